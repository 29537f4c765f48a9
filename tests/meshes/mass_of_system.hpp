// Mass properties of the assembled system: the kinetic energy of its elements in rigid motions. The
// counterpart of meshes::mass_properties, which knows no mesh: the two must agree to round-off.
#pragma once
#include <meshes/mass_properties.hpp>
#include <system/system.hpp>
#include <algorithm>

namespace whirl::assembly {

/// Of the nodes of one line (line < 0: of all nodes, pedestals too) in the reference state, phi =
/// 0: r^T M r over the six rigid motions r.
/// Includes added masses of bearings on those nodes.
inline meshes::MassProperties mass_of_system(const system::System& s, Index line = -1) {
  system::State state = s.make_state();
  system::Workspace w = s.make_workspace();
  MatX R =
      MatX::Zero(s.size(), 6);  // translations, rotations about the global axes through the origin
  for (Index i = 0; i < s.nodes(); ++i) {
    const system::NodeDef& n = s.node(i);
    if ((line >= 0 && n.line != line) || n.scalar) continue;
    const Mat3& E = state.frames.axes(i);
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = Vec3::Unit(k);
      R(6 * i + k, k) = 1.0;
      R.block<3, 1>(6 * i, 3 + k) = axis.cross(n.position);
      R.block<3, 1>(6 * i + 3, 3 + k) =
          E.transpose() * axis;  // (phi', gamma2', gamma3') at gamma = 0
    }
  }
  // From kinetic energies, not from the matrix: that has no rows of nodes that are held.
  const auto twice_energy = [&](const VecX& v) {
    s.evaluate_nodes(w, state.frames, 0.0, state.q, v, state.a);
    return 2.0 * s.energy(w).kinetic;
  };
  Matrix<6> T;
  for (int i = 0; i < 6; ++i)
    T(i, i) = twice_energy(R.col(i));
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j)
      T(i, j) = T(j, i) =
          0.25 * (twice_energy(R.col(i) + R.col(j)) - twice_energy(R.col(i) - R.col(j)));
  meshes::MassProperties p;
  p.mass = T.topLeftCorner<3, 3>().trace() / 3.0;
  // u = e_k x r: r^T M r of (translation i, rotation k) is m (e_k x c)_i
  p.moment = Vec3(0.5 * (T(1, 5) - T(2, 4)), 0.5 * (T(2, 3) - T(0, 5)), 0.5 * (T(0, 4) - T(1, 3)));
  p.about_origin = T.bottomRightCorner<3, 3>();
  return p;
}

/// Largest disagreement between the assembled matrix and the closed form: |mass difference|/mass,
/// and likewise of the first moments and inertias over mass x length and mass x length^2.
inline double mass_disagreement(const meshes::MassProperties& a, const meshes::MassProperties& b,
                                double length) {
  if (!(b.mass > 0)) return a.mass;
  const double l = length > 0 ? length : 1.0;
  return std::max({std::abs(a.mass - b.mass) / b.mass, (a.moment - b.moment).norm() / (b.mass * l),
                   (a.about_origin - b.about_origin).norm() / (b.mass * l * l)});
}

}  // namespace whirl::assembly
