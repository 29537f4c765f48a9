// Tasks side by side: each once, and the failure of least number, for any number of threads.
#include <core/parallel.hpp>
#include <gtest/gtest.h>
#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace whirl {
namespace {

TEST(SideBySide, EveryTaskRunsOnce) {
  for (const int threads : {0, 1, 2, 7, 50}) {
    std::vector<std::atomic<int>> runs(23);
    run_side_by_side(runs.size(), threads, [&](std::size_t k) { ++runs[k]; });
    for (const auto& n : runs)
      EXPECT_EQ(n, 1) << threads << " threads";
  }
}

TEST(SideBySide, NothingToDoIsNoError) {
  run_side_by_side(0, 3, [](std::size_t) { FAIL(); });
}

TEST(SideBySide, TheFailureOfLeastNumberIsThrown) {
  for (const int threads : {1, 2, 4})
    for (int round = 0; round < 50; ++round) {
      std::string message;
      try {
        run_side_by_side(40, threads, [](std::size_t k) {
          if (k % 7 == 5) throw std::runtime_error(std::to_string(k));
        });
      } catch (const std::runtime_error& e) {
        message = e.what();
      }
      EXPECT_EQ(message, "5") << threads << " threads";
    }
}

TEST(SideBySide, NothingBeginsAfterAFailure) {
  std::atomic<int> begun{0};
  EXPECT_THROW(run_side_by_side(100000, 2,
                                [&](std::size_t) {
                                  ++begun;
                                  throw std::runtime_error("no");
                                }),
               std::runtime_error);
  EXPECT_LE(begun, 2);
}

}  // namespace
}  // namespace whirl
