// Every kind of bearing from the deck to the assembled system: its tangents there, its equilibrium, its matrices.
#include <analysis/linear.hpp>
#include <assembly/build_system.hpp>
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <system/problem.hpp>

#include <gtest/gtest.h>

#include <algorithm>
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
)") + "origin = " + origin + "\nspeed_ratio = " + ratio + R"(
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
  double size;      ///< of the generic displacements, m
};

std::string middle(const char* law) { return shaft_deck(std::string("[[bearing]]\nname = \"tested\"\nat = \"rotor/a:end\"\n") + law); }

const char* const oil_film = "diameter = \"60 mm\"\nlength = \"25 mm\"\nclearance = \"60 um\"\nviscosity = \"20 mPa.s\"\n";

std::vector<Case> cases() {
  const std::string film = oil_film;
  std::vector<Case> c;
  const auto add = [&](const char* name, const std::string& law, double size = 8e-6) { c.push_back({name, middle(law.c_str()), size}); };
  add("polynomial", "type = \"nonlinear_spring\"\ndirection = \"y\"\nshape = \"polynomial\"\ncoefficients = [\"0 N\", \"1e6 N/m\", \"0 N/m^2\", \"1e15 N/m^3\"]\ndamping2 = \"1e12 N.s/m^3\"");
  add("radial table", "type = \"nonlinear_spring\"\ndirection = \"radial\"\nshape = \"table\"\ncolumns = [\"deflection[um]\", \"force[N]\"]\nrows = [[0, 0], [20, 100], [40, 500]]");
  add("clearance", "type = \"nonlinear_spring\"\ndirection = \"z\"\nshape = \"clearance\"\ngap = \"1 um\"\nstiffness = \"1e7 N/m\"\nsmooth = \"20 um\"");
  add("angular", "type = \"nonlinear_angular_spring\"\ndirection = \"rz\"\nshape = \"polynomial\"\ncoefficients = [\"0 N.m\", \"1e4 N.m/rad\", \"0 N.m/rad^2\", \"1e9 N.m/rad^3\"]\ndamping = \"10 N.m.s/rad\"");
  add("short journal", "type = \"short_journal\"\n" + film);
  add("finite journal", "type = \"journal\"\nshape = \"two_grooves\"\n" + film);
  add("lobed journal on a pedestal", "type = \"journal\"\nshape = \"lobes\"\nlobes = 3\npreload = 0.5\nsupport = { mass = \"5 kg\", kyy = \"5e7 N/m\", kzz = \"5e7 N/m\", cyy = \"1e3 N.s/m\", czz = \"1e3 N.s/m\" }\n" + film);
  add("squeeze film", "type = \"squeeze_film\"\nfilm = \"cavitated\"\nstiffness = \"1e6 N/m\"\n" + film);
  add("full squeeze film", "type = \"squeeze_film\"\nfilm = \"full\"\n" + film);
  add("sealed squeeze film", "type = \"squeeze_film\"\nfilm = \"sealed\"\n" + film);
  add("deep groove", "type = \"ball\"\nballs = 8\nball_diameter = \"12 mm\"\npitch_diameter = \"60 mm\"\nclearance = \"-10 um\"\nc_radial = \"100 N.s/m\"");
  add("angular contact", "type = \"ball\"\nballs = 12\nball_diameter = \"10 mm\"\npitch_diameter = \"60 mm\"\ncontact_angle = \"25 deg\"\npreload = \"2 kN\"");
  add("roller", "type = \"roller\"\nrollers = 13\nroller_diameter = \"9 mm\"\nroller_length = \"10 mm\"\npitch_diameter = \"54 mm\"\nclearance = \"-10 um\"");
  add("rub", "type = \"rub\"\ngap = \"2 um\"\nstiffness = \"1e7 N/m\"\nfriction = 0.2\ndamping = \"0.3 s/m\"\nsupport = { mass = \"1 kg\", kyy = \"5e7 N/m\", kzz = \"5e7 N/m\" }");
  add("annular seal", "type = \"annular_seal\"\ndiameter = \"60 mm\"\nlength = \"30 mm\"\nclearance = \"200 um\"\npressure_drop = \"20 bar\"\ndensity = \"998 kg/m^3\"\nviscosity = \"1 mPa.s\"");
  add("cross coupling", "type = \"cross_coupling\"\nk = \"1e4 N/m\"");
  c.push_back({"coupling", shaft_deck(second_shaft("[\"400 mm\", \"0 mm\", \"0 mm\"]", "1") + R"([[bearing]]
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
)"), 8e-6});
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
  c.push_back({"gear", shaft_deck(second_shaft("[\"50 mm\", \"90 mm\", \"0 mm\"]", "-2") + gear + "damping = \"1e3 N.s/m\"\n"), 8e-6});
  c.push_back({"gear with backlash", shaft_deck(second_shaft("[\"50 mm\", \"90 mm\", \"0 mm\"]", "-2") + gear + "backlash = \"1 um\"\ncontact_damping = \"0.5 s/m\"\n"), 8e-6});
  c.push_back({"intershaft", shaft_deck(second_shaft("[\"50 mm\", \"0 mm\", \"0 mm\"]", "1.5") + R"([[bearing]]
name = "tested"
at = "rotor/a:end"
to = "second/c:mid"
type = "roller"
rollers = 13
roller_diameter = "9 mm"
roller_length = "10 mm"
pitch_diameter = "54 mm"
clearance = "-10 um"
)"), 8e-6});
  return c;
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

// K and C of the assembled system are the derivatives of its residual; central differences of step h leave h^2 f''' and the
// rounding of f over h: 1e-6 of the largest entry of a row covers films and contacts at these steps.
TEST(Supports, AssembledTangentsAreDerivatives) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Assembled m(c.deck);
    const system::System& s = m.built.system;
    system::SystemProblem p(s);
    p.frames = s.make_state().frames;
    std::mt19937 rng(3);
    std::normal_distribution<double> normal;
    VecX q(s.size()), v(s.size()), a(s.size()), r(s.size()), plus(s.size()), minus(s.size());
    for (Index k = 0; k < s.size(); ++k) {
      const bool angle = k % 6 >= 3;
      q[k] = normal(rng) * (angle ? (k % 6 == 3 ? 1e-4 : 3e-5) : c.size), v[k] = normal(rng) * (angle ? 0.01 : 1e-3), a[k] = normal(rng);
      if (k % 6 == 3) v[k] += 300.0 * (m.deck.model.shafts[std::min<std::size_t>(static_cast<std::size_t>(std::max<Index>(0, m.mesh.nodes[static_cast<std::size_t>(k / 6)].line)), m.deck.model.shafts.size() - 1)].speed_ratio);
    }
    p.impose(0, q, v, a);
    p.linearize(0, q, v, a);
    for (int what = 0; what < 2; ++what) {
      // Columns far below the largest of their kind (axial rates, spins) are lost in the rounding of the residual: they are measured
      // against a thousandth of the largest.
      double largest[2] = {0, 0}, worst = 0;
      for (Index k = 0; k < s.size(); ++k) {
        VecX e = VecX::Zero(s.size()), column = e;
        e[k] = 1.0;
        if (what == 0) p.add_K(1.0, e, column);
        else p.add_C(1.0, e, column);
        largest[k % 6 >= 3] = std::max(largest[k % 6 >= 3], column.cwiseAbs().maxCoeff());
      }
      for (Index k = 0; k < s.size(); ++k) {
        if (!s.active()[static_cast<std::size_t>(k)]) continue;
        const bool angle = k % 6 >= 3;
        const double h = what == 0 ? (angle ? 1e-7 : 5e-10) : (angle ? 1e-4 : 1e-6);
        VecX x = what == 0 ? q : v;
        const double x0 = x[k];
        x[k] = x0 + h;
        ASSERT_TRUE(p.residual(0, what == 0 ? x : q, what == 0 ? v : x, a, plus));
        x[k] = x0 - h;
        ASSERT_TRUE(p.residual(0, what == 0 ? x : q, what == 0 ? v : x, a, minus));
        VecX e = VecX::Zero(s.size()), column = e;
        e[k] = 1.0;
        if (what == 0) p.add_K(1.0, e, column);
        else p.add_C(1.0, e, column);
        const VecX numeric = (plus - minus) / (2 * h);
        const double size = std::max(column.cwiseAbs().maxCoeff(), 1e-3 * largest[angle]);
        for (Index i = 0; i < s.size(); ++i)
          if (s.active()[static_cast<std::size_t>(i)]) worst = std::max(worst, std::abs(numeric[i] - column[i]) / size);
      }
      // C: the residual's elastic forces, 1e4 N, leave 1e-12 of rounding over a step of 1e-6 m/s; films allow no longer step
      EXPECT_LT(worst, what == 0 ? 2e-6 : 5e-5) << (what == 0 ? "K" : "C");
    }
  }
}

// Weight, at rest and turning: the supports carry it, and the matrices exist.
TEST(Supports, EquilibriumCarriesTheWeight) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Assembled m(c.deck);
    const system::System& s = m.built.system;
    analysis::Running running;
    for (const auto& shaft : m.deck.model.shafts) running.ratio.push_back(shaft.speed_ratio);
    analysis::Linearizer linear(s, running);
    try {
      linear.at(200.0);
    } catch (const Error& e) {
      FAIL() << e.what();
    }
    system::SystemProblem p(s);
    const system::State& x = linear.equilibrium().state;
    p.frames = x.frames;
    VecX r(s.size());
    // the mean over the revolution balances; what turns (mesh, cage) leaves its alternating part
    Vec3 support = Vec3::Zero();
    p.residual(x.t, x.q, x.v, x.a, r);
    p.power(x.t, x.q, x.v, x.a, r);
    const auto node = [&](Index n) -> const system::NodeState& { return p.workspace().nodes[static_cast<std::size_t>(n)]; };
    const auto reaction = [&](Index k) { return r[k]; };
    double weight = 0;
    for (std::size_t l = 0; l < m.deck.model.shafts.size(); ++l)
      for (const auto& section : m.deck.model.shafts[l].sections) weight += 9.81 * 7850 * pi / 4 * section.od_l * section.od_l * section.length;
    for (std::size_t i = 0; i < m.deck.model.bearings.size(); ++i)
      if (!m.deck.model.bearings[i].to) support += m.built.support_forces[i].force(node, 0.0, reaction);
    // support force over weight: the alternating part of a mesh or a cage is at most some per cent of it
    const bool alternates = std::string(c.name).find("gear") == 0 || std::string(c.name).find("groove") != std::string::npos;
    EXPECT_NEAR(support.z(), weight, (alternates ? 0.05 : 1e-6) * weight);
    EXPECT_EQ(m.built.support_forces.size(), m.deck.model.bearings.size());
  }
}
