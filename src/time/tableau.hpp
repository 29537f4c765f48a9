// Collocation methods with s <= 3 stages as data: Radau IIA (order 2s-1) and Gauss (order 2s), with
// everything the second-order stepper needs, correct to the last digit of a double.
#pragma once
#include <core/types.hpp>
#include <array>

namespace whirl::time {

/// All matrices s x s, row = stage; vectors of length s; unused entries zero.
struct Tableau {
  static constexpr int max_stages = 3;
  using Vec = std::array<double, max_stages>;
  using Mat = std::array<Vec, max_stages>;
  using VecC = std::array<Complex, max_stages>;

  int stages = 0;
  int order = 0;                  ///< of q at the step's end
  bool stiffly_accurate = false;  ///< c_s = 1: the last stage is the step's end
  Vec c{};                        ///< nodes in (0, 1]
  Mat A{};                        ///< a_ij
  Vec b{};                        ///< weights
  Mat Ainv{}, Ainv2{};            ///< A^-1, A^-2

  /// A^-1 = lambda_r x_r w_r^T + 2 Re(lambda_c x_c w_c^T), w_k^T x_l = delta_kl. Two stages: no
  /// real part.
  bool has_real = false;
  double lambda_r = 0.0;
  Vec x_r{}, w_r{};
  Complex lambda_c{};
  VecC x_c{}, w_c{};

  /// mu of the error filter (mu/h)^2 M + (mu/h) C + K: lambda_r, or |lambda_c| where there is no
  /// real eigenvalue.
  double mu = 0.0;
  Vec at_zero{}, at_one{};  ///< Lagrange polynomials l_j(0), l_j(1) on the nodes

  /// Lagrange polynomials of the nodes at theta, their integral and double integral from 0.
  struct Basis {
    Vec l{}, l1{}, l2{};
  };
  Basis basis(double theta) const;
  /// Second increments of an extrapolated step: with accelerations A_j of a step of length h, the
  /// step of length r h that starts at theta0 of it has Y_i = (r h)^2 sum_j E_ij A_j, Y_i =
  /// q(theta0 + c_i r) - q(theta0) - c_i r h v(theta0).
  Mat extrapolation(double theta0, double r) const;

  /// Coefficients of the l_j in powers of theta: l_j = sum_k poly[j][k] theta^k.
  Mat poly{};
};

/// Radau IIA with 3 stages, order 5.
const Tableau& radau5();
/// Gauss with 2 and 3 stages, orders 4 and 6.
const Tableau& gauss4();
const Tableau& gauss6();

}  // namespace whirl::time
