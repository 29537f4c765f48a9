// Optional components live in shared modules that are opened only when a run asks for them.
#pragma once
#include <string>
#include <vector>

namespace whirl::time {

/// Opens lib<name>.so and returns the address of `symbol`; a module stays open to the end of the process.
/// Searched in order: each directory of $WHIRL_PLUGIN_PATH (colon-separated), the executable's directory, its ../lib and
/// ../lib/whirl, then the build's and the install's plug-in directory. Throws Error (exit code usage, code "E90" module
/// not found, "E91" symbol not found) that lists where it looked.
void* plugin_symbol(const std::string& name, const std::string& symbol);
/// True when the module can be opened.
bool plugin_available(const std::string& name);
/// Directories searched, in order.
std::vector<std::string> plugin_search_path();

}  // namespace whirl::time
