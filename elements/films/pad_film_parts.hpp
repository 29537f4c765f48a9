// What the solvers of PadFilm are made from: the film's geometry in Sommerfeld's angle, its elements,
// a stretch of film condensed to its two ends. Scalars T: double, or a Dual for exact slopes.
#pragma once
#include <elements/films/film_lanes.hpp>
#include <elements/films/pad_film.hpp>
#include <elements/films/turbulence.hpp>
#include <core/dual.hpp>

#include <array>
#include <cmath>

namespace whirl::elements::film_parts {

constexpr int p = film_lanes::order;
static_assert(p == PadFilm::order);
#include <elements/films/film_condense.inl>

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
struct Reference : film_lanes::Tables {
  Gauss<points> gauss;

  Reference() {
    std::array<std::array<double, points>, shapes> value, slope;
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

inline const Reference& reference() {
  static const Reference r;
  return r;
}

/// Position of the journal, and the Moebius map of the circle to Sommerfeld's angle: zeta = (z -
/// b)/(1 - conj(b) z).
template <class T>
struct Place {
  Pair<T> e, b;
  T spread, over_spread;  ///< 1 - |b|^2 and its inverse
  /// Of sqrt(1 - e^2). Near contact the grading of the elements goes no further: contact off the pad is
  /// possible.
  static constexpr double least = 0.02;
  bool graded_fully() const {
    return 1.0 - value(e.x) * value(e.x) - value(e.y) * value(e.y) > least * least;
  }

  Place(const T& ex, const T& ey) : e{ex, ey} {
    using std::sqrt;
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

/// PadMedium, seen at the points of the film.
template <class T>
class Through {
 public:
  static constexpr bool plain = false;
  double edge, carry;

  Through(const PadMedium& m, double start, double arc, const T& reynolds)
      : edge(m.edge),
        carry(m.carry),
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

/// A film whose oil is alike everywhere, several elements at a time.
template <class T>
Condensed<T> condense(const Place<T>& at, const Alike&, const T& from, const T& to, double beta,
                      int n);
template <>
Condensed<double> condense(const Place<double>&, const Alike&, const double&, const double&, double,
                           int);
template <>
Condensed<Dual<4>> condense(const Place<Dual<4>>&, const Alike&, const Dual<4>&, const Dual<4>&,
                            double, int);

template <class T, class Medium>
Condensed<T> condense(const Place<T>& at, const Medium& medium, const T& from, const T& to,
                      double beta, int n) {
  using std::cos;
  using std::sin;
  const T width = (1.0 / n) * (to - from), over_width = 1.0 / width;
  const Pair<T> turn{cos(width), sin(width)};
  std::array<Pair<T>, points> zeta = first_points(from, width);
  Condensed<T> c = {};
  for (int k = 0; k < n; ++k) {
    FilmElement<T> e =
        integrate_element(reference(), at, medium, width, over_width, turn, beta, zeta.data());
    drop_bubbles(e, c);
    append_element(e, k == 0, c);
  }
  return c;
}

}  // namespace whirl::elements::film_parts
