// A rotor on a turning base: what its bearings carry in a steady curve, in closed form. The deck is examples/13_manoeuvre.
#include <gtest/gtest.h>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <io/value.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace {

/// Mean of each column over rows with t in [from, to).
std::map<std::string, double> means(const fs::path& csv, double from, double to) {
  std::ifstream in(csv);
  std::string line;
  std::getline(in, line);
  std::vector<std::string> names;
  std::istringstream head(line);
  for (std::string name; std::getline(head, name, ',');) names.push_back(name);
  std::map<std::string, double> sum;
  long rows = 0;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::vector<double> x;
    for (std::string cell; std::getline(cells, cell, ',');) x.push_back(std::stod(cell));
    if (x.empty() || x[0] < from - 1e-9 || x[0] >= to - 1e-9) continue;
    ++rows;
    for (std::size_t k = 0; k < names.size(); ++k) sum[names[k]] += x[k];
  }
  for (auto& [name, value] : sum) value /= static_cast<double>(rows);
  return sum;
}

}  // namespace

TEST(Manoeuvre, BearingsCarryGyroscopicCoupleAndCentrifugalForce) {
  const fs::path folder = fs::temp_directory_path() / ("whirl_manoeuvre_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const int status = std::system(("cd '" + folder.string() + "' && '" WHIRL_EXE "' run '" WHIRL_SOURCE "/examples/13_manoeuvre/deck.toml' -o r >log.txt 2>&1 </dev/null").c_str());
  std::ostringstream log;
  log << std::ifstream(folder / "log.txt").rdbuf();
  ASSERT_EQ(WEXITSTATUS(status), 0) << log.str();
  EXPECT_EQ(log.str().find("warning"), std::string::npos) << log.str();
  const double pi = std::acos(-1.0), rho = 7850, g = 9.80665, span = 0.48, spin = 9000 * pi / 30, rate = pi / 3, R = 12;
  struct Cylinder { double length, od, id; };
  double mass = 0, Ip = 0;
  for (const Cylinder c : {Cylinder{0.12, 0.06, 0}, {0.48, 0.07, 0}, {0.045, 0.32, 0.07}}) {
    const double m = rho * c.length * pi / 4 * (c.od * c.od - c.id * c.id);
    mass += m, Ip += m * (c.od * c.od + c.id * c.id) / 8;
  }
  // The last 0.1 s before the shock: 15 turns. The spin in space is that of the drive, about an axis square to the turning.
  const auto mean = means(folder / "r/manoeuvre.csv", 0.8, 0.9);
  const double couple = Ip * spin * rate / span, weight = mass * g / 2, centrifugal = mass * rate * rate * R / 2;
  // 1e-4 of the largest: the accuracy asked for, and the sag and bow of the shaft, a few micrometres of 12 m and 0.48 m
  const double allowed = 1e-4 * couple;
  EXPECT_NEAR(mean.at("bearing DE force.z [N]"), weight + couple, allowed);
  EXPECT_NEAR(mean.at("bearing NDE force.z [N]"), weight - couple, allowed);
  EXPECT_NEAR(mean.at("bearing DE force.y [N]"), -centrifugal, allowed);
  EXPECT_NEAR(mean.at("bearing NDE force.y [N]"), -centrifugal, allowed);
  // Work of the turning and of the shock is in the balance.
  const whirl::io::Value step = whirl::io::read_json(folder / "r/summary.json").at("steps").at("manoeuvre");
  EXPECT_LT(step.at("accuracy").at("energy defect / energy turned over").number(), 1e-3);
  fs::remove_all(folder);
}
