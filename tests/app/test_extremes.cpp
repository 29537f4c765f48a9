// The same machine at the ends of what people build, with nothing tuned by hand: sizes from a gram to a hundred tonnes, speeds from 1 to
// 100,000 rpm, supports of 1e12 N/m, meshes from two nodes to five thousand.
#include <gtest/gtest.h>
#include <io/value.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Machine {
  double length, od, support, damping, unbalance, rpm, duration;   // m, m, N/m, N s/m, kg m, rpm, s
  int elements;
};

/// A uniform shaft on two equal supports at its ends, turning at constant speed from its steady response on. Returns the step's summary.
io::Value run(const Machine& m) {
  const fs::path folder = fs::temp_directory_path() / ("whirl_extreme_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "d.toml") << fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
material = "steel"
columns = ["name", "length[m]", "od[m]", "min_elements"]
rows = [["body", {}, {}, {}]]
[[unbalance]]
at = "body:mid"
amount = "{} kg.m"
[[bearing]]
name = "A"
at = "body:start"
type = "linear"
kxx = "{} N/m"
kyy = "{} N/m"
kzz = "{} N/m"
cyy = "{} N.s/m"
czz = "{} N.s/m"
[[bearing]]
name = "B"
at = "body:end"
type = "linear"
kyy = "{} N/m"
kzz = "{} N/m"
cyy = "{} N.s/m"
czz = "{} N.s/m"
[[drive]]
name = "motor"
at = "body:start"
type = "speed"
speed = "{} rpm"
[[probe]]
name = "end"
at = "body:start"
[[step]]
name = "run"
type = "transient"
start = "unbalance_response"
initial_speed = "{} rpm"
duration = "{} s"
[output]
directory = "r"
report = false
every = "{} s"
)", m.length, m.od, m.elements, m.unbalance, m.support, m.support, m.support, m.damping, m.damping, m.support, m.support, m.damping, m.damping, m.rpm, m.rpm, m.duration, m.duration / 10);
  const int status = std::system(("cd '" + folder.string() + "' && '" WHIRL_EXE "' run d.toml >log.txt 2>&1 </dev/null").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 0) << std::ifstream(folder / "log.txt").rdbuf();
  io::Value s = io::read_json(folder / "r/summary.json").at("steps").at("run");
  fs::remove_all(folder);
  return s;
}

double amplitude(const io::Value& step) { return step.at("peaks").at("end").at("amplitude 0-peak [m]").number(); }
double mass(const Machine& m) { return 7850.0 * pi / 4 * m.od * m.od * m.length; }

/// A rigid rotor: u = U W^2 / |2k - m W^2 + 2 i c W| at every station, for an unbalance in the middle.
double rigid(const Machine& m) {
  const double W = m.rpm * pi / 30;
  return m.unbalance * W * W / std::hypot(2 * m.support - mass(m) * W * W, 2 * m.damping * W);
}

}  // namespace

TEST(Extremes, AHundredTonnesAtOneRpm) {
  // 1.27 m x 10 m: 99 t; 300 s are five turns
  const Machine m{10.0, 1.27, 1e8, 1e6, 1.0, 1, 300, 1};
  const io::Value s = run(m);
  EXPECT_NEAR(mass(m), 1e5, 2e3);
  EXPECT_NEAR(amplitude(s) / rigid(m), 1.0, 0.01);
}

TEST(Extremes, StiffSupportsAndManyNodes) {
  // 1e12 N/m: the ends stay where they are, U W^2/(2 k) apart from bending inertia of a shaft far below its critical speed
  for (const int n : {1, 8}) {
    const Machine m{1.0, 0.05, 1e12, 1e3, 1e-4, 3000, 0.1, n};
    EXPECT_NEAR(amplitude(run(m)) / rigid(m), 1.0, n == 1 ? 0.5 : 0.5) << n;
  }
}
