// A scalar force-deflection curve F(x) as polynomial pieces, with its slope and its energy: what
// nonlinear springs share. x in m, F in N and the energy in J, or rad, N m and J; F is the force
// that resists x (the load on the shaft is -F). Piecewise smooth and conservative, defined for
// every x; F need not vanish at 0. Monotone cubics: F. N. Fritsch & R. E. Carlson, doi
// 10.1137/0717021.
#pragma once
#include <array>
#include <memory>
#include <vector>

namespace whirl::elements {

class ForceCurve {
 public:
  struct Value {
    double F, slope, energy;
  };  ///< F(x), dF/dx, integral of F from 0 to x
  Value at(double x) const;
  double operator()(double x) const { return at(x).F; }
  /// Number of corners below x: places where the slope changes by more than half of the larger one,
  /// as where a gap closes.
  int region(double x) const;
  bool cornered() const { return !corners_.empty(); }

  /// F = sum c_k x^k, at most degree 7.
  /// @throws Error E82: more than 8 coefficients, a coefficient not finite.
  static ForceCurve polynomial(const std::vector<double>& c);
  /// Through (x_i, F_i), x strictly increasing: straight lines, or monotone cubics with the slopes
  /// of time laws and bearing tables (pchip_slopes); outside straight on with the end slope.
  /// @throws Error E82: fewer than 2 points, x not increasing.
  static ForceCurve table(const std::vector<double>& x, const std::vector<double>& F,
                          bool monotone_cubic);
  /// Play: no force in [-gap_minus, gap_plus], stiffness k outside, turned on over a length
  /// `smooth` by a parabola (0: a corner).
  /// @throws Error E82: negative gap, stiffness or smooth.
  static ForceCurve clearance(double gap_minus, double gap_plus, double k, double smooth = 0.0);
  /// One-sided: k (x - gap) for x > gap, nothing before; gap may be negative (preloaded).
  /// @throws Error (E82) for a negative stiffness or smoothing length.
  static ForceCurve one_sided(double gap, double k, double smooth = 0.0);

 private:
  struct Piece {
    double x0;                  ///< local origin
    std::array<double, 8> c{};  ///< F = sum c_k (x - x0)^k
    double V0 = 0;              ///< energy at x0
  };
  void integrate();  ///< fixes V0 so that the energy is continuous and zero at x = 0; finds the
                     ///< corners
  const Piece& piece(double x) const;
  std::vector<double> breaks_;  ///< piece k holds for breaks_[k-1] <= x < breaks_[k]
  std::vector<Piece> pieces_;
  std::vector<double> corners_;
};

using ForceCurvePtr = std::shared_ptr<const ForceCurve>;

}  // namespace whirl::elements
