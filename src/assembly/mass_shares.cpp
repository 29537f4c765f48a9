#include <assembly/mass_shares.hpp>

#include <assembly/element_section.hpp>
#include <assembly/node_inertia.hpp>

#include <algorithm>

namespace whirl::assembly {
namespace {

/// Lateral stiffness of a bearing that has a constant one, N/m; 0 for the rest.
double stiffness_of(const model::BearingLaw& law) {
  if (const auto* b = std::get_if<model::SpringBlock>(&law)) return b->C1;
  if (const auto* b = std::get_if<model::LinearBearing>(&law))
    return 0.5 * (b->K(1, 1) + b->K(2, 2));
  return 0.0;
}

/// What a bearing puts on a node: lateral forces, tilting moments, torques.
struct Loads {
  bool forces, moments, torques;
};
Loads loads_of(const model::BearingLaw& law) {
  const auto of_matrices = [](const Matrix<6>& K, const Matrix<6>& C) {
    const auto row = [&](Index c) { return !K.row(c).isZero(0.0) || !C.row(c).isZero(0.0); };
    return Loads{row(1) || row(2), K(4, 4) + K(5, 5) > 0, K(3, 3) > 0};
  };
  if (const auto* b = std::get_if<model::LinearBearing>(&law)) return of_matrices(b->K, b->C);
  if (const auto* b = std::get_if<model::TableBearing>(&law)) {
    Loads any{};
    for (std::size_t i = 0; i < b->K.size(); ++i) {
      const Loads l =
          of_matrices(b->K[i], i < b->C.size() ? b->C[i] : Matrix<6>(Matrix<6>::Zero()));
      any = {any.forces || l.forces, any.moments || l.moments, any.torques || l.torques};
    }
    return any;
  }
  const bool coupling = std::holds_alternative<model::Coupling>(law);
  return {true, coupling || std::holds_alternative<model::SpringBlock>(law),
          coupling || std::holds_alternative<model::GearPair>(law)};
}

/// 12 EI/l^3 of the elements at a node, N/m.
double stiffness_at(const Assembly& a, Index node) {
  double sum = 0;
  for (const meshes::Element& e : a.mesh.elements) {
    if (e.left.node != node && e.right.node != node) continue;
    const model::Section& section =
        a.model.shafts[static_cast<std::size_t>(e.line)].sections[e.section];
    const double l = e.s2 - e.s1, EI = section.general
                                           ? a.model.materials.at(section.material).E *
                                                 std::min(section.general->Iy, section.general->Iz)
                                           : element_section(a.model, e).at(0.5).EI;
    sum += 12 * EI / (l * l * l);
  }
  return sum;
}

}  // namespace

MassShares::MassShares(const Assembly& a) : of_(a.mesh.nodes.size(), Vec3(1, 1, 1)) {
  for (const meshes::Line& line : a.mesh.lines) {
    const auto elements = element_inertias(a.model, a.mesh, line),
               bodies = body_inertias(a.model, a.mesh, line);
    const auto part = [](double own, double other) {
      return other > 0 ? own / (own + other) : 1.0;
    };
    for (std::size_t i = 0; i < elements.size(); ++i)
      of_[static_cast<std::size_t>(line.first_node) + i] = {part(elements[i].mass, bodies[i].mass),
                                                            part(elements[i].Id, bodies[i].Id),
                                                            part(elements[i].Ip, bodies[i].Ip)};
  }
  // Of the force of a bearing nothing is inertia, and half an element's mass is little beside it:
  // 0. Where it is stiffer than the element it hardly moves, and 1 gives the better force. Stops
  // are left most of the time, and what is held does not move.
  for (std::size_t i = 0; i < a.model.bearings.size(); ++i) {
    const model::BearingLaw& law = a.model.bearings[i].law;
    if (std::holds_alternative<model::RigidSupport>(law) || std::holds_alternative<model::Rub>(law))
      continue;
    const Loads loads = loads_of(law);
    for (const Index node : {a.mesh.bearings[i].shaft.node, a.mesh.bearings[i].other.node}) {
      if (node < 0 || node >= static_cast<Index>(of_.size())) continue;
      const double k = stiffness_of(law), element = k > 0 ? stiffness_at(a, node) : 1.0;
      of_[static_cast<std::size_t>(node)].array() *=
          Vec3(loads.forces ? k / (k + element) : 1, loads.moments ? 0 : 1, loads.torques ? 0 : 1)
              .array();
    }
  }
}

}  // namespace whirl::assembly
