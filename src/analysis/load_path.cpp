#include <analysis/load_path.hpp>

#include <core/rotation.hpp>
#include <la/continuation.hpp>
#include <system/problem.hpp>

#include <fmt/format.h>

#include <cmath>

namespace whirl::analysis {
namespace {

constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// R(q, lambda) for la::Continuation. Loads are linear in lambda, so dR/dlambda is a difference of two residuals, exactly.
class Loaded final : public la::ContinuationProblem {
 public:
  Loaded(RunningSystem& running, EquilibriumSolver& solver, double Omega, const system::State& s, const LoadPathOptions& o)
      : running_(running), solver_(solver), Omega_(Omega), frames_(s.frames), scale_(s.q.size()), r1_(s.q.size()), matrices_(running.system().make_matrices()),
        direct_(la::make_direct_solver<double>(running.system().pattern(), solver.free(), o.equilibrium.solver)) {
    const system::System& sys = running.system();
    // Root mean square of displacements over the model's length, and of angles: 1 is as far as things can go.
    double unknowns = 0;
    for (unsigned char a : solver.free()) unknowns += a;
    const double root = std::sqrt(std::max(unknowns, 1.0));
    for (Index k = 0; k < scale_.size(); ++k) scale_[k] = root * (k % 6 < 3 && !sys.node(k / 6).scalar ? solver.length() : 1.0);
    load_scale_ = std::abs(o.last_load) > 0 ? std::abs(o.last_load) : 1.0;
  }
  bool residual(const VecX& q, double lambda, VecX& f) override {
    running_.set_load(lambda);
    if (!running_.residual(frames_, Omega_, q, f)) return false;
    mask(f);
    return true;
  }
  void load(const VecX& q, double lambda, VecX& f) override {
    running_.set_load(lambda + load_scale_);
    running_.residual(frames_, Omega_, q, r1_);
    running_.set_load(lambda - load_scale_);
    running_.residual(frames_, Omega_, q, f);
    f = (r1_ - f) / (2.0 * load_scale_);
    mask(f);
    running_.set_load(lambda);
  }
  bool factor(const VecX& q, double lambda) override {
    running_.set_load(lambda);
    running_.tangent(frames_, Omega_, q, matrices_);
    if (direct_->factor(matrices_, 0.0, 0.0, 1.0) == la::Status::ok) return true;
    const Index k = direct_->singular_unknown();
    const system::System& s = running_.system();
    why = k < 0 ? std::string("the tangent is singular") : fmt::format("the tangent is singular at {} of {}", system::component_name(static_cast<int>(k % 6)), s.node(k / 6).name);
    return false;
  }
  void solve(VecX& b) override { direct_->solve(b); }
  const VecX& scale() const override { return scale_; }
  double mu_scale() const override { return load_scale_; }

  std::string why;

 private:
  void mask(VecX& x) const {
    const auto free = solver_.free();
    for (Index k = 0; k < x.size(); ++k)
      if (!free[at(k)]) x[k] = 0.0;
  }
  RunningSystem& running_;
  EquilibriumSolver& solver_;
  double Omega_;
  system::Frames frames_;
  VecX scale_, r1_;
  double load_scale_ = 1;
  la::MCK matrices_;
  std::unique_ptr<la::DirectSolver<double>> direct_;
};

}  // namespace

LoadPathResult follow_load_path(RunningSystem& running, double Omega, const system::State& start, const LoadPathOptions& o,
                                const std::function<bool(const LoadPathPoint&)>& accept) {
  running.set_load(0.0);
  EquilibriumSolver solver(running, o.equilibrium);
  LoadPathResult out;
  out.last = solver.solve(Omega, &start);
  system::State& s = out.last.state;
  double lambda = 0.0, sign = o.last_load < 0 ? -1.0 : 1.0;
  out.points = 1;
  const bool by_arc = o.controlled < 0;
  bool going = accept({lambda, false, out.last.iterations, &s});
  la::Continuation continuation;
  la::ContinuationOptions c;
  c.tolerance = o.equilibrium.tolerance;
  c.first_step = 1.0 / std::max(o.steps, 1);
  c.max_step = std::max(c.first_step, 0.05);
  while (going && out.end == LoadPathEnd::reached) {
    Loaded problem(running, solver, Omega, s, o);
    if (by_arc) {
      c.last_mu = o.last_load;
      c.direction = sign;
    } else {
      const double to_go = (o.controlled_to - s.q[o.controlled]) / problem.scale()[o.controlled];
      if (to_go == 0.0) break;
      c.controlled = o.controlled;
      c.last_controlled = o.controlled_to;
      c.max_step = std::abs(o.controlled_to / problem.scale()[o.controlled]) / std::max(o.steps, 1);
      c.first_step = std::copysign(c.max_step, to_go);
    }
    bool moved_chart = false, enough = false;
    const auto result = continuation.run(problem, s.q, lambda, c, [&](const VecX&, const la::ContinuationPoint& p) {
      out.last.iterations += p.iterations;
      ++out.points;
      if (p.dmu != 0.0) sign = p.dmu > 0.0 ? 1.0 : -1.0;
      running.set_load(lambda);
      if (o.equilibrium.chart_change) moved_chart = solver.change_charts(s);
      if (!accept({lambda, p.limit_point, p.iterations, &s})) return going = false;
      enough = out.points >= o.max_points;
      return !moved_chart && !enough;
    });
    if (result.status == la::ContinuationStatus::finished) break;
    if (!going) out.end = LoadPathEnd::stopped;
    else if (enough) out.end = LoadPathEnd::too_many_points;
    else if (!moved_chart) out.end = LoadPathEnd::lost, out.why = problem.why.empty() ? "the steps became too short" : problem.why;
  }
  out.load = lambda;
  out.last.load_steps = out.points;
  running.set_load(lambda);
  running.residual(s.frames, Omega, s.q, out.last.reactions);
  for (Index k = 0; k < out.last.reactions.size(); ++k)
    if (solver.free()[at(k)]) out.last.reactions[k] = 0.0;
  return out;
}

}  // namespace whirl::analysis
