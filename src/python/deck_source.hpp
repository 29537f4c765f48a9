// A deck as a program of one's own holds it: its text, and the keys set otherwise.
#pragma once
#include <deck/deck.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace whirl::python {

class DeckSource {
 public:
  /// name: in messages; relative paths inside the text start at folder.
  DeckSource(std::string text, std::string name, std::filesystem::path folder);
  /// @throws Error (E02, E03; Exit::io) for a file that cannot be read or cannot be a deck.
  static DeckSource from_file(const std::filesystem::path& file);

  const std::string& text() const { return text_; }
  const std::string& name() const { return name_; }
  /// path: as of `whirl run --set`; value: TOML, or the text itself. The last setting of a path
  /// counts.
  void set(const std::string& path, const std::string& value);
  /// "path=value", in the order in which they were first set.
  std::vector<std::string> settings() const;
  /// The deck as it is now, read once for all who ask.
  /// @throws Error with all diagnostics when there are errors.
  std::shared_ptr<const deck::Deck> read() const;
  /// Its model with further keys set.
  /// @throws Error as read().
  model::Model model_with(const std::vector<std::string>& more) const;
  /// The diagnostics as the program prints them, each with its source line and caret.
  std::string shown(const std::vector<Diagnostic>& diagnostics) const;

 private:
  deck::Deck read_with(const std::vector<std::string>& more) const;

  std::string text_, name_;
  std::filesystem::path folder_;
  std::vector<std::pair<std::string, std::string>> settings_;
  mutable std::shared_ptr<const deck::Deck> read_;
};

}  // namespace whirl::python
