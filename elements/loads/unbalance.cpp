#include <elements/loads/body_vector.hpp>
#include <elements/loads/unbalance.hpp>
#include <cmath>

namespace whirl::elements {

using namespace system;

namespace {

/// Where the direction (d, phi) stands among the coordinates, after the place (u, d).
template <int N>
constexpr int turn = 7 * (N - 1) + 3;

}  // namespace

template <int N>
UnbalanceOn<N>::UnbalanceOn(double U, double beta, LawPtr law, double o)
    : amount(U),
      cos_beta(std::cos(beta)),
      sin_beta(std::sin(beta)),
      factor(std::move(law)),
      offset(o) {}

template <int N>
void UnbalanceOn<N>::add_force(const Nodes<N>& x, const Context& c, ForceX<7 * N>& f) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(*x[N - 1]);
  BodyVector v(frame, cos_beta, sin_beta);
  v.add_rates(frame);
  const double U = at(c.time);
  f.template head<3>() += U * v.accel;
  f.template segment<3>(3) += (U * offset) * v.accel;
  f.template tail<4>() += U * (v.B.transpose() * (n.ddu + offset * n.ddd));
}

template <int N>
void UnbalanceOn<N>::add_tangent(const Nodes<N>& x, const Context& c, TangentX<7 * N>& t) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(*x[N - 1]);
  BodyVector v(frame, cos_beta, sin_beta);
  v.add_rates(frame);
  Mat34 B1, B2;
  v.gradient_rates(frame, B1, B2);
  const double U = at(c.time), Uo = U * offset;
  constexpr int b = turn<N>;
  t.M.template block<3, 4>(0, b) += U * v.B;
  t.M.template block<4, 3>(b, 0) += U * v.B.transpose();
  t.C.template block<3, 4>(0, b) += (2.0 * U) * B1;
  t.K.template block<3, 4>(0, b) += U * B2;
  t.K.template block<4, 4>(b, b) += U * v.hessian(frame, n.ddu + offset * n.ddd);
  t.M.template block<3, 4>(3, b) += Uo * v.B;
  t.M.template block<4, 3>(b, 3) += Uo * v.B.transpose();
  t.C.template block<3, 4>(3, b) += (2.0 * Uo) * B1;
  t.K.template block<3, 4>(3, b) += Uo * B2;
}

template <int N>
void UnbalanceOn<N>::add_energy(const Nodes<N>& x, const Context& c, Energy& e) const {
  const NodeState& n = *x[0];
  const BodyFrame frame(*x[N - 1]);
  BodyVector v(frame, cos_beta, sin_beta);
  v.add_rates(frame);
  const LawValue law = factor ? factor->at(c.time) : LawValue{1.0, 0.0, 0.0};
  const double kinetic = amount * (n.du + offset * n.dd).dot(v.rate),
               gravity = -amount * c.gravity.dot(v.b);
  e.kinetic += law.f * kinetic;
  e.gravity += law.f * gravity;
  if (law.df != 0.0) e.supplied += law.df * (kinetic + gravity);
}

template <int N>
RigidInertia UnbalanceOn<N>::inertia(double time) const requires(N == 1) {
  RigidInertia r;
  r.moment = at(time) * Vec3(0, cos_beta, sin_beta);
  for (int k : {1, 2})
    r.J(0, k) = r.J(k, 0) = -offset * r.moment[k];
  return r;
}

template struct UnbalanceOn<1>;
template struct UnbalanceOn<2>;

}  // namespace whirl::elements
