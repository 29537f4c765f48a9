// Modal, Campbell, critical-speed and unbalance-response steps.
#include <app/job.hpp>

namespace whirl::app {

void run_frequency_step(Job&, const model::Step& step) {
  throw run_error("R12", "step '" + step.name + "' is of a kind this build cannot run", "", step.name);
}

}  // namespace whirl::app
