// Curves of figures, read back from their files, against the tables of the same run (which
// test_written_numbers.cpp holds against closed forms), with titles and units, and that no picture is
// missing: of a transient, static steps, campbell, stability, critical_map and the two responses.
// Shapes have test_drawn_shapes.cpp; space curves and the replay are not read here.
#include "deck_run.hpp"
#include "drawn.hpp"
#include "lateral_mass.hpp"
#include "wheel_on_bearings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <numeric>
#include <set>
#include <utility>

namespace {

using namespace whirl;
using test::Columns;
using test::DeckRun;
using test::DrawnAxes;
using test::DrawnCurve;
using test::Pixel;
using Values = std::vector<double>;
namespace fs = std::filesystem;

const std::string tracking = "t_tracking.csv";

/// A sum of columns with factors.
using Terms = std::vector<std::pair<const char*, double>>;

enum class Rows { all, rising, falling };  ///< of the speed

struct Shown {
  const char* figure;
  std::size_t axes;
  const char* curve;
  std::string table;
  const char* x_title;
  Terms x;
  const char* y_title;
  Terms y;
  Rows rows = Rows::all;
};

// What a figure may differ: rounding of the file, extremes kept of each column of pixels.
constexpr double pixels = 1.2;

Values values_of(const Columns& table, const Terms& terms) {
  Values sum(table.rows.size(), 0.0);
  for (const auto& [name, factor] : terms) {
    const std::size_t c = table.column(name);
    for (std::size_t r = 0; r < sum.size(); ++r)
      sum[r] += factor * table.rows[r][c];
  }
  return sum;
}

/// Of whole turns, both ends of which are there.
Values about_mean(Values v) {
  const double mean =
      std::accumulate(v.begin(), v.end() - 1, 0.0) / static_cast<double>(v.size() - 1);
  for (double& x : v)
    x -= mean;
  return v;
}

/// Angles in degrees without leaps of whole turns.
Values unwrapped(Values angle) {
  for (std::size_t i = 1; i < angle.size(); ++i)
    angle[i] = angle[i - 1] + std::remainder(angle[i] - angle[i - 1], 360.0);
  return angle;
}

/// [from, to) of the rows, up to the highest speed or from it on.
std::pair<std::size_t, std::size_t> range_of(const Columns& table, Rows rows) {
  if (rows == Rows::all) return {0, table.rows.size()};
  const Values rpm = values_of(table, {{"speed [rpm]", 1}});
  const auto top = static_cast<std::size_t>(std::max_element(rpm.begin(), rpm.end()) - rpm.begin());
  if (rows == Rows::rising) return {0, top + 1};
  return {top, table.rows.size()};
}

std::vector<Pixel> line_of(const DrawnAxes& axes, const Values& x, const Values& y,
                           std::pair<std::size_t, std::size_t> range, bool right = false) {
  std::vector<Pixel> out;
  for (std::size_t r = range.first; r < range.second; ++r)
    if (std::isfinite(x[r]) && std::isfinite(y[r]))
      out.push_back(right ? axes.place_right(x[r], y[r]) : axes.place(x[r], y[r]));
  return out;
}

/// The curve is the line, from end to end. between: how far it may bulge between the points of the line.
void expect_line(const DrawnCurve& curve, const std::vector<Pixel>& line, const std::string& where,
                 double between = pixels) {
  ASSERT_GE(line.size(), 2u) << where;
  EXPECT_LT(test::farthest(curve.points, line), between) << where;
  EXPECT_LT(test::farthest(line, curve.points), pixels) << where;
}

void expect_shown(const DeckRun& run, const Shown& s) {
  const std::string where = std::string(s.figure) + " " + std::to_string(s.axes) + " " + s.curve;
  const auto axes = test::drawn(run.folder / "r" / "plots" / (std::string(s.figure) + ".svg"));
  ASSERT_LT(s.axes, axes.size()) << where;
  const DrawnAxes& a = axes[s.axes];
  EXPECT_EQ(a.x_title, s.x_title) << where;
  const DrawnCurve* curve = a.curve(s.curve);
  ASSERT_TRUE(curve) << where;
  EXPECT_EQ(curve->right ? a.right_title : a.y_title, s.y_title) << where;
  const Columns table = run.csv(s.table);
  // a response is continued without leaps of whole turns; turns that follow each other are not
  const bool angle = a.y_title == "phase lag [°]" && s.table != tracking;
  const Values x = values_of(table, s.x), y = values_of(table, s.y);
  expect_line(*curve,
              line_of(a, x, angle ? unwrapped(y) : y, range_of(table, s.rows), curve->right), where,
              a.kind == "polar" ? 10.0 : pixels);  // vectors far apart are joined by a smooth curve
}

/// Names of the figures in a folder of results that begin so.
std::set<std::string> figures_in(const DeckRun& run, const std::string& begin) {
  std::set<std::string> out;
  for (const fs::directory_entry& e : fs::directory_iterator(run.folder / "r" / "plots")) {
    const std::string name = e.path().stem().string();
    if (name.starts_with(begin)) out.insert(name);
  }
  return out;
}

/// A mass of 10 kg on springs, with its weight and an unbalance, driven up and down past 3020 rpm.
const char* const run_up = R"(format = 1
[model]
gravity = "9.81 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 100, true], ["right", 100, true]]
[[disk]]
name = "mass"
at = "left:end"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
name = "guide"
at = "mass"
type = "rigid"
directions = ["x"]
[[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1.2e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
kryy = "1e4 N.m/rad"
krzz = "1e4 N.m/rad"
[[unbalance]]
at = "left:start"
amount = "10 kg.mm"
[[probe]]
name = "P"
at = "mass"
[output]
every = "0.4 ms"
report = true
quantities = ["speed", "probes", "positions", "velocity", "rotation", "bearing_force",
              "bearing_moment", "torque", "energy"]
[[drive]]
at = "rotor/0 mm"
type = "speed"
speed = { type = "ramp", time = ["0 s", "0.4 s", "0.6 s"], value = ["300 rpm", "4000 rpm", "1500 rpm"] }
[[step]]
name = "t"
type = "transient"
duration = "0.6 s"
)";

constexpr double Omega0 = 10 * pi;  // rad/s: at the start

const char* const t = "t.csv";
const Terms time_s{{"t [s]", 1}}, speed_rpm{{"speed [rpm]", 1}};

const Shown histories[] = {
    {"t_speed", 0, "speed", t, "time [s]", time_s, "spin [rpm]", speed_rpm},
    {"t_P_history", 0, "", t, "time [s]", time_s, "displacement y [mm]", {{"P.y [m]", 1e3}}},
    {"t_P_history", 1, "", t, "time [s]", time_s, "displacement z [mm]", {{"P.z [m]", 1e3}}},
    {"t_P_yz",
     0,
     "",
     t,
     "y [mm]",
     {{"P position.y [m]", 1e3}},
     "z [mm]",
     {{"P position.z [m]", 1e3}}},
    {"t_P_gamma",
     0,
     "gamma_y",
     t,
     "time [s]",
     time_s,
     "transverse Euler vector [rad]",
     {{"P gamma.2 [rad]", 1}}},
    {"t_P_gamma",
     0,
     "gamma_z",
     t,
     "time [s]",
     time_s,
     "transverse Euler vector [rad]",
     {{"P gamma.3 [rad]", 1}}},
    {"t_P_phi", 0, "", t, "time [s]", time_s, "phi [rad]", {{"P phi [rad]", 1}}},
    {"t_P_phi",
     1,
     "",
     t,
     "time [s]",
     time_s,
     "phi - Omega0 t [rad]",
     {{"P phi [rad]", 1}, {"t [s]", -Omega0}}},
    {"t_bearing_spring_force",
     0,
     "y",
     t,
     "time [s]",
     time_s,
     "force on the shaft [N]",
     {{"bearing spring force.y [N]", 1}}},
    {"t_bearing_spring_force",
     0,
     "z",
     t,
     "time [s]",
     time_s,
     "force on the shaft [N]",
     {{"bearing spring force.z [N]", 1}}},
    {"t_bearing_spring_moment",
     0,
     "y",
     t,
     "time [s]",
     time_s,
     "moment on the shaft (x: torque) [N·m]",
     {{"bearing spring moment.y [N.m]", 1}}},
    {"t_bearing_spring_moment",
     0,
     "z",
     t,
     "time [s]",
     time_s,
     "moment on the shaft (x: torque) [N·m]",
     {{"bearing spring moment.z [N.m]", 1}}},
    {"t_drive_drive_1_torque",
     0,
     "",
     t,
     "time [s]",
     time_s,
     "torque on the shaft [N·m]",
     {{"drive drive 1 torque [N.m]", 1}}},
    {"t_torque_angle",
     0,
     "drive drive 1 torque",
     t,
     "angle of the reference shaft [turns]",
     {{"phi [rad]", 1 / two_pi}},
     "torque [N·m]",
     {{"drive drive 1 torque [N.m]", 1}}},
    {"t_energy", 0, "kinetic", t, "time [s]", time_s, "energy [J]", {{"energy.kinetic [J]", 1}}},
    {"t_energy", 0, "elastic", t, "time [s]", time_s, "energy [J]", {{"energy.elastic [J]", 1}}},
    {"t_energy", 0, "gravity", t, "time [s]", time_s, "energy [J]", {{"energy.gravity [J]", 1}}},
    {"t_energy",
     0,
     "sum",
     t,
     "time [s]",
     time_s,
     "energy [J]",
     {{"energy.kinetic [J]", 1}, {"energy.elastic [J]", 1}, {"energy.gravity [J]", 1}}},
    {"t_P_bode",
     0,
     "y rising",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.y 1X [m]", 1e3}},
     Rows::rising},
    {"t_P_bode",
     0,
     "y falling",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.y 1X [m]", 1e3}},
     Rows::falling},
    {"t_P_bode",
     0,
     "z rising",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.z 1X [m]", 1e3}},
     Rows::rising},
    {"t_P_bode",
     0,
     "z falling",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.z 1X [m]", 1e3}},
     Rows::falling},
    {"t_P_bode",
     1,
     "y rising",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "phase lag [°]",
     {{"P.y 1X lag [deg]", 1}},
     Rows::rising},
    {"t_P_bode",
     1,
     "y falling",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "phase lag [°]",
     {{"P.y 1X lag [deg]", 1}},
     Rows::falling},
    {"t_P_envelope",
     0,
     "y rising",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.y envelope [m]", 1e3}},
     Rows::rising},
    {"t_P_envelope",
     0,
     "z falling",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.z envelope [m]", 1e3}},
     Rows::falling},
    {"t_P_orders",
     0,
     "y 1X",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.y 1X [m]", 1e3}}},
    {"t_P_orders",
     0,
     "z 1X",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.z 1X [m]", 1e3}}},
    {"t_P_orders",
     0,
     "y 2X",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.y 2X [m]", 1e3}}},
    {"t_P_orders",
     0,
     "z 2X",
     tracking,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [mm]",
     {{"P.z 2X [m]", 1e3}}},
    {"t_P_polar",
     0,
     "y rising",
     tracking,
     "phase lag clockwise [°]",
     {{"P.y 1X lag [deg]", 1}},
     "amplitude, 0-peak [mm]",
     {{"P.y 1X [m]", 1e3}},
     Rows::rising},
    {"t_P_polar",
     0,
     "z falling",
     tracking,
     "phase lag clockwise [°]",
     {{"P.z 1X lag [deg]", 1}},
     "amplitude, 0-peak [mm]",
     {{"P.z 1X [m]", 1e3}},
     Rows::falling},
    {"t_bearing_guide_force",
     0,
     "x",
     t,
     "time [s]",
     time_s,
     "force on the shaft [N]",
     {{"bearing guide force.x [N]", 1}}},
};

/// Drawn by no row above: what is known of them stands in the test.
const std::set<std::string> apart{"t_P_amplitude", "t_P_turns", "t_P_omega_phi",
                                  "t_P_orbit",     "t_P_space", "t_replay"};

}  // namespace

/// Distances from the mean of four turns under a Hann window, those about a row or the nearest to it, by
/// 4,000 places on the straight lines between the rows.
Values about_the_centre(const Values& y, const Values& z, const Values& phi) {
  const auto mean = [&](const Values& u, double middle) {
    constexpr int places = 4000;
    double sum = 0, weights = 0;
    for (int k = 0; k < places; ++k) {
      const double x = 2.0 * (k + 0.5) / places - 1.0, angle = middle + 2.0 * two_pi * x;
      const auto after = std::lower_bound(phi.begin() + 1, phi.end() - 1, angle);
      const auto r = static_cast<std::size_t>(after - phi.begin());
      const double share = (angle - phi[r - 1]) / (phi[r] - phi[r - 1]);
      const double weight = std::pow(std::cos(0.5 * pi * x), 2);
      sum += weight * (u[r - 1] + share * (u[r] - u[r - 1]));
      weights += weight;
    }
    return sum / weights;
  };
  Values radius(y.size());
  for (std::size_t r = 0; r < y.size(); ++r) {
    const double middle = std::clamp(phi[r], phi.front() + 2 * two_pi, phi.back() - 2 * two_pi);
    radius[r] = std::hypot(y[r] - mean(y, middle), z[r] - mean(z, middle));
  }
  return radius;
}

/// The largest peak-to-peak of any direction in two turns from any row on.
double widest_in_two_turns(const Values& y, const Values& z, const Values& phi) {
  double widest = 0;
  for (int k = 0; k < 60; ++k) {
    const double c = std::cos(pi * k / 60), s = std::sin(pi * k / 60);
    for (std::size_t first = 0; first < y.size(); ++first) {
      double low = infinity, high = -infinity;
      for (std::size_t r = first; r < y.size() && phi[r] <= phi[first] + 2 * two_pi; ++r) {
        low = std::min(low, c * y[r] + s * z[r]);
        high = std::max(high, c * y[r] + s * z[r]);
      }
      widest = std::max(widest, high - low);
    }
  }
  return widest;
}

TEST(DrawnNumbers, OfATransientAreThoseOfItsTables) {
  const DeckRun run(run_up);
  ASSERT_EQ(run.exit, 0) << run.log;
  std::set<std::string> known = apart;
  for (const Shown& s : histories) {
    expect_shown(run, s);
    known.insert(s.figure);
  }
  EXPECT_EQ(figures_in(run, "t_"), known);  // none is missing, none is new
  const Columns rows = run.csv(t);
  const Values rpm = values_of(rows, speed_rpm), y = values_of(rows, {{"P.y [m]", 1e3}}),
               z = values_of(rows, {{"P.z [m]", 1e3}}), phi = values_of(rows, {{"phi [rad]", 1}});
  // about the orbit's centre, up and down apart
  const Values radius = about_the_centre(y, z, phi);
  const DrawnAxes amplitude = test::drawn(run.folder / "r/plots/t_P_amplitude.svg").at(0);
  EXPECT_EQ(amplitude.y_title, "radius about the orbit's centre, 0-peak [mm]");
  for (const Rows part : {Rows::rising, Rows::falling}) {
    const DrawnCurve* c = amplitude.curve(part == Rows::rising ? "speed rising" : "speed falling");
    ASSERT_TRUE(c);
    auto [from, to] = range_of(rows, part);
    from += from > 0;  // the turning point stands on one side
    expect_line(*c, line_of(amplitude, rpm, radius, {from, to}), c->name);
  }
  // the peak of the summary, at the speed that the drive has then
  const io::Value peak = run.summary("t").at("peaks").at("P");
  const double when = peak.at("time [s]").number(),
               wanted = when < 0.4 ? 300 + 3700 * when / 0.4 : 4000 - 2500 * (when - 0.4) / 0.2;
  EXPECT_NEAR(peak.at("speed [rpm]").number(), wanted, 2e-4 * wanted);  // between two steps
  const double width = widest_in_two_turns(y, z, phi);
  EXPECT_NEAR(1e3 * peak.at("motion 0-peak [m]").number(), 0.5 * width, 0.005 * width);
  // ten turns about the largest radius
  const auto largest =
      static_cast<std::size_t>(std::max_element(radius.begin(), radius.end()) - radius.begin());
  std::size_t from = largest, to = largest;
  while (from > 0 && phi[from - 1] >= phi[largest] - 10 * pi)
    --from;
  while (to < phi.size() && phi[to] <= phi[largest] + 10 * pi)
    ++to;
  const DrawnAxes turns = test::drawn(run.folder / "r/plots/t_P_turns.svg").at(0);
  EXPECT_EQ(turns.x_title + " " + turns.y_title, "y [mm] z [mm]");
  expect_line(turns.curves.at(0), line_of(turns, y, z, {from, to}), "turns");
  // the largest of them, turn by turn
  const Columns orbits = run.csv("t_orbits.csv");
  const DrawnAxes orbit = test::drawn(run.folder / "r/plots/t_P_orbit.svg").at(0);
  EXPECT_EQ(orbit.x_title + " " + orbit.y_title, "y displacement [mm] z displacement [mm]");
  EXPECT_EQ(orbit.curves.at(0).name, fmt::format("{:.0f} rpm", orbits.rows[0][1]));
  expect_line(orbit.curves.at(0),
              line_of(orbit, about_mean(values_of(orbits, {{"y [m]", 1e3}})),
                      about_mean(values_of(orbits, {{"z [m]", 1e3}})), {0, orbits.rows.size()}),
              "orbit");
  // less the spin at the start
  const DrawnAxes rate = test::drawn(run.folder / "r/plots/t_P_omega_phi.svg").at(0);
  EXPECT_EQ(rate.y_title, "omega_phi - Omega0 [rad/s]");
  Values omega = values_of(rows, {{"P omega_phi [rad/s]", 1}});
  for (double& w : omega)
    w -= Omega0;
  expect_line(rate.curves.at(0), line_of(rate, values_of(rows, time_s), omega, {0, omega.size()}),
              "rate");
}

namespace {

/// Each kind of analysis.
const std::string analyses = test::wheel_on_bearings(R"([[unbalance]]
at = "wheel"
amount = "3 g.mm"
[[load]]
name = "thrust"
at = "right:end"
force = ["-2 kN", "0 N", "100 N"]
moment = ["5 N.m", "0 N.m", "0 N.m"]
[[load]]
name = "brake"
at = "left:start"
moment = ["-5 N.m", "0 N.m", "0 N.m"]
[[probe]]
name = "middle"
at = "wheel"
[[step]]
name = "static"
type = "static"
[[step]]
name = "campbell"
type = "campbell"
speed = { stop = "6000 rpm", points = 5 }
[[step]]
name = "map"
type = "critical_map"
stiffness_min = "1e6 N/m"
stiffness_max = "1e9 N/m"
points = 5
max_speed = "20000 rpm"
[[step]]
name = "stability"
type = "stability"
speed = { stop = "6000 rpm", points = 4 }
[[step]]
name = "unbalance"
type = "unbalance_response"
speed = { start = "100 rpm", stop = "6000 rpm", points = 9 }
[[step]]
name = "harmonic"
type = "harmonic_response"
frequency = { start = "1 Hz", stop = "100 Hz", points = 9 }
force = [{ at = "wheel", force = ["0 N", "1 N", "0 N"], moment = ["1 N.m", "0 N.m", "0 N.m"] }]
)");

const char* const along = "position along the shaft [m]";
const char* const deflection = "static_deflection.csv";
const char* const sections = "static_sections.csv";
const char* const harmonic = "harmonic_response.csv";
const char* const unbalance = "unbalance_response.csv";
const Terms s_m{{"s [m]", 1}}, frequency_Hz{{"frequency [Hz]", 1}};

const Shown results[] = {
    {"static_deflection",
     0,
     "y",
     deflection,
     along,
     s_m,
     "lateral displacement [µm]",
     {{"u_y [m]", 1e6}}},
    {"static_deflection",
     0,
     "z",
     deflection,
     along,
     s_m,
     "lateral displacement [µm]",
     {{"u_z [m]", 1e6}}},
    {"static_deflection",
     1,
     "axial",
     deflection,
     along,
     s_m,
     "axial displacement [µm]",
     {{"u_x [m]", 1e6}}},
    {"static_deflection",
     2,
     "angle",
     deflection,
     along,
     s_m,
     "twist from the left end [rad]",
     {{"phi [rad]", 1}}},
    {"static_sections", 0, "V_y", sections, along, s_m, "shear force [N]", {{"V_y [N]", 1}}},
    {"static_sections", 0, "V_z", sections, along, s_m, "shear force [N]", {{"V_z [N]", 1}}},
    {"static_sections", 1, "M_z", sections, along, s_m, "bending moment [N·m]", {{"M_z [N m]", 1}}},
    {"static_sections", 1, "M_y", sections, along, s_m, "bending moment [N·m]", {{"M_y [N m]", 1}}},
    {"static_sections", 2, "T", sections, along, s_m, "torque [N·m]", {{"T [N m]", 1}}},
    {"static_sections", 3, "N", sections, along, s_m, "axial force [N]", {{"N [N]", 1}}},
    {"static_stress",
     0,
     "von Mises",
     sections,
     along,
     s_m,
     "stress [kPa]",
     {{"von Mises stress [Pa]", 1e-3}}},
    {"static_stress",
     0,
     "bending",
     sections,
     along,
     s_m,
     "stress [kPa]",
     {{"bending stress [Pa]", 1e-3}}},
    {"static_stress",
     0,
     "torsion",
     sections,
     along,
     s_m,
     "stress [kPa]",
     {{"torsion stress [Pa]", 1e-3}}},
    {"static_stress",
     0,
     "axial",
     sections,
     along,
     s_m,
     "stress [kPa]",
     {{"axial stress [Pa]", 1e-3}}},
    {"map_critical_map",
     0,
     "critical 1",
     "map_critical_map.csv",
     "support stiffness [N/m]",
     {{"stiffness [N/m]", 1}},
     "undamped critical speed [rpm]",
     {{"critical 1 [rpm]", 1}}},
    {"map_critical_map",
     0,
     "critical 2",
     "map_critical_map.csv",
     "support stiffness [N/m]",
     {{"stiffness [N/m]", 1}},
     "undamped critical speed [rpm]",
     {{"critical 2 [rpm]", 1}}},
    {"unbalance_middle_bode",
     0,
     "y",
     unbalance,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [µm]",
     {{"middle y amplitude [m]", 1e6}}},
    {"unbalance_middle_bode",
     0,
     "z",
     unbalance,
     "speed [rpm]",
     speed_rpm,
     "amplitude, 0-peak [µm]",
     {{"middle z amplitude [m]", 1e6}}},
    {"unbalance_middle_bode",
     1,
     "y",
     unbalance,
     "speed [rpm]",
     speed_rpm,
     "phase lag [°]",
     {{"middle y phase lag [deg]", 1}}},
    {"unbalance_middle_bode",
     1,
     "z",
     unbalance,
     "speed [rpm]",
     speed_rpm,
     "phase lag [°]",
     {{"middle z phase lag [deg]", 1}}},
    {"unbalance_middle_polar",
     0,
     "y",
     unbalance,
     "phase lag clockwise [°]",
     {{"middle y phase lag [deg]", 1}},
     "amplitude, 0-peak [µm]",
     {{"middle y amplitude [m]", 1e6}}},
    {"unbalance_middle_polar",
     0,
     "z",
     unbalance,
     "phase lag clockwise [°]",
     {{"middle z phase lag [deg]", 1}},
     "amplitude, 0-peak [µm]",
     {{"middle z amplitude [m]", 1e6}}},
    {"harmonic_middle_bode",
     0,
     "y",
     harmonic,
     "excitation frequency [Hz]",
     frequency_Hz,
     "amplitude, 0-peak [µm]",
     {{"middle y amplitude [m]", 1e6}}},
    {"harmonic_middle_bode",
     0,
     "z",
     harmonic,
     "excitation frequency [Hz]",
     frequency_Hz,
     "amplitude, 0-peak [µm]",
     {{"middle z amplitude [m]", 1e6}}},
    {"harmonic_middle_bode",
     1,
     "y",
     harmonic,
     "excitation frequency [Hz]",
     frequency_Hz,
     "phase lag [°]",
     {{"middle y phase lag [deg]", 1}}},
    {"harmonic_middle_polar",
     0,
     "y",
     harmonic,
     "phase lag clockwise [°]",
     {{"middle y phase lag [deg]", 1}},
     "amplitude, 0-peak [µm]",
     {{"middle y amplitude [m]", 1e6}}},
    {"harmonic_torsion",
     0,
     "middle",
     harmonic,
     "excitation frequency [Hz]",
     frequency_Hz,
     "twist amplitude, 0-peak [rad]",
     {{"middle twist amplitude [rad]", 1}}},
    {"harmonic_torsion",
     1,
     "rotor",
     harmonic,
     "excitation frequency [Hz]",
     frequency_Hz,
     "largest vibratory torque, 0-peak [N.m]",
     {{"largest torque in rotor [N.m]", 1}}},
};

/// Lines of modes, each in as many pieces as its whirl has directions.
void expect_modes(const DeckRun& run, const std::string& figure, const std::string& table,
                  const std::string& quantity, const std::string& y_title) {
  const DrawnAxes a = test::drawn(run.folder / "r" / "plots" / (figure + ".svg")).at(0);
  EXPECT_EQ(a.x_title, "speed [rpm]") << figure;
  EXPECT_EQ(a.y_title, y_title) << figure;
  const Columns modes = run.csv(table);
  const Values rpm = values_of(modes, speed_rpm);
  std::size_t shown = 0;
  for (const std::string& column : modes.names) {
    if (!column.ends_with(" " + quantity)) continue;
    const std::string mode = column.substr(0, column.size() - quantity.size() - 1);
    DrawnCurve whole;
    for (const DrawnCurve& c : a.curves)
      if (c.name == mode || c.name.starts_with(mode + ", ")) {
        whole.points.insert(whole.points.end(), c.points.begin(), c.points.end());
        ++shown;
      }
    const Values y = values_of(modes, {{column.c_str(), 1}});
    expect_line(whole, line_of(a, rpm, y, {0, rpm.size()}), figure + " " + mode);
  }
  for (const DrawnCurve& c : a.curves)
    shown += c.name == "1X excitation";
  EXPECT_EQ(shown, a.curves.size()) << figure;
}

}  // namespace

TEST(DrawnNumbers, OfAnalysesAreThoseOfTheirTables) {
  const DeckRun run(analyses);
  ASSERT_EQ(run.exit, 0) << run.log;
  std::set<std::string> known{"rotor",
                              "campbell_campbell",
                              "campbell_log_decrement",
                              "stability_frequencies",
                              "stability_log_decrement",
                              "unbalance_bearing_forces"};
  for (const Shown& s : results) {
    expect_shown(run, s);
    known.insert(s.figure);
  }
  std::set<std::string> figures = figures_in(run, "");
  std::erase_if(figures, [](const std::string& f) { return f.find("_shape_") != f.npos; });
  EXPECT_EQ(figures, known);  // none is missing, none is new
  const std::string frequency = "damped natural frequency [Hz]",
                    decrement = "log decrement (unstable below 0)";
  expect_modes(run, "campbell_campbell", "campbell_campbell.csv", "frequency [Hz]", frequency);
  expect_modes(run, "campbell_log_decrement", "campbell_campbell.csv", "log decrement [-]",
               decrement);
  expect_modes(run, "stability_frequencies", "stability_log_decrement.csv", "frequency [Hz]",
               frequency);
  expect_modes(run, "stability_log_decrement", "stability_log_decrement.csv", "log decrement [-]",
               decrement);
  // bearings where their stiffness is
  const DrawnAxes map = test::drawn(run.folder / "r/plots/map_critical_map.svg").at(0);
  for (const auto& [bearing, stiffness] : {std::pair{"A kyy", 2e7}, {"B kzz", 3e7}}) {
    const DrawnCurve* c = map.curve(bearing);
    ASSERT_TRUE(c) << bearing;
    for (const Pixel& p : c->points)
      EXPECT_NEAR(p.x, map.place(stiffness, map.y[0]).x, pixels) << bearing;
  }
  // the largest of a force over the turn: half the larger axis of its ellipse
  const Columns response = run.csv(unbalance);
  const DrawnAxes forces = test::drawn(run.folder / "r/plots/unbalance_bearing_forces.svg").at(0);
  for (const std::string name : {"A", "B"}) {
    Values largest;
    for (const auto& row : response.rows) {
      const auto force = [&](const char* axis) {
        const std::string of = "bearing " + name + " force " + axis;
        return std::polar(row[response.column(of + " [N]")],
                          -row[response.column(of + " phase lag [deg]")] * pi / 180);
      };
      const std::complex<double> y = force("y"), z = force("z"), i(0, 1);
      largest.push_back((std::abs(y + i * z) + std::abs(y - i * z)) / 2);
    }
    const DrawnCurve* c = forces.curve(name);
    ASSERT_TRUE(c) << name;
    expect_line(*c, line_of(forces, values_of(response, speed_rpm), largest, {0, largest.size()}),
                "force " + name);
  }
}

namespace {

/// 98.1 N on a bearing, at five speeds.
std::string sweep_of(const std::string& bearing) {
  return test::lateral_mass(10, "9.81 m/s^2",
                            "[[bearing]]\nname = \"b\"\nat = \"mass\"\n" + bearing + R"([[step]]
name = "s"
type = "static"
speeds = { start = "500 rpm", stop = "3000 rpm", points = 5 }
)");
}

const char* const coefficients = "s_coefficients.csv";

const Shown film[] = {
    {"s_locus",
     0,
     "locus",
     coefficients,
     "y / clearance",
     {{"y [m]", 1 / 40e-6}},
     "z / clearance",
     {{"z [m]", 1 / 40e-6}}},
    {"s_eccentricity",
     0,
     "eccentricity",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "eccentricity / clearance",
     {{"eccentricity / clearance [-]", 1}}},
    {"s_eccentricity",
     0,
     "attitude",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "attitude [deg]",
     {{"attitude [deg]", 1}}},
    {"s_stiffness",
     0,
     "kyy",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "stiffness [MN/m]",
     {{"kyy [N/m]", 1e-6}}},
    {"s_stiffness",
     0,
     "kyz",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "stiffness [MN/m]",
     {{"kyz [N/m]", 1e-6}}},
    {"s_stiffness",
     0,
     "kzy",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "stiffness [MN/m]",
     {{"kzy [N/m]", 1e-6}}},
    {"s_stiffness",
     0,
     "kzz",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "stiffness [MN/m]",
     {{"kzz [N/m]", 1e-6}}},
    {"s_damping",
     0,
     "cyy",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "damping [kN s/m]",
     {{"cyy [N s/m]", 1e-3}}},
    {"s_damping",
     0,
     "cyz",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "damping [kN s/m]",
     {{"cyz [N s/m]", 1e-3}}},
    {"s_damping",
     0,
     "czz",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "damping [kN s/m]",
     {{"czz [N s/m]", 1e-3}}},
};

const Shown table_bearing[] = {
    {"s_locus", 0, "locus", coefficients, "y [um]", {{"y [m]", 1e6}}, "z [um]", {{"z [m]", 1e6}}},
    {"s_eccentricity",
     0,
     "eccentricity",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "eccentricity [um]",
     {{"eccentricity [m]", 1e6}}},
    {"s_eccentricity",
     0,
     "attitude",
     coefficients,
     "speed [rpm]",
     speed_rpm,
     "attitude [deg]",
     {{"attitude [deg]", 1}}},
};

}  // namespace

TEST(DrawnNumbers, OfBearingsAgainstSpeedAreThoseOfTheirTable) {
  const DeckRun journal(sweep_of(
      "type = \"short_journal\"\ndiameter = \"40 mm\"\nlength = \"16 mm\"\nclearance = \"40 um\"\n"
      "viscosity = \"20 mPa.s\"\n"));
  ASSERT_EQ(journal.exit, 0) << journal.log;
  std::set<std::string> known;
  for (const Shown& s : film) {
    expect_shown(journal, s);
    known.insert(s.figure);
  }
  EXPECT_EQ(figures_in(journal, "s_"), known);
  const DeckRun table(sweep_of(
      "type = \"table\"\ncolumns = [\"speed[rpm]\", \"kyy[N/m]\", \"kyz[N/m]\", \"kzy[N/m]\", "
      "\"kzz[N/m]\"]\nrows = [[0, 1e6, 2e5, -1e5, 2e6], [4000, 3e6, 1e5, -4e5, 1e6]]\n"));
  ASSERT_EQ(table.exit, 0) << table.log;
  for (const Shown& s : table_bearing)
    expect_shown(table, s);
}

// Turned fast with few rows a turn, then stopped: the orbit at rest has its own centre, not that of four
// turns that were over long before.
TEST(DrawnNumbers, AShaftThatStandsComesToRest) {
  const DeckRun run(R"(format = 1
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40], ["b", 200, 40]]
[[disk]]
name = "D"
at = "a:end"
mass = "5 kg"
Ip = "0.02 kg.m^2"
Id = "0.012 kg.m^2"
[[bearing]]
at = "a:start"
type = "linear"
kyy = "4e6 N/m"
kzz = "3e6 N/m"
cyy = "500 N.s/m"
czz = "500 N.s/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "4e6 N/m"
kzz = "3e6 N/m"
cyy = "500 N.s/m"
czz = "500 N.s/m"
[[unbalance]]
at = "D"
amount = "100 g.mm"
[[drive]]
at = "a:start"
type = "speed"
speed = { type = "ramp", time = ["0 s", "0.4 s", "0.45 s"], value = ["30000 rpm", "30000 rpm", "0 rpm"] }
[[probe]]
name = "P"
at = "D"
[[step]]
name = "t"
type = "transient"
duration = "1 s"
initial_speed = "30000 rpm"
[output]
every = "20 ms"
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const DrawnAxes a = test::drawn(run.folder / "r/plots/t_P_amplitude.svg").at(0);
  const DrawnCurve* c = a.curve("speed falling");
  ASSERT_TRUE(c);
  const double bottom = a.box[1] + a.box[3];
  const auto radius_of = [&](const Pixel& p) {
    return (bottom - p.y) / a.box[3] * (a.y[1] - a.y[0]);
  };
  double largest = 0, at_rest = infinity;
  for (const Pixel& p : c->points) {
    largest = std::max(largest, radius_of(p));
    if (p.x < a.place(100, 0).x) at_rest = std::min(at_rest, radius_of(p));
  }
  EXPECT_GT(largest, 20.0);  // rings when it has stopped
  EXPECT_LT(at_rest, 0.25);  // um; the sag is 24
}
