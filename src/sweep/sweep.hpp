// `whirl sweep DECK`: many runs of a deck with some of its keys varied, into one table.
#pragma once
#include <run/options.hpp>
#include <deck/deck.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::sweep {

struct SweepOptions {
  std::filesystem::path deck;
  deck::ReadOptions read;
  run::RunOptions run;                 ///< jobs, quiet, json, resume, output
  std::vector<std::string> vary;       ///< design.hpp
  std::vector<std::string> responses;  ///< response.hpp
  std::int64_t samples = 1;
  std::string sampling = "lhs";  ///< random, lhs or sobol
  std::uint64_t seed = 1;
  std::string shard;  ///< "2/7": every seventh run from the second; empty: all
  double limit = 0;   ///< s of wall time a run may take; 0: any
  bool keep = false;  ///< keep the results folder of every run
  bool list = false;  ///< run the deck as it is and list what can be a response
};

/// Runs what is not there yet and, when all runs are, writes sweep.csv (one row a run),
/// statistics.csv, effects.csv, summary.json and sweep.html.
/// @throws Error (E99, Exit::usage) for a sweep that cannot be made; as load_model() for its deck.
int run_sweep(const SweepOptions& options);

}  // namespace whirl::sweep
