// Natural frequencies of small dense beams built from the element constants, against closed forms
// and against an independent shooting solution of the differential equations; measured orders of
// convergence.
#include <la/dense.hpp>
#include "round_sections.hpp"
#include <complex>
#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

using namespace whirl;
using namespace whirl::elements;
using namespace whirl::test;

namespace {

// ---------------------------------------------------------------- the discrete beam

enum class Ends { pinned, clamped_free, free_free };

/// Whirl of a spinning beam of n elements in w = y + i z: omega^2 M - omega Omega G - K = 0.
/// uneven: lengths alternate between (1 + uneven) and (1 - uneven) of the mean.
struct Beam {
  MatX K, M, G;
  std::vector<int> keep;
  int rigid = 0;  // number of zero frequencies

  Beam(const ElementSection& s, double L, int n, Ends ends, MassKind kind, double uneven = 0) {
    K = MatX::Zero(2 * n + 2, 2 * n + 2);
    M = K;
    G = K;
    for (int e = 0; e < n; ++e) {
      const double x1 = (e + (e % 2 ? uneven : 0)) / n, x2 = (e + 1 + (e % 2 ? 0 : uneven)) / n;
      const ShaftElementConstants c =
          make_shaft_constants(s.part(x1, x2), L * (x2 - x1), 0, 0, kind);
      K.block<4, 4>(2 * e, 2 * e) += bending_stiffness(c);
      M.block<4, 4>(2 * e, 2 * e) += c.M4;
      G.block<4, 4>(2 * e, 2 * e) += c.G4;
    }
    for (int i = 0; i < 2 * n + 2; ++i) {
      const bool held =
          ends == Ends::pinned ? i == 0 || i == 2 * n : ends == Ends::clamped_free && i < 2;
      if (!held) keep.push_back(i);
    }
    K = MatX(K(keep, keep));
    M = MatX(M(keep, keep));
    G = MatX(G(keep, keep));
    rigid = ends == Ends::free_free ? 2 : 0;
  }
  /// Frequency m = 1, 2, .. at rest, rad/s.
  double at_rest(int m) const { return whirl(m, 0, 1); }
  /// Forward (side = 1, positive) or backward (-1, negative) whirl of mode m at spin Omega: inverse
  /// iteration with the Rayleigh functional from the mode at rest, which keeps full accuracy
  /// whatever the highest frequency of the mesh.
  double whirl(int m, double Omega, int side) const {
    const la::SymmetricEigenpairs rest = la::symmetric_eigenpairs(K, M);
    VecX x = rest.vectors.col(rigid + m - 1);
    double o = 0;
    for (int it = 0; it < 12; ++it) {
      const double a = x.dot(M * x), b = Omega * x.dot(G * x), k = x.dot(K * x);
      o = (b + side * std::sqrt(b * b + 4 * a * k)) / (2 * a);
      const double shift = o * (it < 4 ? 1 + 1e-3 : 1 + 1e-7);
      x = la::DenseLu<double>(MatX(K + shift * Omega * G - shift * shift * M))
              .solve(VecX((2 * shift * M - Omega * G) * x));
      x.normalize();
    }
    return o;
  }
};

// ---------------------------------------------------------------- exact references

/// Pinned: (rhoA w^2 - kGA k^2)(rhoI w^2 - rhoIp Omega w - EI k^2 - kGA) = (kGA k)^2, or, for
/// infinite kGA, (rhoA + rhoI k^2) w^2 - rhoIp Omega k^2 w = EI k^4; k = m pi/L. The root nearest
/// to the guess, by Newton.
double exact_pinned(const SectionProperties& p, double L, int m, double Omega, double guess) {
  const long double k = m * static_cast<long double>(pi) / L, k2 = k * k;
  long double w = guess;
  for (int i = 0; i < 60; ++i) {
    long double f, df;
    if (std::isinf(p.kGA)) {
      f = (p.rhoA + p.rhoI * k2) * w * w - p.rhoIp * Omega * k2 * w - p.EI * k2 * k2;
      df = 2 * (p.rhoA + p.rhoI * k2) * w - p.rhoIp * Omega * k2;
    } else {
      const long double a = p.rhoA * w * w - p.kGA * k2,
                        b = p.rhoI * w * w - p.rhoIp * Omega * w - p.EI * k2 - p.kGA;
      f = a * b - static_cast<long double>(p.kGA) * p.kGA * k2;
      df = 2 * p.rhoA * w * b + a * (2 * p.rhoI * w - p.rhoIp * Omega);
    }
    w -= f / df;
  }
  return static_cast<double>(w);
}

/// Any taper, any ends: w' = th + Q/kGA, th' = M/EI, M' = -Q - (omega^2 rhoI - omega Omega rhoIp)
/// th, Q' = -omega^2 rhoA w, integrated from both admissible starts by RK4 (3000 steps: error below
/// 1e-11 for the first three modes), secant on the determinant of the end conditions.
double exact_shooting(const ElementSection& s, double L, Ends ends, double Omega, double guess) {
  const int n = 3000;
  std::vector<SectionProperties> p;
  for (int i = 0; i <= 2 * n; ++i)
    p.push_back(s.at(0.5 * i / n));
  const auto det = [&](double o) {
    const auto rhs = [&](const Vector<4>& y, const SectionProperties& q) {
      return Vector<4>(y(1) + y(3) / q.kGA, y(2) / q.EI,
                       -y(3) - (o * o * q.rhoI - o * Omega * q.rhoIp) * y(1),
                       -o * o * q.rhoA * y(0));
    };
    const std::array<int, 2> start = ends == Ends::pinned         ? std::array{1, 3}
                                     : ends == Ends::clamped_free ? std::array{2, 3}
                                                                  : std::array{0, 1};
    const std::array<int, 2> end = ends == Ends::pinned ? std::array{0, 2} : std::array{2, 3};
    Mat2 D;
    const double h = L / n;
    for (int c = 0; c < 2; ++c) {
      Vector<4> y = Vector<4>::Zero();
      y(start[c]) = start[c] >= 2 ? p[0].EI : 1;  // comparable sizes of forces and motions
      for (int i = 0; i < n; ++i) {
        const Vector<4> k1 = rhs(y, p[2 * i]), k2 = rhs(y + h / 2 * k1, p[2 * i + 1]);
        const Vector<4> k3 = rhs(y + h / 2 * k2, p[2 * i + 1]), k4 = rhs(y + h * k3, p[2 * i + 2]);
        y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      }
      for (int r = 0; r < 2; ++r)
        D(r, c) = y(end[r]) / (end[r] >= 2 ? p[0].EI : 1);
    }
    return D.determinant();
  };
  double a = guess, b = guess * (1 + 1e-4), fa = det(a), fb = det(b);
  for (int i = 0; i < 30 && std::abs(b - a) > 1e-14 * std::abs(b) && fb != fa; ++i) {
    const double c = b - fb * (b - a) / (fb - fa);
    a = b;
    fa = fb;
    b = c;
    fb = det(b);
  }
  return b;
}

double order(double coarse, double fine) { return std::log2(std::abs(coarse / fine)); }

// ---------------------------------------------------------------- slender shafts: the numbers
// everyone quotes

// Euler-Bernoulli, first mode, 8 elements. Reference roots: pi, 1.875104068711961,
// 4.730040744862704.
TEST(TimoshenkoConvergence, SlenderEightElements) {
  const ElementSection s = cylinder(0.02, ShearRule::rigid, false);
  const double w = std::sqrt(s.at(0).EI / s.at(0).rhoA);
  struct Case {
    Ends ends;
    double root, consistent, corrected;
  };
  for (const Case c :
       {Case{Ends::pinned, pi, 4e-5, 2e-7}, Case{Ends::clamped_free, 1.875104068711961, 5e-6, 3e-8},
        Case{Ends::free_free, 4.730040744862704, 1e-4, 9e-6}}) {
    const double exact = c.root * c.root * w;
    const double plain =
        std::abs(Beam(s, 1, 8, c.ends, MassKind::consistent).at_rest(1) / exact - 1);
    const double fixed =
        std::abs(Beam(s, 1, 8, c.ends, MassKind::corrected).at_rest(1) / exact - 1);
    EXPECT_LT(plain, c.consistent);
    EXPECT_GT(plain, c.consistent / 4);  // the consistent mass really is that much worse
    EXPECT_LT(fixed, c.corrected);
  }
}

TEST(TimoshenkoConvergence, SlenderOrders) {
  const ElementSection s = cylinder(0.02, ShearRule::rigid, false);
  for (Ends ends : {Ends::pinned, Ends::clamped_free, Ends::free_free})
    for (int m : {1, 2, 3}) {
      std::array<double, 2> plain, fixed;
      for (int k = 0; k < 2; ++k) {
        const int n = 6 << k;
        const Beam a(s, 1, n, ends, MassKind::consistent), b(s, 1, n, ends, MassKind::corrected);
        const double exact = ends == Ends::pinned ? exact_pinned(s.at(0), 1, m, 0, b.at_rest(m))
                                                  : exact_shooting(s, 1, ends, 0, b.at_rest(m));
        plain[k] = a.at_rest(m) / exact - 1;
        fixed[k] = b.at_rest(m) / exact - 1;
      }
      SCOPED_TRACE(m);
      EXPECT_GT(order(plain[0], plain[1]), 3.6);
      EXPECT_LT(order(plain[0], plain[1]), 4.3);
      EXPECT_GT(order(fixed[0], fixed[1]), 5.7);  // 6: the leading error is cancelled
    }
}

// ---------------------------------------------------------------- thick shafts, at rest and
// spinning

// Order 4 at least, from elements longer than the shaft is thick down to much shorter ones, equal
// or not. 1e-9: round-off of the dense eigenproblem with 64 elements.
TEST(TimoshenkoConvergence, ThickPinnedOrdersAtRestAndSpinning) {
  for (double d : {0.1, 0.2})
    for (double Omega : {0.0, 1e4})
      for (double uneven : {0.0, 0.3})
        for (int side : {1, -1}) {
          const ElementSection s = cylinder(d);
          std::array<double, 4> e{};
          for (int k = 0; k < 4; ++k) {
            const double w =
                Beam(s, 1, 8 << k, Ends::pinned, MassKind::corrected, uneven).whirl(1, Omega, side);
            e[k] = w / exact_pinned(s.at(0), 1, 1, Omega, w) - 1;
          }
          std::printf(
              "  thick pinned d/L %.1f Omega %6.0f uneven %.1f side %2d: 8..64 elements %9.1e "
              "%9.1e %9.1e %9.1e\n",
              d, Omega, uneven, side, e[0], e[1], e[2], e[3]);
          EXPECT_LT(std::abs(e[0]), 8e-5);
          EXPECT_GT(order(e[1], e[3]) / 2,
                    3.6);  // mean of two halvings; the slope is still steepening from 16 elements
          EXPECT_LT(std::abs(e[3]), 3e-8);
        }
}

// The order at any spin, without the rounding of an eigensolver: n equal elements between pins
// vibrate in exact sines, x_j = (w cos, th sin)(k x_j), so the dispersion relation of an endless
// chain is theirs, two by two, solved in long double. While the elements are longer than the shaft
// is thick the errors of bending and of shear (orders 6 and 4, of both signs) compete and slopes of
// 1 to 3.8 show up; they end at 4, at any spin.
TEST(TimoshenkoConvergence, OrderFourAtAnySpin) {
  using Real = long double;
  for (const double d : {0.02, 0.1, 0.2})
    for (const double Omega : {0.0, 1e4, 1e5})
      for (const int side : {1, -1}) {
        if (d == 0.02 && Omega == 0.0)
          continue;  // order 6 until it reaches 1e-12, the rounding of the element's matrices
        const ElementSection s = cylinder(d);
        const SectionProperties p = s.at(0);
        const Real k = pi, k2 = k * k;
        const auto error = [&](int n) {
          const ShaftElementConstants c =
              make_shaft_constants(s, 1.0 / n, 0, 0, MassKind::corrected);
          const Matrix<4> stiffness = bending_stiffness(c);
          const std::complex<Real> next = std::exp(std::complex<Real>(0, k / n));
          const auto chain = [&](const Matrix<4>& a) {
            Eigen::Matrix<std::complex<Real>, 2, 2> r;
            for (int i = 0; i < 2; ++i)
              for (int j = 0; j < 2; ++j)
                r(i, j) = Real(a(i, j)) + Real(a(i + 2, j + 2)) + Real(a(i, j + 2)) * next +
                          Real(a(i + 2, j)) * std::conj(next);
            return r;
          };
          const auto K = chain(stiffness), M = chain(c.M4), G = chain(c.G4);
          const Real a0 = p.rhoA + p.rhoI * k2, b0 = p.rhoIp * Omega * k2;
          const Real exact = exact_pinned(
              p, 1, 1, Omega,
              static_cast<double>((b0 + side * std::sqrt(b0 * b0 + 4 * a0 * p.EI * k2 * k2)) /
                                  (2 * a0)));
          const auto det = [&](Real w) {
            Eigen::Matrix<std::complex<Real>, 2, 2> q;
            for (int i = 0; i < 2; ++i)
              for (int j = 0; j < 2; ++j)
                q(i, j) = K(i, j) + w * Real(Omega) * G(i, j) - w * w * M(i, j);
            return (q(0, 0) * q(1, 1) - q(0, 1) * q(1, 0)).real();
          };
          Real a = exact * (1 + 1e-6L), b = exact * (1 - 1e-6L), fa = det(a), fb = det(b);
          for (int i = 0; i < 40 && fa != fb; ++i) {
            const Real x = b - fb * (b - a) / (fb - fa);
            a = b;
            fa = fb;
            b = x;
            fb = det(b);
          }
          return static_cast<double>(b / exact - 1);
        };
        // d/L = 0.02: elements become as short as the shaft is thick at 50; the error there is 1e-8
        // already
        const int n = d == 0.02 ? 256 : 64;
        if (d > 0.02 || Omega > 1e4) {
          EXPECT_NEAR(order(error(n), error(2 * n)), 4.0, 0.13) << d << ' ' << Omega << ' ' << side;
        }
        EXPECT_LT(std::abs(error(n)), d == 0.02 ? 5e-9 : Omega > 1e4 ? 2e-6 : 2e-8);
      }
}

TEST(TimoshenkoConvergence, ConsistentMassIsOrderTwoWhenThick) {
  const ElementSection s = cylinder(0.2);
  std::array<double, 2> e{};
  for (int k = 0; k < 2; ++k) {
    const double w = Beam(s, 1, 16 << k, Ends::pinned, MassKind::consistent).at_rest(1);
    e[k] = w / exact_pinned(s.at(0), 1, 1, 0, w) - 1;
  }
  EXPECT_NEAR(order(e[0], e[1]), 2.0, 0.1);
}

TEST(TimoshenkoConvergence, ThickEndsAtRestAndSpinning) {
  const ElementSection s = cylinder(0.15);
  for (Ends ends : {Ends::clamped_free, Ends::free_free})
    for (double Omega : {0.0, 5e3})
      for (int m : {1, 2}) {
        std::array<double, 4> e{};
        for (int k = 0; k < 4; ++k) {
          const double w = Beam(s, 1, 8 << k, ends, MassKind::corrected).whirl(m, Omega, 1);
          e[k] = w / exact_shooting(s, 1, ends, Omega, w) - 1;
        }
        const double plain = Beam(s, 1, 32, ends, MassKind::consistent).whirl(m, Omega, 1);
        std::printf("  thick %-12s Omega %5.0f mode %d: 8..64 elements %9.1e %9.1e %9.1e %9.1e\n",
                    ends == Ends::free_free ? "free-free" : "clamped-free", Omega, m, e[0], e[1],
                    e[2], e[3]);
        EXPECT_GT(order(e[2], e[3]), 3.5);
        EXPECT_LT(std::abs(e[2]),
                  std::abs(plain / exact_shooting(s, 1, ends, Omega, plain) - 1) / 100);
      }
}

// ---------------------------------------------------------------- cones

// slender (slope from 8 to 32 elements): order 4 either way, the correction gains a factor only
// where c_w changes little along the shaft (it varies like 1/d^2). thick (slope from 32 to 64):
// order 4 instead of 2 as long as rhoA/kGA is constant; a wall that tapers differently from the
// outside changes kappa, and order 2 comes back with a tenth of the consistent mass's error.
TEST(TimoshenkoConvergence, ConicalOrders) {
  struct Case {
    const char* name;
    ElementSection s;
    bool slender;
    double least_order;
  };
  for (const Case& c : {Case{"slender, Euler-Bernoulli, 1:2",
                             cone(0.01, 0.02, 0, 0, ShearRule::rigid, false), true, 3.7},
                        Case{"slender 3:1", cone(0.03, 0.01), true, 3.7},
                        Case{"thick 1:2", cone(0.1, 0.2), false, 3.5},
                        Case{"hollow 2:1, bore 1:2", cone(0.2, 0.1, 0.04, 0.08), false, 1.8}})
    for (Ends ends : {Ends::pinned, Ends::clamped_free, Ends::free_free}) {
      std::array<double, 5> e{}, plain{};
      for (int k = 0; k < 5; ++k) {
        const double w = Beam(c.s, 1, 4 << k, ends, MassKind::corrected).at_rest(1),
                     exact = exact_shooting(c.s, 1, ends, 0, w);
        e[k] = w / exact - 1;
        plain[k] = Beam(c.s, 1, 4 << k, ends, MassKind::consistent).at_rest(1) / exact - 1;
      }
      std::printf(
          "  cone %-29s ends %d: 4..64 elements, corrected %8.1e %8.1e %8.1e %8.1e %8.1e, "
          "consistent %8.1e .. %8.1e\n",
          c.name, static_cast<int>(ends), e[0], e[1], e[2], e[3], e[4], plain[0], plain[4]);
      EXPECT_GT(c.slender ? order(e[1], e[3]) / 2 : order(e[3], e[4]), c.least_order);
      EXPECT_LT(std::abs(e[1]), 6e-5);
      EXPECT_LT(std::abs(e[3]), std::max(2.5 * std::abs(plain[3]) / 7, 3e-9));
    }
}

// ---------------------------------------------------------------- torsion

/// Fixed-free torsion of n elements, frequency m.
double torsion(const ElementSection& s, double L, int n, int m, MassKind kind, double uneven = 0) {
  MatX K = MatX::Zero(n + 1, n + 1), M = K;
  for (int e = 0; e < n; ++e) {
    const double x1 = (e + (e % 2 ? uneven : 0)) / n, x2 = (e + 1 + (e % 2 ? 0 : uneven)) / n;
    const ShaftElementConstants c = make_shaft_constants(s.part(x1, x2), L * (x2 - x1), 0, 0, kind);
    K.block<2, 2>(e, e) += c.GJ_l * (Mat2() << 1, -1, -1, 1).finished();
    M.block<2, 2>(e, e) += c.polar;
  }
  const MatX k = K.bottomRightCorner(n, n), mm = M.bottomRightCorner(n, n);
  return std::sqrt(la::symmetric_eigenpairs(k, mm).values(m - 1));
}
/// theta' = T/GJ, T' = -omega^2 rhoIp theta from (0, 1) to T = 0.
double exact_torsion(const ElementSection& s, double L, double guess) {
  const int n = 3000;
  const auto tip = [&](double o) {
    Vec2 y(0, 1);
    const double h = L / n;
    const auto rhs = [&](const Vec2& v, double xi) {
      const SectionProperties q = s.at(xi);
      return Vec2(v(1) / q.GJ * 1e6, -o * o * q.rhoIp * v(0) * 1e-6);
    };
    for (int i = 0; i < n; ++i) {
      const double x = static_cast<double>(i) / n, d = 0.5 / n;
      const Vec2 k1 = rhs(y, x), k2 = rhs(y + h / 2 * k1, x + d), k3 = rhs(y + h / 2 * k2, x + d),
                 k4 = rhs(y + h * k3, x + 2 * d);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return y(1);
  };
  double a = guess, b = guess * (1 + 1e-4), fa = tip(a), fb = tip(b);
  for (int i = 0; i < 30 && std::abs(b - a) > 1e-14 * b && fb != fa; ++i) {
    const double c = b - fb * (b - a) / (fb - fa);
    a = b;
    fa = fb;
    b = c;
    fb = tip(b);
  }
  return b;
}

TEST(TimoshenkoConvergence, TorsionOrders) {
  struct Case {
    const char* name;
    ElementSection s;
  };
  for (const Case& c : {Case{"cylinder", cylinder(0.05)}, Case{"cone 1:2", cone(0.05, 0.1)},
                        Case{"hollow 10:3", cone(0.1, 0.03, 0.02, 0.02)}})
    for (double uneven : {0.0, 0.3}) {
      std::array<double, 4> e{}, plain{};
      for (int k = 0; k < 4; ++k) {
        const double w = torsion(c.s, 1, 4 << k, 1, MassKind::corrected, uneven),
                     exact = exact_torsion(c.s, 1, w);
        e[k] = w / exact - 1;
        plain[k] = torsion(c.s, 1, 4 << k, 1, MassKind::consistent, uneven) / exact - 1;
      }
      std::printf(
          "  torsion %-11s uneven %.1f: 4..32 elements, corrected %8.1e %8.1e %8.1e %8.1e, "
          "consistent %8.1e .. %8.1e\n",
          c.name, uneven, e[0], e[1], e[2], e[3], plain[0], plain[3]);
      EXPECT_GT(order(e[2], e[3]), uneven == 0 ? 3.9 : 2.9);
      EXPECT_NEAR(order(plain[2], plain[3]), 2, 0.1);
      EXPECT_LT(std::abs(e[3]), std::abs(plain[3]) / 15);
    }
}

}  // namespace
