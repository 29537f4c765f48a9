// Part of the quadratic eigensolver (eigen.hpp): the eigenpairs found so far, and what may join them.
#pragma once
#include <la/shifted_operator.hpp>

namespace whirl::la {

struct Eigenpairs : ShiftedOperator {
  using ShiftedOperator::ShiftedOperator;
  std::vector<Pair> known;

  Complex centre() const { return opt.shift.value_or(0.0); }
  double key(Complex lambda) const {
    return std::min(std::abs(lambda - centre()), std::abs(std::conj(lambda) - centre()));
  }
  bool counts(const Pair& p) const { return opt.real_roots || p.lambda.imag() != 0.0; }

  /// Makes candidates of a Ritz pair. In a real problem a double real root shows up as a complex pair a rounding error apart: two
  /// candidates then, of its real and imaginary parts.
  void suggest(std::vector<Pair>& found, Complex lambda, const VecXc& z, bool real_problem, std::vector<VecXc>* vectors) const;
  /// Adds a polished pair unless it is already there: its vector in the span of those with the same eigenvalue.
  bool add(Pair&& p);
  /// The rigid-body motions in the span of the candidates' real and imaginary parts and of those already known.
  bool add_rigid(const std::vector<Pair>& candidates);
  /// Polishes what a search has found (near) or what a neighbouring problem suggests, and adds it. What does not lead to anything new is left in
  /// `found`.
  bool take(std::vector<Pair>& found, bool near);
  void sort_known();
  /// Distance from the centre that must be free of unknown eigenvalues; infinity while too few are known.
  double wanted_radius() const;
  Index missing() const;
  /// Vectors of eigenvalues too close for one-by-one polishing, by the projected problem of each group.
  void separate_close();
};

}  // namespace whirl::la
