// What the commands do; the command line itself is main.cpp.
#pragma once
#include <deck/deck.hpp>
#include <filesystem>
#include <functional>
#include <model/model.hpp>
#include <string>
#include <vector>

namespace whirl::app {

/// Choices of a run that do not change its results.
struct RunOptions {
  bool quiet = false;            ///< no progress, no summary on standard output
  bool json = false;             ///< the summary as JSON on standard output
  bool terminal = false;         ///< standard error is a terminal: one progress line, rewritten
  int jobs = 0;                  ///< threads for what can go in parallel; 0 = all processors
  bool resume = false;           ///< continue from the last checkpoint of the results folder
  std::filesystem::path output;  ///< results folder; empty: as the deck says
  /// The model of the same deck with a key set otherwise ("parameters.clearance=75 um"), for steps that vary one. Throws as load_model().
  std::function<model::Model(const std::string& setting)> variant;
};

/// Runs all steps of a checked model. Returns the exit code (core/error.hpp); throws Error for what the user must know.
int run_deck(const model::Model& model, const RunOptions& options);

struct ReportOptions {
  std::filesystem::path results; ///< a results folder
  bool quiet = false;
};
/// Writes report.html of a results folder anew.
int report_results(const ReportOptions& options);

struct StudyOptions {
  std::filesystem::path deck;
  deck::ReadOptions read;
  RunOptions run;
  std::filesystem::path exact;   ///< CSV of the exact displacements of probes; empty: none
};
/// Error against run time of a deck over a ladder of tolerances, steps, integrators and meshes.
int study_deck(const StudyOptions& options);
/// Spectral radius, numerical damping and energy over very many steps of every integrator on the deck's rotor.
int study_stability(const StudyOptions& options);

}  // namespace whirl::app
