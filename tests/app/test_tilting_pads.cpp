// Tilting-pad bearings through the program: case L4, keys, pads by themselves, messages, motion.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <cmath>

namespace {

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
