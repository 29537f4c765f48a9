// Bearings with floating rings through the program: the concentric speed ratio, two films by the
// theory of short bearings, heat, keys, messages, motion, onset and whirl.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace {

using whirl::test::Columns;
using whirl::test::DeckRun;

/// Concentric: ring/shaft = 1/(1 + (mu_o/mu_i)(L_o/L_i)(R_o/R_i)^3 (c_i/c_o)) = 0.15608709.
const std::string small_ring = R"(type = "floating_ring"
inner = { diameter = "8 mm", length = "5 mm", clearance = "18 um", viscosity = "6 mPa.s" }
outer = { diameter = "13 mm", length = "7 mm", clearance = "40 um", viscosity = "12 mPa.s" }
)";
const std::string brief = "film = \"short\"\n";

/// The same ring with a balance of heat.
std::string hot_ring(const std::string& heat, const std::string& more = {}) {
  return R"(type = "floating_ring"
film = "short"
inner = { diameter = "8 mm", length = "5 mm", clearance = "18 um" }
outer = { diameter = "13 mm", length = "7 mm", clearance = "40 um" }
iso_vg = 32
density = "850 kg/m^3"
supply_pressure = "3 bar"
supply_temperature = "90 degC"
)" + more +
         "heat = { " + heat + " }\n";
}

/// A rigid rotor of 0.16 kg on two rings alike, which carry `load` along -z each.
std::string rotor(const std::string& ring, const std::string& steps, double load = 1.0,
                  const std::string& output = {}) {
  const auto end = [&](const char* name, const char* at) {
    return fmt::format("[[bearing]]\nname = \"{}\"\nat = \"{}\"\n{}\n", name, at, ring);
  };
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["a", 20, true], ["b", 20, true]]
[[disk]]
name = "mass"
at = "a:end"
mass = "0.16 kg"
Ip = "1e-5 kg.m^2"
Id = "2e-5 kg.m^2"
[[bearing]]
name = "thrust"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
cxx = "1e3 N.s/m"
[[load]]
at = "a:end"
)" + fmt::format("force = [\"0 N\", \"0 N\", \"{:.12g} N\"]\n", -2 * load) +
         end("DE", "a:start") + end("NDE", "b:end") + steps + "[output]\nreport = false\n" + output;
}

std::string still(double rpm) {
  return fmt::format("[[step]]\nname = \"st\"\ntype = \"static\"\nspeed = \"{:.12g} rpm\"\n", rpm);
}
constexpr double rated = 90000;
constexpr double Omega = rated * M_PI / 30;

struct Rings {
  Columns coefficients, rings, reduced, full;
  explicit Rings(const DeckRun& d)
      : coefficients(d.csv("st_coefficients.csv")),
        rings(d.csv("st_rings.csv")),
        reduced(d.csv("st_ring_coefficients.csv")),
        full(d.csv("st_full_ring_coefficients.csv")) {}
  static double at(const Columns& t, std::size_t row, const char* column) {
    return t.rows.at(row).at(t.column(column));
  }
  double of(const char* column) const { return at(rings, 0, column); }
  double film(const char* column) const { return at(coefficients, 0, column); }
};

/// Runs in one folder a test: what they wrote is read before the next one.
Rings rings_of(const std::string& deck) {
  const DeckRun d(deck);
  EXPECT_EQ(d.exit, 0) << d.log;
  return Rings(d);
}

/// A short film (Ocvirk) under a load, its sides turning at a and b: eccentricity, what its shear and
/// load brake the inner side with, and drive the outer one with.
struct ShortFilm {
  double e = 0, braked = 0, driven = 0, sine = 0;
  ShortFilm(double eta, double R, double L, double c, double a, double b, double load) {
    const auto carries = [&](double x) {
      return eta * R * L * L * L / (4 * c * c) * (a + b) * x / std::pow(1 - x * x, 2) *
             std::sqrt(16 * x * x + M_PI * M_PI * (1 - x * x));
    };
    double low = 0, high = 0.9999;
    for (int k = 0; k < 100; ++k) {
      e = 0.5 * (low + high);
      (carries(e) < load ? low : high) = e;
    }
    const double q = std::sqrt(1 - e * e);
    sine = M_PI * q / std::sqrt(16 * e * e + M_PI * M_PI * q * q);
    const double shear = 2 * M_PI * eta * R * R * R * L * (a - b) / (c * q);
    braked = shear + 0.5 * load * c * e * sine;
    driven = shear - 0.5 * load * c * e * sine;
  }
};

}  // namespace

// The exact speed ratio of a concentric ring, from a deck, by both theories of the films.
TEST(FloatingRings, ConcentricSpeedRatio) {
  for (const std::string& theory : {std::string(), brief}) {
    const Rings r = rings_of(rotor(small_ring + theory, still(rated), 0.0));
    EXPECT_NEAR(r.of("ring speed / speed [-]"), 0.15608709, 1e-8);
    EXPECT_NEAR(r.of("ring speed [rpm]"), 0.15608709 * rated, 1e-3);
    EXPECT_NEAR(r.of("inner eccentricity [-]"), 0, 1e-9);
    EXPECT_NEAR(r.of("torque on the ring [N m]"), 0, 1e-12);
  }
}

// Two short films in series under a load, with the ring's weight none: eccentricities, spin and power
// by the formulas of short bearings, solved by themselves.
TEST(FloatingRings, TwoShortFilmsByThemselves) {
  for (const double load : {0.5, 20.0, 200.0}) {
    SCOPED_TRACE(load);
    const DeckRun d(rotor(small_ring + brief, still(rated), load));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Rings r(d);
    double low = 0, high = 1;
    for (int k = 0; k < 100; ++k) {
      const double s = 0.5 * (low + high);
      const ShortFilm inner(6e-3, 4e-3, 5e-3, 18e-6, Omega, s * Omega, load),
          outer(12e-3, 6.5e-3, 7e-3, 40e-6, s * Omega, 0, load);
      (inner.driven > outer.braked ? low : high) = s;
    }
    const ShortFilm inner(6e-3, 4e-3, 5e-3, 18e-6, Omega, low * Omega, load),
        outer(12e-3, 6.5e-3, 7e-3, 40e-6, low * Omega, 0, load);
    EXPECT_NEAR(r.of("ring speed / speed [-]"), low, 1e-8);
    EXPECT_NEAR(r.of("inner eccentricity [-]"), inner.e, 1e-8);
    EXPECT_NEAR(r.of("outer eccentricity [-]"), outer.e, 1e-8);
    EXPECT_NEAR(r.of("inner load [N]"), load, 1e-6 * load);
    EXPECT_NEAR(r.of("outer load [N]"), load, 1e-6 * load);
    EXPECT_NEAR(r.of("inner thinnest film [m]"), 18e-6 * (1 - inner.e), 1e-13);
    EXPECT_NEAR(r.of("outer thinnest film [m]"), 40e-6 * (1 - outer.e), 1e-13);
    EXPECT_EQ(r.of("inner clearance [m]"), 18e-6);
    EXPECT_EQ(r.of("outer clearance [m]"), 40e-6);
    EXPECT_EQ(r.of("inner viscosity [Pa s]"), 6e-3);
    EXPECT_EQ(r.of("outer viscosity [Pa s]"), 12e-3);
    EXPECT_NEAR(r.of("speed [rpm]"), rated, 1e-6);
    // the ring stands to the side the shaft turns it to: y -> z, so +y for a load along -z
    EXPECT_NEAR(r.of("ring y [m]"), 40e-6 * outer.e * outer.sine, 1e-12);
    EXPECT_NEAR(r.of("ring z [m]"), -40e-6 * outer.e * std::sqrt(1 - outer.sine * outer.sine),
                1e-12);
    // heat of the films is what the shaft is braked with
    const double power = inner.braked * Omega;
    EXPECT_NEAR(r.of("inner power loss [W]") + r.of("outer power loss [W]"), power, 1e-7 * power);
    EXPECT_NEAR(r.of("outer power loss [W]"), outer.braked * low * Omega, 1e-7 * power);
    // no supply was given
    for (const char* none : {"inner flow [m^3/s]", "outer flow [m^3/s]", "inner temperature [degC]",
                             "outer temperature [degC]", "feed pressure of the inner film [Pa]"})
      EXPECT_TRUE(std::isnan(r.of(none))) << none;
  }
}

// Coefficients with the ring following, w -> 0, against differences of equilibria under other loads;
// tables of reduced and full coefficients agree with those of the bearing.
TEST(FloatingRings, CoefficientsTwoWays) {
  const std::string ring = small_ring + brief + "frequency_ratios = [0, 0.5]\n";
  const Rings r = rings_of(rotor(ring, still(rated), 20.0));
  const auto place = [&](double load) {
    const Rings x = rings_of(rotor(ring, still(rated), load));
    return std::array{x.film("y [m]"), x.film("z [m]")};
  };
  const auto low = place(20.02), high = place(19.98);
  const double dy = (high[0] - low[0]) / 0.04, dz = (high[1] - low[1]) / 0.04;
  const auto k = [&](const char* e) {
    return Rings::at(r.reduced, 1, fmt::format("reduced k{} [N/m]", e).c_str());
  };
  EXPECT_NEAR(k("yy") * dy + k("yz") * dz, 0, 1e-5);
  EXPECT_NEAR(k("zy") * dy + k("zz") * dz, 1, 1e-5);
  EXPECT_EQ(Rings::at(r.reduced, 0, "frequency / speed [-]"), 1);
  EXPECT_EQ(Rings::at(r.reduced, 1, "frequency / speed [-]"), 0);
  EXPECT_NEAR(Rings::at(r.reduced, 2, "frequency [Hz]"), 0.5 * rated / 60, 1e-9);
  EXPECT_NEAR(Rings::at(r.reduced, 2, "speed [rpm]"), rated, 1e-6);
  for (const char* e : {"yy", "yz", "zy", "zz"}) {
    EXPECT_EQ(k(e) == 0, false);
    EXPECT_EQ(Rings::at(r.reduced, 0, fmt::format("reduced k{} [N/m]", e).c_str()),
              r.film(fmt::format("k{} [N/m]", e).c_str()));
    EXPECT_EQ(Rings::at(r.reduced, 0, fmt::format("reduced c{} [N s/m]", e).c_str()),
              r.film(fmt::format("c{} [N s/m]", e).c_str()));
  }
  EXPECT_NEAR(r.film("eccentricity / clearance [-]"),
              std::hypot(r.film("y [m]"), r.film("z [m]")) / 58e-6, 1e-9);
  // 25 entries of two bearings, of which rows and columns of the ring hold its mass
  double mass = 0;
  for (const auto& row : r.full.rows)
    mass += row.at(r.full.column("full m [kg]"));
  const double annulus = 8500 * M_PI * (6.5e-3 * 6.5e-3 - 4.018e-3 * 4.018e-3) * 7e-3;
  EXPECT_NEAR(mass, 4 * annulus, 1e-9);
}

// The balance of heat: what the table says of flow, temperature and power fits; the flow fits the
// formula of the manual; the ring stops the supply at the spin the message names.
TEST(FloatingRings, Heat) {
  const std::string growth =
      "shaft_expansion = \"11e-6 1/K\", ring_expansion = \"18e-6 1/K\", housing_expansion = "
      "\"10.5e-6 1/K\"";
  const Rings r = rings_of(rotor(hot_ring(growth), still(rated), 5.0));
  const double Ti = r.of("inner temperature [degC]"), To = r.of("outer temperature [degC]");
  const double s = r.of("ring speed / speed [-]") * Omega,
               lever = 6.5e-3 * 6.5e-3 - 4.018e-3 * 4.018e-3;
  EXPECT_GT(Ti, To);
  EXPECT_GT(To, 90);
  EXPECT_NEAR(r.of("feed pressure of the inner film [Pa]"), 3e5 - 0.5 * 850 * s * s * lever, 1e-3);
  for (const std::string film : {"inner", "outer"}) {
    const auto of = [&](const char* what) { return r.of((film + what).c_str()); };
    EXPECT_NEAR(of(" power loss [W]"),
                850 * 2000 * of(" flow [m^3/s]") * (of(" temperature [degC]") - 90),
                1e-8 * of(" power loss [W]"));
    const bool inner = film == "inner";
    const double R = inner ? 4e-3 : 6.5e-3, L = inner ? 5e-3 : 7e-3, c = of(" clearance [m]"),
                 e = of(" eccentricity [-]"),
                 p = inner ? r.of("feed pressure of the inner film [Pa]") : 3e5;
    EXPECT_NEAR(of(" flow [m^3/s]"),
                M_PI * R * c * c * c * p / (3 * of(" viscosity [Pa s]") * L) * (1 + 1.5 * e * e) +
                    (inner ? Omega + s : s) * R * L * c * e,
                3e-3 * of(" flow [m^3/s]"));
  }
  const double Tr = 0.5 * (Ti + To);
  EXPECT_NEAR(r.of("inner clearance [m]"), 18e-6 + 4e-3 * (18e-6 * (Tr - 20) - 11e-6 * (Ti - 20)),
              1e-13);
  EXPECT_NEAR(r.of("outer clearance [m]"),
              40e-6 + 6.5e-3 * (10.5e-6 * (To - 20) - 18e-6 * (Tr - 20)), 1e-13);
  // half the heat, more of it through the ring, another oil
  const Rings half = rings_of(rotor(hot_ring(growth + ", share = 0.5"), still(rated), 5.0));
  EXPECT_LT(half.of("inner temperature [degC]"), Ti - 1);
  const Rings joined =
      rings_of(rotor(hot_ring(growth + ", conductance = \"20 W/K\""), still(rated), 5.0));
  EXPECT_LT(joined.of("inner temperature [degC]") - joined.of("outer temperature [degC]"),
            0.5 * (Ti - To));
  const Rings oil =
      rings_of(rotor(hot_ring(growth + ", specific_heat = \"1500 J/(kg.K)\""), still(rated), 5.0));
  EXPECT_GT(oil.of("inner temperature [degC]"), Ti + 1);
  const Rings cold =
      rings_of(rotor(hot_ring(growth + ", reference = \"90 degC\""), still(rated), 5.0));
  EXPECT_NEAR(cold.of("inner clearance [m]") - 18e-6,
              4e-3 * (18e-6 * (0.5 * (cold.of("inner temperature [degC]") +
                                      cold.of("outer temperature [degC]")) -
                               90) -
                      11e-6 * (cold.of("inner temperature [degC]") - 90)),
              1e-13);
  // a ring that turns too fast for 0.02 bar
  const double low = 2e3;
  std::string weak = hot_ring(growth);
  weak.replace(weak.find("3 bar"), 5, "0.02 bar");
  const DeckRun starved(rotor(weak, still(rated), 5.0));
  ASSERT_EQ(starved.exit, 0) << starved.log;
  EXPECT_TRUE(starved.says("keeps the supply from the inner film")) << starved.log;
  EXPECT_TRUE(starved.says(
      fmt::format("from {:.6g} rpm on", std::sqrt(2 * low / (850 * lever)) * 30 / M_PI)))
      << starved.log;
  EXPECT_LT(Rings(starved).of("feed pressure of the inner film [Pa]"), 0);
}

// Every other key does what it says.
TEST(FloatingRings, Keys) {
  const auto with = [](const std::string& more) {
    return rings_of(rotor(small_ring + brief + more, still(rated), 20.0));
  };
  const Rings plain = with("");
  const auto ring_mass = [](const Rings& r) {
    double mass = 0;
    for (const auto& row : r.full.rows)
      mass += row.at(r.full.column("full m [kg]"));
    return mass / 4;
  };
  EXPECT_NEAR(ring_mass(with("mass = \"5 g\"\n")), 5e-3, 1e-15);
  EXPECT_NEAR(ring_mass(with("ring_density = \"2700 kg/m^3\"\n")), ring_mass(plain) * 2700 / 8500,
              1e-12);
  // the last entry of a bearing is that of the spin against itself: I over the outer radius times
  // the spin of an unknown, 1000 rad/s a clearance
  const auto inertia = [](const Rings& r) {
    return Rings::at(r.full, r.full.rows.size() - 1, "full c [N s/m]") * 6.5e-3 * 40e-6 / 1e3;
  };
  const double annulus = 8500 * M_PI * (6.5e-3 * 6.5e-3 - 4.018e-3 * 4.018e-3) * 7e-3;
  EXPECT_NEAR(inertia(plain), 0.5 * annulus * (6.5e-3 * 6.5e-3 + 4.018e-3 * 4.018e-3), 1e-15);
  EXPECT_NEAR(inertia(with("inertia = \"3e-7 kg.m^2\"\n")), 3e-7, 1e-18);
  // holes take n d^2/(4 D) of both lengths
  const Rings holes = with("holes = { number = 6, diameter = \"1.5 mm\" }\n");
  const double Li = 5e-3 - 6 * 1.5e-3 * 1.5e-3 / (4 * 8e-3),
               Lo = 7e-3 - 6 * 1.5e-3 * 1.5e-3 / (4 * 13e-3);
  const Rings shorter = rings_of(rotor(fmt::format(R"(type = "floating_ring"
film = "short"
inner = {{ diameter = "8 mm", length = "{:.15g} m", clearance = "18 um", viscosity = "6 mPa.s" }}
outer = {{ diameter = "13 mm", length = "{:.15g} m", clearance = "40 um", viscosity = "12 mPa.s" }}
)",
                                                   Li, Lo),
                                       still(rated), 20.0));
  EXPECT_NEAR(holes.of("ring speed / speed [-]"), shorter.of("ring speed / speed [-]"), 1e-9);
  EXPECT_NEAR(holes.of("inner eccentricity [-]"), shorter.of("inner eccentricity [-]"), 1e-9);
  // supply: pressure alone gives flows
  const Rings fed = with("supply_pressure = \"2 bar\"\ndensity = \"800 kg/m^3\"\n");
  EXPECT_NEAR(fed.of("feed pressure of the inner film [Pa]"),
              2e5 - 0.5 * 800 * std::pow(fed.of("ring speed / speed [-]") * Omega, 2) *
                        (6.5e-3 * 6.5e-3 - 4.018e-3 * 4.018e-3),
              1e-3);
  EXPECT_GT(fed.of("outer flow [m^3/s]"), 0);
  // viscosity by grade and temperature: another one in each film
  const std::string by_grade = R"(type = "floating_ring"
film = "short"
iso_vg = 46
inner = { diameter = "8 mm", length = "5 mm", clearance = "18 um", temperature = "110 degC" }
outer = { diameter = "13 mm", length = "7 mm", clearance = "40 um", temperature = "90 degC" }
)";
  const Rings grade = rings_of(rotor(by_grade, still(rated), 20.0));
  const auto vogel = [](double T) {
    return 0.18e-3 *
           std::exp((159.55657 / (T + 95) - 0.181913) * std::log(900 * 46 * 1e-6 / 0.18e-3));
  };
  EXPECT_NEAR(grade.of("inner viscosity [Pa s]"), vogel(110), 1e-12);
  EXPECT_NEAR(grade.of("outer viscosity [Pa s]"), vogel(90), 1e-12);
  // finite films carry less than short ones, and a finer grid is nearer to the finest
  const Rings finite = rings_of(rotor(small_ring, still(rated), 20.0));
  EXPECT_GT(finite.of("inner eccentricity [-]"), plain.of("inner eccentricity [-]"));
  EXPECT_LT(finite.film("grid error [-]"), 1e-3);
  const Rings finer = rings_of(rotor(small_ring + "grid = 144\n", still(rated), 20.0));
  EXPECT_LE(finer.film("grid error [-]"), finite.film("grid error [-]"));
  // what one profile along the axis leaves is the larger part
  EXPECT_GT(finite.film("axial error [-]"), finite.film("grid error [-]"));
  EXPECT_LT(finite.film("axial error [-]"), 0.03);
  EXPECT_TRUE(std::isnan(plain.film("axial error [-]")));
}

// A pinned ring: the outer film carries nothing at rest, the spring the load, the pin the drag.
TEST(FloatingRings, Pinned) {
  const std::string pinned =
      small_ring + brief + "pinned = true\nstiffness = \"2e6 N/m\"\ndamping = \"50 N.s/m\"\n";
  const Rings r = rings_of(rotor(pinned, still(rated), 20.0));
  EXPECT_EQ(r.of("ring speed [rpm]"), 0);
  EXPECT_NEAR(r.of("ring z [m]"), -20 / 2e6, 1e-12);
  EXPECT_NEAR(r.of("ring y [m]"), 0, 1e-12);
  const ShortFilm inner(6e-3, 4e-3, 5e-3, 18e-6, Omega, 0, 20.0);
  EXPECT_NEAR(r.of("inner eccentricity [-]"), inner.e, 1e-8);
  EXPECT_NEAR(r.of("torque on the ring [N m]"), inner.driven, 1e-8);
  EXPECT_EQ(r.of("outer power loss [W]"), 0);
  // its damper stands in the full matrices
  const Rings damped = rings_of(
      rotor(small_ring + brief + "pinned = true\nstiffness = \"2e6 N/m\"\ndamping = \"80 N.s/m\"\n",
            still(rated), 20.0));
  const std::size_t last = r.full.rows.size() - 1;
  EXPECT_NEAR(
      Rings::at(damped.full, last, "full c [N s/m]") - Rings::at(r.full, last, "full c [N s/m]"),
      30, 1e-6);
  // without a spring nothing holds it at rest
  const DeckRun loose(rotor(small_ring + brief + "pinned = true\n", still(rated), 20.0));
  EXPECT_NE(loose.exit, 0);
  EXPECT_TRUE(loose.says("E75") || loose.says("E76")) << loose.log;
}

TEST(FloatingRings, BadInput) {
  const auto fails = [](const std::string& ring, const char* code, const char* text,
                        double load = 20.0) {
    const DeckRun d(rotor(ring, still(rated), load));
    EXPECT_NE(d.exit, 0) << ring;
    EXPECT_TRUE(d.says(code) && d.says(text)) << d.log;
  };
  const auto changed = [](const char* from, const char* to) {
    std::string text = small_ring;
    return text.replace(text.find(from), std::string(from).size(), to);
  };
  fails(changed("\"13 mm\"", "\"8.02 mm\""), "error[E14]", "the ring is -0.008 mm thick");
  fails(changed("\"18 um\"", "\"0 um\""), "error[", "clearance");
  fails(small_ring + "mass = \"0 kg\"\n", "error[", "mass");
  fails(small_ring + "inertia = \"0 kg.m^2\"\n", "error[", "inertia");
  fails(small_ring + "stiffness = \"1e6 N/m\"\n", "error[E05]", "pinned");
  fails(small_ring + "holes = { number = 60, diameter = \"3 mm\" }\n", "error[E14]",
        "holes leave nothing");
  fails(changed(", viscosity = \"6 mPa.s\"", ""), "error[E05]", "inner film has no viscosity");
  fails(changed("viscosity = \"6 mPa.s\"", "temperature = \"90 degC\""), "error[E05]", "grade");
  fails(changed("viscosity = \"6 mPa.s\"", "viscosity = \"6 mPa.s\", temperature = \"90 degC\""),
        "error[E26]", "viscosity and a temperature");
  fails(small_ring + "supply_temperature = \"90 degC\"\n", "error[E05]", "heat");
  fails(small_ring + "iso_vg = 32\nheat = {}\n", "error[E26]", "heat balance finds");
  std::string unfed = hot_ring("");
  unfed.replace(unfed.find("supply_pressure = \"3 bar\"\n"), 26, "");
  fails(unfed, "error[E05]", "needs the supply");
  // a shaft that grows into its ring
  fails(hot_ring("shaft_expansion = \"80e-6 1/K\""), "error[E14]", "inner clearance is -4.4 um");
  fails(hot_ring("shaft_expansion = \"60e-6 1/K\""), "error[",
        "a clearance closes where both films have 95 degC");
  // too much for it: load, eccentricity, what it could carry
  const DeckRun heavy(rotor(small_ring + brief, still(rated), 2e5));
  EXPECT_EQ(heavy.exit, 0);
  EXPECT_TRUE(heavy.says("bearing 'DE outer film' runs at eccentricity 0.998") &&
              heavy.says("carrying 2e+05 N") && heavy.says("where it carries about 2790 N") &&
              heavy.says("of the shaft's speed, thinnest film 0.047"))
      << heavy.log;
}

// The motion from rest ends where statics say, and one that begins there stays.
TEST(FloatingRings, MotionEndsInTheEquilibrium) {
  const auto ends = [](const std::string& ring, const char* start, double tolerance) {
    const DeckRun d(rotor(ring,
                          "[[drive]]\nname = \"motor\"\nat = \"a:start\"\ntype = "
                          "\"speed\"\nspeed = \"20000 rpm\"\n[[probe]]\nname = \"P\"\nat = "
                          "\"a:start\"\n" +
                              still(20000) + "[[step]]\nname = \"t\"\ntype = \"transient\"\n" +
                              start,
                          60.0, "quantities = [\"probes\", \"rings\", \"energy\"]\n"));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Rings r(d);
    auto t = d.csv("t.csv").last();
    EXPECT_NEAR(t.at("P.z [m]"), r.film("z [m]"), tolerance * 58e-6);
    EXPECT_NEAR(t.at("bearing DE ring.y [mm]"), 1e3 * r.of("ring y [m]"), 1e3 * tolerance * 58e-6);
    EXPECT_NEAR(t.at("bearing DE ring.z [mm]"), 1e3 * r.of("ring z [m]"), 1e3 * tolerance * 58e-6);
    EXPECT_NEAR(t.at("bearing DE ring speed [rpm]"), r.of("ring speed [rpm]"), tolerance * 20000);
    EXPECT_NEAR(t.at("bearing DE eccentricity.inner [-]"), r.of("inner eccentricity [-]"),
                tolerance);
    EXPECT_NEAR(t.at("bearing DE eccentricity.outer [-]"), r.of("outer eccentricity [-]"),
                tolerance);
    EXPECT_NEAR(t.at("bearing DE power loss.inner [W]"), r.of("inner power loss [W]"),
                tolerance * r.of("inner power loss [W]"));
    EXPECT_NEAR(t.at("bearing DE power loss.outer [W]"), r.of("outer power loss [W]"),
                10 * tolerance * r.of("inner power loss [W]"));
  };
  ends(small_ring + brief, "start = \"static\"\nduration = \"0.02 s\"\n", 1e-6);
  ends(small_ring + brief, "start = \"rest\"\nduration = \"0.1 s\"\n", 1e-3);
}

namespace {

/// Rings of a small turbocharger.
const std::string charger = R"(type = "floating_ring"
film = "short"
inner = { diameter = "7 mm", length = "4 mm", clearance = "12 um", viscosity = "7 mPa.s" }
outer = { diameter = "11.5 mm", length = "6 mm", clearance = "35 um", viscosity = "7 mPa.s" }
)";

std::string turning(double rpm, const std::string& transient, double unbalance = 0.2) {
  return fmt::format(R"([[unbalance]]
at = "mass"
amount = "{2} g.mm"
[[probe]]
name = "P"
at = "mass"
[[drive]]
name = "gas"
at = "a:start"
type = "speed"
speed = "{0:.9g} rpm"
[[step]]
name = "t"
type = "transient"
start = "static"
{1})",
                     rpm, transient, unbalance);
}

/// The strongest motion y + i z slower than the shaft in a part of a run: frequency, Hz, and
/// amplitude, m.
std::array<double, 2> whirl_of(const Columns& run, double from, double rpm, double to = 1e9) {
  const std::size_t t = run.column("t [s]"), y = run.column("P.y [m]"), z = run.column("P.z [m]");
  std::vector<std::array<double, 3>> x;
  for (const auto& row : run.rows)
    if (row[t] >= from && row[t] < to) x.push_back({row[t], row[y], row[z]});
  const double length = x.back()[0] - x.front()[0];
  double my = 0, mz = 0;
  for (const auto& p : x) {
    my += p[1] / static_cast<double>(x.size());
    mz += p[2] / static_cast<double>(x.size());
  }
  const auto amplitude = [&](double f) {
    double re = 0, im = 0;
    for (const auto& p : x) {
      const double s = (p[0] - x.front()[0]) / length, window = 1 - std::cos(2 * M_PI * s),
                   a = 2 * M_PI * f * p[0];
      re += window * ((p[1] - my) * std::cos(a) + (p[2] - mz) * std::sin(a));
      im += window * ((p[2] - mz) * std::cos(a) - (p[1] - my) * std::sin(a));
    }
    return std::hypot(re, im) / static_cast<double>(x.size());
  };
  std::array<double, 2> best{0, 0};
  for (double f = 3 / length; f < 0.8 * rpm / 60; f += 0.1 / length)
    if (const double a = amplitude(f); a > best[1]) best = {f, a};
  return best;
}

double mean_ring_speed(const Columns& run, double from) {
  return run.means(from, 1e9).at("bearing DE ring speed [rpm]");
}

// The stiffness of a film is not symmetric: a whirl it damps strongly may store less than nothing. It
// was "axial" or "torsional" then, by the rounding of what is left.
TEST(FloatingRings, AStronglyDampedWhirlIsLateral) {
  const auto run = [](const char* mass) {
    return DeckRun(fmt::format(R"(format = 1
[output]
report = false
[shaft]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "id[mm]"]
rows = [["a", 150, 40, 16], ["b", 300, 30, 0], ["c", 300, 60, 0], ["d", 300, 60, 24]]
[[disk]]
at = "r/1.05 m"
mass = "8 kg"
Ip = "0.0003 kg.m^2"
Id = "0.165 kg.m^2"
[[disk]]
at = "r/0.3 m"
mass = "{}"
Ip = "0.02 kg.m^2"
Id = "0.012 kg.m^2"
[[bearing]]
name = "ring"
at = "r/0.1 m"
type = "floating_ring"
film = "short"
inner = {{ diameter = "50 mm", length = "20 mm", clearance = "50 um", viscosity = "10 mPa.s" }}
outer = {{ diameter = "65 mm", length = "25 mm", clearance = "80 um", viscosity = "20 mPa.s" }}
[[bearing]]
at = "r/0.1 m"
type = "linear"
kxx = "1e8 N/m"
cxx = "1000 N.s/m"
[[bearing]]
at = "r/0.9 m"
type = "linear"
kyy = "1e7 N/m"
kzz = "1.2e7 N/m"
cyy = "1e3 N.s/m"
czz = "1e3 N.s/m"
[[step]]
name = "m"
type = "modal"
speed = "1500 rpm"
modes = 8
motion = "lateral"
)",
                               mass));
  };
  for (const char* mass : {"3 kg", "6.61386786554633 lbm"}) {
    const DeckRun d = run(mass);
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns t = d.csv("m_modes.csv");
    ASSERT_GE(t.rows.size(), 6u) << d.log;
    for (const auto& row : t.rows)
      EXPECT_NEAR(row[t.column("lateral [%]")], 100.0, 1e-6) << mass << ", mode " << row[0];
  }
}

}  // namespace

// Self-excited whirl of either film: the inner one at about half the sum of the speeds of shaft and
// ring, the outer one at half that of the ring.
TEST(FloatingRings, InnerAndOuterWhirl) {
  const std::string output = "every = \"0.02 ms\"\nquantities = [\"probes\", \"rings\"]\n";
  {
    const DeckRun d(rotor(charger, turning(60000, "duration = \"0.06 s\"\n"), 0.785, output));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns run = d.csv("t.csv");
    const auto [f, size] = whirl_of(run, 0.03, 60000);
    const double half = 0.5 * (60000 + mean_ring_speed(run, 0.03)) / 60;
    EXPECT_GT(size, 2e-6);
    EXPECT_NEAR(f / half, 0.93, 0.05);
  }
  {
    const DeckRun d(rotor(charger, turning(180000, "duration = \"0.1 s\"\n"), 0.785, output));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns run = d.csv("t.csv");
    const auto [f, size] = whirl_of(run, 0.06, 180000);
    const double half = 0.5 * mean_ring_speed(run, 0.06) / 60;
    EXPECT_GT(size, 8e-6);
    EXPECT_NEAR(f / half, 1.0, 0.05);
  }
}

// The onset of the outer whirl by eigenvalues, and motions on both sides of it, kicked by a small
// unbalance at their start: one dies out, the other grows, both at the frequency of the onset.
TEST(FloatingRings, OnsetAndMotion) {
  const double load = 10;
  double onset = 0, frequency = 0;
  {
    const DeckRun d(rotor(charger,
                          "[[step]]\nname = \"stability\"\ntype = \"stability\"\nspeed = { start = "
                          "\"100000 rpm\", stop = \"200000 rpm\", points = 9 }\n",
                          load));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns t = d.csv("stability_onset.csv");
    ASSERT_EQ(t.rows.size(), 1u) << d.log;
    onset = t.rows[0].at(t.column("speed [rpm]"));
    frequency = t.rows[0].at(t.column("whirl frequency [Hz]"));
  }
  // half the ring's speed, which is about 0.29 of the shaft's
  EXPECT_NEAR(frequency / (onset / 60), 0.5 * 0.294, 0.02);
  for (const double part : {0.94, 1.06}) {
    SCOPED_TRACE(part);
    const double rpm = part * onset;
    const DeckRun d(rotor(charger, turning(rpm, "duration = \"0.12 s\"\n", 2e-4), load,
                          "every = \"0.05 ms\"\nquantities = [\"probes\"]\n"));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns run = d.csv("t.csv");
    const auto early = whirl_of(run, 0.005, rpm, 0.045), late = whirl_of(run, 0.08, rpm);
    EXPECT_NEAR(early[0] / frequency, 1, 0.04);
    EXPECT_NEAR(late[0] / frequency, 1, 0.04);
    if (part < 1)
      EXPECT_LT(late[1], 0.8 * early[1]);
    else
      EXPECT_GT(late[1], 1.25 * early[1]);
  }
}
