#include <elements/supports/force_curve.hpp>
#include <core/contract.hpp>
#include <core/law.hpp>

#include <core/error.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

[[noreturn]] void curve_fault(const char* what) {
  throw run_error("E82", std::string("force curve: ") + what);
}

double energy_of(const std::array<double, 8>& c, double u) {
  double V = 0;
  for (int k = 7; k >= 0; --k)
    V = V * u + c[static_cast<std::size_t>(k)] / (k + 1);
  return V * u;
}

double slope_of(const std::array<double, 8>& c, double u) {
  double d = 0;
  for (int k = 7; k >= 1; --k)
    d = d * u + k * c[static_cast<std::size_t>(k)];
  return d;
}

}  // namespace

const ForceCurve::Piece& ForceCurve::piece(double x) const {
  WHIRL_EXPECTS(!pieces_.empty());
  return pieces_[static_cast<std::size_t>(std::upper_bound(breaks_.begin(), breaks_.end(), x) -
                                          breaks_.begin())];
}

ForceCurve::Value ForceCurve::at(double x) const {
  const Piece& p = piece(x);
  const double u = x - p.x0;
  double F = 0, d = 0;
  for (int k = 7; k >= 0; --k) {
    d = d * u + F;
    F = F * u + p.c[static_cast<std::size_t>(k)];
  }
  return {F, d, p.V0 + energy_of(p.c, u)};
}

void ForceCurve::integrate() {
  WHIRL_EXPECTS(pieces_.size() == breaks_.size() + 1);
  for (std::size_t i = 0; i + 1 < pieces_.size(); ++i) {
    const double b = breaks_[i];
    pieces_[i + 1].V0 = pieces_[i].V0 + energy_of(pieces_[i].c, b - pieces_[i].x0) -
                        energy_of(pieces_[i + 1].c, b - pieces_[i + 1].x0);
  }
  const double V = at(0.0).energy;
  for (Piece& p : pieces_)
    p.V0 -= V;
  corners_.clear();
  for (std::size_t i = 0; i < breaks_.size(); ++i) {
    const double left = slope_of(pieces_[i].c, breaks_[i] - pieces_[i].x0),
                 right = slope_of(pieces_[i + 1].c, breaks_[i] - pieces_[i + 1].x0);
    if (std::abs(right - left) > 0.5 * std::max(std::abs(left), std::abs(right)))
      corners_.push_back(breaks_[i]);
  }
}

int ForceCurve::region(double x) const {
  return static_cast<int>(std::upper_bound(corners_.begin(), corners_.end(), x) - corners_.begin());
}

ForceCurve ForceCurve::polynomial(const std::vector<double>& c) {
  if (c.empty() || c.size() > 8) curve_fault("a polynomial has 1 to 8 coefficients");
  ForceCurve f;
  f.pieces_.push_back({0.0});
  for (std::size_t k = 0; k < c.size(); ++k) {
    if (!std::isfinite(c[k])) curve_fault("a coefficient is not finite");
    f.pieces_[0].c[k] = c[k];
  }
  return f;
}

ForceCurve ForceCurve::table(const std::vector<double>& x, const std::vector<double>& F,
                             bool monotone_cubic) {
  const std::size_t n = x.size();
  if (n < 2 || F.size() != n)
    curve_fault("a table has at least 2 points, as many deflections as forces");
  for (std::size_t i = 0; i < n; ++i)
    if (!std::isfinite(x[i]) || !std::isfinite(F[i]) || (i > 0 && !(x[i] > x[i - 1])))
      curve_fault("deflections must be finite and increase");
  std::vector<double> d(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i)
    d[i] = (F[i + 1] - F[i]) / (x[i + 1] - x[i]);
  std::vector<double> m{d.front(), d.back()};  // of straight lines the ends alone
  if (monotone_cubic) m = pchip_slopes(x, F);
  ForceCurve f;
  f.pieces_.push_back({x[0], {F[0], m.front()}});
  f.breaks_.push_back(x[0]);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = x[i + 1] - x[i];
    Piece p{x[i], {F[i], d[i]}};
    if (monotone_cubic) {
      p.c[1] = m[i];
      p.c[2] = (3 * d[i] - 2 * m[i] - m[i + 1]) / h;
      p.c[3] = (m[i] + m[i + 1] - 2 * d[i]) / (h * h);
    }
    f.pieces_.push_back(p);
    f.breaks_.push_back(x[i + 1]);
  }
  f.pieces_.push_back({x[n - 1], {F[n - 1], m.back()}});
  f.integrate();
  return f;
}

ForceCurve ForceCurve::one_sided(double gap, double k, double smooth) {
  if (!(k >= 0) || !(smooth >= 0) || !std::isfinite(gap))
    curve_fault("stiffness and smoothing length must not be negative");
  ForceCurve f;
  f.pieces_.push_back({gap});
  f.breaks_.push_back(gap);
  if (smooth >
      0) {  // parabola over [gap, gap + smooth], then slope k, the line through gap + smooth/2
    f.pieces_.push_back({gap, {0.0, 0.0, 0.5 * k / smooth}});
    f.breaks_.push_back(gap + smooth);
  }
  f.pieces_.push_back({gap + smooth, {0.5 * k * smooth, k}});
  f.integrate();
  return f;
}

ForceCurve ForceCurve::clearance(double gap_minus, double gap_plus, double k, double smooth) {
  if (!(gap_minus >= 0) || !(gap_plus >= 0)) curve_fault("a clearance must not be negative");
  const ForceCurve plus = one_sided(gap_plus, k, smooth), minus = one_sided(gap_minus, k, smooth);
  ForceCurve f;
  for (std::size_t i = minus.pieces_.size(); i-- > 1;) {  // mirrored: F(-x) -> -F(x)
    Piece p{-minus.pieces_[i].x0};
    for (std::size_t j = 0; j < 8; ++j)
      p.c[j] = (j % 2 ? 1.0 : -1.0) * minus.pieces_[i].c[j];
    f.pieces_.push_back(p);
    f.breaks_.push_back(-minus.breaks_[i - 1]);
  }
  f.pieces_.push_back({0.0});
  for (std::size_t i = 1; i < plus.pieces_.size(); ++i) {
    f.pieces_.push_back(plus.pieces_[i]);
    f.breaks_.push_back(plus.breaks_[i - 1]);
  }
  f.integrate();
  return f;
}

}  // namespace whirl::elements
