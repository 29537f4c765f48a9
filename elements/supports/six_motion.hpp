// Relative motion of two points in (x, y, z, rx, ry, rz), and the energies of what is linear in it:
// what linear and tabulated bearings act on.
//   q = q_0 - q_1,
//       q_i = (u + s (d - e0), phi, e0 x d along e2, e3) at points s from the nodes along their
//       axes.
// The tilts are the director components (sin of the tilt angle, equal to gamma2 and gamma3 in first
// order), so q is linear in X; spring_block.hpp has the exact angle. x, y, z are the columns of
// `axes` (e0, e2, e3; usually the global axes).
#pragma once
#include <system/kernel.hpp>

namespace whirl::elements {

class SixMotion {
 public:
  SixMotion() : SixMotion(0, 0) {}
  /// s0, s1: m; axes: orthonormal, global axes.
  SixMotion(double s0, double s1, const Mat3& axes = Mat3::Identity())
      : axes_(axes),
        S0_(map(s0)),
        S1_(map(s1)) {}

  struct Relative {
    Vector<6> q, v, a;
  };  ///< q less the setpoint
  Relative relative(const system::Nodes<2>& x, const Vector<6>& setpoint) const {
    const auto gather = [](const Vec3& u, const Vec3& d, double phi) {
      Vector<7> X;
      X << u, d, phi;
      return X;
    };
    const system::NodeState &a = *x[0], &b = *x[1];
    const Vec3 e0 = axes_.col(0);
    // d - e0, exact for small tilt in a chart that has not been moved; whole turns count
    Relative r;
    r.q = S0_ * gather(a.u, a.t + (a.e() - e0), a.phi) -
          S1_ * gather(b.u, b.t + (b.e() - e0), b.phi) - setpoint;
    r.q[3] += two_pi * (a.turns - b.turns);
    r.v = S0_ * gather(a.du, a.dd, a.dphi) - S1_ * gather(b.du, b.dd, b.dphi);
    r.a = S0_ * gather(a.ddu, a.ddd, a.ddphi) - S1_ * gather(b.ddu, b.ddd, b.ddphi);
    return r;
  }
  /// dq/dX
  Matrix<6, 14> B() const {
    Matrix<6, 14> m;
    m << S0_, -S1_;
    return m;
  }
  /// Adds load F on node 0's point (along `axes`; N, N m) and its opposite on node 1's to the left
  /// side.
  void add_load(const Vector<6>& F, system::ForceX<14>& f) const {
    f.head<7>().noalias() -= S0_.transpose() * F;
    f.tail<7>().noalias() += S1_.transpose() * F;
  }

 private:
  using S = Matrix<6, 7>;  ///< dq_i/dX_i
  S map(double s) const {
    // rows along the axes; e0 x d has the components -d.e3 along e2 and d.e2 along e3
    S m = S::Zero();
    m.topLeftCorner<3, 3>() = axes_.transpose();
    m.block<3, 3>(0, 3) = s * axes_.transpose();
    m(3, 6) = 1.0;
    m.block<1, 3>(4, 3) = -axes_.col(2).transpose();
    m.block<1, 3>(5, 3) = axes_.col(1).transpose();
    return m;
  }

  Mat3 axes_;
  S S0_, S1_;
};

/// Energies of a linear spring, damper and mass in relative coordinates; skew parts of K and M as
/// supplied power.
template <int N>
void add_linear_energy(const Matrix<N>& K, const Matrix<N>& C, const Matrix<N>& M,
                       const Vector<N>& preload, const Vector<N>& q, const Vector<N>& v,
                       const Vector<N>& a, system::Energy& e) {
  const Vector<N> Kq = K * q, Ma = M * a;
  e.elastic += 0.5 * q.dot(Kq);
  e.kinetic += 0.5 * v.dot(M * v);
  e.dissipated += v.dot(C * v);
  e.supplied +=
      preload.dot(v) + 0.5 * (v.dot(K.transpose() * q - Kq) + v.dot(M.transpose() * a - Ma));
}

}  // namespace whirl::elements
