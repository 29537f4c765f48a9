// Body of the rollers' kernels; see roller_lanes.hpp. Included by one .cpp per instruction set, which
// defines WHIRL_LANES_TABLE (name of the function that returns the table) and WHIRL_LANES_ISA (its
// label). Everything here has internal linkage.
#include <elements/rolling/roller_lanes.hpp>
#include <math.h>
#include <string.h>

namespace whirl::elements::roller_lanes {
namespace {

#include <core/lanes.inl>

/// A number of x^(-1/9) to 5 %, from the exponent and the first digits of x > 0: the upper half of
/// the bits of a double is nearly linear in its logarithm.
WHIRL_INLINE T ninth_root_guess(T x) {
  // an integer below 2^52 as the last digits of a double, and back
  constexpr double carrier = 4503599627370496.0;  // 2^52
  constexpr double one = 1191820386.0;            // 10/9 of the upper half of 1.0, centred
  T bits;
  Mask upper;
  memcpy(&upper, &x, sizeof x);
  upper = (upper >> 32) | 0x4330000000000000LL;
  memcpy(&bits, &upper, sizeof bits);
  bits = all(one + carrier) - (bits - carrier) * (1.0 / 9.0);
  memcpy(&upper, &bits, sizeof upper);
  upper <<= 32;
  memcpy(&bits, &upper, sizeof bits);
  return bits;
}

/// x^(1/9), right to about the last digit. With e = 1 - x r^9: x^(-1/9) = r (1 - e)^(-1/9), and from the
/// better r, whose e is below 1e-4, x^(1/9) = z (1 - e)^(-8/9) with z = x r^8. A relative error of z
/// enters e too, and leaves a ninth of itself.
/// @pre x not below 1e-300.
WHIRL_INLINE T ninth_root(T x) {
  T r = ninth_root_guess(x);
  T r2 = r * r, r4 = r2 * r2;
  T e = 1.0 - (x * r) * (r4 * r4);
  r += (r * e) *
       (1.0 / 9.0 +
        e * (5.0 / 81.0 + e * (95.0 / 2187.0 + e * (665.0 / 19683.0 + e * (4921.0 / 177147.0)))));
  r2 = r * r;
  r4 = r2 * r2;
  const T z = x * (r4 * r4);
  e = 1.0 - z * r;
  return z + (z * e) * (8.0 / 9.0 + e * (68.0 / 81.0 + e * (1768.0 / 2187.0)));
}

void evaluate(const Slices& of, const double* rho, const double* t, Loads& out) {
  constexpr double least = 1e-300;  // m: nothing touches
  const double slice = of.length / of.count, end = -0.5 * (of.length - slice);
  for (int first = 0; first < together; first += width) {
    const T approach = *(const Unaligned*)(rho + first) - of.clearance;
    const T tilt = *(const Unaligned*)(t + first);
    T energy{}, force{}, moment{}, slope0{}, slope1{}, slope2{};
    for (int i = 0; i < of.count; ++i) {
      const double s = end + i * slice;
      const T delta = approach + s * tilt;
      const Mask touches = delta > all(least);
      if (every(~touches)) continue;
      const T pressed = touches ? delta : all(1.0);
      T dQ = of.stiffness * ninth_root(pressed);
      dQ = touches ? dQ : T{};
      const T Q = 0.9 * dQ * pressed;
      energy += (9.0 / 19.0) * Q * pressed;
      force += Q;
      moment += s * Q;
      slope0 += dQ;
      slope1 += s * dQ;
      slope2 += (s * s) * dQ;
    }
    *(Unaligned*)(out.energy + first) = energy;
    *(Unaligned*)(out.force + first) = force;
    *(Unaligned*)(out.moment + first) = moment;
    *(Unaligned*)(out.slope[0] + first) = slope0;
    *(Unaligned*)(out.slope[1] + first) = slope1;
    *(Unaligned*)(out.slope[2] + first) = slope2;
  }
}

constexpr Kernels table = {WHIRL_LANES_ISA, evaluate};

}  // namespace

const Kernels* WHIRL_LANES_TABLE() { return &table; }

}  // namespace whirl::elements::roller_lanes
