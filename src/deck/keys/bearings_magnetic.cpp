// Active magnetic bearings: magnet, sensor, controller, amplifier.
#include <core/units.hpp>
#include <deck/keys/bearing_kinds.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::deck {
namespace {

void describe_stage(Visitor& v, model::Pid& s) {
  v.quantity(required("p"), s.kp, "A/m", any, "current for displacement");
  v.quantity("i", s.ki, "A/(m.s)", not_negative, "current for its integral; 0: none");
  v.quantity("d", s.kd, "A.s/m", any, "current for its rate; 0: none");
  const bool lag = v.quantity(optional("lag", "d is not given"), s.lag, "us", positive,
                              "of the derivative: d s/(1 + lag s)");
  if (v.clean() && s.kd != 0 && !lag)
    v.error("E05", "d", "the derivative needs a lag",
            "lag = \"50 us\": without one it would answer to noise without end");
}

void describe_stage(Visitor& v, model::LeadLag& s) {
  v.quantity(required("zero"), s.zero, "rad/s", positive, "gain rises from here");
  v.quantity(required("pole"), s.pole, "rad/s", positive, "to here: (1 + s/zero)/(1 + s/pole)");
}

void describe_stage(Visitor& v, model::Notch& s) {
  v.quantity(required("frequency"), s.frequency, "rad/s", positive, "middle of the notch");
  v.number("damping", s.damping, positive, "zeta: half the width of the notch over its frequency");
  v.number("depth", s.depth, not_negative,
           "what is left in the middle: 0 nothing, 1 all; more: a peak");
}

void describe_stage(Visitor& v, model::LowPass& s) {
  v.quantity(required("frequency"), s.frequency, "rad/s", positive, "where half the power is left");
  v.integer("order", s.order, between(1, 8), "of the Butterworth filter");
}

void describe_stage(Visitor& v, model::TransferFunction& s) {
  v.quantities(required("numerator"), s.numerator, "", any, -1,
               "b0, b1, ..: coefficients of 1, s, s^2, ..; s in 1/s");
  v.quantities(required("denominator"), s.denominator, "", any, -1, "a0, a1, ..");
  v.quantity(optional("gain", "none: the stage has no dimension"), s.gain, "A/m", any,
             "factor that makes current of displacement");
  const auto terms = [](const std::vector<double>& c) {
    return std::find_if(c.rbegin(), c.rend(), [](double x) { return x != 0; }).base() - c.begin();
  };
  if (!v.clean()) return;
  if (terms(s.denominator) == 0)
    v.error("E14", "denominator", "the denominator is zero");
  else if (terms(s.numerator) > terms(s.denominator))
    v.error("E14", "numerator",
            "the numerator has a higher degree than the denominator: a derivative without a lag",
            "coefficients are in rising powers: [b0, b1, ..]");
}

struct MatrixEntry {
  int row = 0, column = 0;
  double value = 0;
};

void describe(Visitor& v, MatrixEntry& e) {
  v.integer(required("row"), e.row, at_least(1), "of [A B; C D], counted from 1");
  v.integer(required("column"), e.column, at_least(1), "of [A B; C D]");
  v.number(required("value"), e.value, any, "in s, with input and output as numbers");
}

/// States, factor and entries of [A B; C D] with so many inputs and outputs.
void state_space(Visitor& v, model::StateSpaceStage& s, int ways, const Key& gain,
                 const char* gain_doc) {
  int order = 1;
  v.integer(required("order"), order, between(1, 60), "number of states n");
  v.quantity(gain, s.gain, "A/m", any, gain_doc);
  const int size = order + ways;
  s.matrix = MatX::Zero(size, size);
  const auto add = [&](Visitor& w) {
    MatrixEntry e;
    describe(w, e);
    if (!w.clean()) return;
    if (e.row > size || e.column > size)
      w.error("E14", e.row > size ? "row" : "column",
              fmt::format("the matrix [A B; C D] has {} rows and columns", size));
    else
      s.matrix(e.row - 1, e.column - 1) = e.value;
  };
  v.rows({add,
          [](Visitor& w) {
            MatrixEntry e;
            describe(w, e);
          }},
         true,
         "entries of [A B; C D], x' = A x + B u, y = C x + D u, one row an entry; those left out "
         "are zero");
}

void describe_stage(Visitor& v, model::StateSpaceStage& s) {
  state_space(v, s, 1, optional("gain", "none: the stage has no dimension"),
              "factor that makes current of displacement");
}

}  // namespace

void describe(Visitor& v, model::ControlStage& s) {
  const auto stage = [&s]<class T>(const char* word, std::type_identity<T>, const char* doc) {
    return Alternative{word, doc, [&s](Visitor& w) {
                         if (!std::holds_alternative<T>(s)) s = T{};
                         describe_stage(w, std::get<T>(s));
                       }};
  };
  const Alternative kinds[] = {
      stage("pid", std::type_identity<model::Pid>{},
            "p + i/s + d s/(1 + lag s): current for displacement"),
      stage("lead_lag", std::type_identity<model::LeadLag>{}, "phase lead between zero and pole"),
      stage("notch", std::type_identity<model::Notch>{}, "takes out a frequency"),
      stage("low_pass", std::type_identity<model::LowPass>{}, "Butterworth"),
      stage("transfer", std::type_identity<model::TransferFunction>{}, "any proper fraction"),
      stage("state_space", std::type_identity<model::StateSpaceStage>{},
            "matrices, in the deck or from a file"),
  };
  v.alternatives(required("type"), kinds, "kind of stage");
}

namespace {

/// One stage gives current for displacement.
bool check_controller(Visitor& v, const char* key, const model::Controller& c) {
  const auto n = std::count_if(c.begin(), c.end(), model::gives_current);
  if (n == 1 || c.empty()) return true;
  v.error("E26", key,
          n == 0 ? "no stage of the controller makes current of displacement"
                 : fmt::format("{} stages of the controller make current of displacement", n),
          "one stage has the unit A/m: a pid, or a transfer or state_space with a gain");
  return false;
}

void check(Visitor& v, const model::MagneticBearing& b) {
  if (!v.clean()) return;
  if ((b.bias > 0) != (b.gap > 0))
    v.error("E05", b.bias > 0 ? "bias_current" : "gap",
            "the nonlinear force law needs the bias current and the gap",
            "give bias_current and gap, or neither: the force is then linear");
  else if (b.saturation > 0 && b.bias == 0)
    v.error("E05", "saturation", "a linear force law does not saturate",
            "give bias_current and gap");
  else if (b.saturation > 0 && !(b.saturation > 0.25 * b.per_current * b.bias))
    v.error("E14", "saturation",
            fmt::format("the bias current alone pulls {} at each pair of poles",
                        units::display(0.25 * b.per_current * b.bias, "N")),
            "saturation is the largest force of one pair of poles");
  else if (b.bias > 0 && b.per_displacement * b.gap > 1.05 * b.per_current * b.bias)
    v.error("E14", "position_stiffness",
            fmt::format("a magnet of this current stiffness has at most {}",
                        units::display(b.per_current * b.bias / b.gap, "N/m")),
            "position_stiffness = current_stiffness bias_current/gap times the cosine of half the "
            "angle between the poles of a pair");
  else if (b.both && !(b.control.empty() && b.second.empty() && b.cross.empty()))
    v.error("E26", "control_both", "the controller of both axes is given, and others beside it",
            "keep one of the two");
  else if (b.control.empty() && !b.both)
    v.error("E05", nullptr, "the magnetic bearing has no controller",
            "[[bearing.control]] with type = \"pid\", p, i, d, lag");
  else
    check_controller(v, "control", b.control) && check_controller(v, "control_2", b.second) &&
        check_controller(v, "cross", b.cross);
}

}  // namespace

void describe(Visitor& v, model::MagneticBearing& b) {
  v.quantity(required("current_stiffness"), b.per_current, "N/A", positive,
             "force for control current, of an axis in the middle of the gap");
  v.quantity("bias_current", b.bias, "A", not_negative,
             "of the nonlinear force law; 0: it is linear");
  v.quantity("gap", b.gap, "mm", not_negative,
             "between poles and rotor in the middle, of the nonlinear force law");
  const bool stiffness = v.quantity(
      optional("position_stiffness", "current_stiffness bias_current/gap"), b.per_displacement,
      "N/m", positive, "force for displacement, towards the pole: a negative stiffness");
  if (v.clean() && !stiffness) {
    if (b.gap > 0 && b.bias > 0)
      b.per_displacement = b.per_current * b.bias / b.gap;
    else
      v.error("E05", nullptr, "the magnet has no position stiffness",
              "position_stiffness = \"1e6 N/m\", or bias_current and gap");
  }
  v.quantity(optional("saturation", "none"), b.saturation, "N", positive,
             "largest force of one pair of poles; it sets in smoothly");
  v.quantity(optional("max_current", "none"), b.current_limit, "A", positive,
             "largest control current; it sets in smoothly");
  v.quantity(optional("max_current_rate", "none"), b.rate_limit, "A/s", positive,
             "largest rate of the current: the amplifier's voltage over the coil's inductance; it "
             "sets in smoothly");
  v.quantity("angle", b.angle, "deg", any,
             "direction of axis 1, from y towards z; axis 2 is 90 deg further");
  model::Location at;
  if (v.location(optional("sensor_at", "at"), at, "place of the sensors on the same shaft"))
    b.sensor_at = at;
  v.quantity(optional("sensor_bandwidth", "it follows at once"), b.sensor_bandwidth, "rad/s",
             positive, "of the sensor, first order");
  v.quantity(required("amplifier_bandwidth"), b.amplifier_bandwidth, "rad/s", positive,
             "of the current amplifier, first order");
  v.quantity("delay", b.delay, "us", not_negative, "of sampling and computing");
  v.integer("delay_order", b.delay_order, between(1, 6), "degree of the delay's Pade form");
  std::vector<double> setpoint{0, 0};
  v.quantities("setpoint", setpoint, "um", any, 2, "displacement along axes 1 and 2 that is held");
  b.setpoint = Vec2(setpoint[0], setpoint[1]);
  v.list(
      "control", b.control,
      "the controller, stages in series: the current is minus what it makes of the displacement");
  v.list(optional("control_2", "as control"), b.second, "the controller of axis 2");
  v.list(optional("cross", "none"), b.cross,
         "cross-axis control, stages in series: what it makes of the displacement along axis 2 is "
         "taken from the current of axis 1, what it makes of that along axis 1 added to axis 2");
  model::StateSpaceStage both;
  const bool coupled = v.table(
      optional("control_both", "none"),
      [&](Visitor& w) {
        state_space(w, both, 2, required("gain"), "factor that makes current of displacement");
      },
      "one controller of both axes, as matrices, in the deck or from a file, in place of control: "
      "inputs are the displacements along axes 1 and 2, outputs what is taken from their currents");
  if (coupled) b.both = both;
  describe_law(v, optional("power", "1"), b.power, "",
               "factor on the forces and on what the sensors see, against time: 0 off, 1 on; steps "
               "without time take it at 0");
  check(v, b);
}

void add_kinds(Kinds& k, As<model::MagneticBearing>) {
  k.add<model::MagneticBearing>(
      "magnetic",
      "active magnetic bearing: magnets on two axes at right angles, sensors, controllers and "
      "amplifiers; what they store are unknowns of every analysis");
}

}  // namespace whirl::deck
