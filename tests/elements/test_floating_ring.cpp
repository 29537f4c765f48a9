// Floating rings: conformance, the concentric speed ratio, the ring in balance, heat and growth,
// coefficients two ways.
#include "conformance.hpp"
#include <elements/films/floating_ring.hpp>
#include <elements/films/tilting_pad.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

// Case of a concentric ring: ring/shaft = 1/(1 + (mu_o/mu_i)(L_o/L_i)(R_o/R_i)^3 (c_i/c_o)).
constexpr double ratio = 0.15608709;
constexpr double Omega = 9000;

template <class Film>
Film make_film(double R, double L, double c, double mu);
template <>
ShortJournal make_film(double R, double L, double c, double mu) {
  return {R, L, c, mu};
}
template <>
FiniteJournal make_film(double R, double L, double c, double mu) {
  FiniteJournal f;
  f.radius = R;
  f.length = L;
  f.viscosity = mu;
  f.surface = std::make_shared<JournalSurface>(c, 0.0, std::vector<JournalPad>{}, 72);
  return f;
}

template <class Film>
FloatingRing<Film> make_ring() {
  FloatingRing<Film> r;
  r.inner = {make_film<Film>(4e-3, 5e-3, 18e-6, 6e-3), 4e-3, 5e-3, 18e-6, 6e-3};
  r.outer = {make_film<Film>(6.5e-3, 7e-3, 40e-6, 12e-3), 6.5e-3, 7e-3, 40e-6, 12e-3};
  r.mass = 4e-3;
  r.inertia = 1.2e-7;
  r.supply = {3e5, 850, 6.5e-3 * 6.5e-3 - 4.018e-3 * 4.018e-3};
  return r;
}

template <class Film>
FloatingRing<Film> make_hot_ring() {
  FloatingRing<Film> r = make_ring<Film>();
  r.heat.oil = OilViscosity(32, 850);
  r.heat.supply_temperature = 363.15;
  r.inner.viscosity = r.outer.viscosity = r.heat.oil.at(363.15);
  r.inner.film.viscosity = r.outer.film.viscosity = r.inner.viscosity;
  r.heat.specific_heat = 2000;
  r.heat.share = 0.8;
  r.heat.capacity = 0.7;
  r.heat.conductance = 1.5;
  r.heat.shaft = 11e-6;
  r.heat.ring = 18e-6;
  r.heat.housing = 10.5e-6;
  return r;
}

/// A ring with its nodes: journal, housing, scalars.
template <class Joint>
struct Standing {
  Joint joint;
  Mat3 axes = Mat3::Identity();
  std::array<system::NodeState, Joint::n_nodes> x;
  system::Context context;

  explicit Standing(const Joint& j) : joint(j) {
    for (auto& s : x) {
      s.chart = &axes;
      s.u = s.du = s.ddu = s.t = s.dd = s.ddd = Vec3::Zero();
    }
    x[0].dphi = Omega;
  }
  Standing(const Standing&) = delete;
  typename Joint::Nodes nodes() const {
    typename Joint::Nodes out;
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] = &x[k];
    return out;
  }
  /// With the ring in balance.
  void settle(const Vec2& journal) {
    x[0].u.template tail<2>() = journal;
    std::array<double, Joint::own> q;
    for (std::size_t k = 0; k < q.size(); ++k)
      q[k] = x[2 + k].u.x();
    joint.relax(nodes(), context, q);
    for (std::size_t k = 0; k < q.size(); ++k)
      x[2 + k].u.x() = q[k];
  }
  system::ForceX<Joint::size> force() const {
    system::ForceX<Joint::size> f = system::ForceX<Joint::size>::Zero();
    joint.add_force(nodes(), context, f);
    return f;
  }
  RingStanding standing() const { return joint.standing(nodes(), context); }
};

/// The joint as the suite of conformance can judge its power: rows of the spin and of temperatures
/// are no forces on the rates of their unknowns. The row of the spin is I s' - T, over a length, and
/// gives s (I s' - T) to the ring.
template <class Joint>
struct Powered : Joint {
  void add_energy(const typename Joint::Nodes& x, const system::Context& c,
                  system::Energy& e) const {
    Joint::add_energy(x, c, e);
    system::ForceX<Joint::size> f = system::ForceX<Joint::size>::Zero();
    Joint::add_force(x, c, f);
    const double spin = this->ring.spin_unit() * x[4]->u.x();
    e.supplied += spin * f[28] / this->ring.spin_row();
  }
};

template <class Film, bool Heat>
void conform(FloatingRing<Film> ring) {
  const double c = 18e-6;
  ring.stiffness = 2e5;
  ring.damping = 30;
  ConformanceOptions o = film_options(c, Omega, 5e-3);
  o.gravity = Vec3(0.0, -2.0, -9.0);  // scalars, which do not fall, move along x
  o.samples = 4;
  o.signals = {4};
  if (Heat) o.signals = {4, 5, 6};
  const std::size_t nodes = Heat ? 7 : 5;
  o.q0.assign(6 * nodes, 0.0);
  o.v0.assign(6 * nodes, 0.0);
  o.q0[1] = 0.5 * c;
  o.q0[2] = -0.9 * c;
  o.v0[3] = Omega;
  o.v0[9] = 30;
  o.q0[12] = 0.2 * c;
  o.q0[18] = -0.5 * c;
  o.q0[24] = 1400 / ring.spin_unit();
  if (Heat) {
    o.q0[30] = 45 / ring.temperature_unit();
    o.q0[36] = 20 / ring.temperature_unit();
  }
  using Joint = FloatingRingJoint<Film, Heat, false>;
  using Apart = FloatingRingJoint<Film, Heat, true>;
  check_kernel(Powered<Joint>{{ring}}, o);
  check_kernel(Powered<Apart>{{ring, {1e-6, 2e-6}}}, o);
}

}  // namespace

TEST(FloatingRing, Conformance) { conform<ShortJournal, false>(make_ring<ShortJournal>()); }
TEST(FloatingRing, ConformanceWithHeat) {
  conform<ShortJournal, true>(make_hot_ring<ShortJournal>());
}
TEST(FloatingRing, ConformanceFinite) { conform<FiniteJournal, false>(make_ring<FiniteJournal>()); }
TEST(FloatingRing, ConformanceFiniteWithHeat) {
  conform<FiniteJournal, true>(make_hot_ring<FiniteJournal>());
}

TEST(FloatingRing, ConcentricSpeedRatio) {
  Standing<FloatingRingJoint<ShortJournal, false>> s({make_ring<ShortJournal>()});
  s.settle(Vec2::Zero());
  EXPECT_NEAR(s.standing().spin / Omega, ratio, 1e-8);
  EXPECT_NEAR(s.joint.ring.centred_spin(Omega, 0) / Omega, ratio, 1e-8);
  Standing<FloatingRingJoint<FiniteJournal, false>> f({make_ring<FiniteJournal>()});
  f.settle(Vec2::Zero());
  EXPECT_NEAR(f.standing().spin / Omega, ratio, 1e-8);
  // what the shaft is braked with, times its speed, is what both films turn into heat
  const RingStanding now = s.standing();
  EXPECT_NEAR(s.force()[6] * Omega, now.inner.power + now.outer.power, 1e-9 * now.inner.power);
  EXPECT_NEAR(now.torque, 0.0, 1e-12 * s.force()[6]);
}

// A pinned ring stays, and what holds it is the torque of its films.
TEST(FloatingRing, Pinned) {
  FloatingRing<ShortJournal> ring = make_ring<ShortJournal>();
  ring.pinned = true;
  ring.stiffness = 1e6;
  Standing<FloatingRingJoint<ShortJournal, false>> s({ring});
  s.settle(Vec2(3e-6, -5e-6));
  const RingStanding now = s.standing();
  EXPECT_EQ(now.spin, 0.0);
  EXPECT_LT((now.outer.place - now.inner.force / 1e6).norm(), 1e-15);
  EXPECT_NEAR(now.torque, s.force()[28] / -ring.spin_row(), 1e-12 * now.torque);
  EXPECT_GT(now.torque, 0.0);
}

// Anywhere in both clearances the ring finds its place: forces and drag balance, with its weight.
TEST(FloatingRing, Settles) {
  Random random(5);
  const FloatingRing<ShortJournal> ring = make_ring<ShortJournal>();
  for (int k = 0; k < 60; ++k) {
    Standing<FloatingRingJoint<ShortJournal, false>> s({ring});
    s.context.gravity = Vec3(0, 0, -9.81);
    const double reach = 52e-6 * (k + 0.5) / 60;
    s.settle(reach * random.direction<3>().tail<2>().normalized());
    const RingStanding now = s.standing();
    const Vec2 left = now.inner.force - now.outer.force + Vec2(0, -9.81 * ring.mass);
    EXPECT_LT(left.norm(), 1e-8 * (now.inner.force.norm() + 0.04)) << reach;
    EXPECT_NEAR(now.torque, 0, 1e-9 * s.force()[6]);
    EXPECT_GT(now.spin, 0);
  }
}

// The balance of heat, term by term, and clearances as the parts have grown.
TEST(FloatingRing, Heat) {
  const FloatingRing<ShortJournal> ring = make_hot_ring<ShortJournal>();
  Standing<FloatingRingJoint<ShortJournal, true>> s({ring});
  s.settle(Vec2(4e-6, -6e-6));
  const RingStanding now = s.standing();
  const double Ti = now.inner.temperature, To = now.outer.temperature;
  EXPECT_GT(Ti, To);
  EXPECT_GT(To, 363.15);
  EXPECT_NEAR(now.inner.viscosity, iso_vg_viscosity(32, Ti, 850), 1e-14);
  EXPECT_NEAR(now.outer.viscosity, iso_vg_viscosity(32, To, 850), 1e-14);
  const double Tr = 0.5 * (Ti + To);
  EXPECT_NEAR(now.inner.clearance, 18e-6 + 4e-3 * (18e-6 * (Tr - 293.15) - 11e-6 * (Ti - 293.15)),
              1e-15);
  EXPECT_NEAR(now.outer.clearance,
              40e-6 + 6.5e-3 * (10.5e-6 * (To - 293.15) - 18e-6 * (Tr - 293.15)), 1e-15);
  const double feed = 3e5 - 0.5 * 850 * now.spin * now.spin * ring.supply.lever;
  EXPECT_NEAR(now.feed_pressure, feed, 1e-6);
  for (const bool inner : {true, false}) {
    const RingFilmStanding& f = inner ? now.inner : now.outer;
    const double R = inner ? 4e-3 : 6.5e-3, L = inner ? 5e-3 : 7e-3;
    const double c = f.clearance, e = f.eccentricity;
    const double driven = pi * R * c * c * c * (inner ? feed : 3e5) / (3 * f.viscosity * L) *
                          (1 + 1.5 * e * e),
                 dragged = (inner ? Omega + now.spin : now.spin) * R * L * c * e;
    EXPECT_NEAR(f.flow, driven + dragged, 1e-3 * f.flow);
    EXPECT_NEAR(0.8 * f.power,
                850 * 2000 * f.flow * (f.temperature - 363.15) + 1.5 * (inner ? Ti - To : To - Ti),
                1e-9 * f.power);
  }
  // the power of the films by the theory of short bearings: shear and the work of the load
  const double mean = 0.5 * (Omega + now.spin), slip = Omega - now.spin;
  const double q = std::sqrt(1 - now.inner.eccentricity * now.inner.eccentricity);
  const double shear = two_pi * now.inner.viscosity * std::pow(4e-3, 3) * 5e-3 * slip * slip /
                       (now.inner.clearance * q);
  const double work = mean * (-now.inner.place.x() * now.inner.force.y() +
                              now.inner.place.y() * now.inner.force.x());
  EXPECT_NEAR(now.inner.power, shear + work, 1e-9 * shear);
}

// A film at another clearance is the film made for it.
TEST(FloatingRing, ScaledFilms) {
  const auto scaled = make_film<FiniteJournal>(4e-3, 5e-3, 18e-6, 6e-3),
             made = make_film<FiniteJournal>(4e-3, 5e-3, 13e-6, 9e-3);
  const FilmPoint p{Vec2(4e-6, -8e-6), Vec2(0.02, 0.05), 5000};
  FilmForce a, b;
  ScaledFilm<FiniteJournal>{&scaled, 1.5, 13.0 / 18.0}.evaluate(p, a);
  made.evaluate(p, b);
  EXPECT_LT((a.F - b.F).norm(), 1e-12 * b.F.norm());
  EXPECT_NEAR(a.T, b.T, 1e-12 * std::abs(b.T));
}

// Stiffness with the ring following, w -> 0: against differences of forces with the ring in balance.
TEST(FloatingRing, ReducedCoefficientsTwoWays) {
  using Joint = FloatingRingJoint<ShortJournal, true>;
  Standing<Joint> s({make_hot_ring<ShortJournal>()});
  const Vec2 r(5e-6, -12e-6);
  s.settle(r);
  system::TangentX<Joint::size> t;
  t.set_zero();
  s.joint.add_tangent(s.nodes(), s.context, t);
  PadCoefficients full{MatX::Zero(7, 7), MatX::Zero(7, 7), MatX::Zero(7, 7)};
  const std::array<Index, 7> from{1, 2, 14, 21, 28, 35, 42};
  for (Index i = 0; i < 7; ++i)
    for (Index j = 0; j < 7; ++j) {
      full.K(i, j) = t.K(from[static_cast<std::size_t>(i)], from[static_cast<std::size_t>(j)]);
      full.C(i, j) = t.C(from[static_cast<std::size_t>(i)], from[static_cast<std::size_t>(j)]);
      full.M(i, j) = t.M(from[static_cast<std::size_t>(i)], from[static_cast<std::size_t>(j)]);
    }
  const Mat2 K = reduce_pads(full, 0.0).K;
  const double h = 2e-8;
  for (Index j = 0; j < 2; ++j) {
    const auto at = [&](double x) {
      s.settle(r + x * Vec2::Unit(j));
      return Vec2(s.force().segment<2>(1));
    };
    const Vec2 slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    EXPECT_LT((K.col(j) - slope).norm(), 1e-6 * K.norm()) << j;
  }
}
