// Given forces and moments at a point of the shaft axis, times a law of time. External: f = -load.
// One node each.
//
// A moment M does the power M.omega, omega = d x d' + s d, s = phi' - w.d'; its part in (d, phi) is
// therefore
//   f_d = -(M x d - (M.d) w),  f_phi = -M.d.
// A fixed moment is not conservative; nor is a load that turns with the body. force N; moment N m;
// offset: point of application from the node along d, m; factor dimensionless, null = 1. Power
// counted as supplied.
#pragma once
#include <core/law.hpp>
#include <system/kernel.hpp>

namespace whirl::elements {

/// Force of fixed direction at the node itself: translations only, no tangent.
struct PointForce {
  static constexpr int n_nodes = 1, width = 3;
  static constexpr bool has_M = false, has_C = false, has_K = false, linear_in_displacements = true;
  static constexpr system::Family family = system::Family::load;
  system::Dependence depends(const system::Context&) const { return {.time = varies(factor)}; }

  Vec3 force = Vec3::Zero();
  LawPtr factor;

  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<3>& f) const;
  void add_tangent(const system::Nodes<1>&, const system::Context&, system::TangentX<3>&) const {}
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const;
  std::vector<double> breakpoints() const { return breakpoints_of(factor); }
};

/// Force and moment of fixed direction (global axes) at an offset point.
struct FixedLoad {
  static constexpr int n_nodes = 1, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = false, has_C = false, has_K = true, quadratic_in_rates = true,
                        linear_in_displacements = true;
  static constexpr system::Family family = system::Family::load;
  system::Dependence depends(const system::Context&) const { return {.time = varies(factor)}; }

  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double offset = 0;
  LawPtr factor;

  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<7>& f) const;
  void add_tangent(const system::Nodes<1>& x, const system::Context& c,
                   system::TangentX<7>& t) const;
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const;
  std::vector<double> breakpoints() const { return breakpoints_of(factor); }
};

/// Force and moment given in body axes (d, b_2, b_3): they turn with tilt and spin (follower
/// loads).
struct BodyLoad {
  static constexpr int n_nodes = 1, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = false, has_C = false, has_K = true, quadratic_in_rates = true,
                        linear_in_displacements = true;
  static constexpr system::Family family = system::Family::load;
  /// Sees the angle while it has a part across the axis.
  system::Dependence depends(const system::Context& c) const;

  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double offset = 0;
  LawPtr factor;

  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<7>& f) const;
  void add_tangent(const system::Nodes<1>& x, const system::Context& c,
                   system::TangentX<7>& t) const;
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const;
  std::vector<double> breakpoints() const { return breakpoints_of(factor); }
};

}  // namespace whirl::elements
