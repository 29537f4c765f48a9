// The error that elements leave of frequencies: the estimate against modes on a mesh four times as
// fine, and the mesh the program chooses against the accuracy it promises, on random machines.
#include "../validation/deck_model.hpp"
#include "random_machines.hpp"

#include <analysis/spectra/whirl_modes.hpp>
#include <assembly/mesh_error.hpp>
#include <core/error.hpp>
#include <gtest/gtest.h>
#include <la/multiply.hpp>
#include <model/resolution.hpp>

#include <regex>

using namespace whirl;
using namespace whirl::analysis;
using whirl::test::DeckModel;
using whirl::test::rpm;

namespace {

constexpr Index listed = 8;

std::string with_elements(const std::string& deck, int factor) {
  std::string out;
  std::size_t from = 0;
  const std::regex key("min_elements = (\\d+)\n");
  for (std::sregex_iterator it(deck.begin(), deck.end(), key), end; it != end; ++it) {
    out += deck.substr(from, static_cast<std::size_t>(it->position()) - from);
    if (factor > 0) out += fmt::format("min_elements = {}\n", factor * std::stoi(it->str(1)));
    from = static_cast<std::size_t>(it->position() + it->length());
  }
  return out + deck.substr(from);
}

struct Spectrum {
  std::vector<WhirlMode> modes;  ///< that oscillate
  std::vector<double> error;     ///< estimated, relative
};

Spectrum spectrum_of(const DeckModel& d, double Omega, Index count) {
  Linearizer linear(d.built.system, d.running());
  ModesOptions o;
  o.count = count;
  o.certify = false;
  Spectrum out;
  const assembly::MeshError mesh(d.deck.model, d.mesh, d.built);
  std::vector<double> spin(d.deck.model.shafts.size(), Omega);
  for (WhirlMode& m : whirl_modes(linear, Omega, o)) {
    if (!m.oscillates()) continue;
    const la::MCK& k = linear.at(Omega);
    VecXc by_mass, by_damping;
    la::multiply(k.M, m.x, by_mass);
    la::multiply(k.C, m.x, by_damping);
    const Complex slope = m.x.dot(VecXc(2.0 * m.lambda * by_mass + by_damping));
    out.error.push_back(std::abs(mesh.defect(m.lambda, m.x, spin) / (slope * m.lambda)));
    out.modes.push_back(std::move(m));
  }
  return out;
}

/// Relative distance of a root from the nearest of a finer spectrum.
double moved(const WhirlMode& m, const Spectrum& fine) {
  double least = infinity;
  for (const WhirlMode& f : fine.modes)
    least = std::min(least, std::abs(f.lambda - m.lambda) / std::abs(m.lambda));
  return least;
}

}  // namespace

TEST(MeshError, EstimateAgreesWithAFinerMesh) {
  int compared = 0, small = 0;
  double worst_under = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const tests::RandomMachine machine(seed);
    const double Omega = 0.5 * machine.top_speed() * rpm;
    try {
      const DeckModel coarse(with_elements(machine.deck(), 1)),
          fine(with_elements(machine.deck(), 4));
      const Spectrum a = spectrum_of(coarse, Omega, listed),
                     b = spectrum_of(fine, Omega, listed + 4);
      for (std::size_t k = 0; k < a.modes.size(); ++k) {
        const double real = moved(a.modes[k], b), said = a.error[k];
        if (real > 0.03 || said > 0.03) continue;  // beyond first order
        ++compared;
        // Films and internal damping make the left vector another than the right one, by up to
        // the whole of it in heavily damped modes: the size of the error is what is told.
        EXPECT_LT(said, 8.0 * real + 1e-5) << "machine " << seed << ", mode " << k + 1;
        EXPECT_LT(real, 3.0 * said + 2e-6) << "machine " << seed << ", mode " << k + 1;
        worst_under = std::max(worst_under, real / (said + 2e-6));
        small += real < 1e-3;
      }
    } catch (const Error& e) {
      const std::string code = e.diagnostics().front().code;
      ASSERT_TRUE(code == "E75" || code == "E76") << e.what();
    }
  }
  EXPECT_GT(compared, 40);
  EXPECT_GT(compared - small, 5);  // errors worth estimating were among them
  std::printf("%d modes compared, at most %.2f times the estimate\n", compared, worst_under);
}

// Without damping the left vector is the right one. What is left is the second order: the corrected
// mass cancels most of the first, so that a fifth of a small error may be of second order.
TEST(MeshError, OfAConservativeRotorIsTheErrorItself) {
  const auto deck = [](int elements) {
    return fmt::format(R"(format = 1
[[shaft]]
name = "s"
material = "steel"
[[shaft.section]]
name = "p"
length = "0.6 m"
od = "30 mm"
min_elements = {0}
[[shaft.section]]
name = "q"
length = "0.4 m"
od_l = "30 mm"
od_r = "50 mm"
min_elements = {0}
[[disk]]
at = "p:end"
mass = "8 kg"
Ip = "0.2 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
at = "p:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "2e7 N/m"
kzz = "2e7 N/m"
[[bearing]]
at = "q:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
)",
                       elements);
  };
  const DeckModel coarse(deck(2)), fine(deck(16));
  const double Omega = 6000 * rpm;
  const Spectrum a = spectrum_of(coarse, Omega, 6), b = spectrum_of(fine, Omega, 8);
  int compared = 0;
  for (std::size_t k = 0; k < a.modes.size(); ++k) {
    const double real = moved(a.modes[k], b);
    if (!(a.modes[k].frequency > 1.0) || real > 0.05 || real < 1e-5) continue;
    EXPECT_NEAR(a.error[k] / real, 1.0, 0.25) << "mode " << k + 1 << ": " << real;
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

TEST(MeshError, ChosenMeshesKeepTheirAccuracy) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const tests::RandomMachine machine(seed);
    const double Omega = 0.5 * machine.top_speed() * rpm;
    const std::string step =
        fmt::format("[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"{} rad/s\"\nmodes = {}\n",
                    Omega, listed);
    const std::string bare = with_elements(machine.deck(), 0) + step;
    try {
      const DeckModel chosen(bare);
      const DeckModel fine(
          std::regex_replace(bare, std::regex("format = 1\n"),
                             "format = 1\n[model.mesh]\nmin_elements_per_section = 40\n"));
      const Spectrum a = spectrum_of(chosen, Omega, listed),
                     b = spectrum_of(fine, Omega, listed + 4);
      for (const WhirlMode& m : a.modes) {
        const double real = moved(m, b);
        EXPECT_LT(real, 1e-3) << "machine " << seed;
        worst = std::max(worst, real);
      }
    } catch (const Error& e) {
      const std::string code = e.diagnostics().front().code;
      ASSERT_TRUE(code == "E75" || code == "E76") << e.what();
    }
  }
  EXPECT_GT(worst, 0.0);
  std::printf("worst relative error of a frequency on chosen meshes: %.1e\n", worst);
}

TEST(MeshError, ElementsAreShorterWhereTheErrorReachesTheAccuracy) {
  // A pinned uniform slender shaft: consistent mass leaves (k h)^4/1440 of omega on short elements.
  const DeckModel d(R"(format = 1
[[shaft]]
name = "s"
material = "steel"
[[shaft.section]]
name = "p"
length = "1 m"
od = "10 mm"
shear = "none"
rotary_inertia = false
[[bearing]]
at = "p:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "p:end"
type = "rigid"
directions = ["y", "z"]
)");
  const model::Model& m = d.deck.model;
  const model::Shaft& shaft = m.shafts[0];
  const model::Section& s = shaft.sections[0];
  ASSERT_TRUE(model::mesh_is_chosen(m, s));
  const double E = m.materials[s.material].E, rho = m.materials[s.material].rho;
  const double radius2 = 0.01 * 0.01 / 16.0;  // I/A
  for (const int n : {3, 10, 40}) {
    const double h = 1.0 / n, k = std::pow(1440.0 * m.mesh_accuracy, 0.25) / h;
    const double omega = k * k * std::sqrt(E * radius2 / rho);
    const auto chosen = [&](double share) {
      return model::longest_element(m, shaft, s, {share * omega, 0.0, 0});
    };
    EXPECT_NEAR(chosen(1 - 1e-6), h, 1e-12) << n;
    EXPECT_NEAR(chosen(1 + 1e-6), 1.0 / (n + 1), 1e-12) << n;
  }
}
