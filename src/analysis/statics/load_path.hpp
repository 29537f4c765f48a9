// Static load path past limit points: R(q; Omega, lambda) = 0 followed in (q, lambda), lambda the
// factor on gravity and given loads (Context::load), by arc length or with one displacement in
// control. Stationary where dlambda/ds = 0: limit points (snap-through).
//
// At every point the negative directions of the tangent are counted (definiteness.hpp). Their
// number changes at a limit point by one; where it changes otherwise other equilibria branch off: a
// bifurcation point, located on the path by the eigenvalue that vanishes there. A perfect structure
// stays on its primary path; `branch` leaves it along the vector of that eigenvalue (E. Riks, Int.
// J. Solids Struct. 15 (1979) 529, doi 10.1016/0020-7683(79)90081-7). Where several eigenvalues
// vanish together one of their vectors is taken. What is missed: two bifurcations between two
// points that undo each other in the count.
#pragma once
#include <analysis/statics/definiteness.hpp>
#include <analysis/statics/equilibrium.hpp>
#include <functional>

namespace whirl::analysis {

struct LoadPathOptions {
  EquilibriumOptions equilibrium;
  Index controlled = -1;     ///< unknown in control; -1: arc length
  double controlled_to = 0;  ///< its last value, m or rad (controlled >= 0)
  double last_load = 1;  ///< arc length: the path ends where lambda first passes this; both kinds:
                         ///< it starts towards its sign
  int steps = 20;        ///< arc length: first step about last_load/steps; control: equal steps
  int max_points = 400;
  int branch = 0;  ///< follow the branch that leaves at the bifurcation of this number (1 the
                   ///< first), negative: to its other side
};

struct LoadPathPoint {
  double load = 0;     ///< lambda
  bool limit = false;  ///< a limit point was passed since the last point
  int iterations = 0;
  const system::State* state = nullptr;
  Definiteness tangent;      ///< without its shape
  bool bifurcation = false;  ///< located: other equilibria branch off here
};

/// A point at which the path turns in load (limit) or other equilibria branch off.
struct CriticalPoint {
  bool limit = false;
  double load = 0;
  Index before = 0, after = 0;  ///< negative directions of the tangent
  system::State state;          ///< of a bifurcation
  VecX direction;  ///< of a bifurcation: the motion along which it branches, largest displacement
                   ///< 1; (u, phi, gamma) a node
};

/// The count of negative directions changes between two loads, and where was not found.
struct Unlocated {
  double from = 0, to = 0;
  Index before = 0, after = 0;
};

enum class LoadPathEnd { reached, stopped, too_many_points, lost, no_branch };

struct LoadPathResult {
  LoadPathEnd end = LoadPathEnd::reached;
  Equilibrium last;  ///< the last point; reactions at its load
  double load = 0;
  int points = 0;
  std::string why;                      ///< when lost: node, direction
  std::vector<CriticalPoint> critical;  ///< in the order passed
  std::vector<Unlocated> unlocated;
  int branched_at = -1;  ///< which of them the path left on a branch
  Definiteness tangent;  ///< at the last point, without its shape
};

/// "reached its end at load factor 1 after 41 points", or where it ended instead and why.
std::string describe(const LoadPathResult& r);

/// accept sees every point (located bifurcations too), lambda = 0 first, and ends the path by
/// returning false. The load factor of `running` is left at the last one.
/// @pre a state of the system.
/// @throws Error as EquilibriumSolver::solve() without an equilibrium at lambda = 0.
LoadPathResult follow_load_path(SteadySystem& running, double Omega, const system::State& start,
                                const LoadPathOptions& options,
                                const std::function<bool(const LoadPathPoint&)>& accept);

}  // namespace whirl::analysis
