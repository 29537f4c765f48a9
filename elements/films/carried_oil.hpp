// What all films whose oil is followed have in common (carried_film.hpp, carried_grid.hpp): how full
// cells take pressure, and oil that moves on by Newton's method. Internal to elements/films.
#pragma once
#include <elements/films/carried_film.hpp>
#include <elements/films/turbulence.hpp>
#include <core/dual.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace whirl::elements::carried_oil {

inline constexpr double bulk = CarriedPad::bulk, mixed = CarriedPad::mixed;

inline Vec2 outward(double a) { return Vec2(std::cos(a), std::sin(a)); }

/// Of a cell with m/h - 1 = x: its pressure, and the share that the journal carries on, which grows
/// no further once the bubbles are gone; with slopes.
struct Filling {
  double pressure, by_pressure, share, by_share;
};
inline Filling filling(double x) {
  if (x <= 0.0) return {0.0, 0.0, 1.0 + x, 1.0};
  const double part = x / mixed;
  if (part < 1.0)
    return {0.5 * bulk * x * part, bulk * part, 1.0 + x * (1.0 - 0.5 * part), 1.0 - part};
  return {bulk * (x - 0.5 * mixed), bulk, 1.0 + 0.5 * mixed, 0.0};
}

/// Of a cell.
template <class T>
struct Oil {
  T gap, share, pressure;
};
template <class T>
Oil<T> oil_of(const T& gap, const T& content) {
  const T share = content / gap;
  const Filling f = filling(value(share) - 1.0);
  return {gap, chain(share, f.share, f.by_share), chain(share, f.pressure, f.by_pressure)};
}

/// m/h - 1 in terms of an unknown for which empty, mixed and full oil are of one size, and its slope.
/// edge: where oil is full, positive.
struct Unknown {
  double edge;
  double filled(double u) const {
    if (u <= 0.0) return u;
    return u < edge ? mixed * u / edge : mixed + 0.5 * mixed * (u - edge) / edge;
  }
  double slope(double u) const {
    if (u <= 0.0) return 1.0;
    return u < edge ? mixed / edge : 0.5 * mixed / edge;
  }
  double of(double x) const {
    if (x <= 0.0) return x;
    return x < mixed ? edge * x / mixed : edge + 2.0 * edge * (x - mixed) / mixed;
  }
};

inline double positive(double x) { return std::max(x, 0.0); }
template <int N>
Dual<N> positive(const Dual<N>& x) {
  return x.v > 0.0 ? x : Dual<N>(0.0);
}
inline double size_of(double x) { return std::abs(x); }
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

/// A cell among its neighbours: that of a column and a row, or -1 beyond the edges.
template <class Pad>
Index neighbour(const Pad& pad, Index column, Index row, const CellStep& step) {
  const Index i = column + step.column, j = row + step.row;
  if (i < 0 || i >= pad.cells() || j < 0 || j >= pad.rows()) return -1;
  return i * pad.rows() + j;
}

/// The balances of all cells as a band: columns one after the other.
class Band {
 public:
  Band(std::size_t size, std::size_t half) : size_(size), half_(half), a_(size * (2 * half + 1)) {}
  double& entry(std::size_t row, std::size_t column) {
    return a_[row * (2 * half_ + 1) + half_ + column - row];
  }
  void clear() { std::fill(a_.begin(), a_.end(), 0.0); }
  /// x := A^-1 x, without exchanges; A is used up.
  void solve(std::vector<double>& x) {
    for (std::size_t k = 0; k < size_; ++k) {
      const std::size_t end = std::min(size_, k + half_ + 1);
      for (std::size_t i = k + 1; i < end; ++i) {
        if (entry(i, k) == 0.0) continue;
        const double share = entry(i, k) / entry(k, k);
        for (std::size_t c = k + 1; c < end; ++c)
          entry(i, c) -= share * entry(k, c);
        x[i] -= share * x[k];
      }
    }
    for (std::size_t k = size_; k-- > 0;) {
      const std::size_t end = std::min(size_, k + half_ + 1);
      for (std::size_t c = k + 1; c < end; ++c)
        x[k] -= entry(k, c) * x[c];
      x[k] /= entry(k, k);
    }
  }

 private:
  std::size_t size_, half_;
  std::vector<double> a_;
};

/// Residual and tangent, in the unknowns, of (m - old) rate + outflow = 0.
template <class Pad>
void balance(const Pad& pad, const Vec2& r, double slip, double rate,
             const std::vector<double>& old, const std::vector<double>& content,
             const std::vector<double>& slope, std::vector<double>& residual, Band& band) {
  using Local = Dual<Pad::around>;
  band.clear();
  for (Index i = 0; i < pad.cells(); ++i)
    for (Index j = 0; j < pad.rows(); ++j) {
      const std::size_t own = at(i * pad.rows() + j);
      std::array<Local, Pad::around> q;
      std::array<Index, Pad::around> other;
      for (std::size_t k = 0; k < q.size(); ++k) {
        other[k] = neighbour(pad, i, j, Pad::steps[k]);
        q[k] = Local::variable(content[other[k] < 0 ? own : at(other[k])], static_cast<int>(k));
      }
      const Local outflow = pad.cell(i, j, Local(r.x()), Local(r.y()), Local(slip), q).outflow;
      residual[own] = outflow.v + rate * (content[own] - old[own]);
      for (std::size_t k = 0; k < q.size(); ++k) {
        if (other[k] < 0) continue;
        const double by = outflow.g[static_cast<Index>(k)] + (at(other[k]) == own ? rate : 0.0);
        band.entry(own, at(other[k])) = by * slope[at(other[k])];
      }
    }
}

/// Moves the contents on by a step of implicit Euler of the length 1/rate, s, at whose end the journal
/// stands at r. Newton's method, by smaller steps where the corners catch it. Unknown: the pressure in
/// a unit of its own where the cell is full, the share less one where it is not, so that both sides of
/// the corner are of one size. unit: a pressure of the size of the film's, Pa. False: no solution was
/// found.
template <class Pad>
bool advance(const Pad& pad, const Vec2& r, double slip, double rate, double unit,
             std::vector<double>& content) {
  const std::vector<double> old = content;
  const std::size_t n = content.size();
  const Unknown unknown{0.5 * bulk * mixed / unit};
  const double tolerance = 1e-10 + 1e-11 * unknown.edge;  // above the rounding of the contents
  std::vector<double> u(n), gap(n), slope(n), residual(n);
  Band band(n, at(pad.rows()));
  for (std::size_t k = 0; k < n; ++k) {
    gap[k] = pad.gap(static_cast<Index>(k) / pad.rows(), static_cast<Index>(k) % pad.rows(), r);
    u[k] = unknown.of(content[k] / gap[k] - 1.0);
  }
  constexpr int bold = 25, most = 100;
  for (int pass = 0; pass < most; ++pass) {
    for (std::size_t k = 0; k < n; ++k) {
      content[k] = gap[k] * (1.0 + unknown.filled(u[k]));
      slope[k] = gap[k] * unknown.slope(u[k]);
    }
    balance(pad, r, slip, rate, old, content, slope, residual, band);
    band.solve(residual);
    double change = 0.0;
    for (std::size_t k = n; k-- > 0;)
      change = std::max(change, std::abs(residual[k]) / std::max(1.0, std::abs(u[k])));
    if (!std::isfinite(change)) return false;
    for (std::size_t k = 0; k < n; ++k)
      u[k] = std::max(u[k] - (pass < bold ? 1.0 : 0.4) * residual[k], -1.0 + 1e-6);
    if (change < tolerance) return true;
  }
  return false;
}

/// The contents at which nothing changes with the journal still at r; at rest, slip and supply zero:
/// full. NaN where the journal stands outside the film, or none are found.
template <class Pad>
std::vector<double> balanced(const Pad& pad, const Vec2& r, double slip, double supply) {
  const std::size_t n = at(pad.cells() * pad.rows());
  std::vector<double> content(n);
  for (std::size_t k = 0; k < n; ++k) {
    content[k] = pad.gap(static_cast<Index>(k) / pad.rows(), static_cast<Index>(k) % pad.rows(), r);
    if (!(content[k] > 0.0)) return std::vector<double>(n, nan);
  }
  if (slip == 0.0 && supply == 0.0) return content;
  const double fast = std::max(std::abs(slip), 1.0);
  const std::vector<double> full = content;
  if (pad.advance(r, slip, 1e-9 * fast, content)) return content;
  // by way of the motion towards it, in ever longer steps
  content = full;
  for (double rate = 1e3 * fast; rate > 1e-9 * fast; rate *= 0.25)
    if (!pad.advance(r, slip, rate, content)) return std::vector<double>(n, nan);
  return content;
}

/// Force of the oil in balance on a journal at r, N; NaN where there is no balance.
template <class Pad>
Vec2 force_in_balance(const Pad& pad, const Vec2& r, double slip) {
  const std::vector<double> content = pad.balanced(r, slip);
  Vec2 sum = Vec2::Zero();
  for (Index i = 0; i < pad.cells(); ++i)
    for (Index j = 0; j < pad.rows(); ++j) {
      std::array<double, at(Pad::around)> around;
      for (std::size_t k = 0; k < around.size(); ++k) {
        const Index other = neighbour(pad, i, j, Pad::steps[k]);
        around[k] = content[at(other < 0 ? i * pad.rows() + j : other)];
      }
      const auto cell = pad.cell(i, j, r.x(), r.y(), slip, around);
      sum -= Vec2(cell.push[0], cell.push[1]);
    }
  return sum;
}

}  // namespace whirl::elements::carried_oil
