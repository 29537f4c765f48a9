// Films beyond isoviscous laminar oil at ambient pressure: turbulence, viscosity along the pad,
// supply pressure; loss, flow, thickness and pressure of pads.
#include "conformance.hpp"
#include <elements/films/film_field.hpp>
#include <elements/films/tilting_pad.hpp>
#include <elements/films/turbulence.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

constexpr double c = 1e-4, eta = 0.02, Omega = 300, R = 0.05;

FiniteJournal bearing(double L, const std::vector<JournalPad>& pads, double preload = 0,
                      int nodes = 72) {
  FiniteJournal b{R, L, eta, std::make_shared<JournalSurface>(c, preload, pads, nodes)};
  return b;
}
std::vector<JournalPad> split() { return two_groove_pads(0.0, 20 * pi / 180); }

FilmPoint at_rest(const Vec2& r, double spin = Omega, const double* kept = nullptr) {
  LateralMotion m;
  m.r = r;
  m.v.setZero();
  m.spin = spin;
  m.kept = kept;
  return FilmLaw<FiniteJournal>::point(m);
}

/// ln(eta/eta_0) falls along a pad, by a parabola: cubic splines of any kind have it exactly.
double log_viscosity(double x) { return -1.1 * x + 0.4 * x * x; }

constexpr int knots = 9;
/// Two pads that have grown.
std::vector<double> kept_of_two_pads() {
  std::vector<double> kept{whirl::nan, whirl::nan};  // of somebody else
  for (int k = 0; k < 2; ++k) {
    kept.push_back(-0.04);
    kept.push_back(0.03);
    for (int i = 0; i < knots; ++i)
      kept.push_back(log_viscosity(static_cast<double>(i) / (knots - 1)));
  }
  return kept;
}

/// A film that keeps something, with it.
struct Keeping : FilmLaw<FiniteJournal> {
  const double* kept = nullptr;
  LateralMotion with(LateralMotion m) const {
    m.kept = kept;
    return m;
  }
  void force(const LateralMotion& m, Vector<4>& z) const {
    FilmLaw<FiniteJournal>::force(with(m), z);
  }
  void tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const {
    FilmLaw<FiniteJournal>::tangent(with(m), z, t);
  }
  void energy(const LateralMotion& m, system::Energy& e) const {
    FilmLaw<FiniteJournal>::energy(with(m), e);
  }
};

/// The complementarity problem of one pad on a fixed grid, by policy iteration (every choice of what
/// is film raises the pressure). Loads and the pressures.
struct OnFixedGrid {
  Vec2 load = Vec2::Zero();
  std::vector<double> P;

  OnFixedGrid(double start, double arc, double beta, const Vec2& e, const Vec2& W,
              const PadMedium& m, bool varies, int N) {
    const double d = arc / N;
    const auto h = [&](double t) { return 1 - e.x() * std::cos(t) - e.y() * std::sin(t); };
    const auto mu = [&](double t) {
      return varies ? std::exp(log_viscosity((t - start) / arc)) : 1;
    };
    const auto factor = [&](double t, double k, double power) {
      const double re = m.reynolds * h(t) / mu(t);
      return std::pow(h(t), 3) / mu(t) / (1 + k / 12 * std::pow(re, power));
    };
    const std::size_t n = static_cast<std::size_t>(N) + 1;
    std::vector<double> west(n), east(n), middle(n), source(n);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double t = start + static_cast<double>(i) * d;
      west[i] = factor(t - d / 2, 0.0136, 0.9) / (d * d);
      east[i] = factor(t + d / 2, 0.0136, 0.9) / (d * d);
      middle[i] = west[i] + east[i] + beta * factor(t, 0.0043, 0.96);
      source[i] = W.x() * std::cos(t) + W.y() * std::sin(t);
    }
    std::vector<unsigned char> film(n, 1);
    P.assign(n, 0.0);
    for (int round = 0; round < 4000; ++round) {
      std::vector<double> below(n, 0.0), value(n, 0.0);  // P_i = value_i + below_i P_{i+1}
      value[0] = m.edge;
      for (std::size_t i = 1; i + 1 < n; ++i) {
        if (!film[i]) continue;
        const double pivot = middle[i] - west[i] * below[i - 1];
        below[i] = east[i] / pivot;
        value[i] = (source[i] + west[i] * value[i - 1]) / pivot;
      }
      P[n - 1] = m.edge;
      for (std::size_t i = n - 1; i-- > 0;)
        P[i] = value[i] + below[i] * P[i + 1];
      bool changed = false;
      for (std::size_t i = 1; i + 1 < n; ++i) {
        const double rest = middle[i] * P[i] - west[i] * P[i - 1] - east[i] * P[i + 1] - source[i];
        const bool wanted = film[i] ? P[i] >= 0 : rest < 0;
        changed = changed || wanted != static_cast<bool>(film[i]);
        film[i] = wanted;
      }
      if (!changed) break;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double t = start + static_cast<double>(i) * d, w = i == 0 || i + 1 == n ? 0.5 : 1.0;
      load += w * d * P[i] * Vec2(std::cos(t), std::sin(t));
    }
  }
};

}  // namespace

TEST(FilmFlow, ElementsSideBySideAreAsOneByOne) {
  // oil that is alike everywhere goes several elements at a time, any other oil one by one: 4, 5,
  // 7, 12 and 15 elements, films at both ends of a pad and between
  const PadMedium alike;
  for (const double grid : {24.0, 30.0, 42.0, 72.0, 90.0}) {
    const PadFilm pad(0.3, 4.2, false, 2.5, grid);
    for (const double turn : {0.0, 1.3, 2.9, 4.8}) {
      const Vec2 e(0.6 * std::cos(turn), 0.6 * std::sin(turn)), W(0.3, -0.8);
      double fed = 0.0;
      const Vec2 G = pad.load(e, W), one_by_one = pad.load(e, W, alike, fed);
      EXPECT_LT((G - one_by_one).norm(), 1e-12 * G.norm()) << grid << " " << turn;
      const PadLoad load = pad.load_and_slopes(e, W);
      const PadFlowLoad want = pad.load_and_slopes(e, W, alike);
      EXPECT_LT((load.G - want.G).norm(), 1e-12 * G.norm());
      EXPECT_LT((load.by_e - want.by_e).norm(), 1e-10 * want.by_e.norm());
      EXPECT_LT((load.by_W - want.by_W).norm(), 1e-10 * want.by_W.norm());
    }
  }
}

TEST(FilmFlow, Conformance) {
  ConformanceOptions o = film_options(c, Omega);
  o.samples = 3;
  o.q0.assign(12, 0.0);
  o.v0.assign(12, 0.0);
  o.v0[3] = Omega;
  o.v0[9] = 20;
  o.q0[1] = 0.45 * c;
  o.q0[2] = -0.35 * c;
  o.v0[1] = 0.05 * c * Omega;
  const std::vector<double> kept = kept_of_two_pads();
  FiniteJournal turbulent = bearing(0.06, {}), fed = bearing(0.05, split()),
                all = bearing(0.08, lobe_pads(2, 0.4, 0.3, 0.6), 0.4);
  turbulent.turbulent_density = 2e5;  // far into turbulence
  fed.supply_pressure = 2e5;
  all.turbulent_density = 2e4;
  all.supply_pressure = 1e5;
  all.kept_from = 2;
  all.knots = knots;
  int number = 0;
  for (const FiniteJournal& film : {turbulent, fed, all}) {
    SCOPED_TRACE(number++);
    Keeping law;
    law.film = film;
    law.kept = kept.data();
    o.v0[1] = 0.05 * c * Omega;
    o.v0[2] = 0;
    check_kernel(LateralJoint<Keeping>{law}, o);
    o.v0[1] = -0.9 * c * Omega;
    o.v0[2] = 0.7 * c * Omega;
    check_kernel(LateralJoint<Keeping>{law}, o);
  }
}

// Where a pad is film, and what it carries: edges, turbulence and viscosity, at random.
TEST(FilmFlow, AgainstAFixedGrid) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<double> knot;
  for (int i = 0; i < knots; ++i)
    knot.push_back(log_viscosity(static_cast<double>(i) / (knots - 1)));
  int ruptured = 0, whole = 0;
  for (int n = 0; n < 60; ++n) {
    const double start = two_pi * share(random), arc = 0.6 + 2.8 * share(random),
                 beta = 20 * share(random), turn = two_pi * share(random);
    const Vec2 e = 0.85 * share(random) * Vec2(std::cos(turn), std::sin(turn));
    const double wind = two_pi * share(random);
    const Vec2 W(std::cos(wind), std::sin(wind));
    PadMedium m;
    const bool varies = n % 2 == 0;
    if (varies) m.log_viscosity = knot;
    m.reynolds = n % 3 == 0 ? 0.0 : 3000 * share(random);
    m.edge = n % 4 == 3 ? 0.0 : 0.3 * share(random) * share(random);
    const PadFilm pad(start, arc, false, beta, 120);
    const auto reference = [&](int N) {
      return OnFixedGrid(start, arc, beta, e, W, m, varies, N).load;
    };
    const Vec2 coarse = reference(2000), fine = reference(4000),
               exact = fine + (fine - coarse) / 3.0;
    double fed = 0;
    const Vec2 got = pad.load(e, W, m, fed);
    EXPECT_LT((got - exact).norm(), 3e-4 * exact.norm() + 1e-7)
        << n << " arc " << arc << " beta " << beta << " edge " << m.edge << " e " << e.norm();
    const double ends[] = {0.0, 0.5 * arc, arc};
    const PadProfile profile = pad.profile(e, W, m, ends);
    const OnFixedGrid grid(start, arc, beta, e, W, m, varies, 4000);
    EXPECT_NEAR(profile.pressure[1], grid.P[2000], 1e-3 * std::max(grid.P[2000], 0.01)) << n;
    EXPECT_NEAR(profile.pressure[0], m.edge, 1e-12);
    (profile.films.size() == 1 && !profile.films[0].free_from && !profile.films[0].free_to
         ? whole
         : ruptured)++;
  }
  EXPECT_GT(ruptured, 10);
  EXPECT_GT(whole, 10);
}

TEST(FilmFlow, OneViscosityIsThatOfAnotherOil) {
  FiniteJournal film = bearing(0.05, split());
  const FiniteJournal thin{R, 0.05, 0.6 * eta, film.surface};
  film.kept_from = 0;
  film.knots = 5;
  std::vector<double> kept;
  for (int k = 0; k < 2; ++k) {
    kept.insert(kept.end(), {0.0, 0.0});
    kept.insert(kept.end(), 5, std::log(0.6));
  }
  const Vec2 r(0.3 * c, -0.5 * c);
  FilmForce with, direct;
  film.evaluate(at_rest(r, Omega, kept.data()), with);
  thin.evaluate(at_rest(r), direct);
  EXPECT_LT((with.F - direct.F).norm(), 1e-10 * direct.F.norm());
  EXPECT_NEAR(with.T, direct.T, 1e-10 * std::abs(direct.T));
}

TEST(FilmFlow, TurbulentFactors) {
  // W. of the formulas at Re = 5000
  const TurbulentFactors<double> f(5000.0);
  EXPECT_NEAR(12 * f.along, 12 + 0.0136 * std::pow(5000, 0.90), 1e-2);
  EXPECT_NEAR(12 * f.across, 12 + 0.0043 * std::pow(5000, 0.96), 1e-2);
  EXPECT_NEAR(f.shear, 1 + 0.0012 * std::pow(5000, 0.94), 1e-3);
  const TurbulentFactors<double> none(0.0);
  EXPECT_EQ(none.along, 1.0);
  EXPECT_EQ(none.shear, 1.0);
  // a short centred journal with a film of one thickness: drag is that factor
  FiniteJournal film = bearing(0.05, {});
  film.turbulent_density = 900;
  const double re = 900 * R * 3000 * c / eta;
  FilmForce f3;
  film.evaluate(at_rest(Vec2::Zero(), 3000), f3);
  const double laminar = -two_pi * eta * R * R * R * 0.05 * 3000 / c;
  EXPECT_NEAR(f3.T / laminar, TurbulentFactors<double>(re).shear, 1e-9);
  EXPECT_NEAR(f3.T / laminar, 1 + 0.0012 * std::pow(re, 0.94), 2e-4);
}

// Torque times speed, and the pump, against what the fields of velocity lose: in the shear of the
// moving surface and in the flows that the pressure drives, summed over the pads.
TEST(FilmFlow, PowerBalance) {
  const std::vector<double> kept = kept_of_two_pads();
  FiniteJournal plain = bearing(0.05, split()), fed = plain, all = bearing(0.08, split(), 0.3);
  fed.supply_pressure = 3e5;
  all.supply_pressure = 1e5;
  all.turbulent_density = 4e4;
  all.kept_from = 2;
  all.knots = knots;
  for (const FiniteJournal& film : {plain, fed, all}) {
    const FilmPoint p = at_rest(Vec2(0.25 * c, -0.5 * c), Omega, kept.data());
    FilmForce f;
    film.evaluate(p, f);
    const double delivered = f.pump - (f.F.dot(p.w) + f.T * p.slip);
    double lost = 0, standing = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      constexpr std::size_t samples = 2001;
      const FilmField x = sample_film(film, k, p, samples);
      const double d = x.theta[1] - x.theta[0];
      for (std::size_t i = 0; i < samples; ++i) {
        const double h = x.thickness[i], mu = x.viscosity[i];
        const TurbulentFactors<double> t(film.turbulent_density * R * Omega * h / mu);
        const double shear = mu * t.shear * std::pow(R * Omega, 2) / h;
        const double flow =
            h * h * h / (film.source * mu) *
            (std::pow(x.slope[i] / R, 2) / t.along +
             film.leakage / std::pow(film.length, 2) * std::pow(x.pressure[i], 2) / t.across);
        lost += (i == 0 || i + 1 == samples ? 0.5 : 1.0) * (shear + flow) * R * film.length * d;
      }
      standing += film_standing(film, k, p, 900).power;
    }
    EXPECT_NEAR(lost / delivered, 1.0, 2e-5);
    EXPECT_NEAR(standing / delivered, 1.0, 1e-12);
  }
}

// A closed ring of oil at one pressure gives no force; a pad that has the oil behind it neither.
TEST(FilmFlow, PressureAllRoundCarriesNothing) {
  FiniteJournal film = bearing(2.0, two_groove_pads(0.3, 1e-6));  // long: no leak at the sides
  film.leakage = 0;
  film.supply_pressure = 5e5;
  FilmForce f;
  film.evaluate(at_rest(Vec2(0.1 * c, 0.2 * c), 0.0), f);
  EXPECT_LT(f.F.norm(), 1e-6 * 5e5 * R * 2.0);
  // oil that is fed presses a journal at rest away from the near side where it leaks
  FiniteJournal leaks = bearing(0.05, split());
  leaks.supply_pressure = 5e5;
  leaks.evaluate(at_rest(Vec2(0.0, -0.5 * c), 0.0), f);
  EXPECT_GT(std::abs(f.F.y()), 1.0);
  EXPECT_GT(f.pump, 0.0);
}

// A two-dimensional solution of one pad, by over-relaxation: side flow, largest pressure.
TEST(FilmFlow, FlowAndPressureAgainstTwoDimensionalReynolds) {
  constexpr double L = 0.05, arc = 160 * pi / 180, start = -170 * pi / 180;
  const FiniteJournal film = bearing(L, split());
  const Vec2 r(0.15 * c, -0.5 * c);
  constexpr int N = 160, M = 24;
  const double dth = arc / N, dz = 0.5 * L / M;
  const auto h = [&](double t) { return c - r.x() * std::cos(t) - r.y() * std::sin(t); };
  std::vector<double> P((N + 1) * (M + 1), 0.0);
  const auto at = [&](int i, int k) -> double& {
    return P[static_cast<std::size_t>(i * (M + 1) + k)];
  };
  for (int sweep = 0; sweep < 1500; ++sweep)
    for (int i = 1; i < N; ++i)
      for (int k = 0; k < M; ++k) {  // k = 0: the middle
        const double t = start + i * dth, a = std::pow(h(t - dth / 2), 3) / std::pow(R * dth, 2),
                     b = std::pow(h(t + dth / 2), 3) / std::pow(R * dth, 2),
                     axial = std::pow(h(t), 3) / (dz * dz);
        const double slope = (h(t + dth / 2) - h(t - dth / 2)) / (R * dth);
        const double sum = a * at(i - 1, k) + b * at(i + 1, k) +
                           axial * (at(i, k + 1) + (k == 0 ? at(i, 1) : at(i, k - 1))) -
                           6 * eta * R * Omega * slope;
        at(i, k) = std::max(0.0, at(i, k) + 1.8 * (sum / (a + b + 2 * axial) - at(i, k)));
      }
  double highest = 0, side = 0;
  for (int i = 0; i <= N; ++i) {
    const double edge =
        (3 * 0.0 - 4 * at(i, M - 1) + at(i, M - 2)) / (2 * dz);  // dp/dz at the side
    side += (i == 0 || i == N ? 0.5 : 1.0) * 2 * R * dth * -edge * std::pow(h(start + i * dth), 3) /
            (12 * eta);
    highest = std::max(highest, at(i, 0));
  }
  // the lower pad: start -170 deg
  const FilmPoint p = at_rest(r);
  for (std::size_t k = 0; k < 2; ++k) {
    const double middle = film.surface->arcs()[k].start + 0.5 * arc;
    const FilmStanding s = film_standing(film, k, p, 900);
    if (std::sin(middle) > 0) continue;
    EXPECT_NEAR(s.highest / highest, 1.0, 0.02);
    EXPECT_NEAR(std::abs(s.side_flow) / std::abs(side), 1.0, 0.04);
    EXPECT_NEAR(s.inflow - s.outflow, s.side_flow, 1e-12 * s.inflow);
    EXPECT_NEAR(s.thinnest, c - r.norm(), 1e-12);
    EXPECT_NEAR(s.reynolds, 900 * R * Omega * std::max(h(start), h(start + arc)) / eta,
                1e-3 * s.reynolds);
  }
}
