#include <app/support_coefficients.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace whirl::app {

namespace {

/// Batches of system::System that hold the bearings of a law; null: its coefficients are constant.
const char* kind_of(const model::BearingLaw& law) {
  if (std::holds_alternative<model::ShortJournal>(law) || std::holds_alternative<model::FiniteJournal>(law)) return "journal bearings";
  if (std::holds_alternative<model::SqueezeFilm>(law)) return "squeeze films";
  if (std::holds_alternative<model::AnnularSeal>(law)) return "annular seals";
  if (std::holds_alternative<model::BallBearing>(law)) return "ball bearings";
  if (std::holds_alternative<model::RollerBearing>(law)) return "roller bearings";
  if (std::holds_alternative<model::Rub>(law)) return "contacts";
  if (const auto* table = std::get_if<model::TableBearing>(&law)) return table->frequency.empty() ? "tabulated bearings" : "bearings tabulated against frequency";
  return nullptr;
}

}  // namespace

io::Table support_coefficients(const Job& job, const StepState& s) {
  io::Table t;
  t.title = "Bearings about the equilibrium";
  t.columns = {{"bearing", "-", ""}, {"speed", "rpm", ""}, {"load", "N", "on the bearing, lateral"}, {"y", "m", "shaft against housing"}, {"z", "m", ""},
               {"eccentricity", "m", ""}, {"eccentricity / clearance", "-", ""}, {"attitude", "deg", "from the load in the sense y to z"}};
  for (const char* m : {"k", "c"})
    for (const char* e : {"yy", "yz", "zy", "zz"}) t.columns.push_back({std::string(m) + e, m[0] == 'k' ? "N/m" : "N s/m", ""});

  const system::System& system = job.system();
  system::Workspace w = system.make_workspace();
  w.context.averaged = s.speed != 0.0;
  la::MCK matrices = system.make_matrices();
  const system::State& x = s.state;
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const model::Bearing& b = job.model.bearings[i];
    const char* kind = kind_of(b.law);
    if (!kind) continue;
    std::vector<std::size_t> only;
    for (std::size_t k = 0; k < system.terms().size(); ++k)
      if (system.terms()[k]->kind() == kind) only.push_back(k);
    const meshes::BearingNodes& n = job.mesh.bearings[i];
    const bool alone = std::count_if(job.mesh.bearings.begin(), job.mesh.bearings.end(), [&](const meshes::BearingNodes& o) {
                         const model::Bearing& other = job.model.bearings[static_cast<std::size_t>(&o - job.mesh.bearings.data())];
                         const char* k = kind_of(other.law);
                         return k && std::string_view(k) == kind && (o.shaft.node == n.shaft.node || o.other.node == n.shaft.node);
                       }) == 1;
    if (only.empty() || !alone) continue;   // two of a kind on one node cannot be told apart
    if (!system.tangent(w, x.frames, x.t, x.q, x.v, x.a, matrices, &only)) continue;
    const la::BlockPattern& pattern = matrices.K.pattern();
    const Index slot = pattern.slot(n.shaft.node, n.shaft.node);
    if (slot < 0) continue;
    const Mat2 K = matrices.K.block(slot).block<2, 2>(1, 1), C = matrices.C.block(slot).block<2, 2>(1, 1);
    const auto node = [&](Index k) -> const system::NodeState& { return w.nodes[static_cast<std::size_t>(k)]; };
    const auto place = [&](const meshes::Place& p) { return Vec2((node(p.node).u + p.offset * node(p.node).t).tail<2>()); };
    const Vec2 r = place(n.shaft) - place(n.other);
    double clearance = nan;
    for (const assembly::SupportCondition& c : job.built.conditions)
      if (c.name == b.name) clearance = c.state(node).gap;
    const auto force = std::find_if(job.built.support_forces.begin(), job.built.support_forces.end(), [&](const auto& f) { return f.name == b.name; });
    const Vec2 F = force != job.built.support_forces.end() ? Vec2(force->force(node, x.t, [](Index) { return 0.0; }).tail<2>()) : Vec2::Zero();
    double attitude = nan;
    if (F.norm() > 0 && r.norm() > 0) {
      attitude = (std::atan2(r.y(), r.x()) - std::atan2(-F.y(), -F.x())) * 180.0 / pi;
      attitude -= 360.0 * std::floor(attitude / 360.0);
      if (attitude > 360.0 - 1e-9) attitude = 0.0;
    }
    t.add({b.name, node(n.shaft.node).spin() * 30.0 / pi, F.norm(), r.x(), r.y(), r.norm(), r.norm() / clearance, attitude, K(0, 0), K(0, 1), K(1, 0), K(1, 1), C(0, 0), C(0, 1), C(1, 0), C(1, 1)});
  }
  return t;
}

}  // namespace whirl::app
