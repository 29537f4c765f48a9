#include <time/initial.hpp>
#include <core/contract.hpp>

#include <cmath>

namespace whirl::time {

void InitialSolver::resize(Problem& problem) {
  WHIRL_EXPECTS(problem.kinds().size() == at(problem.size()));
  const Index n = problem.size();
  row_.assign(at(n), Row::dynamic);
  r_ = probe_ = q_start_ = v_start_ = a_start_ = VecX::Zero(n);
  dynamic_ = VecX::Ones(n);
  held_.clear();
  const auto kinds = problem.kinds();
  for (Index i = 0; i < n; ++i)
    if (kinds[at(i)] == Kind::held) held_.push_back(i);
}

void InitialSolver::classify(const Problem& problem) {
  WHIRL_EXPECTS(problem.size() == r_.size());
  // A row is zero exactly when its product with a vector in general position is: entries of
  // different size and sign cancel to the last bit only in rows that hold nothing.
  for (Index i = 0; i < probe_.size(); ++i)
    probe_[i] = std::fmod(0.6180339887498949 * static_cast<double>(i + 1), 1.0) + 0.5;
  r_.setZero();
  problem.add_M(1.0, probe_, r_);
  any_massless_ = false;
  for (Index i = 0; i < r_.size(); ++i) {
    row_[at(i)] = r_[i] == 0.0 ? Row::algebraic : Row::dynamic;
    dynamic_[i] = r_[i] == 0.0 ? 0.0 : 1.0;
  }
  r_.setZero();
  problem.add_C(1.0, probe_, r_);
  for (Index i = 0; i < r_.size(); ++i)
    if (row_[at(i)] == Row::algebraic && r_[i] != 0.0) row_[at(i)] = Row::first_order;
  for (Index i : held_) {
    row_[at(i)] = Row::dynamic;
    dynamic_[i] = 0.0;
  }
  for (Row row : row_)
    any_massless_ = any_massless_ || row != Row::dynamic;
}

bool InitialSolver::factor(Problem& problem, double tau, Statistics& statistics) const {
  ++statistics.factorizations_real;
  return problem.factor(1.0, tau, tau * tau);
}

double InitialSolver::take_correction(double tau, bool of_a, VecX& q, VecX& v, VecX& a) {
  // convergence in each class: increments against the values they correct
  double change = 0.0, size = 0.0;
  double change_massless = 0.0, size_massless = 0.0;
  for (Index i = 0; i < r_.size(); ++i) {
    switch (row_[at(i)]) {
      case Row::dynamic:
        a[i] -= r_[i];
        change = std::max(change, std::abs(r_[i]));
        size = std::max(size, std::abs(a[i]));
        break;
      case Row::first_order:
        v[i] -= tau * r_[i];
        change_massless = std::max(change_massless, std::abs(tau * r_[i]));
        size_massless = std::max(size_massless, std::abs(v[i]));
        break;
      case Row::algebraic:
        q[i] -= tau * tau * r_[i];
        change_massless = std::max(change_massless, std::abs(tau * tau * r_[i]));
        size_massless = std::max(size_massless, std::abs(q[i]));
        break;
    }
  }
  // where the massless stand still their values shrink with their corrections: the first ones are
  // the measure then
  constexpr double of_the_first = 1e-3;
  largest_massless_ = std::max(largest_massless_, size_massless);
  size_massless = std::max(size_massless, of_the_first * largest_massless_);
  return std::max(size > 0.0 && of_a ? change / size : 0.0,
                  size_massless > 0.0 ? change_massless / size_massless : 0.0);
}

bool InitialSolver::stand_still(double tau, const VecX& q) const {
  if (!any_massless_ || !r_.allFinite()) return false;
  double change = 0.0, size = 0.0;
  for (Index i = 0; i < r_.size(); ++i) {
    if (row_[at(i)] != Row::first_order) continue;
    change = std::max(change, std::abs(tau * r_[i]));
    size = std::max(size, std::abs(q[i]));
  }
  return size > 0.0 && change <= 1e-7 * size;
}

StepStatus InitialSolver::iterate(Problem& problem, double t, double tau, VecX& q, VecX& v, VecX& a,
                                  Statistics& statistics) {
  double previous = infinity;
  largest_massless_ = 0.0;
  for (int iteration = 0; iteration < 20; ++iteration) {
    ++statistics.residuals;
    if (!problem.residual(t, q, v, a, r_)) return StepStatus::domain;
    for (Index i : held_)
      r_[i] = 0.0;
    problem.solve(Ref(r_));
    if (!r_.allFinite()) break;
    // R is affine in a: two solutions determine it to round-off, which at an equilibrium (a = 0)
    // is all there is of a
    const double error = take_correction(tau, iteration < 2, q, v, a);
    // 1e-12: what a and the error filter need; at round-off the corrections stop shrinking
    if (error <= 1e-12 || (iteration > 1 && error <= 1e-8 && error >= 0.5 * previous))
      return StepStatus::ok;
    if (iteration > 3 && error > 2.0 * previous) break;
    previous = error;
  }
  return stand_still(tau, q) ? StepStatus::ok : StepStatus::newton;
}

StepStatus InitialSolver::solve(Problem& problem, double t, VecX& q, VecX& v, VecX& a,
                                Statistics& statistics) {
  WHIRL_EXPECTS(q.size() == r_.size() && v.size() == r_.size() && a.size() == r_.size());
  ++statistics.linearizations;
  problem.linearize(t, q, v, a);
  classify(problem);
  // Matrix of a step of length tau: massless rows need C or K in it, the others want tau -> 0.
  static constexpr double lengths[] = {0.0, 1e-8, 1e-10, 1e-6, 1e-12, 1e-4};
  q_start_ = q;
  v_start_ = v;
  a_start_ = a;
  StepStatus status = StepStatus::singular;
  for (double tau : lengths) {
    if (any_massless_ && tau == 0.0) continue;
    if (!factor(problem, tau, statistics)) continue;
    q = q_start_;
    v = v_start_;
    a = a_start_;
    status = iterate(problem, t, tau, q, v, a, statistics);
    if (status != StepStatus::newton) return status;
  }
  return status;
}

StepStatus InitialSolver::impulse(Problem& problem, const VecX& dv_held, VecX& v,
                                  Statistics& statistics) {
  WHIRL_EXPECTS(dv_held.size() == r_.size() && v.size() == r_.size());
  if (!factor(problem, any_massless_ ? 1e-8 : 0.0, statistics)) return StepStatus::singular;
  r_.setZero();
  problem.add_M(-1.0, dv_held, r_);
  for (Index i : held_)
    r_[i] = 0.0;
  problem.solve(Ref(r_));
  for (Index i = 0; i < r_.size(); ++i)
    if (row_[at(i)] == Row::dynamic) v[i] += r_[i];
  return StepStatus::ok;
}

void InitialSolver::save(std::vector<double>& out) const {
  for (Row row : row_)
    out.push_back(static_cast<double>(row));
  out.insert(out.end(), dynamic_.data(), dynamic_.data() + dynamic_.size());
}

const double* InitialSolver::restore(const double* in) {
  any_massless_ = false;
  for (Row& row : row_) {
    row = static_cast<Row>(static_cast<int>(*in++));
    any_massless_ = any_massless_ || row != Row::dynamic;
  }
  for (Index i = 0; i < dynamic_.size(); ++i)
    dynamic_[i] = *in++;
  return in;
}

}  // namespace whirl::time
