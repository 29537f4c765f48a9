// Hysteretic damping of the shaft material in its rotating axes, against closed forms of a Jeffcott
// rotor (G. Genta, Dynamics of Rotating Systems, 2005, ch. 3; the law in fixed axes: E. S. Zorzi,
// H. D. Nelson 1977, doi 10.1115/1.3446254).
//   z = y + i z, forward z ~ exp(lambda t):
//       m lambda^2 + c lambda + k (1 + i eta sign(w - Omega)) = 0,   backward: sign = -1.
#include "../analysis/rotors.hpp"
#include "record.hpp"

#include <analysis/response/frequency_response.hpp>
#include <analysis/spectra/stability.hpp>
#include <analysis/response/unbalance.hpp>
#include <elements/shaft/hysteretic_damping.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::tests;

namespace {

constexpr double m = 10, k = 1e6, eta = 0.02;

/// Massless shaft between pins, 48 EI/L^3 = k, with a disk in the middle and external damping
/// there.
Rotor jeffcott(double c, double extra = 0) {
  Rotor r;
  r.add_shaft(constants(1e9, 0, 1e5, k / 48, 0), 1.0, 2).pin(0, true).pin(1.0);
  using Viscous = elements::ShaftDamping<true>;
  for (std::size_t i = 0; i < r.element.size(); ++i)
    r.b.add(elements::HystereticDamping<Viscous>{Viscous(r.element[i], Vec3::UnitX(), eta, 0, 0),
                                                 Viscous(r.element[i], Vec3::UnitX(), 0, eta, eta),
                                                 0.0},
            {r.node[i], r.node[i + 1]}, "hysteretic damping");
  r.add_disk(0.5, m, 0.01, 0.005).add_bearing(0.5, 0, extra, c, c);
  return r;
}

MatX dense(const la::BlockMatrix<6>& a) {
  const la::BlockPattern& p = a.pattern();
  MatX out = MatX::Zero(6 * p.size(), 6 * p.size());
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[static_cast<std::size_t>(i)];
         s < p.row_start()[static_cast<std::size_t>(i) + 1]; ++s)
      out.block<6, 6>(6 * i, 6 * p.cols()[static_cast<std::size_t>(s)]) = a.block(s);
  return out;
}

Complex root(double c, double sign) {
  return -c / (2 * m) +
         Complex(0, 1) * std::sqrt(k / m * Complex(1, sign * eta) - c * c / (4 * m * m));
}

}  // namespace

TEST(HystereticDamping, EigenvaluesOfAJeffcottRotor) {
  const double w = std::sqrt(k / m);
  for (const double c : {0.0, 50.0}) {
    const system::System s = jeffcott(c).b.finalize();
    Linearizer linear(s);
    for (const double Omega : {0.0, 0.5 * w, 0.99 * w, 1.01 * w, 3.0 * w, -2.0 * w}) {
      const auto modes = whirl_modes(linear, Omega, {.count = 2, .motion = Motion::lateral});
      ASSERT_EQ(modes.size(), 2u);
      for (const WhirlMode& x : modes) {
        // forward and backward as seen along the spin
        const bool driven = x.direction == Direction::forward && std::abs(Omega) > w;
        EXPECT_LT(std::abs(x.lambda - root(c, driven ? -1.0 : 1.0)), 1e-11 * w)
            << Omega << ' ' << to_string(x.direction);
        if (Omega != 0.0) {
          EXPECT_NE(x.direction, Direction::planar);
        }
        if (driven && c == 0.0) {
          EXPECT_GT(x.lambda.real(), 0.0);
        }  // destabilising above the critical speed
      }
    }
  }
}

// Without external damping forward whirl becomes unstable where the speed passes its frequency;
// with c < eta sqrt(k m) too; with more, never.
TEST(HystereticDamping, OnsetAtTheCriticalSpeed) {
  test::Record record("Hysteretic internal damping: onset of instability",
                      "closed form: the undamped critical speed while c < eta sqrt(k m); G. Genta, "
                      "Dynamics of Rotating Systems (2005), doi 10.1007/0-387-28687-X");
  for (const double c : {0.0, 50.0, 100.0}) {
    const system::System s = jeffcott(c).b.finalize();
    Linearizer linear(s);
    StabilityOptions o;
    o.min_speed = 10;
    o.max_speed = 900;
    o.modes = 2;
    o.motion = Motion::lateral;
    const StabilityResult r = find_instability(linear, o);
    EXPECT_TRUE(r.stable_at_start);
    if (c > eta * std::sqrt(k * m)) {
      EXPECT_TRUE(r.onsets.empty()) << c;
      continue;
    }
    ASSERT_EQ(r.onsets.size(), 1u) << c;
    record.check("external damping " + std::to_string(static_cast<int>(c)) + " N s/m: onset",
                 "rad/s", r.onsets[0].speed, root(c, 1).imag(), 1e-9 * 316);
    EXPECT_TRUE(r.onsets[0].gains);
    EXPECT_EQ(r.onsets[0].mode.direction, Direction::forward);
  }
}

// A rotating force meets 1/(k (1 +- i eta) - m w^2); the synchronous response to unbalance bends
// the shaft once and for all: no loss.
TEST(HystereticDamping, ForcedResponse) {
  Rotor rotor = jeffcott(0);
  rotor.add_unbalance(0.5, 1e-3);
  const system::System s = rotor.b.finalize();
  const Index i = rotor.at(0.5);
  Linearizer linear(s);
  for (const double Omega : {0.0, 200.0, 500.0})
    for (const double w : {100.0, 300.0, 316.2277, 400.0, 700.0})
      for (const double whirl : {1.0, -1.0}) {
        FrequencyResponseOptions o;
        o.forces = {{6 * i + 1, 1.0},
                    {6 * i + 2, Complex(0, -whirl)}};  // y = cos w t, z = whirl sin w t
        o.unknowns = {6 * i + 1, 6 * i + 2};
        const FrequencyPoint p = HarmonicResponder(linear, o).at(Omega, w);
        const double sign = whirl > 0 && w < Omega ? -1.0 : 1.0;
        const Complex exact = 1.0 / (k * Complex(1, eta * sign) - m * w * w);
        EXPECT_LT(std::abs(p.unknown[0] - exact), 1e-11 * std::abs(exact))
            << Omega << ' ' << w << ' ' << whirl;
        EXPECT_LT(std::abs(p.unknown[1] - exact * Complex(0, -whirl)), 1e-11 * std::abs(exact));
      }
  UnbalanceOptions o;
  o.probes = {{"disk", {i, 0.0}, {}}};
  for (const double Omega : {150.0, 300.0, 450.0}) {
    const SteadyPoint p = UnbalanceSolver(linear, o).at(Omega);
    EXPECT_NEAR(p.probe[0][0].orbit().major,
                std::abs(1e-3 * Omega * Omega / (k - m * Omega * Omega)),
                1e-11 * p.probe[0][0].orbit().major)
        << Omega;
  }
}

// A sagging shaft leans to the side it turns to, by the same angle at every speed: z = -i m g/(k (1
// - i eta)).
TEST(HystereticDamping, SagLeansSideways) {
  Rotor rotor = jeffcott(0);
  rotor.b.set_gravity(Vec3(0, 0, -9.81));
  const system::System s = rotor.b.finalize();
  const Index i = rotor.at(0.5);
  Linearizer linear(s);
  for (const double Omega : {50.0, 400.0, -50.0}) {
    linear.at(Omega);
    const Complex exact = Complex(0, -1) * m * 9.81 / (k * Complex(1, Omega > 0 ? -eta : eta));
    const VecX& q = linear.equilibrium().state.q;
    // sag 1e-4 of the span: the large rotation of the shaft leaves the square of that
    EXPECT_NEAR(q[6 * i + 1], exact.real(), 1e-7 * std::abs(exact)) << Omega;
    EXPECT_NEAR(q[6 * i + 2], exact.imag(), 1e-7 * std::abs(exact)) << Omega;
  }
}

// Force and matrices of the element agree at the rate they are for.
TEST(HystereticDamping, TangentsAreExact) {
  elements::ElementSection section = constants(1e7, 2e6, 3e3, 5e3, 4);
  const auto c = elements::make_shaft_constants(section, 0.4);
  using Viscous = elements::ShaftDamping<true>;
  const elements::HystereticDamping<Viscous> law{Viscous(c, Vec3::UnitX(), eta, 0, 0),
                                                 Viscous(c, Vec3::UnitX(), 0, eta, eta), 0.0};
  system::Builder b;
  const Index line = b.add_line("line"), n1 = b.add_node({Vec3::Zero(), line, "1"}),
              n2 = b.add_node({Vec3(0.4, 0, 0), line, "2"});
  b.add(law, {n1, n2}, "hysteretic damping");
  b.add(elements::RigidDisk{1, 1, 1, 0}, {n1}, "disk");
  b.add(elements::RigidDisk{1, 1, 1, 0}, {n2}, "disk");
  const system::System s = b.finalize();
  system::Workspace work = s.make_workspace();
  work.context.hysteretic = true;
  const std::vector<std::size_t> only{0};
  system::State x = s.make_state();
  const double Omega = 70;
  for (Index j = 0; j < 12; ++j)
    x.q[j] = 0.03 * std::sin(2.0 + 3.0 * static_cast<double>(j));
  x.v[3] = x.v[9] = Omega;
  la::MCK t = s.make_matrices();
  for (const double w : {0.0, 40.0, 100.0}) {
    work.context.whirl = work.context.whirl_side = w;
    ASSERT_TRUE(s.tangent(work, x.frames, 0, x.q, x.v, x.a, t, &only));
    const MatX C = dense(t.C), K = dense(t.K);
    double worst_C = 0, worst_K = 0;
    for (Index j = 0; j < 12; ++j) {
      const double h = 1e-4;
      VecX r[4];
      for (int side = 0; side < 4; ++side) {
        VecX q = x.q, v = x.v;
        (side < 2 ? q : v)[j] += side % 2 ? h : -h;
        r[side].resize(12);
        ASSERT_TRUE(s.residual(work, x.frames, 0, q, v, x.a, r[side], &only));
      }
      if (j % 6 != 3)
        worst_C = std::max(worst_C, ((r[3] - r[2]) / (2 * h) - C.col(j))
                                        .cwiseAbs()
                                        .maxCoeff());  // the spin itself is no small motion
      worst_K = std::max(worst_K, ((r[1] - r[0]) / (2 * h) - K.col(j)).cwiseAbs().maxCoeff());
    }
    // second differences of the geometry, h^2 x 4 EI/l
    EXPECT_LT(worst_C, 1e-6 * std::max(1.0, C.cwiseAbs().maxCoeff())) << w;
    EXPECT_LE(worst_K, 1e-6 * K.cwiseAbs().maxCoeff()) << w;  // above the spin there is none
    EXPECT_GT(K.cwiseAbs().maxCoeff() + C.cwiseAbs().maxCoeff(), 1.0);
  }
}
