#include <core/error.hpp>
#include <fcntl.h>
#include <io/file.hpp>
#include <signal.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

namespace whirl::io {

namespace fs = std::filesystem;

namespace {
constexpr std::string_view part_extension = ".part";
}

void io_failure(const fs::path& file, const std::string& what, int error_number) {
  std::string m = what + " '" + file.string() + "'";
  if (error_number) m += std::string(": ") + std::strerror(error_number);
  std::string hint;
  if (error_number == ENOSPC) hint = "the disk is full";
  if (error_number == EACCES || error_number == EROFS) hint = "choose another output directory";
  throw Error(Exit::io, Diagnostic{Diagnostic::Severity::error, "E91", std::move(m),
                                   std::move(hint), Where{}});
}

fs::path temporary_beside(const fs::path& file) {
  static std::atomic<unsigned> count{0};
  std::string name(1, '.');
  name += file.filename().string();
  name += '.';
  name += std::to_string(::getpid());
  name += '.';
  name += std::to_string(count++);
  name += part_extension;
  return file.parent_path() / name;
}

namespace {

// The process that was writing `name`, or 0 when no process of ours makes such names.
long writer_of(std::string_view name) {
  if (name.size() < 2 || name.front() != '.' || !name.ends_with(part_extension)) return 0;
  name.remove_suffix(part_extension.size());
  const auto number = [&name]() -> long {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos || dot + 1 == name.size()) return -1;
    long n = 0;
    const std::string_view digits = name.substr(dot + 1);
    const auto [end, bad] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    name = name.substr(0, dot);
    return bad == std::errc() && end == digits.data() + digits.size() ? n : -1;
  };
  if (number() < 0) return 0;
  return std::max(number(), 0L);
}

void remove_leftovers_of(const fs::path& folder) {
  std::error_code ec;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const long pid = writer_of(it->path().filename().native());
    if (pid == 0 ||
        (pid != ::getpid() && (::kill(static_cast<pid_t>(pid), 0) == 0 || errno != ESRCH)))
      continue;
    std::error_code ignored;  // somebody else may have removed it
    fs::remove(it->path(), ignored);
  }
}

}  // namespace

void remove_leftovers(const fs::path& folder) {
  std::error_code ec;
  remove_leftovers_of(folder);
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    std::error_code unknown;
    if (it->is_directory(unknown) && !it->is_symlink(unknown)) remove_leftovers_of(it->path());
  }
}

void rename_into_place(const fs::path& from, const fs::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) {
    const int e = errno;
    ::unlink(from.c_str());
    io_failure(to, "cannot write", e);
  }
}

namespace {

void make_parent(const fs::path& file) {
  if (!file.has_parent_path()) return;
  std::error_code ec;
  fs::create_directories(file.parent_path(), ec);
  if (ec) io_failure(file.parent_path(), "cannot make the folder", ec.value());
}

// Nearly always the folder is there: asked for only when the file cannot be made. -1: see errno.
int open_new(const fs::path& file) {
  constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
  const int fd = ::open(file.c_str(), flags, 0666);
  if (fd >= 0 || (errno != ENOENT && errno != ENOTDIR)) return fd;
  make_parent(file);
  return ::open(file.c_str(), flags, 0666);
}

// Returns 0 or errno.
int write_all(int fd, const char* p, std::size_t n) {
  while (n > 0) {
    const ssize_t k = ::write(fd, p, n);
    if (k < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    p += k;
    n -= static_cast<std::size_t>(k);
  }
  return 0;
}

bool waits_for_disk = true;

/// 0 or an error number.
int wait_for_disk(int fd) {
  const bool done = !waits_for_disk || ::fdatasync(fd) == 0 || errno == EINVAL || errno == EROFS;
  return done ? 0 : errno;
}

}  // namespace

void set_waiting_for_disk(bool wait) { waits_for_disk = wait; }

void write_atomic(const fs::path& file, std::string_view content) {
  const fs::path tmp = temporary_beside(file);
  const int fd = open_new(tmp);
  if (fd < 0) io_failure(file, "cannot write", errno);
  int e = write_all(fd, content.data(), content.size());
  // a power cut after the rename must not leave a file of that name without its content
  if (e == 0) e = wait_for_disk(fd);
  if (::close(fd) != 0 && e == 0) e = errno;
  if (e != 0) {
    ::unlink(tmp.c_str());
    io_failure(file, "cannot write", e);
  }
  rename_into_place(tmp, file);
}

std::string read_text(const fs::path& file) {
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) io_failure(file, "cannot read", errno);
  std::string s;
  std::size_t n = 0;
  for (;;) {
    if (s.size() < n + 65536) s.resize(std::max<std::size_t>(n + 65536, 2 * n));
    const ssize_t k = ::read(fd, s.data() + n, s.size() - n);
    if (k < 0 && errno == EINTR) continue;
    if (k < 0) {
      const int e = errno;
      ::close(fd);
      io_failure(file, "cannot read", e);
    }
    if (k == 0) break;
    n += static_cast<std::size_t>(k);
  }
  ::close(fd);
  s.resize(n);
  return s;
}

AppendFile::AppendFile(std::size_t buffer_bytes)
    : buffer_(std::max<std::size_t>(buffer_bytes, 4096), '\0') {}

AppendFile::~AppendFile() {
  try {
    close();
  } catch (...) {  // a destructor has nobody to tell; close() before it to know
  }
}

void AppendFile::create(const fs::path& file, std::string_view head) {
  close();
  path_ = file;
  const fs::path tmp = temporary_beside(file);
  fd_ = open_new(tmp);
  if (fd_ < 0) io_failure(file, "cannot write", errno);
  if (const int e = write_all(fd_, head.data(), head.size())) {
    ::close(std::exchange(fd_, -1));
    ::unlink(tmp.c_str());
    io_failure(file, "cannot write", e);
  }
  rename_into_place(tmp, file);  // the descriptor follows the file
}

void AppendFile::reopen(const fs::path& file, std::uint64_t size) {
  close();
  path_ = file;
  fd_ = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd_ < 0) io_failure(file, "cannot continue", errno);
  if (::ftruncate(fd_, static_cast<off_t>(size)) != 0 ||
      ::lseek(fd_, static_cast<off_t>(size), SEEK_SET) < 0)
    io_failure(file, "cannot continue", errno);
}

char* AppendFile::reserve(std::size_t n) {
  if (used_ + n > buffer_.size()) flush();
  if (n > buffer_.size()) buffer_.resize(n);
  return buffer_.data() + used_;
}

void AppendFile::flush() {
  if (fd_ < 0 || used_ == 0) return;
  const int e = write_all(fd_, buffer_.data(), used_);
  used_ = 0;
  if (e != 0) io_failure(path_, "cannot write", e);
}

void AppendFile::sync() {
  flush();
  if (fd_ < 0) return;
  if (const int e = wait_for_disk(fd_)) io_failure(path_, "cannot write", e);
}

void AppendFile::close() {
  if (fd_ < 0) return;
  const int fd = fd_;
  try {
    flush();
  } catch (...) {
    fd_ = -1;
    ::close(fd);
    throw;
  }
  fd_ = -1;
  if (::close(fd) != 0) io_failure(path_, "cannot write", errno);
}

void OverwriteFile::open(const fs::path& file) {
  close();
  path_ = file;
  fd_ = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (fd_ < 0) io_failure(path_, "cannot write", errno);
}

void OverwriteFile::put(std::uint64_t offset, std::string_view s) {
  while (!s.empty()) {  // a write to a disk is cut short only when the disk is full
    const ssize_t k = ::pwrite(fd_, s.data(), s.size(), static_cast<off_t>(offset));
    if (k < 0 && errno == EINTR) continue;
    if (k < 0) io_failure(path_, "cannot write", errno);
    s.remove_prefix(static_cast<std::size_t>(k));
    offset += static_cast<std::uint64_t>(k);
  }
}

void OverwriteFile::close() {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

}  // namespace whirl::io
