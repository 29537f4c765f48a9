#include <elements/films/squeeze_film.hpp>
#include <core/contract.hpp>

namespace whirl::elements {

void ShortFullFilm::evaluate(const FilmPoint& p, FilmForce& f) const {
  WHIRL_EXPECTS(radius > 0.0 && length > 0.0 && clearance > 0.0);
  FilmTangent t;
  evaluate(p, f, t);
}

void ShortFullFilm::evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const {
  WHIRL_EXPECTS(radius > 0.0 && length > 0.0 && clearance > 0.0);
  const double c = clearance;
  const Vec2 e = p.r / c;
  const double u = 1.0 - e.squaredNorm(), k = pi * viscosity * radius * std::pow(length / c, 3);
  if (!(u > 0.0)) return set_outside(f, t);
  const double a = std::pow(u, -1.5), b = 3.0 * a / u, ew = e.dot(p.w);
  f.F = -k * (a * p.w + b * ew * e);
  t.F_w = -k * (a * Mat2::Identity() + b * e * e.transpose());
  // da/de = b e, db/de = 5 b e/u
  t.F_r = -k / c *
          (b * p.w * e.transpose() + 5.0 * b / u * ew * e * e.transpose() +
           b * e * p.w.transpose() + b * ew * Mat2::Identity());
  t.F_slip.setZero();
  const double drag = -two_pi * viscosity * radius * radius * radius * length / (c * std::sqrt(u));
  f.T = drag * p.slip;
  t.T_slip = drag;
  t.T_r = drag * p.slip / (u * c) * e;
  t.T_w.setZero();
}

}  // namespace whirl::elements
