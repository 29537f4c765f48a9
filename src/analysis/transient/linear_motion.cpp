#include <analysis/transient/linear_motion.hpp>

#include <core/contract.hpp>
#include <core/error.hpp>
#include <la/multiply.hpp>
#include <la/step_products.hpp>

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

bool turns(int component) { return component >= 3; }

/// From a line's first node to its farthest, m.
VecX lengths_of_lines(const system::System& system) {
  VecX length = VecX::Zero(system.lines());
  std::vector<Index> first(at(system.lines()), -1);
  for (Index i = 0; i < system.nodes(); ++i) {
    if (system.node(i).scalar) continue;
    const Index line = system.node(i).line;
    if (first[at(line)] < 0) first[at(line)] = i;
    const Vec3 from = system.node(first[at(line)]).position;
    length[line] = std::max(length[line], (system.node(i).position - from).norm());
  }
  return length;
}

/// The same of masses. An unbalance is an eccentricity of what stands at its node, and ties the
/// displacements there to the angles: lateral motion to twist, axial motion to tilt. A motion is acted
/// back upon through both, by the square of the coupling, which is to be compared with the inertia of
/// the whole line, however little of it stands at the node. Of point masses the stiffness tells what a
/// tilt is against a displacement: the length of the line.
double difference_of_masses(const system::System& system, const la::BlockMatrix<6>& x,
                            const la::BlockMatrix<6>& y, const VecX& diagonal) {
  VecX mass = VecX::Zero(system.lines()), rotary = mass;
  for (Index i = 0; i < system.nodes(); ++i) {
    const Index line = system.node(i).line;
    mass[line] += diagonal.segment<3>(6 * i).maxCoeff();
    rotary[line] += diagonal.segment<2>(6 * i + system::gamma2).maxCoeff();
  }
  const VecX length = lengths_of_lines(system);
  constexpr double arm = 0.1;  // of the length
  rotary = rotary.cwiseMax(mass.cwiseProduct((arm * length).cwiseAbs2()));
  const la::BlockPattern& p = x.pattern();
  la::BlockMatrix<6> rest = y;  // y and what is no unbalance
  double worst = 0.0;
  for (Index i = 0; i < p.size(); ++i) {
    const Index line = system.node(i).line;
    const Index s = p.diagonal(i);
    const Matrix<6> d = x.block(s) - y.block(s);
    double coupling = 0.0;
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b)
        if (a != system::spin_phi && b != system::spin_phi && turns(a) != turns(b))
          coupling = std::max(coupling, std::abs(d(a, b)));
    const double size = mass[line] * rotary[line];
    if (coupling > 0.0 && size > 0.0) worst = std::max(worst, coupling * coupling / size);
    const double m = diagonal.segment<3>(6 * i).maxCoeff();
    const double tilt = m > 0.0 ? coupling * coupling / m : 0.0;  // m e^2
    if (tilt > 0.0) worst = std::max(worst, tilt / rotary[line]);
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) {
        if (turns(a) != turns(b)) continue;
        constexpr double seen = 4.0;  // at the angles looked at
        const double of_unbalance = turns(a) ? seen * tilt : 0.0;
        rest.block(s)(a, b) += std::max(0.0, std::abs(d(a, b)) - of_unbalance);
      }
  }
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[at(i)]; s < p.row_start()[at(i) + 1]; ++s)
      if (s != p.diagonal(i)) rest.block(s) = x.block(s);
  return std::max(worst, difference(rest, y, diagonal));
}

VecX diagonal_of(const la::BlockMatrix<6>& x) {
  const la::BlockPattern& p = x.pattern();
  VecX d = VecX::Zero(6 * p.size());
  for (Index i = 0; i < p.size(); ++i)
    d.segment<6>(6 * i) = x.block(p.slot(i, i)).diagonal().cwiseAbs();
  return d;
}

/// An unbalance moves the mass of a line by a share of 1e-6 or so; a key way or a second moment of
/// area shows more.
constexpr double turning_share = 1e-3;

/// sum over h of cosine(., h - 1) cos(h angle) + sine(., h - 1) sin(h angle); add(e, x): x more in
/// row e.
template <class Add>
void sum_series(const MatX& cosine, const MatX& sine, double angle, Add&& add) {
  const double c = std::cos(angle), s = std::sin(angle);
  double ch = c, sh = s;
  for (Index h = 0; h < cosine.cols(); ++h) {
    for (Index e = 0; e < cosine.rows(); ++e)
      add(e, ch * cosine(e, h) + sh * sine(e, h));
    const double next = ch * c - sh * s;
    sh = sh * c + ch * s;
    ch = next;
  }
}

/// r += that, at some entries.
void add_series(const std::vector<Index>& entry, const MatX& cosine, const MatX& sine, double angle,
                time::Ref r) {
  sum_series(cosine, sine, angle, [&](Index e, double x) { r[entry[at(e)]] += x; });
}

/// Something stands in the matrices at another angle of the rotor otherwise.
bool sees_the_angle(const system::System& system, const SteadySystem& running) {
  std::vector<double> rate(at(system.nodes()), 0.0);
  for (Index i = 0; i < system.nodes(); ++i)
    if (running.spinning()[at(i)]) rate[at(i)] = running.ratio(system.node(i).line);
  system::Context at_hand;
  at_hand.time = running.running().time;
  return std::any_of(system.terms().begin(), system.terms().end(),
                     [&](const auto& term) { return term->sees_turning(at_hand, rate); });
}

}  // namespace

LinearMotion::LinearMotion(const system::System& system, const SteadyRotation& running,
                           double Omega, const system::State& start, EquilibriumOptions options)
    : SystemProblem(system, {la::SolverKind::automatic, false}),
      still_(VecX::Zero(system.size())),
      q_(system.size()),
      v_(system.size()),
      steady_(system.make_workspace()) {
  SteadyRotation in_time = running;
  in_time.hysteretic = false;  // motions at large take their stand-in too
  Linearizer linear(system, in_time, options);
  linear.start_from(start);
  const la::MCK& m = linear.at(Omega);
  const system::State& e = linear.equilibrium().state;
  if (e.frames.moved() || start.frames.moved())
    throw run_error("E39", "the rotor tilts too far for small motions",
                    "leave linear out of the step");
  if (sees_the_angle(system, linear.running())) {
    la::MCK turned = system.make_matrices();
    const VecX K = diagonal_of(m.K), M = diagonal_of(m.M);
    double worst = 0.0;
    for (double theta : {0.4, 1.9}) {
      linear.running().tangent_at(e.frames, Omega, e.q, theta, turned);
      worst = std::max(
          {worst, difference(turned.K, m.K, K), difference_of_masses(system, turned.M, m.M, M)});
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
  works_.assign(system.active().begin(), system.active().end());
  for (Index i = 0; i < system.nodes(); ++i)
    if (system.node(i).signal || system.node(i).rate)
      std::fill_n(works_.begin() + 6 * i, 6, static_cast<unsigned char>(0));
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

Index LinearMotion::leading_line() const {
  Index leading = -1;
  for (Index i = 0; i < system().nodes(); ++i) {
    if (!turns_[at(i)]) continue;
    const Index line = system().node(i).line;
    if (leading < 0) leading = line;
    if (std::abs(rate_[at(line)]) != std::abs(rate_[at(leading)])) return -1;
  }
  return leading >= 0 && rate_[at(leading)] != 0.0 ? leading : -1;
}

bool LinearMotion::angles_alone() const {
  if (system().base_moves()) return false;
  return std::none_of(changing_.begin(), changing_.end(), [this](std::size_t k) {
    return system().terms()[k]->depends(steady_.context).time;
  });
}

bool LinearMotion::changing_at(Index line, double angle, VecX& out) {
  // whole turns taken out of no line: the series is the same wherever a run is resumed
  system::Frames apart = frames;
  std::fill(apart.turns.begin(), apart.turns.end(), 0.0);
  const double t = (angle - angle_[line]) / rate_[at(line)];
  q_ = q0_;
  for (Index i = 0; i < system().nodes(); ++i)
    if (turns_[at(i)]) {
      const Index l = system().node(i).line;
      q_[6 * i + system::spin_phi] += angle_[l] + rate_[at(l)] * t;
    }
  return system().residual(steady_, apart, t, q_, v0_, still_, out, &changing_);
}

void LinearMotion::transform(const MatX& samples) {
  const Index count = samples.cols(), harmonics = count / 4;
  const double size = samples.cwiseAbs().maxCoeff();
  series_.entry.clear();
  for (Index i = 0; i < samples.rows(); ++i)
    if (!samples.row(i).isZero(0.0)) series_.entry.push_back(i);
  const Index entries = static_cast<Index>(series_.entry.size());
  series_.mean = constant_ + samples.rowwise().mean();
  series_.cosine = series_.sine = MatX::Zero(entries, harmonics);
  Index last = 0;
  for (Index h = 1; h <= harmonics; ++h) {
    VecX cosines(count), sines(count);
    for (Index k = 0; k < count; ++k) {
      // of the product taken round the circle: exact wherever it comes again
      const double angle =
          two_pi * static_cast<double>((h * k) % count) / static_cast<double>(count);
      cosines[k] = std::cos(angle);
      sines[k] = std::sin(angle);
    }
    for (Index e = 0; e < entries; ++e) {
      const auto values = samples.row(series_.entry[at(e)]);
      series_.cosine(e, h - 1) = 2.0 / static_cast<double>(count) * values.dot(cosines);
      series_.sine(e, h - 1) = 2.0 / static_cast<double>(count) * values.dot(sines);
    }
    const double largest = std::max(series_.cosine.col(h - 1).cwiseAbs().maxCoeff(),
                                    series_.sine.col(h - 1).cwiseAbs().maxCoeff());
    if (largest > 1e-15 * size) last = h;
  }
  series_.cosine.conservativeResize(entries, last);
  series_.sine.conservativeResize(entries, last);
}

VecX LinearMotion::series_at(double angle) const {
  VecX r = series_.mean;
  add_series(series_.entry, series_.cosine, series_.sine, angle, r);
  return r;
}

void LinearMotion::find_series() {
  series_.sought = true;
  series_.holds = false;
  series_.mean = constant_;
  if (changing_.empty()) {
    series_.holds = true;
    return;
  }
  const Index line = leading_line();
  if (line < 0 || !angles_alone()) return;
  constexpr Index count = 32;
  MatX samples(system().size(), count);
  VecX r(system().size());
  for (Index k = 0; k < count; ++k) {
    if (!changing_at(line, two_pi * static_cast<double>(k) / static_cast<double>(count), r)) return;
    samples.col(k) = r;
  }
  const double size = samples.cwiseAbs().maxCoeff();
  if (size > 0.0) transform(samples);
  // between those angles, backwards, and some turns on
  for (const double angle : {0.137, 1.31, 2.77, -0.9, -9.1, 21.3, 64.2}) {
    if (!changing_at(line, angle, r)) return;
    if (size == 0.0 && !r.isZero(0.0)) return;
    if ((r + constant_ - series_at(angle)).cwiseAbs().maxCoeff() > 1e-11 * size) return;
  }
  series_.line = line;
  series_.holds = true;
}

void LinearMotion::steady(double t, VecX& q) const {
  q = q0_;
  for (Index i = 0; i < system().nodes(); ++i)
    if (turns_[at(i)]) q[6 * i + system::spin_phi] += turned(system().node(i).line, t);
}

Vector<6> LinearMotion::beside(double t, const VecX& q, Index node) const {
  Vector<6> x = q.segment<6>(6 * node) - q0_.segment<6>(6 * node);
  if (turns_[at(node)]) x[system::spin_phi] -= turned(system().node(node).line, t);
  return x;
}

bool LinearMotion::steady_residual(double t, time::Ref r) {
  if (!series_.sought) find_series();
  if (series_.holds) {
    r = series_.mean;
    if (!series_.entry.empty())
      add_series(series_.entry, series_.cosine, series_.sine, turned(series_.line, t), r);
    return true;
  }
  steady(t, q_);
  if (!system().residual(steady_, frames, t, q_, v0_, still_, r, &changing_)) return false;
  r += constant_;
  return true;
}

std::optional<std::span<const Index>> LinearMotion::changing_entries() const {
  if (!series_.holds) return std::nullopt;
  return std::span<const Index>(series_.entry);
}

void LinearMotion::changing(double t, time::Ref values) const {
  WHIRL_EXPECTS(series_.holds && values.size() == static_cast<Index>(series_.entry.size()));
  values.setZero();
  if (series_.entry.empty()) return;
  sum_series(series_.cosine, series_.sine, turned(series_.line, t),
             [&](Index e, double x) { values[e] += x; });
}

bool LinearMotion::held_move_freely(const time::FreeMotion& m) const {
  constexpr double rounding = 1e-9;
  for (const system::Hold& h : system().holds()) {
    if (!h.law) continue;
    const Index k = h.unknown;
    const double turns =
        k % 6 == system::spin_phi ? two_pi * frames.turns[at(system().node(k / 6).line)] : 0.0;
    for (std::size_t i = 0; i < m.time.size(); ++i) {
      const LawValue x = h.law->at(m.time[i]);
      const double place = m.q[k] + m.span[i] * m.v[k];
      if (x.ddf != 0.0 || std::abs(x.df - m.v[k]) > rounding * std::abs(x.df) ||
          std::abs(x.f - turns - place) > rounding * std::max(1.0, std::abs(x.f)))
        return false;
    }
  }
  return true;
}

void LinearMotion::take_bound_forces() {
  if (at_first_.size() == q_.size() && q_ == bound_q_ && v_ == bound_v_) return;
  bound_q_ = q_;
  bound_v_ = v_;
  at_first_.setZero(q_.size());
  la::add_forces(matrices(), q_, v_, at_first_);
}

bool LinearMotion::bound_along(const time::FreeMotion& m) {
  if (!system().followers().empty() || !held_move_freely(m)) return false;
  if (!series_.sought) find_series();
  return series_.holds;
}

void LinearMotion::multiply(double t, time::CRef q, time::CRef v, time::Bound& bound,
                            time::StepProducts& step) {
  WHIRL_EXPECTS(series_.holds && q.size() == q0_.size() && v.size() == q0_.size());
  steady(t, q_);
  q_ = q - q_;
  v_ = v - v0_;
  la::multiply(matrices(), {q_, v_, step.stiff_of, step.inertia_of, step.filter_of, step.shift,
                            bound.force, bound.rate, step.stiff, step.inertia, step.filter});
  bound.force += series_.mean;
}

bool LinearMotion::residuals_along(const time::FreeMotion& m, Eigen::Ref<MatX> r) {
  if (!system().followers().empty() || !held_move_freely(m)) return false;
  // the steady motion goes on freely too: what lies between the two grows at their difference of
  // rates
  for (std::size_t i = 0; i < m.time.size(); ++i)
    if (!steady_residual(m.time[i], r.col(static_cast<Index>(i)))) return false;
  steady(m.t, q_);
  q_ = m.q - q_;
  v_ = m.v - v0_;
  take_bound_forces();
  per_second_.setZero(q_.size());
  la::add_multiply(matrices().K, 1.0, v_, per_second_);
  for (std::size_t i = 0; i < m.time.size(); ++i)
    r.col(static_cast<Index>(i)) += at_first_ + m.span[i] * per_second_;
  return r.allFinite();
}

bool LinearMotion::residual(double t, time::CRef q, time::CRef v, time::CRef a, time::Ref r) {
  if (!steady_residual(t, r)) return false;
  steady(t, q_);
  if (!joined_.empty()) {
    steady_q_ = q_;
    steady_v_ = v0_;
  }
  q_ = q - q_;
  v_ = v - v0_;
  if (!joined_.empty() && !add_joint_loads(t, a, r)) return false;
  take_bound_forces();
  r += at_first_;
  if (!a.isZero(0.0))  // before the first correction of a step
    la::add_multiply(matrices().M, 1.0, a, r);
  return true;
}

}  // namespace whirl::analysis
