// Ctrl-C and SIGTERM ask the running step to stop at its next mark (transient.hpp), within a fraction of
// a second; results and a checkpoint are then complete.
#pragma once
#include <atomic>

namespace whirl::app {

/// Set by the signal handler.
const std::atomic<bool>& interrupted();
/// Installs the handlers; a second signal ends the program at once.
void install_interrupt_handlers();

}  // namespace whirl::app
