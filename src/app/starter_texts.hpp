// The texts of src/app/starters, built into the program.
#pragma once
#include <vector>

namespace whirl::app {

struct StarterText {
  const char* machine;  ///< name of the file
  const char* text;
};
const std::vector<StarterText>& starter_texts();

}  // namespace whirl::app
