// Names used everywhere: fixed-size linear algebra, constants, indices, display units.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <complex>
#include <cstddef>
#include <limits>

namespace whirl {

using Index = std::ptrdiff_t;
using Complex = std::complex<double>;

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;
template <int R, int C = R>
using Matrix = Eigen::Matrix<double, R, C>;

using Vec2 = Vector<2>;
using Vec3 = Vector<3>;
using Mat2 = Matrix<2>;
using Mat3 = Matrix<3>;
using Mat32 = Matrix<3, 2>;
using VecX = Eigen::VectorXd;
using VecXc = Eigen::VectorXcd;
using MatX = Eigen::MatrixXd;
using MatXc = Eigen::MatrixXcd;

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double two_pi = 2.0 * pi;
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// An index that is known not to be negative, for the standard containers.
constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// For display: rad/s to revolutions a minute, and to cycles a second.
constexpr double to_rpm(double omega) { return omega * 30.0 / pi; }
constexpr double to_hz(double omega) { return omega / two_pi; }

/// Cross-product matrix: skew(a) b = a x b.
inline Mat3 skew(const Vec3& a) {
  Mat3 m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

}  // namespace whirl
