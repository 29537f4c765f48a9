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

#include <cstdio>
#include <optional>

namespace whirl::steps {

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
  const auto root = run::prepare_results(model, options);
  run::Job job(model, options, root);
  run_steps(job);
  if (options.json)
    std::fputs(io::to_json(job.summary).c_str(), stdout);
  else if (!options.quiet)
    std::fputs(fmt::format("results: {}\n", root.string()).c_str(), stdout);
  if (run::interrupted()) return static_cast<int>(Exit::interrupted);
  return static_cast<int>(job.uncertified.empty() ? Exit::ok : Exit::no_convergence);
}

}  // namespace whirl::steps
