// What a section says of its shear and rotary inertia, against the frequencies of a pinned beam.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <cmath>

namespace {

using namespace whirl;
using test::Columns;
using test::DeckRun;

struct Ring {
  const char* keys;
  double od, id;  ///< m
};

struct Shear {
  const char* keys;
  double (*kappa)(double m);  ///< of the ratio of the diameters; null: no shear deformation
};

constexpr double nu = 0.3, E = 200e9, rho = 8000, length = 1;

/// Cowper (1966), doi 10.1115/1.3625046.
double cowper(double m) {
  const double a = (1 + m * m) * (1 + m * m);
  return 6 * (1 + nu) * a / ((7 + 6 * nu) * a + (20 + 12 * nu) * m * m);
}

/// Hutchinson (2001), doi 10.1115/1.1349417.
double hutchinson(double m) {
  const double b2 = m * m, b4 = b2 * b2;
  return 6 * (1 + b2) * (1 + b2) * (1 + nu) * (1 + nu) /
         (7 + 34 * b2 + 7 * b4 + nu * (12 + 48 * b2 + 12 * b4) + nu * nu * (4 + 16 * b2 + 4 * b4));
}

double given(double) { return 0.6; }

/// The lower root of Timoshenko's equation for n half waves between pins, Hz.
double frequency(const Ring& r, const Shear& shear, bool rotary, int n) {
  const double A = pi / 4 * (r.od * r.od - r.id * r.id),
               I = pi / 64 * (std::pow(r.od, 4) - std::pow(r.id, 4)), k = n * pi / length;
  const double soft =
      shear.kappa ? 2 * (1 + nu) / (E * shear.kappa(r.id / r.od) * A) : 0.0;  // 1/(kappa G A)
  const double rI = rotary ? rho * I : 0.0;
  const double a = rI * rho * A * soft, b = rho * A + rI * k * k + E * I * k * k * rho * A * soft,
               c = E * I * std::pow(k, 4);
  return std::sqrt(2 * c / (b + std::sqrt(b * b - 4 * a * c))) / two_pi;
}

std::string deck_of(const Ring& r, const Shear& shear, bool rotary) {
  return std::string(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
nu = 0.3
density = "8000 kg/m^3"
[[shaft]]
name = "r"
material = "m"
[[shaft.section]]
length = "1 m"
min_elements = 20
)") + r.keys +
         shear.keys + (rotary ? "" : "rotary_inertia = false\n") + R"([[bearing]]
name = "A"
at = "r/0 m"
type = "rigid"
directions = ["x", "y", "z", "ry"]
[[bearing]]
name = "B"
at = "r/1 m"
type = "rigid"
directions = ["y", "z", "ry"]
[output]
report = false
[[step]]
name = "m"
type = "modal"
modes = 8
motion = "lateral"
)";
}

}  // namespace

TEST(BeamOptions, GiveTheFrequenciesOfAPinnedBeam) {
  const Ring rings[] = {{"od = \"120 mm\"\n", 0.12, 0},
                        {"od = \"120 mm\"\nid = \"80 mm\"\n", 0.12, 0.08}};
  const Shear shears[] = {{"shear = \"none\"\n", nullptr},
                          {"", cowper},
                          {"shear = \"hutchinson\"\n", hutchinson},
                          {"shear = \"given\"\nkappa = 0.6\n", given}};
  for (const Ring& r : rings)
    for (const Shear& shear : shears)
      for (const bool rotary : {true, false}) {
        const DeckRun run(deck_of(r, shear, rotary));
        ASSERT_EQ(run.exit, 0) << run.log;
        const Columns modes = run.csv("m_modes.csv");
        const std::size_t c = modes.column("frequency [Hz]");
        for (const int n : {1, 2, 3}) {  // those of the other plane stand between
          const double wanted = frequency(r, shear, rotary, n);
          double nearest = 0;
          for (const auto& row : modes.rows)
            if (std::abs(row[c] - wanted) < std::abs(nearest - wanted)) nearest = row[c];
          EXPECT_NEAR(nearest, wanted, 6e-5 * wanted) << r.keys << shear.keys << rotary << " " << n;
        }
      }
}
