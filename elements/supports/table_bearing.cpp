#include <elements/supports/table_bearing.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <elements/supports/coefficient_grid.hpp>
#include <elements/supports/monotone_slopes.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

using namespace system;

template <int N>
typename CoefficientValues<N>::Row CoefficientValues<N>::row() const {
  Row r;
  r << K.reshaped(), C.reshaped(), M.reshaped();
  return r;
}

template <int N>
void CoefficientValues<N>::set(const Row& r) {
  K.reshaped() = r.template head<entries>();
  C.reshaped() = r.template segment<entries>(entries);
  M.reshaped() = r.template tail<entries>();
}

template <int N>
CoefficientTable<N>::CoefficientTable(std::vector<double> spin, std::vector<Values> rows,
                                      Between between, Outside outside)
    : spin_(std::move(spin)),
      between_(between),
      outside_(outside) {
  const auto fail = [](const char* what) {
    throw run_error("E81", std::string("bearing table: ") + what);
  };
  if (spin_.empty()) fail("it has no rows");
  if (rows.size() != spin_.size()) fail("speeds and coefficients differ in number");
  for (std::size_t i = 1; i < spin_.size(); ++i)
    if (!(spin_[i] > spin_[i - 1])) fail("speeds must increase from row to row");
  for (const Values& v : rows) {
    value_.push_back(v.row());
    if (!value_.back().isFinite().all()) fail("a coefficient is not finite");
    has_mass_ = has_mass_ || !v.M.isZero(0.0);
  }
  if (between_ == Between::monotone_cubic)
    slope_ = monotone_slopes(spin_, value_);
  else
    slope_.assign(spin_.size(), Row::Zero());
}

template <int N>
bool CoefficientTable<N>::resists(int motion) const {
  WHIRL_EXPECTS(motion >= 0 && motion < N);
  return std::any_of(value_.begin(), value_.end(), [motion](const Row& r) {
    return (Values::stiffness(r, motion) != 0.0).any();
  });
}

template <int N>
bool CoefficientTable<N>::damps(int motion) const {
  WHIRL_EXPECTS(motion >= 0 && motion < N);
  return std::any_of(value_.begin(), value_.end(),
                     [motion](const Row& r) { return (Values::damping(r, motion) != 0.0).any(); });
}

template <int N>
void CoefficientTable<N>::at(double s, Values& v, Values& dv) const {
  Row x = Row::Zero(), dx = Row::Zero();
  if (outside_ == Outside::undefined && covers(s)) s = std::clamp(s, spin_.front(), spin_.back());
  if (!covers(s)) {
    x.setConstant(nan);
    dx.setConstant(nan);
  } else if (s <= spin_.front() || spin_.size() == 1)
    x = value_.front();
  else if (s >= spin_.back())
    x = value_.back();
  if (s >= spin_.front() && s <= spin_.back() && spin_.size() > 1) {
    const auto upper = std::upper_bound(spin_.begin(), spin_.end(), s);
    const std::size_t i =
        std::min(static_cast<std::size_t>(upper - spin_.begin()), spin_.size() - 1) - 1;
    const double h = spin_[i + 1] - spin_[i], u = (s - spin_[i]) / h;
    const Row chord = (value_[i + 1] - value_[i]) / h;
    if (between_ == Between::linear) {
      x = value_[i] + (s - spin_[i]) * chord;
      dx = chord;
    } else {
      const Row a = h * (slope_[i] - chord), b = h * (slope_[i + 1] - chord);
      x = value_[i] + u * h * chord + u * (1 - u) * ((1 - u) * a - u * b);
      dx = chord + ((1 - u) * (1 - 3 * u) * a - u * (2 - 3 * u) * b) / h;
    }
  }
  v.set(x);
  dv.set(dx);
}

template <bool Mass, class Table>
void TableBearingLaw<Mass, Table>::force(const LateralMotion& m, Vector<4>& z) const {
  CoefficientValues<2> v, dv;
  table->at(m.spin, m.frequency, v, dv);
  Vec2 F = -(v.K * m.r + v.C * m.v);
  if constexpr (Mass) F -= v.M * m.a;
  z << F, 0.0, 0.0;
}

template <bool Mass, class Table>
void TableBearingLaw<Mass, Table>::tangent(const LateralMotion& m, Vector<4>& z,
                                           LateralTangent& t) const {
  CoefficientValues<2> v, dv;
  table->at(m.spin, m.frequency, v, dv);
  Vec2 F = -(v.K * m.r + v.C * m.v), F_s = -(dv.K * m.r + dv.C * m.v);
  t.set_zero();
  t.r.topRows<2>() = -v.K;
  t.v.topRows<2>() = -v.C;
  if constexpr (Mass) {
    F -= v.M * m.a;
    F_s -= dv.M * m.a;
    t.a.topRows<2>() = -v.M;
  }
  t.spin.head<2>() = F_s;
  z << F, 0.0, 0.0;
}

template <bool Mass, class Table>
void TableBearingLaw<Mass, Table>::energy(const LateralMotion& m, system::Energy& e) const {
  CoefficientValues<2> v, dv;
  table->at(m.spin, m.frequency, v, dv);
  e.elastic += 0.5 * m.r.dot(v.K * m.r);
  e.dissipated += m.v.dot(v.C * m.v);
  const double skew_K = 0.5 * (v.K(0, 1) - v.K(1, 0));
  e.supplied +=
      0.5 * m.spin_rate * m.r.dot(dv.K * m.r) - skew_K * (m.v.x() * m.r.y() - m.v.y() * m.r.x());
  if constexpr (Mass) {
    const double skew_M = 0.5 * (v.M(0, 1) - v.M(1, 0));
    e.kinetic += 0.5 * m.v.dot(v.M * m.v);
    e.supplied +=
        0.5 * m.spin_rate * m.v.dot(dv.M * m.v) - skew_M * (m.v.x() * m.a.y() - m.v.y() * m.a.x());
  }
}

template <bool Mass, class Table>
Vector<6> SpatialTableBearing<Mass, Table>::load_on_first(const Nodes<2>& x,
                                                          const Context& c) const {
  CoefficientValues<6> v, dv;
  table->at(Spin(*x[0]).s, c.frequency, v, dv);
  const SixMotion::Relative r = between.relative(x, setpoint);
  Vector<6> F = preload - v.K * r.q - v.C * r.v;
  if constexpr (Mass) F -= v.M * r.a;
  return F;
}

template <bool Mass, class Table>
void SpatialTableBearing<Mass, Table>::add_force(const Nodes<2>& x, const Context& c,
                                                 ForceX<14>& f) const {
  between.add_load(load_on_first(x, c), f);
}

template <bool Mass, class Table>
void SpatialTableBearing<Mass, Table>::add_tangent(const Nodes<2>& x, const Context& c,
                                                   TangentX<14>& t) const {
  const Spin s(*x[0]);
  CoefficientValues<6> v, dv;
  table->at(s.s, c.frequency, v, dv);
  const SixMotion::Relative r = between.relative(x, setpoint);
  const Matrix<6, 14> B = between.B();
  Vector<6> F_s = -(dv.K * r.q + dv.C * r.v);
  t.K.noalias() += B.transpose() * v.K * B;
  t.C.noalias() += B.transpose() * v.C * B;
  if constexpr (Mass) {
    F_s -= dv.M * r.a;
    t.M.noalias() += B.transpose() * v.M * B;
  }
  // the left side is -B^T F; ds/dphi' = 1, ds/dd' = -w
  const Vector<14> f_s = -(B.transpose() * F_s);
  t.C.col(6) += f_s;
  t.C.template middleCols<3>(3).noalias() -= f_s * s.w.transpose();
  t.K.template middleCols<3>(3).noalias() += f_s * s.s_d.transpose();
}

template <bool Mass, class Table>
void SpatialTableBearing<Mass, Table>::add_energy(const Nodes<2>& x, const Context& c,
                                                  Energy& e) const {
  const SpinRate s(*x[0]);
  CoefficientValues<6> v, dv;
  table->at(s.s, c.frequency, v, dv);
  const SixMotion::Relative r = between.relative(x, setpoint);
  add_linear_energy<6>(v.K, v.C, v.M, preload, r.q, r.v, r.a, e);
  e.supplied += 0.5 * s.sdot * (r.q.dot(dv.K * r.q) + r.v.dot(dv.M * r.v));
}

template struct CoefficientValues<2>;
template struct CoefficientValues<6>;
template class CoefficientTable<2>;
template class CoefficientTable<6>;
template struct TableBearingLaw<false, CoefficientTable<2>>;
template struct TableBearingLaw<true, CoefficientTable<2>>;
template struct TableBearingLaw<false, CoefficientGrid<2>>;
template struct TableBearingLaw<true, CoefficientGrid<2>>;
template struct SpatialTableBearing<false, CoefficientTable<6>>;
template struct SpatialTableBearing<true, CoefficientTable<6>>;
template struct SpatialTableBearing<false, CoefficientGrid<6>>;
template struct SpatialTableBearing<true, CoefficientGrid<6>>;

}  // namespace whirl::elements
