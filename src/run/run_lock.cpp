#include <run/run_lock.hpp>

#include <core/error.hpp>
#include <io/file.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fmt/format.h>
#include <string>

namespace whirl::run {

namespace fs = std::filesystem;

namespace {

/// What the holder wrote into the file: its number.
std::string holder_of(int descriptor) {
  char text[32] = {};
  const ssize_t n = ::pread(descriptor, text, sizeof text - 1, 0);
  std::string number(text, n > 0 ? static_cast<std::size_t>(n) : 0);
  while (!number.empty() && (number.back() < '0' || number.back() > '9'))
    number.pop_back();
  return number;
}

/// Whether the locked file is the one that stands in the folder now, not one its last holder
/// removed meanwhile.
bool still_there(int descriptor, const fs::path& file) {
  struct stat open_one {
  }, there{};
  return ::fstat(descriptor, &open_one) == 0 && ::stat(file.c_str(), &there) == 0 &&
         open_one.st_ino == there.st_ino && open_one.st_dev == there.st_dev;
}

}  // namespace

RunLock::RunLock(const fs::path& folder) : file_(folder / ".whirl.lock") {
  std::error_code ec;
  fs::create_directories(folder, ec);
  if (ec) io::io_failure(folder, "cannot make the results folder", ec.value());
  for (;;) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0) io::io_failure(file_, "cannot write", errno);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) return;  // no locks on this file system
      const std::string holder = holder_of(descriptor_);
      ::close(descriptor_);
      descriptor_ = -1;
      const std::string who = holder.empty() ? std::string("another run")
                                             : fmt::format("another run (process {})", holder);
      throw Error(
          Exit::io,
          Diagnostic{
              Diagnostic::Severity::error, "E97",
              fmt::format("{} is writing into the results folder '{}'", who, folder.string()),
              "wait for it, or give this run a folder of its own: -o FOLDER", Where{}});
    }
    if (still_there(descriptor_, file_)) break;
    ::close(descriptor_);
  }
  const std::string number = fmt::format("{}\n", ::getpid());
  // a file that was cut is written to the disk when it is closed, for which a new one need not wait
  struct stat found {};
  const bool cut = ::fstat(descriptor_, &found) == 0 && found.st_size > 0;
  if ((cut && ::ftruncate(descriptor_, 0) != 0) ||
      ::pwrite(descriptor_, number.data(), number.size(), 0) < 0) {
    // the number only serves the message of the other one
  }
}

RunLock::~RunLock() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());  // while it is held: who waits sees that it is gone
  ::close(descriptor_);
}

}  // namespace whirl::run
