// What is made of the motion of the probes: [output.tracking] and [output.spectra].
#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <fmt/format.h>

#include <cmath>

namespace whirl::deck {

void describe(Visitor& v, model::TrackingOutput& o) {
  v.flag("on", o.on, "amplitude and phase of the probes turn by turn, as CSV and figures");
  v.integer("samples", o.samples, between(16, 1024),
            "samples a turn, at equal angles of the reference shaft");
  v.quantities("orders", o.orders, "", positive, -1, "multiples of the speed, whole numbers");
  v.quantities(optional("orbit_speeds", "the largest orbit alone"), o.orbit_speeds, "rpm", any, -1,
               "orbits are shown where the spin passes these speeds, beside the largest one");
  v.integer("orbit_turns", o.orbit_turns, between(1, 20), "turns an orbit shows");
  for (double k : o.orders)
    if (v.clean() && (k != std::round(k) || 2.0 * k >= o.samples))
      v.error("E20", "orders",
              fmt::format("order {} is not a whole number below half the samples a turn ({})", k,
                          o.samples));
}

void describe(Visitor& v, model::SpectraOutput& o) {
  v.quantity(required("max_frequency"), o.max_frequency, "rad/s", positive,
             "highest frequency shown (Hz, rpm or rad/s)");
  v.integer("lines", o.lines, between(16, 16384),
            "number of frequencies up to it; a block lasts lines/max_frequency");
  v.integer("traces", o.traces, between(2, 2000),
            "most spectra kept for the figures: of more, every other one");
}

}  // namespace whirl::deck
