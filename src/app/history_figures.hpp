// Figures of a transient's time histories.
#pragma once
#include <app/job.hpp>
#include <app/plot_buffer.hpp>

namespace whirl::app {

/// Figures of a transient's time histories: speed, probes (time, amplitude against speed, orbit), paths, rotation, energies.
/// start[i]: first column of measurement i in the buffer.
void add_history_figures(const Job&, const model::Step&, const std::vector<analysis::Measurement>&, const std::vector<std::size_t>& start,
                         const PlotBuffer&, io::ReportSection&);

}  // namespace whirl::app
