// The texts a deck is made of: the deck, what it includes, CSV tables, --set arguments. Kept for
// the caret lines.
#pragma once
#include <core/error.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::deck {

/// A place in one of the texts.
struct Spot {
  int source = -1;  ///< index in Sources; -1 = nowhere
  int line = 0;     ///< from 1
  int column = 0;   ///< from 1, in characters
  int length = 1;   ///< characters underlined
};

inline constexpr std::size_t max_deck_bytes = 8u << 20;     // 8 MiB
inline constexpr std::size_t max_table_bytes = 256u << 20;  // 256 MiB
inline constexpr int max_depth = 64;  // of brackets, and parts of a dotted key

class Sources {
 public:
  struct Source {
    std::string name;              ///< as shown to the user
    std::filesystem::path folder;  ///< relative paths inside it start here
    std::string text;
    std::vector<std::size_t> line_start;
  };

  int add(std::string name, std::filesystem::path folder, std::string text);
  const Source& operator[](int i) const { return sources_[static_cast<std::size_t>(i)]; }
  std::string_view line(int source, int number) const;
  Where where(const Spot& s) const;
  /// The line shown under a diagnostic: by file name and line number; empty when the file is not
  /// one of these.
  std::string_view line(const Where& w) const;
  int size() const { return static_cast<int>(sources_.size()); }

 private:
  std::vector<Source> sources_;
};

/// Reads a whole file of at most `limit` bytes. On failure `text` is empty and `diagnostic` says
/// why (E02, E03).
struct FileText {
  std::string text;
  std::string code, message, hint;
  bool ok() const { return code.empty(); }
};
FileText read_file(const std::filesystem::path& path, std::size_t limit);
/// The same of standard input, which is read once and kept: steps that vary a parameter read their
/// deck again.
FileText read_standard_input(std::size_t limit);

/// Why the bytes cannot be a deck or a table (E03), found without parsing: empty, binary, not
/// UTF-8, nested too deeply.
struct TextProblem {
  std::string message, hint;
  int line = 0, column = 0;
  bool ok() const { return message.empty(); }
};
/// What a text is: TOML, the argument of a --set, or a table of values.
enum class TextKind { deck, argument, table };
TextProblem check_text(std::string_view text, TextKind kind);

}  // namespace whirl::deck
