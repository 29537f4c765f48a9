// [[step]] of type api_lateral and api_torsional, and [title_block].
#include <core/periodic.hpp>
#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace whirl::deck {

void describe(Visitor& v, model::TitleBlock& b) {
  const auto line = [&](const char* key, std::string& target, const char* doc) {
    v.text(beside_motion(optional(key, "left out")), target, doc);
  };
  line("project", b.project, "project");
  line("machine", b.machine, "machine: name, tag, service");
  line("company", b.company, "who makes the report");
  line("author", b.author, "who computed");
  line("checked", b.checked, "who checked");
  line("document", b.document, "number of the document");
  line("revision", b.revision, "its revision");
  line("date", b.date, "its date, as it shall stand there");
  line("notes", b.notes, "one line more");
}

namespace {

template <class T>
ListBody rows_of(std::vector<T>& list) {
  return Visitor::body_of(list, T{});
}

/// Names within a list: there, and each once.
template <class T>
void check_names(Visitor& v, const std::vector<T>& list, const char* key, const char* what) {
  std::set<std::string> names;
  for (const T& x : list)
    if (v.clean() && !names.insert(x.name).second)
      v.error("E16", key, fmt::format("two {} are called '{}'", what, x.name));
}

/// Whole numbers, as many as a step of modes lists at most.
bool check_mode_numbers(Visitor& v, const std::vector<double>& modes) {
  constexpr double most = 10000;
  for (const double m : modes)
    if (m != std::floor(m) || m < 1 || m > most) {
      v.error("E14", "modes", fmt::format("{:g} is no number of a mode", m), "modes = [1, 2]");
      return false;
    }
  return true;
}

void describe_operating(Visitor& v, std::array<double, 2>& range) {
  std::vector<double> speeds;
  v.quantities(required("operating_speed"), speeds, "rpm", positive, 2,
               "lowest and highest continuous speed");
  if (!v.clean() || speeds.size() != 2) return;
  if (speeds[1] < speeds[0])
    v.error("E21", "operating_speed", "the highest operating speed is below the lowest");
  range = {speeds[0], speeds[1]};
}

void describe_source(Visitor& v, std::string& source) {
  v.text(optional("source", "\"set in the deck\""), source,
         "where the limits that the deck sets come from; stands beside them in the table");
}

}  // namespace

void describe(Visitor& v, model::ApiClearance& c) {
  v.text(required("name"), c.name, "name in the tables");
  v.location(required("at"), c.at, "place on the shaft");
  v.quantity(required("diametral"), c.diametral, "mm", positive, "diametral running clearance");
}

void describe(Visitor& v, model::ApiStage& s) {
  v.text(required("name"), s.name, "name in the tables");
  v.choice("kind", s.kind,
           {{"radial", "an impeller: factor 3 and the ratio of densities (Wachel)"},
            {"axial", "blades: factor 1.5, no densities (Alford)"}},
           "which formula");
  model::Location at;
  if (v.location(optional("at", "apply = \"point\""), at, "place on the shaft")) s.at = at;
  v.quantity(required("power"), s.power, "kW", positive, "rated power of the stage");
  v.quantity(optional("speed", "the highest operating speed"), s.speed, "rpm", positive,
             "speed of that power");
  v.quantity(required("diameter"), s.diameter, "mm", positive,
             "of the impeller; mean diameter of blades");
  v.quantity(required("width"), s.width, "mm", positive,
             "least width of the flow, of impeller or diffuser; height of blades");
  const bool suction = v.quantity(optional("suction_density", "of axial stages"), s.suction,
                                  "kg/m^3", positive, "density at suction");
  const bool discharge = v.quantity(optional("discharge_density", "of axial stages"), s.discharge,
                                    "kg/m^3", positive, "density at discharge");
  if (v.clean() && s.kind == model::ApiStage::Kind::radial && !(suction && discharge))
    v.error("E05", nullptr, fmt::format("stage '{}' lacks its densities", s.name),
            "suction_density and discharge_density of a radial stage");
}

void describe(Visitor& v, model::ApiSet& s) {
  v.text(required("name"), s.name, "name in tables and files");
  v.texts(optional("change", "the deck as it is"), s.change,
          "keys of the deck with this set's values, as with --set: \"bearing.DE.clearance = 60 "
          "um\"");
  for (std::string& c : s.change) {
    if (!v.clean()) return;
    const std::size_t equal = c.find('=');
    if (equal == std::string::npos)
      return v.error("E20", "change", fmt::format("'{}' is no key = value", c),
                     "change = [\"bearing.DE.clearance = 60 um\"]");
    // `key = value` as written in decks; --set takes no spaces about the sign
    std::string key = c.substr(0, equal), value = c.substr(equal + 1);
    key.erase(key.find_last_not_of(' ') + 1);
    key.erase(0, key.find_first_not_of(' '));
    value.erase(0, value.find_first_not_of(' '));
    c = fmt::format("{}={}", key, value);
  }
}

void describe(Visitor& v, model::ApiLimits& l) {
  const auto note = [&](const char* key, bool given) {
    if (given) l.given.emplace_back(key);
  };
  const auto number = [&](const char* key, double& x, Range r, const char* doc) {
    note(key, v.number(key, x, r, doc));
  };
  number("unbalance_factor", l.unbalance_factor, positive,
         "of the residual unbalance, in the response");
  number("unbalance_constant", l.unbalance_constant, positive,
         "residual unbalance of a plane: this times W/N, in g mm with W in kg and N in rpm");
  note("unbalance_speed",
       v.quantity(optional("unbalance_speed", "the operating speed nearest to the mode"),
                  l.unbalance_speed, "rpm", positive, "N of the unbalance"));
  note("vibration", v.quantity("vibration", l.vibration, "um", positive,
                               "largest vibration limit, peak to peak"));
  note("vibration_speed",
       v.quantity("vibration_speed", l.vibration_speed, "rpm", positive,
                  "speed from which on it falls: limit = vibration sqrt(vibration_speed/N)"));
  number("scale", l.scale, positive, "largest factor from the vibration limit to the response");
  number("clearance", l.clearance, positive,
         "share of a diametral clearance that the scaled response may take");
  number("damped", l.damped, positive,
         "amplification factor below which no separation margin is asked for");
  number("margin_factor", l.margin_factor, not_negative,
         "separation margin: margin_factor (1 - 1/(AF - margin_offset))");
  number("margin_offset", l.margin_offset, not_negative, "the same");
  number("margin_above", l.margin_above, not_negative, "added to it above the operating range");
  note("margin", v.number(optional("margin", "by amplification factor"), l.margin, fraction,
                          "one separation margin for all, as a share of the speed"));
  number("stage_factor", l.stage_factor, positive, "of radial stages in the cross-coupling");
  number("axial_factor", l.axial_factor, positive, "of axial ones");
  number("torque_constant", l.torque_constant, positive, "torque = this times power in W over rpm");
  number("log_decrement", l.log_decrement, not_negative, "least log decrement");
  number("ratio", l.ratio, positive, "least Q0/QA, below which level 2 is asked for");
  number("ratio_in_b", l.ratio_in_b, positive, "the same in region B");
  note("density", v.quantities("density", l.density, "kg/m^3", not_negative, -1,
                               "mean densities of the gas at the corners of region A, ascending"));
  note("critical_ratio", v.quantities("critical_ratio", l.critical_ratio, "", positive, -1,
                                      "critical speed ratios there: below them lies region A"));
  describe_source(v, l.source);
  if (!v.clean()) return;
  if (l.density.size() != l.critical_ratio.size() || l.density.empty())
    return v.error("E26", "critical_ratio",
                   fmt::format("{} critical speed ratios for {} densities", l.critical_ratio.size(),
                               l.density.size()),
                   "as many of the one as of the other");
  if (!std::is_sorted(l.density.begin(), l.density.end(), std::less_equal<double>()))
    return v.error("E21", "density", "the densities do not increase");
  if (l.damped <= l.margin_offset)
    v.error("E26", "damped",
            "'damped' is not above 'margin_offset': the margin has no value there");
}

void describe(Visitor& v, model::ApiLateralStep& s) {
  v.text("standard", s.standard, "name of the standard in the tables");
  describe_operating(v, s.operating);
  const bool trip = v.quantity(optional("trip_speed", "the highest operating speed"), s.trip, "rpm",
                               positive, "clearances are looked at up to this speed");
  std::vector<double> range;
  const bool given = v.quantities(
      optional("response_speed",
               "a tenth of the lowest to 1.25 of the trip speed, and to 1.3 of the highest"),
      range, "rpm", positive, 2, "first and last speed of the unbalance response");
  v.integer("points", s.points, between(3, 1000000),
            "speeds of the response, before those at its peaks");
  v.texts(optional("bearings", "all that carry laterally to the ground, but seals"), s.bearings,
          "names of the journal bearings");
  v.texts(optional("seals", "bearings of type annular_seal and cross_coupling"), s.seals,
          "names of seals and what else drives whirl: left out of the critical-speed map and of "
          "level 1, as given in level 2");
  v.texts(optional("probes", "all of the deck"), s.probes,
          "names of the probes that vibration limits and margins are looked at");
  v.quantities(optional("modes", "all undamped ones below the last speed"), s.modes, "", positive,
               -1, "numbers of the undamped modes that the unbalance is placed for, 1 the lowest");
  v.list(optional("set", "the deck as it is"), s.sets,
         "sets of bearings: minimum and maximum clearance, say");
  v.table(
      optional("clearances", "none"),
      [&](Visitor& w) {
        w.rows(rows_of(s.clearances), true, "close clearances, one a row");
        check_names(w, s.clearances, nullptr, "clearances");
      },
      "close clearances");
  v.table(
      optional("stages", "no level 1 analysis"),
      [&](Visitor& w) {
        w.rows(rows_of(s.stages), true, "stages, one a row");
        check_names(w, s.stages, nullptr, "stages");
      },
      "stages that drive whirl");
  v.choice(optional("apply", "point"), s.at_stages,
           {{"point", "all of it at cross_coupling_at"}, {"stages", "each stage's where it is"}},
           "where the anticipated cross-coupling acts in level 1");
  model::Location at;
  if (v.location(optional("cross_coupling_at", "midway between the outer journals"), at,
                 "apply = \"point\": where"))
    s.cross_coupling_at = at;
  v.table("limits", s.limits, "what is asked for, and where that comes from");
  if (!v.clean()) return;
  if (!trip) s.trip = s.operating[1];
  if (s.trip < s.operating[1])
    return v.error("E21", "trip_speed", "the trip speed is below the highest operating speed");
  s.min_speed = given ? range[0] : 0.1 * s.operating[0];
  // peaks up to the largest margin that may be asked for above the operating speeds are to be seen
  const double furthest = 1.03 + s.limits.margin_above + s.limits.margin_factor;
  s.max_speed = given ? range[1] : std::max(1.25 * s.trip, furthest * s.operating[1]);
  if (s.min_speed >= s.max_speed)
    return v.error("E21", "response_speed", "the response ends below its start");
  if (given && (s.max_speed < s.trip || s.min_speed > s.operating[0]))
    return v.error("E26", "response_speed",
                   "the response does not reach from the lowest operating speed to the trip speed");
  if (!check_mode_numbers(v, s.modes)) return;
  check_names(v, s.sets, "set", "sets");
  for (const model::ApiStage& stage : s.stages)
    if (s.at_stages && !stage.at)
      return v.error("E05", "apply", fmt::format("stage '{}' has no place 'at'", stage.name));
  if (s.at_stages && s.cross_coupling_at)
    v.error("E26", "cross_coupling_at", "'cross_coupling_at' belongs to apply = \"point\"");
}

void describe(Visitor& v, model::VibrationZones& z) {
  v.quantities(
      "constants", z.constants, "", positive, 3,
      "borders A/B, B/C, C/D in um peak to peak, times the square root of the speed in rpm");
  v.quantities(optional("limits", "by constants"), z.limits, "um", positive, 3,
               "the borders themselves, peak to peak, at every speed");
  v.text("source", z.source, "where the borders come from");
  const auto ascending = [&](const char* key, const std::vector<double>& x) {
    if (v.clean() && !std::is_sorted(x.begin(), x.end()))
      v.error("E21", key, "the borders of the zones do not increase");
  };
  ascending("constants", z.constants);
  ascending("limits", z.limits);
}

void describe(Visitor& v, model::BalancePlane& p) {
  v.text(required("name"), p.name, "name in the tables");
  v.location(required("at"), p.at, "place on the shaft");
}

void describe(Visitor& v, model::MeasuredVector& m) {
  v.text(required("run"), m.run, "name of the run");
  v.text(required("probe"), m.probe, "a probe of the deck");
  v.quantity("angle", m.angle, "deg", any, "direction of the sensor from +y towards +z");
  v.quantity(required("speed"), m.speed, "rpm", positive, "one of the step's speeds");
  v.quantity(required("amplitude"), m.amplitude, "um", not_negative, "of the vibration at 1x");
  v.quantity(required("phase"), m.phase_lag, "deg", any, "its lag behind the rotor mark");
}

void describe(Visitor& v, model::TrialRun& t) {
  v.text(required("run"), t.run, "run of the measured vectors");
  v.text(required("plane"), t.plane, "plane that the trial mass is in");
  v.quantity(required("amount"), t.amount, "g.mm", positive, "its unbalance");
  v.quantity("phase", t.phase, "deg", any,
             "its angle from the rotor mark, with the angle of the deck");
}

void describe(Visitor& v, model::BalancingStep& s) {
  v.choice("method", s.method,
           {{"influence", "all vectors at once, in the least-squares sense"},
            {"modal", "mode by mode: corrections that leave the other modes as they are"}},
           "how corrections are found");
  v.list(required("plane"), s.planes, "planes for correction masses");
  v.quantities(required("speeds"), s.speeds, "rpm", positive, -1,
               "balancing speeds; method = \"modal\": one a mode, in their order");
  v.quantities(optional("modes", "of method = \"modal\""), s.modes, "", positive, -1,
               "numbers of the undamped forward modes, 1 the lowest");
  v.table(
      optional("measured", "from the unbalances of the deck"),
      [&](Visitor& w) { w.rows(rows_of(s.measured), true, "measured vectors, one a row"); },
      "measured vibration vectors");
  v.choice("amplitude", s.peak_to_peak, {{"0-peak", ""}, {"peak-to-peak", ""}},
           "convention of the measured amplitudes");
  v.text(optional("initial_run", "of measured vectors: the first"), s.initial,
         "the run without trial masses");
  v.list(optional("trial", "influence coefficients of the model"), s.trials,
         "trial runs: influence coefficients from measured vectors");
  if (!v.clean()) return;
  check_names(v, s.planes, "plane", "planes");
  if (s.planes.empty() || s.speeds.empty())
    return v.error("E20", s.planes.empty() ? "plane" : "speeds",
                   "balancing needs at least one plane and one speed");
  if (!check_mode_numbers(v, s.modes)) return;
  const bool modal = s.method == model::BalancingStep::Method::modal;
  if (modal != !s.modes.empty())
    return v.error(
        modal ? "E05" : "E26", modal ? nullptr : "modes",
        modal ? "method = \"modal\" lacks 'modes'" : "'modes' belongs to method = \"modal\"");
  if (modal && (s.modes.size() != s.speeds.size() || s.modes.size() > s.planes.size()))
    return v.error(
        "E26", "modes",
        fmt::format("{} modes, {} speeds, {} planes: a mode takes a speed of its own and "
                    "a plane",
                    s.modes.size(), s.speeds.size(), s.planes.size()));
  if (!s.trials.empty() && s.measured.empty())
    return v.error("E26", "trial", "trial runs go with measured vectors", "[step.measured]");
  if (s.measured.empty() && !s.initial.empty())
    return v.error("E26", "initial_run", "'initial_run' belongs to measured vectors");
  if (!s.trials.empty() && s.trials.size() != s.planes.size())
    return v.error(
        "E26", "trial",
        fmt::format("{} trial runs for {} planes: one for each", s.trials.size(), s.planes.size()));
  for (const model::TrialRun& t : s.trials) {
    const auto same = [&](const model::TrialRun& other) { return other.plane == t.plane; };
    if (std::count_if(s.trials.begin(), s.trials.end(), same) > 1)
      return v.error("E26", "trial",
                     fmt::format("two trial runs have their mass in plane '{}', so that another "
                                 "plane has none",
                                 t.plane),
                     "one for each plane");
  }
  if (s.initial.empty() && !s.measured.empty()) s.initial = s.measured.front().run;
}

void describe(Visitor& v, model::ApiHarmonic& h) {
  v.number(required("order"), h.order, positive, "excitations a revolution of its shaft");
  v.quantity(required("amplitude"), h.amplitude, "N.m", not_negative, "0 to peak");
  v.quantity("phase", h.phase, "deg", any, "amplitude cos(order angle + phase)");
}

namespace {

struct CrankRow {
  double angle = 0, torque = 0;
};

void describe(Visitor& v, CrankRow& r) {
  v.quantity(required("angle"), r.angle, "deg", not_negative, "of the crank");
  v.quantity(required("torque"), r.torque, "N.m", any, "torque there");
}

/// A crank-effort diagram, and from it the orders of the torque.
void describe_crank(Visitor& v, model::ApiTorque& t) {
  int turns = 0, harmonics = 24;
  std::vector<CrankRow> rows;
  v.choice("turns", turns, {{"one", "two-stroke engines, compressors"}, {"two", "four-stroke"}},
           "turns of a cycle");
  v.integer("harmonics", harmonics, between(1, 200), "multiples of the cycle that are kept");
  v.rows(rows_of(rows), true, "torque against angle over a cycle: straight lines, periodic");
  if (!v.clean()) return;
  if (rows.size() < 3) return v.error("E20", "rows", "a cycle needs at least three angles");
  const int of_cycle = turns + 1;
  const double cycle = two_pi * of_cycle;
  std::vector<double> angle, torque;
  for (const CrankRow& r : rows) {
    if (!angle.empty() && !(r.angle > angle.back()))
      return v.error("E21", "rows", "the angles do not increase");
    angle.push_back(r.angle);
    torque.push_back(r.torque);
  }
  if (!(angle.back() < angle.front() + cycle))
    return v.error("E21", "rows",
                   fmt::format("the angles span a cycle of {} deg or more", 360 * of_cycle),
                   "the last row is not the first one again");
  for (int k = 1; k <= harmonics; ++k) {
    const Complex c = periodic_coefficient(angle, torque, cycle, k);
    t.harmonics.push_back({static_cast<double>(k) / of_cycle, 2.0 * std::abs(c), std::arg(c)});
  }
}

}  // namespace

void describe(Visitor& v, model::ApiTorque& t) {
  v.text(required("name"), t.name, "name in the tables");
  v.location(required("at"), t.at, "where it acts, on which shaft");
  const bool order = v.number(optional("order", "frequency"), t.order, any,
                              "excitations a revolution of the shaft it acts on");
  const bool frequency = v.quantity(
      optional("frequency", "order"), t.frequency, "rad/s", positive,
      "of one that does not follow the speed (Hz, rpm or rad/s); with 'order' the excitation has "
      "|frequency - order speed|: twice the slip of a motor that starts, sidebands of a converter");
  const bool amplitude = v.quantity(optional("amplitude", "harmonics or crank"), t.amplitude, "N.m",
                                    positive, "of the torque, 0 to peak");
  const bool harmonics = v.table(
      optional("harmonics", "none"),
      [&](Visitor& w) { w.rows(rows_of(t.harmonics), true, "orders, one a row"); },
      "several orders at once: of converters, engines, reciprocating machines");
  const bool crank = v.table(
      optional("crank", "none"), [&](Visitor& w) { describe_crank(w, t); },
      "the same from the torque against the angle of the crank");
  if (!v.clean()) return;
  if (int(amplitude) + int(harmonics) + int(crank) != 1)
    return v.error(
        amplitude || harmonics || crank ? "E26" : "E05",
        harmonics ? "harmonics"
        : crank   ? "crank"
                  : nullptr,
        fmt::format("torque '{}' needs one of 'amplitude', 'harmonics' and 'crank'", t.name));
  if (!amplitude && (order || frequency))
    return v.error("E26", order ? "order" : "frequency",
                   "'harmonics' and 'crank' have orders of their own");
  if (!amplitude) return;
  if (!order && !frequency)
    return v.error("E05", nullptr,
                   fmt::format("torque '{}' has neither 'order' nor 'frequency'", t.name));
  if (!frequency && !(t.order > 0))
    v.error("E14", "order", "the order must be positive",
            "a negative one goes with 'frequency': frequency + |order| speed");
}

void describe(Visitor& v, model::ApiEvent& e) {
  e.where = v.where();
  v.text(required("name"), e.name, "name in the tables");
  v.step(required("step"), e.step, "an earlier transient step with a table 'torques'");
  v.number("times", e.times, positive, "how often it happens in the life of the train");
}

void describe(Visitor& v, model::ApiTorsionalStep& s) {
  v.text("standard", s.standard, "name of the standard in the tables");
  describe_operating(v, s.operating);
  v.integer("modes", s.modes, between(1, 10000),
            "torsional modes, from the lowest frequency; more where an excitation comes near them");
  v.quantities("multiples", s.multiples, "", positive, -1,
               "multiples of the speed of each shaft that the modes keep away from");
  v.quantities(optional("orders", "none"), s.orders, "", positive, -1,
               "orders of the reference speed besides");
  v.quantity(optional("line_frequency", "no motor or generator"), s.line_frequency, "rad/s",
             positive, "of the electric net (Hz)");
  v.quantities("line_multiples", s.line_multiples, "", positive, -1,
               "multiples of the line frequency");
  const bool margin =
      v.number("margin", s.margin, fraction,
               "share of the frequency of an excitation that modes keep away from it");
  v.list(optional("torque", "none"), s.torques, "torques whose response is looked at");
  v.number("concentration", s.concentration, at_least(1), "factor on shear stresses");
  v.list(optional("event", "none"), s.events,
         "transients: starts, short circuits; their stresses and the fatigue they cause");
  const bool damage = v.number("damage_limit", s.damage_limit, positive,
                               "largest sum of the damages of all events, each times 'times'");
  const bool stress = v.quantity(optional("stress_limit", "none"), s.stress_limit, "MPa", positive,
                                 "largest shear stress, 0 to peak");
  describe_source(v, s.source);
  if (margin) s.given.emplace_back("margin");
  if (stress) s.given.emplace_back("stress_limit");
  if (damage) s.given.emplace_back("damage_limit");
  if (v.clean()) check_names(v, s.torques, "torque", "torques");
  if (v.clean()) check_names(v, s.events, "event", "events");
}

}  // namespace whirl::deck
