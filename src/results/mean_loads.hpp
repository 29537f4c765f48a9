// What is in balance in an equilibrium. At speed no state of the turn balances by itself: a bow, a section
// that is not round, an unbalance turn on while the deflection is that of the mean over the turn.
#pragma once
#include <assembly/section_results.hpp>
#include <results/frame_arrays.hpp>
#include <run/job.hpp>

#include <vector>

namespace whirl::results {

/// Means over the turn; at rest, and where nothing sees the angle, of the state as it stands.
struct MeanLoads {
  std::vector<PlaceLoad> supports;   ///< in the order of Built::support_forces
  std::vector<PlaceLoad> joints;     ///< in the order of Built::joints
  assembly::ElementForces elements;  ///< of the mesh
  /// Forces of the elements change as the shafts turn: the mean is not what any moment has.
  bool elements_vary = false;
  /// J, less what turns with a shaft and would be there without displacements: of a bow held straight.
  double elastic_energy = 0;
};

/// reactions: mean residual at held unknowns.
/// @throws Error (R11) when the state cannot be evaluated.
MeanLoads calc_mean_loads(const run::Job& job, analysis::SteadySystem& running,
                          const system::State& state, double Omega, const VecX& reactions);

}  // namespace whirl::results
