// A critical-map step: undamped critical speeds against the stiffness of the supports.
#include <analysis/critical.hpp>
#include <app/frequency.hpp>
#include <elements/hertz.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::app {

namespace {

/// The model with stiffness k in y and z of the chosen bearings and no damping there; what they do along and about the shaft stays.
model::Model with_stiffness(const model::Model& m, const std::vector<std::size_t>& chosen, double k) {
  model::Model out = m;
  for (const std::size_t i : chosen) {
    model::LinearBearing b;
    if (const auto* linear = std::get_if<model::LinearBearing>(&m.bearings[i].law)) {
      b = *linear;
      b.K.row(1).setZero(), b.K.row(2).setZero(), b.K.col(1).setZero(), b.K.col(2).setZero();
    } else if (const auto* block = std::get_if<model::SpringBlock>(&m.bearings[i].law)) {
      b.K(0, 0) = block->C1, b.K(4, 4) = b.K(5, 5) = block->C2;
    }
    b.C.setZero(), b.M.setZero();
    b.K(1, 1) = b.K(2, 2) = k;
    out.bearings[i].law = b;
    out.bearings[i].pedestal.reset();
  }
  return out;
}

/// Stiffness of a bearing as it is, for the map: vertical where it does not depend on speed.
void add_own_curves(const model::Bearing& b, double max_speed, std::vector<io::Curve>& out) {
  const double low = 0.01 * max_speed;
  if (const auto* linear = std::get_if<model::LinearBearing>(&b.law)) {
    out.push_back({b.name + " kyy", {linear->K(1, 1), linear->K(1, 1)}, {low, max_speed}});
    if (linear->K(2, 2) != linear->K(1, 1)) out.push_back({b.name + " kzz", {linear->K(2, 2), linear->K(2, 2)}, {low, max_speed}});
  } else if (const auto* block = std::get_if<model::SpringBlock>(&b.law)) {
    out.push_back({b.name, {block->C1, block->C1}, {low, max_speed}});
  } else if (const auto* rolling = std::get_if<model::RollingEstimate>(&b.law)) {
    const elements::BearingEstimate k = rolling->roller ? elements::estimate_roller_bearing(rolling->elements, rolling->size, rolling->load, rolling->contact_angle)
                                                        : elements::estimate_ball_bearing(rolling->elements, rolling->size, rolling->load, rolling->contact_angle);
    out.push_back({b.name + " along its load", {k.along, k.along}, {low, max_speed}});
    out.push_back({b.name + " across", {k.across, k.across}, {low, max_speed}});
  } else if (const auto* table = std::get_if<model::TableBearing>(&b.law)) {
    for (const auto& [entry, name] : {std::pair{1, " kyy"}, std::pair{2, " kzz"}}) {
      io::Curve c{b.name + name, {}, {}};
      const auto& f = table->frequency;
      for (std::size_t i = 0; i < table->speed.size(); ++i) {
        std::size_t row = i;
        if (!f.empty()) {   // of a grid the synchronous values: the frequency nearest to the speed
          std::size_t j = 0;
          for (std::size_t k = 1; k < f.size(); ++k)
            if (std::abs(f[k] - table->speed[i]) < std::abs(f[j] - table->speed[i])) j = k;
          row = i * f.size() + j;
        }
        if (table->speed[i] > 0 && table->K[row](entry, entry) > 0) c.x.push_back(table->K[row](entry, entry)), c.y.push_back(table->speed[i]);
      }
      if (!c.x.empty()) out.push_back(std::move(c));
    }
  }
}

}  // namespace

void run_critical_map_step(Job& job, const model::Step& step, const model::CriticalMapStep& law) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const model::Bearing& b = job.model.bearings[i];
    const bool named = std::find(law.bearings.begin(), law.bearings.end(), b.name) != law.bearings.end();
    if (law.bearings.empty() ? !std::holds_alternative<model::RigidSupport>(b.law) && !b.to : named) chosen.push_back(i);
  }
  for (const std::string& name : law.bearings)
    if (std::none_of(job.model.bearings.begin(), job.model.bearings.end(), [&](const model::Bearing& b) { return b.name == name; }))
      throw run_error("E80", fmt::format("step '{}' names bearing '{}', which the deck does not have", step.name, name), "", step.name);
  if (chosen.empty()) throw run_error("E80", fmt::format("step '{}' has no bearing to vary: all are rigid", step.name), "give the bearing a stiffness (type \"linear\")", step.name);
  FrequencyStep s(job, step, "critical_map", "critical-speed map", law.max_speed);
  analysis::CriticalMapOptions o;
  o.critical.max_speed = law.max_speed, o.critical.order = law.order, o.critical.motion = analysis::Motion::lateral;
  o.running = running_of(job, law.max_speed);
  o.forward_only = !law.backward;
  for (int k = 0; k < law.points; ++k)
    o.stiffness.push_back(law.stiffness_min * std::pow(law.stiffness_max / law.stiffness_min, static_cast<double>(k) / (law.points - 1)));
  const PhaseTimer timer(job, "critical-speed map");
  const analysis::CriticalMap map = analysis::critical_map(
      [&](double k) {   // a mesh of its own: the pedestals are not there
        const model::Model m = with_stiffness(job.model, chosen, k);
        return std::move(assembly::build_system(m, meshes::make_mesh(m)).system);
      }, o);

  io::Table table;
  table.title = "Critical speeds against support stiffness";
  table.nan_means = "no such critical speed at this stiffness";
  table.columns.push_back({"stiffness", "N/m", "of each support, in y and z"});
  std::vector<io::Curve> curves, own;
  int forward = 0, backward = 0;
  for (const analysis::CriticalMapLine& l : map.lines) {
    const bool back = l.direction == analysis::Direction::backward;
    const std::string label = fmt::format("{} {}", back ? "backward" : law.backward ? "forward" : "critical", back ? ++backward : ++forward);
    table.columns.push_back({label, "rpm", ""});
    curves.push_back({label, map.stiffness, l.speed});
  }
  for (std::size_t i = 0; i < map.stiffness.size(); ++i) {
    std::vector<io::Table::Cell> row{map.stiffness[i]};
    for (const analysis::CriticalMapLine& l : map.lines) row.emplace_back(to_rpm(l.speed[i]));
    table.add(std::move(row));
  }
  for (const std::size_t i : chosen) add_own_curves(job.model.bearings[i], law.max_speed, own);
  s.summary()["lines"] = map.lines.size(), s.summary()["stiffnesses"] = map.stiffness.size();
  s.add_table("critical_map", std::move(table), false);
  s.add_figure(io::plot_critical_map(s.file("critical_map"), "Undamped critical speeds against support stiffness", curves, own));
  s.section.text = fmt::format("Stiffness of {} supports varied together; their damping and pedestals are left out.", chosen.size());
  if (map.lines.empty()) s.section.text += fmt::format(" No critical speed lies below {:.6g} rpm.", to_rpm(law.max_speed));
  s.finish(fmt::format("{} critical speeds at {} stiffnesses", map.lines.size(), map.stiffness.size()));
}

}  // namespace whirl::app
