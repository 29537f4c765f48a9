// A stability step: log decrement against speed and the onset speeds of instability, solved for
// directly.
#include <analysis/spectra/stability.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <results/campbell_lines.hpp>
#include <steps/step_kinds.hpp>
#include <steps/stability_map.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

namespace {

/// The speed of which least is known: not counted, then not complete, then not excluded above.
const analysis::SpeedVerdict& weakest(const analysis::StabilityResult& r) {
  const auto grade = [](const analysis::SpeedVerdict& v) {
    return v.certificate.stability_certain() ? 2 : v.certificate.complete() ? 1 : 0;
  };
  return *std::min_element(r.verdicts.begin(), r.verdicts.end(),
                           [&](const auto& a, const auto& b) { return grade(a) < grade(b); });
}

io::Table verdict_table(const analysis::StabilityResult& r) {
  io::Table t;
  t.title = "Verdict at each speed";
  t.columns = {
      {"speed", "rpm", ""},
      {"growing whirl modes", "-", ""},
      {"diverging motions", "-", ""},
      {"fastest growth", "1/s", ""},
      {"neutral whirl modes", "-", "their growth cannot be told from rounding"},
      {"neutral within", "1/s", "bound of that rounding"},
      {"roots counted up to", "Hz", ""},
      {"roots not found", "-", ""},
      {"certified", "-", "all: at all frequencies; band: up to the frequency counted to; no"}};
  for (const analysis::SpeedVerdict& v : r.verdicts) {
    const analysis::SpectrumCertificate& c = v.certificate;
    const char* word = c.stability_certain() ? "all" : c.complete() ? "band" : "no";
    io::Table::Cell top = std::string(), missing = std::string();
    if (c.open.empty()) {
      top = to_hz(c.list.radius);
      missing = static_cast<int>(c.list.missing);
    }
    t.add({to_rpm(v.speed), static_cast<int>(v.whirling), static_cast<int>(v.diverging), v.fastest,
           static_cast<int>(v.neutral), v.neutral_within, std::move(top), std::move(missing),
           std::string(word)});
  }
  return t;
}

std::string growth_text(const analysis::SpeedVerdict& v) {
  return v.diverging > 0 && v.whirling == 0
             ? fmt::format("a motion diverges at {:.4g} 1/s", v.fastest)
             : fmt::format("growth {:.4g} 1/s at {:.5g} Hz", v.fastest, to_hz(v.fastest_at));
}

std::string onset_text(const analysis::Onset& x) {
  const std::string what = x.divergence()
                               ? "diverging without whirl"
                               : fmt::format("whirling at {:.5g} Hz", to_hz(x.frequency));
  if (!x.begins)
    return fmt::format("growth beyond rounding above {:.6g} rpm, {}", to_rpm(x.speed), what);
  return fmt::format("instability above {:.8g} rpm, {}", to_rpm(x.speed), what);
}

/// Nothing grows at the next speed judged, and nothing begins to grow before it.
bool is_stable_after(const analysis::StabilityResult& r, const analysis::Onset& x) {
  const auto next = std::find_if(r.verdicts.begin(), r.verdicts.end(),
                                 [&](const auto& v) { return v.speed > x.speed; });
  if (next == r.verdicts.end()) return false;
  const bool begins = std::any_of(r.onsets.begin(), r.onsets.end(), [&](const auto& o) {
    return o.gains && o.speed > x.speed && o.speed < next->speed;
  });
  return next->stable() && !begins;
}

/// "stable from .. to .. rpm", "instability above ..". Stable is what is certified only.
std::string finding(const analysis::StabilityResult& r) {
  const analysis::SpeedVerdict &first = r.verdicts.front(), &last = r.verdicts.back();
  if (const auto seen = r.unannounced())
    return fmt::format("unstable at {:.6g} rpm (growth {:.4g} 1/s): where that begins is not known",
                       to_rpm(seen->speed), seen->growth);
  std::string line;
  if (!r.stable_at_start)
    line =
        fmt::format("unstable at {:.6g} rpm already ({})", to_rpm(first.speed), growth_text(first));
  bool grows = !r.stable_at_start, told = false;
  for (const analysis::Onset& x : r.onsets) {
    if (x.gains && told && !grows)
      return line + fmt::format(", unstable again above {:.8g} rpm", to_rpm(x.speed));
    if (x.gains && !told) {
      line += (line.empty() ? "" : "; ") + onset_text(x);
      told = grows = true;
    } else if (grows && is_stable_after(r, x)) {
      line += fmt::format(", stable again above {:.8g} rpm", to_rpm(x.speed));
      grows = false;
    }
  }
  if (!line.empty()) return line;
  return fmt::format("{} from {:.6g} to {:.6g} rpm", r.certain() ? "stable" : "no growth found",
                     to_rpm(first.speed), to_rpm(last.speed));
}

/// What was found, and on what authority.
std::string verdict_line(const analysis::StabilityResult& r) {
  const bool doubted =
      std::any_of(r.verdicts.begin(), r.verdicts.end(), [](const analysis::SpeedVerdict& v) {
        return v.certificate.contradicted() && v.certificate.axis->unknown < 0 && !v.stable();
      });
  const std::string line = (doubted ? "growth in doubt: " : "") + finding(r);
  const analysis::SpectrumCertificate& c = weakest(r).certificate;
  if (r.certain() && c.axis)
    return line +
           fmt::format(" (certified at {} speeds: growing roots counted along the imaginary axis)",
                       r.verdicts.size());
  if (r.certain() && r.growth_left() > 1e-8)
    return line + fmt::format(" (certified at {} speeds, but growth below {:.0e} of its frequency)",
                              r.verdicts.size(), r.growth_left());
  const bool cut = std::any_of(r.verdicts.begin(), r.verdicts.end(),
                               [](const auto& v) { return v.certificate.cut(); });
  if (r.certain())
    return line + fmt::format(" (certified at {} speeds: all roots {}accounted for)",
                              r.verdicts.size(), cut ? "that grow or decay slowly " : "");
  if (r.complete())
    return line + fmt::format(" (certified up to {:.5g} Hz; above it growth is not excluded)",
                              to_hz(c.list.radius));
  return line + " (not certified: " + c.text() + ")";
}

/// Modes that neither grow nor decay, as far as can be told.
std::string neutral_text(const analysis::StabilityResult& r) {
  const auto most =
      std::max_element(r.verdicts.begin(), r.verdicts.end(), [](const auto& a, const auto& b) {
        return a.neutral < b.neutral ||
               (a.neutral == b.neutral && a.neutral_within < b.neutral_within);
      });
  if (most->neutral == 0) return {};
  return fmt::format(
      " {} mode{} at {:.6g} rpm neutral within {:.2g} 1/s, the rounding of the matrices.",
      most->neutral, most->neutral == 1 ? " is" : "s are", to_rpm(most->speed),
      most->neutral_within);
}

/// Of the modes judged, at the highest speed.
void report_mesh(results::FrequencyStep& s, int modes, double Omega) {
  analysis::ModesOptions o;
  o.count = modes;
  o.certify = false;
  results::MeshAccuracy accuracy(s);
  accuracy.look_at(analysis::whirl_modes(s.linear, Omega, o), Omega);
  accuracy.report();
}

std::string beyond_text(const analysis::Onset& x) {
  if (!x.begins) return x.gains ? "grows beyond rounding" : "within rounding again";
  if (x.divergence()) return x.gains ? "diverges" : "no longer diverges";
  return x.gains ? "unstable" : "stable again";
}

void add_onsets(results::FrequencyStep& s, const analysis::StabilityResult& r) {
  io::Table table;
  table.title = "Onset of instability";
  table.nan_means = "stands among the verdicts";
  table.columns = {{"speed", "rpm", ""},           {"whirl frequency", "Hz", ""},
                   {"frequency / speed", "-", ""}, {"kind", "-", ""},
                   {"direction", "-", ""},         {"above this speed", "-", ""}};
  io::Value& list = s.summary()["onsets"];
  list = io::Value::array();
  // what grows without an onset found stands in its place among the others
  std::vector<analysis::Unplaced> unknown = r.unplaced;
  std::sort(unknown.begin(), unknown.end(),
            [](const auto& a, const auto& b) { return a.speed < b.speed; });
  std::size_t next = 0;
  const auto add_unplaced_below = [&](double speed) {
    for (; next < unknown.size() && unknown[next].speed < speed; ++next) {
      const analysis::Unplaced& u = unknown[next];
      table.add({to_rpm(u.speed), to_hz(u.frequency), u.frequency / u.speed, std::string(),
                 std::string(), "unstable there; where that begins below is not known"});
    }
  };
  for (const analysis::Onset& x : r.onsets) {
    add_unplaced_below(x.speed);
    table.add({to_rpm(x.speed), to_hz(x.frequency), x.ratio(), std::string(to_string(x.mode.kind)),
               results::direction_text(x.mode), beyond_text(x)});
    io::Value e = io::Value::object();
    e["speed [rpm]"] = to_rpm(x.speed);
    e["whirl frequency [Hz]"] = to_hz(x.frequency);
    e["becomes unstable"] = x.gains;
    e["divergence"] = x.divergence();
    e["growth begins there"] = x.begins;
    list.push(std::move(e));
  }
  add_unplaced_below(infinity);
  s.add_table("onset", std::move(table));
  io::Value& unplaced = s.summary()["growth of unknown onset"];
  unplaced = io::Value::array();
  for (const analysis::Unplaced& u : r.unplaced) {
    io::Value e = io::Value::object();
    e["seen at [rpm]"] = to_rpm(u.speed);
    e["whirl frequency [Hz]"] = to_hz(u.frequency);
    e["growth [1/s]"] = u.growth;
    unplaced.push(std::move(e));
  }
}

void add_rates(results::FrequencyStep& s, const analysis::StabilityResult& r,
               const std::vector<plot::CampbellLine>& lines) {
  io::Table rates;
  rates.title = "Log decrement against speed";
  rates.nan_means = "the mode is not there at this speed";
  rates.nan_is_absence = true;
  rates.columns.push_back({"speed", "rpm", ""});
  for (const plot::CampbellLine& l : lines) {
    rates.columns.push_back({l.label + " log decrement", "-", ""});
    rates.columns.push_back({l.label + " damping ratio", "-", ""});
    rates.columns.push_back({l.label + " frequency", "Hz", ""});
  }
  for (std::size_t k = 0; k < r.diagram.speeds.size(); ++k) {
    std::vector<io::Table::Cell> row{to_rpm(r.diagram.speeds[k])};
    for (const analysis::CampbellLine& l : r.diagram.lines) {
      row.emplace_back(l.log_decrement[k]);
      row.emplace_back(l.damping_ratio[k]);
      row.emplace_back(to_hz(l.frequency[k]));
    }
    rates.add(std::move(row));
  }
  s.add_table("log_decrement", std::move(rates), false);
}

void add_figures(results::FrequencyStep& s, const analysis::StabilityResult& r,
                 const std::vector<plot::CampbellLine>& lines) {
  std::vector<double> thresholds;
  for (const analysis::Onset& x : r.onsets)
    thresholds.push_back(x.speed);
  s.add_figure(plot::plot_stability(s.file("log_decrement"), "Log decrement of the modes", lines,
                                    thresholds));
  s.add_figure(plot::plot_campbell(s.file("frequencies"), "Frequencies of these modes", lines,
                                   std::vector<double>{1.0}, {}));
  constexpr std::size_t most = model::StabilityStep::most_onset_shapes;
  for (std::size_t k = 0; k < std::min(most, r.onsets.size()); ++k) {
    const analysis::Onset& x = r.onsets[k];
    const std::string name = fmt::format("onset_{}", k + 1);
    s.linear.at(x.speed);
    results::add_shape_figures(
        s, {name,
            fmt::format("Mode at the onset, {:.6g} rpm, {:.5g} Hz, {}", to_rpm(x.speed),
                        to_hz(x.frequency), results::description(x.mode)),
            {},
            &x.mode.x,
            x.mode.kind});
    results::write_shape_frames(s, name, x.mode.x);
  }
}

/// "motions at 906.5 and 906.5 Hz grow by about 383 1/s at 2719.6 rpm, where teeth of gear pair 'mesh' pass at
/// their sum, 1813 Hz"
std::string text_of(const analysis::PassingGrowth& g, const analysis::PassingParts& cause) {
  const std::string sum = g.multiple == 1
                              ? fmt::format("their sum, {:.4g} Hz", to_hz(g.first + g.second))
                              : fmt::format("{:.4g} Hz, of which their sum is {} times",
                                            to_hz(g.first + g.second) / g.multiple, g.multiple);
  return fmt::format(
      "motions at {:.4g} and {:.4g} Hz grow by about {:.3g} 1/s at {:.6g} rpm, where {} of {} pass "
      "at {}",
      to_hz(g.first), to_hz(g.second), g.growth, to_rpm(g.speed),
      cause.meshes ? "teeth" : "rolling elements", results::names_of({cause}), sum);
}

/// The verdict on a machine whose mean stiffness has the verdict `line`, with what parts of varying stiffness
/// make grow as they pass, to first order; W14 where something does.
std::string with_passing_parts(results::FrequencyStep& s, const std::string& line,
                               const std::vector<analysis::PassingParts>& parts,
                               const analysis::Campbell& diagram) {
  const std::string of_the_mean =
      fmt::format("{}, of the mean stiffness of {}", line, results::names_of(parts));
  const analysis::PassingOptions options;
  std::vector<analysis::PassingGrowth> found;
  io::Value& v = s.summary()["growth by what passes"];
  analysis::Linearizer linear(s.linear);
  try {
    found = analysis::find_passing_growth(linear, parts, diagram, options);
  } catch (const Error& e) {
    v = "not known: " + e.diagnostics().front().message;
    return of_the_mean + "; growth by what passes in them is not excluded";
  }
  v = io::Value::array();
  for (const analysis::PassingGrowth& g : found) {
    io::Value row;
    row["of"] = results::names_of({parts[g.parts]});
    row["speed [rpm]"] = to_rpm(g.speed);
    row["growth [1/s]"] = g.growth;
    row["first frequency [Hz]"] = to_hz(g.first);
    row["second frequency [Hz]"] = to_hz(g.second);
    row["multiple"] = g.multiple;
    v.push(std::move(row));
  }
  if (found.empty())
    return fmt::format(
        "{}; to first order nothing grows by what passes in them ({} slowest motions, {} "
        "multiples)",
        of_the_mean, options.modes, options.multiples);
  const std::string grows = text_of(found.front(), parts[found.front().parts]);
  Diagnostic d;
  d.code = "W14";
  d.message = fmt::format(
      "step '{}': {} (to first order in the change of stiffness){}", s.step.name, grows,
      found.size() > 1 ? fmt::format(", and {} more such pairs", found.size() - 1) : "");
  d.hint = "a transient shows what becomes of it";
  results::warn(s.job, std::move(d));
  return grows + "; " + of_the_mean;
}

/// What a table says at a row of its own no speed beside it tells. Two rows or speeds nearer than that are one.
std::vector<double> with_table_speeds(const run::Job& job, std::vector<double> speeds) {
  const bool ascends = speeds.front() <= speeds.back();
  const double least = std::min(speeds.front(), speeds.back());
  const double most = std::max(speeds.front(), speeds.back());
  const double close = 1e-6 * std::max(std::abs(least), std::abs(most));
  for (const double row : results::table_speeds_between(job, least, most))
    if (std::none_of(speeds.begin(), speeds.end(),
                     [&](double x) { return std::abs(x - row) <= close; }))
      speeds.push_back(row);
  std::sort(speeds.begin(), speeds.end());
  if (!ascends) std::reverse(speeds.begin(), speeds.end());
  return speeds;
}

}  // namespace

void run_stability_step(run::Job& job, const model::Step& step, const model::StabilityStep& law) {
  if (results::is_judged_in_turning_axes(job.model)) return run_instability_bands(job, step, law);
  analysis::StabilityOptions o;
  o.speeds = with_table_speeds(job, results::speeds_of(law.speed));
  const std::vector<double>& speeds = o.speeds;
  results::FrequencyStep s(job, step, "stability", "stability",
                           std::max(std::abs(speeds.front()), std::abs(speeds.back())));
  o.modes = law.modes;
  o.all = true;
  o.threads = job.options.jobs;
  const std::vector<analysis::PassingParts> passing = results::passing_parts(job);
  o.shapes = !passing.empty();
  const run::PhaseTimer timer(job, "stability");
  const analysis::StabilityResult r = analysis::find_instability(s.linear, o);

  io::Value& v = s.summary();
  const bool unknown = r.stable_at_start && !r.verdicts.front().certificate.stability_certain();
  v["stable at the first speed"] = unknown ? io::Value() : io::Value(r.stable_at_start);
  v["certified"] = r.certain() && !results::turns_with_inertia(job.model) && passing.empty();
  v["list complete"] = r.complete();
  const analysis::SpeedVerdict& judged = weakest(r);
  s.certify(judged.certificate, fmt::format("at {:.6g} rpm", to_rpm(judged.speed)));
  report_mesh(s, law.modes, speeds.back());
  results::warn_of_tables(job, step.name, speeds.front(), speeds.back());
  s.add_table("verdicts", verdict_table(r), false);
  const std::vector<plot::CampbellLine> lines = results::drawn_lines(r.diagram);
  add_onsets(s, r);
  add_rates(s, r, lines);
  add_figures(s, r, lines);
  std::string line = verdict_line(r);
  if (results::turns_with_inertia(job.model))
    line += "; of the mean inertia over a revolution: growth in bands of speed is not excluded";
  if (!passing.empty()) line = with_passing_parts(s, line, passing, r.diagram);
  if (law.map) line += add_stability_map(s, *law.map, o);
  s.section.text = results::capital(line) + "." + neutral_text(r);
  const std::string moments = results::moments_along_shafts(job.model);
  const bool grows =
      std::any_of(r.verdicts.begin(), r.verdicts.end(), [](const auto& x) { return !x.stable(); });
  if (grows && !moments.empty()) s.assume(moments);
  s.finish(line);
}

}  // namespace whirl::steps
