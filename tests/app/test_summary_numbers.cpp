// What summary.json and `check --json` say, key by key: the value from a closed form, and where that
// comes from. The decks are those of test_written_numbers.cpp.
#include "deck_run.hpp"
#include "written_decks.hpp"

#include <core/types.hpp>

#include <algorithm>
#include <cmath>

namespace {

using namespace whirl;
using io::Value;
using test::Columns;
using test::DeckRun;

/// Of text like "steps > st > support forces [N] > wall > 1"; null where there is none.
Value value_at(Value v, const std::string& path) {
  const std::string part = " > ";
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find(part, begin), path.size());
    const std::string key = path.substr(begin, end - begin);
    if (v.is_array()) {
      const std::size_t k = std::stoul(key);
      v = k < v.items().size() ? Value(v.items()[k]) : Value();
    } else {
      v = v.is_object() ? Value(v.at(key)) : Value();
    }
    begin = end + part.size();
  }
  return v;
}

/// NaN where there is no number; true and false are 1 and 0.
double number_at(const Value& all, const std::string& path) {
  const Value v = value_at(all, path);
  if (v.is_number()) return v.number();
  const bool other = v.is_null() || v.is_text() || v.is_array() || v.is_object();
  return other ? std::nan("") : v.boolean() ? 1.0 : 0.0;
}

struct Number {
  const char* deck;
  const char* path;
  double expected, tolerance;
  const char* why;
};

const Number numbers[] = {
    {"cantilever", "model > nodes", 5, 0, "four elements"},
    {"cantilever", "model > elements", 4, 0, "asked for"},
    {"cantilever", "model > unknowns", 24, 0, "six of each node but the held one"},
    {"cantilever", "model > batches > shaft elements", 4, 0, "asked for"},
    {"cantilever", "model > batches > forces", 1, 0, "one"},
    {"arms at rest", "model > batches > rigid disks", 3, 0, "three"},
    {"laden rectangle", "model > batches > general beam elements", 16, 0, "asked for"},
    {"arms at rest", "model > unknowns", 4, 0, "one angle, two, one slide"},
    {"campbell", "model > unknowns", 3, 0, "a place across and a twist"},
    // resultants of 200 N and 50 N at the end of 1 m; the axial force is that of the slope
    {"cantilever", "steps > st > largest > r > shear force [N]", 206.1552812809, 1e-3, "resultant"},
    {"cantilever", "steps > st > largest > r > bending moment [N m]", 206.1552812809, 1e-3, "F L"},
    {"cantilever", "steps > st > largest > r > bending moment at [m]", 0, 1e-12, "the wall"},
    {"cantilever", "steps > st > largest > r > axial force [N]", 0.32984, 1e-4, "F^2 L^2/(2 E I)"},
    {"cantilever", "steps > st > largest > r > axial force at [m]", 1, 1e-12, "the steepest"},
    {"cantilever", "steps > st > largest > r > bending stress [Pa]", 16799043.61, 50,
     "32 M/(pi d^3)"},
    {"cantilever", "steps > st > largest > r > bending stress at [m]", 0, 1e-12, "the wall"},
    {"cantilever", "steps > st > largest > r > axial stress [Pa]", 167.99, 0.1, "N/A"},
    {"cantilever", "steps > st > largest > r > axial stress at [m]", 1, 1e-12, "the steepest"},
    {"cantilever", "steps > st > largest > r > von Mises stress [Pa]", 16799043.61, 50, "bending"},
    {"cantilever", "steps > st > largest > r > von Mises stress at [m]", 0, 1e-12, "the wall"},
    {"cantilever", "steps > st > support forces [N] > wall > 1", -200, 1e-6, "reaction"},
    {"cantilever", "steps > st > support forces [N] > wall > 2", -50, 1e-6, "reaction"},
    {"cantilever", "steps > st > support moments [N m] > wall > 1", 50, 1e-3, "F_z L"},
    {"cantilever", "steps > st > support moments [N m] > wall > 2", -200, 1e-3, "-F_y L"},
    {"cantilever", "steps > st > mesh > elements", 4, 0, "asked for"},
    {"cantilever", "steps > st > speed [rpm]", 0, 0, "at rest"},
    // 42.824 um and 20.602 um
    {"short rectangle", "steps > st > deflection > r > largest [m]", 4.752196987e-5, 5e-11, "both"},
    {"short rectangle", "steps > st > deflection > r > at [m]", 0.2, 1e-12, "the tip"},
    {"short rectangle", "steps > st > elastic energy [J]", 0.0317129630, 5e-8, "F u/2"},
    // hinge 0.01922726 rad on 1000 N m/rad, slide 30 mm on 2000 N/m; the arm along (100, 30, 40) N
    {"arms at rest", "steps > st > elastic energy [J]", 1.0848437677, 1e-9, "of both springs"},
    {"arms at rest", "steps > st > deflection > h > largest [m]", 0.0076904302, 1e-9,
     "0.4 m sin a"},
    {"arms at rest", "steps > st > deflection > h > at [m]", 0.4, 1e-12, "its end"},
    {"arms at rest", "steps > st > deflection > u > largest [m]", 0.1788854382, 1e-9,
     "0.4 m 50/111.8"},
    {"arms at rest", "steps > st > deflection > u > largest displacement [m]", 0.1838023364, 1e-9,
     "0.8 m sin of half the angle"},
    {"arms at rest", "steps > st > deflection > s > largest [m]", 0.03, 1e-12, "F/k"},
    {"arms at rest", "steps > st > joint forces [N] > U > 0", -100, 1e-6, "weight"},
    {"arms at rest", "steps > st > joint forces [N] > U > 1", -30, 1e-6, "the load"},
    {"arms at rest", "steps > st > joint forces [N] > S > 2", -60, 1e-6, "the load"},
    {"arms at rest", "steps > st > stability > stable", 1, 0, "springs and weights"},
    {"arms at rest", "steps > st > stability > unstable directions", 0, 0, "springs and weights"},
    {"arms at rest", "steps > t > energy > stored at start [J]", 5.3151496506, 1e-8,
     "of the springs, and the weights lifted by 0.4 m (1 - cos)"},
    {"arms at rest", "steps > t > largest tilt > |gamma| [rad]", 0.4636476090, 1e-9, "atan 50/100"},
    {"arms at rest", "steps > t > peaks > disk du > amplitude 0-peak [m]", 0.1788854382, 1e-9,
     "as above"},
    {"arms at rest", "steps > t > peaks > disk ds > motion 0-peak [m]", 0, 1e-9, "it rests"},
    {"arms at rest", "steps > t > t_end [s]", 1e-3, 1e-15, "asked for"},
    // 1 N m for 1 s on 0.1 kg m^2
    {"events", "steps > t > energy > stored at start [J]", 0, 1e-12, "at rest"},
    {"events", "steps > t > energy > stored at end [J]", 5, 1e-8, "Ip w^2/2"},
    {"events", "steps > t > energy > supplied [J]", 5, 1e-8, "T phi"},
    {"events", "steps > t > energy > dissipated [J]", 0, 1e-12, "nothing does"},
    {"events", "steps > t > events", 1, 0, "passes once"},
    {"events", "steps > t > integrator > tolerance", 1e-8, 1e-20, "asked for"},
    {"events", "steps > t > accuracy > aimed at, of the peak response", 1e-8, 1e-20, "asked for"},
    {"events", "steps > t > largest tilt > condition of (phi', gamma') -> omega", 1, 1e-12,
     "untilted"},
    // 1 kN steps on; stopped at 1.2 mm
    {"limited", "steps > t > t_end [s]", 6.0575050235066e-3, 1e-9, "the first passage"},
    {"limited", "steps > t > energy > supplied [J]", 1.2, 1e-6, "F y"},
    {"limited", "steps > t > energy > stored at end [J]", 1.03263343806, 1e-6,
     "kinetic and spring"},
    {"limited", "steps > t > energy > dissipated [J]", 0.16736656194, 1e-6, "the difference"},
    {"limited", "steps > t > peaks > P > amplitude 0-peak [m]", 1.2e-3, 1e-9, "the limit"},
    {"limited", "steps > t > peaks > P > motion 0-peak [m]", 0.6e-3, 1e-9, "half the way"},
    {"limited", "steps > t > peaks > P > time [s]", 6.0575050235066e-3, 1e-9, "the end"},
    {"limited", "steps > t > peaks > P > speed [rpm]", 0, 0, "does not turn"},
    // zeta = 10/(2 sqrt(1e4 0.1)) and 600/(2 sqrt(1e6 10)), w_n sqrt(1 - zeta^2)
    {"limited", "steps > t > accuracy > modes > 0 > frequency [Hz]", 49.696115052205, 1e-8,
     "twist"},
    {"limited", "steps > t > accuracy > modes > 0 > physical damping ratio", 0.158113883008, 1e-10,
     "twist"},
    {"limited", "steps > t > accuracy > modes > 1 > frequency [Hz]", 50.102218760639, 1e-8,
     "lateral"},
    {"limited", "steps > t > accuracy > modes > 2 > physical damping ratio", 0.094868329805, 1e-10,
     "lateral"},
    // m v^2/2 of (0, 0.4, -0.2) m/s and (Ip 7^2 + Id (2^2 + 3^2))/2
    {"turned about the left end", "steps > t > energy > stored at start [J]", 3.84, 1e-12,
     "kinetic"},
    {"turned about the left end", "steps > t > energy > stored at end [J]", 3.84, 1e-9, "kept"},
    {"turned about the left end", "steps > t > peaks > P > amplitude 0-peak [m]",
     4.4721359549996e-4, 1e-12, "v t of the centre"},
    {"turned about the left end", "steps > t > peaks > P > time [s]", 1e-3, 1e-12, "the end"},
    {"turned about the left end", "steps > t > peaks > P > speed [rpm]", 66.845076098596, 1e-6,
     "7 rad/s"},
    {"path", "steps > st > path > load factor", 2, 1e-9, "asked for"},
    {"path", "steps > st > path > reached", 1, 0, "nothing gives way"},
    {"path", "steps > st > elastic energy [J]", 0.02, 1e-12, "k y^2/2 of 0.2 mm"},
    {"path", "steps > st > deflection > rotor > largest [m]", 2e-4, 1e-13, "F/k"},
    {"path", "steps > st > support forces [N] > spring > 1", -200, 1e-7, "reaction"},
    {"path", "steps > st > support forces [N] > guide > 1", 0, 1e-9, "holds nothing across"},
    // pi^2 E I/4 and the strut's shortening
    {"struts", "steps > b > load factors > 0", 157.91367, 0.1, "I_z"},
    {"struts", "steps > b > load factors > 1", 355.30576, 0.5, "I_y"},
    {"struts", "steps > b > imaginary parts of load factors > 0", 0, 0, "conservative"},
    {"struts", "steps > b > rotations before buckling [rad] > 0", 0, 1e-12, "straight"},
    {"struts", "steps > b > displacements before buckling [-] > 0", 3.290e-4, 3e-7, "P/EA"},
    {"struts", "steps > b > displacements before buckling [-] > 1", 7.402e-4, 1e-6, "P/EA"},
    {"struts", "steps > b > on the path > load factor", 157.96566, 1e-4, "P (1 - P/EA)"},
    {"struts", "steps > b > on the path > stability is lost", 1, 0, "it buckles"},
    {"struts", "steps > b > on the path > agrees with the first factor", 1, 0, "to 2e-4"},
    {"struts", "steps > b > certificate > complete", 1, 0, "counted"},
    {"struts", "steps > b > certificate > negative factors", 0, 0, "pulled it never buckles"},
    {"struts", "steps > b > certificate > factors not found", 0, 0, "none"},
    // q = c w_n
    {"speed-coupled", "steps > s > onsets > 0 > speed [rpm]", 3000, 1e-6, "q = c w_n"},
    {"speed-coupled", "steps > s > onsets > 0 > whirl frequency [Hz]", 50.329212104487, 1e-8,
     "w_n"},
    {"speed-coupled", "steps > s > onsets > 0 > becomes unstable", 1, 0, "above"},
    {"speed-coupled", "steps > s > onsets > 0 > divergence", 0, 0, "it whirls"},
    {"speed-coupled", "steps > s > onsets > 0 > growth begins there", 1, 0, "the only one"},
    {"speed-coupled", "steps > s > map > 0 > onset [rpm]", 1500, 1e-6, "half the damping"},
    {"speed-coupled", "steps > s > map > 1 > onset [rpm]", 3000, 1e-6, "q = c w_n"},
    {"speed-coupled", "steps > s > map > 0 > growth begins there", 1, 0, "the only one"},
    {"speed-coupled", "steps > s > stable at the first speed", 1, 0, "1500 rpm"},
    {"speed-coupled", "steps > s > list complete", 1, 0, "four roots"},
    {"speed-coupled", "steps > s > certified", 1, 0, "four roots"},
    {"speed-coupled", "steps > e > speeds", 1, 0, "asked for"},
    {"speed-coupled", "steps > e > equilibria", 1, 0, "found"},
    {"speed-coupled", "steps > e > unstable equilibria", 0, 0, "3000 rpm is the onset of whirl"},
    {"campbell", "steps > c > modes", 2, 0, "asked for"},
    {"campbell", "steps > c > speeds", 2, 0, "asked for"},
    {"campbell", "steps > c > critical speeds [rpm] > 1x > 0", 3006.133125638, 1e-6, "damped"},
    {"campbell", "steps > v > max speed [rpm]", 6000, 1e-9, "asked for"},
    {"campbell", "steps > v > undamped critical speeds [rpm] > 1x > 0", 3019.752726269, 1e-7,
     "w_n"},
    {"campbell", "steps > v > damped critical speeds [rpm] > 1x > 0", 3006.133125638, 1e-7,
     "w_n sqrt(1 - zeta^2)"},
    {"campbell", "steps > p > lines", 1, 0, "both planes in one"},
    {"campbell", "steps > p > stiffnesses", 2, 0, "asked for"},
    {"campbell", "steps > o > frequencies [Hz] > 0", 49.696115052205, 1e-8, "damped"},
    {"campbell", "steps > m > modes > 0 > frequency [Hz]", 49.696115052205, 1e-8, "damped"},
    {"campbell", "steps > m > modes > 0 > log decrement", 1.006114863254, 1e-10, "of zeta"},
    {"campbell", "steps > m > modes > 0 > damping ratio", 0.158113883008, 1e-10, "zeta"},
    {"campbell", "steps > m > unstable modes", 0, 0, "damped"},
    {"campbell", "steps > m > diverging motions", 0, 0, "a spring"},
    {"campbell", "steps > m > certificate > 0 > roots not found", 0, 0, "none"},
    {"campbell", "steps > m > certificate > 0 > complete", 1, 0, "two roots"},
    {"unbalance", "steps > u > speeds", 51, 0, "asked for"},
    {"unbalance", "steps > u > largest amplitude 0-peak [m] > P", 5.294341149915e-4, 1e-9,
     "the peak"},
    {"unbalance", "steps > u > peaks > P > 0 > speed [rpm]", 3047.302992474, 1e-6,
     "w_n/sqrt(1 - 2 zeta^2)"},
    {"unbalance", "steps > u > peaks > P > 0 > amplitude 0-peak [m]", 5.294341149915e-4, 1e-13,
     "closed form"},
    {"unbalance", "steps > u > peaks > P > 0 > amplification factor", 5.078092979906, 1e-7,
     "Nc/(N2 - N1)"},
    {"operated at the peak", "steps > u > separation margins failed", 1, 0, "within"},
    {"operated at the peak", "steps > u > separation margins not determined", 0, 0, "known"},
    {"operated above the peak", "steps > u > separation margins failed", 0, 0, "24 % for 12 %"},
    {"backward", "steps > h > points", 2, 0, "asked for"},
    {"backward", "steps > h > largest amplitude 0-peak [m] > P", 5.292516323279e-4, 1e-13,
     "of the two"},
    // 10 N m/|k - Ip w^2 + i c w| at 40 Hz
    {"twist", "steps > h > largest twist 0-peak [rad] > P", 2.242559819905e-3, 1e-12, "of the two"},
    {"coupled casing", "steps > h > largest amplitude 0-peak [m] > Q", 2.867013095516e-5, 1e-14,
     "moved through the damping alone"},
    {"harmonic peaks", "steps > h > peaks > P > 0 > frequency [Hz]", 49.87419230844, 1e-5,
     "w^2 = k/m - c^2/(2 m^2)"},
    {"harmonic peaks", "steps > h > peaks > P > 0 > speed [rpm]", 0, 0, "does not turn"},
    {"harmonic peaks", "steps > h > peaks > P > 0 > amplitude", 5.294341149915e-5, 1e-14,
     "of the peak"},
    {"ball bearing at its node", "steps > st > rolling elements > ball > loaded", 12, 0,
     "the preload is on all"},
    {"ball bearing at its node", "steps > st > support forces [N] > guide > 0", 300, 1e-6,
     "holds against the preload"},
    {"ball bearing at its node", "steps > st > support forces [N] > ball > 0", -300, 1e-6,
     "the preload"},
};

struct Said {
  const char* deck;
  const char* path;
  const char* text;  ///< how it begins
};

const Said said[] = {
    {"arms at rest", "steps > st > type", "static"},
    {"arms at rest", "steps > st > stability > tangent", "symmetric"},
    {"arms at rest", "steps > t > outcome", "end time reached"},
    {"arms at rest", "steps > t > integrator > method", "radau5"},
    {"arms at rest", "steps > t > largest tilt > node", "node at 0.4 m of casing 'u'"},
    {"backward", "steps > h > type", "harmonic_response"},
    {"backward", "steps > h > motion", "all"},
    {"campbell", "steps > c > linearised", "about the static equilibrium at each speed"},
    {"campbell", "steps > c > motion", "lateral"},
    {"campbell", "steps > c > type", "campbell"},
    {"campbell", "steps > c > held > 0", "twist and axial motion without inertia"},
    {"campbell", "steps > m > held > 0", "lateral and axial motion: the step takes torsional"},
    {"ball bearing at its node", "steps > st > held > 0",
     "angle of node at 0.1 m of shaft 'rotor': nothing else holds the turning of shaft 'rotor'"},
    {"campbell", "steps > m > modes > 0 > label", "torsional 1"},
    {"campbell", "steps > m > modes > 0 > kind", "torsional"},
    {"campbell", "steps > c > certificate > 0 > at", "at 0 rpm"},
    {"campbell", "steps > p > bearings varied > 0", "spring"},
    {"cantilever", "steps > st > mesh > largest at", "r"},
    {"circle", "steps > t > equations", "linear: constant matrices"},
    {"limited", "steps > t > outcome", "amplitude limit exceeded"},
    {"limited", "steps > t > detail", "P passes 0.0012 m at t = 0.0060575"},
    {"path", "steps > st > path > end", "reached its end at load factor 2"},
    {"speed-coupled", "steps > s > map > 0 > c", "300 N.s/m"},
    {"speed-coupled", "steps > e > bearings > 0 > bearing", "spring"},
    {"struts", "steps > b > linearised", "about the unloaded equilibrium at 0 rpm"},
    {"struts", "steps > b > on the path > at", "bifurcation point"},
};

/// What must fit together whatever the run did.
void expect_consistent(const Value& t, const std::string& of) {
  const auto n = [&](const char* path) { return number_at(t, path); };
  const double steps = n("integrator > steps"), mean = n("integrator > step mean [s]");
  EXPECT_NEAR(steps * mean, n("t_end [s]"), 1e-9 * n("t_end [s]")) << of;  // from 0
  EXPECT_LE(n("integrator > step min [s]"), mean) << of;
  EXPECT_GE(n("integrator > step max [s]"), mean) << of;
  EXPECT_GE(n("integrator > Newton iterations"), steps) << of;
  // each iteration needs a residual, each step another one at its beginning or end
  EXPECT_GE(n("integrator > residual evaluations"), n("integrator > Newton iterations") + steps)
      << of;
  EXPECT_GE(n("integrator > factorisations real"), n("integrator > linearisations")) << of;
  EXPECT_LE(n("integrator > local error / allowance, mean"),
            n("integrator > local error / allowance, max"))
      << of;
  for (const std::string key : {"local error / allowance, mean", "local error / allowance, max"})
    EXPECT_EQ(number_at(t, "accuracy > " + key), number_at(t, "integrator > " + key)) << of;
  const double stored = n("energy > stored at end [J]") - n("energy > stored at start [J]"),
               defect = stored - n("energy > supplied [J]") + n("energy > dissipated [J]");
  EXPECT_NEAR(n("energy > defect [J]"), defect, 1e-11 * (1 + std::abs(stored))) << of;
  EXPECT_GE(n("energy > largest defect [J]"), std::abs(n("energy > defect [J]"))) << of;
}

}  // namespace

TEST(SummaryNumbers, AreThoseOfClosedForms) {
  std::size_t read = 0;
  for (const auto& [name, deck] : test::written_decks()) {
    const DeckRun run(deck);
    ASSERT_EQ(run.exit, 0) << name << "\n" << run.log;
    const Value all = run.summary();
    for (const Number& n : numbers) {
      if (n.deck != name) continue;
      ++read;
      EXPECT_NEAR(number_at(all, n.path), n.expected, n.tolerance)
          << name << ", " << n.path << ": " << n.why;
    }
    for (const Said& s : said) {
      if (s.deck != name) continue;
      ++read;
      const Value v = value_at(all, s.path);
      EXPECT_TRUE(v.is_text() && v.text().starts_with(s.text))
          << name << ", " << s.path << ": " << (v.is_text() ? v.text() : "no text");
    }
    for (const auto& [step, t] : all.at("steps").members())
      if (t.at("type").text() == "transient") expect_consistent(t, name + ", " + step);
  }
  EXPECT_EQ(read, std::size(numbers) + std::size(said));  // no deck was renamed
}

// Numbers that a table has too.
TEST(SummaryNumbers, AreThoseOfTheTables) {
  const auto decks = test::written_decks();
  {
    const DeckRun run(decks.at("ball bearing at its node"));
    const Columns loads = run.csv("st_rolling.csv");
    double most = 0;
    for (const auto& row : loads.rows)
      most = std::max(most, row[loads.column("load [N]")]);
    EXPECT_GT(most, 0);
    EXPECT_NEAR(number_at(run.summary("st"), "rolling elements > ball > largest load [N]"), most,
                1e-9 * most);
  }
  const DeckRun run(decks.at("path"));
  const double points = static_cast<double>(run.csv("st_path.csv").rows.size());
  EXPECT_EQ(number_at(run.summary("st"), "path > points"), points);
  EXPECT_EQ(number_at(run.summary("st"), "load steps"), points);
}

// A solid cylinder of 50 mm by 1 m with a wheel and a hollow one of 100 to 60 mm by 0.5 m, 8000 kg/m^3.
TEST(SummaryNumbers, OfACheckAreThoseOfCylinders) {
  const DeckRun run(R"(format = 1
title = "two"
[[material]]
name = "m"
E = "200 GPa"
nu = 0.3
density = "8000 kg/m^3"
[[shaft]]
name = "solid"
material = "m"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 400, 50, 2], ["b", 600, 50, 3]]
[[shaft]]
name = "hollow"
origin = ["200 mm", "300 mm", "0 mm"]
material = "m"
columns = ["name", "length[mm]", "od[mm]", "id[mm]", "min_elements"]
rows = [["c", 500, 100, 60, 4]]
[[disk]]
name = "wheel"
at = "a:end"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.07 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z", "ry", "rz"]
[[bearing]]
name = "C"
at = "c:start"
type = "rigid"
directions = ["x", "y", "z", "ry", "rz"]
[[probe]]
name = "P"
at = "b:end"
[output]
report = true
[[step]]
name = "s"
type = "static"
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const std::string command =
      "cd '" + run.folder.string() + "' && '" WHIRL_EXE "' check --json d.toml > check.json";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const Value v = tests::read_json(run.folder / "check.json").at("model");
  const auto n = [&](const std::string& path) { return number_at(v, path); };
  EXPECT_EQ(n("elements"), 9);
  EXPECT_EQ(n("nodes"), 11);
  EXPECT_EQ(n("shafts > 0 > sections"), 2);
  EXPECT_EQ(n("shafts > 1 > sections"), 1);
  const double outer[] = {0.025, 0.05}, inner[] = {0, 0.03}, length[] = {1, 0.5},
               middle[] = {0.5, 0.45};
  for (const std::size_t k : {0, 1}) {
    const std::string of = "shafts > " + std::to_string(k) + " > ";
    const double r2 = outer[k] * outer[k] - inner[k] * inner[k],
                 sum = outer[k] * outer[k] + inner[k] * inner[k], mass = 8000 * pi * r2 * length[k],
                 wheel = k == 0 ? 10 : 0,
                 centre = (mass * middle[k] + wheel * 0.4) / (mass + wheel),
                 apart = mass * wheel / (mass + wheel) * 0.01;  // 0.1 m
    EXPECT_NEAR(n(of + "length_m"), length[k], 1e-12);
    EXPECT_NEAR(n(of + "mass_kg"), mass + wheel, 1e-10);
    EXPECT_NEAR(n(of + "centre_x_m"), centre, 1e-12);
    EXPECT_NEAR(n(of + "Ip_kg_m2"), mass * sum / 2 + wheel * 0.01, 1e-10);
    EXPECT_NEAR(n(of + "Id_kg_m2"),
                mass * (3 * sum + length[k] * length[k]) / 12 + wheel * 0.007 + apart, 1e-10);
  }
  EXPECT_EQ(value_at(v, "title").text(), "two");
  EXPECT_EQ(value_at(v, "shafts > 1 > name").text(), "hollow");
  EXPECT_EQ(value_at(v, "disks > 0").text(), "wheel");
  EXPECT_EQ(value_at(v, "bearings > 1").text(), "C");
  EXPECT_EQ(value_at(v, "probes > 0").text(), "P");
  EXPECT_EQ(value_at(v, "steps > 0 > name").text(), "s");
  EXPECT_EQ(value_at(v, "steps > 0 > type").text(), "static");
  EXPECT_EQ(n("output_frames"), 0);
  EXPECT_EQ(n("output_bytes"), 0);  // no histories
  // both shafts are free to turn: each is held by itself
  const Value held = run.summary("s").at("held");
  ASSERT_EQ(held.items().size(), 2u);
  std::ostringstream page;
  page << std::ifstream(run.folder / "r" / "report.html").rdbuf();
  const std::string text = page.str().substr(page.str().find("Held: "));
  for (const std::size_t k : {0, 1}) {
    const std::string shaft = k == 0 ? "'solid'" : "'hollow'";
    EXPECT_NE(held.items()[k].text().find("the turning of shaft " + shaft), std::string::npos);
  }
  EXPECT_NE(text.find("'solid'; angle of node"), std::string::npos) << text.substr(0, 300);
}

// One section along two legs at a right angle, 0.6 m along x and 0.4 m along y, 20 mm thick.
TEST(SummaryNumbers, OfACheckAreThoseOfABentPipe) {
  const DeckRun run(R"(format = 1
[[material]]
name = "m"
E = "200 GPa"
nu = 0.3
density = "8000 kg/m^3"
[[shaft]]
name = "pipe"
material = "m"
rotating = false
path = [{ to = ["0.6 m", "0 m", "0 m"] }, { to = ["0.6 m", "0.4 m", "0 m"] }]
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 1000, 20]]
[[bearing]]
name = "wall"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[output]
report = false
[[step]]
name = "s"
type = "static"
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const std::string command =
      "cd '" + run.folder.string() + "' && '" WHIRL_EXE "' check --json d.toml > check.json";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const Value v =
      tests::read_json(run.folder / "check.json").at("model").at("shafts").items().at(0);
  const double each = 8000 * pi * 0.01 * 0.01, a = 0.6 * each, b = 0.4 * each, r2 = 0.01 * 0.01;
  const auto rod = [r2](double mass, double length) {  // across
    return mass * (3 * r2 + length * length) / 12;
  };
  const double x = (a * 0.3 + b * 0.6) / each, y = b * 0.2 / each;
  const double Jxx = a * r2 / 2 + a * y * y + rod(b, 0.4) + b * (0.2 - y) * (0.2 - y),
               Jyy =
                   rod(a, 0.6) + a * (0.3 - x) * (0.3 - x) + b * r2 / 2 + b * (0.6 - x) * (0.6 - x),
               Jzz = rod(a, 0.6) + a * ((0.3 - x) * (0.3 - x) + y * y) + rod(b, 0.4) +
                     b * ((0.6 - x) * (0.6 - x) + (0.2 - y) * (0.2 - y));
  EXPECT_NEAR(number_at(v, "mass_kg"), each, 1e-10);
  EXPECT_NEAR(number_at(v, "length_m"), 1, 1e-12);
  EXPECT_NEAR(number_at(v, "centre_x_m"), x, 1e-10);
  EXPECT_NEAR(number_at(v, "Ip_kg_m2"), Jxx, 1e-9);
  EXPECT_NEAR(number_at(v, "Id_kg_m2"), (Jyy + Jzz) / 2, 1e-9);
}

// 600 rpm forward to 600 rpm backward within 1 s: 2.5 turns on and back. The first passage of the
// mark begins a turn, and one that the rotor has not ended when it turns round is none: the second
// on and the first back are whole.
TEST(SummaryNumbers, TurnsOfARotorThatTurnsRoundAreWhole) {
  const DeckRun run(test::mass_on_springs(R"([[unbalance]]
at = "mass"
amount = "1 kg.mm"
[output.tracking]
orders = [1]
[[drive]]
at = "rotor/0 mm"
type = "speed"
speed = { type = "ramp", time = ["0 s", "1 s"], value = ["600 rpm", "-600 rpm"] }
[[step]]
name = "t"
type = "transient"
duration = "1 s"
start = "rest"
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns t = run.csv("t_tracking.csv");
  const auto mark = [](double turns) { return 0.5 - std::sqrt(0.25 - turns / 10); };
  const double middle = (mark(1) + mark(2)) / 2;
  ASSERT_EQ(t.rows.size(), 2u);
  EXPECT_NEAR(t.rows[0][0], middle, 1e-6);
  EXPECT_NEAR(t.rows[1][0], 1 - middle, 1e-6);
  EXPECT_GT(t.rows[0][t.column("speed [rpm]")], 300);
  EXPECT_LT(t.rows[1][t.column("speed [rpm]")], -300);
}
