// The machine of a step whose shafts all turn the other way.
#pragma once
#include <results/frequency.hpp>

namespace whirl::results {

/// The linearisation of the step with every spin reversed: at the reference speed Omega what the
/// step's own is at -Omega.
analysis::Linearizer turned_back(FrequencyStep& s);

}  // namespace whirl::results
