// Ctrl-C, SIGTERM and SIGHUP ask the running step to stop (core/interrupt.hpp), which it does
// within a fraction of a second, a transient within a few seconds; what is finished is then
// written, and of a transient a checkpoint. A closed standard output or error does not end a run.
#pragma once
#include <atomic>

namespace whirl::run {

/// Set by the signal handler.
const std::atomic<bool>& interrupted();
/// Installs the handlers; Ctrl-C or SIGTERM a second time ends the program at once. Signals that
/// are ignored stay ignored (nohup).
void install_interrupt_handlers();

}  // namespace whirl::run
