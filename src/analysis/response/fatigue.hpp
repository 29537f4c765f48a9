// Load cycles of a stress that varies at random, counted as rainflow (ASTM E1049-85, 5.4.4), and the
// share of life they use up: amplitude at zero mean by Goodman's line, cycles to failure by Basquin's
// power law between two points, sum by Palmgren and Miner.
//
//   a0 = a/(1 - |m|/S)        a: amplitude, m: mean, S: strength
//   N  = 1000 (a0/thousand)^(-1/b),   b = lg(thousand/endurance)/lg(cycles/1000);  a0 <= endurance: no end
//   damage = sum of count/N;  where |m| or a0 reaches S: infinite
#pragma once
#include <core/types.hpp>
#include <vector>

namespace whirl::analysis {

struct LoadCycle {
  double range = 0, mean = 0;
  double count = 1;  ///< 1 or 1/2
  double amplitude() const { return 0.5 * range; }
};

/// Counts while the history goes on: what closes is handed on, what is open is kept.
class Rainflow {
 public:
  /// A value of the history; take(LoadCycle) gets every cycle that it closes.
  template <class Take>
  void push(double x, Take take) {
    if (!turns(x)) return;
    close(take);
  }
  /// The cycles that are still open, each as a half.
  template <class Take>
  void finish(Take take) const {
    for (std::size_t k = 1; k < open_.size(); ++k)
      take(cycle(open_[k - 1], open_[k], 0.5));
  }
  /// Reversals that wait for their partner, the newest last (which may still move).
  const std::vector<double>& open() const { return open_; }
  void reopen(std::vector<double> open) { open_ = std::move(open); }

 private:
  static LoadCycle cycle(double a, double b, double count) {
    return {std::abs(a - b), 0.5 * (a + b), count};
  }
  /// Takes x in; true when the list of reversals may have something to close. The last one moves on
  /// while the history does not turn.
  bool turns(double x) {
    const std::size_t n = open_.size();
    if (n > 0 && x == open_[n - 1]) return false;
    if (n > 1 && (open_[n - 1] - open_[n - 2]) * (x - open_[n - 1]) > 0)
      open_[n - 1] = x;
    else
      open_.push_back(x);
    return open_.size() > 2;
  }
  template <class Take>
  void close(Take take) {
    while (open_.size() > 2) {
      const std::size_t n = open_.size();
      const double newest = std::abs(open_[n - 1] - open_[n - 2]),
                   before = std::abs(open_[n - 2] - open_[n - 3]);
      if (newest < before) return;
      const bool begins = n == 3;  // it contains the start of the history
      take(cycle(open_[n - 3], open_[n - 2], begins ? 0.5 : 1.0));
      if (begins)
        open_.erase(open_.begin());
      else
        open_.erase(open_.end() - 3, open_.end() - 1);
    }
  }
  std::vector<double> open_;
};

/// Strengths, all in the unit of the stress. @pre strength > 0, thousand > endurance > 0, cycles > 1000.
struct FatigueStrength {
  double strength = 0, thousand = 0, endurance = 0, cycles = 1e6;
  /// Amplitude about zero that is as bad; infinite where the mean alone reaches the strength.
  double equivalent(double amplitude, double mean) const;
  /// Cycles to failure of that amplitude: infinity, or 0 where it reaches the strength.
  double life(double equivalent) const;
  double damage(const LoadCycle& c) const;
};

}  // namespace whirl::analysis
