// Magnetic bearings through the program: closed-loop poles and sensitivity of a rigid rotor (exact),
// motion against the exact solution of its linear equations, sensors elsewhere, a rotor that
// spins, equilibria that only control holds, a drop, messages.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace {

using whirl::test::Columns;
using whirl::test::DeckRun;

/// 30 kg, held in x and against tilting, on the magnets of `bearing`.
std::string mass(const std::string& bearing, const std::string& steps) {
  return R"(format = 1
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 100, true], ["right", 100, true]]
[[disk]]
name = "mass"
at = "left:end"
mass = "30 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
name = "guide"
at = "mass"
type = "rigid"
directions = ["x", "rx", "ry", "rz"]
[[bearing]]
name = "AMB"
at = "mass"
type = "magnetic"
)" + bearing +
         "[[probe]]\nname = \"P\"\nat = \"mass\"\n" + steps + "[output]\nreport = false\n";
}
const std::string magnet = R"(current_stiffness = "250 N/A"
position_stiffness = "1.5e6 N/m"
sensor_bandwidth = "4000 Hz"
amplifier_bandwidth = "1200 Hz"
)";
std::string control(double p, double i, double d) {
  return fmt::format(
      "[[bearing.control]]\ntype = \"pid\"\np = \"{} A/m\"\ni = \"{} A/(m.s)\"\nd = \"{} "
      "A.s/m\"\nlag = \"53 us\"\n",
      p, i, d);
}
const std::string modal =
    "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 2\nmax_frequency = \"5000 Hz\"\n";
const std::string loops =
    "[[step]]\nname = \"s\"\ntype = \"sensitivity\"\nfrequency = { start = \"1 Hz\", stop = \"2000 "
    "Hz\", points = 300 }\n";
const std::string still = "[[step]]\nname = \"st\"\ntype = \"static\"\n";

// Without damping enough the loop grows at 43.5 Hz. Sensitivities asked for up to 10 Hz were 0.76 and
// "zone A".
TEST(MagneticBearings, LoopsThatGrowBeyondTheFrequenciesAskedForHaveNoZone) {
  const std::string low =
      "[[step]]\nname = \"s\"\ntype = \"sensitivity\"\nfrequency = { start = \"1 Hz\", stop = \"10 "
      "Hz\", points = 10 }\n";
  const DeckRun d(mass(magnet + control(1.5e4, 0, 0.5), low));
  EXPECT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("zone A")) << d.log;
  EXPECT_TRUE(d.says("unstable: 2 growing motions")) << d.log;
  const DeckRun damped(mass(magnet + control(1.5e4, 0, 32), low));
  EXPECT_TRUE(damped.says("no zone: a loop's sensitivity is largest at an end")) << damped.log;
}

// An amplifier that answers in 1e300 s leaves a loop open without end; no count of the roots can say
// whether it grows. The list said "zone A" all the same.
TEST(MagneticBearings, ALoopWhoseRootsCannotBeCountedHasNoZone) {
  std::string endless = magnet;
  endless.replace(endless.find("1200 Hz"), 7, "1e-300 Hz");
  const DeckRun d(mass(endless + control(1.5e4, 0, 32), loops));
  EXPECT_EQ(d.exit, 4) << d.log;
  EXPECT_FALSE(d.says("zone A")) << d.log;
  EXPECT_TRUE(d.says("W07")) << d.log;
}

// A controller of both axes as one set of matrices: p + d s/(1 + lag s) on the axes and a gain across
// them, as control and cross have it.
TEST(MagneticBearings, OneControllerOfBothAxes) {
  constexpr double p = 1.5e4, d = 32, lag = 53e-6, across = 600;
  const auto entry = [](int row, int column, double value) {
    return fmt::format("[{}, {}, {:.17g}], ", row, column, value);
  };
  std::string rows;
  for (const int k : {1, 2}) {
    rows += entry(k, k, -1 / lag) + entry(k, k + 2, 1 / lag);
    rows += entry(k + 2, k, -d / lag) + entry(k + 2, k + 2, p + d / lag);
  }
  rows += entry(3, 4, across) + entry(4, 3, -across);
  const std::string both =
      "[bearing.control_both]\norder = 2\ngain = \"1 A/m\"\ncolumns = [\"row\", \"column\", "
      "\"value\"]\nrows = [" +
      rows + "]\n";
  const std::string cross =
      fmt::format("[[bearing.cross]]\ntype = \"pid\"\np = \"{} A/m\"\n", across);
  const auto modes_of = [](const std::string& bearing) {  // runs of one test share a folder
    const DeckRun run(mass(bearing, modal));
    EXPECT_EQ(run.exit, 0) << run.log;
    return run.csv("m_modes.csv");
  };
  const Columns got = modes_of(magnet + both), want = modes_of(magnet + control(p, 0, d) + cross),
                without = modes_of(magnet + control(p, 0, d));
  ASSERT_EQ(got.rows.size(), want.rows.size());
  ASSERT_GE(got.rows.size(), 2u);
  for (std::size_t k = 0; k < got.rows.size(); ++k)
    for (const char* column : {"frequency [Hz]", "damping ratio [-]"})
      EXPECT_NEAR(got.rows[k][got.column(column)], want.rows[k][want.column(column)],
                  1e-9 * std::abs(want.rows[k][want.column(column)]));
  // the gain across the axes does something
  EXPECT_GT(std::abs(got.rows[0][got.column("damping ratio [-]")] -
                     without.rows[0][without.column("damping ratio [-]")]),
            1e-4);
  const auto fails = [](const std::string& bearing, const char* code, const char* text) {
    const DeckRun run(mass(bearing, still));
    EXPECT_NE(run.exit, 0);
    EXPECT_TRUE(run.says(code) && run.says(text)) << run.log;
  };
  fails(magnet + both + control(p, 0, d), "error[E26]", "both axes");
  std::string large = both;
  large.replace(large.find("[3, 4"), 5, "[3, 5");
  fails(magnet + large, "error[E14]", "4 rows and columns");
}

// m 30 kg, k_s 1.5e6 N/m, k_i 250 N/A, PID 1.5e4 A/m, 1e5 A/(m s), 32 A s/m with lag 53 us, amplifier
// 1200 Hz, sensor 4000 Hz: roots of the characteristic polynomial, and the largest |1/(1 + L)|.
TEST(MagneticBearings, PolesAndSensitivityOfARigidRotor) {
  const DeckRun d(mass(magnet + control(1.5e4, 1e5, 32), still + modal + loops));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns modes = d.csv("m_modes.csv"), real = d.csv("m_real_roots.csv");
  for (const auto& row : modes.rows) {
    EXPECT_NEAR(row[modes.column("frequency [Hz]")] * 2 * M_PI, 247.593409226, 1e-7);
    EXPECT_NEAR(row[modes.column("damping ratio [-]")],
                124.132810086 / std::hypot(124.132810086, 247.593409226), 1e-9);
  }
  for (const double rate : {-11.549881174}) {
    EXPECT_EQ(std::count_if(real.rows.begin(), real.rows.end(),
                            [&](const auto& row) { return std::abs(row[0] - rate) < 1e-8; }),
              2)
        << rate;
  }
  const Columns s = d.csv("s_sensitivity.csv");
  ASSERT_EQ(s.rows.size(), 2u);
  for (const auto& row : s.rows) {
    EXPECT_NEAR(row[s.column("largest sensitivity [-]")], 1.968359750, 1e-8);
    EXPECT_NEAR(row[s.column("largest sensitivity [dB]")], 5.88208951, 1e-7);
    EXPECT_NEAR(row[s.column("frequency [Hz]")], 46.4978, 1e-3);
  }
  EXPECT_TRUE(d.says("zone A")) << d.log;
  // S (1 + L) = 1
  const Columns curves = d.csv("s_curves.csv");
  for (const auto& row : curves.rows)
    EXPECT_NEAR(row[1] * std::hypot(1 + row[3], row[4]), 1, 1e-9);
}

// The weight comes at once: exact by the eigenvectors of the six first-order equations.
TEST(MagneticBearings, MotionUnderItsWeight) {
  const DeckRun d(mass(magnet + control(1.5e4, 1e5, 32),
                       "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"100 ms\"\nstart "
                       "= \"rest\"\nintegrator = { tolerance = 1e-8 }\n") +
                  "every = \"1 ms\"\nquantities = [\"probes\", \"control\", \"energy\"]\n");
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("t.csv");
  const std::size_t z = t.column("P.z [m]"), current = t.column("bearing AMB current.2 [A]");
  struct At {
    double t, z, i;
  };
  for (const At& x : {At{2e-3, -1.70669882745e-05, 0.6710705439413},
                      At{10e-3, -0.0001461011793736, 2.458146274206},
                      At{30e-3, -9.685580896525e-05, 1.758879997276},
                      At{100e-3, -4.441020182912e-05, 1.442542533697}}) {
    const auto row = std::find_if(t.rows.begin(), t.rows.end(),
                                  [&](const auto& r) { return std::abs(r[0] - x.t) < 1e-9; });
    ASSERT_NE(row, t.rows.end());
    EXPECT_NEAR((*row)[z], x.z, 3e-10);
    EXPECT_NEAR((*row)[current], x.i, 1e-5);
  }
}

// The mass is held, the setpoint 0.1 mm away: 1.5 A are asked for at once, and the current follows
//   i' = D/(1 + |D/r|^8)^(1/8), D = w (1.5 A - i), w = 2 pi 1200 Hz, r = 2000 A/s (D begins at
// 11310 A/s), t(i) by Simpson's rule.
TEST(MagneticBearings, CurrentOfLimitedRate) {
  const std::string steps =
      "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"3 ms\"\nstart = \"rest\"\n"
      "integrator = { tolerance = 1e-8 }\n";
  const std::string amplifier =
      "current_stiffness = \"250 N/A\"\nposition_stiffness = \"1.5e6 N/m\"\namplifier_bandwidth = "
      "\"1200 Hz\"\nsetpoint = [\"0 um\", \"100 um\"]\n";
  const std::string gain = "[[bearing.control]]\ntype = \"pid\"\np = \"1.5e4 A/m\"\n";
  const auto run = [&](const std::string& limit) {
    std::string deck = mass(amplifier + limit + gain, steps);
    deck.replace(deck.find("\"x\", "), 5, "\"x\", \"y\", \"z\", ");
    const DeckRun d(deck + "every = \"0.1 ms\"\nquantities = [\"control\", \"energy\"]\n");
    EXPECT_EQ(d.exit, 0) << d.log;
    return d.csv("t.csv");
  };
  constexpr double w = 2 * M_PI * 1200, goal = 1.5, r = 2000;
  const Columns f = run(""), b = run("max_current_rate = \"2000 A/s\"\n");
  const std::size_t current = b.column("bearing AMB current.2 [A]");
  for (const auto& row : f.rows)
    EXPECT_NEAR(row[current], goal * (1 - std::exp(-w * row[0])), 1e-6) << row[0];
  const auto time_to = [&](double i) {
    constexpr int n = 2000;
    double sum = 0;
    for (int k = 0; k <= n; ++k) {
      const double D = w * (goal - i * k / n);
      sum += (k == 0 || k == n ? 1
              : k % 2 == 1     ? 4
                               : 2) *
             std::pow(1 + std::pow(D / r, 8), 0.125) / D;
    }
    return sum * i / (3 * n);
  };
  ASSERT_GT(b.rows.size(), 20u);
  for (const auto& row : b.rows)
    if (row[current] < 0.99 * goal) {
      EXPECT_NEAR(time_to(row[current]), row[0], 2e-8) << row[current];
    }
  EXPECT_NEAR(b.last()["bearing AMB current.2 [A]"], goal, 1e-4);
}

// Small motions know no limit: poles and sensitivity are the exact ones of the linear loop.
TEST(MagneticBearings, SmallMotionsBelowTheLimitOfTheRate) {
  const DeckRun d(mass(magnet + "max_current_rate = \"500 A/s\"\n" + control(1.5e4, 1e5, 32),
                       still + modal + loops));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns modes = d.csv("m_modes.csv"), s = d.csv("s_sensitivity.csv");
  ASSERT_EQ(modes.rows.size(), 2u);
  for (const auto& row : modes.rows)
    EXPECT_NEAR(row[modes.column("frequency [Hz]")] * 2 * M_PI, 247.593409226, 1e-7);
  for (const auto& row : s.rows)
    EXPECT_NEAR(row[s.column("largest sensitivity [-]")], 1.968359750, 1e-8);
  EXPECT_TRUE(d.says("zone A")) << d.log;
}

// What a table of coefficients says of it: -k_s + k_i G(i w) at the frequency of the spin.
TEST(MagneticBearings, SynchronousCoefficients) {
  std::string deck = mass(magnet + "angle = \"30 deg\"\n" + control(1.5e4, 1e5, 32),
                          "[[step]]\nname = \"st\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n");
  deck.replace(deck.find("\"rx\", "), 6, "");
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns c = d.csv("st_coefficients.csv");
  const double w = 100 * M_PI;
  const std::complex<double> s(0, w);
  const std::complex<double> G = (1.5e4 + 1e5 / s + 32.0 * s / (1.0 + 53e-6 * s)) /
                                 (1.0 + s / (2 * M_PI * 1200)) / (1.0 + s / (2 * M_PI * 4000));
  const std::complex<double> Z = -1.5e6 + 250.0 * G;
  for (const char* k : {"kyy [N/m]", "kzz [N/m]"})
    EXPECT_NEAR(c.rows.at(0)[c.column(k)], Z.real(), 1e-9 * std::abs(Z));
  for (const char* k : {"cyy [N s/m]", "czz [N s/m]"})
    EXPECT_NEAR(c.rows.at(0)[c.column(k)] * w, Z.imag(), 1e-9 * std::abs(Z));
  EXPECT_NEAR(c.rows.at(0)[c.column("kyz [N/m]")], 0, 1e-9 * std::abs(Z));
}

/// A rigid rotor on a spring at -0.2 m, a magnet in the middle and its sensor at 0.1 m.
std::string lever(const std::string& steps) {
  return R"deck(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 200, true], ["right", 100, true]]
[[disk]]
name = "mass"
at = "left:end"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
name = "spring"
at = "left:start"
type = "linear"
kxx = "1e6 N/m"
kyy = "3e5 N/m"
kzz = "3e5 N/m"
cyy = "200 N.s/m"
czz = "200 N.s/m"
[[bearing]]
name = "AMB"
at = "mass"
type = "magnetic"
current_stiffness = "200 N/A"
position_stiffness = "1e5 N/m"
sensor_at = "right:end"
sensor_bandwidth = "500 Hz"
amplifier_bandwidth = "300 Hz"
delay = "200 us"
[[bearing.control]]
type = "pid"
p = "5000 A/m"
i = "2e4 A/(m.s)"
d = "20 A.s/m"
lag = "500 us"
[[probe]]
name = "end"
at = "right:end"
)deck" + steps +
         "[output]\nreport = false\n";
}
std::string shaken(const char* speed) {
  return fmt::format(
      "[[step]]\nname = \"h\"\ntype = \"harmonic_response\"\nrotor_speed = \"{0}\"\nfrequency = "
      "{{ values = [\"30 Hz\"] }}\n[[step.force]]\nat = \"mass\"\nforce = [\"0 N\", \"100 N\", "
      "\"200 "
      "N\"]\n[[step]]\nname = \"s\"\ntype = \"sensitivity\"\nspeed = \"{0}\"\nfrequency = {{ "
      "values "
      "= [\"30 Hz\"] }}\nabout = \"undeformed\"\n",
      speed);
}

// Four equations of motion with gyroscopic moments, the control force on the middle from the
// displacement of the end, solved apart from the program.
TEST(MagneticBearings, SensorElsewhereAndSpin) {
  struct Case {
    const char* speed;
    double y, z, sensitivity;
  };
  for (const Case& c :
       {Case{"0 rpm", 0.0001006774395609, 0.0002013548791218, 0.3259632519219},
        Case{"6000 rpm", 7.165925231084e-05, 0.0002465533918588, 0.6049556469263}}) {
    const DeckRun d(lever(shaken(c.speed)));
    ASSERT_TRUE(std::filesystem::exists(d.folder / "r/h_response.csv")) << d.log;
    const Columns h = d.csv("h_response.csv"), s = d.csv("s_sensitivity.csv");
    EXPECT_NEAR(h.last()["end y amplitude [m]"], c.y, 1e-12);
    EXPECT_NEAR(h.last()["end z amplitude [m]"], c.z, 1e-12);
    EXPECT_NEAR(s.rows.front()[s.column("largest sensitivity [-]")], c.sensitivity, 1e-9);
  }
}

// k_i p < k_s diverges, which no negative eigenvalue of the static tangent need show: two axes alike
// have a positive determinant. One alone has a negative one.
TEST(MagneticBearings, EquilibriumIsNotCalledStableWhereControlDecides) {
  {
    const DeckRun d(mass(magnet + control(5e3, 0, 32), still + modal + loops));
    EXPECT_FALSE(d.says("unstable equilibrium")) << d.log;
    EXPECT_TRUE(d.says("whether controllers hold it is for a modal")) << d.log;
    EXPECT_TRUE(d.says("2 diverging")) << d.log;
    EXPECT_TRUE(d.says("unstable: 2 growing motions, sensitivities are no margins")) << d.log;
    EXPECT_TRUE(d.says("W13") && d.says("most of it at the sensor of")) << d.log;
  }
  std::string second = control(1.5e4, 0, 32);
  second.replace(second.find("control"), 7, "control_2");
  const DeckRun d(mass(magnet + control(5e3, 0, 32) + second, still + modal));
  EXPECT_TRUE(d.says("unstable equilibrium, 1 direction: it diverges at any mass and damping"))
      << d.log;
  EXPECT_TRUE(d.says("1 diverging")) << d.log;
}

// What controllers drive no energy bounds: stability is looked for up to their bandwidth, whatever
// the number of modes. A stage that is unstable by itself grows at every speed, far from the modes
// asked for.
TEST(MagneticBearings, StabilityIsLookedForUpToTheBandwidth) {
  const std::string stability =
      "[[step]]\nname = \"g\"\ntype = \"stability\"\nspeed = { start = \"0 rpm\", stop = \"3000 "
      "rpm\", "
      "points = 3 }\nmodes = 2\n";
  const std::string growing =
      "[[bearing.control]]\ntype = \"transfer\"\nnumerator = [1]\ndenominator = [-0.001, 1]\n";
  const auto turning = [&](const std::string& bearing) {
    std::string deck = mass(bearing, stability);
    deck.replace(deck.find("\"rx\", "), 6, "");
    return deck;
  };
  const DeckRun d(turning(magnet + control(1.5e4, 1e5, 32) + growing));
  EXPECT_TRUE(d.says("unstable at 0 rpm already (a motion diverges")) << d.log;
  EXPECT_FALSE(d.says(" stable")) << d.log;
  const Columns v = d.csv("g_verdicts.csv");
  for (const auto& row : v.rows)
    EXPECT_GE(row[v.column("fastest growth [1/s]")], 200) << row[0];
  const DeckRun good(turning(magnet + control(1.5e4, 1e5, 32)));
  const Columns c = good.csv("g_verdicts.csv");
  for (const auto& row : c.rows)
    EXPECT_GE(row[c.column("roots counted up to [Hz]")], 1200) << row[0];
}

// Magnets without power let go: free fall onto the catcher bearing, and every joule accounted for.
TEST(MagneticBearings, DropOnACatcher) {
  const std::string power =
      "power = { type = \"table\", time = [\"0 s\", \"10 ms\", \"10.0001 ms\"], value = [1, 1, 0] "
      "}\n";
  const DeckRun d(
      mass(R"(current_stiffness = "250 N/A"
bias_current = "3 A"
gap = "0.5 mm"
sensor_bandwidth = "4000 Hz"
amplifier_bandwidth = "1200 Hz"
)" + power + control(1.5e4, 1e5, 32) +
               R"([[bearing]]
name = "catcher"
at = "mass"
type = "rub"
gap = "0.2 mm"
stiffness = "2e7 N/m"
damping = "0.5 s/m"
diameter = "80 mm"
)",
           still + "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"40 ms\"\nfrom = "
                   "\"st\"\nintegrator = { tolerance = 1e-8 }\n") +
      "every = \"0.1 ms\"\nquantities = [\"probes\", \"control\", \"energy\"]\n");
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("t.csv");
  const std::size_t z = t.column("P.z [m]");
  double lowest = 0;
  for (const auto& row : t.rows) {
    if (row[0] < 10e-3) {
      EXPECT_NEAR(row[z], 0, 1e-9) << row[0];
    }
    if (row[0] > 10.2e-3 && row[0] < 15e-3) {
      EXPECT_NEAR(row[z], -0.5 * 9.80665 * std::pow(row[0] - 10e-3, 2), 3e-8) << row[0];
    }
    lowest = std::min(lowest, row[z]);
  }
  EXPECT_LT(lowest, -0.2e-3);
  EXPECT_GT(lowest, -0.35e-3);
  // against what the fall set free
  EXPECT_LT(std::abs(d.summary("t").at("energy").at("largest defect [J]").number()),
            1e-6 * 30 * 9.80665 * 0.2e-3);
}

TEST(MagneticBearings, Messages) {
  const auto says = [](const std::string& bearing, const std::string& steps,
                       const std::string& text) {
    const DeckRun d(mass(bearing, steps));
    EXPECT_EQ(d.exit, 3) << d.log;
    EXPECT_TRUE(d.says(text)) << text << "\n" << d.log;
  };
  const std::string pid = control(1.5e4, 1e5, 32);
  const std::string strong = "current_stiffness = \"250 N/A\"\namplifier_bandwidth = \"1 kHz\"\n";
  says(magnet, still, "has no controller");
  says(magnet + pid + pid, still, "2 stages of the controller make current of displacement");
  says(magnet + "[[bearing.control]]\ntype = \"notch\"\nfrequency = \"50 Hz\"\n", still,
       "no stage of the controller makes current");
  says(magnet + "[[bearing.control]]\ntype = \"pid\"\np = \"1 A/m\"\nd = \"1 A.s/m\"\n", still,
       "the derivative needs a lag");
  says(strong + pid, still, "has no position stiffness");
  says(strong + "position_stiffness = \"1 MN/m\"\nbias_current = \"2 A\"\n" + pid, still,
       "needs the bias current and the gap");
  says(strong + "position_stiffness = \"2 MN/m\"\nbias_current = \"2 A\"\ngap = \"0.5 mm\"\n" + pid,
       still, "has at most");
  says(strong + "bias_current = \"2 A\"\ngap = \"0.5 mm\"\nsaturation = \"100 N\"\n" + pid, still,
       "the bias current alone pulls");
  says(magnet + "saturation = \"100 N\"\n" + pid, still, "a linear force law does not saturate");
  says(
      magnet + pid +
          "[[bearing.control]]\ntype = \"transfer\"\nnumerator = [1, 2, 3]\ndenominator = [1, 2]\n",
      still, "higher degree");
  for (const char* step : {"type = \"critical_speeds\"\nmax_speed = \"6000 rpm\"\n",
                           "type = \"modal\"\ndamping = \"undamped\"\n", "type = \"buckling\"\n"})
    says(magnet + pid, "[[step]]\nname = \"u\"\n" + std::string(step),
         "nothing of what controls magnetic bearing 'AMB'");
  const DeckRun none(
      "format = 1\n[shaft]\nname = \"r\"\nmaterial = \"steel\"\ncolumns = [\"length[mm]\", "
      "\"od[mm]\"]\nrows = [[100, 20]]\n[[bearing]]\nname = \"B\"\nat = \"0 m\"\ntype = "
      "\"rigid\"\ndirections = [\"x\", \"y\", \"z\", \"ry\", \"rz\"]\n" +
      loops);
  EXPECT_TRUE(none.says("no bearing is magnetic")) << none.log;
}

}  // namespace

// At 100 Hz the rotor moves along its axis on a spring that nothing damps, and no loop sees.
TEST(MagneticBearings, SensitivityBesideAMotionThatNoLoopSees) {
  std::string deck = mass(magnet + control(1.5e4, 1e5, 32),
                          "[[bearing]]\nname = \"spring\"\nat = \"mass\"\ntype = \"linear\"\n"
                          "kxx = \"11843525.281307230 N/m\"\n"
                          "[[step]]\nname = \"s\"\ntype = \"sensitivity\"\n"
                          "frequency = { values = [\"99 Hz\", \"100 Hz\", \"101 Hz\"] }\n");
  const std::string held = "\"x\", \"rx\"";
  deck.replace(deck.find(held), held.size(), "\"rx\"");
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("s_curves.csv");
  const std::size_t k = t.column("AMB axis 1 sensitivity [-]");
  const double before = t.rows.at(0).at(k), there = t.rows.at(1).at(k), behind = t.rows.at(2).at(k);
  EXPECT_NEAR(there, 0.5 * (before + behind), 1e-4);
}

// 294 N of weight; an integrator asks for ever more current, and nothing else resists.
TEST(MagneticBearings, ALoadBeyondTheirCapacityIsSaid) {
  const std::string pid = control(1.5e4, 1e5, 32);
  const DeckRun current(mass(magnet + "max_current = \"1 A\"\n" + pid, still));
  EXPECT_NE(current.exit, 0);
  EXPECT_TRUE(current.says("error[E76]")) << current.log;
  EXPECT_TRUE(current.says("the supports carry 0.848 of the load")) << current.log;
  EXPECT_TRUE(current.says("axis 2 of magnetic bearing 'AMB' carries 249.4 N of at most 250 N"))
      << current.log;
  const DeckRun saturated(
      mass("current_stiffness = \"250 N/A\"\namplifier_bandwidth = \"1.2 kHz\"\nbias_current = "
           "\"2 A\"\ngap = \"0.5 mm\"\nsaturation = \"280 N\"\n" +
               pid,
           still));
  EXPECT_TRUE(saturated.says("error[E76]")) << saturated.log;
  EXPECT_TRUE(saturated.says("N of at most 280 N")) << saturated.log;
}

// A fast amplifier with a slow delay grows at 447 and 1,580 Hz, far above the amplifier's 300 Hz and
// the frequencies asked for, at whose end the sensitivity is largest: "zone A" for both.
TEST(MagneticBearings, FastLoopsAreSearchedAsFarAsTheyAct) {
  const DeckRun d(
      mass("current_stiffness = \"200 N/A\"\nposition_stiffness = \"1e6 "
           "N/m\"\namplifier_bandwidth = \"300 Hz\"\ndelay = \"250 "
           "us\"\n[[bearing.control]]\ntype = \"pid\"\np = \"4e4 A/m\"\nd = \"900 "
           "A.s/m\"\nlag = \"30 us\"\n",
           "[[step]]\nname = \"s\"\ntype = \"sensitivity\"\nfrequency = { start = \"1 "
           "Hz\", stop = \"200 Hz\", points = 50 }\n"));
  EXPECT_TRUE(d.says("unstable: 2 growing motions")) << d.log;
  const DeckRun low(
      mass(magnet + control(1.5e4, 0, 32),
           "[[step]]\nname = \"s\"\ntype = \"sensitivity\"\nfrequency = { start = \"1 Hz\", stop "
           "= \"20 Hz\", points = 50 }\n"));
  EXPECT_TRUE(low.says("no zone: a loop's sensitivity is largest at an end")) << low.log;
}

// 30 kg hang 0.75 mm below the middle of a gap of 0.5 mm: an equilibrium on paper, and a shaft that
// lies on its poles.
TEST(MagneticBearings, AShaftInThePolesIsSaid) {
  const auto deck = [](const char* p) {
    return mass(fmt::format("current_stiffness = \"200 N/A\"\nbias_current = \"3 A\"\ngap = \"0.5 "
                            "mm\"\namplifier_bandwidth = \"2.5 kHz\"\n[[bearing.control]]\ntype = "
                            "\"pid\"\np = \"{} A/m\"\nd = \"20 A.s/m\"\nlag = \"30 us\"\n",
                            p),
                still + modal +
                    "[[step]]\nname = \"h\"\ntype = \"harmonic_response\"\nfrequency = { values = "
                    "[\"20 Hz\"] }\nforce = [{ at = \"mass\", force = [\"0 N\", \"5000 N\", \"0 "
                    "N\"] }]\n");
  };
  const DeckRun weak(deck("10000"));
  EXPECT_TRUE(
      weak.says("of magnetic bearing 'AMB' at the equilibrium at 0 rpm of step 'st', whose "
                "air gap is 0.5 mm"))
      << weak.log;
  EXPECT_TRUE(weak.says("of step 'm', whose air gap")) << weak.log;
  const DeckRun strong(deck("15000"));
  EXPECT_FALSE(strong.says("of step 'st', whose air gap")) << strong.log;
  EXPECT_TRUE(strong.says("W11")) << strong.log;
}

// 30 N along y and the weight of 10 kg along z, held in the middle by the integral.
TEST(MagneticBearings, CarryEachForceAlongItsOwnAxis) {
  const DeckRun run(whirl::test::lateral_mass(10, "9.81 m/s^2", R"deck([[bearing]]
name = "AMB"
at = "mass"
type = "magnetic"
current_stiffness = "200 N/A"
position_stiffness = "1e5 N/m"
sensor_bandwidth = "500 Hz"
amplifier_bandwidth = "300 Hz"
delay = "200 us"
[[bearing.control]]
type = "pid"
p = "5000 A/m"
i = "2e4 A/(m.s)"
d = "10 A.s/m"
lag = "0.5 ms"
[[load]]
at = "mass"
force = ["0 N", "30 N", "0 N"]
[output]
report = false
[[step]]
name = "st"
type = "static"
)deck",
                                              R"("x", "rx", "ry", "rz")"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const whirl::io::Value force = run.summary("st").at("support forces [N]").at("AMB");
  const double wanted[] = {0, -30, 98.1};
  for (const std::size_t k : {0, 1, 2})
    EXPECT_NEAR(force.items().at(k).number(), wanted[k], 1e-6) << k;
  // i = F/k_i
  EXPECT_NEAR(run.summary("st")
                  .at("magnetic bearings")
                  .at("AMB")
                  .at("largest control current [A]")
                  .number(),
              98.1 / 200, 1e-6);
}
