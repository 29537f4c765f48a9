// From model and mesh to the side elevation that `check` and the report show.
#pragma once
#include <plot/plots.hpp>
#include <meshes/scene.hpp>

namespace whirl::plot {

/// One drawing a shaft line, lengths from its left end. Sections and disks without drawing sizes
/// get those of the scene. A line along a path is drawn laid out straight.
std::vector<RotorDrawing> make_rotor_drawings(const model::Model& model, const meshes::Mesh& mesh,
                                              const meshes::Scene& scene);

/// The lines along a path, in space: one drawing each.
std::vector<LineDrawing> make_line_drawings(const model::Model& model, const meshes::Mesh& mesh);
/// All of them as figures: "machine" where there are several straight lines, "rotor", "rotor_2" and
/// so on, "line" and so on.
std::vector<Figure> draw_model(const model::Model& model, const meshes::Mesh& mesh,
                               const meshes::Scene& scene);

}  // namespace whirl::plot
