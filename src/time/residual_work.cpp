// R(theta) = M a + C v + K q + x(t) along the interpolant of a step: a(theta) the polynomial through
// the stages A_j, of degree s - 1, v and q its integrals from (q0, v0). The products are a
// polynomial of degree s + 1, known by its values at 0, c_1 .. c_s and its leading coefficient:
//   at the stages V_i and A_i are those of the interpolant, Q_i is not. With alpha the leading
//     coefficient of a, v departs from its polynomial through the V_j by (h alpha / s) P, P(theta) =
//     prod (theta - c_j), so q from Q_i by h^2 alpha phi(c_i), phi(theta) = (1/s) int_0^theta P;
//     the stages' equations hold, hence R(c_i) = h^2 phi(c_i) K alpha;
//   at 0 q and v are those of the state, a is not: R(0) = R(q0, v0, a0) - M (a0 - a(0));
//   the leading coefficient is h^2 K alpha / (s (s + 1)), that of h^2 phi K alpha.
// So, with l_i the Lagrange polynomials on 0, c_1 .. c_s,
//   R(theta) = h^2 phi K alpha + l_0 R(0) + x(theta) - sum_i l_i(theta) x_i:
// two products with the matrices, and x, which has few entries, at the nodes and where the work is
// summed. P is a multiple of l_0.
#include <time/residual_work.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::time {

namespace {

/// Point k of n of the Gauss-Legendre rule on [0, 1], and its weight.
void gauss_legendre(std::size_t k, std::size_t n, double& point, double& weight) {
  double x = std::cos(pi * (static_cast<double>(n - k) - 0.25) / (static_cast<double>(n) + 0.5));
  double slope = 0.0;
  for (int again = 0; again < 8; ++again) {
    double below = 1.0, p = x;  // Legendre's polynomials by their recursion
    for (std::size_t m = 2; m <= n; ++m) {
      const double d = static_cast<double>(m);
      const double next = ((2.0 * d - 1.0) * x * p - (d - 1.0) * below) / d;
      below = p;
      p = next;
    }
    slope = static_cast<double>(n) * (x * p - below) / (x * x - 1.0);
    x -= p / slope;
  }
  point = 0.5 * (1.0 + x);
  weight = 1.0 / ((1.0 - x * x) * slope * slope);
}

}  // namespace

ResidualWork::ResidualWork(const Tableau& tableau, Problem& problem, AffineProblem& affine)
    : tab_(tableau),
      problem_(problem),
      affine_(affine) {
  for (std::size_t p = 0; p < points; ++p)
    gauss_legendre(p, points, theta_[p], weight_[p]);

  const auto s = static_cast<std::size_t>(tab_.stages);
  std::array<double, Tableau::max_stages + 1> node{};
  std::copy_n(tab_.c.begin(), s, node.begin() + 1);
  std::array<double, Tableau::max_stages + 1> product{1.0};  // P, lowest power first
  for (std::size_t j = 0; j < s; ++j)
    for (std::size_t k = j + 2; k-- > 0;)
      product[k] = (k > 0 ? product[k - 1] : 0.0) - tab_.c[j] * product[k];
  for (std::size_t p = 0; p < points; ++p) {
    const double x = theta_[p];
    basis_[p] = tab_.basis(x);
    for (std::size_t i = 0; i <= s; ++i) {
      double l = 1.0;
      for (std::size_t k = 0; k <= s; ++k)
        if (k != i) l *= (x - node[k]) / (node[i] - node[k]);
      lagrange_[i][p] = l;
    }
    double phi = 0.0, power = x;
    for (std::size_t k = 0; k <= s; ++k, power *= x)
      phi += product[k] * power / static_cast<double>((k + 1) * s);
    phi_ += weight_[p] * phi;
    l0_ += weight_[p] * lagrange_[0][p];
    for (std::size_t j = 0; j < s; ++j) {
      phi_rate_[j] += weight_[p] * phi * basis_[p].l1[j];
      l0_rate_[j] += weight_[p] * lagrange_[0][p] * basis_[p].l1[j];
    }
  }
  for (VecX* x : {&combined_, &stiff_, &first_})
    *x = VecX::Zero(problem.size());
  const std::span<const unsigned char> works = affine.works();
  works_.resize(static_cast<Index>(works.size()));
  for (std::size_t i = 0; i < works.size(); ++i)
    works_[static_cast<Index>(i)] = works[i] ? 1.0 : 0.0;
}

void ResidualWork::multiply(const Step& step) {
  const int s = tab_.stages;
  combined_.setZero();
  for (int j = 0; j < s; ++j)
    combined_ += tab_.poly[static_cast<std::size_t>(j)][static_cast<std::size_t>(s - 1)] *
                 step.stages.col(j);
  stiff_.setZero();
  problem_.add_K(1.0, combined_, stiff_);
  combined_ = -step.a0;
  for (int j = 0; j < s; ++j)
    combined_ += tab_.at_zero[static_cast<std::size_t>(j)] * step.stages.col(j);
  if (step.start)
    first_ = *step.start;
  else
    first_.setZero();
  problem_.add_M(1.0, combined_, first_);
}

double ResidualWork::of_products(const Step& step, double scale, const VecX& stiff,
                                 const VecX& first) {
  // the work is linear in the rates: one sum for v0 and one for each stage
  working_stiff_ = works_.cwiseProduct(stiff);
  working_first_ = works_.cwiseProduct(first);
  double work = (scale * phi_ * working_stiff_ + l0_ * working_first_).dot(step.v0);
  for (int j = 0; j < tab_.stages; ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double of_phi = scale * step.h * phi_rate_[k], of_l0 = step.h * l0_rate_[k];
    work += (of_phi * working_stiff_ + of_l0 * working_first_).dot(step.stages.col(j));
  }
  return step.h * work;
}

double ResidualWork::of_loads(const Step& step, std::span<const Index> entries) {
  const std::span<const unsigned char> works = affine_.works();
  const auto s = static_cast<std::size_t>(tab_.stages);
  const auto time_at = [&](double theta) { return step.t0 + (theta * step.h + step.t0_low); };
  at_nodes_.resize(static_cast<Index>(entries.size()), tab_.stages + 1);
  at_point_.resize(static_cast<Index>(entries.size()));
  affine_.changing(time_at(0.0), at_nodes_.col(0));
  for (std::size_t i = 0; i < s; ++i)
    affine_.changing(time_at(tab_.c[i]), at_nodes_.col(static_cast<Index>(i) + 1));
  double work = 0.0;
  for (std::size_t p = 0; p < points; ++p) {
    affine_.changing(time_at(theta_[p]), at_point_);
    for (std::size_t i = 0; i <= s; ++i)
      at_point_ -= lagrange_[i][p] * at_nodes_.col(static_cast<Index>(i));
    double power = 0.0;
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const Index k = entries[e];
      if (!works[at(k)]) continue;
      double rate = step.v0[k];
      for (std::size_t j = 0; j < s; ++j)
        rate += step.h * basis_[p].l1[j] * step.stages(k, static_cast<Index>(j));
      power += rate * at_point_[static_cast<Index>(e)];
    }
    work += weight_[p] * power;
  }
  return step.h * work;
}

std::optional<double> ResidualWork::of(const Step& step) {
  WHIRL_EXPECTS(step.h > 0.0 && step.stages.cols() == tab_.stages);
  const std::optional<std::span<const Index>> entries = affine_.changing_entries();
  if (!entries) return std::nullopt;
  multiply(step);
  return of_products(step, step.h * step.h, stiff_, first_) + of_loads(step, *entries);
}

std::optional<double> ResidualWork::of(const Step& step, const VecX& stiff, const VecX& first) {
  WHIRL_EXPECTS(step.h > 0.0 && stiff.size() == step.v0.size() && first.size() == stiff.size());
  const std::optional<std::span<const Index>> entries = affine_.changing_entries();
  if (!entries) return std::nullopt;
  return of_products(step, step.h * step.h, stiff, first) + of_loads(step, *entries);
}

}  // namespace whirl::time
