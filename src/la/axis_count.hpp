// How many growing roots a problem has whose matrices are known on the imaginary axis alone, by
// Nyquist's criterion: Q(i w) = -w^2 M(w) + i w C(w) + K(w), w >= 0, and its conjugate at -w, as
// tables of supports against the frequency of the motion give it.
//
// Beyond w = top the matrices stay as they are, so that Q is there Q0(s) = s^2 M0 + s C0 + K0, whose
// growing roots, N0 of them, are found and counted as those of any such problem (root_count.hpp).
//   g(s) = det Q(s)/det Q0(s)
// is real on the real axis and 1 on the imaginary one beyond top. In the right half plane Q is what
// continues it from the axis. Where the supports' own motions decay it has no poles there, and like
// every force of a motion faster and faster it goes to what it is at the top: g goes to 1. Twice the
// number of roots of det Q less that of det Q0 is then the number of turns of g along the axis, run
// through downward; by symmetry
//   N = N0 - (1/pi) (change of arg g from the real axis up to i top).
// Roots at zero and near it (free motions) stay outside: the path begins at s = rho and takes a
// quarter of a circle to i rho, with the matrices of zero frequency.
//
// With the roots known of both problems divided out, arg g hardly turns, and the samples are placed
// as those of root_count.hpp: until slopes at both ends explain each change. The slopes are
// one-sided, for tables may bend at their rows, which are stations.
//
// Certified is the number of growing roots, as far as the tables say what the supports do; not that
// a list of decaying ones is complete: away from the axis Q is not known.
#pragma once
#include <functional>
#include <la/block_lu.hpp>

namespace whirl::la {

/// What the count stands on.
struct AxisProblem {
  /// Q at w, rad/s, valid until the next call; from `top` on the same.
  std::function<const MCK&(double w)> at;
  const MCK* held = nullptr;     ///< Q0
  double rho = 0, top = 0;       ///< rad/s, 0 < rho < top
  std::vector<double> stations;  ///< rad/s, ascending: where the matrices may bend
  /// Roots found of either problem, Im >= 0 standing for the pair; those on the axis within
  /// rounding with Re <= 0, for they do not grow.
  std::vector<Complex> known, known_held;
};

struct AxisCount {
  bool certain = false;  ///< the samples settle the argument
  Index unknown = 0;     ///< growing roots with |s| > rho beyond those in AxisProblem::known
                         ///< (negative: fewer), if known_held misses none; a pair is two
  Index factorizations = 0;
};

class AxisCounter {
 public:
  AxisCounter(const BlockPattern& pattern, std::span<const unsigned char> active);
  /// @pre 0 < rho < top, stations ascending, matrices given.
  AxisCount count(const AxisProblem& problem);

 private:
  /// s at t: on the arc for t < rho, i t beyond.
  Complex point(double t) const;
  /// log g with the known roots divided out; false: a matrix is singular there.
  bool log_g(double t, Complex& out);

  BlockLu<Complex> lu_;
  const AxisProblem* problem_ = nullptr;
  Index factorizations_ = 0;
};

}  // namespace whirl::la
