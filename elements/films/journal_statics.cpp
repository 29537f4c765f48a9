#include <elements/films/journal_statics.hpp>

#include <core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

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

Vec2 solve2(const Mat2& A, const Vec2& b) {
  const double det = A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0);
  return Vec2(A(1, 1) * b.x() - A(0, 1) * b.y(), A(0, 0) * b.y() - A(1, 0) * b.x()) / det;
}

/// Newton on F(r) + load = 0 from r; halved until the film exists and the imbalance falls. True
/// when it converged.
bool newton(Balance& b, const Vec2& load, double size, double limit, Vec2& r) {
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

}  // namespace

JournalEquilibrium find_journal_equilibrium(const FilmFunction& film, const Vec2& load, double spin,
                                            double clearance, const EquilibriumOptions& options) {
  Balance b{film, spin, {}, {}, {}};
  const double W = load.norm(), limit = options.max_eccentricity * clearance;
  const Vec2 along = W > 0.0 ? Vec2(load / W) : Vec2::Zero();
  const double turn = spin < 0.0 ? -1.0 : 1.0;
  const auto place = [&](double ecc, double attitude) {
    const double c = std::cos(turn * attitude), s = std::sin(turn * attitude);
    return Vec2(ecc * clearance *
                Vec2(c * along.x() - s * along.y(), s * along.x() + c * along.y()));
  };
  Vec2 r = Vec2::Zero();
  bool found = W == 0.0 && newton(b, load, 1.0, limit, r);
  // Starts near typical loci first; then the load is led from what the film carries at the start to
  // the load asked for.
  for (double ecc : {0.3, 0.6, 0.8, 0.1, 0.9, 0.95, 0.99, 0.01}) {
    if (found || W == 0.0) break;
    r = place(ecc, std::acos(std::min(1.0, ecc)));
    found = newton(b, load, W, limit, r);
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
        if (newton(b, (1.0 - next) * start + next * load, size, limit, trial)) {
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

WhirlThreshold whirl_threshold(const Mat2& K, const Mat2& C) {
  WhirlThreshold w;
  w.k_eq = (K(0, 0) * C(1, 1) + K(1, 1) * C(0, 0) - K(0, 1) * C(1, 0) - K(1, 0) * C(0, 1)) /
           (C(0, 0) + C(1, 1));
  w.omega2 = ((K(0, 0) - w.k_eq) * (K(1, 1) - w.k_eq) - K(0, 1) * K(1, 0)) /
             (C(0, 0) * C(1, 1) - C(0, 1) * C(1, 0));
  return w;
}

WhirlOnset find_whirl_onset(const FilmFunction& film, const Vec2& load, double mass,
                            double clearance, double low, double high, double shaft_stiffness,
                            int points, const EquilibriumOptions& options) {
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
