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
#include <array>

namespace whirl::elements {

/// Motion of the journal point relative to the housing point, (y, z).
struct LateralMotion {
  Vec2 r, v, a;                                 ///< m, m/s, m/s2
  double spin = 0, housing_spin = 0;            ///< rad/s
  double spin_rate = 0, housing_spin_rate = 0;  ///< rad/s2, set for energy() only
  double frequency = nan;                       ///< rad/s, Context::frequency
  const double* kept = nullptr;                 ///< what elements keep (system::NodeState::kept)
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

/// How every law is carried to the nodes. Offsets: the points stand off the nodes.
template <bool Offsets>
struct LateralLink {
  using Nodes = system::Nodes<2>;
  using Spins = std::array<system::Spin, 2>;
  std::array<double, 2> offset;  ///< o_0, o_1, m

  /// With the spins; accelerations: r'' too.
  LateralMotion motion(const Nodes& x, const system::Context& c, const Spins& s,
                       bool accelerations) const;
  /// f += the left side of z.
  void add_force(const Spins& s, const Vector<4>& z, system::ForceX<14>& f) const;
  /// k += its derivatives; inertia: M too.
  void add_tangent(const Spins& s, const Vector<4>& z, const LateralTangent& t, bool inertia,
                   system::TangentX<14>& k) const;
};

extern template struct LateralLink<false>;
extern template struct LateralLink<true>;

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
    const Spins s = spins(x);
    Vector<4> z;
    law.force(link().motion(x, c, s, has_M), z);
    link().add_force(s, z, f);
  }

  void add_tangent(const system::Nodes<2>& x, const system::Context& c,
                   system::TangentX<14>& k) const {
    const Spins s = spins(x);
    Vector<4> z;
    LateralTangent t;
    law.tangent(link().motion(x, c, s, has_M), z, t);
    link().add_tangent(s, z, t, has_M, k);
  }

  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const {
    const system::SpinRate s0(*x[0]), s1(*x[1]);
    LateralMotion m = link().motion(x, c, {s0, s1}, has_M);
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
  { return law.region(motion_of(x, {})); }

  /// Relative motion with spins, for results.
  LateralMotion motion_of(const system::Nodes<2>& x, const system::Context& c) const {
    return link().motion(x, c, spins(x), has_M);
  }

 private:
  using Link = LateralLink<Offsets>;
  using Spins = typename Link::Spins;
  Link link() const { return {offset}; }
  static Spins spins(const system::Nodes<2>& x) {
    return {system::Spin(*x[0]), system::Spin(*x[1])};
  }
};

}  // namespace whirl::elements
