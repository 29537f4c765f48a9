// Linkages from decks, driven through buckling.
#include "deck_run.hpp"

#include <core/types.hpp>
#include <fmt/format.h>

#include <array>

using namespace whirl;
using namespace whirl::test;

namespace {

/// A strip of 1 m x 10 mm x 100 mm along y, clamped, pulled down at its end by a link on a crank of
/// 50 mm that turns by half a turn in 0.4 s about x, 0.1 mm beside the strip's plane: the benchmark
/// of O. A. Bauchau et al. 2016, doi 10.1007/s11044-016-9514-y, with its crank at the end.
std::string strip_on_a_crank(int elements, bool full) {
  const double width = 0.01, height = 0.1, A = width * height;
  const double Iy = width * std::pow(height, 3) / 12, Iz = height * std::pow(width, 3) / 12;
  const double J = 0.312 * height * std::pow(width, 3), E = 73e9, G = E / 2.6, rho = 2680;
  std::string section = fmt::format(
      R"(general = {{ A = "{:.17g} m^2", Iy = "{:.17g} m^4", Iz = "{:.17g} m^4", J = "{:.17g} m^4", kappa_y = 0.833, kappa_z = 0.833 }})",
      A, Iy, Iz, J);
  if (full) {
    const double kGA = 0.833 * G * A;
    const std::array<double, 6> K{E * A, kGA, kGA, G * J, E * Iy, E * Iz};
    const std::array<double, 6> M{rho * A, rho * A, rho * A, rho * (Iy + Iz), rho * Iy, rho * Iz};
    const auto diagonal = [](const std::array<double, 6>& d, std::array<const char*, 3> units) {
      std::string out = "[";
      for (std::size_t i = 0; i < 6; ++i) {
        out += "[";
        for (std::size_t k = 0; k < 6; ++k)
          out += fmt::format("\"{:.17g} {}\", ", i == k ? d[i] : 0.0, units[i / 3 + k / 3]);
        out += "], ";
      }
      return out + "]";
    };
    section = "full.stiffness = " + diagonal(K, {"N", "N.m", "N.m^2"}) +
              "\nfull.mass = " + diagonal(M, {"kg/m", "kg", "kg.m"});
  }
  std::string times, speeds;
  for (int k = 0; k <= 80; ++k) {
    times += fmt::format("\"{:.17g} s\", ", 0.4 * k / 80);
    speeds += fmt::format("\"{:.17g} rad/s\", ", pi * pi / 0.8 * std::sin(pi * k / 80));
  }
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "aluminium"
E = "73 GPa"
nu = 0.3
density = "2680 kg/m^3"
[[shaft]]
name = "beam"
material = "aluminium"
rotating = false
path = [{{ to = ["0 m", "1 m", "0 m"] }}]
[[shaft.section]]
name = "strip"
length = "1 m"
min_elements = {}
{}
[[shaft]]
name = "link"
material = "aluminium"
rotating = false
origin = ["0.1 mm", "1 m", "-0.25 m"]
path = [{{ to = ["0 m", "1 m", "0 m"] }}]
[[shaft.section]]
name = "bar"
length = "{:.17g} m"
min_elements = 2
od = "48 mm"
id = "40 mm"
[[shaft]]
name = "crank"
material = "aluminium"
rotating = false
origin = ["0.1 mm", "1 m", "-0.3 m"]
path = [{{ to = ["0.1 mm", "1 m", "-0.25 m"] }}]
[[shaft.section]]
name = "arm"
length = "50 mm"
min_elements = 1
od = "48 mm"
[[shaft]]
name = "motor"
material = "aluminium"
origin = ["-99.9 mm", "1 m", "-300 mm"]
columns = ["name", "length[mm]", "od[mm]"]
rows = [["spindle", 100, 60]]
[[joint]]
name = "ball"
kind = "spherical"
at = "beam:end"
to = "link:end"
[[joint]]
name = "pin"
kind = "spherical"
at = "link:start"
to = "crank:end"
[[joint]]
name = "weld"
kind = "rigid"
at = "crank:start"
to = "motor:end"
[[bearing]]
name = "clamp"
at = "beam:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[bearing]]
name = "front"
at = "motor:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "back"
at = "motor:end"
type = "rigid"
directions = ["y", "z"]
[[drive]]
at = "motor:start"
type = "speed"
speed = {{ type = "table", interpolation = "monotone_cubic", time = [{}], value = [{}] }}
[[probe]]
name = "tip"
at = "beam:end"
[[step]]
name = "pull"
type = "transient"
start = "rest"
duration = "0.22 s"
[output]
quantities = ["positions", "energy"]
every = "10 ms"
)",
                     elements, section, std::hypot(0.25, 1e-4), times, speeds);
}

}  // namespace

TEST(Linkages, AStripPulledDownByACrankBuckles) {
  // Below its critical load it stays in its plane; then it gives way by a third of its height. The
  // two elements have different kinematics and masses; meshes of both agree.
  struct Pulled {
    Columns motion;
    double defect;
  };
  const auto pulled = [](int elements, bool full) {
    const DeckRun r(strip_on_a_crank(elements, full));
    EXPECT_EQ(r.exit, 0) << r.log;
    return Pulled{r.csv("pull.csv"),
                  r.summary("pull").at("energy").at("largest defect [J]").number()};
  };
  const Pulled coarse = pulled(8, false), other = pulled(16, true);
  const Columns &a = coarse.motion, &b = other.motion;
  const std::size_t x = a.column("tip position.x [m]"), z = a.column("tip position.z [m]");
  ASSERT_EQ(a.rows.size(), 23u);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t k = 0; k < a.rows.size(); ++k) {
    EXPECT_NEAR(a.rows[k][x], b.rows[k][x], 2e-4) << a.rows[k][0];
    EXPECT_NEAR(a.rows[k][z], b.rows[k][z], 5e-5) << a.rows[k][0];
    if (a.rows[k][0] < 0.155) {
      EXPECT_LT(std::abs(a.rows[k][x]), 5e-4) << a.rows[k][0];
    }
  }
  EXPECT_NEAR(a.rows[20][x], 0.03625, 1e-4);
  EXPECT_LT(coarse.defect, 1e-6 * a.last().at("energy.elastic [J]"));
}
