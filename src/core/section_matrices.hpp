// Sections of beams as 6x6 matrices per length.
#pragma once
#include <core/types.hpp>

namespace whirl {

/// A section, per length, about the line of nodes in its own axes (x along the shaft, y, z).
struct FullSection {
  /// Forces (Fx, Fy, Fz), N, and moments (Mx, My, Mz), N m, of strains (ex, gy, gz), - and (kx, ky,
  /// kz), 1/m: symmetric, positive definite.
  Matrix<6> stiffness = Matrix<6>::Zero();
  /// Momenta of velocities and angular velocities: [m, -m c x; m c x, J], c the mass centre; kg/m,
  /// kg, kg m.
  Matrix<6> mass = Matrix<6>::Zero();
};

/// Stiffness of a section whose bending and axial stiffness are about `centroid` and whose torsion
/// and shear are about `shear_centre` (y, z, m), on the line of nodes. EIy bends about y.
Matrix<6> offset_stiffness(double EA, double kGAy, double kGAz, double GJ, double EIy, double EIz,
                           const Vec2& centroid, const Vec2& shear_centre);
/// Mass matrix of m (kg/m) at `centre` with moments about it, Jx about the axis, Jy, Jz, Jyz = int
/// rho y z dA, kg m.
Matrix<6> offset_mass(double m, const Vec2& centre, double Jx, double Jy, double Jz, double Jyz);
/// Transverse inertia replaced by its mean about the mass centre (no difference, no product).
Matrix<6> with_mean_rotary_inertia(const Matrix<6>& mass);
/// Without inertia of rotation about the mass centre.
Matrix<6> without_rotary_inertia(const Matrix<6>& mass);

/// Whether a stiffness, compliance or mass matrix of a section is the same after a quarter turn about
/// the axis, and so after any, but for `share` of its diagonal: lateral 2x2 blocks of the form a I + b J, nothing
/// between them and the axis. Extension may twist and bending may shear such a section.
bool is_axisymmetric(const Matrix<6>& section, double share);

/// What a mass matrix says: mass per length, its centre, and moments about that.
struct SectionMoments {
  double m = 0;                ///< kg/m
  Vec3 centre = Vec3::Zero();  ///< m
  Mat3 J = Mat3::Zero();       ///< inertia tensor about the centre, kg m
  Mat3 second = Mat3::Zero();  ///< int rho y_a y_b dA about the centre, kg m
  SectionMoments() = default;
  explicit SectionMoments(const Matrix<6>& mass);
  Matrix<6> matrix() const;  ///< from m, centre and J
};

}  // namespace whirl
