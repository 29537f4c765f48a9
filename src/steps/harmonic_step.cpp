// A harmonic-response step: steady response to given forces, at one speed against the frequency or
// at an order of the speed.
#include <analysis/response/frequency_response.hpp>
#include <analysis/search.hpp>
#include <results/response.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <results/refined_response.hpp>
#include <run/progress.hpp>
#include <steps/resonances.hpp>
#include <steps/step_kinds.hpp>
#include <core/parallel.hpp>
#include <core/rotation.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace whirl::steps {

namespace {

using analysis::FrequencyPoint;

/// The work of a force and a moment in the unknowns of its node: exact at the equilibrium. spin: +1
/// or -1, sign of the reference speed.
void add_force(results::FrequencyStep& s, const model::HarmonicForce& f, double spin,
               std::vector<analysis::HarmonicForce>& out) {
  const analysis::Point p = results::point_of(s.job, f.at);
  const system::State& state = s.linear.equilibrium().state;
  const Mat3& chart = state.frames.axes(p.node);
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
  // a node on a joint has its angle from what it follows
  const auto unknowns_of = [&](Index node) {
    const system::Followers& all = s.job.system().followers();
    for (const system::FollowerDef* f = all.find(node); f && !f->pinned; f = all.find(node))
      node = f->parent;
    return node;
  };
  for (const meshes::Line& l : s.job.mesh.lines) {
    double most = 0;
    for (Index n = l.first_node; n + 1 < l.first_node + l.nodes; ++n)
      if (const Index slot = m.K.pattern().slot(unknowns_of(n), unknowns_of(n + 1));
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

/// Forces that whirl do so with the spin, whichever way that is: what is asked for at speeds from
/// zero on, and at reversed ones.
using BothSpins = std::array<analysis::FrequencyResponseOptions, 2>;

/// The responses of one thread, on a linearisation of its own.
class Responder {
 public:
  Responder(analysis::Linearizer& linear, const BothSpins& options)
      : linear_(linear),
        options_(options) {}
  FrequencyPoint at(double Omega, double w, double scale) {
    const std::size_t reversed = Omega < 0 ? 1 : 0;
    auto& solver = solver_[reversed];
    if (!solver) solver.emplace(linear_, options_[reversed]);
    return solver->at(Omega, w, scale);
  }

 private:
  analysis::Linearizer& linear_;
  const BothSpins& options_;
  std::array<std::optional<analysis::HarmonicResponder>, 2> solver_;
};

/// Whether a line has elements, in which alone a torque is known.
std::vector<bool> elastic_lines(const meshes::Mesh& mesh) {
  std::vector<bool> elastic(mesh.lines.size(), false);
  for (const meshes::Element& e : mesh.elements)
    elastic[static_cast<std::size_t>(e.line)] = true;
  return elastic;
}

/// A harmonic response on its way: forces, points of the grid, peaks.
class HarmonicRun {
 public:
  HarmonicRun(run::Job& job, const model::Step& step, const model::HarmonicStep& law);
  void execute();

 private:
  struct Peak {
    double at, size;  ///< rad/s of frequency or of speed; m or rad
  };

  /// Against the grid's variable: rad/s of frequency or of speed.
  FrequencyPoint respond(double x) { return respond(responder_, x); }
  FrequencyPoint respond(Responder& responder, double x) const;
  double speed_at(double x) const { return asynchronous_ ? law_.speed : x; }
  /// So that no peak is too sharp for it.
  void refine_grid();
  void solve_grid();
  /// Points first .. last - 1 of the grid on a linearisation of their own. equilibria: theirs, or
  /// empty where all stand at one speed.
  void solve_points(std::size_t first, std::size_t last,
                    std::span<const analysis::Equilibrium> equilibria);
  void warn_of_left_out();
  void find_largest();
  double largest_of(std::size_t probe) const;
  double size_of(const FrequencyPoint& x, std::size_t probe) const {
    return twists_ ? twist(x, probe) : lateral(x, probe);
  }
  static double lateral(const FrequencyPoint& x, std::size_t probe) {
    return x.probe[probe].orbit().major;
  }
  static double twist(const FrequencyPoint& x, std::size_t probe) {
    return std::abs(x.unknown[probe]);
  }
  void judge_mesh();
  void judge_gaps();
  void add_table();
  void add_peaks();
  /// A maximum of a probe at a point of the grid, and the response at the peak beside it.
  struct Found {
    std::size_t probe, point;
    double at = 0;
    FrequencyPoint peak;
    bool bounded = true;  ///< something damps it
  };
  void find_peaks();
  /// The ends of the grid, where they meet a resonance that nothing damps.
  void add_unbounded_ends();
  std::vector<double> sizes_of(std::size_t probe) const;
  void list_maxima(std::size_t probe, std::vector<Found>& out) const;
  void find_peak(Found& x) const;
  bool is_bounded(Responder& responder, const Found& x) const;
  /// Points of the grid on what has no bound.
  void drop_unbounded();
  void warn_of_unbounded();
  void put_largest(const std::vector<Found>& peaks);
  /// What the elements leave of the peaks, or of the largest amplitude where there is none.
  std::vector<double> judge_amplitudes(const std::vector<Found>& peaks);
  BothSpins options_on(const results::RefinedModel& refined) const;
  double place_on_axis(const FrequencyPoint& x) const {
    return asynchronous_ ? x.frequency : x.Omega;
  }
  double displayed(double x) const { return asynchronous_ ? to_hz(x) : to_rpm(x); }
  void add_response_figures(std::size_t probe);
  void add_torsion_figure();
  std::vector<double> shape_places();
  void add_shape(double x);
  void finish();

  run::Job& job_;
  const model::HarmonicStep& law_;
  const bool asynchronous_;
  std::vector<double> grid_;
  const double top_;  ///< highest |speed|, rad/s
  results::FrequencyStep s_;
  results::GapCheck gaps_;
  BothSpins both_;
  analysis::FrequencyResponseOptions& options_;  ///< of the first: all but forces are alike
  Responder responder_;
  std::vector<FrequencyPoint> points_;
  std::vector<std::vector<double>> torques_;  ///< [point][line], N m
  double largest_ = 0, largest_twist_ = 0, largest_at_ = 0;
  bool twists_ = false;  ///< the response is torsional
  std::vector<Found> found_;
  std::vector<Peak> peaks_;  ///< those with a bound
};

HarmonicRun::HarmonicRun(run::Job& job, const model::Step& step, const model::HarmonicStep& law)
    : job_(job),
      law_(law),
      asynchronous_(law.frequency.has_value()),
      grid_(asynchronous_ ? results::frequencies_of(*law.frequency)
                          : results::speeds_of(*law.speeds)),
      top_(asynchronous_ ? std::abs(law.speed)
                         : std::max(std::abs(grid_.front()), std::abs(grid_.back()))),
      s_(job, step, "harmonic_response", "harmonic response", top_),
      gaps_(s_),
      options_(both_.front()),
      responder_(s_.linear, both_) {
  s_.linear.at(speed_at(grid_.front()));
  options_.probes = results::response_probes(job);
  for (const analysis::ResponseProbe& p : options_.probes)
    options_.unknowns.push_back(6 * p.point.node + system::spin_phi);
  options_.outputs = results::support_measurements(job);
  options_.motion = results::motion_of(law.motion);
  options_.shapes = true;
  both_[1] = both_[0];
  for (const model::HarmonicForce& f : law_.forces) {
    add_force(s_, f, 1.0, both_[0].forces);
    add_force(s_, f, -1.0, both_[1].forces);
  }
}

FrequencyPoint HarmonicRun::respond(Responder& responder, double x) const {
  if (asynchronous_) return responder.at(law_.speed, x, 1.0);
  const double scale = law_.speed_squared ? x * x / (top_ * top_) : 1.0;
  return responder.at(x, law_.order * std::abs(x), scale);
}

void HarmonicRun::solve_points(std::size_t first, std::size_t last,
                               std::span<const analysis::Equilibrium> equilibria) {
  analysis::Linearizer linear(s_.linear);
  Responder responder(linear, both_);
  for (std::size_t k = first; k < last; ++k) {
    if (!equilibria.empty()) linear.set_equilibrium(equilibria[k - first]);
    points_[k] = respond(responder, grid_[k]);
    torques_[k] = line_torques(s_, linear.at(points_[k].Omega), points_[k].shape);
  }
}

Driven driven_by(const results::FrequencyStep& s, const std::vector<model::HarmonicForce>& forces) {
  constexpr double rounding = 1e-12;
  Driven out;
  for (const model::HarmonicForce& f : forces) {
    const analysis::Point p = results::point_of(s.job, f.at);
    const Vec3 e = s.linear.equilibrium().state.frames.axes(p.node).col(0);
    const auto along = [&](const Vec3& v) { return std::abs(e.dot(v)) > rounding * v.norm(); };
    const auto across = [&](const Vec3& v) { return e.cross(v).norm() > rounding * v.norm(); };
    out.lateral = out.lateral || across(f.force) || across(f.moment);
    out.torsional = out.torsional || along(f.moment);
    out.axial = out.axial || along(f.force);
  }
  return out;
}

void HarmonicRun::refine_grid() {
  const bool range = asynchronous_ ? law_.frequency->values.empty() : law_.speeds->refine_peaks;
  if (!range) return;
  const run::PhaseTimer timer(job_, asynchronous_ ? "natural frequencies" : "critical speeds");
  const analysis::Motion motion = results::motion_of(law_.motion);
  if (asynchronous_)
    refine_at_frequencies(s_, motion, driven_by(s_, law_.forces), law_.speed, grid_);
  else
    refine_at_criticals(s_, motion, driven_by(s_, law_.forces), law_.order, grid_);
}

// Equilibria one after the other, responses side by side. What a thread gets at a time depends on
// the grid alone.
void HarmonicRun::solve_grid() {
  const run::PhaseTimer timer(job_, "harmonic response");
  constexpr std::size_t batch = 512;  // equilibria kept at a time
  const std::size_t run_length = std::clamp<std::size_t>(grid_.size() / 16, 8, 64);
  points_.resize(grid_.size());
  torques_.resize(grid_.size());
  for (std::size_t from = 0; from < grid_.size(); from += batch) {
    const std::size_t count = std::min(batch, grid_.size() - from);
    std::vector<analysis::Equilibrium> equilibria;
    for (std::size_t k = 0; k < count && !asynchronous_; ++k) {
      s_.linear.move_to(grid_[from + k]);
      equilibria.push_back(s_.linear.equilibrium());
    }
    run_side_by_side((count + run_length - 1) / run_length, job_.options.jobs, [&](std::size_t r) {
      const std::size_t first = r * run_length, last = std::min(first + run_length, count);
      const std::span<const analysis::Equilibrium> all(equilibria);
      solve_points(from + first, from + last,
                   asynchronous_ ? all : all.subspan(first, last - first));
    });
  }
}

void HarmonicRun::find_largest() {
  largest_ = largest_twist_ = 0;
  if (points_.empty()) return;  // all on resonances without bound
  for (std::size_t k = 0; k < points_.size(); ++k)
    for (std::size_t p = 0; p < options_.probes.size(); ++p) {
      if (lateral(points_[k], p) > largest_) {
        largest_ = lateral(points_[k], p);
        largest_at_ = grid_[k];
      }
      largest_twist_ = std::max(largest_twist_, twist(points_[k], p));
    }
  twists_ = law_.motion == model::MotionKind::torsional || largest_ == 0;
  if (!twists_) return;
  for (std::size_t k = 0; k < points_.size(); ++k)
    for (std::size_t p = 0; p < options_.probes.size(); ++p)
      if (twist(points_[k], p) == largest_twist_) largest_at_ = grid_[k];
}

void HarmonicRun::judge_mesh() {
  double top = 0;
  for (const FrequencyPoint& x : points_)
    top = std::max(top, std::abs(x.frequency));
  constexpr double beyond = 1.2;  // a peak is seen before its frequency is reached
  results::report_mesh_accuracy(s_, points_.back().Omega, beyond * top);
  results::warn_of_tables(job_, s_.step.name, points_.front().Omega, points_.back().Omega);
  const std::vector<double> speeds =
      asynchronous_ ? std::vector<double>{law_.speed} : results::speeds_of(*law_.speeds);
  results::warn_of_growth(s_, results::speeds_to_judge(job_, speeds),
                          results::motion_of(law_.motion));
}

/// At the largest response, beside the shapes.
void HarmonicRun::judge_gaps() {
  if (largest_ > 0) {
    const FrequencyPoint p = respond(largest_at_);
    gaps_.look(p.Omega, std::span(&p.shape, 1), p.frequency);
  }
  gaps_.report("harmonic response");
}

void HarmonicRun::add_table() {
  io::Table t;
  t.title = "Harmonic response";
  t.columns = {{"speed", "rpm", ""}, {"frequency", "Hz", "of the excitation"}};
  for (const analysis::ResponseProbe& p : options_.probes) {
    results::add_probe_columns(t, p);
    t.columns.push_back({p.name + " twist amplitude", "rad", "0-peak"});
    t.columns.push_back({p.name + " twist phase lag", "deg", "behind a force of phase 0"});
  }
  for (const analysis::Measurement& m : options_.outputs)
    for (const char* c : {"x", "y", "z"})
      t.columns.push_back({fmt::format("{} {}", m.name, c), "N", "0-peak"});
  // rigid lines have none
  const std::vector<bool> elastic = elastic_lines(job_.mesh);
  for (std::size_t l = 0; l < elastic.size(); ++l)
    if (elastic[l])
      t.columns.push_back({fmt::format("largest torque in {}", job_.mesh.lines[l].name), "N.m",
                           "0-peak, in any element"});
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const FrequencyPoint& x = points_[k];
    std::vector<io::Table::Cell> row{to_rpm(x.Omega), to_hz(x.frequency)};
    for (std::size_t p = 0; p < options_.probes.size(); ++p) {
      results::add_probe_cells(row, options_.probes[p], x.probe[p]);
      row.emplace_back(std::abs(x.unknown[p]));
      row.emplace_back(results::lag(x.unknown[p]) * 180 / pi);
    }
    for (std::size_t m = 0; m < options_.outputs.size(); ++m)
      for (std::size_t c = 0; c < 3; ++c)
        row.emplace_back(std::abs(x.output[m][c]));
    for (std::size_t l = 0; l < elastic.size(); ++l)
      if (elastic[l]) row.emplace_back(torques_[k][l]);
    t.add(std::move(row));
  }
  s_.add_table("response", std::move(t), false);
}

// Peaks, found between the points.
void HarmonicRun::add_peaks() {
  io::Table table;
  table.title = "Peaks of the response";
  table.columns = {{"probe", "-", ""},
                   {"speed", "rpm", ""},
                   {"frequency", "Hz", ""},
                   {"amplitude", twists_ ? "rad" : "m",
                    twists_ ? "0-peak, twist" : "0-peak, major axis of the orbit"},
                   {"mesh error of amplitude", "-", "relative, what the elements leave"}};
  table.nan_means = "an amplitude without bound, or not judged";
  io::Value& v = s_.summary();
  v["points"] = points_.size();
  put_largest(found_);
  const std::vector<double> errors = judge_amplitudes(found_);
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const Found& x = found_[k];
    const std::string& name = options_.probes[x.probe].name;
    const double size = x.bounded ? size_of(x.peak, x.probe) : nan;
    table.add({name, to_rpm(x.peak.Omega), to_hz(x.peak.frequency), size, errors[k]});
    io::Value e = io::Value::object();
    e["frequency [Hz]"] = to_hz(x.peak.frequency);
    e["speed [rpm]"] = to_rpm(x.peak.Omega);
    e["amplitude"] = size;
    e["bounded"] = x.bounded;
    e["mesh error of amplitude"] = errors[k];
    v["peaks"][name].push(std::move(e));
    if (x.bounded) peaks_.push_back({x.at, size});
  }
  s_.add_table("peaks", std::move(table));
}

/// Of points and peaks.
void HarmonicRun::put_largest(const std::vector<Found>& peaks) {
  std::vector<double> most;
  for (std::size_t p = 0; p < options_.probes.size(); ++p)
    most.push_back(largest_of(p));
  double& largest = twists_ ? largest_twist_ : largest_;
  for (const Found& x : peaks) {
    if (!x.bounded) continue;
    const double size = size_of(x.peak, x.probe);
    most[x.probe] = std::max(most[x.probe], size);
    if (size > largest) {
      largest = size;
      largest_at_ = x.at;
    }
  }
  const char* what = twists_ ? "largest twist 0-peak [rad]" : "largest amplitude 0-peak [m]";
  for (std::size_t p = 0; p < most.size(); ++p)
    s_.summary()[what][options_.probes[p].name] = most[p];
}

BothSpins HarmonicRun::options_on(const results::RefinedModel& refined) const {
  BothSpins out = both_;
  for (analysis::FrequencyResponseOptions& o : out) {
    for (analysis::HarmonicForce& f : o.forces)
      f.unknown = refined.unknown(f.unknown);
    for (analysis::ResponseProbe& p : o.probes)
      p.point = refined.point(p.point);
    for (Index& k : o.unknowns)
      k = refined.unknown(k);
    o.outputs.clear();
    o.shapes = false;
  }
  return out;
}

std::vector<double> HarmonicRun::judge_amplitudes(const std::vector<Found>& peaks) {
  std::vector<double> out(peaks.size(), nan);
  const double most = twists_ ? largest_twist_ : largest_;
  if (job_.mesh.elements.empty() || results::is_rounding(job_, most) || !std::isfinite(most))
    return out;
  results::AmplitudeAccuracy accuracy(
      s_, peaks.empty() ? "largest amplitude" : "amplitudes of the peaks");
  const run::PhaseTimer timer(job_, "accuracy of the mesh");
  try {
    results::RefinedModel refined(s_);
    const BothSpins options = options_on(refined);
    Responder fine(refined.linear(), options);
    for (std::size_t k = 0; k < peaks.size(); ++k) {
      if (!peaks[k].bounded) continue;
      const std::size_t probe = peaks[k].probe;
      const auto on = [&](Responder& responder) {
        return [&, probe](double x) { return size_of(respond(responder, x), probe); };
      };
      out[k] = results::peak_error(peaks[k].at, nan, on(responder_), on(fine)).amplitude;
    }
    if (peaks.empty()) {
      const FrequencyPoint own = respond(largest_at_), other = respond(fine, largest_at_);
      double here = 0, there = 0;
      for (std::size_t p = 0; p < options_.probes.size(); ++p) {
        here = std::max(here, size_of(own, p));
        there = std::max(there, size_of(other, p));
      }
      accuracy.add(meshes::error_of_change * std::abs(there / here - 1.0),
                   fmt::format("the largest response, at {:.6g} {}", displayed(largest_at_),
                               asynchronous_ ? "Hz" : "rpm"));
    }
  } catch (const Error&) {  // no equilibrium of the finer mesh, or no factorisation
    if (peaks.empty()) accuracy.add(nan, {});
  }
  for (std::size_t k = 0; k < peaks.size(); ++k)
    if (peaks[k].bounded)
      accuracy.add(out[k], fmt::format("the peak of probe '{}' at {:.6g} {}",
                                       options_.probes[peaks[k].probe].name, displayed(peaks[k].at),
                                       asynchronous_ ? "Hz" : "rpm"));
  accuracy.report();
  return out;
}

double HarmonicRun::largest_of(std::size_t probe) const {
  double most = 0;
  for (const FrequencyPoint& x : points_)
    most = std::max(most, size_of(x, probe));
  return most;
}

std::vector<double> HarmonicRun::sizes_of(std::size_t probe) const {
  std::vector<double> sizes;
  for (const FrequencyPoint& x : points_)
    sizes.push_back(size_of(x, probe));
  return sizes;
}

void HarmonicRun::list_maxima(std::size_t probe, std::vector<Found>& out) const {
  for (const std::size_t k : analysis::maxima_of(sizes_of(probe)))
    out.push_back({probe, k, 0.0, {}});
}

void HarmonicRun::find_peak(Found& x) const {
  analysis::Linearizer linear(s_.linear);
  Responder responder(linear, both_);
  const auto size = [&](double y) { return size_of(respond(responder, y), x.probe); };
  const std::size_t k = x.point;
  x.at = analysis::find_maximum(grid_[k - 1], grid_[k], size_of(points_[k], x.probe), grid_[k + 1],
                                3e-9, size);
  x.peak = respond(responder, x.at);
  x.bounded = is_bounded(responder, x);
}

bool HarmonicRun::is_bounded(Responder& responder, const Found& x) const {
  const auto amplitude = [&](double side) {
    const FrequencyPoint p = respond(responder, x.at * (1 + side * analysis::beside_resonance));
    return twists_ ? analysis::PointAmplitude{p.unknown[x.probe], 0.0} : p.probe[x.probe];
  };
  return !analysis::turns_about(amplitude(-1.0), amplitude(1.0));
}

void HarmonicRun::find_peaks() {
  for (std::size_t p = 0; p < options_.probes.size(); ++p)
    list_maxima(p, found_);
  run_side_by_side(found_.size(), job_.options.jobs, [&](std::size_t k) { find_peak(found_[k]); });
  add_unbounded_ends();
}

void HarmonicRun::add_unbounded_ends() {
  for (std::size_t p = 0; p < options_.probes.size(); ++p)
    for (const std::size_t end : analysis::ends_that_stand_out(sizes_of(p))) {
      if (grid_[end] == 0.0) continue;
      Found x{p, end, grid_[end], points_[end]};
      x.bounded = is_bounded(responder_, x);
      if (!x.bounded) found_.push_back(std::move(x));
    }
}

void HarmonicRun::drop_unbounded() {
  constexpr double near = 1e-6;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const bool on_it = std::any_of(found_.begin(), found_.end(), [&](const Found& x) {
      return !x.bounded && std::abs(grid_[k] - x.at) < near * std::abs(x.at);
    });
    if (on_it) continue;
    if (kept != k) {
      grid_[kept] = grid_[k];
      points_[kept] = std::move(points_[k]);
      torques_[kept] = std::move(torques_[k]);
    }
    ++kept;
  }
  grid_.resize(kept);
  points_.resize(kept);
  torques_.resize(kept);
}

void HarmonicRun::warn_of_unbounded() {
  std::vector<double> places;
  for (const Found& x : found_)
    if (!x.bounded && std::none_of(places.begin(), places.end(), [&](double p) {
          return std::abs(p - x.at) < 1e-6 * std::abs(p);
        }))
      places.push_back(x.at);
  if (places.empty()) return;
  std::string list;
  for (const double x : places)
    list += fmt::format("{}{:.6g}", list.empty() ? "" : ", ", displayed(x));
  Diagnostic d;
  d.code = "W13";
  d.message = fmt::format("step '{}': the response has no bound at {} {}: nothing damps it there",
                          s_.step.name, list, asynchronous_ ? "Hz" : "rpm");
  d.hint = "give bearings or shafts damping; amplitudes beside these places grow without end";
  results::warn(job_, std::move(d));
}

void HarmonicRun::add_response_figures(std::size_t probe) {
  const plot::Amplitude convention = plot::amplitude(job_.model.output.peak_to_peak);
  const std::string& name = options_.probes[probe].name;
  std::vector<double> axis;
  std::vector<analysis::PointAmplitude> amplitudes;
  for (const FrequencyPoint& x : points_) {
    axis.push_back(place_on_axis(x));
    amplitudes.push_back(x.probe[probe]);
  }
  const std::vector<plot::ResponseCurve> curves =
      results::response_curves(axis, results::curves_of(options_.probes[probe], amplitudes));
  plot::Figure bode = plot::plot_bode(s_.file(name + "_bode"),
                                      name + ": response to harmonic forces", curves, convention);
  plot::Figure polar =
      plot::plot_polar(s_.file(name + "_polar"), name + ": polar plot", curves, convention);
  if (asynchronous_) {
    use_frequency_axis(bode);
    use_frequency_axis(polar);
  }
  s_.add_figure(std::move(bode));
  s_.add_figure(std::move(polar));
}

void HarmonicRun::add_torsion_figure() {
  // twist of the rounding of the lateral motion is no response: the arm that would make it visible
  // is longer than any rotor
  if (!(largest_twist_ > 1e-9 * largest_)) return;
  plot::Axes twists, torques;
  twists.y = plot::Axis("twist amplitude, 0-peak", "rad");
  torques.y = plot::Axis("largest vibratory torque, 0-peak", "N.m");
  for (plot::Axes* a : {&twists, &torques}) {
    a->x = asynchronous_ ? plot::Axis("excitation frequency", "Hz") : plot::Axis("speed", "rpm");
    a->y.include_zero = true;
  }
  torques.share_x = true;
  const auto curve = [&](const std::string& label, const auto& value) {
    plot::Series y;
    y.label = label;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      y.x.push_back(displayed(place_on_axis(points_[k])));
      y.y.push_back(value(k));
    }
    return y;
  };
  for (std::size_t p = 0; p < options_.probes.size(); ++p)
    twists.series.push_back(
        curve(options_.probes[p].name, [&](std::size_t k) { return twist(points_[k], p); }));
  const std::vector<bool> elastic = elastic_lines(job_.mesh);
  for (std::size_t l = 0; l < elastic.size(); ++l)
    if (elastic[l])
      torques.series.push_back(
          curve(job_.mesh.lines[l].name, [&](std::size_t k) { return torques_[k][l]; }));
  plot::Figure f;
  f.name = s_.file("torsion");
  f.title = "Torsional response";
  f.axes = {std::move(twists)};
  if (!torques.series.empty()) f.axes.push_back(std::move(torques));
  f.height = 540;
  s_.add_figure(std::move(f));
}

/// Where asked for, else at the distinct peaks, the largest first: four at most.
std::vector<double> HarmonicRun::shape_places() {
  std::vector<double> places;
  for (const double w : law_.shapes_at)
    places.push_back(asynchronous_ ? w : w / law_.order);
  if (places.empty()) {
    std::sort(peaks_.begin(), peaks_.end(),
              [](const Peak& a, const Peak& b) { return a.size > b.size; });
    for (const Peak& p : peaks_) {
      const bool known = std::any_of(places.begin(), places.end(),
                                     [&](double x) { return std::abs(x - p.at) < 0.01 * p.at; });
      if (places.size() < 4 && !known) places.push_back(p.at);
    }
  }
  std::sort(places.begin(), places.end());
  return places;
}

void HarmonicRun::add_shape(double x) {
  const FrequencyPoint p = respond(x);
  gaps_.look(p.Omega, std::span(&p.shape, 1), p.frequency);
  const std::string name = fmt::format("shape_{:.6g}Hz", to_hz(p.frequency));
  results::add_shape_figures(
      s_,
      {name,
       fmt::format("Operating shape at {:.5g} Hz, {:.5g} rpm", to_hz(p.frequency), to_rpm(p.Omega)),
       {},
       &p.shape,
       twists_ ? analysis::ModeKind::torsional : analysis::ModeKind::lateral,
       true});
  results::write_shape_frames(s_, name, p.shape, 1.0);
}

void HarmonicRun::finish() {
  const plot::DisplayUnit unit = plot::length_unit(largest_);
  const std::string what =
      twists_ ? fmt::format("largest twist {} rad", readable(largest_twist_))
              : fmt::format("largest {} {}", readable(unit.factor * largest_), unit.name);
  s_.section.text =
      asynchronous_
          ? fmt::format("Steady response at {:.6g} rpm against the excitation frequency.",
                        to_rpm(law_.speed))
          : fmt::format("Steady response with the excitation at {:g} times the speed.", law_.order);
  const auto unbounded =
      std::find_if(found_.begin(), found_.end(), [](const Found& x) { return !x.bounded; });
  const bool endless = unbounded != found_.end();
  s_.finish(
      fmt::format("{} points, {} at {:.5g} {}", points_.size(), endless ? "without bound" : what,
                  displayed(endless ? unbounded->at : largest_at_), asynchronous_ ? "Hz" : "rpm"));
}

/// What a step of some motions leaves out of its forces: W02.
void HarmonicRun::warn_of_left_out() {
  if (law_.motion == model::MotionKind::all) return;
  std::string names;
  for (const model::HarmonicForce& f : law_.forces) {
    const Driven d = driven_by(s_, {f});
    std::string parts;
    const auto drop = [&](bool is_driven, model::MotionKind by, const char* what) {
      if (is_driven && law_.motion != by)
        parts += (parts.empty() ? "" : " and ") + std::string(what);
    };
    drop(d.lateral, model::MotionKind::lateral, "acts across the shaft");
    drop(d.torsional, model::MotionKind::torsional, "twists the shaft");
    drop(d.axial, model::MotionKind::axial, "acts along the shaft");
    if (!parts.empty())
      names += fmt::format("{}what of {} {}", names.empty() ? "" : "; ",
                           f.name.empty() ? "a force" : "force '" + f.name + "'", parts);
  }
  if (names.empty()) return;
  Diagnostic d;
  d.code = "W02";
  d.where = s_.step.where;
  d.message =
      fmt::format("step '{}' takes part of the motion only and leaves out {}", s_.step.name, names);
  d.hint = "motion = \"all\" takes them in";
  results::warn(job_, std::move(d));
}

void HarmonicRun::execute() {
  warn_of_left_out();
  refine_grid();
  solve_grid();
  find_largest();
  find_peaks();
  drop_unbounded();
  find_largest();
  warn_of_unbounded();
  judge_mesh();
  add_table();
  add_peaks();
  for (std::size_t p = 0; p < options_.probes.size() && !twists_; ++p)
    add_response_figures(p);
  add_torsion_figure();
  for (const double x : shape_places())
    add_shape(x);
  judge_gaps();
  finish();
}

}  // namespace

void run_harmonic_step(run::Job& job, const model::Step& step, const model::HarmonicStep& law) {
  HarmonicRun(job, step, law).execute();
}

}  // namespace whirl::steps
