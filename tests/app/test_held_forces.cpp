// Forces of rigid supports in responses: what acts on the very place that is held reaches them too.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <core/types.hpp>

#include <cmath>
#include <complex>

namespace {

using namespace whirl;
using test::Columns;
using test::DeckRun;

/// 10 kg held along x and `held`, on a spring along z, with 1 kg mm of unbalance.
std::string held_mass(const std::string& held, const std::string& rest) {
  return test::lateral_mass(10, "0 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kzz = "1e6 N/m"
czz = "600 N.s/m"
[[unbalance]]
at = "mass"
amount = "1 kg.mm"
phase = "30 deg"
[[probe]]
name = "P"
at = "mass"
[output]
report = false
)" + rest,
                            held);
}

double at(const Columns& table, std::size_t row, const std::string& column) {
  return table.rows.at(row).at(table.column(column));
}

}  // namespace

// m e W^2 cos(W t + 30 deg) along y and nothing along z, which is free; W t runs on either way.
TEST(HeldForces, OfAnUnbalanceAreItsForce) {
  const DeckRun run(held_mass(R"("x", "y", "ry", "rz")", R"([[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["-1500 rpm", "1000 rpm", "1500 rpm"] }
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns u = run.csv("u_response.csv");
  ASSERT_EQ(u.rows.size(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    const double rpm = at(u, row, "speed [rpm]"), force = 1e-3 * std::pow(rpm * pi / 30, 2);
    EXPECT_NEAR(at(u, row, "bearing guide force y [N]"), force, 1e-9 * force) << rpm;
    const double lag = rpm > 0 ? 150 : -150;  // against the force, which leads by 30 degrees
    EXPECT_NEAR(std::remainder(at(u, row, "bearing guide force y phase lag [deg]") - lag, 360), 0,
                1e-6)
        << rpm;
    EXPECT_NEAR(at(u, row, "bearing guide force z [N]"), 0, 1e-9) << rpm;
  }
}

TEST(HeldForces, OfAHarmonicForceAreThatForce) {
  const DeckRun run(held_mass(R"("x", "y", "ry", "rz")", R"([[step]]
name = "h"
type = "harmonic_response"
frequency = { start = "20 Hz", stop = "40 Hz", points = 2 }
[[step.force]]
at = "mass"
force = ["5 N", "3 N", "10 N"]
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns h = run.csv("h_response.csv");
  for (std::size_t row = 0; row < 2; ++row) {
    const double w = two_pi * at(h, row, "frequency [Hz]");
    EXPECT_NEAR(at(h, row, "bearing guide force x [N]"), 5, 1e-9);
    EXPECT_NEAR(at(h, row, "bearing guide force y [N]"), 3, 1e-9);
    EXPECT_NEAR(at(h, row, "bearing guide force z [N]"), 0, 1e-9);
    const std::complex<double> spring(1e6, 600 * w);
    const double z = 10 / std::abs(spring - 10 * w * w);
    EXPECT_NEAR(at(h, row, "P z amplitude [m]"), z, 1e-9 * z);
    EXPECT_NEAR(at(h, row, "bearing spring force z [N]"), z * std::abs(spring), 1e-7);
  }
}

// Where nothing moves at all the force is still there.
TEST(HeldForces, AreThereWhereNothingMoves) {
  const DeckRun run(held_mass(R"("x", "y", "z", "ry", "rz")", R"([[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["1500 rpm"] }
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns u = run.csv("u_response.csv");
  const double force = 1e-3 * std::pow(1500 * pi / 30, 2);
  EXPECT_NEAR(at(u, 0, "bearing guide force y [N]"), force, 1e-9);
  EXPECT_NEAR(at(u, 0, "bearing guide force z [N]"), force, 1e-9);
}
