// Steady motion of a rotor whose forces change as it turns (a breathing crack, an asymmetric shaft
// under its weight, unbalance), as a Fourier series of the revolution:
//   q(t) = q_e + a_0 + sum_h Re(a_h exp(i h w t)),   w = |spin|,   h <= H,
// by Galerkin's method on the exact equations (harmonic balance): the residual at `samples` instants
// of the revolution, and the exact tangents there, whose Fourier components are Hill's matrix. Forces
// that are linear in the motion are solved in one step, others by Newton's method. The rotor turns at
// constant speed: its angle is prescribed, and whatever torque that takes is not looked at.
// Limits: one speed of all spinning lines; hysteretic damping has no form here (E88).
// Sources: A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, 1979, ch. 2 (harmonic balance);
// Friswell et al., Dynamics of Rotating Machines, 2010, ch. 7.
#pragma once
#include <analysis/linearizer.hpp>
#include <la/direct.hpp>

namespace whirl::analysis {

struct PeriodicMotion {
  double Omega = 0;              ///< rad/s
  std::vector<VecXc> amplitude;  ///< a_h, h = 0 .. H, of all unknowns; a_0 real
  bool converged = false;
  int rounds = 0;
  double last_share =
      0;  ///< largest displacement of a_H over that of the largest: what is left out
          ///< is about as large
};

class PeriodicResponse {
 public:
  /// @throws Error E88: lines of different speeds, hysteretic damping.
  explicit PeriodicResponse(Linearizer& linear, Index harmonics = 6);

  /// From the equilibrium at this speed.
  /// @pre Omega != 0.
  PeriodicMotion solve(double Omega);
  Index harmonics() const { return harmonics_; }

 private:
  void make_pattern();
  /// Motion at a sample from the coefficients, into q_, v_, a_.
  void move(double Omega, Index sample);
  /// Residual and matrix of the coefficients. False outside the range of an element.
  bool balance(double Omega);
  /// Hill's matrix from the tangents at the samples.
  void assemble(double w);
  double size_of(const VecX& coefficients) const;
  PeriodicMotion result(double Omega) const;

  Linearizer& linear_;
  Index harmonics_, parts_, samples_;
  MatX basis_, rate_, acceleration_;  ///< parts x samples; rates for w = 1
  std::unique_ptr<la::BlockPattern> pattern_;
  std::vector<unsigned char> active_;
  la::MCK hill_;
  std::vector<la::MCK> tangents_;  ///< one a sample
  std::unique_ptr<la::DirectSolver<double>> solver_;
  system::Workspace workspace_;
  VecX x_, r_, q_, v_, a_, f_;
};

}  // namespace whirl::analysis
