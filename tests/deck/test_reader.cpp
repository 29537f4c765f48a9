// Reading good decks: what arrives in the model, and that the resolved deck says the same again.
#include <deck/deck.hpp>
#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include "dump_model.hpp"

namespace fs = std::filesystem;
using namespace whirl;

namespace {

constexpr const char* shaft_text = R"(
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 300, 40], ["right", 200, 50]]
)";

deck::Deck read(const std::string& text, std::vector<std::string> set = {}) {
  deck::ReadOptions o;
  o.set = std::move(set);
  return deck::read_deck_text(text, "deck.toml", o);
}

std::vector<fs::path> good_decks() {
  std::vector<fs::path> r{"good/everything.toml", "good/bearings.toml"};
  for (const auto& e : fs::directory_iterator("../../examples"))
    if (fs::exists(e.path() / "deck.toml")) r.push_back(e.path() / "deck.toml");
  return r;
}

// Members without a name have the one that messages give them; a name given to another is skipped.
TEST(Reader, MembersWithoutANameAreSetByTheOneTheyGet) {
  const std::string text = R"(format = 1
[[shaft]]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40], ["b", 200, 50]]
[[disk]]
name = "disk 2"
at = "a:start"
mass = "1 kg"
[[disk]]
at = "a:end"
mass = "2 kg"
[[disk]]
at = "b:end"
mass = "3 kg"
[[unbalance]]
at = "a:end"
amount = "10 g.mm"
[[step]]
type = "modal"
)";
  const auto d = read(text, {"unbalance.unbalance 1.amount = 20 g.mm", "disk.disk 3.mass = 7 kg",
                             "disk.disk 4.mass = 8 kg", "disk.disk 2.mass = 6 kg",
                             "shaft.shaft.material = aluminium"});
  ASSERT_TRUE(d.diagnostics.empty()) << d.diagnostics.front().message;
  EXPECT_DOUBLE_EQ(d.model.unbalances.at(0).amount, 20e-6);
  std::vector<std::pair<std::string, double>> masses;
  for (const auto& disk : d.model.disks)
    masses.emplace_back(disk.name, disk.mass);
  const std::vector<std::pair<std::string, double>> wanted{
      {"disk 2", 6}, {"disk 3", 7}, {"disk 4", 8}};
  EXPECT_EQ(masses, wanted);
}

}  // namespace

// Hz, rpm and rad/s say the same thing wherever a frequency is asked for; the model keeps rad/s.
TEST(Reader, FrequenciesAreAngular) {
  const char* text = R"(format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40]]
[[bearing]]
name = "by frequency"
at = "a:start"
type = "table"
extrapolate = "hold"
columns = ["speed[rpm]", "frequency[Hz]", "kyy[N/m]", "kzz[N/m]"]
rows = [[0, 10, 1e7, 1e7], [0, 20, 2e7, 2e7]]
[[bearing]]
name = "other"
at = "a:end"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
[[step]]
name = "modes"
type = "modal"
max_frequency = "300 Hz"
[[step]]
name = "shaken"
type = "harmonic_response"
frequency = { start = "10 Hz", stop = "12000 rpm", points = 5 }
shapes_at = ["50 Hz"]
[[step.force]]
at = "a:end"
force = ["0 N", "1 N", "0 N"]
)";
  const auto d = read(text);
  ASSERT_TRUE(d.ok()) << d.report();
  const auto& table = std::get<model::TableBearing>(d.model.bearings[0].law);
  ASSERT_EQ(table.frequency.size(), 2u);
  EXPECT_DOUBLE_EQ(table.frequency[0], 10 * two_pi);
  EXPECT_DOUBLE_EQ(table.frequency[1], 20 * two_pi);
  EXPECT_EQ(table.speed.size(), 1u);
  EXPECT_DOUBLE_EQ(std::get<model::ModalStep>(d.model.steps[0].law).max_frequency, 300 * two_pi);
  const auto& shaken = std::get<model::HarmonicStep>(d.model.steps[1].law);
  EXPECT_DOUBLE_EQ(shaken.frequency->start, 10 * two_pi);
  EXPECT_DOUBLE_EQ(shaken.frequency->stop, 200 * two_pi);
  EXPECT_DOUBLE_EQ(shaken.shapes_at.at(0), 50 * two_pi);
}

TEST(Reader, PaperRotor) {
  const auto d = deck::read_deck("../../examples/01_paper_rotor/deck.toml");
  ASSERT_TRUE(d.ok()) << d.report();
  EXPECT_TRUE(d.diagnostics.empty()) << d.report();
  const model::Model& m = d.model;
  EXPECT_EQ(m.gravity, Vec3(0, 0, -9.81));
  ASSERT_EQ(m.shafts.size(), 1u);
  ASSERT_EQ(m.shafts[0].sections.size(), 1u);
  EXPECT_TRUE(m.shafts[0].sections[0].rigid);
  EXPECT_EQ(m.shafts[0].length(), 0.75);
  ASSERT_EQ(m.disks.size(), 1u);
  EXPECT_EQ(m.disks[0].at.s, 0.75);
  EXPECT_EQ(m.disks[0].mass, 5);
  EXPECT_EQ(m.disks[0].Ip, 5 * 0.25 / 8);
  EXPECT_EQ(m.disks[0].Id, 5 * 0.25 / 16);
  const auto& block = std::get<model::SpringBlock>(m.bearings.at(0).law);
  EXPECT_EQ(block.C1, 2000);
  EXPECT_EQ(block.C2, 500);
  EXPECT_EQ(m.bearings[0].at.s, 0);
  const auto& run = std::get<model::TransientStep>(m.steps.at(0).law);
  EXPECT_EQ(run.speed0, 50);
  EXPECT_EQ(run.duration, 10);
  EXPECT_EQ(run.start, model::TransientStep::Start::rest);
  EXPECT_EQ(run.integrator.method, "radau5");
  EXPECT_FALSE(m.output.vtk.empty());
}

TEST(Reader, Everything) {
  const auto d = deck::read_deck("good/everything.toml");
  ASSERT_TRUE(d.ok()) << d.report();
  EXPECT_TRUE(d.diagnostics.empty()) << d.report();
  const model::Model& m = d.model;
  EXPECT_EQ(m.title, "Everything \"quoted\", \xCE\xA9");
  EXPECT_EQ(m.gravity, Vec3(0.1, 0, -9.8));
  ASSERT_EQ(m.materials.size(), 4u);  // two of its own, steel and titanium used
  EXPECT_EQ(m.materials[0].name, "own");
  EXPECT_NEAR(m.materials[0].nu, 30 / (2 * 11.5) - 1,
              1e-15);  // one rounding each of E, G and their ratio
  EXPECT_NEAR(m.materials[0].rho, 0.283 * 0.45359237 / std::pow(0.0254, 3),
              1e-11);  // 7833 kg/m3 with a few roundings
  ASSERT_EQ(m.shafts.size(), 2u);
  const auto& hp = m.shafts[0];
  ASSERT_EQ(hp.sections.size(), 2u);
  EXPECT_EQ(hp.sections[0].name, "a");
  EXPECT_EQ(hp.sections[0].length, 0.1205);
  EXPECT_EQ(hp.sections[1].length, 0.25);
  EXPECT_EQ(hp.sections[1].id_r, 0.02);
  EXPECT_EQ(hp.sections[1].material, 1u);
  EXPECT_EQ(hp.sections[0].shear, model::ShearFactor::given);
  EXPECT_EQ(hp.sections[0].kappa, 0.85);
  EXPECT_EQ(hp.sections[0].min_elements, 2);
  EXPECT_EQ(hp.sections[0].max_element_length, 0.06);
  EXPECT_EQ(hp.damping.loss_factor, 0.002);
  EXPECT_EQ(hp.speed_ratio, -1.5);
  EXPECT_EQ(hp.axial_preload, -2000);
  const auto& lp = m.shafts[1];
  ASSERT_EQ(lp.sections.size(), 5u);
  EXPECT_EQ(lp.sections[0].length, 0.1016);
  EXPECT_EQ(lp.sections[1].od_r, 0.06);
  EXPECT_EQ(lp.sections[1].id_l, 0.01);
  EXPECT_EQ(lp.sections[1].stiffness_diameters->at(2), 0.038);
  EXPECT_EQ(lp.sections[1].min_elements, 3);
  EXPECT_FALSE(lp.sections[1].rotary_inertia);
  EXPECT_TRUE(lp.sections[2].rigid);
  EXPECT_EQ(lp.sections[3].general->Iy, 1.1e-7);
  EXPECT_EQ(lp.sections[4].constants->EI, 354500);
  EXPECT_EQ(m.disks[0].offset, Vec3(1e-3, 75e-6, 0));
  EXPECT_EQ(m.disks[0].at.shaft, 0u);
  EXPECT_EQ(m.disks[0].at.s, 0.1205);
  EXPECT_EQ(m.disks[1].at.shaft, 1u);
  EXPECT_NEAR(m.disks[1].at.s, 0.1016 + 0.1 + 0.005, 1e-15);
  EXPECT_NEAR(m.disks[1].mass, 7850 * pi / 4 * (0.26 * 0.26 - 0.14 * 0.14) * 0.055, 1e-13);
  EXPECT_EQ((*m.disks[2].inertia)(1, 2), -0.02);
  EXPECT_EQ(m.disks[3].mass, 1);  // "1 kg * (2 * (75 um))/(150 um)"
  const auto& linear = std::get<model::LinearBearing>(m.bearings[0].law);
  EXPECT_EQ(linear.K(1, 2), 1e6);
  EXPECT_EQ(linear.K(2, 1), -1e6);
  EXPECT_EQ(linear.K(4, 4), 1e4);
  EXPECT_EQ(linear.K(5, 5), 1e4);
  EXPECT_EQ(linear.C(3, 3), 1);
  EXPECT_EQ(linear.M(0, 0), 0.2);
  EXPECT_EQ(linear.setpoint[1], 10e-6);
  EXPECT_NEAR(linear.preload[1], 5 * 4.4482216152605, 1e-14);
  EXPECT_EQ(m.bearings[0].pedestal->mass, 60);
  EXPECT_EQ(m.bearings[0].pedestal->K(2, 2), 3.5e8);
  const auto& matrix = std::get<model::LinearBearing>(m.bearings[1].law);
  EXPECT_EQ(matrix.K(1, 5), 2e5);
  EXPECT_EQ(matrix.K(5, 1), 2e5);
  const auto& table = std::get<model::TableBearing>(m.bearings[3].law);
  ASSERT_EQ(table.speed.size(), 2u);
  EXPECT_NEAR(table.speed[1], 12000 * two_pi / 60, 1e-12);  // one rounding
  EXPECT_EQ((table.K[1].block<2, 2>(1, 1)), (Mat2() << 3e7, 2e5, -2e5, 3.1e7).finished());
  EXPECT_FALSE(table.monotone_cubic);
  EXPECT_TRUE(table.M.empty());
  const auto& rows = std::get<model::TableBearing>(m.bearings[4].law);
  EXPECT_EQ(rows.K[1](1, 1), 2e8);
  EXPECT_EQ(rows.C[1](2, 2), 1100);
  ASSERT_EQ(rows.M.size(), 2u);
  EXPECT_EQ(rows.M[1](1, 1), 0.5);
  const auto& held = std::get<model::RigidSupport>(m.bearings[5].law).held;
  EXPECT_EQ(held, (std::array<bool, 6>{true, true, false, false, false, true}));
  EXPECT_EQ(m.bearings[6].to->shaft, 1u);
  EXPECT_EQ(m.unbalances[0].amount, 12e-6);
  EXPECT_NEAR(m.unbalances[0].factor->at(1.05).f, 0.5, 1e-12);
  // ISO 21940-11: e omega = 2.5 mm/s at 9000 rpm, times the given mass
  EXPECT_NEAR(m.unbalances[2].amount, 100 * 6.3e-3 / (9000 * two_pi / 60), 1e-18);
  EXPECT_GT(m.unbalances[1].amount, 0);
  EXPECT_EQ(m.loads[1].factor->at(3).f, 2);
  EXPECT_EQ(m.loads[0].frame, model::LoadFrame::rotating);
  const auto& speed = std::get<model::PrescribedSpin>(m.drives[0].law).angle;
  EXPECT_NEAR(speed->at(0.25).df, 24, 1e-12);
  EXPECT_NEAR(speed->at(2).df, 72, 1e-12);
  EXPECT_NEAR(speed->at(0).f, pi / 18, 1e-15);
  const auto& polynomial = std::get<model::PrescribedSpin>(m.drives[1].law).angle;
  EXPECT_NEAR(polynomial->at(2).f, 22, 1e-12);
  const auto& motor = std::get<model::TorqueCurve>(m.drives[2].law);
  EXPECT_EQ(m.drives[2].kind, model::TorqueKind::fixed_direction);
  EXPECT_NEAR(motor.of_time->at(2.5).f, 2.5, 1e-12);
  EXPECT_EQ(motor.speed.size(), 2u);
  EXPECT_EQ(motor.quadratic, 2e-5);
  EXPECT_EQ(motor.power->power, 1e4);
  EXPECT_EQ(motor.governor->ki, 1);
  EXPECT_EQ(motor.dc->stall, 10);
  EXPECT_NEAR(std::get<model::TorqueCurve>(m.drives[3].law).of_time->at(1.5).f, 3.25, 1e-12);
  EXPECT_EQ(m.initial[0].shaft, 1u);
  EXPECT_NEAR(m.initial[0].gamma[1], pi / 36, 1e-16);
  EXPECT_EQ(m.probes[0].angles.size(), 2u);
  EXPECT_EQ(std::get<model::ModalStep>(m.steps[1].law).modes, 7);
  EXPECT_EQ(m.steps[1].from, "weight");
  EXPECT_TRUE(std::get<model::UnbalanceStep>(m.steps[4].law).speed.refine_peaks);
  EXPECT_EQ(std::get<model::TransientStep>(m.steps[6].law).speed0, two_pi);
  EXPECT_EQ(m.output.directory, "results/everything/base");
  EXPECT_TRUE(m.output.peak_to_peak);
  EXPECT_EQ(m.output.vtk[0].t1, 4.5);
  EXPECT_EQ(m.output.vtk[1].every, 1e-3);
}

TEST(Reader, ResolvedDeckSaysTheSame) {
  for (const auto& p : good_decks()) {
    const auto first = deck::read_deck(p);
    ASSERT_TRUE(first.ok()) << p << "\n" << first.report();
    const auto second =
        deck::read_deck_text(first.model.resolved, "resolved.toml");  // no other file is needed
    ASSERT_TRUE(second.ok()) << p << "\n" << second.report() << first.model.resolved;
    EXPECT_EQ(ModelDump(first.model).text(), ModelDump(second.model).text()) << p;
    const auto third = deck::read_deck_text(second.model.resolved, "resolved.toml");
    EXPECT_EQ(second.model.resolved, third.model.resolved) << p;
  }
}

// A slip of the pen is an error, or a deck that says the same again when it is resolved; nothing
// is left out without a word.
TEST(Reader, OneWrongLetterIsAnErrorOrAnotherDeck) {
  std::mt19937 rng(7);
  const std::string letters = "0123456789.-+eE_#[]\"'={},*/^: \n\tkmNradHzx";
  deck::ReadOptions options;
  options.files_allowed = false;
  int read_well = 0;
  for (const auto& p : good_decks()) {
    std::ifstream file(p);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (int k = 0; k < 100; ++k) {
      std::string slip = text;
      const std::size_t at = rng() % slip.size();
      const char letter = letters[rng() % letters.size()];
      if (rng() % 2)
        slip.insert(at, 1, letter);
      else
        slip[at] = letter;
      const auto first = deck::read_deck_text(slip, "deck.toml", options);
      if (!first.ok()) continue;
      ++read_well;
      const auto second = deck::read_deck_text(first.model.resolved, "resolved.toml", options);
      ASSERT_TRUE(second.ok()) << p << "\n" << second.report() << slip;
      EXPECT_EQ(ModelDump(first.model).text(), ModelDump(second.model).text()) << slip;
    }
  }
  EXPECT_GT(read_well, 200);
}

// Each key declares whether motion depends on it.
TEST(Reader, WhatMotionDependsOn) {
  const std::string base = std::string("format = 1\ntitle = \"one\"\n") + shaft_text + R"(
[[disk]]
name = "wheel"
at = "left:end"
mass = "3 kg"
Ip = "0.02 kg.m^2"
Id = "0.01 kg.m^2"
[[probe]]
name = "p"
at = "wheel"
[[step]]
name = "first"
type = "transient"
start = "rest"
duration = "1 s"
stop_speed = "900 rpm"
amplitude_limit = "1 mm"
checkpoint = "3 s"
[step.integrator]
tolerance = 1e-6
[[step]]
name = "second"
type = "transient"
start = "rest"
duration = "1 s"
initial_speed = "100 rpm"
[output]
every = "2 ms"
)";
  const auto moving = [](const std::string& text) {
    const auto d = read(text);
    EXPECT_TRUE(d.ok()) << d.report();
    return d.model.moving;
  };
  const model::MovingDeck before = moving(base);
  ASSERT_EQ(before.steps.size(), 2u);
  const auto change = [&](const std::string& from, const std::string& to) {
    std::string text = base;
    text.replace(text.find(from), from.size(), to);
    return moving(text);
  };
  const std::pair<const char*, const char*> idle[] = {{"\"one\"", "\"two\""},
                                                      {"name = \"p\"", "name = \"q\""},
                                                      {"duration = \"1 s\"", "duration = \"2 s\""},
                                                      {"900 rpm", "800 rpm"},
                                                      {"\"1 mm\"", "\"2 mm\""},
                                                      {"\"3 s\"", "\"4 s\""},
                                                      {"every = \"2 ms\"", "every = \"3 ms\""}};
  for (const auto& [from, to] : idle) {
    const model::MovingDeck after = change(from, to);
    EXPECT_EQ(after.machine, before.machine) << from;
    EXPECT_EQ(after.steps, before.steps) << from;
  }
  EXPECT_NE(change("\"3 kg\"", "\"4 kg\"").machine, before.machine);
  EXPECT_NE(change("300, 40", "300, 41").machine, before.machine);
  const model::MovingDeck finer = change("1e-6", "1e-7"), faster = change("100 rpm", "200 rpm");
  EXPECT_NE(finer.steps[0], before.steps[0]);
  EXPECT_EQ(finer.steps[1], before.steps[1]);
  EXPECT_EQ(faster.steps[0], before.steps[0]);
  EXPECT_NE(faster.steps[1], before.steps[1]);
  EXPECT_EQ(faster.machine, before.machine);
}

TEST(Reader, EveryEntityKeepsItsPlace) {
  const auto d = read(std::string("format = 1\n") + shaft_text +
                      "\n[[disk]]\nname = \"wheel\"\nat = \"left:end\"\nmass = \"1 kg\"\n");
  ASSERT_TRUE(d.ok()) << d.report();
  EXPECT_EQ(d.model.shafts[0].where.line, 3);
  EXPECT_EQ(d.model.disks[0].where.line, 8);
  EXPECT_EQ(d.model.disks[0].where.file, "deck.toml");
  EXPECT_EQ(d.model.disks[0].where.entity, "disk 'wheel'");
  EXPECT_EQ(d.model.disks[0].at.where.line, 10);
}

TEST(Reader, LineEndsAndByteOrderMark) {
  const std::string unix_text =
      std::string("format = 1\n") + shaft_text + "[[disk]]\nat = \"left:end\"\nmass = 3\n";
  std::string windows = "\xEF\xBB\xBF";
  for (char c : unix_text)
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read(unix_text).report(), read(windows).report());
  EXPECT_EQ(read(unix_text).errors, 1);
}

TEST(Reader, Overrides) {
  const std::string text =
      std::string("format = 1\n[parameters]\nm = \"1 kg\"\n") + shaft_text +
      "[[disk]]\nname = \"wheel\"\nat = \"left:end\"\nmass = \"${m}\"\n[[disk]]\nname = "
      "\"x.y\"\nat = \"left:end\"\nmass = \"1 kg\"\n";
  EXPECT_EQ(read(text, {"parameters.m=2 kg"}).model.disks[0].mass, 2);
  EXPECT_EQ(read(text, {"parameters.m=\"2 kg\""}).model.disks[0].mass, 2);
  EXPECT_EQ(read(text, {"disk.wheel.mass=3kg", "disk.1.mass=4kg"}).model.disks[1].mass, 4);
  EXPECT_EQ(read(text, {"disk.\"x.y\".mass=5kg"}).model.disks[1].mass, 5);
  EXPECT_EQ(read(text, {"model.gravity=0 m/s^2"}).model.gravity.norm(), 0);
  EXPECT_EQ(read(text, {"model.gravity=0"}).model.gravity.norm(), 0);
  EXPECT_EQ(read(text, {"model.chart_change=false"}).model.chart_change, false);
  EXPECT_EQ(read(text, {"shaft.rows=[[\"left\", 100, 40]]"}).model.shafts[0].length(), 0.1);
  EXPECT_EQ(read(text, {"title=two words"}).model.title, "two words");
}

TEST(Reader, IncludesJoinLists) {
  const fs::path folder = fs::temp_directory_path() / "whirl deck test with blanks";
  fs::create_directories(folder);
  std::ofstream(folder / "more disks.toml")
      << "[[disk]]\nname = \"first\"\nat = \"left:end\"\nmass = \"1 kg\"\n[model]\nchart_change = "
         "false\n";
  std::ofstream(folder / "a deck.toml") << "format = 1\ninclude = [\"more disks.toml\"]\n"
                                        << shaft_text
                                        << "[[disk]]\nname = \"second\"\nat = \"left:end\"\nmass = "
                                           "\"1 kg\"\n[model]\ngravity = \"1 m/s^2\"\n";
  const auto d = deck::read_deck(folder / "a deck.toml");
  ASSERT_TRUE(d.ok()) << d.report();
  ASSERT_EQ(d.model.disks.size(), 2u);
  EXPECT_EQ(d.model.disks[0].name, "first");
  EXPECT_EQ(d.model.gravity, Vec3(0, 0, -1));
  EXPECT_FALSE(d.model.chart_change);
  EXPECT_EQ(d.model.deck_name, "a deck");
  fs::remove_all(folder);
}

TEST(Reader, DefaultGravityAndNames) {
  const auto d = read(std::string("format = 1\n") + shaft_text +
                      "[[disk]]\nat = \"left:end\"\nmass = \"1 kg\"\n[[disk]]\nat = "
                      "\"left:end\"\nmass = \"1 kg\"\n");
  ASSERT_TRUE(d.ok()) << d.report();
  EXPECT_EQ(d.model.gravity, Vec3(0, 0, -9.80665));
  EXPECT_EQ(d.model.disks[0].name, "disk 1");
  EXPECT_EQ(d.model.disks[1].name, "disk 2");
  EXPECT_EQ(d.model.shafts[0].name, "shaft");
}

TEST(Reader, FilesCanBeRefused) {
  deck::ReadOptions o;
  o.files_allowed = false;
  const auto d = deck::read_deck_text(
      "format = 1\ninclude = [\"x.toml\"]\n[shaft]\nfile = \"shaft.csv\"\n", "deck.toml", o);
  EXPECT_EQ(d.errors, 2);
  EXPECT_NE(d.report().find("cannot read 'x.toml': files are not allowed here"), std::string::npos)
      << d.report();
}
