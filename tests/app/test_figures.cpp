// What the pictures of a run rest on: keyphasors of several shafts, motion apart from sag, clearance
// diagrams, the replay, the machine in one drawing.
#include "deck_run.hpp"
#include "figure_faults.hpp"
#include "lateral_mass.hpp"

#include <core/types.hpp>
#include <plot/plots.hpp>
#include <plot/svg.hpp>

#include <complex>
#include <tuple>

namespace {

using namespace whirl;
using test::DeckRun;
using test::lateral_mass;
namespace fs = std::filesystem;

constexpr double k = 1e6, m = 10, c = 600;  // N/m, kg, N s/m

const std::string springs = R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
[[unbalance]]
at = "mass"
amount = "1 kg.mm"
[[probe]]
name = "P"
at = "mass"
)";

std::string driven(const std::string& speed, const std::string& keys) {
  return "[[drive]]\nat = \"rotor/0 mm\"\ntype = \"speed\"\nspeed = \"" + speed +
         "\"\n[[step]]\nname = \"t\"\ntype = \"transient\"\n" + keys +
         "[step.integrator]\ntolerance = 1e-8\n";
}

/// Radius of the circle that 1 kg mm drives at a speed, m.
double radius_at(double Omega) {
  return 1e-3 * Omega * Omega / std::abs(std::complex<double>(k - m * Omega * Omega, c * Omega));
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++n;
  return n;
}

}  // namespace

// A steady circle of radius r about a sag s: r + s from the line at rest, the width of the circle
// from where it began.
TEST(Figures, PeaksTellMotionFromSag) {
  const DeckRun run(lateral_mass(m, "9.81 m/s^2", springs) +
                    driven("3000 rpm", "duration = \"0.1 s\"\nstart = \"unbalance_response\"\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const auto peak = run.csv("t_peaks.csv").last();
  const double r = radius_at(100 * pi), sag = m * 9.81 / k;
  EXPECT_NEAR(peak.at("amplitude 0-peak [m]"), r + sag, 1e-8);
  EXPECT_NEAR(peak.at("motion 0-peak [m]"), r, 1e-4 * r);
  EXPECT_GE(peak.at("motion at [s]"), 0.01);
}

// A report draws what stands in tables: it adds none.
TEST(Figures, TablesDoNotNeedTheReport) {
  std::string deck = lateral_mass(m, "0 m/s^2", springs) +
                     driven("3000 rpm", "duration = \"0.6 s\"\nstart = \"rest\"\n");
  const std::string ramp =
      R"({ type = "ramp", time = ["0 s", "0.6 s"], value = ["1000 rpm", "6000 rpm"] })";
  deck.replace(deck.find("\"3000 rpm\""), 10, ramp);
  const DeckRun with(deck), without(deck + "[output]\nreport = false\n");
  ASSERT_EQ(without.exit, 0) << without.log;
  std::size_t found = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(with.folder / "r")) {
    if (file.path().extension() != ".csv") continue;
    EXPECT_EQ(text_of(without.folder / "r" / file.path().filename()), text_of(file.path()));
    ++found;
  }
  EXPECT_GT(found, 4);
  for (const char* name : {"t_peaks.csv", "t_response_peaks.csv", "t_orbits.csv"})
    EXPECT_TRUE(fs::exists(without.folder / "r" / name)) << name;
}

// A path between a few rows a turn is not drawn, and the picture says so.
TEST(Figures, AnOrbitOfFewRowsIsDots) {
  for (const auto& [every, few] : {std::pair{"3 ms", true}, {"1 ms", false}}) {
    const DeckRun run(lateral_mass(m, "0 m/s^2", springs) +
                      driven("3000 rpm", "duration = \"0.2 s\"\nstart = \"unbalance_response\"\n") +
                      "[output]\nevery = \"" + every + "\"\n");
    ASSERT_EQ(run.exit, 0) << run.log;
    const bool said =
        text_of(run.folder / "r" / "report.html").find("6.7 a turn") != std::string::npos;
    EXPECT_EQ(said, few) << every;
    for (const char* picture : {"t_P_turns.svg", "t_P_orbit.svg"})  // this one of the keyphasor
      EXPECT_TRUE(fs::exists(run.folder / "r" / "plots" / picture)) << picture;
  }
}

namespace {

const std::string two = R"([[shaft]]
name = "other"
origin = ["0 mm", "1 m", "0 m"]
speed_ratio = 1.5
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left2", 100, true], ["right2", 100, true]]
[[disk]]
name = "mass 2"
at = "other/100 mm"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
name = "guide 2"
at = "mass 2"
type = "rigid"
directions = ["x", "ry", "rz"]
[[bearing]]
name = "spring 2"
at = "mass 2"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
[[unbalance]]
at = "mass 2"
amount = "1 kg.mm"
[[probe]]
name = "Q"
at = "mass 2"
[[drive]]
at = "other/0 mm"
type = "speed"
speed = "4500 rpm"
)";

}  // namespace

// Two shafts that nothing couples: each is seen by its own keyphasor, at its own speed.
TEST(Figures, EveryShaftHasItsKeyphasor) {
  std::string deck = lateral_mass(m, "0 m/s^2", springs + two) +
                     driven("3000 rpm", "duration = \"1 s\"\nstart = \"rest\"\n");
  const std::size_t one = deck.find("[shaft]");
  deck.replace(one, 7, "[[shaft]]");
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  // the first drive is that of the other shaft, but the rotor turns at the reference speed
  const auto other = run.csv("t_other_tracking.csv").last();
  const auto first = run.csv("t_tracking.csv").last();
  EXPECT_FALSE(first.contains("Q.y 1X [m]"));
  EXPECT_NEAR(first.at("speed [rpm]"), 3000, 1e-6);
  EXPECT_NEAR(other.at("speed [rpm]"), 4500, 1e-6);
  EXPECT_NEAR(first.at("P.y 1X [m]"), radius_at(100 * pi), 1e-9);
  EXPECT_NEAR(other.at("Q.y 1X [m]"), radius_at(150 * pi), 1e-9);
  EXPECT_NEAR(other.at("Q 1X forward [m]"), radius_at(150 * pi), 1e-9);
  EXPECT_TRUE(fs::exists(run.folder / "r" / "plots" / "machine.svg"));
}

// Radii and orbits too: the one runs from 3000 to 3600 rpm, the other, backwards, to -5400 rpm.
TEST(Figures, RadiiAreDrawnAgainstTheSpinOfTheirShaft) {
  std::string other = two;
  other.replace(other.find("\"4500 rpm\""), 10,
                R"({ type = "ramp", time = ["0 s", "1 s"], value = ["-4500 rpm", "-5400 rpm"] })");
  std::string deck = lateral_mass(m, "0 m/s^2", springs + other) +
                     driven("3000 rpm", "duration = \"1 s\"\nstart = \"rest\"\n");
  deck.replace(deck.rfind("\"3000 rpm\""), 10,
               R"({ type = "ramp", time = ["0 s", "1 s"], value = ["3000 rpm", "3600 rpm"] })");
  const std::size_t one = deck.find("[shaft]");
  deck.replace(one, 7, "[[shaft]]");
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  const auto picture = [&](const char* name) {
    return text_of(run.folder / "r" / "plots" / (std::string("t_") + name + ".svg"));
  };
  EXPECT_NE(picture("P_amplitude").find("against spin<"), std::string::npos);
  const std::string radii = picture("Q_amplitude");
  EXPECT_NE(radii.find("against spin of other<"), std::string::npos);
  EXPECT_NE(radii.find("5200"), std::string::npos);             // on its axis
  EXPECT_EQ(radii.find("speed falling"), std::string::npos);    // it rises, backwards
  EXPECT_NE(picture("Q_turns").find("(-"), std::string::npos);  // rpm, backwards
}

// The one shakes the other through a spring: of its 1X nothing is left in what the other keyphasor
// sees, and the vectors of a steady motion stand still.
TEST(Figures, KeyphasorsLeaveTheOtherShaftOut) {
  const std::string coupled = R"([[bearing]]
name = "between"
at = "mass"
to = "mass 2"
type = "linear"
kyy = "3e5 N/m"
kzz = "3e5 N/m"
)";
  // 1.5: nothing is let through; 1.45: of the other's 1X 0.0038, with ten turns
  for (const auto& [ratio, share] : {std::pair{1.5, 1e-5}, {1.45, 0.004}}) {
    std::string other = two;
    other.replace(other.find("ratio = 1.5"), 11, "ratio = " + std::to_string(ratio));
    other.replace(other.find("4500 rpm"), 8, std::to_string(3000 * ratio) + " rpm");
    std::string deck = lateral_mass(m, "0 m/s^2", springs + other + coupled) +
                       driven("3000 rpm", "duration = \"1.2 s\"\nstart = \"rest\"\n");
    deck.replace(deck.find("[shaft]"), 7, "[[shaft]]");
    const DeckRun run(deck);
    ASSERT_EQ(run.exit, 0) << run.log;
    // 2x2: each is shaken by its own unbalance at its own speed, and by the other's at the other's
    const auto amplitudes = [&](double rpm) {
      const double Omega = rpm * pi / 30, between = 3e5;
      const std::complex<double> own(k + between - m * Omega * Omega, c * Omega);
      const double by_both = 1e-3 * Omega * Omega / std::abs(own * own - between * between);
      return std::pair{std::abs(own) * by_both, between * by_both};
    };
    for (const auto& [file, probe, rpm, other_rpm] :
         {std::tuple{"t_tracking.csv", "P.y 1X [m]", 3000.0, 3000.0 * ratio},
          std::tuple{"t_other_tracking.csv", "Q.y 1X [m]", 3000.0 * ratio, 3000.0}}) {
      const double expected = amplitudes(rpm).first;
      const double slack = 1e-5 * expected + share * amplitudes(other_rpm).second;
      const test::Columns t = run.csv(file);
      const std::size_t column = t.column(probe), n = t.rows.size();
      ASSERT_GT(n, 30u);
      for (std::size_t r = n - 20; r < n - 12; ++r)
        EXPECT_NEAR(t.rows[r][column], expected, slack) << file << " " << r;
    }
  }
}

TEST(Figures, ClearancesOfARubInResponseAndTransient) {
  const std::string rub = R"([[bearing]]
name = "seal ring"
at = "mass"
type = "rub"
gap = "1 mm"
stiffness = "1e8 N/m"
)";
  const DeckRun run(lateral_mass(m, "0 m/s^2", springs + rub) +
                    "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { start = "
                    "\"1000 rpm\", stop = \"3000 rpm\", points = 5 }\n" +
                    driven("3000 rpm", "duration = \"0.1 s\"\nstart = \"unbalance_response\"\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(fs::exists(run.folder / "r" / "plots" / "u_clearance_diagram.svg"));
  const std::string steady = text_of(run.folder / "r" / "plots" / "t_clearance_diagram.svg");
  const double share = 100 * radius_at(100 * pi) / 1e-3;
  char expected[32];
  std::snprintf(expected, sizeof expected, "seal ring: %.3g %%", share);
  EXPECT_NE(steady.find(expected), std::string::npos) << expected;
  const io::Value gap = run.summary("t").at("gaps").at("seal ring");
  EXPECT_NEAR(gap.at("largest displacement [m]").number(), radius_at(100 * pi), 1e-8);
}

// Bounded, whatever the run; left out where a deck says so.
TEST(Figures, AReplayIsKeptWhereADeckWantsIt) {
  for (const bool wanted : {true, false}) {
    const DeckRun run(lateral_mass(m, "0 m/s^2", springs) +
                      (wanted ? "" : "[output]\nreplay = false\n") +
                      driven("3000 rpm", "duration = \"2 s\"\nstart = \"rest\"\n"));
    ASSERT_EQ(run.exit, 0) << run.log;
    const std::string report = text_of(run.folder / "r" / "report.html");
    EXPECT_EQ(count(report, "class=\"replay\" data-for"), wanted ? 1u : 0u);
    // a rule for that class would show the numbers of the script as text
    EXPECT_EQ(count(report, "\n.replay "), 0u);
    EXPECT_LT(report.size(), 700000u);
    EXPECT_EQ(fs::exists(run.folder / "r" / "plots" / "t_replay.svg"), wanted);
  }
}

// Zone A reaches 4800 um/sqrt(rpm) peak to peak: 37.9 um 0 to peak at 4000 rpm. A small response is
// shown within it; a large one through all of them.
TEST(Figures, ZonesColourTheResponse) {
  const auto bode = [](const char* unbalance) {
    std::string deck = lateral_mass(m, "0 m/s^2", springs);
    deck.replace(deck.find("1 kg.mm"), 7, unbalance);
    const DeckRun run(deck + R"([[step]]
name = "u"
type = "unbalance_response"
speed = { start = "2000 rpm", stop = "6000 rpm", points = 41 }
operating_speed = ["4000 rpm", "5000 rpm"]
[step.zones]
)");
    EXPECT_EQ(run.exit, 0) << run.log;
    return text_of(run.folder / "r" / "plots" / "u_P_bode.svg");
  };
  const std::string small = bode("10 g.mm"), large = bode("1 kg.mm");
  EXPECT_NE(small.find(">zone A<"), std::string::npos);
  EXPECT_EQ(small.find(">zone C<"), std::string::npos);
  const std::size_t range = small.find("data-y=\"") + 8;
  const double top = std::stod(small.substr(small.find(' ', range)));
  EXPECT_NEAR(top, 1.12 * 2400 / std::sqrt(4000.0), 1e-9 * top);
  for (const char* zone : {">zone A<", ">zone B<", ">zone C<", ">zone D<"})
    EXPECT_NE(large.find(zone), std::string::npos) << zone;
}

namespace {

/// Disks, supports and probes every 20 mm of a shaft of 2 m.
plot::RotorDrawing crowded_rotor() {
  plot::RotorDrawing d;
  d.title = "crowd";
  d.sections = {{0, 2, 0.05, 0.05, 0, 0, "shaft"}};
  for (int k = 0; k < 12; ++k) {
    const double s = 0.8 + 0.02 * k;
    d.disks.push_back({s, 0.15, 0.05, 0.01, "impeller " + std::to_string(k)});
    d.bearings.push_back({s + 0.01, 0.05, "labyrinth " + std::to_string(k)});
    d.probes.push_back({s, 0.05, "eddy current " + std::to_string(k)});
  }
  return d;
}

}  // namespace

// Names that have no room stand in a key, each beside its number; a name alone stands at its part.
TEST(Figures, CrowdedNamesHaveAKey) {
  plot::RotorDrawing few = crowded_rotor();
  few.disks.resize(1);
  few.bearings.resize(1);
  few.probes.resize(1);
  EXPECT_EQ(plot::render_svg(plot::plot_rotor("few", few)).find("class=\"key\""),
            std::string::npos);
  const std::string svg = plot::render_svg(plot::plot_rotor("rotor", crowded_rotor()));
  EXPECT_EQ(test::FigureCheck(svg).faults(), std::vector<std::string>());
  const std::size_t from = svg.find("class=\"key\"");
  ASSERT_NE(from, std::string::npos);
  const std::string key = svg.substr(from, svg.find("</g>", from) - from);
  const std::size_t numbered = count(key, "<text ");
  EXPECT_GE(numbered, 12u);
  for (std::size_t n = 1; n <= numbered; ++n) {
    EXPECT_EQ(count(svg, ">" + std::to_string(n) + "</text>"), 1u) << n;
    EXPECT_EQ(count(key, ">" + std::to_string(n) + ": "), 1u) << n;
  }
  // all are named, here or there
  for (int k = 0; k < 12; ++k)
    for (const char* part : {"impeller ", "labyrinth ", "eddy current "})
      EXPECT_EQ(count(svg, part + std::to_string(k) + "</text>"), 1u) << part << k;
}

TEST(Figures, CrowdedCriticalSpeedsHaveAKey) {
  std::vector<plot::CampbellLine> lines(1);
  std::vector<plot::CriticalMark> marks;
  lines[0].label = "mode";
  for (int k = 0; k <= 20; ++k) {
    lines[0].speed.push_back(50.0 * k);
    lines[0].frequency.push_back(500.0);
    marks.push_back({490.0 + k, 500.0, 1, ""});
  }
  const double orders[] = {1.0};
  const std::string svg =
      plot::render_svg(plot::plot_campbell("campbell", "Campbell", lines, orders, marks));
  EXPECT_EQ(test::FigureCheck(svg).faults(), std::vector<std::string>());
  EXPECT_EQ(count(svg, " rpm</text>"), marks.size());
}

TEST(Figures, CrowdedStationsHaveAKey) {
  plot::ModeShape mode{"", {0.0, 1.0}, {0.5, 1.0}, {0.0, 0.0}, {}};
  for (int k = 11; k >= 0; --k)
    mode.stations.emplace_back("labyrinth " + std::to_string(k), 0.4 + 0.01 * k);
  const std::string svg = plot::render_svg(plot::plot_mode_shape("mode", "mode", mode));
  EXPECT_EQ(test::FigureCheck(svg).faults(), std::vector<std::string>());
  const std::string key = svg.substr(std::min(svg.size(), svg.find("class=\"key\"")));
  EXPECT_EQ(count(svg, "labyrinth "), 12u);
  EXPECT_GE(count(key, "labyrinth "), 6u);
  int last = -1;  // from left to right
  for (std::size_t at = key.find(": labyrinth "); at != std::string::npos;
       at = key.find(": labyrinth ", at + 1)) {
    const int station = std::stoi(key.substr(at + 12));
    EXPECT_GT(station, last);
    last = station;
  }
}

// What the figures of every deck are looked at with sees names on one another.
TEST(Figures, TextsOnTextsAreAFault) {
  const auto with = [](const char* y) {
    return std::string(
               "<svg><text x=\"10\" y=\"20\" font-size=\"11\">seal</text><text x=\"14\" y=\"") +
           y + "\" font-size=\"11\" text-anchor=\"middle\">impeller</text></svg>";
  };
  EXPECT_EQ(test::FigureCheck(with("22")).faults().size(), 1u);
  EXPECT_TRUE(test::FigureCheck(with("40")).faults().empty());
}

namespace {

/// Plane axes 100 px wide at 10, 10, with what is told in them.
std::string axes_with(const std::string& pins, const std::string& ticks) {
  return "<svg class=\"figure\" viewBox=\"0 0 200 200\"><g class=\"axes\" data-kind=\"xy\" "
         "data-box=\"10 10 100 100\" data-x=\"0 1 0\" data-y=\"0 1 0\"><g class=\"pins\">" +
         pins + "</g><g class=\"tx\">" + ticks + "</g></g></svg>";
}

std::string text_at(const char* x, const char* y, const char* text) {
  return std::string("<text x=\"") + x + "\" y=\"" + y + "\" font-size=\"10\">" + text + "</text>";
}

const std::string two_ticks = text_at("10", "130", "0") + text_at("90", "130", "1");

}  // namespace

TEST(Figures, WhatIsCutOrRunsTogetherIsAFault) {
  const auto faults = [](const std::string& svg) { return test::FigureCheck(svg).faults(); };
  EXPECT_TRUE(
      faults(axes_with(text_at("50", "50", "2") + text_at("70", "50", "3"), two_ticks)).empty());
  const auto together =
      faults(axes_with(text_at("50", "50", "2") + text_at("57", "50", "3"), two_ticks));
  ASSERT_EQ(together.size(), 1u);
  EXPECT_EQ(together[0], "'2' and '3' run together");
  const auto cut = faults(axes_with(text_at("5", "50", "-2X"), two_ticks));
  ASSERT_EQ(cut.size(), 1u);
  EXPECT_EQ(cut[0], "the frame cuts '-2X'");
  const auto outside = faults(axes_with(text_at("195", "190", "speed"), two_ticks));
  EXPECT_EQ(outside.size(), 2u);  // by the frame too
  EXPECT_EQ(faults(axes_with("", text_at("10", "130", "0"))).size(), 1u);
}

TEST(Figures, ALegendOnABodyIsAFault) {
  const auto with = [](const char* y) {
    return std::string("<svg><path d=\"M10 ") + y + "L40 " + y +
           " 40 30 10 30Z\"/><g class=\"legend\"><rect x=\"5\" y=\"50\" width=\"60\" "
           "height=\"20\"/>" +
           text_at("10", "62", "shaft") + "</g></svg>";
  };
  EXPECT_TRUE(test::FigureCheck(with("40")).faults().empty());
  EXPECT_EQ(test::FigureCheck(with("60")).faults().size(), 1u);
}

// 52 pm about a sag of 0.1 mm is less than an integration to 1e-4 tells; alone, or integrated to
// 1e-8, it is a motion.
TEST(Figures, MotionsThatAreNotResolvedAreNotDrawn) {
  for (const auto& [gravity, tolerance, drawn] : {std::tuple{"9.81 m/s^2", "1e-4", false},
                                                  {"9.81 m/s^2", "1e-8", true},
                                                  {"0 m/s^2", "1e-4", true}}) {
    std::string deck = lateral_mass(m, gravity, springs) +
                       driven("3000 rpm", "duration = \"0.3 s\"\nstart = \"unbalance_response\"\n");
    deck.replace(deck.find("1 kg.mm"), 7, "1e-7 kg.mm");
    deck.replace(deck.find("1e-8"), 4, tolerance);
    const DeckRun run(deck);
    ASSERT_EQ(run.exit, 0) << run.log;
    const fs::path plots = run.folder / "r" / "plots";
    const std::string of = std::string(gravity) + ", " + tolerance;
    EXPECT_EQ(fs::exists(plots / "t_P_synchronous.svg"), drawn) << of;
    EXPECT_EQ(fs::exists(plots / "t_P_orbit.svg"), drawn) << of;
    const std::string report = text_of(run.folder / "r" / "report.html");
    EXPECT_EQ(report.find("Not drawn: 1X of P (up to ") == std::string::npos, drawn) << of;
    if (drawn) {
      EXPECT_NEAR(run.csv("t_tracking.csv").last().at("P.y 1X [m]"), 1e-7 * radius_at(100 * pi),
                  1e-13)
          << of;
    }
  }
}

// The moment about the axis of a hinge is what rounding leaves of forces of 100 N.
TEST(Figures, LoadsThatAreNotResolvedAreNotDrawn) {
  std::string deck = text_of(fs::path(WHIRL_SOURCE) / "examples/33_double_pendulum/deck.toml");
  deck.replace(deck.find("duration = \"2 s\""), 16, "duration = \"0.4 s\"");
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  const fs::path plots = run.folder / "r" / "plots";
  EXPECT_TRUE(fs::exists(plots / "fall_joint_elbow_force.svg"));
  EXPECT_FALSE(fs::exists(plots / "fall_joint_elbow_moment.svg"));
  const std::string report = text_of(run.folder / "r" / "report.html");
  EXPECT_NE(report.find("joint elbow moment (up to "), std::string::npos);
}
