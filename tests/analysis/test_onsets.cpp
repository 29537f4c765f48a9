// Onsets of whirl and of divergence of random rotors on tabulated bearings, from light to heavy, soft to
// stiff, undamped to overdamped, with stiffness that may become negative: verdicts and onsets against
// a dense method; on tables against frequency as well, by the criterion of Nyquist.
#include <la/dense.hpp>
#include "../validation/deck_model.hpp"
#include "two_methods.hpp"

#include <core/error.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

using namespace whirl;
using namespace whirl::analysis;
using whirl::test::DeckModel;

namespace {

constexpr double top_rpm = 12000;
constexpr double rpm_in_rad_s = std::numbers::pi / 30;

class TabulatedRotor {
 public:
  explicit TabulatedRotor(unsigned seed, bool by_frequency = false)
      : rng_(seed),
        by_frequency_(by_frequency) {
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
        "[[bearing]]\nat = \"{} m\"\ntype = \"table\"\ninterpolation = \"linear\"\n{}columns = "
        "[\"speed[rpm]\", {}\"kyy[N/m]\", \"kzz[N/m]\", \"kyz[N/m]\", \"kzy[N/m]\", "
        "\"cyy[N.s/m]\", \"czz[N.s/m]\"]\nrows = [",
        at, by_frequency_ ? "extrapolate = \"hold\"\n" : "",
        by_frequency_ ? "\"frequency[rpm]\", " : "");
    const double softened = chance(0.5) ? uniform(-1.0, 0.5) : uniform(0.5, 2.0);
    const double driven = chance(0.5) ? uniform(0.0, 1.0) : 0.0;
    const double other = uniform(0.7, 1.5);
    const double stiffened = by_frequency_ ? spread(0.5, 3.0) : 1;
    const double less_damped = by_frequency_ ? uniform(0.1, 1.0) : 1;
    for (int k = 0; k < 3; ++k) {
      const double share = 0.5 * k;
      for (int j = 0; j < (by_frequency_ ? 4 : 1); ++j) {
        const double high = j / 3.0;
        const double K = stiffness * (1 + share * (softened - 1)) * (1 + high * (stiffened - 1));
        const double cross = stiffness * driven * share;
        const double C = damping * (1 + high * (less_damped - 1));
        deck_ += fmt::format("[{}, ", top_rpm * share);
        if (by_frequency_) deck_ += fmt::format("{}, ", 2 * top_rpm * high);
        deck_ += fmt::format("{}, {}, {}, {}, {}, {}], ", K, stiffness * other * (1 - 0.3 * share),
                             cross, -cross, C, C * other);
      }
    }
    deck_ += "]\n";
  }

  std::mt19937 rng_;
  bool by_frequency_;
  std::string deck_;
};

/// Growing roots of a machine whose matrices depend on the frequency, by the criterion of Nyquist:
/// the angle through which det S turns, S(w) = K(w) + i w C(w) - w^2 M, from w = 0 to infinity. It
/// knows the matrices on the imaginary axis alone, where they mean what tables say. Between two
/// rows of the tables S is a polynomial of degree two in w, and each of its roots turns by the angle
/// under which the stretch is seen from it. Lateral motion only: the shaft is straight and round,
/// and nothing damps the rest.
class Nyquist {
 public:
  /// rows: frequencies of the tables, ascending from 0, rad/s; beyond the last they are held.
  Nyquist(Linearizer& linear, double Omega, std::span<const double> rows)
      : linear_(linear),
        Omega_(Omega) {
    for (std::size_t k = 0; k + 1 < rows.size(); ++k)
      add_stretch(rows[k], rows[k + 1]);
    add_stretch(rows.back(), infinity);
  }
  /// Two a pair that oscillates.
  Index growing() const { return std::lround(size_ - turned_ / pi); }
  /// No root stands on the axis, but for rounding.
  bool known() const { return known_; }

 private:
  struct Polynomial {
    MatXc A0, A1, A2;
    MatXc at(Complex w) const { return A0 + w * A1 + w * w * A2; }
  };

  Polynomial between(double a, double b) {
    const double end = b < infinity ? b : 2 * a;
    const double w1 = a + 0.3 * (end - a), w2 = a + 0.8 * (end - a);
    const auto lateral_at = [&](double w) {
      return tests::Dense(linear_.at(Omega_, Complex(0, w)), lateral(linear_));
    };
    const tests::Dense one = lateral_at(w1), two = lateral_at(w2),
                       third = lateral_at(0.5 * (w1 + w2));
    EXPECT_LT((0.5 * (one.K + two.K) - third.K).norm(), 1e-12 * third.K.norm());
    EXPECT_LT((0.5 * (one.C + two.C) - third.C).norm(), 1e-12 * (third.C.norm() + 1e-300));
    const MatX K1 = (two.K - one.K) / (w2 - w1), C1 = (two.C - one.C) / (w2 - w1);
    const MatX K0 = one.K - w1 * K1, C0 = one.C - w1 * C1;
    const Complex i(0, 1);
    size_ = static_cast<double>(K0.rows());
    return {K0.cast<Complex>(), K1 + i * C0, i * C1 - one.M};
  }

  /// Roots of det(A0 + w A1 + w^2 A2), but for infinite ones.
  static VecXc roots(const Polynomial& p, Complex shift) {
    const MatXc Q = p.at(shift);
    const Index n = Q.rows();
    VecX scale(n);
    for (Index i = 0; i < n; ++i)
      scale[i] = 1.0 / std::sqrt(std::max(std::abs(Q(i, i)), 1e-300));
    const auto scaled = [&](const MatXc& A) {
      return MatXc(scale.asDiagonal() * A * scale.asDiagonal());
    };
    const la::DenseLu<Complex> lu(scaled(Q));
    MatXc op(2 * n, 2 * n);
    op.topLeftCorner(n, n) = -lu.solve(scaled(shift * (p.A1 + 2.0 * shift * p.A2)));
    op.topRightCorner(n, n) = -lu.solve(scaled(shift * shift * p.A2));
    op.bottomLeftCorner(n, n).setIdentity();
    op.bottomRightCorner(n, n).setZero();
    const VecXc theta = la::eigenpairs(op).values;
    const double largest = theta.cwiseAbs().maxCoeff();
    std::vector<Complex> out;
    for (const Complex t : theta)
      if (std::abs(t) > 1e-11 * largest) out.push_back(shift + shift / t);
    return Eigen::Map<const VecXc>(out.data(), static_cast<Index>(out.size()));
  }

  void add_stretch(double a, double b) {
    const double middle = b < infinity ? 0.5 * (a + b) : 2 * a;
    for (const Complex w : roots(between(a, b), middle * Complex(1.0, 0.6))) {
      const Complex from = a - w;
      turned_ += b < infinity ? std::arg((b - w) / from) : -std::arg(from);
      const bool inside = w.real() > a && w.real() < b;
      known_ = known_ && (!inside || std::abs(w.imag()) > 1e-7 * std::abs(w));
    }
  }

  /// Of the active unknowns of a node, (u, phi, gamma), those across the axis.
  static std::vector<unsigned char> lateral(const Linearizer& linear) {
    std::vector<unsigned char> mask(linear.active().begin(), linear.active().end());
    for (std::size_t i = 0; i < mask.size(); ++i) {
      const std::size_t component = i % 6;
      if (component == 0 || component == 3) mask[i] = 0;
    }
    return mask;
  }

  Linearizer& linear_;
  double Omega_, turned_ = 0, size_ = 0;
  bool known_ = true;
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

TEST(Onsets, OfRotorsOnTablesAgainstFrequencyAreThoseOfTheNyquistCriterion) {
  const char* wanted = std::getenv("WHIRL_TABULATED_ROTORS");
  const int machines = wanted ? std::atoi(wanted) / 6 : 6;  // each takes six times as long
  std::vector<double> rows;
  for (int j = 0; j < 4; ++j)
    rows.push_back(2 * top_rpm * whirl::test::rpm * j / 3);
  tests::Compared sum;
  int grow = 0, uncertain = 0;
  for (int k = 1; k <= machines; ++k) {
    const std::string name = fmt::format("rotor {}", k);
    const TabulatedRotor rotor(1000 + static_cast<unsigned>(k), true);
    const DeckModel d(rotor.deck());
    Linearizer linear(d.built.system, d.running());
    StabilityOptions o;
    for (const double share : {0.02, 0.35, 0.67, 1.0})
      o.speeds.push_back(share * top_rpm * whirl::test::rpm);
    o.modes = 6;
    o.all = true;
    const StabilityResult r = find_instability(linear, o);
    for (const SpeedVerdict& v : r.verdicts) {
      if (!v.certificate.stability_certain()) {
        std::printf("%s at %g rpm: %s\n", name.c_str(), v.speed / rpm_in_rad_s,
                    v.certificate.text().c_str());
        ++uncertain;
        continue;
      }
      const Nyquist all(linear, v.speed, rows);
      if (!all.known()) continue;
      ++sum.verdicts;
      grow += v.growing > 0;
      EXPECT_EQ(v.growing, all.growing()) << name << " at " << v.speed / rpm_in_rad_s << " rpm";
    }
    tests::compare_onsets_to_verdicts(r, name, sum);
  }
  std::printf("%d verdicts, %d with growth, %d without a certificate, %d balances of onsets\n",
              sum.verdicts, grow, uncertain, sum.balances);
  EXPECT_GE(sum.verdicts, 3 * machines);
  EXPECT_GE(sum.balances, 2 * machines);
  EXPECT_GE(grow, machines);
  EXPECT_LE(uncertain, 4 * machines / 10);
}
