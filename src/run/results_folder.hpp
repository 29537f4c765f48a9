// The results folder: what every run puts there before it computes anything.
#pragma once
#include <run/options.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::run {

/// Makes the folder (below the current directory unless absolute) and writes, each atomically:
///   resolved.toml
///       the deck with parameters put in, includes merged, defaults explicit, tables inlined: runs
///       by itself
///   run.json        program version and build, deck path, SHA-256 of resolved.toml, start time, steps
/// Pictures and checkpoints that earlier runs made there are removed unless the run is resumed;
/// files no run made are left alone. A large output is announced with its size.
/// @throws Error (Exit::io) when writing fails; (Exit::deck, E33) when the output would not fit on
/// its disk.
std::filesystem::path prepare_results(const model::Model& model, const RunOptions& options);

/// Names of the steps of the run that was started last in a folder; none where none is known of.
std::vector<std::string> steps_of_earlier_run(const std::filesystem::path& folder);

/// Removes what an earlier run of these steps wrote: summary, report, tables and series. They would stand
/// beside what a run that fails or is killed leaves, and among those of a deck that has changed.
void remove_results_of(const io::ResultsFolder& folder, const std::vector<std::string>& steps);

/// @throws Error (Exit::deck, E33): the output would not fit on the disk of the folder, which need
/// not be there yet, or would take more than RunOptions::max_disk.
void check_space(const model::Model& model, const RunOptions& options);

/// @throws Error (Exit::io, E91): the results folder cannot be made or written to.
void check_folder(const model::Model& model, const RunOptions& options);

/// SHA-256 of the resolved deck, in hexadecimal: `sha256sum resolved.toml` gives the same.
std::string deck_hash(const model::Model& model);

}  // namespace whirl::run
