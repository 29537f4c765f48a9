// Responses at and near 0 Hz and 0 rpm of rotors that nothing holds at their angle: their inertia drowns
// in the rounding of the torsional stiffness there.
#include "deck_run.hpp"

#include <core/types.hpp>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

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
