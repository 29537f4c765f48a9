// Unbalance: the static moment U = mass x eccentricity of the station's bodies, turning with them.
// One node, or two: a slice of shaft too light to bear the moment has the place of its own node (u, d,
// the first) and the direction b of a heavier one beside it (the second); what the shaft twists and
// bends between them is left out of b alone.
//   T = U (u + o d)'.b',  b = P(d <- e)(cos(phi + beta) e2 + sin(phi + beta) e3);  potential -U g.b
//   f_u = U b'',  f_d = U o b'',  (f_d, f_phi) += U (db/d(d, phi))^T (u'' + o d'' - g)
// Exact at any amplitude: a body of given mass, given inertia about the node and static moment U,
// in force, moment, torque and gravity. U(t) = amount factor(t): mass that comes or goes moves with
// the body and carries its own energy (counted as supplied power), so a step factor is a blade loss
// without impulse. amount kg m; beta rad, body angle at phi = 0 from e2 towards e3; factor
// dimensionless, null = 1; offset o: the station from the node along d, m.
#pragma once
#include <core/law.hpp>
#include <system/kernel.hpp>
#include <system/rigid_inertia.hpp>

namespace whirl::elements {

template <int N>
struct UnbalanceOn {
  static_assert(N == 1 || N == 2);
  static constexpr int n_nodes = N, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = true, has_C = true, has_K = true, quadratic_in_rates = true,
                        inertial = true, linear_in_displacements = true;
  static constexpr system::Family family = system::Family::load;
  /// Sees the angle while there is an unbalance.
  system::Dependence depends(const system::Context& c) const {
    return {.angle = at(c.time) != 0.0 ? system::each_angle : system::no_angle,
            .spin = true,
            .time = varies(factor),
            .weight = true};
  }

  double amount = 0, cos_beta = 1, sin_beta = 0;
  LawPtr factor;
  double offset = 0;

  UnbalanceOn() = default;
  UnbalanceOn(double U, double beta, LawPtr law = nullptr, double o = 0);
  /// kg m at time t
  double at(double t) const { return factor ? amount * factor->at(t).f : amount; }

  void add_force(const system::Nodes<N>& x, const system::Context& c,
                 system::ForceX<7 * N>& f) const;
  void add_tangent(const system::Nodes<N>& x, const system::Context& c,
                   system::TangentX<7 * N>& t) const;
  void add_energy(const system::Nodes<N>& x, const system::Context& c, system::Energy& e) const;
  std::vector<double> breakpoints() const { return breakpoints_of(factor); }
  system::RigidInertia inertia(double time) const requires(N == 1);
};
using UnbalanceMass = UnbalanceOn<1>;
using LightUnbalance = UnbalanceOn<2>;
extern template struct UnbalanceOn<1>;
extern template struct UnbalanceOn<2>;

}  // namespace whirl::elements
