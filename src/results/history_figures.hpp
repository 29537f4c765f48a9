// Figures of a transient's time histories.
#pragma once
#include <results/channels.hpp>
#include <results/plot_buffer.hpp>

namespace whirl::results {

/// Speed, probes (time, amplitude against speed, orbit), paths, rotation, forces, energies: as far
/// as there are channels of them. buffer: its columns are those of `channels`. unresolved: share of
/// the largest motion or load below which one is not drawn, which the section's text then says.
void add_history_figures(const run::Job& job, const model::Step& step, const Channels& channels,
                         const PlotBuffer& buffer, double unresolved, io::ReportSection& section);

}  // namespace whirl::results
