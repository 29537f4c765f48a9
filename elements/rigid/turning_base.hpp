// What turning of the base adds to the inertia of an element: manoeuvres of a vehicle, seen in axes
// fixed to the base.
//
// The base turns about an axis fixed in it and in space: angular velocity omega = rate(t) n through
// the point `about`, angle the integral of the rate from 0. Displacements, directors and spins stay
// relative to the base; bearings stand on it. An element of kernel K has, in inertial axes that
// coincide with the base's at the instant,
//   u_abs' = u' + omega x r,   u_abs'' = u'' + 2 omega x u' + omega x (omega x r) + omega' x r,
//       r = reference + u - about
// (directors alike, with r = d), and with w = (e x d)/(1 + e.d) of the spin s = phi' - w.d'
//   s_abs = s + omega.d,   phi_abs' = phi' + omega.(e + d)/(1 + e.d),
//       phi_abs'' from s_abs' = s' + omega'.d + omega.d'.
// The weight turns against the base. Added is f_K(absolute) - f_K(relative), exactly: Coriolis,
// centrifugal and Euler forces, and gyroscopic moments Ip Omega omega. Its power is counted as
// supplied. One template for every inertia, so that scenes without a turning base carry nothing of
// it. Internal masses of supports (stators of rubs, added fluid masses) do not take part.
#pragma once
#include <core/law.hpp>
#include <system/kernel.hpp>
#include <cmath>
#include <memory>

namespace whirl::elements {

struct TurningBase {
  Vec3 axis = Vec3::UnitY();    ///< unit vector n
  Vec3 about = Vec3::Zero();    ///< m, global axes
  LawPtr rate;                  ///< rad/s
  Vec3 gravity = Vec3::Zero();  ///< weight's acceleration at angle 0, m/s^2

  struct Motion {
    Vec3 omega, alpha, gravity_change;
  };
  /// At time t; gravity_change: g(0) - g in axes of the base, m/s^2.
  Motion at(double t) const {
    const LawValue v = rate->at(t);
    const double angle = rate->integral(t), h = std::sin(0.5 * angle);
    // g - R(-angle) g = sin(angle) n x g - 2 sin^2(angle/2) n x (n x g)
    const Vec3 ng = axis.cross(gravity);
    return {v.f * axis, v.df * axis, std::sin(angle) * ng - 2.0 * h * h * axis.cross(ng)};
  }
};
using TurningBasePtr = std::shared_ptr<const TurningBase>;

/// The state of a node seen from inertial axes, and its derivatives in the relative one.
struct AbsoluteNode {
  system::NodeState state;
  Matrix<7> rate_position;   ///< d X_abs'/d X; d X_abs'/d X' = 1
  Matrix<7> accel_rate;      ///< d X_abs''/d X'
  Matrix<7> accel_position;  ///< d X_abs''/d X
  AbsoluteNode(const system::NodeState& n, const TurningBase::Motion& b, double load,
               const Vec3& arm);
  void derive(const system::NodeState& n, const TurningBase::Motion& b);
};

template <class K>
struct OnTurningBase {
  static constexpr int n_nodes = K::n_nodes, width = K::width;
  static constexpr system::Axes axes = system::axes_of<K>();
  static constexpr bool has_M = false, has_C = true, has_K = true, quadratic_in_rates = true;
  static constexpr system::Family family = system::Family::body;
  /// As the inertia in its kernel, and on time: a twist is elastic and cancels, and so does a
  /// common acceleration. While the base stands and has not turned, nothing is added.
  system::Dependence depends(const system::Context& c) const {
    system::Dependence d = system::dependence_of(kernel, c);
    const TurningBase::Motion b = base->at(c.time);
    const bool stands = b.omega.isZero(0.0) && b.alpha.isZero(0.0) && b.gravity_change.isZero(0.0);
    if (stands || d.angle.form == system::SeenAngle::Form::sum) d.angle = system::no_angle;
    d.time = true;
    d.weight = false;
    return d;
  }

  K kernel;
  TurningBasePtr base;
  std::array<Vec3, n_nodes> reference;  ///< of the nodes, from base->about, m

  OnTurningBase(const K& k, TurningBasePtr b, const std::array<Vec3, n_nodes>& position)
      : kernel(k),
        base(std::move(b)),
        reference(position) {
    for (Vec3& r : reference)
      r -= base->about;
  }

  void add_force(const system::Nodes<n_nodes>& x, const system::Context& c,
                 system::ForceX<n_nodes * width>& f) const {
    const TurningBase::Motion b = base->at(c.time);
    std::array<system::NodeState, n_nodes> states;
    system::Nodes<n_nodes> absolute;
    for (int i = 0; i < n_nodes; ++i) {
      states[i] = AbsoluteNode(*x[i], b, c.load, reference[i]).state;
      absolute[i] = &states[i];
    }
    system::ForceX<n_nodes* width> relative = system::ForceX<n_nodes * width>::Zero();
    kernel.add_force(x, c, relative);
    kernel.add_force(absolute, c, f);
    f -= relative;
  }

  void add_tangent(const system::Nodes<n_nodes>& x, const system::Context& c,
                   system::TangentX<n_nodes * width>& t) const {
    constexpr int W = width;
    const TurningBase::Motion b = base->at(c.time);
    std::array<system::NodeState, n_nodes> states;
    system::Nodes<n_nodes> absolute;
    system::TangentX<n_nodes * W> a, r;
    a.set_zero();
    r.set_zero();
    Matrix<n_nodes*W> rate_position = Matrix<n_nodes * W>::Zero(), accel_rate = rate_position,
                      accel_position = rate_position;
    for (int i = 0; i < n_nodes; ++i) {
      AbsoluteNode n(*x[i], b, c.load, reference[i]);
      n.derive(*x[i], b);
      states[i] = n.state;
      absolute[i] = &states[i];
      rate_position.template block<W, W>(W * i, W * i) =
          n.rate_position.template topLeftCorner<W, W>();
      accel_rate.template block<W, W>(W * i, W * i) = n.accel_rate.template topLeftCorner<W, W>();
      accel_position.template block<W, W>(W * i, W * i) =
          n.accel_position.template topLeftCorner<W, W>();
    }
    kernel.add_tangent(absolute, c, a);
    kernel.add_tangent(x, c, r);
    t.C += a.C - r.C + a.M * accel_rate;
    t.K += a.K - r.K + a.C * rate_position + a.M * accel_position;
  }

  void add_energy(const system::Nodes<n_nodes>& x, const system::Context& c,
                  system::Energy& e) const {
    system::ForceX<n_nodes* width> f = system::ForceX<n_nodes * width>::Zero();
    add_force(x, c, f);
    for (int i = 0; i < n_nodes; ++i) {
      e.supplied -= f.template segment<3>(width * i).dot(x[i]->du);
      if constexpr (width == 7)
        e.supplied -=
            f.template segment<3>(width * i + 3).dot(x[i]->dd) + f[width * i + 6] * x[i]->dphi;
    }
  }

  std::vector<double> breakpoints() const { return base->rate->breakpoints(); }
};

}  // namespace whirl::elements
