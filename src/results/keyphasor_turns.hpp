// What the keyphasor of a shaft has seen of its probes, turn by turn, and how a report shows it.
#pragma once
#include <model/model.hpp>
#include <plot/plots.hpp>
#include <results/plot_buffer.hpp>
#include <results/transient_output.hpp>

#include <string>
#include <vector>

namespace whirl::results {

/// A direction in which a probe looks across the shaft.
struct TrackedDirection {
  std::string name, shown;  ///< shown: in figures
  double c = 1, s = 0;      ///< of its angle from y
};

/// The columns of a probe begin with those of its directions (TrackedTurns).
struct TrackedProbe {
  std::string name;
  std::vector<TrackedDirection> directions;
  std::size_t first_column = 0;
  double sense = 1;  ///< -1: the shaft there turns against the reference
};

/// Some turns of one probe; displacements y, z in m.
struct TrackedOrbit {
  std::size_t probe = 0;
  double t = 0;      ///< s, middle of the last turn
  double speed = 0;  ///< rad/s
  double size = 0;   ///< m, peak to peak
  std::vector<double> y, z;
};

/// Rows: time in s, speed in rad/s, then of every probe and direction amplitude (m, 0-peak) and phase
/// lag (rad) of each order, envelope and mean (m), and its circles forward and backward (m).
struct TrackedTurns {
  std::string step, shaft;  ///< shaft: empty, the reference
  model::TrackingOutput tracking;
  plot::Amplitude convention;
  std::vector<TrackedProbe> probes{};
  int filter_turns = 1;
  std::size_t shown = 0;  ///< of the orders asked for: of Bode plots and peaks, 1 or the first
  std::size_t columns = 2;
  PlotBuffer rows{0};
  std::vector<TrackedOrbit> largest{};  ///< [probe]
  std::vector<TrackedOrbit> passed{};   ///< at speeds asked for

  std::size_t per_direction() const { return 2 * tracking.orders.size() + 2; }
  // columns of the rows
  std::size_t amplitude(std::size_t probe, std::size_t direction, std::size_t order) const {
    return column(probe, direction, 2 * order);
  }
  std::size_t phase_lag(std::size_t probe, std::size_t direction, std::size_t order) const {
    return column(probe, direction, 2 * order + 1);
  }
  std::size_t envelope(std::size_t probe, std::size_t direction) const {
    return column(probe, direction, per_direction() - 2);
  }
  std::size_t mean(std::size_t probe, std::size_t direction) const {
    return column(probe, direction, per_direction() - 1);
  }
  /// "STEP_tracking.csv", "STEP_SHAFT_tracking.csv"
  std::string file(const std::string& what) const;

 private:
  std::size_t column(std::size_t probe, std::size_t direction, std::size_t what) const {
    return probes[probe].first_column + direction * per_direction() + what;
  }
};

/// Adds figures, peaks and orbits of the turns to the section of a transient, and writes the tables of
/// peaks and orbits.
void report_turns(const TrackedTurns& turns, TransientEnd& end);

}  // namespace whirl::results
