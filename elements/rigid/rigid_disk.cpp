#include <elements/rigid/rigid_disk.hpp>
#include <core/contract.hpp>
#include <system/spin.hpp>

namespace whirl::elements {

using namespace system;

void RigidDisk::add_force(const Nodes<1>& x, const Context&, ForceX<7>& f) const {
  const NodeState& n = *x[0];
  const SpinRate s(n);
  const Vec3 F = mass * (n.ddu + offset * n.ddd);
  f.head<3>() += F;
  f.segment<3>(3) += offset * F + Jt * n.ddd - (Jp * s.sdot) * s.w - (Jp * s.s) * n.d().cross(n.dd);
  f[6] += Jp * s.sdot;
}

void RigidDisk::add_tangent(const Nodes<1>& x, const Context&, TangentX<7>& t) const {
  const NodeState& n = *x[0];
  const SpinRate s(n);
  const Vec3 g = n.d().cross(n.dd);
  const double mz = mass * offset, Jd = Jt + mz * offset;
  for (int i = 0; i < 3; ++i) {
    t.M(i, i) += mass;
    t.M(i, 3 + i) += mz;
    t.M(3 + i, i) += mz;
    t.M(3 + i, 3 + i) += Jd;
  }
  t.M.block<3, 3>(3, 3) += (Jp * s.w) * s.w.transpose();
  t.M.block<3, 1>(3, 6) -= Jp * s.w;
  t.M.block<1, 3>(6, 3) -= Jp * s.w.transpose();
  t.M(6, 6) += Jp;

  t.C.block<3, 3>(3, 3) -=
      Jp * (s.w * s.sdot_dd.transpose() - g * s.w.transpose() + s.s * skew(n.d()));
  t.C.block<3, 1>(3, 6) -= Jp * g;
  t.C.block<1, 3>(6, 3) += Jp * s.sdot_dd.transpose();

  t.K.block<3, 3>(3, 3) -=
      Jp * (s.w * s.sdot_d.transpose() + s.sdot * s.W() + g * s.s_d.transpose() - s.s * skew(n.dd));
  t.K.block<1, 3>(6, 3) += Jp * s.sdot_d.transpose();
}

void RigidDisk::add_energy(const Nodes<1>& x, const Context& c, Energy& e) const {
  const NodeState& n = *x[0];
  const double s = n.spin();
  e.kinetic +=
      0.5 * (mass * (n.du + offset * n.dd).squaredNorm() + Jt * n.dd.squaredNorm() + Jp * s * s);
  e.gravity -= mass * c.gravity.dot(
                          n.u + offset * n.d());  // d, not t: t starts anew when the chart is moved
}

RigidInertia RigidDisk::inertia(double) const {
  WHIRL_EXPECTS(mass >= 0.0 && Jp >= 0.0 && Jt >= 0.0);
  RigidInertia r;
  r.mass = mass;
  r.moment = Vec3(mass * offset, 0, 0);
  const double Jd = Jt + mass * offset * offset;
  r.J = Vec3(Jp, Jd, Jd).asDiagonal();
  return r;
}

}  // namespace whirl::elements
