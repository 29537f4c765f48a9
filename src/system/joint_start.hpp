// Coordinates of joints for nodes that are given: the start of a motion.
#pragma once
#include <system/system.hpp>
#include <string>

namespace whirl::system {

/// Sets the joints' own coordinates and their rates so that followers stand and move as x has them,
/// by least squares (Gauss-Newton), and then puts followers exactly where their joints do. Returns
/// the joint that does not fit, within 1e-6 of the model and its speeds, or nothing.
std::string fit_joints(const System& system, State& x);

}  // namespace whirl::system
