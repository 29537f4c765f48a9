// What a transient step writes while it runs: time histories and frames.
#pragma once
#include <results/frame_arrays.hpp>
#include <run/job.hpp>
#include <core/archive.hpp>

namespace whirl::results {

/// Channels of a time history, with the plots they belong to.
struct Channels {
  std::vector<analysis::Measurement> all;
  std::vector<std::size_t> start;  // first column (without time) of each measurement
  std::size_t columns = 0;
  std::size_t add(analysis::Measurement m) {
    start.push_back(columns);
    columns += m.width();
    all.push_back(std::move(m));
    return all.size() - 1;
  }
};

/// The columns the deck's [output] asks for.
Channels make_channels(const run::Job& job);
/// The same for a file, time first.
std::vector<io::Channel> io_channels(const Channels& c);
/// Node and offset of a place on a shaft.
analysis::Point point_of(const run::Job& job, const model::Location& at);

/// Writes frames of the moving rotor when they are due.
class Frames final : public analysis::Observer {
 public:
  Frames(const run::Job& job, const model::VtkOutput& o, const std::string& step, double t0,
         double t1);
  void begin(const analysis::Snapshot& s) override;
  void step(analysis::StepAccess& s) override;
  void end() override { writer_->end(); }
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  std::uint64_t frames() const { return writer_->frames(); }

 private:
  void write(const analysis::Snapshot& s);
  const run::Job& job_;
  io::FrameSchedule schedule_;
  std::unique_ptr<io::FrameWriter> writer_;
  FrameArrays arrays_;
  bool line_ = false, bearings_ = false;  ///< the sets that show section forces, forces of bearings
  double phi_ = 0, now_ = 0;
};

}  // namespace whirl::results
