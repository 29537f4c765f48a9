#include <elements/finite_journal.hpp>

#include <core/error.hpp>
#include <elements/reynolds_line.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

[[noreturn]] void fail(const char* what) { throw run_error("E84", std::string("journal bearing: ") + what); }

Vec2 direction(double a) { return Vec2(std::cos(a), std::sin(a)); }

}  // namespace

JournalSurface::JournalSurface(double clearance, double preload, const std::vector<JournalPad>& pads, int nodes)
    : clearance_(clearance), lobed_(preload != 0.0) {
  if (!(clearance > 0)) fail("the clearance must be positive");
  if (!(preload >= 0 && preload < 1)) fail("the preload must be at least 0 and below 1");
  if (nodes < 8 || nodes > max_nodes) fail("the grid needs 8 to 360 points");
  if (pads.empty() && lobed_) fail("a preload needs pads");
  const double cp = clearance / (1.0 - preload), lift = cp - clearance;
  std::vector<JournalPad> arcs = pads;
  const bool round = arcs.empty() || (arcs.size() == 1 && arcs[0].end - arcs[0].start > two_pi - 1e-9);
  if (arcs.empty()) arcs.push_back({0.0, two_pi, 0.0});
  std::sort(arcs.begin(), arcs.end(), [](const auto& a, const auto& b) { return a.start < b.start; });
  double total = 0.0;
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    if (!(arcs[k].end > arcs[k].start)) fail("a pad is empty");
    const double next = k + 1 < arcs.size() ? arcs[k + 1].start : arcs[0].start + two_pi;
    if (arcs[k].end > next + 1e-9) fail("pads overlap");
    total += arcs[k].end - arcs[k].start;
  }
  for (const JournalPad& a : arcs) {
    const double arc = a.end - a.start;
    const int m = std::max(4, static_cast<int>(std::lround(nodes * arc / total)));
    const double step = arc / m;
    const auto h0 = [&](double th) { return cp - lift * std::cos(th - a.thinnest); };
    for (int i = 0; i <= m; ++i) {
      if (round && i == m) break;   // the last point is the first
      const double th = a.start + i * step;
      const bool edge = !round && (i == 0 || i == m);
      nodes_.push_back({direction(th), h0(th), lift * std::sin(th - a.thinnest), edge ? 0.5 * step : step, edge});
      gaps_.push_back({direction(th + 0.5 * step), h0(th + 0.5 * step), edge && i == m ? 0.0 : 1.0 / step});
    }
  }
  if (size() > max_nodes) fail("too many pads for the grid");
}

std::vector<JournalPad> two_groove_pads(double groove_at, double groove) {
  std::vector<JournalPad> pads;
  for (int k = 0; k < 2; ++k) {
    const double a = groove_at + k * pi + 0.5 * groove, b = groove_at + (k + 1) * pi - 0.5 * groove;
    pads.push_back({a, b, 0.5 * (a + b)});
  }
  return pads;
}

std::vector<JournalPad> lobe_pads(int n, double first, double groove, double offset) {
  std::vector<JournalPad> pads;
  const double arc = two_pi / n - groove;
  for (int k = 0; k < n; ++k) {
    const double a = first + k * two_pi / n - 0.5 * arc;
    pads.push_back({a, a + arc, a + offset * arc});
  }
  return pads;
}

void FiniteJournal::pressure(const FilmPoint& p, Pressure& out) const {
  ReynoldsLine s(*this, p);
  out.inside = s.inside();
  out.passes = 0;
  out.P.fill(0.0);
  if (!out.inside) return;
  s.run();
  const double c = surface->clearance(), unit = source * viscosity * radius * radius / (c * c * c);
  for (int i = 0; i < surface->size(); ++i) out.P[static_cast<std::size_t>(i)] = unit * s.P(i);
  out.passes = s.passes();
}

Mat2 FiniteJournal::mean_damping(const FilmPoint& p) const {
  constexpr int directions = 16;   // more change it by less than 2e-3
  Mat2 C = Mat2::Zero();
  for (int k = 0; k < directions; ++k) {
    const double angle = two_pi * (k + 0.5) / directions;
    FilmPoint moving = p;
    moving.w = Vec2(std::cos(angle), std::sin(angle)), moving.slip = 0.0;
    FilmForce f;
    evaluate(moving, f);
    C += 2.0 / directions * f.F * moving.w.transpose();
  }
  return C;
}

void FiniteJournal::evaluate(const FilmPoint& p, FilmForce& f) const {
  ReynoldsLine s(*this, p);
  if (!s.inside()) {
    f.F.setConstant(nan), f.T = nan;
    return;
  }
  s.run();
  const double c = surface->clearance();
  Vec2 sum = Vec2::Zero();
  double lobe = 0.0, shear = 0.0;
  for (int i = 0; i < surface->size(); ++i) {
    const auto& q = surface->node(i);
    const double pw = s.P(i) * q.weight;
    sum += pw * q.n;
    lobe += pw * q.dh0;
    shear += q.weight / s.h(i);
  }
  const double unit = source * viscosity * std::pow(radius / c, 3) * length;   // N per m/s of f
  f.F = -unit * sum;
  f.T = 0.5 * unit * lobe - viscosity * std::pow(radius, 3) * length / c * shear * p.slip;
}

void FiniteJournal::evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const {
  ReynoldsLine s(*this, p);
  if (!s.inside()) {
    f.F.setConstant(nan), f.T = nan;
    t.F_r.setConstant(nan), t.F_w = t.F_r, t.F_slip.setConstant(nan), t.T_r = t.T_w = t.F_slip, t.T_slip = nan;
    return;
  }
  s.run();
  const double c = surface->clearance(), unit = source * viscosity * std::pow(radius / c, 3) * length;
  const double drag = viscosity * std::pow(radius, 3) * length / c;
  ReynoldsLine::Line g;
  const auto derive = [&](auto weight) {   // sum weight_i P_i and its gradient
    double sum = 0.0;
    for (int i = 0; i < surface->size(); ++i) {
      const double w = weight(surface->node(i)) * surface->node(i).weight;
      g[static_cast<std::size_t>(i)] = w;
      sum += w * s.P(i);
    }
    return std::pair(sum, s.gradient(g));
  };
  for (int k = 0; k < 2; ++k) {
    const auto [sum, d] = derive([k](const auto& q) { return q.n[k]; });
    f.F[k] = -unit * sum;
    t.F_r.row(k) = -unit * d.r, t.F_w.row(k) = -unit * d.w, t.F_slip[k] = -unit * d.slip;
  }
  double shear = 0.0;
  Vec2 shear_r = Vec2::Zero();
  for (int i = 0; i < surface->size(); ++i) {
    const auto& q = surface->node(i);
    const double inv = 1.0 / s.h(i);
    shear += q.weight * inv;
    shear_r += q.weight * inv * inv / c * q.n;   // d(c/h)/dr = c n/h^2
  }
  f.T = -drag * shear * p.slip, t.T_r = -drag * p.slip * shear_r, t.T_w.setZero(), t.T_slip = -drag * shear;
  // 1e-9: a journal centred but for rounding
  if (p.w.norm() <= 1e-9 * std::abs(p.slip) * c && (p.slip == 0.0 || !surface->lobed())) t.F_w = mean_damping(p);
  if (surface->lobed()) {
    const auto [sum, d] = derive([](const auto& q) { return q.dh0; });
    f.T += 0.5 * unit * sum, t.T_r += 0.5 * unit * d.r, t.T_w += 0.5 * unit * d.w, t.T_slip += 0.5 * unit * d.slip;
  }
}

}  // namespace whirl::elements
