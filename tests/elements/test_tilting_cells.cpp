// Tilting pads whose films conserve mass in a motion at large: balance of the oil of a pad that moves,
// equilibria against the film of the momentary state, full films against those that do not conserve
// mass, small motions, tangents and power.
#include "conformance.hpp"
#include <core/dual.hpp>
#include <elements/films/tilting_cells.hpp>
#include <Eigen/LU>

namespace tilting_cells_tests {

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

constexpr double c = 1e-4, eta = 0.02, Omega = 300, R = 0.05;

/// A pad of 60 deg below the journal.
TiltingPad lower_pad(int points, double supply = 0.0, double preload = 0.3, double offset = 0.5) {
  const double below = -0.5 * pi, arc = pi / 3.0;
  TiltingPad pad = make_tilting_pad({R, 0.06, eta, c, preload, below, arc, offset, 0.01, points});
  pad.film.supply_pressure = supply;
  pad.film.mass_conserving = true;
  return pad;
}

std::shared_ptr<const CarriedPad> cells_of(const TiltingPad& pad) {
  return std::make_shared<const CarriedPad>(pad.film, 0);
}

LateralMotion still(const Vec2& r) {
  LateralMotion m;
  m.r = r;
  m.v.setZero();
  m.a.setZero();
  m.spin = Omega;
  return m;
}

/// The pad's oil while journal and pad move: implicit Euler.
class MovedPad {
 public:
  MovedPad(const CarriedPad& oil, const Vec2& r) : oil_(oil), content(oil.balanced(r, Omega)) {}
  /// r: of the journal against the centre of the pad at the end of the step, m. Counts what comes in and
  /// what leaves, m rad.
  void step(double dt, const Vec2& r) {
    ASSERT_TRUE(oil_.advance(r, Omega, 1.0 / dt, content));
    const Index last = oil_.cells() - 1;
    for (Index i = 0; i <= last; ++i) {
      const auto x = cell(i, r);
      if (i == 0) entered += dt * x.in;
      if (i == last) entered -= dt * x.out;
      entered -= dt * x.sides;
      passed += dt * (std::abs(x.in) + std::abs(x.out));
    }
  }
  CarriedPad::Cell<double> cell(Index i, const Vec2& r) const {
    const Index last = oil_.cells() - 1;
    const double before = content[at(std::max<Index>(i - 1, 0))];
    const double next = content[at(std::min(i + 1, last))];
    return oil_.cell(i, r.x(), r.y(), Omega, before, content[at(i)], next);
  }
  double held() const {
    double sum = 0.0;
    for (const double x : content)
      sum += x * oil_.width();
    return sum;
  }
  double least_share(const Vec2& r) const {
    double least = infinity;
    for (Index i = 0; i <= oil_.cells() - 1; ++i)
      least = std::min(least, content[at(i)] / oil_.gap(i, r));
    return least;
  }
  /// On the journal, N.
  Vec2 force(const Vec2& r) const {
    Vec2 F = Vec2::Zero();
    for (Index i = 0; i < oil_.cells(); ++i) {
      const auto x = cell(i, r);
      F -= Vec2(x.push[0], x.push[1]);
    }
    return F;
  }

 private:
  const CarriedPad& oil_;

 public:
  std::vector<double> content;
  double entered = 0, passed = 0;
};

}  // namespace

// Oil and pad in balance are the pad of the momentary film, which has no grid, to the second order of the
// cells: on the 14 of a usual pad the force within 2.5 % and the edges within 4 % of the clearance, on 56
// within 0.2 and 0.3 %. At a supply pressure the film of the momentary state looks for no tilt of its own:
// it is compared where the cells put the pad.
TEST(TiltingCells, EquilibriumOfTheMomentaryState) {
  double tilts[2] = {0.0, 0.0}, forces[2] = {0.0, 0.0};
  for (const double supply : {0.0, 2e5})
    for (const double offset : {0.5, 0.6})
      for (const double down : {0.0, 0.3, 0.6})
        for (const int fine : {0, 1}) {
          const TiltingPad pad = lower_pad(fine ? 56 : 14, supply, 0.3, offset);
          const PadAtRest rest(pad, cells_of(pad));
          const LateralMotion m = still(Vec2(0.1 * c, -down * c));
          const Vec2 q = rest.settled(m);
          const Vec2 F = rest.force(pad.seen(m, q, Vec2::Zero()).r, Omega);
          // nothing turns the pad
          const double moment = F.dot(pad.direction(0)) + pad.tilt_stiffness * q.x();
          EXPECT_LT(std::abs(moment), 1e-6 * F.norm() * pad.arm);
          const double exact = supply == 0.0 ? pad.settled_tilt(m) : q.x();
          const Vec2 momentary = -pad.standing(m, Vec2(exact, 0.0)).force;
          tilts[fine] = std::max(tilts[fine], std::abs(q.x() - exact) * pad.arm / c);
          forces[fine] = std::max(forces[fine], (F - momentary).norm() / momentary.norm());
        }
  EXPECT_LT(tilts[0], 0.04);
  EXPECT_LT(tilts[1], 0.003);
  EXPECT_LT(forces[0], 0.025);
  EXPECT_LT(forces[1], 0.002);
}

// An elastic pivot gives by its load.
TEST(TiltingCells, PivotGives) {
  TiltingPad pad = lower_pad(14);
  pad.pivot_stiffness = 1e8;
  const PadAtRest rest(pad, cells_of(pad));
  const LateralMotion m = still(Vec2(0.0, -0.5 * c));
  const Vec2 q = rest.settled(m);
  const Vec2 F = rest.force(pad.seen(m, q, Vec2::Zero()).r, Omega);
  EXPECT_GT(q.y(), 0.01 * c);
  EXPECT_NEAR(pad.pivot_stiffness * q.y(), -F.dot(pad.pivot), 1e-6 * F.norm());
}

// Of several balances that nearest to where the pad stands; where the journal stands outside the film
// there is none, and a cell that touches anywhere gives no force.
TEST(TiltingCells, WherePadsAreInBalance) {
  const TiltingPad pad = lower_pad(14);
  const PadAtRest rest(pad, cells_of(pad));
  const LateralMotion m = still(Vec2(0.1 * c, 0.5 * c));
  const Vec2 carries = rest.settled(m), left = rest.settled(m, Vec2(-0.9 * c / pad.arm, 0.0));
  for (const Vec2& q : {carries, left}) {
    const Vec2 again = rest.settled(m, q);
    EXPECT_NEAR(again.x(), q.x(), 1e-6 * c / pad.arm);
  }
  EXPECT_FALSE(rest.settled(still(Vec2(0.0, -2.0 * c))).allFinite());
  const CarriedPad& oil = *rest.oil();
  const Vec2 along(std::cos(oil.middle(0)), std::sin(oil.middle(0)));
  const double to_wall = oil.gap(0, Vec2::Zero());
  EXPECT_TRUE(oil.open(0, 0.9 * to_wall * along));
  EXPECT_FALSE(oil.open(0, 0.9999 * to_wall * along));  // an edge is nearer than the middle
}

// While journal, tilt and pivot move through rupture and refilling, the oil held is what came in less
// what left, to rounding.
TEST(TiltingCells, OilIsConserved) {
  const TiltingPad pad = lower_pad(14, 2e4);
  const CarriedPad oil(pad.film, 0);
  const auto r = [&](double turned) {
    const LateralMotion m = still(c * Vec2(0.3 * std::cos(turned), -0.3 + 0.3 * std::sin(turned)));
    const Vec2 q(0.4 * c / pad.arm * std::sin(0.7 * turned), 0.1 * c * std::sin(1.3 * turned));
    return pad.seen(m, q, Vec2::Zero()).r;
  };
  MovedPad moved(oil, r(0.0));
  const double begun = moved.held();
  double least = infinity;
  constexpr int steps = 600;
  for (int k = 1; k <= steps; ++k) {
    const double turned = 6.0 * pi * k / steps;
    moved.step(6.0 * pi / Omega / steps, r(turned));
    least = std::min(least, moved.least_share(r(turned)));
  }
  EXPECT_LT(least, 0.95);  // it did rupture
  EXPECT_NEAR(moved.held() - begun, moved.entered, 1e-11 * moved.passed);
}

// At a supply pressure that keeps it full, a pad that moves has the force of the film that knows no
// rupture: wedge, squeeze of journal and pad, leakage.
TEST(TiltingCells, FullFilmIsThatOfReynolds) {
  const double supply = 5e6;
  const TiltingPad pad = lower_pad(56, supply);
  FiniteJournal film = pad.film;
  film.mass_conserving = false;
  const CarriedPad oil(pad.film, 0);
  const double rate = Omega;  // as an unbalance
  const auto seen = [&](double t) {
    LateralMotion m = still(c * Vec2(0.1 * std::cos(rate * t), -0.3 + 0.1 * std::sin(rate * t)));
    m.v = 0.1 * c * rate * Vec2(-std::sin(rate * t), std::cos(rate * t));
    const double most = 0.1 * c / pad.arm;
    return pad.seen(m, Vec2(most * std::sin(rate * t), 0.0),
                    Vec2(most * rate * std::cos(rate * t), 0.0));
  };
  MovedPad moved(oil, seen(0.0).r);
  constexpr int steps = 2000;
  double worst = 0.0, largest = 0.0, without_motion = 0.0;
  for (int k = 1; k <= steps; ++k) {
    const double t = k * two_pi / rate / steps;
    const LateralMotion m = seen(t);
    moved.step(two_pi / rate / steps, m.r);
    EXPECT_GT(moved.least_share(m.r), 1.0);
    if (k < steps / 10) continue;
    FilmForce exact, at_rest;
    film.evaluate(FilmLaw<FiniteJournal>::point(m), exact);
    LateralMotion stands = m;
    stands.v.setZero();
    film.evaluate(FilmLaw<FiniteJournal>::point(stands), at_rest);
    worst = std::max(worst, (moved.force(m.r) - exact.F).norm());
    largest = std::max(largest, exact.F.norm());
    without_motion = std::max(without_motion, (at_rest.F - exact.F).norm());
  }
  EXPECT_GT(without_motion, 0.05 * largest);
  EXPECT_LT(worst, 0.005 * largest);
}

namespace {

ConformanceOptions moving(const PadAtRest<>& rest, int pad_unknowns, double filled) {
  ConformanceOptions o = film_options(c, Omega, 5e-3);
  o.gravity.setZero();  // it does not act on scalars
  o.tangent_tolerance = 1e-7;
  o.samples = 4;
  o.passive = false;  // the elastic energy of the oil is counted as heat
  const int first = 2 + pad_unknowns;
  o.signals = {first, first + 1, first + 2};
  o.q0.assign(at(6 * (first + 3)), 0.0);
  o.v0.assign(at(6 * (first + 3)), 0.0);
  LateralMotion m = still(c * Vec2(0.2, -0.4));
  o.q0[1] = m.r.x();
  o.q0[2] = m.r.y();
  o.v0[3] = Omega;
  o.v0[9] = 20;
  Vec2 q(0.2 * c / rest.pad().arm, 0.0);
  if (pad_unknowns == 2) q.y() = 0.05 * c;
  o.q0[12] = q.x();
  if (pad_unknowns == 2) o.q0[18] = q.y();
  const Vec2 r = rest.pad().seen(m, q, Vec2::Zero()).r;
  const std::array<Index, 3> cells{4, 6, 5};  // before, next, own
  for (std::size_t k = 0; k < 3; ++k)
    o.q0[6 * (at(first) + k)] =
        filled * rest.oil()->gap(cells[k], r) - rest.oil()->reference(cells[k]);
  return o;
}

}  // namespace

TEST(TiltingCells, ConformToTheContractOfKernels) {
  TiltingPad pad = lower_pad(16, 1e5);
  pad.inertia = 2e-4;
  pad.tilt_stiffness += 300;
  pad.tilt_damping += 0.02;
  pad.mass = 0.3;
  pad.pivot_stiffness = 2e8;
  pad.pivot_damping = 3e3;
  for (const double density : {0.0, 900.0}) {
    pad.film.turbulent_density = density;
    const auto rest = std::make_shared<const PadAtRest<>>(pad, cells_of(pad));
    for (const double filled : {0.8, 1.2}) {
      const std::array<double, 2> none{0.0, 0.0}, off{1e-6, 2e-6};
      const auto rigid = moving(*rest, 1, filled), pressed = moving(*rest, 2, filled);
      check_kernel(TiltingCell<CarriedPad, false, false>::of(rest, 5, none), rigid);
      check_kernel(TiltingCell<CarriedPad, false, true>::of(rest, 5, off), rigid);
      check_kernel(TiltingCell<CarriedPad, true, false>::of(rest, 5, none), pressed);
      check_kernel(TiltingCell<CarriedPad, true, true>::of(rest, 5, off), pressed);
    }
  }
}

TEST(TiltingCells, MountsConformToTheContractOfKernels) {
  TiltingPad pad = lower_pad(16);
  pad.inertia = 2e-4;
  pad.mass = 0.3;
  pad.pivot_stiffness = 2e8;
  pad.pivot_damping = 3e3;
  const auto rest = std::make_shared<const PadAtRest<>>(pad, cells_of(pad));
  ConformanceOptions o;
  o.gravity.setZero();
  check_kernel(PadMount<CarriedPad, false, false>{rest}, o);
  check_kernel(PadMount<CarriedPad, false, true>{rest, {1e-6, 2e-6}}, o);
  check_kernel(PadMount<CarriedPad, true, false>{rest}, o);
  check_kernel(PadMount<CarriedPad, true, true>{rest, {1e-6, 2e-6}}, o);
}

}  // namespace tilting_cells_tests
