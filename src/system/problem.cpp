#include <system/problem.hpp>

#include <core/rotation.hpp>

#include <cmath>

namespace whirl::system {

SystemProblem::SystemProblem(const System& system, ProblemOptions options)
    : system_(system),
      options_(options),
      workspace_(system.make_workspace()),
      matrices_(system.make_matrices()) {
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
  rechartable_.assign(at(system.lines()), 1);
  lead_.assign(at(system.lines()), -1);
  // A fixed angle or a clamped end shares chart and turns of its line: such a line keeps both.
  std::vector<unsigned char> clamped(at(system.lines()), 0), rotates(at(system.nodes()), 0);
  for (const auto& term : system.terms()) {
    std::vector<Index> touched;
    if (term->width() == 7) term->list_nodes(touched);
    for (Index i : touched)
      rotates[at(i)] = 1;
  }
  for (Index i = 0; i < system.nodes(); ++i) {
    const NodeDef& def = system.node(i);
    if (def.scalar) continue;
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
    // a held tilt or angle is held in this chart: such a line keeps it
    if (rotation_held) rechartable_[at(def.line)] = 0;
    if (lead_[at(def.line)] < 0) lead_[at(def.line)] = i;
  }
  for (Index l = 0; l < system.lines(); ++l)
    if (clamped[at(l)]) line_nodes_[at(l)].clear();
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
  energy_ = system_.energy(workspace_);
  for (const Hold& h : system_.holds())
    if (h.law) energy_.supplied += reactions[h.unknown] * v[h.unknown];
  return {energy_.kinetic + energy_.elastic + energy_.gravity, energy_.kinetic, energy_.supplied,
          energy_.dissipated};
}

time::Problem::Power SystemProblem::exchange_here(time::CRef v, time::CRef reactions) {
  Energy e = system_.exchange(workspace_);
  for (const Hold& h : system_.holds())
    if (h.law) e.supplied += reactions[h.unknown] * v[h.unknown];
  return {0.0, 0.0, e.supplied, e.dissipated};
}

bool SystemProblem::accept(double, time::Ref q, time::Ref v, time::Ref a) {
  bool changed = false;
  for (Index l = 0; l < system_.lines(); ++l) {
    const auto& nodes = line_nodes_[at(l)];
    if (nodes.empty()) continue;
    // Whole turns leave phi, all nodes of the line together: differences and trigonometry see no
    // change, and phi keeps its last digit over any number of revolutions. 2 pi is taken out in two
    // parts, so that the turns are true turns.
    const double turns = std::round(q[6 * lead_[at(l)] + spin_phi] / two_pi);
    if (std::abs(turns) >= 1.0) {
      for (Index i : nodes)
        rotation::take_turns(q[6 * i + spin_phi], turns);
      frames.turns[at(l)] += turns;
      changed = true;
    }
    if (!options_.chart_change || !rechartable_[at(l)]) continue;
    for (Index i : nodes)
      if (q.segment<2>(6 * i + 4).squaredNorm() > options_.chart_limit * options_.chart_limit) {
        changed = rechart(l, q, v, a) || changed;
        break;
      }
  }
  return changed;
}

bool SystemProblem::rechart(Index line, time::Ref q, time::Ref v, time::Ref a) {
  // New axis: along the first node's present director, so that every node of the line starts near
  // the middle of it.
  const auto& nodes = line_nodes_[at(line)];
  const Mat3 old_chart = frames.chart[at(line)];
  auto director_of = [&](Index i) {
    rotation::Director d;
    rotation::director(q.segment<2>(6 * i + 4), d);
    return Vec3(old_chart * (d.t + Vec3::UnitX()));
  };
  Vec3 mean = Vec3::Zero();
  for (Index i : nodes)
    mean += director_of(i);
  if (mean.norm() < 1e-3 * static_cast<double>(nodes.size())) return false;
  const rotation::ChartChange change(old_chart, mean.normalized());
  for (Index i : nodes) {
    const rotation::Angles n =
        change.apply({q[6 * i + 3], v[6 * i + 3], a[6 * i + 3], q.segment<2>(6 * i + 4),
                      v.segment<2>(6 * i + 4), a.segment<2>(6 * i + 4)});
    q[6 * i + 3] = n.phi;
    v[6 * i + 3] = n.dphi;
    a[6 * i + 3] = n.ddphi;
    q.segment<2>(6 * i + 4) = n.gamma;
    v.segment<2>(6 * i + 4) = n.dgamma;
    a.segment<2>(6 * i + 4) = n.ddgamma;
  }
  frames.chart[at(line)] = change.new_triad();
  return true;
}

}  // namespace whirl::system
