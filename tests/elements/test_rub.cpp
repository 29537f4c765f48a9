// Rub: conformance, sign of friction, synchronous full annular rub (exact branches) and its
// transients.
#include "conformance.hpp"
#include <elements/supports/rub.hpp>
#include <complex>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

// Jeffcott rotor in a compliant ring: closed form of Black, J. Mech. Eng. Sci. 10 (1968) 1-12, doi
// 10.1243/JMES_JOUR_1968_010_003_02: |k - m O^2 + i c O + kc (1 + i mu)(1 - gap/R)| R = m e O^2
constexpr double m = 10, k = 1e6, c = 400, ecc = 1e-4, kc = 4e6, gap = 3e-4;

RubLaw ring(double mu) {
  RubLaw r;
  r.gap = gap;
  r.stiffness = kc;
  r.friction = mu;
  r.radius = 0.05;
  r.slip_speed = 1e-2;
  return r;
}

/// Synchronous equation with the contact force taken from the kernel; zero on a branch.
double imbalance(const RubLaw& rub, double Omega, double R) {
  LateralMotion x;
  x.r = Vec2(R, 0);
  x.v = Vec2(0, Omega * R);
  x.spin = Omega;
  Vector<4> z;
  rub.force(x, z);
  const Complex dynamic = (Complex(k - m * Omega * Omega, c * Omega)) * R - Complex(z[0], z[1]);
  return std::abs(dynamic) - m * ecc * Omega * Omega;
}

double root(const RubLaw& rub, double Omega, double lo, double hi) {
  double a = imbalance(rub, Omega, lo);
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (lo + hi), v = imbalance(rub, Omega, mid);
    if ((v > 0) == (a > 0)) {
      lo = mid;
      a = v;
    } else
      hi = mid;
  }
  return 0.5 * (lo + hi);
}

/// Classical Runge-Kutta on the rotor; returns the radius after `turns`.
double settle(const RubLaw& rub, double Omega, Vec2 r, Vec2 v, int turns, int steps_per_turn) {
  const double h = two_pi / Omega / steps_per_turn;
  double t = 0;
  const auto accel = [&](double s, const Vec2& x, const Vec2& w) {
    LateralMotion q;
    q.r = x;
    q.v = w;
    q.spin = Omega;
    Vector<4> z;
    rub.force(q, z);
    return Vec2((m * ecc * Omega * Omega * Vec2(std::cos(Omega * s), std::sin(Omega * s)) - k * x -
                 c * w + z.head<2>()) /
                m);
  };
  for (int i = 0; i < turns * steps_per_turn; ++i, t += h) {
    const Vec2 k1 = accel(t, r, v), k2 = accel(t + h / 2, r + h / 2 * v, v + h / 2 * k1),
               k3 = accel(t + h / 2, r + h / 2 * v + h * h / 4 * k1, v + h / 2 * k2),
               k4 = accel(t + h, r + h * v + h * h / 2 * k2, v + h * k3);
    r += h * v + h * h / 6 * (k1 + k2 + k3);
    v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return r.norm();
}

}  // namespace

TEST(Rub, Conformance) {
  RubLaw law;
  law.gap = 0.05;
  law.stiffness = 1e3;
  law.damping = 0.1;
  law.friction = 0.3;
  law.radius = 0.4;
  law.slip_speed = 2.0;
  ConformanceOptions o;
  o.chart = tilted_chart();
  o.u = 0.03;
  o.du = 0.3;
  o.tilt = 0.3;
  o.dtilt = 0.5;
  o.dphi = 1.0;
  o.q0.assign(12, 0.0);
  o.v0.assign(12, 0.0);
  o.q0[1] = 0.1;
  o.q0[2] = -0.12;  // always in contact
  for (double spin : {4.0, -6.0, 0.0}) {
    o.v0[3] = spin;
    o.v0[9] = 0.4 * spin + 1;
    check_kernel(Rub{{law}}, o);
    check_kernel(LateralJoint<RubLaw, true>{{law}, {0.02, 0.03}}, o);
  }
  // apart: nothing
  o.over_declared.spin = true;
  o.q0.assign(12, 0.0);
  o.u = 0.01;
  check_kernel(Rub{{law}}, o);
  // released faster than the contact relaxes: N = 0, the stored energy is lost
  o.q0[1] = 0.1;
  o.v0[1] = -25;
  o.u = 0.005;
  check_kernel(Rub{{law}}, o);
}

TEST(Rub, FrictionOpposesSlipAndTakesPower) {
  RubLaw law = ring(0.2);
  law.damping = 0.5;
  Random random(17);
  for (int n = 0; n < 2000; ++n) {
    LateralMotion x;
    x.r = 1e-3 * random.vector<2>();
    x.v = random.vector<2>();
    x.spin = 50 * random.vector<1>()[0];
    x.housing_spin = 10 * random.vector<1>()[0];
    Vector<4> z;
    law.force(x, z);
    const double rho = x.r.norm();
    const Vec2 out(x.r / rho), t(-out.y(), out.x());
    const double normal = -z.head<2>().dot(out), friction = z.head<2>().dot(t);
    const double slip = x.v.dot(t) + law.radius * x.spin - (law.radius + rho) * x.housing_spin;
    EXPECT_GE(normal, 0.0);
    EXPECT_LE(friction * slip, 0.0);
    EXPECT_LE(std::abs(friction), 0.2 * normal * (1 + 1e-14));
    system::Energy e;
    law.energy(x, e);
    EXPECT_GE(e.dissipated, 0.0);
  }
}

TEST(Rub, OnsetAndBranches) {
  // contact onset and re-entry of the contact-free response, in units of omega_n
  const double wn = std::sqrt(k / m);
  for (double f : {0.87688784, 1.20957336}) {
    const double O = f * wn;
    EXPECT_NEAR(m * ecc * O * O / std::abs(Complex(k - m * O * O, c * O)), gap, 1e-7 * gap);
    EXPECT_NEAR(imbalance(ring(0.1), O, gap), 0.0, 1e-6 * m * ecc * O * O);
  }
  const double f[] = {0.9, 1.0, 1.1, 1.3};
  const double mu0[] = {0.000303876166, 0.000322820753, 0.000345914385, 0.000409369978};
  const double mu5[] = {0.000303790679, 0.000322297013, 0.000344793882, 0.00040612574};
  for (int i = 0; i < 4; ++i) {
    const double low = i == 3 ? 3.5e-4 : 1.000001 * gap;
    EXPECT_NEAR(root(ring(0), f[i] * wn, low, 1e-3), mu0[i], 2e-7 * mu0[i]);
    EXPECT_NEAR(root(ring(0.05), f[i] * wn, low, 1e-3), mu5[i], 2e-7 * mu5[i]);
  }
  // coexisting states at 1.5: upper branches and the unstable middle one
  EXPECT_NEAR(root(ring(0), 1.5 * wn, 4.2e-4, 1e-3), 0.000510221455, 2e-7 * 5e-4);
  EXPECT_NEAR(root(ring(0.01), 1.5 * wn, 4.2e-4, 1e-3), 0.000508749664, 2e-7 * 5e-4);
  EXPECT_NEAR(root(ring(0.05), 1.5 * wn, 4.2e-4, 1e-3), 0.000501675563, 2e-7 * 5e-4);
  EXPECT_NEAR(root(ring(0), 1.5 * wn, 3.01e-4, 4.2e-4), 0.00035837103, 2e-7 * 4e-4);
  EXPECT_NEAR(root(ring(0), 1.3 * wn, 3.001e-4, 3.5e-4), 0.000313920447, 2e-7 * 3e-4);
  // upper folds: the branch exists below them and not above
  const double fold[3][2] = {{0, 2.078104}, {0.01, 2.055764}, {0.05, 1.967031}};
  for (const auto& p : fold)
    for (double side : {-1e-4, 1e-4}) {
      const double O = (1 + side) * p[1] * wn;
      double least = infinity;  // along R the contact branch is where the imbalance dips below zero
      for (double R = 4.5e-4; R < 2e-3; R += 2e-8)
        least = std::min(least, imbalance(ring(p[0]), O, R));
      EXPECT_EQ(least < 0, side < 0) << "mu " << p[0];
    }
}

TEST(Rub, TransientsFallOnTheBranches) {
  const double wn = std::sqrt(k / m);
  // from rest into contact: RK4 with 400 steps a turn, error 1e-8 of the radius
  EXPECT_NEAR(settle(ring(0.05), 1.1 * wn, Vec2::Zero(), Vec2::Zero(), 150, 400), 0.000344793882,
              1e-6 * 3.4e-4);
  // at 1.5 from rest: no contact; from the upper branch: stays there
  EXPECT_NEAR(settle(ring(0.05), 1.5 * wn, Vec2::Zero(), Vec2::Zero(), 200, 400), 0.000177961557,
              1e-6 * 1.8e-4);
  const double R = 0.000501675563, O = 1.5 * wn;
  // phase of the whirl behind the unbalance from the closed form
  const Complex z = Complex(k - m * O * O, c * O) + kc * Complex(1, 0.05) * (1 - gap / R);
  const double lag = -std::arg(z);
  EXPECT_NEAR(settle(ring(0.05), O, R * Vec2(std::cos(lag), std::sin(lag)),
                     O * R * Vec2(-std::sin(lag), std::cos(lag)), 150, 400),
              R, 1e-6 * R);
}
