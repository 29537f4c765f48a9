// Viscous damping of the axisymmetric shaft element, proportional to its stiffness: on strain rates
// as seen in a frame that turns with the section (internal, rotating damping) or does not
// (external, non-rotating damping).
//
// p_i: rotation-like vector from the chord a towards the director d_i, |p_i| = theta_i,
// perpendicular to a. Its rate is
//   p_i o = p_i' - (a x a' + c sigma a) x p_i,   c = 1 rotating, 0 not,
//       sigma = (sigma_1 + sigma_2)/2,
//   sigma_i = (a + d_i).(omega_i - a x a')/(1 + a.d_i): the spin of end i about the chord.
// f = dP^T (beta k) p o with p o = P(X) X', so the power lost, beta p o^T k p o, is never negative;
// a rigidly turning bent shaft loses nothing when rotating, and feeds the forward whirl above
// omega_crit (1 + c_ext/c_int) as it must (Kimball 1924). The rate of twist, sigma_2 - sigma_1, and
// of the chord length l' are damped likewise.
//
// Parameters: d11, d12, d22 = beta (k11, k12, k22), N m s; d_twist = beta_t GJ_l, N m s; d_axial =
// beta EA_l, N s/m. Sources: Sorokin & Zhang 2018 (kinematics); Kimball 1924; objective rate
// checked against rigid spin in the tests.
#pragma once
#include <elements/shaft/shaft_beam.hpp>

namespace whirl::elements {

template <bool Rotating>
struct ShaftDamping {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = system::Axes::common;
  static constexpr bool has_M = false, has_C = true, has_K = true, quadratic_in_rates = true;
  static constexpr system::Family family = system::Family::damping;
  system::Dependence depends(const system::Context&) const {
    return {.spin = Rotating || d_twist != 0.0};
  }

  double length = 0, o1 = 0, o2 = 0;
  Vec3 e0 = Vec3::UnitX();
  double d11 = 0, d12 = 0, d22 = 0, d_twist = 0, d_axial = 0;

  ShaftDamping() = default;
  ShaftDamping(const ShaftElementConstants& c, const Vec3& direction, double beta_bending,
               double beta_torsion, double beta_axial);
  void add_force(const system::Nodes<2>& x, const system::Context& ctx,
                 system::ForceX<14>& f) const;
  /// All elements of a batch, several at a time (shaft_lanes.hpp).
  static void add_forces(std::span<const ShaftDamping> elements, const std::array<Index, 2>* nodes,
                         const system::NodeState* states, const system::Context& ctx,
                         Vector<7>* force);
  void add_tangent(const system::Nodes<2>& x, const system::Context& ctx,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& ctx, system::Energy& e) const;
};

extern template struct ShaftDamping<false>;
extern template struct ShaftDamping<true>;

/// External damping proportional to the element's mass, in fixed axes: f = alpha (M4 (x) 1) X'.
/// 1/s.
struct ShaftMassDamping {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = false, has_C = true, has_K = false, quadratic_in_rates = true;
  static constexpr system::Family family = system::Family::damping;
  static constexpr system::Dependence depends{};
  Matrix<4> C4 = Matrix<4>::Zero();  ///< alpha M4
  void add_force(const system::Nodes<2>& x, const system::Context& ctx,
                 system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& ctx,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& ctx, system::Energy& e) const;
};

}  // namespace whirl::elements
