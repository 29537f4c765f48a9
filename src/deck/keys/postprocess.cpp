// What is made of the motion of the probes: [output.tracking] and [output.spectra].
#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <fmt/format.h>

#include <cmath>

namespace whirl::deck {

namespace {

/// An order that the samples of a turn show and that the filter tells from its neighbours: a Hann
/// window of M turns lets nothing through from 2/M orders on but its side lobes.
void check_order(Visitor& v, const model::TrackingOutput& o, double k) {
  if (2.0 * k >= o.samples)
    v.error("E20", "orders",
            fmt::format("order {} is not below half the samples a turn ({})", k, o.samples));
  const double apart = std::abs(k - std::round(k));
  if (apart == 0.0 || o.filter_turns() * apart >= 2.0 * (1.0 - 1e-9)) return;
  v.error(
      "E20", "orders",
      fmt::format("a filter of bandwidth {} does not tell order {} from order {}: at most {:.4g}",
                  o.bandwidth, k, std::round(k), apart));
}

}  // namespace

void describe(Visitor& v, model::TrackingOutput& o) {
  v.flag("on", o.on, "amplitude and phase of the probes turn by turn, as CSV and figures");
  v.integer("samples", o.samples, between(16, 1024),
            "samples a turn, at equal angles of the shaft the probe looks at");
  v.quantities("orders", o.orders, "", positive, -1,
               "multiples of the speed of the shaft the probe looks at; the first is drawn against "
               "speed with its phase");
  v.quantity("bandwidth", o.bandwidth, "", between(0.02, 2),
             "width of the filter at half amplitude, in multiples of the speed: a Hann window of "
             "2/bandwidth turns about each turn (2: each turn by itself), of up to 12 where shafts "
             "turn at different speeds, so that each keyphasor sees its own: of the others' 1X "
             "nothing at a ratio such as "
             "1.5, about 0.01 or less where speeds differ by a quarter or more");
  v.quantities(optional("orbit_speeds", "the largest orbit alone"), o.orbit_speeds, "rpm", any, -1,
               "orbits are shown where the spin passes these speeds, beside the largest one");
  v.integer("orbit_turns", o.orbit_turns, between(1, 20), "turns an orbit shows");
  if (!v.clean()) return;
  for (const double k : o.orders)
    check_order(v, o, k);
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
