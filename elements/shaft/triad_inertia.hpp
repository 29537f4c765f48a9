// Rotary and polar inertia of an element on the triads (D, B, C) of its ends.
//
// Sections with the inertia tensor J (about D, B, C) turn with 1/2 w.J w. A part of the inertia
// about both lateral axes can follow the bent line: it is carried by the directors' static shape in
// M4 (timoshenko_matrices.hpp), order 4. It may be no more than the smaller of the two, so that
//   J - contained (0, 1, 1) >= 0.
// What is left about D and what is left across it are interpolated between the ends, with node
// matrices of their own. That of the twist is the mean of consistent and lumped, which makes up for
// the twist of an element under its own inertia. That across is lumped for a slender element: the
// rule of Euler and Maclaurin, and a distributed moment bends nothing. In a short one, where bending
// passes to shear, it bends as much as torque twists: with phi = Phi/(1 + Phi) the diagonal is (6 -
// phi)/12 of the whole. At an end whose moment is not this inertia alone both are consistent, which
// is what their boundary terms leave. On the rates of directors an inertia about D is B + C, one
// about B is C + D, one about C is B + D, and products have the sign of int rho y z.
//
// Each form is positive, and so is the mass matrix, however short an element is against its
// section; a remainder of both signs (the mean of both planes in M4) is not.
#pragma once
#include <core/types.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>

#include <array>

namespace whirl::elements {

/// What part of the moment at each end is the element's own inertia, 0 to 1: about the axis, and
/// across it.
struct TriadShare {
  Vec2 spin = Vec2::Ones();
  Vec2 tilt = Vec2::Ones();
};

struct TriadInertia {
  /// Of directors (D, B, C) by (D, B, C): symmetric 2 x 2 matrices of (left, right), kg m^2.
  std::array<std::array<Mat2, 3>, 3> on;
  double contained = 0;  ///< what M4 has to carry, kg m^2

  TriadInertia();
  /// J: inertia tensor about (D, B, C) times the element's length, kg m^2, positive semi-definite.
  /// phi: share of the shear in the element's softness, of the plane with the larger inertia.
  TriadInertia(const Mat3& J, double phi, MassKind kind = MassKind::corrected,
               const TriadShare& share = {});
};

/// Phi/(1 + Phi) of an element with the end stiffnesses k11, k12, k22; 0 for a cone without shear
/// that gives a little less than none.
double shear_share(double k11, double k12, double k22);

}  // namespace whirl::elements
