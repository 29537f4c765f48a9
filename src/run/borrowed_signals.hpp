// Stopping a run from a program that has signal handlers of its own, and runs more than one thing.
#pragma once
#include <array>
#include <csignal>

namespace whirl::run {

/// Asks the running step to stop, as the handlers of run/interrupt.hpp do. For other threads and for
/// observers.
void ask_to_stop();

/// While one lives the handlers are those of a run, and nobody has asked to stop yet; after it
/// everything is as before. One at a time in a process.
class BorrowedSignals {
 public:
  BorrowedSignals();
  ~BorrowedSignals();
  BorrowedSignals(const BorrowedSignals&) = delete;
  BorrowedSignals& operator=(const BorrowedSignals&) = delete;
  /// The signal that asked to stop, 0: none did. Whoever lent the handlers may want it raised again.
  int asked_by() const;

 private:
  std::array<struct sigaction, 4> before_{};
};

}  // namespace whirl::run
