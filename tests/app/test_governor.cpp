// The integral of a governor: from the beginning of the step in which it begins to act, and on
// through steps in which it goes on acting.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

/// A shaft at 500 rpm under a governor for 1000 rpm, kp 0.05 N m s/rad: 2.618 N m where its
/// integral is zero.
std::string deck(const std::string& drive_step, const std::string& steps,
                 const std::string& more = "") {
  return R"(format = 1
[[shaft]]
name = "s"
initial_spin = "500 rpm"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 1000, 50]]
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "a:end"
type = "rigid"
directions = ["y", "z"]
[[drive]]
name = "gov"
at = "a:start"
type = "torque"
)" + drive_step +
         R"(governor = { target = "1000 rpm", kp = "0.05 N.m.s/rad", ki = "0.05 N.m/rad" }
)" + more +
         steps + R"(
[output]
every = "0.01 s"
quantities = ["speed", "torque"]
report = false
)";
}
std::string step(const std::string& name, const std::string& from, const std::string& duration) {
  return "[[step]]\nname = \"" + name +
         "\"\ntype = \"transient\"\nintegrator = { tolerance = 1e-7 }\nduration = \"" + duration +
         "\"\n" + (from.empty() ? "" : "from = \"" + from + "\"\n");
}
/// A file of the results; the folder goes with the run.
Columns run(const std::string& text, const std::string& file) {
  const DeckRun d(text);
  EXPECT_EQ(d.exit, 0) << d.log;
  return d.csv(file);
}
constexpr double first = 0.05 * 500 * pi / 30;
const char* const torque = "drive gov torque [N.m]";

double value(const Columns& c, std::size_t row) { return c.rows.at(row).at(c.column(torque)); }

}  // namespace

TEST(Governor, IntegralBeginsWithItsStep) {
  // After 2 s of coasting at 500 rpm an integral counted from time 0 would add 0.05 N m/rad x 104.7
  // rad = 5.2 N m.
  const Columns a = run(deck("step = \"hold\"\n", step("hold", "", "2 s")), "hold.csv");
  const Columns b =
      run(deck("step = \"hold\"\n", step("coast", "", "2 s") + step("hold", "coast", "2 s")),
          "hold.csv");
  EXPECT_NEAR(value(a, 0), first, 1e-6 * first);
  EXPECT_NEAR(value(b, 0), first, 1e-6 * first);
  // the law does not know the time: both steps are one motion
  const std::size_t n = std::min(a.rows.size(), b.rows.size());
  ASSERT_GT(n, 190u);
  for (std::size_t k = 0; k < n; k += 10)
    EXPECT_NEAR(value(a, k), value(b, k), 1e-6 * first) << k;
}

TEST(Governor, GoesOnWithoutAJump) {
  // one run of 2 s, and the same in two steps in both of which it acts
  const Columns w = run(deck("", step("one", "", "2 s")), "one.csv");
  const std::string parts = deck("", step("one", "", "1 s") + step("two", "one", "1 s"));
  const Columns one = run(parts, "one.csv"), two = run(parts, "two.csv");
  EXPECT_NEAR(value(one, one.rows.size() - 1), value(two, 0), 1e-9 * first);
  // 1e-7 of the peak asked for, of a torque that is a thousandth of it
  EXPECT_NEAR(value(two, two.rows.size() - 1), value(w, w.rows.size() - 1), 1e-6 * first);
}

TEST(Governor, BeginsAfterAnEquilibriumThatFollowsAMotion) {
  const DeckRun d(
      deck("", step("one", "", "0.5 s") +
                   "[[step]]\nname = \"sag\"\ntype = \"static\"\nspeed = \"500 rpm\"\n" +
                   step("two", "sag", "0.5 s")));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NEAR(value(d.csv("two.csv"), 0), first, 1e-6 * first);
}

TEST(Governor, SeesNoAngleInSteadyStates) {
  // Its integral is no function of the angle of the rotor: at its target speed it gives no torque,
  // and the equilibrium needs none. Averaged over the angles of a revolution it gave -0.05 N m/rad
  // x 3 pi/4.
  const DeckRun d(
      deck("", "[[step]]\nname = \"still\"\ntype = \"static\"\nspeed = \"1000 rpm\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const io::Value still = d.summary("still");
  const io::Value& torques = still.at("torque that keeps the speed [N m]");
  if (!torques.is_null()) {
    EXPECT_NEAR(torques.at("s").number(), 0.0, 1e-9);
  }
}
