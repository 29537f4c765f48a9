// Momentum form of systems whose only inertia is that of rigid bodies and point masses: y' = F(t,
// y) with, for each body,
//   r' = v,   m v' = F,   phi' = (e + d).omega/(1 + e.d)   (11),   gamma' = D+ (omega x d)   (9),
//       K' = Mo,   omega = J^-1 K
// (the system (12) of Sorokin & Zhang 2018, doi 10.18698/2308-6033-2018-10-1815). r and v belong to
// the mass centre, K is the angular momentum about it, F and Mo are collected from all elements
// that are not inertia. A second route to the same motion: it shares the elements' forces with the
// second-order form and nothing of its inertia, tangents or solvers.
//
// Also: bodies whose node stands still (K then about the node) and point masses. Not: prescribed
// motion of a body, partly held nodes, shaft elements with mass, added mass, static moments that
// change in time; the constructor says which it met.
#pragma once
#include <system/system.hpp>
#include <time/first_order.hpp>
#include <string>
#include <vector>

namespace whirl::system {

struct MomentumOptions {
  double displacement = 1e-3;  ///< m: scale of displacements for absolute tolerances
  double tilt = 1e-3;          ///< rad: scale of gamma
  double rate =
      100.0;  ///< rad/s: scales of velocities and momenta are at least scale x rate (x inertia)
  bool chart_change = true;
};

class MomentumProblem final : public time::FirstOrderProblem {
 public:
  /// @throws Error E74, the system has something this form does not cover.
  MomentumProblem(const System& system, MomentumOptions options = {});
  /// Empty when the momentum form covers the system, else what stands against it.
  static std::string obstacle(const System& system);

  Index size() const override { return size_; }
  bool rate(double t, time::CRef y, time::Ref dy) override;
  double scale(Index i) const override { return scale_[static_cast<std::size_t>(i)]; }
  bool is_unbounded(Index i) const override { return unbounded_[static_cast<std::size_t>(i)] != 0; }

  /// y of a state (its charts and turns are taken over).
  void set_state(const State& s, time::Ref y);
  /// q, v and a of (t, y); a from the rates, so that residuals, probes and energies apply. False
  /// outside the charts.
  bool get_state(double t, time::CRef y, State& s);
  /// Between steps: takes whole turns (64 or more at once) out of phi and moves charts beyond
  /// rotation::chart_switch. True when y has changed: the integrator then starts anew from it.
  bool accept(time::Ref y);
  Frames frames;  ///< charts and turns of y

 private:
  enum class Form { free, pivot, point };
  struct Body {
    Form form;
    Index node, line, start;  ///< start: of its entries in y
    double mass;
    Vec3 centre;        ///< mass centre from the node, body axes, m
    Vec3 centre0;       ///< the same in global axes at phi = 0, gamma = 0
    Mat3 J, J_inverse;  ///< about the mass centre (pivot: the node), body axes
  };
  struct Attitude {
    Mat3 R;
    Vec3 omega;
  };  ///< body axes to global; global
  Attitude attitude(const Body& b, time::CRef y) const;
  bool evaluate(double t, time::CRef y);
  bool take_turns(time::Ref y);
  static Index angles(const Body& b) { return b.start + (b.form == Form::free ? 6 : 0); }
  /// The bodies the form covers; returns the obstacle, if any.
  static std::string list_bodies(const System& system, std::vector<Body>& bodies);

  const System& system_;
  MomentumOptions options_;
  std::vector<Body> bodies_;
  Index size_ = 0;
  std::vector<double> scale_;
  std::vector<unsigned char> unbounded_;
  Workspace w_;
  VecX q_, v_, a_, dy_;
  std::vector<Vec3> normals_;
};

}  // namespace whirl::system
