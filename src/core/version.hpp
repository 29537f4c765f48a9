// Which program this is.
#pragma once
#include <string>

namespace whirl {

std::string version();       ///< "0.1.0"
std::string version_text();  ///< version, compiler, build type and optional components, a few lines

}  // namespace whirl
