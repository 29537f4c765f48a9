// What linear results say of their limits: a mesh too coarse (W10), a response larger than a gap
// (W11), a table held beyond its end (W12) or with rows far apart (W16); and nothing where there is nothing to say.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <assembly/table_spacing.hpp>
#include <elements/supports/table_bearing.hpp>
#include <fmt/format.h>

using namespace whirl;
using whirl::test::Columns;
using whirl::test::DeckRun;
namespace io = whirl::io;

namespace {

std::string rotor(const std::string& mesh, const std::string& parts) {
  return R"(format = 1
[output]
report = false
)" + mesh +
         R"(
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 30], ["b", 500, 30]]
[[disk]]
name = "d"
at = "a:end"
mass = "5 kg"
Ip = "0.05 kg.m^2"
Id = "0.025 kg.m^2"
[[unbalance]]
at = "d"
amount = "200 g.mm"
[[bearing]]
name = "L"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "500 N.s/m"
czz = "500 N.s/m"
[[bearing]]
name = "R"
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "500 N.s/m"
czz = "500 N.s/m"
)" + parts;
}

constexpr const char* modes = "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 12\n";
constexpr const char* response =
    "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n"
    "speed = { start = \"500 rpm\", stop = \"4000 rpm\", points = 15 }\n";

}  // namespace

TEST(LinearLimits, ACoarseMeshIsNamed) {
  const DeckRun coarse(rotor("[model.mesh]\nmin_elements_per_section = 1\n", modes));
  EXPECT_EQ(coarse.exit, 0) << coarse.log;
  EXPECT_TRUE(coarse.says("W10")) << coarse.log;
  const auto modes_of = coarse.csv("m_modes.csv");
  double worst = 0;
  for (const auto& row : modes_of.rows)
    worst = std::max(worst, row[modes_of.column("mesh error [-]")]);
  EXPECT_GT(worst, 1e-3);
}

TEST(LinearLimits, AChosenMeshIsNot) {
  const DeckRun chosen(rotor("", modes));
  EXPECT_FALSE(chosen.says("W10")) << chosen.log;
}

TEST(LinearLimits, AResponseBeyondAGapIsNamed) {
  const auto stop = [](const char* gap) {
    return std::string("[[bearing]]\nname = \"stop\"\nat = \"a:end\"\ntype = \"rub\"\ngap = \"") +
           gap + "\"\nstiffness = \"1e7 N/m\"\n";
  };
  const DeckRun small(rotor("", stop("0.05 mm") + response));
  EXPECT_TRUE(small.says("W11")) << small.log;
  EXPECT_TRUE(small.says("'stop'")) << small.log;
  const DeckRun wide(rotor("", stop("500 mm") + response));
  EXPECT_FALSE(wide.says("'stop'")) << wide.log;
}

// A damper on a spring: 25 kg, unbalance a fifth of mass times clearance, 7000 rpm. The orbit of the
// cavitated film is 0.807 of the clearance, that of its coefficients for small motions 0.49.
TEST(LinearLimits, AFilmThatIsNoLongerThatOfSmallMotionsIsNamed) {
  const auto damper = [](const char* unbalance) {
    return whirl::test::lateral_mass(25, "0 m/s^2",
                                     std::string(R"([[bearing]]
name = "damper"
at = "mass"
type = "squeeze_film"
film = "cavitated"
diameter = "129.6 mm"
length = "23 mm"
clearance = "200 um"
viscosity = "6 mPa.s"
stiffness = "8e6 N/m"
[[unbalance]]
at = "mass"
amount = ")") + unbalance +
                                         R"( g.mm"
[[probe]]
at = "mass"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["7000 rpm"] }
[output]
report = false
)");
  };
  const DeckRun large(damper("1000"));
  ASSERT_EQ(large.exit, 0) << large.log;
  EXPECT_TRUE(large.says("W11")) << large.log;
  EXPECT_TRUE(large.says("'damper'")) << large.log;
  const double share = large.summary("u")
                           .at("gaps")
                           .at("damper")
                           .at("share of the film that the response takes")
                           .number();
  EXPECT_NEAR(share, 0.4906, 5e-3);  // of 24 looks a period
  const DeckRun small(damper("100"));
  EXPECT_FALSE(small.says("W11")) << small.log;
}

// The bearings stand in nodes of the first mode: the response to 200 g mm is a tenth of the shaft's
// length and tilts its ends by 0.4 rad.
TEST(LinearLimits, ATiltThatIsNotSmallIsNamed) {
  const DeckRun large(rotor("", response));
  ASSERT_EQ(large.exit, 0) << large.log;
  EXPECT_TRUE(large.says("would tilt the shaft by 0.406 rad")) << large.log;
  std::string less = rotor("", response);
  less.replace(less.find("200 g.mm"), 8, "20 g.mm");
  const DeckRun small(less);
  ASSERT_EQ(small.exit, 0) << small.log;
  EXPECT_FALSE(small.says("W11")) << small.log;
}

TEST(LinearLimits, AHeldTableIsNamed) {
  const auto table = [](const char* last) {
    return std::string(
               "[[bearing]]\nname = \"seal\"\nat = \"a:end\"\ntype = \"table\"\n"
               "extrapolate = \"hold\"\ncolumns = [\"speed[rpm]\", \"kyy[N/m]\", "
               "\"kzz[N/m]\"]\nrows = [[0, 1e4, 1e4], [") +
           last + ", 2e4, 2e4]]\n";
  };
  const DeckRun shorter(rotor("", table("3000") + response));
  EXPECT_TRUE(shorter.says("W12")) << shorter.log;
  const DeckRun enough(rotor("", table("4000") + response));
  EXPECT_FALSE(enough.says("W12")) << enough.log;
}

TEST(LinearLimits, PeaksAreRefinedUnlessSpeedsAreListed) {
  const DeckRun range(rotor("", response));
  EXPECT_GT(range.csv("u_response.csv").rows.size(), 20u) << range.log;
  const DeckRun listed(rotor(
      "",
      "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { values = [\"500 rpm\", "
      "\"4000 rpm\"] }\n"));
  EXPECT_EQ(listed.csv("u_response.csv").rows.size(), 2u) << listed.log;
}

namespace {

/// A run-up at 1000 rpm/s from 2000 rpm to 4000 rpm;
std::string run_up() {
  return R"([[drive]]
at = "a:start"
type = "speed"
speed = { type = "table", time = ["0 s", "2 s"], value = ["2000 rpm", "4000 rpm"] }
[[step]]
name = "t"
type = "transient"
duration = "2 s"
)";
}

std::string held_table(const char* last) {
  return std::string(
             "[[bearing]]\nname = \"seal\"\nat = \"a:end\"\ntype = \"table\"\n"
             "extrapolate = \"hold\"\ncolumns = [\"speed[rpm]\", \"kyy[N/m]\", "
             "\"kzz[N/m]\"]\nrows = [[0, 1e4, 1e4], [") +
         last + ", 2e4, 2e4]]\n";
}

/// A rotor of 5 kg on two short journals of 30 mm diameter at 3000 rpm.
std::string on_films(double length_mm, double clearance_um) {
  std::string d = R"(format = 1
[output]
report = false
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 200, 30], ["b", 200, 30]]
[[disk]]
name = "d"
at = "a:end"
mass = "5 kg"
Ip = "0.05 kg.m^2"
Id = "0.025 kg.m^2"
[[bearing]]
name = "thrust"
at = "a:start"
type = "rigid"
directions = ["x"]
)";
  for (const char* at : {"a:start", "b:end"})
    d += std::string("[[bearing]]\nname = \"film ") + at[0] + "\"\nat = \"" + at +
         "\"\ntype = \"short_journal\"\ndiameter = \"30 mm\"\nlength = \"" +
         std::to_string(length_mm) + " mm\"\nclearance = \"" + std::to_string(clearance_um) +
         " um\"\nviscosity = \"20 mPa.s\"\n";
  return d;
}

}  // namespace

TEST(LinearLimits, AHeldTableIsNamedInStatics) {
  const std::string still = "[[step]]\nname = \"s\"\ntype = \"static\"\nspeed = \"3500 rpm\"\n";
  EXPECT_TRUE(DeckRun(rotor("", held_table("3000") + still)).says("W12"));
  EXPECT_FALSE(DeckRun(rotor("", held_table("3600") + still)).says("W12"));
  const std::string sweep =
      "[[step]]\nname = \"s\"\ntype = \"static\"\nspeeds = { start = \"500 rpm\", stop = \"4000 "
      "rpm\", points = 4 }\n";
  EXPECT_TRUE(DeckRun(rotor("", held_table("3000") + sweep)).says("W12"));
}

TEST(LinearLimits, ATransientSaysFromWhenATableIsHeld) {
  const DeckRun beyond(rotor("", held_table("3000") + run_up()));
  EXPECT_EQ(beyond.exit, 0) << beyond.log;
  EXPECT_TRUE(beyond.says("W12")) << beyond.log;
  const io::Value held = beyond.summary("t").at("held tables").at("seal");
  // 3000 rpm is passed at 1 s, give or take the twist of the shaft
  EXPECT_NEAR(held.at("from [s]").number(), 1.0, 0.05);
  EXPECT_NEAR(held.at("fastest [rpm]").number(), 4000.0, 5.0);  // the shaft twists
  const DeckRun within(rotor("", held_table("4020") + run_up()));
  EXPECT_FALSE(within.says("W12")) << within.log;
}

namespace {

/// Stiffness of a seal at the middle against rpm: a peak of a width at 2000 rpm.
double peak_at_2000(double rpm, double width) {
  const double x = (rpm - 2000) / width;
  return 1e4 / (1 + x * x);
}

/// Its table from 0 to 4000 rpm.
std::string peak_table(double width, int rows) {
  std::string out =
      "[[bearing]]\nname = \"seal\"\nat = \"a:end\"\ntype = \"table\"\ncolumns = "
      "[\"speed[rpm]\", \"kyy[N/m]\", \"kzz[N/m]\"]\nrows = [";
  for (int i = 0; i < rows; ++i) {
    const double rpm = 4000.0 * i / (rows - 1), kk = peak_at_2000(rpm, width);
    out += fmt::format("[{}, {}, {}], ", rpm, kk, kk);
  }
  return out + "]\n";
}

model::TableBearing table_of(const std::vector<double>& place, bool of_frequency, double width) {
  model::TableBearing t;
  (of_frequency ? t.frequency : t.speed) = place;
  if (of_frequency) t.speed = {100.0};
  for (const double x : place) {
    Matrix<6> K = Matrix<6>::Zero();
    K(1, 1) = K(2, 2) = peak_at_2000(x, width);
    t.K.push_back(K);
    t.C.emplace_back(Matrix<6>::Zero());
  }
  return t;
}

}  // namespace

TEST(LinearLimits, RowsOfATableThatAreFarApartAreNamed) {
  const auto look = [](int rows, const std::string& step) {
    const DeckRun run(rotor("", peak_table(1000, rows) + step));
    EXPECT_EQ(run.exit, 0) << run.log;
    return run.says("W16");
  };
  const std::string transient =
      "[[drive]]\nat = \"a:start\"\ntype = \"speed\"\nspeed = \"1900 rpm\"\n[[step]]\nname = "
      "\"t\"\ntype = \"transient\"\nduration = \"1 ms\"\n";
  const std::string beside_a_row =
      "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"1900 rpm\"\n";
  const std::string at_a_row = "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"2000 rpm\"\n";
  for (const std::string& step : {std::string(response), transient, beside_a_row}) {
    EXPECT_TRUE(look(7, step)) << step;
    EXPECT_FALSE(look(41, step)) << step;
  }
  EXPECT_FALSE(look(7, at_a_row));
  // single speeds on rows have nothing between them
  const std::string many = "[[step]]\nname = \"s\"\ntype = \"static\"\nspeeds = { values = ";
  EXPECT_FALSE(look(5, many + "[\"1000 rpm\", \"2000 rpm\", \"3000 rpm\"] }\n"));
  EXPECT_TRUE(look(5, many + "[\"1000 rpm\", \"1900 rpm\", \"3000 rpm\"] }\n"));
}

// The estimate is no less than the error between the rows, and not much more.
TEST(LinearLimits, TheErrorBetweenRowsIsEstimated) {
  for (const bool of_frequency : {false, true})
    for (const int rows : {9, 17, 33, 65}) {
      std::vector<double> place;
      for (int i = 0; i < rows; ++i)
        place.push_back(4000.0 * i / (rows - 1));
      const model::TableBearing t = table_of(place, of_frequency, 1000);
      const double low = of_frequency ? 100 : 0, high = of_frequency ? 100 : 4000;
      const assembly::CoarsestRow row = assembly::coarsest_row(t, low, high);
      EXPECT_EQ(row.against_frequency, of_frequency);
      // between the rows as the program does
      std::vector<elements::CoefficientValues<2>> values;
      for (const Matrix<6>& K : t.K)
        values.push_back({K.block<2, 2>(1, 1), Matrix<2>::Zero(), Matrix<2>::Zero()});
      using Table = elements::CoefficientTable<2>;
      const Table table(place, values, Table::Between::monotone_cubic, Table::Outside::hold);
      double worst = 0;
      for (double x = 0; x < 4000; x += 7) {
        elements::CoefficientValues<2> v, dv;
        table.at(x, v, dv);
        worst = std::max(worst, std::abs(v.K(0, 0) / peak_at_2000(x, 1000) - 1));
      }
      EXPECT_GE(row.error, 0.7 * worst) << rows;
      EXPECT_LE(row.error, 4 * worst) << rows;
    }
}

TEST(LinearLimits, ALinearTransientBeyondAGapIsNamed) {
  const std::string stop =
      "[[bearing]]\nname = \"stop\"\nat = \"a:end\"\ntype = \"rub\"\ngap = \"0.05 "
      "mm\"\nstiffness = \"1e7 N/m\"\n";
  const std::string near_critical =
      "[[drive]]\nat = \"a:start\"\ntype = \"speed\"\nspeed = \"2100 rpm\"\n[[step]]\nname = "
      "\"t\"\ntype = \"transient\"\nduration = \"0.3 s\"\n";
  const DeckRun small(rotor("", stop + near_critical + "linear = true\n"));
  EXPECT_TRUE(small.says("W11")) << small.log;
  const io::Value gap = small.summary("t").at("gaps").at("stop");
  EXPECT_GT(gap.at("largest displacement [m]").number(), 5e-5);
  // the contact itself acts where motion is not linear
  EXPECT_FALSE(DeckRun(rotor("", stop + near_critical)).says("W11"));
}

TEST(LinearLimits, ACoarseMeshIsNamedInTransients) {
  const DeckRun coarse(
      rotor("[model.mesh]\nmin_elements_per_section = 1\naccuracy = 1e-6\n", run_up()));
  EXPECT_TRUE(coarse.says("W10")) << coarse.log;
  const DeckRun chosen(rotor("", run_up()));
  EXPECT_FALSE(chosen.says("W10")) << chosen.log;
  EXPECT_LT(chosen.summary("t").at("mesh").at("relative error of frequencies").number(), 1e-3);
}

TEST(LinearLimits, ABearingTooLongForTheShortTheoryIsNamedInEveryStep) {
  const std::string steps[] = {"[[step]]\nname = \"x\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n",
                               "[[step]]\nname = \"x\"\ntype = \"modal\"\nspeed = \"3000 rpm\"\n",
                               "[[drive]]\nat = \"a:start\"\ntype = \"speed\"\nspeed = \"3000 "
                               "rpm\"\n[[step]]\nname = \"x\"\ntype = "
                               "\"transient\"\nduration = \"20 ms\"\n"};
  for (const std::string& step : steps) {
    const DeckRun longer(on_films(24, 40) + step);
    EXPECT_EQ(longer.exit, 0) << longer.log;
    EXPECT_TRUE(longer.says("short bearings")) << longer.log;
    const DeckRun brief(on_films(9, 40) + step);
    EXPECT_FALSE(brief.says("short bearings")) << brief.log;
  }
}

namespace {

/// A disk of 10 kg on a massless shaft of 1.1e6 and 0.9e6 N/m in its two planes.
std::string asymmetric(const std::string& parts) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "massless"
E = "200 GPa"
density = "0 kg/m^3"
[[shaft]]
name = "shaft"
material = "massless"
[[shaft.section]]
name = "l"
length = "500 mm"
general = { A = "1000 mm^2", Iy = "93750 mm^4", Iz = "114583.33333333333 mm^4", J = "200000 mm^4", kappa_y = 1e9, kappa_z = 1e9 }
[[shaft.section]]
name = "r"
length = "500 mm"
general = { A = "1000 mm^2", Iy = "93750 mm^4", Iz = "114583.33333333333 mm^4", J = "200000 mm^4", kappa_y = 1e9, kappa_z = 1e9 }
[[disk]]
name = "mass"
at = "l:end"
mass = "10 kg"
Ip = "0.005 kg.m^2"
Id = "0.01 kg.m^2"
[[bearing]]
at = "l:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "r:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
at = "mass"
type = "linear"
cyy = "100 N.s/m"
czz = "100 N.s/m"
[[unbalance]]
at = "mass"
amount = "1000 g.mm"
[[probe]]
name = "p"
at = "mass"
[output]
report = false
)" + parts;
}

}  // namespace

// In axes that turn with the shaft the response stands still:
//   [1.1e6 - m W^2, -c W; c W, 0.9e6 - m W^2] u = m e W^2 (1, 0),
// a circle of radius |u| in space (F. M. Dimentberg, Flexural Vibrations of Rotating Shafts, 1961).
TEST(LinearLimits, UnbalanceMeetsTheTwoStiffnessesOfAnAsymmetricShaft) {
  const DeckRun run(asymmetric(
      "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { start = \"1500 rpm\", "
      "stop = \"4500 rpm\", points = 31, refine = \"no\" }\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("W13")) << run.log;  // within the band it bends out at its own speed
  const auto table = run.csv("u_response.csv");
  const std::size_t y = table.column("p y amplitude [m]"), z = table.column("p z amplitude [m]");
  for (const auto& row : table.rows) {
    const double W = row[0] * 2 * std::acos(-1.0) / 60, m = 10, c = 100, me = 1e-3;
    const double a = 1.1e6 - m * W * W, d = 0.9e6 - m * W * W, b = c * W;
    const double determinant = a * d + b * b;
    const double radius = me * W * W * std::hypot(d, b) / std::abs(determinant);
    EXPECT_NEAR(row[y], radius, 1e-6 * radius) << row[0];
    EXPECT_NEAR(row[z], radius, 1e-6 * radius) << row[0];
  }
}

TEST(LinearLimits, AMeanOfAStiffnessThatTurnsIsSaid) {
  EXPECT_TRUE(DeckRun(asymmetric(modes + std::string("speed = \"60 rpm\"\n"))).says("W14"));
  EXPECT_FALSE(DeckRun(rotor("", modes)).says("W14"));
}

// Motions without stiffness are told apart by what moves: nothing holds this shaft.
TEST(LinearLimits, RigidMotionsOfAFreeShaftAreOfTheirKinds) {
  const DeckRun run(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "free"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 400, 40], ["b", 300, 60]]
[[step]]
name = "m"
type = "modal"
modes = 8
[output]
report = false
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  std::ifstream file(run.folder / "r" / "m_real_roots.csv");
  const std::string roots{std::istreambuf_iterator<char>(file), {}};
  std::map<std::string, int> count;
  for (const char* kind : {"lateral", "torsional", "axial"})
    for (std::size_t at = roots.find(std::string(",") + kind + ",free"); at != std::string::npos;
         at = roots.find(std::string(",") + kind + ",free", at + 1))
      ++count[kind];
  EXPECT_EQ(count, (std::map<std::string, int>{{"lateral", 4}, {"torsional", 1}, {"axial", 1}}))
      << run.log;
}

// At rest the principal axes lie where they are: sqrt(k/m) in each; under its weight W the rotor is
// a pendulum of dE = W^2/2 (1/k_soft - 1/k_stiff) between its two positions, k_phi = 2 dE.
TEST(LinearLimits, AnAsymmetricShaftAtRestHasItsPrincipalModes) {
  std::string deck = asymmetric(
      "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 3\n"
      "[[step]]\nname = \"h\"\ntype = \"harmonic_response\"\n"
      "frequency = { values = [\"20 Hz\"] }\n"
      "[[step.force]]\nat = \"mass\"\nforce = [\"0 N\", \"1 N\", \"0 N\"]\n");
  deck.replace(deck.find("0 m/s^2"), 7, "9.81 m/s^2");
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_FALSE(run.says("W14")) << run.log;
  const auto modes = run.csv("m_modes.csv");
  const std::size_t f = modes.column("frequency [Hz]");
  const double two_pi = 2 * std::acos(-1.0), soft = 0.9e6, stiff = 1.1e6, m = 10;
  const double swing = m * m * 9.81 * 9.81 * (1 / soft - 1 / stiff);  // N m/rad
  // the damper takes 14e-6 of the lateral ones, the tilting and the sag of the disk up to 2e-4
  EXPECT_NEAR(modes.rows.at(0)[f], std::sqrt(swing / 0.005) / two_pi, 1e-4);
  EXPECT_NEAR(modes.rows.at(1)[f], std::sqrt(soft / m) / two_pi, 2e-4 * 47.7);
  EXPECT_NEAR(modes.rows.at(2)[f], std::sqrt(stiff / m) / two_pi, 2e-4 * 52.8);
  const auto response = run.csv("h_response.csv");
  const double w = two_pi * 20, dynamic = std::hypot(stiff - m * w * w, 100 * w);
  EXPECT_NEAR(response.rows.at(0)[response.column("p y amplitude [m]")], 1 / dynamic,
              1e-4 / dynamic);
}

namespace {

/// A wound tube on bearings: extension twists it, bending shears it. extra: added to a stiffness, N m^2,
/// or a mass, kg m, about y alone.
std::string tube(double stiffness, double mass, const std::string& step) {
  char section[900];
  std::snprintf(section, sizeof section, R"(
full.stiffness = [["5e7 N", 0, 0, "1.2e5 N.m", 0, 0],
                  [0, "1e7 N", 0, 0, "5e4 N.m", "2e4 N.m"],
                  [0, 0, "1e7 N", 0, "-2e4 N.m", "5e4 N.m"],
                  ["1.2e5 N.m", 0, 0, "3e3 N.m^2", 0, 0],
                  [0, "5e4 N.m", "-2e4 N.m", 0, "%.17g N.m^2", 0],
                  [0, "2e4 N.m", "5e4 N.m", 0, 0, "8e3 N.m^2"]]
full.mass = [["1.2 kg/m", 0, 0, 0, 0, 0], [0, "1.2 kg/m", 0, 0, 0, 0], [0, 0, "1.2 kg/m", 0, 0, 0],
             [0, 0, 0, "4e-4 kg.m", 0, 0], [0, 0, 0, 0, "%.17g kg.m", 0], [0, 0, 0, 0, 0, "2e-4 kg.m"]]
)",
                8e3 + stiffness, 2e-4 + mass);
  return R"(format = 1
[output]
report = false
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "tube"
[[shaft.section]]
name = "a"
length = "1 m"
min_elements = 6)" +
         std::string(section) + R"([[bearing]]
name = "L"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "2e6 N/m"
kzz = "2e6 N/m"
cyy = "300 N.s/m"
czz = "300 N.s/m"
[[bearing]]
name = "R"
at = "a:end"
type = "linear"
kyy = "2e6 N/m"
kzz = "2e6 N/m"
cyy = "300 N.s/m"
czz = "300 N.s/m"
)" + step;
}

}  // namespace

TEST(LinearLimits, ACoupledTubeThatIsAlikeAllAroundHasNoMean) {
  const std::string
      modal = "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 8\nspeed = \"9000 rpm\"\n",
      stability =
          "[[step]]\nname = \"s\"\ntype = \"stability\"\nspeed = { start = \"0 rpm\", "
          "stop = \"12000 rpm\", points = 7 }\n";
  const DeckRun d(tube(0, 0, modal + stability));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("W14")) << d.log;
  EXPECT_FALSE(d.says("not certified")) << d.log;
  EXPECT_TRUE(d.summary("s").at("certified").boolean()) << d.log;
  const DeckRun stiff(tube(500, 0, modal)), heavy(tube(0, 5e-5, modal));
  EXPECT_TRUE(stiff.says("the stiffness of the asymmetric rotor")) << stiff.log;
  EXPECT_TRUE(heavy.says("the inertia of the asymmetric rotor")) << heavy.log;
}

namespace {

/// 20 kg on 2e6 N/m and 300 N s/m, shaken by 3000 g mm at 1500 and 3000 rpm.
std::string shaken(const std::string& parts) {
  return whirl::test::lateral_mass(20, "0 m/s^2", R"([[bearing]]
name = "B"
at = "mass"
type = "linear"
kyy = "2e6 N/m"
kzz = "2e6 N/m"
cyy = "300 N.s/m"
czz = "300 N.s/m"
[[unbalance]]
at = "mass"
amount = "3000 g.mm"
[output]
report = false
)" + parts);
}
/// Its amplitude in m with 2e6 N/m, as k - m w^2 + i c w has it.
double shaken_at_3000_rpm() {
  const double w = 100 * pi;
  return 3e-3 * w * w / std::hypot(2e6 - 20 * w * w, 300 * w);
}
constexpr const char* two_speeds =
    "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { values = [\"1500 rpm\", "
    "\"3000 rpm\"] }\n";
/// linear = true: small motions.
std::string in_time(const char* keys) {
  return std::string(
             "[[drive]]\nat = \"mass\"\ntype = \"speed\"\nspeed = \"3000 rpm\"\nstep = \"t\"\n"
             "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"0.2 s\"\nstart = "
             "\"unbalance_response\"\n") +
         keys;
}
std::string open_stop(const char* gap, const char* shape = "clearance",
                      const char* direction = "y") {
  return fmt::format(
      "[[bearing]]\nname = \"stop\"\nat = \"mass\"\ntype = \"nonlinear_spring\"\ndirection = "
      "\"{}\"\nshape = \"{}\"\ngap = \"{}\"\nstiffness = \"1e8 N/m\"\n",
      direction, shape, gap);
}
/// The number behind a text of the log; NaN: it is not there.
double number_behind(const DeckRun& run, const std::string& text) {
  const std::size_t at = run.log.find(text);
  return at == std::string::npos ? std::nan("") : std::stod(run.log.substr(at + text.size()));
}

}  // namespace

// A stop 100 um away knows nothing of a small motion, and its share of nothing was nothing.
TEST(LinearLimits, PlayThatIsOpenAtRestIsNoticed) {
  const double force = 1e8 * (shaken_at_3000_rpm() - 100e-6);
  for (const char* direction : {"y", "z", "radial"})
    for (const char* shape : {"clearance", "one_sided"}) {
      if (std::string(shape) == "one_sided" && std::string(direction) == "radial") continue;
      const DeckRun run(shaken(open_stop("100 um", shape, direction) + two_speeds));
      ASSERT_EQ(run.exit, 0) << run.log;
      EXPECT_TRUE(run.says("W11")) << run.log;
      EXPECT_NEAR(number_behind(run, "takes 'stop' into contact, where it would press with "),
                  force, 0.012 * force)
          << direction << shape << run.log;
    }
  EXPECT_FALSE(DeckRun(shaken(open_stop("50 mm") + two_speeds)).says("W11"));
}

TEST(LinearLimits, PlayOfRollingBearingsAndTablesIsNoticed) {
  const auto bearing = [](const std::string& law) {
    return "[[bearing]]\nname = \"X\"\nat = \"mass\"\n" + law + two_speeds;
  };
  const std::string balls =
      "type = \"ball\"\nballs = 9\nball_diameter = \"10 mm\"\npitch_diameter = \"50 "
      "mm\"\nc_radial = \"200 N.s/m\"\nclearance = ";
  const std::string band =
      "type = \"nonlinear_spring\"\ndirection = \"y\"\nshape = \"table\"\ninterpolation = "
      "\"linear\"\ncolumns = [\"deflection[mm]\", \"force[N]\"]\nrows = [[-1, -5e4], [-0.1, 0], "
      "[0.1, 0], [1, 5e4]]\n";
  for (const std::string& law : {balls + "\"30 um\"\n", band}) {
    const DeckRun run(shaken(bearing(law)));
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_TRUE(run.says("takes 'X' into contact")) << run.log;
  }
  EXPECT_FALSE(DeckRun(shaken(bearing(balls + "\"20 mm\"\n"))).says("W11"));
}

// Unbalances of a couple: M = 2 m_u (50 mm) w^2 against (Id - Ip) w^2 and a stiffness of 1e5 N m/rad.
TEST(LinearLimits, AStopAgainstTiltIsNoticed) {
  const auto deck = [](const char* gap) {
    return whirl::test::lateral_mass(
        20, "0 m/s^2",
        fmt::format("[[bearing]]\nat = \"mass\"\ntype = \"linear\"\nkrr = \"1e5 "
                    "N.m/rad\"\ncrr = \"1 N.m.s/rad\"\n[[bearing]]\nname = \"stop\"\nat = "
                    "\"mass\"\ntype = \"nonlinear_angular_spring\"\ndirection = \"ry\"\nshape = "
                    "\"clearance\"\ngap = \"{}\"\nstiffness = \"1e7 N.m/rad\"\n[[unbalance]]\nat "
                    "= \"left:mid\"\namount = \"3000 g.mm\"\n[[unbalance]]\nat = "
                    "\"right:mid\"\namount = \"3000 g.mm\"\nphase = \"180 deg\"\n[[probe]]\nat = "
                    "\"left:start\"\n[output]\nreport "
                    "= false\n{}",
                    gap, two_speeds),
        R"("x", "y", "z")");
  };
  const DeckRun run(deck("0.001 deg"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const double w = 100 * pi, gap = 0.001 * pi / 180,
               tilt = 2 * 3e-3 * 0.05 * w * w / std::hypot(1e5 - (0.06 - 0.1) * w * w, w),
               moment = 1e7 * (tilt - gap);
  EXPECT_NEAR(number_behind(run, "takes 'stop' into contact, where it would turn back with "),
              moment, 0.012 * moment)
      << run.log;
  EXPECT_FALSE(DeckRun(deck("5 deg")).says("W11"));
}

// The same in time: the motion begins with that response.
TEST(LinearLimits, ALinearTransientNoticesWhatBends) {
  const double a = shaken_at_3000_rpm(), force = 1e8 * (a - 100e-6);
  const DeckRun run(shaken(open_stop("100 um") + in_time("linear = true\n")));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("step 't': at t = ")) << run.log;
  EXPECT_NEAR(
      number_behind(run, "the motion takes 'stop' into contact, where it would press with "), force,
      0.03 * force)
      << run.log;
  const std::string cubic =
      "[[bearing]]\nname = \"stop\"\nat = \"mass\"\ntype = \"nonlinear_spring\"\ndirection = "
      "\"z\"\nshape = \"polynomial\"\ncoefficients = [\"0 N\", \"1e4 N/m\", \"0 N/m^2\", \"1e11 "
      "N/m^3\"]\n";
  EXPECT_TRUE(DeckRun(shaken(cubic + in_time("linear = true\n"))).says("the motion takes 'stop'"));
  for (const std::string& deck : {open_stop("50 mm") + in_time("linear = true\n"),
                                  open_stop("100 um") + in_time("linear = false\n")})
    EXPECT_FALSE(DeckRun(shaken(deck)).says("W11"));
}

// The amplitude r of the response asks for |p + i w d/(1 + i w lag)| r/|1 + i w/(amplifier)| of
// current, and w times that of its rate.
TEST(LinearLimits, WhatAnAmplifierDoesNotGiveIsNoticed) {
  const auto magnet = [](const std::string& limits) {
    return "[[bearing]]\nname = \"m\"\nat = \"mass\"\ntype = \"magnetic\"\ncurrent_stiffness "
           "= \"200 N/A\"\nposition_stiffness = \"1e5 N/m\"\namplifier_bandwidth = \"2000 "
           "Hz\"\ncontrol = [{ type = \"pid\", p = \"20000 A/m\", d = \"30 A.s/m\", lag = "
           "\"150 us\" }]\n" +
           limits + "[[probe]]\nname = \"p\"\nat = \"mass\"\n";
  };
  const DeckRun run(
      shaken(magnet("max_current_rate = \"150 A/s\"\nmax_current = \"0.5 A\"\n") + two_speeds));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns response = run.csv("u_response.csv");
  const Complex iw(0, 100 * pi);
  const double r = response.last().at("p y amplitude [m]"),
               current = std::abs((2e4 + 30.0 * iw / (1.0 + iw * 150e-6)) /
                                  (1.0 + iw / (two_pi * 2000))) *
                         r;
  EXPECT_NEAR(number_behind(run, "the response needs "), current, 1e-3 * current) << run.log;
  EXPECT_TRUE(run.says("whose amplifier gives 0.5 A:")) << run.log;
  EXPECT_TRUE(run.says("whose amplifier gives 150 A/s:")) << run.log;
  EXPECT_FALSE(DeckRun(shaken(magnet("max_current_rate = \"5e4 A/s\"\nmax_current = \"90 A\"\n") +
                              two_speeds))
                   .says("W11"));
  const std::string slow = magnet("max_current_rate = \"150 A/s\"\n");
  const DeckRun rate(shaken(slow + two_speeds)), small(shaken(slow + in_time("linear = true\n")));
  EXPECT_NEAR(number_behind(rate, "the response needs "), 100 * pi * current,
              1e-3 * 100 * pi * current)
      << rate.log;
  EXPECT_NEAR(number_behind(small, "the motion needs "), 100 * pi * current,
              0.02 * 100 * pi * current)
      << small.log;
}
