// Stresses along a shaft whose diameters change, against those of its sections by themselves.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <cmath>

namespace {

using namespace whirl;
using test::Columns;
using test::DeckRun;

struct Tip {
  double N, Fy, Fz, T;  ///< N, N m
};

struct Cone {
  double length;      ///< m
  double od_l, od_r;  ///< m
  double id_l, id_r;  ///< m
};

std::string deck_of(const Cone& c, const Tip& f) {
  const auto text = [](double x) { return std::to_string(x); };
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
rotating = false
[[shaft.section]]
length = ")" +
         text(c.length) + " m\"\nod_l = \"" + text(c.od_l) + " m\"\nod_r = \"" + text(c.od_r) +
         " m\"\nid_l = \"" + text(c.id_l) + " m\"\nid_r = \"" + text(c.id_r) + R"( m"
min_elements = 3
[[bearing]]
name = "wall"
at = "r/0 m"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/)" +
         text(c.length) + " m\"\nforce = [\"" + text(f.N) + " N\", \"" + text(f.Fy) + " N\", \"" +
         text(f.Fz) + " N\"]\nmoment = [\"" + text(f.T) + R"( N.m", "0 N.m", "0 N.m"]
[output]
report = false
[[step]]
name = "st"
type = "static"
)";
}

}  // namespace

// Of loads at the tip: N/A, 32 M d/(pi (d^4 - i^4)), 16 T d/(pi (d^4 - i^4)); across the middle of a
// ring 4 V/(3 A) (R^2 + R r + r^2)/(R^2 + r^2). Sags of 1e-5 m leave 1e-4 of the moments.
TEST(SectionStress, OfAConeIsThatOfItsSections) {
  const Cone cones[] = {
      {0.3, 0.06, 0.04, 0.02, 0.03}, {0.3, 0.05, 0.05, 0, 0}, {0.02, 0.04, 0.06, 0.03, 0.01}};
  const Tip tips[] = {{500, 200, -150, 40}, {-300, 0, 250, -5}, {0, 400, 300, 0}};
  for (const Cone& c : cones)
    for (const Tip& f : tips) {
      const DeckRun run(deck_of(c, f));
      ASSERT_EQ(run.exit, 0) << run.log;
      const Columns t = run.csv("st_sections.csv");
      ASSERT_GT(t.rows.size(), 6u);
      const auto value = [&](const std::vector<double>& row, const char* name) {
        return row[t.column(name)];
      };
      const double V = std::hypot(f.Fy, f.Fz);
      double most = 0;
      for (const auto& row : t.rows) {
        const double s = value(row, "s [m]"), x = s / c.length;
        const double d = c.od_l + x * (c.od_r - c.od_l), i = c.id_l + x * (c.id_r - c.id_l),
                     R = d / 2, r = i / 2;
        const double A = pi / 4 * (d * d - i * i),
                     W = pi / 32 * (std::pow(d, 4) - std::pow(i, 4)) / d;
        const double M = V * (c.length - s), axial = f.N / A, bending = M / W,
                     torsion = std::abs(f.T) / (2 * W),
                     across = 4 * V / (3 * A) * (R * R + R * r + r * r) / (R * R + r * r);
        const double outside = std::hypot(std::abs(axial) + bending, std::sqrt(3.0) * torsion),
                     middle = std::hypot(axial, std::sqrt(3.0) * (torsion + across));
        const double near = 3e-4 * (std::abs(axial) + torsion + across + V * c.length / W);
        EXPECT_NEAR(value(row, "axial stress [Pa]"), axial, near) << s;
        EXPECT_NEAR(value(row, "bending stress [Pa]"), bending, near) << s;
        EXPECT_NEAR(value(row, "torsion stress [Pa]"), torsion, near) << s;
        EXPECT_NEAR(value(row, "von Mises stress [Pa]"), std::max(outside, middle), 2 * near) << s;
        most = std::max(most, std::max(outside, middle));
      }
      const double said =
          run.summary("st").at("largest").at("r").at("von Mises stress [Pa]").number();
      EXPECT_NEAR(said, most, 1e-3 * most);
    }
}
