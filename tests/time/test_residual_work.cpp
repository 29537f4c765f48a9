// The work of the residual along the interpolant, which two products with the matrices give, against
// the integral of v . R at many points of every step.
#include "dense_problem.hpp"

#include <gtest/gtest.h>
#include <time/affine.hpp>

#include <array>
#include <optional>

namespace whirl::time::test {
namespace {

/// Two masses between springs and dampers, a massless point with a damper, and an unknown whose row
/// does no work; harmonic loads on the first mass and the massless point.
class Affine final : public LinearProblem, public AffineProblem {
 public:
  Affine()
      : LinearProblem(all(4), mass(), damping(), stiffness(), [this](double t, Ref f) {
          f[1] = 3.0 + 0.5 * t;
          f[0] = load(t)[0];
          f[2] = load(t)[1];
        }) {}
  static std::array<double, 2> load(double t) {
    return {20.0 * std::cos(31.0 * t), 5.0 * std::sin(31.0 * t) + 2.0 * std::cos(62.0 * t)};
  }
  bool residuals_along(const FreeMotion& m, Eigen::Ref<MatX> r) override {
    const VecX still = VecX::Zero(size());
    for (std::size_t k = 0; k < m.span.size(); ++k) {
      VecX q = m.q + m.span[k] * m.v, v = m.v, out(size());
      residual(m.time[k], q, v, still, out);
      r.col(static_cast<Index>(k)) = out;
    }
    return !series_unknown;
  }
  bool bound_along(const FreeMotion&) override { return tells_bound && !series_unknown; }
  void multiply(double t, CRef q, CRef v, Bound& bound, StepProducts& step) override {
    const MatX M = mass(), C = damping(), K = stiffness();
    bound.force = K * q + C * v;
    bound.force[1] -= 3.0 + 0.5 * t;
    bound.rate = K * v;
    bound.rate[1] -= 0.5;
    step.stiff = K * step.stiff_of;
    step.inertia = M * step.inertia_of;
    step.filter = (step.shift * M + C) * step.filter_of;
  }
  std::optional<std::span<const Index>> changing_entries() const override { return entries_; }
  void changing(double t, Ref values) const override {
    values[0] = -load(t)[0];
    values[1] = -load(t)[1];
  }
  std::span<const unsigned char> works() const override { return works_; }
  bool series_unknown = false, tells_bound = true;

 private:
  static MatX mass() { return VecX{{2.0, 1.0, 0.0, 1.0}}.asDiagonal(); }
  static MatX damping() {
    MatX c = VecX{{1.0, 0.5, 8.0, 3.0}}.asDiagonal();
    c(0, 1) = 2.0;  // gyroscopic
    c(1, 0) = -2.0;
    return c;
  }
  static MatX stiffness() {
    MatX k = VecX{{3000.0, 2000.0, 500.0, 40.0}}.asDiagonal();
    k(0, 1) = k(1, 0) = -800.0;
    k(0, 2) = k(2, 0) = -300.0;
    k(3, 0) = 7.0;
    return k;
  }
  std::array<Index, 2> entries_{0, 2};
  std::array<unsigned char, 4> works_{1, 1, 1, 0};
};

/// Integral of v . R over the last step: Gauss's two points on 40 and 80 parts, extrapolated.
double integrated(const Integrator& scheme, Affine& problem, double t0, double t1) {
  VecX q(4), v(4), a(4), r(4);
  const auto power = [&](double t) {
    scheme.interpolate(t, q, v, a);
    problem.residual(t, q, v, a, r);
    return v.head<3>().dot(r.head<3>());
  };
  // never at an end: there the state itself is given, whose acceleration is another one
  const auto sum = [&](int parts) {
    const double h = (t1 - t0) / parts, inner = 0.5 / std::sqrt(3.0);
    double work = 0.0;
    for (int k = 0; k < parts; ++k)
      for (const double x : {0.5 - inner, 0.5 + inner})
        work += 0.5 * h * power(t0 + (k + x) * h);
    return work;
  };
  const double coarse = sum(40), fine = sum(80);
  return fine + (fine - coarse) / 15.0;
}

class ResidualWorkOf : public testing::TestWithParam<const char*> {};

TEST_P(ResidualWorkOf, IsTheIntegralOverTheInterpolant) {
  for (const auto& [dt, tells_bound] :  // equal steps, and adaptive ones
       {std::pair(2e-2, true), std::pair(2e-2, false), std::pair(0.0, true),
        std::pair(0.0, false)}) {
    Affine problem;
    problem.tells_bound = tells_bound;
    Options options;
    options.tolerance = 1e-3;
    options.dt_fixed = dt;
    options.t_end = 1.0;
    const auto scheme = make_integrator(GetParam(), problem, options);
    scheme->start(0.0, VecX{{0.01, 0.0, 0.02, 1.0}}, VecX{{0.0, 0.3, 0.0, 0.0}});
    double size = 0.0;
    int steps = 0;
    while (scheme->time() < options.t_end) {
      const StepReport step = scheme->advance();
      ASSERT_TRUE(step.ok());
      const std::optional<double> work = scheme->residual_work();
      ASSERT_TRUE(work.has_value());
      const double expected = integrated(*scheme, problem, step.t0, step.t1);
      size = std::max(size, std::abs(expected));
      EXPECT_NEAR(*work, expected, 1e-7 * size + 1e-14) << step.t0 << " " << step.t1;
      ++steps;
    }
    EXPECT_GT(size, 1e-9);  // there is something to compare
    EXPECT_GT(steps, 20);
  }
}

// Steps by the bound of the state are those by residuals of their stages, estimates of errors and
// rejections included: a load that sets in suddenly, and steps that a stop shortens.
TEST_P(ResidualWorkOf, StepsByTheBoundAreThoseByResiduals) {
  Affine bound, residuals;
  residuals.tells_bound = false;
  Options options;
  options.tolerance = 1e-4;
  options.t_end = 1.0;
  options.dt_first = 0.1;  // too long: rejected
  options.breakpoints = {0.25};
  const auto one = make_integrator(GetParam(), bound, options);
  const auto other = make_integrator(GetParam(), residuals, options);
  for (Integrator* scheme : {one.get(), other.get()})
    scheme->start(0.0, VecX{{0.01, 0.0, 0.02, 1.0}}, VecX{{0.0, 0.3, 0.0, 0.0}});
  bool shortened = false;
  while (one->time() < options.t_end) {
    const StepReport a = one->advance(), b = other->advance();
    ASSERT_TRUE(a.ok() && b.ok());
    ASSERT_EQ(a.rejected_error, b.rejected_error);
    EXPECT_NEAR(a.t1, b.t1, 1e-8 * b.t1);
    EXPECT_NEAR(a.error, b.error, 1e-5 * (1.0 + b.error));
    EXPECT_LT((one->q() - other->q()).norm(), 1e-8 * other->q().norm());
    EXPECT_LT((one->v() - other->v()).norm(), 1e-8 * (0.1 + other->v().norm()));
    if (shortened || a.t1 < 0.5) continue;
    shortened = true;
    const double stop = 0.5 * (a.t0 + a.t1);
    ASSERT_TRUE(one->shorten_to(stop).ok() && other->shorten_to(stop).ok());
  }
  EXPECT_TRUE(shortened);
  EXPECT_GT(one->statistics().rejected_error, 0);
  EXPECT_EQ(one->statistics().rejected_error, other->statistics().rejected_error);
}

INSTANTIATE_TEST_SUITE_P(Schemes, ResidualWorkOf, testing::Values("radau5", "gauss4", "gauss6"),
                         [](const auto& scheme) { return std::string(scheme.param); });

TEST(ResidualWork, IsUnknownWhereStagesAreNotOfFreeMotion) {
  Affine problem;
  problem.series_unknown = true;
  Options options;
  options.dt_fixed = 1e-2;
  options.t_end = 0.1;
  const auto gauss = make_integrator("gauss6", problem, options);
  gauss->start(0.0, VecX::Zero(4), VecX::Zero(4));
  ASSERT_TRUE(gauss->advance().ok());
  EXPECT_FALSE(gauss->residual_work().has_value());
  LinearProblem other = oscillator(10.0);
  const auto radau = make_integrator("radau5", other, options);
  radau->start(0.0, VecX::Ones(1), VecX::Zero(1));
  ASSERT_TRUE(radau->advance().ok());
  EXPECT_FALSE(radau->residual_work().has_value());
}

}  // namespace
}  // namespace whirl::time::test
