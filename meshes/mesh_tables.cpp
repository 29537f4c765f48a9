#include <meshes/mesh_tables.hpp>

#include <fmt/format.h>

#include <iterator>

namespace whirl::meshes {
namespace {

/// A CSV cell: quoted where it must be (RFC 4180).
std::string cell(const std::string& s) {
  if (s.find_first_of(",\"\r\n") == std::string::npos) return s;
  std::string out = "\"";
  for (char c : s)
    out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

const char* name_of(NodeKind k) {
  return k == NodeKind::shaft ? "shaft" : k == NodeKind::pedestal ? "pedestal" : "ground";
}

double mix(double a, double b, double xi) { return a == b ? a : a + xi * (b - a); }

}  // namespace

std::string nodes_csv(const Mesh& mesh) {
  std::string out = "node,name,kind,line,s[m],x[m],y[m],z[m]\n";
  auto to = std::back_inserter(out);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Node& n = mesh.nodes[i];
    const std::string line = n.line < 0 ? "" : mesh.lines[static_cast<std::size_t>(n.line)].name;
    fmt::format_to(to, "{},{},{},{},{},{},{},{}\n", i, cell(n.name), name_of(n.kind), cell(line),
                   n.s, n.position.x(), n.position.y(), n.position.z());
  }
  return out;
}

std::string elements_csv(const model::Model& m, const Mesh& mesh) {
  std::string out =
      "element,line,section,left,right,s1[m],s2[m],left_offset[m],right_offset[m],od1[m],id1[m],"
      "od2[m],id2[m]\n";
  auto to = std::back_inserter(out);
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const Element& e = mesh.elements[i];
    const model::Shaft& shaft = m.shafts[static_cast<std::size_t>(e.line)];
    const model::Section& s = shaft.sections[e.section];
    fmt::format_to(to, "{},{},{},{},{},{},{},{},{}", i, cell(shaft.name), cell(s.name), e.left.node,
                   e.right.node, e.s1, e.s2, e.left.offset, e.right.offset);
    if (s.od_l > 0 || s.od_r > 0)
      fmt::format_to(to, ",{},{},{},{}\n", mix(s.od_l, s.od_r, e.xi1), mix(s.id_l, s.id_r, e.xi1),
                     mix(s.od_l, s.od_r, e.xi2), mix(s.id_l, s.id_r, e.xi2));
    else
      out += ",,,,\n";
  }
  return out;
}

std::string stations_csv(const Mesh& mesh) {
  std::string out = "station,line,s[m],node,offset[m],element,labels\n";
  auto to = std::back_inserter(out);
  for (std::size_t i = 0; i < mesh.stations.size(); ++i) {
    const Station& s = mesh.stations[i];
    fmt::format_to(to, "{},{},{},{},{},{},{}\n", i,
                   cell(mesh.lines[static_cast<std::size_t>(s.line)].name), s.s, s.at.node,
                   s.at.offset, s.element < 0 ? std::string() : fmt::format("{}", s.element),
                   cell(s.label()));
  }
  return out;
}

std::string station_table(const model::Model& m, const Mesh& mesh) {
  std::string out = fmt::format("{:<14} {:>10} {:>9} {:>6} {:>10}  {}\n", "shaft", "s, m", "od, mm",
                                "node", "offset, m", "station");
  auto to = std::back_inserter(out);
  for (const Station& s : mesh.stations) {
    if (s.labels.empty()) continue;
    const auto line = static_cast<std::size_t>(s.line);
    fmt::format_to(to, "{:<14} {:>10.6g} {:>9.5g} {:>6} {:>10}  {}\n", mesh.lines[line].name, s.s,
                   2e3 * mesh.radius(m, line, s.s), s.at.node,
                   s.at.offset == 0 ? std::string("-") : fmt::format("{:.6g}", s.at.offset),
                   s.label());
  }
  return out;
}

}  // namespace whirl::meshes
