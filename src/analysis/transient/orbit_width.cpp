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
  const auto better = [&](double p) { return p > look.value ? Vertex{x, p} : look; };
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
    if (next == x) return better(p);  // it still rises at an end
    const bool met = std::abs(next - x) < 1e-6;
    x = next;
    if (met) break;
  }
  double p = c[n - 1];
  for (std::size_t k = n - 1; k-- > 0;)
    p = p * (x - static_cast<double>(k)) + c[k];
  return better(p);
}

/// Unit vectors of the directions, a row each.
template <int N>
const Eigen::Matrix<double, N, 2>& units() {
  static const auto all = [] {
    Eigen::Matrix<double, N, 2> u;
    for (int k = 0; k < N; ++k)
      u.row(k) << std::cos(pi * k / N), std::sin(pi * k / N);
    return u;
  }();
  return all;
}

}  // namespace

OrbitWidth::Extent OrbitWidth::at(const Vec2& u, double t) {
  Extent e;
  for (std::size_t k = 0; k < directions; ++k) {
    e.low[k] = e.high[k] = units<directions>().row(static_cast<Index>(k)).dot(u);
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
  using Widths = Eigen::Array<double, directions, 1>;
  Eigen::Matrix<double, 2, looks> path;
  for (std::size_t i = 0; i < looks; ++i)
    path.col(static_cast<Index>(i)) = seen[i];
  const Eigen::Matrix<double, directions, looks> projections = units<directions>() * path;
  const Widths most = projections.rowwise().maxCoeff(), least = projections.rowwise().minCoeff();
  // a path of four looks a period passes the largest of them by a fifth of what it spans
  const Widths beyond = 0.25 * (most - least);
  const Eigen::Map<Widths> high(now_.high.data()), low(now_.low.data());
  if (!((most + beyond > high) || (least - beyond < low)).any()) return;
  const auto time_of = [&](double x) { return t0 + (t1 - t0) * x / 4.0; };
  for (Index d = 0; d < directions; ++d) {
    const auto k = static_cast<std::size_t>(d);
    std::array<double, looks> values;
    const auto take = [&](double sense) {
      for (std::size_t i = 0; i < looks; ++i)
        values[i] = sense * projections(d, static_cast<Index>(i));
      return top_of(values);
    };
    if (most[d] + beyond[d] > now_.high[k])
      if (const Vertex v = take(1.0); v.value > now_.high[k]) {
        now_.high[k] = v.value;
        now_.t_high[k] = time_of(v.x);
      }
    if (least[d] - beyond[d] < now_.low[k])
      if (const Vertex v = take(-1.0); - v.value < now_.low[k]) {
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
