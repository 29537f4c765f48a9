// A deck read and parsed once, for many readings of it that differ in a few keys.
#pragma once
#include <deck/deck.hpp>
#include <deck/text/document.hpp>

#include <optional>

namespace whirl::deck {

class ParsedDeck {
 public:
  /// Reads the deck and what it includes; "-" is standard input. Never throws for what a deck can
  /// contain: every reading says what is wrong with it.
  explicit ParsedDeck(const std::filesystem::path& file, bool files_allowed = true);
  /// As read_deck() with these overrides. Files of values that the deck names are read each time.
  Deck read(const std::vector<std::string>& set) const;
  /// As load_model() with these overrides.
  /// @throws Error (Exit::deck or Exit::io)
  model::Model load(const std::vector<std::string>& set) const;
  /// Of a path as --set has it: the same for what names the same entry ("disk.0.mass",
  /// "disk.wheel.mass").
  std::string entry(const std::string& path) const;

 private:
  std::filesystem::path file_;
  bool files_allowed_;
  Sources sources_;
  std::optional<Diagnostic> unreadable_;
  Diagnostics diagnostics_;  ///< of the texts
  Document document_;
};

}  // namespace whirl::deck
