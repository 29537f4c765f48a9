// Radau IIA 5: Pade (2,3) of exp; Gauss 4, 6: Pade (2,2), (3,3). Generalized-alpha: J. Chung, G. M.
// Hulbert, J. Appl. Mech. 60 (1993) 371, doi 10.1115/1.2900803, eliminated to the characteristic
// cubic below. BDF2: (3/2 - z) r^2 - 2 r + 1/2 = 0.
#include <time/stability.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <fmt/format.h>

#include <array>
#include <cmath>

namespace whirl::time {
namespace {

[[noreturn]] void unknown(std::string_view name) {
  throw Error(Exit::usage, Diagnostic{Diagnostic::Severity::error,
                                      "N10",
                                      fmt::format("there is no integrator '{}'", name),
                                      {},
                                      {}});
}

/// Roots of c0 + c1 x + c2 x^2 + c3 x^3 (c3 may be 0: two roots and one 0), by Durand-Kerner with
/// Newton polishing.
std::array<Complex, 3> roots(Complex c0, Complex c1, Complex c2, Complex c3) {
  std::array<Complex, 3> x{};
  if (std::abs(c3) < 1e-300) {
    const Complex d = std::sqrt(c1 * c1 - 4.0 * c2 * c0);
    const Complex s = -0.5 * (c1 + (std::real(std::conj(c1) * d) >= 0.0 ? d : -d));
    x[0] = std::abs(c2) > 0.0 ? s / c2 : Complex(0.0);
    x[1] = std::abs(s) > 0.0 ? c0 / s : Complex(0.0);
    return x;
  }
  c0 /= c3;
  c1 /= c3;
  c2 /= c3;
  auto value = [&](Complex z) { return ((z + c2) * z + c1) * z + c0; };
  for (std::size_t k = 0; k < 3; ++k)
    x[k] = std::polar(1.0, 0.4 + two_pi * static_cast<double>(k) / 3.0);
  for (int it = 0; it < 500; ++it) {
    double change = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      Complex d = 1.0;
      for (std::size_t j = 0; j < 3; ++j)
        if (j != k) d *= x[k] - x[j];
      if (std::abs(d) < 1e-300) d = 1e-300;
      const Complex step = value(x[k]) / d;
      x[k] -= step;
      change = std::max(change, std::abs(step));
    }
    if (change < 1e-16) break;
  }
  return x;
}

}  // namespace

Complex stability_function(std::string_view name, Complex z) {
  const Complex z2 = z * z, z3 = z2 * z;
  if (name == "radau5")
    return (1.0 + 0.4 * z + z2 / 20.0) / (1.0 - 0.6 * z + 0.15 * z2 - z3 / 60.0);
  if (name == "gauss4") return (1.0 + 0.5 * z + z2 / 12.0) / (1.0 - 0.5 * z + z2 / 12.0);
  if (name == "gauss6")
    return (1.0 + 0.5 * z + 0.1 * z2 + z3 / 120.0) / (1.0 - 0.5 * z + 0.1 * z2 - z3 / 120.0);
  unknown(name);
}

double bdf2_radius(Complex z) {
  double radius = 0.0;
  for (const Complex& r : roots(0.5, -2.0, 1.5 - z, 0.0))
    radius = std::max(radius, std::abs(r));
  return radius;
}

ModeResponse mode_response(std::string_view name, double omega, double zeta, double h,
                           double rho_inf) {
  WHIRL_EXPECTS(omega > 0.0 && h > 0.0);
  WHIRL_EXPECTS(std::abs(zeta) < 1.0);
  WHIRL_EXPECTS(rho_inf >= 0.0 && rho_inf <= 1.0);
  const double wd = omega * std::sqrt(1.0 - zeta * zeta);
  const Complex lambda(-zeta * omega, wd), z = h * lambda, exact = std::exp(z);
  ModeResponse out;
  Complex root;
  auto nearest = [&](const std::array<Complex, 3>& x) {
    root = x[0];
    for (const Complex& r : x) {
      out.radius = std::max(out.radius, std::abs(r));
      if (std::abs(r - exact) < std::abs(root - exact)) root = r;
    }
  };
  if (name == "generalized_alpha") {
    const double am = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0), af = rho_inf / (rho_inf + 1.0);
    const double g = 0.5 - am + af, b = 0.25 * (g + 0.5) * (g + 0.5);
    // In the mode: a = -2 zeta omega v - omega^2 q. With shift operator r and b_n carried beside
    // a_n,
    //   ((1-am) r + am) B = ((1-af) r + af) A,  A = h^2 a,  B = h^2 b
    //   (r-1) h v = ((1-g) + g r) B,   (r-1) q = h v + ((1/2-b) + b r) B
    // so (r-1)^2 q = [((1-g) + g r) + (r-1)((1/2-b) + b r)] B and A = -k q - d h v, k = (omega
    // h)^2, d = 2 zeta omega h:
    //   ((1-am) r + am)(r-1)^2 + ((1-af) r + af) [ k P(r) + d (r-1) G(r) ] = 0,
    //   G = (1-g) + g r,  P = G + (r-1)((1/2-b) + b r)
    const double k = omega * omega * h * h, d = 2.0 * zeta * omega * h;
    const double p0 = (1.0 - g) - (0.5 - b), p1 = g + 0.5 - 2.0 * b, p2 = b;  // P
    const double s0 = -(1.0 - g), s1 = 1.0 - 2.0 * g, s2 = g;                 // (r-1) G
    const double e0 = k * p0 + d * s0, e1 = k * p1 + d * s1, e2 = k * p2 + d * s2;
    nearest(roots(am + af * e0, (1.0 - am) - 2.0 * am + (1.0 - af) * e0 + af * e1,
                  am - 2.0 * (1.0 - am) + (1.0 - af) * e1 + af * e2, (1.0 - am) + (1.0 - af) * e2));
  } else if (name == "ida") {
    nearest(roots(0.5, -2.0, 1.5 - z, 0.0));
  } else {
    root = stability_function(name, z);
    out.radius = std::abs(root);
  }
  out.amplification = std::abs(root);
  // root = exp(h lambda_apparent)
  const double angle = std::abs(std::arg(root)),
               decay = -std::log(std::max(out.amplification, 1e-300));
  const double apparent = std::hypot(angle, decay);
  out.damping = (apparent > 0.0 ? decay / apparent : 0.0) - zeta;
  // beyond half a turn a step the angle is an alias
  out.frequency_error = wd * h < pi && angle > 0.0 ? angle / (wd * h) - 1.0 : nan;
  return out;
}

}  // namespace whirl::time
