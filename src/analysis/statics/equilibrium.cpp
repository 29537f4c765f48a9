#include <analysis/statics/equilibrium.hpp>
#include <analysis/statics/definiteness.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <core/interrupt.hpp>
#include <core/rotation.hpp>
#include <system/problem.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace whirl::analysis {

namespace {

/// Whether the residual r at s is small against the load. Pressed against its wall a film is so
/// stiff that corrections vanish long before the forces balance.
bool balanced(SteadySystem& running, double Omega, const system::State& s, const VecX& r,
              const la::MCK& matrices, std::span<const unsigned char> free) {
  const system::System& sys = running.system();
  const double factor = running.load();
  VecX unloaded(r.size());
  running.set_load(0.0);
  const bool inside = running.residual(s.frames, Omega, s.q, unloaded);
  running.set_load(factor);
  if (!inside) return true;
  const auto& start = sys.pattern().row_start();
  const auto& cols = sys.pattern().cols();
  double load = 0.0;
  for (Index k = 0; k < r.size(); ++k)
    if (k % 6 < 3) load = std::max(load, std::abs(r[k] - unloaded[k]));
  for (Index i = 0; i < sys.nodes() && load > 0.0; ++i) {
    if (sys.node(i).scalar) continue;
    for (Index k = 6 * i; k < 6 * i + 3; ++k) {
      if (!free[at(k)] || std::abs(r[k]) <= 1e-3 * load) continue;
      double products = 0.0;  // rounding of the forces that cancel here
      for (Index b = start[at(i)]; b < start[at(i) + 1]; ++b)
        products += matrices.K.block(b).row(k % 6).cwiseAbs().dot(
            s.q.segment<6>(6 * cols[at(b)]).cwiseAbs());
      if (std::abs(r[k]) > 1e-3 * load + std::min(1e-15 * products, 1e-2 * load)) return false;
    }
  }
  return true;
}
}  // namespace

std::vector<Index> Equilibrium::holds() const {
  std::vector<Index> out = spin_holds;
  out.insert(out.end(), axial_holds.begin(), axial_holds.end());
  return out;
}

EquilibriumSolver::EquilibriumSolver(SteadySystem& running, EquilibriumOptions options)
    : running_(running),
      options_(options),
      free_(running.system().active().begin(), running.system().active().end()),
      r_(running.system().size()) {
  const system::System& s = running.system();
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (Index i = 0; i < s.nodes(); ++i)
    if (!s.node(i).scalar) {
      low = low.cwiseMin(s.node(i).position);
      high = high.cwiseMax(s.node(i).position);
    }
  length_ = (high - low).norm();
  if (!(length_ > 0)) length_ = 1.0;  // one body: metre and radian weigh alike
  find_axial_holds();
}

void EquilibriumSolver::find_axial_holds() {
  const system::System& s = running_.system();
  for (const Index line : running_.running().axially_free) {
    Index first = 0;
    while (first < s.nodes() && (s.node(first).scalar || s.node(first).line != line))
      ++first;
    if (first == s.nodes() || !free_[at(6 * first + system::ux)]) continue;
    axial_holds_.push_back(6 * first + system::ux);
    free_[at(axial_holds_.back())] = 0;
  }
}

void EquilibriumSolver::make_matrices() {
  throw_if_interrupted();
  if (matrices_.M.value_count() == 0) matrices_ = running_.system().make_matrices();
}

struct EquilibriumSolver::SpinMotions {
  std::vector<Index> first;  ///< its first unknown phi, -1: not free
  std::vector<VecX> e, ke;   ///< all its phi by its ratio; K times that
  std::vector<VecX> size;    ///< of the single products, against which "zero" is measured
  std::vector<Index> group;  ///< a line it turns with, or itself
  Index root(Index l) const {
    while (group[at(l)] != l)
      l = group[at(l)];
    return l;
  }
};

EquilibriumSolver::SpinMotions EquilibriumSolver::spin_motions() const {
  const system::System& sys = running_.system();
  const Index L = sys.lines();
  SpinMotions m{std::vector<Index>(at(L), -1), std::vector<VecX>(at(L)), std::vector<VecX>(at(L)),
                std::vector<VecX>(at(L)), std::vector<Index>(at(L))};
  for (Index l = 0; l < L; ++l) {
    m.group[at(l)] = l;
    m.e[at(l)] = VecX::Zero(sys.size());
  }
  for (Index i = 0; i < sys.nodes(); ++i) {
    const Index l = sys.node(i).line, k = 6 * i + system::spin_phi;
    if (!running_.spinning()[at(i)]) continue;
    m.e[at(l)][k] = running_.ratio(l);
    if (m.first[at(l)] < 0) m.first[at(l)] = free_[at(k)] ? k : -1;
  }
  const auto& start = sys.pattern().row_start();
  const auto& cols = sys.pattern().cols();
  for (Index l = 0; l < L; ++l) {
    m.ke[at(l)] = VecX::Zero(sys.size());
    m.size[at(l)] = VecX::Zero(sys.size());
    if (m.first[at(l)] < 0) continue;
    matrices_.K.add_multiply(1.0, m.e[at(l)], m.ke[at(l)]);
    for (Index i = 0; i < sys.nodes(); ++i)
      for (Index b = start[at(i)]; b < start[at(i) + 1]; ++b)
        m.size[at(l)].segment<6>(6 * i) +=
            matrices_.K.block(b).cwiseAbs() * m.e[at(l)].segment<6>(6 * cols[at(b)]).cwiseAbs();
  }
  return m;
}

Index EquilibriumSolver::freely_turning(const SpinMotions& m, Index group) const {
  const system::System& sys = running_.system();
  VecX sum = VecX::Zero(sys.size()), scale = sum;
  Index lead = -1;
  for (Index l = 0; l < sys.lines(); ++l) {
    if (m.root(l) != group) continue;
    sum += m.ke[at(l)];
    scale += m.size[at(l)];
    if (lead < 0) lead = m.first[at(l)];
  }
  if (lead < 0) return -1;
  for (Index i = 0; i < sys.nodes(); ++i)  // a prescribed angle holds its whole group
    if (running_.spinning()[at(i)] && m.root(sys.node(i).line) == group &&
        !sys.active()[at(6 * i + 3)] && !sys.followers().find(i))
      return -1;
  double torque = 0;
  for (Index k = 3; k < sys.size(); k += 6)
    torque = std::max(torque, scale[k]);
  for (Index k = 0; k < sys.size(); ++k) {
    const double least = std::max(scale[k], k % 6 < 3 ? torque / length_ : torque);
    if (free_[at(k)] && std::abs(sum[k]) > 1e-9 * least) return -1;
  }
  return lead;
}

void EquilibriumSolver::find_spin_holds(const system::State& s, double Omega) {
  // A rotor turns freely when K times the motion "all its phi by its ratio" vanishes to rounding.
  // What sees phi (weight on an unbalance) holds it in no useful sense and is left out.
  const system::System& sys = running_.system();
  const Index L = sys.lines();
  make_matrices();
  if (!running_.blind_tangent(s.frames, Omega, s.q, matrices_)) return;
  SpinMotions motions = spin_motions();
  // Lines whose torques meet (gears, couplings) are one rotor.
  for (Index l = 0; l < L; ++l)
    for (Index m = 0; m < l; ++m) {
      bool meet = false;
      for (Index k = 0; k < sys.size() && !meet; ++k)
        meet = motions.e[at(m)][k] != 0.0 &&
               std::abs(motions.ke[at(l)][k]) > 1e-9 * motions.size[at(l)][k];
      if (meet) motions.group[at(motions.root(l))] = motions.root(m);
    }
  // At rest the weight of a bow or a flat would turn a free rotor, as that of an unbalance would: all
  // stand where they are. On joints a shaft may hold another one by its stiffness.
  std::optional<SpinMotions> without_shafts;
  if (running_.shafts_see_angle() && sys.followers().empty() &&
      running_.tangent_without_shafts(s.frames, Omega, s.q, matrices_)) {
    without_shafts = spin_motions();
    without_shafts->group = motions.group;
  }
  for (Index g = 0; g < L; ++g) {
    if (motions.root(g) != g) continue;
    Index lead = freely_turning(motions, g);
    if (lead < 0 && without_shafts) lead = freely_turning(*without_shafts, g);
    if (lead < 0) continue;
    spin_holds_.push_back(lead);
    free_[at(lead)] = 0;
  }
  group_.resize(at(L));
  for (Index l = 0; l < L; ++l)
    group_[at(l)] = motions.root(l);
}

bool EquilibriumSolver::resists(const VecX& e) const {
  const system::System& sys = running_.system();
  const auto& start = sys.pattern().row_start();
  const auto& cols = sys.pattern().cols();
  for (Index i = 0; i < sys.nodes(); ++i) {
    Vector<6> sum = Vector<6>::Zero(), size = sum;
    for (Index b = start[at(i)]; b < start[at(i) + 1]; ++b) {
      const auto x = e.segment<6>(6 * cols[at(b)]);
      sum += matrices_.K.block(b) * x;
      size += matrices_.K.block(b).cwiseAbs() * x;
    }
    // forces against forces, moments against moments: small couplings are not rounding of each
    // other
    const double force = size.head<3>().maxCoeff(), moment = size.tail<3>().maxCoeff();
    for (Index k = 0; k < 6; ++k)
      if (free_[at(6 * i + k)] && std::abs(sum[k]) > 1e-9 * (k < 3 ? force : moment)) return true;
  }
  return false;
}

std::string EquilibriumSolver::free_motions(std::span<const Index> part) const {
  const system::System& sys = running_.system();
  constexpr const char* motion[4] = {"axial motion", "lateral motion along y",
                                     "lateral motion along z", "turning about its axis"};
  std::string name;
  for (std::size_t k = 0; k < part.size(); ++k)
    name += fmt::format("{}'{}'",
                        k == 0                 ? (part.size() > 1 ? "shafts " : "shaft ")
                        : k + 1 == part.size() ? " and "
                                               : ", ",
                        sys.line_name(part[k]));
  if (part.size() > 1) name += " on their joints";
  std::string free;
  for (int c = 0; c < (part.size() > 1 ? 3 : 4); ++c) {
    VecX e = VecX::Zero(sys.size());
    for (Index i = 0; i < sys.nodes(); ++i)
      if (const Index k = 6 * i + c;
          std::find(part.begin(), part.end(), sys.node(i).line) != part.end() &&
          !sys.node(i).scalar && free_[at(k)])
        e[k] = 1.0;
    if (!e.isZero(0.0) && !resists(e))
      free += fmt::format("{}{} of {}", free.empty() ? "" : ", nor ", motion[c], name);
  }
  return free;
}

std::vector<std::vector<Index>> EquilibriumSolver::jointed_parts() const {
  const system::System& sys = running_.system();
  std::vector<Index> root(at(sys.lines()));
  std::iota(root.begin(), root.end(), Index{0});
  const auto root_of = [&](Index l) {
    while (root[at(l)] != l)
      l = root[at(l)];
    return l;
  };
  for (std::size_t k = 0; k < sys.followers().count(); ++k) {
    const system::FollowerDef& f = sys.followers()[k];
    root[at(root_of(sys.node(f.node).line))] = root_of(sys.node(f.parent).line);
  }
  std::vector<unsigned char> placed(at(sys.lines()),
                                    0);  // not the lines of coordinates and crosses
  for (Index i = 0; i < sys.nodes(); ++i) {
    const system::FollowerDef* f = sys.followers().find(i);
    const bool moves =
        f ? !f->between
          : std::find(&free_[at(6 * i)], &free_[at(6 * i)] + 6, 1) != &free_[at(6 * i)] + 6;
    if (!sys.node(i).scalar && moves) placed[at(sys.node(i).line)] = 1;
  }
  std::vector<std::vector<Index>> parts(at(sys.lines()));
  for (Index l = 0; l < sys.lines(); ++l)
    if (placed[at(l)]) parts[at(root_of(l))].push_back(l);
  std::erase_if(parts, [](const auto& p) { return p.size() < 2; });
  return parts;
}

std::string EquilibriumSolver::name_motion(Index singular) const {
  // A line that K lets go as a whole, or lines on joints together, else the unknown at which
  // elimination found nothing left.
  const system::System& sys = running_.system();
  std::string free;
  const auto add = [&free](const std::string& more) {
    if (!more.empty()) free += (free.empty() ? "" : ", nor ") + more;
  };
  for (Index l = 0; l < sys.lines(); ++l)
    add(free_motions({&l, 1}));
  if (free.empty())
    for (const std::vector<Index>& part : jointed_parts())
      add(free_motions(part));
  if (!free.empty()) return "nothing resists " + free;
  if (singular < 0) return "the stiffness matrix is singular";
  return fmt::format("nothing resists a motion along {} of {}",
                     system::component_name(static_cast<int>(singular % 6)),
                     sys.node(singular / 6).name);
}

double EquilibriumSolver::correction_size(const VecX& d) const {
  double m = 0;
  const system::System& s = running_.system();
  for (Index k = 0; k < d.size(); ++k)
    m = std::max(m, std::abs(d[k]) / (k % 6 < 3 && !s.node(k / 6).scalar ? length_ : 1.0));
  return m;
}

bool EquilibriumSolver::is_small(const VecX& d, const VecX& q) const {
  WHIRL_EXPECTS(d.size() == q.size());
  // Displacements against the largest displacement, tilts against the largest tilt, twists against
  // the largest twist. Below 1e-15 of the model's size (rad) nothing more can be asked.
  const system::System& s = running_.system();
  double now[4] = {}, all[4] = {};
  for (Index k = 0; k < d.size(); ++k) {
    const int c = s.node(k / 6).scalar ? 3 : k % 6 < 3 ? 0 : k % 6 == 3 ? 1 : 2;
    now[c] = std::max(now[c], std::abs(d[k]));
    all[c] = std::max(all[c], std::abs(q[k]));
  }
  for (int c = 0; c < 4; ++c)
    if (now[c] > std::max(options_.tolerance * all[c], c == 0 ? 1e-15 * length_ : 1e-15))
      return false;
  return true;
}

EquilibriumSolver::Outcome EquilibriumSolver::newton(double Omega, system::State& s,
                                                     int& iterations) {
  const VecX begin = s.q;
  Outcome o = newton(Omega, s, iterations, Step::bold);
  if (o == Outcome::diverged) {
    s.q = begin;
    o = newton(Omega, s, iterations, Step::careful);
  }
  if (o == Outcome::diverged && running_.system().relaxes()) {
    s.q = begin;
    running_.relax(s.frames, Omega, s.q);
    o = newton(Omega, s, iterations, Step::relaxed);
  }
  return o;
}

void EquilibriumSolver::clear_held(VecX& x) const {
  for (Index k = 0; k < x.size(); ++k)
    if (!free_[at(k)]) x[k] = 0.0;
}

double EquilibriumSolver::step_boldly(double Omega, const system::State& s, double size) {
  double alpha = std::min(1.0, 0.5 / size);
  for (int halving = 0; halving < 10; ++halving, alpha *= 0.5) {
    trial_ = s.q + alpha * step_;
    if (running_.residual(s.frames, Omega, trial_, r_)) return alpha;
  }
  return 0.0;
}

double EquilibriumSolver::step_carefully(double Omega, const system::State& s, double size,
                                         double most, Step kind) {
  double alpha = most;
  for (int halving = 0; halving < 30; ++halving, alpha *= 0.5) {
    trial_ = s.q + alpha * step_;
    if (kind == Step::relaxed && size > 1e-6) running_.relax(s.frames, Omega, trial_);
    if (!running_.residual(s.frames, Omega, trial_, r_)) continue;
    next_ = r_;
    clear_held(next_);
    solver_->solve(next_);
    const double after = correction_size(next_);
    if (after <= (1.0 - 0.25 * alpha) * size || (alpha == 1.0 && size < 1e-8)) return alpha;
    if (alpha < (kind == Step::relaxed ? 1e-3 : 1e-6)) break;
  }
  return 0.0;
}

bool EquilibriumSolver::settle(double Omega, system::State& s) {
  s.q += step_;
  if (!running_.residual(s.frames, Omega, s.q, r_)) {
    s.q -= step_;
    running_.residual(s.frames, Omega, s.q, r_);
  }
  return balanced(running_, Omega, s, r_, matrices_, free_);
}

EquilibriumSolver::Outcome EquilibriumSolver::newton(double Omega, system::State& s,
                                                     int& iterations, Step kind) {
  const system::System& sys = running_.system();
  make_matrices();
  if (!solver_) solver_ = la::make_direct_solver<double>(sys.pattern(), free_, options_.solver);
  if (!running_.residual(s.frames, Omega, s.q, r_)) {
    why_ = "the state lies outside the range of an element or of the tilt (pi)";
    return Outcome::diverged;
  }
  double last = infinity, damping = 1.0, first = infinity;
  for (int it = 0; it < options_.max_iterations; ++it, ++iterations) {
    step_ = r_;
    clear_held(step_);
    if (step_.isZero(0.0)) return Outcome::converged;
    running_.tangent(s.frames, Omega, s.q, matrices_);
    if (solver_->factor(matrices_, 0.0, 0.0, 1.0) != la::Status::ok) {
      why_ = name_motion(solver_->singular_unknown());
      return Outcome::singular;
    }
    solver_->solve(step_);
    step_ = -step_;
    const double size = correction_size(step_);
    if (it == 0) first = std::max(size, 1e-3);
    if (!std::isfinite(size)) {
      why_ = "a correction is not finite";
      return Outcome::diverged;
    }
    // A start that needs no correction stays what it is to the last bit: sweeps over speed rely on
    // it.
    if (it == 0 && is_small(step_, s.q) && balanced(running_, Omega, s, r_, matrices_, free_))
      return Outcome::converged;
    // Converged, or as small as rounding lets it become.
    if (is_small(step_, s.q) || (damping == 1.0 && size < 1e-8 && size > 0.25 * last)) {
      if (settle(Omega, s)) return Outcome::converged;
      last = size;
      continue;
    }
    double taken = kind == Step::bold
                       ? step_boldly(Omega, s, size)
                       : step_carefully(Omega, s, size, std::min(1.0, 2.0 * damping), kind);
    if (kind == Step::bold && size > 1e4 * first) taken = 0.0;
    if (taken == 0.0) {
      why_ = "Newton's iteration finds no descent";
      return Outcome::diverged;
    }
    s.q = trial_;
    damping = taken;
    last = size;
  }
  why_ = no_convergence();
  return Outcome::diverged;
}

std::string EquilibriumSolver::no_convergence() const {
  const system::System& sys = running_.system();
  Index worst = 0;
  for (Index k = 0; k < step_.size(); ++k) {
    const auto weight = [&](Index i) {
      return std::abs(step_[i]) / (i % 6 < 3 && !sys.node(i / 6).scalar ? length_ : 1.0);
    };
    if (weight(k) > weight(worst)) worst = k;
  }
  return fmt::format("no convergence in {} iterations; the largest correction is that of {} of {}",
                     options_.max_iterations, system::component_name(static_cast<int>(worst % 6)),
                     sys.node(worst / 6).name);
}

bool EquilibriumSolver::change_charts(system::State& s) const {
  const system::System& sys = running_.system();
  sys.follow(s);
  sys.followers().keep_turns(s.frames, s.q);
  bool far = false;
  for (Index i = 0; i < sys.nodes() && !far; ++i)
    far = !sys.node(i).scalar && s.q.segment<2>(6 * i + 4).norm() > rotation::chart_switch;
  if (!far) return false;
  system::SystemProblem problem(sys);
  problem.frames = s.frames;
  const bool moved = problem.accept(s.t, s.q, s.v, s.a);
  s.frames = problem.frames;
  return moved;
}

bool EquilibriumSolver::load_in_steps(double Omega, double t, Equilibrium& out) {
  system::State& s = out.state;
  const double full = running_.load();
  const double largest = options_.load_steps > 1 ? 1.0 / options_.load_steps : 1.0;
  double done = 0.0, step = std::min(0.25, largest);
  // pads that right themselves at each trial take their time (also step_carefully)
  const double least = running_.system().relaxes() ? 1e-3 : 1e-6;
  const std::vector<double> values = s.frames.kept;  // temperatures of films stay
  s = running_.system().make_state();
  s.frames.kept = values;
  s.t = t;
  running_.impose(s.frames, s.q);
  running_.set_rates(Omega, s.v);
  running_.relax(s.frames, Omega, s.q);
  system::State kept = s;
  out.load_steps = 0;
  bool first = true;
  while (true) {
    const double factor = first ? 0.0 : std::min(1.0, done + step);
    running_.set_load(full * factor);
    s = kept;
    int n = 0;
    const Outcome o = newton(Omega, s, n);
    out.iterations += n;
    ++out.load_steps;
    if (o == Outcome::converged) {
      if (options_.chart_change) change_charts(s);
      kept = s;
      done = factor;
      if (factor == 1.0) break;
      if (!first && n <= 6) step = std::min(2.0 * step, largest);
      first = false;
    } else {
      step *= 0.5;
      if (first || step < least || out.load_steps >= options_.max_load_steps) {
        why_ += fmt::format(" (at {:.6g} rpm and {:.4g} of the load)", to_rpm(Omega),
                            first ? 0.0 : done);
        running_.set_load(full);
        return false;
      }
    }
  }
  running_.set_load(full);
  running_.residual(s.frames, Omega, s.q, r_);
  return true;
}

namespace {

/// No internal unknown has been anywhere yet.
bool has_fresh_scalars(const system::System& s, const VecX& q) {
  for (Index i = 0; i < s.nodes(); ++i)
    if (s.node(i).scalar && !q.segment(6 * i, s.node(i).scalars).isZero(0.0)) return false;
  return true;
}

}  // namespace

void EquilibriumSolver::find_holds_once(const system::State& s, double Omega) {
  if (!holds_known_) find_spin_holds(s, Omega);
  holds_known_ = true;
}

void EquilibriumSolver::list_holds(const system::State& state, Equilibrium& e) {
  find_holds_once(state, e.Omega);
  e.spin_holds = spin_holds_;
  e.axial_holds = axial_holds_;
}

bool EquilibriumSolver::attracts(double Omega, const system::State& s) {
  running_.tangent(s.frames, Omega, s.q, matrices_);
  // a pad by itself; of two of them the tangent as a whole may say nothing
  const system::System& sys = running_.system();
  for (Index i = 0; i < sys.nodes(); ++i)
    for (Index k = 0; sys.node(i).scalar && k < sys.node(i).scalars; ++k)
      if (free_[at(6 * i + k)] && matrices_.K.block(matrices_.K.pattern().diagonal(i))(k, k) < 0.0)
        return false;
  const Definiteness d = judge_tangent(matrices_.K, free_, running_.system(), length_, false);
  return !d.judged || d.stable();
}

bool EquilibriumSolver::drift_from(const system::State& begin, double Omega, bool found,
                                   Equilibrium& out) {
  const system::State repelling = out.state;
  const std::string why = why_;
  out.state = begin;
  if (drift(Omega, out.state, out.iterations) == Outcome::converged &&
      (!found || attracts(Omega, out.state)))
    return true;
  if (found) {  // or from where it repels, to one side and the other
    constexpr double aside = 1e-6;
    for (const double side : {aside, -aside}) {
      out.state = repelling;
      VecX moved = VecX::Constant(out.state.q.size(), side);
      for (Index k = 0; k < moved.size(); ++k)
        if (k % 6 < 3 && !running_.system().node(k / 6).scalar) moved[k] *= length_;
      clear_held(moved);
      out.state.q += moved;
      if (drift(Omega, out.state, out.iterations) == Outcome::converged &&
          attracts(Omega, out.state))
        return true;
    }
  }
  why_ = why;
  out.state = repelling;
  running_.residual(repelling.frames, Omega, repelling.q, r_);
  return false;
}

std::optional<Equilibrium> EquilibriumSolver::try_solve(double Omega, const system::State* start) {
  throw_if_interrupted();
  const system::System& sys = running_.system();
  Equilibrium out;
  out.Omega = Omega;
  out.state = start ? *start : sys.make_state();
  system::State& s = out.state;
  s.t = running_.running().time;
  running_.impose(s.frames, s.q);
  running_.set_rates(Omega, s.v);
  s.a.setZero();
  find_holds_once(s, Omega);
  for (Index k : spin_holds_)
    s.q[k] = 0.0;
  if (has_fresh_scalars(sys, s.q)) running_.relax(s.frames, Omega, s.q);

  const system::State begin = s;
  Outcome o = options_.load_steps > 1 ? Outcome::diverged : newton(Omega, s, out.iterations);
  if (o == Outcome::singular) {
    s = begin;
    o = close_gaps(Omega, s, out.iterations);
  }
  const bool found = o == Outcome::converged || load_in_steps(Omega, begin.t, out);
  // Among pads that balance themselves there are equilibria that repel beside those that attract.
  if (!found || (sys.relaxes() && !attracts(Omega, s))) {
    out.drifted = drift_from(begin, Omega, found, out);
    if (!found && !out.drifted) return std::nullopt;
  }
  if (!spin_holds_.empty()) close_backlash(Omega, s, out.iterations);
  if (options_.chart_change) change_charts(s);
  sys.follow(s);
  out.reactions = r_;
  for (Index k = 0; k < r_.size(); ++k)
    if (free_[at(k)]) out.reactions[k] = 0.0;
  out.spin_holds = spin_holds_;
  out.axial_holds = axial_holds_;
  return out;
}

namespace {

/// What stands against a steady rotation of the model, whatever the speed; empty: nothing.
std::string obstacle_to_turning(const SteadySystem& running) {
  VecX v(running.system().size());
  try {
    running.set_rates(1.0, v);
  } catch (const Error& e) {
    const Diagnostic& d = e.diagnostics().front();
    if (d.code == "E41") return d.message;
  }
  return {};
}

}  // namespace

Equilibrium EquilibriumSolver::solve(double Omega, const system::State* start) {
  WHIRL_EXPECTS(std::isfinite(Omega));
  WHIRL_EXPECTS(!start || start->q.size() == running_.system().size());
  const auto is_cold = [&] {
    return start->frames.kept == running_.system().make_state().frames.kept;
  };
  if (!start || running_.system().keepers().empty() || is_cold()) return solve_from(Omega, start);
  try {
    return solve_from(Omega, start);
  } catch (const Error&) {
    // temperatures of another speed may hold what these here do not, or lead astray
    return solve_from(Omega, nullptr);
  }
}

Equilibrium EquilibriumSolver::solve_from(double Omega, const system::State* start) {
  auto out = try_solve(Omega, start);
  if (out) {
    balance_kept(Omega, *out);
    return std::move(*out);
  }
  const bool singular = why_.starts_with("nothing resists");
  const std::string contradiction = singular ? obstacle_to_turning(running_) : std::string();
  if (!contradiction.empty())
    throw run_error("E75", why_ + "; " + contradiction,
                    "give lines that are joined rigidly the same 'rotating' and speed_ratio, or a "
                    "joint that lets one turn in the other");
  if (singular)
    throw run_error("E75", why_,
                    "add a support in that direction, or hold it rigidly; at a high load: "
                    "the structure is at a limit point or buckles");
  throw NoEquilibrium(
      run_error("E76", "no equilibrium found: " + why_,
                "the load may lie beyond a limit point (try the buckling analysis), "
                "or a bearing beyond its capacity"),
      Omega);
}

}  // namespace whirl::analysis
