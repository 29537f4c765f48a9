// Kinds of motion in the frequency domain: which unknowns take part, which follow, which are held.
//
// Lateral motion is bending. What a bent, sagged or geared shaft does along and about its axis
// comes with it: those unknowns follow without inertia, gyroscopic couple or damping,
//   M, C: their rows and columns zero,   K: complete,
// so that (lambda^2 M + lambda C + K) x = 0 is the lateral problem with K_ll - K_lf K_ff^-1 K_fl,
// static condensation with the pattern kept; the unknowns without mass have their eigenvalues at
// infinity. Holding them instead would make a sagged shaft stretch when it bends. Left out: axial
// and torsional inertia, of relative size (lateral/axial or torsional frequency)^2 times the square
// of the coupling. A motion that nothing resists (a shaft free to move along its axis, the free
// spin) is restrained by a spring at one unknown: what the rest of the model feels of it is zero,
// and so is the force in the spring. The spin of a rotor that turns as one against little (one that is
// not round rolls at rest under its weight) is held so too: it is slow beside bending, and its inertia,
// which is left out, holds it. What follows a spin that is held already, by teeth or a coupling, follows.
//
// Torsional and axial motion hold the rest: bending is slow beside them and held by its inertia,
// not by its stiffness.
#pragma once
#include <la/block_lu.hpp>
#include <system/system.hpp>

#include <memory>

namespace whirl::analysis {

enum class Motion { all, lateral, torsional, axial };

/// What an unknown belongs to: u_x is axial, phi torsional, the rest (internal coordinates of
/// foundations too) lateral. A joint's slide along the axis is axial, its angle about it torsional.
/// @pre 0 <= unknown < system.size().
Motion kind_of_unknown(const system::System& system, Index unknown);

class MotionReduction {
 public:
  enum class Twist { follows, held };
  /// twist: of lateral motion alone. Held where matrices that depend on the angle of the rotor are
  /// not averaged over it: a free spin then is not free of forces, and the rotor turns at its
  /// speed.
  /// spinning: a flag a node whose phi turns with its line (SteadySystem::spinning()); empty: none does.
  MotionReduction(const system::System& system, Motion motion,
                  std::span<const unsigned char> spinning, Twist twist = Twist::follows);

  Motion motion() const { return motion_; }
  /// 6 flags a node: 1 where an unknown takes part or follows, 0 where it is held.
  std::span<const unsigned char> active() const { return active_; }
  bool takes_part(Index unknown) const {
    return active_[static_cast<std::size_t>(unknown)] &&
           !follows_[static_cast<std::size_t>(unknown)];
  }
  bool anything_follows() const { return any_; }
  /// Matrices of the motion; m itself where nothing follows, else valid until the next call.
  /// @pre m stands on the pattern of the system.
  const la::MCK& reduce(const la::MCK& m) { return reduce(m, m.K); }
  /// The same where K holds a part of the damping: following, stiffness without it, gives the rows and
  /// columns of what follows, which is not damped. A free spin would not be free otherwise.
  /// @pre both on the pattern of the system.
  const la::MCK& reduce(const la::MCK& m, const la::BlockMatrix<6>& following);
  /// Unknowns whose free motion the last reduce() restrained.
  std::span<const Index> restraints() const { return restraints_; }

 private:
  struct Restraint {
    Index unknown = -1;
    bool rolls = false;  ///< a spin that something resists; false: nothing does
    double spring = 0;
  };
  void find_restraints();
  bool restraints_still_free();
  Index softest_unknown() const;
  /// A spin that little resists, or -1. After a factorisation with nothing softer left.
  Index rolling_spin();
  void restrain(Index unknown, bool rolls);
  double& own_stiffness(Index unknown);
  /// How much more an unknown gives way than it would if all others were held. After a factorisation.
  double softness(Index unknown) const;
  bool spins(Index unknown) const;
  /// Into scratch_: the motion of a restraint under a force on its spring.
  void push(const Restraint& r);
  /// scratch_ turns the line of an unknown as one.
  bool turns_as_one(Index unknown) const;

  const system::System& system_;
  Motion motion_;
  std::vector<unsigned char> active_, follows_;  ///< follows_: without inertia
  bool any_ = false;                             ///< something follows
  la::MCK reduced_;
  std::unique_ptr<la::BlockLu<double>> followers_;
  std::vector<unsigned char> spinning_;
  std::vector<Restraint> springs_;
  std::vector<Index> restraints_;  ///< their unknowns
  VecX scratch_;
};

}  // namespace whirl::analysis
