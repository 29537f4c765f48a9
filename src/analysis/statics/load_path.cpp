#include <analysis/statics/load_path.hpp>
#include <core/contract.hpp>

#include <core/rotation.hpp>
#include <la/continuation.hpp>
#include <system/problem.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace whirl::analysis {
namespace {

/// R(q, lambda) for la::Continuation. Loads are linear in lambda, so dR/dlambda is a difference of
/// two residuals, exactly.
class Loaded final : public la::ContinuationProblem {
 public:
  /// free: unknowns of the path (those of the solver, but for what a branch holds).
  Loaded(SteadySystem& running, EquilibriumSolver& solver, std::span<const unsigned char> free,
         double Omega, const system::State& s, const LoadPathOptions& o)
      : running_(running),
        free_(free),
        Omega_(Omega),
        frames_(s.frames),
        scale_(s.q.size()),
        r1_(s.q.size()),
        matrices_(running.system().make_matrices()),
        direct_(la::make_direct_solver<double>(running.system().pattern(), free,
                                               o.equilibrium.solver)) {
    const system::System& sys = running.system();
    // Root mean square of displacements over the model's length, and of angles: 1 is as far as
    // things can go.
    double unknowns = 0;
    for (unsigned char a : solver.free())
      unknowns += a;
    const double root = std::sqrt(std::max(unknowns, 1.0));
    for (Index k = 0; k < scale_.size(); ++k)
      scale_[k] = root * (k % 6 < 3 && !sys.node(k / 6).scalar ? solver.length() : 1.0);
    load_scale_ = std::abs(o.last_load) > 0 ? std::abs(o.last_load) : 1.0;
  }
  bool residual(const VecX& q, double lambda, VecX& f) override {
    running_.set_load(lambda);
    if (!running_.residual(frames_, Omega_, q, f)) {
      why = reason_outside(q);
      return false;
    }
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
    if (direct_->factor(matrices_, 0.0, 0.0, 1.0) == la::Status::ok) {
      why.clear();
      return true;
    }
    const Index k = direct_->singular_unknown();
    const system::System& s = running_.system();
    why = k < 0 ? std::string("the tangent is singular")
                : fmt::format("the tangent is singular at {} of {}",
                              system::component_name(static_cast<int>(k % 6)), s.node(k / 6).name);
    return false;
  }
  void solve(VecX& b) override { direct_->solve(b); }
  const VecX& scale() const override { return scale_; }
  double mu_scale() const override { return load_scale_; }
  /// K of the last factor().
  const la::BlockMatrix<6>& tangent() const { return matrices_.K; }

  std::string why;  ///< of the last failure; empty: Newton's iteration itself

 private:
  std::string reason_outside(const VecX& q) const {
    const system::System& s = running_.system();
    for (Index i = 0; i < s.nodes(); ++i)
      if (!s.node(i).scalar && q.segment<2>(6 * i + 4).norm() >= rotation::chart_limit)
        return fmt::format("chart limit at {}: its section is tilted by pi from its axis{}",
                           s.node(i).name, holds_rotation(i) ? hinges_instead : "");
    return "the next state lies outside the range of an element";
  }
  static constexpr const char* hinges_instead =
      ", and a support that holds some of its rotations keeps that axis (a [[joint]] of kind "
      "hinge, "
      "slider or universal has no such limit)";
  bool holds_rotation(Index node) const {
    const auto active = running_.system().active().subspan(at(6 * node + 3), 3);
    return !running_.system().followers().find(node) &&
           std::find(active.begin(), active.end(), 0) != active.end();
  }
  void mask(VecX& x) const {
    for (Index k = 0; k < x.size(); ++k)
      if (!free_[at(k)]) x[k] = 0.0;
  }
  SteadySystem& running_;
  std::span<const unsigned char> free_;
  double Omega_;
  system::Frames frames_;
  VecX scale_, r1_;
  double load_scale_ = 1;
  la::MCK matrices_;
  std::unique_ptr<la::DirectSolver<double>> direct_;
};

/// One path on its way: the tangent's count at each point, critical points, and the continuation
/// that leads from one to the next.
class Follower {
 public:
  using Accept = std::function<bool(const LoadPathPoint&)>;
  Follower(SteadySystem& running, double Omega, const system::State& start,
           const LoadPathOptions& o, const Accept& accept)
      : running_(running),
        Omega_(Omega),
        o_(o),
        accept_(accept),
        solver_(running, o.equilibrium) {
    running.set_load(0.0);
    out_.last = solver_.solve(Omega, &start);
    free_.assign(solver_.free().begin(), solver_.free().end());
    c_.tolerance = o.equilibrium.tolerance;
    c_.first_step = 1.0 / std::max(o.steps, 1);
    c_.max_step = std::max(c_.first_step, 0.05);
    c_.max_steps = std::numeric_limits<int>::max();  // max_points ends the path
  }

  LoadPathResult follow() {
    const system::State& s = out_.last.state;
    out_.points = 1;
    sign_ = o_.last_load < 0 ? -1.0 : 1.0;
    la::MCK m = running_.system().make_matrices();
    running_.tangent(s.frames, Omega_, s.q, m);
    now_ = judge(m.K);
    kept_ = s;
    bool going = accept_({0.0, false, out_.last.iterations, &s, now_});
    if (!going) out_.end = LoadPathEnd::stopped;
    while (going)
      going = follow_on_one_chart();
    if (out_.end == LoadPathEnd::reached && o_.branch != 0 && out_.branched_at < 0)
      out_.end = LoadPathEnd::no_branch;
    return finish();
  }

 private:
  enum class Next { go_on, chart, branch, enough, stop };
  /// A point between two points of the path.
  struct Probe {
    double part = 0, load = 0;
    double mu = nan;  ///< the eigenvalue nearest to zero
    VecX q, shape;    ///< shape: of that eigenvalue
    Definiteness tangent;
  };

  Definiteness judge(const la::BlockMatrix<6>& K) const {
    return judge_tangent(K, solver_.free(), running_.system(), solver_.length(), false);
  }

  /// Continues while the charts stay; whether there is more to follow.
  bool follow_on_one_chart() {
    system::State& s = out_.last.state;
    Loaded problem(running_, solver_, free_, Omega_, s, o_);
    if (o_.controlled < 0) {
      c_.last_mu = o_.last_load;
      c_.direction = sign_;
    } else {
      const double to_go = (o_.controlled_to - s.q[o_.controlled]) / problem.scale()[o_.controlled];
      if (to_go == 0.0) return false;
      c_.controlled = o_.controlled;
      c_.last_controlled = o_.controlled_to;
      c_.max_step =
          std::abs(o_.controlled_to / problem.scale()[o_.controlled]) / std::max(o_.steps, 1);
      c_.first_step = std::copysign(c_.max_step, to_go);
    }
    const VecX leave_along = std::move(leave_along_);
    leave_along_ = VecX();
    c_.start_direction = leave_along.size() > 0 ? &leave_along : nullptr;
    kept_arc_ = 0.0;
    Next next = Next::go_on;
    const auto result = continuation_.run(problem, s.q, load_, c_,
                                          [&](const VecX&, const la::ContinuationPoint& p) {
                                            next = take(problem, p);
                                            return next == Next::go_on;
                                          });
    if (result.status == la::ContinuationStatus::finished && next == Next::go_on) return false;
    switch (next) {
      case Next::chart:
      case Next::branch: return true;
      case Next::stop: out_.end = LoadPathEnd::stopped; return false;
      case Next::enough: out_.end = LoadPathEnd::too_many_points; return false;
      case Next::go_on: break;
    }
    out_.end = LoadPathEnd::lost;
    out_.why = problem.why.empty()
                   ? "Newton's iteration does not converge even in the shortest steps"
                   : problem.why;
    return false;
  }

  /// A point the continuation has found.
  Next take(Loaded& problem, const la::ContinuationPoint& p) {
    system::State& s = out_.last.state;
    out_.last.iterations += p.iterations;
    if (p.dmu != 0.0) sign_ = p.dmu > 0.0 ? 1.0 : -1.0;
    running_.set_load(load_);
    const Definiteness before = now_;
    now_ = judge(problem.tangent());
    if (p.limit_point) add_limit(p, before.negative);
    // a limit point changes the count by one
    const Index change = std::abs(now_.negative - before.negative);
    if (change != (p.limit_point ? 1 : 0) && locate(before.negative)) return Next::branch;
    ++out_.points;
    running_.set_load(load_);
    running_.system().follow(s);
    const bool moved = o_.equilibrium.chart_change && solver_.change_charts(s);
    kept_ = s;
    kept_load_ = load_;
    kept_slope_ = p.dmu;
    kept_arc_ = p.arc;
    if (!accept_({load_, p.limit_point, p.iterations, &s, now_})) return Next::stop;
    if (out_.points >= o_.max_points) return Next::enough;
    return moved ? Next::chart : Next::go_on;
  }

  /// Where the load is stationary between the last two points: on the cubic through both with their
  /// slopes.
  void add_limit(const la::ContinuationPoint& p, Index before) {
    CriticalPoint c;
    c.limit = true;
    c.before = before;
    c.after = now_.negative;
    const double h = p.arc - kept_arc_;
    const double a = kept_slope_ * h;
    const double b = p.dmu * h;
    const double rise = load_ - kept_load_;
    // l(x) = l0 + a x + c2 x^2 + c3 x^3, 0 <= x <= 1, with slope a at 0 and b at 1
    const double c2 = 3.0 * rise - 2.0 * a - b;
    const double c3 = a + b - 2.0 * rise;
    const double root = std::sqrt(std::max(c2 * c2 - 3.0 * a * c3, 0.0));
    const double x = std::clamp(a / (-c2 + std::copysign(root, a)), 0.0, 1.0);
    c.load =
        std::isfinite(x) ? kept_load_ + x * (a + x * (c2 + x * c3)) : 0.5 * (kept_load_ + load_);
    out_.critical.push_back(std::move(c));
  }

  /// Bifurcations between the last point kept and the one just found; true when the path shall
  /// leave at one of them, which is then the state.
  bool locate(Index counted) {
    Loaded problem(running_, solver_, free_, Omega_, kept_, o_);
    const VecX end = out_.last.state.q;
    const double end_load = load_;
    la::Continuation chord;
    VecX shape;
    const auto probe = [&](double part) {
      Probe x;
      x.part = part;
      if (!chord.between(problem, kept_.q, kept_load_, end, end_load, part, c_, x.q, x.load))
        return x;
      problem.factor(x.q, x.load);
      x.tangent = judge(problem.tangent());
      x.mu = eigenvalue_near_zero(problem.tangent(), solver_.free(), running_.system(),
                                  solver_.length(), shape);
      x.shape = shape;
      return x;
    };
    double from = 0.0;
    bool leaves = false;
    for (int found = 0; found < 8 && counted != now_.negative && !leaves; ++found) {
      Probe low, high;
      low.part = from;
      high.part = 1.0;
      high.tangent = now_;
      for (int k = 0; k < 60 && high.part - low.part > 1e-10; ++k) {
        const double width = high.part - low.part;
        const bool secant = low.mu * high.mu < 0.0 && k % 3 != 2;
        const double inside = secant ? low.mu / (low.mu - high.mu) : 0.5;
        const double part = low.part + width * std::clamp(inside, 1e-3, 1.0 - 1e-3);
        Probe x = probe(part);
        // where the tangent is singular no state is found: beside it there is one
        for (const double aside : {1e-5, -1e-5, 1e-3})
          if (std::isnan(x.mu)) x = probe(part + aside * width);
        if (std::isnan(x.mu)) break;
        (x.tangent.negative == counted ? low : high) = std::move(x);
      }
      if (std::isnan(low.mu) && std::isnan(high.mu)) {
        out_.unlocated.push_back({kept_load_, end_load, counted, now_.negative});
        break;
      }
      leaves = add_bifurcation(low, high, counted, problem);
      counted = high.tangent.negative;
      from = high.part;
    }
    if (!leaves) load_ = end_load;
    running_.set_load(load_);
    return leaves;
  }

  /// Notes the point where the eigenvalue vanishes between two probes; true when the path shall
  /// branch there.
  bool add_bifurcation(const Probe& low, const Probe& high, Index before, Loaded& problem) {
    const bool both = low.mu * high.mu < 0.0;
    const Probe& near = both && std::abs(high.mu) < std::abs(low.mu) ? high
                        : std::isnan(low.mu)                         ? high
                                                                     : low;
    const double load =
        both ? low.load + (high.load - low.load) * low.mu / (low.mu - high.mu) : near.load;
    // at a limit point the load does work on the motion, at a bifurcation (of a symmetric tangent)
    // none
    VecX f(near.q.size());
    problem.load(near.q, near.load, f);
    const double work = std::abs(f.dot(near.shape));
    if (near.tangent.symmetric && work > 1e-3 * f.norm() * near.shape.norm()) return false;
    CriticalPoint c;
    c.load = load;
    c.before = before;
    c.after = high.tangent.negative;
    c.state = kept_;
    c.state.q = near.q;
    c.direction = near.shape;
    scale_shape(c.direction, running_.system());
    out_.critical.push_back(std::move(c));
    ++bifurcations_;
    const CriticalPoint& here = out_.critical.back();
    running_.set_load(load);
    accept_({load, false, 0, &here.state, near.tangent, true});
    ++out_.points;
    if (out_.branched_at >= 0 || std::abs(o_.branch) != bifurcations_) return false;
    out_.branched_at = static_cast<int>(out_.critical.size()) - 1;
    out_.last.state = here.state;
    load_ = kept_load_ = load;
    kept_ = here.state;
    kept_slope_ = 0.0;
    now_ = near.tangent;
    VecX along = here.direction;
    const Index together = std::abs(here.after - here.before);
    for (Index k = 1; k < together; ++k)
      hold_one(along, problem);
    leave_along_ = o_.branch < 0 ? VecX(-along) : along;
    return true;
  }

  /// Where two eigenvalues vanish together the branch may be a family (a round column bends in any
  /// plane), along which nothing is resisted. One displacement is held where it is: `along` becomes
  /// the motion that leaves it alone. finish() checks that nothing is held by force.
  void hold_one(VecX& along, Loaded& problem) {
    Index largest = -1;
    for (Index k = 0; k < along.size(); ++k) {
      const bool displacement = k % 6 < 3 && free_[at(k)];
      if (displacement && (largest < 0 || std::abs(along[k]) > std::abs(along[largest])))
        largest = k;
    }
    if (largest < 0) return;
    free_[at(largest)] = 0;
    held_.push_back(largest);
    VecX other;
    eigenvalue_near_zero(problem.tangent(), free_, running_.system(), solver_.length(), other);
    scale_shape(other, running_.system());
    along = other;
  }

  LoadPathResult finish() {
    const system::State& s = out_.last.state;
    out_.load = load_;
    out_.last.load_steps = out_.points;
    running_.set_load(load_);
    running_.residual(s.frames, Omega_, s.q, out_.last.reactions);
    const double largest = out_.last.reactions.cwiseAbs().maxCoeff();
    for (Index k : held_) {
      if (std::abs(out_.last.reactions[k]) <= 1e-6 * largest || out_.end != LoadPathEnd::reached)
        continue;
      out_.end = LoadPathEnd::lost;
      out_.why = fmt::format(
          "several branches leave at the bifurcation, and none along {} of {} = 0",
          system::component_name(static_cast<int>(k % 6)), running_.system().node(k / 6).name);
    }
    for (Index k = 0; k < out_.last.reactions.size(); ++k)
      if (solver_.free()[at(k)]) out_.last.reactions[k] = 0.0;
    out_.tangent = now_;
    return std::move(out_);
  }

  SteadySystem& running_;
  double Omega_;
  const LoadPathOptions& o_;
  const Accept& accept_;
  EquilibriumSolver solver_;
  la::Continuation continuation_;
  la::ContinuationOptions c_;
  LoadPathResult out_;
  Definiteness now_;    ///< at the last point
  system::State kept_;  ///< the last point, with its load, slope of the load and arc length
  double kept_load_ = 0, kept_slope_ = 0, kept_arc_ = 0;
  double load_ = 0, sign_ = 1;
  int bifurcations_ = 0;
  std::vector<unsigned char> free_;  ///< unknowns of the path
  std::vector<Index> held_;          ///< displacements held to choose one of a family of branches
  VecX leave_along_;                 ///< the next stretch starts this way
};

}  // namespace

LoadPathResult follow_load_path(SteadySystem& running, double Omega, const system::State& start,
                                const LoadPathOptions& o,
                                const std::function<bool(const LoadPathPoint&)>& accept) {
  WHIRL_EXPECTS(start.q.size() == running.system().size());
  return Follower(running, Omega, start, o, accept).follow();
}

std::string describe(const LoadPathResult& r) {
  std::string limits;
  for (const CriticalPoint& c : r.critical)
    if (c.limit) limits += fmt::format("{}{:.6g}", limits.empty() ? "" : ", ", c.load);
  if (!limits.empty())
    limits = fmt::format("; it turned back at limit points, load factors {}", limits);
  switch (r.end) {
    case LoadPathEnd::reached:
      return fmt::format("reached its end at load factor {:.6g} after {} points", r.load, r.points);
    case LoadPathEnd::stopped:
      return fmt::format("was stopped at load factor {:.6g} after {} points", r.load, r.points);
    case LoadPathEnd::too_many_points:
      return fmt::format("ended at load factor {:.6g}: max_points, {} points{}", r.load, r.points,
                         limits);
    case LoadPathEnd::no_branch:
      return fmt::format(
          "reached its end at load factor {:.6g} after {} points without the bifurcation it should "
          "branch at",
          r.load, r.points);
    case LoadPathEnd::lost: break;
  }
  return fmt::format("was lost at load factor {:.6g} after {} points: {}{}", r.load, r.points,
                     r.why, limits);
}

}  // namespace whirl::analysis
