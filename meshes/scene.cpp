#include <meshes/scene.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::meshes {
namespace {

struct Radii {
  double outer, inner;
};

/// Radii of a section at the fraction xi.
Radii radii(const model::Section& s, double line_length, double xi) {
  const auto mix = [xi](double a, double b) { return 0.5 * (a + xi * (b - a)); };
  if (s.od_l > 0 || s.od_r > 0) return {mix(s.od_l, s.od_r), mix(s.id_l, s.id_r)};
  if (s.constants && s.constants->EA > 0 && s.constants->EI > 0)
    return {2 * std::sqrt(s.constants->EI / s.constants->EA), 0};  // EI/EA = r^2/4
  if (s.general && s.general->A > 0) return {std::sqrt(s.general->A / pi), 0};
  return {0.01 * line_length, 0};
}

/// Largest radius of the line at a place (a step has two).
double radius_at(const model::Shaft& shaft, double length, double s) {
  double start = 0, r = 0;
  for (const auto& k : shaft.sections) {
    if (s >= start - 1e-9 * length && s <= start + k.length + 1e-9 * length)
      r = std::max(r, radii(k, length, std::clamp((s - start) / k.length, 0.0, 1.0)).outer);
    start += k.length;
  }
  return r;
}

DiskShape disk_shape(const model::Disk& d, Place at, double shaft_radius) {
  DiskShape out;
  out.name = d.name;
  out.at = {at.node, at.offset + d.offset.x()};
  out.outer = 0.5 * d.draw_od;
  out.width = d.draw_width;
  if (!(out.outer > 0) && d.mass > 0 && d.Ip > 0) out.outer = std::sqrt(2 * d.Ip / d.mass);
  if (!(out.outer > 0)) out.outer = shaft_radius > 0 ? 2 * shaft_radius : 0.05;
  if (!(out.width > 0) && d.mass > 0) {  // Id = m (3 r^2 + w^2)/12
    const double w2 = 12 * d.Id / d.mass - 3 * out.outer * out.outer;
    out.width = w2 > 0 ? std::min(std::sqrt(w2), 2 * out.outer) : 0.0;
  }
  out.width = std::max(out.width, 0.04 * out.outer);
  out.inner = d.draw_id > 0 ? 0.5 * d.draw_id : shaft_radius;
  out.inner = std::min(out.inner, 0.9 * out.outer);
  return out;
}

/// Draws one line of a scene.
class LineDrawing {
 public:
  LineDrawing(const model::Model& m, const Mesh& mesh, std::size_t l, Scene& scene)
      : model_(m),
        mesh_(mesh),
        number_(l),
        line_(mesh.lines[l]),
        shaft_(m.shafts[l]),
        bent_(!shaft_.path.empty()),
        scene_(scene) {}

  Scene::Line draw() {
    out_.name = line_.name;
    add_stations();
    add_stretches();
    add_pieces();
    add_disks();
    return std::move(out_);
  }

 private:
  struct Piece {
    double s;
    ShaftPiece shape;
  };

  /// Axes of a line along a path, before and after s; the same on both sides of a smooth joint.
  std::pair<Index, Index> bends(double s) {
    const Mat3 before = shaft_.path.before(s).triad, after = shaft_.path.after(s).triad;
    const auto add = [&](const Mat3& triad) {
      scene_.bends.push_back(triad);
      return static_cast<Index>(scene_.bends.size()) - 1;
    };
    const Index b = add(before);
    return std::pair(b, (after - before).norm() < 1e-6 ? b : add(after));
  }

  void add_stations() {
    for (Index k = line_.first_station; k < line_.first_station + line_.stations; ++k) {
      const Station& s = mesh_.stations[static_cast<std::size_t>(k)];
      out_.points.push_back(s.at);
      out_.radius.push_back(radius_at(shaft_, line_.length, s.s));
      if (!bent_) continue;
      const auto [before, after] = bends(s.s);
      out_.bend_before.push_back(before);
      out_.bend_after.push_back(after);
    }
  }

  /// Which element, and with it which section forces, there is between two points. At what has a name
  /// something may stand: a step, a support, a body, a load.
  void add_stretches() {
    Index next = line_.first_element;
    for (std::size_t k = 0; k < out_.points.size(); ++k) {
      const Station& s = mesh_.stations[static_cast<std::size_t>(line_.first_station) + k];
      out_.breaks.push_back(!s.labels.empty());
      if (k + 1 == out_.points.size()) return;
      const bool elastic =
          next < line_.first_element + line_.elements &&
          mesh_.elements[static_cast<std::size_t>(next)].left.node == out_.points[k].node &&
          mesh_.elements[static_cast<std::size_t>(next)].right.node == out_.points[k + 1].node;
      out_.elements.push_back(elastic ? next++ : -1);
    }
  }

  void add_piece(std::size_t section, double s, Place a, Place b, double xi1, double xi2) {
    const Radii r1 = radii(shaft_.sections[section], line_.length, xi1),
                r2 = radii(shaft_.sections[section], line_.length, xi2);
    pieces_.push_back({s, {a, b, r1.outer, r2.outer, r1.inner, r2.inner}});
  }

  /// Elements and rigid parts in order of their left ends.
  void add_pieces() {
    for (Index k = line_.first_element; k < line_.first_element + line_.elements; ++k) {
      const Element& e = mesh_.elements[static_cast<std::size_t>(k)];
      add_piece(e.section, e.s1, e.left, e.right, e.xi1, e.xi2);
      pieces_.back().shape.element = k;
      if (bent_) bend_last_piece(e);
    }
    for (const RigidPart& r : mesh_.rigid_parts)
      if (r.line == static_cast<Index>(number_))
        add_piece(r.section, mesh_.nodes[static_cast<std::size_t>(r.node)].s + r.o1, {r.node, r.o1},
                  {r.node, r.o2}, 0, 1);
    std::stable_sort(pieces_.begin(), pieces_.end(),
                     [](const Piece& a, const Piece& b) { return a.s < b.s; });
    for (Piece& p : pieces_)
      out_.pieces.push_back(p.shape);
  }

  void bend_last_piece(const Element& e) {
    ShaftPiece& p = pieces_.back().shape;
    const Index last = pieces_.size() > 1 ? pieces_[pieces_.size() - 2].shape.bend_right : -1;
    const Mat3 from = shaft_.path.after(e.s1).triad;
    p.bend_left = last >= 0 && (scene_.bends[static_cast<std::size_t>(last)] - from).norm() < 1e-6
                      ? last
                      : bends(e.s1).second;
    p.bend_right = bends(e.s2).first;
  }

  void add_disks() {
    for (const auto& d : model_.disks) {
      if (d.at.shaft != number_) continue;
      const double inside = radius_at(shaft_, line_.length, d.at.s);
      out_.disks.push_back(disk_shape(d, mesh_.place(d.at), inside));
      if (bent_ && d.at.housing < 0) out_.disks.back().bend = bends(d.at.s).second;
    }
  }

  const model::Model& model_;
  const Mesh& mesh_;
  std::size_t number_;
  const Line& line_;
  const model::Shaft& shaft_;
  bool bent_;
  Scene& scene_;
  Scene::Line out_;
  std::vector<Piece> pieces_;
};

SupportShape support_shape(const model::Model& m, const Mesh& mesh, std::size_t bearing,
                           Scene& scene) {
  const model::Bearing& b = m.bearings[bearing];
  const BearingNodes& n = mesh.bearings[bearing];
  SupportShape s;
  s.name = b.name;
  s.picture = model::traits_of(b.law).picture;
  s.at = n.shaft;
  s.to_node = n.other.node >= 0 && n.other.node != n.ground;
  if (s.to_node) s.to = n.other;
  s.radius = radius_at(m.shafts[b.at.shaft], mesh.lines[b.at.shaft].length, b.at.s);
  if (const Path& path = m.shafts[b.at.shaft].path; !path.empty()) {
    s.bend = static_cast<Index>(scene.bends.size());
    scene.bends.push_back(path.after(b.at.s).triad);
  }
  return s;
}

}  // namespace

Scene make_scene(const model::Model& m, const Mesh& mesh) {
  WHIRL_EXPECTS(mesh.lines.size() == m.shafts.size());
  WHIRL_EXPECTS(mesh.bearings.size() == m.bearings.size());
  Scene scene;
  for (const Node& n : mesh.nodes) {
    scene.nodes.push_back(n.position);
    scene.node_line.push_back(std::max<Index>(n.line, 0));
  }
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    scene.lines.push_back(LineDrawing(m, mesh, l, scene).draw());
  for (std::size_t i = 0; i < m.bearings.size(); ++i)
    scene.supports.push_back(support_shape(m, mesh, i, scene));
  for (const model::Joint& j : m.joints) {
    scene.joints.push_back({j.name, mesh.place(j.at)});
    if (const Path& path = m.shafts[j.at.shaft].path; !path.empty()) {
      scene.joints.back().bend = static_cast<Index>(scene.bends.size());
      scene.bends.push_back(path.after(j.at.s).triad);
    }
  }
  for (const auto& p : m.probes)
    scene.trails.push_back({p.name, mesh.place(p.at)});
  return scene;
}

}  // namespace whirl::meshes
