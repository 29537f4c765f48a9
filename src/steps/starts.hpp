// The states transient steps start from: steady responses, modes, other runs; and their governors.
#pragma once
#include <run/job.hpp>

namespace whirl::steps {

/// Moves a start into the steady response to the unbalance at its speed; adds the whirl mode that
/// the step names.
/// @throws Error (E76) when there is no response to start in.
void start_in_unbalance_response(const run::Job&, run::StepState& start);
/// @throws Error (E76) when there is no such mode.
void start_in_mode(const run::Job&, run::StepState& start, const model::TransientStep&);
/// Lets the governors of the step begin: where those of the start did that acted before, the others
/// here, without a jump of their torque. in_motion: the start was left by a transient; prescribed
/// angles then go on from the angle there is.
void begin_governors(const run::Job&, run::StepState& start, bool in_motion);
/// The part of a checkpoint that says where they began.
void save_governors(OutArchive& out, const run::StepState& start);
void restore_governors(InArchive& in, run::StepState& start);
/// The last state of a transient step in another results folder.
run::StepState start_of_other_run(const run::Job&, const std::string& folder,
                                  const std::string& step);

}  // namespace whirl::steps
