// The largest displacement of every probe (without any: of every disk), and when; the same of its
// motion alone, about the place at the start: a sag is no vibration.
#include <results/transient_output.hpp>

#include <span>

namespace whirl::results {

namespace {

class PeaksOutput final : public TransientOutput {
 public:
  using Points = std::vector<std::pair<std::string, analysis::Point>>;

  PeaksOutput(const TransientSetup& s, const Points& watched)
      : peaks_(watched, s.job.reference(), -infinity, true) {}

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&peaks_);
    std::string names;
    for (const analysis::Peak& p : peaks_.peaks())
      names += p.name + " ";
    parts.add({run::Part::peaks, names + "and motion"}, peaks_);
  }

  void summarize(TransientEnd& end) override {
    for (const analysis::Peak& p : of_displacement()) {
      io::Value& v = end.summary["peaks"][p.name];
      v["amplitude 0-peak [m]"] = p.amplitude;
      v["time [s]"] = p.time;
      v["speed [rpm]"] = to_rpm(p.speed);
    }
    for (const analysis::Peak& p : of_motion())
      end.summary["peaks"][p.name]["about the place at the start [m]"] = p.amplitude;
  }

  void report(TransientEnd& end) override {
    if (!end.job.model.output.report) return;
    io::Table t;
    t.title = "Peaks";
    t.columns = {{"probe", "-", ""},
                 {"amplitude 0-peak", "m", "from the line at rest, static displacement included"},
                 {"speed", "rpm", ""},
                 {"time", "s", ""},
                 {"motion 0-peak", "m", "about the place at the start"},
                 {"motion at", "s", ""}};
    for (std::size_t i = 0; i < of_displacement().size(); ++i) {
      const analysis::Peak &p = of_displacement()[i], &motion = of_motion()[i];
      t.add({p.name, p.amplitude, to_rpm(p.speed), p.time, motion.amplitude, motion.time});
    }
    end.job.folder.write_table(end.step.name + "_peaks.csv", t);
    end.section.tables.push_back(std::move(t));
  }

 private:
  using Peaks = std::span<const analysis::Peak>;
  Peaks of_displacement() const { return Peaks(peaks_.peaks()).first(peaks_.peaks().size() / 2); }
  Peaks of_motion() const { return Peaks(peaks_.peaks()).last(peaks_.peaks().size() / 2); }

  analysis::PeakTracker peaks_;
};

}  // namespace

void add_peaks(const TransientSetup& setup, TransientOutputs& outputs) {
  if (const PeaksOutput::Points watched = watched_points(setup.job); !watched.empty())
    outputs.push_back(std::make_unique<PeaksOutput>(setup, watched));
}

}  // namespace whirl::results
