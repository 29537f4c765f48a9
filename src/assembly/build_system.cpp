#include <core/contract.hpp>
#include <assembly/parts.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace whirl::assembly {

void Assembly::error(const char* code, std::string message, std::string hint,
                     const model::Entity& e, std::string entity) {
  Diagnostic d{Diagnostic::Severity::error, code, std::move(message), std::move(hint), e.where};
  d.where.entity = std::move(entity);
  errors.push_back(std::move(d));
}

Built build_system(const model::Model& model, const meshes::Mesh& mesh, const std::string& step,
                   FilmOil oil) {
  WHIRL_EXPECTS(mesh.lines.size() == model.shafts.size());
  WHIRL_EXPECTS(mesh.bearings.size() == model.bearings.size());
  Assembly a{model, mesh, step, oil, {}, {}, {}};
  // Nodes in the order of the mesh: indices agree everywhere.
  for (const meshes::Line& line : mesh.lines)
    a.builder.add_line(line.name);
  Index supports = -1;
  for (const meshes::Node& n : mesh.nodes) {
    if (n.kind == meshes::NodeKind::ground) {
      a.builder.add_ground(n.position, n.name);
      continue;
    }
    Index line = n.line;
    if (n.kind ==
        meshes::NodeKind::pedestal) {  // axes of their own: those of a shaft line may be moved
      if (supports < 0) supports = a.builder.add_line("supports");
      line = supports;
    }
    a.builder.add_node({n.position, line, n.name, false});
  }
  a.builder.set_gravity(model.gravity);
  add_shafts(a);
  add_thermal_bows(a);
  add_cracks(a);
  add_bodies(a);
  add_unbalances(a);
  add_supports(a);
  add_joints(a);
  add_foundations(a);
  add_loads(a);
  add_turning_base(a);
  check_restraint(a);
  if (!a.errors.empty()) {
    std::stable_sort(a.errors.begin(), a.errors.end(),
                     [](const auto& x, const auto& y) { return x.where.line < y.where.line; });
    throw Error(Exit::deck, std::move(a.errors));
  }
  Built out = std::move(a.built);
  out.system = a.builder.finalize();
  const std::vector<double> held = out.system.breakpoints();
  out.breakpoints.insert(out.breakpoints.end(), held.begin(), held.end());
  const std::vector<Pace> paces = out.system.paces();
  out.paces.insert(out.paces.end(), paces.begin(), paces.end());
  std::sort(out.breakpoints.begin(), out.breakpoints.end());
  out.breakpoints.erase(std::unique(out.breakpoints.begin(), out.breakpoints.end()),
                        out.breakpoints.end());
  return out;
}

}  // namespace whirl::assembly
