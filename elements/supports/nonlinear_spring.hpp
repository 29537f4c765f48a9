// Nonlinear springs and dampers between two nodes (second node: ground, housing or another shaft).
//
// ScalarSpring: along one generalized deflection q = b0.X_0 - b1.X_1 with constant b:
//   translation along the unit vector n at points s_i on the nodes' axes:  b_i = (n, s_i n, 0)
//   tilt about the unit vector n across the line e:   q = n.(e x d), b = (0, n x e, 0)
//       (sine of the tilt; the angle in first order)
//   twist: b = (0, 0, 1), whole turns included
// Load on node 0 along b: -(F(q) + D(q) q'), opposite on node 1. F, D: force curves, N and N s/m (N
// m, N m s for angles).
//
// RadialSpring: central in the lateral plane, r relative displacement in (y, z), rho = |r|:
//   force on node 0 = -(F(rho)/rho) r - D(rho) v,
//       F(0) = 0: no direction is preferred at the centre.
//
// Dissipated power D q'^2 >= 0 for D >= 0; F is conservative. A corner in a curve is legal:
// adaptive steps find it. Limits: directions fixed in space, tilts by their sine, no friction.
// Source: Ishida & Yamamoto, Linear and Nonlinear Rotordynamics, 2nd ed., 2012, doi
// 10.1002/9783527651894.
#pragma once
#include <elements/supports/force_curve.hpp>
#include <system/kernel.hpp>

namespace whirl::elements {

template <int W>
struct ScalarSpring {
  static constexpr int n_nodes = 2, width = W;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  /// A torsional spring sees the angles it acts between.
  system::Dependence depends(const system::Context&) const {
    if constexpr (W == 7)
      if (b0[6] != 0.0 || b1[6] != 0.0)
        return {.angle = system::angle_sum(b0[6], -b1[6]), .spin = true};
    return {};
  }

  Vector<W> b0, b1;
  ForceCurvePtr force, damping;  ///< neither null

  /// @pre n (and e of a tilt) are unit vectors; no curve is null.
  static ScalarSpring translation(const Vec3& n, ForceCurvePtr F, ForceCurvePtr D, double s0 = 0,
                                  double s1 = 0);
  static ScalarSpring tilt(const Vec3& n, const Vec3& e, ForceCurvePtr F,
                           ForceCurvePtr D) requires(W == 7);
  static ScalarSpring twist(ForceCurvePtr F, ForceCurvePtr D) requires(W == 7);

  struct Deflection {
    double q, dq;
  };
  Deflection deflection(const system::Nodes<2>& x) const;
  bool cornered() const { return force->cornered(); }
  int region(const system::Nodes<2>& x) const { return force->region(deflection(x).q); }
  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<2 * W>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context&,
                   system::TangentX<2 * W>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context&, system::Energy& e) const;
};

struct RadialSpring {
  static constexpr int n_nodes = 2, width = 3;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{};

  ForceCurvePtr force, damping;  ///< neither null; force(0) = 0

  bool cornered() const { return force->cornered(); }
  int region(const system::Nodes<2>& x) const {
    return force->region((x[0]->u - x[1]->u).tail<2>().norm());
  }
  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<6>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context&, system::TangentX<6>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context&, system::Energy& e) const;
};

extern template struct ScalarSpring<3>;
extern template struct ScalarSpring<7>;

}  // namespace whirl::elements
