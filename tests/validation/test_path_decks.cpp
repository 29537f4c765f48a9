// Lines along a path through the deck: the 45-degree bend, a right-angle frame, a half ring; and
// the Princeton strip, straight with a general section.
//
// Bend: K. J. Bathe, S. Bolourchi, Int. J. Numer. Meth. Engng 14 (1979) 961, doi
// 10.1002/nme.1620140703. Strip: E. H. Dowell, J. Traybar 1975. Values by shooting with the exact
// rod.
#include "deck_model.hpp"
#include "exact_rod.hpp"
#include "record.hpp"
#include "static_model.hpp"

#include <analysis/spectra/whirl_modes.hpp>
#include <meshes/mass_properties.hpp>
#include <meshes/scene.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

const char* const clamp_first = R"(
[[bearing]]
name = "clamp"
at = "line:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
)";

std::string bend_deck(int elements, double F, const char* path) {
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "bar"
E = "1e7 Pa"
nu = 0
density = "0 kg/m^3"
[[shaft]]
name = "bend"
material = "bar"
rotating = false
path = [{}]
[[shaft.section]]
name = "line"
length = "78.53981633974483 m"
min_elements = {}
general = {{ A = "1 m^2", Iy = "0.08333333333333333 m^4", Iz = "0.08333333333333333 m^4", J = "0.16666666666666667 m^4", kappa_y = 1, kappa_z = 1 }}
{}
[[load]]
at = "line:end"
force = ["0 N", "0 N", "{} N"]
)",
                     path, elements, clamp_first, F);
}

Vec3 end_of(const Solved& s) {
  const Index n = s.mesh.lines[0].first_node + s.mesh.lines[0].nodes - 1;
  return s.mesh.nodes[static_cast<std::size_t>(n)].position + s.node(n).u;
}

}  // namespace

TEST(PathDecks, BendOf45Degrees) {
  Record record("45-degree bend, end pulled out of its plane",
                "K. J. Bathe, S. Bolourchi 1979, doi 10.1002/nme.1620140703; values of the exact "
                "shear-deformable rod");
  struct Case {
    double F;
    Vec3 tip;
  };
  for (const Case& c : {Case{300, {22.24478095, 58.77912249, 40.19189167}},
                        Case{600, {15.68480053, 47.15043857, 53.47485879}}}) {
    const DeckModel m(bend_deck(
        32, c.F, R"({ centre = ["100 m", "0 m", "0 m"], axis = [0, 0, -1], angle = "45 deg" })"));
    const Solved s = solve(m.deck.model);
    for (int k = 0; k < 3; ++k)
      record.check(fmt::format("F = {} N, tip {}", c.F, "xyz"[k]), "m", end_of(s)[k], c.tip[k],
                   5e-6);  // 32 elements; order 4
    const Vec3 reaction = s.support(0);
    EXPECT_LT((reaction + Vec3(0, 0, c.F)).norm(), 1e-9 * c.F);
    // section forces in the axes carried along the line: at the end no moment; at the clamp the
    // moment of the force about it
    const assembly::SectionPoint &first = s.sections.front(), &last = s.sections.back();
    EXPECT_LT(last.moment.norm(), 1e-7 * c.F * 78.5);
    EXPECT_LT((first.moment - end_of(s).cross(Vec3(0, 0, c.F))).norm(), 1e-7 * c.F * 78.5);
    EXPECT_NEAR(first.T, first.moment.y(),
                1e-9 * c.F * 78.5);  // the line starts along y, its section axes are -x and z
    EXPECT_NEAR(first.M[0], -first.moment.x(), 1e-9 * c.F * 78.5);
    // the axes turn with the twist: where two elements meet both say the same
    for (std::size_t k = 5; k < s.sections.size(); k += 5)
      EXPECT_LT((s.sections[k].M - s.sections[k - 1].M).norm(), 1e-7 * c.F * 78.5) << k;
  }
  // the same arc through a point of it
  const double t = pi / 8, r = 100;
  const DeckModel m(bend_deck(
      16, 300,
      fmt::format(
          R"({{ through = ["{:.17g} m", "{:.17g} m", "0 m"], to = ["{:.17g} m", "{:.17g} m", "0 m"] }})",
          r * (1 - std::cos(t)), r * std::sin(t), r * (1 - std::cos(2 * t)), r * std::sin(2 * t))
          .c_str()));
  EXPECT_LT((end_of(solve(m.deck.model)) - Vec3(22.24478095, 58.77912249, 40.19189167)).norm(),
            3e-5);  // 16 elements
}

TEST(PathDecks, PrincetonStrip) {
  Record record("Princeton beam, load at 45 degrees to the strip",
                "E. H. Dowell, J. Traybar 1975; values of the exact shear-deformable rod");
  const double E = 7.17e10, G = E / 2.62, EA = 2932146.262, EIz = 2.505852698, EIy = 39.84613284,
               GJ = 3.221507621;  // y thin, z high
  const std::string deck = fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "aluminium"
E = "71.7 GPa"
nu = 0.31
density = "2700 kg/m^3"
[[shaft]]
name = "strip"
material = "aluminium"
rotating = false
[[shaft.section]]
name = "line"
length = "508 mm"
min_elements = 16
general = {{ A = "{:.17g} m^2", Iy = "{:.17g} m^4", Iz = "{:.17g} m^4", J = "{:.17g} m^4", kappa_y = {:.17g}, kappa_z = {:.17g} }}
{}
[[load]]
at = "line:end"
force = ["0 N", "{:.17g} N", "{:.17g} N"]
)",
                                       EA / E, EIy / E, EIz / E, GJ / G, 932616.4954 / (G * EA / E),
                                       932616.4954 / (G * EA / E), clamp_first,
                                       13.345 * std::sqrt(0.5), 13.345 * std::sqrt(0.5));
  const Solved s = solve(DeckModel(deck).deck.model);
  const Vec3 u = end_of(s) - Vec3(0.508, 0, 0);
  // 16 elements leave 4e-9 m, of order 4
  record.check("P = 13.345 N, deflection along the soft axis", "m", u.y(), 0.1525123157, 1e-7);
  record.check("P = 13.345 N, deflection along the hard axis", "m", u.z(), 0.01406221437, 1e-7);
}

TEST(PathDecks, RightAngleFrame) {
  // Legs a along x and b along y, force along z at the end, so small that the frame is linear: w =
  // F (a^3 + b^3)/(3 EI) + F a b^2/GJ + F (a + b)/kGA.
  const double a = 0.6, b = 0.4, E = 2e11, nu = 0.25, d = 0.02, F = 1e-3;
  const std::string deck = fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
nu = {}
density = "7800 kg/m^3"
[[shaft]]
name = "frame"
material = "m"
rotating = false
shear = "given"
kappa = 0.9
path = [{{ to = ["600 mm", "0 mm", "0 mm"] }}, {{ to = ["600 mm", "400 mm", "0 mm"] }}]
columns = ["name", "length[mm]", "od[mm]"]
rows = [["line", 1000, 20]]
{}
[[load]]
at = "line:end"
force = ["0 N", "0 N", "{} N"]
)",
                                       nu, clamp_first, F);
  const DeckModel m(deck);
  ASSERT_EQ(m.mesh.nodes.size() - static_cast<std::size_t>(m.mesh.lines[0].first_node),
            3u);  // a node at the corner: one element a leg is exact
  const Solved s = solve(m.deck.model);
  const double I = pi * std::pow(d, 4) / 64, G = E / (2 * (1 + nu)), A = pi * d * d / 4;
  const double w = F * (a * a * a + b * b * b) / (3 * E * I) + F * a * b * b / (2 * G * I) +
                   F * (a + b) / (0.9 * G * A);
  EXPECT_NEAR((end_of(s) - Vec3(a, b, 0)).z(), w, 1e-9 * w);
  // stress at the clamp: bending F a about y, torsion F b, of a round bar
  const assembly::SectionPoint& p = s.sections.front();
  EXPECT_NEAR(p.T, F * b, 1e-9 * F);
  EXPECT_NEAR(p.M[0], -F * a, 1e-9 * F);
  EXPECT_NEAR(p.bending, F * a * d / (2 * I), 1e-8 * p.bending);
}

TEST(PathDecks, HalfRingHasItsMassAndWeight) {
  const double R = 0.5, d = 0.03, rho = 7800, A = pi * d * d / 4, L = pi * R, mass = rho * A * L;
  const std::string deck = fmt::format(R"(format = 1
[model]
gravity = "9.81 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
nu = 0.3
density = "7800 kg/m^3"
[[shaft]]
name = "ring"
origin = ["500 mm", "0 mm", "0 mm"]
material = "m"
rotating = false
path = [{{ through = ["0 mm", "500 mm", "0 mm"], to = ["-500 mm", "0 mm", "0 mm"] }}]
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["line", {:.17g}, 30, 12]]
{}
[[disk]]
name = "weight"
at = "line:end"
mass = "2 kg"
Ip = "0.02 kg.m^2"
Id = "0.01 kg.m^2"
)",
                                       1e3 * L, clamp_first);
  const DeckModel m(deck);
  const meshes::MassProperties p = meshes::shaft_mass(m.deck.model, 0);
  EXPECT_NEAR(p.mass, mass + 2, 1e-12 * p.mass);
  EXPECT_LT((p.centre() - Vec3(-2 * R, mass * 2 * R / pi, 0) / (mass + 2)).norm(), 1e-12);
  // about z through the centre of the ring: the line, its cross-sections (rho I L), and the disk,
  // whose axis is that of the line there, y
  EXPECT_NEAR(p.about_origin(2, 2),
              mass * R * R + rho * pi * std::pow(d, 4) / 64 * L + 2 * R * R + 0.01, 1e-12);
  EXPECT_NEAR(p.about_origin(1, 1),
              0.5 * mass * R * R + 1.5 * rho * pi * std::pow(d, 4) / 64 * L + 2 * R * R + 0.02,
              1e-12);
  const Solved s = solve(m.deck.model);
  EXPECT_LT((s.support(0) - Vec3(0, 0, 9.81 * (mass + 2))).norm(), 1e-8);
  // picture: the ends of the line, and the disk standing across it
  const meshes::Scene scene = meshes::make_scene(m.deck.model, m.mesh);
  std::vector<meshes::Pose> rest;
  for (const Vec3& r : scene.nodes)
    rest.push_back({r, Vec3::UnitX(), 0.0});
  const meshes::Skin skin(scene, 16);
  std::vector<float> points, normals;
  skin.update(rest, points, normals);
  double far = 0;
  for (std::size_t k = 0; k < points.size(); k += 3) {
    const Vec3 x(points[k], points[k + 1], points[k + 2]);
    if (x.y() < 0.2) continue;  // away from the disk: on a torus
    far = std::max(far, std::abs(std::hypot(std::hypot(x.x(), x.y()) - R, x.z()) - d / 2));
  }
  EXPECT_LT(far, 1e-5);  // cubic between the nodes of 15 degrees: R phi^4/384 is 6e-6
}

TEST(PathDecks, AFreeFrameIsHeldNowhere) {
  // Modes about the drawing of a right-angle frame that nothing supports, against the same frame on a
  // spring of 1 N/m along x: held at a node along x its first frequency would be 10 % lower.
  const auto modes = [](const std::string& support) {
    const DeckModel m(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "frame"
material = "steel"
rotating = false
path = [{ to = ["600 mm", "0 mm", "0 mm"] }, { to = ["600 mm", "400 mm", "0 mm"] }]
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["line", 1000, 20, 10]]
)" + support + R"([[step]]
name = "m"
type = "modal"
about = "undeformed"
)");
    EXPECT_TRUE(m.built.held.empty());
    analysis::Linearizer linear(m.built.system, m.running());
    linear.stay_undeformed();
    analysis::ModesOptions o;
    o.count = 8;
    std::vector<double> out;
    for (const analysis::WhirlMode& mode : analysis::whirl_modes(linear, 0.0, o))
      if (mode.frequency > two_pi) out.push_back(mode.frequency);
    return out;
  };
  const std::vector<double> free = modes(""), soft = modes(R"([[bearing]]
name = "soft"
at = "line:start"
type = "linear"
kxx = "1 N/m"
)");
  ASSERT_GE(free.size(), 6u);
  ASSERT_GE(soft.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(free[k], soft[k], 1e-5 * soft[k]) << k;
}
