// Linearised buckling: factors mu on the loads at which K0 + mu K1 is singular, K0 the stiffness of
// the unloaded (spinning) rotor and K1 what the loads change of it to first order: dK/dlambda at
// rest, and dK of what the linear response u1 = -K0^-1 dR/dlambda deforms in each element
// (system/stiffness_rate.hpp: exact for beams, so that refining the mesh loses nothing). For what
// is no beam (supports, loads) it is the derivative of K along u1, a difference over states of 1e-5
// of the model. Circulatory loads (a torque of fixed direction) make K1 non-symmetric; complex
// factors mean flutter.
//
// The factor is right when the rotor is hardly deformed at that load. `check_on_path` asks the
// nonlinear model: it follows the equilibria to the load found and tells where on that path the
// tangent stops being definite.
#pragma once
#include <analysis/linearizer.hpp>
#include <analysis/statics/load_path.hpp>

namespace whirl::analysis {

struct BucklingMode {
  Complex factor;           ///< on the loads; negative: loads reversed
  VecXc x;                  ///< (u, phi, gamma) a node; largest displacement 1
  double rotation = 0;      ///< largest tilt or twist of the linear response at this load, rad
  double displacement = 0;  ///< its largest displacement over the size of the model
};

/// Whether a list of factors is complete. With symmetric K1 and a positive K0 the factors are real,
/// and K0 + mu K1 has as many negative eigenvalues as factors lie between 0 and mu (Sylvester): two
/// factorisations count those of either sign. Between them the last of the list itself is left out,
/// for a factor may be a double one of which the list ends with the first.
struct BucklingCount {
  bool counted = false;  ///< false: why_not says why
  const char* why_not = "";
  double up_to = 0;    ///< size of the factors counted, a little below that of the last listed
  Index positive = 0;  ///< factors in (0, up_to)
  Index negative = 0;  ///< factors in (-up_to, 0)
  Index missing = 0;   ///< of these, not in the list
  /// Negative directions of the stiffness without the loads: what is built in (temperature, preload)
  /// has buckled the model before any of them acts, and the factors lead on from there.
  Index unstable = 0;
  bool unstable_certain = true;  ///< false: an unsymmetric stiffness, counted and not proved
  bool complete() const { return counted && missing == 0; }
};

struct Buckling {
  std::vector<BucklingMode> modes;  ///< ascending by size of the factor
  BucklingCount count;              ///< how many there are, by inertia
  Equilibrium unloaded;             ///< the state the factors are of
};

/// The `count` factors of least size. None where no load changes the stiffness of a model that is
/// unstable without loads.
/// @throws Error as EquilibriumSolver::solve; E79 no load changes the stiffness of a stable one.
Buckling buckling(SteadySystem& running, double Omega, Index count,
                  const EquilibriumOptions& options = {});

/// E79 where a look at the loads is enough: neither gravity nor a load acts, and without them the
/// model is stable.
/// @throws Error (E79); as EquilibriumSolver::solve.
void require_loads(SteadySystem& running, double Omega, const EquilibriumOptions& options = {});

/// What the nonlinear equilibria under growing loads say about a factor.
struct PathCheck {
  bool found = false;  ///< the tangent loses definiteness
  bool limit = false;  ///< at a limit point; else equilibria branch off
  double load = 0;     ///< there; not found: as far as was looked
  std::string ended;   ///< why the path ended before that, else empty
};

/// Follows the path to 1.25 times `factor`, until its tangent gains a negative direction.
PathCheck check_on_path(SteadySystem& running, double Omega, double factor,
                        const EquilibriumOptions& options = {});

}  // namespace whirl::analysis
