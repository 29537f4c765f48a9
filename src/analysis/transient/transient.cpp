#include <core/contract.hpp>
#include <analysis/transient/corners.hpp>
#include <analysis/transient/momentum_route.hpp>
#include <analysis/transient/transient.hpp>

#include <core/interrupt.hpp>
#include <core/stopwatch.hpp>
#include <core/rotation.hpp>
#include <time/event.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>

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
      : integrator_(i),
        look_(std::move(look)),
        snapshot_(p),
        q_(p.size()),
        v_(p.size()),
        a_(p.size()) {}
  void set(double t0, double t1) {
    t0_ = t0;
    t1_ = t1;
    at_end_ = false;
  }
  double t0() const override { return t0_; }
  double t1() const override { return t1_; }
  const Snapshot& at(double t) override {
    look_();
    if (t >= t1_) {
      // the end state itself, evaluated once however many observers ask
      if (!at_end_) snapshot_.set(t1_, integrator_.q(), integrator_.v(), integrator_.a());
      at_end_ = true;
    } else {
      integrator_.interpolate(t, q_, v_, a_);
      snapshot_.set(t, q_, v_, a_);
      at_end_ = false;
    }
    return snapshot_;
  }

 private:
  time::Integrator& integrator_;
  std::function<void()> look_;
  Snapshot snapshot_;
  VecX q_, v_, a_;
  double t0_ = 0, t1_ = 0;
  bool at_end_ = false;
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

}  // namespace

TransientResult run_transient(system::SystemProblem& problem, const system::State& start,
                              const TransientOptions& options,
                              const std::vector<Observer*>& observers,
                              const time::IntegratorState* resume) {
  WHIRL_EXPECTS(start.q.size() == problem.size() && start.v.size() == problem.size());
  WHIRL_EXPECTS(std::find(observers.begin(), observers.end(), nullptr) == observers.end());
  WHIRL_EXPECTS(options.reference >= 0 && options.reference < problem.system().nodes());
  TransientResult result;
  const double cpu0 = thread_cpu_seconds();
  problem.frames = start.frames;
  auto integrator = options.method == "momentum_rk"
                        ? make_momentum_integrator(problem, options.integrator)
                        : time::make_integrator(options.method, problem, options.integrator);
  if (resume)
    integrator->restore(*resume);
  else
    integrator->start(start.t, start.q, start.v);
  // what the steps themselves call may not unwind: this loop looks for interruptions
  const interrupt::Shield shield;
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point t) {
    return std::chrono::duration<double>(Clock::now() - t).count();
  };
  auto last_checkpoint = Clock::now(), last_mark = last_checkpoint, last_kept = last_checkpoint;
  const auto interrupted = [&] {
    return options.interrupt && options.interrupt->load(std::memory_order_relaxed);
  };
  // Seconds to the next mark, were the steps to it like those since the last one.
  const auto seconds_to_mark = [&] {
    const double between = static_cast<double>(std::max(options.steps_between_marks, 1L));
    const double made = std::fmod(static_cast<double>(integrator->statistics().accepted), between);
    return seconds_since(last_mark) / std::max(made, 0.5) * (between - made);
  };
  StepDense step(problem, *integrator, [&] {
    if (interrupted() && seconds_since(last_mark) > least_wait && seconds_to_mark() > longest_wait)
      throw Interrupted();
  });

  auto state_now = [&] {
    return system::State{integrator->time(), integrator->q(), integrator->v(), integrator->a(),
                         problem.frames};
  };
  step.set(integrator->time(), integrator->time());
  for (Observer* o : resume ? options.new_observers : observers)
    o->begin(step.end());

  std::vector<double> speed_before(options.speed_stops.size());
  for (std::size_t i = 0; i < speed_before.size(); ++i)
    speed_before[i] =
        step.end().node(options.speed_stops[i].node).spin() - options.speed_stops[i].speed;

  const double t_end = options.integrator.t_end;
  // equal steps are the user's own choice, and the momentum form knows no contacts
  Corners corners(problem);
  bool passed = false;
  const bool land_on_corners =
      corners.any() && options.integrator.dt_fixed <= 0.0 && options.method != "momentum_rk";

  Progress progress{integrator->time(), t_end, 0, 0, 0, 0};
  bool stop = false, between_marks = false;
  try {
    while (!stop && integrator->time() < t_end) {
      if (options.steps_between_marks == 0 && interrupted()) {
        result.reason = StopReason::interrupted;
        break;
      }
      if (land_on_corners) {
        step.end();
        corners.begin();
      }
      time::StepReport report = integrator->advance();
      if (!report.ok()) {
        result.reason = StopReason::failed;
        result.detail = failure(problem, report);
        break;
      }
      step.set(report.t0, report.t1);
      bool corner = false;
      if (land_on_corners) {
        // A step that straddles a corner is wrong before it too: made again to the passage, and if
        // it still passes inside, ever shorter, until it is smooth. The next one then begins
        // closer.
        for (int again = 0; again < 60; ++again) {
          const double passage = corners.find(step);
          if (passage < 0.0) break;
          corner = again == 0;
          if (passage >= report.t1) break;
          const double t = corner ? passage : report.t0 + 0.7 * (passage - report.t0);
          report = integrator->shorten_to(t);
          if (!report.ok()) {
            // as far towards it as Newton's iteration goes
            integrator->set_end(t);
            report = integrator->advance();
            integrator->set_end(t_end);
            corner = false;
            if (!report.ok()) break;
          }
          step.set(report.t0, report.t1);
        }
        if (!report.ok()) {
          result.reason = StopReason::failed;
          result.detail = failure(problem, report);
          break;
        }
      }

      double t_stop = infinity;
      for (std::size_t i = 0; i < options.speed_stops.size(); ++i) {
        const SpeedStop& s = options.speed_stops[i];
        auto f = [&](const Snapshot& x) { return x.node(s.node).spin() - s.speed; };
        const double t = crossing(step, f, speed_before[i]);
        if (t < t_stop) {
          t_stop = t;
          result.reason = StopReason::speed_reached;
          result.detail = fmt::format("spin of {:.6g} rpm at t = {:.9g} s", to_rpm(s.speed), t);
        }
      }
      for (const AmplitudeStop& s : options.amplitude_stops) {
        auto f = [&](const Snapshot& x) {
          return displacement(x, s.point).tail<2>().norm() - s.limit;
        };
        double within = -1.0;
        const double t = crossing(step, f, within);
        if (t < t_stop) {
          t_stop = t;
          result.reason = StopReason::amplitude_limit;
          result.detail = fmt::format("{} passes {:.4g} m at t = {:.9g} s", s.name, s.limit, t);
        }
      }
      if (t_stop < infinity) {
        stop = true;
        if (t_stop < report.t1 && t_stop > report.t0) {
          report = integrator->shorten_to(t_stop);
          if (!report.ok()) {
            result.reason = StopReason::failed;
            result.detail = failure(problem, report);
            break;
          }
          step.set(report.t0, report.t1);
        }
      }

      for (Observer* o : observers)
        o->step(step);
      // the state after a corner stands just before it: the matrices of the other side are taken a
      // step later
      if (passed) integrator->refresh();
      passed = corner;
      if (corner) {
        // what was smooth before says nothing about what comes
        integrator->restart(VecX(integrator->q()), VecX(integrator->v()), true);
        step.set(report.t1, report.t1);
      }
      if (options.progress) {
        progress.t = report.t1;
        progress.dt = report.t1 - report.t0;
        ++progress.steps;
        progress.newton = integrator->statistics().newton_iterations;
        progress.spin = step.end().node(options.reference).spin();
        options.progress(progress);
      }
      if (options.steps_between_marks > 0 &&
          integrator->statistics().accepted % options.steps_between_marks == 0) {
        const time::IntegratorState s = integrator->save();
        if (interrupted() && !stop && report.t1 < t_end) {
          result.reason = StopReason::interrupted;
          break;
        }
        if (options.checkpoint && seconds_since(last_checkpoint) >= options.checkpoint_seconds) {
          options.checkpoint(state_now(), s);
          last_checkpoint = Clock::now();
        }
        if (options.keep && seconds_since(last_kept) > keep_every) {
          options.keep(state_now(), s);
          last_kept = Clock::now();
        }
        last_mark = Clock::now();
      }
    }
  } catch (const Interrupted&) {
    result.reason = StopReason::interrupted;
    between_marks = true;
  }
  if (between_marks && options.fall_back) options.fall_back();
  if (options.checkpoint && !between_marks && result.reason != StopReason::failed) {
    const time::IntegratorState s = integrator->save();
    options.checkpoint(state_now(), s);
  }
  result.end = state_now();
  result.statistics = integrator->statistics();
  for (Observer* o : observers)
    o->end();
  result.seconds = thread_cpu_seconds() - cpu0;
  return result;
}

}  // namespace whirl::analysis
