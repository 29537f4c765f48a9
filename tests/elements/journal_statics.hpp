// A journal bearing on its own: equilibrium under a load, the eight coefficients there, and the
// stability of a rigid or a single-mass flexible rotor on it. What design charts show; the full
// model does not need any of it.
//
// The film is any function of (r, v, spin): the law of a LateralJoint with the housing at rest.
// Coefficients are minus the derivatives of the film force: K = -dF/dr (with the spin's part of
// it), C = -dF/dv, rows and columns (y, z).
#pragma once
#include <core/error.hpp>
#include <elements/supports/lateral_joint.hpp>
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace whirl::elements {

/// Film force on the journal with its derivatives; NaN outside the film's domain.
using FilmFunction = std::function<void(const LateralMotion&, Vector<4>&, LateralTangent&)>;

template <class Law>
FilmFunction film_function(Law law) {
  return [law](const LateralMotion& m, Vector<4>& z, LateralTangent& t) { law.tangent(m, z, t); };
}

struct JournalEquilibrium {
  Vec2 r;                   ///< journal position, m
  double eccentricity = 0;  ///< |r|/clearance
  double attitude = 0;      ///< angle from the load to r, positive in the sense of rotation, rad
  Mat2 K, C;                ///< N/m, N s/m
  double torque = 0;        ///< on the journal, N m (negative: drag)
};

struct EquilibriumOptions {
  double max_eccentricity = 0.999;  ///< beyond this the film is not believed
  std::string name = "bearing";     ///< for messages
};

/// Solves F(r, 0, spin) + load = 0. load: force on the journal from outside, N. clearance: length
/// scale of the film, m. Throws E87 when there is none below max_eccentricity; the message has
/// load, capacity and eccentricity reached.
JournalEquilibrium find_journal_equilibrium(const FilmFunction& film, const Vec2& load, double spin,
                                            double clearance,
                                            const EquilibriumOptions& options = {});

/// Stability of a mass carried by K, C (cross-coupled): the pure whirl that is neither damped nor
/// driven.
///   k_eq = (Kyy Czz + Kzz Cyy - Kyz Czy - Kzy Cyz)/(Cyy + Czz),
///   omega^2 = ((Kyy-k_eq)(Kzz-k_eq) - Kyz Kzy)/(Cyy Czz - Cyz Czy)
/// (Lund, ASME J. Appl. Mech. 1965, doi 10.1115/1.3627324, written for two planes). omega2 <= 0:
/// stable for every mass.
struct WhirlThreshold {
  double k_eq = 0;    ///< N/m
  double omega2 = 0;  ///< whirl frequency squared, rad2/s2
  /// Largest stable mass per bearing, kg; infinite when omega2 <= 0.
  double critical_mass() const { return omega2 > 0.0 ? k_eq / omega2 : infinity; }
};
WhirlThreshold whirl_threshold(const Mat2& K, const Mat2& C);

struct WhirlOnset {
  double speed = 0, whirl = 0;  ///< rad/s
  JournalEquilibrium at;
};

/// Lowest spin in [low, high] at which a symmetric rotor loses stability: mass per bearing on a
/// shaft of stiffness per bearing shaft_stiffness (infinite: rigid rotor), the load held. Throws
/// E87 when some speed has no equilibrium; speed = infinity when the rotor is stable throughout.
/// The range is scanned in `points` steps, then bisected to 1e-12.
WhirlOnset find_whirl_onset(const FilmFunction& film, const Vec2& load, double mass,
                            double clearance, double low, double high,
                            double shaft_stiffness = infinity, int points = 200,
                            const EquilibriumOptions& options = {});

namespace journal_detail {

struct Balance {
  const FilmFunction& film;
  double spin;
  Vec2 F;
  Mat2 F_r, F_v;
  double torque = 0;

  bool at(const Vec2& r) {
    LateralMotion m;
    m.r = r;
    m.v.setZero();
    m.a.setZero();
    m.spin = spin;
    Vector<4> z;
    LateralTangent t;
    film(m, z, t);
    F = z.head<2>();
    torque = z[2];
    F_r = t.r.topRows<2>();
    F_v = t.v.topRows<2>();
    return F.allFinite() && F_r.allFinite();
  }
};

inline Vec2 solve2(const Mat2& A, const Vec2& b) {
  const double det = A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0);
  return Vec2(A(1, 1) * b.x() - A(0, 1) * b.y(), A(0, 0) * b.y() - A(1, 0) * b.x()) / det;
}

/// Newton on F(r) + load = 0 from r; halved until the film exists and the imbalance falls. True
/// when it converged.
inline bool newton(Balance& b, const Vec2& load, double size, double limit, Vec2& r) {
  if (!b.at(r)) return false;
  Vec2 g = b.F + load;
  for (int it = 0; it < 60; ++it) {
    // 1e-13: rounding of the film integrals is a few 1e-15 of the load
    if (g.norm() <= 1e-13 * size) return true;
    const Vec2 step = solve2(b.F_r, -g);
    if (!step.allFinite()) return false;
    double lambda = 1.0;
    Vec2 trial;
    for (;; lambda *= 0.5) {
      if (lambda < 1e-10) return g.norm() <= 1e-9 * size;
      trial = r + lambda * step;
      if (trial.norm() < limit && b.at(trial) &&
          (b.F + load).norm() < (1.0 - 1e-4 * lambda) * g.norm())
        break;
    }
    r = trial;
    g = b.F + load;
  }
  return false;
}

}  // namespace journal_detail

inline JournalEquilibrium find_journal_equilibrium(const FilmFunction& film, const Vec2& load,
                                                   double spin, double clearance,
                                                   const EquilibriumOptions& options) {
  journal_detail::Balance b{film, spin, {}, {}, {}};
  const double W = load.norm(), limit = options.max_eccentricity * clearance;
  const Vec2 along = W > 0.0 ? Vec2(load / W) : Vec2::Zero();
  const double turn = spin < 0.0 ? -1.0 : 1.0;
  const auto place = [&](double ecc, double attitude) {
    const double c = std::cos(turn * attitude), s = std::sin(turn * attitude);
    return Vec2(ecc * clearance *
                Vec2(c * along.x() - s * along.y(), s * along.x() + c * along.y()));
  };
  Vec2 r = Vec2::Zero();
  bool found = W == 0.0 && journal_detail::newton(b, load, 1.0, limit, r);
  // Starts near typical loci first; then the load is led from what the film carries at the start to
  // the load asked for.
  for (double ecc : {0.3, 0.6, 0.8, 0.1, 0.9, 0.95, 0.99, 0.01}) {
    if (found || W == 0.0) break;
    r = place(ecc, std::acos(std::min(1.0, ecc)));
    found = journal_detail::newton(b, load, W, limit, r);
  }
  double reached = 0.0;
  if (!found && W > 0.0) {
    r = place(0.5, 1.0);
    if (b.at(r) && b.F.norm() > 0.0) {
      const Vec2 start = -b.F;
      const double size = std::max(W, start.norm());
      double done = 0.0, step = 0.1;
      while (done < 1.0 && step > 1e-6) {
        const double next = std::min(1.0, done + step);
        Vec2 trial = r;
        if (journal_detail::newton(b, (1.0 - next) * start + next * load, size, limit, trial)) {
          r = trial;
          done = next;
          step *= 1.6;
        } else
          step *= 0.4;
      }
      found = done >= 1.0;
      reached = r.norm() / clearance;
    }
  }
  if (!found) {
    // Capacity: the largest force the film gives near max_eccentricity, over all directions.
    double capacity = 0.0;
    for (int k = 0; k < 72; ++k) {
      const double a = two_pi * k / 72;
      if (b.at(0.999 * limit * Vec2(std::cos(a), std::sin(a))))
        capacity = std::max(capacity, b.F.norm());
    }
    throw run_error(
        "E87",
        fmt::format("no equilibrium: load {:.6g} N at {:.6g} rad/s; the film carries at most "
                    "{:.6g} N at eccentricity {:.4g}; "
                    "reached eccentricity {:.4g}",
                    W, spin, capacity, 0.999 * options.max_eccentricity, reached),
        spin == 0.0 ? "a hydrodynamic film carries nothing at rest: give a speed"
                    : "raise speed, viscosity or length, reduce the clearance, or check the load",
        options.name);
  }
  b.at(r);
  JournalEquilibrium e;
  e.r = r;
  e.eccentricity = r.norm() / clearance;
  if (W > 0.0) e.attitude = turn * std::atan2(load.x() * r.y() - load.y() * r.x(), load.dot(r));
  e.K = -b.F_r;
  e.C = -b.F_v;
  e.torque = b.torque;
  return e;
}

inline WhirlThreshold whirl_threshold(const Mat2& K, const Mat2& C) {
  WhirlThreshold w;
  w.k_eq = (K(0, 0) * C(1, 1) + K(1, 1) * C(0, 0) - K(0, 1) * C(1, 0) - K(1, 0) * C(0, 1)) /
           (C(0, 0) + C(1, 1));
  w.omega2 = ((K(0, 0) - w.k_eq) * (K(1, 1) - w.k_eq) - K(0, 1) * K(1, 0)) /
             (C(0, 0) * C(1, 1) - C(0, 1) * C(1, 0));
  return w;
}

inline WhirlOnset find_whirl_onset(const FilmFunction& film, const Vec2& load, double mass,
                                   double clearance, double low, double high,
                                   double shaft_stiffness, int points,
                                   const EquilibriumOptions& options) {
  WhirlOnset out;
  double whirl = 0.0;
  // At the threshold the journal sees k_eq; journal and shaft in series carry the mass: omega^2 m =
  // k_eq ks/(k_eq + ks). Positive: unstable.
  const auto excess = [&](double spin) {
    out.at = find_journal_equilibrium(film, load, spin, clearance, options);
    const WhirlThreshold t = whirl_threshold(out.at.K, out.at.C);
    const double k = std::isinf(shaft_stiffness)
                         ? t.k_eq
                         : t.k_eq * shaft_stiffness / (t.k_eq + shaft_stiffness);
    whirl = std::sqrt(std::max(0.0, k / mass));
    return t.omega2 - k / mass;
  };
  double a = low;
  if (excess(a) > 0.0) {
    out.speed = low;
    out.whirl = whirl;
    return out;
  }
  for (int i = 1; i <= points; ++i) {
    double b = low * std::pow(high / low, static_cast<double>(i) / points);
    if (excess(b) <= 0.0) {
      a = b;
      continue;
    }
    while (b - a > 1e-12 * b) {
      const double m = 0.5 * (a + b);
      if (m == a || m == b) break;
      (excess(m) > 0.0 ? b : a) = m;
    }
    excess(b);
    out.speed = b;
    out.whirl = whirl;
    return out;
  }
  out.speed = out.whirl = infinity;
  return out;
}

}  // namespace whirl::elements
