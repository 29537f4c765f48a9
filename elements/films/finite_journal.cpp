#include <elements/films/finite_journal.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

[[noreturn]] void journal_fault(const char* what) {
  throw run_error("E84", std::string("journal bearing: ") + what);
}

Vec2 direction(double a) { return Vec2(std::cos(a), std::sin(a)); }

}  // namespace

JournalSurface::JournalSurface(double clearance, double preload,
                               const std::vector<JournalPad>& pads, int nodes)
    : clearance_(clearance),
      lift_(0.0) {
  if (!(clearance > 0)) journal_fault("the clearance must be positive");
  if (!(preload >= 0 && preload < 1)) journal_fault("the preload must be at least 0 and below 1");
  if (nodes < 8 || nodes > max_nodes) journal_fault("the grid needs 8 to 360 points");
  if (pads.empty() && preload != 0.0) journal_fault("a preload needs pads");
  lift_ = clearance / (1.0 - preload) - clearance;
  std::vector<JournalPad> all = pads;
  const bool round = all.empty() || (all.size() == 1 && all[0].end - all[0].start > two_pi - 1e-9);
  if (all.empty()) all.push_back({0.0, two_pi, 0.0});
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.start < b.start; });
  double total = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!(all[k].end > all[k].start)) journal_fault("a pad is empty");
    const double next = k + 1 < all.size() ? all[k + 1].start : all[0].start + two_pi;
    if (all[k].end > next + 1e-9) journal_fault("pads overlap");
    total += all[k].end - all[k].start;
  }
  for (const JournalPad& a : all) {
    const double length = a.end - a.start;
    arcs_.push_back({a.start, length, round, direction(a.thinnest), nodes * length / total});
  }
}

std::vector<JournalPad> two_groove_pads(double groove_at, double groove) {
  WHIRL_EXPECTS(groove >= 0.0 && groove < pi);
  std::vector<JournalPad> pads;
  for (int k = 0; k < 2; ++k) {
    const double a = groove_at + k * pi + 0.5 * groove, b = groove_at + (k + 1) * pi - 0.5 * groove;
    pads.push_back({a, b, 0.5 * (a + b)});
  }
  return pads;
}

std::vector<JournalPad> lobe_pads(int n, double first, double groove, double offset) {
  WHIRL_EXPECTS(n > 0 && groove >= 0.0 && groove * n < two_pi);
  std::vector<JournalPad> pads;
  const double arc = two_pi / n - groove;
  for (int k = 0; k < n; ++k) {
    const double a = first + k * two_pi / n - 0.5 * arc;
    pads.push_back({a, a + arc, a + offset * arc});
  }
  return pads;
}

PadFilm FiniteJournal::pad(std::size_t k) const {
  WHIRL_EXPECTS(surface && k < surface->arcs().size());
  WHIRL_EXPECTS(radius > 0.0 && length > 0.0);
  const JournalSurface::Arc& arc = surface->arcs()[k];
  return PadFilm(arc.start, arc.length, arc.round, leakage * radius * radius / (length * length),
                 arc.points);
}

FiniteJournal::PadPlace FiniteJournal::place(std::size_t k, const FilmPoint& p) const {
  WHIRL_EXPECTS(surface && k < surface->arcs().size());
  const Vec2& n = surface->arcs()[k].thinnest;
  const Gap g = gap(k, p);
  return {(p.r + g.lift * n) / g.pad, p.w - 0.5 * p.slip * g.lift * Vec2(-n.y(), n.x())};
}

FiniteJournal::Gap FiniteJournal::gap(std::size_t k, const FilmPoint& p) const {
  const Gap cold{surface->pad_clearance(), surface->lift()};
  if (kept_from < 0) return cold;
  WHIRL_EXPECTS(p.kept != nullptr);
  const double* own = p.kept + kept_from + static_cast<std::ptrdiff_t>(k) * kept_each();
  const double assembled = surface->clearance(), pad = cold.pad + own[1] * assembled;
  return {pad, pad - assembled * (1.0 + own[0])};
}

double FiniteJournal::pressure_unit(const Gap& g) const {
  return source * viscosity * radius * radius / (g.pad * g.pad * g.pad);
}

PadMedium FiniteJournal::medium(std::size_t k, const FilmPoint& p) const {
  const Gap g = gap(k, p);
  PadMedium m;
  if (kept_from >= 0 && !alike)
    m.log_viscosity = {p.kept + kept_from + static_cast<std::ptrdiff_t>(k) * kept_each() + 2,
                       static_cast<std::size_t>(knots)};
  m.reynolds = turbulent_density * radius * std::abs(p.slip) * g.pad / viscosity;
  m.edge = supply_pressure / pressure_unit(g);
  if (mass_conserving) m.carry = 0.5 * p.slip * g.pad;
  return m;
}

double FiniteJournal::least_film(const FilmPoint& p) const {
  double least = infinity;
  for (std::size_t k = 0; k < surface->arcs().size(); ++k)
    least = std::min(least, gap(k, p).pad * pad(k).smallest_clearance(place(k, p).e));
  return least;
}

bool FiniteJournal::inside(const FilmPoint& p) const {
  WHIRL_EXPECTS(surface != nullptr);
  if (!p.r.allFinite() || !p.w.allFinite() || !std::isfinite(p.slip)) return false;
  for (std::size_t k = 0; k < surface->arcs().size(); ++k)
    if (!(pad(k).smallest_clearance(place(k, p).e) > 0.0)) return false;
  return true;
}

void FiniteJournal::evaluate(const FilmPoint& p, FilmForce& f) const {
  WHIRL_EXPECTS(radius > 0.0 && length > 0.0 && viscosity >= 0.0);
  if (!inside(p)) return set_outside(f);
  if (grid) return evaluate_on_grid(p, f);
  if (!isoviscous()) return evaluate_through(p, f);
  f.F.setZero();
  f.T = 0.0;
  const double c = surface->pad_clearance();
  const double unit = source * viscosity * std::pow(radius / c, 3) * length;  // N per m/s of W
  const double drag = viscosity * std::pow(radius, 3) * length / c;
  for (std::size_t k = 0; k < surface->arcs().size(); ++k) {
    const PadFilm film = pad(k);
    const auto [e, W] = place(k, p);
    const Vec2& n = surface->arcs()[k].thinnest;
    const Vec2 G = film.load(e, W);
    Vec2 gradient;
    f.F -= unit * G;
    f.T += 0.5 * unit * surface->lift() * (n.x() * G.y() - n.y() * G.x());
    if (p.slip != 0.0) f.T -= drag * p.slip * film.shear(e, gradient);
  }
}

void FiniteJournal::evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const {
  if (!inside(p)) return set_outside(f, t);
  if (grid) return evaluate_on_grid(p, f, t);
  if (!isoviscous()) return evaluate_through(p, f, t);
  set_zero(f, t);
  const double c = surface->pad_clearance(), half_lift = 0.5 * surface->lift();
  const double unit = source * viscosity * std::pow(radius / c, 3) * length;
  const double drag = viscosity * std::pow(radius, 3) * length / c;
  for (std::size_t k = 0; k < surface->arcs().size(); ++k) {
    const PadFilm film = pad(k);
    auto [e, W] = place(k, p);
    const Vec2& n = surface->arcs()[k].thinnest;
    const Vec2 across(-n.y(), n.x());
    if (W.norm() <= 1e-9 * std::abs(p.slip) * c)
      W.setZero();  // a journal centred in its pad but for rounding
    const PadLoad load = film.load_and_slopes(e, W);
    Vec2 shear_e;
    const double shear = film.shear(e, shear_e);
    f.F -= unit * load.G;
    t.F_r -= unit / c * load.by_e;
    t.F_w -= unit * load.by_W;
    t.F_slip += unit * half_lift * (load.by_W * across);
    // pressure on the lobe, and shear of a full film
    f.T += unit * half_lift * across.dot(load.G) - drag * p.slip * shear;
    t.T_r += unit / c * half_lift * (load.by_e.transpose() * across) - drag * p.slip / c * shear_e;
    t.T_w += unit * half_lift * (load.by_W.transpose() * across);
    t.T_slip -= unit * half_lift * half_lift * across.dot(load.by_W * across) + drag * shear;
  }
}

namespace {

/// int n dtheta over a pad.
Vec2 normal_of(const JournalSurface::Arc& arc) {
  if (arc.round) return Vec2::Zero();
  const double end = arc.start + arc.length;
  return Vec2(std::sin(end) - std::sin(arc.start), std::cos(arc.start) - std::cos(end));
}

/// A journal centred in its pad but for rounding has no source.
Vec2 source_of(const FiniteJournal::PadPlace& at, double slip, double clearance) {
  return at.W.norm() <= 1e-9 * std::abs(slip) * clearance ? Vec2(Vec2::Zero()) : at.W;
}

}  // namespace

/// Whether oil is carried over ruptured stretches: not at rest, nor where nothing makes a film.
bool FiniteJournal::carries_oil(std::size_t k, const FilmPoint& p) const {
  if (!mass_conserving || p.slip == 0.0) return false;
  return supply_pressure > 0.0 || !source_of(place(k, p), p.slip, gap(k, p).pad).isZero(0.0);
}

/// Pad k of a film that conserves mass, in rotation.
void FiniteJournal::add_carried(std::size_t k, const FilmPoint& p, FilmForce& f,
                                FilmTangent& t) const {
  const Gap g = gap(k, p);
  const double c = g.pad, half_lift = 0.5 * g.lift;
  const double unit = pressure_unit(g) * radius * length;
  const double drag = viscosity * std::pow(radius, 3) * length / c;
  const PadMedium m = medium(k, p);
  const PadPlace at = place(k, p);
  const Vec2 W = source_of(at, p.slip, c), normal = normal_of(surface->arcs()[k]);
  const Vec2& n = surface->arcs()[k].thinnest;
  const Vec2 across(-n.y(), n.x());
  const PadCarriedLoad load = pad(k).carried(at.e, W, m);
  const Vec2 G = load.G - m.edge * normal;
  const double of_reynolds = std::copysign(turbulent_density * radius * c / viscosity, p.slip);
  const double of_carry = m.carry / p.slip;
  // W = w - slip half_lift across
  const Vec2 G_slip =
      of_reynolds * load.by_reynolds + of_carry * load.by_carry - half_lift * (load.by_W * across);
  const double shear_slip = of_reynolds * load.shear.by_reynolds + of_carry * load.shear_by_carry -
                            half_lift * load.shear_by_W.dot(across);
  f.F -= unit * G;
  t.F_r -= unit / c * load.by_e;
  t.F_w -= unit * load.by_W;
  t.F_slip -= unit * G_slip;
  f.T += unit * half_lift * across.dot(G) - drag * p.slip * load.shear.value;
  t.T_r +=
      unit / c * half_lift * (load.by_e.transpose() * across) - drag * p.slip / c * load.shear.by_e;
  t.T_w += unit * half_lift * (load.by_W.transpose() * across) - drag * p.slip * load.shear_by_W;
  t.T_slip +=
      unit * half_lift * across.dot(G_slip) - drag * (load.shear.value + p.slip * shear_slip);
  f.pump += unit * m.edge * (load.fed + W.dot(normal));
}

void FiniteJournal::evaluate_through(const FilmPoint& p, FilmForce& f) const {
  if (mass_conserving && p.slip != 0.0) {
    FilmTangent unused;
    return evaluate_through(p, f, unused);
  }
  f = {Vec2::Zero(), 0.0, 0.0};
  for (std::size_t k = 0; k < surface->arcs().size(); ++k) {
    const Gap g = gap(k, p);
    const double unit = pressure_unit(g) * radius * length;
    const double drag = viscosity * std::pow(radius, 3) * length / g.pad;
    const PadFilm film = pad(k);
    const PadMedium m = medium(k, p);
    const PadPlace at = place(k, p);
    const Vec2 W = source_of(at, p.slip, g.pad), normal = normal_of(surface->arcs()[k]);
    const Vec2& n = surface->arcs()[k].thinnest;
    double fed = 0.0;
    const Vec2 G = film.load(at.e, W, m, fed) - m.edge * normal;
    f.F -= unit * G;
    f.T += 0.5 * unit * g.lift * (n.x() * G.y() - n.y() * G.x());
    if (p.slip != 0.0) f.T -= drag * p.slip * film.shear(at.e, m).value;
    f.pump += unit * m.edge * (fed + W.dot(normal));
  }
}

void FiniteJournal::evaluate_through(const FilmPoint& p, FilmForce& f, FilmTangent& t) const {
  set_zero(f, t);
  for (std::size_t k = 0; k < surface->arcs().size(); ++k) {
    if (carries_oil(k, p)) {
      add_carried(k, p, f, t);
      continue;
    }
    const Gap g = gap(k, p);
    const double c = g.pad, half_lift = 0.5 * g.lift;
    const double unit = pressure_unit(g) * radius * length;
    const double drag = viscosity * std::pow(radius, 3) * length / c;
    const PadFilm film = pad(k);
    const PadMedium m = medium(k, p);
    const PadPlace at = place(k, p);
    const Vec2 W = source_of(at, p.slip, c), normal = normal_of(surface->arcs()[k]);
    const Vec2& n = surface->arcs()[k].thinnest;
    const Vec2 across(-n.y(), n.x());
    const PadFlowLoad load = film.load_and_slopes(at.e, W, m);
    const PadShear shear = film.shear(at.e, m);
    const Vec2 G = load.G - m.edge * normal;
    const double by_slip =
        std::copysign(turbulent_density * radius * c / viscosity, p.slip);  // of reynolds
    f.F -= unit * G;
    t.F_r -= unit / c * load.by_e;
    t.F_w -= unit * load.by_W;
    t.F_slip += unit * (half_lift * (load.by_W * across) - by_slip * load.by_reynolds);
    f.T += unit * half_lift * across.dot(G) - drag * p.slip * shear.value;
    t.T_r +=
        unit / c * half_lift * (load.by_e.transpose() * across) - drag * p.slip / c * shear.by_e;
    t.T_w += unit * half_lift * (load.by_W.transpose() * across);
    t.T_slip += unit * half_lift *
                    across.dot(by_slip * load.by_reynolds - half_lift * (load.by_W * across)) -
                drag * (shear.value + p.slip * by_slip * shear.by_reynolds);
    f.pump += unit * m.edge * (load.fed + W.dot(normal));
  }
}

GridDrive FiniteJournal::drive(std::size_t k, const FilmPoint& p) const {
  WHIRL_EXPECTS(grid && k < grid->size());
  const Gap g = gap(k, p);
  const PadMedium m = medium(k, p);
  const PadPlace at = place(k, p);
  const Vec2 W = source_of(at, p.slip, g.pad);
  return {
      at.e,           Vec3(W.x(), W.y(), 0.5 * p.slip), g.pad, m.reynolds, m.edge, m.log_viscosity,
      mass_conserving};
}

namespace {

/// Of a film that nothing drives: 1/pi int G(n) n^T dphi, as PadFilm::mean_slope.
Mat2 mean_slope(const GridPad& pad, const GridDrive& at_rest) {
  constexpr int directions = 12;
  GridDrive in = at_rest;
  GridLoad load;
  Mat2 C = Mat2::Zero();
  for (int k = 0; k < directions; ++k) {
    const double angle = two_pi * (k + 0.5) / directions;
    const Vec2 n(std::cos(angle), std::sin(angle));
    in.source << n, 0.0;
    pad.load(in, load);
    C += 2.0 / directions * load.z.head<2>() * n.transpose();
  }
  return C;
}

}  // namespace

void FiniteJournal::evaluate_on_grid(const FilmPoint& p, FilmForce& f) const {
  f = {Vec2::Zero(), 0.0, 0.0};
  GridLoad load;
  for (std::size_t k = 0; k < grid->size(); ++k) {
    const GridDrive in = drive(k, p);
    (*grid)[k].load(in, load);
    const Gap g = gap(k, p);
    const double unit = pressure_unit(g) * radius * length;
    const double drag = viscosity * std::pow(radius, 3) * length / g.pad;
    const Vec2& n = surface->arcs()[k].thinnest;
    const Vec2 across(-n.y(), n.x());
    f.F -= unit * load.z.head<2>();
    f.T += 0.5 * unit * (g.lift * across.dot(load.z.head<2>()) - load.z[2]);
    f.T -= drag * p.slip * load.shear;
    f.pump += unit * in.edge * (load.fed + load.normal);
  }
}

void FiniteJournal::evaluate_on_grid(const FilmPoint& p, FilmForce& f, FilmTangent& t) const {
  set_zero(f, t);
  GridLoad load;
  GridSlopes by;
  for (std::size_t k = 0; k < grid->size(); ++k) {
    const GridDrive in = drive(k, p);
    (*grid)[k].load(in, load, by);
    if (in.source.isZero(0.0) && in.edge == 0.0)
      by.by_source.topLeftCorner<2, 2>() =
          mean_slope((grid_at_rest ? *grid_at_rest : *grid)[k], in);
    const Gap g = gap(k, p);
    const double c = g.pad, unit = pressure_unit(g) * radius * length;
    const double drag = viscosity * std::pow(radius, 3) * length / c;
    const Vec2& n = surface->arcs()[k].thinnest;
    const Vec2 across(-n.y(), n.x());
    // torque of the pressure: unit row . z
    Eigen::RowVector3d row;
    row << 0.5 * g.lift * across.transpose(), -0.5;
    Vec3 source_slip;
    source_slip << -0.5 * g.lift * across, 0.5;
    const double reynolds_slip = std::copysign(turbulent_density * radius * c / viscosity, p.slip);
    const Vec3 z_slip = by.by_source * source_slip + reynolds_slip * by.by_reynolds;
    const double shear_slip =
        by.shear_by_source.dot(source_slip) + reynolds_slip * by.shear_by_reynolds;
    f.F -= unit * load.z.head<2>();
    t.F_r -= unit / c * by.by_e.topRows<2>();
    t.F_w -= unit * by.by_source.topLeftCorner<2, 2>();
    t.F_slip -= unit * z_slip.head<2>();
    f.T += unit * row.dot(load.z) - drag * p.slip * load.shear;
    t.T_r += unit / c * (row * by.by_e).transpose() - drag * p.slip / c * by.shear_by_e;
    t.T_w += unit * (row * by.by_source).head<2>().transpose() -
             drag * p.slip * by.shear_by_source.head<2>();
    t.T_slip += unit * row.dot(z_slip) - drag * (load.shear + p.slip * shear_slip);
    f.pump += unit * in.edge * (load.fed + load.normal);
  }
}

}  // namespace whirl::elements
