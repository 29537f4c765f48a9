// The skin of the rotor: closed, outward, true to size, and turning with phi.
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <meshes/surface.hpp>
#include <cmath>
#include <map>
#include <random>

namespace whirl::meshes {
namespace {

Scene two_node_scene(double length, std::vector<ShaftPiece> pieces,
                     std::vector<DiskShape> disks = {}) {
  Scene s;
  s.nodes = {Vec3(0, 0, 0), Vec3(length, 0, 0)};
  s.node_line = {0, 0};
  Scene::Line line;
  line.pieces = std::move(pieces);
  line.disks = std::move(disks);
  s.lines = {line};
  return s;
}

std::vector<Pose> rest(const Scene& s) {
  std::vector<Pose> p;
  for (const auto& r : s.nodes)
    p.push_back({r, Vec3::UnitX(), 0.0});
  return p;
}

struct Corner {
  Vec3 x, n;
};
Corner corner(const std::vector<float>& p, const std::vector<float>& n, Index i) {
  const auto k = static_cast<std::size_t>(3 * i);
  return {Vec3(p[k], p[k + 1], p[k + 2]), Vec3(n[k], n[k + 1], n[k + 2])};
}

// Volume by the divergence theorem; negative when the quads face inwards.
double volume(const Skin& skin, const std::vector<float>& p) {
  double v = 0;
  const auto& q = skin.quads();
  for (std::size_t k = 0; k < q.size(); k += 4) {
    Vec3 x[4];
    for (std::size_t j = 0; j < 4; ++j)
      x[j] = corner(p, p, q[k + j]).x;
    v += (x[0].dot(x[1].cross(x[2])) + x[0].dot(x[2].cross(x[3]))) / 6.0;
  }
  return v;
}

// Area of a regular polygon of n points against its circle.
double polygon(int n) { return 0.5 * n * std::sin(two_pi / n); }

TEST(Skin, SteppedHollowConicalShaftHasItsVolumeAndIsClosed) {
  // 0.3 m cone 60 -> 80 mm with a 20 mm bore, then 0.2 m of 100 mm, solid.
  Scene s = two_node_scene(0.5, {});
  s.nodes = {Vec3(0, 0, 0), Vec3(0.3, 0, 0), Vec3(0.5, 0, 0)};
  s.node_line = {0, 0, 0};
  s.lines[0].pieces = {{{0, 0}, {1, 0}, 0.03, 0.04, 0.01, 0.01},
                       {{1, 0}, {2, 0}, 0.05, 0.05, 0, 0}};
  constexpr int n = 40;
  Skin skin(s, n);
  std::vector<float> p, normals;
  const auto poses = rest(s);
  skin.update(poses, p, normals);
  const double expected = polygon(n) * (0.3 / 3 * (0.03 * 0.03 + 0.03 * 0.04 + 0.04 * 0.04) -
                                        0.3 * 1e-4 + 0.2 * 0.05 * 0.05);
  // Coordinates are float: 6e-8 of 0.5 m over a radius of 0.05 m.
  EXPECT_NEAR(volume(skin, p), expected, 2e-6 * expected);

  // Closed: every directed edge of positive length has its opposite. Rings are duplicated, so
  // compare positions.
  std::map<std::array<int, 6>, int> edges;
  const auto key = [](const Vec3& a, const Vec3& b) {
    std::array<int, 6> k;
    for (Index c = 0; c < 3; ++c) {
      k[static_cast<std::size_t>(c)] = static_cast<int>(std::lround(a[c] * 1e6));
      k[static_cast<std::size_t>(c + 3)] = static_cast<int>(std::lround(b[c] * 1e6));
    }
    return k;
  };
  const auto& q = skin.quads();
  for (std::size_t k = 0; k < q.size(); k += 4)
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec3 a = corner(p, p, q[k + j]).x, b = corner(p, p, q[k + (j + 1) % 4]).x;
      if ((a - b).norm() > 1e-7) {
        ++edges[key(a, b)];
        --edges[key(b, a)];
      }
    }
  for (const auto& [k, count] : edges)
    EXPECT_EQ(count, 0);

  // Normals: unit, and on the outer side of each quad.
  for (std::size_t k = 0; k < q.size(); k += 4) {
    const Corner a = corner(p, normals, q[k]), c = corner(p, normals, q[k + 2]),
                 b = corner(p, normals, q[k + 1]), d = corner(p, normals, q[k + 3]);
    const Vec3 facet = (c.x - a.x).cross(d.x - b.x);
    if (facet.norm() < 1e-12) continue;
    for (const auto& x : {a, b, c, d}) {
      EXPECT_NEAR(x.n.norm(), 1.0, 1e-6);
      EXPECT_GT(x.n.dot(facet.normalized()),
                0.95);  // half a facet of 9 degrees and the cone: cos < 5 degrees
    }
  }
}

TEST(Skin, DiskStandsOnTheTiltedSectionAndStripeTurnsWithPhi) {
  Scene s;
  s.nodes = {Vec3(0.2, 0, 0)};
  s.node_line = {0};
  s.lines.resize(1);
  s.lines[0].disks = {{"disk", {0, 0.05}, 0.25, 0.02, 0.04}};
  Skin skin(s, 32);
  ASSERT_EQ(skin.stripe().size(), static_cast<std::size_t>(skin.quad_count()));
  EXPECT_EQ(skin.part()[0], 1);
  const double g = 0.7, phi = 1234.5;
  const Vec3 d = Eigen::AngleAxisd(g, Vec3(0, 0.6, 0.8)) * Vec3::UnitX();
  const std::vector<Pose> pose = {{Vec3(1, 2, 3), d, phi}};
  std::vector<float> p, n;
  skin.update(pose, p, n);
  // The total rotation of the split: first phi about e, then the transverse rotation.
  const Mat3 R = (Eigen::AngleAxisd(g, Vec3(0, 0.6, 0.8)) * Eigen::AngleAxisd(phi, Vec3::UnitX()))
                     .toRotationMatrix();
  std::vector<float> p0, n0;
  const auto home = rest(s);
  skin.update(home, p0, n0);
  for (Index i = 0; i < skin.point_count(); ++i) {
    const Corner now = corner(p, n, i), before = corner(p0, n0, i);
    // Float coordinates of size 3 m: 2.4e-7.
    EXPECT_LT((now.x - (pose[0].r + R * (before.x - s.nodes[0]))).norm(), 6e-7);
    EXPECT_LT((now.n - R * before.n).norm(), 3e-7);
  }
  int painted = 0;
  for (const auto x : skin.stripe())
    painted += x;
  EXPECT_EQ(painted, 4 * 2);  // two of 32 sectors on the rim, the bore and both faces
}

TEST(Skin, RigidMotionOfAFlexiblePieceIsRigid) {
  Scene s = two_node_scene(0.4, {{{0, 0}, {1, 0}, 0.02, 0.03, 0.0, 0.0}},
                           {{"d", {1, 0}, 0.1, 0.03, 0.02}});
  Skin skin(s, 16);
  const Mat3 R = (Eigen::AngleAxisd(1.1, Vec3(0, 1, 0)) * Eigen::AngleAxisd(0.4, Vec3::UnitX()))
                     .toRotationMatrix();
  std::vector<Pose> moved;
  for (const auto& r : s.nodes)
    moved.push_back({Vec3(0.1, -0.2, 0.3) + R * r, R.col(0), 0.4});
  std::vector<float> p0, n0, p, n;
  const auto home = rest(s);
  skin.update(home, p0, n0);
  skin.update(moved, p, n);
  for (Index i = 0; i < skin.point_count(); ++i)
    EXPECT_LT((corner(p, n, i).x - Vec3(0.1, -0.2, 0.3) - R * corner(p0, n0, i).x).norm(), 2e-7);
}

TEST(Magnified, ScalesTiltAndDisplacementAlikeAndKeepsTheSpin) {
  // A rigid rod, both ends displaced and tilted together: magnified ends and directors still belong
  // to a rod.
  const Vec3 e = Vec3::UnitX();
  const Vec3 d = Vec3(1, 1e-3, -2e-3).normalized();
  const Pose a{Vec3(0, 1e-4, 0), d, 5.0}, b{Vec3(0, 1e-4, 0) + 0.5 * d, d, 5.0};
  const Pose A = magnified(a, Vec3(0, 0, 0), e, 100), B = magnified(b, Vec3(0.5, 0, 0), e, 100);
  EXPECT_NEAR((B.r - A.r).normalized().dot(A.d), 1.0, 1e-12);
  EXPECT_NEAR(A.d.y() / A.d.x(), 0.1, 1e-4);  // tangent of the slope, times 100; the rest is cos g
  EXPECT_EQ(A.phi, 5.0);
  EXPECT_EQ(magnified(a, Vec3(0, 0, 0), e, 1).d, a.d);
}

TEST(SectionAxes, EqualsTheSplitRotationForAnyTilt) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int k = 0; k < 200; ++k) {
    const Mat3 triad =
        Eigen::Quaterniond(u(rng), u(rng), u(rng), u(rng)).normalized().toRotationMatrix();
    const Vec3 axis = (triad.col(1) * u(rng) + triad.col(2) * u(rng)).normalized();
    const double g = 1.55 * (1 + u(rng)), phi = 10 * u(rng);
    const Mat3 R =
        (Eigen::AngleAxisd(g, axis) * Eigen::AngleAxisd(phi, triad.col(0))).toRotationMatrix();
    const Mat3 expected = R * triad;
    EXPECT_LT((section_axes(triad, expected.col(0), phi) - expected).norm(), 1e-11)
        << g;  // 1e-16/(1 + cos g), g <= 3.1
  }
}

}  // namespace
}  // namespace whirl::meshes
