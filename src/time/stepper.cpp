#include <time/stepper.hpp>
#include <core/contract.hpp>
#include <time/hermite.hpp>

#include <core/error.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace whirl::time {
namespace {
/// A stop this close to the step's end (relative to the step) is the step's end: no slivers of a
/// step remain.
constexpr double landing_slack = 1e-9;
}  // namespace

Stepper::Stepper(Problem& problem, const Options& options)
    : problem_(problem),
      options_(options),
      n_(problem.size()) {
  WHIRL_EXPECTS(problem.kinds().size() == at(n_));
  WHIRL_EXPECTS(options.tolerance > 0.0 && options.max_attempts > 0);
  scale_.resize(problem.kinds(), options.scales);
  if (options.dt_fixed > 0.0) scale_.keep_errors();
  initial_.resize(problem);
  for (Index i = 0; i < n_; ++i)
    if (problem.kinds()[at(i)] == Kind::held) held_.push_back(i);
  for (VecX* x : {&q0_, &v0_, &a0_, &q_, &v_, &a_, &q0_low_, &v0_low_, &q_low_, &v_low_})
    *x = VecX::Zero(n_);
  set_breakpoints(options.breakpoints);
}

// ---------------------------------------------------------------------------------------------------------------------
// Start and discontinuities

void Stepper::start(double t, CRef q, CRef v) {
  WHIRL_EXPECTS(std::isfinite(t));
  WHIRL_EXPECTS(q.size() == n_ && v.size() == n_);
  statistics_ = {};
  longest_ = rate_span_ = rate_steps_ = 0.0;
  t_ = t0_ = t1_eval_ = t;
  t_low_ = t0_low_ = 0.0;
  h_ = h_next_ = 0.0;
  have_step_ = accept_pending_ = at_break_ = false;
  q_ = q;
  v_ = v;
  a_.setZero();
  q_low_.setZero();
  v_low_.setZero();
  problem_.impose(t, q_, v_, a_);
  after_discontinuity(false);
  scale_.reset(q_);
  // polar inertia lumped by row: M times a unit spin acceleration of everything
  const auto kinds = problem_.kinds();
  for (Index i = 0; i < n_; ++i)
    q0_[i] = kinds[at(i)] == Kind::spin_angle ? 1.0 : 0.0;
  v0_.setZero();
  problem_.add_M(1.0, q0_, v0_);
  scale_.set_spin_inertia(v0_);
  q0_ = q_;
  v0_ = v_;
  a0_ = a_;
  choose_first_step();
}

void Stepper::restart(CRef q, CRef v, bool corner) {
  WHIRL_EXPECTS(q.size() == n_ && v.size() == n_);
  if (corner) {
    rate_span_ = std::max(rate_span_, longest_);
    longest_ = rate_steps_ = 0.0;
  }  // an approach may take more than one
  q_ = q;
  v_ = v;
  q_low_.setZero();
  v_low_.setZero();
  accept_pending_ = at_break_ = have_step_ = false;
  problem_.impose(t_, q_, v_, a_);
  after_discontinuity(false);
  for (Index i = 0; i < n_; ++i)
    if (q_[i] != q0_[i]) scale_.rebase(i, q_[i]);
  q0_ = q_;
  v0_ = v_;
  a0_ = a_;
  t0_ = t_;
  t0_low_ = t_low_;
}

void Stepper::after_discontinuity(bool impulse) {
  // a_ of the left side is the first guess of the right one
  if (impulse) {
    // q0_, v0_ are scratch here: held velocities before, jump
    v0_.setZero();
    for (Index i : held_)
      v0_[i] = v_[i];
    problem_.impose(t_, q_, v_, a_);
    double jump = 0.0;
    for (Index i : held_) {
      v0_[i] = v_[i] - v0_[i];
      // the left side is one ulp of t before: a smooth law differs by rounding alone
      if (std::abs(v0_[i]) > 1e-9 * (1.0 + std::abs(v_[i])))
        jump = std::max(jump, std::abs(v0_[i]));
    }
    if (jump > 0.0) {
      problem_.linearize(t_, q_, v_, a_);
      ++statistics_.linearizations;
      initial_.classify(problem_);
      if (initial_.impulse(problem_, v0_, v_, statistics_) != StepStatus::ok)
        throw run_error(
            "N21",
            fmt::format("the jump of a prescribed velocity at t = {} s moves unknowns without mass",
                        t_),
            "smooth the law, or give the parts it drives a mass");
    }
  }
  const StepStatus status = initial_.solve(problem_, t_, q_, v_, a_, statistics_);
  if (status != StepStatus::ok)
    throw run_error(
        "N20",
        fmt::format("no acceleration satisfies the equations at t = {} s: {}", t_, message(status)),
        "a part without mass that nothing holds, or a state outside the model's range");
  drop_history();
  control_.reset();
  refresh();
  fresh_ = false;
  first_ = true;
  segment_valid_ = false;
}

void Stepper::choose_first_step() {
  double stop;
  bool is_break;
  next_stop(stop, is_break);
  const double span = std::isfinite(stop) ? stop - t_ : 1.0;
  double h = options_.dt_first;
  if (h <= 0.0) {
    // Short enough to be accepted; the controller grows it eightfold a step.
    h = 1e-5 * span;
    const double speed = scale_.weights().size()
                             ? v_.cwiseProduct(initial_.dynamic()).lpNorm<Eigen::Infinity>()
                             : 0.0;
    const double acceleration = a_.cwiseProduct(initial_.dynamic()).lpNorm<Eigen::Infinity>();
    if (speed > 0.0 && acceleration > 0.0) h = std::min(h, 0.01 * speed / acceleration);
    h = std::max(h, 1e-9 * span);
  }
  h_next_ = std::max(std::min(h, options_.dt_max), options_.dt_min);
}

// ---------------------------------------------------------------------------------------------------------------------
// Where the next step ends

void Stepper::set_end(double t_end) {
  if (t_end == options_.t_end) return;
  options_.t_end = t_end;
  segment_valid_ = false;
}

void Stepper::set_breakpoints(std::vector<double> times) {
  std::erase_if(times, [](double t) { return !std::isfinite(t); });
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  if (times == breaks_) return;
  breaks_ = std::move(times);
  segment_valid_ = false;
}

void Stepper::next_stop(double& t, bool& is_break) const {
  const auto it = std::upper_bound(breaks_.begin(), breaks_.end(), t_);
  is_break = it != breaks_.end() && *it <= options_.t_end;
  t = is_break ? *it : options_.t_end;
}

void Stepper::plan_segment() {
  WHIRL_EXPECTS(options_.dt_fixed > 0.0);
  bool is_break;
  segment_start_ = t_;
  next_stop(segment_end_, is_break);
  segment_k_ = 0.0;
  if (std::isfinite(segment_end_)) {
    segment_count_ =
        std::max(1.0, std::ceil((segment_end_ - segment_start_) / options_.dt_fixed - 1e-9));
    segment_step_ = (segment_end_ - segment_start_) / segment_count_;
  } else {
    segment_count_ = infinity;
    segment_step_ = options_.dt_fixed;
  }
  segment_valid_ = true;
  inside_part_ = false;
}

Stepper::Target Stepper::plan(double h) {
  WHIRL_EXPECTS(h > 0.0);
  double target;
  if (options_.dt_fixed > 0.0) {
    target = segment_k_ + 1.0 >= segment_count_
                 ? segment_end_
                 : segment_start_ + (segment_k_ + 1.0) * segment_step_;
    if (!inside_part_ && h >= segment_step_) return {segment_step_, target, true, false};
  } else {
    bool is_break;
    next_stop(target, is_break);
  }
  const double remaining = (target - t0_) - t0_low_;
  if (h >= remaining * (1.0 - landing_slack))
    return {remaining, target, true, h > remaining * (1.0 + landing_slack)};
  // the rest in two halves, but for one that would be too short
  const double half = 0.5 * remaining;
  if (h > half && half >= options_.dt_min && options_.dt_fixed <= 0.0) h = half;
  return {h, t0_ + (h + t0_low_), false, false};
}

// ---------------------------------------------------------------------------------------------------------------------
// One step

void Stepper::take_recharted() {
  recharted();
  const auto kinds = problem_.kinds();
  bool rates_changed = false;
  for (Index i = 0; i < n_; ++i) {
    const bool rate = v_[i] != v0_[i] || a_[i] != a0_[i];
    rates_changed = rates_changed || rate;
    if (q_[i] != q0_[i]) scale_.rebase(i, q_[i]);
    // whole turns leave the remainder's compensation valid, a new chart does not
    if (rate || (q_[i] != q0_[i] && kinds[at(i)] != Kind::spin_angle)) q_low_[i] = v_low_[i] = 0.0;
  }
  if (!rates_changed) return;
  drop_history();
  refresh();
}

void Stepper::begin_step() {
  q0_ = q_;
  v0_ = v_;
  a0_ = a_;
  bool changed = false;
  if (accept_pending_) {
    accept_pending_ = false;
    changed = problem_.accept(t_, q_, v_, a_);
    if (changed) take_recharted();
  }
  if (at_break_) {
    at_break_ = false;
    changed = true;
    after_discontinuity(true);
  }
  if (changed) {
    q0_ = q_;
    v0_ = v_;
    a0_ = a_;
  }
  q0_low_ = q_low_;
  v0_low_ = v_low_;
  t0_ = t_;
  t0_low_ = t_low_;
  fresh_ = false;
}

void Stepper::linearize(double h, bool inside) {
  WHIRL_EXPECTS(h > 0.0);
  // In films the stages differ from the start as much as from each other: the middle of the step,
  // as far as the present acceleration tells it, is nearer to all of them.
  if (inside) {
    const double m = 0.5 * h;
    q_ = q0_ + m * v0_ + (0.5 * m * m) * a0_;
    v_ = v0_ + m * a0_;
    a_ = a0_;
    problem_.impose(t0_ + m, q_, v_, a_);
    problem_.linearize(t0_ + m, q_, v_, a_);
  } else {
    problem_.linearize(t0_, q0_, v0_, a0_);
  }
  ++statistics_.linearizations;
  linearize_ = false;
  fresh_ = true;
  h_factored_ = 0.0;
}

Stepper::Attempt Stepper::attempt_with_recovery(double h) {
  WHIRL_EXPECTS(h > 0.0);
  for (;;) {
    const bool inside = linearize_ && smooth();
    if (linearize_) linearize(h, inside);
    Attempt result;
    if (inside && !factor(h))
      linearize(h, false);  // out of the domain of a film
    else if (inside)
      h_factored_ = h;
    if (h != h_factored_) {
      if (factor(h)) {
        h_factored_ = h;
      } else {
        h_factored_ = 0.0;
        result.status = StepStatus::singular;
      }
    }
    if (result.status == StepStatus::ok) {
      result = attempt(h);
      statistics_.newton_iterations += result.iterations;
    }
    const bool recoverable =
        result.status == StepStatus::newton || result.status == StepStatus::singular;
    if (!recoverable || fresh_ || problem_.is_linear()) return result;
    linearize_ = true;  // old matrices: once more with new ones before the step is shortened
  }
}

StepReport Stepper::advance() {
  StepReport report;
  report.t0 = report.t1 = t_;
  if (t_ >= options_.t_end) {
    report.status = StepStatus::finished;
    return report;
  }
  begin_step();
  const bool fixed = options_.dt_fixed > 0.0;
  if (fixed && (!segment_valid_ || segment_k_ >= segment_count_)) plan_segment();
  double h_wanted =
      fixed ? (inside_part_ ? h_next_ : segment_step_)
            : std::max(std::min({h_next_, options_.dt_max, longest_step(options_.paces, t_)}),
                       options_.dt_min);
  const double dt_min =
      options_.dt_min > 0.0 ? options_.dt_min : std::max(1e-14 * std::abs(t0_), 1e-300);
  retrying_ = false;
  Target target{};
  Attempt result;
  for (int tries = 0;; ++tries) {
    target = plan(h_wanted);
    report.at_breakpoint = aim_at(target);
    result = attempt_with_recovery(target.h);
    if (result.status == StepStatus::ok && (fixed || result.error <= 1.0)) break;
    h_wanted = shorter_after(result, target.h, report);
    // the least step itself is tried before it is given up
    if (target.h > dt_min && !fixed) h_wanted = std::max(h_wanted, dt_min);
    if (h_wanted < dt_min || tries + 1 >= options_.max_attempts) {
      return_to_start();
      report.status = result.status;
      h_next_ = std::max(h_wanted, dt_min);
      return report;
    }
  }
  report.t1 = t_;
  report.error = result.error;
  report.newton_iterations = result.iterations;
  take_step(target.h, report);
  const bool smooth = report.rejected_error == 0 && report.rejected_newton == 0;
  if (fixed) {
    inside_part_ = !target.landing;
    if (target.landing) segment_k_ += 1.0;
    h_next_ = inside_part_ ? target.h : segment_step_;
  } else {
    const double proposal =
        control_.accepted(target.h, result.error, result.iterations, options_.max_newton);
    // a step cut short by a stop says nothing against the length wanted before
    h_next_ = target.clipped && smooth ? std::max(proposal, h_wanted) : proposal;
  }
  return report;
}

bool Stepper::aim_at(const Target& target) {
  t_ = target.t1;
  t_low_ = target.landing ? 0.0 : (t0_ - t_) + (target.h + t0_low_);
  const bool lands_on_break =
      target.landing && std::binary_search(breaks_.begin(), breaks_.end(), target.t1);
  t1_eval_ = lands_on_break ? std::nextafter(target.t1, t0_) : target.t1;
  return lands_on_break;
}

double Stepper::shorter_after(Attempt& failed, double h, StepReport& report) {
  if (failed.status == StepStatus::ok) {
    failed.status = StepStatus::error_test;
    ++report.rejected_error;
    ++statistics_.rejected_error;
    const double shorter = control_.rejected(h, failed.error);
    retrying_ = true;
    return shorter;
  }
  ++report.rejected_newton;
  ++statistics_.rejected_newton;
  control_.newton_failed(h);
  return h * (failed.status == StepStatus::domain ? 0.25 : 0.5);
}

void Stepper::take_step(double h, const StepReport& report) {
  if (scale_.keeps_errors()) scale_.observe_error(step_error(h, report.error));
  scale_.observe_twist(q0_, q_, false);
  commit(h);
  h_ = h;
  have_step_ = accept_pending_ = true;
  first_ = false;
  at_break_ = report.at_breakpoint;
  scale_.observe(q_);
  ++statistics_.accepted;
  statistics_.step_min = std::min(statistics_.step_min, h);
  statistics_.step_max = std::max(statistics_.step_max, h);
  statistics_.step_sum += h;
  longest_ = std::max(longest_, h);
  // a rotor at rest in a contact that rings without damping would be followed for ever
  constexpr double ringing = 1000.0;
  if (rate_span_ > 0.0 && (h >= rate_span_ || ++rate_steps_ >= ringing)) rate_span_ = 0.0;
  statistics_.error_max = std::max(statistics_.error_max, report.error);
  statistics_.error_sum += report.error;
}

Statistics Stepper::judged_statistics() const {
  // by the scales that the motion so far makes, whether a step was made since a restore or not
  ResponseScale scale = scale_;
  scale.begin_step(VecX::Zero(n_));
  Statistics s = statistics_;
  s.twist = scale.twist();
  s.twist_error = scale.twist_error() / allowance();
  s.twists_alone = scale.twists_alone();
  if (options_.dt_fixed > 0.0) {
    s.error_max = scale.largest_error() / allowance();
    s.error_sum = scale.mean_error() / allowance() * static_cast<double>(s.accepted);
  }
  return s;
}

void Stepper::return_to_start() {
  q_ = q0_;
  v_ = v0_;
  a_ = a0_;
  q_low_ = q0_low_;
  v_low_ = v0_low_;
  t_ = t0_;
  t_low_ = t0_low_;
}

StepReport Stepper::shorten_to(double t) {
  StepReport report;
  if (!have_step_ || !(t > t0_ && t < t_))
    throw std::invalid_argument("shorten_to: t outside the last step");
  const double wanted = h_next_, h_before = h_;
  retrying_ = false;
  t_ = t1_eval_ = t;
  t_low_ = 0.0;
  report.t0 = t0_;
  const double h = (t - t0_) - t0_low_;
  rewind();
  const Attempt result = attempt_with_recovery(h);
  report.status = result.status;
  report.newton_iterations = result.iterations;
  report.error = result.error;
  if (result.status != StepStatus::ok) {
    return_to_start();  // the caller may go on with advance()
    have_step_ = false;
    accept_pending_ = false;
    report.t1 = t_;
    return report;
  }
  scale_.observe_twist(q0_, q_, true);
  commit(h);
  h_ = h;
  accept_pending_ = true;
  at_break_ = false;
  segment_valid_ = false;
  report.t1 = t;
  statistics_.step_sum += h - h_before;
  statistics_.step_min = std::min(statistics_.step_min, h);
  h_next_ = wanted;
  return report;
}

void Stepper::interpolate(double t, Ref q, Ref v, Ref a) const {
  WHIRL_EXPECTS(q.size() == n_ && v.size() == n_ && a.size() == n_);
  if (take_end(have_step_ ? t : t_, {t_, q_, v_, a_}, q, v, a)) return;
  if (take_end(t, {t0_, q0_, v0_, a0_}, q, v, a)) return;
  dense(((t - t0_) - t0_low_) / h_, q, v, a);
  problem_.impose(t, q, v, a);
}

bool Stepper::interpolate_entries(double t, std::span<const Index> entries, Ref q) const {
  WHIRL_EXPECTS(q.size() == static_cast<Index>(entries.size()));
  const VecX* known = !have_step_ || t == t_ ? &q_ : t == t0_ ? &q0_ : nullptr;
  if (known) {
    for (std::size_t i = 0; i < entries.size(); ++i)
      q[static_cast<Index>(i)] = (*known)[entries[i]];
    return true;
  }
  const std::span<const Kind> kinds = problem_.kinds();
  for (const Index k : entries)
    if (kinds[static_cast<std::size_t>(k)] == Kind::held) return false;
  return dense_entries(((t - t0_) - t0_low_) / h_, entries, q);
}

bool Stepper::interpolate_some(double t, std::span<const Index> entries, Ref q, Ref v,
                               Ref a) const {
  WHIRL_EXPECTS(q.size() == n_ && v.size() == n_ && a.size() == n_);
  if (!have_step_ || t == t_ || t == t0_) return false;
  if (!dense_some(((t - t0_) - t0_low_) / h_, entries, q, v, a)) return false;
  problem_.impose(t, q, v, a);
  return true;
}

void Stepper::add_compensated(const VecX& x, const VecX& x_low, const VecX& dx, VecX& sum,
                              VecX& low) {
  WHIRL_EXPECTS(dx.size() == x.size() && x_low.size() == x.size());
  WHIRL_EXPECTS(sum.size() == x.size() && low.size() == x.size());
  // two-sum (Knuth): exact for any order of magnitudes
  for (Index i = 0; i < x.size(); ++i) {
    const double d = dx[i] + x_low[i];
    const double s = x[i] + d;
    const double b = s - x[i];
    low[i] = (x[i] - (s - b)) + (d - b);
    sum[i] = s;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Save and restore

IntegratorState Stepper::save() {
  refresh();
  IntegratorState s;
  s.t = t_;
  s.q = q_;
  s.v = v_;
  s.a = a_;
  auto& out = s.history;
  const Statistics& k = statistics_;
  for (long c : {k.accepted, k.rejected_error, k.rejected_newton, k.newton_iterations,
                 k.linearizations, k.factorizations_real, k.factorizations_complex, k.residuals,
                 k.solves_real, k.solves_complex})
    out.push_back(static_cast<double>(c));
  out.insert(out.end(), {k.step_min, k.step_max, k.step_sum, k.error_max, k.error_sum});
  out.insert(out.end(), {longest_, rate_span_, rate_steps_, t_low_, h_next_, first_ ? 1.0 : 0.0,
                         accept_pending_ ? 1.0 : 0.0, at_break_ ? 1.0 : 0.0});
  out.insert(out.end(), {segment_start_, segment_end_, segment_count_, segment_step_, segment_k_,
                         segment_valid_ ? 1.0 : 0.0, inside_part_ ? 1.0 : 0.0});
  for (const VecX* x : {&q_low_, &v_low_})
    out.insert(out.end(), x->data(), x->data() + n_);
  scale_.save(out);
  control_.save(out);
  initial_.save(out);
  save_history(out);
  return s;
}

void Stepper::restore(const IntegratorState& s) {
  if (s.q.size() != n_ || s.v.size() != n_ || s.a.size() != n_)
    throw std::invalid_argument("integrator state of another problem");
  if (s.history.size() != save().history.size())
    throw std::invalid_argument("integrator state of another scheme");
  const double* in = s.history.data();
  Statistics& k = statistics_;
  for (long* c : {&k.accepted, &k.rejected_error, &k.rejected_newton, &k.newton_iterations,
                  &k.linearizations, &k.factorizations_real, &k.factorizations_complex,
                  &k.residuals, &k.solves_real, &k.solves_complex})
    *c = static_cast<long>(*in++);
  for (double* c : {&k.step_min, &k.step_max, &k.step_sum, &k.error_max, &k.error_sum})
    *c = *in++;
  auto flag = [&in] { return *in++ != 0.0; };
  t_ = s.t;
  longest_ = *in++;
  rate_span_ = *in++;
  rate_steps_ = *in++;
  t_low_ = *in++;
  h_next_ = *in++;
  first_ = flag();
  accept_pending_ = flag();
  at_break_ = flag();
  for (double* c : {&segment_start_, &segment_end_, &segment_count_, &segment_step_, &segment_k_})
    *c = *in++;
  segment_valid_ = flag();
  inside_part_ = flag();
  for (VecX* x : {&q_low_, &v_low_}) {
    std::copy_n(in, n_, x->data());
    in += n_;
  }
  in = scale_.restore(in);
  in = control_.restore(in);
  in = initial_.restore(in);
  restore_history(in);
  q_ = q0_ = s.q;
  v_ = v0_ = s.v;
  a_ = a0_ = s.a;
  t0_ = t_;
  t0_low_ = t_low_;
  have_step_ = false;
  refresh();
}

}  // namespace whirl::time
