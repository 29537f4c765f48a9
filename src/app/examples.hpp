// The example decks, built into the program for `whirl new`.
#pragma once
#include <vector>

namespace whirl::app {

struct Example {
  const char* folder;   ///< "01_paper_rotor"
  const char* deck;     ///< text of its deck.toml
};
/// In the order of their numbers.
const std::vector<Example>& examples();

}  // namespace whirl::app
