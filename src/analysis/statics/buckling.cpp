#include <analysis/statics/buckling.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <la/block_lu.hpp>
#include <la/eigen.hpp>
#include <system/stiffness_rate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Largest displacement relative to the model's size, and largest rotation.
struct Size {
  double displacement = 0, rotation = 0;
};
Size size_of(const system::System& s, const VecX& u) {
  const double length = model_length(s);
  Size out;
  for (Index k = 0; k < u.size(); ++k) {
    const bool displaced = k % 6 < 3 && !s.node(k / 6).scalar;
    double& largest = displaced ? out.displacement : out.rotation;
    largest = std::max(largest, std::abs(u[k]) / (displaced ? length : 1.0));
  }
  return out;
}

Eigen::Map<VecX> values(la::BlockMatrix<6>& m) {
  return {m.data(), static_cast<Index>(m.value_count())};
}

/// Terms whose derivative along the response is not known exactly: with joints none is, which carry
/// forces along as they turn.
std::vector<std::size_t> other_terms(const system::System& s) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < s.terms().size(); ++k)
    if (!s.followers().empty() || !system::find_stiffness_rate(*s.terms()[k])) out.push_back(k);
  return out;
}

/// dK/dt of the terms in `only` along q' = u by central differences of steps h and h/2,
/// extrapolated; at the state of a visit.
class Differences {
 public:
  Differences(const system::System& s, const std::vector<std::size_t>& only, double h)
      : system_(s),
        only_(only),
        h_(h),
        workspace_(s.make_workspace()),
        plus_(s.make_matrices()),
        minus_(s.make_matrices()) {}
  void add(const system::Context& context, const system::Frames& frames, const VecX& q,
           const VecX& v, const VecX& u, double weight, la::BlockMatrix<6>& out) {
    if (only_.empty()) return;
    workspace_.context = context;
    const VecX a = VecX::Zero(q.size());
    for (const auto& [h, share] : {std::pair{h_, -1.0 / 3.0}, std::pair{0.5 * h_, 4.0 / 3.0}}) {
      const bool inside =
          system_.tangent(workspace_, frames, context.time, q + h * u, v, a, plus_, &only_) &&
          system_.tangent(workspace_, frames, context.time, q - h * u, v, a, minus_, &only_);
      if (!inside)
        throw run_error(
            "E76",
            "no linearised buckling: the response to the loads leaves the range of an element");
      values(out) += (weight * share / (2.0 * h)) * (values(plus_.K) - values(minus_.K));
    }
  }

 private:
  const system::System& system_;
  const std::vector<std::size_t>& only_;
  double h_;
  system::Workspace workspace_;
  la::MCK plus_, minus_;
};

/// What the response u changes of K at a steady state, the mean over the revolution.
void add_rate(SteadySystem& running, const system::State& s, double Omega, const VecX& u,
              la::BlockMatrix<6>& out) {
  const system::System& system = running.system();
  const std::vector<std::size_t> others = other_terms(system);
  const Size response = size_of(system, u);
  Differences differences(system, others,
                          1e-5 / std::max({response.displacement, response.rotation, 1e-300}));
  VecX v(system.size());
  running.set_rates(Omega, v);
  running.visit_revolution(s.frames, Omega, s.q, [&](double weight, const system::Workspace& w) {
    VecX turned = s.q;
    for (Index i = 0; i < system.nodes(); ++i)
      turned[6 * i + system::spin_phi] = w.nodes[at(i)].phi;
    if (system.followers().empty())
      system::add_stiffness_rate({system, w, s.frames, turned, u}, weight, out);
    differences.add(w.context, s.frames, turned, v, u, weight, out);
  });
}

/// Largest displacement 1 (a complex shape keeps its phases).
void scale(VecXc& x, Index nodes) {
  Complex top = 0;
  for (Index i = 0; i < nodes; ++i)
    for (int c = 0; c < 3; ++c)
      if (std::abs(x[6 * i + c]) > std::abs(top) * (1 + 1e-9)) top = x[6 * i + c];
  if (std::abs(top) > 0) x /= top;
}

/// Largest |a_ij - a_ji| over the largest |a_ij| among free unknowns.
double asymmetry(const la::BlockMatrix<6>& a, std::span<const unsigned char> free) {
  const la::BlockPattern& p = a.pattern();
  double apart = 0, size = 0;
  for (Index i = 0; i < p.size(); ++i)
    for (Index k = p.row_start()[at(i)]; k < p.row_start()[at(i) + 1]; ++k) {
      const Index j = p.cols()[at(k)];
      const Matrix<6> here = a.block(k);
      const Matrix<6> there = a.block(p.slot(j, i)).transpose();
      for (Index r = 0; r < 6; ++r)
        for (Index c = 0; c < 6; ++c) {
          if (!free[at(6 * i + r)] || !free[at(6 * j + c)]) continue;
          apart = std::max(apart, std::abs(here(r, c) - there(r, c)));
          size = std::max(size, std::abs(here(r, c)));
        }
    }
  return size > 0 ? apart / size : 0.0;
}

/// Negative eigenvalues of K0 - mu B; -1: singular.
Index negative_at(const la::MCK& K0, const la::BlockMatrix<6>& B, double mu, la::MCK& work,
                  la::BlockLu<double>& lu) {
  values(work.K) = Eigen::Map<const VecX>(K0.K.data(), static_cast<Index>(K0.K.value_count())) -
                   mu * Eigen::Map<const VecX>(B.data(), static_cast<Index>(B.value_count()));
  if (lu.factor(work, 0.0, 0.0, 1.0) != la::Status::ok) return -1;
  return lu.negative_eigenvalues();
}

Error nothing_buckles() {
  return run_error("E79", "no load that is scaled changes the stiffness of the model",
                   "give a load along a shaft, or a moment; heat, preloads and places that are "
                   "forced are not scaled: they are in the stiffness already");
}

Definiteness judge(const la::BlockMatrix<6>& K0, const EquilibriumSolver& solver,
                   const system::System& system) {
  return judge_tangent(K0, solver.free(), system, solver.length(), false);
}

/// Factors of K0 x = mu B x against those listed.
BucklingCount count_factors(const la::MCK& K0, const la::BlockMatrix<6>& B,
                            std::span<const unsigned char> free,
                            const std::vector<BucklingMode>& listed) {
  constexpr double rounding = 1e-10;   // of a symmetric matrix
  constexpr double below_last = 1e-6;  // relative
  BucklingCount out;
  if (listed.empty()) return {false, "there is none"};
  if (asymmetry(K0.K, free) > rounding || asymmetry(B, free) > rounding)
    return {false,
            "stiffness or its change with the loads is not symmetric, factors may be complex"};
  la::MCK work = K0;
  la::BlockLu<double> lu(K0.K.pattern(), free);
  if (negative_at(K0, B, 0.0, work, lu) != 0)
    return {false, "the rotor is not in stable equilibrium without its loads"};
  out.up_to = (1.0 - below_last) * std::abs(listed.back().factor);
  out.positive = negative_at(K0, B, out.up_to, work, lu);
  out.negative = negative_at(K0, B, -out.up_to, work, lu);
  if (out.positive < 0 || out.negative < 0) return {false, "a factorisation failed"};
  out.counted = true;
  const Index found = std::count_if(listed.begin(), listed.end(), [&](const BucklingMode& m) {
    return std::abs(m.factor) < out.up_to;
  });
  out.missing = out.positive + out.negative - found;
  return out;
}

/// What the loads change of K0 at the rest state: zero where it is rounding of equal sums, and with
/// the change of K along the response u to them.
la::BlockMatrix<6> load_stiffness(SteadySystem& running, const system::State& rest, double Omega,
                                  la::MCK& K0, la::MCK& loaded, const VecX& u) {
  la::BlockMatrix<6> B(running.system().pattern());
  values(B) = values(loaded.K) - values(K0.K);
  values(B) =
      (values(B).array().abs() <= 1e-14 * values(K0.K).array().abs()).select(0.0, values(B));
  add_rate(running, rest, Omega, u, B);
  return B;
}

}  // namespace

Buckling buckling(SteadySystem& running, double Omega, Index count,
                  const EquilibriumOptions& options) {
  WHIRL_EXPECTS(count > 0);
  const system::System& system = running.system();
  EquilibriumSolver solver(running, options);
  const double full = running.load();
  running.set_load(0.0);
  Buckling out;
  out.unloaded = solver.solve(Omega);
  const system::State& rest = out.unloaded.state;
  if (rest.frames.moved())
    throw run_error("E76",
                    "no linearised buckling: without the loads a section is already tilted by more "
                    "than 1.5 rad from its line",
                    "follow the load path: it has no such limit");
  la::MCK K0 = system.make_matrices(), loaded = K0;
  VecX r0(system.size()), u(system.size());
  running.residual(rest.frames, Omega, rest.q, r0);
  running.tangent(rest.frames, Omega, rest.q, K0);
  running.set_load(full);
  running.residual(rest.frames, Omega, rest.q, u);
  running.tangent(rest.frames, Omega, rest.q, loaded);
  running.set_load(0.0);

  // the linear response to the loads
  u = r0 - u;
  for (Index k = 0; k < u.size(); ++k)
    if (!solver.free()[at(k)]) u[k] = 0.0;
  const auto direct =
      la::make_direct_solver<double>(system.pattern(), solver.free(), options.solver);
  if (direct->factor(K0, 0.0, 0.0, 1.0) != la::Status::ok) {
    running.set_load(full);
    throw run_error("E75", "nothing resists a motion of the unloaded rotor",
                    "add a support in that direction, or hold it rigidly");
  }
  direct->solve(u);
  system.complete(rest, u);

  la::BlockMatrix<6> B = load_stiffness(running, rest, Omega, K0, loaded, u);
  running.set_load(full);
  const double change = values(B).cwiseAbs().maxCoeff(),
               stiffness = values(K0.K).cwiseAbs().maxCoeff();
  const Size response = size_of(system, u);
  // against what a response of 1e-5 would change
  const double share = 1e-5 / std::max({response.displacement, response.rotation, 1e-300});
  const Definiteness unloaded = judge(K0.K, solver, system);
  const auto note_unloaded = [&] {
    out.count.unstable = unloaded.negative;
    out.count.unstable_certain = unloaded.certain;
  };
  if (!(change * std::min(share, 1.0) > 1e-15 * stiffness)) {
    if (unloaded.stable()) throw nothing_buckles();
    out.count.why_not = "no load that is scaled changes the stiffness of the model";
    note_unloaded();
    return out;
  }
  values(B) *= -1.0;
  for (const la::Mode& m : la::linear_modes(K0.K, B, solver.free(), count)) {
    const double by = std::abs(m.lambda);
    BucklingMode b{m.lambda, m.x, by * response.rotation, by * response.displacement};
    system.complete(rest, b.x);
    scale(b.x, system.nodes());
    out.modes.push_back(std::move(b));
  }
  out.count = count_factors(K0, B, solver.free(), out.modes);
  note_unloaded();
  return out;
}

void require_loads(SteadySystem& running, double Omega, const EquilibriumOptions& options) {
  const system::System& system = running.system();
  EquilibriumSolver solver(running, options);
  const double full = running.load();
  running.set_load(0.0);
  const system::State rest = solver.solve(Omega).state;
  VecX without(system.size()), with(system.size());
  la::MCK K0 = system.make_matrices(), loaded = K0;
  running.residual(rest.frames, Omega, rest.q, without);
  running.tangent(rest.frames, Omega, rest.q, K0);
  running.set_load(full);
  running.residual(rest.frames, Omega, rest.q, with);
  running.tangent(rest.frames, Omega, rest.q, loaded);
  if (with == without && values(K0.K) == values(loaded.K) && judge(K0.K, solver, system).stable())
    throw nothing_buckles();
}

PathCheck check_on_path(SteadySystem& running, double Omega, double factor,
                        const EquilibriumOptions& options) {
  LoadPathOptions o;
  o.equilibrium = options;
  o.last_load = 1.25 * factor * running.load();
  o.steps = 10;
  o.max_points = 400;
  const double full = running.load();
  PathCheck out;
  const LoadPathResult r = follow_load_path(running, Omega, running.system().make_state(), o,
                                            [&](const LoadPathPoint& p) {
                                              out.load = p.load;
                                              return !p.bifurcation && p.tangent.stable();
                                            });
  running.set_load(full);
  out.load /= full;
  if (!r.critical.empty()) {
    out.found = true;
    out.limit = r.critical.front().limit;
    out.load = r.critical.front().load / full;
  } else if (!r.unlocated.empty()) {
    const Unlocated& u = r.unlocated.front();
    out.ended =
        fmt::format("loses stability between load factors {:.6g} and {:.6g}; where was not found",
                    u.from / full, u.to / full);
  } else if (r.end == LoadPathEnd::stopped) {
    out.found = true;  // unstable from the beginning
  } else if (r.end != LoadPathEnd::reached) {
    out.ended = describe(r);
  }
  return out;
}

}  // namespace whirl::analysis
