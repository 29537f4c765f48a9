// [[step]]: the analyses.
#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <fmt/format.h>

namespace whirl::deck {

void describe(Visitor& v, model::SpeedRange& r) {
  static constexpr Option refine[] = {{"no", "the points alone"}, {"peaks", "more points where the response peaks"}};
  int i = 0;
  v.quantity(optional("start", "\"0 rpm\""), r.start, "rpm", any, "first speed");
  const bool stop = v.quantity(optional("stop", "values are given"), r.stop, "rpm", any, "last speed");
  const bool points = v.integer(optional("points", "values are given"), r.points, between(1, 1000000), "number of speeds, equally spaced");
  const bool values = v.quantities(optional("values", "start, stop, points"), r.values, "rpm", any, -1, "the speeds one by one");
  v.option("refine", i, refine, "refinement");
  r.refine_peaks = i == 1;
  if (!v.clean()) return;
  if (values && (stop || points || v.given("start"))) v.error("E26", "values", "the speeds are given by 'values' and by 'start', 'stop', 'points'", "keep one of the two");
  else if (!values && (!stop || !points)) v.error("E05", nullptr, fmt::format("the speeds lack '{}'", stop ? "points" : "stop"), "speed = { start = \"0 rpm\", stop = \"14000 rpm\", points = 71 }");
  else if (values && r.values.empty()) v.error("E20", "values", "at least one speed is needed");
  else if (!values && r.points > 1 && !(r.stop > r.start))
    v.error("E21", "stop", fmt::format("the range ends at {}, not above its start at {}", units::display(r.stop, "rpm"), units::display(r.start, "rpm")));
  for (std::size_t k = 1; v.clean() && k < r.values.size(); ++k)
    if (!(r.values[k] > r.values[k - 1])) v.error("E21", "values", fmt::format("the speeds do not increase: {} after {}", units::display(r.values[k], "rpm"), units::display(r.values[k - 1], "rpm")));
}

void describe(Visitor& v, model::IntegratorOptions& o) {
  static constexpr Option methods[] = {
      {"radau5", "adaptive Radau IIA of order 5: the default"},
      {"generalized_alpha", "second order, cheap per step"},
      {"gauss4", "Gauss of order 4: keeps energy, for long lightly damped runs"},
      {"gauss6", "Gauss of order 6"},
      {"ida", "SUNDIALS IDA, an independent cross-check"},
      {"momentum_rk", "the momentum form by explicit Runge-Kutta, for one rigid body"},
  };
  int i = 0;
  for (std::size_t k = 0; k < std::size(methods); ++k)
    if (o.method == methods[k].name) i = static_cast<int>(k);
  v.option("method", i, methods, "integration scheme");
  o.method = methods[i].name;
  v.number("tolerance", o.tolerance, Range{0, 1, true, true}, "accuracy wanted, relative to the peak response of each kind of quantity");
  v.number("rho_inf", o.rho_inf, fraction, "spectral radius at infinite frequency, of generalized_alpha");
  const bool fixed = v.quantity(optional("dt", "adaptive"), o.dt, "ms", positive, "fixed time step");
  const bool max = v.quantity(optional("dt_max", "no limit"), o.dt_max, "ms", positive, "largest adaptive step");
  const bool min = v.quantity(optional("dt_min", "no limit"), o.dt_min, "ms", positive, "smallest adaptive step");
  const bool first = v.quantity(optional("dt_first", "chosen"), o.dt_first, "ms", positive, "first adaptive step");
  if (v.clean() && fixed && (max || min || first)) v.error("E26", max ? "dt_max" : min ? "dt_min" : "dt_first", "'dt' fixes the step, so there is nothing to adapt", "leave one of them out");
  if (v.clean() && max && min && o.dt_min > o.dt_max) v.error("E26", "dt_min", "'dt_min' is larger than 'dt_max'");
}

namespace {

constexpr const char* orders_doc = "excitation orders: multiples of the speed";

void check_orders(Visitor& v, const std::vector<double>& orders) {
  if (v.clean() && orders.empty()) v.error("E20", "orders", "at least one order is needed");
}

}  // namespace

void describe(Visitor& v, model::StaticStep& s) {
  v.integer("load_steps", s.load_steps, between(1, 100000), "number of parts in which the loads are applied");
  v.quantity("speed", s.speed, "rpm", any, "speed at which speed-dependent bearings are taken");
}

void describe(Visitor& v, model::ModalStep& s) {
  v.quantity("speed", s.speed, "rpm", any, "speed of the rotor");
  v.integer("modes", s.modes, between(1, 10000), "number of modes, from the lowest frequency");
}

void describe(Visitor& v, model::CampbellStep& s) {
  v.table(required("speed"), s.speed, "the speeds");
  v.integer("modes", s.modes, between(1, 10000), "number of modes followed");
  v.quantities("orders", s.orders, "", positive, -1, orders_doc);
  check_orders(v, s.orders);
}

void describe(Visitor& v, model::CriticalStep& s) {
  v.quantity(required("max_speed"), s.max_speed, "rpm", positive, "critical speeds up to this one");
  v.quantities("orders", s.orders, "", positive, -1, orders_doc);
  v.integer("modes", s.modes, between(1, 10000), "number of modes looked at");
  check_orders(v, s.orders);
}

void describe(Visitor& v, model::UnbalanceStep& s) { v.table(required("speed"), s.speed, "the speeds"); }

void describe(Visitor& v, model::TransientStep& s) {
  v.quantity(required("duration"), s.duration, "s", positive, "length of the run; it begins at time 0, or where the step named by 'from' ended");
  v.choice("start", s.start, {{"rest", "straight and unstressed, loads applied at once"}, {"static", "in static equilibrium"}}, "state at the start, unless 'from' names a transient step");
  v.quantity("initial_speed", s.speed0, "rpm", any, "spin at the start of every rotating line (times its speed_ratio)");
  v.quantity(optional("stop_speed", "never"), s.stop_speed, "rpm", any, "the run ends when the reference spin passes this value");
  v.quantity(optional("amplitude_limit", "none"), s.amplitude_limit, "mm", positive, "the run ends when a probe exceeds this displacement");
  v.quantity("checkpoint", s.checkpoint, "s", not_negative, "wall-clock time between checkpoints, from which --resume continues; 0 s: none");
  v.table("integrator", s.integrator, "time integration");
}

void describe(Visitor& v, model::Step& s) {
  v.name(s, "step");
  v.step(optional("from", "the undeformed model"), s.from, "an earlier static or transient step whose result this one starts from");
  const Alternative kinds[] = {
      Visitor::alternative<model::StaticStep>("static", s.law, "static equilibrium under gravity, loads and preloads"),
      Visitor::alternative<model::ModalStep>("modal", s.law, "whirl modes at one speed"),
      Visitor::alternative<model::CampbellStep>("campbell", s.law, "whirl frequencies and damping against speed"),
      Visitor::alternative<model::CriticalStep>("critical_speeds", s.law, "critical speeds, solved for directly"),
      Visitor::alternative<model::UnbalanceStep>("unbalance_response", s.law, "steady response to the unbalances against speed"),
      Visitor::alternative<model::TransientStep>("transient", s.law, "motion in time, nonlinear"),
  };
  v.alternatives(required("type"), kinds, "kind of analysis");
}

}  // namespace whirl::deck
