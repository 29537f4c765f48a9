// Lateral motion of random machines: its modes are the bending modes of all motion, whether the rotors are flat,
// cracked or coupled, at rest (where such rotors roll, slowly) and turning.
#include "deck_run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using whirl::test::DeckRun;

namespace {

class RandomMachine {
 public:
  explicit RandomMachine(unsigned seed) : random_(seed) {
    const int rotors = one_in(2) ? 2 : 1;
    const bool flat = one_in(2);
    deck_ = "format = 1\n[output]\nreport = false\n";
    for (int i = 0; i < rotors; ++i)
      rotor(i == 0 ? 'A' : 'B', flat && i == 0);
    if (!flat)
      deck_ += fmt::format(
          "[[crack]]\nname = \"c\"\nat = \"A/s0:end\"\ndepth = \"{} mm\"\nphase = \"{} deg\"\n",
          between(3, 14), between(0, 360));
    if (rotors == 2)
      deck_ += fmt::format(
          "[[bearing]]\nname = \"coupling\"\nat = \"A/s1:end\"\nto = \"B/s0:start\"\ntype = "
          "\"coupling\"\nkrxx = \"{} N.m/rad\"\nkyy = \"1e7 N/m\"\nkzz = \"1e7 N/m\"\nkrr = \"1e4 "
          "N.m/rad\"\n",
          std::pow(10.0, between(2, 6)));
    speed_ = one_in(2) ? 0 : 1500;
  }
  std::string deck(const char* motion) const {
    return deck_ + fmt::format(
                       "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"{} rpm\"\nmodes = "
                       "14\nmotion = \"{}\"\n",
                       speed_, motion);
  }

 private:
  double between(double a, double b) { return std::uniform_real_distribution(a, b)(random_); }
  bool one_in(int n) { return random_() % static_cast<unsigned>(n) == 0; }

  void rotor(char name, bool flat) {
    deck_ += fmt::format("[[shaft]]\nname = \"{}\"\nmaterial = \"steel\"\n", name);
    if (name != 'A') deck_ += "origin = [\"1005 mm\", \"0 mm\", \"0 mm\"]\n";
    for (int k = 0; k < 2; ++k) {
      const double d = std::round(between(30, 80));
      deck_ += fmt::format("[[shaft.section]]\nname = \"s{}\"\nlength = \"500 mm\"\n", k);
      if (flat)
        deck_ += strip(d, d * between(0.5, 0.95));
      else
        deck_ += fmt::format("od = \"{} mm\"\n", d);
    }
    deck_ += fmt::format(
        "[[disk]]\nname = \"d{0}\"\nat = \"{0}/s0:end\"\nmass = \"{1} kg\"\nIp = \"0.2 "
        "kg.m^2\"\nId = \"0.1 kg.m^2\"\n",
        name, between(5, 60));
    bearing(name, "s0:start", true);
    bearing(name, "s1:end", false);
  }
  static std::string strip(double a, double b) {
    return fmt::format(
        "general = {{ A = \"{} mm^2\", Iy = \"{} mm^4\", Iz = \"{} mm^4\", J = \"{} mm^4\", "
        "kappa_y = 0.85, kappa_z = 0.85 }}\n",
        a * b, a * b * b * b / 12, b * a * a * a / 12, 0.2 * a * b * b * b);
  }
  void bearing(char shaft, const char* at, bool thrust) {
    const double k = std::pow(10.0, between(6, 8.5));
    deck_ += fmt::format(
        "[[bearing]]\nname = \"{0}{1}\"\nat = \"{0}/{2}\"\ntype = \"linear\"\nkyy = \"{3} N/m\"\n"
        "kzz = \"{4} N/m\"\ncyy = \"200 N.s/m\"\nczz = \"200 N.s/m\"\n{5}",
        shaft, thrust ? 1 : 2, at, k, one_in(2) ? k : k * between(0.5, 2),
        thrust ? "kxx = \"1e8 N/m\"\ncxx = \"100 N.s/m\"\n" : "");
  }

  std::mt19937 random_;
  std::string deck_;
  int speed_ = 0;
};

struct Mode {
  double frequency, lateral;
};

std::vector<Mode> modes_of(const std::string& deck) {
  const DeckRun r(deck);
  EXPECT_TRUE(r.exit == 0 || r.exit == 4) << r.log;
  const auto table = r.csv("m_modes.csv");
  std::vector<Mode> modes;
  for (const auto& row : table.rows)
    modes.push_back({row.at(table.column("frequency [Hz]")), row.at(table.column("lateral [%]"))});
  return modes;
}

TEST(LateralMachines, ModesAreTheBendingModesOfAllMotion) {
  for (unsigned seed = 1; seed <= 24; ++seed) {
    const RandomMachine machine(seed);
    SCOPED_TRACE(machine.deck("lateral"));
    const std::vector<Mode> lateral = modes_of(machine.deck("lateral"));
    int seen = 0;
    for (const Mode& whole : modes_of(machine.deck("all"))) {
      constexpr double rolling = 0.5;  // Hz: slow
      if (whole.lateral < 90 || whole.frequency < rolling || ++seen > 6) continue;
      double nearest = 1;
      for (const Mode& m : lateral)
        nearest = std::min(nearest, std::abs(m.frequency / whole.frequency - 1));
      EXPECT_LT(nearest, 2e-3) << whole.frequency;  // torsional inertia is left out
    }
    EXPECT_GE(seen, 3);
  }
}

}  // namespace
