#pragma once
#include <run/job.hpp>

namespace whirl::steps {

/// Runs every step of the job's deck and writes summary.json, report.html and plots/. An Error of a
/// step is passed on after everything up to it has been written.
void run_steps(run::Job& job);

}  // namespace whirl::steps
