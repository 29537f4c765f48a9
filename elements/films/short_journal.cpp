#include <elements/films/short_journal.hpp>
#include <core/contract.hpp>

namespace whirl::elements {

HalfFilmIntegral::HalfFilmIntegral(double x, double y) {
  const double u = 1.0 - x * x - y * y, q = std::sqrt(u), Q = 1.0 / (1.0 - y * y), P = y * y * Q;
  G = 2.0 / q * (std::atan((1.0 + x - y) / q) + std::atan((1.0 + x + y) / q));
  a = (2.0 + x * G) / u;
  b = (2.0 * x * y * Q + y * G) / u;
  aa = (G + 3.0 * x * a) / u;
  ab = (x * b + 2.0 * y * a) / u;
  bb = (G + 3.0 * y * b + 2.0 * x * Q * (1.0 + 2.0 * P)) / u;
  aaa = (4.0 * a + 5.0 * x * aa) / u;
  aab = (b + 3.0 * x * ab + 2.0 * y * aa) / u;
  abb = (a + 3.0 * y * ab + 2.0 * x * bb + 2.0 * Q * (1.0 + 2.0 * P)) / u;
  bbb = (4.0 * b + 5.0 * y * bb + 4.0 * x * y * Q * Q * (3.0 + 4.0 * P)) / u;
}

namespace {

/// Unit vector of w with its quarter turn as columns; +y when w = 0.
Mat2 axes_of(const Vec2& w, double speed) {
  const double cs = speed > 0.0 ? w.x() / speed : 1.0, sn = speed > 0.0 ? w.y() / speed : 0.0;
  Mat2 A;
  A << cs, -sn, sn, cs;
  return A;
}

}  // namespace

void ShortJournal::evaluate(const FilmPoint& p, FilmForce& f) const {
  WHIRL_EXPECTS(radius > 0.0 && length > 0.0 && clearance > 0.0);
  const double c2 = clearance * clearance, u = 1.0 - p.r.squaredNorm() / c2;
  if (!(u > 0.0)) return set_outside(f);
  const double speed = p.w.norm();
  const Mat2 A = axes_of(p.w, speed);
  const Vec2 e = A.transpose() * p.r / clearance;
  const HalfFilmIntegral g(e.x(), e.y());
  const double scale = viscosity * radius * length * length * length / (c2 * clearance);
  f.F = -0.5 * scale * speed * (A * Vec2(g.aa, g.ab));
  f.T =
      -two_pi * viscosity * radius * radius * radius * length / (clearance * std::sqrt(u)) * p.slip;
}

void ShortJournal::evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const {
  WHIRL_EXPECTS(radius > 0.0 && length > 0.0 && clearance > 0.0);
  const double c2 = clearance * clearance, u = 1.0 - p.r.squaredNorm() / c2;
  if (!(u > 0.0)) return set_outside(f, t);
  const double speed = p.w.norm();
  const Mat2 A = axes_of(p.w, speed);
  const Vec2 e = A.transpose() * p.r / clearance;
  const HalfFilmIntegral g(e.x(), e.y());
  const double scale = viscosity * radius * length * length * length / (c2 * clearance);
  f.F = -0.5 * scale * speed * (A * Vec2(g.aa, g.ab));
  Mat2 S2, S3;
  S2 << g.aa, g.ab, g.ab, g.bb;
  if (speed == 0.0) {  // mean of the two half circles
    const HalfFilmIntegral o(-e.x(), -e.y());
    Mat2 other;
    other << o.aa, o.ab, o.ab, o.bb;
    S2 = 0.5 * (S2 + other);
  }
  S3 << g.aaa, g.aab, g.aab, g.abb;
  t.F_w = -0.5 * scale * A * S2 * A.transpose();
  t.F_r = -0.5 * scale / clearance * speed * A * S3 * A.transpose();
  t.F_slip.setZero();
  const double drag =
      -two_pi * viscosity * radius * radius * radius * length / (clearance * std::sqrt(u));
  f.T = drag * p.slip;
  t.T_slip = drag;
  t.T_r = drag * p.slip / (u * c2) * p.r;
  t.T_w.setZero();
}

}  // namespace whirl::elements
