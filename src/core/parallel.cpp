#include <core/contract.hpp>
#include <core/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <sched.h>
#include <thread>
#include <vector>

namespace whirl {

int processors() {
  cpu_set_t mine;
  CPU_ZERO(&mine);
  if (sched_getaffinity(0, sizeof mine, &mine) == 0) return std::max(1, CPU_COUNT(&mine));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace {

class Crew {
 public:
  Crew(std::size_t count, const std::function<void(std::size_t)>& task)
      : count_(count),
        task_(task),
        failed_(count) {}

  void work() {
    while (!stop_.load(std::memory_order_relaxed)) {
      const std::size_t k = next_.fetch_add(1, std::memory_order_relaxed);
      if (k >= count_) return;
      try {
        task_(k);
      } catch (...) {
        remember(k);
      }
    }
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  /// Numbers are given out in order, so every task before the failed one has begun and will be heard
  /// of too.
  void remember(std::size_t k) {
    const std::lock_guard lock(mutex_);
    if (k < failed_) {
      failed_ = k;
      failure_ = std::current_exception();
    }
    stop_ = true;
  }

  std::size_t count_;
  const std::function<void(std::size_t)>& task_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::size_t failed_;
  std::exception_ptr failure_;
};

}  // namespace

void run_side_by_side(std::size_t count, int threads,
                      const std::function<void(std::size_t)>& task) {
  WHIRL_EXPECTS(threads >= 0);
  if (threads == 0) threads = processors();
  const std::size_t hands = std::min(count, static_cast<std::size_t>(threads));
  if (hands <= 1) {
    for (std::size_t k = 0; k < count; ++k)
      task(k);
    return;
  }
  Crew crew(count, task);
  {
    std::vector<std::jthread> others;
    for (std::size_t h = 1; h < hands; ++h)
      others.emplace_back([&crew] { crew.work(); });
    crew.work();
  }
  crew.rethrow();
}

}  // namespace whirl
