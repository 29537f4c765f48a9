// Small motions in time about a rotor that turns at constant speed in its static equilibrium:
//   R(steady motion, t) + M (a - a0) + C (v - v0) + K (q - q0(t)) = 0
// with the residual of the general model along the steady motion (unbalance, gravity, given forces
// as they act at t) and the constant matrices of the Linearizer. Terms whose force does not change
// along the steady motion (the shaft, its damping, its weight) are evaluated once; where those that
// do (unbalances, skewed disks) hang on the angle alone of lines that turn equally fast, they are a
// Fourier series in it, found at the start and checked to 1e-11 at other angles. One linearisation serves the run, one factorisation each length of step, and Newton's first iteration
// is exact. Held unknowns follow their laws. What is left out is of second order in the motion:
// with tilts of 1e-3 the response is right to about 1e-6.
//
// Loads of joints stand in the residual at nodes that follow. Held there are no unknowns, so that the
// matrices say nothing of them: they are those of the steady motion and what changes them to first order,
// the central difference of the general model's along the small motion.
//
// q is the whole state, not the deviation: whatever reads a SystemProblem reads this one.
//
// Energies are those of the general model at this state, so that they can be compared with those of
// a general run. The speed is kept by assumption; the torque that keeps it is of second order and
// stands in none of the equations, but its work is of the order of the energies themselves. The
// power of all that the general equations R_g have beside these, R,
//   v . (R_g - R) = Omega (torque that keeps the speed) + third order,
// counts as supplied: then the balance closes as exactly as these equations are integrated.
#pragma once
#include <analysis/linearizer.hpp>
#include <core/archive.hpp>
#include <system/problem.hpp>
#include <time/affine.hpp>
#include <optional>
#include <span>
#include <vector>

namespace whirl::analysis {

class LinearMotion final : public system::SystemProblem, public time::AffineProblem {
 public:
  /// Omega: rad/s of the lines with ratio 1. start: state the run begins with; its angles say where
  /// the lines stand at start.t.
  /// @throws Error as Linearizer::at; E39 when the matrices turn with a rotor.
  LinearMotion(const system::System& system, const SteadyRotation& running, double Omega,
               const system::State& start, EquilibriumOptions options = {});

  /// From now on residuals hold the loads of joints, which costs some evaluations of what is joined.
  void take_joint_loads();

  bool is_linear() const override { return true; }
  bool residual(double t, time::CRef q, time::CRef v, time::CRef a, time::Ref r) override;
  bool residuals_along(const time::FreeMotion& m, Eigen::Ref<MatX> r) override;
  bool bound_along(const time::FreeMotion& m) override;
  void multiply(double t, time::CRef q, time::CRef v, time::Bound& bound,
                time::StepProducts& step) override;
  std::optional<std::span<const Index>> changing_entries() const override;
  void changing(double t, time::Ref values) const override;
  std::span<const unsigned char> works() const override { return works_; }
  /// Keeps the matrices it has.
  void linearize(double, time::CRef, time::CRef, time::CRef) override {}
  Power power_here(time::CRef v, time::CRef reactions) override;
  Power exchange_here(time::CRef v, time::CRef reactions) override;
  bool power_needs_reactions() const override { return true; }

  /// q of the steady motion at t, its rates.
  void steady(double t, VecX& q) const;
  const VecX& steady_rates() const { return v0_; }
  /// Of a node, what q has beside the steady motion at t.
  Vector<6> beside(double t, const VecX& q, Index node) const;

  /// The steady motion, for checkpoints.
  void save(OutArchive& out) const {
    out.put(q0_);
    out.put(v0_);
    out.put(angle_);
    out.put(constant_);
  }
  void restore(InArchive& in) {
    q0_ = in.vector();
    v0_ = in.vector();
    angle_ = in.vector();
    constant_ = in.vector();
    series_ = {};
  }

 private:
  /// Of the changing terms along the steady motion: sums over harmonics 1 .. of the angle.
  struct Series {
    bool sought = false, holds = false;
    Index line = 0;            ///< whose angle it is
    VecX mean;                 ///< the constant terms' too
    std::vector<Index> entry;  ///< of the residual; row of the coefficients
    MatX cosine, sine;         ///< [entry, harmonic - 1]
  };
  void find_changing(double t);
  void find_series();
  /// The line whose angle tells those of all lines, -1: there is none.
  Index leading_line() const;
  /// Changing terms hang on the angles alone.
  bool angles_alone() const;
  /// Residual of the changing terms where the leading line stands at `angle` from where it was.
  bool changing_at(Index line, double angle, VecX& out);
  /// Their values at equally spaced angles into the coefficients of the series.
  void transform(const MatX& samples);
  VecX series_at(double angle) const;
  /// Residual of the steady motion at t.
  bool steady_residual(double t, time::Ref r);
  /// The angle of a line at t over that of q0_.
  double turned(Index line, double t) const {
    return (angle_[line] - two_pi * frames.turns[at(line)]) + rate_[at(line)] * t;
  }
  /// at_first_ := C v_ + K q_. A scheme asks at the end of a step and at the start of the next.
  void take_bound_forces();
  /// What is held by a law goes on at the rates of the state.
  bool held_move_freely(const time::FreeMotion& m) const;
  /// Adds what the motion q_, v_, a beside the steady one changes of the loads of joints.
  bool add_joint_loads(double t, time::CRef a, time::Ref r);
  /// W, of what keeps the motion to these equations; nan outside the range of an element.
  double power_beside(time::CRef v, time::CRef residual);

  VecX q0_, v0_;  ///< equilibrium; steady rates
  VecX angle_;    ///< per line: angle of the steady motion at t = 0 over that of q0_, rad, whole
                  ///< turns included
  std::vector<double> rate_;          ///< per line, rad/s
  std::vector<unsigned char> works_;  ///< per unknown: its rate times its residual is power
  std::vector<unsigned char> turns_;  ///< per node: its phi turns
  VecX still_;                        ///< zero: accelerations of the steady motion
  VecX q_, v_, general_;              // scratch
  VecX at_first_, per_second_;        // of residuals along a free motion
  VecX bound_q_, bound_v_;            ///< what at_first_ = C v + K q is of
  Series series_;
  std::vector<std::size_t>
      joined_;  ///< terms at nodes that follow, where their loads are asked for
  VecX steady_q_, steady_v_, plus_, minus_;  // scratch of these
  system::Workspace steady_;
  std::vector<std::size_t>
      changing_;   ///< terms whose force changes along the steady motion; the others:
  VecX constant_;  ///< their residual
};

}  // namespace whirl::analysis
