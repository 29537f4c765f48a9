// Unstressed curvature of a straight element, fixed in the turning shaft, that grows or decays: heat
// on one side (a rub, a blocked cooling duct, a stop with hot gas).
//
// With P_i the bending of the ends in section axes (end_bending.inl), k the end stiffness and p_i the
// bending of the unstressed element at amount 1, the element's energy 1/2 P.kP becomes that of P - A
// p by
//   V = -A sum_i s_i.P_i + 1/2 A^2 v,   s = k p,   v = p.kp,   A(t) = end + (start - end)
//       exp(-t/constant)
// A pair of moments that turns with the shaft. dV/dt at a standing shape, A' (A v - sum s.P), is what
// the heat supplies, W. A steady rotation (Context::averaged) knows the end alone. N m.
// Limits: small curvature; the bow itself is a known function of time and does not follow the motion.
// Source: J. C. Nicholas, E. J. Gunter, P. E. Allaire, J. Eng. Power 98 (1976) 171 (residual bow).
#pragma once
#include <elements/shaft/end_axes.hpp>
#include <system/kernel.hpp>

namespace whirl::elements {

struct ThermalBow {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = false, has_C = false, has_K = true, quadratic_in_rates = true;
  static constexpr system::Family family = system::Family::shaft;
  system::Dependence depends(const system::Context& c) const {
    return {.angle = system::each_angle, .time = !c.averaged && growth.varies()};
  }

  EndAxes at;
  Vec2 s1 = Vec2::Zero(), s2 = Vec2::Zero();  ///< s_i along both section axes, N m
  double square = 0;                          ///< v, N m
  Growth growth;                              ///< of A

  double amount(const system::Context& c) const {
    return c.averaged ? growth.end : growth.at(c.time);
  }
  void add_force(const system::Nodes<2>& x, const system::Context& c, system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& c,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const;
};

}  // namespace whirl::elements
