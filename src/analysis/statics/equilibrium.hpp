// Spinning, loaded equilibrium: R(q; Omega) = 0 of steady_rotation.hpp, with gravity sag, preload,
// torque and what internal damping and films add at speed. Newton with the exact tangent, in whole
// steps; when that fails, with a natural monotonicity line search (P. Deuflhard, Newton Methods for
// Nonlinear Problems, 2004, ch. 3); when that fails too, the loads are put on in steps, and
// at last what damps is left to bring the model there (equilibrium_drift.cpp).
//
// A rotor that is free to turn needs one more condition a rotor: the axial angle of its first node
// is held, and the torque that keeps it at its speed comes out as a reaction. Geared lines that
// turn together count as one rotor; gears with backlash, which do not touch at first, are turned by
// the torque on them until their flanks meet. So too for a line that nothing resists along its axis
// (SteadyRotation::axially_free): its first node is held there.
#pragma once
#include <analysis/steady_rotation.hpp>
#include <core/error.hpp>
#include <la/direct.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace whirl::analysis {

struct EquilibriumOptions {
  double tolerance = 1e-10;  ///< relative size of the last correction (it converges quadratically:
                             ///< the error is far below)
  int max_iterations = 40;   ///< a load step
  int load_steps =
      1;  ///< parts in which the loads are put on; more when an equilibrium is not found otherwise
  int max_load_steps = 400;
  bool chart_change = true;  ///< move reference axes of lines that tilt beyond
                             ///< rotation::chart_switch (between load steps)
  la::SolverKind solver = la::SolverKind::automatic;
};

struct Equilibrium {
  system::State state;  ///< q; v = the steady rates; a = 0
  double Omega = 0;     ///< rad/s
  VecX reactions;       ///< at held unknowns, N and N m, exerted by the support on the model; zero
                        ///< elsewhere
  std::vector<Index> spin_holds;   ///< unknowns phi held because nothing else does; reactions[.] =
                                   ///< torque that keeps the speed
  std::vector<Index> axial_holds;  ///< unknowns u_x held so too
  /// Both.
  std::vector<Index> holds() const;
  int iterations = 0, load_steps = 1;
  bool drifted =
      false;  ///< reached as a motion without inertia: Newton's method found none that attracts
  double kept_error =
      0;  ///< what elements keep (system::Frames::kept) still changes by, the largest
};

/// At this speed, rad/s, none was found.
class NoEquilibrium : public Error {
 public:
  NoEquilibrium(Error e, double speed) : Error(std::move(e)), Omega(speed) {}
  double Omega;
};

class EquilibriumSolver {
 public:
  EquilibriumSolver(SteadySystem& running, EquilibriumOptions options = {});

  /// From `start` (null: the reference configuration); where films are hot and none is found from there,
  /// from the reference configuration.
  /// @throws Error E75 nothing resists a motion (node and direction named), or the structure is at
  /// a limit point; NoEquilibrium E76 (load factor reached).
  Equilibrium solve(double Omega, const system::State* start = nullptr);
  /// As a status: nullopt when there is none, why() tells.
  std::optional<Equilibrium> try_solve(double Omega, const system::State* start = nullptr);
  const std::string& why() const { return why_; }

  SteadySystem& running() { return running_; }
  std::span<const unsigned char> free() const { return free_; }
  const std::vector<Index>& spin_holds() const { return spin_holds_; }
  /// Looks at `state` for what is held because nothing else does, and puts it into e: for a state that
  /// needs no balance.
  void list_holds(const system::State& state, Equilibrium& e);
  const la::MCK& matrices() const { return matrices_; }
  /// Size of the model, m: what displacements are compared with.
  double length() const { return length_; }
  /// Moves the reference axes of lines that tilt beyond rotation::chart_switch; whether one moved.
  bool change_charts(system::State& s) const;

 private:
  enum class Outcome { converged, singular, diverged };
  /// Of each line, the motion in which it turns.
  struct SpinMotions;
  /// matrices_, when they are first wanted: copies that are given their equilibria need none.
  void make_matrices();
  void find_axial_holds();
  void find_spin_holds(const system::State& s, double Omega);
  void find_holds_once(const system::State& s, double Omega);
  /// @pre matrices_ are those of the state.
  SpinMotions spin_motions() const;
  /// The unknown phi to hold of a group of lines that nothing resists or holds, else -1.
  Index freely_turning(const SpinMotions& m, Index group) const;
  /// All phi of the lines that turn with line `group`, by their ratio.
  VecX spin_of(Index group) const;
  /// A rotor held at its angle against a torque, with play towards another one (backlash): turned
  /// on by its torque until they meet, which then holds it. s: in balance, r_ its residual; both
  /// are so again afterwards.
  void close_backlash(double Omega, system::State& s, int& iterations);
  /// Turns the rotor of the hold until it meets another one, whose group is returned; -1 when it
  /// meets none or no balance is found then (s is anything, and the hold stays).
  Index turn_until_met(Index held, double Omega, system::State& s, int& iterations);
  /// A group of lines on which the motion e of another one acts in the tangent at hand, or -1.
  Index group_met(const VecX& e, Index group) const;
  /// relaxed: carefully, with what elements balance themselves in balance at every trial.
  enum class Step { bold, careful, relaxed };
  Outcome newton(double Omega, system::State& s, int& iterations);
  Outcome newton(double Omega, system::State& s, int& iterations, Step kind);
  /// The motion C q' = -R without inertia, in implicit steps that lengthen as the forces come into balance:
  /// films bring a journal and its pads to an equilibrium that attracts, whatever bends the way there.
  Outcome drift(double Omega, system::State& s, int& iterations);
  /// drift() from a state, then, where the state in out is an equilibrium (found), from beside that one; into
  /// out, when it ends in an equilibrium that attracts (else out is as it was).
  bool drift_from(const system::State& begin, double Omega, bool found, Equilibrium& out);
  /// No small displacement drives the state further away, as far as that can be told.
  bool attracts(double Omega, const system::State& s);
  /// Newton's method from here ends where steps of this size still lead; else s is as before.
  bool ends_near(double Omega, system::State& s, double size, int& iterations);
  void clear_held(VecX& x) const;
  /// Takes the last correction as it is; whether forces balance then.
  bool settle(double Omega, system::State& s);
  /// Whole steps, no turn of more than half a radian and no move of more than half the model: what
  /// slender structures in large rotation want, whose axial force rises before it falls. The part
  /// of the correction taken (trial_, r_), or 0; so too of the next one.
  double step_boldly(double Omega, const system::State& s, double size);
  /// Natural monotonicity: the simplified Newton correction after the step must be shorter than the
  /// correction itself. most: the part tried first.
  double step_carefully(double Omega, const system::State& s, double size, double most, Step kind);
  std::string no_convergence() const;
  /// As solve(), from there alone.
  Equilibrium solve_from(double Omega, const system::State* start);
  /// Settles what elements keep, and the equilibrium with it.
  /// @throws NoEquilibrium when they do not settle.
  void balance_kept(double Omega, Equilibrium& out);
  /// Loads in steps from the unloaded state at time t, doubled after an easy step, halved after a
  /// failure.
  bool load_in_steps(double Omega, double t, Equilibrium& out);
  std::string name_motion(Index singular) const;
  /// Which translations along x, y, z, and of one line which turning, K does not resist, in words;
  /// part: lines that move together.
  std::string free_motions(std::span<const Index> part) const;
  /// Lines that joints connect, where there are two and more.
  std::vector<std::vector<Index>> jointed_parts() const;
  /// K as it stands resists the motion e of the free unknowns.
  bool resists(const VecX& e) const;
  /// Where supports have gaps nothing resists at first: each line is moved along the force on it
  /// until something does.
  Outcome close_gaps(double Omega, system::State& s, int& iterations);
  /// The same for what that does not close: couples, mechanisms, gaps one after another.
  Outcome let_down(double Omega, system::State& s, int& iterations);
  struct LetDown;
  double correction_size(const VecX& d) const;
  bool is_small(const VecX& d, const VecX& q) const;

  SteadySystem& running_;
  EquilibriumOptions options_;
  bool holds_known_ = false;
  double length_ = 1;  ///< size of the model, m
  std::vector<unsigned char> free_;
  std::vector<Index> spin_holds_, axial_holds_;
  std::vector<Index> group_;  ///< of each line: the first of those it turns with
  std::unique_ptr<la::DirectSolver<double>> solver_;
  la::MCK matrices_;
  VecX r_, step_, trial_, next_;
  std::string why_;
};

}  // namespace whirl::analysis
