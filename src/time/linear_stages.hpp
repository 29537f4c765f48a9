// A collocation step of a problem with constant matrices, in few passes over its vectors. See
// linear_stages.cpp.
#pragma once
#include <time/affine.hpp>
#include <time/stage_lanes.hpp>
#include <time/tableau.hpp>

#include <span>
#include <vector>

namespace whirl::time {

class LinearStages {
 public:
  /// held: entries that impose() sets.
  LinearStages(const Tableau& tableau, std::span<const Index> held);
  /// Takes the length of the step, s.
  void set_step(double h);
  /// Right-hand sides of the decoupled systems, held entries zero: real (zero where there is no
  /// real eigenvalue) and complex.
  /// @pre set_step(); changing: x of AffineProblem at the stages, a column each.
  void right_hand_sides(const Bound& bound, std::span<const Index> entries, const MatX& changing,
                        VecX& real, VecXc& complex) const;
  /// State at the start of the step with what its rounding left.
  struct Start {
    const VecX &q, &v, &a, &q_low, &v_low;
  };
  struct End {
    MatX& stages;            ///< accelerations, a column a stage
    VecX &q, &v, &a;         ///< at the end
    VecX &q_low, &v_low;     ///< what rounding leaves of q and v
    VecX& last_increment;    ///< of q to the last stage
    StepProducts& products;  ///< gets what is to be multiplied
  };
  /// From the solutions of the decoupled systems. consistent: the accelerations at the start solve
  /// the equations there, and the estimate of the error takes them.
  void finish(const VecX& real, const VecXc& complex, const Start& start, bool consistent,
              const End& end) const;

 private:
  template <class Coefficient>
  lanes::Weights sum_of(const lanes::Weights* x, Coefficient&& c) const;

  const Tableau& tab_;
  std::vector<Index> held_;
  double h_ = 0.0;
  lanes::Sums sums_;
};

}  // namespace whirl::time
