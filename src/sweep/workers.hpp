// Runs side by side, each in a process of its own: one that crashes or hangs costs its own row.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace whirl::sweep {

/// How the process of a run ended where it did not answer.
enum class Ended { answered, crashed, out_of_time };

struct WorkerOptions {
  int processes = 1;
  double limit = 0;  ///< s of wall time a run may take; 0: any
};

/// Calls `run` for every task in processes forked from this one, which must have one thread, handing
/// out tasks as processes get free (short ones, of which many are left, one ahead), and `take` here
/// with what each gave, in the order they finish.
/// worker: 0 .. processes - 1. Stops handing out once the program is to be interrupted
/// (core/interrupt.hpp); what runs then is waited for.
/// run: its text must not hold a line end but may end with one; it must not throw. take: the task,
/// how it ended, the text, the signal number of a crash.
/// @throws Error (Exit::io) when no process can be started
void run_in_workers(std::span<const std::int64_t> tasks, const WorkerOptions& options,
                    const std::function<std::string(std::int64_t task, int worker)>& run,
                    const std::function<void(std::int64_t task, Ended ended,
                                             const std::string& text, int signal)>& take);

}  // namespace whirl::sweep
