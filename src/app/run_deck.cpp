#include <app/checkpoint.hpp>
#include <app/interrupt.hpp>
#include <app/job.hpp>
#include <app/results_folder.hpp>
#include <app/run.hpp>
#include <app/run_lock.hpp>
#include <app/steps.hpp>
#include <app/run_deck.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace whirl::app {

int run_deck(const model::Model& model, const RunOptions& options) {
  install_interrupt_handlers();
  const std::filesystem::path folder = options.output.empty() ? std::filesystem::path(model.output.directory) : options.output;
  const RunLock lock(folder);
  if (options.resume) {
    check_checkpoints(folder, model);   // before anything in the folder changes
    if (!options.quiet && !has_checkpoint(folder, model)) std::fputs(fmt::format("no checkpoint in {}: starting from the beginning\n", folder.string()).c_str(), stderr);
  }
  const auto root = prepare_results(model, options);
  Job job(model, options, root);
  run_steps(job);
  if (options.json) std::fputs(io::to_json(job.summary).c_str(), stdout);
  else if (!options.quiet) std::fputs(fmt::format("results: {}\n", root.string()).c_str(), stdout);
  if (interrupted()) return static_cast<int>(Exit::interrupted);
  return static_cast<int>(job.uncertified.empty() ? Exit::ok : Exit::no_convergence);
}

}  // namespace whirl::app
