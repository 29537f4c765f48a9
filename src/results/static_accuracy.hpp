// What the finite length of the elements does to an equilibrium: the same one on a mesh twice as fine.
#pragma once
#include <analysis/steady_rotation.hpp>
#include <run/job.hpp>

#include <optional>
#include <string>

namespace whirl::results {

struct StaticAccuracy {
  double error = 0;   ///< of a displacement of a node, over the largest displacement of the rotor
  std::string shaft;  ///< where it is largest
};

/// The error that elements leave of the displacements in an equilibrium: 4/3 of their change on a
/// mesh twice as fine, which is right where it falls with the square of their length, and too large
/// where it falls faster. nullopt: no elements, nothing displaced, axes that have moved, or no
/// equilibrium found on that mesh. step: the one that the system is built for; turning: as it was found;
/// load: factor on gravity and loads at which it stands.
std::optional<StaticAccuracy> static_mesh_error(const run::Job& job, const std::string& step,
                                                const run::StepState& equilibrium,
                                                const analysis::SteadyRotation& turning,
                                                double load = 1.0);
/// Nothing said of the mesh where nothing is displaced but by rounding; else what was looked for and not found.
bool has_deflections(const run::Job& job, const run::StepState& equilibrium);

/// Into the summary: the deflections of the equilibrium were not judged; returns the same in words.
std::string report_no_static_accuracy(run::Job& job, const std::string& step);
/// Into the summary ("mesh"), and W10 where it is above Model::mesh_accuracy; returns "deflections
/// right to 2e-4 (elements)".
std::string report_static_accuracy(run::Job& job, const std::string& step, const StaticAccuracy& a);

}  // namespace whirl::results
