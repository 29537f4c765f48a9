// What a bearing, seal, damper, contact, coupling or gear pair is, as plain values in SI, and
// beside each law its traits. How to add one: docs/developer/add_a_bearing_law.md.
#pragma once
#include <core/types.hpp>
#include <model/magnetic_bearing.hpp>
#include <model/support_traits.hpp>
#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace whirl::model {

/// Linear bearing or support between a shaft station and ground (or another station): 6x6 K, C, M
/// in the order (x, y, z, rx, ry, rz), fixed axes; force on the shaft = preload - K (q - setpoint)
/// - C q'.
struct LinearBearing {
  Matrix<6> K = Matrix<6>::Zero(), C = Matrix<6>::Zero(), M = Matrix<6>::Zero();
  Vector<6> setpoint = Vector<6>::Zero(), preload = Vector<6>::Zero();
};
SupportTraits traits(const LinearBearing&);

/// The paper's spring block at a point: force -C1 (r - r0), moment -C2 gamma (gamma: Euler vector
/// of the axis tilt).
struct SpringBlock {
  double C1 = 0, C2 = 0;
};
SupportTraits traits(const SpringBlock&);
/// The same for small motions, between any two points.
LinearBearing linear_form(const SpringBlock&);

/// The linear bearing with K, C (and M) tabulated against speed, and where given against the
/// frequency of the motion. With frequencies the rows are a grid, speed by speed: row i f + j
/// belongs to speed i, frequency j.
struct TableBearing {
  std::vector<double> speed;       ///< rad/s, increasing
  std::vector<double> frequency;   ///< rad/s, increasing; empty: against speed alone
  std::vector<Matrix<6>> K, C, M;  ///< as many as speeds (times frequencies); M may be empty
  Vector<6> setpoint = Vector<6>::Zero(), preload = Vector<6>::Zero();
  bool monotone_cubic = true;     ///< else linear
  bool extrapolate_hold = false;  ///< else outside the table is an error
  std::string file;
};
SupportTraits traits(const TableBearing&);

/// Directions held rigidly (constraints, no penalty): x, y, z, rx (spin), ry, rz.
struct RigidSupport {
  std::array<bool, 6> held{};
};
SupportTraits traits(const RigidSupport&);

/// A force (or moment) against a deflection (or angle).
struct ForceLaw {
  enum class Shape { polynomial, table, clearance, one_sided } shape = Shape::polynomial;
  std::vector<double> coefficients;    ///< c0, c1, ...: sum c_k q^k
  std::vector<double> q, F;            ///< table
  bool monotone_cubic = true;          ///< table: else straight lines
  double gap_minus = 0, gap_plus = 0;  ///< clearance: play on either side; one_sided: gap_plus
  double stiffness = 0,
         smooth = 0;  ///< clearance and one_sided: behind the gap; length over which it sets in
};

/// Nonlinear spring with damper along one direction: load on the shaft -(F(q) + D(q) q'), D =
/// damping + damping2 q^2.
struct NonlinearSpring {
  enum class Along { y, z, radial, x, ry, rz, rx } along = Along::y;
  ForceLaw force;
  double damping = 0, damping2 = 0;
};
SupportTraits traits(const NonlinearSpring&);

/// Viscosity of a lubricant: given, or an ISO VG oil at a temperature.
struct Oil {
  double viscosity = 0;                              ///< Pa s; 0: from the grade
  double grade = 0, temperature = 0, density = 900;  ///< ISO VG number, K, kg/m3
  /// 1/K, of a given viscosity: that at T is viscosity exp(-thinning (T - temperature)).
  double thinning = 0;
};

/// What the heat balance of a film needs (elements/films/film_heat.hpp).
struct FilmHeat {
  double supply_temperature = 0;                     ///< of fresh oil, K
  double specific_heat = 1950, conductivity = 0.14;  ///< of the oil, J/(kg K), W/(m K)
  enum class Feed { flooded, leading_edge } feed = Feed::flooded;
  double carry_over = 0.75;  ///< hot oil, from the pad before, in what enters a pad
  /// Of tilting pads, fresh oil to the bearing, m3/s; NaN: what the temperatures of carry_over stand for.
  double supply_flow = nan;
  /// Of the pads, m; 0: nothing goes through them. NaN, of tilting pads: as thick as each is.
  double wall = 0;
  double wall_conductivity = 50;  ///< W/(m K)
  double back_coefficient = 100;  ///< from the back and the ends of a pad to the oil, W/(m2 K)
  /// And of that oil, K; NaN: of the oil about the pads with supply_flow, else of what enters each pad.
  double housing_temperature = nan;
  double shaft_expansion = 0, pad_expansion = 0, housing_expansion = 0;  ///< 1/K
  double assembly_temperature = 293.15;  ///< at which the clearances are those given, K
  double time_constant = infinity;       ///< of all temperatures in time, s; infinite: they stay
};

/// How oil flows in a film beyond the isoviscous laminar one at ambient pressure.
struct FilmFlow {
  enum class Regime { laminar, ng_pan } regime = Regime::laminar;
  double supply_pressure = 0;  ///< in grooves and between pads, above ambient, Pa
  /// What oil there is where a film has ruptured: as much as the next film needs, or what leaves the
  /// one before it.
  enum class Cavitation { reynolds, mass_conserving } cavitation = Cavitation::reynolds;
  std::optional<FilmHeat> heat;  ///< nothing: one viscosity everywhere
  bool conserves_mass() const { return cavitation == Cavitation::mass_conserving; }
  /// The oil of ruptured film is an unknown of a motion at large: of films of one viscosity. Else the
  /// film is that of the momentary state.
  bool follows_oil() const { return conserves_mass() && !heat; }
};

/// Plain journal bearing by the short-bearing theory (pi film).
struct ShortJournal {
  double diameter = 0, length = 0, clearance = 0;  ///< m; clearance radial
  Oil oil;
};
SupportTraits traits(const ShortJournal&);

/// Journal bearing of finite length with cavitation: plain, with axial grooves, multi-lobe, or with
/// recesses in its surface.
struct FiniteJournal {
  double diameter = 0, length = 0, clearance = 0;  ///< m; clearance radial, as assembled
  Oil oil;
  double preload = 0;  ///< of the pads, in [0, 1)
  enum class Shape { plain, two_grooves, grooves, lobes, pressure_dam, tapered_land };
  Shape shape = Shape::plain;
  int lobes = 3;  ///< or lands
  struct Groove {
    double at = 0, width = 20 * pi / 180;  ///< rad, from +y towards +z
  };
  std::vector<Groove> grooves;  ///< of Shape::grooves
  /// A pocket of the first pad with a dam at its end, or a taper of each: its arc from the leading edge
  /// (rad), its depth there and its width (m).
  double recess_arc = 0, recess_depth = 0, recess_width = 0;
  double relief_width = 0;      ///< of a track in the second pad, m; 0: none
  bool leading_at_end = false;  ///< edges that lead: the ends of the pads (z -> y)
  double groove = 0, groove_at = 0, lobe_at = 0, lobe_offset = 0.5;  ///< rad; from +y towards +z
  FilmFlow flow;
  int nodes = 72;  ///< grid points round the circumference
  int rows = 0;    ///< of a grid along the axis too, over half the length; 0: one profile there
};
SupportTraits traits(const FiniteJournal&);

/// Journal bearing of pads that tilt about their pivots.
struct TiltingPadJournal {
  double diameter = 0, length = 0;  ///< m
  double clearance = 0;             ///< m; radial, as assembled: the smallest of its pads
  Oil oil;
  FilmFlow flow;
  struct Contact {
    enum class Shape { ball, line } shape = Shape::ball;
    double radius = 0,
           seat_radius = infinity;  ///< of a ball and its hollow seat, m; infinity: flat
    double length = 0;              ///< of a line, m; 0: that of the bearing
    double E = 210e9, nu = 0.3;     ///< of a ball and its seat, Pa
  };
  struct Pad {
    double pivot = 0;      ///< rad; from +y towards +z
    double arc = pi / 3;   ///< rad
    double offset = 0.5;   ///< of the pivot from the start of the pad, in arcs
    double preload = 0;    ///< 1 - (assembled clearance)/(clearance of the pad), in [0, 1)
    double clearance = 0;  ///< m; of a centred journal at the pivot; 0: that of the bearing
    double thickness = 0;  ///< at the pivot, m
    double inertia = 0;    ///< about the pivot, kg m2; 0: it follows at once
    double mass = 0;       ///< kg, along an elastic pivot
    double pivot_stiffness = 0,
           pivot_damping = 0;        ///< N/m, N s/m; stiffness 0: rigid, or a contact
    std::optional<Contact> contact;  ///< a pivot that stiffens with its load
    double tilt_stiffness = 0;       ///< of a flexure, N m/rad
    bool rigid_pivot() const { return pivot_stiffness == 0 && !contact; }
  };
  int count = 5;           ///< equal pads, the first pivot at `first`, one like `like` each
  double first = -pi / 2;  ///< rad
  Pad like;
  std::vector<Pad> own;                  ///< each by itself: instead of the equal ones
  std::vector<double> frequency_ratios;  ///< frequency over speed, of further coefficients
  int nodes = 72;                        ///< grid points round the circumference
  int rows = 0;  ///< of a grid along the axis too, over half the length; 0: one profile there

  /// All pads, in the order of the deck or of their pivots from the first.
  std::vector<Pad> pads() const;
};
SupportTraits traits(const TiltingPadJournal&);

/// Journal bearing whose ring floats between an inner and an outer film and turns as their drag makes
/// it, or is pinned (semi-floating).
struct FloatingRing {
  struct Film {
    double diameter = 0, length = 0, clearance = 0;  ///< m; clearance radial
    double viscosity = 0, temperature = 0;           ///< Pa s, or K of the oil; 0: from the heat
  };
  Film inner;  ///< diameter of the journal
  Film outer;  ///< outer diameter of the ring
  enum class Theory { finite, brief } theory = Theory::finite;
  double grade = 0, density = 900;  ///< ISO VG number, kg/m3
  double ring_density = 8500;       ///< kg/m3
  double mass = 0, inertia = 0;     ///< kg, kg m2 about the axis; 0: those of the annulus
  bool pinned = false;
  double stiffness = 0, damping = 0;  ///< of the centring of a pinned ring, N/m, N s/m
  struct Holes {
    int number = 0;
    double diameter = 0;  ///< m
  };
  Holes holes;
  double supply_pressure = 0;     ///< Pa above ambient; 0: not given
  double supply_temperature = 0;  ///< K
  /// Balance of heat: the temperatures of both films are unknowns.
  struct Heat {
    double specific_heat = 2000;              ///< of the oil, J/(kg K)
    double share = 1;                         ///< of the heat that oil and ring take
    double ring_specific_heat = 380;          ///< J/(kg K)
    double conductance = 0;                   ///< through the ring, W/K
    double reference = 293.15;                ///< K: at which the clearances are given
    double shaft = 0, ring = 0, housing = 0;  ///< coefficients of expansion, 1/K
  };
  std::optional<Heat> heat;
  std::vector<double> frequency_ratios;  ///< frequency over speed, of further coefficients
  int nodes = 72;                        ///< grid points round the circumference

  double bore() const { return 0.5 * inner.diameter + inner.clearance; }  ///< radius, m
  double thickness() const { return 0.5 * outer.diameter - bore(); }      ///< of the ring, m
  double ring_mass() const;     ///< kg: given, or of the annulus as long as the longer film
  double ring_inertia() const;  ///< kg m2: given, or of the annulus
  /// Length of a film less the area that the holes take from it, m.
  double carrying_length(const Film& f) const {
    return f.length - holes.number * holes.diameter * holes.diameter / (4.0 * f.diameter);
  }
  /// Clearances at one temperature of everything, K.
  double inner_clearance_at(double temperature) const;
  double outer_clearance_at(double temperature) const;
};
SupportTraits traits(const FloatingRing&);

/// Squeeze-film damper, with its centring spring where it has one.
struct SqueezeFilm {
  double diameter = 0, length = 0, clearance = 0;
  Oil oil;
  enum class Film { cavitated, full, finite, sealed } film = Film::cavitated;
  double groove = 0, groove_at = 0;   ///< feed of the sealed film, rad
  double stiffness = 0, damping = 0;  ///< centring spring, the same in y and z, N/m, N s/m
};
SupportTraits traits(const SqueezeFilm&);

struct BallBearing {
  int balls = 0;
  double ball_diameter = 0, pitch_diameter = 0, contact_angle = 0, clearance = 0;
  double f_inner = 0.52, f_outer = 0.52, stiffness = 0, preload = 0;
  int direction = 1;
  double c_radial = 0, c_axial = 0;
};
SupportTraits traits(const BallBearing&);

struct RollerBearing {
  int rollers = 0;
  double roller_diameter = 0, roller_length = 0, pitch_diameter = 0, clearance = 0, stiffness = 0;
  double c_radial = 0, c_axial = 0;
};
SupportTraits traits(const RollerBearing&);

/// Ball or cylindrical roller bearing as the linear spring estimated for its static load.
struct RollingEstimate {
  bool roller = false;
  int elements = 0;
  double size = 0;                  ///< ball diameter or roller length, m
  double load = 0, load_angle = 0;  ///< N; rad, from +y towards +z
  double contact_angle = 0;         ///< rad
  double kxx = 0, c_radial = 0;     ///< given: axial stiffness, N/m; lateral damping, N s/m
};
SupportTraits traits(const RollingEstimate&);

/// Stiffness of a loaded rolling bearing, N/m: kyy along the load = 13e6 n^(2/3) d^(1/3) F^(1/3)
/// cos^(5/3) alpha (balls, d: ball diameter), kyy = 1e9 n^0.9 l^0.8 F^0.1 cos^1.9 alpha (rollers,
/// l: length); across it kxx/kyy interpolated in n from 8: 0.46, 12: 0.64, 16: 0.73 (balls), 0.49,
/// 0.66, 0.74 (rollers). F: static load, N; alpha: contact angle, rad. Friswell, Penny, Garvey &
/// Lees 2010, doi 10.1017/CBO9780511780509, pp. 182-185.
struct EstimatedStiffness {
  double along, across;
};
EstimatedStiffness estimate_stiffness(const RollingEstimate&);
/// The linear bearing it stands for.
LinearBearing linear_form(const RollingEstimate&);

SupportTraits traits(const MagneticBearing&);  // magnetic_bearing.hpp

/// One-sided contact with friction: rub, stop, catcher bearing. The stator is the pedestal.
struct Rub {
  double gap = 0, stiffness = 0, damping = 0, friction = 0;  ///< m, N/m, s/m (Hunt & Crossley), -
  double diameter = 0;                                       ///< 0: that of the shaft
  double slip_speed = 1e-3;                                  ///< m/s
};
SupportTraits traits(const Rub&);

struct AnnularSeal {
  double diameter = 0, length = 0, clearance = 0, pressure_drop = 0, density = 0, viscosity = 0;
  double inlet_loss = 0.1, inlet_swirl = 0.5;
};
SupportTraits traits(const AnnularSeal&);

/// Destabilising force k J r of a bladed stage or impeller.
struct CrossCoupling {
  double k = 0;  ///< N/m, positive: drives whirl y -> z
  struct Alford {
    double beta = 1, torque = 0, diameter = 0, blade_height = 0;
  };
  struct Wachel {
    double power = 0, speed = 0, diameter = 0, width = 0, molar_mass = 0.029, density_ratio = 1;
  };
  enum class From { given, alford, wachel } from = From::given;
  Alford alford;
  Wachel wachel;
};
SupportTraits traits(const CrossCoupling&);

/// Coupling between two shafts: K, C turn with them (order x, y, z, rx, ry, rz).
struct Coupling {
  Matrix<6> K = Matrix<6>::Zero(), C = Matrix<6>::Zero();
  double offset_y = 0, offset_z = 0;  ///< parallel misalignment of hub 1 against hub 2, m
  double angle_y = 0, angle_z = 0;    ///< angular misalignment: slopes towards y and z, rad
};
SupportTraits traits(const Coupling&);
/// Stiffness or damping across the shaft differs between directions by more than this share of the
/// largest: the forces change as the coupling turns.
bool is_unequal(const Coupling& c, double share);

/// Spur or helical gear pair between the shaft and a second one.
struct GearPair {
  int teeth = 0, other_teeth = 0;             ///< other_teeth < 0: internal gear
  double pitch_diameter = 0;                  ///< of the gear on this shaft, m
  double pressure_angle = pi / 9, helix = 0;  ///< transverse, and base helix angle, rad
  double centre_angle = nan;                  ///< rad; nan: from the places of the shafts
  int drive = 1;
  double stiffness = 0, damping = 0;  ///< N/m, N s/m (with backlash: s/m)
  double backlash = -1;  ///< m along the line of action; negative: none, both flanks always hold
  std::vector<double> stiffness_harmonics, stiffness_phases;  ///< relative to the mean; rad
  std::vector<double> error_harmonics, error_phases;          ///< m; rad
};
SupportTraits traits(const GearPair&);

// ---------------------------------------------------------------- the list of laws

/// In the order of the kinds in the deck's reference.
using BearingLaw =
    std::variant<LinearBearing, SpringBlock, TableBearing, RigidSupport, NonlinearSpring,
                 ShortJournal, FiniteJournal, TiltingPadJournal, FloatingRing, SqueezeFilm,
                 BallBearing, RollerBearing, RollingEstimate, MagneticBearing, Rub, AnnularSeal,
                 CrossCoupling, Coupling, GearPair>;

inline SupportTraits traits_of(const BearingLaw& law) {
  return std::visit([](const auto& x) { return traits(x); }, law);
}

/// Calls f(std::type_identity<Law>{}) for every law of the list, in its order.
template <std::size_t I = 0, class F>
void for_each_law(const F& f) {
  if constexpr (I < std::variant_size_v<BearingLaw>) {
    f(std::type_identity<std::variant_alternative_t<I, BearingLaw>>{});
    for_each_law<I + 1>(f);
  }
}

}  // namespace whirl::model
