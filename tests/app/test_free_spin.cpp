// Torques on a shaft that nothing holds about its axis: two discs on a bar without mass turn as one
// body and against each other.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <cmath>
#include <complex>

namespace {

using namespace whirl;
using test::Columns;
using test::DeckRun;

constexpr double J_A = 1, J_B = 3, M = 100, brake = 40;  // kg m^2, N m, N m s/rad
const double k = 80e9 * pi * std::pow(0.05, 4) / 32;     // N m/rad of 1 m

std::string deck_of(bool damped) {
  return std::string(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
G = "80 GPa"
density = "1e-3 kg/m^3"
[[shaft]]
name = "r"
material = "m"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["s", 1000, 50]]
[[disk]]
name = "A"
at = "s:start"
mass = "10 kg"
Ip = "1 kg.m^2"
[[disk]]
name = "B"
at = "s:end"
mass = "10 kg"
Ip = "3 kg.m^2"
[[bearing]]
name = "left"
at = "s:start"
type = "rigid"
directions = ["x", "y", "z", "ry", "rz"]
[[bearing]]
name = "right"
at = "s:end"
type = "linear"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
)") + (damped ? "crxx = \"40 N.m.s/rad\"\n" : "") +
         R"([[probe]]
name = "P"
at = "s:start"
[[probe]]
name = "Q"
at = "s:end"
[output]
report = true
[[step]]
name = "h"
type = "harmonic_response"
frequency = { values = ["5 Hz", "20 Hz", "60 Hz"] }
[[step.force]]
at = "s:start"
moment = ["100 N.m", "0 N.m", "0 N.m"]
)";
}

}  // namespace

// (k - J_A w^2) a - k b = M, (k - J_B w^2 + i w c) b - k a = 0
TEST(FreeSpin, TwoDiscsAnswerATorque) {
  for (const bool damped : {false, true}) {
    const DeckRun run(deck_of(damped));
    ASSERT_EQ(run.exit, 0) << run.log;
    const Columns t = run.csv("h_response.csv");
    ASSERT_EQ(t.rows.size(), 3u);
    for (const auto& row : t.rows) {
      const double w = two_pi * row[t.column("frequency [Hz]")];
      const Complex own(k - J_B * w * w, damped ? w * brake : 0.0),
          D = (k - J_A * w * w) * own - k * k, a = M * own / D, b = M * k / D;
      const auto expect = [&](const std::string& probe, const Complex& wanted) {
        const double amplitude = row[t.column(probe + " twist amplitude [rad]")],
                     lag = row[t.column(probe + " twist phase lag [deg]")] * pi / 180;
        EXPECT_NEAR(std::abs(std::polar(amplitude, -lag) - wanted), 0, 1e-6 * std::abs(wanted))
            << probe << " " << w << " " << damped;
      };
      expect("P", a);
      expect("Q", b);
      EXPECT_NEAR(row[t.column("largest torque in r [N.m]")], k * std::abs(a - b),
                  1e-6 * k * std::abs(a - b));
    }
  }
}

// The report says against what a response is drawn.
TEST(FreeSpin, AResponseSaysWhatExcitesIt) {
  const auto page = [](const DeckRun& run) {
    std::ostringstream out;
    out << std::ifstream(run.folder / "r" / "report.html").rdbuf();
    return out.str();
  };
  std::string deck = deck_of(true);
  const std::string at_rest = page(DeckRun(deck));
  const char *frequency = "Steady response at 0 rpm against the excitation frequency",
             *speed = "Steady response with the excitation at 2 times the speed";
  EXPECT_NE(at_rest.find(frequency), std::string::npos);
  EXPECT_EQ(at_rest.find(speed), std::string::npos);
  const std::string asked = "frequency = { values = [\"5 Hz\", \"20 Hz\", \"60 Hz\"] }";
  deck.replace(deck.find(asked), asked.size(),
               "order = 2\nspeed = { values = [\"150 rpm\", \"600 rpm\"] }");
  const DeckRun turning(deck);
  ASSERT_EQ(turning.exit, 0) << turning.log;
  const std::string turned = page(turning);
  EXPECT_EQ(turned.find("against the excitation frequency"), std::string::npos);
  EXPECT_NE(turned.find(speed), std::string::npos);
}
