// Shafts without inertia about their axes: spacers and idlers that others turn, rotors that keep the
// speed they start with.
#include "deck_run.hpp"

#include <core/types.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace {

using whirl::pi;
using whirl::two_pi;
using whirl::test::Columns;
using whirl::test::DeckRun;

std::string rigid_line(std::string_view name, int start, int length, std::string_view ratio = "1",
                       int side = 0) {
  return fmt::format(R"([[shaft]]
name = "{}"
origin = ["{} mm", "{} mm", "0 mm"]
speed_ratio = {}
[[shaft.section]]
name = "a"
length = "{} mm"
rigid = true
)",
                     name, start, side, ratio, length);
}

std::string disk(std::string_view line, std::string_view keys) {
  return fmt::format("[[disk]]\nat = \"{}/a:mid\"\nmass = \"20 kg\"\n{}", line, keys);
}

std::string held(std::string_view line) {
  return fmt::format(R"([[bearing]]
at = "{}/a:mid"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e10 N/m"
kzz = "1e10 N/m"
krr = "1e9 N.m/rad"
)",
                     line);
}

std::string coupling(std::string_view from, std::string_view to) {
  return fmt::format(R"([[bearing]]
at = "{}/a:end"
to = "{}/a:start"
type = "coupling"
kxx = "1e6 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
krr = "1e5 N.m/rad"
krxx = "2e5 N.m/rad"
)",
                     from, to);
}

std::string gears(std::string_view from, std::string_view to) {
  return fmt::format(R"([[bearing]]
at = "{}/a:mid"
to = "{}/a:mid"
type = "gear"
teeth = 20
other_teeth = 20
pitch_diameter = "100 mm"
stiffness = "1e8 N/m"
)",
                     from, to);
}

/// 1 kg m2, a spacer without mass between two couplings of 2e5 N m/rad, 2 kg m2.
std::string train(const std::string& link_1 = coupling("m", "s"),
                  const std::string& link_2 = coupling("s", "g")) {
  return "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n" +
         rigid_line("m", 0, 300) + rigid_line("s", 300, 500) + rigid_line("g", 800, 300) +
         disk("m", "Ip = \"1 kg.m^2\"\nId = \"1 kg.m^2\"\n") +
         disk("g", "Ip = \"2 kg.m^2\"\nId = \"1.5 kg.m^2\"\n") + held("m") + held("g") + link_1 +
         link_2;
}

std::string pushed() {
  return R"([[drive]]
name = "motor"
at = "m/a:mid"
type = "torque"
step = "push"
torque = "10 N.m"
[[step]]
name = "push"
type = "transient"
start = "rest"
duration = "1 s"
)";
}

constexpr std::string_view torsional =
    "[[step]]\nname = \"t\"\ntype = \"torsional\"\nmodes = 3\nmax_speed = \"3000 rpm\"\n";

std::vector<double> elastic_modes(const DeckRun& d) {
  std::vector<double> out;
  const Columns t = d.csv("t_torsional.csv");
  for (const auto& row : t.rows)
    if (const double f = t.named(row).at("frequency [Hz]"); f > 1.0) out.push_back(f);
  return out;
}

}  // namespace

TEST(MasslessLines, ASpacerIsTwoSpringsInSeries) {
  const DeckRun d(train() + std::string(torsional));
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::vector<double> f = elastic_modes(d);
  ASSERT_EQ(f.size(), 1u) << d.log;
  EXPECT_NEAR(f[0], std::sqrt(1e5 * (1.0 + 1.0 / 2)) / two_pi, 1e-6 * f[0]);
}

TEST(MasslessLines, AnIdlerIsTwoTeethInSeries) {
  const DeckRun d("format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n" +
                  rigid_line("m", 0, 300) + rigid_line("i", 0, 300, "-1", 100) +
                  rigid_line("g", 0, 300, "1", 200) +
                  disk("m", "Ip = \"1 kg.m^2\"\nId = \"1 kg.m^2\"\n") + disk("i", "") +
                  disk("g", "Ip = \"2 kg.m^2\"\nId = \"1 kg.m^2\"\n") + held("m") + held("i") +
                  held("g") + gears("m", "i") + gears("i", "g") + std::string(torsional));
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::vector<double> f = elastic_modes(d);
  ASSERT_EQ(f.size(), 1u) << d.log;
  // along the line of action, 20 degrees from the tangent; bearings give 1e8/1e10 of it
  const double radius = 0.05 * std::cos(pi / 9);
  const double k = 0.5 * 1e8 * radius * radius;
  EXPECT_NEAR(f[0], std::sqrt(k * (1.0 + 1.0 / 2)) / two_pi, 0.02 * f[0]);
}

TEST(MasslessLines, ATorqueTurnsWhatASpacerJoins) {
  const std::string rigid_1 =
      "[[joint]]\nname = \"j\"\nat = \"m/a:end\"\nto = \"s/a:start\"\nkind = \"rigid\"\n";
  const std::string rigid_2 =
      "[[joint]]\nname = \"k\"\nat = \"s/a:end\"\nto = \"g/a:start\"\nkind = \"rigid\"\n";
  for (const std::string& deck : {train() + pushed(), train(rigid_1, rigid_2) + pushed()}) {
    const DeckRun d(deck);
    ASSERT_EQ(d.exit, 0) << d.log;
    const auto end = d.csv("push.csv").last();
    const double rpm = 10.0 / 3.0 * 60 / two_pi;
    // the driven end rings about the mean by its share of the twist
    EXPECT_NEAR(end.at("speed s [rpm]"), rpm, 0.005 * rpm) << d.log;
    EXPECT_FALSE(d.says("as unknowns: no inertia")) << d.log;
  }
}

namespace {

/// A disk without polar inertia amid a shaft without mass.
std::string point_mass(std::string_view step, std::string_view more = "") {
  return fmt::format(R"(format = 1
[output]
every = "1 ms"
report = false
quantities = ["speed", "probes"]
[model]
gravity = "0 m/s^2"
[[material]]
name = "z"
E = "210 GPa"
nu = 0.3
density = "0 kg/m^3"
[shaft]
name = "s"
material = "z"
{}
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 20], ["b", 500, 20]]
[[disk]]
at = "a:end"
name = "d"
mass = "10 kg"
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "1000 N.s/m"
czz = "1000 N.s/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "1000 N.s/m"
czz = "1000 N.s/m"
[[unbalance]]
at = "d"
amount = "10 g.mm"
[[probe]]
name = "p"
at = "d"
{})",
                     more, step);
}

double largest(const Columns& c, const std::string& name) {
  double most = 0;
  const std::size_t k = c.column(name);
  for (const auto& row : c.rows)
    most = std::max(most, std::abs(row[k]));
  return most;
}

}  // namespace

// However its speed is given: by the shaft, by the step, by the step that it begins from.
TEST(MasslessLines, KeepTheSpeedThatAStepBeginsWith) {
  const std::string transient =
      "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"0.5 s\"\n";
  const DeckRun given(point_mass(transient, "initial_spin = \"6000 rpm\""));
  ASSERT_EQ(given.exit, 0) << given.log;
  const double amplitude = largest(given.csv("t.csv"), "p.y [m]");
  EXPECT_GT(amplitude, 1e-6);
  const std::string speed = "initial_speed = \"6000 rpm\"\n";
  const std::string settled = "[[step]]\nname = \"s\"\ntype = \"static\"\nspeed = \"6000 rpm\"\n" +
                              transient + "from = \"s\"\n";
  const std::string goes_on =
      transient + speed +
      "[[step]]\nname = \"u\"\ntype = \"transient\"\nduration = \"0.5 s\"\nfrom = \"t\"\n";
  for (const std::string& steps : {transient + speed, settled, goes_on}) {
    const DeckRun d(point_mass(steps));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns t = d.csv("t.csv");
    EXPECT_NEAR(t.last().at("speed [rpm]"), 6000, 1e-6) << d.log;
    EXPECT_NEAR(largest(t, "p.y [m]"), amplitude, 1e-6 * amplitude);
    // the inertia of the unbalance alone rings at 30 MHz
    if (steps == goes_on) {
      EXPECT_NEAR(d.csv("u.csv").last().at("speed [rpm]"), 6000, 1e-6);
    }
    EXPECT_TRUE(d.says("it keeps the speed that a step starts with")) << d.log;
  }
  // a point mass with an unbalance is no asymmetric rotor
  const DeckRun linear(point_mass(transient + speed + "linear = true\n"));
  ASSERT_EQ(linear.exit, 0) << linear.log;
  EXPECT_NEAR(largest(linear.csv("t.csv"), "p.y [m]"), amplitude, 1e-3 * amplitude);
}
