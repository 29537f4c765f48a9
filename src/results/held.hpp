// What a step holds that the deck's supports do not: what drives prescribe, motions left out, what
// an equilibrium needs.
#pragma once
#include <run/job.hpp>

#include <span>

namespace whirl::results {

/// One line each: "twist of shaft 'r' at 'b:end': drive 'motor' prescribes its angle". motion: of a
/// step that takes some motions only. spin_holds: unknowns phi an equilibrium held because nothing
/// else does.
std::vector<std::string> held_in_step(const run::Job& job, const model::Step& step,
                                      std::span<const Index> holds = {});

/// The same in the summary of the step ("held"), in its section of the report and on the terminal.
void say_held(run::Job& job, const model::Step& step, const std::vector<std::string>& held,
              io::ReportSection& section);

}  // namespace whirl::results
