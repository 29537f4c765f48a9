// The contacts of rollers over their slices, several rollers at a time: one compiler vector holds the
// same quantity of four rollers (two on a baseline machine). Compiled once per instruction set and
// chosen at run time, as the shaft's kernels are (elements/shaft/shaft_lanes.hpp). Only plain data
// crosses this interface.
#pragma once

namespace whirl::elements::roller_lanes {

/// Rollers evaluated together; a multiple of every machine's vector.
inline constexpr int together = 8;

/// The contact of one slice: V = 9/19 Q delta, Q = 9/10 Q' delta, Q' = stiffness delta^(1/9) of
/// delta = rho + s t - clearance where that is positive.
struct Slices {
  double stiffness = 0;  ///< Q' / delta^(1/9): 10/9 of the K of a slice, N/m^(10/9)
  double clearance = 0;  ///< m
  double length = 0;     ///< of all slices together, m: s = length ((i + 1/2)/count - 1/2)
  int count = 0;
};

/// Sums over the slices of every roller.
struct Loads {
  double energy[together];    ///< J
  double force[together];     ///< Q, N
  double moment[together];    ///< s Q, N m
  double slope[3][together];  ///< Q', s Q', s^2 Q'
};

struct Kernels {
  const char* isa;
  /// rho, t: `together` numbers each, m and rad; a roller that is not there has rho = -infinity.
  void (*evaluate)(const Slices&, const double* rho, const double* t, Loads&);
};

/// The best set for the machine the program runs on.
const Kernels& kernels();

const Kernels* base_kernels();
const Kernels* avx2_kernels();    ///< nullptr where not compiled in
const Kernels* avx512_kernels();  ///< nullptr where not compiled in

}  // namespace whirl::elements::roller_lanes
