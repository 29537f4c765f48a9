// Where a grid of speeds or frequencies is made finer, so that no peak of a response is too sharp
// for it.
#pragma once
#include <analysis/spectra/motion.hpp>
#include <results/frequency.hpp>
#include <vector>

namespace whirl::steps {

/// Kinds of motion that the forces drive by themselves, not by what couples them. Of others those that
/// nothing damps are left out: their peaks are of rounding.
struct Driven {
  bool lateral = false, torsional = false, axial = false;
};

/// Puts natural frequencies at a speed, and places about them in multiples of their half width, into
/// a grid of frequencies, rad/s, ascending and apart by 1e-7 at least. Where they cannot be found
/// W15 says so and the grid stays.
/// @pre the grid ascends and is not empty.
void refine_at_frequencies(results::FrequencyStep& s, analysis::Motion motion, Driven driven,
                           double speed, std::vector<double>& grid);
/// Damped critical speeds of an order into a grid of speeds of either sign; likewise.
void refine_at_criticals(results::FrequencyStep& s, analysis::Motion motion, Driven driven,
                         double order, std::vector<double>& grid);
/// Speeds at which the steady motions of a rotor have their peaks whose matrices turn with it
/// (RotatingAxes::poles), likewise.
void refine_at_poles(results::FrequencyStep& s, std::vector<double>& grid);

}  // namespace whirl::steps
