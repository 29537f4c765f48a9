#include <elements/films/annular_seal.hpp>
#include <core/contract.hpp>

#include <core/dual.hpp>

#include <cmath>

namespace whirl::elements {

namespace {

constexpr double m0 = -0.25;

double friction(const AnnularSeal& k, double V, double x) {
  return 0.066 * std::pow(V * k.clearance * k.density / k.viscosity, m0) * std::pow(1.0 + x, 0.375);
}

}  // namespace

AnnularSeal::Flow AnnularSeal::flow(double spin) const {
  WHIRL_EXPECTS(radius > 0.0 && length > 0.0 && clearance > 0.0);
  WHIRL_EXPECTS(density > 0.0 && viscosity > 0.0);
  const double unit = std::sqrt(2.0 * pressure_drop / density);
  double V = unit / std::sqrt(1.0 + inlet_loss), lambda = 0.0;
  // dp = rho V^2/2 (1 + xi + 2 lambda L/C): the left side grows with V and is convex in log V;
  // Newton in log V.
  for (int it = 0; it < 60; ++it) {
    const double x = std::pow(0.5 * radius * spin / V, 2);
    lambda = friction(*this, V, x);
    const double loss = 2.0 * lambda * length / clearance, total = 1.0 + inlet_loss + loss;
    const double slope = 2.0 + loss / total * (m0 - 0.75 * x / (1.0 + x));
    const double step = std::log(unit * unit / (V * V * total)) / slope;
    V *= std::exp(step);
    if (std::abs(step) < 1e-15) break;
  }
  lambda = friction(*this, V, std::pow(0.5 * radius * spin / V, 2));
  return {V, lambda, lambda * length / clearance};
}

void AnnularSeal::coefficients(double spin, Coefficients& v, Coefficients& dv) const {
  using S = Dual<1>;
  const Flow f = flow(spin);
  // V as a function of the spin: implicit derivative of the leakage equation.
  const double x0 = std::pow(0.5 * radius * spin / f.V, 2),
               loss = 2.0 * f.lambda * length / clearance, total = 1.0 + inlet_loss + loss;
  const double by_V = 2.0 + loss / total * (m0 - 0.75 * x0 / (1.0 + x0));
  const double by_spin = spin == 0.0 ? 0.0 : loss / total * 0.75 * x0 / (1.0 + x0) / spin;
  const S s = S::variable(spin, 0), V(f.V, Vector<1>(-f.V * by_spin / by_V));
  const S swirl = (0.5 * radius) * s / V, x = swirl * swirl, one_x = S(1.0) + x;
  const S Ra = (clearance * density / viscosity) * V;
  const S lambda = 0.066 * chain(Ra, std::pow(Ra.v, m0), m0 * std::pow(Ra.v, m0 - 1.0)) *
                   chain(one_x, std::pow(one_x.v, 0.375), 0.375 * std::pow(one_x.v, -0.625));
  const S sigma = (length / clearance) * lambda, beta = x / one_x, B = S(1.0) + S(1.0 + m0) / one_x;
  const S E = S(1.0 + inlet_loss) / (2.0 * (S(1.0 + inlet_loss) + B * sigma)),
          a = sigma * (S(1.0) + (1.0 + m0) * beta);
  const S ea = chain(a, std::exp(-a.v), -std::exp(-a.v)), ia = S(1.0) / a, T = S(length) / V;
  const double v0 = inlet_swirl - 0.5;
  const S alpha1 = E + B * sigma * (S(1.0 / 12.0) + 0.5 * E), alpha2 = 0.5 * (S(1.0 / 6.0) + E);
  const S gamma1 =
      sigma * ia *
      (E * B + (S(1.0) / sigma - B * ia) * ((S(1.0) - ea) * (E + S(0.5) + ia) - S(1.0)));
  const S gamma2 = ia * ((E + ia * ia) * (S(1.0) - ea) - (S(0.5) + ia) * ea);
  const S n =
      (two_pi * radius * pressure_drop) * sigma / (lambda * (S(1.0 + inlet_loss) + 2.0 * sigma));
  const S sT = s * T;
  const S K = n * ((1.0 - m0) * sigma * E - 0.25 * sT * sT * (alpha2 + 2.0 * v0 * gamma2));
  const S k = 0.5 * n * sT * (alpha1 + 2.0 * v0 * gamma1);
  const S C = n * T * alpha1, c = n * sT * T * (alpha2 + v0 * gamma2), M = n * T * T * alpha2;
  v = {K.v, k.v, C.v, c.v, M.v};
  dv = {K.g[0], k.g[0], C.g[0], c.g[0], M.g[0]};
}

namespace {

Mat2 cross(double direct, double coupled) {
  Mat2 m;
  m << direct, coupled, -coupled, direct;
  return m;
}

}  // namespace

void AnnularSeal::force(const LateralMotion& m, Vector<4>& z) const {
  Coefficients v, dv;
  coefficients(m.spin, v, dv);
  z << -(cross(v.K, v.k) * m.r + cross(v.C, v.c) * m.v + v.M * m.a), 0.0, 0.0;
}

void AnnularSeal::tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const {
  Coefficients v, dv;
  coefficients(m.spin, v, dv);
  const Mat2 K = cross(v.K, v.k), C = cross(v.C, v.c);
  z << -(K * m.r + C * m.v + v.M * m.a), 0.0, 0.0;
  t.set_zero();
  t.r.topRows<2>() = -K;
  t.v.topRows<2>() = -C;
  t.a.topRows<2>() = -v.M * Mat2::Identity();
  t.spin.head<2>() = -(cross(dv.K, dv.k) * m.r + cross(dv.C, dv.c) * m.v + dv.M * m.a);
}

void AnnularSeal::energy(const LateralMotion& m, system::Energy& e) const {
  Coefficients v, dv;
  coefficients(m.spin, v, dv);
  e.elastic += 0.5 * v.K * m.r.squaredNorm();
  e.kinetic += 0.5 * v.M * m.v.squaredNorm();
  e.dissipated += v.C * m.v.squaredNorm();
  e.supplied += 0.5 * m.spin_rate * (dv.K * m.r.squaredNorm() + dv.M * m.v.squaredNorm()) -
                v.k * (m.v.x() * m.r.y() - m.v.y() * m.r.x());
}

double alford_stiffness(double beta, double torque, double mean_diameter, double blade_height) {
  WHIRL_EXPECTS(mean_diameter > 0.0 && blade_height > 0.0);
  return beta * torque / (mean_diameter * blade_height);
}

double wachel_stiffness(double power, double speed, double diameter, double width,
                        double molar_mass, double density_ratio) {
  WHIRL_EXPECTS(speed != 0.0 && diameter > 0.0 && width > 0.0);
  return power / (speed * diameter * width) * (molar_mass / 0.010) * density_ratio;
}

}  // namespace whirl::elements
