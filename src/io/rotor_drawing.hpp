// From model and mesh to the side elevation that `check` and the report show.
#pragma once
#include <io/plots.hpp>
#include <meshes/scene.hpp>

namespace whirl::io {

/// One drawing a shaft line, lengths from its left end. Sections and disks without drawing sizes get those of the scene.
std::vector<RotorDrawing> make_rotor_drawings(const model::Model& model, const meshes::Mesh& mesh, const meshes::Scene& scene);

}  // namespace whirl::io
