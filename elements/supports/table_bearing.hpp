// Bearing or seal with coefficients tabulated against spin. The usual case are the lateral ones
// (TableBearingLaw):
//   F = -K(s) r - C(s) v - M(s) a,
//       F on the journal, (r, v, a) relative to the housing, (y, z), s the journal's spin;
// 6x6 matrices, a set point or a preload take SpatialTableBearing.
// The tangents contain dK/ds, dC/ds and dM/ds: a run-up with free spin sees them. A table gives no
// torque on the shaft, so what its cross coupling (skew K) feeds into whirl counts as supplied
// power; symmetric K and M store energy, symmetric C dissipates.
//
// Interpolation: linear, or monotone cubic (Fritsch & Carlson, SIAM J. Numer. Anal. 17, 1980, doi
// 10.1137/0717021) per coefficient. Outside the table: held at its ends, or not defined (NaN: the
// step is rejected and the run says so).
#pragma once
#include <elements/supports/lateral_joint.hpp>
#include <elements/supports/six_motion.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace whirl::elements {

/// Coefficient matrices, rows (force) and columns (motion); N/m, N s/m, kg, and N m/rad, .. where a
/// rotation takes part. N = 2: y, z. N = 6: x, y, z, rx, ry, rz.
template <int N>
struct CoefficientValues {
  static constexpr int entries = N * N;
  using Row = Eigen::Array<double, 3 * entries, 1>;  ///< K, C, M one after another
  Matrix<N> K, C, M;
  Row row() const;
  void set(const Row& r);
  /// Column of K and of C in a row.
  static auto stiffness(const Row& r, int motion) { return r.template segment<N>(N * motion); }
  static auto damping(const Row& r, int motion) {
    return r.template segment<N>(entries + N * motion);
  }
};

/// Coefficients against spin.
template <int N>
class CoefficientTable {
 public:
  static constexpr int size = N;
  using Values = CoefficientValues<N>;
  enum class Between { linear, monotone_cubic };
  enum class Outside { undefined, hold };
  /// spin: rad/s, strictly increasing.
  /// @throws Error E81: no rows, lengths that differ, spin not increasing, a value not finite.
  CoefficientTable(std::vector<double> spin, std::vector<Values> rows, Between between,
                   Outside outside);
  /// Values at spin s with their derivatives in s; NaN outside an undefined range.
  void at(double s, Values& v, Values& dv) const;
  /// The same whatever frequency is asked about.
  void at(double s, double /*asked*/, Values& v, Values& dv) const { at(s, v, dv); }
  /// A speed beyond the end by rounding (rpm to rad/s and back, a variation about the end) is that
  /// of the end.
  bool covers(double s) const {
    return outside_ == Outside::hold ||
           (s >= spin_.front() - slack() && s <= spin_.back() + slack());
  }
  double first() const { return spin_.front(); }
  double last() const { return spin_.back(); }
  bool has_mass() const { return has_mass_; }
  bool follows_spin() const { return spin_.size() > 1 || outside_ == Outside::undefined; }
  static constexpr bool follows_frequency() { return false; }
  /// There is stiffness, or damping, against a motion of this number.
  /// @pre 0 <= motion < N (also of damps).
  bool resists(int motion) const;
  bool damps(int motion) const;

 private:
  using Row = typename Values::Row;
  double slack() const { return 1e-9 * std::max(std::abs(spin_.front()), std::abs(spin_.back())); }
  std::vector<double> spin_;
  std::vector<Row> value_, slope_;
  Between between_;
  Outside outside_;
  bool has_mass_ = false;
};

template <int N>
class CoefficientGrid;  // coefficient_grid.hpp: against spin and frequency

/// Mass: the table has M columns that are not all zero. Table: CoefficientTable, CoefficientGrid.
template <bool Mass, class Table = CoefficientTable<2>>
struct TableBearingLaw {
  static constexpr bool inertia = Mass;
  system::Dependence depends(const system::Context&) const {
    return {.spin = table->follows_spin(), .frequency = table->follows_frequency()};
  }
  std::shared_ptr<const Table> table;

  void force(const LateralMotion& m, Vector<4>& z) const;
  void tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const;
  void energy(const LateralMotion& m, system::Energy& e) const;
};

/// The same for all six motions of the journal against its housing, with set point and preload: the
/// linear bearing (linear_bearing.hpp) with coefficients that follow the spin s of node 0,
///   force on node 0 = preload - K(s) (q - setpoint) - C(s) q' - M(s) q''.
/// Stiffness that changes with s does work on what is deflected; the shaft's spin gets no torque
/// for it, so it counts as supplied.
template <bool Mass, class Table>
struct SpatialTableBearing {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr bool has_M = Mass, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  /// Sees the twist where it resists one.
  system::Dependence depends(const system::Context&) const {
    return {.angle = table->resists(3) ? system::twist_angle : system::no_angle,
            .spin = table->follows_spin() || table->damps(3),
            .frequency = table->follows_frequency()};
  }

  std::shared_ptr<const Table> table;
  SixMotion between;
  Vector<6> setpoint = Vector<6>::Zero(), preload = Vector<6>::Zero();

  void add_force(const system::Nodes<2>& x, const system::Context& c, system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& c,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const;
  /// Force and moment on node 0's point, N, N m.
  Vector<6> load_on_first(const system::Nodes<2>& x, const system::Context& c) const;
};

extern template struct CoefficientValues<2>;
extern template struct CoefficientValues<6>;
extern template class CoefficientTable<2>;
extern template class CoefficientTable<6>;
extern template struct TableBearingLaw<false, CoefficientTable<2>>;
extern template struct TableBearingLaw<true, CoefficientTable<2>>;
extern template struct TableBearingLaw<false, CoefficientGrid<2>>;
extern template struct TableBearingLaw<true, CoefficientGrid<2>>;
extern template struct SpatialTableBearing<false, CoefficientTable<6>>;
extern template struct SpatialTableBearing<true, CoefficientTable<6>>;
extern template struct SpatialTableBearing<false, CoefficientGrid<6>>;
extern template struct SpatialTableBearing<true, CoefficientGrid<6>>;

}  // namespace whirl::elements
