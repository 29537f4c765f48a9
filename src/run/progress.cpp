#include <run/progress.hpp>
#include <run/watch_progress.hpp>
#include <core/messages.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <unistd.h>
#include <utility>

namespace whirl::run {

ProgressLine::ProgressLine(std::string name, bool quiet)
    : name_(std::move(name)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0) {}

namespace {
thread_local const ProgressWatcher* watching = nullptr;
thread_local double last_told = 0;
constexpr double rest = 0.1;  // s, between two looks

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void tell(const std::string& step, double fraction, const std::string& text) {
  if (watching == nullptr) return;
  const double t = now();
  if (fraction < 1.0 && t - last_told < rest) return;
  last_told = t;
  (*watching)(step, fraction, text);
}
}  // namespace

WatchProgress::WatchProgress(ProgressWatcher watcher)
    : watcher_(std::move(watcher)),
      outer_(std::exchange(watching, &watcher_)) {
  last_told = 0;
}

WatchProgress::~WatchProgress() { watching = outer_; }

ProgressWatcher progress_watcher() { return watching != nullptr ? *watching : ProgressWatcher(); }

PhaseTimer::PhaseTimer(Job& job, std::string phase) : job_(job), phase_(std::move(phase)) {}

void put_run_time(io::Value& summary, const RunTime& time) {
  summary["run time, CPU [s]"] = time.cpu;
  summary["run time, wall [s]"] = time.wall;
}

PhaseTimer::~PhaseTimer() {
  const RunTime spent = watch_.elapsed();
  for (auto& [name, time] : job_.phases)
    if (name == phase_) {
      time += spent;
      return;
    }
  job_.phases.emplace_back(phase_, spent);
}

namespace {

/// ", 3 min left"; nothing while that is a guess.
std::string time_left(double fraction, double spent) {
  if (!(fraction > 0.02) || spent < 2.0) return {};
  const double left = spent * (1.0 - fraction) / fraction;
  if (left < 90.0) return fmt::format("  {:.0f} s left", left);
  if (left < 5400.0) return fmt::format("  {:.0f} min left", left / 60.0);
  return fmt::format("  {:.1f} h left", left / 3600.0);
}

}  // namespace

void ProgressLine::update(double fraction, const std::string& text) {
  tell(name_, fraction, text);
  if (quiet_) return;
  const double t = now();
  if (std::isnan(begin_)) {  // a resumed run is not at its start
    begin_ = t;
    first_ = fraction;
  }
  const double done = first_ < 1.0 ? (fraction - first_) / (1.0 - first_) : 1.0;
  const std::string left = time_left(done, t - begin_);
  if (terminal_) {
    if (t - last_time_ < rest || !is_heard()) return;
    last_time_ = t;
    say(fmt::format("\r\033[K{} {:3.0f} %  {}{}", name_, 100.0 * fraction, text, left));
  } else if (const int tenth = static_cast<int>(10.0 * fraction);
             tenth > last_tenth_ && tenth < 10) {
    last_tenth_ = tenth;
    if (tenth > 0) say(fmt::format("{} {} %  {}{}\n", name_, 10 * tenth, text, left));
  }
}

void ProgressLine::done(const std::string& text) {
  tell(name_, 1.0, text);
  if (quiet_) return;
  say(fmt::format("{}{}: {}\n", terminal_ ? "\r\033[K" : "", name_, text));
}

}  // namespace whirl::run
