// Part of the quadratic eigensolver (eigen.hpp): the eigenpairs found so far, and what may join
// them.
#pragma once
#include <la/shifted_operator.hpp>

namespace whirl::la {

struct Eigenpairs : ShiftedOperator {
  using ShiftedOperator::ShiftedOperator;
  std::vector<Pair> known;
  double least_radius = 0.0;  ///< rad/s: all roots up to it are wanted, whatever their number

  Complex centre() const { return opt.shift.value_or(0.0); }
  double key(Complex lambda) const {
    return std::min(std::abs(lambda - centre()), std::abs(std::conj(lambda) - centre()));
  }
  bool counts(const Pair& p) const { return opt.real_roots || p.lambda.imag() != 0.0; }

  /// Makes candidates of a Ritz pair. In a real problem a double real root shows up as a complex
  /// pair a rounding error apart: two candidates then, of its real and imaginary parts.
  void suggest(std::vector<Pair>& found, Complex lambda, const VecXc& z, bool real_problem,
               std::vector<VecXc>* vectors) const;
  static constexpr double unproved = 1e-8;  ///< backward error of what is no root
  /// Adds a polished pair unless it is no root, or already there: its vector in the span of those
  /// with the same eigenvalue.
  bool add(Pair&& p);
  /// Those whose eigenvalues are no further off than that share of it, or than they are uncertain; free
  /// motions among them or not.
  std::vector<const Pair*> known_near(const Pair& p, double apart, bool free) const;
  /// Its vector lies in the span of theirs.
  bool spanned(const Pair& p, const std::vector<const Pair*>& by) const;
  /// Takes a root that rounding alone keeps off the real axis for what it is.
  void make_real(Pair& p);
  static constexpr double real_line = 1e-9;  ///< |Im| over |lambda|
  /// What stands beside the zero roots of the free motions: a second zero each where nothing damps
  /// the motion, else the rate at which it dies away (or grows), a root of its own that shares the
  /// vector but for a small twist and is easily taken for the first. Adds those of the second kind.
  void add_companions();
  /// Near zero x = P a moves, P the free motions, with lambda^2 a + lambda D a = 0, to first order in lambda.
  /// D is drag over mass by the left vectors of K's zero roots, which are not P where what a motion's
  /// rate displaces resists or drives it (the drag of films, whose journals shift with the speed).
  struct DecayOfFree {
    MatX D;
    MatX follows;  ///< x = P a + lambda (lambda/sigma - 1) follows a; empty: not known
  };
  DecayOfFree decay_of_free(const std::vector<std::size_t>& free);
  /// Slow real roots among the known ones whose vectors are free motions: companions that the
  /// search has told from zero.
  Index count_slow_companions(const std::vector<std::size_t>& free) const;
  /// Free motions whose second root is zero as well.
  Index double_zeros = 0;
  /// Slow roots have vectors of free motions. They may be companions that a search has told from zero,
  /// or motions of their own that drive free ones (an integrator's decay): the count tells.
  bool slow_beside_zeros = false;
  /// 1/s: what rounding of the stiffness can make of a double zero.
  double zero_rounding = 0.0;
  /// Nothing resists the motion, but for what rounding mixed into its vector (taken off then).
  bool is_free_motion(Pair& p);
  /// The rigid-body motions in the span of the candidates' real and imaginary parts and of those
  /// already known.
  bool add_rigid(const std::vector<Pair>& candidates);
  /// Polishes what a search has found (near) or what a neighbouring problem suggests, and adds it.
  /// What does not lead to anything new is left in `found`.
  bool take(std::vector<Pair>& found, bool near);
  void sort_known();
  /// Distance from the centre that must be free of unknown eigenvalues; infinity while too few are
  /// known.
  double wanted_radius() const;
  Index missing() const;
  /// Vectors of eigenvalues too close for one-by-one polishing, by the projected problem of each
  /// group.
  void separate_close();
};

}  // namespace whirl::la
