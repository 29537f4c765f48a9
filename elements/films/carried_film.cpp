#include <elements/films/carried_film.hpp>
#include <elements/films/carried_oil.hpp>
#include <core/contract.hpp>
#include <core/dual.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

using namespace carried_oil;

CarriedPad::CarriedPad(const FiniteJournal& film, std::size_t k) : film_(film) {
  WHIRL_EXPECTS(film.surface && k < film.surface->arcs().size());
  WHIRL_EXPECTS(film.mass_conserving && film.kept_from < 0);
  const JournalSurface::Arc& arc = film.surface->arcs()[k];
  WHIRL_EXPECTS(!arc.round);
  const int cells = std::max(4, static_cast<int>(std::lround(arc.points)));
  start_ = arc.start;
  width_ = arc.length / cells;
  clearance_ = film.surface->pad_clearance();
  lift_ = film.surface->lift();
  thinnest_ = arc.thinnest;
  for (int i = 0; i < cells; ++i) {
    const double from = start_ + i * width_, to = from + width_;
    normal_.push_back({std::sin(to) - std::sin(from), std::cos(from) - std::cos(to)});
  }
}

double CarriedPad::gap(Index i, const Vec2& r) const {
  return clearance_ - (r + lift_ * thinnest_).dot(normal_[at(i)]) / width_;
}

template <class T>
T CarriedPad::gap_at(double angle, const T& ry, const T& rz) const {
  const Vec2 n = outward(angle);
  return T(clearance_ - lift_ * thinnest_.dot(n)) - (ry * n.x() + rz * n.y());
}

bool CarriedPad::open(Index i, const Vec2& r) const {
  const auto at_face = [&](Index face) {
    return gap_at(start_ + static_cast<double>(face) * width_, r.x(), r.y());
  };
  return gap(i, r) > 0.0 && at_face(i) > 0.0 && at_face(i + 1) > 0.0;
}

double CarriedPad::pressure(double content, double gap) const {
  return filling(content / gap - 1.0).pressure;
}

double CarriedPad::row_factor() const {
  const double slender = film_.radius / clearance_;
  return film_.source * film_.viscosity * slender * slender * slender * film_.length * width_;
}

double CarriedPad::pump(Index i, double fed, const FilmPoint& p, double part) const {
  const Vec2 W = p.w - p.slip * lever();
  return film_.supply_pressure * film_.radius * film_.length * (fed + part * W.dot(normal_[at(i)]));
}

template <class T>
auto CarriedPad::oil(Index i, const T& ry, const T& rz, const T& content) const -> Oil<T> {
  const Vec2 n = normal_[at(i)] / width_;
  const T gap = T(clearance_ - lift_ * thinnest_.dot(n)) - (ry * n.x() + rz * n.y());
  return oil_of(gap, content);
}

/// Phi at a face, m rad/s. left, right: null beyond the ends, where a full groove is. driven: what the
/// pressure does of it.
template <class T>
T CarriedPad::flow_along(Index face, const T& ry, const T& rz, const T& slip, const Oil<T>* left,
                         const Oil<T>* right, T& driven) const {
  const T gap = gap_at(start_ + static_cast<double>(face) * width_, ry, rz);
  const double distance = left && right ? width_ : 0.5 * width_;
  const double groove = film_.supply_pressure;
  const T before = left ? left->pressure : T(groove), behind = right ? right->pressure : T(groove);
  const T full(1.0);
  const T carried = 0.5 * ((positive(slip) * (left ? left->share : full) -
                            positive(-slip) * (right ? right->share : full)) *
                           gap);
  const double unit = film_.source * film_.viscosity * film_.radius * film_.radius * distance;
  const FlowFactors<T> turbulent = factors_at(film_, slip, gap);
  driven = (1.0 / unit) * (gap * gap * gap * turbulent.along * (before - behind));
  return carried + driven;
}

template <class T>
auto CarriedPad::cell(Index i, const T& ry, const T& rz, const T& slip, const T& before,
                      const T& own, const T& next) const -> Cell<T> {
  const Index last = cells() - 1;
  const Oil<T> here = oil(i, ry, rz, own);
  const Oil<T> up = i > 0 ? oil(i - 1, ry, rz, before) : Oil<T>{};
  const Oil<T> down = i < last ? oil(i + 1, ry, rz, next) : Oil<T>{};
  T in_driven(0.0), out_driven(0.0);
  Cell<T> c;
  c.in = flow_along(i, ry, rz, slip, i > 0 ? &up : nullptr, &here, in_driven);
  c.out = flow_along(i + 1, ry, rz, slip, &here, i < last ? &down : nullptr, out_driven);
  const FlowFactors<T> turbulent = factors_at(film_, slip, here.gap);
  const double L = film_.length, R = film_.radius;
  const double unit = film_.leakage * width_ / (film_.source * film_.viscosity * L * L);
  c.sides = unit * (here.gap * here.gap * here.gap * turbulent.across * here.pressure);
  c.outflow = (1.0 / width_) * (c.out - c.in + c.sides);
  const T over = R * L * (here.pressure - T(film_.supply_pressure));
  c.push[0] = over * normal_[at(i)].x();
  c.push[1] = over * normal_[at(i)].y();
  // wet is the mean of what comes in through one face and what goes out through the other
  const bool forwards = value(slip) >= 0.0;
  const bool from_groove = forwards ? i == 0 : i == last;
  const T entering = from_groove ? T(1.0) : forwards ? up.share : down.share;
  const double drag = 0.5 * film_.viscosity * R * R * R * L * width_;
  c.drag = -drag * (slip * turbulent.shear * (entering + here.share) / here.gap);
  c.fed = T(0.0);
  if (i == 0) c.fed += in_driven;
  if (i == last) c.fed -= out_driven;
  return c;
}

template CarriedPad::Cell<double> CarriedPad::cell(Index, const double&, const double&,
                                                   const double&, const double&, const double&,
                                                   const double&) const;
template CarriedPad::Cell<Dual<3>> CarriedPad::cell(Index, const Dual<3>&, const Dual<3>&,
                                                    const Dual<3>&, const Dual<3>&, const Dual<3>&,
                                                    const Dual<3>&) const;
template CarriedPad::Cell<Dual<6>> CarriedPad::cell(Index, const Dual<6>&, const Dual<6>&,
                                                    const Dual<6>&, const Dual<6>&, const Dual<6>&,
                                                    const Dual<6>&) const;

bool CarriedPad::advance(const Vec2& r, double slip, double rate,
                         std::vector<double>& content) const {
  const double slender = film_.radius / clearance_;
  const double fast = std::max(std::abs(slip), 1.0);
  const double unit =
      film_.source * film_.viscosity * fast * slender * slender + film_.supply_pressure;
  return carried_oil::advance(*this, r, slip, rate, unit, content);
}

std::vector<double> CarriedPad::balanced(const Vec2& r, double slip) const {
  return carried_oil::balanced(*this, r, slip, film_.supply_pressure);
}

Vec2 CarriedPad::force_in_balance(const Vec2& r, double slip) const {
  return carried_oil::force_in_balance(*this, r, slip);
}

double CarriedPad::balanced_cell(Index i, Index, const Vec2& r, double slip) const {
  const auto find = [this](const Vec2& place, double at_slip) { return balanced(place, at_slip); };
  return last_.content(at(i), r, slip, find);
}

}  // namespace whirl::elements
