// Section forces and stresses along the shafts in a state.
//
// Resultants are those of the part to the right (larger s) on the part to the left, in section
// axes: t along the section normal d, y and z the shaft's lateral axes carried to d by the minimal
// rotation (they do not turn with the spin).
//   N = F.t (tension positive), V = (F.y, F.z), T = M.t, M = (M.y, M.z); on a straight shaft
//       dM_z/ds = -V_y, dM_y/ds = V_z,
// and M_z > 0 bends it hollow towards +y. On a line along a path y and z are the axes carried along
// it, as they now stand. At element ends they are what the element puts on its nodes, loads and
// inertia spread over it included: exact with respect to equilibrium for any mesh. Between them F
// is linear and M the cubic with dM/ds = -t x F at the ends (exact for constant weight).
//
// Stresses of round sections (stiffness diameters; nothing for sections given by constants or as
// general ones), Pa:
//   axial N/A, bending |M| c/I, torsion |T| c/J, and von Mises, the larger of
//   sqrt((|N|/A + |M| c/I)^2 + 3 (T c/J)^2) at the surface and sqrt((N/A)^2 + 3 (T c/J + tau_V)^2)
//       at the neutral fibre, with
//   tau_V = 4 V (Ro^2 + Ro Ri + Ri^2)/(3 A (Ro^2 + Ri^2))
//       (S. Timoshenko, J. Gere, Mechanics of Materials, 3rd ed., 5.9)
// Nominal: no stress concentration.
#pragma once
#include <assembly/build_system.hpp>
#include <array>

namespace whirl::assembly {

struct SectionPoint {
  Index line = 0, element = 0;
  double s = 0;         ///< m from the left end of the line
  double xi = 0;        ///< 0 .. 1 along the element; at 0 and 1 the values are exact
  double N = 0, T = 0;  ///< N, N m
  Vec2 V = Vec2::Zero(), M = Vec2::Zero();
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  ///< the same in global axes
  Vec3 normal = Vec3::UnitX();                       ///< of the section, global axes
  bool has_stress = false;
  double axial = 0, bending = 0, torsion = 0, von_mises = 0;  ///< Pa; axial is signed
};

/// What the element of each place of the mesh puts on its two nodes, N and N m in X (system/kernel.hpp).
using ElementForces = std::vector<system::ForceX<14>>;

/// In the state that the workspace holds.
/// @pre w was evaluated.
ElementForces calc_element_forces(const meshes::Mesh& mesh, const Built& built,
                                  const system::Workspace& w);

/// By line and element, `inner` points inside each element beside its two ends; in the state that
/// the workspace holds.
/// @pre w was evaluated; inner >= 0.
std::vector<SectionPoint> calc_section_results(const model::Model& m, const meshes::Mesh& mesh,
                                               const Built& built, const system::Workspace& w,
                                               int inner = 3);
/// With given forces of the elements, which need not be those of the state: the ends stand where the
/// workspace has them.
/// @pre w was evaluated; one force an element; inner >= 0.
std::vector<SectionPoint> calc_section_results(const model::Model& m, const meshes::Mesh& mesh,
                                               const Built& built, const system::Workspace& w,
                                               const ElementForces& forces, int inner = 3);
/// The same as the first into `out`, whose memory is used again.
void calc_section_results(const model::Model& m, const meshes::Mesh& mesh, const Built& built,
                          const system::Workspace& w, int inner, std::vector<SectionPoint>& out);

/// T at the left and at the right end of an element, N m, exact as above.
/// @pre w was evaluated.
std::array<double, 2> calc_torques(const meshes::Mesh& mesh, const Built& built,
                                   const system::Workspace& w, std::size_t element);

}  // namespace whirl::assembly
