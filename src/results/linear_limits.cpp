#include <results/linear_limits.hpp>
#include <core/contract.hpp>
#include <results/clearances.hpp>
#include <results/mesh_accuracy.hpp>
#include <results/refined_response.hpp>
#include <analysis/response/unbalance.hpp>
#include <analysis/spectra/instability_bands.hpp>
#include <assembly/film_kernels.hpp>
#include <assembly/table_spacing.hpp>
#include <run/diagnose.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace whirl::results {

void warn(run::Job& job, Diagnostic d) {
  d.severity = Diagnostic::Severity::warning;
  job.report.warnings.push_back(d.message);
  job.summary["warnings"].push(d.code + ": " + d.message);
  if (!job.options.quiet) run::print_diagnostics({d});
}

namespace {

/// Free motions of a step's rotor that grow, whether its response lists modes or not.
class Growth {
 public:
  /// judged: rad/s; lateral motions slower than this are left out.
  Growth(FrequencyStep& s, analysis::Motion motion, double judged = 0.0)
      : step_(s),
        motion_(motion),
        judged_(judged),
        solver_(s.linear, options()),
        mesh_(s) {}
  /// What grows at a speed.
  FreeGrowth at(double Omega) {
    const std::optional<analysis::WhirlMode> mode = fastest(solver_, Omega);
    if (!mode) {
      const analysis::SpectrumCertificate& known = solver_.certificate();
      if (!known.stability_certain()) known_to_ = std::min(known_to_, known.list.radius);
      return {};
    }
    if (is_resolved(*mode, Omega)) return growth_of(*mode);
    // What elements as long as its waves say of a motion is no property of the rotor.
    if (!refined_) {
      refined_.emplace(step_);
      on_refined_.emplace(refined_->linear(), options());
    }
    const std::optional<analysis::WhirlMode> refined = fastest(*on_refined_, Omega);
    if (refined) return growth_of(*refined);
    known_to_ = std::min(known_to_, mode->frequency);
    return {};
  }
  /// rad/s: growth above it is not excluded at one of the speeds; infinite: it is at all.
  double known_to() const { return known_to_; }

 private:
  analysis::ModesOptions options() const {
    analysis::ModesOptions o;
    o.motion = motion_;
    o.count = 4;
    o.judge = true;
    o.real_roots = true;
    return o;
  }
  std::optional<analysis::WhirlMode> fastest(analysis::WhirlSolver& solver, double Omega) const {
    const analysis::WhirlMode* found = nullptr;
    for (const analysis::WhirlMode& m : solver.solve(Omega)) {
      if (m.kind == analysis::ModeKind::lateral && m.frequency < judged_) continue;
      if (!found || m.lambda.real() > found->lambda.real()) found = &m;
    }
    if (!found || found->growth() <= 0) return std::nullopt;
    return *found;
  }
  bool is_resolved(const analysis::WhirlMode& mode, double Omega) {
    constexpr double coarse = 0.05;  // of the frequency
    return !mode.oscillates() || !(mesh_.of(mode, Omega, "") > coarse);
  }
  static FreeGrowth growth_of(const analysis::WhirlMode& mode) {
    FreeGrowth out;
    out.rate = mode.lambda.real();
    out.text = fmt::format("{} motion at {:.4g} Hz grows by {:.3g} 1/s", to_string(mode.kind),
                           to_hz(mode.frequency), mode.lambda.real());
    return out;
  }

  FrequencyStep& step_;
  analysis::Motion motion_;
  double judged_;
  analysis::WhirlSolver solver_;
  MeshAccuracy mesh_;
  std::optional<RefinedModel> refined_;
  std::optional<analysis::WhirlSolver> on_refined_;
  double known_to_ = infinity;
};

/// The band of speeds in which free motions of a rotor grow whose stiffness or inertia turns with it: the
/// first of those between the speeds, all in the same sense; the band is that of their magnitudes. Harmonics left out of Hill's equations may make one of nothing:
/// it is there with two more of them too. counted_to: rad/s, fixed axes; slower motions are counted at every
/// speed, 0 where they are not.
std::optional<analysis::InstabilityBand> band_among(FrequencyStep& s,
                                                    const std::vector<double>& speeds,
                                                    double& counted_to) {
  constexpr Index modes = 8, more = 2, most = 5;
  analysis::BandOptions o;
  o.modes = modes;
  o.sense = speeds.front() < 0.0 ? -1.0 : 1.0;
  for (const double Omega : speeds)
    o.speeds.push_back(std::abs(Omega));
  std::sort(o.speeds.begin(), o.speeds.end());
  const double probed = o.sense * o.speeds.back();
  // a band's edges are those of the response without bound: of as many harmonics
  const Index H = std::max<Index>(analysis::enough_harmonics(s.linear, speeds, most), 1);
  analysis::RotatingAxes axes(s.linear, probed, {.least = H, .most = std::max<Index>(H, 3)});
  const analysis::BandResult found = analysis::find_bands(axes, o);
  counted_to =
      found.complete() ? std::max(0.0, found.counted_to - std::abs(axes.speed(probed))) : 0.0;
  if (found.bands.empty() || axes.constant())
    return found.bands.empty() ? std::nullopt : std::optional(found.bands.front());
  const Index finer_harmonics = axes.harmonics() + more;
  analysis::RotatingAxes finer(s.linear, probed,
                               {.least = finer_harmonics, .most = finer_harmonics});
  for (const analysis::InstabilityBand& band : found.bands) {
    const double nothing = analysis::unnoticed_share(finer) * std::abs(finer.speed(band.speed));
    const double growth =
        analysis::largest_growth(finer, o.sense * band.speed, o.speeds.back(), modes);
    if (growth > std::max(nothing, 0.5 * band.growth)) return band;
  }
  return std::nullopt;
}

/// W13. @throws e unless it says that a table of frequencies ends: modes below one that reaches the excitation.
FreeGrowth unknown_growth(FrequencyStep& s, double Omega, const Error& e) {
  if (e.diagnostics().front().code != "E81") throw e;
  FreeGrowth out;
  out.judged = false;
  out.open = fmt::format("whether free motions grow at {:.6g} rpm is not known", to_rpm(Omega));
  Diagnostic d;
  d.code = "W13";
  d.message =
      fmt::format("step '{}': {}: {}", s.step.name, out.open, e.diagnostics().front().message);
  d.hint = "extend the frequencies of the table, or write extrapolate = \"hold\"";
  warn(s.job, std::move(d));
  return out;
}

/// counted_to: as of band_among().
FreeGrowth growth_in_band(FrequencyStep& s, const std::vector<double>& speeds, double& counted_to) {
  std::optional<analysis::InstabilityBand> band;
  FreeGrowth none;
  try {
    band = band_among(s, speeds, counted_to);
  } catch (const Error& e) {
    none = unknown_growth(s, speeds.back(), e);
  }
  if (!band) return none;
  const double sense = speeds.front() < 0.0 ? -1.0 : 1.0;
  const auto edge = [sense](double Omega, const char* beyond, double last) {
    return std::isnan(Omega) ? fmt::format("{} {:.6g}", beyond, to_rpm(last))
                             : fmt::format("{:.6g}", to_rpm(sense * Omega));
  };
  const auto [least, most] = std::minmax_element(
      speeds.begin(), speeds.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  FreeGrowth out;
  out.rate = band->growth;
  out.text = fmt::format("the rotor, whose {} turns with it, is unstable from {} to {} rpm ({})",
                         what_turns(s.job.model), edge(band->low, "below", *least),
                         edge(band->high, "above", *most),
                         band->frequency > 1e-6 * band->speed
                             ? fmt::format("a motion grows by {:.3g} 1/s at {:.6g} rpm",
                                           band->growth, to_rpm(sense * band->speed))
                             : "it bends out at its own speed");
  return out;
}

}  // namespace

void warn_of_mean_crack(run::Job& job, const std::string& step, bool turns) {
  if (!turns || !breathes(job.model)) return;
  Diagnostic d;
  d.code = "W14";
  d.message = fmt::format(
      "step '{}': the crack enters as the mean of its compliance over a revolution", step);
  d.hint = "an unbalance response and a transient turn with the shaft";
  warn(job, std::move(d));
}

std::string moments_along_shafts(const model::Model& m) {
  std::string names;
  for (const model::PointLoad& l : m.loads)
    if (m.shafts[l.at.shaft].rotating && l.moment.x() != 0.0)
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", l.name);
  if (names.empty()) return {};
  return fmt::format(
      "load {} twists a shaft by a moment that has no potential as the shaft tilts and can itself "
      "drive whirl; a torque on the turning is a [[drive]]",
      names);
}

namespace {

/// Reference speeds at which what is given in a table has a say of its own.
std::vector<std::vector<double>> rows_of_tables(const model::Model& m) {
  std::vector<std::vector<double>> out;
  const auto add = [&](std::size_t shaft, std::vector<double> rows) {
    const double ratio = m.shafts[shaft].speed_ratio;
    if (ratio == 0.0) return;
    for (double& row : rows)
      row /= ratio;
    out.push_back(std::move(rows));
  };
  for (const model::Bearing& b : m.bearings)
    if (const auto* table = std::get_if<model::TableBearing>(&b.law)) add(b.at.shaft, table->speed);
  for (const model::Drive& d : m.drives) {
    const auto* curve = std::get_if<model::TorqueCurve>(&d.law);
    if (!curve) continue;
    std::vector<double> between;  // where its slope, which drives, is that of a stretch
    for (std::size_t k = 1; k < curve->speed.size(); ++k)
      between.push_back(0.5 * (curve->speed[k - 1] + curve->speed[k]));
    add(d.at.shaft, std::move(between));
  }
  return out;
}

}  // namespace

std::vector<double> table_speeds_between(const run::Job& job, double first, double last) {
  constexpr std::size_t few = 16;
  std::vector<double> out;
  for (std::vector<double> rows : rows_of_tables(job.model)) {
    std::erase_if(rows, [&](double row) { return !(row > first && row < last); });
    const std::size_t every = (rows.size() + few - 1) / few;
    for (std::size_t k = 0; k < rows.size(); k += every)
      out.push_back(rows[k]);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<double> speeds_to_judge(const run::Job& job, const std::vector<double>& speeds) {
  WHIRL_EXPECTS(!speeds.empty());
  constexpr std::size_t few = 16;
  const auto [least, most] = std::minmax_element(speeds.begin(), speeds.end());
  const double first = *least, last = *most;
  std::vector<double> out{first, 0.5 * (first + last), last};
  if (speeds.size() <= few) out.insert(out.end(), speeds.begin(), speeds.end());
  const std::vector<double> rows = table_speeds_between(job, first, last);
  out.insert(out.end(), rows.begin(), rows.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

namespace {

/// At speeds of either sense; counted_to: as of band_among(), the least.
FreeGrowth growth_in_bands(FrequencyStep& s, const std::vector<double>& speeds,
                           double& counted_to) {
  std::vector<double> backwards, forwards;
  for (const double Omega : speeds)
    if (Omega != 0.0) (Omega < 0.0 ? backwards : forwards).push_back(Omega);
  FreeGrowth all;
  for (const std::vector<double>& sense : {backwards, forwards}) {
    if (sense.empty()) continue;
    double counted = 0.0;
    const FreeGrowth found = growth_in_band(s, sense, counted);
    if (!found.text.empty()) all.text += (all.text.empty() ? "" : "; ") + found.text;
    all.rate = std::max(all.rate, found.rate);
    if (!found.judged) {
      all.judged = false;
      all.open = found.open;
    }
    counted_to = std::min(counted_to, counted);
  }
  return all;
}

/// At speeds one by one; of_the_mean: over a revolution.
FreeGrowth growth_at_speeds(FrequencyStep& s, const std::vector<double>& speeds,
                            Growth& free_motions, bool of_the_mean) {
  FreeGrowth none;
  for (const double Omega : speeds) {
    try {
      FreeGrowth growth = free_motions.at(Omega);
      if (growth.text.empty()) continue;
      growth.text = fmt::format(
          "the rotor{} is unstable at {:.6g} rpm ({})",
          of_the_mean ? fmt::format(", its {} the mean over a revolution,", what_turns(s.job.model))
                      : "",
          to_rpm(Omega), growth.text);
      return growth;
    } catch (const Error& e) {
      if (none.judged) none = unknown_growth(s, Omega, e);  // said once, looked for on
    }
  }
  if (!none.judged || free_motions.known_to() == infinity) return none;
  const double top = to_hz(free_motions.known_to());
  s.summary()["growth not excluded above [Hz]"] = top;
  none.open = fmt::format("growth above {:.5g} Hz not excluded", top);
  s.say_also(none.open);
  return none;
}

}  // namespace

FreeGrowth find_growth(FrequencyStep& s, std::vector<double> speeds, analysis::Motion motion) {
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end()), speeds.end());
  const bool bends = motion == analysis::Motion::all || motion == analysis::Motion::lateral;
  double counted_to = infinity;
  const bool turns = bends && s.turns_as_one() &&
                     (turns_with_stiffness(s.job.model) || turns_with_inertia(s.job.model));
  FreeGrowth bands;
  if (turns) bands = growth_in_bands(s, speeds, counted_to);
  if (!bands.text.empty()) return bands;
  // what turns joins slow motions alone: what bends faster grows as with the mean
  Growth free_motions(s, turns ? analysis::Motion::lateral : motion, turns ? counted_to : 0.0);
  const FreeGrowth all = growth_at_speeds(s, speeds, free_motions, turns);
  return all.text.empty() && !bands.judged ? bands : all;
}

bool warn_of_growth(FrequencyStep& s, std::vector<double> speeds, analysis::Motion motion) {
  const std::string growth = find_growth(s, std::move(speeds), motion).text;
  if (growth.empty()) return false;
  Diagnostic d;
  d.code = "W13";
  d.message =
      fmt::format("step '{}': {}: the steady response is never reached there", s.step.name, growth);
  d.hint = "a stability step finds where that begins, a transient step what the rotor does there";
  const std::string moments = moments_along_shafts(s.job.model);
  if (!moments.empty()) d.hint += "; " + moments;
  warn(s.job, std::move(d));
  return true;
}

/// rad: what is left out goes with the square of the tilt, 1 %.
constexpr double small_tilt = 0.1;

void GapCheck::look_at(const Worst& seen, const std::string& name, double at_rest) {
  Worst& x = worst_[name];
  double share = x.film_share;
  if (seen.film && seen.gap > at_rest)
    share = std::max(share, (seen.displacement - at_rest) / (seen.gap - at_rest));
  if (!(x.gap > 0) || seen.displacement * x.gap > x.displacement * seen.gap) x = seen;
  x.film_share = share;
}

void GapCheck::look(double Omega, std::span<const VecXc> amplitudes, double frequency) {
  const run::Job& job = step_.job;
  if (amplitudes.empty()) return;
  look_at_tilts(Omega, amplitudes, frequency);
  look_at_forces(Omega, amplitudes, frequency);
  look_at_currents(Omega, amplitudes, frequency);
  const std::vector<std::size_t> seals = seals_of(job.model);
  const std::vector<assembly::SupportCondition>& conditions = job.built.conditions;
  if (conditions.empty() && seals.empty()) return;
  step_.linear.at(Omega);
  const system::State& still = step_.linear.equilibrium().state;
  system::Workspace w = job.system().make_workspace();
  const auto node = [&](Index n) -> const system::NodeState& { return w.in_own_axes(n); };
  const auto seal = [&](std::size_t b) { return displacement_at(job.mesh.bearings[b], node); };
  std::vector<double> at_rest, seal_at_rest;
  job.system().evaluate_nodes(w, still.frames, still.t, still.q, still.v, still.a);
  for (const assembly::SupportCondition& c : conditions)
    at_rest.push_back(c.state(node).displacement);
  for (const std::size_t b : seals)
    seal_at_rest.push_back(seal(b));
  const std::vector<analysis::Point> stations = station_points(job);
  reach_.resize(stations.size(), 0.0);
  constexpr int looks = 24;  // a period: the extreme is met to 1 %
  for (int k = 0; k < looks; ++k) {
    const Complex turn = std::polar(1.0, two_pi * k / looks);
    VecX q = still.q;
    for (const VecXc& a : amplitudes)
      q += (a * turn).real();
    job.system().evaluate_nodes(w, still.frames, still.t, q, still.v, still.a);
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const assembly::SupportCondition& c = conditions[i];
      const assembly::SupportCondition::State s = c.state(node);
      if (!(s.gap > 0)) continue;
      look_at({.displacement = s.displacement,
               .gap = s.gap,
               .speed = Omega,
               .frequency = frequency,
               .film = s.film,
               .where = c.where,
               .bearing = c.bearing},
              c.name, at_rest[i]);
    }
    for (std::size_t i = 0; i < seals.size(); ++i) {
      const model::Bearing& b = job.model.bearings[seals[i]];
      look_at({.displacement = seal(seals[i]),
               .gap = seal_gap(b),
               .speed = Omega,
               .frequency = frequency,
               .film = true,
               .where = b.where,
               .bearing = seals[i]},
              b.name, seal_at_rest[i]);
    }
    for (std::size_t i = 0; i < stations.size(); ++i) {
      const system::NodeState& at = node(stations[i].node);
      const Vec3 u = at.u + stations[i].offset * at.t;
      reach_[i] = std::max(reach_[i], u.tail<2>().norm());
    }
  }
}

void GapCheck::look_at_tilts(double Omega, std::span<const VecXc> amplitudes, double frequency) {
  for (Index i = 0; i < step_.job.system().nodes(); ++i) {
    double tilt = 0;
    for (const VecXc& a : amplitudes)
      tilt += a.segment<2>(6 * i + system::gamma2).norm();
    if (!(tilt > tilt_.largest)) continue;
    tilt_ = {tilt, Omega, frequency, i};
  }
}

bool GapCheck::goes_further(std::span<const VecXc> amplitudes) {
  const std::vector<meshes::BearingNodes>& bearings = step_.job.mesh.bearings;
  ways_.resize(bearings.size());
  bool further = false;
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    Way now;
    for (const Index n : {bearings[i].shaft.node, bearings[i].other.node})
      for (const VecXc& a : amplitudes) {
        if (n < 0) continue;
        now.along += a.segment<3>(6 * n).norm();
        now.tilt += a.segment<3>(6 * n + 3).norm();
      }
    Way& before = ways_[i];
    further = further || now.along > 1.01 * before.along || now.tilt > 1.01 * before.tilt;
    before.along = std::max(before.along, now.along);
    before.tilt = std::max(before.tilt, now.tilt);
  }
  return further;
}

void GapCheck::look_at_forces(double Omega, std::span<const VecXc> amplitudes, double frequency) {
  // how far a force leaves its linear part grows with the motion
  if (!goes_further(amplitudes)) return;
  step_.linear.move_to(Omega);
  SupportBends supports(step_.job, step_.linear.equilibrium().state,
                        step_.linear.running().running().mean);
  VecX cosine = VecX::Zero(amplitudes.front().size()), sine = cosine;
  for (const VecXc& a : amplitudes) {
    cosine += a.real();
    sine -= a.imag();
  }
  const SupportBends::Loads by_cosine = supports.linear_along(cosine),
                            by_sine = supports.linear_along(sine);
  constexpr int looks = 24;  // a period: the extreme is met to 1 %
  for (int k = 0; k < looks; ++k) {
    const double c = std::cos(two_pi * k / looks), s = std::sin(two_pi * k / looks);
    supports.look(c * cosine + s * sine, c * by_cosine + s * by_sine);
  }
  most_.take(supports.bends(), longest_line(step_.job));
  bent_.resize(supports.bends().size());
  for (std::size_t i = 0; i < bent_.size(); ++i) {
    const SupportBend& now = supports.bends()[i];
    if (now.beyond(bent_[i].bend)) bent_[i] = {now, Omega, frequency};
  }
}

void GapCheck::look_at_currents(double Omega, std::span<const VecXc> amplitudes, double frequency) {
  const std::vector<assembly::MagneticControl>& controls = step_.job.built.magnetic_controls;
  if (controls.empty()) return;
  if (currents_.empty()) currents_ = current_needs(step_.job);
  step_.linear.move_to(Omega);
  const VecX& still = step_.linear.equilibrium().state.q;
  const std::span<const double> orders = step_.linear.running().orders();
  const double place = static_cast<double>(places_.size());
  places_.emplace_back(Omega, frequency);
  for (std::size_t i = 0; i < controls.size(); ++i)
    for (const Index node : controls[i].currents) {
      double current = std::abs(still[6 * node]), rate = 0;
      for (std::size_t k = 0; k < amplitudes.size(); ++k) {
        const double w = std::isnan(frequency) ? orders[k] * Omega : frequency;
        current += std::abs(amplitudes[k][6 * node]);
        rate += std::abs(w * amplitudes[k][6 * node]);
      }
      const double unit = controls[i].current_unit;
      currents_[i].take(unit * current, unit * rate, place);
    }
}

namespace {

/// "at 3000 rpm and 40 Hz"
std::string place_of(double speed, double frequency) {
  return std::isnan(frequency)
             ? fmt::format("at {:.6g} rpm", to_rpm(speed))
             : fmt::format("at {:.6g} rpm and {:.5g} Hz", to_rpm(speed), to_hz(frequency));
}

}  // namespace

std::string GapCheck::Worst::text() const { return place_of(speed, frequency); }

void GapCheck::report_tilt() {
  if (!(tilt_.largest > small_tilt)) return;
  Diagnostic d;
  d.code = "W11";
  d.message = fmt::format(
      "step '{}': {} the response would tilt the shaft by {:.3g} rad ({}): a linear response is "
      "that of small motions",
      step_.step.name, place_of(tilt_.speed, tilt_.frequency), tilt_.largest,
      step_.job.system().node(tilt_.node).name);
  d.hint = "less unbalance, more damping or another speed; a transient step has no such limit";
  warn(step_.job, std::move(d));
}

bool GapCheck::is_named(std::size_t bearing) const {
  const auto worst = worst_.find(step_.job.model.bearings[bearing].name);
  const bool by_gap = worst != worst_.end() &&
                      (worst->second.film || worst->second.displacement > worst->second.gap);
  return by_gap || std::any_of(currents_.begin(), currents_.end(), [&](const CurrentNeed& x) {
           return x.bearing == bearing && x.beyond_current();
         });
}

void GapCheck::report_forces() {
  for (std::size_t i = 0; i < bent_.size(); ++i) {
    const Bent& x = bent_[i];
    if (!most_.misled_by(x.bend) || is_named(i)) continue;
    const model::Bearing& b = step_.job.model.bearings[i];
    Diagnostic d;
    d.code = "W11";
    d.message = fmt::format(
        "step '{}': {} the response takes {}: a linear response does not know it", step_.step.name,
        place_of(x.speed, x.frequency), text_of(x.bend, most_, b.name));
    d.hint = fmt::format("{}a transient step meets it as it is", of_bends);
    d.where = b.where;
    warn(step_.job, std::move(d));
  }
}

void GapCheck::report_currents() {
  for (const CurrentNeed& x : currents_)
    for (const bool of_rate : {false, true}) {
      if (of_rate ? !x.beyond_rate() : !x.beyond_current()) continue;
      const model::Bearing& b = step_.job.model.bearings[x.bearing];
      const auto& [speed, frequency] =
          places_[static_cast<std::size_t>(of_rate ? x.rate_at : x.current_at)];
      Diagnostic d;
      d.code = "W11";
      d.message =
          fmt::format("step '{}': {} the response needs {}: a linear response does not know it",
                      step_.step.name, place_of(speed, frequency), text_of(x, of_rate, b.name));
      d.hint = "a transient step meets the amplifier as it is";
      d.where = b.where;
      warn(step_.job, std::move(d));
    }
}

void GapCheck::report(const std::string& of) {
  report_tilt();
  report_forces();
  report_currents();
  std::vector<UsedGap> used;
  for (const auto& [name, x] : worst_) {
    if (!(x.gap > 0)) continue;
    used.push_back({x.bearing, x.gap, x.displacement, x.text()});
    io::Value& v = step_.summary()["gaps"][name];
    v["gap [m]"] = x.gap;
    v["largest displacement [m]"] = x.displacement;
    v["at [rpm]"] = to_rpm(x.speed);
    if (x.film) v["share of the film that the response takes"] = x.film_share;
    const bool beyond = x.displacement > x.gap;
    if (!beyond && x.film_share <= small_in_film) continue;
    Diagnostic d;
    d.code = "W11";
    d.message =
        beyond
            ? fmt::format(
                  "step '{}': {} the response would take the shaft {:.4g} mm from the "
                  "middle of '{}', whose {} is {:.4g} mm ({:.3g} times): a linear response "
                  "does not know it",
                  step_.step.name, x.text(), 1e3 * x.displacement, name,
                  x.film ? "clearance" : "gap", 1e3 * x.gap, x.displacement / x.gap)
            : fmt::format(
                  "step '{}': {} the response takes {:.2g} of the film that the equilibrium "
                  "leaves in '{}' ({:.4g} of {:.4g} mm from its middle): its coefficients "
                  "are those of small motions",
                  step_.step.name, x.text(), x.film_share, name, 1e3 * x.displacement, 1e3 * x.gap);
    d.hint =
        "a transient step meets the contact or the film as it is; less unbalance, more damping "
        "or another speed keeps the response linear";
    d.where = x.where;
    warn(step_.job, std::move(d));
  }
  if (used.empty() || !step_.job.model.output.report) return;
  add_clearances(step_.job, step_.section, step_.file("clearance_diagram"),
                 step_.step.name + ", " + of, reach_, used);
}

double table_slack(const model::TableBearing& table) {
  return 1e-9 * std::max(std::abs(table.speed.front()), std::abs(table.speed.back()));
}

namespace {

/// How far a shaft turns beyond the ends of a bearing's table, rad/s; 0: not, or none is held.
double beyond_table(const run::Job& job, const model::Bearing& b, double low, double high) {
  const auto* table = std::get_if<model::TableBearing>(&b.law);
  if (!table || !table->extrapolate_hold || table->speed.empty()) return 0.0;
  const double ratio = job.model.shafts[b.at.shaft].speed_ratio;
  const double below = table->speed.front() - std::min(ratio * low, ratio * high);
  const double above = std::max(ratio * low, ratio * high) - table->speed.back();
  const double most = std::max(below, above);
  return most > table_slack(*table) ? most : 0.0;
}

}  // namespace

void warn_of_coarse_tables(run::Job& job, const std::string& step,
                           std::span<const UsedTable> tables) {
  constexpr double admitted = 0.02;
  assembly::CoarsestRow worst;
  const model::Bearing* named = nullptr;
  std::string others;
  for (const UsedTable& t : tables) {
    const model::Bearing& b = job.model.bearings[t.bearing];
    const auto* table = std::get_if<model::TableBearing>(&b.law);
    if (!table) continue;
    const assembly::CoarsestRow row = assembly::coarsest_row(*table, t.low, t.high);
    if (!(row.error > admitted)) continue;
    others += fmt::format("{}'{}'", others.empty() ? "" : ", ", b.name);
    if (row.error <= worst.error) continue;
    worst = row;
    named = &b;
  }
  if (!named) return;
  const std::string place = worst.against_frequency ? fmt::format("{:.6g} Hz", to_hz(worst.at))
                                                    : fmt::format("{:.6g} rpm", to_rpm(worst.at));
  const bool alone = others == fmt::format("'{}'", named->name);
  const std::string several =
      alone ? others : fmt::format("{}; most for '{}'", others, named->name);
  Diagnostic d;
  d.code = "W16";
  d.message = fmt::format(
      "step '{}': rows of tables are far apart for {}, whose coefficients beside {} "
      "are known to about {:.2g} % only (without the row there they would be {:.2g} % off)",
      step, several, place, 100 * worst.error, 400 * worst.error);
  d.hint = "more rows about there";
  d.where = named->where;
  warn(job, std::move(d));
}

namespace {

void warn_of_held_tables(run::Job& job, const std::string& step, double low, double high) {
  const model::Bearing* worst = nullptr;
  double most = 0;
  std::string others;
  for (const model::Bearing& b : job.model.bearings) {
    const double beyond = beyond_table(job, b, low, high);
    if (beyond == 0.0) continue;
    others += fmt::format("{}'{}'", others.empty() ? "" : ", ", b.name);
    if (beyond <= most) continue;
    most = beyond;
    worst = &b;
  }
  if (!worst) return;
  const auto& table = std::get<model::TableBearing>(worst->law);
  const double ratio = job.model.shafts[worst->at.shaft].speed_ratio;
  Diagnostic d;
  d.code = "W12";
  d.message = fmt::format(
      "step '{}': the coefficients at the edge of their tables are held beyond them for {}; most "
      "for '{}', whose table covers {:.6g} to {:.6g} rpm and whose shaft turns at {:.6g} to {:.6g} "
      "rpm",
      step, others, worst->name, to_rpm(table.speed.front()), to_rpm(table.speed.back()),
      to_rpm(ratio * low), to_rpm(ratio * high));
  d.hint = "a table over all speeds of the step, or extrapolate = \"error\"";
  d.where = worst->where;
  warn(job, std::move(d));
}

}  // namespace

TablesBegin where_tables_begin(const run::Job& job) {
  TablesBegin out;
  for (const model::Bearing& b : job.model.bearings) {
    const auto* table = std::get_if<model::TableBearing>(&b.law);
    const double ratio = std::abs(job.model.shafts[b.at.shaft].speed_ratio);
    if (!table || table->extrapolate_hold || table->speed.size() < 2 || ratio == 0.0) continue;
    const double first = table->speed.front(), last = table->speed.back();
    const double begins =
        first * last > 0 ? std::min(std::abs(first), std::abs(last)) / ratio : 0.0;
    if (begins <= out.speed) continue;
    out.speed = begins;
    out.said = fmt::format(
        "critical speeds below {:.6g} rpm are not looked for: the table of bearing '{}' begins "
        "there",
        to_rpm(begins), b.name);
  }
  return out;
}

void warn_of_tables(run::Job& job, const std::string& step, double low, double high) {
  warn_of_held_tables(job, step, low, high);
  std::vector<UsedTable> used;
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const double ratio = job.model.shafts[job.model.bearings[i].at.shaft].speed_ratio;
    const auto [least, most] = std::minmax({ratio * low, ratio * high});
    used.push_back({i, least, most});
  }
  warn_of_coarse_tables(job, step, used);
}

void warn_of_tables(run::Job& job, const std::string& step, std::span<const double> speeds) {
  WHIRL_EXPECTS(!speeds.empty());
  warn_of_held_tables(job, step, speeds.front(), speeds.back());
  std::vector<UsedTable> used;
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const model::Bearing& b = job.model.bearings[i];
    const double ratio = job.model.shafts[b.at.shaft].speed_ratio;
    const auto [least, most] = std::minmax({ratio * speeds.front(), ratio * speeds.back()});
    used.push_back({i, least, most});
    const auto* table = std::get_if<model::TableBearing>(&b.law);
    if (!table) continue;
    const auto row_at = [&](double speed) {
      return std::find_if(table->speed.begin(), table->speed.end(), [&](double row) {
        return std::abs(row - ratio * speed) <= 1e-12 * std::abs(row);
      });
    };
    const auto first = row_at(speeds.front());
    if (std::all_of(speeds.begin(), speeds.end(),
                    [&](double speed) { return row_at(speed) != table->speed.end(); }))
      used.back().low = used.back().high = *first;
  }
  warn_of_coarse_tables(job, step, used);
}

double admitted_excess() {
  static const double corner = assembly::short_bearing_excess(longest_short_bearing, 0.7);
  return corner;
}

void warn_of_short_bearings(run::Job& job, const std::string& step,
                            std::span<const ShortFilm> films) {
  double worst = 0.0;
  const ShortFilm* named = nullptr;
  std::string others;
  for (const ShortFilm& f : films) {
    const model::Bearing& b = job.model.bearings[f.bearing];
    const auto* law = std::get_if<model::ShortJournal>(&b.law);
    if (!law) continue;
    const double excess =
        assembly::short_bearing_excess(law->length / law->diameter, f.eccentricity);
    job.summary["steps"][step]["force of short bearings over finite ones"][b.name] = excess;
    const bool too_long = law->length > longest_short_bearing * law->diameter * (1.0 + 1e-9);
    if (!too_long && excess <= admitted_excess() * (1.0 + 1e-9)) continue;
    others += fmt::format("{}'{}'", others.empty() ? "" : ", ", b.name);
    if (excess <= worst) continue;
    worst = excess;
    named = &f;
  }
  if (!named) return;
  const model::Bearing& b = job.model.bearings[named->bearing];
  const auto& law = std::get<model::ShortJournal>(b.law);
  Diagnostic d;
  d.code = "W03";
  d.message = fmt::format(
      "step '{}': too long for the theory of short bearings: {}; '{}' with L/D = {:.3g} at "
      "eccentricity {:.3f} has {:.3g} times the force of a bearing of finite length",
      step, others, b.name, law.length / law.diameter, named->eccentricity, worst);
  d.hint = "type = \"journal\" has no such limit";
  d.where = b.where;
  warn(job, std::move(d));
}

void warn_of_short_bearings(run::Job& job, const std::string& step, const system::State& s) {
  const auto is_short = [](const model::Bearing& b) {
    return std::holds_alternative<model::ShortJournal>(b.law);
  };
  if (std::none_of(job.model.bearings.begin(), job.model.bearings.end(), is_short)) return;
  system::Workspace w = job.system().make_workspace();
  job.system().evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a);
  std::vector<ShortFilm> films;
  for (const assembly::SupportCondition& c : job.built.conditions) {
    if (!is_short(job.model.bearings[c.bearing])) continue;
    const auto x = c.state([&](Index n) -> const system::NodeState& { return w.in_own_axes(n); });
    films.push_back({c.bearing, x.displacement / x.gap});
  }
  warn_of_short_bearings(job, step, films);
}

}  // namespace whirl::results
