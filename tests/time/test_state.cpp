// Save and restore: the restored integrator continues bit-identically.
#include "toys.hpp"
#include <core/plugin.hpp>
#include <gtest/gtest.h>

namespace whirl::time::test {
namespace {

LavalRotor rotor() {
  LavalRotor p;
  p.m = 1.0;
  p.e = 0.02;
  p.J = 0.02;
  p.k = 400.0;
  p.c = 0.3;
  p.b = 1.0;
  p.torque = 0.8;
  return p;
}

void expect_same(const Integrator& a, const Integrator& b, const std::string& what) {
  EXPECT_EQ(a.time(), b.time()) << what;
  EXPECT_EQ(a.q(), b.q()) << what;
  EXPECT_EQ(a.v(), b.v()) << what;
  EXPECT_EQ(a.a(), b.a()) << what;
  EXPECT_EQ(a.proposed_step(), b.proposed_step()) << what;
  EXPECT_EQ(a.statistics().accepted, b.statistics().accepted) << what;
  EXPECT_EQ(a.statistics().newton_iterations, b.statistics().newton_iterations) << what;
  EXPECT_EQ(a.statistics().error_sum, b.statistics().error_sum) << what;
}

void check(const char* name, double dt_fixed) {
  const std::string what = std::string(name) + (dt_fixed > 0.0 ? " fixed" : " adaptive");
  Options o;
  o.tolerance = 1e-3;
  o.dt_fixed = dt_fixed;
  o.breakpoints = {0.9, 1.5};
  o.t_end = 3.0;
  LavalRotor p = rotor();
  auto original = make_integrator(name, p, o);
  original->start(0.0, Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.1, 5.0));
  std::vector<double> saved_at;
  for (int cut = 0; cut < 6; ++cut) {
    // cuts: after start, after a few steps, right on a breakpoint, after a whole turn was taken
    // out, near the end
    const double until[] = {0.0, 0.05, 0.9, 1.3, 2.2, 2.9};
    while (original->time() < until[cut])
      ASSERT_TRUE(original->advance().ok());
    const std::vector<double> file = original->save().serialize();
    LavalRotor p2 = rotor();
    p2.turns = p.turns;  // the problem's own state is its owner's business
    auto resumed = make_integrator(name, p2, o);
    resumed->restore(IntegratorState::deserialize(file));
    expect_same(*original, *resumed, what + " at once");
    for (int k = 0; k < 40 && original->time() < 3.0; ++k) {
      const StepReport a = original->advance(), b = resumed->advance();
      ASSERT_TRUE(a.ok() && b.ok());
      EXPECT_EQ(a.t1, b.t1);
      EXPECT_EQ(a.error, b.error);
      ASSERT_EQ(original->q(), resumed->q()) << what << " cut " << cut << " step " << k;
      VecX q(3), v(3), acc(3), q2(3), v2(3), a2(3);
      original->interpolate(0.5 * (a.t0 + a.t1), q, v, acc);
      resumed->interpolate(0.5 * (a.t0 + a.t1), q2, v2, a2);
      EXPECT_EQ(q, q2);
      EXPECT_EQ(acc, a2);
    }
    expect_same(*original, *resumed, what + " later");
  }
}

TEST(SaveRestore, BitIdentical) {
  for (const char* name : {"radau5", "gauss4", "gauss6", "generalized_alpha"})
    for (double dt : {0.0, 0.013})
      check(name, dt);
}

TEST(SaveRestore, BitIdenticalIda) {
  if (!Plugin::available("sundials")) GTEST_SKIP() << "built without SUNDIALS";
  check("ida", 0.0);
}

/// One integrator that saves every `marks` steps, and one that is made anew from what was saved
/// there each time, as a run that is killed again and again: all states are equal. (Weights that
/// remember the step of IDA's life before show in a few of a hundred marks.)
void check_many_marks(const char* name, double tolerance, int marks) {
  Options o;
  o.tolerance = tolerance;
  o.t_end = 8.0;
  LavalRotor p = rotor(), p2 = rotor();
  auto whole = make_integrator(name, p, o);
  whole->start(0.0, Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.1, 5.0));
  auto cut = make_integrator(name, p2, o);
  cut->start(0.0, Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.1, 5.0));
  for (int step = 1; whole->time() < 8.0; ++step) {
    ASSERT_TRUE(whole->advance().ok());
    ASSERT_TRUE(cut->advance().ok());
    ASSERT_EQ(whole->time(), cut->time()) << name << ", step " << step << ", every " << marks;
    ASSERT_EQ(whole->q(), cut->q()) << name << ", step " << step << ", every " << marks;
    ASSERT_EQ(whole->v(), cut->v()) << name << ", step " << step << ", every " << marks;
    if (step % marks != 0) continue;
    whole->save();
    const std::vector<double> file = cut->save().serialize();
    cut = make_integrator(name, p2, o);
    cut->restore(IntegratorState::deserialize(file));
  }
}

TEST(SaveRestore, BitIdenticalOverManyMarks) {
  for (const char* name : {"radau5", "gauss4", "gauss6", "generalized_alpha", "ida"}) {
    if (std::string(name) == "ida" && !Plugin::available("sundials")) continue;
    for (const double tolerance : {1e-2, 1e-3, 1e-4})
      // IDA begins at order 1 and a tenth of its step again: far between, or it would not get on
      for (const int marks :
           std::string(name) == "ida" ? std::vector<int>{20, 33, 60} : std::vector<int>{1, 5, 20})
        check_many_marks(name, tolerance, marks);
  }
}

TEST(SaveRestore, ForeignDataAreRefused) {
  LavalRotor p = rotor();
  auto radau = make_integrator("radau5", p, {});
  radau->start(0.0, Vec3::Zero(), Vec3(0.0, 0.0, 1.0));
  const IntegratorState state = radau->save();
  auto alpha = make_integrator("generalized_alpha", p, {});
  EXPECT_THROW(alpha->restore(state), std::invalid_argument);
  auto small = oscillator(1.0);
  auto other = make_integrator("radau5", small, {});
  EXPECT_THROW(other->restore(state), std::invalid_argument);
  auto data = state.serialize();
  data.pop_back();
  EXPECT_THROW(IntegratorState::deserialize(data), std::invalid_argument);
  data.clear();
  EXPECT_THROW(IntegratorState::deserialize(data), std::invalid_argument);
  EXPECT_THROW(IntegratorState::deserialize({1.0, 1e300, 0.0, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace whirl::time::test
