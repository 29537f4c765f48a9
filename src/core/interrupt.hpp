// Somebody wants the program to stop: one flag, which a signal handler sets and every long loop looks at.
//
// A transient step looks itself and stops where it can be continued. Everything else calls throw_if_interrupted() where it does the
// work that takes time (matrices of a speed, a mode, a frame): the exception unwinds to the run, which writes what is finished.
#pragma once
#include <atomic>
#include <exception>

namespace whirl {

/// Thrown by throw_if_interrupted(). Not an Error: what catches a failed attempt to try another must not catch this.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

namespace interrupt {
/// Set by signal handlers; never cleared.
inline std::atomic<bool> flag{false};
/// Depth of Shields.
inline std::atomic<int> shields{0};
static_assert(std::atomic<bool>::is_always_lock_free);   // a handler may touch it

/// While one lives, throw_if_interrupted() does not: for the short work that finishes an interrupted step.
class Shield {
 public:
  Shield() { ++shields; }
  ~Shield() { --shields; }
  Shield(const Shield&) = delete;
  Shield& operator=(const Shield&) = delete;
};
}  // namespace interrupt

/// @throws Interrupted when the program was asked to stop.
inline void throw_if_interrupted() {
  if (interrupt::flag.load(std::memory_order_relaxed) && interrupt::shields.load(std::memory_order_relaxed) == 0) throw Interrupted();
}

}  // namespace whirl
