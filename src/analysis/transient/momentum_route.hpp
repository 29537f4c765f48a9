// The momentum form (system/momentum.hpp) by explicit Runge-Kutta, as an Integrator: the paper's
// own route, selectable like any scheme where all inertia is that of rigid bodies.
#pragma once
#include <system/momentum.hpp>
#include <system/problem.hpp>
#include <time/integrator.hpp>

namespace whirl::analysis {

/// problem: shares its frames with the momentum form, so that observers read the same charts.
/// order: of the Runge-Kutta pair. options.tolerance is the pair's relative local tolerance.
/// @throws Error E74, the system has inertia other than rigid bodies'; the SUNDIALS plug-in is
/// missing.
std::unique_ptr<time::Integrator> make_momentum_integrator(system::SystemProblem& problem,
                                                           const time::Options& options,
                                                           int order = 8);

}  // namespace whirl::analysis
