// One whirl mode: frequency, damping, direction, kind, shape.
//
// x(t) = Re(x exp(lambda t)). Direction: the orbit of a node in the plane across its shaft is the
// sum of a part that turns with the spin, |Y + i s Z|/2, and one against it, |Y - i s Z|/2 (Y, Z
// amplitudes along e2, e3; s = +1 where the shaft turns from e2 to e3, else -1). Whose spin that is
// for what stands still: spin_senses() in steady_rotation.hpp. Kind: the largest share of the
// energy (kinetic and strain) among lateral, torsional and axial motion.
#pragma once
#include <analysis/linearizer.hpp>
#include <la/eigen.hpp>
#include <string_view>

namespace whirl::analysis {

enum class Direction {
  forward,
  backward,
  mixed,
  planar,
  none
};  ///< planar: no orbit has an area; none: not lateral
enum class ModeKind { lateral, torsional, axial };
std::string_view to_string(Direction d);
std::string_view to_string(ModeKind k);

struct WhirlMode {
  Complex lambda;            ///< 1/s, Im >= 0
  double frequency = 0;      ///< damped natural frequency Im lambda, rad/s
  double damping_ratio = 0;  ///< -Re lambda / |lambda|; 0 for a rigid motion
  double log_decrement =
      0;  ///< -2 pi Re lambda / Im lambda, per cycle; +-inf when it does not oscillate
  ModeKind kind = ModeKind::lateral;
  Direction direction = Direction::none;
  double forwardness = 0;  ///< sum of (forward^2 - backward^2)/(forward^2 + backward^2), -1 .. 1: a
                           ///< smooth measure of direction
  double lateral = 0, torsional = 0, axial = 0;  ///< shares of energy
  VecXc x;  ///< (u, phi, gamma) a node; largest displacement (twist, when torsional) is 1 and real
  double residual = 0;  ///< backward error of the eigenpair
  double rounding = 0;  ///< 1/s: growth that rounding of the matrices alone can cause
  /// +1: grows, -1: decays, 0: neutral, its growth rate being within rounding of zero.
  int growth() const { return lambda.real() > rounding ? 1 : lambda.real() < -rounding ? -1 : 0; }
  /// False of real roots and of pairs damped beyond 0.949 of critical (la::oscillates).
  bool oscillates() const { return la::oscillates(lambda); }
  /// 1/s: lambda to first order with coefficients that depend on frequency continued to the complex
  /// frequency -i lambda of the motion itself (OwnFrequency::continued); equal to lambda where
  /// nothing depends on it.
  Complex continued;
  Index from = -1;  ///< mode of the last speed it continues, -1: none
};

/// 1/s: growth that rounding can cause of an eigenpair: what it does to lambda, and what the
/// eigenvector's own error leaves.
double rounding_of(const la::Mode& mode);

/// Fills kind, direction and the rest from lambda and x. Scales x.
WhirlMode describe_mode(const la::Mode& mode, const la::MCK& m, const Linearizer& linear);

/// Two lateral modes of one root span a plane of shapes, out of which rounding picks two: makes them, where
/// they move most, the one along y and the one along z, or, of a rotor that turns, the circle against its
/// spin and the one with it.
void separate_pair(const Linearizer& linear, bool turning, WhirlMode& first, WhirlMode& second);

/// |x^H M y|^2/((x^H M x)(y^H M y)), 0 .. 1: likeness of two shapes.
double likeness(const la::MCK& m, const VecXc& x, const VecXc& y);

/// The elliptic orbit Re((Y, Z) exp(i omega t)) of a point.
struct Orbit {
  double forward = 0, backward = 0;  ///< radii of the two circles, with the spin and against it
  double major = 0, minor = 0;       ///< half axes; minor < 0: run against the spin
  double angle = 0;                  ///< of the major axis, from e2 towards e3, rad
};
/// sense: +1 where the spin is from e2 to e3, -1 where it is the other way.
Orbit orbit_of(Complex Y, Complex Z, double sense = 1.0);

/// Displacement amplitude of a node along the axes (e, e2, e3) of its line.
Eigen::Vector3cd local_displacement(const Linearizer& linear, const VecXc& x, Index node);

}  // namespace whirl::analysis
