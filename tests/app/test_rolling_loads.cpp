// Load of every ball and roller, from the deck to the table of the results.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

std::string deck(const std::string& held, const std::string& force, const std::string& bearing) {
  return test::lateral_mass(
      20, "0 m/s^2",
      "[[load]]\nat = \"mass\"\nforce = [" + force +
          "]\n[[bearing]]\nname = \"tested\"\nat = \"mass\"\n" + bearing +
          "[[step]]\nname = \"load\"\ntype = \"static\"\n[output]\nreport = false\n",
      held);
}

}  // namespace

// Stribeck: Z Qmax/F without clearance, the load over one element: 4.345708935, 4.364492313,
// 4.368085065 for 8, 12, 16 balls, 4.077006838, .. for rollers.
TEST(RollingLoads, StribeckNumber) {
  const int Z[] = {8, 12, 16};
  const double ball[] = {4.345708935, 4.364492313, 4.368085065},
               roller[] = {4.077006838, 4.082806932, 4.084109416};
  for (std::size_t i = 0; i < 3; ++i)
    for (const bool balls : {true, false}) {
      const DeckRun d(
          deck(R"("x", "ry", "rz")", R"("0 N", "0 N", "-1000 N")",
               balls ? fmt::format("type = \"ball\"\nballs = {}\nball_diameter = \"8 "
                                   "mm\"\npitch_diameter = \"60 mm\"\n",
                                   Z[i])
                     : fmt::format("type = \"roller\"\nrollers = {}\nroller_diameter = \"8 "
                                   "mm\"\nroller_length = \"10 mm\"\npitch_diameter = \"60 mm\"\n",
                                   Z[i])));
      ASSERT_EQ(d.exit, 0) << d.log;
      const Columns t = d.csv("load_rolling.csv");
      ASSERT_EQ(t.rows.size(), static_cast<std::size_t>(Z[i]));
      double most = 0, z = 0;
      for (const auto& row : t.rows) {
        const auto e = t.named(row);
        most = std::max(most, e.at("load [N]"));
        z += e.at("load [N]") * std::sin(e.at("angle [deg]") * pi / 180);
      }
      EXPECT_NEAR(z, -1000, 1e-6);  // they carry it: the shaft presses down
      EXPECT_NEAR(Z[i] * most / 1000, balls ? ball[i] : roller[i], 1e-8)
          << (balls ? "balls " : "rollers ") << Z[i];
    }
}

// 218 angular-contact bearing under a thrust of 17,800 N (Harris & Kotzalas): Z = 16, D = 22.23 mm,
// 40 deg, B = 0.0464, axial constant 896.7 N/mm^2. Exact root of sin a (cos 40/cos a - 1)^1.5 =
// Fa/(Z D^2 K): 41.59207702 deg and 0.03831822 mm, every ball alike.
TEST(RollingLoads, AngularContact218UnderThrust) {
  const double D = 0.02223, K = 896.7e6 * D * D / std::pow(0.0464 * D, 1.5);
  const DeckRun d(
      deck(R"("y", "z", "ry", "rz")", R"("17800 N", "0 N", "0 N")",
           fmt::format("type = \"ball\"\nballs = 16\nball_diameter = \"22.23 mm\"\npitch_diameter "
                       "= \"125.27 mm\"\ncontact_angle = \"40 deg\"\nf_inner = 0.5232\nf_outer = "
                       "0.5232\nstiffness = \"{:.15g} N/m^1.5\"\n",
                       K)));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns balls = d.csv("load_rolling.csv"), shape = d.csv("load_deflection.csv");
  ASSERT_EQ(balls.rows.size(), 16u);
  for (const auto& row : balls.rows)
    EXPECT_NEAR(row[balls.column("load [N]")], 17800 / (16 * std::sin(41.59207702 * pi / 180)),
                1e-7 * 1700);
  EXPECT_NEAR(shape.rows[0][shape.column("u_x [m]")], 0.03831822e-3, 1e-7 * 3.8e-5);

  // stiffness in five motions: with s = (A sin 40 + x, A cos 40) between the groove centres, d =
  // |s| - A, every ball alike
  const Columns stiffness = d.csv("load_rolling_stiffness.csv");
  ASSERT_EQ(stiffness.rows.size(), 5u);
  const double A = 0.0464 * D,
               sa = A * std::sin(2 * pi / 9) + shape.rows[0][shape.column("u_x [m]")],
               sr = A * std::cos(2 * pi / 9), s = std::hypot(sa, sr), q = s - A;
  const double along = 1.5 * K * std::sqrt(q),
               across = K * std::pow(q, 1.5) / s;  // of one ball, along and across its load
  const auto k = [&](std::size_t i, std::size_t j) { return stiffness.rows[i][2 + j]; };
  EXPECT_NEAR(k(0, 0), 16 * (along * sa * sa + across * sr * sr) / (s * s),
              1e-5 * k(0, 0));  // f - 0.5 to four digits makes A
  for (const std::size_t i : {1u, 2u})
    EXPECT_NEAR(k(i, i), 8 * (along * sr * sr + across * sa * sa) / (s * s), 1e-5 * k(i, i));
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j)
      EXPECT_NEAR(k(i, j), k(j, i), 1e-9 * std::sqrt(k(i, i) * k(j, j)));
  EXPECT_GT(k(1, 4) * k(1, 4),
            0.1 * k(1, 1) * k(4, 4));  // lateral motion and tilt belong together under thrust
}
