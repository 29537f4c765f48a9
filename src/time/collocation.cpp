// Collocation in second-order form.
//
// Equations and stages. On a step from (t0, q0, v0) to t0 + h the first-order form q' = v, v' = a
// is collocated at t_i = t0 + c_i h: Q_i = q0 + h sum a_ij V_j, V_i = v0 + h sum a_ij A_j. The
// unknowns are the increments over free motion,
//     Y_i = Q_i - q0 - c_i h v0,   V_i = v0 + (1/h) sum (A^-1)_ij Y_j,
//         A_i = (1/h^2) sum (A^-2)_ij Y_j,
// which keep the digits of the acceleration when phi turns by radians a step, and R(t_i, Q_i, V_i,
// A_i) = 0 at every stage. Rows of M may be zero: a first-order unknown then follows exactly the
// classical scheme for C v + f = 0, because V_i is (A^-1 (Q - q0))_i / h whatever v0 was. Held
// entries take their exact values at every stage time.
//
// Newton. With M, C, K frozen for all stages the linearised stage equations
//     K dY_i + (1/h) C sum (A^-1)_ij dY_j + (1/h^2) M sum (A^-2)_ij dY_j = -R_i
// decouple in the eigenvectors of A^-1 = sum lambda_k x_k w_k^T:  dY_i = sum_k x_k,i u_k,
//     [ (lambda_k/h)^2 M + (lambda_k/h) C + K ] u_k = - sum_i w_k,i R_i.
// One real and one complex N x N system (Gauss 4: complex only) instead of one of 6N. (E. Hairer,
// G. Wanner, Solving ODEs II, IV.8; J. C. Butcher, BIT 16 (1976) 237, doi 10.1007/BF01932265.)
// Iteration ends when rate/(1-rate) times the last correction is below the Newton allowance, with
// the rate of earlier steps standing in after the first correction. With Options:: linearize_inside
// new matrices are taken in the middle of the step, and where the iteration still fails, at the
// middle stage of where it has come to: a film whose wedge all but vanishes changes its tangent
// within a correction.
//
// Predictor: the acceleration polynomial of the last step, extrapolated and integrated twice. Of a linear
// problem there is none: its one iteration begins at free motion, along which the residuals of all
// stages share their products with the matrices (AffineProblem). Where Newton fails or is slow, unknowns
// without mass begin the next attempts at the rates they have: their accelerations are differences
// of rates over the step with what Newton left of its error over h, which extrapolated grows as steps get
// shorter. A rate that is barely held (the tilt of a pad whose film has all but gone) never came back.
// After an easy attempt alone one would be slow again, every other one, and steps would not grow.
//
// Error. Of all embedded formulas on {t0, t_1..t_s} of order s only one exists up to a factor: its
// defect is that of the collocation polynomials u (of q) and w (of v) at the step's start,
//     rho_q = v0 - u'(0),   rho_v = a0 - w'(0),   u'(0) = sum l_j(0) V_j,   w'(0) = sum l_j(0) A_j.
// For Radau IIA 5 it is Hairer's estimate. Filtered by (mu/h - J)^-1, J the first-order Jacobian,
// so that stiff modes do not count:   (mu/h) e_q - e_v = rho_q,   M (mu/h) e_v + C e_v + K e_q = M
// rho_v,   hence
//     [ (mu/h)^2 M + (mu/h) C + K ] e_q = M (rho_v + (mu/h) rho_q) + C rho_q,
//         e_v = (mu/h) e_q - rho_q.
// Radau: mu is the real eigenvalue, the matrix is Newton's, and a0 is the last stage of the step
// before (the state is consistent). Gauss 6: likewise, but (q0, v0) is not a stage, so M a0 is
// replaced by M a0 - R(t0, q0, v0, a0), one residual a step (which also shows whether the model
// holds at the step's end). Gauss 4: the same with mu = |lambda| and a real factorisation of its
// own. The error is O(h^(s+1)) with s = 3, 3, 2. Where it exceeds its allowance on a first or
// repeated attempt, the defect is taken again at the filtered point (q0 + e_q, v0 + e_v): on stiff
// transients the first estimate is far too large (Hairer & Wanner, IV.8 (8.20)). Tested are e_q and
// h e_v in the scale of q; after a corner of the force the time for e_v is longer
// (Integrator::restart).
//
// Tolerance. The estimate is of order s + 1, the step itself of local order p + 1, p = 5, 6, 4. To
// make the global error proportional to Options::tolerance the local allowance is c
// tolerance^((s+1)/p). c is set so that a hundred periods of an undamped oscillator, a run-up
// through a resonance with Q = 50, or 160 nutations of an undamped fast top (the rotor of
// tests/validation/test_paper_rotor.cpp over 10 s) end with a global error of the tolerance or less
// (tests/time/test_accuracy.cpp holds the numbers).
//
// Result. Radau: the last stage. Gauss: q1 = q0 + h v0 + h^2 sum b_j (1 - c_j) A_j, v1 = v0 + h sum
// b_j A_j. Dense output: a(theta) the polynomial through the A_j, v and q its integrals; exact at
// both ends of the step in q and v.
#include <time/collocation.hpp>
#include <core/contract.hpp>

#include <cmath>
#include <stdexcept>

namespace whirl::time {
namespace {

/// Local allowance at tolerance 1 (c above).
double allowance_factor(const Tableau& t) {
  return t.stiffly_accurate ? 0.014 : t.stages == 3 ? 0.05 : 0.026;
}
/// Largest Newton error of a step: this times tolerance^(1 + 1/p). It leaves a momentum error that
/// a free spin sums up over the run, and the number of steps grows as tolerance^(-1/p). Gauss takes
/// longer steps (6) or more of them (4).
double newton_share(const Tableau& t) { return t.stiffly_accurate ? 3e-4 : 5e-5; }

}  // namespace

Collocation::Collocation(std::string_view name, const Tableau& tableau, Problem& problem,
                         const Options& options)
    : Stepper(problem, options),
      name_(name),
      tab_(tableau),
      affine_(problem.is_linear() ? dynamic_cast<AffineProblem*>(&problem) : nullptr),
      s_(tableau.stages) {
  const double exponent = static_cast<double>(s_ + 1) / tab_.order;
  allowance_ = allowance_factor(tab_) * std::pow(options.tolerance, exponent);
  newton_.configure(options.max_newton,
                    newton_share(tab_) * std::pow(options.tolerance, 1.0 + 1.0 / tab_.order),
                    0.03 * allowance_);
  scale_.resolve(NewtonMonitor::rounding_share * 0.03 * allowance_);
  control_.configure(s_ + 1);
  for (MatX* m : {&y_, &a_stage_, &r_, &a_last_})
    *m = MatX::Zero(n_, s_);
  for (VecX* x : {&qs_, &vs_, &as_, &dq_, &u_, &e_, &rho_q_, &rho_v_, &start_residual_,
                  &end_residual_, &start_before_})
    *x = VecX::Zero(n_);
  uc_ = VecXc::Zero(n_);
  if (!affine_) return;
  work_.emplace(tab_, problem_, *affine_);
  linear_.emplace(tab_, held_);
  bound_.resize(n_);
  bound_end_.resize(n_);
  products_.resize(n_);
  start_forces_.setZero(n_);
}

bool Collocation::factor(double h) {
  const double m = tab_.mu / h;
  const Complex l = tab_.lambda_c / h;
  return factor_complex(l * l, l, Complex(1.0)) && factor_real(m * m, m, 1.0);
}

void Collocation::predict(double h, bool extrapolate) {
  if (problem_.is_linear()) {
    // One iteration solves exactly, whatever the start; from zero it cannot lose digits to an
    // extrapolated stiff mode.
    y_.setZero();
  } else if (extrapolate) {
    const Tableau::Mat e = tab_.extrapolation(theta_start_, h / h_last_);
    const double h2 = h * h;
    for (int i = 0; i < s_; ++i) {
      const auto& row = e[static_cast<std::size_t>(i)];
      if (s_ == 3)
        y_.col(i) = (h2 * row[0]) * a_last_.col(0) + (h2 * row[1]) * a_last_.col(1) +
                    (h2 * row[2]) * a_last_.col(2);
      else
        y_.col(i) = (h2 * row[0]) * a_last_.col(0) + (h2 * row[1]) * a_last_.col(1);
    }
  } else {
    for (int i = 0; i < s_; ++i) {
      const double x = tab_.c[static_cast<std::size_t>(i)] * h;
      y_.col(i) = (0.5 * x * x) * a0_;
    }
  }
}

double Collocation::set_stage(int i, double h) {
  const double h1 = 1.0 / h, h2 = h1 * h1;
  const auto u = static_cast<std::size_t>(i);
  const auto& b = tab_.Ainv[u];
  const auto& d = tab_.Ainv2[u];
  qs_ = q0_ + ((tab_.c[u] * h) * v0_ + y_.col(i));
  if (s_ == 3) {
    vs_ = v0_ + ((h1 * b[0]) * y_.col(0) + (h1 * b[1]) * y_.col(1) + (h1 * b[2]) * y_.col(2));
    as_ = (h2 * d[0]) * y_.col(0) + (h2 * d[1]) * y_.col(1) + (h2 * d[2]) * y_.col(2);
  } else {
    vs_ = v0_ + ((h1 * b[0]) * y_.col(0) + (h1 * b[1]) * y_.col(1));
    as_ = (h2 * d[0]) * y_.col(0) + (h2 * d[1]) * y_.col(1);
  }
  const double t = stage_time(tab_.c[u], h);
  problem_.impose(t, qs_, vs_, as_);
  return t;
}

bool Collocation::evaluate_free_stages(double h) {
  std::array<double, Tableau::max_stages> span{}, time{};
  const auto stages = static_cast<std::size_t>(s_);
  for (std::size_t i = 0; i < stages; ++i) {
    span[i] = tab_.c[i] * h;
    time[i] = stage_time(tab_.c[i], h);
  }
  if (!affine_->residuals_along({t0_, q0_, v0_, {span.data(), stages}, {time.data(), stages}}, r_))
    return false;
  statistics_.residuals += s_;
  return true;
}

std::optional<double> Collocation::residual_work() {
  if (!affine_ || !free_stages_) return std::nullopt;
  if (linear_step_)
    return work_->of({t0_, t0_low_, h_, v0_, a0_, nullptr, a_last_}, products_.stiff,
                     start_forces_);
  // what a stage solved, or the initial accelerations, has no residual
  const bool at_rest = tab_.stiffly_accurate || !had_start_residual_;
  return work_->of({t0_, t0_low_, h_, v0_, a0_, at_rest ? nullptr : &start_before_, a_last_});
}

bool Collocation::evaluate_stages(double h) {
  free_stages_ = affine_ && evaluate_free_stages(h);
  if (free_stages_) return true;
  for (int i = 0; i < s_; ++i) {
    const double t = set_stage(i, h);
    if (!residual(t, qs_, vs_, as_, r_.col(i))) return false;
  }
  return true;
}

bool Collocation::linearize_inside(double h) {
  y_ += r_;  // the correction that showed it makes nothing better
  const double t = set_stage(1, h);
  problem_.linearize(t, qs_, vs_, as_);
  ++statistics_.linearizations;
  h_factored_ = 0.0;
  if (!factor(h)) return false;
  h_factored_ = h;
  return true;
}

bool Collocation::correct() {
  const auto& t = tab_;
  if (s_ == 3) {
    u_ = t.w_r[0] * r_.col(0) + t.w_r[1] * r_.col(1) + t.w_r[2] * r_.col(2);
    uc_.real() =
        t.w_c[0].real() * r_.col(0) + t.w_c[1].real() * r_.col(1) + t.w_c[2].real() * r_.col(2);
    uc_.imag() =
        t.w_c[0].imag() * r_.col(0) + t.w_c[1].imag() * r_.col(1) + t.w_c[2].imag() * r_.col(2);
    for (Index i : held_)
      u_[i] = 0.0;
    problem_.solve(Ref(u_));
    ++statistics_.solves_real;
  } else {
    uc_.real() = t.w_c[0].real() * r_.col(0) + t.w_c[1].real() * r_.col(1);
    uc_.imag() = t.w_c[0].imag() * r_.col(0) + t.w_c[1].imag() * r_.col(1);
  }
  for (Index i : held_)
    uc_[i] = 0.0;
  problem_.solve(RefC(uc_));
  ++statistics_.solves_complex;
  for (int i = 0; i < s_; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double re = 2.0 * t.x_c[k].real(), im = -2.0 * t.x_c[k].imag();
    if (s_ == 3)
      r_.col(i) = re * uc_.real() + im * uc_.imag() + t.x_r[k] * u_;
    else
      r_.col(i) = re * uc_.real() + im * uc_.imag();
  }
  y_ -= r_;
  return std::isfinite(r_.sum());
}

void Collocation::newton(double h, Attempt& out) {
  out.status = StepStatus::domain;
  if (!evaluate_stages(h)) {
    // the extrapolated polynomial may leave the domain where the motion does not
    if (!have_history_) return;
    predict(h, false);
    if (!evaluate_stages(h)) return;
  }
  newton_.begin();
  constexpr int most_linearizations = 4;
  for (int again = 0;;) {
    const bool finite = correct();
    ++out.iterations;
    if (out.iterations == 1) {
      dq_ = h * v0_ + y_.col(s_ - 1);
      scale_.begin_step(dq_);
    }
    if (problem_.is_linear()) {
      newton_.update(0.0, 0.0);
      out.status = finite ? StepStatus::ok : StepStatus::newton;
      return;
    }
    double change = infinity;
    if (finite) {
      change = 0.0;
      for (int i = 0; i < s_; ++i)
        change = std::max(change, scale_.norm(r_.col(i)));
    }
    switch (newton_.update(change, scale_.rounding())) {
      case NewtonMonitor::Verdict::converged:
        out.status = StepStatus::ok;
        if (newton_.slow()) linearize_ = true;
        return;
      case NewtonMonitor::Verdict::failed:
        newton_.forget();
        if (finite && smooth() && again++ < most_linearizations && linearize_inside(h)) {
          newton_.begin();
          break;
        }
        out.status = StepStatus::newton;
        linearize_ = true;
        return;
      case NewtonMonitor::Verdict::iterate: break;
    }
    if (!evaluate_stages(h)) return;
  }
}

void Collocation::finish(double h) {
  const double h2 = 1.0 / (h * h);
  for (int i = 0; i < s_; ++i) {
    const auto& d = tab_.Ainv2[static_cast<std::size_t>(i)];
    if (s_ == 3)
      a_stage_.col(i) = (h2 * d[0]) * y_.col(0) + (h2 * d[1]) * y_.col(1) + (h2 * d[2]) * y_.col(2);
    else
      a_stage_.col(i) = (h2 * d[0]) * y_.col(0) + (h2 * d[1]) * y_.col(1);
  }
  if (tab_.stiffly_accurate) {
    const auto& b = tab_.Ainv[static_cast<std::size_t>(s_ - 1)];
    dq_ = h * v0_ + y_.col(s_ - 1);
    e_ = (b[0] / h) * y_.col(0) + (b[1] / h) * y_.col(1) + (b[2] / h) * y_.col(2);
    a_ = a_stage_.col(s_ - 1);
  } else {
    dq_ = h * v0_;
    e_.setZero();
    a_.setZero();
    for (int j = 0; j < s_; ++j) {
      const auto k = static_cast<std::size_t>(j);
      dq_ += (h * h * tab_.b[k] * (1.0 - tab_.c[k])) * a_stage_.col(j);
      e_ += (h * tab_.b[k]) * a_stage_.col(j);
      a_ += tab_.at_one[k] * a_stage_.col(j);
    }
  }
  add_compensated(q0_, q0_low_, dq_, q_, q_low_);
  add_compensated(v0_, v0_low_, e_, v_, v_low_);
  problem_.impose(t1_eval_, q_, v_, a_);
  for (Index i : held_)
    q_low_[i] = v_low_[i] = 0.0;
}

double Collocation::estimate(double h) {
  // rho_q = v0 - u'(0) = -(1/h) sum_ij l_i(0) (A^-1)_ij Y_j: without v0, it cancels exactly
  std::array<double, Tableau::max_stages> g{};
  for (int i = 0; i < s_; ++i)
    for (int j = 0; j < s_; ++j)
      g[static_cast<std::size_t>(j)] -=
          tab_.at_zero[static_cast<std::size_t>(i)] *
          tab_.Ainv[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] / h;
  if (s_ == 3) {
    rho_q_ = g[0] * y_.col(0) + g[1] * y_.col(1) + g[2] * y_.col(2);
    rho_v_ = a0_ - (tab_.at_zero[0] * a_stage_.col(0) + tab_.at_zero[1] * a_stage_.col(1) +
                    tab_.at_zero[2] * a_stage_.col(2));
  } else {
    rho_q_ = g[0] * y_.col(0) + g[1] * y_.col(1);
    rho_v_ = a0_ - (tab_.at_zero[0] * a_stage_.col(0) + tab_.at_zero[1] * a_stage_.col(1));
  }
  for (Index i : held_)
    rho_q_[i] = rho_v_[i] = 0.0;

  const bool consistent = tab_.stiffly_accurate || first_;  // a0 solves the equations at the start
  return taken_again(h, filtered(h, consistent ? nullptr : &start_residual_));
}

double Collocation::size_of_defect(double h, const VecX& rho_q) {
  u_ = tab_.mu * e_ - h * rho_q;              // h e_v
  dq_ = u_.cwiseProduct(initial_.dynamic());  // rates of massless unknowns are results, not states
  return std::max(scale_.error_norm(e_), scale_.error_norm(dq_) * std::max(1.0, rate_span_ / h)) /
         allowance_;
}

double Collocation::filtered(double h, const VecX* r) {
  u_ = rho_v_ + (tab_.mu / h) * rho_q_;
  e_.setZero();
  problem_.add_M(1.0, u_, e_);
  problem_.add_C(1.0, rho_q_, e_);
  if (r) e_ -= *r;
  for (Index i : held_)
    e_[i] = 0.0;
  problem_.solve(Ref(e_));
  ++statistics_.solves_real;
  return size_of_defect(h, rho_q_);
}

double Collocation::taken_again(double h, double error) {
  if (!(error > 1.0) || !(first_ || retrying_)) return error;
  qs_ = q0_ + e_;
  vs_ = v0_ + u_ / h;
  as_ = a0_;
  for (Index i : held_) {
    qs_[i] = q0_[i];
    vs_[i] = v0_[i];
  }
  rho_q_ += u_ / h;
  if (!residual(t0_, qs_, vs_, as_, r_.col(0))) return error;
  vs_ = r_.col(0);
  return std::min(error, filtered(h, &vs_));
}

bool Collocation::bound_along(double h) {
  std::array<double, Tableau::max_stages> span{}, time{};
  const auto stages = static_cast<std::size_t>(s_);
  for (std::size_t i = 0; i < stages; ++i) {
    span[i] = tab_.c[i] * h;
    time[i] = stage_time(tab_.c[i], h);
  }
  if (!affine_->bound_along({t0_, q0_, v0_, {span.data(), stages}, {time.data(), stages}}))
    return false;
  const std::optional<std::span<const Index>> entries = affine_->changing_entries();
  if (!entries) return false;
  const auto count = static_cast<Index>(entries->size());
  changing_.resize(count, s_);
  changing_start_.resize(count);
  affine_->changing(t0_, changing_start_);
  for (std::size_t i = 0; i < stages; ++i)
    affine_->changing(time[i], changing_.col(static_cast<Index>(i)));
  return true;
}

bool Collocation::attempt_linear(double h, Attempt& out) {
  linear_step_ = free_stages_ = linear_ && bound_along(h);
  if (!linear_step_) return false;
  const std::span<const Index> entries = *affine_->changing_entries();
  if (!have_bound_) affine_->multiply(t0_, q0_, v0_, bound_, products_);
  have_bound_ = true;
  linear_->set_step(h);
  linear_->right_hand_sides(bound_, entries, changing_, u_, uc_);
  if (tab_.has_real) {
    problem_.solve(Ref(u_));
    ++statistics_.solves_real;
  }
  problem_.solve(RefC(uc_));
  ++statistics_.solves_complex;
  statistics_.residuals += s_ + (tab_.stiffly_accurate ? 0 : 1);  // as many are known
  ++out.iterations;
  if (!std::isfinite(u_.sum()) || !std::isfinite(uc_.sum().real() + uc_.sum().imag())) {
    out.status = StepStatus::newton;
    return true;
  }
  const bool consistent = tab_.stiffly_accurate || first_;
  linear_->finish(u_, uc_, {q0_, v0_, a0_, q0_low_, v0_low_}, consistent,
                  {a_stage_, q_, v_, a_, q_low_, v_low_, dq_, products_});
  problem_.impose(t1_eval_, q_, v_, a_);
  scale_.begin_step(dq_);
  affine_->multiply(t1_eval_, q_, v_, bound_end_, products_);
  out.error = estimate_linear(h, consistent);
  return true;
}

double Collocation::estimate_linear(double h, bool consistent) {
  // M a0 of an inconsistent start is what its bound leaves
  start_forces_ = products_.inertia;
  if (!consistent) {
    start_forces_ += bound_.force;
    const std::span<const Index> entries = *affine_->changing_entries();
    for (std::size_t e = 0; e < entries.size(); ++e)
      start_forces_[entries[e]] += changing_start_[static_cast<Index>(e)];
  }
  e_ = products_.filter - start_forces_;
  for (Index i : held_)
    e_[i] = 0.0;
  problem_.solve(Ref(e_));
  ++statistics_.solves_real;
  const double error = size_of_defect(h, products_.filter_of);
  if (!(error > 1.0) || !(first_ || retrying_)) return error;
  rho_q_ = products_.filter_of;
  rho_v_ = consistent ? VecX(-products_.inertia_of) : VecX(a0_ - products_.inertia_of);
  for (Index i : held_)
    rho_v_[i] = 0.0;
  return taken_again(h, error);
}

Stepper::Attempt Collocation::attempt(double h) {
  Attempt out;
  if (attempt_linear(h, out)) return out;
  if (!tab_.stiffly_accurate && !first_ && !have_start_residual_) {
    have_start_residual_ = residual(t0_, q0_, v0_, a0_, start_residual_);
    if (!have_start_residual_) {
      out.status = StepStatus::domain;
      return out;
    }
  }
  predict(h, have_history_);
  if (hard_ > 0)
    for (int i = 0; i < s_; ++i)
      y_.col(i) = y_.col(i).cwiseProduct(initial_.dynamic());
  newton(h, out);
  constexpr int wary = 8;  // attempts
  const bool slow = out.status == StepStatus::newton || 2 * out.iterations >= options_.max_newton;
  if (out.status != StepStatus::domain) hard_ = hard_ > 0 ? hard_ - 1 : slow ? wary : 0;
  if (out.status != StepStatus::ok) return out;
  finish(h);
  // Gauss: the end is no stage. Its residual shows whether the model holds there, and serves the
  // next step's estimate.
  if (!tab_.stiffly_accurate && !residual(t1_eval_, q_, v_, a_, end_residual_)) {
    out.status = StepStatus::domain;
    return out;
  }
  out.error = estimate(h);
  return out;
}

const VecX& Collocation::step_error(double h, double error) {
  const double rates = std::max(1.0, rate_span_ / h);
  for (Index i = 0; i < n_; ++i)
    if (std::abs(rates * dq_[i]) > std::abs(e_[i])) e_[i] = rates * dq_[i];
  // of two estimates the smaller one counts (taken_again)
  if (first_ || retrying_) {
    const double size = scale_.error_norm(e_) / allowance_;
    if (size > error) e_ *= error / size;
  }
  return e_;
}

void Collocation::commit(double h) {
  a_last_.swap(a_stage_);
  h_last_ = h;
  theta_start_ = 1.0;
  have_history_ = true;
  bound_.force.swap(bound_end_.force);
  bound_.rate.swap(bound_end_.rate);
  have_bound_ = linear_step_;
  if (linear_step_) {
    have_start_residual_ = had_start_residual_ = false;
    return;
  }
  start_before_.swap(start_residual_);
  start_residual_.swap(end_residual_);
  had_start_residual_ = have_start_residual_;
  have_start_residual_ = true;
}

void Collocation::rewind() {
  theta_start_ = 0.0;
  have_bound_ = false;
  start_residual_.swap(start_before_);
  have_start_residual_ = had_start_residual_;
}

void Collocation::drop_history() { have_history_ = have_start_residual_ = have_bound_ = false; }

template <int S, class Entry>
void Collocation::dense_of(double theta, Index count, const Entry& entry, Ref q, Ref v,
                           Ref a) const {
  WHIRL_EXPECTS(s_ == S);
  const Tableau::Basis b = tab_.basis(theta);
  double on_q[S], on_v[S], on_a[S];
  for (int j = 0; j < S; ++j) {
    const auto k = static_cast<std::size_t>(j);
    on_q[j] = h_ * h_ * b.l2[k];
    on_v[j] = h_ * b.l1[k];
    on_a[j] = b.l[k];
  }
  const double along = theta * h_;
  // one pass: the vectors are read once
  for (Index k = 0; k < count; ++k) {
    const Index i = entry(k);
    double q_i = q0_[i] + along * v0_[i], v_i = v0_[i], a_i = 0.0;
    for (int j = 0; j < S; ++j) {
      const double stage = a_last_(i, j);
      a_i += on_a[j] * stage;
      v_i += on_v[j] * stage;
      q_i += on_q[j] * stage;
    }
    q[i] = q_i;
    v[i] = v_i;
    a[i] = a_i;
  }
}

template <class Entry>
void Collocation::dense_at(double theta, Index count, const Entry& entry, Ref q, Ref v,
                           Ref a) const {
  WHIRL_EXPECTS(h_ > 0.0);
  switch (s_) {
    case 1: return dense_of<1>(theta, count, entry, q, v, a);
    case 2: return dense_of<2>(theta, count, entry, q, v, a);
    default: return dense_of<3>(theta, count, entry, q, v, a);
  }
}

void Collocation::dense(double theta, Ref q, Ref v, Ref a) const {
  dense_at(
      theta, n_, [](Index k) { return k; }, q, v, a);
}

bool Collocation::dense_some(double theta, std::span<const Index> entries, Ref q, Ref v,
                             Ref a) const {
  const auto entry = [entries](Index k) { return entries[static_cast<std::size_t>(k)]; };
  dense_at(theta, static_cast<Index>(entries.size()), entry, q, v, a);
  return true;
}

template <int S>
void Collocation::dense_entries_of(double theta, std::span<const Index> entries, Ref q) const {
  WHIRL_EXPECTS(s_ == S && h_ > 0.0);
  const Tableau::Basis b = tab_.basis(theta);
  double on_q[S];
  for (int j = 0; j < S; ++j)
    on_q[j] = h_ * h_ * b.l2[static_cast<std::size_t>(j)];
  const double along = theta * h_;
  double* out = q.data();
  for (const Index k : entries) {
    double at = q0_[k] + along * v0_[k];
    for (int j = 0; j < S; ++j)
      at += on_q[j] * a_last_(k, j);
    *out++ = at;
  }
}

bool Collocation::dense_entries(double theta, std::span<const Index> entries, Ref q) const {
  switch (s_) {
    case 1: dense_entries_of<1>(theta, entries, q); break;
    case 2: dense_entries_of<2>(theta, entries, q); break;
    default: dense_entries_of<3>(theta, entries, q);
  }
  return true;
}

void Collocation::save_history(std::vector<double>& out) const {
  out.insert(out.end(), {h_last_, theta_start_, have_history_ ? 1.0 : 0.0,
                         have_start_residual_ ? 1.0 : 0.0, static_cast<double>(hard_)});
  newton_.save(out);
  out.insert(out.end(), a_last_.data(), a_last_.data() + a_last_.size());
  out.insert(out.end(), start_residual_.data(), start_residual_.data() + n_);
}

const double* Collocation::restore_history(const double* in) {
  h_last_ = *in++;
  theta_start_ = *in++;
  have_history_ = *in++ != 0.0;
  have_start_residual_ = *in++ != 0.0;
  hard_ = static_cast<int>(*in++);
  have_bound_ = false;
  in = newton_.restore(in);
  std::copy_n(in, a_last_.size(), a_last_.data());
  in += a_last_.size();
  std::copy_n(in, n_, start_residual_.data());
  return in + n_;
}

}  // namespace whirl::time
