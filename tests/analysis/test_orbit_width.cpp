#include <analysis/transient/orbit_width.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace whirl {
namespace {

using analysis::OrbitWidth;

/// Follows a path of the angle turned, through `turns` turns in steps of a fraction of a turn; a
/// second is a radian.
OrbitWidth follow(const std::function<Vec2(double)>& path, double turns, double steps_a_turn) {
  OrbitWidth w;
  w.begin(path(0.0), 0.0, 0.0);
  const auto steps = static_cast<int>(std::lround(turns * steps_a_turn));
  const double h = two_pi / steps_a_turn;
  for (int k = 0; k < steps; ++k) {
    std::array<Vec2, OrbitWidth::looks> seen;
    for (std::size_t i = 0; i < seen.size(); ++i)
      seen[i] = path(h * (k + 0.25 * static_cast<double>(i)));
    w.step(seen, h * k, h * (k + 1));
    w.turned_to(h * (k + 1), seen.back(), h * (k + 1));
  }
  return w;
}

Vec2 turned(double angle, double a, double b, double t) {
  const double x = a * std::cos(t), y = b * std::sin(t);
  return {x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle)};
}

// The major semi-axis of an ellipse at any angle, of a line and of a circle, far from the origin.
TEST(OrbitWidth, OfAnEllipseIsItsMajorAxis) {
  for (const double b : {0.0, 0.2, 0.7, 1.0, -0.4})
    for (int k = 0; k < 12; ++k) {
      const double angle = 0.271 * k;
      const auto path = [&](double t) -> Vec2 { return Vec2(50, -20) + turned(angle, 1.0, b, t); };
      EXPECT_NEAR(follow(path, 5.0, 20.0).amplitude(), 1.0, 1e-7) << b << " at " << angle;
    }
}

// Few looks a turn: the quartic through five.
TEST(OrbitWidth, ErrorOfLongSteps) {
  const auto path = [](double t) { return turned(0.4, 1.0, 0.5, t); };
  EXPECT_NEAR(follow(path, 5.0, 10.0).amplitude(), 1.0, 3e-6);
  EXPECT_NEAR(follow(path, 5.0, 5.0).amplitude(), 1.0, 1e-4);
}

// A whirl that grows to 3 and fades, on a centre that moves by 100: two turns of the drift count, and
// the time is that of the largest whirl.
TEST(OrbitWidth, DriftIsNoMotion) {
  const auto size = [](double t) {
    return 1.0 + 2.0 * std::exp(-std::pow((t - 1000.0) / 200.0, 2));
  };
  const auto path = [&](double t) -> Vec2 {
    return Vec2(100.0 * t / 2000.0, 0) + size(t) * Vec2(std::cos(t), std::sin(t));
  };
  const OrbitWidth w = follow(path, 318.0, 20.0);
  const double drift_of_two_turns = 0.05 * 2.0 * two_pi;
  EXPECT_GT(w.amplitude(), 3.0 - 1e-3);
  EXPECT_LT(w.amplitude(), 3.0 + 0.5 * drift_of_two_turns);
  EXPECT_NEAR(w.time(), 1000.0, 40.0);
}

// At half the speed one whirl takes two turns; at 0.4 of it two turns see nine tenths of the orbit's width.
TEST(OrbitWidth, SubsynchronousWhirl) {
  for (const double ratio : {0.5, 0.4, 0.3, 2.0, -1.0}) {
    const auto path = [&](double t) -> Vec2 {
      return 2.0 * Vec2(std::cos(ratio * t), std::sin(ratio * t));
    };
    EXPECT_NEAR(follow(path, 20.0, 20.0).amplitude(), 2.0, 0.03) << ratio;
  }
}

// A shaft that makes less than two turns: the whole path.
TEST(OrbitWidth, WithoutTurnsIsHalfThePath) {
  OrbitWidth w;
  w.begin(Vec2::Zero(), 0.0, 0.0);
  for (int k = 0; k < 10; ++k) {
    std::array<Vec2, OrbitWidth::looks> seen;
    for (std::size_t i = 0; i < seen.size(); ++i)
      seen[i] = Vec2(0.3, 0.4) * (k + 0.25 * static_cast<double>(i));
    w.step(seen, k, k + 1);
    w.turned_to(0.0, seen.back(), k + 1);
  }
  EXPECT_NEAR(w.amplitude(), 2.5, 1e-12);
  EXPECT_DOUBLE_EQ(w.time(), 10.0);
}

}  // namespace
}  // namespace whirl
