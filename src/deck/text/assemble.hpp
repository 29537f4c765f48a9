// The document of a deck with everything that belongs to it: included files merged, --set arguments
// applied.
#pragma once
#include <deck/text/document.hpp>
#include <string>
#include <vector>

namespace whirl::deck {

struct AssembleOptions {
  bool files_allowed = true;
};

/// Parses source 0 of `sources` (already there), reads and merges what it includes.
Document assemble(Sources& sources, Diagnostics& diagnostics, const AssembleOptions& options);
/// Applies "path=value" arguments; they become one more source, one argument a line.
void apply_overrides(Document& document, const std::vector<std::string>& arguments,
                     Sources& sources, Diagnostics& diagnostics);

/// Of a path as --set has it, with the members of lists by their numbers: the same for what names the
/// same entry. A path that leads nowhere: as far as it leads.
std::string entry_of(Document document, const std::string& path);

/// Whether a file that a deck names may be read. Messages quote what they are about, so that a deck
/// from somebody else could show the user's private files to whoever sees its messages: outside the
/// deck's own folder only names with one of the extensions are read.
bool may_be_read(const Sources& sources, const std::filesystem::path& file,
                 std::initializer_list<std::string_view> extensions);

}  // namespace whirl::deck
