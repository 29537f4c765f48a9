// Linearised buckling: factors mu on the loads at which K0 + mu K1 is singular, K0 the stiffness of the unloaded (spinning)
// rotor and K1 its first derivative with the load factor, along the linear response to the loads.
//
// K1 is the central difference of the exact tangent at the equilibria under +-delta times the loads; delta is chosen so that the
// response stays near 1e-5 rad (or lengths of the model): its square is the error of the difference. Circulatory loads (a torque of
// fixed direction) make K1 non-symmetric; complex factors mean flutter.
#pragma once
#include <analysis/linear.hpp>

namespace whirl::analysis {

struct BucklingMode {
  Complex factor;     ///< on the loads; negative: loads reversed
  VecXc x;            ///< (u, phi, gamma) a node; largest displacement 1
};

/// The `count` factors of least size, ascending. Errors: as EquilibriumSolver::solve; E79 no load changes the stiffness.
std::vector<BucklingMode> buckling(RunningSystem& running, double Omega, Index count, const EquilibriumOptions& options = {});

}  // namespace whirl::analysis
