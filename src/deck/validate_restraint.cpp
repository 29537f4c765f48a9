// What holds the shafts of a model.
#include <deck/validate_parts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace whirl::deck {

namespace {

/// Rigid motions of one shaft that something resists. Lateral and tilting restraint in one plane
/// follows from the stations where that plane is held: one place holds the shift, a second place or
/// a tilting stiffness the tilt.
struct Restraint {
  std::array<std::set<double>, 2> stations;  ///< held laterally along y, z
  std::array<bool, 2> tilt{};                ///< tilt in the x-y, x-z plane held by a moment
  bool lateral(int k) const { return !stations[static_cast<std::size_t>(k)].empty(); }
  bool tilting(int k) const {
    return tilt[static_cast<std::size_t>(k)] || stations[static_cast<std::size_t>(k)].size() > 1;
  }
};

/// Direction of the tilt in the x-y and the x-z plane: about z, about y.
constexpr std::array<std::size_t, 2> tilt_in_plane{5, 4};

std::vector<Restraint> restraints(const model::Model& m) {
  std::vector<Restraint> r(m.shafts.size());
  const auto apply = [&](const model::Location& at, const model::Directions& held) {
    Restraint& x = r[at.shaft];
    for (std::size_t k = 0; k < 2; ++k) {
      if (held[1 + k]) x.stations[k].insert(at.s);
      x.tilt[k] = x.tilt[k] || held[tilt_in_plane[k]];
    }
  };
  for (const auto& b : m.bearings)
    if (!b.to) apply(b.at, model::traits_of(b.law).held);
  // a bearing to another shaft holds as far as that shaft is held there; whole chains settle in as
  // many passes
  for (std::size_t pass = 0; pass < m.shafts.size(); ++pass)
    for (const auto& b : m.bearings) {
      if (!b.to) continue;
      for (const auto& [here, there] : {std::pair(b.at, *b.to), std::pair(*b.to, b.at)}) {
        if (here.shaft == there.shaft) continue;
        const Restraint& other = r[there.shaft];
        model::Directions held = model::traits_of(b.law).held;
        for (std::size_t k = 0; k < 2; ++k) {
          const bool fixed =
              other.lateral(static_cast<int>(k)) && other.tilting(static_cast<int>(k));
          held[1 + k] = held[1 + k] && fixed;
          held[tilt_in_plane[k]] = held[tilt_in_plane[k]] && fixed;
        }
        apply(here, held);
      }
    }
  return r;
}

bool starts_static(const model::Step& s) {
  if (std::holds_alternative<model::StaticStep>(s.law)) return true;
  if (const auto* t = std::get_if<model::TransientStep>(&s.law))
    return s.from.empty() && t->start == model::TransientStep::Start::static_equilibrium;
  return false;
}

}  // namespace

void check_restraint(const model::Model& m, Problems& out) {
  const auto needs = std::find_if(m.steps.begin(), m.steps.end(), starts_static);
  if (needs == m.steps.end()) return;
  const auto r = restraints(m);
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    if (m.joined(k)) continue;  // the assembled model knows
    const auto say = [&](const char* motion, const char* hint) {
      report(
          out, "E32",
          fmt::format("nothing resists {} of shaft '{}', but step '{}' needs a static equilibrium",
                      motion, m.shafts[k].name, needs->name),
          hint, m.shafts[k].where);
    };
    for (int a = 0; a < 2; ++a) {
      const char* axis = a == 0 ? "y" : "z";
      if (!r[k].lateral(a))
        say(a == 0 ? "motion along y" : "motion along z",
            a == 0 ? "a bearing with kyy is missing" : "a bearing with kzz is missing");
      else if (!r[k].tilting(a))
        say(a == 0 ? "tilting in the x-y plane" : "tilting in the x-z plane",
            fmt::format("it is held along {} at one place only: a second bearing or a tilting "
                        "stiffness is missing",
                        axis)
                .c_str());
    }
  }
}

/// An axial preload is a force only between two places that hold the shaft along its axis.
void check_preloads(const model::Model& m, Problems& out) {
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    if (m.shafts[k].axial_preload == 0) continue;
    std::set<double> places;
    for (const auto& b : m.bearings) {
      if (!(*model::traits_of(b.law).held)[0]) continue;
      if (b.at.shaft == k) places.insert(b.at.s);
      if (b.to && b.to->shaft == k) places.insert(b.to->s);
    }
    if (places.size() > 1) continue;
    report(
        out, "W02",
        fmt::format("axial_preload of shaft '{}' has no effect but its length: it relaxes, because "
                    "nothing holds the shaft along its axis at two places",
                    m.shafts[k].name),
        "axial_force is a force that pulls at the ends and stays", m.shafts[k].where,
        Diagnostic::Severity::warning);
  }
}

}  // namespace whirl::deck
