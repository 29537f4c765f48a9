// [[step]]: the analyses.
#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <fmt/format.h>

#include <cstdlib>

namespace whirl::deck {

void describe(Visitor& v, model::SpeedRange& r) {
  v.quantity(optional("start", "\"0 rpm\""), r.start, "rpm", any, "first speed");
  const bool stop =
      v.quantity(optional("stop", "values are given"), r.stop, "rpm", any, "last speed");
  const bool points = v.integer(optional("points", "values are given"), r.points,
                                between(1, 1000000), "number of speeds, equally spaced");
  const bool values = v.quantities(optional("values", "start, stop, points"), r.values, "rpm", any,
                                   -1, "the speeds one by one");
  if (!v.clean()) return;
  if (values && (stop || points || v.given("start")))
    v.error("E26", "values", "the speeds are given by 'values' and by 'start', 'stop', 'points'",
            "keep one of the two");
  else if (!values && (!stop || !points))
    v.error("E05", nullptr, fmt::format("the speeds lack '{}'", stop ? "points" : "stop"),
            "speed = { start = \"0 rpm\", stop = \"14000 rpm\", points = 71 }");
  else if (values && r.values.empty())
    v.error("E20", "values", "at least one speed is needed");
  else if (!values && r.points > 1 && !(r.stop > r.start))
    v.error("E21", "stop",
            fmt::format("the range ends at {}, not above its start at {}",
                        units::display(r.stop, "rpm"), units::display(r.start, "rpm")));
  for (std::size_t k = 1; v.clean() && k < r.values.size(); ++k)
    if (!(r.values[k] > r.values[k - 1]))
      v.error(
          "E21", "values",
          fmt::format("the speeds do not increase: {} after {}", units::display(r.values[k], "rpm"),
                      units::display(r.values[k - 1], "rpm")));
}

void describe(Visitor& v, model::ResponseSpeeds& r) {
  static constexpr Option refine[] = {
      {"peaks",
       "more points where the response peaks (default of a range, not of speeds one by one)"},
      {"no", "the points alone"}};
  describe(v, static_cast<model::SpeedRange&>(r));
  int i = v.given("values") ? 1 : 0;
  v.option("refine", i, refine, "refinement");
  r.refine_peaks = i == 0;
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
  v.number("tolerance", o.tolerance, between(1e-13, 0.1),
           "accuracy wanted, relative to the peak response of each kind of quantity; in films, to "
           "the clearance where that is less");
  v.number("rho_inf", o.rho_inf, fraction,
           "spectral radius at infinite frequency, of generalized_alpha");
  if (v.clean() && o.rho_inf != model::IntegratorOptions{}.rho_inf &&
      o.method != "generalized_alpha")
    v.error("E26", "rho_inf",
            fmt::format("'rho_inf' is of generalized_alpha, the method is {}", o.method),
            "leave it out, or method = \"generalized_alpha\"");
  const bool fixed =
      v.quantity(optional("dt", "adaptive"), o.dt, "ms", positive, "fixed time step");
  const bool max =
      v.quantity(optional("dt_max", "no limit"), o.dt_max, "ms", positive, "largest adaptive step");
  const bool min =
      v.quantity(optional("dt_min", "no limit"), o.dt_min, "ms", positive,
                 "smallest adaptive step, but for those that end at an instant: a corner of a "
                 "law or contact, an end, a stop");
  const bool first =
      v.quantity(optional("dt_first", "chosen"), o.dt_first, "ms", positive, "first adaptive step");
  if (v.clean() && fixed && (max || min || first))
    v.error("E26",
            max   ? "dt_max"
            : min ? "dt_min"
                  : "dt_first",
            "'dt' fixes the step, so there is nothing to adapt", "leave one of them out");
  if (v.clean() && max && min && o.dt_min > o.dt_max)
    v.error("E26", "dt_min", "'dt_min' is larger than 'dt_max'");
  if (v.clean() && max && first && o.dt_first > o.dt_max)
    v.error("E26", "dt_first", "'dt_first' is larger than 'dt_max'");
  if (v.clean() && min && first && o.dt_first < o.dt_min)
    v.error("E26", "dt_first", "'dt_first' is smaller than 'dt_min'");
}

namespace {

void describe_orders(Visitor& v, std::vector<double>& orders) {
  const bool given = v.quantities(optional("orders", "once a turn of every shaft"), orders, "",
                                  positive, -1, "excitation orders: multiples of the speed");
  if (v.clean() && given && orders.empty())
    v.error("E20", "orders", "at least one order is needed");
}

}  // namespace

void describe(Visitor& v, model::LoadPath& p) {
  v.choice("control", p.control,
           {{"arc_length", "steps along the path, in load and displacements together"},
            {"displacement", "equal steps of one displacement or angle"}},
           "what is stepped");
  const bool load =
      v.number(optional("load", "1, with arc_length"), p.last_load, any,
               "arc_length: load factor at which the path ends (1 = the loads of the deck)");
  const bool at = v.location(optional("at", "control = \"arc_length\""), p.at,
                             "displacement: where the controlled displacement is");
  const bool which = v.choice(
      optional("direction", "y"), p.direction,
      {{"x", "along the shaft"}, {"y", "along y"}, {"z", "along z"}, {"rx", "turn about the axis"}},
      "displacement: which one");
  const bool along = v.quantity(optional("to", "control = \"arc_length\", or an angle"), p.to, "mm",
                                any, "displacement: its last value");
  const bool turn =
      v.quantity(optional("to_angle", "control = \"arc_length\", or a displacement"), p.to, "deg",
                 any, "displacement with direction = \"rx\": its last value");
  v.integer("steps", p.steps, between(1, 100000),
            "displacement: number of steps; arc_length: about as many for a straight path");
  v.integer("max_points", p.max_points, between(2, 1000000), "the path ends here at the latest");
  const bool branch =
      v.integer(optional("branch", "the primary path"), p.branch, between(-100, 100),
                "arc_length: follow what branches off at the bifurcation of this number on the "
                "path (1 the first), negative: to its other side");
  if (!v.clean()) return;
  const bool control = p.control == model::LoadPath::Control::displacement;
  const auto odd = [&](const char* key, const char* other) {
    v.error("E26", key, fmt::format("'{}' belongs to control = \"{}\"", key, other));
  };
  if (control && load) odd("load", "arc_length");
  if (control && branch) return odd("branch", "arc_length");
  if (branch && p.branch == 0)
    return v.error("E14", "branch", "bifurcations are numbered from 1",
                   "branch = 1, or branch = -1 for the other side");
  if (!control)
    for (const auto& [given, key] :
         {std::pair{at, "at"}, {which, "direction"}, {along, "to"}, {turn, "to_angle"}})
      if (given) return odd(key, "displacement");
  if (!control) {
    if (p.last_load == 0) v.error("E14", "load", "a path to load factor 0 is no path");
    return;
  }
  const bool angle = p.direction == 3;
  if (!at)
    v.error("E05", nullptr, "displacement control lacks 'at'",
            "at = \"disk\", direction = \"y\", to = \"-5 mm\"");
  else if (angle ? !turn || along : !along || turn)
    v.error("E05", nullptr,
            fmt::format("displacement control with direction = \"{}\" needs '{}'",
                        angle              ? "rx"
                        : p.direction == 0 ? "x"
                        : p.direction == 1 ? "y"
                                           : "z",
                        angle ? "to_angle" : "to"));
  else if (p.to == 0)
    v.error("E14", angle ? "to_angle" : "to", "a path to displacement 0 is no path");
}

void describe(Visitor& v, model::StaticStep& s) {
  v.integer("load_steps", s.load_steps, between(1, 100000),
            "number of parts in which gravity and the loads are put on (more where needed)");
  s.speed_given = v.quantity(
      optional("speed", "what the drives prescribe at time 0, else the shafts' initial_spin"),
      s.speed, "rpm", any,
      "speed of the rotor, whatever drives prescribe: every shaft at its speed_ratio");
  v.table(
      optional("speeds", "speed alone"), s.speeds,
      "equilibria at these speeds instead, one after another: locus, eccentricity, load and the "
      "eight coefficients of each bearing against speed; later steps start from the last one");
  v.table(optional("path", "one equilibrium, at the full load"), s.path,
          "follow the equilibria from no load past limit points (snap-through) and, with branch, "
          "off bifurcations (buckling); a path that does not reach its load is an error");
  if (v.clean() && s.path && s.load_steps > 1)
    v.error("E26", "load_steps", "a path has its own steps", "use path.steps");
  if (v.clean() && s.speeds && (s.path || v.given("speed")))
    v.error("E26", "speeds",
            s.path ? "a path is followed at one speed"
                   : "the speed is given by 'speed' and by 'speeds'",
            "keep one of the two");
}

namespace {

void describe_motion(Visitor& v, model::MotionKind& motion) {
  v.choice("motion", motion,
           {{"all", "every motion, coupled as it is"},
            {"lateral", "bending: axial motion and twist follow without inertia"},
            {"torsional", "twist alone: bending and axial motion held"},
            {"axial", "motion along the shafts alone: bending and twist held"}},
           "unknowns that take part");
}

void describe_about(Visitor& v, model::About& about) {
  v.choice(
      "about", about,
      {{"equilibrium", "the static equilibrium at the speed, under gravity and loads"},
       {"undeformed",
        "the rotor as drawn: no gravity, no loads, no deflection, and of heat and axial_preload "
        "what the supports along the axis hold; not with supports whose stiffness is that of "
        "their load"}},
      "state that the equations are linearised about");
}

void describe_damping(Visitor& v, bool& damped) {
  int i = damped ? 0 : 1;
  static constexpr Option kinds[] = {
      {"damped", "with damping, cross-coupling and circulation"},
      {"undamped", "mass, gyroscopic effects and symmetric stiffness alone"}};
  v.option("damping", i, kinds, "what the modes include");
  damped = i == 0;
}

}  // namespace

void describe(Visitor& v, model::FrequencyRange& r) {
  v.quantity(optional("start", "\"0 Hz\""), r.start, "rad/s", not_negative,
             "first frequency (Hz, rpm or rad/s)");
  const bool stop = v.quantity(optional("stop", "values are given"), r.stop, "rad/s", positive,
                               "last frequency (Hz, rpm or rad/s)");
  const bool points = v.integer(optional("points", "values are given"), r.points,
                                between(1, 1000000), "number of frequencies, equally spaced");
  const bool values =
      v.quantities(optional("values", "start, stop, points"), r.values, "rad/s", not_negative, -1,
                   "the frequencies one by one (Hz, rpm or rad/s)");
  if (!v.clean()) return;
  if (values && (stop || points || v.given("start")))
    v.error("E26", "values",
            "the frequencies are given by 'values' and by 'start', 'stop', 'points'",
            "keep one of the two");
  else if (!values && (!stop || !points))
    v.error("E05", nullptr, fmt::format("the frequencies lack '{}'", stop ? "points" : "stop"),
            "frequency = { start = \"0 Hz\", stop = \"200 Hz\", points = 201 }");
  else if (values && r.values.empty())
    v.error("E20", "values", "at least one frequency is needed");
  else if (!values && r.points > 1 && !(r.stop > r.start))
    v.error("E21", "stop", "the frequencies end below their start");
  for (std::size_t k = 1; v.clean() && k < r.values.size(); ++k)
    if (!(r.values[k] > r.values[k - 1]))
      v.error("E21", "values", "the frequencies do not increase");
}

void describe(Visitor& v, model::ModalStep& s) {
  v.quantity("speed", s.speed, "rpm", any, "speed of the rotor");
  v.integer("modes", s.modes, between(1, 10000), "number of modes, from the lowest frequency");
  v.quantity(optional("max_frequency", "no limit"), s.max_frequency, "rad/s", positive,
             "modes up to this frequency only (Hz, rpm or rad/s)");
  describe_damping(v, s.damped);
  describe_motion(v, s.motion);
  describe_about(v, s.about);
  v.integer("shapes", s.shapes, between(0, 1000),
            "number of mode shapes drawn, and animated where [[output.vtk]] asks for this step");
}

void describe(Visitor& v, model::CampbellStep& s) {
  v.table(required("speed"), s.speed, "the speeds");
  v.integer("modes", s.modes, between(1, 10000), "number of modes followed");
  describe_orders(v, s.orders);
  v.quantity(optional("max_frequency", "no limit"), s.max_frequency, "rad/s", positive,
             "modes up to this frequency only (Hz, rpm or rad/s)");
  describe_damping(v, s.damped);
  describe_motion(v, s.motion);
  describe_about(v, s.about);
}

void describe(Visitor& v, model::CriticalStep& s) {
  v.quantity(required("max_speed"), s.max_speed, "rpm", positive, "critical speeds up to this one");
  const bool from = v.quantity(optional("min_speed", "a thousandth of max_speed"), s.min_speed,
                               "rpm", not_negative, "critical speeds from this one on");
  describe_orders(v, s.orders);
  v.integer("modes", s.modes, between(1, 10000),
            "critical speeds listed of each order, from the lowest");
  describe_motion(v, s.motion);
  describe_about(v, s.about);
  v.integer("shapes", s.shapes, between(0, 1000), "number of mode shapes drawn");
  if (v.clean() && s.min_speed >= s.max_speed)
    v.error("E21", "min_speed", "min_speed is not below max_speed");
  // at standstill itself every free motion is one
  constexpr double next_to_standstill = 1e-6;
  if (v.clean() && from && s.min_speed == 0) s.min_speed = next_to_standstill * s.max_speed;
}

void describe(Visitor& v, model::UnbalanceStep& s) {
  v.table(required("speed"), s.speed, "the speeds");
  std::vector<double> range;
  const bool given =
      v.quantities(optional("operating_speed", "no separation margins"), range, "rpm", positive, 2,
                   "lowest and highest operating speed: separation margins as in API RP 684");
  v.quantities(optional("shapes_at", "at the peaks"), s.shapes_at, "rpm", positive, -1,
               "speeds at which the deflected rotor is drawn");
  describe_about(v, s.about);
  const bool zones =
      v.table(optional("zones", "none"), s.zones,
              "zones of shaft vibration: that of every probe over the operating speeds");
  const bool grade = v.quantity(
      optional("balance_grade", "none"), s.balance_grade, "mm/s", positive,
      "balance grade after ISO 21940-11 (\"G2.5\" or \"2.5 mm/s\"): the unbalances of each shaft "
      "against it, at the highest operating speed");
  if (v.clean() && !given && (zones || grade))
    v.error("E05", nullptr, "zones and grades are those of operating speeds",
            "operating_speed = [\"7000 rpm\", \"9450 rpm\"]");
  if (!v.clean() || !given) return;
  if (range[1] < range[0])
    v.error("E21", "operating_speed", "the highest operating speed is below the lowest");
  else
    s.operating = {range[0], range[1]};
}

void describe(Visitor& v, model::StabilityMap& m) {
  v.text(required("parameter"), m.parameter, "name of the parameter, as in [parameters]");
  v.texts(
      required("values"), m.values,
      "its values, each with its unit as in [parameters], ascending: \"60 um\", \"75 um\", ...");
  if (!v.clean()) return;
  if (m.values.size() < 2) v.error("E20", "values", "a map needs at least two values");
  double last = -infinity;
  std::string unit;
  for (const std::string& text : m.values) {
    char* end = nullptr;
    const double x = std::strtod(text.c_str(), &end);
    const std::string rest = *end == ' ' ? end + 1 : end;
    if (end == text.c_str())
      return v.error("E20", "values", fmt::format("'{}' is not a number with a unit", text),
                     "values = [\"60 um\", \"75 um\"]");
    if (last != -infinity && rest != unit)
      return v.error("E26", "values",
                     fmt::format("the values have different units: '{}' and '{}'", unit, rest),
                     "write all of them in one unit");
    if (!(x > last))
      return v.error("E21", "values", fmt::format("the values do not increase: '{}'", text));
    last = x;
    unit = rest;
  }
}

void describe(Visitor& v, model::StabilityStep& s) {
  v.table(required("speed"), s.speed, "the speeds");
  v.integer("modes", s.modes, between(1, 10000),
            "number of modes followed, from the lowest frequency");
  v.table(optional("map", "the deck as it is"), s.map,
          "stability over a parameter of the deck as well: onset speed and log decrement at each "
          "of its values");
  describe_about(v, s.about);
}

void describe(Visitor& v, model::CriticalMapStep& s) {
  v.quantity(required("stiffness_min"), s.stiffness_min, "N/m", positive,
             "lowest stiffness of the supports, in y and z alike");
  v.quantity(required("stiffness_max"), s.stiffness_max, "N/m", positive, "highest stiffness");
  v.integer("points", s.points, between(2, 10000),
            "number of stiffnesses, equally spaced on a logarithmic scale");
  v.quantity(required("max_speed"), s.max_speed, "rpm", positive, "critical speeds up to this one");
  v.number("order", s.order, positive, "excitations a revolution");
  v.flag("backward", s.backward, "backward critical speeds as lines of their own");
  describe_motion(v, s.motion);
  describe_about(v, s.about);
  v.texts(
      optional("bearings", "all that carry laterally from a shaft to the ground, but rigid ones"),
      s.bearings,
      "names of the bearings whose lateral stiffness is varied; what they do along and about the "
      "shaft stays");
  if (v.clean() && s.stiffness_max <= s.stiffness_min)
    v.error("E21", "stiffness_max", "stiffness_max is not above stiffness_min");
}

void describe(Visitor& v, model::HarmonicForce& f) {
  v.location(required("at"), f.at, "where it acts, on which shaft");
  v.vector("force", f.force, "N", "amplitude of the force along x, y, z");
  v.vector("moment", f.moment, "N.m",
           "amplitude of the moment about x, y, z; about x it twists the shaft");
  v.quantity("phase", f.phase, "deg", any, "lead of this force: cos(w t + phase)");
  v.choice("whirl", f.whirl,
           {{"none", "along fixed directions"},
            {"forward",
             "turning at the frequency as the shaft spins (from y towards z where its spin is "
             "positive)"},
            {"backward", "turning against the spin"}},
           "a lateral force or moment that turns starts in the direction given");
  if (!v.clean()) return;
  if (!v.given("force") && !v.given("moment"))
    v.error("E05", nullptr, "a harmonic force has neither 'force' nor 'moment'");
  else if (f.whirl != model::HarmonicForce::Whirl::none && (f.force.x() != 0 || f.moment.x() != 0))
    v.error("E26", "whirl", "a force or moment along the axis cannot turn about it",
            "give the axial part a force of its own");
}

void describe(Visitor& v, model::HarmonicStep& s) {
  v.list("force", s.forces, "the harmonic forces");
  v.quantity(optional("rotor_speed", "\"0 rpm\""), s.speed, "rpm", any,
             "speed of the rotor while the frequency varies");
  v.table(optional("frequency", "order times the speed"), s.frequency,
          "excitation frequencies at one rotor speed");
  v.table(optional("speed", "rotor_speed"), s.speeds,
          "rotor speeds, with the excitation frequency order times the speed");
  v.number(optional("order", "1"), s.order, positive, "excitation frequency relative to the speed");
  v.flag("speed_squared", s.speed_squared,
         "amplitudes grow with the square of the speed; they are given for the highest speed");
  describe_motion(v, s.motion);
  describe_about(v, s.about);
  v.quantities(optional("shapes_at", "at the peaks"), s.shapes_at, "rad/s", positive, -1,
               "excitation frequencies at which the deflected rotor is drawn");
  if (!v.clean()) return;
  if (s.forces.empty())
    v.error("E05", nullptr, "a harmonic response needs at least one force",
            "[[step.force]] with at, force or moment");
  else if (s.frequency.has_value() == s.speeds.has_value())
    v.error(s.frequency ? "E26" : "E05", s.frequency ? "frequency" : nullptr,
            s.frequency ? "'frequency' and 'speed' cannot both be varied"
                        : "neither 'frequency' nor 'speed' is given",
            "frequency = { start = \"0 Hz\", stop = \"200 Hz\", points = 201 }");
  else if (s.frequency && v.given("order"))
    v.error("E26", "order", "'order' belongs to a range of speeds");
  else if (s.speeds && v.given("rotor_speed"))
    v.error("E26", "rotor_speed", "'rotor_speed' belongs to a range of frequencies");
}

void describe(Visitor& v, model::SensitivityStep& s) {
  v.quantity("speed", s.speed, "rpm", any, "speed of the rotor");
  v.table(required("frequency"), s.frequency, "frequencies of the disturbance");
  describe_about(v, s.about);
  const auto magnetic = [](const model::Bearing& b) {
    return std::holds_alternative<model::MagneticBearing>(b.law);
  };
  const auto& bearings = v.model().bearings;
  if (v.clean() && std::none_of(bearings.begin(), bearings.end(), magnetic))
    v.error("E26", nullptr, "there is no control loop: no bearing is magnetic",
            "[[bearing]] with type = \"magnetic\"");
}

void describe(Visitor& v, model::TorsionalStep& s) {
  v.integer("modes", s.modes, between(1, 10000),
            "number of torsional modes, from the lowest frequency");
  v.quantity(required("max_speed"), s.max_speed, "rpm", positive,
             "end of the interference diagram");
  describe_orders(v, s.orders);
  describe_about(v, s.about);
}

void describe(Visitor& v, model::BucklingStep& s) {
  v.integer("modes", s.modes, between(1, 10000),
            "number of buckling loads, from the smallest factor");
  v.quantity("speed", s.speed, "rpm", any, "speed of the rotor");
}

void describe(Visitor& v, model::ShaftTorques& t) {
  v.number("concentration", t.concentration, at_least(1), "factor on shear stresses");
  v.quantity(optional("yield", "not looked at"), t.yield, "MPa", positive, "yield stress in shear");
  const bool endurance = v.quantity(
      optional("endurance", "no fatigue"), t.endurance, "MPa", positive,
      "shear stress amplitude about zero that 'cycles' of them and any more do not break");
  const bool ultimate = v.quantity(optional("ultimate", "no fatigue"), t.ultimate, "MPa", positive,
                                   "tensile strength; 0.67 of it in shear");
  const bool thousand =
      v.quantity(optional("thousand", "0.9 of 0.67 of 'ultimate'"), t.thousand, "MPa", positive,
                 "shear stress amplitude about zero that 1000 cycles take");
  v.number("cycles", t.cycles, Range{1000, 1e12, true, false},
           "cycles at which 'endurance' begins");
  if (!v.clean()) return;
  if (endurance != ultimate)
    return v.error("E05", nullptr, "fatigue needs 'endurance' and 'ultimate'", "give both");
  if (thousand && !endurance)
    return v.error("E26", "thousand", "'thousand' goes with 'endurance' and 'ultimate'");
  if (endurance && !thousand) t.thousand = 0.9 * 0.67 * t.ultimate;
  if (endurance && !(t.thousand > t.endurance && 0.67 * t.ultimate > t.endurance))
    v.error("E21", "endurance", "the endurance limit is not below the strength at 1000 cycles");
}

void describe(Visitor& v, model::TransientStep& s) {
  v.quantity(beside_motion(required("duration")), s.duration, "s", positive,
             "length of the run; it begins at time 0, or where the step named by 'from' ended");
  v.choice("start", s.start,
           {{"rest", "straight and unstressed, loads applied at once"},
            {"static", "in static equilibrium"},
            {"unbalance_response", "in the steady response to the unbalance at the initial speed"},
            {"mode", "in static equilibrium plus a whirl mode at the initial speed"}},
           "state at the start, unless 'from' names a transient step");
  v.integer(
      "mode", s.mode, between(1, 10000),
      "of start = \"mode\": its number from the lowest frequency, among the modes of its kind");
  v.choice("mode_kind", s.mode_kind,
           {{"all", "every kind, in one row"},
            {"lateral", "bending"},
            {"torsional", "twist"},
            {"axial", "along the shafts"}},
           "of start = \"mode\": kind of the modes that are counted, by the largest share of their "
           "energy");
  v.quantity("mode_amplitude", s.mode_amplitude, "mm", positive,
             "of start = \"mode\": its largest displacement");
  // a resolved deck writes what is the default anyway
  const model::TransientStep plain;
  const bool number = s.mode != plain.mode, kind = s.mode_kind != plain.mode_kind,
             amplitude = s.mode_amplitude != plain.mode_amplitude;
  if (s.start != model::TransientStep::Start::mode && (number || kind || amplitude))
    v.error("E26",
            number ? "mode"
            : kind ? "mode_kind"
                   : "mode_amplitude",
            "a mode is that of start = \"mode\", and the step starts otherwise",
            "start = \"mode\"");
  v.text(optional("previous", "none"), s.previous,
         "results folder of an earlier run of the same rotor; this step starts from its last state "
         "(of the checkpoint written at its end)");
  v.text(optional("previous_step", "the only one"), s.previous_step,
         "which of its transient steps");
  if (s.previous.empty() && !s.previous_step.empty())
    v.error("E26", "previous_step", "'previous_step' belongs to 'previous'",
            "previous = \"results folder\"");
  s.speed0_given = v.quantity(
      optional("initial_speed", "what the drives prescribe, else the shafts' initial_spin"),
      s.speed0, "rpm", any, "spin at the start of every rotating line (times its speed_ratio)");
  double stop = 0;
  if (v.quantity(beside_motion(optional("stop_speed", "never")), stop, "rpm", any,
                 "the run ends when the reference speed, the spin of the reference shaft over its "
                 "speed_ratio, passes this value"))
    s.stop_speed = stop;
  v.quantity(beside_motion(optional("amplitude_limit", "none")), s.amplitude_limit, "mm", positive,
             "the run ends when a probe exceeds this displacement");
  v.flag(
      "linear", s.linear,
      "small motions about the rotor that turns at constant speed in static equilibrium: constant "
      "matrices, one factorisation for each length of step; loads and unbalance act as they are");
  v.quantity(beside_motion("checkpoint"), s.checkpoint, "s", not_negative,
             "wall-clock time between checkpoints, from which --resume continues; 0 s: none");
  v.table(
      beside_motion(optional("torques", "none")), s.torques,
      "torques in all shafts and couplings: the largest, cycles, fatigue, pictures against time "
      "and angle");
  v.table("integrator", s.integrator, "time integration");
}

void describe(Visitor& v, model::Step& s) {
  v.name(s, "step");
  v.step(optional("from", "the undeformed model"), s.from,
         "an earlier static or transient step whose result this one starts from");
  const Alternative kinds[] = {
      Visitor::alternative<model::StaticStep>(
          "static", s.law, "static equilibrium under gravity, loads and preloads"),
      Visitor::alternative<model::ModalStep>("modal", s.law, "whirl modes at one speed"),
      Visitor::alternative<model::CampbellStep>("campbell", s.law,
                                                "whirl frequencies and damping against speed"),
      Visitor::alternative<model::CriticalStep>("critical_speeds", s.law,
                                                "critical speeds, solved for directly"),
      Visitor::alternative<model::UnbalanceStep>("unbalance_response", s.law,
                                                 "steady response to the unbalances against speed"),
      Visitor::alternative<model::StabilityStep>(
          "stability", s.law,
          "log decrement against speed, and the onset speeds of instability, solved for directly"),
      Visitor::alternative<model::CriticalMapStep>(
          "critical_map", s.law, "undamped critical speeds against the stiffness of the supports"),
      Visitor::alternative<model::HarmonicStep>(
          "harmonic_response", s.law, "steady response to harmonic forces, synchronous or not"),
      Visitor::alternative<model::SensitivityStep>(
          "sensitivity", s.law,
          "sensitivity of the control loops of magnetic bearings, with the zones of ISO 14839-3"),
      Visitor::alternative<model::TorsionalStep>(
          "torsional", s.law,
          "torsional natural frequencies and where orders of the speed meet them"),
      Visitor::alternative<model::BucklingStep>(
          "buckling", s.law,
          "factors on gravity and all loads at which the rotor buckles, linearised about the "
          "unloaded state"),
      Visitor::alternative<model::TransientStep>("transient", s.law, "motion in time, nonlinear"),
      Visitor::alternative<model::ApiLateralStep>(
          "api_lateral", s.law,
          "lateral report after API 617 and RP 684: critical-speed map, unbalance response and "
          "stability of every set of bearings, and one table of what complies"),
      Visitor::alternative<model::ApiTorsionalStep>(
          "api_torsional", s.law,
          "torsional report: train, interference diagram, separation margins, stresses, and one "
          "table of what complies"),
      Visitor::alternative<model::BalancingStep>(
          "balancing", s.law,
          "correction masses by influence coefficients or by modes, from the model or from "
          "measured vectors, and the vibration that is left"),
  };
  v.alternatives(required("type"), kinds, "kind of analysis");
}

}  // namespace whirl::deck
