#include <app/results_folder.hpp>
#include <app/sha256.hpp>
#include <app/version.hpp>
#include <chrono>
#include <ctime>
#include <fmt/format.h>
#include <io/file.hpp>
#include <io/value.hpp>
#include <system_error>

namespace whirl::app {

std::string deck_hash(const model::Model& model) { return sha256_hex(model.resolved); }

void check_space(const model::Model& model, const RunOptions& options) {
  std::filesystem::path folder = options.output.empty() ? std::filesystem::path(model.output.directory) : options.output;
  std::error_code ec;
  folder = std::filesystem::absolute(folder, ec);
  while (!std::filesystem::exists(folder, ec) && folder.has_relative_path()) folder = folder.parent_path();
  const auto space = std::filesystem::space(folder, ec);
  if (ec) return;
  auto problems = deck::check_output(model, static_cast<double>(space.available));
  if (problems.empty()) return;
  problems.front().where.file = model.deck_path;
  throw Error(Exit::deck, std::move(problems));
}

std::filesystem::path prepare_results(const model::Model& model, const RunOptions& options) {
  const std::filesystem::path folder = options.output.empty() ? std::filesystem::path(model.output.directory) : options.output;
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  if (ec) io::io_failure(folder, "cannot make the results folder", ec.value());
  check_space(model, options);
  // pictures of an earlier run with other steps or probes would stand among those of this one
  if (!options.resume && std::filesystem::is_directory(folder / "plots", ec))
    for (const auto& f : std::filesystem::directory_iterator(folder / "plots", ec))
      if (f.path().extension() == ".svg") std::filesystem::remove(f.path(), ec);
  io::write_atomic(folder / "resolved.toml", model.resolved);
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
  io::write_atomic(folder / "run.json", io::to_json(run));
  return folder;
}

}  // namespace whirl::app
