// At constant speed and with a small unbalance a transient of the full nonlinear model settles to
// the linear unbalance response.
#include "../app/deck_run.hpp"
#include "record.hpp"
#include <gtest/gtest.h>
#include <cmath>
#include <string>

namespace {

/// Anisotropic, cross-coupled bearings at 0.7 of the shaft's bending critical speed; the slowest
/// mode decays by e^-20 in the run.
constexpr const char* deck = R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["left", 300, 30, 3], ["right", 400, 30, 4]]
[[disk]]
name = "disk"
at = "left:end"
mass = "5 kg"
Ip = "0.03 kg.m^2"
Id = "0.016 kg.m^2"
[[unbalance]]
at = "disk"
amount = "1e-9 kg.m"
phase = "30 deg"
[[bearing]]
name = "A"
at = "left:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "2e6 N/m"
kzz = "1e6 N/m"
cyy = "2000 N.s/m"
czz = "2000 N.s/m"
[[bearing]]
name = "B"
at = "right:end"
type = "linear"
kyy = "2e6 N/m"
kzz = "1e6 N/m"
kyz = "1e5 N/m"
kzy = "-1e5 N/m"
cyy = "2000 N.s/m"
czz = "2000 N.s/m"
[[drive]]
at = "left:start"
type = "speed"
speed = "3600 rpm"
step = "run"
[[probe]]
name = "disk"
at = "disk"
[[step]]
name = "steady"
type = "unbalance_response"
speed = { values = ["3600 rpm"] }
[[step]]
name = "run"
type = "transient"
start = "rest"
initial_speed = "3600 rpm"
duration = "1 s"
integrator = { tolerance = 1e-8 }
[output]
report = false
every = "1 ms"
quantities = ["probes", "velocity", "acceleration", "rotation"]
)";

}  // namespace

TEST(LinearLimit, TransientSettlesToTheUnbalanceResponse) {
  whirl::test::Record record("Linear limit of the nonlinear transient",
                             "the unbalance response of the same deck");
  const whirl::test::DeckRun r(deck);
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_FALSE(r.says("warning")) << r.log;
  const auto run = r.csv("run.csv").last(), steady = r.csv("steady_response.csv").last();
  // The angle of the rotor at the end, a row's last: u = A cos(phi - lag). 1e-6 of the amplitude;
  // the run was asked for 1e-8.
  const double Omega = 3600 * std::acos(-1.0) / 30, phi = run.at("disk phi [rad]"),
               major = steady.at("disk major [m]");
  for (const std::string axis : {"y", "z"}) {
    const double lag = steady.at("disk " + axis + " phase lag [deg]") * std::acos(-1.0) / 180;
    const double amplitude = steady.at("disk " + axis + " amplitude [m]");
    record.check("displacement " + axis, "m", run.at("disk." + axis + " [m]"),
                 amplitude * std::cos(phi - lag), 1e-6 * major);
    EXPECT_NEAR(run.at("disk velocity." + axis + " [m/s]"),
                -Omega * amplitude * std::sin(phi - lag), 1e-6 * Omega * major)
        << axis;
    EXPECT_NEAR(run.at("disk acceleration." + axis + " [m/s^2]"),
                -Omega * Omega * amplitude * std::cos(phi - lag), 1e-6 * Omega * Omega * major)
        << axis;
  }
}
