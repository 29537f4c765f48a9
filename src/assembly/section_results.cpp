#include <assembly/section_results.hpp>
#include <core/contract.hpp>

#include <assembly/element_section.hpp>
#include <core/rotation.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {
namespace {

using system::NodeState;

struct SectionEnd {
  Vec3 r, d, F, M;
};

/// Moment of a force in X: virtual work on delta d = theta x d, delta phi = theta.(e + d)/(1 +
/// e.d).
Vec3 moment_of(const NodeState& n, const Vec3& f_d, double f_phi) {
  const Vec3 d = n.d();
  return d.cross(f_d) + f_phi / (2.0 + n.e().dot(n.t)) * (n.e() + d);
}

/// The second axis of sections that bend but do not turn: the smallest rotation that takes the axis
/// of the line to the normal of the section. Where the normal is opposite to that axis (a beam bent
/// by half a turn) there is no smallest: the axis of the section before it goes on.
class SectionAxis {
 public:
  Vec3 axis(Index line, const Mat3& of_line, const Vec3& normal) {
    const bool opposite = (of_line.col(0) + normal).squaredNorm() < opposite_within;
    if (line != line_) ey_ = of_line.col(1);
    if (!opposite)
      ey_ = rotation::minimal_rotation(of_line.col(0), normal) * of_line.col(1);
    else if (line == line_)
      ey_ = rotation::minimal_rotation(normal_, normal) * ey_;
    line_ = line;
    normal_ = normal;
    return ey_;
  }

 private:
  static constexpr double opposite_within = 1e-16;
  Index line_ = -1;
  Vec3 normal_ = Vec3::Zero(), ey_ = Vec3::Zero();
};

void add_stress(const elements::ElementSection& s, double xi, SectionPoint& p) {
  if (s.constants) return;
  const double od = s.od1 + xi * (s.od2 - s.od1), id = s.id1 + xi * (s.id2 - s.id1);
  if (!(od > 0)) return;
  const double A = elements::annulus_area(od, id), I = elements::annulus_I(od, id),
               J = elements::annulus_J(od, id), c = 0.5 * od, ri = 0.5 * id;
  const double shear =
      4.0 * p.V.norm() * (c * c + c * ri + ri * ri) / (3.0 * A * (c * c + ri * ri));
  p.has_stress = true;
  p.axial = p.N / A;
  p.bending = p.M.norm() * c / I;
  p.torsion = std::abs(p.T) * c / J;
  const double surface = std::hypot(std::abs(p.axial) + p.bending, std::sqrt(3.0) * p.torsion);
  p.von_mises = std::max(surface, std::hypot(p.axial, std::sqrt(3.0) * (p.torsion + shear)));
}

/// An element as it stands now: its ends, and how moments change along it.
struct BentElement {
  SectionEnd a, b;
  bool bent = false;  ///< along a path
  Mat3 t1, t2;        ///< axes of such a line at the ends
  Vec3 dM1, dM2;      ///< N m, L dM/ds at the ends
};

BentElement stand(const model::Shaft& shaft, const meshes::Mesh& mesh, const meshes::Element& e,
                  const system::NodeState& n1, const system::NodeState& n2,
                  const system::ForceX<14>& f) {
  const double L = e.s2 - e.s1;
  BentElement out;
  SectionEnd &a = out.a, &b = out.b;
  a.d = n1.d();
  b.d = n2.d();
  a.r = mesh.nodes[static_cast<std::size_t>(e.left.node)].position + n1.u + e.left.offset * a.d;
  b.r = mesh.nodes[static_cast<std::size_t>(e.right.node)].position + n2.u + e.right.offset * b.d;
  a.F = -f.segment<3>(0);
  b.F = f.segment<3>(7);
  a.M = -moment_of(n1, f.segment<3>(3), f[6]) - e.left.offset * a.d.cross(a.F);
  b.M = moment_of(n2, f.segment<3>(10), f[13]) - e.right.offset * b.d.cross(b.F);
  const Vec3 chord = (b.r - a.r) / L;
  out.bent = !shaft.path.empty();
  if (out.bent) {
    out.t1 = meshes::section_axes(*n1.chart, a.d, n1.phi) * shaft.path.after(e.s1).triad;
    out.t2 = meshes::section_axes(*n2.chart, b.d, n2.phi) * shaft.path.before(e.s2).triad;
  }
  out.dM1 = -L * (out.bent ? Vec3(out.t1.col(0)) : chord).cross(a.F);
  out.dM2 = -L * (out.bent ? Vec3(out.t2.col(0)) : chord).cross(b.F);
  return out;
}

/// Forces and moments at the share x of the element, in the axes of the section there. chart: of
/// the line.
void resolve(const BentElement& e, const Mat3& chart, double x, SectionAxis& transported,
             SectionPoint& p) {
  const double y = 1.0 - x;
  p.force = y * e.a.F + x * e.b.F;
  p.moment = y * y * (1.0 + 2.0 * x) * e.a.M + x * x * (3.0 - 2.0 * x) * e.b.M +
             x * y * (y * e.dM1 - x * e.dM2);
  const Vec3 d =
      (e.bent ? Vec3(y * e.t1.col(0) + x * e.t2.col(0)) : Vec3(y * e.a.d + x * e.b.d)).normalized();
  Vec3 ey;
  if (e.bent) {  // turning with the twist from end to end
    const Vec3 mean = y * e.t1.col(1) + x * e.t2.col(1);
    ey = (mean - d.dot(mean) * d).normalized();
  } else {
    ey = transported.axis(p.line, chart, d);
  }
  const Vec3 ez = d.cross(ey);
  p.normal = d;
  p.N = p.force.dot(d);
  p.V = Vec2(p.force.dot(ey), p.force.dot(ez));
  p.T = p.moment.dot(d);
  p.M = Vec2(p.moment.dot(ey), p.moment.dot(ez));
}

}  // namespace

namespace {

/// What an element puts on its nodes, as they are seen together.
system::ForceX<14> element_force(const Built& built, std::size_t element,
                                 const std::array<NodeState, 2>& ends, const system::Context& c) {
  system::ForceX<14> f = system::ForceX<14>::Zero();
  built.element_forces.at(element)(built.system, {&ends[0], &ends[1]}, c, f);
  return f;
}

/// force(element, ends): what it puts on its nodes.
template <class Force>
void list_points(const model::Model& m, const meshes::Mesh& mesh, const Built& built,
                 const system::Workspace& w, int inner, const Force& force,
                 std::vector<SectionPoint>& out) {
  WHIRL_EXPECTS(inner >= 0);
  out.clear();
  SectionAxis transported;
  out.reserve(mesh.elements.size() * static_cast<std::size_t>(inner + 2));
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    const meshes::Element& e = mesh.elements[k];
    const auto ends = system::seen_together(built.system, w, e.left.node, e.right.node);
    const model::Shaft& shaft = m.shafts[static_cast<std::size_t>(e.line)];
    const BentElement now = stand(shaft, mesh, e, ends[0], ends[1], force(k, ends));
    const Mat3& chart = *w.in_own_axes(e.left.node).chart;
    const model::Section& section = shaft.sections[e.section];
    const elements::ElementSection shape = element_section(m, e);
    for (int j = 0; j <= inner + 1; ++j) {
      const double x = static_cast<double>(j) / (inner + 1);
      SectionPoint p;
      p.line = e.line;
      p.element = static_cast<Index>(k);
      p.s = j == 0 ? e.s1 : j == inner + 1 ? e.s2 : e.s1 + x * (e.s2 - e.s1);
      p.xi = x;
      resolve(now, chart, x, transported, p);
      if (!section.general) add_stress(shape, x, p);
      out.push_back(p);
    }
  }
}

}  // namespace

ElementForces calc_element_forces(const meshes::Mesh& mesh, const Built& built,
                                  const system::Workspace& w) {
  WHIRL_EXPECTS(built.element_forces.size() == mesh.elements.size());
  ElementForces out;
  out.reserve(mesh.elements.size());
  for (const meshes::Element& e : mesh.elements)
    out.push_back(element_force(built, out.size(),
                                system::seen_together(built.system, w, e.left.node, e.right.node),
                                w.context));
  return out;
}

std::vector<SectionPoint> calc_section_results(const model::Model& m, const meshes::Mesh& mesh,
                                               const Built& built, const system::Workspace& w,
                                               int inner) {
  std::vector<SectionPoint> out;
  calc_section_results(m, mesh, built, w, inner, out);
  return out;
}

std::vector<SectionPoint> calc_section_results(const model::Model& m, const meshes::Mesh& mesh,
                                               const Built& built, const system::Workspace& w,
                                               const ElementForces& forces, int inner) {
  WHIRL_EXPECTS(forces.size() == mesh.elements.size());
  std::vector<SectionPoint> out;
  const auto force = [&](std::size_t k, const auto&) { return forces[k]; };
  list_points(m, mesh, built, w, inner, force, out);
  return out;
}

void calc_section_results(const model::Model& m, const meshes::Mesh& mesh, const Built& built,
                          const system::Workspace& w, int inner, std::vector<SectionPoint>& out) {
  WHIRL_EXPECTS(built.element_forces.size() == mesh.elements.size());
  const auto force = [&](std::size_t k, const std::array<NodeState, 2>& ends) {
    return element_force(built, k, ends, w.context);
  };
  list_points(m, mesh, built, w, inner, force, out);
}

// The moment of a generalized force on phi has that force as its part along the normal.
std::array<double, 2> calc_torques(const meshes::Mesh& mesh, const Built& built,
                                   const system::Workspace& w, std::size_t element) {
  WHIRL_EXPECTS(built.element_forces.size() == mesh.elements.size());
  const meshes::Element& e = mesh.elements.at(element);
  const auto ends = system::seen_together(built.system, w, e.left.node, e.right.node);
  const system::ForceX<14> f = element_force(built, element, ends, w.context);
  return {-f[6], f[13]};
}

}  // namespace whirl::assembly
