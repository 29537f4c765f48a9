// What loads that change do to the stiffness that small motions in time keep.
#pragma once
#include <run/job.hpp>

namespace whirl::results {

/// Warns where loads of a linear transient, as they act at some time of it, move a natural frequency of the
/// rotor by more than 1 % from what it is at the start, or leave it no equilibrium: axial loads stiffen
/// shafts or soften them, others move supports along their curves.
void warn_of_changing_loads(run::Job& job, const model::Step& step, const model::TransientStep& law,
                            const run::StepState& start);

}  // namespace whirl::results
