// How right the frequencies of a step are on its mesh, estimated mode by mode
// (assembly/mesh_error.hpp), said in table headers, summary and report; W10 where they are not to
// Model::mesh_accuracy.
#pragma once
#include <analysis/spectra/whirl_modes.hpp>
#include <assembly/mesh_error.hpp>
#include <results/refined_modes.hpp>
#include <memory>
#include <span>
#include <string>

namespace whirl::results {

class MeshAccuracy {
 public:
  explicit MeshAccuracy(FrequencyStep& s);

  /// Relative error of the frequency of a mode found at a reference speed, rad/s; 0 on a rotor
  /// without elements, NaN where it could not be found. Remembers the largest, with its name.
  double of(const analysis::WhirlMode& mode, double Omega, const std::string& name);
  /// All oscillating modes of a list, named by their labels.
  void look_at(std::span<const analysis::WhirlMode> modes, double Omega);
  /// Into the summary ("mesh"), the headers of the tables still to come, and a warning.
  void report();

 private:
  double error_of(const analysis::WhirlMode& mode, double Omega);
  FrequencyStep& step_;
  assembly::MeshError error_;
  std::unique_ptr<RefinedModes> refined_;  ///< made when a mode with general sections is met
  double largest_ = 0;
  std::string worst_;
  std::vector<std::string> not_judged_;  ///< names of modes
  bool looked_ = false, warned_ = false;
};

/// Looks at the modes of a step that lists none (responses): those up to a frequency, rad/s, at a
/// reference speed, and reports.
void report_mesh_accuracy(FrequencyStep& s, double Omega, double max_frequency);

/// Relative error that the elements leave to the frequency of a mode of the matrices m. spin: of
/// each line, rad/s.
double relative_mesh_error(const assembly::MeshError& error, const la::MCK& m,
                           const analysis::WhirlMode& mode, std::span<const double> spin);

/// W10, with the hint that fits a mesh given or chosen. what: "the frequency of lateral 1 is off by
/// about 2e-3, 1e-3 wanted".
void warn_of_coarse_mesh(run::Job& job, const std::string& step, const std::string& what);

/// "2e-4": one digit, rounded up, never below 1e-6.
std::string error_text(double relative);

}  // namespace whirl::results
