// What a run of a deck writes, held against what was approved before: any deck that any test runs, by
// the checksum of its text, in approved/runs/SUITE.txt. Whether a number is right other tests say; this
// one says that it has changed.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::test {

/// Of a line of a CSV file; a comma within quotes parts nothing.
std::vector<std::string> csv_cells(const std::string& line);

/// A file of results: its words by their checksum, its numbers such that a difference of 1 is nearly
/// 1e-4 of them. Columns: mean, a mean weighted by the row, and root mean square, against the largest
/// number of their unit. Other numbers: by their logarithm (those below 1e-9 are next to nothing).
struct Fingerprint {
  std::string file;  ///< "log" is what the run printed
  std::uint32_t words = 0;
  std::vector<double> numbers;
  std::size_t rows = 0;  ///< of a table; of long ones a little more may change
};

/// Of the tables, the summary, the resolved deck, the words of the figures and the log of a run.
/// @throws std::runtime_error when the summary is not JSON.
std::vector<Fingerprint> fingerprints(const std::filesystem::path& results, const std::string& log);

/// As approved/runs has it: file, checksum, rows, numbers. "~" may be anything, "*" any numbers on.
std::string line_of(const Fingerprint& of);

/// What differs between such a line and a fingerprint by more than rounding; empty: nothing.
std::string difference(const std::string& approved, const Fingerprint& now);

/// What differs from what was approved for this deck, a line each; empty: nothing, or the deck is not
/// among them. With WHIRL_APPROVED_RUNS_TO, a folder, the fingerprints are left there instead
/// (approved/update_runs.py).
std::vector<std::string> differences_from_approved(const std::string& suite,
                                                   const std::string& deck, int exit,
                                                   const std::filesystem::path& results,
                                                   const std::string& log);

}  // namespace whirl::test
