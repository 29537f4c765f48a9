// Forces and moments of every kind of support: with the loads they are in balance, in the static
// results and in the first row of a motion that starts from them. A support whose moment is left
// out of the tables leaves the moments out of balance by what it carries.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <gtest/gtest.h>

#include <fstream>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

/// One support on the shaft: its name, and where it stands, m.
struct Support {
  const char* name;
  double x;
};

struct Case {
  const char* name;
  std::vector<Support> supports;
  std::string text;        ///< bearings and what belongs to them
  double rpm = 0;          ///< speed of the equilibrium
  const char* rigid = "";  ///< places of rigid stretches: supports stand off the nodes there
  bool in_time = true;     ///< the motion in time begins with the same forces
};

std::string bearing(const std::string& name, const std::string& at, const std::string& law) {
  return "[[bearing]]\nname = \"" + name + "\"\nat = \"" + at + "\"\n" + law + "\n";
}

const std::string soft = "type = \"linear\"\nkyy = \"1e6 N/m\"\nkzz = \"2e6 N/m\"\n";
const std::string thrust =
    bearing("T", "a:start", "type = \"linear\"\nkxx = \"1e7 N/m\"\nkrxx = \"1e4 N.m/rad\"");
std::string two(const std::string& law) {
  return thrust + bearing("L", "a:start", law) + bearing("R", "b:end", law);
}
const std::vector<Support> ends{{"T", 0.0}, {"L", 0.0}, {"R", 1.0}};
/// What is to be looked at stands at x = 0.25 m beside two bearings at the ends.
std::string beside(const std::string& law) { return two(soft) + bearing("X", "q:end", law); }
const std::vector<Support> beside_ends{{"T", 0.0}, {"L", 0.0}, {"R", 1.0}, {"X", 0.25}};

const std::string film =
    "diameter = \"50 mm\"\nlength = \"20 mm\"\nclearance = \"100 um\"\nviscosity = \"50 mPa.s\"\n";
const std::string ball =
    "type = \"ball\"\nballs = 9\nball_diameter = \"10 mm\"\npitch_diameter = \"50 mm\"\nclearance "
    "= \"5 um\"\n";
const std::string angular =
    "type = \"ball\"\nballs = 16\nball_diameter = \"10 mm\"\npitch_diameter = \"60 "
    "mm\"\ncontact_angle = \"25 deg\"\npreload = \"500 N\"\n";
const std::string roller =
    "type = \"roller\"\nrollers = 12\nroller_diameter = \"10 mm\"\nroller_length = \"12 "
    "mm\"\npitch_diameter = \"60 mm\"\nclearance = \"-2 um\"\n";
const std::string pedestal =
    "support = { mass = \"3 kg\", kyy = \"4e6 N/m\", kzz = \"5e6 N/m\", kxx = \"1e7 N/m\" }\n";
const std::string second = R"([[shaft]]
name = "two"
material = "bar"
origin = ["1 m", "0 mm", "0 mm"]
columns = ["name", "length[mm]", "od[mm]"]
rows = [["c", 200, 50], ["d", 200, 50]]
[[disk]]
at = "two/c:end"
mass = "5 kg"
Ip = "0.01 kg.m^2"
Id = "0.01 kg.m^2"
[[bearing]]
name = "far"
at = "two/d:end"
type = "rigid"
directions = ["x", "y", "z", "ry", "rz"]
[[load]]
at = "two/c:end"
force = ["10 N", "40 N", "0 N"]
)";

std::vector<Case> cases() {
  std::vector<Case> c;
  c.push_back(
      {"spring block",
       {{"X", 0.25}},
       bearing("X", "q:end", "type = \"spring_block\"\nC1 = \"1e8 N/m\"\nC2 = \"1e6 N.m/rad\"")});
  c.push_back(
      {"spring block off the node",
       {{"X", 0.25}},
       bearing("X", "q:end", "type = \"spring_block\"\nC1 = \"1e8 N/m\"\nC2 = \"1e6 N.m/rad\""),
       0,
       "rigid"});
  c.push_back(
      {"spring block on a pedestal",
       {{"X", 0.25}, {"L", 0.0}, {"R", 1.0}},
       two(soft) + bearing("X", "q:end",
                           "type = \"spring_block\"\nC1 = \"1e8 N/m\"\nC2 = \"1e5 N.m/rad\"\n" +
                               pedestal)});
  c.back().supports.push_back({"T", 0.0});
  c.push_back({"linear, translations", ends, two(soft)});
  const std::string tilting =
      "type = \"linear\"\nkxx = \"1e7 N/m\"\nkyy = \"1e7 N/m\"\nkzz = \"1e7 N/m\"\nkrr = \"1e5 "
      "N.m/rad\"\nkrxx = \"1e5 N.m/rad\"";
  c.push_back({"linear, tilting", {{"X", 0.25}}, bearing("X", "q:end", tilting)});
  c.push_back(
      {"linear, tilting, off the node", {{"X", 0.25}}, bearing("X", "q:end", tilting), 0, "rigid"});
  c.push_back({"linear, translations, off the node", beside_ends, beside(soft), 0, "rigid"});
  c.push_back({"linear with preloads", beside_ends,
               beside(tilting + "\npreload = [\"5 N\", \"7 N\", \"11 N\"]\npreload_moment = [\"1 "
                                "N.m\", \"2 N.m\", \"3 N.m\"]")});
  c.push_back({"linear on a pedestal", ends, two(soft + pedestal)});
  c.push_back({"table", ends,
               two("type = \"table\"\nextrapolate = \"hold\"\ncolumns = [\"speed[rpm]\", "
                   "\"kyy[N/m]\", \"kzz[N/m]\", \"kyz[N/m]\", \"kzy[N/m]\"]\nrows = [[0, 1e6, 2e6, "
                   "3e5, -3e5], [3000, 2e6, 3e6, 0, 0]]\n")});
  c.push_back({"table with moments", beside_ends,
               beside("type = \"table\"\nextrapolate = \"hold\"\ncolumns = [\"speed[rpm]\", "
                      "\"kyy[N/m]\", \"kzz[N/m]\", \"krr[N.m/rad]\"]\nrows = [[0, 1e6, 2e6, 1e5], "
                      "[3000, 2e6, 3e6, 2e5]]\n")});
  c.push_back(
      {"clamp",
       {{"X", 0.25}},
       bearing("X", "q:end",
               "type = \"rigid\"\ndirections = [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"]")});
  c.push_back(
      {"rigid, two",
       {{"L", 0.0}, {"R", 1.0}},
       bearing("L", "a:start", "type = \"rigid\"\ndirections = [\"x\", \"y\", \"z\", \"rx\"]") +
           bearing("R", "b:end", "type = \"rigid\"\ndirections = [\"y\", \"z\"]")});
  c.push_back(
      {"rigid, two on one stretch",
       {{"L", 0.0}, {"X", 0.25}},
       bearing("L", "a:start", "type = \"rigid\"\ndirections = [\"x\", \"y\", \"z\", \"rx\"]") +
           bearing("X", "q:end", "type = \"rigid\"\ndirections = [\"y\", \"z\"]"),
       0,
       "rigid"});
  c.push_back(
      {"clamp on a pedestal",
       {{"X", 0.25}},
       bearing("X", "q:end",
               "type = \"rigid\"\ndirections = [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"]\n" +
                   pedestal)});
  c.push_back({"rigid in y and z on a pedestal", ends,
               two("type = \"rigid\"\ndirections = [\"y\", \"z\"]\n" + pedestal)});
  for (const char* direction : {"x", "y", "z", "radial"})
    c.push_back(
        {direction, beside_ends,
         beside(std::string("type = \"nonlinear_spring\"\nshape = \"polynomial\"\ncoefficients = "
                            "[\"0 N\", \"1e6 N/m\", \"0 N/m^2\", \"1e9 N/m^3\"]\ndirection = \"") +
                direction + "\"")});
  for (const char* direction : {"rx", "ry", "rz"})
    c.push_back(
        {direction, beside_ends,
         beside(std::string(
                    "type = \"nonlinear_angular_spring\"\nshape = \"polynomial\"\ncoefficients = "
                    "[\"0 N.m\", \"1e5 N.m/rad\"]\ndirection = \"") +
                direction + "\"")});
  c.push_back({"nonlinear spring off the node", beside_ends,
               beside("type = \"nonlinear_spring\"\nshape = \"polynomial\"\ncoefficients = [\"0 "
                      "N\", \"1e6 N/m\"]\ndirection = \"z\""),
               0, "rigid"});
  c.push_back({"short journals", ends, two("type = \"short_journal\"\n" + film), 6000});
  c.push_back({"short journal off the node", beside_ends,
               beside("type = \"short_journal\"\n" + film), 6000, "rigid"});
  c.push_back({"journals", ends, two("type = \"journal\"\nshape = \"plain\"\n" + film), 6000});
  const std::string pads = "type = \"tilting_pad\"\npreload = 0.4\n";
  c.push_back({"tilting pads", ends, two(pads + film), 6000});
  c.push_back({"tilting pads off the node, elastic pivots", beside_ends,
               beside(pads +
                      "inertia = \"1e-5 kg.m^2\"\nmass = \"0.1 kg\"\npivot_stiffness = "
                      "\"1e8 N/m\"\n" +
                      film),
               6000, "rigid"});
  const std::string films =
      "type = \"floating_ring\"\ninner = { diameter = \"50 mm\", length = \"25 mm\", clearance = "
      "\"50 um\", viscosity = \"20 mPa.s\" }\nouter = { diameter = \"70 mm\", length = \"30 mm\", "
      "clearance = \"90 um\", viscosity = \"20 mPa.s\" }\n";
  c.push_back({"floating rings", ends, two(films), 6000});
  c.push_back({"floating ring off the node", beside_ends, beside(films + "film = \"short\"\n"),
               6000, "rigid"});
  c.push_back(
      {"squeeze films", ends,
       two("type = \"squeeze_film\"\nfilm = \"cavitated\"\nstiffness = \"3e6 N/m\"\n" + film)});
  c.push_back({"deep-groove balls", ends, two(ball)});
  c.push_back({"angular-contact balls", beside_ends, beside(angular)});
  c.push_back({"angular-contact balls off the node", beside_ends, beside(angular), 0, "rigid"});
  c.push_back({"rollers", ends, two(roller)});
  c.push_back(
      {"estimate of balls", ends,
       two("type = \"ball_estimate\"\nballs = 9\nball_diameter = \"10 mm\"\nload = \"60 N\"\n")});
  c.push_back({"rub with friction", beside_ends,
               beside("type = \"rub\"\ngap = \"5 um\"\nstiffness = \"1e7 N/m\"\nfriction = 0.2\n"),
               6000});
  c.push_back({"annular seal", beside_ends,
               beside("type = \"annular_seal\"\ndiameter = \"50 mm\"\nlength = \"20 "
                      "mm\"\nclearance = \"200 um\"\npressure_drop = \"10 bar\"\ndensity = \"1000 "
                      "kg/m^3\"\nviscosity = \"1 mPa.s\"\n"),
               6000});
  c.push_back(
      {"cross coupling", beside_ends, beside("type = \"cross_coupling\"\nk = \"1e5 N/m\"\n")});
  c.push_back(
      {"coupling",
       {{"T", 0.0}, {"L", 0.0}, {"X", 1.0}},
       thrust + bearing("L", "a:start", soft) + second +
           bearing("X", "b:end",
                   "to = \"two/c:start\"\ntype = \"coupling\"\nkxx = \"1e7 N/m\"\nkyy = \"1e8 "
                   "N/m\"\nkzz = \"1e8 N/m\"\nkrr = \"1e5 N.m/rad\"\nkrxx = \"1e5 N.m/rad\"")});
  return c;
}

/// A shaft of 1 m with a disk of 10 kg in its middle, pulled and turned at 0.75 m.
std::string deck(const Case& k) {
  // a spring against turning would be wound up by a shaft that turns
  std::string parts = k.text;
  const std::string against_turning = "\nkrxx = \"1e4 N.m/rad\"";
  if (const std::size_t at = parts.find(against_turning); k.rpm != 0 && at != std::string::npos)
    parts.erase(at, against_turning.size());
  const std::string rigid = *k.rigid ? "true" : "false";
  std::string text = R"(format = 1
[[material]]
name = "bar"
E = "210 GPa"
density = "7800 kg/m^3"
[[shaft]]
name = "shaft"
material = "bar"
columns = ["name", "length[mm]", "od[mm]", "rigid"]
rows = [["a", 100, 50, )" +
                     rigid + R"(], ["q", 150, 50, )" + rigid + R"(], ["r", 100, 50, )" + rigid +
                     R"(], ["m", 150, 50, false], ["n", 250, 50, false], ["b", 250, 50, false]]
[[disk]]
at = "m:end"
mass = "10 kg"
Ip = "0.05 kg.m^2"
Id = "0.03 kg.m^2"
[[load]]
at = "n:end"
force = ["20 N", "-30 N", "50 N"]
moment = ["2 N.m", "3 N.m", "-5 N.m"]
)" + parts + R"([[step]]
name = "rest"
type = "static"
speed = ")" + std::to_string(k.rpm) +
                     R"( rpm"
[[step]]
name = "move"
type = "transient"
duration = "1 us"
initial_speed = ")" + std::to_string(k.rpm) +
                     R"( rpm"
checkpoint = "0 s"
[output]
quantities = ["bearing_force", "bearing_moment"]
report = false
)";
  return text;
}

/// Force and moment in a row of the histories, by the name of the support.
Vec3 channel(const Columns& run, const std::string& name) {
  Vec3 v = Vec3::Zero();
  for (std::size_t k = 0; k < run.names.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (run.names[k].rfind(name + "." + "xyz"[c], 0) == 0) v[c] = run.rows.front()[k];
  return v;
}

}  // namespace

TEST(SupportBalance, EveryKindIsInBalanceWithTheLoads) {
  for (const Case& k : cases()) {
    SCOPED_TRACE(k.name);
    const DeckRun d(deck(k));
    ASSERT_EQ(d.exit, 0) << d.log;
    std::map<std::string, std::pair<Vec3, Vec3>> row;  // force, moment
    {
      std::ifstream in(d.folder / "r" / "rest_supports.csv");
      std::string line;
      std::getline(in, line);
      while (std::getline(in, line)) {
        std::istringstream cells(line);
        std::string name, cell;
        std::getline(cells, name, ',');
        Vec3 F, M;
        for (int c = 0; c < 6; ++c) {
          std::getline(cells, cell, ',');
          (c < 3 ? F[c] : M[c - 3]) = std::stod(cell);
        }
        row[name] = {F, M};
      }
    }
    // loads: weights of disk and shaft at 0.5 m, force and moment at 0.75 m
    const double mass = 10 + 7800 * pi / 4 * 0.05 * 0.05;
    const Vec3 weight(0, 0, -9.80665 * mass), pull(20, -30, 50), turn(2, 3, -5);
    Vec3 force = weight + pull;
    Vec3 moment = turn + Vec3(0.5, 0, 0).cross(weight) + Vec3(0.75, 0, 0).cross(pull);
    for (const Support& s : k.supports) {
      ASSERT_TRUE(row.count(s.name)) << s.name;
      force += row[s.name].first;
      moment += row[s.name].second + Vec3(s.x, 0, 0).cross(row[s.name].first);
    }
    const io::Value rest = d.summary("rest");
    const io::Value& torque = rest.at("torque that keeps the speed [N m]").at("shaft");
    if (torque.is_number()) moment.x() += torque.number();
    // forces: what Newton's iteration leaves, 1e-9 of them. Moments are taken about the places of
    // the undeformed shaft, which is displaced by up to 0.2 mm under up to 120 N: 0.03 N m
    EXPECT_LT(force.norm(), 1e-6) << force.transpose();
    EXPECT_LT(moment.norm(), 0.03) << moment.transpose();

    const Columns run = d.csv("move.csv");
    ASSERT_FALSE(run.rows.empty());
    // the accelerations that Newton's iteration leaves act on the masses of pedestals: 1e-4 of the
    // forces
    for (const auto& [name, load] : row) {
      EXPECT_LT((channel(run, "bearing " + name + " force") - load.first).norm(),
                1e-4 * std::max(100.0, load.first.norm()))
          << name;
      EXPECT_LT((channel(run, "bearing " + name + " moment") - load.second).norm(),
                1e-4 * std::max(100.0, load.second.norm()))
          << name;
    }
  }
}

// 100 N down at 1 m from a block of C2 = 1e5 N m/rad, and the weight of the shaft itself (15.41 kg
// at 0.5 m): 100 N m about z, 75.577 N m about y.
TEST(SupportBalance, MomentOfASpringBlockIsThatOfTheLinearBearing) {
  const std::string shaft = R"(format = 1
[[material]]
name = "steel"
E = "210 GPa"
density = "7850 kg/m^3"
[[shaft]]
name = "s"
material = "steel"
[[shaft.section]]
name = "a"
length = "1 m"
od = "50 mm"
[[load]]
at = "a:end"
force = ["0 N", "-100 N", "0 N"]
[[step]]
name = "st"
type = "static"
)";
  std::map<std::string, double> a, b;
  {
    const DeckRun block(
        shaft +
        bearing("B", "a:start", "type = \"spring_block\"\nC1 = \"1e8 N/m\"\nC2 = \"1e5 N.m/rad\""));
    ASSERT_EQ(block.exit, 0) << block.log;
    a = block.csv("st_supports.csv").last();
  }
  {
    const DeckRun linear(shaft +
                         bearing("B", "a:start",
                                 "type = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = \"1e8 N/m\"\nkzz = "
                                 "\"1e8 N/m\"\nkrr = \"1e5 N.m/rad\"\nkrxx = \"1e5 N.m/rad\""));
    ASSERT_EQ(linear.exit, 0) << linear.log;
    b = linear.csv("st_supports.csv").last();
  }
  // deflection of 3 mm shortens the arms by 1e-5
  EXPECT_NEAR(a.at("M_y [N m]"), -75.577, 2e-3);
  EXPECT_NEAR(a.at("M_z [N m]"), 100.0, 2e-3);
  for (const char* c : {"F_x [N]", "F_y [N]", "F_z [N]", "M_x [N m]", "M_y [N m]", "M_z [N m]"})
    EXPECT_NEAR(a.at(c), b.at(c), 1e-3) << c;
}
