#include <core/messages.hpp>
#include <results/transient_output.hpp>

#include <fmt/format.h>

namespace whirl::results {

// Every output of a transient, in the order of the report. add(setup, outputs) stands in the file
// of the output.
#define WHIRL_TRANSIENT_OUTPUTS(add)                                                               \
  add(add_history) add(add_torques) add(add_energy) add(add_peaks) add(add_tilt) add(add_accuracy) \
      add(add_limits) add(add_bends) add(add_frames) add(add_events) add(add_keyphasor)            \
          add(add_spectra) add(add_temperatures) add(add_replay)

#define WHIRL_DECLARE(add) void add(const TransientSetup& setup, TransientOutputs& outputs);
WHIRL_TRANSIENT_OUTPUTS(WHIRL_DECLARE)

TransientOutputs make_transient_outputs(const TransientSetup& setup) {
  TransientOutputs outputs;
#define WHIRL_CALL(add) add(setup, outputs);
  WHIRL_TRANSIENT_OUTPUTS(WHIRL_CALL)
  return outputs;
}

void warn_of_step(run::Job& job, const model::Step& step, const std::string& what) {
  job.summary["steps"][step.name]["warnings"].push(what);
  job.report.warnings.push_back(step.name + ": " + what);
  if (!job.options.quiet) say(fmt::format("warning: {}: {}\n", step.name, what));
}

}  // namespace whirl::results
