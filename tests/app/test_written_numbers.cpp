// What the program writes, number by number: deck, file, row, column, the value from a closed form,
// and where that comes from.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <cmath>
#include <fstream>
#include <map>

namespace {

using whirl::test::DeckRun;

/// 10 kg on 1e6 N/m and 600 N s/m each way, Ip 0.1 kg m2 on 1e4 N m/rad and 10 N m s/rad about the
/// axis.
std::string mass_on_springs(const std::string& rest) {
  return whirl::test::lateral_mass(10, "0 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
krxx = "1e4 N.m/rad"
crxx = "10 N.m.s/rad"
[[probe]]
name = "P"
at = "mass"
[output]
report = false
)" + rest);
}

const std::string push = R"([[load]]
at = "mass"
force = ["0 N", "1 kN", "0 N"]
[[step]]
name = "t"
type = "transient"
start = "rest"
)";

const std::map<std::string, std::string> decks = {
    {"cantilever", R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
[[shaft.section]]
length = "1 m"
od = "50 mm"
min_elements = 4
[[bearing]]
name = "wall"
at = "r/0 m"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/1 m"
force = ["0 N", "200 N", "50 N"]
[[step]]
name = "st"
type = "static"
[output]
report = false
)"},
    {"backward", mass_on_springs(R"([[step]]
name = "h"
type = "harmonic_response"
speed = { start = "1500 rpm", stop = "3000 rpm", points = 2 }
speed_squared = true
[[step.force]]
at = "mass"
force = ["0 N", "100 N", "0 N"]
whirl = "backward"
)")},
    {"twist", mass_on_springs(R"([[step]]
name = "h"
type = "harmonic_response"
frequency = { start = "20 Hz", stop = "40 Hz", points = 2 }
[[step.force]]
at = "mass"
moment = ["10 N.m", "0 N.m", "0 N.m"]
)")},
    {"unbalance", mass_on_springs(R"([[unbalance]]
at = "mass"
amount = "1 kg.mm"
phase = "60 deg"
[[step]]
name = "u"
type = "unbalance_response"
speed = { start = "1000 rpm", stop = "6000 rpm", points = 51, refine = "no" }
)")},
    {"limited", mass_on_springs(push + "duration = \"1 s\"\namplitude_limit = \"1.2 mm\"\n")},
    {"short steps",
     mass_on_springs(push + "duration = \"20 ms\"\n[step.integrator]\ndt_max = \"0.1 ms\"\n")},
    {"modes", mass_on_springs(
                  "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"1000 rpm\"\nmodes = 2\n")},
};

struct Number {
  const char* deck;
  const char* file;
  int row;  ///< from 0; negative: from the end
  const char* column;
  double expected, tolerance;
  const char* why;
};

// Forces of the right part on the left one: r x F of the tip force about the section. The sag
// shortens the lever by 1e-6 of it.
const Number numbers[] = {
    {"cantilever", "st_sections.csv", 0, "V_y [N]", 200, 1e-3, "tip force"},
    {"cantilever", "st_sections.csv", 0, "V_z [N]", 50, 1e-3, "tip force"},
    {"cantilever", "st_sections.csv", 0, "M_z [N m]", 200, 1e-3, "F_y L, hollow towards +y"},
    {"cantilever", "st_sections.csv", 0, "M_y [N m]", -50, 1e-3, "-F_z L"},
    {"cantilever", "st_sections.csv", 0, "M [N m]", 206.1552812809, 1e-3, "resultant"},
    {"cantilever", "st_supports.csv", 0, "F_y [N]", -200, 1e-6, "reaction"},
    {"cantilever", "st_supports.csv", 0, "F_z [N]", -50, 1e-6, "reaction"},
    {"cantilever", "st_supports.csv", 0, "M_y [N m]", 50, 1e-3, "reaction: F_z L"},
    {"cantilever", "st_supports.csv", 0, "M_z [N m]", -200, 1e-3, "reaction: -F_y L"},
    // F (w/w_top)^2/(k - m w^2 + i c w)
    {"backward", "h_response.csv", 0, "P y amplitude [m]", 3.293230012334e-5, 1e-14,
     "a quarter of the force at half the top speed"},
    {"backward", "h_response.csv", 1, "P y amplitude [m]", 5.292516323279e-4, 1e-13,
     "the whole force"},
    {"backward", "h_response.csv", 0, "P y phase lag [deg]", 7.131778639309, 1e-9,
     "atan2(c w, k - m w^2)"},
    {"backward", "h_response.csv", 0, "P z phase lag [deg]", -82.868221360691, 1e-9,
     "backward: z leads y by a quarter"},
    {"backward", "h_response.csv", 1, "P major [m]", 5.292516323279e-4, 1e-13, "a circle"},
    {"backward", "h_response.csv", 1, "P minor [m]", -5.292516323279e-4, 1e-13,
     "run backward: negative"},
    {"backward", "h_response.csv", 1, "bearing spring force y [N]", 538.5718741681, 1e-8,
     "|k + i c w| times the amplitude"},
    // M/(k - Ip w^2 + i c w)
    {"twist", "h_response.csv", 0, "P twist amplitude [rad]", 1.174520832862e-3, 1e-13,
     "one degree of freedom"},
    {"twist", "h_response.csv", 0, "P twist phase lag [deg]", 8.487558102645, 1e-9,
     "lags: positive"},
    {"twist", "h_response.csv", 1, "P twist phase lag [deg]", 34.306291444409, 1e-9,
     "atan2(c w, k - Ip w^2)"},
    // peak of m_u w^2/|k - m w^2 + i c w| at w_n/sqrt(1 - 2 zeta^2), zeta = 600/(2 sqrt(k m));
    // there the lag is 95.468 deg behind the heavy spot
    {"unbalance", "u_peaks.csv", 0, "speed [rpm]", 3047.302992474, 1e-6, "w_n/sqrt(1 - 2 zeta^2)"},
    {"unbalance", "u_peaks.csv", 0, "amplitude [m]", 5.294341149915e-4, 1e-13, "closed form"},
    {"unbalance", "u_peaks.csv", 0, "phase lag [deg]", 35.468479891, 1e-6,
     "95.468 less the 60 deg of the unbalance: behind the mark"},
    // y = F/k (1 - exp(-zeta w t)(cos w_d t + zeta w/w_d sin w_d t)); tolerance of the integrator
    // 1e-9 of the motion, with a margin
    {"limited", "t.csv", -1, "t [s]", 6.0575050235066e-3, 1e-9, "the first passage of 1.2 mm"},
    {"limited", "t.csv", -1, "P.y [m]", 1.2e-3, 1e-9, "the limit"},
    {"short steps", "t.csv", -1, "P.y [m]", 4.5056184569988e-4, 1e-9, "step response at 20 ms"},
    {"modes", "m_energy.csv", 0, "share [%]", 100, 1e-9, "one spring"},
    {"modes", "m_energy.csv", 1, "share [%]", 100, 1e-9, "one disk"},
};

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

}  // namespace

TEST(WrittenNumbers, AreThoseOfClosedForms) {
  for (const auto& [name, deck] : decks) {
    const DeckRun run(deck);
    ASSERT_EQ(run.exit, 0) << name << "\n" << run.log;
    for (const Number& n : numbers) {
      if (n.deck != name) continue;
      const auto csv = run.csv(n.file);
      const std::size_t row = n.row < 0 ? csv.rows.size() - static_cast<std::size_t>(-n.row)
                                        : static_cast<std::size_t>(n.row);
      ASSERT_LT(row, csv.rows.size()) << name << " " << n.file;
      EXPECT_NEAR(csv.rows[row][csv.column(n.column)], n.expected, n.tolerance)
          << name << ", " << n.file << ", " << n.column << ": " << n.why;
    }
    if (name == "short steps") {  // 20 ms in steps of at most 0.1 ms
      const std::string summary = text_of(run.folder / "r" / "summary.json");
      EXPECT_NE(summary.find("\"step max [s]\": 0.0001"), std::string::npos) << summary;
    }
    if (name == "limited") EXPECT_TRUE(run.says("amplitude limit exceeded")) << run.log;
    if (name == "modes") {  // a spring stores strain, a disk moves
      const std::string shares = text_of(run.folder / "r" / "m_energy.csv");
      EXPECT_NE(shares.find("1,strain,linear bearings"), std::string::npos) << shares;
      EXPECT_NE(shares.find("1,kinetic,rigid disks"), std::string::npos) << shares;
    }
  }
}
