// Linear systems of signals in state space, and the stages controllers are made of.
//   x' = A x + B u,  y = C x + D u,  G(s) = C (s - A)^-1 B + D;  time in s
// Franklin, Powell and Emami-Naeini, Feedback Control of Dynamic Systems, chapters 6 and 7.
#pragma once
#include <core/types.hpp>
#include <span>

namespace whirl::elements {

/// n states, m inputs, p outputs: A n x n, B n x m, C p x n, D p x m.
struct StateSpace {
  MatX A, B, C, D;
  Index states() const { return A.rows(); }
  Index inputs() const { return D.cols(); }
  Index outputs() const { return D.rows(); }
  /// G(s). @pre s is no eigenvalue of A.
  MatXc at(Complex s) const;
};

/// y = gain u.
StateSpace make_gain(double gain);
/// (b0 + b1 s + ..)/(a0 + a1 s + ..) in companion form, time scaled to the size of its poles.
/// @throws Error E84: no denominator, or a numerator of higher degree.
StateSpace make_transfer(std::span<const double> numerator, std::span<const double> denominator);
/// exp(-s T) after Pade with numerator and denominator of the same degree, 1 to 6. T > 0, s.
StateSpace make_delay(double T, int degree);
/// First the one, then the other. @pre outputs of the first = inputs of the second.
StateSpace series(const StateSpace& first, const StateSpace& second);
/// The sum of both on the same inputs.
StateSpace parallel(const StateSpace& one, const StateSpace& other);
/// One beside the other: inputs and outputs of the first, then of the second.
StateSpace beside(const StateSpace& one, const StateSpace& other);

/// Largest size of each state for a unit harmonic at any one input, over frequencies from a tenth of
/// the slowest to ten times the fastest pole (without those at zero): the unit in which a state is
/// about as large as what enters. Ones where nothing reaches a state.
VecX sizes_of_states(const StateSpace& s);
/// States counted in units of their own: x = size * x_new.
StateSpace rescaled(const StateSpace& s, const VecX& size);

}  // namespace whirl::elements
