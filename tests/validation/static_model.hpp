// A model solved to its static equilibrium, for the static validation cases.
#pragma once
#include <analysis/statics/equilibrium.hpp>
#include <assembly/section_results.hpp>
#include <meshes/mesh.hpp>
#include <system/problem.hpp>

namespace whirl::test {

struct Solved {
  meshes::Mesh mesh;
  assembly::Built built;
  analysis::Equilibrium found;
  std::unique_ptr<system::SystemProblem> problem;
  std::vector<assembly::SectionPoint> sections;

  const system::NodeState& node(Index n) const {
    return problem->workspace().nodes[static_cast<std::size_t>(n)];
  }
  const system::NodeState& node_at(const model::Location& l) const {
    return node(mesh.place(l).node);
  }
  Vec3 support(std::size_t i) const {
    return built.support_forces[i].force(
        [this](Index n) -> const system::NodeState& { return node(n); }, system::Context{},
        [this](Index k) { return r[k]; });
  }
  VecX r;
};

/// Equilibrium at Omega (all rotating lines).
inline Solved solve(const model::Model& m, double Omega = 0.0, double load = 1.0) {
  Solved s{meshes::make_mesh(m), {}, {}, nullptr, {}, {}};
  s.built = assembly::build_system(m, s.mesh);
  analysis::SteadyRotation running;
  for (const model::Shaft& shaft : m.shafts)
    running.ratio.push_back(shaft.rotating ? shaft.speed_ratio : 0.0);
  analysis::SteadySystem turning(s.built.system, running);
  turning.set_load(load);
  analysis::EquilibriumSolver solver(turning);
  s.found = solver.solve(Omega);
  s.problem = std::make_unique<system::SystemProblem>(s.built.system);
  s.problem->frames = s.found.state.frames;
  s.problem->workspace().context.load = load;
  s.r.resize(s.built.system.size());
  const system::State& x = s.found.state;
  s.problem->residual(0.0, x.q, x.v, x.a, s.r);
  s.problem->power(0.0, x.q, x.v, x.a, s.r);
  s.sections = assembly::calc_section_results(m, s.mesh, s.built, s.problem->workspace());
  return s;
}

}  // namespace whirl::test
