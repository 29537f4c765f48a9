// Shapes of modes and of responses as figures, read back from their files, against closed forms.
#include "deck_run.hpp"
#include "drawn.hpp"
#include "lateral_mass.hpp"

#include <algorithm>
#include <functional>

namespace {

using namespace whirl;
using test::DeckRun;
using test::DrawnAxes;
using test::DrawnCurve;
using test::DrawnSpaceCurve;
using test::Pixel;
using Shape = std::function<double(double)>;  ///< of the place along a line of length 1

const Shape none = [](double) { return 0.0; };

/// E I and the mass of a length are one for all modes: only the ends make the shapes.
const char* const slender = R"(format = 1
[[material]]
name = "m"
E = "200 GPa"
nu = 0.3
density = "8000 kg/m^3"
[output]
report = true
)";

/// Half a sine: both ends pinned.
double pinned(double x) { return std::sin(pi * x); }

/// Both ends held, the first mode: cosh b = 1/cos b.
double held(double x) {
  constexpr double b = 4.730040744862704;
  const double s = (std::cosh(b) - std::cos(b)) / (std::sinh(b) - std::sin(b));
  const auto of = [s](double v) {
    return std::cosh(v) - std::cos(v) - s * (std::sinh(v) - std::sin(v));
  };
  return of(b * x) / of(b / 2);
}

/// The left end held, the right one free, the first mode: cosh b = -1/cos b.
double cantilever(double x) {
  constexpr double b = 1.875104068711961;
  const double s = (std::sinh(b) - std::sin(b)) / (std::cosh(b) + std::cos(b));
  const auto of = [s](double v) {
    return std::cosh(v) - std::cos(v) - s * (std::sinh(v) - std::sin(v));
  };
  return of(b * x) / of(b);
}

DrawnAxes axes_of(const DeckRun& run, const std::string& figure, std::size_t k) {
  const auto all = test::drawn(run.folder / "r" / "plots" / (figure + ".svg"));
  return k < all.size() ? all[k] : DrawnAxes{};
}

/// The line from x0 to x1, in the units of the axis.
std::vector<Pixel> line_of(const DrawnAxes& a, double x0, double x1, const Shape& shape,
                           double factor) {
  std::vector<Pixel> out;
  for (int k = 0; k <= 200; ++k) {
    const double x = k / 200.0;
    out.push_back(a.place(x0 + (x1 - x0) * x, factor * shape(x)));
  }
  return out;
}

constexpr double near = 0.8;  // px: cubics between nodes, rounding of the file

void expect_curve(const DrawnAxes& a, const std::string& name, double x0, double x1,
                  const Shape& shape, double factor, const std::string& where) {
  const DrawnCurve* c = a.curve(name);
  ASSERT_TRUE(c) << where << " " << name;
  const std::vector<Pixel> line = line_of(a, x0, x1, shape, factor);
  EXPECT_LT(test::farthest(c->points, line), near) << where << " " << name;
  EXPECT_LT(test::farthest(line, c->points), near) << where << " " << name;
}

/// A shape is drawn at one of two moments, half a period apart.
double moment_of(const DrawnSpaceCurve& c, Index axis) {
  double most = 0;
  for (const Vec3& p : c.points)
    if (std::abs(p[axis]) > std::abs(most)) most = p[axis];
  return most > 0 ? 1 : -1;
}

struct LateralMode {
  const char* figure;
  Index axis;  ///< 1 y, 2 z
  Shape shape;
};

void expect_in_space(const DrawnAxes& space, const LateralMode& m) {
  EXPECT_EQ(space.kind, "space");
  EXPECT_EQ(space.x_title, "axial position [mm]");
  EXPECT_EQ(space.y_title, "deflection y, largest = 1");
  const DrawnSpaceCurve* line = space.space_curve("deflected shaft");
  ASSERT_TRUE(line) << m.figure;
  const double sign = moment_of(*line, m.axis);
  const Index other = 3 - m.axis;
  const auto expect_on_it = [&](const Vec3& p, const char* of) {
    EXPECT_NEAR(p[m.axis], sign * m.shape(p.x() / 1e3), 1.5e-3) << m.figure << of;
    EXPECT_NEAR(p[other], 0, 1.5e-3) << m.figure << of;
  };
  EXPECT_NEAR(line->points.front().x(), 0, 0.1);
  EXPECT_NEAR(line->points.back().x(), 1000, 0.1);
  for (const Vec3& p : line->points)
    expect_on_it(p, " line");
  // the axis at rest, and dots from end to end
  ASSERT_EQ(space.space.size(), 4u);
  for (const Vec3& p : space.space.front().points)
    EXPECT_NEAR(p.tail<2>().norm(), 0, 1.5e-3);
  const std::vector<Vec3>& dots = space.space.back().points;
  ASSERT_GT(dots.size(), 10u);
  EXPECT_NEAR(dots.front().x(), 0, 0.1);
  EXPECT_NEAR(dots.back().x(), 1000, 0.1);
  for (const Vec3& p : dots)
    expect_on_it(p, " dots");
  // every station moves between both extremes
  const DrawnSpaceCurve* orbits = space.space_curve("orbits of the stations");
  ASSERT_TRUE(orbits) << m.figure;
  for (const Vec3& dot : dots) {
    double least = 1, most = -1;
    for (const Vec3& p : orbits->points)
      if (std::abs(p.x() - dot.x()) < 1) {
        least = std::min(least, p[m.axis]);
        most = std::max(most, p[m.axis]);
        EXPECT_NEAR(p[other], 0, 1.5e-3);
      }
    const double reach = m.shape(dot.x() / 1e3);
    EXPECT_NEAR(most, std::abs(reach), 5e-3) << m.figure;
    EXPECT_NEAR(least, -std::abs(reach), 5e-3) << m.figure;
  }
}

}  // namespace

TEST(DrawnShapes, OfOneShaftAreItsModes) {
  const DeckRun run(std::string(slender) + R"([shaft]
name = "rotor"
material = "m"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 400, 10], ["right", 600, 10]]
[[bearing]]
name = "A"
at = "left:start"
type = "rigid"
directions = ["x", "y", "z", "ry"]
[[bearing]]
name = "B"
at = "right:end"
type = "rigid"
directions = ["y", "z", "ry"]
[[step]]
name = "m"
type = "modal"
modes = 3
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const LateralMode modes[] = {
      {"m_mode_1", 1, pinned},
      {"m_mode_2", 2, held},
      {"m_mode_3", 1, [](double x) { return std::sin(2 * pi * x); }},
  };
  for (const LateralMode& m : modes) {
    const DrawnAxes space = axes_of(run, m.figure, 0), planes = axes_of(run, m.figure, 1);
    expect_in_space(space, m);
    EXPECT_EQ(planes.x_title, "axial position [mm]");
    EXPECT_EQ(planes.y_title, "deflection, largest = 1");
    const DrawnSpaceCurve* line = space.space_curve("deflected shaft");
    ASSERT_TRUE(line);
    const double sign = moment_of(*line, m.axis);
    expect_curve(planes, "y", 0, 1000, m.axis == 1 ? m.shape : none, sign, m.figure);
    expect_curve(planes, "z", 0, 1000, m.axis == 2 ? m.shape : none, sign, m.figure);
    expect_curve(
        planes, "largest radius", 0, 1000, [&](double x) { return std::abs(m.shape(x)); }, 1,
        m.figure);
  }
}

namespace {

/// Two shafts, one a cantilever beside the other, and a soft spring that joins them.
const std::string two_lines = std::string(slender) + R"([[shaft]]
name = "inner"
material = "m"
shear = "none"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["i", 500, 10], ["i2", 500, 10]]
[[shaft]]
name = "outer"
origin = ["250 mm", "200 mm", "30 mm"]
material = "m"
shear = "none"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["o", 400, 10], ["o2", 400, 10]]
[[bearing]]
name = "A"
at = "i:start"
type = "rigid"
directions = ["x", "y", "z", "ry"]
[[bearing]]
name = "B"
at = "i2:end"
type = "rigid"
directions = ["y", "z", "ry"]
[[bearing]]
name = "C"
at = "o:start"
type = "rigid"
directions = ["x", "y", "z", "ry", "rz"]
[[bearing]]
name = "D"
at = "o2:end"
type = "rigid"
directions = ["z"]
[[bearing]]
name = "joins"
at = "o:end"
to = "i:end"
type = "linear"
kyy = "1e-3 N/m"
kzz = "1e-3 N/m"
)";

}  // namespace

// The largest motion is drawn as 14 % of the machine's length.
TEST(DrawnShapes, OfTwoShaftsStandAtTheirPlaces) {
  const DeckRun run(two_lines + "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 2\n");
  ASSERT_EQ(run.exit, 0) << run.log;
  const double drawn = 0.14 * 1050;
  for (const bool first : {true, false}) {  // the cantilever, the pinned shaft
    const std::string figure = first ? "m_mode_1" : "m_mode_2";
    const DrawnAxes space = axes_of(run, figure, 0), planes = axes_of(run, figure, 1);
    EXPECT_EQ(space.x_title, "x [mm]");
    EXPECT_EQ(space.y_title, "y, deflection without scale [mm]");
    const DrawnSpaceCurve *inner = space.space_curve("inner"), *outer = space.space_curve("outer");
    ASSERT_TRUE(inner && outer);
    const auto u = [&](bool of_outer, double x) {
      return of_outer ? first ? cantilever(x) : 0.0 : first ? 0.0 : pinned(x);
    };
    const double at_tip =
        first ? outer->points.back().y() - 200 : inner->points[inner->points.size() / 2].y();
    const double sign = at_tip > 0 ? 1 : -1;
    for (const Vec3& p : inner->points) {
      EXPECT_NEAR(p.y(), sign * drawn * u(false, p.x() / 1000), 0.4) << figure;
      EXPECT_NEAR(p.z(), 0, 0.2) << figure;
    }
    for (const Vec3& p : outer->points) {
      EXPECT_NEAR(p.y(), 200 + sign * drawn * u(true, (p.x() - 250) / 800), 0.4) << figure;
      EXPECT_NEAR(p.z(), 30, 0.2) << figure;
    }
    EXPECT_NEAR(inner->points.front().x(), 0, 0.1);
    EXPECT_NEAR(inner->points.back().x(), 1000, 0.1);
    EXPECT_NEAR(outer->points.front().x(), 250, 0.1);
    EXPECT_NEAR(outer->points.back().x(), 1050, 0.1);
    // the spring from where one shaft is to where the other is
    const DrawnSpaceCurve* link = space.space_curve("supports");
    ASSERT_TRUE(link);
    ASSERT_GE(link->points.size(), 2u);
    const Vec3 from(650, 200 + sign * drawn * u(true, 0.5), 30),
        to(500, sign * drawn * u(false, 0.5), 0);
    EXPECT_NEAR((link->points[0] - from).norm(), 0, 0.4) << figure;
    EXPECT_NEAR((link->points[1] - to).norm(), 0, 0.4) << figure;
    // lines at rest, one after the other
    for (const Vec3& p : space.space.front().points)
      EXPECT_TRUE(std::isnan(p.x()) || p.tail<2>().norm() < 0.2 ||
                  (p.tail<2>() - Vec2(200, 30)).norm() < 0.2);
    EXPECT_EQ(planes.x_title, "x [mm]");
    EXPECT_EQ(planes.y_title, "deflection, largest = 1");
    expect_curve(
        planes, "inner, y", 0, 1000, [&](double x) { return u(false, x); }, sign, figure);
    expect_curve(
        planes, "outer, y", 250, 1050, [&](double x) { return u(true, x); }, sign, figure);
    expect_curve(planes, "inner, z", 0, 1000, none, 1, figure);
    expect_curve(planes, "outer, z", 250, 1050, none, 1, figure);
  }
}

// Quarter waves of a bar held at its left end; the largest is drawn as 1, of the second at the free end or,
// where a node stands there, at a third of the length from it.
TEST(DrawnShapes, AlongTheShaftAreWavesOfABar) {
  const std::string bar = std::string(slender) + R"([shaft]
name = "rotor"
material = "m"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 1000, 50], ["right", 1000, 50]]
[[bearing]]
name = "A"
at = "left:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[step]]
name = "t"
type = "modal"
modes = 2
motion = "torsional"
[[step]]
name = "a"
type = "modal"
modes = 2
motion = "axial"
)";
  const DeckRun run(bar);
  ASSERT_EQ(run.exit, 0) << run.log;
  for (const auto& [step, title] :
       {std::pair{"t", "twist, largest = 1"}, {"a", "axial motion, largest = 1"}})
    for (const int k : {1, 2}) {
      const std::string figure = std::string(step) + "_mode_" + std::to_string(k);
      const DrawnAxes a = axes_of(run, figure, 0);
      EXPECT_EQ(a.x_title, "axial position [m]") << figure;
      EXPECT_EQ(a.y_title, title) << figure;
      const double waves = (2 * k - 1) * pi / 2;
      ASSERT_EQ(a.curves.size(), 1u) << figure;
      const auto apart = [&](double sign) {
        const std::vector<Pixel> line = line_of(
            a, 0, 2, [&](double x) { return sign * std::sin(waves * x); }, 1);
        return test::farthest(a.curves[0].points, line);
      };
      EXPECT_LT(k == 1 ? apart(1) : std::min(apart(1), apart(-1)), 1.5) << figure;
    }
}

// A rigid shaft goes round as one: a circle of 12.286 um at 1000 rpm, m_u w^2/|k - m w^2 + i c w|.
TEST(DrawnShapes, OfAResponseAreItsCircles) {
  const DeckRun run(test::lateral_mass(10, "0 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
[[unbalance]]
at = "mass"
amount = "1000 g.mm"
[[probe]]
name = "P"
at = "mass"
[output]
report = true
[[step]]
name = "u"
type = "unbalance_response"
speed = { start = "1000 rpm", stop = "1400 rpm", points = 3 }
shapes_at = ["1000 rpm"]
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const DrawnAxes space = axes_of(run, "u_shape_1000rpm", 0),
                  planes = axes_of(run, "u_shape_1000rpm", 1);
  EXPECT_EQ(space.y_title, "deflection y, 1 = 12.3 µm");
  EXPECT_EQ(planes.y_title, "deflection, 1 = 12.3 µm");
  const DrawnSpaceCurve* line = space.space_curve("deflected shaft");
  ASSERT_TRUE(line);
  const Vec3 at = line->points.front();
  EXPECT_NEAR(at.tail<2>().norm(), 1, 1e-3);
  for (const Vec3& p : line->points)
    EXPECT_NEAR((p - at).tail<2>().norm(), 0, 1e-3);
  const DrawnSpaceCurve* orbits = space.space_curve("orbits of the stations");
  ASSERT_TRUE(orbits);
  for (const Vec3& p : orbits->points)
    EXPECT_TRUE(std::isnan(p.x()) || std::abs(p.tail<2>().norm() - 1) < 1e-3) << p.transpose();
  const auto level = [](double v) { return Shape([v](double) { return v; }); };
  expect_curve(planes, "y", 0, 200, level(at.y()), 1, "response");
  expect_curve(planes, "z", 0, 200, level(at.z()), 1, "response");
  expect_curve(planes, "largest radius", 0, 200, level(1), 1, "response");
}
