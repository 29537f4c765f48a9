// Observers: peaks found between steps, at a cost that hardly grows with the number of points; the
// energy that a motion turns over.
#include "rotors.hpp"
#include <analysis/transient/observer.hpp>
#include <analysis/transient/revolutions.hpp>
#include <analysis/transient/transient.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

using namespace whirl;

namespace {

/// Counts the states that are evaluated inside a step.
class Counted final : public analysis::StepAccess {
 public:
  explicit Counted(analysis::StepAccess& s) : step_(s) {}
  double t0() const override { return step_.t0(); }
  double t1() const override { return step_.t1(); }
  const analysis::Snapshot& at(double t) override {
    ++count;
    return step_.at(t);
  }
  void displacements(double t, std::span<const analysis::Point> points,
                     std::vector<Vec2>& out) override {
    ++looks;
    step_.displacements(t, points, out);
  }
  int count = 0, looks = 0;

 private:
  analysis::StepAccess& step_;
};

struct CountedPeaks final : analysis::Observer {
  explicit CountedPeaks(std::vector<std::pair<std::string, analysis::Point>> points)
      : tracker(std::move(points), 0) {}
  void begin(const analysis::Snapshot& s) override { tracker.begin(s); }
  void step(analysis::StepAccess& s) override {
    Counted counted(s);
    tracker.step(counted);
    most = std::max(most, counted.count);
    most_looks = std::max(most_looks, counted.looks);
  }
  analysis::PeakTracker tracker;
  int most = 0, most_looks = 0;
};

/// The largest amplitude of the dense output itself, looked at 100 times a step.
struct DenseSearch final : analysis::Observer {
  explicit DenseSearch(std::vector<analysis::Point> p)
      : points(std::move(p)),
        amplitude(points.size()),
        spin(points.size()) {}
  void step(analysis::StepAccess& s) override {
    for (int k = 0; k <= 100; ++k) {
      const analysis::Snapshot& now = s.at(s.t0() + (s.t1() - s.t0()) * k / 100);
      for (std::size_t i = 0; i < points.size(); ++i)
        if (const double r = analysis::displacement(now, points[i]).tail<2>().norm();
            r > amplitude[i]) {
          amplitude[i] = r;
          spin[i] = now.node(0).spin();
        }
    }
  }
  std::vector<analysis::Point> points;
  std::vector<double> amplitude, spin;
};

/// Shaft with a disk in unequal springs, undamped, let go from a bent shape. speed: of one end, rad/s;
/// null: it turns freely.
struct Released {
  tests::Rotor rotor;
  std::unique_ptr<whirl::system::System> system;
  whirl::system::State start;
  explicit Released(int elements, const LawPtr& speed = nullptr) {
    rotor.add_shaft(tests::cylinder(0.02, 2.1e11, 8e10, 7850), 0.6, elements);
    rotor.add_disk(0.3, 3, 0.0076, 0.015);
    rotor.add_bearing(0, 2e6, 1e6).add_bearing(0.6, 2e6, 1e6);
    rotor.hold_axially(0);
    if (speed)
      rotor.b.hold(rotor.node[0], whirl::system::spin_phi, make_angle_of_speed(speed, 0.0));
    system = std::make_unique<whirl::system::System>(rotor.b.finalize());
    start = system->make_state();
    for (std::size_t i = 0; i < rotor.node.size(); ++i) {
      start.q[6 * rotor.node[i] + 1] = 1e-4 * std::sin(pi * rotor.x[i] / 0.6);
      start.q[6 * rotor.node[i] + 5] =
          1e-4 * pi / 0.6 * std::cos(pi * rotor.x[i] / 0.6);  // bent, not sheared
      start.q[6 * rotor.node[i] + 2] = 2e-5;
      start.v[6 * rotor.node[i] + whirl::system::spin_phi] = 100.0;
    }
  }
};

analysis::TransientOptions options_of(double t_end, double tolerance) {
  analysis::TransientOptions o;
  o.integrator.tolerance = tolerance;
  o.integrator.t_end = t_end;
  return o;
}

}  // namespace

TEST(Observers, PeaksOfManyPointsShareTheirLooks) {
  Released r(12);
  system::SystemProblem problem(*r.system);
  std::vector<std::pair<std::string, analysis::Point>> named;
  std::vector<analysis::Point> points;
  for (int k = 0; k < 60; ++k) {
    points.push_back({r.rotor.node[static_cast<std::size_t>(k) % r.rotor.node.size()], 1e-4 * k});
    named.emplace_back("p" + std::to_string(k), points.back());
  }
  CountedPeaks peaks(named);
  DenseSearch dense(points);
  const auto result =
      analysis::run_transient(problem, r.start, options_of(0.003, 1e-3), {&peaks, &dense});
  ASSERT_EQ(result.reason, analysis::StopReason::end_time);
  EXPECT_LE(peaks.most_looks, 9);  // once some thirty a point
  EXPECT_LE(peaks.most, 5);        // for the speed at all peaks of a step
  for (std::size_t i = 0; i < points.size(); ++i) {
    const analysis::Peak& p = peaks.tracker.peaks()[i];
    // a maximum is flat: looks at h/100 miss it by (w h/200)^2/2, which is 1e-5 for steps of a
    // radian; the polynomial of order 8 adds 1e-9
    EXPECT_NEAR(p.amplitude, dense.amplitude[i], 1e-5 * p.amplitude) << i;
    EXPECT_GE(p.amplitude, dense.amplitude[i] * (1 - 1e-9)) << i;
  }
}

// The speed at the peaks of many points is that of each by itself; where it hardly changes in a step it
// takes three states, not five.
TEST(Observers, SpeedsAtPeaksShareTheirLooks) {
  Released r(6);
  for (std::size_t i = 0; i < r.rotor.node.size(); ++i)
    r.start.q.segment<6>(6 * r.rotor.node[i]) *= 1e-2;
  std::vector<std::pair<std::string, analysis::Point>> named;
  for (std::size_t i = 1; i < r.rotor.node.size(); ++i)
    named.emplace_back("p" + std::to_string(i), analysis::Point{r.rotor.node[i], 1e-3});
  ASSERT_GT(named.size(), 5u);
  CountedPeaks together(named);
  std::vector<std::unique_ptr<CountedPeaks>> alone;
  std::vector<analysis::Observer*> observers{&together};
  for (const auto& p : named) {
    alone.push_back(std::make_unique<CountedPeaks>(std::vector{p}));
    observers.push_back(alone.back().get());
  }
  system::SystemProblem problem(*r.system);
  const auto result = analysis::run_transient(problem, r.start, options_of(0.01, 1e-3), observers);
  ASSERT_EQ(result.reason, analysis::StopReason::end_time);
  EXPECT_EQ(together.most, 3);
  for (std::size_t i = 0; i < named.size(); ++i) {
    const analysis::Peak &all = together.tracker.peaks()[i],
                         &one = alone[i]->tracker.peaks().front();
    EXPECT_EQ(all.time, one.time) << i;
    EXPECT_NEAR(all.speed, one.speed, 1e-7 * one.speed) << i;
    EXPECT_GT(all.speed, 90.0);
  }
}

namespace {

/// Looks at single nodes are those at whole states, to the last bit, and leave the states alone.
struct ComparedLooks final : analysis::Observer {
  explicit ComparedLooks(Index n) : node(n) {}
  void step(analysis::StepAccess& s) override {
    const VecX end = s.end().q();
    for (int k = 0; k <= 4; ++k) {
      const double t = k == 4 ? s.t1() : s.t0() + 0.25 * k * (s.t1() - s.t0());
      const analysis::Snapshot& before = s.end();
      const analysis::StepAccess::Angle angle = s.angle(t, node);
      const double spin = s.spin(t, node);
      EXPECT_EQ(before.t(), s.t1());
      EXPECT_TRUE(before.q() == end);
      EXPECT_EQ(before.node(node).phi, end[6 * node + whirl::system::spin_phi]);
      const analysis::Snapshot& whole = s.at(t);
      EXPECT_EQ(angle.phi, whole.total_phi(node));
      EXPECT_EQ(angle.rate, whole.node(node).dphi);
      EXPECT_EQ(spin, whole.node(node).spin());
    }
    ++steps;
  }
  Index node;
  int steps = 0;
};

/// Counts the whole states that turns ask for, and lets looks at nodes pass.
struct CountedTurns final : analysis::Observer {
  struct Access final : analysis::StepAccess {
    explicit Access(analysis::StepAccess& s) : step(s) {}
    double t0() const override { return step.t0(); }
    double t1() const override { return step.t1(); }
    const analysis::Snapshot& at(double t) override {
      ++states;
      return step.at(t);
    }
    void displacements(double t, std::span<const analysis::Point> points,
                       std::vector<Vec2>& out) override {
      step.displacements(t, points, out);
    }
    Angle angle(double t, Index node) override { return step.angle(t, node); }
    analysis::StepAccess& step;
    int states = 0;
  };
  explicit CountedTurns(std::vector<analysis::Point> points)
      : turns(std::move(points), 0, 32, [this](const analysis::Turn&) { ++whole; }) {}
  void begin(const analysis::Snapshot& s) override { turns.begin(s); }
  void step(analysis::StepAccess& s) override {
    Access access(s);
    turns.step(access);
    most = std::max(most, access.states);
  }
  int whole = 0, most = 0;
  analysis::Revolutions turns;
};

}  // namespace

TEST(Observers, LooksAtOneNodeAreThoseAtAllOfThem) {
  for (const LawPtr& speed : {LawPtr(), make_smooth_step(0.0, 0.01, 100.0, 400.0)}) {
    Released r(6, speed);
    system::SystemProblem problem(*r.system);
    ComparedLooks driven(r.rotor.node.front()), middle(r.rotor.node[3]);
    const auto result =
        analysis::run_transient(problem, r.start, options_of(0.01, 1e-3), {&driven, &middle});
    ASSERT_EQ(result.reason, analysis::StopReason::end_time);
    EXPECT_GT(driven.steps, 10);
  }
}

// The angle of a shaft whose speed is given was once read off states of all nodes, some a sample.
TEST(Observers, TurnsAskForTheEndOfAStepAlone) {
  for (const LawPtr& speed : {LawPtr(), make_constant(1000.0)}) {
    Released r(6, speed);
    for (const Index n : r.rotor.node)
      r.start.v[6 * n + whirl::system::spin_phi] = 1000.0;
    system::SystemProblem problem(*r.system);
    CountedTurns turns({{r.rotor.node[3], 0.0}, {r.rotor.node[4], 1e-3}});
    const auto result = analysis::run_transient(problem, r.start, options_of(0.02, 1e-3), {&turns});
    ASSERT_EQ(result.reason, analysis::StopReason::end_time);
    EXPECT_GE(turns.whole, 2);
    EXPECT_EQ(turns.most, 1);
  }
}

TEST(Observers, ConservativeMotionTurnsOverItsPotentialEnergy) {
  Released r(6);
  system::SystemProblem problem(*r.system);
  analysis::EnergyBalance energy;
  analysis::run_transient(problem, r.start, options_of(0.005, 1e-3), {&energy});
  // nothing comes in or goes out, so that all that changes in the balance is its defect: it cannot
  // be its own measure
  EXPECT_EQ(energy.supplied(), 0.0);
  EXPECT_EQ(energy.dissipated(), 0.0);
  EXPECT_GT(energy.worst_defect(), 0.0);
  // the bent shaft holds about k a^2/2 = 48 EI/l^3 a^2/2, which turns into motion and back
  const double stiffness = 48 * 2.1e11 * pi * std::pow(0.02, 4) / 64 / std::pow(0.6, 3);
  EXPECT_GT(energy.exchanged(), 0.3 * 0.5 * stiffness * 1e-8);
  EXPECT_LT(energy.exchanged(), 3 * 0.5 * stiffness * 1e-8);
  EXPECT_LT(energy.worst_defect(), 0.02 * energy.exchanged());
}

TEST(Observers, RowsOutsideTheWindowCostNothing) {
  // 10^13 ticks before the window: counted one by one they would take hours
  analysis::Ticker t(0.0, 1e-9);
  t.pass(1e4);
  EXPECT_GT(t.next(), 1e4);
  EXPECT_LE(t.next(), 1e4 + 2e-9);
  analysis::Ticker slow(0.25, 0.1), fast(0.25, 0.1);
  while (slow.next() <= 7.05)
    slow.advance();
  fast.pass(7.05);
  EXPECT_EQ(slow.count(), fast.count());
  fast.pass(3.0);  // never back
  EXPECT_EQ(slow.count(), fast.count());
}
