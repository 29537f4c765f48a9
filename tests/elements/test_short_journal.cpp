// Short journal bearing: film integrals, published and exact loci, coefficients and whirl onsets.
#include "conformance.hpp"
#include "journal_statics.hpp"
#include <core/error.hpp>
#include <elements/films/short_journal.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

// Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines, 2010, example 5.5.1.
const ShortJournal friswell{0.05, 0.03, 1e-4, 0.1};
constexpr double load = 525.0, rpm = two_pi / 60;

JournalEquilibrium equilibrium(double speed) {
  return find_journal_equilibrium(film_function(FilmLaw<ShortJournal>{friswell}), Vec2(0, -load),
                                  speed, friswell.clearance);
}

void expect_matrix(const Mat2& m, double a, double b, double c, double d, double tol) {
  EXPECT_NEAR(m(0, 0), a, tol * std::abs(a));
  EXPECT_NEAR(m(0, 1), b, tol * std::abs(b));
  EXPECT_NEAR(m(1, 0), c, tol * std::abs(c));
  EXPECT_NEAR(m(1, 1), d, tol * std::abs(d));
}

ConformanceOptions in_the_clearance(double c, double speed) {
  ConformanceOptions o;
  o.u = 0.2 * c;  // two nodes: relative displacement within 0.4 sqrt(2) c
  o.du = 0.3 * c * speed;
  o.ddu = c * speed * speed;
  o.tilt = 0.3;
  o.dtilt = 0.2 * speed;
  o.ddtilt = 0.2 * speed * speed;
  o.dphi = 0.3 * speed;
  o.ddphi = speed * speed;
  o.v0.assign(12, 0.0);
  o.v0[3] = speed;
  return o;
}

}  // namespace

TEST(ShortJournal, Conformance) {
  ConformanceOptions o = in_the_clearance(1e-4, 200);
  check_kernel(ShortJournalBearing{{friswell}}, o);
  o.chart = tilted_chart();
  o.v0[9] = -120;  // counter-rotating housing
  LateralJoint<FilmLaw<ShortJournal>, true> stub{{friswell}, {2e-5, -1e-5}};
  check_kernel(stub, o);
}

TEST(ShortJournal, IntegralsAgainstQuadrature) {
  // Simpson with 20000 intervals: good to
  // 1e-12 up to an eccentricity of 0.95.
  Random r(5);
  for (int n = 0; n < 20; ++n) {
    const Vec2 e = 0.95 * std::sqrt(0.5) * r.vector<2>();
    const HalfFilmIntegral g(e.x(), e.y());
    const int N = 20000;
    double s[10] = {};
    for (int i = 0; i <= N; ++i) {
      const double psi = -pi / 2 + pi * i / N, c = std::cos(psi), q = std::sin(psi),
                   h = 1 - e.x() * c - e.y() * q;
      const double w = (i == 0 || i == N ? 1 : i % 2 ? 4 : 2) * pi / N / 3;
      const double v[10] = {1 / h,
                            c / (h * h),
                            q / (h * h),
                            2 * c * c / (h * h * h),
                            2 * c * q / (h * h * h),
                            2 * q * q / (h * h * h),
                            6 * c * c * c / (h * h * h * h),
                            6 * c * c * q / (h * h * h * h),
                            6 * c * q * q / (h * h * h * h),
                            6 * q * q * q / (h * h * h * h)};
      for (int k = 0; k < 10; ++k)
        s[k] += w * v[k];
    }
    const double exact[10] = {g.G, g.a, g.b, g.aa, g.ab, g.bb, g.aaa, g.aab, g.abb, g.bbb};
    const double third = std::abs(g.aaa) + std::abs(g.bbb),
                 second = std::abs(g.aa) + std::abs(g.bb);
    for (int k = 0; k < 10; ++k)
      EXPECT_NEAR(exact[k], s[k],
                  1e-10 * (k < 3   ? std::abs(g.G) + std::abs(g.a)
                           : k < 6 ? second
                                   : third))
          << k;
  }
}

TEST(ShortJournal, ForcesOfCapone) {
  // (x, y, x', y')/(c, c, c Omega, c Omega) -> force/(eta Omega R L^3/c^2), by circumferential
  // integration of the positive pressure
  const double table[5][6] = {{0.3, 0.2, 0.0, 0.0, -0.3364786177990092, 0.19508543509264628},
                              {-0.5, 0.4, -0.2, 0.1, 2.7234859306827595, -4.0791054652237095},
                              {0.1, 0.6, 0.05, -0.3, -0.6241169043245323, 0.07721853318683176},
                              {0.0, -0.7, 0.02, 0.03, 1.263266503877111, 1.3237695525132753},
                              {0.25, -0.09, 0.3, -0.2, -0.971453905068221, 0.8758997670304765}};
  const double Omega = 300, c = friswell.clearance;
  const double unit =
      friswell.viscosity * Omega * friswell.radius * std::pow(friswell.length, 3) / (c * c);
  const FilmLaw<ShortJournal> law{friswell};
  for (const auto& t : table) {
    LateralMotion m;
    m.r = c * Vec2(t[0], t[1]);
    m.v = c * Omega * Vec2(t[2], t[3]);
    m.spin = Omega;
    Vector<4> z;
    law.force(m, z);
    EXPECT_NEAR(z[0] / unit, t[4], 1e-6 * std::hypot(t[4], t[5]));
    EXPECT_NEAR(z[1] / unit, t[5], 1e-6 * std::hypot(t[4], t[5]));
    // reversed spin and mirrored motion: mirrored force
    m.r.x() *= -1;
    m.v.x() *= -1;
    m.spin *= -1;
    Vector<4> mirror;
    law.force(m, mirror);
    EXPECT_NEAR(mirror[0], -z[0], 1e-12 * unit);
    EXPECT_NEAR(mirror[1], z[1], 1e-12 * unit);
  }
}

TEST(ShortJournal, LocusAndStability) {
  // eccentricity, modified Sommerfeld number eta Omega D L^3/(8 c^2 W), attitude deg, k_eq c/W,
  // whirl ratio, M c Omega^2/W: the closed forms of Ocvirk's film (Friswell et al. 2010, 5.5) and
  // Lund's threshold
  const double table[][6] = {{0.01, 31.823634409387825, 89.27049042286399, 1.9097681770576924,
                              0.5000303861744495, 7.6381443040798},
                             {0.1, 3.1101110916168, 82.70775479547765, 1.9007978951820976,
                              0.5029383929348534, 7.514608560794097},
                             {0.2, 1.4488832317897364, 75.43120794246524, 1.8742362066996863,
                              0.5105623209306428, 7.189965412514443},
                             {0.3, 0.8550662152486902, 68.17807995860817, 1.831936441893643,
                              0.5194173871201135, 6.790119780918972},
                             {0.4, 0.5355183434902039, 60.93962834971417, 1.7765158787152981,
                              0.5238057849796655, 6.474832121538248},
                             {0.5, 0.3331640496536172, 53.68020059989582, 1.7110647488383302,
                              0.5146401448073004, 6.460395752329514},
                             {0.6, 0.19644334152628942, 46.320703770147354, 1.6387619857198399,
                              0.4739550818840409, 7.295272399729982},
                             {0.7, 0.10356047246628367, 38.70402431141864, 1.562563884049113,
                              0.3445663369221549, 13.161097008124868},
                             {0.75, 0.06993202914478601, 34.70864481340598, 1.5238150860339235,
                              0.12668434309485466, 94.94812246355588}};
  const double Omega = 100, c = friswell.clearance;
  for (const auto& t : table) {
    const double W = friswell.viscosity * Omega * 2 * friswell.radius *
                     std::pow(friswell.length, 3) / (8 * c * c * t[1]);
    const auto e = find_journal_equilibrium(film_function(FilmLaw<ShortJournal>{friswell}),
                                            Vec2(0, -W), Omega, c);
    const auto w = whirl_threshold(e.K, e.C);
    EXPECT_NEAR(e.eccentricity, t[0], 1e-12);
    EXPECT_NEAR(e.attitude * 180 / pi, t[2], 1e-10);
    EXPECT_NEAR(w.k_eq * c / W, t[3], 1e-11);
    EXPECT_NEAR(std::sqrt(w.omega2) / Omega, t[4], 1e-10);
    EXPECT_NEAR(w.critical_mass() * c * Omega * Omega / W, t[5], 1e-9 * t[5] / t[4]);
  }
  // the least stable load, and the eccentricity above which every mass is stable
  const auto p2 = [&](double ecc) {
    const double W = friswell.viscosity * Omega * friswell.radius * std::pow(friswell.length, 3) *
                     ecc * std::sqrt(pi * pi * (1 - ecc * ecc) + 16 * ecc * ecc) /
                     (4 * c * c * std::pow(1 - ecc * ecc, 2));
    const auto e = find_journal_equilibrium(film_function(FilmLaw<ShortJournal>{friswell}),
                                            Vec2(0, -W), Omega, c);
    EXPECT_NEAR(e.eccentricity, ecc, 1e-12);
    const auto w = whirl_threshold(e.K, e.C);
    return std::pair(w.critical_mass() * c * Omega * Omega / W, w.omega2);
  };
  EXPECT_NEAR(p2(0.45697).first, 6.4095338, 1e-6 * 6.4);
  EXPECT_LT(p2(0.45697).first, std::min(p2(0.455).first, p2(0.459).first));
  EXPECT_GT(p2(0.7560303865 - 1e-8).second, 0.0);
  EXPECT_LT(p2(0.7560303865 + 1e-8).second, 0.0);
  EXPECT_EQ(p2(0.8).first, infinity);
}

TEST(ShortJournal, PublishedCoefficients) {
  // Friswell et al. 2010, example 5.5.1 (book: 12.81, 16.39, -25.06, 8.815 MN/m)
  const auto e = equilibrium(1500 * rpm);
  EXPECT_NEAR(e.eccentricity, 0.266297509, 1e-8);
  EXPECT_NEAR(e.attitude * 180 / pi, 70.62004779, 1e-7);
  expect_matrix(e.K, 12807959, 16393593, -25060393, 8815302, 1e-7);
  expect_matrix(e.C, 232896.93, -81924.37, -81924.37, 294911.62, 1e-7);
  struct Row {
    double n, ecc, x, y, K[4], C[4];
  };
  const Row rows[] = {
      {250,
       0.62633218280768,
       4.3782444063026525e-05,
       -4.478858810092461e-05,
       {10813626.857879883, 928977.8507287599, -22136852.155470453, 22645568.886359103},
       {413413.6042970258, -422914.0705695489, -422914.0705695489, 1348686.0094648788}},
      {1000,
       0.35059816928103843,
       3.16484725481199e-05,
       -1.508525599395175e-05,
       {12429102.82770553, 10664141.896761525, -22053842.74029967, 10511972.193348028},
       {251020.20169955483, -119648.87077989923, -119648.87077989923, 373847.2762596028}},
      {3000,
       0.14959887320304727,
       1.4689791420046596e-05,
       -2.829886335480569e-06,
       {13186034.912592791, 33198907.052972786, -38088177.764655024, 7337423.025112646},
       {218207.49318265024, -42036.15869006618, -42036.15869006618, 235620.1839108166}},
      {9000,
       0.052206744180900926,
       5.209147447857898e-06,
       -3.467336819172328e-07,
       {13346425.282692226, 99895875.4825199, -101606178.05333602, 6763157.421558212},
       {212787.05867457174, -14163.63062422288, -14163.63062422288, 214813.57950408422}}};
  for (const Row& t : rows) {
    const auto q = equilibrium(t.n * rpm);
    EXPECT_NEAR(q.eccentricity, t.ecc, 1e-11);
    EXPECT_NEAR(q.r.x(), t.x, 1e-11 * 1e-4);
    EXPECT_NEAR(q.r.y(), t.y, 1e-11 * 1e-4);
    expect_matrix(q.K, t.K[0], t.K[1], t.K[2], t.K[3], 1e-9);
    expect_matrix(q.C, t.C[0], t.C[1], t.C[2], t.C[3], 1e-9);
  }
  // the other sense of rotation is the mirror image
  const auto forward = equilibrium(1500 * rpm), back = equilibrium(-1500 * rpm);
  EXPECT_NEAR(back.r.x(), -forward.r.x(), 1e-16);
  EXPECT_NEAR(back.r.y(), forward.r.y(), 1e-16);
  EXPECT_NEAR(back.K(0, 1), -forward.K(0, 1), 1e-6);
  EXPECT_NEAR(back.attitude, forward.attitude, 1e-12);
}

TEST(ShortJournal, OilWhirlOnset) {
  const auto film = film_function(FilmLaw<ShortJournal>{friswell});
  const double M = load / 9.81;
  const auto rigid = find_whirl_onset(film, Vec2(0, -load), M, 1e-4, 100, 2000);
  EXPECT_NEAR(rigid.speed / rpm, 8244.3368, 1e-7 * 8244);
  EXPECT_NEAR(rigid.whirl, 432.5136, 1e-6 * 432);
  EXPECT_NEAR(rigid.at.eccentricity, 0.056924, 1e-6);
  const double table[3][4] = {{100, 1811.3617, 97.37152, 0.230315},
                              {200, 3430.5272, 181.42303, 0.132328},
                              {300, 4678.6899, 246.38206, 0.098798}};
  for (const auto& t : table) {
    const auto o = find_whirl_onset(film, Vec2(0, -load), M, 1e-4, 50, 2000, M * t[0] * t[0]);
    EXPECT_NEAR(o.speed / rpm, t[1], 1e-7 * t[1]);
    EXPECT_NEAR(o.whirl, t[2], 1e-6 * t[2]);
    EXPECT_NEAR(o.at.eccentricity, t[3], 1e-6);
  }
}

TEST(ShortJournal, ExtremeEccentricity) {
  // e = 0.9999: the closed locus still holds; the film never pushes out of its own circle
  const double ecc = 0.9999, Omega = 100, c = 1e-4;
  const double W = 0.1 * Omega * 0.05 * 2.7e-5 * ecc *
                   std::sqrt(pi * pi * (1 - ecc * ecc) + 16 * ecc * ecc) /
                   (4 * c * c * std::pow(1 - ecc * ecc, 2));
  const auto e = find_journal_equilibrium(film_function(FilmLaw<ShortJournal>{friswell}),
                                          Vec2(0, -W), Omega, c, {0.99999, "b"});
  EXPECT_NEAR(e.eccentricity, ecc, 1e-11);
  Random r(9);
  for (int n = 0; n < 200; ++n) {
    FilmPoint p;
    p.r = r.vector<2>().normalized() * c * 0.99999;
    p.w = r.vector<2>();
    p.slip = 0;
    FilmForce f;
    friswell.evaluate(p, f);
    EXPECT_LE(f.F.dot(p.w), 0.0);
  }
  FilmForce f;
  friswell.evaluate({Vec2(c, 0), Vec2(1, 0), 0}, f);
  EXPECT_TRUE(std::isnan(f.F.x()));
}

TEST(ShortJournal, NoEquilibriumSaysWhy) {
  try {
    find_journal_equilibrium(film_function(FilmLaw<ShortJournal>{friswell}), Vec2(0, -load), 0.0,
                             1e-4, {0.999, "bearing 'DE'"});
    FAIL() << "found an equilibrium at rest";
  } catch (const Error& e) {
    const auto& d = e.diagnostics().front();
    EXPECT_EQ(d.code, "E87");
    EXPECT_EQ(d.where.entity, "bearing 'DE'");
    EXPECT_NE(d.message.find("load 525 N"), std::string::npos);
    EXPECT_NE(d.message.find("carries at most 0 N"), std::string::npos) << d.message;
  }
  try {
    find_journal_equilibrium(film_function(FilmLaw<ShortJournal>{friswell}), Vec2(0, -1e12), 100.0,
                             1e-4, {});
    FAIL() << "no film carries 1e12 N";
  } catch (const Error& e) {
    EXPECT_NE(e.diagnostics().front().message.find("reached eccentricity 0.9"), std::string::npos)
        << e.what();
  }
}
