// The stages' equations are those of collocation.cpp. Along free motion the residual of stage i is
// force + c_i h rate + x(t_i), so that the right-hand sides need no residuals of stages:
//   sum_i w_i R_i = (sum w_i) force + (h sum w_i c_i) rate + sum_i w_i x(t_i).
// Whatever follows from the solutions u (real) and z (complex) of the decoupled systems is a sum
// over them, Y_i = -(x_i u + 2 Re(x_i z)), with weights known from the scheme and the step's length:
// one pass gives the accelerations of the stages, the end, and what the estimate of the error and
// the balance of energy ask of the matrices.
#include <time/linear_stages.hpp>

namespace whirl::time {

LinearStages::LinearStages(const Tableau& tableau, std::span<const Index> held)
    : tab_(tableau),
      held_(held.begin(), held.end()) {}

template <class Coefficient>
LinearStages::Weights LinearStages::sum_of(const std::array<Weights, Tableau::max_stages>& x,
                                           Coefficient&& c) const {
  Weights sum{};
  for (std::size_t j = 0; j < static_cast<std::size_t>(tab_.stages); ++j)
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += c(j) * x[j][k];
  return sum;
}

void LinearStages::set_step(double h) {
  WHIRL_EXPECTS(h > 0.0);
  if (h == h_) return;
  h_ = h;
  const auto s = static_cast<std::size_t>(tab_.stages);
  const std::size_t last = s - 1;
  std::array<Weights, Tableau::max_stages> y{};
  for (std::size_t i = 0; i < s; ++i)
    y[i] = {-tab_.x_r[i], -2.0 * tab_.x_c[i].real(), 2.0 * tab_.x_c[i].imag()};
  for (std::size_t i = 0; i < s; ++i)
    stage_[i] = sum_of(y, [&](std::size_t j) { return tab_.Ainv2[i][j] / (h * h); });
  last_ = y[last];
  if (tab_.stiffly_accurate) {
    increment_ = last_;
    rate_increment_ = sum_of(y, [&](std::size_t j) { return tab_.Ainv[last][j] / h; });
    end_ = stage_[last];
  } else {
    increment_ =
        sum_of(stage_, [&](std::size_t j) { return h * h * tab_.b[j] * (1.0 - tab_.c[j]); });
    rate_increment_ = sum_of(stage_, [&](std::size_t j) { return h * tab_.b[j]; });
    end_ = sum_of(stage_, [&](std::size_t j) { return tab_.at_one[j]; });
  }
  at_start_ = sum_of(stage_, [&](std::size_t j) { return tab_.at_zero[j]; });
  leading_ = sum_of(stage_, [&](std::size_t j) { return tab_.poly[j][last]; });
  defect_ = sum_of(y, [&](std::size_t j) {
    double c = 0.0;
    for (std::size_t i = 0; i < s; ++i)
      c -= tab_.at_zero[i] * tab_.Ainv[i][j] / h;
    return c;
  });
}

void LinearStages::right_hand_sides(const Bound& bound, std::span<const Index> entries,
                                    const MatX& changing, VecX& real, VecXc& complex) const {
  WHIRL_EXPECTS(bound.force.size() == real.size() && complex.size() == real.size());
  WHIRL_EXPECTS(changing.rows() == static_cast<Index>(entries.size()));
  const auto s = static_cast<std::size_t>(tab_.stages);
  double of_force = 0.0, of_rate = 0.0;
  Complex of_force_c = 0.0, of_rate_c = 0.0;
  for (std::size_t i = 0; i < s; ++i) {
    of_force += tab_.w_r[i];
    of_rate += tab_.w_r[i] * (tab_.c[i] * h_);
    of_force_c += tab_.w_c[i];
    of_rate_c += tab_.w_c[i] * (tab_.c[i] * h_);
  }
  if (tab_.has_real) real = of_force * bound.force + of_rate * bound.rate;
  complex.real() = of_force_c.real() * bound.force + of_rate_c.real() * bound.rate;
  complex.imag() = of_force_c.imag() * bound.force + of_rate_c.imag() * bound.rate;
  for (std::size_t e = 0; e < entries.size(); ++e)
    for (std::size_t i = 0; i < s; ++i) {
      const double x = changing(static_cast<Index>(e), static_cast<Index>(i));
      if (tab_.has_real) real[entries[e]] += tab_.w_r[i] * x;
      complex[entries[e]] += tab_.w_c[i] * x;
    }
  for (const Index k : held_) {
    if (tab_.has_real) real[k] = 0.0;
    complex[k] = 0.0;
  }
}

namespace {

/// sum = x + dx with the rounding error carried in low (Knuth's two-sum).
inline void add_compensated(double x, double x_low, double dx, double& sum, double& low) {
  const double d = dx + x_low;
  const double s = x + d;
  const double b = s - x;
  low = (x - (s - b)) + (d - b);
  sum = s;
}

}  // namespace

template <int S>
void LinearStages::finish_stages(const VecX& real, const VecXc& complex, const Start& start,
                                 bool consistent, const End& end) const {
  const Index n = real.size();
  const double subtracted = consistent ? 1.0 : 0.0;
  const auto* const z = reinterpret_cast<const double*>(complex.data());
  const double *const u = real.data(), *const q0 = start.q.data(), *const v0 = start.v.data(),
                      *const a0 = start.a.data(), *const q0_low = start.q_low.data(),
                      *const v0_low = start.v_low.data();
  double* const stages = end.stages.data();
  double *const q = end.q.data(), *const v = end.v.data(), *const a = end.a.data(),
                *const q_low = end.q_low.data(), *const v_low = end.v_low.data(),
                *const last = end.last_increment.data(),
                *const stiff = end.products.stiff_of.data(),
                *const inertia = end.products.inertia_of.data(),
                *const filter = end.products.filter_of.data();
#pragma GCC ivdep
  for (Index i = 0; i < n; ++i) {
    const double x = u[i], re = z[2 * i], im = z[2 * i + 1], free = h_ * v0[i];
    const auto sum = [&](const Weights& w) { return w[0] * x + w[1] * re + w[2] * im; };
    for (int j = 0; j < S; ++j)
      stages[j * n + i] = sum(stage_[static_cast<std::size_t>(j)]);
    a[i] = sum(end_);
    last[i] = free + sum(last_);
    stiff[i] = sum(leading_);
    inertia[i] = sum(at_start_) - subtracted * a0[i];
    filter[i] = sum(defect_);
    add_compensated(q0[i], q0_low[i], free + sum(increment_), q[i], q_low[i]);
    add_compensated(v0[i], v0_low[i], sum(rate_increment_), v[i], v_low[i]);
  }
}

void LinearStages::finish(const VecX& real, const VecXc& complex, const Start& start,
                          bool consistent, const End& end) const {
  WHIRL_EXPECTS(end.stages.rows() == real.size() && end.stages.cols() == tab_.stages);
  if (tab_.stages == 3)
    finish_stages<3>(real, complex, start, consistent, end);
  else
    finish_stages<2>(real, complex, start, consistent, end);
  StepProducts& p = end.products;
  p.shift = tab_.mu / h_;
  for (const Index k : held_) {
    end.q_low[k] = end.v_low[k] = 0.0;
    p.filter_of[k] = p.inertia_of[k] = 0.0;
  }
}

}  // namespace whirl::time
