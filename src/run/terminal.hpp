// What the user's terminal can do.
#pragma once
namespace whirl::run {

/// Standard output (1) or error (2) is a terminal.
bool is_terminal(int descriptor);
/// Colour codes are wanted there: a terminal that is not "dumb", and NO_COLOR (no-color.org) is
/// unset or empty.
bool wants_colour(int descriptor);

}  // namespace whirl::run
