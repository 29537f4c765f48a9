// Two-node kernel for everything that acts between a journal and its housing in the lateral plane
// and may depend on spin: films, tabulated bearings, seals, rub. The physics is a Law of the
// relative motion; this header carries it to the nodes.
//
// Nodes: 0 = journal (shaft), 1 = housing (pedestal, casing, second shaft, or a ground node). The
// shaft line runs along +x; the lateral plane is the fixed (y, z). With p_i = u_i + o_i d_i (o:
// axial offset of the acting point on a rigid stub, m)
//   r = (p_0 - p_1)_yz,  v = r',  a = r'',  s_i = spin of node i about its own normal d_i (rotor
//   spins y -> z for s > 0).
// A law gives z = (F_y, F_z, T_0, T_1): force on the journal (minus it on the housing) and torques
// about d_0 and d_1. With w = spin form of a node (s = phi' - w.d') the virtual work F.dr + sum T_i
// (dphi_i - w_i.dd_i) gives the entries of the left side: f_u0 = -F, f_u1 = F, f_phi = -T, f_d = T
// w -+ o F. Power delivered to the nodes: F.v + T_0 s_0 + T_1 s_1. The tangents are exact,
// including those of w, of s with respect to (phi', d', d), and of the torques.
//
//   struct Law {
//     static constexpr bool inertia = false;                           // force depends on a
//     static constexpr system::Dependence depends{.spin = true};       // as in a kernel
//     void force(const LateralMotion&, Vector<4>& z) const;            // sets z
//     void tangent(const LateralMotion&, Vector<4>& z, LateralTangent& t) const;   // sets z and t
//     void energy(const LateralMotion&, Energy&) const;                // adds
//     int region(const LateralMotion&) const;                          // optional: smooth piece of
//     a force with corners
//   };
#pragma once
#include <system/kernel.hpp>
#include <system/spin.hpp>

namespace whirl::elements {

/// Motion of the journal point relative to the housing point, (y, z).
struct LateralMotion {
  Vec2 r, v, a;                                 ///< m, m/s, m/s2
  double spin = 0, housing_spin = 0;            ///< rad/s
  double spin_rate = 0, housing_spin_rate = 0;  ///< rad/s2, set for energy() only
  double frequency = nan;                       ///< rad/s, Context::frequency
};

/// Derivatives of z = (F_y, F_z, T_0, T_1).
struct LateralTangent {
  Matrix<4, 2> r, v, a;
  Vector<4> spin, housing_spin;
  void set_zero() {
    r.setZero();
    v.setZero();
    a.setZero();
    spin.setZero();
    housing_spin.setZero();
  }
};

template <class Law_, bool Offsets = false>
struct LateralJoint {
  using Law = Law_;
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = Offsets ? system::Axes::own : system::Axes::any;
  static constexpr bool has_M = Law::inertia, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  system::Dependence depends(const system::Context& c) const {
    return system::dependence_of(law, c);
  }

  Law law;
  std::array<double, 2> offset{0.0, 0.0};  ///< o_0, o_1, m (used when Offsets)

  void add_force(const system::Nodes<2>& x, const system::Context& c, system::ForceX<14>& f) const {
    const system::Spin s0(*x[0]), s1(*x[1]);
    LateralMotion m = motion(x, c);
    m.spin = s0.s;
    m.housing_spin = s1.s;
    Vector<4> z;
    law.force(m, z);
    scatter(s0.w, s1.w, z, f);
  }

  void add_tangent(const system::Nodes<2>& x, const system::Context& c,
                   system::TangentX<14>& k) const {
    const system::Spin s0(*x[0]), s1(*x[1]);
    LateralMotion m = motion(x, c);
    m.spin = s0.s;
    m.housing_spin = s1.s;
    Vector<4> z;
    LateralTangent t;
    law.tangent(m, z, t);
    Matrix<4, 14> y;
    spread(t.v, y);
    y.template middleCols<3>(3).noalias() -= t.spin * s0.w.transpose();
    y.col(6) += t.spin;
    y.template middleCols<3>(10).noalias() -= t.housing_spin * s1.w.transpose();
    y.col(13) += t.housing_spin;
    scatter(s0.w, s1.w, y, k.C);
    spread(t.r, y);
    y.template middleCols<3>(3).noalias() += t.spin * s0.s_d.transpose();
    y.template middleCols<3>(10).noalias() += t.housing_spin * s1.s_d.transpose();
    scatter(s0.w, s1.w, y, k.K);
    k.K.template block<3, 3>(3, 3) += z[2] * s0.W();
    k.K.template block<3, 3>(10, 10) += z[3] * s1.W();
    if constexpr (has_M) {
      spread(t.a, y);
      scatter(s0.w, s1.w, y, k.M);
    }
  }

  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const {
    const system::SpinRate s0(*x[0]), s1(*x[1]);
    LateralMotion m = motion(x, c);
    m.spin = s0.s;
    m.housing_spin = s1.s;
    m.spin_rate = s0.sdot;
    m.housing_spin_rate = s1.sdot;
    law.energy(m, e);
  }

  bool cornered() const requires requires(const Law& l, const LateralMotion& m) { l.region(m); }
  { return true; }
  int region(const system::Nodes<2>& x) const requires
      requires(const Law& l, const LateralMotion& m) {
    l.region(m);
  }
  { return law.region(motion(x, {})); }

  /// Relative motion with spins, for results.
  LateralMotion motion_of(const system::Nodes<2>& x, const system::Context& c) const {
    LateralMotion m = motion(x, c);
    m.spin = x[0]->spin();
    m.housing_spin = x[1]->spin();
    return m;
  }

 private:
  LateralMotion motion(const system::Nodes<2>& x, const system::Context& c) const {
    const system::NodeState &n = *x[0], &h = *x[1];
    LateralMotion m;
    m.frequency = c.frequency;
    m.r = (n.u - h.u).template tail<2>();
    m.v = (n.du - h.du).template tail<2>();
    if constexpr (has_M) m.a = (n.ddu - h.ddu).template tail<2>();
    if constexpr (Offsets) {
      m.r += (offset[0] * n.t - offset[1] * h.t).template tail<2>();
      m.v += (offset[0] * n.dd - offset[1] * h.dd).template tail<2>();
      if constexpr (has_M) m.a += (offset[0] * n.ddd - offset[1] * h.ddd).template tail<2>();
    }
    return m;
  }
  /// y = g dr/dx
  void spread(const Matrix<4, 2>& g, Matrix<4, 14>& y) const {
    y.setZero();
    y.template middleCols<2>(1) = g;
    y.template middleCols<2>(8) = -g;
    if constexpr (Offsets) {
      y.template middleCols<2>(4) = offset[0] * g;
      y.template middleCols<2>(11) = -offset[1] * g;
    }
  }
  /// out += -B^T y, B the map from X' to (v, s_0, s_1).
  template <class Y, class Out>
  void scatter(const Vec3& w0, const Vec3& w1, const Y& y, Out& out) const {
    out.template middleRows<2>(1) -= y.template topRows<2>();
    out.template middleRows<2>(8) += y.template topRows<2>();
    out.row(6) -= y.row(2);
    out.row(13) -= y.row(3);
    out.template middleRows<3>(3).noalias() += w0 * y.row(2);
    out.template middleRows<3>(10).noalias() += w1 * y.row(3);
    if constexpr (Offsets) {
      out.template middleRows<2>(4) -= offset[0] * y.template topRows<2>();
      out.template middleRows<2>(11) += offset[1] * y.template topRows<2>();
    }
  }
};

}  // namespace whirl::elements
