// The states transient steps start from: steady responses, modes, other runs; and where their drives begin.
#pragma once
#include <run/job.hpp>

namespace whirl::steps {

/// Moves a start into the steady response to the unbalance at its speed; adds the whirl mode that
/// the step names.
/// @throws Error (E76) when there is no response to start in.
void start_in_unbalance_response(const run::Job&, run::StepState& start);
/// @throws Error (E76) when there is no such mode.
void start_in_mode(const run::Job&, run::StepState& start, const model::TransientStep&);
/// Says (W08) where a step begins in an equilibrium that is left as soon as anything disturbs it: nothing in
/// the motion need show that. Of machines with controllers the motions that grow are looked for (W13).
void warn_of_unstable_start(run::Job&, const model::Step&, const run::StepState& start,
                            const analysis::Equilibrium& equilibrium);
/// How a step begins.
enum class Beginning {
  settled,    ///< at rest or in an equilibrium: a prescribed angle is that of its law
  in_motion,  ///< where another transient ended: a prescribed angle goes on from the one there is
  resumed     ///< in its midst: as it began
};
Beginning beginning_of(const run::Job&, const model::Step&, const model::TransientStep&);
/// Lets the drives of the step begin to count turns; speed controllers that acted before go on with
/// their integrals, without a jump of their torque.
void begin_drives(const run::Job&, run::StepState& start, Beginning);
/// The part of a checkpoint that says where they began.
void save_drives(OutArchive& out, const run::StepState& start);
void restore_drives(InArchive& in, run::StepState& start);
/// The last state of a transient step in another results folder.
run::StepState start_of_other_run(run::Job&, const model::Step&, const std::string& folder,
                                  const std::string& step);

}  // namespace whirl::steps
