// The grid a film is solved on.
#pragma once

namespace whirl::assembly {

/// How a film is solved: points round the circumference; rows over half the length, 0: one profile
/// along the axis; uniform: with one viscosity and, where it ruptures, the condition of Reynolds
/// whatever the law says, to compare with others like that.
struct FilmGrid {
  int points = 0, rows = 0;
  bool uniform = false;
};
template <class Law>
FilmGrid own_grid(const Law& law) {
  return {law.nodes, law.rows, false};
}

}  // namespace whirl::assembly
