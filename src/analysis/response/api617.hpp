// Numbers that an API lateral report rests on (API Standard 617, API RP 684), as plain formulas: what
// is compared with them is computed elsewhere. SI throughout; where a standard writes a formula in
// other units, its constants are turned here.
#pragma once
#include <core/types.hpp>

#include <string>
#include <vector>

namespace whirl::analysis {

/// Unbalance factor * constant * W/N, kg m. API: constant 6350 g mm rpm/kg, of the residual unbalance
/// of one plane; factor 2 in response analyses. W in kg, N in rad/s.
double api_unbalance(double factor, double constant, double W, double N);

/// Vibration limit, peak to peak, m: cap sqrt(of_speed/N), at most cap. API: cap 25.4 um, of_speed
/// 12,000 rpm. N in rad/s.
double vibration_limit(double cap, double of_speed, double N);

/// Factor that brings a response to its limit: limit/amplitude, at most `most`.
double scale_factor(double limit, double amplitude, double most);

/// Separation margins against amplification factors: none below `damped`; else below the range
/// factor (1 - 1/(AF - offset)), above it the same and `above`. API RP 684: 2.5, 0.17, 1.5, 0.10.
/// fixed: the same share on both sides, whatever AF from `damped` on; nan: by amplification.
struct MarginRule {
  double damped = 2.5, factor = 0.17, offset = 1.5, above = 0.10, fixed = nan;
  double required(double amplification, bool above_the_range) const;
};

/// A stage that drives whirl. Radial (Wachel): factor T/(D H) rho_d/rho_s, axial (Alford): factor
/// T/(D H), with the torque T = constant P/N, N in rpm, constant 9.55.
struct CrossCoupledStage {
  bool axial = false;
  double power = 0, speed = 0;        ///< W, rad/s
  double diameter = 0, width = 0;     ///< impeller or blades: diameter, width or height, m
  double suction = 1, discharge = 1;  ///< densities, kg/m3
  double anticipated(double radial_factor, double axial_factor, double constant) const;  ///< N/m
};

/// Limit of the critical speed ratio against the mean density of the gas, by straight lines between
/// points; above the last density nothing is in region A.
struct RatioBoundary {
  std::vector<double> density, ratio;  ///< kg/m3, ascending; -
  double at(double rho) const;         ///< 0 beyond the table
};

/// Places of unbalance for a mode, after the pictures of API RP 684: at the antinodes of its shape.
struct ModePlane {
  double s = 0;         ///< along the shaft, m
  double weight = 0;    ///< kg
  bool turned = false;  ///< at 180 degrees
};
enum class ModeForm { one_lobe, conical, several_lobes, overhung };
std::string describe(ModeForm form);
struct ModePlanes {
  ModeForm form = ModeForm::one_lobe;
  std::vector<ModePlane> planes;  ///< ascending s
};
/// What stands on the shaft that a mode bends.
struct JournalWeights {
  std::vector<double> s, weight;  ///< journals, ascending: place, m, and static load, kg
  double overhang_left = 0, overhang_right = 0;  ///< mass outside the outer journals, kg
  double motion_left = 0, motion_right = 0;      ///< share of the mode's kinetic energy there
};
/// s, u: the shape at ascending places (m; real, any scale). Between the outer journals every lobe
/// has its antinode; one lobe takes the load of all journals, of two each the load of the nearest
/// journal, the second one turned; of several each that of the nearest journal, turned as the shape
/// is. A mode with more than half of its kinetic energy outside the journals is overhung: the
/// unbalance is that of the overhung mass, at its largest deflection, on each side with at least a
/// quarter of the energy.
/// @pre at least one place and one journal
ModePlanes place_unbalance(const std::vector<double>& s, const std::vector<double>& u,
                           const JournalWeights& journals);

}  // namespace whirl::analysis
