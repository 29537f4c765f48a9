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

Index EquilibriumSolver::group_met(const VecX& e, Index group) const {
  const system::System& sys = running_.system();
  const auto& start = sys.pattern().row_start();
  const auto& cols = sys.pattern().cols();
  for (Index i = 0; i < sys.nodes(); ++i) {
    const Index own = group_[at(sys.node(i).line)];
    if (!running_.spinning()[at(i)] || own == group) continue;
    double torque = 0, size = 0;
    for (Index b = start[at(i)]; b < start[at(i + 1)]; ++b) {
      const auto row = matrices_.K.block(b).row(system::spin_phi);
      const auto x = e.segment<6>(6 * cols[at(b)]);
      torque += row.dot(x);
      size += row.cwiseAbs().dot(x.cwiseAbs());
    }
    if (std::abs(torque) > 1e-9 * size) return own;
  }
  return -1;
}

Index EquilibriumSolver::turn_until_met(Index held, double Omega, system::State& s,
                                        int& iterations) {
  const Index group = group_[at(running_.system().node(held / 6).line)];
  const VecX e = spin_of(group);
  const double way = (r_[held] < 0 ? 1.0 : -1.0) / e[held];
  const VecX open = s.q;
  // rad; a flank that is met is pressed by at most the way it took to find it
  for (double turn = 1e-9; turn < 0.5; turn *= 2.0) {
    s.q = open + turn * way * e;
    if (!running_.blind_tangent(s.frames, Omega, s.q, matrices_)) return -1;
    const Index other = group_met(e, group);
    if (other < 0) continue;
    free_[at(held)] = 1;
    solver_.reset();
    if (newton(Omega, s, iterations) == Outcome::converged) return other;
    free_[at(held)] = 0;
    solver_.reset();
    return -1;
  }
  return -1;
}

void EquilibriumSolver::close_backlash(double Omega, system::State& s, int& iterations) {
  const system::System& sys = running_.system();
  Index groups = 0;
  for (std::size_t l = 0; l < group_.size(); ++l)
    groups += group_[l] == static_cast<Index>(l) && running_.ratio(static_cast<Index>(l)) != 0.0;
  if (groups < 2) return;
  const double rounding = 1e-12 * length_ * r_.cwiseAbs().maxCoeff();
  // The first rotor keeps its hold, as that of a geared pair without backlash does.
  for (std::size_t n = spin_holds_.size(); n-- > 0;) {
    const Index held = spin_holds_[n];
    if (n == 0 && groups == static_cast<Index>(spin_holds_.size())) continue;
    if (!(std::abs(r_[held]) > rounding)) continue;
    const system::State open = s;
    const VecX residual = r_;
    const Index group = group_[at(sys.node(held / 6).line)];
    const Index other = turn_until_met(held, Omega, s, iterations);
    if (other < 0) {
      s = open;
      r_ = residual;
      continue;
    }
    spin_holds_.erase(spin_holds_.begin() + static_cast<std::ptrdiff_t>(n));
    for (Index& g : group_)
      if (g == group) g = other;
    --groups;
  }
}

// Pseudo-transient continuation (C. T. Kelley, D. E. Keyes, SIAM J. Numer. Anal. 35, 1998, doi
// 10.1137/S0036142996304796): the implicit Euler steps (D/tau + K) d = -r of the motion D q' = -r,
// in which everything moves along the generalised force on it (moments too), stiff parts as a
// whole. D is 1 for displacements and the square of a tenth of the model for rotations. tau grows
// while the way of a step at most doubles the way so far, and shrinks where a step runs too far
// into a contact; with the residual gone the last steps are Newton's.
struct EquilibriumSolver::LetDown {
  EquilibriumSolver& of;
  double Omega;
  system::State& s;
  VecX D, r, d;  ///< r: residual at s; d: the last step
  double stiffest = 0;

  LetDown(EquilibriumSolver& solver, double speed, system::State& state)
      : of(solver),
        Omega(speed),
        s(state),
        D(state.q.size()),
        d(state.q.size()) {
    for (Index k = 0; k < D.size(); ++k) {
      const bool displacement = k % 6 < 3 || of.running_.system().node(k / 6).scalar;
      D[k] = displacement ? 1.0 : 0.01 * of.length_ * of.length_;
    }
  }
  bool is_free(Index k) const { return of.free_[at(k)] != 0; }
  double size_of(const VecX& x) const {
    double sum = 0;
    for (Index k = 0; k < x.size(); ++k)
      if (is_free(k)) sum += x[k] * x[k] / D[k];
    return std::sqrt(sum);
  }
  /// Largest diagonal entry of D^-1 K at s, or where there is none what load and length give.
  void find_stiffest(double load) {
    of.running_.tangent(s.frames, Omega, s.q, of.matrices_);
    const la::BlockMatrix<6>& K = of.matrices_.K;
    for (Index k = 0; k < D.size(); ++k)
      if (is_free(k)) {
        const double entry = K.block(K.pattern().diagonal(k / 6))(k % 6, k % 6);
        stiffest = std::max(stiffest, std::abs(entry) / D[k]);
      }
    if (!(stiffest > 0.0)) stiffest = load / of.length_;
  }
  /// K + D/tau factored and applied to -r.
  bool solve(double over_tau) {
    of.running_.tangent(s.frames, Omega, s.q, of.matrices_);
    la::BlockMatrix<6>& K = of.matrices_.K;
    for (Index k = 0; k < D.size(); ++k)
      K.block(K.pattern().diagonal(k / 6))(k % 6, k % 6) += over_tau * D[k];
    if (of.solver_->factor(of.matrices_, 0.0, 0.0, 1.0) != la::Status::ok) return false;
    d = -r;
    of.clear_held(d);
    of.solver_->solve(d);
    return d.allFinite();
  }
  Outcome run(double load, int& iterations);
};

/// load: size of the residual at the start.
EquilibriumSolver::Outcome EquilibriumSolver::LetDown::run(double load, int& iterations) {
  const double length = of.length_;
  double tau = 1e-8 * length / load, way = 0, now = load, tried = load;
  for (int k = 0; k < 400; ++k, ++iterations) {
    if (!solve(1.0 / tau)) return Outcome::singular;
    const double step = of.correction_size(d) * length, most = std::max(1e-8 * length, way);
    if (step > 2.0 * most) {
      tau *= std::max(0.1, most / step);
      continue;
    }
    of.trial_ = s.q + d;
    const bool inside = of.running_.residual(s.frames, Omega, of.trial_, of.r_);
    const double after = inside ? size_of(of.r_) : infinity;
    if (!(after <= std::max(1.5 * load, 0.9 * now))) {
      tau *= 0.25;
      continue;
    }
    s.q = of.trial_;
    r = of.r_;
    way += step;
    if (way > 0.5 * length) return Outcome::singular;
    tau = std::min(tau * std::max(2.0, now / std::max(after, 1e-300)), 1e13 / stiffest);
    now = after;
    if (now < 0.1 * tried) {
      tried = now;
      const system::State here = s;
      int extra = 0;
      const Outcome o = of.newton(Omega, s, extra);
      iterations += extra;
      if (o == Outcome::converged) return o;
      s = here;
    }
    // Indifferent: in balance, with a motion left that nothing resists and nothing loads (one ball
    // of a bearing with play right under the load).
    if (now < 1e-11 * load) {
      of.running_.residual(s.frames, Omega, s.q, of.r_);
      return Outcome::converged;
    }
  }
  return Outcome::singular;
}

EquilibriumSolver::Outcome EquilibriumSolver::let_down(double Omega, system::State& s,
                                                       int& iterations) {
  if (!running_.residual(s.frames, Omega, s.q, r_)) return Outcome::singular;
  LetDown down(*this, Omega, s);
  const double load = down.size_of(r_);
  if (!(load > 0.0)) return Outcome::singular;
  down.find_stiffest(load);
  // Is what nothing resists under load at all? With a spring of 1e-9 of the stiffest in every
  // direction that spring then carries much of the load.
  down.r = r_;
  const double faint = 1e-9 * down.stiffest;
  if (!down.solve(faint) || down.size_of(down.D.cwiseProduct(down.d)) * faint < 1e-3 * load)
    return Outcome::singular;
  return down.run(load, iterations);
}

}  // namespace whirl::analysis
