// Rolling bearings between a shaft (node 0, inner ring) and a housing or second shaft (node 1,
// outer ring): deep-groove and angular-contact ball, cylindrical roller.
//
// Everything is a potential of the relative motion q = (x, y, z, tau_y, tau_z, psi): displacement
// of the inner ring against the outer, difference of the ring normals d_0 - d_1 in (y, z) (tau_y:
// rotation about +z, tau_z: about -y), and the cage angle
//   psi = [(1 - lambda) phi_0 + (1 + lambda) phi_1]/2,   lambda = (D/d_m) cos alpha
//       (rolling without slip)
//   V = sum over elements, K/(n+1) delta_+^(n+1)
// so the tangent is a Hessian, the torque that varying compliance puts on the shaft is in it, and
// motion is conservative but for the damper below. With n_j = (cos, sin)(psi + 2 pi j/Z), rho =
// r.n_j, t = tau.n_j:
//   ball:   s_a = a_0 + x - R t,   s_r = r_0 + rho,
//       delta = |s| - A_0, exponent 3/2: distance of the groove centres against the
//            unloaded one A_0 = (f_i + f_o - 1) D; (a_0, r_0) holds contact angle, clearance and
//                preload
//   roller:
//       delta = rho + s_k t - clearance over `slices` laminae at axial positions s_k, exponent
//       10/9, load K/slices each
// Damping: -c_r v lateral, -c_a v axial (grease, mounting; N s/m).
//
// Frequency-domain analyses (Context::averaged) see the mean over the cage angle: the elements
// smeared round the ring, over the arcs in which they touch, to rounding in any direction of the
// load.
//
// Limits: no centrifugal force or gyroscopic moment of the elements (ball bearings: n d_m below
// about 5e5 mm/min), rings round and rigid, cage exactly at the rolling speed, tilts small (tau <<
// 1). The onset of contact is C1 (3/2) or C1 with an unbounded second derivative (10/9): no
// smoothing is used.
// Sources: Harris & Kotzalas, Rolling Bearing Analysis, 5th ed., doi 10.1201/9781482275148; Jones,
// ASME J. Basic Eng. 82 (1960), doi 10.1115/1.3662587; varying compliance: Fukata et al., Trans.
// JSME 51 (1985).
#pragma once
#include <system/kernel.hpp>
#include <array>
#include <vector>

namespace whirl::elements {

/// q and derivatives of V there.
struct RollingPotential {
  double V = 0;
  Vector<6> g = Vector<6>::Zero();  ///< dV/dq: load on the inner ring is -g
  Matrix<6> H = Matrix<6>::Zero();
};

/// Energy of one contact and its derivatives by (x, rho, t).
struct ContactLoad {
  double V;
  Vec3 g;
  Mat3 H;
};

/// Contacts of some rolling elements in (x, rho, t); zero where one does not touch.
struct ContactLoads {
  static constexpr int together = 8;
  std::array<double, together> V;
  std::array<double, together> gx, gr, gt;
  std::array<double, together> Hxx, Hxr, Hxt, Hrr, Hrt, Htt;
  ContactLoad at(std::size_t j) const;
};

/// Contact of a ball: deflection as a function of (x, rho, t).
struct BallContact {
  double K = 0;   ///< both contacts in series, N/m^1.5
  double A0 = 0;  ///< unloaded distance of groove centres, m
  double a0 = 0,
         r0 = 0;  ///< distance of groove centres in the reference position, axial and radial, m
  double R = 0;   ///< radius of the inner groove centres, m
  using Local = ContactLoad;
  bool evaluate(double x, double rho, double t, Local& l) const;
  /// Balls at rho and t, ContactLoads::together of them; one that is not there has rho = -infinity.
  void evaluate(double x, const double* rho, const double* t, ContactLoads& out) const;
  double load(double x, double rho, double t) const;  ///< N
  /// Contacts of an element that begin by themselves, each where its gap_at (m) rises above zero.
  int parts() const { return 1; }
  double gap_at(int part, double x, double rho, double t) const;
  bool evaluate_part(int, double x, double rho, double t, Local& l) const {
    return evaluate(x, rho, t, l);
  }
};

/// Contact of a cylindrical roller.
struct RollerContact {
  double K = 0;          ///< both contacts in series, N/m^(10/9)
  double clearance = 0;  ///< radial (negative: interference), m
  double length = 0;     ///< effective, m
  int slices = 9;
  using Local = ContactLoad;
  /// As the balls'.
  void evaluate(double x, const double* rho, const double* t, ContactLoads& out) const;
  double load(double x, double rho, double t) const;
  int parts() const { return slices; }
  double gap_at(int part, double x, double rho, double t) const;
  bool evaluate_part(int part, double x, double rho, double t, Local& l) const;
  /// Of a lamina along the roller from its middle, m.
  double place(int part) const { return length * ((part + 0.5) / slices - 0.5); }
};

template <class Contact>
struct RollingBearing {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  /// Sees the angle of the cage, unless means are asked for.
  system::Dependence depends(const system::Context& c) const {
    return {.angle = c.averaged ? system::no_angle : system::angle_sum(cage[0], cage[1])};
  }

  Contact contact;
  int elements = 0;                      ///< Z
  std::array<double, 2> cage{0.5, 0.5};  ///< (1 -+ lambda)/2
  double c_radial = 0, c_axial = 0;      ///< N s/m

  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context&,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context&, system::Energy& e) const;

  /// q of the nodes; psi reduced by whole turns of the cage.
  Vector<6> deflection(const system::Nodes<2>& x) const;
  /// with_hessian = false leaves H at zero.
  void potential(const Vector<6>& q, RollingPotential& p, bool with_hessian) const;
  /// The mean of it over the angle of the cage.
  void mean_potential(const Vector<6>& q, RollingPotential& p, bool with_hessian) const;
  /// Load of every rolling element, N.
  std::vector<double> loads(const Vector<6>& q) const;

 private:
  static constexpr int smeared = 96;  ///< points of the mean over a ring in contact all round
  /// An element at an angle of cosine c and sine s.
  static void add_element(const Vector<6>& q, double c, double s, double weight,
                          const typename Contact::Local& l, bool with_hessian, RollingPotential& p);
  void add_arc(const Vector<6>& q, int part, double from, double to, bool with_hessian,
               RollingPotential& p) const;
  void add_ring(const Vector<6>& q, int part, double from, bool with_hessian,
                RollingPotential& p) const;
  void evaluate(const system::Nodes<2>& x, bool averaged, RollingPotential& p,
                bool with_hessian) const;
};

using BallBearing = RollingBearing<BallContact>;
using RollerBearing = RollingBearing<RollerContact>;

extern template struct RollingBearing<BallContact>;
extern template struct RollingBearing<RollerContact>;

/// Geometry of a ball bearing, m and rad.
struct BallGeometry {
  int balls = 0;
  double ball_diameter = 0;   ///< D
  double pitch_diameter = 0;  ///< d_m
  double contact_angle =
      0;  ///< free contact angle alpha_0; 0: deep groove, taken from the clearance
  double radial_clearance = 0;  ///< deep groove: half the diametral play; negative: interference
  double f_inner = 0.52, f_outer = 0.52;  ///< groove radius / ball diameter, > 0.5
  int direction = 1;  ///< angular contact: +1 carries a push of the shaft towards +x, -1 towards -x
  double stiffness = 0;  ///< K, N/m^1.5; 0: from Hertz (steel)
};
/// @throws Error E83: fewer than 2 balls, sizes not positive, balls that do not fit, f <= 0.5,
/// |alpha| >= 80 deg, clearance beyond the grooves.
/// @throws Error (E83) for a geometry that cannot be built.
BallBearing make_ball_bearing(const BallGeometry& g);
/// Shifts the reference position so that the bearing pushes back with `force` (N, >= 0) axially
/// when undisplaced. E83 when deep groove.
/// @throws Error (E83) when the force is negative or the bearing has no contact angle.
void set_axial_preload(BallBearing& b, double force);

struct RollerGeometry {
  int rollers = 0;
  double roller_diameter = 0, roller_length = 0, pitch_diameter = 0;
  double radial_clearance = 0;
  double stiffness = 0;  ///< K, N/m^(10/9); 0: Palmgren (steel)
};
/// @throws Error (E83) for a geometry that cannot be built.
RollerBearing make_roller_bearing(const RollerGeometry& g);

}  // namespace whirl::elements
