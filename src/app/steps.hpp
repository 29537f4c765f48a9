#pragma once
#include <app/job.hpp>

namespace whirl::app {

/// Runs every step of the job's deck and writes summary.json, report.html and plots/. An Error of a step is passed on after
/// everything up to it has been written.
void run_steps(Job& job);

}  // namespace whirl::app
