// A unit vector fixed in a rigid body and perpendicular to its axis at phi = 0, as a function of
// director d and phi:
//   b(d, phi) = P(d <- e) c,  c = cos(phi + beta) e2 + sin(phi + beta) e3,
//   P(d <- e) c = c - alpha (e + d),  alpha = d.c/(1 + e.d)      (minimal rotation; rational in d)
// With rates: b'' and the time derivatives of the gradient B = db/d(d, phi) give, for any
// Lagrangian in b,
//   db''/dX'' = B,  db''/dX' = 2 B',  db''/dX = B''.
// beta: body angle at phi = 0 from e2 towards e3, rad. All vectors in global axes.
#pragma once
#include <system/node.hpp>

namespace whirl::elements {

using Mat34 = Matrix<3, 4>;
using Mat4 = Matrix<4>;

/// What the vectors of one body share at a state: axis, director, their rates, cos and sin of phi.
struct BodyFrame {
  Vec3 e, e2, e3, p;  ///< p = e + d
  const system::NodeState& n;
  double D, D1, D2;     ///< 1 + e.d and rates
  double cosine, sine;  ///< of phi
  explicit BodyFrame(const system::NodeState& s);
};

/// Value and rates of c = cos(phi + beta) e2 + sin(phi + beta) e3.
struct BodyVector {
  Vec3 b, rate, accel;
  Mat34 B;  ///< db/d(d, phi), columns (d, phi)
  /// Position and B only.
  BodyVector(const BodyFrame& f, double cos_beta, double sin_beta);
  /// Second derivative of A.b in (d, phi).
  Mat4 hessian(const BodyFrame& f, const Vec3& A) const;
  /// Fills rate and accel.
  void add_rates(const BodyFrame& f);
  /// B' and B'' (after add_rates).
  void gradient_rates(const BodyFrame& f, Mat34& B_rate, Mat34& B_accel) const;

 private:
  Vec3 c_, c1_;  ///< c and dc/dphi
  double alpha_, alpha1_ = 0, alpha2_ = 0;
  Vec3 alpha_d_;      ///< dalpha/dd
  double alpha_phi_;  ///< dalpha/dphi
};

}  // namespace whirl::elements
