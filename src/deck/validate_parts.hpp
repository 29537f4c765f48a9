// The parts check_model() is made of, by subject. Internal to src/deck.
#pragma once
#include <deck/validate.hpp>

#include <optional>
#include <utility>

namespace whirl::deck {

using Problems = std::vector<WholeModelProblem>;

/// Appends a problem.
void report(Problems& p, const char* code, std::string message, std::string hint,
            const Where& where, Diagnostic::Severity severity = Diagnostic::Severity::error);

// validate_names.cpp
/// No two things write one file of results.
void check_names(const model::Model& m, Problems& out);

// validate_restraint.cpp: what holds the shafts
void check_restraint(const model::Model& m, Problems& out);
void check_preloads(const model::Model& m, Problems& out);

// validate_speeds.cpp: speeds and frequencies the steps go through
/// Speeds a step goes through: least and largest of the reference shaft, rad/s, or nothing.
std::optional<std::pair<double, double>> speeds_of(const model::Model& m, const model::Step& s,
                                                   std::size_t shaft);
void check_tables(const model::Model& m, Problems& out);
void check_drives(const model::Model& m, Problems& out);
/// A transient begins at the speed its drives prescribe.
void check_start_speeds(const model::Model& m, Problems& out);
/// Gears and couplings tie the speeds of two shafts together.
void check_speeds_of_pairs(const model::Model& m, Problems& out);
void check_speeds_of_joints(const model::Model& m, Problems& out);

// validate_steps.cpp: what a step can be asked for
void check_linear(const model::Model& m, Problems& out);
void check_events(const model::Model& m, Problems& out);
void check_torques(const model::Model& m, Problems& out);
void check_maps(const model::Model& m, Problems& out);
/// Steps without damping on magnetic bearings.
void check_controllers(const model::Model& m, Problems& out);
/// Steps that a cracked shaft does not go with.
void check_cracks(const model::Model& m, Problems& out);
/// What films that conserve mass do not go with.
void check_cavitation(const model::Model& m, Problems& out);
/// A prescribed angle is held in small motions: the shaft is clamped there.
void check_clamps(const model::Model& m, Problems& out);
/// Steps linearised about the rotor as drawn.
void check_undeformed(const model::Model& m, Problems& out);
/// A step begins where one other motion ended.
void check_beginnings(const model::Model& m, Problems& out);
/// Windows of time in which no step runs: nothing would be written.
void check_windows(const model::Model& m, Problems& out);
/// Windows of speed that no step passes through.
void check_speed_window(const model::Model& m, Problems& out);

}  // namespace whirl::deck
