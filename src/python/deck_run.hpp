// A run of a deck from a program of one's own: into its results folder, as `whirl run` does it,
// with an observer that can end it.
#pragma once
#include <filesystem>
#include <functional>
#include <python/deck_source.hpp>
#include <string>

namespace whirl::python {

struct RunChoices {
  std::filesystem::path output;  ///< empty: as the deck says
  int jobs = 0;                  ///< threads for what can go in parallel; 0 = all processors
  bool resume = false;           ///< go on from the last checkpoint
  bool quiet = true;             ///< nothing on standard output and standard error
  /// Called on the thread that runs, at most ten times a second; false ends the run, which writes
  /// what is finished and a checkpoint of a transient.
  std::function<bool(const std::string& step, double fraction, const std::string& text)> progress;
};

struct RunOutcome {
  std::filesystem::path folder;
  int exit_code = 0;  ///< core/error.hpp
  bool cancelled = false;
};

/// @throws Error as steps::run_deck(), E35 for a deck without steps.
/// @pre run::BorrowedSignals lives: the run may be stopped.
RunOutcome run(const DeckSource& source, const RunChoices& choices);

}  // namespace whirl::python
