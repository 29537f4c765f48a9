// Direction of whirl is that of the spin: a machine and its mirror image (every vector reflected in
// the plane z = 0, every spin the other way) get the same words and the same signs, whatever it
// consists of.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <random>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

/// Cells of a CSV file as they stand.
std::vector<std::vector<std::string>> cells_of(const std::filesystem::path& csv) {
  std::vector<std::vector<std::string>> out;
  std::ifstream in(csv);
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    out.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');)
      out.back().push_back(cell);
  }
  return out;
}

bool is_number(const std::string& cell) { return !std::isnan(Columns::number(cell)); }

/// Rotors (one, or two that turn either way) in a casing on feet, one bearing on a pedestal of its
/// own: all drawn at random. mirror = -1: its image.
std::string machine(unsigned seed, double mirror) {
  std::mt19937 random(seed);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(random);
  };
  std::string deck = "format = 1\n[output]\nreport = false\n";
  deck += fmt::format("[model]\ngravity_vector = [\"{} m/s^2\", \"{} m/s^2\", \"{} m/s^2\"]\n",
                      draw(-1, 1), draw(-9, 9), mirror * draw(-9, 9));
  const int rotors = seed % 2 ? 2 : 1;
  const double second = seed % 4 == 1 ? -draw(0.6, 1.4) : draw(1.1, 1.6);
  const auto support = [&](const std::string& name, const std::string& at, const std::string& rest,
                           double k) {
    const double kyy = k * draw(0.8, 1.2), kzz = k * draw(0.8, 1.2), kyz = 0.1 * k * draw(-1, 1),
                 kzy = 0.1 * k * draw(-1, 1);
    return fmt::format(
        "[[bearing]]\nname = \"{}\"\nat = \"{}\"\n{}type = \"linear\"\nkxx = \"{} N/m\"\nkyy = "
        "\"{} N/m\"\nkzz = \"{} N/m\"\nkyz = \"{} N/m\"\n"
        "kzy = \"{} N/m\"\ncyy = \"{} N.s/m\"\nczz = \"{} N.s/m\"\nkryy = \"{} N.m/rad\"\nkrzz = "
        "\"{} N.m/rad\"\nkrxx = \"{} N.m/rad\"\n",
        name, at, rest, k, kyy, kzz, mirror * kyz, mirror * kzy, 1e-4 * k, 1e-4 * k, 1e-3 * k,
        1e-3 * k, name.starts_with("foot") ? 1e-2 * k : 0.0);
  };
  std::string bearings;
  for (int r = 0; r < rotors; ++r) {
    const double ratio = mirror * (r == 0 ? 1.0 : second), z = mirror * 0.05 * r;
    deck += fmt::format(
        "[[shaft]]\nname = \"r{0}\"\nmaterial = \"steel\"\nspeed_ratio = {1}\norigin = [\"{2} m\", "
        "\"0 m\", \"{3} m\"]\ncolumns = [\"name\", \"length[m]\", \"od[m]\", "
        "\"min_elements\"]\nrows = [[\"a{0}\", {4}, {5}, 2], [\"b{0}\", {6}, {5}, 2]]\n",
        r, ratio, 0.05 * r, z, draw(0.2, 0.3), draw(0.03, 0.05), draw(0.2, 0.3));
    deck += fmt::format(
        "[[disk]]\nname = \"d{0}\"\nat = \"r{0}/a{0}:end\"\nmass = \"{1} kg\"\nIp = \"{2} "
        "kg.m^2\"\nId = \"{3} kg.m^2\"\n",
        r, draw(4, 12), draw(0.08, 0.12), draw(0.07, 0.1));
    deck += fmt::format(
        "[[unbalance]]\nat = \"d{0}\"\namount = \"1 g.mm\"\nphase = \"{1} deg\"\n[[probe]]\nname = "
        "\"p{0}\"\nat = \"d{0}\"\n",
        r, mirror * draw(-180, 180));
    bearings += support(fmt::format("left{}", r), fmt::format("r{0}/a{0}:start", r),
                        fmt::format("to = \"casing/{} m\"\n", 0.1 + 0.05 * r), draw(1e6, 3e7));
    const bool pedestal = r == 0 && seed % 3 == 0;
    bearings += support(fmt::format("right{}", r), fmt::format("r{0}/b{0}:end", r),
                        pedestal ? "" : fmt::format("to = \"casing/{} m\"\n", 0.6 + 0.05 * r),
                        draw(1e6, 3e7));
    if (pedestal) {
      const double k = draw(1e7, 5e7);
      bearings += fmt::format(
          "support = {{ mass = \"{} kg\", kxx = \"{} N/m\", kyy = \"{} N/m\", kzz = \"{} N/m\" "
          "}}\n",
          draw(2, 8), k, k, 1.3 * k);
    }
  }
  deck +=
      "[[shaft]]\nname = \"casing\"\nmaterial = \"steel\"\nrotating = false\norigin = [\"-0.1 m\", "
      "\"0 m\", \"0 m\"]\ncolumns = [\"name\", \"length[m]\", \"od[m]\", \"id[m]\", "
      "\"min_elements\"]\n"
      "rows = [[\"c\", 0.9, 0.3, 0.29, 4]]\n[[probe]]\nname = \"pc\"\nat = \"casing/0.4 m\"\n";
  bearings += support("foot1", "casing/c:start", "", draw(5e6, 5e7)) +
              support("foot2", "casing/c:end", "", draw(5e6, 5e7));
  const double speed = draw(1000, 9000);
  return deck + bearings +
         fmt::format(R"([[step]]
name = "m"
type = "modal"
speed = "{0} rpm"
modes = 14
[[step]]
name = "rest"
type = "modal"
modes = 14
[[step]]
name = "c"
type = "campbell"
speed = {{ start = "500 rpm", stop = "{0} rpm", points = 4 }}
modes = 10
[[step]]
name = "u"
type = "unbalance_response"
speed = {{ start = "{1} rpm", stop = "{0} rpm", points = 7, refine = "no" }}
[[step]]
name = "h"
type = "harmonic_response"
rotor_speed = "{0} rpm"
frequency = {{ start = "20 Hz", stop = "150 Hz", points = 6 }}
[[step.force]]
at = "d0"
force = ["0 N", "3 N", "0 N"]
whirl = "forward"
)",
                     speed, 0.3 * speed);
}

using Cells = std::vector<std::vector<std::string>>;

/// The tables of a run as they stand in its files; energies element by element say nothing of
/// directions.
std::map<std::string, Cells> results(const std::string& deck) {
  const DeckRun run(deck);
  EXPECT_EQ(run.exit, 0) << run.log;
  std::map<std::string, Cells> out;
  for (const auto& file : std::filesystem::directory_iterator(run.folder / "r")) {
    const std::string name = file.path().filename().string();
    if (name.ends_with(".csv") && name.find("energy") == std::string::npos)
      out[name] = cells_of(file.path());
  }
  return out;
}

/// Words equal, numbers equal but for rounding: 1e-5 of them, shapes of close modes being badly
/// conditioned. Phase lags of z and of turns about x are half a turn apart.
void expect_alike(const Cells& x, const Cells& y, const std::string& which) {
  ASSERT_EQ(x.size(), y.size()) << which;
  const auto holds = [](const std::string& name, const char* part) {
    return name.find(part) != std::string::npos;
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_EQ(x[i].size(), y[i].size()) << which;
    for (std::size_t j = 0; j < x[i].size(); ++j) {
      const std::string& name = x.front()[j];
      const std::string where = fmt::format("{} row {} column {}", which, i, name);
      if (i == 0 || !is_number(x[i][j])) {
        EXPECT_EQ(x[i][j], y[i][j]) << where;
        continue;
      }
      const double p = Columns::number(x[i][j]), q = Columns::number(y[i][j]);
      double apart = p - q;
      if (holds(name, "lag"))
        apart = std::remainder(apart, holds(name, " z ") || holds(name, "twist") ? 180.0 : 360.0);
      // amplitudes are 1e-7 m and more, energies and angles of the order of 1
      const double small = holds(name, "[m]") ? 1e-13 : holds(name, "[N]") ? 1e-8 : 1e-3;
      EXPECT_NEAR(apart, 0.0, 1e-5 * std::abs(p) + small) << where << ": " << p << " and " << q;
    }
  }
}

}  // namespace

TEST(Direction, MirroredMachinesGetTheSameWords) {
  int words = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const auto here = results(machine(seed, 1.0)), image = results(machine(seed, -1.0));
    EXPECT_GE(here.size(), 6u);
    EXPECT_EQ(here.size(), image.size());
    for (const auto& [file, cells] : here) {
      if (!image.contains(file)) continue;
      expect_alike(cells, image.at(file), fmt::format("{} seed {}", file, seed));
      for (const auto& row : cells)
        words += static_cast<int>(std::count(row.begin(), row.end(), "forward") +
                                  std::count(row.begin(), row.end(), "backward"));
    }
  }
  EXPECT_GT(words, 200);
}

namespace {

/// A flexible rotor on equal bearings far below its critical speed: the orbits are circles run with
/// the spin.
std::string counter(double ratio, const std::string& step) {
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
speed_ratio = {}
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 30], ["b", 300, 30]]
[[disk]]
at = "a:end"
mass = "5 kg"
Ip = "0.02 kg.m^2"
Id = "0.01 kg.m^2"
[[shaft]]
name = "casing"
material = "steel"
rotating = false
columns = ["name", "length[mm]", "od[mm]", "id[mm]"]
rows = [["c", 600, 200, 190]]
[[bearing]]
name = "A"
at = "a:start"
to = "c:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "300 N.s/m"
czz = "300 N.s/m"
[[bearing]]
name = "B"
at = "b:end"
to = "c:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "300 N.s/m"
czz = "300 N.s/m"
[[bearing]]
name = "foot 1"
at = "c:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
krxx = "1e6 N.m/rad"
[[bearing]]
name = "foot 2"
at = "c:end"
type = "linear"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
[[unbalance]]
at = "a:end"
amount = "10 g.mm"
phase = "{} deg"
[[probe]]
name = "p"
at = "a:end"
[[probe]]
name = "c"
at = "c:end"
[output]
report = false
{})",
                     ratio, ratio < 0 ? -40 : 40, step);
}

}  // namespace

// Issue: minor was negative ("run backward") for a forward orbit of a shaft that turns from z to y.
TEST(Direction, MinorIsPositiveWithTheSpin) {
  const std::string steps = R"([[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["1000 rpm"] }
[[step]]
name = "h"
type = "harmonic_response"
rotor_speed = "1000 rpm"
frequency = { values = ["15 Hz"] }
[[step.force]]
at = "a:end"
force = ["0 N", "1 N", "0 N"]
whirl = "forward"
)";
  for (const double ratio : {1.0, -1.0}) {
    const DeckRun run(counter(ratio, steps));
    ASSERT_EQ(run.exit, 0) << run.log;
    for (const char* file : {"u_response.csv", "h_response.csv"}) {
      const Columns t = run.csv(file);
      for (const char* probe : {"p", "c"}) {
        // a circle: both axes are one but for rounding
        const double major = t.rows.at(0)[t.column(std::string(probe) + " major [m]")],
                     minor = t.rows.at(0)[t.column(std::string(probe) + " minor [m]")];
        EXPECT_GT(major, 1e-10) << file;
        EXPECT_NEAR(minor, major, 1e-9 * major) << file << " " << probe << " " << ratio;
      }
    }
  }
}

// The keyphasor's circles and lags of a rotor that turns backward are those of its image. Probes on
// the casing too.
TEST(Direction, KeyphasorOfARotorThatTurnsTheOtherWay) {
  const std::string step = R"([[step]]
name = "t"
type = "transient"
duration = "0.4 s"
start = "unbalance_response"
initial_speed = "1500 rpm"
)";
  for (const double ratio : {1.0, -1.0}) {
    const DeckRun run(counter(ratio, step));
    ASSERT_EQ(run.exit, 0) << run.log;
    const auto last = run.csv("t_tracking.csv").last();
    for (const std::string probe : {"p", "c"}) {
      const double forward = last.at(probe + " 1X forward [m]"),
                   backward = last.at(probe + " 1X backward [m]");
      EXPECT_GT(forward, 1e-9);
      EXPECT_LT(backward, 1e-4 * forward) << probe << " " << ratio;  // the default accuracy
    }
    // far below the critical speed the rotor bends out where the unbalance is: 40 degrees after the
    // mark in the sense of its spin, which is 40 degrees before it in time, and the damping adds a
    // little
    EXPECT_NEAR(std::remainder(last.at("p.y 1X lag [deg]") + 40.0, 360.0), 0.0, 3.0) << ratio;
  }
}

// Two motions of one frequency while the rotor turns, which rounding picked: both were called backward. One
// turns with the spin and one against it, whichever way that is.
TEST(Direction, MotionsOfOneFrequencyTurnBothWays) {
  for (const char* ratio : {"1", "-1"}) {
    const DeckRun run(fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "rotor"
speed_ratio = {}
[[shaft.section]]
name = "body"
length = "1 m"
rigid = true
[[disk]]
at = "body:mid"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "2 kg.m^2"
)",
                                  ratio) +
                      R"([[bearing]]
at = "body:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[bearing]]
at = "body:end"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[step]]
name = "c"
type = "critical_speeds"
max_speed = "6000 rpm"
motion = "lateral"
[[step]]
name = "m"
type = "modal"
speed = "3000 rpm"
modes = 2
motion = "lateral"
)");
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_TRUE(run.says("4270.58 (backward), 4270.58 (forward)")) << run.log;
    const whirl::io::Value s = run.summary("m");
    const auto& modes = s.at("modes").items();
    ASSERT_EQ(modes.size(), 2u);
    EXPECT_EQ(modes[0].at("direction").text(), "backward");
    EXPECT_EQ(modes[1].at("direction").text(), "forward");
  }
}
