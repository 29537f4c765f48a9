// Independent tasks of one analysis side by side on threads. What a task gives must depend on its
// number alone, never on the thread or on other tasks: then results are the same bits for any
// number of threads.
#pragma once
#include <cstddef>
#include <functional>

namespace whirl {

/// Processors this process may run on, at least 1.
int processors();

/// Calls task(k) once for every k from 0 to count - 1, in this order on the calling thread where
/// threads = 1, else on up to `threads` threads that take the next number as they get free. Returns
/// when all have ended. threads: 0 = processors(). A call from within a task shares the threads of the
/// outermost call, which are never more than that one asked for.
/// @throws what the failed task of least number threw; no task is begun after one has failed.
void run_side_by_side(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

}  // namespace whirl
