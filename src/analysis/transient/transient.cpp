#include <core/contract.hpp>
#include <analysis/transient/corners.hpp>
#include <analysis/transient/level_passages.hpp>
#include <analysis/transient/momentum_route.hpp>
#include <analysis/transient/transient.hpp>

#include <core/interrupt.hpp>
#include <core/stopwatch.hpp>
#include <core/rotation.hpp>
#include <time/event.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

namespace whirl::analysis {

std::string_view to_string(StopReason r) {
  switch (r) {
    case StopReason::end_time: return "end time reached";
    case StopReason::speed_reached: return "stop speed reached";
    case StopReason::amplitude_limit: return "amplitude limit exceeded";
    case StopReason::interrupted: return "interrupted";
    case StopReason::failed: return "failed";
  }
  return "";
}

namespace {

constexpr double least_wait = 0.5;    // seconds an interruption waits for the next mark in any case
constexpr double longest_wait = 3.0;  // and at most
constexpr double keep_every = 2.0;    // seconds at least between states that are kept

/// The integrator's last step as observers see it.
class StepDense final : public StepAccess {
 public:
  /// look: called before every evaluation; throws to stop.
  StepDense(system::SystemProblem& p, time::Integrator& i, std::function<void()> look)
      : problem_(p),
        integrator_(i),
        look_(std::move(look)),
        snapshot_(p),
        q_(p.size()),
        v_(p.size()),
        a_(p.size()),
        some_q_(p.size()),
        some_v_(p.size()),
        some_a_(p.size()),
        of_node_(p.system().make_workspace()),
        fixed_(at_(p.size()), 0) {
    for (const system::Hold& h : p.system().holds())
      if (!h.law) fixed_[at_(h.unknown)] = 1;
    for (const Index node : p.system().exchanging_nodes())
      for (Index c = 0; c < 6; ++c)
        exchanging_.push_back(6 * node + c);
  }
  void set(double t0, double t1) {
    t0_ = t0;
    t1_ = t1;
    at_end_ = false;
    inside_ = nan;
  }
  double t0() const override { return t0_; }
  double t1() const override { return t1_; }
  const Snapshot& at(double t) override {
    look_();
    if (t >= t1_) {
      // the end state itself, evaluated once however many observers ask
      if (!at_end_) snapshot_.set(t1_, integrator_.q(), integrator_.v(), integrator_.a());
      at_end_ = true;
      inside_ = nan;
    } else if (t != inside_) {
      integrator_.interpolate(t, q_, v_, a_);
      snapshot_.set(t, q_, v_, a_);
      at_end_ = false;
      inside_ = t;
    }
    return snapshot_;
  }
  time::Problem::Power exchange(double t) override {
    if (problem_.power_needs_reactions() || !exchanging_alone(t)) return at(t).exchange();
    return problem_.exchange_here(v_, a_);  // which reads no reactions
  }
  double dissipation(double t) override {
    if (!exchanging_alone(t)) return at(t).dissipation();
    return problem_.system().exchange(problem_.workspace()).dissipated;
  }
  std::optional<double> residual_work() override {
    return t1_ > t0_ ? integrator_.residual_work() : std::nullopt;
  }
  void displacements(double t, std::span<const Point> points, std::vector<Vec2>& out) override {
    if (!alone(t, points, out)) lateral(at(t), points, out);
  }

  Angle angle(double t, Index node) override {
    const Index unknown = 6 * node + system::spin_phi;
    if (!apart() || !interpolate_some(t, std::span(&unknown, 1))) return StepAccess::angle(t, node);
    const double turns = snapshot_.frames().turns[at_(snapshot_.system().node(node).line)];
    return {some_q_[unknown] + two_pi * turns, some_v_[unknown]};
  }
  double spin(double t, Index node) override {
    if (t >= t1_ || !apart()) return StepAccess::spin(t, node);
    const std::array<Index, 6> own{6 * node,     6 * node + 1, 6 * node + 2,
                                   6 * node + 3, 6 * node + 4, 6 * node + 5};
    if (!interpolate_some(t, own) ||
        !problem_.system().evaluate_some(of_node_, problem_.frames, t, some_q_, some_v_, some_a_,
                                         std::span(&node, 1)))
      return StepAccess::spin(t, node);
    return of_node_.nodes[at_(node)].spin();
  }

 private:
  static std::size_t at_(Index i) { return static_cast<std::size_t>(i); }

  /// Evaluates the nodes that supply or dissipate power at t, and no others; false where that is not
  /// enough.
  bool exchanging_alone(double t) {
    if (exchanging_.empty() || t >= t1_ || snapshot_.frames().moved()) return false;
    look_();
    if (!integrator_.interpolate_some(t, exchanging_, q_, v_, a_)) return false;
    at_end_ = false;
    inside_ = nan;
    return problem_.system().evaluate_exchanging(problem_.workspace(), problem_.frames, t, q_, v_,
                                                 a_);
  }

  /// Nodes can be looked at one by one: none follows others, and their charts are those of the lines.
  bool apart() const {
    return !snapshot_.frames().moved() && snapshot_.system().followers().empty();
  }
  /// These unknowns, and those held, into some_q_, some_v_, some_a_ (the others mean nothing); false
  /// where that is not cheaper than all.
  bool interpolate_some(double t, std::span<const Index> entries) {
    const double within = std::min(t, t1_);
    if (integrator_.interpolate_some(within, entries, some_q_, some_v_, some_a_)) return true;
    if (within != t0_ && within != t1_) return false;
    integrator_.interpolate(within, some_q_, some_v_, some_a_);
    return true;
  }

  /// The unknowns of these points alone; false where that is not enough.
  bool alone(double t, std::span<const Point> points, std::vector<Vec2>& out) {
    if (!apart()) return false;
    if (!std::equal(points.begin(), points.end(), asked_.begin(), asked_.end()))
      list_entries(points);
    if (!integrator_.interpolate_entries(std::min(t, t1_), entries_, values_)) return false;
    out.resize(points.size());
    const auto value = [&](Index place) { return place < 0 ? 0.0 : values_[place]; };
    rotation::Director d;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Places& p = places_[i];
      out[i].x() = value(p.y);
      out[i].y() = value(p.z);
      if (points[i].offset == 0.0) continue;
      const Vec2 gamma(value(p.gamma2), value(p.gamma3));
      rotation::director(gamma, d);
      const Vec3 tilt = snapshot_.frames().axes(points[i].node) * d.t;
      out[i] += points[i].offset * tilt.tail<2>();
    }
    return true;
  }
  /// What the points ask the integrator for: y and z, and the tilt of those beside their node, but
  /// what is held at zero.
  void list_entries(std::span<const Point> points) {
    asked_.assign(points.begin(), points.end());
    entries_.clear();
    places_.clear();
    const auto ask = [this](Index unknown) -> Index {
      if (fixed_[at_(unknown)]) return -1;
      entries_.push_back(unknown);
      return static_cast<Index>(entries_.size()) - 1;
    };
    for (const Point& p : points) {
      const Index first = 6 * p.node;
      Places& place = places_.emplace_back();
      place.y = ask(first + system::uy);
      place.z = ask(first + system::uz);
      if (p.offset == 0.0) continue;
      place.gamma2 = ask(first + system::gamma2);
      place.gamma3 = ask(first + system::gamma3);
    }
    values_.resize(static_cast<Index>(entries_.size()));
  }

  /// Where the values of a point stand among those asked for; -1: held at zero, or not asked for.
  struct Places {
    Index y = -1, z = -1, gamma2 = -1, gamma3 = -1;
  };

  system::SystemProblem& problem_;
  time::Integrator& integrator_;
  std::function<void()> look_;
  Snapshot snapshot_;
  VecX q_, v_, a_;
  VecX some_q_, some_v_, some_a_;     ///< of some unknowns, beside what the snapshot is of
  system::Workspace of_node_;         ///< of a node looked at alone
  std::vector<unsigned char> fixed_;  ///< unknowns held at zero
  std::vector<Point> asked_;          ///< the points that were asked for last, ..
  std::vector<Places> places_;        ///< .. where their values stand, ..
  std::vector<Index> entries_;        ///< .. and of which unknowns these are
  VecX values_;
  std::vector<Index> exchanging_;  ///< unknowns of System::exchanging_nodes
  double t0_ = 0, t1_ = 0;
  bool at_end_ = false;  ///< the snapshot is the step's end ..
  double inside_ = nan;  ///< .. or this instant of the step
};

/// First time in the step where f changes sign, or infinity; last: see time::EventLocator.
template <class F>
double crossing(StepDense& step, F&& f, double& last) {
  static constexpr time::EventLocator locator(time::quarters, {1e-18, 1e-14});
  double first = infinity;
  locator.sign_changes(
      step.t0(), step.t1(), last, [&](double t) { return f(step.at(t)); },
      [&](const time::Passage& passage, bool) {
        first = passage.after;
        return false;
      });
  return first;
}

std::string failure(const system::SystemProblem& problem, const time::StepReport& report) {
  std::string text = fmt::format("at t = {:.9g} s: {}", report.t0, time::message(report.status));
  if (problem.outside() >= 0)
    text += fmt::format("; tilt of {} at the limit of its chart ({} rad of pi)",
                        problem.system().node(problem.outside()).name, rotation::chart_limit);
  else if (const std::string s = problem.singular_unknown();
           report.status == time::StepStatus::singular && !s.empty())
    text += "; nothing determines " + s;
  return text;
}

/// One transient: the integrator, its last step, and what is watched in it.
class Run {
 public:
  Run(system::SystemProblem& problem, const system::State& start, const TransientOptions& options,
      const std::vector<Observer*>& observers, const time::IntegratorState* resume)
      : problem_(problem),
        options_(options),
        observers_(observers),
        integrator_(make_started(problem, start, options, resume)),
        step_(problem, *integrator_, [this] { stop_when_interrupted(); }),
        corners_(problem) {
    step_.set(integrator_->time(), integrator_->time());
    for (Observer* o : resume ? options.new_observers : observers)
      o->begin(step_.end());
    for (const SpeedStop& s : options.speed_stops) {
      speed_stops_.emplace_back(s.reach, s.hold);
      const double g = beyond(step_.end(), s);
      speed_stops_.back().begin(g, resume && std::abs(g) > s.reach);
    }
    // what begins beyond its limit stops at once
    constexpr double just_within = -1e-300;
    for (const AmplitudeStop& s : options.amplitude_stops)
      amplitude_before_.push_back(std::min(beyond(step_.end(), s), just_within));
    // equal steps are the user's own choice, and the momentum form knows no contacts
    land_on_corners_ =
        corners_.any() && options.integrator.dt_fixed <= 0.0 && options.method != "momentum_rk";
    progress_ = {integrator_->time(), t_end(), 0, 0, 0, 0};
  }

  TransientResult go() {
    bool between_marks = false;
    try {
      while (!stop_ && integrator_->time() < t_end())
        if (!make_step()) break;
    } catch (const Interrupted&) {
      result_.reason = StopReason::interrupted;
      between_marks = true;
    }
    if (between_marks && options_.fall_back) options_.fall_back();
    if (options_.checkpoint && !between_marks && result_.reason != StopReason::failed) {
      const time::IntegratorState s = integrator_->save();
      options_.checkpoint(state_now(), s);
    }
    result_.end = state_now();
    result_.end.frames.hold_kept(result_.end.t);
    result_.statistics = integrator_->judged_statistics();
    for (Observer* o : observers_)
      o->end();
    return std::move(result_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  static std::unique_ptr<time::Integrator> make_started(system::SystemProblem& problem,
                                                        const system::State& start,
                                                        const TransientOptions& options,
                                                        const time::IntegratorState* resume) {
    problem.frames = start.frames;
    auto integrator = options.method == "momentum_rk"
                          ? make_momentum_integrator(problem, options.integrator)
                          : time::make_integrator(options.method, problem, options.integrator);
    if (resume)
      integrator->restore(*resume);
    else
      integrator->start(start.t, start.q, start.v);
    return integrator;
  }

  double t_end() const { return options_.integrator.t_end; }
  system::State state_now() const {
    return {integrator_->time(), integrator_->q(), integrator_->v(), integrator_->a(),
            problem_.frames};
  }

  static double seconds_since(Clock::time_point t) {
    return std::chrono::duration<double>(Clock::now() - t).count();
  }
  bool interrupted() const {
    return options_.interrupt && options_.interrupt->load(std::memory_order_relaxed);
  }
  /// Seconds to the next mark, were the steps to it like those since the last one.
  double seconds_to_mark() const {
    const double between = static_cast<double>(std::max(options_.steps_between_marks, 1L));
    const double made = std::fmod(static_cast<double>(integrator_->statistics().accepted), between);
    return seconds_since(last_mark_) / std::max(made, 0.5) * (between - made);
  }
  void stop_when_interrupted() const {
    if (interrupted() && seconds_since(last_mark_) > least_wait && seconds_to_mark() > longest_wait)
      throw Interrupted();
  }

  /// Whether the step was made; else the reason is in the result.
  bool accepted(const time::StepReport& report) {
    if (report.ok()) return true;
    result_.reason = StopReason::failed;
    result_.detail = failure(problem_, report);
    return false;
  }

  /// One step with all that watches it; false: the run ends here.
  bool make_step() {
    if (options_.steps_between_marks == 0 && interrupted()) {
      result_.reason = StopReason::interrupted;
      return false;
    }
    if (land_on_corners_) {
      step_.end();
      corners_.begin();
    }
    time::StepReport report = integrator_->advance();
    if (!accepted(report)) return false;
    step_.set(report.t0, report.t1);
    const bool corner = land_on_corners_ && land_on_corner(report);
    if (!accepted(report) || !land_on_stop(report)) return false;
    for (Observer* o : observers_)
      o->step(step_);
    if (stop_ && stopping_event_)
      for (Observer* o : observers_)
        o->stopped(step_.end(), *stopping_event_);
    // the state after a corner stands just before it: the matrices of the other side are taken a
    // step later
    if (passed_) integrator_->refresh();
    passed_ = corner;
    if (options_.between_steps) options_.between_steps(report.t1, problem_.frames);
    if (corner) {
      // what was smooth before says nothing about what comes
      integrator_->restart(VecX(integrator_->q()), VecX(integrator_->v()), true);
      step_.set(report.t1, report.t1);
    }
    tell_progress(report);
    return !at_mark() || make_mark(report);
  }

  /// A step that straddles a corner is wrong before it too: made again to the passage, and if it
  /// still passes inside, ever shorter, until it is smooth. The next one then begins closer.
  /// Returns whether the step ends on the corner.
  bool land_on_corner(time::StepReport& report) {
    bool corner = false;
    for (int again = 0; again < 60; ++again) {
      const double passage = corners_.find(step_);
      if (passage < 0.0) break;
      corner = again == 0;
      if (passage >= report.t1) break;
      const double t = corner ? passage : report.t0 + 0.7 * (passage - report.t0);
      report = integrator_->shorten_to(t);
      if (!report.ok()) {
        // as far towards it as Newton's iteration goes
        integrator_->set_end(t);
        report = integrator_->advance();
        integrator_->set_end(t_end());
        corner = false;
        if (!report.ok()) break;
      }
      step_.set(report.t0, report.t1);
    }
    return corner;
  }

  /// m, by which a place is beyond the limit of a stop.
  static double beyond(const Snapshot& x, const AmplitudeStop& s) {
    return displacement(x, s.point).tail<2>().norm() - s.limit;
  }

  /// rad/s, by which a spin is above that of a stop.
  static double beyond(const Snapshot& x, const SpeedStop& s) {
    const double spin = s.angle ? s.angle->at(x.t()).df : x.node(s.node).spin();
    return spin - s.speed;
  }
  /// First passage of a speed in the step, or infinity.
  double first_passage(const SpeedStop& s, LevelPassages& passages) {
    static constexpr time::EventLocator locator(time::quarters, {1e-18, 1e-14});
    double first = infinity;
    passages.search(
        locator, step_.t0(), step_.t1(), [&](double t) { return beyond(step_.at(t), s); },
        [&](double t, bool) {
          // one that turned out to be none of rounding later than its step ends the run now
          first = t > step_.t0() ? t : step_.t1();
          return false;
        });
    return first;
  }
  /// First passage of a stop in the step, or infinity; what stopped is in the result.
  double first_stop() {
    double t_stop = infinity;
    for (std::size_t i = 0; i < options_.speed_stops.size(); ++i) {
      const SpeedStop& s = options_.speed_stops[i];
      const double t = first_passage(s, speed_stops_[i]);
      if (t < t_stop) {
        t_stop = t;
        stopping_event_ = s.event;
        result_.reason = StopReason::speed_reached;
        result_.detail = fmt::format("spin of {:.6g} rpm at t = {:.9g} s", to_rpm(s.speed), t);
      }
    }
    for (std::size_t i = 0; i < options_.amplitude_stops.size(); ++i) {
      const AmplitudeStop& s = options_.amplitude_stops[i];
      auto f = [&](const Snapshot& x) { return beyond(x, s); };
      const double t = crossing(step_, f, amplitude_before_[i]);
      if (t < t_stop) {
        t_stop = t;
        stopping_event_ = s.event;
        result_.reason = StopReason::amplitude_limit;
        result_.detail = fmt::format("{} passes {:.4g} m at t = {:.9g} s", s.name, s.limit, t);
      }
    }
    return t_stop;
  }

  /// Ends the step, and the run with it, where a stop is passed; false: it cannot be shortened.
  bool land_on_stop(time::StepReport& report) {
    const double t_stop = first_stop();
    if (!(t_stop < infinity)) return true;
    stop_ = true;
    if (!(t_stop < report.t1 && t_stop > report.t0)) return true;
    report = integrator_->shorten_to(t_stop);
    if (!accepted(report)) return false;
    step_.set(report.t0, report.t1);
    return true;
  }

  void tell_progress(const time::StepReport& report) {
    if (!options_.progress) return;
    progress_.t = report.t1;
    progress_.dt = report.t1 - report.t0;
    ++progress_.steps;
    progress_.newton = integrator_->statistics().newton_iterations;
    progress_.spin = step_.end().node(options_.reference).spin();
    options_.progress(progress_);
  }

  bool at_mark() const {
    return options_.steps_between_marks > 0 &&
           integrator_->statistics().accepted % options_.steps_between_marks == 0;
  }
  /// The matrices are made anew, and what asks for it is saved; false: interrupted.
  bool make_mark(const time::StepReport& report) {
    const time::IntegratorState s = integrator_->save();
    if (interrupted() && !stop_ && report.t1 < t_end()) {
      result_.reason = StopReason::interrupted;
      return false;
    }
    if (options_.checkpoint && seconds_since(last_checkpoint_) >= options_.checkpoint_seconds) {
      options_.checkpoint(state_now(), s);
      last_checkpoint_ = Clock::now();
    }
    if (options_.keep && seconds_since(last_kept_) > keep_every) {
      options_.keep(state_now(), s);
      last_kept_ = Clock::now();
    }
    last_mark_ = Clock::now();
    return true;
  }

  system::SystemProblem& problem_;
  const TransientOptions& options_;
  const std::vector<Observer*>& observers_;
  std::unique_ptr<time::Integrator> integrator_;
  // what the steps themselves call may not unwind: the loop looks for interruptions
  interrupt::Shield shield_;
  Clock::time_point last_checkpoint_ = Clock::now(), last_mark_ = last_checkpoint_,
                    last_kept_ = last_checkpoint_;
  StepDense step_;
  Corners corners_;
  std::vector<LevelPassages> speed_stops_;  ///< one a stop
  std::vector<double> amplitude_before_;
  std::optional<std::size_t> stopping_event_;
  bool land_on_corners_ = false;
  bool passed_ = false;  ///< the step before ended on a corner
  bool stop_ = false;
  Progress progress_;
  TransientResult result_;
};

}  // namespace

TransientResult run_transient(system::SystemProblem& problem, const system::State& start,
                              const TransientOptions& options,
                              const std::vector<Observer*>& observers,
                              const time::IntegratorState* resume) {
  WHIRL_EXPECTS(start.q.size() == problem.size() && start.v.size() == problem.size());
  WHIRL_EXPECTS(std::find(observers.begin(), observers.end(), nullptr) == observers.end());
  WHIRL_EXPECTS(options.reference >= 0 && options.reference < problem.system().nodes());
  const double cpu0 = thread_cpu_seconds();
  TransientResult result = Run(problem, start, options, observers, resume).go();
  result.seconds = thread_cpu_seconds() - cpu0;
  return result;
}

}  // namespace whirl::analysis
