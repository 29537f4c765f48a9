#include <run/memory_limit.hpp>
#include <core/parallel.hpp>
#include <core/types.hpp>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

namespace whirl::run {

namespace {

namespace fs = std::filesystem;

/// The number behind a word that begins a line; infinite: there is none.
double number_behind(const fs::path& file, const std::string& word) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first;
    double number = 0;
    if (words >> first >> number && first == word) return number;
  }
  return infinity;
}

double number_in(const fs::path& file) {
  std::ifstream in(file);
  double number = 0;
  return in >> number ? number : infinity;  // "max"
}

/// What a control group leaves. Pages of files are given up before a process is refused memory.
double left_by_group(const fs::path& group, const char* limit, const char* used,
                     const char* pages_of_files) {
  const double most = number_in(group / limit);
  const double now = number_in(group / used);
  if (!(most < infinity) || !(now < infinity)) return infinity;
  const double files = number_behind(group / "memory.stat", pages_of_files);
  return std::max(0.0, most - now + (files < infinity ? files : 0.0));
}

/// Of the group of this process and those it is in, after both versions.
double left_by_groups() {
  double left = infinity;
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string kinds = line.substr(first + 1, second - first - 1);
    if (!kinds.empty() && kinds != "memory") continue;
    const fs::path root = kinds.empty() ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    fs::path group = line.substr(second + 1);
    for (;; group = group.parent_path()) {
      const fs::path folder = root / group.relative_path();
      left = std::min(left,
                      kinds.empty()
                          ? left_by_group(folder, "memory.max", "memory.current", "inactive_file")
                          : left_by_group(folder, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                          "total_inactive_file"));
      if (group == group.parent_path()) break;
    }
  }
  return left;
}

/// What `ulimit -v` leaves.
double left_of_addresses() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return infinity;
  const double used = number_in("/proc/self/statm") * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

}  // namespace

double available_memory() {
  const double machine = 1024 * number_behind("/proc/meminfo", "MemAvailable:");
  return std::min({machine, left_by_groups(), left_of_addresses()});
}

double memory_limit(const RunOptions& options) {
  return options.max_memory > 0 ? options.max_memory : available_memory();
}

namespace {

int threads_of(const RunOptions& options) { return options.jobs > 0 ? options.jobs : processors(); }

}  // namespace

bool steps_fit_side_by_side(const model::Model& model, const RunOptions& options) {
  return deck::memory_of_steps_side_by_side(model, threads_of(options)) <= memory_limit(options);
}

void check_memory(const model::Model& model, const RunOptions& options) {
  const int threads = threads_of(options);
  auto problems = deck::check_memory(model, threads, memory_limit(options), options.max_memory > 0);
  if (problems.empty()) return;
  if (problems.front().where.file.empty()) problems.front().where.file = model.deck_path;
  throw Error(Exit::deck, std::move(problems));
}

}  // namespace whirl::run
