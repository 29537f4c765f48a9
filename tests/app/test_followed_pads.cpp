// Transients of rotors on tilting pads whose films conserve mass, through the program: where they begin
// and settle, films that stay full, small motions against the modes, interruptions, threads.
#include "deck_run.hpp"
#include "disk_between_films.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <complex>

namespace followed_pads_tests {

using whirl::test::Columns;
using whirl::test::DeckRun;

constexpr double clearance = 80e-6;

struct Machine {
  std::string cavitation = "mass_conserving";
  std::string more{};   ///< keys of the bearings
  std::string parts{};  ///< of the model
  std::string every = "1 ms";
  std::string pads =
      "clearance = \"80 um\"\nthickness = \"15 mm\"\npads = 4\n"
      "first_pivot = \"-135 deg\"\n";
};

/// A disk between two bearings of four pads at 3000 rpm.
std::string rotor(const Machine& m, const std::string& steps) {
  const auto bearing = [&](const char* name, const char* at) {
    return fmt::format(R"([[bearing]]
name = "{}"
at = "{}"
type = "tilting_pad"
diameter = "80 mm"
length = "40 mm"
viscosity = "20 mPa.s"
{}arc = "72 deg"
preload = 0.3
cavitation = "{}"
{}
)",
                       name, at, m.pads, m.cavitation, m.more);
  };
  return whirl::test::disk_between(bearing("DE", "left:start") + bearing("NDE", "right:end"), steps,
                                   m.every, m.parts);
}
const std::string& at_rest = whirl::test::settled_at_speed;
const std::string unbalance = "[[unbalance]]\nat = \"left:end\"\namount = \"3000 g.mm\"\n";
using whirl::test::moves;

struct Place {
  double t, y, z;  ///< s; of the journal, m
};
std::vector<Place> path_of(const DeckRun& d) {
  EXPECT_EQ(d.exit, 0) << d.log;
  const Columns c = d.csv("t.csv");
  const std::size_t y = c.column("DE.y [m]"), z = c.column("DE.z [m]");
  std::vector<Place> out;
  for (const auto& row : c.rows)
    out.push_back({row[0], row[y], row[z]});
  return out;
}
/// Of the clearance.
double between(const Place& a, const Place& b) {
  return std::hypot(a.y - b.y, a.z - b.z) / clearance;
}

const std::string inert = "inertia = \"2e-4 kg.m^2\"\n";
const std::string elastic = inert +
                            "mass = \"0.5 kg\"\npivot_stiffness = \"3e8 N/m\"\n"
                            "pivot_damping = \"1e4 N.s/m\"\n";
/// Pads that differ, on pivots of three kinds: elastic, rigid, a line, rigid.
const Machine unlike_pads{.more = R"([[bearing.pad]]
pivot = "-135 deg"
pivot_stiffness = "3e8 N/m"
mass = "0.5 kg"
pivot_damping = "1e4 N.s/m"
inertia = "2e-4 kg.m^2"
[[bearing.pad]]
pivot = "-45 deg"
[[bearing.pad]]
pivot = "45 deg"
pivot_contact = { shape = "line" }
mass = "0.4 kg"
[[bearing.pad]]
pivot = "135 deg"
inertia = "1e-4 kg.m^2"
)",
                          .pads =
                              "thickness = [\"15 mm\", \"12 mm\", \"14 mm\", \"16 mm\"]\n"
                              "clearance = [\"80 um\", \"82 um\", \"78 um\", \"85 um\"]\n"};
const std::string massless_pivots = "pivot_stiffness = \"3e8 N/m\"\n";

// Begun in its own equilibrium a journal stays; let go in that of the momentary film, or in the middle of
// its bearing, it comes there: pads that follow at once, with inertia on pivots that give, or some of each.
// The momentary film has its equilibrium elsewhere by the grid alone.
TEST(FollowedPads, SettleInTheEquilibrium) {
  for (const Machine& m : {Machine{}, Machine{.more = elastic}, unlike_pads}) {
    const auto stays = path_of(DeckRun(rotor(m, moves("start = \"static\"", "0.05 s"))));
    EXPECT_LT(between(stays.front(), stays.back()), 1e-7) << m.more;
    const auto falls = path_of(DeckRun(rotor(m, moves("start = \"rest\"", "0.05 s"))));
    EXPECT_EQ(falls.front().y, 0.0);
    EXPECT_GT(between(falls.front(), stays.front()), 0.3);
    EXPECT_LT(between(falls.back(), stays.front()), 2e-4) << m.more;
  }
  const auto stays = path_of(DeckRun(rotor({}, moves("start = \"static\"", "1 ms"))));
  const DeckRun on(rotor({}, at_rest + moves("from = \"st\"", "0.05 s")));
  const auto comes = path_of(on);
  EXPECT_GT(between(comes.front(), stays.front()), 5e-4);
  EXPECT_LT(between(comes.front(), stays.front()), 0.005);
  EXPECT_LT(between(comes.back(), stays.front()), 1e-5);
  const whirl::io::Value energy = on.summary("t").at("energy");
  EXPECT_LT(std::abs(energy.at("largest defect [J]").number()),
            1e-6 * energy.at("supplied [J]").number());
}

// At a supply pressure at which no film ruptures the motion is that of films that do not conserve mass,
// but for the grid: from the middle of the bearing, with an unbalance. Pads have inertia, so that those of
// both films begin where they stand.
TEST(FollowedPads, FullFilmsMoveAsThoseOfReynolds) {
  Machine m{.more = inert + "grid = 288\nsupply_pressure = \"60 bar\"\n",
            .parts = unbalance,
            .every = "0.2 ms"};
  const std::string steps = moves("start = \"rest\"", "0.04 s");
  const auto followed = path_of(DeckRun(rotor(m, steps)));
  m.cavitation = "reynolds";
  const auto reynolds = path_of(DeckRun(rotor(m, steps)));
  ASSERT_EQ(followed.size(), reynolds.size());
  double worst = 0.0, moved = 0.0;
  for (std::size_t k = 0; k < followed.size(); ++k) {
    worst = std::max(worst, between(followed[k], reynolds[k]));
    moved = std::max(moved, between(followed[k], followed.back()));
  }
  EXPECT_GT(moved, 0.2);
  EXPECT_LT(worst, 0.002);
}

// A small motion in a mode dies away as `modal` has it, whose films are those of the momentary state: no
// film lies behind a ruptured one.
TEST(FollowedPads, SmallMotionsAreTheModes) {
  const DeckRun modes(
      rotor({}, "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"3000 rpm\"\nmodes = 2\n"));
  ASSERT_EQ(modes.exit, 0) << modes.log;
  const auto mode = modes.csv("m_modes.csv").named(modes.csv("m_modes.csv").rows.front());
  const double frequency = mode.at("frequency [Hz]");
  const double decay = mode.at("log decrement [-]") * frequency;
  ASSERT_GT(mode.at("forwardness [-]"), 0.99);
  const Machine m{.every = "0.5 ms"};
  const auto path = path_of(DeckRun(
      rotor(m, moves("start = \"mode\"\nmode_kind = \"lateral\"\nmode_amplitude = \"0.2 um\"\n"
                     "integrator = { tolerance = 1e-5 }",
                     "0.08 s"))));
  using Complex = std::complex<double>;
  const auto at = [&](std::size_t k) {
    return Complex(path[k].y - path.back().y, path[k].z - path.back().z);
  };
  const std::size_t from = 4, to = 16;
  Complex turned = 0.0;
  for (std::size_t k = from; k < to; ++k)
    turned += std::log(at(k + 1) / at(k));
  const Complex rate = turned / (path[to].t - path[from].t);
  EXPECT_NEAR(-rate.real(), decay, 0.01 * decay);
  EXPECT_NEAR(rate.imag() / (2.0 * M_PI), frequency, 0.005 * frequency);
}

namespace {

std::string read(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// `whirl run` on the deck of a run with a part before it and options behind it; the exit code.
int again(const DeckRun& d, const std::string& before, const std::string& options) {
  const std::string command = "cd '" + d.folder.string() + "' && " + before +
                              " '" WHIRL_EXE "' run d.toml " + options +
                              " >again.txt 2>&1 </dev/null";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void expect_same_bytes(Machine m) {
  const auto begun = std::chrono::steady_clock::now();
  m.parts = unbalance;
  const DeckRun whole(rotor(m, moves("start = \"static\"", "0.1 s")));
  ASSERT_EQ(whole.exit, 0) << whole.log;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  const std::string bytes = read(whole.folder / "r" / "t.csv");
  ASSERT_GT(bytes.size(), 1000u);
  for (const int jobs : {1, 2}) {
    ASSERT_EQ(again(whole, "", fmt::format("-o j{0} --jobs {0}", jobs)), 0);
    EXPECT_TRUE(read(whole.folder / fmt::format("j{}", jobs) / "t.csv") == bytes) << jobs;
  }
  int cuts = 0;
  for (double share = 0.5; share > 0.02 && cuts == 0; share *= 0.5) {
    std::filesystem::remove_all(whole.folder / "cut");
    const int code =
        again(whole, fmt::format("timeout -s INT {:.3f}", share * took.count()), "-o cut");
    cuts += code != 0;
  }
  ASSERT_EQ(cuts, 1);
  ASSERT_EQ(again(whole, "", "-o cut --resume"), 0);
  EXPECT_TRUE(read(whole.folder / "cut" / "t.csv") == bytes);
}

}  // namespace

// The oil of every cell is a part of the state: interrupted and gone on with from its checkpoint, and on
// any number of threads, a run writes the same bytes.
TEST(FollowedPads, InterruptedAndOnThreadsTheSameBytes) { expect_same_bytes({.more = inert}); }

TEST(FollowedPads, UnlikePadsInterruptedAndOnThreadsTheSameBytes) {
  expect_same_bytes(unlike_pads);
}

// Steps of other kinds take up what such a transient leaves, and the other way round.
TEST(FollowedPads, StepsGoOn) {
  const DeckRun d(rotor(
      {},
      moves("start = \"static\"", "5 ms") +
          "[[step]]\nname = \"st\"\ntype = \"static\"\nfrom = \"t\"\nspeed = \"3000 rpm\"\n"
          "[[step]]\nname = \"m\"\ntype = \"modal\"\nfrom = \"st\"\nspeed = \"3000 rpm\"\n"
          "modes = 2\n"
          "[[step]]\nname = \"on\"\ntype = \"transient\"\nfrom = \"t\"\nduration = \"5 ms\"\n"));
  EXPECT_EQ(d.exit, 0) << d.log;
  const DeckRun alone(
      rotor({}, "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"3000 rpm\"\nmodes = 2\n"));
  EXPECT_EQ(alone.exit, 0) << alone.log;
  const Columns with = d.csv("m_modes.csv"), without = alone.csv("m_modes.csv");
  const std::size_t f = with.column("frequency [Hz]");
  ASSERT_EQ(with.rows.size(), without.rows.size());
  for (std::size_t k = 0; k < with.rows.size(); ++k)
    EXPECT_NEAR(with.rows[k][f], without.rows[k][f], 1e-6 * without.rows[k][f]);
}

// From standstill to its speed on pivots that nothing but oil holds back. A pad that the journal has left
// may stay so: it comes to rest near the equilibrium, not always in it.
TEST(FollowedPads, RunUpFromStandstill) {
  const Machine m{.more = massless_pivots};
  std::string deck = rotor(m, moves("start = \"rest\"", "0.06 s"));
  const std::string constant = "speed = \"3000 rpm\"";
  deck.replace(deck.find(constant), constant.size(),
               "speed = { type = \"smooth\", time = [\"0 s\", \"0.02 s\"], "
               "value = [\"0 rpm\", \"3000 rpm\"] }");
  const auto path = path_of(DeckRun(deck));
  const auto stays = path_of(DeckRun(rotor(m, moves("start = \"static\"", "1 ms"))));
  EXPECT_LT(between(path.back(), stays.front()), 0.05);
  EXPECT_LT(between(path.back(), path[path.size() - 5]), 1e-3);
}

// A journal that stands outside its film leaves the oil no balance, and the run says so.
TEST(FollowedPads, SaysWhereOilHasNoBalance) {
  const DeckRun d(
      rotor({.parts = "[[initial]]\ndisplacement = [\"0 mm\", \"0 mm\", \"-0.2 mm\"]\n"},
            moves("start = \"rest\"", "1 ms")));
  EXPECT_NE(d.exit, 0);
  EXPECT_TRUE(d.says("bearing 'DE': its oil finds no balance")) << d.log;
}

}  // namespace followed_pads_tests
