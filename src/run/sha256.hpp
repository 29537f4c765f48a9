// SHA-256 (FIPS 180-4), to name the deck a result belongs to.
#pragma once
#include <string>
#include <string_view>

namespace whirl::run {

std::string sha256_hex(std::string_view bytes);

}  // namespace whirl::run
