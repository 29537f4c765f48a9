// Tasks side by side: each once, and the failure of least number, for any number of threads.
#include <core/parallel.hpp>
#include <gtest/gtest.h>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
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

/// How many there are inside at once, at most.
class Crowd {
 public:
  void enter() {
    const int now = ++inside_;
    for (int most = most_; now > most && !most_.compare_exchange_weak(most, now);) {}
  }
  void leave() { --inside_; }
  int inside() const { return inside_; }
  int most() const { return most_; }

 private:
  std::atomic<int> inside_{0}, most_{0};
};

TEST(SideBySide, CallsWithinTasksShareTheThreads) {
  for (const int threads : {1, 2, 3, 8}) {
    Crowd crowd;
    std::vector<std::atomic<int>> sums(5);
    run_side_by_side(sums.size(), threads, [&](std::size_t outer) {
      run_side_by_side(30, threads, [&](std::size_t inner) {
        crowd.enter();
        run_side_by_side(3, threads, [&](std::size_t k) { sums[outer] += static_cast<int>(k); });
        sums[outer] += static_cast<int>(inner);
        crowd.leave();
      });
    });
    for (const auto& sum : sums)
      EXPECT_EQ(sum, 30 * 29 / 2 + 30 * 3);
    EXPECT_LE(crowd.most(), threads);
  }
}

// The first outer task ends at once; who did it helps the other one, which waits for that.
TEST(SideBySide, WhoHasNothingLeftHelpsWithinTheTasksOfOthers) {
  using namespace std::chrono_literals;
  Crowd crowd;
  run_side_by_side(2, 2, [&](std::size_t outer) {
    if (outer == 0) return;
    run_side_by_side(2, 2, [&](std::size_t) {
      crowd.enter();
      const auto end = std::chrono::steady_clock::now() + 20s;
      while (crowd.most() < 2 && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(1ms);
      crowd.leave();
    });
  });
  EXPECT_EQ(crowd.most(), 2);
}

TEST(SideBySide, TheFailureOfAnInnerTaskIsThatOfItsOuterOne) {
  for (const int threads : {1, 2, 4}) {
    std::string message;
    try {
      run_side_by_side(6, threads, [threads](std::size_t outer) {
        run_side_by_side(6, threads, [outer](std::size_t inner) {
          if (outer >= 2 && inner >= 3)
            throw std::runtime_error(std::to_string(10 * outer + inner));
        });
      });
    } catch (const std::runtime_error& e) {
      message = e.what();
    }
    EXPECT_EQ(message, "23") << threads << " threads";
  }
}

}  // namespace
}  // namespace whirl
