// Choices of a run.
#pragma once
#include <deck/deck.hpp>
#include <filesystem>
#include <functional>
#include <io/results.hpp>
#include <model/model.hpp>
#include <string>
#include <vector>

namespace whirl::run {

/// Choices of a run that do not change its results.
struct RunOptions {
  bool quiet = false;            ///< no progress, no summary on standard output
  bool json = false;             ///< the summary as JSON on standard output
  bool terminal = false;         ///< standard error is a terminal: one progress line, rewritten
  int jobs = 0;                  ///< threads for what can go in parallel; 0 = all processors
  bool savings = false;          ///< measure what leaving out parts of the general model saves
  bool resume = false;           ///< continue from the last checkpoint of the results folder
  double max_memory = 0;         ///< bytes a run may take; 0: what is available; infinite: any
  double max_disk = 0;           ///< bytes its output may take; 0: what is free
  std::filesystem::path output;  ///< results folder; empty: as the deck says
  std::vector<std::filesystem::path> inputs;  ///< files the deck reads: no results replace them
  /// Texts and tables that are written ("STEP_modes.csv"), into a folder of this run alone from which
  /// they are read at once; empty: everything, into a folder that is kept.
  std::vector<std::string> only_files;
  /// Called with every table that is written, by the thread that writes it.
  io::ResultsFolder::TableSeen seen_table;
  /// The model of the same deck with a key set otherwise ("parameters.clearance=75 um"), for steps
  /// that vary one. Throws as load_model().
  std::function<model::Model(const std::string& setting)> variant;
  /// The same with several keys set otherwise, for steps that vary the bearings.
  std::function<model::Model(const std::vector<std::string>& settings)> build;
};

}  // namespace whirl::run
