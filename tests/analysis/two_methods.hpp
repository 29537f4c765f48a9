// What the program says of a machine by another method, on dense matrices: responses, critical
// speeds, statics, decay, onsets of instability, and modes whose matrices depend on their own rate.
#pragma once
#include "machine_checks.hpp"

#include <analysis/response/unbalance.hpp>
#include <analysis/spectra/critical.hpp>
#include <analysis/spectra/stability.hpp>

#include <la/dense.hpp>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

namespace whirl::tests {

/// What was compared, and the largest relative differences.
struct Compared {
  int responses = 0, criticals = 0, statics = 0, decays = 0, verdicts = 0, onsets = 0,
      divergences = 0, balances = 0, rates = 0, lists = 0, refused = 0;
  double response = 0, critical = 0, place = 0, decay = 0, rate = 0;
};

/// M, C, K of the unknowns that are not held.
struct Dense {
  std::vector<Index> unknowns;
  MatX M, C, K;
  Dense(const la::MCK& m, std::span<const unsigned char> active) {
    for (std::size_t i = 0; i < active.size(); ++i)
      if (active[i]) unknowns.push_back(static_cast<Index>(i));
    M = la::test::dense(m.M)(unknowns, unknowns);
    C = la::test::dense(m.C)(unknowns, unknowns);
    K = la::test::dense(m.K)(unknowns, unknowns);
  }
  Index size() const { return K.rows(); }
  VecXc taken(const VecXc& x) const { return x(unknowns); }
};

/// The scale about which a dense method is accurate: frequencies looked at.
inline double scale_of(double Omega) { return std::max(0.37 * std::abs(Omega), 1.0); }

inline double distance_to(Complex lambda, const std::vector<Complex>& roots) {
  double least = infinity;
  for (const Complex s : roots)
    least = std::min(least, std::abs(s - lambda));
  return least / std::abs(lambda);
}

/// Amplitudes of the unknowns by a dense LU, against those of the sparse solver.
inline void compare_response(Linearizer& linear, double Omega, const std::string& name,
                             Compared& sum) {
  UnbalanceOptions o;
  o.speeds = {Omega};
  o.refine_peaks = false;
  o.shapes = true;
  UnbalanceSolver solver(linear, o);
  const SteadyPoint point = solver.at(Omega, false);
  const auto orders = linear.running().orders();
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const double w = orders[k] * std::abs(Omega);
    const Dense d(linear.at(Omega, Complex(0, w)), linear.active());
    const VecXc f =
        Omega > 0 ? VecXc(-linear.forcing()[k]) : VecXc(-linear.forcing()[k].conjugate());
    const MatXc S =
        d.K.cast<Complex>() + Complex(0, w) * d.C.cast<Complex>() - w * w * d.M.cast<Complex>();
    // rows and columns on one scale
    VecX scale(d.size());
    for (Index i = 0; i < d.size(); ++i)
      scale[i] = 1.0 / std::sqrt(std::max(std::abs(S(i, i)), 1e-300));
    const MatXc scaled = scale.asDiagonal() * S * scale.asDiagonal();
    const VecXc x = scale.asDiagonal() *
                    scaled.fullPivLu().solve(VecXc(scale.asDiagonal() * d.taken(f))).eval();
    const VecXc own = d.taken(point.shape[k]);
    const double away = (own - x).norm() / x.norm();
    sum.response = std::max(sum.response, away);
    ++sum.responses;
    EXPECT_LT(away, 1e-6) << name << ", response of order " << orders[k];
  }
}

/// Oscillating roots of the conservative part at a speed, rad/s, ascending.
inline std::vector<double> undamped_frequencies(Linearizer& linear, double Omega) {
  const std::vector<Complex> all =
      all_roots(linear.conservative_at(Omega), linear.active(), scale_of(Omega));
  std::vector<double> out;
  for (const Complex s : all)
    if (s.imag() > 1e-3 * std::abs(Omega) && std::abs(s.real()) < 1e-4 * s.imag())
      out.push_back(s.imag());
  std::sort(out.begin(), out.end());
  return out;
}

inline Index count_below(const std::vector<double>& frequencies, double w) {
  return std::upper_bound(frequencies.begin(), frequencies.end(), w) - frequencies.begin();
}

/// Each critical speed is a frequency of the dense problem there; and what lies below the order line
/// at both ends rises by no more than those found, each counted the way it crosses.
inline void compare_criticals(Linearizer& linear, double low, double high, const std::string& name,
                              Compared& sum) {
  CriticalOptions o;
  o.min_speed = low;
  o.max_speed = high;
  std::vector<Critical> found;
  try {
    found = critical_speeds(linear, o);
  } catch (const Error& e) {  // pads that rest: without damping nothing holds them; no equilibrium
    const std::string code = e.diagnostics().front().code;
    EXPECT_TRUE(code == "E77" || code == "E75" || code == "E76") << name << ": " << e.what();
    ++sum.refused;
    return;
  }
  Index crossed = 0;
  bool alone = true;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double Omega = found[k].speed;
    double nearest = infinity;
    for (const double w : undamped_frequencies(linear, Omega))
      nearest = std::min(nearest, std::abs(w - Omega) / Omega);
    sum.critical = std::max(sum.critical, nearest);
    ++sum.criticals;
    EXPECT_LT(nearest, 1e-6) << name << ", critical speed " << Omega / rpm << " rpm";
    const double beside = 1e-4 * Omega;
    alone = alone && Omega - beside > low && Omega + beside < high &&
            (k == 0 || found[k - 1].speed < Omega - 4 * beside);
    crossed += count_below(undamped_frequencies(linear, Omega + beside), Omega + beside) -
               count_below(undamped_frequencies(linear, Omega - beside), Omega - beside);
  }
  if (!alone) return;  // two together: counted twice
  const Index change = count_below(undamped_frequencies(linear, high), high) -
                       count_below(undamped_frequencies(linear, low), low);
  // fewer: a frequency that falls to zero (divergence) leaves the count without a critical speed
  EXPECT_LE(change, crossed) << name << ", critical speeds from " << low / rpm << " to "
                             << high / rpm << " rpm";
}

/// The same place with the loads put on in parts.
inline void compare_statics(Linearizer& linear, const DeckModel& d, double Omega,
                            const std::string& name, Compared& sum) {
  linear.at(Omega);
  const VecX own = linear.equilibrium().state.q;
  EquilibriumOptions o;
  o.load_steps = 7;
  SteadySystem running(d.built.system, d.running());
  EquilibriumSolver solver(running, o);
  const auto other = solver.try_solve(Omega);
  if (!other) return;  // a film that carries no part of its load
  double size = 0, away = 0;
  for (Index n = 0; n < d.built.system.nodes(); ++n) {
    if (d.built.system.node(n).scalar) continue;
    size = std::max(size, own.segment<3>(6 * n).norm());
    away = std::max(away, (own - other->state.q).segment<3>(6 * n).norm());
  }
  if (away > 1e-3 * size) return;  // pads that rest, loaded on another way: another equilibrium
  sum.place = std::max(sum.place, size > 0 ? away / size : 0.0);
  ++sum.statics;
  EXPECT_LT(away, 1e-6 * size) << name;
}

/// One period of the free motion by Gauss's method of order 6 in small steps, from a mode: what it
/// comes to against exp(lambda T).
inline double decay_error(const Dense& d, Complex lambda, const VecXc& x) {
  constexpr int steps = 80;
  const double root = std::sqrt(15.0);
  const double a[3][3] = {{5.0 / 36, 2.0 / 9 - root / 15, 5.0 / 36 - root / 30},
                          {5.0 / 36 + root / 24, 2.0 / 9, 5.0 / 36 - root / 24},
                          {5.0 / 36 + root / 30, 2.0 / 9 + root / 15, 5.0 / 36}};
  const double b[3] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
  const Index n = d.size();
  const double h = two_pi / std::abs(lambda.imag()) / steps;
  // stages are accelerations: v_i = v + h sum a_ij A_j, q_i = q + h c_i v + h^2 sum (a a)_ij A_j
  MatX big(3 * n, 3 * n);
  double aa[3][3] = {}, c[3] = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      c[i] += a[i][j];
      for (int k = 0; k < 3; ++k)
        aa[i][j] += a[i][k] * a[k][j];
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      big.block(i * n, j * n, n, n) =
          (i == j ? d.M : MatX(MatX::Zero(n, n))) + h * a[i][j] * d.C + h * h * aa[i][j] * d.K;
  VecX scale(n);
  for (Index i = 0; i < n; ++i)
    scale[i] = 1.0 / std::sqrt(std::max(std::abs(big(i, i)), 1e-300));
  const VecX all_scales = scale.replicate(3, 1);
  const Eigen::FullPivLU<MatX> lu(all_scales.asDiagonal() * big * all_scales.asDiagonal());
  VecX q = x.real(), v = (lambda * x).real();
  for (int step = 0; step < steps; ++step) {
    VecX right(3 * n);
    for (int i = 0; i < 3; ++i)
      right.segment(i * n, n) = -(d.C * v + d.K * (q + h * c[i] * v));
    const VecX A = all_scales.asDiagonal() * lu.solve(VecX(all_scales.asDiagonal() * right));
    for (int i = 0; i < 3; ++i) {
      double weight = 0;
      for (int j = 0; j < 3; ++j)
        weight += b[j] * a[j][i];
      q += h * h * weight * A.segment(i * n, n);
    }
    q += h * v;
    for (int i = 0; i < 3; ++i)
      v += h * b[i] * A.segment(i * n, n);
  }
  const double shrunk = std::exp(lambda.real() * h * steps);
  return (q / shrunk - x.real()).norm() / x.norm();
}

/// Modes as motions in time.
inline void compare_decay(Linearizer& linear, double Omega, const std::vector<WhirlMode>& modes,
                          const std::string& name, Compared& sum) {
  const Dense d(linear.at(Omega), linear.active());
  int looked = 0;
  for (const WhirlMode& m : modes) {
    // slow ones are stiff in time, and what grows meanwhile would cover them
    if (!m.oscillates() || m.damping_ratio > 0.5 || m.frequency < 0.05 * Omega || looked == 2)
      continue;
    ++looked;
    const double away = decay_error(d, m.lambda, d.taken(m.x));
    sum.decay = std::max(sum.decay, away);
    ++sum.decays;
    EXPECT_LT(away, 1e-5) << name << ": " << m.lambda;
  }
}

/// Roots of the dense problem, and how well they are known.
struct DenseRoots {
  std::vector<Complex> all;
  double largest = 0, speed = 0;
  DenseRoots(Linearizer& linear, double Omega) : speed(std::abs(Omega)) {
    for (const Complex s : all_roots(linear.at(Omega), linear.active(), scale_of(Omega)))
      if (std::abs(s) < 1e7 * speed) all.push_back(s);
    for (const Complex s : all)
      largest = std::max(largest, std::abs(s));
  }
  /// A double root at zero, a free motion, comes out as large as the square root of rounding.
  double doubt(Complex s) const {
    if (std::abs(s) < 2e-8 * largest) return 2e-8 * largest;
    return 1e-6 * std::abs(s) + 1e-9 * largest + 1e-6 * speed;
  }
  Complex nearest(Complex to) const {
    return *std::min_element(all.begin(), all.end(), [to](Complex a, Complex b) {
      return std::abs(a - to) < std::abs(b - to);
    });
  }
};

/// Growing pairs and real roots: those that grow beyond doubt, and all that may.
struct Growing {
  Index surely = 0, perhaps = 0;
};
inline Growing growing_roots(Linearizer& linear, const SpeedVerdict& v) {
  const DenseRoots dense(linear, v.speed);
  const SpectrumCertificate& c = v.certificate;
  // what the certificate leaves open above its list, and says so
  const auto left_open = [&c](Complex s) {
    return std::abs(s) > c.list.radius && s.real() <= c.quiet_ratio * std::norm(s) / c.quiet_above;
  };
  Growing out;
  for (const Complex s : dense.all) {
    if (s.imag() < 0) continue;
    out.surely += s.real() > dense.doubt(s) && !left_open(s);
    out.perhaps += s.real() > -dense.doubt(s);
  }
  return out;
}

/// Real negative eigenvalues of the stiffness, scaled by its diagonal: one passes zero where a root
/// does. Free motions have none of it (1e-16 by rounding).
inline Index negative_stiffnesses(Linearizer& linear, double Omega) {
  const Dense dense(linear.at(Omega), linear.active());
  std::vector<Index> held;
  for (Index k = 0; k < dense.K.rows(); ++k)
    if (dense.K(k, k) != 0.0) held.push_back(k);
  MatX K = dense.K(held, held);
  const VecX scale = K.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  K = scale.asDiagonal() * K * scale.asDiagonal();
  const VecXc values = la::eigenvalues(K);
  Index negative = 0;
  for (Index k = 0; k < values.size(); ++k)
    negative += values(k).imag() == 0.0 && values(k).real() < -1e-12;
  return negative;
}

/// As many eigenvalues of the stiffness pass zero within a ten-thousandth of the speed as divergences
/// begin or end there.
inline void compare_divergence(Linearizer& linear, const StabilityResult& r, const Onset& x,
                               const std::string& name, Compared& sum) {
  Index said = 0;
  for (const Onset& o : r.onsets)
    said +=
        o.divergence() && std::abs(o.speed - x.speed) <= 1e-4 * x.speed ? (o.gains ? 1 : -1) : 0;
  ++sum.divergences;
  const Index below = negative_stiffnesses(linear, x.speed * (1 - 1e-4)),
              above = negative_stiffnesses(linear, x.speed * (1 + 1e-4));
  EXPECT_EQ(std::abs(above - below), std::abs(said))
      << name << ", divergence at " << x.speed / rpm << " rpm";
}

/// It grows on both sides, by what cannot be told from rounding.
inline void compare_slow_growth(Linearizer& linear, const Onset& x, const std::string& name) {
  for (const double Omega : {x.speed * (1 - 1e-4), x.speed * (1 + 1e-4)}) {
    const DenseRoots dense(linear, Omega);
    const Complex root = dense.nearest(x.mode.lambda);
    EXPECT_LE(std::abs(root.real()), 10 * x.mode.rounding + dense.doubt(root))
        << name << ", slow growth at " << x.speed / rpm << " rpm";
  }
}

/// The growth is of opposite signs, a ten-thousandth of the speed on either side.
inline void compare_whirl_onset(Linearizer& linear, const Onset& x, const std::string& name,
                                Compared& sum) {
  const DenseRoots below(linear, x.speed * (1 - 1e-4)), above(linear, x.speed * (1 + 1e-4));
  const Complex a = below.nearest(Complex(0, x.frequency)),
                b = above.nearest(Complex(0, x.frequency));
  if (std::abs(a.real()) < below.doubt(a) && std::abs(b.real()) < above.doubt(b)) return;
  ++sum.onsets;
  const std::string what = fmt::format("{}, onset at {} rpm, {} rad/s: {} below, {} above", name,
                                       x.speed / rpm, x.frequency, a.real(), b.real());
  EXPECT_EQ(b.real() > a.real(), x.gains) << what;
  EXPECT_LE(std::min(a.real(), b.real()), below.doubt(a)) << what;
  EXPECT_GE(std::max(a.real(), b.real()), -below.doubt(a)) << what;
}

/// Between speeds at which all that grows is known the onsets account for what grows more and less.
/// Growth within rounding of the axis may be counted at one and not at the other.
inline void compare_onsets_to_verdicts(const StabilityResult& r, const std::string& name,
                                       Compared& sum) {
  for (std::size_t k = 1; k < r.verdicts.size(); ++k) {
    const SpeedVerdict &a = r.verdicts[k - 1], &b = r.verdicts[k];
    const bool known = a.certificate.stability_certain() && b.certificate.stability_certain();
    const bool placed = std::none_of(r.unplaced.begin(), r.unplaced.end(), [&](const Unplaced& u) {
      return u.speed > a.speed && u.speed <= b.speed;
    });
    if (!known || !placed || a.neutral != b.neutral) continue;
    Index change = 0;
    for (const Onset& x : r.onsets)
      if (x.speed > a.speed && x.speed <= b.speed)
        change += (x.gains ? 1 : -1) * (x.divergence() ? 1 : 2);
    ++sum.balances;
    EXPECT_EQ(b.growing - a.growing, change)
        << name << " from " << a.speed / rpm << " to " << b.speed / rpm << " rpm";
  }
}

/// Verdicts at some speeds, and the sign of the growth on both sides of every onset.
inline void compare_stability(Linearizer& linear, double low, double high, const std::string& name,
                              Compared& sum) {
  StabilityOptions o;
  for (int k = 0; k < 4; ++k)
    o.speeds.push_back(low + (high - low) * k / 3);
  o.modes = 6;
  o.all = true;
  const StabilityResult r = find_instability(linear, o);
  for (const SpeedVerdict& v : r.verdicts) {
    if (!v.certificate.stability_certain()) continue;
    ++sum.verdicts;
    const Growing dense = growing_roots(linear, v);
    const Index said = v.whirling + v.diverging;
    EXPECT_GE(said, dense.surely) << name << " at " << v.speed / rpm << " rpm";
    EXPECT_LE(said, dense.perhaps) << name << " at " << v.speed / rpm << " rpm";
  }
  compare_onsets_to_verdicts(r, name, sum);
  for (const Onset& x : r.onsets) {
    if (!x.begins)
      compare_slow_growth(linear, x, name);
    else if (x.divergence())
      compare_divergence(linear, r, x, name, sum);
    else
      compare_whirl_onset(linear, x, name, sum);
  }
}

/// Roots of the dense problem with the matrices of one rate.
inline std::vector<Complex> roots_at(Linearizer& linear, double Omega, Complex rate) {
  return all_roots(linear.at(Omega, rate), linear.active(), 0.37 * std::abs(rate));
}

inline Complex nearest_to(Complex s, const std::vector<Complex>& roots) {
  return *std::min_element(roots.begin(), roots.end(),
                           [s](Complex x, Complex y) { return std::abs(x - s) < std::abs(y - s); });
}

/// A root of its own matrices between two frequencies, moderately damped, if there is one: branches
/// are followed in small steps over the line Im lambda = w.
inline Complex unlisted_root(Linearizer& linear, double Omega, double from, double to) {
  constexpr int steps = 12;
  std::vector<Complex> before = roots_at(linear, Omega, Complex(0, from));
  double w = from;
  for (int k = 1; k <= steps; ++k) {
    const double next = from + (to - from) * k / steps;
    const std::vector<Complex> now = roots_at(linear, Omega, Complex(0, next));
    for (const Complex s : before) {
      if (!(s.imag() > w) || std::abs(s.real()) > 0.5 * s.imag()) continue;
      Complex root = nearest_to(s, now);
      if (!(root.imag() < next)) continue;
      for (int round = 0; round < 40; ++round)
        root = nearest_to(root, roots_at(linear, Omega, root));
      const bool own =
          std::abs(nearest_to(root, roots_at(linear, Omega, root)) - root) < 1e-8 * std::abs(root);
      if (own && root.imag() > from && root.imag() < to &&
          std::abs(root.real()) < 0.5 * root.imag())
        return root;
    }
    before = now;
    w = next;
  }
  return 0.0;
}

/// Modes of a machine whose matrices depend on the rate of the motion: each is a root of the dense
/// problem with the matrices of its own rate. The problem with the matrices of the frequency w has so
/// many roots slower than w: where the number rises between two modes listed, a branch has crossed
/// the line Im lambda = w there, and is looked for.
inline void compare_rates(Linearizer& linear, double Omega, const std::vector<WhirlMode>& modes,
                          const std::string& name, Compared& sum) {
  std::vector<double> found;
  for (const WhirlMode& m : modes) {
    if (!m.oscillates()) continue;
    found.push_back(m.frequency);
    if (m.damping_ratio > 0.9) continue;
    const double away = distance_to(m.lambda, roots_at(linear, Omega, m.lambda));
    sum.rate = std::max(sum.rate, away);
    ++sum.rates;
    // slow motions of a stiff machine are known to what rounding of its stiffness leaves
    const double near = std::max(1e-6, m.rounding / std::abs(m.lambda));
    EXPECT_LT(away, near) << name << ": " << m.lambda << " is no root of its own matrices";
  }
  for (std::size_t k = 0; k + 1 < found.size(); ++k) {
    const double from = found[k] * 1.001, to = found[k + 1] * 0.999;
    if (found[k] < 0.02 * Omega || !(to > 1.01 * from)) continue;
    const auto slower = [&](double w) {
      Index n = 0;
      for (const Complex s : roots_at(linear, Omega, Complex(0, w)))
        n += s.imag() > 0.5 * from && s.imag() < w && std::abs(s.real()) < 0.5 * s.imag();
      return n;
    };
    ++sum.lists;
    if (slower(to) <= slower(from)) continue;
    const Complex root = unlisted_root(linear, Omega, from, to);
    EXPECT_EQ(root, Complex(0.0)) << name << ": not in the list";
  }
}

inline void report(const Compared& c) {
  std::printf(
      "two methods: %d responses (to %.1e), %d critical speeds (%.1e; %d machines refused), %d "
      "equilibria (%.1e), %d "
      "decays (%.1e), %d verdicts, %d onsets, %d divergences, %d balances of onsets, %d modes by "
      "their own rate (%.1e), %d gaps of "
      "lists\n",
      c.responses, c.response, c.criticals, c.critical, c.refused, c.statics, c.place, c.decays,
      c.decay, c.verdicts, c.onsets, c.divergences, c.balances, c.rates, c.rate, c.lists);
}

}  // namespace whirl::tests
