// Reading decks: the public face of this component.
#pragma once
#include <deck/text/sources.hpp>
#include <filesystem>
#include <model/model.hpp>
#include <string>
#include <vector>

namespace whirl::deck {

struct ReadOptions {
  std::vector<std::string> set;  ///< "path=value" overrides, applied before anything is checked
  bool files_allowed = true;  ///< false: included files and CSV tables are refused (untrusted text)
};

/// What came out of a deck. With errors the model is not to be used.
struct Deck {
  model::Model model;
  std::vector<Diagnostic> diagnostics;  ///< errors and warnings in the order of the text
  Sources sources;                      ///< the texts, for caret lines
  int errors = 0;
  bool ok() const { return errors == 0; }
  /// All diagnostics as shown to the user.
  std::string report(bool colour = false) const;
};

/// Reads and checks a deck; "-" is standard input. Never throws for what a deck can contain.
Deck read_deck(const std::filesystem::path& file, const ReadOptions& options = {});
/// The same from memory; `name` is shown in messages, relative paths start at `folder`.
Deck read_deck_text(std::string text, const std::string& name = "deck.toml",
                    const ReadOptions& options = {}, const std::filesystem::path& folder = {});
/// The model of a deck.
/// Warnings are in the model.
/// @throws Error (Exit::deck, or Exit::io for a file that cannot be read) with all diagnostics,
/// when there are errors.
model::Model load_model(const std::filesystem::path& file, const ReadOptions& options = {});

/// The exit code that fits the errors: Exit::usage for a bad --set, Exit::io for a deck that cannot
/// be read, else Exit::deck.
Exit exit_of(const std::vector<Diagnostic>& diagnostics);

/// Bytes the outputs of a model will take, roughly (rows of the histories, frames of pictures;
/// windows of time honoured).
struct OutputEstimate {
  double histories = 0, pictures = 0;
  double frames = 0;          ///< of the pictures
  bool fewer_frames = false;  ///< how many shapes or turns there are is for the run to find out:
                              ///< these are the most, or for peaks a guess
  bool at_most = false;  ///< rows are written inside a window of speed or amplitude only: there may
                         ///< be far fewer
  bool open = false;     ///< a step writes a row at each accepted step: how many is not known, and
                         ///< they are not counted here
  Where where;           ///< the step that writes most
  double total() const { return histories + pictures; }
};
OutputEstimate estimate_output(const model::Model& model);
/// "1.2 GB"
std::string size_text(double bytes);
/// E33 when the estimate exceeds `available` bytes, else nothing. is_asked_for: the user's limit, not
/// what is free.
std::vector<Diagnostic> check_output(const model::Model& model, double available,
                                     bool is_asked_for = false);

/// Bytes of memory that a run takes at its peak, roughly: measured on runs of 10 to 20,000 elements
/// within a factor of 2, and at least 0.7 of what they took.
struct MemoryEstimate {
  struct Part {
    std::string what;
    double bytes = 0;
  };
  double total = 0;
  std::vector<Part> parts;  ///< the largest first
  Where where;              ///< the step that takes most
};
/// threads: that work side by side, at one step after the other.
MemoryEstimate estimate_memory(const model::Model& model, int threads);
/// Bytes at the peak where as many steps as there are threads run side by side: at most.
double memory_of_steps_side_by_side(const model::Model& model, int threads);
/// E44 when the estimate exceeds `limit` bytes, else nothing. is_asked_for: as of check_output().
std::vector<Diagnostic> check_memory(const model::Model& model, int threads, double limit,
                                     bool is_asked_for = false);

}  // namespace whirl::deck
