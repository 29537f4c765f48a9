#include <elements/rolling/hertz.hpp>
#include <core/contract.hpp>

#include <core/types.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

double hertz_ellipticity(double Rx, double Ry) {
  WHIRL_EXPECTS(Rx > 0.0 && Ry > 0.0);
  const double ratio = std::max(Rx, Ry) / std::min(Rx, Ry), F_rho = (ratio - 1.0) / (ratio + 1.0);
  if (F_rho < 1e-5)
    return 1.0 + 4.0 / 3.0 * F_rho;  // nearly circular: kappa = ratio^(2/3), error F_rho^2
  // The left side minus F_rho grows from below zero at kappa = 1 to 1 - F_rho: bisection in log
  // kappa.
  const auto excess = [&](double kappa) {
    const double k2 = kappa * kappa, m = std::sqrt(1.0 - 1.0 / k2);
    const double F = std::comp_ellint_1(m), E = std::comp_ellint_2(m);
    return ((k2 + 1.0) * E - 2.0 * F) / ((k2 - 1.0) * E) - F_rho;
  };
  double lo = 1.0 + 1e-6, hi = 1e6;
  while (hi / lo - 1.0 > 1e-15) {
    const double mid = std::sqrt(lo * hi);
    if (mid == lo || mid == hi) break;
    (excess(mid) > 0.0 ? hi : lo) = mid;
  }
  return std::sqrt(lo * hi);
}

double hertz_point_stiffness(double Rx, double Ry, const ContactMaterial& a,
                             const ContactMaterial& b) {
  WHIRL_EXPECTS(a.E > 0.0 && b.E > 0.0);
  WHIRL_EXPECTS(std::abs(a.nu) < 1.0 && std::abs(b.nu) < 1.0);
  const double modulus = 2.0 / ((1.0 - a.nu * a.nu) / a.E + (1.0 - b.nu * b.nu) / b.E);
  const double R = 1.0 / (1.0 / Rx + 1.0 / Ry), kappa = hertz_ellipticity(Rx, Ry),
               m = std::sqrt(1.0 - 1.0 / (kappa * kappa));
  const double F = std::comp_ellint_1(m), E = std::comp_ellint_2(m);
  return pi * kappa * modulus * std::sqrt(R * E / (4.5 * F * F * F));
}

double hertz_line_stiffness(double length) {
  WHIRL_EXPECTS(length > 0.0);
  // N/mm^(10/9) with length in mm -> N/m^(10/9)
  return 8.06e4 * std::pow(1e3 * length, 8.0 / 9.0) * std::pow(1e3, 10.0 / 9.0);
}

double hertz_series(double K1, double K2, double n) {
  WHIRL_EXPECTS(K1 > 0.0 && K2 > 0.0 && n > 0.0);
  return std::pow(std::pow(K1, -1.0 / n) + std::pow(K2, -1.0 / n), -n);
}

}  // namespace whirl::elements
