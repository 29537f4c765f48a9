// Accelerations that satisfy the equations at a given (q, v), and velocity jumps of impulsive
// starts.
#pragma once
#include <time/integrator.hpp>

namespace whirl::time {

/// Rows of M that are zero belong to massless unknowns: where C acts, v is solved for instead of a;
/// where only K acts, q.
class InitialSolver {
 public:
  void resize(Problem& problem);
  /// Finds which unknowns are massless from the matrices kept in the problem.
  void classify(const Problem& problem);
  /// Newton on R(t, q, v, a) = 0 with (q, v) given: a on return; v or q of massless unknowns.
  /// linearize() is called; factors are left over. Returns the reason of failure, or ok.
  StepStatus solve(Problem& problem, double t, VecX& q, VecX& v, VecX& a, Statistics& statistics);
  /// Held velocities jumped by dv_held (zero elsewhere): M dv = 0 in the free rows, the velocity
  /// jump of a rigid impulsive drive. Adds it to v. Uses the kept matrices.
  StepStatus impulse(Problem& problem, const VecX& dv_held, VecX& v, Statistics& statistics);
  /// 1 for unknowns with inertia, 0 for massless and held ones.
  const VecX& dynamic() const { return dynamic_; }

  void save(std::vector<double>& out) const;
  const double* restore(const double* in);

 private:
  enum class Row : unsigned char { dynamic, first_order, algebraic };
  bool factor(Problem& problem, double tau, Statistics& statistics) const;
  /// Newton with the factors of a step of length tau; `newton`: it does not converge.
  StepStatus iterate(Problem& problem, double t, double tau, VecX& q, VecX& v, VecX& a,
                     Statistics& statistics);
  /// Takes the correction r_; returns its size. of_a: a, which may be zero, counts.
  double take_correction(double tau, bool of_a, VecX& q, VecX& v, VecX& a);
  /// Massless unknowns that stand still: the last correction of their rates, r_, changes nothing of
  /// them in a second, and would be size over size for ever.
  bool stand_still(double tau, const VecX& q) const;
  std::vector<Row> row_;
  std::vector<Index> held_;
  double largest_massless_ = 0;  ///< rate or value of a massless unknown in this iteration
  bool any_massless_ = false;
  VecX r_, probe_, dynamic_, q_start_, v_start_, a_start_;
};

}  // namespace whirl::time
