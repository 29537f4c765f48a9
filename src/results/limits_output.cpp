// Where a motion in time leaves what its supports are known for: tables held beyond their ends
// (W12), films pressed further than they are believed (W03), gaps that small motions do not know
// (W11).
#include <analysis/transient/linear_motion.hpp>
#include <results/clearances.hpp>
#include <results/linear_limits.hpp>
#include <results/transient_output.hpp>
#include <run/support_diagnosis.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace whirl::results {

namespace {

/// What an extreme is reached by, and when.
struct Extreme {
  double value = 0, time = nan;
  void take(double x, double t) {
    if (!(x > value)) return;
    value = x;
    time = t;
  }
};

/// A quantity at the last look.
struct LastLook {
  double value = nan, time = nan;
  /// When it passed a limit, on its straight way to what it is now, s.
  double passed(double limit, double now, double t) const {
    if (std::isnan(value) || now == value) return t;
    return std::lerp(time, t, std::clamp((limit - value) / (now - value), 0.0, 1.0));
  }
};

/// The table of a bearing on its way.
struct WatchedTable {
  std::size_t bearing;
  Index node;                                 ///< of the shaft
  double low, high, slack;                    ///< rad/s: beyond these it is held, and rounding
  double begin = nan;                         ///< s: when it first went beyond; NaN: never
  double least = infinity, most = -infinity;  ///< rad/s, of the shaft over the run
  LastLook last{};
};

/// A gap or a film on its way.
struct Gap {
  std::size_t bearing;
  std::string name;
  Where where;
  std::function<double(const assembly::NodeAt&)> reach;  ///< m, what counts against the gap
  double size;                                           ///< m
  bool film, magnet;
  double limit;        ///< m: displacement beyond which the law is not believed; infinite: none
  Extreme largest{};   ///< m
  double begin = nan;  ///< s: when it first went beyond
  LastLook last{};
};

/// Looks at the end of every accepted step at the supports that have a limit, and at nothing else.
class LimitWatch final : public analysis::Observer {
 public:
  LimitWatch(const run::Job& job, bool small_motion);
  void begin(const analysis::Snapshot& s) override { look(s); }
  void step(analysis::StepAccess& s) override { look(s.end()); }
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  const std::vector<WatchedTable>& tables() const { return tables_; }
  const std::vector<Gap>& gaps() const { return gaps_; }
  bool empty() const { return tables_.empty() && gaps_.empty(); }

 private:
  void look(const analysis::Snapshot& s);
  std::vector<WatchedTable> tables_;
  std::vector<Gap> gaps_;
};

LimitWatch::LimitWatch(const run::Job& job, bool small_motion) {
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const auto* table = std::get_if<model::TableBearing>(&job.model.bearings[i].law);
    if (!table || table->speed.empty()) continue;
    const bool held = table->extrapolate_hold;
    tables_.push_back({i, job.mesh.bearings[i].shaft.node, held ? table->speed.front() : -infinity,
                       held ? table->speed.back() : infinity, table_slack(*table)});
  }
  const system::State still = job.system().make_state();
  system::Workspace w = job.system().make_workspace();
  job.system().evaluate_nodes(w, still.frames, still.t, still.q, still.v, still.a);
  const auto node = [&](Index n) -> const system::NodeState& { return w.in_own_axes(n); };
  for (const assembly::SupportCondition& c : job.built.conditions) {
    const assembly::SupportCondition::State x = c.state(node);
    const meshes::BearingNodes& nodes = job.mesh.bearings[c.bearing];
    if (!(x.gap > 0) || nodes.other.node < 0) continue;
    // a contact that closes is what it is for, unless the motion does not know it
    const double share = x.film                     ? assembly::SupportCondition::believed
                         : x.magnet || small_motion ? 1.0
                                                    : infinity;
    const auto apart = [nodes](const assembly::NodeAt& at) { return displacement_at(nodes, at); };
    gaps_.push_back({c.bearing, c.name, c.where,
                     c.reach ? c.reach : std::function<double(const assembly::NodeAt&)>(apart),
                     x.gap, x.film, x.magnet, share * x.gap});
  }
  for (const std::size_t b : seals_of(job.model)) {
    const meshes::BearingNodes nodes = job.mesh.bearings[b];
    const double gap = seal_gap(job.model.bearings[b]);
    gaps_.push_back({b, job.model.bearings[b].name, job.model.bearings[b].where,
                     [nodes](const assembly::NodeAt& at) { return displacement_at(nodes, at); },
                     gap, true, false, assembly::SupportCondition::believed * gap});
  }
}

void LimitWatch::look(const analysis::Snapshot& s) {
  for (WatchedTable& x : tables_) {
    const double spin = s.node(x.node).spin();
    x.least = std::min(x.least, spin);
    x.most = std::max(x.most, spin);
    if (std::isnan(x.begin) && (spin < x.low - x.slack || spin > x.high + x.slack))
      x.begin = x.last.passed(spin < x.low ? x.low : x.high, spin, s.t());
    x.last = {spin, s.t()};
  }
  const assembly::NodeAt node = [&s](Index n) -> const system::NodeState& { return s.node(n); };
  for (Gap& x : gaps_) {
    const double displacement = x.reach(node);
    x.largest.take(displacement, s.t());
    if (std::isnan(x.begin) && displacement > x.limit)
      x.begin = x.last.passed(x.limit, displacement, s.t());
    x.last = {displacement, s.t()};
  }
}

void LimitWatch::save(OutArchive& out) const {
  for (const WatchedTable& x : tables_)
    for (const double v : {x.begin, x.least, x.most, x.last.value, x.last.time})
      out.put(v);
  for (const Gap& x : gaps_)
    for (const double v : {x.begin, x.largest.value, x.largest.time, x.last.value, x.last.time})
      out.put(v);
}

void LimitWatch::restore(InArchive& in) {
  for (WatchedTable& x : tables_)
    for (double* v : {&x.begin, &x.least, &x.most, &x.last.value, &x.last.time})
      *v = in.number();
  for (Gap& x : gaps_)
    for (double* v : {&x.begin, &x.largest.value, &x.largest.time, &x.last.value, &x.last.time})
      *v = in.number();
}

class LimitsOutput final : public TransientOutput {
 public:
  explicit LimitsOutput(const TransientSetup& s) : watch_(s.job, s.law.linear) {
    if (s.motion) find_rest(s);
    if (s.job.model.output.report && !watch_.gaps().empty()) watch_stations(s.job);
    for (const WatchedTable& x : watch_.tables())
      content_ += fmt::format(" {} {} {}", x.bearing, x.low, x.high);
    for (const Gap& x : watch_.gaps())
      content_ += fmt::format(" {} {}", x.name, x.size);
  }
  bool empty() const { return watch_.empty(); }

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&watch_);
    parts.add({run::Part::limits, content_}, watch_);
    if (!stations_) return;
    observers.push_back(&*stations_);
    parts.add({run::Part::peaks, fmt::format("{} stations", stations_->peaks().size())},
              *stations_);
  }

  void report(TransientEnd& end) override {
    if (!stations_) return;
    std::vector<double> reach;
    for (const analysis::Peak& p : stations_->peaks())
      reach.push_back(p.amplitude);
    std::vector<UsedGap> used;
    for (const Gap& x : watch_.gaps())
      used.push_back(
          {x.bearing, x.size, x.largest.value,
           std::isnan(x.largest.time) ? "" : fmt::format("t = {:.5g} s", x.largest.time)});
    add_clearances(end.job, end.section, end.step.name + "_clearance_diagram", end.step.name, reach,
                   used);
  }

  void summarize(TransientEnd& end) override {
    judge_tables(end);
    std::vector<ShortFilm> films;
    for (std::size_t k = 0; k < watch_.gaps().size(); ++k) {
      const Gap& x = watch_.gaps()[k];
      if (k < at_rest_.size()) judge_share(end, x, at_rest_[k]);
      judge_gap(end, x);
      if (x.film) films.push_back({x.bearing, x.largest.value / x.size});
    }
    warn_of_short_bearings(end.job, end.step.name, films);
  }

 private:
  void watch_stations(const run::Job& job) {
    std::vector<std::pair<std::string, analysis::Point>> points;
    for (const analysis::Point& p : station_points(job))
      points.emplace_back("", p);
    stations_.emplace(std::move(points), job.reference());
  }
  /// Displacements of the motion that small ones are about.
  void find_rest(const TransientSetup& s);
  void judge_tables(TransientEnd& end) const;
  static void judge_share(TransientEnd& end, const Gap& x, double at_rest);
  static void judge_gap(TransientEnd& end, const Gap& x);

  std::string content_;
  LimitWatch watch_;
  std::vector<double> at_rest_;                    ///< of the gaps, m; of a linear step alone
  std::optional<analysis::PeakTracker> stations_;  ///< for the clearance diagram
};

void LimitsOutput::find_rest(const TransientSetup& s) {
  const system::State& start = s.start.state;
  system::Workspace w = s.job.system().make_workspace();
  VecX q(start.q.size());
  s.motion->steady(start.t, q);
  if (!s.job.system().evaluate_nodes(w, start.frames, start.t, q, s.motion->steady_rates(),
                                     VecX::Zero(q.size())))
    return;
  const auto node = [&](Index n) -> const system::NodeState& { return w.in_own_axes(n); };
  for (const Gap& x : watch_.gaps())
    at_rest_.push_back(x.reach(node));
}

/// Coefficients of small motions, and a motion that is not small against the film.
void LimitsOutput::judge_share(TransientEnd& end, const Gap& x, double at_rest) {
  if (!x.film || !(x.size > at_rest)) return;
  const double share = std::max(0.0, (x.largest.value - at_rest) / (x.size - at_rest));
  end.summary["gaps"][x.name]["share of the film that the motion takes"] = share;
  if (share <= small_in_film || !std::isnan(x.begin)) return;  // beyond: judge_gap
  Diagnostic d;
  d.code = "W11";
  d.message = fmt::format(
      "step '{}': at t = {:.6g} s the motion takes {:.2g} of the film that the equilibrium leaves "
      "in '{}' "
      "({:.4g} of {:.4g} mm from its middle): its coefficients are those of small motions",
      end.step.name, x.largest.time, share, x.name, 1e3 * x.largest.value, 1e3 * x.size);
  d.hint = "without linear = true the step meets the film as it is";
  d.where = x.where;
  warn(end.job, std::move(d));
}

void LimitsOutput::judge_tables(TransientEnd& end) const {
  const WatchedTable* worst = nullptr;
  double most = 0;
  std::string held;
  std::vector<UsedTable> used;
  for (const WatchedTable& x : watch_.tables()) {
    used.push_back({x.bearing, x.least, x.most});
    if (std::isnan(x.begin)) continue;
    const std::string& name = end.job.model.bearings[x.bearing].name;
    io::Value& v = end.summary["held tables"][name];
    v["from [s]"] = x.begin;
    v["table from [rpm]"] = to_rpm(x.low);
    v["table to [rpm]"] = to_rpm(x.high);
    v["slowest [rpm]"] = to_rpm(x.least);
    v["fastest [rpm]"] = to_rpm(x.most);
    held += fmt::format("{}'{}'", held.empty() ? "" : ", ", name);
    const double beyond = std::max(x.low - x.least, x.most - x.high);
    if (beyond <= most) continue;
    most = beyond;
    worst = &x;
  }
  warn_of_coarse_tables(end.job, end.step.name, used);
  if (!worst) return;
  const model::Bearing& b = end.job.model.bearings[worst->bearing];
  Diagnostic d;
  d.code = "W12";
  d.message = fmt::format(
      "step '{}': the coefficients at the edge of their tables are held beyond them for {}; most "
      "for '{}', from t = {:.6g} s, whose table covers {:.6g} to {:.6g} rpm and whose shaft turns "
      "at {:.6g} to {:.6g} rpm",
      end.step.name, held, b.name, worst->begin, to_rpm(worst->low), to_rpm(worst->high),
      to_rpm(worst->least), to_rpm(worst->most));
  d.hint = "a table over all speeds of the step, or extrapolate = \"error\"";
  d.where = b.where;
  warn(end.job, std::move(d));
}

void LimitsOutput::judge_gap(TransientEnd& end, const Gap& x) {
  io::Value& v = end.summary["gaps"][x.name];
  v["gap [m]"] = x.size;
  v["largest displacement [m]"] = x.largest.value;
  v["at [s]"] = x.largest.time;
  if (std::isnan(x.begin)) return;
  v["beyond from [s]"] = x.begin;
  Diagnostic d;
  d.where = x.where;
  if (end.law.linear) {
    d.code = "W11";
    d.message = fmt::format(
        "step '{}': at t = {:.6g} s the shaft is {:.4g} mm from the middle of '{}', whose {} is "
        "{:.4g} mm ({:.3g} times; first beyond at t = {:.6g} s): linear motion does not know it",
        end.step.name, x.largest.time, 1e3 * x.largest.value, x.name, x.film ? "clearance" : "gap",
        1e3 * x.size, x.largest.value / x.size, x.begin);
    d.hint = "without linear = true the step meets the contact or the film as it is";
  } else if (x.magnet) {
    d.code = "W03";
    d.message = fmt::format(
        "step '{}': the shaft would move {:.4g} mm from the middle of magnetic bearing '{}' (at t "
        "= "
        "{:.6g} s; first beyond its air gap of {:.4g} mm at t = {:.6g} s): it hits the poles, "
        "which "
        "the force of the magnet does not know",
        end.step.name, 1e3 * x.largest.value, x.name, x.largest.time, 1e3 * x.size, x.begin);
    d.hint =
        "a catcher bearing (type = \"rub\") with less play than the air gap, or a stiffer "
        "controller";
  } else {
    d.code = "W03";
    d.message = fmt::format(
        "step '{}': bearing '{}' runs at eccentricities up to {:.5f} (at t = {:.6g} s; first "
        "beyond "
        "at t = {:.6g} s): its film is believed up to {}",
        end.step.name, x.name, x.largest.value / x.size, x.largest.time, x.begin,
        assembly::SupportCondition::believed);
    d.hint = run::pressed_film_hint;
  }
  warn(end.job, std::move(d));
}

}  // namespace

void add_limits(const TransientSetup& setup, TransientOutputs& outputs) {
  auto limits = std::make_unique<LimitsOutput>(setup);
  if (!limits->empty()) outputs.push_back(std::move(limits));
}

}  // namespace whirl::results
