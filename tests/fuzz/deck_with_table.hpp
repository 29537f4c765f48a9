// A deck that names a table, which is what is fuzzed.
#pragma once
#include "scratch.hpp"

#include <deck/deck.hpp>

#include <cstdlib>

namespace whirl::fuzz {

/// Reads the deck with the bytes as its table.csv; what was read is read again from its own text.
inline int read_deck_with_table(const std::string& deck_text, const std::uint8_t* data,
                                std::size_t size) {
  write("table.csv", text_of(data, size));
  const deck::Deck read = deck::read_deck(write("deck.toml", deck_text), {});
  (void)read.report();
  if (!read.ok()) return 0;
  const deck::Deck again = deck::read_deck_text(read.model.resolved, "resolved.toml", {});
  if (!again.ok()) std::abort();
  return 0;
}

}  // namespace whirl::fuzz
