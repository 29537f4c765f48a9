// Rotors whose matrices turn with them (shafts with unequal principal stiffnesses, tilted or
// unequal bodies): small motions in axes that rotate with the rotor, where they are constant on
// isotropic supports.
//
// q = T(theta) x, theta = Omega t of the rotor (its speed_ratio times the reference's, with its
// sign): T turns (u_y, u_z) and (gamma2, gamma3) of every node about the
// axis by theta and leaves axial motion and twist alone. With J the quarter turn, T' = Omega J T,
//   M~ = T^T M T,   C~ = T^T C T + 2 Omega M~ J,   K~ = T^T K T + Omega T^T C T J + Omega^2 M~ J^2.
// On isotropic supports these do not depend on theta: a quadratic eigenvalue problem on the pattern
// of the system, exact. Where the supports are unequal too they have period pi (or 2 pi) in theta.
// Then G. W. Hill's determinant: motions exp(lambda t) sum_h x_h exp(i h b theta), b = 2 or 1
// harmonics apart, h = -H .. H, written in real sines and cosines and balanced by Galerkin's
// method: (2H+1) times the unknowns, still sparse. Each characteristic exponent turns up 2H+1
// times, i b Omega apart; the copy with the largest constant part is kept (harmonics above H are
// neglected: the error falls by the ratio of the anisotropy a harmonic).
// Sources: F. M. Dimentberg, Flexural Vibrations of Rotating Shafts, 1961; Friswell et al.,
// Dynamics of Rotating Machines, 2010, ch. 7.
#pragma once
#include <analysis/linearizer.hpp>
#include <analysis/spectra/harmonic_balance.hpp>
#include <la/direct.hpp>
#include <la/eigen.hpp>
#include <algorithm>
#include <memory>
#include <optional>

namespace whirl::analysis {

/// Where what varies can join two motions.
struct Resonance {
  double speed = 0;      ///< of the reference, rad/s
  double frequency = 0;  ///< of one of them there, in rotating axes, rad/s
  double slope = 0;      ///< by which their frequencies part, rad/s for every rad/s of the speed
};

/// H of Hill's equations where the matrices are periodic.
struct Harmonics {
  Index least = 1, most = 3;
  /// Of the reference, rad/s: the slowest speed to come, at which more harmonics join; NaN: that of the
  /// probe.
  double slowest = nan;
};

class RotatingAxes {
 public:
  /// harmonics: 0 is enough on isotropic supports and is chosen then whatever is asked for, and fewer than
  /// most where what varies (a sagging shaft) joins motions so little that bands of the rest would grow by
  /// less than 1e-6 of the speed.
  /// @throws Error E88, the lines turn at different speeds, or what is unequal turns both ways.
  RotatingAxes(Linearizer& linear, double Omega_probe, Harmonics harmonics = {},
               Motion motion = Motion::lateral);

  /// @throws Error E88, the lines turn at different speeds.
  static void require(const SteadySystem& running);

  /// Speed of the axes at one of the reference, rad/s, with its sign.
  double speed(double Omega) const { return ratio_ * Omega; }
  /// Matrices at Omega on pattern(); valid until the next call. lambda: rate in rotating axes, for
  /// hysteretic damping.
  /// @throws Error (E76) when the state lies outside the range of an element.
  const la::MCK& at(double Omega, Complex lambda = {});
  const la::BlockPattern& pattern() const { return *pattern_; }
  std::span<const unsigned char> active() const { return active_; }
  /// Constant in rotating axes.
  bool constant() const { return harmonics_ == 0; }
  Index harmonics() const { return harmonics_; }
  /// 1 or 2: what varies has the period of one or of half a revolution of the axes.
  Index step() const { return step_; }
  /// Multiples of the speed at which what varies can join two motions: 1 .. this.
  Index joined_multiples() const { return step_ * harmonics_ + 1; }
  bool hysteretic() const { return linear_.hysteretic(); }
  /// rad/s, in these axes: beyond it what turns makes no motion grow at speeds up to this one, though
  /// motions are found there; infinite: the motions of least frequency end below it, or not far above. The multiples
  /// that are kept join two motions whose frequencies add up to one of them, or differ by it where one
  /// has negative energy, which slower whirl than the rotor's turning has (its frequency here is below
  /// the speed). The three motions of least frequency lie within it in any case.
  double reach(double Omega) const;
  /// Something does turn with the rotor: the matrices in fixed axes are not constant.
  bool turning() const { return turning_; }
  /// Speeds between the first and the last at which two natural frequencies of the mean matrices, in fixed
  /// axes, add up to a multiple of the speed of the axes or differ by one, ascending; each frequency between
  /// the speeds by straight lines, of the six slowest motions. Nothing: a table of supports ends below them.
  /// @pre ascending speeds; sense: as of BandOptions.
  std::optional<std::vector<Resonance>> resonances(const std::vector<double>& speeds,
                                                   double sense) const;
  /// Complex speeds of the reference, rad/s, at which response() or multiples() have no bound, their real
  /// parts from low to high and ascending, imaginary parts >= 0: each is the place of a peak and half its
  /// width; a real one, of a peak without bound. Those too faint to be seen are left out. Exact where
  /// matrices are quadratic in the speed; elsewhere found on pieces of the range, then settled.
  std::vector<Complex> poles(double low, double high);
  /// Share of the constant part of a motion, 0 .. 1 (1 when constant()).
  double constant_share(const VecXc& x) const;
  /// Share of the last harmonic of a motion, 0 .. 1 (0 when constant()): what more of them would add is
  /// less.
  double last_share(const VecXc& x) const;
  /// Of the steady motion last solved for (response() or multiples()): how large its last harmonics are,
  /// over the largest displacement.
  double last_share() const { return share_; }
  /// Constant part of a motion, on the unknowns of the system, rotating axes.
  VecXc constant_part(const VecXc& x) const;
  /// What the roots of the matrices that at() gave last are near, where these are periodic: motions
  /// of the mean matrices (as many of these, or up to the frequency, as the options say), and their
  /// copies in every harmonic: none of them knows of what varies.
  /// @pre !constant(), and at() has been called.
  std::vector<la::Mode> motions_and_copies(const la::ModeOptions& options) const;
  /// Symmetric part of the mean K~ (negative eigenvalues: what the rotation has made unstable if
  /// nothing gyroscopic held it).
  Index negative_stiffnesses(double Omega);

  /// Steady motion Re(a exp(i theta)), theta = |ratio| Omega t, under forces Re(f exp(i theta)) that turn with
  /// the rotor, both in fixed axes and of length system().size(): what unbalance does to a rotor
  /// whose stiffness turns with it. Lateral; parts at other multiples of the speed, which unequal
  /// supports cause, are left out of a.
  /// NaN where the rotor stands at the edge of a band.
  /// @throws Error (E88): the forces do not turn with the rotor.
  VecXc response(double Omega, const VecXc& f);

  /// Steady motion under f (response()) and of weight and other forces of fixed direction, which meet
  /// another stiffness or inertia at every angle. Amplitudes a_h of Re(a_h exp(i h w t)),
  /// w = |speed(Omega)|, h = 0 .. count, about the equilibrium of the mean; a_0 real; a_1 that of f alone.
  /// Lateral; NaN as response(). On isotropic supports the mean and twice the speed are all: the weight turns
  /// backwards in the axes. On unequal ones f makes odd multiples; without f (empty) the even ones are right.
  /// @pre count >= 2.
  std::vector<VecXc> multiples(double Omega, const VecXc& forces, int count);

 private:
  /// M, C and K of a block less those at the first angle, each as (36), as waves of the angle.
  using Changes = Eigen::Matrix<double, 108, Eigen::Dynamic>;
  /// Largest displacement of a steady motion in parts, m, and of its last harmonics.
  struct SteadySize {
    double all = 0, last = 0;
    double share(double floor) const {
      const double size = std::max(all, floor);
      return size > 0 ? last / size : 0.0;
    }
  };
  SteadySize size_of(const VecX& x, Index parts) const;
  /// Of what a block of unknowns does, m^2: its displacement, and its tilt at arm_, without which a
  /// rigid rotor that tilts about its middle would not move.
  template <class Motion>
  double squared_size(const Motion& x, Index block) const {
    return x.template segment<3>(6 * block).squaredNorm() +
           arm_ * arm_ * x.template segment<2>(6 * block + system::gamma2).squaredNorm();
  }
  /// Parts of the motion under forces that turn, and under those of fixed direction; empty at the edge of a
  /// band.
  VecX solve_response(double Omega, const VecXc& forces);
  VecX solve_standing(double Omega);
  /// Of the lines whose matrices turn with them; where none do, of the first that turns.
  void find_ratio(double Omega);
  /// Of the motion and of what turns with the rotor; 0: the constant part.
  std::vector<Index> orders() const;
  /// Amplitudes of the multiples 0 .. count of the angle, of a motion in these parts.
  std::vector<VecXc> in_fixed_axes(const VecX& x, const std::vector<Index>& orders,
                                   Index count) const;
  /// Harmonic balance in sines and cosines of these multiples of the angle of the axes, ascending; 0:
  /// the constant part. out stands on a pattern of make_pattern().
  void balance(double Omega, Complex lambda, const std::vector<Index>& orders,
               std::unique_ptr<HarmonicBalance>& kept, la::MCK& out);
  /// By what blocks differ at this angle from the first, turned_ from first_.
  void note_changes(const HarmonicBalance& of, double theta, Index points);
  /// Node i, part j -> node parts i + j: neighbours stay neighbours.
  std::unique_ptr<la::BlockPattern> make_pattern(Index parts) const;
  /// Matrices of multiples(), as at().
  const la::MCK& at_odd(double Omega);
  /// A matrix of a steady motion, whose multiples of the angle of the axes these are.
  struct Steady;
  void find_poles(const Steady& of, double low, double high, std::vector<Complex>& out);
  /// What is unbalanced at the equilibrium, in these parts.
  VecX unbalanced(double Omega, const std::vector<Index>& orders);
  /// Matrices in rotating axes at one angle of these, on the system's pattern, into turned_.
  void sample(double Omega, double theta, Complex lambda, bool without_series = false);
  /// Takes compliances in series into account, whose moments have the harmonics of the motion. They are
  /// not in out. @pre the equilibrium is at this speed.
  void add_series(double Omega, const std::vector<Index>& orders, la::MCK& out);
  /// x exp(lambda t) as the motion exp((lambda + i h step w) t) of the harmonic h, in the parts of at();
  /// w: speed of the axes, rad/s.
  la::Mode copy(const la::Mode& mean, Index h, double w) const;
  /// The equilibrium at hand serves this speed too.
  bool still_balanced(double Omega);
  Linearizer& linear_;
  MotionReduction motion_;
  bool turning_ = false, moved_ = false;
  double ratio_ = 1.0;  ///< speed of the axes over the reference's
  Index harmonics_ = 0, step_ = 2;
  std::vector<double> frequencies_;  ///< rad/s, of some motions of the constant matrices
  double share_ = 0;                 ///< last_share()
  const la::BlockPattern* pattern_ = nullptr;
  std::unique_ptr<la::BlockPattern> own_pattern_;
  std::vector<unsigned char> active_;
  double arm_;  ///< m, at which tilts and moments compare with displacements and forces
  la::MCK turned_, first_, raw_, hill_;
  double hill_speed_ = 0;        ///< of the axes, rad/s, in hill_
  std::vector<Index> changing_;  ///< of the pattern's blocks: of changes_; -1: it does not
  std::vector<Changes> changes_;
  std::unique_ptr<HarmonicBalance> balance_, odd_balance_;  ///< made when first wanted
  /// Of multiples(): made when first wanted.
  std::vector<Index> odd_;
  std::unique_ptr<la::BlockPattern> odd_pattern_;
  std::vector<unsigned char> odd_active_;
  la::MCK odd_hill_;
  std::unique_ptr<la::DirectSolver<double>> direct_, odd_direct_;  ///< made when first wanted
};

}  // namespace whirl::analysis
