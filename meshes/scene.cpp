#include <meshes/scene.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::meshes {

namespace {

struct Diameters { double od_l, id_l, od_r, id_r; };

/// Diameters of a section between fractions xi1 and xi2, with a stand-in for sections that have none.
Diameters part(const model::Section& s, double xi1, double xi2, double thin) {
  auto mix = [](double a, double b, double x) { return a + (b - a) * x; };
  Diameters d{mix(s.od_l, s.od_r, xi1), mix(s.id_l, s.id_r, xi1), mix(s.od_l, s.od_r, xi2), mix(s.id_l, s.id_r, xi2)};
  if (d.od_l <= 0.0 && s.constants && s.constants->rhoA > 0.0) {
    // a solid round bar with this ratio of bending inertia to mass
    d.od_l = d.od_r = 4.0 * std::sqrt(s.constants->rhoI / s.constants->rhoA);
  }
  if (d.od_l <= 0.0 && s.general) d.od_l = d.od_r = 2.0 * std::sqrt(s.general->A / pi);
  if (d.od_l <= 0.0) d.od_l = d.od_r = thin;
  return d;
}

}  // namespace

Scene make_scene(const model::Model& model, const Mesh& mesh) {
  Scene scene;
  double length = 0.0;
  for (const Line& l : mesh.lines) length = std::max(length, l.length);
  const double thin = 0.02 * length;
  for (const Node& n : mesh.nodes) {
    scene.nodes.push_back(n.position);
    scene.node_line.push_back(std::max<Index>(n.line, 0));
  }
  std::vector<double> radius_at(mesh.lines.size(), 0.5 * thin);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const Line& line = mesh.lines[l];
    const model::Shaft& shaft = model.shafts[l];
    Scene::Line out;
    out.name = line.name;
    // pieces, left to right: flexible elements and rigid sections
    struct Piece { double s; ShaftPiece piece; };
    std::vector<Piece> pieces;
    auto add = [&](double s, const Place& a, const Place& b, const Diameters& d) {
      pieces.push_back({s, {a, b, 0.5 * d.od_l, 0.5 * d.od_r, 0.5 * d.id_l, 0.5 * d.id_r}});
    };
    for (Index k = line.first_element; k < line.first_element + line.elements; ++k) {
      const Element& e = mesh.elements[static_cast<std::size_t>(k)];
      add(e.s1, e.left, e.right, part(shaft.sections[e.section], e.xi1, e.xi2, thin));
    }
    for (const RigidPart& r : mesh.rigid_parts) {
      if (r.line != static_cast<Index>(l)) continue;
      const Node& n = mesh.nodes[static_cast<std::size_t>(r.node)];
      add(n.s + r.o1, {r.node, r.o1}, {r.node, r.o2}, part(shaft.sections[r.section], 0.0, 1.0, thin));
    }
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.s < b.s; });
    for (Piece& p : pieces) {
      if (out.points.empty()) {
        out.points.push_back(p.piece.left);
        out.radius.push_back(p.piece.outer_left);
      }
      out.points.push_back(p.piece.right);
      out.radius.push_back(p.piece.outer_right);
      out.pieces.push_back(p.piece);
    }
    for (const model::Disk& d : model.disks) {
      if (d.at.shaft != l) continue;
      const double bore = std::max(mesh.radius(model, l, d.at.s), 0.5 * thin);
      DiskShape shape{d.name, mesh.place(d.at), 0.5 * d.draw_od, 0.5 * d.draw_id, d.draw_width};
      // a solid round disk of this polar inertia
      if (shape.outer <= 0.0 && d.mass > 0.0 && d.Ip > 0.0) shape.outer = std::sqrt(2.0 * d.Ip / d.mass);
      if (shape.outer <= bore) continue;   // no larger than its shaft: nothing to draw
      if (shape.inner <= 0.0) shape.inner = bore;
      if (shape.width <= 0.0) shape.width = 0.15 * shape.outer;
      out.disks.push_back(shape);
    }
    scene.lines.push_back(std::move(out));
  }
  for (std::size_t k = 0; k < model.bearings.size(); ++k) {
    const model::Bearing& b = model.bearings[k];
    const BearingNodes& at = mesh.bearings[k];
    SupportShape s;
    s.name = b.name;
    s.kind = std::holds_alternative<model::SpringBlock>(b.law) ? SupportShape::Kind::spring : SupportShape::Kind::bearing;
    s.at = at.shaft;
    if (b.to || at.pedestal >= 0) s.to_node = true, s.to = at.other;
    s.radius = std::max(mesh.radius(model, b.at.shaft, b.at.s), 0.5 * thin);
    scene.supports.push_back(s);
  }
  for (const model::Probe& p : model.probes) scene.trails.push_back({p.name, mesh.place(p.at)});
  for (const model::Disk& d : model.disks) scene.trails.push_back({"disk " + d.name, mesh.place(d.at)});
  return scene;
}

}  // namespace whirl::meshes
