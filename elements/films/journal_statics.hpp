// A journal bearing on its own: equilibrium under a load, the eight coefficients there, and the
// stability of a rigid or a single-mass flexible rotor on it. What design charts show; the full
// model does not need any of it.
//
// The film is any function of (r, v, spin): the law of a LateralJoint with the housing at rest.
// Coefficients are minus the derivatives of the film force: K = -dF/dr (with the spin's part of
// it), C = -dF/dv, rows and columns (y, z).
#pragma once
#include <elements/supports/lateral_joint.hpp>
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

}  // namespace whirl::elements
