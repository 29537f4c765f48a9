// Whether a static state is stable, and the shapes that go with it, as steps report them.
#pragma once
#include <analysis/statics/load_path.hpp>
#include <run/job.hpp>

namespace whirl::results {

/// Judges the static tangent of a state at the load of `running`.
/// @throws Error (E76) when the tangent of the state cannot be evaluated.
analysis::Definiteness judge_state(analysis::SteadySystem& running, const system::State& state,
                                   double Omega, std::span<const Index> holds, bool shape);

/// What is said of an equilibrium that is not judged.
inline const std::string left_to_controllers =
    "whether controllers hold it is for a modal, stability or sensitivity step";
/// "unstable equilibrium, 2 directions", or that it is open; empty when it is stable. At a speed: what that means
/// there.
std::string stability_line(const analysis::Definiteness& d, double Omega);

/// The same as a warning (W08) on the terminal, in the report and in the summary.
void warn_of_unstable(run::Job& job, const std::string& step, const analysis::Definiteness& d,
                      double Omega);

/// Into the summary of a step: stable or not, directions, what is claimed.
void add_stability(io::Value& v, const analysis::Definiteness& d, double Omega);

/// A shape node by node: position, displacement, turn about the axis, tilt of the section about the
/// axes.
io::Table shape_table(const run::Job& job, const std::string& title, const system::Frames& frames,
                      const VecX& q, const VecX& shape);

/// Bifurcation and limit points of a path.
io::Table critical_table(const analysis::LoadPathResult& path);

}  // namespace whirl::results
