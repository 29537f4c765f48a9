#include <core/contract.hpp>
#include <algorithm>
#include <cmath>
#include <la/continuation.hpp>

namespace whirl::la {

bool Continuation::tangent(ContinuationProblem& problem, const VecX& q, double mu,
                           const ContinuationOptions& o, bool first) {
  // K dq + f_mu dmu = 0, normalised in the scaled space.
  if (!problem.factor(q, mu)) return false;
  problem.load(q, mu, load_);
  b_ = -load_;
  problem.solve(b_);
  double norm2 = 1.0 / (mu_weight_ * mu_weight_);
  norm2 += b_.cwiseProduct(weight_).squaredNorm();
  double s = 1.0 / std::sqrt(norm2);
  if (!(s > 0.0)) return false;
  if (o.controlled >= 0) {
    if (s * b_(o.controlled) * o.first_step < 0.0) s = -s;
  } else if (first) {
    if (o.direction < 0.0) s = -s;
  } else {
    // Onwards: along the last direction.
    const double forward = b_.cwiseProduct(weight_).dot(direction_.cwiseProduct(weight_)) +
                           mu_direction_ / (mu_weight_ * mu_weight_);
    if (forward < 0.0) s = -s;
  }
  direction_ = s * b_;
  mu_direction_ = s;
  return direction_.allFinite();
}

/// Newton on f(q, mu) = 0 with the constraint of this step; the number of iterations, or -1.
int Continuation::correct(ContinuationProblem& problem, const VecX& q, double mu, double ds,
                          const ContinuationOptions& o, bool fixed_mu) {
  double stretch = ds;
  if (o.controlled >= 0 && !fixed_mu) {
    const double rate = std::abs(direction_(o.controlled) * weight_(o.controlled));
    if (!(rate > 0.0)) return -1;
    stretch = ds / rate;
  }
  trial_ = q + stretch * direction_;
  trial_mu_ = mu + stretch * mu_direction_;
  if (fixed_mu) trial_mu_ = o.last_mu;
  double last = infinity;
  for (int k = 1; k <= o.max_iterations; ++k) {
    if (!problem.residual(trial_, trial_mu_, f_)) return -1;
    if (!problem.factor(trial_, trial_mu_)) {
      // on a straight path the prediction may be a point of it, at which K is singular
      constexpr double rounding = 1e-12;  // of the loads
      problem.load(trial_, trial_mu_, load_);
      return f_.norm() <= rounding * mu_weight_ * load_.norm() ? k : -1;
    }
    a_ = -f_;
    problem.solve(a_);
    double dmu = 0.0;
    if (!fixed_mu) {
      problem.load(trial_, trial_mu_, load_);
      b_ = -load_;
      problem.solve(b_);
      if (o.controlled >= 0) {
        dmu = -a_(o.controlled) / b_(o.controlled);
      } else {
        // Stay in the plane across the tangent.
        const double down = direction_.cwiseProduct(weight_).dot(b_.cwiseProduct(weight_)) +
                            mu_direction_ / (mu_weight_ * mu_weight_);
        dmu = -direction_.cwiseProduct(weight_).dot(a_.cwiseProduct(weight_)) / down;
      }
      a_ += dmu * b_;
    }
    trial_ += a_;
    trial_mu_ += dmu;
    const double size =
        std::max(a_.cwiseProduct(weight_).cwiseAbs().maxCoeff(), std::abs(dmu) / mu_weight_);
    if (!(size < infinity)) return -1;
    if (size <= o.tolerance) return k;
    if (k > 3 && size > 2.0 * last) return -1;
    last = size;
  }
  return -1;
}

void Continuation::prepare(ContinuationProblem& problem, Index n) {
  for (VecX* v : {&f_, &load_, &a_, &b_, &trial_, &direction_, &last_})
    v->resize(n);
  weight_ = problem.scale().cwiseInverse();
  mu_weight_ = problem.mu_scale();
}

bool Continuation::between(ContinuationProblem& problem, const VecX& qa, double mua, const VecX& qb,
                           double mub, double part, const ContinuationOptions& o, VecX& q,
                           double& mu) {
  WHIRL_EXPECTS(qb.size() == qa.size() && problem.scale().size() == qa.size());
  WHIRL_EXPECTS(part >= 0.0 && part <= 1.0);
  prepare(problem, qa.size());
  direction_ = qb - qa;
  mu_direction_ = mub - mua;
  const double in_mu = mu_direction_ / mu_weight_;
  const double length = std::sqrt(direction_.cwiseProduct(weight_).squaredNorm() + in_mu * in_mu);
  if (!(length > 0.0)) return false;
  direction_ /= length;
  mu_direction_ /= length;
  ContinuationOptions by_arc = o;
  by_arc.controlled = -1;
  if (correct(problem, qa, mua, part * length, by_arc, false) < 0) return false;
  q = trial_;
  mu = trial_mu_;
  return true;
}

bool Continuation::set_out(ContinuationProblem& problem, const VecX& q, double mu,
                           const ContinuationOptions& o) {
  if (!o.start_direction) return tangent(problem, q, mu, o, true);
  direction_ = *o.start_direction / o.start_direction->cwiseProduct(weight_).norm();
  mu_direction_ = 0.0;
  return true;
}

Continuation::Advance Continuation::advance(ContinuationProblem& problem, const VecX& q, double mu,
                                            double& ds, bool leaving, const ContinuationOptions& o,
                                            ContinuationPoint& point) {
  const int iterations = correct(problem, q, mu, ds, o, false);
  if (iterations < 0) {
    ds *= 0.5;
    return Advance::failed;
  }
  point.iterations = iterations;
  const bool passed =
      !leaving && (trial_mu_ - o.last_mu) * (mu - o.last_mu) <= 0.0 && std::isfinite(o.last_mu);
  if (passed) {
    // Land on the last value: the step in proportion, then Newton at that mu.
    const double part = (o.last_mu - mu) / (trial_mu_ - mu);
    point.iterations = correct(problem, q, mu, part * ds, o, true);
    if (point.iterations < 0) {
      ds *= 0.5;
      return Advance::failed;
    }
  }
  const double before = mu_direction_;
  last_ = direction_;
  // At a limit point K is singular to rounding: the old tangent serves for one more step.
  if (!tangent(problem, trial_, trial_mu_, o, false)) {
    direction_ = last_;
    mu_direction_ = before;
  }
  if (o.controlled < 0 && !leaving && ds > 1e3 * o.min_step) {
    // A turn of more than 45 degrees in one step may have jumped to another part of the path, or
    // back.
    const double turn = direction_.cwiseProduct(weight_).dot(last_.cwiseProduct(weight_)) +
                        mu_direction_ * before / (mu_weight_ * mu_weight_);
    if (turn < 0.7) {
      direction_ = last_;
      mu_direction_ = before;
      ds *= 0.5;
      return Advance::turned;
    }
  }
  point.mu = trial_mu_;
  point.dmu = mu_direction_;
  point.limit_point = before * mu_direction_ < 0.0;
  return passed ? Advance::arrived : Advance::on_the_way;
}

ContinuationResult Continuation::run(ContinuationProblem& problem, VecX& q, double& mu,
                                     const ContinuationOptions& o, const Accept& accept) {
  WHIRL_EXPECTS(problem.scale().size() == q.size() && problem.mu_scale() > 0.0);
  WHIRL_EXPECTS(0.0 < o.min_step && o.min_step <= o.max_step);
  WHIRL_EXPECTS(o.first_step != 0.0 && o.wanted_iterations > 0);
  WHIRL_EXPECTS(o.controlled < q.size());
  WHIRL_EXPECTS(!o.start_direction || o.start_direction->size() == q.size());
  ContinuationResult result;
  prepare(problem, q.size());
  double ds = std::abs(o.first_step), arc = 0.0;
  if (!set_out(problem, q, mu, o)) return {ContinuationStatus::singular_start, 0};
  bool leaving = o.start_direction != nullptr;
  while (result.steps < o.max_steps) {
    bool landing = false;
    if (o.controlled >= 0 && std::isfinite(o.last_controlled)) {
      const double left = std::abs(o.last_controlled - q(o.controlled)) * weight_(o.controlled);
      if (ds >= left * (1.0 - 1e-9)) {
        ds = left;
        landing = true;
      }
    }
    ContinuationPoint point{};
    const Advance step = advance(problem, q, mu, ds, leaving, o, point);
    if (step == Advance::failed && ds < o.min_step)
      return result.status = ContinuationStatus::step_too_small, result;
    if (step == Advance::failed || step == Advance::turned) continue;
    ++result.steps;
    // Arc length of the chord.
    const double dmu = trial_mu_ - mu;
    arc += std::sqrt((trial_ - q).cwiseProduct(weight_).squaredNorm() +
                     dmu * dmu / (mu_weight_ * mu_weight_));
    q = trial_;
    mu = trial_mu_;
    point.arc = arc;
    leaving = false;
    if (!accept(q, point)) return result.status = ContinuationStatus::stopped, result;
    if (step == Advance::arrived || landing) return result;
    const double wanted = static_cast<double>(o.wanted_iterations) / point.iterations;
    ds = std::clamp(ds * std::clamp(wanted, 0.5, 2.0), o.min_step, o.max_step);
  }
  result.status = ContinuationStatus::too_many_steps;
  return result;
}

}  // namespace whirl::la
