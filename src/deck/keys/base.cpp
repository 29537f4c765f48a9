// [base] and [[event]]: what happens to the whole machine, and what is watched for.
#include <deck/visitor.hpp>

namespace whirl::deck {

void describe(Visitor& v, model::BaseMotion& b) {
  static constexpr const char* keys[] = {"x", "y", "z"};
  static constexpr const char* docs[] = {
      ("acceleration of the base along the shaft, constant or a law of time; displacements are "
       "relative to the base; steps without time take the value at t = 0, as for the keys below"),
      "acceleration across, horizontally", "acceleration upwards"};
  for (std::size_t k = 0; k < 3; ++k)
    describe_law(v, optional(keys[k], "0"), b.acceleration[k], "m/s^2", docs[k]);
  v.table(optional("turn", "none"), b.turn,
          "turning of the base, a manoeuvre: every inertia gets its Coriolis, centrifugal, Euler "
          "and gyroscopic forces, and the weight turns against the base");
}

void describe(Visitor& v, model::BaseTurn& t) {
  v.vector(required("axis"), t.axis, "",
           "direction it turns about, x along the shaft, z up; fixed in the base and in space; of "
           "any length");
  v.vector(optional("about", "[0, 0, 0]"), t.about, "m",
           "a point of the axis; far away for a curve");
  describe_law(v, required("rate"), t.rate, "deg/s",
               "angular speed, constant or a law of time; steps without time take it at t = 0");
  if (!v.clean()) return;
  if (!(t.axis.norm() > 0))
    v.error("E14", "axis", "the axis of turning has no direction",
            "for example axis = [0, 0, 1]: yaw");
  else
    t.axis.normalize();
}

void describe(Visitor& v, model::Event& e) {
  v.name(e, "event");
  static constexpr Option directions[] = {
      {"both", "either way"}, {"rising", "from below"}, {"falling", "from above"}};
  int direction = e.direction == 0 ? 0 : e.direction > 0 ? 1 : 2;
  v.option("direction", direction, directions, "which passages count");
  e.direction = direction == 0 ? 0 : direction == 1 ? 1 : -1;
  v.flag("stop", e.stop, "the run ends at it");
  const Alternative kinds[] = {
      {"speed",
       "the reference speed, the spin of the reference shaft over its speed_ratio, passes a value",
       [&](Visitor& w) {
         e.kind = model::Event::Kind::speed;
         w.quantity(required("value"), e.value, "rpm", any, "spin");
       }},
      {"amplitude", "the lateral displacement of a station passes a value, for example a clearance",
       [&](Visitor& w) {
         e.kind = model::Event::Kind::amplitude;
         model::Location at;
         if (w.location(required("at"), at, "place on a shaft")) e.at = at;
         w.quantity(required("value"), e.value, "mm", positive,
                    "displacement from the reference position");
       }},
  };
  v.alternatives(required("type"), kinds, "what is watched");
  // the run ends at the first passage there is
  const bool rising_only = e.kind == model::Event::Kind::amplitude;
  if (v.clean() && e.stop && e.direction != 0 && !(rising_only && e.direction > 0))
    v.error("E26", "direction",
            rising_only ? "a run stops where the amplitude rises above its value"
                        : "a run stops at a speed whichever way it is passed",
            "leave out 'direction', or 'stop'");
}

}  // namespace whirl::deck
