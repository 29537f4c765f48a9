// Static load path past limit points: R(q; Omega, lambda) = 0 followed in (q, lambda), lambda the factor on gravity and given loads
// (Context::load), by arc length or with one displacement in control. Stationary where dlambda/ds = 0: limit points (snap-through).
// A perfect structure stays on its primary branch at a bifurcation; give it an imperfection, or ask for the linearised buckling loads.
#pragma once
#include <analysis/equilibrium.hpp>
#include <functional>

namespace whirl::analysis {

struct LoadPathOptions {
  EquilibriumOptions equilibrium;
  Index controlled = -1;          ///< unknown in control; -1: arc length
  double controlled_to = 0;       ///< its last value, m or rad (controlled >= 0)
  double last_load = 1;           ///< arc length: the path ends where lambda first passes this; both kinds: it starts towards its sign
  int steps = 20;                 ///< arc length: first step about last_load/steps; control: equal steps
  int max_points = 400;
};

struct LoadPathPoint {
  double load = 0;                ///< lambda
  bool limit = false;             ///< a limit point was passed since the last point
  int iterations = 0;
  const system::State* state = nullptr;
};

enum class LoadPathEnd { reached, stopped, too_many_points, lost };

struct LoadPathResult {
  LoadPathEnd end = LoadPathEnd::reached;
  Equilibrium last;               ///< the last point; reactions at its load
  double load = 0;
  int points = 0;
  std::string why;                ///< when lost: node, direction
};

/// accept sees every point, lambda = 0 first, and ends the path by returning false. The load factor of `running` is left at the last one.
/// Error when there is no equilibrium at lambda = 0.
LoadPathResult follow_load_path(RunningSystem& running, double Omega, const system::State& start, const LoadPathOptions& options,
                                const std::function<bool(const LoadPathPoint&)>& accept);

}  // namespace whirl::analysis
