// Start of an equilibrium whose supports have clearance (ball bearings with play, catcher
// bearings): in the reference configuration they carry nothing, the tangent is singular, and Newton
// has no direction to go. The rotor is let down instead.
#include <analysis/statics/equilibrium.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

EquilibriumSolver::Outcome EquilibriumSolver::close_gaps(double Omega, system::State& s,
                                                         int& iterations) {
  const system::System& sys = running_.system();
  const system::State begin = s;
  const std::string why = why_;
  if (!running_.residual(begin.frames, Omega, begin.q, r_)) return Outcome::singular;
  std::vector<Vec3> force(static_cast<std::size_t>(sys.lines()), Vec3::Zero());
  const auto each = [&](auto visit) {
    for (Index i = 0; i < sys.nodes(); ++i)
      for (Index c = 0; c < 3 && !sys.node(i).scalar; ++c)
        if (free_[static_cast<std::size_t>(6 * i + c)])
          visit(6 * i + c, force[static_cast<std::size_t>(sys.node(i).line)][c]);
  };
  each([&](Index k, double& f) { f -= r_[k]; });
  VecX down = VecX::Zero(sys.size());
  each([&](Index k, double& f) { down[k] = f; });
  const double largest = down.cwiseAbs().maxCoeff();
  if (largest > 0.0) {
    down /= largest;
    // From 1e-8 to a twentieth of the model's size in doublings: a contact found is pressed by at
    // most the way it took to find it.
    for (double way = 1e-8 * length_; way < 0.05 * length_; way *= 2.0) {
      s = begin;
      s.q += way * down;
      int n = 0;
      const Outcome o = newton(Omega, s, n);
      iterations += n;
      if (o == Outcome::converged) return o;
    }
  }
  s = begin;
  const Outcome o = let_down(Omega, s, iterations);
  if (o != Outcome::converged) {
    s = begin;
    why_ = why;
  }
  return o;
}

VecX EquilibriumSolver::spin_of(Index group) const {
  const system::System& sys = running_.system();
  VecX e = VecX::Zero(sys.size());
  for (Index i = 0; i < sys.nodes(); ++i)
    if (const Index l = sys.node(i).line; running_.spinning()[static_cast<std::size_t>(i)] &&
                                          group_[static_cast<std::size_t>(l)] == group)
      e[6 * i + system::spin_phi] = running_.ratio(l);
  return e;
}

void EquilibriumSolver::close_backlash(double Omega, system::State& s, int& iterations) {
  const system::System& sys = running_.system();
  const auto line_of = [&](Index k) { return static_cast<std::size_t>(sys.node(k / 6).line); };
  Index groups = 0;
  for (std::size_t l = 0; l < group_.size(); ++l)
    groups += group_[l] == static_cast<Index>(l) && running_.ratio(static_cast<Index>(l)) != 0.0;
  if (groups < 2) return;
  const double rounding = 1e-12 * length_ * r_.cwiseAbs().maxCoeff();
  const auto& start = sys.pattern().row_start();
  const auto& cols = sys.pattern().cols();
  // The first rotor keeps its hold, as that of a geared pair without backlash does.
  for (std::size_t n = spin_holds_.size(); n-- > 0;) {
    const Index held = spin_holds_[n];
    if (n == 0 && groups == static_cast<Index>(spin_holds_.size())) continue;
    if (!(std::abs(r_[held]) > rounding)) continue;
    const Index group = group_[line_of(held)];
    const VecX e = spin_of(group);
    const double way = (r_[held] < 0 ? 1.0 : -1.0) / e[held];
    const system::State open = s;
    const VecX residual = r_;
    for (double turn = 1e-9; turn < 0.5;
         turn *=
         2.0) {  // rad; a flank that is met is pressed by at most the way it took to find it
      s.q = open.q + turn * way * e;
      if (!running_.blind_tangent(s.frames, Omega, s.q, matrices_)) break;
      Index other = -1;
      for (Index i = 0; i < sys.nodes() && other < 0; ++i) {
        if (!running_.spinning()[static_cast<std::size_t>(i)] ||
            group_[static_cast<std::size_t>(sys.node(i).line)] == group)
          continue;
        double torque = 0, size = 0;
        for (Index b = start[static_cast<std::size_t>(i)];
             b < start[static_cast<std::size_t>(i + 1)]; ++b) {
          const auto row = matrices_.K.block(b).row(system::spin_phi);
          const auto x = e.segment<6>(6 * cols[static_cast<std::size_t>(b)]);
          torque += row.dot(x);
          size += row.cwiseAbs().dot(x.cwiseAbs());
        }
        if (std::abs(torque) > 1e-9 * size)
          other = group_[static_cast<std::size_t>(sys.node(i).line)];
      }
      if (other < 0) continue;
      free_[static_cast<std::size_t>(held)] = 1;
      solver_.reset();
      if (newton(Omega, s, iterations) == Outcome::converged) {
        spin_holds_.erase(spin_holds_.begin() + static_cast<std::ptrdiff_t>(n));
        for (Index& g : group_)
          if (g == group) g = other;
        --groups;
      } else {
        free_[static_cast<std::size_t>(held)] = 0;
        solver_.reset();
        s = open;
      }
      break;
    }
    if (!free_[static_cast<std::size_t>(held)]) {
      s = open;
      r_ = residual;
    }
  }
}

// Pseudo-transient continuation (C. T. Kelley, D. E. Keyes, SIAM J. Numer. Anal. 35, 1998, doi
// 10.1137/S0036142996304796): the implicit Euler steps (D/tau + K) d = -r of the motion D q' = -r,
// in which everything moves along the generalised force on it (moments too), stiff parts as a
// whole. D is 1 for displacements and the square of a tenth of the model for rotations. tau grows
// while the way of a step at most doubles the way so far, and shrinks where a step runs too far
// into a contact; with the residual gone the last steps are Newton's.
EquilibriumSolver::Outcome EquilibriumSolver::let_down(double Omega, system::State& s,
                                                       int& iterations) {
  const system::System& sys = running_.system();
  const Index n = sys.size();
  const auto is_free = [&](Index k) { return free_[static_cast<std::size_t>(k)] != 0; };
  VecX D(n);
  for (Index k = 0; k < n; ++k)
    D[k] = k % 6 < 3 || sys.node(k / 6).scalar ? 1.0 : 0.01 * length_ * length_;
  const auto size_of = [&](const VecX& r) {
    double sum = 0;
    for (Index k = 0; k < n; ++k)
      if (is_free(k)) sum += r[k] * r[k] / D[k];
    return std::sqrt(sum);
  };
  // K + D/tau factored and applied to -r
  const auto solve = [&](double over_tau, const VecX& r, VecX& d) {
    running_.tangent(s.frames, Omega, s.q, matrices_);
    const la::BlockPattern& p = matrices_.K.pattern();
    for (Index i = 0; i < sys.nodes(); ++i)
      for (Index c = 0; c < 6; ++c)
        matrices_.K.block(p.diagonal(i))(c, c) += over_tau * D[6 * i + c];
    if (solver_->factor(matrices_, 0.0, 0.0, 1.0) != la::Status::ok) return false;
    d = -r;
    for (Index k = 0; k < n; ++k)
      if (!is_free(k)) d[k] = 0.0;
    solver_->solve(d);
    return d.allFinite();
  };
  if (!running_.residual(s.frames, Omega, s.q, r_)) return Outcome::singular;
  const double load = size_of(r_);
  if (!(load > 0.0)) return Outcome::singular;
  running_.tangent(s.frames, Omega, s.q, matrices_);
  double stiffest = 0;
  for (Index i = 0; i < sys.nodes(); ++i)
    for (Index c = 0; c < 6; ++c)
      if (is_free(6 * i + c))
        stiffest = std::max(
            stiffest,
            std::abs(matrices_.K.block(matrices_.K.pattern().diagonal(i))(c, c)) / D[6 * i + c]);
  if (!(stiffest > 0.0)) stiffest = load / length_;
  // Is what nothing resists under load at all? With a spring of 1e-9 of the stiffest in every
  // direction that spring then carries much of the load.
  VecX r = r_, d(n);
  const double faint = 1e-9 * stiffest;
  if (!solve(faint, r, d) || size_of(D.cwiseProduct(d)) * faint < 1e-3 * load)
    return Outcome::singular;

  double tau = 1e-8 * length_ / load, way = 0, now = load, tried = load;
  for (int k = 0; k < 400; ++k, ++iterations) {
    if (!solve(1.0 / tau, r, d)) return Outcome::singular;
    const double step = correction_size(d) * length_, most = std::max(1e-8 * length_, way);
    if (step > 2.0 * most) {
      tau *= std::max(0.1, most / step);
      continue;
    }
    trial_ = s.q + d;
    const bool inside = running_.residual(s.frames, Omega, trial_, r_);
    const double after = inside ? size_of(r_) : infinity;
    if (!(after <= std::max(1.5 * load, 0.9 * now))) {
      tau *= 0.25;
      continue;
    }
    s.q = trial_;
    r = r_;
    way += step;
    if (way > 0.5 * length_) return Outcome::singular;
    tau = std::min(tau * std::max(2.0, now / std::max(after, 1e-300)), 1e13 / stiffest);
    now = after;
    if (now < 0.1 * tried) {
      tried = now;
      const system::State here = s;
      int extra = 0;
      const Outcome o = newton(Omega, s, extra);
      iterations += extra;
      if (o == Outcome::converged) return o;
      s = here;
    }
    // Indifferent: in balance, with a motion left that nothing resists and nothing loads (one ball
    // of a bearing with play right under the load).
    if (now < 1e-11 * load) {
      running_.residual(s.frames, Omega, s.q, r_);
      return Outcome::converged;
    }
  }
  return Outcome::singular;
}

}  // namespace whirl::analysis
