// The limit of stability over a parameter of the deck.
#pragma once
#include <analysis/spectra/stability.hpp>
#include <results/frequency.hpp>

namespace whirl::steps {

/// The deck of a run with another value of a map's parameter. E89: nothing depends on it.
/// @throws Error (E89) when nothing in the deck depends on the parameter.
model::Model variant_of(const run::RunOptions& options, const model::Step& step,
                        const model::StabilityMap& map, const std::string& value);
/// E89: such a rotor has bands of instability, over which no map is drawn.
Error no_map_of_bands(const model::Step& step);
/// Figures and tables of the stability over a parameter; returns what to add to the step's line.
/// @throws Error (E89) when the deck of the run cannot be read again with another value.
std::string add_stability_map(results::FrequencyStep& s, const model::StabilityMap& map,
                              const analysis::StabilityOptions& options);

}  // namespace whirl::steps
