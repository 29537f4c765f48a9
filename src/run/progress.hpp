// How long a run takes, and how far it is.
#pragma once
#include <run/job.hpp>
#include <core/stopwatch.hpp>
#include <core/types.hpp>
#include <io/value.hpp>
#include <string>

namespace whirl::run {

/// "run time, CPU [s]" and "run time, wall [s]" of a summary.
void put_run_time(io::Value& summary, const RunTime& time);

/// Adds the time since its construction to a phase of the job.
class PhaseTimer {
 public:
  PhaseTimer(Job& job, std::string phase);
  ~PhaseTimer();
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  Job& job_;
  std::string phase_;
  Stopwatch watch_;
};

/// Progress on a terminal (one line, rewritten) or one line per 10 %, with the time that is left at
/// the mean pace so far.
class ProgressLine {
 public:
  ProgressLine(std::string name, bool quiet);
  void update(double fraction, const std::string& text);
  void done(const std::string& text);

 private:
  std::string name_;
  bool quiet_, terminal_;
  int last_tenth_ = -1;
  double last_time_ = 0;
  double begin_ = nan, first_ = 0;  ///< time and fraction of the first update
};

}  // namespace whirl::run
