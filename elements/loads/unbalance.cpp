#include <elements/loads/body_vector.hpp>
#include <elements/loads/unbalance.hpp>
#include <cmath>

namespace whirl::elements {

using namespace system;

UnbalanceMass::UnbalanceMass(double U, double beta, LawPtr law, double o)
    : amount(U),
      cos_beta(std::cos(beta)),
      sin_beta(std::sin(beta)),
      factor(std::move(law)),
      offset(o) {}

void UnbalanceMass::add_force(const Nodes<1>& x, const Context& c, ForceX<7>& f) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(n);
  BodyVector v(frame, cos_beta, sin_beta);
  v.add_rates(frame);
  const double U = at(c.time);
  f.head<3>() += U * v.accel;
  f.segment<3>(3) += (U * offset) * v.accel;
  f.tail<4>() += U * (v.B.transpose() * (n.ddu + offset * n.ddd));
}

void UnbalanceMass::add_tangent(const Nodes<1>& x, const Context& c, TangentX<7>& t) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(n);
  BodyVector v(frame, cos_beta, sin_beta);
  v.add_rates(frame);
  Mat34 B1, B2;
  v.gradient_rates(frame, B1, B2);
  const double U = at(c.time);
  t.M.topRightCorner<3, 4>() += U * v.B;
  t.M.bottomLeftCorner<4, 3>() += U * v.B.transpose();
  t.C.topRightCorner<3, 4>() += (2.0 * U) * B1;
  t.K.topRightCorner<3, 4>() += U * B2;
  t.K.bottomRightCorner<4, 4>() += U * v.hessian(frame, n.ddu + offset * n.ddd);
  const double Uo = U * offset;
  t.M.block<3, 4>(3, 3) += Uo * v.B;
  t.M.block<4, 3>(3, 3) += Uo * v.B.transpose();
  t.C.block<3, 4>(3, 3) += (2.0 * Uo) * B1;
  t.K.block<3, 4>(3, 3) += Uo * B2;
}

void UnbalanceMass::add_energy(const Nodes<1>& x, const Context& c, Energy& e) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(n);
  BodyVector v(frame, cos_beta, sin_beta);
  v.add_rates(frame);
  const LawValue law = factor ? factor->at(c.time) : LawValue{1.0, 0.0, 0.0};
  const double kinetic = amount * (n.du + offset * n.dd).dot(v.rate),
               gravity = -amount * c.gravity.dot(v.b);
  e.kinetic += law.f * kinetic;
  e.gravity += law.f * gravity;
  if (law.df != 0.0) e.supplied += law.df * (kinetic + gravity);
}

RigidInertia UnbalanceMass::inertia(double time) const {
  RigidInertia r;
  r.moment = at(time) * Vec3(0, cos_beta, sin_beta);
  for (int k : {1, 2})
    r.J(0, k) = r.J(k, 0) = -offset * r.moment[k];
  return r;
}

}  // namespace whirl::elements
