#include <analysis/statics/definiteness.hpp>
#include <analysis/statics/equilibrium.hpp>
#include <assembly/build_system.hpp>
#include <meshes/halved.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <results/static_accuracy.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace whirl::results {
namespace {

/// m: displacements below it are none. Ten times what an equilibrium is found to, or what a bow of half a
/// sine gives along the shaft when the mean over a turn holds it straight: pi^2 A^2/(4 L).
double least_deflection(const run::Job& job) {
  double out = 1e-14 * analysis::model_length(job.system());
  for (const model::Shaft& s : job.model.shafts) {
    const double bow = std::max(s.bow.amount, s.bow.initial);
    if (bow > 0) out = std::max(out, 0.25 * pi * pi * bow * bow / s.length());
  }
  return out;
}

/// The equilibrium on the halved mesh nearest the one found.
std::optional<analysis::Equilibrium> settle_on(const system::System& fine,
                                               const meshes::Halved& mesh, const run::Job& job,
                                               const run::StepState& found,
                                               const analysis::SteadyRotation& running,
                                               double load) {
  analysis::SteadySystem turning(fine, running);
  turning.set_load(load);
  analysis::EquilibriumOptions options;
  options.chart_change = job.model.chart_change;
  analysis::EquilibriumSolver solver(turning, options);
  system::State start = fine.make_state();
  start.q = meshes::spread(mesh, found.state.q);
  if (start.q.size() != fine.size()) return std::nullopt;
  start.frames.kept = found.state.frames.kept;  // films as warm as they were found
  return solver.try_solve(found.speed, &start);
}

}  // namespace

std::optional<StaticAccuracy> static_mesh_error(const run::Job& job, const std::string& step,
                                                const run::StepState& equilibrium,
                                                const analysis::SteadyRotation& turning,
                                                double load) {
  const system::State& own = equilibrium.state;
  if (job.mesh.elements.empty() || own.frames.moved()) return std::nullopt;
  const meshes::Halved fine =
      meshes::halve(job.mesh, std::vector<bool>(job.mesh.lines.size(), true));
  const assembly::Built built = assembly::build_system(job.model, fine.mesh, step);
  const auto found = settle_on(built.system, fine, job, equilibrium, turning, load);
  if (!found || found->state.frames.moved()) return std::nullopt;
  StaticAccuracy out;
  double most = 0;  // between the nodes of the own mesh too
  for (const meshes::Line& line : fine.mesh.lines)
    for (Index n = line.first_node; n < line.first_node + line.nodes; ++n)
      most = std::max(most, found->state.q.segment<3>(6 * n).norm());
  for (const meshes::Line& line : job.mesh.lines)
    for (Index n = line.first_node; n < line.first_node + line.nodes; ++n) {
      const Vec3 u = own.q.segment<3>(6 * n);
      const Vec3 refined = found->state.q.segment<3>(6 * fine.node[static_cast<std::size_t>(n)]);
      if (const double moved = (refined - u).norm(); moved > out.error) {
        out.error = moved;
        out.shaft = line.name;
      }
    }
  if (!(most > least_deflection(job))) return std::nullopt;
  out.error *= meshes::error_of_change / most;
  constexpr double another =
      0.5;  // no mesh's error: Newton's method has gone to another equilibrium
  if (out.error > another) return std::nullopt;
  if (out.shaft.empty()) out.shaft = job.mesh.lines.front().name;
  return out;
}

bool has_deflections(const run::Job& job, const run::StepState& equilibrium) {
  if (job.mesh.elements.empty()) return false;
  const double least = least_deflection(job);
  for (const meshes::Line& line : job.mesh.lines)
    for (Index n = line.first_node; n < line.first_node + line.nodes; ++n)
      if (equilibrium.state.q.segment<3>(6 * n).norm() > least) return true;
  return false;
}

std::string report_no_static_accuracy(run::Job& job, const std::string& step) {
  const std::string said =
      "what the elements leave of the deflections is not judged: no equilibrium like it was found "
      "on a mesh twice as fine";
  job.summary["steps"][step]["mesh"]["not judged"] = said;
  return said;
}

std::string report_static_accuracy(run::Job& job, const std::string& step,
                                   const StaticAccuracy& a) {
  io::Value& v = job.summary["steps"][step]["mesh"];
  v["elements"] = job.mesh.elements.size();
  v["relative error of deflections"] = a.error;
  v["largest at"] = a.shaft;
  if (a.error > job.model.mesh_accuracy) {
    warn_of_coarse_mesh(
        job, step,
        fmt::format("deflections of shaft '{}' are off by about {} of the largest, {} wanted",
                    a.shaft, error_text(a.error), error_text(job.model.mesh_accuracy)));
  }
  return fmt::format("deflections right to {} (elements)", error_text(a.error));
}

}  // namespace whirl::results
