// Nodes of a beam element in any scalar (double, Dual or DualRate): rotation, angular velocity and
// acceleration, and the way from forces and moments to the extended coordinates. Included inside an
// anonymous namespace after shaft_single.inl.
#pragma once

template <class T>
using V3 = Vec3T<T>;

/// Node coordinates, rates and accelerations in any scalar.
template <class T>
struct NodeT {
  const Mat3* chart;
  V3<T> u, t, du, dd, ddu, ddd;
  T phi, dphi, ddphi;
  explicit NodeT(const NodeState& n)
      : chart(n.chart),
        u(n.u),
        t(n.t),
        du(n.du),
        dd(n.dd),
        ddu(n.ddu),
        ddd(n.ddd),
        phi(n.phi),
        dphi(n.dphi),
        ddphi(n.ddphi) {}
};

/// Rotation, angular velocity and acceleration of a node.
template <class T>
struct SectionMotion {
  V3<T> e, d, s2, omega, alpha, w;  // s2 = (e + d)/(1 + e.d)
  V3<T> e2, e3;
  T cphi, sphi;
  explicit SectionMotion(const NodeT<T>& n)
      : e(Vec3(n.chart->col(0))),
        d(e + n.t),
        e2(Vec3(n.chart->col(1))),
        e3(Vec3(n.chart->col(2))) {
    using std::cos;
    using std::sin;
    const T one_plus_cosine = spin_divisor(e, n.t);
    w = spin_form(e, n.t, one_plus_cosine);
    s2 = (e + d) / one_plus_cosine;
    const T s = spin_rate(w, n.dd, n.dphi);
    const T sdot = spin_acceleration(e, w, n.dd, n.ddd, n.ddphi, one_plus_cosine);
    omega = d.cross(n.dd) + s * d;
    alpha = d.cross(n.ddd) + sdot * d + s * n.dd;
    cphi = cos(n.phi);
    sphi = sin(n.phi);
  }
  /// A vector fixed in the node, given by its components in the node's chart at rest.
  V3<T> turn(const Vec3& c) const {
    const V3<T> m =
        (T(c.y()) * cphi - T(c.z()) * sphi) * e2 + (T(c.y()) * sphi + T(c.z()) * cphi) * e3;
    return T(c.x()) * d + m - d.dot(m) * s2;
  }
  V3<T> accel(const V3<T>& r) const { return alpha.cross(r) + omega.cross(omega.cross(r)); }
};

template <class T>
struct ForceOut {
  V3<T> f[2], m[2];  // on u, and moment on omega
  T dissipated{};
};

/// Moment on omega -> (f_d, f_phi): delta theta = d x delta d + (delta phi - w . delta d) d.
template <class T>
std::array<T, 14> to_X(const ForceOut<T>& f, const SectionMotion<T>& m1,
                       const SectionMotion<T>& m2) {
  std::array<T, 14> r;
  const SectionMotion<T>* mo[2] = {&m1, &m2};
  for (int i = 0; i < 2; ++i) {
    const T along = f.m[i].dot(mo[i]->d);
    const V3<T> fd = f.m[i].cross(mo[i]->d) - along * mo[i]->w;
    T* out = r.data() + 7 * i;
    out[0] = f.f[i].x;
    out[1] = f.f[i].y;
    out[2] = f.f[i].z;
    out[3] = fd.x;
    out[4] = fd.y;
    out[5] = fd.z;
    out[6] = along;
  }
  return r;
}
