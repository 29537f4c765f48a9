// Every kind of step alone in a deck, with the report and the frames for ParaView: nothing that is
// drawn may rest on what another step has left behind.
#include "deck_run.hpp"
#include "wheel_on_bearings.hpp"

#include <deck/deck.hpp>

namespace {

using whirl::test::DeckRun;
namespace fs = std::filesystem;

struct Kind {
  const char* name;
  const char* step;  ///< what stands after `type`
};

void PrintTo(const Kind& k, std::ostream* out) { *out << k.name; }

const std::string machine = whirl::test::wheel_on_bearings(R"([[unbalance]]
at = "wheel"
amount = "300 g.mm"
[[load]]
name = "thrust"
at = "right:end"
force = ["-2 kN", "0 N", "0 N"]
[[probe]]
name = "middle"
at = "wheel"
[[output.vtk]]
[[step]]
name = "s"
type = )");

class PicturesOf : public ::testing::TestWithParam<Kind> {};

TEST_P(PicturesOf, AStepThatStandsAlone) {
  const DeckRun run(machine + "\"" + GetParam().name + "\"\n" + GetParam().step);
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(fs::exists(run.folder / "r" / "report.html"));
  std::size_t pictures = 0;
  for (const fs::directory_entry& e : fs::recursive_directory_iterator(run.folder / "r"))
    pictures += e.path().extension() == ".svg" || e.path().extension() == ".pvd";
  EXPECT_GT(pictures, 0u) << run.log;
}

// What `check` says of them before the run: no fewer frames than are written, and their bytes within
// a half.
TEST_P(PicturesOf, HaveTheSizeThatCheckSays) {
  const std::string deck = machine + "\"" + GetParam().name + "\"\n" + GetParam().step;
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  double surfaces = 0, bytes = 0;
  if (fs::exists(run.folder / "r" / "vtk"))
    for (const fs::directory_entry& e :
         fs::recursive_directory_iterator(run.folder / "r" / "vtk")) {
      if (!e.is_regular_file()) continue;
      bytes += static_cast<double>(e.file_size());
      surfaces +=
          e.path().extension() == ".vtp" && e.path().string().find("surface") != std::string::npos;
    }
  const auto said = whirl::deck::estimate_output(whirl::deck::read_deck_text(deck).model);
  EXPECT_LE(surfaces, said.frames);
  if (!said.fewer_frames) {
    EXPECT_EQ(surfaces, said.frames);
  }
  if (surfaces == 0) return;
  const double ratio = bytes / surfaces / (said.pictures / said.frames);
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 1.5);
}

INSTANTIATE_TEST_SUITE_P(
    Steps, PicturesOf,
    ::testing::Values(Kind{"static", ""}, Kind{"modal", "speed = \"3000 rpm\"\nmodes = 6\n"},
                      Kind{"campbell", "speed = { stop = \"6000 rpm\", points = 5 }\n"},
                      Kind{"critical_speeds", "max_speed = \"6000 rpm\"\n"},
                      Kind{"critical_map",
                           "stiffness_min = \"1e6 N/m\"\nstiffness_max = \"1e9 N/m\"\npoints = 5\n"
                           "max_speed = \"20000 rpm\"\n"},
                      Kind{"stability", "speed = { stop = \"6000 rpm\", points = 4 }\n"},
                      Kind{"unbalance_response",
                           "speed = { start = \"100 rpm\", stop = \"6000 rpm\", points = 9 }\n"},
                      Kind{"harmonic_response",
                           "frequency = { start = \"1 Hz\", stop = \"100 Hz\", points = 9 }\n"
                           "force = [{ at = \"wheel\", force = [\"0 N\", \"1 N\", \"0 N\"] }]\n"},
                      Kind{"torsional", "max_speed = \"9000 rpm\"\n"}, Kind{"buckling", ""},
                      Kind{"transient", "duration = \"0.02 s\"\ninitial_speed = \"3000 rpm\"\n"}),
    [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
