#include <sweep/limits.hpp>
#include <core/error.hpp>
#include <core/parallel.hpp>
#include <deck/deck.hpp>
#include <run/memory_limit.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace whirl::sweep {
namespace {

constexpr double kB = 1e3;

/// Of all runs. Measured with one to four keys and responses at 1e5 runs: within a tenth of the
/// memory, a fifth of the disk.
struct Table {
  double memory = 0, disk = 0;  ///< bytes
};

Table table_of(const Plan& plan) {
  const auto runs = static_cast<double>(plan.design.runs());
  const auto keys = static_cast<double>(plan.design.factors().size());
  const auto responses = static_cast<double>(plan.responses.size());
  Table t;
  t.memory = runs * (0.6 + 0.2 * keys + 0.7 * responses) * kB;
  t.disk = runs * (40 + 20 * keys + 42 * responses);
  return t;
}

[[noreturn]] void refuse(const char* code, std::string message, std::string hint,
                         const model::Model& model) {
  Diagnostic d;
  d.code = code;
  d.message = std::move(message);
  d.hint = std::move(hint);
  d.where.file = model.deck_path;
  throw Error(Exit::deck, std::move(d));
}

void check_memory(const SweepOptions& options, const Plan& plan, const model::Model& model) {
  const double limit = run::memory_limit(options.run);
  const int processes = processes_of(options, plan);
  const double of_runs = processes * deck::estimate_memory(model, 1).total;
  const double of_table = table_of(plan).memory;
  if (of_runs + of_table <= limit) return;
  const bool mostly_table = of_table > of_runs;
  refuse("E44",
         fmt::format("the sweep would take about {} of memory ({}), but {}",
                     deck::size_text(of_runs + of_table),
                     mostly_table
                         ? fmt::format("the table of {} runs: {}", plan.design.runs(),
                                       deck::size_text(of_table))
                         : fmt::format("{} processes: {}", processes, deck::size_text(of_runs)),
                     options.run.max_memory > 0
                         ? fmt::format("the limit is {} (--max-memory)", deck::size_text(limit))
                         : fmt::format("only {} are available", deck::size_text(limit))),
         mostly_table ? "fewer --samples or values of --vary"
                      : "fewer processes: --jobs; --max-memory sets another limit, or none",
         model);
}

void check_disk(const SweepOptions& options, const Plan& plan, const model::Model& model) {
  constexpr double of_a_folder = 100 * kB;  // kept: summary, tables, report
  const double kept = options.keep ? static_cast<double>(plan.design.runs()) *
                                         (of_a_folder + deck::estimate_output(model).histories)
                                   : 0.0;
  const double need = table_of(plan).disk + kept;
  std::filesystem::path folder = std::filesystem::absolute(plan.root);
  std::error_code ec;
  while (!std::filesystem::exists(folder, ec) && folder.has_relative_path())
    folder = folder.parent_path();
  const auto space = std::filesystem::space(folder, ec);
  if (ec) return;
  const double available = static_cast<double>(space.available);
  const bool limited = options.run.max_disk > 0 && options.run.max_disk < available;
  const double limit = limited ? options.run.max_disk : available;
  if (need <= limit) return;
  refuse("E33",
         fmt::format(
             "the sweep would write about {} ({} runs{}), but {}", deck::size_text(need),
             plan.design.runs(),
             options.keep ? fmt::format(", of which --keep keeps {}", deck::size_text(kept)) : "",
             limited ? fmt::format("the limit is {} (--max-disk)", deck::size_text(limit))
                     : fmt::format("only {} are free", deck::size_text(limit))),
         options.keep ? "leave out --keep, or write fewer histories" : "fewer runs", model);
}

}  // namespace

int processes_of(const SweepOptions& options, const Plan& plan) {
  const int asked = options.run.jobs > 0 ? options.run.jobs : processors();
  const std::int64_t runs = std::max<std::int64_t>(1, plan.design.runs() / plan.shard.count);
  return static_cast<int>(std::min<std::int64_t>(asked, runs));
}

double memory_of_a_process(const SweepOptions& options, const Plan& plan) {
  return run::memory_limit(options.run) / processes_of(options, plan);
}

void check_limits(const SweepOptions& options, const Plan& plan, const model::Model& model) {
  check_memory(options, plan, model);
  check_disk(options, plan, model);
}

}  // namespace whirl::sweep
