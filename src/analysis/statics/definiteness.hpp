// Whether an equilibrium is stable: the directions in which its static tangent K = dR/dq drives a
// small displacement further away.
//
// Symmetric K (dead loads, springs, gravity): the number of its negative eigenvalues, by
// Sylvester's law from one factorisation. In each of these directions the potential energy falls,
// at any speed.
// Unsymmetric K (films, cross-coupling, internal damping that turns, torques of fixed direction) is
// the derivative of no energy. What is claimed then, for lambda^2 M + lambda C + K with any
// positive M and any C:
//   x' K x > 0 for every x (inertia of the symmetric part): no real root lambda >= 0, no
//       divergence;
//     certain
//   det K < 0: an odd number of real roots lambda > 0, unstable; certain
//   otherwise: the negative real eigenvalues among those of least size; counted, not proved. Complex
//       pairs with a negative real part among them (a column beyond its buckling load in a
//       cross-coupled bush) leave it open: masses and damping decide
// So too for a symmetric K that cannot be factored. With controllers, whose signals are states of
// first order, small eigenvalues of K say nothing: det K < 0 remains, and where it is positive
// nothing is claimed (judged = false).
// Loss of stability by oscillation (whirl, flutter) is not asked about here, nor whether gyroscopic
// moments hold an even number of negative directions in a rotor that spins: modal analysis of the
// same state answers both.
#pragma once
#include <la/block.hpp>
#include <system/system.hpp>

namespace whirl::analysis {

struct Definiteness {
  Index negative = 0;  ///< directions (symmetric K) or negative real eigenvalues (unsymmetric K)
  Index open = 0;      ///< complex pairs of negative real part (unsymmetric K)
  bool symmetric = true;
  bool certain = true;  ///< false: counted, not proved
  bool judged = true;   ///< false: controllers decide, and nothing is said here
  int sign = 1;         ///< of det K; 0: K cannot be factored
  double lowest = 0;    ///< the lowest eigenvalue of K x = mu D x, D = 1 for displacements and
                        ///< (length/10)^2 for rotations, N/m
  VecX
      shape;  ///< its vector (u, phi, gamma) a node, largest displacement 1; only when negative > 0

  bool stable() const { return negative == 0; }
  /// Whether it is stable depends on masses and damping.
  bool undecided() const { return negative == 0 && open > 0; }
};

/// Judges a tangent. free: 1 where q is unknown. length: size of the model, m. Directions that K
/// resists by less than 2e-14 of what its rows hold are rounding (indifferent), not negative.
/// shape: find it (some 20 factorisations, unstable equilibria only).
Definiteness judge_tangent(const la::BlockMatrix<6>& K, std::span<const unsigned char> free,
                           const system::System& system, double length, bool shape = true);

/// A controller has states in it.
bool has_signals(const system::System& system);

/// Scales a shape: largest displacement 1 (rotation, where nothing is displaced).
void scale_shape(VecX& x, const system::System& system);
/// Diagonal of the box around the nodes, m (1 where that is zero).
double model_length(const system::System& system);
/// Unknowns of an equilibrium: the system's, but for those held because nothing else does
/// (Equilibrium::holds).
std::vector<unsigned char> free_unknowns(const system::System& system,
                                         std::span<const Index> holds);

/// The eigenvalue of K x = mu D x nearest to zero, and its vector, by inverse iteration from x (or
/// a start of its own when x is empty). NaN: K cannot be factored.
double eigenvalue_near_zero(const la::BlockMatrix<6>& K, std::span<const unsigned char> free,
                            const system::System& system, double length, VecX& x);

}  // namespace whirl::analysis
