#include <elements/shaft/crack_compliance.hpp>
#include <core/contract.hpp>

#include <array>
#include <cmath>

namespace whirl::elements {
namespace {

constexpr int points = 32;

/// Points and weights of Gauss and Legendre on (-1, 1).
struct GaussRule {
  std::array<double, points> x{}, w{};
  GaussRule() {
    for (std::size_t i = 0; i < points; ++i) {
      double z = std::cos(pi * (static_cast<double>(i) + 0.75) / (points + 0.5)), slope = 0.0;
      for (int round = 0; round < 20; ++round) {
        double before = 1.0, p = z;
        for (int k = 2; k <= points; ++k) {
          const double next = ((2 * k - 1) * z * p - (k - 1) * before) / k;
          before = p;
          p = next;
        }
        slope = points * (z * p - before) / (z * z - 1.0);
        z -= p / slope;
      }
      x[i] = z;
      w[i] = 2.0 / ((1.0 - z * z) * slope * slope);
    }
  }
};

double square(double x) { return x * x; }

}  // namespace

CrackCompliance crack_compliance(double depth, double radius, double E, double nu) {
  WHIRL_EXPECTS(depth > 0.0 && depth <= radius && E > 0.0);
  static const GaussRule rule;
  const double a = depth / radius, half_edge = std::sqrt(a * (2.0 - a));
  double C_xi = 0.0, C_eta = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    const double x = half_edge * rule.x[i], half_height = std::sqrt(1.0 - x * x);
    const double deep = half_height - (1.0 - a);  // of this strip
    for (std::size_t j = 0; j < points; ++j) {
      const double y = 0.5 * deep * (rule.x[j] + 1.0);
      const double weight = half_edge * rule.w[i] * 0.5 * deep * rule.w[j];
      const double share = y / (2.0 * half_height), u = 0.5 * pi * share, s = std::sin(u);
      const double edge = std::tan(u) / (u * square(std::cos(u)));
      const double F2 = 0.923 + 0.199 * square(square(1.0 - s));
      const double F1 = 0.752 + 2.02 * share + 0.37 * square(1.0 - s) * (1.0 - s);
      C_xi += weight * (1.0 - x * x) * y * edge * F2 * F2;
      C_eta += weight * x * x * y * edge * F1 * F1;
    }
  }
  const double scale = 32.0 / pi * (1.0 - nu * nu) / (E * radius * radius * radius);
  return {scale * C_xi, scale * C_eta};
}

}  // namespace whirl::elements
