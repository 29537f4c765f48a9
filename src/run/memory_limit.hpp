// How much memory a run may take, and whether it will.
#pragma once
#include <run/options.hpp>

namespace whirl::run {

/// Bytes that this process can still get: the least of what the machine has, its control groups and
/// `ulimit -v` leave; infinite where none of them says.
double available_memory();

/// The limit that was set, or else what is available, bytes.
double memory_limit(const RunOptions& options);

/// Call it before the mesh is made.
/// @throws Error (Exit::deck, E44): the run would take more memory than it may.
void check_memory(const model::Model& model, const RunOptions& options);

/// Whether as many steps as there are threads may run side by side within the limit.
bool steps_fit_side_by_side(const model::Model& model, const RunOptions& options);

}  // namespace whirl::run
