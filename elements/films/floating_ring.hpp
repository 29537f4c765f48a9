// Journal bearing with a floating ring: an inner film between journal and ring, an outer one between
// ring and housing, and the ring as a body of its own.
//
// Each film is a plain cylinder of film.hpp. The inner one sees r_s - x and the spins (s_s, s), the
// outer one x - r_h and (s, s_h); x, s: displacement (y, z) and spin of the ring, r, s_s, s_h those of
// journal and housing. With z = (F, T_0, T_1) of either film the ring has
//   m x'' = -F_i + F_o - k (x - r_h) - c (x' - r_h') + m g,   I s' = T_i1 + T_o0,
// so its spin follows from the balance of drag. The spin is an unknown by itself (not the rate of an
// angle: nothing about a round ring depends on its angle), constant where the shaft turns steadily.
// Semi-floating: pinned against turning, s = 0 (its row is held, and what holds it is the torque of
// the pin), with a centring spring k and damper c. Concentric, s = s_s/(1 + D_o/D_i) with D = eta R^3
// L/clearance: M. L. Shaw and T. J. Nussdorfer, NACA Report 866 (1947).
//
// Heat (with temperatures): lumped, each film mixed to one effective temperature T_f = T_supply +
// theta_f, at which its oil has its viscosity and leaves:
//   C theta_f' + rho c_p Q_f theta_f + G (theta_f - theta_other) = share P_f.
// P_f: what the film turns into heat; share of it that stays in oil and ring; C: half the heat
// capacity of the ring, which has the mean of both temperatures; G: conduction through the ring.
//   Q_f = pi R c^3 p_f/(3 eta L) (1 + 3/2 eps^2) + 2 R L |w|,
// what a pressure p_f in the middle plane drives out at both ends of the gap, and what wedge and
// squeeze displace (in steady rotation (s_0 + s_1) R L c eps, the side leakage of a short film). The
// outer film is fed at the supply pressure p_s, the inner one through the ring's holes against the
// spin of the oil in them,
//   p_i = p_s - rho s^2 (R_o^2 - R_b^2)/2,   R_b: bore of the ring,
// and by nothing once that is negative (smoothly, within 2 % of p_s).
// Growth: a clearance is c + R (alpha_outside (T_outside - T_0) - alpha_inside (T_inside - T_0)); the
// shaft has the temperature of the inner film, the housing that of the outer one, the ring their mean.
//
// Holes take their area from both films, spread over the circumference: L becomes L - n d^2/(4 D).
// Limits: films as in short_journal.hpp or finite_journal.hpp, cavitated at ambient pressure (the feed
// pressure is neglected against film pressures); laminar, aligned; ring rigid and round, faces without
// friction.
#pragma once
#include <elements/films/finite_journal.hpp>
#include <elements/films/oil.hpp>
#include <elements/films/short_journal.hpp>

namespace whirl::elements {

/// A plain film at other viscosities and clearances than its kernel has: F(r, w; eta, c) is
/// proportional to eta and homogeneous of degree -2 in (r, w, c); T of degree -1.
template <class Film>
struct ScaledFilm {
  const Film* film = nullptr;
  double viscosity = 1, clearance = 1;  ///< over those of the kernel

  void evaluate(const FilmPoint& p, FilmForce& f) const;
  void evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const;
};

/// What feeds the films.
struct RingSupply {
  double pressure = 0;  ///< Pa above ambient; 0: not known
  double density = 900;
  double lever = 0;  ///< R_o^2 - R_b^2 of the holes, m2

  /// Where it reaches the inner film, Pa; negative: it does not.
  double behind_ring(double spin) const { return pressure - 0.5 * density * spin * spin * lever; }
};

/// Heat balance and growth.
struct RingHeat {
  OilViscosity oil;
  double supply_temperature = 0;            ///< K
  double specific_heat = 0;                 ///< of the oil, J/(kg K)
  double share = 1;                         ///< of the heat that oil and ring take
  double capacity = 0;                      ///< C, J/K
  double conductance = 0;                   ///< G, W/K
  double reference = 293.15;                ///< T_0, K: at which the clearances are given
  double shaft = 0, ring = 0, housing = 0;  ///< coefficients of expansion, 1/K
};

/// How one film of a ring stands.
struct RingFilmStanding {
  double eccentricity = 0, clearance = 0;  ///< -, m
  Vec2 place = Vec2::Zero();               ///< inner side against outer side, m
  Vec2 force = Vec2::Zero();               ///< on the outer side, N
  double power = 0;                        ///< turned into heat, W
  double viscosity = 0;                    ///< Pa s
  double temperature = nan;                ///< K
  double flow = nan;                       ///< m3/s
  double thinnest() const { return clearance * (1.0 - eccentricity); }
};
struct RingStanding {
  RingFilmStanding inner, outer;
  double spin = 0;             ///< rad/s
  double torque = 0;           ///< of both films on the ring, N m: 0 in balance, that of the pin
  double feed_pressure = nan;  ///< where the oil reaches the inner film, Pa
};

template <class Film>
struct FloatingRing {
  struct Side {
    Film film;
    double radius = 0, length = 0, clearance = 0, viscosity = 0;  ///< m, m, m, Pa s
  };
  Side inner, outer;
  double mass = 0, inertia = 0;       ///< kg, kg m2 about the axis
  bool pinned = false;                ///< the spin is held
  double stiffness = 0, damping = 0;  ///< of a centring spring, N/m, N s/m
  RingSupply supply;
  RingHeat heat;  ///< used where temperatures are unknowns

  /// Spin of an unknown, rad/s a m: 1000 rad/s are one outer clearance, so that all unknowns of a
  /// ring are of one size; temperatures, K a m: 100 K.
  double spin_unit() const { return 1e3 / outer.clearance; }
  double temperature_unit() const { return 1e2 / outer.clearance; }
  /// Of the row of the spin, 1/m, and of those of the temperatures, s/m: rows are forces in size.
  double spin_row() const { return 1.0 / outer.radius; }
  double heat_row() const { return 1.0 / (outer.radius * 1e3); }
  /// Clearances, m, at excess temperatures of inner and outer film, K, with their derivatives.
  struct Clearances {
    Vec2 c;
    Mat2 slope;  ///< dc_i/dtheta_j, m/K
  };
  Clearances clearances(const Vec2& excess) const;
  /// Excess temperature of both films at which the inner or outer clearance closes, K; infinity:
  /// never.
  double closing_excess() const;
  /// The spin that a centred ring has, rad/s.
  double centred_spin(double shaft, double housing) const;
};

/// The ring between journal and housing. Nodes: 0 journal, 1 housing, then scalars: displacement of
/// the ring along y and z in m, its spin over spin_unit(); with Heat the excess temperatures of inner
/// and outer film over temperature_unit().
template <class Film, bool Heat, bool Offsets = false>
struct FloatingRingJoint {
  static constexpr int own = Heat ? 5 : 3, n_nodes = 2 + own, width = 7, size = 7 * n_nodes;
  static constexpr system::Axes axes = Offsets ? system::Axes::own : system::Axes::any;
  static constexpr bool has_M = true, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{.spin = true, .weight = true};
  using Nodes = system::Nodes<n_nodes>;

  FloatingRing<Film> ring;
  std::array<double, 2> offset{0.0, 0.0};  ///< of journal and housing, m

  void add_force(const Nodes& x, const system::Context& c, system::ForceX<size>& f) const;
  void add_tangent(const Nodes& x, const system::Context& c, system::TangentX<size>& t) const;
  void add_energy(const Nodes& x, const system::Context& c, system::Energy& e) const;
  /// The ring in balance with journal and housing where they are, at rest. Where there is no balance
  /// a ring without a spin gets that of a centred one, and a place inside both clearances.
  void relax(const Nodes& x, const system::Context& c, std::array<double, own>& q) const;
  RingStanding standing(const Nodes& x, const system::Context& c) const;
  /// Largest force of a film, N, at the eccentricity `at` in the direction it has now, or downwards.
  double capacity(const Nodes& x, const system::Context& c, bool of_inner, double at) const;
};

extern template struct FloatingRingJoint<ShortJournal, false, false>;
extern template struct FloatingRingJoint<ShortJournal, false, true>;
extern template struct FloatingRingJoint<ShortJournal, true, false>;
extern template struct FloatingRingJoint<ShortJournal, true, true>;
extern template struct FloatingRingJoint<FiniteJournal, false, false>;
extern template struct FloatingRingJoint<FiniteJournal, false, true>;
extern template struct FloatingRingJoint<FiniteJournal, true, false>;
extern template struct FloatingRingJoint<FiniteJournal, true, true>;

}  // namespace whirl::elements
