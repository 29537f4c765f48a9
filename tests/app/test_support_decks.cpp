// Every kind of support from the deck: what the analyses in frequency say is what the motion in
// time does.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

constexpr double rpm = pi / 30;

/// A rotor of 600 mm with a disk in the middle, from left (a:start) to right (b:end).
const std::string rotor = R"(format = 1
[[shaft]]
name = "rotor"
material = "steel"
damping = { internal_beta = "1e-6 s", rayleigh_alpha = "2 1/s" }
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 300, 50, 2], ["b", 300, 50, 2]]
[[disk]]
name = "disk"
at = "rotor/a:end"
mass = "20 kg"
Ip = "0.2 kg.m^2"
Id = "0.11 kg.m^2"
[[unbalance]]
at = "disk"
amount = "0.2 g.mm"
[[probe]]
name = "P"
at = "disk"
)";

std::string bearing(const std::string& name, const std::string& at, const std::string& law) {
  return "[[bearing]]\nname = \"" + name + "\"\nat = \"" + at + "\"\n" + law + "\n";
}
const std::string thrust =
    bearing("thrust", "rotor/a:start", "type = \"linear\"\nkxx = \"1e7 N/m\"\ncxx = \"1e3 N.s/m\"");
const std::string linear =
    "type = \"linear\"\nkyy = \"2e7 N/m\"\nkzz = \"3e7 N/m\"\ncyy = \"2e3 N.s/m\"\nczz = \"2e3 "
    "N.s/m\"\n";
std::string both(const std::string& law) {
  return thrust + bearing("DE", "rotor/a:start", law) + bearing("NDE", "rotor/b:end", law);
}
std::string with(const std::string& law) { return both(linear) + bearing("X", "disk", law); }

/// A second shaft of 400 mm on two bearings.
std::string second(const std::string& head) {
  return "[[shaft]]\nname = \"two\"\nmaterial = \"steel\"\n" + head + R"(
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["c", 200, 50, 2], ["d", 200, 50, 2]]
)" +
         bearing("T1", "two/c:mid",
                 "type = \"linear\"\nkxx = \"1e7 N/m\"\nkyy = \"3e7 N/m\"\nkzz = \"3e7 N/m\"\ncyy "
                 "= \"2e3 N.s/m\"\nczz = \"2e3 N.s/m\"") +
         bearing("T2", "two/d:end",
                 "type = \"linear\"\nkyy = \"3e7 N/m\"\nkzz = \"3e7 N/m\"\ncyy = \"2e3 "
                 "N.s/m\"\nczz = \"2e3 N.s/m\"");
}
const std::string gear_pair =
    "to = \"two/c:start\"\ntype = \"gear\"\nteeth = 24\nother_teeth = 60\npitch_diameter = \"60 "
    "mm\"\nstiffness = \"4e8 N/m\"\n";
const std::string wheel = second("origin = [\"150 mm\", \"105 mm\", \"0 mm\"]\nspeed_ratio = -0.4");
/// 20 N m on the pinion's shaft, 50 N m on the wheel's: in balance through the mesh.
std::string torques_of(int sign) {
  return fmt::format(
      "[[load]]\nat = \"rotor:end\"\nmoment = [\"{} N.m\", \"0 N.m\", \"0 N.m\"]\n[[load]]\nat = "
      "\"two/d:end\"\nmoment = [\"{} N.m\", \"0 N.m\", \"0 N.m\"]\n",
      20 * sign, 50 * sign);
}
const std::string torques = torques_of(1);
const std::string casing =
    R"([[shaft]]
name = "casing"
material = "steel"
rotating = false
columns = ["name", "length[mm]", "od[mm]", "id[mm]", "min_elements"]
rows = [["c", 300, 200, 180, 2], ["d", 300, 200, 180, 2]]
)" +
    bearing("F1", "casing/c:mid",
            "type = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = \"1e8 N/m\"\nkzz = \"2e8 N/m\"\nkrxx = "
            "\"1e7 N.m/rad\"\ncyy = \"1e4 N.s/m\"\nczz = \"1e4 N.s/m\"") +
    bearing("F2", "casing/d:mid",
            "type = \"linear\"\nkyy = \"1e8 N/m\"\nkzz = \"2e8 N/m\"\ncyy = \"1e4 N.s/m\"\nczz = "
            "\"1e4 N.s/m\"");
const std::string pedestal =
    "support = { mass = \"8 kg\", kxx = \"5e7 N/m\", kyy = \"5e7 N/m\", kzz = \"6e7 N/m\", cyy = "
    "\"1e3 N.s/m\", czz = \"1e3 N.s/m\" }";
const std::string film =
    "diameter = \"50 mm\"\nlength = \"25 mm\"\nclearance = \"50 um\"\nviscosity = \"20 mPa.s\"\n";
const std::string short_film = "type = \"short_journal\"\n" + film;
const std::string pads =
    "type = \"tilting_pad\"\npads = 5\nfirst_pivot = \"-90 deg\"\npreload = 0.4\n" + film;
const std::string ring =
    "type = \"floating_ring\"\ninner = { diameter = \"50 mm\", length = \"25 mm\", clearance = "
    "\"50 "
    "um\", viscosity = \"20 mPa.s\" }\nouter = { diameter = \"70 mm\", length = \"30 mm\", "
    "clearance "
    "= \"90 um\", viscosity = \"20 mPa.s\" }\n";
const std::string hot_ring =
    "type = \"floating_ring\"\nfilm = \"short\"\niso_vg = 32\nsupply_pressure = \"2 "
    "bar\"\nsupply_temperature = \"50 degC\"\nheat = { ring_expansion = \"18e-6 1/K\", "
    "shaft_expansion = \"11e-6 1/K\", housing_expansion = \"11e-6 1/K\" }\ninner = { diameter = "
    "\"50 "
    "mm\", length = \"25 mm\", clearance = \"50 um\" }\nouter = { diameter = \"70 mm\", length = "
    "\"30 mm\", clearance = \"90 um\" }\n";
const std::string rub =
    "type = \"rub\"\ngap = \"10 um\"\nstiffness = \"2e7 N/m\"\nfriction = 0.1\n";
const std::string balls =
    "type = \"ball\"\nballs = 9\nball_diameter = \"10 mm\"\npitch_diameter = \"56 mm\"\nc_radial = "
    "\"500 N.s/m\"\nc_axial = \"500 N.s/m\"\n";
const std::string rollers =
    "type = \"roller\"\nrollers = 14\nroller_diameter = \"8 mm\"\nroller_length = \"8 "
    "mm\"\npitch_diameter = \"65 mm\"\nc_radial = \"500 N.s/m\"\n";
const std::string seal =
    "type = \"annular_seal\"\ndiameter = \"150 mm\"\nlength = \"40 mm\"\nclearance = \"200 "
    "um\"\npressure_drop = \"10 bar\"\ndensity = \"1000 kg/m^3\"\nviscosity = \"1 mPa.s\"\n";
const std::string coupling =
    "to = \"two:start\"\ntype = \"coupling\"\nkxx = \"5e6 N/m\"\nkyy = \"6e6 N/m\"\nkzz = \"6e6 "
    "N/m\"\nkrr = \"4e3 N.m/rad\"\nkrxx = \"4e4 N.m/rad\"\ncrxx = \"4 N.m.s/rad\"\n";

struct Kind {
  const char* name;
  std::string supports;
  double tolerance = 1e-5;  ///< of the amplitude; smooth laws follow their linearisation to 1e-6
                            ///< and better, less where the law bends within the motion
  const char* gravity = "9.81 m/s^2";
};

const Kind kinds[] = {
    {"linear", both(linear)},
    {"six_by_six",
     both(
         "type = \"linear\"\nK = [[\"1e7 N/m\",0,0,0,0,0],[0,\"2e7 N/m\",\"3e6 N/m\",0,0,\"1e5 "
         "N/rad\"],[0,\"-3e6 N/m\",\"2e7 N/m\",0,\"-1e5 N/rad\",0],[0,0,0,0,0,0],"
         "[0,0,\"-1e5 N/rad\",0,\"1e4 N.m/rad\",0],[0,\"1e5 N/rad\",0,0,0,\"1e4 N.m/rad\"]]\ncyy = "
         "\"3e3 N.s/m\"\nczz = \"3e3 N.s/m\"\nsetpoint = [\"0 mm\", \"0.01 mm\", \"0.02 mm\"]\n")},
    {"rigid", thrust +
                  bearing("DE", "rotor/a:start", "type = \"rigid\"\ndirections = [\"y\", \"z\"]") +
                  bearing("NDE", "rotor/b:end", "type = \"rigid\"\ndirections = [\"y\", \"z\"]")},
    {"polynomial", with("type = \"nonlinear_spring\"\ndirection = \"radial\"\nshape = "
                        "\"polynomial\"\ncoefficients = [\"0 N\", \"1e6 N/m\", \"0 N/m^2\", \"1e14 "
                        "N/m^3\"]\ndamping = \"100 N.s/m\"\n")},
    {"spring_table", with("type = \"nonlinear_spring\"\ndirection = \"z\"\nshape = "
                          "\"table\"\ncolumns = [\"deflection[mm]\", \"force[N]\"]\nrows = [[-1, "
                          "-3000], [-0.1, -100], [0, 0], [0.1, 100], [1, 3000]]\n")},
    {"clearance", with("type = \"nonlinear_spring\"\ndirection = \"radial\"\nshape = "
                       "\"clearance\"\ngap = \"5 um\"\nstiffness = \"1e7 N/m\"\n")},
    {"one_sided", with("type = \"nonlinear_spring\"\ndirection = \"y\"\nshape = \"one_sided\"\ngap "
                       "= \"-2 um\"\nstiffness = \"1e7 N/m\"\n")},
    {"angular", with("type = \"nonlinear_angular_spring\"\ndirection = \"ry\"\nshape = "
                     "\"polynomial\"\ncoefficients = [\"0 N.m\", \"1e4 N.m/rad\", \"0 N.m/rad^2\", "
                     "\"1e9 N.m/rad^3\"]\n")},
    {"short_journal", both(short_film)},
    {"short_journal_on_pedestals", both(short_film + pedestal)},
    {"two_films_at_one_place", both(short_film) + bearing("third", "rotor/b:end", short_film)},
    {"plain_journal", both("type = \"journal\"\nshape = \"plain\"\n" + film)},
    {"grooved_journal", both("type = \"journal\"\nshape = \"two_grooves\"\n" + film)},
    {"lobed_journal", both("type = \"journal\"\nshape = \"lobes\"\npreload = 0.5\n" + film), 2e-5},
    {"tilting_pads", both(pads)},
    {"tilting_pads_with_inertia_on_elastic_pivots",
     both(pads + "inertia = \"2e-5 kg.m^2\"\nmass = \"0.1 kg\"\npivot_stiffness = \"1e8 "
                 "N/m\"\npivot_damping = \"1e3 N.s/m\"\n")},
    {"tilting_pads_on_pedestals", both(pads + pedestal)},
    {"tilting_pads_in_a_casing",
     casing + thrust + bearing("DE", "rotor/a:start", "to = \"casing/c:start\"\n" + pads) +
         bearing("NDE", "rotor/b:end", "to = \"casing/d:end\"\n" + pads)},
    // two films in series bend more than one: 1.8e-5 of the amplitude in the first revolution
    {"floating_rings", both(ring), 2.5e-5},
    {"short_floating_rings_with_heat", both(hot_ring), 2.5e-5},
    {"floating_rings_in_a_casing",
     casing + thrust + bearing("DE", "rotor/a:start", "to = \"casing/c:start\"\n" + ring) +
         bearing("NDE", "rotor/b:end", "to = \"casing/d:end\"\n" + ring),
     2.5e-5},
    {"squeeze_film",
     both("type = \"squeeze_film\"\nfilm = \"full\"\nstiffness = \"1e7 N/m\"\n" + film)},
    // centred: a circle, on which the film that cavitates is linear too; the springs of the three
    // others are what lets gravity off
    {"cavitated_squeeze_film",
     both("type = \"squeeze_film\"\nfilm = \"cavitated\"\nstiffness = \"1e7 N/m\"\n" + film), 1e-3,
     "0 m/s^2"},
    {"finite_squeeze_film",
     both("type = \"squeeze_film\"\nfilm = \"finite\"\nstiffness = \"1e7 N/m\"\n" + film), 1e-3,
     "0 m/s^2"},
    // in the middle of the bearing too; what its boundary of cavitation leaves is 1e-3 where it
    // passes a node of the grid
    {"centred_journal", both("type = \"journal\"\nshape = \"plain\"\n" + film), 3e-3, "0 m/s^2"},
    {"deep_groove", both(balls + "clearance = \"-3 um\"\n")},
    {"angular_contact",
     bearing("DE", "rotor/a:start", balls + "contact_angle = \"25 deg\"\npreload = \"300 N\"\n") +
         bearing("NDE", "rotor/b:end",
                 balls + "contact_angle = \"25 deg\"\npreload = \"300 N\"\ndirection = \"-x\"\n")},
    {"roller", both(rollers + "clearance = \"-2 um\"\n")},
    {"rub", with(rub), 5e-5},
    {"rub_on_an_elastic_stator", with(rub + pedestal), 5e-5},
    {"catcher",
     thrust + bearing("C1", "rotor/a:start", rub + pedestal) +
         bearing("C2", "rotor/b:end", rub + pedestal),
     2e-4},
    {"seal", with(seal)},
    {"alford", with("type = \"cross_coupling\"\nalford = { torque = \"500 N.m\", diameter = \"300 "
                    "mm\", blade_height = \"20 mm\" }")},
    {"wachel", with("type = \"cross_coupling\"\nwachel = { power = \"500 kW\", speed = \"9000 "
                    "rpm\", diameter = \"300 mm\", width = \"10 mm\", density_ratio = 2 }")},
    {"coupling",
     second("origin = [\"600 mm\", \"0 mm\", \"0 mm\"]") + both(linear) +
         bearing("C", "rotor:end", coupling + "offset_y = \"0.1 mm\"\nangle_z = \"0.1 deg\"\n")},
    {"spur_gears", wheel + both(linear) + torques +
                       bearing("mesh", "rotor/a:mid", gear_pair + "damping = \"2e3 N.s/m\"\n")},
    {"helical_gears_with_backlash",
     wheel + both(linear) + torques +
         bearing("mesh", "rotor/a:mid",
                 gear_pair +
                     "helix = \"15 deg\"\nbacklash = \"40 um\"\ncontact_damping = \"5 s/m\"\n")},
    {"intershaft_roller",
     second("origin = [\"200 mm\", \"0 mm\", \"0 mm\"]\nspeed_ratio = 1.5") + both(linear) +
         bearing("IS", "rotor/b:mid",
                 "to = \"two/d:start + 50 mm\"\n" + rollers + "clearance = \"-2 um\"\n")},
    {"intershaft_film",
     second("origin = [\"200 mm\", \"0 mm\", \"0 mm\"]\nspeed_ratio = 1.5") + both(linear) +
         bearing("IS", "rotor/b:mid", "to = \"two/d:start + 50 mm\"\n" + short_film) +
         "[[drive]]\nname = \"second\"\nat = \"two/d:end\"\ntype = \"speed\"\nspeed = \"4500 "
         "rpm\"\n"},  // its drag would slow the second shaft down
    {"films_in_a_casing",
     casing + thrust + bearing("DE", "rotor/a:start", "to = \"casing/c:start\"\n" + short_film) +
         bearing("NDE", "rotor/b:end", "to = \"casing/d:end\"\n" + short_film)},
    {"rub_in_a_casing", casing + with("to = \"casing/c:end\"\n" + rub), 5e-5},
    {"foundation", both(short_film) + R"([[foundation]]
name = "table"
symmetric = false
coordinates = ["DE.y", "DE.z", "NDE.y", "NDE.z"]
columns = ["row", "column", "K[N/m]", "C[N.s/m]", "M[kg]"]
rows = [[1, 1, 4e7, 500, 12], [2, 2, 6e7, 500, 12], [3, 3, 4e7, 500, 12], [4, 4, 6e7, 500, 12], [1, 2, 2e6, 0, 0], [2, 1, -2e6, 0, 0]]
)"},
};

void PrintTo(const Kind& k, std::ostream* os) { *os << k.name; }

class SupportDecks : public testing::TestWithParam<Kind> {};

}  // namespace

// A transient that starts in the response to a small unbalance stays in it: its line at the spin
// after a turn and after three is the amplitude that the step in frequency tells, in y and in z.
// Equilibrium, linearisation, forcing and motion are then all of one rotor.
TEST_P(SupportDecks, MotionStaysInTheUnbalanceResponse) {
  const double Omega = 3000 * rpm, turn = two_pi / Omega;
  const std::string steps = fmt::format(R"([[drive]]
name = "motor"
at = "rotor/b:end"
type = "speed"
speed = "3000 rpm"
step = "run"
[[step]]
name = "response"
type = "unbalance_response"
speed = {{ values = ["3000 rpm"] }}
[[step]]
name = "run"
type = "transient"
start = "unbalance_response"
initial_speed = "3000 rpm"
duration = "{:.15g} s"
integrator = {{ tolerance = 1e-7 }}
[output]
every = "{:.15g} ms"
quantities = ["probes"]
report = false
)",
                                        3 * turn, 1e3 * turn / 48);
  const DeckRun d(rotor + fmt::format("[model]\ngravity = \"{}\"\n", GetParam().gravity) +
                  GetParam().supports + steps);
  ASSERT_EQ(d.exit, 0) << d.log;
  // shafts of several speeds: the unbalance is on the reference shaft
  const char* file = std::filesystem::exists(d.folder / "r/response_response.csv")
                         ? "response_response.csv"
                         : "response_response_1x.csv";
  const Columns run = d.csv("run.csv"), response = d.csv(file);
  for (const char* axis : {"y", "z"}) {
    const double expected =
        response.rows.at(0)[response.column(fmt::format("P {} amplitude [m]", axis))];
    const std::size_t t = run.column("t [s]"), u = run.column(fmt::format("P.{} [m]", axis));
    for (const std::size_t first : {0u, 96u}) {
      Complex line = 0;
      for (std::size_t i = first; i < first + 48; ++i)
        line += 2.0 / 48 * run.rows.at(i)[u] * std::exp(Complex(0, -Omega * run.rows[i][t]));
      EXPECT_NEAR(std::abs(line), expected, GetParam().tolerance * expected)
          << axis << " from row " << first;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SupportDecks, testing::ValuesIn(kinds),
                         [](const auto& info) { return std::string(info.param.name); });

// Without load a journal runs in the middle, where its film has no stiffness but cross coupling;
// undamped modes and critical speeds are those of a free rotor.
TEST(SupportSteps, CentredJournalsInEveryFrequencyStep) {
  const DeckRun d(rotor + "[model]\ngravity = \"0 m/s^2\"\n" +
                  both("type = \"journal\"\nshape = \"plain\"\n" + film) + R"([[step]]
name = "critical"
type = "critical_speeds"
max_speed = "15000 rpm"
[[step]]
name = "campbell"
type = "campbell"
damping = "undamped"
speed = { start = "1000 rpm", stop = "9000 rpm", points = 5 }
[[step]]
name = "stability"
type = "stability"
speed = { start = "1000 rpm", stop = "9000 rpm", points = 5 }
[output]
report = false
)");
  EXPECT_EQ(d.exit, 0) << d.log;
}

// The map varies the bearings and leaves their pedestals out: it is the map of the same rotor
// without them.
TEST(SupportSteps, CriticalMapLeavesPedestalsOut) {
  const auto map = [](const std::string& more) {
    const DeckRun d(
        rotor + "[model]\ngravity = \"9.81 m/s^2\"\n" + both(linear + more) +
        "[[step]]\nname = \"m\"\ntype = \"critical_map\"\nmax_speed = \"15000 rpm\"\nstiffness_min "
        "= \"1e6 N/m\"\nstiffness_max = \"1e8 N/m\"\npoints = 3\n[output]\nreport = false\n");
    EXPECT_EQ(d.exit, 0) << d.log;
    return d.csv("m_critical_map.csv").rows;
  };
  const auto with_them = map(pedestal), without = map("");
  ASSERT_EQ(with_them.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(with_them[i].size(), without[i].size());
    EXPECT_GT(without[i][1], 0);
    EXPECT_NEAR(with_them[i][1], without[i][1], 1e-9 * without[i][1]);
  }
}

// What a static step at speed tells of its supports is the mean over the revolution, which is in
// balance: not one position of a cage, a mesh or a coupling.
namespace {

std::string at_rest_and_speed(const std::string& supports) {
  return rotor + "[model]\ngravity = \"9.81 m/s^2\"\n" + supports +
         "[[step]]\nname = \"s\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n[output]\nreport = "
         "false\n";
}

/// Rows F_x, F_y, F_z, M_x, M_y, M_z of the supports in the order of the deck.
std::vector<std::vector<double>> forces(const DeckRun& d) {
  std::vector<std::vector<double>> out;
  for (auto& row : d.csv("s_supports.csv").rows)
    out.emplace_back(row.begin() + 1, row.end());
  return out;
}

constexpr double rotor_weight = 9.81 * (20 + 7850 * pi / 4 * 0.05 * 0.05 * 0.6);

}  // namespace

TEST(StaticForces, RollingBearingsCarryTheWeight) {
  for (const std::string& law :
       {balls + "clearance = \"3 um\"\n", rollers + "clearance = \"2 um\"\n"}) {
    const DeckRun d(at_rest_and_speed(both(law)));
    ASSERT_EQ(d.exit, 0) << d.log;
    const auto F = forces(d);
    ASSERT_EQ(F.size(), 3u);
    for (int k : {1, 2}) {
      EXPECT_NEAR(F[static_cast<std::size_t>(k)][2], 0.5 * rotor_weight, 1e-6 * rotor_weight);
      EXPECT_NEAR(F[static_cast<std::size_t>(k)][1], 0.0, 1e-6 * rotor_weight);
    }
  }
}

TEST(StaticForces, AnUnequalCouplingIsInBalance) {
  std::string unequal = coupling;
  unequal.replace(unequal.find("kzz = \"6e6"), 10, "kzz = \"4e6");
  const DeckRun d(at_rest_and_speed(
      second("origin = [\"600 mm\", \"0 mm\", \"0 mm\"]") + both(linear) +
      bearing("C", "rotor:end", unequal + "offset_y = \"0.1 mm\"\nangle_z = \"0.1 deg\"\n")));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto F = forces(d);  // T1, T2, thrust, DE, NDE, C
  ASSERT_EQ(F.size(), 6u);
  const double other = 9.81 * 7850 * pi / 4 * 0.05 * 0.05 * 0.4;
  EXPECT_GT(std::abs(F[5][1]), 100);  // the misaligned coupling pushes
  EXPECT_NEAR(F[0][1] + F[1][1], F[5][1], 1e-6 * 400);
  EXPECT_NEAR(F[3][1] + F[4][1], -F[5][1], 1e-6 * 400);
  EXPECT_NEAR(F[0][2] + F[1][2] - F[5][2], other, 1e-6 * rotor_weight);
  EXPECT_NEAR(F[3][2] + F[4][2] + F[5][2], rotor_weight, 1e-6 * rotor_weight);
}

// 20 N m on the pinion against 50 N m on the wheel: 20/0.03 N across the line of centres, tan 20
// deg of it along; with varying stiffness and transmission error, and with backlash, whose flanks
// are apart until the torque turns them together.
TEST(StaticForces, GearsCarryTheTorque) {
  for (const char* more :
       {"damping = \"2e3 N.s/m\"\n",
        "damping = \"2e3 N.s/m\"\nstiffness_harmonics = [0.2]\nerror_harmonics = [\"2 um\"]\n",
        "backlash = \"40 um\"\n", "backlash = \"40 um\"\nstiffness_harmonics = [0.2]\n"})
    for (const char* speed : {"3000 rpm", "0 rpm"}) {
      std::string deck = at_rest_and_speed(wheel + both(linear) + torques +
                                           bearing("mesh", "rotor/a:mid", gear_pair + more));
      deck.replace(deck.find("speed = \"3000 rpm\""), 18, fmt::format("speed = \"{}\"", speed));
      const DeckRun d(deck);
      ASSERT_EQ(d.exit, 0) << d.log;
      const auto F = forces(d);  // T1, T2, thrust, DE, NDE, mesh
      ASSERT_EQ(F.size(), 6u);
      SCOPED_TRACE(std::string(more) + speed);
      // the torque that keeps the speed adds the damping of the shafts: 2e-4 N m
      EXPECT_NEAR(F[5][3], -20, 1e-4);
      EXPECT_NEAR(F[5][2], -20 / 0.03, 1e-5 * 667);
      EXPECT_NEAR(F[5][1], -20 / 0.03 * std::tan(pi / 9), 1e-5 * 667);
    }
}

// Torque the other way: the back flanks meet, and push the centres apart all the same.
TEST(StaticForces, TheBackFlanksCarryTheOtherTorque) {
  const DeckRun d(
      at_rest_and_speed(wheel + both(linear) + torques_of(-1) +
                        bearing("mesh", "rotor/a:mid", gear_pair + "backlash = \"40 um\"\n")));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto F = forces(d);
  ASSERT_EQ(F.size(), 6u);
  EXPECT_NEAR(F[5][2], 20 / 0.03, 1e-5 * 667);
  EXPECT_NEAR(F[5][1], -20 / 0.03 * std::tan(pi / 9), 1e-5 * 667);
}

// Two films at one place are two rows, each half of the one film they stand for; a nonlinear spring
// has its row too.
TEST(StaticForces, CoefficientsOfSupportsThatShareAPlace) {
  std::string thick = short_film;
  thick.replace(thick.find("20 mPa.s"), 8, "40 mPa.s");
  const std::string spring = bearing(
      "spring", "disk",
      "type = \"nonlinear_spring\"\ndirection = \"z\"\nshape = \"polynomial\"\ncoefficients = [\"0 "
      "N\", \"1e5 N/m\", \"0 N/m^2\", \"1e13 N/m^3\"]\n");
  const auto coefficients = [](const std::string& deck) {  // one run at a time: they share a folder
    const DeckRun d(deck);
    EXPECT_EQ(d.exit, 0) << d.log;
    return d.csv("s_coefficients.csv");
  };
  const Columns a = coefficients(at_rest_and_speed(thrust + bearing("DE", "rotor/a:start", thick) +
                                                   bearing("NDE", "rotor/b:end", thick) + spring));
  const Columns b = coefficients(at_rest_and_speed(
      thrust + bearing("DE", "rotor/a:start", thick) + bearing("NDE", "rotor/b:end", short_film) +
      bearing("NDE too", "rotor/b:end", short_film) + spring));
  ASSERT_EQ(a.rows.size(), 3u);
  ASSERT_EQ(b.rows.size(), 4u);
  const auto whole = a.named(a.rows[1]);
  for (const std::size_t i : {1u, 2u}) {
    const auto half = b.named(b.rows[i]);
    for (const char* entry : {"kyy", "kyz", "kzy", "kzz"})
      EXPECT_NEAR(half.at(std::string(entry) + " [N/m]"),
                  0.5 * whole.at(std::string(entry) + " [N/m]"), 1e-6 * whole.at("kzz [N/m]"))
          << entry;
    for (const char* entry : {"cyy", "cyz", "czy", "czz"})
      EXPECT_NEAR(half.at(std::string(entry) + " [N s/m]"),
                  0.5 * whole.at(std::string(entry) + " [N s/m]"), 1e-6 * whole.at("czz [N s/m]"))
          << entry;
    EXPECT_NEAR(half.at("load [N]"), 0.5 * whole.at("load [N]"), 1e-6 * whole.at("load [N]"));
  }
  const auto row = b.named(b.rows[3]);  // k = c1 + 3 c3 q^2
  EXPECT_NEAR(row.at("kzz [N/m]"), 1e5 + 3e13 * row.at("z [m]") * row.at("z [m]"),
              1e-9 * row.at("kzz [N/m]"));
  EXPECT_EQ(row.at("kyy [N/m]"), 0.0);
}

// A ball bearing with much play, far stiffer than steel, catches a mass that falls 1 mm (0.196 J):
// an impact of 30 us. Matrices taken inside a step would make it stiff to the error test as well,
// and a step over the impact would give the rebound 3 J. They are for films (one of no viscosity
// stands here), not where a gap may close. At a tolerance of 1e-2 the impacts of 0.4 s lose 14 % of
// the fall; asked is half.
TEST(Films, ImpactsBesideOne) {
  const DeckRun d(test::lateral_mass(20, "9.81 m/s^2", R"([[bearing]]
name = "film"
at = "mass"
type = "short_journal"
diameter = "100 mm"
length = "30 mm"
clearance = "2 mm"
viscosity = "1e-12 Pa.s"
[[bearing]]
name = "catcher"
at = "mass"
type = "ball"
balls = 8
ball_diameter = "11.9 mm"
pitch_diameter = "52 mm"
clearance = "1 mm"
f_inner = 0.6
f_outer = 0.6
stiffness = "1e14 N/m^1.5"
[[step]]
name = "fall"
type = "transient"
start = "rest"
duration = "0.4 s"
integrator = { tolerance = 1e-2 }
[output]
report = false
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_LT(d.summary("fall").at("energy").at("largest defect [J]").number(), 0.1);
}
