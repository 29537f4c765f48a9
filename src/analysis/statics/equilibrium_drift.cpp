// Equilibria that Newton's method does not reach: followed as a motion without inertia. C. T. Kelley and
// D. E. Keyes, Convergence analysis of pseudo-transient continuation, SIAM J. Numer. Anal. 35 (1998) 508,
// doi 10.1137/S0036142996304796.
#include <analysis/statics/equilibrium.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

bool EquilibriumSolver::ends_near(double Omega, system::State& s, double size, int& iterations) {
  constexpr double near = 100.0;  // steps that shrink by a hundredth each still come to that
  const VecX here = s.q;
  if (newton(Omega, s, iterations, Step::careful) == Outcome::converged &&
      correction_size(s.q - here) <= near * size)
    return true;
  s.q = here;
  running_.residual(s.frames, Omega, s.q, r_);
  return false;
}

EquilibriumSolver::Outcome EquilibriumSolver::drift(double Omega, system::State& s,
                                                    int& iterations) {
  constexpr int most = 800, between_looks = 25;
  constexpr double accepted = 0.5;  // what the step has not foreseen, of the step
  if (!running_.residual(s.frames, Omega, s.q, r_)) return Outcome::diverged;
  // Longer steps are drawn to equilibria that repel: those of rate 1/time and more do not hold them.
  const double longest = 3.0 / std::max(std::abs(Omega), 1.0), shortest = 1e-10 * longest;
  double time = 1e-3 * longest;
  for (int k = 1; k <= most && time > shortest; ++k, ++iterations) {
    running_.tangent(s.frames, Omega, s.q, matrices_);
    if (solver_->factor(matrices_, 0.0, 1.0 / time, 1.0) != la::Status::ok)
      return Outcome::singular;
    step_ = r_;
    clear_held(step_);
    solver_->solve(step_);
    step_ = -step_;
    const double size = correction_size(step_);
    if (!std::isfinite(size)) return Outcome::diverged;
    // R after the step is what C d/time left of it, but for what is not linear
    trial_ = s.q + step_;
    const bool inside = running_.residual(s.frames, Omega, trial_, next_);
    double unforeseen = infinity;
    if (inside) {
      VecX rest = next_;
      matrices_.C.add_multiply(1.0 / time, step_, rest);
      clear_held(rest);
      solver_->solve(rest);
      unforeseen = correction_size(rest) / size;
    }
    if (!(unforeseen < accepted)) {
      time *= 0.25;
      continue;
    }
    s.q = trial_;
    r_ = next_;
    time = std::min(longest, time * std::clamp(0.25 / unforeseen, 0.5, 4.0));
    if (k % between_looks == 0 && time == longest && ends_near(Omega, s, size, iterations))
      return Outcome::converged;
  }
  return Outcome::diverged;
}

}  // namespace whirl::analysis
