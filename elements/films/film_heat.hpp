// Temperatures of a lubricating film in a steady state, of the pads behind it and of the journal.
//
// Along each pad, in the mean over its length, resolved along the film and across it (zeta = y/h
// from pad to journal; x = R theta):
//   rho c (u dT/dx + v dT/dy) = d/dy (k_e dT/dy) + eta u_y^2 (+ axial part)
//   u = R s zeta - h^2 P'/(2 eta f_x R) zeta (1 - zeta)
// by finite volumes: flows through the cells balance exactly, what leaves at the sides leaves at the
// temperature of its place, convection is upwind; the gaps between the streams of a stretch that has
// ruptured are empty: no flow, no loss, no heat across them. The loss is that of the film's forces: eta
// f_s (R s)^2/h and the flows that the pressure drives. Turbulence mixes heat as it does momentum,
// k_e = k (1 + Pr (f_s - 1)). In the pad, thickness t, conduction along and across; from its back and
// its ends heat goes to the oil about it by a coefficient. At the face of the pad heat flows on; the
// journal's surface has one temperature, at which no heat goes into the shaft.
// Between pads, with T_s of the supply and k = carry_over, the least known number here:
//   fed grooves      T_in = s T_out + (1 - s) T_s,   s = min(k, Q_out/Q_in)
//     hot oil of the film before, no more than it lets out, and fresh oil (Heshmat and Pinkus).
//   flooded pads     T_in - T_s = k (T_out - T_s)
//     a ratio of temperatures (Ettles). The oil about the pads, the bath, is what the films let out and
//     the supply; what a groove takes beyond the film before comes from there, and brings heat back:
//       returned = rho c (Q_in (T_in - T_s) - min(k Q_in, Q_out) (T_out - T_s)).
//     Mixed, the bath has T_b = T_s + sum(returned)/(rho c sum(taken from it)), which stands for a supply
//     of loss/(rho c (T_b - T_s)): energy of all that is within the housing.
//   supply flow Q_s  T_b = T_s + loss/(rho c Q_s), and what is not oil of the film before is of the bath:
//     flooded   min(k Q_out, Q_in) at T_out, the rest at T_b
//     fed       s Q_in at T_out, then up to Q_s/pads at T_s, the rest at T_b
//   Loss less what the pads conduct to a housing of a temperature of its own.
// Heat that leaves films with oil and through pads is loss + returned. Given the flows all of this is linear
// in the temperatures, and is solved at once.
// Oil is kept count of: in a ruptured stretch flows what the film lets go, which wets its share of the
// width, conducts and is warmed there. Films of Reynolds form wherever they want to; what one lacks there
// comes in from the groove where it is the first of its pad (it belongs to Q_in), at the sides where it is
// a later one: fresh, or of the bath (as warm as the oil of the groove where T_b is not known). Of that is
// also what the pressure of a groove drives back into the end of a pad. Their drag
// counts ruptured gaps as full: what is lost there beyond the streams warms oil that comes from the sides
// and leaves again (part of heat, carried and to_oil, of no temperature here).
// A film on a grid (grid_film.hpp): flow, loss and what is conducted across are the means over the length
// of what it finds there; a film that forms in the way between two nodes takes in its share of that, so
// that nothing jumps as its front passes a node; recesses share one temperature with the lands beside
// them, and the oil of a relief track takes no heat.
//
// The oil of the film's equation has at each place the viscosity eta_e with which shear is right,
//   1/eta_e = int dzeta/eta(T).
// Growth of the clearances from the temperature of assembly T_a (alpha: expansions; T_J journal, T_p
// mean of a pad, T_H housing, dT from the back of a pad to its face):
//   pads that tilt  c_b += (R + t_a) alpha_H (T_H - T_a) - t_a alpha_p (T_p - T_a)
//                          - R alpha_J (T_J - T_a),     t_a thickness at the pivot
//                   c_p += R alpha_p (T_p - T_a) - R alpha_J (T_J - T_a) + R^2 alpha_p dT/t
//                   (the last: a pad hotter at its face opens)
//   fixed surfaces  both: R alpha_p (T_p - T_a) - R alpha_J (T_J - T_a), T_p in the mean of all pads
//
// Upwind flows leave an error of first order in the cells: the balance is extrapolated from two grids
// (L. F. Richardson, Phil. Trans. R. Soc. A 226, 1927, doi 10.1098/rsta.1927.0008), which keeps it a
// balance, as all of it is linear. What is left is 0.2 to 0.6 % of the viscosity at a place where it
// was 0.5 to 2 %; finer_settings() tell how much it is.
//
// Limits: steady; no variation along the axis; the velocity is that of one viscosity across the
// film; heat goes neither from pad to pad nor along the shaft.
// Source: Szeri 2011, doi 10.1017/CBO9780511782022, ch. 9; grooves H. Heshmat and O. Pinkus, J. Tribol. 108
// (1986) 241 (mixing inlet temperatures); flooded pads C. M. M. Ettles, J. Lubr. Technol. 102 (1980) 182
// (hot oil carry-over).
#pragma once
#include <elements/films/film_field.hpp>
#include <functional>
#include <span>
#include <vector>

namespace whirl::elements {

struct HeatSettings {
  double density = 900, specific_heat = 1950, conductivity = 0.14;  ///< SI, of the oil
  double supply_temperature = 0;                                    ///< K
  double carry_over = 0.75;                                         ///< k
  bool flooded = false;  ///< pads in a bath; else grooves that are fed
  double supply_flow =
      nan;          ///< of all pads, m3/s; NaN: not known, and the bath is that of carry_over
  double wall = 0;  ///< t, m; 0: nothing goes through the pads; NaN: t_a of each
  double wall_conductivity = 50;  ///< W/(m K)
  double back_coefficient = 100;  ///< W/(m2 K)
  /// Behind the pads, K. NaN: of the bath where supply_flow is given, else that which enters each.
  double housing_temperature = nan;
  double shaft_expansion = 0, pad_expansion = 0, housing_expansion = 0;  ///< 1/K
  double assembly_temperature = 293.15;                                  ///< K
  /// Viscosity at a temperature, Pa s, and where it is known, K.
  std::function<double(double)> viscosity;
  double coldest = 0, hottest = infinity;
  std::size_t cells = 48, layers = 16, wall_layers = 4;  ///< along the pad, across film and pad
  /// Grids, each of half the cells and wall layers of the one before it, from which the balance is
  /// extrapolated (what the layers leave falls with their square); 1: none.
  std::size_t grids = 2;

  /// Within the range of the law.
  double viscosity_near(double T) const;
};

/// A pad whose film is asked about. The film must live as long.
struct HeatPad {
  const FiniteJournal* film;
  std::size_t pad;  ///< of the film
  FilmPoint point;
  double thickness_at_pivot = nan;  ///< t_a, m; NaN: a fixed surface
};

struct PadTemperatures {
  double in = 0, out = 0;                     ///< of the oil, K
  double hottest = 0, hottest_at = 0;         ///< of the face of the pad, K, and where, rad
  double film_hottest = 0, film_coldest = 0;  ///< anywhere in the film, K
  double pad = 0;         ///< mean of the pad, K; that of the oil about it without wall
  double through = 0;     ///< dT, K
  double to_pad = 0;      ///< heat that goes into the pad, W
  double to_journal = 0;  ///< and into the journal, W
  double heat = 0;        ///< loss in its film, W
  double carried = 0;  ///< rho c times what leaves (at the end and the sides, less what enters), W
  double hot_share = 0;  ///< of what enters: oil of the film before
  /// What its oil takes out of the film, at the sides and, where the next pad does not take it over, at
  /// the end, over oil as fed, W. Of all pads: with to_pad and to_journal the loss and what is returned.
  double to_oil = 0;
  double returned = 0;     ///< heat that it takes in with oil of the bath, over oil as fed, W
  double beyond = 0;       ///< rho c times what enters and is not oil of the film before, W/K
  double beyond_at = nan;  ///< and how warm it is, K; NaN: oil as fed
  /// At the cells, rad, K, K, Pa s: face, mean across the film, eta_e.
  std::vector<double> theta, face, film, viscosity;
};

struct HeatBalance {
  std::vector<PadTemperatures> pads;  ///< in the order asked
  double journal = 0;                 ///< K
  /// The oil about the pads, mixed, K; NaN: grooves are fed, and no flow is given.
  double bath = nan;
  double mixed = nan;  ///< what leaves the films, mixed, K; likewise
  /// Of all pads, m3/s: that given, or with which the bath would be as warm; NaN: no such flow.
  double supply_flow = nan;
  /// Over the assembled clearance: c_b and c_p, one a pad. Not limited.
  std::vector<double> growth, pad_growth;
};

/// Twice the cells and layers, from three grids: to compare with.
HeatSettings finer_settings(const HeatSettings& s);

/// @pre at least one pad, in any order; all journals inside their films and of one spin. Cells and
/// layers that halve s.grids - 1 times.
HeatBalance balance_heat(std::span<const HeatPad> pads, const HeatSettings& s);

/// The balance as the film keeps it (FiniteJournal::kept_from): growths, and ln(eta_e/viscosity) at
/// the knots, for the pad with number k. values: of size kept_each().
void keep_heat(const HeatBalance& b, std::size_t k, const HeatPad& pad, std::span<double> values);

/// Clearances are not followed below this part of the assembled one.
inline constexpr double least_clearance = 0.05;

}  // namespace whirl::elements
