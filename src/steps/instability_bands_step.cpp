// A stability step of a rotor whose shaft has unequal principal stiffnesses: bands of parametric
// instability.
#include <analysis/spectra/instability_bands.hpp>
#include <results/frequency.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>
#include <steps/stability_map.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace whirl::steps {

Error no_map_of_bands(const model::Step& step) {
  return run_error("E89",
                   fmt::format("step '{}': a map over a parameter is not drawn for asymmetric "
                               "or cracked shafts, whose instabilities are bands",
                               step.name),
                   "leave 'map' out, or give the shaft equal stiffnesses", step.name);
}

namespace {

using analysis::BandResult;
using analysis::InstabilityBand;

/// -1: the rotor runs backwards.
double sense_of(const std::vector<double>& speeds) { return speeds.back() > 0.0 ? 1.0 : -1.0; }

BandResult solve_bands(const model::StabilityStep& law, analysis::RotatingAxes& axes,
                       const std::vector<double>& speeds, run::ProgressLine& line) {
  analysis::BandOptions o;
  o.modes = law.modes;
  o.sense = sense_of(speeds);
  o.progress = [&](double share, double Omega) {
    line.update(share, share < 1.0 ? fmt::format("{:.5g} rpm", to_rpm(Omega))
                                   : fmt::format("band about {:.5g} rpm", to_rpm(Omega)));
  };
  for (const double Omega : speeds)
    o.speeds.push_back(std::abs(Omega));
  std::sort(o.speeds.begin(), o.speeds.end());
  return analysis::find_bands(axes, o);
}

/// What the cut of Hill's determinant does to growth rates.
struct Truncation {
  int harmonics = 0, speeds = 0;
  double change = 0;   ///< 1/s, with two harmonics more, the largest
  double allowed = 0;  ///< 1/s, what says nothing
  double cut = 0;      ///< largest share of the last harmonic in a motion
  bool settled() const {
    constexpr double little = 0.3;  // rates feel its square
    return change <= allowed && cut <= little;
  }
};

struct SpeedAndGrowth {
  double speed = 0, growth = 0;  ///< rad/s, 1/s
};

/// Where the growth is largest: of each band, nine at most, and of all speeds; and where most is cut.
std::vector<SpeedAndGrowth> telling_speeds(const BandResult& r) {
  std::vector<InstabilityBand> bands = r.bands;
  std::sort(bands.begin(), bands.end(),
            [](const InstabilityBand& a, const InstabilityBand& b) { return a.growth > b.growth; });
  std::vector<SpeedAndGrowth> out;
  for (std::size_t k = 0; k < std::min<std::size_t>(bands.size(), 9); ++k)
    out.push_back({bands[k].speed, bands[k].growth});
  const auto add_largest = [&](const std::vector<double>& of) {
    const auto k = static_cast<std::size_t>(std::max_element(of.begin(), of.end()) - of.begin());
    const bool there = std::any_of(out.begin(), out.end(),
                                   [&](const SpeedAndGrowth& s) { return s.speed == r.speeds[k]; });
    if (!there) out.push_back({r.speeds[k], r.growth[k]});
  };
  add_largest(r.growth);
  add_largest(r.cut);
  return out;
}

Truncation find_truncation(results::FrequencyStep& s, const model::StabilityStep& law,
                           const BandResult& r, double sense, const analysis::RotatingAxes& axes) {
  Truncation t;
  t.harmonics = static_cast<int>(axes.harmonics());
  t.cut = *std::max_element(r.cut.begin(), r.cut.end());
  constexpr Index more = 2;
  const Index finer_harmonics = axes.harmonics() + more;
  analysis::RotatingAxes finer(s.linear, sense * r.speeds.back(),
                               {.least = finer_harmonics, .most = finer_harmonics});
  for (const SpeedAndGrowth& own : telling_speeds(r)) {
    const double other =
        analysis::largest_growth(finer, sense * own.speed, r.speeds.back(), law.modes);
    ++t.speeds;
    t.change = std::max(t.change, std::abs(own.growth - other));
  }
  return t;
}

struct Solved {
  std::unique_ptr<analysis::RotatingAxes> axes;
  BandResult bands;
  Truncation cut;
};

/// Bands with as many harmonics as it takes: motions that the last ones should have joined, but are
/// copies without them, grow where nothing does.
Solved solve_with_enough_harmonics(results::FrequencyStep& s, const model::StabilityStep& law,
                                   const std::vector<double>& speeds, run::ProgressLine& line) {
  constexpr Index first = 3, most = 11, more = 2;
  constexpr double accuracy = 0.02;  // of the largest growth
  double slowest = infinity;
  for (const double Omega : speeds)
    if (Omega != 0.0) slowest = std::min(slowest, std::abs(Omega));
  Solved out;
  Index least = 1;
  for (Index harmonics = first;; harmonics += more) {
    out.axes = std::make_unique<analysis::RotatingAxes>(
        s.linear, speeds.back(),
        analysis::Harmonics{.least = least, .most = harmonics, .slowest = slowest});
    out.bands = solve_bands(law, *out.axes, speeds, line);
    if (out.axes->constant()) return out;
    out.cut = find_truncation(s, law, out.bands, sense_of(speeds), *out.axes);
    const double nothing =
        analysis::unnoticed_share(*out.axes) * std::abs(out.axes->speed(out.bands.speeds.back()));
    double growth = 0.0;
    for (const InstabilityBand& b : out.bands.bands)
      growth = std::max(growth, b.growth);
    out.cut.allowed = std::max(nothing, accuracy * growth);
    if (out.cut.settled() || harmonics >= most) return out;
    least = harmonics + more;
  }
}

/// "unstable from 2000 to 2100 rpm, 4000 to above 6000 rpm"
std::string text_of(const BandResult& r) {
  if (r.bands.empty())
    return fmt::format("no growth found from {:.6g} to {:.6g} rpm", to_rpm(r.speeds.front()),
                       to_rpm(r.speeds.back()));
  std::string text;
  for (const InstabilityBand& b : r.bands)
    text += fmt::format("{}{} to {} rpm", text.empty() ? "unstable from " : ", ",
                        std::isnan(b.low) ? fmt::format("below {:.6g}", to_rpm(r.speeds.front()))
                                          : fmt::format("{:.8g}", to_rpm(b.low)),
                        std::isnan(b.high) ? fmt::format("above {:.6g}", to_rpm(r.speeds.back()))
                                           : fmt::format("{:.8g}", to_rpm(b.high)));
  return text;
}

/// All speeds as they are.
void turn_back(BandResult& r, double sense) {
  for (double& x : r.speeds)
    x *= sense;
  for (InstabilityBand& b : r.bands) {
    b.low *= sense;
    b.high *= sense;
    b.speed *= sense;
  }
}

/// What is known of the motions at the speeds looked at.
std::string counts_of(const BandResult& r) {
  const std::string between =
      r.sought_between ? ""
                       : "; bands between them are not looked for: a table of frequencies ends";
  if (r.complete())
    return fmt::format(
        "certified at {} speeds: roots counted up to {:.5g} Hz in axes that turn with the rotor{}",
        r.counted, to_hz(r.counted_to), between);
  return fmt::format(
      "not certified: at {} of {} speeds eigenvalues were searched for, not counted{}", r.uncounted,
      r.counted + r.uncounted, between);
}

void add_band_table(results::FrequencyStep& s, const BandResult& r) {
  io::Table table;
  table.title = "Bands of instability";
  table.nan_means = "the band goes on beyond the speeds";
  table.columns = {{"from", "rpm", ""},
                   {"to", "rpm", ""},
                   {"largest growth", "1/s", "real part of the eigenvalue"},
                   {"at", "rpm", ""},
                   {"frequency there", "Hz",
                    "in axes turning with the rotor; 0: the rotor bends out at its own speed"}};
  io::Value& list = s.summary()["bands"];
  list = io::Value::array();
  for (const InstabilityBand& b : r.bands) {
    table.add({to_rpm(b.low), to_rpm(b.high), b.growth, to_rpm(b.speed),
               to_hz(results::tidy(b.frequency))});
    io::Value e = io::Value::object();
    e["from [rpm]"] = to_rpm(b.low);
    e["to [rpm]"] = to_rpm(b.high);
    e["largest growth [1/s]"] = b.growth;
    e["at [rpm]"] = to_rpm(b.speed);
    list.push(std::move(e));
  }
  s.add_table("bands", std::move(table));
}

void add_growth_table(results::FrequencyStep& s, const BandResult& r) {
  io::Table rates;
  rates.title = "Largest growth rate against speed";
  rates.columns = {
      {"speed", "rpm", ""},
      {"growth", "1/s", "largest real part of the eigenvalues; negative: all motions decay"},
      {"frequency", "Hz", "of that motion, in axes turning with the rotor"}};
  for (std::size_t k = 0; k < r.speeds.size(); ++k)
    rates.add(
        {to_rpm(r.speeds[k]), results::tidy(r.growth[k]), to_hz(results::tidy(r.frequency[k]))});
  s.add_table("growth", std::move(rates), false);
}

/// The edges of the bands belong to it: growth zero there.
plot::Series growth_curve(const BandResult& r) {
  struct Point {
    double speed, growth, frequency;
  };
  std::vector<Point> points;
  for (std::size_t k = 0; k < r.speeds.size(); ++k)
    points.push_back({r.speeds[k], r.growth[k], r.frequency[k]});
  for (const InstabilityBand& b : r.bands) {
    points.push_back({b.speed, b.growth, b.frequency});
    for (const double x : {b.low, b.high})
      if (!std::isnan(x)) points.push_back({x, 0.0, nan});
  }
  std::sort(points.begin(), points.end(),
            [](const Point& x, const Point& y) { return x.speed < y.speed; });
  plot::Series curve;
  curve.label = "largest growth rate";
  curve.style = {0, plot::Dash::solid, 1.8};
  plot::Extra hertz{"frequency in rotating axes", "Hz", {}};
  for (const Point& p : points) {
    curve.x.push_back(to_rpm(p.speed));
    curve.y.push_back(p.growth);
    hertz.values.push_back(to_hz(p.frequency));
  }
  curve.extra.push_back(std::move(hertz));
  return curve;
}

void add_growth_figure(results::FrequencyStep& s, const BandResult& r) {
  double top = 0, bottom = 0;
  for (const double growth : r.growth)
    bottom = std::min(bottom, growth);
  for (const InstabilityBand& b : r.bands)
    top = std::max(top, b.growth);
  plot::Axes a;
  a.x = plot::Axis("speed", "rpm");
  a.y = plot::Axis("largest growth rate (unstable above 0)", "1/s");
  a.y.include_zero = true;
  a.y.max = top > 0 ? 1.15 * top : nan;
  for (const InstabilityBand& b : r.bands) {
    const double from = to_rpm(std::isnan(b.low) ? r.speeds.front() : b.low),
                 to = to_rpm(std::isnan(b.high) ? r.speeds.back() : b.high);
    plot::Patch p;
    p.x = {from, to, to, from};
    p.y = {bottom, bottom, 1.15 * top, 1.15 * top};
    p.style = {1, plot::Dash::solid, 0.0};
    p.tooltip = fmt::format("unstable from {:.6g} to {:.6g} rpm", from, to);
    if (&b == &r.bands.front()) p.label = "instability";
    a.patches.push_back(std::move(p));
  }
  a.series.push_back(growth_curve(r));
  a.rules.push_back({false, 0, "", {plot::ink, plot::Dash::solid, 1.0}});
  plot::Figure f;
  f.name = s.file("growth");
  f.title = "Growth rate of the least stable motion";
  f.caption = "Shaded: instability. Eigenvalues in axes that turn with the rotor.";
  f.axes.push_back(std::move(a));
  s.add_figure(std::move(f));
}

}  // namespace

void run_instability_bands(run::Job& job, const model::Step& step,
                           const model::StabilityStep& law) {
  const std::vector<double> speeds = results::speeds_of(law.speed);
  results::FrequencyStep s(job, step, "stability",
                           fmt::format("instability bands of the rotor, whose {} turns with it",
                                       results::what_turns(job.model)),
                           std::max(std::abs(speeds.front()), std::abs(speeds.back())));
  const run::PhaseTimer timer(job, "stability");
  if (law.map) throw no_map_of_bands(step);
  if (speeds.front() < 0.0 && speeds.back() > 0.0)
    throw run_error("E88",
                    fmt::format("step '{}': speeds of both senses of rotation, and bands of "
                                "instability of an asymmetric or cracked shaft in each",
                                step.name),
                    "write two steps, one of negative speeds", step.name);
  const bool cracked = results::breathes(job.model);
  run::ProgressLine progress(step.name, job.options.quiet);
  Solved solved = solve_with_enough_harmonics(s, law, speeds, progress);
  turn_back(solved.bands, sense_of(speeds));
  const analysis::RotatingAxes& axes = *solved.axes;
  const BandResult& r = solved.bands;
  if (!cracked) s.summary()["supports"] = axes.constant() ? "isotropic" : "unequal";
  add_band_table(s, r);
  add_growth_table(s, r);
  add_growth_figure(s, r);
  const std::string line = text_of(r);
  const std::string why =
      axes.constant()
          ? "The supports are isotropic: in axes turning with the rotor its matrices are constant."
          : fmt::format("{}: Hill's equations with {} harmonics.",
                        cracked ? "The crack opens and closes with the weight and with what bends "
                                  "the shaft in the mean, not with its vibration"
                                : "Neither the rotor nor its supports are isotropic",
                        axes.harmonics());
  std::string known = counts_of(r);
  if (const auto passing = results::passing_parts(job); !passing.empty())
    known +=
        fmt::format("; of the mean stiffness of {}: growth by what passes in them is not excluded",
                    results::names_of(passing));
  std::string in_short = known;
  known += fmt::format(
      "; bands narrower than the distance of the speeds are found at critical speeds and halfway "
      "between two bands only; growth "
      "below {:.0e} of the speed is taken for none",
      analysis::unnoticed_share(axes));
  if (!axes.constant()) {
    const Truncation& cut = solved.cut;
    known +=
        cut.change > 0.0
            ? fmt::format(
                  "; Hill's determinant is cut after {} harmonics: with {} the growth rates at "
                  "{} speed{} of largest growth change by {:.1g} 1/s",
                  cut.harmonics, cut.harmonics + 2, cut.speeds, cut.speeds == 1 ? "" : "s",
                  cut.change)
            : fmt::format(
                  "; Hill's determinant is cut after {} harmonics: more join motions by "
                  "less than 1e-6 of the speed",
                  cut.harmonics);
    if (!cut.settled()) {
      const std::string open = fmt::format(
          "growth rates have not settled with these harmonics (the last one is {:.2g} of a "
          "motion): "
          "growth is not excluded",
          cut.cut);
      known += "; " + open;
      in_short = open + "; " + in_short;
    }
    in_short += fmt::format("; Hill with {} harmonics, ", cut.harmonics) +
                (cut.change > 0.0 ? fmt::format("growth right to {:.1g} 1/s", cut.change)
                                  : "more join motions by less than 1e-6 of the speed");
    io::Value& v = s.summary()["certificate"];
    v["harmonics"] = cut.harmonics;
    v["change of growth with two more [1/s]"] = cut.change;
  }
  const bool complete = r.complete() && (axes.constant() || solved.cut.settled());
  s.summary()["certificate"]["complete"] = complete;
  if (r.complete()) s.summary()["certificate"]["up to [Hz]"] = to_hz(r.counted_to);
  s.summary()["certificate"]["text"] = known;
  s.section.text = results::capital(line) + ". " + why + " " + results::capital(known) + ".";
  s.finish(line + " (" + in_short + ")");
}

}  // namespace whirl::steps
