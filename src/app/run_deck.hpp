// The run of a deck, from the model to the results folder.
#pragma once
#include <app/run.hpp>

namespace whirl::app {

/// Runs all steps of a checked model. Returns the exit code (core/error.hpp); throws Error for what the user must know.
int run_deck(const model::Model& model, const RunOptions& options);

}  // namespace whirl::app
