#include <elements/films/carried_film.hpp>
#include <elements/films/pad_mount.hpp>
#include <elements/films/turbulence.hpp>
#include <core/contract.hpp>
#include <core/dual.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

Vec2 outward(double a) { return Vec2(std::cos(a), std::sin(a)); }

/// Of a cell with m/h - 1 = x: its pressure, and the share that the journal carries on, which grows
/// no further once the bubbles are gone; with slopes.
struct Filling {
  double pressure, by_pressure, share, by_share;
};
Filling filling(double x) {
  constexpr double bulk = CarriedPad::bulk, mixed = CarriedPad::mixed;
  if (x <= 0.0) return {0.0, 0.0, 1.0 + x, 1.0};
  const double part = x / mixed;
  if (part < 1.0)
    return {0.5 * bulk * x * part, bulk * part, 1.0 + x * (1.0 - 0.5 * part), 1.0 - part};
  return {bulk * (x - 0.5 * mixed), bulk, 1.0 + 0.5 * mixed, 0.0};
}

/// m/h - 1 in terms of an unknown for which empty, mixed and full oil are of one size, and its slope.
/// edge: where oil is full, positive.
struct Unknown {
  double edge;
  double filled(double u) const {
    constexpr double mixed = CarriedPad::mixed;
    if (u <= 0.0) return u;
    return u < edge ? mixed * u / edge : mixed + 0.5 * mixed * (u - edge) / edge;
  }
  double slope(double u) const {
    if (u <= 0.0) return 1.0;
    return u < edge ? CarriedPad::mixed / edge : 0.5 * CarriedPad::mixed / edge;
  }
  double of(double x) const {
    constexpr double mixed = CarriedPad::mixed;
    if (x <= 0.0) return x;
    return x < mixed ? edge * x / mixed : edge + 2.0 * edge * (x - mixed) / mixed;
  }
};

double positive(double x) { return std::max(x, 0.0); }
template <int N>
Dual<N> positive(const Dual<N>& x) {
  return x.v > 0.0 ? x : Dual<N>(0.0);
}
double size_of(double x) { return std::abs(x); }
template <int N>
Dual<N> size_of(const Dual<N>& x) {
  return x.v < 0.0 ? -x : x;
}

/// What turbulence adds at a thickness; 1 of a laminar film.
template <class T>
struct FlowFactors {
  T along, across, shear;
};
template <class T>
FlowFactors<T> factors_at(const FiniteJournal& f, const T& slip, const T& gap) {
  if (f.turbulent_density == 0.0) return {T(1.0), T(1.0), T(1.0)};
  const double unit = f.turbulent_density * f.radius / f.viscosity;
  const TurbulentFactors<T> t(unit * (size_of(slip) * gap));
  return {T(1.0) / t.along, T(1.0) / t.across, t.shear};
}

}  // namespace

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

double CarriedPad::pump(Index i, double fed, const Vec2& w, double slip) const {
  const Vec2 W = w - slip * lever();
  return film_.supply_pressure * film_.radius * film_.length * (fed + W.dot(normal_[at(i)]));
}

template <class T>
auto CarriedPad::oil(Index i, const T& ry, const T& rz, const T& content) const -> Oil<T> {
  const Vec2 n = normal_[at(i)] / width_;
  const T gap = T(clearance_ - lift_ * thinnest_.dot(n)) - (ry * n.x() + rz * n.y());
  const T share = content / gap;
  const Filling f = filling(value(share) - 1.0);
  return {gap, chain(share, f.share, f.by_share), chain(share, f.pressure, f.by_pressure)};
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

/// Newton's method for (m - old) rate + outflow = 0, by smaller steps where the corners catch it.
/// Unknown: the pressure in a unit of its own where the cell is full, the share less one where it is
/// not, so that both sides of the corner are of one size.
bool CarriedPad::advance(const Vec2& r, double slip, double rate,
                         std::vector<double>& content) const {
  using Three = Dual<3>;
  const std::vector<double> old = content;
  const std::size_t n = content.size();
  const double slender = film_.radius / clearance_;
  const double fast = std::max(std::abs(slip), 1.0);
  const double unit =
      film_.source * film_.viscosity * fast * slender * slender + film_.supply_pressure;
  const Unknown unknown{0.5 * bulk * mixed / unit};
  const double tolerance = 1e-10 + 1e-11 * unknown.edge;  // above the rounding of the contents
  std::vector<double> u(n), slope(n), residual(n), lower(n), diagonal(n), upper(n);
  for (std::size_t i = 0; i < n; ++i)
    u[i] = unknown.of(content[i] / gap(static_cast<Index>(i), r) - 1.0);
  constexpr int bold = 25, most = 100;
  for (int pass = 0; pass < most; ++pass) {
    for (std::size_t i = 0; i < n; ++i) {
      const double h = gap(static_cast<Index>(i), r);
      content[i] = h * (1.0 + unknown.filled(u[i]));
      slope[i] = h * unknown.slope(u[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t before = i > 0 ? i - 1 : i, next = i + 1 < n ? i + 1 : i;
      const Cell<Three> c = cell(static_cast<Index>(i), Three(r.x()), Three(r.y()), Three(slip),
                                 Three::variable(content[before], 0),
                                 Three::variable(content[i], 1), Three::variable(content[next], 2));
      residual[i] = c.outflow.v + rate * (content[i] - old[i]);
      lower[i] = c.outflow.g[0] * slope[before];
      diagonal[i] = (c.outflow.g[1] + rate) * slope[i];
      upper[i] = c.outflow.g[2] * slope[next];
    }
    for (std::size_t i = 1; i < n; ++i) {
      const double share = lower[i] / diagonal[i - 1];
      diagonal[i] -= share * upper[i - 1];
      residual[i] -= share * residual[i - 1];
    }
    double change = 0.0;
    for (std::size_t k = n; k-- > 0;) {
      if (k + 1 < n) residual[k] -= upper[k] * residual[k + 1];
      residual[k] /= diagonal[k];
      change = std::max(change, std::abs(residual[k]) / std::max(1.0, std::abs(u[k])));
    }
    if (!std::isfinite(change)) return false;
    for (std::size_t i = 0; i < n; ++i)
      u[i] = std::max(u[i] - (pass < bold ? 1.0 : 0.4) * residual[i], -1.0 + 1e-6);
    if (change < tolerance) return true;
  }
  return false;
}

std::vector<double> CarriedPad::balanced(const Vec2& r, double slip) const {
  std::vector<double> content(normal_.size());
  for (std::size_t i = 0; i < content.size(); ++i) {
    content[i] = gap(static_cast<Index>(i), r);
    if (!(content[i] > 0.0)) return std::vector<double>(content.size(), nan);
  }
  if (slip == 0.0 && film_.supply_pressure == 0.0) return content;
  const double fast = std::max(std::abs(slip), 1.0);
  const std::vector<double> full = content;
  if (advance(r, slip, 1e-9 * fast, content)) return content;
  // by way of the motion towards it, in ever longer steps
  content = full;
  for (double rate = 1e3 * fast; rate > 1e-9 * fast; rate *= 0.25)
    if (!advance(r, slip, rate, content)) return std::vector<double>(content.size(), nan);
  return content;
}

double CarriedPad::balanced_cell(Index i, const Vec2& r, double slip) const {
  const std::lock_guard guard(last_.lock);
  if (last_.r != r || last_.slip != slip) {
    last_.content = balanced(r, slip);
    last_.r = r;
    last_.slip = slip;
  }
  return last_.content[at(i)];
}

template <int Moves, bool Offsets>
LateralMotion PadCell<Moves, Offsets>::motion(const Nodes& x, const system::Context& c) const {
  LateralMotion m = Link{offset}.motion(ends(x), c, spins(x), false);
  for (std::size_t k = 0; k < directions.size(); ++k) {
    m.r -= x[2 + k]->u.x() * directions[k];
    m.v -= x[2 + k]->du.x() * directions[k];
  }
  return m;
}

template <int Moves, bool Offsets>
auto PadCell<Moves, Offsets>::contents(const Nodes& x) const -> Contents {
  const Index last = pad->cells() - 1;
  return {x[before]->u.x() + pad->reference(std::max<Index>(cell - 1, 0)),
          x[held]->u.x() + pad->reference(cell),
          x[next]->u.x() + pad->reference(std::min(cell + 1, last))};
}

namespace {

/// (F, T_0, T_1) on the journal of what a cell does (film.hpp).
template <class T>
std::array<T, 4> load_of(const CarriedPad& pad, const CarriedPad::Cell<T>& c, const T& ry,
                         const T& rz) {
  const Vec2 lever = pad.lever();
  const T torque = lever.x() * c.push[0] + lever.y() * c.push[1] + c.drag;
  const T half = -0.5 * (ry * c.push[1] - rz * c.push[0]);
  return {-c.push[0], -c.push[1], torque - half, -torque - half};
}

}  // namespace

template <int Moves, bool Offsets>
Vector<4> PadCell<Moves, Offsets>::load(const Nodes& x, const system::Context& c) const {
  const LateralMotion m = motion(x, c);
  const Contents q = contents(x);
  const auto now =
      pad->cell(cell, m.r.x(), m.r.y(), m.spin - m.housing_spin, q.before, q.own, q.next);
  const std::array<double, 4> z = load_of(*pad, now, m.r.x(), m.r.y());
  return Vector<4>(z[0], z[1], z[2], z[3]);
}

template <int Moves, bool Offsets>
void PadCell<Moves, Offsets>::add_force(const Nodes& x, const system::Context& c,
                                        system::ForceX<size>& f) const {
  const LateralMotion m = motion(x, c);
  const Contents q = contents(x);
  const double ry = m.r.x(), rz = m.r.y();
  const auto now = pad->cell(cell, ry, rz, m.spin - m.housing_spin, q.before, q.own, q.next);
  const std::array<double, 4> load = load_of(*pad, now, ry, rz);
  Vector<4> z(load[0], load[1], load[2], load[3]);
  // a pad that turns away from its journal touches at an edge first
  const bool inside = Moves > 0 ? pad->open(cell, m.r) : pad->gap(cell, m.r) > 0.0;
  if (!inside) z.setConstant(nan);
  system::ForceX<14> at_ends = system::ForceX<14>::Zero();
  Link{offset}.add_force(spins(x), z, at_ends);
  f.template head<14>() += at_ends;
  for (std::size_t k = 0; k < directions.size(); ++k)
    f[pad_mount::row_of(k)] += z.head<2>().dot(directions[k]);
  f[7 * held] += pad->row_factor() * (x[held]->du.x() + now.outflow);
}

template <int Moves, bool Offsets>
void PadCell<Moves, Offsets>::add_tangent(const Nodes& x, const system::Context& c,
                                          system::TangentX<size>& t) const {
  constexpr int by_ry = 0, by_rz = 1, by_slip = 2, by_before = 3, by_own = 4, by_next = 5;
  using All = Dual<6>;
  const auto s = spins(x);
  const LateralMotion m = motion(x, c);
  const Contents q = contents(x);
  const All ry = All::variable(m.r.x(), by_ry), rz = All::variable(m.r.y(), by_rz);
  const auto now = pad->cell(cell, ry, rz, All::variable(m.spin - m.housing_spin, by_slip),
                             All::variable(q.before, by_before), All::variable(q.own, by_own),
                             All::variable(q.next, by_next));
  const std::array<All, 4> load = load_of(*pad, now, ry, rz);
  const double row = pad->row_factor();
  constexpr Index row_held = 7 * held;
  Vector<4> z;
  Matrix<4, 3> by_contents;
  LateralTangent of_load, of_row;
  of_load.set_zero();
  of_row.set_zero();
  for (Index k = 0; k < 4; ++k) {
    const All& part = load[at(k)];
    z[k] = part.v;
    by_contents.row(k) = part.g.template tail<3>().transpose();
    of_load.r.row(k) = part.g.template head<2>().transpose();
    of_load.spin[k] = part.g[by_slip];
  }
  of_load.housing_spin = -of_load.spin;
  // a row of the ends is minus the slope of the force there
  of_row.r.row(0) = row * now.outflow.g.template head<2>().transpose();
  of_row.spin[0] = row * now.outflow.g[by_slip];
  of_row.housing_spin = -of_row.spin;
  system::TangentX<14> at_ends;
  at_ends.C.setZero();
  at_ends.K.setZero();
  Link{offset}.add_tangent(s, z, of_load, false, at_ends);
  t.C.template topLeftCorner<14, 14>() += at_ends.C;
  t.K.template topLeftCorner<14, 14>() += at_ends.K;
  pad_mount::add_film_tangent(Link{offset}, s, directions, of_load, at_ends, t);
  at_ends.C.setZero();
  at_ends.K.setZero();
  Link{offset}.add_tangent(s, Vector<4>::Zero(), of_row, false, at_ends);
  t.C.template block<1, 14>(row_held, 0) -= at_ends.C.row(1);
  t.K.template block<1, 14>(row_held, 0) -= at_ends.K.row(1);
  constexpr std::array<Index, 3> column_of{7 * before, row_held, 7 * next};
  for (const Index k : {by_before, by_own, by_next}) {
    const Index column = column_of[at(k - by_before)];
    system::ForceX<14> of_ends = system::ForceX<14>::Zero();
    Link{offset}.add_force(s, by_contents.col(k - by_before), of_ends);
    t.K.template block<14, 1>(0, column) += of_ends;
    for (std::size_t j = 0; j < directions.size(); ++j)
      t.K(pad_mount::row_of(j), column) +=
          directions[j].dot(by_contents.col(k - by_before).template head<2>());
    t.K(row_held, column) += row * now.outflow.g[k];
  }
  for (std::size_t k = 0; k < directions.size(); ++k)
    t.K(row_held, pad_mount::row_of(k)) -= of_row.r.row(0).dot(directions[k]);
  t.C(row_held, row_held) += row;
}

template <int Moves, bool Offsets>
void PadCell<Moves, Offsets>::add_energy(const Nodes& x, const system::Context& c,
                                         system::Energy& e) const {
  const LateralMotion m = motion(x, c);
  const Contents q = contents(x);
  const FilmPoint p = FilmLaw<FiniteJournal>::point(m);
  const auto now = pad->cell(cell, m.r.x(), m.r.y(), p.slip, q.before, q.own, q.next);
  const Vec2 push(now.push[0], now.push[1]);
  const double torque = pad->lever().dot(push) + now.drag;
  const double pump = pad->pump(cell, now.fed, p.w, p.slip);
  e.dissipated -= torque * p.slip - push.dot(p.w);
  e.dissipated += pump;
  e.supplied += pump;
}

template <int Moves, bool Offsets>
void PadCell<Moves, Offsets>::relax(const Nodes& x, const system::Context& c,
                                    std::array<double, own>& q) const {
  const LateralMotion m = motion(x, c);
  const double content = pad->balanced_cell(cell, m.r, m.spin - m.housing_spin);
  if (std::isfinite(content)) q[0] = content - pad->reference(cell);
}

template <int Moves, bool Offsets>
double PadCell<Moves, Offsets>::full(const Nodes& x) const {
  return pad->gap(cell, motion(x, {}).r) - pad->reference(cell);
}

template struct PadCell<0, false>;
template struct PadCell<0, true>;
template struct PadCell<1, false>;
template struct PadCell<1, true>;
template struct PadCell<2, false>;
template struct PadCell<2, true>;

}  // namespace whirl::elements
