// What a transient run says about its own accuracy: energy balance, local errors, numerical against
// physical damping, warnings.
#pragma once
#include <analysis/transient/observer.hpp>
#include <analysis/study/scheme_damping.hpp>
#include <analysis/transient/transient.hpp>
#include <run/job.hpp>

namespace whirl::steps {

struct AccuracyInputs {
  const model::TransientStep& law;
  const analysis::TransientResult& result;
  const analysis::EnergyBalance& energy;
  const analysis::StepHistogram& steps;
  double speed = 0;  ///< of the reference at the end, rad/s
};

/// Fills `summary`, adds a table and a paragraph to the section, and returns the warnings.
std::vector<std::string> state_accuracy(run::Job& job, const AccuracyInputs& in, io::Value& summary,
                                        io::ReportSection& section);

}  // namespace whirl::steps
