#include <analysis/transient/corners.hpp>

#include <analysis/transient/observer.hpp>

#include <algorithm>
#include <cmath>

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
  const double h = step.t1() - step.t0();
  double before = step.t0();
  for (const double part : looks) {
    const double look = part == 1.0 ? step.t1() : step.t0() + h * part;
    while (moved(step, look)) {
      double lo = before, hi = look;
      while (hi - lo > 1e-12 * h && hi - lo > 4e-16 * std::abs(hi)) {
        const double m = 0.5 * (lo + hi);
        (moved(step, m) ? hi : lo) = m;
      }
      if (lo - step.t0() > at_start * h) return lo;
      // the passage the step before ended at: the rest of this one is looked at from the other side
      moved(step, hi);
      start_ = now_;
      before = hi;
      if (hi >= look) break;
    }
    before = std::max(before, look);
  }
  return -1.0;
}

}  // namespace whirl::analysis
