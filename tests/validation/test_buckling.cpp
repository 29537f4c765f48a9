// Linearised buckling against Euler and Greenhill.
#include "../analysis/rotors.hpp"
#include "record.hpp"

#include <analysis/statics/buckling.hpp>
#include <core/error.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::tests;

namespace {

constexpr double EI = 2000, L = 1.5, GJ = 1500;

std::vector<BucklingMode> factors(const system::System& s, Index count = 2) {
  SteadyRotation running;
  running.ratio.assign(static_cast<std::size_t>(s.lines()), 0.0);
  SteadySystem still(s, running);
  return buckling(still, 0, count).modes;
}

}  // namespace

// Pinned column under an axial force of 1 N: pi^2 EI/L^2, twice (both planes).
TEST(Buckling, EulerColumn) {
  test::Record record("Pinned column", "L. Euler: P = pi^2 EI/L^2; 8 elements");
  Rotor r;
  r.add_shaft(constants(1e12, 0, GJ, EI, 1), L, 8).pin(0, true).pin(L);
  r.b.hold(r.at(0), 3);
  r.b.add(elements::FixedLoad{Vec3(-1, 0, 0), Vec3::Zero(), 0, nullptr}, {r.at(L)}, "thrust");
  const auto m = factors(r.b.finalize());
  ASSERT_EQ(m.size(), 2u);
  // cubic bowing of eight elements: (pi/8)^4/720 = 3.3e-5
  for (const BucklingMode& k : m)
    record.check("buckling load over pi^2 EI/L^2", "-", k.factor.real() * L * L / (EI * pi * pi),
                 1.0, 3.5e-5);
}

// With shear: Engesser's P = Pe/(1 + Pe/kGA).
TEST(Buckling, ColumnSoftInShear) {
  test::Record record("Pinned column soft in shear",
                      "F. Engesser 1889: P = Pe/(1 + Pe/kGA); 32 elements");
  const double kGA = 1e5, Pe = EI * pi * pi / (L * L);
  Rotor r;
  r.add_shaft(constants(1e9, kGA, GJ, EI, 1), L, 32).pin(0, true).pin(L);
  r.b.hold(r.at(0), 3);
  r.b.add(elements::FixedLoad{Vec3(-1, 0, 0), Vec3::Zero(), 0, nullptr}, {r.at(L)}, "thrust");
  record.check("buckling load", "N", factors(r.b.finalize())[0].factor.real(), Pe / (1 + Pe / kGA),
               2e-4 * Pe);
}

// A. G. Greenhill 1883: a shaft under an end torque of fixed direction buckles at M L/EI = 2 pi
// between pins, at 8.986818916 between clamps that may slide along and turn about the axis at one
// end.
TEST(Buckling, ShaftUnderTorque) {
  for (const auto& [clamped, expected] : {std::pair{false, two_pi}, {true, 8.986818916}}) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      Rotor r;
      r.add_shaft(constants(1e9, 0, GJ, EI, 1), L, k == 0 ? 12 : 24).pin(0, true).pin(L);
      r.b.hold(r.at(0), 3);
      if (clamped)
        for (double x : {0.0, L})
          for (int c : {4, 5})
            r.b.hold(r.at(x), c);
      // fixed direction at both ends; the held angle then carries nothing
      r.b.add(elements::FixedLoad{Vec3::Zero(), Vec3(1, 0, 0), 0, nullptr}, {r.at(L)}, "torque");
      r.b.add(elements::FixedLoad{Vec3::Zero(), Vec3(-1, 0, 0), 0, nullptr}, {r.at(0)}, "torque");
      const auto m = factors(r.b.finalize());
      ASSERT_FALSE(m.empty());
      error[k] = std::abs(std::abs(m[0].factor.real()) * L / EI / expected - 1.0);
    }
    EXPECT_LT(error[1], 2e-4) << clamped;
    EXPECT_GT(std::log2(error[0] / error[1]), 3.5)
        << clamped;  // fourth order, less what the next one leaves at 12 elements
  }
}

TEST(Buckling, SaysWhenNothingLoads) {
  Rotor r;
  r.add_shaft(constants(1e9, 0, GJ, EI, 1), L, 4).pin(0, true).pin(L);
  r.b.hold(r.at(0), 3);
  const system::System s = r.b.finalize();
  try {
    factors(s);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().at(0).code, "E79");
  }
}
