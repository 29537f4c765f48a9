#include <analysis/transient/corners.hpp>

#include <analysis/transient/observer.hpp>
#include <time/event.hpp>

namespace whirl::analysis {

namespace {
// quarters, and the stages of Radau IIA 5, Gauss 4 and Gauss 6: a force that acts at a stage is
// seen there
constexpr double looks[] = {0.1127016653792583, 0.1550510257216822, 0.2113248654051871, 0.25, 0.5,
                            0.6449489742783178, 0.7886751345948129, 0.8872983346207417, 1.0};
constexpr double at_start = 1e-6;  ///< of a step: what passes there passed at its start
}  // namespace

bool Corners::moved(StepAccess& step, double t) {
  step.at(t);  // evaluates the nodes
  problem_.system().list_regions(problem_.workspace(), now_);
  return now_ != start_;
}

double Corners::find(StepAccess& step) {
  static constexpr time::EventLocator locator(looks, {1e-12, 4e-16});
  const double h = step.t1() - step.t0();
  double first = -1.0;
  locator.search(
      step.t0(), step.t1(), [&](double t) { return moved(step, t); },
      [&](const time::Passage& passage) {
        if (passage.before - step.t0() > at_start * h) {
          first = passage.before;
          return false;
        }
        // the passage the step before ended at: the rest of this one is looked at from the other
        // side
        moved(step, passage.after);
        start_ = now_;
        return true;
      });
  return first;
}

}  // namespace whirl::analysis
