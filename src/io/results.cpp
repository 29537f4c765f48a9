#include <core/plugin.hpp>
#include <io/file.hpp>
#include <io/hdf5/entry.hpp>
#include <io/nonfinite.hpp>
#include <io/plain_csv.hpp>
#include <io/results.hpp>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

class Tee final : public TimeSeries {
 public:
  explicit Tee(std::vector<TimeSeriesPtr> sinks) : sinks_(std::move(sinks)) {}
  void begin(std::span<const Channel> c) override {
    rows_ = 0;
    for (auto& s : sinks_)
      s->begin(c);
  }
  void resume(std::span<const Channel> c, std::uint64_t rows) override {
    rows_ = rows;
    for (auto& s : sinks_)
      s->resume(c, rows);
  }
  void append(std::span<const double> row) override {
    ++rows_;
    for (auto& s : sinks_)
      s->append(row);
  }
  void flush() override {
    for (auto& s : sinks_)
      s->flush();
  }
  void close() override {
    for (auto& s : sinks_)
      s->close();
  }
  std::uint64_t rows() const override { return rows_; }

 private:
  std::vector<TimeSeriesPtr> sinks_;
  std::uint64_t rows_ = 0;
};

/// Counts what is no number on its way into a file.
class Watched final : public TimeSeries {
 public:
  Watched(std::string file, TimeSeriesPtr sink) : file_(std::move(file)), sink_(std::move(sink)) {}
  ~Watched() override { report(); }
  void begin(std::span<const Channel> c) override {
    take_names(c);
    sink_->begin(c);
  }
  void resume(std::span<const Channel> c, std::uint64_t rows) override {
    take_names(c);
    sink_->resume(c, rows);
  }
  void append(std::span<const double> row) override {
    double zero = 0;
    for (const double x : row)
      zero += 0.0 * x;  // NaN when any is not finite
    if (!(zero == 0.0)) count(row);
    sink_->append(row);
  }
  void flush() override { sink_->flush(); }
  void close() override {
    sink_->close();
    report();
  }
  std::uint64_t rows() const override { return sink_->rows(); }

 private:
  void take_names(std::span<const Channel> channels) {
    names_.clear();
    for (const Channel& c : channels)
      for (std::size_t k = 0; k < c.width(); ++k)
        names_.push_back(c.column(k));
  }
  void count(std::span<const double> row) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (std::isfinite(row[k])) continue;
      if (count_++ == 0) first_ = k < names_.size() ? names_[k] : std::string();
    }
  }
  void report() { note_nonfinite(file_, first_, std::exchange(count_, 0)); }

  std::string file_;
  TimeSeriesPtr sink_;
  std::vector<std::string> names_;
  std::string first_;
  std::size_t count_ = 0;
};

}  // namespace

TimeSeriesPtr make_csv_series(fs::path file, SeriesOptions options) {
  std::string name = file.filename().string();
  return std::make_unique<Watched>(std::move(name),
                                   make_plain_csv_series(std::move(file), options));
}

TimeSeriesPtr make_tee(std::vector<TimeSeriesPtr> sinks) {
  return std::make_unique<Tee>(std::move(sinks));
}

TimeSeriesPtr make_hdf5_series(const fs::path& file, SeriesOptions options) {
  TimeSeriesPtr sink(
      Plugin::load("hdf5").function<Hdf5MakeSeries>(hdf5_make_series)(file, options));
  return std::make_unique<Watched>(file.filename().string(), std::move(sink));
}

void add_words_hdf5(const fs::path& file, const std::vector<WordColumn>& columns) {
  Plugin::load("hdf5").function<Hdf5AddWords>(hdf5_add_words)(file, columns);
}

Columns read_hdf5(const fs::path& file) {
  Columns c;
  Plugin::load("hdf5").function<Hdf5Read>(hdf5_read)(file, c);
  return c;
}

ResultsFolder::ResultsFolder(fs::path root) : root_(std::move(root)) {
  std::error_code ec;
  fs::create_directories(root_, ec);
  if (ec) io_failure(root_, "cannot make the folder", ec.value());
  remove_leftovers(root_);
  manifest_ = std::make_shared<Manifest>(root_);
}

fs::path ResultsFolder::path(std::string_view name) const {
  manifest_->claim(name, owner_);
  const fs::path p = root_ / name;
  std::error_code ec;
  fs::create_directories(p.parent_path(), ec);
  if (ec) io_failure(p.parent_path(), "cannot make the folder", ec.value());
  return p;
}

fs::path ResultsFolder::subfolder(std::string_view name) const {
  const fs::path p = root_ / name;
  std::error_code ec;
  if (fs::is_symlink(fs::symlink_status(p, ec)))
    io_failure(p, "nothing is written through a symbolic link:");
  fs::create_directories(p, ec);
  if (ec) io_failure(p, "cannot make the folder", ec.value());
  return p;
}

void ResultsFolder::remove(const std::function<bool(const std::string&)>& which) const {
  manifest_->remove(which);
}

void ResultsFolder::protect(const std::vector<fs::path>& inputs) { manifest_->protect(inputs); }

void ResultsFolder::remove_of(const std::string& owner) const { manifest_->remove_of(owner); }

void ResultsFolder::write_only(std::vector<std::string> names) {
  only_ = std::move(names);
  manifest_->list_nothing();
}

bool ResultsFolder::wanted(std::string_view name) const {
  if (only_.empty() || std::find(only_.begin(), only_.end(), name) != only_.end()) return true;
  manifest_->claim(name, owner_);
  return false;
}

void ResultsFolder::write_text(std::string_view name, std::string_view content) const {
  if (wanted(name)) write_atomic(path(name), content);
}
void ResultsFolder::write_json(std::string_view name, const Value& value) const {
  if (wanted(name)) write_atomic(path(name), to_json(value));
}

void ResultsFolder::write_table(std::string_view name, const Table& table) const {
  const auto unexpected = [&](const Table::Cell& c) {
    return !c.is_text && !std::isfinite(c.number) &&
           !(std::isnan(c.number) && !table.nan_means.empty());
  };
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const auto count = std::count_if(table.rows.begin(), table.rows.end(),
                                     [&](const auto& row) { return unexpected(row[k]); });
    note_nonfinite(name, table.columns[k].name, static_cast<std::size_t>(count));
  }
  if (!wanted(name)) return;
  write_csv(path(name), table);
  if (seen_) seen_(name, table);
}

}  // namespace whirl::io
