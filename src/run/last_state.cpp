// The last state of another run, as a start.
#include <run/checkpoint.hpp>

#include <core/error.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

namespace whirl::run {

Checkpoint last_state_of(const std::string& folder, const std::string& step) {
  namespace fs = std::filesystem;
  fs::path file = step.empty() ? fs::path() : checkpoint_file(folder, step);
  std::error_code ec;
  if (step.empty())
    for (const auto& f : fs::directory_iterator(fs::path(folder) / "checkpoint", ec))
      if (f.path().extension() == ".whirl") {
        if (!file.empty())
          throw Error(Exit::io,
                      Diagnostic{Diagnostic::Severity::error, "E91",
                                 fmt::format("{} holds checkpoints of several steps", folder),
                                 "name one with previous_step", Where{}});
        file = f.path();
      }
  std::optional<Checkpoint> c = file.empty() ? std::nullopt : read_checkpoint(file);
  if (!c)
    throw Error(
        Exit::io,
        Diagnostic{Diagnostic::Severity::error, "E91",
                   fmt::format("no state of an earlier run in '{}'", folder),
                   "previous names a results folder whose transient step has run with checkpoints",
                   Where{}});
  return std::move(*c);
}

void check_state_fits(const Checkpoint& c, const std::string& folder, const system::System& system,
                      const std::string& deck) {
  if (c.state.q.size() == system.size() &&
      c.state.frames.turns.size() == static_cast<std::size_t>(system.lines()) &&
      c.state.frames.kept.size() == system.make_state().frames.kept.size())
    return;
  throw Error(Exit::deck, Diagnostic{Diagnostic::Severity::error, "E94",
                                     fmt::format("the run in '{}' has {} unknowns, this model {}",
                                                 folder, c.state.q.size(), system.size()),
                                     "both must have the same mesh: where the program chose it, "
                                     "the steps of the two decks differ; "
                                     "write min_elements into both",
                                     Where{deck, 0, 0, 0, {}}});
}

}  // namespace whirl::run
