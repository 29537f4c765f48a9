// A torque as a function of time and speed, T(t, x), in three ways of acting. One node; external: f
// = -torque.
//   joint:  on phi (a constant-velocity joint: the moment stands along (e + d)/(1 + e.d)); x = phi'
//   normal: along the section normal d (drag that turns with the section); x = s = omega.d
//   fixed:  moment T e0 of fixed direction; x = e0.omega
// In each case x is the speed that T works on: its power is T x. Losses (friction, viscous,
// quadratic) count as dissipated, the rest as supplied.
#pragma once
#include <core/law.hpp>
#include <system/kernel.hpp>
#include <memory>
#include <optional>

namespace whirl::elements {

/// T(t, x) = of_time + table + motors + pulsation + governor - ((friction + brake(t)) tanh(x/friction_speed) +
/// viscous x + quadratic x|x|). N m, rad/s. Terms that are zero or absent cost nothing worth
/// mentioning.
struct TorqueLaw {
  LawPtr of_time;  ///< N m; null = 0
  std::vector<double> speed,
      torque;  ///< increasing speeds; linear between, held outside; may be empty
  double friction = 0, viscous = 0, quadratic = 0;  ///< N m, N m s, N m s2
  double friction_speed =
      0.05;  ///< rad/s: below it dry friction is smoothed (0.05 rad/s is half a rpm)
  /// Kloss: 2 Tb/(z/zb + zb/z), slip z = (synchronous - x)/synchronous
  struct Induction {
    double breakdown = 0, slip_breakdown = 0.1, synchronous = 0;
  };
  std::optional<Induction> induction;
  /// A(x) cos(poles (synchronous t - phi) + phase): twice the slip frequency of a salient-pole motor with
  /// that many poles. A mean over its periods is zero.
  struct Pulsation {
    double synchronous = 0, poles = 4, phase = 0;  ///< rad/s, -, rad
    std::vector<double> speed, amplitude;          ///< as the table of torques
  };
  std::optional<Pulsation> pulsation;
  /// power/x, never above max_torque; a motor has max_torque at and below zero speed, a brake (power
  /// below zero) opposes the spin either way
  struct ConstantPower {
    double power = 0, max_torque = 0;
  };
  std::optional<ConstantPower> power;
  /// stall (1 - x/no_load_speed)
  struct DcLine {
    double stall = 0, no_load_speed = 0;
  };
  std::optional<DcLine> dc;
  LawPtr brake;  ///< dry torque against the motion, N m, >= 0; null = 0
  /// Where an integral begins: time, s, and angle, rad, whole turns included. All copies of a law
  /// share it.
  struct Start {
    double time = 0, angle = 0;
  };
  /// kp (target - x) + ki (target (t - t0) - (angle - angle0)), limited to +-max_torque. For a
  /// torque on phi the integral of the speed error from t0 on is exactly target (t - t0) - (phi -
  /// phi(t0)), with no extra state. angle0 = phi0, t0 = 0; with `start` t0 = start->time, angle0 =
  /// phi0 + start->angle.
  struct Governor {
    double target = 0, kp = 0, ki = 0, max_torque = infinity, phi0 = 0;
    std::shared_ptr<const Start> start{};
  };
  std::optional<Governor> governor;

  /// Torque, its derivatives in x and in the angle, and the part of it that is loss (<= 0 against
  /// x).
  struct Value {
    double T = 0, dx = 0, dphi = 0, loss = 0;
  };
  /// settled: a steady state, in which no time passes: a pulsation has its mean, and the integral is
  /// what the steady state needs, which is not for this law to say; it counts as zero here, and with its slope for small motions
  /// about the state.
  Value at(double t, double x, double phi, bool settled = false) const;
  std::vector<double> breakpoints() const;
  /// T depends on x.
  bool follows_speed() const;
};

enum class TorqueAction { joint, normal, fixed };

template <TorqueAction A>
struct SpinTorque {
  static constexpr int n_nodes = 1, width = 7;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::load;
  /// What counts the turns (the integral of a governor) sees the angle, unless means are asked for.
  system::Dependence depends(const system::Context& c) const;

  TorqueLaw law;
  Vec3 e0 = Vec3::UnitX();  ///< direction of a fixed moment, unit, global axes

  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<7>& f) const;
  void add_tangent(const system::Nodes<1>& x, const system::Context& c,
                   system::TangentX<7>& t) const;
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const;
  std::vector<double> breakpoints() const { return law.breakpoints(); }
  /// Torque at a state, N m, and the speed it works on, rad/s.
  struct Working {
    double torque, speed;
  };
  Working working(const system::NodeState& n, double time) const;

 private:
  TorqueLaw::Value value(const system::NodeState& n, const system::Context& c) const;
};

using JointTorque = SpinTorque<TorqueAction::joint>;
using NormalTorque = SpinTorque<TorqueAction::normal>;
using FixedTorque = SpinTorque<TorqueAction::fixed>;

extern template struct SpinTorque<TorqueAction::joint>;
extern template struct SpinTorque<TorqueAction::normal>;
extern template struct SpinTorque<TorqueAction::fixed>;

}  // namespace whirl::elements
