#include <plot/rotor_drawing.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot {

namespace {

/// A round pin for a hinge, a cross for a universal joint, a block for a slider, a seam for a weld.
DrawnJoint mark_of(const model::Joint& j, double s, double radius) {
  using Kind = model::JointKind;
  switch (j.kind) {
    case Kind::rigid: return {s, radius, j.name, "rigid joint", Marker::plus};
    case Kind::hinge: return {s, radius, j.name, "hinge", Marker::circle};
    case Kind::universal: return {s, radius, j.name, "universal joint", Marker::cross};
    case Kind::spherical: return {s, radius, j.name, "ball joint", Marker::diamond};
    case Kind::slider: return {s, radius, j.name, "slider", Marker::square};
  }
  return {};
}

/// Makes the drawing of one line of the mesh.
class RotorDrawer {
 public:
  RotorDrawer(const model::Model& model, const meshes::Mesh& mesh, const meshes::Scene& scene,
              std::size_t line)
      : model_(model),
        mesh_(mesh),
        scene_(scene),
        number_(line) {}
  RotorDrawing draw();

 private:
  double s_of(const meshes::Place& p) const { return mesh_.nodes[at(p.node)].s + p.offset; }
  bool on_line(const meshes::Place& p) const {
    return mesh_.nodes[at(p.node)].line == static_cast<Index>(number_);
  }
  double radius_at(double s) const;
  void add_sections();
  void add_bearing(const meshes::Place& p, const std::string& name);
  void add_probe(const model::Probe& p);

  const model::Model& model_;
  const meshes::Mesh& mesh_;
  const meshes::Scene& scene_;
  std::size_t number_;
  RotorDrawing d_;
};

void RotorDrawer::add_sections() {
  double s = 0;
  for (const auto& section : model_.shafts[number_].sections) {
    DrawnSection x{s,
                   s + section.length,
                   section.od_l / 2,
                   section.od_r / 2,
                   section.id_l / 2,
                   section.id_r / 2,
                   section.name};
    if (x.outer_left <= 0 && x.outer_right <= 0)  // constants instead of diameters
      for (const auto& p : scene_.lines[number_].pieces)
        if (const double m = (s_of(p.left) + s_of(p.right)) / 2; m > x.s0 && m < x.s1) {
          x.outer_left = p.outer_left;
          x.outer_right = p.outer_right;
        }
    d_.sections.push_back(std::move(x));
    s += section.length;
  }
}

double RotorDrawer::radius_at(double s) const {
  double r = 0;
  for (const auto& x : d_.sections)
    if (s >= x.s0 - 1e-9 && s <= x.s1 + 1e-9) {
      const double f = x.s1 > x.s0 ? std::clamp((s - x.s0) / (x.s1 - x.s0), 0.0, 1.0) : 0.0;
      r = std::max(r, x.outer_left + f * (x.outer_right - x.outer_left));
    }
  return r;
}

/// Several at one place are one mark with all their names.
void RotorDrawer::add_bearing(const meshes::Place& p, const std::string& name) {
  const double s = s_of(p);
  const auto same = std::find_if(d_.bearings.begin(), d_.bearings.end(),
                                 [s](const auto& x) { return std::abs(x.s - s) < 1e-9; });
  if (same != d_.bearings.end())
    same->name += ", " + name;
  else
    d_.bearings.push_back({s, radius_at(s), name});
}

/// At a disk it is drawn at the rim.
void RotorDrawer::add_probe(const model::Probe& p) {
  double r = radius_at(p.at.s);
  for (const auto& k : d_.disks)
    if (std::abs(p.at.s - k.s) <= k.width / 2) r = std::max(r, k.outer);
  d_.probes.push_back({p.at.s, r, p.name});
}

RotorDrawing RotorDrawer::draw() {
  const meshes::Line& line = mesh_.lines[number_];
  d_.title = model_.shafts[number_].path.empty() ? "Shaft ‘" + line.name + "’"
                                                 : "Line ‘" + line.name + "’, laid out straight";
  add_sections();
  for (const auto& k : scene_.lines[number_].disks)
    d_.disks.push_back({s_of(k.at), k.outer, k.inner, k.width, k.name});
  for (const auto& b : scene_.supports)
    for (const auto* p : {&b.at, b.to_node ? &b.to : nullptr})
      if (p && on_line(*p)) add_bearing(*p, b.name);
  for (const auto& p : model_.probes)
    if (p.at.shaft == number_) add_probe(p);
  for (const auto& j : model_.joints)
    for (const model::Location* p : {&j.at, j.to ? &*j.to : nullptr})
      if (p && p->shaft == number_) d_.joints.push_back(mark_of(j, p->s, radius_at(p->s)));
  for (Index k = line.first_node; k < line.first_node + line.nodes; ++k)
    d_.nodes.push_back(mesh_.nodes[at(k)].s);
  return std::move(d_);
}

}  // namespace

std::vector<RotorDrawing> make_rotor_drawings(const model::Model& model, const meshes::Mesh& mesh,
                                              const meshes::Scene& scene) {
  std::vector<RotorDrawing> all;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    all.push_back(RotorDrawer(model, mesh, scene, l).draw());
  return all;
}

std::vector<LineDrawing> make_line_drawings(const model::Model& model, const meshes::Mesh& mesh) {
  std::vector<LineDrawing> all;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const model::Shaft& shaft = model.shafts[l];
    if (shaft.path.empty()) continue;
    const meshes::Line& line = mesh.lines[l];
    LineDrawing d;
    d.title = "Line ‘" + line.name + "’ in space";
    for (Index k = line.first_element; k < line.first_element + line.elements; ++k) {
      const meshes::Element& e = mesh.elements[static_cast<std::size_t>(k)];
      for (int i = d.line.empty() ? 0 : 1; i <= 8; ++i)
        d.line.push_back(shaft.position(e.s1 + (e.s2 - e.s1) * i / 8.0));
    }
    for (Index k = line.first_node; k < line.first_node + line.nodes; ++k)
      d.nodes.push_back(mesh.nodes[static_cast<std::size_t>(k)].position);
    const auto add = [&](std::vector<DrawnPoint>& to, const model::Location& at,
                         const std::string& name) {
      if (at.shaft == l && at.housing < 0) to.push_back({shaft.position(at.s), name});
    };
    for (const auto& x : model.bearings) {
      add(d.supports, x.at, x.name);
      if (x.to) add(d.supports, *x.to, x.name);
    }
    for (const auto& x : model.disks)
      add(d.disks, x.at, x.name);
    for (const auto& x : model.probes)
      add(d.probes, x.at, x.name);
    for (const auto& x : model.joints) {
      add(d.joints, x.at, x.name);
      if (x.to) add(d.joints, *x.to, x.name);
    }
    all.push_back(std::move(d));
  }
  return all;
}

namespace {

/// Supports between two lines, and those of a line that stand on the ground.
void part_supports(const meshes::Mesh& mesh, const meshes::Scene& scene, MachineDrawing& machine,
                   const std::vector<double>& heights) {
  for (MachineLine& l : machine.lines)
    l.drawing.bearings.clear();
  const auto radius = [](const MachineLine& l, double s, bool inner) {
    double r = 0;
    for (const DrawnSection& x : l.drawing.sections)
      if (s >= x.s0 - 1e-9 && s <= x.s1 + 1e-9) {
        const double f = x.s1 > x.s0 ? std::clamp((s - x.s0) / (x.s1 - x.s0), 0.0, 1.0) : 0.0;
        r = std::max(r, inner ? std::lerp(x.inner_left, x.inner_right, f)
                              : std::lerp(x.outer_left, x.outer_right, f));
      }
    return r;
  };
  for (const meshes::SupportShape& b : scene.supports) {
    const meshes::Node& node = mesh.nodes[at(b.at.node)];
    if (node.line < 0) continue;
    MachineLine& line = machine.lines[at(node.line)];
    const double s = node.s + b.at.offset;
    const Index to = b.to_node ? mesh.nodes[at(b.to.node)].line : -1;
    if (to < 0) {
      line.drawing.bearings.push_back({s, radius(line, s, false), b.name});
      continue;
    }
    const MachineLine& other = machine.lines[at(to)];
    const double so = mesh.nodes[at(b.to.node)].s + b.to.offset;
    const double h = heights[at(node.line)], ho = heights[at(to)];
    const double x = line.x + s;
    if (std::abs(h - ho) > 1e-9) {  // side by side: from surface to surface
      const double up = ho > h ? 1 : -1;
      machine.links.push_back(
          {b.name, x, h + up * radius(line, s, false), ho - up * radius(other, so, false)});
      continue;
    }
    const bool inside = radius(line, s, false) <= radius(other, so, false);
    const double outer = radius(inside ? line : other, inside ? s : so, false);
    const double bore = radius(inside ? other : line, inside ? so : s, true);
    machine.links.push_back({b.name, x, h + outer, h + (bore > outer ? bore : outer)});
  }
}

/// All lines in one elevation, across the direction in which they are furthest apart.
MachineDrawing make_machine_drawing(const model::Model& model, const meshes::Mesh& mesh,
                                    const meshes::Scene& scene) {
  MachineDrawing machine;
  machine.title = "Machine";
  Vec3 low = mesh.lines.front().origin, high = low;
  for (const meshes::Line& l : mesh.lines) {
    low = low.cwiseMin(l.origin);
    high = high.cwiseMax(l.origin);
  }
  const Index across = high.y() - low.y() > high.z() - low.z() ? 1 : 2;
  if (high[across] - low[across] > 1e-9) machine.across = across == 1 ? "y" : "z";
  std::vector<double> heights;
  std::vector<RotorDrawing> drawings = make_rotor_drawings(model, mesh, scene);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    drawings[l].title = mesh.lines[l].name;
    heights.push_back(mesh.lines[l].origin[across]);
    machine.lines.push_back({std::move(drawings[l]), mesh.lines[l].origin.x(), heights.back()});
  }
  part_supports(mesh, scene, machine, heights);
  return machine;
}

}  // namespace

std::vector<Figure> draw_model(const model::Model& model, const meshes::Mesh& mesh,
                               const meshes::Scene& scene) {
  std::vector<Figure> all;
  const auto numbered = [](const char* name, int k) {
    return k == 1 ? std::string(name) : name + ("_" + std::to_string(k));
  };
  const auto straight = [](const model::Shaft& s) { return s.path.empty(); };
  if (mesh.lines.size() > 1 && std::all_of(model.shafts.begin(), model.shafts.end(), straight))
    all.push_back(plot_machine("machine", make_machine_drawing(model, mesh, scene)));
  int k = 0;
  for (const RotorDrawing& d : make_rotor_drawings(model, mesh, scene))
    all.push_back(plot_rotor(numbered("rotor", ++k), d));
  k = 0;
  for (const LineDrawing& d : make_line_drawings(model, mesh))
    all.push_back(plot_line(numbered("line", ++k), d));
  return all;
}

}  // namespace whirl::plot
