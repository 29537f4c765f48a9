// Modes at many speeds side by side, before they are followed from one speed to the next.
//
// The equilibria are continued over the speeds one after the other; the modes of short runs of
// neighbouring speeds are then found by solvers of their own, each speed starting from the modes of
// the one before within its run, the first from those of the first speed of all. Runs are the same
// for any number of threads, and so are the results.
#pragma once
#include <analysis/spectra/whirl_modes.hpp>
#include <deque>
#include <exception>
#include <vector>

namespace whirl::analysis {

/// What is found at one speed.
struct ModesAtSpeed {
  double Omega = 0;  ///< rad/s
  Equilibrium equilibrium;
  std::vector<WhirlMode> modes;
  SpectrumCertificate certificate;
  std::exception_ptr failure;  ///< why there are none
};

class ModesAhead {
 public:
  static constexpr std::size_t run_length = 5;  ///< speeds of one solver
  /// speeds: rad/s, in the order they will be asked for. at_once: so many are solved for when the
  /// first of them is asked for; 0: all. threads: 0 = all processors.
  ModesAhead(Linearizer& linear, const ModesOptions& options, std::vector<double> speeds,
             std::size_t at_once, int threads);
  /// The next speed's, once it is asked for; null for any other speed. Valid until the next call.
  /// @throws what finding them threw.
  const ModesAtSpeed* at(double Omega);

 private:
  void solve_more();
  void continue_equilibria(std::vector<ModesAtSpeed>& batch);
  void solve_run(std::span<ModesAtSpeed> run, const WhirlSolver* seed) const;

  Linearizer& linear_;
  ModesOptions options_;
  std::vector<double> speeds_;
  std::size_t next_ = 0;  ///< of speeds_: the first not solved for
  std::size_t at_once_;
  int threads_;
  std::optional<Linearizer> seed_linear_;
  std::optional<WhirlSolver> seed_;  ///< at the first speed
  std::deque<ModesAtSpeed> ready_;
  ModesAtSpeed current_;
};

}  // namespace whirl::analysis
