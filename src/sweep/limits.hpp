// Whether a sweep fits into memory and on the disk, before any of it runs.
#pragma once
#include <sweep/plan.hpp>
#include <sweep/sweep.hpp>
#include <model/model.hpp>

namespace whirl::sweep {

/// Processes that do runs side by side.
int processes_of(const SweepOptions& options, const Plan& plan);

/// Bytes that one process of a sweep may take.
double memory_of_a_process(const SweepOptions& options, const Plan& plan);

/// @throws Error (Exit::deck): E44, the processes and the table of all runs would take more memory
/// than --max-memory or than is available; E33, rows, tables and results that are kept would take more
/// than --max-disk or than is free.
void check_limits(const SweepOptions& options, const Plan& plan, const model::Model& model);

}  // namespace whirl::sweep
