#include <analysis/buckling.hpp>

#include <core/error.hpp>
#include <la/eigen.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Largest displacement relative to the model's size, or rotation, between two states.
double distance(const system::System& s, const VecX& a, const VecX& b) {
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (Index i = 0; i < s.nodes(); ++i)
    if (!s.node(i).scalar) low = low.cwiseMin(s.node(i).position), high = high.cwiseMax(s.node(i).position);
  const double length = (high - low).norm() > 0 ? (high - low).norm() : 1.0;
  double d = 0;
  for (Index k = 0; k < a.size(); ++k) d = std::max(d, std::abs(a[k] - b[k]) / (k % 6 < 3 ? length : 1.0));
  return d;
}

}  // namespace

std::vector<BucklingMode> buckling(RunningSystem& running, double Omega, Index count, const EquilibriumOptions& options) {
  const system::System& system = running.system();
  EquilibriumSolver solver(running, options);
  const double full = running.load();
  running.set_load(0.0);
  const Equilibrium rest = solver.solve(Omega);
  la::MCK K0 = system.make_matrices(), plus = K0, minus = K0;
  running.tangent(rest.state.frames, Omega, rest.state.q, K0);
  double delta = 1e-6 * full;
  for (int pass = 0; pass < 3; ++pass) {
    running.set_load(delta);
    const double moved = distance(system, solver.solve(Omega, &rest.state).state.q, rest.state.q);
    if (moved > 0.3e-5 && moved < 3e-5) break;
    // loads that move nothing (through a rigid support) need no small factor
    delta = moved > 0 ? std::min(delta * 1e-5 / moved, 1e6 * full) : full;
  }
  const auto tangent_at = [&](double load, la::MCK& out) {
    running.set_load(load);
    const Equilibrium e = solver.solve(Omega, &rest.state);
    running.tangent(e.state.frames, Omega, e.state.q, out);
  };
  tangent_at(delta, plus), tangent_at(-delta, minus);
  running.set_load(full);
  la::BlockMatrix<6> B(system.pattern());
  double size = 0, stiffness = 0;
  for (std::size_t k = 0; k < B.value_count(); ++k) {
    B.data()[k] = -(plus.K.data()[k] - minus.K.data()[k]) / (2.0 * delta) * full;
    size = std::max(size, std::abs(B.data()[k]) * delta / full), stiffness = std::max(stiffness, std::abs(K0.K.data()[k]));
  }
  // Differences at the rounding level of the tangent are no geometric stiffness.
  if (!(size > 1e-15 * stiffness)) throw run_error("E79", "no load changes the stiffness of the model: nothing can buckle", "give a load along a shaft, or a moment");
  std::vector<BucklingMode> out;
  for (const la::Mode& m : la::linear_modes(K0.K, B, solver.free(), count)) {
    BucklingMode b{m.lambda, m.x};
    Complex top = 0;
    for (Index i = 0; i < system.nodes(); ++i)
      for (int c = 0; c < 3; ++c)
        if (std::abs(b.x[6 * i + c]) > std::abs(top) * (1 + 1e-9)) top = b.x[6 * i + c];
    if (std::abs(top) > 0) b.x /= top;
    out.push_back(std::move(b));
  }
  return out;
}

}  // namespace whirl::analysis
