// A critical-map step: undamped critical speeds against the stiffness of the supports.
#include <analysis/spectra/critical.hpp>
#include <core/contract.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/support_coefficients.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace whirl::steps {

namespace {

/// Stiffness of the chosen rolling bearings in all motions at the equilibrium, by number of the
/// bearing.
using RollingStiffness = std::map<std::size_t, Matrix<6>>;

RollingStiffness stiffness_of_rolling(results::FrequencyStep& s,
                                      const std::vector<std::size_t>& chosen, double speed) {
  RollingStiffness out;
  const auto rolls = [&](std::size_t i) {
    return *model::traits_of(s.job.model.bearings[i].law).rolling;
  };
  if (std::none_of(chosen.begin(), chosen.end(), rolls)) return out;
  s.linear.at(speed);
  const run::StepState state{s.linear.equilibrium().state, speed, {}};
  for (const std::size_t i : chosen)
    if (rolls(i)) out[i] = results::support_stiffness(s.job, state, i);
  return out;
}

/// Only the lateral stiffness is varied: what the support does where no lateral force acts stays,
/// K_oo - K_ol K_ll^-1 K_lo, and so does the place at which it pushes, K_ll^-1 K_lo (the pressure
/// centre of an angular-contact bearing). Without couplings the rest stays as it is; with them K
/// stays definite at every k.
void set_lateral(Matrix<6>& K, double k) {
  const Mat2 Kll = K.block<2, 2>(1, 1);
  if (Kll.determinant() > 0) {
    const Mat2 flexibility = Kll.inverse();
    Eigen::Matrix<double, 2, 6> here = flexibility * K.middleRows<2>(1);
    Eigen::Matrix<double, 6, 2> there = K.middleCols<2>(1) * flexibility;
    here.middleCols<2>(1).setIdentity();
    there.middleRows<2>(1).setIdentity();
    K += there * (k * Mat2::Identity() - Kll) * here;
  }
  K(1, 2) = K(2, 1) = 0.0;
  K(1, 1) = K(2, 2) = k;
}

/// A support with stiffness k in y and z and no damping; along and about the shaft it does what it
/// did.
model::BearingLaw law_with_stiffness(const model::BearingLaw& law, const Matrix<6>* rolling,
                                     double k) {
  if (const auto* given = std::get_if<model::TableBearing>(&law)) {
    model::TableBearing table = *given;
    for (Matrix<6>& K : table.K)
      set_lateral(K, k);
    for (Matrix<6>& C : table.C)
      C.setZero();
    table.M.clear();
    return table;
  }
  const model::SupportTraits t = model::traits_of(law);
  model::LinearBearing b;
  if (*t.stiffness)
    b.K = **t.stiffness;
  else if (rolling)
    b.K = *rolling;
  b.setpoint = t.bias->setpoint;
  b.preload = t.bias->preload;
  set_lateral(b.K, k);
  return b;
}

model::Model with_stiffness(const model::Model& m, const std::vector<std::size_t>& chosen,
                            const RollingStiffness& rolling, double k) {
  model::Model out = m;
  for (const std::size_t i : chosen) {
    const auto known = rolling.find(i);
    out.bearings[i].law =
        law_with_stiffness(m.bearings[i].law, known == rolling.end() ? nullptr : &known->second, k);
    // a pedestal of the bearing's own is part of the stiffness varied; one that a foundation joins
    // to others is not
    if (m.foundation_of(i) < 0) out.bearings[i].pedestal.reset();
  }
  return out;
}

/// Bearings to vary, by number: at least one, all of them with a stiffness (check_maps of the deck).
std::vector<std::size_t> chosen_bearings(const model::Model& m, const model::CriticalMapStep& law) {
  const auto is_named = [&](const model::Bearing& b) {
    return std::find(law.bearings.begin(), law.bearings.end(), b.name) != law.bearings.end();
  };
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < m.bearings.size(); ++i) {
    const model::Bearing& b = m.bearings[i];
    const bool varied =
        law.bearings.empty() ? *model::traits_of(b.law).mapped && !b.to : is_named(b);
    if (varied) chosen.push_back(i);
  }
  WHIRL_EXPECTS(!chosen.empty());
  return chosen;
}

std::string line_label(const analysis::CriticalMapLine& l, const model::CriticalMapStep& law) {
  if (l.kind != analysis::ModeKind::lateral) return std::string(to_string(l.kind));
  if (!law.backward) return "critical";
  return l.direction == analysis::Direction::backward ? "backward" : "forward";
}

/// Stiffness of a bearing as it is, for the map: vertical where it does not depend on speed.
void add_own_curves(const model::Bearing& b, double max_speed, std::vector<plot::Curve>& out) {
  const double low = 0.01 * max_speed;
  const model::SupportTraits law = model::traits_of(b.law);
  for (const model::StiffnessCurve& c : *law.curves)
    if (c.speed.empty())
      out.push_back({b.name + c.label, {c.k.front(), c.k.front()}, {low, max_speed}});
    else
      out.push_back({b.name + c.label, c.k, c.speed});
}

/// Table and figure, with what the bearings have themselves.
void add_map(results::FrequencyStep& s, const model::Model& model,
             const std::vector<std::size_t>& chosen, const analysis::CriticalMap& map,
             const model::CriticalMapStep& law) {
  io::Table table;
  table.title = "Critical speeds against support stiffness";
  table.nan_means = "no such critical speed at this stiffness";
  table.nan_is_absence = true;
  table.columns.push_back({"stiffness", "N/m", "of each support, in y and z"});
  std::vector<plot::Curve> curves;
  std::map<std::string, int> count;
  for (const analysis::CriticalMapLine& l : map.lines) {
    const std::string name = line_label(l, law);
    const std::string label = fmt::format("{} {}", name, ++count[name]);
    table.columns.push_back({label, "rpm", ""});
    curves.push_back({label, map.stiffness, l.speed});
  }
  for (std::size_t i = 0; i < map.stiffness.size(); ++i) {
    std::vector<io::Table::Cell> row{map.stiffness[i]};
    for (const analysis::CriticalMapLine& l : map.lines)
      row.emplace_back(to_rpm(l.speed[i]));
    table.add(std::move(row));
  }
  s.add_table("critical_map", std::move(table), false);
  std::vector<plot::Curve> own;
  for (const std::size_t i : chosen)
    add_own_curves(model.bearings[i], law.max_speed, own);
  s.add_figure(plot::plot_critical_map(
      s.file("critical_map"), "Undamped critical speeds against support stiffness", curves, own));
}

}  // namespace

void run_critical_map_step(run::Job& job, const model::Step& step,
                           const model::CriticalMapStep& law) {
  const std::vector<std::size_t> chosen = chosen_bearings(job.model, law);
  results::FrequencyStep s(job, step, "critical_map", "critical-speed map", law.max_speed);
  analysis::CriticalMapOptions o;
  o.critical.max_speed = law.max_speed;
  const results::TablesBegin tables = results::where_tables_begin(job);
  const bool begins_later = tables.speed > analysis::lowest_speed(0.0, law.max_speed);
  if (begins_later) o.critical.min_speed = tables.speed;
  o.critical.order = law.order;
  o.critical.motion = results::motion_of(law.motion);
  o.running = results::steady_rotation_of(job, law.max_speed);
  o.forward_only = !law.backward;
  o.undeformed = law.about == model::About::undeformed;
  o.threads = job.options.jobs;
  for (int k = 0; k < law.points; ++k)
    o.stiffness.push_back(law.stiffness_min * std::pow(law.stiffness_max / law.stiffness_min,
                                                       static_cast<double>(k) / (law.points - 1)));
  const run::PhaseTimer timer(job, "critical-speed map");
  const RollingStiffness rolling = stiffness_of_rolling(s, chosen, law.max_speed);
  const analysis::CriticalMap map = analysis::critical_map(
      [&](double k) {  // a mesh of its own: the pedestals are not there
        const model::Model m = with_stiffness(job.model, chosen, rolling, k);
        return std::move(assembly::build_system(m, meshes::make_mesh(m)).system);
      },
      o);

  add_map(s, job.model, chosen, map, law);
  std::string names;
  for (const std::size_t i : chosen) {
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", job.model.bearings[i].name);
    s.summary()["bearings varied"].push(job.model.bearings[i].name);
  }
  s.summary()["lines"] = map.lines.size();
  s.summary()["stiffnesses"] = map.stiffness.size();
  s.section.text = fmt::format(
      "Lateral stiffness of {} supports varied together: {}. What else they do along and about the "
      "shaft stays;"
      " their damping, mass and pedestals are left out.",
      chosen.size(), names);
  if (begins_later) s.assume(tables.said);
  if (!rolling.empty())
    s.section.text +=
        fmt::format(" Rolling bearings keep the stiffness of the equilibrium at {:.6g} rpm.",
                    to_rpm(law.max_speed));
  const std::string known = fmt::format(
      "at each stiffness counted by inertia at {} speeds: none is missing but pairs that come and "
      "go "
      "between two of them; lines between the stiffnesses are paired by shape and order, not "
      "counted",
      o.critical.grid + 1);
  s.summary()["certificate"]["text"] = known;
  s.summary()["certificate"]["counted at each stiffness"] = true;
  s.summary()["certificate"]["counted between stiffnesses"] = false;
  s.section.text += " Critical speeds are " + known + ".";
  if (map.lines.empty())
    s.section.text +=
        fmt::format(" No critical speed lies below {:.6g} rpm.", to_rpm(law.max_speed));
  s.finish(fmt::format("{} critical speeds at {} stiffnesses, counted at each, not between them",
                       map.lines.size(), map.stiffness.size()));
}

}  // namespace whirl::steps
