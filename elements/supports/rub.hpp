// Rub, stop or catcher bearing: one-sided contact of a round journal in a round bore, with Coulomb
// friction.
//
// r: journal centre relative to the bore centre, rho = |r|, n = r/rho, t = J n (quarter turn y ->
// z), delta = rho - gap.
//   N   = k delta (1 + beta rho')   for delta > 0, never negative (no adhesion); 0 otherwise
//       (Hunt & Crossley,
//         J. Appl. Mech. 42, 1975, doi 10.1115/1.3423596, with exponent 1): continuous at touch and
//             at release
//   v_t = v.t + R s_0 - (R + rho) s_1
//       true slip velocity of the surfaces in contact (orbit, spin, bore spin)
//   F   = -N n - mu N tanh(v_t/v_0) t      friction opposes slip, whichever way it goes
//   T_0 = R F.t,  T_1 = -(R + rho) F.t     about the two centres
// Friction power mu N v_t tanh(v_t/v_0) >= 0 and contact damping k beta delta rho'^2 >= 0 (where N
// > 0) are dissipated; k delta^2/2 is stored. With beta > 0 and N cut off at zero the dissipation
// is k delta |rho'|, still positive.
//
// Parameters SI. R: surface radius of the journal, m; v_0: slip velocity within which friction is
// viscous (sticking creeps at most v_0 artanh(F_t/(mu N))). Limits: journal smaller than bore by
// `gap` (gap << R); flat-on-flat axially.
#pragma once
#include <elements/supports/lateral_joint.hpp>

namespace whirl::elements {

struct RubLaw {
  static constexpr bool inertia = false;
  /// The spin enters by friction.
  system::Dependence depends(const system::Context&) const { return {.spin = friction != 0.0}; }
  double gap = 0;            ///< radial, m, >= 0
  double stiffness = 0;      ///< k, N/m
  double damping = 0;        ///< beta, s/m
  double friction = 0;       ///< mu
  double radius = 0;         ///< R, m
  double slip_speed = 1e-3;  ///< v_0, m/s

  void force(const LateralMotion& m, Vector<4>& z) const;
  void tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const;
  void energy(const LateralMotion& m, system::Energy& e) const;
  int region(const LateralMotion& m) const { return m.r.norm() > gap; }
};

using Rub = LateralJoint<RubLaw>;

}  // namespace whirl::elements
