// What there is to draw of a model, from the model and its mesh.
#pragma once
#include <meshes/mesh.hpp>
#include <meshes/surface.hpp>
#include <model/model.hpp>

namespace whirl::meshes {

/// Node indices are those of the mesh. Sizes that the model does not give are estimated for the
/// picture: disks without drawing data from their mass and inertia (as solid cylinders), sections
/// without diameters from EI/EA or as rods of a hundredth of the line's length.
Scene make_scene(const model::Model& m, const Mesh& mesh);

}  // namespace whirl::meshes
