// An unbalance-response step: Bode and polar plots of the probes, forces of the supports, operating
// shapes, separation margins.
#include <analysis/response/api684.hpp>
#include <meshes/mass_properties.hpp>
#include <results/response.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <results/refined_response.hpp>
#include <run/progress.hpp>
#include <steps/critical_margins.hpp>
#include <steps/resonances.hpp>
#include <steps/step_kinds.hpp>
#include <steps/vibration_zones.hpp>
#include <core/contract.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

namespace {

using analysis::SteadyPoint;
using analysis::UnbalanceResponse;

std::string order_suffix(const UnbalanceResponse& r, std::size_t k) {
  return r.orders.size() > 1 ? fmt::format(" {:g}x", r.orders[k]) : "";
}

void add_probe_figures(results::FrequencyStep& s, const UnbalanceResponse& r,
                       const std::vector<analysis::ResponseProbe>& probes,
                       const std::vector<analysis::ResponsePeak>& peaks) {
  const plot::Amplitude convention = plot::amplitude(s.job.model.output.peak_to_peak);
  for (std::size_t p = 0; p < probes.size(); ++p) {
    std::vector<plot::ResponseCurve> curves;
    for (std::size_t k = 0; k < r.orders.size(); ++k) {
      std::vector<analysis::PointAmplitude> amplitudes;
      std::vector<double> speeds;
      for (const SteadyPoint& x : r.points) {
        speeds.push_back(x.Omega);
        amplitudes.push_back(x.probe[k][p]);
      }
      const std::vector<plot::ResponseCurve> of_order = results::response_curves(
          speeds, results::curves_of(probes[p], amplitudes), order_suffix(r, k));
      curves.insert(curves.end(), of_order.begin(), of_order.end());
    }
    std::vector<plot::CriticalMark> marks;
    for (const analysis::ResponsePeak& k : peaks)
      if (k.probe == p)
        marks.push_back({k.speed, k.speed * r.orders[k.order], r.orders[k.order], {}});
    // what has no bound leaves nothing else to see on an even scale
    const bool log_amplitude =
        std::any_of(peaks.begin(), peaks.end(),
                    [p](const analysis::ResponsePeak& k) { return k.probe == p && !k.bounded; });
    s.add_figure(plot::plot_bode(s.file(probes[p].name + "_bode"),
                                 probes[p].name + ": response to unbalance", curves, convention,
                                 marks, log_amplitude));
    s.add_figure(plot::plot_polar(s.file(probes[p].name + "_polar"),
                                  probes[p].name + ": polar plot", curves, convention, marks));
  }
}

void add_force_figure(results::FrequencyStep& s, const UnbalanceResponse& r,
                      const std::vector<analysis::Measurement>& outputs) {
  if (outputs.empty()) return;
  double largest = 0;
  for (const SteadyPoint& x : r.points)
    for (const auto& order : x.output)
      for (const auto& out : order)
        for (const Complex f : out)
          largest = std::isfinite(std::abs(f)) ? std::max(largest, std::abs(f)) : largest;
  const plot::DisplayUnit unit = plot::unit_for("N", largest);
  plot::Axes axes;
  axes.x = plot::Axis("speed", "rpm");
  axes.y = plot::Axis("dynamic force on the shaft, largest over the turn", unit.name);
  axes.y.include_zero = true;
  for (std::size_t m = 0; m < outputs.size(); ++m)
    for (std::size_t k = 0; k < r.orders.size(); ++k) {
      plot::Series y;
      y.label = s.job.built.support_forces[m].name + order_suffix(r, k);
      for (const SteadyPoint& x : r.points) {
        const auto& f = x.output[k][m];
        y.x.push_back(to_rpm(x.Omega));
        y.y.push_back(unit.factor * analysis::orbit_of(f[1], f[2]).major);
      }
      axes.series.push_back(std::move(y));
    }
  plot::Figure f;
  f.name = s.file("bearing_forces");
  f.title = "Dynamic forces of the supports";
  f.axes.push_back(std::move(axes));
  s.add_figure(std::move(f));
}

constexpr const char* no_motion = "no periodic motion was found at the speed";

io::Table make_table(const UnbalanceResponse& r, std::size_t k,
                     const std::vector<analysis::ResponseProbe>& probes,
                     const std::vector<analysis::Measurement>& outputs) {
  io::Table t;
  t.title = "Unbalance response" + order_suffix(r, k);
  t.columns.push_back({"speed", "rpm", ""});
  for (const analysis::ResponseProbe& p : probes)
    results::add_probe_columns(t, p);
  for (const analysis::Measurement& m : outputs)
    for (const char* c : {"y", "z"}) {
      t.columns.push_back({fmt::format("{} {}", m.name, c), "N", "0-peak"});
      t.columns.push_back({fmt::format("{} {} phase lag", m.name, c), "deg", ""});
    }
  if (std::any_of(r.points.begin(), r.points.end(), [](const SteadyPoint& x) { return !x.found; }))
    t.nan_means = no_motion;
  for (const SteadyPoint& x : r.points) {
    std::vector<io::Table::Cell> row{to_rpm(x.Omega)};
    for (std::size_t p = 0; p < probes.size(); ++p)
      results::add_probe_cells(row, probes[p], x.probe[k][p]);
    for (std::size_t m = 0; m < outputs.size(); ++m)
      for (std::size_t c : {1u, 2u}) {
        row.emplace_back(std::abs(x.output[k][m][c]));
        row.emplace_back(results::lag(x.output[k][m][c]) * 180 / pi);
      }
    t.add(std::move(row));
  }
  return t;
}

/// Largest amplitude of all probes, and the speed there.
struct Largest {
  double amplitude = 0, speed = 0;  ///< m 0-peak, rad/s
};

/// Multiples of the speed in the motion of a rotor that turns unevenly or breathes.
io::Table multiples_table(const UnbalanceResponse& r,
                          const std::vector<analysis::ResponseProbe>& probes, int multiples) {
  io::Table t;
  t.title = "Multiples of the speed";
  t.columns.push_back({"speed", "rpm", ""});
  for (const analysis::ResponseProbe& p : probes) {
    for (const char* c : {"y", "z"})
      t.columns.push_back({fmt::format("{} mean {}", p.name, c), "m", "from the undeformed shaft"});
    for (int h = 1; h <= multiples; ++h)
      for (const char* way : {"forward", "backward"})
        t.columns.push_back({fmt::format("{} {}x {}", p.name, h, way), "m",
                             "radius of the circle that turns with or against the spin"});
  }
  t.nan_means = no_motion;
  t.columns.push_back({"left out", "-", "about: the last harmonic computed over the largest"});
  for (const SteadyPoint& x : r.points) {
    std::vector<io::Table::Cell> row{to_rpm(x.Omega)};
    for (std::size_t p = 0; p < probes.size(); ++p)
      for (std::size_t h = 0; h < x.multiple.size(); ++h) {
        const analysis::PointAmplitude& a = x.multiple[h][p];
        row.emplace_back(h == 0 ? a.y.real() : std::abs(a.forward()));
        row.emplace_back(h == 0 ? a.z.real() : std::abs(a.backward()));
      }
    row.emplace_back(x.left_out);
    t.add(std::move(row));
  }
  return t;
}

plot::Figure multiples_figure(const results::FrequencyStep& s, const UnbalanceResponse& r,
                              const analysis::ResponseProbe& probe, std::size_t p, int multiples,
                              bool bounded) {
  double largest = 0;
  for (const SteadyPoint& x : r.points)
    for (std::size_t h = 1; h < x.multiple.size(); ++h)
      largest = std::max(largest, x.multiple[h][p].orbit().major);
  const plot::DisplayUnit unit = plot::length_unit(largest);
  plot::Axes axes;
  axes.x = plot::Axis("speed", "rpm");
  axes.y = plot::Axis("major axis of the orbit, 0-peak", unit.name, !bounded);
  axes.y.include_zero = bounded;
  for (int h = 1; h <= multiples; ++h) {
    plot::Series y;
    y.label = fmt::format("{}x", h);
    for (const SteadyPoint& x : r.points) {
      y.x.push_back(to_rpm(x.Omega));
      y.y.push_back(unit.factor * x.multiple[static_cast<std::size_t>(h)][p].orbit().major);
    }
    axes.series.push_back(std::move(y));
  }
  plot::Figure f;
  f.name = s.file(probe.name + "_multiples");
  f.title = probe.name + ": multiples of the speed";
  f.axes.push_back(std::move(axes));
  return f;
}

/// Largest amplitude of all probes at a multiple of the speed, and the speed there; infinite where a peak has
/// no bound.
Largest largest_of_multiple(const UnbalanceResponse& r,
                            const std::vector<analysis::MultiplePeak>& peaks, std::size_t h) {
  Largest out;
  for (const analysis::MultiplePeak& p : peaks)
    if (p.multiple == h && p.amplitude > out.amplitude) out = {p.amplitude, p.speed};
  for (const SteadyPoint& x : r.points) {
    if (h >= x.multiple.size() || out.amplitude == infinity) continue;
    for (const analysis::PointAmplitude& a : x.multiple[h])
      if (a.orbit().major > out.amplitude) out = {a.orbit().major, x.Omega};
  }
  return out;
}

/// Largest amplitude of all probes at the speed itself, at the point nearest to a speed.
double largest_once_beside(const UnbalanceResponse& r, double speed) {
  const SteadyPoint& nearest = *std::min_element(
      r.points.begin(), r.points.end(), [speed](const SteadyPoint& a, const SteadyPoint& b) {
        return std::abs(a.Omega - speed) < std::abs(b.Omega - speed);
      });
  double most = 0;
  for (const analysis::PointAmplitude& a : nearest.multiple[1])
    most = std::max(most, a.orbit().major);
  return most;
}

/// ", at twice the speed 6.9 mm at 410 rpm": where it is no rounding. bounded: what is once a revolution is
/// everywhere, and says what is small beside it.
std::string add_multiples(results::FrequencyStep& s, const UnbalanceResponse& r,
                          const std::vector<analysis::ResponseProbe>& probes,
                          const std::vector<analysis::MultiplePeak>& peaks, int multiples,
                          bool breathes, bool bounded) {
  if (multiples == 0) return {};
  constexpr double seen = 1e-3, rounding = 1e-9;
  const Largest twice = largest_of_multiple(r, peaks, 2);
  const double once =
      bounded ? largest_of_multiple(r, {}, 1).amplitude : largest_once_beside(r, twice.speed);
  // without weight unbalance alone makes odd multiples, on unequal supports
  const double most = std::max(twice.amplitude, largest_of_multiple(r, peaks, 3).amplitude);
  if (!breathes && most <= rounding * once) return {};
  s.summary()["largest at twice the speed 0-peak [m]"] =
      std::isfinite(twice.amplitude) ? twice.amplitude : nan;
  s.add_table("multiples", multiples_table(r, probes, multiples), false);
  for (std::size_t p = 0; p < probes.size(); ++p)
    s.add_figure(multiples_figure(s, r, probes[p], p, multiples, bounded));
  double left_out = 0;
  for (const SteadyPoint& x : r.points)
    left_out = std::max(left_out, x.left_out);
  if (breathes) s.summary()["left out of the Fourier series, share"] = left_out;
  if (twice.amplitude <= seen * once) return {};
  if (!std::isfinite(twice.amplitude))
    return fmt::format(", at twice the speed without bound at {:.6g} rpm", to_rpm(twice.speed));
  const plot::DisplayUnit unit = plot::length_unit(twice.amplitude);
  return fmt::format(", at twice the speed {} {} at {:.6g} rpm",
                     readable(unit.factor * twice.amplitude), unit.name, to_rpm(twice.speed));
}

/// The same into the summary.
io::Table peak_table(results::FrequencyStep& s, const UnbalanceResponse& r,
                     const std::vector<analysis::ResponseProbe>& probes,
                     const std::vector<analysis::ResponsePeak>& peaks,
                     const std::vector<results::PeakError>& errors) {
  io::Table table;
  table.title = "Peaks of the response";
  table.nan_means =
      "no half-power point on this side within the speeds; an error: not judged; an amplitude and "
      "its "
      "factor: without bound";
  table.columns = {{"probe", "-", ""},
                   {"order", "-", ""},
                   {"speed", "rpm", ""},
                   {"amplitude", "m", "0-peak, major axis of the orbit"},
                   {"phase lag", "deg", ""},
                   {"amplification factor", "-", "from the half-power points"},
                   {"N1", "rpm", "lower half-power speed"},
                   {"N2", "rpm", "upper half-power speed"},
                   {"mesh error of amplitude", "-", "relative, what the elements leave"},
                   {"mesh error of amplification", "-", "the same"}};
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    const analysis::ResponsePeak& p = peaks[k];
    const std::string& name = probes[p.probe].name;
    const double amplitude = p.bounded ? p.amplitude : nan;
    const double amplification = p.bounded ? p.amplification() : nan;
    table.add({name, r.orders[p.order], to_rpm(p.speed), amplitude, p.phase_lag * 180 / pi,
               amplification, to_rpm(p.low), to_rpm(p.high), errors[k].amplitude,
               errors[k].amplification});
    io::Value e = io::Value::object();
    e["speed [rpm]"] = to_rpm(p.speed);
    e["amplitude 0-peak [m]"] = amplitude;
    e["amplification factor"] = amplification;
    e["bounded"] = p.bounded;
    e["mesh error of amplitude"] = errors[k].amplitude;
    e["mesh error of amplification"] = errors[k].amplification;
    s.summary()["peaks"][name].push(std::move(e));
  }
  return table;
}

/// Responses on the mesh of the deck, and on one twice as fine.
class BothMeshes {
 public:
  BothMeshes(results::FrequencyStep& s, analysis::UnbalanceOptions options)
      : refined_(s),
        own_(s.linear, with_probes_alone(options)),
        fine_(refined_.linear(), on_refined(std::move(options))) {}

  results::PeakError error_of(const analysis::ResponsePeak& peak) {
    const auto size = [&](analysis::UnbalanceSolver& solver) {
      return [&](double Omega) {
        return solver.at(Omega, false).probe[peak.order][peak.probe].orbit().major;
      };
    };
    return results::peak_error(peak.speed, peak.amplification(), size(own_), size(fine_));
  }
  /// Of the largest amplitude of all probes, where there is no peak.
  double error_at(double Omega, double amplitude) {
    double largest = 0;
    for (const auto& order : fine_.at(Omega, false).probe)
      for (const analysis::PointAmplitude& a : order)
        largest = std::max(largest, a.orbit().major);
    return meshes::error_of_change * std::abs(largest / amplitude - 1.0);
  }

 private:
  static analysis::UnbalanceOptions with_probes_alone(analysis::UnbalanceOptions o) {
    o.outputs.clear();
    return o;
  }
  analysis::UnbalanceOptions on_refined(analysis::UnbalanceOptions o) const {
    o.outputs.clear();
    for (analysis::ResponseProbe& p : o.probes)
      p.point = refined_.point(p.point);
    return o;
  }
  results::RefinedModel refined_;
  analysis::UnbalanceSolver own_, fine_;
};

/// The same of each probe into the summary.
Largest find_largest(const UnbalanceResponse& r, const std::vector<analysis::ResponseProbe>& probes,
                     const std::vector<analysis::ResponsePeak>& peaks, io::Value& summary) {
  Largest largest;
  for (std::size_t p = 0; p < probes.size(); ++p) {
    double most = 0;
    for (const SteadyPoint& x : r.points)
      for (const auto& order : x.probe) {
        const double a = order[p].orbit().major;
        if (a > most) most = a;
        if (a > largest.amplitude) largest = {a, x.Omega};
      }
    // between the speeds
    for (const analysis::ResponsePeak& peak : peaks) {
      if (peak.probe != p) continue;
      if (!peak.bounded) {
        most = nan;
        break;
      }
      most = std::max(most, peak.amplitude);
      if (peak.amplitude > largest.amplitude) largest = {peak.amplitude, peak.speed};
    }
    summary["largest amplitude 0-peak [m]"][probes[p].name] = most;
  }
  return largest;
}

/// Where all unbalances cancel, what is left of the response is rounding: so small a part of what one
/// of them alone would move the rotor by.
bool is_rounding(const Largest& largest, const model::Model& m) {
  constexpr double rounding = 1e-12;
  double unbalance = 0, mass = 0;
  for (std::size_t k = 0; k < m.shafts.size(); ++k)
    mass += meshes::shaft_mass(m, k).mass;
  for (const model::Unbalance& u : m.unbalances)
    unbalance += std::abs(u.amount * (u.factor ? u.factor->at(0.0).f : 1.0));
  for (const model::Disk& d : m.disks)
    unbalance += d.mass * d.offset.tail<2>().norm();
  return largest.amplitude > 0 && largest.amplitude * mass < rounding * unbalance;
}

/// What the elements leave of the peaks, or of the largest amplitude where there is none; not judged
/// where the finer mesh has no equilibrium.
std::vector<results::PeakError> judge_amplitudes(results::FrequencyStep& s,
                                                 const analysis::UnbalanceOptions& options,
                                                 const std::vector<analysis::ResponseProbe>& probes,
                                                 const std::vector<analysis::ResponsePeak>& peaks,
                                                 const Largest& largest) {
  std::vector<results::PeakError> out(peaks.size());
  if (s.job.mesh.elements.empty() || results::is_rounding(s.job, largest.amplitude)) return out;
  results::AmplitudeAccuracy accuracy(
      s, peaks.empty() ? "largest amplitude" : "amplitudes of the peaks");
  const run::PhaseTimer timer(s.job, "accuracy of the mesh");
  try {
    BothMeshes meshes(s, options);
    for (std::size_t k = 0; k < peaks.size(); ++k)
      if (peaks[k].bounded) out[k] = meshes.error_of(peaks[k]);
    if (peaks.empty())
      accuracy.add(meshes.error_at(largest.speed, largest.amplitude),
                   fmt::format("the largest response, at {:.6g} rpm", to_rpm(largest.speed)));
  } catch (const Error&) {  // no equilibrium of the finer mesh, or no factorisation
    if (peaks.empty()) accuracy.add(nan, {});
  }
  for (std::size_t k = 0; k < peaks.size(); ++k)
    if (peaks[k].bounded)
      accuracy.add(out[k].amplitude,
                   fmt::format("the peak of probe '{}' at {:.6g} rpm", probes[peaks[k].probe].name,
                               to_rpm(peaks[k].speed)));
  accuracy.report();
  return out;
}

/// Returns what the line on the terminal says of them.
std::string add_margins(results::FrequencyStep& s, const UnbalanceResponse& r,
                        const std::vector<analysis::ResponseProbe>& probes,
                        const std::vector<analysis::ResponsePeak>& peaks,
                        const model::UnbalanceStep& law) {
  if (!(law.operating[1] > 0)) return {};
  io::Table margins;
  margins.title = "Separation margins (API RP 684)";
  margins.nan_means = "no half-power point within the speeds, or a response without bound";
  const bool several = r.orders.size() > 1;
  margins.columns = {{"probe", "-", ""}};
  if (several) margins.columns.push_back({"order", "-", "of the reference speed: whose unbalance"});
  for (const io::Table::Column& c : std::initializer_list<io::Table::Column>{
           {"peak", "rpm", ""},
           {"amplification factor", "-", ""},
           {"required", "%", "by the largest factor it may have, where that is not known"},
           {"actual", "%", "negative: inside the operating range"},
           {"result", "-", ""}})
    margins.columns.push_back(c);
  int failed = 0, undetermined = 0;
  for (std::size_t k = 0; k < r.orders.size(); ++k)
    for (const analysis::MarginRow& m :
         analysis::separation_margins(peaks, probes, {law.operating[0], law.operating[1]}, k)) {
      std::vector<io::Table::Cell> row{m.probe};
      if (several) row.emplace_back(r.orders[k]);
      const double factor = std::isfinite(m.amplification) ? m.amplification : nan;
      for (const double x : {to_rpm(m.speed), factor, 100 * m.required, 100 * m.actual})
        row.emplace_back(x);
      row.emplace_back(std::string(m.critically_damped ? "critically damped"
                                   : m.undetermined    ? "not determined"
                                   : m.passed          ? "passed"
                                                       : "FAILED"));
      margins.add(std::move(row));
      failed += !m.passed && !m.undetermined;
      undetermined += m.undetermined;
    }
  s.summary()["separation margins failed"] = failed;
  s.summary()["separation margins not determined"] = undetermined;
  s.add_table("margins", std::move(margins));
  std::string said;
  if (failed > 0)
    said += fmt::format(", {} separation margin{} FAILED", failed, failed > 1 ? "s" : "");
  if (undetermined > 0)
    said += fmt::format(", {} separation margin{} not determined (no half-power point in reach)",
                        undetermined, undetermined > 1 ? "s" : "");
  return said;
}

/// What the separation margins leave out.
struct Unshown {
  int criticals = 0;
  std::string list;     ///< of them
  std::string unknown;  ///< why there may be more; empty: there are none
};

/// Lightly damped critical speeds nearer to the operating range than their margin that no peak of this order
/// stands for, as far as the supports are known.
void find_unshown(results::FrequencyStep& s, CriticalMarginOptions o,
                  const UnbalanceResponse& response, Unshown& out) {
  analysis::Linearizer linear(s.linear);
  analysis::SpectrumCertificate certificate;
  std::vector<CriticalMargin> found;
  try {
    found = critical_margins(linear, o, &certificate);
  } catch (const Error&) {  // beyond speeds that its supports are known at
    o.min_speed = std::max(o.min_speed, response.points.front().Omega);
    o.max_speed = std::min(o.max_speed, response.points.back().Omega);
    try {
      if (o.max_speed > o.min_speed) found = critical_margins(linear, o, &certificate);
      out.unknown = fmt::format("critical speeds are looked for from {:.6g} to {:.6g} rpm only",
                                to_rpm(o.min_speed), to_rpm(o.max_speed));
    } catch (const Error& e) {
      out.unknown = "critical speeds are not known: " + e.diagnostics().front().message;
    }
  }
  if (out.unknown.empty() && !certificate.complete())
    out.unknown = "the list of critical speeds may not be complete";
  for (const CriticalMargin& m : found) {
    if (m.passed()) continue;
    ++out.criticals;
    out.list += fmt::format("{}{:.6g} rpm ({}, amplification {:.3g}: {:.1f} % of {:.1f} %)",
                            out.list.empty() ? "" : ", ", to_rpm(m.critical.speed),
                            results::direction_text(m.critical.mode), m.critical.amplification(),
                            100 * m.actual, 100 * m.required);
  }
}

/// W17: critical speeds that the separation margins leave out.
void warn_of_unshown_criticals(results::FrequencyStep& s, const UnbalanceResponse& r,
                               const std::vector<analysis::ResponseProbe>& probes,
                               const std::vector<analysis::ResponsePeak>& peaks,
                               const model::UnbalanceStep& law) {
  if (!(law.operating[1] > 0)) return;
  if (r.points.back().Omega <= 0.0) {
    s.assume(
        "critical speeds that no peak stands for are not looked for where the rotor runs "
        "backwards");
    return;
  }
  // no margin is wider
  constexpr double below = 0.17, above = 0.27;
  Unshown unshown;
  for (std::size_t k = 0; k < r.orders.size(); ++k) {
    CriticalMarginOptions o;
    o.order = r.orders[k];
    o.range = {law.operating[0], law.operating[1]};
    o.min_speed = (1.0 - below) * law.operating[0];
    o.max_speed = (1.0 + above) * law.operating[1];
    o.threads = s.job.options.jobs;
    for (const analysis::MarginRow& m : analysis::separation_margins(peaks, probes, o.range, k))
      if (!m.critically_damped) o.peaks.push_back(m.speed);
    find_unshown(s, std::move(o), r, unshown);
  }
  s.summary()["critical speeds that no peak stands for"] = unshown.criticals;
  if (!unshown.unknown.empty()) s.assume("separation margins: " + unshown.unknown);
  if (unshown.criticals == 0) return;
  Diagnostic d;
  d.code = "W17";
  d.message = fmt::format(
      "step '{}': separation margins leave out {} critical speed{} that no peak of the response "
      "from {:.6g} to {:.6g} rpm stands for: {}",
      s.step.name, unshown.criticals, unshown.criticals > 1 ? "s" : "",
      to_rpm(r.points.front().Omega), to_rpm(r.points.back().Omega), unshown.list);
  d.hint = "speeds beyond it, unbalance that drives it, a probe that sees it";
  results::warn(s.job, std::move(d));
}

/// Shafts that turn against each other at one speed, both out of balance: what they do together
/// depends on where they meet, which the phases of the deck say.
void say_opposed_unbalances(results::FrequencyStep& s) {
  const model::Model& m = s.job.model;
  const auto unbalanced = [&](std::size_t k) {
    return m.shafts[k].rotating && std::any_of(m.unbalances.begin(), m.unbalances.end(),
                                               [k](const auto& u) { return u.at.shaft == k; });
  };
  for (std::size_t a = 0; a < m.shafts.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      if (!unbalanced(a) || !unbalanced(b)) continue;
      if (m.shafts[a].speed_ratio != -m.shafts[b].speed_ratio) continue;
      s.assume(fmt::format(
          "unbalances of shafts '{}' and '{}', which turn against each other at one speed, act "
          "together at the phases given; unless something keeps the shafts in step, they may "
          "meet at any other",
          m.shafts[b].name, m.shafts[a].name));
    }
}

/// Where asked for, else at the distinct peaks.
std::vector<double> shape_speeds(const model::UnbalanceStep& law,
                                 const std::vector<analysis::ResponsePeak>& peaks) {
  if (!law.shapes_at.empty()) return law.shapes_at;
  std::vector<double> speeds;
  speeds.reserve(peaks.size());
  for (const analysis::ResponsePeak& p : peaks)
    if (p.bounded) speeds.push_back(p.speed);
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end(),
                           [](double a, double b) { return b - a < 0.01 * b; }),
               speeds.end());
  return speeds;
}

double largest_radius(analysis::Linearizer& linear, const VecXc& shape) {
  double most = 0;
  for (Index n = 0; n < linear.system().nodes(); ++n) {
    if (linear.system().node(n).scalar) continue;
    const Eigen::Vector3cd u = analysis::local_displacement(linear, shape, n);
    most = std::max(most, analysis::orbit_of(u[1], u[2]).major);
  }
  return most;
}

/// also: speeds at which the gaps are looked at beside these and that of the largest response.
void add_shapes(results::FrequencyStep& s, const UnbalanceResponse& r,
                analysis::UnbalanceOptions options, const std::vector<double>& speeds,
                const std::vector<double>& also, const Largest& largest) {
  options.shapes = true;
  analysis::UnbalanceSolver solver(s.linear, options);
  results::GapCheck gaps(s);
  // what the mean place is off by counts to either side
  const auto look = [&](const SteadyPoint& x) {
    std::vector<VecXc> all = x.shape;
    all.insert(all.end(), x.shape_of_multiples.begin(), x.shape_of_multiples.end());
    gaps.look(x.Omega, all);
  };
  if (largest.amplitude > 0) look(solver.at(largest.speed));
  const double twice = largest_of_multiple(r, {}, 2).speed;
  if (twice != 0.0) look(solver.at(twice));
  for (const double Omega : speeds) {
    const SteadyPoint x = solver.at(Omega);
    look(x);
    for (std::size_t k = 0; k < r.orders.size(); ++k) {
      const std::string name = fmt::format("shape_{:.0f}rpm{}", to_rpm(Omega), order_suffix(r, k));
      const double most = largest_radius(s.linear, x.shape[k]);
      if (!(most > 0)) continue;
      const plot::DisplayUnit unit = plot::length_unit(most);
      results::add_shape_figures(
          s,
          {name, fmt::format("Operating shape at {:.6g} rpm{}", to_rpm(Omega), order_suffix(r, k)),
           fmt::format("Largest amplitude of a node {} {}, 0-peak.", readable(unit.factor * most),
                       unit.name),
           &x.shape[k], analysis::ModeKind::lateral, true});
      results::write_shape_frames(s, name, x.shape[k], 1.0);
    }
  }
  for (const double Omega : also)
    look(solver.at(Omega));
  gaps.report("response to unbalance");
}

analysis::UnbalanceOptions unbalance_options(const run::Job& job, const model::UnbalanceStep& law) {
  analysis::UnbalanceOptions o;
  o.speeds = results::speeds_of(law.speed);
  o.refine_peaks = law.speed.refine_peaks;
  o.probes = results::response_probes(job);
  o.outputs = results::support_measurements(job);
  o.threads = job.options.jobs;
  // zones are judged over the operating speeds, both ends included
  if (law.zones) {
    const double sense = std::abs(o.speeds.front()) > std::abs(o.speeds.back()) ? -1.0 : 1.0;
    for (const double end : law.operating) {
      const auto is_there = [&](double x) { return std::abs(x - sense * end) <= 1e-12 * end; };
      if (std::none_of(o.speeds.begin(), o.speeds.end(), is_there)) o.speeds.push_back(sense * end);
    }
    std::sort(o.speeds.begin(), o.speeds.end());
  }
  return o;
}

/// The response, with the peaks found within the operating speeds.
UnbalanceResponse with_peaks(const UnbalanceResponse& r,
                             const std::vector<analysis::ResponsePeak>& peaks,
                             analysis::UnbalanceSolver& solver, const model::UnbalanceStep& law) {
  UnbalanceResponse out = r;
  if (!law.zones) return out;
  for (const analysis::ResponsePeak& p : peaks)
    if (p.bounded && std::abs(p.speed) > law.operating[0] && std::abs(p.speed) < law.operating[1])
      out.points.push_back(solver.at(p.speed));
  std::sort(out.points.begin(), out.points.end(),
            [](const SteadyPoint& a, const SteadyPoint& b) { return a.Omega < b.Omega; });
  return out;
}

/// Those of the response, the operating speeds and their middle, and the highest response.
std::vector<double> speeds_to_judge(const run::Job& job, const std::vector<double>& speeds,
                                    const Largest& response, const std::vector<double>& operating) {
  std::vector<double> out = results::speeds_to_judge(job, speeds);
  out.insert(out.end(), operating.begin(), operating.end());
  if (operating.size() > 1) out.push_back(0.5 * (operating[0] + operating[1]));
  if (response.amplitude > 0) out.push_back(response.speed);
  return out;
}

/// "3004.4, 5137.2": of the peaks that have no bound.
template <class Peak>
std::string unbounded_among(const std::vector<Peak>& peaks) {
  std::vector<double> speeds;
  for (const Peak& p : peaks)
    if (!p.bounded &&
        (speeds.empty() || std::abs(p.speed - speeds.back()) > 1e-6 * std::abs(p.speed)))
      speeds.push_back(p.speed);
  std::string list;
  for (const double x : speeds)
    list += fmt::format("{}{:.6g}", list.empty() ? "" : ", ", to_rpm(x));
  return list;
}

/// Where amplitudes have no bound.
void warn_of_unbounded(results::FrequencyStep& s, const std::vector<analysis::ResponsePeak>& peaks,
                       const std::vector<analysis::MultiplePeak>& of_multiples,
                       const analysis::UnbalanceOptions& o) {
  const std::string once = unbounded_among(peaks), more = unbounded_among(of_multiples);
  if (once.empty() && more.empty()) return;
  Diagnostic d;
  d.code = "W13";
  d.message =
      fmt::format("step '{}': the response{} has no bound at {} rpm: {}", s.step.name,
                  once.empty() ? " at a multiple of the speed" : "", once.empty() ? more : once,
                  o.breathes           ? "there is no periodic motion beside it"
                  : o.turns_with_rotor ? "nothing damps it there, or the rotor begins to bend out"
                                       : "nothing damps it there");
  d.hint = "give bearings or shafts damping; amplitudes beside these speeds grow without end";
  results::warn(s.job, std::move(d));
}

/// Where no periodic motion was found.
void warn_of_no_motion(results::FrequencyStep& s, const UnbalanceResponse& r) {
  const auto none = [](const SteadyPoint& x) { return !x.found; };
  const auto first = std::find_if(r.points.begin(), r.points.end(), none);
  if (first == r.points.end()) return;
  const auto last = std::find_if(r.points.rbegin(), r.points.rend(), none);
  Diagnostic d;
  d.code = "W13";
  d.message = fmt::format(
      "step '{}': no periodic motion found at {} of {} speeds, {:.6g} to {:.6g} rpm: the crack's "
      "opening and closing did not settle",
      s.step.name, std::count_if(r.points.begin(), r.points.end(), none), r.points.size(),
      to_rpm(first->Omega), to_rpm(last->Omega));
  d.hint =
      "a stability step finds the bands in which there is none; a transient step follows the "
      "motion";
  results::warn(s.job, std::move(d));
}

}  // namespace

UnbalanceOutcome run_unbalance_step(run::Job& job, const model::Step& step,
                                    const model::UnbalanceStep& law, std::size_t beside,
                                    std::vector<double> operating) {
  analysis::UnbalanceOptions o = unbalance_options(job, law);
  WHIRL_EXPECTS(beside <= o.probes.size());
  const std::vector<analysis::ResponseProbe> shown(
      o.probes.begin(), o.probes.end() - static_cast<std::ptrdiff_t>(beside));
  const double top = std::max(std::abs(o.speeds.front()), std::abs(o.speeds.back()));
  results::FrequencyStep s(job, step, "unbalance_response", "unbalance response", top);
  o.turns_with_rotor = s.turns_as_one() && (results::turns_with_stiffness(job.model) ||
                                            results::turns_with_inertia(job.model));
  o.breathes = s.turns_as_one() && results::breathes(job.model);
  if (o.breathes || o.turns_with_rotor) o.multiples = 3;
  if (o.refine_peaks && o.speeds.back() > o.speeds.front()) {
    const run::PhaseTimer timer(job, "critical speeds");
    // what turns unevenly has peaks beside the critical speeds of its mean, and the weight shakes it at
    // twice the speed
    const auto orders = s.linear.running().orders();
    if (o.multiples > 0)
      refine_at_poles(s, o.speeds);
    else
      for (const double order : std::vector<double>(orders.begin(), orders.end()))
        refine_at_criticals(s, analysis::Motion::lateral, {.lateral = true}, order, o.speeds);
    o.resolve = s.linear.running().running().frequency_dependent();
  }
  analysis::UnbalanceSolver solver(s.linear, o);
  const UnbalanceResponse r = [&] {
    const run::PhaseTimer timer(job, "unbalance response");
    return solver.run();
  }();
  std::vector<analysis::ResponsePeak> peaks = solver.peaks();
  std::vector<analysis::MultiplePeak> of_multiples = solver.peaks_of_multiples();
  const auto is_beside = [&](const auto& p) { return p.probe >= shown.size(); };
  std::erase_if(peaks, is_beside);
  std::erase_if(of_multiples, is_beside);

  s.summary()["speeds"] = r.points.size();
  const Largest largest = find_largest(r, shown, peaks, s.summary());
  const auto unbounded = std::find_if(peaks.begin(), peaks.end(),
                                      [](const analysis::ResponsePeak& p) { return !p.bounded; });
  warn_of_unbounded(s, peaks, of_multiples, o);
  warn_of_no_motion(s, r);
  constexpr double beyond = 1.2;  // a peak is seen before its frequency is reached
  results::report_mesh_accuracy(s, o.speeds.back(), beyond * top);
  const bool cancelled = is_rounding(largest, job.model);
  const Largest judged = cancelled ? Largest{} : largest;
  io::Table found = peak_table(s, r, shown, peaks, judge_amplitudes(s, o, o.probes, peaks, judged));
  results::warn_of_tables(job, step.name, o.speeds);
  if (operating.empty() && law.operating[1] > 0)
    operating.assign(law.operating.begin(), law.operating.end());
  if (o.speeds.back() <= 0)
    for (double& x : operating)
      x = -std::abs(x);
  results::warn_of_growth(s,
                          speeds_to_judge(job, results::speeds_of(law.speed), largest, operating));
  for (std::size_t k = 0; k < r.orders.size(); ++k)
    s.add_table(r.orders.size() > 1 ? fmt::format("response_{:g}x", r.orders[k]) : "response",
                make_table(r, k, shown, o.outputs), false);
  s.add_table("peaks", std::move(found));
  const std::string margins = add_margins(s, r, shown, peaks, law);
  warn_of_unshown_criticals(s, r, shown, peaks, law);
  add_probe_figures(s, r, shown, peaks);
  const std::string twice =
      add_multiples(s, r, shown, of_multiples, o.multiples, o.breathes, unbounded == peaks.end());
  add_force_figure(s, r, o.outputs);
  add_zones(s, with_peaks(r, peaks, solver, law), shown, peaks, law);
  add_grades(s, law);
  std::vector<double> also{o.speeds.front(), o.speeds.back()};
  for (const analysis::ResponsePeak& p : peaks)
    if (p.bounded) also.push_back(p.speed);
  add_shapes(s, r, o, shape_speeds(law, peaks),
             largest.amplitude > 0 ? also : std::vector<double>{}, largest);

  const bool still = largest.amplitude == 0 && !r.points.empty();
  s.section.text = still ? "Nothing turns that is out of balance: the response is zero."
                         : fmt::format("Steady response to what turns out of balance, {} speeds{}.",
                                       r.points.size(),
                                       o.refine_peaks ? ", with more of them where it peaks" : "");
  say_opposed_unbalances(s);
  if (still) {
    Diagnostic d;
    d.code = "W02";
    d.message = fmt::format("step '{}': nothing turns that is out of balance: the response is zero",
                            step.name);
    d.hint = "give an [[unbalance]] whose factor is not zero at time 0, or a probe that it moves";
    results::warn(job, std::move(d));
  }
  const plot::DisplayUnit unit = plot::length_unit(largest.amplitude);
  const std::string most =
      unbounded != peaks.end()
          ? fmt::format("without bound at {:.0f} rpm", to_rpm(unbounded->speed))
      : cancelled
          ? fmt::format("the unbalances cancel: {:.1g} m is rounding", largest.amplitude)
          : fmt::format("largest {} {} at {:.0f} rpm", readable(unit.factor * largest.amplitude),
                        unit.name, to_rpm(largest.speed));
  s.finish(fmt::format("{} speeds, {} peaks, {}{}{}", r.points.size(), peaks.size(), most, twice,
                       margins));
  return {std::move(o.probes), r, std::move(peaks)};
}

}  // namespace whirl::steps
