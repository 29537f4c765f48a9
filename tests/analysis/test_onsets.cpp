// Onsets of whirl and of divergence of random rotors on bearings tabulated against speed, from light
// to heavy, soft to stiff, undamped to overdamped, with stiffness that may become negative: verdicts
// and onsets against a dense method.
#include "../validation/deck_model.hpp"
#include "two_methods.hpp"

#include <core/error.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

using namespace whirl;
using namespace whirl::analysis;
using whirl::test::DeckModel;

namespace {

constexpr double top_rpm = 12000;

class TabulatedRotor {
 public:
  explicit TabulatedRotor(unsigned seed) : rng_(seed) {
    const double mass = spread(0.05, 500), stiffness = spread(1e4, 1e9), length = spread(0.3, 2.0);
    const double radius = 0.3 * length * spread(0.3, 1.0);
    const bool rigid = chance(0.4);
    deck_ = fmt::format(
        "format = 1\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = \"s\"\nmaterial = "
        "\"steel\"\n[[shaft.section]]\nname = \"a\"\nlength = \"{} m\"\n{}\n[[disk]]\nat = \"{} "
        "m\"\nmass = \"{} kg\"\nIp = \"{} kg.m^2\"\nId = \"{} kg.m^2\"\n",
        length,
        rigid ? "rigid = true" : fmt::format("od = \"{} m\"\nmin_elements = 3", 0.04 * length),
        length * uniform(0.2, 0.8), mass, 0.5 * mass * radius * radius,
        0.25 * mass * radius * radius * spread(1, 4));
    const double damping = chance(0.15) ? 0.0 : spread(1e-4, 10.0) * std::sqrt(stiffness * mass);
    for (const double at : {0.0, length})
      bearing(at, stiffness * spread(0.3, 3.0), damping);
    deck_ += "[[bearing]]\nat = \"0 m\"\ntype = \"linear\"\nkxx = \"1e6 N/m\"\n";
  }
  const std::string& deck() const { return deck_; }

 private:
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(rng_); }
  double spread(double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); }
  bool chance(double p) { return uniform(0.0, 1.0) < p; }

  void bearing(double at, double stiffness, double damping) {
    deck_ += fmt::format(
        "[[bearing]]\nat = \"{} m\"\ntype = \"table\"\ninterpolation = \"linear\"\ncolumns = "
        "[\"speed[rpm]\", \"kyy[N/m]\", \"kzz[N/m]\", \"kyz[N/m]\", \"kzy[N/m]\", \"cyy[N.s/m]\", "
        "\"czz[N.s/m]\"]\nrows = [",
        at);
    const double softened = chance(0.5) ? uniform(-1.0, 0.5) : uniform(0.5, 2.0);
    const double driven = chance(0.5) ? uniform(0.0, 1.0) : 0.0;
    const double other = uniform(0.7, 1.5);
    for (int k = 0; k < 3; ++k) {
      const double share = 0.5 * k;
      const double K = stiffness * (1 + share * (softened - 1));
      const double cross = stiffness * driven * share;
      deck_ += fmt::format("[{}, {}, {}, {}, {}, {}, {}], ", top_rpm * share, K,
                           stiffness * other * (1 - 0.3 * share), cross, -cross, damping,
                           damping * other);
    }
    deck_ += "]\n";
  }

  std::mt19937 rng_;
  std::string deck_;
};

void campaign(unsigned machines) {
  tests::Compared sum;
  for (unsigned seed = 1; seed <= machines; ++seed) {
    const TabulatedRotor rotor(seed);
    const DeckModel d(rotor.deck());
    Linearizer linear(d.built.system, d.running());
    tests::compare_stability(linear, 0.02 * top_rpm * whirl::test::rpm, top_rpm * whirl::test::rpm,
                             fmt::format("rotor {}", seed), sum);
  }
  tests::report(sum);
  // what is not certified cannot be compared
  EXPECT_GE(sum.verdicts, static_cast<int>(3 * machines));
  EXPECT_GE(sum.onsets + sum.divergences, static_cast<int>(machines / 6));
}

}  // namespace

TEST(Onsets, OfRandomRotorsOnTablesAreThoseOfADenseMethod) {
  const char* wanted = std::getenv("WHIRL_TABULATED_ROTORS");
  campaign(wanted ? static_cast<unsigned>(std::atoi(wanted)) : 20);
}
