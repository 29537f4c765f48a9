// The largest amplitude of every probe (without any: of every disk), and when.
#include <results/transient_output.hpp>

namespace whirl::results {

namespace {

class PeaksOutput final : public TransientOutput {
 public:
  using Points = std::vector<std::pair<std::string, analysis::Point>>;

  PeaksOutput(const TransientSetup& s, const Points& watched)
      : peaks_(watched, s.job.reference()) {}

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&peaks_);
    std::string names;
    for (const analysis::Peak& p : peaks_.peaks())
      names += p.name + " ";
    parts.add({run::Part::peaks, names}, peaks_);
  }

  void summarize(TransientEnd& end) override {
    for (const analysis::Peak& p : peaks_.peaks()) {
      io::Value& v = end.summary["peaks"][p.name];
      v["amplitude 0-peak [m]"] = p.amplitude;
      v["time [s]"] = p.time;
      v["speed [rpm]"] = to_rpm(p.speed);
    }
  }

  void report(TransientEnd& end) override {
    if (!end.job.model.output.report) return;
    io::Table t;
    t.title = "Peaks";
    t.columns = {
        {"probe", "-", ""}, {"amplitude 0-peak", "m", ""}, {"speed", "rpm", ""}, {"time", "s", ""}};
    for (const analysis::Peak& p : peaks_.peaks())
      t.add({p.name, p.amplitude, to_rpm(p.speed), p.time});
    end.job.folder.write_table(end.step.name + "_peaks.csv", t);
    end.section.tables.push_back(std::move(t));
  }

 private:
  analysis::PeakTracker peaks_;
};

}  // namespace

void add_peaks(const TransientSetup& setup, TransientOutputs& outputs) {
  if (const PeaksOutput::Points watched = watched_points(setup.job); !watched.empty())
    outputs.push_back(std::make_unique<PeaksOutput>(setup, watched));
}

}  // namespace whirl::results
