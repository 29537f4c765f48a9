// Shafts, casings and sleeves from the text of a deck to their frequencies and deflections, against
// closed forms.
#include <analysis/spectra/whirl_modes.hpp>
#include <assembly/build_system.hpp>
#include <deck/deck.hpp>
#include <meshes/mesh.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::analysis;

namespace {

struct Deck {
  model::Model model;
  meshes::Mesh mesh;
  assembly::Built built;
  explicit Deck(const std::string& text) {
    const deck::Deck d = deck::read_deck_text(text);
    EXPECT_TRUE(d.ok()) << d.report();
    model = d.model;
    mesh = meshes::make_mesh(model);
    built = assembly::build_system(model, mesh);
  }
  SteadyRotation running() const {
    SteadyRotation r;
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      r.ratio.push_back(mesh.lines[l].rotating ? model.shafts[l].speed_ratio : 0.0);
    return r;
  }
  std::vector<WhirlMode> modes(double Omega, Index count) {
    Linearizer linear(built.system, running());
    return whirl_modes(linear, Omega, {.count = count, .motion = Motion::lateral});
  }
};

constexpr const char* pins = R"([[bearing]]
name = "left"
at = "0 m"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "right"
at = "1 m"
type = "rigid"
directions = ["y", "z"]
)";

std::string shaft(const std::string& section, const std::string& more = "") {
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
mesh = {{ max_element_length = "50 mm" }}
[[material]]
name = "iron"
E = "200 GPa"
nu = 0.25
density = "8000 kg/m^3"
[[shaft]]
name = "shaft"
material = "iron"
shear = "none"
rotary_inertia = false
{}
[[shaft.section]]
name = "body"
length = "1 m"
{}
)",
                     more, section);
}

double I(double d) { return pi / 64 * std::pow(d, 4); }
double A(double d) { return pi / 4 * d * d; }

}  // namespace

// A sleeve shrunk on: it has mass but does not stiffen. omega_k = (k pi/L)^2 sqrt(E I/(rho A)) with
// I of 40 mm and A of 60 mm.
TEST(ShaftDecks, SeparateMassAndStiffnessDiameters) {
  Deck d(shaft("od = \"60 mm\"\nstiffness_od = \"40 mm\"") + pins);
  const auto modes = d.modes(0.0, 6);
  for (int k = 1; k <= 3; ++k) {
    const double exact = std::pow(k * pi, 2) * std::sqrt(2e11 * I(0.04) / (8000 * A(0.06)));
    // order 6 with 20 elements: 1e-9 for the first
    for (const std::size_t i : {2 * k - 2, 2 * k - 1})
      EXPECT_NEAR(modes.at(i).frequency, exact, 1e-6 * exact) << k;
  }
  // a bore in the mass alone: a liner that carries no load
  Deck bored(
      shaft("od = \"60 mm\"\nid = \"20 mm\"\nstiffness_od = \"40 mm\"\nstiffness_id = \"30 mm\"") +
      pins);
  const double exact =
      pi * pi * std::sqrt(2e11 * (I(0.04) - I(0.03)) / (8000 * (A(0.06) - A(0.02))));
  EXPECT_NEAR(bored.modes(0.0, 1).at(0).frequency, exact, 1e-8 * exact);
}

// Distributed mass without stiffness.
TEST(ShaftDecks, AddedMass) {
  Deck d(shaft("od = \"40 mm\"\nadded_mass = \"12 kg/m\"") + pins);
  const double exact = pi * pi * std::sqrt(2e11 * I(0.04) / (8000 * A(0.04) + 12));
  EXPECT_NEAR(d.modes(0.0, 1).at(0).frequency, exact, 1e-8 * exact);
}

// A casing is a beam that does not turn: no splitting at any speed of the rotor inside; the rotor's
// own frequencies split.
TEST(ShaftDecks, CasingsDoNotTurn) {
  std::string text = shaft("od = \"60 mm\"");
  text.replace(text.find("rotary_inertia = false"), 22, "rotary_inertia = true");
  const std::string casing = R"([[shaft]]
name = "casing"
material = "iron"
rotating = false
shear = "none"
origin = ["0 mm", "0 mm", "0 mm"]
[[shaft.section]]
name = "barrel"
length = "1 m"
od = "200 mm"
id = "180 mm"
)";
  std::string supports;
  for (const char* line : {"shaft", "casing"})
    for (const char* end : {"left", "right"})
      supports += fmt::format(
          "[[bearing]]\nname = \"{} {}\"\nat = \"{}/{}\"\ntype = \"rigid\"\ndirections = [{}\"y\", "
          "\"z\"]\n",
          line, end, line, end == std::string("left") ? "0 m" : "1 m",
          end == std::string("left")
              ? (line == std::string("casing") ? "\"x\", \"rx\", " : "\"x\", ")
              : "");
  Deck d(text + casing + supports);
  const double Omega = 1000;
  const auto modes = d.modes(Omega, 8);
  // Rayleigh's beam: omega^2 (rho A + rho I k^2) = E I k^4; rotating, rho I k^2 (omega^2 - 2 omega
  // Omega) in its place
  const auto rayleigh = [](double EI, double rhoA, double rhoI, double speed) {
    const double k2 = pi * pi, a = rhoA + rhoI * k2, b = rhoI * k2 * speed;
    return (b + std::sqrt(b * b + a * EI * k2 * k2)) / a;
  };
  const double I_casing = I(0.2) - I(0.18), A_casing = A(0.2) - A(0.18);
  std::vector<double> exact;
  for (const double speed : {-Omega, Omega})
    exact.push_back(rayleigh(2e11 * I(0.06), 8000 * A(0.06), 8000 * I(0.06), speed));
  for (int twice = 0; twice < 2; ++twice)
    exact.push_back(rayleigh(2e11 * I_casing, 8000 * A_casing, 8000 * I_casing, 0));
  EXPECT_GT(exact[1] - exact[0], 1.0);
  for (const double w : exact) {
    double nearest = infinity;
    int hits = 0;
    for (const WhirlMode& m : modes) {
      nearest = std::min(nearest, std::abs(m.frequency - w));
      hits += std::abs(m.frequency - w) < 1e-7 * w;
    }
    EXPECT_LT(nearest, 1e-7 * w) << w;                // 20 elements: 1e-8
    EXPECT_EQ(hits, w == exact.back() ? 2 : 1) << w;  // the casing's two planes alike
  }
}

// A rotor hung in a casing by a bearing at mid-span: springs in series, 48 EI/L^3 of both beams and
// the bearing.
TEST(ShaftDecks, RotorInACasing) {
  const std::string casing = R"([[shaft]]
name = "casing"
material = "iron"
rotating = false
shear = "none"
[[shaft.section]]
name = "barrel"
length = "1 m"
od = "100 mm"
id = "90 mm"
[[bearing]]
name = "c left"
at = "casing/0 m"
type = "rigid"
directions = ["x", "rx", "y", "z"]
[[bearing]]
name = "c right"
at = "casing/1 m"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
name = "between"
at = "shaft/0.5 m"
to = "casing/0.5 m"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[bearing]]
name = "axial"
at = "shaft/0 m"
type = "rigid"
directions = ["x"]
[[load]]
at = "shaft/0.5 m"
force = ["0 N", "1 N", "0 N"]
)";
  Deck d(shaft("od = \"60 mm\"") + casing +
         "[[bearing]]\nname = \"guide\"\nat = \"shaft/0.5 m\"\ntype = \"linear\"\nkrr = \"1e4 "
         "N.m/rad\"\n");
  SteadySystem running(d.built.system, d.running());
  const Equilibrium e = EquilibriumSolver(running).solve(0.0);
  const double exact = 1e-6 + 1.0 / (48 * 2e11 * (I(0.1) - I(0.09)));
  const auto at = [&](const char* line) {
    for (const meshes::Station& s : d.mesh.stations)
      if (d.mesh.lines[static_cast<std::size_t>(s.line)].name == line && std::abs(s.s - 0.5) < 1e-9)
        return e.state.q[6 * s.at.node + 1];
    return whirl::nan;
  };
  EXPECT_NEAR(at("shaft"), exact, 1e-9 * exact);
  EXPECT_NEAR(at("casing"), exact - 1e-6, 1e-9 * exact);
}
