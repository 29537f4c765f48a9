// What energy forbids: a frequency above which nothing can grow, whatever modes there are.
//
// For a root lambda = a + i w, a > 0, of lambda^2 M + lambda C + K with symmetric M >= 0, x^H M x =
// m, x^H C x = c + i g, x^H K x = k + i n (c of the symmetric, g of the skew part of C; k and n
// likewise of K), the real and the imaginary part of x^H Q x = 0 give, with g eliminated,
//   (a m + c) |lambda|^2 + a k + n w = 0.
// So a motion grows only if circulatory forces put more into a cycle than damping takes out: c W +
// n < 0 at W = |lambda|^2/w, or if the stiffness is negative. When at some W1
//   (1) K_s + W1^2 M > 0,
//   (2) C_s + eta (W1 M + K_s/W1) > 0,
//   (3) W1 C_s - i K_a + eta (W1^2 M + K_s) > 0
//       (K_s, K_a: symmetric and skew part; -i K_a is Hermitian, x^H (-i K_a) x = n)
// then no root with |lambda| >= W1 has a > eta |lambda|^2/W1. Each is settled by the inertia of one
// block factorisation. eta is above zero because rounding is, and because rotors carry circulatory
// moments that nothing damps at their place (a torque on a tilted section): they are small, and so
// is the growth they can cause.
#pragma once
#include <la/block_lu.hpp>
#include <la/eigen.hpp>

#include <optional>
#include <span>

namespace whirl::analysis {

class GrowthBound {
 public:
  /// Nothing with |lambda| >= above (rad/s) grows faster than ratio |lambda|^2/above.
  struct Quiet {
    double above;
    double ratio;
  };

  GrowthBound(const la::BlockPattern& pattern, std::span<const unsigned char> active);
  /// The least of w, 2 w, 4 w, .. up to w_max (rad/s) at which the three hold with a ratio of at
  /// most 1e-5; nullopt: at none of them.
  std::optional<Quiet> first(const la::MCK& m, double w, double w_max);
  /// Of the conservative part of the matrices last given to first(); nullopt: not counted.
  std::optional<Index> modes_below(double w);

 private:
  void split(const la::MCK& m);
  bool positive_stiffness(double w);
  bool positive_damping(double w, double eta);
  bool damping_beats_circulation(double w, double eta);

  la::BlockLu<double> real_;
  la::BlockLu<Complex> complex_;
  la::MCK parts_;  ///< M, C_s, K_s
  la::MCK work_;
  bool symmetric_mass_ = false;
};

}  // namespace whirl::analysis
