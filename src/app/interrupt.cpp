#include <app/interrupt.hpp>

#include <csignal>

namespace whirl::app {

namespace {
std::atomic<bool> flag{false};
static_assert(std::atomic<bool>::is_always_lock_free);   // the handler may touch it

extern "C" void on_signal(int sig) {
  if (flag.exchange(true)) {
    std::signal(sig, SIG_DFL);
    std::raise(sig);
  }
}
}  // namespace

const std::atomic<bool>& interrupted() { return flag; }

void install_interrupt_handlers() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

}  // namespace whirl::app
