// Generalized-alpha: J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371, doi 10.1115/1.2900803,
// in the form of M. Arnold, O. Bruls, Multibody Syst. Dyn. 18 (2007) 185, doi
// 10.1007/s11044-007-9084-0: the equations hold exactly at the step's end,
//     R(t1, q1, v1, a1) = 0,
//     (1 - alpha_m) b1 + alpha_m b0 = (1 - alpha_f) a1 + alpha_f a0,
//     q1 = q0 + h v0 + h^2 ((1/2 - beta) b0 + beta b1),   v1 = v0 + h ((1 - gamma) b0 + gamma b1),
// with an acceleration-like b carried beside a. So M(q) and prescribed entries keep order 2.
//     alpha_m = (2 rho - 1)/(rho + 1), alpha_f = rho/(rho + 1), gamma = 1/2 - alpha_m + alpha_f,
//         beta = (gamma + 1/2)^2/4.
// Newton's unknown is q1: q1 = q* + B a1, v1 = v* + G a1, matrix (1/B) M + (G/B) C + K, B = h^2
// beta (1-alpha_f)/(1-alpha_m), G = h gamma (1-alpha_f)/(1-alpha_m).
//
// Changing steps. b is the acceleration at a shifted time, b = a + (alpha_m - alpha_f) h a' +
// O(h^2). When h changes, b0 is moved along with it, b0 := a0 + (h_new/h_old)(b0 - a0), and order 2
// is kept.
//
// Error. Local error in q: (beta - 1/6 + (alpha_m - alpha_f)/2) h^3 q''' = c h^2 (a1 - a0),
// filtered by ((1/B) M + (G/B) C + K)^-1 ((1/B) M + (G/B) C) so that stiff modes do not count. The
// global error is of order 2, so the local allowance is taken proportional to tolerance^(3/2): ten
// periods of an undamped oscillator end with an error of the tolerance. (A hundred periods would
// need ten thousand steps each: for such runs the other schemes are the cheaper ones.)
//
// Dense output: q the cubic Hermite polynomial, v = q', a = q''.
#include <time/generalized_alpha.hpp>
#include <core/contract.hpp>

#include <time/hermite.hpp>
#include <cmath>

namespace whirl::time {
namespace {
constexpr double alpha_allowance = 7e-3;
constexpr double alpha_newton_share =
    0.01;  // largest Newton error of a step over its largest local error
}  // namespace

GeneralizedAlpha::GeneralizedAlpha(Problem& problem, const Options& options)
    : Stepper(problem, options) {
  const double rho = options.rho_inf;
  alpha_m_ = (2.0 * rho - 1.0) / (rho + 1.0);
  alpha_f_ = rho / (rho + 1.0);
  gamma_ = 0.5 - alpha_m_ + alpha_f_;
  beta_ = 0.25 * (gamma_ + 0.5) * (gamma_ + 0.5);
  error_constant_ = beta_ - 1.0 / 6.0 + 0.5 * (alpha_m_ - alpha_f_);
  allowance_ = alpha_allowance * std::pow(options.tolerance, 1.5);
  newton_.configure(options.max_newton, alpha_newton_share * allowance_, 0.03 * allowance_);
  scale_.resolve(NewtonMonitor::rounding_share * 0.03 * allowance_);
  control_.configure(3);
  for (VecX* x : {&algorithmic0_, &algorithmic_, &algorithmic_before_, &difference_,
                  &difference_before_, &r_, &dq_, &dv_, &e_})
    *x = VecX::Zero(n_);
}

bool GeneralizedAlpha::factor(double h) {
  const double f = (1.0 - alpha_f_) / (1.0 - alpha_m_);
  const double B = h * h * beta_ * f, G = h * gamma_ * f;
  return factor_real(1.0 / B, G / B, 1.0);
}

/// Linear in a; then q1 - q0 and v1 - v0 that go with it.
void GeneralizedAlpha::predict(double h) {
  if (h_last_ > 0.0)
    algorithmic0_ = a0_ + (h / h_last_) * (algorithmic_ - a0_);
  else
    algorithmic0_ = a0_;
  a_ = a0_;
  if (h_last_ > 0.0) a_ += h * difference_;
  const double g = 1.0 / (1.0 - alpha_m_);
  e_ = (g * (1.0 - alpha_f_)) * a_ + (g * alpha_f_) * a0_ - (g * alpha_m_) * algorithmic0_;  // b1
  dq_ = h * v0_ + (h * h) * ((0.5 - beta_) * algorithmic0_ + beta_ * e_);
  dv_ = h * ((1.0 - gamma_) * algorithmic0_ + gamma_ * e_);
}

/// Newton's method from there: its status, and the iterations it took.
void GeneralizedAlpha::correct(double B, double G, Attempt& out) {
  newton_.begin();
  for (;;) {
    q_ = q0_ + dq_;
    v_ = v0_ + dv_;
    problem_.impose(t1_eval_, q_, v_, a_);
    out.status = StepStatus::domain;
    if (!residual(t1_eval_, q_, v_, a_, r_)) return;
    for (Index i : held_)
      r_[i] = 0.0;
    problem_.solve(Ref(r_));
    ++statistics_.solves_real;
    dq_ -= r_;
    dv_ -= (G / B) * r_;
    a_ -= (1.0 / B) * r_;
    out.iterations = newton_.count() + 1;
    if (out.iterations == 1) scale_.begin_step(dq_);
    const bool finite = std::isfinite(r_.sum());
    if (problem_.is_linear()) {
      newton_.update(0.0, 0.0);
      if (!finite) {
        out.status = StepStatus::newton;
        return;
      }
      break;
    }
    const auto verdict = newton_.update(finite ? scale_.norm(r_) : infinity, scale_.rounding());
    if (verdict == NewtonMonitor::Verdict::converged) break;
    if (verdict == NewtonMonitor::Verdict::failed) {
      out.status = StepStatus::newton;
      newton_.forget();
      return;
    }
  }
  out.status = StepStatus::ok;
}

Stepper::Attempt GeneralizedAlpha::attempt(double h) {
  Attempt out;
  const double f = (1.0 - alpha_f_) / (1.0 - alpha_m_);
  const double B = h * h * beta_ * f, G = h * gamma_ * f;
  predict(h);
  correct(B, G, out);
  if (out.status != StepStatus::ok) return out;
  if (newton_.slow()) linearize_ = true;
  add_compensated(q0_, q0_low_, dq_, q_, q_low_);
  add_compensated(v0_, v0_low_, dv_, v_, v_low_);
  problem_.impose(t1_eval_, q_, v_, a_);
  for (Index i : held_)
    q_low_[i] = v_low_[i] = 0.0;

  e_ = (error_constant_ * h * h) * (a_ - a0_);
  for (Index i : held_)
    e_[i] = 0.0;
  r_.setZero();
  problem_.add_M(1.0 / B, e_, r_);
  problem_.add_C(G / B, e_, r_);
  for (Index i : held_)
    r_[i] = 0.0;
  problem_.solve(Ref(r_));
  ++statistics_.solves_real;
  out.error = scale_.error_norm(r_) / allowance_;
  return out;
}

const VecX& GeneralizedAlpha::step_error(double, double) { return r_; }

void GeneralizedAlpha::commit(double h) {
  algorithmic_before_ = algorithmic_;
  difference_before_ = difference_;
  h_before_ = h_last_;
  const double g = 1.0 / (1.0 - alpha_m_);
  algorithmic_ =
      (g * (1.0 - alpha_f_)) * a_ + (g * alpha_f_) * a0_ - (g * alpha_m_) * algorithmic0_;
  difference_ = (a_ - a0_) / h;
  h_last_ = h;
}

void GeneralizedAlpha::rewind() {
  algorithmic_ = algorithmic_before_;
  difference_ = difference_before_;
  h_last_ = h_before_;
}

void GeneralizedAlpha::drop_history() { h_last_ = h_before_ = 0.0; }

void GeneralizedAlpha::dense(double theta, Ref q, Ref v, Ref a) const {
  WHIRL_EXPECTS(h_ > 0.0);
  hermite(theta, h_, q0_, v0_, q_, v_, q, v, a);
}

void GeneralizedAlpha::save_history(std::vector<double>& out) const {
  out.insert(out.end(), {h_last_});
  newton_.save(out);
  for (const VecX* x : {&algorithmic_, &difference_})
    out.insert(out.end(), x->data(), x->data() + n_);
}

const double* GeneralizedAlpha::restore_history(const double* in) {
  h_last_ = *in++;
  h_before_ = 0.0;
  in = newton_.restore(in);
  for (VecX* x : {&algorithmic_, &difference_}) {
    std::copy_n(in, n_, x->data());
    in += n_;
  }
  return in;
}

}  // namespace whirl::time
