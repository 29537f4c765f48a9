#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/rotation.hpp>
#include <system/momentum.hpp>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace whirl::system {

namespace {

Index entries(int form) { return form == 0 ? 12 : 6; }

/// Rotation of the body axes, L(gamma) L(phi e) in global axes.
Mat3 body_axes(const Mat3& chart, double phi, const Vec2& gamma) {
  return chart * rotation::L(Vec3(0, gamma.x(), gamma.y())) * rotation::L(Vec3(phi, 0, 0));
}

}  // namespace

std::string MomentumProblem::list_bodies(const System& system, std::vector<Body>& bodies) {
  if (!system.followers().empty()) return "a joint (" + system.followers()[0].joint + ")";
  std::vector<RigidInertia> inertia(at(system.nodes()));
  for (const auto& term : system.terms()) {
    if (term->inertial() && !term->add_rigid_inertia(inertia))
      return "an inertia that changes in time (" + std::string(term->kind()) + ")";
  }
  const auto active = system.active();
  const State start = system.make_state();
  Index next = 0;
  for (Index i = 0; i < system.nodes(); ++i) {
    const NodeDef& def = system.node(i);
    int free = 0;
    for (int c = 0; c < 6; ++c)
      free |= active[at(6 * i + c)] ? 1 << c : 0;
    if (free == 0) continue;
    if (def.scalar) return "an internal unknown (" + def.name + ")";
    const RigidInertia& in = inertia[at(i)];
    Body b{};
    b.node = i;
    b.line = def.line;
    b.start = next;
    b.mass = in.mass;
    b.form = free == 63 ? Form::free : free == 56 ? Form::pivot : Form::point;
    if (free != 63 && free != 56 && free != 7) return "a partly held node (" + def.name + ")";
    for (const Hold& h : system.holds())
      if (h.law && h.unknown / 6 == i) return "a prescribed motion (" + def.name + ")";
    if (b.form != Form::pivot && !(in.mass > 0.0)) return "a node without mass (" + def.name + ")";
    b.centre = in.mass > 0.0 ? Vec3(in.moment / in.mass) : Vec3(Vec3::Zero());
    if (b.form == Form::point && in.moment.norm() > 0.0)
      return "a body that cannot turn (" + def.name + ")";
    b.J = in.J;
    if (b.form == Form::free)
      b.J -=
          in.mass * (b.centre.squaredNorm() * Mat3::Identity() - b.centre * b.centre.transpose());
    if (b.form != Form::point) {
      const double size = b.J.cwiseAbs().maxCoeff();
      if (!(b.J.determinant() > 1e-12 * size * size * size))
        return "a node without rotary inertia (" + def.name + ")";
      b.J_inverse = b.J.inverse();
    }
    b.centre0 = start.frames.axes(i) * b.centre;
    next += entries(static_cast<int>(b.form));
    bodies.push_back(b);
  }
  if (bodies.empty()) return "nothing that moves";
  return {};
}

std::string MomentumProblem::obstacle(const System& system) {
  std::vector<Body> bodies;
  std::string found = list_bodies(system, bodies);
  if (!found.empty()) return found;
  // Mass in anything else shows in its tangent.
  Workspace w = system.make_workspace();
  system.make_tangents(w);
  const State s = system.make_state();
  VecX q = s.q, v = s.v, a = s.a;
  system.impose(s.frames, 0.0, q, v, a);
  system.evaluate_nodes(w, s.frames, 0.0, q, v, a);
  for (const auto& term : system.terms()) {
    if (term->inertial()) continue;
    w.M.set_zero();
    w.C.set_zero();
    w.K.set_zero();
    term->add_tangent(w);
    if (std::any_of(w.M.data(), w.M.data() + w.M.value_count(), [](double x) { return x != 0.0; }))
      return "mass in " + std::string(term->kind());
  }
  return {};
}

MomentumProblem::MomentumProblem(const System& system, MomentumOptions options)
    : system_(system),
      options_(options),
      w_(system.make_workspace()) {
  WHIRL_EXPECTS(options.displacement > 0.0 && options.tilt > 0.0 && options.rate > 0.0);
  const std::string found = obstacle(system);
  if (!found.empty())
    throw Error(Exit::deck, Diagnostic{Diagnostic::Severity::error,
                                       "E74",
                                       "the momentum form does not cover " + found,
                                       "use another integrator (radau5)",
                                       {}});
  list_bodies(system, bodies_);
  frames = system.make_state().frames;
  const State s = system.make_state();
  q_ = s.q;
  v_ = s.v;
  a_ = s.a;
  for (const Body& b : bodies_) {
    const auto add = [&](int n, double x, bool unbounded = false) {
      for (int i = 0; i < n; ++i) {
        scale_.push_back(x);
        unbounded_.push_back(unbounded);
      }
    };
    if (b.form != Form::pivot) {
      add(3, options.displacement);
      add(3, options.displacement * options.rate);
    }
    if (b.form == Form::point) continue;
    add(1, 1.0, true);
    add(2, options.tilt);
    add(3, b.J.diagonal().maxCoeff() * options.tilt * options.rate);
  }
  size_ = static_cast<Index>(scale_.size());
  dy_.resize(size_);
}

MomentumProblem::Attitude MomentumProblem::attitude(const Body& b, time::CRef y) const {
  const Index k = angles(b);
  Attitude r;
  r.R = body_axes(frames.axes(b.node), y[k], y.segment<2>(k + 1));
  r.omega = r.R * (b.J_inverse * (r.R.transpose() * y.segment<3>(k + 3)));
  return r;
}

bool MomentumProblem::evaluate(double t, time::CRef y) {
  WHIRL_EXPECTS(y.size() == size_);
  a_.setZero();
  system_.impose(frames, t, q_, v_, a_);
  for (const Body& b : bodies_) {
    const Index n = 6 * b.node;
    if (b.form == Form::point) {
      q_.segment<3>(n) = y.segment<3>(b.start);
      v_.segment<3>(n) = y.segment<3>(b.start + 3);
      continue;
    }
    const Index k = angles(b);
    const Vec2 gamma = y.segment<2>(k + 1);
    if (!(gamma.squaredNorm() < rotation::chart_limit * rotation::chart_limit)) {
      w_.outside = b.node;
      return false;
    }
    const Attitude x = attitude(b, y);
    q_.segment<3>(n + 3) = y.segment<3>(k);
    const rotation::ChartRates rate =
        rotation::rates_of_omega(gamma, frames.axes(b.node).transpose() * x.omega);
    v_[n + 3] = rate.phi;
    v_.segment<2>(n + 4) = rate.gamma;
    if (b.form == Form::free) {
      const Vec3 arm = x.R * b.centre;
      q_.segment<3>(n) = y.segment<3>(b.start) - (arm - b.centre0);
      v_.segment<3>(n) = y.segment<3>(b.start + 3) - x.omega.cross(arm);
    }
  }
  return system_.evaluate_nodes(w_, frames, t, q_, v_, a_);
}

bool MomentumProblem::rate(double t, time::CRef y, time::Ref dy) {
  WHIRL_EXPECTS(dy.size() == size_);
  if (!evaluate(t, y)) return false;
  for (auto& f : w_.force)
    f.setZero();
  for (const auto& term : system_.terms())
    if (!term->inertial()) term->add_force(w_);
  for (const Body& b : bodies_) {
    const Vector<7>& f = w_.force[at(b.node)];
    const NodeState& n = w_.nodes[at(b.node)];
    const Vec3 F = -f.head<3>();
    if (b.form != Form::pivot) {
      dy.segment<3>(b.start) = y.segment<3>(b.start + 3);
      dy.segment<3>(b.start + 3) = F / b.mass + w_.context.gravity;
    }
    if (b.form == Form::point) continue;
    // moment about the node of the generalized forces (f_d, f_phi): d x f_d + f_phi (e + d)/(1 +
    // e.d)
    const Vec3 f_d = f.segment<3>(3);
    Vec3 moment = -(n.d().cross(f_d) + (f[6] / (2.0 + n.e().dot(n.t))) * (2.0 * n.e() + n.t));
    const Index k = angles(b);
    if (b.centre.squaredNorm() > 0.0) {
      const Vec3 arm = body_axes(*n.chart, y[k], y.segment<2>(k + 1)) * b.centre;
      moment -= b.form == Form::free ? arm.cross(F) : arm.cross(Vec3(-b.mass * w_.context.gravity));
    }
    dy[k] = n.dphi;
    dy.segment<2>(k + 1) = v_.segment<2>(6 * b.node + 4);
    dy.segment<3>(k + 3) = moment;
  }
  return dy.allFinite();
}

void MomentumProblem::set_state(const State& s, time::Ref y) {
  WHIRL_EXPECTS(s.q.size() == system_.size() && s.v.size() == system_.size());
  WHIRL_EXPECTS(y.size() == size_);
  frames = s.frames;
  for (const Body& b : bodies_) {
    const Index n = 6 * b.node;
    if (b.form != Form::pivot) {
      y.segment<3>(b.start) = s.q.segment<3>(n);
      y.segment<3>(b.start + 3) = s.v.segment<3>(n);
    }
    if (b.form == Form::point) continue;
    const Index k = angles(b);
    const Vec2 gamma = s.q.segment<2>(n + 4);
    const Mat3& chart = frames.axes(b.node);
    const Mat3 R = body_axes(chart, s.q[n + 3], gamma);
    const Vec3 omega = chart * rotation::omega_of_rates(gamma, s.v[n + 3], s.v.segment<2>(n + 4)),
               arm = R * b.centre;
    y.segment<3>(k) = s.q.segment<3>(n + 3);
    y.segment<3>(k + 3) = R * (b.J * (R.transpose() * omega));
    if (b.form == Form::free) {
      y.segment<3>(b.start) += arm - b.centre0;
      y.segment<3>(b.start + 3) += omega.cross(arm);
    }
    // momenta of the size they start with
    for (int i = 0; i < 3; ++i)
      scale_[at(k + 3 + i)] = std::max(scale_[at(k + 3 + i)], y.segment<3>(k + 3).norm());
  }
}

bool MomentumProblem::get_state(double t, time::CRef y, State& s) {
  if (!rate(t, y, dy_)) return false;
  s.t = t;
  s.frames = frames;
  s.q = q_;
  s.v = v_;
  s.a = a_;
  for (const Body& b : bodies_) {
    const Index n = 6 * b.node;
    if (b.form != Form::pivot) s.a.segment<3>(n) = dy_.segment<3>(b.start + 3);
    if (b.form == Form::point) continue;
    const Index k = angles(b);
    const Attitude x = attitude(b, y);
    // K' = J omega' + omega x K
    const Vec3 K = y.segment<3>(k + 3), rest = dy_.segment<3>(k + 3) - x.omega.cross(K);
    const Vec3 domega = x.R * (b.J_inverse * (x.R.transpose() * rest));
    if (b.form == Form::free) {
      const Vec3 arm = x.R * b.centre;
      s.a.segment<3>(n) -= domega.cross(arm) + x.omega.cross(x.omega.cross(arm));
    }
    const Vec2 gamma = y.segment<2>(k + 1), dgamma = s.v.segment<2>(n + 4);
    const auto acc = rotation::accelerations_of_omega(gamma, s.v[n + 3], dgamma,
                                                      frames.axes(b.node).transpose() * domega);
    s.a[n + 3] = acc.phi;
    s.a.segment<2>(n + 4) = acc.gamma;
  }
  return true;
}

bool MomentumProblem::accept(time::Ref y) {
  bool changed = take_turns(y);
  bool far = false;
  for (const Body& b : bodies_)
    far = far ||
          (b.form != Form::point && y.segment<2>(angles(b) + 1).norm() > rotation::chart_switch);
  far = far && options_.chart_change;
  if (!far && !frames.moved()) return changed;
  normals_.resize(at(system_.nodes()), Vec3::UnitX());
  for (const Body& b : bodies_) {
    if (b.form == Form::point) continue;
    const Vec2 gamma = y.segment<2>(angles(b) + 1);
    normals_[at(b.node)] = frames.axes(b.node) * rotation::L(Vec3(0, gamma.x(), gamma.y())).col(0);
  }
  frames.follow(system_, normals_);
  if (!far) return changed;
  for (const Body& b : bodies_) {
    if (b.form == Form::point) continue;
    const Index k = angles(b);
    if (y.segment<2>(k + 1).norm() <= rotation::chart_switch) continue;
    rotation::Angles angle;
    angle.phi = y[k];
    angle.gamma = y.segment<2>(k + 1);
    frames.move(system_, {&b.node, 1}, normals_[at(b.node)], normals_, {&angle, 1});
    y[k] = angle.phi;
    y.segment<2>(k + 1) = angle.gamma;
  }
  return true;
}

bool MomentumProblem::take_turns(time::Ref y) {
  bool changed = false;
  for (Index line = 0; line < system_.lines(); ++line) {
    double turns = 0.0;
    bool first = true;
    for (const Body& b : bodies_) {
      if (b.line != line || b.form == Form::point) continue;
      const Index k = angles(b);
      if (first) turns = std::nearbyint(y[k] / two_pi);
      first = false;
      // each removal restarts the integrator; 64 turns cost phi six bits, 6e-14 rad
      if (std::abs(turns) < 64.0) break;
      y[k] = rotation::without_turns(y[k], turns);
    }
    if (std::abs(turns) < 64.0) continue;
    frames.turns[at(line)] += turns;
    changed = true;
  }
  return changed;
}

}  // namespace whirl::system
