#include <analysis/transient/orbit_width.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Value and place x in [0, 4] of a polynomial's stationary point.
struct Vertex {
  double x, value;
};

/// Of the quartic through f at 0, 1, .. 4, the maximum nearest to its largest value.
Vertex top_of(const std::array<double, OrbitWidth::looks>& f) {
  constexpr std::size_t n = OrbitWidth::looks;
  const auto top = static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin());
  const Vertex look{static_cast<double>(top), f[top]};
  std::array<double, n> c = f;  // Newton's form
  for (std::size_t order = 1; order < n; ++order)
    for (std::size_t k = n - 1; k >= order; --k)
      c[k] = (c[k] - c[k - 1]) / static_cast<double>(order);
  double x = look.x;
  for (int again = 0; again < 6; ++again) {
    double p = c[n - 1], p1 = 0, p2 = 0;
    for (std::size_t k = n - 1; k-- > 0;) {
      const double d = x - static_cast<double>(k);
      p2 = p2 * d + 2.0 * p1;
      p1 = p1 * d + p;
      p = p * d + c[k];
    }
    if (!(p2 < 0.0)) return look;
    const double next =
        std::clamp(x - p1 / p2, std::max(0.0, look.x - 1.0), std::min(4.0, look.x + 1.0));
    const bool met = std::abs(next - x) < 1e-6;
    x = next;
    if (met) break;
  }
  double p = c[n - 1];
  for (std::size_t k = n - 1; k-- > 0;)
    p = p * (x - static_cast<double>(k)) + c[k];
  return p > look.value ? Vertex{x, p} : look;
}

/// What the values do not exceed between looks: the largest, and twice what the parabola through it
/// and its neighbours rises above it.
double reach_of(const std::array<double, OrbitWidth::looks>& f) {
  const auto top = static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin());
  const std::size_t middle = std::clamp<std::size_t>(top, 1, f.size() - 2);
  const double slope = 0.5 * (f[middle + 1] - f[middle - 1]);
  const double curvature = 2.0 * f[middle] - f[middle + 1] - f[middle - 1];
  if (!(std::abs(slope) <= 2.0 * curvature)) return f[top];
  const double vertex = curvature > 0.0 ? f[middle] + 0.5 * slope * slope / curvature : f[middle];
  return f[top] + 2.0 * std::max(0.0, vertex - f[top]);
}

/// Unit vectors of the directions.
template <std::size_t N>
const std::array<Vec2, N>& units() {
  static const auto all = [] {
    std::array<Vec2, N> u;
    for (std::size_t k = 0; k < N; ++k) {
      const double angle = pi * static_cast<double>(k) / static_cast<double>(N);
      u[k] = Vec2(std::cos(angle), std::sin(angle));
    }
    return u;
  }();
  return all;
}

}  // namespace

OrbitWidth::Extent OrbitWidth::at(const Vec2& u, double t) {
  Extent e;
  for (std::size_t k = 0; k < directions; ++k) {
    e.low[k] = e.high[k] = units<directions>()[k].dot(u);
    e.t_low[k] = e.t_high[k] = t;
  }
  e.empty = false;
  return e;
}

void OrbitWidth::begin(const Vec2& u, double t, double phi) {
  now_ = at(u, t);
  before_ = {};
  turn_began_ = phi;
  largest_ = {0.0, t};
}

void OrbitWidth::step(std::span<const Vec2, looks> seen, double t0, double t1) {
  const auto time_of = [&](double x) { return t0 + (t1 - t0) * x / 4.0; };
  for (std::size_t k = 0; k < directions; ++k) {
    const Vec2& direction = units<directions>()[k];
    std::array<double, looks> up, down;
    for (std::size_t i = 0; i < looks; ++i) {
      up[i] = direction.dot(seen[i]);
      down[i] = -up[i];
    }
    if (reach_of(up) > now_.high[k])
      if (const Vertex v = top_of(up); v.value > now_.high[k]) {
        now_.high[k] = v.value;
        now_.t_high[k] = time_of(v.x);
      }
    if (reach_of(down) > -now_.low[k])
      if (const Vertex v = top_of(down); v.value > -now_.low[k]) {
        now_.low[k] = -v.value;
        now_.t_low[k] = time_of(v.x);
      }
  }
}

void OrbitWidth::turned_to(double phi, const Vec2& u, double t) {
  if (std::abs(phi - turn_began_) < two_pi) return;
  largest_ = largest();
  before_ = now_;
  now_ = at(u, t);
  turn_began_ = phi;
}

OrbitWidth::Extent OrbitWidth::together(const Extent& a, const Extent& b) {
  if (a.empty) return b;
  Extent e = b;
  for (std::size_t k = 0; k < directions; ++k) {
    if (a.high[k] > b.high[k]) {
      e.high[k] = a.high[k];
      e.t_high[k] = a.t_high[k];
    }
    if (a.low[k] < b.low[k]) {
      e.low[k] = a.low[k];
      e.t_low[k] = a.t_low[k];
    }
  }
  return e;
}

// The square of the width of an ellipse is A + B cos 2a + C sin 2a with the direction a: its maximum
// from the widest direction and its two neighbours. No convex figure is wider between directions than
// the widest of them over the cosine of half the angle between two.
OrbitWidth::Width OrbitWidth::width_of(const Extent& e) {
  std::array<double, directions> square;
  for (std::size_t k = 0; k < directions; ++k) {
    const double width = e.high[k] - e.low[k];
    square[k] = width * width;
  }
  const auto top =
      static_cast<std::size_t>(std::max_element(square.begin(), square.end()) - square.begin());
  const double between = pi / static_cast<double>(directions);
  const double here = square[top], next = square[(top + 1) % directions],
               last = square[(top + directions - 1) % directions];
  const double b = (here - 0.5 * (next + last)) / (1.0 - std::cos(2.0 * between));
  const double c = 0.5 * (next - last) / std::sin(2.0 * between);
  const double bound = here / std::pow(std::cos(0.5 * between), 2);
  const double widest = std::clamp(here - b + std::hypot(b, c), here, bound);
  return {0.5 * std::sqrt(widest), std::max(e.t_high[top], e.t_low[top])};
}

OrbitWidth::Width OrbitWidth::largest() const {
  const Width w = width_of(together(before_, now_));
  return w.half > largest_.half ? w : largest_;
}

double OrbitWidth::amplitude() const { return largest().half; }

double OrbitWidth::time() const { return largest().time; }

void OrbitWidth::save(OutArchive& out) const {
  for (const Extent* e : {&before_, &now_}) {
    out.put_count(e->empty ? 1 : 0);
    for (const auto* values : {&e->low, &e->high, &e->t_low, &e->t_high})
      for (const double x : *values)
        out.put(x);
  }
  for (const double x : {turn_began_, largest_.half, largest_.time})
    out.put(x);
}

void OrbitWidth::restore(InArchive& in) {
  for (Extent* e : {&before_, &now_}) {
    e->empty = in.count() != 0;
    for (auto* values : {&e->low, &e->high, &e->t_low, &e->t_high})
      for (double& x : *values)
        x = in.number();
  }
  for (double* x : {&turn_began_, &largest_.half, &largest_.time})
    *x = in.number();
}

}  // namespace whirl::analysis
