// Galerkin's harmonic balance of motions in sines and cosines of multiples of an angle, whose matrices change
// with that angle themselves. Of node i the parts stand one after the other, node parts i + a: the constant
// one, if there is one, then cosine and sine of every multiple.
#pragma once
#include <la/block.hpp>

#include <vector>

namespace whirl::analysis {

/// Parts of these multiples of the angle, ascending; 0: the constant part.
Index count_parts(const std::vector<Index>& orders);

/// 1, where 0 is among the multiples, and cosine and sine of each at this angle.
VecX waves_at(const std::vector<Index>& orders, double theta);

/// The balance of parts a in which motions of parts b meet what changes as a cosine or sine h of the angle:
/// means of products of three of them, exact.
class HarmonicBalance {
 public:
  /// step: what changes has multiples of this multiple of the angle.
  HarmonicBalance(const std::vector<Index>& orders, Index step);

  Index parts() const { return parts_; }
  /// Of what changes: 0 is its mean.
  Index waves() const { return static_cast<Index>(waves_.size()); }

  /// Of what is sampled at one of so many equal angles: its share of every wave.
  void weigh(double theta, Index points, VecX& out) const;

  /// What joins node j to node i as wave h, where the angle grows at W, rad/s.
  /// @pre out stands on a pattern in which the parts of j follow one another.
  void add(Index h, Index i, Index j, double W, const Matrix<6>& M, const Matrix<6>& C,
           const Matrix<6>& K, la::MCK& out) const;

 private:
  struct Wave {
    Index order = 0;
    bool sine = false;
  };
  struct Term {
    Index a = 0, b = 0;
    double value = 0, rate = 0, acceleration = 0;  ///< at 1 rad/s
  };
  static double mean(const Wave& a, const Wave& b, const Wave& h);
  void add_term(const Wave& of_a, Index a, const Wave& of_b, Index b, std::size_t h);

  Index parts_;
  std::vector<Wave> waves_;
  std::vector<std::vector<Term>> terms_;  ///< [wave]
};

}  // namespace whirl::analysis
