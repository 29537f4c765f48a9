// The parts of a static state's results, each in a file of its own.
#pragma once
#include <results/static_results.hpp>

namespace whirl::results {

/// Deflected centre lines: table, figures, largest deflections. state: evaluated there.
void add_deflection(const run::Job& job, const std::string& step, const system::Workspace& state,
                    StaticResults& out, io::Value& summary);
/// Section forces and stresses of out.points: tables, figures, largest values.
void add_sections(const run::Job& job, const std::string& step, StaticResults& out,
                  io::Value& summary);

}  // namespace whirl::results
