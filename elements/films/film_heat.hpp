// Temperatures of a lubricating film in a steady state, of the pads behind it and of the journal.
//
// Along each pad, in the mean over its length, resolved along the film and across it (zeta = y/h
// from pad to journal; x = R theta):
//   rho c (u dT/dx + v dT/dy) = d/dy (k_e dT/dy) + eta u_y^2 (+ axial part)
//   u = R s zeta - h^2 P'/(2 eta f_x R) zeta (1 - zeta)
// by finite volumes: flows through the cells balance exactly, what leaves at the sides leaves at the
// temperature of its place (in a stretch that has ruptured the gaps between the streams count as
// filled, as they do in the drag; those of a film that conserves mass are empty: no flow, no loss, no
// heat across them), convection is upwind. The loss is that of the film's forces: eta
// f_s (R s)^2/h and the flows that the pressure drives. Turbulence mixes heat as it does momentum,
// k_e = k (1 + Pr (f_s - 1)). In the pad, thickness t, conduction along and across; from its back and
// its ends heat goes to the oil about it by a coefficient. At the face of the pad heat flows on; the
// journal's surface has one temperature, at which no heat goes into the shaft. Between pads
//   T_in = s T_out + (1 - s) T_supply
// with the share s of hot oil in what enters, a number of experience: the least known one here. Given the flows all of this is linear in the temperatures, and is solved at once.
// A film on a grid (grid_film.hpp): flow, loss and what is conducted across are the means over the length
// of what it finds there; recesses share one temperature with the lands beside them, and the oil of a
// relief track takes no heat.
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
// Source: Szeri 2011, doi 10.1017/CBO9780511782022, ch. 9; mixing in grooves H. Heshmat and O.
// Pinkus, J. Tribol. 108 (1986) (mixing inlet temperatures).
#pragma once
#include <elements/films/film_field.hpp>
#include <functional>
#include <span>
#include <vector>

namespace whirl::elements {

struct HeatSettings {
  double density = 900, specific_heat = 1950, conductivity = 0.14;  ///< SI, of the oil
  double supply_temperature = 0;                                    ///< K
  double carry_over = 0.75;          ///< s, hot oil in what enters a pad
  double wall = 0;                   ///< t, m; 0: nothing goes through the pads; NaN: t_a of each
  double wall_conductivity = 50;     ///< W/(m K)
  double back_coefficient = 100;     ///< W/(m2 K)
  double housing_temperature = nan;  ///< of the oil about the pads, K; NaN: that which enters each
  double shaft_expansion = 0, pad_expansion = 0, housing_expansion = 0;  ///< 1/K
  double assembly_temperature = 293.15;                                  ///< K
  /// Viscosity at a temperature, Pa s, and where it is known, K.
  std::function<double(double)> viscosity;
  double coldest = 0, hottest = infinity;
  std::size_t cells = 48, layers = 16, wall_layers = 4;  ///< along the pad, across film and pad
  /// Grids, each of half the cells and layers of the one before it, from which the balance is
  /// extrapolated; 1: none.
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
  /// At the cells, rad, K, K, Pa s: face, mean across the film, eta_e.
  std::vector<double> theta, face, film, viscosity;
};

struct HeatBalance {
  std::vector<PadTemperatures> pads;  ///< in the order asked
  double journal = 0;                 ///< K
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
