#include <elements/table_bearing.hpp>

#include <core/error.hpp>

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
  const std::size_t n = spin_.size();
  slope_.assign(n, Row::Zero());
  if (between_ == Between::linear || n < 2) return;
  // Fritsch-Carlson: weighted harmonic mean of the chords inside, three-point one-sided slopes at the ends, limited.
  const auto chord = [&](std::size_t i) { return Row((value_[i + 1] - value_[i]) / (spin_[i + 1] - spin_[i])); };
  if (n == 2) {
    slope_[0] = slope_[1] = chord(0);
    return;
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = spin_[i] - spin_[i - 1], h1 = spin_[i + 1] - spin_[i], w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
    const Row d0 = chord(i - 1), d1 = chord(i);
    for (int k = 0; k < 12; ++k) slope_[i][k] = d0[k] * d1[k] > 0 ? (w0 + w1) / (w0 / d0[k] + w1 / d1[k]) : 0.0;
  }
  const auto end = [&](double h0, double h1, const Row& d0, const Row& d1) {
    Row s = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    for (int k = 0; k < 12; ++k) {
      if (s[k] * d0[k] <= 0) s[k] = 0;
      else if (d0[k] * d1[k] < 0 && std::abs(s[k]) > 3 * std::abs(d0[k])) s[k] = 3 * d0[k];
    }
    return s;
  };
  slope_[0] = end(spin_[1] - spin_[0], spin_[2] - spin_[1], chord(0), chord(1));
  slope_[n - 1] = end(spin_[n - 1] - spin_[n - 2], spin_[n - 2] - spin_[n - 3], chord(n - 2), chord(n - 3));
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

template <bool Mass>
void TableBearingLaw<Mass>::force(const LateralMotion& m, Vector<4>& z) const {
  CoefficientTable::Values v, dv;
  table->at(m.spin, v, dv);
  Vec2 F = -(v.K * m.r + v.C * m.v);
  if constexpr (Mass) F -= v.M * m.a;
  z << F, 0.0, 0.0;
}

template <bool Mass>
void TableBearingLaw<Mass>::tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const {
  CoefficientTable::Values v, dv;
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

template <bool Mass>
void TableBearingLaw<Mass>::energy(const LateralMotion& m, system::Energy& e) const {
  CoefficientTable::Values v, dv;
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

template struct TableBearingLaw<false>;
template struct TableBearingLaw<true>;

}  // namespace whirl::elements
