// Reading JSON.
#pragma once
#include <io/value.hpp>
#include <string_view>

namespace whirl::io {

/// JSON text as a value; NaN and Infinity, which some programs write, are no JSON.
/// @throws Error (E92) with the line; `name` is shown in the message.
Value parse_json(std::string_view text, std::string_view name);

}  // namespace whirl::io
