// A moment vector m in the coordinates (d, phi): from m.omega with omega = d x d' + (phi' - w.d')
// d,
//   f_d = m x d - (m.d) w,  f_phi = m.d;  and back: m = d x f_d + f_phi (e + d)/(1 + e.d).
#pragma once
#include <system/spin.hpp>

namespace whirl::elements {

inline void add_moment(const system::NodeState& n, const Vec3& m, system::ForceX<7>& f) {
  const Vec3 d = n.d();
  const double along = m.dot(d);
  f.segment<3>(3) += m.cross(d) - along * n.spin_form();
  f[6] += along;
}

/// Its derivative in d with m held fixed.
inline void add_moment_tangent(const system::NodeState& n, const Vec3& m, Matrix<7>& K) {
  const system::Spin s(n);
  const Vec3 d = n.d();
  K.block<3, 3>(3, 3) += skew(m) - s.w * m.transpose() - m.dot(d) * s.W();
  K.block<1, 3>(6, 3) += m.transpose();
}

/// The moment vector of generalized forces (f_d, f_phi).
inline Vec3 moment_of(const system::NodeState& n, const Vec3& f_d, double f_phi) {
  return n.d().cross(f_d) + (f_phi / (2.0 + n.e().dot(n.t))) * (2.0 * n.e() + n.t);
}

}  // namespace whirl::elements
