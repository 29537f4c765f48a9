// Steady motion of a rotor whose forces change as it turns (a breathing crack, an asymmetric shaft
// under its weight, unbalance), as a Fourier series of the revolution:
//   q(t) = q_e + a_0 + sum_h Re(a_h exp(i h w t)),   w = |spin|,   h <= H,
// by Galerkin's method on the exact equations (harmonic balance): the residual at `samples` instants
// of the revolution, and the exact tangents there, whose Fourier components are Hill's matrix. Forces
// that are linear in the motion are solved in one step, others by Newton's method. The rotor turns at
// constant speed: its angle is prescribed, and whatever torque that takes is not looked at.
// A crack in series with a stiff element (system::SeriesCompliance) switches its rotation, while the moments
// at it are smooth: these are unknown too, with the same harmonics, m + g P(dW/dm) = P(M). (A rotation of
// few harmonics alone would put its rounded corners onto the stiff element, as large moments.)
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
  void make_fine_basis();
  /// Motion at a sample from the coefficients, into q_, v_, a_.
  void move(double Omega, Index sample);
  /// Residual and matrix of the coefficients. False outside the range of an element.
  bool balance(double Omega);
  /// Hill's matrix from the tangents at the samples.
  void assemble(double w);
  /// A compliance in series, with its moments, in axes that stand still: those in axes that turn miss a
  /// harmonic at one end.
  struct InSeries {
    system::SeriesCompliance of;
    double sense = 0;  ///< its axes turn by this times the angle of a sample; 0: not known yet
    std::vector<Vec2> moment;                             ///< M, one a sample
    std::vector<Eigen::Matrix<double, 2, 12>> by_motion;  ///< dM/dq of its two nodes
    std::vector<system::SeriesCompliance::Law> law;
    std::vector<system::SeriesCompliance::Kink> kink;
    VecX m;  ///< coefficients, a pair a part; empty: not known yet
  };
  /// What its law makes of the moments at a sample, without the rest of the system.
  bool look_at_series(double Omega, Index sample);
  void solve_moments(InSeries& c) const;
  /// Moments and motion in axes that stand still.
  void stand_still(InSeries& c) const;
  VecX moments_defect(const InSeries& c, const VecX& m,
                      std::vector<system::SeriesCompliance::Kink>& kinks) const;
  /// At the samples, without the harmonics that these would take for lower ones: of a law that switches
  /// as many more instants are looked at.
  void find_kinks(const InSeries& c, const VecX& m,
                  std::vector<system::SeriesCompliance::Kink>& kinks) const;
  void add_series(const InSeries& c);
  double weight(Index part) const {
    return (part == 0 ? 1.0 : 2.0) / static_cast<double>(samples_);
  }
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
  std::vector<InSeries> series_;
  std::vector<std::size_t> in_series_;  ///< terms
  std::vector<Vec2> kinks_;
  MatX fine_basis_;  ///< parts x instants
  MatX smooth_;      ///< instants x samples
};

}  // namespace whirl::analysis
