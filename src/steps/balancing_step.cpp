// A balancing step: influence coefficients of the planes, corrections, and what they leave.
#include <analysis/response/balancing.hpp>
#include <analysis/response/unbalance.hpp>
#include <assembly/build_system.hpp>
#include <results/channels.hpp>
#include <results/frequency.hpp>
#include <results/response.hpp>
#include <run/progress.hpp>
#include <steps/api_models.hpp>
#include <steps/step_kinds.hpp>
#include <steps/undamped_forward.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

namespace {

/// One vibration that is balanced: a probe in a direction at a speed.
struct Sensor {
  std::size_t probe = 0;        ///< number in the model
  double angle = 0, speed = 0;  ///< rad, rad/s
};

Error balancing_error(const model::Step& step, const std::string& message,
                      const std::string& hint) {
  Diagnostic d{Diagnostic::Severity::error, "E63", fmt::format("step '{}': {}", step.name, message),
               hint, step.where};
  return Error(Exit::deck, {std::move(d)});
}

bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(1.0, std::abs(b)); }

/// What a step is asked to balance: of measured vectors those of the initial run; else every probe
/// along its angles (y and z where it has none) at every speed.
std::vector<Sensor> sensors_of(const model::Model& m, const model::Step& step,
                               const model::BalancingStep& law) {
  if (m.probes.empty())
    throw balancing_error(step, "the deck has no probe", "[[probe]] with name and at");
  std::vector<Sensor> out;
  for (const double speed : law.speeds) {
    if (law.measured.empty())
      for (std::size_t p = 0; p < m.probes.size(); ++p)
        for (const double angle :
             m.probes[p].angles.empty() ? std::vector<double>{0, pi / 2} : m.probes[p].angles)
          out.push_back({p, angle, speed});
    for (const model::MeasuredVector& v : law.measured) {
      const auto probe = std::find_if(m.probes.begin(), m.probes.end(),
                                      [&](const model::Probe& x) { return x.name == v.probe; });
      if (probe == m.probes.end())
        throw balancing_error(
            step,
            fmt::format("a measured vector names probe '{}', which the deck does not have",
                        v.probe),
            "names of probes as in the deck");
      if (v.run == law.initial && same(v.speed, speed))
        out.push_back({static_cast<std::size_t>(probe - m.probes.begin()), v.angle, speed});
    }
  }
  if (out.empty())
    throw balancing_error(
        step, fmt::format("run '{}' has no vector at the speeds of the step", law.initial),
        "speeds = [..] with the speeds of the measurement");
  return out;
}

/// The measured vectors of a run at the sensors, m, 0 to peak.
VecXc vectors_of(const model::Model& m, const model::Step& step, const model::BalancingStep& law,
                 const std::vector<Sensor>& sensors, const std::string& run) {
  VecXc r(static_cast<Index>(sensors.size()));
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Sensor& s = sensors[i];
    const std::string& probe = m.probes[s.probe].name;
    const auto found = std::find_if(law.measured.begin(), law.measured.end(), [&](const auto& v) {
      return v.run == run && v.probe == probe && same(v.angle, s.angle) && same(v.speed, s.speed);
    });
    if (found == law.measured.end())
      throw balancing_error(
          step,
          fmt::format("run '{}' lacks the vector of probe '{}' at {:.6g} deg and {:.6g} rpm", run,
                      probe, s.angle * 180 / pi, to_rpm(s.speed)),
          "every run has a vector of every sensor and speed of the initial one");
    r[static_cast<Index>(i)] =
        std::polar((law.peak_to_peak ? 0.5 : 1.0) * found->amplitude, -found->phase_lag);
  }
  return r;
}

Index plane_of(const model::Step& step, const model::BalancingStep& law, const model::TrialRun& t) {
  for (std::size_t j = 0; j < law.planes.size(); ++j)
    if (law.planes[j].name == t.plane) return static_cast<Index>(j);
  throw balancing_error(
      step, fmt::format("a trial run names plane '{}', which the step does not have", t.plane),
      "names of planes as in [[step.plane]]");
}

/// The balanced machine with unbalances in the planes, kg m.
model::Model with_planes(const model::Model& given, const model::BalancingStep& law,
                         const std::vector<double>& amounts) {
  model::Model m = balanced(given);
  for (std::size_t j = 0; j < law.planes.size(); ++j) {
    model::Unbalance u;
    u.name = law.planes[j].name;
    u.at = law.planes[j].at;
    u.amount = amounts[j];
    m.unbalances.push_back(std::move(u));
  }
  return m;
}

/// Speed of the shaft of a plane over the reference's, with its sign.
double ratio_of(const model::Model& m, const model::BalancePlane& plane) {
  return m.shafts[plane.at.shaft].speed_ratio;
}

class Balancing {
 public:
  Balancing(run::Job& job, const model::Step& step, const model::BalancingStep& law)
      : job_(job),
        step_(step),
        law_(law),
        order_(std::abs(ratio_of(job.model, law.planes.front()))) {}
  void execute();

 private:
  VecXc respond(const model::Model& m) const;
  /// A mass in a plane as an amplitude of its frequency, and back: a shaft that turns backwards meets
  /// the marks in the opposite order.
  Complex seen(std::size_t plane, Complex mass) const {
    return ratio_of(job_.model, law_.planes[plane]) < 0 ? std::conj(mass) : mass;
  }
  VecXc measured(const std::string& run) const {
    return vectors_of(job_.model, step_, law_, sensors_, run);
  }
  void find_influence();
  void find_corrections();
  MatX shapes_at_planes(results::FrequencyStep& s) const;
  void write(results::FrequencyStep& s) const;

  run::Job& job_;
  const model::Step& step_;
  const model::BalancingStep& law_;
  double order_;  ///< of the planes' shafts: what is balanced is of its frequency
  std::vector<Sensor> sensors_;
  MatXc influence_;       ///< m/(kg m): a row a sensor, a column a plane
  VecXc before_, after_;  ///< m
  VecXc corrections_;     ///< kg m, as amplitudes of the frequency
};

/// Response of a model at the sensors.
VecXc Balancing::respond(const model::Model& m) const {
  run::Job sub(m, job_);
  model::UnbalanceStep law;
  law.speed.values = law_.speeds;
  model::Step step;
  step.name = step_.name;
  step.where = step_.where;
  step.law = law;
  const double top = *std::max_element(law_.speeds.begin(), law_.speeds.end());
  results::FrequencyStep s(sub, step, "balancing", "balancing", top);
  analysis::UnbalanceOptions o;
  o.speeds = law_.speeds;
  o.probes = results::response_probes(sub);
  analysis::UnbalanceSolver solver(s.linear, o);
  VecXc r = VecXc::Zero(static_cast<Index>(sensors_.size()));
  const std::span<const double> orders = s.linear.running().orders();
  const auto own =
      std::find_if(orders.begin(), orders.end(), [&](double x) { return same(x, order_); });
  if (own == orders.end()) return r;  // nothing is out of balance there
  const auto order = static_cast<std::size_t>(own - orders.begin());
  for (const double speed : law_.speeds) {
    const analysis::SteadyPoint x = solver.at(speed, false);
    for (std::size_t i = 0; i < sensors_.size(); ++i)
      if (sensors_[i].speed == speed)
        r[static_cast<Index>(i)] = x.probe[order][sensors_[i].probe].along(sensors_[i].angle);
  }
  return r;
}

void Balancing::find_influence() {
  const auto planes = static_cast<Index>(law_.planes.size());
  influence_ = MatXc::Constant(static_cast<Index>(sensors_.size()), planes, Complex(nan, nan));
  for (const model::TrialRun& t : law_.trials) {
    const Index plane = plane_of(step_, law_, t);
    influence_.col(plane) = (measured(t.run) - before_) /
                            seen(static_cast<std::size_t>(plane), std::polar(t.amount, t.phase));
  }
  if (!law_.trials.empty()) return;
  constexpr double gram_millimetre = 1e-6;
  for (Index k = 0; k < planes; ++k) {
    std::vector<double> amounts(law_.planes.size(), 0.0);
    amounts[static_cast<std::size_t>(k)] = gram_millimetre;
    influence_.col(k) = respond(with_planes(job_.model, law_, amounts)) / gram_millimetre;
  }
}

/// By modes: each at the vectors of its own speed.
void Balancing::find_corrections() {
  if (law_.method == model::BalancingStep::Method::influence) {
    corrections_ = analysis::balance_by_influence(influence_, before_);
    return;
  }
  // the planes are places of the mesh
  const model::Model shaped =
      with_planes(job_.model, law_, std::vector<double>(law_.planes.size(), 0.0));
  run::Job sub(shaped, job_);
  model::Step step = step_;
  step.law = model::CriticalStep{};
  results::FrequencyStep of_modes(sub, step, "balancing", "balancing",
                                  *std::max_element(law_.speeds.begin(), law_.speeds.end()));
  std::vector<std::vector<Index>> rows(law_.speeds.size());
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    for (std::size_t k = 0; k < law_.speeds.size(); ++k)
      if (same(sensors_[i].speed, law_.speeds[k])) rows[k].push_back(static_cast<Index>(i));
  corrections_ = analysis::balance_by_modes(
      influence_, before_, analysis::modal_patterns(shapes_at_planes(of_modes)), rows);
}

/// Deflections of the modes at the planes, a row a mode.
MatX Balancing::shapes_at_planes(results::FrequencyStep& s) const {
  const double highest = *std::max_element(law_.modes.begin(), law_.modes.end());
  const double top = *std::max_element(law_.speeds.begin(), law_.speeds.end());
  std::vector<analysis::Critical> found;
  for (const double beyond : {1.5, 3.0, 10.0}) {
    found = undamped_forward(s.linear, beyond * top / order_, order_);
    keep_modes_of(s.job.mesh, s.job.system(), law_.planes.front().at.shaft, found);
    if (static_cast<double>(found.size()) >= highest) break;
  }
  MatX phi(static_cast<Index>(law_.modes.size()), static_cast<Index>(law_.planes.size()));
  for (std::size_t k = 0; k < law_.modes.size(); ++k) {
    const auto number = static_cast<std::size_t>(law_.modes[k]);
    if (number < 1 || number > found.size() || law_.modes[k] != std::floor(law_.modes[k]))
      throw balancing_error(
          step_,
          fmt::format("there is no undamped mode {:g}: {} were found", law_.modes[k], found.size()),
          "modes = [1, 2], from the lowest");
    const analysis::Critical& c = found[number - 1];
    s.linear.at(c.speed);
    for (std::size_t j = 0; j < law_.planes.size(); ++j) {
      const model::Location& at = law_.planes[j].at;
      phi(static_cast<Index>(k), static_cast<Index>(j)) =
          shape_along(s, c.mode.x, at.shaft).at(at.s);
    }
  }
  return phi;
}

void Balancing::write(results::FrequencyStep& s) const {
  io::Table corrections, left, influence;
  corrections.title = "Correction masses";
  corrections.columns = {{"plane", "-", ""},
                         {"place", "m", "from the left end of the shaft"},
                         {"correction", "g mm", ""},
                         {"angle", "deg", "from the rotor mark, as the angles of unbalances"}};
  const auto degrees = [](double x) {
    const double d = x * 180 / pi;
    return d < 0 ? d + 360 : d;
  };
  for (std::size_t j = 0; j < law_.planes.size(); ++j) {
    const Complex w = seen(j, corrections_[static_cast<Index>(j)]);
    corrections.add(
        {law_.planes[j].name, law_.planes[j].at.s, 1e6 * std::abs(w), degrees(std::arg(w))});
    io::Value& v = s.summary()["corrections"][law_.planes[j].name];
    v["amount [g mm]"] = 1e6 * std::abs(w);
    v["angle [deg]"] = degrees(std::arg(w));
  }
  left.title = "Vibration before and after";
  influence.title = "Influence coefficients";
  left.columns = {{"probe", "-", ""},         {"angle", "deg", ""},      {"speed", "rpm", ""},
                  {"before", "um", "0-peak"}, {"lag before", "deg", ""}, {"after", "um", "0-peak"},
                  {"lag after", "deg", ""}};
  influence.columns = {{"probe", "-", ""}, {"angle", "deg", ""}, {"speed", "rpm", ""}};
  for (const model::BalancePlane& p : law_.planes) {
    influence.columns.push_back({p.name, "um/(g mm)", "0-peak"});
    influence.columns.push_back({p.name + " lag", "deg", ""});
  }
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const Sensor& x = sensors_[i];
    const auto row = static_cast<Index>(i);
    std::vector<io::Table::Cell> head{job_.model.probes[x.probe].name, x.angle * 180 / pi,
                                      to_rpm(x.speed)};
    std::vector<io::Table::Cell> coefficients = head;
    for (const Complex r : {before_[row], after_[row]}) {
      head.emplace_back(1e6 * std::abs(r));
      head.emplace_back(results::lag(r) * 180 / pi);
    }
    for (Index j = 0; j < influence_.cols(); ++j) {
      coefficients.emplace_back(std::abs(influence_(row, j)));  // m/(kg m) = um/(g mm)
      coefficients.emplace_back(results::lag(influence_(row, j)) * 180 / pi);
    }
    left.add(std::move(head));
    influence.add(std::move(coefficients));
  }
  s.add_table("corrections", std::move(corrections));
  s.add_table("residuals", std::move(left));
  s.add_table("influence", std::move(influence));
}

void Balancing::execute() {
  sensors_ = sensors_of(job_.model, step_, law_);
  const double top = *std::max_element(law_.speeds.begin(), law_.speeds.end());
  before_ = law_.measured.empty() ? respond(job_.model) : measured(law_.initial);
  find_influence();
  find_corrections();
  after_ = before_ + influence_ * corrections_;
  results::FrequencyStep s(job_, step_, "balancing", "balancing", top);
  write(s);
  const auto rms = [](const VecXc& r) {
    return 1e6 * r.norm() / std::sqrt(static_cast<double>(r.size()));
  };
  s.summary()["root mean square before 0-peak [um]"] = rms(before_);
  s.summary()["root mean square after 0-peak [um]"] = rms(after_);
  s.section.text = fmt::format(
      "{}, {} planes, {} vectors; influence coefficients of {}. Root mean square of the vibration "
      "{:.5g} um before, {:.5g} um after (0-peak).",
      law_.method == model::BalancingStep::Method::modal ? "Mode by mode" : "Least squares",
      law_.planes.size(), sensors_.size(), law_.trials.empty() ? "the model" : "the trial runs",
      rms(before_), rms(after_));
  s.finish(fmt::format("{} planes, {:.5g} um before, {:.5g} um after", law_.planes.size(),
                       rms(before_), rms(after_)));
}

}  // namespace

void check_balancing(const model::Model& m, const model::Step& step,
                     const model::BalancingStep& law) {
  if (!step.from.empty())
    throw balancing_error(step, "balancing starts from no other step", "leave out 'from'");
  for (const model::BalancePlane& p : law.planes) {
    const double ratio = std::abs(ratio_of(m, p)),
                 first = std::abs(ratio_of(m, law.planes.front()));
    if (!m.shafts[p.at.shaft].rotating || ratio == 0)
      throw balancing_error(step,
                            fmt::format("plane '{}' is on a shaft that does not turn", p.name),
                            "planes are places of the rotor");
    if (!same(ratio, first))
      throw balancing_error(
          step,
          fmt::format("planes '{}' and '{}' turn at different speeds", law.planes.front().name,
                      p.name),
          "a step for each shaft: vibrations of different frequencies are balanced apart");
  }
  const std::vector<Sensor> sensors = sensors_of(m, step, law);
  if (!law.measured.empty()) vectors_of(m, step, law, sensors, law.initial);
  for (const model::TrialRun& t : law.trials) {
    plane_of(step, law, t);
    vectors_of(m, step, law, sensors, t.run);
  }
  const model::Model placed = with_planes(m, law, std::vector<double>(law.planes.size(), 0.0));
  assembly::build_system(placed, meshes::make_mesh(placed), step.name);
}

void run_balancing_step(run::Job& job, const model::Step& step, const model::BalancingStep& law) {
  Balancing(job, step, law).execute();
}

}  // namespace whirl::steps
