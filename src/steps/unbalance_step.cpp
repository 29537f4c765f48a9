// An unbalance-response step: Bode and polar plots of the probes, forces of the supports, operating
// shapes, separation margins.
#include <analysis/response/api684.hpp>
#include <analysis/spectra/critical.hpp>
#include <results/response.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>
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
  const plot::Amplitude convention = s.job.model.output.peak_to_peak
                                         ? plot::Amplitude::peak_to_peak
                                         : plot::Amplitude::zero_to_peak;
  for (std::size_t p = 0; p < probes.size(); ++p) {
    std::vector<plot::ResponseCurve> curves;
    for (std::size_t k = 0; k < r.orders.size(); ++k) {
      std::vector<analysis::PointAmplitude> amplitudes;
      std::vector<double> speeds;
      for (const SteadyPoint& x : r.points) {
        speeds.push_back(x.Omega);
        amplitudes.push_back(x.probe[k][p]);
      }
      const results::ProbeCurves c = results::curves_of(probes[p], amplitudes);
      for (std::size_t i = 0; i < c.label.size(); ++i) {
        plot::ResponseCurve curve{c.label[i] + order_suffix(r, k), speeds, {}, {}};
        for (const Complex a : c.amplitude[i]) {
          curve.amplitude.push_back(std::abs(a));
          curve.phase_lag.push_back(results::lag(a));
        }
        curves.push_back(std::move(curve));
      }
    }
    std::vector<plot::CriticalMark> marks;
    for (const analysis::ResponsePeak& k : peaks)
      if (k.probe == p)
        marks.push_back({k.speed, k.speed * r.orders[k.order], r.orders[k.order], {}});
    s.add_figure(plot::plot_bode(s.file(probes[p].name + "_bode"),
                                 probes[p].name + ": response to unbalance", curves, convention,
                                 marks));
    s.add_figure(plot::plot_polar(s.file(probes[p].name + "_polar"),
                                  probes[p].name + ": polar plot", curves, convention));
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
        y.x.push_back(results::to_rpm(x.Omega));
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

io::Table make_table(const UnbalanceResponse& r, std::size_t k,
                     const std::vector<analysis::ResponseProbe>& probes,
                     const std::vector<analysis::Measurement>& outputs) {
  io::Table t;
  t.title = "Unbalance response" + order_suffix(r, k);
  t.columns.push_back({"speed", "rpm", ""});
  for (const analysis::ResponseProbe& p : probes)
    results::add_probe_columns(t, p.name);
  for (const analysis::Measurement& m : outputs)
    for (const char* c : {"y", "z"}) {
      t.columns.push_back({fmt::format("{} {}", m.name, c), "N", "0-peak"});
      t.columns.push_back({fmt::format("{} {} phase lag", m.name, c), "deg", ""});
    }
  for (const SteadyPoint& x : r.points) {
    std::vector<io::Table::Cell> row{results::to_rpm(x.Omega)};
    for (const analysis::PointAmplitude& a : x.probe[k])
      results::add_probe_cells(row, a);
    for (std::size_t m = 0; m < outputs.size(); ++m)
      for (std::size_t c : {1u, 2u}) {
        row.emplace_back(std::abs(x.output[k][m][c]));
        row.emplace_back(results::lag(x.output[k][m][c]) * 180 / pi);
      }
    t.add(std::move(row));
  }
  return t;
}

/// Damped critical speeds and places about them, so that no peak is too sharp for the grid. Sorted
/// into the speeds.
void add_critical_speeds(results::FrequencyStep& s, std::vector<double>& speeds) {
  const double low = speeds.front(), high = speeds.back();
  if (!(low >= 0 && high > 0)) return;
  const auto orders = s.linear.running().orders();
  for (const double order : std::vector<double>(orders.begin(), orders.end())) {
    analysis::CriticalOptions o;
    o.order = order;
    o.max_speed = high;
    o.min_speed = low;
    o.damped = true;
    o.motion = analysis::Motion::lateral;
    for (const analysis::Critical& c : analysis::critical_speeds(s.linear, o))
      for (const double x : {-8.0, -4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0}) {
        const double Omega = c.speed * (1.0 + x * c.mode.damping_ratio);
        if (Omega > low && Omega < high) speeds.push_back(Omega);
      }
  }
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end(),
                           [](double a, double b) { return b - a < 1e-7 * b; }),
               speeds.end());
}

}  // namespace

void run_unbalance_step(run::Job& job, const model::Step& step, const model::UnbalanceStep& law) {
  analysis::UnbalanceOptions o;
  o.speeds = results::speeds_of(law.speed);
  o.refine_peaks = law.speed.refine_peaks;
  const double top = std::max(std::abs(o.speeds.front()), std::abs(o.speeds.back()));
  results::FrequencyStep s(job, step, "unbalance_response", "unbalance response", top);
  if (o.refine_peaks) {
    const run::PhaseTimer timer(job, "critical speeds");
    add_critical_speeds(s, o.speeds);
  }
  o.probes = results::response_probes(job);
  o.outputs = results::support_measurements(job);
  analysis::UnbalanceSolver solver(s.linear, o);
  const UnbalanceResponse r = [&] {
    const run::PhaseTimer timer(job, "unbalance response");
    return solver.run();
  }();
  const std::vector<analysis::ResponsePeak>& peaks = solver.peaks();

  io::Value& v = s.summary();
  v["speeds"] = r.points.size();
  io::Table table;
  table.title = "Peaks of the response";
  table.nan_means = "no half-power point on this side within the speeds";
  table.columns = {{"probe", "-", ""},
                   {"order", "-", ""},
                   {"speed", "rpm", ""},
                   {"amplitude", "m", "0-peak, major axis of the orbit"},
                   {"phase lag", "deg", ""},
                   {"amplification factor", "-", "from the half-power points"},
                   {"N1", "rpm", "lower half-power speed"},
                   {"N2", "rpm", "upper half-power speed"}};
  for (const analysis::ResponsePeak& p : peaks) {
    table.add({o.probes[p.probe].name, r.orders[p.order], results::to_rpm(p.speed), p.amplitude,
               p.phase_lag * 180 / pi, p.amplification(), results::to_rpm(p.low),
               results::to_rpm(p.high)});
    io::Value e = io::Value::object();
    e["speed [rpm]"] = results::to_rpm(p.speed);
    e["amplitude 0-peak [m]"] = p.amplitude;
    e["amplification factor"] = p.amplification();
    v["peaks"][o.probes[p.probe].name].push(std::move(e));
  }
  double largest = 0, at = 0;
  for (std::size_t p = 0; p < o.probes.size(); ++p) {
    double most = 0;
    for (const SteadyPoint& x : r.points)
      for (const auto& order : x.probe)
        if (const double a = order[p].orbit().major; a > most) {
          most = a;
          if (a > largest) {
            largest = a;
            at = x.Omega;
          }
        }
    v["largest amplitude 0-peak [m]"][o.probes[p].name] = most;
  }
  constexpr double beyond = 1.2;  // a peak is seen before its frequency is reached
  results::report_mesh_accuracy(s, o.speeds.back(), beyond * top);
  for (std::size_t k = 0; k < r.orders.size(); ++k)
    s.add_table(r.orders.size() > 1 ? fmt::format("response_{:g}x", r.orders[k]) : "response",
                make_table(r, k, o.probes, o.outputs), false);
  s.add_table("peaks", std::move(table));

  if (law.operating[1] > 0) {
    io::Table margins;
    margins.title = "Separation margins (API RP 684)";
    margins.nan_means = "no half-power point within the speeds";
    margins.columns = {{"probe", "-", ""},
                       {"peak", "rpm", ""},
                       {"amplification factor", "-", ""},
                       {"required", "%", ""},
                       {"actual", "%", "negative: inside the operating range"},
                       {"result", "-", ""}};
    int failed = 0;
    for (std::size_t k = 0; k < r.orders.size(); ++k)
      for (const analysis::MarginRow& m :
           analysis::separation_margins(peaks, o.probes, {law.operating[0], law.operating[1]}, k)) {
        margins.add({m.probe, results::to_rpm(m.speed), m.amplification, 100 * m.required,
                     100 * m.actual,
                     m.critically_damped ? "critically damped"
                     : m.passed          ? "passed"
                                         : "FAILED"});
        failed += !m.passed;
      }
    v["separation margins failed"] = failed;
    s.add_table("margins", std::move(margins));
  }
  add_probe_figures(s, r, o.probes, peaks);
  add_force_figure(s, r, o.outputs);

  // Operating shapes: where asked for, else at the distinct peaks.
  std::vector<double> shapes_at = law.shapes_at;
  if (shapes_at.empty()) {
    for (const analysis::ResponsePeak& p : peaks)
      shapes_at.push_back(p.speed);
    std::sort(shapes_at.begin(), shapes_at.end());
    shapes_at.erase(std::unique(shapes_at.begin(), shapes_at.end(),
                                [](double a, double b) { return b - a < 0.01 * b; }),
                    shapes_at.end());
  }
  analysis::UnbalanceOptions one = o;
  one.shapes = true;
  analysis::UnbalanceSolver shape_solver(s.linear, one);
  results::GapCheck gaps(s);
  for (const double Omega : shapes_at) {
    const SteadyPoint x = shape_solver.at(Omega);
    gaps.look(Omega, x.shape);
    for (std::size_t k = 0; k < r.orders.size(); ++k) {
      const std::string name =
          fmt::format("shape_{:.0f}rpm{}", results::to_rpm(Omega), order_suffix(r, k));
      double most = 0;
      for (Index n = 0; n < s.linear.system().nodes(); ++n)
        if (!s.linear.system().node(n).scalar) {
          const Eigen::Vector3cd u = analysis::local_displacement(s.linear, x.shape[k], n);
          most = std::max(most, analysis::orbit_of(u[1], u[2]).major);
        }
      if (!(most > 0)) continue;
      const plot::DisplayUnit unit = plot::length_unit(most);
      results::add_shape_figures(s, {name,
                                     fmt::format("Operating shape at {:.6g} rpm{}",
                                                 results::to_rpm(Omega), order_suffix(r, k)),
                                     fmt::format("Largest amplitude {} {}, 0-peak, drawn as 1.",
                                                 readable(unit.factor * most), unit.name),
                                     &x.shape[k]});
      results::write_shape_frames(s, name, x.shape[k], 1.0);
    }
  }
  if (largest > 0) gaps.look(at, shape_solver.at(at).shape);
  gaps.report();
  results::warn_of_held_tables(job, step.name, o.speeds.front(), o.speeds.back());
  if (largest == 0)
    s.section.text = "Nothing turns that is out of balance: the response is zero.";
  else
    s.section.text =
        fmt::format("Steady response to what turns out of balance, {} speeds{}.", r.points.size(),
                    o.refine_peaks ? ", with more of them where it peaks" : "");
  const plot::DisplayUnit unit = plot::length_unit(largest);
  s.finish(fmt::format("{} speeds, {} peaks, largest {} {} at {:.0f} rpm", r.points.size(),
                       peaks.size(), readable(unit.factor * largest), unit.name,
                       results::to_rpm(at)));
}

}  // namespace whirl::steps
