// Figures of a transient's time histories.
#pragma once
#include <run/job.hpp>
#include <results/plot_buffer.hpp>

namespace whirl::results {

/// Figures of a transient's time histories: speed, probes (time, amplitude against speed, orbit),
/// paths, rotation, energies. start[i]: first column of measurement i in the buffer.
void add_history_figures(const run::Job&, const model::Step&,
                         const std::vector<analysis::Measurement>&,
                         const std::vector<std::size_t>& start, const PlotBuffer&,
                         io::ReportSection&);

}  // namespace whirl::results
