// Small motions about the spinning, loaded equilibrium: M, C(Omega), K(Omega) on the system's block
// pattern, in q = (u, phi, gamma) a node, fixed axes:
//   M x'' + C x' + K x = -sum_k Re(f_k exp(i order_k Omega t))
// C holds damping and gyroscopic effects, K all stiffness, geometric and circulatory ones included;
// both are exact derivatives of the nonlinear model, averaged over the revolution where something
// turns (steady_rotation.hpp).
#pragma once
#include <analysis/statics/equilibrium.hpp>
#include <analysis/spectra/motion.hpp>

#include <array>

namespace whirl::analysis {

class Linearizer {
 public:
  explicit Linearizer(const system::System& system, SteadyRotation running = {},
                      EquilibriumOptions options = {});
  /// Of the same system and in the same state, with a workspace of its own: for another thread.
  Linearizer(const Linearizer& other);
  Linearizer& operator=(const Linearizer&) = delete;

  /// Moves the equilibrium to Omega (rad/s, from the last one) and returns the matrices there;
  /// valid until the next call. What does not answer differently to another lambda is not evaluated
  /// again: supports and dampings that know no frequency cost one evaluation a speed.
  /// @throws Error as EquilibriumSolver::solve.
  const la::MCK& at(double Omega) { return at(Omega, Complex(0, nan)); }
  /// The same as a motion x exp(lambda t) meets them, lambda = g + i w: supports that answer by
  /// frequency (SteadyRotation::table_frequencies) and hysteretic damping give real matrices that
  /// are exact for it alone. w NaN: synchronous values of tables, hysteretic damping of the steady
  /// state only; infinite: synchronous values, no hysteretic damping. The equilibrium is the same
  /// at every lambda. side: frequency that decides whether the whirl is faster than the spin; w
  /// unless given.
  /// @throws Error E81, a table does not cover w.
  const la::MCK& at(double Omega, Complex lambda, double side = nan) {
    return at(Omega, lambda, side, lambda.imag());
  }
  const la::MCK& at(double Omega, double) = delete;  // a real lambda is rarely meant
  /// tables: the frequency that supports answer to, where it is not Im lambda.
  const la::MCK& at(double Omega, Complex lambda, double side, double tables);
  /// Tables at the frequency w, no hysteretic damping beside that of the steady state.
  const la::MCK& at_frequency(double Omega, double w) {
    return at(Omega, Complex(0, infinity), nan, w);
  }
  /// The equilibrium alone: without the matrices, which take a tangent at every angle where something
  /// turns with the rotor.
  /// @throws Error as at().
  void move_to(double Omega);
  /// The part of them that keeps energy: M, skew part of C (gyroscopic), symmetric part of K. For
  /// "undamped" results.
  const la::MCK& conservative_at(double Omega, double w = nan);
  double Omega() const { return equilibrium_.Omega; }
  const Equilibrium& equilibrium() const { return equilibrium_; }
  /// Takes an equilibrium as found elsewhere.
  /// @pre a state of this system.
  void set_equilibrium(const Equilibrium& e);
  /// The first equilibrium is sought from this state instead of the reference configuration.
  void start_from(const system::State& s) { first_ = s; }
  /// From now on everything is about the reference configuration, turning, without gravity and
  /// loads. Held unknowns stand at their laws; supports answer as they do there. What heat and
  /// preload leave of axial forces is in balance along x: a shaft that is free to grow has none.
  void stay_undeformed();
  /// Forcing amplitudes at the last speed, one for each of running().orders().
  /// @pre after at().
  const std::vector<VecXc>& forcing();
  SteadySystem& running() { return running_; }
  bool hysteretic() const { return running_.hysteretic(); }
  const system::System& system() const { return running_.system(); }
  /// +1 or -1: sense of the spin that whirl at a node is measured against, at the last speed; at
  /// rest that of a positive one.
  double sense(Index node) const { return (Omega() < 0 ? -1.0 : 1.0) * running_.sense(node); }
  /// Unknowns of small motions: what is not held by a support. A free rotor may turn.
  std::span<const unsigned char> active() const { return running_.system().active(); }

 private:
  bool still_balanced(double Omega);
  void take_undeformed(double Omega);
  /// Balances the axial forces of the undeformed state.
  /// @throws Error E75 when nothing resists a motion along x that is loaded, E76 without a balance.
  void relax_axially();
  SteadySystem running_;
  EquilibriumOptions options_;
  EquilibriumSolver solver_;
  Equilibrium equilibrium_;
  std::optional<system::State> first_;
  bool have_ = false, have_forcing_ = false, undeformed_ = false;
  double balanced_load_ = 1;  ///< factor on loads at which equilibrium_ was found
  /// What matrices_ were made for: speed, load, rate of hysteretic damping (growth, frequency,
  /// side), frequency of tables.
  using Asked = std::array<double, 6>;
  Asked asked(double Omega, Complex lambda, double side, double tables) const;
  bool current_ = false;  ///< matrices_ are those of made_for_ about equilibrium_
  Asked made_for_{};
  Vec2 floor_ = Vec2::Zero();  ///< residual left at the last solution: force, moment
  la::MCK matrices_, conservative_;
  std::vector<VecXc> forcing_;
  VecX r_;
};

/// M, (C - C^T)/2, (K + K^T)/2.
/// @pre out stands on the pattern of m and is another object.
void take_conservative_part(const la::MCK& m, la::MCK& out);

}  // namespace whirl::analysis
