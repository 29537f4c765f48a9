// Constants of a straight axisymmetric shaft element from its section.
//
// Static solution. Under end moments m1, m2 (work-conjugate to the end rotations th1, th2 relative
// to the chord)
//   M(s) = -m1 (1-xi) + m2 xi = EI th',   Q = -(m1+m2)/l,   w' = th + Q/(kGA),   w(0) = w(l) = 0,
// so the flexibility is f_ij = int M_i M_j/EI + Q_i Q_j/(kGA) and k = f^-1. It holds for any
// variation of EI and kGA: an element loaded at its ends alone is exact, conical or not. Uniform,
// Phi = 12 EI/(kGA l^2):
//   k11 = k22 = EI (4+Phi)/(l (1+Phi)),   k12 = EI (2-Phi)/(l (1+Phi)).
// th(s) and w(s) of that solution are the shape functions (J. S. Przemieniecki, Theory of Matrix
// Structural Analysis, 1968, ch. 5 and 11, for the uniform case):
//   r(s) = N1 r1 + N2 d1 + N3 r2 + N4 d2,   d(s) = G1 r1 + G2 d1 + G3 r2 + G4 d2.
//
// Consistent mass. M4 = int rhoA N N^T + rhoI G G^T, G4 = int rhoIp G G^T. They leave out the
// motion of the element between clamped ends, which the inertia loads omega^2 rhoA w and (omega^2
// rhoI - omega Omega rhoIp) th excite. The error of omega^2 is of order l^4 omega^2 rhoA/EI when
// slender, and of order l^2 omega^2 rho/G when the elements are as short as the shaft is thick.
//
// Correction. Let c_w, c_th, c_p (s^2) be the compliance of the clamped element under the loads
// rhoA(s), the moments rhoI(s), rhoIp(s), each divided by the integral of its load (uniform: rhoA
// l^4 (1+5Phi)/(720 EI), rhoI l^2/(12 EI) Phi/(1+Phi), the same with rhoIp). The inertia missed is
// omega^2 (c_w int rhoA w^2 + ..) times omega^2; by the equation of motion omega^2 int (rhoA w^2 +
// rhoI th^2) = x.K4 x, and omega^2 int rhoI th^2 = (the part of x_d.(K4 x)_d that is rotary), d the
// director rows. So
//   M4 += (c_i + c_j)/2 K4_ij,  c = (c_w, c_d, c_w, c_d),  c_d = c_w - share (c_w - c_th),
//   G4 += the same with c = (0, c_p, 0, c_p),  share = int rhoI / (int rhoI + int rhoA l^2/15),
// share being the rotary part of the nodal inertia moments of M4. Without rotary inertia it is M4
// += c_w K4: a mere shift of the spectrum, lambda -> lambda/(1 + c_w lambda), which cancels the
// leading error of every mode. Translations are untouched (K4 times a translation is zero), so
// mass, gravity loads and nodally exact sag are; the energy of rigid rotation is, too. Measured
// orders of the frequencies: slender 6, thick Timoshenko shafts 4, spinning or not (consistent
// mass: 4 and 2). Limits: the argument needs c_w the same in neighbouring elements. Where it varies
// (cones, unequal lengths) the leading order stays with a smaller constant: slender cones 4; thick
// solid cones 4; thick hollow cones whose kappa changes 2, with a tenth of the consistent mass's
// error.
// Bodies and bearings. The force in row i of K4 x accelerates all that is joined at the node and
// holds against what loads it, and only the elements' part of it stands for their own inertia: with
// the share w_i = (inertia of elements)/(of elements and bodies), of the mass for x and of the
// transverse inertia for d, and w_i = 0 where a bearing acts,
//   M4 += (w_i c_i K4_ij + K4_ij c_j w_j)/2.
// Without the shares a body leaves the frequencies an error of order 4 on slender elements and 2 on
// elements as short as the shaft is thick; with them the orders are 6 and 3, and 6 elements a
// disk-heavy rotor's are 1e-6 to 1e-5. Rigid motion keeps its energy, but the element's weight is
// then no longer the row sums of M4: that of the whole line is, and what is missing at a node is a
// force and a moment of order l^4, known and constant (elements/weight_rest.hpp). Rows of different
// shares are of both signs; corrected_mass.hpp takes no more of them than leaves the mass positive.
//
// The polar mass is built in the same way on the exact static twist: consistent plus c_t K_t, which
// is rhoIp l [5/12 1/12; 1/12 5/12] for a uniform element; order 4 where l sqrt(rhoIp/GJ) is the
// same in all elements, between 2 and 4 elsewhere; with the shares of the polar inertia beside
// bodies, too.
#pragma once
#include <elements/shaft/section.hpp>
#include <elements/shaft/shaft_constants.hpp>
#include <vector>

namespace whirl::elements {

/// w of the header: what part of all that is joined at a node, or loads it, is inertia of the
/// elements. 1: all, 0: next to none.
struct MassShare {
  Vector<4> bending = Vector<4>::Ones();  ///< rows of (x1, d1, x2, d2)
  Vec2 spin = Vec2::Ones();               ///< of both ends
};

enum class MassKind {
  corrected,   ///< with the corrections above
  consistent,  ///< without them
};

/// section along the element of unstressed length l > 0, m; end points r_i = node_i + o_i d_i.
/// Lengths, diameters and moduli must be positive and the bore smaller than the outer diameter at
/// both ends (checked when the model is read).
ShaftElementConstants make_shaft_constants(const ElementSection& section, double l, double o1 = 0,
                                           double o2 = 0, MassKind mass = MassKind::corrected,
                                           const MassShare& share = {});

/// The bending stiffness on (r1, d1, r2, d2) of small motions about the straight state, node
/// coordinates (offsets inside).
Matrix<4> bending_stiffness(const ShaftElementConstants& c);

}  // namespace whirl::elements
