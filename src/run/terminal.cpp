#include <run/terminal.hpp>
#include <cstdlib>
#include <string_view>
#include <unistd.h>

namespace whirl::run {

bool is_terminal(int descriptor) { return ::isatty(descriptor) == 1; }

bool wants_colour(int descriptor) {
  const char* no = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  return is_terminal(descriptor) && !(no && *no) && term && std::string_view(term) != "dumb" &&
         *term;
}

}  // namespace whirl::run
