// Spin about the section's own normal in director form, with its derivatives: what polar inertia,
// films and internal damping share. s = phi' - w(d).d' (system/spin.inl). Lagrange's equation of T
// = 1/2 Jp s^2 is, after projection to the sphere's tangent plane,
//   L_phi = h', L_d = -h' w - h d x d',  h = Jp s: on the sphere curl w = d + (a part along e x d
//   that cancels), so
// (W - W^T) d' = d x d' there.
#pragma once
#include <system/node.hpp>

namespace whirl::system {

/// Spin and its gradients with respect to (phi', d', d).
struct Spin {
  Vec3 e, w;
  double D;  ///< 1 + e.d
  double s;  ///< rad/s
  Vec3 s_d;  ///< ds/dd; ds/dd' = -w, ds/dphi' = 1
  explicit Spin(const NodeState& n) : e(n.e()), D(of_one::spin_divisor(e, n.t)) {
    w = of_one::spin_form(e, n.t, D);
    s = of_one::spin_rate(w, n.dd, n.dphi);
    s_d = (e.cross(n.dd) + w.dot(n.dd) * e) / D;
  }
  /// W = dw/dd
  Mat3 W() const { return (skew(e) - w * e.transpose()) / D; }
};

/// Spin acceleration s' with its gradients; ds'/dphi'' = 1, ds'/dd'' = -w.
struct SpinRate : Spin {
  double sdot;   ///< rad/s2
  Vec3 sdot_dd;  ///< ds'/dd'
  Vec3 sdot_d;   ///< ds'/dd
  explicit SpinRate(const NodeState& n) : Spin(n) {
    const double wd = w.dot(n.dd), ed = e.dot(n.dd);
    sdot = of_one::spin_acceleration(e, w, n.dd, n.ddd, n.ddphi, D);
    sdot_dd = (ed * w + wd * e) / D;
    sdot_d =
        (e.cross(n.ddd) + w.dot(n.ddd) * e) / D + (ed / (D * D)) * (n.dd.cross(e) - 2.0 * wd * e);
  }
};

}  // namespace whirl::system
