// What leaving out physics saves: one evaluation of the model as built against one of the general
// model.
#pragma once
#include <run/job.hpp>

namespace whirl::steps {

/// CPU seconds of one evaluation of forces and tangents; 0 where the general model cannot be built.
struct Savings {
  double pruned = 0, everything = 0;
};
/// The fastest of several evaluations each, in the reference state. Costs about ten evaluations of
/// both.
Savings measure_savings(const run::Job& job);

}  // namespace whirl::steps
