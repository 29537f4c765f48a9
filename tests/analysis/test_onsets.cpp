// Onsets of whirl and of divergence of random rotors on bearings tabulated against speed, from light
// to heavy, soft to stiff, undamped to overdamped, with stiffness that may become negative: verdicts
// and onsets against a dense method.
#include "../validation/deck_model.hpp"
#include "two_methods.hpp"

#include <core/error.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

using namespace whirl;
using namespace whirl::analysis;
using whirl::test::DeckModel;

namespace {

constexpr double top_rpm = 12000;

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
/// the angle through which det(K(w) + i w C(w) - w^2 M) turns from w near 0 to above all its roots.
/// It knows the matrices on the imaginary axis alone, where they mean what tables say.
class Nyquist {
 public:
  Nyquist(Linearizer& linear, double Omega) : linear_(linear), Omega_(Omega) {
    const double low = 1e-4 * rad(top_rpm), high = 1e6 * rad(top_rpm);
    const double steps = 400;
    double w = low;
    Complex at = direction(w);
    for (int k = 1; k <= steps; ++k) {
      const double next = low * std::pow(high / low, k / steps);
      const Complex there = direction(next);
      turned_ += turn(w, at, next, there, 0);
      w = next;
      at = there;
    }
  }
  double turned() const { return turned_; }
  bool resolved() const { return resolved_; }

 private:
  static double rad(double speed_rpm) { return speed_rpm * whirl::test::rpm; }

  Complex direction(double w) {
    const tests::Dense d(linear_.at(Omega_, Complex(0, w)), linear_.active());
    const MatXc S =
        d.K.cast<Complex>() + Complex(0, w) * d.C.cast<Complex>() - w * w * d.M.cast<Complex>();
    VecX scale(d.size());
    for (Index i = 0; i < d.size(); ++i)
      scale[i] = 1.0 / std::sqrt(std::max(std::abs(S(i, i)), 1e-300));
    const Eigen::PartialPivLU<MatXc> lu(scale.asDiagonal() * S * scale.asDiagonal());
    Complex product(lu.permutationP().determinant(), 0);
    for (Index i = 0; i < d.size(); ++i)
      product *= lu.matrixLU()(i, i) / std::abs(lu.matrixLU()(i, i));
    return product;
  }

  double turn(double a, Complex at_a, double b, Complex at_b, int depth) {
    const double angle = std::arg(at_b / at_a);
    const double middle = 0.5 * (a + b);
    const Complex between = direction(middle);
    const double first = std::arg(between / at_a), second = std::arg(at_b / between);
    const bool smooth =
        std::abs(first) < 0.5 && std::abs(second) < 0.5 && std::abs(first + second - angle) < 1e-6;
    if (smooth) return first + second;
    if (depth == 40) {
      resolved_ = false;
      return angle;
    }
    return turn(a, at_a, middle, between, depth + 1) + turn(middle, between, b, at_b, depth + 1);
  }

  Linearizer& linear_;
  double Omega_, turned_ = 0;
  bool resolved_ = true;
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
  const unsigned machines = wanted ? static_cast<unsigned>(std::atoi(wanted)) : 10;
  int onsets = 0, balances = 0, incomplete = 0;
  for (unsigned seed = 1; seed <= machines; ++seed) {
    const TabulatedRotor rotor(1000 + seed, true);
    const DeckModel d(rotor.deck());
    Linearizer linear(d.built.system, d.running());
    StabilityOptions o;
    for (int k = 0; k < 4; ++k)
      o.speeds.push_back((0.02 + 0.98 * k / 3) * top_rpm * whirl::test::rpm);
    o.modes = 6;
    o.all = true;
    const StabilityResult r = find_instability(linear, o);
    std::vector<double> turned;
    for (const double Omega : o.speeds) {
      const Nyquist n(linear, Omega);
      turned.push_back(n.resolved() ? n.turned() : whirl::nan);
    }
    for (std::size_t k = 1; k < o.speeds.size(); ++k) {
      if (!std::isfinite(turned[k] + turned[k - 1])) continue;
      // a root that comes over the axis turns the determinant by pi less over the half axis
      const double more = (turned[k - 1] - turned[k]) / pi;
      Index change = 0;
      for (const Onset& x : r.onsets)
        if (x.speed > o.speeds[k - 1] && x.speed <= o.speeds[k])
          change += (x.gains ? 1 : -1) * (x.divergence() ? 1 : 2);
      std::printf("rotor %u: %g..%g rpm: nyquist %g, onsets %ld, growing %ld -> %ld, %s\n", seed,
                  o.speeds[k - 1] / whirl::test::rpm, o.speeds[k] / whirl::test::rpm, more,
                  long(change), long(r.verdicts[k - 1].growing), long(r.verdicts[k].growing),
                  r.verdicts[k].certificate.stability_certain()
                      ? ""
                      : r.verdicts[k].certificate.text().c_str());
    }
    onsets += static_cast<int>(r.onsets.size());
  }
  std::printf("%d onsets\n", onsets);
}
