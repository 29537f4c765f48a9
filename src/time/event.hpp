// Events: sign changes of g(t, q, v) inside the last step, found on its dense output.
#pragma once
#include <time/integrator.hpp>
#include <functional>

namespace whirl::time {

struct EventFunction {
  std::function<double(double t, CRef q, CRef v, CRef a)> g;
  int direction = 0;         ///< +1: only rising through zero, -1: only falling, 0: both
  double tolerance = 1e-10;  ///< bracket width relative to the step at which the search ends
};

/// Looks for events step by step; keeps its own workspace.
class EventLocator {
 public:
  EventLocator(Index size, EventFunction event)
      : event_(std::move(event)),
        q_(size),
        v_(size),
        a_(size) {}
  /// Evaluates g at the integrator's present state: call once after start() and after every
  /// restart().
  void begin(const Integrator& integrator);
  /// Earliest event in (t0, t1] of the last step. The step is scanned at `samples` interior points
  /// as well as its ends (an even number of crossings between neighbours is missed), then
  /// bracketed; the time returned lies on the far side of the crossing. An event exactly at t0 was
  /// reported by the step before.
  bool find(const Integrator& integrator, const StepReport& step, double& t_event, int samples = 3);

 private:
  double value(const Integrator& integrator, double t);
  bool crosses(double g0, double g1) const;
  EventFunction event_;
  VecX q_, v_, a_;
  double g_last_ = 0.0;
};

}  // namespace whirl::time
