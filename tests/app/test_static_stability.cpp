// Static steps that say whether their equilibrium is stable, and load paths that say when they did
// not get there.
#include "deck_run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

using namespace whirl::test;

namespace {

/// Cantilever column of 1 m and 4 mm under `load` times its Euler load pi^2 EI/(4 L^2) = 6.5113 N;
/// a step and other lines at the end.
std::string column(double load, const std::string& more) {
  return R"(format = 1
title = "column"
[parameters]
P = ")" + std::to_string(-6.5113180 * load) +
         R"( N"
[model]
gravity = "0 m/s^2"
[[material]]
name = "steel"
E = "210 GPa"
nu = 0.3
density = "7850 kg/m^3"
[shaft]
name = "column"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["column", 1000, 4, 20]]
[[bearing]]
name = "clamp"
at = "column:start"
type = "rigid"
directions = ["x", "y", "z", "ry", "rz"]
[[load]]
at = "column:end"
force = ["${P}", "0 N", "0 N"]
[output]
report = false
)" + more;
}

/// Two bars of half span 1 m and rise 0.1 m under a load at the apex; `elements` a bar, a step.
std::string shallow_arch(int elements, const std::string& step) {
  const std::string n = std::to_string(elements);
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "soft"
E = "1 MPa"
nu = 0.3
density = "1000 kg/m^3"
[[shaft]]
name = "bars"
material = "soft"
rotating = false
path = [{ to = ["1 m", "0.1 m", "0 m"] }, { to = ["2 m", "0 m", "0 m"] }]
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 1004.98756211209, 20, )" +
         n + R"(], ["b", 1004.98756211209, 20, )" + n +
         R"(]]
[[bearing]]
name = "left"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[bearing]]
name = "right"
at = "b:end"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "b:start"
force = ["0 N", "-1 N", "0 N"]
[output]
report = false
)" + step;
}

/// The text of a file.
std::string text_of(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

}  // namespace

TEST(StaticStability, ColumnBeyondItsBucklingLoad) {
  const std::string step = "[[step]]\nname = \"st\"\ntype = \"static\"\n";
  const DeckRun below(column(0.98, step));
  EXPECT_EQ(below.exit, 0) << below.log;
  EXPECT_FALSE(below.says("unstable")) << below.log;
  const DeckRun above(column(1.2, step));
  EXPECT_EQ(above.exit, 0) << above.log;
  EXPECT_TRUE(above.says("warning[W08]")) << above.log;
  EXPECT_TRUE(above.says("unstable equilibrium, 2 directions")) << above.log;
  const std::string summary = text_of(above.folder / "r" / "summary.json");
  EXPECT_NE(summary.find("\"unstable directions\": 2"), std::string::npos) << summary;
  // the direction is the first buckling shape, u = 1 - cos(pi x/2L)
  const Columns shape = above.csv("st_unstable_direction.csv");
  const std::size_t x = shape.column("x [m]"), y = shape.column("u_y [-]"),
                    z = shape.column("u_z [-]"), along = shape.column("u_x [-]");
  ASSERT_EQ(shape.rows.size(), 21u);
  const double tip = std::hypot(shape.rows.back()[y], shape.rows.back()[z]);
  for (const auto& row : shape.rows) {
    EXPECT_NEAR(std::hypot(row[y], row[z]) / tip, 1.0 - std::cos(M_PI / 2 * row[x]), 0.02)
        << row[x];  // at 1.2 of the load, not 1
    EXPECT_LT(std::abs(row[along]), 1e-9);
  }
}

TEST(StaticStability, SpeedSweepCountsToo) {
  const DeckRun run(column(1.2,
                           "[[step]]\nname = \"st\"\ntype = \"static\"\nspeeds = { start = \"0 "
                           "rpm\", stop = \"100 rpm\", points = 3 }\n"));
  EXPECT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("3 of them unstable")) << run.log;
  const Columns t = run.csv("st_equilibria.csv");
  ASSERT_EQ(t.rows.size(), 3u);
  for (const auto& row : t.rows) {
    EXPECT_EQ(row[t.column("equilibrium [-]")], 1);
    EXPECT_EQ(row[t.column("unstable directions [-]")], 2);
  }
}

TEST(StaticStability, NegativeSupportStiffness) {
  // a cantilever of some 8 N/m at its end, on 1e5 N/m in y and -1e5 N/m in z there
  const std::string spring = R"(
[[bearing]]
name = "far"
at = "column:end"
type = "linear"
kyy = "1e5 N/m"
kzz = "-1e5 N/m"
)";
  const DeckRun symmetric(column(0.1, spring + "[[step]]\nname = \"st\"\ntype = \"static\"\n"));
  EXPECT_TRUE(symmetric.says("unstable equilibrium, 1 direction")) << symmetric.log;
  // with cross-coupling the tangent is unsymmetric: det K < 0 proves divergence
  const DeckRun skew(column(
      0.1,
      spring +
          "kyz = \"1e3 N/m\"\nkzy = \"-1e3 N/m\"\n[[step]]\nname = \"st\"\ntype = \"static\"\n"));
  EXPECT_TRUE(skew.says("unstable equilibrium, 1 direction: it diverges at any mass and damping"))
      << skew.log;
  // cross-coupling alone makes no divergence
  const DeckRun whirl(
      column(0.1,
             "[[bearing]]\nname = \"far\"\nat = \"column:end\"\ntype = \"linear\"\nkyy = \"1e4 "
             "N/m\"\nkzz = \"1e4 N/m\"\nkyz = \"3e3 N/m\"\nkzy = \"-3e3 N/m\"\n"
             "[[step]]\nname = \"st\"\ntype = \"static\"\n"));
  EXPECT_EQ(whirl.exit, 0) << whirl.log;
  EXPECT_FALSE(whirl.says("unstable")) << whirl.log;
}

TEST(StaticStability, PathThatMissesItsLoad) {
  // they snap through; too few points to get to the load
  const DeckRun run(shallow_arch(4, R"([[step]]
name = "snap"
type = "static"
path = { load = 10, steps = 100, max_points = 30 }
)"));
  EXPECT_EQ(run.exit, 4) << run.log;
  EXPECT_TRUE(run.says("error[E69]")) << run.log;
  EXPECT_TRUE(run.says("max_points")) << run.log;
  EXPECT_TRUE(std::filesystem::exists(run.folder / "r" / "snap_path.csv"));
  EXPECT_NE(text_of(run.folder / "r" / "summary.json").find("E69"), std::string::npos);
}

TEST(StaticStability, BifurcationOfTheColumn) {
  const std::string path =
      "[[step]]\nname = \"st\"\ntype = \"static\"\npath = { load = 1.2, steps = 12";
  const DeckRun straight(column(1.0, path + " }\n"));
  EXPECT_EQ(straight.exit, 0) << straight.log;
  EXPECT_TRUE(straight.says("bifurcation 1 at load factor")) << straight.log;
  EXPECT_TRUE(straight.says("0 unstable directions before, 2 after")) << straight.log;
  const Columns c = straight.csv("st_critical_points.csv");
  ASSERT_EQ(c.rows.size(), 1u);
  EXPECT_NEAR(c.rows[0][c.column("load factor [-]")], 1.0,
              2e-5);  // 20 elements; shear and shortening 4e-6
  EXPECT_TRUE(std::filesystem::exists(straight.folder / "r" / "st_bifurcation_1.csv"));
  // the branch is the elastica: at 1.2 of the Euler load, k = sin(alpha/2), K(k)^2 = 1.2 pi^2/4
  const DeckRun bent(
      column(1.0, path + ", branch = 1 }\n[[probe]]\nname = \"tip\"\nat = \"column:end\"\n"));
  EXPECT_EQ(bent.exit, 0) << bent.log;
  double k = 0.5;
  for (int i = 0; i < 60; ++i) {
    const double K = std::comp_ellint_1(k), E = std::comp_ellint_2(k);
    k -= (K - std::sqrt(1.2) * M_PI / 2) / ((E / (1 - k * k) - K) / k);
  }
  const double K = std::comp_ellint_1(k);
  const auto end = bent.csv("st_path.csv").last();
  EXPECT_EQ(end.at("load factor [-]"), 1.2);
  EXPECT_NEAR(std::hypot(end.at("tip u_y [m]"), end.at("tip u_z [m]")), 2 * k / K, 2e-4);
  EXPECT_EQ(end.at("unstable directions [-]"), 0);
  const DeckRun none(column(0.5, path + ", branch = 1 }\n"));
  EXPECT_EQ(none.exit, 4) << none.log;
  EXPECT_TRUE(none.says("without the bifurcation")) << none.log;
}

TEST(StaticStability, BucklingAndItsPath) {
  const DeckRun run(column(1.0, "[[step]]\nname = \"b\"\ntype = \"buckling\"\nmodes = 2\n"));
  EXPECT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("at a bifurcation point")) << run.log;
  EXPECT_FALSE(run.says("W09")) << run.log;
  // a shallow arch: the state before buckling is not small, and the path has a limit point long
  // before the factor
  const DeckRun arch(shallow_arch(8, R"([[step]]
name = "b"
type = "buckling"
modes = 2
)"));
  EXPECT_EQ(arch.exit, 0) << arch.log;
  EXPECT_TRUE(arch.says("W09")) << arch.log;
}

// Euler loads of a round cantilever, (2 k - 1)^2 times the first and each double: four lie below the
// fifth in the list, and inertia counts them.
TEST(StaticStability, BucklingFactorsAreCounted) {
  const DeckRun run(column(1.0, "[[step]]\nname = \"b\"\ntype = \"buckling\"\nmodes = 5\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const whirl::io::Value c = run.summary("b").at("certificate");
  EXPECT_TRUE(c.at("complete").boolean()) << c.at("text").text();
  EXPECT_EQ(c.at("positive factors").number(), 4);
  EXPECT_EQ(c.at("negative factors").number(), 0);
  EXPECT_NEAR(c.at("size up to").number(), 25.0, 0.1);
  EXPECT_TRUE(run.says("counted by inertia")) << run.log;
}

// A torque of fixed direction changes the stiffness unsymmetrically: nothing is claimed.
TEST(StaticStability, BucklingUnderTorqueIsNotCounted) {
  const DeckRun run(column(1.0, R"([[load]]
at = "column:end"
moment = ["1 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "b"
type = "buckling"
modes = 4
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const whirl::io::Value c = run.summary("b").at("certificate");
  EXPECT_FALSE(c.at("complete").boolean()) << c.at("text").text();
  EXPECT_NE(c.at("text").text().find("not symmetric"), std::string::npos);
}

// Held at both ends and hot, a shaft has buckled before any load acts, in both planes: there is no
// factor to find, and the step says why.
TEST(StaticStability, BucklingOfWhatHasBuckledAlready) {
  const std::string hot = R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "210 GPa"
nu = 0.3
density = "7850 kg/m^3"
expansion = "12e-6 1/K"
[[shaft]]
name = "R"
material = "m"
temperature_rise = "50 K"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 500, 20, 6], ["b", 500, 20, 6]]
[[bearing]]
at = "0 mm"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "1000 mm"
type = "rigid"
directions = ["x", "y", "z"]
[[step]]
name = "b"
type = "buckling"
[output]
report = false
)";
  const DeckRun run(hot);
  EXPECT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("unstable already, in 2 directions")) << run.log;
  EXPECT_TRUE(run.says("W09")) << run.log;
  EXPECT_EQ(run.summary("b").at("unstable directions without loads").number(), 2);
}

// Where neither weight nor a load acts on a stable model, the deck alone tells it: `check` does.
TEST(StaticStability, BucklingWithoutLoadsIsFoundByCheck) {
  const DeckRun run(column(0.0, "[[step]]\nname = \"b\"\ntype = \"buckling\"\n"));
  EXPECT_TRUE(run.says("E79")) << run.log;
  EXPECT_TRUE(run.says("no load that is scaled"))
      << run.log;  // heat and preloads may yet buckle it
  const auto check = [&](const std::string& deck) {
    return std::system(
        ("cd '" + run.folder.string() + "' && '" WHIRL_EXE "' check " + deck + " >check.txt 2>&1")
            .c_str());
  };
  EXPECT_NE(check("d.toml"), 0);
  std::ostringstream said;
  said << std::ifstream(run.folder / "check.txt").rdbuf();
  EXPECT_NE(said.str().find("E79"), std::string::npos) << said.str();
  EXPECT_EQ(check("d.toml --set 'parameters.P=-1 N'"), 0);
}

// A shaft that turns, rigidly joined to one that stands: not a missing support.
TEST(StaticStability, JointThatContradictsTheRotationIsNamed) {
  const DeckRun run(R"(format = 1
[[shaft]]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 400, 50, 2], ["b", 400, 50, 2]]
[[shaft]]
name = "S"
material = "steel"
rotating = false
origin = ["400 mm", "0 mm", "0 mm"]
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["c", 400, 50, 2]]
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
[[joint]]
name = "flange"
kind = "rigid"
at = "S/c:start"
to = "R/a:end"
[[step]]
name = "s"
type = "static"
[output]
report = false
)");
  EXPECT_NE(run.exit, 0);
  EXPECT_TRUE(run.says("E75")) << run.log;
  EXPECT_TRUE(run.says("flange")) << run.log;
  EXPECT_TRUE(run.says("'rotating'")) << run.log;
  EXPECT_FALSE(run.says("buckles")) << run.log;
}

// A window of time that no transient reaches is said before anything runs.
TEST(StaticStability, WindowAfterTheEndIsNamed) {
  const std::string run = "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"1 ms\"\n";
  const auto deck = [&](const std::string& window) {
    std::string text = column(0.1, run);
    return text.replace(text.find("report = false"), 14, "report = false\nwindow = " + window);
  };
  EXPECT_TRUE(DeckRun(deck("[\"1 s\", \"2 s\"]")).says("holds nothing"));
  EXPECT_FALSE(DeckRun(deck("[\"0.5 ms\", \"2 s\"]")).says("holds nothing"));
  const auto frames = [&](const std::string& window) {
    return column(0.1, run) + "[[output.vtk]]\nwindow = " + window + "\n";
  };
  EXPECT_TRUE(DeckRun(frames("[\"1 s\", \"2 s\"]")).says("no frame would be written"));
  EXPECT_FALSE(DeckRun(frames("[\"0.5 ms\", \"2 s\"]")).says("holds nothing"));
}

namespace {

/// Rigid bars of 1 m in a row, each on a hinge spring of 100 N m/rad, under an end load of P N.
std::string bars_on_hinges(int bars, double P) {
  std::string deck = R"(format = 1
[model]
gravity = "0 m/s^2"
[output]
report = false
)";
  for (int k = 0; k < bars; ++k)
    deck += fmt::format(R"([[shaft]]
name = "bar{0}"
rotating = false
origin = ["{0} m", "0 m", "0 m"]
[[shaft.section]]
name = "b{0}"
length = "1 m"
rigid = true
[[disk]]
name = "d{0}"
at = "b{0}:end"
mass = "1 kg"
Ip = "0.1 kg.m^2"
Id = "0.1 kg.m^2"
[[joint]]
name = "h{0}"
at = "b{0}:start"
kind = "hinge"
axis = [0, 0, 1]
stiffness = "100 N.m/rad"
{1}
)",
                        k, k == 0 ? "" : fmt::format("to = \"b{}:end\"", k - 1));
  return deck + fmt::format("[[load]]\nat = \"b{}:end\"\nforce = [\"-{} N\", \"0 N\", \"0 N\"]\n",
                            bars - 1, P);
}

constexpr const char* path_and_buckling =
    "[[step]]\nname = \"st\"\ntype = \"static\"\npath = {}\n[[step]]\nname = \"b\"\ntype = "
    "\"buckling\"\n";

}  // namespace

// P_cr = k/L = 100 N. Nothing moves before it, and some point of the path or of the search falls on the
// load at which the tangent is singular.
TEST(StaticStability, ABarOnAHingeIsLocatedAtAnyLoad) {
  for (const double P : {160.0, 170.0, 200.0, 250.0, 399.0, 400.0, 401.0, 800.0, 1600.0}) {
    const DeckRun run(bars_on_hinges(1, P) + path_and_buckling);
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_FALSE(run.says("W09")) << run.log;
    const Columns c = run.csv("st_critical_points.csv");
    ASSERT_EQ(c.rows.size(), 1u) << P << run.log;
    EXPECT_NEAR(c.rows[0][c.column("load factor [-]")], 100.0 / P, 1e-8) << P;
    EXPECT_NEAR(run.summary("b").at("on the path").at("load factor").number(), 100.0 / P, 1e-8)
        << P;
  }
  const DeckRun branch(bars_on_hinges(1, 400.0) +
                       "[[step]]\nname = \"st\"\ntype = \"static\"\npath = { branch = 1 }\n");
  EXPECT_EQ(branch.exit, 0) << branch.log;
}

// Eigenvalues of [[2, -1], [-1, 1]] k/L are (3 -+ sqrt 5)/2; the load ends on the second, or has the first
// half way.
TEST(StaticStability, TwoBarsOnHingesAreLocated) {
  const double first = 50.0 * (3.0 - std::sqrt(5.0)), second = 50.0 * (3.0 + std::sqrt(5.0));
  for (const double P : {400.0, 2.0 * first, second}) {
    const DeckRun run(bars_on_hinges(2, P) + path_and_buckling);
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_FALSE(run.says("W09")) << run.log;
    const Columns c = run.csv("st_critical_points.csv");
    ASSERT_EQ(c.rows.size(), P == 400.0 ? 2u : 1u) << P << run.log;
    EXPECT_NEAR(c.rows[0][c.column("load factor [-]")], first / P, 1e-8) << P;
    if (P == 400.0) {
      EXPECT_NEAR(c.rows[1][c.column("load factor [-]")], second / P, 1e-8);
    }
  }
}

// A column far beyond its buckling load in bushes of crossed stiffness: every eigenvalue of the static tangent is
// complex, and what was counted among the real ones, nothing, is no stability.
TEST(StaticStability, CrossedStiffnessLeavesItOpen) {
  const auto standing = [](const std::string& crossed) {
    return R"(format = 1
[model]
gravity_direction = "-x"
[[shaft]]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["s", 2000, 12, 4], ["t", 4000, 12, 8]]
[[disk]]
name = "top"
at = "t:end"
mass = "60 kg"
Ip = "0.5 kg.m^2"
Id = "0.3 kg.m^2"
[[bearing]]
name = "foot"
at = "s:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
[[bearing]]
name = "bush"
at = "t:end"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
)" + crossed +
           R"([[step]]
name = "s"
type = "static"
[output]
report = false
)";
  };
  const DeckRun straight(standing(""));
  ASSERT_EQ(straight.exit, 0) << straight.log;
  EXPECT_TRUE(straight.says("unstable equilibrium")) << straight.log;
  const DeckRun crossed(standing("kyz = \"2e5 N/m\"\nkzy = \"-2e5 N/m\"\n"));
  ASSERT_EQ(crossed.exit, 0) << crossed.log;
  EXPECT_TRUE(crossed.says("W08")) << crossed.log;
  const whirl::io::Value said = crossed.summary("s").at("stability").at("stable");
  ASSERT_TRUE(said.is_text()) << crossed.log;
  EXPECT_NE(said.text().find("not decided"), std::string::npos);
}

// 2e5 N/m of springs less 5e5 N/m of a pull: nothing disturbs the rotor, which stands above its bearing for the
// whole run. The same of magnets whose control pulls by less than their bias pushes away.
TEST(StaticStability, TransientsThatBeginInAnUnstableEquilibriumSaySo) {
  const auto begun = [](const std::string& support) {
    return R"(format = 1
[[shaft]]
name = "rotor"
[[shaft.section]]
name = "body"
length = "1 m"
rigid = true
[[disk]]
name = "mass"
at = "body:mid"
mass = "20 kg"
Ip = "0.1 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
name = "guide"
at = "body:mid"
type = "linear"
kxx = "1e8 N/m"
krr = "1e8 N.m/rad"
)" + support +
           R"([[probe]]
name = "p"
at = "body:mid"
[[step]]
name = "run"
type = "transient"
start = "static"
duration = "20 ms"
[output]
report = false
)";
  };
  const auto springs = [&](const char* pull) {
    return begun(
        std::string(
            "[[bearing]]\nname = \"k\"\nat = \"body:mid\"\ntype = \"linear\"\nkyy = \"2e5 N/m\"\n"
            "kzz = \"2e5 N/m\"\n[[bearing]]\nname = \"n\"\nat = \"body:mid\"\ntype = "
            "\"nonlinear_spring\"\ndirection = \"radial\"\nshape = \"polynomial\"\ncoefficients = "
            "[\"0 N\", \"") +
        pull + " N/m\"]\n");
  };
  EXPECT_TRUE(DeckRun(springs("-5e5")).says("W08"));
  EXPECT_FALSE(DeckRun(springs("-1e5")).says("W08"));
  const auto magnets = [&](const char* gain) {
    return begun(
        std::string("[[bearing]]\nname = \"AMB\"\nat = \"body:mid\"\ntype = "
                    "\"magnetic\"\ncurrent_stiffness "
                    "= \"200 N/A\"\nposition_stiffness = \"1e6 N/m\"\nsensor_bandwidth = \"10 "
                    "kHz\"\namplifier_bandwidth = \"2.5 kHz\"\n[[bearing.control]]\ntype = "
                    "\"pid\"\np = \"") +
        gain + " A/m\"\ni = \"0 A/(m.s)\"\nd = \"20 A.s/m\"\nlag = \"30 us\"\n");
  };
  const DeckRun falls(magnets("4e3"));
  EXPECT_TRUE(falls.says("W13")) << falls.log;
  const DeckRun floats(magnets("1.4e4"));
  EXPECT_FALSE(floats.says("W13")) << floats.log;
}
