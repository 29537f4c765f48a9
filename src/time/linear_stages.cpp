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
lanes::Weights LinearStages::sum_of(const lanes::Weights* x, Coefficient&& c) const {
  lanes::Weights sum;
  for (std::size_t j = 0; j < static_cast<std::size_t>(tab_.stages); ++j) {
    sum.real += c(j) * x[j].real;
    sum.re += c(j) * x[j].re;
    sum.im += c(j) * x[j].im;
  }
  return sum;
}

void LinearStages::set_step(double h) {
  WHIRL_EXPECTS(h > 0.0);
  if (h == h_) return;
  h_ = h;
  const auto s = static_cast<std::size_t>(tab_.stages);
  const std::size_t last = s - 1;
  lanes::Weights y[Tableau::max_stages];
  for (std::size_t i = 0; i < s; ++i)
    y[i] = {-tab_.x_r[i], -2.0 * tab_.x_c[i].real(), 2.0 * tab_.x_c[i].imag()};
  lanes::Sums& w = sums_;
  for (std::size_t i = 0; i < s; ++i)
    w.stage[i] = sum_of(y, [&](std::size_t j) { return tab_.Ainv2[i][j] / (h * h); });
  w.last = y[last];
  if (tab_.stiffly_accurate) {
    w.increment = w.last;
    w.rate_increment = sum_of(y, [&](std::size_t j) { return tab_.Ainv[last][j] / h; });
    w.end = w.stage[last];
  } else {
    w.increment =
        sum_of(w.stage, [&](std::size_t j) { return h * h * tab_.b[j] * (1.0 - tab_.c[j]); });
    w.rate_increment = sum_of(w.stage, [&](std::size_t j) { return h * tab_.b[j]; });
    w.end = sum_of(w.stage, [&](std::size_t j) { return tab_.at_one[j]; });
  }
  w.at_start = sum_of(w.stage, [&](std::size_t j) { return tab_.at_zero[j]; });
  w.leading = sum_of(w.stage, [&](std::size_t j) { return tab_.poly[j][last]; });
  w.defect = sum_of(y, [&](std::size_t j) {
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
  if (tab_.has_real)
    real = of_force * bound.force + of_rate * bound.rate;
  else
    real.setZero();
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

void LinearStages::finish(const VecX& real, const VecXc& complex, const Start& start,
                          bool consistent, const End& end) const {
  WHIRL_EXPECTS(end.stages.rows() == real.size() && end.stages.cols() == tab_.stages);
  const lanes::Vectors vectors{real.size(),
                               real.data(),
                               reinterpret_cast<const double*>(complex.data()),
                               start.q.data(),
                               start.v.data(),
                               start.a.data(),
                               start.q_low.data(),
                               start.v_low.data(),
                               h_,
                               consistent ? 1.0 : 0.0,
                               end.stages.data(),
                               end.q.data(),
                               end.v.data(),
                               end.a.data(),
                               end.q_low.data(),
                               end.v_low.data(),
                               end.last_increment.data(),
                               end.products.stiff_of.data(),
                               end.products.inertia_of.data(),
                               end.products.filter_of.data()};
  const lanes::Kernels& kernels = lanes::kernels();
  (tab_.stages == 3 ? kernels.finish_three : kernels.finish_two)(sums_, vectors);
  StepProducts& p = end.products;
  p.shift = tab_.mu / h_;
  for (const Index k : held_) {
    end.q_low[k] = end.v_low[k] = 0.0;
    p.filter_of[k] = p.inertia_of[k] = 0.0;
  }
}

}  // namespace whirl::time
