// Steady harmonic motion about the spinning equilibrium, x(t) = Re(a exp(i w t)):
//   (K + i w C - w^2 M) a = f,
// one complex factorisation for each (Omega, w). Nothing is assumed about symmetry of the supports: forward and backward parts
// are both in a. Phase reference: the rotor mark (phi = 0) passes e2 at t = 0, so that -arg is the lag behind the mark.
#pragma once
#include <analysis/measurement.hpp>
#include <analysis/whirl_modes.hpp>

namespace whirl::analysis {

class HarmonicSolver {
 public:
  /// Forces on what does not take part in the motion are left out.
  explicit HarmonicSolver(Linearizer& linear, Motion motion = Motion::all);
  /// Equilibrium, matrices and factorisation at speed Omega and excitation frequency w, rad/s. False: resonance without damping.
  bool prepare(double Omega, double w);
  /// x := S^-1 x; entries of x at unknowns that take no part are not looked at, those of held ones become zero.
  void solve(VecXc& x);
  Linearizer& linear() { return linear_; }

 private:
  Linearizer& linear_;
  MotionReduction motion_;
  std::unique_ptr<la::DirectSolver<Complex>> solver_;
};

/// Amplitudes (Y, Z) along e2, e3 of a point of a shaft. sense: +1 where the spin there is from e2 to e3, else -1.
struct PointAmplitude {
  Complex y, z;
  double sense = 1;
  /// Along a direction at `angle` from e2 towards e3.
  Complex along(double angle) const { return std::cos(angle) * y + std::sin(angle) * z; }
  Orbit orbit() const { return orbit_of(y, z, sense); }
  /// Of the circle that turns with the spin.
  Complex forward() const { return 0.5 * (y + Complex(0, sense) * z); }
};
PointAmplitude amplitude_at(const Linearizer& linear, const VecXc& a, const Point& p);

/// Complex amplitudes of anything that can be measured on the system (bearing forces, torques, velocities): its exact first
/// variation along a, by central differences about the equilibrium. The measurement must be smooth there.
class VariationMeter {
 public:
  explicit VariationMeter(Linearizer& linear);
  void measure(const VecXc& a, double w, const std::vector<Measurement>& what, std::vector<std::vector<Complex>>& out);

 private:
  Linearizer& linear_;
  system::SystemProblem problem_;
  Snapshot snapshot_;
};

/// Forces and moments that supports exert at held unknowns, complex amplitudes (zero at free unknowns); f: what stands in the residual.
VecXc reaction_amplitudes(Linearizer& linear, const VecXc& a, double w, const VecXc& f);

}  // namespace whirl::analysis
