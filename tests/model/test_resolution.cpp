// What the steps of a deck ask of the mesh, against closed forms of a uniform shaft.
#include <model/resolution.hpp>
#include "../meshes/models.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

constexpr double length = 1.2, diameter = 0.06;

model::Model uniform(model::StepLaw law) {
  model::Model m;
  m.materials = {steel()};
  model::Shaft shaft;
  shaft.name = "shaft";
  shaft.speed_ratio = -2.0;
  shaft.sections = {cylinder("a", 0.5, diameter, 0, 0), cylinder("b", 0.7, diameter, 0, 0)};
  m.shafts = {shaft};
  model::Step step;
  step.name = "step";
  step.law = std::move(law);
  m.steps = {step};
  return m;
}

/// n/2 + 1 half-waves in each plane: (half-waves pi/L)^2 sqrt(EI/rhoA), I/A = d^2/16.
double lateral(double n) {
  const model::Material s = steel();
  return std::pow((0.5 * n + 1) * pi / length, 2) * std::sqrt(s.E / s.rho) * diameter / 4;
}

/// n half-waves of twist: n pi/L sqrt(G/rho).
double torsional(double n) {
  const model::Material s = steel();
  return n * pi / length * std::sqrt(s.G / s.rho);
}

void expect(const char* what, const model::StepLaw& law, double lateral, double torsional,
            int half_waves = 0) {
  const model::Resolution r = model::resolution_of(uniform(law));
  EXPECT_NEAR(r.lateral, lateral, 1e-12 * lateral) << what;
  EXPECT_NEAR(r.torsional, torsional, 1e-12 * torsional) << what;
  EXPECT_EQ(r.half_waves, half_waves) << what;
}

}  // namespace

TEST(Resolution, StepsThatAskForModes) {
  using model::MotionKind;
  model::ModalStep modal;
  modal.modes = 4;
  expect("all motions: where the first kind reaches", modal, lateral(4), lateral(4));
  modal.motion = MotionKind::lateral;
  expect("lateral", modal, lateral(4), 0);
  modal.motion = MotionKind::torsional;
  expect("torsional", modal, 0, torsional(4));
  modal.max_frequency = 0.5 * torsional(4);
  expect("not beyond the frequency", modal, 0, 0.5 * torsional(4));
  model::CampbellStep campbell;
  campbell.modes = 80;  // twist comes first
  expect("Campbell", campbell, torsional(80), torsional(80));
  model::StabilityStep stability;
  stability.modes = 6;
  expect("stability", stability, lateral(6), lateral(6));
  model::TorsionalStep torsion;
  torsion.modes = 3;
  expect("torsional step", torsion, 0, torsional(3));
  model::BucklingStep buckling;
  for (const auto& [modes, half_waves] : {std::pair{1, 1}, {2, 1}, {3, 2}, {6, 3}}) {
    buckling.modes = modes;
    expect("buckling: one half-wave of two planes", buckling, 0, 0, half_waves);
  }
}

TEST(Resolution, StepsThatNameAFrequency) {
  model::CriticalStep critical;
  critical.modes = 8;
  critical.motion = model::MotionKind::lateral;
  expect("critical speeds without an end", critical, lateral(8), 0);
  critical.max_speed = 100;
  critical.orders = {0.5, -3.0, 2.0};
  expect("critical speeds", critical, 300, 0);
  critical.orders = {0.5};  // no order is looked at below one per turn
  expect("critical speeds, low order", critical, 100, 0);
  model::CriticalMapStep map;
  map.max_speed = 150;
  map.order = 2;
  expect("critical map", map, 300, 0);
  model::UnbalanceStep unbalance;
  unbalance.speed.start = -500;
  unbalance.speed.stop = 200;
  expect("unbalance: the shaft turns twice as fast, backward", unbalance, 1000, 0);
  unbalance.speed.values = {100, -700};
  expect("unbalance, values", unbalance, 1400, 0);
  model::HarmonicStep harmonic;
  harmonic.frequency = model::FrequencyRange{800, 30, 2, {}};
  expect("harmonic", harmonic, 800, 800);
  harmonic.frequency->values = {900};
  expect("harmonic, values", harmonic, 900, 900);
  harmonic.speeds = model::ResponseSpeeds{{10, 400, 2, {}}, false};
  harmonic.order = -3;
  expect("harmonic, of the speed", harmonic, 1200, 1200);
}

TEST(Resolution, StepsInTimeAndOfEquilibria) {
  model::TransientStep transient;
  expect("nothing says how fast", transient, lateral(4), lateral(4));
  transient.speed0 = -200;
  expect("initial speed, of the reference: the shaft turns at twice of it", transient, 600, 600);
  transient.stop_speed = 400;
  expect("stop speed", transient, 1200, 1200);
  transient.stop_speed.reset();
  model::Model m = uniform(transient);
  m.shafts[0].spin0 = -500;
  EXPECT_NEAR(model::resolution_of(m).lateral, 750, 1e-9);  // its own
  model::BalancingStep balancing;
  balancing.speeds = {300, 500};
  expect("balancing", balancing, 1000, 0);
  model::ApiLateralStep report;
  report.max_speed = 700;
  expect("lateral report", report, 1400, 0);
  model::StaticStep statics;
  expect("one load step", statics, 0, 0, 0);
  statics.load_steps = 2;
  expect("large deflections", statics, 0, 0, 1);
}
