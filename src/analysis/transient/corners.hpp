// Corners of forces (a gap closes, a stop is left) inside steps: where they are, so that a step can
// end there. A step that straddles a hard impact gives the rebound an energy nobody ordered; error
// control sees only what it does to the step itself.
#pragma once
#include <system/problem.hpp>
#include <vector>

namespace whirl::analysis {

class StepAccess;

class Corners {
 public:
  explicit Corners(system::SystemProblem& problem) : problem_(problem) {}
  bool any() const { return problem_.system().cornered(); }
  /// Takes the pieces at the present state of the nodes as those the next step starts on.
  void begin() { problem_.system().list_regions(problem_.workspace(), start_); }
  /// Last time in the step before an element passes to another piece than it stands on at the
  /// start, or -1. The near side: there the step is smooth to its end, and Newton's iteration sees
  /// nothing of the stiffness to come. Looks at quarters and stages: an even number of passages
  /// between two of them is missed.
  double find(StepAccess& step);

 private:
  bool moved(StepAccess& step, double t);
  system::SystemProblem& problem_;
  std::vector<int> start_, now_;
};

}  // namespace whirl::analysis
