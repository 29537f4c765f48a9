// Where the numbers of a NodeState stand, for kernels compiled once per instruction set: they see
// plain data only (la/lu_kernel.hpp says why). node.hpp asserts every place.
#pragma once

namespace whirl::system {

/// Counted in doubles from the start of a NodeState; vectors take three places.
struct NodePlaces {
  static constexpr int u = 0, du = 3, ddu = 6, t = 9, dd = 12, ddd = 15;
  static constexpr int phi = 18, dphi = 19, ddphi = 20, turns = 21;
  static constexpr int numbers = 22;  ///< that many doubles, then two pointers
  static constexpr int chart = 22;    ///< pointer to the chart's nine numbers, columns e, e2, e3
  static constexpr int kept = 23;     ///< pointer
  static constexpr int size = 24;     ///< from one NodeState to the next
};

}  // namespace whirl::system
