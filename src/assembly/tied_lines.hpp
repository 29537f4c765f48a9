// Lines whose turning about their axes is connected.
#pragma once
#include <model/model.hpp>

#include <vector>

namespace whirl::assembly {

/// A joint that passes torque from one line to another.
bool ties_spins(const model::Joint& j);
/// For each line the first of those that gears, couplings and joints turn in proportion to it.
std::vector<std::size_t> tied_lines(const model::Model& m);

}  // namespace whirl::assembly
