// What a run would refuse before or while it computes, found without computing: for `whirl check`.
#pragma once
#include <run/options.hpp>
#include <meshes/mesh.hpp>

namespace whirl::steps {

/// Puts together what each step of a deck needs (equations, integrator, the decks of a map over a
/// parameter, the state of an earlier run). Error: all that stands against it, with the exit code
/// of the first. options.variant and options.output as for run_deck().
void check_steps(const model::Model& model, const meshes::Mesh& mesh,
                 const run::RunOptions& options);

}  // namespace whirl::steps
