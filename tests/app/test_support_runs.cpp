// What a run says about supports that cannot do what is asked of them, and what it keeps of their
// states.
#include "deck_run.hpp"
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& p) {
  std::ifstream in(p, std::ios::binary);
  std::ostringstream s;
  s << in.rdbuf();
  return s.str();
}

class SupportRuns : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("whirl_supports_" + std::to_string(::getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  /// Exit code of `whirl ARGUMENTS` in the test's folder; what it said is said_.
  int whirl(const std::string& arguments) {
    const int status = std::system(("cd '" + folder_.string() + "' && '" WHIRL_EXE "' " +
                                    arguments + " >out.txt 2>err.txt </dev/null")
                                       .c_str());
    said_ = read(folder_ / "out.txt") + read(folder_ / "err.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  bool says(const char* text) const { return said_.find(text) != std::string::npos; }

  fs::path folder_;
  std::string said_;
  static constexpr const char* rotor = R"(format = 1
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 300, 50, 2], ["b", 300, 50, 2]]
[[bearing]]
name = "thrust"
at = "a:start"
type = "rigid"
directions = ["x"]
)";
};

std::string film(const char* name, const char* at) {
  return std::string("[[bearing]]\nname = \"") + name + "\"\nat = \"" + at +
         "\"\ntype = \"short_journal\"\ndiameter = \"50 mm\"\nlength = \"20 mm\"\nclearance = \"50 "
         "um\"\nviscosity = \"10 mPa.s\"\n";
}

}  // namespace

// A film has no largest load: its equilibrium runs into the wall. What is not believed is said,
// with load, capacity and eccentricity. 200 kN on two films of 50 mm.
TEST_F(SupportRuns, FilmBeyondItsCapacityIsAWarning) {
  const std::string text =
      std::string(rotor) + film("DE", "a:start") + film("NDE", "b:end") +
      "[[load]]\nat = \"a:end\"\nforce = [\"0 N\", \"0 N\", \"-2e5 N\"]\n[[step]]\nname = "
      "\"weight\"\ntype = \"static\"\nspeed = \"100 rpm\"\n";
  std::string finite = text;
  for (std::size_t at; (at = finite.find("\"short_journal\"")) != std::string::npos;)
    finite.replace(at, 15, "\"journal\"\nshape = \"plain\"");
  for (const std::string& deck : {text, finite}) {
    write("d.toml", deck);
    EXPECT_EQ(whirl("run d.toml"), 0) << said_;
    EXPECT_TRUE(says("warning[W03]: bearing 'DE' runs at eccentricity 0.99")) << said_;
    EXPECT_TRUE(says("carrying 1e+05 N")) << said_;
    EXPECT_TRUE(says("believed up to 0.99, where it carries about")) << said_;
  }
}

TEST_F(SupportRuns, FilmsAtRestCarryNothing) {
  write("d.toml", std::string(rotor) + film("DE", "a:start") + film("NDE", "b:end") +
                      "[[step]]\nname = \"weight\"\ntype = \"static\"\nspeed = \"0 rpm\"\n");
  EXPECT_EQ(whirl("run d.toml"), 4) << said_;
  EXPECT_TRUE(says("at rest it carries nothing")) << said_;
}

TEST_F(SupportRuns, GapThatNoLoadCloses) {
  const auto stop = [](const char* name, const char* at) {
    return std::string("[[bearing]]\nname = \"") + name + "\"\nat = \"" + at +
           "\"\ntype = \"rub\"\ngap = \"0.2 mm\"\nstiffness = \"1e7 N/m\"\nfriction = 0.1\n";
  };
  const auto above = [](const char* name,
                        const char* at) {  // the weight moves the shaft away from it
    return std::string("[[bearing]]\nname = \"") + name + "\"\nat = \"" + at +
           "\"\ntype = \"nonlinear_spring\"\ndirection = \"z\"\nshape = \"one_sided\"\ngap = \"0.2 "
           "mm\"\nstiffness = \"1e7 N/m\"\n[[bearing]]\nat = \"" +
           at + "\"\ntype = \"linear\"\nkyy = \"1e6 N/m\"\n";
  };
  const std::string step = "[[step]]\nname = \"weight\"\ntype = \"static\"\nspeed = \"0 rpm\"\n";
  write("d.toml", std::string(rotor) + above("near", "a:start") + above("far", "b:end") + step);
  EXPECT_EQ(whirl("run d.toml"), 4) << said_;
  EXPECT_TRUE(says("E75")) << said_;
  EXPECT_TRUE(says(
      "'near', 'far' have a gap, and moving the shaft along its load finds nothing that holds it"))
      << said_;
  // with its weight it lies in the stops, and that is said too; a couple without weight turns it
  // into them
  write("g.toml", std::string(rotor) + stop("near", "a:start") + stop("far", "b:end") + step);
  EXPECT_EQ(whirl("run g.toml"), 0) << said_;
  EXPECT_TRUE(
      says("warning[W04]: contact 'far' is closed at the equilibrium at 0 rpm of step 'weight'"))
      << said_;
  write("c.toml", std::string(rotor) + "[model]\ngravity = \"0 m/s^2\"\n" +
                      stop("near", "a:start") + stop("far", "b:end") +
                      "[[load]]\nat = \"a:end\"\nmoment = [\"0 N.m\", \"0 N.m\", \"1 N.m\"]\n" +
                      step);
  EXPECT_EQ(whirl("run c.toml"), 0) << said_;
  EXPECT_TRUE(
      says("warning[W04]: contact 'near' is closed at the equilibrium at 0 rpm of step 'weight'"))
      << said_;
}

TEST_F(SupportRuns, ContactClosedAtRestIsAWarning) {
  write("d.toml", std::string(rotor) + R"([[bearing]]
name = "left"
at = "a:start"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[bearing]]
name = "right"
at = "b:end"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[bearing]]
name = "stop"
at = "a:end"
type = "rub"
gap = "10 um"
stiffness = "1e7 N/m"
friction = 0.1
[[step]]
name = "weight"
type = "static"
speed = "0 rpm"
)");
  EXPECT_EQ(whirl("run d.toml"), 0) << said_;
  EXPECT_TRUE(
      says("warning[W04]: contact 'stop' is closed at the equilibrium at 0 rpm of step 'weight'"))
      << said_;
  std::string text = read(folder_ / "d.toml");
  text.replace(text.find("\"10 um\""), 7, "\"0.1 mm\"");
  write("open.toml", text);
  EXPECT_EQ(whirl("run open.toml"), 0) << said_;
  EXPECT_FALSE(says("W04")) << said_;
}

// Elastic stator with mass, pedestal, gear mesh and a ball bearing's cage angle: a run continued
// from its checkpoint goes on as one that was never interrupted. Fixed steps, so that the end of
// the first part is an ordinary step: only the rounding of its time differs.
TEST_F(SupportRuns, StatesOfSupportsAreInTheCheckpoint) {
  const std::string text = R"(format = 1
[[shaft]]
name = "motor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 200, 40], ["b", 200, 40]]
[[shaft]]
name = "fan"
origin = ["0 mm", "105 mm", "0 mm"]
material = "steel"
speed_ratio = -0.4
columns = ["name", "length[mm]", "od[mm]"]
rows = [["c", 200, 50], ["d", 200, 50]]
[[unbalance]]
at = "a:end"
amount = "400 g.mm"
[[bearing]]
name = "M1"
at = "a:start"
type = "ball"
balls = 8
ball_diameter = "10 mm"
pitch_diameter = "56 mm"
clearance = "4 um"
c_radial = "500 N.s/m"
support = { mass = "3 kg", kxx = "1e8 N/m", kyy = "3e7 N/m", kzz = "4e7 N/m", cyy = "2e3 N.s/m", czz = "2e3 N.s/m" }
[[bearing]]
name = "M2"
at = "b:end"
type = "linear"
kxx = "1e8 N/m"
kyy = "3e7 N/m"
kzz = "3e7 N/m"
cyy = "1e3 N.s/m"
czz = "1e3 N.s/m"
[[bearing]]
name = "stator"
at = "a:mid"
type = "rub"
gap = "2 um"
stiffness = "1e7 N/m"
friction = 0.1
support = { mass = "2 kg", kyy = "2e7 N/m", kzz = "2e7 N/m", cyy = "1e3 N.s/m", czz = "1e3 N.s/m" }
[[bearing]]
name = "F1"
at = "c:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
cyy = "1e3 N.s/m"
czz = "1e3 N.s/m"
[[bearing]]
name = "F2"
at = "d:end"
type = "linear"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
cyy = "1e3 N.s/m"
czz = "1e3 N.s/m"
[[bearing]]
name = "mesh"
at = "a:end"
to = "c:end"
type = "gear"
teeth = 24
other_teeth = 60
pitch_diameter = "60 mm"
stiffness = "4e8 N/m"
damping = "2e3 N.s/m"
stiffness_harmonics = [0.15]
[[drive]]
name = "motor"
at = "b:end"
type = "torque"
torque = "30 N.m"
[[probe]]
name = "shaft"
at = "a:mid"
[[probe]]
name = "stator"
at = "stator:support"
[[probe]]
name = "pedestal"
at = "M1:support"
[[step]]
name = "run"
type = "transient"
start = "rest"
initial_speed = "3000 rpm"
duration = "DURATION"
integrator = { method = "generalized_alpha", dt = "10 us" }
[output]
every = "0.1 ms"
quantities = ["speed", "probes", "bearing_force", "energy"]
)";
  const auto with = [&](const char* duration) {
    std::string t = text;
    return t.replace(t.find("DURATION"), 8, duration);
  };
  write("short.toml", with("0.04 s"));
  write("long.toml", with("0.08 s"));
  ASSERT_EQ(whirl("run short.toml -o r"), 0) << said_;
  ASSERT_EQ(whirl("run long.toml -o r --resume"), 0) << said_;
  ASSERT_EQ(whirl("run long.toml -o whole"), 0) << said_;
  const auto rows = [](const std::string& csv) {
    std::vector<std::vector<double>> out;
    std::istringstream in(csv);
    std::string line, cell;
    for (std::getline(in, line); std::getline(in, line);) {
      std::istringstream cells(line);
      out.emplace_back();
      while (std::getline(cells, cell, ','))
        out.back().push_back(std::strtod(cell.c_str(), nullptr));
    }
    return out;
  };
  const auto a = rows(read(folder_ / "r/run.csv")), b = rows(read(folder_ / "whole/run.csv"));
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 700u);
  std::vector<double> largest(b[0].size(), 0.0);
  for (const auto& r : b)
    for (std::size_t k = 0; k < r.size(); ++k)
      largest[k] = std::max(largest[k], std::abs(r[k]));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < a[i].size(); ++k)
      ASSERT_NEAR(a[i][k], b[i][k], 1e-8 * largest[k]) << "row " << i << " column " << k;
  // the stator is struck, the pedestal moves: there is something to keep
  EXPECT_GT(largest.size(), 8u);
}

// A vertical rotor does not load its journals: their load is rounding, no number is divided by it,
// and no mass is stable on them.
TEST(SupportCoefficients, UnloadedJournalHasNoSommerfeldNumber) {
  const whirl::test::DeckRun run(R"(format = 1
[model]
gravity_direction = "-x"
[[shaft]]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 1500, 60, 6]]
[[bearing]]
name = "th"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
[[bearing]]
name = "b1"
at = "a:mid"
type = "short_journal"
diameter = "60 mm"
length = "40 mm"
clearance = "120 um"
viscosity = "1 mPa.s"
[[step]]
name = "s"
type = "static"
speed = "1500 rpm"
[output]
report = false
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const std::map<std::string, double> row = run.csv("s_coefficients.csv").last();
  EXPECT_TRUE(std::isnan(row.at("Sommerfeld number [-]")));
  EXPECT_TRUE(std::isnan(row.at("attitude [deg]")));
  EXPECT_EQ(row.at("threshold mass [kg]"), 0.0);
  EXPECT_NEAR(row.at("whirl / speed [-]"), 0.5, 1e-9);
  EXPECT_GT(row.at("kyz [N/m]"), 1e4);
}
