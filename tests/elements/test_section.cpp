#include <elements/shaft/section.hpp>
#include <gtest/gtest.h>
#include <cmath>

using namespace whirl;
using namespace whirl::elements;

namespace {

TEST(Section, AnnulusMatchesThePowerForms) {
  const double D = 0.11, d = 0.07;
  EXPECT_NEAR(annulus_area(D, d), pi / 4 * (D * D - d * d), 1e-17);
  EXPECT_NEAR(annulus_I(D, d), pi / 64 * (std::pow(D, 4) - std::pow(d, 4)), 1e-20);
  EXPECT_NEAR(annulus_J(D, d), pi / 32 * (std::pow(D, 4) - std::pow(d, 4)), 1e-20);
}

TEST(Section, ThinWallKeepsItsDigits) {
  const double D = 1.0, t = 1e-12,
               d = D - 2 * t;  // wall of a picometre: J = pi D^3 t / 4 to relative 3 t/D
  EXPECT_NEAR(annulus_J(D, d) / (pi * (D - d) / 8), 1.0, 1e-11);
}

TEST(Section, ShearFactorsOfSolidAndThinCircles) {
  for (double nu : {0.0, 0.25, 0.3, 0.5}) {
    EXPECT_NEAR(cowper_factor(0, nu), 6 * (1 + nu) / (7 + 6 * nu), 1e-15);
    EXPECT_NEAR(cowper_factor(1, nu), 2 * (1 + nu) / (4 + 3 * nu), 1e-15);  // thin tube, same paper
    EXPECT_NEAR(hutchinson_factor(0, nu), 6 * (1 + nu) * (1 + nu) / (7 + 12 * nu + 4 * nu * nu),
                1e-15);
    EXPECT_NEAR(hutchinson_factor(1, nu), (1 + nu) / (2 + nu), 1e-15);  // thin tube, same paper
  }
  EXPECT_NEAR(cowper_factor(0, 0.3), 0.886, 5e-4);
}

// K1 benchmark tube: r 50/45 mm, E 210 GPa, nu 0.3, rho 7800; the case states its section
// constants.
TEST(Section, BenchmarkTube) {
  ElementSection s;
  s.od1 = s.od2 = s.mass_od1 = s.mass_od2 = 0.1;
  s.id1 = s.id2 = s.mass_id1 = s.mass_id2 = 0.09;
  s.E = 210e9;
  s.G = 210e9 / 2.6;
  s.rho = 7800;
  const SectionProperties p = s.at(0.3);
  EXPECT_NEAR(p.EA, 313.4e6, 0.05e6);  // printed digits
  EXPECT_NEAR(p.EI, 354.5e3, 0.05e3);
  EXPECT_NEAR(p.GJ, 272.7e3, 0.05e3);
  EXPECT_NEAR(p.rhoA, 11.640, 5e-4);
  EXPECT_NEAR(p.rhoI, 13.17e-3, 5e-6);
  EXPECT_NEAR(p.rhoIp, 26.33e-3, 5e-6);
  EXPECT_TRUE(s.uniform());
}

TEST(Section, PartInterpolatesAndKeepsCylindersExact) {
  ElementSection s;
  s.od1 = 0.1;
  s.od2 = 0.2;
  s.id1 = s.id2 = 0.03;
  s.mass_od1 = 0.1;
  s.mass_od2 = 0.3;
  s.E = 2e11;
  s.G = 8e10;
  s.rho = 7800;
  const ElementSection p = s.part(0.25, 0.75);
  EXPECT_DOUBLE_EQ(p.od1, 0.125);
  EXPECT_DOUBLE_EQ(p.od2, 0.175);
  EXPECT_EQ(p.id1, 0.03);
  EXPECT_EQ(p.id2, 0.03);
  EXPECT_DOUBLE_EQ(p.mass_od1, 0.15);
  EXPECT_NEAR(p.at(0.5).EI, s.at(0.5).EI, 1e-12 * p.at(0.5).EI);
  EXPECT_NEAR(p.at(1).rhoA, s.at(0.75).rhoA, 1e-12 * p.at(1).rhoA);
}

TEST(Section, SwitchesOfTheBookBeams) {
  ElementSection s;
  s.od1 = s.od2 = s.mass_od1 = s.mass_od2 = 0.05;
  s.E = 2e11;
  s.G = 8e10;
  s.rho = 7800;
  s.shear = ShearRule::rigid;
  s.rotary_inertia = false;
  s.added_mass = 2.5;
  const SectionProperties p = s.at(0.5);
  EXPECT_TRUE(std::isinf(p.kGA));
  EXPECT_EQ(p.rhoI, 0.0);
  EXPECT_GT(p.rhoIp, 0.0);
  EXPECT_NEAR(p.rhoA, 7800 * pi / 4 * 0.0025 + 2.5, 1e-12);
}

}  // namespace
