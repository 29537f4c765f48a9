// Start of an equilibrium whose supports have clearance (ball bearings with play, catcher bearings): in the reference configuration they
// carry nothing, the tangent is singular, and Newton has no direction to go. The rotor is let down instead.
#include <analysis/equilibrium.hpp>

namespace whirl::analysis {

EquilibriumSolver::Outcome EquilibriumSolver::close_gaps(double Omega, system::State& s, int& iterations) {
  const system::System& sys = running_.system();
  const system::State begin = s;
  const std::string why = why_;
  if (!running_.residual(begin.frames, Omega, begin.q, r_)) return Outcome::singular;
  std::vector<Vec3> force(static_cast<std::size_t>(sys.lines()), Vec3::Zero());
  const auto each = [&](auto visit) {
    for (Index i = 0; i < sys.nodes(); ++i)
      for (Index c = 0; c < 3 && !sys.node(i).scalar; ++c)
        if (free_[static_cast<std::size_t>(6 * i + c)]) visit(6 * i + c, force[static_cast<std::size_t>(sys.node(i).line)][c]);
  };
  each([&](Index k, double& f) { f -= r_[k]; });
  VecX down = VecX::Zero(sys.size());
  each([&](Index k, double& f) { down[k] = f; });
  const double largest = down.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return Outcome::singular;
  down /= largest;
  // From 1e-8 to a twentieth of the model's size in doublings: a contact found is pressed by at most the way it took to find it.
  for (double way = 1e-8 * length_; way < 0.05 * length_; way *= 2.0) {
    s = begin;
    s.q += way * down;
    int n = 0;
    const Outcome o = newton(Omega, s, n);
    iterations += n;
    if (o == Outcome::converged) return o;
  }
  s = begin;
  why_ = why;
  return Outcome::singular;
}

}  // namespace whirl::analysis
