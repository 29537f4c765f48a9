#include <core/error.hpp>
#include <core/plugin.hpp>
#include <dlfcn.h>
#include <fmt/format.h>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <vector>

namespace whirl {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& name, std::string message, std::string hint) {
  throw Error(Exit::io, Diagnostic{Diagnostic::Severity::error, "E90", std::move(message),
                                   std::move(hint), Where{{}, 0, 0, 0, "plug-in '" + name + "'"}});
}

/// The file this code is in: the program, or the Python module.
fs::path own_file() {
  std::error_code ec;
  Dl_info info{};
  static const char here = 0;
  if (dladdr(&here, &info) != 0 && info.dli_fname) {
    const fs::path library = fs::canonical(info.dli_fname, ec);
    if (!ec && library.extension() == ".so") return library;
  }
  return fs::read_symlink("/proc/self/exe", ec);
}

/// Its own installation and nothing else: PREFIX/lib/whirl beside PREFIX/bin (of the module beside
/// PREFIX/lib/python3/dist-packages), or `plugins` of the build tree it was built in.
std::vector<fs::path> search_path() {
  const fs::path own = own_file();
  if (own.empty()) return {};
  const fs::path prefix = own.parent_path().parent_path();
  std::vector<fs::path> dirs{prefix / "lib" / "whirl"};
  if (own.extension() == ".so") dirs.push_back(prefix.parent_path() / "whirl");
  std::error_code ec;
  if (fs::is_regular_file(prefix / "CMakeCache.txt", ec)) dirs.push_back(prefix / "plugins");
  return dirs;
}

/// Whether the file says that it fits this program. Read, not opened as a library: opening one runs
/// its code.
bool fits(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string marker =
      fmt::format("{}{}{}", WHIRL_PLUGIN_MARKER_BEGIN, WHIRL_PLUGIN_ABI, WHIRL_PLUGIN_MARKER_END);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return text.find(marker) != std::string::npos;
}

fs::path find(const std::string& name) {
  std::error_code ec;
  for (const auto& dir : search_path())
    if (auto p = dir / ("libwhirl_" + name + ".so"); fs::is_regular_file(p, ec)) return p;
  return {};
}

/// @throws Error E90.
fs::path find_fitting(const std::string& name) {
  fs::path path = find(name);
  if (path.empty())
    fail(name, fmt::format("the component '{}' is not installed (no libwhirl_{}.so)", name, name),
         "install the package that holds it, or build Whirl with it");
  if (!fits(path))
    fail(name, fmt::format("{} is not from this build of Whirl", path.string()),
         "rebuild it with the program");
  return path;
}

std::mutex mutex;
std::map<std::string, Plugin>& registry() {
  static std::map<std::string, Plugin> r;
  return r;
}

}  // namespace

bool Plugin::available(const std::string& name) { return !find(name).empty(); }

void Plugin::require(const std::string& name) { find_fitting(name); }

bool Plugin::loaded(const std::string& name) {
  const std::lock_guard lock(mutex);
  return registry().count(name) != 0;
}

const Plugin& Plugin::load(const std::string& name) {
  const std::lock_guard lock(mutex);
  auto& all = registry();
  if (const auto it = all.find(name); it != all.end()) return it->second;
  Plugin p;
  p.name_ = name;
  p.path_ = find_fitting(name).string();
  p.handle_ = dlopen(p.path_.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!p.handle_)
    fail(name, fmt::format("the component '{}' cannot be loaded: {}", name, dlerror()), {});
  const auto abi = reinterpret_cast<const char* (*)()>(dlsym(p.handle_, "whirl_plugin_abi"));
  if (!abi || std::strcmp(abi(), WHIRL_PLUGIN_ABI) != 0)
    fail(name, fmt::format("{} is not from this build of Whirl", p.path_),
         "rebuild it with the program");
  return all.emplace(name, std::move(p)).first->second;
}

void* Plugin::address(const char* symbol) const {
  void* a = dlsym(handle_, symbol);
  if (!a)
    fail(name_, fmt::format("{} has no entry point '{}'", path_, symbol),
         "rebuild it with the program");
  return a;
}

}  // namespace whirl
