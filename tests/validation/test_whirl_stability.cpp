// Onset of instability: internal damping and oil films, against closed forms.
#include "../analysis/rotors.hpp"
#include "record.hpp"

#include <analysis/spectra/stability.hpp>
#include <elements/films/short_journal.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::tests;

namespace {

constexpr double rpm = pi / 30;

/// Massless shaft between pins with a point mass of 10 kg in the middle, 48 EI/L^3 = 1e6 N/m,
/// internal damping ci = 100 N s/m and external ce = 50 N s/m at the mass; extra stiffness along z.
Rotor jeffcott(double extra) {
  Rotor r;
  r.add_shaft(constants(1e9, 0, 1e5, 1e6 / 48, 0), 1.0, 2).pin(0, true).pin(1.0);
  r.add_shaft_damping<true>(100 / 1e6);
  r.add_disk(0.5, 10, 0.01, 0.005).add_bearing(0.5, 0, extra, 50, 50);
  return r;
}

StabilityResult onsets(const system::System& s, double from, double to, Index modes = 2) {
  Linearizer linear(s);
  StabilityOptions o;
  o.min_speed = from;
  o.max_speed = to;
  o.modes = modes;
  o.motion = Motion::lateral;
  return find_instability(linear, o);
}

}  // namespace

// A. L. Kimball 1924, D. M. Smith 1933: onset at omega_n (1 + ce/ci), whirling at omega_n.
TEST(InternalDamping, OnsetOfAJeffcottRotor) {
  test::Record record("Internal damping: onset of instability",
                      "A. L. Kimball 1924, D. M. Smith 1933: omega_n (1 + ce/ci)");
  const system::System s = jeffcott(0).b.finalize();
  const auto r = onsets(s, 10, 900);
  EXPECT_TRUE(r.stable_at_start);
  ASSERT_EQ(r.onsets.size(), 1u);
  record.check("onset speed", "rad/s", r.onsets[0].speed, 474.341649025, 1e-9 * 474.34);
  record.check("whirl frequency there", "rad/s", r.onsets[0].frequency, 316.227766017,
               1e-9 * 316.2);
  EXPECT_TRUE(r.onsets[0].gains);
  EXPECT_EQ(r.onsets[0].mode.direction, Direction::forward);
  // growth on both sides, 1/s
  Linearizer linear(s);
  for (const auto& [factor, growth] : {std::pair{1.01, 0.0749572}, {0.99, -0.07495847}}) {
    double most = -infinity;
    for (const WhirlMode& m :
         whirl_modes(linear, factor * 474.341649025, {.count = 2, .motion = Motion::lateral}))
      most = std::max(most, m.lambda.real());
    EXPECT_NEAR(most, growth, 2e-6 * std::abs(growth)) << factor;
  }
}

// Unequal supports raise it: Omega = sqrt(d^2 + c^2 k/m)/ci, d half the difference and k the mean
// of the stiffnesses, c = ci + ce.
TEST(InternalDamping, OnsetOnUnequalSupports) {
  test::Record record("Internal damping on unequal supports",
                      "Omega = sqrt(d^2 + c^2 k/m)/ci, d half the difference and k the mean of the "
                      "stiffnesses, c = ci + ce");
  const auto r = onsets(jeffcott(2e5).b.finalize(), 10, 2000);
  ASSERT_EQ(r.onsets.size(), 1u);
  record.check("onset speed", "rad/s", r.onsets[0].speed, 1116.915395, 1e-9 * 1116.9);
  record.check("whirl frequency there", "rad/s", r.onsets[0].frequency, 331.662479, 2e-9 * 331.7);
}

// Short plain journal bearings, pi film (Friswell et al. 2010, example 5.5.1: D = 100 mm, L = 30
// mm, c = 0.1 mm, 0.1 Pa s, 525 N): equilibrium in the film, its coefficients and the onset solved
// for together, from the nonlinear film element.
TEST(OilFilm, OnsetOfARigidRotor) {
  test::Record record("Oil whirl of a rigid rotor in short bearings",
                      "M. I. Friswell et al. 2010, example 5.5.1; characteristic equation of the "
                      "linear film coefficients");
  system::Builder b;
  const Index line = b.add_line("rotor"), node = b.add_node({Vec3::Zero(), line, "journal"});
  b.add(elements::RigidDisk{525 / 9.81, 1, 2, 0}, {node}, "disks");
  b.add(elements::ShortJournalBearing{{elements::ShortJournal{0.05, 0.03, 1e-4, 0.1}}},
        {node, b.add_ground(Vec3::Zero(), "ground")}, "films");
  b.set_gravity(Vec3(0, -9.81, 0));
  for (int c : {0, 4, 5})
    b.hold(node, c);
  const auto r = onsets(b.finalize(), 3000 * rpm, 12000 * rpm);
  ASSERT_GE(r.onsets.size(), 1u);
  record.check("onset speed", "rpm", r.onsets[0].speed / rpm, 8244.3368, 1e-7 * 8244.3);
  record.check("whirl frequency", "rad/s", r.onsets[0].frequency, 432.5136, 2e-7 * 432.5);
  record.check("whirl / spin", "-", r.onsets[0].ratio(), 0.500974, 1e-6);
}

// A mass on a flexible shaft between massless journals: Omega = sqrt(keq ks/((keq + ks) M))/WFR.
TEST(OilFilm, OnsetOfAFlexibleRotor) {
  test::Record record("Oil whirl of a flexible rotor",
                      "Omega = sqrt(keq ks/((keq + ks) M))/WFR, short bearings as above");
  for (const auto& [natural, speed, whirl] : {std::tuple{100.0, 1811.3617, 97.37152},
                                              {200.0, 3430.5272, 181.42303},
                                              {300.0, 4678.6899, 246.38206}}) {
    system::Builder b;
    const Index line = b.add_line("rotor");
    const Index journal = b.add_node({Vec3::Zero(), line, "journal"}),
                mass = b.add_node({Vec3::Zero(), line, "mass"});
    const double M = 525 / 9.81;
    b.add(elements::RigidDisk{M, 1, 2, 0}, {mass}, "disks");
    elements::TranslationalBearing spring;
    spring.K(1, 1) = spring.K(2, 2) = M * natural * natural;
    b.add(spring, {mass, journal}, "shaft");
    // the journal turns with the shaft; it carries polar inertia of its own to be a part of it
    b.add(elements::RigidDisk{0, 1e-9, 1e-9, 0}, {journal}, "journals");
    b.add(elements::ShortJournalBearing{{elements::ShortJournal{0.05, 0.03, 1e-4, 0.1}}},
          {journal, b.add_ground(Vec3::Zero(), "ground")}, "films");
    b.set_gravity(Vec3(0, -9.81, 0));
    for (const Index n : {journal, mass})
      for (int c : {0, 4, 5})
        b.hold(n, c);
    b.hold(journal, 3, make_angle_of_speed(make_constant(0.0), 0.0));
    b.hold(mass, 3, make_angle_of_speed(make_constant(0.0), 0.0));
    const auto r = onsets(b.finalize(), 0.5 * speed * rpm, 1.5 * speed * rpm);
    ASSERT_GE(r.onsets.size(), 1u) << natural;
    record.check("onset speed, shaft alone " + std::to_string(static_cast<int>(natural)) + " rad/s",
                 "rpm", r.onsets[0].speed / rpm, speed, 1e-7 * speed);
    EXPECT_NEAR(r.onsets[0].frequency, whirl, 1e-7 * whirl);
  }
}

// Friswell example 5.9.6: the two-disk rotor on two of these bearings, each carrying 525 N. Six
// elements.
TEST(OilFilm, OnsetOfTheTwoDiskRotor) {
  test::Record record("Oil whirl of the two-disk rotor, example 5.9.6",
                      "M. I. Friswell et al. 2010; six elements, each bearing carries 525 N");
  Rotor rotor;
  rotor.add_shaft(cylinder(0.05, 2.11e11, 8.12e10, 7810), 1.5, 6, elements::MassKind::consistent);
  rotor.add_disk_of_size(0.5, 0.07, 0.28, 0.05, 7810)
      .add_disk_of_size(1.0, 0.07, 0.35, 0.05, 7810)
      .hold_axially(0);
  for (double x : {0.0, 1.5}) {
    rotor.b.add(elements::ShortJournalBearing{{elements::ShortJournal{0.05, 0.03, 1e-4, 0.1}}},
                {rotor.at(x), rotor.b.add_ground(Vec3(x, 0, 0), "ground")}, "films");
    rotor.b.add(elements::FixedLoad{Vec3(0, -525, 0), Vec3::Zero(), 0, nullptr}, {rotor.at(x)},
                "weight");
  }
  const auto r = onsets(rotor.b.finalize(), 500 * rpm, 3000 * rpm, 8);
  ASSERT_GE(r.onsets.size(), 1u);
  // the reference is stated to 2e-4
  record.check("onset speed", "rpm", r.onsets[0].speed / rpm, 2075.4209, 2e-4 * 2075.4);
  record.check("whirl frequency", "Hz", r.onsets[0].frequency / two_pi, 17.418836, 1e-5 * 17.4);
  EXPECT_NEAR(r.onsets[0].ratio(), 0.50357504, 2e-4);
}
