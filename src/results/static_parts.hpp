// The parts of a static state's results, each in a file of its own.
#pragma once
#include <results/static_results.hpp>

namespace whirl::results {

/// Deflected centre lines: table, figures, largest deflections. state: evaluated there.
void add_deflection(const run::Job& job, const std::string& step, const system::Workspace& state,
                    const MeanLoads& loads, StaticResults& out, io::Value& summary);
/// Section forces and stresses of out.points: tables, figures, largest values. means: they are those
/// over a turn, and no moment has them.
void add_sections(const run::Job& job, const std::string& step, bool means, StaticResults& out,
                  io::Value& summary);

}  // namespace whirl::results
