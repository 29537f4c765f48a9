// The model: what the deck says, as plain values in SI (m, kg, s, rad, N). Validated once by the
// deck reader, then const. No matrices, no mesh, no numbering. Every entity keeps where in the deck
// it stands.
#pragma once
#include <core/compression.hpp>
#include <core/error.hpp>
#include <core/law.hpp>
#include <core/path.hpp>
#include <core/types.hpp>
#include <model/bearing_laws.hpp>
#include <model/location.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace whirl::model {

struct Entity {
  std::string name;
  Where where;
};

// ---------------------------------------------------------------- shafts

struct Material : Entity {
  double E = 0, G = 0, nu = 0.3, rho = 0;  ///< Pa, Pa, -, kg/m3 (G = E/(2(1+nu)) unless given)
  double yield = 0;                        ///< Pa, 0 = not given
  double expansion = 0;                    ///< coefficient of thermal expansion, 1/K
};

enum class ShearFactor { cowper, hutchinson, none /* Euler-Bernoulli or Rayleigh */, given };

/// One section of a station table, left to right. Conical when the left and right diameters differ.
struct Section : Entity {
  double length = 0;
  double od_l = 0, id_l = 0, od_r = 0, id_r = 0;  ///< mass diameters, m
  std::optional<std::array<double, 4>>
      stiffness_diameters;   ///< od_l, id_l, od_r, id_r for stiffness, when they differ
  std::size_t material = 0;  ///< index into Model::materials
  bool rigid = false;        ///< rigid link: no deformation; massless unless it has diameters
  ShearFactor shear = ShearFactor::cowper;
  double kappa = 0;                  ///< for ShearFactor::given
  bool rotary_inertia = true;        ///< false: Euler-Bernoulli mass
  double added_mass_per_length = 0;  ///< kg/m without stiffness
  double temperature_rise = 0;       ///< K above the state in which the shaft has its lengths
  int min_elements = 0;              ///< 0, and no length given: chosen (model/resolution.hpp)
  double max_element_length = infinity;
  bool mean_rotary_inertia = false;  ///< both transverse inertias the mean of the two
  /// General sections (not axisymmetric): stiffnesses given directly; I about the section's own y
  /// and z axes through the centroid, which is the mass centre.
  struct General {
    double A = 0, Iy = 0, Iz = 0, J = 0, kappa_y = 0, kappa_z = 0, angle = 0;
    double twist = 0;  ///< angle at the right end less `angle`, rad
    Vec2 centroid = Vec2::Zero(), shear_centre = Vec2::Zero();  ///< m, section axes
    bool on_line() const { return centroid.isZero(0) && shear_centre.isZero(0); }
  };
  std::optional<General> general;
  /// Stiffness and mass per length as full matrices in section axes (core/section_matrices.hpp).
  /// `constants` then holds the round section nearest to them.
  struct Full {
    Matrix<6> stiffness = Matrix<6>::Zero(), mass = Matrix<6>::Zero();
    double angle = 0, twist = 0;  ///< as of General
  };
  std::optional<Full> full;
  double angle() const { return general ? general->angle : full ? full->angle : 0.0; }
  double twist() const { return general ? general->twist : full ? full->twist : 0.0; }
  /// Not a matter of two principal planes: coupled, twisted or off the line.
  bool is_full() const { return full || (general && (general->twist != 0 || !general->on_line())); }
  /// Stiffness and inertia constants given directly (benchmarks that state them): EA, kGA, GJ, EI;
  /// rhoA, rhoI (transverse), rhoIp.
  struct Constants {
    double EA = 0, kGA = 0, GJ = 0, EI = 0, rhoA = 0, rhoI = 0, rhoIp = 0;
  };
  std::optional<Constants> constants;
};

/// Damping of a shaft line.
struct ShaftDamping {
  double alpha = 0;           ///< mass-proportional, external (fixed frame), 1/s
  double beta_external = 0;   ///< stiffness-proportional, non-rotating, s
  double beta_internal = 0;   ///< stiffness-proportional, rotating (viscous), s
  double loss_factor = 0;     ///< hysteretic, rotating
  double loss_frequency = 0;  ///< rad/s in rotating axes, at which a viscous stand-in loses as much
                              ///< in transients; 0: none
  double beta_torsion = 0;    ///< torsional viscous, s
};

/// Residual or thermal bow of an unloaded shaft: half a sine from end to end, in a plane that turns
/// with the shaft.
struct Bow {
  double amount = 0, phase = 0;  ///< m at mid-length; rad, body angle from e2 towards e3
  /// Of a bow that grows or decays: amount + (initial - amount) exp(-t/time_constant), m, s; 0: it
  /// is always there.
  double initial = 0, time_constant = 0;
  bool constant() const { return time_constant == 0; }
  bool any() const { return amount != 0 || (!constant() && initial != 0); }
};

struct Shaft : Entity {
  Vec3 origin =
      Vec3::Zero();  ///< position of station 0, m; the line runs along +x, or along `path`
  Path path;         ///< of a line that is not straight; it starts at the origin
  std::vector<Section> sections;
  ShaftDamping damping;
  bool rotating = true;  ///< false: a casing or foundation beam
  double speed_ratio =
      1;  ///< speed of this line relative to the reference speed of frequency-domain steps
  double spin0 = 0;          ///< initial spin of transients unless a drive says otherwise, rad/s
  double axial_preload = 0;  ///< N, tension positive: before anything deforms; relaxes where the
                             ///< ends are free along the axis
  double axial_force = 0;    ///< N, tension positive: pulls at both ends, a load
  Bow bow;
  double length() const {
    double s = 0;
    for (const auto& x : sections)
      s += x.length;
    return s;
  }
  Vec3 position(double s) const {
    return path.empty() ? Vec3(origin + Vec3(s, 0, 0)) : path.after(s).r;
  }
};

// ---------------------------------------------------------------- what sits on a shaft

/// Rigid disk or body, fixed to the shaft at `at`.
struct Disk : Entity {
  Location at;
  double mass = 0, Ip = 0, Id = 0;  ///< about the mass centre
  std::optional<Mat3>
      inertia;  ///< full body-fixed tensor about the mass centre, axes (e, e2, e3) at phi = 0
  Vec3 offset = Vec3::Zero();  ///< mass centre from the station, body axes (x along the shaft):
                               ///< unbalance is mass * offset_yz
  double skew = 0,
         skew_phase = 0;  ///< rad: principal axis tilted by `skew` towards body angle `skew_phase`
  double draw_od = 0, draw_id = 0, draw_width = 0;  ///< picture only
};

struct Unbalance : Entity {
  Location at;
  std::optional<Location> to;  ///< of the same shaft, to the right: evenly over the length between;
                               ///< absent = at one place
  double amount = 0;           ///< kg m
  double phase = 0;            ///< rad, body angle from e2 towards e3
  LawPtr factor;  ///< time law multiplying amount (blade loss, thermal growth); null = 1
};

/// Transverse crack of a shaft, at a place, or as stiffness lost over a length.
struct Crack : Entity {
  enum class Breathing {
    weight,    ///< by the angle of its normal to a direction in space (Mayes)
    hinge,     ///< open or closed, by the sign of the bending moment at it
    response,  ///< by the angle of the bending moment at it
    open
  };
  Location at;
  std::optional<Location> to;  ///< of the same shaft, to the right: stiffness lost between
  double phase =
      0;  ///< rad, body angle of its normal, which points to its mouth, from e2 towards e3
  Breathing breathing = Breathing::weight;
  double depth = 0;  ///< m, of a straight edge; 0: not given
  double stiffness = infinity,
         stiffness_across = infinity;  ///< of the open crack as a hinge in the
                                       ///< shaft, N m/rad
  double loss = 0, loss_across = 0;    ///< D of EI (1 - D f) between at and to
  double open_direction = nan;         ///< rad from +y towards +z: the normal points there when the
                                       ///< weight holds the crack open; nan: along gravity
};

/// Initial values of a free body or line: applied to all nodes as a rigid motion.
struct InitialMotion : Entity {
  std::size_t shaft = 0;
  Vec3 displacement = Vec3::Zero(), velocity = Vec3::Zero(), omega = Vec3::Zero();
  Vec2 gamma = Vec2::Zero();
  Vec3 about = Vec3::Zero();  ///< point the rotation and velocity refer to (reference position)
};

// ---------------------------------------------------------------- supports and bearings

/// A mass-spring-damper pedestal under a bearing: mass with its own y, z (and x) motion.
struct Pedestal {
  double mass = 0;
  Mat3 K = Mat3::Zero(), C = Mat3::Zero();
};

struct Bearing : Entity {
  Location at;
  std::optional<Location>
      to;  ///< second shaft station (intershaft bearing or coupling); absent = ground
  BearingLaw law;
  std::optional<Pedestal> pedestal;
};

enum class JointKind { rigid, hinge, universal, spherical, slider };

/// Holds two places of lines together exactly, or one to the ground, but for what its kind leaves
/// free. Axes are of the undeformed model and fixed in the lines.
struct Joint : Entity {
  JointKind kind = JointKind::rigid;
  Location at;
  std::optional<Location> to;  ///< absent: the ground
  Vec3 axis = Vec3::UnitX();   ///< unit vector; of a universal joint the one fixed in the line of
                               ///< `at`
  Vec3 second_axis = Vec3::UnitX();  ///< of a universal joint, fixed in the other
  bool arm = false;  ///< rigid: the places may lie apart, joined by an arm without mass
  double stiffness = 0, damping = 0;  ///< on the angle of a hinge, N m/rad, N m s/rad; on the slide
                                      ///< of a slider, N/m, N s/m
};

/// A foundation or casing as reduced matrices: its coordinates are support points of bearings and
/// internal ones.
struct Foundation : Entity {
  struct Coordinate {
    std::string name;
    int bearing = -1;
    int direction = 0;
  };  ///< bearing -1: internal; direction 0 .. 2 x, y, z, 3 .. 5 rotations about them
  std::vector<Coordinate> coordinates;
  MatX K, C, M;  ///< one row and column a coordinate; M symmetric
};

// ---------------------------------------------------------------- loads and drives

enum class LoadFrame { fixed, rotating };  ///< fixed directions, or turning with phi (body axes)

struct PointLoad : Entity {
  Location at;
  LoadFrame frame = LoadFrame::fixed;
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  ///< N, N m; multiplied by factor(t)
  LawPtr factor;                                     ///< null = 1
};

/// Torque along the shaft on phi (a constant-velocity joint, along (e+d)/(1+e.d)) or as a
/// fixed-direction moment.
enum class TorqueKind { spin, fixed_direction };

/// Torque as a function of the station's own spin: T(t, s).
struct TorqueCurve {
  LawPtr of_time;  ///< T(t); null = 0
  std::vector<double> speed,
      torque;  ///< table against spin, rad/s -> N m (linear between, held outside); may be empty
  double constant = 0, viscous = 0,
         quadratic = 0;  ///< load torque -(constant sign(s) + viscous s + quadratic s|s|)
  struct Induction {
    double breakdown = 0, slip_breakdown = 0.1, synchronous = 0;
  };  ///< Kloss: 2 Tb/(x/xb + xb/x)
  std::optional<Induction> induction;
  /// Of a salient-pole motor that runs up: amplitude(s) cos(2 p (synchronous t - phi) + phase), twice
  /// the slip frequency.
  struct Pulsation {
    double synchronous = 0, poles = 4, phase = 0;  ///< rad/s, number of poles 2 p, rad
    std::vector<double> speed, amplitude;          ///< rad/s -> N m, linear between, held outside
  };
  std::optional<Pulsation> pulsation;
  struct ConstantPower {
    double power = 0, max_torque = 0;
  };
  std::optional<ConstantPower> power;
  struct DcLine {
    double stall = 0, no_load_speed = 0;
  };  ///< stall (1 - s/no_load_speed), N m, rad/s
  std::optional<DcLine> dc;
  LawPtr brake;  ///< magnitude of a torque opposing the spin, N m(t); null = 0
  struct Governor {
    double target = 0, kp = 0, ki = 0, max_torque = infinity;
  };  ///< PI on speed
  std::optional<Governor> governor;
};

struct PrescribedSpin {
  LawPtr angle;              ///< phi(t) at the station, exact constraint
  bool of_speed = false;     ///< given as a speed
  bool angle_given = false;  ///< by the deck; else only the speed matters
};
struct Drive : Entity {
  Location at;
  std::variant<PrescribedSpin, TorqueCurve> law;
  TorqueKind kind = TorqueKind::spin;
  std::string step;  ///< the transient step it belongs to; empty = all
};

// ---------------------------------------------------------------- observation

struct Probe : Entity {
  Location at;
  std::vector<double> angles;  ///< rad from +y towards +z; empty: y and z
};

// ---------------------------------------------------------------- steps

struct IntegratorOptions {
  std::string method = "radau5";  ///< radau5, generalized_alpha, gauss4, gauss6, ida, momentum_rk
  double tolerance =
      1e-4;  ///< one user-facing accuracy number, relative to the peak response of each kind
  double rho_inf = 0.9;  ///< generalized-alpha
  double dt = 0;         ///< fixed step, s; 0 = adaptive
  double dt_max = infinity, dt_min = 0, dt_first = 0;
};

struct SpeedRange {
  double start = 0, stop = 0;
  int points = 2;
  std::vector<double> values;
};
/// Speeds of a response, which has peaks between them.
struct ResponseSpeeds : SpeedRange {
  bool refine_peaks = false;  ///< more speeds where it peaks
};

/// Static equilibria followed past limit points, the load factor (on gravity and loads) an unknown.
struct LoadPath {
  enum class Control { arc_length, displacement } control = Control::arc_length;
  int branch = 0;  ///< arc length: bifurcation at which the path leaves on the branch, 1 the first;
                   ///< negative: to its other side; 0: none
  double last_load = 1;  ///< arc length: load factor at which the path ends
  Location at;           ///< displacement control: where,
  int direction = 1;     ///< 0 .. 2: x, y, z; 3: angle about the axis,
  double to = 0;         ///< m or rad
  int steps = 20, max_points = 400;
};
struct StaticStep {
  int load_steps = 1;
  double speed = 0;
  bool speed_given = false;  ///< 0 may be meant
  /// rad/s; nothing where the deck leaves the speed to the drives and initial spins.
  std::optional<double> own_speed() const {
    return speed_given || speed != 0 ? std::optional(speed) : std::nullopt;
  }
  std::optional<SpeedRange>
      speeds;  ///< equilibria one after another; the last one is the step's result
  std::optional<LoadPath> path;
};
/// Which unknowns of the shafts take part in a frequency-domain step; the others are held.
enum class MotionKind { all, lateral, torsional, axial };
/// What a frequency-domain step is linearised about: the static equilibrium at its speed, or the
/// rotor as drawn, without gravity, loads and the deflection they cause.
enum class About { equilibrium, undeformed };
/// Excitation frequencies, rad/s: equally spaced, or one by one.
struct FrequencyRange {
  double start = 0, stop = 0;
  int points = 2;
  std::vector<double> values;
};

struct ModalStep {
  double speed = 0;
  int modes = 10;
  double max_frequency = infinity;  ///< rad/s
  bool damped = true;               ///< false: the conservative part of the matrices only
  MotionKind motion = MotionKind::all;
  int shapes = 6;  ///< mode shapes drawn and animated
  About about = About::equilibrium;
};
struct CampbellStep {
  SpeedRange speed;
  int modes = 10;
  std::vector<double> orders;  ///< empty: once a turn of every shaft
  double max_frequency = infinity;
  bool damped = true;
  MotionKind motion = MotionKind::all;
  About about = About::equilibrium;
};
struct CriticalStep {
  double max_speed = 0;
  std::vector<double> orders;  ///< empty: once a turn of every shaft
  int modes = 10;              ///< critical speeds listed of each order, from the lowest
  double min_speed = 0;
  MotionKind motion = MotionKind::all;
  int shapes = 4;
  About about = About::equilibrium;
};
/// Zones of shaft vibration, peak to peak: limits as they are, or constants over the square root of
/// the speed.
struct VibrationZones {
  std::vector<double> constants{4800, 9000, 13200};  ///< A/B, B/C, C/D: um sqrt(rpm)
  std::vector<double> limits;                        ///< m; empty: by constants
  std::string source = "ISO 20816-3";
};
struct UnbalanceStep {
  std::optional<VibrationZones> zones;
  double balance_grade = 0;  ///< m/s (e omega); 0: none
  ResponseSpeeds speed;
  std::array<double, 2> operating{0, 0};  ///< range of operating speeds, rad/s; 0 0 = not given
  std::vector<double> shapes_at;  ///< speeds of operating shapes, rad/s; empty = at the peaks
  About about = About::equilibrium;
};
/// The stability at several values of a parameter of the deck, as written there ("75 um").
struct StabilityMap {
  std::string parameter;
  std::vector<std::string> values;
};
struct StabilityStep {
  static constexpr int most_onset_shapes = 3;
  SpeedRange speed;
  int modes = 12;
  std::optional<StabilityMap> map;
  About about = About::equilibrium;
};
struct CriticalMapStep {
  double stiffness_min = 0, stiffness_max = 0;  ///< N/m
  int points = 31;
  double max_speed = 0;
  double order = 1;
  bool backward = false;  ///< backward criticals as lines of their own
  std::vector<std::string>
      bearings;  ///< whose stiffness is varied; empty = all that carry laterally to the ground
  MotionKind motion = MotionKind::lateral;
  About about = About::equilibrium;
};
/// Harmonic force or moment: Re(amplitude exp(i (w t + phase))), or turning at w in the lateral
/// plane.
struct HarmonicForce : Entity {
  enum class Whirl { none, forward, backward };
  Location at;
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  ///< amplitudes, N, N m
  double phase = 0;                                  ///< rad
  Whirl whirl = Whirl::none;
};
struct HarmonicStep {
  std::vector<HarmonicForce> forces;
  double speed = 0;  ///< asynchronous: rotor speed while the frequency varies
  std::optional<FrequencyRange> frequency;
  std::optional<ResponseSpeeds> speeds;  ///< synchronous: frequency = order x speed
  double order = 1;
  bool speed_squared =
      false;  ///< amplitudes are those at the highest speed and grow with its square
  MotionKind motion = MotionKind::all;
  std::vector<double> shapes_at;  ///< frequencies of operating shapes, rad/s; empty = at the peaks
  About about = About::equilibrium;
};
/// Sensitivity of the control loops of magnetic bearings.
struct SensitivityStep {
  double speed = 0;
  FrequencyRange frequency;
  About about = About::equilibrium;
};
struct TorsionalStep {
  double max_speed = 0;
  std::vector<double> orders;  ///< empty: once a turn of every shaft
  int modes = 6;
  About about = About::equilibrium;
};
/// A close clearance of the machine, looked at by an API report.
struct ApiClearance : Entity {
  Location at;
  double diametral = 0;  ///< m
};
/// A stage whose gas or steam drives whirl.
struct ApiStage : Entity {
  enum class Kind { radial, axial } kind = Kind::radial;
  std::optional<Location> at;
  double power = 0, speed = 0;        ///< W; rad/s, 0: the highest continuous one
  double diameter = 0, width = 0;     ///< m; of blades: mean diameter and height
  double suction = 0, discharge = 0;  ///< densities, kg/m3
};
/// One build of the machine: keys of the deck that it has otherwise.
struct ApiSet : Entity {
  std::vector<std::string> change;  ///< "bearing.DE.clearance=60 um"
};
/// What an API lateral report holds against its numbers.
struct ApiLimits {
  double unbalance_factor = 2, unbalance_constant = 6350;  ///< -, g mm rpm/kg
  double unbalance_speed = 0;  ///< rad/s; 0: the operating speed nearest to the mode
  double vibration = 25.4 / 1e6, vibration_speed = 12000 * pi / 30;  ///< m peak to peak, rad/s
  double scale = 6, clearance = 0.75;
  double damped = 2.5, margin_factor = 0.17, margin_offset = 1.5, margin_above = 0.10;
  double margin = nan;  ///< a fixed one; nan: by amplification factor
  double stage_factor = 3, axial_factor = 1.5, torque_constant = 9.55;
  double log_decrement = 0.1, ratio = 2, ratio_in_b = 10;
  std::vector<double> density{0, 16.53, 60}, critical_ratio{2.5, 2.5, 2.0};  ///< kg/m3, -
  std::string source;              ///< of limits that the deck sets
  std::vector<std::string> given;  ///< keys that the deck sets
};
/// Lateral analyses and their comparison with a standard, for every set of bearings.
struct ApiLateralStep {
  std::string standard = "API 617";
  std::array<double, 2> operating{0, 0};  ///< rad/s, least and highest continuous speed
  double trip = 0;                        ///< rad/s
  double min_speed = 0, max_speed = 0;    ///< rad/s, of the response
  int points = 121;
  std::vector<std::string> bearings, seals, probes;
  std::vector<double> modes;  ///< numbers; empty: all below max_speed
  std::vector<ApiSet> sets;
  std::vector<ApiClearance> clearances;
  std::vector<ApiStage> stages;
  std::optional<Location> cross_coupling_at;
  bool at_stages = false;  ///< each stage's share where the stage is
  ApiLimits limits;
};
/// A plane that takes correction masses.
struct BalancePlane : Entity {
  Location at;
};
/// A measured vibration: a run, a probe, an angle, a speed.
struct MeasuredVector {
  std::string run, probe;
  double angle = 0, speed = 0, amplitude = 0, phase_lag = 0;  ///< rad, rad/s, m, rad
};
struct TrialRun : Entity {
  std::string run, plane;
  double amount = 0, phase = 0;  ///< kg m, rad
};
struct BalancingStep {
  enum class Method { influence, modal } method = Method::influence;
  std::vector<BalancePlane> planes;
  std::vector<double> speeds;  ///< rad/s
  std::vector<double> modes;   ///< modal: numbers, one a speed
  std::vector<MeasuredVector> measured;
  bool peak_to_peak = true;  ///< amplitudes measured
  std::string initial;       ///< run without trial masses
  std::vector<TrialRun> trials;
};
/// A torque that excites a train: a multiple of a shaft's speed, or at a fixed frequency.
/// One of the orders of a periodic torque: amplitude cos(order phi + phase).
struct ApiHarmonic {
  double order = 0, amplitude = 0, phase = 0;  ///< -, N m 0 to peak, rad
};
struct ApiTorque : Entity {
  Location at;
  /// Of the speed of its shaft; rad/s. Both: |frequency - order times that speed|.
  double order = 0, frequency = 0;
  double amplitude = 0;                ///< N m, 0 to peak
  std::vector<ApiHarmonic> harmonics;  ///< instead of all these
};
/// What a transient that an earlier step ran does to the train, so many times in its life.
struct ApiEvent : Entity {
  std::string step;
  double times = 1;
};
struct ApiTorsionalStep {
  std::string standard = "API 617, 671";
  std::array<double, 2> operating{0, 0};  ///< rad/s of the reference
  int modes = 6;
  std::vector<double> multiples{1, 2}, orders, line_multiples{1, 2};
  double line_frequency = 0;  ///< rad/s; 0: none
  double margin = 0.10;
  std::vector<ApiTorque> torques;
  std::vector<ApiEvent> events;
  double damage_limit = 1;                     ///< of the sum over all events
  double concentration = 1, stress_limit = 0;  ///< -, Pa; 0: none
  std::string source;
  std::vector<std::string> given;
};
/// Torques that a transient sends through shafts and couplings, and the fatigue they cause.
struct ShaftTorques {
  double concentration = 1;  ///< factor on shear stresses
  double yield = 0;          ///< Pa, in shear; 0: not looked at
  /// Strengths, Pa: tensile; shear amplitudes that 1000 cycles and endless ones take; 0: no fatigue.
  double ultimate = 0, thousand = 0, endurance = 0;
  double cycles = 1e6;  ///< from which on the amplitude is `endurance`
};
struct BucklingStep {
  int modes = 3;
  double speed = 0;
};
struct TransientStep {
  double duration = 0;  ///< s; from 0 unless it continues a previous step
  IntegratorOptions integrator;
  enum class Start {
    rest,
    static_equilibrium,
    unbalance_response,
    mode
  } start = Start::static_equilibrium;
  int mode = 1;  ///< of start = mode: number from the lowest frequency among those of mode_kind
  MotionKind mode_kind = MotionKind::all;
  double mode_amplitude = 1e-5;         ///< its largest displacement, m
  std::string previous, previous_step;  ///< results folder of another run (and its step) whose end
                                        ///< this one starts from
  double speed0 = 0;          ///< rad/s, initial spin of every rotating line times its speed_ratio
  bool speed0_given = false;  ///< 0 may be meant
  std::optional<double> own_speed() const {
    return speed0_given || speed0 != 0 ? std::optional(speed0) : std::nullopt;
  }
  std::optional<double> stop_speed;   ///< stop when the reference spin passes this value
  double amplitude_limit = infinity;  ///< stop when a probe exceeds it, m
  double checkpoint = 60;             ///< wall-clock s between checkpoints; 0 = none
  bool linear = false;  ///< small motions about the steadily turning equilibrium: constant matrices
  std::optional<ShaftTorques> torques;
};

using StepLaw =
    std::variant<StaticStep, ModalStep, CampbellStep, CriticalStep, UnbalanceStep, StabilityStep,
                 CriticalMapStep, HarmonicStep, SensitivityStep, TorsionalStep, BucklingStep,
                 TransientStep, ApiLateralStep, ApiTorsionalStep, BalancingStep>;
struct Step : Entity {
  std::string from;  ///< earlier step whose result it starts from
  StepLaw law;
};

// ---------------------------------------------------------------- output

struct VtkOutput {
  static constexpr int frames_of_a_shape = 24;  ///< a period of a mode or response
  std::string step;
  double t0 = 0, t1 = infinity;
  double every = 0;  ///< s between frames; 0 = use frames_per_revolution or frames
  double frames_per_revolution = 0;
  int frames = 200;  ///< used when nothing else is given
  int max_frames = 5000;
  std::vector<std::string> content{"line", "surface"};
  double deformation_scale = 1;
  int points_around = 32;
  bool one_file = false;  ///< all frames of a set in one VTKHDF file
  Compression compression = Compression::lz4;
  Where where;
};

/// Motion seen from the keyphasor: synchronous amplitudes and phases turn by turn, orbits.
struct TrackingOutput {
  bool on = true;
  int samples = 48;                      ///< a turn
  std::vector<double> orders{1.0, 2.0};  ///< multiples of the speed
  double bandwidth = 0.5;  ///< of the filter at half amplitude, multiples of the speed
  std::vector<double>
      orbit_speeds;  ///< rad/s: orbits are kept when the spin passes these, beside the largest one
  int orbit_turns = 3;  ///< turns an orbit shows
  /// Turns of a Hann window of that bandwidth; 1: each turn by itself.
  int filter_turns() const {
    return std::max(1, static_cast<int>(std::ceil(2.0 / bandwidth - 1e-9)));
  }
};

/// Spectra of the probes block by block (waterfall, full spectrum).
struct SpectraOutput {
  double max_frequency = 0;  ///< rad/s
  int lines = 400;           ///< frequencies from 0 to the highest
  int traces = 200;          ///< most spectra kept for the figures
};

struct Output {
  std::string directory;  ///< default `results/<deck name>`
  double every = 0;       ///< s between rows of time histories; 0 = every accepted step
  std::vector<std::string> quantities{"speed", "probes", "energy"};
  double t0 = -infinity, t1 = infinity;  ///< rows only inside this window, s
  double speed_low = -infinity,
         speed_high = infinity;  ///< rows only while the reference spin is within, rad/s
  double above = 0;  ///< rows only while a probe is displaced by more than this, m; 0 = always
  TrackingOutput tracking;
  std::optional<SpectraOutput> spectra;
  bool csv = true, binary = false, report = true;
  bool replay = true;  ///< in the report
  bool peak_to_peak = false;
  std::vector<VtkOutput> vtk;
};

/// What stands at the head of a report, as given.
struct TitleBlock {
  std::string project, machine, company, author, checked, document, revision, date, notes;
};

/// What `whirl sweep` varies and looks at, where the command line does not say; texts as the
/// options of the same names take them (src/sweep).
struct SweepPlan {
  std::vector<std::string> vary, response, correlation, exceed, worst;
  int samples = 1;
  std::string sampling = "lhs";
  int seed = 1;
  double limit = 0;  ///< s of wall time a run may take; 0: any
};

// ---------------------------------------------------------------- the model

/// Turning of the base about an axis fixed in it and in space: a manoeuvre.
struct BaseTurn {
  Vec3 axis = Vec3::UnitY();  ///< unit vector
  Vec3 about = Vec3::Zero();  ///< a point of the axis, m
  LawPtr rate;                ///< rad/s
};

/// Motion of the base: displacements are relative to it.
struct BaseMotion {
  std::array<LawPtr, 3> acceleration;  ///< along its axes x, y, z, m/s2; null = none
  std::optional<BaseTurn> turn;
};

/// Something that happens during a transient, located on the dense output.
struct Event : Entity {
  enum class Kind { speed, amplitude } kind = Kind::speed;
  double value = 0;            ///< rad/s, m
  std::optional<Location> at;  ///< where the amplitude is looked at
  int direction = 0;           ///< +1 rising, -1 falling, 0 both
  bool stop = false;           ///< ends the run
};

/// The part of a resolved deck that motion depends on, TOML text: without titles, outputs, probes
/// and what ends a run. Each key of the deck declares whether it belongs to it.
struct MovingDeck {
  std::string machine;             ///< all but the steps
  std::vector<std::string> steps;  ///< in their order
};

struct Model {
  int format = 1;
  std::string title;
  std::string deck_path;  ///< as given by the user
  std::string deck_name;  ///< file name without extension
  std::string resolved;  ///< the resolved deck (parameters substituted, includes merged), TOML text
  MovingDeck moving;
  Vec3 gravity = Vec3::Zero();  ///< m/s2, global axes; +x along the shaft
  bool chart_change = true;     ///< nodes tilted beyond 1.5 rad get axes of their own
  bool keep_everything = false;
  double max_element_length = infinity;
  int min_elements = 0;          ///< 0: chosen where the sections say nothing
  double mesh_accuracy = 1e-3;   ///< of frequencies, where the mesh is chosen
  bool consistent_mass = false;  ///< element masses without the corrections that raise their order
  std::vector<Material> materials;
  std::vector<Shaft> shafts;
  std::vector<Disk> disks;
  std::vector<Unbalance> unbalances;
  std::vector<Crack> cracks;
  std::vector<InitialMotion> initial;
  std::vector<Bearing> bearings;
  std::vector<Joint> joints;
  /// Lines that joints hold.
  bool joined(std::size_t shaft) const {
    for (const Joint& j : joints)
      if (j.at.shaft == shaft || (j.to && j.to->shaft == shaft)) return true;
    return false;
  }
  std::vector<Foundation> foundations;
  /// Foundation a bearing stands on, or -1.
  int foundation_of(std::size_t bearing) const {
    for (std::size_t f = 0; f < foundations.size(); ++f)
      for (const auto& c : foundations[f].coordinates)
        if (c.bearing == static_cast<int>(bearing)) return static_cast<int>(f);
    return -1;
  }
  std::vector<PointLoad> loads;
  std::vector<Drive> drives;
  BaseMotion base;
  std::vector<Event> events;
  std::vector<Probe> probes;
  std::vector<Step> steps;
  Output output;
  std::optional<TitleBlock> title_block;
  std::optional<SweepPlan> sweep;
  std::vector<Diagnostic> warnings;
};

}  // namespace whirl::model
