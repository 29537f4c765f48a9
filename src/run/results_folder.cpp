#include <run/results_folder.hpp>
#include <run/checkpoint.hpp>
#include <core/version.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fmt/format.h>
#include <sha2.h>
#include <core/text.hpp>
#include <io/file.hpp>
#include <io/json.hpp>
#include <io/results.hpp>
#include <unistd.h>
#include <cerrno>
#include <io/value.hpp>
#include <algorithm>
#include <new>
#include <vector>
#include <system_error>

namespace whirl::run {

std::string deck_hash(const model::Model& model) {
  char digits[SHA256_DIGEST_STRING_LENGTH];
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(model.resolved.data());
  if (!SHA256Data(bytes, model.resolved.size(), digits)) throw std::bad_alloc();
  return digits;
}

namespace {

constexpr double worth_saying = 1e9;  // bytes of output

/// Pictures of an earlier run with other steps or probes would stand among those of this one; its
/// checkpoints would be resumed.
bool is_of_one_run(const std::string& name) {
  return (name.starts_with("plots/") && name.ends_with(".svg")) ||
         (name.starts_with("checkpoint/") &&
          (name.ends_with(".whirl") || name.ends_with(earlier_extension)));
}

/// The results folder, or what is there of the way to it.
std::filesystem::path existing_part(const model::Model& model, const RunOptions& options) {
  std::filesystem::path folder =
      options.output.empty() ? std::filesystem::path(model.output.directory) : options.output;
  std::error_code ec;
  folder = std::filesystem::absolute(folder, ec);
  while (!std::filesystem::exists(folder, ec) && folder.has_relative_path())
    folder = folder.parent_path();
  return folder;
}

}  // namespace

void check_folder(const model::Model& model, const RunOptions& options) {
  const std::filesystem::path folder = existing_part(model, options);
  std::error_code ec;
  if (!std::filesystem::is_directory(folder, ec))
    io::io_failure(folder, "no results can be written below the file", ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    io::io_failure(folder, "no results can be written in", errno);
}

void check_space(const model::Model& model, const RunOptions& options) {
  std::error_code ec;
  const auto space = std::filesystem::space(existing_part(model, options), ec);
  if (ec) return;
  const double available = static_cast<double>(space.available);
  const bool limited = options.max_disk > 0 && options.max_disk < available;
  auto problems = deck::check_output(model, limited ? options.max_disk : available, limited);
  if (!problems.empty()) {
    if (problems.front().where.file.empty()) problems.front().where.file = model.deck_path;
    throw Error(Exit::deck, std::move(problems));
  }
  const deck::OutputEstimate e = deck::estimate_output(model);
  if (options.quiet || e.total() < worth_saying) return;
  std::fputs(fmt::format("the output will take {} {} (histories {}, pictures {}); {} are free\n",
                         e.at_most || e.fewer_frames ? "at most" : "about",
                         deck::size_text(e.total()), deck::size_text(e.histories),
                         deck::size_text(e.pictures), deck::size_text(available))
                 .c_str(),
             stderr);
}

std::vector<std::string> steps_of_earlier_run(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "run.json";
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec)) return {};
  std::vector<std::string> names;
  try {
    const io::Value run = io::parse_json(io::read_text(file), file.string());
    if (run.is_object() && run.at("steps").is_array())
      for (const io::Value& name : run.at("steps").items())
        if (name.is_text()) names.push_back(name.text());
  } catch (const Error&) {
    // cut off or somebody else's: nothing is known of what that run left
  }
  return names;
}

void remove_results_of(const io::ResultsFolder& folder, const std::vector<std::string>& steps) {
  if (steps.empty()) return;
  const auto is_of_step = [&](const std::string& name) {
    return std::any_of(steps.begin(), steps.end(), [&](const std::string& step) {
      const std::string begin = safe_stem(step);
      return name.starts_with(begin + "_") || name.starts_with(begin + ".");
    });
  };
  folder.remove([&](const std::string& name) {
    if (name == "summary.json" || name == "report.html") return true;
    const bool table = name.ends_with(".csv") || name.ends_with(".h5");
    const bool own = name.find('/') == std::string::npos;
    return table && own && is_of_step(name);
  });
}

std::filesystem::path prepare_results(const model::Model& model, const RunOptions& options) {
  const std::filesystem::path root =
      options.output.empty() ? std::filesystem::path(model.output.directory) : options.output;
  check_space(model, options);
  if (!options.only_files.empty()) return root;
  // before anything is removed: what they go on from may stand in this folder
  std::vector<std::string> kept;
  if (!options.resume) kept = states_to_keep(model, root);
  io::ResultsFolder folder(root);
  folder.protect(options.inputs);
  if (!options.resume)
    folder.remove([&](const std::string& name) {
      return is_of_one_run(name) && std::find(kept.begin(), kept.end(), name) == kept.end();
    });
  folder.write_text("resolved.toml", model.resolved);
  io::Value run = io::Value::object();
  run["program"] = "whirl " + version();
  run["deck"] = model.deck_path;
  run["title"] = model.title;
  run["sha256"] = deck_hash(model);
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  run["started"] = text;
  run["steps"] = io::Value::array();
  for (const model::Step& s : model.steps)
    run["steps"].push(s.name);
  folder.write_json("run.json", run);
  return root;
}

}  // namespace whirl::run
