#include <core/contract.hpp>
#include <elements/loads/moment.hpp>
#include <elements/loads/spin_torque.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::elements {

using namespace system;

namespace {

struct Line {
  double value = 0, slope = 0;
};

/// Straight lines between points, held outside.
Line interpolate(const std::vector<double>& at, const std::vector<double>& values, double x) {
  WHIRL_EXPECTS(!at.empty() && at.size() == values.size());
  const auto k = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), x) - at.begin());
  if (k == 0) return {values.front(), 0.0};
  if (k == at.size()) return {values.back(), 0.0};
  const double slope = (values[k] - values[k - 1]) / (at[k] - at[k - 1]);
  return {values[k - 1] + slope * (x - at[k - 1]), slope};
}

void add_pulsation(const TorqueLaw::Pulsation& p, double t, double x, double phi,
                   TorqueLaw::Value& v) {
  const Line amplitude = interpolate(p.speed, p.amplitude, x);
  const double angle = p.poles * (p.synchronous * t - phi) + p.phase, c = std::cos(angle);
  v.T += amplitude.value * c;
  v.dx += amplitude.slope * c;
  v.dphi += amplitude.value * p.poles * std::sin(angle);
}

/// A motor pushes with its largest torque up to the speed at which it has its power; a brake, of
/// negative power, opposes the spin either way, near standstill as dry friction does.
void add_power(const TorqueLaw::ConstantPower& p, double x, double friction_speed,
               TorqueLaw::Value& v) {
  const bool beyond =
      p.power < 0 ? std::abs(x) * p.max_torque > -p.power : x * p.max_torque > p.power;
  if (beyond) {
    v.T += p.power / x;
    v.dx -= p.power / (x * x);
  } else if (p.power < 0) {
    const double smooth = std::tanh(x / friction_speed);
    v.T -= p.max_torque * smooth;
    v.dx -= p.max_torque * (1.0 - smooth * smooth) / friction_speed;
  } else {
    v.T += p.max_torque;
  }
}

}  // namespace

TorqueLaw::Value TorqueLaw::at(double t, double x, double phi, bool settled) const {
  WHIRL_EXPECTS(speed.size() == torque.size());
  WHIRL_EXPECTS(friction_speed > 0.0);
  Value v;
  if (of_time) v.T += of_time->at(t).f;
  if (!speed.empty()) {
    const Line l = interpolate(speed, torque, x);
    v.T += l.value;
    v.dx += l.slope;
  }
  if (induction) {
    const double zb = induction->slip_breakdown, z = 1.0 - x / induction->synchronous,
                 q = z * z + zb * zb;
    v.T += 2.0 * induction->breakdown * z * zb / q;
    v.dx -= 2.0 * induction->breakdown * zb * (zb * zb - z * z) / (q * q) / induction->synchronous;
  }
  if (pulsation && !settled) add_pulsation(*pulsation, t, x, phi, v);
  if (power) add_power(*power, x, friction_speed, v);
  if (dc) {
    v.T += dc->stall * (1.0 - x / dc->no_load_speed);
    v.dx -= dc->stall / dc->no_load_speed;
  }
  if (governor) {
    const Governor& g = *governor;
    const Start from = g.start ? *g.start : Start{};
    const double integral =
        settled ? 0.0 : g.target * (t - from.time) - (phi - from.angle - g.phi0);
    const double T = g.kp * (g.target - x) + g.ki * integral;
    if (std::abs(T) < g.max_torque) {
      v.T += T;
      v.dx -= g.kp;
      v.dphi -= g.ki;
    } else
      v.T += std::copysign(g.max_torque, T);
  }
  const double smooth = std::tanh(x / friction_speed);
  const double dry = friction + (brake ? brake->at(t).f : 0.0);
  v.loss = -(dry * smooth + viscous * x + quadratic * x * std::abs(x));
  v.T += v.loss;
  v.dx -= dry * (1.0 - smooth * smooth) / friction_speed + viscous + 2.0 * quadratic * std::abs(x);
  return v;
}

bool TorqueLaw::follows_speed() const {
  return !speed.empty() || friction != 0.0 || viscous != 0.0 || quadratic != 0.0 || induction ||
         pulsation || power || dc || brake || governor;
}

std::vector<double> TorqueLaw::breakpoints() const {
  std::vector<double> out;
  for (const LawPtr& l : {of_time, brake})
    if (l)
      for (double t : l->breakpoints())
        out.push_back(t);
  return out;
}

namespace {

template <TorqueAction A>
double speed_of(const NodeState& n, const Vec3& e0) {
  if constexpr (A == TorqueAction::joint)
    return n.dphi;
  else if constexpr (A == TorqueAction::normal)
    return n.spin();
  else
    return e0.dot(n.omega());
}

double angle_of(const NodeState& n) { return n.phi + two_pi * n.turns; }

}  // namespace

template <TorqueAction A>
TorqueLaw::Value SpinTorque<A>::value(const NodeState& n, const Context& c) const {
  return law.at(c.time, speed_of<A>(n, e0), angle_of(n), c.averaged);
}

template <TorqueAction A>
Dependence SpinTorque<A>::depends(const Context& c) const {
  const bool counts = (law.pulsation || (law.governor && law.governor->ki != 0.0)) && !c.averaged;
  return {.angle = counts ? each_angle : no_angle,
          .spin = law.follows_speed(),
          .time = counts || varies(law.of_time) || varies(law.brake)};
}

template <TorqueAction A>
void SpinTorque<A>::add_force(const Nodes<1>& x, const Context& c, ForceX<7>& f) const {
  const NodeState& n = *x[0];
  const double T = value(n, c).T;
  if constexpr (A == TorqueAction::joint) {
    f[6] -= T;
  } else if constexpr (A == TorqueAction::normal) {
    f.template segment<3>(3) += T * n.spin_form();  // moment along d: s = phi' - w.d'
    f[6] -= T;
  } else {
    add_moment(n, -T * e0, f);
  }
}

template <TorqueAction A>
void SpinTorque<A>::add_tangent(const Nodes<1>& x, const Context& c, TangentX<7>& t) const {
  const NodeState& n = *x[0];
  const TorqueLaw::Value v = value(n, c);
  if constexpr (A == TorqueAction::joint) {
    t.C(6, 6) -= v.dx;
    t.K(6, 6) -= v.dphi;
  } else {
    // f = -T(x) a(d) with a = dx/dX': x is linear in the rates
    Vector<4> a, x_d = Vector<4>::Zero();
    const Spin s(n);
    if constexpr (A == TorqueAction::normal) {
      a << -s.w, 1.0;
      x_d.template head<3>() = s.s_d;
      t.K.template block<3, 3>(3, 3) += v.T * s.W();
    } else {
      const Vec3 d = n.d();
      const double along = e0.dot(d);
      a << e0.cross(d) - along * s.w, along;
      // x = (e0 x d).d' + (e0.d) s
      x_d.template head<3>() = n.dd.cross(e0) + s.s * e0 + along * s.s_d;
      add_moment_tangent(n, -v.T * e0, t.K);
    }
    t.C.template bottomRightCorner<4, 4>() -= v.dx * a * a.transpose();
    t.K.template bottomRightCorner<4, 4>() -= v.dx * a * x_d.transpose();
    t.K.template block<4, 1>(3, 6) -= v.dphi * a;
  }
}

template <TorqueAction A>
void SpinTorque<A>::add_energy(const Nodes<1>& x, const Context& c, Energy& e) const {
  const double speed = speed_of<A>(*x[0], e0);
  const TorqueLaw::Value v = value(*x[0], c);
  e.supplied += (v.T - v.loss) * speed;
  e.dissipated -= v.loss * speed;
}

template <TorqueAction A>
typename SpinTorque<A>::Working SpinTorque<A>::working(const NodeState& n, double time) const {
  const double speed = speed_of<A>(n, e0);
  return {law.at(time, speed, angle_of(n)).T, speed};
}

template struct SpinTorque<TorqueAction::joint>;
template struct SpinTorque<TorqueAction::normal>;
template struct SpinTorque<TorqueAction::fixed>;

}  // namespace whirl::elements
