// From a model to its drawing and its picture: sections, disks, bearings and probes stand where the
// deck puts them.
#include "xml_check.hpp"
#include <gtest/gtest.h>
#include <plot/rotor_drawing.hpp>
#include <plot/svg.hpp>
#include <algorithm>
#include <cmath>
#include <tuple>

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

/// A hollow cone, a solid cylinder and a section of constants, those of a circle of 30 mm, in a
/// casing that stands beside; a support that joins the two.
model::Model machine_of_two() {
  model::Model m;
  model::Material steel;
  steel.name = "steel";
  steel.E = 200e9;
  steel.G = 80e9;
  steel.rho = 8000;
  m.materials = {steel};
  model::Shaft rotor, casing;
  rotor.name = "rotor";
  rotor.sections = {section("cone", 0.2, 0.06, 0.02), section("solid", 0.3, 0.08, 0),
                    section("given", 0.1, 0, 0)};
  rotor.sections[0].od_r = 0.04;
  rotor.sections[0].id_r = 0.03;
  model::Section::Constants& k = rotor.sections[2].constants.emplace(model::Section::Constants{});
  const double r = 0.03, A = pi * r * r, I = pi * r * r * r * r / 4;
  k = {200e9 * A, 80e9 * A, 160e9 * I, 200e9 * I, 8000 * A, 8000 * I, 16000 * I};
  casing.name = "casing";
  casing.rotating = false;
  casing.origin = Vec3(0.1, 0.5, 0.2);
  casing.sections = {section("tube", 0.4, 0.5, 0.45)};
  m.shafts = {rotor, casing};
  const auto at = [](std::size_t shaft, double s) { return model::Location{shaft, s, "", {}}; };
  model::Disk disk;
  disk.name = "wheel";
  disk.at = at(0, 0.35);
  disk.mass = 10;
  disk.Ip = 0.2;                                 // radius 0.2 m
  disk.Id = 10 * (3 * 0.04 + 0.03 * 0.03) / 12;  // width 30 mm
  m.disks = {disk};
  for (const auto& [name, shaft, s] :
       {std::tuple{"A", 0, 0.1}, {"A2", 0, 0.1}, {"B", 0, 0.6}, {"foot", 1, 0.4}}) {
    model::Bearing b;
    b.name = name;
    b.at = at(static_cast<std::size_t>(shaft), s);
    b.law = model::LinearBearing{};
    m.bearings.push_back(b);
  }
  model::Bearing joins;
  joins.name = "joins";
  joins.at = at(0, 0.25);
  joins.to = at(1, 0.15);
  joins.law = model::LinearBearing{};
  m.bearings.push_back(joins);
  for (const auto& [name, s] : {std::pair{"P", 0.35}, {"Q", 0.05}}) {
    model::Probe p;
    p.name = name;
    p.at = at(0, s);
    m.probes.push_back(p);
  }
  return m;
}

using Corners = std::vector<double>;

void expect_corners(const plot::Patch& p, const Corners& x, const Corners& y, const char* of) {
  ASSERT_EQ(p.x.size(), x.size()) << of;
  for (std::size_t k = 0; k < x.size(); ++k) {
    EXPECT_NEAR(p.x[k], x[k], 1e-9) << of << k;
    EXPECT_NEAR(p.y[k], y[k], 1e-9) << of << k;
  }
}

/// Of all patches whose tooltip begins so, in their order.
std::vector<plot::Patch> patches(const plot::Figure& f, const std::string& tip) {
  std::vector<plot::Patch> out;
  for (const plot::Patch& p : f.axes.at(0).patches)
    if (p.tooltip.starts_with(tip)) out.push_back(p);
  return out;
}

const plot::Note* note(const plot::Figure& f, const std::string& text) {
  for (const plot::Note& n : f.axes.at(0).notes)
    if (n.text == text) return &n;
  return nullptr;
}

std::vector<plot::Figure> figures_of(const model::Model& m) {
  const meshes::Mesh mesh = meshes::make_mesh(m);
  return plot::draw_model(m, mesh, meshes::make_scene(m, mesh));
}

// In mm: places and radii of the deck.
TEST(RotorDrawing, PictureHasTheDeckSDimensions) {
  const auto figures = figures_of(machine_of_two());
  ASSERT_EQ(figures.size(), 3u);
  const plot::Figure& f = figures[1];
  EXPECT_EQ(f.name, "rotor");
  EXPECT_EQ(f.axes[0].x.label + f.axes[0].y.label, "axial positionradius");
  EXPECT_EQ(f.axes[0].x.unit + f.axes[0].y.unit, "mmmm");
  const Corners cone{0, 200, 200, 0}, solid{200, 500, 500, 200}, given{500, 600, 600, 500},
      wheel{335, 365, 365, 335};
  const auto cones = patches(f, "cone");
  ASSERT_EQ(cones.size(), 2u);
  expect_corners(cones[0], cone, {30, 20, 15, 10}, "cone");
  expect_corners(cones[1], cone, {-30, -20, -15, -10}, "cone");
  EXPECT_EQ(cones[0].tooltip, "cone: length 200 mm, outer diameter 60 to 40 mm, bore 20 to 30 mm");
  ASSERT_EQ(patches(f, "solid").size(), 1u);
  expect_corners(patches(f, "solid")[0], solid, {40, 40, -40, -40}, "solid");
  EXPECT_EQ(patches(f, "solid")[0].tooltip, "solid: length 300 mm, outer diameter 80 mm");
  ASSERT_EQ(patches(f, "given").size(), 1u);
  expect_corners(patches(f, "given")[0], given, {30, 30, -30, -30}, "given");
  const auto wheels = patches(f, "wheel");
  ASSERT_GE(wheels.size(), 1u);
  Corners rim = wheels[0].y;
  EXPECT_NEAR(rim[0], 200, 1e-9);
  EXPECT_NEAR(rim[1], 200, 1e-9);
  expect_corners(wheels[0], wheel, rim, "wheel");
  EXPECT_TRUE(wheels[0].tooltip.starts_with("wheel: outer diameter 400 mm, width 30 mm"));
  // two at one place have one mark: below the shaft
  for (const auto& [name, x, r] :
       {std::tuple{"A, A2", 100.0, 25.0}, {"B", 600.0, 30.0}, {"joins", 250.0, 40.0}}) {
    const auto marks = patches(f, name);
    ASSERT_EQ(marks.size(), 1u) << name;
    const double size = marks[0].x[1] - x;
    EXPECT_GT(size, 5);
    expect_corners(marks[0], {x, x + size, x - size}, {-r, -r - 1.6 * size, -r - 1.6 * size}, name);
    ASSERT_TRUE(note(f, name));
    EXPECT_NEAR(note(f, name)->x, x, 1e-9);
    EXPECT_NEAR(note(f, name)->y, -r - 1.6 * size, 1e-9);
  }
  ASSERT_TRUE(note(f, "wheel"));
  EXPECT_NEAR(note(f, "wheel")->x, 350, 1e-9);
  EXPECT_NEAR(note(f, "wheel")->y, -200, 1e-9);
  for (const plot::Series& s : f.axes[0].series)
    if (s.label == "probes") {  // a little above the rim and the cone, 27.5 mm there
      ASSERT_EQ(s.x.size(), 2u);
      EXPECT_NEAR(s.x[0], 350, 1e-9);
      EXPECT_NEAR(s.x[1], 50, 1e-9);
      EXPECT_GT(s.y[0], 200);
      EXPECT_NEAR(s.y[0] - 200, s.y[1] - 27.5, 1e-9);
    } else if (s.label == "nodes") {
      for (const double x : {0.0, 100.0, 200.0, 500.0, 600.0})
        EXPECT_EQ(
            std::count_if(s.x.begin(), s.x.end(), [x](double n) { return std::abs(n - x) < 1e-9; }),
            1)
            << x;
    } else {  // the centre line, over both ends
      ASSERT_EQ(s.trace_label, "centre line");
      EXPECT_LT(s.x[0], 0);
      EXPECT_NEAR(s.x[0] + s.x[1], 600, 1e-9);
      EXPECT_EQ(s.y, Corners({0, 0}));
    }
}

// The lines are further apart along y than along z: seen along z, each at its own height.
TEST(RotorDrawing, MachineHasItsLinesWhereTheyStand) {
  const auto figures = figures_of(machine_of_two());
  const plot::Figure& f = figures.at(0);
  EXPECT_EQ(f.name, "machine");
  EXPECT_EQ(f.axes[0].x.label + f.axes[0].y.label, "xy");
  EXPECT_EQ(figures.at(2).name, "rotor_2");
  const auto tube = patches(f, "casing, tube"), cones = patches(f, "rotor, cone"),
             link = patches(f, "joins");
  ASSERT_EQ(tube.size(), 2u);
  expect_corners(tube[0], {100, 500, 500, 100}, {750, 750, 725, 725}, "tube");
  expect_corners(tube[1], {100, 500, 500, 100}, {250, 250, 275, 275}, "tube");
  ASSERT_EQ(cones.size(), 2u);
  expect_corners(cones[0], {0, 200, 200, 0}, {30, 20, 15, 10}, "cone");
  // from the rotor's surface to the casing's
  ASSERT_EQ(link.size(), 1u);
  EXPECT_NEAR(link[0].x[0] + link[0].x[1], 500, 1e-9);
  EXPECT_GT(link[0].x[1], link[0].x[0]);
  EXPECT_NEAR(link[0].y[0], 40, 1e-9);
  EXPECT_NEAR(link[0].y[2], 250, 1e-9);
  ASSERT_TRUE(note(f, "joins"));
  EXPECT_NEAR(note(f, "joins")->y, 250, 1e-9);
  const auto foot = patches(f, "foot"), a = patches(f, "A");
  ASSERT_EQ(foot.size(), 1u);
  EXPECT_NEAR(foot[0].x[0], 500, 1e-9);
  EXPECT_NEAR(foot[0].y[0], 250, 1e-9);
  ASSERT_EQ(a.size(), 2u);  // each by itself here
  EXPECT_NEAR(a[0].x[0], 100, 1e-9);
  EXPECT_NEAR(a[0].y[0], -25, 1e-9);  // half way along the cone
  ASSERT_TRUE(note(f, "wheel"));
  EXPECT_NEAR(note(f, "wheel")->y, 200, 1e-9);
  const plot::Series& centre = f.axes[0].series.back();
  ASSERT_EQ(centre.x.size(), 6u);
  for (const auto& [k, x, y] : {std::tuple{0, 0, 0}, {1, 600, 0}, {3, 100, 500}, {4, 500, 500}}) {
    EXPECT_NEAR(centre.x[static_cast<std::size_t>(k)], x, 1e-9);
    EXPECT_NEAR(centre.y[static_cast<std::size_t>(k)], y, 1e-9);
  }
}

// A hinge between two lines is drawn on both and listed once.
TEST(RotorDrawing, AJointOfTwoLinesIsListedOnce) {
  plot::MachineDrawing machine;
  for (const double x : {0.0, 0.5}) {
    plot::MachineLine line;
    line.x = x;
    line.drawing.sections.push_back({0, 0.5, 0.01, 0.01, 0, 0, "bar"});
    line.drawing.joints.push_back({x > 0 ? 0 : 0.5, 0.01, "elbow", "hinge", plot::Marker::circle});
    machine.lines.push_back(std::move(line));
  }
  const plot::Figure f = plot::plot_machine("machine", machine);
  int drawn = 0, listed = 0;
  for (const plot::Series& s : f.axes.front().series) {
    if (s.style.marker != plot::Marker::circle) continue;
    ++drawn;
    listed += s.label.empty() ? 0 : 1;
  }
  EXPECT_EQ(drawn, 2);
  EXPECT_EQ(listed, 1);
}

// One within the other: a support reaches from the rotor to the bore.
TEST(RotorDrawing, SupportsWithinACasingReachToItsBore) {
  model::Model m = machine_of_two();
  m.shafts[1].origin = Vec3(0.1, 0, 0);
  const auto figures = figures_of(m);
  const plot::Figure& f = figures.at(0);
  EXPECT_EQ(f.axes[0].y.label, "radius");
  const auto link = patches(f, "joins");
  ASSERT_EQ(link.size(), 1u);
  EXPECT_NEAR(link[0].y[0], 40, 1e-9);
  EXPECT_NEAR(link[0].y[2], 225, 1e-9);
}

}  // namespace
}  // namespace whirl::io
