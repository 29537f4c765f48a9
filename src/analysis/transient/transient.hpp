// Nonlinear transients: run-up, run-down, impacts, whatever the system's laws and loads do in time.
#pragma once
#include <analysis/transient/observer.hpp>
#include <system/problem.hpp>
#include <time/integrator.hpp>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace whirl::analysis {

/// Ends the run when the spin of a node passes `speed` (either way), located on the dense output.
struct SpeedStop {
  Index node = 0;
  double speed = 0;
  LawPtr angle = {};                      ///< that is prescribed at the node: its rate is the spin
  double reach = 0, hold = 0;             ///< see LevelPassages
  std::optional<std::size_t> event = {};  ///< it belongs to, by number
};
/// Ends the run when a point's lateral displacement exceeds `limit`, m.
struct AmplitudeStop {
  Point point;
  double limit = infinity;
  std::string name;
  std::optional<std::size_t> event = {};  ///< it belongs to, by number
};

struct Progress {
  double t = 0, t_end = 0, spin = 0, dt = 0;
  long steps = 0, newton = 0;
};

struct TransientOptions {
  std::string method = "radau5";
  time::Options integrator;  ///< t_end and breakpoints included
  std::vector<SpeedStop> speed_stops;
  std::vector<AmplitudeStop> amplitude_stops;
  Index reference = 0;                            ///< node whose spin progress reports
  std::function<void(const Progress&)> progress;  ///< after every step
  const std::atomic<bool>* interrupt = nullptr;   ///< set by Ctrl-C
  /// Every so many accepted steps the matrices are made anew, whether a checkpoint is written there
  /// or not: the motion does not depend on the clock, and checkpoints and interruptions fall on
  /// these steps only. 0: none.
  long steps_between_marks = 0;
  double checkpoint_seconds = infinity;  ///< wall clock between checkpoints
  /// Called at a mark when it is time, when interrupted, and at the end of the run (not after a
  /// failure).
  std::function<void(const system::State&, const time::IntegratorState&)> checkpoint;
  /// Called at marks two seconds and more apart: what a checkpoint would hold is kept in memory.
  /// Where the next mark is more than three seconds away (a thousand rows a step) an interruption
  /// does not wait for it: the run stops at once and calls fall_back, which writes what was kept;
  /// the time since then is computed again when the run is resumed.
  std::function<void(const system::State&, const time::IntegratorState&)> keep;
  std::function<void()> fall_back;
  /// Called after every step, ending at t, and what watches it: may change the rates of what elements keep
  /// (Frames::kept_rate), which goes on without a jump.
  std::function<void(double t, system::Frames&)> between_steps;
  std::vector<Observer*> new_observers;  ///< of a resumed run: those that begin at its start
};

enum class StopReason { end_time, speed_reached, amplitude_limit, interrupted, failed };
std::string_view to_string(StopReason r);

struct TransientResult {
  StopReason reason = StopReason::end_time;
  std::string detail;  ///< which stop, or why it failed and where
  system::State end;
  time::Statistics statistics;
  double seconds = 0;  ///< CPU time of stepping and observing, this thread
};

/// Runs from `start` to integrator.t_end. Observers see every accepted step in order. A failure (no
/// step possible) is a result, with node and time in `detail`; the observers have seen all steps
/// before it. resume: continue from a checkpoint (`start` gives the frames); observers are those of
/// the earlier run restored, or named in new_observers.
/// @pre a state of the problem; no observer is null.
/// @throws Error (N10, N11) for an integrator that does not exist or options out of range; (N20)
/// when there is no initial acceleration.
TransientResult run_transient(system::SystemProblem& problem, const system::State& start,
                              const TransientOptions& options,
                              const std::vector<Observer*>& observers,
                              const time::IntegratorState* resume = nullptr);

}  // namespace whirl::analysis
