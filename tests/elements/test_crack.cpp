// Breathing cracks and thermal bows: conformance, the laws of opening, compliance in series on any
// mesh, and what fracture mechanics says of a depth.
#include "conformance.hpp"
#include <Eigen/Eigenvalues>
#include <elements/shaft/crack.hpp>
#include <elements/shaft/crack_compliance.hpp>
#include <elements/shaft/thermal_bow.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <system/system.hpp>
#include <elements/shaft/shaft_beam.hpp>

#include <Eigen/LU>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

constexpr double length = 0.4, EI = 120;

ShaftElementConstants uniform(double l) {
  ElementSection s;
  s.constants = true;
  s.given = {4e4, 3e4, 90, EI, 2, 1e-3, 2e-3};
  return make_shaft_constants(s, l);
}

/// At x of the length of an element with end offsets.
Crack crack(Breathing breathing, double x, bool series = true) {
  const ShaftElementConstants c = uniform(length);
  Crack k;
  k.at = {length, 0.03, -0.02, EndAxes::normal_at(0.6)};
  k.place = x;
  k.r = -(1.0 - x) * Vec2(c.k11, c.k12) + x * Vec2(c.k12, c.k22);
  k.law.breathing = breathing;
  k.law.c_xi = 4e-4;
  k.law.c_eta = breathing == Breathing::hinge ? 0.0 : 1e-4;
  k.law.g = series ? (x < 0.5 ? c.k11 : c.k22) : 0.0;
  k.law.small = 1e-9;
  k.toward = Vec3(0, 0.6, -0.8);
  return k;
}

ConformanceOptions options() {
  ConformanceOptions o;
  o.symmetric_K = true;
  o.tilt = 0.15;
  o.phi = 1.0;
  o.u = 0.03;
  // both nodes turned alike, the ends bent against each other: away from moment zero, where the law
  // that follows the moment has a corner
  o.q0 = {0, 0, 0, 0.4, 0.2, -0.4, 0, 0, 0, 0.4, -0.3, 0.35};
  o.position = {Vec3::Zero(), Vec3(length + 0.03 + 0.02, 0, 0)};
  return o;
}

CrackLaw law(Breathing breathing, double g) {
  CrackLaw k;
  k.breathing = breathing;
  k.c_xi = 2e-3;
  k.c_eta = 0.5e-3;
  k.g = g;
  k.small = 1e-12;
  return k;
}

}  // namespace

void check_breathing(Breathing breathing) {
  ConformanceOptions o = options();
  o.objective = true;
  for (const double x : {0.0, 0.21, 1.0})
    check_kernel(crack(breathing, x, x != 0.21), o);
  o.chart = tilted_chart();
  o.objective = false;
  check_kernel(crack(breathing, 0.0), o);
}

TEST(Crack, OpenConformance) { check_breathing(Breathing::open); }

TEST(Crack, HingeConformance) { check_breathing(Breathing::hinge); }

TEST(Crack, ResponseConformance) { check_breathing(Breathing::response); }

TEST(Crack, WeightConformance) {
  for (const double x : {0.0, 0.79, 1.0})
    check_kernel(crack(Breathing::weight, x, x != 0.79), options());
}

namespace {

/// V = -kink.M, whatever the law.
struct CrackOfGivenKink : Crack {
  std::vector<Vec2> kinks;
  system::Context given(system::Context c) const {
    c.kinks = kinks;
    return c;
  }
  void add_force(const system::Nodes<2>& x, const system::Context& c, system::ForceX<14>& f) const {
    Crack::add_force(x, given(c), f);
  }
  void add_tangent(const system::Nodes<2>& x, const system::Context& c,
                   system::TangentX<14>& t) const {
    Crack::add_tangent(x, given(c), t);
  }
  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const {
    e.elastic -= kinks[number].dot(moment(x, c));
  }
};

}  // namespace

TEST(Crack, OfGivenKinkConformance) {
  ConformanceOptions o = options();
  o.objective = true;
  CrackOfGivenKink k;
  static_cast<Crack&>(k) = crack(Breathing::response, 1.0);
  k.number = 1;
  k.kinks = {Vec2::Zero(), Vec2(0.02, -0.013)};
  check_kernel(k, o);
}

// In series: m + g dW/dm = M, and 1/h = 1/(d2W/dm2) + g.
TEST(Crack, ItsKinkIsThatOfTheMomentsThatAreLeft) {
  const double g = 900;
  for (const Breathing b :
       {Breathing::open, Breathing::weight, Breathing::hinge, Breathing::response})
    for (const Vec2& M : {Vec2(2, 1), Vec2(0.3, -2), Vec2(-1, 0.4)}) {
      CrackLaw k = law(b, g);
      if (b == Breathing::hinge) k.c_eta = 0;
      const double cosine = 0.3;
      const CrackLaw::Answer a = k.at(M[0], M[1], cosine);
      const Vec2 kink = -a.slope.head<2>(), m = M - g * kink;
      k.g = 0;
      const auto [angle, slope] = Crack::KinkLaw{k, cosine}(m);
      EXPECT_LT((angle - kink).norm(), 1e-9 * (kink.norm() + 1e-6));
      const Mat2 h = slope * (Mat2::Identity() + g * slope).inverse();
      EXPECT_LT((h + a.curvature.topLeftCorner<2, 2>()).norm(), 1e-9 * (h.norm() + 1e-6));
    }
}

TEST(Crack, OfABowedShaftConformance) {
  Crack k = crack(Breathing::response, 1.0);
  k.rest1 = Vec2(0.05, -0.02);
  k.rest2 = Vec2(-0.04, 0.06);
  k.bow = {0.3, 1.2, 0.9};
  ConformanceOptions o = options();
  check_kernel(k, o);
}

TEST(ThermalBow, Conformance) {
  ThermalBow b;
  b.at = {length, 0.03, -0.02, EndAxes::normal_at(-0.8)};
  b.s1 = Vec2(3, -1);
  b.s2 = Vec2(-2, 1.5);
  b.square = 0.7;
  b.growth = {0.2, 1.0, 0.8};
  ConformanceOptions o = options();
  o.objective = true;
  check_kernel(b, o);
}

TEST(ThermalBow, GrowsByItsTimeConstant) {
  const Growth grows{0.0, 2.0, 10.0}, there{5.0, 2.0, 0.0};
  EXPECT_NEAR(grows.at(10.0), 2.0 * (1.0 - std::exp(-1.0)), 1e-15);
  EXPECT_NEAR(grows.rate(10.0), 0.2 * std::exp(-1.0), 1e-16);
  EXPECT_EQ(there.at(0.0), 2.0);
  EXPECT_EQ(there.rate(0.0), 0.0);
}

TEST(CrackLaw, OpensAsItSays) {
  for (const double g : {0.0, 3e3}) {
    const CrackLaw mayes = law(Breathing::weight, g);
    EXPECT_EQ(mayes.at(1, 2, 1.0).f, 1.0);
    EXPECT_EQ(mayes.at(1, 2, -1.0).f, 0.0);
    EXPECT_EQ(mayes.at(1, 2, -1.0).V, 0.0);
    EXPECT_EQ(mayes.at(1, 2, 0.0).f, 0.5);
    const CrackLaw hinge = law(Breathing::hinge, g);
    EXPECT_EQ(hinge.at(-1, 2, 0.3).V, 0.0);
    // in series: c/(1 + c g)
    EXPECT_NEAR(hinge.at(5, 2, 0.3).slope[0], -5 * 2e-3 / (1 + 2e-3 * g), 1e-16);
    const CrackLaw response = law(Breathing::response, g), open = law(Breathing::open, g);
    // open: as the open crack, also against small moments across; closed: nothing
    EXPECT_NEAR(response.at(5, 0, 0).V, open.at(5, 0, 0).V, 1e-13);
    EXPECT_NEAR(response.at(5, 0, 0).curvature(1, 1), open.at(5, 0, 0).curvature(1, 1), 1e-15);
    EXPECT_NEAR(response.at(-5, 0, 0).V, 0.0, 1e-15);
    EXPECT_NEAR(response.at(0, 5, 0).f, g == 0.0 ? 0.5 : response.at(0, 5, 0).f, 1e-12);
  }
}

TEST(CrackLaw, ResponseIsConvexInSeries) {
  // its energy beside that of the element never makes the element unstable: 1/g - curvature of -V > 0
  const double g = 3e3;
  const CrackLaw k = law(Breathing::response, g);
  for (int i = 0; i < 720; ++i) {
    const double x = i * pi / 360;
    const Mat2 bend = k.at(7 * std::cos(x), 7 * std::sin(x), 0).curvature.topLeftCorner<2, 2>();
    const Eigen::SelfAdjointEigenSolver<Mat2> e(bend);
    EXPECT_GT(e.eigenvalues()[0], -1.0 / g) << x;
    EXPECT_LE(e.eigenvalues()[1], 1e-12 / g) << x;
  }
}

TEST(CrackCompliance, AgreesWithPublishedTable) {
  // C. A. Papadopoulos, Mech. Syst. Signal Process. 22 (2008) 763, as tabulated in ROSS: c55 and c44
  // (over half the edge) times E R^3/(1 - nu^2), six digits
  struct Row {
    double ratio, c55, c44;
  };
  for (const Row& r :
       {Row{0.1, 0.0277722, 0.000425851}, Row{0.2, 0.144614, 0.00474954},
        Row{0.3, 0.372215, 0.019617}, Row{0.5, 1.22153, 0.12323}, Row{0.8, 3.97355, 0.827564}}) {
    const double R = 0.025, E = 2e11, nu = 0.3, unit = (1 - nu * nu) / (E * R * R * R);
    const CrackCompliance c = crack_compliance(r.ratio * R, R, E, nu);
    EXPECT_NEAR(c.xi / unit, r.c55, 5e-6 * r.c55) << r.ratio;
    EXPECT_NEAR(c.eta / unit, 2 * r.c44, 1e-5 * 2 * r.c44) << r.ratio;
  }
}
