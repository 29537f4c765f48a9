#include <results/clearances.hpp>

#include <core/contract.hpp>

#include <algorithm>

namespace whirl::results {

std::vector<std::size_t> seals_of(const model::Model& m) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < m.bearings.size(); ++i)
    if (std::holds_alternative<model::AnnularSeal>(m.bearings[i].law)) out.push_back(i);
  return out;
}

double seal_gap(const model::Bearing& seal) {
  return std::get<model::AnnularSeal>(seal.law).clearance;
}

double displacement_at(const meshes::BearingNodes& at, const assembly::NodeAt& node) {
  const auto place = [&node](const meshes::Place& p) -> Vec3 {
    if (p.node < 0) return Vec3::Zero();
    const system::NodeState& n = node(p.node);
    return n.u + p.offset * n.t;
  };
  return (place(at.shaft) - place(at.other)).tail<2>().norm();
}

std::vector<analysis::Point> station_points(const run::Job& job) {
  std::vector<analysis::Point> points;
  for (const meshes::Station& s : job.mesh.stations)
    points.push_back({s.at.node, s.at.offset});
  return points;
}

namespace {

io::Table clearance_table(const run::Job& job, const std::string& of,
                          const std::vector<UsedGap>& gaps) {
  io::Table t;
  t.title = "Clearances: " + of;
  t.columns = {
      {"at", "-", ""},
      {"position", "m", "along the machine"},
      {"gap", "m", "radial"},
      {"largest displacement", "m", "against the other side, static displacement included"},
      {"of the gap", "%", ""},
      {"when", "-", ""}};
  for (const UsedGap& g : gaps) {
    const model::Bearing& b = job.model.bearings[g.bearing];
    io::Table::Cell share = 100 * g.reach / g.gap;
    t.add({b.name, job.mesh.station(b.at).position.x(), g.gap, g.reach, share, g.at});
  }
  return t;
}

}  // namespace

void add_clearances(const run::Job& job, io::ReportSection& section, const std::string& id,
                    const std::string& of, const std::vector<double>& reach,
                    const std::vector<UsedGap>& gaps) {
  const meshes::Mesh& mesh = job.mesh;
  WHIRL_EXPECTS(reach.size() == mesh.stations.size());
  std::vector<plot::ReachLine> lines;
  for (const meshes::Line& l : mesh.lines) {
    plot::ReachLine line{l.name, {}, {}};
    for (Index k = l.first_station; k < l.first_station + l.stations; ++k) {
      line.x.push_back(mesh.stations[at(k)].position.x());
      line.reach.push_back(reach[at(k)]);
    }
    lines.push_back(std::move(line));
  }
  std::vector<plot::GapMark> marks;
  for (const UsedGap& g : gaps) {
    const model::Bearing& b = job.model.bearings[g.bearing];
    marks.push_back({b.name, mesh.station(b.at).position.x(), g.gap, g.reach});
  }
  plot::Figure f = plot::plot_clearances(id, "Clearance diagram: " + of, lines, marks);
  f.caption =
      "Lines: largest distance of each station from its place at rest, static displacement "
      "included. Marks: largest displacement against the other side of a gap, which may move "
      "itself.";
  section.figures.push_back(std::move(f));
  section.tables.push_back(clearance_table(job, of, gaps));
}

}  // namespace whirl::results
