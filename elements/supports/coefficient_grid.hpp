// Coefficients (2x2 lateral, or 6x6) tabulated against spin s and the frequency w of the motion, on
// a grid: K(s, w), C(s, w), M(s, w) of
//   F = -K r - C v - M a   for motions r exp(i w t),
// as computed for tilting pads, gas seals and other supports with internal motion of their own.
//
// What w is: the frequency an analysis of small motions asks about (Context::frequency); where none
// asks - statics, transients - the frequency of the spin itself, w = |s| (synchronous
// reduction), held at the first and last frequency of the table.
//
// Interpolation: bilinear, or bicubic with monotone cubics along both families of grid lines and
// mixed derivatives from three-point differences of their slopes (monotone on the grid lines; F. N.
// Fritsch & R. E. Carlson, doi 10.1137/0717021). Error against a smooth function of spacing h: h^2
// f''/8 linear, of third order cubic. Outside: held at the edge, or not defined (NaN).
#pragma once
#include <elements/supports/table_bearing.hpp>

namespace whirl::elements {

template <int N>
class CoefficientGrid {
 public:
  static constexpr int size = N;
  using Values = CoefficientValues<N>;
  using Between = typename CoefficientTable<N>::Between;
  using Outside = typename CoefficientTable<N>::Outside;
  /// spin, frequency: rad/s, strictly increasing, frequency not negative; rows: spin by spin,
  /// frequencies within.
  /// @throws Error E81: no rows, lengths that differ, not increasing, a value not finite.
  CoefficientGrid(std::vector<double> spin, std::vector<double> frequency,
                  const std::vector<Values>& rows, Between between, Outside outside);
  /// Values for the spin s at the frequency asked about (NaN: none, synchronous), and their
  /// derivatives in s.
  void at(double s, double asked, Values& v, Values& dv) const;
  /// Values at (s, w) with derivatives in s and w; NaN outside an undefined range.
  void at(double s, double w, Values& v, Values& ds, Values& dw) const;
  bool has_mass() const { return has_mass_; }
  bool follows_frequency() const { return frequency_.size() > 1 || outside_ == Outside::undefined; }
  bool follows_spin() const {
    return spin_.size() > 1 || frequency_.size() > 1 || outside_ == Outside::undefined;
  }
  /// There is stiffness, or damping, against a motion of this number.
  /// @pre 0 <= motion < N (also of damps).
  bool resists(int motion) const;
  bool damps(int motion) const;

 private:
  using Row = typename Values::Row;
  struct Node {
    Row f, f_s, f_w, f_sw;
  };
  const Node& node(std::size_t i, std::size_t j) const { return nodes_[i * frequency_.size() + j]; }

  std::vector<double> spin_, frequency_;
  std::vector<Node> nodes_;
  Between between_;
  Outside outside_;
  bool has_mass_ = false;
};

extern template class CoefficientGrid<2>;
extern template class CoefficientGrid<6>;

}  // namespace whirl::elements
