#include <core/section_matrices.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl {

SectionMoments::SectionMoments(const Matrix<6>& mass) : m(mass(0, 0)) {
  if (m > 0) centre = Vec3(mass(1, 5), -mass(0, 5), mass(0, 4)) / m;
  J = mass.bottomRightCorner<3, 3>() + m * skew(centre) * skew(centre);
  second = 0.5 * J.trace() * Mat3::Identity() - J;
}

Matrix<6> SectionMoments::matrix() const {
  const Mat3 c = skew(centre);
  Matrix<6> r;
  r << m * Mat3::Identity(), -m * c, m * c, Mat3(J - m * c * c);
  return r;
}

Matrix<6> offset_stiffness(double EA, double kGAy, double kGAz, double GJ, double EIy, double EIz,
                           const Vec2& centroid, const Vec2& shear_centre) {
  // strains at the centres: ex + z_c ky - y_c kz; gy - z_s kx, gz + y_s kx
  Matrix<6> T = Matrix<6>::Identity();
  T(0, 4) = centroid[1];
  T(0, 5) = -centroid[0];
  T(1, 3) = -shear_centre[1];
  T(2, 3) = shear_centre[0];
  Vector<6> k;
  k << EA, kGAy, kGAz, GJ, EIy, EIz;
  return T.transpose() * k.asDiagonal() * T;
}

Matrix<6> offset_mass(double m, const Vec2& centre, double Jx, double Jy, double Jz, double Jyz) {
  SectionMoments x;
  x.m = m;
  x.centre = Vec3(0, centre[0], centre[1]);
  x.J << Jx, 0, 0, 0, Jy, -Jyz, 0, -Jyz, Jz;
  return x.matrix();
}

Matrix<6> with_mean_rotary_inertia(const Matrix<6>& mass) {
  SectionMoments x(mass);
  x.J(1, 1) = x.J(2, 2) = 0.5 * (x.J(1, 1) + x.J(2, 2));
  x.J(1, 2) = x.J(2, 1) = 0;
  return x.matrix();
}

Matrix<6> without_rotary_inertia(const Matrix<6>& mass) {
  SectionMoments x(mass);
  x.J.setZero();
  return x.matrix();
}

bool is_axisymmetric(const Matrix<6>& section, double share) {
  // a quarter turn: (x, y, z) -> (x, z, -y), of both halves
  static constexpr std::array<Index, 6> from{0, 2, 1, 3, 5, 4};
  static constexpr std::array<double, 6> sign{1, 1, -1, 1, 1, -1};
  Vector<6> size;
  for (Index i = 0; i < 6; ++i)
    size[i] = std::sqrt(std::max(section(i, i), section(from[at(i)], from[at(i)])));
  for (Index i = 0; i < 6; ++i)
    for (Index k = 0; k < 6; ++k) {
      const double turned = sign[at(i)] * sign[at(k)] * section(from[at(i)], from[at(k)]);
      if (std::abs(turned - section(i, k)) > share * size[i] * size[k]) return false;
    }
  return true;
}

}  // namespace whirl
