// Cracks and thermal bows: what adds to the bending of shaft elements, in axes that turn with them.
#include <assembly/element_section.hpp>
#include <assembly/stressed.hpp>
#include <elements/shaft/crack.hpp>
#include <elements/shaft/crack_compliance.hpp>
#include <elements/shaft/thermal_bow.hpp>

#include <core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {
namespace {

using elements::Breathing;
using elements::ShaftElementConstants;

constexpr double same_place = 1e-9;  ///< m

std::string crack_name(const model::Crack& c) { return fmt::format("crack '{}'", c.name); }

bool is_round(const model::Section& s) { return !s.general && !s.full; }

/// A mesh element and its end at a place.
struct ElementEnd {
  std::size_t element = 0;
  bool right = false;  ///< which of its ends
  double radius = 0;   ///< m, 0: not known
};

const meshes::Element& element_of(const Assembly& a, std::size_t i) { return a.mesh.elements[i]; }

const model::Section& section_of(const Assembly& a, const meshes::Element& e) {
  return a.model.shafts[static_cast<std::size_t>(e.line)].sections[e.section];
}

/// Round elements that end at a place.
std::vector<ElementEnd> ends_at(const Assembly& a, const model::Location& at) {
  const meshes::Place place = a.mesh.place(at);
  const auto here = [&](const meshes::Place& p) {
    return p.node == place.node && std::abs(p.offset - place.offset) <= same_place;
  };
  std::vector<ElementEnd> out;
  for (std::size_t i = 0; i < a.mesh.elements.size(); ++i) {
    const meshes::Element& e = element_of(a, i);
    if (!is_round(section_of(a, e))) continue;
    const elements::ElementSection s = element_section(a.model, e);
    if (here(e.right)) out.push_back({i, true, s.constants ? 0.0 : 0.5 * s.od2});
    if (here(e.left)) out.push_back({i, false, s.constants ? 0.0 : 0.5 * s.od1});
  }
  return out;
}

/// Of a depth: E14, E26.
void set_compliance(Assembly& a, const model::Crack& c, const ElementEnd& end,
                    elements::CrackLaw& law) {
  if (c.depth == 0) {
    law.c_xi = 1.0 / c.stiffness;
    law.c_eta = 1.0 / c.stiffness_across;
    return;
  }
  const meshes::Element& e = element_of(a, end.element);
  const elements::ElementSection s = element_section(a.model, e);
  const double bore = end.right ? s.id2 : s.id1;
  if (s.constants || bore > 0) {
    a.error("E26",
            fmt::format("{}: a depth says how soft it is in a solid round section, and section "
                        "'{}' {}",
                        crack_name(c), section_of(a, e).name,
                        s.constants ? "is given by constants" : "is hollow"),
            "give stiffness = \"2 MN.m/rad\", or loss = 0.1 and 'to'", c, crack_name(c));
    return;
  }
  if (c.depth > end.radius) {
    a.error("E14",
            fmt::format("{}: it is {} deep in a shaft of radius {}", crack_name(c),
                        units::display(c.depth, "mm"), units::display(end.radius, "mm")),
            "the compliance of a crack is known up to a depth of one radius; a deeper one may be "
            "given by its stiffness",
            c, crack_name(c));
    return;
  }
  const double nu = a.model.materials.at(section_of(a, e).material).nu;
  const elements::CrackCompliance k = elements::crack_compliance(c.depth, end.radius, s.E, nu);
  law.c_xi = k.xi;
  law.c_eta = k.eta;
}

elements::Crack kernel_of(const Assembly& a, const model::Crack& c, const meshes::Element& e) {
  const model::Shaft& shaft = a.model.shafts[c.at.shaft];
  elements::Crack k;
  k.at = end_axes(e, c.phase);
  switch (c.breathing) {
    case model::Crack::Breathing::weight: k.law.breathing = Breathing::weight; break;
    case model::Crack::Breathing::hinge: k.law.breathing = Breathing::hinge; break;
    case model::Crack::Breathing::response: k.law.breathing = Breathing::response; break;
    case model::Crack::Breathing::open: k.law.breathing = Breathing::open; break;
  }
  const Vec2 weight = a.model.gravity.tail<2>();
  if (!std::isnan(c.open_direction))
    k.toward = Vec3(0, std::cos(c.open_direction), std::sin(c.open_direction));
  else if (weight.norm() > 0)
    k.toward << 0, weight.normalized();
  if (shaft.bow.any()) {
    const Vec2 slopes = bow_slopes(shaft, e);
    const double angle = shaft.bow.phase - c.phase;
    const Vec2 axis(std::cos(angle), std::sin(angle));
    k.rest1 = slopes[0] * axis;
    k.rest2 = slopes[1] * axis;
    k.bow = growth_of(shaft.bow);
  }
  return k;
}

/// Puts a kernel at a place of its element: x of the length.
void place_crack(elements::Crack& k, const ShaftElementConstants& c, double x) {
  k.place = x;
  k.r = -(1.0 - x) * Vec2(c.k11, c.k12) + x * Vec2(c.k12, c.k22);
  k.law.small = 1e-12 * k.r.lpNorm<1>();
}

/// Kernels of one crack.
using Kernels = std::vector<std::pair<std::size_t, elements::Crack>>;  // element, kernel

/// A crack at a station: in series at the end of an element beside it, the thinner one.
Kernels at_station(Assembly& a, const model::Crack& c) {
  const std::vector<ElementEnd> ends = ends_at(a, c.at);
  if (ends.empty()) {
    a.error("E26",
            fmt::format("{}: no round elastic section ends at '{}'", crack_name(c), c.at.text),
            "a crack stands in or at the end of a round section that bends", c, crack_name(c));
    return {};
  }
  const auto thinner = [](const ElementEnd& x, const ElementEnd& y) { return x.radius < y.radius; };
  const ElementEnd end = *std::min_element(ends.begin(), ends.end(), thinner);
  const meshes::Element& e = element_of(a, end.element);
  elements::Crack k = kernel_of(a, c, e);
  set_compliance(a, c, end, k.law);
  const ShaftElementConstants constants = element_constants(a.model, e);
  place_crack(k, constants, end.right ? 1.0 : 0.0);
  k.law.g = end.right ? constants.k22 : constants.k11;
  return {{end.element, k}};
}

/// Stiffness lost over a length: at the two Gauss points of each of its elements.
Kernels over_length(Assembly& a, const model::Crack& c) {
  Kernels out;
  const double tiny = 1e-9 * (c.to->s - c.at.s);
  for (std::size_t i = 0; i < a.mesh.elements.size(); ++i) {
    const meshes::Element& e = element_of(a, i);
    if (static_cast<std::size_t>(e.line) != c.at.shaft) continue;
    if (e.s1 < c.at.s - tiny || e.s2 > c.to->s + tiny) continue;  // its ends are nodes
    if (!is_round(section_of(a, e))) {
      a.error("E26",
              fmt::format("{}: section '{}' is not round", crack_name(c), section_of(a, e).name),
              "a crack takes stiffness from round sections", c, crack_name(c));
      return {};
    }
    const ShaftElementConstants constants = element_constants(a.model, e);
    const double l = e.s2 - e.s1;
    const double EI = 0.5 * l * (0.5 * (constants.k11 + constants.k22) - constants.k12);
    elements::Crack k = kernel_of(a, c, e);
    k.law.c_xi = 0.5 * c.loss * l / EI;
    k.law.c_eta = 0.5 * c.loss_across * l / EI;
    for (const double side : {-1.0, 1.0}) {
      place_crack(k, constants, 0.5 * (1.0 + side / std::sqrt(3.0)));
      out.emplace_back(i, k);
    }
  }
  if (out.empty())
    a.error("E26", fmt::format("{}: nothing between its ends bends", crack_name(c)),
            "the sections there are rigid", c, crack_name(c));
  return out;
}

/// A crack breathes in a shaft that turns about itself.
bool can_turn(Assembly& a, const model::Crack& c) {
  const model::Shaft& shaft = a.model.shafts[c.at.shaft];
  if (shaft.rotating && shaft.path.empty()) return true;
  a.error("E26",
          fmt::format("{}: shaft '{}' {}", crack_name(c), shaft.name,
                      shaft.path.empty() ? "does not turn (rotating = false)"
                                         : "runs along a path and does not turn"),
          "a crack breathes as its shaft turns; a notch of a frame is a section of less stiffness",
          c, crack_name(c));
  return false;
}

void add_crack(Assembly& a, const model::Crack& c) {
  CrackOpening result{c.name, [](const NodeAt&, const system::Context&) { return nan; }};
  if (can_turn(a, c)) {
    const Kernels kernels = c.to ? over_length(a, c) : at_station(a, c);
    if (!c.to && c.depth > 0 && c.breathing == model::Crack::Breathing::hinge)
      a.built.notes.push_back(fmt::format(
          "{}: a hinge, without the compliance across that its depth has", crack_name(c)));
    std::vector<std::pair<std::array<Index, 2>, elements::Crack>> placed;
    for (const auto& [element, kernel] : kernels) {
      const meshes::Element& e = element_of(a, element);
      const std::array<Index, 2> nodes{e.left.node, e.right.node};
      elements::Crack numbered = kernel;
      numbered.number = a.builder.count<elements::Crack>();
      add_stressed(a, numbered, nodes, "cracks", element);
      placed.emplace_back(nodes, numbered);
    }
    result.opening = [placed](const NodeAt& at, const system::Context& ctx) {
      double sum = 0.0;
      for (const auto& [nodes, kernel] : placed)
        sum += kernel.opening({&at(nodes[0]), &at(nodes[1])}, ctx);
      return sum / static_cast<double>(placed.size());
    };
  }
  a.built.cracks.push_back(std::move(result));
}

void add_thermal_bow(Assembly& a, const model::Shaft& shaft, std::size_t element) {
  const meshes::Element& e = element_of(a, element);
  const ShaftElementConstants c = element_constants(a.model, e);
  const Vec2 p = bow_slopes(shaft, e);
  elements::ThermalBow k;
  k.at = end_axes(e, shaft.bow.phase);
  k.s1[0] = c.k11 * p[0] + c.k12 * p[1];
  k.s2[0] = c.k12 * p[0] + c.k22 * p[1];
  k.square = k.s1[0] * p[0] + k.s2[0] * p[1];
  k.growth = growth_of(shaft.bow);
  add_stressed(a, k, {e.left.node, e.right.node}, "thermal bows", element);
}

}  // namespace

Vec2 bow_slopes(const model::Shaft& shaft, const meshes::Element& e) {
  const double k = pi / shaft.length();
  const double chord = (std::sin(k * e.s2) - std::sin(k * e.s1)) / (e.s2 - e.s1);
  return Vec2(k * std::cos(k * e.s1) - chord, k * std::cos(k * e.s2) - chord);
}

void add_cracks(Assembly& a) {
  for (const model::Crack& c : a.model.cracks)
    add_crack(a, c);
}

void add_thermal_bows(Assembly& a) {
  for (std::size_t i = 0; i < a.mesh.elements.size(); ++i) {
    const meshes::Element& e = element_of(a, i);
    const model::Shaft& shaft = a.model.shafts[static_cast<std::size_t>(e.line)];
    if (shaft.bow.constant() || !shaft.bow.any()) continue;
    if (is_round(section_of(a, e))) {
      add_thermal_bow(a, shaft, i);
      continue;
    }
    a.error("E26",
            fmt::format("shaft '{}' has a thermal bow, and its section '{}' is not round",
                        shaft.name, section_of(a, e).name),
            "a residual bow (without time_constant) goes with any section", shaft,
            fmt::format("shaft '{}'", shaft.name));
    return;
  }
}

}  // namespace whirl::assembly
