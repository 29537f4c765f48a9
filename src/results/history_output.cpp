// Time histories: rows of the channels the deck asks for, as CSV and HDF5 and as figures.
#include <plot/plots.hpp>
#include <results/history_figures.hpp>
#include <results/transient_output.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace whirl::results {

namespace {

/// When rows of the histories are wanted, or nothing when always.
analysis::Recorder::Gate gate_of(const run::Job& job) {
  const model::Output& o = job.model.output;
  const auto watched = watched_points(job);
  const bool by_speed = o.speed_low > -infinity || o.speed_high < infinity;
  const bool by_size = o.above > 0.0 && !watched.empty();
  if (!by_speed && !by_size) return {};
  return [&job, &o, watched, by_size](const analysis::Snapshot& s) {
    const double spin = s.node(job.reference()).spin();
    if (spin < o.speed_low || spin > o.speed_high) return false;
    return !by_size || std::any_of(watched.begin(), watched.end(), [&](const auto& p) {
      return analysis::displacement(s, p.second).template tail<2>().norm() > o.above;
    });
  };
}

/// The files the deck asks for; none: null.
io::TimeSeriesPtr make_sink(const run::Job& job, const std::string& name) {
  const model::Output& o = job.model.output;
  std::vector<io::TimeSeriesPtr> sinks;
  if (o.csv) sinks.push_back(io::make_csv_series(job.folder.path(name + ".csv")));
  if (o.binary) sinks.push_back(io::make_hdf5_series(job.folder.path(name + ".h5")));
  if (sinks.empty()) return nullptr;
  return sinks.size() == 1 ? std::move(sinks.front()) : io::make_tee(std::move(sinks));
}

/// Histories of other columns than those of the earlier part of the run: the file of that part gets
/// a number.
void keep_earlier_series(const run::Job& job, const std::string& name) {
  for (const char* extension : {".csv", ".h5"}) {
    const std::filesystem::path file = job.folder.path(name + extension);
    std::error_code ec;
    if (!std::filesystem::exists(file, ec)) continue;
    int n = 1;
    while (std::filesystem::exists(job.folder.path(fmt::format("{}.{}{}", name, n, extension)), ec))
      ++n;
    std::filesystem::rename(file, job.folder.path(fmt::format("{}.{}{}", name, n, extension)), ec);
  }
}

class HistoryOutput final : public TransientOutput {
 public:
  explicit HistoryOutput(const TransientSetup& s)
      : job_(s.job),
        step_(s.step),
        resumed_(s.resumed),
        channels_(make_channels(s.job)),
        buffer_(channels_.columns),
        sink_(make_sink(s.job, s.step.name)),
        recorder_(
            channels_.all, [this](const std::vector<double>& row) { take(row); }, s.t_begin,
            out_.every, out_.t0, out_.t1, gate_of(s.job)) {}

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    const std::string columns = column_names();
    const std::string series =
        fmt::format("{}{}: {}", out_.csv ? "csv " : "", out_.binary ? "hdf5 " : "", columns);
    if (sink_)
      parts.add(
          {run::Part::series, series}, [this](OutArchive& a) { save_series(a); },
          [this](InArchive& a) { restore_series(a); });
    parts.add(
        {run::Part::plot_buffer, columns}, [this](OutArchive& a) { buffer_.save(a); },
        [this](InArchive& a) { buffer_.restore(a); });
    if (channels_.columns == 0 || !(sink_ || out_.report)) return;
    observers.push_back(&recorder_);
    parts.add({run::Part::recorder, fmt::format("every {} {}", out_.every, series)}, recorder_);
  }

  void open() override {
    if (!sink_ || continues_) return;
    if (resumed_) keep_earlier_series(job_, step_.name);
    sink_->begin(io_channels(channels_));
  }

  void close() override {
    if (sink_) sink_->close();
  }

  void report(TransientEnd& end) override {
    if (!out_.report) return;
    add_history_figures(job_, step_, channels_, buffer_, unresolved_share(end.law), end.section);
    if (out_.csv) end.section.files.emplace_back("time history", step_.name + ".csv");
  }

 private:
  void take(const std::vector<double>& row) {
    if (sink_) sink_->append(row);
    if (out_.report) buffer_.append(row);
  }

  /// What decides whether a saved part fits.
  std::string column_names() const {
    std::string names;
    for (const analysis::Measurement& m : channels_.all)
      for (std::size_t k = 0; k < m.width(); ++k)
        names += m.name + "." + (m.components.empty() ? "" : m.components[k]) + " ";
    return names;
  }

  void save_series(OutArchive& a) {
    sink_->flush();
    a.put_count(sink_->rows());
  }

  void restore_series(InArchive& a) {
    sink_->resume(io_channels(channels_), a.count());
    continues_ = true;
  }

  const run::Job& job_;
  const model::Step& step_;
  const model::Output& out_ = job_.model.output;
  bool resumed_, continues_ = false;  ///< continues_: the files are those of the earlier part
  Channels channels_;
  PlotBuffer buffer_;
  io::TimeSeriesPtr sink_;
  analysis::Recorder recorder_;
};

}  // namespace

void add_history(const TransientSetup& setup, TransientOutputs& outputs) {
  outputs.push_back(std::make_unique<HistoryOutput>(setup));
}

}  // namespace whirl::results
