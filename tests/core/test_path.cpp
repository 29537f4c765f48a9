// Lines of straight pieces and arcs: lengths, points and axes against closed forms.
#include <core/path.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;

namespace {
constexpr double tol = 1e-13;  // round-off of a few rotations of unit size
}

TEST(Path, EmptyIsStraightAlongX) {
  const Path p(Vec3(1, 2, 3));
  EXPECT_TRUE(p.empty());
  EXPECT_LT((p.after(0.5).r - Vec3(1.5, 2, 3)).norm(), tol);
  EXPECT_LT((p.before(0.5).triad - Mat3::Identity()).norm(), tol);
}

TEST(Path, AnEighthOfACircleByEitherForm) {
  // from the origin along +y, centre (100, 0, 0): the bend of Bathe and Bolourchi
  const double R = 100, a = pi / 4;
  Path about, through;
  about = through = Path(Vec3::Zero());
  ASSERT_TRUE(about.add_arc_about(Vec3(R, 0, 7), Vec3(0, 0, -2),
                                  a));  // any point on the axis, any length of its direction
  const auto on = [&](double t) { return Vec3(R * (1 - std::cos(t)), R * std::sin(t), 0); };
  ASSERT_TRUE(through.add_arc_through(on(0.3), on(a)));
  for (const Path& p : {about, through}) {
    EXPECT_NEAR(p.length(), R * a, R * tol);
    for (const double t : {0.0, 0.2, a}) {
      const Path::Point x = p.before(R * t);
      EXPECT_LT((x.r - on(t)).norm(), R * tol);
      Mat3 triad;
      triad << Vec3(std::sin(t), std::cos(t), 0), Vec3(-std::cos(t), std::sin(t), 0), Vec3::UnitZ();
      EXPECT_LT((x.triad - triad).norm(), tol);
    }
    EXPECT_LT((p.after(R * a + 2).r - on(a) - 2 * Vec3(std::sin(a), std::cos(a), 0)).norm(),
              R * tol);
  }
}

TEST(Path, TheLongWayRound) {
  Path p(Vec3(1, 0, 0));
  ASSERT_TRUE(
      p.add_arc_through(Vec3(-1, 0, 0), Vec3(0, -1, 0)));  // three quarters of the unit circle
  EXPECT_NEAR(p.length(), 1.5 * pi, tol);
  EXPECT_LT((p.after(0.5 * pi).r - Vec3(0, 1, 0)).norm(), tol);
}

TEST(Path, CornersHaveTwoTriads) {
  Path p(Vec3::Zero());
  ASSERT_TRUE(p.add_line(Vec3(2, 0, 0)));
  ASSERT_TRUE(p.add_line(Vec3(2, 3, 0)));
  ASSERT_TRUE(p.add_line(Vec3(2, 3, -1)));
  EXPECT_DOUBLE_EQ(p.length(), 6.0);
  ASSERT_EQ(p.joints().size(), 2u);
  EXPECT_DOUBLE_EQ(p.joints()[1], 5.0);
  EXPECT_LT((p.before(2).triad - Mat3::Identity()).norm(), tol);
  Mat3 second;
  second << Vec3::UnitY(), -Vec3::UnitX(), Vec3::UnitZ();
  EXPECT_LT((p.after(2).triad - second).norm(), tol);
  Mat3 third;  // about -x by a right angle: y to -z, z to y
  third << -Vec3::UnitZ(), -Vec3::UnitX(), Vec3::UnitY();
  EXPECT_LT((p.after(5).triad - third).norm(), tol);
  EXPECT_LT((p.after(5.25).r - Vec3(2, 3, -0.25)).norm(), tol);
}

TEST(Path, BackAlongX) {
  Path p(Vec3::Zero());
  ASSERT_TRUE(p.add_line(Vec3(-1, 0, 0)));
  const Mat3 t = p.after(0).triad;
  EXPECT_LT((t.col(0) + Vec3::UnitX()).norm(), tol);
  EXPECT_LT((t.transpose() * t - Mat3::Identity()).norm(), tol);
  EXPECT_NEAR(t.determinant(), 1.0, tol);
}

TEST(Path, RefusesWhatIsNoPiece) {
  Path p(Vec3(1, 0, 0));
  EXPECT_FALSE(p.add_line(Vec3(1, 0, 0)));
  EXPECT_FALSE(p.add_arc_through(Vec3(2, 0, 0), Vec3(3, 0, 0)));
  EXPECT_FALSE(p.add_arc_through(Vec3(1, 0, 0), Vec3(3, 1, 0)));
  EXPECT_FALSE(p.add_arc_through(Vec3(3, 1, 0), Vec3(3, 1, 0)));
  EXPECT_FALSE(p.add_arc_about(Vec3(0, 0, 0), Vec3(1, 0, 0), 1.0));
  EXPECT_FALSE(p.add_arc_about(Vec3(0, 0, 0), Vec3::Zero(), 1.0));
  EXPECT_FALSE(p.add_arc_about(Vec3(0, 0, 0), Vec3(0, 0, 1), 0.0));
  EXPECT_FALSE(p.add_arc_about(Vec3(0, 0, 0), Vec3(0, 0, 1), 20.0));
  EXPECT_TRUE(p.empty());
}
