// Published and closed-form bearing cases from the deck: what a user writes, and the equilibrium,
// coefficients, stability and motion that come out.
#include <analysis/spectra/whirl_modes.hpp>
#include <system/problem.hpp>

#include "deck_model.hpp"
#include "record.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>

using namespace whirl;
using test::DeckModel;
using test::lateral_mass;
using test::Windows;

namespace {

/// K or C of (y, z) at a node, rows the forces.
Mat2 lateral(const la::BlockMatrix<6>& m, Index node) {
  return m.block(m.pattern().slot(node, node)).block<2, 2>(1, 1);
}

std::string load(const Vec2& F) {
  return fmt::format("[[load]]\nat = \"mass\"\nforce = [\"0 N\", \"{:.17g} N\", \"{:.17g} N\"]\n",
                     F.x(), F.y());
}

std::string at_speed(double Omega) {
  return fmt::format(
      "[[drive]]\nname = \"motor\"\nat = \"mass\"\ntype = \"speed\"\nspeed = \"{:.17g} rad/s\"\n",
      Omega);
}

}  // namespace

// Short bearing (Ocvirk, pi film), closed forms: eccentricity, modified Sommerfeld number Ss = D
// Omega eta L^3/(8 c^2 W), attitude, equivalent stiffness over W/c, whirl ratio and p^2 = M c
// Omega^2/W at the threshold of stability, per bearing. Load for the eccentricity, mass for the
// threshold: the equilibrium must come back, one pair of eigenvalues must stand on the imaginary
// axis. Numbers to 10 digits, asserted to 1e-7 (locus) and 1e-6 (threshold: p^2 from differences of
// coefficients).
TEST(ShortJournalDeck, LocusAndStabilityTable) {
  struct Row {
    double eps, Ss, attitude, k, whirl, p2;
  };
  const Row table[] = {{0.01, 31.82363441, 89.27049042, 1.909768177, 0.5000303862, 7.638144304},
                       {0.05, 6.329494061, 86.35280355, 1.907584017, 0.5007535547, 7.607388454},
                       {0.1, 3.110111092, 82.7077548, 1.900797895, 0.5029383929, 7.514608561},
                       {0.15, 2.013625223, 79.06675455, 1.889618534, 0.506329967, 7.370668461},
                       {0.2, 1.448883232, 75.43120794, 1.874236207, 0.5105623209, 7.189965413},
                       {0.25, 1.097949266, 71.80177015, 1.854905804, 0.5151356046, 6.990024922},
                       {0.3, 0.8550662152, 68.17807996, 1.831936442, 0.5194173871, 6.790119781},
                       {0.35, 0.6750751667, 64.5584693, 1.805679493, 0.5226291671, 6.61079027},
                       {0.4, 0.5355183435, 60.93962835, 1.776515879, 0.523805785, 6.474832122},
                       {0.45, 0.4240061053, 57.31619308, 1.744843392, 0.5217070389, 6.410664672},
                       {0.5, 0.3331640497, 53.6802006, 1.711064749, 0.5146401448, 6.460395752},
                       {0.55, 0.2583371837, 50.02032068, 1.675576902, 0.500097611, 6.699691501},
                       {0.6, 0.1964433415, 46.32070377, 1.638761986, 0.4739550818, 7.2952724},
                       {0.65, 0.1453573136, 42.55915094, 1.600980086, 0.4283892984, 8.723860324},
                       {0.7, 0.1035604725, 38.70402431, 1.562563884, 0.3445663369, 13.16109701},
                       {0.75, 0.06993202914, 34.70864481, 1.523815086, 0.1266843431, 94.94812246},
                       {0.8, 0.04361990746, 30.50015339, 1.485002461, whirl::nan, infinity}};
  const double D = 0.1, L = 0.03, c = 1e-4, eta = 0.02, Omega = 500;
  test::Record record("Short journal bearing: locus and stability",
                      "F. W. Ocvirk, NACA TN 2808 (1952), pi film, in closed form; eigenvalues of "
                      "a mass on its linearisation");
  const auto film = [&](double M, double W) {
    return lateral_mass(M, "0 m/s^2",
                        "[[bearing]]\nname = \"film\"\nat = \"mass\"\ntype = "
                        "\"short_journal\"\ndiameter = \"100 mm\"\nlength = \"30 mm\"\n"
                        "clearance = \"100 um\"\nviscosity = \"20 mPa.s\"\n" +
                            load(Vec2(0, -W)));
  };
  const auto load_at = [&](double eps) {
    const double e2 = eps * eps;
    return eta * Omega * D * L * L * L * eps * std::sqrt(pi * pi * (1 - e2) + 16 * e2) /
           (8 * c * c * (1 - e2) * (1 - e2));
  };
  // Threshold of a mass on K, C (Routh): equivalent stiffness and the square of the whirl frequency
  const auto threshold = [](const Mat2& K, const Mat2& C) {
    const double k =
        (K(0, 0) * C(1, 1) + K(1, 1) * C(0, 0) - K(0, 1) * C(1, 0) - K(1, 0) * C(0, 1)) / C.trace();
    return Vec2(k, ((k - K(0, 0)) * (k - K(1, 1)) - K(0, 1) * K(1, 0)) / C.determinant());
  };
  for (const Row& t : table) {
    const double W = load_at(t.eps), M = std::isfinite(t.p2) ? t.p2 * W / (c * Omega * Omega)
                                                             : 1e4 * W / (c * Omega * Omega);
    const DeckModel m(film(M, W));
    analysis::Linearizer linear(m.built.system, m.running());
    const la::MCK& mck = linear.at(Omega);
    const Vec2 r = linear.equilibrium().state.q.segment<2>(6 * m.disk() + 1);
    const Vec2 limit = threshold(lateral(mck.K, m.disk()), lateral(mck.C, m.disk()));
    const std::string at = fmt::format("eccentricity {:g}: ", t.eps);
    EXPECT_NEAR(D * Omega * eta * L * L * L / (8 * c * c * W), t.Ss,
                1e-9 * t.Ss);  // the load is that of the table
    record.check(at + "eccentricity", "-", r.norm() / c, t.eps, 1e-7 * t.eps);
    record.check(at + "attitude", "deg", std::atan2(r.x(), -r.y()) * 180 / pi, t.attitude,
                 1e-7 * t.attitude);  // from the load (-z) in the sense of rotation (y -> z: to +y)
    record.check(at + "equivalent stiffness", "W/c", limit[0] * c / W, t.k, 1e-6 * t.k);
    analysis::ModesOptions o;
    o.count = 4;
    o.motion = analysis::Motion::lateral;
    const auto modes = analysis::whirl_modes(linear, Omega, o);
    if (!std::isfinite(t.p2)) {
      EXPECT_LT(limit[1], 0.0);  // no threshold: stable whatever the mass
      for (const auto& mode : modes)
        EXPECT_FALSE(mode.lambda.real() > 0);
      continue;
    }
    const double given = m.deck.model.disks[0].mass;  // as rounded in the deck
    double nearest = infinity, frequency = 0;
    for (const auto& mode : modes)
      if (mode.frequency > 0 && std::abs(mode.lambda.real()) < nearest) {
        nearest = std::abs(mode.lambda.real());
        frequency = mode.frequency;
      }
    EXPECT_LT(nearest, 1e-6 * Omega + std::abs(given / M - 1) * Omega) << t.eps;
    record.check(at + "whirl at the onset over speed", "-", frequency / Omega, t.whirl, 1e-6);
  }
  // The least stable eccentricity is 0.45697: p^2 = 6.4095338, p = 2.53170571.
  double p2[3];
  const double around[] = {0.447, 0.45697, 0.467};
  for (int i = 0; i < 3; ++i) {
    const double W = load_at(around[i]);
    const DeckModel m(film(50, W));
    analysis::Linearizer linear(m.built.system, m.running());
    const la::MCK& mck = linear.at(Omega);
    const Vec2 limit = threshold(lateral(mck.K, m.disk()), lateral(mck.C, m.disk()));
    p2[i] = limit[0] * c / W / (limit[1] / (Omega * Omega));
  }
  record.check("least p^2, at eccentricity 0.45697", "-", p2[1], 6.4095338, 1e-6 * 6.4);
  record.check("its root p", "-", std::sqrt(p2[1]), 2.53170571, 1e-6 * 2.5);
  EXPECT_GT(p2[0], p2[1]);
  EXPECT_GT(p2[2], p2[1]);
}

// Above an eccentricity of 0.7560303865 no mass is unstable.
TEST(ShortJournalDeck, StableAtAnySpeedBeyondAnEccentricity) {
  const double D = 0.1, L = 0.03, c = 1e-4, eta = 0.02, Omega = 500;
  for (const auto& [eps, stable] : {std::pair{0.757, true}, std::pair{0.755, false}}) {
    const double e2 = eps * eps, W = eta * Omega * D * L * L * L * eps *
                                     std::sqrt(pi * pi * (1 - e2) + 16 * e2) /
                                     (8 * c * c * (1 - e2) * (1 - e2));
    const DeckModel m(lateral_mass(
        1e4 * W / (c * Omega * Omega), "0 m/s^2",
        "[[bearing]]\nname = \"film\"\nat = \"mass\"\ntype = \"short_journal\"\ndiameter = \"100 "
        "mm\"\nlength = \"30 mm\"\nclearance = \"100 um\"\n"
        "viscosity = \"20 mPa.s\"\n" +
            load(Vec2(0, -W))));
    analysis::Linearizer linear(m.built.system, m.running());
    analysis::ModesOptions o;
    o.count = 4;
    o.motion = analysis::Motion::lateral;
    bool all = true;
    for (const auto& mode : analysis::whirl_modes(linear, Omega, o))
      all = all && !(mode.lambda.real() > 0);
    EXPECT_EQ(all, stable) << eps;
  }
}

// Lund & Thomsen (ASME 1978): two pads of 160 deg, grooves of 20 deg at the horizontal split, load
// between them. L/D, S = eta N L D (R/c)^2/W, eccentricity, attitude, K c/W and B c Omega/W with x
// along the load. Table of three digits: 6 % or 0.06; the locus 0.5 %.
TEST(FiniteJournalDeck, LundThomsenTwoAxialGrooves) {
  const double table[][11] = {{0.5, 1.656, 0.244, 65.85, 1.69, 5.06, -2.2, 1.95, 9.93, 2.15, 4.8},
                              {0.5, 0.917, 0.372, 57.45, 2.12, 4.01, -1.3, 1.85, 7.7, 2.06, 3.23},
                              {0.5, 0.58, 0.477, 51.01, 2.67, 3.7, -0.78, 1.75, 6.96, 1.94, 2.4},
                              {0.5, 0.379, 0.57, 45.43, 3.33, 3.64, -0.43, 1.68, 6.76, 1.87, 1.89},
                              {0.5, 0.244, 0.655, 40.25, 4.21, 3.74, -0.13, 1.64, 6.87, 1.82, 1.54},
                              {1, 0.991, 0.15, 70.58, 1.56, 7.29, -2.16, 1.52, 14.66, 1.58, 4.49},
                              {1, 0.635, 0.224, 63.54, 1.62, 5.33, -1.57, 1.56, 10.8, 1.7, 3.41},
                              {1, 0.235, 0.46, 49.27, 2.19, 3.57, -0.8, 1.55, 7.36, 1.89, 2.19},
                              {1, 0.159, 0.559, 44.33, 2.73, 3.36, -0.48, 1.48, 6.94, 1.78, 1.74},
                              {1, 0.108, 0.65, 39.72, 3.45, 3.34, -0.23, 1.44, 6.89, 1.72, 1.43}};
  const double D = 0.1, c = 1e-4, eta = 0.02, Omega = 300;
  test::Record record("Journal bearing with two axial grooves",
                      "J. W. Lund, K. K. Thomsen, in Topics in Fluid Film Bearing and Rotor "
                      "Bearing System Design, ASME (1978) 1");
  for (const auto& t : table) {
    const double L = t[0] * D,
                 W = eta * Omega / two_pi * L * D * (0.5 * D / c) * (0.5 * D / c) / t[1];
    const DeckModel m(lateral_mass(
        100, "0 m/s^2",
        fmt::format("[[bearing]]\nname = \"film\"\nat = \"mass\"\ntype = \"journal\"\nshape = "
                    "\"two_grooves\"\ngroove = \"20 deg\"\ndiameter = \"100 mm\"\n"
                    "length = \"{:.17g} mm\"\nclearance = \"100 um\"\nviscosity = \"20 mPa.s\"\n",
                    1e3 * L) +
            load(Vec2(0, -W))));
    analysis::Linearizer linear(m.built.system, m.running());
    const la::MCK& mck = linear.at(Omega);
    const Vec2 r = linear.equilibrium().state.q.segment<2>(6 * m.disk() + 1);
    const Mat2 K = lateral(mck.K, m.disk()) * c / W, B = lateral(mck.C, m.disk()) * c * Omega / W;
    // load along -z, spin y -> z: their x is -z, their y is +y
    const double got[] = {r.norm() / c, std::atan2(r.x(), -r.y()) * 180 / pi,
                          K(1, 1),      -K(1, 0),
                          -K(0, 1),     K(0, 0),
                          B(1, 1),      -B(1, 0),
                          B(0, 0)};
    for (int i = 0; i < 9; ++i)
      EXPECT_NEAR(got[i], t[i + 2], std::max(0.06, 0.06 * std::abs(t[i + 2])))
          << "S " << t[1] << " column " << i;
    const std::string at = fmt::format("L/D {:g}, S {:g}: ", t[0], t[1]);
    record.check(at + "eccentricity", "-", got[0], t[2], 0.005 * t[2]);
    record.check(at + "attitude", "deg", got[1], t[3], 0.005 * t[3]);
    for (const auto& [name, i] : {std::pair{"Kxx", 2}, {"Kyy", 5}, {"Bxx", 6}, {"Byy", 8}})
      record.check(at + name, "W/c", got[i], t[i + 2], std::max(0.06, 0.06 * std::abs(t[i + 2])));
  }
}

namespace {

/// Jeffcott rotor in an elastic stator ring: m 10 kg, k 1e6 N/m, c 400 N s/m, e 0.1 mm, gap 0.3 mm,
/// stator 4e6 N/m.
constexpr double rub_m = 10, rub_k = 1e6, rub_c = 400, rub_e = 1e-4, rub_kc = 4e6, rub_gap = 3e-4;

std::string rub_rotor(double friction, double Omega) {
  return lateral_mass(rub_m, "0 m/s^2",
                      fmt::format(R"([[unbalance]]
at = "mass"
amount = "1 kg.mm"
[[bearing]]
name = "shaft"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "400 N.s/m"
czz = "400 N.s/m"
[[bearing]]
name = "stator"
at = "mass"
type = "rub"
gap = "0.3 mm"
stiffness = "4e6 N/m"
friction = {}
diameter = "300 mm"
)",
                                  friction)) +
         at_speed(Omega);
}

/// Radius of full annular rub, the largest root R of |k - m O^2 + i O c + kc (1 + i mu)(1 - gap/R)|
/// R = m e O^2.
double branch(double friction, double ratio) {
  const double O = ratio * std::sqrt(rub_k / rub_m);
  const auto excess = [&](double R) {
    return std::abs(Complex(rub_k - rub_m * O * O, O * rub_c) +
                    rub_kc * (1 - rub_gap / R) * Complex(1, friction)) *
               R -
           rub_m * rub_e * O * O;
  };
  double R = 3e-3;
  while (R > rub_gap && excess(R) > 0)
    R -= 1e-7;
  double low = R, high = R + 1e-7;
  for (int i = 0; i < 60; ++i)
    (excess(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
  return R > rub_gap ? low : whirl::nan;
}

/// Radius after `turns`, started at rest in the middle or on the circle of radius R (phase of the
/// steady motion).
double rub_radius(double friction, double ratio, double R, double turns, double& least_power) {
  const double Omega = ratio * std::sqrt(rub_k / rub_m), end = turns * two_pi / Omega;
  const DeckModel m(rub_rotor(friction, Omega));
  system::SystemProblem problem(m.built.system);
  system::State s = m.built.system.make_state();
  const Index n = 6 * m.disk();
  if (R > 0) {
    const Complex D = Complex(rub_k - rub_m * Omega * Omega, Omega * rub_c) +
                      rub_kc * std::max(0.0, 1 - rub_gap / R) * Complex(1, friction);
    const Complex r = R * std::exp(Complex(0, -std::arg(D)));
    s.q[n + 1] = r.real();
    s.q[n + 2] = r.imag();
    s.v[n + 1] = -Omega * r.imag();
    s.v[n + 2] = Omega * r.real();
  }
  problem.impose(0.0, s.q, s.v, s.a);
  analysis::TransientOptions o;
  o.integrator.tolerance = 1e-7;
  o.integrator.t_end = end;
  Windows w(m.disk(), Vec2::Zero(), {{end * (1 - 1 / turns), end}});
  const auto r = analysis::run_transient(problem, s, o, {&w});
  EXPECT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
  least_power = std::min(least_power, w.dissipated_least);
  return w.peak[0];
}

}  // namespace

// Full annular rub of a Jeffcott rotor (Black, J. Mech. Eng. Sci. 10, 1968, closed form): radii on
// the branches, by transients from rest and from the branch. zeta = 0.063: after 40 turns e^-16.
// Tolerance: eight samples a step see the circle to 1e-6.
TEST(AnnularRubDeck, RadiiOnTheBranches) {
  double power = infinity;
  test::Record record("Full annular rub of a Jeffcott rotor",
                      "steady motion in closed form; mu friction, W speed over natural frequency");
  const double speeds[] = {0.9, 1.0, 1.1, 1.3};
  const std::pair<double, std::array<double, 4>> radii[] = {
      {0.0, {0.000303876166, 0.000322820753, 0.000345914385, 0.000409369978}},
      {0.05, {0.000303790679, 0.000322297013, 0.000344793882, 0.00040612574}}};
  for (const auto& [mu, R] : radii)
    for (std::size_t i = 0; i < 4; ++i)  // at 1.3 there is a free motion too: started in contact
      record.check(fmt::format("mu {:g}, W {:.1f}: radius", mu, speeds[i]), "m",
                   rub_radius(mu, speeds[i], i == 3 ? R[i] : 0, 60, power), R[i], 2e-6 * R[i]);
  // two motions at 1.5: free from rest, in contact when it was in contact
  record.check("mu 0.05, W 1.5, from rest: radius", "m", rub_radius(0.05, 1.5, 0, 80, power),
               0.000177961557, 2e-6 * 2e-4);
  EXPECT_NEAR(branch(0.05, 1.5), 0.000501675563, 1e-8 * 5e-4);
  record.check("mu 0.05, W 1.5, in contact: radius", "m", rub_radius(0.05, 1.5, 0.0005, 100, power),
               0.000501675563, 2e-6 * 5e-4);
  record.check("mu 0.01, W 1.5, in contact: radius", "m", rub_radius(0.01, 1.5, 0.0005, 100, power),
               0.000508749664, 2e-6 * 5e-4);
  record.check("mu 0, W 1.5, in contact: radius", "m", rub_radius(0.0, 1.5, 0.0005, 100, power),
               0.000510221455, 2e-6 * 5e-4);
  // friction and dampers take power at every instant
  EXPECT_GE(power, 0.0);
}

// The free motion reaches the stator at 0.87688784 of the natural frequency and leaves it again at
// 1.20957336: a thousandth on one side of these speeds it is the free motion, on the other the
// circle in contact. Started from rest below, on the circle of the free motion above, where the
// circle in contact exists beside it; 80 turns leave e^-27 of what the start is off.
TEST(AnnularRubDeck, OnsetAndReentry) {
  double power = infinity;
  for (const auto& [ratio, opens] : {std::pair{0.87688784, false}, std::pair{1.20957336, true}}) {
    const auto free_radius = [&](double x) {
      const double O = x * std::sqrt(rub_k / rub_m);
      return rub_m * rub_e * O * O / std::abs(Complex(rub_k - rub_m * O * O, O * rub_c));
    };
    EXPECT_NEAR(free_radius(ratio), rub_gap, 1e-7 * rub_gap);
    const double open = (opens ? 1.001 : 0.999) * ratio, closed = (opens ? 0.999 : 1.001) * ratio;
    EXPECT_NEAR(rub_radius(0.05, open, opens ? free_radius(open) : 0, 80, power), free_radius(open),
                2e-6 * rub_gap)
        << ratio;
    EXPECT_LT(free_radius(open), rub_gap);
    EXPECT_NEAR(rub_radius(0.05, closed, opens ? free_radius(closed) : 0, 80, power),
                branch(0.05, closed), 2e-6 * rub_gap)
        << ratio;
  }
  EXPECT_GE(power, 0.0);
}

// The branch of contact ends at 1.967031 (mu = 0.05), 2.055764 (0.01) and 2.078104 (0): started on
// its end, the motion stays in contact a little below that speed and falls back into the clearance
// a little above.
TEST(AnnularRubDeck, JumpAtTheEndOfTheBranch) {
  double power = infinity;
  for (const auto& [mu, fold] :
       {std::pair{0.05, 1.967031}, std::pair{0.01, 2.055764}, std::pair{0.0, 2.078104}}) {
    EXPECT_TRUE(std::isnan(branch(mu, 1.0001 * fold)));
    EXPECT_FALSE(std::isnan(branch(mu, 0.9999 * fold)));
    const double R = branch(mu, 0.99 * fold);
    EXPECT_NEAR(rub_radius(mu, 0.99 * fold, R, 100, power), R, 1e-4 * R) << mu;
    EXPECT_LT(rub_radius(mu, 1.01 * fold, R, 150, power), rub_gap) << mu;
  }
  EXPECT_GE(power, 0.0);
}

// Between the branch of contact and the free motion lies a third circle, unstable (mu = 0): a
// motion on it stays for a turn, one started a hundredth outside goes to the branch, one a
// hundredth inside to the free motion.
TEST(AnnularRubDeck, MiddleBranchDividesTheMotions) {
  double power = infinity;
  const auto free_radius = [](double ratio) {
    const double O = ratio * std::sqrt(rub_k / rub_m);
    return rub_m * rub_e * O * O / std::abs(Complex(rub_k - rub_m * O * O, O * rub_c));
  };
  for (const auto& [ratio, middle, outer] : {std::tuple{1.3, 0.000313920447, 0.000409369978},
                                             std::tuple{1.5, 0.00035837103, 0.000510221455}}) {
    EXPECT_NEAR(rub_radius(0.0, ratio, middle, 1, power), middle, 1e-5 * middle) << ratio;
    EXPECT_NEAR(rub_radius(0.0, ratio, 1.01 * middle, 120, power), outer, 2e-6 * outer) << ratio;
    EXPECT_NEAR(rub_radius(0.0, ratio, 0.99 * middle, 120, power), free_radius(ratio),
                2e-6 * free_radius(ratio))
        << ratio;
  }
}

// Ball bearing of eight balls, K 1.334e10 N/m^1.5: displacement and stiffness under a load, a ball
// under it or between two. Roots of the eight-ball sum.
TEST(BallBearingDeck, LoadSharing) {
  struct Row {
    double clearance, W;
    bool between;
    double x, k;
  };
  const Row table[] = {{0, 58.8, false, 1.789759857e-06, 49280354.37},
                       {0, 196, false, 3.993747404e-06, 73615071.33},
                       {0, 58.8, true, 1.802089581e-06, 48943182.92},
                       {0, 196, true, 4.021260482e-06, 73111404.08},
                       {1, 58.8, false, 2.97298009e-06, 49114386.5},
                       {1, 196, false, 5.180283765e-06, 73565735.29},
                       {1, 58.8, true, 3.001953619e-06, 47750816.21},
                       {1, 196, true, 5.242020287e-06, 72842652},
                       {5, 58.8, false, 7.567395999e-06, 43916464.13},
                       {5, 196, false, 9.87145827e-06, 72322642.58},
                       {5, 58.8, true, 7.344383524e-06, 45642192.09},
                       {5, 196, true, 9.724052036e-06, 68180378.76},
                       {10, 58.8, false, 1.268832021e-05, 32808591.6},
                       {10, 58.8, true, 1.275634453e-05, 45642192.09},
                       {10, 196, false, 1.559219672e-05, 67581319.78},
                       {10, 196, true, 1.513601304e-05, 68180378.76}};
  test::Record record("Ball bearing with eight balls: displacement and stiffness under load",
                      "Hertzian balls, equilibrium by bisection; geometry common in papers on "
                      "varying compliance (S. Fukata et al., Bull. JSME 28 (1985) 899)");
  for (const Row& t : table) {
    const double angle = -0.5 * pi + (t.between ? pi / 8 : 0.0);
    const Vec2 along(std::cos(angle), std::sin(angle));
    const DeckModel m(lateral_mass(
        20, "0 m/s^2",
        fmt::format(
            "[[bearing]]\nname = \"balls\"\nat = \"mass\"\ntype = \"ball\"\nballs = "
            "8\nball_diameter = \"11.9 mm\"\n"
            "pitch_diameter = \"52 mm\"\nclearance = \"{} um\"\nstiffness = \"1.334e10 N/m^1.5\"\n",
            t.clearance) +
            load(t.W * along)));
    analysis::SteadyRotation turning = m.running();
    turning.mean = false;
    analysis::SteadySystem running(m.built.system, turning);
    const auto e = analysis::EquilibriumSolver(running).solve(0.0);
    const Vec2 r = e.state.q.segment<2>(6 * m.disk() + 1);
    const std::string at = fmt::format("clearance {:g} um, {:g} N, {}: ", t.clearance, t.W,
                                       t.between ? "between balls" : "on a ball");
    record.check(at + "displacement", "m", r.dot(along), t.x, 1e-8 * t.x);
    la::MCK mck = m.built.system.make_matrices();
    ASSERT_TRUE(running.tangent(e.state.frames, 0.0, e.state.q, mck));
    record.check(at + "stiffness", "N/m", along.dot(lateral(mck.K, m.disk()) * along), t.k,
                 1e-7 * t.k);
  }
}

// Varying compliance: 20 kg, 2000 N s/m, 5 um, 10 turns a second: limit cycle by an independent run
// (DOP853, 1e-10). The balls pass 3.084615385 times a turn.
TEST(BallBearingDeck, VaryingComplianceCycle) {
  const DeckModel m(
      lateral_mass(
          20, "9.8 m/s^2",
          "[[bearing]]\nname = \"balls\"\nat = \"mass\"\ntype = \"ball\"\nballs = 8\nball_diameter "
          "= \"11.9 mm\"\npitch_diameter = \"52 mm\"\n"
          "clearance = \"5 um\"\nstiffness = \"1.334e10 N/m^1.5\"\nc_radial = \"2000 N.s/m\"\n") +
      at_speed(20 * pi));
  system::SystemProblem problem(m.built.system);
  system::State s = m.built.system.make_state();
  s.q[6 * m.disk() + 2] = -9.8e-6;
  problem.impose(0.0, s.q, s.v, s.a);
  const double period = 1 / (10 * 3.084615385);
  analysis::TransientOptions o;
  o.integrator.tolerance = 1e-7;
  o.integrator.t_end = 21 * period;
  o.integrator.breakpoints = {20 * period};  // a step ends where the mean begins
  o.integrator.breakpoints.insert(o.integrator.breakpoints.begin(), 19 * period);
  Windows w(m.disk(), Vec2::Zero(), {{20 * period, 21 * period}, {19 * period, 20 * period}});
  const auto r = analysis::run_transient(problem, s, o, {&w});
  ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
  EXPECT_LT(
      (w.mean[0] - w.mean[1]).norm(),
      1e-4 * 1.6e-7);  // the cycle repeats with the passes of the balls: one period after another
  // their x is -z, their y is +y; given to nine digits
  EXPECT_NEAR(w.mean[0].y(), -9.82006387e-06, 1e-4 * 1.6e-7);  // of the swing
  EXPECT_NEAR(-w.most[0].y(), 9.71753874e-06, 1e-4 * 1e-5);
  EXPECT_NEAR(-w.least[0].y(), 9.87555871e-06, 1e-4 * 1e-5);
  EXPECT_NEAR(std::max(-w.least[0].x(), w.most[0].x()), 7.17400478e-07, 1e-3 * 7e-7);
  EXPECT_NEAR(std::min(-w.least[0].x(), w.most[0].x()), 6.63437104e-07, 1e-3 * 7e-7);
}
