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

/// Asks everything that runs to stop, because the run has failed elsewhere. Whoever calls it takes it
/// back when all have ended: what a signal asked for in between stays asked for.
void stop_what_runs();
void take_back_stop();

}  // namespace whirl::run
