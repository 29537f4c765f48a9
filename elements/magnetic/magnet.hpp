// Active magnetic bearing: two axes of opposed pairs of poles, and what they pull.
// With x the displacement of the journal along an axis and i the control current of that axis:
//   linear    F = k_i i + k_s x
//   magnetic  F = c ((i0 + i)/(s0 - b x))^2 - c ((i0 - i)/(s0 + b x))^2,
//             c = k_i s0^2/(4 i0),  b = k_s s0/(k_i i0)
// so that dF/di = k_i and dF/dx = k_s at x = i = 0; b is the cosine of half the angle between the
// poles of a pair where k_s is that of the same magnet. i0: bias current, A; s0: gap, m; k_i N/A;
// k_s N/m, positive: the force grows towards the pole (negative stiffness). Schweitzer and Maslen
// (eds.), Magnetic Bearings, Springer 2009, doi 10.1007/978-3-642-00497-1, chapter 4.
//
// A coil pulls only: where |i| > i0 the other one is without current. Limits, both smooth:
//   current     i/(1 + |i/i_max|^8)^(1/8)
//   saturation  of each pair of poles: f/(1 + (f/f_max)^4)^(1/4), f_max the force it ends at, N
// Towards the pole, below a twentieth of the gap, 1/gap goes on along its tangent, so that a journal
// that no stop holds finds a finite force. Limits: no eddy currents, no hysteresis, no leakage, the
// axes do not act on each other.
#pragma once
#include <core/law.hpp>
#include <elements/supports/lateral_joint.hpp>

namespace whirl::elements {

struct Magnet {
  double per_current = 0;       ///< k_i, N/A
  double per_displacement = 0;  ///< k_s, N/m
  double bias = 0;              ///< i0, A; 0: the linear law
  double gap = 0;               ///< s0, m, of the magnetic law
  double current_limit = 0;     ///< i_max, A; 0: none
  double saturation = 0;        ///< f_max, N, of the magnetic law; 0: none

  struct Pull {
    double force, by_displacement, by_current;  ///< N, N/m, N/A
  };
  /// Along an axis at the displacement x, m, with the control current i, A.
  Pull pull(double x, double i) const;
  /// The force ends somewhere, whatever the current.
  bool has_limit() const { return saturation > 0 || current_limit > 0; }

 private:
  Pull pull_of_pair(double x, double i, double side) const;
};

/// Both axes of a bearing between journal and housing. Nodes: 0 journal, 1 housing, 2 and 3
/// (signals) the control currents, A per `current_unit`.
template <bool Offsets>
struct MagnetJoint {
  static constexpr int n_nodes = 4, width = 7, size = 7 * n_nodes;
  static constexpr system::Axes axes = Offsets ? system::Axes::own : system::Axes::any;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  system::Dependence depends(const system::Context&) const { return {.time = varies(power)}; }
  using Nodes = system::Nodes<n_nodes>;

  Magnet magnet;
  std::array<Vec2, 2> axis{Vec2::UnitX(), Vec2::UnitY()};  ///< of the currents, in (y, z)
  double current_unit = 1;                                 ///< A, of a signal
  LawPtr power;                                            ///< factor on the forces; null: 1
  std::array<double, 2> offset{0.0, 0.0};                  ///< of journal and housing, m

  /// Of one axis: the displacement, m, the control current, A, and what it pulls, with power.
  struct AtAxis {
    double displacement, current;
    Magnet::Pull pull;
  };
  AtAxis at_axis(const Nodes& x, const system::Context& c, std::size_t k) const;
  /// On the journal in (y, z), N.
  Vec2 force(const Nodes& x, const system::Context& c) const;
  /// Of one axis at a displacement, N: where current or force ends, towards the side of this one.
  double capacity(double displacement, double side, const system::Context& c) const;
  void add_force(const Nodes& x, const system::Context& c, system::ForceX<size>& f) const;
  void add_tangent(const Nodes& x, const system::Context& c, system::TangentX<size>& t) const;
  /// All of its power comes from the amplifiers: supplied.
  void add_energy(const Nodes& x, const system::Context& c, system::Energy& e) const;

 private:
  using Link = LateralLink<Offsets>;
  static system::Nodes<2> ends(const Nodes& x) { return {x[0], x[1]}; }
  AtAxis at_axis(const Vec2& r, const Nodes& x, const system::Context& c, std::size_t k) const;
  double factor(const system::Context& c) const { return power ? power->at(c.time).f : 1.0; }
};

extern template struct MagnetJoint<false>;
extern template struct MagnetJoint<true>;

}  // namespace whirl::elements
