// The decks of key_pairs.hpp, most of them by what they change in another.
#pragma once
#include <map>
#include <stdexcept>
#include <string>

namespace whirl::test {

using Decks = std::map<std::string, std::string>;

/// The deck `base` with the text `from` exchanged for `to`.
inline std::string changed(const Decks& decks, const std::string& base, const std::string& from,
                           const std::string& to) {
  std::string deck = decks.at(base);
  const std::size_t place = deck.find(from);
  if (place == std::string::npos) throw std::runtime_error("'" + base + "' has no " + from);
  return deck.replace(place, from.size(), to);
}

/// 10 kg 100 mm from either end of a rigid shaft: `rest` is its supports, loads and steps, `held`
/// what the place of the mass does not do; nothing: free.
inline std::string body(const std::string& rest, const std::string& held = R"("x", "ry", "rz")") {
  const std::string guide =
      "[[bearing]]\nname = \"guide\"\nat = \"mass\"\ntype = \"rigid\"\ndirections = [" + held +
      "]\n";
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 100, true], ["right", 100, true]]
[[disk]]
name = "mass"
at = "left:end"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
)" + (held.empty() ? "" : guide) +
         rest + "[output]\nreport = false\n";
}

/// decks: those of written_decks.hpp and "bar", on which some of them build.
inline void add_key_decks(Decks& decks) {
  const auto changed = [&](const char* base, const char* from, const char* to) {
    return test::changed(decks, base, from, to);
  };
  decks["bar by rows"] = changed("bar", R"([[shaft.section]]
name = "a"
length = "200 mm"
od = "50 mm"
)",
                                 R"(columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 200, 50]]
)");
  decks["bar pulled"] = changed("bar", R"(force = ["0 N", "1 kN", "0 N"]
)",
                                R"(force = ["100 kN", "0 N", "0 N"]
)");
  decks["bar pulled by rows"] = changed("bar by rows", R"(force = ["0 N", "1 kN", "0 N"]
)",
                                        R"(force = ["100 kN", "0 N", "0 N"]
)");
  decks["bar of known strength"] = changed("bar", R"(expansion = "1e-5 1/K"
)",
                                           R"(expansion = "1e-5 1/K"
yield = "300 MPa"
)");
  decks["bar by constants"] = changed("bar", R"([[bearing]]
name = "wall"
at = "r/0 mm"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/200 mm"
force = ["0 N", "1 kN", "0 N"]
)",
                                      R"([shaft.section.constants]
EA = "4e8 N"
kGA = "1e8 N"
GJ = "5e4 N.m^2"
EI = "6e4 N.m^2"
rhoA = "16 kg/m"
rhoI = "0.002 kg.m"
rhoIp = "0.004 kg.m"
[[bearing]]
name = "wall"
at = "r/0 mm"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/200 mm"
force = ["100 N", "1 kN", "0 N"]
moment = ["100 N.m", "0 N.m", "0 N.m"]
)");
  decks["bar by constants, stretching"] = changed("bar", R"([[bearing]]
name = "wall"
at = "r/0 mm"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/200 mm"
force = ["0 N", "1 kN", "0 N"]
[[step]]
name = "st"
type = "static"
)",
                                                  R"(min_elements = 40
[shaft.section.constants]
EA = "4e8 N"
kGA = "1e8 N"
GJ = "5e4 N.m^2"
EI = "6e4 N.m^2"
rhoA = "16 kg/m"
rhoI = "0.002 kg.m"
rhoIp = "0.004 kg.m"
[[bearing]]
name = "wall"
at = "r/0 mm"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/200 mm"
force = ["0 N", "0 N", "0 N"]
[[step]]
name = "m"
type = "modal"
modes = 1
motion = "axial"
)");
  decks["bar by constants, twisting"] = changed("bar by constants, stretching", R"(motion = "axial"
)",
                                                R"(motion = "torsional"
)");
  decks["bar by constants, bending"] = changed("bar by constants, stretching", R"(motion = "axial"
)",
                                               R"(motion = "lateral"
)");
  decks["rectangle twisted"] = changed("short rectangle", R"(force = ["0 N", "1 kN", "1 kN"]
)",
                                       R"(moment = ["100 N.m", "0 N.m", "0 N.m"]
)");
  decks["body on springs"] = body(R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
krr = "1e4 N.m/rad"
krxx = "1e4 N.m/rad"
[[step]]
name = "st"
type = "static"
)",
                                  R"()");
  decks["pushed on a spring"] = body(R"([[bearing]]
name = "weak"
at = "mass"
type = "linear"
kyy = "1e5 N/m"
kzz = "1e5 N/m"
krxx = "100 N.m/rad"
[[bearing]]
name = "spring"
at = "mass"
type = "nonlinear_spring"
direction = "y"
shape = "polynomial"
coefficients = ["0 N", "1e6 N/m"]
[[load]]
at = "mass"
force = ["0 N", "110 N", "110 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "st"
type = "static"
)");
  decks["pushed on a stop"] = changed("pushed on a spring", R"(shape = "polynomial"
coefficients = ["0 N", "1e6 N/m"]
)",
                                      R"(shape = "one_sided"
gap = "0.5 mm"
stiffness = "1e6 N/m"
)");
  decks["pushed through play"] = changed("pushed on a spring", R"(shape = "polynomial"
coefficients = ["0 N", "1e6 N/m"]
[[load]]
at = "mass"
force = ["0 N", "110 N", "110 N"]
)",
                                         R"(shape = "clearance"
gap = "0.5 mm"
stiffness = "1e6 N/m"
[[load]]
at = "mass"
force = ["0 N", "-110 N", "0 N"]
)");
  decks["pushed on a table"] = changed("pushed on a spring", R"(shape = "polynomial"
coefficients = ["0 N", "1e6 N/m"]
[[load]]
at = "mass"
force = ["0 N", "110 N", "110 N"]
)",
                                       R"(shape = "table"
columns = ["deflection[mm]", "force[N]"]
rows = [[-1, -300], [0, 0], [1, 300], [2, 2300]]
interpolation = "linear"
[[load]]
at = "mass"
force = ["0 N", "800 N", "0 N"]
)");
  decks["damped"] = body(R"([[bearing]]
name = "d"
at = "mass"
type = "nonlinear_spring"
direction = "y"
shape = "polynomial"
coefficients = ["0 N"]
damping = "100 N.s/m"
[[probe]]
name = "P"
at = "mass"
[[initial]]
velocity = ["0 m/s", "1 m/s", "0 m/s"]
[[step]]
name = "t"
type = "transient"
duration = "50 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
)");
  decks["turned on a spring"] = body(R"([[bearing]]
name = "weak"
at = "mass"
type = "linear"
krr = "1e3 N.m/rad"
krxx = "1e3 N.m/rad"
[[bearing]]
name = "spring"
at = "mass"
type = "nonlinear_angular_spring"
direction = "rz"
shape = "polynomial"
coefficients = ["0 N.m", "1e4 N.m/rad"]
[[load]]
at = "mass"
force = ["0 N", "0 N", "0 N"]
moment = ["0 N.m", "11 N.m", "11 N.m"]
[[step]]
name = "st"
type = "static"
)",
                                     R"("x", "y", "z")");
  decks["turned on a spring about one axis"] =
      changed("turned on a spring", R"(moment = ["0 N.m", "11 N.m", "11 N.m"]
)",
              R"(moment = ["0 N.m", "0 N.m", "11 N.m"]
)");
  decks["turned on a stop"] = changed("turned on a spring about one axis", R"(shape = "polynomial"
coefficients = ["0 N.m", "1e4 N.m/rad"]
)",
                                      R"(shape = "one_sided"
gap = "0.05 deg"
stiffness = "1e4 N.m/rad"
)");
  decks["turned through play"] =
      changed("turned on a spring about one axis", R"(shape = "polynomial"
coefficients = ["0 N.m", "1e4 N.m/rad"]
[[load]]
at = "mass"
force = ["0 N", "0 N", "0 N"]
moment = ["0 N.m", "0 N.m", "11 N.m"]
)",
              R"(shape = "clearance"
gap = "0.05 deg"
stiffness = "1e4 N.m/rad"
[[load]]
at = "mass"
force = ["0 N", "0 N", "0 N"]
moment = ["0 N.m", "0 N.m", "-11 N.m"]
)");
  decks["turned on a table"] = changed("turned on a spring about one axis", R"(shape = "polynomial"
coefficients = ["0 N.m", "1e4 N.m/rad"]
)",
                                       R"(shape = "table"
interpolation = "linear"
columns = ["deflection[deg]", "force[N.m]"]
rows = [[-1, -3], [0, 0], [0.1, 3], [0.2, 23]]
)");
  decks["twist damped"] = changed("ball bearing at its node", R"(name = "ball"
at = "mass"
type = "ball"
balls = 12
ball_diameter = "10 mm"
pitch_diameter = "50 mm"
contact_angle = "25 deg"
preload = "300 N"
[output]
report = false
[[step]]
name = "st"
type = "static"
)",
                                  R"(name = "d"
at = "mass"
type = "nonlinear_angular_spring"
direction = "rx"
shape = "polynomial"
coefficients = ["0 N.m"]
damping = "0.5 N.m.s/rad"
[[probe]]
name = "P"
at = "mass"
[[initial]]
angular_velocity = ["10 rad/s", "0 rad/s", "0 rad/s"]
[[step]]
name = "t"
type = "transient"
duration = "0.3 s"
start = "rest"
[step.integrator]
tolerance = 1e-8
[output]
report = false
quantities = ["rotation"]
)");
  decks["on a spring block"] = body(R"([[bearing]]
name = "b"
at = "mass"
type = "spring_block"
C1 = "1e6 N/m"
C2 = "1e4 N.m/rad"
[[bearing]]
name = "s"
at = "mass"
type = "rigid"
directions = ["rx"]
[[load]]
at = "mass"
force = ["0 N", "100 N", "0 N"]
moment = ["0 N.m", "0 N.m", "5 N.m"]
[[step]]
name = "st"
type = "static"
)",
                                    R"()");
  decks["ball bearing pushed"] = body(R"([[bearing]]
name = "ball"
at = "mass"
type = "ball"
balls = 12
ball_diameter = "10 mm"
pitch_diameter = "50 mm"
contact_angle = "25 deg"
stiffness = "1e10 N/m^1.5"
[[load]]
at = "mass"
force = ["1000 N", "0 N", "0 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "st"
type = "static"
)",
                                      R"("y", "z", "rx", "ry", "rz")");
  decks["ball bearing beside a spring"] =
      changed("ball bearing pushed", R"(directions = ["y", "z", "rx", "ry", "rz"]
[[bearing]]
)",
              R"(directions = ["y", "z", "rx", "ry", "rz"]
[[bearing]]
at = "mass"
type = "linear"
kxx = "1e7 N/m"
[[bearing]]
)");
  decks["deep groove pushed"] = changed("ball bearing pushed", R"(contact_angle = "25 deg"
)",
                                        R"(clearance = "0 um"
)");
  decks["ball bearing held"] = changed("ball bearing at its node", R"(preload = "300 N"
)",
                                       R"(preload = "300 N"
stiffness = "1e10 N/m^1.5"
)");
  decks["ball bearing damped"] = body(R"([[bearing]]
name = "ball"
at = "mass"
type = "ball"
balls = 12
ball_diameter = "10 mm"
pitch_diameter = "50 mm"
clearance = "20 um"
stiffness = "1e10 N/m^1.5"
c_radial = "1e4 N.s/m"
[[probe]]
name = "P"
at = "mass"
[[load]]
at = "mass"
force = ["0 N", "100 N", "0 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "t"
type = "transient"
duration = "1.5 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
)",
                                      R"("x", "rx", "ry", "rz")");
  decks["roller estimate"] = body(R"([[bearing]]
name = "r"
at = "mass"
type = "roller_estimate"
rollers = 12
roller_length = "15 mm"
load = "1000 N"
[[load]]
at = "mass"
force = ["0 N", "100 N", "50 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "st"
type = "static"
)");
  decks["ball estimate"] = changed("roller estimate", R"(type = "roller_estimate"
rollers = 12
roller_length = "15 mm"
)",
                                   R"(type = "ball_estimate"
balls = 12
ball_diameter = "15 mm"
)");
  decks["roller estimate pushed along"] = body(R"([[bearing]]
name = "r"
at = "mass"
type = "roller_estimate"
rollers = 12
roller_length = "15 mm"
load = "1000 N"
kxx = "1e6 N/m"
[[load]]
at = "mass"
force = ["100 N", "0 N", "0 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "st"
type = "static"
)",
                                               R"("ry", "rz")");
  decks["roller estimate shaken"] = body(R"([[bearing]]
name = "r"
at = "mass"
type = "roller_estimate"
rollers = 12
roller_length = "15 mm"
load = "1000 N"
c_radial = "1e4 N.s/m"
[[probe]]
name = "P"
at = "mass"
[[step]]
name = "h"
type = "harmonic_response"
frequency = { values = ["200 Hz"] }
[[step.force]]
at = "mass"
force = ["0 N", "100 N", "0 N"]
)");
  decks["ball estimate pushed along"] =
      changed("roller estimate pushed along", R"(type = "roller_estimate"
rollers = 12
roller_length = "15 mm"
)",
              R"(type = "ball_estimate"
balls = 12
ball_diameter = "15 mm"
)");
  decks["ball estimate shaken"] = changed("roller estimate shaken", R"(type = "roller_estimate"
rollers = 12
roller_length = "15 mm"
)",
                                          R"(type = "ball_estimate"
balls = 12
ball_diameter = "15 mm"
)");
  decks["unbalanced body"] = body(R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
krr = "2e4 N.m/rad"
[[probe]]
name = "P"
at = "mass"
[[probe]]
name = "E"
at = "right:end"
[[unbalance]]
at = "mass"
amount = "1 kg.mm"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["1000 rpm"] }
)",
                                  R"("x")");
  decks["graded body"] = changed("unbalanced body", R"(amount = "1 kg.mm"
)",
                                 R"(grade = "G2.5"
grade_speed = "3000 rpm"
)");
  decks["skewed body"] = body(R"(skew = "0.1 deg"
skew_phase = "0 deg"
[[bearing]]
name = "guide"
at = "mass"
type = "rigid"
directions = ["x"]
[[bearing]]
name = "spring"
at = "mass"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
krr = "2e4 N.m/rad"
[[probe]]
name = "P"
at = "mass"
[[probe]]
name = "E"
at = "right:end"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["1000 rpm"] }
)",
                              R"()");
  decks["loaded in time"] = body(R"([[drive]]
at = "rotor/0 mm"
type = "speed"
speed = "600 rpm"
[[probe]]
name = "P"
at = "mass"
[[load]]
at = "mass"
force = ["0 N", "10 N", "0 N"]
[[step]]
name = "t"
type = "transient"
duration = "50 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
)");
  decks["turned from an angle"] = changed("loaded in time", R"(force = ["0 N", "10 N", "0 N"]
)",
                                          R"(frame = "rotating"
force = ["0 N", "10 N", "0 N"]
)");
  decks["swings"] = body(R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e5 N/m"
kzz = "1e5 N/m"
[[probe]]
name = "P"
at = "mass"
[[initial]]
displacement = ["0 mm", "1 mm", "0 mm"]
[[event]]
name = "far"
type = "amplitude"
at = "mass"
value = "0.5 mm"
[[step]]
name = "t"
type = "transient"
duration = "60 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
)");
  decks["swings apart"] = body(R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
krr = "1e4 N.m/rad"
kyy = "1e5 N/m"
kzz = "1e5 N/m"
[[probe]]
name = "P"
at = "mass"
[[initial]]
displacement = ["0 mm", "1 mm", "0 mm"]
tilt = ["0 deg", "0.5 deg"]
[[event]]
name = "far"
type = "amplitude"
at = "right:end"
value = "0.5 mm"
[[step]]
name = "t"
type = "transient"
duration = "60 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
)",
                               R"("x", "ry")");
  decks["hangs"] = body(R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e5 N/m"
kzz = "1e5 N/m"
krxx = "1000 N.m/rad"
[[probe]]
name = "P"
at = "mass"
[[load]]
at = "mass"
force = ["0 N", "100 N", "0 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "t"
type = "transient"
duration = "20 ms"
[step.integrator]
tolerance = 1e-8
)");
  decks["swings in a mode"] = body(R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e5 N/m"
kzz = "4e5 N/m"
krxx = "9000 N.m/rad"
[[probe]]
name = "P"
at = "mass"
[[step]]
name = "t"
type = "transient"
start = "mode"
mode_amplitude = "0.1 mm"
duration = "20 ms"
[step.integrator]
tolerance = 1e-8
)");
  decks["swings, row by row"] = changed("swings", R"(report = false
)",
                                        R"(report = false
every = "0.1 ms"
)");
  decks["spins up"] = changed("ball bearing at its node", R"([[bearing]]
name = "ball"
at = "mass"
type = "ball"
balls = 12
ball_diameter = "10 mm"
pitch_diameter = "50 mm"
contact_angle = "25 deg"
preload = "300 N"
[output]
report = false
[[step]]
name = "st"
type = "static"
)",
                              R"([[drive]]
name = "motor"
at = "rotor/0 mm"
type = "torque"
torque = "1 N.m"
[[probe]]
name = "P"
at = "mass"
[[step]]
name = "t"
type = "transient"
duration = "1 s"
start = "rest"
[step.integrator]
tolerance = 1e-8
[output]
report = false
every = "1 ms"
quantities = ["speed", "torque"]
)");
  decks["governed"] = changed("spins up", R"(torque = "1 N.m"
)",
                              R"(governor = { target = "100 rad/s", kp = "0.2 N.m.s/rad" }
)");
  decks["motor"] = changed("spins up", R"(torque = "1 N.m"
)",
                           R"(induction = { breakdown = "4 N.m", synchronous = "100 rad/s" }
)");
  decks["dc motor"] = changed("spins up", R"(torque = "1 N.m"
)",
                              R"(dc = { stall = "2 N.m", no_load_speed = "30 rad/s" }
)");
  decks["fan"] = changed("spins up", R"(torque = "1 N.m"
)",
                         R"(torque = "1 N.m"
load = { viscous = "0.01 N.m.s/rad", quadratic = "0.001 N.m.s^2/rad^2", constant = "0 N.m" }
)");
  decks["ramped"] =
      changed("spins up", R"(torque = "1 N.m"
)",
              R"(torque = { type = "ramp", time = ["0 s", "1 s"], value = ["0 N.m", "2 N.m"] }
)");
  decks["smoothed"] =
      changed("spins up", R"(torque = "1 N.m"
)",
              R"(torque = { type = "smooth", time = ["0 s", "1 s"], value = ["0 N.m", "2 N.m"] }
)");
  decks["swung"] = changed(
      "spins up", R"(torque = "1 N.m"
)",
      R"(torque = { type = "harmonic", mean = "1 N.m", amplitude = "2 N.m", frequency = "3 rad/s", phase = "20 deg" }
)");
  decks["decays"] = changed(
      "spins up", R"(torque = "1 N.m"
)",
      R"(torque = { type = "decaying", start = "0.1 s", amplitude = "2 N.m", frequency = "3 rad/s", phase = "20 deg", decay = "0.5 s" }
)");
  decks["pulsates"] = changed("spins up", R"(torque = "1 N.m"
)",
                              R"(torque = "1 N.m"
[drive.pulsation]
synchronous = "40 rad/s"
poles = 2
phase = "10 deg"
columns = ["speed[rpm]", "amplitude[N.m]"]
rows = [[0, 3], [300, 1]]
)");
  decks["polynomial"] =
      changed("spins up", R"(torque = "1 N.m"
)",
              R"(torque = { type = "polynomial", coefficients = ["1 N.m", "2 N.m/s"] }
)");
  decks["tabled"] = changed(
      "spins up", R"(torque = "1 N.m"
)",
      R"(torque = { type = "table", time = ["0 s", "0.4 s", "1 s"], value = ["0 N.m", "1 N.m", "4 N.m"] }
)");
  decks["pieces"] = changed(
      "spins up", R"(torque = "1 N.m"
)",
      R"(torque = { type = "piecewise", pieces = [{ start = "0 s", law = "1 N.m" }, { start = "0.5 s", law = "3 N.m" }] }
)");
  decks["on a base"] = changed("body on springs", R"(name = "spring"
at = "mass"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
krr = "1e4 N.m/rad"
krxx = "1e4 N.m/rad"
[[step]]
name = "st"
type = "static"
[output]
report = false
)",
                               R"(name = "guide"
at = "mass"
type = "rigid"
directions = ["ry", "rz"]
[[probe]]
name = "P"
at = "mass"
[base]
x = "1 m/s^2"
y = "1 m/s^2"
z = "1 m/s^2"
[[step]]
name = "t"
type = "transient"
duration = "0.1 s"
start = "rest"
[step.integrator]
tolerance = 1e-8
[output]
report = false
quantities = ["positions"]
)");
  decks["cross-coupled"] = body(R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[bearing]]
name = "stage"
at = "mass"
type = "cross_coupling"
k = "2e5 N/m"
[[load]]
at = "mass"
force = ["0 N", "100 N", "0 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "st"
type = "static"
)");
  decks["blades"] = changed(
      "cross-coupled", R"(k = "2e5 N/m"
)",
      R"(alford = { beta = 1.5, torque = "1000 N.m", diameter = "400 mm", blade_height = "25 mm" }
)");
  decks["impeller"] = changed(
      "cross-coupled", R"(k = "2e5 N/m"
)",
      R"(wachel = { power = "500 kW", speed = "9000 rpm", diameter = "400 mm", width = "20 mm", molar_mass = "0.03 kg", density_ratio = 1.5 }
)");
  decks["short journal"] = body(R"([[bearing]]
name = "J"
at = "mass"
type = "short_journal"
diameter = "50 mm"
length = "20 mm"
clearance = "50 um"
viscosity = "20 mPa.s"
[[load]]
at = "mass"
force = ["0 N", "0 N", "-200 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "st"
type = "static"
speed = "3000 rpm"
)");
  decks["oil"] = changed("short journal", R"(viscosity = "20 mPa.s"
)",
                         R"(iso_vg = 46
temperature = "40 degC"
)");
  decks["squeezed"] = body(R"([[bearing]]
name = "S"
at = "mass"
type = "squeeze_film"
diameter = "100 mm"
length = "20 mm"
clearance = "100 um"
viscosity = "20 mPa.s"
film = "full"
stiffness = "1e6 N/m"
[[probe]]
name = "P"
at = "mass"
[[step]]
name = "h"
type = "harmonic_response"
frequency = { values = ["40 Hz"] }
[[step.force]]
at = "mass"
force = ["0 N", "10 N", "0 N"]
)");
  decks["full film pushed"] = body(R"([[bearing]]
name = "S"
at = "mass"
type = "squeeze_film"
diameter = "100 mm"
length = "20 mm"
clearance = "100 um"
viscosity = "20 mPa.s"
film = "full"
[[probe]]
name = "P"
at = "mass"
[[load]]
at = "mass"
force = ["0 N", "0.01 N", "0 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "t"
type = "transient"
duration = "10 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
)");
  decks["sealed film pushed"] = body(R"([[bearing]]
name = "S"
at = "mass"
type = "squeeze_film"
diameter = "100 mm"
length = "20 mm"
clearance = "100 um"
viscosity = "20 mPa.s"
film = "sealed"
groove_at = "180 deg"
[[probe]]
name = "P"
at = "mass"
[[load]]
at = "mass"
force = ["0 N", "10 N", "0 N"]
moment = ["0 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "t"
type = "transient"
duration = "4 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
)");
  decks["rubbing"] = changed("cross-coupled", R"(kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[bearing]]
name = "stage"
at = "mass"
type = "cross_coupling"
k = "2e5 N/m"
)",
                             R"(kyy = "1e5 N/m"
kzz = "1e5 N/m"
[[bearing]]
name = "R"
at = "mass"
type = "rub"
gap = "200 um"
stiffness = "1e7 N/m"
friction = 0
diameter = "50 mm"
)");
  decks["on a pedestal"] = body(R"([[bearing]]
name = "B"
at = "mass"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
support = { mass = "5 kg", kxx = "3e6 N/m", kyy = "3e6 N/m", kzz = "3e6 N/m", cyy = "100 N.s/m" }
[[probe]]
name = "P"
at = "mass"
[[step]]
name = "h"
type = "harmonic_response"
frequency = { values = ["30 Hz"] }
[[step.force]]
at = "mass"
force = ["100 N", "200 N", "300 N"]
)",
                                R"("ry", "rz")");
  decks["bar by parameters"] = changed("cantilever", R"([model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
[[shaft.section]]
length = "1 m"
od = "50 mm"
min_elements = 4
[[bearing]]
name = "wall"
at = "r/0 m"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/1 m"
force = ["0 N", "200 N", "50 N"]
)",
                                       R"([parameters]
push = "1 kN"
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
G = "80 GPa"
density = "8000 kg/m^3"
expansion = "1e-5 1/K"
[[material]]
name = "soft"
E = "100 GPa"
G = "40 GPa"
density = "8000 kg/m^3"
[[shaft]]
name = "r"
material = "m"
[[shaft.section]]
name = "a"
length = "200 mm"
od = "50 mm"
[[bearing]]
name = "wall"
at = "r/0 mm"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/200 mm"
force = ["0 N", "${push}", "0 N"]
)");
  decks["bent by its own weight"] = changed("laden rectangle", R"(rotary_inertia = false
)",
                                            R"()");
  decks["heavy bar by rows"] = changed("cantilever", R"(gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
[[shaft.section]]
length = "1 m"
od = "50 mm"
min_elements = 4
[[bearing]]
name = "wall"
at = "r/0 m"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/1 m"
force = ["0 N", "200 N", "50 N"]
)",
                                       R"(gravity = "10 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
G = "80 GPa"
density = "8000 kg/m^3"
expansion = "1e-5 1/K"
[[material]]
name = "soft"
E = "100 GPa"
G = "40 GPa"
density = "8000 kg/m^3"
[[shaft]]
name = "r"
material = "m"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 200, 50]]
[[bearing]]
name = "wall"
at = "r/0 mm"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/200 mm"
force = ["0 N", "0 N", "0 N"]
)");
  decks["swings in equal steps"] = changed("swings", R"(tolerance = 1e-8
)",
                                           R"(dt = "0.1 ms"
method = "generalized_alpha"
rho_inf = 0.9
)");
  decks["swings on a hardening spring"] = changed("swings", R"(directions = ["x", "ry", "rz"]
[[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e5 N/m"
kzz = "1e5 N/m"
)",
                                                  R"(directions = ["x", "z", "ry", "rz"]
[[bearing]]
name = "spring"
at = "mass"
type = "nonlinear_spring"
direction = "y"
shape = "polynomial"
coefficients = ["0 N", "1e5 N/m", "0 N/m^2", "1e11 N/m^3"]
)");
  decks["runs up"] =
      changed("orbits", R"(speed = "3000 rpm"
[[step]]
name = "t"
type = "transient"
duration = "0.1 s"
start = "rest"
[step.integrator]
tolerance = 1e-8
)",
              R"(speed = { type = "ramp", time = ["0 s", "1 s"], value = ["600 rpm", "3000 rpm"] }
[[step]]
name = "t"
type = "transient"
duration = "1 s"
start = "rest"
[step.integrator]
tolerance = 1e-4
)");
  decks["unbalance, reported"] = changed("unbalance", R"(report = false
)",
                                         R"(report = true
)");
  decks["two bodies"] = changed("cantilever", R"(name = "r"
material = "steel"
[[shaft.section]]
length = "1 m"
od = "50 mm"
min_elements = 4
[[bearing]]
name = "wall"
at = "r/0 m"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "r/1 m"
force = ["0 N", "200 N", "50 N"]
[[step]]
name = "st"
type = "static"
)",
                                R"(name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 100, true], ["right", 100, true]]
[[disk]]
name = "mass"
at = "left:end"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[probe]]
name = "P"
at = "mass"
[[initial]]
shaft = "rotor"
velocity = ["0 m/s", "1 m/s", "0 m/s"]
[[shaft]]
name = "other"
origin = ["1 m", "0 m", "0 m"]
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["o", 100, true]]
[[disk]]
name = "second"
at = "o:end"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[probe]]
name = "Q"
at = "second"
[[step]]
name = "t"
type = "transient"
duration = "10 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
)");
  decks["driven at a tilt"] = changed("body on springs", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
krr = "1e4 N.m/rad"
krxx = "1e4 N.m/rad"
[[step]]
name = "st"
type = "static"
[output]
report = false
)",
                                      R"([[drive]]
name = "motor"
at = "mass"
type = "torque"
torque = "1 N.m"
[[probe]]
name = "P"
at = "mass"
[[initial]]
about = ["100 mm", "0 mm", "0 mm"]
tilt = ["60 deg", "0 deg"]
[[step]]
name = "t"
type = "transient"
duration = "1 ms"
start = "rest"
[step.integrator]
tolerance = 1e-8
[output]
report = false
quantities = ["rotation"]
)");
}

}  // namespace whirl::test
