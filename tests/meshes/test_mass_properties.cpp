#include "models.hpp"

#include <gtest/gtest.h>
#include <meshes/mass_properties.hpp>

#include <cmath>

using namespace whirl;
using namespace whirl::meshes;
using namespace whirl::test;

namespace {

TEST(MassProperties, SolidCylinder) {
  const model::Model m = one_shaft({cylinder("a", 0.5, 0.1)});
  const MassProperties p = total_mass(m);
  const double mass = 7850 * pi * 0.05 * 0.05 * 0.5;
  EXPECT_NEAR(p.mass, mass, 1e-13 * mass);
  EXPECT_NEAR(p.centre().x(), 0.25, 1e-15);
  EXPECT_NEAR(p.Ip(), mass * 0.05 * 0.05 / 2, 1e-13);
  EXPECT_NEAR(p.Id(), mass * (3 * 0.05 * 0.05 + 0.5 * 0.5) / 12, 1e-13);
}

// Full cone of base radius R and height h: centre h/4 from the base, Ip = 3/10 m R^2, Id = 3/80 m
// (4R^2 + h^2) about it.
TEST(MassProperties, PointedCone) {
  model::Model m = one_shaft({rigid("cone", 0.4, 0.2)});
  m.shafts[0].sections[0].od_r = 0;
  m.shafts[0].origin = Vec3(1, 2, 3);
  const MassProperties p = total_mass(m);
  const double mass = 7850 * pi * 0.01 * 0.4 / 3;
  EXPECT_NEAR(p.mass, mass, 1e-13 * mass);
  EXPECT_LT((p.centre() - Vec3(1.1, 2, 3)).norm(), 1e-14);
  EXPECT_NEAR(p.Ip(), 0.3 * mass * 0.01, 1e-12);
  EXPECT_NEAR(p.Id(), 3.0 / 80 * mass * (4 * 0.01 + 0.16), 1e-12);
}

// A hollow frustum is the sum of many thin slices.
TEST(MassProperties, HollowFrustumAgainstSlices) {
  model::Model m = one_shaft({cylinder("a", 0.3, 0.1, 0.02), cylinder("b", 0.2, 0.06)});
  m.shafts[0].sections[0].od_r = 0.06;
  m.shafts[0].sections[0].id_r = 0.05;
  m.shafts[0].sections[1].added_mass_per_length = 12;
  MassProperties sum;
  const int n = 4000;
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < n; ++i) {
      const auto& s = m.shafts[0].sections[static_cast<std::size_t>(k)];
      const double x = (i + 0.5) / n, D = s.od_l + x * (s.od_r - s.od_l),
                   d = s.id_l + x * (s.id_r - s.id_l);
      const double A = pi / 4 * (D * D - d * d), I = pi / 64 * (std::pow(D, 4) - std::pow(d, 4)),
                   h = s.length / n;
      const double slice = 7850 * A * h;
      sum.add(slice, Vec3(0.3 * k + x * s.length, 0, 0), 7850 * h * Vec3(2 * I, I, I).asDiagonal());
      if (k == 1) sum.add(12 * h, Vec3(0.3 + x * s.length, 0, 0), Mat3::Zero());
    }
  const MassProperties p = total_mass(m);
  EXPECT_NEAR(p.mass / sum.mass, 1, 1e-7);  // midpoint rule: (1/4000)^2
  EXPECT_NEAR(p.centre().x() / sum.centre().x(), 1, 1e-7);
  EXPECT_NEAR(p.Ip() / sum.Ip(), 1, 1e-7);
  EXPECT_NEAR(p.Id() / sum.Id(), 1, 1e-7);
}

TEST(MassProperties, DisksOffsetSkewAndUnbalance) {
  model::Model m = one_shaft({rigid("rod", 1.0)});
  model::Disk d = disk("d", 0.25, 2, 0.02, 0.012);
  d.offset = Vec3(0.01, 0.002, 0);
  d.skew = 0.3;
  d.skew_phase = pi / 2;  // leans towards +z
  m.disks.push_back(d);
  auto u = named<model::Unbalance>("u", 0.25);
  u.amount = 2e-3;
  u.phase = pi / 2;
  m.unbalances.push_back(u);
  const MassProperties p = total_mass(m);
  EXPECT_NEAR(p.mass, 2, 1e-15);
  EXPECT_LT((p.centre() - Vec3(0.26, 0.002, 1e-3)).norm(), 1e-15);
  const Vec3 n(std::cos(0.3), 0, std::sin(0.3));
  const Mat3 J = 0.012 * Mat3::Identity() + 0.008 * n * n.transpose();
  MassProperties expected;
  expected.add(2, Vec3(0.26, 0.002, 0), J);
  // 2 g m at +z: products of inertia - x u about the origin
  expected.about_origin(0, 2) -= 0.25 * 2e-3;
  expected.about_origin(2, 0) -= 0.25 * 2e-3;
  EXPECT_LT((p.about_origin - expected.about_origin).norm(), 1e-15);
}

TEST(MassProperties, RotaryInertiaOffAndConstants) {
  model::Model m = one_shaft({cylinder("a", 1.0, 0.1)});
  m.shafts[0].sections[0].rotary_inertia = false;
  const double mass = total_mass(m).mass;
  EXPECT_NEAR(total_mass(m).Id(), mass / 12, 1e-12);
  EXPECT_NEAR(total_mass(m).Ip(), mass * 0.0025 / 2, 1e-13);
  m.shafts[0].sections[0].constants =
      model::Section::Constants{1, 1, 1, 1, 11.64, 13.17e-3, 26.33e-3};
  m.shafts[0].sections[0].rotary_inertia = true;
  EXPECT_NEAR(total_mass(m).mass, 11.64, 1e-14);
  EXPECT_NEAR(total_mass(m).Ip(), 26.33e-3, 1e-15);
  EXPECT_NEAR(total_mass(m).Id(), 11.64 / 12 + 13.17e-3, 1e-14);
}

TEST(MassProperties, TableNamesShaftsAndTotal) {
  model::Model m = one_shaft({cylinder("a", 1.0, 0.1)}, "lp");
  m.shafts.push_back(m.shafts[0]);
  m.shafts[1].name = "hp";
  const std::string t = mass_table(m);
  EXPECT_NE(t.find("lp "), std::string::npos);
  EXPECT_NE(t.find("hp "), std::string::npos);
  EXPECT_NE(t.find("total"), std::string::npos);
  EXPECT_NE(t.find("61.6538"), std::string::npos) << t;
}

}  // namespace
