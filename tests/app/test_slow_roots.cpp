// Roots far slower than the whirl of the machine: what a free spin, a controller's integrator and the
// drag of a film leave beside zero. A list is complete with them, or says that it is not.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

using whirl::test::DeckRun;

namespace {

struct Variation {
  double integral, proportional, mass, force, stiffness, speed;
};

/// Two spools, an intershaft bearing, and a magnetic bearing whose integrator decays within seconds to
/// minutes, beside two spins that nothing holds.
std::string two_spools(const Variation& v) {
  return fmt::format(R"D(format=1
[output]
report=false
[model]
gravity="0 m/s^2"
mesh={{accuracy=0.01}}
[[shaft]]
name="inner"
material="inconel_718"
damping={{rayleigh_alpha="3 1/s",external_beta="1e-05 s"}}
columns=["name","length[mm]","od_l[mm]","od_r[mm]","id_l[mm]","id_r[mm]"]
rows=[["i0",100,40,40,0,0],["i1",60,80,80,0,0],["i2",150,80,80,32,32],["i3",100,30,30,0,0]]
[[disk]]
at="inner/59 mm"
mass="3 kg"
Ip="0.02 kg.m^2"
Id="0.011 kg.m^2"
offset=["0 mm","0.01 mm","0.01 mm"]
[[shaft]]
name="outer"
material="steel"
axial_force="{force} N"
columns=["name","length[mm]","od_l[mm]","od_r[mm]","id_l[mm]","id_r[mm]"]
rows=[["o0",100,120,120,100,100],["o1",150,120,120,100,100],["o2",300,120,120,100,100]]
[[disk]]
at="outer/62 mm"
mass="{mass} kg"
Ip="0.02 kg.m^2"
[[bearing]]
at="inner/23 mm"
type="linear"
kyy="{stiffness} N/m"
kzz="3e7 N/m"
cyy="2e4 N.s/m"
czz="3e4 N.s/m"
[[bearing]]
at="inner/340 mm"
type="ball"
balls=9
ball_diameter="12 mm"
pitch_diameter="65 mm"
contact_angle="15 deg"
preload="400 N"
support={{mass="6 kg",kyy="5e7 N/m",kzz="9e7 N/m",cyy="500 N.s/m",czz="500 N.s/m",kxx="1e8 N/m"}}
[[bearing]]
at="outer/26 mm"
type="magnetic"
current_stiffness="200 N/A"
position_stiffness="1e6 N/m"
amplifier_bandwidth="2500 Hz"
angle="45 deg"
delay="40 us"
[[bearing.control]]
type="pid"
p="{proportional} A/m"
i="{integral} A/(m.s)"
d="60 A.s/m"
lag="30 us"
[[bearing]]
at="outer/533 mm"
type="nonlinear_spring"
direction="radial"
shape="polynomial"
coefficients=["0 N","6e6 N/m","0 N/m^2","1e13 N/m^3"]
damping="2000 N.s/m"
[[bearing]]
at="outer/275 mm"
type="linear"
kxx="1e8 N/m"
cxx="1000 N.s/m"
[[load]]
at="inner/164 mm"
force=["100 N","-200 N","150 N"]
moment=["0 N.m","20 N.m","-10 N.m"]
[[bearing]]
at="inner/164 mm"
to="outer/164 mm"
type="linear"
kyy="5e7 N/m"
kzz="5e7 N/m"
cyy="1000 N.s/m"
czz="1000 N.s/m"
[[step]]
name="m"
type="modal"
speed="{speed} rpm"
modes=8
)D",
                     fmt::arg("integral", v.integral), fmt::arg("proportional", v.proportional),
                     fmt::arg("mass", v.mass), fmt::arg("force", v.force),
                     fmt::arg("stiffness", v.stiffness), fmt::arg("speed", v.speed));
}

/// Rates of the real roots between zero and the slowest of 1 per second, and how many are free.
struct SlowRoots {
  int free = 0;
  std::vector<double> rates;
  explicit SlowRoots(const DeckRun& d) {
    const auto t = d.csv("m_real_roots.csv");
    for (const auto& row : t.rows) {
      const double rate = row[t.column("rate [1/s]")];
      if (rate == 0.0)
        ++free;
      else if (std::abs(rate) < 1.0)
        rates.push_back(rate);
    }
  }
};

}  // namespace

// Of 400 such machines 16 were INCOMPLETE, or could not be counted: Krylov vectors of the double zeros
// came mixed with the integrator's, which the purification of free motions made larger, not smaller; the
// second of two integrators at nearly one rate went for a copy of the first, for both drive the free
// spins; and it stood for a companion of these.
TEST(SlowRoots, IntegratorsBesideFreeSpinsAreInEveryList) {
  std::mt19937 random(7);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 5) / 134217728.0;
  };
  for (int machine = 0; machine < 40; ++machine) {
    Variation v{};
    v.integral = std::pow(10.0, between(3.0, 6.5));
    v.proportional = std::pow(10.0, between(4.0, 4.7));
    v.mass = std::pow(10.0, between(0.5, 2.0));
    v.force = between(-3000.0, 3000.0);
    v.stiffness = std::pow(10.0, between(6.0, 8.5));
    v.speed = std::vector<double>{0, 300, 1000, 3000, 9000}[random() % 5];
    const DeckRun d(two_spools(v));
    SCOPED_TRACE(machine);
    EXPECT_EQ(d.exit, 0) << d.log;
    EXPECT_TRUE(d.says(", complete")) << d.log;
    EXPECT_EQ(SlowRoots(d).free, 2);
  }
}

// The integrator of each axis of the bearing moves what the springs leave of its stiffness: quasi-static,
// rate = -ki i / (ki p - ks + k) with the stiffness k of the rotor against the bearing's node. Both axes
// have their own; doubling the integral gain doubles the rates.
TEST(SlowRoots, BothAxesOfAnIntegratorAreListed) {
  Variation v{2000.0, 2e4, 30.0, -500.0, 2e7, 3000.0};
  const SlowRoots once(DeckRun(two_spools(v)));
  v.integral *= 2.0;
  const SlowRoots twice(DeckRun(two_spools(v)));
  ASSERT_EQ(once.rates.size(), 2u);
  ASSERT_EQ(twice.rates.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(twice.rates[k] / once.rates[k], 2.0, 1e-3);
}
