// How the lines of a deck turn in the frequency domain, without a run.
#pragma once
#include <analysis/steady_rotation.hpp>
#include <assembly/build_system.hpp>
#include <meshes/mesh.hpp>
#include <model/model.hpp>

namespace whirl::results {

/// Spin of every line relative to the reference speed, as the deck's speed_ratio says; casings
/// stand. top_speed: highest |speed| expected, rad/s.
/// @pre built is of that model and mesh.
analysis::SteadyRotation steady_rotation_of(const model::Model& model, const meshes::Mesh& mesh,
                                            const assembly::Built& built, double top_speed);

}  // namespace whirl::results
