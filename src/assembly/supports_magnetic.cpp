// Active magnetic bearings: a magnet between shaft and housing, and a scalar node for every signal
// that sensors, controllers and amplifiers store.
#include <assembly/control_loop.hpp>
#include <assembly/support_parts.hpp>
#include <core/contract.hpp>
#include <elements/magnetic/magnet.hpp>
#include <elements/magnetic/signal.hpp>
#include <meshes/mass_properties.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {
namespace {

/// The signals of one bearing on their nodes.
class Signals {
 public:
  Signals(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
          const model::MagneticBearing& law)
      : a_(a),
        law_(law),
        loop_(make_control_loop(law)),
        shaft_(law.sensor_at ? a.mesh.place(*law.sensor_at) : n.shaft),
        housing_(n.other) {
    const Index line = a.builder.add_line(fmt::format("signals of {}", name_of(b)));
    for (Index k = 0; k < loop_.system.states(); ++k)
      nodes_.push_back(a.builder.add_node(
          {Vec3::Zero(), line, fmt::format("signal {} of {}", k + 1, name_of(b)), true, true}));
    for (Index k = 0; k < loop_.system.states(); ++k)
      row_.push_back(law.per_displacement / rate_of_row(k));
    sum_ = nodes_;
    if (law.rate_limit > 0)
      for (const Index k : loop_.current)
        sum_[at(k)] = a.builder.add_node(
            {Vec3::Zero(), line, fmt::format("demand for signal {} of {}", k + 1, name_of(b)), true,
             true});
  }
  /// x' - A x - B y = 0, row by row.
  void add(const model::Bearing& b) {
    const StateSpace& s = loop_.system;
    auto& terms = a_.built.support_terms[number_of(a_, b)];
    for (Index k = 0; k < s.states(); ++k) {
      const double row = row_[at(k)];
      const bool limited = sum(k) != node(k);
      if (limited)
        add_limit(k, terms);
      else
        terms.push_back(
            a_.builder.add(elements::SignalState{row, -row * s.A(k, k)}, {node(k)}, "signals"));
      for (Index j = 0; j < s.states(); ++j)
        if ((j != k || limited) && s.A(k, j) != 0)
          terms.push_back(a_.builder.add(elements::SignalLink{-row * s.A(k, j)}, {sum(k), node(j)},
                                         "links of signals"));
      if (!s.B.row(k).isZero(0.0)) add_sensor(k, terms);
    }
  }
  const ControlLoop& loop() const { return loop_; }
  Index current(std::size_t axis) const { return node(loop_.current[axis]); }
  /// Of the loop through one axis, opened at its sensor.
  MagneticControl::Loop opened(std::size_t axis) const {
    const StateSpace& s = loop_.system;
    const Index sensor = loop_.sensor[axis];
    MagneticControl::Loop out;
    out.axis = loop_.axis[axis];
    out.shaft = shaft_;
    out.housing = housing_;
    if (sensor >= 0) {
      out.signal = node(sensor);
      out.unit = loop_.size[sensor];
    }
    for (Index k = 0; k < s.states(); ++k) {
      const double gain =
          sensor >= 0 ? s.A(k, sensor) / out.unit : s.B(k, static_cast<Index>(axis));
      if (k != sensor && gain != 0) out.entry.emplace_back(sum(k), row_[at(k)] * gain);
    }
    return out;
  }

 private:
  using StateSpace = elements::StateSpace;
  Index node(Index k) const { return nodes_[at(k)]; }
  /// In whose row A x + B y stands.
  Index sum(Index k) const { return sum_[at(k)]; }
  /// 1/s: what a row is divided by, so that its entries are of one size.
  double rate_of_row(Index k) const {
    const StateSpace& s = loop_.system;
    return std::max(s.A.row(k).cwiseAbs().maxCoeff(), s.B.row(k).cwiseAbs().maxCoeff());
  }
  /// x' = w f(q) with w q = A x + B y, w the amplifier's bandwidth, f what the rate is bounded to.
  void add_limit(Index k, std::vector<std::size_t>& terms) {
    const double gain = row_[at(k)] * law_.amplifier_bandwidth;
    const double limit = law_.rate_limit / (law_.amplifier_bandwidth * loop_.current_unit);
    terms.push_back(a_.builder.add(elements::SignalState{0.0, gain}, {sum(k)}, "signals"));
    terms.push_back(a_.builder.add(elements::RateLimit{row_[at(k)], gain, limit}, {node(k), sum(k)},
                                   "rate limits"));
  }
  void add_sensor(Index k, std::vector<std::size_t>& terms) {
    const auto add = [&](auto sensor) {
      sensor.power = law_.power;
      for (const std::size_t axis : {0, 1}) {
        const double gain = -row_[at(k)] * loop_.system.B(k, static_cast<Index>(axis));
        sensor.gain.template tail<2>() += gain * loop_.axis[axis];
        sensor.constant -= gain * law_.setpoint[static_cast<Index>(axis)];
      }
      sensor.offset = shaft_.offset;
      terms.push_back(a_.builder.add(sensor, {sum(k), shaft_.node}, "sensors"));
      if (a_.mesh.nodes[at(housing_.node)].kind == meshes::NodeKind::ground) return;
      sensor.gain *= -1.0;
      sensor.constant = 0.0;
      sensor.offset = housing_.offset;
      terms.push_back(a_.builder.add(sensor, {sum(k), housing_.node}, "sensors"));
    };
    if (varies(law_.power))
      add(elements::Sensor<true>{});
    else
      add(elements::Sensor<false>{});
  }

  Assembly& a_;
  const model::MagneticBearing& law_;
  ControlLoop loop_;
  meshes::Place shaft_, housing_;
  std::vector<Index> nodes_, sum_;
  std::vector<double> row_;  ///< N s/m
};

template <bool Offsets>
void add_magnet(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                const model::MagneticBearing& law, const Signals& signals,
                MagneticControl& control) {
  using Kernel = elements::MagnetJoint<Offsets>;
  Kernel joint;
  joint.magnet = {.per_current = law.per_current,
                  .per_displacement = law.per_displacement,
                  .bias = law.bias,
                  .gap = law.gap,
                  .current_limit = law.current_limit,
                  .saturation = law.saturation};
  joint.axis = signals.loop().axis;
  joint.current_unit = signals.loop().current_unit;
  joint.power = law.power;
  joint.offset = {n.shaft.offset, n.other.offset};
  const std::array<Index, 4> nodes{n.shaft.node, n.other.node, signals.current(0),
                                   signals.current(1)};
  a.built.support_terms[number_of(a, b)].push_back(a.builder.add(joint, nodes, "magnets"));
  a.built.support_forces.push_back(
      {b.name, [joint, nodes](const NodeAt& at, const system::Context& c, const ReactionAt&) {
         const Vec2 F =
             joint.force({&at(nodes[0]), &at(nodes[1]), &at(nodes[2]), &at(nodes[3])}, c);
         return Vec3(0.0, F.x(), F.y());
       }});
  if (law.gap > 0)
    a.built.conditions.push_back({number_of(a, b), b.name, b.where,
                                  [r = displacement_of(n), gap = law.gap](const NodeAt& at) {
                                    SupportCondition::State s;
                                    s.magnet = true;
                                    s.gap = gap;
                                    s.displacement = r(at).norm();
                                    return s;
                                  }});
  const auto states = [nodes](const NodeAt& at) {
    return typename Kernel::Nodes{&at(nodes[0]), &at(nodes[1]), &at(nodes[2]), &at(nodes[3])};
  };
  control.standing = [joint, states](const NodeAt& at, const system::Context& c) {
    std::array<MagneticControl::Standing, 2> out;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto [x, i, pull] = joint.at_axis(states(at), c, k);
      const double most = joint.magnet.has_limit() ? joint.capacity(x, pull.force, c) : infinity;
      out[k] = {x, i, pull.force, most};
    }
    return out;
  };
  control.stiffness = [joint, states, loop = signals.loop()](const NodeAt& at,
                                                             const system::Context& c, double w) {
    const MatXc current = loop.system.at(Complex(0.0, w));  // A/m
    Eigen::Matrix2cd Z = Eigen::Matrix2cd::Zero();          // along the axes
    for (std::size_t k = 0; k < 2; ++k) {
      const elements::Magnet::Pull pull = joint.at_axis(states(at), c, k).pull;
      const auto row = static_cast<Index>(k);
      Z.row(row) = -pull.by_current * current.row(row);
      Z(row, row) -= pull.by_displacement;
    }
    Mat2 axes;
    axes << joint.axis[0].transpose(), joint.axis[1].transpose();
    return Eigen::Matrix2cd(axes.transpose().cast<Complex>() * Z * axes.cast<Complex>());
  };
}

/// rad/s: above it the loop's force is less than a hundredth of the inertia of the shaft.
double bandwidth_of(const Assembly& a, const model::Bearing& b, const model::MagneticBearing& law,
                    const ControlLoop& loop) {
  constexpr double share = 0.01, step = 1.25, furthest = 1e4;
  const double mass = meshes::shaft_mass(a.model, b.at.shaft).mass;
  double last = law.amplifier_bandwidth;
  for (double w = last; w < furthest * law.amplifier_bandwidth; w *= step) {
    const double gain = loop.system.at(Complex(0.0, w)).cwiseAbs().maxCoeff();
    if (law.per_current * gain > share * mass * w * w) last = w;
  }
  return last;
}

/// A controller that grows by itself is told: it may be meant.
void tell_unstable(Assembly& a, const model::Bearing& b, const ControlLoop& loop) {
  double fastest = 0;
  for (const Complex& pole : loop.poles)
    fastest = std::max(fastest, pole.real());
  if (fastest > 1e-9 * loop.poles.cwiseAbs().maxCoeff())
    a.built.notes.push_back(fmt::format(
        "the controller of {} is unstable by itself: it grows with {:.4g}/s", name_of(b), fastest));
}

}  // namespace

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::MagneticBearing& law) {
  guarded(a, b, [&] {
    Signals signals(a, b, n, law);
    signals.add(b);
    MagneticControl control;
    control.bearing = number_of(a, b);
    control.current_unit = signals.loop().current_unit;
    control.bandwidth = bandwidth_of(a, b, law, signals.loop());
    if (n.shaft.offset == 0 && n.other.offset == 0)
      add_magnet<false>(a, b, n, law, signals, control);
    else
      add_magnet<true>(a, b, n, law, signals, control);
    auto& terms = a.built.support_terms[number_of(a, b)];
    std::sort(terms.begin(), terms.end());
    terms.erase(std::unique(terms.begin(), terms.end()), terms.end());
    a.take_breakpoints(law.power);
    tell_unstable(a, b, signals.loop());
    for (const std::size_t axis : {0, 1}) {
      control.currents[axis] = signals.current(axis);
      control.loops[axis] = signals.opened(axis);
    }
    a.built.magnetic_controls.push_back(std::move(control));
  });
}

}  // namespace whirl::assembly
