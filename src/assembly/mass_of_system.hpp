// Mass properties of the assembled system: the kinetic energy of its elements in rigid motions. The
// counterpart of meshes::mass_properties, which knows no mesh: the two must agree to round-off.
#pragma once
#include <meshes/mass_properties.hpp>
#include <system/system.hpp>

namespace whirl::assembly {

/// Of the nodes of one line (line < 0: of all nodes, pedestals too) in the reference state, phi =
/// 0: r^T M r over the six rigid motions r. Includes added masses of bearings on those nodes.
meshes::MassProperties mass_of_system(const system::System& s, Index line = -1);

/// Largest disagreement between the assembled matrix and the closed form: |mass difference|/mass,
/// and likewise of the first moments and inertias over mass x length and mass x length^2.
double mass_disagreement(const meshes::MassProperties& assembled,
                         const meshes::MassProperties& closed_form, double length);

}  // namespace whirl::assembly
