// [[drive]]: what turns a shaft.
#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <fmt/format.h>

#include <cmath>

namespace whirl::deck {
namespace {

void describe_speed(Visitor& v, model::Drive& d) {
  LawPtr speed;
  double angle = 0;
  describe_law(v, required("speed"), speed, "rpm",
               "speed of the station, constant or a law of time; held exactly, without a spring");
  v.quantity("angle", angle, "deg", any,
             "angle at time 0; a step that goes on from another turns on from the angle there");
  d.law = model::PrescribedSpin{};
  if (v.clean() && speed)
    d.law = model::PrescribedSpin{make_angle_of_speed(speed, angle), true, angle != 0.0};
}

void describe_angle(Visitor& v, model::Drive& d) {
  LawPtr angle;
  describe_law(
      v, required("angle"), angle, "rad",
      "angle of the station against time; held exactly, in a step that goes on from another "
      "from the angle there");
  d.law = model::PrescribedSpin{angle, false, true};
}

struct SpeedTorque {
  double speed = 0, torque = 0;
};

void describe(Visitor& v, SpeedTorque& r) {
  v.quantity(required("speed"), r.speed, "rpm", any, "spin of the station");
  v.quantity(required("torque"), r.torque, "N.m", any, "torque at that spin");
}

struct SpeedAmplitude {
  double speed = 0, amplitude = 0;
};

void describe(Visitor& v, SpeedAmplitude& r) {
  v.quantity(required("speed"), r.speed, "rpm", any, "spin of the station");
  v.quantity(required("amplitude"), r.amplitude, "N.m", not_negative, "pulsation, 0 to peak");
}

/// Rows against speed, which increases.
template <class Row, class Add>
ListBody speed_rows(const std::vector<double>& speeds, Add add) {
  return {[&speeds, add](Visitor& w) {
            Row r;
            describe(w, r);
            if (w.clean() && !speeds.empty() && !(r.speed > speeds.back()))
              w.error("E21", "speed",
                      fmt::format("the speeds do not increase: {} after {}",
                                  units::display(r.speed, "rpm"),
                                  units::display(speeds.back(), "rpm")));
            add(r);
          },
          [](Visitor& w) {
            Row r;
            describe(w, r);
          }};
}

void describe_pulsation(Visitor& v, model::TorqueCurve::Pulsation& p) {
  v.quantity(required("synchronous"), p.synchronous, "rpm", positive, "synchronous speed");
  v.number("poles", p.poles, between(2, 1000), "number of poles, 2 p");
  v.quantity("phase", p.phase, "deg", any, "at time 0 and angle 0");
  v.rows(speed_rows<SpeedAmplitude>(p.speed,
                                    [&p](const SpeedAmplitude& r) {
                                      p.speed.push_back(r.speed);
                                      p.amplitude.push_back(r.amplitude);
                                    }),
         true, "amplitude against speed: straight lines between the rows, constant outside");
  if (v.clean() && std::fmod(p.poles, 2.0) != 0.0)
    v.error("E14", "poles", fmt::format("{:g} is no number of poles", p.poles),
            "two, four, six, ...");
}

/// Torques of motors against speed and slip; false: none of them is given.
bool describe_motors(Visitor& v, model::TorqueCurve& t) {
  const bool induction = v.table(
      optional("induction", "none"),
      [&](Visitor& w) {
        model::TorqueCurve::Induction m;
        w.quantity(required("breakdown"), m.breakdown, "N.m", positive, "breakdown torque");
        w.number("slip_breakdown", m.slip_breakdown, Range{0, 1, true, false}, "slip at breakdown");
        w.quantity(required("synchronous"), m.synchronous, "rpm", positive, "synchronous speed");
        if (w.clean()) t.induction = m;
      },
      "induction motor, Kloss: 2 breakdown/(x/x_b + x_b/x) with the slip x = 1 - s/synchronous");
  const bool pulsation = v.table(
      optional("pulsation", "none"),
      [&](Visitor& w) {
        model::TorqueCurve::Pulsation p;
        describe_pulsation(w, p);
        if (w.clean()) t.pulsation = p;
      },
      "pulsating torque of a salient-pole synchronous motor that runs up, at twice the slip "
      "frequency: amplitude cos(poles (synchronous t - angle) + phase)");
  const bool dc = v.table(
      optional("dc", "none"),
      [&](Visitor& w) {
        model::TorqueCurve::DcLine m;
        w.quantity(required("stall"), m.stall, "N.m", positive, "torque at standstill");
        w.quantity(required("no_load_speed"), m.no_load_speed, "rpm", positive,
                   "speed without torque");
        if (w.clean()) t.dc = m;
      },
      "straight torque line: stall (1 - s/no_load_speed)");
  const bool power = v.table(
      optional("constant_power", "none"),
      [&](Visitor& w) {
        model::TorqueCurve::ConstantPower m;
        w.quantity(required("power"), m.power, "kW", any, "power; negative brakes");
        w.quantity(required("max_torque"), m.max_torque, "N.m", positive, "limit near standstill");
        if (w.clean()) t.power = m;
      },
      "torque power/s, limited to max_torque: a motor has max_torque from below zero up to the "
      "speed "
      "at which it has its power, a brake (negative power) opposes the spin either way");
  return induction || pulsation || dc || power;
}

void describe_torque(Visitor& v, model::Drive& d) {
  model::TorqueCurve t;
  v.choice(
      "kind", d.kind,
      {{"spin", "acts on the axial angle, like a constant-velocity joint: along (e+d)/(1+e.d)"},
       {"fixed_direction", "a moment whose direction stays that of the undeformed axis"}},
      "what the torque does when the shaft tilts");
  describe_law(v, optional("torque", "0"), t.of_time, "N.m", "torque, constant or a law of time");
  const ListBody rows = speed_rows<SpeedTorque>(t.speed, [&t](const SpeedTorque& r) {
    t.speed.push_back(r.speed);
    t.torque.push_back(r.torque);
  });
  const bool table = v.rows(
      rows, false, "torque against speed: straight lines between the rows, constant outside");
  const bool load = v.table(
      optional("load", "none"),
      [&](Visitor& w) {
        w.quantity("constant", t.constant, "N.m", not_negative, "dry friction, opposes the spin");
        w.quantity("viscous", t.viscous, "N.m.s/rad", not_negative, "times the spin");
        w.quantity("quadratic", t.quadratic, "N.m.s^2/rad^2", not_negative,
                   "times the spin squared (fan, windage)");
      },
      "torque that opposes the spin: -(constant sign(s) + viscous s + quadratic s|s|), the sign "
      "smoothed below 0.5 rpm");
  const bool motor = describe_motors(v, t);
  const bool governor = v.table(
      optional("governor", "none"),
      [&](Visitor& w) {
        model::TorqueCurve::Governor m;
        w.quantity(required("target"), m.target, "rpm", any, "speed it steers to");
        w.quantity(required("kp"), m.kp, "N.m.s/rad", not_negative, "proportional gain");
        w.quantity("ki", m.ki, "N.m/rad", not_negative, "integral gain");
        w.quantity(optional("max_torque", "no limit"), m.max_torque, "N.m", positive,
                   "limit of its torque");
        if (w.clean()) t.governor = m;
      },
      "speed controller: kp (target - s) + ki times the integral of it, from the beginning of the "
      "step in which it begins to act and on through those that go on from there");
  const bool brake =
      describe_law(v, optional("brake", "none"), t.brake, "N.m",
                   "magnitude of a torque that opposes the spin, constant or a law of time");
  if (v.clean() && !t.of_time && !table && !load && !motor && !governor && !brake)
    v.error("E05", nullptr, fmt::format("drive '{}' has no torque", d.name),
            "give torque, columns and rows, load, induction, pulsation, dc, constant_power, "
            "governor or brake; those given are added");
  d.law = std::move(t);
}

}  // namespace

void describe(Visitor& v, model::Drive& d) {
  v.name(d, "drive");
  v.location(required("at"), d.at,
             "place on a shaft: \"section:start\", \"shaft:end\", \"1.14 m\"");
  v.step(optional("step", "all steps; those that are no motion in time have their own speed"),
         d.step, "the step it belongs to: it acts in no other one");
  const Alternative kinds[] = {
      {"speed", "prescribed speed", [&](Visitor& w) { describe_speed(w, d); }},
      {"angle", "prescribed angle", [&](Visitor& w) { describe_angle(w, d); }},
      {"torque", "torque of time and speed; the speed is then an unknown",
       [&](Visitor& w) { describe_torque(w, d); }},
  };
  v.alternatives(required("type"), kinds, "what is prescribed");
}

}  // namespace whirl::deck
