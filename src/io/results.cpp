#include <core/plugin.hpp>
#include <io/file.hpp>
#include <io/hdf5/entry.hpp>
#include <io/results.hpp>
#include <stdexcept>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

class Tee final : public TimeSeries {
 public:
  explicit Tee(std::vector<TimeSeriesPtr> sinks) : sinks_(std::move(sinks)) {}
  void begin(std::span<const Channel> c) override { rows_ = 0; for (auto& s : sinks_) s->begin(c); }
  void resume(std::span<const Channel> c, std::uint64_t rows) override { rows_ = rows; for (auto& s : sinks_) s->resume(c, rows); }
  void append(std::span<const double> row) override { ++rows_; for (auto& s : sinks_) s->append(row); }
  void flush() override { for (auto& s : sinks_) s->flush(); }
  void close() override { for (auto& s : sinks_) s->close(); }
  std::uint64_t rows() const override { return rows_; }

 private:
  std::vector<TimeSeriesPtr> sinks_;
  std::uint64_t rows_ = 0;
};

}  // namespace

TimeSeriesPtr make_tee(std::vector<TimeSeriesPtr> sinks) { return std::make_unique<Tee>(std::move(sinks)); }

bool hdf5_available() { return Plugin::available("hdf5"); }

TimeSeriesPtr make_hdf5_series(fs::path file, SeriesOptions options) {
  return TimeSeriesPtr(Plugin::load("hdf5").function<Hdf5MakeSeries>(hdf5_make_series)(file, options));
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
}

fs::path ResultsFolder::path(std::string_view name) const {
  const fs::path p = root_ / name;
  std::error_code ec;
  fs::create_directories(p.parent_path(), ec);
  if (ec) io_failure(p.parent_path(), "cannot make the folder", ec.value());
  return p;
}

void ResultsFolder::write_text(std::string_view name, std::string_view content) const {
  write_atomic(root_ / name, content);
}
void ResultsFolder::write_json(std::string_view name, const Value& value) const {
  write_atomic(root_ / name, to_json(value));
}
void ResultsFolder::write_table(std::string_view name, const Table& table) const { write_csv(root_ / name, table); }

}  // namespace whirl::io
