// Element constants against closed forms, and the natural frequencies of small beams built from
// them.
#include "round_sections.hpp"
#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <cmath>
#include <functional>

using namespace whirl;
using namespace whirl::elements;
using namespace whirl::test;

namespace {

/// Independent quadrature: composite midpoint with Richardson extrapolation (error ~ h^6).
double integrate(const std::function<double(double)>& f, double a, double b) {
  const auto mid = [&](int n) {
    double s = 0, h = (b - a) / n;
    for (int i = 0; i < n; ++i)
      s += f(a + (i + 0.5) * h);
    return s * h;
  };
  const double m1 = mid(2000), m2 = mid(4000), m4 = mid(8000);
  const double r1 = (4 * m2 - m1) / 3, r2 = (4 * m4 - m2) / 3;
  return (16 * r2 - r1) / 15;
}

// ---------------------------------------------------------------- statics

TEST(TimoshenkoElement, UniformClosedForms) {
  for (double l : {5.0, 0.3, 0.05, 0.005}) {
    const ElementSection s = cylinder(0.06);
    const SectionProperties p = s.at(0.5);
    const double Phi = 12 * p.EI / (p.kGA * l * l), q = 1 + Phi;
    const ShaftElementConstants c = make_shaft_constants(s, l);
    SCOPED_TRACE(Phi);
    const double k = p.EI / (l * q),
                 tol = 1e-13 * (1 + Phi);  // k12 is a difference of terms of size Phi
    EXPECT_NEAR(c.k11 / k, 4 + Phi, tol * 4);
    EXPECT_NEAR(c.k22 / k, 4 + Phi, tol * 4);
    EXPECT_NEAR(c.k12 / k, 2 - Phi, tol * 4);
    EXPECT_NEAR(c.EA_l, p.EA / l, 1e-14 * c.EA_l);
    EXPECT_NEAR(c.GJ_l, p.GJ / l, 1e-14 * c.GJ_l);
    EXPECT_NEAR(c.tau_c, 0.5 * (1 - Phi) / q, 1e-13);
    const double b1 = 2.0 / 15 + Phi / 6 + Phi * Phi / 12, b2 = 1.0 / 30 + Phi / 6 + Phi * Phi / 12;
    EXPECT_NEAR(c.b11, b1 / (q * q), 1e-13);
    EXPECT_NEAR(c.b22, b1 / (q * q), 1e-13);
    EXPECT_NEAR(c.b12, -b2 / (q * q), 1e-13);
    EXPECT_NEAR(c.polar(0, 0), 5.0 / 12 * p.rhoIp * l, 1e-14 * p.rhoIp * l);
    EXPECT_NEAR(c.polar(0, 1), 1.0 / 12 * p.rhoIp * l, 1e-14 * p.rhoIp * l);
    Matrix<4> add;
    add << 12, 6 * l, -12, 6 * l, 6 * l, (4 + Phi) * l * l, -6 * l, (2 - Phi) * l * l, -12, -6 * l,
        12, -6 * l, 6 * l, (2 - Phi) * l * l, -6 * l, (4 + Phi) * l * l;
    const double cw = p.rhoA * std::pow(l, 4) * (1 + 5 * Phi) / (720 * p.EI);
    const double cp = p.rhoIp * l * l / (12 * p.EI) * Phi / q, cth = 0.5 * cp;
    const double share = p.rhoI / (p.rhoI + p.rhoA * l * l / 15), cd = cw - share * (cw - cth);
    const Matrix<4> K = add * p.EI / (l * l * l * q);
    const ShaftElementConstants plain = make_shaft_constants(s, l, 0, 0, MassKind::consistent);
    EXPECT_LT((bending_stiffness(c) - K).cwiseAbs().maxCoeff(), tol * K.cwiseAbs().maxCoeff());
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const double ci = i % 2 ? cd : cw, cj = j % 2 ? cd : cw,
                     size = std::sqrt(c.M4(i, i) * c.M4(j, j));
        EXPECT_NEAR(c.M4(i, j) - plain.M4(i, j), 0.5 * (ci + cj) * K(i, j), 1e-13 * size);
        const double gi = i % 2 ? cp : 0, gj = j % 2 ? cp : 0,
                     gsize = std::sqrt(c.G4(i, i) * c.G4(j, j));
        EXPECT_NEAR(c.G4(i, j) - plain.G4(i, j), 0.5 * (gi + gj) * K(i, j), 1e-12 * gsize);
      }
    // Without rotary inertia: rhoA l (1+5 Phi)/(720 (1+Phi)) [12 6l -12 6l; ...].
    const ElementSection e = cylinder(0.06, ShearRule::cowper, false);
    const Matrix<4> got =
        make_shaft_constants(e, l).M4 - make_shaft_constants(e, l, 0, 0, MassKind::consistent).M4;
    add *= p.rhoA * l * (1 + 5 * Phi) / (720 * q);
    EXPECT_LT((got - add).cwiseAbs().maxCoeff(), 1e-13 * q * c.M4.cwiseAbs().maxCoeff());
  }
}

// Consistent Timoshenko mass: Friedman & Kosmatka, Computers & Structures 47 (1993) 473-481, doi
// 10.1016/0045-7949(93)90243-7.
TEST(TimoshenkoElement, UniformConsistentMassIsTheKnownOne) {
  const ElementSection s = cylinder(0.06);
  const double l = 0.1;
  const SectionProperties p = s.at(0);
  const double Phi = 12 * p.EI / (p.kGA * l * l);
  const Matrix<4> M = make_shaft_constants(s, l, 0, 0, MassKind::consistent).M4;
  const double a = p.rhoA * l / (210 * (1 + Phi) * (1 + Phi)),
               b = p.rhoI / (30 * (1 + Phi) * (1 + Phi) * l);
  const double P = Phi;
  EXPECT_NEAR(M(0, 0), a * (70 * P * P + 147 * P + 78) + b * 36, 1e-13 * M(0, 0));
  EXPECT_NEAR(M(0, 1), a * l / 4 * (35 * P * P + 77 * P + 44) - b * l * (15 * P - 3),
              1e-13 * M(0, 0));
  EXPECT_NEAR(M(0, 2), a * (35 * P * P + 63 * P + 27) - b * 36, 1e-13 * M(0, 0));
  EXPECT_NEAR(M(0, 3), -a * l / 4 * (35 * P * P + 63 * P + 26) - b * l * (15 * P - 3),
              1e-13 * M(0, 0));
  EXPECT_NEAR(M(1, 1),
              a * l * l / 4 * (7 * P * P + 14 * P + 8) + b * l * l * (10 * P * P + 5 * P + 4),
              1e-13 * M(0, 0));
  EXPECT_NEAR(M(1, 3),
              -a * l * l / 4 * (7 * P * P + 14 * P + 6) + b * l * l * (5 * P * P - 5 * P - 1),
              1e-13 * M(0, 0));
}

TEST(TimoshenkoElement, EulerBernoulliIsTheLimitOfStiffShear) {
  const ShaftElementConstants c = make_shaft_constants(cylinder(0.06, ShearRule::rigid), 0.5);
  const double EI = cylinder(0.06).at(0).EI;
  EXPECT_NEAR(c.k11, 4 * EI / 0.5, 1e-13 * c.k11);
  EXPECT_NEAR(c.k12, 2 * EI / 0.5, 1e-13 * c.k11);
  EXPECT_NEAR(c.tau_c, 0.5, 1e-14);
}

// One conical element, clamped at its left end, is exact under a tip force and a tip moment.
TEST(TimoshenkoElement, ConicalCantileverIsExact) {
  struct Case {
    double d1, d2, b1, b2, l;
  };
  for (const Case k : {Case{0.10, 0.05, 0, 0, 0.8}, Case{0.02, 0.20, 0, 0.1, 0.4},
                       Case{0.1, 0.1, 0.0, 0.095, 0.5}, Case{0.3, 0.003, 0, 0, 0.5}}) {
    const ElementSection s = cone(k.d1, k.d2, k.b1, k.b2);
    const ShaftElementConstants c = make_shaft_constants(s, k.l);
    const Matrix<4> K = bending_stiffness(c);
    const Mat2 tip = K.bottomRightCorner<2, 2>();
    const Mat2 flex = tip.inverse();
    SCOPED_TRACE(k.d2);
    const auto EI = [&](double x) { return s.at(x / k.l).EI; };
    const double l = k.l;
    // Substitution x = l - l u^3 clusters the independent rule at the thin end.
    const auto I = [&](auto f) {
      return integrate([&](double u) { return 3 * l * u * u * f(l - l * u * u * u); }, 0, 1);
    };
    const double wF = I([&](double x) { return (l - x) * (l - x) / EI(x) + 1 / s.at(x / l).kGA; });
    const double wM = I([&](double x) { return (l - x) / EI(x); });
    const double tM = I([&](double x) { return 1 / EI(x); });
    const double tol = 3e-9;  // the independent rule's own error for the sharpest cone
    EXPECT_NEAR(flex(0, 0) / wF, 1, tol);
    EXPECT_NEAR(flex(0, 1) / wM, 1, tol);
    EXPECT_NEAR(flex(1, 1) / tM, 1, tol);
    EXPECT_NEAR(c.EA_l * I([&](double x) { return 1 / s.at(x / l).EA; }), 1, tol);
    EXPECT_NEAR(c.GJ_l * I([&](double x) { return 1 / s.at(x / l).GJ; }), 1, tol);
  }
}

// Solid Euler-Bernoulli cone, closed forms: int ds/EI etc. with EI = EI1 (1+q xi)^4, q = d2/d1 - 1.
TEST(TimoshenkoElement, SolidConeClosedForms) {
  const double d1 = 0.04, d2 = 0.10, l = 0.7;
  const ElementSection s = cone(d1, d2, 0, 0, ShearRule::rigid);
  const ShaftElementConstants c = make_shaft_constants(s, l);
  const double r = d2 / d1, q = r - 1;
  EXPECT_NEAR(c.EA_l, s.at(0).EA * r / l, 1e-13 * c.EA_l);
  EXPECT_NEAR(c.GJ_l, s.at(0).GJ / l * 3 * q / (1 - std::pow(r, -3)), 1e-13 * c.GJ_l);
  EXPECT_NEAR(c.mass, s.rho * pi * l / 12 * (d1 * d1 + d1 * d2 + d2 * d2), 1e-13 * c.mass);
  const Mat2 flex = bending_stiffness(c).bottomRightCorner<2, 2>().inverse();
  EXPECT_NEAR(flex(1, 1), l / s.at(0).EI * (1 - std::pow(r, -3)) / (3 * q), 1e-12 * flex(1, 1));
  EXPECT_NEAR(flex(0, 0), l * l * l / (3 * s.at(0).EI * r),
              1e-12 * flex(0, 0));  // P l^3/(3 E I1 (d2/d1)), load at end 2
}

TEST(TimoshenkoElement, PanelsDoNotMatter) {
  // A very slight cone goes through the 16-point rule; it must agree with the cylinder's 4-point
  // rule.
  const ShaftElementConstants a = make_shaft_constants(cylinder(0.06), 0.2, 0.03, -0.02);
  const ShaftElementConstants b =
      make_shaft_constants(cone(0.06, 0.06 * (1 + 1e-15)), 0.2, 0.03, -0.02);
  EXPECT_LT((a.M4 - b.M4).cwiseAbs().maxCoeff(), 1e-13 * a.M4.cwiseAbs().maxCoeff());
  EXPECT_LT((a.G4 - b.G4).cwiseAbs().maxCoeff(), 1e-12 * a.G4.cwiseAbs().maxCoeff());
  EXPECT_LT((a.polar - b.polar).cwiseAbs().maxCoeff(), 1e-13 * a.polar(0, 0));
  EXPECT_NEAR(a.tau_c, b.tau_c, 1e-13);
  EXPECT_NEAR(a.b12, b.b12, 1e-13);
}

/// Director g and slope w' of the static solution with one end rotation 1 and the other 0, at the
/// fractions i/n, from M = a + b s = EI g', w' = g - b/kGA, w(0) = w(l) = 0 by the trapezoidal rule
/// (error ~ 1/n^2).
struct StaticSolution {
  std::vector<double> g, slope;
};
StaticSolution static_solution(const ElementSection& s, double l, int end, std::size_t n) {
  const double h = l / static_cast<double>(n), g0 = end == 0 ? 1.0 : 0.0;
  // running integrals of 1/EI, s/EI; their integrals and that of 1/kGA over the length
  std::vector<double> one(n + 1, 0.0), along(n + 1, 0.0);
  double all_one = 0, all_along = 0, soft = 0;
  const auto at = [&](std::size_t i) { return s.at(static_cast<double>(i) / n); };
  for (std::size_t i = 0; i < n; ++i) {
    const SectionProperties p = at(i), q = at(i + 1);
    const double x = h * static_cast<double>(i);
    one[i + 1] = one[i] + 0.5 * h * (1 / p.EI + 1 / q.EI);
    along[i + 1] = along[i] + 0.5 * h * (x / p.EI + (x + h) / q.EI);
    all_one += 0.5 * h * (one[i] + one[i + 1]);
    all_along += 0.5 * h * (along[i] + along[i + 1]);
    soft += 0.5 * h * (1 / p.kGA + 1 / q.kGA);
  }
  Mat2 A;
  A << one[n], along[n], all_one, all_along - soft;
  const Vec2 ab = A.inverse() * Vec2((end == 1 ? 1.0 : 0.0) - g0, -g0 * l);
  StaticSolution out;
  for (std::size_t i = 0; i <= n; ++i) {
    out.g.push_back(g0 + ab[0] * one[i] + ab[1] * along[i]);
    out.slope.push_back(out.g[i] - ab[1] / at(i).kGA);
  }
  return out;
}

// Bowing and twist coefficients of a cone against integrals of the static solution.
TEST(TimoshenkoElement, ConicalBowingAndTwistCouplingFromShapes) {
  const ElementSection s = cone(0.1, 0.04, 0.02, 0.01);
  const double l = 0.15;
  const ShaftElementConstants c = make_shaft_constants(s, l);
  const auto sums = [&](std::size_t n) {
    const StaticSolution f = static_solution(s, l, 0, n), e = static_solution(s, l, 1, n);
    Vector<4> sum = Vector<4>::Zero();
    for (std::size_t i = 0; i <= n; ++i) {
      const double w = (i == 0 || i == n ? 0.5 : 1.0) / static_cast<double>(n);
      sum.head<3>() +=
          w * Vec3(f.slope[i] * f.slope[i], f.slope[i] * e.slope[i], e.slope[i] * e.slope[i]);
    }
    for (std::size_t i = 0; i < n; ++i)  // polygon area of the director curve (g1, g2)
      sum[3] += 0.5 * (f.g[i] * e.g[i + 1] - e.g[i] * f.g[i + 1]);
    return sum;
  };
  const Vector<4> coarse = sums(2000), fine = sums(4000), limit = fine + (fine - coarse) / 3.0;
  EXPECT_NEAR(c.b11, limit[0], 1e-10);
  EXPECT_NEAR(c.b12, limit[1], 1e-10);
  EXPECT_NEAR(c.b22, limit[2], 1e-10);
  EXPECT_NEAR(c.tau_c, -limit[3], 1e-10);
}

// ---------------------------------------------------------------- inertia of rigid motion

TEST(TimoshenkoElement, RigidInertiaIsExact) {
  for (MassKind kind : {MassKind::consistent, MassKind::corrected})
    for (double d2 : {0.06, 0.02, 0.15}) {
      const ElementSection s = cone(0.06, d2, 0.01, 0.015);
      const double l = 0.21, o1 = 0.04, o2 = -0.03;
      const ShaftElementConstants c = make_shaft_constants(s, l, o1, o2, kind);
      const auto I = [&](auto f) {
        return integrate([&](double x) { return f(x, s.at(x / l)); }, 0, l);
      };
      const double m = I([](double, const auto& p) { return p.rhoA; });
      const double S = I([](double x, const auto& p) { return p.rhoA * x; });
      const double J = I([](double x, const auto& p) { return p.rhoA * x * x + p.rhoI; });
      const double Jp = I([](double, const auto& p) { return p.rhoIp; });
      // Node positions are r_i - o_i d_i: nodes at -o1 and l - o2 from end 1.
      const Vector<4> shift(1, 0, 1, 0), turn(-o1, 1, l - o2, 1);
      const double tol = 1e-12;  // of the independent rule
      EXPECT_NEAR(shift.dot(c.M4 * shift), m, tol * m);
      EXPECT_NEAR(shift.dot(c.M4 * turn), S, tol * m * l);
      EXPECT_NEAR(turn.dot(c.M4 * turn), J, tol * m * l * l);
      EXPECT_NEAR(turn.dot(c.G4 * turn), Jp, tol * Jp);
      EXPECT_NEAR(shift.dot(c.G4 * shift), 0, tol * Jp / (l * l));
      EXPECT_NEAR(c.polar.sum(), Jp, tol * Jp);
      EXPECT_NEAR(c.mass, m, tol * m);
      EXPECT_NEAR((bending_stiffness(c) * turn).norm() / bending_stiffness(c).norm(), 0, 1e-15);
      EXPECT_LT((c.M4 - c.M4.transpose()).norm(), 1e-15 * c.M4.norm());
      Eigen::SelfAdjointEigenSolver<Matrix<4>> eig(c.M4);
      EXPECT_GT(eig.eigenvalues()(0), 0.0);
    }
}

TEST(TimoshenkoElement, MasslessAndTorsionlessConstants) {
  ElementSection s;
  s.constants = true;
  s.given.EI = 1000;
  s.given.EA = 1e6;
  const ShaftElementConstants c = make_shaft_constants(s, 0.5);
  EXPECT_EQ(c.M4.norm(), 0.0);
  EXPECT_EQ(c.polar.norm(), 0.0);
  EXPECT_EQ(c.GJ_l, 0.0);
  EXPECT_NEAR(c.k11, 8000, 1e-9);
}

}  // namespace
