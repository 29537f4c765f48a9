#include <sweep/sweep.hpp>
#include <sweep/outcome.hpp>
#include <sweep/plan.hpp>
#include <sweep/workers.hpp>
#include <core/error.hpp>
#include <core/interrupt.hpp>
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
#include <thread>

namespace whirl::sweep {
namespace {

namespace fs = std::filesystem;

/// What a sweep reads nothing from is not written.
const char* const tables_alone[] = {"output.report=false", "output.vtk=[]"};

class Runner {
 public:
  Runner(const SweepOptions& options, const Plan& plan) : options_(options), plan_(plan) {}

  /// In the process of a worker. Never throws.
  std::string operator()(std::int64_t run, int worker) const {
    Row row;
    row.run = run;
    const Stopwatch watch;
    const fs::path results = folder_of(run, worker);
    io::set_waiting_for_disk(options_.keep);
    try {
      std::error_code ec;
      fs::remove_all(results, ec);  // tables of the run before must not be taken for this one's
      row.exit = steps_of(run, results);
      for (const Response& r : plan_.responses)
        row.answers.push_back(answer(r, results));
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
                         : shard / fmt::format("worker_{}", worker);
  }
  int steps_of(std::int64_t run, const fs::path& results) const {
    return steps_of(run, results, options_.keep);
  }

 public:
  /// whole: with the report and the pictures of the deck. @throws as steps::run_deck
  int steps_of(std::int64_t run, const fs::path& results, bool whole) const {
    deck::ReadOptions read = options_.read;
    if (!whole) read.set.insert(read.set.end(), std::begin(tables_alone), std::end(tables_alone));
    const std::vector<std::string> values = plan_.design.values(run);
    for (std::size_t k = 0; k < values.size(); ++k)
      read.set.push_back(plan_.design.factors()[k].path + "=" + values[k]);
    run::RunOptions o;
    o.quiet = true;
    o.jobs = 1;
    o.output = results;
    o.variant = [&](const std::string& setting) {
      deck::ReadOptions one = read;
      one.set.push_back(setting);
      return deck::load_model(options_.deck, one);
    };
    o.build = [&](const std::vector<std::string>& settings) {
      deck::ReadOptions one = read;
      one.set.insert(one.set.end(), settings.begin(), settings.end());
      return deck::load_model(options_.deck, one);
    };
    return steps::run_deck(deck::load_model(options_.deck, read), o);
  }

 private:
  const SweepOptions& options_;
  const Plan& plan_;
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

Done run_tasks(const SweepOptions& options, const Plan& plan) {
  const fs::path file = plan.root / plan.shard.folder() / "rows.tsv";
  const RowsRead before = read_rows(file);
  std::vector<std::int64_t> tasks;
  for (std::int64_t run = plan.shard.index; run < plan.design.runs(); run += plan.shard.count)
    if (!before.rows.count(run)) tasks.push_back(run);
  Done done;
  if (tasks.empty()) return done;
  RowFile out(file, before.bytes);
  WorkerOptions w;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  w.processes = options.run.jobs > 0 ? options.run.jobs : cores;
  w.processes = static_cast<int>(
      std::min<std::int64_t>(w.processes, static_cast<std::int64_t>(tasks.size())));
  w.limit = options.limit;
  run::ProgressLine progress("sweep", options.run.quiet);
  const Runner run(options, plan);
  run_in_workers(
      tasks, w, run, [&](std::int64_t task, Ended ended, const std::string& text, int signal) {
        std::optional<Row> row = ended == Ended::answered ? row_of(text) : std::nullopt;
        if (!row) row = row_without_answer(task, ended, signal, w.limit, plan.responses.size());
        if (row->exit == static_cast<int>(Exit::interrupted)) return;  // to be done again
        out.append(line_of(*row));
        ++done.runs;
        done.failed += row->exit != 0;
        done.cpu += row->cpu;
        progress.update(
            static_cast<double>(done.runs) / static_cast<double>(tasks.size()),
            fmt::format("{} of {} runs, {} failed", done.runs, tasks.size(), done.failed));
      });
  out.close();
  progress.done(fmt::format("{} of {} runs, {} failed", done.runs, tasks.size(), done.failed));
  return done;
}

/// Makes the worst runs again with everything they can show. What fails now failed before.
void run_worst(const SweepOptions& options, const Plan& plan,
               const std::map<std::int64_t, Row>& rows) {
  const std::vector<std::int64_t> runs = worst_runs(plan, rows);
  if (runs.empty()) return;
  std::error_code ec;
  fs::remove_all(plan.root / "worst", ec);
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
  const int code = steps::run_deck(deck::load_model(options.deck, read), o);
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

/// The keys that are varied are there. What is wrong with their values is for the rows to say.
void require_keys(const SweepOptions& options, const Plan& plan) {
  deck::ReadOptions read = options.read;
  const std::vector<std::string> values = plan.design.values(0);
  for (std::size_t k = 0; k < values.size(); ++k)
    read.set.push_back(plan.design.factors()[k].path + "=" + values[k]);
  try {
    deck::load_model(options.deck, read);
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

int run_sweep(const SweepOptions& given) {
  if (given.deck == "-")
    throw Error(Exit::usage, Diagnostic{Diagnostic::Severity::error, "E99",
                                        "a deck on standard input can be read once only",
                                        "write it to a file", Where{}});
  run::install_interrupt_handlers();
  if (given.list) return list_tables(given);
  const model::Model model = deck::load_model(given.deck, given.read);
  const SweepOptions options = completed(given, model);
  const Plan plan = make_plan(options, model);
  require_keys(options, plan);
  prepare_folder(plan, options.run.resume);
  const run::RunLock lock(plan.root / plan.shard.folder());
  const Stopwatch watch;
  const Done done = run_tasks(options, plan);
  const auto rows = all_rows(plan);
  const auto missing = plan.design.runs() - static_cast<std::int64_t>(rows.size());
  if (missing == 0 && !run::interrupted()) run_worst(options, plan, rows);
  if (missing == 0) write_outcome(plan, rows, options.run);
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

}  // namespace whirl::sweep
