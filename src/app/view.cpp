// `whirl view`: a state script for ParaView beside the frames of a results folder.
#include <app/commands.hpp>
#include <app/view_state.hpp>
#include <deck/text/document.hpp>
#include <fmt/format.h>
#include <io/file.hpp>
#include <io/value.hpp>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>

namespace whirl::app {
namespace {

namespace fs = std::filesystem;

/// What a run wrote of one step or shape.
struct FrameSets {
  std::vector<std::string> kinds;  ///< in the order they are arranged
  std::size_t frames = 0;
  bool one_file = false;  ///< all of them in one, uncounted
};

Error refusal(const fs::path& results, const std::string& message, const std::string& hint) {
  Diagnostic d;
  d.code = "E43";
  d.message = fmt::format("'{}': {}", results.string(), message);
  d.hint = hint;
  return Error(Exit::usage, std::move(d));
}

std::size_t count(std::string_view text, std::string_view what) {
  std::size_t n = 0;
  for (std::size_t k = text.find(what); k != std::string_view::npos; k = text.find(what, k + 1))
    ++n;
  return n;
}

/// By name of the step or shape.
std::map<std::string, FrameSets> find_sets(const fs::path& vtk) {
  std::map<std::string, FrameSets> out;
  for (const char* kind : {"surface", "line", "bearings", "orbits"}) {
    std::error_code ec;
    for (const fs::directory_entry& f : fs::directory_iterator(vtk, ec)) {
      const std::string stem = f.path().stem().string(), end = std::string("_") + kind;
      const bool one_file = f.path().extension() == ".vtkhdf";
      if ((f.path().extension() != ".pvd" && !one_file) || !stem.ends_with(end)) continue;
      // how many stand in one file ParaView finds out
      const std::size_t frames = one_file ? 1 : count(io::read_text(f.path()), "<DataSet");
      if (frames == 0) continue;
      FrameSets& set = out[stem.substr(0, stem.size() - end.size())];
      set.kinds.push_back(kind);
      set.frames = std::max(set.frames, frames);
      set.one_file = one_file;
    }
  }
  return out;
}

/// As Python writes it, which reads strings of JSON.
std::string quoted(const std::string& text) { return io::to_json(io::Value(text)); }

void replace_all(std::string& text, const std::string& what, const std::string& with) {
  for (std::size_t k = text.find(what); k != std::string::npos;
       k = text.find(what, k + with.size()))
    text.replace(k, what.size(), with);
}

std::string chosen_set(const ViewOptions& o, const std::map<std::string, FrameSets>& sets) {
  if (o.set.empty())
    return std::max_element(
               sets.begin(), sets.end(),
               [](const auto& a, const auto& b) { return a.second.frames < b.second.frames; })
        ->first;
  if (sets.contains(o.set)) return o.set;
  std::vector<std::string> names;
  names.reserve(sets.size());
  for (const auto& [name, set] : sets)
    names.push_back(name);
  const std::vector<std::string> near = deck::nearest(o.set, names);
  throw refusal(o.results, fmt::format("there are no frames of '{}'", o.set),
                near.empty() ? fmt::format("there are frames of {}", fmt::join(names, ", "))
                             : fmt::format("did you mean '{}'?", near.front()));
}

}  // namespace

int view_results(const ViewOptions& o) {
  const fs::path vtk = o.results / "vtk";
  const std::map<std::string, FrameSets> sets = find_sets(vtk);
  if (sets.empty())
    throw refusal(o.results, "no frames are there to look at",
                  "a deck writes them with [[output.vtk]]; the argument is the results folder of a "
                  "run");
  const std::string shown = chosen_set(o, sets);
  const fs::path script = o.script.empty() ? o.results / "view.py" : o.script;
  std::string names, kinds;
  for (const auto& [name, set] : sets)
    names += (names.empty() ? "" : ", ") + name;
  for (const std::string& kind : sets.at(shown).kinds)
    kinds += (kinds.empty() ? "" : ", ") + quoted(kind);

  std::string text = view_state();
  replace_all(text, "@script@", script.filename().string());
  replace_all(text, "@sets@", names);
  replace_all(text, "\"@shown@\"", quoted(shown));
  replace_all(text, "@kinds@", "[" + kinds + "]");
  replace_all(text, "@folder@", quoted(fs::absolute(vtk).lexically_normal().string()));
  io::write_atomic(script, text);
  const FrameSets& set = sets.at(shown);
  const std::string frames = set.one_file ? "one file a set" : fmt::format("{} frames", set.frames);
  std::fputs(
      fmt::format("{}: {} ({}; {})\n", script.string(), shown, frames, fmt::join(set.kinds, ", "))
          .c_str(),
      stdout);
  if (sets.size() > 1) std::fputs(fmt::format("frames there are: {}\n", names).c_str(), stdout);
  if (!o.open) {
    std::fputs(fmt::format("open it: paraview --script='{}'\n", script.string()).c_str(), stdout);
    return static_cast<int>(Exit::ok);
  }
  std::fflush(stdout);
  const std::string argument = "--script=" + script.string();
  ::execlp("paraview", "paraview", argument.c_str(), nullptr);
  throw refusal(o.results, "ParaView cannot be started: no program 'paraview' is found",
                "install it (Debian: apt-get install paraview), or open the script with "
                "paraview --script");
}

}  // namespace whirl::app
