#include <time/event.hpp>

#include <cmath>

namespace whirl::time {

double EventLocator::value(const Integrator& integrator, double t) {
  integrator.interpolate(t, q_, v_, a_);
  return event_.g(t, q_, v_, a_);
}

bool EventLocator::crosses(double g0, double g1) const {
  // zero at the left end was the event of the interval before; zero at the right end is an event of
  // this one
  const bool rises = g0 < 0.0 && g1 >= 0.0, falls = g0 > 0.0 && g1 <= 0.0;
  return (rises && event_.direction >= 0) || (falls && event_.direction <= 0);
}

void EventLocator::begin(const Integrator& integrator) {
  g_last_ = event_.g(integrator.time(), integrator.q(), integrator.v(), integrator.a());
}

bool EventLocator::find(const Integrator& integrator, const StepReport& step, double& t_event,
                        int samples) {
  const double h = step.t1 - step.t0;
  double t_left = step.t0, g_left = g_last_;
  g_last_ = value(integrator, step.t1);
  for (int k = 1; k <= samples + 1; ++k) {
    const bool last = k == samples + 1;
    const double t = last ? step.t1 : step.t0 + h * k / (samples + 1);
    const double g = last ? g_last_ : value(integrator, t);
    if (!crosses(g_left, g)) {
      t_left = t;
      g_left = g;
      continue;
    }
    // Bracketed search: regula falsi with the Illinois rule, bisection whenever it shrinks the
    // bracket too little.
    double a = t_left, fa = g_left, b = t, fb = g;
    const double width = event_.tolerance * h;
    int side = 0;
    for (int it = 0; it < 200 && b - a > width && fb != 0.0; ++it) {
      const double before = b - a;
      double c = b - fb * (b - a) / (fb - fa);
      if (!(c > a + 0.25 * width && c < b - 0.25 * width))
        c = it % 2 ? 0.5 * (a + b) : (c <= a + 0.25 * width ? a + 0.5 * width : b - 0.5 * width);
      const double fc = value(integrator, c);
      if ((fc < 0.0) == (g_left < 0.0) && fc != 0.0) {
        a = c;
        fa = fc;
        if (side == -1) fb *= 0.5;
        side = -1;
      } else {
        b = c;
        fb = fc;
        if (side == 1) fa *= 0.5;
        side = 1;
      }
      if (b - a > 0.5 * before && it % 3 == 2) {
        c = 0.5 * (a + b);
        const double fm = value(integrator, c);
        if ((fm < 0.0) == (g_left < 0.0) && fm != 0.0) {
          a = c;
          fa = fm;
        } else {
          b = c;
          fb = fm;
        }
        side = 0;
      }
    }
    t_event = b;
    return true;
  }
  return false;
}

}  // namespace whirl::time
