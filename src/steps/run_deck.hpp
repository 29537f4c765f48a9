// The run of a deck, from the model to the results folder.
#pragma once
#include <run/options.hpp>

namespace whirl::steps {

/// Runs all steps of a checked model. Returns the exit code (core/error.hpp); throws Error for what
/// the user must know.
int run_deck(const model::Model& model, const run::RunOptions& options);

}  // namespace whirl::steps
