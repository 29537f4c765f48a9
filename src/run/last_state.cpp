// The last state of another run, as a start.
#include <run/checkpoint.hpp>

#include <core/error.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

namespace whirl::run {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(Exit exit, const char* code, std::string message, std::string hint,
                         Where where = {}) {
  throw Error(exit, Diagnostic{Diagnostic::Severity::error, code, std::move(message),
                               std::move(hint), std::move(where)});
}

/// Checkpoints in a results folder, by name.
std::vector<fs::path> checkpoints_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ec;
  for (const auto& f : fs::directory_iterator(folder / "checkpoint", ec))
    if (f.path().extension() == ".whirl") files.push_back(f.path());
  std::sort(files.begin(), files.end());
  return files;
}

[[noreturn]] void refuse_step(const std::string& folder, const std::string& step,
                              const std::vector<fs::path>& files) {
  std::string names;
  for (const fs::path& f : files)
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", f.stem().string());
  refuse(Exit::io, "E91",
         fmt::format("the run in '{}' has no state of a step '{}': it has that of {}", folder, step,
                     names),
         "previous_step names one of its transient steps");
}

/// The file of a step, or of the only one.
fs::path state_file(const std::string& folder, const std::string& step) {
  const std::vector<fs::path> files = checkpoints_in(folder);
  if (files.empty())
    refuse(Exit::io, "E91", fmt::format("no state of an earlier run in '{}'", folder),
           "previous names a results folder whose transient step has run with checkpoints");
  if (!step.empty()) {
    const fs::path file = checkpoint_file(folder, step);
    if (std::find(files.begin(), files.end(), file) == files.end())
      refuse_step(folder, step, files);
    return file;
  }
  if (files.size() > 1)
    refuse(Exit::io, "E91", fmt::format("{} holds checkpoints of several steps", folder),
           "name one with previous_step");
  return files.front();
}

const model::TransientStep* with_checkpoints(const model::Step& s) {
  const auto* t = std::get_if<model::TransientStep>(&s.law);
  return t && t->checkpoint > 0.0 ? t : nullptr;
}

/// Whether one of the steps before this one leaves the state it goes on from.
bool left_by_this_run(const model::Model& model, const model::Step& step,
                      const std::string& previous_step) {
  for (const model::Step& s : model.steps) {
    if (&s == &step) return false;
    if (with_checkpoints(s) && (previous_step.empty() || s.name == previous_step)) return true;
  }
  return false;
}

}  // namespace

Checkpoint last_state_of(const std::string& folder, const std::string& step) {
  std::optional<Checkpoint> c = read_checkpoint(state_file(folder, step));
  if (!c) refuse(Exit::io, "E91", fmt::format("no state of an earlier run in '{}'", folder), {});
  return std::move(*c);
}

bool is_results_folder(const std::string& previous, const fs::path& results) {
  std::error_code ec;
  const auto whole = [&ec](const fs::path& p) {
    return fs::weakly_canonical(fs::absolute(p, ec), ec);
  };
  return whole(previous) == whole(results) && !ec;
}

std::vector<std::string> states_to_keep(const model::Model& model, const fs::path& results) {
  std::vector<std::string> names;
  for (const model::Step& step : model.steps) {
    const auto* law = std::get_if<model::TransientStep>(&step.law);
    if (!law || law->previous.empty()) continue;
    const bool here = is_results_folder(law->previous, results);
    if (here && left_by_this_run(model, step, law->previous_step)) continue;
    last_state_of(law->previous, law->previous_step);
    if (!here) continue;
    const fs::path file = state_file(law->previous, law->previous_step).filename();
    const std::string name = (fs::path("checkpoint") / file).string();
    for (const model::Step& s : model.steps)
      if (with_checkpoints(s) && checkpoint_name(s.name) == name)
        refuse(Exit::deck, "E26",
               fmt::format("step '{}' goes on from a state in '{}' over which step '{}' of this "
                           "run would write its own",
                           step.name, law->previous, s.name),
               "write into another folder (-o, output.directory), or give the step another name",
               step.where);
    names.push_back(name);
  }
  return names;
}

void check_state_fits(const Checkpoint& c, const std::string& folder, const system::System& system,
                      const std::string& deck) {
  if (c.state.q.size() == system.size() &&
      c.state.frames.turns.size() == static_cast<std::size_t>(system.lines()) &&
      c.state.frames.kept.size() == system.make_state().frames.kept.size())
    return;
  refuse(Exit::deck, "E94",
         fmt::format("the run in '{}' has {} unknowns, this model {}", folder, c.state.q.size(),
                     system.size()),
         "both must have the same mesh: where the program chose it, the steps of the two decks "
         "differ; write min_elements into both",
         Where{deck, 0, 0, 0, {}});
}

}  // namespace whirl::run
