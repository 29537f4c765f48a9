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
// and so is the force in the spring. A spin that next to nothing resists is held so: a rotor at rest
// that is not round would roll under its weight, slowly, and does not while it vibrates.
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
  MotionReduction(const system::System& system, Motion motion, Twist twist = Twist::follows);

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
  void find_restraints();
  bool restraints_still_free();
  Index softest_unknown() const;
  void restrain(Index unknown);
  double& own_stiffness(Index unknown);
  /// Part of the stiffness of an unknown below which others do not hold it.
  double resisted(Index unknown) const;

  const system::System& system_;
  Motion motion_;
  std::vector<unsigned char> active_, follows_;  ///< follows_: without inertia
  bool any_ = false;                             ///< something follows
  la::MCK reduced_;
  std::unique_ptr<la::BlockLu<double>> followers_;
  std::vector<Index> restraints_;
  std::vector<double> springs_;  ///< at the restraints
  VecX scratch_;
};

}  // namespace whirl::analysis
