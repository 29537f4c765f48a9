// Gears with play that nothing presses together: steps without time see two rotors, and say so.
#include "deck_run.hpp"

#include <fmt/format.h>

using whirl::test::DeckRun;

namespace {

std::string pair_of_shafts(const std::string& torque, const std::string& mesh = "") {
  const auto line = [](const char* name, const char* more) {
    return fmt::format(
        "[[shaft]]\nname = \"{}\"\nmaterial = \"steel\"\n{}columns = [\"name\", \"length[mm]\", "
        "\"od[mm]\"]\nrows = [[\"a\", 200, 50], [\"b\", 200, 50]]\n",
        name, more);
  };
  const auto held = [](const char* name) {
    return fmt::format(
        "[[bearing]]\nat = \"{0}/a:start\"\ntype = \"rigid\"\ndirections = [\"x\", \"y\", "
        "\"z\"]\n[[bearing]]\nat = \"{0}/b:end\"\ntype = \"rigid\"\ndirections = [\"y\", \"z\"]\n",
        name);
  };
  const auto disk = [](const char* name, const char* at, double Ip) {
    return fmt::format(
        "[[disk]]\nname = \"{}\"\nat = \"{}\"\nmass = \"10 kg\"\nIp = \"{} kg.m^2\"\n", name, at,
        Ip);
  };
  const auto drive = [&](const char* at, const char* sign, const char* factor) {
    return fmt::format("[[drive]]\nat = \"{}\"\ntype = \"torque\"\ntorque = \"{}{} * {} N.m\"\n",
                       at, sign, factor, torque);
  };
  return "format = 1\n[model]\ngravity = \"0 m/s^2\"\n" + line("one", "") +
         line("two", "origin = [\"0 mm\", \"150 mm\", \"0 mm\"]\nspeed_ratio = -0.5\n") +
         disk("motor", "one/b:end", 0.2) + disk("fan", "two/b:end", 1.5) + held("one") +
         held("two") +
         R"([[bearing]]
name = "mesh"
at = "one/a:end"
to = "two/a:end"
type = "gear"
drive = "positive"
teeth = 20
other_teeth = 40
pitch_diameter = "100 mm"
stiffness = "2e8 N/m"
backlash = "40 um"
)" + mesh +
         drive("motor", "", "1") + drive("fan", "", "2") + R"([[step]]
name = "t"
type = "torsional"
modes = 2
max_speed = "3000 rpm"
)";
}

}  // namespace

TEST(OpenGears, AreSaid) {
  const DeckRun open(pair_of_shafts("0")), closed(pair_of_shafts("20"));
  ASSERT_EQ(open.exit, 0) << open.log;
  ASSERT_EQ(closed.exit, 0) << closed.log;
  EXPECT_TRUE(open.says("the teeth of 'mesh' do not touch at the equilibrium")) << open.log;
  EXPECT_FALSE(closed.says("do not touch")) << closed.log;
}

TEST(OpenGears, MeshWhereTheirShaftsAre) {
  const DeckRun apart(pair_of_shafts("20", "centre_angle = \"10 deg\"\n"));
  EXPECT_NE(apart.exit, 0) << apart.log;
  EXPECT_TRUE(apart.says("centre_angle is 10 deg, the shafts lie at 0 deg")) << apart.log;
  const DeckRun there(pair_of_shafts("20", "centre_angle = \"360 deg\"\n"));
  EXPECT_EQ(there.exit, 0) << there.log;
}
