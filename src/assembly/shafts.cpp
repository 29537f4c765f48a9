// Shaft elements. Damping of a line: beta_internal acts on bending and axial strain rates seen
// turning with the shaft, beta_external on those seen in fixed axes; the twist rate is the same in
// both, so torsion gets beta_internal + beta_external + beta_torsion. alpha acts on the velocities
// of the shaft's own mass. The loss factor acts on all strain rates seen turning with the shaft
// (hysteretic_damping.hpp).
#include <assembly/element_section.hpp>
#include <assembly/mass_shares.hpp>
#include <assembly/parts.hpp>
#include <assembly/stressed.hpp>
#include <elements/shaft/general_beam.hpp>
#include <elements/shaft/hysteretic_damping.hpp>
#include <elements/shaft/section_beam.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/shaft_damping.hpp>
#include <elements/supports/weight_rest.hpp>
#include <meshes/mass_properties.hpp>
#include <model/full_section.hpp>

#include <core/interrupt.hpp>
#include <core/rotation.hpp>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {
namespace {

using elements::ShaftElementConstants;

/// To the element that is being made.
template <system::Kernel K>
void add_stressed(Assembly& a, const K& k, const std::array<Index, 2>& nodes, const char* kind) {
  add_stressed(a, k, nodes, kind, a.built.element_forces.size() - 1);
}

bool has_weight(const model::Model& m) {
  const auto& base = m.base.acceleration;
  return m.gravity != Vec3::Zero() || base[0] || base[1] || base[2];
}

/// Constants of an element, make(share), and the part of its weight that its share of the mass
/// leaves out. part: of their mass that is used.
template <class Make>
ShaftElementConstants shared_constants(Assembly& a, const MassShares& shares,
                                       const meshes::Element& e, Make make, double part = 1.0) {
  const elements::MassShare share = shares.of(e);
  const ShaftElementConstants c = make(share);
  const Vector<4> rest = part * (make({}).M4 - c.M4) * Vector<4>(1, 0, 1, 0);
  if (has_weight(a.model) && (rest.array() != 0).any())
    add_stressed(a, elements::WeightRest{rest}, {e.left.node, e.right.node},
                 "weights beside bodies");
  return c;
}

void add_damping(Assembly& a, const model::Shaft& shaft, const ShaftElementConstants& c,
                 const std::array<Index, 2>& nodes, bool internal) {
  const model::ShaftDamping& d = shaft.damping;
  const Vec3 e0 = Vec3::UnitX();
  const double twist = d.beta_internal + d.beta_external + d.beta_torsion;
  // The twist goes with whichever of the two exists.
  const bool all = a.model.keep_everything;
  const bool rotating = internal && (all || d.beta_internal != 0),
             fixed = all || d.beta_external != 0;
  if (rotating)
    add_stressed(a, elements::ShaftDamping<true>(c, e0, d.beta_internal, twist, d.beta_internal),
                 nodes, "internal damping");
  if (fixed || (twist != 0 && !rotating))
    a.builder.add(elements::ShaftDamping<false>(c, e0, d.beta_external, rotating ? 0.0 : twist,
                                                d.beta_external),
                  nodes, "external damping");
  if (all || d.alpha != 0) {
    elements::ShaftMassDamping m;
    m.C4 = d.alpha * c.M4;
    a.builder.add(m, nodes, "mass-proportional damping");
  }
}

double stand_in_of(const model::ShaftDamping& d) {
  return d.loss_frequency > 0 ? 1.0 / d.loss_frequency : 0.0;
}

void add_hysteresis(Assembly& a, const model::Shaft& shaft, const ShaftElementConstants& c,
                    const std::array<Index, 2>& nodes) {
  const model::ShaftDamping& d = shaft.damping;
  if (d.loss_factor == 0) return;
  using Viscous = elements::ShaftDamping<true>;
  add_stressed(a,
               elements::HystereticDamping<Viscous>{
                   Viscous(c, Vec3::UnitX(), d.loss_factor, 0.0, 0.0),
                   Viscous(c, Vec3::UnitX(), 0.0, d.loss_factor, d.loss_factor), stand_in_of(d)},
               nodes, "hysteretic damping");
}

void add_hysteresis(Assembly& a, const model::Shaft& shaft, const elements::GeneralBeam& beam,
                    const std::array<Index, 2>& nodes) {
  const model::ShaftDamping& d = shaft.damping;
  if (d.loss_factor == 0) return;
  using Viscous = elements::GeneralBeamDamping;
  add_stressed(
      a,
      elements::HystereticDamping<Viscous>{Viscous(beam, d.loss_factor, 0.0),
                                           Viscous(beam, 0.0, d.loss_factor), stand_in_of(d)},
      nodes, "hysteretic damping");
}

void add_hysteresis(Assembly& a, const model::Shaft& shaft, const elements::SectionBeam& beam,
                    const std::array<Index, 2>& nodes) {
  const model::ShaftDamping& d = shaft.damping;
  if (d.loss_factor == 0) return;
  using Viscous = elements::SectionBeamDamping;
  add_stressed(a,
               elements::HystereticDamping<Viscous>{
                   Viscous(beam, d.loss_factor, Viscous::Part::bending),
                   Viscous(beam, d.loss_factor, Viscous::Part::along), stand_in_of(d)},
               nodes, "hysteretic damping");
}

/// Thermal ones are kernels of their own (cracks.cpp).
bool has_residual_bow(const model::Shaft& s) { return s.bow.constant() && s.bow.amount != 0; }

double thermal_strain(const Assembly& a, const model::Section& s) {
  return s.constants || a.model.materials.empty()
             ? 0.0
             : a.model.materials.at(s.material).expansion * s.temperature_rise;
}

/// Force at unstressed length: preload, and what keeps the element from its thermal growth.
double preload_of(const Assembly& a, const model::Shaft& shaft, const meshes::Element& e,
                  double EA) {
  return shaft.axial_preload - EA * thermal_strain(a, shaft.sections[e.section]);
}

/// Preload and the unstressed shape of a bowed shaft: the slopes of w = A sin(pi s/L) against the
/// chord are stress-free.
void finish_general(Assembly& a, const model::Shaft& shaft, const meshes::Element& e,
                    elements::GeneralBeam& beam, const std::array<Index, 2>& nodes) {
  beam.preload = preload_of(a, shaft, e, beam.c.EA_l * beam.c.length);
  if (has_residual_bow(shaft)) {
    const Vec2 slopes = shaft.bow.amount * bow_slopes(shaft, e);
    // body axes of the section may be turned by an angle of their own
    const double angle =
        shaft.sections[e.section].general ? shaft.sections[e.section].general->angle : 0.0;
    const Vec2 axis(std::cos(shaft.bow.phase - angle), std::sin(shaft.bow.phase - angle));
    beam.p01 += slopes[0] * axis;
    beam.p02 += slopes[1] * axis;
  }
  add_stressed(a, beam, nodes, "general beam elements");
  add_hysteresis(a, shaft, beam, nodes);
}

/// What part of the moments at the ends of an element is inertia of its own line: none at a bend or
/// at a joint of lines that run elsewhere, where torsion of one side is bending of the other.
Vec2 moment_shares(const model::Model& m, const meshes::Element& e) {
  const model::Shaft& shaft = m.shafts[static_cast<std::size_t>(e.line)];
  const auto share = [&](double s) {
    if (joined_at_angle(m, static_cast<std::size_t>(e.line), s)) return 0.0;
    if (shaft.path.empty() || s <= 0 || s >= shaft.path.length()) return 1.0;
    const Vec3 before = shaft.path.before(s).triad.col(0), after = shaft.path.after(s).triad.col(0);
    return (after - before).norm() > 1e-6 ? 0.0 : 1.0;
  };
  return Vec2(share(e.s1), share(e.s2));
}

elements::TriadShare triad_share(const Assembly& a, const MassShares& shares,
                                 const meshes::Element& e) {
  const Vec2 own = moment_shares(a.model, e);
  const elements::MassShare node = shares.of(e);
  return {own.cwiseProduct(node.spin), own.cwiseProduct(Vec2(node.bending[1], node.bending[3]))};
}

/// Constants for a general beam, which has the offsets of its ends itself; the shares are those of
/// nodes, so only without offsets.
ShaftElementConstants between_nodes(Assembly& a, const MassShares& shares, const meshes::Element& e,
                                    const elements::ElementSection& section, double part) {
  const auto make = [&](const elements::MassShare& share) {
    return elements::make_shaft_constants(section, e.s2 - e.s1, 0, 0, mass_kind(a.model), share);
  };
  const bool straight =
      a.model.shafts[static_cast<std::size_t>(e.line)]
          .path.empty();  // what is left of the weight acts on the directors of straight lines
  if (straight && e.left.offset == 0 && e.right.offset == 0)
    return shared_constants(a, shares, e, make, part);
  const Vec2 moments = moment_shares(a.model, e);
  elements::MassShare share;
  share.bending = Vector<4>(1, moments[0], 1, moments[1]);
  return make(share);
}

/// A round section, or one given by constants, as a general beam.
elements::GeneralBeamConstants round_constants(Assembly& a, const MassShares& shares,
                                               const model::Shaft& shaft,
                                               const meshes::Element& e) {
  const elements::ElementSection section = element_section(a.model, e);
  const double l = e.s2 - e.s1;
  const ShaftElementConstants k = between_nodes(a, shares, e, section, 1.0);
  elements::GeneralBeamConstants c;
  c.length = l;
  c.EA_l = k.EA_l;
  c.GJ_l = k.GJ_l;
  c.ky_def11 = c.kz_def11 = k.k11;
  c.ky_def12 = c.kz_def12 = k.k12;
  c.ky_def22 = c.kz_def22 = k.k22;
  c.b11 = k.b11;
  c.b12 = k.b12;
  c.b22 = k.b22;
  c.M4 = k.M4;
  const double polar = k.polar.sum();
  c.triads = {Vec3(polar, 0.5 * polar, 0.5 * polar).asDiagonal().toDenseMatrix(), 0.0,
              mass_kind(a.model), triad_share(a, shares, e)};
  c.beta = c.beta_axial = shaft.damping.beta_internal;
  return c;
}

/// A round section whose unstressed shape is not straight.
void add_bowed(Assembly& a, const MassShares& shares, const model::Shaft& shaft,
               const meshes::Element& e) {
  const elements::GeneralBeamConstants c = round_constants(a, shares, shaft, e);
  const std::array<Index, 2> nodes{e.left.node, e.right.node};
  elements::GeneralBeam beam(c, Vec3(c.length, 0, 0), Mat3::Identity(), Mat3::Identity(),
                             Vec3(e.left.offset, 0, 0), Vec3(e.right.offset, 0, 0));
  finish_general(a, shaft, e, beam, nodes);
  add_damping(a, shaft, element_constants(a.model, e), nodes, false);
}

/// Section with unequal principal axes; y, z: each plane by itself. Deflection along the section's
/// y bends about its z.
elements::GeneralBeamConstants unequal_constants(Assembly& a, const MassShares& shares,
                                                 const model::Shaft& shaft,
                                                 const meshes::Element& e, ShaftElementConstants& y,
                                                 ShaftElementConstants& z) {
  const model::Section& s = shaft.sections[e.section];
  const model::Section::General& g = *s.general;
  const model::Material& material = a.model.materials.at(s.material);
  const double l = e.s2 - e.s1;
  elements::ElementSection plane;
  plane.constants = true;
  const double rho = s.rotary_inertia ? material.rho : 0.0;
  const double about_y = rho * (s.mean_rotary_inertia ? 0.5 * (g.Iy + g.Iz) : g.Iy);
  const double about_z = rho * (g.Iy + g.Iz) - about_y;
  const auto constants = [&](double I, double kappa) {
    plane.given = {material.E * g.A,
                   s.shear == model::ShearFactor::none ? 0.0 : kappa * material.G * g.A,
                   material.G * g.J,
                   material.E * I,
                   material.rho * g.A + s.added_mass_per_length,
                   std::min(about_y, about_z),
                   0};
    return between_nodes(a, shares, e, plane, 0.5);
  };
  y = constants(g.Iz, g.kappa_y);
  z = constants(g.Iy, g.kappa_z);
  elements::GeneralBeamConstants c;
  c.length = l;
  c.EA_l = y.EA_l;
  c.GJ_l = y.GJ_l;
  c.ky_def11 = y.k11;
  c.ky_def12 = y.k12;
  c.ky_def22 = y.k22;
  c.kz_def11 = z.k11;
  c.kz_def12 = z.k12;
  c.kz_def22 = z.k22;
  c.b11 = 0.5 * (y.b11 + z.b11);
  c.b12 = 0.5 * (y.b12 + z.b12);
  c.b22 = 0.5 * (y.b22 + z.b22);
  c.M4 = 0.5 * (y.M4 + z.M4);
  const Mat3 J = l * Vec3(about_y + about_z, about_y, about_z).asDiagonal().toDenseMatrix();
  const ShaftElementConstants& stiffer = about_z > about_y ? y : z;  // y: bending about z
  c.triads = {J, elements::shear_share(stiffer.k11, stiffer.k12, stiffer.k22), mass_kind(a.model),
              triad_share(a, shares, e)};
  c.beta = c.beta_axial = shaft.damping.beta_internal;
  return c;
}

/// Axes of a section against those of the line, at a fraction of its length.
Mat3 section_axes(const model::Section& s, double xi = 0) {
  const double angle = s.angle() + xi * s.twist();
  Mat3 axes;
  axes << Vec3::UnitX(), Vec3(0, std::cos(angle), std::sin(angle)),
      Vec3(0, -std::sin(angle), std::cos(angle));
  return axes;
}

void add_general(Assembly& a, const MassShares& shares, const model::Shaft& shaft,
                 const meshes::Element& e) {
  ShaftElementConstants y, z;
  const elements::GeneralBeamConstants c = unequal_constants(a, shares, shaft, e, y, z);
  const Mat3 triad = section_axes(shaft.sections[e.section]);
  const std::array<Index, 2> nodes{e.left.node, e.right.node};
  elements::GeneralBeam beam(c, Vec3(c.length, 0, 0), triad, triad, Vec3(e.left.offset, 0, 0),
                             Vec3(e.right.offset, 0, 0));
  finish_general(a, shaft, e, beam, nodes);
  // Fixed-axes damping does not turn with the section: it takes the mean of both planes.
  ShaftElementConstants mean = y;
  mean.k11 = 0.5 * (y.k11 + z.k11);
  mean.k12 = 0.5 * (y.k12 + z.k12);
  mean.k22 = 0.5 * (y.k22 + z.k22);
  mean.o1 = e.left.offset;
  mean.o2 = e.right.offset;
  Matrix<4> T = Matrix<4>::Identity();
  T(0, 1) = mean.o1;
  T(2, 3) = mean.o2;
  mean.M4 = T.transpose() * c.M4 * T;
  add_damping(a, shaft, mean, nodes, false);
}

/// An element of a line along a path: its ends keep their angles to the chord. Nodes have global
/// axes. A line that does not turn has one kind of stiffness-proportional damping: internal and
/// external together.
void add_curved(Assembly& a, const MassShares& shares, const model::Shaft& shaft,
                const meshes::Element& e) {
  const model::Section& s = shaft.sections[e.section];
  const model::ShaftDamping& d = shaft.damping;
  ShaftElementConstants y, z;
  elements::GeneralBeamConstants c = s.general ? unequal_constants(a, shares, shaft, e, y, z)
                                               : round_constants(a, shares, shaft, e);
  c.beta = c.beta_axial = d.beta_internal + d.beta_external;
  c.beta_twist = c.beta + d.beta_torsion;
  c.alpha = d.alpha;
  const Path::Point p = shaft.path.after(e.s1), q = shaft.path.before(e.s2);
  elements::GeneralBeam beam(c, q.r - p.r, p.triad * section_axes(s), q.triad * section_axes(s));
  beam.preload = preload_of(a, shaft, e, c.EA_l * c.length);
  const std::array<Index, 2> nodes{e.left.node, e.right.node};
  add_stressed(a, beam, nodes, "general beam elements");
  add_hysteresis(a, shaft, beam, nodes);
}

/// A round element with the mean bending stiffness of a section: for what acts in fixed axes.
ShaftElementConstants mean_constants(const Assembly& a, const FullSection& section,
                                     const meshes::Element& e) {
  const Matrix<6> S = section.stiffness.llt().solve(Matrix<6>::Identity());
  const SectionMoments mass(section.mass);
  elements::ElementSection round;
  round.constants = true;
  round.given = {1.0 / S(0, 0), 2.0 / (S(1, 1) + S(2, 2)),
                 1.0 / S(3, 3), 0.5 * (1.0 / S(4, 4) + 1.0 / S(5, 5)),
                 mass.m,        std::max(0.0, 0.5 * (mass.second(1, 1) + mass.second(2, 2))),
                 mass.J(0, 0)};
  return elements::make_shaft_constants(round, e.s2 - e.s1, e.left.offset, e.right.offset,
                                        mass_kind(a.model));
}

/// Turn of the end of an element by the slope of a bow.
Mat3 bowed(const model::Shaft& shaft, double slope) {
  return rotation::L(slope * Vec3(0, -std::sin(shaft.bow.phase), std::cos(shaft.bow.phase)));
}

/// A section that is coupled, twisted or off the line.
void add_full(Assembly& a, const MassShares& shares, const model::Shaft& shaft,
              const meshes::Element& e) {
  const model::Section& s = shaft.sections[e.section];
  const model::ShaftDamping& d = shaft.damping;
  const FullSection section = model::full_section(a.model, s);
  const double l = e.s2 - e.s1;
  elements::SectionBeamConstants c = elements::make_section_constants(
      section, l, (e.xi2 - e.xi1) * s.twist(), mass_kind(a.model), triad_share(a, shares, e));
  const Mat3 left = section_axes(s, e.xi1), right = section_axes(s, e.xi2);
  const std::array<Index, 2> nodes{e.left.node, e.right.node};
  const bool bent = !shaft.path.empty();
  if (bent) c.alpha = d.alpha;
  elements::SectionBeam beam;
  if (bent) {
    const Path::Point p = shaft.path.after(e.s1), q = shaft.path.before(e.s2);
    beam = elements::SectionBeam(c, q.r - p.r, p.triad * left, q.triad * right);
  } else {
    beam = elements::SectionBeam(c, Vec3(l, 0, 0), left, right, Vec3(e.left.offset, 0, 0),
                                 Vec3(e.right.offset, 0, 0));
  }
  if (has_residual_bow(shaft)) {
    const Vec2 slopes = shaft.bow.amount * bow_slopes(shaft, e);
    beam.set_unstressed(bowed(shaft, slopes[0]) * left, bowed(shaft, slopes[1]) * right);
  }
  beam.set_prestress(shaft.axial_preload, thermal_strain(a, s));
  // a line that does not turn has one kind of damping; else the twist goes with the fixed axes
  const double beta = d.beta_internal + (bent ? d.beta_external : 0.0),
               beta_twist = bent ? d.beta_torsion : 0.0;
  if (beta != 0 || beta_twist != 0) beam.set_damping(beta, beta_twist);
  add_stressed(a, beam, nodes, "full section elements");
  add_hysteresis(a, shaft, beam, nodes);
  if (bent) return;
  model::Shaft rest = shaft;
  rest.damping.beta_internal = 0;  // in the beam, with its twist
  add_damping(a, rest, mean_constants(a, section, e), nodes, false);
}

void add_rigid_part(Assembly& a, const model::Shaft& shaft, const meshes::RigidPart& r) {
  const meshes::MassProperties p =
      meshes::section_mass(a.model, shaft.sections[r.section], Vec3(r.o1, 0, 0));  // from the node
  if (!(p.mass > 0)) return;
  if (a.model.keep_everything)
    a.builder.add(
        elements::RigidBody(p.mass, p.centre(), Vec3(p.Ip(), p.Id(), p.Id()).asDiagonal()),
        {r.node}, "rigid bodies");
  else
    a.builder.add(elements::RigidDisk{p.mass, p.Id(), p.Ip(), p.centre().x()}, {r.node},
                  "rigid disks");
}

/// What the elements of a line do without.
void list_absent(Assembly& a, const model::Shaft& shaft, Index line) {
  int elements = 0, joined = 0;
  for (const meshes::Element& e : a.mesh.elements)
    if (e.line == line && shaft.path.empty() && !shaft.sections[e.section].general &&
        !shaft.sections[e.section].full) {
      ++elements;
      joined += e.left.offset == 0 && e.right.offset == 0;
    }
  if (elements == 0) return;
  std::string absent;
  const auto list = [&](bool is_absent, const char* what) {
    if (is_absent) absent += (absent.empty() ? "" : ", ") + std::string(what);
  };
  const model::ShaftDamping& d = shaft.damping;
  list(d.beta_internal == 0, "internal damping");
  list(d.beta_external == 0, "external damping");
  list(d.alpha == 0, "mass-proportional damping");
  if (!absent.empty())
    a.built.simpler.push_back(
        fmt::format("{} of shaft '{}': its {} elements have none", absent, shaft.name, elements));
  if (joined > 0)
    a.built.simpler.push_back(
        fmt::format("rigid end offsets of {} of {} elements of shaft '{}': zero", joined, elements,
                    shaft.name));
}

void list_absent(Assembly& a) {
  for (std::size_t i = 0; i < a.model.shafts.size(); ++i)
    list_absent(a, a.model.shafts[i], static_cast<Index>(i));
}

}  // namespace

void add_shafts(Assembly& a) {
  if (!a.model.keep_everything) list_absent(a);
  const MassShares shares(a);
  for (const meshes::Element& e : a.mesh.elements) {
    throw_if_interrupted();
    a.built.element_forces.emplace_back();
    const model::Shaft& shaft = a.model.shafts[static_cast<std::size_t>(e.line)];
    if (shaft.sections[e.section].is_full()) {
      add_full(a, shares, shaft, e);
      continue;
    }
    if (!shaft.path.empty()) {
      add_curved(a, shares, shaft, e);
      continue;
    }
    if (shaft.sections[e.section].general) {
      add_general(a, shares, shaft, e);
      continue;
    }
    if (has_residual_bow(shaft)) {
      add_bowed(a, shares, shaft, e);
      continue;
    }
    const ShaftElementConstants c = shared_constants(
        a, shares, e,
        [&](const elements::MassShare& share) { return element_constants(a.model, e, share); });
    const std::array<Index, 2> nodes{e.left.node, e.right.node};
    const auto add = [&](auto beam) {
      beam.preload = preload_of(a, shaft, e, c.EA_l * c.length);
      add_stressed(a, beam, nodes, "shaft elements");
    };
    if (!a.model.keep_everything && c.o1 == 0 && c.o2 == 0)
      add(elements::ShaftBeam<false>(c, Vec3::UnitX()));
    else
      add(elements::ShaftBeam<true>(c, Vec3::UnitX()));
    add_damping(a, shaft, c, nodes, true);
    add_hysteresis(a, shaft, c, nodes);
  }
  for (const meshes::RigidPart& r : a.mesh.rigid_parts)
    add_rigid_part(a, a.model.shafts[static_cast<std::size_t>(r.line)], r);
}

}  // namespace whirl::assembly
