// A rotor on a turning base: what its bearings carry in a steady curve, in closed form. The deck is
// examples/13_manoeuvre.
#include "../app/deck_run.hpp"
#include "record.hpp"
#include <gtest/gtest.h>
#include <cmath>
#include <fstream>
#include <sstream>

#include <io/value.hpp>

TEST(Manoeuvre, BearingsCarryGyroscopicCoupleAndCentrifugalForce) {
  whirl::test::Record record(
      "Manoeuvre: bearing forces in a steady turn",
      "gyroscopic couple Ip spin rate, centrifugal force m R rate^2, weight");
  std::ostringstream deck;
  deck << std::ifstream(WHIRL_SOURCE "/examples/13_manoeuvre/deck.toml").rdbuf();
  const whirl::test::DeckRun r(deck.str());
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_FALSE(r.says("warning")) << r.log;
  const double pi = std::acos(-1.0), rho = 7850, g = 9.80665, span = 0.48, spin = 9000 * pi / 30,
               rate = pi / 3, R = 12;
  struct Cylinder {
    double length, od, id;
  };
  double mass = 0, Ip = 0;
  for (const Cylinder c : {Cylinder{0.12, 0.06, 0}, {0.48, 0.07, 0}, {0.045, 0.32, 0.07}}) {
    const double m = rho * c.length * pi / 4 * (c.od * c.od - c.id * c.id);
    mass += m;
    Ip += m * (c.od * c.od + c.id * c.id) / 8;
  }
  // The last 0.1 s before the shock: 15 turns. The spin in space is that of the drive, about an
  // axis square to the turning.
  const auto mean = r.csv("manoeuvre.csv").means(0.8, 0.9);
  const double couple = Ip * spin * rate / span, weight = mass * g / 2,
               centrifugal = mass * rate * rate * R / 2;
  // 1e-4 of the largest: the accuracy asked for, and the sag and bow of the shaft, a few
  // micrometres of 12 m and 0.48 m
  const double allowed = 1e-4 * couple;
  record.check("drive end, vertical", "N", mean.at("bearing DE force.z [N]"), weight + couple,
               allowed);
  record.check("other end, vertical", "N", mean.at("bearing NDE force.z [N]"), weight - couple,
               allowed);
  record.check("drive end, outwards", "N", mean.at("bearing DE force.y [N]"), -centrifugal,
               allowed);
  record.check("other end, outwards", "N", mean.at("bearing NDE force.y [N]"), -centrifugal,
               allowed);
  // Work of the turning and of the shock is in the balance.
  const whirl::io::Value step =
      whirl::tests::read_json(r.folder / "r/summary.json").at("steps").at("manoeuvre");
  EXPECT_LT(step.at("accuracy").at("energy defect / energy turned over").number(), 1e-3);
}
