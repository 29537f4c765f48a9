// Work and energy over every kind of drive and motion of the base, in the general equations and in
// those of small motions: the balance closes, and the drive's work is in it.
#include "deck_run.hpp"

#include <io/file.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace io = whirl::io;
using whirl::test::DeckRun;

namespace {

struct Energy {
  double stored0, stored, supplied, dissipated, worst, share;
  std::string warnings;
};

Energy run(const std::string& deck) {
  const DeckRun d(deck);
  EXPECT_EQ(d.exit, 0) << d.log;
  if (d.exit != 0) return {};
  const io::Value s = d.summary("t");
  const io::Value& e = s.at("energy");
  return {e.at("stored at start [J]").number(),
          e.at("stored at end [J]").number(),
          e.at("supplied [J]").number(),
          e.at("dissipated [J]").number(),
          e.at("largest defect [J]").number(),
          s.at("accuracy").at("energy defect / energy turned over").number(),
          io::to_json(s.at("warnings"))};
}

/// A disk of 20 kg between two bearings on a damped shaft, unbalanced; parts: drives and the like;
/// step: keys of the transient.
std::string rotor(const std::string& bearings, const std::string& parts, const std::string& step) {
  return R"(format = 1
[model]
gravity = "9.81 m/s^2"
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40], ["b", 300, 40]]
[[disk]]
name = "disk"
at = "a:end"
mass = "20 kg"
Ip = "0.3 kg.m^2"
Id = "0.16 kg.m^2"
[[unbalance]]
at = "disk"
amount = "100 g.mm"
[[bearing]]
name = "thrust"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
cxx = "1e3 N.s/m"
)" + bearings +
         parts + R"([[step]]
name = "t"
type = "transient"
duration = "0.1 s"
integrator = { tolerance = 1e-6 }
checkpoint = "0 s"
)" + step +
         R"([output]
csv = false
report = false
)";
}

std::string pair(const std::string& law) {
  return "[[bearing]]\nname = \"L\"\nat = \"a:start\"\n" + law +
         "[[bearing]]\nname = \"R\"\nat = \"b:end\"\n" + law;
}
const std::string springs = pair(
    "type = \"linear\"\nkyy = \"4e6 N/m\"\nkzz = \"3e6 N/m\"\ncyy = \"500 N.s/m\"\nczz = \"500 "
    "N.s/m\"\n");
std::string drive(const std::string& law) { return "[[drive]]\nat = \"a:start\"\n" + law; }
const std::string constant_speed = drive("type = \"speed\"\nspeed = \"3000 rpm\"\n");
const std::string at_3000 = "initial_speed = \"3000 rpm\"\n";

/// What the balance must be closed to: 1e-4 of what is exchanged, a hundred times the accuracy
/// asked for (energy: twice the amplitude, over some hundred steps).
constexpr double closed = 1e-4;

void expect_closed(const Energy& e) {
  EXPECT_LT(e.share, closed) << e.worst << " J";
  EXPECT_EQ(e.warnings.find("energy balance"), std::string::npos) << e.warnings;
  EXPECT_LE(std::abs(e.stored - e.stored0 - e.supplied + e.dissipated),
            e.worst * (1 + 1e-9) + 1e-12);
}

}  // namespace

TEST(EnergyBalance, OfGeneralMotionsUnderEveryDrive) {
  struct Kind {
    const char* name;
    std::string parts, step;
  };
  const Kind kinds[] = {
      {"free", "", at_3000},
      {"constant speed", constant_speed, ""},
      {"speed that grows",
       drive("type = \"speed\"\nspeed = { type = \"ramp\", time = [\"0 s\", \"0.1 s\"], value = "
             "[\"1000 rpm\", \"3000 rpm\"] }\n"),
       ""},
      {"angle",
       drive("type = \"angle\"\nangle = { type = \"polynomial\", coefficients = [\"0 rad\", \"200 "
             "rad/s\", \"500 rad/s^2\"] }\n"),
       ""},
      {"torque", drive("type = \"torque\"\ntorque = \"50 N.m\"\n"), at_3000},
      {"torque of fixed direction",
       drive("type = \"torque\"\nkind = \"fixed_direction\"\ntorque = \"50 N.m\"\n"), at_3000},
      {"torque against speed",
       drive("type = \"torque\"\ncolumns = [\"speed[rpm]\", \"torque[N.m]\"]\nrows = [[0, 100], "
             "[6000, 10]]\n"),
       at_3000},
      {"load",
       drive("type = \"torque\"\nload = { constant = \"1 N.m\", viscous = \"0.01 N.m.s/rad\", "
             "quadratic = \"1e-4 N.m.s^2/rad^2\" }\n"),
       at_3000},
      {"induction motor",
       drive("type = \"torque\"\ninduction = { breakdown = \"100 N.m\", slip_breakdown = 0.1, "
             "synchronous = \"3100 rpm\" }\n"),
       at_3000},
      {"dc motor",
       drive("type = \"torque\"\ndc = { stall = \"100 N.m\", no_load_speed = \"4000 rpm\" }\n"),
       at_3000},
      {"constant power",
       drive(
           "type = \"torque\"\nconstant_power = { power = \"10 kW\", max_torque = \"100 N.m\" }\n"),
       at_3000},
      {"governor",
       drive("type = \"torque\"\ngovernor = { target = \"3500 rpm\", kp = \"1 N.m.s/rad\", ki = "
             "\"5 N.m/rad\" }\n"),
       at_3000},
      {"brake", drive("type = \"torque\"\nbrake = \"20 N.m\"\n"), at_3000},
      {"shaken base",
       constant_speed +
           "[base]\nz = { type = \"harmonic\", amplitude = \"5 m/s^2\", frequency = \"30 Hz\" }\n",
       ""},
      {"turning base", constant_speed + "[base.turn]\naxis = [0, 0, 1]\nrate = \"60 deg/s\"\n", ""},
      {"base that begins to turn",
       constant_speed + "[base.turn]\naxis = [0, 1, 0]\nrate = { type = \"smooth\", time = [\"0 "
                        "s\", \"0.1 s\"], value = [\"0 deg/s\", \"60 deg/s\"] }\n",
       ""},
      {"load in fixed directions",
       constant_speed + "[[load]]\nat = \"disk\"\nforce = [\"0 N\", \"100 N\", \"0 N\"]\nfactor = "
                        "{ type = \"harmonic\", amplitude = \"1\", frequency = \"20 Hz\" }\n",
       ""},
  };
  for (const Kind& k : kinds) {
    SCOPED_TRACE(k.name);
    expect_closed(run(rotor(springs, k.parts, k.step)));
  }
}

TEST(EnergyBalance, OfSmallMotionsUnderEverythingTheyTake) {
  struct Kind {
    const char* name;
    std::string bearings, parts, step;
  };
  const std::string film = pair(
      "type = \"short_journal\"\ndiameter = \"40 mm\"\nlength = \"20 mm\"\nclearance = \"100 "
      "um\"\nviscosity = \"30 mPa.s\"\n");
  const std::string table = pair(
      "type = \"table\"\ncolumns = [\"speed[rpm]\", \"kyy[N/m]\", \"kzz[N/m]\", \"kyz[N/m]\", "
      "\"kzy[N/m]\", \"cyy[N.s/m]\", \"czz[N.s/m]\"]\nrows = [[0, 4e6, 3e6, 1e5, -1e5, 500, 500], "
      "[6000, 5e6, 4e6, 2e5, -2e5, 500, 500]]\n");
  const std::string light = "[[unbalance]]\nat = \"b:end\"\namount = \"1 g.mm\"\n";
  const Kind kinds[] = {
      {"no drive", springs, "", at_3000},
      {"constant speed, from rest", springs, constant_speed, "start = \"rest\"\n"},
      {"constant speed, in equilibrium", springs, constant_speed, ""},
      {"in the unbalance response", springs, constant_speed, "start = \"unbalance_response\"\n"},
      {"angle", springs,
       drive("type = \"angle\"\nangle = { type = \"polynomial\", coefficients = [\"0 rad\", \"300 "
             "rad/s\"] }\n"),
       ""},
      {"two drives", springs,
       constant_speed + "[[drive]]\nat = \"b:end\"\ntype = \"speed\"\nspeed = \"3000 rpm\"\n", ""},
      {"backwards", springs, drive("type = \"speed\"\nspeed = \"-3000 rpm\"\n"), ""},
      {"shaken base", springs,
       constant_speed +
           "[base]\nz = { type = \"harmonic\", amplitude = \"5 m/s^2\", frequency = \"30 Hz\" }\n",
       ""},
      {"harmonic load", springs,
       constant_speed + "[[load]]\nat = \"disk\"\nforce = [\"0 N\", \"100 N\", \"0 N\"]\nfactor = "
                        "{ type = \"harmonic\", amplitude = \"1\", frequency = \"20 Hz\" }\n",
       ""},
      {"films", film, constant_speed + light, ""},
      {"tables", table, constant_speed, ""},
  };
  for (const Kind& k : kinds) {
    SCOPED_TRACE(k.name);
    const Energy linear = run(rotor(k.bearings, k.parts, k.step + "linear = true\n"));
    expect_closed(linear);
    if (std::string(k.name) == "films" || std::string(k.name) == "no drive")
      continue;  // there the general motion is another one: films, and a spin that falls
    // the same motion but for its second order. (What is supplied differs by the kinetic energy of
    // the spin, which twists back and forth in the general one.)
    const Energy general = run(rotor(k.bearings, k.parts, k.step));
    EXPECT_NEAR(linear.dissipated, general.dissipated, 0.005 * general.dissipated);
  }
}

TEST(EnergyBalance, OfAConservativeMotionIsMeasuredByWhatIsExchanged) {
  // A disk dropped onto springs without damping: nothing is supplied or dissipated; the exchange
  // between its kinetic and elastic energy is what the defect is a part of, not the defect itself.
  const std::string springs_alone =
      pair("type = \"linear\"\nkyy = \"4e6 N/m\"\nkzz = \"3e6 N/m\"\n");
  const Energy e = run(rotor(springs_alone, "", "start = \"rest\"\n" + at_3000));
  expect_closed(e);
}

// A rotor of three disks in 1500 mm of shaft, its unbalance switched on at 300 rad/s: after 1 s the
// drive has supplied 5.04e-3 J, which damping took up but for 6e-5 J, by the general equations and
// by the linear ones.
TEST(EnergyBalance, DriveOfSmallMotionsSupplies) {
  std::string text = R"(format = 1
[model]
gravity = "0 m/s^2"
mesh = { max_element_length = "75 mm" }
[[material]]
name = "bar"
E = "211 GPa"
G = "81.2 GPa"
density = "7810 kg/m^3"
[[shaft]]
name = "rotor"
material = "bar"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["s1", 375, 50], ["s2", 375, 50], ["s3", 375, 50], ["s4", 375, 50]]
)";
  for (int k = 1; k <= 3; ++k)
    text += "[[disk]]\nname = \"disk " + std::to_string(k) + "\"\nat = \"s" + std::to_string(k) +
            ":end\"\nod = \"280 mm\"\nid = \"50 mm\"\nwidth = \"40 mm\"\nmaterial = \"bar\"\n";
  const std::string law =
      "type = \"linear\"\nkyy = \"1e6 N/m\"\nkzz = \"0.8e6 N/m\"\ncyy = \"1000 N.s/m\"\nczz = "
      "\"1000 N.s/m\"\n";
  text += "[[bearing]]\nat = \"s1:start\"\n" + law + "[[bearing]]\nat = \"s4:end\"\n" + law +
          R"([[bearing]]
at = "s1:start"
type = "rigid"
directions = ["x"]
[[unbalance]]
at = "disk 2"
amount = "1e-4 kg.m"
[[unbalance]]
at = "disk 1"
amount = "5e-5 kg.m"
phase = "90 deg"
[[drive]]
at = "s1:start"
type = "speed"
speed = "300 rad/s"
[[step]]
name = "t"
type = "transient"
duration = "1 s"
start = "rest"
initial_speed = "300 rad/s"
linear = true
checkpoint = "0 s"
[output]
csv = false
report = false
)";
  const Energy e = run(text);
  expect_closed(e);
  EXPECT_NEAR(e.supplied, 5.04e-3, 0.01 * 5.04e-3);
  EXPECT_NEAR(e.dissipated, e.supplied, 0.02 * e.supplied);
}

// A prescribed speed that jumps puts the rotor's energy in by an impulse.
TEST(EnergyBalance, AJumpOfThePrescribedSpeedIsSupplied) {
  const Energy e = run(rotor(
      springs,
      drive("type = \"speed\"\nspeed = { type = \"piecewise\", pieces = [{ start = \"0 s\", law "
            "= \"0 rpm\" }, { start = \"0.04 s\", law = \"600 rpm\" }, { start = \"0.07 s\", "
            "law = \"-900 rpm\" }] }\n"),
      ""));
  expect_closed(e);
  EXPECT_GT(e.supplied, 1000.0);  // 0.3 kg m2 at 900 rpm
}

// What a drive supplies to a rotor that only turns is rounding: of large angles on a stiff shaft.
TEST(EnergyBalance, UndisturbedRotationIsNoAlarm) {
  int said = 0;  // where the defect is small beside the energy of the motion there is no need
  for (const char* speed : {"300 rpm", "30000 rpm"})
    for (const char* duration : {"0.05 s", "5 s"})
      for (const char* diameter : {"10", "200"}) {
        const DeckRun d(
            std::string("format = 1\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = \"r\"\n"
                        "material = \"steel\"\ncolumns = [\"name\", \"length[mm]\", "
                        "\"od[mm]\"]\nrows = [[\"a\", 500, ") +
            diameter +
            "]]\n[[bearing]]\nat = \"a:start\"\ntype = \"linear\"\nkyy = \"1e7 N/m\"\nkzz = "
            "\"2e7 N/m\"\n[[bearing]]\nat = \"a:end\"\ntype = \"linear\"\nkyy = \"1e7 N/m\"\n"
            "kzz = \"2e7 N/m\"\n[[drive]]\nat = \"a:start\"\ntype = \"speed\"\nspeed = \"" +
            speed + "\"\n[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"" + duration +
            "\"\n[output]\ncsv = false\n");
        ASSERT_EQ(d.exit, 0) << d.log;
        EXPECT_FALSE(d.says("energy balance")) << d.log;
        const std::string report = whirl::io::read_text(d.folder / "r" / "report.html");
        said += report.find("says nothing of the amplitudes") != std::string::npos;
      }
  EXPECT_GT(said, 0);
}

// Steps of a tenth of a turn with a scheme that damps: the amplitude is not to be trusted, and said so.
TEST(EnergyBalance, LongStepsAreAnAlarm) {
  std::string text = rotor(springs, constant_speed, "");
  const std::string careful = "integrator = { tolerance = 1e-6 }";
  text.replace(text.find(careful), careful.size(),
               "integrator = { method = \"generalized_alpha\", rho_inf = 0.2, dt = \"2 ms\" }");
  const DeckRun d(text);
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("do not trust the amplitudes")) << d.log;
}

// A rotor that starts on its orbit and stays there exchanges nothing; its amplitude is right to 1e-8.
TEST(EnergyBalance, ASteadyOrbitIsNoAlarm) {
  for (const char* stiffness : {"1e8", "1e9"}) {
    std::string bearings;
    for (const char* at : {"start", "end"})
      bearings += std::string("[[bearing]]\nat = \"r:") + at + "\"\ntype = \"linear\"\nkyy = \"" +
                  stiffness + " N/m\"\nkzz = \"" + stiffness + " N/m\"\nkxx = \"" + stiffness +
                  " N/m\"\n";
    const DeckRun d(
        "format = 1\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = \"r\"\nmaterial = "
        "\"steel\"\n"
        "columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 1000, 40]]\n" +
        bearings +
        "[[unbalance]]\nat = \"a:mid\"\namount = \"500 g.mm\"\n[[drive]]\nat = \"r:start\"\ntype = "
        "\"speed\"\nspeed = \"2000 rpm\"\n[[step]]\nname = \"t\"\ntype = \"transient\"\nstart = "
        "\"unbalance_response\"\nduration = \"0.1 s\"\nintegrator = { tolerance = 1e-4 }\n");
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_FALSE(d.says("energy balance")) << d.log;
  }
}
