// Equilibria together with what elements keep (system::Frames::kept): temperatures of films.
#include <analysis/statics/equilibrium.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>

#include <la/dense.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

namespace whirl::analysis {

namespace {

VecX vector_of(const std::vector<double>& x) {
  return Eigen::Map<const VecX>(x.data(), static_cast<Index>(x.size()));
}

/// Whose values are farthest from the balance.
const system::Keeper& farthest(const system::System& sys, const VecX& residual) {
  const auto off = [&](const system::Keeper& k) {
    return residual.segment(static_cast<Index>(k.first), static_cast<Index>(k.count))
        .cwiseAbs()
        .maxCoeff();
  };
  return *std::max_element(
      sys.keepers().begin(), sys.keepers().end(),
      [&](const system::Keeper& a, const system::Keeper& b) { return off(a) < off(b); });
}

/// The fixed point of x -> g(x) from pairs of x and g(x) - x (D. G. Anderson, J. ACM 12, 1965, doi
/// 10.1145/321296.321305): of the last few, the combination whose residuals cancel best.
class FixedPoint {
 public:
  /// The next x, from x and its residual.
  VecX next(const VecX& x, const VecX& residual) {
    const VecX to = combination(x, residual);
    // no further than where an exponential is a straight line by half
    const double step = (to - x).cwiseAbs().maxCoeff();
    constexpr double most = 0.4;
    return step > most ? VecX(x + most / step * (to - x)) : to;
  }

 private:
  VecX combination(const VecX& x, const VecX& residual) {
    const double size = residual.norm();
    // astray: what was learnt does not hold here, nor what was reached
    if (size > 2.0 * smallest_) {
      steps_.clear();
      changes_.clear();
      last_residual_.resize(0);
      smallest_ = size;
    }
    smallest_ = std::min(size, smallest_);
    if (last_residual_.size() > 0) {
      steps_.push_back(x - last_x_);
      changes_.push_back(residual - last_residual_);
      if (steps_.size() > memory) {
        steps_.pop_front();
        changes_.pop_front();
      }
    }
    last_x_ = x;
    last_residual_ = residual;
    // at first half of what is asked: hotter oil heats less
    if (steps_.empty()) return x + 0.5 * residual;
    const Index m = static_cast<Index>(steps_.size());
    MatX D(x.size(), m), S(x.size(), m);
    for (Index k = 0; k < m; ++k) {
      S.col(k) = steps_[static_cast<std::size_t>(k)];
      D.col(k) = changes_[static_cast<std::size_t>(k)];
    }
    const VecX share = la::ColumnSpan<double>(D).coordinates(residual);
    return x + residual - (S + D) * share;
  }

  static constexpr std::size_t memory = 5;
  double smallest_ = infinity;
  std::deque<VecX> steps_, changes_;
  VecX last_x_, last_residual_;
};

}  // namespace

void EquilibriumSolver::balance_kept(double Omega, Equilibrium& out) {
  const system::System& sys = running_.system();
  if (sys.keepers().empty()) return;
  // of values that are logarithms or ratios
  constexpr double tolerance = 1e-7;
  constexpr int most = 60;
  system::Workspace w = sys.make_workspace();
  FixedPoint iteration;
  std::vector<double> settled;
  VecX residual;
  // Films on a grid dry and fill cell by cell, which moves what they warm by some 1e-4: nearer to a balance than
  // that there may be none. It is less than the cells of the heat balance leave, whose error is told.
  constexpr double of_cells = 1e-3;
  constexpr int patience = 20, in_vain = 10;
  std::optional<Equilibrium> nearest;
  int nearest_round = 0;
  for (int round = 0; round < most; ++round) {
    const system::State& s = out.state;
    sys.evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a);
    sys.settle_kept(w, settled);
    const VecX now = vector_of(s.frames.kept);
    residual = vector_of(settled) - now;
    out.kept_error = residual.cwiseAbs().maxCoeff();
    if (out.kept_error < tolerance) {
      for (const system::Keeper& k : sys.keepers())
        if (k.check) k.check(w);
      return;
    }
    if (round >= patience && out.kept_error < (nearest ? nearest->kept_error : of_cells)) {
      nearest = out;
      nearest_round = round;
    }
    if (nearest && round >= nearest_round + in_vain) break;
    VecX change = iteration.next(now, residual) - now;
    system::State start = s;
    std::optional<Equilibrium> moved;
    constexpr int halvings = 6;  // the journal may not find its place over so large a change
    for (int k = 0; !moved && k < halvings; ++k, change *= 0.5) {
      const VecX next = now + change;
      start.frames.kept.assign(next.data(), next.data() + next.size());
      moved = try_solve(Omega, &start);
    }
    if (!moved)
      throw NoEquilibrium(
          run_error("E76",
                    fmt::format("no equilibrium found with the temperatures of {}: {}",
                                farthest(sys, residual).name, why_),
                    "a bearing may be beyond its capacity with hot oil (supply_flow, carry_over): "
                    "look at it without heat"),
          Omega);
    moved->iterations += out.iterations;
    moved->drifted = moved->drifted || out.drifted;
    const double error = out.kept_error;
    out = std::move(*moved);
    out.kept_error = error;
  }
  if (nearest) {
    nearest->iterations = out.iterations;
    out = std::move(*nearest);
    sys.evaluate_nodes(w, out.state.frames, out.state.t, out.state.q, out.state.v, out.state.a);
  }
  for (const system::Keeper& k : sys.keepers())
    if (k.check) k.check(w);  // what cannot be says more
  if (nearest) return;
  throw NoEquilibrium(
      run_error("E76",
                fmt::format("the temperatures of {} and the equilibrium do not settle: after {} "
                            "rounds they still change by {:.2g} (of the logarithm of the "
                            "viscosity, or of the clearance)",
                            farthest(sys, residual).name, most, out.kept_error),
                "the journal may grow into its bearing (expansions, supply_temperature, "
                "clearance), or the oil be too little (supply_flow, carry_over): look at it "
                "without heat"),
      Omega);
}

}  // namespace whirl::analysis
