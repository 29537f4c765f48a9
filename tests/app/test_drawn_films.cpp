// Pictures of films, pads and floating rings, read back from their files: against the tables of the
// same run and, of a round bearing, the film that its place leaves.
#include "deck_run.hpp"
#include "drawn.hpp"
#include "lateral_mass.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace {

using namespace whirl;
using test::Columns;
using test::DeckRun;
using test::DrawnAxes;
using test::DrawnCurve;
using test::Pixel;
using Values = std::vector<double>;

/// A hot bearing of four pads and a grooved one, 10 kN each.
const char* const two_bearings = R"deck(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "rigid"]
rows = [["a", 500, 100, true], ["b", 500, 100, true]]
[[bearing]]
name = "thrust"
at = "a:start"
type = "linear"
kxx = "10 MN/m"
cxx = "1e4 N.s/m"
[[load]]
at = "a:end"
force = ["0 N", "0 N", "-20 kN"]
[[bearing]]
name = "pads"
at = "a:start"
type = "tilting_pad"
diameter = "100 mm"
length = "70 mm"
clearance = "78.4 um"
pads = 4
first_pivot = "-135 deg"
arc = "75 deg"
preload = 0.47
thickness = "20 mm"
viscosity = "27.7 mPa.s"
temperature = "40 degC"
thinning = "0.0341 1/K"
density = "860 kg/m^3"
[bearing.heat]
supply_temperature = "40 degC"
specific_heat = "1951.8 J/(kg.K)"
conductivity = "0.149 W/(m.K)"
[[bearing]]
name = "grooved"
at = "b:end"
type = "journal"
diameter = "100 mm"
length = "60 mm"
clearance = "75 um"
shape = "two_grooves"
viscosity = "20 mPa.s"
[[step]]
name = "st"
type = "static"
speed = "4000 rpm"
[[step]]
name = "sp"
type = "static"
speeds = { start = "3000 rpm", stop = "5000 rpm", points = 3 }
[output]
report = true
)deck";

constexpr double pixels = 1.2;

std::vector<DrawnAxes> picture(const DeckRun& run, const std::string& name) {
  return test::drawn(run.folder / "r" / "plots" / (name + ".svg"));
}

/// Of the table of films: pad 0 is all of a bearing.
double film(const DeckRun& run, int bearing, int pad, const char* column) {
  const Columns t = run.csv("st_films.csv");
  int at = 0;
  for (const auto& row : t.rows) {
    if (row[t.column("pad [-]")] == pad && at == bearing) return row[t.column(column)];
    at += row[t.column("pad [-]")] == 0;  // the last of its bearing
  }
  return std::nan("");
}

/// Degrees within the limits of an upright picture.
double within(const DrawnAxes& a, double degrees) {
  if (a.kind == "polar") return degrees;
  while (degrees > a.x[1])
    degrees -= 360;
  while (degrees < a.x[0])
    degrees += 360;
  return degrees;
}

/// Some point of the curve is there; none lies higher (`side` 1) or lower (-1).
void expect_extreme(const DrawnAxes& a, const char* name, double degrees, double value, int side) {
  const DrawnCurve* c = a.curve(name);
  ASSERT_TRUE(c) << name;
  const auto at = [&](double x, double y) {
    return c->right ? a.place_right(x, y) : a.place(x, y);
  };
  const Pixel there = at(within(a, degrees), value), origin = at(0, 0);
  double nearest = infinity, most = -infinity;
  const auto height = [&](const Pixel& p) {
    return a.kind == "polar" ? std::hypot(p.x - origin.x, p.y - origin.y) : origin.y - p.y;
  };
  for (const Pixel& p : c->points) {
    nearest = std::min(nearest, std::hypot(p.x - there.x, p.y - there.y));
    most = std::max(most, side * height(p));
  }
  EXPECT_LT(nearest, 3.0) << name << " at " << degrees;  // points stand some px apart
  EXPECT_LT(std::abs(most - side * height(there)), pixels) << name << " at " << degrees;
}

/// Axes of one row, none over another.
void expect_in_a_row(const std::vector<DrawnAxes>& all) {
  for (std::size_t k = 1; k < all.size(); ++k) {
    const auto &left = all[k - 1].box, &right = all[k].box;
    EXPECT_GT(right[0], left[0] + left[2]);
    EXPECT_LT(std::abs(right[1] + right[3] / 2 - left[1] - left[3] / 2), 30);
  }
}

}  // namespace

TEST(DrawnFilms, StandWhereTheTableHasThem) {
  const DeckRun run(two_bearings);
  ASSERT_EQ(run.exit, 0) << run.log;
  for (const int bearing : {0, 1}) {
    const std::string name = "st_films_" + std::to_string(bearing + 1);
    const auto along = picture(run, name), round = picture(run, name + "_round");
    ASSERT_EQ(along.size(), bearing == 0 ? 2u : 1u);
    ASSERT_EQ(round.size(), bearing == 0 ? 3u : 2u);
    EXPECT_EQ(along[0].x_title + ", " + along[0].y_title + ", " + along[0].right_title,
              "angle [deg], pressure [MPa], film thickness [µm]");
    EXPECT_EQ(round[0].y_title + ", " + round[1].y_title, "pressure [MPa], film thickness [µm]");
    expect_in_a_row(round);
    const auto of = [&](const char* column) { return film(run, bearing, 0, column); };
    for (const DrawnAxes* a : {&along[0], &round[0]})
      expect_extreme(*a, "pressure", of("angle of largest pressure [deg]"),
                     1e-6 * of("largest pressure [Pa]"), 1);
    for (const DrawnAxes* a : {&along[0], &round[1]})
      expect_extreme(*a, "film thickness", of("angle of smallest film [deg]"),
                     1e6 * of("smallest film [m]"), -1);
    if (bearing == 1) continue;
    EXPECT_EQ(along[1].y_title, "temperature [degC]");
    EXPECT_EQ(round[2].y_title, "temperature [degC]");
    for (const DrawnAxes* a : {&along[1], &round[2]})
      expect_extreme(*a, "face of the pad", of("angle of hottest face [deg]"),
                     of("hottest face [degC]"), 1);
  }
}

// c - y cos a - z sin a, round all of the bearing but its grooves.
TEST(DrawnFilms, OfARoundBearingAreWhatItsPlaceLeaves) {
  const DeckRun run(two_bearings);
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns places = run.csv("st_coefficients.csv");
  const auto& row = places.rows.back();
  const double y = row[places.column("y [m]")], z = row[places.column("z [m]")];
  ASSERT_GT(std::hypot(y, z), 10e-6);
  const auto along = picture(run, "st_films_2"), round = picture(run, "st_films_2_round");
  for (const DrawnAxes* a : {&along.at(0), &round.at(1)}) {
    const DrawnCurve* c = a->curve("film thickness");
    ASSERT_TRUE(c);
    std::vector<Pixel> line;
    for (int k = 0; k <= 720; ++k) {
      const double degrees = k / 2.0, angle = degrees * pi / 180,
                   um = 1e6 * (75e-6 - y * std::cos(angle) - z * std::sin(angle));
      line.push_back(c->right ? a->place_right(degrees, um) : a->place(degrees, um));
    }
    EXPECT_LT(test::farthest(c->points, line), pixels);
    EXPECT_GT(c->points.size(), 20u);
  }
}

TEST(DrawnFilms, AgainstSpeedAreTheSumsOfTheTable) {
  const DeckRun run(two_bearings);
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns t = run.csv("sp_films.csv");
  const auto all = picture(run, "sp_film_trends");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].y_title + ", " + all[0].right_title, "power loss [kW], side flow [L/min]");
  EXPECT_EQ(all[1].y_title, "hottest face of a pad [degC]");
  const auto cells = [&](int bearing, const char* column) {
    Values out;
    int at = 0;
    for (const auto& row : t.rows)
      if (row[t.column("pad [-]")] == 0 && at++ % 2 == bearing)
        out.push_back(row[t.column(column)]);
    return out;
  };
  const auto expect_line = [&](const DrawnAxes& a, const std::string& name, int bearing,
                               const char* column, double factor) {
    const DrawnCurve* c = a.curve(name);
    ASSERT_TRUE(c) << name;
    const Values x = cells(bearing, "speed [rpm]"), y = cells(bearing, column);
    ASSERT_EQ(x.size(), 3u);
    std::vector<Pixel> line;
    for (std::size_t k = 0; k < 3; ++k)
      line.push_back(c->right ? a.place_right(x[k], factor * y[k]) : a.place(x[k], factor * y[k]));
    EXPECT_LT(test::farthest(c->points, line), pixels) << name;
    EXPECT_LT(test::farthest(line, c->points), pixels) << name;
  };
  for (const int bearing : {0, 1}) {
    const std::string name = bearing == 0 ? "pads" : "grooved";
    expect_line(all[0], name + ", loss", bearing, "power loss [W]", 1e-3);
    expect_line(all[0], name + ", side flow", bearing, "side flow [m^3/s]", 6e4);
  }
  expect_line(all[1], "pads", 0, "hottest face [degC]", 1);
}

namespace {

/// The circle through a curve's points: centre and radius, in the units of the axes.
Vec3 circle_of(const DrawnAxes& a, const DrawnCurve& c) {
  double x = 0, y = 0, r = 0;
  const auto n = static_cast<double>(c.points.size() - 1);  // the last is the first again
  for (std::size_t k = 0; k + 1 < c.points.size(); ++k) {
    x += c.points[k].x / n;
    y += c.points[k].y / n;
  }
  for (std::size_t k = 0; k + 1 < c.points.size(); ++k)
    r += std::hypot(c.points[k].x - x, c.points[k].y - y) / n;
  const double unit = a.box[2] / (a.x[1] - a.x[0]);
  const Pixel origin = a.place(0, 0);
  return {(x - origin.x) / unit, (origin.y - y) / unit, r / unit};
}

}  // namespace

// Places within clearances are to scale among each other, and the clearances too.
TEST(DrawnFilms, AFloatingRingStandsWhereTheTableHasIt) {
  const DeckRun run(test::lateral_mass(5, "9.81 m/s^2", R"([[bearing]]
name = "J"
at = "mass"
type = "floating_ring"
film = "short"
inner = { diameter = "20 mm", length = "10 mm", clearance = "30 um", viscosity = "10 mPa.s" }
outer = { diameter = "30 mm", length = "12 mm", clearance = "50 um", viscosity = "15 mPa.s" }
[[step]]
name = "st"
type = "static"
speed = "20000 rpm"
[output]
report = true
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const auto ring_of = run.csv("st_rings.csv").last(),
             place = run.csv("st_coefficients.csv").last();
  std::vector<DrawnAxes> all;
  for (const auto& e : std::filesystem::directory_iterator(run.folder / "r" / "plots"))
    for (const DrawnAxes& a : test::drawn(e.path()))
      if (a.curve("housing")) all.push_back(a);
  ASSERT_EQ(all.size(), 1u);
  const DrawnAxes& a = all[0];
  EXPECT_EQ(a.x_title + ", " + a.y_title, "y / radius of the journal, z / radius of the journal");
  const DrawnCurve *journal = a.curve("journal"), *bore = a.curve("ring"),
                   *housing = a.curve("housing"), *outside = a.curve("");
  ASSERT_TRUE(journal && bore && housing && outside);
  const Vec3 j = circle_of(a, *journal), b = circle_of(a, *bore), o = circle_of(a, *outside),
             h = circle_of(a, *housing);
  const double near = 0.01;
  EXPECT_NEAR(j.z(), 1, near);
  const double inner = b.z() - j.z(), outer = h.z() - o.z(), scale = inner / 30e-6;
  EXPECT_NEAR(outer, scale * 50e-6, near);
  EXPECT_NEAR(h.head<2>().norm(), 0, near);
  EXPECT_NEAR(b.x(), scale * ring_of.at("ring y [m]"), near);
  EXPECT_NEAR(b.y(), scale * ring_of.at("ring z [m]"), near);
  EXPECT_NEAR((o - b).head<2>().norm(), 0, near);
  EXPECT_NEAR((j - b).head<2>().norm(), inner * ring_of.at("inner eccentricity [-]"), near);
  EXPECT_NEAR(j.x(), scale * place.at("y [m]"), near);
  EXPECT_NEAR(j.y(), scale * place.at("z [m]"), near);
}
