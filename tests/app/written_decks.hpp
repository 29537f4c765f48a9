// The decks whose written numbers test_written_numbers.cpp knows in closed form, by name.
#pragma once
#include "lateral_mass.hpp"

#include <map>
#include <string>

namespace whirl::test {

/// 10 kg on 1e6 N/m and 600 N s/m each way, Ip 0.1 kg m2 on 1e4 N m/rad and 10 N m s/rad about the
/// axis.
inline std::string mass_on_springs(const std::string& rest) {
  return lateral_mass(10, "0 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
krxx = "1e4 N.m/rad"
crxx = "10 N.m.s/rad"
[[probe]]
name = "P"
at = "mass"
[output]
report = false
)" + rest);
}

/// The same on the springs across alone: free to spin. `output`: keys of [output].
inline std::string spinning_mass(const std::string& output, const std::string& rest) {
  return lateral_mass(10, "0 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
[[unbalance]]
at = "mass"
amount = "1 kg.mm"
[[probe]]
name = "P"
at = "mass"
[output]
report = false
)" + output + rest);
}

/// 10 kg that moves and turns where nothing holds it.
inline std::string loose_mass(const std::string& held, const std::string& quantities,
                              const std::string& rest) {
  return lateral_mass(10, "0 m/s^2", "[output]\nreport = false\nquantities = [" + quantities + R"(]
[[probe]]
name = "P"
at = "mass"
)" + rest,
                      held);
}

/// 10 kg on a rigid shaft that nothing holds, 100 mm to either side.
inline std::string free_body(const std::string& quantities, const std::string& rest) {
  const std::string deck = loose_mass("", quantities, rest);
  const std::size_t guide = deck.find("[[bearing]]"), end = deck.find("[output]");
  return deck.substr(0, guide) + deck.substr(end);
}

/// A beam 40 mm wide and 60 mm high, 200 GPa, 80 GPa, 8000 kg/m3. `section`: more of its keys.
inline std::string rectangle(const std::string& length, const std::string& section,
                             const std::string& kappa, const std::string& rest) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
G = "80 GPa"
density = "8000 kg/m^3"
[[shaft]]
name = "r"
material = "m"
[[shaft.section]]
length = ")" +
         length + "\"\nmin_elements = 16\n" + section + R"([shaft.section.general]
A = "2400 mm^2"
Iy = "720000 mm^4"
Iz = "320000 mm^4"
J = "7.5e5 mm^4"
)" + kappa +
         R"([output]
report = false
)" + rest;
}

inline std::string clamped(const std::string& at) {
  return "[[bearing]]\nname = \"wall\"\nat = \"" + at + R"("
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
)";
}

/// A preloaded ball bearing on a rotor that is held: its stiffness at the place `at`.
inline std::string held_ball_bearing(const std::string& at) {
  return lateral_mass(10, "0 m/s^2", "[[bearing]]\nname = \"ball\"\nat = \"" + at + R"("
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
                      R"("x", "y", "z", "ry", "rz")");
}

/// Two masses of 10 kg on 1e6 N/m each, on a casing with a point of 20 kg under each: 3e6 N/m to the
/// ground, 2000 N s/m between the points and nothing else.
inline const char* const coupled_casing = R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["a", 100, true]]
[[disk]]
name = "left"
at = "r/a:start"
mass = "10 kg"
Ip = "0.1 kg.m^2"
[[bearing]]
name = "A"
at = "left"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[bearing]]
name = "guide"
at = "left"
type = "rigid"
directions = ["x", "ry", "rz"]
[[shaft]]
name = "q"
origin = ["1 m", "0 m", "0 m"]
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["a", 100, true]]
[[disk]]
name = "right"
at = "q/a:start"
mass = "10 kg"
Ip = "0.1 kg.m^2"
[[bearing]]
name = "B"
at = "right"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[bearing]]
name = "guide of q"
at = "right"
type = "rigid"
directions = ["x", "ry", "rz"]
[[foundation]]
name = "casing"
coordinates = ["A.y", "B.y"]
columns = ["row", "column", "K[N/m]", "C[N.s/m]", "M[kg]"]
rows = [[1, 1, 3e6, 0, 20], [2, 2, 3e6, 0, 20], [1, 2, 0, -2000, 0]]
[[probe]]
name = "P"
at = "left"
[[probe]]
name = "Q"
at = "right"
[output]
report = false
[[step]]
name = "h"
type = "harmonic_response"
frequency = { values = ["30 Hz"] }
[[step.force]]
at = "left"
force = ["0 N", "100 N", "0 N"]
)";

/// With a report, and what is written beside it.
inline std::string reported(std::string deck) {
  const std::string off = "report = false";
  return deck.replace(deck.find(off), off.size(), "report = true");
}

/// The mass on springs across whose cross-coupling grows with the speed: 2 c w_n at 6000 rpm, so that
/// forward whirl grows from 3000 rpm on where c is 600 N s/m.
inline std::string speed_coupled(const std::string& rest) {
  return lateral_mass(10, "0 m/s^2", R"([parameters]
c = "600 N.s/m"
[[bearing]]
name = "spring"
at = "mass"
type = "table"
columns = ["speed[rpm]", "kyy[N/m]", "kzz[N/m]", "kyz[N/m]", "kzy[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [[0, 1e6, 1e6, 0, 0, "${c}", "${c}"],
        [6000, 1e6, 1e6, 379473.3192202055, -379473.3192202055, "${c}", "${c}"]]
interpolation = "linear"
[[probe]]
name = "P"
at = "mass"
[output]
report = false
)" + rest);
}

/// Rigid arms of 400 mm along x without mass, 10 kg at the end of each: `joints` hold them.
inline std::string arms(const std::string& names, const std::string& gravity,
                        const std::string& joints) {
  std::string deck = "format = 1\n[model]\ngravity_vector = " + gravity + "\n";
  for (const char name : names) {
    const std::string n(1, name);
    deck += "[[shaft]]\nname = \"" + n + "\"\nrotating = false\nmaterial = \"steel\"\n" +
            "columns = [\"name\", \"length[mm]\", \"rigid\"]\nrows = [[\"" + n +
            "1\", 400, true]]\n";
  }
  for (const char name : names) {
    const std::string n(1, name);
    deck += "[[disk]]\nname = \"d" + n + "\"\nat = \"" + n +
            "1:end\"\nmass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"\n";
  }
  return deck + joints + "[output]\nreport = false\nquantities = [\"joints\"]\n";
}

inline std::map<std::string, std::string> written_decks() {
  const std::string unbalanced = mass_on_springs(R"([[unbalance]]
at = "mass"
amount = "1 kg.mm"
phase = "60 deg"
[[step]]
name = "u"
type = "unbalance_response"
speed = { start = "1000 rpm", stop = "6000 rpm", points = 51, refine = "no" }
)");
  const std::string probe = "[[probe]]\nname = \"P\"\nat = \"mass\"\n";
  const std::string push = R"([[load]]
at = "mass"
force = ["0 N", "1 kN", "0 N"]
[[step]]
name = "t"
type = "transient"
start = "rest"
)";
  const auto transient = [](const std::string& keys, const std::string& tolerance = "1e-8") {
    return "[[step]]\nname = \"t\"\ntype = \"transient\"\n" + keys +
           "[step.integrator]\ntolerance = " + tolerance + "\n";
  };
  const auto circle = [&](const std::string& speed) {
    return spinning_mass("", R"([output.spectra]
max_frequency = "100 Hz"
lines = 50
[[drive]]
at = "rotor/0 mm"
type = "speed"
speed = ")" + speed + "\"\n" + transient("duration = \"1.1 s\"\nstart = \"unbalance_response\"\n"));
  };
  const auto margins = [](const std::string& operating) {
    return mass_on_springs(R"([[unbalance]]
at = "mass"
amount = "1 kg.mm"
[[step]]
name = "u"
type = "unbalance_response"
speed = { start = "1000 rpm", stop = "6000 rpm", points = 51, refine = "no" }
operating_speed = )" + operating +
                           "\n");
  };
  return {
      {"cantilever", R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
[[shaft.section]]
length = "1 m"
od = "50 mm"
min_elements = 4
)" + clamped("r/0 m") +
                         R"([[load]]
at = "r/1 m"
force = ["0 N", "200 N", "50 N"]
[[step]]
name = "st"
type = "static"
[output]
report = false
)"},
      {"tilting pads", lateral_mass(50, "9.81 m/s^2", R"([[bearing]]
name = "J"
at = "mass"
type = "tilting_pad"
diameter = "50 mm"
length = "25 mm"
clearance = "50 um"
viscosity = "20 mPa.s"
preload = 0.4
[[step]]
name = "st"
type = "static"
speed = "3000 rpm"
[output]
report = false
)")},
      {"floating rings", lateral_mass(5, "9.81 m/s^2", R"([[bearing]]
name = "J"
at = "mass"
type = "floating_ring"
film = "short"
inner = { diameter = "20 mm", length = "10 mm", clearance = "30 um", viscosity = "10 mPa.s" }
outer = { diameter = "30 mm", length = "12 mm", clearance = "50 um", viscosity = "15 mPa.s" }
[[step]]
name = "st"
type = "static"
speed = "20000 rpm"
[output]
report = false
)")},
      {"arms at rest", arms("hus", R"(["10 m/s^2", "0 m/s^2", "0 m/s^2"])", R"([[joint]]
name = "H"
kind = "hinge"
at = "h1:start"
axis = [0, 0, 1]
stiffness = "1000 N.m/rad"
[[joint]]
name = "U"
kind = "universal"
at = "u1:start"
axis = [0, 1, 0]
second_axis = [0, 0, 1]
[[joint]]
name = "S"
kind = "slider"
at = "s1:start"
axis = [0, 0, 1]
stiffness = "2000 N/m"
[[load]]
at = "dh"
force = ["0 N", "50 N", "20 N"]
[[load]]
at = "du"
force = ["0 N", "30 N", "40 N"]
[[load]]
at = "ds"
force = ["0 N", "5 N", "60 N"]
[[step]]
name = "st"
type = "static"
)") + transient("duration = \"1 ms\"\n")},
      {"arms in motion", arms("hs", R"(["0 m/s^2", "0 m/s^2", "0 m/s^2"])", R"([[joint]]
name = "H"
kind = "hinge"
at = "h1:start"
axis = [0, 0, 1]
damping = "2 N.m.s/rad"
[[joint]]
name = "S"
kind = "slider"
at = "s1:start"
axis = [0, 0, 1]
damping = "20 N.s/m"
[[load]]
at = "dh"
moment = ["0 N.m", "0 N.m", "3 N.m"]
[[load]]
at = "ds"
force = ["0 N", "0 N", "40 N"]
)") + transient("duration = \"1 s\"\nstart = \"rest\"\n")},
      {"arm on an arm", arms("pq", R"(["0 m/s^2", "0 m/s^2", "0 m/s^2"])", R"([[joint]]
name = "G"
kind = "slider"
at = "p1:start"
axis = [1, 0, 0]
stiffness = "1e6 N/m"
[[joint]]
name = "A"
kind = "rigid"
at = "q1:end"
to = "p1:start"
arm = true
[[load]]
at = "dq"
force = ["0 N", "50 N", "0 N"]
)") + transient("duration = \"1 ms\"\n")},
      {"backward", mass_on_springs(R"([[step]]
name = "h"
type = "harmonic_response"
speed = { start = "1500 rpm", stop = "3000 rpm", points = 2, refine = "no" }
speed_squared = true
[[step.force]]
at = "mass"
force = ["0 N", "100 N", "0 N"]
whirl = "backward"
)")},
      {"harmonic peaks", mass_on_springs(R"([[step]]
name = "h"
type = "harmonic_response"
frequency = { start = "20 Hz", stop = "80 Hz", points = 13 }
[[step.force]]
at = "mass"
force = ["5 N", "10 N", "0 N"]
moment = ["10 N.m", "0 N.m", "0 N.m"]
)")},
      {"twist", mass_on_springs(R"([[step]]
name = "h"
type = "harmonic_response"
frequency = { values = ["20 Hz", "40 Hz"] }
[[step.force]]
at = "mass"
moment = ["10 N.m", "0 N.m", "0 N.m"]
)")},
      {"unbalance", unbalanced},
      {"probe at 45 degrees",
       std::string(unbalanced)
           .replace(unbalanced.find(probe), probe.size(), probe + "angles = [\"45 deg\"]\n")},
      {"limited", mass_on_springs(push + "duration = \"1 s\"\namplitude_limit = \"1.2 mm\"\n")},
      {"short steps",
       mass_on_springs(push + "duration = \"20 ms\"\n[step.integrator]\ndt_max = \"0.1 ms\"\n")},
      {"modes",
       mass_on_springs("[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"1000 rpm\"\nmodes = "
                       "2\n")},
      {"operated below the peak", margins("[\"1000 rpm\", \"2000 rpm\"]")},
      {"operated above the peak", margins("[\"4000 rpm\", \"5000 rpm\"]")},
      {"operated at the peak", margins("[\"3000 rpm\", \"4000 rpm\"]")},
      {"short rectangle",
       rectangle("200 mm", "", "kappa_y = 0.9\nkappa_z = 0.5\n", clamped("r/0 m") + R"([[load]]
at = "r/200 mm"
force = ["0 N", "1 kN", "1 kN"]
[[step]]
name = "st"
type = "static"
)")},
      {"laden rectangle", rectangle("1 m", "rotary_inertia = false\nadded_mass = \"10 kg/m\"\n",
                                    "kappa_y = 1e4\nkappa_z = 1e4\n", R"([[bearing]]
at = "r/0 m"
type = "rigid"
directions = ["x", "y", "z", "rx"]
[[bearing]]
at = "r/1 m"
type = "rigid"
directions = ["y", "z"]
[[step]]
name = "m"
type = "modal"
modes = 2
motion = "lateral"
)")},
      {"damping2", loose_mass(R"("x", "ry", "rz")", "\"probes\"", R"([[bearing]]
at = "mass"
type = "nonlinear_spring"
direction = "y"
shape = "polynomial"
coefficients = ["0 N"]
damping2 = "3e7 N.s/m^3"
[[initial]]
velocity = ["0 m/s", "1 m/s", "0 m/s"]
)" + transient("duration = \"0.3 s\"\nstart = \"rest\"\n"))},
      {"damping2 of the twist", loose_mass(R"("x", "y", "z", "ry", "rz")", "\"rotation\"",
                                           R"([[bearing]]
at = "mass"
type = "nonlinear_angular_spring"
direction = "rx"
shape = "polynomial"
coefficients = ["0 N.m"]
damping2 = "3 N.m.s/rad^3"
[[initial]]
angular_velocity = ["10 rad/s", "0 rad/s", "0 rad/s"]
)" + transient("duration = \"3 s\"\nstart = \"rest\"\n"))},
      {"ball bearing pushed along", loose_mass(R"("y", "z", "ry", "rz")", "\"positions\"",
                                               R"([[bearing]]
name = "ball"
at = "mass"
type = "ball"
balls = 9
ball_diameter = "10 mm"
pitch_diameter = "50 mm"
clearance = "20 um"
c_axial = "1e4 N.s/m"
[[load]]
at = "mass"
force = ["100 N", "0 N", "0 N"]
)" + transient("duration = \"5 ms\"\nstart = \"rest\"\n"))},
      {"roller bearing pushed along", loose_mass(R"("y", "z", "ry", "rz")", "\"positions\"",
                                                 R"([[bearing]]
name = "roller"
at = "mass"
type = "roller"
rollers = 13
roller_diameter = "10 mm"
roller_length = "10 mm"
pitch_diameter = "50 mm"
c_axial = "1e4 N.s/m"
[[load]]
at = "mass"
force = ["100 N", "0 N", "0 N"]
)" + transient("duration = \"5 ms\"\nstart = \"rest\"\n"))},
      {"coupled casing", coupled_casing},
      {"window", spinning_mass("every = \"1 ms\"\nwindow = [\"5 ms\", \"10 ms\"]\n",
                               transient("duration = \"20 ms\"\n"))},
      {"circle", circle("3000 rpm")},
      {"circle of a shaft that turns backward", circle("-3000 rpm")},
      {"turned about the left end", free_body("\"velocity\", \"positions\", \"speed\"",
                                              R"([[probe]]
name = "far"
at = "right:end"
[[initial]]
angular_velocity = ["7 rad/s", "2 rad/s", "3 rad/s"]
velocity = ["0 m/s", "0.1 m/s", "0 m/s"]
)" + transient("duration = \"1 ms\"\nstart = \"rest\"\n"))},
      {"tilted", free_body("\"speed\", \"rotation\"", R"([[initial]]
angular_velocity = ["100 rad/s", "0 rad/s", "20 rad/s"]
tilt = ["30 deg", "0 deg"]
)" + transient("duration = \"1 ms\"\nstart = \"rest\"\n"))},
      {"events", loose_mass(R"("x", "y", "z", "ry", "rz")", "\"speed\", \"torque\"", R"([[drive]]
name = "motor"
at = "rotor/0 mm"
type = "torque"
torque = "1 N.m"
[[event]]
name = "five"
type = "speed"
value = "5 rad/s"
)" + transient("duration = \"1 s\"\nstart = \"rest\"\n"))},
      {"campbell", mass_on_springs(R"([[step]]
name = "c"
type = "campbell"
modes = 2
motion = "lateral"
speed = { values = ["0 rpm", "6000 rpm"] }
[[step]]
name = "v"
type = "critical_speeds"
max_speed = "6000 rpm"
motion = "lateral"
[[step]]
name = "p"
type = "critical_map"
stiffness_min = "1e6 N/m"
stiffness_max = "4e6 N/m"
points = 2
max_speed = "9000 rpm"
[[step]]
name = "o"
type = "torsional"
modes = 1
max_speed = "6000 rpm"
orders = [2]
[[step]]
name = "m"
type = "modal"
modes = 1
motion = "torsional"
)")},
      {"speed-coupled", speed_coupled(R"([[load]]
at = "mass"
force = ["0 N", "1 kN", "0 N"]
[[step]]
name = "s"
type = "stability"
modes = 2
speed = { values = ["1500 rpm", "6000 rpm"] }
[step.map]
parameter = "c"
values = ["300 N.s/m", "600 N.s/m"]
[[step]]
name = "e"
type = "static"
speeds = { values = ["3000 rpm"] }
)")},
      {"struts",
       rectangle("1 m", "", "kappa_y = 1e4\nkappa_z = 1e4\n", clamped("r/0 m") + R"([[load]]
at = "r/1 m"
force = ["-1 kN", "0 N", "0 N"]
[[step]]
name = "b"
type = "buckling"
modes = 2
)")},
      {"path", mass_on_springs(R"([[load]]
at = "mass"
force = ["0 N", "100 N", "0 N"]
[[step]]
name = "st"
type = "static"
[step.path]
load = 2
)")},
      {"orbits", reported(spinning_mass("", R"([output.tracking]
samples = 16
orbit_turns = 2
[[drive]]
at = "rotor/0 mm"
type = "speed"
speed = "3000 rpm"
)" + transient("duration = \"0.1 s\"\nstart = \"rest\"\n")))},
      // a free vibration of half the speed: 1 kN let go on an undamped spring, sqrt(k/m) = w/2
      {"beat", lateral_mass(10, "0 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
[[probe]]
name = "P"
at = "mass"
[output]
report = false
[output.tracking]
bandwidth = 2
[[load]]
at = "mass"
force = ["0 N", "1 kN", "0 N"]
[[drive]]
at = "rotor/0 mm"
type = "speed"
speed = "632.4555320336759 rad/s"
)" + transient("duration = \"0.4 s\"\nstart = \"rest\"\n", "1e-9"))},
      {"ball bearing at its node", held_ball_bearing("mass")},
      {"ball bearing off its node", held_ball_bearing("right:start + 30 mm")},
  };
}

}  // namespace whirl::test
