// An output of a transient step: what it observes, what of it a checkpoint keeps, and what it adds
// to summary and report at the end. The step holds a list of them and knows none.
//
// To add one: a file of its own with a class derived from TransientOutput and the function that
// adds it to the list where the deck asks for it, and a line in transient_outputs.cpp.
#pragma once
#include <analysis/transient/observer.hpp>
#include <results/channels.hpp>
#include <run/checkpoint.hpp>
#include <run/job.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace whirl::analysis {
class LinearMotion;
}
namespace whirl::system {
struct Frames;
}

namespace whirl::results {

/// What outputs are made from; what it refers to outlives them.
struct TransientSetup {
  run::Job& job;
  const model::Step& step;
  const model::TransientStep& law;
  const run::StepState& start;       ///< where the step starts, or goes on when resumed
  const time::Options& integration;  ///< end time and breakpoints, s
  double t_begin = 0;                ///< where the step began, s: of a resumed one too
  bool resumed = false;
  const analysis::LinearMotion* motion = nullptr;  ///< of a linear step; else null
};

/// A transient that has ended, and where it is shown.
struct TransientEnd {
  run::Job& job;
  const model::Step& step;
  const model::TransientStep& law;
  const analysis::TransientResult& result;
  io::Value& summary;          ///< of the step
  io::ReportSection& section;  ///< of the step; dropped when the deck wants no report
};

/// Of the largest motion or load of a transient the share below which its integrator resolves
/// nothing: a tenth of the error that it aims at; of a fixed step, which aims at none, rounding.
inline double unresolved_share(const model::TransientStep& law) {
  constexpr double most = 1e-5, rounding = 1e-9;
  return law.integrator.dt > 0 ? rounding : std::min(most, 0.1 * law.integrator.tolerance);
}

class TransientOutput {
 public:
  virtual ~TransientOutput() = default;
  /// Joins the stepping loop and the checkpoint; called once, before open().
  virtual void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) = 0;
  /// Null, or what it changes between steps (TransientOptions::between_steps).
  virtual std::function<void(double, system::Frames&)> between_steps() { return nullptr; }
  /// s, of a step that adapts.
  virtual double longest_step() const { return infinity; }
  /// Begins the files that no checkpoint goes on with, after the parts are restored.
  virtual void open() {}
  /// Ends them. The motion is over, complete or not.
  virtual void close() {}
  /// Numbers and warnings.
  virtual void summarize(TransientEnd& end) { (void)end; }
  /// A few words for the line on the terminal, or none.
  virtual std::string headline() const { return {}; }
  /// Tables, figures and the files they are written to; after summarize() of all outputs.
  virtual void report(TransientEnd& end) { (void)end; }
};

using TransientOutputs = std::vector<std::unique_ptr<TransientOutput>>;

/// Those the deck asks for, in the order of the report.
TransientOutputs make_transient_outputs(const TransientSetup& setup);

/// The output of type T of a list, which has one.
template <class T>
const T& find_output(const TransientOutputs& outputs) {
  for (const auto& o : outputs)
    if (const T* found = dynamic_cast<const T*>(o.get())) return *found;
  throw std::logic_error("no such output of a transient");
}

/// Warns in the summary of the step, in the report and on the terminal.
void warn_of_step(run::Job& job, const model::Step& step, const std::string& what);

}  // namespace whirl::results
