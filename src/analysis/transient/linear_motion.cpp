#include <analysis/transient/linear_motion.hpp>

#include <core/error.hpp>
#include <la/multiply.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Largest difference of the lateral entries of two matrices, relative to the diagonals they stand
/// between.
double difference(const la::BlockMatrix<6>& x, const la::BlockMatrix<6>& y, const VecX& diagonal) {
  const la::BlockPattern& p = x.pattern();
  double worst = 0.0;
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[at(i)]; s < p.row_start()[at(i) + 1]; ++s) {
      const Index j = p.cols()[at(s)];
      for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b) {
          if (a == system::spin_phi || b == system::spin_phi) continue;
          const double size = std::sqrt(diagonal[6 * i + a] * diagonal[6 * j + b]);
          if (size > 0.0)
            worst = std::max(worst, std::abs(x.block(s)(a, b) - y.block(s)(a, b)) / size);
        }
    }
  return worst;
}

VecX diagonal_of(const la::BlockMatrix<6>& x) {
  const la::BlockPattern& p = x.pattern();
  VecX d = VecX::Zero(6 * p.size());
  for (Index i = 0; i < p.size(); ++i)
    d.segment<6>(6 * i) = x.block(p.slot(i, i)).diagonal().cwiseAbs();
  return d;
}

/// An unbalance moves the mass of a station by a share of 1e-6 or so; a key way or a second moment
/// of area shows more.
constexpr double turning_share = 1e-3;

}  // namespace

LinearMotion::LinearMotion(const system::System& system, const SteadyRotation& running,
                           double Omega, const system::State& start, EquilibriumOptions options)
    : SystemProblem(system, {la::SolverKind::automatic, false}),
      still_(VecX::Zero(system.size())),
      q_(system.size()),
      v_(system.size()),
      a_(system.size()),
      steady_(system.make_workspace()) {
  Linearizer linear(system, running, options);
  linear.start_from(start);
  const la::MCK& m = linear.at(Omega);
  const system::State& e = linear.equilibrium().state;
  if (e.frames.moved() || start.frames.moved())
    throw run_error("E39", "the rotor tilts too far for small motions",
                    "leave linear out of the step");
  if (linear.running().phase_dependent()) {
    la::MCK turned = system.make_matrices();
    const VecX K = diagonal_of(m.K), M = diagonal_of(m.M);
    double worst = 0.0;
    for (double theta : {0.4, 1.9}) {
      linear.running().tangent_at(e.frames, Omega, e.q, theta, turned);
      worst = std::max({worst, difference(turned.K, m.K, K), difference(turned.M, m.M, M)});
    }
    if (worst > turning_share)
      throw run_error("E39",
                      "the matrices turn with the rotor: its stiffness or inertia is not the same "
                      "in all directions",
                      "leave linear out of the step");
  }
  la::MCK& kept = kept_matrices();
  for (auto [to, from] :
       {std::pair(&kept.M, &m.M), std::pair(&kept.C, &m.C), std::pair(&kept.K, &m.K)})
    std::copy_n(from->data(), from->value_count(), to->data());

  q0_ = e.q;
  v0_ = e.v;
  const auto spinning = linear.running().spinning();
  turns_.assign(spinning.begin(), spinning.end());
  angle_ = VecX::Zero(system.lines());
  std::vector<unsigned char> seen(at(system.lines()), 0);
  for (Index l = 0; l < system.lines(); ++l)
    rate_.push_back(Omega * linear.running().ratio(l));
  for (Index i = 0; i < system.nodes(); ++i) {
    const Index l = system.node(i).line;
    if (!turns_[at(i)] || seen[at(l)]) continue;
    seen[at(l)] = 1;
    angle_[l] = start.total_phi(i, l) - q0_[6 * i + system::spin_phi] - rate_[at(l)] * start.t;
  }
  frames = start.frames;
  find_changing(start.t);
}

void LinearMotion::take_joint_loads() {
  const system::Followers& followers = system().followers();
  const auto& terms = system().terms();
  for (std::size_t k = 0; k < terms.size(); ++k) {
    std::vector<Index> touched;
    terms[k]->list_nodes(touched);
    if (std::any_of(touched.begin(), touched.end(), [&](Index i) { return followers.find(i); }))
      joined_.push_back(k);
  }
  steady_q_ = steady_v_ = plus_ = minus_ = VecX::Zero(system().size());
}

bool LinearMotion::add_joint_loads(double t, time::CRef a, time::Ref r) {
  // so small a part of the motion that its cube is nothing, and the difference still exact to 1e-8
  double size = 0;
  for (Index i = 0; i < system().nodes(); ++i)
    size = std::max(size, q_.segment<6>(6 * i).cwiseAbs().maxCoeff());
  const double h = size > 0 ? std::min(1e-5 / size, 1e3) : 1.0;
  const auto loads_at = [&](double part, VecX& out) {
    return system().residual(steady_, frames, t, steady_q_ + part * q_, steady_v_ + part * v_,
                             part * a, out, &joined_);
  };
  if (!loads_at(h, plus_) || !loads_at(-h, minus_)) return false;
  const system::Followers& followers = system().followers();
  for (std::size_t k = 0; k < followers.count(); ++k) {
    const Index n = followers[k].pinned ? 3 : 6, first = 6 * followers[k].node;
    r.segment(first, n) += (plus_.segment(first, n) - minus_.segment(first, n)) / (2.0 * h);
  }
  return true;
}

void LinearMotion::find_changing(double t) {
  // A term is constant when it sees neither the angles of the rotor nor the time, nor the weight
  // where the base accelerates.
  std::vector<double> rate(at(system().nodes()), 0.0);
  for (Index i = 0; i < system().nodes(); ++i)
    if (turns_[at(i)]) rate[at(i)] = rate_[at(system().node(i).line)];
  system::Context now = steady_.context;
  now.time = t;
  std::vector<std::size_t> still;
  const auto& terms = system().terms();
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const system::Dependence d = terms[k]->depends(now);
    const bool changes =
        d.time || (d.weight && system().base_moves()) || terms[k]->sees_turning(now, rate);
    (changes ? changing_ : still).push_back(k);
  }
  constant_ = VecX::Zero(system().size());
  if (!system().residual(steady_, frames, t, q0_, v0_, still_, constant_,
                         &still)) {  // leave it to residual() to say so
    changing_.insert(changing_.end(), still.begin(), still.end());
    constant_.setZero();
  }
}

double LinearMotion::power_beside(time::CRef v, time::CRef residual) {
  // the general residual at the node states of the last evaluation
  system::Workspace& w = workspace();
  for (auto& x : w.force)
    x.setZero();
  for (const auto& term : system().terms())
    term->add_force(w);
  general_.resize(v.size());
  if (!system().followers().empty()) system().followers().carry_force(w, frames, general_);
  for (Index i = 0; i < system().nodes(); ++i) {
    const Vector<7>& f = w.force[at(i)];
    general_.segment<3>(6 * i) = f.head<3>();
    general_[6 * i + system::spin_phi] = f[6];
    general_.segment<2>(6 * i + 4) = w.D[at(i)].transpose() * f.segment<3>(3);
  }
  // loads of joints stand where their nodes have no unknowns: they do no work
  const system::Followers& followers = system().followers();
  for (std::size_t k = 0; k < followers.count(); ++k) {
    const Index n = followers[k].pinned ? 3 : 6, first = 6 * followers[k].node;
    general_.segment(first, n) = residual.segment(first, n);
  }
  const double power = v.dot(general_ - residual);
  return std::isfinite(power) ? power : nan;
}

time::Problem::Power LinearMotion::power_here(time::CRef v, time::CRef reactions) {
  Power p = SystemProblem::power_here(v, reactions);
  p.supplied += power_beside(v, reactions);
  return p;
}

time::Problem::Power LinearMotion::exchange_here(time::CRef v, time::CRef reactions) {
  Power p = SystemProblem::exchange_here(v, reactions);
  p.supplied += power_beside(v, reactions);
  return p;
}

bool LinearMotion::residual(double t, time::CRef q, time::CRef v, time::CRef a, time::Ref r) {
  q_ = q0_;
  v_ = v0_;
  for (Index i = 0; i < system().nodes(); ++i)
    if (turns_[at(i)]) {
      const Index l = system().node(i).line;
      q_[6 * i + system::spin_phi] += (angle_[l] - two_pi * frames.turns[at(l)]) + rate_[at(l)] * t;
    }
  if (!system().residual(steady_, frames, t, q_, v_, still_, r, &changing_)) return false;
  r += constant_;
  if (!joined_.empty()) {
    steady_q_ = q_;
    steady_v_ = v_;
  }
  q_ = q - q_;
  v_ = v - v_;
  if (!joined_.empty() && !add_joint_loads(t, a, r)) return false;
  a_ = a;
  if (a_.isZero(0.0))  // before the first correction of a step
    la::add_forces(matrices(), q_, v_, r);
  else
    la::add_forces(matrices(), q_, v_, a_, r);
  return true;
}

}  // namespace whirl::analysis
