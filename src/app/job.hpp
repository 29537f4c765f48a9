// One run of a deck: model -> mesh -> system -> the deck's steps, in order, each writing its results. The body of run_deck().
#pragma once
#include <analysis/equilibrium.hpp>
#include <analysis/measurement.hpp>
#include <analysis/transient.hpp>
#include <app/run.hpp>
#include <assembly/build_system.hpp>
#include <core/archive.hpp>
#include <core/stopwatch.hpp>
#include <io/frames.hpp>
#include <io/report.hpp>
#include <io/results.hpp>
#include <meshes/scene.hpp>
#include <model/model.hpp>
#include <system/system.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace whirl::app {

/// Results of a finished step that a later one can start from.
struct StepState {
  system::State state;
  double speed = 0;   ///< rad/s of the reference line
  /// Where the integrals of the governors that acted began, by drive: a later step in which they act as well goes on with them.
  struct Began { double time = 0, angle = 0; };
  std::map<std::string, Began> governors;
};

struct Job {
  const model::Model& model;
  const RunOptions& options;
  meshes::Mesh mesh;
  assembly::Built built;               ///< system, breakpoints of element laws, what was left out
  meshes::Scene scene;
  io::ResultsFolder folder;
  io::Report report;
  io::Value summary;
  std::map<std::string, StepState> states;
  std::vector<std::pair<std::string, RunTime>> phases;   ///< for the summary

  /// Steps whose lists or verdicts could not be certified although they should be: the run ends with Exit::no_convergence.
  std::vector<std::string> uncertified;

  std::string built_for;

  Job(const model::Model& m, const RunOptions& o, const std::filesystem::path& root);
  const system::System& system() const { return built.system; }
  Index reference() const { return built.reference; }
  /// Builds the system with the drives of a step (the same one again costs nothing).
  void build_for(const model::Step& step);
  /// Initial state of a step: that of the step it names, else straight, with the lines' spins. speed: of the reference, rad/s, every line at
  /// its speed_ratio whatever drives prescribe; without it lines turn as their drives prescribe at time 0, else with their initial spins.
  StepState start_of(const model::Step& step, std::optional<double> speed) const;
  /// How the lines turn in a state.
  analysis::Running running_of(const StepState& start) const;
  /// Moves a start to its static equilibrium (spinning, loaded; in_time: where a transient starts, hysteretic damping as it acts there). Errors E75, E76 when there is none.
  analysis::Equilibrium settle(StepState& start, analysis::EquilibriumOptions options = {}, bool in_time = false) const;
};

class PlotBuffer;
/// Figures of a transient's time histories: speed, probes (time, amplitude against speed, orbit), paths, rotation, energies.
/// start[i]: first column of measurement i in the buffer.
void add_history_figures(const Job&, const model::Step&, const std::vector<analysis::Measurement>&, const std::vector<std::size_t>& start,
                         const PlotBuffer&, io::ReportSection&);

/// Each runs one step, adds its section to the report and its entry to the summary, and writes its files.
void run_static_step(Job&, const model::Step&, const model::StaticStep&);
void run_static_speeds(Job&, const model::Step&, const std::vector<double>& speeds, int load_steps);
void run_transient_step(Job&, const model::Step&, const model::TransientStep&);
/// In the frequency domain (any kind that is neither static nor transient); see frequency.hpp.
void run_frequency_step(Job&, const model::Step&);

/// Where a transient's peaks are looked for: the probes, or the disks when there are none.
std::vector<std::pair<std::string, analysis::Point>> watched_points(const Job&);
/// Scheme, accuracy, breakpoints and stops of a transient step.
analysis::TransientOptions transient_options(const Job&, const model::TransientStep&, double t0);
/// The state it starts from, settled when the deck asks for the static equilibrium.
StepState transient_start(Job&, const model::Step&, const model::TransientStep&);

/// The equations a transient step integrates from `start`: the general ones, or those of small motions.
std::unique_ptr<system::SystemProblem> transient_problem(const Job&, const model::TransientStep&, const StepState& start);

/// Moves a start into the steady response to the unbalance at its speed; adds the whirl mode that the step names.
void start_in_unbalance_response(const Job&, StepState& start);
void start_in_mode(const Job&, StepState& start, const model::TransientStep&);
/// Lets the governors of the step begin: where those of the start did that acted before, the others here, without a jump of their torque.
void begin_governors(const Job&, StepState& start);
/// The part of a checkpoint that says where they began.
inline constexpr const char* governors_part = "governors";
void save_governors(OutArchive& out, const StepState& start);
void restore_governors(InArchive& in, StepState& start);
/// The last state of a transient step in another results folder.
StepState start_of_other_run(const Job&, const std::string& folder, const std::string& step);

/// "run time, CPU [s]" and "run time, wall [s]" of a summary.
void put_run_time(io::Value& summary, const RunTime& time);

/// Adds the time since its construction to a phase of the job.
class PhaseTimer {
 public:
  PhaseTimer(Job& job, std::string phase);
  ~PhaseTimer();
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  Job& job_;
  std::string phase_;
  Stopwatch watch_;
};

/// Progress on a terminal (one line, rewritten) or one line per 10 %.
class ProgressLine {
 public:
  ProgressLine(std::string name, bool quiet);
  void update(double fraction, const std::string& text);
  void done(const std::string& text);

 private:
  std::string name_;
  bool quiet_, terminal_;
  int last_tenth_ = -1;
  double last_time_ = 0;
};

}  // namespace whirl::app
