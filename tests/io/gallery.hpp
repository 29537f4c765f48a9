// One of each of the field's plots, from closed forms: what the tests check and what one can look
// at.
#pragma once
#include <plot/plots.hpp>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace whirl::io {

inline std::vector<double> grid(double a, double b, int n) {
  std::vector<double> v;
  for (int i = 0; i < n; ++i)
    v.push_back(a + (b - a) * i / (n - 1));
  return v;
}

/// Unbalance response of a Jeffcott rotor, r = Omega/omega_n.
inline Complex jeffcott(double r, double zeta) { return r * r / Complex(1 - r * r, 2 * zeta * r); }

struct Curve {
  std::string label;
  const std::vector<double>* y;
};
/// One row of axes of a history, time in s.
inline plot::Axes against_time(const std::string& name, const std::string& unit,
                               const std::vector<double>& time, const std::vector<Curve>& curves) {
  double most = 0;
  for (const Curve& c : curves)
    for (const double y : *c.y)
      most = std::max(most, std::abs(y));
  const plot::DisplayUnit u = plot::unit_for(unit, most);
  plot::Axes a;
  a.x = plot::Axis("time", "s");
  a.y = plot::Axis(name, u.name);
  for (const Curve& c : curves) {
    plot::Series line;
    (curves.size() == 1 ? line.trace_label : line.label) = c.label;  // one: the axis names it
    line.x = time;
    for (const double y : *c.y)
      line.y.push_back(u.factor * y);
    line.style.width = 1.2;
    a.series.push_back(std::move(line));
  }
  return a;
}

/// Two shafts side by side and a casing about one of them.
inline plot::Figure gallery_machine() {
  plot::MachineDrawing m{"Machine", "y", {}, {}};
  const auto rod = [](const char* name, double length, double outer, double inner) {
    plot::RotorDrawing d;
    d.title = name;
    d.sections = {{0, length, outer, outer, inner, inner, name}};
    return d;
  };
  plot::RotorDrawing motor = rod("motor", 0.6, 0.03, 0), fan = rod("fan", 0.8, 0.04, 0);
  motor.disks = {{0.5, 0.1, 0.03, 0.06, "pinion"}};
  fan.disks = {{0.3, 0.2, 0.04, 0.06, "wheel"}};
  motor.bearings = {{0.05, 0.03, "M1"}, {0.12, 0.03, "M2 beside it"}};
  fan.bearings = {{0.1, 0.04, "F1"}, {0.7, 0.04, "F2"}};
  m.lines = {{motor, 0, 0}, {fan, 0.2, 0.3}, {rod("casing", 0.7, 0.1, 0.09), 0, 0}};
  m.links = {{"mesh", 0.5, 0.1, 0.1}, {"front", 0.1, 0.03, 0.09}};
  return plot::plot_machine("machine", m);
}

/// A shaft that whirls with a radius of sin(pi x) and a casing that rocks with a third of it.
inline plot::Figure gallery_machine_shape() {
  plot::MachineShape m;
  for (const auto& [name, size] : {std::pair{"rotor", 1.0}, {"casing", 1.0 / 3}}) {
    plot::ShapeLine l{name, {}, {}, {}};
    for (const double x : grid(0, 1, 41)) {
      if (l.rest.size() % 10 == 0) l.stations.push_back(l.rest.size());
      l.rest.push_back({x, 0, 0});
      const double r = 4e-6 * size * std::sin(pi * x);
      l.u.push_back({0.0, Complex(r, 0), Complex(0, -r)});
    }
    m.lines.push_back(std::move(l));
  }
  m.links.push_back({"foot", {0.2, 0, 0}, {}, {}, {}, true});
  return plot::plot_machine_shape("machine_shape", "Mode of a machine", m);
}

/// A rod on a growing circle: 0.1 mm at the end of ten moments, 600 to 6000 rpm.
inline plot::Figure gallery_replay() {
  plot::Replay r;
  r.samples = 24;
  r.points = 5;
  for (const double x : grid(0, 0.8, 5))
    r.rest.push_back({x, 0, 0});
  for (int m = 0; m < 10; ++m) {
    const double speed = two_pi * 10 * (m + 1);
    r.time.push_back(0.5 * m);
    r.speed.push_back(speed);
    r.span.push_back(two_pi / speed);
    for (std::size_t k = 0; k < r.samples; ++k)
      for (std::size_t p = 0; p < r.points; ++p) {
        const double size = 1e-5 * (m + 1) * (0.25 * static_cast<double>(p)),
                     angle = two_pi * static_cast<double>(k) / 23;
        r.y.push_back(static_cast<float>(size * std::cos(angle)));
        r.z.push_back(static_cast<float>(size * std::sin(angle)));
      }
  }
  r.shown = 9;
  const plot::ReplayedLine line{"rod", 0, 5};
  return plot::plot_replay("replay", "Replay", std::move(r), std::span(&line, 1));
}

inline plot::Figure gallery_clearances() {
  plot::ReachLine rotor{"rotor", {}, {}};
  for (const double x : grid(0, 1, 21)) {
    rotor.x.push_back(x);
    rotor.reach.push_back(4e-5 * std::sin(pi * x));
  }
  const plot::GapMark gaps[] = {{"DE", 0.1, 8e-5, 2e-5},
                                {"seal 1", 0.48, 1.5e-4, 4e-5},
                                {"seal 2", 0.52, 1.5e-4, 4e-5},
                                {"NDE", 0.9, 8e-5, 2e-5}};
  return plot::plot_clearances("clearances", "Clearance diagram", std::span(&rotor, 1), gaps);
}

inline std::vector<plot::Figure> gallery() {
  std::vector<plot::Figure> all;
  const double w1 = 480, w2 = 1350;  // criticals, rad/s

  {  // history: run-up through a critical, 60,000 points
    std::vector<double> t = grid(0, 6, 60000), speed, y, z, torque;
    for (const double x : t) {
      const double omega = 200 * x, phi = 100 * x * x;
      const Complex a = 40e-6 * jeffcott(omega / w1, 0.03) * std::polar(1.0, phi);
      speed.push_back(omega);
      y.push_back(a.real());
      z.push_back(a.imag() - 12e-6);
      torque.push_back(20 + 3 * std::sin(30 * x));
    }
    plot::Figure f;
    f.name = "history";
    f.title = "Run-up: drive end";
    f.caption = "60,000 rows; every extreme survives the thinning.";
    f.axes.push_back(against_time("displacement DE", "m", t, {{"y", &y}, {"z", &z}}));
    f.axes.push_back(against_time("speed", "rad/s", t, {{"spin", &speed}}));
    f.axes.push_back(against_time("drive torque", "N m", t, {{"torque", &torque}}));
    f.axes[1].share_x = f.axes[2].share_x = true;
    f.height = 120 + 190 * static_cast<double>(f.axes.size());
    all.push_back(std::move(f));
  }
  {  // orbits
    plot::Orbit a{"2400 rpm", {}, {}, {}}, b{"4600 rpm", {}, {}, {}};
    for (int k = 0; k <= 720; ++k) {
      const double p = two_pi * k / 240;
      a.y.push_back(30e-6 * std::cos(p) + 4e-6 * std::cos(2 * p));
      a.z.push_back(18e-6 * std::sin(p + 0.4));
      b.y.push_back(62e-6 * std::cos(p + 1) + 9e-6 * std::cos(0.48 * p));
      b.z.push_back(55e-6 * std::sin(p + 1.2) + 9e-6 * std::sin(0.48 * p));
      if (k % 240 == 0) {
        a.keyphasor.push_back(static_cast<std::size_t>(k));
        b.keyphasor.push_back(static_cast<std::size_t>(k));
      }
    }
    const plot::Orbit o[] = {a, b};
    all.push_back(plot::plot_orbit("orbit", "Orbits at the drive-end bearing", o, 75e-6));
  }
  {  // a path in the plane and in space: a slow spiral with a whirl
    std::vector<double> x, y, z;
    for (const double t : grid(0, 10, 20000)) {
      x.push_back(0.75 - 0.012 * (1 - std::cos(3 * t)) + 0.001 * t);
      y.push_back(0.09 * std::sin(0.9 * t) * std::cos(7 * t));
      z.push_back(-0.09 + 0.06 * std::cos(7 * t) * std::cos(0.5 * t));
    }
    const plot::Curve c[] = {{"centre of the disk", y, z}};
    all.push_back(plot::plot_path("path", "Path of the disk in the yz plane", "y", "z", c));
    all.push_back(plot::plot_path_in_space("space", "Path of the disk in space", x, y, z));
  }
  {  // Campbell and stability
    std::vector<plot::CampbellLine> lines;
    std::vector<plot::CriticalMark> marks;
    const auto speeds = grid(0, 1500, 61);
    int k = 1;
    for (const double w : {w1, w2}) {
      plot::CampbellLine b{"mode " + std::to_string(k++), plot::Whirl::backward, {}, {}, {}, {}},
          f{"mode " + std::to_string(k++), plot::Whirl::forward, {}, {}, {}, {}};
      for (const double s : speeds) {
        const double g = 0.00025 * s * w / 1000 * (w / w1);
        b.speed.push_back(s);
        b.frequency.push_back(w * (std::sqrt(1 + g * g) - g));
        b.log_decrement.push_back(0.25 + 0.0001 * s);
        f.speed.push_back(s);
        f.frequency.push_back(w * (std::sqrt(1 + g * g) + g));
        f.log_decrement.push_back(0.3 - 0.00028 * s * w1 / w);
        if (s < 250 && w < 1000) {
          f.whirl_at.push_back(plot::Whirl::mixed);
          b.whirl_at.push_back(plot::Whirl::mixed);
        } else {
          f.whirl_at.push_back(plot::Whirl::forward);
          b.whirl_at.push_back(plot::Whirl::backward);
        }
      }
      lines.push_back(b);
      lines.push_back(f);
    }
    plot::CampbellLine torsion{"torsion 1",
                               plot::Whirl::none,
                               speeds,
                               std::vector<double>(speeds.size(), 1010.0),
                               std::vector<double>(speeds.size(), 0.02),
                               {}};
    lines.push_back(torsion);
    for (const auto& l : lines)
      for (std::size_t i = 1; i < l.speed.size(); ++i)
        if (const double a = l.frequency[i - 1] - l.speed[i - 1], b = l.frequency[i] - l.speed[i];
            a > 0 && b <= 0 && l.whirl != plot::Whirl::none) {
          const double s = l.speed[i - 1] + (l.speed[i] - l.speed[i - 1]) * a / (a - b);
          marks.push_back({s, s, 1, ""});
        }
    const double orders[] = {1, 2};
    all.push_back(plot::plot_campbell("campbell", "Campbell diagram", lines, orders, marks));
    const double onset[] = {0.3 / 0.00028};
    all.push_back(plot::plot_stability("stability", "Stability map", lines, onset));
  }
  {  // Bode and polar
    std::vector<plot::ResponseCurve> curves;
    for (const auto& [label, gain, lag] :
         {std::tuple{"DE 45°", 1.0, 0.0}, {"NDE 45°", 0.45, 0.35}}) {
      plot::ResponseCurve c{label, {}, {}, {}};
      for (const double s : grid(30, 1500, 400)) {
        const Complex a = 25e-6 * gain * (jeffcott(s / w1, 0.04) - 0.6 * jeffcott(s / w2, 0.05)) *
                          std::polar(1.0, -lag);
        c.speed.push_back(s);
        c.amplitude.push_back(std::abs(a));
        c.phase_lag.push_back(-std::arg(a));
      }
      curves.push_back(c);
    }
    const plot::CriticalMark marks[] = {{w1, w1, 1, ""}, {w2, w2, 1, ""}};
    all.push_back(plot::plot_bode("bode", "Unbalance response", curves,
                                  plot::Amplitude::peak_to_peak, marks));
    all.push_back(plot::plot_polar("polar", "Unbalance response, polar", curves,
                                   plot::Amplitude::peak_to_peak));
  }
  {  // spectra
    std::vector<plot::SpectrumTrace> traces;
    for (const double s : grid(100, 1400, 53)) {
      plot::SpectrumTrace t{s, grid(0, 2000, 400), {}};
      for (const double w : t.frequency) {
        const auto line = [&](double at, double a) { return a / (1 + std::pow((w - at) / 9, 2)); };
        t.amplitude.push_back(line(s, 30e-6 * std::abs(jeffcott(s / w1, 0.06))) +
                              line(2 * s, 5e-6) +
                              (s > 950 ? line(485, 60e-6 * (s - 950) / 450) : 0) + 2e-7);
      }
      traces.push_back(std::move(t));
    }
    const double orders[] = {1, 2};
    all.push_back(plot::plot_waterfall("waterfall", "Cascade of the run-up", traces,
                                       "displacement DE", "m", plot::Amplitude::zero_to_peak,
                                       orders));
    all.push_back(plot::plot_spectrogram("spectrogram", "Spectra of the run-up", traces,
                                         "displacement DE", "m", plot::Amplitude::zero_to_peak));
  }
  {  // critical-speed map
    std::vector<plot::Curve> modes, supports;
    for (int m = 1; m <= 4; ++m) {
      plot::Curve c{"mode " + std::to_string(m), {}, {}};
      for (const double e : grid(5, 10, 80)) {
        const double k = std::pow(10, e), limit = 450.0 * m * m;
        c.x.push_back(k);
        c.y.push_back(limit / std::sqrt(1 + 3e7 * m * m / k) + (m > 2 ? 0.5 * limit : 0));
      }
      modes.push_back(c);
    }
    plot::Curve b{"bearing kyy", {}, {}};
    for (const double s : grid(100, 6000, 50)) {
      b.x.push_back(4e7 * (1 + s / 3000));
      b.y.push_back(s);
    }
    supports.push_back(b);
    all.push_back(plot::plot_critical_map("criticals", "Critical-speed map", modes, supports));
  }
  {  // mode shape
    plot::ModeShape m{"mode 2, forward, 76.4 Hz, log decrement 0.12",
                      {},
                      {},
                      {},
                      {{"DE", 0.15}, {"impeller", 0.7}, {"NDE", 1.2}}};
    for (const double s : grid(0, 1.4, 60)) {
      const double w = std::sin(pi * (s - 0.1) / 1.1) + 0.1;
      m.s.push_back(s);
      m.y.push_back(w * Complex(1, 0.2));
      m.z.push_back(w * Complex(0.15, -0.7));
    }
    all.push_back(plot::plot_mode_shape("mode", "Mode shape", m));
  }
  {  // error against run time
    std::vector<plot::StudyCurve> curves;
    for (const auto& [label, order, cost] : {std::tuple{"Radau IIA 5", 5.0, 0.02},
                                             {"generalized-α", 2.0, 0.004},
                                             {"Gauss 6", 6.0, 0.018},
                                             {"IDA", 1.6, 0.3}}) {
      plot::StudyCurve c{label, {}};
      for (int k = 0; k < 7; ++k) {
        const double h = std::pow(2.0, -k);
        c.points.push_back(
            {cost / h, 0.02 * std::pow(h, order) + 1e-11, "step " + std::to_string(h) + " ms"});
      }
      curves.push_back(c);
    }
    all.push_back(
        plot::plot_study("study", "Error against run time", curves, "error / peak", "-", 1e-4));
  }
  {  // rotor
    plot::RotorDrawing r;
    r.title = "Overhung compressor rotor";
    double s = 0;
    for (const auto& [name, l, a, b, bore] : {std::tuple{"thrust_end", 0.08, 0.06, 0.06, 0.0},
                                              {"brg_de", 0.09, 0.08, 0.08, 0.0},
                                              {"body1", 0.26, 0.11, 0.11, 0.04},
                                              {"taper", 0.06, 0.11, 0.14, 0.04},
                                              {"body2", 0.42, 0.14, 0.14, 0.04},
                                              {"brg_nde", 0.09, 0.08, 0.08, 0.0},
                                              {"overhang", 0.14, 0.07, 0.07, 0.0}}) {
      r.sections.push_back({s, s + l, a / 2, b / 2, bore / 2, bore / 2, name});
      s += l;
    }
    r.disks = {{1.14, 0.21, 0.035, 0.07, "impeller"}, {0.7, 0.13, 0.07, 0.055, "balance piston"}};
    r.bearings = {{0.125, 0.04, "DE"}, {0.955, 0.04, "NDE"}};
    r.probes = {{0.17, 0.04, "DE-XY"}, {1.0, 0.04, "NDE-XY"}};
    for (const double x : grid(0, 1.14, 20))
      r.nodes.push_back(x);
    all.push_back(plot::plot_rotor("rotor", r));
  }
  all.push_back(gallery_machine());
  all.push_back(gallery_machine_shape());
  all.push_back(gallery_replay());
  all.push_back(gallery_clearances());
  return all;
}

}  // namespace whirl::io
