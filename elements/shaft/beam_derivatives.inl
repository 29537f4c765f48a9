// Tangents of beam elements by dual numbers: what varies, and how their stiffness changes in a
// motion. Included inside an anonymous namespace after beam_nodes.inl.
#pragma once

/// The node's place, rates or accelerations become variables k to k + 6.
struct VaryPlace {
  template <class D>
  void operator()(NodeT<D>& n, const NodeState& s, int k) const {
    n.u = V3<D>::variable(s.u, k);
    n.t = V3<D>::variable(s.t, k + 3);
    n.phi = D::variable(s.phi, k + 6);
  }
};
struct VaryRate {
  template <class D>
  void operator()(NodeT<D>& n, const NodeState& s, int k) const {
    n.du = V3<D>::variable(s.du, k);
    n.dd = V3<D>::variable(s.dd, k + 3);
    n.dphi = D::variable(s.dphi, k + 6);
  }
};
struct VaryAcceleration {
  template <class D>
  void operator()(NodeT<D>& n, const NodeState& s, int k) const {
    n.ddu = V3<D>::variable(s.ddu, k);
    n.ddd = V3<D>::variable(s.ddd, k + 3);
    n.ddphi = D::variable(s.ddphi, k + 6);
  }
};

/// Adds the forces of a beam, their stiffness, and the rates of both as its nodes move.
template <class Beam>
void differentiate_in_motion(const Beam& beam, const Nodes<2>& x, const Nodes<2>& rate,
                             system::StiffnessRateX<14>& out) {
  using D = DualRate<14>;
  const auto moving = [](const Vec3& v, const Vec3& dv, int k) {
    return V3<D>(D::variable(v.x(), dv.x(), k), D::variable(v.y(), dv.y(), k + 1),
                 D::variable(v.z(), dv.z(), k + 2));
  };
  NodeT<D> n[2] = {NodeT<D>(*x[0]), NodeT<D>(*x[1])};
  for (int i = 0; i < 2; ++i) {
    const auto a = static_cast<std::size_t>(i);
    n[i].u = moving(x[a]->u, rate[a]->u, 7 * i);
    n[i].t = moving(x[a]->t, rate[a]->t, 7 * i + 3);
    n[i].phi = D::variable(x[a]->phi, rate[a]->phi, 7 * i + 6);
  }
  const SectionMotion<D> m1(n[0]), m2(n[1]);
  const auto f = to_X(beam_force(beam, n[0], n[1], m1, m2), m1, m2);
  for (int k = 0; k < 14; ++k) {
    const D& r = f[static_cast<std::size_t>(k)];
    out.f[k] += r.v;
    out.df[k] += r.e;
    out.K.row(k) += r.g.transpose();
    out.dK.row(k) += r.h.transpose();
  }
}
