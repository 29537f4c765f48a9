// An api_lateral step: for every set of bearings the critical-speed map, the undamped modes, the
// response to unbalance at their antinodes and the stability, each a step of its own on a model of
// its own; and one table of what complies.
#include <core/messages.hpp>
#include <analysis/response/api684.hpp>
#include <la/multiply.hpp>
#include <meshes/mass_properties.hpp>
#include <results/compliance.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <run/progress.hpp>
#include <steps/api_criticals.hpp>
#include <steps/api_models.hpp>
#include <steps/api_stability.hpp>
#include <steps/step_kinds.hpp>
#include <steps/undamped_forward.hpp>
#include <steps/vibration_zones.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace whirl::steps {

namespace {

using results::Check;

/// An undamped mode at its critical speed, and where the unbalance goes for it.
struct PlacedMode {
  int number = 0;
  double speed = 0;  ///< rad/s
  double N = 0;      ///< of the unbalance, rad/s of the rotor
  analysis::ModePlanes planes;
  std::vector<double> amount;  ///< kg m, one a plane
};

/// One set of bearings on its way.
class SetReport {
 public:
  SetReport(run::Job& job, const model::Step& step, const model::ApiLateralStep& law,
            const ApiMachine& machine, results::Compliance& checks)
      : job_(job),
        step_(step),
        law_(law),
        machine_(machine),
        checks_(checks) {}
  void execute();

 private:
  std::string name_of(const std::string& part) const {
    return step_.name + (machine_.tag.empty() ? "_" : "_" + machine_.tag + "_") + part;
  }
  /// "lateral, minimum": what its sections are called after.
  std::string title() const {
    return step_.name + (machine_.set.empty() ? "" : ", " + machine_.set);
  }
  /// A step within this one.
  model::Step part(const std::string& name, model::StepLaw law) const {
    model::Step s;
    s.name = name_of(name);
    s.where = step_.where;
    s.law = std::move(law);
    return s;
  }
  /// What a step within this one has to say; what: of its section.
  void close(run::Job& sub, const std::string& what) {
    if (!sub.report.sections.empty())
      sub.report.sections.back().title = fmt::format("{}: {}", title(), what);
    sub.hand_over(job_, job_.summary["steps"][step_.name]["parts"]);
  }
  std::string source(std::initializer_list<const char*> keys) const {
    return results::source_of(law_.standard, law_.limits.given, law_.limits.source, keys);
  }
  void add(Check c, const std::string& where, std::string figure, std::string source);
  void weigh();
  void draw_map();
  void find_modes();
  void place(PlacedMode& mode, results::FrequencyStep& s, const analysis::Critical& c);
  void write_planes(results::FrequencyStep& s) const;
  void respond(const PlacedMode& mode);
  model::Model model_with(const PlacedMode& mode) const;
  void add_margins(const PlacedMode& mode, const model::Step& of, const UnbalanceOutcome& r,
                   io::ReportSection& section);
  double add_vibration(const PlacedMode& mode, const model::Step& of, const UnbalanceOutcome& r,
                       io::ReportSection& section);
  void add_clearances(const PlacedMode& mode, const model::Step& of, const UnbalanceOutcome& r,
                      double scale, io::ReportSection& section);
  void judge_criticals();
  /// The least stable mode of the machine as given, and the figure that shows it.
  std::pair<WhirlingMode, std::string> stability_as_given();
  void judge_stability();
  /// Levels 1 and 2 look at the highest speed alone.
  void judge_growth();
  std::string bode_of(const model::Step& of, const std::string& probe) const;
  void mark_speeds(plot::Figure& f, double limit) const;

  run::Job& job_;
  const model::Step& step_;
  const model::ApiLateralStep& law_;
  const ApiMachine& machine_;
  results::Compliance& checks_;
  analysis::JournalWeights weights_;
  std::vector<PlacedMode> modes_;
  std::vector<double> peaks_;  ///< of the responses, those that were judged by their margin, rad/s
  std::size_t order_ = 0;      ///< of the response: that of the rotor's speed
};

void SetReport::add(Check c, const std::string& where, std::string figure, std::string source) {
  c.set = machine_.set;
  if (!where.empty()) c.where = where;
  c.figure = std::move(figure);
  c.source = std::move(source);
  checks_.add(std::move(c));
}

/// Static loads of the journals, and the masses outside them.
void SetReport::weigh() {
  const model::Model m = weight_alone(without_seals(machine_));
  model::StaticStep law;
  law.speed = law_.operating[1];
  law.speed_given = true;
  const model::Step s = part("weights", law);
  run::RunOptions brief = job_.options;
  brief.json = true;  // the reactions stand in the table
  run::Job sub(m, job_, brief);
  sub.build_for(s);
  run_static_step(sub, s, law);
  const io::Value& forces = sub.summary["steps"][s.name].at("support forces [N]");
  for (const std::size_t i : machine_.journals) {
    const io::Value& f = forces.at(m.bearings[i].name);
    weights_.s.push_back(m.bearings[i].at.s);
    weights_.weight.push_back(std::hypot(f.items()[1].number(), f.items()[2].number()) /
                              m.gravity.norm());
  }
  close(sub, "static loads of the journals");
  const model::Shaft& shaft = m.shafts[machine_.shaft];
  const auto outside = [&](double s0) {
    return s0 < weights_.s.front() ? -1 : s0 > weights_.s.back() ? 1 : 0;
  };
  const auto take = [&](double mass, double s0) {
    if (outside(s0) < 0) weights_.overhang_left += mass;
    if (outside(s0) > 0) weights_.overhang_right += mass;
  };
  for (const model::Disk& d : m.disks)
    if (d.at.shaft == machine_.shaft) take(d.mass, d.at.s);
  // sections cut by a journal count by their slices
  constexpr int slices = 200;
  double left = 0;
  for (const model::Section& x : shaft.sections) {
    const double mass = meshes::section_mass(m, x, Vec3::Zero()).mass;
    for (int k = 0; k < slices; ++k)
      take(mass / slices, left + (k + 0.5) / slices * x.length);
    left += x.length;
  }
}

void SetReport::draw_map() {
  const auto mapped = [&](std::size_t i) {
    return *model::traits_of(machine_.model.bearings[i].law).mapped;
  };
  std::vector<double> speeds;
  constexpr int points = 24;
  for (int k = 0; k <= points; ++k)
    speeds.push_back(law_.min_speed + (law_.max_speed - law_.min_speed) * k / points);
  const model::Model m =
      with_tables(job_, machine_, balanced(without_seals(machine_)), step_, speeds);
  model::CriticalMapStep law;
  double least = infinity, most = 0;
  for (const std::size_t i : machine_.journals) {
    if (!mapped(i)) continue;
    law.bearings.push_back(m.bearings[i].name);
    const model::SupportTraits traits = model::traits_of(m.bearings[i].law);
    for (const model::StiffnessCurve& c : *traits.curves)
      for (const double k : c.k) {
        if (!(k > 0)) continue;
        least = std::min(least, k);
        most = std::max(most, k);
      }
  }
  if (law.bearings.empty() || !(most > 0)) return;
  law.stiffness_min = std::pow(10.0, std::floor(std::log10(least)) - 1);
  law.stiffness_max = std::pow(10.0, std::ceil(std::log10(most)) + 1);
  law.max_speed = 2 * law_.max_speed;
  law.order = machine_.ratio;
  const model::Step s = part("map", law);
  run::Job sub(m, job_);
  sub.build_for(s);
  run_critical_map_step(sub, s, law);
  if (!sub.report.sections.empty())
    for (plot::Figure& f : sub.report.sections.back().figures)
      for (const auto& [speed, name] :
           {std::pair{law_.operating[0], "lowest speed"}, {law_.operating[1], "highest speed"}})
        f.axes.front().rules.push_back(
            {false, to_rpm(speed), name, {plot::ink, plot::Dash::dotted, 1.0}});
  close(sub, "undamped critical-speed map");
}

/// Where the unbalance of a mode goes, and how much.
void SetReport::place(PlacedMode& mode, results::FrequencyStep& s, const analysis::Critical& c) {
  VecXc mx;
  la::multiply(s.linear.conservative_at(c.speed).M, c.mode.x, mx);
  double all = 0, left = 0, right = 0;
  for (Index n = 0; n < static_cast<Index>(s.job.mesh.nodes.size()); ++n) {
    const meshes::Node& node = s.job.mesh.nodes[static_cast<std::size_t>(n)];
    const double energy = c.mode.x.segment<6>(6 * n).dot(mx.segment<6>(6 * n)).real();
    all += energy;
    if (node.line != static_cast<Index>(machine_.shaft)) continue;
    if (node.s < weights_.s.front() * (1 - 1e-12)) left += energy;
    if (node.s > weights_.s.back() * (1 + 1e-12)) right += energy;
  }
  analysis::JournalWeights journals = weights_;
  journals.motion_left = all > 0 ? left / all : 0;
  journals.motion_right = all > 0 ? right / all : 0;
  const RealShape shape = shape_along(s, c.mode.x, machine_.shaft);
  mode.planes = analysis::place_unbalance(shape.s, shape.u, journals);
  const model::ApiLimits& l = law_.limits;
  mode.N = l.unbalance_speed > 0
               ? l.unbalance_speed
               : machine_.ratio * std::clamp(c.speed, law_.operating[0], law_.operating[1]);
  for (const analysis::ModePlane& p : mode.planes.planes)
    mode.amount.push_back(
        analysis::api_unbalance(l.unbalance_factor, l.unbalance_constant, p.weight, mode.N));
}

void SetReport::write_planes(results::FrequencyStep& s) const {
  io::Table t;
  t.title = "Undamped modes and their unbalance";
  t.columns = {{"mode", "-", ""},
               {"critical speed", "rpm",
                "of the reference; undamped, on the mean direct stiffness of each journal"},
               {"form", "-", ""},
               {"place", "m", "from the left end of the shaft"},
               {"weight", "kg", "W of the unbalance"},
               {"speed", "rpm", "N of the unbalance, of the rotor"},
               {"unbalance", "g mm", ""},
               {"angle", "deg", ""}};
  for (const PlacedMode& m : modes_)
    for (std::size_t k = 0; k < m.planes.planes.size(); ++k) {
      const analysis::ModePlane& p = m.planes.planes[k];
      t.add({m.number, to_rpm(m.speed), analysis::describe(m.planes.form), p.s, p.weight,
             to_rpm(m.N), 1e6 * m.amount[k], p.turned ? 180.0 : 0.0});
    }
  s.add_table("unbalance", std::move(t));
}

void SetReport::find_modes() {
  std::vector<double> speeds;
  constexpr int points = 24;
  for (int k = 0; k <= points; ++k)
    speeds.push_back(law_.min_speed + (law_.max_speed - law_.min_speed) * k / points);
  const model::Model tables =
      with_tables(job_, machine_, balanced(without_seals(machine_)), step_, speeds);
  model::Model m = with_mean_stiffness(machine_, tables);
  for (model::Bearing& b : m.bearings)
    if (auto* table = std::get_if<model::TableBearing>(&b.law)) table->extrapolate_hold = true;
  model::CriticalStep law;
  law.max_speed = 3 * law_.max_speed;
  law.motion = model::MotionKind::lateral;
  const model::Step step = part("modes", law);
  run::Job sub(m, job_);
  results::FrequencyStep s(sub, step, "undamped modes", "undamped modes", law.max_speed);
  std::vector<analysis::Critical> found = undamped_forward(s.linear, law.max_speed, machine_.ratio);
  keep_modes_of(sub.mesh, sub.system(), machine_.shaft, found);
  std::vector<int> asked;
  for (const double k : law_.modes)
    asked.push_back(static_cast<int>(k));
  for (int k = 1; k <= static_cast<int>(found.size()) && law_.modes.empty(); ++k)
    if (k == 1 || found[static_cast<std::size_t>(k - 1)].speed < law_.max_speed) asked.push_back(k);
  for (const int k : asked) {
    if (k > static_cast<int>(found.size()))
      throw Error(
          Exit::deck,
          {{Diagnostic::Severity::error, "E70",
            fmt::format("step '{}' asks for undamped mode {}: below {:.6g} rpm there are {}",
                        step_.name, k, to_rpm(law.max_speed), found.size()),
            "lower numbers in 'modes'", step_.where}});
    const analysis::Critical& c = found[static_cast<std::size_t>(k - 1)];
    PlacedMode mode;
    mode.number = k;
    mode.speed = c.speed;
    s.linear.at(c.speed);
    place(mode, s, c);
    results::add_shape_figures(s, {fmt::format("mode_{}", k),
                                   fmt::format("Undamped mode {}: {:.6g} rpm, {}", k,
                                               to_rpm(c.speed), describe(mode.planes.form)),
                                   {},
                                   &c.mode.x,
                                   c.mode.kind});
    modes_.push_back(std::move(mode));
  }
  write_planes(s);
  s.section.text =
      "Forward modes at their undamped critical speeds, each journal with the mean of its direct "
      "stiffnesses at that speed, seals left out.";
  s.finish(fmt::format("{} modes", modes_.size()));
  close(sub, "undamped modes and their unbalance");
}

/// The set's machine with the unbalance of a mode alone, and the clearances as places beside the
/// probes.
model::Model SetReport::model_with(const PlacedMode& mode) const {
  model::Model m = balanced(machine_.model);
  for (std::size_t k = 0; k < mode.planes.planes.size(); ++k) {
    model::Unbalance u;
    u.name = fmt::format("plane {}", k + 1);
    u.at.shaft = machine_.shaft;
    u.at.s = mode.planes.planes[k].s;
    u.at.text = fmt::format("{:.6g} m", u.at.s);
    u.at.where = step_.where;
    u.amount = mode.amount[k];
    u.phase = mode.planes.planes[k].turned ? pi : 0.0;
    m.unbalances.push_back(std::move(u));
  }
  if (!law_.probes.empty())
    std::erase_if(m.probes, [&](const model::Probe& p) {
      return std::find(law_.probes.begin(), law_.probes.end(), p.name) == law_.probes.end();
    });
  for (const model::ApiClearance& c : law_.clearances) {
    model::Probe p;
    p.name = c.name;
    p.at = c.at;
    m.probes.push_back(std::move(p));
  }
  return m;
}

std::string SetReport::bode_of(const model::Step& of, const std::string& probe) const {
  return safe_stem(of.name + "_" + probe + "_bode");
}

/// Lines at the operating speeds, and at a limit (m peak to peak; 0: none).
void SetReport::mark_speeds(plot::Figure& f, double limit) const {
  plot::Axes& a = f.axes.front();
  const plot::Style line{plot::ink, plot::Dash::dash_dot, 0.8};
  a.rules.push_back({true, to_rpm(law_.operating[0]), "lowest", line});
  a.rules.push_back({true, to_rpm(law_.operating[1]), "highest", line});
  const double factor = a.y.unit == "m" ? 1 : a.y.unit == "mm" ? 1e3 : a.y.unit == "nm" ? 1e9 : 1e6;
  if (limit > 0)
    a.rules.push_back({false, factor * limit, "limit", {plot::ink, plot::Dash::dashed, 1.2}});
}

void SetReport::add_margins(const PlacedMode& mode, const model::Step& of,
                            const UnbalanceOutcome& r, io::ReportSection& section) {
  const model::ApiLimits& l = law_.limits;
  const analysis::MarginRule rule{l.damped, l.margin_factor, l.margin_offset, l.margin_above,
                                  l.margin};
  io::Table t;
  t.title = "Separation margins";
  t.nan_means = "no half-power point within the speeds";
  t.columns = {{"probe", "-", ""},
               {"peak", "rpm", ""},
               {"amplification factor", "-", "from the half-power points"},
               {"required", "%", ""},
               {"actual", "%", "negative: inside the operating range"},
               {"result", "-", ""}};
  std::optional<Check> worst;
  double reserve = infinity;
  std::string where, figure;
  for (const analysis::MarginRow& row : analysis::separation_margins(
           r.peaks, r.probes, {law_.operating[0], law_.operating[1]}, order_)) {
    const bool above = row.speed > law_.operating[1];
    const double required = rule.required(row.amplification_bound, above);
    const bool damped = row.is_damped(l.damped);
    const bool passed = damped || row.actual >= required;
    const bool undetermined = !passed && std::isnan(row.amplification);
    if (!damped) peaks_.push_back(row.speed);
    t.add({row.probe, to_rpm(row.speed), row.amplification, 100 * required, 100 * row.actual,
           damped         ? "critically damped"
           : undetermined ? "not determined"
           : passed       ? "passed"
                          : "FAILED"});
    const double left = damped         ? 1e3 - row.amplification_bound
                        : undetermined ? -infinity
                                       : row.actual - required;
    if (left >= reserve) continue;
    reserve = left;
    worst = damped ? results::compare("separation margin", row.amplification, "AF",
                                      Check::Rule::at_most, l.damped)
                   : results::compare("separation margin", 100 * row.actual, "%",
                                      Check::Rule::at_least, 100 * required);
    worst->passed = passed;
    worst->remark = undetermined ? "no half-power point within the speeds: not determined"
                    : !damped
                        ? fmt::format("AF {}{:.4g}", std::isnan(row.amplification) ? "up to " : "",
                                      row.amplification_bound)
                    : std::isnan(row.amplification) ? "no half-power point: critically damped"
                                                    : "critically damped: no margin asked for";
    where =
        fmt::format("mode {}, {}, peak at {:.5g} rpm", mode.number, row.probe, to_rpm(row.speed));
    figure = bode_of(of, row.probe);
  }
  if (!worst) {
    worst = results::compare("separation margin", nan, "-", Check::Rule::none, nan);
    worst->remark = fmt::format("no peak from {:.5g} to {:.5g} rpm", to_rpm(law_.min_speed),
                                to_rpm(law_.max_speed));
    where = fmt::format("mode {}", mode.number);
    figure = bode_of(of, r.probes.front().name);
  }
  add(*worst, where, figure,
      source({"margin", "margin_factor", "margin_offset", "margin_above", "damped"}));
  job_.folder.write_table(safe_stem(of.name + "_margins") + ".csv", t);
  section.files.emplace_back(t.title, safe_stem(of.name + "_margins") + ".csv");
  section.tables.push_back(std::move(t));
}

/// Returns the factor from the response to the vibration limit.
double SetReport::add_vibration(const PlacedMode& mode, const model::Step& of,
                                const UnbalanceOutcome& r, io::ReportSection& section) {
  const model::ApiLimits& l = law_.limits;
  const double limit =
      analysis::vibration_limit(l.vibration, l.vibration_speed, machine_.ratio * law_.operating[1]);
  double largest = 0, at = 0;
  std::size_t probe = 0;
  const std::size_t shown = r.probes.size() - law_.clearances.size();
  for (const analysis::SteadyPoint& x : r.response.points) {
    if (x.Omega < law_.operating[0] * (1 - 1e-12) || x.Omega > law_.operating[1] * (1 + 1e-12))
      continue;
    for (std::size_t p = 0; p < shown; ++p)
      if (const double pp = peak_to_peak(x, p); pp > largest) {
        largest = pp;
        at = x.Omega;
        probe = p;
      }
  }
  add(results::compare("vibration at probes", 1e6 * largest, "um pp", Check::Rule::at_most,
                       1e6 * limit),
      fmt::format("mode {}, {}, {:.5g} rpm", mode.number, r.probes[probe].name, to_rpm(at)),
      bode_of(of, r.probes[probe].name), source({"vibration", "vibration_speed"}));
  for (plot::Figure& f : section.figures)
    if (f.name.ends_with("_bode")) mark_speeds(f, limit);
  return analysis::scale_factor(limit, largest, l.scale);
}

void SetReport::add_clearances(const PlacedMode& mode, const model::Step& of,
                               const UnbalanceOutcome& r, double scale,
                               io::ReportSection& section) {
  if (law_.clearances.empty()) return;
  const std::size_t first = r.probes.size() - law_.clearances.size();
  io::Table t;
  t.title = fmt::format("Scaled response at the clearances, factor {:.5g}", scale);
  t.columns = {{"clearance", "-", ""},
               {"diametral", "mm", ""},
               {"speed", "rpm", "of the largest response up to the trip speed"},
               {"response", "um", "major axis, peak to peak"},
               {"scaled", "um", "the same times the scale factor"},
               {"share", "%", "of the diametral clearance"}};
  plot::Axes axes;
  axes.x = plot::Axis("speed", "rpm");
  axes.y = plot::Axis("share of the clearance, peak to peak", "%");
  axes.y.include_zero = true;
  double worst = -1;
  std::size_t worst_at = 0;
  for (std::size_t k = 0; k < law_.clearances.size(); ++k) {
    const model::ApiClearance& c = law_.clearances[k];
    plot::Series line;
    line.label = c.name;
    double most = 0, speed = 0;
    for (const analysis::SteadyPoint& x : r.response.points) {
      const double pp = peak_to_peak(x, first + k);
      line.x.push_back(to_rpm(x.Omega));
      line.y.push_back(100 * scale * pp / c.diametral);
      if (x.Omega <= law_.trip * (1 + 1e-12) && pp > most) {
        most = pp;
        speed = x.Omega;
      }
    }
    axes.series.push_back(std::move(line));
    const double share = scale * most / c.diametral;
    t.add({c.name, 1e3 * c.diametral, to_rpm(speed), 1e6 * most, 1e6 * scale * most, 100 * share});
    if (share <= worst) continue;
    worst = share;
    worst_at = k;
  }
  axes.rules.push_back(
      {false, 100 * law_.limits.clearance, "limit", {plot::ink, plot::Dash::dashed, 1.2}});
  axes.rules.push_back({true, to_rpm(law_.trip), "trip", {plot::ink, plot::Dash::dash_dot, 0.8}});
  plot::Figure f;
  f.name = safe_stem(of.name + "_clearances");
  f.title = fmt::format("Close clearances, unbalance of mode {}", mode.number);
  f.axes.push_back(std::move(axes));
  add(results::compare("close clearances", 100 * worst, "%", Check::Rule::at_most,
                       100 * law_.limits.clearance),
      fmt::format("mode {}, {}, scale {:.4g}", mode.number, law_.clearances[worst_at].name, scale),
      f.name, source({"clearance", "scale", "vibration", "vibration_speed"}));
  job_.folder.write_table(safe_stem(of.name + "_clearances") + ".csv", t);
  section.files.emplace_back(t.title, safe_stem(of.name + "_clearances") + ".csv");
  section.tables.push_back(std::move(t));
  if (job_.model.output.report) section.figures.push_back(std::move(f));
}

void SetReport::respond(const PlacedMode& mode) {
  const model::Model m = model_with(mode);
  model::UnbalanceStep law;
  law.speed.start = law_.min_speed;
  law.speed.stop = law_.max_speed;
  law.speed.points = law_.points;
  law.speed.refine_peaks = true;
  // the ends of the ranges are places where limits hold
  law.speed.values = results::speeds_of(law.speed);
  for (const double Omega : {law_.operating[0], law_.operating[1], law_.trip})
    law.speed.values.push_back(Omega);
  std::sort(law.speed.values.begin(), law.speed.values.end());
  law.speed.values.erase(std::unique(law.speed.values.begin(), law.speed.values.end(),
                                     [](double a, double b) { return b - a < 1e-9 * b; }),
                         law.speed.values.end());
  const model::Step s = part(fmt::format("mode_{}", mode.number), law);
  run::Job sub(m, job_);
  sub.build_for(s);
  const UnbalanceOutcome r = run_unbalance_step(sub, s, law, law_.clearances.size(),
                                                {law_.operating[0], law_.operating[1], law_.trip});
  for (std::size_t k = 0; k < r.response.orders.size(); ++k)
    if (std::abs(std::abs(r.response.orders[k]) - machine_.ratio) < 1e-9 * machine_.ratio)
      order_ = k;
  io::ReportSection spare;
  io::ReportSection& section = sub.report.sections.empty() ? spare : sub.report.sections.back();
  add_margins(mode, s, r, section);
  const double scale = add_vibration(mode, s, r, section);
  add_clearances(mode, s, r, scale, section);
  io::Value& v = sub.summary["steps"][s.name];
  v["scale factor"] = scale;
  for (plot::Figure& f : section.figures)
    f.caption += fmt::format("{}Unbalance of mode {}{}.", f.caption.empty() ? "" : " ", mode.number,
                             machine_.set.empty() ? "" : ", set '" + machine_.set + "'");
  close(sub, fmt::format("response to the unbalance of mode {}", mode.number));
}

void SetReport::judge_criticals() {
  const model::Model m = balanced(machine_.model);
  model::CriticalStep law;
  law.max_speed = law_.max_speed;
  law.motion = model::MotionKind::lateral;
  const model::Step s = part("critical_speeds", law);
  run::Job sub(m, job_);
  add(check_critical_speeds(sub, s, law_, machine_, peaks_), "", "",
      source({"margin", "margin_factor", "margin_offset", "margin_above", "damped"}));
  close(sub, "damped critical speeds");
}

std::pair<WhirlingMode, std::string> SetReport::stability_as_given() {
  const model::Model m = balanced(machine_.model);
  model::ModalStep law;
  law.speed = law_.operating[1];
  law.shapes = 2;
  law.motion = model::MotionKind::lateral;
  // without seals there is nothing of level 2 to show
  const int shown = machine_.seals.empty() ? 2 : 8;
  const Level1::Below below =
      Level1::modes_below(job_, m, part("level_2", law), machine_, law.speed);
  law.modes = std::max(shown, below.count);
  const model::Step s = part(machine_.seals.empty() ? "stability" : "level_2", law);
  run::Job sub(m, job_);
  sub.build_for(s);
  const WhirlingMode listed =
      least_stable(run_modal_step(sub, s, law), sub.mesh, sub.system(), machine_, law.speed);
  const WhirlingMode least = below.least.grows ? below.least : listed;
  std::string figure;
  if (!sub.report.sections.empty() && !sub.report.sections.back().figures.empty())
    figure = sub.report.sections.back().figures.front().name;
  close(sub, machine_.seals.empty() ? "stability" : "stability, level 2");
  return {least, figure};
}

void SetReport::judge_stability() {
  std::optional<WhirlingMode> with_seals;
  std::string figure;
  if (!machine_.seals.empty() || law_.stages.empty())
    std::tie(with_seals, figure) = stability_as_given();
  if (law_.stages.empty()) {
    Check c = check_as_given(law_, machine_, *with_seals, figure);
    c.set = machine_.set;
    checks_.add(std::move(c));
    return;
  }
  Level1 level(job_, step_, law_, machine_, name_of("level_1"));
  for (Check& c : level.judge(with_seals, figure)) {
    c.set = machine_.set;
    checks_.add(std::move(c));
  }
  close(level.job(), "stability, level 1");
}

void SetReport::judge_growth() {
  const model::Model m = balanced(machine_.model);
  model::ModalStep law;
  law.speed = law_.operating[1];
  const model::Step s = part("operation", law);
  run::Job sub(m, job_);
  sub.build_for(s);
  results::FrequencyStep frequency(sub, s, "free motions in operation", "free motions",
                                   law_.operating[1]);
  const std::vector<double> speeds =
      results::speeds_to_judge(sub, {law_.operating[0], law_.operating[1]});
  const results::FreeGrowth grows = results::find_growth(frequency, speeds);
  Check c = results::compare("growth in operation", grows.rate, "1/s", Check::Rule::at_most, 0.0);
  c.judged = grows.judged || !grows.text.empty();
  c.remark = grows.text.empty() ? grows.open : grows.text;
  add(std::move(c),
      fmt::format("{} speeds, {:.5g} to {:.5g} rpm", speeds.size(), to_rpm(law_.operating[0]),
                  to_rpm(law_.operating[1])),
      "", "");
  close(sub, "free motions in operation");
}

void SetReport::execute() {
  weigh();
  draw_map();
  find_modes();
  for (const PlacedMode& mode : modes_)
    respond(mode);
  if (modes_.empty()) {
    Check none = results::compare("response to unbalance", nan, "-", Check::Rule::none, nan);
    none.remark = "no undamped mode to place unbalance for: vibration is not judged";
    add(std::move(none), fmt::format("up to {:.5g} rpm", to_rpm(3 * law_.max_speed)), "", "");
  }
  judge_criticals();
  judge_stability();
  judge_growth();
}

void add_head(run::Job& job, const model::Step& step, const model::ApiLateralStep& law,
              const results::Compliance& checks, std::size_t place) {
  io::ReportSection head;
  head.title = fmt::format("{}: lateral report, {}", step.name, law.standard);
  const int failed = checks.failed();
  head.text = fmt::format(
      "{} of {} checks failed. Operating from {:.6g} to {:.6g} rpm, trip at {:.6g} rpm. Amplitudes "
      "are peak to peak. The deck's own unbalances, bows and eccentricities are left out; the "
      "unbalance of each case is that of its table.",
      failed, checks.checks().size(), to_rpm(law.operating[0]), to_rpm(law.operating[1]),
      to_rpm(law.trip));
  const auto table = [&](const char* name, io::Table t) {
    const std::string file = safe_stem(step.name + "_" + name) + ".csv";
    job.folder.write_table(file, t);
    head.files.emplace_back(t.title, file);
    head.tables.push_back(std::move(t));
  };
  table("compliance", checks.table("Compliance"));
  table("masses", results::mass_table(job.model));
  table("stations", results::station_table(job));
  if (job.model.output.report)
    job.report.sections.insert(job.report.sections.begin() + static_cast<std::ptrdiff_t>(place),
                               std::move(head));
}

}  // namespace

void run_api_lateral_step(run::Job& job, const model::Step& step,
                          const model::ApiLateralStep& law) {
  const Stopwatch watch;
  io::Value& v = job.summary["steps"][step.name];
  v["type"] = "api_lateral";
  v["standard"] = law.standard;
  const std::size_t place = job.report.sections.size();
  results::Compliance checks;
  for (const ApiMachine& machine : api_machines(job.model, job.options, step, law))
    SetReport(job, step, law, machine, checks).execute();
  io::Value& done = job.summary["steps"][step.name];
  done["checks"] = checks.checks().size();
  done["failed"] = checks.failed();
  done["compliance"] = checks.value();
  add_head(job, step, law, checks, place);
  const RunTime time = watch.elapsed();
  run::put_run_time(done, time);
  run::ProgressLine(step.name, job.options.quiet)
      .done(fmt::format("{}: {} of {} checks failed, {}", law.standard, checks.failed(),
                        checks.checks().size(), time.text()));
  if (!job.options.quiet && !job.options.json) print(checks.text());
}

}  // namespace whirl::steps
