#include <core/error.hpp>
#include <deck/deck.hpp>
#include <gtest/gtest.h>

using namespace whirl;

TEST(OutputEstimate, RefusesWhatDoesNotFit) {
  const auto d = deck::read_deck_text(R"(format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40]]
[[probe]]
at = "a:mid"
[[step]]
type = "transient"
start = "rest"
duration = "1e6 s"
[output]
every = "1 us"
)");
  ASSERT_TRUE(d.ok()) << d.report();
  // 1e12 rows of 2 + 1 + 2 + 6 columns, 20 characters each
  EXPECT_DOUBLE_EQ(deck::estimate_output(d.model).histories, 1e12 * 11 * 20);
  EXPECT_TRUE(deck::check_output(d.model, 1e15).empty());
  const auto problems = deck::check_output(d.model, 5e10);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(format(problems[0]),
            "deck.toml:8:1: error[E33]: the output would take about 220.0 TB (histories 220.0 TB, "
            "pictures 0 kB), but only 50.0 GB are free\n     = hint: write rows less often: "
            "output.every\n");
}

TEST(OutputEstimate, KnowsHowFramesArePacked) {
  const auto pictures = [](const std::string& how) {
    const auto d = deck::read_deck_text(R"(format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40]]
[[step]]
type = "transient"
start = "rest"
duration = "1 s"
[[output.vtk]]
)" + how);
    EXPECT_TRUE(d.ok()) << d.report();
    return deck::estimate_output(d.model).pictures;
  };
  const double lz4 = pictures("");
  EXPECT_EQ(pictures("compression = \"lz4\""), lz4);
  EXPECT_GT(pictures("compression = \"none\""), 1.3 * lz4);
  EXPECT_LT(pictures("compression = \"zlib\""), 0.9 * lz4);
  EXPECT_LT(pictures("format = \"vtkhdf\""), 0.5 * lz4);
  EXPECT_LT(pictures("format = \"vtkhdf\"\ncompression = \"none\""),
            pictures("compression = \"none\""));
}

TEST(OutputEstimate, FramesAreCapped) {
  const char* text = R"(format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40]]
[[step]]
type = "transient"
start = "rest"
duration = "1000 s"
[[output.vtk]]
every = "1 us"
max_frames = 100
content = ["line"]
)";
  const auto d = deck::read_deck_text(text);
  ASSERT_TRUE(d.ok()) << d.report();
  const double one_frame = deck::estimate_output(d.model).pictures / 100;
  EXPECT_GT(one_frame, 1e3);
  EXPECT_LT(one_frame, 1e5);
}

namespace {

/// A transient of 1000 s with rows every 0.1 us: 3 TB and more if they were all written.
std::string long_run(const std::string& more_output, const std::string& more_steps = "") {
  return R"(format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40]]
[[step]]
name = "first"
type = "transient"
start = "rest"
duration = "1000 s"
)" + more_steps +
         "[output]\nevery = \"0.1 us\"\n" + more_output;
}

double histories_of(const std::string& text) {
  const auto d = deck::read_deck_text(text);
  EXPECT_TRUE(d.ok()) << d.report();
  return deck::estimate_output(d.model).histories;
}

constexpr double row = (2 + 1 + 6) * 20;  // bytes: columns times characters

}  // namespace

TEST(OutputEstimate, CountsRowsInsideTheWindowOnly) {
  EXPECT_DOUBLE_EQ(histories_of(long_run("")), 1e10 * row);
  EXPECT_NEAR(histories_of(long_run("window = [\"0.01 s\", \"0.011 s\"]\n")), 1e4 * row,
              1e-6 * row);
  // the window is partly, or wholly, beyond the end
  EXPECT_NEAR(histories_of(long_run("window = [\"999.999 s\", \"1001 s\"]\n")), 1e4 * row,
              1e-3 * row);
  EXPECT_EQ(histories_of(long_run("window = [\"2000 s\", \"2001 s\"]\n")), 0.0);
}

TEST(OutputEstimate, AStepThatGoesOnHasItsTimesAfterThoseBefore) {
  const std::string second =
      "[[step]]\nname = \"second\"\ntype = \"transient\"\nfrom = \"first\"\nduration = \"10 s\"\n";
  EXPECT_NEAR(histories_of(long_run("window = [\"1001 s\", \"1001.001 s\"]\n", second)), 1e4 * row,
              1e-3 * row);
}

TEST(OutputEstimate, RowsInsideAWindowOfSpeedMayBeFew) {
  const auto d = deck::read_deck_text(long_run("speed_window = [\"100 rpm\", \"101 rpm\"]\n"));
  ASSERT_TRUE(d.ok()) << d.report();
  EXPECT_TRUE(deck::estimate_output(d.model).at_most);
  EXPECT_TRUE(deck::check_output(d.model, 1e6).empty());
}

// Eight turns a second for ten seconds, there and back: as many frames as a turn has.
TEST(OutputEstimate, FramesByTurnsAreThoseOfTheDrive) {
  const auto frames = [](const std::string& window) {
    const auto d = deck::read_deck_text(R"(format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40]]
[[drive]]
at = "a:start"
type = "speed"
speed = { type = "ramp", time = ["0 s", "10 s"], value = ["480 rpm", "-480 rpm"] }
[[step]]
type = "transient"
start = "rest"
duration = "10 s"
[[output.vtk]]
frames_per_revolution = 6
)" + window);
    EXPECT_TRUE(d.ok()) << d.report();
    return deck::estimate_output(d.model);
  };
  EXPECT_NEAR(frames("").frames, 40 * 6 + 1, 0.01);
  EXPECT_FALSE(frames("").fewer_frames);
  EXPECT_TRUE(frames("window = [\"1 s\", \"2 s\"]\n").fewer_frames);
}
