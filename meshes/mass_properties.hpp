// Mass, centre and inertia of shafts with all that turns with them, in closed form from the model
// (no mesh involved), for printing and to check the assembled mass matrix against.
//
// Frustum of length L, diameters D1, D2 (hollow: outer less inner): V = pi L/12 (D1^2 + D1 D2 +
// D2^2),
//   int A s ds = pi L^2/48 (D1^2 + 2 D1 D2 + 3 D2^2),
//       int A s^2 ds = pi L^3/120 (D1^2 + 3 D1 D2 + 6 D2^2),
//   int J ds = pi L/160 (D1^4 + D1^3 D2 + D1^2 D2^2 + D1 D2^3 + D2^4),  J = pi D^4/32.
#pragma once
#include <model/model.hpp>
#include <string>
#include <vector>

namespace whirl::meshes {

struct MassProperties {
  double mass = 0;                   ///< kg
  Vec3 moment = Vec3::Zero();        ///< mass x position of the centre, global origin, kg m
  Mat3 about_origin = Mat3::Zero();  ///< inertia tensor about the global origin, kg m2

  Vec3 centre() const { return mass > 0 ? Vec3(moment / mass) : Vec3::Zero(); }
  /// Inertia tensor about the mass centre, global axes, kg m2.
  Mat3 about_centre() const;
  double Ip() const { return about_centre()(0, 0); }  ///< about the axis through the centre, kg m2
  /// Mean transverse inertia about the centre, kg m2.
  double Id() const { return 0.5 * (about_centre()(1, 1) + about_centre()(2, 2)); }
  MassProperties& operator+=(const MassProperties& o);
  /// A body of mass m at c with inertia J about c.
  void add(double m, const Vec3& c, const Mat3& J);
};

/// One shaft: its sections (also rigid ones with diameters), disks and added mass; phi = 0,
/// undeformed. Rotary inertia counts as far as the model has it (Section::rotary_inertia).
/// Unbalances are static moments without mass of their own and count as such.
MassProperties shaft_mass(const model::Model& m, std::size_t shaft);
/// One section, its left end at x.
MassProperties section_mass(const model::Model& m, const model::Section& s, const Vec3& left_end);
MassProperties disk_mass(const model::Disk& d, const Vec3& station);
/// All shafts and casings, without pedestals.
MassProperties total_mass(const model::Model& m);

/// Table: shaft by shaft and total; mass kg, centre m, Ip and Id kg m2.
std::string mass_table(const model::Model& m);

}  // namespace whirl::meshes
