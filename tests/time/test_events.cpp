// Events on the dense output, and steps made again to end on them.
#include "sign_watch.hpp"
#include "toys.hpp"
#include <gtest/gtest.h>
#include <cmath>

namespace whirl::time::test {
namespace {

TEST(Events, CrossingsAreFoundInOrder) {
  for (const char* name : {"radau5", "gauss4", "gauss6", "generalized_alpha"}) {
    auto p = oscillator(1.0);
    Options o;
    o.tolerance = name == std::string_view("generalized_alpha") ? 1e-4 : 1e-8;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
    for (int direction : {0, 1, -1}) {
      integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
      SignWatch watch(
          1, [](CRef q, CRef) { return q[0] - 0.5; }, direction);
      watch.begin(*integrator);
      std::vector<double> found;
      integrator->set_end(14.0);
      while (integrator->time() < 14.0) {
        const StepReport s = integrator->advance();
        ASSERT_TRUE(s.ok());
        double t = 0.0;
        if (watch.find(*integrator, s, t)) {
          found.push_back(t);
          EXPECT_GT(t, s.t0);
          EXPECT_LE(t, s.t1);
        }
      }
      std::vector<double> exact;
      for (int k = 0; k < 3; ++k) {
        if (direction <= 0) exact.push_back(pi / 3.0 + two_pi * k);
        if (direction >= 0) exact.push_back(two_pi * (k + 1) - pi / 3.0);
      }
      std::erase_if(exact, [](double t) { return t > 14.0; });
      ASSERT_EQ(found.size(), exact.size()) << name << " " << direction;
      for (std::size_t k = 0; k < exact.size(); ++k)
        EXPECT_NEAR(found[k], exact[k], 10.0 * o.tolerance) << name;
    }
  }
}

// Two crossings inside one step: the first is reported.
TEST(Events, TwoCrossingsInOneStep) {
  auto p = oscillator(1.0);
  Options o;
  o.dt_fixed = 2.5;
  auto integrator = make_integrator("gauss6", p, o);
  integrator->start(-1.25, VecX::Constant(1, std::cos(1.25)), VecX::Constant(1, std::sin(1.25)));
  SignWatch watch(
      1, [](CRef q, CRef) { return q[0] - 0.9; }, 0);
  watch.begin(*integrator);
  const StepReport s = integrator->advance();
  double t = 0.0;
  ASSERT_TRUE(watch.find(*integrator, s, t));
  EXPECT_NEAR(t, -std::acos(0.9), 2e-2);  // the interpolant of a step of 2.5 rad
}

TEST(Events, TheTimeLiesBeyondTheCrossing) {
  auto p = oscillator(1.0);
  Options o;
  o.dt_fixed = 0.1;
  auto integrator = make_integrator("radau5", p, o);
  integrator->start(0.0, VecX::Zero(1), VecX::Ones(1));
  auto g = [](CRef q, CRef) { return q[0] - 0.45; };
  SignWatch watch(1, g, +1);
  watch.begin(*integrator);
  double t = 0.0;
  StepReport s;
  do
    s = integrator->advance();
  while (!watch.find(*integrator, s, t));
  VecX q(1), v(1), a(1);
  integrator->interpolate(t, q, v, a);
  EXPECT_GE(g(q, v), 0.0);
  EXPECT_LT(g(q, v), 1e-9);
}

// Every sign change of a step is reported in order, each on its bracket's two sides, and where g turns
// between looks both its passages.
TEST(Events, AllSignChangesOfAStepInOrder) {
  constexpr EventLocator locator(quarters, {1e-12, 1e-15});
  const auto g = [](double t) { return (t - 2.1) * (t - 2.4) * (t - 2.8); };
  double last = g(2.0);
  std::vector<double> at;
  std::vector<bool> rises;
  locator.sign_changes(2.0, 3.0, last, g, [&](const Passage& p, bool rising) {
    EXPECT_LE(p.after - p.before, 1e-12);
    EXPECT_NE(g(p.before) < 0.0, g(p.after) < 0.0);
    at.push_back(p.after);
    rises.push_back(rising);
    return true;
  });
  ASSERT_EQ(at.size(), 3u);
  EXPECT_NEAR(at[0], 2.1, 1e-12);
  EXPECT_NEAR(at[1], 2.4, 1e-12);
  EXPECT_NEAR(at[2], 2.8, 1e-12);
  EXPECT_EQ(rises, (std::vector<bool>{true, false, true}));
  EXPECT_GT(last, 0.0);

  for (const double sign : {1.0, -1.0})
    for (int k = 1; k < 98; ++k)
      for (const double width : {0.01, 0.001}) {
        const double a = 2.0 + 0.01 * k, b = a + width;
        const auto turns = [=](double t) {
          return sign * (t - a) * (t - b) * (1.0 + 0.3 * std::sin(3.0 * t));
        };
        last = turns(2.0);
        at.clear();
        locator.sign_changes(2.0, 3.0, last, turns, [&](const Passage& p, bool) {
          at.push_back(p.after);
          return true;
        });
        ASSERT_EQ(at.size(), 2u) << a;
        EXPECT_NEAR(at[0], a, 1e-11);
        EXPECT_NEAR(at[1], b, 1e-11);
        EXPECT_GT(last * sign, 0.0);
      }
  // what turns above zero, however closely, passes nothing
  const auto touches = [](double t) { return 1e-9 + (t - 2.37) * (t - 2.37); };
  last = touches(2.0);
  locator.sign_changes(2.0, 3.0, last, touches, [](const Passage&, bool) {
    ADD_FAILURE() << "no passage";
    return true;
  });
}

// An event exactly at the end of a step belongs to it, not to the next one.
TEST(Events, AnEventBetweenTwoStepsIsFoundOnce) {
  constexpr EventLocator locator(quarters, {1e-12, 1e-15});
  double last = -1.0;
  int events = 0;
  for (double t0 : {0.0, 1.0})
    locator.sign_changes(
        t0, t0 + 1.0, last, [](double t) { return t - 1.0; },
        [&](const Passage& p, bool rising) {
          EXPECT_TRUE(rising);
          EXPECT_EQ(p.after, 1.0);
          ++events;
          return true;
        });
  EXPECT_EQ(events, 1);
}

// Pieces instead of signs: three of them, two boundaries between the same two looks.
TEST(Events, EveryPieceOfThreeIsEntered) {
  constexpr EventLocator locator(quarters, {1e-12, 1e-15});
  const auto piece = [](double t) { return t < 0.05 ? 0 : t < 0.2 ? 1 : 2; };
  int side = 0;
  std::vector<double> near;
  locator.search(
      0.0, 1.0, [&](double t) { return piece(t) != side; },
      [&](const Passage& p) {
        EXPECT_EQ(piece(p.before), side);
        side = piece(p.after);
        near.push_back(p.before);
        return true;
      });
  ASSERT_EQ(near.size(), 2u);
  EXPECT_NEAR(near[0], 0.05, 1e-12);
  EXPECT_NEAR(near[1], 0.2, 1e-12);
  EXPECT_EQ(side, 2);
}

// Landing on an event: the step made again is a step of the scheme, not a point of its interpolant,
// and the run goes on.
TEST(Events, StepsMadeAgainEndOnTheEvent) {
  LavalRotor model;
  model.m = 1.0;
  model.e = 0.05;
  model.J = 0.02;
  model.k = 100.0;
  model.c = 0.3;
  model.torque = 0.5;
  VecX y0(6);
  y0 << 0.02, -0.01, 0.3, 0.1, 0.2, 2.0;
  for (const char* name : {"radau5", "gauss4", "gauss6", "generalized_alpha"}) {
    const bool low = name == std::string_view("generalized_alpha");
    LavalRotor p = model;
    Options o;
    o.tolerance = low ? 1e-4 : 1e-8;
    o.t_end = 2.0;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, y0.head(3), y0.tail(3));
    SignWatch watch(
        3, [](CRef, CRef v) { return v[2] - 8.0; }, +1);
    watch.begin(*integrator);
    double t = 0.0;
    bool landed = false;
    while (integrator->time() < 2.0) {
      const StepReport s = integrator->advance();
      ASSERT_TRUE(s.ok());
      if (!landed && watch.find(*integrator, s, t)) {
        const long accepted = integrator->statistics().accepted;
        if (t < s.t1) {
          const StepReport again = integrator->shorten_to(t);
          ASSERT_TRUE(again.ok()) << name;
          EXPECT_EQ(again.t0, s.t0);
          EXPECT_EQ(again.t1, t);
        }
        EXPECT_EQ(integrator->time(), t);
        EXPECT_EQ(integrator->statistics().accepted, accepted);
        EXPECT_NEAR(integrator->v()[2], 8.0, 100.0 * o.tolerance) << name;
        VecX q(3), v(3), a(3);
        integrator->interpolate(t, q, v, a);
        EXPECT_EQ(v[2], integrator->v()[2]);
        landed = true;
        EXPECT_THROW(integrator->shorten_to(t + 1.0), std::invalid_argument);
      }
    }
    EXPECT_TRUE(landed);
    const VecX y =
        reference([&](double, const VecX& x) { return model.rate(x); }, 0.0, 2.0, y0, 800);
    EXPECT_NEAR((integrator->q().head(2) - y.head(2)).norm(), 0.0, 50.0 * o.tolerance * 0.1)
        << name;
    EXPECT_NEAR(p.phi(integrator->q()), y[2], 50.0 * o.tolerance) << name;
  }
}

// A change of state at an event: a ball that bounces, restarted with reversed velocity.
TEST(Events, RestartAfterAnImpact) {
  MatX one = MatX::Ones(1, 1), zero = MatX::Zero(1, 1);
  LinearProblem p(all(1), one, zero, zero, [](double, Ref f) { f[0] = -9.81; });
  for (const char* name : {"radau5", "gauss6", "generalized_alpha"}) {
    Options o;
    o.tolerance = 1e-6;
    o.t_end = 2.0;
    o.dt_max = 0.05;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
    SignWatch watch(
        1, [](CRef q, CRef) { return q[0]; }, -1);
    watch.begin(*integrator);
    int bounces = 0;
    while (integrator->time() < 2.0) {
      const StepReport s = integrator->advance();
      ASSERT_TRUE(s.ok());
      double t = 0.0;
      if (watch.find(*integrator, s, t)) {
        if (t < s.t1) {
          ASSERT_TRUE(integrator->shorten_to(t).ok());
        }
        integrator->restart(integrator->q(), -0.8 * integrator->v());
        watch.begin(*integrator);
        ++bounces;
      }
    }
    // falls 1 m in t1, bounces for 2 * 0.8 t1, again for 2 * 0.64 t1 ...
    const double t1 = std::sqrt(2.0 / 9.81), v1 = 9.81 * t1;
    EXPECT_EQ(bounces, 3) << name;
    const double t3 = t1 * (1.0 + 1.6 + 1.28), rest = 2.0 - t3;
    EXPECT_NEAR(integrator->q()[0], 0.512 * v1 * rest - 0.5 * 9.81 * rest * rest, 1e-7) << name;
  }
}

}  // namespace
}  // namespace whirl::time::test
