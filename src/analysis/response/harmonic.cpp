#include <analysis/response/harmonic.hpp>
#include <core/contract.hpp>

#include <la/dense.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Size of a variation: differences of second order in it drop out by symmetry, third order is
/// below rounding.
double variation_step(const VecXc& a) {
  const double largest = std::sqrt(a.cwiseAbs2().maxCoeff());
  return largest > 0 ? 1e-7 / largest : 0.0;
}

VecXc times(const la::BlockMatrix<6>& matrix, const VecXc& x) {
  VecX re = VecX::Zero(x.size()), im = re;
  matrix.add_multiply(1.0, VecX(x.real()), re);
  matrix.add_multiply(1.0, VecX(x.imag()), im);
  return re.cast<Complex>() + Complex(0, 1) * im.cast<Complex>();
}

/// Size of the single torques whose sum in row k is zero but for rounding when nothing drives the
/// rotor round.
double torque_size(const system::System& s, const la::MCK& m, const VecXc& x, const VecXc& f,
                   Index k) {
  const Index node = k / 6, line = s.node(node).line;
  double size = 0;
  for (Index i = 0; i < s.nodes(); ++i)
    if (s.node(i).line == line) size += std::abs(f[6 * i + system::spin_phi]);
  const auto& start = s.pattern().row_start();
  for (Index i = 0; i < s.nodes(); ++i) {
    if (s.node(i).line != line) continue;
    for (Index b = start[at(i)]; b < start[at(i) + 1]; ++b) {
      const Index j = s.pattern().cols()[at(b)];
      size = std::max(
          size,
          (m.K.block(b).row(system::spin_phi).cwiseAbs() * x.segment<6>(6 * j).cwiseAbs()).value());
    }
  }
  return size;
}

/// The inertia of a rotor that is free to turn drowns in the rounding of its torsional stiffness.
bool too_slow(const system::System& s, const la::MCK& m, double w, Index spin) {
  constexpr double least = 1e-8;
  const Index line = s.node(spin / 6).line;
  const auto own = [&](const la::BlockMatrix<6>& x, Index node) {
    return std::abs(x.block(s.pattern().slot(node, node))(system::spin_phi, system::spin_phi));
  };
  double inertia = 0.0;
  for (Index i = 0; i < s.nodes(); ++i)
    if (s.node(i).line == line && s.pattern().diagonal(i) >= 0) inertia += own(m.M, i);
  return w * w * inertia < least * own(m.K, spin / 6);
}

double extent_of(const system::System& s) {
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (Index i = 0; i < s.nodes(); ++i) {
    if (s.node(i).scalar) continue;
    low = low.cwiseMin(s.node(i).position);
    high = high.cwiseMax(s.node(i).position);
  }
  return (high - low).cwiseMax(0.0).norm();
}
}  // namespace

HarmonicSolver::HarmonicSolver(Linearizer& linear, Motion motion)
    : linear_(linear),
      motion_(linear.system(), motion, linear.running().spinning()),
      solver_(la::make_direct_solver<Complex>(linear.system().pattern(), motion_.active())) {}

bool HarmonicSolver::prepare(double Omega, double w) {
  WHIRL_EXPECTS(std::isfinite(Omega) && std::isfinite(w));
  const la::MCK& m = motion_.reduce(linear_.at(Omega, Complex(0, w)));
  matrices_ = &m;
  w_ = w;
  spin_free_ = false;
  const auto& spin_holds = linear_.equilibrium().spin_holds;
  const bool slow = std::any_of(spin_holds.begin(), spin_holds.end(), [&](Index k) {
    return motion_.takes_part(k) && too_slow(linear_.system(), m, w, k);
  });
  if (w != 0.0 && !slow &&
      solver_->factor(m, Complex(-w * w, 0), Complex(0, w), Complex(1, 0)) == la::Status::ok)
    return true;
  std::vector<Index> spins, axial;
  // A line that is free along its axis is never pushed along it (E32): at w = 0 it may stand anywhere.
  for (const Index k : linear_.equilibrium().axial_holds)
    if (w == 0.0 && motion_.takes_part(k)) axial.push_back(k);
  for (const Index k : spin_holds)
    if (motion_.takes_part(k)) spins.push_back(k);
  if (spins.empty() && axial.empty())
    return w == 0.0 &&
           solver_->factor(m, Complex(0, 0), Complex(0, 0), Complex(1, 0)) == la::Status::ok;
  spin_free_ = hold(m, w, std::move(spins), axial);
  return spin_free_;
}

bool HarmonicSolver::hold(const la::MCK& m, double w, std::vector<Index> unknowns,
                          const std::vector<Index>& axial) {
  std::vector<unsigned char> active(motion_.active().begin(), motion_.active().end());
  for (const Index k : unknowns)
    active[at(k)] = 0;
  for (const Index k : axial)
    active[at(k)] = 0;
  held_.at = std::move(unknowns);
  if (held_.active != active || !held_.solver) {
    held_.active = std::move(active);
    held_.solver = la::make_direct_solver<Complex>(linear_.system().pattern(), held_.active);
  }
  return held_.solver->factor(m, Complex(-w * w, 0), Complex(0, w), Complex(1, 0)) ==
         la::Status::ok;
}

void HarmonicSolver::solve(VecXc& x) {
  WHIRL_EXPECTS(matrices_ != nullptr);
  WHIRL_EXPECTS(x.size() == linear_.system().size());
  for (Index k = 0; k < x.size(); ++k)
    if (!motion_.takes_part(k)) x[k] = 0;
  bounded_.resize(0);
  if (spin_free_)
    solve_held(x);
  else
    solver_->solve(x);
  linear_.system().complete(linear_.equilibrium().state, x);
  if (bounded_.size() > 0) linear_.system().complete(linear_.equilibrium().state, bounded_);
}

void HarmonicSolver::solve_columns(MatXc& x) {
  WHIRL_EXPECTS(matrices_ != nullptr);
  WHIRL_EXPECTS(x.rows() == linear_.system().size());
  if (!spin_free_) {
    for (Index k = 0; k < x.rows(); ++k)
      if (!motion_.takes_part(k)) x.row(k).setZero();
    solver_->solve_columns(x);
  }
  for (Index j = 0; j < x.cols(); ++j) {
    column_ = x.col(j);
    if (spin_free_)
      solve(column_);
    else
      linear_.system().complete(linear_.equilibrium().state, column_);
    x.col(j) = column_;
  }
}

VecXc HarmonicSolver::multiply(const VecXc& x) const {
  WHIRL_EXPECTS(matrices_ != nullptr);
  VecXc out = times(matrices_->K, x);
  if (w_ != 0.0) out += inertia_and_damping(x);
  return out;
}

void HarmonicSolver::solve_moving(VecXc& x) const {
  for (Index k = 0; k < x.size(); ++k)
    if (!held_.active[at(k)]) x[k] = 0;
  held_.solver->solve(x);
}

void HarmonicSolver::solve_held(VecXc& x) {
  const VecXc f = x;
  solve_moving(x);
  const VecXc rest =
      f - multiply(x);  // what the holds must exert: the torques that drive the rotors round
  if (w_ != 0.0) {
    VecXc driving = VecXc::Zero(rest.size());
    for (const Index k : held_.at)
      if (std::abs(rest[k]) > 1e-12 * torque_size(linear_.system(), *matrices_, x, f, k))
        driving[k] = rest[k];
    // Their inertia and damping take the torque up: turning by c, then what that does to the twist.
    const MatX spins = free_spins();
    const VecXc c = la::pivoted_solution(spin_matrix(spins, matrices_->M, matrices_->C),
                                         spins.transpose().cast<Complex>() * driving);
    VecXc turned = spins.cast<Complex>() * c;
    VecXc left = driving - inertia_and_damping(turned);
    solve_moving(left);
    constexpr double many_turns = 1e3;  // rad: their rounding is no force
    if (turned.cwiseAbs().maxCoeff() > many_turns) bounded_ = x + left;
    x += turned + left;
    // A matrix that is singular at a frequency of the twist has no answer at all.
    const VecXc wrong = f - multiply(x);
    for (const Index k : held_.at)
      if (std::abs(wrong[k]) > 1e-6 * torque_size(linear_.system(), *matrices_, x, f, k)) {
        x.setConstant(Complex(nan, nan));
        bounded_.resize(0);
        return;
      }
    return;
  }
  // Rounding leaves some torque where there is none.
  VecXc driving = VecXc::Zero(rest.size());
  for (const Index k : held_.at)
    if (std::abs(rest[k]) > 1e-9 * torque_size(linear_.system(), *matrices_, x, f, k))
      driving[k] = rest[k];
  if (driving.isZero(0.0))
    add_free_spin(x);
  else
    add_driven_spin(driving, x);
}

VecXc HarmonicSolver::inertia_and_damping(const VecXc& x) const {
  return Complex(0, w_) * times(matrices_->C, x) - w_ * w_ * times(matrices_->M, x);
}

MatXc HarmonicSolver::spin_matrix(const MatX& spins, const la::BlockMatrix<6>& M,
                                  const la::BlockMatrix<6>& C) const {
  MatXc out(spins.cols(), spins.cols());
  for (Index j = 0; j < spins.cols(); ++j) {
    VecX mass = VecX::Zero(spins.rows()), damping = mass;
    M.add_multiply(1.0, spins.col(j), mass);
    C.add_multiply(1.0, spins.col(j), damping);
    out.col(j) = spins.transpose().cast<Complex>() *
                 (Complex(0, w_) * damping.cast<Complex>() - w_ * w_ * mass.cast<Complex>());
  }
  return out;
}

MatX HarmonicSolver::free_spins() const {
  const Index unknowns = linear_.system().size(), n = static_cast<Index>(held_.at.size());
  MatX spins(unknowns, n);
  // Nothing but rounding moves a journal where its shaft turns, and its damping would be taken for one
  // of the spin.
  constexpr double rounding = 1e-10;
  const double length = extent_of(linear_.system());
  for (Index j = 0; j < n; ++j) {
    VecX e = VecX::Zero(unknowns), pull = e;
    e[held_.at[at(j)]] = 1.0;
    matrices_->K.add_multiply(-1.0, e, pull);
    VecXc follow = pull.cast<Complex>();
    solve_moving(follow);
    spins.col(j) = follow.real() + e;
    for (Index k = 0; k < unknowns; ++k)
      if (std::abs(spins(k, j)) < rounding * (k % 6 < 3 ? length : 1.0)) spins(k, j) = 0.0;
  }
  return spins;
}

void HarmonicSolver::add_driven_spin(const VecXc& driving, VecXc& x) {
  const MatX spins = free_spins();
  // Of a torque T the damping of the free spins, or else their inertia, takes up all as w goes to 0: they
  // turn by T/(i w c) or -T/(w^2 J), and load the rotor by what does not depend on w.
  for (const la::BlockMatrix<6>* matrix : {&matrices_->C, &matrices_->M}) {
    MatX images(spins.rows(), spins.cols());
    for (Index j = 0; j < spins.cols(); ++j) {
      VecX image = VecX::Zero(spins.rows());
      matrix->add_multiply(1.0, spins.col(j), image);
      images.col(j) = image;
    }
    const MatX on_spins = spins.transpose() * images;
    const VecXc torque = spins.transpose().cast<Complex>() * driving;
    MatX parts(torque.size(), 2);
    parts << torque.real(), torque.imag();
    const double least = 1e-9 * (spins.cwiseAbs().transpose() * images.cwiseAbs()).maxCoeff();
    if (!(least > 0.0)) continue;
    const auto taken = la::pivoted_solution(on_spins, parts, least);
    if (!taken) continue;
    const VecXc share = taken->col(0).cast<Complex>() + Complex(0, 1) * taken->col(1);
    VecXc left = driving - images.cast<Complex>() * share;
    solve_moving(left);
    x += left;
    break;
  }
  bounded_ = x;
  for (Index j = 0; j < spins.cols(); ++j)
    for (Index k = 0; k < x.size(); ++k)
      if (spins(k, j) != 0.0) x[k] = Complex(nan, nan);
}

void HarmonicSolver::add_free_spin(VecXc& x) const {
  const MatX spins = free_spins();
  // As w goes to 0 the torques of damping on the free spins vanish, and where there is no damping
  // those of inertia.
  for (const la::BlockMatrix<6>* matrix : {&matrices_->C, &matrices_->M}) {
    MatX on_spins(spins.cols(), spins.cols());
    double size = 0;
    for (Index j = 0; j < spins.cols(); ++j) {
      VecX image = VecX::Zero(x.size());
      matrix->add_multiply(1.0, spins.col(j), image);
      on_spins.col(j) = spins.transpose() * image;
      size = std::max(size, spins.col(j).cwiseAbs().dot(image.cwiseAbs()));
    }
    const VecXc on_x = spins.transpose().cast<Complex>() * times(*matrix, x);
    if (!(size > 0)) continue;
    MatX parts(on_x.size(), 2);
    parts << on_x.real(), on_x.imag();
    const auto turns = la::pivoted_solution(on_spins, parts, 1e-9 * size);
    if (!turns) continue;
    const VecXc turn = turns->col(0).cast<Complex>() + Complex(0, 1) * turns->col(1);
    x -= spins.cast<Complex>() * turn;
    return;
  }
}

bool turns_about(const PointAmplitude& below, const PointAmplitude& above) {
  const double sense = (below.y * std::conj(above.y) + below.z * std::conj(above.z)).real();
  const double size = std::sqrt((std::norm(below.y) + std::norm(below.z)) *
                                (std::norm(above.y) + std::norm(above.z)));
  return sense < -0.5 * size;
}

PointAmplitude amplitude_at(const Linearizer& linear, const VecXc& a, const Point& p) {
  WHIRL_EXPECTS(a.size() == linear.system().size());
  WHIRL_EXPECTS(p.node >= 0 && p.node < linear.system().nodes());
  const Eigen::Vector3cd u = local_displacement(linear, a, p.node);
  const double sense = linear.sense(p.node);
  if (p.offset == 0.0) return {u[1], u[2], sense};
  // d = e + gamma x e about a nearly straight equilibrium: gamma3 along e2, -gamma2 along e3
  return {u[1] + p.offset * a[6 * p.node + 5], u[2] - p.offset * a[6 * p.node + 4], sense};
}

double largest_displacement(const system::System& system, const VecXc& a) {
  WHIRL_EXPECTS(a.size() == system.size());
  double size = 0;
  for (Index i = 0; i < system.nodes(); ++i)
    if (!system.node(i).scalar) size = std::max(size, a.segment<3>(6 * i).norm());
  return size;
}

void drop_rounding(double size, std::span<PointAmplitude> at) {
  constexpr double share = 1e-11;
  for (PointAmplitude& p : at)
    if (p.orbit().major < share * size) p.y = p.z = 0;
}

bool DrivenProblem::residual(double t, time::CRef q, time::CRef v, time::CRef a, time::Ref r) {
  if (!SystemProblem::residual(t, q, v, a, r)) return false;
  r -= force;
  return true;
}

VariationMeter::VariationMeter(Linearizer& linear)
    : linear_(linear),
      problem_(linear.system()),
      snapshot_(problem_) {}

void VariationMeter::measure(const VecXc& a, const VecXc& force, double w,
                             const std::vector<Measurement>& what,
                             std::vector<std::vector<Complex>>& out) {
  WHIRL_EXPECTS(a.size() == linear_.system().size() && force.size() == a.size());
  const system::State& s = linear_.equilibrium().state;
  problem_.frames = s.frames;
  system::Context& context = problem_.workspace().context;
  context.hysteretic = linear_.hysteretic();
  context.whirl = context.whirl_side = w;
  context.frequency = std::abs(w);
  out.resize(what.size());
  for (std::size_t m = 0; m < what.size(); ++m)
    out[m].assign(what[m].width(), Complex(0, 0));
  if (!a.allFinite()) {  // no response: an undamped resonance, or a motion that nothing resists at
                         // 0 Hz
    for (auto& values : out)
      std::fill(values.begin(), values.end(), Complex(nan, nan));
    return;
  }
  const double step = variation_step(a), eps = step == 0.0 ? 1.0 : step;  // held: its force alone
  std::vector<double> value, behind, here;
  for (int part = 0; part < 2; ++part) {
    // the motion at phase 0 and a quarter period earlier: Re and Im of the amplitude
    const Complex turn = part == 0 ? Complex(1, 0) : Complex(0, -1);
    const VecX q = (turn * a).real(), v = (turn * Complex(0, w) * a).real(),
               acc = (turn * (-w * w) * a).real();
    const auto evaluate = [&](double h, std::vector<double>& values) {
      const VecX q1 = s.q + h * q, v1 = s.v + h * v, a1 = s.a + h * acc;
      problem_.force = h * (turn * force).real();
      snapshot_.set(s.t, q1, v1, a1);
      values.clear();
      for (const Measurement& m : what) {
        values.resize(values.size() + m.width());
        m.evaluate(snapshot_, values.data() + values.size() - m.width());
      }
    };
    evaluate(eps, value);
    evaluate(-eps, behind);
    here.clear();
    std::size_t k = 0;
    for (std::vector<Complex>& values : out)
      for (Complex& to : values) {
        double x = (value[k] - behind[k]) / (2.0 * eps);
        if (!std::isfinite(x)) {  // at the end of a table: from the side within
          if (here.empty()) evaluate(0.0, here);
          x = std::isfinite(value[k]) ? (value[k] - here[k]) / eps : (here[k] - behind[k]) / eps;
        }
        to += part == 0 ? Complex(x, 0) : Complex(0, x);
        ++k;
      }
  }
}

}  // namespace whirl::analysis
