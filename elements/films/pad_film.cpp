#include <elements/films/pad_film.hpp>
#include <elements/films/pad_film_parts.hpp>
#include <core/contract.hpp>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace whirl::elements {

double log_viscosity_at(std::span<const double> knots, double place, double& slope) {
  WHIRL_EXPECTS(knots.size() >= 3);
  const std::size_t last = knots.size() - 1;
  const auto slope_at = [&](std::size_t i) {
    if (i == 0) return 0.5 * (-3.0 * knots[0] + 4.0 * knots[1] - knots[2]);
    if (i == last) return 0.5 * (3.0 * knots[last] - 4.0 * knots[last - 1] + knots[last - 2]);
    return 0.5 * (knots[i + 1] - knots[i - 1]);
  };
  const double intervals = static_cast<double>(last), x = place * intervals;
  const std::size_t i = static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, intervals - 1.0));
  const double s = x - static_cast<double>(i), rise = knots[i + 1] - knots[i];
  const double first = slope_at(i), second = slope_at(i + 1);
  const double c2 = 3.0 * rise - 2.0 * first - second, c3 = first + second - 2.0 * rise;
  slope = intervals * (first + s * (2.0 * c2 + 3.0 * s * c3));
  return knots[i] + s * (first + s * (c2 + s * c3));
}

using namespace film_parts;

PadFilm::PadFilm(double start, double arc, bool round, double beta, double points_on_arc)
    : start_(start),
      arc_(arc),
      beta_(beta),
      round_(round) {
  WHIRL_EXPECTS(arc > 0.0 && arc <= two_pi + 1e-9);
  WHIRL_EXPECTS(beta >= 0.0 && std::isfinite(beta));
  WHIRL_EXPECTS(points_on_arc > 0.0);
  // at the ends of short pads the pressure falls within 1/sqrt(beta): an element is at most three
  // of those
  const double asked = std::round(points_on_arc / points_of_element),
               needed = std::ceil(std::sqrt(beta) * arc / 3.0);
  elements_ = std::max(4, static_cast<int>(std::max(asked, needed)));
}

double PadFilm::smallest_clearance(const Vec2& e) const {
  const double turn = std::atan2(e.y(), e.x()) - start_,
               inside = turn - two_pi * std::floor(turn / two_pi);
  if (round_ || inside <= arc_) return 1.0 - e.norm();
  const auto at = [&](double a) { return 1.0 - e.x() * std::cos(a) - e.y() * std::sin(a); };
  return std::min(at(start_), at(start_ + arc_));
}

namespace {

/// The flow that a pressure must drive back where a film forms, and its slope by lengthening the film.
struct Needed {
  double flow = 0, by_length = 0;
};
Needed needed_at(const Place<double>& at, int end, double angle, double carry, double content) {
  const AtPoint<double> x(at, {std::cos(angle), std::sin(angle)});
  if (!(x.h > content)) return {};
  const double slope = (at.e.x * x.n.y - at.e.y * x.n.x) * x.stretch;  // dh/dgamma
  return {std::abs(carry) * (x.h - content), std::abs(carry) * (end == 0 ? -slope : slope)};
}

}  // namespace

/// The stretches where the source is positive, and how far their ends may move.
int PadFilm::cores(const Vec2& e, const Vec2& W, std::array<Ends, 2>& out) const {
  const Place<double> at(e.x(), e.y());
  const double begin = std::atan2(W.y(), W.x()) - 0.5 * pi - start_,
               u = begin - two_pi * std::floor(begin / two_pi);
  const auto gamma = [&](double theta) { return at.gamma(start_ + theta); };
  const auto stretch = [](double a, double b, double low, double high, bool held_a, bool held_b) {
    return Ends{a, b, a, b, low, high, held_a, held_b};
  };
  if (round_) {
    out[0] = stretch(gamma(u), gamma(u + pi), -infinity, infinity, false, false);
    return 1;
  }
  const double low = gamma(0.0), high = gamma(arc_);
  const bool first = u > pi,
             second = u < arc_;  // from the start of the pad; up to its end or ending on it
  int n = 0;
  const auto add = [&](const Ends& s) {
    // one of no length carries nothing: loads go with the third power of it, and more
    constexpr double least = 1e-9;  // of the pad
    if (s.b - s.a > least * (high - low)) out[static_cast<std::size_t>(n++)] = s;
  };
  if (first) {
    const bool whole = u - pi >= arc_;
    add(stretch(low, whole ? high : gamma(u - pi), low, second ? gamma(u) : high, true, whole));
  }
  if (second) {
    const bool whole = u + pi >= arc_;
    const double a = u > 0.0 ? gamma(u) : low, b = whole ? high : gamma(u + pi);
    add(stretch(a, b, first ? gamma(u - pi) : low, high, u <= 0.0, whole));
  }
  return n;
}

namespace {

/// What flows out at the ends of a stretch, less what must flow in where it forms of carried oil:
/// positive while the film is too short.
struct EndFlows {
  double out[2];
  double driven[2];        ///< by the pressure alone
  double needed_more = 0;  ///< slope of what must flow in
};
template <class Ends, class Medium>
EndFlows flows_at_ends(const Place<double>& at, const Vec2& W, const Medium& medium, const Ends& s,
                       const Condensed<double>& c) {
  EndFlows f;
  f.driven[0] = c.out_a.x * W.x() + c.out_a.y * W.y();
  f.driven[1] = c.out_b.x * W.x() + c.out_b.y * W.y();
  if constexpr (!Medium::plain) {
    const double p_a = s.held_a ? medium.edge : 0.0, p_b = s.held_b ? medium.edge : 0.0;
    f.driven[0] -= c.D_aa * p_a + c.D_ab * p_b;
    f.driven[1] -= c.D_ab * p_a + c.D_bb * p_b;
  }
  f.out[0] = f.driven[0];
  f.out[1] = f.driven[1];
  if constexpr (!Medium::plain)
    if (s.forms >= 0) {
      const Needed needed =
          needed_at(at, s.forms, s.forms == 0 ? s.a : s.b, medium.carry, s.content);
      f.out[s.forms] -= needed.flow;
      f.needed_more = needed.by_length;
    }
  return f;
}

/// Slopes by lengthening the film at an end.
struct EndSlopes {
  double flow[2];      ///< of its flow
  double pressure[2];  ///< at its old place
};
template <class Ends, class Medium>
EndSlopes slopes_at_ends(const Place<double>& at, const Vec2& W, const Medium& medium,
                         const Ends& s, const Condensed<double>& c, const EndFlows& f) {
  const double least = -1e-6 * W.norm();  // where two films could meet the source vanishes again
  EndSlopes slopes;
  for (int i = 0; i < 2; ++i) {
    const double angle = i == 0 ? s.a : s.b;
    const AtPoint<double> x(at, {std::cos(angle), std::sin(angle)});
    const double driven = std::max(0.0, f.driven[i]);
    if constexpr (Medium::plain)
      slopes.pressure[i] = driven * x.stretch / (x.h * x.h * x.h);
    else
      slopes.pressure[i] = driven / flow_at(x, medium);
    double source = W.x() * x.n.x + W.y() * x.n.y;
    if (i != s.forms) source = std::min(source, least);
    const double held_back = (i == 0 ? c.D_aa : c.D_bb) * slopes.pressure[i];
    slopes.flow[i] = source * x.stretch - held_back;
    if (i == s.forms)
      slopes.flow[i] = std::min(slopes.flow[i] - f.needed_more, least - 0.5 * held_back);
  }
  return slopes;
}

}  // namespace

/// Newton's method for the free ends. What flows out at an end is positive while the film is too
/// short.
template <class Medium>
bool PadFilm::settle(const Vec2& e, const Vec2& W, const Medium& medium, Ends& s, int elements,
                     double tolerance, int most_passes, int& passes) const {
  const Place<double> at(e.x(), e.y());
  double last[2] = {s.a, s.b}, last_out[2] = {0.0, 0.0};
  for (int k = 0; k < most_passes; ++k) {
    const Condensed<double> c = condense(at, medium, s.a, s.b, beta_, elements);
    ++passes;
    const EndFlows flows = flows_at_ends(at, W, medium, s, c);
    const double(&out)[2] = flows.out;
    const bool moves[2] = {!s.held_a && !(s.a <= s.low && out[0] >= 0.0),
                           !s.held_b && !(s.b >= s.high && out[1] >= 0.0)};
    if (!moves[0] && !moves[1]) return true;
    const EndSlopes slopes = slopes_at_ends(at, W, medium, s, c, flows);
    const double(&slope)[2] = slopes.flow, (&shift)[2] = slopes.pressure;
    double step[2] = {0.0, 0.0};
    if (moves[0] && moves[1]) {
      const double ab = -c.D_ab * shift[1], ba = -c.D_ab * shift[0];  // d out_a/d b, d out_b/d a
      const double det = slope[0] * slope[1] - ab * ba;
      step[0] = -(slope[1] * out[0] - ab * out[1]) / det;
      step[1] = -(slope[0] * out[1] - ba * out[0]) / det;
    } else {
      const int i = moves[0] ? 0 : 1;
      step[i] = -out[i] / slope[i];
    }
    if (!std::isfinite(step[0]) || !std::isfinite(step[1])) return false;
    const double length = s.b - s.a;
    double most = length;
    if (round_) most = std::min(most, 0.25 * (two_pi - length));
    double moved = 0.0;
    for (int i = 0; i < 2; ++i) {
      double& end = i == 0 ? s.a : s.b;
      const double outward = i == 0 ? -1.0 : 1.0, core = i == 0 ? s.core_a : s.core_b;
      double to = std::clamp(end + outward * std::min(step[i], most), s.low, s.high);
      // a step back beyond where it came from, or into the core: the root is between
      const double back = last[i] - end;
      const bool between = k > 0 && back != 0.0 && out[i] * last_out[i] < 0.0;
      if (between && (to - end) / back >= 1.0) to = end + back * out[i] / (out[i] - last_out[i]);
      const double beyond = outward * (to - core);
      if (beyond < 0.0 || (beyond == 0.0 && i == s.forms)) to = 0.5 * (end + core);
      moved = std::max(moved, std::abs(to - end));
      last[i] = end;
      last_out[i] = out[i];
      end = to;
    }
    if (moved < tolerance * length) return true;
  }
  return false;
}

template <class Medium>
void PadFilm::find(const Vec2& e, const Vec2& W, const Medium& m, Ends& s, int& passes) const {
  if (s.held_a && s.held_b) return;
  // from a little outside the core: at its ends there is no source to balance a flow
  const double beyond = std::min(0.15, 0.3 * (s.b - s.a));
  const double room_a = round_ ? 0.5 * (two_pi - (s.b - s.a)) : s.a - s.low,
               room_b = round_ ? room_a : s.high - s.b;
  if (!s.held_a) s.a -= std::min(beyond, 0.5 * room_a);
  if (!s.held_b) s.b += std::min(beyond, 0.5 * room_b);
  settle(e, W, m, s, std::max(2, elements_ / 3), 3e-3, 8, passes);
  // the load does not feel small errors of a free end, and Newton's error goes with the square of
  // the last step
  settle(e, W, m, s, elements_, 1e-4, 60, passes);
}

int PadFilm::solve(const Vec2& e, const Vec2& W, std::array<Ends, 2>& out, int& passes) const {
  int n = cores(e, W, out);
  for (int i = 0; i < n; ++i)
    find(e, W, Alike{}, out[static_cast<std::size_t>(i)], passes);
  if (n == 2 && out[0].b >= out[1].a) {  // films from both ends that meet are one
    out[0].b = out[1].b;
    out[0].held_b = true;
    n = 1;
  }
  return n;
}

/// The cores, and stretches that the pressure at the ends of the pad begins.
template <class Medium>
int PadFilm::fed_films(const Vec2& e, const Vec2& W, const Medium& m, Films& out) const {
  const Place<double> at(e.x(), e.y());
  const double low = at.gamma(start_), high = at.gamma(start_ + arc_);
  if (W.isZero(0.0)) {
    out[0] = {low, high, low, high, low, high, true, true};
    return 1;
  }
  std::array<Ends, 2> inner;
  const int cores_found = cores(e, W, inner);
  const auto length_from = [&](double angle) {
    // where the flow that the edge drives is turned round by the source against it
    const AtPoint<double> x(at, {std::cos(angle), std::sin(angle)});
    const double against = std::abs(W.x() * x.n.x + W.y() * x.n.y) * x.stretch;
    const double length = std::sqrt(2.0 * m.edge * flow_at(x, m) / std::max(against, 1e-300));
    return std::min(length, 0.25 * (high - low));
  };
  std::size_t n = 0;
  if (cores_found == 0 || !inner[0].held_a)
    out[n++] = {low, low + length_from(low), low, low, low, high, true, false};
  for (int i = 0; i < cores_found; ++i) {
    out[n] = inner[static_cast<std::size_t>(i)];
    out[n].low = low;
    out[n].high = high;
    ++n;
  }
  if (cores_found == 0 || !out[n - 1].held_b)
    out[n++] = {high - length_from(high), high, high, high, low, high, false, true};
  return static_cast<int>(n);
}

/// Stretches that meet are one: what either would hold alone is less than what both hold.
template <class Medium>
int PadFilm::solve_through(const Vec2& e, const Vec2& W, const Medium& m, Films& out,
                           int& passes) const {
  if (m.carry != 0.0) return carried_films(e, W, m, out, passes);
  if (m.edge == 0.0) {
    if (W.isZero(0.0)) return 0;
    std::array<Ends, 2> films;
    int n = cores(e, W, films);
    for (int i = 0; i < n; ++i)
      find(e, W, m, films[static_cast<std::size_t>(i)], passes);
    if (n == 2 && films[0].b >= films[1].a) {
      films[0].b = films[1].b;
      films[0].held_b = true;
      n = 1;
    }
    std::copy(films.begin(), films.end(), out.begin());
    return n;
  }
  int n = fed_films(e, W, m, out);
  for (int i = 0; i < n; ++i)
    if (Ends& s = out[static_cast<std::size_t>(i)]; !(s.held_a && s.held_b)) {
      // films at an edge are as long as they are guessed; others as without an edge
      if (s.core_b > s.core_a) find(e, W, m, s, passes);
      settle(e, W, m, s, elements_, 1e-4, 60, passes);
    }
  for (int i = 0; i + 1 < n;) {
    const auto here = static_cast<std::size_t>(i);
    Ends &s = out[here], &next = out[here + 1];
    if (s.b < next.a) {
      ++i;
      continue;
    }
    s.b = next.b;
    s.core_b = next.core_b;
    s.held_b = next.held_b;
    std::copy(out.begin() + i + 2, out.begin() + n, out.begin() + i + 1);
    --n;
    if (!(s.held_a && s.held_b)) settle(e, W, m, s, elements_, 1e-4, 60, passes);
    i = 0;
  }
  return n;
}

// for pad_film_carried.cpp
template bool PadFilm::settle(const Vec2&, const Vec2&, const Through<double>&, Ends&, int, double,
                              int, int&) const;
template void PadFilm::find(const Vec2&, const Vec2&, const Through<double>&, Ends&, int&) const;
template int PadFilm::fed_films(const Vec2&, const Vec2&, const Through<double>&, Films&) const;
template int PadFilm::solve_through(const Vec2&, const Vec2&, const Through<double>&, Films&,
                                    int&) const;

Vec2 PadFilm::load(const Vec2& e, const Vec2& W) const {
  WHIRL_EXPECTS(smallest_clearance(e) > 0.0);
  Vec2 G = Vec2::Zero();
  if (W.isZero(0.0)) return G;
  std::array<Ends, 2> films;
  int passes = 0;
  const int n = solve(e, W, films, passes);
  const Place<double> at(e.x(), e.y());
  for (int i = 0; i < n; ++i) {
    const Ends& s = films[static_cast<std::size_t>(i)];
    const Condensed<double> c = condense(at, Alike{}, s.a, s.b, beta_, elements_);
    G += Vec2(c.S00 * W.x() + c.S01 * W.y(), c.S01 * W.x() + c.S11 * W.y());
  }
  return G;
}

PadLoad PadFilm::load_and_slopes(const Vec2& e, const Vec2& W) const {
  WHIRL_EXPECTS(smallest_clearance(e) > 0.0);
  PadLoad out{Vec2::Zero(), Mat2::Zero(), Mat2::Zero()};
  if (W.isZero(0.0)) {
    out.by_W = mean_slope(e);
    return out;
  }
  using T = Dual<4>;  // e_x, e_y, ends a and b
  std::array<Ends, 2> films;
  int passes = 0;
  const int n = solve(e, W, films, passes);
  const Place<T> at(T::variable(e.x(), 0), T::variable(e.y(), 1));
  for (int i = 0; i < n; ++i) {
    const Ends& s = films[static_cast<std::size_t>(i)];
    const bool free_a = !s.held_a && s.a > s.low, free_b = !s.held_b && s.b < s.high;
    const T a = free_a ? T::variable(s.a, 2) : at.gamma(start_),
            b = free_b ? T::variable(s.b, 3) : at.gamma(start_ + arc_);
    const Condensed<T> c = condense(at, Alike{}, a, b, beta_, elements_);
    const T G[2] = {c.S00 * W.x() + c.S01 * W.y(), c.S01 * W.x() + c.S11 * W.y()};
    const T flow[2] = {c.out_a.x * W.x() + c.out_a.y * W.y(),
                       c.out_b.x * W.x() + c.out_b.y * W.y()};
    Mat2 by_ends, flow_by_ends = Mat2::Identity(), flow_by_e = Mat2::Zero(),
                  flow_by_W = Mat2::Zero();
    const bool free[2] = {free_a, free_b};
    const Pair<T> outflow[2] = {c.out_a, c.out_b};
    for (int k = 0; k < 2; ++k) {
      if (!free[k]) continue;
      flow_by_ends.row(k) = flow[k].g.tail<2>();
      flow_by_e.row(k) = flow[k].g.head<2>();
      flow_by_W.row(k) << outflow[k].x.v, outflow[k].y.v;
    }
    Mat2 S, S_e;
    S << c.S00.v, c.S01.v, c.S01.v, c.S11.v;
    for (int k = 0; k < 2; ++k) {
      out.G[k] += G[k].v;
      S_e.row(k) = G[k].g.head<2>();
      by_ends.row(k) = G[k].g.tail<2>();
    }
    const Mat2 follow = by_ends * flow_by_ends.inverse();
    out.by_e += S_e - follow * flow_by_e;
    out.by_W += S - follow * flow_by_W;
  }
  return out;
}

namespace {

/// 1/pi int G(n) n^T dphi. As many directions as the grid has points, counted from `first`, an angle
/// that turns with the machine.
template <class Load>
Mat2 mean_over_directions(int elements, double first, const Load& load_towards) {
  const int directions = std::max(16, PadFilm::points_of_element * elements);
  Mat2 C = Mat2::Zero();
  for (int k = 0; k < directions; ++k) {
    const double angle = first + two_pi * (k + 0.5) / directions;
    const Vec2 n(std::cos(angle), std::sin(angle));
    C += 2.0 / directions * load_towards(n) * n.transpose();
  }
  return C;
}

/// The pad's own start; a round one has none, and there e says where the directions begin.
double first_direction(bool round, double start, const Vec2& e) {
  if (!round) return start;
  return e.isZero(0.0) ? 0.0 : std::atan2(e.y(), e.x());
}

}  // namespace

Mat2 PadFilm::mean_slope(const Vec2& e) const {
  return mean_over_directions(elements_, first_direction(round_, start_, e),
                              [&](const Vec2& n) { return load(e, n); });
}

double PadFilm::shear(const Vec2& e, Vec2& gradient) const {
  WHIRL_EXPECTS(smallest_clearance(e) > 0.0);
  using T = Dual<2>;
  const Place<T> at(T::variable(e.x(), 0), T::variable(e.y(), 1));
  if (!at.graded_fully()) return shear_by_points(e, gradient);
  // Sommerfeld's angle has dtheta/h = dgamma/sqrt(1 - e^2)
  const T root = sqrt(1.0 - (at.e.x * at.e.x + at.e.y * at.e.y));
  const T angle = round_ ? T(two_pi) : at.gamma(start_ + arc_) - at.gamma(start_);
  const T sum = angle / root;
  gradient = sum.g;
  return sum.v;
}

/// Near contact: there the map has another eccentricity.
double PadFilm::shear_by_points(const Vec2& e, Vec2& gradient) const {
  // the integrands are waves of the angle: two panels of eight points are exact to rounding
  static const Gauss<8> gauss;
  const Place<double> at(e.x(), e.y());
  const double from = at.gamma(start_), half = 0.5 * (at.gamma(start_ + arc_) - from);
  double sum = 0.0;
  gradient.setZero();
  for (int panel = 0; panel < 2; ++panel)
    for (std::size_t q = 0; q < 8; ++q) {
      const double angle = from + (panel + gauss.x[q]) * half;
      const AtPoint<double> x(at, {std::cos(angle), std::sin(angle)});
      const double part = gauss.w[q] * half * x.stretch / x.h;
      sum += part;
      gradient += part / x.h * Vec2(x.n.x, x.n.y);
    }
  return sum;
}

Vec2 PadFilm::load(const Vec2& e, const Vec2& W, const PadMedium& medium, double& fed) const {
  WHIRL_EXPECTS(smallest_clearance(e) > 0.0);
  const Through<double> m(medium, start_, arc_, medium.reynolds);
  Films films;
  int passes = 0;
  const int n = solve_through(e, W, m, films, passes);
  const Place<double> at(e.x(), e.y());
  Vec2 G = Vec2::Zero();
  fed = 0.0;
  for (int i = 0; i < n; ++i) {
    const Ends& s = films[static_cast<std::size_t>(i)];
    const Condensed<double> c = condense(at, m, s.a, s.b, beta_, elements_);
    const double p_a = s.held_a ? m.edge : 0.0, p_b = s.held_b ? m.edge : 0.0;
    const Vec2 a(c.out_a.x, c.out_a.y), b(c.out_b.x, c.out_b.y);
    G += Vec2(c.S00 * W.x() + c.S01 * W.y(), c.S01 * W.x() + c.S11 * W.y()) + a * p_a + b * p_b;
    if (s.held_a) fed += c.D_aa * p_a + c.D_ab * p_b - a.dot(W);
    if (s.held_b) fed += c.D_ab * p_a + c.D_bb * p_b - b.dot(W);
  }
  return G;
}

PadFlowLoad PadFilm::load_and_slopes(const Vec2& e, const Vec2& W, const PadMedium& medium) const {
  WHIRL_EXPECTS(smallest_clearance(e) > 0.0);
  PadFlowLoad out;
  out.G.setZero();
  out.by_e.setZero();
  out.by_W.setZero();
  out.by_reynolds.setZero();
  if (W.isZero(0.0) && medium.edge == 0.0) {
    out.by_W = mean_slope(e, medium);
    return out;
  }
  using T = Dual<5>;  // e_x, e_y, ends a and b, Reynolds number
  Films films;
  int passes = 0;
  const int n =
      solve_through(e, W, Through<double>(medium, start_, arc_, medium.reynolds), films, passes);
  const Through<T> m(medium, start_, arc_, T::variable(medium.reynolds, 4));
  const Place<T> at(T::variable(e.x(), 0), T::variable(e.y(), 1));
  for (int i = 0; i < n; ++i) {
    const Ends& s = films[static_cast<std::size_t>(i)];
    const bool free[2] = {!s.held_a && s.a > s.low, !s.held_b && s.b < s.high};
    const T a = free[0] ? T::variable(s.a, 2) : at.gamma(start_),
            b = free[1] ? T::variable(s.b, 3) : at.gamma(start_ + arc_);
    const Condensed<T> c = condense(at, m, a, b, beta_, elements_);
    const double edge[2] = {s.held_a ? m.edge : 0.0, s.held_b ? m.edge : 0.0};
    const Pair<T> outflow[2] = {c.out_a, c.out_b};
    const T in[2] = {c.D_aa * edge[0] + c.D_ab * edge[1], c.D_ab * edge[0] + c.D_bb * edge[1]};
    const T G[2] = {
        c.S00 * W.x() + c.S01 * W.y() + outflow[0].x * edge[0] + outflow[1].x * edge[1],
        c.S01 * W.x() + c.S11 * W.y() + outflow[0].y * edge[0] + outflow[1].y * edge[1]};
    Mat2 by_ends, flow_by_ends = Mat2::Identity(), flow_by_W = Mat2::Zero();
    Matrix<2, 3> flow_by = Matrix<2, 3>::Zero(), G_by;  // e and Reynolds number
    const auto pick = [](const T& x) { return Eigen::RowVector3d(x.g[0], x.g[1], x.g[4]); };
    for (int k = 0; k < 2; ++k) {
      const T flow = outflow[k].x * W.x() + outflow[k].y * W.y() - in[k];
      if (k == 0 ? s.held_a : s.held_b) out.fed -= flow.v;
      if (!free[k]) continue;
      flow_by_ends.row(k) = flow.g.segment<2>(2).transpose();
      flow_by.row(k) = pick(flow);
      flow_by_W.row(k) << outflow[k].x.v, outflow[k].y.v;
    }
    Mat2 S;
    S << c.S00.v, c.S01.v, c.S01.v, c.S11.v;
    for (int k = 0; k < 2; ++k) {
      out.G[k] += G[k].v;
      G_by.row(k) = pick(G[k]);
      by_ends.row(k) = G[k].g.segment<2>(2).transpose();
    }
    const Mat2 follow = by_ends * flow_by_ends.inverse();
    const Matrix<2, 3> total = G_by - follow * flow_by;
    out.by_e += total.leftCols<2>();
    out.by_reynolds += total.col(2);
    out.by_W += S - follow * flow_by_W;
  }
  return out;
}

Mat2 PadFilm::mean_slope(const Vec2& e, const PadMedium& medium) const {
  double fed = 0.0;
  return mean_over_directions(elements_, first_direction(round_, start_, e),
                              [&](const Vec2& n) { return load(e, n, medium, fed); });
}

PadShear PadFilm::shear(const Vec2& e, const PadMedium& medium) const {
  WHIRL_EXPECTS(smallest_clearance(e) > 0.0);
  static const Gauss<8> gauss;
  constexpr int panels = 6;
  using T = Dual<3>;  // e_x, e_y, Reynolds number
  using std::cos;
  using std::sin;
  const Through<T> m(medium, start_, arc_, T::variable(medium.reynolds, 2));
  const Place<T> at(T::variable(e.x(), 0), T::variable(e.y(), 1));
  const T from = at.gamma(start_), width = (1.0 / panels) * (at.gamma(start_ + arc_) - from);
  T sum(0.0);
  for (int panel = 0; panel < panels; ++panel)
    for (std::size_t q = 0; q < 8; ++q) {
      const T angle = from + (panel + gauss.x[q]) * width;
      const AtPoint<T> x(at, {cos(angle), sin(angle)});
      sum += gauss.w[q] * width * x.stretch * m.at(x).shear / x.h;
    }
  return {sum.v, Vec2(sum.g[0], sum.g[1]), sum.g[2]};
}

namespace {

/// Pressures of one stretch of film: all of its unknowns, kept.
class StretchPressure {
 public:
  StretchPressure(const Place<double>& at, const Through<double>& m, double from, double to,
                  double beta, int n, const Vec2& W, const std::array<double, 2>& ends)
      : from_(from),
        width_((to - from) / n),
        n_(n),
        x_(VecX::Zero(n * p + 1)) {
    const Index size = x_.size();
    MatX A = MatX::Zero(size, size);
    VecX B = VecX::Zero(size);
    std::array<Pair<double>, points> zeta = first_points(from, width_);
    const Pair<double> turn{std::cos(width_), std::sin(width_)};
    for (int k = 0; k < n; ++k) {
      const FilmElement<double> e =
          integrate_element(reference(), at, m, width_, 1.0 / width_, turn, beta, zeta.data());
      std::size_t entry = 0;
      for (int i = 0; i < shapes; ++i) {
        const Pair<double>& b = e.B[static_cast<std::size_t>(i)];
        B[place(k, i)] += b.x * W.x() + b.y * W.y();
        for (int j = i; j < shapes; ++j, ++entry) {
          A(place(k, i), place(k, j)) += e.A[entry];
          if (j != i) A(place(k, j), place(k, i)) += e.A[entry];
        }
      }
    }
    const Index last = size - 1, inner = size - 2;
    x_[0] = ends[0];
    x_[last] = ends[1];
    const VecX known = A.col(0) * ends[0] + A.col(last) * ends[1];
    x_.segment(1, inner) = A.block(1, 1, inner, inner).ldlt().solve((B - known).segment(1, inner));
  }
  /// P and dP/dgamma.
  Pair<double> at(double angle) const {
    const double along = (angle - from_) / width_;
    const int k = std::clamp(static_cast<int>(std::floor(along)), 0, n_ - 1);
    const double x = along - k, t = 2.0 * x - 1.0;
    std::array<double, p + 1> legendre{1.0, t};
    for (std::size_t i = 2; i <= p; ++i) {
      const double m = static_cast<double>(i);
      legendre[i] = ((2 * m - 1) * t * legendre[i - 1] - (m - 1) * legendre[i - 2]) / m;
    }
    const double left = x_[place(k, bubbles)], right = x_[place(k, bubbles + 1)];
    Pair<double> out{left * (1.0 - x) + right * x, right - left};
    for (std::size_t i = 0; i < bubbles; ++i) {
      const double m = static_cast<double>(i) + 1.0, c = x_[place(k, static_cast<int>(i))];
      out.x += c * (legendre[i + 2] - legendre[i]) / (2.0 * (2 * m + 1));
      out.y += c * legendre[i + 1];
    }
    out.y /= width_;
    return out;
  }

 private:
  /// Shape i of element k among the unknowns: vertex, bubbles, vertex, ...
  static Index place(int k, int i) {
    if (i < bubbles) return k * p + 1 + i;
    return (k + i - bubbles) * p;
  }
  double from_, width_;
  int n_;
  VecX x_;
};

}  // namespace

/// What fills the gap where film has ruptured.
void PadFilm::carry_content(const Vec2& e, double carry, std::span<const double> theta,
                            PadProfile& out) const {
  const auto thickness = [&](double place) {
    return 1.0 - e.x() * std::cos(start_ + place) - e.y() * std::sin(start_ + place);
  };
  out.content.assign(theta.size(), thickness(carry > 0.0 ? 0.0 : arc_));
  for (std::size_t k = 0; k < theta.size(); ++k)
    for (const PadProfile::Stretch& s : out.films) {
      const bool passed = carry > 0.0 ? s.to <= theta[k] : s.from >= theta[k];
      if (!passed) continue;
      out.content[k] = thickness(carry > 0.0 ? s.to : s.from);
      if (carry < 0.0) break;
    }
}

PadProfile PadFilm::profile(const Vec2& e, const Vec2& W, const PadMedium& medium,
                            std::span<const double> theta) const {
  WHIRL_EXPECTS(smallest_clearance(e) > 0.0);
  const Through<double> m(medium, start_, arc_, medium.reynolds);
  Films films;
  int passes = 0;
  const int n = solve_through(e, W, m, films, passes);
  const Place<double> at(e.x(), e.y());
  PadProfile out;
  out.pressure.assign(theta.size(), 0.0);
  out.slope = out.pressure;
  for (int i = 0; i < n; ++i) {
    const Ends& s = films[static_cast<std::size_t>(i)];
    const std::array<double, 2> ends{s.held_a ? m.edge : 0.0, s.held_b ? m.edge : 0.0};
    const StretchPressure film(at, m, s.a, s.b, beta_, elements_, W, ends);
    const double shift = round_ ? two_pi : 0.0;
    for (std::size_t k = 0; k < theta.size(); ++k) {
      const double here = at.gamma(start_ + theta[k]);
      for (const double angle : {here - shift, here, here + shift}) {
        const double slack = 1e-12 * (s.b - s.a);
        if (angle < s.a - slack || angle > s.b + slack) continue;
        const AtPoint<double> x(at, {std::cos(angle), std::sin(angle)});
        const Pair<double> P = film.at(angle);
        out.pressure[k] = P.x;
        out.slope[k] = P.y / x.stretch;
        break;
      }
    }
    const Condensed<double> c = condense(at, m, s.a, s.b, beta_, elements_);
    out.films.push_back(
        {at.theta(s.a) - start_, at.theta(s.b) - start_, !s.held_a && s.a > s.low,
         !s.held_b && s.b < s.high,
         c.out_a.x * W.x() + c.out_a.y * W.y() - c.D_aa * ends[0] - c.D_ab * ends[1],
         c.out_b.x * W.x() + c.out_b.y * W.y() - c.D_ab * ends[0] - c.D_bb * ends[1]});
  }
  if (medium.carry != 0.0) carry_content(e, medium.carry, theta, out);
  return out;
}

}  // namespace whirl::elements
