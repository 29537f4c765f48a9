// The largest displacement of every probe (without any: of every disk), and when; and the largest
// motion alone: a sag is no vibration, nor is a slow drift.
#include <results/transient_output.hpp>

namespace whirl::results {

namespace {

class PeaksOutput final : public TransientOutput {
 public:
  using Points = std::vector<std::pair<std::string, analysis::Point>>;

  PeaksOutput(const TransientSetup& s, const Points& watched)
      : peaks_(watched, s.job.reference(), -infinity, turning_nodes(s.job, watched)) {}

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&peaks_);
    std::string names;
    for (const analysis::Peak& p : peaks_.peaks())
      names += p.name + " ";
    parts.add({run::Part::peaks, names + "and motion in two turns"}, peaks_);
  }

  void summarize(TransientEnd& end) override {
    for (std::size_t i = 0; i < peaks_.peaks().size(); ++i) {
      const analysis::Peak& p = peaks_.peaks()[i];
      io::Value& v = end.summary["peaks"][p.name];
      v["amplitude 0-peak [m]"] = p.amplitude;
      v["time [s]"] = p.time;
      v["speed [rpm]"] = to_rpm(p.speed);
      v["motion 0-peak [m]"] = peaks_.motions()[i].amplitude();
    }
  }

  void report(TransientEnd& end) override {
    io::Table t;
    t.title = "Peaks";
    t.columns = {
        {"probe", "-", ""},
        {"amplitude 0-peak", "m", "from the line at rest, static displacement included"},
        {"speed", "rpm", ""},
        {"time", "s", ""},
        {"motion 0-peak", "m", "half the largest peak-to-peak in two turns, without sag and drift"},
        {"motion at", "s", ""}};
    for (std::size_t i = 0; i < peaks_.peaks().size(); ++i) {
      const analysis::Peak& p = peaks_.peaks()[i];
      const analysis::OrbitWidth& motion = peaks_.motions()[i];
      t.add({p.name, p.amplitude, to_rpm(p.speed), p.time, motion.amplitude(), motion.time()});
    }
    end.job.folder.write_table(end.step.name + "_peaks.csv", t);
    if (!end.job.model.output.report) return;
    end.section.tables.push_back(std::move(t));
  }

 private:
  /// The node that turns with each point: its own; of one that stands, the reference.
  static std::vector<Index> turning_nodes(const run::Job& job, const Points& watched) {
    std::vector<Index> nodes;
    for (const auto& [name, point] : watched) {
      const Index line = job.mesh.nodes[static_cast<std::size_t>(point.node)].line;
      const bool turns = line >= 0 && job.mesh.lines[static_cast<std::size_t>(line)].rotating;
      nodes.push_back(turns ? point.node : job.reference());
    }
    return nodes;
  }

  analysis::PeakTracker peaks_;
};

}  // namespace

void add_peaks(const TransientSetup& setup, TransientOutputs& outputs) {
  if (const PeaksOutput::Points watched = watched_points(setup.job); !watched.empty())
    outputs.push_back(std::make_unique<PeaksOutput>(setup, watched));
}

}  // namespace whirl::results
