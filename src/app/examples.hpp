// The example decks, built into the program for `whirl new`.
#pragma once
#include <vector>

namespace whirl::app {

struct ExampleFile {
  const char* name;
  const char* text;
};

struct Example {
  const char* folder;              ///< "01_paper_rotor"
  const char* deck;                ///< text of its deck.toml
  std::vector<ExampleFile> files;  ///< tables it reads from its folder
};
/// In the order of their numbers.
const std::vector<Example>& examples();

}  // namespace whirl::app
