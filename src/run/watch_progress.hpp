// How far a run is, for programs that show it themselves.
#pragma once
#include <functional>
#include <string>

namespace whirl::run {

/// Called with the name of the step, how much of it is done (0 .. 1) and what the progress line says.
using ProgressWatcher =
    std::function<void(const std::string& step, double fraction, const std::string& text)>;

/// While one lives, every ProgressLine of its thread tells it where it is, at most ten times a
/// second and once at the end, whatever is printed.
class WatchProgress {
 public:
  explicit WatchProgress(ProgressWatcher watcher);
  ~WatchProgress();
  WatchProgress(const WatchProgress&) = delete;
  WatchProgress& operator=(const WatchProgress&) = delete;

 private:
  ProgressWatcher watcher_;
  const ProgressWatcher* outer_;
};

/// Whom the calling thread tells, to go on telling from another one; empty: nobody.
ProgressWatcher progress_watcher();

}  // namespace whirl::run
