// Tilting-pad journal bearing: a pad that tilts about its pivot, and gives there.
//
// A pad is a stretch of a circle of its own (finite_journal.hpp with one pad: clearance c_p, tightest
// at the pivot by the preload). To the first order in its tilt, a pad that turns by delta (about +x,
// y -> z) about a pivot in the direction n at the distance arm from its centre of curvature, and is
// pressed outwards by xi, moves that centre by
//   a = -arm delta t + xi n,   t = J n (a quarter turn y -> z),
// and its film is that of a journal at r_p = r - a with r_p' = r' - a'. What the film does to the
// journal, z = (F, T_0, T_1) of film.hpp at (r_p, r_p'), it takes from the pad: virtual work
// F.(dr - da). Left sides of the pad's own unknowns:
//   F.da/ddelta + k_t delta + c_t delta' + I delta''   (N m)
//   F.n + k_p xi^n + c_p xi' + m xi''                   (N)
// n = 1: a pivot that is elastic both ways; 3/2: a ball in its seat, 10/9: a line of contact (Hertz,
// Palmgren: elements/rolling/hertz.hpp), which take nothing where they are not pressed (xi < 0) but for a
// rest spring.
// so a pad at rest turns until the resultant of its pressure passes through the pivot, and the pivot
// gives by -F.n/k_p. Power: the film turns -(F.w + T s) at r_p into heat (film.hpp), pads lose
// c_t delta'^2 + c_p xi'^2.
//
// A pad that the journal has left carries nothing whatever its tilt, as long as its film diverges.
// Nothing would say where it stands: every pad therefore has a soft spring against turning, 1e-6 of
// what its film resists in a second, which lays it against the edge of the range in which it carries
// nothing (with some 1e-8 of the bearing's load), and a damper of 1e-5 of its film's own, as the oil
// about it has, so that a pad with inertia does not coast.
//
// Axial profile: one parabola along z underestimates what a long pad carries. The film here has the
// profile p = P(theta) (1 - cosh(2 kappa z/L)/cosh kappa), with which Galerkin's method in z gives
// the equation of finite_journal.hpp with other factors (AxialProfile). kappa by alternating between
// the profiles along z and theta for a uniform film (extended Kantorovich method: A. D. Kerr, Q.
// Appl. Math. 26, 1968, doi 10.1090/qam/99857), times 1.15 for the wedge of a pad at work, whose
// pressure stands on a part of the arc. kappa -> 0 is the parabola.
//
// Limits: aligned; no inertia of the oil; shear on the pad's
// face has no moment about the pivot; tilts are small (arm delta against the radius). The mass of a
// pad counts for its motion along the pivot against the housing.
// Source: J. W. Lund, ASLE Trans. 7, 1964, doi 10.1080/05698196408972064 (pad assembly).
#pragma once
#include <elements/films/finite_journal.hpp>

namespace whirl::elements {

/// Factors of (h^3 P')'/R^2 - leakage/L^2 h^3 P = source eta f for the axial mean P.
struct AxialProfile {
  double leakage = 10, source = 10;
  double peak = 1.5;  ///< pressure in the middle over the axial mean
};
/// The profile 1 - cosh(2 kappa z/L)/cosh kappa. @pre kappa >= 0.
AxialProfile axial_profile(double kappa);
/// That of a pad of an arc (rad) and a length over the radius.
/// @pre both positive.
AxialProfile axial_profile_of_pad(double arc, double length_over_radius);

/// What a pad is made from, SI.
struct PadGeometry {
  double radius = 0, length = 0, viscosity = 0;  ///< m, m, Pa s
  double clearance = 0;                          ///< as assembled, c_b, m
  double preload = 0;                            ///< 1 - c_b/c_p
  double pivot = 0, arc = 0;                     ///< rad, from +y towards +z
  double offset = 0.5;                           ///< (pivot - start)/arc
  double thickness = 0;                          ///< of the pad at the pivot, m
  int points = 16;                               ///< of the grid on this pad
};

/// How a pad stands.
struct PadStanding {
  double tilt = 0, pressed = 0;  ///< delta, rad; xi, m
  Vec2 force = Vec2::Zero();     ///< of the film on the pad, N
  double load = 0;               ///< along the pivot, outwards, N
  double film = 0;               ///< smallest thickness, m
  double eccentricity = 0;       ///< of the journal towards the pivot over c_b: 1 at contact there
  double power = 0;              ///< that the film turns into heat, W
};

struct TiltingPad {
  FiniteJournal film;
  Vec2 pivot = Vec2::UnitX();                   ///< n
  double arm = 0;                               ///< m
  double inertia = 0;                           ///< I about the pivot, kg m2
  double tilt_stiffness = 0, tilt_damping = 0;  ///< k_t N m/rad, c_t N m s/rad
  double mass = 0, pivot_damping = 0;           ///< m kg, c_p N s/m
  /// k_p N/m^n and n: the pivot takes k_p xi^n. n > 1, a contact: nothing where it is not pressed.
  double pivot_stiffness = 0, pivot_exponent = 1;
  double pivot_rest = 0;  ///< N/m, beside a contact: where a pad that carries nothing stands

  /// What the pivot takes at a compression, N, its slope, N/m, and what it stores, J.
  double pivot_force(double by) const;
  double pivot_slope(double by) const;
  double pivot_energy(double by) const;

  Vec2 across() const { return Vec2(-pivot.y(), pivot.x()); }
  /// da/ddelta (0) and da/dxi (1).
  Vec2 direction(int coordinate) const { return coordinate == 0 ? Vec2(-arm * across()) : pivot; }
  /// The motion of the journal against the centre of the pad.
  LateralMotion seen(LateralMotion m, const Vec2& q, const Vec2& rate) const;
  /// q: (tilt, pressed).
  PadStanding standing(const LateralMotion& m, const Vec2& q) const;
  /// The tilt at which a journal at rest leaves the pad in balance on a rigid pivot, rad. NaN: there
  /// is none, the pad turns until it touches.
  double settled_tilt(const LateralMotion& m) const;
  /// All tilts in stable balance there, rad, ascending: a lightly loaded pad may carry, or rest where
  /// its film begins.
  std::vector<double> balances(const LateralMotion& m) const;
  /// Tilt and compression of an elastic pivot in balance; NaN: there are none.
  Vec2 settled(const LateralMotion& m) const;

 private:
  /// The least and the largest tilt, rad, at which an edge of the pad touches a journal at rest; NaN:
  /// it touches at all.
  Vec2 touching_tilts(const LateralMotion& m) const;
  /// Moment about a rigid pivot that turns the pad back, N m: it grows through zero in stable balance.
  double righting_moment(const LateralMotion& m, double tilt) const;
};

/// With the rest spring and damper.
/// @throws Error E84: clearance, preload, arc, offset or dimensions that make no pad.
TiltingPad make_tilting_pad(const PadGeometry& g);

/// One pad between journal and housing. Nodes: 0 journal, 1 housing, 2 (scalar) tilt in rad, and
/// where the pivot gives 3 (scalar) its compression in m.
template <bool Pressed, bool Offsets = false>
struct TiltingPadJoint {
  static constexpr int n_nodes = Pressed ? 4 : 3, width = 7, size = 7 * n_nodes;
  static constexpr int own = n_nodes - 2;  ///< unknowns of the pad
  static constexpr system::Axes axes = Offsets ? system::Axes::own : system::Axes::any;
  static constexpr bool has_M = true, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  /// Inertia sees a common acceleration of all nodes, of which gravity gives the scalars nothing.
  system::Dependence depends(const system::Context&) const {
    return {.spin = true, .weight = pad.inertia != 0 || (Pressed && pad.mass != 0)};
  }
  using Nodes = system::Nodes<n_nodes>;

  TiltingPad pad;
  std::array<double, 2> offset{0.0, 0.0};  ///< of journal and housing, m

  void add_force(const Nodes& x, const system::Context& c, system::ForceX<size>& f) const;
  void add_tangent(const Nodes& x, const system::Context& c, system::TangentX<size>& t) const;
  void add_energy(const Nodes& x, const system::Context& c, system::Energy& e) const;
  /// The pad in balance with the journal where it is, at rest.
  void relax(const Nodes& x, const system::Context& c, std::array<double, own>& q) const;
  /// Journal against housing, and the pad's own unknowns (tilt, pressed) with their rates.
  struct Motion {
    LateralMotion journal;
    Vec2 q, rate;
  };
  Motion motion_of(const Nodes& x, const system::Context& c) const;

 private:
  using Link = LateralLink<Offsets>;
  static system::Nodes<2> ends(const Nodes& x) { return {x[0], x[1]}; }
};

extern template struct TiltingPadJoint<false, false>;
extern template struct TiltingPadJoint<false, true>;
extern template struct TiltingPadJoint<true, false>;
extern template struct TiltingPadJoint<true, true>;

/// Linearised pads of one bearing: force on the shaft and on the pads' own unknowns for motions in
/// the order (y, z, tilt 1, [pressed 1,] tilt 2, ...): K x + C x' + M x'' on the left side. N, N m;
/// m, rad; s. Pads on rigid pivots have no compression.
struct PadCoefficients {
  MatX K, C, M;
};
/// What the shaft sees at the frequency w, rad/s, with the pads following: Z(w) = K + i w C of 2x2.
struct ReducedCoefficients {
  Mat2 K = Mat2::Zero(), C = Mat2::Zero();
};
/// The Schur complement of the pads in K - w^2 M + i w C; w = 0: its limit.
ReducedCoefficients reduce_pads(const PadCoefficients& full, double w);

}  // namespace whirl::elements
