// Kinematic state of a node as the elements see it: extended coordinates X = (u, d, phi).
//
// The unknowns are q = (u, phi, gamma); elements never see gamma. They are written in the director
// d(gamma), its offset t = d - e from the chart axis (kept separately, so that a tilt of 1e-12 rad
// keeps its digits), and phi. The system converts forces and tangents once per node with the
// Jacobian J = dX/dq:
//   r_q = J^T f_X,   M_q = J^T M J,   C_q = J^T (C J + 2 M J'),
//       K_q = J^T (K J + C J' + M J'') + f_d . d2d/dgamma2
// with J' = d(Xdot)/dq and J'' = d(Xddot)/dq. Any smooth extension of an element's force off |d| =
// 1 gives the same result, because J maps to the tangent space of the sphere.
#pragma once
#include <core/single.hpp>
#include <core/types.hpp>
#include <system/node_places.hpp>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

namespace whirl::system {

namespace of_one {
using namespace single;
#define WHIRL_INLINE inline
#include <system/spin.inl>
#undef WHIRL_INLINE
}  // namespace of_one

struct NodeState {
  Vec3 u, du;    ///< displacement from the reference position, m, and its rate, m/s (global axes)
  Vec3 ddu;      ///< acceleration relative to free fall, u'' - g(t), m/s^2: gravity and base motion
                 ///< enter every inertia here
  Vec3 t;        ///< d - e, exact for small tilt
  Vec3 dd, ddd;  ///< d', d''
  double phi = 0.0, dphi = 0.0,
         ddphi = 0.0;            ///< axial angle (less the whole turns), rad, and rates
  double turns = 0.0;            ///< whole turns taken out of phi
  const Mat3* chart = nullptr;   ///< columns e, e2, e3: the chart triad, in global axes
  const double* kept = nullptr;  ///< all that elements keep (Frames::kept), the same for every node

  Vec3 e() const { return chart->col(0); }
  Vec3 d() const { return chart->col(0) + t; }
  /// w with s = phi' - w . d': w = (e x d)/(1 + e.d)   (paper eq. (11) with d' = omega x d)
  Vec3 spin_form() const { return of_one::spin_form(e(), t, of_one::spin_divisor(e(), t)); }
  /// Spin rate about the section's own normal, s = omega . d, rad/s.
  double spin() const { return dphi - spin_form().dot(dd); }
  /// Whole angular velocity, d x d' + s d, rad/s.
  Vec3 omega() const { return d().cross(dd) + spin() * d(); }
};

static_assert(offsetof(NodeState, u) == NodePlaces::u * sizeof(double));
static_assert(offsetof(NodeState, du) == NodePlaces::du * sizeof(double));
static_assert(offsetof(NodeState, ddu) == NodePlaces::ddu * sizeof(double));
static_assert(offsetof(NodeState, t) == NodePlaces::t * sizeof(double));
static_assert(offsetof(NodeState, dd) == NodePlaces::dd * sizeof(double));
static_assert(offsetof(NodeState, ddd) == NodePlaces::ddd * sizeof(double));
static_assert(offsetof(NodeState, phi) == NodePlaces::phi * sizeof(double));
static_assert(offsetof(NodeState, dphi) == NodePlaces::dphi * sizeof(double));
static_assert(offsetof(NodeState, ddphi) == NodePlaces::ddphi * sizeof(double));
static_assert(offsetof(NodeState, turns) == NodePlaces::turns * sizeof(double));
static_assert(offsetof(NodeState, chart) == NodePlaces::chart * sizeof(double));
static_assert(offsetof(NodeState, kept) == NodePlaces::kept * sizeof(double));
static_assert(sizeof(NodeState) == NodePlaces::size * sizeof(double));
static_assert(sizeof(Mat3) == 9 * sizeof(double) && sizeof(Vec3) == 3 * sizeof(double));

template <int N>
using Nodes = std::array<const NodeState*, N>;

/// What an element may know beside its nodes.
struct Context {
  double time = 0.0;
  Vec3 gravity = Vec3::Zero();  ///< g(t) minus base acceleration; already inside NodeState::ddu,
                                ///< here for energies
  double load = 1.0;  ///< factor on gravity and given loads: statics in load steps, buckling; 1 in
                      ///< every motion
  /// Means over the revolution are asked for: gear meshes and rolling bearings, whose periods
  /// samples of the revolution would alias, answer with their own mean.
  bool averaged = false;
  /// And what turns with its shaft answers with its mean over the turn, not for the angle at hand, where
  /// that is more than the mean of samples (a crack, whose compliance stands in series).
  bool whole_turn = false;
  /// Hysteretic damping has no form in time: in motions a viscous stand-in acts (false); in steady
  /// states and in small motions about them, at the rate growth + i whirl (1/s), a complex
  /// stiffness (true). whirl: 0 for the steady state itself, infinity to leave it out.
  bool hysteretic = false;
  bool whirl_rotates = false;  ///< whirl is seen in axes that turn with the shaft
  double whirl = 0.0, growth = 0.0;
  double whirl_side =
      0.0;  ///< compared with the spin in place of whirl (which may still be an iterate)
  /// rad/s, not negative: frequency w of the small motions a exp(i w t) that are asked about.
  /// Coefficients that were measured or computed by shaking (tables of bearings and seals) may
  /// depend on it beside the spin. NaN: none is asked about, as in a motion in time; such elements
  /// then answer for the frequency of the shaft's own spin (synchronous reduction).
  double frequency = std::numeric_limits<double>::quiet_NaN();
  /// rad, of compliances in series (SeriesCompliance) by their number: given, not by their law; empty: none
  /// is.
  std::span<const Vec2> kinks;
};

/// Force contribution in X: 3 (u) or 7 (u, d, phi) entries a node.
template <int W>
using ForceX = Vector<W>;

/// Tangents of the force in X.
template <int W>
struct TangentX {
  Matrix<W> M, C, K;  ///< d f/d X'', d f/d X', d f/d X
  void set_zero() {
    M.setZero();
    C.setZero();
    K.setZero();
  }
};

/// Energies in J and powers in W, summed over elements. Gravity's potential is kept apart from the
/// elastic one.
struct Energy {
  double kinetic = 0.0, elastic = 0.0, gravity = 0.0;
  double supplied = 0.0;    ///< power of external loads (not gravity)
  double dissipated = 0.0;  ///< power lost in dampers, >= 0 for passive ones
};

}  // namespace whirl::system
