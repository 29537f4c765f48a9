// Spinning, loaded equilibrium: R(q; Omega) = 0 of steady_rotation.hpp, with gravity sag, preload,
// torque and what internal damping and films add at speed. Newton with the exact tangent, in whole
// steps; when that fails, with a natural monotonicity line search (P. Deuflhard, Newton Methods for
// Nonlinear Problems, 2004, ch. 3); when that fails too, the loads are put on in steps.
//
// A rotor that is free to turn needs one more condition a rotor: the axial angle of its first node
// is held, and the torque that keeps it at its speed comes out as a reaction. Geared lines that
// turn together count as one rotor; gears with backlash, which do not touch at first, are turned by
// the torque on them until their flanks meet.
#pragma once
#include <analysis/steady_rotation.hpp>
#include <la/direct.hpp>
#include <memory>
#include <optional>
#include <string>

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
  std::vector<Index> spin_holds;  ///< unknowns phi held because nothing else does; reactions[.] =
                                  ///< torque that keeps the speed
  int iterations = 0, load_steps = 1;
};

class EquilibriumSolver {
 public:
  EquilibriumSolver(SteadySystem& running, EquilibriumOptions options = {});

  /// From `start` (null: the reference configuration).
  /// @throws Error E75 nothing resists a motion (node and direction named), or the structure is at
  /// a limit point; E76 no equilibrium found (load factor reached).
  Equilibrium solve(double Omega, const system::State* start = nullptr);
  /// As a status: nullopt when there is none, why() tells.
  std::optional<Equilibrium> try_solve(double Omega, const system::State* start = nullptr);
  const std::string& why() const { return why_; }

  SteadySystem& running() { return running_; }
  std::span<const unsigned char> free() const { return free_; }
  const std::vector<Index>& spin_holds() const { return spin_holds_; }
  const la::MCK& matrices() const { return matrices_; }
  /// Size of the model, m: what displacements are compared with.
  double length() const { return length_; }
  /// Moves the reference axes of lines that tilt beyond rotation::chart_switch; whether one moved.
  bool change_charts(system::State& s) const;

 private:
  enum class Outcome { converged, singular, diverged };
  void find_spin_holds(const system::State& s, double Omega);
  /// All phi of the lines that turn with line `group`, by their ratio.
  VecX spin_of(Index group) const;
  /// A rotor held at its angle against a torque, with play towards another one (backlash): turned
  /// on by its torque until they meet, which then holds it. s: in balance, r_ its residual; both
  /// are so again afterwards.
  void close_backlash(double Omega, system::State& s, int& iterations);
  enum class Step { bold, careful };
  Outcome newton(double Omega, system::State& s, int& iterations);
  Outcome newton(double Omega, system::State& s, int& iterations, Step kind);
  std::string name_motion(Index singular) const;
  /// Where supports have gaps nothing resists at first: each line is moved along the force on it
  /// until something does.
  Outcome close_gaps(double Omega, system::State& s, int& iterations);
  /// The same for what that does not close: couples, mechanisms, gaps one after another.
  Outcome let_down(double Omega, system::State& s, int& iterations);
  double correction_size(const VecX& d) const;
  bool is_small(const VecX& d, const VecX& q) const;

  SteadySystem& running_;
  EquilibriumOptions options_;
  bool holds_known_ = false;
  double length_ = 1;  ///< size of the model, m
  std::vector<unsigned char> free_;
  std::vector<Index> spin_holds_;
  std::vector<Index> group_;  ///< of each line: the first of those it turns with
  std::unique_ptr<la::DirectSolver<double>> solver_;
  la::MCK matrices_;
  VecX r_, step_, trial_, next_;
  std::string why_;
};

}  // namespace whirl::analysis
