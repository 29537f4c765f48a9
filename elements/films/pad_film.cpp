#include <elements/films/pad_film.hpp>
#include <elements/films/turbulence.hpp>
#include <core/contract.hpp>

#include <core/dual.hpp>

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

namespace {

constexpr int p = PadFilm::order;
constexpr int bubbles = p - 1;
constexpr int shapes = p + 1;  // bubbles, then the left and the right vertex
constexpr int points =
    p +
    1;  // Gauss points: one more than the order asks for halves the elements a given error takes
constexpr int entries = shapes * (shapes + 1) / 2;

/// Gauss-Legendre points and weights on [0, 1].
template <int n>
struct Gauss {
  std::array<double, n> x, w;
  Gauss() {
    for (std::size_t i = 0; i < n; ++i) {
      double t = std::cos(pi * (static_cast<double>(i) + 0.75) / (n + 0.5));
      double slope = 1.0;
      for (int newton = 0; newton < 20; ++newton) {
        double a = 1.0, b = t;
        for (int k = 2; k <= n; ++k) {
          const double next = ((2 * k - 1) * t * b - (k - 1) * a) / k;
          a = b;
          b = next;
        }
        slope = n * (a - t * b) / (1.0 - t * t);
        t -= b / slope;
      }
      x[i] = 0.5 * (1.0 - t);
      w[i] = 1.0 / ((1.0 - t * t) * slope * slope);
    }
  }
};

/// Shape functions at the Gauss points: integrated Legendre polynomials inside, linear ones at the
/// vertices.
struct Reference {
  Gauss<points> gauss;
  std::array<std::array<double, points>, shapes> value, slope;
  /// products of two (upper triangle by rows), of their slopes; shape functions; all times the
  /// weight of the point
  std::array<std::array<double, entries>, points> mass, stiffness;
  std::array<std::array<double, shapes>, points> source;

  Reference() {
    for (std::size_t q = 0; q < points; ++q) {
      const double x = gauss.x[q], t = 2.0 * x - 1.0;
      std::array<double, p + 1> legendre{1.0, t};
      for (std::size_t k = 2; k <= p; ++k) {
        const double m = static_cast<double>(k);
        legendre[k] = ((2 * m - 1) * t * legendre[k - 1] - (m - 1) * legendre[k - 2]) / m;
      }
      for (std::size_t k = 0; k < bubbles; ++k) {
        const double m = static_cast<double>(k) + 1.0;
        value[k][q] = (legendre[k + 2] - legendre[k]) / (2.0 * (2 * m + 1));
        slope[k][q] = legendre[k + 1];
      }
      value[bubbles][q] = 1.0 - x;
      slope[bubbles][q] = -1.0;
      value[bubbles + 1][q] = x;
      slope[bubbles + 1][q] = 1.0;
      std::size_t m = 0;
      for (std::size_t i = 0; i < shapes; ++i) {
        source[q][i] = gauss.w[q] * value[i][q];
        for (std::size_t j = i; j < shapes; ++j, ++m) {
          mass[q][m] = gauss.w[q] * value[i][q] * value[j][q];
          stiffness[q][m] = gauss.w[q] * slope[i][q] * slope[j][q];
        }
      }
    }
  }
};

const Reference& reference() {
  static const Reference r;
  return r;
}

template <class T>
struct Pair {
  T x, y;
};

/// Position of the journal, and the Moebius map of the circle to Sommerfeld's angle: zeta = (z -
/// b)/(1 - conj(b) z).
template <class T>
struct Place {
  Pair<T> e, b;
  T spread, over_spread;  ///< 1 - |b|^2 and its inverse

  Place(const T& ex, const T& ey) : e{ex, ey} {
    using std::sqrt;
    // near contact the grading of the elements goes no further: contact off the pad is possible
    constexpr double least = 0.02;  // of sqrt(1 - e^2)
    const T square = ex * ex + ey * ey;
    const double room = 1.0 - value(square);
    T scale(0.5);
    if (room > least * least)
      scale = 1.0 / (1.0 + sqrt(1.0 - square));
    else
      scale = std::sqrt((1.0 - least) / (1.0 + least)) / sqrt(square);
    b = {scale * ex, scale * ey};
    spread = 1.0 - (b.x * b.x + b.y * b.y);
    over_spread = 1.0 / spread;
  }
  T gamma(double theta) const {
    using std::atan2;
    const double c = std::cos(theta), s = std::sin(theta);
    return theta + 2.0 * atan2(b.x * s - b.y * c, 1.0 - (b.x * c + b.y * s));
  }
  double theta(double angle) const {
    const double c = std::cos(angle), s = std::sin(angle), bx = value(b.x), by = value(b.y);
    return angle + 2.0 * std::atan2(by * c - bx * s, 1.0 + bx * c + by * s);
  }
};

/// What the film needs at an angle gamma given by (cos, sin).
template <class T>
struct AtPoint {
  Pair<T> n;
  T h, stretch;  ///< clearance, dtheta/dgamma
  T flow;        ///< h^3 dgamma/dtheta
  AtPoint(const Place<T>& at, const Pair<T>& zeta) {
    const Pair<T> sum{zeta.x + at.b.x, zeta.y + at.b.y};
    const T re = 1.0 + at.b.x * zeta.x + at.b.y * zeta.y,
            im = at.b.x * zeta.y - at.b.y * zeta.x;  // 1 + conj(b) zeta
    const T square = re * re + im * im, inverse = 1.0 / square;
    n = {(sum.x * re + sum.y * im) * inverse, (sum.y * re - sum.x * im) * inverse};
    h = 1.0 - (at.e.x * n.x + at.e.y * n.y);
    stretch = at.spread * inverse;
    flow = h * h * h * square * at.over_spread;
  }
};

/// Oil that is alike everywhere.
struct Alike {
  static constexpr bool plain = true;
  static constexpr double edge = 0.0;
};

/// PadMedium, seen at the points of the film.
template <class T>
class Through {
 public:
  static constexpr bool plain = false;
  double edge;

  Through(const PadMedium& m, double start, double arc, const T& reynolds)
      : edge(m.edge),
        log_(m.log_viscosity),
        turbulent_(m.reynolds != 0.0),
        arc_(arc),
        middle_{std::cos(start + 0.5 * arc), std::sin(start + 0.5 * arc)},
        reynolds_(reynolds) {}

  struct Factors {
    T along, across, shear;
  };
  Factors at(const AtPoint<T>& x) const {
    const T fluidity = log_.empty() ? T(1.0) : fluidity_at(x.n);
    if (!turbulent_) return {fluidity, fluidity, T(1.0) / fluidity};
    const TurbulentFactors<T> f(reynolds_ * x.h * fluidity);
    return {fluidity / f.along, fluidity / f.across, f.shear / fluidity};
  }

 private:
  /// 1/mu
  T fluidity_at(const Pair<T>& n) const {
    using std::atan2;
    const T from_middle =
        atan2(middle_.x * n.y - middle_.y * n.x, middle_.x * n.x + middle_.y * n.y);
    const T place = (1.0 / arc_) * (from_middle + T(0.5 * arc_));
    double by_place = 0.0;
    const double f = std::exp(-log_viscosity_at(log_, value(place), by_place));
    return chain(place, f, -f * by_place);
  }

  std::span<const double> log_;
  bool turbulent_;
  double arc_;
  Pair<double> middle_;
  T reynolds_;
};

/// h^3 dgamma/dtheta through a medium.
template <class T, class Medium>
T flow_at(const AtPoint<T>& x, const Medium& m) {
  if constexpr (Medium::plain)
    return x.flow;
  else
    return x.flow * m.at(x).along;
}

/// A stretch of film condensed to its two ends, for the unit sources n_x and n_y.
template <class T>
struct Condensed {
  T S00, S01, S11;       ///< loads int P_i n_j dtheta with P = 0 at both ends
  Pair<T> out_a, out_b;  ///< flow out at the ends
  T D_aa, D_ab, D_bb;    ///< stiffness: flow in at an end for a pressure there
};

template <class T>
void add_load(Condensed<T>& c, const T& x, const T& y, const T& inverse) {
  const T ix = inverse * x;
  c.S00 += ix * x;
  c.S01 += ix * y;
  c.S11 += inverse * y * y;
}

/// One element: stiffness (upper triangle by rows) and loads of its shapes, the bubbles first, then
/// the shapes of its two ends.
template <class T>
struct FilmElement {
  std::array<T, entries> A;
  std::array<Pair<T>, shapes> B;
};

/// Integrates an element over its points zeta, which are turned on to those of the next one.
template <class T, class Medium>
FilmElement<T> integrate_element(const Place<T>& at, const Medium& medium, const T& width,
                                 const T& over_width, const Pair<T>& turn, double beta,
                                 std::array<Pair<T>, points>& zeta) {
  const Reference& ref = reference();
  FilmElement<T> e;
  e.A.fill(T(0.0));
  e.B.fill({T(0.0), T(0.0)});
  for (std::size_t q = 0; q < points; ++q) {
    const AtPoint<T> x(at, zeta[q]);
    const T arc = width * x.stretch;
    T flow = over_width * x.flow, leak = beta * (x.h * x.h * x.h) * arc;
    if constexpr (!Medium::plain) {
      const auto f = medium.at(x);
      flow = flow * f.along;
      leak = leak * f.across;
    }
    const T sx = arc * x.n.x, sy = arc * x.n.y;
    for (std::size_t m = 0; m < entries; ++m)
      e.A[m] += ref.stiffness[q][m] * flow + ref.mass[q][m] * leak;
    for (std::size_t i = 0; i < shapes; ++i) {
      e.B[i].x += ref.source[q][i] * sx;
      e.B[i].y += ref.source[q][i] * sy;
    }
    const Pair<T> z = zeta[q];
    zeta[q] = {z.x * turn.x - z.y * turn.y, z.x * turn.y + z.y * turn.x};
  }
  return e;
}

/// Eliminates the bubbles of an element.
template <class T>
void drop_bubbles(FilmElement<T>& e, Condensed<T>& c) {
  for (std::size_t i = 0, row = 0; i < bubbles; row += shapes - i, ++i) {
    const T inverse = 1.0 / e.A[row];
    add_load(c, e.B[i].x, e.B[i].y, inverse);
    std::size_t below = row + shapes - i;
    for (std::size_t j = 1; j < shapes - i; ++j) {
      const T factor = e.A[row + j] * inverse;
      for (std::size_t m = j; m < shapes - i; ++m)
        e.A[below++] -= factor * e.A[row + m];
      e.B[i + j].x -= factor * e.B[i].x;
      e.B[i + j].y -= factor * e.B[i].y;
    }
  }
}

/// Joins an element to what is condensed so far, and eliminates the vertex between them.
template <class T>
void append_element(const FilmElement<T>& e, bool first, Condensed<T>& c) {
  const T &ll = e.A[entries - 3], &lr = e.A[entries - 2], &rr = e.A[entries - 1];
  const Pair<T>&left = e.B[bubbles], &right = e.B[bubbles + 1];
  if (first) {
    c.D_aa = ll;
    c.D_ab = lr;
    c.D_bb = rr;
    c.out_a = left;
    c.out_b = right;
    return;
  }
  const T inverse = 1.0 / (c.D_bb + ll), x = c.out_b.x + left.x, y = c.out_b.y + left.y;
  add_load(c, x, y, inverse);
  const T back = c.D_ab * inverse, ahead = lr * inverse;
  c.out_a.x -= back * x;
  c.out_a.y -= back * y;
  c.out_b = {right.x - ahead * x, right.y - ahead * y};
  c.D_aa -= back * c.D_ab;
  c.D_bb = rr - ahead * lr;
  c.D_ab = -(back * lr);
}

/// (cos, sin) of the points of the first of elements of a width from an angle on.
template <class T>
std::array<Pair<T>, points> first_points(const T& from, const T& width) {
  using std::cos;
  using std::sin;
  const Reference& ref = reference();
  const auto at_angle = [](const T& angle) { return Pair<T>{cos(angle), sin(angle)}; };
  const Pair<T> middle = at_angle(from + 0.5 * width);
  std::array<Pair<T>, points> zeta;
  for (std::size_t q = 0; q < points / 2; ++q) {  // points lie in pairs about the middle
    const Pair<T> away = at_angle((0.5 - ref.gauss.x[q]) * width);
    const T cc = middle.x * away.x, ss = middle.y * away.y, sc = middle.y * away.x,
            cs = middle.x * away.y;
    zeta[q] = {cc + ss, sc - cs};
    zeta[points - 1 - q] = {cc - ss, sc + cs};
  }
  zeta[points / 2] = middle;
  return zeta;
}

template <class T, class Medium>
Condensed<T> condense(const Place<T>& at, const Medium& medium, const T& from, const T& to,
                      double beta, int n) {
  using std::cos;
  using std::sin;
  const T width = (1.0 / n) * (to - from), over_width = 1.0 / width;
  const Pair<T> turn{cos(width), sin(width)};
  std::array<Pair<T>, points> zeta = first_points(from, width);
  Condensed<T> c{0.0, 0.0, 0.0, {0.0, 0.0}, {0.0, 0.0}, 0.0, 0.0, 0.0};
  for (int k = 0; k < n; ++k) {
    FilmElement<T> e = integrate_element(at, medium, width, over_width, turn, beta, zeta);
    drop_bubbles(e, c);
    append_element(e, k == 0, c);
  }
  return c;
}

}  // namespace

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
  if (first) {
    const bool whole = u - pi >= arc_;
    out[0] = stretch(low, whole ? high : gamma(u - pi), low, second ? gamma(u) : high, true, whole);
    n = 1;
  }
  if (second) {
    const bool whole = u + pi >= arc_;
    const double a = u > 0.0 ? gamma(u) : low, b = whole ? high : gamma(u + pi);
    out[static_cast<std::size_t>(n++)] =
        stretch(a, b, first ? gamma(u - pi) : low, high, u <= 0.0, whole);
  }
  return n;
}

/// Newton's method for the free ends. What flows out at an end is positive while the film is too
/// short.
template <class Medium>
bool PadFilm::settle(const Vec2& e, const Vec2& W, const Medium& medium, Ends& s, int elements,
                     double tolerance, int most_passes, int& passes) const {
  const Place<double> at(e.x(), e.y());
  double last[2] = {s.a, s.b}, last_out[2] = {0.0, 0.0};
  const double least = -1e-6 * W.norm();  // where two films could meet the source vanishes again
  for (int k = 0; k < most_passes; ++k) {
    const Condensed<double> c = condense(at, medium, s.a, s.b, beta_, elements);
    ++passes;
    double out[2] = {c.out_a.x * W.x() + c.out_a.y * W.y(), c.out_b.x * W.x() + c.out_b.y * W.y()};
    if constexpr (!Medium::plain) {
      const double p_a = s.held_a ? medium.edge : 0.0, p_b = s.held_b ? medium.edge : 0.0;
      out[0] -= c.D_aa * p_a + c.D_ab * p_b;
      out[1] -= c.D_ab * p_a + c.D_bb * p_b;
    }
    const bool moves[2] = {!s.held_a && !(s.a <= s.low && out[0] >= 0.0),
                           !s.held_b && !(s.b >= s.high && out[1] >= 0.0)};
    if (!moves[0] && !moves[1]) return true;
    double slope[2],
        shift[2];  // of the flow by lengthening; pressure at the old end by lengthening
    for (int i = 0; i < 2; ++i) {
      const double angle = i == 0 ? s.a : s.b;
      const AtPoint<double> x(at, {std::cos(angle), std::sin(angle)});
      if constexpr (Medium::plain)
        shift[i] = std::max(0.0, out[i]) * x.stretch / (x.h * x.h * x.h);
      else
        shift[i] = std::max(0.0, out[i]) / flow_at(x, medium);
      const double source = std::min(W.x() * x.n.x + W.y() * x.n.y, least);
      slope[i] = source * x.stretch - (i == 0 ? c.D_aa : c.D_bb) * shift[i];
    }
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
      if (outward * (to - core) < 0.0) to = 0.5 * (end + core);
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

// flattened: beside the other media the compiler would leave calls in it, at half its speed more
[[gnu::flatten]] PadLoad PadFilm::load_and_slopes(const Vec2& e, const Vec2& W) const {
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
  // in Sommerfeld's angle the integrands are a constant and a wave: two panels of eight points are
  // exact to rounding
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
          integrate_element(at, m, width_, 1.0 / width_, turn, beta, zeta);
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
    out.films.push_back({at.theta(s.a) - start_, at.theta(s.b) - start_, !s.held_a && s.a > s.low,
                         !s.held_b && s.b < s.high});
  }
  return out;
}

}  // namespace whirl::elements
