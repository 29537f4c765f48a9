// One run at a time in a results folder.
#pragma once
#include <filesystem>

namespace whirl::run {

/// Holds the folder (made when missing) until destroyed. The lock is the operating system's and
/// goes with the process: a run that was killed leaves nothing to clear up. File systems without
/// locks (some network shares) are used without one.
class RunLock {
 public:
  /// @throws Error (Exit::io, E97) when another process holds it; its number is in the message.
  explicit RunLock(const std::filesystem::path& folder);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace whirl::run
