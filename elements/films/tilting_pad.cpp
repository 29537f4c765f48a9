#include <elements/films/tilting_pad.hpp>
#include <elements/films/pad_mount.hpp>
#include <elements/films/root_between.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <la/dense.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

/// What lays an unloaded pad, of the damping of a film against turning its pad: a damper, and a
/// spring with this damping in a second.
constexpr double rest_damper = 1e-5, rest_spring = 1e-6;

[[noreturn]] void pad_fault(const char* what) {
  throw run_error("E84", std::string("tilting pad: ") + what);
}

}  // namespace

AxialProfile axial_profile(double kappa) {
  WHIRL_EXPECTS(kappa >= 0.0);
  if (kappa < 1e-2) return {10.0, 10.0, 1.5};  // of the next order in kappa^2: 1e-5
  const double t = std::tanh(kappa) / kappa, s = 1.0 / (std::cosh(kappa) * std::cosh(kappa));
  const double mean = 1.0 - t, square = 1.0 - 1.5 * t + 0.5 * s;
  const double slope = 2.0 * kappa * kappa * (t - s);  // mean of (L phi')^2
  return {slope / square, 12.0 * mean * mean / square, (1.0 - std::sqrt(s)) / mean};
}

AxialProfile axial_profile_of_pad(double arc, double length_over_radius) {
  WHIRL_EXPECTS(arc > 0.0 && length_over_radius > 0.0);
  constexpr double wedge = 1.15;
  double kappa = 1.0;
  for (int k = 0; k < 60; ++k) {
    const double along = 0.5 * arc * std::sqrt(axial_profile(kappa).leakage) / length_over_radius;
    const double next = 0.5 * length_over_radius * std::sqrt(axial_profile(along).leakage) / arc;
    const bool done = std::abs(next - kappa) < 1e-12 * kappa;
    kappa = next;
    if (done) break;
  }
  return axial_profile(wedge * kappa);
}

TiltingPad make_tilting_pad(const PadGeometry& g) {
  if (!(g.radius > 0 && g.length > 0)) pad_fault("radius and length must be positive");
  if (!(g.arc > 0 && g.arc < two_pi)) pad_fault("the arc must lie between 0 and 360 deg");
  if (!(g.offset >= 0 && g.offset <= 1)) pad_fault("the pivot lies outside the pad");
  if (!(g.thickness >= 0)) pad_fault("the thickness must not be negative");
  const double start = g.pivot - g.offset * g.arc;
  TiltingPad p;
  p.film.radius = g.radius;
  p.film.length = g.length;
  p.film.viscosity = g.viscosity;
  const std::vector<JournalPad> stretch{{start, start + g.arc, g.pivot}};
  p.film.surface =
      std::make_shared<JournalSurface>(g.clearance, g.preload, stretch, std::max(8, g.points));
  const AxialProfile profile = axial_profile_of_pad(g.arc, g.length / g.radius);
  p.film.leakage = profile.leakage;
  p.film.source = profile.source;
  p.film.peak = profile.peak;
  p.pivot = Vec2(std::cos(g.pivot), std::sin(g.pivot));
  const double clearance = p.film.surface->pad_clearance();
  p.arm = g.radius + clearance + g.thickness;
  const double slender = g.radius / clearance;
  const double own = g.viscosity * g.length * slender * slender * slender * p.arm * p.arm;
  p.tilt_damping = rest_damper * own;
  p.pivot_rest = rest_spring * own / (p.arm * p.arm);
  p.tilt_stiffness = rest_spring * own;  // times 1/s: far below every frequency of a film at work
  return p;
}

double TiltingPad::pivot_force(double by) const {
  if (pivot_exponent == 1.0) return pivot_stiffness * by;
  return pivot_rest * by + (by > 0.0 ? pivot_stiffness * std::pow(by, pivot_exponent) : 0.0);
}

double TiltingPad::pivot_slope(double by) const {
  if (pivot_exponent == 1.0) return pivot_stiffness;
  const double power = pivot_exponent - 1.0;
  return pivot_rest + (by > 0.0 ? pivot_exponent * pivot_stiffness * std::pow(by, power) : 0.0);
}

double TiltingPad::pivot_energy(double by) const {
  if (pivot_exponent == 1.0) return 0.5 * pivot_stiffness * by * by;
  const double power = pivot_exponent + 1.0;
  return 0.5 * pivot_rest * by * by +
         (by > 0.0 ? pivot_stiffness / power * std::pow(by, power) : 0.0);
}

LateralMotion TiltingPad::seen(LateralMotion m, const Vec2& q, const Vec2& rate) const {
  m.r -= q.x() * direction(0) + q.y() * direction(1);
  m.v -= rate.x() * direction(0) + rate.y() * direction(1);
  return m;
}

PadStanding TiltingPad::standing(const LateralMotion& m, const Vec2& q) const {
  const LateralMotion own = seen(m, q, Vec2::Zero());
  const FilmPoint at = FilmLaw<FiniteJournal>::point(own);
  FilmForce f;
  film.evaluate(at, f);
  PadStanding s;
  s.tilt = q.x();
  s.pressed = q.y();
  s.force = -f.F;
  s.load = s.force.dot(pivot) + 0.0;  // not -0
  const FiniteJournal::Gap gap = film.gap(0, at);
  s.film = gap.pad * film.pad(0).smallest_clearance(film.place(0, at).e);
  s.eccentricity = (m.r.dot(pivot) - q.y()) / (gap.pad - gap.lift);
  s.power = f.pump - (f.F.dot(at.w) + f.T * at.slip);
  return s;
}

double TiltingPad::righting_moment(const LateralMotion& m, double tilt) const {
  FilmForce f;
  film.evaluate(FilmLaw<FiniteJournal>::point(seen(m, Vec2(tilt, 0.0), Vec2::Zero())), f);
  return f.F.dot(direction(0)) + tilt_stiffness * tilt;
}

Vec2 TiltingPad::touching_tilts(const LateralMotion& m) const {
  const auto inside = [&](double tilt) {
    return film.inside(FilmLaw<FiniteJournal>::point(seen(m, Vec2(tilt, 0.0), Vec2::Zero())));
  };
  const double size = film.surface->pad_clearance() / arm;
  double middle = 0.0;
  for (double look = 0.0; !inside(middle) && look < 3.0; look += 0.05)
    for (const double side : {look, -look})
      if (inside(side * size)) middle = side * size;
  if (!inside(middle)) return Vec2::Constant(nan);
  const auto edge = [&](double side) {
    double in = middle, out = middle + side * size;
    while (inside(out) && std::abs(out) < 1e3 * size) {
      in = out;
      out += side * size;
    }
    for (int k = 0; k < 40; ++k) {
      const double half = 0.5 * (in + out);
      (inside(half) ? in : out) = half;
    }
    return in;
  };
  return {edge(-1.0), edge(1.0)};
}

double TiltingPad::settled_tilt(const LateralMotion& m) const {
  const Vec2 ends = touching_tilts(m);
  if (!ends.allFinite()) return nan;
  const auto moment = [&](double tilt) { return righting_moment(m, tilt); };
  if (!(moment(ends[0]) < 0.0) || !(moment(ends[1]) > 0.0)) return nan;
  const double size = film.surface->pad_clearance() / arm;
  return root_between(ends[0], ends[1], tilt_stiffness * size, moment);
}

std::vector<double> TiltingPad::balances(const LateralMotion& m) const {
  constexpr int looks = 160;  // two balances nearer than that carry the same to a percent
  const Vec2 ends = touching_tilts(m);
  std::vector<double> out;
  if (!ends.allFinite()) return out;
  const auto moment = [&](double tilt) { return righting_moment(m, tilt); };
  const double size = film.surface->pad_clearance() / arm;
  double before = ends[0], below = moment(before);
  for (int k = 1; k <= looks; ++k) {
    const double tilt = ends[0] + (ends[1] - ends[0]) * k / looks, here = moment(tilt);
    if (below < 0.0 && here >= 0.0)
      out.push_back(root_between(before, tilt, tilt_stiffness * size, moment));
    before = tilt;
    below = here;
  }
  return out;
}

Vec2 TiltingPad::settled(const LateralMotion& m) const {
  if (pivot_stiffness == 0.0) return {settled_tilt(m), 0.0};
  const auto pressed = [&](double by) {
    LateralMotion moved = m;
    moved.r -= by * pivot;
    return moved;
  };
  // the left side k xi + F.n, which grows with xi; a pad that the journal is pressed into: beyond it
  const auto balance = [&](double by) {
    const double tilt = settled_tilt(pressed(by));
    if (std::isnan(tilt)) return -infinity;
    return pivot_force(by) - standing(m, Vec2(tilt, by)).load;
  };
  const double size = film.surface->clearance();
  double low = -size, high = size;
  for (int k = 0; balance(low) > 0.0 && k < 20; ++k)
    low *= 2.0;
  for (int k = 0; balance(high) < 0.0 && k < 20; ++k)
    high *= 2.0;
  if (!(balance(low) <= 0.0) || !(balance(high) >= 0.0)) return {nan, nan};
  for (int k = 0; k < 36; ++k) {
    const double half = 0.5 * (low + high);
    (balance(half) < 0.0 ? low : high) = half;
  }
  return {settled_tilt(pressed(high)), high};
}

template <bool Pressed, bool Offsets>
auto TiltingPadJoint<Pressed, Offsets>::motion_of(const Nodes& x, const system::Context& c) const
    -> Motion {
  const typename Link::Spins s{system::Spin(*x[0]), system::Spin(*x[1])};
  Motion out;
  out.journal = Link{offset}.motion(ends(x), c, s, false);
  out.journal.a.setZero();
  out.q = Vec2(x[2]->u.x(), 0.0);
  out.rate = Vec2(x[2]->du.x(), 0.0);
  if constexpr (Pressed) {
    out.q.y() = x[3]->u.x();
    out.rate.y() = x[3]->du.x();
  }
  return out;
}

template <bool Pressed, bool Offsets>
void TiltingPadJoint<Pressed, Offsets>::add_force(const Nodes& x, const system::Context& c,
                                                  system::ForceX<size>& f) const {
  const typename Link::Spins s{system::Spin(*x[0]), system::Spin(*x[1])};
  const Motion m = motion_of(x, c);
  Vector<4> z;
  FilmLaw<FiniteJournal>{pad.film}.force(pad.seen(m.journal, m.q, m.rate), z);
  system::ForceX<14> at_ends = system::ForceX<14>::Zero();
  Link{offset}.add_force(s, z, at_ends);
  f.template head<14>() += at_ends;
  for (std::size_t k = 0; k < own; ++k)
    f[pad_mount::row_of(k)] += z.head<2>().dot(pad.direction(static_cast<int>(k)));
  pad_mount::add_force<Pressed>(pad, x, f);
}

template <bool Pressed, bool Offsets>
void TiltingPadJoint<Pressed, Offsets>::add_tangent(const Nodes& x, const system::Context& c,
                                                    system::TangentX<size>& k) const {
  const typename Link::Spins s{system::Spin(*x[0]), system::Spin(*x[1])};
  const Motion m = motion_of(x, c);
  Vector<4> z;
  LateralTangent t;
  FilmLaw<FiniteJournal>{pad.film}.tangent(pad.seen(m.journal, m.q, m.rate), z, t);
  system::TangentX<14> at_ends;
  at_ends.C.setZero();
  at_ends.K.setZero();
  Link{offset}.add_tangent(s, z, t, false, at_ends);
  k.C.template topLeftCorner<14, 14>() += at_ends.C;
  k.K.template topLeftCorner<14, 14>() += at_ends.K;
  std::array<Vec2, own> directions;
  for (std::size_t i = 0; i < own; ++i)
    directions[i] = pad.direction(static_cast<int>(i));
  pad_mount::add_film_tangent(Link{offset}, s, directions, t, at_ends, k);
  pad_mount::add_tangent<Pressed>(pad, x, k);
}

template <bool Pressed, bool Offsets>
void TiltingPadJoint<Pressed, Offsets>::add_energy(const Nodes& x, const system::Context& c,
                                                   system::Energy& e) const {
  const Motion m = motion_of(x, c);
  FilmLaw<FiniteJournal>{pad.film}.energy(pad.seen(m.journal, m.q, m.rate), e);
  pad_mount::add_energy<Pressed>(pad, x, e);
}

template <bool Pressed, bool Offsets>
void TiltingPadJoint<Pressed, Offsets>::relax(const Nodes& x, const system::Context& c,
                                              std::array<double, own>& q) const {
  const Vec2 settled = pad.settled(motion_of(x, c).journal);
  if (!settled.allFinite()) return;
  q[0] = settled.x();
  if constexpr (Pressed) q[1] = settled.y();
}

template struct TiltingPadJoint<false, false>;
template struct TiltingPadJoint<false, true>;
template struct TiltingPadJoint<true, false>;
template struct TiltingPadJoint<true, true>;

ReducedCoefficients reduce_pads(const PadCoefficients& full, double w) {
  WHIRL_EXPECTS(full.K.rows() >= 2 && w >= 0.0);
  const Index n = full.K.rows() - 2;
  const auto own = [n](const MatX& m) { return m.bottomRightCorner(n, n); };
  ReducedCoefficients out;
  if (w == 0.0) {
    const MatX K = own(full.K);
    const MatX follow = la::DenseLu<double>(K).solve(MatX(full.K.bottomLeftCorner(n, 2)));
    const MatX across = full.K.topRightCorner(2, n).transpose();
    const MatX back = la::DenseLu<double>(K.transpose()).solve(across);
    out.K = full.K.topLeftCorner<2, 2>() - full.K.topRightCorner(2, n) * follow;
    out.C = full.C.topLeftCorner<2, 2>() - full.C.topRightCorner(2, n) * follow -
            back.transpose() * full.C.bottomLeftCorner(n, 2) +
            back.transpose() * own(full.C) * follow;
    return out;
  }
  using MatXc = Eigen::MatrixXcd;
  const MatXc Z = (full.K - w * w * full.M).cast<Complex>() + Complex(0.0, w) * full.C;
  const la::DenseLu<Complex> lu(Z.bottomRightCorner(n, n));
  const MatXc follow = lu.solve(MatXc(Z.bottomLeftCorner(n, 2)));
  const Eigen::Matrix2cd seen = Z.topLeftCorner<2, 2>() - Z.topRightCorner(2, n) * follow;
  out.K = seen.real();
  out.C = seen.imag() / w;
  return out;
}

}  // namespace whirl::elements
