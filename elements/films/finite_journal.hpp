// Journal bearing of finite length: plain, with axial grooves, or multi-lobe; nonlinear in
// displacement and velocity.
//
// Reynolds with the axial pressure profile p = 3/2 P(theta) (1 - (2z/L)^2) (Galerkin in z; P: axial
// mean, Pa):
//   (h^3 P')'/R^2 - 10/L^2 h^3 P = 10 eta f,   f = -w.n + (s/2) h0',   h = h0(theta) - r.n
// and Swift-Stieber (Reynolds) cavitation P >= 0. Grooves hold P = 0 (ambient; a supply pressure is
// neglected against film pressures). Seen from its own centre every pad is a circle with a single
// wave of f, so a pad's load is a function of two vectors, solved by elements.pad_film. No grid is
// fixed in space: forces are smooth in position, velocity and load.
//
// Pads: h0 = c_p - (c_p - c_b) cos(theta - theta_k); c_p: pad clearance (radius of the pad less
// that of the journal), c_b: assembled clearance, theta_k where the film of a centred journal is
// thinnest; preload m = 1 - c_b/c_p. Angles from +y towards +z. At w = 0 a cylinder carries
// nothing, and its force is homogeneous in w with another derivative in each direction (a film that
// cavitates). The tangent there is the linear law nearest to it in all directions, C = 1/pi int
// F(n) n^T dphi: of a short film the half of the full one. Torque: shear of a full film between the
// grooves, -eta R^3 L s int dtheta/h, and the pressure on lobes, R/2 int p h0'.
//
// Error against a two-dimensional Reynolds solution (test
// FiniteJournal.AgainstTwoDimensionalReynolds), from the axial profile and the rupture line, which
// is straight across the bearing: below 2 % of the force for L/D <= 0.5, or L/D <= 1 with
// eccentricities to 0.6; 3 % at L/D = 1 and 0.9. Grid: force within 1e-3 and coefficients within
// 2e-3 of the converged ones at the default of 72 points, to an eccentricity of 0.9, most within
// 1e-4 (test CoefficientsAreConverged). About 3 us a force and 5 us a tangent on one core. Limits:
// no inertia, aligned.
//
// Beyond isoviscous laminar oil at ambient pressure (PadMedium):
//   turbulence by the local Reynolds number rho R |s| h/eta (turbulence.hpp);
//   supply_pressure p_s at the ends of every pad, which also stands in the grooves and behind pads
//     that tilt: a pad gives int (P - p_s) n R L dtheta, so that a closed ring at p_s gives nothing.
//     What the pump does is p_s times the flow that it drives, FilmForce::pump;
//   mass_conserving: what leaves a film where it ruptures is carried on, and the next one forms where
//     that fills the gap (Jakobsson, Floberg, Olsson; pad_film.hpp); the leading groove is full.
//     Conserved is the mean over the length that the axial profile weighs, as Galerkin's equation has
//     it (another one would let films part with a jump): Q = L R s content/2 in ruptured film, and in
//     the film behind it Q = L (R s h/2 - (12/source) h^3 P'/(12 eta R)), which at its sides loses
//     just what the slope of the profile gives. Drag of ruptured film: the share content/h of the
//     width. In motion fronts and content are those of the momentary state: exact at rest; of small
//     motions, where no film lies behind a ruptured one (a rupture has P' = 0 as long as it moves
//     slower than the oil, R s/2); behind one it leaves out the time the oil takes to it and what a
//     moving front swallows;
//   a viscosity that varies along each pad, and clearances that grow, by what the film keeps of the
//     last equilibrium (film_heat.hpp). Both are constants to force and tangent.
// Recesses (tapers, pockets of pressure dams, relief tracks), and any shape where no profile along the
// axis is to be assumed: on a grid in both directions (grid_film.hpp), some hundred times dearer.
// Sources: Reynolds equation Szeri 2011, doi 10.1017/CBO9780511782022; published coefficients Lund
// & Thomsen, ASME 1978 (Topics in Fluid Film Bearing and Rotor Bearing System Design and
// Optimization, pp. 1-28).
#pragma once
#include <elements/films/film.hpp>
#include <elements/films/grid_film.hpp>
#include <elements/films/pad_film.hpp>
#include <memory>
#include <vector>

namespace whirl::elements {

/// One pad: a stretch of bearing surface between two grooves.
struct JournalPad {
  double start = 0, end = 0;  ///< rad, end > start, at most start + 2 pi
  double thinnest = 0;        ///< theta_k, rad
};

/// Shape of the bearing surface; shared by all copies of a kernel.
class JournalSurface {
 public:
  static constexpr int max_nodes = 360;
  /// clearance: assembled c_b, m; preload m in [0, 1): c_p = c_b/(1 - m). nodes: grid points over
  /// all pads; no pads: one uninterrupted cylinder.
  /// @throws Error E84: no clearance, preload outside [0, 1), pads that overlap or are empty, too
  /// many or too few nodes.
  JournalSurface(double clearance, double preload, const std::vector<JournalPad>& pads,
                 int nodes = 72);

  /// A pad seen from its centre, which is `lift` to the side of `thinnest` from that of the
  /// bearing.
  struct Arc {
    double start, length;
    bool round;
    Vec2 thinnest;
    double points;
  };
  const std::vector<Arc>& arcs() const { return arcs_; }
  double pad_clearance() const { return clearance_ + lift_; }  ///< c_p, m
  double lift() const { return lift_; }                        ///< c_p - c_b, m
  double clearance() const { return clearance_; }

 private:
  double clearance_, lift_;
  std::vector<Arc> arcs_;
};

/// Two pads between axial grooves of `groove` rad at theta = groove_at and opposite (the usual
/// split bearing).
/// @pre 0 <= groove < pi.
std::vector<JournalPad> two_groove_pads(double groove_at, double groove);
/// n equal lobes, the first centred at theta = first; grooves of `groove` rad between them; offset:
/// (theta_k - start)/(arc) (0.5: centred).
/// @pre n > 0; the grooves leave something of the circle.
std::vector<JournalPad> lobe_pads(int n, double first, double groove, double offset = 0.5);

struct FiniteJournal {
  double radius = 0;     ///< R, m
  double length = 0;     ///< L, m
  double viscosity = 0;  ///< eta, Pa s
  std::shared_ptr<const JournalSurface> surface;
  /// One a pad where the pressure is found on a grid along the axis too, which recesses need
  /// (grid_film.hpp); null: the axial profile.
  std::shared_ptr<const std::vector<GridPad>> grid{};
  /// Coarser ones for the many solutions that the linear law of a journal at rest is the mean of; null:
  /// the grid itself.
  std::shared_ptr<const std::vector<GridPad>> grid_at_rest{};
  /// Axial profile: leakage/L^2 is the outflow term and `source` eta the source of (h^3 P')'/R^2 -
  /// leakage/L^2 h^3 P = source eta f.
  double leakage = 10, source = 10;
  /// Sealed ends (squeeze-film dampers with piston rings or O-rings): uniform along the axis, flow
  /// round the circumference only. Needs a groove (feed): without one nothing fixes the level of
  /// the pressure.
  void seal_ends() {
    leakage = 0;
    source = 12;
    peak = 1;
  }

  double peak = 1.5;             ///< pressure in the middle over the axial mean
  double turbulent_density = 0;  ///< kg/m3; 0: laminar
  double supply_pressure = 0;    ///< above ambient, Pa
  bool mass_conserving = false;  ///< ruptured film carries on what oil there is; needs grooves
  /// Of what elements keep, where a film with heat begins; -1: it has none. For each pad the growth
  /// of the assembled clearance c_b and that of c_p, both over c_b, then ln(eta/viscosity) at
  /// `knots` equidistant places from its start to its end.
  std::ptrdiff_t kept_from = -1;
  bool alike = false;  ///< one viscosity whatever is kept
  int knots = 0;
  static constexpr int kept_growths = 2;  ///< before the knots
  int kept_each() const { return knots + kept_growths; }
  bool isoviscous() const {
    return turbulent_density == 0.0 && supply_pressure == 0.0 && kept_from < 0 && !mass_conserving;
  }

  void evaluate(const FilmPoint& p, FilmForce& f) const;
  void evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const;

  /// Film where it is thinnest, m; negative: the journal is outside.
  double least_film(const FilmPoint& p) const;

  /// The clearances of pad k as they are: c_p and c_p - c_b, m.
  struct Gap {
    double pad, lift;
  };
  Gap gap(std::size_t k, const FilmPoint& p) const;
  /// Its oil, in the units of PadFilm; refers to p.kept.
  PadMedium medium(std::size_t k, const FilmPoint& p) const;
  /// Pa for PadFilm's unit of pressure.
  double pressure_unit(const Gap& g) const;

  /// The film of pad k in its own terms, at its displacement e and source W (in m/s).
  /// @pre k below surface->arcs().size(); radius and length positive.
  PadFilm pad(std::size_t k) const;
  struct PadPlace {
    Vec2 e, W;
  };
  PadPlace place(std::size_t k, const FilmPoint& p) const;
  /// The film of pad k on its grid. @pre grid.
  GridDrive drive(std::size_t k, const FilmPoint& p) const;
  /// Whether the journal is clear of every pad.
  bool inside(const FilmPoint& p) const;

 private:
  void evaluate_through(const FilmPoint& p, FilmForce& f) const;
  bool carries_oil(std::size_t k, const FilmPoint& p) const;
  void add_carried(std::size_t k, const FilmPoint& p, FilmForce& f, FilmTangent& t) const;
  void evaluate_through(const FilmPoint& p, FilmForce& f, FilmTangent& t) const;
  void evaluate_on_grid(const FilmPoint& p, FilmForce& f) const;
  void evaluate_on_grid(const FilmPoint& p, FilmForce& f, FilmTangent& t) const;
};

using FiniteJournalBearing = LateralJoint<FilmLaw<FiniteJournal>>;

}  // namespace whirl::elements
