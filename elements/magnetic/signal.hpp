// Signals of a controller as scalar nodes: rows of x' = A x + B y, each times a factor that makes it
// a force in size. They take no power from what they measure: their rows stand on signals alone, so
// that f = 0 there whatever the motion, and no force on a shaft comes from them.
#pragma once
#include <core/law.hpp>
#include <system/kernel.hpp>
#include <cmath>

namespace whirl::elements {

/// rate q' + keep q of a signal q.
struct SignalState {
  static constexpr int n_nodes = 1, width = 3;
  static constexpr bool has_M = false, has_C = true, has_K = true, quadratic_in_rates = true,
                        linear_in_displacements = true, powerless = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{};

  double rate = 0;  ///< N s/m
  double keep = 0;  ///< N/m

  void add_force(const system::Nodes<1>& x, const system::Context&, system::ForceX<3>& f) const {
    f[0] += rate * x[0]->du.x() + keep * x[0]->u.x();
  }
  void add_tangent(const system::Nodes<1>&, const system::Context&, system::TangentX<3>& t) const {
    t.C(0, 0) += rate;
    t.K(0, 0) += keep;
  }
  void add_energy(const system::Nodes<1>&, const system::Context&, system::Energy&) const {}
};

/// rate q0' - gain q1/(1 + |q1/limit|^8)^(1/8) in the row of q0: q0 follows what is asked for, q1,
/// no faster than the limit lets it. Nodes: q0, q1, both signals.
struct RateLimit {
  static constexpr int n_nodes = 2, width = 3;
  static constexpr bool has_M = false, has_C = true, has_K = true, quadratic_in_rates = true,
                        powerless = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{};

  double rate = 0;   ///< N s/m
  double gain = 0;   ///< N/m
  double limit = 0;  ///< of q1, m

  /// Followed, and its slope.
  struct Followed {
    double value, slope;
  };
  Followed followed(double asked) const {
    const double ratio = asked / limit, power = 1.0 + std::pow(ratio, 8);
    const double root = std::pow(power, -0.125);
    return {asked * root, root / power};
  }
  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<6>& f) const {
    f[0] += rate * x[0]->du.x() - gain * followed(x[1]->u.x()).value;
  }
  void add_tangent(const system::Nodes<2>& x, const system::Context&,
                   system::TangentX<6>& t) const {
    t.C(0, 0) += rate;
    t.K(0, 3) -= gain * followed(x[1]->u.x()).slope;
  }
  void add_energy(const system::Nodes<2>&, const system::Context&, system::Energy&) const {}
};

/// gain q1 in the row of q0; nodes: q0, q1, both signals.
struct SignalLink {
  static constexpr int n_nodes = 2, width = 3;
  static constexpr bool has_M = false, has_C = false, has_K = true, quadratic_in_rates = true,
                        linear_in_displacements = true, powerless = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{};

  double gain = 0;  ///< N/m

  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<6>& f) const {
    f[0] += gain * x[1]->u.x();
  }
  void add_tangent(const system::Nodes<2>&, const system::Context&, system::TangentX<6>& t) const {
    t.K(0, 3) += gain;
  }
  void add_energy(const system::Nodes<2>&, const system::Context&, system::Energy&) const {}
};

/// power(t) (gain . (u + o t) + constant) in the row of a signal: a displacement of a shaft or its
/// housing, measured. Nodes: 0 signal, 1 measured; u + o t: displacement of the place at the offset
/// o along the axis of its node (t = d - e).
template <bool Varies>
struct Sensor {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = system::Axes::own;
  static constexpr bool has_M = false, has_C = false, has_K = true, quadratic_in_rates = true,
                        linear_in_displacements = !Varies, powerless = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{.time = Varies};

  Vec3 gain = Vec3::Zero();  ///< N/m
  double offset = 0;         ///< o, m
  double constant = 0;       ///< N
  LawPtr power;              ///< of the magnets; null: 1. Constant unless Varies

  double factor(const system::Context& c) const { return power ? power->at(c.time).f : 1.0; }
  void add_force(const system::Nodes<2>& x, const system::Context& c, system::ForceX<14>& f) const {
    f[0] += factor(c) * (gain.dot(x[1]->u + offset * x[1]->t) + constant);
  }
  void add_tangent(const system::Nodes<2>&, const system::Context& c,
                   system::TangentX<14>& t) const {
    const Vec3 seen = factor(c) * gain;
    t.K.template block<1, 3>(0, 7) += seen.transpose();
    t.K.template block<1, 3>(0, 10) += offset * seen.transpose();
  }
  void add_energy(const system::Nodes<2>&, const system::Context&, system::Energy&) const {}
};

}  // namespace whirl::elements
