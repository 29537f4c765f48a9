// How many roots det Q(s; Im s) has in a band of frequency, where the matrices of
// Q(s; w) = s^2 M + s C + K depend on the frequency w = Im s of the motion itself.
//
// D(s) = det Q(s; Im s) is a continuous function of the upper half plane, though not an analytic one,
// and its argument turns along a closed curve once for every root inside, forward or backward by the
// sign of its Jacobian there (the degree of D). On a branch s_k(w) of eigenvalues with w held that
// sign is the one of 1 - d Im s_k/dw: +1 where the branch falls through the line Im s = w, -1 where
// it rises through it. The curve encloses the wedge
//   { low <= Im s <= top, |Re s| <= reach Im s }:
// every root of a frequency in the band whose damping ratio (of decay or growth) is below
// reach/sqrt(1 + reach^2). Roots that are known are divided out, so that what is left turns for those
// alone that are not; samples are placed by LogChange.
//
// Certified is the number of falling roots less that of rising ones.
#pragma once
#include <functional>
#include <la/block_lu.hpp>

namespace whirl::la {

struct WedgeProblem {
  /// Matrices at s, valid until the next call. The wedge is closed: s comes with low <= Im s <= top.
  std::function<const MCK&(Complex s)> at;
  double low = 0, top = 0;       ///< rad/s, 0 < low < top
  double reach = 0;              ///< > 0
  std::vector<double> stations;  ///< rad/s, ascending: where the matrices may bend
  std::vector<Complex> known;    ///< roots found, falling ones, in the wedge and outside, Im > 0
  std::vector<Complex> rising;   ///< roots found that rise
};

struct WedgeCount {
  bool certain = false;  ///< the samples settle the argument
  Index unknown = 0;     ///< falling roots less rising ones, beyond those known
  Index factorizations = 0;
};

class WedgeCounter {
 public:
  WedgeCounter(const BlockPattern& pattern, std::span<const unsigned char> active);
  /// @pre 0 < low < top, reach > 0, stations ascending, matrices given.
  WedgeCount count(const WedgeProblem& problem);

 private:
  BlockLu<Complex> lu_;
};

}  // namespace whirl::la
