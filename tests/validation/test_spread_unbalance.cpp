// A pinned slender shaft whose mass centres all lie e beside it, no transverse but polar inertia,
// in turning axes:
//   EI d4w/dx4 - rhoIp W^2 d2w/dx2 - rhoA W^2 w = rhoA e W^2,
//       w(L/2) = e ((b^2/cosh(a L/2) + a^2/cos(b L/2))/(a^2 + b^2) - 1),
// a^2 and -b^2 the roots of EI r^2 - rhoIp W^2 r - rhoA W^2 = 0.
#include "../app/deck_run.hpp"
#include "record.hpp"
#include <gtest/gtest.h>
#include <cmath>

namespace {

constexpr double pi = 3.14159265358979323846;

std::string deck(const std::string& unbalance, int elements) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "own steel"
E = "210 GPa"
nu = 0.3
density = "7850 kg/m^3"
[[shaft]]
name = "rotor"
material = "own steel"
shear = "none"
rotary_inertia = false
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 500, 30, )" +
         std::to_string(elements) + R"(], ["b", 500, 30, )" + std::to_string(elements) + R"(]]
[[bearing]]
name = "L"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "R"
at = "b:end"
type = "rigid"
directions = ["y", "z"]
)" + unbalance +
         R"(
[[probe]]
name = "middle"
at = "a:end"
[[step]]
name = "response"
type = "unbalance_response"
speed = { values = ["1500 rpm", "6000 rpm"] }
[output]
report = false
)";
}

}  // namespace

TEST(SpreadUnbalance, UniformEccentricityOfAPinnedShaft) {
  whirl::test::Record record("Unbalance spread over a shaft",
                             "closed form of a pinned slender shaft with a uniform eccentricity");
  const double A = pi / 4 * 0.03 * 0.03, I = pi / 64 * std::pow(0.03, 4), e = 20e-6,
               amount = 7850 * A * e * 1.0;
  const whirl::test::DeckRun r(
      deck("[[unbalance]]\nname = \"all along\"\nat = \"a:start\"\nto = \"b:end\"\namount = \"" +
               std::to_string(amount * 1e6) + " g.mm\"\n",
           4));
  ASSERT_EQ(r.exit, 0) << r.log;
  const auto rows = r.csv("response_response.csv");
  ASSERT_EQ(rows.rows.size(), 2u);
  for (const auto& row : rows.rows) {
    const auto x = rows.named(row);
    const double W = x.at("speed [rpm]") * pi / 30, p = 7850 * 2 * I * W * W / (210e9 * I),
                 q = 7850 * A * W * W / (210e9 * I);
    const double a2 = 0.5 * (p + std::sqrt(p * p + 4 * q)), b2 = a2 - p;
    const double exact =
        e *
        ((b2 / std::cosh(0.5 * std::sqrt(a2)) + a2 / std::cos(0.5 * std::sqrt(b2))) / (a2 + b2) -
         1);
    // 8 elements; the error of order 4 and more
    record.check(std::to_string(static_cast<int>(x.at("speed [rpm]") + 0.5)) + " rpm: middle", "m",
                 x.at("middle major [m]"), std::abs(exact), 2e-5 * std::abs(exact));
  }
}

TEST(SpreadUnbalance, BadInput) {
  const auto wrong = [](const std::string& places, const char* message) {
    const whirl::test::DeckRun r(deck("[[unbalance]]\n" + places + "amount = \"10 g.mm\"\n", 2));
    EXPECT_EQ(r.exit, 3) << r.log;
    EXPECT_TRUE(r.says(message)) << r.log;
  };
  wrong("at = \"b:end\"\nto = \"a:start\"\n", "not to the right of its beginning");
  wrong("at = \"a:start\"\nto = \"c:end\"\n", "c:end");
}
