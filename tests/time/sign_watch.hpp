// Watches the steps of an integrator for sign changes of a function of the motion.
#pragma once
#include <time/event.hpp>
#include <time/integrator.hpp>
#include <functional>

namespace whirl::time::test {

class SignWatch {
 public:
  /// direction: +1 rising only, -1 falling only, 0 both.
  SignWatch(Index size, std::function<double(CRef q, CRef v)> g, int direction)
      : g_(std::move(g)),
        direction_(direction),
        q_(size),
        v_(size),
        a_(size) {}

  /// After start() and after every restart().
  void begin(const Integrator& integrator) { last_ = g_(integrator.q(), integrator.v()); }

  /// First event of the last step.
  bool find(const Integrator& integrator, const StepReport& step, double& t_event) {
    static constexpr EventLocator locator(quarters, {1e-13, 1e-14});
    bool found = false;
    locator.sign_changes(
        step.t0, step.t1, last_, [&](double t) { return value(integrator, t); },
        [&](const Passage& passage, bool rising) {
          found = direction_ == 0 || rising == (direction_ > 0);
          t_event = passage.after;
          return !found;
        });
    return found;
  }

 private:
  double value(const Integrator& integrator, double t) {
    integrator.interpolate(t, q_, v_, a_);
    return g_(q_, v_);
  }
  std::function<double(CRef, CRef)> g_;
  int direction_;
  VecX q_, v_, a_;
  double last_ = 0.0;
};

}  // namespace whirl::time::test
