// `whirl sweep DECK`: many runs of a deck with some of its keys varied, into one table.
#pragma once
#include <run/options.hpp>
#include <deck/deck.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace whirl::sweep {

struct SweepOptions {
  std::filesystem::path deck;
  deck::ReadOptions read;
  run::RunOptions run;                    ///< jobs, quiet, json, resume, output
  std::vector<std::string> vary;          ///< design.hpp
  std::vector<std::string> responses;     ///< response.hpp
  std::optional<std::int64_t> samples;    ///< else of the deck, as all that is not given
  std::string sampling;                   ///< random, lhs, sobol, saltelli, morris or one_at_a_time
  std::vector<std::string> correlations;  ///< "PATH,PATH=0.6"
  std::vector<std::string> exceed;        ///< "NAME>VALUE" or "NAME<VALUE": how probable that is
  std::vector<std::string> worst;         ///< "NAME[:least|:largest][:COUNT]": run again in full
  std::optional<std::uint64_t> seed;
  /// "2/7": every seventh run from the second; "auto": as the queue or mpirun says; empty: all
  std::string shard;
  double limit = 0;   ///< s of wall time a run may take; 0: any, or that of the deck
  bool keep = false;  ///< keep the results folder of every run
  bool hdf5 = false;  ///< also write the table of runs to sweep.h5
  bool list = false;  ///< run the deck as it is and list what can be a response
};

/// Runs what is not there yet and, when all runs are, writes sweep.csv (one row a run),
/// statistics.csv, effects.csv, summary.json and sweep.html. Under mpirun rank 0 hands out the runs
/// and writes (ranks.hpp).
/// @throws Error (E99, Exit::usage) for a sweep that cannot be made; as load_model() for its deck.
int run_sweep(const SweepOptions& options);

}  // namespace whirl::sweep
