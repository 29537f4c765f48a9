// The linearised bearings of a state: eccentricity, attitude, K and C of every film, seal, table,
// contact, nonlinear spring and rolling bearing.
#pragma once
#include <run/job.hpp>

#include <optional>
#include <span>

namespace whirl::results {

/// A pad's face: a stretch of a circle, its radius less that of the journal, and where its centre
/// stands.
using PadDrawing = assembly::TiltingPads::Face;

/// The pads of a tilting-pad bearing at an equilibrium.
struct PadResults {
  double spin = 0;             ///< of the shaft, rad/s
  std::vector<double> pivots;  ///< rad
  std::vector<bool> gives;     ///< of the pivots: they have a compression in `full`
  std::vector<elements::PadStanding> pads;
  std::vector<double> others;  ///< N: loads in another balance of the tilt, NaN: there is none
  std::vector<PadDrawing> drawings;
  elements::PadCoefficients full;
  std::vector<double> ratios;  ///< frequencies over the speed; the first is 1
  std::vector<elements::ReducedCoefficients> reduced;  ///< one a ratio

  /// N: a pad that carries less has been left by the journal.
  double least_load() const;
  bool carries(std::size_t pad) const;
};

/// The films of a journal bearing of finite length at an equilibrium, one a pad.
struct FilmResults {
  std::vector<elements::FilmStanding> pads;
  std::vector<elements::FilmField> fields;
  std::optional<elements::HeatBalance> heat;
  double face_error =
      nan;  ///< K: by how much the hottest faces differ on a finer grid of the balance
  /// Of films with one profile along the axis, one a pad: by how much the largest pressure and the side
  /// flow differ from those of a film that is solved along the axis too, as isoviscous films at the same
  /// place; of the pad's own. Empty: no such profile.
  std::vector<double> pressure_error, flow_error;
  double effective_temperature = nan;  ///< of the oil with the mean viscosity, K; NaN: no heat
  std::vector<double> clearances;      ///< as assembled, one a pad, m
  double viscosity = 0;                ///< mean, Pa s
  double reynolds = 0;                 ///< rho R |s| c/eta of the largest of them
  double transition =
      0;  ///< Reynolds number from which on vortices and turbulence are to be expected
  bool laminar = true;  ///< as the deck has it
};

/// The floating ring of a bearing at an equilibrium.
struct RingResults {
  double shaft_spin = 0, spin = 0;  ///< rad/s
  elements::RingStanding standing;
  bool turns = true;  ///< not pinned
  /// Spin at which the supply no longer reaches the inner film, rad/s; infinity: not known.
  double starved_spin = infinity;
  elements::PadCoefficients full;
  std::vector<double> ratios;  ///< frequencies over the speed; the first is 1
  std::vector<elements::ReducedCoefficients> reduced;  ///< one a ratio
};

/// One bearing whose coefficients depend on where the shaft runs: F = -K r - C r' on the shaft, (y,
/// z), at an equilibrium. Place and attitude are measured from the middle of the bearing, the
/// attitude from the direction of the load (opposite to the force on the shaft) in the sense y ->
/// z. Rolling bearings in a turning rotor: means over a pass.
struct SupportCoefficients {
  std::string name;
  double spin = 0;                          ///< of the shaft, rad/s
  double load = 0;                          ///< on the bearing, lateral, N
  Vec2 place = Vec2::Zero();                ///< shaft against housing, m
  double clearance = nan;                   ///< m; NaN where there is none
  double attitude = nan;                    ///< deg, -180 to 180; NaN without load or displacement
  double sommerfeld = nan;                  ///< films: eta N L D (R/c)^2/W, N in rev/s
  Mat2 K = Mat2::Zero(), C = Mat2::Zero();  ///< N/m, N s/m
  std::optional<Matrix<5>>
      K5;  ///< rolling bearings: in x, y, z, ry, rz at the place of the bearing; N, m, rad
  /// Of a rigid rotor on bearings like this one alone (Lund; Routh's criterion): the share of its
  /// mass on this bearing beyond which the equilibrium is unstable at this speed, kg, and whirl
  /// frequency over speed there. NaN: no mass makes it unstable.
  double threshold_mass = nan, whirl_ratio = nan;
  /// Of journals of finite length: how far K and C are from those on the finest grid
  /// (elements::JournalSurface::max_nodes) at the same place, the larger of both in the Frobenius
  /// norm; of grids more than half as fine, from those on one half as fine, which is more than the
  /// error. NaN: no grid.
  double grid_error = nan;
  /// Of journals, pads, rings and dampers with one profile of the pressure along their axis: how far K and C are from
  /// those of a film that is solved along the axis too (grid_film.hpp; its own error is about 1e-3), at
  /// the same place and as isoviscous films, in the same norm. NaN: no such profile.
  double axial_error = nan;
  /// Of films with heat: how far K and C are from those with the viscosities and clearances of a
  /// finer grid of the heat balance, of journals under the same load, of pads that tilt at the same
  /// place, in the same norm. NaN: no heat.
  double heat_error = nan;
  /// Of tilting pads; K and C are then what the shaft sees at the frequency of its own spin, with
  /// the pads following.
  std::optional<PadResults> pads{};
  std::optional<FilmResults> films{};
  /// Of floating rings, likewise; the clearance is then that of both films together.
  std::optional<RingResults> ring{};
};

/// In the order of the deck; empty when there is none.
std::vector<SupportCoefficients> calc_support_coefficients(const run::Job& job,
                                                           const run::StepState& s);
/// Stiffness of one support at a state in (x, y, z, rx, ry, rz), -d(force, moment)/d(displacement,
/// tilt) on the shaft at the place of the bearing, N/m, N, N m, rad; the spin (rx) resists nothing.
/// By differences of fourth order.
Matrix<6> support_stiffness(const run::Job& job, const run::StepState& s, std::size_t bearing);
/// The largest grid error of a list into the summary of a step; "coefficients right to 2e-4 (film
/// grid)", what the profile along the axis and the grid of the heat balance leave, or nothing where no bearing has a grid.
std::string report_grid_error(io::Value& summary, std::span<const SupportCoefficients> list);
/// A row each; empty title and no rows when there is none.
io::Table support_table(std::span<const SupportCoefficients> list);
/// What stands beside the coefficients where there are tilting pads.
struct PadTables {
  io::Table pads;     ///< a row a pad: how it stands
  io::Table reduced;  ///< a row a frequency
  io::Table full;     ///< an entry a row: shaft and pads
  bool empty() const { return pads.rows.empty(); }
};
PadTables pad_tables(std::span<const SupportCoefficients> list);
/// Of the pads that carry nothing a line a bearing: "bearing 'DE': pads 1 and 2 carry nothing, ..."; of
/// those with two balances a line each.
std::vector<std::string> unloaded_pads(std::span<const SupportCoefficients> list);
/// A section through each tilting-pad bearing: journal, pads with their films, pivots and loads.
std::vector<plot::Figure> draw_pads(const std::string& name,
                                    std::span<const SupportCoefficients> list);
/// A row a pad, and one for the whole bearing: loss, flow, thickness, pressure, temperatures.
io::Table film_table(std::span<const SupportCoefficients> list);
/// Pressure, thickness and temperatures of each film bearing, unrolled and round the journal.
std::vector<plot::Figure> draw_films(const std::string& name,
                                     std::span<const SupportCoefficients> list);
/// Loss, flow and temperatures against speed; no figure where there are no films. list: the states
/// of all bearings, speed by speed.
std::optional<plot::Figure> draw_film_trends(const std::string& name,
                                             std::span<const SupportCoefficients> list);
/// Films that are laminar in the deck and beyond their transition, the worst state of each bearing:
/// warning W03.
void warn_of_turbulence(run::Job& job, const std::string& step,
                        std::span<const SupportCoefficients> list);
/// A line for each bearing with heat: of flooded pads how warm the oil about them is, and for which supply that
/// stands; of fed grooves those that take in less hot oil than carry_over, as the pads before give no more.
std::vector<std::string> groove_lines(const run::Job& job,
                                      std::span<const SupportCoefficients> list);
/// Flooded pads that would have to be fed with oil hotter than all that leaves their films, in the mean; the
/// worst state of each bearing: warning W03.
void warn_of_hot_bath(run::Job& job, const std::string& step,
                      std::span<const SupportCoefficients> list);
/// What a motion in time left as it began: of each film with heat the viscosity that its balance in
/// the last state would have over the one that acted, in the mean, into the summary; more than 5 %
/// apart: warning W03.
/// linear: small motions, which no temperatures follow.
void report_kept_films(run::Job& job, const std::string& step, const system::State& end,
                       bool linear);
/// Coefficients that the shaft sees with what a bearing has inside following: a row a frequency.
io::Table reduced_table(std::string title);
/// ratios: frequencies over the speed, one for each of `reduced`.
void add_reduced(io::Table& t, const SupportCoefficients& c, std::span<const double> ratios,
                 std::span<const elements::ReducedCoefficients> reduced);
/// The same where there are floating rings.
struct RingTables {
  io::Table rings;    ///< a row a bearing: how its ring stands
  io::Table reduced;  ///< a row a frequency
  io::Table full;     ///< an entry a row: shaft and ring
  bool empty() const { return rings.rows.empty(); }
};
RingTables ring_tables(std::span<const SupportCoefficients> list);
/// Of the rings that keep the supply from their inner film a line each.
std::vector<std::string> starved_rings(std::span<const SupportCoefficients> list);
/// A section through each bearing with a floating ring: journal, ring, housing.
std::vector<plot::Figure> draw_rings(const std::string& name,
                                     std::span<const SupportCoefficients> list);
/// Five rows a rolling bearing.
io::Table rolling_stiffness_table(std::span<const SupportCoefficients> list);

}  // namespace whirl::results
