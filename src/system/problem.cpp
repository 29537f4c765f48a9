#include <system/problem.hpp>
#include <core/contract.hpp>

#include <core/rotation.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::system {

SystemProblem::SystemProblem(const System& system, ProblemOptions options)
    : system_(system),
      options_(options),
      workspace_(system.make_workspace()),
      matrices_(system.make_matrices()) {
  WHIRL_EXPECTS(options.chart_limit > 0.0 && options.chart_limit < rotation::chart_limit);
  frames = system.make_state().frames;
  kinds_.resize(at(system.size()));
  const auto active = system.active();
  for (Index k = 0; k < system.size(); ++k) {
    const Index c = k % 6;
    kinds_[at(k)] = !active[at(k)]              ? time::Kind::held
                    : system.node(k / 6).scalar ? time::Kind::internal
                    : c < 3                     ? time::Kind::displacement
                    : c == spin_phi             ? time::Kind::spin_angle
                                                : time::Kind::tilt;
  }
  for (const Hold& h : system.holds())
    driven_by_law_ = driven_by_law_ || h.law;
  line_nodes_.resize(at(system.lines()));
  movable_.resize(at(system.lines()));
  lead_.assign(at(system.lines()), -1);
  // A fixed angle or a clamped end shares the turns of its line: such a line keeps them.
  std::vector<unsigned char> clamped(at(system.lines()), 0), rotates(at(system.nodes()), 0);
  for (const auto& term : system.terms()) {
    std::vector<Index> touched;
    if (term->width() == 7) term->list_nodes(touched);
    for (Index i : touched)
      rotates[at(i)] = 1;
  }
  const Followers& followers = system.followers();
  for (Index i = 0; i < system.nodes(); ++i) {
    const NodeDef& def = system.node(i);
    if (def.scalar) continue;
    if (const FollowerDef* f = followers.find(i); f && !f->pinned) {
      line_nodes_[at(def.line)].push_back(i);
      movable_[at(def.line)].push_back(i);
      if (lead_[at(def.line)] < 0) lead_[at(def.line)] = i;
      continue;
    }
    bool any = false, rotation_held = false;
    for (int c = 3; c < 6; ++c)
      (active[at(6 * i + c)] ? any : rotation_held) = true;
    // a prescribed spin still turns: it counts for whole turns
    bool law = false;
    for (const Hold& h : system.holds())
      law = law || (h.unknown == 6 * i + spin_phi && h.law);
    if (rotates[at(i)] && !active[at(6 * i + spin_phi)] && !law) clamped[at(def.line)] = 1;
    if (!any && !law) continue;
    line_nodes_[at(def.line)].push_back(i);
    // a held tilt or angle is held in these axes: such a node keeps them
    if (!rotation_held) movable_[at(def.line)].push_back(i);
    if (lead_[at(def.line)] < 0) lead_[at(def.line)] = i;
  }
  for (Index l = 0; l < system.lines(); ++l)
    if (clamped[at(l)]) lead_[at(l)] = -1;
}

bool SystemProblem::residual(double t, time::CRef q, time::CRef v, time::CRef a, time::Ref r) {
  return system_.residual(workspace_, frames, t, q, v, a, r);
}

void SystemProblem::linearize(double t, time::CRef q, time::CRef v, time::CRef a) {
  system_.tangent(workspace_, frames, t, q, v, a, matrices_);
}

bool SystemProblem::factor(double cm, double cc, double ck) {
  if (!real_)
    real_ = la::make_direct_solver<double>(system_.pattern(), system_.active(), options_.solver);
  return real_->factor(matrices_, cm, cc, ck) == la::Status::ok;
}

bool SystemProblem::factor(Complex cm, Complex cc, Complex ck) {
  if (!complex_)
    complex_ =
        la::make_direct_solver<Complex>(system_.pattern(), system_.active(), options_.solver);
  return complex_->factor(matrices_, cm, cc, ck) == la::Status::ok;
}

std::string SystemProblem::singular_unknown() const {
  const Index k = real_ ? real_->singular_unknown() : -1;
  if (k < 0) return {};
  return std::string(component_name(static_cast<int>(k % 6))) + " of " + system_.node(k / 6).name;
}

time::Problem::Power SystemProblem::power(double t, time::CRef q, time::CRef v, time::CRef a,
                                          time::CRef reactions) {
  system_.evaluate_nodes(workspace_, frames, t, q, v, a);
  return power_here(v, reactions);
}

time::Problem::Power SystemProblem::power_here(time::CRef v, time::CRef reactions) {
  WHIRL_EXPECTS(v.size() == system_.size());
  energy_ = system_.energy(workspace_);
  for (const Hold& h : system_.holds())
    if (h.law) energy_.supplied += reactions[h.unknown] * v[h.unknown];
  return {energy_.kinetic + energy_.elastic + energy_.gravity, energy_.kinetic, energy_.supplied,
          energy_.dissipated};
}

time::Problem::Power SystemProblem::exchange_here(time::CRef v, time::CRef reactions) {
  WHIRL_EXPECTS(v.size() == system_.size());
  Energy e = system_.exchange(workspace_);
  for (const Hold& h : system_.holds())
    if (h.law) e.supplied += reactions[h.unknown] * v[h.unknown];
  return {0.0, 0.0, e.supplied, e.dissipated};
}

bool SystemProblem::accept(double, time::Ref q, time::Ref v, time::Ref a) {
  WHIRL_EXPECTS(q.size() == size() && v.size() == size() && a.size() == size());
  if (system_.followers().empty()) return accept_nodes(q, v, a);
  system_.follow(frames, q, v, a);
  const bool changed = accept_nodes(q, v, a);
  system_.followers().keep_turns(frames, q);
  return changed;
}

bool SystemProblem::accept_nodes(time::Ref q, time::Ref v, time::Ref a) {
  bool changed = false;
  if (frames.moved()) {
    list_normals(q);
    frames.follow(system_, normals_);
  }
  for (Index l = 0; l < system_.lines(); ++l) {
    const auto& nodes = line_nodes_[at(l)];
    // Whole turns leave phi, all nodes of the line together: differences and trigonometry see no
    // change, and phi keeps its last digit over any number of revolutions. 2 pi is taken out in two
    // parts, so that the turns are true turns.
    const Index lead = lead_[at(l)];
    const double turns = lead < 0 ? 0.0 : std::round(q[6 * lead + spin_phi] / two_pi);
    if (std::abs(turns) >= 1.0) {
      for (Index i : nodes)
        rotation::take_turns(q[6 * i + spin_phi], turns);
      frames.turns[at(l)] += turns;
      changed = true;
    }
    if (options_.chart_change) changed = rechart(l, q, v, a) || changed;
  }
  return changed;
}

void SystemProblem::list_normals(time::CRef q) {
  normals_.resize(at(system_.nodes()));
  rotation::Director d;
  for (Index i = 0; i < system_.nodes(); ++i) {
    rotation::director(q.segment<2>(6 * i + gamma2), d);
    normals_[at(i)] = frames.axes(i) * (d.t + Vec3::UnitX());
  }
}

bool SystemProblem::rechart(Index line, time::Ref q, time::Ref v, time::Ref a) {
  const auto& nodes = movable_[at(line)];
  const auto tilt = [&](Index i) { return q.segment<2>(6 * i + gamma2).norm(); };
  if (std::none_of(nodes.begin(), nodes.end(),
                   [&](Index i) { return tilt(i) > options_.chart_limit; }))
    return false;
  list_normals(q);
  // A line that stays nearly straight moves as one: its elements then compare angles as they stand.
  Vec3 mean = Vec3::Zero();
  bool together = nodes.size() == line_nodes_[at(line)].size();
  for (Index i : nodes) {
    mean += normals_[at(i)];
    together = together && frames.same_axes(i, nodes.front());
  }
  mean.normalize();
  for (Index i : nodes)
    together = together && mean.dot(normals_[at(i)]) > 0.5;
  if (together) {
    move(nodes, mean, q, v, a);
    return true;
  }
  for (const Index i : nodes)
    if (tilt(i) > options_.chart_limit) move({&i, 1}, normals_[at(i)], q, v, a);
  return true;
}

void SystemProblem::move(std::span<const Index> nodes, const Vec3& axis, time::Ref q, time::Ref v,
                         time::Ref a) {
  std::vector<rotation::Angles> x;
  for (const Index i : nodes)
    x.push_back({q[6 * i + spin_phi], v[6 * i + spin_phi], a[6 * i + spin_phi],
                 q.segment<2>(6 * i + gamma2), v.segment<2>(6 * i + gamma2),
                 a.segment<2>(6 * i + gamma2)});
  frames.move(system_, nodes, axis, normals_, x);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Index i = 6 * nodes[k];
    q[i + spin_phi] = x[k].phi;
    v[i + spin_phi] = x[k].dphi;
    a[i + spin_phi] = x[k].ddphi;
    q.segment<2>(i + gamma2) = x[k].gamma;
    v.segment<2>(i + gamma2) = x[k].dgamma;
    a.segment<2>(i + gamma2) = x[k].ddgamma;
  }
}

}  // namespace whirl::system
