// Bearing or seal with lateral coefficients tabulated against spin:
//   F = -K(s) r - C(s) v - M(s) a,  F on the journal, (r, v, a) relative to the housing, (y, z), s the journal's spin.
// The tangents contain dK/ds, dC/ds and dM/ds: a run-up with free spin sees them. A table gives no torque on the shaft, so what
// its cross coupling (skew K) feeds into whirl counts as supplied power; symmetric K and M store energy, symmetric C dissipates.
//
// Interpolation: linear, or monotone cubic (Fritsch & Carlson, SIAM J. Numer. Anal. 17, 1980, doi 10.1137/0717021) per
// coefficient. Outside the table: held at its ends, or not defined (NaN: the step is rejected and the run says so).
#pragma once
#include <elements/lateral_joint.hpp>
#include <memory>
#include <vector>

namespace whirl::elements {

/// 2x2 coefficient matrices, rows (force) and columns (motion) y, z; N/m, N s/m, kg.
struct CoefficientValues { Mat2 K, C, M; };

/// Coefficients against spin.
class CoefficientTable {
 public:
  using Values = CoefficientValues;
  enum class Between { linear, monotone_cubic };
  enum class Outside { undefined, hold };
  /// spin: rad/s, strictly increasing. Errors (E81): no rows, lengths that differ, spin not increasing, a value not finite.
  CoefficientTable(std::vector<double> spin, std::vector<Values> rows, Between between, Outside outside);
  /// Values at spin s with their derivatives in s; NaN outside an undefined range.
  void at(double s, Values& v, Values& dv) const;
  bool covers(double s) const { return outside_ == Outside::hold || (s >= spin_.front() && s <= spin_.back()); }
  double first() const { return spin_.front(); }
  double last() const { return spin_.back(); }
  bool has_mass() const { return has_mass_; }

 private:
  using Row = Eigen::Array<double, 12, 1>;
  std::vector<double> spin_;
  std::vector<Row> value_, slope_;
  Between between_;
  Outside outside_;
  bool has_mass_ = false;
};

class CoefficientGrid;   // coefficient_grid.hpp: against spin and frequency

/// Mass: the table has M columns that are not all zero. Table: CoefficientTable, CoefficientGrid.
template <bool Mass, class Table = CoefficientTable>
struct TableBearingLaw {
  static constexpr bool inertia = Mass;
  std::shared_ptr<const Table> table;

  void force(const LateralMotion& m, Vector<4>& z) const;
  void tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const;
  void energy(const LateralMotion& m, system::Energy& e) const;
};

extern template struct TableBearingLaw<false, CoefficientTable>;
extern template struct TableBearingLaw<true, CoefficientTable>;
extern template struct TableBearingLaw<false, CoefficientGrid>;
extern template struct TableBearingLaw<true, CoefficientGrid>;

}  // namespace whirl::elements
