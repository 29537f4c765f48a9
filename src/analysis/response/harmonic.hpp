// Steady harmonic motion about the spinning equilibrium, x(t) = Re(a exp(i w t)):
//   (K + i w C - w^2 M) a = f,
// one complex factorisation for each (Omega, w). Nothing is assumed about symmetry of the supports:
// forward and backward parts are both in a. At w = 0, and so near to it that the inertia drowns in
// rounding, nothing determines the angle of a rotor that is free to turn: its free spin is taken
// out (held at one node), which changes no other unknown unless the force turns the rotor. Phase
// reference: the rotor mark (phi = 0) passes e2 at t = 0, so that -arg is the lag behind the mark.
#pragma once
#include <analysis/transient/measurement.hpp>
#include <analysis/spectra/whirl_modes.hpp>

namespace whirl::analysis {

class HarmonicSolver {
 public:
  /// Forces on what does not take part in the motion are left out.
  explicit HarmonicSolver(Linearizer& linear, Motion motion = Motion::all);
  /// Equilibrium, matrices and factorisation at speed Omega and excitation frequency w, rad/s.
  /// False: resonance without damping, or a motion other than the spin of a rotor that nothing
  /// resists.
  bool prepare(double Omega, double w);
  /// x := S^-1 x; entries of x at unknowns that take no part are not looked at, those of held ones
  /// become zero, nodes on joints move as what they follow (forces on them: System::reduce). At w = 0 a force that turns a free rotor has no finite answer: the entries that
  /// it moves without bound become NaN, the others are right.
  /// @pre prepare() went well; x of length system().size().
  void solve(VecXc& x);
  /// S^-1 f with f = force(), called once prepared. Where an undamped resonance is met exactly: beside
  /// it, where the response of what is forced is seen to grow without bound, and of what is not is
  /// right. NaN: no answer there either.
  template <class Force>
  VecXc response(double Omega, double w, const Force& force) {
    constexpr double beside = 1e-9;
    for (const double at_w : {w, (1.0 + beside) * w}) {
      if (!prepare(Omega, at_w)) continue;
      VecXc x = force();
      solve(x);
      if (w == 0.0 || x.allFinite()) return x;
    }
    return VecXc::Constant(linear_.system().size(), Complex(nan, nan));
  }
  /// solve() of every column.
  void solve_columns(MatXc& x);
  /// Of the last solve() at w = 0, or so slow that it turns on and on, with a force that turns a free
  /// rotor: the motion without that turning, for all that does not hang on it; empty else.
  const VecXc& bounded() const { return bounded_; }
  Linearizer& linear() { return linear_; }

 private:
  /// The system with one unknown of each free spin held.
  struct Held {
    std::vector<Index> at;  ///< the unknowns held
    std::vector<unsigned char> active;
    std::unique_ptr<la::DirectSolver<Complex>> solver;
  };
  /// axial: unknowns held beside them.
  bool hold(const la::MCK& m, double w, std::vector<Index> unknowns,
            const std::vector<Index>& axial);
  /// S x with the matrices prepared.
  VecXc multiply(const VecXc& x) const;
  VecXc inertia_and_damping(const VecXc& x) const;
  /// Columns: the motions of all unknowns when one free rotor turns by one radian.
  MatX free_spins() const;
  /// Inertia and damping of the free spins at the frequency prepared.
  MatXc spin_matrix(const MatX& spins, const la::BlockMatrix<6>& M,
                    const la::BlockMatrix<6>& C) const;
  void solve_held(VecXc& x);
  /// With the spins held; what does not move gets no force.
  void solve_moving(VecXc& x) const;
  /// Adds the turning of free rotors that the limit w -> 0 asks for.
  void add_free_spin(VecXc& x) const;
  /// Adds what the turning of free rotors by these torques on what is held leaves in them as w goes to
  /// 0; x without bound becomes NaN.
  void add_driven_spin(const VecXc& driving, VecXc& x);

  Linearizer& linear_;
  MotionReduction motion_;
  std::unique_ptr<la::DirectSolver<Complex>> solver_;
  bool spin_free_ = false;  ///< prepared without inertia: `held_` is used
  double w_ = 0;
  const la::MCK* matrices_ = nullptr;
  VecXc column_;
  Held held_;  ///< free spins held at a node of their lines
  VecXc bounded_;
};

/// Amplitudes (Y, Z) along e2, e3 of a point of a shaft. sense: +1 where the spin there is from e2
/// to e3, else -1.
struct PointAmplitude {
  Complex y, z;
  double sense = 1;
  /// Along a direction at `angle` from e2 towards e3.
  Complex along(double angle) const { return std::cos(angle) * y + std::sin(angle) * z; }
  Orbit orbit() const { return orbit_of(y, z, sense); }
  /// Of the circle that turns with the spin.
  Complex forward() const { return 0.5 * (y + Complex(0, sense) * z); }
  /// Of the one that turns against it, conjugate.
  Complex backward() const { return 0.5 * (y - Complex(0, sense) * z); }
};
/// @pre a of length system().size(), p on one of its nodes.
PointAmplitude amplitude_at(const Linearizer& linear, const VecXc& a, const Point& p);
/// Where nothing damps a resonance the response turns about from just below it to just above, by this
/// share of the frequency; a damping ratio of 1e-6 keeps it from that.
inline constexpr double beside_resonance = 1e-7;
bool turns_about(const PointAmplitude& below, const PointAmplitude& above);
/// Largest displacement of a node, m.
/// @pre a of length system.size().
double largest_displacement(const system::System& system, const VecXc& a);
/// Sets to zero what is rounding of displacements of this size, m: where nothing drives a place, the
/// solution leaves something that has peaks of its own.
void drop_rounding(double size, std::span<PointAmplitude> at);

/// A system on which forces act that none of its terms gives: held unknowns pass them on.
class DrivenProblem final : public system::SystemProblem {
 public:
  using SystemProblem::SystemProblem;
  VecX force;  ///< of each unknown, N and N m
  bool residual(double t, time::CRef q, time::CRef v, time::CRef a, time::Ref r) override;
};

/// Complex amplitudes of anything that can be measured on the system (bearing forces, torques,
/// velocities): its exact first variation along a, by central differences about the equilibrium.
/// The measurement must be smooth there.
class VariationMeter {
 public:
  explicit VariationMeter(Linearizer& linear);
  /// a: the response to `force`, amplitudes of the unknowns, N and N m: where a support holds the
  /// unknown it acts on, it is that support's load.
  /// @pre a and force of length system().size().
  void measure(const VecXc& a, const VecXc& force, double w, const std::vector<Measurement>& what,
               std::vector<std::vector<Complex>>& out);

 private:
  Linearizer& linear_;
  DrivenProblem problem_;
  Snapshot snapshot_;
};

}  // namespace whirl::analysis
