// Tilting-pad bearings through the program: case L4, keys, pads by themselves, messages, motion, and
// the compressor of example 28 with its pads in full and reduced to tables.
#include "deck_run.hpp"
#include "film_rotor.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <cmath>
#include <complex>

namespace {

using whirl::Vec2;
using whirl::test::Columns;
using whirl::test::DeckRun;

const std::string five_pads = R"(type = "tilting_pad"
diameter = "399.9992 mm"
length = "263.144 mm"
clearance = "194.564 um"
viscosity = "19.01574061 mPa.s"
preload = 0.3
)";
const std::string on_pad = "pads = 5\nfirst_pivot = \"54 deg\"\n";

/// A stiff rotor on two bearings that carry `load` along -z each, turning at 94.2477796 rad/s.
std::string rotor(const std::string& bearing, const std::string& steps,
                  const std::string& load = "-225629.814 N") {
  const auto end = [&](const char* name, const char* at) {
    return fmt::format("[[bearing]]\nname = \"{}\"\nat = \"{}\"\n{}\n", name, at, bearing);
  };
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "rigid"]
rows = [["a", 1000, 400, true], ["b", 1000, 400, true]]
[[bearing]]
name = "thrust"
at = "a:start"
type = "linear"
kxx = "10 MN/m"
cxx = "1e4 N.s/m"
[[load]]
at = "a:end"
force = ["0 N", "0 N", ")" +
         load + "\"]\n" + end("DE", "a:start") + end("NDE", "b:end") + steps +
         "[output]\nreport = false\n";
}
const std::filesystem::path compressor_folder =
    std::filesystem::path(WHIRL_SOURCE) / "examples" / "28_tilting_pads";
const std::string still =
    "[[step]]\nname = \"st\"\ntype = \"static\"\nspeed = \"94.2477796 rad/s\"\n";

struct Pads {
  Columns coefficients, pads, reduced, full;
  explicit Pads(const DeckRun& d)
      : coefficients(d.csv("st_coefficients.csv")),
        pads(d.csv("st_pads.csv")),
        reduced(d.csv("st_pad_coefficients.csv")),
        full(d.csv("st_full_coefficients.csv")) {}
  double at(const Columns& t, std::size_t row, const char* column) const {
    return t.rows.at(row).at(t.column(column));
  }
  double pad(std::size_t k, const char* column) const { return at(pads, k, column); }
  double of(const char* column) const { return at(coefficients, 0, column); }
};

/// Runs in one folder a test: what they wrote is read before the next one.
Pads pads_of(const std::string& deck) {
  const DeckRun d(deck);
  EXPECT_EQ(d.exit, 0) << d.log;
  return Pads(d);
}

}  // namespace

// Case L4: see test_tilting_pad.cpp.
TEST(TiltingPads, FivePadsLoadOnPad) {
  const DeckRun d(rotor(five_pads + on_pad + "frequency_ratios = [0, 0.5]\n", still));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Pads p(d);
  constexpr double cb = 194.564e-6;
  EXPECT_NEAR(p.of("z [m]") / cb, -0.61797, 0.0025);
  EXPECT_NEAR(p.of("y [m]") / cb, 0.0, 1e-6);
  EXPECT_NEAR(p.of("load [N]"), 112814.907, 0.2);
  ASSERT_EQ(p.pads.rows.size(), 10u);
  double sum_z = 0, power = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    const double pivot = p.pad(k, "pivot [deg]");
    EXPECT_NEAR(pivot, 54 + 72.0 * static_cast<double>(k), 1e-9);
    EXPECT_EQ(p.pad(k, "pad [-]"), static_cast<double>(k + 1));
    EXPECT_EQ(p.pad(k, "carries [-]"), k < 2 ? 0.0 : 1.0);
    EXPECT_NEAR(p.pad(k, "speed [rpm]"), 900, 1e-6);
    EXPECT_EQ(p.pad(k, "pivot compression [m]"), 0.0);
    // towards the pivot
    EXPECT_NEAR(p.pad(k, "pad eccentricity [-]"),
                (p.of("y [m]") * std::cos(pivot * M_PI / 180) +
                 p.of("z [m]") * std::sin(pivot * M_PI / 180)) /
                    cb,
                1e-9);
    sum_z += p.pad(k, "pad load [N]") * std::sin(pivot * M_PI / 180);
    power += p.pad(k, "power loss [W]");
    EXPECT_GT(p.pad(k, "smallest film [m]"), 5e-5);
  }
  EXPECT_NEAR(sum_z, -112814.907, 0.2);
  EXPECT_LT(std::abs(p.pad(0, "tilt [rad]")), 1e-2);
  // what the pads turn into heat is what the shaft is driven with
  const Columns supports = d.csv("st_supports.csv");
  EXPECT_NEAR(power, -94.2477796 * supports.rows.at(1).at(supports.column("M_x [N m]")),
              1e-3 * power);
  EXPECT_TRUE(d.says("pads 1, 2 carry nothing")) << d.log;
  // reduced at the frequencies asked for; the synchronous ones are those of the bearing
  EXPECT_EQ(p.at(p.reduced, 0, "frequency / speed [-]"), 1.0);
  EXPECT_NEAR(p.at(p.reduced, 2, "frequency [Hz]"), 7.5, 1e-6);
  for (const char* e : {"yy", "yz", "zy", "zz"}) {
    EXPECT_EQ(p.at(p.reduced, 0, fmt::format("reduced k{} [N/m]", e).c_str()),
              p.of(fmt::format("k{} [N/m]", e).c_str()));
    EXPECT_EQ(p.at(p.reduced, 0, fmt::format("reduced c{} [N s/m]", e).c_str()),
              p.of(fmt::format("c{} [N s/m]", e).c_str()));
  }
  EXPECT_LT(p.of("grid error [-]"), 1e-4);
  // a little more load, and less
  const double low = pads_of(rotor(five_pads + on_pad, still, "-225829.814 N")).of("z [m]"),
               high = pads_of(rotor(five_pads + on_pad, still, "-225429.814 N")).of("z [m]");
  EXPECT_NEAR(200 / (high - low) / p.at(p.reduced, 1, "reduced kzz [N/m]"), 1.0, 1e-4);
}

// A list of pads, one by one, is the equal ones; bearing and load turned by 90 deg.
// Which pads carry nothing is said by every step that has an equilibrium, and where a pad that carries
// little has another balance.
TEST(TiltingPads, PadsThatCarryNothingAreNamedByEveryStep) {
  const DeckRun d(
      rotor(five_pads + on_pad, still + "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 2\n"
                                        "speed = \"94.2477796 rad/s\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("m: bearing 'DE' at 900 rpm: pads 1, 2 carry nothing")) << d.log;
  EXPECT_EQ(d.summary("m").at("unloaded pads").items().size(), 2u);
  std::string leaning = rotor(five_pads + on_pad, still);
  const std::string straight = "\"0 N\", \"0 N\", \"-225629.814 N\"";
  leaning.replace(leaning.find(straight), straight.size(),
                  "\"0 N\", \"41117.767721 N\", \"-221851.621908 N\"");
  const DeckRun two(leaning);
  ASSERT_EQ(two.exit, 0) << two.log;
  // without load at that pad the equilibrium repels
  EXPECT_FALSE(two.says("W08")) << two.log;
  EXPECT_TRUE(
      two.says("pad 1 carries 1103 N, and in another balance with the journal where it is nothing"))
      << two.log;
  EXPECT_FALSE(two.says("pad 5 carries")) << two.log;
}

TEST(TiltingPads, PadsByThemselvesAndTurned) {
  std::string list = "arc = \"60 deg\"\n";
  for (int k = 0; k < 5; ++k)
    list += fmt::format("[[bearing.pad]]\npivot = \"{} deg\"\n", 54 + 72 * k);
  const Pads one = pads_of(rotor(five_pads + on_pad, still));
  const double k = one.of("kzz [N/m]");
  {
    const DeckRun d(rotor(five_pads + list, still));
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_NEAR(Pads(d).of("kzz [N/m]"), k, 1e-9 * k);
    // the resolved deck is the same again
    std::ostringstream resolved;
    resolved << std::ifstream(d.folder / "r" / "resolved.toml").rdbuf();
    EXPECT_NEAR(pads_of(resolved.str()).of("kzz [N/m]"), k, 1e-9 * k);
  }
  std::string deck = rotor(five_pads + "first_pivot = \"144 deg\"\n", still);
  const std::string along_z = "\"0 N\", \"0 N\", \"-225629.814 N\"";
  deck.replace(deck.find(along_z), along_z.size(), "\"0 N\", \"225629.814 N\", \"0 N\"");
  const Pads turned = pads_of(deck);
  EXPECT_NEAR(turned.of("kyy [N/m]"), k, 1e-6 * k);
  EXPECT_NEAR(turned.of("y [m]"), -one.of("z [m]"), 1e-10);
}

// Every key does what it says.
TEST(TiltingPads, Keys) {
  const auto with = [](const std::string& more) { return rotor(five_pads + on_pad + more, still); };
  const Pads plain = pads_of(with(""));
  {  // pivots: compression is load over stiffness, and the full matrices hold what was given
    const Pads p =
        pads_of(with("pivot_stiffness = \"2e9 N/m\"\npivot_damping = \"3e5 N.s/m\"\nmass = \"7 "
                     "kg\"\ninertia = \"0.11 kg.m^2\"\n"));
    EXPECT_NEAR(p.pad(3, "pivot compression [m]"), p.pad(3, "pad load [N]") / 2e9, 1e-12);
    EXPECT_LT(p.of("kzz [N/m]"), plain.of("kzz [N/m]"));
    std::vector<double> masses;
    for (const auto& row : p.full.rows)
      if (const double m = row.at(p.full.column("full m [kg]")); m != 0) masses.push_back(m);
    ASSERT_EQ(masses.size(), 20u);
    EXPECT_EQ(masses[0], 0.11);
    EXPECT_EQ(masses[1], 7.0);
    // the last entry of a bearing is that of an unloaded or loaded pivot against itself
    const Pads q =
        pads_of(with("pivot_stiffness = \"2e9 N/m\"\npivot_damping = \"4e5 N.s/m\"\nmass = \"7 "
                     "kg\"\ninertia = \"0.11 kg.m^2\"\n"));
    EXPECT_NEAR(q.at(q.full, q.full.rows.size() - 1, "full c [N s/m]") -
                    p.at(p.full, p.full.rows.size() - 1, "full c [N s/m]"),
                1e5, 1.0);
    EXPECT_GT(p.at(p.full, p.full.rows.size() - 1, "full k [N/m]"), 1.9e9);
  }
  {  // the pivot further out: the pad's centre stands where it did
    const Pads p = pads_of(with("thickness = \"200 mm\"\n"));
    const double arm = 0.1999996 + 194.564e-6 / 0.7;
    EXPECT_NEAR(p.pad(3, "tilt [rad]") * (arm + 0.2), plain.pad(3, "tilt [rad]") * arm, 1e-8);
    EXPECT_NEAR(p.of("kzz [N/m]"), plain.of("kzz [N/m]"), 1e-5 * plain.of("kzz [N/m]"));
  }
  {  // flexures: pads that hardly turn are lobes
    const Pads p = pads_of(with("tilt_stiffness = \"1e12 N.m/rad\"\n"));
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_LT(std::abs(p.pad(k, "tilt [rad]")), 1e-7);
    EXPECT_GT(std::abs(p.of("kyz [N/m]")), 0.02 * p.of("kzz [N/m]"));
  }
  // a finer grid is nearer to the finest
  EXPECT_LE(pads_of(with("grid = 144\n")).of("grid error [-]"), plain.of("grid error [-]"));
  // smaller pads carry less, pivots behind the middle more: the journal runs lower, higher
  EXPECT_LT(pads_of(with("arc = \"45 deg\"\n")).of("z [m]"), plain.of("z [m]"));
  EXPECT_GT(pads_of(with("offset = 0.6\n")).of("z [m]"), plain.of("z [m]"));
  // without preload the pads beside the loaded one carry less
  const Pads loose = pads_of(rotor(five_pads.substr(0, five_pads.find("preload")) + on_pad, still));
  EXPECT_LT(loose.pad(2, "pad load [N]"), 0.9 * plain.pad(2, "pad load [N]"));
}

// Hertz: a ball of radius r in a seat of radius s takes 4/3 E* sqrt(R) xi^(3/2), 1/R = 1/r - 1/s, E* =
// E/(2 (1 - nu^2)). Palmgren: a line of steel takes 8.06e4 l^(8/9) xi^(10/9) N, in mm.
TEST(TiltingPads, ContactsTakeTheirLoad) {
  const auto with = [](const std::string& more) {
    return pads_of(rotor(five_pads + on_pad + more, still));
  };
  const auto pressed = [](const Pads& p) { return p.pad(3, "pivot compression [m]"); };
  const auto load = [](const Pads& p) { return p.pad(3, "pad load [N]"); };
  const std::string ball = "pivot_contact = { shape = \"ball\", radius = \"190 mm\"";
  const auto hertz = [](double E, double nu, double radius, double xi) {
    return 4.0 / 3.0 * E / (2 * (1 - nu * nu)) * std::sqrt(radius) * std::pow(xi, 1.5);
  };
  const Pads seat = with(ball + ", seat_radius = \"200 mm\" }\n"), flat = with(ball + " }\n"),
             soft = with(ball + ", E = \"100 GPa\", nu = 0.2 }\n"),
             line = with("pivot_contact = { shape = \"line\" }\n"),
             brief = with("pivot_contact = { shape = \"line\", length = \"100 mm\" }\n");
  EXPECT_NEAR(hertz(210e9, 0.3, 3.8, pressed(seat)), load(seat), 1e-6 * load(seat));
  EXPECT_NEAR(hertz(210e9, 0.3, 0.19, pressed(flat)), load(flat), 1e-6 * load(flat));
  EXPECT_NEAR(hertz(100e9, 0.2, 0.19, pressed(soft)), load(soft), 1e-6 * load(soft));
  const auto palmgren = [](double length, double xi) {
    return 8.06e4 * std::pow(1e3 * length, 8.0 / 9) * std::pow(1e3 * xi, 10.0 / 9);
  };
  EXPECT_NEAR(palmgren(0.263144, pressed(line)), load(line), 1e-6 * load(line));
  EXPECT_NEAR(palmgren(0.1, pressed(brief)), load(brief), 1e-6 * load(brief));
  // its slope is what the small motions see: that of an elastic pivot as stiff as it is there
  const double slope = 1.5 * load(flat) / pressed(flat);
  EXPECT_GT(flat.of("kzz [N/m]"), soft.of("kzz [N/m]"));
  const Pads rigid = with("");
  EXPECT_LT(flat.of("kzz [N/m]"), rigid.of("kzz [N/m]"));
  EXPECT_GT(slope, flat.of("kzz [N/m]"));
  // a pad that carries nothing is not pressed
  EXPECT_LT(std::abs(flat.pad(0, "pivot compression [m]")), 1e-3 * pressed(flat));
}

TEST(TiltingPads, AMotionOnBallsStaysInTheEquilibrium) {
  const DeckRun d(
      rotor(five_pads + on_pad + "pivot_contact = { shape = \"ball\", radius = \"190 mm\" }\n",
            "[[drive]]\nname = \"motor\"\nat = \"a:start\"\ntype = \"speed\"\nspeed = "
            "\"94.2477796 rad/s\"\n[[probe]]\nname = \"P\"\nat = \"a:start\"\n" +
                still +
                "[[step]]\nname = \"t\"\ntype = \"transient\"\nstart = \"static\"\n"
                "duration = \"0.05 s\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const double rest = Pads(d).of("z [m]");
  EXPECT_NEAR(d.csv("t.csv").last().at("P.z [m]"), rest, 1e-6 * std::abs(rest));
}

TEST(TiltingPads, ContactsThatCannotBe) {
  const auto refused = [](const std::string& more, const char* code, const char* word) {
    const DeckRun d(rotor(five_pads + on_pad + more, still));
    EXPECT_NE(d.exit, 0);
    EXPECT_TRUE(d.says(code) && d.says(word)) << d.log;
  };
  refused("pivot_contact = { shape = \"ball\", radius = \"20 mm\", seat_radius = \"20 mm\" }\n",
          "E14", "does not fit");
  refused("pivot_stiffness = \"1e9 N/m\"\npivot_contact = { shape = \"line\" }\n", "E26",
          "contact");
}

// The motion from rest ends where statics say, and one that begins there stays: with pads that follow
// at once, and with inertia on elastic pivots.
TEST(TiltingPads, MotionEndsInTheEquilibrium) {
  const auto deck = [](const std::string& more, const std::string& start) {
    return rotor(five_pads + on_pad + more,
                 "[[drive]]\nname = \"motor\"\nat = \"a:start\"\ntype = \"speed\"\nspeed = "
                 "\"94.2477796 rad/s\"\n[[probe]]\nname = \"P\"\nat = \"a:start\"\n" +
                     still + "[[step]]\nname = \"t\"\ntype = \"transient\"\n" + start);
  };
  const auto ends = [&](const std::string& more, const std::string& start, double tolerance) {
    const DeckRun d(deck(more, start));
    ASSERT_EQ(d.exit, 0) << d.log;
    const double rest = Pads(d).of("z [m]");
    EXPECT_NEAR(d.csv("t.csv").last().at("P.z [m]"), rest, tolerance * std::abs(rest)) << more;
  };
  const std::string with_inertia =
      "inertia = \"0.3 kg.m^2\"\nmass = \"20 kg\"\npivot_stiffness = \"5e9 N/m\"\n"
      "pivot_damping = \"1e6 N.s/m\"\n";
  ends("", "start = \"rest\"\nduration = \"1 s\"\n", 1e-4);
  ends("", "start = \"static\"\nduration = \"0.05 s\"\n", 1e-7);
  ends(with_inertia, "start = \"static\"\nduration = \"0.05 s\"\n", 1e-7);
}

// Oil under pressure at the edges of pads that carry little has equilibria that repel: Newton's method ended in
// one of them, the journal above the middle under its weight. The static step finds the one in which a motion
// comes to rest.
TEST(TiltingPads, SuppliedUnderPressureAreFoundWhereTheySettle) {
  const std::string bearing = R"(type = "tilting_pad"
diameter = "120 mm"
length = "70 mm"
clearance = "100 um"
pads = 5
offset = 0.6
first_pivot = "-70 deg"
arc = "58 deg"
preload = 0.3
viscosity = "20 mPa.s"
supply_pressure = "1 bar"
inertia = "2e-3 kg.m^2"
)";
  const std::string speed = "speed = \"6000 rpm\"\n";
  const DeckRun d(
      rotor(bearing,
            "[[probe]]\nname = \"P\"\nat = \"a:start\"\n[[drive]]\nname = \"v\"\nat = "
            "\"a:start\"\ntype = \"speed\"\nstep = \"t\"\n" +
                speed + "[[step]]\nname = \"st\"\ntype = \"static\"\n" + speed +
                "[[step]]\nname = \"t\"\ntype = \"transient\"\nstart = \"rest\"\nduration = "
                "\"0.5 s\"\ninitial_speed = \"6000 rpm\"\n",
            "-7845 N"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("W08")) << d.log;
  const double z = Pads(d).of("z [m]");
  EXPECT_LT(z, 0.0);
  EXPECT_NEAR(d.csv("t.csv").last().at("P.z [m]"), z, 1e-3 * std::abs(z)) << d.log;
}

// Beyond some tilt such a pad turns until it touches: it works in the balance that rights it, which changes
// with the pressure by little, and the rotor is as stable as without.
TEST(TiltingPads, SuppliedUnderPressureWorkWhereTheyRightThemselves) {
  const auto pads = [](const char* pressure) {
    return fmt::format(R"(type = "tilting_pad"
pads = 5
first_pivot = "-90 deg"
arc = "60 deg"
offset = 0.6
preload = 0.2
diameter = "100 mm"
length = "50 mm"
clearance = "80 um"
viscosity = "18 mPa.s"
supply_pressure = "{} bar"
)",
                       pressure);
  };
  const std::string steps = R"([[step]]
name = "st"
type = "static"
speed = "6000 rpm"
[[step]]
name = "m"
type = "modal"
speed = "6000 rpm"
modes = 6
motion = "lateral"
)";
  double place = 0;
  for (const char* pressure : {"0", "1.2", "2"}) {
    const DeckRun d(whirl::test::film_rotor(pads(pressure), 6000, steps));
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_FALSE(d.says("W08")) << d.log;
    EXPECT_FALSE(d.says("diverging")) << pressure << d.log;
    const Pads found(d);
    const double z = found.of("z [m]");
    if (place == 0) place = z;
    EXPECT_NEAR(z, place, 0.06 * std::abs(place)) << pressure;
    for (const auto& row : found.pads.rows)
      EXPECT_GT(row.at(found.pads.column("pad load [N]")), 0.0) << pressure;
  }
}

// The spring that lays an unloaded pad carried the rotor, 4 km away.
TEST(TiltingPads, ALoadThatNoPadFacesIsRefused) {
  std::string bearing = R"(type = "tilting_pad"
diameter = "100 mm"
length = "50 mm"
clearance = "50 um"
viscosity = "20 mPa.s"
)";
  for (const char* pivot : {"0", "90", "180"})
    bearing += fmt::format("[[bearing.pad]]\npivot = \"{} deg\"\narc = \"60 deg\"\n", pivot);
  const DeckRun d(whirl::test::film_rotor(
      bearing, 250, "[[step]]\nname = \"st\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n"));
  EXPECT_EQ(d.exit, 4) << d.log;
  EXPECT_TRUE(d.says("E76")) << d.log;
}

// Twenty speeds, from light to heavy loads, each with its equilibrium.
TEST(TiltingPads, TableOverSpeeds) {
  for (const char* load : {"-2000 N", "-225629.814 N", "-700000 N"}) {
    const DeckRun d(rotor(five_pads + on_pad,
                          "[[step]]\nname = \"st\"\ntype = \"static\"\nspeeds = { start = \"300 "
                          "rpm\", stop = \"3000 rpm\", points = 20 }\n",
                          load));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns c = d.csv("st_coefficients.csv");
    ASSERT_EQ(c.rows.size(), 40u) << load;
    for (std::size_t k = 0; k < 40; ++k) {
      EXPECT_LT(c.rows[k].at(c.column("z [m]")), 0);
      EXPECT_GT(c.rows[k].at(c.column("kzz [N/m]")), 0);
      EXPECT_GT(c.rows[k].at(c.column("cyy [N s/m]")), 0);
    }
    EXPECT_EQ(d.csv("st_pads.csv").rows.size(), 200u);
  }
}

namespace {

/// A deck of example 28 without its steps.
std::string compressor(const char* deck) {
  std::ostringstream text;
  text << std::ifstream(compressor_folder / deck).rdbuf();
  const std::string all = text.str();
  return all.substr(0, all.find("[[step]]"));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t found = 0;
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
    ++found;
  }
  EXPECT_GT(found, 0u) << from;
  return text;
}

/// The first mode of a list that whirls forward.
std::map<std::string, double> first_forward(const Columns& modes) {
  for (const auto& row : modes.rows) {
    const auto m = modes.named(row);
    if (m.at("forwardness [-]") > 0) return m;
  }
  throw std::runtime_error("no forward mode");
}

const std::string modes_at_rated =
    "[[step]]\nname = \"modes\"\ntype = \"modal\"\nspeed = \"9000 rpm\"\nmodes = 8\n"
    "motion = \"lateral\"\n";

}  // namespace

// Example 28: its table is what deck.toml writes. What turns with the spin, the unbalance response, is
// that of the pads in full to the table's interpolation; what whirls below it is not.
TEST(TiltingPads, ReducedCoefficientsHoldForWhatTurnsWithTheSpin) {
  const DeckRun full(compressor("deck.toml") + R"([[step]]
name = "films"
type = "static"
speeds = { start = "3000 rpm", stop = "12000 rpm", points = 19 }
[[step]]
name = "unbalance"
type = "unbalance_response"
speed = { start = "3000 rpm", stop = "12000 rpm", points = 91, refine = "peaks" }
)" + modes_at_rated + "[output]\nreport = false\n");
  ASSERT_EQ(full.exit, 0) << full.log;
  const DeckRun reduced(compressor_folder / "tables.toml");
  ASSERT_EQ(reduced.exit, 0) << reduced.log;

  const Columns table(compressor_folder / "pads.csv"), films = full.csv("films_coefficients.csv");
  ASSERT_EQ(films.rows.size(), 2 * table.rows.size());
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const auto& made = films.rows[2 * k];
    EXPECT_NEAR(table.rows[k][0], made[films.column("speed [rpm]")], 1e-6);
    for (const std::string part : {"k", "c"})
      for (const char* e : {"yy", "yz", "zy", "zz"}) {
        const std::string unit = part == "k" ? "N/m" : "N.s/m";
        EXPECT_NEAR(table.rows[k][table.column(part + e + "[" + unit + "]")],
                    made[films.column(part + e + (part == "k" ? " [N/m]" : " [N s/m]"))],
                    1e-6 * made[films.column(part == "k" ? "kzz [N/m]" : "czz [N s/m]")])
            << part << e << " at " << table.rows[k][0];
      }
  }

  const Columns a = full.csv("unbalance_response.csv"), b = reduced.csv("unbalance_response.csv");
  std::size_t compared = 0;
  for (const char* name : {"mid span y", "mid span z"}) {
    const auto motion = [&](const Columns& c, const std::vector<double>& row) {
      return std::polar(row[c.column(name + std::string(" amplitude [m]"))],
                        -M_PI / 180 * row[c.column(name + std::string(" phase lag [deg]"))]);
    };
    double largest = 0, worst = 0;
    for (const auto& row : a.rows)
      for (const auto& other : b.rows) {
        if (std::abs(row[0] - other[0]) > 1e-6) continue;
        ++compared;
        largest = std::max(largest, std::abs(motion(a, row)));
        worst = std::max(worst, std::abs(motion(a, row) - motion(b, other)));
      }
    EXPECT_LT(worst, 1e-4 * largest) << name;
  }
  EXPECT_GE(compared, 2u * 91u);
  const auto peak = full.csv("unbalance_peaks.csv").last(),
             same = reduced.csv("unbalance_peaks.csv").last();
  EXPECT_NEAR(peak.at("amplitude [m]"), 9.774e-6, 1e-9);
  EXPECT_NEAR(same.at("amplitude [m]"), peak.at("amplitude [m]"), 6e-5 * peak.at("amplitude [m]"));
  EXPECT_NEAR(same.at("speed [rpm]"), peak.at("speed [rpm]"), 6e-5 * peak.at("speed [rpm]"));

  const auto whirl = first_forward(full.csv("modes_modes.csv")),
             promised = first_forward(reduced.csv("modes_modes.csv"));
  EXPECT_NEAR(whirl.at("frequency [Hz]"), 95.53, 0.1);
  EXPECT_NEAR(promised.at("frequency [Hz]"), 99.15, 0.1);
  EXPECT_NEAR(whirl.at("log decrement [-]"), 0.835, 0.01 * 0.835);
  EXPECT_NEAR(promised.at("log decrement [-]"), 1.517, 0.01 * 1.517);
}

// Cross coupling of 26.4 MN/m makes the pads' rotor unstable; the table holds it stable to 38.9.
TEST(TiltingPads, ReducedCoefficientsPromiseAStableRotor) {
  const auto decrement = [](const char* deck, const char* k) {
    std::string text = replaced(compressor(deck), "k = \"4e6 N/m\"", fmt::format("k = \"{}\"", k));
    if (deck == std::string("tables.toml"))
      text = replaced(text, "\"pads.csv\"", '"' + (compressor_folder / "pads.csv").string() + '"');
    const DeckRun d(text + modes_at_rated + "[output]\nreport = false\n");
    EXPECT_EQ(d.exit, 0) << d.log;
    return first_forward(d.csv("modes_modes.csv")).at("log decrement [-]");
  };
  EXPECT_GT(decrement("deck.toml", "26.2 MN/m"), 0);
  EXPECT_LT(decrement("deck.toml", "26.6 MN/m"), 0);
  EXPECT_GT(decrement("tables.toml", "38.7 MN/m"), 0);
  EXPECT_LT(decrement("tables.toml", "39.1 MN/m"), 0);
}

// A transient on the films that are the default (cavitation = "reynolds") settles in the orbit of the
// unbalance response, small against the film: radii and phases, by the Fourier sum over the last turn.
TEST(TiltingPads, MotionSettlesInTheOrbitOfItsResponse) {
  const DeckRun d(replaced(compressor("deck.toml"), "\"900 g.mm\"", "\"90 g.mm\"") + R"([[drive]]
name = "motor"
at = "de:start"
type = "speed"
speed = "4000 rpm"
[[step]]
name = "t"
type = "transient"
start = "static"
duration = "0.3 s"
integrator = { tolerance = 1e-5 }
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["4000 rpm"] }
[output]
report = false
every = "1 ms"
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("t.csv");
  const auto response = d.csv("u_response.csv").last();
  constexpr std::size_t rows_a_turn = 15;
  ASSERT_GT(t.rows.size(), rows_a_turn);
  for (const std::string axis : {"y", "z"}) {
    std::complex<double> sum = 0;
    for (std::size_t k = t.rows.size() - rows_a_turn; k < t.rows.size(); ++k)
      sum += t.rows[k][t.column("mid span." + axis + " [m]")] *
             std::polar(1.0, -t.rows[k][t.column("phi [rad]")]);
    const double radius = response.at("mid span " + axis + " amplitude [m]");
    const auto expected =
        std::polar(radius, -M_PI / 180 * response.at("mid span " + axis + " phase lag [deg]"));
    EXPECT_GT(radius, 2e-7);
    EXPECT_LT(std::abs(2.0 / rows_a_turn * sum - expected), 1e-4 * radius) << axis;
  }
}

namespace {

/// A rigid rotor of 400 kg on the bearings of docs/elements/tilting_pads.md. more: keys of both.
std::string documented(const std::string& more, const std::string& rest) {
  const auto end = [&](const char* name, const char* at) {
    return fmt::format(R"([[bearing]]
name = "{}"
at = "body:{}"
type = "tilting_pad"
first_pivot = "-54 deg"
preload = 0.3
diameter = "100 mm"
length = "50 mm"
clearance = "80 um"
iso_vg = 32
temperature = "55 degC"
{}
)",
                       name, at, more);
  };
  return R"(format = 1
[model]
gravity = "9.81 m/s^2"
[[shaft]]
name = "rotor"
[[shaft.section]]
name = "body"
length = "1 m"
rigid = true
[[disk]]
name = "mass"
at = "body:mid"
mass = "400 kg"
Ip = "5 kg.m^2"
Id = "20 kg.m^2"
[[bearing]]
name = "thrust"
at = "body:start"
type = "linear"
kxx = "1e8 N/m"
[[probe]]
name = "DE"
at = "body:start"
)" + end("DE", "start") +
         end("NDE", "end") + rest + "[output]\nevery = \"0.1 ms\"\nreport = false\n";
}

struct Journal {
  std::vector<Vec2> at;  ///< (y, z), m
  double newton;
};
Journal journal_of(const std::string& deck) {
  const DeckRun d(deck);
  EXPECT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("run.csv");
  Journal out;
  for (const auto& row : t.rows)
    out.at.emplace_back(row[t.column("DE.y [m]")], row[t.column("DE.z [m]")]);
  out.newton = d.summary("run").at("integrator").at("Newton iterations").number();
  return out;
}
/// The largest way between two motions over the clearance.
double apart(const Journal& a, const Journal& b) {
  EXPECT_EQ(a.at.size(), b.at.size());
  double worst = 0.0;
  for (std::size_t k = 0; k < std::min(a.at.size(), b.at.size()); ++k)
    worst = std::max(worst, (a.at[k] - b.at[k]).norm() / 80e-6);
  return worst;
}

}  // namespace

namespace {

const std::string orbit = R"([[unbalance]]
at = "mass"
amount = "20 kg.mm"
[[drive]]
name = "m"
at = "body:mid"
type = "speed"
speed = "6000 rpm"
[[step]]
name = "run"
type = "transient"
duration = "0.05 s"
start = "static"
)";

}  // namespace

// Half of the clearance, round which every pad loses its load once a turn. A pad without inertia moves as
// ones with ever less do, the nearer.
TEST(TiltingPads, MasslessPadsLoseTheirLoadInMotion) {
  const Journal none = journal_of(documented("", orbit));
  EXPECT_LT(none.newton, 2e4);
  double largest = 0.0;
  for (const Vec2& place : none.at)
    largest = std::max(largest, place.norm() / 80e-6);
  EXPECT_GT(largest, 0.5);
  const double some = apart(none, journal_of(documented("inertia = \"1.2e-4 kg.m^2\"\n", orbit))),
               less = apart(none, journal_of(documented("inertia = \"3e-5 kg.m^2\"\n", orbit)));
  EXPECT_LT(some, 0.05);
  EXPECT_LT(less, 0.7 * some);
}

// Where no step is possible pads that move as they please are named.
TEST(TiltingPads, MasslessPadsThatStopAStepAreNamed) {
  const std::string coarse = orbit + "integrator = { dt_min = \"0.001 ms\" }\n";
  const DeckRun d(documented("", coarse));
  EXPECT_NE(d.exit, 0);
  EXPECT_TRUE(d.says("error[R10]") && d.says("of bearing 'DE', which carries") &&
              d.says("give its bearing inertia"))
      << d.log;
  const DeckRun heavy(documented("inertia = \"1.2e-4 kg.m^2\"", coarse));
  EXPECT_FALSE(heavy.says("give its bearing inertia")) << heavy.log;
}

// At rest no film says where a pad stands; the rotor falls into its bearings and is run up.
TEST(TiltingPads, MasslessPadsStartFromStandstill) {
  const std::string up = R"([[drive]]
name = "m"
at = "body:mid"
type = "speed"
speed = { type = "ramp", time = ["0 s", "0.4 s"], value = ["0 rpm", "3000 rpm"] }
[[step]]
name = "run"
type = "transient"
duration = "0.6 s"
start = "rest"
)";
  const Journal none = journal_of(documented("", up));
  EXPECT_LT(none.newton, 2e4);
  EXPECT_LT(apart(none, journal_of(documented("inertia = \"3e-5 kg.m^2\"\n", up))), 0.06);
}

TEST(TiltingPads, BadInput) {
  const auto fails = [](std::string bearing, const char* code, const char* text,
                        const char* load = "-225629.814 N") {
    const DeckRun d(rotor(bearing, still, load));
    EXPECT_NE(d.exit, 0) << bearing;
    EXPECT_TRUE(d.says(code) && d.says(text)) << d.log;
  };
  const auto changed = [](const char* from, const char* to) {
    std::string text = five_pads + on_pad;
    return text.replace(text.find(from), std::string(from).size(), to);
  };
  fails(changed("\"194.564 um\"", "\"0 um\""), "error[", "clearance");
  fails(changed("\"194.564 um\"", "\"-5 um\""), "error[", "clearance");
  fails(changed("preload = 0.3", "preload = 1"), "error[", "preload");
  fails(five_pads + on_pad + "arc = \"73 deg\"\n", "error[E14]", "overlap by 1");
  fails(five_pads + on_pad + "offset = 1.2\n", "error[", "offset");
  fails(five_pads + on_pad + "mass = \"1 kg\"\n", "error[E05]", "pivot_stiffness");
  fails(five_pads + on_pad + "[[bearing.pad]]\npivot = \"-90 deg\"\n", "error[E26]",
        "by themselves");
  fails(five_pads + "[[bearing.pad]]\npivot = \"-90 deg\"\n[[bearing.pad]]\npivot = \"-80 deg\"\n",
        "error[E14]", "pads 1 and 2 overlap");
  // too much for it: bearing, load, capacity, pad, eccentricity
  const DeckRun heavy(rotor(five_pads + on_pad, still, "-9e7 N"));
  EXPECT_EQ(heavy.exit, 0);
  EXPECT_TRUE(heavy.says("W03") && heavy.says("carrying 4.5e+07 N") &&
              heavy.says("where it carries about") && heavy.says("pad 4 carries") &&
              heavy.says("at eccentricity 0.993"))
      << heavy.log;
  // pivots at the start of the pads: nothing balances there
  fails(five_pads + on_pad + "offset = 0\n", "error[E75]", "pad 1 carries 0 N");
}
