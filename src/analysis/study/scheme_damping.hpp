// What a time scheme does to a mode of the rotor: numerical damping against physical damping.
//
// A step of length h multiplies a motion exp(lambda t) by R(lambda h) instead of exp(lambda h). R
// is the stability function of the scheme: Radau IIA of order 5, (1 + 2z/5 + z^2/20)/(1 - 3z/5 +
// 3z^2/20 - z^3/60); Gauss of order 4 and 6, the diagonal Pade approximations; generalized-alpha,
// the principal root of its amplification matrix for q'' = lambda^2 q (J. Chung, G. M. Hulbert, J.
// Appl. Mech. 60 (1993) 371-375, doi 10.1115/1.2900803), with damping of the mode left out.
#pragma once
#include <analysis/transient/observer.hpp>
#include <core/types.hpp>
#include <string_view>
#include <vector>

namespace whirl::analysis {

/// R(lambda h); nan for a scheme that has none (variable order).
Complex amplification(std::string_view method, double rho_inf, Complex lambda, double h);

/// Extra decay rate -ln|R|/h + Re lambda, 1/s: what the scheme takes from the mode beside its own
/// damping; negative: gives.
double numerical_decay(std::string_view method, double rho_inf, Complex lambda, double h);

/// Lengths of all steps, counted in bins a ninth apart, and the largest spin: enough to find
/// afterwards what the steps did to a mode.
class StepHistogram final : public Observer {
 public:
  explicit StepHistogram(Index reference) : reference_(reference) {}
  void begin(const Snapshot& s) override { look(s); }
  void step(StepAccess& s) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  double largest_spin() const { return spin_; }  ///< |rad/s|
  double seconds() const { return seconds_; }
  /// Mean of numerical_decay, 1/s, over the half of the run with the shortest steps: step control
  /// lengthens steps only while nothing that fast moves beyond the tolerance, and damps what is not
  /// there; at equal steps it is the mean over the run.
  double mean_decay(std::string_view method, double rho_inf, Complex lambda) const;

 private:
  void look(const Snapshot& s);
  static constexpr int per_octave = 6, octaves = 60;  ///< 1e-16 s ... 100 s
  Index reference_;
  double spin_ = 0, seconds_ = 0;
  std::vector<double> time_ =
      std::vector<double>(per_octave * octaves, 0.0);  ///< seconds spent in steps of a bin
};

}  // namespace whirl::analysis
