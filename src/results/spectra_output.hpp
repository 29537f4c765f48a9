// Spectra of a transient's probes: CSV block by block, waterfall, map and full spectrum (forward
// and backward whirl apart).
#pragma once
#include <analysis/transient/spectrum.hpp>
#include <run/job.hpp>

namespace whirl::results {

class SpectraOutput {
 public:
  /// senses: of the shafts at the probes, +1 or -1 relative to the reference; see probe_senses().
  SpectraOutput(const run::Job& job, const model::Step& step, double t_begin,
                std::vector<double> senses);
  analysis::Observer& observer() { return spectra_; }
  void begin();
  void save(OutArchive& out);
  void restore(InArchive& in);
  void close();
  void report(io::ReportSection& section) const;
  run::PartKey key() const { return {run::Part::spectra, content_}; }

 private:
  struct Trace {
    double t = 0, speed = 0;
    std::vector<std::vector<double>> full, y;
  };  ///< [probe][line]
  void take(analysis::SpectrumBlock block);
  std::vector<io::Channel> channels() const;
  const model::Output& out_;
  model::SpectraOutput options_;
  std::string step_, content_;
  std::vector<std::string> probes_;
  std::vector<double> senses_;
  std::vector<io::TimeSeriesPtr> sinks_;  ///< one a probe
  std::vector<Trace> traces_;
  std::size_t blocks_ = 0, stride_ = 1;
  std::vector<double> row_;
  analysis::Spectra spectra_;
};

}  // namespace whirl::results
