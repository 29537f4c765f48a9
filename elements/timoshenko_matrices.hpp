// Constants of a straight axisymmetric shaft element from its section.
//
// Static solution. Under end moments m1, m2 (work-conjugate to the end rotations th1, th2 relative to the chord)
//   M(s) = -m1 (1-xi) + m2 xi = EI th',   Q = -(m1+m2)/l,   w' = th + Q/(kGA),   w(0) = w(l) = 0,
// so the flexibility is f_ij = int M_i M_j/EI + Q_i Q_j/(kGA) and k = f^-1. It holds for any variation of EI and kGA: an
// element loaded at its ends alone is exact, conical or not. Uniform, Phi = 12 EI/(kGA l^2):
//   k11 = k22 = EI (4+Phi)/(l (1+Phi)),   k12 = EI (2-Phi)/(l (1+Phi)).
// th(s) and w(s) of that solution are the shape functions (J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968,
// ch. 5 and 11, for the uniform case):
//   r(s) = N1 r1 + N2 d1 + N3 r2 + N4 d2,   d(s) = G1 r1 + G2 d1 + G3 r2 + G4 d2.
//
// Mass. M4 = int rhoA N N^T + rhoI G G^T + c K4, K4 the bending stiffness on (r1, d1, r2, d2) and
//   c = int rhoA w_q ds / int rhoA ds,   w_q the deflection of the element clamped at both ends under the load rhoA(s)
// (uniform: c = rhoA l^4 (1+5Phi)/(720 EI)). The consistent mass leaves out the ends-clamped motion of the element, which
// lowers the frequencies by the inertia force omega^2 rhoA w acting on w_q: a relative error omega^2 c of omega^2, of order
// l^4. Since K4 vanishes for rigid motion, c K4 alters neither mass, inertia nor gravity loads; where c is the same along a
// shaft it cancels the leading error of every mode exactly (the spectrum is only shifted, lambda -> lambda/(1 + c lambda)),
// and elsewhere the part of it that the variation of c does not bring back.
// The polar mass is built in the same way on the twist: consistent with the exact static twist plus c_t K_t, which is
// rho I_p l [5/12 1/12; 1/12 5/12] for a uniform element.
#pragma once
#include <elements/section.hpp>
#include <elements/shaft_constants.hpp>
#include <vector>

namespace whirl::elements {

enum class MassKind {
  corrected,   ///< with c K4 and c_t K_t
  consistent,  ///< without them
};

/// section along the element of unstressed length l > 0, m; end points r_i = node_i + o_i d_i. Lengths, diameters and moduli
/// must be positive and the bore smaller than the outer diameter at both ends (checked when the model is read).
ShaftElementConstants make_shaft_constants(const ElementSection& section, double l, double o1 = 0, double o2 = 0,
                                           MassKind mass = MassKind::corrected);

/// Shape functions at one point: r = sum N_k X_k, d = sum G_k X_k on X = (r1, d1, r2, d2), and slope_k = dN_k/ds.
struct ShapeFunctions {
  double xi = 0;
  Vector<4> N, G, slope;
};

/// Shape functions at fractions xi (increasing, in [0, 1]) of an element: for pictures and for stresses between nodes.
std::vector<ShapeFunctions> shape_functions(const ElementSection& section, double l, const std::vector<double>& xi);

/// The bending stiffness on (r1, d1, r2, d2) of small motions about the straight state, node coordinates (offsets inside).
Matrix<4> bending_stiffness(const ShaftElementConstants& c);

}  // namespace whirl::elements
