// Where linear results leave what they stand on: responses larger than the gaps of supports, tables
// asked beyond their ends. Each is said once a step, with place and size (W11, W12).
#pragma once
#include <results/frequency.hpp>
#include <map>
#include <span>
#include <string>

namespace whirl::results {

/// Largest share of each support's gap (journal bearings, squeeze films, stops, rubs) that a steady
/// harmonic response takes, the static displacement included.
class GapCheck {
 public:
  explicit GapCheck(FrequencyStep& s) : step_(s) {}
  /// amplitudes: of all unknowns, one for each frequency of the response, about the equilibrium at
  /// the reference speed Omega, rad/s. frequency: of the excitation where it is not the speed,
  /// rad/s.
  void look(double Omega, std::span<const VecXc> amplitudes, double frequency = nan);
  /// W11 for every gap that a response oversteps; all shares into the summary ("gaps").
  void report();

 private:
  struct Worst {
    double displacement = 0, gap = 0;  ///< m
    double speed = 0, frequency = nan;
    bool film = false;
    Where where;
  };
  FrequencyStep& step_;
  std::map<std::string, Worst> worst_;
};

/// W12: bearings whose table ends within low .. high (reference speed, rad/s) and whose edge
/// coefficients are held beyond.
void warn_of_held_tables(run::Job& job, const std::string& step, double low, double high);

/// A warning of a step: terminal, report and summary.
void warn(run::Job& job, Diagnostic d);

}  // namespace whirl::results
