// Films that conserve mass (Jakobsson, Floberg, Olsson), with a profile along the axis and on a grid: a
// long journal in closed form, Elrod's equation on a two-dimensional grid, flow, tangents.
#include "conformance.hpp"
#include "journal_statics.hpp"
#include <elements/films/film_field.hpp>
#include <elements/films/tilting_pad.hpp>
#include <Eigen/SparseLU>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

constexpr double c = 1e-4, eta = 0.02, Omega = 300, R = 0.05;
constexpr double deg = pi / 180;

FiniteJournal conserving(double L, const std::vector<JournalPad>& pads, double preload = 0,
                         double supply = 0) {
  FiniteJournal b{R, L, eta, std::make_shared<JournalSurface>(c, preload, pads, 72)};
  b.supply_pressure = supply;
  b.mass_conserving = true;
  return b;
}
std::vector<JournalPad> split() { return two_groove_pads(0.0, 20 * deg); }

/// The same film on a grid along the axis too. columns: round the circumference.
FiniteJournal on_grid(FiniteJournal b, int columns = 240, int rows = 6,
                      const std::vector<std::vector<Recess>>& recesses = {}) {
  std::vector<GridPad> pads;
  for (std::size_t k = 0; k < b.surface->arcs().size(); ++k) {
    const JournalSurface::Arc& arc = b.surface->arcs()[k];
    const int own = static_cast<int>(std::lround(columns * arc.length / two_pi));
    pads.emplace_back(arc.start, arc.length, arc.round, R / b.length, own, rows,
                      k < recesses.size() ? recesses[k] : std::vector<Recess>{});
  }
  b.grid = std::make_shared<const std::vector<GridPad>>(std::move(pads));
  b.leakage = b.source = 12.0;
  return b;
}
/// A pocket in the upper pad that ends at a dam, a relief track in the lower one. leading: the end by
/// which the journal enters.
FiniteJournal dam_bearing(double supply = 0, bool leading_at_end = false) {
  const double arc = 160 * deg, pocket = 125 * deg, from = leading_at_end ? arc - pocket : 0.0;
  return on_grid(conserving(0.07, split(), 0.0, supply), 240, 6,
                 {{{from, from + pocket, 2 * c, 2 * c, 5.0 / 7, false}},
                  {{0.0, arc, 0.0, 0.0, 1.5 / 7, true}}});
}

FilmPoint at_rest(const Vec2& r, double spin = Omega) {
  LateralMotion m;
  m.r = r;
  m.v.setZero();
  m.spin = spin;
  return FilmLaw<FiniteJournal>::point(m);
}
Vec2 place(double eccentricity, double angle) {
  return eccentricity * c * Vec2(std::cos(angle), std::sin(angle));
}

PadProfile profile_of(const FiniteJournal& b, std::size_t k, const FilmPoint& p,
                      const std::vector<double>& theta) {
  return b.pad(k).profile(b.place(k, p).e, b.place(k, p).W, b.medium(k, p), theta);
}

/// A root of f between a and b, where it changes its sign.
template <class F>
double root(double a, double b, const F& f) {
  const bool low = f(a) < 0.0;
  for (int k = 0; k < 200; ++k) {
    const double half = 0.5 * (a + b);
    ((f(half) < 0.0) == low ? a : b) = half;
  }
  return 0.5 * (a + b);
}

/// Simpson's rule.
template <class F>
auto integral(double a, double b, const F& f) {
  constexpr int n = 4000;
  auto sum = f(a);
  sum += f(b);
  for (int k = 1; k < n; ++k)
    sum += (k % 2 == 1 ? 4.0 : 2.0) * f(a + (b - a) * k / n);
  return decltype(sum)(sum * ((b - a) / (3.0 * n)));
}

struct LongCase {
  double eccentricity, thinnest, supply;
};
constexpr LongCase long_cases[] = {{0.3, 342 * deg, 0},
                                   {0.6, 345 * deg, 0},
                                   {0.85, 340 * deg, 0},
                                   {0.5, 342 * deg, 2e4},
                                   {0.7, 338 * deg, 1e5}};

/// No flow along the axis: h^3 P' = 6 eta s (R/c)^2 (h - g) with one g for all that follows a rupture,
/// where h = g. Groove at theta = 0 with a pressure; the gap opens from there, so that the film
/// ruptures, and forms again where the pressure of the other end of the pad is met:
///   int_0^r (h - h(r))/h^3 = -p_s/unit,   int_f^end (h - h(r))/h^3 = p_s/unit
/// Integrals by Simpson's rule; at p_s = 0 the film ruptures in the groove itself.
struct LongFilm {
  static constexpr double unit = 6.0 * eta * Omega * R * R / (c * c), end = 350 * deg;
  LongCase given;
  double rupture = 0, from = 0, content = 0;

  explicit LongFilm(const LongCase& k) : given(k) {
    if (k.supply > 0)
      rupture = root(1e-9, k.thinnest - pi,
                     [&](double r) { return rise(0.0, r, h(r)) + k.supply / unit; });
    content = h(rupture);
    const double latest = 2.0 * k.thinnest - two_pi - rupture;  // h = content again
    from = root(rupture, latest, [&](double f) { return rise(f, end, content) - k.supply / unit; });
  }
  double h(double t) const { return 1.0 - given.eccentricity * std::cos(t - given.thinnest); }
  double rise(double a, double b, double g) const {
    return integral(a, b, [&](double t) { return (h(t) - g) / std::pow(h(t), 3); });
  }
  /// int P n, less that of the pressure behind the pad.
  Vec2 load() const {
    Vec2 G = between(from, end, given.supply, 0.0);
    if (given.supply > 0) G += between(0.0, rupture, 0.0, given.supply);
    return G - given.supply * Vec2(std::sin(end), 1.0 - std::cos(end));
  }

 private:
  /// int P n by parts, with N' = n.
  Vec2 between(double a, double z, double P_z, double P_a) const {
    const auto N = [](double t) { return Vec2(std::sin(t), -std::cos(t)); };
    return P_z * N(z) - P_a * N(a) - unit * integral(a, z, [&](double t) {
                                       return Vec2(N(t) * ((h(t) - content) / std::pow(h(t), 3)));
                                     });
  }
};

/// Elrod's equation of one pad from the groove at `start` (full, at the pressure of supply) on N cells
/// along and M over half the length, by active sets: p > 0 where the share r of the gap that oil fills
/// is 1, p = 0 elsewhere. The flow from cell to cell is r h at the face between them.
struct OnTwoDimensions {
  Vec2 force = Vec2::Zero();  ///< on the journal, less that of the supply behind the pad, N
  double inflow = 0, outflow = 0, sides = 0;  ///< m3/s
  bool settled = false;

  OnTwoDimensions(double start, double arc, double L, const Vec2& e, double supply, int N, int M) {
    const double dx = arc / N, dz = 0.5 * L / R / M;
    const double unit = 6.0 * eta * Omega * std::pow(R / c, 2), edge = supply / unit;
    const auto h = [&](double t) { return 1.0 - e.x() * std::cos(t) - e.y() * std::sin(t); };
    const auto face = [&](int i) { return h(start + i * dx); };
    const auto cube = [](double x) { return x * x * x; };
    const auto number = [M](int i, int k) { return i * M + k; };
    std::vector<char> full(static_cast<std::size_t>(N * M), 1);
    VecX x;
    const auto is_full = [&](int i, int k) { return full[static_cast<std::size_t>(number(i, k))]; };
    for (int round = 0; round < 200 && !settled; ++round) {
      std::vector<Eigen::Triplet<double>> entries;
      VecX b = VecX::Zero(N * M);
      const auto add = [&](int row, int i, int k, double by_p, double by_r) {
        if (is_full(i, k)) {
          entries.emplace_back(row, number(i, k), by_p);
          b[row] -= by_r;
        } else {
          entries.emplace_back(row, number(i, k), by_r);
        }
      };
      for (int i = 0; i < N; ++i)
        for (int k = 0; k < M; ++k) {
          const int row = number(i, k);
          const double west = cube(face(i)) / dx * dz, east = cube(face(i + 1)) / dx * dz;
          const double axial = cube(h(start + (i + 0.5) * dx)) / dz * dx;
          double own = 0.0;
          if (i > 0) {
            add(row, i - 1, k, -west, -face(i) * dz);
            own += west;
          } else {
            b[row] += 2.0 * west * edge + face(0) * dz;
            own += 2.0 * west;
          }
          if (i + 1 < N) {
            add(row, i + 1, k, -east, 0.0);
            own += east;
          } else {
            b[row] += 2.0 * east * edge;
            own += 2.0 * east;
          }
          if (k > 0) {
            add(row, i, k - 1, -axial, 0.0);
            own += axial;
          }
          if (k + 1 < M) {
            add(row, i, k + 1, -axial, 0.0);
            own += axial;
          } else {
            own += 2.0 * axial;
          }
          add(row, i, k, own, face(i + 1) * dz);
        }
      Eigen::SparseMatrix<double> A(N * M, N * M);
      A.setFromTriplets(entries.begin(), entries.end());
      Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(A);
      x = lu.solve(b);
      settled = true;
      for (std::size_t j = 0; j < full.size(); ++j) {
        const double value = x[static_cast<Index>(j)];
        const char want = full[j] ? value >= 0.0 : value > 1.0;
        settled = settled && want == full[j];
        full[j] = want;
      }
    }
    force += supply * R * L *
             Vec2(std::sin(start + arc) - std::sin(start), std::cos(start) - std::cos(start + arc));
    const double flow = 0.5 * Omega * R * c * R;  // of h = 1 over the length R
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < M; ++k) {
        const double p = is_full(i, k) ? x[number(i, k)] : 0.0, t = start + (i + 0.5) * dx;
        const double filled = is_full(i, k) ? 1.0 : x[number(i, k)];
        force -= 2.0 * unit * R * R * p * dx * dz * Vec2(std::cos(t), std::sin(t));
        if (k + 1 == M) sides += 2.0 * flow * cube(h(t)) * p / (0.5 * dz) * dx;
        if (i == 0) inflow += 2.0 * flow * dz * (face(0) - cube(face(0)) * (p - edge) / (0.5 * dx));
        if (i + 1 == N)
          outflow += 2.0 * flow * dz * (filled * face(N) - cube(face(N)) * (edge - p) / (0.5 * dx));
      }
  }
};

}  // namespace

TEST(MassConserving, LongJournal) {
  for (const LongCase& k : long_cases) {
    FiniteJournal b = conserving(1.0, {{0.0, LongFilm::end, 0.0}}, 0.0, k.supply);
    b.seal_ends();
    const LongFilm exact(k);
    const FilmPoint p = at_rest(place(k.eccentricity, k.thinnest));
    const std::vector<double> at{0.5 * (exact.rupture + exact.from),
                                 0.3 * exact.from + 0.7 * LongFilm::end};
    const PadProfile got = profile_of(b, 0, p, at);
    ASSERT_EQ(got.films.size(), k.supply > 0 ? 2u : 1u);
    EXPECT_NEAR(got.films.back().from, exact.from, 1e-5) << k.thinnest;
    EXPECT_NEAR(got.films.back().to, LongFilm::end, 1e-9);
    if (k.supply > 0) {
      EXPECT_NEAR(got.films[0].to, exact.rupture, 1e-6);
    }
    EXPECT_NEAR(got.content[0], exact.content, 1e-6);
    EXPECT_EQ(got.pressure[0], 0.0);
    const double pressure = LongFilm::unit * exact.rise(exact.from, at[1], exact.content);
    EXPECT_NEAR(got.pressure[1] * b.pressure_unit(b.gap(0, p)), pressure, 1e-5 * pressure);
    FilmForce f;
    b.evaluate(p, f);
    EXPECT_LT((f.F + R * b.length * exact.load()).norm(), 1e-5 * f.F.norm()) << k.thinnest;
    // one flow through every section: what the rupture lets go
    const FilmStanding s = film_standing(b, 0, p, 900);
    const double flow = 0.5 * b.length * R * Omega * c * exact.content;
    EXPECT_NEAR(s.inflow, flow, 1e-9 * flow);
    EXPECT_NEAR(s.outflow, flow, 1e-6 * flow);  // the elements' integral of the wedge between
  }
}

TEST(MassConserving, AgainstTwoDimensionalElrod) {
  struct Case {
    double L, eccentricity, angle, supply;
  };
  for (const Case& k :
       {Case{0.05, 0.6, 110 * deg, 0}, Case{0.1, 0.6, 110 * deg, 0}, Case{0.1, 0.3, 50 * deg, 0},
        Case{0.1, 0.8, 230 * deg, 0}, Case{0.1, 0.6, 50 * deg, 2e5}}) {
    const FiniteJournal b = conserving(k.L, split(), 0.0, k.supply);
    const FilmPoint p = at_rest(place(k.eccentricity, k.angle));
    Vec2 force = Vec2::Zero(), exact_force = Vec2::Zero();
    for (std::size_t pad = 0; pad < 2; ++pad) {
      const JournalSurface::Arc& arc = b.surface->arcs()[pad];
      const OnTwoDimensions exact(arc.start, arc.length, k.L, p.r / c, k.supply, 96, 12);
      ASSERT_TRUE(exact.settled);
      const FilmStanding s = film_standing(b, pad, p, 900);
      const double full = 0.5 * k.L * R * Omega * c;  // of the gap c, dragged
      EXPECT_NEAR(exact.inflow, exact.outflow + exact.sides, 1e-10 * full);
      EXPECT_NEAR(s.inflow, s.outflow + s.side_flow, 1e-12 * full);
      const double tolerance = k.supply > 0 ? 0.11 : 0.03;  // profile of a pressure at the groove
      EXPECT_NEAR(s.inflow, exact.inflow, tolerance * full);
      EXPECT_NEAR(s.outflow, exact.outflow, 0.03 * full);
      EXPECT_NEAR(s.side_flow, exact.sides, tolerance * full);
      force -= s.force;
      exact_force += exact.force;
    }
    EXPECT_LT((force - exact_force).norm(), 0.05 * exact_force.norm())
        << k.L << " " << k.eccentricity << " " << k.angle / deg;
  }
}

/// A force, and slopes of it in (r, w, slip) by differences.
TEST(MassConserving, TangentIsThatOfTheForce) {
  for (const double supply : {0.0, 2e5})
    for (const double spin : {Omega, -Omega})
      for (const bool lobed : {false, true}) {
        const FiniteJournal b = lobed ? conserving(0.05, lobe_pads(3, 0.3, 20 * deg), 0.3, supply)
                                      : conserving(0.05, split(), 0.0, supply);
        for (const double eccentricity : {0.3, 0.6, 0.8})
          for (const double angle : {55 * deg, 115 * deg, 305 * deg}) {
            const FilmPoint p = at_rest(place(eccentricity, angle), spin);
            if (!b.inside(p)) continue;
            FilmForce f;
            FilmTangent t;
            b.evaluate(p, f, t);
            const auto check = [&](const auto& moved, double h, double unit, const Vec2& F_by,
                                   double T_by) {
              FilmForce ahead, behind;
              b.evaluate(moved(h), ahead);
              b.evaluate(moved(-h), behind);
              const Vec2 F_slope = (ahead.F - behind.F) / (2 * h);
              EXPECT_LT((F_slope - F_by).norm() * unit, 1e-5 * f.F.norm());
              EXPECT_NEAR((ahead.T - behind.T) / (2 * h) * unit, T_by * unit, 1e-5 * std::abs(f.T));
            };
            for (int k = 0; k < 2; ++k) {
              const auto shifted = [&](double h) {
                FilmPoint q = p;
                q.r[k] += h;
                return q;
              };
              const auto pushed = [&](double h) {
                FilmPoint q = p;
                q.w[k] += h;
                return q;
              };
              check(shifted, 1e-5 * c, c, t.F_r.col(k), t.T_r[k]);
              check(pushed, 1e-5 * c * Omega, c * Omega, t.F_w.col(k), t.T_w[k]);
            }
            const auto spun = [&](double h) {
              FilmPoint q = p;
              q.slip += h;
              return q;
            };
            check(spun, 1e-5 * Omega, Omega, t.F_slip, t.T_slip);
          }
      }
}

TEST(MassConserving, MirroredTurnsTheOtherWay) {
  const FiniteJournal b = conserving(0.06, lobe_pads(3, 0.5 * pi, 20 * deg), 0.2, 5e4);
  for (const double angle : {0.3, 1.4, 2.9, 4.4}) {
    const Vec2 r = place(0.6, angle);
    FilmForce f, g;
    b.evaluate(at_rest(r), f);
    b.evaluate(at_rest(Vec2(-r.x(), r.y()), -Omega), g);
    EXPECT_NEAR(g.F.x(), -f.F.x(), 1e-9 * f.F.norm());
    EXPECT_NEAR(g.F.y(), f.F.y(), 1e-9 * f.F.norm());
    EXPECT_NEAR(g.T, -f.T, 1e-9 * std::abs(f.T));
  }
}

TEST(MassConserving, WithoutAFilmBehindRupturedOilItIsReynolds) {
  // every film begins in a groove: what the others lack is drag in ruptured film
  const FiniteJournal b = conserving(0.05, lobe_pads(3, 0.5 * pi, 20 * deg), 0.5);
  FiniteJournal reynolds = b;
  reynolds.mass_conserving = false;
  for (const double angle : {0.3, 1.4, 2.9, 4.4}) {
    const FilmPoint p = at_rest(place(0.4, angle));
    FilmForce f, g;
    FilmTangent t, u;
    b.evaluate(p, f, t);
    reynolds.evaluate(p, g, u);
    EXPECT_LT((f.F - g.F).norm(), 1e-7 * g.F.norm());
    EXPECT_LT((t.F_r - u.F_r).norm(), 1e-6 * u.F_r.norm());
    EXPECT_LT((t.F_w - u.F_w).norm(), 1e-6 * u.F_w.norm());
    EXPECT_LT(f.T, 0.0);
    EXPECT_GT(f.T, g.T);
  }
}

TEST(MassConserving, StarvedPadsCarryNothing) {
  // what leaves the groove fills no gap behind it: thinnest place of the lower pad at its start
  const FiniteJournal b = conserving(0.05, split());
  const FilmPoint p = at_rest(place(0.6, 200 * deg));
  const FilmStanding s = film_standing(b, 1, p, 900);
  EXPECT_GT(s.force.norm(), 0.0);  // 190 to 200 deg closes still
  const FilmStanding starved = film_standing(b, 1, at_rest(place(0.6, 185 * deg)), 900);
  EXPECT_EQ(starved.force.norm(), 0.0);
  EXPECT_EQ(starved.side_flow, 0.0);
  EXPECT_NEAR(starved.inflow, 0.5 * b.length * R * Omega * c * (1.0 - 0.6 * std::cos(5 * deg)),
              1e-12);
}

TEST(MassConserving, ForceIsSmoothAllRound) {
  // The journal goes round at one eccentricity. Where a film parts in two, or from its groove, the force
  // has a corner, for the gap between them opens as a square root: 2e-4 over half a degree.
  for (const double supply : {0.0, 1e5})
    for (const double eccentricity : {0.4, 0.75}) {
      const FiniteJournal b = conserving(0.06, split(), 0.0, supply);
      constexpr double step = 0.5 * deg;
      const auto at_angle = [&](double angle) {
        FilmForce f;
        b.evaluate(at_rest(place(eccentricity, angle)), f);
        return f.F;
      };
      for (int k = 0; k < 90; ++k) {
        const double angle = 2.0 * k * deg;
        const Vec2 here = at_angle(angle);
        const Vec2 between = (-at_angle(angle - 2 * step) + 4.0 * at_angle(angle - step) +
                              4.0 * at_angle(angle + step) - at_angle(angle + 2 * step)) /
                             6.0;
        EXPECT_LT((here - between).norm(), 3e-4 * here.norm())
            << supply << " " << eccentricity << " " << 2 * k;
      }
    }
}

TEST(MassConservingOnGrid, LongJournal) {
  // R/L next to nothing: alike along the axis but for the side, which stands at no pressure
  constexpr double inside = 1.0 - 1.0 / 18;  // the nodes of the side, of six rows
  for (const LongCase& k : long_cases) {
    const FiniteJournal b =
        on_grid(conserving(1e4 * R, {{0.0, LongFilm::end, 0.0}}, 0.0, k.supply), 480);
    const LongFilm exact(k);
    const FilmPoint p = at_rest(place(k.eccentricity, k.thinnest));
    FilmForce f;
    b.evaluate(p, f);
    // at the side a pressure of the groove is missed
    const Vec2 behind = k.supply * Vec2(std::sin(LongFilm::end), 1.0 - std::cos(LongFilm::end));
    const Vec2 load = inside * (exact.load() + behind) - behind;
    // where the groove has a pressure a film of few cells ruptures behind it
    const double tolerance = k.supply > 0 ? 5e-3 : 1e-3;
    EXPECT_LT((f.F + R * b.length * load).norm(), tolerance * f.F.norm()) << k.thinnest;
    const FilmStanding s = film_standing(b, 0, p, 900);
    const double flow = 0.5 * b.length * R * Omega * c * exact.content;
    EXPECT_NEAR(s.inflow, s.outflow + s.side_flow, 1e-10 * flow);
  }
}

TEST(MassConservingOnGrid, AgainstTwoDimensionalElrod) {
  struct Case {
    double L, eccentricity, angle, supply;
  };
  for (const Case& k :
       {Case{0.05, 0.6, 110 * deg, 0}, Case{0.1, 0.6, 110 * deg, 0}, Case{0.1, 0.3, 50 * deg, 0},
        Case{0.1, 0.8, 230 * deg, 0}, Case{0.1, 0.6, 50 * deg, 2e5}}) {
    const FilmPoint p = at_rest(place(k.eccentricity, k.angle));
    const double full = 0.5 * k.L * R * Omega * c;  // of the gap c, dragged
    Vec2 exact_force = Vec2::Zero();
    double inflow = 0, outflow = 0, sides = 0;
    for (const double start : {10 * deg, 190 * deg}) {
      const OnTwoDimensions coarse(start, 160 * deg, k.L, p.r / c, k.supply, 48, 6);
      const OnTwoDimensions exact(start, 160 * deg, k.L, p.r / c, k.supply, 96, 12);
      ASSERT_TRUE(coarse.settled && exact.settled);
      exact_force += (4.0 * exact.force - coarse.force) / 3.0;  // its error falls with the square
      inflow += exact.inflow;
      outflow += exact.outflow;
      sides += exact.sides;
    }
    for (const bool fine : {false, true}) {
      const FiniteJournal b =
          on_grid(conserving(k.L, split(), 0.0, k.supply), fine ? 480 : 120, fine ? 10 : 6);
      FilmForce f;
      b.evaluate(p, f);
      // extrapolated, the other is right to 7e-4
      EXPECT_LT((f.F - exact_force).norm(), (fine ? 1e-3 : 5e-3) * exact_force.norm()) << k.L;
      double in = 0, out = 0, at_sides = 0;
      for (std::size_t pad = 0; pad < 2; ++pad) {
        const FilmStanding s = film_standing(b, pad, p, 900);
        EXPECT_NEAR(s.inflow, s.outflow + s.side_flow, 1e-12 * full);
        in += s.inflow;
        out += s.outflow;
        at_sides += s.side_flow;
      }
      // where a pressure of the groove meets the side, flow grows with every refinement
      const double tolerance = k.supply > 0 ? 0.15 : 0.01;
      EXPECT_NEAR(in, inflow, tolerance * full);
      EXPECT_NEAR(out, outflow, tolerance * full);
      EXPECT_NEAR(at_sides, sides, tolerance * full);
    }
  }
}

TEST(MassConservingOnGrid, WhatComesIntoRecessesLeaves) {
  for (const double supply : {0.0, 1e5})
    for (const double spin : {Omega, -Omega})
      for (const double angle : {0.4, 1.9, 3.5, 5.0}) {
        const FiniteJournal b = dam_bearing(supply);
        for (std::size_t pad = 0; pad < 2; ++pad) {
          const FilmStanding s = film_standing(b, pad, at_rest(place(0.5, angle), spin), 900);
          const double full = 0.5 * b.length * R * Omega * c;
          EXPECT_GT(s.inflow, 0.1 * full);
          EXPECT_NEAR(s.inflow, s.outflow + s.side_flow, 1e-11 * full) << angle << ' ' << pad;
        }
      }
}

TEST(MassConservingOnGrid, BehindARuptureTangentsAreThoseOfTheForce) {
  // one pad whose gap opens from its start on, so that no film ruptures downstream, where slopes are
  // those of a front between two nodes
  FiniteJournal b = on_grid(conserving(0.07, {{0.0, 350 * deg, 0.0}}), 120);
  for (const double density : {0.0, 900.0})
    for (const double spin : {Omega, -Omega})
      for (const Vec2& velocity : {Vec2(0.0, 0.0), Vec2(0.04, 0.03)}) {
        b.turbulent_density = density;
        LateralMotion m;
        m.r = place(0.6, spin > 0 ? 352 * deg : -2 * deg);
        m.v = c * Omega * velocity;
        m.spin = spin;
        const FilmPoint p = FilmLaw<FiniteJournal>::point(m);
        FilmForce f;
        FilmTangent t;
        b.evaluate(p, f, t);
        const auto check = [&](const auto& moved, double unit, const Vec2& F_by, double T_by) {
          const double h = 1e-6 * unit;
          FilmForce ahead, behind;
          b.evaluate(moved(h), ahead);
          b.evaluate(moved(-h), behind);
          EXPECT_LT(((ahead.F - behind.F) / (2 * h) - F_by).norm() * unit, 1e-6 * f.F.norm());
          EXPECT_NEAR((ahead.T - behind.T) / (2 * h) * unit, T_by * unit, 1e-6 * std::abs(f.T));
        };
        for (int k = 0; k < 2; ++k) {
          const auto shifted = [&](double h) {
            FilmPoint q = p;
            q.r[k] += h;
            return q;
          };
          const auto pushed = [&](double h) {
            FilmPoint q = p;
            q.w[k] += h;
            return q;
          };
          check(shifted, c, t.F_r.col(k), t.T_r[k]);
          check(pushed, c * Omega, t.F_w.col(k), t.T_w[k]);
        }
        const auto spun = [&](double h) {
          FilmPoint q = p;
          q.slip += h;
          return q;
        };
        check(spun, Omega, t.F_slip, t.T_slip);
      }
}

TEST(MassConservingOnGrid, CoefficientsAreConverged) {
  // as those of Reynolds' film (GridFilm.CoefficientsAreConverged), against twice as fine a grid
  const FiniteJournal own = on_grid(conserving(0.05, split())),
                      fine = on_grid(conserving(0.05, split()), 480);
  Random random(7);
  int far = 0, looked = 0;
  for (int n = 0; n < 20; ++n) {
    const Vec2 at = random.vector<2>();
    const FilmPoint p = at_rest(0.8 * c * at / std::max(1.0, at.norm()));
    FilmForce f;
    FilmTangent t, u;
    own.evaluate(p, f, t);
    fine.evaluate(p, f, u);
    const double apart =
        std::max((t.F_r - u.F_r).norm() / u.F_r.norm(), (t.F_w - u.F_w).norm() / u.F_w.norm());
    ++looked;
    far += apart > 5e-3 ? 1 : 0;
    EXPECT_LT(apart, 2e-2) << p.r.transpose() / c;
  }
  EXPECT_LE(10 * far, looked);
}

TEST(MassConservingOnGrid, WithoutAFilmBehindRupturedOilItIsReynolds) {
  const FiniteJournal b = on_grid(conserving(0.05, lobe_pads(3, 0.5 * pi, 20 * deg), 0.5));
  FiniteJournal reynolds = b;
  reynolds.mass_conserving = false;
  for (const double angle : {0.3, 1.4, 2.9, 4.4}) {
    const FilmPoint p = at_rest(place(0.4, angle));
    FilmForce f, g;
    FilmTangent t, u;
    b.evaluate(p, f, t);
    reynolds.evaluate(p, g, u);
    EXPECT_LT((f.F - g.F).norm(), 1e-10 * g.F.norm());
    EXPECT_LT((t.F_r - u.F_r).norm(), 1e-9 * u.F_r.norm());
    EXPECT_LT((t.F_w - u.F_w).norm(), 1e-9 * u.F_w.norm());
    EXPECT_LT(f.T, 0.0);
    EXPECT_GT(f.T, g.T);
  }
}

TEST(MassConservingOnGrid, LessOilIsLessPressure) {
  const FiniteJournal b = dam_bearing();
  FiniteJournal reynolds = b;
  reynolds.mass_conserving = false;
  double least = 1.0;  // of the mean pressures, over Reynolds'
  for (const double angle : {0.4, 1.9, 3.0, 3.5, 5.0})
    for (std::size_t pad = 0; pad < 2; ++pad) {
      const FilmPoint p = at_rest(place(0.5, angle));
      const GridField f = (*b.grid)[pad].field(b.drive(pad, p)),
                      g = (*b.grid)[pad].field(reynolds.drive(pad, p));
      double sum = 0, of_reynolds = 0;
      for (std::size_t i = 0; i < f.mean.size(); ++i) {
        EXPECT_LE(f.mean[i], g.mean[i] + 1e-9 * g.highest) << angle << ' ' << pad << ' ' << i;
        sum += f.mean[i];
        of_reynolds += g.mean[i];
      }
      if (of_reynolds > 0) least = std::min(least, sum / of_reynolds);
    }
  EXPECT_LT(least, 0.9);
}

TEST(MassConservingOnGrid, MirroredTurnsTheOtherWay) {
  // a point that moves: squeeze is handed on too
  const FiniteJournal b = dam_bearing(5e4), mirrored = dam_bearing(5e4, true);
  for (const double angle : {0.3, 1.4, 2.9, 4.4}) {
    LateralMotion m;
    m.r = place(0.6, angle);
    m.v = c * Omega * Vec2(0.05, 0.1);
    m.spin = Omega;
    FilmForce f, g;
    b.evaluate(FilmLaw<FiniteJournal>::point(m), f);
    m.r.x() = -m.r.x();
    m.v.x() = -m.v.x();
    m.spin = -Omega;
    mirrored.evaluate(FilmLaw<FiniteJournal>::point(m), g);
    EXPECT_NEAR(g.F.x(), -f.F.x(), 1e-9 * f.F.norm());
    EXPECT_NEAR(g.F.y(), f.F.y(), 1e-9 * f.F.norm());
    EXPECT_NEAR(g.T, -f.T, 1e-9 * std::abs(f.T));
  }
}

TEST(MassConservingOnGrid, ForceIsAsSmoothAsReynolds) {
  // A step of 0.1 degrees is less than a tenth of a cell: kinks are those of single nodes.
  const auto kink = [](const FiniteJournal& b) {
    std::vector<Vec2> F;
    for (int k = 0; k < 400; ++k) {
      FilmForce f;
      b.evaluate(at_rest(place(0.75, (80 + 0.1 * k) * deg)), f);
      F.push_back(f.F);
    }
    double worst = 0;
    for (std::size_t k = 2; k + 2 < F.size(); ++k) {
      const Vec2 between = (-F[k - 2] + 4.0 * F[k - 1] + 4.0 * F[k + 1] - F[k + 2]) / 6.0;
      worst = std::max(worst, (F[k] - between).norm() / F[k].norm());
    }
    return worst;
  };
  const FiniteJournal b = on_grid(conserving(0.06, split()));
  FiniteJournal reynolds = b;
  reynolds.mass_conserving = false;
  EXPECT_LT(kink(reynolds), 5e-6);
  EXPECT_LT(kink(b), 5e-6);
}

TEST(MassConservingOnGrid, SettlesAndLosesPowerInEveryMotion) {
  Random random(3);
  FiniteJournal b = dam_bearing();
  for (int n = 0; n < 60; ++n) {
    b.supply_pressure = n % 2 == 0 ? 0.0 : 5e5;
    const FilmPoint p{0.6 * c * random.vector<2>() / 1.5, c * Omega * random.vector<2>(),
                      Omega * random.vector<1>()[0]};
    FilmForce f;
    FilmTangent t;
    b.evaluate(p, f, t);
    ASSERT_TRUE(f.F.allFinite() && t.F_r.allFinite() && t.F_w.allFinite());
    EXPECT_GE(f.pump - (f.F.dot(p.w) + f.T * p.slip), 0.0);
  }
}
