#include <steps/api_stability.hpp>

#include <analysis/response/api617.hpp>
#include <analysis/search.hpp>
#include <assembly/build_system.hpp>
#include <steps/undamped_forward.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

namespace {

using results::Check;

constexpr double reach = 10;  // of the curve, times the anticipated cross-coupling

analysis::CrossCoupledStage stage_of(const model::ApiStage& s, double highest) {
  analysis::CrossCoupledStage out;
  out.axial = s.kind == model::ApiStage::Kind::axial;
  out.power = s.power;
  out.speed = s.speed > 0 ? s.speed : highest;
  out.diameter = s.diameter;
  out.width = s.width;
  out.suction = s.suction;
  out.discharge = s.discharge;
  return out;
}

double anticipated_of(const model::ApiStage& s, const model::ApiLateralStep& law, double ratio) {
  const model::ApiLimits& l = law.limits;
  return stage_of(s, ratio * law.operating[1])
      .anticipated(l.stage_factor, l.axial_factor, l.torque_constant);
}

}  // namespace

WhirlingMode least_stable(const std::vector<analysis::WhirlMode>& modes, const meshes::Mesh& mesh,
                          const system::System& system, const ApiMachine& machine, double speed) {
  const double Omega = machine.ratio * speed;
  // what another rotor of the deck does, and this one not with it, is none of its modes
  constexpr double with_it = 1e-6;
  // on unequal supports the slow modes are nearly straight lines, of either sign by little
  constexpr double backward_below = -0.5;
  const auto lateral = [&](const analysis::WhirlMode& m) {
    return m.kind == analysis::ModeKind::lateral &&
           moves(mesh, system, m.x, machine.shaft, with_it);
  };
  const analysis::WhirlMode *best = nullptr, *forward = nullptr, *any = nullptr, *growing = nullptr;
  for (const analysis::WhirlMode& m : modes) {
    if (!lateral(m)) continue;
    if (m.growth() > 0 && (!growing || m.log_decrement < growing->log_decrement)) growing = &m;
    if (!m.oscillates()) continue;
    if (!any || m.frequency < any->frequency) any = &m;
    if (!(m.forwardness > backward_below)) continue;
    if (!forward || m.frequency < forward->frequency) forward = &m;
    if (m.frequency < std::abs(Omega) && (!best || m.log_decrement < best->log_decrement))
      best = &m;
  }
  const analysis::WhirlMode* found = growing ? growing : best ? best : forward ? forward : any;
  return found ? WhirlingMode{found->log_decrement, found->frequency,
                              found == growing || found == best, found == growing}
               : WhirlingMode{};
}

Check check_as_given(const model::ApiLateralStep& law, const ApiMachine& machine,
                     const WhirlingMode& mode, const std::string& figure) {
  const bool level_2 = !machine.seals.empty();
  const double least = level_2 ? law.limits.log_decrement : 0.0;
  Check c = results::compare(level_2 ? "level 2: log decrement" : "log decrement",
                             mode.log_decrement, "-", Check::Rule::at_least, least);
  c.where =
      fmt::format("{} as given, {:.4g} Hz", level_2 ? "seals" : "machine", to_hz(mode.frequency));
  if (level_2)
    c.source =
        results::source_of(law.standard, law.limits.given, law.limits.source, {"log_decrement"});
  c.figure = figure;
  if (mode.grows)
    c.remark = std::isinf(mode.log_decrement) ? "a motion diverges" : "a motion grows";
  if (std::isnan(mode.log_decrement)) {  // nothing that could grow swings
    c.passed = true;
    c.remark = "no lateral mode oscillates";
  }
  return c;
}

Level1::Level1(run::Job& parent, const model::Step& step, const model::ApiLateralStep& law,
               const ApiMachine& machine, const std::string& name)
    : law_(law),
      machine_(machine),
      model_(balanced(without_seals(machine))) {
  step_.name = name;
  step_.where = step.where;
  model::ModalStep modal;
  modal.speed = law.operating[1];
  modal.motion = model::MotionKind::lateral;
  step_.law = modal;
  add_couplings();
  sub_ = std::make_unique<run::Job>(model_, parent);
  s_ = std::make_unique<results::FrequencyStep>(*sub_, step_, "level 1", "stability, level 1",
                                                law.operating[1]);
}

/// Bearings that push across, with what each has of the whole.
void Level1::add_couplings() {
  double low = infinity, high = 0;
  for (const model::ApiStage& s : law_.stages) {
    anticipated_ += anticipated_of(s, law_, machine_.ratio);
    if (s.kind != model::ApiStage::Kind::radial) continue;
    low = std::min(low, s.suction);
    high = std::max(high, s.discharge);
  }
  if (high > 0) density_ = 0.5 * (low + high);
  const auto add = [&](const model::Location& at, double share) {
    model::Bearing b;
    b.name = fmt::format("anticipated cross-coupling {}", shares_.size() + 1);
    b.where = step_.where;
    b.at = at;
    b.law = model::CrossCoupling{};
    shares_.emplace_back(model_.bearings.size(), share);
    model_.bearings.push_back(std::move(b));
  };
  if (law_.at_stages) {
    for (const model::ApiStage& s : law_.stages)
      add(*s.at, anticipated_of(s, law_, machine_.ratio) / anticipated_);
    return;
  }
  model::Location middle;
  middle.shaft = machine_.shaft;
  middle.s = 0.5 * (machine_.model.bearings[machine_.journals.front()].at.s +
                    machine_.model.bearings[machine_.journals.back()].at.s);
  middle.text = "midway between the journals";
  middle.where = step_.where;
  add(law_.cross_coupling_at ? *law_.cross_coupling_at : middle, 1.0);
}

WhirlingMode Level1::at(double q, bool whatever_grows) {
  model::Model m = model_;
  // k > 0 drives the whirl from y to z, forward whirl of a shaft that turns so
  const double sense = m.shafts[machine_.shaft].speed_ratio < 0 ? -1.0 : 1.0;
  for (const auto& [i, share] : shares_)
    std::get<model::CrossCoupling>(m.bearings[i].law).k = sense * share * q;
  const assembly::Built built = assembly::build_system(m, sub_->mesh, step_.name);
  analysis::Linearizer linear = s_->linearizer_of(built.system);
  const double speed = law_.operating[1];
  analysis::ModesOptions o;
  o.count = 0;  // all that are slower than the rotor
  o.max_frequency = machine_.ratio * speed;
  o.motion = analysis::Motion::lateral;
  o.judge = o.real_roots = whatever_grows;
  analysis::SpectrumCertificate certificate;
  WhirlingMode found = least_stable(analysis::whirl_modes(linear, speed, o, &certificate),
                                    sub_->mesh, built.system, machine_, speed);
  if (!certificate.complete()) s_->certify(certificate, fmt::format("at Q = {:.5g} N/m", q));
  if (found.driven) return found;
  o.count = 16;  // none is: the slowest then
  o.max_frequency = infinity;
  o.certify = false;
  return least_stable(analysis::whirl_modes(linear, speed, o), sub_->mesh, built.system, machine_,
                      speed);
}

Level1::Below Level1::modes_below(const run::Job& parent, const model::Model& m,
                                  const model::Step& step, const ApiMachine& machine,
                                  double speed) {
  run::Job job(m, parent);
  results::FrequencyStep s(job, step, "modal", "modes slower than the rotor", speed);
  analysis::ModesOptions o;
  o.count = 0;
  o.max_frequency = machine.ratio * speed;
  o.motion = analysis::Motion::lateral;
  o.judge = o.real_roots = true;
  const std::vector<analysis::WhirlMode> modes = analysis::whirl_modes(s.linear, speed, o);
  const auto slower = [&](const analysis::WhirlMode& w) {
    return w.frequency > 0 && w.frequency <= o.max_frequency;
  };
  return {static_cast<int>(std::count_if(modes.begin(), modes.end(), slower)),
          least_stable(modes, job.mesh, job.system(), machine, speed)};
}

Level1::Curve Level1::find_curve() {
  Curve c;
  constexpr int points = 40;
  for (int k = 0; k <= points; ++k) {
    const double q = anticipated_ * reach * k / points;
    const WhirlingMode m = at(q);
    c.q.push_back(q);
    c.log_decrement.push_back(m.log_decrement);
    c.frequency.push_back(m.frequency);
    const std::size_t n = c.q.size();
    if (!std::isnan(c.onset) || m.log_decrement > 0) continue;
    c.onset = n == 1
                  ? 0.0
                  : analysis::find_crossing(c.q[n - 2], c.log_decrement[n - 2], q, m.log_decrement,
                                            1e-10, [&](double x) { return at(x).log_decrement; });
  }
  return c;
}

/// Highest continuous speed over the first undamped critical speed on rigid supports; nan where the
/// shaft has none within ten times the speed.
double Level1::find_critical_ratio() const {
  const model::Model m = with_rigid_journals(machine_, model_);
  const meshes::Mesh mesh = meshes::make_mesh(m);
  const assembly::Built built = assembly::build_system(m, mesh, step_.name);
  analysis::Linearizer linear = s_->linearizer_of(built.system);
  for (const double top : {2.0, 10.0}) {
    std::vector<analysis::Critical> found =
        undamped_forward(linear, top * law_.operating[1], machine_.ratio);
    keep_modes_of(mesh, built.system, machine_.shaft, found);
    if (!found.empty()) return law_.operating[1] / found.front().speed;
  }
  return nan;
}

void Level1::add_tables(const Curve& curve) {
  io::Table stages;
  stages.title = "Anticipated cross-coupling";
  stages.columns = {{"stage", "-", ""}, {"kind", "-", ""}, {"cross-coupling", "N/m", ""}};
  for (const model::ApiStage& s : law_.stages)
    stages.add({s.name, s.kind == model::ApiStage::Kind::axial ? "axial" : "radial",
                anticipated_of(s, law_, machine_.ratio)});
  stages.add({"sum, QA", "", anticipated_});
  s_->add_table("stages", std::move(stages));
  io::Table t;
  t.title = "Log decrement against cross-coupling";
  t.columns = {{"cross-coupling", "N/m", ""},
               {"Q / QA", "-", ""},
               {"log decrement", "-", "of the least stable forward mode slower than the rotor"},
               {"frequency", "Hz", ""}};
  for (std::size_t k = 0; k < curve.q.size(); ++k)
    t.add(
        {curve.q[k], curve.q[k] / anticipated_, curve.log_decrement[k], to_hz(curve.frequency[k])});
  s_->add_table("log_decrement", std::move(t), false);
}

void Level1::add_curve_figure(const Curve& curve) {
  plot::Axes a;
  a.x = plot::Axis("cross-coupled stiffness", "N/m");
  a.y = plot::Axis("log decrement", "-");
  a.y.include_zero = true;
  plot::Series line;
  line.label = "least stable forward mode";
  line.x = curve.q;
  line.y = curve.log_decrement;
  // far beyond the onset the table tells
  const double shown = 2.5 * std::max(anticipated_, curve.onset);
  const auto beyond = std::upper_bound(line.x.begin(), line.x.end(), shown);
  if (!std::isnan(curve.onset) && beyond != line.x.end()) {
    line.x.erase(beyond, line.x.end());
    line.y.resize(line.x.size());
  }
  a.series.push_back(std::move(line));
  a.legend = false;
  a.rules.push_back({true, anticipated_, "QA", {plot::ink, plot::Dash::dash_dot, 0.8}});
  if (!std::isnan(curve.onset))
    a.rules.push_back({true, curve.onset, "Q0", {plot::ink, plot::Dash::dash_dot, 0.8}});
  a.rules.push_back(
      {false, law_.limits.log_decrement, "least", {plot::ink, plot::Dash::dashed, 1.2}});
  a.rules.push_back({false, 0, "", {plot::ink, plot::Dash::solid, 1.0}});
  plot::Figure f;
  f.name = s_->file("log_decrement");
  f.title = "Stability against cross-coupling, level 1";
  f.axes.push_back(std::move(a));
  s_->add_figure(std::move(f));
}

void Level1::add_ratio_figure(double ratio) {
  if (std::isnan(density_) || std::isnan(ratio)) return;
  plot::Axes a;
  a.x = plot::Axis("mean density of the gas", "kg/m³");
  a.y = plot::Axis("critical speed ratio", "-");
  a.x.min = a.y.min = 0;
  a.x.max = 1.25 * std::max(law_.limits.density.back(), density_);
  a.y.max = 1.25 * std::max(ratio, law_.limits.critical_ratio.front());
  plot::Series edge;
  edge.label = "region A below, B above";
  edge.x = law_.limits.density;
  edge.y = law_.limits.critical_ratio;
  if (edge.x.front() > 0) {
    edge.x.insert(edge.x.begin(), 0.0);
    edge.y.insert(edge.y.begin(), edge.y.front());
  }
  edge.x.push_back(edge.x.back());
  edge.y.push_back(0.0);
  edge.keep_all = true;
  plot::Series here;
  here.label = "this machine";
  here.x = {density_};
  here.y = {ratio};
  here.style.width = 0;
  here.style.marker = plot::Marker::diamond;
  here.style.marker_size = 9;
  here.keep_all = true;
  a.series = {std::move(edge), std::move(here)};
  plot::Figure f;
  f.name = s_->file("critical_ratio");
  f.title = "Critical speed ratio against gas density";
  f.axes.push_back(std::move(a));
  s_->add_figure(std::move(f));
}

std::vector<Check> Level1::judge(const std::optional<WhirlingMode>& with_seals,
                                 const std::string& seals_figure) {
  const model::ApiLimits& l = law_.limits;
  const Curve curve = find_curve();
  const WhirlingMode anticipated = at(anticipated_, true);
  const double ratio = find_critical_ratio();
  const bool known = !std::isnan(density_) && !std::isnan(ratio);
  const bool in_b =
      known && ratio >= analysis::RatioBoundary{l.density, l.critical_ratio}.at(density_);
  add_tables(curve);
  add_curve_figure(curve);
  add_ratio_figure(ratio);
  io::Value& v = s_->summary();
  v["anticipated cross-coupling QA [N/m]"] = anticipated_;
  if (!std::isnan(curve.onset)) v["cross-coupling at the onset Q0 [N/m]"] = curve.onset;
  if (!std::isnan(ratio)) v["critical speed ratio"] = ratio;
  if (!std::isnan(density_)) v["mean density [kg/m^3]"] = density_;
  if (known) v["region"] = in_b ? "B" : "A";

  std::vector<Check> out;
  const std::string at_qa = fmt::format("QA = {:.5g} N/m", anticipated_);
  Check decrement = results::compare("level 1: log decrement", anticipated.log_decrement, "-",
                                     Check::Rule::at_least, l.log_decrement);
  decrement.where = fmt::format("{}, {:.4g} Hz", at_qa, to_hz(anticipated.frequency));
  decrement.source = source({"log_decrement"});
  decrement.figure = s_->file("log_decrement");
  if (anticipated.grows) decrement.remark = "a motion grows";
  double margin = std::isnan(curve.onset) ? reach : curve.onset / anticipated_;
  if (anticipated.grows) margin = std::min(margin, 1.0);  // faster than the rotor: not on the curve
  Check onset = results::compare("level 1: Q0/QA", margin, "-", Check::Rule::at_least,
                                 in_b ? l.ratio_in_b : l.ratio);
  onset.where = at_qa;
  onset.source = source({"ratio", "ratio_in_b", "density", "critical_ratio"});
  onset.figure = s_->file("log_decrement");
  onset.remark = std::isnan(curve.onset) ? "stable up to 10 QA" : "";
  if (known)
    onset.remark +=
        fmt::format("{}region {}: CSR {:.4g} at {:.4g} kg/m3", onset.remark.empty() ? "" : "; ",
                    in_b ? "B" : "A", ratio, density_);
  const bool needed = !decrement.passed || !onset.passed;
  if (needed && with_seals)  // that is what level 2 is for
    for (Check* c : {&decrement, &onset}) {
      c->remark += c->passed ? "" : std::string(c->remark.empty() ? "" : "; ") + "level 2 decides";
      c->judged = c->passed;
    }
  out.push_back(std::move(decrement));
  out.push_back(std::move(onset));
  if (with_seals) {
    Check second = check_as_given(law_, machine_, *with_seals, seals_figure);
    if (!needed && second.remark.empty()) second.remark = "not asked for by level 1";
    out.push_back(std::move(second));
  }
  s_->section.text = fmt::format("Without seals, {} at {:.6g} rpm.",
                                 law_.at_stages ? "each stage's cross-coupling where it is"
                                                : "all cross-coupling at one place",
                                 to_rpm(law_.operating[1]));
  s_->finish(fmt::format("QA {:.5g} N/m, log decrement {:.4g}, Q0/QA {}{:.4g}", anticipated_,
                         anticipated.log_decrement, std::isnan(curve.onset) ? "above " : "",
                         margin));
  return out;
}

}  // namespace whirl::steps
