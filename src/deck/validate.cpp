#include <deck/validate_parts.hpp>

#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::deck {

void report(Problems& p, const char* code, std::string message, std::string hint,
            const Where& where, Diagnostic::Severity severity) {
  p.push_back({severity, code, std::move(message), std::move(hint), where});
}

namespace {

void check_places(const model::Model& m, Problems& out) {
  const auto on_shaft = [&](const model::Location& at, const char* what) {
    if (at.housing >= 0)
      report(out, "E26",
             fmt::format("{} cannot stand on the support of a bearing", with_article(what)),
             "only probes and loads can", at.where);
  };
  for (const auto& d : m.disks)
    on_shaft(d.at, "disk");
  for (const auto& u : m.unbalances) {
    on_shaft(u.at, "unbalance");
    if (!u.to) continue;
    on_shaft(*u.to, "unbalance");
    if (u.to->shaft != u.at.shaft || !(u.to->s > u.at.s))
      report(out, "E26",
             "the end of an unbalance lies on another shaft or not to the right of its beginning",
             "'to' is a place further right on the shaft of 'at'", u.to->where);
  }
  for (const auto& c : m.cracks) {
    on_shaft(c.at, "crack");
    if (!c.to) continue;
    on_shaft(*c.to, "crack");
    if (c.to->shaft != c.at.shaft || !(c.to->s > c.at.s))
      report(out, "E26",
             "the end of a crack lies on another shaft or not to the right of its beginning",
             "'to' is a place further right on the shaft of 'at'", c.to->where);
  }
  for (const auto& d : m.drives)
    on_shaft(d.at, "drive");
  for (const auto& j : m.joints) {
    on_shaft(j.at, "joint");
    if (j.to) on_shaft(*j.to, "joint");
  }
  for (const auto& b : m.bearings) {
    on_shaft(b.at, "bearing");
    if (const model::Location* sensor = model::traits_of(b.law).sensor) {
      on_shaft(*sensor, "sensor");
      if (sensor->shaft != b.at.shaft)
        report(out, "E26", fmt::format("the sensor of '{}' looks at another shaft", b.name),
               "sensor_at is a place on the shaft of 'at'", sensor->where);
    }
    if (!b.to) continue;
    on_shaft(*b.to, "bearing");
    // forces on both sides are taken to meet in one point (gears: in one plane)
    const std::optional<model::ShaftPair> pair = *model::traits_of(b.law).pair;
    if (b.at.housing >= 0 || b.to->housing >= 0) continue;
    const Vec3 apart =
        m.shafts[b.to->shaft].position(b.to->s) - m.shafts[b.at.shaft].position(b.at.s);
    const double along = std::abs(apart.x()),
                 across = pair && pair->mesh ? 0.0 : apart.tail<2>().norm();
    if (along > 1e-3)
      report(
          out, "W05",
          fmt::format("the two places of '{}' are {:.5g} mm apart along x: its forces on both "
                      "shafts are not in line, and their couple is missing",
                      b.name, 1e3 * along),
          "check the origins of the shafts and the two places; a spacer is a section of one of the "
          "shafts",
          b.where, Diagnostic::Severity::warning);
    if (across > 1e-6)
      report(
          out, "W05",
          fmt::format("the two places of '{}' are {:.5g} mm apart across the shafts: that distance "
                      "has no effect",
                      b.name, 1e3 * across),
          pair ? "a misalignment is given by offset_y, offset_z, angle_y, angle_z"
               : "a set point of the springs is given by 'setpoint'",
          b.where, Diagnostic::Severity::warning);
  }
}

/// Masses of a foundation that are in its matrices alone: nobody knows which way they would be shaken.
void check_shaken_foundations(const model::Model& m, Problems& out) {
  const auto& shaken = m.base.acceleration;
  if (std::none_of(shaken.begin(), shaken.end(), [](const LawPtr& law) { return law != nullptr; }))
    return;
  for (const model::Foundation& f : m.foundations) {
    std::string names;
    for (std::size_t k = 0; k < f.coordinates.size(); ++k) {
      const auto i = static_cast<Index>(k);
      if (f.coordinates[k].bearing >= 0 || f.M.size() == 0 || f.M.row(i).isZero(0.0)) continue;
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", f.coordinates[k].name);
    }
    if (names.empty()) continue;
    report(out, "W18",
           fmt::format("the acceleration of the base acts on foundation '{}' where it carries its "
                       "bearings, and through the couplings of its mass matrix; on the masses of "
                       "its internal coordinates {} it does not act: which way they move is not "
                       "known",
                       f.name, names),
           "a lumped mass of its own as a pedestal, or as a shaft that does not turn, is shaken "
           "with the rest",
           f.where, Diagnostic::Severity::warning);
  }
}

/// Numbers of a material that are right in another unit only.
void check_materials(const model::Model& m, Problems& out) {
  constexpr double metal = 2000.0;      // kg/m3, and more
  constexpr double slowest = 1000.0;    // m/s: sound in a rod of lead has 1200
  constexpr double heaviest = 23000.0;  // kg/m3: osmium has 22590
  constexpr double in_g_per_cm3[]{1.5, heaviest / 1000.0};
  for (const model::Material& x : m.materials) {
    const double sound = x.rho > 0 ? std::sqrt(x.E / x.rho) : infinity;
    const auto warn = [&](std::string what, const char* hint) {
      report(out, "W19", fmt::format("material '{}': {}", x.name, what), hint, x.where,
             Diagnostic::Severity::warning);
    };
    if (x.rho > heaviest)
      warn(fmt::format("a density of {:.6g} kg/m^3 is more than that of any metal", x.rho),
           "steel has 7850 kg/m^3, or 0.284 lbm/in^3");
    else if (x.rho > in_g_per_cm3[0] && x.rho < in_g_per_cm3[1])
      warn(fmt::format("a density of {:.6g} kg/m^3 is that of a foam, or of a metal in g/cm^3",
                       x.rho),
           "steel has 7850 kg/m^3; a shaft without mass has density = \"0 kg/m^3\"");
    else if (x.rho >= metal && sound < slowest)
      warn(fmt::format("a modulus E of {:.6g} GPa beside a density of {:.6g} kg/m^3 is that of no "
                       "metal",
                       1e-9 * x.E, x.rho),
           "steel has 210 GPa, or 30e6 psi");
  }
}

void check_effects(const model::Model& m, Problems& out) {
  check_shaken_foundations(m, out);
  const bool transient = std::any_of(m.steps.begin(), m.steps.end(), [](const model::Step& s) {
    return std::holds_alternative<model::TransientStep>(s.law);
  });
  const auto warn = [&](std::string what, const Where& w) {
    report(out, "W02", fmt::format("{} without effect: the deck has no transient step", what), "",
           w, Diagnostic::Severity::warning);
  };
  for (const auto& s : m.shafts) {
    if (transient && s.damping.loss_factor != 0 && s.damping.loss_frequency == 0)
      report(
          out, "W02",
          fmt::format("internal_loss_factor of shaft '{}' has no effect on transient steps: "
                      "hysteretic damping has no form in time",
                      s.name),
          "internal_loss_frequency = \"30 Hz\": viscous damping stands for it then that loses as "
          "much at this frequency, seen in rotating axes",
          s.where, Diagnostic::Severity::warning);
    for (const auto& x : s.sections)
      if (x.temperature_rise != 0 &&
          (x.constants || m.materials.empty() || m.materials.at(x.material).expansion == 0)) {
        report(out, "W02",
               fmt::format("temperature_rise of section '{}' has no effect: {}", x.name,
                           x.constants ? "its constants have no thermal expansion"
                                       : "its material has no 'expansion'"),
               "expansion = \"12e-6 1/K\" for steel", x.where, Diagnostic::Severity::warning);
        break;
      }
  }
  using Start = model::TransientStep::Start;
  const auto begins = [&m](auto start) {
    return std::any_of(m.steps.begin(), m.steps.end(), [&](const model::Step& s) {
      const auto* law = std::get_if<model::TransientStep>(&s.law);
      return law && s.from.empty() && law->previous.empty() && start(law->start);
    });
  };
  const bool from_rest = begins([](Start s) { return s == Start::rest; }),
             otherwise = begins([](Start s) { return s != Start::rest; });
  if (otherwise && !from_rest && !m.initial.empty())
    report(out, "W02",
           fmt::format("the initial motion '{}' has no effect: no transient step starts from rest",
                       m.initial.front().name),
           "start = \"rest\" in the step: its other starts are motions of their own",
           m.initial.front().where, Diagnostic::Severity::warning);
  if (transient) return;
  if (!m.initial.empty()) warn("an initial motion", m.initial.front().where);
  const bool shapes = std::any_of(m.steps.begin(), m.steps.end(), [](const model::Step& s) {
    return std::holds_alternative<model::StaticStep>(s.law) ||
           std::holds_alternative<model::ModalStep>(s.law) ||
           std::holds_alternative<model::CriticalStep>(s.law) ||
           std::holds_alternative<model::UnbalanceStep>(s.law) ||
           std::holds_alternative<model::HarmonicStep>(s.law) ||
           std::holds_alternative<model::BucklingStep>(s.law);
  });
  if (shapes) return;
  for (const auto& o : m.output.vtk)
    if (o.step.empty()) warn("a picture output", o.where);
}

}  // namespace

std::vector<WholeModelProblem> check_model(const model::Model& m) {
  Problems out;
  check_names(m, out);
  check_materials(m, out);
  check_restraint(m, out);
  check_tables(m, out);
  check_linear(m, out);
  check_events(m, out);
  check_torques(m, out);
  check_maps(m, out);
  check_drives(m, out);
  check_start_speeds(m, out);
  check_speeds_of_pairs(m, out);
  check_speeds_of_joints(m, out);
  check_places(m, out);
  check_controllers(m, out);
  check_cracks(m, out);
  check_cavitation(m, out);
  check_clamps(m, out);
  check_preloads(m, out);
  check_undeformed(m, out);
  check_beginnings(m, out);
  check_windows(m, out);
  check_speed_window(m, out);
  check_effects(m, out);
  return out;
}

}  // namespace whirl::deck
