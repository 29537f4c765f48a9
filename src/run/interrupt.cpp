#include <run/interrupt.hpp>
#include <run/borrowed_signals.hpp>
#include <core/interrupt.hpp>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstddef>

namespace whirl::run {

namespace {

std::atomic<int> asked_by{0};  // the signal that asked to stop
constexpr int by_program = -1;
static_assert(std::atomic<int>::is_always_lock_free);  // a handler may touch it

constexpr std::array<int, 4> borrowed{SIGINT, SIGTERM, SIGHUP, SIGPIPE};

extern "C" void on_signal(int sig) {
  // Ctrl-C twice ends it at once. A terminal that closes sends SIGHUP more than once, and other
  // signals with it.
  if (asked_by.exchange(sig) == sig && sig != SIGHUP) {
    std::signal(sig, SIG_DFL);
    std::raise(sig);
  }
  // last: take_back_stop() sees who asked as soon as it can clear this
  interrupt::flag.store(true);
}

void handle(int sig) {
  struct sigaction before {};
  ::sigaction(sig, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;  // nohup, or a job in the background
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(sig, &action, nullptr);
}

}  // namespace

const std::atomic<bool>& interrupted() { return interrupt::flag; }

void install_interrupt_handlers() {
  handle(SIGINT);
  handle(SIGTERM);
  handle(SIGHUP);
  // nobody reads the progress any more: the run goes on
  std::signal(SIGPIPE, SIG_IGN);
}

void ask_to_stop() {
  int nobody = 0;
  asked_by.compare_exchange_strong(nobody, by_program);
  interrupt::flag.store(true);
}

void stop_what_runs() { interrupt::flag.store(true); }

void take_back_stop() {
  if (asked_by != 0) return;
  interrupt::flag.store(false);
  if (asked_by != 0) interrupt::flag.store(true);
}

BorrowedSignals::BorrowedSignals() {
  for (std::size_t k = 0; k < borrowed.size(); ++k)
    ::sigaction(borrowed[k], nullptr, &before_[k]);
  run::asked_by = 0;
  interrupt::flag.store(false, std::memory_order_relaxed);
  install_interrupt_handlers();
}

BorrowedSignals::~BorrowedSignals() {
  for (std::size_t k = 0; k < borrowed.size(); ++k)
    ::sigaction(borrowed[k], &before_[k], nullptr);
  run::asked_by = 0;
  interrupt::flag.store(false, std::memory_order_relaxed);
}

int BorrowedSignals::asked_by() const { return std::max(0, run::asked_by.load()); }

}  // namespace whirl::run
