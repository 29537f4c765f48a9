// Films that conserve mass (Jakobsson, Floberg, Olsson): a long journal in closed form, Elrod's
// equation on a two-dimensional grid, flow, tangents.
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
  // No flow along the axis: h^3 P' = 6 eta s (R/c)^2 (h - g) with one g for all that follows a rupture,
  // where h = g. Groove at theta = 0 with a pressure; the gap opens from there, so that the film
  // ruptures, and forms again where the pressure of the other end of the pad is met:
  //   int_0^r (h - h(r))/h^3 = -p_s/unit,   int_f^end (h - h(r))/h^3 = p_s/unit
  // Integrals by Simpson's rule; at p_s = 0 the film ruptures in the groove itself.
  struct Case {
    double eccentricity, thinnest, supply;
  };
  constexpr double unit = 6.0 * eta * Omega * R * R / (c * c), end = 350 * deg;
  for (const Case& k : {Case{0.3, 342 * deg, 0}, Case{0.6, 345 * deg, 0}, Case{0.85, 340 * deg, 0},
                        Case{0.5, 342 * deg, 2e4}, Case{0.7, 338 * deg, 1e5}}) {
    FiniteJournal b = conserving(1.0, {{0.0, end, 0.0}}, 0.0, k.supply);
    b.seal_ends();
    const auto h = [&](double t) { return 1.0 - k.eccentricity * std::cos(t - k.thinnest); };
    const auto rise = [&](double from, double to, double g) {
      return integral(from, to, [&](double t) { return (h(t) - g) / std::pow(h(t), 3); });
    };
    double rupture = 0.0;
    if (k.supply > 0)
      rupture = root(1e-9, k.thinnest - pi,
                     [&](double r) { return rise(0.0, r, h(r)) + k.supply / unit; });
    const double g = h(rupture), latest = 2.0 * k.thinnest - two_pi - rupture;  // h = g again
    const double from =
        root(rupture, latest, [&](double f) { return rise(f, end, g) - k.supply / unit; });
    const FilmPoint p = at_rest(place(k.eccentricity, k.thinnest));
    const std::vector<double> at{0.5 * (rupture + from), 0.3 * from + 0.7 * end};
    const PadProfile got = profile_of(b, 0, p, at);
    ASSERT_EQ(got.films.size(), k.supply > 0 ? 2u : 1u);
    EXPECT_NEAR(got.films.back().from, from, 1e-5) << k.thinnest;
    EXPECT_NEAR(got.films.back().to, end, 1e-9);
    if (k.supply > 0) {
      EXPECT_NEAR(got.films[0].to, rupture, 1e-6);
    }
    EXPECT_NEAR(got.content[0], g, 1e-6);
    EXPECT_EQ(got.pressure[0], 0.0);
    EXPECT_NEAR(got.pressure[1] * b.pressure_unit(b.gap(0, p)), unit * rise(from, at[1], g),
                1e-5 * unit * rise(from, at[1], g));
    // int P n by parts, with N' = n
    const auto load = [&](double a, double z, double P_z, double P_a) {
      const auto N = [](double t) { return Vec2(std::sin(t), -std::cos(t)); };
      return Vec2(P_z * N(z) - P_a * N(a) - unit * integral(a, z, [&](double t) {
                                              return Vec2(N(t) * ((h(t) - g) / std::pow(h(t), 3)));
                                            }));
    };
    Vec2 G = load(from, end, k.supply, 0.0);
    if (k.supply > 0) G += load(0.0, rupture, 0.0, k.supply);
    G -= k.supply * Vec2(std::sin(end), 1.0 - std::cos(end));  // behind the pad
    FilmForce f;
    b.evaluate(p, f);
    EXPECT_LT((f.F + R * b.length * G).norm(), 1e-5 * f.F.norm()) << k.thinnest;
    // one flow through every section: what the rupture lets go
    const FilmStanding s = film_standing(b, 0, p, 900);
    const double flow = 0.5 * b.length * R * Omega * c * g;
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
