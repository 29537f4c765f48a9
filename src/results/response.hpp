// Steady responses as tables and figures: what unbalance and harmonic forcing share.
#pragma once
#include <analysis/response/unbalance.hpp>
#include <results/frequency.hpp>

namespace whirl::results {

/// The deck's probes; without any the disks.
std::vector<analysis::ResponseProbe> response_probes(const run::Job& job);

/// Curves of a probe: one for each of its angles, without any y and z.
struct ProbeCurves {
  std::vector<std::string> label;
  std::vector<std::vector<Complex>> amplitude;  ///< m; [curve][point]
};
/// amplitudes: the probe's at every speed.
ProbeCurves curves_of(const analysis::ResponseProbe& probe,
                      const std::vector<analysis::PointAmplitude>& amplitudes);

/// The same as curves against speed (or frequency), rad/s. suffix: of their labels.
std::vector<plot::ResponseCurve> response_curves(const std::vector<double>& axis,
                                                 const ProbeCurves& curves,
                                                 const std::string& suffix = {});

/// Columns "amplitude [m]", "phase lag [deg]" of y and z and of each of the probe's angles, and the
/// major and minor axis of the orbit.
void add_probe_columns(io::Table& t, const analysis::ResponseProbe& probe);
void add_probe_cells(std::vector<io::Table::Cell>& row, const analysis::ResponseProbe& probe,
                     const analysis::PointAmplitude& a);

/// Phase lag, rad.
inline double lag(Complex a) { return -std::arg(a); }

}  // namespace whirl::results
