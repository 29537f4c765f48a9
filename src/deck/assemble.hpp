// The document of a deck with everything that belongs to it: included files merged, --set arguments applied.
#pragma once
#include <deck/document.hpp>
#include <string>
#include <vector>

namespace whirl::deck {

struct AssembleOptions { bool files_allowed = true; };

/// Parses source 0 of `sources` (already there), reads and merges what it includes.
Document assemble(Sources& sources, Diagnostics& diagnostics, const AssembleOptions& options);
/// Applies "path=value" arguments; they become one more source, one argument a line.
void apply_overrides(Document& document, const std::vector<std::string>& arguments, Sources& sources, Diagnostics& diagnostics);

}  // namespace whirl::deck
