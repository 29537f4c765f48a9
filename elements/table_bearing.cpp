#include <elements/table_bearing.hpp>

#include <core/error.hpp>
#include <elements/coefficient_grid.hpp>
#include <elements/monotone_slopes.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

CoefficientTable::CoefficientTable(std::vector<double> spin, std::vector<Values> rows, Between between, Outside outside)
    : spin_(std::move(spin)), between_(between), outside_(outside) {
  const auto fail = [](const char* what) { throw run_error("E81", std::string("bearing table: ") + what); };
  if (spin_.empty()) fail("it has no rows");
  if (rows.size() != spin_.size()) fail("speeds and coefficients differ in number");
  for (std::size_t i = 1; i < spin_.size(); ++i)
    if (!(spin_[i] > spin_[i - 1])) fail("speeds must increase from row to row");
  for (const Values& v : rows) {
    Row r;
    const Mat2* m[] = {&v.K, &v.C, &v.M};
    for (int k = 0; k < 3; ++k) r.segment<4>(4 * k) << (*m[k])(0, 0), (*m[k])(0, 1), (*m[k])(1, 0), (*m[k])(1, 1);
    if (!r.isFinite().all()) fail("a coefficient is not finite");
    has_mass_ = has_mass_ || (r.tail<4>() != 0.0).any();
    value_.push_back(r);
  }
  if (between_ == Between::monotone_cubic) slope_ = monotone_slopes(spin_, value_);
  else slope_.assign(spin_.size(), Row::Zero());
}

void CoefficientTable::at(double s, Values& v, Values& dv) const {
  Row x = Row::Zero(), dx = Row::Zero();
  if (!covers(s)) x.setConstant(nan), dx.setConstant(nan);
  else if (s <= spin_.front() || spin_.size() == 1) x = value_.front();
  else if (s >= spin_.back()) x = value_.back();
  if (s >= spin_.front() && s <= spin_.back() && spin_.size() > 1) {
    const auto upper = std::upper_bound(spin_.begin(), spin_.end(), s);
    const std::size_t i = std::min(static_cast<std::size_t>(upper - spin_.begin()), spin_.size() - 1) - 1;
    const double h = spin_[i + 1] - spin_[i], u = (s - spin_[i]) / h;
    const Row chord = (value_[i + 1] - value_[i]) / h;
    if (between_ == Between::linear) {
      x = value_[i] + (s - spin_[i]) * chord, dx = chord;
    } else {
      const Row a = h * (slope_[i] - chord), b = h * (slope_[i + 1] - chord);
      x = value_[i] + u * h * chord + u * (1 - u) * ((1 - u) * a - u * b);
      dx = chord + ((1 - u) * (1 - 3 * u) * a - u * (2 - 3 * u) * b) / h;
    }
  }
  Mat2* out[] = {&v.K, &v.C, &v.M, &dv.K, &dv.C, &dv.M};
  for (int k = 0; k < 6; ++k) {
    const Row& r = k < 3 ? x : dx;
    const int o = 4 * (k % 3);
    *out[k] << r[o], r[o + 1], r[o + 2], r[o + 3];
  }
}

template <bool Mass, class Table>
void TableBearingLaw<Mass, Table>::force(const LateralMotion& m, Vector<4>& z) const {
  CoefficientValues v, dv;
  table->at(m.spin, v, dv);
  Vec2 F = -(v.K * m.r + v.C * m.v);
  if constexpr (Mass) F -= v.M * m.a;
  z << F, 0.0, 0.0;
}

template <bool Mass, class Table>
void TableBearingLaw<Mass, Table>::tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const {
  CoefficientValues v, dv;
  table->at(m.spin, v, dv);
  Vec2 F = -(v.K * m.r + v.C * m.v), F_s = -(dv.K * m.r + dv.C * m.v);
  t.set_zero();
  t.r.topRows<2>() = -v.K, t.v.topRows<2>() = -v.C;
  if constexpr (Mass) {
    F -= v.M * m.a, F_s -= dv.M * m.a;
    t.a.topRows<2>() = -v.M;
  }
  t.spin.head<2>() = F_s;
  z << F, 0.0, 0.0;
}

template <bool Mass, class Table>
void TableBearingLaw<Mass, Table>::energy(const LateralMotion& m, system::Energy& e) const {
  CoefficientValues v, dv;
  table->at(m.spin, v, dv);
  e.elastic += 0.5 * m.r.dot(v.K * m.r);
  e.dissipated += m.v.dot(v.C * m.v);
  const double skew_K = 0.5 * (v.K(0, 1) - v.K(1, 0));
  e.supplied += 0.5 * m.spin_rate * m.r.dot(dv.K * m.r) - skew_K * (m.v.x() * m.r.y() - m.v.y() * m.r.x());
  if constexpr (Mass) {
    const double skew_M = 0.5 * (v.M(0, 1) - v.M(1, 0));
    e.kinetic += 0.5 * m.v.dot(v.M * m.v);
    e.supplied += 0.5 * m.spin_rate * m.v.dot(dv.M * m.v) - skew_M * (m.v.x() * m.a.y() - m.v.y() * m.a.x());
  }
}

template struct TableBearingLaw<false, CoefficientTable>;
template struct TableBearingLaw<true, CoefficientTable>;
template struct TableBearingLaw<false, CoefficientGrid>;
template struct TableBearingLaw<true, CoefficientGrid>;

}  // namespace whirl::elements
