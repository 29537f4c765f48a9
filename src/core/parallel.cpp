#include <core/contract.hpp>
#include <core/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <sched.h>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace whirl {

int processors() {
  cpu_set_t mine;
  CPU_ZERO(&mine);
  if (sched_getaffinity(0, sizeof mine, &mine) == 0) return std::max(1, CPU_COUNT(&mine));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace {

class Crew;
/// The call whose task the thread is at; which thread it is changes no result.
thread_local const Crew* crew_of_this_thread = nullptr;

/// The tasks of one call and who works at them.
class Crew {
 public:
  Crew(std::size_t count, std::size_t hands, const std::function<void(std::size_t)>& task)
      : count_(count),
        most_helpers_(hands - 1),
        task_(task),
        outer_(crew_of_this_thread),
        failed_(count) {}

  void work() {
    const Crew* before = std::exchange(crew_of_this_thread, this);
    take_tasks();
    crew_of_this_thread = before;
  }
  /// A call from within a task of another one, however deep.
  bool is_within(const Crew& other) const {
    for (const Crew* crew = outer_; crew != nullptr; crew = crew->outer_)
      if (crew == &other) return true;
    return false;
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }
  /// Helpers that would find something to do, beside those it has.
  std::size_t wanted() const {
    const std::size_t next = next_.load(std::memory_order_relaxed);
    if (stop_.load(std::memory_order_relaxed) || next >= count_) return 0;
    return std::min(count_ - next, most_helpers_ - helpers);
  }

  std::size_t helpers = 0;  ///< at work now; under the lock of the pool

 private:
  void take_tasks() {
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

  std::size_t count_, most_helpers_;
  const std::function<void(std::size_t)>& task_;
  const Crew* outer_;  ///< which outlives this one
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::size_t failed_;
  std::exception_ptr failure_;
};

/// The threads of one call and of all calls within its tasks: a helper that runs out of tasks takes
/// those of an inner call, so that there are never more hands than asked for, and none is idle while
/// there is work. Who has no task left to begin waits for those that others work at, and helps within
/// these alone: nothing waits for itself, or for what is not its own.
class Pool {
 public:
  explicit Pool(std::size_t hands) : spare_(hands - 1) {}
  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    changed_.notify_all();
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  void run(Crew& crew) {
    {
      const std::lock_guard lock(mutex_);
      open_.push_back(&crew);
      engage();
    }
    changed_.notify_all();
    crew.work();
    std::unique_lock lock(mutex_);
    std::erase(open_, &crew);
    while (crew.helpers > 0) {
      if (Crew* inner = crew_in_need(&crew))
        help_with(*inner, lock);
      else
        changed_.wait(lock);
    }
  }

 private:
  /// New threads where those that stand idle are too few.
  void engage() {
    std::size_t wanted = 0;
    for (const Crew* crew : open_)
      wanted += crew->wanted();
    for (std::size_t n = idle_; n < wanted && spare_ > 0; ++n, --spare_) {
      try {
        threads_.emplace_back([this] { help(); });
      } catch (const std::system_error&) {
        spare_ = 0;  // the machine has no more threads: those there are do it
        return;
      }
    }
  }

  /// The outermost call first: its tasks are the longest. within: of calls within that one alone; null:
  /// of all.
  Crew* crew_in_need(const Crew* within) const {
    const auto found = std::find_if(open_.begin(), open_.end(), [within](const Crew* crew) {
      return crew->wanted() > 0 && (within == nullptr || crew->is_within(*within));
    });
    return found == open_.end() ? nullptr : *found;
  }

  /// @pre the lock is held; it is held again afterwards
  void help_with(Crew& crew, std::unique_lock<std::mutex>& lock) {
    ++crew.helpers;
    lock.unlock();
    crew.work();
    lock.lock();
    if (--crew.helpers == 0) changed_.notify_all();
  }

  void help();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Crew*> open_;  ///< the outermost first
  std::size_t spare_;        ///< threads that may still be made
  std::size_t idle_ = 0;
  bool closing_ = false;
  std::vector<std::jthread> threads_;  ///< last: they end before what they use
};

/// The pool whose task the thread is at; which thread it is changes no result.
thread_local Pool* pool_of_this_thread = nullptr;

void Pool::help() {
  pool_of_this_thread = this;
  std::unique_lock lock(mutex_);
  while (!closing_) {
    if (Crew* crew = crew_in_need(nullptr)) {
      help_with(*crew, lock);
      continue;
    }
    ++idle_;
    changed_.wait(lock);
    --idle_;
  }
}

}  // namespace

void run_side_by_side(std::size_t count, int threads,
                      const std::function<void(std::size_t)>& task) {
  WHIRL_EXPECTS(threads >= 0);
  if (threads == 0) threads = processors();
  const auto most = static_cast<std::size_t>(threads);
  const std::size_t hands = std::min(count, most);
  if (hands <= 1) {
    for (std::size_t k = 0; k < count; ++k)
      task(k);
    return;
  }
  Crew crew(count, hands, task);
  if (pool_of_this_thread != nullptr) {
    pool_of_this_thread->run(crew);
  } else {
    Pool pool(most);
    pool_of_this_thread = &pool;
    pool.run(crew);
    pool_of_this_thread = nullptr;
  }
  crew.rethrow();
}

}  // namespace whirl
