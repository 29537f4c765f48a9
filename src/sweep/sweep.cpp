#include <sweep/sweep.hpp>
#include <sweep/limits.hpp>
#include <sweep/outcome.hpp>
#include <sweep/plan.hpp>
#include <sweep/ranks.hpp>
#include <sweep/workers.hpp>
#include <core/error.hpp>
#include <deck/parsed_deck.hpp>
#include <core/interrupt.hpp>
#include <core/parallel.hpp>
#include <core/stopwatch.hpp>
#include <io/file.hpp>
#include <run/interrupt.hpp>
#include <run/progress.hpp>
#include <run/run_lock.hpp>
#include <steps/run_deck.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <exception>
#include <optional>
#include <utility>

namespace whirl::sweep {
namespace {

namespace fs = std::filesystem;

/// What a sweep reads nothing from is not written.
const char* const tables_alone[] = {"output.report=false", "output.vtk=[]"};

/// The folder stays: making it anew costs more than what stands in it.
void empty(const fs::path& folder) {
  std::error_code ec, ignored;
  std::vector<fs::path> found;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
    found.push_back(it->path());
  for (const fs::path& file : found)
    fs::remove_all(file, ignored);
}

/// Steps that ask for the deck with other values of some keys (maps, reports) get it, beside what is set.
/// deck and o live as long as one another.
void read_again_in(run::RunOptions& o, const deck::ParsedDeck& deck,
                   const std::vector<std::string>& set) {
  o.variant = [&deck, set](const std::string& setting) {
    std::vector<std::string> one = set;
    one.push_back(setting);
    return deck.load(one);
  };
  o.build = [&deck, set](const std::vector<std::string>& settings) {
    std::vector<std::string> one = set;
    one.insert(one.end(), settings.begin(), settings.end());
    return deck.load(one);
  };
}

class Runner {
 public:
  /// rank: of this process among those of the sweep.
  Runner(const SweepOptions& options, const Plan& plan, int rank = 0)
      : options_(options),
        plan_(plan),
        rank_(rank),
        memory_(memory_of_a_process(options, plan)),
        deck_(options.deck, options.read.files_allowed) {}

  /// In the process of a worker. Never throws.
  std::string operator()(std::int64_t run, int worker) const {
    Row row;
    row.run = run;
    const Stopwatch watch;
    const fs::path results = folder_of(run, worker);
    io::set_waiting_for_disk(options_.keep);
    try {
      if (fs::is_symlink(results))
        io::io_failure(results, "nothing is written through a symbolic link:");
      // tables of the run before must not be taken for this one's; of a run's own folder the run knows
      if (!options_.keep) empty(results);
      NanMeanings meanings;
      row.exit = steps_of(run, results, options_.keep, &meanings);
      for (const Response& r : plan_.responses)
        row.answers.push_back(answer(r, results, meanings));
    } catch (const Error& e) {
      row.exit = static_cast<int>(e.exit());
      if (!e.diagnostics().empty()) {
        row.code = e.diagnostics().front().code;
        row.message = e.diagnostics().front().message;
      }
    } catch (const std::exception& e) {
      row.exit = static_cast<int>(Exit::internal);
      row.message = e.what();
    }
    const std::string why = row.code.empty() ? fmt::format("exit {}", row.exit) : row.code;
    while (row.answers.size() < plan_.responses.size())
      row.answers.push_back({nan, "", why});
    row.cpu = watch.elapsed().cpu;
    return line_of(row);
  }

 private:
  fs::path folder_of(std::int64_t run, int worker) const {
    const fs::path shard = plan_.root / plan_.shard.folder();
    return options_.keep ? plan_.root / "runs" / fmt::format("{:06}", run)
                         : shard / fmt::format("worker_{}_{}", rank_, worker);
  }

 public:
  /// whole: with the report and the pictures of the deck. meanings: of nan in its tables, added to;
  /// null: not asked for. @throws as steps::run_deck
  int steps_of(std::int64_t run, const fs::path& results, bool whole,
               NanMeanings* meanings = nullptr) const {
    std::vector<std::string> set = options_.read.set;
    if (!whole) set.insert(set.end(), std::begin(tables_alone), std::end(tables_alone));
    const std::vector<std::string> values = plan_.design.values(run);
    for (std::size_t k = 0; k < values.size(); ++k)
      set.push_back(plan_.design.factors()[k].path + "=" + values[k]);
    run::RunOptions o;
    o.quiet = true;
    o.jobs = 1;
    o.max_memory = memory_;
    o.output = results;
    if (!whole)
      for (const Response& r : plan_.responses)
        o.only_files.push_back(file_of(r));
    if (meanings)
      o.seen_table = [meanings](std::string_view name, const io::Table& table) {
        (*meanings)[std::string(name)] = {table.nan_means, table.nan_is_absence};
      };
    read_again_in(o, deck_, set);
    return steps::run_deck(deck_.load(set), o);
  }

 private:
  const SweepOptions& options_;
  const Plan& plan_;
  int rank_;
  double memory_;          ///< bytes that a run may take
  deck::ParsedDeck deck_;  ///< read once, before there are workers
};

Row row_without_answer(std::int64_t run, Ended ended, int signal, double limit, std::size_t n) {
  Row row;
  row.run = run;
  row.exit = -1;
  row.message = ended == Ended::out_of_time
                    ? fmt::format("not done in {:g} s", limit)
                    : fmt::format("its process was ended by signal {}", signal);
  for (std::size_t k = 0; k < n; ++k)
    row.answers.push_back({nan, "", row.message});
  return row;
}

/// Appends rows as they come; on the disk at least every second.
class RowFile {
 public:
  RowFile(const fs::path& file, std::uint64_t bytes) : out_(1 << 16) {
    if (bytes > 0)
      out_.reopen(file, bytes);
    else
      out_.create(file, "");
  }
  void append(const std::string& line) {
    constexpr std::size_t buffered = 1 << 15;
    for (std::size_t k = 0; k < line.size(); k += buffered) {
      const std::size_t n = std::min(buffered, line.size() - k);
      line.copy(out_.reserve(n), n, k);
      out_.commit(n);
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - synced_ < std::chrono::seconds(1)) return;
    out_.sync();
    synced_ = now;
  }
  void close() {
    out_.sync();
    out_.close();
  }

 private:
  io::AppendFile out_;
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
};

struct Done {
  std::int64_t runs = 0, failed = 0;
  double cpu = 0;
};

/// Keeps the rows as they come, and tells how far it is.
class Collector {
 public:
  Collector(const fs::path& file, std::uint64_t bytes, std::size_t tasks, bool quiet)
      : out_(file, bytes),
        tasks_(tasks),
        progress_("sweep", quiet) {}
  void take(const Row& row) {
    if (row.exit == static_cast<int>(Exit::interrupted)) return;  // to be done again
    out_.append(line_of(row));
    ++done_.runs;
    done_.failed += row.exit != 0;
    done_.cpu += row.cpu;
    progress_.update(static_cast<double>(done_.runs) / static_cast<double>(tasks_), text());
  }
  Done close() {
    out_.close();
    progress_.done(text());
    return done_;
  }

 private:
  std::string text() const {
    return fmt::format("{} of {} runs, {} failed", done_.runs, tasks_, done_.failed);
  }
  RowFile out_;
  std::size_t tasks_;
  run::ProgressLine progress_;
  Done done_;
};

/// Does the runs in processes of this one.
void run_here(const SweepOptions& options, const Plan& plan, int processes, int rank,
              std::span<const std::int64_t> tasks, const std::function<void(const Row&)>& take) {
  WorkerOptions w;
  w.processes =
      static_cast<int>(std::min<std::int64_t>(processes, static_cast<std::int64_t>(tasks.size())));
  w.limit = options.limit;
  const Runner run(options, plan, rank);
  run_in_workers(tasks, w, run,
                 [&](std::int64_t task, Ended ended, const std::string& text, int signal) {
                   std::optional<Row> row = ended == Ended::answered ? row_of(text) : std::nullopt;
                   if (!row)
                     row = row_without_answer(task, ended, signal, w.limit, plan.responses.size());
                   take(*row);
                 });
}

void collect_from(Ranks& ranks, std::span<const std::int64_t> tasks, Collector& rows) {
  ranks.hand_out(tasks, [&](const std::string& lines) {
    for (std::size_t from = 0; from < lines.size();) {
      const std::size_t end = lines.find('\n', from);
      const std::string_view line(lines.data() + from, end - from);
      if (const std::optional<Row> row = row_of(line)) rows.take(*row);
      from = end + 1;
    }
  });
}

/// A rank other than 0.
void serve(Ranks& ranks, const SweepOptions& options, const Plan& plan) {
  const int processes = std::max(1, options.run.jobs);
  ranks.work([&](std::span<const std::int64_t> runs) {
    std::string lines;
    run_here(options, plan, processes, ranks.rank(), runs, [&](const Row& row) {
      lines += line_of(row);
      if (lines.back() != '\n') lines += '\n';
    });
    return lines;
  });
}

/// ranks: null where this process does all by itself.
Done run_tasks(const SweepOptions& options, const Plan& plan, Ranks* ranks) {
  const fs::path file = plan.root / plan.shard.folder() / "rows.tsv";
  const RowsRead before = read_rows(file);
  std::vector<std::int64_t> tasks;
  for (std::int64_t run = plan.shard.index; run < plan.design.runs(); run += plan.shard.count)
    if (!before.rows.count(run)) tasks.push_back(run);
  if (tasks.empty() && !ranks) return {};
  Collector rows(file, before.bytes, tasks.size(), options.run.quiet);
  if (ranks)
    collect_from(*ranks, tasks, rows);
  else
    run_here(options, plan, options.run.jobs > 0 ? options.run.jobs : processors(), 0, tasks,
             [&](const Row& row) { rows.take(row); });
  return rows.close();
}

/// Makes the worst runs again with everything they can show. What fails now failed before.
void run_worst(const SweepOptions& options, const Plan& plan,
               const std::map<std::int64_t, Row>& rows) {
  const std::vector<std::int64_t> runs = worst_runs(plan, rows);
  if (runs.empty()) return;
  remove_worst_runs(plan);
  const Runner runner(options, plan);
  WorkerOptions w;
  w.processes = static_cast<int>(
      std::min<std::size_t>(runs.size(), static_cast<std::size_t>(std::max(1, options.run.jobs))));
  const auto run = [&](std::int64_t number, int) -> std::string {
    try {
      runner.steps_of(number, plan.root / worst_folder(number), true);
    } catch (const std::exception&) {
      return "failed";
    }
    return "done";
  };
  run_in_workers(runs, w, run, [](std::int64_t, Ended, const std::string&, int) {});
}

/// "4 runs: E77, a critical speed ..", the most frequent first.
std::string failures_text(const std::map<std::int64_t, Row>& rows) {
  std::map<std::string, std::pair<std::int64_t, std::string>> kinds;
  for (const auto& [run, row] : rows) {
    if (row.exit == 0) continue;
    const std::string kind = row.code.empty() ? fmt::format("exit {}", row.exit) : row.code;
    auto& [count, first] = kinds[kind];
    if (count++ == 0)
      first =
          fmt::format("{} (run {}{})", kind, run, row.message.empty() ? "" : ": " + row.message);
  }
  std::vector<std::pair<std::int64_t, std::string>> list;
  list.reserve(kinds.size());
  for (auto& [kind, k] : kinds)
    list.push_back(std::move(k));
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [count, first] : list)
    text += fmt::format("{} of {} runs failed: {}\n", count, rows.size(), first);
  return text;
}

int list_tables(const SweepOptions& options) {
  const model::Model model = deck::load_model(options.deck, options.read);
  const fs::path root =
      options.run.output.empty() ? fs::path(model.output.directory + "_sweep") : options.run.output;
  deck::ReadOptions read = options.read;
  read.set.insert(read.set.end(), std::begin(tables_alone), std::end(tables_alone));
  run::RunOptions o;
  o.quiet = true;
  o.output = root / "as_it_is";
  const deck::ParsedDeck deck(options.deck, options.read.files_allowed);
  read_again_in(o, deck, read.set);
  const int code = steps::run_deck(deck.load(read.set), o);
  for (const std::string& name : list_responses(o.output))
    std::printf("%s\n", name.c_str());
  return code;
}

/// Some run gave a value for each of them.
bool every_response_answered(const std::map<std::int64_t, Row>& rows) {
  std::vector<bool> answered(rows.begin()->second.answers.size(), false);
  for (const auto& [run, row] : rows)
    for (std::size_t k = 0; k < answered.size(); ++k)
      if (row.answers[k].failure.empty()) answered[k] = true;
  return std::find(answered.begin(), answered.end(), false) == answered.end();
}

/// A parameter that is varied is one of the deck.
/// @throws Error (E99)
void require_used(const Plan& plan, const std::vector<Diagnostic>& warnings) {
  for (const Factor& f : plan.design.factors()) {
    constexpr std::string_view head = "parameters.";
    if (!f.path.starts_with(head)) continue;
    const std::string name = f.path.substr(head.size());
    const auto is_unused = [&name](const Diagnostic& d) {
      return d.code == "W01" && d.message.find("'" + name + "'") != std::string::npos;
    };
    if (std::none_of(warnings.begin(), warnings.end(), is_unused)) continue;
    throw Error(
        Exit::usage,
        Diagnostic{Diagnostic::Severity::error, "E99",
                   fmt::format("--vary '{}': no key of the deck has this parameter", f.path),
                   fmt::format("write \"${{{}}}\" in the deck where its values belong, or the "
                               "name of the parameter that is meant",
                               name),
                   Where{}});
  }
}

/// No key is varied under two names.
/// @throws Error (E99)
void require_different(const SweepOptions& options, const Plan& plan) {
  const deck::ParsedDeck deck(options.deck, options.read.files_allowed);
  std::map<std::string, std::string> names;
  for (const Factor& f : plan.design.factors()) {
    const auto [other, is_new] = names.emplace(deck.entry(f.path), f.path);
    if (!is_new)
      throw Error(Exit::usage,
                  Diagnostic{Diagnostic::Severity::error, "E99",
                             fmt::format("'{}' and '{}' are one key", other->second, f.path),
                             "one --vary a key", Where{}});
  }
}

/// The keys that are varied are there. What is wrong with their values is for the rows to say.
void require_keys(const SweepOptions& options, const Plan& plan) {
  deck::ReadOptions read = options.read;
  const std::vector<std::string> values = plan.design.values(0);
  for (std::size_t k = 0; k < values.size(); ++k)
    read.set.push_back(plan.design.factors()[k].path + "=" + values[k]);
  try {
    require_used(plan, deck::load_model(options.deck, read).warnings);
  } catch (const Error& e) {
    const auto& problems = e.diagnostics();
    const bool unknown = std::any_of(problems.begin(), problems.end(),
                                     [](const Diagnostic& d) { return d.code == "E04"; });
    if (e.exit() == Exit::usage || unknown) throw;
  }
}

}  // namespace

namespace {

/// What the command line leaves open is the deck's.
SweepOptions completed(SweepOptions o, const model::Model& model) {
  const model::SweepPlan s = model.sweep.value_or(model::SweepPlan());
  if (o.vary.empty())
    for (const std::string& vary : s.vary)
      o.vary.push_back(
          vary.starts_with('@') ? "@" + (o.deck.parent_path() / vary.substr(1)).string() : vary);
  const auto take = [](std::vector<std::string>& mine, const std::vector<std::string>& decks) {
    if (mine.empty()) mine = decks;
  };
  take(o.responses, s.response);
  take(o.correlations, s.correlation);
  take(o.exceed, s.exceed);
  take(o.worst, s.worst);
  if (!o.samples) o.samples = s.samples;
  if (!o.seed) o.seed = static_cast<std::uint64_t>(s.seed);
  if (o.sampling.empty()) o.sampling = s.sampling;
  if (o.limit == 0) o.limit = s.limit;
  return o;
}

}  // namespace

namespace {

/// Everything but the runs themselves, by the one process that keeps the rows.
int lead(const SweepOptions& options, const Plan& plan, const model::Model& model,
         std::unique_ptr<Ranks> ranks) {
  std::unique_ptr<run::RunLock> lock;
  try {
    check_limits(options, plan, model);
    require_keys(options, plan);
    require_different(options, plan);
    lock = prepare_folder(plan, options.run.resume);
  } catch (...) {
    if (ranks) ranks->agree(false);
    throw;
  }
  if (ranks) ranks->agree(true);
  const Stopwatch watch;
  const Done done = run_tasks(options, plan, ranks.get());
  ranks.reset();
  const auto rows = all_rows(plan);
  const auto missing = plan.design.runs() - static_cast<std::int64_t>(rows.size());
  if (missing == 0 && !run::interrupted()) run_worst(options, plan, rows);
  if (missing == 0) write_outcome(plan, rows, options);
  if (!options.run.quiet && !options.run.json)
    std::fputs(
        fmt::format("{}{} runs in {:.1f} s of wall time, {:.1f} s of CPU time in them\n{}",
                    failures_text(rows), done.runs, watch.elapsed().wall, done.cpu,
                    missing == 0 ? fmt::format("results: {}\n", plan.root.string())
                                 : fmt::format("{} of {} runs are still to be done: the other "
                                               "shards, or --resume\n",
                                               missing, plan.design.runs()))
            .c_str(),
        stdout);
  if (run::interrupted()) return static_cast<int>(Exit::interrupted);
  return static_cast<int>(missing == 0 && !every_response_answered(rows) ? Exit::no_convergence
                                                                         : Exit::ok);
}

}  // namespace

int run_sweep(const SweepOptions& given) {
  if (given.deck == "-")
    throw Error(Exit::usage, Diagnostic{Diagnostic::Severity::error, "E99",
                                        "a deck on standard input can be read once only",
                                        "write it to a file", Where{}});
  run::install_interrupt_handlers();
  if (given.list) return list_tables(given);
  std::unique_ptr<Ranks> ranks = given.shard.empty() ? join_ranks() : nullptr;
  const bool leads = !ranks || ranks->rank() == 0;
  std::optional<model::Model> model;
  std::optional<SweepOptions> options;
  std::optional<Plan> plan;
  try {
    model.emplace(deck::load_model(given.deck, given.read));
    options.emplace(completed(given, *model));
    plan.emplace(make_plan(*options, *model));
  } catch (const Error&) {
    // The same on every rank, and told once.
    if (leads) throw;
    return static_cast<int>(Exit::deck);
  }
  if (leads) return lead(*options, *plan, *model, std::move(ranks));
  if (ranks->agree(true)) serve(*ranks, *options, *plan);
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::sweep
