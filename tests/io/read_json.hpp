// JSON that the program wrote, as values again.
#pragma once
#include <io/value.hpp>

#include <filesystem>
#include <string_view>

namespace whirl::tests {

/// @throws std::runtime_error when the text is not JSON.
io::Value parse_json(std::string_view text);
io::Value read_json(const std::filesystem::path& file);

}  // namespace whirl::tests
