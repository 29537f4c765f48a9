#include <core/version.hpp>
#include <core/plugin.hpp>
#include <fmt/format.h>

namespace whirl {

std::string version() { return WHIRL_VERSION; }

std::string version_text() {
  std::string parts;
  for (const char* name : {"vtk", "hdf5", "sundials", "mpi"})
    parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", name,
                         Plugin::available(name) ? "yes" : "no");
  return fmt::format("whirl {}\ncompiler {}, {}\nplug-ins: {}\n", WHIRL_VERSION, __VERSION__,
                     *WHIRL_BUILD_TYPE ? WHIRL_BUILD_TYPE : "no build type", parts);
}

}  // namespace whirl
