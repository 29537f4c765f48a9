// A motion that grows faster than the steps see it is damped by them: the run stays calm and must not be
// taken for a stable rotor.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

/// A heavy wheel on soft bearings turns at 20 Hz; on it stands a light wheel, on springs with which it whirls
/// at 1 kHz, driven by a cross-coupling of so much.
std::string machine(double cross, const std::string& integrator) {
  const auto shaft = [](const char* name, const char* disk, double mass) {
    return fmt::format(
        "[[shaft]]\nname = \"{0}\"\n[[shaft.section]]\nname = \"{0}s\"\nlength = \"200 mm\"\nrigid "
        "= "
        "true\n[[disk]]\nname = \"{1}\"\nat = \"{0}/{0}s:mid\"\nmass = \"{2} kg\"\nIp = \"{3} "
        "kg.m^2\"\nId = "
        "\"{4} kg.m^2\"\n",
        name, disk, mass, 0.01 * mass, 0.006 * mass);
  };
  return "format = 1\n[output]\nreport = false\nevery = \"1 ms\"\n[model]\ngravity = \"0 "
         "m/s^2\"\n" +
         shaft("heavy", "wheel", 20) + shaft("light", "ring", 0.5) +
         "[[bearing]]\nat = \"heavy/heavys:mid\"\ntype = \"linear\"\nkxx = \"1e6 N/m\"\nkyy = "
         "\"1e6 N/m\"\nkzz = "
         "\"1e6 N/m\"\nkrr = \"1e5 N.m/rad\"\ncyy = \"2e3 N.s/m\"\nczz = \"2e3 N.s/m\"\n" +
         fmt::format(
             "[[bearing]]\nat = \"light/lights:mid\"\nto = \"heavy/heavys:mid\"\ntype = "
             "\"linear\"\nkxx = \"2e7 N/m\"\nkyy = \"2e7 N/m\"\nkzz = \"2e7 N/m\"\nkrr = \"1e5 "
             "N.m/rad\"\nkyz = \"{0} N/m\"\nkzy = \"{1} N/m\"\n",
             cross, -cross) +
         "[[unbalance]]\nat = \"wheel\"\namount = \"200 g.mm\"\n[[probe]]\nname = \"p\"\nat = "
         "\"ring\"\n" +
         "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"1200 rpm\"\nmodes = 12\nmotion = "
         "\"lateral\"\n"
         "[[drive]]\nat = \"heavy/heavys:mid\"\ntype = \"speed\"\nspeed = \"1200 rpm\"\nstep = "
         "\"t\"\n"
         "[[drive]]\nat = \"light/lights:mid\"\ntype = \"speed\"\nspeed = \"1200 rpm\"\nstep = "
         "\"t\"\n"
         "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"0.3 s\"\nstart = "
         "\"unbalance_response\"\n" +
         integrator;
}

}  // namespace

TEST(HiddenGrowth, OfWhatTheStepsDoNotResolveIsSaid) {
  const DeckRun calm(machine(3e5, ""));
  ASSERT_EQ(calm.exit, 0) << calm.log;
  EXPECT_TRUE(calm.says("unstable though the run does not show it")) << calm.log;
  EXPECT_TRUE(calm.says("unstable, complete")) << calm.log;

  const DeckRun resolved(machine(3e5, "integrator = { dt_max = \"0.05 ms\" }\n"));
  EXPECT_FALSE(resolved.says("does not show it")) << resolved.log;

  const DeckRun stable(machine(0, ""));
  EXPECT_FALSE(stable.says("does not show it")) << stable.log;
}
