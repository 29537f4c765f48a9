// Short plain journal bearing (Ocvirk): nonlinear in displacement and velocity, pi film.
//
// Axial pressure flow only: p = 6 eta (w.n)/h^3 (L^2/4 - z^2), h = c - r.n, kept where positive
// (half Sommerfeld: exactly the half circle w.n > 0). The force is
//   F = -eta R L^3 A w,  A = int_{w.n>0} n n^T / h^3 dtheta,
// symmetric and positive: F.w <= 0 always, dF/dw = -eta R L^3 A (the ends of the half circle do not
// contribute). In the axes (w/|w|, J w/|w|) with a, b the components of r/c the integrals are
// derivatives of
//   G(a, b) = int_{-pi/2}^{pi/2} dpsi/(1 - a cos psi - b sin psi) = 2/q [atan((1+a-b)/q) +
//       atan((1+a+b)/q)], q^2 = 1-a^2-b^2,
// 1/2 G_jk for h^-3 and 1/6 G_jkl for h^-4, which follow from (1-a^2-b^2) G_a = 2 + a G and its b
// counterpart. No case distinction on signs is needed anywhere. Equivalent to Capone's form, La
// Houille Blanche 41 (1986), and to Ocvirk's equilibrium NACA TN 2808 (1953). Shear torque of the
// full film: T = -2 pi eta R^3 L s/(c q).
//
// Limits: L/D <= 0.5 for eccentricity to 0.7 (the usual rule); isoviscous, laminar; no supply
// pressure; misalignment ignored. Relative accuracy of F better than 1e-9 up to an eccentricity of
// 0.9999. At w = 0 exactly F = 0 and dF/dw is the mean over the directions of w (the one-sided ones
// differ there).
#pragma once
#include <elements/films/film.hpp>

namespace whirl::elements {

struct ShortJournal {
  double radius = 0;     ///< R, m
  double length = 0;     ///< L, m
  double clearance = 0;  ///< c, radial, m
  double viscosity = 0;  ///< eta, Pa s

  void evaluate(const FilmPoint& p, FilmForce& f) const;
  void evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const;
};

using ShortJournalBearing = LateralJoint<FilmLaw<ShortJournal>>;

/// The half-circle integral G(a, b) with its derivatives to third order (a^2 + b^2 < 1).
struct HalfFilmIntegral {
  double G, a, b, aa, ab, bb, aaa, aab, abb, bbb;
  HalfFilmIntegral(double x, double y);
};

}  // namespace whirl::elements
