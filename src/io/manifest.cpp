#include <io/file.hpp>
#include <io/manifest.hpp>
#include <core/error.hpp>
#include <core/messages.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <sstream>
#include <system_error>
#include <vector>

namespace whirl::io {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view head =
    "# Files in this folder that whirl made. Later runs replace these and leave all others "
    "alone.\n";

/// Stands in the list of a folder that held results from before there were lists: files found there
/// are replaced.
constexpr std::string_view older_mark = "# made before there were lists";

bool is_there(const fs::path& p) {
  std::error_code ec;
  return fs::symlink_status(p, ec).type() != fs::file_type::not_found;
}

bool regular(const fs::path& p) {
  std::error_code ec;
  return fs::symlink_status(p, ec).type() == fs::file_type::regular;
}

/// Whether the folder holds results of this program from the time before it kept lists.
bool has_older_results(const fs::path& root) {
  const fs::path run = root / "run.json";
  if (!regular(run)) return false;
  const std::string text = read_text(run);
  return text.size() < 100000 && text.find("\"program\": \"whirl ") != std::string::npos;
}

fs::path free_name(const fs::path& file) {
  fs::path kept = file;
  kept += ".kept";
  for (int n = 2; is_there(kept); ++n) {
    kept = file;
    kept += fmt::format(".kept{}", n);
  }
  return kept;
}

/// Moved, not copied: it stays the user's file.
void move_aside(const fs::path& file) {
  const fs::path kept = free_name(file);
  std::error_code ec;
  fs::rename(file, kept, ec);
  if (ec) io_failure(file, "cannot move aside", ec.value());
  say(fmt::format("note: '{}' was made by no run of whirl: it is kept as '{}'\n", file.string(),
                  kept.filename().string()));
}

}  // namespace

Manifest::Manifest(fs::path root) : root_(std::move(root)) {
  const fs::path list = root_ / file_name;
  if (!is_there(list)) {
    older_ = has_older_results(root_);
    if (older_) append(std::string(older_mark));
    return;
  }
  const std::string text = regular(list) ? read_text(list) : std::string();
  if (!text.starts_with(head)) {  // the user's own
    move_aside(list);
    return;
  }
  std::istringstream in(text);
  std::string line;
  while (std::getline(in, line)) {
    older_ = older_ || line == older_mark;
    if (!line.empty() && line.front() != '#') names_.insert(line);
  }
}

bool Manifest::inside(const std::string& name) const {
  const fs::path relative(name);
  if (name.empty() || relative.is_absolute()) return false;
  fs::path folder = root_;
  for (const fs::path& part : relative.parent_path()) {
    if (part == "..") return false;
    folder /= part;
    std::error_code ec;
    const fs::file_type type = fs::symlink_status(folder, ec).type();
    if (type == fs::file_type::symlink) return false;
    if (type == fs::file_type::not_found) return true;
  }
  return relative.filename() != "..";
}

void Manifest::append(const std::string& line) {
  if (!listing_) return;
  const fs::path list = root_ / file_name;
  const int fd = ::open(list.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (fd < 0) io_failure(list, "cannot write", errno);
  const std::string text =
      (::lseek(fd, 0, SEEK_END) == 0 ? std::string(head) : std::string()) + line + "\n";
  const ssize_t n = ::write(fd, text.data(), text.size());
  const int e = errno;
  ::close(fd);
  if (n != static_cast<ssize_t>(text.size())) io_failure(list, "cannot write", n < 0 ? e : ENOSPC);
}

bool Manifest::lists(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  return names_.count(std::string(name)) != 0;
}

void Manifest::protect(const std::vector<fs::path>& inputs) {
  const std::lock_guard lock(mutex_);
  for (const fs::path& file : inputs) {
    std::error_code ec;
    const fs::path whole = fs::weakly_canonical(fs::absolute(file, ec), ec);
    if (!ec) inputs_.push_back(whole);
  }
}

bool Manifest::is_read(const fs::path& file) const {
  if (inputs_.empty()) return false;
  std::error_code ec;
  const fs::path whole = fs::weakly_canonical(fs::absolute(file, ec), ec);
  return !ec && std::find(inputs_.begin(), inputs_.end(), whole) != inputs_.end();
}

void Manifest::list_nothing() {
  const std::lock_guard lock(mutex_);
  listing_ = false;
}

void Manifest::claim(std::string_view given, const std::string& owner) {
  const std::lock_guard lock(mutex_);
  const std::string name(given);
  if (!owner.empty())
    if (const auto [before, fresh] = owner_.emplace(name, owner); !fresh && before->second != owner)
      throw Error(
          Exit::deck,
          Diagnostic{Diagnostic::Severity::error,
                     "E16",
                     fmt::format("step '{}' would write the file '{}' over that of step '{}'",
                                 owner, name, before->second),
                     "rename one of the steps",
                     {}});
  if (!inside(name))
    io_failure(root_ / name,
               "nothing is written through a symbolic link, or outside the results folder:");
  const fs::path file = root_ / name;
  if (is_read(file))
    throw Error(
        Exit::io,
        Diagnostic{Diagnostic::Severity::error,
                   "E91",
                   fmt::format("results would replace '{}', which the deck reads", file.string()),
                   "write into another folder (-o, output.directory), or give the step "
                   "another name",
                   {}});
  if (names_.count(name)) return;
  const bool folder = [&] {
    std::error_code ec;
    return fs::symlink_status(file, ec).type() == fs::file_type::directory;
  }();
  if (folder) return;
  if (is_there(file) && !older_) move_aside(file);
  names_.insert(name);
  append(name);
}

void Manifest::remove(const std::function<bool(const std::string&)>& which) const {
  const std::lock_guard lock(mutex_);
  for (const std::string& name : names_) {
    const fs::path file = root_ / name;
    if (!which(name) || !inside(name) || !regular(file) || is_read(file)) continue;
    std::error_code ec;
    fs::remove(file, ec);
  }
}

void Manifest::remove_of(const std::string& owner) const {
  remove([&](const std::string& name) {
    const auto of = owner_.find(name);
    return of != owner_.end() && of->second == owner;
  });
}

}  // namespace whirl::io
