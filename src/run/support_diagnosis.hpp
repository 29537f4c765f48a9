// What supports with a gap say about an equilibrium: how far a film was pressed when none was
// found, contacts that are closed at rest.
#pragma once
#include <run/job.hpp>

namespace whirl::analysis {
class SteadySystem;
}

namespace whirl::run {

/// `failed` with what the films say at the largest load that still has an equilibrium: load,
/// capacity, eccentricity reached.
Error explain_no_equilibrium(const Job& job, const analysis::SteadySystem& running,
                             const StepState& start, const Error& failed);

/// What helps a film that is pressed further than it is believed.
inline constexpr const char* pressed_film_hint =
    "the film is thinner than roughness and tilt allow: more speed or viscosity, less clearance, a "
    "longer bearing, less load";

/// Supports beyond what they are for in the state of a step, as warnings of the run (terminal, report
/// and summary): contacts that are closed, films pressed further than they are believed, shafts in
/// the poles of magnets. when: "the start", "the equilibrium
/// at 3000 rpm".
void warn_of_closed_contacts(Job& job, const model::Step& step, const std::string& when,
                             const system::State& state);

/// Which supports stand at the end of their range in a state (a table at the speed where it ends, a
/// journal at the wall): "; ..." for the message of a motion that could not go on, empty when none
/// does.
std::string supports_at_their_limit(const Job& job, const system::State& s);

/// "pad 2 of bearing 'DE', which carries 3 N,": of those that have no inertia and carry little in a state the
/// one that carries least, against the other pads of its bearing; empty: there is none.
std::string light_pad_without_load(const Job& job, const system::State& s);

}  // namespace whirl::run
