// From model and mesh to the picture of the rotor (surface.hpp): plain data for frame writers.
#pragma once
#include <meshes/mesh.hpp>
#include <meshes/surface.hpp>

namespace whirl::meshes {

/// Lines, sections, disks, supports and probe trails. A rigid section without diameters is drawn as a thin rod (a fiftieth of the
/// model's length); disks without drawing sizes get a diameter from their polar inertia and mass.
Scene make_scene(const model::Model& model, const Mesh& mesh);

}  // namespace whirl::meshes
