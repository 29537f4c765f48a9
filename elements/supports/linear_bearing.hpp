// Linear spring, damper and added mass between two nodes (shaft and ground, housing or another
// shaft), fixed axes.
//   q = q_1 - q_2,   force on node 1 = preload - K (q - setpoint) - C q' - M q'',
//       on node 2 the opposite
//
// Two kernels:
//   TranslationalBearing: q = u, 3 x 3 matrices (the usual case);
//   LinearBearing: q = (x, y, z, rx, ry, rz) of six_motion.hpp at points off the nodes, 6 x 6
//       matrices; linear in X, so its tangents
//     are constant.
//
// Matrices need not be symmetric: the skew parts of K
// and M exchange energy and count as supplied power, as does the preload. SI units.
#pragma once
#include <elements/supports/six_motion.hpp>

namespace whirl::elements {

struct TranslationalBearing {
  static constexpr int n_nodes = 2, width = 3;
  static constexpr bool has_M = true, has_C = true, has_K = true, quadratic_in_rates = true,
                        linear_in_displacements = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{};

  Mat3 K = Mat3::Zero(), C = Mat3::Zero(), M = Mat3::Zero();  ///< global axes
  Vec3 setpoint = Vec3::Zero(), preload = Vec3::Zero();

  void add_force(const system::Nodes<2>& x, const system::Context& c, system::ForceX<6>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& c,
                   system::TangentX<6>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const;
  /// Force on node 1, N.
  Vec3 force_on_first(const system::Nodes<2>& x) const;
};

struct LinearBearing {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr bool has_M = true, has_C = true, has_K = true, quadratic_in_rates = true,
                        linear_in_displacements = true;
  static constexpr system::Family family = system::Family::support;
  /// Sees the twist where it resists one.
  system::Dependence depends(const system::Context&) const {
    return {.angle = K_.col(3).isZero(0.0) ? system::no_angle : system::twist_angle,
            .spin = !C_.col(3).isZero(0.0)};
  }

  LinearBearing() = default;
  /// s1, s2: points from the nodes along their directors, m; axes: columns e0, e2, e3, orthonormal,
  /// global axes.
  /// @pre finite matrices, orthonormal axes.
  LinearBearing(const Matrix<6>& K, const Matrix<6>& C, const Matrix<6>& M,
                const Vector<6>& setpoint, const Vector<6>& preload, double s1 = 0, double s2 = 0,
                const Mat3& axes = Mat3::Identity());

  void add_force(const system::Nodes<2>& x, const system::Context& c, system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& c,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const;
  /// Force and moment on node 1's point along `axes`: N, N m (conjugate to q).
  Vector<6> load_on_first(const system::Nodes<2>& x) const;

 private:
  Matrix<6> K_ = Matrix<6>::Zero(), C_ = K_, M_ = K_;
  Vector<6> setpoint_ = Vector<6>::Zero(), preload_ = Vector<6>::Zero();
  SixMotion between_;
  Matrix<14> K14_ = Matrix<14>::Zero(), C14_ = K14_, M14_ = K14_;
};

}  // namespace whirl::elements
