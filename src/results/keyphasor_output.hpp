// Tracking filter of a transient's probes: CSV turn by turn, Bode and polar figures against speed,
// response peaks, orbits with keyphasor marks. Memory is bounded: long runs are thinned for the
// figures, the CSV holds every turn.
#pragma once
#include <analysis/transient/revolutions.hpp>
#include <run/job.hpp>
#include <results/plot_buffer.hpp>

#include <span>

namespace whirl::results {

/// Of each probe of the deck: +1 where the shaft there turns as the reference does, -1 the other
/// way, by the spins at the start of a step (a shaft that does not turn yet: by its speed_ratio).
std::vector<double> probe_senses(const run::Job& job, const run::StepState& start);

class KeyphasorOutput {
 public:
  /// senses: of probe_senses().
  KeyphasorOutput(const run::Job& job, const model::Step& step, std::span<const double> senses);
  analysis::Observer& observer() { return revolutions_; }
  void begin();
  void save(OutArchive& out);
  void restore(InArchive& in);
  void close() {
    if (sink_) sink_->close();
  }
  /// Writes the tables and adds the figures.
  void report(run::Job& job, io::ReportSection& section) const;
  /// What decides whether a checkpoint's part fits.
  run::PartKey key() const { return {run::Part::keyphasor, content_}; }

 private:
  struct Direction {
    std::string name;
    double c = 1, s = 0;
  };
  struct Tracked {
    std::string name;
    std::vector<Direction> directions;
    std::size_t column = 0;
    double sense = 1;  ///< -1: the shaft there turns against the reference
  };
  /// Some turns of one probe.
  struct Orbit {
    std::size_t probe = 0;
    double t = 0, speed = 0, size = 0;
    std::vector<double> y, z;
  };
  void take(const analysis::Turn& turn);
  Orbit last_turns(std::size_t probe, double t, double speed, double size) const;
  std::size_t column(std::size_t probe, std::size_t direction, std::size_t what) const;
  std::vector<io::Channel> channels() const;
  void add_bode(io::ReportSection& section, std::size_t probe) const;
  void add_peaks(run::Job& job, io::ReportSection& section) const;
  void add_orbits(run::Job& job, io::ReportSection& section) const;

  static constexpr std::size_t most_orbits = 64;
  const model::Output& out_;
  std::string step_, content_;
  std::vector<Tracked> probes_;
  std::size_t per_direction_ = 0, columns_ = 0;
  io::TimeSeriesPtr sink_;
  PlotBuffer rows_;
  std::vector<double> row_, direction_values_;
  std::vector<std::vector<Orbit>> recent_;  ///< [probe] last turns
  std::vector<Orbit> largest_, passed_;
  double last_speed_ = nan;
  analysis::Revolutions revolutions_;
};

}  // namespace whirl::results
