// A harmonic-response step: steady response to given forces, at one speed against the frequency or
// at an order of the speed.
#include <analysis/response/frequency_response.hpp>
#include <analysis/search.hpp>
#include <results/response.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>
#include <core/rotation.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace whirl::steps {

namespace {

using analysis::FrequencyPoint;

/// The work of a force and a moment in the unknowns of its node: exact at the equilibrium. spin: +1
/// or -1, sign of the reference speed.
void add_force(results::FrequencyStep& s, const model::HarmonicForce& f, double spin,
               std::vector<analysis::HarmonicForce>& out) {
  const analysis::Point p = results::point_of(s.job, f.at);
  const system::State& state = s.linear.equilibrium().state;
  const Mat3& chart =
      state.frames.chart[static_cast<std::size_t>(s.linear.system().node(p.node).line)];
  const Vec2 gamma = state.q.segment<2>(6 * p.node + 4);
  rotation::Director d;
  rotation::director(gamma, d);
  const auto amplitude = [&](const Vec3& v) -> Eigen::Vector3cd {
    // along v at phase 0, a quarter period later where the spin turns it (forward) or against that
    using Whirl = model::HarmonicForce::Whirl;
    const Vec3 aside = spin * s.linear.running().sense(p.node) * chart.col(0).cross(v);
    const double sign = f.whirl == Whirl::forward ? -1.0 : f.whirl == Whirl::backward ? 1.0 : 0.0;
    return std::polar(1.0, f.phase) *
           (v.cast<Complex>() + Complex(0, sign) * aside.cast<Complex>());
  };
  const Eigen::Vector3cd force = amplitude(f.force),
                         moment = chart.transpose() * amplitude(f.moment),
                         local = chart.transpose() * force;
  for (int c = 0; c < 3; ++c)
    if (force[c] != 0.0) out.push_back({6 * p.node + c, force[c]});
  for (int c = 0; c < 3; ++c) {
    Vec2 dgamma = Vec2::Zero();
    if (c > 0) dgamma[c - 1] = 1.0;
    Complex q =
        (rotation::omega_of_rates(gamma, c == 0 ? 1.0 : 0.0, dgamma).cast<Complex>().transpose() *
         moment)(0);
    if (c > 0) q += p.offset * (d.D.col(c - 1).cast<Complex>().transpose() * local)(0);
    if (q != 0.0) out.push_back({6 * p.node + 3 + c, q});
  }
}

/// Largest amplitude of the torque in the elements of each line, N m.
std::vector<double> line_torques(const results::FrequencyStep& s, const la::MCK& m,
                                 const VecXc& a) {
  std::vector<double> out;
  for (const meshes::Line& l : s.job.mesh.lines) {
    double most = 0;
    for (Index n = l.first_node; n + 1 < l.first_node + l.nodes; ++n)
      if (const Index slot = m.K.pattern().slot(n, n + 1);
          slot >= 0) {  // the coupling of neighbours is the element's GJ/l
        const double torque =
            std::abs(m.K.block(slot)(3, 3)) * std::abs(a[6 * (n + 1) + 3] - a[6 * n + 3]);
        most = std::isnan(torque) ? torque : std::max(most, torque);
      }
    out.push_back(most);
  }
  return out;
}

/// Against frequency in Hz instead of speed in rpm.
void use_frequency_axis(plot::Figure& f) {
  for (plot::Axes& a : f.axes) {
    if (a.kind == plot::AxesKind::polar) {
      for (plot::Series& s : a.series)
        for (plot::Extra& e : s.extra)
          if (e.unit == "rpm") {
            e.label = "frequency";
            e.unit = "Hz";
            for (double& x : e.values)
              x /= 60.0;
          }
      a.notes.clear();  // they name speeds
      continue;
    }
    a.x.label = "excitation frequency";
    a.x.unit = "Hz";
    for (plot::Series& s : a.series)
      for (double& x : s.x)
        x /= 60.0;
    for (plot::Rule& r : a.rules)
      r.value /= r.vertical ? 60.0 : 1.0;
  }
}

struct Peak {
  double at, size;
};  ///< rad/s of frequency or of speed

}  // namespace

void run_harmonic_step(run::Job& job, const model::Step& step, const model::HarmonicStep& law) {
  const bool asynchronous = law.frequency.has_value();
  const std::vector<double> grid =
      asynchronous ? results::frequencies_of(*law.frequency) : results::speeds_of(*law.speeds);
  const double top =
      asynchronous ? std::abs(law.speed) : std::max(std::abs(grid.front()), std::abs(grid.back()));
  results::FrequencyStep s(job, step, "harmonic_response", "harmonic response", top);
  s.linear.at(asynchronous ? law.speed : grid.front());
  analysis::FrequencyResponseOptions o;
  o.probes = results::response_probes(job);
  for (const analysis::ResponseProbe& p : o.probes)
    o.unknowns.push_back(6 * p.point.node + system::spin_phi);
  o.outputs = results::support_measurements(job);
  o.motion = results::motion_of(law.motion);
  o.shapes = true;
  // Forces that whirl do so with the spin, whichever way that is.
  std::map<bool, analysis::HarmonicResponder> responders;
  const auto responder_at = [&](double Omega) -> analysis::HarmonicResponder& {
    const bool reversed = Omega < 0;
    if (const auto known = responders.find(reversed); known != responders.end())
      return known->second;
    o.forces.clear();
    for (const model::HarmonicForce& f : law.forces)
      add_force(s, f, reversed ? -1.0 : 1.0, o.forces);
    return responders.try_emplace(reversed, s.linear, o).first->second;
  };
  const auto respond = [&](double x) {
    const double scale = law.speed_squared && !asynchronous ? x * x / (top * top) : 1.0;
    if (asynchronous) return responder_at(law.speed).at(law.speed, x);
    return responder_at(x).at(x, law.order * std::abs(x), scale);
  };
  std::vector<FrequencyPoint> points;
  std::vector<std::vector<double>> torques;
  {
    const run::PhaseTimer timer(job, "harmonic response");
    for (const double x : grid) {
      points.push_back(respond(x));
      torques.push_back(line_torques(s, s.linear.at(points.back().Omega), points.back().shape));
    }
  }
  const auto lateral = [](const FrequencyPoint& p, std::size_t probe) {
    return p.probe[probe].orbit().major;
  };
  const auto twist = [](const FrequencyPoint& p, std::size_t probe) {
    return std::abs(p.unknown[probe]);
  };
  double largest = 0, largest_twist = 0, at = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
    for (std::size_t p = 0; p < o.probes.size(); ++p) {
      if (lateral(points[k], p) > largest) {
        largest = lateral(points[k], p);
        at = grid[k];
      }
      largest_twist = std::max(largest_twist, twist(points[k], p));
    }
  const bool twists = law.motion == model::MotionKind::torsional || largest == 0;
  if (twists)
    for (std::size_t k = 0; k < points.size(); ++k)
      for (std::size_t p = 0; p < o.probes.size(); ++p)
        if (twist(points[k], p) == largest_twist) at = grid[k];

  // Table
  io::Table t;
  t.title = "Harmonic response";
  t.columns = {{"speed", "rpm", ""}, {"frequency", "Hz", "of the excitation"}};
  for (const analysis::ResponseProbe& p : o.probes) {
    results::add_probe_columns(t, p.name);
    t.columns.push_back({p.name + " twist amplitude", "rad", "0-peak"});
    t.columns.push_back({p.name + " twist phase lag", "deg", "behind a force of phase 0"});
  }
  for (const analysis::Measurement& m : o.outputs)
    for (const char* c : {"x", "y", "z"})
      t.columns.push_back({fmt::format("{} {}", m.name, c), "N", "0-peak"});
  for (const meshes::Line& l : job.mesh.lines)
    t.columns.push_back(
        {fmt::format("largest torque in {}", l.name), "N.m", "0-peak, in any element"});
  for (std::size_t k = 0; k < points.size(); ++k) {
    const FrequencyPoint& x = points[k];
    std::vector<io::Table::Cell> row{results::to_rpm(x.Omega), results::to_hz(x.frequency)};
    for (std::size_t p = 0; p < o.probes.size(); ++p) {
      results::add_probe_cells(row, x.probe[p]);
      row.emplace_back(std::abs(x.unknown[p]));
      row.emplace_back(results::lag(x.unknown[p]) * 180 / pi);
    }
    for (std::size_t m = 0; m < o.outputs.size(); ++m)
      for (std::size_t c = 0; c < 3; ++c)
        row.emplace_back(std::abs(x.output[m][c]));
    for (const double torque : torques[k])
      row.emplace_back(torque);
    t.add(std::move(row));
  }
  double top_frequency = 0;
  for (const FrequencyPoint& x : points)
    top_frequency = std::max(top_frequency, std::abs(x.frequency));
  results::report_mesh_accuracy(s, points.back().Omega, 1.2 * top_frequency);
  s.add_table("response", std::move(t), false);

  // Peaks, found between the points.
  io::Table peaks;
  peaks.title = "Peaks of the response";
  peaks.columns = {{"probe", "-", ""},
                   {"speed", "rpm", ""},
                   {"frequency", "Hz", ""},
                   {"amplitude", twists ? "rad" : "m",
                    twists ? "0-peak, twist" : "0-peak, major axis of the orbit"}};
  std::vector<Peak> all;
  io::Value& v = s.summary();
  v["points"] = points.size();
  for (std::size_t p = 0; p < o.probes.size(); ++p) {
    const auto size = [&](const FrequencyPoint& x) { return twists ? twist(x, p) : lateral(x, p); };
    double most = 0;
    for (const FrequencyPoint& x : points)
      most = std::max(most, size(x));
    v[twists ? "largest twist 0-peak [rad]" : "largest amplitude 0-peak [m]"][o.probes[p].name] =
        most;
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
      const double f0 = size(points[k - 1]), f1 = size(points[k]), f2 = size(points[k + 1]);
      if (!(f1 > f0 && f1 >= f2) || f1 - std::min(f0, f2) < 1e-7 * most)
        continue;  // a peak of rounding is none
      const double x = analysis::find_maximum(grid[k - 1], grid[k], f1, grid[k + 1], 3e-9,
                                              [&](double y) { return size(respond(y)); });
      const FrequencyPoint peak = respond(x);
      peaks.add({o.probes[p].name, results::to_rpm(peak.Omega), results::to_hz(peak.frequency),
                 size(peak)});
      io::Value e = io::Value::object();
      e["frequency [Hz]"] = results::to_hz(peak.frequency);
      e["speed [rpm]"] = results::to_rpm(peak.Omega);
      e["amplitude"] = size(peak);
      v["peaks"][o.probes[p].name].push(std::move(e));
      all.push_back({x, size(peak)});
    }
  }
  s.add_table("peaks", std::move(peaks));

  // Figures
  const plot::Amplitude convention =
      job.model.output.peak_to_peak ? plot::Amplitude::peak_to_peak : plot::Amplitude::zero_to_peak;
  std::vector<double> axis;
  for (const FrequencyPoint& x : points)
    axis.push_back(asynchronous ? x.frequency : x.Omega);
  for (std::size_t p = 0; p < o.probes.size() && !twists; ++p) {
    std::vector<analysis::PointAmplitude> amplitudes;
    for (const FrequencyPoint& x : points)
      amplitudes.push_back(x.probe[p]);
    const results::ProbeCurves c = results::curves_of(o.probes[p], amplitudes);
    std::vector<plot::ResponseCurve> curves;
    for (std::size_t i = 0; i < c.label.size(); ++i) {
      plot::ResponseCurve curve{c.label[i], axis, {}, {}};
      for (const Complex a : c.amplitude[i]) {
        curve.amplitude.push_back(std::abs(a));
        curve.phase_lag.push_back(results::lag(a));
      }
      curves.push_back(std::move(curve));
    }
    plot::Figure bode =
        plot::plot_bode(s.file(o.probes[p].name + "_bode"),
                        o.probes[p].name + ": response to harmonic forces", curves, convention);
    plot::Figure polar = plot::plot_polar(s.file(o.probes[p].name + "_polar"),
                                          o.probes[p].name + ": polar plot", curves, convention);
    if (asynchronous) {
      use_frequency_axis(bode);
      use_frequency_axis(polar);
    }
    s.add_figure(std::move(bode));
    s.add_figure(std::move(polar));
  }
  // twist of the rounding of the lateral motion is no response: the arm that would make it visible
  // is longer than any rotor
  if (largest_twist > 1e-9 * largest) {
    std::vector<plot::Axes> axes(2);
    axes[0].y = plot::Axis("twist amplitude, 0-peak", "rad");
    axes[1].y = plot::Axis("largest vibratory torque, 0-peak", "N.m");
    for (plot::Axes& a : axes) {
      a.x = asynchronous ? plot::Axis("excitation frequency", "Hz") : plot::Axis("speed", "rpm");
      a.y.include_zero = true;
    }
    axes[1].share_x = true;
    for (std::size_t p = 0; p < o.probes.size(); ++p) {
      plot::Series y;
      y.label = o.probes[p].name;
      for (std::size_t k = 0; k < points.size(); ++k) {
        y.x.push_back(asynchronous ? results::to_hz(axis[k]) : results::to_rpm(axis[k]));
        y.y.push_back(twist(points[k], p));
      }
      axes[0].series.push_back(std::move(y));
    }
    for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
      plot::Series y;
      y.label = job.mesh.lines[l].name;
      for (std::size_t k = 0; k < points.size(); ++k) {
        y.x.push_back(asynchronous ? results::to_hz(axis[k]) : results::to_rpm(axis[k]));
        y.y.push_back(torques[k][l]);
      }
      axes[1].series.push_back(std::move(y));
    }
    plot::Figure f;
    f.name = s.file("torsion");
    f.title = "Torsional response";
    f.axes = std::move(axes);
    f.height = 540;
    s.add_figure(std::move(f));
  }

  // Shapes where asked for, else at the distinct peaks, the largest first.
  std::vector<double> shapes_at;
  if (!law.shapes_at.empty())
    for (const double w : law.shapes_at)
      shapes_at.push_back(asynchronous ? w : w / law.order);
  std::sort(all.begin(), all.end(), [](const Peak& a, const Peak& b) { return a.size > b.size; });
  for (const Peak& p : all)
    if (law.shapes_at.empty() && shapes_at.size() < 4 &&
        std::none_of(shapes_at.begin(), shapes_at.end(),
                     [&](double x) { return std::abs(x - p.at) < 0.01 * p.at; }))
      shapes_at.push_back(p.at);
  std::sort(shapes_at.begin(), shapes_at.end());
  results::GapCheck gaps(s);
  for (const double x : shapes_at) {
    const FrequencyPoint p = respond(x);
    gaps.look(p.Omega, std::span(&p.shape, 1), p.frequency);
    const std::string name = fmt::format("shape_{:.6g}Hz", results::to_hz(p.frequency));
    results::add_shape_figures(
        s, {name,
            fmt::format("Operating shape at {:.5g} Hz, {:.5g} rpm", results::to_hz(p.frequency),
                        results::to_rpm(p.Omega)),
            {},
            &p.shape,
            twists ? analysis::ModeKind::torsional : analysis::ModeKind::lateral});
    results::write_shape_frames(s, name, p.shape, 1.0);
  }
  if (largest > 0) {
    const FrequencyPoint p = respond(at);
    gaps.look(p.Omega, std::span(&p.shape, 1), p.frequency);
  }
  gaps.report();
  results::warn_of_held_tables(job, step.name, points.front().Omega, points.back().Omega);
  const plot::DisplayUnit unit = plot::length_unit(largest);
  const std::string what =
      twists ? fmt::format("largest twist {} rad", readable(largest_twist))
             : fmt::format("largest {} {}", readable(unit.factor * largest), unit.name);
  s.section.text =
      asynchronous
          ? fmt::format("Steady response at {:.6g} rpm against the excitation frequency.",
                        results::to_rpm(law.speed))
          : fmt::format("Steady response with the excitation at {:g} times the speed.", law.order);
  s.finish(fmt::format("{} points, {} at {:.5g} {}", points.size(), what,
                       asynchronous ? results::to_hz(at) : results::to_rpm(at),
                       asynchronous ? "Hz" : "rpm"));
}

}  // namespace whirl::steps
