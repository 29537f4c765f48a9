// Damped critical speeds of an API lateral report, held against the separation margins: those that
// no response of the report shows as a peak count as well.
#pragma once
#include <results/compliance.hpp>
#include <steps/api_models.hpp>

namespace whirl::steps {

/// Of the lateral modes of the set's machine as given whose frequency is that of the rotor's speed
/// somewhere between the speeds of the report, that an unbalance drives (more than hardly forward)
/// and whose amplification 1/(2 zeta) asks for a margin. peaks: speeds of the responses' peaks that
/// were judged by their margin, rad/s of the reference. Fails with the critical speed that none of
/// them shows and that keeps least of its margin; else says how many there are, for information.
results::Check check_critical_speeds(run::Job& sub, const model::Step& step,
                                     const model::ApiLateralStep& law, const ApiMachine& machine,
                                     const std::vector<double>& peaks);

}  // namespace whirl::steps
