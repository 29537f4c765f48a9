// Mesh of a spur or helical gear pair, external or internal, between two shaft nodes.
//
// Gear 1 at node 0, gear 2 at node 1, axes parallel to x; c = (cos a, sin a) in (y, z): from centre
// 1 towards centre 2 (towards the mesh for an internal pair), J a quarter turn y -> z. n: unit
// normal of the tooth flanks on which a positive torque of gear 1 drives,
//   n = cos beta (cos alpha J c + sin alpha c) - sin beta x
//       (transverse pressure angle alpha, base helix angle beta, right-hand on
//   gear 1 positive: its teeth run along cos beta x + sin beta J c, and a driver of right-hand teeth
//   that turns positively is pushed along +x)
// Compression of the mesh along n at the pitch points (r_i: pitch radii, r_2 < 0 for an internal
// gear):
//   delta = n.(u_0 - u_1) + cos beta (r_b1 phi_1 + r_b2 phi_2) + sin beta c.(r_1 t_0 + r_2 t_1) +
//       e(theta)
// (r_b = r cos alpha; t = d - x: a tilt moves the pitch point along x). phi enters with its whole
// turns through the teeth passed, z_1 phi_1 + z_2 phi_2, which is exact for any number of turns. e:
// static transmission error, theta = z_1 phi_1 the mesh phase.
//
// Drive flank: N = k(theta) delta, both signs when there is no backlash; with backlash j (along n,
// m) only delta > 0, and the back flank, of normal n' = cos beta (-cos alpha J c + sin alpha c) +
// sin beta x, carries delta' = its compression - j > 0.
//   k(theta) = k_0 [1 + sum_m a_m cos(m theta + b_m)],   e(theta) = sum_m e_m cos(m theta + f_m)
//       (m = 1 ... harmonics)
// Everything but the damping is the potential 1/2 k delta^2, so the torque that the turning
// stiffness makes is there. Damping: c delta' without backlash; k delta (1 + h delta') >= 0 with it
// (h s/m, Hunt & Crossley).
//
// Frequency-domain analyses (Context::averaged) see the mean mesh: k_0, no transmission error.
//
// Limits: small displacements against the pitch radii, parallel axes, no tooth friction, load
// shared as k(theta) says. Sources: Kahraman, J. Sound Vib. 163 (1993), doi 10.1006/jsvi.1993.1172
// (helical, three-dimensional); Kahraman & Singh, J. Sound Vib. 146 (1991), doi
// 10.1016/0022-460X(91)90499-Y (backlash, time-varying stiffness).
#pragma once
#include <system/kernel.hpp>
#include <vector>

namespace whirl::elements {

struct GearHarmonic {
  double amplitude = 0, phase = 0;
};  ///< a cos(m theta + phase); a relative (stiffness) or m (error)

struct GearGeometry {
  int z1 = 0, z2 = 0;              ///< teeth; z2 < 0: internal gear
  double pitch_radius = 0;         ///< r_1, m (r_2 = r_1 z_2/z_1)
  double pressure_angle = pi / 9;  ///< transverse, rad (20 degrees)
  double base_helix = 0;           ///< beta, rad
  double centre_angle = 0;         ///< a, rad from +y towards +z
  double drive = 1;  ///< +1: a positive torque of gear 1 drives; -1: mesh on the other flank
};

struct GearMesh {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  /// Sees the teeth that pass, and which tooth is in mesh unless means are asked for.
  system::Dependence depends(const system::Context& context) const;
  static constexpr int max_harmonics = 5;

  double k0 = 0, c = 0;  ///< N/m, N s/m
  std::array<GearHarmonic, max_harmonics> stiffness{}, error{};
  int harmonics = 0;

  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context&,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context&, system::Energy& e) const;
  double compression(const system::Nodes<2>& x) const;  ///< delta, m

  /// b: d delta/dX; rotation = cos beta r_b1/z_1: metres of delta a radian of z_1 phi_1 + z_2
  /// phi_2.
  Vector<14> b = Vector<14>::Zero();
  double rotation = 0;
  int z1 = 1, z2 = 1;
};

/// With backlash: two one-sided flanks.
struct BacklashGearMesh {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  system::Dependence depends(const system::Context& context) const;

  GearMesh drive, back;   ///< the flanks; c is not used
  double backlash = 0;    ///< j, m, along n
  double relaxation = 0;  ///< h, s/m

  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context&,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context&, system::Energy& e) const;
};

/// @throws Error E86: teeth or radius not possible, angles out of range, negative stiffness or
/// backlash, stiffness that turns negative, more than max_harmonics.
GearMesh make_gear_mesh(const GearGeometry& g, double k0, double c,
                        const std::vector<GearHarmonic>& stiffness = {},
                        const std::vector<GearHarmonic>& error = {});
BacklashGearMesh make_backlash_gear_mesh(const GearGeometry& g, double k0, double relaxation,
                                         double backlash,
                                         const std::vector<GearHarmonic>& stiffness = {},
                                         const std::vector<GearHarmonic>& error = {});

}  // namespace whirl::elements
