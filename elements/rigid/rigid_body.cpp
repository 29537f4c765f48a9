#include <core/error.hpp>
#include <core/rotation.hpp>
#include <elements/loads/body_vector.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace whirl::elements {

using namespace system;

namespace {

[[noreturn]] void refuse(const char* message, const char* hint) {
  throw Error(Exit::deck, Diagnostic{Diagnostic::Severity::error, "E73", message, hint, {}});
}

/// The two transverse body vectors; the axis itself is d, with unit gradient.
struct Axes {
  BodyFrame frame;
  BodyVector b2, b3;
  explicit Axes(const NodeState& n) : frame(n), b2(frame, 1.0, 0.0), b3(frame, 0.0, 1.0) {
    b2.add_rates(frame);
    b3.add_rates(frame);
  }
};

/// y_k = S_k A + sum_l G_kl b_l''
struct Loads {
  Vec3 y1, y2, y3;
  Loads(const RigidBody& k, const NodeState& n, const Axes& a) {
    y1 = k.G(0, 1) * a.b2.accel + k.G(0, 2) * a.b3.accel;
    y2 = k.S[0] * n.ddu + k.G(0, 1) * n.ddd + k.G(1, 1) * a.b2.accel + k.G(1, 2) * a.b3.accel;
    y3 = k.S[1] * n.ddu + k.G(0, 2) * n.ddd + k.G(1, 2) * a.b2.accel + k.G(2, 2) * a.b3.accel;
  }
};

}  // namespace

RigidBody::RigidBody(double mass, const Vec3& offset, const Mat3& J) {
  const double size = J.cwiseAbs().maxCoeff();
  if (!(mass >= 0.0)) refuse("the mass of a rigid body must not be negative", "");
  if (!J.allFinite() || (J - J.transpose()).cwiseAbs().maxCoeff() > 1e-12 * size)
    refuse("an inertia tensor must be symmetric", "give J_xy = J_yx and so on");
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(J, Eigen::EigenvaluesOnly);
  const Vec3& j = principal.eigenvalues();
  if (j[0] < -1e-12 * size || j[2] > (j[0] + j[1]) + 1e-9 * size)
    refuse(
        "no body has these moments of inertia: each principal moment must be at least zero and at "
        "most the sum of the others",
        "for a thin disk Jp = 2 Jt");
  disk = {mass, 0.5 * (J(1, 1) + J(2, 2)), J(0, 0), offset.x()};
  S = mass * offset.tail<2>();
  G = mass * offset * offset.transpose() - J;
  G(0, 0) = 0.0;
  G(1, 1) += disk.Jt;
  G(2, 2) += disk.Jt;
}

Dependence RigidBody::depends(const Context&) const {
  const double size = disk.Jp + disk.Jt;  // the moments of inertia are known to their rounding only
  const bool axisymmetric =
      S.squaredNorm() <= 1e-24 * disk.mass * size && G.cwiseAbs().maxCoeff() <= 1e-12 * size;
  return {.angle = axisymmetric ? no_angle : each_angle, .spin = true, .weight = true};
}

void RigidBody::add_force(const Nodes<1>& x, const Context& c, ForceX<7>& f) const {
  disk.add_force(x, c, f);
  const NodeState& n = *x[0];
  const Axes a(n);
  const Loads y(*this, n, a);
  f.head<3>() += S[0] * a.b2.accel + S[1] * a.b3.accel;
  f.segment<3>(3) += y.y1;
  f.tail<4>() += a.b2.B.transpose() * y.y2 + a.b3.B.transpose() * y.y3;
}

void RigidBody::add_tangent(const Nodes<1>& x, const Context& c, TangentX<7>& t) const {
  disk.add_tangent(x, c, t);
  const NodeState& n = *x[0];
  const Axes a(n);
  const Loads y(*this, n, a);
  Mat34 P2, Q2, P3, Q3;  // B' and B'' of b2, b3
  a.b2.gradient_rates(a.frame, P2, Q2);
  a.b3.gradient_rates(a.frame, P3, Q3);
  // d(y_k)/d(.) for the three kinds: G (B_2, B_3) and its analogues with 2B' and B''; d itself has
  // gradient (1, 0)
  const auto add = [&](Matrix<7>& m, const Mat34& X2, const Mat34& X3, bool acceleration) {
    Mat34 z1 = G(0, 1) * X2 + G(0, 2) * X3, z2 = G(1, 1) * X2 + G(1, 2) * X3,
          z3 = G(1, 2) * X2 + G(2, 2) * X3;
    if (acceleration) {
      z2.diagonal().array() += G(0, 1);
      z3.diagonal().array() += G(0, 2);
    }
    m.topRightCorner<3, 4>() += S[0] * X2 + S[1] * X3;
    m.block<3, 4>(3, 3) += z1;
    m.bottomRightCorner<4, 4>() += a.b2.B.transpose() * z2 + a.b3.B.transpose() * z3;
  };
  add(t.M, a.b2.B, a.b3.B, true);
  t.M.bottomLeftCorner<4, 3>() += (S[0] * a.b2.B + S[1] * a.b3.B).transpose();
  add(t.C, 2.0 * P2, 2.0 * P3, false);
  add(t.K, Q2, Q3, false);
  t.K.bottomRightCorner<4, 4>() += a.b2.hessian(a.frame, y.y2) + a.b3.hessian(a.frame, y.y3);
}

void RigidBody::add_energy(const Nodes<1>& x, const Context& c, Energy& e) const {
  disk.add_energy(x, c, e);
  const NodeState& n = *x[0];
  const Axes a(n);
  const Vec3 &v1 = n.dd, &v2 = a.b2.rate, &v3 = a.b3.rate;
  e.kinetic += n.du.dot(S[0] * v2 + S[1] * v3) + v1.dot(G(0, 1) * v2 + G(0, 2) * v3) +
               0.5 * (G(1, 1) * v2.squaredNorm() + G(2, 2) * v3.squaredNorm()) +
               G(1, 2) * v2.dot(v3);
  e.gravity -= c.gravity.dot(S[0] * a.b2.b + S[1] * a.b3.b);
}

RigidInertia RigidBody::inertia(double time) const {
  RigidInertia r = disk.inertia(time);
  r.moment.tail<2>() = S;
  r.J += G.trace() * Mat3::Identity() - G;
  return r;
}

Mat3 skewed_inertia(double Jp, double Jt, double skew, double phase) {
  const Vec3 axis(std::cos(skew), std::sin(skew) * std::cos(phase),
                  std::sin(skew) * std::sin(phase));
  return Jt * Mat3::Identity() + (Jp - Jt) * axis * axis.transpose();
}

}  // namespace whirl::elements
