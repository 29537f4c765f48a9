// A sensitivity step: how much margin the control loops of magnetic bearings have.
#include <analysis/response/sensitivity.hpp>
#include <analysis/search.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <core/parallel.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {
namespace {

/// Zones of ISO 14839-3:2006 for the largest |S|: A up to 3 (9.5 dB), B up to 4 (12 dB), C up to 5
/// (14 dB), D beyond.
constexpr std::array<double, 3> zone_ends{3.0, 4.0, 5.0};
const char* zone_of(double sensitivity) {
  static constexpr const char* names[] = {"A", "B", "C", "D"};
  const auto* end = std::lower_bound(zone_ends.begin(), zone_ends.end(), sensitivity);
  return names[end - zone_ends.begin()];
}
double decibel(double x) { return 20.0 * std::log10(x); }

class SensitivityRun {
 public:
  SensitivityRun(run::Job& job, const model::Step& step, const model::SensitivityStep& law)
      : law_(law),
        s_(job, step, "sensitivity", "sensitivity of the control loops", std::abs(law.speed)),
        opened_(opened_loops(job)) {}
  void execute();

 private:
  struct Loop {
    std::string name;
    double peak = 0, at = 0;  ///< largest |S|; rad/s
    bool at_end = false;      ///< of the frequencies asked for: it may be larger beyond
  };
  std::vector<analysis::OpenedLoop> opened_loops(const run::Job& job);
  void judge_stability();
  void name_growth(const analysis::WhirlMode& fastest);
  void solve();
  void find_peak(std::size_t loop);
  void add_curves();
  void add_peaks();
  void add_figure();
  std::string verdict() const;

  const model::SensitivityStep& law_;
  std::vector<Loop> loops_;
  std::vector<std::size_t> bearing_of_;  ///< one a loop
  results::FrequencyStep s_;
  std::vector<analysis::OpenedLoop> opened_;
  std::vector<double> grid_;                  ///< rad/s
  std::vector<std::vector<Complex>> values_;  ///< [frequency][loop]
  std::size_t growing_ = 0;
  bool counted_ = false;          ///< no growing motion is missing up to that frequency
  double counted_to_ = infinity;  ///< rad/s: above it growth is not excluded
};

std::vector<analysis::OpenedLoop> SensitivityRun::opened_loops(const run::Job& job) {
  std::vector<analysis::OpenedLoop> out;
  for (const assembly::MagneticControl& c : job.built.magnetic_controls)
    for (std::size_t axis = 0; axis < c.loops.size(); ++axis) {
      const assembly::MagneticControl::Loop& from = c.loops[axis];
      analysis::OpenedLoop loop;
      for (const auto& [node, force] : from.entry)
        loop.entry.emplace_back(6 * node, force);
      loop.signal = from.signal >= 0 ? 6 * from.signal : -1;
      loop.unit = from.unit;
      loop.axis = from.axis;
      loop.shaft = {from.shaft.node, from.shaft.offset};
      if (job.mesh.nodes[at(from.housing.node)].kind != meshes::NodeKind::ground)
        loop.housing = analysis::Point{from.housing.node, from.housing.offset};
      out.push_back(std::move(loop));
      bearing_of_.push_back(c.bearing);
      loops_.push_back({fmt::format("{} axis {}", job.model.bearings[c.bearing].name, axis + 1)});
    }
  return out;
}

/// The motion that grows fastest, and the loop whose sensor sees most of it.
void SensitivityRun::name_growth(const analysis::WhirlMode& fastest) {
  const auto seen_by = [&](const analysis::OpenedLoop& loop) {
    const auto along = [&](const analysis::Point& p) {
      const analysis::PointAmplitude a = analysis::amplitude_at(s_.linear, fastest.x, p);
      return loop.axis.x() * a.y + loop.axis.y() * a.z;
    };
    Complex moved = along(loop.shaft);
    if (loop.housing) moved -= along(*loop.housing);
    return std::abs(moved);
  };
  std::size_t most = 0;
  for (std::size_t k = 1; k < opened_.size(); ++k)
    if (seen_by(opened_[k]) > seen_by(opened_[most])) most = k;
  const run::Job& job = s_.job;
  Diagnostic d;
  d.code = "W13";
  d.message = fmt::format(
      "step '{}': at {:.6g} rpm a motion of {:.5g} Hz grows with {:.3g} 1/s, most of it at the "
      "sensor of {}: with its loops closed the machine is unstable, and sensitivities are no "
      "margins",
      s_.step.name, to_rpm(law_.speed), to_hz(fastest.frequency), fastest.lambda.real(),
      loops_[most].name);
  d.hint = "a modal step lists what grows; check signs, gains and delays of that controller";
  d.where = job.model.bearings[bearing_of_[most]].where;
  results::warn(s_.job, std::move(d));
}

/// Its modes up to the end of the range, where the curves are steep, and what grows at all.
void SensitivityRun::judge_stability() {
  analysis::ModesOptions o;
  o.count = 0;
  o.max_frequency =
      law_.frequency.values.empty() ? law_.frequency.stop : law_.frequency.values.back();
  o.real_roots = true;
  o.judge = true;
  analysis::SpectrumCertificate certificate;
  const std::vector<analysis::WhirlMode> modes =
      analysis::whirl_modes(s_.linear, law_.speed, o, &certificate);
  for (const analysis::WhirlMode& m : modes) {
    growing_ += m.growth() > 0;
    if (!(m.frequency > 0)) continue;
    for (const double widths : {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0}) {
      const double w = m.frequency + widths * std::abs(m.lambda.real());
      if (w > grid_.front() && w < grid_.back()) grid_.push_back(w);
    }
  }
  const auto fastest = std::max_element(
      modes.begin(), modes.end(), [](const analysis::WhirlMode& a, const analysis::WhirlMode& b) {
        return a.lambda.real() < b.lambda.real();
      });
  if (fastest != modes.end() && fastest->growth() > 0) name_growth(*fastest);
  counted_ = certificate.complete();
  if (!certificate.stability_certain()) counted_to_ = certificate.list.radius;
  s_.certify(certificate);
}

void SensitivityRun::solve() {
  grid_ = results::frequencies_of(law_.frequency);
  grid_.erase(std::remove_if(grid_.begin(), grid_.end(), [](double w) { return w <= 0; }),
              grid_.end());
  constexpr double per_decade = 24.0;  // for the curves' beginning on their logarithmic axis
  const double last = grid_.back();
  for (double w = grid_.front(); w < last; w *= std::pow(10.0, 1.0 / per_decade))
    grid_.push_back(w);
  std::sort(grid_.begin(), grid_.end());
  judge_stability();
  std::sort(grid_.begin(), grid_.end());
  grid_.erase(
      std::unique(grid_.begin(), grid_.end(), [](double a, double b) { return b - a < 1e-9 * b; }),
      grid_.end());
  const run::PhaseTimer timer(s_.job, "sensitivity");
  s_.linear.at(law_.speed);
  // what a thread gets at a time depends on the grid alone
  constexpr std::size_t run_length = 128;
  values_.resize(grid_.size());
  run_side_by_side((grid_.size() + run_length - 1) / run_length, s_.job.options.jobs,
                   [&](std::size_t r) {
                     analysis::Linearizer linear(s_.linear);
                     analysis::SensitivityMeter meter(linear, opened_);
                     const std::size_t end = std::min((r + 1) * run_length, grid_.size());
                     for (std::size_t k = r * run_length; k < end; ++k)
                       values_[k] = meter.at(law_.speed, grid_[k]);
                   });
  run_side_by_side(loops_.size(), s_.job.options.jobs, [&](std::size_t k) { find_peak(k); });
}

void SensitivityRun::find_peak(std::size_t loop) {
  const auto size = [&](std::size_t k) { return std::abs(values_[k][loop]); };
  std::size_t top = 0;
  for (std::size_t k = 1; k < grid_.size(); ++k)
    if (size(k) > size(top)) top = k;
  loops_[loop].at = grid_[top];
  loops_[loop].peak = size(top);
  loops_[loop].at_end = top == 0 || top + 1 == grid_.size();
  if (loops_[loop].at_end) return;
  analysis::Linearizer linear(s_.linear);
  analysis::SensitivityMeter meter(linear, opened_);
  const auto size_at = [&](double w) { return std::abs(meter.of(loop, law_.speed, w)); };
  // where |S| is flat to its rounding
  constexpr double flat = 1e-7;
  loops_[loop].at =
      analysis::find_maximum(grid_[top - 1], grid_[top], size(top), grid_[top + 1], flat, size_at);
  loops_[loop].peak = size_at(loops_[loop].at);
}

void SensitivityRun::add_curves() {
  io::Table t;
  t.title = "Sensitivity of the loops";
  t.columns = {{"frequency", "Hz", ""}};
  for (const Loop& l : loops_) {
    t.columns.push_back({l.name + " sensitivity", "-", "|S|"});
    t.columns.push_back({l.name + " sensitivity", "dB", ""});
    t.columns.push_back({l.name + " open loop, real", "-", "of L, S = 1/(1 + L)"});
    t.columns.push_back({l.name + " open loop, imaginary", "-", ""});
  }
  for (std::size_t k = 0; k < grid_.size(); ++k) {
    std::vector<io::Table::Cell> row{to_hz(grid_[k])};
    for (const Complex& S : values_[k]) {
      const Complex L = 1.0 / S - 1.0;
      row.emplace_back(std::abs(S));
      row.emplace_back(decibel(std::abs(S)));
      row.emplace_back(L.real());
      row.emplace_back(L.imag());
    }
    t.add(std::move(row));
  }
  s_.add_table("curves", std::move(t), false);
}

void SensitivityRun::add_peaks() {
  io::Table t;
  t.title = "Largest sensitivity of every loop";
  t.columns = {{"loop", "-", "bearing and axis"},
               {"largest sensitivity", "-", "|S|, the other loops closed"},
               {"largest sensitivity", "dB", ""},
               {"frequency", "Hz", "of the largest"},
               {"zone", "-", "ISO 14839-3:2006: A up to 3, B up to 4, C up to 5, D beyond"}};
  io::Value& v = s_.summary();
  v["speed [rpm]"] = to_rpm(law_.speed);
  v["growing motions"] = static_cast<int>(growing_);
  if (counted_to_ < infinity) v["growth not excluded above [Hz]"] = to_hz(counted_to_);
  for (const Loop& l : loops_) {
    const std::string zone = growing_ > 0            ? "unstable"
                             : counted_ && !l.at_end ? zone_of(l.peak)
                                                     : "not judged";
    t.add({l.name, l.peak, decibel(l.peak), to_hz(l.at), zone});
    io::Value e = io::Value::object();
    e["loop"] = l.name;
    e["largest sensitivity"] = l.peak;
    e["frequency [Hz]"] = to_hz(l.at);
    e["zone"] = zone;
    v["loops"].push(std::move(e));
  }
  s_.add_table("sensitivity", std::move(t));
}

void SensitivityRun::add_figure() {
  plot::Axes a;
  a.x = plot::Axis("frequency", "Hz", true);
  a.y = plot::Axis("sensitivity |S|", "dB");
  for (std::size_t l = 0; l < loops_.size(); ++l) {
    plot::Series y;
    y.label = loops_[l].name;
    for (std::size_t k = 0; k < grid_.size(); ++k) {
      y.x.push_back(to_hz(grid_[k]));
      y.y.push_back(decibel(std::abs(values_[k][l])));
    }
    a.series.push_back(std::move(y));
  }
  static constexpr const char* ends[] = {"end of zone A", "end of zone B", "end of zone C"};
  for (std::size_t k = 0; k < zone_ends.size(); ++k) {
    plot::Rule r;
    r.vertical = false;
    r.value = decibel(zone_ends[k]);
    r.label = ends[k];
    a.rules.push_back(std::move(r));
  }
  plot::Figure f;
  f.name = s_.file("curves");
  f.title = fmt::format("Sensitivity of the control loops at {:.6g} rpm", to_rpm(law_.speed));
  f.axes = {std::move(a)};
  s_.add_figure(std::move(f));
}

std::string SensitivityRun::verdict() const {
  if (growing_ > 0)
    return fmt::format("unstable: {} growing motion{}, sensitivities are no margins", growing_,
                       growing_ == 1 ? "" : "s");
  const auto worst = std::max_element(loops_.begin(), loops_.end(),
                                      [](const Loop& a, const Loop& b) { return a.peak < b.peak; });
  const std::string zone =
      std::any_of(loops_.begin(), loops_.end(), [](const Loop& l) { return l.at_end; })
          ? "no zone: a loop's sensitivity is largest at an end of the frequencies"
      : !counted_ ? "no zone: whether the loops are stable is not certified"
      : counted_to_ < infinity
          ? fmt::format("zone {} if nothing grows above {:.5g} Hz, which is not excluded",
                        zone_of(worst->peak), to_hz(counted_to_))
          : fmt::format("zone {}", zone_of(worst->peak));
  return fmt::format("largest sensitivity {:.4g} ({:.3g} dB) of {} at {:.4g} Hz, {}", worst->peak,
                     decibel(worst->peak), worst->name, to_hz(worst->at), zone);
}

void SensitivityRun::execute() {
  solve();
  add_peaks();
  add_curves();
  add_figure();
  s_.section.text = fmt::format(
      "Every loop of the magnetic bearings opened behind its sensor, the others closed, at {:.6g} "
      "rpm, {:.5g} to {:.5g} Hz: {}. Zones of ISO 14839-3:2006 for machines that are stable.",
      to_rpm(law_.speed), to_hz(grid_.front()), to_hz(grid_.back()), verdict());
  s_.finish(
      fmt::format("{} loops at {:.0f} rpm, {}", loops_.size(), to_rpm(law_.speed), verdict()));
}

}  // namespace

void run_sensitivity_step(run::Job& job, const model::Step& step,
                          const model::SensitivityStep& law) {
  SensitivityRun(job, step, law).execute();
}

}  // namespace whirl::steps
