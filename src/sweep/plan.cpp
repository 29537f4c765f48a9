#include <sweep/confidence.hpp>
#include <sweep/plan.hpp>
#include <core/error.hpp>
#include <core/version.hpp>
#include <io/file.hpp>
#include <io/value.hpp>
#include <run/results_folder.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <regex>

namespace whirl::sweep {
namespace {

Error refusal(const std::string& message, const std::string& hint) {
  return Error(Exit::usage, Diagnostic{Diagnostic::Severity::error, "E99", message, hint, Where{}});
}

Sampling sampling_of(const std::string& name) {
  if (name == "random") return Sampling::random;
  if (name == "lhs") return Sampling::latin_hypercube;
  if (name == "sobol") return Sampling::sobol;
  if (name == "saltelli") return Sampling::saltelli;
  if (name == "morris") return Sampling::morris;
  if (name == "one_at_a_time") return Sampling::one_at_a_time;
  throw refusal(fmt::format("--sampling '{}' is not known", name),
                "random, lhs, sobol, saltelli, morris or one_at_a_time");
}

/// Of the response called this; count of responses: none.
std::size_t place_of(const std::vector<Response>& responses, const std::string& name) {
  const auto it = std::find_if(responses.begin(), responses.end(),
                               [&](const Response& r) { return r.name == name; });
  return static_cast<std::size_t>(it - responses.begin());
}

std::string stripped(const std::string& s) {
  const auto first = s.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t") - first + 1);
}

/// "peak > 40"
Limit read_limit(const std::string& text, const std::vector<Response>& responses) {
  const auto sign = text.find_last_of("<>");
  Limit limit;
  if (sign != std::string::npos) {
    const std::string value = stripped(text.substr(sign + 1));
    limit.response = place_of(responses, stripped(text.substr(0, sign)));
    limit.above = text[sign] == '>';
    const auto read = std::from_chars(value.data(), value.data() + value.size(), limit.value);
    const bool whole = read.ec == std::errc{} && read.ptr == value.data() + value.size();
    if (whole && limit.response < responses.size()) return limit;
  }
  throw refusal(fmt::format("--exceed '{}' is not NAME>VALUE or NAME<VALUE", text),
                "NAME of a --response, VALUE a number in its unit: 'peak>40'");
}

/// "peak:largest:10"
Worst read_worst(const std::string& text, const std::vector<Response>& responses) {
  Worst w;
  std::string name = text;
  while (true) {
    const auto colon = name.rfind(':');
    if (place_of(responses, name) < responses.size() || colon == std::string::npos) break;
    const std::string word = name.substr(colon + 1);
    const auto read = std::from_chars(word.data(), word.data() + word.size(), w.count);
    const bool number = read.ec == std::errc{} && read.ptr == word.data() + word.size();
    if (!number && word != "least" && word != "largest") break;
    w.least = w.least || word == "least";
    name.resize(colon);
  }
  w.response = place_of(responses, name);
  if (w.response == responses.size() || w.count == 0)
    throw refusal(fmt::format("--worst '{}' is not NAME[:least|:largest][:COUNT]", text),
                  "NAME of a --response: 'log decrement:least:5'");
  return w;
}

/// A number in the environment.
std::optional<std::int64_t> environment(const char* name) {
  const char* text = std::getenv(name);
  if (!text) return {};
  std::int64_t x = 0;
  const char* end = text + std::strlen(text);
  const auto read = std::from_chars(text, end, x);
  if (read.ec != std::errc{} || read.ptr != end) return {};
  return x;
}

Shard shard_of_environment() {
  struct Source {
    const char *place, *first, *count;
  };
  constexpr Source sources[] = {
      {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_COUNT"},
      {"OMPI_COMM_WORLD_RANK", nullptr, "OMPI_COMM_WORLD_SIZE"},
      {"PMI_RANK", nullptr, "PMI_SIZE"},
      {"SLURM_PROCID", nullptr, "SLURM_NTASKS"}};
  for (const Source& source : sources) {
    const auto place = environment(source.place), count = environment(source.count);
    const auto first = source.first ? environment(source.first) : std::optional<std::int64_t>(0);
    if (!place || !count || !first) continue;
    const Shard s{*place - *first, *count};
    if (s.index < 0 || s.index >= s.count)
      throw refusal(
          fmt::format("{} = {} is not one of {} from {}", source.place, *place, *count, *first),
          "array tasks go one by one: --array=1-7, not with a step");
    return s;
  }
  throw refusal("--shard auto, but this is no task of a Slurm array and no rank of srun or mpirun",
                "--shard 2/7 says it in so many words");
}

std::string text_of(const SweepOptions& o, const model::Model& model) {
  io::Value v = io::Value::object();
  v["program"] = version();
  v["deck"] = run::deck_hash(model);
  v["vary"] = o.vary;
  v["responses"] = o.responses;
  v["samples"] = o.samples.value_or(1);
  v["sampling"] = o.sampling;
  v["seed"] = o.seed.value_or(1);
  v["correlations"] = o.correlations;
  for (const std::string& vary : o.vary)
    if (vary.starts_with('@')) v["runs"].push(io::read_text(vary.substr(1)));
  return io::to_json(v);
}

/// Folders that a sweep has named, in the order of their names. Links lead elsewhere.
std::vector<std::filesystem::path> folders_named(const std::filesystem::path& root,
                                                 const std::regex& name) {
  std::vector<std::filesystem::path> out;
  std::error_code ec;
  for (const auto& entry : std::filesystem::directory_iterator(root, ec))
    if (entry.is_directory() && !entry.is_symlink() &&
        std::regex_match(entry.path().filename().string(), name))
      out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::filesystem::path> shard_folders(const std::filesystem::path& root) {
  static const std::regex name("shard_[0-9]+_of_[0-9]+");
  return folders_named(root, name);
}

/// The rows of a shard, and what its workers left.
void remove_rows(const std::filesystem::path& shard) {
  static const std::regex worker("worker_[0-9]+_[0-9]+");
  std::error_code ec;
  std::filesystem::remove(shard / "rows.tsv", ec);
  for (const auto& folder : folders_named(shard, worker))
    std::filesystem::remove_all(folder, ec);
}

/// All of them are held before the first goes.
void remove_other_shards(const std::filesystem::path& root, const std::filesystem::path& own) {
  std::vector<std::filesystem::path> others = shard_folders(root);
  std::erase(others, own);
  std::vector<std::unique_ptr<run::RunLock>> held;
  held.reserve(others.size());
  for (const auto& folder : others)
    held.push_back(std::make_unique<run::RunLock>(folder));
  for (const auto& folder : others)
    remove_rows(folder);
  held.clear();
  std::error_code ec;
  for (const auto& folder : others)
    std::filesystem::remove(folder, ec);  // where nothing else stands in it
}

}  // namespace

std::string Shard::folder() const { return fmt::format("shard_{}_of_{}", index + 1, count); }

Shard read_shard(const std::string& text) {
  if (text.empty()) return {};
  if (text == "auto") return shard_of_environment();
  Shard s;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, s.index);
  bool ok = first.ec == std::errc{} && first.ptr != end && *first.ptr == '/';
  if (ok) {
    const auto second = std::from_chars(first.ptr + 1, end, s.count);
    ok = second.ec == std::errc{} && second.ptr == end;
  }
  if (!ok || s.index < 1 || s.index > s.count)
    throw refusal(fmt::format("--shard '{}' is not one of several", text),
                  "--shard 2/7 does every seventh run from the second");
  --s.index;
  return s;
}

Plan make_plan(const SweepOptions& o, const model::Model& model) {
  Plan plan;
  std::vector<Factor> factors;
  int files = 0;
  for (const std::string& v : o.vary) {
    if (!v.starts_with('@')) {
      factors.push_back(read_factor(v));
      continue;
    }
    for (Factor& f : read_runs(v.substr(1), files))
      factors.push_back(std::move(f));
    ++files;
  }
  if (factors.empty())
    throw refusal("nothing is varied", "for instance --vary bearing.NDE.clearance=60um:90um:7");
  for (const std::string& r : o.responses) {
    plan.responses.push_back(read_response(r));
    for (std::size_t k = 0; k + 1 < plan.responses.size(); ++k)
      if (plan.responses[k].name == plan.responses.back().name)
        throw refusal(fmt::format("two responses are called '{}'", plan.responses[k].name),
                      "NAME=TABLE:COLUMN gives one a name of its own");
  }
  if (plan.responses.empty())
    throw refusal(
        "no response is asked for",
        "--response 'first critical=critical_undamped:speed:1'; `whirl sweep DECK --list` "
        "shows what there is");
  for (const std::string& text : o.exceed)
    plan.limits.push_back(read_limit(text, plan.responses));
  for (const std::string& text : o.worst)
    plan.worst.push_back(read_worst(text, plan.responses));
  std::vector<Correlation> correlations;
  for (const std::string& text : o.correlations)
    correlations.push_back(read_correlation(text));
  plan.design = Design(std::move(factors), o.samples.value_or(1), sampling_of(o.sampling),
                       o.seed.value_or(1), correlations);
  if (!plan.limits.empty() && !follows_distributions(plan.design))
    throw refusal(
        fmt::format(
            "--exceed asks for a probability, and the points of --sampling {} do not lie as "
            "the distributions have it",
            o.sampling),
        "--sampling random, lhs, sobol or saltelli");
  plan.shard = read_shard(o.shard);
  plan.root = o.run.output.empty() ? std::filesystem::path(model.output.directory + "_sweep")
                                   : o.run.output;
  plan.text = text_of(o, model);
  return plan;
}

std::unique_ptr<run::RunLock> prepare_folder(const Plan& plan, bool resume) {
  const auto file = plan.root / "plan.json";
  std::error_code ec;
  const bool there = std::filesystem::exists(file, ec);
  const bool same = there && io::read_text(file) == plan.text;
  if (there && !same && (resume || plan.shard.count > 1))
    throw refusal(
        fmt::format("{} holds another sweep", plan.root.string()),
        "the deck, the keys varied or the program have changed: take another --output, or "
        "remove the folder");
  const auto own = plan.root / plan.shard.folder();
  if (std::filesystem::is_symlink(own, ec))
    io::io_failure(own, "nothing is written through a symbolic link:");
  auto lock = std::make_unique<run::RunLock>(own);
  if (!resume) {
    if (plan.shard.count == 1) remove_other_shards(plan.root, own);
    remove_rows(own);
  }
  if (!same) io::write_atomic(file, plan.text);
  return lock;
}

std::vector<std::int64_t> worst_runs(const Plan& plan, const std::map<std::int64_t, Row>& rows) {
  std::vector<std::int64_t> out;
  for (const Worst& w : plan.worst) {
    std::vector<std::pair<double, std::int64_t>> order;
    for (const auto& [run, row] : rows) {
      if (plan.design.weight(run) == 0.0) continue;  // drawn where the distribution has nothing
      if (const Answer& a = row.answers[w.response]; a.failure.empty() && a.word.empty())
        order.emplace_back(w.least ? a.value : -a.value, run);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t k = 0; k < std::min(w.count, order.size()); ++k)
      if (std::find(out.begin(), out.end(), order[k].second) == out.end())
        out.push_back(order[k].second);
  }
  return out;
}

std::string worst_folder(std::int64_t run) { return fmt::format("worst/run_{:06}", run); }

void remove_worst_runs(const Plan& plan) {
  static const std::regex run("run_[0-9]+");
  const auto worst = plan.root / "worst";
  std::error_code ec;
  if (std::filesystem::is_symlink(worst, ec)) return;
  for (const auto& folder : folders_named(worst, run))
    if (std::filesystem::exists(folder / "run.json", ec)) std::filesystem::remove_all(folder, ec);
  std::filesystem::remove(worst, ec);
}

std::map<std::int64_t, Row> all_rows(const Plan& plan) {
  std::map<std::int64_t, Row> out;
  for (const auto& folder : shard_folders(plan.root))
    for (auto& [run, row] : read_rows(folder / "rows.tsv").rows)
      if (run >= 0 && run < plan.design.runs()) out.insert_or_assign(run, std::move(row));
  return out;
}

}  // namespace whirl::sweep
