#include <elements/loads/body_vector.hpp>
#include <elements/loads/moment.hpp>
#include <elements/loads/point_load.hpp>

namespace whirl::elements {

using namespace system;

namespace {

double value(const LawPtr& law, const Context& c) {
  return law ? c.load * law->at(c.time).f : c.load;
}

/// A vector with body components, in global axes, with its gradient in (d, phi).
struct BodyLoadVector {
  Vec3 v;
  Mat34 B;
  BodyLoadVector(const BodyVector& b2, const BodyVector& b3, const Vec3& d, const Vec3& c)
      : v(c[0] * d + c[1] * b2.b + c[2] * b3.b),
        B(c[1] * b2.B + c[2] * b3.B) {
    B.diagonal().array() += c[0];
  }
};

}  // namespace

void PointForce::add_force(const Nodes<1>&, const Context& c, ForceX<3>& f) const {
  f -= value(factor, c) * force;
}

void PointForce::add_energy(const Nodes<1>& x, const Context& c, Energy& e) const {
  e.supplied += value(factor, c) * force.dot(x[0]->du);
}

void FixedLoad::add_force(const Nodes<1>& x, const Context& c, ForceX<7>& f) const {
  const double s = value(factor, c);
  f.head<3>() -= s * force;
  f.segment<3>(3) -= (s * offset) * force;
  add_moment(*x[0], -s * moment, f);
}

void FixedLoad::add_tangent(const Nodes<1>& x, const Context& c, TangentX<7>& t) const {
  add_moment_tangent(*x[0], -value(factor, c) * moment, t.K);
}

void FixedLoad::add_energy(const Nodes<1>& x, const Context& c, Energy& e) const {
  const NodeState& n = *x[0];
  e.supplied += value(factor, c) * (force.dot(n.du + offset * n.dd) + moment.dot(n.omega()));
}

Dependence BodyLoad::depends(const Context& c) const {
  const bool across = !force.tail<2>().isZero(0.0) || !moment.tail<2>().isZero(0.0);
  return {.angle = across && value(factor, c) != 0.0 ? each_angle : no_angle,
          .time = varies(factor)};
}

void BodyLoad::add_force(const Nodes<1>& x, const Context& c, ForceX<7>& f) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(n);
  const BodyVector b2(frame, 1, 0), b3(frame, 0, 1);
  const double s = value(factor, c);
  const Vec3 F = s * (force[0] * n.d() + force[1] * b2.b + force[2] * b3.b);
  f.head<3>() -= F;
  f.segment<3>(3) -= offset * F;
  add_moment(n, -s * (moment[0] * n.d() + moment[1] * b2.b + moment[2] * b3.b), f);
}

void BodyLoad::add_tangent(const Nodes<1>& x, const Context& c, TangentX<7>& t) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(n);
  const BodyVector b2(frame, 1, 0), b3(frame, 0, 1);
  const double s = value(factor, c);
  const BodyLoadVector F(b2, b3, n.d(), s * force), M(b2, b3, n.d(), -s * moment);
  t.K.topRightCorner<3, 4>() -= F.B;
  t.K.block<3, 4>(3, 3) -= offset * F.B;
  add_moment_tangent(n, M.v, t.K);
  // and the change of the moment vector itself
  const Vec3 d = n.d(), w = n.spin_form();
  t.K.block<3, 4>(3, 3) -= skew(d) * M.B + w * (d.transpose() * M.B);
  t.K.block<1, 4>(6, 3) += d.transpose() * M.B;
}

void BodyLoad::add_energy(const Nodes<1>& x, const Context& c, Energy& e) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(n);
  const BodyVector b2(frame, 1, 0), b3(frame, 0, 1);
  const Vec3 F = force[0] * n.d() + force[1] * b2.b + force[2] * b3.b;
  const Vec3 M = moment[0] * n.d() + moment[1] * b2.b + moment[2] * b3.b;
  e.supplied += value(factor, c) * (F.dot(n.du + offset * n.dd) + M.dot(n.omega()));
}

}  // namespace whirl::elements
