#include <elements/reynolds_line.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

ReynoldsLine::ReynoldsLine(const FiniteJournal& k, const FilmPoint& p)
    : s_(*k.surface), p_(p), n_(s_.size()), beta_(k.leakage * k.radius * k.radius / (k.length * k.length)), c_(s_.clearance()) {
  const Vec2 e = p.r / c_;
  for (int i = 0; i < n_; ++i) {
    h_[at(i)] = s_.node(i).h0 / c_ - e.dot(s_.node(i).n);
    inside_ = inside_ && h_[at(i)] > 0.0;
    const double m = mid(i);
    K_[at(i)] = m * m * m * s_.gap(i).inverse;
    inside_ = inside_ && K_[at(i)] >= 0.0;
  }
  if (!inside_) return;
  for (int i = 0; i < n_; ++i) {
    const auto& q = s_.node(i);
    D_[at(i)] = K_[at(i)] + K_[at(prev(i))] + beta_ * h_[at(i)] * h_[at(i)] * h_[at(i)] * q.weight;
    f_[at(i)] = -p.w.dot(q.n) + 0.5 * p.slip * q.dh0;
    b_[at(i)] = -f_[at(i)] * q.weight;
    zero_[at(i)] = q.held || b_[at(i)] <= 0.0;
    P_[at(i)] = 0.0, end_[at(i)] = 0, xi_[at(i)] = 0.0;
  }
}

double ReynoldsLine::mid(int gap) const { return s_.gap(gap).h0 / c_ - p_.r.dot(s_.gap(gap).n) / c_; }

void ReynoldsLine::find_cut() {
  cut_ = 0;
  while (cut_ < n_ && !zero_[at(cut_)]) ++cut_;
  if (cut_ == n_) cut_ = 0;   // cannot happen at a solution: f of a whole circle has no mean
}

/// Extends the filled stretches both ways with the elimination alone (Brennan-Schwartz): exact for one stretch from a groove.
void ReynoldsLine::guess() {
  find_cut();
  for (int side : {1, -1}) {
    double u = 0.0, v = 0.0;
    for (int k = 0, i = cut_; k < n_; ++k, i = side > 0 ? next(i) : prev(i)) {
      const double left = side > 0 ? K_[at(prev(i))] : K_[at(i)], right = side > 0 ? K_[at(i)] : K_[at(prev(i))];
      const double pivot = 1.0 / (D_[at(i)] - left * u), value = (b_[at(i)] + left * v) * pivot;
      if (s_.node(i).held || (zero_[at(i)] && value <= 0.0)) {
        u = v = 0.0;
        continue;
      }
      zero_[at(i)] = false;
      u = right * pivot, v = value;
    }
  }
}

/// Solves the cyclic tridiagonal system cut at a node with P = 0; x: right side in, solution out.
void ReynoldsLine::solve(Line& lower, Line& diagonal, Line& upper, Line& x) const {
  double u = 0.0, v = 0.0;
  for (int k = 0, i = cut_; k < n_; ++k, i = next(i)) {
    if (zero_[at(i)]) {
      upper[at(i)] = x[at(i)] = u = v = 0.0;
      continue;
    }
    const double pivot = 1.0 / (diagonal[at(i)] + lower[at(i)] * u);
    upper[at(i)] = u = -upper[at(i)] * pivot;
    x[at(i)] = v = (x[at(i)] - lower[at(i)] * v) * pivot;
  }
  v = 0.0;
  for (int k = 0, i = prev(cut_); k < n_; ++k, i = prev(i)) x[at(i)] = v = x[at(i)] + upper[at(i)] * v;
}

/// Active sets on the nodes: filled nodes with P < 0 are emptied, empty ones that would fill are filled.
bool ReynoldsLine::settle_sets() {
  Line lower, diagonal, upper;
  std::array<bool, max_nodes> want;
  for (int k = 0; k < 100; ++k) {
    ++passes_;
    find_cut();
    any_ = false;
    for (int i = 0; i < n_; ++i) {
      any_ = any_ || !zero_[at(i)];
      lower[at(i)] = zero_[at(prev(i))] ? 0.0 : -K_[at(prev(i))];
      upper[at(i)] = zero_[at(next(i))] ? 0.0 : -K_[at(i)];
      diagonal[at(i)] = D_[at(i)];
      P_[at(i)] = zero_[at(i)] ? 0.0 : b_[at(i)];
    }
    if (any_) solve(lower, diagonal, upper, P_);
    bool changed = false;
    for (int i = 0; i < n_; ++i) {
      want[at(i)] = zero_[at(i)];
      if (s_.node(i).held) continue;
      want[at(i)] = zero_[at(i)] ? b_[at(i)] + K_[at(i)] * P_[at(next(i))] + K_[at(prev(i))] * P_[at(prev(i))] <= 0.0 : P_[at(i)] < 0.0;
      changed = changed || want[at(i)] != zero_[at(i)];
    }
    if (!changed) return true;
    zero_ = want;
  }
  return false;
}

bool ReynoldsLine::open(int i, int side) const {
  const int out = side > 0 ? next(i) : prev(i), in = side > 0 ? prev(i) : next(i);
  return !zero_[at(i)] && zero_[at(out)] && (!zero_[at(in)] || s_.node(in).held) && f_[at(out)] > 0.0;
}

/// P, K g and their xi-derivatives of the end nodes.
void ReynoldsLine::refresh() {
  for (int i = 0; i < n_; ++i) {
    dP_[at(i)] = 1.0, Kg_[at(i)] = dKg_[at(i)] = 0.0;
    if (!end_[at(i)]) continue;
    const int gap = end_[at(i)] > 0 ? i : prev(i), out = end_[at(i)] > 0 ? next(i) : prev(i);
    const double inv = s_.gap(gap).inverse, step = 1.0 / inv, xi = xi_[at(i)], dc = (f_[at(out)] - f_[at(i)]) * inv, c = f_[at(i)] + dc * xi;
    const double half = 0.5 * inv / K_[at(gap)];   // 1/(2 h^3)
    P_[at(i)] = c * xi * xi * half;
    dP_[at(i)] = (dc * xi + 2.0 * c) * xi * half;
    Kg_[at(i)] = 0.5 * c * (step - xi) * (step - xi) * inv;
    dKg_[at(i)] = (0.5 * dc * (step - xi) - c) * (step - xi) * inv;
  }
}

/// Newton for the pressures together with the free boundaries, which may move to another node on the way.
bool ReynoldsLine::settle_boundaries() {
  Line lower, diagonal, upper, x;
  for (int i = 0; i < n_; ++i) {
    end_[at(i)] = 0;
    for (int side : {1, -1}) {
      if (!open(i, side)) continue;
      const int gap = side > 0 ? i : prev(i), out = side > 0 ? next(i) : prev(i);
      const double step = 1.0 / s_.gap(gap).inverse, square = 2.0 * P_[at(i)] * K_[at(gap)] * step;   // c xi^2
      if (s_.node(out).held && square > f_[at(out)] * step * step) continue;   // runs into the groove under pressure
      if (end_[at(i)]) {   // a lone node next to a groove on one side only can have two
        end_[at(i)] = 0;
        continue;
      }
      end_[at(i)] = static_cast<signed char>(side);
      double lo = 0.0, hi = step;
      for (int n = 0; n < 12; ++n) {
        const double xi = 0.5 * (lo + hi);
        ((f_[at(i)] + (f_[at(out)] - f_[at(i)]) * xi / step) * xi * xi < square ? lo : hi) = xi;
      }
      xi_[at(i)] = hi;
    }
  }
  for (int k = 0; k < 40; ++k) {
    ++passes_;
    refresh();
    find_cut();
    for (int i = 0; i < n_; ++i) {
      const int a = prev(i), z = next(i);
      lower[at(i)] = zero_[at(a)] ? 0.0 : -K_[at(a)] * dP_[at(a)];
      upper[at(i)] = zero_[at(z)] ? 0.0 : -K_[at(i)] * dP_[at(z)];
      diagonal[at(i)] = D_[at(i)] * dP_[at(i)] - dKg_[at(i)];
      x[at(i)] = zero_[at(i)] ? 0.0 : b_[at(i)] + Kg_[at(i)] + K_[at(i)] * P_[at(z)] + K_[at(a)] * P_[at(a)] - D_[at(i)] * P_[at(i)];
    }
    solve(lower, diagonal, upper, x);
    double change = 0.0;
    bool moved = false;
    for (int i = 0; i < n_; ++i) {
      if (zero_[at(i)]) continue;
      if (!end_[at(i)]) {
        P_[at(i)] += x[at(i)];
        for (int side : {1, -1}) {   // next to a groove: may have fallen below what reaches it
          if (!open(i, side)) continue;
          const int gap = side > 0 ? i : prev(i), out = side > 0 ? next(i) : prev(i);
          const double step = 1.0 / s_.gap(gap).inverse;
          if (2.0 * P_[at(i)] * K_[at(gap)] >= f_[at(out)] * step) continue;
          moved = true;
          end_[at(i)] = static_cast<signed char>(side);
          xi_[at(i)] = step;
        }
        continue;
      }
      const int gap = end_[at(i)] > 0 ? i : prev(i);
      const double inv = s_.gap(gap).inverse;
      xi_[at(i)] += std::clamp(x[at(i)], -1.0 / inv, 1.0 / inv);
      change = std::max(change, std::abs(x[at(i)]) * inv);
    }
    // Boundaries that left their gap.
    const auto ends = end_;
    for (int i = 0; i < n_; ++i) {
      const int side = ends[at(i)];
      if (!side || zero_[at(i)] || end_[at(i)] != side) continue;
      const int gap = side > 0 ? i : prev(i), out = side > 0 ? next(i) : prev(i), in = side > 0 ? prev(i) : next(i);
      const double step = 1.0 / s_.gap(gap).inverse;
      // 1e-12: a boundary on a node belongs to either gap
      if (xi_[at(i)] > step * (1.0 + 1e-12)) {
        moved = true;
        end_[at(i)] = 0;
        if (s_.node(out).held) continue;   // the groove is reached
        zero_[at(out)] = false;
        P_[at(out)] = 0.0;
        const int beyond = side > 0 ? next(out) : prev(out);
        if (!zero_[at(beyond)] || (s_.node(beyond).held && f_[at(beyond)] <= 0.0)) {   // two stretches merge, or a filling groove
          if (end_[at(beyond)] == -side) end_[at(beyond)] = 0;
        } else {
          end_[at(out)] = static_cast<signed char>(side);
          xi_[at(out)] = std::min(xi_[at(i)] - step, step);
        }
      } else if (xi_[at(i)] < -1e-12 * step) {
        moved = true;
        if (f_[at(i)] < 0.0 || end_[at(in)] || (zero_[at(in)] && !s_.node(in).held)) return false;   // a stretch vanishes
        end_[at(i)] = 0;
        zero_[at(i)] = true;
        P_[at(i)] = 0.0;
        if (zero_[at(in)]) continue;
        end_[at(in)] = static_cast<signed char>(side);
        xi_[at(in)] = std::max(xi_[at(i)] + step, 0.0);
      }
    }
    if (!moved && change < 1e-6) {   // quadratic: the error left is 1e-12 of a gap
      refresh();
      for (int i = 0; i < n_; ++i)
        if (!(P_[at(i)] >= 0.0)) return false;
      return true;
    }
  }
  return false;
}

void ReynoldsLine::run() {
  guess();
  settle_sets();
  if (!any_) return;
  const auto zero = zero_;
  const Line P = P_;
  if (settle_boundaries()) return;
  // Degenerate boundaries (a stretch about to vanish or to split): boundaries on nodes.
  zero_ = zero, P_ = P;
  end_.fill(0);
  refresh();
  find_cut();
}

ReynoldsLine::Gradient ReynoldsLine::gradient(const Line& g) const {
  Gradient out{Vec2::Zero(), Vec2::Zero(), 0.0};
  if (!any_) return out;
  // Adjoint: (A S - G)^T y = S g with S = dP/d(unknown), G = d(K g)/d(unknown), A symmetric.
  Line lower, diagonal, upper, y;
  for (int i = 0; i < n_; ++i) {
    lower[at(i)] = zero_[at(prev(i))] ? 0.0 : -K_[at(prev(i))] * dP_[at(i)];
    upper[at(i)] = zero_[at(next(i))] ? 0.0 : -K_[at(i)] * dP_[at(i)];
    diagonal[at(i)] = D_[at(i)] * dP_[at(i)] - dKg_[at(i)];
    y[at(i)] = zero_[at(i)] ? 0.0 : dP_[at(i)] * g[at(i)];
  }
  solve(lower, diagonal, upper, y);
  // d = sum_i (g_i - (A y)_i) dP_i + y.(db + d(K g) - dA P), dP_i and d(K g) at fixed unknowns; dh = -n.dr/c, df = -n.dw + h0'/2 ds.
  for (int i = 0; i < n_; ++i) {
    const auto& q = s_.node(i);
    const auto& gap = s_.gap(i);
    if (!zero_[at(i)]) {
      out.w += y[at(i)] * q.weight * q.n;
      out.slip -= 0.5 * y[at(i)] * q.weight * q.dh0;
      out.r += y[at(i)] * beta_ * 3.0 * h_[at(i)] * h_[at(i)] * q.weight * P_[at(i)] / c_ * q.n;
    }
    const double slope = (y[at(next(i))] - y[at(i)]) * (P_[at(next(i))] - P_[at(i)]);
    if (slope != 0.0) out.r += slope * 3.0 * mid(i) * mid(i) * gap.inverse / c_ * gap.n;
    if (!end_[at(i)]) continue;
    const int side = end_[at(i)], j = side > 0 ? next(i) : prev(i);
    const auto& edge = s_.gap(side > 0 ? i : prev(i));
    const double H = mid(side > 0 ? i : prev(i)), inv = edge.inverse, step = 1.0 / inv, xi = xi_[at(i)];
    const double Ay = D_[at(i)] * y[at(i)] - (zero_[at(prev(i))] ? 0.0 : K_[at(prev(i))] * y[at(prev(i))]) -
                      (zero_[at(next(i))] ? 0.0 : K_[at(i)] * y[at(next(i))]);
    const double weight = g[at(i)] - Ay;
    const double by_c = weight * xi * xi / (2.0 * H * H * H) + y[at(i)] * 0.5 * (step - xi) * (step - xi) * inv;
    const double u = xi * inv;   // c = (1 - u) f_i + u f_j
    out.w -= by_c * ((1.0 - u) * q.n + u * s_.node(j).n);
    out.slip += by_c * 0.5 * ((1.0 - u) * q.dh0 + u * s_.node(j).dh0);
    out.r += weight * P_[at(i)] * 3.0 / (H * c_) * edge.n;
  }
  return out;
}

}  // namespace whirl::elements
