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
            "error[E33]: the output would take about 220.0 TB (histories 220.0 TB, pictures 0 kB), but only 50.0 GB are free\n     = hint: write rows less often: output.every\n");
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
