// Critical speeds in a range of speeds that may be negative.
#pragma once
#include <analysis/spectra/critical.hpp>
#include <results/frequency.hpp>
#include <vector>

namespace whirl::steps {

/// Critical speeds between two reference speeds of either sign, rad/s, in ascending order. Those
/// below zero, with their sign, are those of the machine whose shafts all turn the other way. Of
/// `options` the range of speeds is set here.
/// @pre from <= to.
/// @throws Error as analysis::critical_speeds.
std::vector<analysis::Critical> criticals_between(results::FrequencyStep& s,
                                                  analysis::CriticalOptions options, double from,
                                                  double to);

}  // namespace whirl::steps
