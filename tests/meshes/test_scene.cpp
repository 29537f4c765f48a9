#include "models.hpp"

#include <gtest/gtest.h>
#include <meshes/scene.hpp>

using namespace whirl;
using namespace whirl::meshes;
using namespace whirl::test;

namespace {

TEST(Scene, PaperRotor) {
  model::Model m = one_shaft({rigid("rod", 0.75)});
  m.disks.push_back(disk("disk", 0.75, 5, 5 * 0.25 / 8, 5 * 0.25 / 16));  // thin, D = 0.5 m
  auto b = named<model::Bearing>("block", 0.0);
  b.law = model::SpringBlock{2000, 500};
  m.bearings.push_back(b);
  m.probes.push_back(named<model::Probe>("p", 0.75));
  const Mesh mesh = make_mesh(m);
  const Scene s = make_scene(m, mesh);
  ASSERT_EQ(s.nodes.size(), 1u);
  ASSERT_EQ(s.lines.size(), 1u);
  ASSERT_EQ(s.lines[0].pieces.size(), 1u);
  EXPECT_EQ(s.lines[0].pieces[0].left.offset, -0.75);
  EXPECT_NEAR(s.lines[0].pieces[0].outer_left, 0.0075, 1e-15);
  ASSERT_EQ(s.lines[0].disks.size(), 1u);
  EXPECT_NEAR(s.lines[0].disks[0].outer, 0.25, 1e-15);
  EXPECT_NEAR(s.lines[0].disks[0].width, 0.01, 1e-9);  // thin: the least drawn
  EXPECT_EQ(s.supports[0].picture, model::Picture::spring);
  EXPECT_FALSE(s.supports[0].to_node);
  EXPECT_EQ(s.trails[0].at.node, 0);
  const Skin skin(s, 12);
  EXPECT_GT(skin.quad_count(), 0);
}

TEST(Scene, StepsConesRigidPartsAndPedestalsInOrder) {
  model::Model m = one_shaft({cylinder("a", 0.2, 0.04, 0.01, 2), rigid("hub", 0.1, 0.12),
                              cylinder("cone", 0.3, 0.04, 0, 3)});
  m.shafts[0].sections[2].od_r = 0.1;
  auto b = spring("b", 0.0, 1e7);
  b.pedestal = model::Pedestal{10, 1e8 * Mat3::Identity(), Mat3::Zero()};
  m.bearings.push_back(b);
  m.bearings.push_back(spring("c", 0.6, 1e7));
  const Mesh mesh = make_mesh(m);
  const Scene s = make_scene(m, mesh);
  EXPECT_EQ(s.nodes.size(), mesh.nodes.size());
  EXPECT_EQ(s.node_line.size(), mesh.nodes.size());
  ASSERT_EQ(s.lines[0].pieces.size(), 6u);
  double at = 0;
  for (const ShaftPiece& p : s.lines[0].pieces) {  // one follows the other
    EXPECT_NEAR(s.nodes[static_cast<std::size_t>(p.left.node)].x() + p.left.offset, at, 1e-15);
    at = s.nodes[static_cast<std::size_t>(p.right.node)].x() + p.right.offset;
  }
  EXPECT_NEAR(at, 0.6, 1e-15);
  EXPECT_NEAR(s.lines[0].pieces[2].outer_left, 0.06, 1e-15);
  EXPECT_NEAR(s.lines[0].pieces[5].outer_left, 0.04, 1e-15);
  EXPECT_NEAR(s.lines[0].pieces[5].outer_right, 0.05, 1e-15);
  EXPECT_NEAR(s.lines[0].pieces[1].inner_right, 0.005, 1e-15);
  EXPECT_TRUE(s.supports[0].to_node);
  EXPECT_EQ(s.supports[0].to.node, mesh.bearings[0].pedestal);
  EXPECT_FALSE(s.supports[1].to_node);
  ASSERT_EQ(s.lines[0].points.size(), s.lines[0].radius.size());
}

}  // namespace
