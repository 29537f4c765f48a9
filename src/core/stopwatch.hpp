// Run times: the processor's time of the whole process, and the clock on the wall. Both are always
// given, and named.
#pragma once
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <string>

namespace whirl {

struct RunTime {
  double cpu = 0, wall = 0;  ///< s
  RunTime& operator+=(const RunTime& more) {
    cpu += more.cpu;
    wall += more.wall;
    return *this;
  }
  /// "1.234 s CPU, 1.250 s wall"
  std::string text() const { return fmt::format("{:.3f} s CPU, {:.3f} s wall", cpu, wall); }
};

/// CPU time of the calling thread so far, s.
inline double thread_cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Counts from its construction.
class Stopwatch {
 public:
  RunTime elapsed() const { return {cpu_now() - cpu_, wall_now() - wall_}; }

 private:
  static double cpu_now() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  static double wall_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

  double cpu_ = cpu_now(), wall_ = wall_now();
};

}  // namespace whirl
