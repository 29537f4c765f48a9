// The only translator from Model + Mesh to System. Absent physics is an absent batch: what the deck
// does not contain is not added.
#pragma once
#include <assembly/film_grid.hpp>
#include <meshes/mesh.hpp>
#include <model/model.hpp>
#include <elements/films/film_heat.hpp>
#include <elements/films/floating_ring.hpp>
#include <elements/films/tilting_pad.hpp>
#include <system/system.hpp>
#include <functional>
#include <string>
#include <vector>

namespace whirl::assembly {

/// How results read a state: node states and reactions (residual at held unknowns,
/// system::System::residual).
using NodeAt = std::function<const system::NodeState&(Index)>;
using ReactionAt = std::function<double(Index unknown)>;

/// Force of a support on the shaft, N, global axes (and moment, N m, where it has one). Of the
/// context the time and whether the mean over the revolution is asked for.
struct SupportForce {
  using Law = std::function<Vec3(const NodeAt&, const system::Context&, const ReactionAt&)>;
  std::string name;  ///< of the bearing
  Law force;
  Law moment{};  ///< N m, about the place of the support; null where it gives none
};

/// What a joint does: its load on the line of `at`, about its place, and its coordinates.
struct JointResult {
  std::string name;
  SupportForce::Law force, moment;  ///< N, N m, global axes; moment null: it gives none
  std::vector<Index> angles;        ///< scalar nodes, rad: `at` against the other, about its axes
  Index slide = -1;                 ///< scalar node, m
};

/// How a support with a gap stands: films before their clearance is used up, contacts before they
/// close, magnets before the shaft stands in their poles.
struct SupportCondition {
  static constexpr double believed = 0.99;  ///< eccentricity beyond which a film is not believed
  struct State {
    bool film = false, magnet = false;  ///< neither: a contact
    double gap = 0, displacement = 0;   ///< m
    double load = 0,
           capacity =
               0;  ///< N, of films and contacts; capacity of a film: at the believed eccentricity
  };
  std::size_t bearing = 0;  ///< of the model
  std::string name;
  Where where;
  std::function<State(const NodeAt&)> state;
  double sommerfeld = 0;  ///< of a film: eta L D (R/c)^2, N s; times the speed in rev/s over the
                          ///< load it is the Sommerfeld number
  /// What counts against the gap where it is not the distance from the middle, m; null: that.
  std::function<double(const NodeAt&)> reach{};
  /// More of where it stands, for messages: "pad 4 ..."; null: there is no more.
  std::function<std::string(const NodeAt&)> detail{};
};

/// The pads of a tilting-pad bearing.
struct TiltingPads {
  std::size_t bearing = 0;     ///< of the model
  std::vector<double> pivots;  ///< rad, one a pad
  std::vector<std::vector<Index>>
      unknowns;               ///< scalar nodes of each pad: tilt, pressed if it gives
  std::vector<bool> follows;  ///< an elastic pivot without mass: it follows the film at once
  std::vector<bool> light;    ///< a tilt without inertia: likewise
  std::function<std::vector<elements::PadStanding>(const NodeAt&)> standing;
  /// The face of a pad as it stands, for pictures.
  struct Face {
    double from, to;  ///< rad
    double radius;    ///< less that of the journal, m
    Vec2 centre;      ///< against the middle of the bearing, m
  };
  std::function<std::vector<Face>(const NodeAt&)> faces;
  /// grid: of the films; without points that of the bearing.
  std::function<elements::PadCoefficients(const NodeAt&, const FilmGrid& grid)> coefficients;
  /// N, one a pad that carries little: what it would carry in another stable balance of its tilt,
  /// journal and pivot where they are; NaN: there is none, or it carries much in one of them.
  std::function<std::vector<double>(const NodeAt&)> other_loads;
};

/// The films of a journal bearing of finite length, one a pad, and their heat.
struct FilmBearing {
  std::size_t bearing = 0;  ///< of the model
  bool heated = false;
  std::ptrdiff_t kept_from = -1;        ///< of what elements keep; -1: it keeps nothing
  std::size_t kept = 0, kept_each = 0;  ///< how much in all, and for each pad
  /// Empty where the journal is outside a film.
  std::function<std::vector<elements::FilmStanding>(const NodeAt&)> standing;
  /// Of the films on another grid, at the same place; those without heat as assembled.
  std::function<std::vector<elements::FilmStanding>(const NodeAt&, const FilmGrid&)> standing_on;
  /// @pre the journal is inside all films (also heat).
  std::function<std::vector<elements::FilmField>(const NodeAt&)> fields;
  /// The balance that the state would have, which is that in the state where it is in equilibrium.
  /// @pre heated.
  std::function<elements::HeatBalance(const NodeAt&)> heat{};
  /// The same on a finer grid, and what it would have kept.
  struct FinerHeat {
    elements::HeatBalance balance;
    std::vector<double> kept;
  };
  std::function<FinerHeat(const NodeAt&)> finer_heat{};
  double viscosity = 0;  ///< of reference: what is kept are logarithms over it, Pa s
  /// Of the oil with a viscosity in Pa s, K.
  std::function<double(double)> temperature_of{};
};

/// The floating ring of a bearing.
struct FloatingRingBearing {
  std::size_t bearing = 0;      ///< of the model
  std::vector<Index> unknowns;  ///< scalar nodes: y, z, spin over spin_unit, temperatures
  double spin_unit = 1;         ///< rad/s a m
  std::function<elements::RingStanding(const NodeAt&)> standing;
  /// Of shaft and ring, (y, z) of both, spin, temperatures: on all but a held spin. grid: of the films;
  /// without points that of the bearing.
  std::function<elements::PadCoefficients(const NodeAt&, const FilmGrid& grid)> coefficients;
};

/// The oil of a film that conserves mass, where the step follows it.
struct CarriedOil {
  std::string bearing;           ///< for messages: "bearing 'DE'"
  std::vector<Index> unknowns;   ///< places in q, one a cell
  std::vector<Index> following;  ///< scalar nodes of pads that tilt
  /// Unknowns of the cells, m, and of pads with the oil in balance and the journal where it is; NaN where
  /// none is found. What of a pad has inertia stays where it is.
  struct Balance {
    std::vector<double> content, followed;
  };
  std::function<Balance(const NodeAt&)> balanced;
  /// Those of full cells without pressure, journal and pads where they are, m.
  std::function<std::vector<double>(const NodeAt&)> full;
  /// Of a film on a grid along the axis too, whose cells are not those of statics: how many there are
  /// ("40 x 6 cells"), and how far the film with its oil in balance stands from that of statics where
  /// journal and pads are, of the force; NaN: there is no balance.
  std::string grid;
  std::function<double(const NodeAt&)> off_statics;
};

/// What the controller of a magnetic bearing does.
struct MagneticControl {
  /// The loop of one axis, opened behind its sensor.
  struct Loop {
    Vec2 axis = Vec2::UnitX();     ///< in (y, z)
    meshes::Place shaft, housing;  ///< what the sensor looks at
    Index signal = -1;             ///< scalar node of the sensor; -1: it follows at once
    double unit = 1;               ///< m, of that signal
    /// What stands on the right side of these nodes' rows for a displacement added to the signal,
    /// N/m.
    std::vector<std::pair<Index, double>> entry;
  };
  std::size_t bearing = 0;          ///< of the model
  std::array<Index, 2> currents{};  ///< scalar nodes, A per current_unit
  double current_unit = 1;
  double bandwidth = 0;  ///< rad/s: faster motions of a rigid rotor the loop moves by less than 1 %
  std::array<Loop, 2> loops;
  /// How an axis stands.
  struct Standing {
    double displacement = 0, current = 0, force = 0;  ///< m at the magnet, A, N
    double capacity = infinity;  ///< N, towards the side it pulls to: where current or force ends
  };
  std::function<std::array<Standing, 2>(const NodeAt&, const system::Context&)> standing;
  /// Force on the shaft, N, for small harmonic motions of it at the frequency w, rad/s, alike at
  /// magnet and sensor: F = -Z r in (y, z). Not finite where an integrator acts and w = 0.
  std::function<Eigen::Matrix2cd(const NodeAt&, const system::Context&, double w)> stiffness;
};

/// How far a crack is open, 0 (closed) to 1; of one with a length its mean.
struct CrackOpening {
  std::string name;
  std::function<double(const NodeAt&, const system::Context&)> opening;
};

/// Load of every element of a rolling bearing.
struct RollingLoads {
  struct Element {
    double angle, load;
  };  ///< rad from +y towards +z, 0 to 2 pi; N
  std::string name;
  std::function<std::vector<Element>(const NodeAt&)> loads;
};

/// Torque of a drive on its shaft, N m: of a torque curve, or the reaction of a prescribed angle.
struct DriveTorque {
  std::string name;
  std::function<double(const NodeAt&, double t, const ReactionAt&)> torque;
};

/// What a drive counts turns from: the integral of a speed controller, or a prescribed angle, begins
/// where begin() was called last: time, s, and angle of its node, rad, whole turns included.
struct TurnCount {
  std::string drive;
  Index node = 0;
  std::function<void(double time, double angle)> begin;
  LawPtr angle;  ///< that is prescribed; null: of a speed controller
};

/// A line without polar inertia that nothing turns: it goes on with the spin it has where begin() was
/// called last: time, s, angle, rad, whole turns included, and spin, rad/s.
struct CoastingLine {
  std::string line;
  Index node = 0;
  std::function<void(double time, double angle, double spin)> begin;
};

/// Spin every node of a line starts with: from a prescribed angle law of the step, else
/// Shaft::spin0.
struct LineSpin {
  bool prescribed = false;
  LawPtr angle;      ///< when prescribed
  double spin0 = 0;  ///< rad/s
};

/// What a shaft element (stiffness, inertia, damping of its material) adds to the force in X of its
/// two nodes.
using ElementForce = std::function<void(const system::System&, const system::Nodes<2>&,
                                        const system::Context&, system::ForceX<14>&)>;

struct Built {
  system::System system;
  std::vector<ElementForce> element_forces;  ///< one an element of the mesh
  std::vector<double> breakpoints;  ///< of all laws (holds, loads, drives, unbalance factors),
                                    ///< sorted: integrator steps land on them
  std::vector<Pace> paces;          ///< of the same laws: integrator steps keep them
  std::vector<SupportForce> support_forces;  ///< one a bearing of the model, in its order
  std::vector<JointResult> joints;           ///< one a joint of the model, in its order
  std::vector<std::vector<std::size_t>>
      support_terms;  ///< of each bearing the terms of the system in which its law stands, without
                      ///< constant springs and dampers; they may hold other bearings' elements
  std::vector<SupportCondition> conditions;
  struct Fine {
    Index node;
    double length;
  };
  std::vector<Fine> fine;  ///< nodes whose lateral motion, scalars that themselves must be right to
                           ///< a small part of a length: journals, rings, to their clearance, m
  std::vector<CrackOpening> cracks;  ///< one a crack of the model, in its order
  std::vector<RollingLoads> rolling_loads;
  std::vector<TiltingPads> tilting_pads;
  std::vector<FilmBearing> films;
  std::vector<FloatingRingBearing> floating_rings;
  std::vector<CarriedOil> carried_oil;
  std::vector<MagneticControl> magnetic_controls;
  std::vector<DriveTorque> drive_torques;
  std::vector<TurnCount> turn_counts;
  std::vector<CoastingLine> coasting;
  std::vector<LineSpin> spins;  ///< one a line
  Index reference = 0;  ///< node whose spin is the speed axis: the first drive's, else the first
                        ///< node of the first rotating line
  std::vector<std::string> notes;  ///< what was idealised otherwise than the deck says it, one line
                                   ///< each, for the summary
  std::vector<double>
      table_frequencies;  ///< rad/s, in no order: of supports with coefficients against the
                          ///< frequency of the motion (Context::frequency)
  std::vector<Index> axially_free;  ///< lines whose motion along their axis nothing resists or
                                    ///< loads, one of each group that moves together: equilibria
                                    ///< hold them (analysis::SteadyRotation)
  std::vector<std::string>
      held;  ///< motions that nothing resists and that are held for it, one line each
  std::vector<std::string>
      left_out;  ///< physics this scene does not need, one line each, for the summary
  std::vector<std::string> simpler;  ///< general kernels that simpler ones stand for here;
                                     ///< Model::keep_everything keeps them
};

/// Steps with one key have the same system: the same drives act, and the same free motions are held.
std::string system_key(const model::Model& model, const model::Step& step);

/// Whose films that conserve mass have oil of their own: those that a step follows, or none, all being of
/// the momentary state.
enum class FilmOil { followed, momentary };

/// step: name of the step whose drives act (drives without a step always act) and that decides which
/// free motions must be held; "" = only drives without a step, and the needs of all steps. Unknowns are the
/// same with and without oil.
/// @throws Error (Exit::deck) unrestrained motion named with its shaft, attachments off the shaft,
/// impossible bodies.
/// @pre mesh = make_mesh(model).
Built build_system(const model::Model& model, const meshes::Mesh& mesh,
                   const std::string& step = {}, FilmOil oil = FilmOil::followed);

}  // namespace whirl::assembly
