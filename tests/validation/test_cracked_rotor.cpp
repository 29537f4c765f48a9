// Cracked and bowed shafts, from decks: the periodic motion of a Jeffcott rotor with a breathing crack
// (the two-degree-of-freedom rotor, by shooting to 1e-10), compliance in series,
// laws that follow the bending, and the bow response of Nicholas, Gunter and Allaire.
#include <analysis/response/unbalance.hpp>
#include <analysis/spectra/instability_bands.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include <elements/shaft/crack_compliance.hpp>
#include <system/problem.hpp>

#include "deck_model.hpp"
#include "record.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using test::DeckModel;

namespace {

constexpr double mass = 20, k = 2e6, c = 126.4911064, omega_n = 316.22776601683796;

/// A disk in the middle of a massless Euler shaft of 1 m on rigid supports: 48 EI/L^3 = 2e6 N/m.
std::string jeffcott(const std::string& rest, const std::string& of_shaft = "") {
  const std::string section =
      "length = \"500 mm\"\nmin_elements = 1\n[shaft.section.constants]\n"
      "EA = \"4e8 N\"\nGJ = \"1e5 N.m^2\"\nEI = \"41666.666666666664 "
      "N.m^2\"\nkGA = \"1e15 N\"\nrhoA = \"0 kg/m\"\nrhoI = \"0 kg.m\"\nrhoIp = \"0 kg.m\"\n";
  return "format = 1\n[model]\ngravity = \"9.80665 m/s^2\"\n[shaft]\nname = \"s\"\n" + of_shaft +
         "\n[[shaft.section]]\nname = \"left\"\n" + section +
         "[[shaft.section]]\nname = \"right\"\n" + section +
         R"([[disk]]
name = "d"
at = "left:end"
mass = "20 kg"
Ip = "0.02 kg.m^2"
Id = "0.01 kg.m^2"
[[bearing]]
name = "DE"
at = "left:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "NDE"
at = "right:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
name = "air"
at = "d"
type = "linear"
cyy = "126.4911064 N.s/m"
czz = "126.4911064 N.s/m"
)" + rest;
}

/// Unbalance 0.3 rad ahead of the crack, whose normal points down at t = 0.
const std::string mayes = R"([[crack]]
name = "c"
at = "left:start"
to = "right:end"
loss = 0.1
phase = "270 deg"
[[unbalance]]
at = "d"
amount = "2e-4 kg.m"
phase = "287.1887338539247 deg"
)";

std::string at_speed(double Omega) {
  return fmt::format(
      "[[drive]]\nat = \"left:start\"\ntype = \"speed\"\nspeed = \"{:.17g} rad/s\"\n", Omega);
}

/// Terms of r = y + i z, um.
struct Orbit {
  double share;  ///< Omega/omega_n
  double mean_y, mean_z, r1, r2, r3, rm1, rm2, multiplier;
};
const Orbit orbits[] = {
    {1.0 / 3.0, 0.34723, -100.38674, 4.39652, 4.22172, 41.17156, 0.92633, 0.93644, 0.828204181},
    {0.5, 1.28064, -99.06179, 4.76632, 81.09635, 0.62591, 1.04339, 0.16348, 0.881911378},
    {0.9, 0.01118, -102.51915, 74.15552, 1.98754, 0.22856, 7.53312, 0.04023, 0.932568035},
    {1.1, 0.00628, -99.17050, 56.71212, 0.28749, 0.11157, 5.22612, 0.01724, 0.944480851}};

constexpr const char* orbit_source =
    "periodic solution of the two equations of the Jeffcott rotor with a breathing crack after "
    "Mayes "
    "and Davies (1984), by shooting to 1e-10";

/// The three nodes of the shaft at a spin.
void turn_all(system::State& s, double Omega) {
  for (Index i = 0; i < 3; ++i)
    s.v[6 * i + system::spin_phi] = Omega;
}

/// Place of the disk in balance.
Vec3 place(const DeckModel& m, double Omega, bool mean = true) {
  analysis::SteadyRotation running = m.running();
  running.mean = mean;
  analysis::SteadySystem steady(m.built.system, running);
  const auto e = analysis::EquilibriumSolver(steady).solve(Omega);
  return e.state.q.segment<3>(6 * m.disk());
}

}  // namespace

TEST(CrackedRotor, PeriodicOrbitsAgainstShooting) {
  test::Record record("Breathing crack: Fourier terms of the steady orbit", orbit_source);
  const DeckModel m(jeffcott(mayes));
  analysis::Linearizer linear(m.built.system, m.running());
  analysis::PeriodicResponse periodic(linear);
  for (const Orbit& o : orbits) {
    const analysis::PeriodicMotion x = periodic.solve(o.share * omega_n);
    ASSERT_TRUE(x.converged);
    EXPECT_LT(x.last_share, 1e-4);
    const auto amplitude = [&](std::size_t h) {
      return analysis::amplitude_at(linear, x.amplitude[h], {m.disk(), 0.0});
    };
    const VecX mean = linear.equilibrium().state.q + x.amplitude[0].real();
    const std::string at = fmt::format("{:.4g} of the critical speed, ", o.share);
    // the printed digits, and what is quadratic in tilts of 3e-4 rad, resonance included
    const auto near = [&](const std::string& what, double computed, double reference) {
      record.check(at + what, "um", 1e6 * computed, reference,
                   std::max(1e-5, 3e-6 * std::abs(reference)));
    };
    near("mean y", mean[6 * m.disk() + 1], o.mean_y);
    near("mean z", mean[6 * m.disk() + 2], o.mean_z);
    near("r1", std::abs(amplitude(1).forward()), o.r1);
    near("r2", std::abs(amplitude(2).forward()), o.r2);
    near("r3", std::abs(amplitude(3).forward()), o.r3);
    near("r-1", std::abs(amplitude(1).backward()), o.rm1);
    near("r-2", std::abs(amplitude(2).backward()), o.rm2);
  }
}

TEST(CrackedRotor, MultipliersAndBandAgainstFloquet) {
  test::Record record("Breathing crack: largest multiplier of a turn", orbit_source);
  const DeckModel m(jeffcott(mayes));
  analysis::Linearizer linear(m.built.system, m.running());
  analysis::RotatingAxes axes(linear, 1.1 * omega_n, {.most = 2});
  analysis::BandOptions o;
  o.modes = 2;  // translations: the disk tilts without damping
  for (const Orbit& x : orbits)
    o.speeds.push_back(x.share * omega_n);
  const analysis::BandResult r = analysis::find_bands(axes, o);
  for (const Orbit& x : orbits) {
    const double Omega = x.share * omega_n;
    const auto at = std::find_if(r.speeds.begin(), r.speeds.end(), [&](double speed) {
      return std::abs(speed - Omega) < 1e-9 * Omega;
    });
    ASSERT_NE(at, r.speeds.end());
    const double growth = r.growth[static_cast<std::size_t>(at - r.speeds.begin())];
    record.check(fmt::format("{:.4g} of the critical speed", x.share), "-",
                 std::exp(growth * two_pi / Omega), x.multiplier, 2e-9);
  }
  // found between 0.9 and 1.1, where the rotation takes the last stiffness
  ASSERT_EQ(r.bands.size(), 1u);
  EXPECT_NEAR(r.bands[0].speed, 0.98 * omega_n, 0.01 * omega_n);
  EXPECT_GT(r.bands[0].growth, 0.3);
}

TEST(CrackedRotor, TransientSettlesOnTheOrbit) {
  // 250 turns from the static place; what is left of the start is 3e-8. Terms over the last turn.
  const Orbit& o = orbits[2];
  const double Omega = o.share * omega_n, turn = two_pi / Omega, end = 250 * turn;
  const DeckModel m(jeffcott(mayes + at_speed(Omega)));
  system::SystemProblem problem(m.built.system);
  analysis::TransientOptions options;
  options.integrator.tolerance = 1e-6;
  options.integrator.t_end = end * (1 + 1e-9);
  system::State start = m.built.system.make_state();
  start.q[6 * m.disk() + 2] = -mass * 9.80665 / k;
  turn_all(start, Omega);
  struct Terms final : analysis::Observer {
    Index node = 0;
    double begin = 0, turn = 0;
    std::array<Complex, 3> sum{};  // 1, -1, 2
    std::size_t next = 0, samples = 64;
    void step(analysis::StepAccess& s) override {
      for (; next < samples; ++next) {
        const double n = static_cast<double>(samples), x = static_cast<double>(next) / n,
                     t = begin + turn * x;
        if (t > s.t1()) return;
        const Vec3 u = s.at(t).node(node).u;
        const Complex r(u.y(), u.z());
        for (std::size_t i = 0; i < 3; ++i)
          sum[i] += r * std::polar(1.0 / n, -two_pi * x * std::array{1.0, -1.0, 2.0}[i]);
      }
    }
  } terms;
  terms.node = m.disk();
  terms.begin = end - turn;
  terms.turn = turn;
  analysis::EnergyBalance energy;
  analysis::run_transient(problem, start, options, {&terms, &energy});
  EXPECT_EQ(terms.next, terms.samples);
  EXPECT_NEAR(1e6 * std::abs(terms.sum[0]), o.r1, 1e-3);
  EXPECT_NEAR(1e6 * std::abs(terms.sum[1]), o.rm1, 1e-3);
  EXPECT_NEAR(1e6 * std::abs(terms.sum[2]), o.r2, 1e-3);
  EXPECT_LT(energy.worst_defect(), 1e-5 * energy.exchanged());
}

TEST(CrackedRotor, EveryLawKeepsEnergy) {
  // undamped, spinning freely off its equilibrium: what breathing takes from the bending the spin
  // gives back
  for (const std::string law : {"mayes", "hinge", "response", "open"}) {
    const std::string across = law == "hinge" ? "" : "stiffness_across = \"1e6 N.m/rad\"\n";
    std::string deck = jeffcott(
        "[[crack]]\nname = \"c\"\nat = \"left:end\"\nstiffness = \"3e5 "
        "N.m/rad\"\n" +
        across + "breathing = \"" + law + "\"\nphase = \"200 deg\"\n");
    for (const char* damper : {"cyy = \"126.4911064 N.s/m\"", "czz = \"126.4911064 N.s/m\""})
      deck.replace(deck.find(damper), std::string(damper).size(),
                   std::string(1, damper[0]) + damper[1] + damper[2] + " = \"1e-9 N.s/m\"");
    const DeckModel m(deck);
    system::SystemProblem problem(m.built.system);
    analysis::TransientOptions options;
    options.method = "gauss6";
    options.integrator.tolerance = 1e-9;
    options.integrator.t_end = 0.2;
    system::State start = m.built.system.make_state();
    start.q[6 * m.disk() + 1] = 3e-4;
    turn_all(start, 150);
    analysis::EnergyBalance energy;
    analysis::run_transient(problem, start, options, {&energy});
    EXPECT_LT(energy.worst_defect(), 1e-7 * energy.exchanged()) << law;
  }
}

TEST(CrackedRotor, PointCrackIsAComplianceInSeries) {
  // deflection under the weight, the crack where the moment is M(x): + m(x)^2 c F; on any mesh
  const double F = mass * 9.80665, kc = 3e5;
  for (const double at : {0.5, 0.25})
    for (const int elements : {1, 2, 5}) {
      std::string deck = jeffcott(fmt::format(
          "[[crack]]\nname = \"c\"\nat = \"{} mm\"\nstiffness = \"3e5 N.m/rad\"\nbreathing = "
          "\"open\"\nphase = \"270 deg\"\n",
          1e3 * at));
      for (std::size_t p = 0; (p = deck.find("min_elements = 1", p)) != std::string::npos; ++p)
        deck.replace(p, 16, fmt::format("min_elements = {}", elements));
      const double lever = 0.5 * at;  // moment at the crack of a unit force in the middle
      EXPECT_NEAR(place(DeckModel(deck), 0.0, false).z(), -F / k - lever * lever * F / kc, 2e-11)
          << at << " " << elements;
    }
}

TEST(CrackedRotor, DepthTurnsIntoTheComplianceOfItsSection) {
  // 1 m of 50 mm, Euler: sag F L^3/(48 EI) + (L/4)^2 c F with the crack open (below), and no second
  // term with it closed (above)
  const auto deck = [](const std::string& breathing, const std::string& phase) {
    return R"(format = 1
[[material]]
name = "light"
E = "200 GPa"
nu = 0.3
density = "0 kg/m^3"
[shaft]
name = "s"
material = "light"
shear = "none"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 500, 50], ["right", 500, 50]]
[[disk]]
name = "d"
at = "left:end"
mass = "20 kg"
Ip = "0.02 kg.m^2"
Id = "0.01 kg.m^2"
[[bearing]]
name = "DE"
at = "left:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "NDE"
at = "right:end"
type = "rigid"
directions = ["y", "z"]
[[crack]]
name = "c"
at = "left:end"
depth = "12.5 mm"
breathing = ")" +
           breathing + "\"\nphase = \"" + phase + "\"\n";
  };
  const double F = mass * 9.80665, EI = 2e11 * pi / 64 * std::pow(0.05, 4), sound = F / (48 * EI),
               c_xi = elements::crack_compliance(0.0125, 0.025, 2e11, 0.3).xi;
  for (const std::string law : {"hinge", "response", "mayes"}) {
    EXPECT_NEAR(place(DeckModel(deck(law, "270 deg")), 0.0, false).z(), -sound - c_xi * F / 16,
                1e-6 * sound)
        << law;
    EXPECT_NEAR(place(DeckModel(deck(law, "90 deg")), 0.0, false).z(), -sound, 1e-6 * sound) << law;
  }
}

TEST(CrackedRotor, ResponseLawIsTheSameOnEveryMesh) {
  // bent obliquely, so that both planes and the angle matter
  for (const int elements : {1, 2, 6}) {
    std::string deck = jeffcott(
        "[[crack]]\nname = \"c\"\nat = \"left:end\"\nstiffness = \"1e5 N.m/rad\"\n"
        "stiffness_across = \"3e5 N.m/rad\"\nbreathing = \"response\"\nphase = \"200 deg\"\n");
    for (std::size_t p = 0; (p = deck.find("min_elements = 1", p)) != std::string::npos; ++p)
      deck.replace(p, 16, fmt::format("min_elements = {}", elements));
    const Vec3 now = place(DeckModel(deck), 0.0, false);
    // by hand: m = F L/4 (-sin, -cos) of 200 deg in crack axes, theta = dW/dm, theta L/4 aside
    EXPECT_NEAR(now.y(), -3.866021963e-5, 1e-11) << elements;
    EXPECT_NEAR(now.z(), -1.4088647129e-4, 4e-11) << elements;
  }
}

TEST(CrackedRotor, HingeAndResponseBreatheWithTheWeight) {
  // small vibration: the sag opens the crack. A hinge in a sagging rotor is Gasch's square wave; its
  // mean stiffness is half open.
  const auto deck = [](const char* law) {
    return jeffcott(std::string("[[crack]]\nname = \"c\"\nat = \"left:start\"\nto = \"right:end\"\n"
                                "loss = 0.1\nphase = \"270 deg\"\nbreathing = \"") +
                    law + "\"\n");
  };
  const double sag = mass * 9.80665 / k;
  // mean over the turn of cos^2 f: 1/4 for a hinge
  const DeckModel hinge(deck("hinge"));
  EXPECT_NEAR(place(hinge, 100.0).z(), -sag / (1 - 0.1 * 0.25), 1e-4 * sag);
  const DeckModel m(deck("mayes"));
  EXPECT_NEAR(place(m, 100.0).z(), -sag / (1 - 0.1 * 0.25), 1e-6 * sag);
  // the hinge shakes at every speed in multiples of it: the second near half the critical speed
  analysis::Linearizer linear(hinge.built.system, hinge.running());
  analysis::PeriodicResponse periodic(linear);
  const analysis::PeriodicMotion x = periodic.solve(0.5 * omega_n);
  ASSERT_TRUE(x.converged);
  const auto second = analysis::amplitude_at(linear, x.amplitude[2], {hinge.disk(), 0.0});
  EXPECT_GT(std::abs(second.forward()), 5e-5);
}

// J. C. Nicholas, E. J. Gunter, P. E. Allaire, J. Eng. Power 98 (1976) 171: with the bow d, the
// eccentricity e ahead of it by b, f = Omega/omega_n:
//   r = (d + e f^2 exp(i b))/(1 - f^2 + 2 i zeta f) exp(i Omega t)
TEST(BowedRotor, ResponseOfNicholasGunterAllaire) {
  test::Record record(
      "Bowed Jeffcott rotor: synchronous response",
      "J. C. Nicholas, E. J. Gunter, P. E. Allaire, J. Eng. Power 98 (1976) 171, in closed "
      "form");
  const double d = 60e-6, e = 40e-6, b = 2.0, zeta = c / (2 * mass * omega_n);
  for (const bool thermal : {false, true})
    for (const bool unbalanced : {false, true}) {
      const std::string bow =
          thermal ? "bow = { amount = \"60 um\", phase = \"30 deg\", time_constant = \"5 s\" }"
                  : "bow = { amount = \"60 um\", phase = \"30 deg\" }";
      const std::string unbalance = fmt::format(
          "[[unbalance]]\nat = \"d\"\namount = \"8e-4 kg.m\"\nphase = \"{:.17g} rad\"\n",
          pi / 6 + b);
      const DeckModel m(jeffcott(unbalanced ? unbalance : "", bow));
      analysis::Linearizer linear(m.built.system, m.running());
      analysis::UnbalanceOptions o;
      o.probes = {{"d", {m.disk(), 0.0}, {}}};
      analysis::UnbalanceSolver solver(linear, o);
      for (const double f : {0.02, 0.7, 1.0, 1.8}) {
        const Complex exact = std::polar(1.0, pi / 6) *
                              (d + (unbalanced ? e * f * f * std::polar(1.0, b) : Complex(0))) /
                              Complex(1 - f * f, 2 * zeta * f);
        const Complex got = solver.at(f * omega_n).probe[0][0].forward();
        const std::string what =
            fmt::format("{} bow, {}, at {} of the critical speed", thermal ? "thermal" : "residual",
                        unbalanced ? "unbalance" : "balanced", f);
        record.check(what, "um", 1e6 * std::abs(got), 1e6 * std::abs(exact),
                     1e-5 * 1e6 * std::abs(exact));
        EXPECT_NEAR(std::arg(got / exact), 0.0, 1e-5) << what;
      }
    }
}

TEST(BowedRotor, BowLeavesModesAlone) {
  double first = 0;
  for (const char* bow : {"", "bow = { amount = \"200 um\" }",
                          "bow = { amount = \"200 um\", time_constant = \"5 s\" }"}) {
    const DeckModel m(jeffcott("", bow));
    analysis::Linearizer linear(m.built.system, m.running());
    analysis::WhirlSolver modes(linear);
    const double frequency = modes.solve(200.0).front().frequency;
    if (first == 0) first = frequency;
    EXPECT_NEAR(frequency, first, 2e-6 * first) << bow;
  }
}

TEST(BowedRotor, ThermalBowGrowsInTransients) {
  // slowly turning, it stands bowed by d (1 - exp(-t/T)) in its own direction, beside the sag
  const double Omega = 6, T = 0.5;
  const DeckModel m(jeffcott(at_speed(Omega),
                             "bow = { amount = \"60 um\", phase = \"30 deg\", initial = \"10 um\", "
                             "time_constant = \"0.5 s\" }"));
  system::SystemProblem problem(m.built.system);
  analysis::TransientOptions options;
  options.integrator.tolerance = 1e-5;
  options.integrator.t_end = 1.6;
  system::State start = m.built.system.make_state();
  const Vec3 rest = place(m, 0.0, false);
  EXPECT_NEAR(rest.y(), 10e-6 * std::cos(pi / 6), 1e-9);
  start.q[6 * m.disk() + 1] = rest.y();
  start.q[6 * m.disk() + 2] = rest.z();
  turn_all(start, Omega);
  struct Look final : analysis::Observer {
    Index node = 0;
    double Omega = 0, T = 0, worst = 0;
    void step(analysis::StepAccess& s) override {
      const double t = s.t1();
      if (t < 1.0) return;  // the start has rung down to 4 %
      const double d = 60e-6 - 50e-6 * std::exp(-t / T), f = Omega / omega_n;
      const Vec3 u = s.at(t).node(node).u;
      const Complex expected = d / (1 - f * f) * std::polar(1.0, pi / 6 + Omega * t);
      worst = std::max(worst, std::abs(Complex(u.y(), u.z() + mass * 9.80665 / k) - expected));
    }
  } look;
  look.node = m.disk();
  look.Omega = Omega;
  look.T = T;
  analysis::EnergyBalance energy;
  analysis::run_transient(problem, start, options, {&look, &energy});
  EXPECT_LT(look.worst, 0.3e-6);
  EXPECT_LT(energy.worst_defect(), 1e-5 * energy.exchanged());
}
