#include <core/error.hpp>
#include <core/plugin.hpp>
#include <dlfcn.h>
#include <fmt/format.h>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

namespace whirl {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& name, std::string message, std::string hint) {
  throw Error(Exit::io, Diagnostic{Diagnostic::Severity::error, "E90", std::move(message), std::move(hint),
                                   Where{{}, 0, 0, 0, "plug-in '" + name + "'"}});
}

std::vector<fs::path> search_path() {
  std::vector<fs::path> dirs;
  if (const char* env = std::getenv("WHIRL_PLUGIN_PATH")) {
    std::string_view rest = env;
    while (!rest.empty()) {
      const auto colon = rest.find(':');
      if (const auto one = rest.substr(0, colon); !one.empty()) dirs.emplace_back(one);
      rest = colon == std::string_view::npos ? std::string_view{} : rest.substr(colon + 1);
    }
  }
  std::error_code ec;
  const fs::path exe = fs::read_symlink("/proc/self/exe", ec);
  if (!ec) {
    fs::path dir = exe.parent_path();
    dirs.push_back(dir);
    dirs.push_back(dir.parent_path() / "lib" / "whirl");
    for (int up = 0; up < 4; ++up, dir = dir.parent_path()) dirs.push_back(dir / "plugins");
  }
  return dirs;
}

fs::path find(const std::string& name) {
  std::error_code ec;
  for (const auto& dir : search_path())
    if (auto p = dir / ("libwhirl_" + name + ".so"); fs::is_regular_file(p, ec)) return p;
  return {};
}

std::mutex mutex;
std::map<std::string, Plugin>& registry() {
  static std::map<std::string, Plugin> r;
  return r;
}

}  // namespace

bool Plugin::available(const std::string& name) { return !find(name).empty(); }

bool Plugin::loaded(const std::string& name) {
  const std::lock_guard lock(mutex);
  return registry().count(name) != 0;
}

const Plugin& Plugin::load(const std::string& name) {
  const std::lock_guard lock(mutex);
  auto& all = registry();
  if (const auto it = all.find(name); it != all.end()) return it->second;
  const fs::path path = find(name);
  if (path.empty())
    fail(name, fmt::format("the component '{}' is not installed (no libwhirl_{}.so)", name, name),
         "build Whirl with it, or set WHIRL_PLUGIN_PATH to the folder that holds it");
  Plugin p;
  p.name_ = name;
  p.path_ = path.string();
  p.handle_ = dlopen(p.path_.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!p.handle_) fail(name, fmt::format("the component '{}' cannot be loaded: {}", name, dlerror()), {});
  const auto abi = reinterpret_cast<const char* (*)()>(dlsym(p.handle_, "whirl_plugin_abi"));
  if (!abi || std::strcmp(abi(), WHIRL_PLUGIN_ABI) != 0)
    fail(name, fmt::format("{} is not from this build of Whirl", p.path_), "rebuild it with the program");
  return all.emplace(name, std::move(p)).first->second;
}

void* Plugin::address(const char* symbol) const {
  void* a = dlsym(handle_, symbol);
  if (!a) fail(name_, fmt::format("{} has no entry point '{}'", path_, symbol), "rebuild it with the program");
  return a;
}

}  // namespace whirl
