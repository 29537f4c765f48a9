// The reference of decks as pages: docs/deck.md, how to read it and the list of pages, and docs/deck/.
#pragma once
#include <string>
#include <vector>

namespace whirl::deck {

struct ReferencePage {
  std::string file;  ///< relative to the folder of the manual: "deck/bearing_linear.md"
  std::string text;  ///< Markdown
};
/// One page a table of the deck, one a kind of bearing and of step.
std::vector<ReferencePage> reference_pages();

}  // namespace whirl::deck
