// Standards that judge the response to unbalance: zones of vibration (ISO 20816, ISO 7919) and balance
// grades (ISO 21940-11). The deck gives the limits and their source.
#pragma once
#include <analysis/response/unbalance.hpp>
#include <results/frequency.hpp>
#include <vector>

namespace whirl::steps {

/// Major axis, m, of all frequencies together, as if their largest fell on one instant.
double peak_to_peak(const analysis::SteadyPoint& x, std::size_t probe);

/// Zone of every probe where it comes nearest to the borders, over the operating speeds: a table, and
/// colours in the figures of the probes, which stand in the section already. r: with the peaks within
/// the operating speeds among its points; where a peak has no bound there, the zone is D.
void add_zones(results::FrequencyStep& s, const analysis::UnbalanceResponse& r,
               const std::vector<analysis::ResponseProbe>& probes,
               const std::vector<analysis::ResponsePeak>& peaks, const model::UnbalanceStep& law);

/// Unbalances of each shaft, vectors at each place, against a balance grade.
void add_grades(results::FrequencyStep& s, const model::UnbalanceStep& law);

}  // namespace whirl::steps
