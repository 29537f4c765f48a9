// Responses at and near 0 Hz and 0 rpm of rotors that nothing holds at their angle: their inertia drowns
// in the rounding of the torsional stiffness there.
#include "deck_run.hpp"

#include <core/types.hpp>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

/// 20 kg at 400 mm of 1000 mm, bearings at both ends that are not the same along y and z; gravity makes
/// the shaft sag.
std::string rotor(std::string_view damping, const std::string& step) {
  const std::string coefficients = fmt::format("{}kzz = \"1e7 N/m\"\n", damping);
  return "format = 1\n[output]\nreport = false\n"
         "[[shaft]]\nname = \"r\"\nmaterial = \"steel\"\n"
         "columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 400, 50], [\"b\", 600, "
         "50]]\n"
         "[[disk]]\nname = \"d\"\nat = \"a:end\"\nmass = \"20 kg\"\nIp = \"0.4 kg.m^2\"\n"
         "Id = \"0.2 kg.m^2\"\n"
         "[[bearing]]\nname = \"L\"\nat = \"a:start\"\ntype = \"linear\"\nkxx = \"1e7 N/m\"\n"
         "kyy = \"2e7 N/m\"\n" +
         coefficients +
         "[[bearing]]\nname = \"R\"\nat = \"b:end\"\ntype = \"linear\"\nkyy = \"1e7 N/m\"\n" +
         coefficients +
         "[[unbalance]]\nat = \"d\"\namount = \"100 g.mm\"\n[[probe]]\nname = \"p\"\nat = \"d\"\n"
         "[[step]]\nname = \"s\"\n" +
         step;
}

constexpr std::string_view damped = "cyy = \"1e3 N.s/m\"\nczz = \"1e3 N.s/m\"\n";

}  // namespace

// The supports share a force by its levers. The damping of bearings at a journal that the spin moves by
// 1e-18 m was taken for a damping of the spin, and turned the rotor by 1e13 rad.
TEST(Standstill, AStillForceIsSharedByItsLevers) {
  for (const std::string_view damping : {std::string_view(), damped})
    for (const char* about : {"equilibrium", "undeformed"})
      for (const char* frequencies : {R"("0 Hz", "10 Hz")", R"("1e-12 Hz", "10 Hz")",
                                      R"("1e-6 Hz", "1e-4 Hz", "1e-3 Hz", "1e-2 Hz")"}) {
        const DeckRun run(rotor(
            damping,
            fmt::format("type = \"harmonic_response\"\nabout = \"{}\"\nfrequency = {{ values = "
                        "[{}] }}\n[[step.force]]\nat = \"d\"\nforce = [\"0 N\", "
                        "\"1 N\", \"0 N\"]\n",
                        about, frequencies)));
        const std::string what = fmt::format("{} {} {}: {}", damping, about, frequencies, run.log);
        ASSERT_EQ(run.exit, 0) << what;
        const Columns response = run.csv("s_response.csv");
        for (const auto& row : response.rows) {
          if (row[response.column("frequency [Hz]")] > 1.0) continue;
          EXPECT_NEAR(row[response.column("bearing L force y [N]")], 0.6, 1e-6) << what;
          EXPECT_NEAR(row[response.column("bearing R force y [N]")], 0.4, 1e-6) << what;
          EXPECT_NEAR(row[response.column("bearing L force z [N]")], 0.0, 1e-6) << what;
        }
      }
}

// The search for peaks walked to 1e-87 rpm, where the spin's inertia is nothing: one "peak" of 1e103 m
// there, and the true ones gone.
TEST(Standstill, ARangeThroughZeroSpeedHasThePeaksOfBothSenses) {
  for (const char* about : {"equilibrium", "undeformed"})
    for (const char* range : {"start = \"-9000 rpm\", stop = \"9000 rpm\", points = 21",
                              "start = \"-9000 rpm\", stop = \"9000 rpm\", points = 22",
                              "start = \"-9000 rpm\", stop = \"9000 rpm\", points = 10",
                              "start = \"-9000 rpm\", stop = \"0 rpm\", points = 21"}) {
      const DeckRun run(rotor(
          damped, fmt::format("type = \"unbalance_response\"\nabout = \"{}\"\nspeed = {{ {} }}\n",
                              about, range)));
      const std::string what = fmt::format("{} {}: {}", about, range, run.log);
      ASSERT_EQ(run.exit, 0) << what;
      const bool both = std::string_view(range).find("stop = \"9000") != std::string_view::npos;
      const Columns peaks = run.csv("s_peaks.csv");
      const std::size_t speed = peaks.column("speed [rpm]"), size = peaks.column("amplitude [m]");
      ASSERT_EQ(peaks.rows.size(), both ? 4u : 2u) << what;
      for (std::size_t k = 0; both && k < 2; ++k) {
        EXPECT_NEAR(peaks.rows[k][speed] / -peaks.rows[3 - k][speed], 1.0, 1e-6) << what;
        EXPECT_NEAR(peaks.rows[k][size] / peaks.rows[3 - k][size], 1.0, 1e-6) << what;
      }
      EXPECT_FALSE(run.says("not finite")) << what;
    }
}

// A torque that turns a free train has no twist at 0 Hz, and leaves in its shafts what the inertia of the
// discs takes up beyond them: of 100 N m at the second of 4, 0.5 and 3 kg m2 100 4/7.5 at most.
TEST(Standstill, AStillTorqueIsSharedByInertia) {
  for (const char* motion : {"all", "torsional"})
    for (const char* frequencies : {R"("0 Hz", "1 Hz")", R"("1e-9 Hz", "1e-3 Hz")"}) {
      const DeckRun run(
          "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 "
          "m/s^2\"\n[[material]]\nname = \"light\"\nE = \"210 "
          "GPa\"\nnu = 0.3\n"
          "density = \"1e-3 kg/m^3\"\n[[shaft]]\nname = \"a\"\nmaterial = \"light\"\ncolumns = "
          "[\"name\", "
          "\"length[mm]\", \"od[mm]\"]\nrows = [[\"s\", 400, 60], [\"t\", 500, 50]]\n" +
          [] {
            std::string disks;
            for (const auto& [at, inertia] :
                 {std::pair{"s:start", 4.0}, {"s:end", 0.5}, {"t:end", 3.0}})
              disks += fmt::format(
                  "[[disk]]\nat = \"{}\"\nmass = \"10 kg\"\nIp = \"{} kg.m^2\"\nId = "
                  "\"{} kg.m^2\"\n",
                  at, inertia, 0.6 * inertia);
            return disks;
          }() +
          "[[bearing]]\nname = \"A\"\nat = \"s:start\"\ntype = \"rigid\"\ndirections = [\"x\", "
          "\"y\", "
          "\"z\"]\n[[bearing]]\nname = \"B\"\nat = \"t:end\"\ntype = \"rigid\"\ndirections = "
          "[\"y\", "
          "\"z\"]\n[[probe]]\nname = \"p\"\nat = \"s:end\"\n[[step]]\nname = \"s\"\ntype = "
          "\"harmonic_response\"\nmotion = \"" +
          std::string(motion) + "\"\nfrequency = { values = [" + frequencies +
          "] }\n[[step.force]]\nat = \"s:end\"\nmoment = [\"100 N.m\", \"0 N.m\", \"0 N.m\"]\n");
      const std::string what = fmt::format("{} {}: {}", motion, frequencies, run.log);
      ASSERT_EQ(run.exit, 0) << what;
      const Columns response = run.csv("s_response.csv");
      const std::vector<double>& row = response.rows.at(0);
      // the shaft towards 4 kg m2 takes what that one takes up, the other what 3 kg m2 take up
      EXPECT_NEAR(row[response.column("largest torque in a [N.m]")], 100 * 4.0 / 7.5, 1e-3) << what;
      EXPECT_NEAR(row[response.column("bearing A force y [N]")], 0.0, 1e-6) << what;
      const double twist = row[response.column("p twist amplitude [rad]")];
      EXPECT_TRUE(std::isnan(twist) || twist > 1e6) << what;
    }
}

// The error of nothing was told as that of the elements.
TEST(Standstill, NoResponseHasNoError) {
  const DeckRun run(
      rotor(damped, "type = \"unbalance_response\"\nspeed = { values = [\"0 rpm\"] }\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_FALSE(run.says("the mesh is too coarse")) << run.log;
  EXPECT_FALSE(run.says("W10")) << run.log;
}
