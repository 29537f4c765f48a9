// How many eigenvalues of Q(lambda) = lambda^2 M + lambda C + K a region holds, by the argument
// principle: an independent check that a list of modes is complete.
//
// det Q(s) is a polynomial with real coefficients; its argument grows by 2 pi along a closed curve
// for every root inside. With the roots that are known divided out,
//   f(s) = det Q(s) / prod_k (s - lambda_k),
// f turns only for roots that are not known, and where none of these is near the curve it is so
// smooth that some twenty factorisations settle the count. Every sample knows log f and its
// derivative; samples are put in until the change from one to the next is what the derivatives at
// both say, which no turn in between can hide from. By symmetry the upper half of the curve
// suffices. The moments of the unknown roots,
//   p_m = sum lambda^m = 1/(2 pi i) \oint s^m d log f
//       (L. M. Delves and J. N. Lyness, doi 10.1090/S0025-5718-1967-0228165-4),
// say where they are.
#pragma once
#include <la/block_lu.hpp>

namespace whirl::la {

/// { Re s >= 0, |s| <= radius } together with { -reach <= Re s < 0, |Im s| <= radius }: every root
/// of a frequency up to `radius` but those damped more than reach/sqrt(reach^2 + radius^2) of
/// critical, and everything that grows.
struct CountRegion {
  double radius = 0.0;  ///< rad/s, > 0
  double reach = 0.0;   ///< 1/s, > 0
  /// Of the radius: over which d log f/ds is taken. So near to zero that the stiffness hides the inertia
  /// by all but a few digits, rounding of f asks for more.
  double slope_step = 1e-5;
  bool contains(Complex s) const;
};

struct RootCount {
  bool certain = false;  ///< the samples settle the argument
  Index unknown = 0;  ///< roots inside that are not among the known ones; a conjugate pair is two
  Index factorizations = 0;
  Complex crossed = 0.0;  ///< where the curve did not settle: beside a root, or in a crowd of them
};

class RootCounter {
 public:
  RootCounter(const BlockPattern& pattern, std::span<const unsigned char> active);
  /// known: every root found so far, inside and outside; Im > 0 stands for the pair. Multiple roots
  /// come several times.
  /// @pre a region of finite size above zero.
  RootCount count(const MCK& m, const CountRegion& region, std::span<const Complex> known);
  /// After count(): estimates of the unknown roots, Im >= 0, from their moments; a few per cent of
  /// the radius off, more where there are many. Empty when the curve does not settle.
  std::vector<Complex> locate(Index unknown);
  /// Right after a count() that is certain, by its samples: where many unknown roots crowd on the
  /// negative real axis, by their mean and spread: the rate, 1/s > 0, that (next to) none of them is
  /// below; infinite where they do not.
  double crowd_rate(Index unknown) const;

 private:
  struct Sample {
    double t;
    Complex s;
    Complex log_f;  ///< imaginary part modulo 2 pi until it joins the chain
    Complex slope;  ///< d log f / ds
  };
  /// log f at s; NaN where Q(s) is singular.
  Complex log_f(Complex s);
  /// Sample at the parameter t in [0, 3] of the upper half of the curve. False: Q(s) is singular
  /// there.
  bool sample(double t, Sample& out);
  /// Samples along the whole curve. surprise: change of log f between neighbours that their slopes
  /// may leave unexplained.
  bool follow_curve(double surprise);
  /// Appends the samples between a (the last of the chain) and b, and b, once the change of log f
  /// between neighbours is settled.
  bool settle(const Sample& a, const Sample& b, int depth);
  Complex point(double t) const;
  /// ds/dt at t on the piece of the curve (arc, line or end) on which `within` lies.
  Complex direction(double t, double within) const;
  /// Adds the part of the moments that the curve between two samples gives, in units of the radius.
  void add_moments(const Sample& a, const Sample& b, std::vector<double>& moments) const;

  BlockLu<Complex> lu_;
  const MCK* m_ = nullptr;
  CountRegion region_;
  std::vector<Complex> known_;
  std::vector<Sample> samples_;
  double surprise_ = 0.0;
  Complex unsettled_ = 0.0;  ///< where the last curve stopped
  Index factorizations_ = 0;
};

}  // namespace whirl::la
