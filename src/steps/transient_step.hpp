// What a transient step is made of, for those who run one otherwise than the step itself does
// (studies, benchmarks).
#pragma once
#include <run/job.hpp>

namespace whirl::steps {

/// Scheme, accuracy, breakpoints and stops of a transient step.
analysis::TransientOptions transient_options(const run::Job&, const model::TransientStep&,
                                             double t0);
/// The state it starts from, settled when the deck asks for the static equilibrium.
run::StepState transient_start(run::Job&, const model::Step&, const model::TransientStep&);

/// The equations a transient step integrates from `start`: the general ones, or those of small
/// motions.
std::unique_ptr<system::SystemProblem> transient_problem(const run::Job&,
                                                         const model::TransientStep&,
                                                         const run::StepState& start);

}  // namespace whirl::steps
