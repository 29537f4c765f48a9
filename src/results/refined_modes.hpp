// Modes followed to a mesh twice as fine, where the error of the elements cannot be estimated on the
// mesh itself (general sections, bent lines: assembly/mesh_error.hpp).
#pragma once
#include <analysis/spectra/whirl_modes.hpp>
#include <assembly/build_system.hpp>
#include <meshes/halved.hpp>
#include <results/frequency.hpp>
#include <optional>
#include <string>
#include <vector>

namespace whirl::results {

class RefinedModes {
 public:
  /// shafts: names of those whose elements are halved.
  RefinedModes(FrequencyStep& s, const std::vector<std::string>& shafts);
  /// Change of a mode's rate lambda, 1/s, at a reference speed, rad/s, times 4/3: what the elements
  /// leave where the error falls with the square of their length, more than that where it falls
  /// faster. nullopt: the mode was lost on the way.
  std::optional<double> error(const analysis::WhirlMode& mode, double Omega);

 private:
  meshes::Halved fine_;
  assembly::Built built_;
  analysis::Linearizer linear_;
  analysis::WhirlSolver damped_, undamped_;
};

}  // namespace whirl::results
