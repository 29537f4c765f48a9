// Eigenvalues of the quadratic problem (lambda^2 M + lambda C + K) x = 0 of whirl, of K x = omega^2
// M x, and of A x = mu B x.
//
// Method: shift-invert Arnoldi on the linearisation z = (x, lambda x / alpha) in real arithmetic.
// The operator (A - sigma B)^-1 B needs only the N-sized factorisation Q(sigma) = sigma^2 M + sigma
// C + K:
//   p = -Q(sigma)^-1 (M (v + sigma x) + C x),   q = x + sigma p   for (x, v) -> (p, q),
//       eigenvalue 1/(lambda - sigma).
// Massless unknowns (singular M) only add eigenvalues at infinity, which this operator maps to
// zero. What Arnoldi finds is polished by Newton's method on the N-sized problem (F. Tisseur and K.
// Meerbergen, doi 10.1137/S0036144500381988; A. Neumaier, doi 10.1137/0722055) and deflated; a new
// Arnoldi run from a random vector in the complement then shows whether anything inside the wanted
// circle is missing, which also finds all copies of multiple eigenvalues. A neighbouring problem
// (the next speed of a Campbell diagram) starts from the known modes: polishing and the search for
// missing ones are all that is left.
#pragma once
#include <cmath>
#include <la/block.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace whirl::la {

struct Mode {
  Complex lambda;  ///< 1/s, Im lambda >= 0; the conjugate pair counts as one mode
  VecXc x;         ///< nodal amplitudes (u, phi, gamma), largest component 1; zero at held unknowns
  /// Backward error: largest entry of |Q x| over the largest of (|lambda|^2 |M| + |lambda| |C| +
  /// |K|) |x|, rows scaled by their diagonal entries so that forces and moments compare.
  double residual = 0.0;
  double uncertainty =
      0.0;  ///< 1/s: what rounding of the entries of M, C, K to working precision can do to lambda
  Index from = -1;  ///< which of the modes given as a start this one continues, -1: none
};

/// A motion counts as one that oscillates up to a damping ratio of 3/sqrt(10) = 0.949, of decay or of
/// growth: beyond it hardly a second swing can be seen, and the number of such decaying roots grows
/// with the mesh. They are listed with the roots on the real axis.
inline constexpr double oscillating_reach = 3.0;
inline bool oscillates(Complex lambda) {
  return lambda.imag() != 0.0 &&
         std::abs(lambda.real()) <= oscillating_reach * std::abs(lambda.imag());
}

/// Growth below this part of |lambda| is not told from none: so much the energy bound leaves open of
/// what lies above a list (growth_bound.hpp). What a list says may not depend on how far it goes: a
/// twist that nothing damps is driven by cross-coupled forces, through the sag, by 1e-10.
inline constexpr double unnoticed_growth = 1e-9;

struct ModeOptions {
  Index count = 12;  ///< modes wanted: the nearest to the shift (none given: of least |lambda|)
  /// Where to look. Complex: only modes near it are sought, in complex arithmetic. Not set: least
  /// |lambda|.
  std::optional<Complex> shift;
  /// rad/s. With count = 0: every mode with |lambda| <= max_frequency; otherwise drops modes
  /// beyond.
  double max_frequency = std::numeric_limits<double>::infinity();
  double tolerance = 1e-12;  ///< relative accuracy of lambda aimed at; what the condition of the
                             ///< problem allows is the limit
  Index dense_below = 36;    ///< active unknowns up to which a dense solver is used
  bool real_roots = true;    ///< return (and count) overdamped and rigid-body modes, Im lambda = 0
  Index guard = 2;  ///< modes kept beyond count, so that a neighbouring problem does not lose one
                    ///< at the border
  /// Count the roots by an independent method (root_count.hpp), look for those that are missing,
  /// and say what is known: Certificate. Only without a shift. `count` then counts modes that
  /// oscillate (as la::oscillates() says), in the order of their damped frequency |Im lambda|;
  /// real_roots adds every other root that the counted region holds.
  bool certify = false;
  bool growing = false;  ///< with certify: on to the last root of the region with Re lambda > 0,
                         ///< whatever its number
  /// Motions (a column each, of all unknowns) that may be free, as the model knows: spins, slides.
  /// Those of their span that K does not resist are zero roots, wherever slow ones beside them leave
  /// them to a search.
  MatX maybe_free;
};

/// What is known of a list of modes: that every root of the region { Re s >= 0, |s| <= radius } and
/// { -reach <= Re s < 0, |Im s| <= radius } is in it. counted: the argument principle gave a
/// number; missing: that number less the roots found (a conjugate pair counts as two).
struct Certificate {
  bool counted = false;
  Index missing = 0;
  double radius = 0.0;         ///< rad/s
  double reach = 0.0;          ///< 1/s
  std::vector<Complex> where;  ///< estimates of the missing roots, Im >= 0
  Index factorizations = 0;    ///< what it cost
  Index recovered = 0;         ///< roots the search had missed and the count led to
  /// Roots too close to zero to be told from it, beyond the free motions known: taken for zeros of
  /// free motions. 0: none.
  Index taken_for_zero = 0;
  double zeros_within = 0.0;  ///< 1/s: distance from zero of those
  bool complete() const { return counted && missing == 0; }
  /// Roots of frequency `radius` are in the region up to this damping ratio, slower ones further.
  double damping_ratio() const { return reach > 0.0 ? reach / std::hypot(reach, radius) : 0.0; }
};

/// Modes sorted by |Im lambda|, then |lambda|; overdamped roots are kept, each on its own; a
/// rigid-body motion (K x = 0, C x = 0) comes once, with lambda = 0.
/// @throws Error when the problem has no eigenvalues or cannot be factored.
std::vector<Mode> quadratic_modes(const MCK& m, std::span<const unsigned char> active,
                                  const ModeOptions& options = {});

/// The same for a series of neighbouring problems on one pattern; keeps factorisations, workspace
/// and guard modes.
class ModeSolver {
 public:
  /// @throws std::invalid_argument when there are not 6 flags a node.
  ModeSolver(const BlockPattern& pattern, std::span<const unsigned char> active,
             const ModeOptions& options = {});
  ~ModeSolver();
  ModeSolver(ModeSolver&&) noexcept;
  /// All modes wanted. From the second call on it starts from what the last call found (Mode::from
  /// counts in its result).
  /// @throws Error (E61) as quadratic_modes().
  const std::vector<Mode>& solve(const MCK& m);
  /// The same, with ModeOptions::certify, for a region that reaches at least to the radius (rad/s).
  const std::vector<Mode>& solve_to(const MCK& m, double radius);
  /// rad/s: size of the fastest root of the last problem, where it was solved whole (dense).
  std::optional<double> fastest_root() const;
  /// Forgets what is known, so that the next solve() starts from nothing.
  void reset();
  /// The next solve() starts from what the other one, of the same pattern and options, found last.
  void start_from(const ModeSolver& other);
  /// The next solve() starts from these, as from modes of a neighbouring problem.
  void start_from(std::span<const Mode> near);
  /// Newton's method from one mode; nullopt when it does not converge.
  std::optional<Mode> follow(const MCK& m, const Mode& start);

  /// Of the last solve(), with ModeOptions::certify.
  const Certificate& certificate() const;

  struct Work {
    Index factorizations = 0, operator_products = 0, searches = 0;
  };
  Work work() const;  ///< of the last call

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Eigenvalues mu of A x = mu B x nearest to the shift, sorted by |mu - shift|: buckling (A
/// stiffness, B minus the geometric stiffness per unit load). Complex pairs (Im mu > 0 listed) mean
/// flutter. Mode::lambda = mu.
/// @pre matrices on patterns of one size, 6 flags a node, count > 0.
/// @throws Error (E61) when the problem has no eigenvalues or cannot be factored.
std::vector<Mode> linear_modes(const BlockMatrix<6>& A, const BlockMatrix<6>& B,
                               std::span<const unsigned char> active, Index count,
                               double shift = 0.0);

}  // namespace whirl::la
