// The states transient steps start from: steady responses, modes, other runs; and their governors.
#pragma once
#include <app/job.hpp>

namespace whirl::app {

/// Moves a start into the steady response to the unbalance at its speed; adds the whirl mode that the step names.
void start_in_unbalance_response(const Job&, StepState& start);
void start_in_mode(const Job&, StepState& start, const model::TransientStep&);
/// Lets the governors of the step begin: where those of the start did that acted before, the others here, without a jump of their torque.
void begin_governors(const Job&, StepState& start);
/// The part of a checkpoint that says where they began.
inline constexpr const char* governors_part = "governors";
void save_governors(OutArchive& out, const StepState& start);
void restore_governors(InArchive& in, StepState& start);
/// The last state of a transient step in another results folder.
StepState start_of_other_run(const Job&, const std::string& folder, const std::string& step);

}  // namespace whirl::app
