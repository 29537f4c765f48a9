// A critical-map step: undamped critical speeds against the stiffness of the supports.
#include <analysis/spectra/critical.hpp>
#include <results/frequency.hpp>
#include <results/support_coefficients.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>
#include <elements/rolling/hertz.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace whirl::steps {

namespace {

/// Whether a support carries laterally by a stiffness of its own, which a map can vary.
bool carries_laterally(const model::BearingLaw& law) {
  const auto lateral = [](const Matrix<6>& K) { return K(1, 1) != 0 || K(2, 2) != 0; };
  if (const auto* b = std::get_if<model::LinearBearing>(&law)) return lateral(b->K);
  if (const auto* b = std::get_if<model::TableBearing>(&law))
    return std::any_of(b->K.begin(), b->K.end(), lateral);
  if (const auto* b = std::get_if<model::SpringBlock>(&law)) return b->C1 != 0;
  if (const auto* b = std::get_if<model::SqueezeFilm>(&law)) return b->stiffness != 0;
  if (const auto* b = std::get_if<model::NonlinearSpring>(&law)) {
    using Along = model::NonlinearSpring::Along;
    using Shape = model::ForceLaw::Shape;
    const bool gap = b->force.shape == Shape::clearance || b->force.shape == Shape::one_sided;
    return !gap && (b->along == Along::y || b->along == Along::z || b->along == Along::radial);
  }
  return std::holds_alternative<model::ShortJournal>(law) ||
         std::holds_alternative<model::FiniteJournal>(law) ||
         std::holds_alternative<model::BallBearing>(law) ||
         std::holds_alternative<model::RollerBearing>(law) ||
         std::holds_alternative<model::RollingEstimate>(law);
}

/// Stiffness of the chosen rolling bearings in all motions at the equilibrium, by number of the
/// bearing.
using RollingStiffness = std::map<std::size_t, Matrix<6>>;

RollingStiffness stiffness_of_rolling(results::FrequencyStep& s,
                                      const std::vector<std::size_t>& chosen, double speed) {
  RollingStiffness out;
  const auto rolls = [&](std::size_t i) {
    const model::BearingLaw& law = s.job.model.bearings[i].law;
    return std::holds_alternative<model::BallBearing>(law) ||
           std::holds_alternative<model::RollerBearing>(law);
  };
  if (std::none_of(chosen.begin(), chosen.end(), rolls)) return out;
  s.linear.at(speed);
  const run::StepState state{s.linear.equilibrium().state, speed};
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
  model::LinearBearing b;
  if (const auto* linear = std::get_if<model::LinearBearing>(&law))
    b = *linear;
  else if (const auto* block = std::get_if<model::SpringBlock>(&law))
    b.K.diagonal() << block->C1, k, k, 0, block->C2, block->C2;
  else if (const auto* estimate = std::get_if<model::RollingEstimate>(&law))
    b.K(0, 0) = estimate->kxx;
  else if (rolling)
    b.K = *rolling;
  set_lateral(b.K, k);
  b.C.setZero();
  b.M.setZero();
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

/// Bearings to vary, by number. Errors: E80.
std::vector<std::size_t> chosen_bearings(const model::Model& m, const model::Step& step,
                                         const model::CriticalMapStep& law) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < m.bearings.size() && law.bearings.empty(); ++i)
    if (carries_laterally(m.bearings[i].law) && !m.bearings[i].to) chosen.push_back(i);
  for (const std::string& name : law.bearings) {
    const auto found = std::find_if(m.bearings.begin(), m.bearings.end(),
                                    [&](const model::Bearing& b) { return b.name == name; });
    if (found == m.bearings.end())
      throw run_error("E80",
                      fmt::format("step '{}' names bearing '{}', which the deck does not have",
                                  step.name, name),
                      "", step.name);
    if (!carries_laterally(found->law))
      throw run_error(
          "E80",
          fmt::format("step '{}' names bearing '{}', which has no lateral stiffness to vary",
                      step.name, name),
          "name supports that carry the shaft laterally", step.name);
    chosen.push_back(static_cast<std::size_t>(found - m.bearings.begin()));
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  if (chosen.empty())
    throw run_error(
        "E80",
        fmt::format("step '{}' has no bearing to vary: none carries a shaft laterally by a "
                    "stiffness of its own",
                    step.name),
        "give the bearing a stiffness (type \"linear\"), or name the supports in 'bearings'",
        step.name);
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
  if (const auto* linear = std::get_if<model::LinearBearing>(&b.law)) {
    out.push_back({b.name + " kyy", {linear->K(1, 1), linear->K(1, 1)}, {low, max_speed}});
    if (linear->K(2, 2) != linear->K(1, 1))
      out.push_back({b.name + " kzz", {linear->K(2, 2), linear->K(2, 2)}, {low, max_speed}});
  } else if (const auto* block = std::get_if<model::SpringBlock>(&b.law)) {
    out.push_back({b.name, {block->C1, block->C1}, {low, max_speed}});
  } else if (const auto* rolling = std::get_if<model::RollingEstimate>(&b.law)) {
    const elements::BearingEstimate k =
        rolling->roller ? elements::estimate_roller_bearing(rolling->elements, rolling->size,
                                                            rolling->load, rolling->contact_angle)
                        : elements::estimate_ball_bearing(rolling->elements, rolling->size,
                                                          rolling->load, rolling->contact_angle);
    out.push_back({b.name + " along its load", {k.along, k.along}, {low, max_speed}});
    out.push_back({b.name + " across", {k.across, k.across}, {low, max_speed}});
  } else if (const auto* table = std::get_if<model::TableBearing>(&b.law)) {
    for (const auto& [entry, name] : {std::pair{1, " kyy"}, std::pair{2, " kzz"}}) {
      plot::Curve c{b.name + name, {}, {}};
      const auto& f = table->frequency;
      for (std::size_t i = 0; i < table->speed.size(); ++i) {
        std::size_t row = i;
        if (!f.empty()) {  // of a grid the synchronous values: the frequency nearest to the speed
          std::size_t j = 0;
          for (std::size_t k = 1; k < f.size(); ++k)
            if (std::abs(f[k] - table->speed[i]) < std::abs(f[j] - table->speed[i])) j = k;
          row = i * f.size() + j;
        }
        if (table->speed[i] > 0 && table->K[row](entry, entry) > 0) {
          c.x.push_back(table->K[row](entry, entry));
          c.y.push_back(table->speed[i]);
        }
      }
      if (!c.x.empty()) out.push_back(std::move(c));
    }
  }
}

/// Table and figure, with what the bearings have themselves.
void add_map(results::FrequencyStep& s, const model::Model& model,
             const std::vector<std::size_t>& chosen, const analysis::CriticalMap& map,
             const model::CriticalMapStep& law) {
  io::Table table;
  table.title = "Critical speeds against support stiffness";
  table.nan_means = "no such critical speed at this stiffness";
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
  const std::vector<std::size_t> chosen = chosen_bearings(job.model, step, law);
  results::FrequencyStep s(job, step, "critical_map", "critical-speed map", law.max_speed);
  analysis::CriticalMapOptions o;
  o.critical.max_speed = law.max_speed;
  o.critical.order = law.order;
  o.critical.motion = results::motion_of(law.motion);
  o.running = results::steady_rotation_of(job, law.max_speed);
  o.forward_only = !law.backward;
  o.undeformed = law.about == model::About::undeformed;
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
  if (!rolling.empty())
    s.section.text +=
        fmt::format(" Rolling bearings keep the stiffness of the equilibrium at {:.6g} rpm.",
                    to_rpm(law.max_speed));
  if (map.lines.empty())
    s.section.text +=
        fmt::format(" No critical speed lies below {:.6g} rpm.", to_rpm(law.max_speed));
  s.finish(
      fmt::format("{} critical speeds at {} stiffnesses", map.lines.size(), map.stiffness.size()));
}

}  // namespace whirl::steps
