// The loop around one step: stops hit exactly, rejections of every kind, discontinuities, chart
// changes, failures.
#include "toys.hpp"
#include <core/error.hpp>
#include <time/response_scale.hpp>
#include <time/step_control.hpp>
#include <gtest/gtest.h>
#include <cmath>

namespace whirl::time::test {
namespace {

// A rotor that moves by little beside where it stands, and that symmetry keeps level: its tilts are the
// rounding of forces that hold where it stands, and are asked for no finer than that.
TEST(Control, TiltsOfALevelRotorAreNotFollowed) {
  const Kind kinds[] = {Kind::displacement, Kind::tilt};
  Scales o;
  o.length = 2.0;
  ResponseScale scale;
  scale.resize(kinds, o);
  const auto at = [](double u, double g) { return VecX((VecX(2) << u, g).finished()); };
  scale.reset(at(6e-5, 0.0));
  scale.observe(at(6e-5 + 4e-8, 1e-19));
  scale.begin_step(at(1e-9, 1e-19));
  EXPECT_NEAR(scale.scale(Kind::displacement), 2e-8, 1e-12);
  EXPECT_NEAR(scale.scale(Kind::tilt), 1e-6 * 6e-5 / 2.0, 1e-13);
  scale.observe(at(6e-5, 2e-9));  // one that tilts is right to its tilts
  scale.begin_step(at(1e-9, 1e-12));
  EXPECT_NEAR(scale.scale(Kind::tilt), 1e-9, 1e-15);
}

constexpr const char* names[] = {"radau5", "gauss4", "gauss6", "generalized_alpha"};

TEST(Control, BreakpointsAndEndAreHitExactly) {
  for (const char* name : names)
    for (double dt : {0.0, 0.07}) {
      auto p = oscillator(3.0);
      Options o;
      o.dt_fixed = dt;
      o.tolerance = 1e-3;
      o.breakpoints = {0.3, 0.1 + 0.2, 1.0 / 3.0, 0.9, 0.9 + 1e-12, 5.0, -1.0, infinity};
      o.t_end = 1.1;
      auto integrator = make_integrator(name, p, o);
      integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
      std::vector<double> hit;
      double before = 0.0;
      while (integrator->time() < 1.1) {
        const StepReport s = integrator->advance();
        ASSERT_TRUE(s.ok());
        EXPECT_EQ(s.t0, before);
        EXPECT_GT(s.t1, s.t0);
        before = s.t1;
        if (s.at_breakpoint) hit.push_back(s.t1);
        if (dt > 0.0) {
          EXPECT_LE(s.t1 - s.t0, dt * (1.0 + 1e-12));
        }
      }
      EXPECT_EQ(hit, (std::vector<double>{0.3, 0.1 + 0.2, 1.0 / 3.0, 0.9, 0.9 + 1e-12})) << name;
      EXPECT_EQ(integrator->time(), 1.1);
      EXPECT_EQ(integrator->advance().status, StepStatus::finished);
      EXPECT_NEAR(integrator->q()[0], std::cos(3.3), dt > 0.0 ? 2e-2 : 2e-3) << name;
    }
}

// Steps that grow back from a short one leave proposals behind that are short against the steps
// that follow: those must not take a step back whose own error asks for a longer one.
TEST(Control, GrowingStepsAreNotTakenBack) {
  StepControl c;
  c.configure(4);
  double h = 1e-6;
  for (int k = 0; k < 8; ++k)
    h = c.accepted(h, 1e-8, 2, 10);
  for (double error : {0.3, 0.05, 0.2, 0.3}) {  // proposals of 1.2 to 1.9
    const double next = c.accepted(h, error, 2, 10);
    EXPECT_GE(next, h) << error;
    h = next;
  }
  EXPECT_LT(c.accepted(h, 0.98, 2, 10), h);
}

// Newton failed at h: for some steps nothing as long as h is proposed, however small the error;
// then it is tried again.
TEST(Control, NewtonFailuresAreRemembered) {
  StepControl c;
  c.configure(4);
  c.accepted(1.0, 0.1, 2, 10);
  c.newton_failed(1.0);
  double h = 0.5;
  int steps = 0;
  for (; h < 1.0 && steps < 50; ++steps) {
    const double next = c.accepted(h, 1e-4, 2, 10);
    EXPECT_GE(next, h);
    EXPECT_TRUE(steps > 0 || next == h) << "at once";
    h = next;
  }
  EXPECT_GE(steps, 3);
  EXPECT_LE(steps, 10);
}

// A force that switches on and off: with breakpoints the order is kept although the law is
// right-continuous (the step that ends at the switch must see the left limit).
TEST(Control, JumpsAtBreakpointsKeepTheOrder) {
  auto error = [](const char* name, int n) {
    MatX one = MatX::Ones(1, 1);
    LinearProblem p(
        all(1), one, 0.2 * one, 25.0 * one,
        [](double t, Ref f) { f[0] = t >= 0.3 && t < 0.8 ? 10.0 : 0.0; }, false);
    Options o;
    o.dt_fixed = 0.1 / n;
    o.tolerance = 1e-10;
    o.breakpoints = {0.3, 0.8};
    o.t_end = 1.0;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Constant(1, 0.1), VecX::Zero(1));
    EXPECT_EQ(run(*integrator, 1.0), StepStatus::ok);
    // q = sum of free decay and two step responses
    const double d = 0.1, w = std::sqrt(25.0 - d * d);
    auto step = [&](double t) {
      return t < 0 ? 0.0
                   : (1.0 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t))) / 25.0;
    };
    const double exact = 0.1 * (1.0 - 25.0 * step(1.0)) + 10.0 * (step(0.7) - step(0.2));
    return std::abs(integrator->q()[0] - exact);
  };
  EXPECT_NEAR(std::log2(error("radau5", 2) / error("radau5", 4)), 5.0, 0.4);
  EXPECT_NEAR(std::log2(error("gauss4", 2) / error("gauss4", 4)), 4.0, 0.4);
  EXPECT_NEAR(std::log2(error("gauss6", 1) / error("gauss6", 2)), 6.0, 0.4);
  EXPECT_NEAR(std::log2(error("generalized_alpha", 20) / error("generalized_alpha", 40)), 2.0, 0.2);
}

/// Records whether the error test refused steps.
TEST(Control, ErrorTestRejects) {
  // a sharp pulse nobody announced
  MatX one = MatX::Ones(1, 1);
  LinearProblem p(
      all(1), one, one, one,
      [](double t, Ref f) { f[0] = std::exp(-1e6 * (t - 0.5) * (t - 0.5)) * 1e3; }, false);
  for (const char* name : {"radau5", "gauss6"}) {
    Options o;
    o.tolerance = 1e-5;
    o.dt_max = 2e-3;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
    EXPECT_EQ(run(*integrator, 1.0), StepStatus::ok);
    EXPECT_GT(integrator->statistics().rejected_error, 0) << name;
    // impulse 1e3 sqrt(pi)/1e3 = 1.7725 at t = 0.5, on the free motion
    const double d = 0.5, w = std::sqrt(0.75), t = 0.5;
    const double free = std::exp(-d) * (std::cos(w) + d / w * std::sin(w));
    const double kick = std::sqrt(pi) * std::exp(-d * t) * std::sin(w * t) / w;
    EXPECT_NEAR(integrator->q()[0], free + kick, 2e-5) << name;
  }
}

/// q'' = -1 above the floor q = 0, where residual() refuses to go: a spring of growing stiffness,
/// film-like.
class Film final : public DenseProblem {
 public:
  Film() : DenseProblem(all(1)) { M.setOnes(); }
  bool residual(double, CRef q, CRef v, CRef a, Ref r) override {
    if (!(q[0] > 0.0)) {
      ++refused;
      return false;
    }
    r[0] = a[0] + 1.0 - 1e-2 / (q[0] * q[0]) + 1e-3 * v[0] / q[0];
    return true;
  }
  void tangent(double, CRef q, CRef v, CRef) override {
    K(0, 0) = 2e-2 / std::pow(q[0], 3) - 1e-3 * v[0] / (q[0] * q[0]);
    C(0, 0) = 1e-3 / q[0];
  }
  int refused = 0;
};

TEST(Control, RefusedConfigurationsShortenTheStep) {
  for (const char* name : names) {
    Film p;
    Options o;
    o.tolerance = name == std::string_view("generalized_alpha") ? 1e-3 : 1e-5;
    o.dt_first = 3.0;  // falls through the floor at once
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Constant(1, 0.5), VecX::Constant(1, -2.0));
    EXPECT_EQ(run(*integrator, 1.0), StepStatus::ok) << name;
    EXPECT_GT(p.refused, 0) << name;
    EXPECT_GT(integrator->statistics().rejected_newton, 0) << name;
    EXPECT_GT(integrator->q()[0], 0.0);
    const VecX y = reference(
        [](double, const VecX& x) {
          VecX dy(2);
          dy << x[1], -1.0 + 1e-2 / (x[0] * x[0]) - 1e-3 * x[1] / x[0];
          return dy;
        },
        0.0, 1.0, Vec2(0.5, -2.0), 4000);
    EXPECT_NEAR(integrator->q()[0], y[0], 20.0 * o.tolerance) << name;
  }
}

/// Becomes impassable at q >= 1: every scheme must give up with a reason, at once, and stay where
/// it was.
class Wall final : public DenseProblem {
 public:
  Wall() : DenseProblem(all(1)) { M.setOnes(); }
  bool residual(double, CRef q, CRef, CRef a, Ref r) override {
    r[0] = a[0];
    return q[0] < 1.0;
  }
  void tangent(double, CRef, CRef, CRef) override {}
};

TEST(Control, ImpassableStatesAreReported) {
  for (const char* name : names) {
    Wall p;
    Options o;
    o.t_end = 2.0;
    o.dt_min = 1e-9;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Zero(1), VecX::Ones(1));
    StepReport s;
    int steps = 0;
    do {
      s = integrator->advance();
      ++steps;
    } while (s.ok() && steps < 10000);
    EXPECT_EQ(s.status, StepStatus::domain) << name;
    EXPECT_NEAR(integrator->time(), 1.0, 1e-8) << name;
    EXPECT_EQ(integrator->time(), s.t0);
    EXPECT_NEAR(integrator->q()[0], integrator->time(), 1e-12);
    // asked again it may creep on by steps of dt_min, with the same end
    do {
      s = integrator->advance();
      ++steps;
    } while (s.ok() && steps < 10000);
    EXPECT_EQ(s.status, StepStatus::domain) << name;
    EXPECT_LT(integrator->q()[0], 1.0);
  }
}

// Steps began as short as they liked; those that met a rejection went on below the least one.
TEST(Control, NoStepIsShorterThanTheLeast) {
  for (const char* name : names)
    for (const double least : {0.02, 0.1}) {
      auto p = oscillator(3.0);
      Options o;
      o.tolerance = 1e-3;
      o.dt_min = least;
      o.t_end = 10.0;
      auto integrator = make_integrator(name, p, o);
      integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
      while (integrator->time() < o.t_end) {
        const StepReport s = integrator->advance();
        if (!s.ok()) {  // it may be too long to be right
          EXPECT_EQ(s.status, StepStatus::error_test) << name;
          break;
        }
        if (s.t1 < o.t_end) {
          EXPECT_GE(s.t1 - s.t0, least * (1.0 - 1e-9)) << name;
        }
      }
    }
}

/// Residual with a kink and wrong tangents: Newton fails, also at the smallest step.
class Lying final : public DenseProblem {
 public:
  Lying() : DenseProblem(all(1)) {}
  bool residual(double t, CRef, CRef, CRef a, Ref r) override {
    r[0] = t < 0.5 ? a[0] : -a[0] + 1.0;  // M changes sign behind the tangent's back
    return true;
  }
  void tangent(double, CRef, CRef, CRef) override { M.setOnes(); }
};

TEST(Control, NewtonFailureIsReported) {
  for (const char* name : names) {
    Lying p;
    Options o;
    o.t_end = 2.0;
    o.dt_min = 1e-6;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Zero(1), VecX::Ones(1));
    StepReport s;
    do
      s = integrator->advance();
    while (s.ok() && integrator->time() < 1.0);
    EXPECT_EQ(s.status, StepStatus::newton) << name;
    EXPECT_NEAR(integrator->time(), 0.5, 5e-3)
        << name;  // the last stage of a Gauss step stands before its end
  }
}

TEST(Control, SingularMatricesAreReported) {
  for (const char* name : names) {
    MatX zero = MatX::Zero(2, 2), M = zero;
    M(0, 0) = 1.0;  // the second unknown is in no equation
    LinearProblem p(all(2), M, zero, zero);
    auto integrator = make_integrator(name, p, Options{});
    EXPECT_THROW(integrator->start(0.0, VecX::Zero(2), VecX::Zero(2)), Error) << name;
  }
}

// Equal steps that do not converge are halved until the next grid point, then equal again.
TEST(Control, FixedStepsRecoverByHalving) {
  Film p;
  Options o;
  o.dt_fixed = 0.25;
  o.tolerance = 1e-3;
  auto integrator = make_integrator("radau5", p, o);
  integrator->start(0.0, VecX::Constant(1, 0.5), VecX::Constant(1, -2.0));
  o.t_end = 2.0;
  integrator->set_end(2.0);
  int on_grid = 0;
  while (integrator->time() < 2.0) {
    const StepReport s = integrator->advance();
    ASSERT_TRUE(s.ok());
    EXPECT_LE(s.t1 - s.t0, 0.25 * (1 + 1e-12));
    if (std::abs(std::remainder(s.t1, 0.25)) < 1e-14) ++on_grid;
  }
  EXPECT_EQ(on_grid, 8);
  EXPECT_GT(integrator->statistics().rejected_newton, 0);
}

// A support that is hit: its prescribed velocity jumps by dv at a breakpoint. The pendulum's angle
// rate must jump by -cos(theta) dv (impulse of the rigid drive), nothing else.
class Jolt final : public DenseProblem {
 public:
  Jolt() : DenseProblem({Kind::held, Kind::tilt}) {}
  void impose(double t, Ref q, Ref v, Ref a) const override {
    v[0] = t < 0.4 ? 0.0 : 1.5;
    q[0] = t < 0.4 ? 0.0 : 1.5 * (t - 0.4);
    a[0] = 0.0;
  }
  bool residual(double, CRef q, CRef v, CRef a, Ref r) override {
    const double s = std::sin(q[1]), k = std::cos(q[1]);
    r[0] = 2.0 * a[0] + k * a[1] - s * v[1] * v[1];
    r[1] = a[1] + k * a[0] + 9.81 * s;
    return true;
  }
  void tangent(double, CRef q, CRef v, CRef a) override {
    const double s = std::sin(q[1]), k = std::cos(q[1]);
    M << 2.0, k, k, 1.0;
    C << 0.0, -2.0 * s * v[1], 0.0, 0.0;
    K << 0.0, -s * a[1] - k * v[1] * v[1], 0.0, -s * a[0] + 9.81 * k;
  }
};

TEST(Control, JumpOfAPrescribedVelocityIsAnImpulse) {
  const auto pendulum = [](double, const VecX& x) {
    VecX dy(2);
    dy << x[1], -9.81 * std::sin(x[0]);
    return dy;
  };
  VecX y = reference(pendulum, 0.0, 0.4, Vec2(0.8, 0.0), 50);
  y[1] -= std::cos(y[0]) * 1.5;
  y = reference(pendulum, 0.4, 1.0, y, 50);
  for (const char* name : names) {
    Jolt p;
    Options o;
    o.tolerance = name == std::string_view("generalized_alpha") ? 1e-4 : 1e-7;
    o.breakpoints = {0.4};
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, Vec2(0.0, 0.8), Vec2(0.0, 0.0));
    EXPECT_EQ(run(*integrator, 1.0), StepStatus::ok);
    EXPECT_NEAR(integrator->q()[1], y[0], 10.0 * o.tolerance) << name;
    EXPECT_NEAR(integrator->v()[1], y[1], 100.0 * o.tolerance) << name;
  }
}

// phi over a million revolutions: every digit kept (whole turns out, compensated sums).
TEST(Control, AMillionRevolutions) {
  for (const char* name : {"radau5", "gauss4", "generalized_alpha"}) {
    LavalRotor p;
    p.e = 0.0;
    p.torque = 0.0;
    Options o;
    const double omega = 523.6, dt = 0.93 * two_pi / omega;
    o.dt_fixed = dt;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Zero(3), Vec3(0.0, 0.0, omega));
    long steps = 0;
    for (; p.turns < 1e6; ++steps)
      ASSERT_TRUE(integrator->advance().ok());
    EXPECT_EQ(integrator->v()[2], omega) << name;
    const long double exact = static_cast<long double>(omega) * static_cast<long double>(dt) *
                              static_cast<long double>(steps);
    const long double phi =
        static_cast<long double>(p.turns) * static_cast<long double>(two_pi) + integrator->q()[2];
    // h v0 is rounded once a step, always alike: 1e-16 of the angle; taking turns out rounds
    // randomly
    EXPECT_NEAR(static_cast<double>(phi - exact), 0.0, 3e-9) << name;
  }
}

/// A rotation angle kept in a chart: q is re-expressed (q -> q - 1, all rates doubled in a second
/// unknown's unit) at every crossing of 1; the exact solution is known.
class Charted final : public DenseProblem {
 public:
  Charted() : DenseProblem(all(1, Kind::tilt)) { M.setOnes(); }
  double shift = 0.0, unit = 1.0;  // true angle = shift + unit q
  bool residual(double, CRef q, CRef, CRef a, Ref r) override {
    r[0] = a[0] + 4.0 * (shift / unit + q[0]);
    return true;
  }
  void tangent(double, CRef, CRef, CRef) override { K(0, 0) = 4.0; }
  bool accept(double, Ref q, Ref v, Ref a) override {
    if (std::abs(q[0]) < 0.5) return false;
    const double f = unit == 1.0 ? 2.0 : 0.5;
    shift += 0.7 * unit * q[0];
    q *= 0.3 / f;
    v /= f;
    a /= f;
    unit *= f;
    ++changes;
    return true;
  }
  int changes = 0;
};

TEST(Control, ChartChangesLoseNothing) {
  for (const char* name : {"radau5", "gauss6", "gauss4"}) {
    Charted p;
    Options o;
    o.tolerance = 1e-7;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Constant(1, 0.4), VecX::Constant(1, 1.5));
    EXPECT_EQ(run(*integrator, 10.0), StepStatus::ok);
    EXPECT_GE(p.changes, 3);
    EXPECT_NEAR(p.shift + p.unit * integrator->q()[0], 0.4 * std::cos(20.0) + 0.75 * std::sin(20.0),
                1e-6)
        << name;
  }
}

TEST(Control, BadOptionsAreRefused) {
  auto p = oscillator(1.0);
  EXPECT_THROW(make_integrator("radau7", p, Options{}), Error);
  for (auto spoil : std::vector<std::function<void(Options&)>>{
           [](Options& o) { o.tolerance = 0.0; }, [](Options& o) { o.tolerance = nan; },
           [](Options& o) { o.rho_inf = 1.1; }, [](Options& o) { o.dt_fixed = -1.0; },
           [](Options& o) { o.dt_max = 0.0; },
           [](Options& o) {
             o.dt_min = 1.0;
             o.dt_max = 0.5;
           },
           [](Options& o) { o.t_end = nan; }, [](Options& o) { o.scales.length = 0.0; },
           [](Options& o) { o.max_newton = 0; }}) {
    Options o;
    spoil(o);
    EXPECT_THROW(make_integrator("radau5", p, o), Error);
  }
}

}  // namespace
}  // namespace whirl::time::test
