// Squeeze-film dampers.
#include "conformance.hpp"
#include <elements/films/finite_journal.hpp>
#include <elements/films/short_journal.hpp>
#include <elements/films/squeeze_film.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {
constexpr double R = 0.065, L = 0.02, c = 1.2e-4, eta = 0.006;
}

TEST(SqueezeFilm, Conformance) {
  ConformanceOptions o;
  o.u = 0.2 * c;
  o.du = 0.1;
  check_kernel(SqueezeFilm<ShortJournal>{{R, L, c, eta}}, o);
  check_kernel(SqueezeFilm<ShortFullFilm>{{R, L, c, eta}}, o);
  o.u = 1e-3 * c;
  o.du = 1e-3;  // boundaries of the finite film pass nodes: small steps
  o.tangent_tolerance = o.power_tolerance = 1e-7;
  o.q0.assign(12, 0.0);
  o.v0.assign(12, 0.0);
  o.q0[1] = 0.5 * c;
  o.q0[2] = 0.2 * c;
  o.v0[1] = 0.02;
  o.v0[2] = -0.05;
  FiniteJournal film{R, L, eta,
                     std::make_shared<JournalSurface>(c, 0.0, std::vector<JournalPad>{})};
  check_kernel(SqueezeFilm<FiniteJournal>{film}, o);
  film.surface =
      std::make_shared<JournalSurface>(c, 0.0, std::vector<JournalPad>{{0.1, two_pi - 0.1, pi}});
  film.seal_ends();
  check_kernel(SqueezeFilm<FiniteJournal>{film}, o);
}

TEST(SqueezeFilm, CircularCentredOrbit) {
  // pi film: F_r = -2 eta R L^3 w eps^2/(c^2 (1-eps^2)^2), F_t = -pi eta R L^3 w eps/(2 c^2
  // (1-eps^2)^1.5); 2 pi film: F_r = 0, twice F_t
  const double w = 350;
  for (double eps : {0.05, 0.3, 0.6, 0.9}) {
    const FilmPoint p{Vec2(eps * c, 0), Vec2(0, w * eps * c), 0.0};
    FilmForce half, full;
    ShortJournal{R, L, c, eta}.evaluate(p, half);
    ShortFullFilm{R, L, c, eta}.evaluate(p, full);
    const double u = 1 - eps * eps, unit = eta * R * L * L * L * w / (c * c);
    EXPECT_NEAR(half.F.x(), -2 * unit * eps * eps / (u * u), 1e-11 * unit / (u * u));
    EXPECT_NEAR(half.F.y(), -pi * unit * eps / (2 * std::pow(u, 1.5)), 1e-11 * unit / (u * u));
    EXPECT_NEAR(full.F.x(), 0.0, 1e-12 * unit);
    EXPECT_NEAR(full.F.y(), -pi * unit * eps / std::pow(u, 1.5), 1e-11 * unit / (u * u));
  }
}

TEST(SqueezeFilm, DragOfTheFullFilm) {
  // Shear eta R s/h over the whole circle, at the lever R: -eta R^3 L s int dtheta/(c (1 - e cos
  // theta)), by the rectangle rule (exact here).
  for (const double e : {0.0, 0.3, 0.7}) {
    FilmForce f;
    FilmTangent t;
    const double slip = 120;
    ShortFullFilm{R, L, c, eta}.evaluate({Vec2(0.6 * e * c, -0.8 * e * c), Vec2(1e-3, 2e-3), slip},
                                         f, t);
    double shear = 0;
    for (int k = 0; k < 400; ++k)
      shear += two_pi / 400 / (1 - e * std::cos(two_pi * k / 400));
    const double torque = -eta * R * R * R * L / c * shear;
    EXPECT_NEAR(f.T, torque * slip, 1e-12 * std::abs(torque * slip));
    EXPECT_NEAR(t.T_slip, torque, 1e-12 * std::abs(torque));
  }
}

TEST(SqueezeFilm, SealedEndsAgainstLongFilm) {
  // Radial squeeze at the centre towards +y with the feed opposite: (h^3 P')' = -12 eta R^2 w
  // cos(theta) with P = 0 at theta = pi gives P = 12 eta R^2 w/c^3 (1 + cos theta), positive all
  // round: F = -12 pi eta R^3 L w/c^3, the long damper that does not cavitate.
  FiniteJournal film{R, L, eta,
                     std::make_shared<JournalSurface>(
                         c, 0.0, std::vector<JournalPad>{{-pi + 1e-3, pi - 1e-3, 0.0}}, 144)};
  film.seal_ends();
  const double w = 1e-3;
  FilmForce f;
  film.evaluate({Vec2::Zero(), Vec2(w, 0), 0.0}, f);
  const double exact = -12 * pi * eta * R * R * R * L * w / (c * c * c);
  EXPECT_NEAR(f.F.x(), exact, 2e-3 * std::abs(exact));
  EXPECT_NEAR(f.F.y(), 0.0, 1e-6 * std::abs(exact));
  // open ends leak: far softer
  FilmForce open;
  FiniteJournal{R, L, eta, film.surface}.evaluate({Vec2::Zero(), Vec2(w, 0), 0.0}, open);
  EXPECT_LT(std::abs(open.F.x()), 0.05 * std::abs(f.F.x()));
}

// At rest a cavitated film has another derivative in each direction; the tangent is the linear law
// nearest to it in all of them. The short film gives half of the full one in closed form; a finite
// film that is short comes near it, and any finite one is the mean of its forces over many
// directions.
TEST(SqueezeFilm, TangentOfAFilmAtRestIsTheMeanOverDirections) {
  const auto plain = std::make_shared<JournalSurface>(c, 0.0, std::vector<JournalPad>{});
  const auto fed =
      std::make_shared<JournalSurface>(c, 0.0, std::vector<JournalPad>{{0.1, two_pi - 0.1, pi}});
  FiniteJournal sealed{R, L, eta, fed};
  sealed.seal_ends();
  for (const Vec2& r : {Vec2(0, 0), Vec2(0.2 * c, -0.3 * c)}) {
    const FilmPoint rest{r, Vec2::Zero(), 0.0};
    FilmForce f;
    FilmTangent half, full;
    ShortJournal{R, 0.1 * R, c, eta}.evaluate(rest, f, half);
    ShortFullFilm{R, 0.1 * R, c, eta}.evaluate(rest, f, full);
    EXPECT_LT((half.F_w - 0.5 * full.F_w).norm(), 1e-12 * full.F_w.norm());
    FilmTangent t;
    FiniteJournal{R, 0.1 * R, eta, plain}.evaluate(rest, f, t);
    EXPECT_LT((t.F_w - half.F_w).norm(),
              0.02 * half.F_w.norm());  // L/D = 0.05, parabola along the axis, 72 nodes
    EXPECT_EQ(f.F.norm(), 0.0);
    for (const FiniteJournal& film : {FiniteJournal{R, L, eta, plain}, sealed}) {
      film.evaluate(rest, f, t);
      Mat2 mean = Mat2::Zero();
      constexpr int n = 500;
      for (int k = 0; k < n; ++k) {
        const Vec2 w(std::cos(two_pi * k / n), std::sin(two_pi * k / n));
        film.evaluate({r, w, 0.0}, f);
        mean += 2.0 / n * f.F * w.transpose();
      }
      EXPECT_LT((t.F_w - mean).norm(), 1e-4 * mean.norm());  // 72 directions against many
      EXPECT_LT(t.F_w(0, 0), 0.0);
      EXPECT_LT(t.F_w.determinant() * -1.0, 0.0);  // damps motion in every direction
    }
  }
}
