#include <elements/films/carried_grid.hpp>
#include <elements/films/carried_oil.hpp>
#include <core/contract.hpp>
#include <core/dual.hpp>
#include <core/error.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

using namespace carried_oil;

namespace {

constexpr double near = 1e-9;  // of angles and widths

/// Cells between stops: one each, the others where the widest are.
std::vector<double> edges_between(const std::vector<double>& stops, int cells) {
  std::vector<int> numbers(stops.size() - 1, 1);
  const auto width = [&](std::size_t k) { return (stops[k + 1] - stops[k]) / numbers[k]; };
  if (static_cast<int>(numbers.size()) > cells)
    throw run_error("E84", "journal bearing: too many recesses on one pad for its grid");
  for (int k = static_cast<int>(numbers.size()); k < cells; ++k) {
    std::size_t widest = 0;
    for (std::size_t i = 1; i < numbers.size(); ++i)
      if (width(i) > width(widest) * (1.0 + near)) widest = i;
    ++numbers[widest];
  }
  std::vector<double> edges{stops.front()};
  for (std::size_t k = 0; k < numbers.size(); ++k)
    for (int i = 1; i <= numbers[k]; ++i)
      edges.push_back(std::lerp(stops[k], stops[k + 1], static_cast<double>(i) / numbers[k]));
  return edges;
}

}  // namespace

CarriedGrid::CarriedGrid(const FiniteJournal& film, std::size_t k, int columns, int rows)
    : film_(film) {
  WHIRL_EXPECTS(film.surface && k < film.surface->arcs().size());
  WHIRL_EXPECTS(film.mass_conserving && film.kept_from < 0);
  WHIRL_EXPECTS(columns > 0 && rows > 0);
  const JournalSurface::Arc& arc = film.surface->arcs()[k];
  WHIRL_EXPECTS(!arc.round);
  start_ = arc.start;
  clearance_ = film.surface->pad_clearance();
  lift_ = film.surface->lift();
  thinnest_ = arc.thinnest;
  const std::vector<Recess> recesses =
      film.grid ? (*film.grid)[k].recesses() : std::vector<Recess>{};
  for (const Recess& x : recesses) {
    if (!x.open) continue;
    if (x.from > near || x.to < arc.length - near)
      throw run_error("E84", "journal bearing: a relief track ends on its pad");
    track_ = std::max(track_, x.width);
  }
  add_columns(recesses, arc.length, columns);
  add_rows(recesses, rows);
  place_recesses(recesses);
  find_distances();
}

void CarriedGrid::add_columns(const std::vector<Recess>& recesses, double arc, int columns) {
  std::vector<double> stops{0.0, arc};
  for (const Recess& x : recesses) {
    stops.push_back(x.from);
    stops.push_back(std::min(x.to, arc));
  }
  const std::vector<double> edges = edges_between(distinct_places(stops), columns);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double from = start_ + edges[i], to = start_ + edges[i + 1];
    const Vec2 normal(std::sin(to) - std::sin(from), std::cos(from) - std::cos(to));
    columns_.push_back({from, to - from, normal, 0.0, 0.0});
  }
}

void CarriedGrid::add_rows(const std::vector<Recess>& recesses, int rows) {
  std::vector<double> stops{track_, 1.0};
  for (const Recess& x : recesses)
    if (!x.open && x.width > track_) stops.push_back(x.width);
  const std::vector<double> edges = edges_between(distinct_places(stops), rows);
  for (std::size_t j = 0; j + 1 < edges.size(); ++j)
    shares_.push_back(edges[j + 1] - edges[j]);
}

void CarriedGrid::place_recesses(const std::vector<Recess>& recesses) {
  depths_.resize(columns_.size() * shares_.size());
  for (Index i = 0; i < cells(); ++i) {
    const double from = columns_[at(i)].from - start_, to = from + width(i);
    double inner = track_;
    for (Index j = 0; j < rows(); ++j) {
      const double middle = inner + 0.5 * share(j);
      inner += share(j);
      for (const Recess& x : recesses) {
        if (x.open || middle > x.width || from < x.from - near || to > x.to + near) continue;
        const auto at_place = [&](double place) {
          return std::lerp(x.depth_from, x.depth_to, (place - x.from) / (x.to - x.from));
        };
        depths_[at(i * rows() + j)] = {at_place(0.5 * (from + to)), at_place(from), at_place(to)};
      }
    }
  }
}

/// From the middle of a row to an edge at a given pressure: of a parabola, so that means count, whose
/// top is in the middle of the stretch of equal depth; beside a deeper one the pressure falls straight.
void CarriedGrid::find_distances() {
  for (Index i = 0; i < cells(); ++i) {
    const auto alike = [&](Index j, Index k) {
      return std::abs(depth(i, j).mean - depth(i, k).mean) <= near * clearance_;
    };
    double even = share(0);  // from the track, or the middle, and from the side
    for (Index j = 1; j < rows() && alike(j, 0); ++j)
      even += share(j);
    const bool all = even > 1.0 - track_ - near;
    const double top = !all ? infinity : track_ > 0.0 ? 0.5 * even : 1.0;
    const auto distance = [&](double of) { return 0.5 * of * (1.0 - of / (3.0 * top)); };
    columns_[at(i)].to_side = distance(shares_.back());
    columns_[at(i)].to_track = distance(shares_.front());
  }
}

double CarriedGrid::face(Index f) const {
  return f < cells() ? columns_[at(f)].from : columns_.back().from + columns_.back().width;
}

template <class T>
T CarriedGrid::gap_at(double angle, const T& ry, const T& rz) const {
  const Vec2 n = outward(angle);
  return T(clearance_ - lift_ * thinnest_.dot(n)) - (ry * n.x() + rz * n.y());
}

template <class T>
T CarriedGrid::gap_of(Index i, Index j, const T& ry, const T& rz) const {
  const Vec2 n = columns_[at(i)].normal / width(i);
  return T(clearance_ - lift_ * thinnest_.dot(n) + depth(i, j).mean) - (ry * n.x() + rz * n.y());
}

double CarriedGrid::gap(Index i, Index j, const Vec2& r) const {
  return gap_of(i, j, r.x(), r.y());
}

double CarriedGrid::gap(Index i, const Vec2& r) const {
  return clearance_ - (r + lift_ * thinnest_).dot(columns_[at(i)].normal) / width(i);
}

bool CarriedGrid::open(Index i, const Vec2& r) const {
  return gap(i, r) > 0.0 && gap_at(face(i), r.x(), r.y()) > 0.0 &&
         gap_at(face(i + 1), r.x(), r.y()) > 0.0;
}

double CarriedGrid::row_factor(Index i, Index j) const {
  const double slender = film_.radius / clearance_;
  return film_.source * film_.viscosity * slender * slender * slender * film_.length * width(i) *
         share(j);
}

/// Where a track is, the wall's motion alone displaces oil.
double CarriedGrid::pump(Index i, double fed, const FilmPoint& p, double part) const {
  const Vec2 W = p.w - p.slip * lever();
  const Vec2 place = p.r + lift_ * thinnest_;
  const Vec2 wedge = 0.5 * p.slip * Vec2(place.y(), -place.x());
  const double displaced = (W - track_ * wedge).dot(columns_[at(i)].normal);
  return film_.supply_pressure * film_.radius * film_.length * (fed + part * displaced);
}

/// Past a face of row j. left, right: null beyond the ends, where a full groove is.
template <class T>
auto CarriedGrid::along(Index f, Index j, const T& ry, const T& rz, const T& slip,
                        const Oil<T>* left, const Oil<T>* right) const -> Passed<T> {
  const T circle = gap_at(face(f), ry, rz);
  const double R = film_.radius, groove = film_.supply_pressure;
  T resistance[2] = {T(0.0), T(0.0)};
  double depths[2] = {0.0, 0.0};
  for (const int side : {0, 1}) {
    if ((side == 0 ? left : right) == nullptr) continue;
    const Index i = side == 0 ? f - 1 : f;
    depths[side] = side == 0 ? depth(i, j).to : depth(i, j).from;
    const T h = circle + T(depths[side]);
    const double unit = film_.source * film_.viscosity * R * R * 0.5 * width(i);
    resistance[side] = T(unit) / (h * h * h * factors_at(film_, slip, h).along);
  }
  const T whole = resistance[0] + resistance[1];
  Passed<T> out;
  out.mean = (depths[0] * resistance[0] + depths[1] * resistance[1]) / whole;
  const T full(1.0);
  const T carried = 0.5 * (positive(slip) * (left ? left->share : full) -
                           positive(-slip) * (right ? right->share : full));
  const T before = left ? left->pressure : T(groove), behind = right ? right->pressure : T(groove);
  out.driven = (before - behind) / whole;
  out.flow = carried * (circle + out.mean) + out.driven;
  for (const int side : {0, 1})
    out.torque[side] =
        depths[side] * resistance[side] * (out.driven - carried * (T(depths[side]) - out.mean));
  return out;
}

/// Between the rows j - 1 and j, m2/s. inner: null in the middle of the length, or at a track; outer:
/// null at the side.
template <class T>
T CarriedGrid::across(Index i, Index j, const T& slip, const Oil<T>* inner,
                      const Oil<T>* outer) const {
  if (inner == nullptr && track_ == 0.0) return T(0.0);
  const double unit = film_.source * film_.viscosity * 0.5 * film_.length;
  const auto resistance = [&](const Oil<T>& oil, double distance) {
    const T& h = oil.gap;
    return T(unit * distance) / (h * h * h * factors_at(film_, slip, h).across);
  };
  if (inner == nullptr)
    return (T(film_.supply_pressure) - outer->pressure) /
           resistance(*outer, columns_[at(i)].to_track);
  if (outer == nullptr) return inner->pressure / resistance(*inner, columns_[at(i)].to_side);
  return (inner->pressure - outer->pressure) /
         (resistance(*inner, 0.5 * share(j - 1)) + resistance(*outer, 0.5 * share(j)));
}

template <class T>
auto CarriedGrid::cell(Index i, Index j, const T& ry, const T& rz, const T& slip,
                       const std::array<T, around>& content) const -> Cell<T> {
  const Index last = cells() - 1, side = rows() - 1;
  const double part = share(j), angle = width(i), L = film_.length, R = film_.radius;
  const Oil<T> here = oil_of(gap_of(i, j, ry, rz), content[1]);
  const Oil<T> up = i > 0 ? oil_of(gap_of(i - 1, j, ry, rz), content[0]) : Oil<T>{};
  const Oil<T> down = i < last ? oil_of(gap_of(i + 1, j, ry, rz), content[2]) : Oil<T>{};
  const Oil<T> inner = j > 0 ? oil_of(gap_of(i, j - 1, ry, rz), content[3]) : Oil<T>{};
  const Oil<T> outer = j < side ? oil_of(gap_of(i, j + 1, ry, rz), content[4]) : Oil<T>{};
  const Passed<T> before = along(i, j, ry, rz, slip, i > 0 ? &up : nullptr, &here);
  const Passed<T> behind = along(i + 1, j, ry, rz, slip, &here, i < last ? &down : nullptr);
  Cell<T> c;
  c.in = before.flow;
  c.out = behind.flow;
  const double over = angle / (0.5 * L);
  c.inner = over * across(i, j, slip, j > 0 ? &inner : nullptr, &here);
  c.outer = over * across(i, j + 1, slip, &here, j < side ? &outer : nullptr);
  c.outflow = (1.0 / angle) * (c.out - c.in) + (1.0 / (part * angle)) * (c.outer - c.inner);
  const T pressed = R * L * part * (here.pressure - T(film_.supply_pressure));
  c.push[0] = pressed * columns_[at(i)].normal.x();
  c.push[1] = pressed * columns_[at(i)].normal.y();
  // wet is the mean of what comes in through one face and what goes out through the other
  const bool forwards = value(slip) >= 0.0;
  const bool from_groove = forwards ? i == 0 : i == last;
  const T entering = from_groove ? T(1.0) : forwards ? up.share : down.share;
  const double shear = 0.5 * film_.viscosity * R * R * R * L * angle * part;
  const FlowFactors<T> turbulent = factors_at(film_, slip, here.gap);
  c.drag = 0.5 * R * L * part * (before.torque[1] + behind.torque[0]) -
           shear * (slip * turbulent.shear * (entering + here.share) / here.gap);
  c.fed = T(0.0);
  if (i == 0) c.fed += part * (before.driven + 0.5 * slip * before.mean);
  if (i == last) c.fed -= part * (behind.driven + 0.5 * slip * behind.mean);
  if (j == 0) c.fed += c.inner;
  return c;
}

template CarriedGrid::Cell<double> CarriedGrid::cell(Index, Index, const double&, const double&,
                                                     const double&,
                                                     const std::array<double, around>&) const;
template CarriedGrid::Cell<Dual<5>> CarriedGrid::cell(Index, Index, const Dual<5>&, const Dual<5>&,
                                                      const Dual<5>&,
                                                      const std::array<Dual<5>, around>&) const;
template CarriedGrid::Cell<Dual<8>> CarriedGrid::cell(Index, Index, const Dual<8>&, const Dual<8>&,
                                                      const Dual<8>&,
                                                      const std::array<Dual<8>, around>&) const;

bool CarriedGrid::advance(const Vec2& r, double slip, double rate,
                          std::vector<double>& content) const {
  const double slender = film_.radius / clearance_;
  const double fast = std::max(std::abs(slip), 1.0);
  const double unit =
      film_.source * film_.viscosity * fast * slender * slender + film_.supply_pressure;
  return carried_oil::advance(*this, r, slip, rate, unit, content);
}

std::vector<double> CarriedGrid::balanced(const Vec2& r, double slip) const {
  return carried_oil::balanced(*this, r, slip, film_.supply_pressure);
}

Vec2 CarriedGrid::force_in_balance(const Vec2& r, double slip) const {
  return carried_oil::force_in_balance(*this, r, slip);
}

double CarriedGrid::balanced_cell(Index i, Index j, const Vec2& r, double slip) const {
  const auto find = [this](const Vec2& place, double at_slip) { return balanced(place, at_slip); };
  return last_.content(at(i * rows() + j), r, slip, find);
}

}  // namespace whirl::elements
