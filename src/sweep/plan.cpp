#include <sweep/plan.hpp>
#include <core/error.hpp>
#include <core/version.hpp>
#include <io/file.hpp>
#include <io/value.hpp>
#include <run/results_folder.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace whirl::sweep {
namespace {

Error refusal(const std::string& message, const std::string& hint) {
  return Error(Exit::usage, Diagnostic{Diagnostic::Severity::error, "E99", message, hint, Where{}});
}

Sampling sampling_of(const std::string& name) {
  if (name == "random") return Sampling::random;
  if (name == "lhs") return Sampling::latin_hypercube;
  if (name == "sobol") return Sampling::sobol;
  throw refusal(fmt::format("--sampling '{}' is not known", name), "random, lhs or sobol");
}

std::string text_of(const SweepOptions& o, const model::Model& model) {
  io::Value v = io::Value::object();
  v["program"] = version();
  v["deck"] = run::deck_hash(model);
  v["vary"] = o.vary;
  v["responses"] = o.responses;
  v["samples"] = o.samples;
  v["sampling"] = o.sampling;
  v["seed"] = o.seed;
  return io::to_json(v);
}

std::vector<std::filesystem::path> shard_folders(const std::filesystem::path& root) {
  std::vector<std::filesystem::path> out;
  std::error_code ec;
  for (const auto& entry : std::filesystem::directory_iterator(root, ec))
    if (entry.is_directory() && entry.path().filename().string().starts_with("shard_"))
      out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::string Shard::folder() const { return fmt::format("shard_{}_of_{}", index + 1, count); }

Shard read_shard(const std::string& text) {
  if (text.empty()) return {};
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
  for (const std::string& v : o.vary)
    factors.push_back(read_factor(v));
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
  plan.design = Design(std::move(factors), o.samples, sampling_of(o.sampling), o.seed);
  plan.shard = read_shard(o.shard);
  plan.root = o.run.output.empty() ? std::filesystem::path(model.output.directory + "_sweep")
                                   : o.run.output;
  plan.text = text_of(o, model);
  return plan;
}

void prepare_folder(const Plan& plan, bool resume) {
  const auto file = plan.root / "plan.json";
  std::error_code ec;
  const bool there = std::filesystem::exists(file, ec);
  const bool same = there && io::read_text(file) == plan.text;
  if (there && !same && (resume || plan.shard.count > 1))
    throw refusal(
        fmt::format("{} holds another sweep", plan.root.string()),
        "the deck, the keys varied or the program have changed: take another --output, or "
        "remove the folder");
  if (plan.shard.count > 1) {
    if (!resume) std::filesystem::remove_all(plan.root / plan.shard.folder(), ec);
  } else if (!resume) {
    for (const auto& folder : shard_folders(plan.root))
      std::filesystem::remove_all(folder, ec);
  }
  std::filesystem::create_directories(plan.root / plan.shard.folder(), ec);
  if (ec) io::io_failure(plan.root, "cannot make the folder", ec.value());
  if (!same) io::write_atomic(file, plan.text);
}

std::map<std::int64_t, Row> all_rows(const Plan& plan) {
  std::map<std::int64_t, Row> out;
  for (const auto& folder : shard_folders(plan.root))
    for (auto& [run, row] : read_rows(folder / "rows.tsv").rows)
      if (run >= 0 && run < plan.design.runs()) out.insert_or_assign(run, std::move(row));
  return out;
}

}  // namespace whirl::sweep
