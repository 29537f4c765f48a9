// Steps of a given length: their errors are judged by the response of the whole run, not by the little
// that has moved when the first ones are made.
#include "deck_run.hpp"
#include "unbalanced_rotor.hpp"

#include <cmath>
#include <string>

namespace {

using whirl::test::Columns;
using whirl::test::DeckRun;

std::string in_steps_of(const std::string& integrator) {
  return std::string(whirl::test::unbalanced_rotor) + R"([[drive]]
name = "motor"
at = "disk"
type = "speed"
speed = "3000 rpm"
[[probe]]
name = "p"
at = "disk"
[[step]]
name = "t"
type = "transient"
start = "rest"
duration = "0.3 s"
[step.integrator]
)" + integrator +
         "[output]\nreport = false\nevery = \"1 ms\"\n";
}

double off(const DeckRun& d, const Columns& right) {
  const Columns rows = d.csv("t.csv");
  const std::size_t y = right.column("p.y [m]");
  double error = 0, peak = 0;
  for (std::size_t k = 0; k < right.rows.size(); ++k) {
    error = std::max(error, std::abs(rows.rows.at(k)[y] - right.rows[k][y]));
    peak = std::max(peak, std::abs(right.rows[k][y]));
  }
  return error / peak;
}

}  // namespace

// The rotor starts from rest: what the first steps move is nothing beside the response.
TEST(EqualSteps, ShortOnesAreNotSaidToBeTooLong) {
  const DeckRun exact(in_steps_of("tolerance = 1e-9\nmethod = \"gauss6\"\n"));
  ASSERT_EQ(exact.exit, 0) << exact.log;
  const Columns right = exact.csv("t.csv");
  for (const std::string method : {"radau5", "gauss4", "gauss6"}) {
    const DeckRun d(in_steps_of("method = \"" + method + "\"\ndt = \"0.05 ms\"\n"));
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_LT(off(d, right), 1e-4) << method;
    EXPECT_FALSE(d.says("too long")) << d.log;
    const auto accuracy = d.summary("t").at("accuracy");
    EXPECT_LT(accuracy.at("local error / allowance, max").number(), 1.0) << method;
    EXPECT_LE(accuracy.at("local error / allowance, mean").number(),
              accuracy.at("local error / allowance, max").number());
  }
}

TEST(EqualSteps, LongOnesAre) {
  for (const std::string method : {"radau5", "gauss4", "generalized_alpha"}) {
    const DeckRun d(in_steps_of("method = \"" + method + "\"\ndt = \"2.5 ms\"\n"));
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_TRUE(d.says("the fixed step is too long for the accuracy asked for")) << d.log;
  }
}
