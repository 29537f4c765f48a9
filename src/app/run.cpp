#include <app/results_folder.hpp>
#include <app/run.hpp>
#include <cstdio>
#include <fmt/format.h>

namespace whirl::app {

int run_deck(const model::Model& model, const RunOptions& options) {
  const auto folder = prepare_results(model, options);
  if (!options.quiet) std::fputs(fmt::format("results: {}\n", folder.string()).c_str(), stdout);
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::app
