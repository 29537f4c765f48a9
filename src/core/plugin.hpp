// Components that are loaded only when a deck asks for them (VTK frames, HDF5 series, SUNDIALS):
// shared modules libwhirl_<name>.so, opened with dlopen. A run that asks for none loads none.
#pragma once
#include <string>

// The plug-ins pass C++ objects, so they must come from the same compiler and the same headers.
#define WHIRL_PLUGIN_ABI "whirl plug-in 1, " __VERSION__
/// Once in every plug-in: proves that it fits. Other entry points are extern "C" with the same
/// visibility.
#define WHIRL_PLUGIN_EXPORT extern "C" __attribute__((visibility("default")))
#define WHIRL_DEFINE_PLUGIN                                                                  \
  WHIRL_PLUGIN_EXPORT const char* whirl_plugin_abi() { return WHIRL_PLUGIN_ABI; }            \
  extern "C" __attribute__((visibility("default"), used)) const char whirl_plugin_marker[] = \
      WHIRL_PLUGIN_MARKER_BEGIN WHIRL_PLUGIN_ABI WHIRL_PLUGIN_MARKER_END;
/// What the program looks for in the file before any of its code runs.
#define WHIRL_PLUGIN_MARKER_BEGIN "<whirl plug-in fits: "
#define WHIRL_PLUGIN_MARKER_END ">"

namespace whirl {

class Plugin {
 public:
  /// Opens libwhirl_<name>.so on first use and keeps it until the program ends. Looked for in
  /// ../lib/whirl of the program's own folder, or in ../plugins when the program stands in its
  /// build tree.
  /// @throws Error (Exit::io) when it is not there or cannot be opened, and, before anything of it
  /// runs, when it was built by another compiler.
  static const Plugin& load(const std::string& name);
  /// @throws Error (Exit::io), as load(): the file is not there or does not fit. Opens nothing.
  static void require(const std::string& name);
  /// Whether the file is there; opens nothing.
  static bool available(const std::string& name);
  /// Whether load(name) has been called with success.
  static bool loaded(const std::string& name);

  /// Entry point of the plug-in.
  /// @throws Error (Exit::io) when it has none of that name.
  template <class F>
  F* function(const char* symbol) const {
    return reinterpret_cast<F*>(address(symbol));
  }
  const std::string& path() const { return path_; }

 private:
  void* address(const char* symbol) const;
  std::string name_, path_;
  void* handle_ = nullptr;
};

}  // namespace whirl
