#include <run/checkpoint.hpp>
#include <run/interrupt.hpp>
#include <run/job.hpp>
#include <run/memory_limit.hpp>
#include <run/results_folder.hpp>
#include <run/options.hpp>
#include <run/run_lock.hpp>
#include <steps/steps.hpp>
#include <steps/run_deck.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace whirl::steps {

namespace {

/// A run that goes on from one whose results stand in the folder adds to them.
bool goes_on_in(const std::filesystem::path& folder, const model::Model& model) {
  return std::any_of(model.steps.begin(), model.steps.end(), [&](const model::Step& s) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    return t && !t->previous.empty() && run::is_results_folder(t->previous, folder);
  });
}

}  // namespace

int run_deck(const model::Model& model, const run::RunOptions& options) {
  run::install_interrupt_handlers();
  run::check_memory(model, options);
  const std::filesystem::path folder =
      options.output.empty() ? std::filesystem::path(model.output.directory) : options.output;
  std::optional<run::RunLock> lock;
  if (options.only_files.empty()) lock.emplace(folder);
  if (options.resume) {
    run::check_checkpoints(folder, model);  // before anything in the folder changes
    if (!options.quiet && !run::has_checkpoint(folder, model))
      std::fputs(fmt::format("no checkpoint in {}: starting from the beginning\n", folder.string())
                     .c_str(),
                 stderr);
  }
  std::vector<std::string> earlier;
  const bool alone = options.only_files.empty() && !options.resume;
  if (alone && !goes_on_in(folder, model)) earlier = run::steps_of_earlier_run(folder);
  const auto root = run::prepare_results(model, options);
  run::Job job(model, options, root);
  run::remove_results_of(job.folder, earlier);
  run_steps(job);
  if (options.json)
    std::fputs(io::to_json(job.summary).c_str(), stdout);
  else if (!options.quiet)
    std::fputs(fmt::format("results: {}\n", root.string()).c_str(), stdout);
  if (run::interrupted()) return static_cast<int>(Exit::interrupted);
  return static_cast<int>(job.uncertified.empty() ? Exit::ok : Exit::no_convergence);
}

}  // namespace whirl::steps
