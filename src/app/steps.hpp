#pragma once
#include <app/job.hpp>
#include <io/plots.hpp>

namespace whirl::app {

/// Runs every step of the job's deck and writes summary.json, report.html and plots/. An Error of a step is passed on after
/// everything up to it has been written.
void run_steps(Job& job);

/// Side elevation of the model, for `check` and the report.
io::RotorDrawing drawing_of(const model::Model& model, const meshes::Mesh& mesh);

}  // namespace whirl::app
