#include <core/messages.hpp>
#include <core/text.hpp>
#include <model/full_section.hpp>
#include <run/diagnose.hpp>
#include <results/frequency.hpp>
#include <results/turned_back.hpp>
#include <results/held.hpp>
#include <results/linear_limits.hpp>
#include <results/steady_rotation.hpp>
#include <results/support_coefficients.hpp>
#include <run/progress.hpp>
#include <run/support_diagnosis.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

namespace whirl::results {

analysis::SteadyRotation steady_rotation_of(const model::Model& model, const meshes::Mesh& mesh,
                                            const assembly::Built& built, double top_speed) {
  const auto lines = static_cast<std::size_t>(built.system.lines());
  if (lines < mesh.lines.size())
    throw std::logic_error("the rotation of a system before it is built");
  analysis::SteadyRotation r;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    r.ratio.push_back(mesh.lines[l].rotating ? model.shafts[l].speed_ratio : 0.0);
  r.ratio.resize(lines, 0.0);
  r.top_speed = top_speed;
  r.table_frequencies = built.table_frequencies;
  r.axially_free = built.axially_free;
  for (const assembly::MagneticControl& c : built.magnetic_controls)
    r.control_bandwidth = std::max(r.control_bandwidth, c.bandwidth);
  return r;
}

analysis::SteadyRotation steady_rotation_of(const run::Job& job, double top_speed) {
  return steady_rotation_of(job.model, job.mesh, job.built, top_speed);
}

std::vector<double> speeds_of(const model::SpeedRange& r) {
  if (!r.values.empty()) return r.values;
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(std::max(r.points, 0)));
  // the end is met, and standing still within a range is no rounding beside it
  const double rounding = 1e-12 * std::max(std::abs(r.start), std::abs(r.stop));
  const int last = r.points - 1;
  for (int k = 0; k < r.points; ++k) {
    const double x = k == last ? r.stop : r.start + (r.stop - r.start) * k / last;
    out.push_back(std::abs(x) < rounding ? 0.0 : x);
  }
  return out;
}

std::vector<double> frequencies_of(const model::FrequencyRange& r) {
  return speeds_of({r.start, r.stop, r.points, r.values});
}

analysis::Motion motion_of(model::MotionKind kind) { return static_cast<analysis::Motion>(kind); }

plot::Whirl whirl_of(analysis::Direction d) {
  switch (d) {
    case analysis::Direction::forward: return plot::Whirl::forward;
    case analysis::Direction::backward: return plot::Whirl::backward;
    case analysis::Direction::mixed:
    case analysis::Direction::planar: return plot::Whirl::mixed;
    case analysis::Direction::none: break;
  }
  return plot::Whirl::none;
}

std::string description(const analysis::WhirlMode& m) {
  std::string out{to_string(m.kind)};
  if (m.direction != analysis::Direction::none) out += fmt::format(", {}", to_string(m.direction));
  return out;
}

std::vector<analysis::Measurement> support_measurements(const run::Job& job) {
  std::vector<analysis::Measurement> out;
  for (const assembly::SupportForce& f : job.built.support_forces) {
    analysis::Measurement m{"bearing " + f.name + " force",
                            "N",
                            "force of the support on the shaft, fixed axes",
                            {"x", "y", "z"},
                            1.0,
                            {}};
    m.evaluate = [&f](const analysis::Snapshot& s, double* v) {
      system::Context mean;
      mean.time = s.t();
      mean.averaged = true;
      mean.frequency = s.context().frequency;
      Eigen::Map<Vec3>{v} = f.force([&s](Index n) -> const system::NodeState& { return s.node(n); },
                                    mean, [&s](Index k) { return s.reactions()[k]; });
    };
    out.push_back(std::move(m));
  }
  return out;
}

namespace {
analysis::EquilibriumOptions equilibrium_options(const run::Job& job, int load_steps) {
  analysis::EquilibriumOptions o;
  o.load_steps = load_steps;
  o.chart_change = job.model.chart_change;
  return o;
}

/// The one speed of a step's equilibrium, rad/s; null where there are several.
std::optional<double> speed_of(const model::StepLaw& law) {
  if (const auto* x = std::get_if<model::ModalStep>(&law)) return x->speed;
  if (const auto* x = std::get_if<model::SensitivityStep>(&law)) return x->speed;
  if (const auto* x = std::get_if<model::TorsionalStep>(&law)) return x->max_speed;
  if (const auto* x = std::get_if<model::ApiTorsionalStep>(&law)) return x->operating[1];
  if (const auto* x = std::get_if<model::BucklingStep>(&law)) return x->speed;
  if (const auto* x = std::get_if<model::HarmonicStep>(&law); x && x->frequency) return x->speed;
  return std::nullopt;
}

bool about_undeformed(const model::StepLaw& law) {
  return std::visit(
      [](const auto& x) {
        if constexpr (requires { x.about; })
          return x.about == model::About::undeformed;
        else
          return false;
      },
      law);
}

std::string about_of(const model::StepLaw& law) {
  if (about_undeformed(law)) return "about the undeformed rotor";
  const std::optional<double> speed = speed_of(law);
  const std::string at = speed ? fmt::format("at {:.6g} rpm", to_rpm(*speed)) : "at each speed";
  if (std::holds_alternative<model::BucklingStep>(law))
    return "about the unloaded equilibrium " + at;
  if (std::holds_alternative<model::CriticalMapStep>(law))
    return "about the static equilibrium " + at + " and stiffness";
  return "about the static equilibrium " + at;
}

std::optional<model::MotionKind> motion_asked(const model::StepLaw& law) {
  if (std::holds_alternative<model::TorsionalStep>(law) ||
      std::holds_alternative<model::ApiTorsionalStep>(law))
    return model::MotionKind::torsional;
  return std::visit(
      [](const auto& x) -> std::optional<model::MotionKind> {
        if constexpr (requires { x.motion; })
          return x.motion;
        else
          return std::nullopt;
      },
      law);
}

/// Nothing turns at 0 rpm; of a range, it is the end of a curve along which the rotor turns.
bool stands(const model::StepLaw& law) {
  if (const auto* modal = std::get_if<model::ModalStep>(&law)) return modal->speed == 0;
  if (const auto* s = std::get_if<model::SensitivityStep>(&law)) return s->speed == 0;
  const auto* harmonic = std::get_if<model::HarmonicStep>(&law);
  return harmonic && !harmonic->speeds && harmonic->speed == 0;
}

analysis::SteadyRotation rotation_of(const run::Job& job, const model::StepLaw& law,
                                     double top_speed) {
  analysis::SteadyRotation r = steady_rotation_of(job, top_speed);
  const bool uneven = turns_with_stiffness(job.model) || turns_with_inertia(job.model);
  r.mean = !(uneven && stands(law));  // else principal axes lie where they are
  return r;
}

/// What a kind of motion leaves out.
std::string motion_text(model::MotionKind kind) {
  switch (kind) {
    case model::MotionKind::lateral:
      return "Lateral motion: axial motion and twist follow without inertia or damping.";
    case model::MotionKind::torsional:
      return "Torsional motion: bending and axial motion are held.";
    case model::MotionKind::axial: return "Axial motion: bending and twist are held.";
    case model::MotionKind::all: break;
  }
  return {};
}

std::string_view motion_name(model::MotionKind kind) {
  constexpr std::string_view names[] = {"all", "lateral", "torsional", "axial"};
  return names[static_cast<int>(kind)];
}
}  // namespace

std::vector<std::string> labels_of(std::span<const analysis::WhirlMode> modes) {
  std::map<analysis::ModeKind, int> count;
  std::vector<std::string> out;
  for (const analysis::WhirlMode& m : modes)
    out.push_back(fmt::format("{} {}", to_string(m.kind), ++count[m.kind]));
  return out;
}

std::string direction_text(const analysis::WhirlMode& m) {
  return m.direction == analysis::Direction::none ? std::string()
                                                  : std::string(to_string(m.direction));
}

FrequencyStep::FrequencyStep(run::Job& j, const model::Step& s, const std::string& type,
                             const std::string& title, double top_speed, int load_steps)
    : job((j.build_for(s), j)),  // first: what follows reads what is built
      step(s),
      linear(j.system(), rotation_of(j, s.law, top_speed), equilibrium_options(j, load_steps)),
      top_speed_(top_speed),
      load_steps_(load_steps) {
  if (!s.from.empty()) linear.start_from(j.states.at(s.from).state);
  if (about_undeformed(s.law)) linear.stay_undeformed();
  type_ = type;
  about_ = about_of(s.law);
  summary()["type"] = type;
  summary()["linearised"] = about_;
  if (const auto motion = motion_asked(s.law))
    summary()["motion"] = std::string(motion_name(*motion));
  section.title = fmt::format("{}: {}", s.name, title);
}

analysis::Linearizer FrequencyStep::linearizer_of(const system::System& other) const {
  analysis::Linearizer out(other, rotation_of(job, step.law, top_speed_),
                           equilibrium_options(job, load_steps_));
  if (about_undeformed(step.law)) out.stay_undeformed();
  return out;
}

analysis::Linearizer turned_back(FrequencyStep& s) {
  analysis::SteadyRotation running = s.linear.running().running();
  for (double& ratio : running.ratio)
    ratio = -ratio;
  analysis::Linearizer out(s.linear.system(), running, equilibrium_options(s.job, 1));
  if (about_undeformed(s.step.law)) out.stay_undeformed();
  return out;
}

analysis::Motion FrequencyStep::motion() const {
  const auto asked = motion_asked(step.law);
  return asked ? motion_of(*asked) : analysis::Motion::all;
}

std::string FrequencyStep::file(const std::string& name) const {
  return safe_stem(step.name + "_" + name);
}

void FrequencyStep::add_table(const std::string& name, io::Table table, bool shown) {
  const std::string path = file(name) + ".csv";
  job.folder.write_table(path, table);
  section.files.emplace_back(table.title.empty() ? name : table.title, path);
  if (!shown) return;
  if (!table.title.empty()) table.title += ", " + about_ + (claim_.empty() ? "" : "; " + claim_);
  section.tables.push_back(std::move(table));
}

void FrequencyStep::add_figure(plot::Figure f) {
  if (job.model.output.report) section.figures.push_back(std::move(f));
}

std::string capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string stability_text(const analysis::SpectrumCertificate& c) {
  if (c.axis && c.axis->certain())
    return "no motion grows: growing roots counted along the imaginary axis, none there";
  if (c.stability_certain() && c.quiet_ratio == 0.0)
    return fmt::format("no motion grows at any frequency: all roots counted, none above {:.5g} Hz",
                       to_hz(c.list.radius));
  if (c.stability_certain())
    return fmt::format(
        "no motion grows at any frequency: all roots up to {:.5g} Hz counted, above it energy "
        "forbids growth by more than {:.0e} of the frequency",
        to_hz(c.list.radius), c.quiet_ratio);
  if (c.complete() && c.by_frequency)
    return fmt::format(
        "no motion grows while it oscillates at {:.3g} to {:.5g} Hz; beyond, growth is not "
        "excluded",
        to_hz(c.by_frequency->low), to_hz(c.list.radius));
  if (c.complete())
    return fmt::format(
        "no motion grows below {:.5g} Hz; above it growth is not excluded (forces without damping "
        "of their own act across the modes)",
        to_hz(c.list.radius));
  return "no growing motion found; that there is none is not certified";
}

io::Table real_root_table(const std::vector<analysis::WhirlMode>& modes) {
  io::Table t;
  t.title =
      "Motions that do not oscillate, or hardly (damping ratio above 0.949); of those that decay "
      "fastest "
      "some may be missing";
  t.columns = {{"rate", "1/s", "of exp(rate t); positive: grows"},
               {"frequency", "Hz", "of what is left of an oscillation"},
               {"damping ratio", "-", ""},
               {"time", "s", "to 1/e, or to e"},
               {"kind", "-", "by the largest share of energy"},
               {"motion", "-", "decays, free (neither resisted nor driven), diverges"}};
  for (const analysis::WhirlMode& m : modes) {
    if (m.oscillates()) continue;
    const double rate = m.growth() == 0 ? 0.0 : m.lambda.real();
    const char* word = m.growth() > 0 ? "diverges" : m.growth() < 0 ? "decays" : "free";
    io::Table::Cell time = std::string();
    if (rate != 0.0) time = 1.0 / std::abs(rate);
    t.add({rate, to_hz(m.frequency), tidy(m.damping_ratio), std::move(time),
           std::string(to_string(m.kind)), std::string(word)});
  }
  return t;
}

void FrequencyStep::assume(const std::string& said) {
  summary()["assumed"].push(said);
  section.text += (section.text.empty() ? "" : "\n\n") + capital(said) + ".\n\n";
  if (!job.options.quiet) say(fmt::format("  {}: assumed: {}\n", step.name, said));
}

void FrequencyStep::certify(const analysis::SpectrumCertificate& c, const std::string& where) {
  io::Value& v = summary()["certificate"];
  if (v.is_null()) v = io::Value::array();
  io::Value e = io::Value::object();
  if (!where.empty()) e["at"] = where;
  e["complete"] = c.complete();
  e["text"] = c.text();
  if (c.open.empty()) {
    e["up to [Hz]"] = to_hz(c.list.radius);
    e["damping ratio up to"] = c.list.damping_ratio();
    e["roots not found"] = static_cast<int>(c.list.missing);
    e["factorizations"] = static_cast<int>(c.list.factorizations);
  }
  if (!std::isnan(c.quiet_above)) {
    e["nothing grows above [Hz]"] = to_hz(c.quiet_above);
    e["by more than, of its frequency"] = c.quiet_ratio;
  }
  if (c.axis) {
    e["growing roots counted"] = c.axis->counted;
    e["growing roots not found"] = static_cast<int>(c.axis->unknown);
    e["tables end at [Hz]"] = to_hz(c.axis->top);
    e["tables held beyond their ends"] = c.axis->held_beyond;
    e["factorizations"] = static_cast<int>(c.axis->factorizations);
  }
  v.push(std::move(e));
  if (c.complete() || (!c.open.empty() && !c.unsettled && !c.contradicted())) return;
  const std::string message =
      fmt::format("step '{}'{}{}: {}", step.name, where.empty() ? "" : " ", where, c.text());
  job.uncertified.push_back(message);
  Diagnostic w;
  w.severity = Diagnostic::Severity::warning;
  w.code = "W07";
  w.message = message;
  w.hint =
      "ask for more or fewer modes, or for another max_frequency; the list is not to be relied on "
      "as it is";
  job.report.warnings.push_back(message);
  job.summary["warnings"].push(w.code + ": " + message);
  if (!job.options.quiet) run::print_diagnostics({w});
}

std::string equilibrium_at(double Omega) {
  return fmt::format("the equilibrium at {:.6g} rpm", to_rpm(Omega));
}

void FrequencyStep::say_unloaded_pads(const system::State& still) {
  const auto tilts = [](const model::Bearing& b) {
    return std::holds_alternative<model::TiltingPadJournal>(b.law);
  };
  if (std::none_of(job.model.bearings.begin(), job.model.bearings.end(), tilts)) return;
  run::StepState state;
  state.state = still;
  state.speed = linear.Omega();
  const std::vector<std::string> unloaded = unloaded_pads(calc_support_coefficients(job, state));
  if (unloaded.empty()) return;
  io::Value& list = summary()["unloaded pads"];
  const bool listed = !list.is_null();  // of every speed
  for (const std::string& said : unloaded) {
    if (!listed) list.push(said);
    section.text += " " + capital(said) + ".";
    if (!job.options.quiet) say(fmt::format("  {}: {}\n", step.name, said));
  }
}

void FrequencyStep::say_open_gears() {
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const model::Bearing& b = job.model.bearings[i];
    const auto* gears = std::get_if<model::GearPair>(&b.law);
    if (!gears || gears->backlash < 0.0) continue;
    const la::MCK& m = linear.at(linear.Omega());
    const meshes::BearingNodes& at = job.mesh.bearings[i];
    const Index slot = m.K.pattern().slot(at.shaft.node, at.other.node);
    if (slot < 0 || !m.K.block(slot).isZero(0.0)) continue;
    assume(fmt::format(
        "the teeth of '{}' do not touch at the equilibrium, and nothing passes through them: a "
        "torque that drives closes their play",
        b.name));
  }
}

void FrequencyStep::finish(const std::string& line) {
  if (const system::State& still = linear.equilibrium().state; still.q.size() > 0) {
    say_unloaded_pads(still);
    say_open_gears();
    warn_of_short_bearings(job, step.name, still);
    run::warn_of_closed_contacts(job, step, equilibrium_at(linear.Omega()), still);
  }
  const RunTime time = watch_.elapsed();
  run::put_run_time(summary(), time);
  if (const auto motion = motion_asked(step.law); motion && *motion != model::MotionKind::all)
    section.text += " " + motion_text(*motion);
  section.text += fmt::format(" Linearised {}.", about_);
  if (!claim_.empty()) section.text += " " + capital(claim_) + ".";
  warn_of_mean_stiffness();
  say_passing_teeth();
  run::ProgressLine(step.name, job.options.quiet)
      .done(fmt::format("{}{}, {}, {}", line, also_, about_, time.text()));
  say_held(job, step, held_in_step(job, step), section);
  if (job.model.output.report) job.report.sections.push_back(std::move(section));
}

void FrequencyStep::say_passing_teeth() {
  if (type_ == "stability" || stands(step.law)) return;  // which looks at what they do
  std::vector<analysis::PassingParts> parts = passing_parts(job);
  std::erase_if(parts, [](const analysis::PassingParts& p) { return !p.meshes; });
  if (parts.empty()) return;
  assume(
      fmt::format("the stiffness of {} is its mean over a tooth; what the change may make grow, a "
                  "stability step looks for",
                  names_of(parts)));
}

void FrequencyStep::warn_of_mean_stiffness() {
  const bool stiffness = turns_with_stiffness(job.model);
  const bool in_bands = type_ == "stability" && is_judged_in_turning_axes(job.model);
  const bool not_lateral = type_ == "torsional" || type_ == "buckling";
  const bool in_its_axes = type_ == "unbalance_response" && turns_as_one();
  if (in_bands || in_its_axes || not_lateral || stands(step.law)) return;
  if (!stiffness && !turns_with_inertia(job.model)) return;
  const std::string what =
      breathes(job.model)
          ? "the crack enters as the mean of its compliance over a revolution; in truth the rotor "
            "is "
            "softer or stiffer as it turns"
          : fmt::format(
                "the {} of the asymmetric rotor enters as its mean over a revolution; where it "
                "spins its critical speeds are a pair, with instability between them",
                stiffness ? "stiffness" : "inertia");
  Diagnostic d;
  d.code = "W14";
  d.message = fmt::format("step '{}': {}", step.name, what);
  // a shaft geared to others turns at no one speed: what does turn with all of them is a transient
  d.hint = !turns_as_one() ? "a transient turns with the shafts"
           : stiffness
               ? "a stability step finds the band; an unbalance response turns with the shaft"
               : "an unbalance response and a transient turn with the rotor";
  section.text += " " + capital(what) + ".";
  warn(job, std::move(d));
}

namespace {

/// Of a disk whose axis is not the shaft's: its moments across differ with the square of the angle,
/// and products with the axis shift frequencies by their square. A swash of half a degree is none.
bool is_uneven(const model::Disk& d) {
  constexpr double seen = 1e-4;
  if (!d.inertia) {
    const double tilt = std::sin(d.skew);
    return tilt * tilt * std::abs(d.Ip - d.Id) > seen * (d.Ip + 2 * d.Id);
  }
  const Mat3& J = *d.inertia;
  const double across = std::max(std::abs(J(1, 1) - J(2, 2)), std::abs(J(1, 2)));
  const double products = std::max(std::abs(J(0, 1)), std::abs(J(0, 2)));
  return across > 1e-9 * J.trace() || products * products > seen * J.trace() * J.trace();
}

}  // namespace

bool turns_with_inertia(const model::Model& m) {
  const auto turns = [](const model::Shaft& s) { return s.rotating && s.speed_ratio != 0; };
  const auto of_section = [](const model::Section& x) {
    return model::has_unequal_inertia(x, 1e-9);
  };
  if (std::any_of(m.shafts.begin(), m.shafts.end(), [&](const model::Shaft& s) {
        return turns(s) && std::any_of(s.sections.begin(), s.sections.end(), of_section);
      }))
    return true;
  return std::any_of(m.disks.begin(), m.disks.end(), [&](const model::Disk& d) {
    return turns(m.shafts[d.at.shaft]) && is_uneven(d);
  });
}

bool breathes(const model::Model& m) {
  return std::any_of(m.cracks.begin(), m.cracks.end(), [&](const model::Crack& c) {
    const model::Shaft& s = m.shafts[c.at.shaft];
    return s.rotating && s.speed_ratio != 0;
  });
}

bool turns_with_stiffness(const model::Model& m) {
  if (breathes(m)) return true;
  for (const model::Bearing& b : m.bearings)
    if (const auto* coupling = std::get_if<model::Coupling>(&b.law))
      if (model::is_unequal(*coupling, 0) && m.shafts[b.at.shaft].rotating &&
          m.shafts[b.at.shaft].speed_ratio != 0)
        return true;
  for (const model::Shaft& s : m.shafts)
    for (const model::Section& x : s.sections)
      if (s.rotating && s.speed_ratio != 0 &&
          (model::is_unequal(x, 0) || (x.general && x.general->kappa_y != x.general->kappa_z)))
        return true;
  return false;
}

bool is_judged_in_turning_axes(const model::Model& m) {
  if (turns_with_stiffness(m)) return true;
  if (!turns_with_inertia(m)) return false;
  double speed = 0;
  for (const model::Shaft& s : m.shafts) {
    const double own = s.rotating ? s.speed_ratio : 0.0;
    if (own == 0) continue;
    if (speed != 0 && own != speed) return false;
    speed = own;
  }
  return true;
}

std::vector<analysis::PassingParts> passing_parts(const run::Job& job) {
  const model::Model& m = job.model;
  const auto speed = [&](const model::Location& at) {
    const model::Shaft& shaft = m.shafts[at.shaft];
    return shaft.rotating ? shaft.speed_ratio : 0.0;
  };
  std::vector<analysis::PassingParts> out;
  for (std::size_t i = 0; i < m.bearings.size(); ++i) {
    const model::Bearing& b = m.bearings[i];
    const model::SupportTraits law = model::traits_of(b.law);
    if (!law.passing->has_value()) continue;
    const model::Passing passing = **law.passing;
    const double rate =
        std::abs(passing.own * speed(b.at) + (b.to ? passing.other * speed(*b.to) : 0.0));
    if (rate == 0.0) continue;
    auto it = std::find_if(out.begin(), out.end(), [&](const analysis::PassingParts& p) {
      return std::abs(p.rate - rate) < 1e-9 * rate;
    });
    if (it == out.end()) {
      it = out.emplace(out.end());
      it->rate = rate;
    }
    it->meshes = it->meshes || law.pair->has_value();
    it->names.push_back(
        fmt::format("{} '{}'", law.pair->has_value() ? (**law.pair).noun : "bearing", b.name));
    const std::vector<std::size_t>& terms = job.built.support_terms[i];
    it->terms.insert(it->terms.end(), terms.begin(), terms.end());
    it->nodes.push_back({job.mesh.bearings[i].shaft.node, job.mesh.bearings[i].other.node});
  }
  for (analysis::PassingParts& p : out) {
    std::sort(p.terms.begin(), p.terms.end());
    p.terms.erase(std::unique(p.terms.begin(), p.terms.end()), p.terms.end());
  }
  return out;
}

std::string names_of(const std::vector<analysis::PassingParts>& parts) {
  std::string out;
  for (const analysis::PassingParts& p : parts)
    for (const std::string& name : p.names)
      out += (out.empty() ? "" : ", ") + name;
  return out;
}

const char* what_turns(const model::Model& m) {
  return turns_with_stiffness(m) ? "stiffness" : "inertia";
}

}  // namespace whirl::results
