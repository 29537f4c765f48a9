// Cracks and thermal bows through the program: what steps write, and what is refused.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace {

using whirl::pi;
using whirl::test::Columns;
using whirl::test::DeckRun;

/// 20 kg in the middle of a massless shaft of 2 MN/m.
std::string rotor(const std::string& rest, const std::string& of_shaft = "") {
  const std::string section =
      "length = \"500 mm\"\nmin_elements = 1\n[shaft.section.constants]\n"
      "EA = \"4e8 N\"\nGJ = \"1e5 N.m^2\"\nEI = \"41666.666666666664 "
      "N.m^2\"\nkGA = \"1e15 N\"\nrhoA = \"0 kg/m\"\nrhoI = \"0 kg.m\"\nrhoIp = \"0 kg.m\"\n";
  return "format = 1\n[shaft]\nname = \"s\"\n" + of_shaft +
         "\n[[shaft.section]]\nname = \"left\"\n" + section +
         "[[shaft.section]]\nname = \"right\"\n" + section + R"([[disk]]
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
[[probe]]
name = "P"
at = "d"
)" + rest;
}

const std::string mayes = R"([[crack]]
name = "c"
at = "left:start"
to = "right:end"
loss = 0.1
phase = "270 deg"
)";

const std::string unbalance =
    "[[unbalance]]\nat = \"d\"\namount = \"2e-4 kg.m\"\nphase = \"287.1887338539247 deg\"\n";

}  // namespace

// Fourier terms by shooting to 1e-10 (tests/validation/test_cracked_rotor.cpp), at 0.5 and 1.1 of the
// critical speed.
TEST(Cracks, UnbalanceResponseWritesMultiples) {
  const DeckRun d(rotor(mayes + unbalance +
                        "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { values = "
                        "[\"158.11388300841898 rad/s\", \"347.8505426185217 rad/s\"] }\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("u_multiples.csv");
  ASSERT_GE(t.rows.size(), 2u);
  const auto half = t.named(t.rows.front()), above = t.named(t.rows.back());
  EXPECT_NEAR(half.at("P mean y [m]"), 1.28064e-6, 2e-11);
  EXPECT_NEAR(half.at("P mean z [m]"), -99.06179e-6, 2e-11);
  EXPECT_NEAR(half.at("P 1x forward [m]"), 4.76632e-6, 2e-11);
  EXPECT_NEAR(half.at("P 1x backward [m]"), 1.04339e-6, 2e-11);
  EXPECT_NEAR(half.at("P 2x forward [m]"), 81.09635e-6, 3e-6 * 81.09635e-6);
  EXPECT_NEAR(half.at("P 2x backward [m]"), 0.16348e-6, 2e-11);
  EXPECT_NEAR(half.at("P 3x forward [m]"), 0.62591e-6, 2e-11);
  EXPECT_NEAR(above.at("P 1x forward [m]"), 56.71212e-6, 2e-11);
  EXPECT_LT(half.at("left out [-]"), 1e-4);
  // the first multiple is what the table of the response has
  const Columns r = d.csv("u_response.csv");
  const auto row = r.named(r.rows.back());
  EXPECT_NEAR(row.at("P major [m]"), (56.71212 + 5.22612) * 1e-6, 5e-11);
}

TEST(Cracks, StabilityFindsTheBand) {
  const DeckRun d(rotor(mayes +
                        "[[step]]\nname = \"b\"\ntype = \"stability\"\nspeed = { start = \"2700 "
                        "rpm\", stop = \"3100 rpm\", points = 9 }\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns bands = d.csv("b_bands.csv");
  ASSERT_EQ(bands.rows.size(), 1u);
  // near 0.98 of 3019.75 rpm
  EXPECT_NEAR(bands.last().at("at [rpm]"), 0.98 * 3019.75, 30);
}

TEST(Cracks, TransientWritesTheOpening) {
  // after Mayes: (1 + cos)/2 of the angle between the normal and straight down, the shaft turned by
  // 40 rad/s t
  const DeckRun d(rotor(mayes +
                        "[[drive]]\nat = \"left:start\"\ntype = \"speed\"\nspeed = \"40 rad/s\"\n"
                        "[[step]]\nname = \"t\"\ntype = \"transient\"\nstart = \"static\"\n"
                        "initial_speed = \"40 rad/s\"\nduration = \"0.1 s\"\n[output]\nevery = \"5 "
                        "ms\"\nquantities = [\"cracks\"]\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("t.csv");
  ASSERT_GT(t.rows.size(), 10u);
  for (const auto& row : t.rows)
    EXPECT_NEAR(row[t.column("crack c opening [-]")], 0.5 * (1 + std::cos(40 * row[0])), 1e-6);
}

TEST(Cracks, OpenDirectionTurnsTheLaw) {
  const DeckRun d(
      rotor("[[crack]]\nname = \"c\"\nat = \"left:end\"\nstiffness = \"1 MN.m/rad\"\n"
            "open_direction = \"30 deg\"\n[[step]]\nname = \"t\"\ntype = "
            "\"transient\"\nduration = \"1 ms\"\nstart = \"rest\"\n[output]\n"
            "quantities = [\"cracks\"]\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("t.csv");
  EXPECT_NEAR(t.rows.front()[t.column("crack c opening [-]")], 0.5 * (1 + std::cos(pi / 6)), 1e-9);
}

TEST(Cracks, MeansAreSaid) {
  const DeckRun d(
      rotor(mayes + "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"1000 rpm\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("W14")) << d.log;
  EXPECT_TRUE(d.says("crack enters as the mean of its compliance")) << d.log;
}

TEST(Cracks, AtRestItIsOpenOrShutAsItLies) {
  const auto modes = [](const std::string& crack) {
    const DeckRun d(rotor(crack + "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 3\n"));
    EXPECT_EQ(d.exit, 0) << d.log;
    EXPECT_FALSE(d.says("W14")) << d.log;
    const Columns t = d.csv("m_modes.csv");
    return std::pair(t.rows.at(0)[t.column("frequency [Hz]")],
                     t.rows.at(1)[t.column("frequency [Hz]")]);
  };
  const auto sound = modes(""), open = modes(mayes),
             shut = modes(std::string(mayes).replace(mayes.find("270"), 3, "90"));
  EXPECT_NEAR(shut.first, sound.first, 1e-6 * sound.first);
  EXPECT_NEAR(shut.second, sound.second, 1e-6 * sound.second);
  EXPECT_LT(open.first, 0.999 * sound.first);
}

TEST(Cracks, WhatIsRefused) {
  const auto refused = [](const std::string& deck, const char* code, const char* text) {
    const DeckRun d(deck);
    EXPECT_NE(d.exit, 0) << text;
    EXPECT_TRUE(d.says(code)) << d.log;
    EXPECT_TRUE(d.says(text)) << d.log;
  };
  const std::string still = "[[step]]\nname = \"st\"\ntype = \"static\"\n";
  const std::string at_mid = "[[crack]]\nname = \"c\"\nat = \"left:end\"\n";
  refused(rotor(at_mid + "depth = \"5 mm\"\n" + still), "E26", "is given by constants");
  refused(rotor(at_mid + "stiffness = \"1 MN.m/rad\"\n" + still, "rotating = false"), "E26",
          "does not turn");
  refused(
      rotor(mayes + "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"1 s\"\nlinear = "
                    "true\n"),
      "E39", "turns with it");
  refused(rotor(mayes + "[[step]]\nname = \"b\"\ntype = \"balancing\"\nspeeds = [\"1000 rpm\"]\n"
                        "[[step.plane]]\nname = \"p\"\nat = \"d\"\n"),
          "E88", "influence coefficients");
  refused(rotor("[[crack]]\nname = \"c\"\nat = \"right:start\"\nto = \"left:start\"\nloss = 0.1\n" +
                still),
          "E26", "not to the right of its beginning");
  const std::string solid = R"(format = 1
[shaft]
name = "s"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "rigid"]
rows = [["left", 500, 50, false], ["hub", 100, 80, true], ["right", 500, 50, false]]
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
)";
  refused(solid + "[[crack]]\nname = \"c\"\nat = \"left:mid\"\ndepth = \"26 mm\"\n" + still, "E14",
          "deep in a shaft of radius");
  refused(solid + "[[crack]]\nname = \"c\"\nat = \"hub:mid\"\ndepth = \"10 mm\"\n" + still, "E26",
          "no round elastic section ends");
  refused(solid + "[[crack]]\nname = \"c\"\nat = \"nowhere\"\ndepth = \"10 mm\"\n" + still, "E18",
          "nowhere");
}

TEST(ThermalBow, StaticsAtRestHaveItsStartAndSteadyRotationItsEnd) {
  const std::string bow =
      "bow = { amount = \"60 um\", initial = \"10 um\", time_constant = \"5 s\" }";
  // held at its angle: free, it would roll
  std::string still = rotor("[[step]]\nname = \"st\"\ntype = \"static\"\n", bow);
  const std::string free = "[\"x\", \"y\", \"z\"]";
  still.replace(still.find(free), free.size(), "[\"x\", \"y\", \"z\", \"rx\"]");
  const DeckRun at_rest(still);
  ASSERT_EQ(at_rest.exit, 0) << at_rest.log;
  const Columns t = at_rest.csv("st_deflection.csv");
  double most = 0;
  for (const auto& row : t.rows)
    most = std::max(most, row[t.column("u_y [m]")]);
  EXPECT_NEAR(most, 10e-6, 1e-10);
  const DeckRun turning(
      rotor("[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { values = [\"60 "
            "rpm\"] }\n",
            bow));
  ASSERT_EQ(turning.exit, 0) << turning.log;
  const double f = 2 * pi / 316.22776601683796;
  EXPECT_NEAR(turning.csv("u_response.csv").last().at("P major [m]"), 60e-6 / (1 - f * f), 1e-9);
}

// A moment that stands still in space meets the mean of the compliance of a turning crack, in series with
// the shaft: u = L^3/(48 EI) + c (L/4)^2 a unit force of a Jeffcott rotor, on any mesh. The mean of the
// stiffness between two nodes was that of the closed crack where they were close.
TEST(Cracks, TheMeanIsThatOfTheComplianceOnAnyMesh) {
  constexpr double L = 1.0, EI = 41666.666666666664, xi = 1.0 / 2e6, eta = 1.0 / 5e6, mass = 20.0;
  const auto frequency = [&](const std::string& breathing, int elements,
                             const std::string& beside) {
    const auto section = [&](const char* name, double mm) {
      return fmt::format(
          "[[shaft.section]]\nname = \"{}\"\nlength = \"{} mm\"\nmin_elements = "
          "{}\n[shaft.section.constants]\n"
          "EA = \"4e8 N\"\nGJ = \"1e5 N.m^2\"\nEI = \"41666.666666666664 N.m^2\"\nkGA = \"1e15 "
          "N\"\nrhoA = \"0 "
          "kg/m\"\nrhoI = \"0 kg.m\"\nrhoIp = \"0 kg.m\"\n",
          name, mm, elements);
    };
    const double first = beside.empty() ? 500.0 : 499.0;
    const DeckRun run(
        "format = 1\n[output]\nreport = false\n[model]\ngravity = \"9.8 m/s^2\"\n[shaft]\nname = "
        "\"s\"\n" +
        section("left", first) + (beside.empty() ? std::string() : section("short", 1.0)) +
        section("right", 500.0) +
        "[[disk]]\nat = \"right:start\"\nmass = \"20 kg\"\nIp = \"1e-3 kg.m^2\"\nId = \"5e-4 "
        "kg.m^2\"\n"
        "[[bearing]]\nat = \"left:start\"\ntype = \"rigid\"\ndirections = [\"x\", \"y\", \"z\"]\n"
        "[[bearing]]\nat = \"right:end\"\ntype = \"rigid\"\ndirections = [\"y\", \"z\"]\n"
        "[[crack]]\nat = \"right:start\"\nstiffness = \"2 MN.m/rad\"\n" +
        std::string(breathing == "hinge" ? "" : "stiffness_across = \"5 MN.m/rad\"\n") +
        "breathing = \"" + breathing +
        "\"\n[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"600 rpm\"\nmodes = 2\nmotion = "
        "\"lateral\"\n");
    EXPECT_EQ(run.exit, 0) << run.log;
    return run.csv("m_modes.csv").rows.at(0)[4];
  };
  const std::pair<const char*, double> laws[] = {{"open", (xi + eta) / 2},
                                                 {"mayes", (xi + eta) / 4},
                                                 {"response", (xi + eta) / 4},
                                                 {"hinge", xi / 4}};
  for (const auto& [breathing, c] : laws) {
    const double u = L * L * L / (48 * EI) + c * L * L / 16;
    const double exact = std::sqrt(1 / (mass * u)) / (2 * 3.14159265358979);
    for (const int elements : {1, 7})
      for (const char* beside : {"", "short"})
        EXPECT_NEAR(frequency(breathing, elements, beside) / exact, 1.0, 1e-4)
            << breathing << elements << beside;
  }
}

// The element in which a crack stands carries its inertia without the kink. It is short, so that the mesh
// around it is of no account: what 5 elements a section give is what 60 give.
TEST(Cracks, TheInertiaBesideAKinkIsConvergedOnAnyMesh) {
  const auto frequencies = [](const char* od, const char* depth, int elements) {
    const DeckRun r(fmt::format(R"(format = 1
[output]
report = false
[shaft]
name = "R"
material = "steel"
[[shaft.section]]
length = "1 m"
od = "{} mm"
min_elements = {}
[[crack]]
at = "0.45 m"
depth = "{} mm"
breathing = "open"
[[bearing]]
at = "0 m"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "1 m"
type = "rigid"
directions = ["y", "z"]
[[step]]
name = "m"
type = "modal"
speed = "0 rpm"
motion = "lateral"
modes = 2
)",
                                od, elements, depth));
    EXPECT_EQ(r.exit, 0) << r.log;
    const Columns modes = r.csv("m_modes.csv");
    return std::array{modes.rows.at(0).at(4), modes.rows.at(1).at(4)};
  };
  for (const auto& [od, depth] : {std::pair{"50", "20"}, std::pair{"200", "80"}}) {
    const auto coarse = frequencies(od, depth, 5), fine = frequencies(od, depth, 60);
    for (const std::size_t k : {0u, 1u})
      EXPECT_NEAR(coarse[k] / fine[k], 1.0, 2e-4) << od << " " << k;
  }
}

// So it is where sections meet whose lengths add up to the station of the crack but for rounding.
TEST(Cracks, StationsStandBesideACrackWhereSectionsMeet) {
  const DeckRun r(R"(format = 1
[output]
report = false
[model.mesh]
min_elements_per_section = 1
[shaft]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 100, 50], ["b", 200, 50], ["c", 700, 50]]
[[crack]]
at = "0.3 m"
depth = "20 mm"
breathing = "open"
[[bearing]]
at = "0 m"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "1 m"
type = "rigid"
directions = ["y", "z"]
[[step]]
name = "s"
type = "static"
speed = "0 rpm"
)");
  ASSERT_EQ(r.exit, 0) << r.log;
  const Columns t = r.csv("s_deflection.csv");
  std::vector<double> places;
  for (const auto& row : t.rows)
    places.push_back(row[t.column("s [m]")]);
  for (const double place : {0.2975, 0.3025})
    EXPECT_TRUE(std::any_of(places.begin(), places.end(), [&](double s) {
      return std::abs(s - place) < 1e-9;
    })) << place;
}

// A shaft of 1 m on two supports under 1000 N in the middle, where an open crack gives way like a hinge of
// 2 MN m/rad: F L^3/48 EI and shear, and F L^2/16 of the hinge. The line has a kink there, no bend of the element
// beside it: the largest deflection is that of the middle.
TEST(Cracks, TheDeflectionHasAKinkAtTheCrack) {
  for (const char* elements : {"1", "5"}) {
    const DeckRun r(std::string(R"(format = 1
[model]
gravity = "0 m/s^2"
[model.mesh]
min_elements_per_section = )") +
                    elements + R"(
[shaft]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 50], ["b", 500, 50]]
[[crack]]
at = "a:end"
stiffness = "0.4 MN.m/rad"
breathing = "open"
phase = "-90 deg"
[[load]]
at = "a:end"
force = ["0 N", "0 N", "-1000 N"]
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "b:end"
type = "rigid"
directions = ["y", "z"]
[[step]]
name = "s"
type = "static"
speed = "0 rpm"
)");
    ASSERT_EQ(r.exit, 0) << r.log;
    const whirl::io::Value deflection = r.summary("s").at("deflection").at("R");
    EXPECT_NEAR(deflection.at("at [m]").number(), 0.5, 1e-12) << elements;
    const Columns table = r.csv("s_deflection.csv");
    double middle = 0;
    for (const auto& row : table.rows)
      middle = std::max(middle, std::abs(row[table.column("u_z [m]")]));
    EXPECT_NEAR(deflection.at("largest [m]").number(), middle, 1e-9 * middle) << elements;
  }
}

namespace {

/// 20 kg in the middle of a pinned shaft of 1 m and 50 mm without mass, cracked there 15 mm deep.
std::string cracked_jeffcott(const char* law, double damping, const std::string& step) {
  return fmt::format(R"(format = 1
[model]
gravity = "9.81 m/s^2"
[output]
report = false
[[material]]
name = "light"
E = "200 GPa"
nu = 0.3
density = "0.5 kg/m^3"
[shaft]
name = "s"
material = "light"
shear = "none"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["l", 500, 50], ["r", 500, 50]]
[[disk]]
at = "l:end"
mass = "20 kg"
Ip = "1e-6 kg.m^2"
Id = "1e-6 kg.m^2"
[[bearing]]
at = "l:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "r:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
at = "l:end"
type = "linear"
cyy = "{0} N.s/m"
czz = "{0} N.s/m"
[[probe]]
name = "p"
at = "l:end"
[[crack]]
at = "l:end"
depth = "15 mm"
breathing = "{1}"
[[step]]
name = "u"
{2})",
                     damping, law, step);
}

}  // namespace

// Periods of the motion by Dormand and Prince to 1e-9 m, of two degrees of freedom whose shaft gives way by
// L^3/(48 E I) and, where the moment opens the crack, by c_xi L^2/16 more: with zeta = 0.01, at 0.49, 0.5 and
// a third of the critical speed. The kink at the crack is told by six harmonics of the moments; by six of
// the motion it was a ripple on a stiff element, and 2x and 3x backward were wrong by a factor of six and
// by a quarter.
TEST(Cracks, TheMultiplesOfAHingeAreThoseOfTheMotionInTime) {
  struct Case {
    double speed;
    const char* column;
    double amplitude;
  };
  const Case cases[] = {{188.03628258516727, "p 2x backward [m]", 1.401e-6},
                        {191.8737577399666, "p 2x backward [m]", 0.4025e-6},
                        {127.91583849331107, "p 3x backward [m]", 2.333e-6}};
  for (const Case& k : cases) {
    const DeckRun d(cracked_jeffcott(
        "hinge", 153.49900619197328,
        fmt::format("type = \"unbalance_response\"\nspeed = {{ values = [\"{:.14g} rad/s\"] }}\n",
                    k.speed)));
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_NEAR(d.csv("u_multiples.csv").last().at(k.column), k.amplitude, 0.03 * k.amplitude)
        << k.speed;
  }
}

// Largest of Floquet's multipliers of the same shaft, whose compliance is L^3/(48 E I) and d2W/dm2 L^2/16 at
// the moment of the weight: 0.870 1/s. The harmonics of the stiffness of a short element said none.
TEST(Cracks, TheGrowthOfOneThatFollowsItsMomentIsFloquets) {
  const DeckRun d(cracked_jeffcott(
      "response", 100, "type = \"stability\"\nspeed = { values = [\"3609.551056682821 rpm\"] }\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NEAR(d.csv("u_growth.csv").last().at("growth [1/s]"), 0.870, 0.05 * 0.870);
}
