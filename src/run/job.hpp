// One run of a deck: model -> mesh -> system -> the deck's steps, in order, each writing its
// results. The body of run_deck().
#pragma once
#include <analysis/statics/equilibrium.hpp>
#include <analysis/transient/measurement.hpp>
#include <analysis/transient/transient.hpp>
#include <run/options.hpp>
#include <assembly/build_system.hpp>
#include <core/archive.hpp>
#include <core/stopwatch.hpp>
#include <io/frames.hpp>
#include <io/report.hpp>
#include <io/results.hpp>
#include <meshes/scene.hpp>
#include <model/model.hpp>
#include <system/system.hpp>
#include <time/twist_scale.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace whirl::run {

/// Results of a finished step that a later one can start from.
struct StepState {
  system::State state;
  double speed = 0;  ///< rad/s of the reference line
  /// Where the drives that acted began to count turns: a later step in which a speed controller acts
  /// as well goes on with its integral.
  struct Began {
    double time = 0, angle = 0;
  };
  std::map<std::string, Began> drives{};
};

/// What the torques of a transient did to every element of the shafts, the worse of its two ends.
struct ShaftDamage {
  std::vector<double> stress;  ///< Pa, largest shear stress
  std::vector<double> damage;  ///< share of the life; empty: no fatigue asked for
};

struct Job {
  const model::Model& model;
  const RunOptions& options;
  meshes::Mesh mesh;
  assembly::Built built;  ///< system, breakpoints of element laws, what was left out
  meshes::Scene scene;
  io::ResultsFolder folder;
  io::Report report;
  io::Value summary;
  std::map<std::string, StepState> states;
  std::map<std::string, ShaftDamage> shaft_damage;      ///< by transient step that was asked for it
  std::vector<std::pair<std::string, RunTime>> phases;  ///< for the summary

  /// Steps whose lists or verdicts could not be certified although they should be: the run ends
  /// with Exit::no_convergence.
  std::vector<std::string> uncertified;

  std::string built_for;  ///< name of the step that `built` was made for; empty: of none yet

  Job(const model::Model& m, const RunOptions& o, const std::filesystem::path& root);
  /// A run of another model within this one: it writes into the same folder; report, summary,
  /// warnings and states are its own until hand_over().
  Job(const model::Model& m, const Job& parent) : Job(m, parent, parent.options) {}
  Job(const model::Model& m, const Job& parent, const RunOptions& o);
  /// Gives what a run within a run has to say to the one it is part of; its steps go into `steps` of
  /// the summary.
  void hand_over(Job& parent, io::Value& steps);
  const system::System& system() const { return built.system; }
  Index reference() const { return built.reference; }
  /// speed_ratio of the reference's shaft: its spin is this many times the reference speed.
  double reference_ratio() const;
  /// Builds the system with the drives of a step (the same one again costs nothing).
  void build_for(const model::Step& step);
  /// The step goes on from the motion of another one, which has its own speed and angles.
  bool goes_on_in_motion(const model::Step& step) const;
  /// Initial state of a step: that of the step it names, else straight, with the lines' spins.
  /// speed: of the reference, rad/s, every line at its speed_ratio whatever drives prescribe;
  /// without it lines turn as their drives prescribe at time 0, else with their initial spins.
  StepState start_of(const model::Step& step, std::optional<double> speed) const;
  /// Spin of each line, rad/s; of lines that gears, couplings or joints tie in proportion, about which
  /// they vibrate.
  std::vector<double> mean_spins(const StepState& start) const;
  /// The nodes of shafts that turn in proportion, group by group: what vibrations of twist are between.
  std::vector<time::TwistGroup> twisting_shafts() const;
  /// How the lines turn in a state.
  analysis::SteadyRotation steady_rotation_of(const StepState& start) const;
  /// Moves a start to its static equilibrium (spinning, loaded; in_time: where a transient starts,
  /// hysteretic damping as it acts there). Errors E75, E76 when there is none.
  analysis::Equilibrium settle(StepState& start, analysis::EquilibriumOptions options = {},
                               bool in_time = false) const;

 private:
  /// Of a line where its drive holds it, rad; 0: nothing prescribes it.
  double angle_of_drive(const system::State& s, std::size_t line) const;
  std::string key_;  ///< assembly::system_key of `built`
};

}  // namespace whirl::run
