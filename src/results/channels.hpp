// What the columns of a transient's time histories are.
#pragma once
#include <run/job.hpp>

namespace whirl::results {

/// Channels of a time history, with the plots they belong to.
struct Channels {
  std::vector<analysis::Measurement> all;
  std::vector<std::size_t> start;  ///< first column (without time) of each measurement
  std::size_t columns = 0;
  void add(analysis::Measurement m) {
    start.push_back(columns);
    columns += m.width();
    all.push_back(std::move(m));
  }
};

/// The columns the deck's [output] asks for.
Channels make_channels(const run::Job& job);
/// The same for a file, time first.
std::vector<io::Channel> io_channels(const Channels& c);
/// Node and offset of a place on a shaft.
analysis::Point point_of(const run::Job& job, const model::Location& at);
/// Those of the deck's probes, in their order.
std::vector<analysis::Point> probe_points(const run::Job& job);
/// Of each probe: +1 where the shaft there turns as the reference does, -1 the other way, by the
/// spins at the start of a step (a shaft that does not turn yet: by its speed_ratio).
std::vector<double> probe_senses(const run::Job& job, const run::StepState& start);
/// The shaft whose turns count at a place, where it is another than the reference and turns by itself;
/// empty: the reference's (also on standing parts, and on shafts that a joint ties to others).
std::string own_shaft(const run::Job& job, const model::Location& at);
/// Where a transient's peaks are looked for: the probes, or the disks when there are none.
std::vector<std::pair<std::string, analysis::Point>> watched_points(const run::Job& job);

}  // namespace whirl::results
