// Breathing crack: what bending of a shaft element at one place of it loses to a transverse crack
// there, which opens and closes.
//
// M = k P is the moment that the ends' bending P (end_bending.inl) makes at the place in the sound
// element, of each plane: M_xi = -(r1 P_1.xi + r2 P_2.xi) opens the crack whose normal xi (from the
// axis to the middle of the crack's mouth, fixed in the shaft) lies on the tension side; M_eta
// across. The crack adds the rotation dW/dm in series, m the moment that is left at it:
//   M = m + g dW/dm,   V = -W(m) - g/2 |dW/dm|^2,   dV/dM = -dW/dm,
// g = r k^-1 r the moment at the place per rotation there with the ends held (a point in series: any
// mesh gives the same), or g = 0 (V = -W(M): the stiffness itself falls, by D of EI over a length
// at its two Gauss points with c = D length/(2 EI), exact for EI (1 - D f)).
// W is half a quadratic form with the compliances c_xi, c_eta of the open crack (rad/(N m)):
//   open      W = 1/2 (c_xi m_xi^2 + c_eta m_eta^2)
//   weight    W = f/2 (c_xi m_xi^2 + c_eta m_eta^2),   f = (1 + xi.n)/2: n the direction, fixed in
//             space, in which the normal points when the weight holds the crack open (Mayes, Davies
//             1984); with g = 0 the stiffness, else the compliance, is linear in f
//   hinge     W = 1/2 c_xi max(m_xi, 0)^2: switches with the sign of the moment (Gasch 1993)
//   response  W = 1/2 c_xi ((m_xi + rho)/2)^2,   rho^2 = m_xi^2 + b^2 m_eta^2,   b^2 = 2 c_eta/c_xi:
//             f = (1 + m_xi/rho)/2 follows the angle of the bending moment itself; convex, and
//             smooth but at m = 0. Open it has c_xi and c_eta, half open c_xi/8 and c_eta/2, closed
//             nothing; for c_eta = 0 it is the hinge.
// Means over the revolution (Context::whole_turn): the moment m at the crack stands still in space, and
// W of the turning crack has the mean c/2 |m|^2, c = (c_xi + c_eta)/2 open, (c_xi + c_eta)/4 by weight and
// by response, c_xi/4 as a hinge: a point in series like any other. (The mean of the stiffness between the
// nodes would be that of the closed crack where the element is short.)
// V is one function of the nodes' places and rotations, with no time in it: the crack keeps energy
// whatever the law. Where f follows the angle, dV/dphi is a torque on the shaft, through which its
// turning pays for what breathing does to the bending. A closed crack is the sound shaft. At m = 0
// the response law is half open (rho is kept above 1e-12 rad of bending).
// Limits: one plane of opening; no torsion, shear or tension opens it or is softened by it; no
// friction of its faces.
// Sources: I. W. Mayes, W. G. R. Davies, J. Vib. Acoust. Stress Reliab. Des. 106 (1984) 139; R. Gasch,
// J. Sound Vib. 160 (1993) 313; compliance in series: C. A. Papadopoulos, Mech. Syst. Signal Process.
// 22 (2008) 763.
#pragma once
#include <elements/shaft/end_axes.hpp>
#include <system/kernel.hpp>
#include <utility>

namespace whirl::elements {

enum class Breathing { open, weight, hinge, response };

/// The crack alone, of the moments and the cosine that a law of the weight sees.
struct CrackLaw {
  Breathing breathing = Breathing::open;
  double c_xi = 0, c_eta = 0;  ///< rad/(N m), open
  double g = 0;                ///< N m/rad; 0: in parallel
  double small = 0;            ///< N m, keeps rho from zero

  /// V of (M_xi, M_eta, cosine), its derivatives and their derivatives.
  struct Answer {
    double V = 0;
    Vec3 slope = Vec3::Zero();
    Mat3 curvature = Mat3::Zero();
    double f = 0;  ///< how far it is open, 0 .. 1
  };
  Answer at(double M_xi, double M_eta, double cosine) const;
  /// In the mean over a turn, of moments that stand still in space.
  Answer mean(double M_xi, double M_eta) const;
  /// rad/(N m), the same about all axes: the second derivatives of the mean of W.
  double mean_compliance() const;

 private:
  Answer follow_weight(double M_xi, double M_eta, double cosine) const;
  Answer follow_moment(double M_xi, double M_eta) const;
};

struct Crack {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = false, has_C = false, has_K = true, quadratic_in_rates = true;
  static constexpr system::Family family = system::Family::shaft;
  /// Its share of the stiffness over the revolution has sharp corners where it switches.
  system::Dependence depends(const system::Context& c) const {
    const bool bowed = !(rest1.isZero(0) && rest2.isZero(0));
    return {.angle = c.whole_turn && !bowed ? system::no_angle : system::each_angle,
            .time = !c.averaged && bow.varies() && bowed,
            .harmonics = c.whole_turn ? 2 : 62};
  }

  CrackLaw law;
  std::size_t number = 0;        ///< among all cracks: of Context::kinks
  EndAxes at;                    ///< normal: xi
  Vec2 r = Vec2::Zero();         ///< r1, r2, N m/rad
  double place = 0;              ///< of the length: which end's normal counts, 0 .. 1
  Vec3 toward = -Vec3::UnitZ();  ///< n
  Vec2 rest1 = Vec2::Zero(), rest2 = Vec2::Zero();  ///< bending of the unstressed ends (xi, eta)
  Growth bow;                                       ///< multiplies rest1, rest2

  void add_force(const system::Nodes<2>& x, const system::Context& c, system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& c,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const;

  /// f: 0 closed, 1 open.
  double opening(const system::Nodes<2>& x, const system::Context& c) const;
  bool cornered() const { return law.breathing == Breathing::hinge; }

  // As a compliance in series (system::SeriesCompliance): its kink may be given (Context::kinks), which
  // leaves out what the law of the weight does to the turning of its shaft.
  double series_stiffness() const { return law.g; }
  bool by_moment() const { return law.breathing != Breathing::weight; }
  /// M of the element without it.
  Vec2 moment(const system::Nodes<2>& x, const system::Context& c) const;
  /// dW/dm and d2W/dm2 at moments m.
  struct KinkLaw {
    CrackLaw alone;
    double cosine;
    std::pair<Vec2, Mat2> operator()(const Vec2& m) const;
  };
  KinkLaw kink_law(const system::Nodes<2>& x, const system::Context& c) const;
  int region(const system::Nodes<2>& x) const { return opening(x, {}) > 0.5 ? 1 : 0; }
};

}  // namespace whirl::elements
