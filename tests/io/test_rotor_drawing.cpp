// From a model to its drawing and its picture: sections, disks, bearings and probes stand where the
// deck puts them.
#include "xml_check.hpp"
#include <gtest/gtest.h>
#include <plot/rotor_drawing.hpp>
#include <plot/svg.hpp>
#include <cmath>

namespace whirl::io {
namespace {

model::Section section(const char* name, double length, double od, double id) {
  model::Section s;
  s.name = name;
  s.length = length;
  s.od_l = s.od_r = od;
  s.id_l = s.id_r = id;
  return s;
}

TEST(RotorDrawing, FollowsTheModel) {
  model::Model m;
  model::Material steel;
  steel.name = "steel";
  steel.E = 211e9;
  steel.G = 81e9;
  steel.rho = 7810;
  m.materials = {steel};
  model::Shaft shaft;
  shaft.name = "hp";
  shaft.sections = {section("left", 0.2, 0.05, 0), section("right", 0.3, 0.08, 0.02)};
  m.shafts = {shaft};
  const auto at = [](double s) { return model::Location{0, s, "", {}}; };
  model::Disk disk;
  disk.name = "impeller";
  disk.at = at(0.4);
  disk.mass = 10;
  disk.Ip = 0.2;
  disk.Id = 0.1;
  m.disks = {disk};
  model::Bearing bearing;
  bearing.name = "DE";
  bearing.at = at(0.1);
  bearing.law = model::LinearBearing{};
  m.bearings = {bearing};
  model::Probe probe;
  probe.name = "P";
  probe.at = at(0.2);
  m.probes = {probe};

  const meshes::Mesh mesh = meshes::make_mesh(m);
  const auto drawings = plot::make_rotor_drawings(m, mesh, meshes::make_scene(m, mesh));
  ASSERT_EQ(drawings.size(), 1u);
  const auto& d = drawings[0];
  ASSERT_EQ(d.sections.size(), 2u);
  EXPECT_DOUBLE_EQ(d.sections[1].s0, 0.2);
  EXPECT_DOUBLE_EQ(d.sections[1].s1, 0.5);
  EXPECT_DOUBLE_EQ(d.sections[1].inner_left, 0.01);
  ASSERT_EQ(d.disks.size(), 1u);
  EXPECT_NEAR(d.disks[0].s, 0.4, 1e-12);
  EXPECT_NEAR(d.disks[0].outer, std::sqrt(2 * 0.2 / 10), 1e-12);  // a solid disk of this inertia
  ASSERT_EQ(d.bearings.size(), 1u);
  EXPECT_NEAR(d.bearings[0].s, 0.1, 1e-12);
  EXPECT_NEAR(d.bearings[0].radius, 0.025, 1e-12);
  ASSERT_EQ(d.probes.size(), 1u);
  EXPECT_NEAR(d.probes[0].radius, 0.04, 1e-12);  // at a step: the larger side
  EXPECT_EQ(d.nodes.size(), static_cast<std::size_t>(mesh.lines[0].nodes));
  EXPECT_EQ(xml_fault(plot::render_svg(plot::plot_rotor("rotor", d))), "");
}

}  // namespace
}  // namespace whirl::io
