#include <analysis/steady_rotation.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <core/interrupt.hpp>
#include <la/dense.hpp>

#include <algorithm>
#include <cmath>
#include <queue>

namespace whirl::analysis {

namespace {

void add_scaled(la::BlockMatrix<6>& y, double s, const la::BlockMatrix<6>& x) {
  Eigen::Map<VecX>(y.data(), static_cast<Index>(y.value_count())) +=
      s * Eigen::Map<const VecX>(x.data(), static_cast<Index>(x.value_count()));
}
void set_scaled(la::BlockMatrix<6>& y, double s, const la::BlockMatrix<6>& x) {
  Eigen::Map<VecX>(y.data(), static_cast<Index>(y.value_count())) =
      s * Eigen::Map<const VecX>(x.data(), static_cast<Index>(x.value_count()));
}
/// Shortest way from every node to a turning shaft whose spin has this sign, m, along what stands
/// and moves; infinity: none.
std::vector<double> distance_to_spin(const system::System& s, std::span<const double> ratio,
                                     double sign) {
  const auto ratio_of = [&](Index node) {
    const std::size_t line = at(s.node(node).line);
    return line < ratio.size() ? ratio[line] : 0.0;
  };
  const auto moves = [&](Index node) {
    const auto flags = s.active().subspan(at(6 * node), 6);
    return std::find(flags.begin(), flags.end(), 1) != flags.end();
  };
  std::vector<double> distance(at(s.nodes()), infinity);
  using Place = std::pair<double, Index>;
  std::priority_queue<Place, std::vector<Place>, std::greater<>> queue;
  for (Index i = 0; i < s.nodes(); ++i) {
    if (s.node(i).scalar || !(ratio_of(i) * sign > 0)) continue;
    distance[at(i)] = 0.0;
    queue.emplace(0.0, i);
  }
  const auto& start = s.pattern().row_start();
  const auto& cols = s.pattern().cols();
  while (!queue.empty()) {
    const auto [d, i] = queue.top();
    queue.pop();
    if (d > distance[at(i)]) continue;
    for (Index b = start[at(i)]; b < start[at(i) + 1]; ++b) {
      const Index j = cols[at(b)];
      if (ratio_of(j) != 0.0 || !moves(j)) continue;  // other shafts and the ground lead nowhere
      // generalised coordinates have no place
      const bool placed = !s.node(i).scalar && !s.node(j).scalar;
      const double next = d + (placed ? (s.node(i).position - s.node(j).position).norm() : 0.0);
      if (next >= distance[at(j)]) continue;
      distance[at(j)] = next;
      queue.emplace(next, j);
    }
  }
  return distance;
}

/// The node of a line that a node between lines (the end of an arm, a cross) stands on.
Index carrier(const system::System& system, Index node) {
  const system::FollowerDef* f = system.followers().find(node);
  return f && f->between ? carrier(system, f->parent) : node;
}

/// Lines on a joint that ties their spins have one speed: what differs is rounding, or small motions of
/// the state they were read from. Lines on a ball may turn at any, on a hinge along the axis too.
void join_speeds(const system::System& system, std::vector<double>& ratio) {
  for (std::size_t k = 0; k < system.followers().count(); ++k) {
    const system::FollowerDef& f = system.followers()[k];
    if (f.pinned) continue;
    const double allowed = f.angle >= 0 ? 1e-6 : 1e-3;
    if (f.between) continue;
    const double of_parent = ratio[at(system.node(carrier(system, f.parent)).line)];
    double& of_node = ratio[at(system.node(f.node).line)];
    if (std::abs(of_node - of_parent) <= allowed * std::abs(of_parent)) of_node = of_parent;
  }
}

void add_scaled(la::MCK& y, double s, const la::MCK& x) {
  add_scaled(y.M, s, x.M);
  add_scaled(y.C, s, x.C);
  add_scaled(y.K, s, x.K);
}

}  // namespace

std::vector<double> spin_senses(const system::System& system, std::span<const double> ratio) {
  const std::vector<double> with = distance_to_spin(system, ratio, 1.0);
  const std::vector<double> against = distance_to_spin(system, ratio, -1.0);
  const auto first = std::find_if(ratio.begin(), ratio.end(), [](double r) { return r != 0.0; });
  const double of_first = first != ratio.end() && *first < 0 ? -1.0 : 1.0;
  std::vector<double> out(at(system.nodes()), of_first);
  for (std::size_t i = 0; i < out.size(); ++i) {
    // ways of one length differ by rounding
    if (with[i] < against[i] * (1.0 - 1e-9)) out[i] = 1.0;
    if (against[i] < with[i] * (1.0 - 1e-9)) out[i] = -1.0;
  }
  return out;
}

SteadySystem::SteadySystem(const system::System& system, SteadyRotation running)
    : system_(system),
      running_(std::move(running)),
      ratio_(running_.ratio),
      workspace_(system.make_workspace()),
      q_(system.size()),
      v_(system.size()),
      a_(VecX::Zero(system.size())),
      r_(system.size()) {
  WHIRL_EXPECTS(std::all_of(running_.table_frequencies.begin(), running_.table_frequencies.end(),
                            [](double w) { return std::isfinite(w); }));
  if (ratio_.empty()) ratio_.assign(at(system.lines()), 1.0);
  ratio_.resize(at(system.lines()), 0.0);
  join_speeds(system, ratio_);
  find_spinning();
  for (Index i = 0; i < system.nodes(); ++i)
    if (spinning_[at(i)]) orders_.push_back(std::abs(ratio_[at(system.node(i).line)]));
  std::sort(orders_.begin(), orders_.end());
  orders_.erase(std::unique(orders_.begin(), orders_.end()), orders_.end());
  sense_ = spin_senses(system, ratio_);
  find_unsteady_joint();
  workspace_.context.averaged = workspace_.context.whole_turn = running_.mean;
  workspace_.context.hysteretic = running_.hysteretic;
  for (const auto& term : system.terms())
    hysteretic_ = hysteretic_ || term->depends(workspace_.context).rate;
  make_samples();
  sort_terms();
  for (std::size_t k = 0; k < system.terms().size(); ++k) {
    const std::size_t before = series_.size();
    system.terms()[k]->list_series(series_);
    (series_.size() > before ? in_series_ : without_series_).push_back(k);
  }
}

namespace {

/// Lines that no term acts on: rigid ones without mass between joints.
std::vector<unsigned char> bare_lines(const system::System& s) {
  std::vector<unsigned char> bare(at(s.lines()), 1);
  std::vector<Index> nodes;
  for (const auto& term : s.terms()) {
    nodes.clear();
    term->list_nodes(nodes);
    for (const Index i : nodes)
      bare[at(s.node(i).line)] = 0;
  }
  return bare;
}

}  // namespace

void SteadySystem::find_spinning() {
  std::vector<unsigned char> turnable(at(system_.nodes()), 0);
  for (const auto& term : system_.terms())
    if (term->width() == 7) {
      std::vector<Index> nodes;
      term->list_nodes(nodes);
      for (Index i : nodes)
        turnable[at(i)] = 1;
    }
  if (system_.followers().count() > 0) {
    const std::vector<unsigned char> bare = bare_lines(system_);
    for (Index i = 0; i < system_.nodes(); ++i)
      if (bare[at(system_.node(i).line)]) turnable[at(i)] = 1;
  }
  spinning_.assign(at(system_.nodes()), 0);
  for (Index i = 0; i < system_.nodes(); ++i)
    spinning_[at(i)] =
        turnable[at(i)] && !system_.node(i).scalar && ratio_[at(system_.node(i).line)] != 0.0;
  // A line whose angle is held somewhere stands still. (The line of the ground points has nothing
  // that could turn.)
  std::vector<unsigned char> moves(at(system_.lines()), 0);
  for (Index k = 0; k < system_.size(); ++k)
    if (system_.active()[at(k)]) moves[at(system_.node(k / 6).line)] = 1;
  for (const auto& h : system_.holds()) {
    const Index i = h.unknown / 6, line = system_.node(i).line;
    if (h.unknown % 6 != system::spin_phi || !spinning_[at(i)] || h.law) continue;
    if (moves[at(line)]) held_.emplace_back(line, i);
    for (Index j = 0; j < system_.nodes(); ++j)
      if (system_.node(j).line == line) spinning_[at(j)] = 0;
  }
}

void SteadySystem::find_unsteady_joint() {
  const system::Followers& followers = system_.followers();
  const auto along = [](const Vec3& v) { return v.cross(Vec3::UnitX()).norm() <= 1e-9 * v.norm(); };
  const auto rate = [&](Index i) {
    return spinning_[at(i)] ? ratio_[at(system_.node(i).line)] : 0.0;
  };
  for (std::size_t k = 0; k < followers.count() && unsteady_joint_.empty(); ++k) {
    const system::FollowerDef& f = followers[k];
    const double of_parent = rate(carrier(system_, f.parent)),
                 of_node = f.between ? of_parent : rate(f.node);
    if (f.pinned || (of_node == 0.0 && of_parent == 0.0)) continue;
    // a slide or a turn along the axis of rotation, as of a spline or a flexible coupling, is at rest
    if ((f.angle >= 0 || f.slide >= 0) && !along(f.axis))
      unsteady_joint_ =
          f.joint +
          " bends or slides across the axis of lines that turn: its own axes turn too, "
          "and small motions about a steady rotation have no constant matrices";
    else if (of_node != of_parent)
      unsteady_joint_ =
          f.joint + " holds lines that do not turn as one shaft: there is no steady rotation";
    else if (!along(system_.node(f.node).position - system_.node(f.parent).position))
      unsteady_joint_ =
          f.joint + " holds lines whose axes are not one: there is no steady rotation";
  }
}

void SteadySystem::take_polynomials(const SteadySystem& other) {
  WHIRL_EXPECTS(&other.system_ == &system_);
  polynomial_ = other.polynomial_;
  seen_ = other.seen_;
  seen_speed_ = other.seen_speed_;
  seen_q_ = other.seen_q_;
}

void SteadySystem::set_load(double factor) {
  WHIRL_EXPECTS(std::isfinite(factor));
  if (workspace_.context.load != factor) {
    workspace_.context.load = factor;
    polynomial_.reset();
    seen_ = false;
  }
}

void SteadySystem::set_whirl(Complex lambda, bool rotates, double side) {
  system::Context& c = workspace_.context;
  c.whirl = std::abs(lambda.imag());
  c.growth = lambda.real();
  c.whirl_rotates = rotates;
  c.whirl_side = std::isnan(side) ? c.whirl : side;
}

void SteadySystem::set_frequency(double w) { workspace_.context.frequency = std::abs(w); }

Index SteadySystem::most_harmonics() const {
  system::Context mean = workspace_.context;
  mean.time = running_.time;
  mean.averaged = true;
  int most = 2;
  for (const auto& term : system_.terms())
    most = std::max(most, term->depends(mean).harmonics);
  return most;
}

void SteadySystem::make_samples() {
  if (orders_.size() > 1) return make_samples_of_orders();
  // n samples a revolution: the mean is exact up to the harmonic n - 1 and the first one up to n - 2
  const Index harmonics = most_harmonics();
  if (harmonics <= 2) {
    theta_ = {0.0, 0.5 * pi, pi, 1.5 * pi};
    weights_.resize(3, 4);
    weights_ << 0.25, 0.25, 0.25, 0.25, 0.5, 0, -0.5, 0, 0, 0.5, 0, -0.5;
  } else {
    // beside the quarters, where what breathes switches
    const Index n = harmonics + 2;
    weights_.resize(3, n);
    for (Index k = 0; k < n; ++k) {
      const double x = two_pi * (static_cast<double>(k) + 0.5) / static_cast<double>(n);
      theta_.push_back(x);
      weights_.col(k) << 1.0, 2.0 * std::cos(x), 2.0 * std::sin(x);
    }
    weights_ /= static_cast<double>(n);
  }
  if (orders_.size() == 1)
    for (double& x : theta_)
      x /= orders_[0];
}

void SteadySystem::make_samples_of_orders() {
  const Index k = static_cast<Index>(orders_.size());
  std::vector<double> harmonics;
  for (Index h = 1; h <= std::min<Index>(most_harmonics(), 8); ++h)
    for (double o : orders_)
      harmonics.push_back(static_cast<double>(h) * o);
  std::sort(harmonics.begin(), harmonics.end());
  harmonics.erase(std::unique(harmonics.begin(), harmonics.end(),
                              [](double a, double b) { return b - a < 1e-9 * b; }),
                  harmonics.end());
  double spacing = harmonics.front();
  for (std::size_t i = 1; i < harmonics.size(); ++i)
    spacing = std::min(spacing, harmonics[i] - harmonics[i - 1]);
  const Index unknowns = 1 + 2 * static_cast<Index>(harmonics.size()), samples = 3 * unknowns;
  MatX A(samples, unknowns);
  theta_.resize(at(samples));
  for (Index j = 0; j < samples; ++j) {
    // golden-section points over a few periods of the slowest beat
    const double g = 0.6180339887498949 * static_cast<double>(j + 1);
    theta_[at(j)] = (g - std::floor(g)) * 4.0 * two_pi / spacing;
    A(j, 0) = 1.0;
    for (Index h = 0; h < static_cast<Index>(harmonics.size()); ++h) {
      A(j, 1 + 2 * h) = std::cos(harmonics[at(h)] * theta_[at(j)]);
      A(j, 2 + 2 * h) = std::sin(harmonics[at(h)] * theta_[at(j)]);
    }
  }
  const MatX inverse = la::pseudo_inverse(A);
  weights_.resize(1 + 2 * k, samples);
  weights_.row(0) = inverse.row(0);
  for (Index o = 0; o < k; ++o) {
    Index h = 0;
    while (std::abs(harmonics[at(h)] - orders_[at(o)]) > 1e-9 * orders_[at(o)])
      ++h;
    weights_.middleRows(1 + 2 * o, 2) = inverse.middleRows(1 + 2 * h, 2);
  }
}

void SteadySystem::sort_terms() {
  // A term sees phi when an element of it sees the lines turn on together, as they stand at
  // running_.time, where means over the revolution are asked for.
  std::vector<double> rate(at(system_.nodes()), 0.0);
  for (Index i = 0; i < system_.nodes(); ++i)
    if (spinning_[at(i)]) rate[at(i)] = ratio_[at(system_.node(i).line)];
  system::Context mean = workspace_.context;
  mean.time = running_.time;
  mean.averaged = true;
  const auto& terms = system_.terms();
  for (std::size_t k = 0; k < terms.size(); ++k) {
    all_.push_back(k);
    const bool sees = terms[k]->sees_turning(mean, rate);
    // what acts on one node alone (the integral of a governor) holds no angle against anything; at
    // rest a spring against the twist holds one, which turning it would wind up
    std::vector<Index> touched;
    terms[k]->list_nodes(touched);
    if (!(sees && running_.mean) && touched.size() > terms[k]->count()) {
      blind_.push_back(k);
      if (!is_shaft_at_angle(*terms[k], mean)) without_shafts_.push_back(k);
    }
    // a twist is measured from the steady turn: it has no mean over angles that wind it up
    const bool winds = terms[k]->depends(mean).angle == system::twist_angle;
    if (sees && !winds)
      (terms[k]->quadratic_in_rates() ? turning_smooth_ : turning_).push_back(k);
    else
      (terms[k]->quadratic_in_rates() ? smooth_ : other_).push_back(k);
  }
  if (!running_.mean) {
    // nothing is averaged: what turns is evaluated like the rest
    other_.insert(other_.end(), turning_.begin(), turning_.end());
    smooth_.insert(smooth_.end(), turning_smooth_.begin(), turning_smooth_.end());
    turning_.clear();
    turning_smooth_.clear();
  }
  of_turning_smooth_ = system_.blocks_of(turning_smooth_);
  set_apart_asked_terms();
}

bool SteadySystem::is_shaft_at_angle(const system::Term& term, const system::Context& mean) const {
  const bool of_shaft =
      term.family() == system::Family::shaft || term.family() == system::Family::damping;
  if (!of_shaft || term.depends(mean).angle.form != system::SeenAngle::Form::each) return false;
  // an element of a shaft that stands touches no node of one that turns
  std::vector<Index> touched;
  term.list_nodes(touched);
  const std::size_t nodes = touched.size() / std::max<std::size_t>(term.count(), 1);
  for (std::size_t k = 0; k < touched.size(); ++k)
    if (spinning_[at(touched[k])] != spinning_[at(touched[k - k % nodes])]) return false;
  return true;
}

void SteadySystem::set_apart_asked_terms() {
  const auto place = [this](std::size_t k, Terms& asked, Terms& rated, Terms& steady) {
    const system::Dependence d = system_.terms()[k]->depends(workspace_.context);
    const bool by_frequency = running_.frequency_dependent() && d.frequency;
    (by_frequency ? asked : d.rate ? rated : steady).push_back(k);
  };
  for (const std::size_t k : other_)
    place(k, asked_, rated_, steady_);
  for (const std::size_t k : turning_)
    place(k, turning_asked_, turning_rated_, turning_steady_);
  of_turning_asked_ = system_.blocks_of(turning_asked_);
  of_turning_rated_ = system_.blocks_of(turning_rated_);
  of_turning_steady_ = system_.blocks_of(turning_steady_);
}

void SteadySystem::set_rates(double Omega, Eigen::Ref<VecX> v) const {
  WHIRL_EXPECTS(std::isfinite(Omega) && v.size() == system_.size());
  v.setZero();
  if (Omega != 0.0 && !unsteady_joint_.empty())
    throw run_error("E41", unsteady_joint_,
                    "a transient step follows them; lines that stand still have rotating = false");
  if (Omega != 0.0)
    for (const auto& [line, node] : held_)
      throw run_error("E78",
                      "shaft '" + system_.line_name(line) + "' cannot turn: its spin is held at " +
                          system_.node(node).name,
                      "release the rotation about the axis (rx) of that support, or give the shaft "
                      "speed_ratio = 0");
  for (Index i = 0; i < system_.nodes(); ++i)
    if (spinning_[at(i)]) v[6 * i + 3] = Omega * ratio_[at(system_.node(i).line)];
}

void SteadySystem::turn_line(Index line, double by, Eigen::Ref<VecX> q) const {
  for (Index i = 0; i < system_.nodes(); ++i)
    if (spinning_[at(i)] && system_.node(i).line == line) q[6 * i + system::spin_phi] += by;
}

void SteadySystem::impose(const system::Frames& f, Eigen::Ref<VecX> q) const {
  WHIRL_EXPECTS(q.size() == system_.size());
  std::vector<double> lead(at(system_.lines()), nan);
  for (const auto& h : system_.holds()) {
    if (!h.law) {
      q[h.unknown] = 0.0;
      continue;
    }
    const Index i = h.unknown / 6;
    double x = h.law->at(running_.time).f;
    if (h.unknown % 6 == system::spin_phi && spinning_[at(i)]) {
      double& first = lead[at(system_.node(i).line)];
      if (!running_.mean) x -= two_pi * f.turns[at(system_.node(i).line)];
      if (std::isnan(first)) {
        first = x;
        if (!running_.mean) turn_line(system_.node(i).line, x - q[h.unknown], q);
      }
      if (running_.mean) x -= first;
    } else if (h.unknown % 6 == system::spin_phi) {
      x -= two_pi * f.turns[at(system_.node(i).line)];
    }
    q[h.unknown] = x;
  }
}

bool SteadySystem::evaluate_residual(const system::Frames& f, double Omega, const VecX& q,
                                     double theta, VecX& r, const Terms& only) {
  WHIRL_EXPECTS(q.size() == system_.size() && std::isfinite(theta));
  throw_if_interrupted();
  set_rates(Omega, v_);
  if (theta == 0.0) return system_.residual(workspace_, f, running_.time, q, v_, a_, r, &only);
  q_ = q;
  for (Index i = 0; i < system_.nodes(); ++i)
    if (spinning_[at(i)]) q_[6 * i + 3] += theta * ratio_[at(system_.node(i).line)];
  return system_.residual(workspace_, f, running_.time, q_, v_, a_, r, &only);
}

bool SteadySystem::evaluate_tangent(const system::Frames& f, double Omega, const VecX& q,
                                    double theta, la::MCK& out, const Terms& only) {
  WHIRL_EXPECTS(q.size() == system_.size() && std::isfinite(theta));
  throw_if_interrupted();
  set_rates(Omega, v_);
  if (theta == 0.0) return system_.tangent(workspace_, f, running_.time, q, v_, a_, out, &only);
  q_ = q;
  for (Index i = 0; i < system_.nodes(); ++i)
    if (spinning_[at(i)]) q_[6 * i + 3] += theta * ratio_[at(system_.node(i).line)];
  return system_.tangent(workspace_, f, running_.time, q_, v_, a_, out, &only);
}

bool SteadySystem::evaluate_blocks(const system::Frames& f, double Omega, const VecX& q,
                                   double theta, const Terms& only,
                                   const system::System::Blocks& where) {
  throw_if_interrupted();
  set_rates(Omega, v_);
  q_ = q;
  for (Index i = 0; i < system_.nodes(); ++i)
    if (spinning_[at(i)]) q_[6 * i + 3] += theta * ratio_[at(system_.node(i).line)];
  if (sample_.M.value_count() == 0) sample_ = system_.make_matrices();
  return system_.tangent_blocks(workspace_, f, running_.time, q_, v_, a_, sample_, only, where);
}

bool SteadySystem::visit_revolution(
    const system::Frames& f, double Omega, const VecX& q,
    const std::function<void(double, const system::Workspace&)>& visit) {
  WHIRL_EXPECTS(visit != nullptr);
  const auto visit_at = [&](double theta, double weight) {
    set_rates(Omega, v_);
    q_ = q;
    for (Index i = 0; i < system_.nodes(); ++i)
      if (spinning_[at(i)]) q_[6 * i + 3] += theta * ratio_[at(system_.node(i).line)];
    if (!system_.evaluate_nodes(workspace_, f, running_.time, q_, v_, a_)) return false;
    visit(weight, workspace_);
    return true;
  };
  if (!phase_dependent()) return visit_at(0.0, 1.0);
  // Either way round: the mean of what is periodic is the same, and a spring against the angle, which
  // is measured from the steady turn, is not wound up by the samples.
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    const double weight = 0.5 * weights_(0, static_cast<Index>(k));
    if (!visit_at(theta_[k], weight) || !visit_at(-theta_[k], weight)) return false;
  }
  return true;
}

bool SteadySystem::tangent_at(const system::Frames& f, double Omega, const VecX& q, double theta,
                              la::MCK& out) {
  workspace_.context.averaged = workspace_.context.whole_turn = false;
  const bool inside = evaluate_tangent(f, Omega, q, theta, out, all_);
  workspace_.context.averaged = workspace_.context.whole_turn = running_.mean;
  return inside;
}

bool SteadySystem::tangent_without_series_at(const system::Frames& f, double Omega, const VecX& q,
                                             double theta, la::MCK& out) {
  workspace_.context.averaged = workspace_.context.whole_turn = false;
  const bool inside = evaluate_tangent(f, Omega, q, theta, out, without_series_);
  workspace_.context.averaged = workspace_.context.whole_turn = running_.mean;
  return inside;
}

bool SteadySystem::visit_series_at(const system::Frames& f, double Omega, const VecX& q,
                                   double theta,
                                   const std::function<void(const system::Workspace&)>& visit) {
  workspace_.context.averaged = workspace_.context.whole_turn = false;
  const bool inside = evaluate_residual(f, Omega, q, theta, r_, in_series_);
  if (inside) visit(workspace_);
  workspace_.context.averaged = workspace_.context.whole_turn = running_.mean;
  return inside;
}

bool SteadySystem::series_force_at(const system::Frames& f, double Omega, const VecX& q,
                                   double theta, std::span<const Vec2> kinks, VecX& r) {
  r.resize(q.size());
  workspace_.context.averaged = workspace_.context.whole_turn = false;
  workspace_.context.kinks = kinks;
  const bool inside = evaluate_residual(f, Omega, q, theta, r, in_series_);
  workspace_.context.kinks = {};
  workspace_.context.averaged = workspace_.context.whole_turn = running_.mean;
  return inside;
}

bool SteadySystem::residual_at(const system::Frames& f, double Omega, const VecX& q, double theta,
                               VecX& r) {
  r.resize(q.size());
  workspace_.context.averaged = workspace_.context.whole_turn = false;
  const bool inside = evaluate_residual(f, Omega, q, theta, r, all_);
  workspace_.context.averaged = workspace_.context.whole_turn = running_.mean;
  return inside;
}

bool SteadySystem::fits_polynomial(const system::Frames& f, double Omega, const VecX& q) const {
  return polynomial_ && std::abs(Omega) <= 2.0 * polynomial_->scale && q == polynomial_->q &&
         f.chart == polynomial_->charts;
}

namespace {

/// Adds what is left of samples of this size in the mean. What is rounding of theirs is nothing: a
/// line that turns freely would be held by it, or thrown off.
void add_mean(const Eigen::Ref<const VecX>& mean, const Eigen::Ref<const VecX>& size,
              Eigen::Ref<VecX> out) {
  constexpr double share = 32 * std::numeric_limits<double>::epsilon();
  out.array() += (mean.array().abs() > share * size.array()).select(mean.array(), 0.0);
}

}  // namespace

bool SteadySystem::add_mean_residual(const system::Frames& f, double Omega, const VecX& q,
                                     const Terms& only, VecX& r) {
  WHIRL_EXPECTS(weights_.cols() == static_cast<Index>(theta_.size()));
  if (only.empty()) return true;
  mean_r_.setZero(q.size());
  size_r_.setZero(q.size());
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    if (!evaluate_residual(f, Omega, q, theta_[k], r_, only)) return false;
    const double w = weights_(0, static_cast<Index>(k));
    mean_r_ += w * r_;
    size_r_ += std::abs(w) * r_.cwiseAbs();
  }
  add_mean(mean_r_, size_r_, r);
  return true;
}

bool SteadySystem::add_mean_tangent(const system::Frames& f, double Omega, const VecX& q,
                                    const Terms& only, const system::System::Blocks& where,
                                    la::MCK& out) {
  WHIRL_EXPECTS(weights_.cols() == static_cast<Index>(theta_.size()));
  if (only.empty()) return true;
  constexpr std::array parts{&la::MCK::M, &la::MCK::C, &la::MCK::K};
  constexpr Index block = 36;
  const Index values = 3 * block * static_cast<Index>(where.slots.size());
  mean_.setZero(values);
  size_.setZero(values);
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    if (!evaluate_blocks(f, Omega, q, theta_[k], only, where)) return false;
    const double w = weights_(0, static_cast<Index>(k));
    Index first = 0;
    for (const auto part : parts)
      for (const Index s : where.slots) {
        const Eigen::Map<const Vector<block>> sample((sample_.*part).block(s).data());
        mean_.segment<block>(first) += w * sample;
        size_.segment<block>(first) += std::abs(w) * sample.cwiseAbs();
        first += block;
      }
  }
  Index first = 0;
  for (const auto part : parts)
    for (const Index s : where.slots) {
      add_mean(mean_.segment<block>(first), size_.segment<block>(first),
               Eigen::Map<Vector<block>>((out.*part).block(s).data()));
      first += block;
    }
  return true;
}

bool SteadySystem::add_forcing(const system::Frames& f, double Omega, const VecX& q,
                               const Terms& only, std::vector<VecXc>& out) {
  WHIRL_EXPECTS(weights_.rows() == 1 + 2 * static_cast<Index>(orders_.size()));
  if (only.empty()) return true;
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    if (!evaluate_residual(f, Omega, q, theta_[k], r_, only)) return false;
    // A cos + B sin = Re((A - iB) e^(i x))
    for (std::size_t o = 0; o < orders_.size(); ++o) {
      const Index c = 1 + 2 * static_cast<Index>(o), j = static_cast<Index>(k);
      out[o] += r_ * Complex(weights_(c, j), -weights_(c + 1, j));
    }
  }
  return true;
}

bool SteadySystem::smooth_residual(const system::Frames& f, double Omega, const VecX& q, VecX& r) {
  return evaluate_residual(f, Omega, q, 0.0, r, smooth_) &&
         add_mean_residual(f, Omega, q, turning_smooth_, r);
}

bool SteadySystem::smooth_tangent(const system::Frames& f, double Omega, const VecX& q,
                                  la::MCK& out) {
  return evaluate_tangent(f, Omega, q, 0.0, out, smooth_) &&
         add_mean_tangent(f, Omega, q, turning_smooth_, of_turning_smooth_, out);
}

la::MCK& SteadySystem::part() {
  if (part_.M.value_count() == 0) part_ = system_.make_matrices();
  return part_;
}

bool SteadySystem::make_polynomial(const system::Frames& f, double Omega, const VecX& q) {
  // Interpolation at -s, 0, s with s near the top speed: no digits are lost below it.
  const double s = std::max({std::abs(Omega), running_.top_speed, 1.0});
  const auto made = std::make_shared<Polynomials>();
  Polynomials& p = *made;
  p.p0 = system_.make_matrices();
  p.p1 = system_.make_matrices();
  p.k2 = la::BlockMatrix<6>(system_.pattern());
  for (VecX* r : {&p.r0, &p.r1, &p.r2})
    r->resize(q.size());
  la::MCK& behind = part();
  if (!smooth_tangent(f, s, q, p.p1) || !smooth_residual(f, s, q, p.r1)) return false;
  if (!smooth_tangent(f, -s, q, behind) || !smooth_residual(f, -s, q, p.r2)) return false;
  if (!smooth_tangent(f, 0.0, q, p.p0) || !smooth_residual(f, 0.0, q, p.r0)) return false;
  for (auto* x : {&p.f0, &p.f1, &p.f2})
    x->assign(orders_.size(), VecXc::Zero(q.size()));
  if (!add_forcing(f, s, q, turning_smooth_, p.f1) ||
      !add_forcing(f, -s, q, turning_smooth_, p.f2) ||
      !add_forcing(f, 0.0, q, turning_smooth_, p.f0))
    return false;
  for (std::size_t o = 0; o < orders_.size(); ++o) {
    const VecXc plus = p.f1[o], minus = p.f2[o];
    p.f1[o] = (0.5 / s) * (plus - minus);
    p.f2[o] = (0.5 / (s * s)) * (plus + minus - 2.0 * p.f0[o]);
  }
  set_scaled(p.k2, 0.5 / (s * s), p.p1.K);
  add_scaled(p.k2, 0.5 / (s * s), behind.K);
  add_scaled(p.k2, -1.0 / (s * s), p.p0.K);
  for (auto [slope, m] : {std::pair{&p.p1.C, &behind.C}, std::pair{&p.p1.K, &behind.K}}) {
    set_scaled(*slope, 0.5 / s, *slope);
    add_scaled(*slope, -0.5 / s, *m);
  }
  const VecX plus = p.r1, minus = p.r2;
  p.r1 = (0.5 / s) * (plus - minus);
  p.r2 = (0.5 / (s * s)) * (plus + minus - 2.0 * p.r0);
  p.scale = s;
  p.q = q;
  p.charts = f.chart;
  polynomial_ = made;
  return true;
}

void SteadySystem::relax(const system::Frames& f, double Omega, VecX& q) {
  if (!system_.relaxes()) return;
  VecX v = VecX::Zero(q.size());
  set_rates(Omega, v);
  const VecX still = VecX::Zero(q.size());
  system_.relax(workspace_, f, running_.time, q, v, still);
}

bool SteadySystem::residual(const system::Frames& f, double Omega, const VecX& q, VecX& r) {
  r.resize(q.size());
  if (fits_polynomial(f, Omega, q)) {
    const Polynomials& p = *polynomial_;
    r = p.r0 + Omega * p.r1 + (Omega * Omega) * p.r2;
  } else {
    if (!smooth_residual(f, Omega, q, r)) return false;
  }
  if (!other_.empty()) {
    if (!evaluate_residual(f, Omega, q, 0.0, r_, other_)) return false;
    r += r_;
  }
  return add_mean_residual(f, Omega, q, turning_, r);
}

bool SteadySystem::tangent(const system::Frames& f, double Omega, const VecX& q, la::MCK& out) {
  const bool by_rate = !rated_.empty() || !turning_rated_.empty();
  if (asked_.empty() && turning_asked_.empty() && !by_rate) return fixed_tangent(f, Omega, q, out);
  const system::Context& c = workspace_.context;
  if (!have_fixed_ || fixed_speed_ != Omega || fixed_load_ != c.load || fixed_q_ != q ||
      fixed_charts_ != f.chart) {
    if (fixed_.M.value_count() == 0) fixed_ = system_.make_matrices();
    have_fixed_ = fixed_tangent(f, Omega, q, fixed_);
    if (!have_fixed_) return false;
    fixed_speed_ = Omega;
    fixed_load_ = c.load;
    fixed_q_ = q;
    fixed_charts_ = f.chart;
  }
  if (!evaluate_tangent(f, Omega, q, 0.0, out, asked_)) return false;
  add_scaled(out, 1.0, fixed_);
  if (!add_mean_tangent(f, Omega, q, turning_asked_, of_turning_asked_, out)) return false;
  return !by_rate || add_rated(f, Omega, q, out);
}

bool SteadySystem::rated_tangent(const system::Frames& f, double Omega, const VecX& q,
                                 la::MCK& out) {
  return evaluate_tangent(f, Omega, q, 0.0, out, rated_) &&
         add_mean_tangent(f, Omega, q, turning_rated_, of_turning_rated_, out);
}

/// Where the side of the motion stands to the spin of each line: +1 faster, -1 slower, 0 as fast.
std::vector<int> SteadySystem::sides(double Omega) const {
  constexpr double same = 1e-12;
  const double side = workspace_.context.whirl_side;
  std::vector<int> out;
  for (const double ratio : ratio_) {
    const double spin = std::abs(ratio * Omega);
    out.push_back(std::abs(side - spin) <= same * spin ? 0 : side > spin ? 1 : -1);
  }
  return out;
}

bool SteadySystem::add_rated(const system::Frames& f, double Omega, const VecX& q, la::MCK& out) {
  const system::Context& c = workspace_.context;
  if (c.whirl == 0.0 || std::isinf(c.whirl)) {
    if (!rated_tangent(f, Omega, q, part())) return false;
    add_scaled(out, 1.0, part());
    return true;
  }
  std::vector<int> side = sides(Omega);
  if (!rates_ || rates_->Omega != Omega || rates_->load != c.load || rates_->q != q ||
      rates_->rotates != c.whirl_rotates || rates_->sides != side || rates_->charts != f.chart) {
    if (!make_rated(f, Omega, q)) return false;
    rates_->sides = std::move(side);
  }
  add_scaled(out, 1.0, rates_->base);
  add_scaled(out, 1.0 / c.whirl, rates_->by_whirl);
  add_scaled(out, c.growth / c.whirl, rates_->by_growth);
  return true;
}

bool SteadySystem::make_rated(const system::Frames& f, double Omega, const VecX& q) {
  system::Context& c = workspace_.context;
  const double whirl = c.whirl, growth = c.growth;
  if (!rates_) {
    rates_ = std::make_unique<Rated>();
    for (la::MCK* m : {&rates_->base, &rates_->by_whirl, &rates_->by_growth})
      *m = system_.make_matrices();
  }
  Rated& r = *rates_;
  r.Omega = nan;  // until it is whole
  // base + by_whirl/w + by_growth g/w, at (w, 0), (2w, 0) and (w, w)
  c.growth = 0.0;
  bool inside = rated_tangent(f, Omega, q, r.base);
  c.whirl = 2.0 * whirl;
  inside = inside && rated_tangent(f, Omega, q, r.by_whirl);
  c.whirl = c.growth = whirl;
  inside = inside && rated_tangent(f, Omega, q, r.by_growth);
  c.whirl = whirl;
  c.growth = growth;
  if (!inside) return false;
  for (const auto part : {&la::MCK::M, &la::MCK::C, &la::MCK::K}) {
    const auto values = [part](la::MCK& m) {
      return Eigen::Map<VecX>((m.*part).data(), static_cast<Index>((m.*part).value_count()));
    };
    auto base = values(r.base), by_whirl = values(r.by_whirl), by_growth = values(r.by_growth);
    by_growth -= base;
    by_whirl = 2.0 * whirl * (base - by_whirl);
    base -= by_whirl / whirl;
  }
  r.Omega = Omega;
  r.load = c.load;
  r.rotates = c.whirl_rotates;
  r.q = q;
  r.charts = f.chart;
  return true;
}

bool SteadySystem::fixed_tangent(const system::Frames& f, double Omega, const VecX& q,
                                 la::MCK& out) {
  if (!fits_polynomial(f, Omega, q)) {
    // A second speed at the same equilibrium: a sweep, in which the polynomials pay.
    const bool sweep = seen_ && seen_speed_ != Omega && seen_q_ == q;
    if (sweep && !make_polynomial(f, Omega, q)) return false;
    seen_ = true;
    seen_speed_ = Omega;
    seen_q_ = q;
  }
  if (fits_polynomial(f, Omega, q)) {
    const Polynomials& p = *polynomial_;
    const auto values = [](const la::BlockMatrix<6>& m) {
      return Eigen::Map<const VecX>(m.data(), static_cast<Index>(m.value_count()));
    };
    const Index n = static_cast<Index>(p.p0.C.value_count());
    std::copy_n(p.p0.M.data(), n, out.M.data());
    Eigen::Map<VecX>(out.C.data(), n) = values(p.p0.C) + Omega * values(p.p1.C);
    Eigen::Map<VecX>(out.K.data(), n) =
        values(p.p0.K) + Omega * values(p.p1.K) + (Omega * Omega) * values(p.k2);
  } else if (!smooth_tangent(f, Omega, q, out)) {
    return false;
  }
  if (!steady_.empty()) {
    if (!evaluate_tangent(f, Omega, q, 0.0, part(), steady_)) return false;
    add_scaled(out, 1.0, part());
  }
  return add_mean_tangent(f, Omega, q, turning_steady_, of_turning_steady_, out);
}

bool SteadySystem::forcing(const system::Frames& f, double Omega, const VecX& q,
                           std::vector<VecXc>& out) {
  out.resize(orders_.size());
  const bool ready = fits_polynomial(f, Omega, q);
  for (std::size_t o = 0; o < orders_.size(); ++o) {
    if (ready)
      out[o] =
          polynomial_->f0[o] + Omega * polynomial_->f1[o] + (Omega * Omega) * polynomial_->f2[o];
    else
      out[o] = VecXc::Zero(q.size());
  }
  return (ready || add_forcing(f, Omega, q, turning_smooth_, out)) &&
         add_forcing(f, Omega, q, turning_, out);
}

}  // namespace whirl::analysis
