// Every kind of bearing from the deck to the assembled system: its tangents there, its equilibrium,
// its matrices.
#include <analysis/linearizer.hpp>
#include <assembly/build_system.hpp>
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <system/problem.hpp>
#include "../core/reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <ostream>
#include <random>
#include <stdexcept>

using namespace whirl;

namespace {

/// A steel shaft, 60 mm, 0.4 m, on stiff springs at its ends; `extra` stands at its middle.
std::string shaft_deck(const std::string& extra) {
  return R"(format = 1
[model]
gravity = "9.81 m/s^2"
[[shaft]]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 200, 60], ["b", 200, 60]]
[[bearing]]
name = "left"
at = "rotor/a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "2e6 N/m"
kzz = "2e6 N/m"
cyy = "200 N.s/m"
czz = "200 N.s/m"
[[bearing]]
name = "right"
at = "rotor/b:end"
type = "linear"
kyy = "2e6 N/m"
kzz = "2e6 N/m"
cyy = "200 N.s/m"
czz = "200 N.s/m"
)" + extra;
}

/// A second shaft beside or behind the first.
std::string second_shaft(const char* origin, const char* ratio) {
  return std::string(R"(
[[shaft]]
name = "second"
material = "steel"
)") +
         "origin = " + origin + "\nspeed_ratio = " + ratio + R"(
columns = ["name", "length[mm]", "od[mm]"]
rows = [["c", 300, 50]]
[[bearing]]
name = "second left"
at = "second/c:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "3e6 N/m"
kzz = "3e6 N/m"
[[bearing]]
name = "second right"
at = "second/c:end"
type = "linear"
kyy = "3e6 N/m"
kzz = "3e6 N/m"
)";
}

struct Case {
  const char* name;
  std::string deck;
  double size;  ///< of the generic displacements, m
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::string middle(const char* law) {
  return shaft_deck(std::string("[[bearing]]\nname = \"tested\"\nat = \"rotor/a:end\"\n") + law);
}

const char* const oil_film =
    "diameter = \"60 mm\"\nlength = \"25 mm\"\nclearance = \"60 um\"\nviscosity = \"20 mPa.s\"\n";

std::vector<Case> cases() {
  const std::string film = oil_film;
  std::vector<Case> c;
  const auto add = [&](const char* name, const std::string& law, double size = 8e-6) {
    c.push_back({name, middle(law.c_str()), size});
  };
  add("polynomial",
      "type = \"nonlinear_spring\"\ndirection = \"y\"\nshape = \"polynomial\"\ncoefficients = [\"0 "
      "N\", \"1e6 N/m\", \"0 N/m^2\", \"1e15 N/m^3\"]\ndamping2 = \"1e12 N.s/m^3\"");
  add("radial table",
      "type = \"nonlinear_spring\"\ndirection = \"radial\"\nshape = \"table\"\ncolumns = "
      "[\"deflection[um]\", \"force[N]\"]\nrows = [[0, 0], [20, 100], [40, 500]]");
  add("clearance",
      "type = \"nonlinear_spring\"\ndirection = \"z\"\nshape = \"clearance\"\ngap = \"1 "
      "um\"\nstiffness = \"1e7 N/m\"\nsmooth = \"20 um\"");
  add("angular",
      "type = \"nonlinear_angular_spring\"\ndirection = \"rz\"\nshape = "
      "\"polynomial\"\ncoefficients = [\"0 N.m\", \"1e4 N.m/rad\", \"0 N.m/rad^2\", \"1e9 "
      "N.m/rad^3\"]\ndamping = \"10 N.m.s/rad\"");
  add("short journal", "type = \"short_journal\"\n" + film);
  add("finite journal", "type = \"journal\"\nshape = \"two_grooves\"\n" + film);
  add("lobed journal on a pedestal",
      "type = \"journal\"\nshape = \"lobes\"\nlobes = 3\npreload = 0.5\nsupport = { mass = \"5 "
      "kg\", kyy = \"5e7 N/m\", kzz = \"5e7 N/m\", cyy = \"1e3 N.s/m\", czz = \"1e3 N.s/m\" }\n" +
          film);
  add("squeeze film",
      "type = \"squeeze_film\"\nfilm = \"cavitated\"\nstiffness = \"1e6 N/m\"\n" + film);
  add("full squeeze film", "type = \"squeeze_film\"\nfilm = \"full\"\n" + film);
  add("sealed squeeze film", "type = \"squeeze_film\"\nfilm = \"sealed\"\n" + film);
  add("deep groove",
      "type = \"ball\"\nballs = 8\nball_diameter = \"12 mm\"\npitch_diameter = \"60 "
      "mm\"\nclearance = \"-10 um\"\nc_radial = \"100 N.s/m\"");
  add("angular contact",
      "type = \"ball\"\nballs = 12\nball_diameter = \"10 mm\"\npitch_diameter = \"60 "
      "mm\"\ncontact_angle = \"25 deg\"\npreload = \"2 kN\"");
  add("roller",
      "type = \"roller\"\nrollers = 13\nroller_diameter = \"9 mm\"\nroller_length = \"10 "
      "mm\"\npitch_diameter = \"54 mm\"\nclearance = \"-10 um\"");
  add("rub",
      "type = \"rub\"\ngap = \"2 um\"\nstiffness = \"1e7 N/m\"\nfriction = 0.2\ndamping = \"0.3 "
      "s/m\"\nsupport = { mass = \"1 kg\", kyy = \"5e7 N/m\", kzz = \"5e7 N/m\" }");
  add("annular seal",
      "type = \"annular_seal\"\ndiameter = \"60 mm\"\nlength = \"30 mm\"\nclearance = \"200 "
      "um\"\npressure_drop = \"20 bar\"\ndensity = \"998 kg/m^3\"\nviscosity = \"1 mPa.s\"");
  add("linear with all entries",
      "type = \"linear\"\nkxx = \"1e6 N/m\"\nkyy = \"3e6 N/m\"\nkyz = \"1e6 N/m\"\nkzy = \"-2e6 "
      "N/m\"\nkzz = \"4e6 N/m\"\nkrr = \"1e4 N.m/rad\"\nkrxx = \"0 N.m/rad\"\ncyy = \"300 "
      "N.s/m\"\ncyz = \"20 N.s/m\"\nczz = \"400 N.s/m\"\ncrr = \"3 N.m.s/rad\"\nmyy = \"2 "
      "kg\"\nmzz = \"3 kg\"\nsetpoint = [\"0 um\", \"2 um\", \"-3 um\"]\npreload = [\"0 N\", \"10 "
      "N\", \"20 N\"]");
  add("spring block", "type = \"spring_block\"\nC1 = \"1e6 N/m\"\nC2 = \"1e4 N.m/rad\"");
  add("one sided",
      "type = \"nonlinear_spring\"\ndirection = \"y\"\nshape = \"one_sided\"\ngap = \"-20 "
      "um\"\nstiffness = \"1e7 N/m\"\nsmooth = \"5 um\"");
  const std::string columns =
      "columns = [\"speed[rpm]\", \"kyy[N/m]\", \"kyz[N/m]\", \"kzy[N/m]\", \"kzz[N/m]\", "
      "\"cyy[N.s/m]\", \"czz[N.s/m]\", \"myy[kg]\"";
  add("table", "type = \"table\"\n" + columns +
                   "]\nrows = [[0, 1e6, 1e5, -2e5, 2e6, 300, 200, 1], [2000, 2e6, 2e5, -3e5, 3e6, "
                   "200, 300, 2], [4000, 3e6, 5e5, -8e5, 3e6, 400, 300, 4]]");
  add("table by frequency",
      "type = \"table\"\n" + columns +
          ", \"frequency[Hz]\"]\nrows = [[0, 1e6, 1e5, -2e5, 2e6, 300, 200, 1, 0], [0, 2e6, 2e5, "
          "-2e5, 2e6, 200, 300, 2, 80], [4000, 3e6, 5e5, -8e5, 3e6, 400, 300, 4, 0], [4000, 3e6, "
          "6e5, -9e5, 4e6, 300, 300, 5, 80]]");
  add("mass on a rigid support",
      "type = \"rigid\"\ndirections = [\"y\", \"z\"]\nsupport = { mass = \"20 kg\", kyy = \"5e7 "
      "N/m\", kzz = \"6e7 N/m\", cyy = \"1e3 N.s/m\" }");
  add("cross coupling", "type = \"cross_coupling\"\nk = \"1e4 N/m\"");
  c.push_back({"coupling",
               shaft_deck(second_shaft("[\"400 mm\", \"0 mm\", \"0 mm\"]", "1") + R"([[bearing]]
name = "tested"
at = "rotor/b:end"
to = "second/c:start"
type = "coupling"
kxx = "1e6 N/m"
kyy = "1e8 N/m"
kzz = "2e8 N/m"
krr = "5e3 N.m/rad"
krxx = "1e5 N.m/rad"
crxx = "5 N.m.s/rad"
offset_y = "0.1 mm"
angle_z = "0.05 deg"
)"),
               8e-6});
  const char* gear = R"([[bearing]]
name = "tested"
at = "rotor/a:end"
to = "second/c:mid"
type = "gear"
teeth = 40
other_teeth = 20
pitch_diameter = "120 mm"
helix = "10 deg"
stiffness = "3e8 N/m"
stiffness_harmonics = [0.2]
error_harmonics = ["3 um"]
)";
  c.push_back({"gear",
               shaft_deck(second_shaft("[\"50 mm\", \"90 mm\", \"0 mm\"]", "-2") + gear +
                          "damping = \"1e3 N.s/m\"\n"),
               8e-6});
  c.push_back({"gear with backlash",
               shaft_deck(second_shaft("[\"50 mm\", \"90 mm\", \"0 mm\"]", "-2") + gear +
                          "backlash = \"1 um\"\ncontact_damping = \"0.5 s/m\"\n"),
               8e-6});
  // the shaft's own bearings on a table of two points and one internal coordinate (rows 1 to 3)
  c.push_back({"foundation", shaft_deck(R"([[bearing]]
name = "tested"
at = "rotor/a:end"
type = "linear"
kyy = "5e6 N/m"
kzz = "5e6 N/m"
[[foundation]]
name = "table"
coordinates = ["left.z", "tested.z", "mode", "left.y", "left.x", "tested.y", "right.y", "right.z"]
columns = ["row", "column", "K[N/m]", "C[N.s/m]", "M[kg]"]
rows = [[1, 1, 2e8, 1e4, 50], [2, 2, 2e8, 1e4, 50], [1, 2, -1e8, 0, 10], [3, 3, 1e7, 100, 1], [3, 1, 0, 0, 2], [2, 3, 0, 0, 2],
        [4, 4, 1e8, 0, 20], [5, 5, 1e8, 0, 20], [6, 6, 1e8, 0, 20], [7, 7, 1e8, 0, 20], [8, 8, 1e8, 0, 20]]
)"),
               8e-6});
  // support points that turn, circulatory and gyroscopic parts, masses that couple displacement and
  // rotation
  c.push_back({"foundation with rotations", shaft_deck(R"([[bearing]]
name = "tested"
at = "rotor/a:end"
type = "linear"
kyy = "5e6 N/m"
kzz = "5e6 N/m"
krr = "2e4 N.m/rad"
krxx = "3e4 N.m/rad"
cryy = "5 N.m.s/rad"
[[foundation]]
name = "table"
symmetric = false
coordinates = ["tested.y", "tested.z", "tested.rx", "tested.ry", "tested.rz", "tested.x", "left.y", "left.z", "left.rz", "mode"]
columns = ["row", "column", "K", "C", "M"]
rows = [[1, 1, "2e8 N/m", "1e4 N.s/m", "50 kg"], [2, 2, "3e8 N/m", "2e4 N.s/m", "50 kg"], [1, 2, "4e7 N/m", "3e3 N.s/m", 0], [2, 1, "-2e7 N/m", "-3e3 N.s/m", 0],
        [3, 3, "2e6 N.m/rad", "20 N.m.s/rad", "2 kg.m^2"], [4, 4, "3e6 N.m/rad", "30 N.m.s/rad", "3 kg.m^2"], [5, 5, "1e6 N.m/rad", 0, "3 kg.m^2"],
        [4, 5, "2e5 N.m/rad", "40 N.m.s/rad", 0], [5, 4, 0, "-40 N.m.s/rad", 0], [1, 5, "5e6 N/rad", "100 N.s/rad", "3 kg.m"], [5, 1, "3e6 N/rad", 0, "3 kg.m"],
        [6, 6, "2e8 N/m", 0, "50 kg"], [7, 7, "2e8 N/m", 0, "50 kg"], [8, 8, "2e8 N/m", 0, "50 kg"], [9, 9, "1e6 N.m/rad", 0, 0], [7, 1, "1e7 N/m", 0, "2 kg"], [1, 7, 0, 0, "2 kg"],
        [9, 4, "1e5 N.m/rad", 0, 0], [10, 10, "1e7 N/m", "100 N.s/m", "1 kg"], [10, 5, "1e5 N/rad", 0, "0.2 kg.m"], [5, 10, "1e5 N/rad", 0, "0.2 kg.m"]]
)"),
               8e-6});
  c.push_back({"intershaft",
               shaft_deck(second_shaft("[\"50 mm\", \"0 mm\", \"0 mm\"]", "1.5") + R"([[bearing]]
name = "tested"
at = "rotor/a:end"
to = "second/c:mid"
type = "roller"
rollers = 13
roller_diameter = "9 mm"
roller_length = "10 mm"
pitch_diameter = "54 mm"
clearance = "-10 um"
)"),
               8e-6});
  return c;
}

/// The same supports 8 mm off the node of a rigid hub.
std::vector<Case> cases_off_the_node() {
  std::vector<Case> out;
  for (Case c : cases()) {
    const auto replace = [&](const std::string& from, const std::string& to) {
      for (std::size_t at = c.deck.find(from); at != std::string::npos;
           at = c.deck.find(from, at + to.size()))
        c.deck.replace(at, from.size(), to);
    };
    if (c.deck.find("rotor/a:end") == std::string::npos) continue;
    replace("rotor/a:end", "rotor/hub:start + 12 mm");
    replace(R"("od[mm]"]
rows = [["a", 200, 60], ["b", 200, 60]])",
            R"("od[mm]", "rigid"]
rows = [["a", 180, 60, false], ["hub", 40, 60, true], ["b", 180, 60, false]])");
    replace("second/c:mid", "second/c:start + 142 mm");
    out.push_back(c);
  }
  return out;
}

struct Assembled {
  deck::Deck deck;
  meshes::Mesh mesh;
  assembly::Built built;
  explicit Assembled(const std::string& text) : deck(deck::read_deck_text(text, "deck.toml")) {
    if (!deck.ok()) throw std::runtime_error(deck.report());
    mesh = meshes::make_mesh(deck.model);
    built = assembly::build_system(deck.model, mesh);
  }
};

}  // namespace

// M, C and K of every kind of element in the assembled system are the derivatives of what it adds
// to the residual, to 1e-7 of the largest term in the row (terms in force units: entry times the
// size of its motion). Each kind alone, so that the shaft's elastic forces do not hide a film in
// their rounding. Eighth-order differences of a hundredth of the motion leave 1e-12. The ends of a
// film move without a grid to pass, but where one reaches the edge of its pad within that step the
// force has a bend in its slope: then the limit is taken with steps of a thousandth and a
// ten-thousandth, which leave 1e-10.
class SupportTangents : public ::testing::TestWithParam<Case> {};

TEST_P(SupportTangents, AreDerivativesInTheAssembledSystem) {
  const Case& c = GetParam();
  const Assembled m(c.deck);
  const system::System& s = m.built.system;
  system::Workspace w = s.make_workspace();
  const system::Frames frames = s.make_state().frames;
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  const Index n = s.size();
  VecX q(n), v(n), a(n);
  VecX q_size(n), v_size(n), a_size = VecX::Ones(n);
  for (Index k = 0; k < n; ++k) {
    const bool angle = k % 6 >= 3;
    q_size[k] = angle ? (k % 6 == 3 ? 1e-4 : 3e-5) : c.size;
    v_size[k] = angle ? 0.01 : 1e-3;
    q[k] = normal(rng) * q_size[k];
    v[k] = normal(rng) * v_size[k];
    a[k] = normal(rng);
    const auto line = static_cast<std::size_t>(std::max<Index>(0, s.node(k / 6).line));
    if (k % 6 == 3)
      v[k] +=
          300.0 * m.deck.model.shafts[std::min(line, m.deck.model.shafts.size() - 1)].speed_ratio;
  }
  s.impose(frames, 0.0, q, v, a);
  la::MCK exact = s.make_matrices();
  for (std::size_t k = 0; k < s.terms().size(); ++k) {
    const std::vector<std::size_t> only{k};
    SCOPED_TRACE(std::string(s.terms()[k]->kind()));
    ASSERT_TRUE(s.tangent(w, frames, 0.0, q, v, a, exact, &only));
    const la::BlockMatrix<6>* matrix[3] = {&exact.K, &exact.C, &exact.M};
    const VecX* size[3] = {&q_size, &v_size, &a_size};
    MatX dense[3];
    VecX row(n);
    ASSERT_TRUE(s.residual(w, frames, 0.0, q, v, a, row, &only));
    row = row.cwiseAbs();
    for (int what = 0; what < 3; ++what) {
      dense[what] = MatX::Zero(n, n);
      for (Index j = 0; j < n; ++j) {
        VecX e = VecX::Zero(n), column = e;
        e[j] = (*size[what])[j];
        matrix[what]->add_multiply(1.0, e, column);
        dense[what].col(j) = column;
      }
      row = row.cwiseMax(dense[what].cwiseAbs().rowwise().maxCoeff());
    }
    const double floor = 1e-6 * row.maxCoeff();  // a row of zeros has no scale of its own
    for (int what = 0; what < 3; ++what) {
      double worst = 0;
      for (Index j = 0; j < n; ++j) {
        if (!s.active()[static_cast<std::size_t>(j)]) continue;
        const auto at = [&](test::Real x) {
          VecX z[3] = {q, v, a}, r(n);
          z[what][j] += static_cast<double>(x) * (*size[what])[j];
          s.residual(w, frames, 0.0, z[0], z[1], z[2], r, &only);
          return Eigen::Matrix<test::Real, Eigen::Dynamic, 1>(r.cast<test::Real>());
        };
        double column = infinity;
        for (const test::Real h : {1e-2L, 1e-3L, 1e-4L}) {
          const VecX slope = test::central(at, h).cast<double>();
          double error = 0;
          for (Index i = 0; i < n; ++i)
            if (s.active()[static_cast<std::size_t>(i)])
              error =
                  std::max(error, std::abs(slope[i] - dense[what](i, j)) / std::max(row[i], floor));
          column = std::min(column, error);
          if (column < 1e-9) break;
        }
        worst = std::max(worst, column);
      }
      EXPECT_LT(worst, 1e-7) << "KCM"[what];
    }
  }
}

const auto test_name = [](const auto& info) {
  std::string name = info.param.name;
  for (char& x : name)
    x = std::isalnum(static_cast<unsigned char>(x)) ? x : '_';
  return name;
};
INSTANTIATE_TEST_SUITE_P(EveryKind, SupportTangents, ::testing::ValuesIn(cases()), test_name);
INSTANTIATE_TEST_SUITE_P(OffTheNode, SupportTangents, ::testing::ValuesIn(cases_off_the_node()),
                         test_name);

// Weight, at rest and turning: the supports carry it, and the matrices exist.
TEST(Supports, EquilibriumCarriesTheWeight) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Assembled m(c.deck);
    const system::System& s = m.built.system;
    analysis::SteadyRotation running;
    for (const auto& shaft : m.deck.model.shafts)
      running.ratio.push_back(shaft.speed_ratio);
    analysis::Linearizer linear(s, running);
    try {
      linear.at(200.0);
    } catch (const Error& e) {
      FAIL() << e.what();
    }
    const system::State& x = linear.equilibrium().state;
    Vec3 support = Vec3::Zero();
    const VecX& r = linear.equilibrium().reactions;
    const auto reaction = [&](Index k) { return r[k]; };
    double weight = 0;
    for (std::size_t l = 0; l < m.deck.model.shafts.size(); ++l)
      for (const auto& section : m.deck.model.shafts[l].sections)
        weight += 9.81 * 7850 * pi / 4 * section.od_l * section.od_l * section.length;
    const bool inside = linear.running().visit_revolution(
        x.frames, linear.equilibrium().Omega, x.q, [&](double part, const system::Workspace& w) {
          const auto node = [&](Index n) -> const system::NodeState& {
            return w.nodes[static_cast<std::size_t>(n)];
          };
          for (std::size_t i = 0; i < m.deck.model.bearings.size(); ++i)
            if (!m.deck.model.bearings[i].to)
              support += part * m.built.support_forces[i].force(node, w.context, reaction);
        });
    ASSERT_TRUE(inside);
    // the support forces on the shaft carry it alone; the foundation's own mass stands on its
    // matrices
    EXPECT_NEAR(support.z(), weight, 1e-6 * weight);
    EXPECT_EQ(m.built.support_forces.size(), m.deck.model.bearings.size());
  }
}
