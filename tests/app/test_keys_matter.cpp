// Every key of a deck matters: pairs of decks that differ in one key, and the number the second one
// must then write, from a closed form. The list of keys is that of the program.
#include "../deck/dump_model.hpp"
#include "deck_run.hpp"
#include "key_decks.hpp"
#include "key_pairs.hpp"
#include "written_decks.hpp"

#include <deck/deck.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <regex>
#include <set>

namespace {

using whirl::test::DeckRun;

/// A round cantilever, 200 mm by 50 mm, 200 GPa, 80 GPa, with 1 kN along y at its tip.
const std::string bar = R"(format = 1
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
force = ["0 N", "1 kN", "0 N"]
[[step]]
name = "st"
type = "static"
[output]
report = false
)";

std::string hot_bar() {
  const std::string od = "od = \"50 mm\"\n";
  std::string deck = bar;
  return deck.insert(deck.find(od), "temperature_rise = \"100 K\"\n");
}

/// The mass on springs under its own weight.
const std::string weight =
    whirl::test::mass_on_springs("[[step]]\nname = \"st\"\ntype = \"static\"\n");

/// A rigid block on a bearing of its own, shaken in all directions.
const std::string block = R"(format = 1
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
[[bearing]]
name = "block"
at = "mass"
type = "linear"
kxx = "1e6 N/m"
kyy = "2e6 N/m"
kzz = "3e6 N/m"
krr = "2e4 N.m/rad"
krxx = "1e4 N.m/rad"
cxx = "100 N.s/m"
cyy = "200 N.s/m"
czz = "300 N.s/m"
crr = "3 N.m.s/rad"
crxx = "2 N.m.s/rad"
[[probe]]
name = "P"
at = "mass"
[[probe]]
name = "E"
at = "right:end"
[[step]]
name = "h"
type = "harmonic_response"
frequency = { start = "30 Hz", stop = "40 Hz", points = 2 }
[[step.force]]
at = "mass"
force = ["100 N", "200 N", "300 N"]
moment = ["4 N.m", "5 N.m", "6 N.m"]
[output]
report = false
)";

/// A mass on a magnetic bearing: shaken, at rest under its weight, and its loops.
const std::string magnet = R"deck(format = 1
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
[[bearing]]
name = "guide"
at = "mass"
type = "rigid"
directions = ["x", "rx", "ry", "rz"]
[[bearing]]
name = "AMB"
at = "mass"
type = "magnetic"
current_stiffness = "200 N/A"
position_stiffness = "1e5 N/m"
sensor_bandwidth = "500 Hz"
amplifier_bandwidth = "300 Hz"
delay = "200 us"
[[bearing.control]]
type = "pid"
p = "5000 A/m"
i = "2e4 A/(m.s)"
d = "20 A.s/m"
lag = "500 us"
[[probe]]
name = "P"
at = "mass"
[[step]]
name = "st"
type = "static"
[[step]]
name = "s"
type = "sensitivity"
frequency = { values = ["25 Hz"] }
[[step]]
name = "h"
type = "harmonic_response"
frequency = { start = "30 Hz", stop = "40 Hz", points = 2 }
[[step.force]]
at = "mass"
force = ["0 N", "100 N", "200 N"]
[output]
report = false
)deck";

using whirl::test::Pair;
using whirl::test::Said;

const Pair pairs[] = {
    {"[model]", "gravity", "weight", "\"0 m/s^2\"", "\"10 m/s^2\"", "st_deflection.csv", 1,
     "u_z [m]", -1e-4, 1e-12, "-m g/k"},
    {"[model]", "gravity_direction", "weight", "\"0 m/s^2\"",
     "\"10 m/s^2\"\ngravity_direction = \"+y\"", "st_deflection.csv", 1, "u_y [m]", 1e-4, 1e-12,
     "m g/k"},
    {"[model]", "gravity_vector", "weight", "gravity = \"0 m/s^2\"",
     "gravity_vector = [\"0 m/s^2\", \"3 m/s^2\", \"0 m/s^2\"]", "st_deflection.csv", 1, "u_y [m]",
     3e-5, 1e-12, "m g/k"},
    // F L^3/(3 E I) + F L/(kappa G A), kappa = 6 (1 + nu)/(7 + 6 nu) after Cowper
    {"[[material]]", "E", "laden rectangle", "E = \"200 GPa\"\nG = \"80 GPa\"",
     "E = \"800 GPa\"\nG = \"320 GPa\"", "m_modes.csv", 0, "frequency [Hz]", 147.0782432796, 1e-3,
     "pi/2 sqrt(E I/(29.2 kg/m))"},
    {"[[material]]", "G", "short rectangle", "80 GPa", "160 GPa", "st_deflection.csv", -1,
     "u_y [m]", 4.224537037e-5, 5e-11, "half the shear"},
    {"[[material]]", "nu", "short rectangle", "G = \"80 GPa\"", "nu = 0", "st_deflection.csv", -1,
     "u_y [m]", 4.259259259e-5, 5e-11, "G = E/2"},
    {"[[material]]", "density", "laden rectangle", "8000 kg", "2000 kg", "m_modes.csv", 0,
     "frequency [Hz]", 103.2949, 1e-3, "pi/2 sqrt(E I/(14.8 kg/m))"},
    {"[[material]]", "expansion", "hot bar", "1e-5 1/K", "2e-5 1/K", "st_deflection.csv", -1,
     "u_x [m]", 4e-4, 1e-8, "expansion 100 K L"},
    {"[[shaft]]", "material", "bar", "material = \"m\"", "material = \"soft\"", "st_deflection.csv",
     -1, "u_y [m]", 8.980582922e-5, 1e-10, "half the moduli"},
    {"[[shaft]]", "shear", "bar", "material = \"m\"", "material = \"m\"\nshear = \"none\"",
     "st_deflection.csv", -1, "u_y [m]", 4.345990979e-5, 5e-11, "F L^3/(3 E I)"},
    {"[[shaft]]", "kappa", "bar", "material = \"m\"",
     "material = \"m\"\nshear = \"given\"\nkappa = 0.5", "st_deflection.csv", -1, "u_y [m]",
     4.600638888e-5, 5e-11, "F L/(0.5 G A)"},
    {"[[shaft]]", "temperature_rise", "bar", "material = \"m\"",
     "material = \"m\"\ntemperature_rise = \"100 K\"", "st_deflection.csv", -1, "u_x [m]", 2e-4,
     1e-8, "expansion 100 K L"},
    {"[[shaft]]", "axial_force", "bar", "material = \"m\"",
     "material = \"m\"\naxial_force = \"100 kN\"", "st_deflection.csv", -1, "u_x [m]",
     5.0929581789e-5, 2e-8, "F L/(E A)"},
    {"[[shaft]]", "speed_ratio", "unbalance", "[shaft]\n", "[shaft]\nspeed_ratio = 2\n",
     "u_response.csv", 0, "P major [m]", 7.625437462229e-5, 1e-16, "of 2000 rpm"},
    {"[[shaft]]", "initial_spin", "events", "[shaft]\n", "[shaft]\ninitial_spin = \"100 rpm\"\n",
     "t.csv", 0, "speed [rpm]", 100, 1e-9, "the speed at the start"},
    {"[[shaft.section]]", "length", "bar", "length = \"200 mm\"", "length = \"300 mm\"",
     "st_deflection.csv", -1, "u_y [m]", 7.749784696e-05, 1e-10,
     "and the slope at the load times 100 mm"},
    {"[[shaft.section]]", "od", "bar", "od = \"50 mm\"", "od = \"60 mm\"", "st_deflection.csv", -1,
     "u_y [m]", 2.196076231e-5, 5e-11, "closed form"},
    {"[[shaft.section]]", "id", "bar", "od = \"50 mm\"", "od = \"50 mm\"\nid = \"25 mm\"",
     "st_deflection.csv", -1, "u_y [m]", 4.911422514e-5, 5e-11, "closed form"},
    {"[[shaft.section]]", "stiffness_od", "bar", "od = \"50 mm\"",
     "od = \"50 mm\"\nstiffness_od = \"60 mm\"", "st_deflection.csv", -1, "u_y [m]", 2.196076231e-5,
     5e-11, "stiff as 60 mm"},
    {"[[shaft.section]]", "stiffness_id", "bar", "od = \"50 mm\"",
     "od = \"50 mm\"\nstiffness_od = \"50 mm\"\nstiffness_id = \"25 mm\"", "st_deflection.csv", -1,
     "u_y [m]", 4.911422514e-5, 5e-11, "stiff as a tube"},
    {"[[shaft.section]]", "material", "bar", "od = \"50 mm\"",
     "od = \"50 mm\"\nmaterial = \"soft\"", "st_deflection.csv", -1, "u_y [m]", 8.980582922e-5,
     1e-10, "half the moduli"},
    {"[[shaft.section]]", "rigid", "bar", "od = \"50 mm\"", "rigid = true", "st_deflection.csv", -1,
     "u_y [m]", 0, 1e-15, "does not bend"},
    {"[[shaft.section]]", "shear", "bar", "od = \"50 mm\"",
     "od = \"50 mm\"\nshear = \"hutchinson\"", "st_deflection.csv", -1, "u_y [m]", 4.485198503e-5,
     5e-11, "6 (1 + nu)^2/(7 + 12 nu + 4 nu^2)"},
    {"[[shaft.section]]", "kappa", "bar", "od = \"50 mm\"",
     "od = \"50 mm\"\nshear = \"given\"\nkappa = 0.5", "st_deflection.csv", -1, "u_y [m]",
     4.600638888e-5, 5e-11, "F L/(0.5 G A)"},
    {"[[shaft.section]]", "temperature_rise", "bar", "od = \"50 mm\"",
     "od = \"50 mm\"\ntemperature_rise = \"100 K\"", "st_deflection.csv", -1, "u_x [m]", 2e-4, 1e-8,
     "expansion 100 K L"},
    {"[[shaft.section]]", "added_mass", "laden rectangle", "10 kg/m", "20 kg/m", "m_modes.csv", 0,
     "frequency [Hz]", 63.46975626, 1e-3, "pi/2 sqrt(E I/(39.2 kg/m))"},
    {"[shaft.section.general]", "kappa_y", "short rectangle", "kappa_y = 0.9", "kappa_y = 0.5",
     "st_deflection.csv", -1, "u_y [m]", 4.375e-5, 5e-11, "F L/(kappa G A)"},
    {"[shaft.section.general]", "kappa_z", "short rectangle", "kappa_z = 0.5", "kappa_z = 1",
     "st_deflection.csv", -1, "u_z [m]", 1.956018519e-5, 5e-11, "F L/(kappa G A)"},
    {"[shaft.section.general]", "Iy", "short rectangle", "720000", "320000", "st_deflection.csv",
     -1, "u_z [m]", 4.375e-5, 5e-11, "F L^3/(3 E Iy)"},
    {"[shaft.section.general]", "Iz", "short rectangle", "320000", "720000", "st_deflection.csv",
     -1, "u_y [m]", 1.967592593e-5, 5e-11, "F L^3/(3 E Iz)"},
    {"[shaft.section.general]", "A", "short rectangle", "2400", "4800", "st_deflection.csv", -1,
     "u_y [m]", 4.224537037e-5, 5e-11, "half the shear"},
    {"[shaft.section.general]", "angle", "short rectangle", "kappa_z = 0.5",
     "kappa_z = 0.5\nangle = \"90 deg\"", "st_deflection.csv", -1, "u_y [m]", 2.060185185e-5, 5e-11,
     "the section's z along -y"},
    {"[[disk]]", "mass", "campbell", "10 kg\"", "40 kg\"", "c_campbell.csv", 0,
     "1 F frequency [Hz]", 25.136279928017, 1e-9, "sqrt(k/m - (c/2m)^2)"},
    {"[[disk]]", "Ip", "campbell", "0.1 kg.m^2", "0.12 kg.m^2", "m_modes.csv", 0, "frequency [Hz]",
     45.46297157, 1e-3, "sqrt(k/Ip - (c/2Ip)^2)"},
    {"[[bearing]], type = \"linear\"", "kyy", "backward", "kyy = \"1e6", "kyy = \"2e6",
     "h_response.csv", 0, "P y amplitude [m]", 1.423859477e-05, 2e-8, "F/|k - m w^2 + i c w|"},
    {"[[bearing]], type = \"linear\"", "setpoint", "weight", "kyy = \"1e6",
     "setpoint = [\"0 mm\", \"0.3 mm\", \"0 mm\"]\nkyy = \"1e6", "st_deflection.csv", 1, "u_y [m]",
     3e-4, 1e-12, "where the spring is free"},
    {"[[bearing]], type = \"linear\"", "preload", "weight", "kyy = \"1e6",
     "preload = [\"0 N\", \"0 N\", \"40 N\"]\nkyy = \"1e6", "st_deflection.csv", 1, "u_z [m]", 4e-5,
     1e-12, "preload/k"},
    {"[[bearing]], type = \"linear\"", "krxx", "campbell", "krxx = \"1e4", "krxx = \"4e4",
     "m_modes.csv", 0, "frequency [Hz]", 100.343373595157, 1e-8, "sqrt(k/Ip - (c/2Ip)^2)"},
    {"[[bearing]], type = \"linear\"", "crxx", "campbell", "crxx = \"10", "crxx = \"20",
     "m_modes.csv", 0, "frequency [Hz]", 47.746482927569, 1e-8, "sqrt(k/Ip - (c/2Ip)^2)"},
    {"[[bearing]], type = \"nonlinear_spring\"", "damping2", "damping2", "3e7 N.s", "2.4e8 N.s",
     "t.csv", -1, "P.y [m]", 0.005, 1e-9, "(3 m v/c2)^(1/3)"},
    {"[[bearing]], type = \"nonlinear_angular_spring\"", "damping2", "damping2 of the twist",
     "3 N.m.s", "24 N.m.s", "t.csv", -1, "P phi [rad]", 0.5, 1e-7, "(3 Ip w/c2)^(1/3)"},
    {"[[bearing]], type = \"ball\"", "c_axial", "ball bearing pushed along", "1e4 N.s", "2e4 N.s",
     "t.csv", -1, "P position.x [m]", 0.10002250011350, 1e-10, "F/c (t - m/c (1 - exp(-c t/m)))"},
    {"[[load]]", "force", "bar", "\"1 kN\"", "\"2 kN\"", "st_deflection.csv", -1, "u_y [m]",
     8.980582922e-5, 1e-10, "twice"},
    {"[[load]]", "at", "bar", "\"r/200 mm\"", "\"r/100 mm\"", "st_deflection.csv", -1, "u_y [m]",
     1.430272422e-5, 5e-11, "F a^3/(3 E I) + F a/(kappa G A) + F a^2/(2 E I) a"},
    {"[[load]]", "moment", "bar", "force = [",
     "moment = [\"0 N.m\", \"0 N.m\", \"100 N.m\"]\nforce = [", "st_deflection.csv", -1, "u_y [m]",
     7.749784696e-05, 5e-10, "and M L^2/(2 E I)"},
    {"[[unbalance]]", "amount", "unbalance", "1 kg.mm", "2 kg.mm", "u_response.csv", 0,
     "P major [m]", 2.457274608863e-5, 1e-16, "twice"},
    {"[[unbalance]]", "phase", "unbalance", "60 deg", "0 deg", "u_response.csv", 0,
     "P y phase lag [deg]", 4.036717069707, 1e-9, "atan2(c w, k - m w^2)"},
    {"[[drive]], type = \"torque\"", "torque", "events", "1 N.m", "2 N.m", "t.csv", -1, "phi [rad]",
     10, 1e-10, "T t^2/(2 Ip)"},
    {"[[drive]], type = \"speed\"", "speed", "orbits", "3000 rpm", "1500 rpm", "t.csv", -1,
     "speed [rpm]", 1500, 1e-6, "held"},
    {"[[event]], type = \"speed\"", "value", "events", "\"5 rad/s\"", "\"2 rad/s\"", "t_events.csv",
     0, "time [s]", 0.2, 1e-11, "w Ip/T"},
    {"[[event]]", "stop", "events", "type = \"speed\"", "type = \"speed\"\nstop = true", "t.csv",
     -1, "t [s]", 0.5, 1e-9, "the passage ends the run"},
    {"[[initial]]", "about", "turned about the left end", "velocity = [\"0 m/s\"",
     "about = [\"200 mm\", \"0 mm\", \"0 mm\"]\nvelocity = [\"0 m/s\"", "t.csv", 0,
     "far velocity.y [m/s]", 0.1, 1e-14, "the velocity of the point itself"},
    {"[[initial]]", "velocity", "turned about the left end", "\"0.1 m/s\"", "\"0.2 m/s\"", "t.csv",
     0, "far velocity.y [m/s]", 0.8, 1e-14, "v + w r"},
    {"[[initial]]", "displacement", "turned about the left end", "velocity = [\"0 m/s\"",
     "displacement = [\"0 mm\", \"3 mm\", \"0 mm\"]\nvelocity = [\"0 m/s\"", "t.csv", 0,
     "P position.y [m]", 3e-3, 1e-14, "shifted"},
    {"[[initial]]", "tilt", "tilted", "30 deg", "60 deg", "t.csv", 0, "speed [rpm]", 312.0661606,
     1e-4, "100 cos 60 - 20 sin 60 rad/s"},
    {"[[step]], type = \"transient\"", "duration", "events", "\"1 s\"", "\"2 s\"", "t.csv", -1,
     "speed [rpm]", 190.985931710274, 1e-8, "T t/Ip"},
    {"[[step]], type = \"transient\"", "initial_speed", "events", "start = \"rest\"",
     "start = \"rest\"\ninitial_speed = \"60 rpm\"", "t.csv", 0, "speed [rpm]", 60, 1e-9,
     "the speed at the start"},
    {"[[step]], type = \"transient\"", "stop_speed", "events", "start = \"rest\"",
     "start = \"rest\"\nstop_speed = \"2 rad/s\"", "t.csv", -1, "t [s]", 0.2, 1e-9, "w Ip/T"},
    {"[step.integrator]", "dt", "events", "tolerance = 1e-8", "dt = \"50 ms\"", "t.csv", 1, "t [s]",
     0.05, 1e-14, "the first step"},
    {"[step.integrator]", "dt_first", "events", "tolerance = 1e-8",
     "tolerance = 1e-8\ndt_first = \"3 ms\"", "t.csv", 1, "t [s]", 0.003, 1e-14, "the first step"},
    {"[output]", "every", "window", "every = \"1 ms\"", "every = \"2 ms\"", "t.csv", 1, "t [s]",
     8e-3, 1e-14, "6 ms, 8 ms"},
    {"[output]", "window", "window", "\"10 ms\"", "\"8 ms\"", "t.csv", -1, "t [s]", 8e-3, 1e-14,
     "its end"},
    {"[output.tracking]", "samples", "orbits", "samples = 16", "samples = 32", "t_orbits.csv", 1,
     "angle [deg]", 11.25, 1e-9, "of 360 deg"},
    {"[output.tracking]", "orbit_turns", "orbits", "orbit_turns = 2", "orbit_turns = 3",
     "t_orbits.csv", -1, "angle [deg]", 1080, 1e-9, "three turns"},
    {"[output.tracking]", "bandwidth", "beat", "bandwidth = 2", "bandwidth = 0.5", "t_tracking.csv",
     20, "P.y 1X [m]", 0, 1e-10, "half an order away: the window lets nothing through"},
    {"[[joint]], kind = \"hinge\"", "axis", "arms at rest", "axis = [0, 0, 1]\nstiffness = \"1000",
     "axis = [0, 1, 0]\nstiffness = \"1000", "t.csv", -1, "joint H angle [rad]",
     -0.0076920830411221, 1e-9, "bends under the other force"},
    {"[[joint]], kind = \"hinge\"", "stiffness", "arms at rest", "1000 N.m/rad", "2000 N.m/rad",
     "t.csv", -1, "joint H angle [rad]", 0.0098034535352471, 1e-9, "in balance"},
    {"[[joint]], kind = \"hinge\"", "damping", "arms in motion", "2 N.m.s/rad", "4 N.m.s/rad",
     "t.csv", -1, "joint H angle [rad]", 0.466715116482535, 1e-7,
     "M/c (t - I/c (1 - exp(-c t/I)))"},
    {"[[joint]], kind = \"slider\"", "axis", "arms at rest", "axis = [0, 0, 1]\nstiffness = \"2000",
     "axis = [0, 2, 0]\nstiffness = \"2000", "t.csv", -1, "joint S slide [m]", 0.0025, 1e-10,
     "5 N/k"},
    {"[[joint]], kind = \"slider\"", "stiffness", "arms at rest", "2000 N/m", "1000 N/m", "t.csv",
     -1, "joint S slide [m]", 0.06, 1e-10, "F/k"},
    {"[[joint]], kind = \"slider\"", "damping", "arms in motion", "20 N.s/m", "40 N.s/m", "t.csv",
     -1, "joint S slide [m]", 0.754578909722184, 1e-7, "F/c (t - m/c (1 - exp(-c t/m)))"},
    {"[[joint]], kind = \"universal\"", "axis", "arms at rest", "axis = [0, 1, 0]\nsecond",
     "axis = [0, 1, 1]\nsecond", "t.csv", -1, "joint U angle [rad]", -0.530499703318932, 1e-9,
     "-asin(sqrt(2) F_z/F)"},
    {"[[joint]], kind = \"universal\"", "second_axis", "arms at rest", "second_axis = [0, 0, 1]",
     "second_axis = [0, 1, 1]", "t.csv", -1, "joint U angle [rad]", -0.676540217694394, 1e-9,
     "-asin (F_y + F_z)/F"},
    // the mass on its magnets: (-w^2 M - k_s + k_i G) q = F at 30 Hz, and what holds its weight
    {"[[bearing]], type = \"magnetic\"", "current_stiffness", "magnet",
     "current_stiffness = \"200 N/A\"", "current_stiffness = \"300 N/A\"", "h_response.csv", 0,
     "P y amplitude [m]", 6.58819401625e-05, 6.6e-14, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "position_stiffness", "magnet",
     "position_stiffness = \"1e5 N/m\"", "position_stiffness = \"3e5 N/m\"", "h_response.csv", 0,
     "P y amplitude [m]", 0.000137581846287, 1.4e-13, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "sensor_bandwidth", "magnet",
     "sensor_bandwidth = \"500 Hz\"", "sensor_bandwidth = \"100 Hz\"", "h_response.csv", 0,
     "P y amplitude [m]", 0.0001269874863935, 1.3e-13, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "amplifier_bandwidth", "magnet",
     "amplifier_bandwidth = \"300 Hz\"", "amplifier_bandwidth = \"80 Hz\"", "h_response.csv", 0,
     "P y amplitude [m]", 0.0001314546616148, 1.3e-13, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "delay", "magnet", "delay = \"200 us\"",
     "delay = \"2 ms\"", "h_response.csv", 0, "P y amplitude [m]", 0.0001203820310518, 1.2e-13,
     "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "delay_order", "magnet", "delay = \"200 us\"",
     "delay = \"5 ms\"\ndelay_order = 1", "h_response.csv", 0, "P y amplitude [m]",
     0.0001116944032051, 1.1e-13, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "power", "magnet", "delay = \"200 us\"",
     "delay = \"200 us\"\npower = 0.8", "h_response.csv", 0, "P y amplitude [m]",
     0.0002203918998198, 2.2e-13, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "control_2", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control_2]]\ntype = \"pid\"\np = \"3000 A/m\"", "h_response.csv",
     0, "P z amplitude [m]", 0.001148802629594, 1.1e-12, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "angle", "magnet",
     "delay = \"200 us\"\n[[bearing.control]]\ntype = \"pid\"\np = \"5000 A/m\"",
     "delay = \"200 us\"\nangle = \"30 deg\"\n[[bearing.control_2]]\ntype = \"pid\"\np = \"3000 "
     "A/m\"\n[[bearing.control]]\ntype = \"pid\"\np = \"5000 A/m\"",
     "h_response.csv", 0, "P y amplitude [m]", 0.0003585392488984, 3.6e-13, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "cross", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.cross]]\ntype = \"pid\"\np = \"1000 A/m\"", "h_response.csv", 0,
     "P y amplitude [m]", 8.579039631433e-05, 8.6e-14, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "control", "magnet",
     "\n[[bearing.control]]\ntype = \"pid\"\np = \"5000 A/m\"",
     "\n[[bearing.control]]\ntype = \"pid\"\np = \"4000 A/m\"", "h_response.csv", 0,
     "P y amplitude [m]", 0.0001319691991259, 1.3e-13, "Z q = F"},
    {"[[bearing.control]], type = \"pid\"", "p", "magnet", "p = \"5000 A/m\"", "p = \"4000 A/m\"",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001319691991259, 1.3e-13, "Z q = F"},
    {"[[bearing.control]], type = \"pid\"", "i", "magnet", "i = \"2e4 A/(m.s)\"",
     "i = \"5e5 A/(m.s)\"", "h_response.csv", 0, "P y amplitude [m]", 0.0001588560639193, 1.6e-13,
     "Z q = F"},
    {"[[bearing.control]], type = \"pid\"", "d", "magnet", "d = \"20 A.s/m\"", "d = \"10 A.s/m\"",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001568501062243, 1.6e-13, "Z q = F"},
    {"[[bearing.control]], type = \"pid\"", "lag", "magnet", "lag = \"500 us\"", "lag = \"5 ms\"",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001037285239409, 1.0e-13, "Z q = F"},
    {"[[bearing.control]], type = \"lead_lag\"", "zero", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"lead_lag\"\nzero = \"20 Hz\"\npole = \"200 "
     "Hz\"",
     "h_response.csv", 0, "P y amplitude [m]", 4.582662833179e-05, 4.6e-14, "Z q = F"},
    {"[[bearing.control]], type = \"lead_lag\"", "pole", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"lead_lag\"\nzero = \"50 Hz\"\npole = \"90 "
     "Hz\"",
     "h_response.csv", 0, "P y amplitude [m]", 9.236114424184e-05, 9.2e-14, "Z q = F"},
    {"[[bearing.control]], type = \"notch\"", "frequency", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"notch\"\nfrequency = \"60 Hz\"",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001593189835791, 1.6e-13, "Z q = F"},
    {"[[bearing.control]], type = \"notch\"", "damping", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"notch\"\nfrequency = \"60 Hz\"\ndamping = "
     "0.2",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001261218534015, 1.3e-13, "Z q = F"},
    {"[[bearing.control]], type = \"notch\"", "depth", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"notch\"\nfrequency = \"60 Hz\"\ndepth = 0.4",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001531415196922, 1.5e-13, "Z q = F"},
    {"[[bearing.control]], type = \"low_pass\"", "frequency", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"low_pass\"\nfrequency = \"70 Hz\"",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001378210065612, 1.4e-13, "Z q = F"},
    {"[[bearing.control]], type = \"low_pass\"", "order", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"low_pass\"\nfrequency = \"70 Hz\"\norder = 3",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001105373908451, 1.1e-13, "Z q = F"},
    {"[[bearing.control]], type = \"transfer\"", "numerator", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"transfer\"\nnumerator = [1, "
     "0.003]\ndenominator = [1, 0.01]",
     "h_response.csv", 0, "P y amplitude [m]", 0.0003924680614887, 3.9e-13, "Z q = F"},
    {"[[bearing.control]], type = \"transfer\"", "denominator", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"transfer\"\nnumerator = [1]\ndenominator = "
     "[1, 0.004, 1e-5]",
     "h_response.csv", 0, "P y amplitude [m]", 0.000109749047009, 1.1e-13, "Z q = F"},
    {"[[bearing.control]], type = \"transfer\"", "gain", "magnet",
     "type = \"pid\"\np = \"5000 A/m\"\ni = \"2e4 A/(m.s)\"\nd = \"20 A.s/m\"\nlag = \"500 us\"",
     "type = \"transfer\"\ngain = \"4000 A/m\"\nnumerator = [1, 0.01]\ndenominator = [1, 0.001]",
     "h_response.csv", 0, "P y amplitude [m]", 7.407566978402e-05, 7.4e-14, "Z q = F"},
    {"[[bearing.control]], type = \"state_space\"", "order", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"state_space\"\norder = 2\ncolumns = "
     "[\"row\", \"column\", \"value\"]\nrows = [[1, 1, -100], [1, 2, 50], [1, 3, 100], [2, 1, "
     "-60], [2, 2, -200], [2, 3, 20], [3, 1, 0.7], [3, 2, 0.3], [3, 3, 0.4]]",
     "h_response.csv", 0, "P y amplitude [m]", 0.0002587027480305, 2.6e-13, "Z q = F"},
    {"[[bearing.control]], type = \"state_space\"", "row", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"state_space\"\norder = 2\ncolumns = "
     "[\"row\", \"column\", \"value\"]\nrows = [[1, 1, -100], [1, 2, 50], [1, 3, 100], [2, 1, "
     "-60], [2, 2, -200], [2, 3, 20], [3, 1, 0.7], [3, 2, 0.3], [3, 3, 0.4]]",
     "h_response.csv", 0, "P y amplitude [m]", 0.0002587027480305, 2.6e-13, "Z q = F"},
    {"[[bearing.control]], type = \"state_space\"", "column", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"state_space\"\norder = 2\ncolumns = "
     "[\"row\", \"column\", \"value\"]\nrows = [[1, 1, -100], [1, 2, 50], [1, 3, 100], [2, 1, "
     "-60], [2, 2, -200], [2, 3, 20], [3, 1, 0.7], [3, 2, 0.3], [3, 3, 0.4]]",
     "h_response.csv", 0, "P y amplitude [m]", 0.0002587027480305, 2.6e-13, "Z q = F"},
    {"[[bearing.control]], type = \"state_space\"", "value", "magnet", "lag = \"500 us\"",
     "lag = \"500 us\"\n[[bearing.control]]\ntype = \"state_space\"\norder = 2\ncolumns = "
     "[\"row\", \"column\", \"value\"]\nrows = [[1, 1, -100], [1, 2, 50], [1, 3, 100], [2, 1, "
     "-60], [2, 2, -200], [2, 3, 20], [3, 1, 0.7], [3, 2, 0.3], [3, 3, 0.4]]",
     "h_response.csv", 0, "P y amplitude [m]", 0.0002587027480305, 2.6e-13, "Z q = F"},
    {"[[bearing.control]], type = \"state_space\"", "gain", "magnet",
     "type = \"pid\"\np = \"5000 A/m\"\ni = \"2e4 A/(m.s)\"\nd = \"20 A.s/m\"\nlag = \"500 us\"",
     "type = \"state_space\"\ngain = \"4000 A/m\"\norder = 1\ncolumns = [\"row\", \"column\", "
     "\"value\"]\nrows = [[1, 1, -1000], [1, 2, -9000], [2, 1, 1], [2, 2, 10]]",
     "h_response.csv", 0, "P y amplitude [m]", 7.407566978402e-05, 7.4e-14, "Z q = F"},
    {"[[bearing]], type = \"magnetic\"", "setpoint", "magnet", "delay = \"200 us\"",
     "delay = \"200 us\"\nsetpoint = [\"0 um\", \"-40 um\"]", "st_deflection.csv", 1, "u_z [m]",
     -4e-05, 4.0e-14, "held there by the integral"},
    {"[[bearing]], type = \"magnetic\"", "bias_current", "magnet", "delay = \"200 us\"",
     "delay = \"200 us\"\nbias_current = \"2 A\"\ngap = \"0.5 mm\"\nsetpoint = [\"0 um\", \"-40 "
     "um\"]",
     "st_magnets.csv", 1, "control current [A]", 0.5114914065576, 5.1e-10, "the square law"},
    {"[[bearing]], type = \"magnetic\"", "gap", "magnet", "delay = \"200 us\"",
     "delay = \"200 us\"\nbias_current = \"2 A\"\ngap = \"0.25 mm\"\nsetpoint = [\"0 um\", \"-40 "
     "um\"]",
     "st_magnets.csv", 1, "control current [A]", 0.5114914065576, 5.1e-10, "the square law"},
    {"[[bearing]], type = \"magnetic\"", "saturation", "magnet", "delay = \"200 us\"",
     "delay = \"200 us\"\nbias_current = \"2 A\"\ngap = \"0.5 mm\"\nsetpoint = [\"0 um\", \"-40 "
     "um\"]\nsaturation = \"150 N\"",
     "st_magnets.csv", 1, "control current [A]", 0.7573247222129, 7.6e-10,
     "the square law saturated"},
    {"[[bearing]], type = \"magnetic\"", "max_current", "magnet", "delay = \"200 us\"",
     "delay = \"200 us\"\nmax_current = \"0.5 A\"", "st_magnets.csv", 1, "control current [A]",
     0.6244056194446, 6.2e-10, "W/k_i, limited"},
    {"[[step]], type = \"sensitivity\"", "frequency", "magnet", "values = [\"25 Hz\"]",
     "values = [\"55 Hz\"]", "s_sensitivity.csv", 0, "largest sensitivity [-]", 1.531434053158,
     1.5e-09, "1/(1 + L)"},
    // the block on its bearing, shaken at 30 Hz: (K + i w C - w^2 M) q = F
    {"[[bearing]], type = \"linear\"", "kxx", "block", "kxx = \"1e6 N/m\"", "kxx = \"400000 N/m\"",
     "h_response.csv", 0, "bearing block force x [N]", 825.54677836311, 8.3e-07, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kzz", "block", "kzz = \"3e6 N/m\"", "kzz = \"400000 N/m\"",
     "h_response.csv", 0, "E z amplitude [m]", 0.0041441490395528, 4.1e-12, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kyz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkyz = \"400000 N/m\"", "h_response.csv", 0, "P y amplitude [m]",
     9.4004888855293e-05, 9.4e-14, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kzy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkzy = \"400000 N/m\"", "h_response.csv", 0, "E z amplitude [m]",
     6.7067070102623e-05, 6.7e-14, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kxy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkxy = \"400000 N/m\"", "h_response.csv", 0,
     "bearing block force x [N]", 128.31298569423, 1.3e-07, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kxz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkxz = \"400000 N/m\"", "h_response.csv", 0,
     "bearing block force x [N]", 130.10748955083, 1.3e-07, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kyx", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkyx = \"400000 N/m\"", "h_response.csv", 0, "P y amplitude [m]",
     8.3896284815169e-05, 8.4e-14, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kzx", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkzx = \"400000 N/m\"", "h_response.csv", 0, "E z amplitude [m]",
     6.201435556892e-05, 6.2e-14, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "krr", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"5000 N.m/rad\"", "h_response.csv", 0, "E y amplitude [m]", 0.00032568795375745,
     3.3e-13, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kryy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkryy = \"5000 N.m/rad\"", "h_response.csv", 0, "E z amplitude [m]",
     6.2464062958868e-05, 6.2e-14, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "krzz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkrzz = \"5000 N.m/rad\"", "h_response.csv", 0, "E y amplitude [m]",
     0.00032568795375745, 3.3e-13, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "kryz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkryz = \"5000 N.m/rad\"", "h_response.csv", 0, "E z amplitude [m]",
     9.4820305762876e-05, 9.5e-14, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "krzy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nkrzy = \"5000 N.m/rad\"", "h_response.csv", 0, "E y amplitude [m]",
     0.00014731628589148, 1.5e-13, "(K q = F)"},
    {"[[bearing]], type = \"linear\"", "cxx", "block", "cxx = \"100 N.s/m\"", "cxx = \"500 N.s/m\"",
     "h_response.csv", 0, "bearing block force x [N]", 154.16105372658, 1.5e-07, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "cyy", "block", "cyy = \"200 N.s/m\"", "cyy = \"500 N.s/m\"",
     "h_response.csv", 0, "P y amplitude [m]", 0.0001214039820292, 1.2e-13, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "czz", "block", "czz = \"300 N.s/m\"", "czz = \"500 N.s/m\"",
     "h_response.csv", 0, "E z amplitude [m]", 8.5394272964895e-05, 8.5e-14, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "cyz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\ncyz = \"500 N.s/m\"", "h_response.csv", 0, "P y amplitude [m]",
     0.00012160593411139, 1.2e-13, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "czy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nczy = \"500 N.s/m\"", "h_response.csv", 0, "P z amplitude [m]",
     0.00011339219749305, 1.1e-13, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "cxy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\ncxy = \"500 N.s/m\"", "h_response.csv", 0, "bearing block force x [N]",
     154.93843137531, 1.5e-07, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "cxz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\ncxz = \"500 N.s/m\"", "h_response.csv", 0, "bearing block force x [N]",
     154.94851790723, 1.5e-07, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "cyx", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\ncyx = \"500 N.s/m\"", "h_response.csv", 0, "P y amplitude [m]",
     0.00012163609809969, 1.2e-13, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "czx", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nczx = \"500 N.s/m\"", "h_response.csv", 0, "P z amplitude [m]",
     0.00011338183111744, 1.1e-13, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "crr", "block", "crr = \"3 N.m.s/rad\"",
     "crr = \"8 N.m.s/rad\"", "h_response.csv", 0, "E z amplitude [m]", 8.5598028346781e-05,
     8.6e-14, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "cryy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\ncryy = \"8 N.m.s/rad\"", "h_response.csv", 0, "E z amplitude [m]",
     8.5598028346781e-05, 8.6e-14, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "crzz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\ncrzz = \"8 N.m.s/rad\"", "h_response.csv", 0, "E y amplitude [m]",
     0.00015498228992804, 1.5e-13, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "cryz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\ncryz = \"8 N.m.s/rad\"", "h_response.csv", 0, "E z amplitude [m]",
     8.5616765603944e-05, 8.6e-14, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "crzy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\ncrzy = \"8 N.m.s/rad\"", "h_response.csv", 0, "E y amplitude [m]",
     0.00015505987125439, 1.6e-13, "(C q = F)"},
    {"[[bearing]], type = \"linear\"", "mxx", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmxx = \"2 kg\"", "h_response.csv", 0, "bearing block force x [N]",
     161.88550962577, 1.6e-07, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "myy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmyy = \"2 kg\"", "h_response.csv", 0, "P y amplitude [m]",
     0.00012705797397194, 1.3e-13, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mzz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmzz = \"2 kg\"", "h_response.csv", 0, "E z amplitude [m]",
     8.857160020072e-05, 8.9e-14, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "myz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmyz = \"2 kg\"", "h_response.csv", 0, "P y amplitude [m]",
     0.00012646882619904, 1.3e-13, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mzy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmzy = \"2 kg\"", "h_response.csv", 0, "E z amplitude [m]",
     8.8706674918032e-05, 8.9e-14, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mxy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmxy = \"2 kg\"", "h_response.csv", 0, "bearing block force x [N]",
     159.82865982913, 1.6e-07, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mxz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmxz = \"2 kg\"", "h_response.csv", 0, "bearing block force x [N]",
     159.50966091665, 1.6e-07, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "myx", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmyx = \"2 kg\"", "h_response.csv", 0, "P y amplitude [m]",
     0.00012826571170927, 1.3e-13, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mzx", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmzx = \"2 kg\"", "h_response.csv", 0, "E z amplitude [m]",
     8.960489234159e-05, 9e-14, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mrr", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmrr = \"0.02 kg.m^2\"", "h_response.csv", 0, "E z amplitude [m]",
     8.4285495281642e-05, 8.4e-14, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mryy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmryy = \"0.02 kg.m^2\"", "h_response.csv", 0, "E z amplitude [m]",
     8.4285495281642e-05, 8.4e-14, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mrzz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmrzz = \"0.02 kg.m^2\"", "h_response.csv", 0, "E y amplitude [m]",
     0.00015652089372087, 1.6e-13, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mryz", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmryz = \"0.02 kg.m^2\"", "h_response.csv", 0, "E z amplitude [m]",
     8.4109256706979e-05, 8.4e-14, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mrzy", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmrzy = \"0.02 kg.m^2\"", "h_response.csv", 0, "E y amplitude [m]",
     0.00015624362063202, 1.6e-13, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "mrxx", "block", "krr = \"2e4 N.m/rad\"",
     "krr = \"2e4 N.m/rad\"\nmrxx = \"0.02 kg.m^2\"", "h_response.csv", 0,
     "P twist amplitude [rad]", 0.00069580882631539, 7e-13, "(M q = F)"},
    {"[[bearing]], type = \"linear\"", "K", "block",
     "kxx = \"1e6 N/m\"\nkyy = \"2e6 N/m\"\nkzz = \"3e6 N/m\"\nkrr = \"2e4 N.m/rad\"\nkrxx = \"1e4 "
     "N.m/rad\"\ncxx = \"100 N.s/m\"\ncyy = \"200 N.s/m\"\nczz = \"300 N.s/m\"\ncrr = \"3 "
     "N.m.s/rad\"\ncrxx = \"2 N.m.s/rad\"",
     "cxx = \"100 N.s/m\"\ncyy = \"200 N.s/m\"\nczz = \"300 N.s/m\"\ncrr = \"3 N.m.s/rad\"\ncrxx = "
     "\"2 N.m.s/rad\"\nK = [[\"2e+06 N/m\", \"100000 N/m\", \"0 N/m\", \"0 N/rad\", \"10000 "
     "N/rad\", \"0 N/rad\"], [\"100000 N/m\", \"1e+06 N/m\", \"200000 N/m\", \"30000 N/rad\", \"0 "
     "N/rad\", \"0 N/rad\"], [\"0 N/m\", \"-200000 N/m\", \"3e+06 N/m\", \"0 N/rad\", \"0 N/rad\", "
     "\"20000 N/rad\"], [\"0 N/rad\", \"30000 N/rad\", \"0 N/rad\", \"10000 N.m/rad\", \"1000 "
     "N.m/rad\", \"0 N.m/rad\"], [\"10000 N/rad\", \"0 N/rad\", \"0 N/rad\", \"1000 N.m/rad\", "
     "\"20000 N.m/rad\", \"2000 N.m/rad\"], [\"0 N/rad\", \"0 N/rad\", \"20000 N/rad\", \"0 "
     "N.m/rad\", \"-2000 N.m/rad\", \"20000 N.m/rad\"]]",
     "h_response.csv", 0, "P y amplitude [m]", 0.00029901033275503, 3e-13, "the whole matrix"},
    {"[[bearing]], type = \"linear\"", "C", "block",
     "kxx = \"1e6 N/m\"\nkyy = \"2e6 N/m\"\nkzz = \"3e6 N/m\"\nkrr = \"2e4 N.m/rad\"\nkrxx = \"1e4 "
     "N.m/rad\"\ncxx = \"100 N.s/m\"\ncyy = \"200 N.s/m\"\nczz = \"300 N.s/m\"\ncrr = \"3 "
     "N.m.s/rad\"\ncrxx = \"2 N.m.s/rad\"",
     "kxx = \"1e6 N/m\"\nkyy = \"2e6 N/m\"\nkzz = \"3e6 N/m\"\nkrr = \"2e4 N.m/rad\"\nkrxx = \"1e4 "
     "N.m/rad\"\nC = [[\"300 N.s/m\", \"50 N.s/m\", \"0 N.s/m\", \"0 N.s/rad\", \"20 N.s/rad\", "
     "\"0 N.s/rad\"], [\"50 N.s/m\", \"400 N.s/m\", \"60 N.s/m\", \"10 N.s/rad\", \"0 N.s/rad\", "
     "\"0 N.s/rad\"], [\"0 N.s/m\", \"-60 N.s/m\", \"100 N.s/m\", \"0 N.s/rad\", \"0 N.s/rad\", "
     "\"15 N.s/rad\"], [\"0 N.s/rad\", \"10 N.s/rad\", \"0 N.s/rad\", \"4 N.m.s/rad\", \"1 "
     "N.m.s/rad\", \"0 N.m.s/rad\"], [\"20 N.s/rad\", \"0 N.s/rad\", \"0 N.s/rad\", \"1 "
     "N.m.s/rad\", \"5 N.m.s/rad\", \"0.5 N.m.s/rad\"], [\"0 N.s/rad\", \"0 N.s/rad\", \"15 "
     "N.s/rad\", \"0 N.m.s/rad\", \"-0.5 N.m.s/rad\", \"2 N.m.s/rad\"]]",
     "h_response.csv", 0, "E z amplitude [m]", 8.636715152609e-05, 8.6e-14, "the whole matrix"},
    {"[[bearing]], type = \"linear\"", "M", "block",
     "kxx = \"1e6 N/m\"\nkyy = \"2e6 N/m\"\nkzz = \"3e6 N/m\"\nkrr = \"2e4 N.m/rad\"\nkrxx = \"1e4 "
     "N.m/rad\"\ncxx = \"100 N.s/m\"\ncyy = \"200 N.s/m\"\nczz = \"300 N.s/m\"\ncrr = \"3 "
     "N.m.s/rad\"\ncrxx = \"2 N.m.s/rad\"",
     "kxx = \"1e6 N/m\"\nkyy = \"2e6 N/m\"\nkzz = \"3e6 N/m\"\nkrr = \"2e4 N.m/rad\"\nkrxx = \"1e4 "
     "N.m/rad\"\ncxx = \"100 N.s/m\"\ncyy = \"200 N.s/m\"\nczz = \"300 N.s/m\"\ncrr = \"3 "
     "N.m.s/rad\"\ncrxx = \"2 N.m.s/rad\"\nM = [[\"3 kg\", \"1 kg\", \"0 kg\", \"0 kg.m\", \"0.1 "
     "kg.m\", \"0 kg.m\"], [\"1 kg\", \"2 kg\", \"0 kg\", \"0.2 kg.m\", \"0 kg.m\", \"0 kg.m\"], "
     "[\"0 kg\", \"0 kg\", \"4 kg\", \"0 kg.m\", \"0 kg.m\", \"0.1 kg.m\"], [\"0 kg.m\", \"0.2 "
     "kg.m\", \"0 kg.m\", \"0.05 kg.m^2\", \"0 kg.m^2\", \"0 kg.m^2\"], [\"0.1 kg.m\", \"0 kg.m\", "
     "\"0 kg.m\", \"0 kg.m^2\", \"0.04 kg.m^2\", \"0.01 kg.m^2\"], [\"0 kg.m\", \"0 kg.m\", \"0.1 "
     "kg.m\", \"0 kg.m^2\", \"0.01 kg.m^2\", \"0.03 kg.m^2\"]]",
     "h_response.csv", 0, "P twist amplitude [rad]", 0.0010602820936796, 1.1e-12,
     "the whole matrix"},
    {"[[disk]]", "Id", "block", "Id = \"0.06 kg.m^2\"", "Id = \"0.5 kg.m^2\"", "h_response.csv", 0,
     "E y amplitude [m]", 0.00037976493430805, 3.8e-13, "(K - w^2 M) q = F"},
    {"[[disk]]", "inertia", "block", "Ip = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"",
     "inertia = [\"0.2 kg.m^2\", \"0.3 kg.m^2\", \"0.4 kg.m^2\", \"0.03 kg.m^2\", \"0.02 kg.m^2\", "
     "\"0.05 kg.m^2\"]",
     "h_response.csv", 0, "P twist amplitude [rad]", 0.0021553371466938, 2.2e-12,
     "(K + i w C - w^2 J) q = M with all of J, as the disk lies"},
    {"[[disk]]", "od", "block", "mass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"",
     "od = \"300 mm\"\nwidth = \"20 mm\"\nmaterial = \"m\"\n[[material]]\nname = \"m\"\nE = \"200 "
     "GPa\"\nG = \"80 GPa\"\ndensity = \"8000 kg/m^3\"",
     "h_response.csv", 0, "P twist amplitude [rad]", 0.00072830047792679, 7.3e-13,
     "m = rho pi/4 od^2 width"},
    {"[[disk]]", "id", "block", "mass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"",
     "od = \"300 mm\"\nid = \"100 mm\"\nwidth = \"20 mm\"\nmaterial = \"m\"\n[[material]]\nname = "
     "\"m\"\nE = \"200 GPa\"\nG = \"80 GPa\"\ndensity = \"8000 kg/m^3\"",
     "h_response.csv", 0, "P twist amplitude [rad]", 0.00072099098315809, 7.2e-13, "with a bore"},
    {"[[disk]]", "width", "block", "mass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"",
     "od = \"300 mm\"\nwidth = \"50 mm\"\nmaterial = \"m\"\n[[material]]\nname = \"m\"\nE = \"200 "
     "GPa\"\nG = \"80 GPa\"\ndensity = \"8000 kg/m^3\"",
     "h_response.csv", 0, "P twist amplitude [rad]", 0.0029514276419312, 3e-12,
     "m = rho pi/4 od^2 width"},
    {"[[disk]]", "material", "block", "mass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"",
     "od = \"300 mm\"\nwidth = \"20 mm\"\nmaterial = \"m\"\n[[material]]\nname = \"m\"\nE = \"200 "
     "GPa\"\nG = \"80 GPa\"\ndensity = \"3000 kg/m^3\"",
     "h_response.csv", 0, "P twist amplitude [rad]", 0.00048115761950826, 4.8e-13,
     "m = rho pi/4 od^2 width"},
    {"[[disk]]", "offset", "block", "mass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"",
     "mass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"\noffset = [\"20 mm\", \"0 mm\", "
     "\"0 mm\"]",
     "h_response.csv", 0, "E y amplitude [m]", 0.00016201117170462, 1.6e-13, "parallel axes"},
    {"[[disk]]", "skew", "block", "mass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"",
     "mass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.06 kg.m^2\"\nskew = \"30 deg\"",
     "h_response.csv", 0, "E z amplitude [m]", 8.2721634332429e-05, 8.3e-14,
     "(K + i w C - w^2 J) q = M, J turned by 30 deg about z"},
    // a torque on Ip = 0.1 kg m2, after 1 s
    {"[[drive]], type = \"torque\"", "load", "events", "torque = \"1 N.m\"",
     "torque = \"1 N.m\"\nload = { viscous = \"0.1 N.m.s/rad\" }", "t.csv", -1, "speed [rpm]",
     60.363066940546, 1e-5, "T/c (1 - exp(-c t/Ip))"},
    {"[[drive]], type = \"torque\"", "dc", "events", "torque = \"1 N.m\"",
     "dc = { stall = \"2 N.m\", no_load_speed = \"30 rad/s\" }", "t.csv", -1, "speed [rpm]",
     139.39572731374, 1e-5, "s0 (1 - exp(-T t/(Ip s0)))"},
    {"[[drive]], type = \"torque\"", "constant_power", "events", "torque = \"1 N.m\"",
     "constant_power = { power = \"0.005 kW\", max_torque = \"1 N.m\" }", "t.csv", -1,
     "speed [rpm]", 82.699334313269, 1e-5, "at the limit up to P/T, then sqrt(2 P t/Ip)"},
    {"[[drive]], type = \"torque\"", "brake", "events", "torque = \"1 N.m\"",
     "torque = \"1 N.m\"\nbrake = \"0.4 N.m\"", "t.csv", -1, "speed [rpm]", 57.295779513082, 0.3,
     "(T - brake) t/Ip, but for the start"},
    {"[[drive]], type = \"torque\"", "speed", "events", "torque = \"1 N.m\"",
     "columns = [\"speed[rad/s]\", \"torque[N.m]\"]\nrows = [[0, 2], [20, 0]]", "t.csv", -1,
     "speed [rpm]", 120.72613388109, 1e-5, "s0 (1 - exp(-T t/(Ip s0)))"},
    {"[drive.constant_power]", "power", "events", "torque = \"1 N.m\"",
     "constant_power = { power = \"0.02 kW\", max_torque = \"10 N.m\" }", "t.csv", -1,
     "speed [rpm]", 190.02860271583, 1e-5, "P = 20 W"},
    {"[drive.constant_power]", "max_torque", "events", "torque = \"1 N.m\"",
     "constant_power = { power = \"0.005 kW\", max_torque = \"0.2 N.m\" }", "t.csv", -1,
     "speed [rpm]", 19.098593171027, 1e-5, "below P/T the limit holds"},
    {"law, type = \"cosine\"", "time", "events", "torque = \"1 N.m\"",
     "torque = { type = \"cosine\", time = [\"0 s\", \"1 s\"], value = [\"0 N.m\", \"4 N.m\"] }",
     "t.csv", -1, "speed [rpm]", 190.98593171027, 1e-5, "half of it"},
    {"law, type = \"cosine\"", "value", "events", "torque = \"1 N.m\"",
     "torque = { type = \"cosine\", time = [\"0 s\", \"1 s\"], value = [\"1 N.m\", \"4 N.m\"] }",
     "t.csv", -1, "speed [rpm]", 238.73241463784, 1e-5, "half of both"},
    {"[[pieces]]", "start", "events", "torque = \"1 N.m\"",
     "torque = { type = \"piecewise\", pieces = [{ start = \"0 s\", law = \"1 N.m\" }, { start = "
     "\"0.5 s\", law = \"3 N.m\" }] }",
     "t.csv", -1, "speed [rpm]", 190.98593171027, 1e-5, "1 and 3 N m"},
    {"[[pieces]]", "law", "events", "torque = \"1 N.m\"",
     "torque = { type = \"piecewise\", pieces = [{ start = \"0 s\", law = \"1 N.m\" }, { start = "
     "\"0.5 s\", law = \"5 N.m\" }] }",
     "t.csv", -1, "speed [rpm]", 286.47889756541, 1e-5, "1 and 5 N m"},
    {"law, type = \"sum\"", "terms", "events", "torque = \"1 N.m\"",
     "torque = { type = \"sum\", terms = [{ law = \"1 N.m\" }, { law = \"2 N.m\" }] }", "t.csv", -1,
     "speed [rpm]", 286.47889756541, 1e-5, "3 N m"},
    {"[[terms]]", "law", "events", "torque = \"1 N.m\"",
     "torque = { type = \"sum\", terms = [{ law = \"1 N.m\" }, { law = { type = \"ramp\", time = "
     "[\"0 s\", \"1 s\"], value = [\"0 N.m\", \"2 N.m\"] } }] }",
     "t.csv", -1, "speed [rpm]", 190.98593171027, 1e-5, "1 and 1 N m"},
};

double in_summary(const DeckRun& run, std::string path) {
  whirl::io::Value v = run.summary();
  for (std::size_t end = 0; end != std::string::npos;) {
    end = path.find('/');
    v = v.at(path.substr(0, end));
    path = end == std::string::npos ? "" : path.substr(end + 1);
  }
  return v.number();
}

double number_of(const DeckRun& run, const Pair& p) {
  EXPECT_EQ(run.exit, 0) << run.log;
  if (p.file == std::string("summary.json")) return in_summary(run, p.column);
  const auto csv = run.csv(p.file);
  const std::size_t rows = csv.rows.size();
  const std::size_t row =
      p.row < 0 ? rows - static_cast<std::size_t>(-p.row) : static_cast<std::size_t>(p.row);
  EXPECT_LT(row, rows) << p.file;
  return row < rows ? csv.rows[row][csv.column(p.column)] : std::nan("");
}

bool is_said(const DeckRun& run, const Said& s) {
  std::ostringstream file;
  file << std::ifstream(run.folder / "r" / s.file).rdbuf();
  const std::string text = s.file == std::string("log") ? run.log : file.str();
  const bool absent = s.text[0] == '!';
  return (text.find(s.text + absent) != std::string::npos) != absent;
}

/// All decks, by name.
whirl::test::Decks all_decks() {
  whirl::test::Decks decks = whirl::test::written_decks();
  decks["bar"] = bar;
  decks["hot bar"] = hot_bar();
  decks["weight"] = weight;
  decks["block"] = block;
  decks["magnet"] = magnet;
  whirl::test::add_key_decks(decks);
  return decks;
}

std::vector<Pair> all_pairs() {
  std::vector<Pair> out(std::begin(pairs), std::end(pairs));
  out.insert(out.end(), std::begin(whirl::test::more_pairs), std::end(whirl::test::more_pairs));
  return out;
}

struct Elsewhere {
  const char* table;
  const char* key;  ///< "*": every key of the table
  const char* where;
};

/// Keys without a pair: tests whose decks have the table, or why none is needed; "open": nothing
/// reads what the key changes yet.
const Elsewhere elsewhere[] = {
    {"Top level", "model", "a table: its keys have pairs or lines"},
    {"Top level", "material", "a table: its keys have pairs or lines"},
    {"Top level", "shaft", "a table: its keys have pairs or lines"},
    {"Top level", "disk", "a table: its keys have pairs or lines"},
    {"Top level", "bearing", "a table: its keys have pairs or lines"},
    {"Top level", "joint", "a table: its keys have pairs or lines"},
    {"Top level", "foundation", "a table: its keys have pairs or lines"},
    {"Top level", "crack", "a table: its keys have pairs or lines"},
    {"Top level", "unbalance", "a table: its keys have pairs or lines"},
    {"Top level", "load", "a table: its keys have pairs or lines"},
    {"Top level", "drive", "a table: its keys have pairs or lines"},
    {"Top level", "base", "a table: its keys have pairs or lines"},
    {"Top level", "event", "a table: its keys have pairs or lines"},
    {"Top level", "initial", "a table: its keys have pairs or lines"},
    {"Top level", "probe", "a table: its keys have pairs or lines"},
    {"Top level", "step", "a table: its keys have pairs or lines"},
    {"Top level", "title_block", "a table: its keys have pairs or lines"},
    {"Top level", "output", "a table: its keys have pairs or lines"},
    {"Top level", "sweep", "a table: its keys have pairs or lines"},
    {"Top level", "include", "deck/test_reader.cpp"},
    {"[[bearing]], type = \"magnetic\"", "sensor_at", "app/test_magnetic_bearings.cpp"},
    {"[[step]], type = \"sensitivity\"", "speed", "app/test_magnetic_bearings.cpp"},
    {"[[step]], type = \"sensitivity\"", "about", "app/test_magnetic_bearings.cpp"},
    {"[[bearing.control]]", "type", "each type has keys of its own"},
    {"[[bearing]], type = \"magnetic\"", "max_current_rate", "app/test_magnetic_bearings.cpp"},
    {"[[bearing]], type = \"magnetic\"", "control_both", "app/test_magnetic_bearings.cpp"},
    {"[bearing.control_both]", "*", "app/test_magnetic_bearings.cpp"},
    {"[[bearing.control_2]]", "*", "read as [[bearing.control]]"},
    {"[[bearing.control_2]], type = \"pid\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.control_2]], type = \"lead_lag\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.control_2]], type = \"notch\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.control_2]], type = \"low_pass\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.control_2]], type = \"transfer\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.control_2]], type = \"state_space\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.cross]]", "*", "read as [[bearing.control]]"},
    {"[[bearing.cross]], type = \"pid\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.cross]], type = \"lead_lag\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.cross]], type = \"notch\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.cross]], type = \"low_pass\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.cross]], type = \"transfer\"", "*", "read as [[bearing.control]]"},
    {"[[bearing.cross]], type = \"state_space\"", "*", "read as [[bearing.control]]"},
    {"[model]", "axis", "it has one word"},
    {"[model]", "chart_change",
     "validation/test_rigid_integrators.cpp, validation/test_extreme_tilt.cpp"},
    {"[model]", "keep_everything", "app/test_keep_everything.cpp: the same results"},
    {"[model]", "mesh", "a table: its keys have pairs or lines"},
    {"[model.mesh]", "*",
     "app/test_spectra.cpp, app/test_check_refuses.cpp, validation/test_full_sections.cpp"},
    {"[[material]]", "name", "a name"},
    {"[[shaft]]", "name", "a name"},
    {"[[shaft]]", "path", "a table: its keys have pairs or lines"},
    {"[[shaft]]", "mean_rotary_inertia", "validation/test_full_sections.cpp"},
    {"[[shaft]]", "bow", "a table: its keys have pairs or lines"},
    {"[[shaft]]", "damping", "a table: its keys have pairs or lines"},
    {"[[shaft]]", "section", "a table: its keys have pairs or lines"},
    {"[[shaft.path]]", "*", "app/test_static_stability.cpp"},
    {"[shaft.bow]", "*", "validation/test_static_rotor.cpp, validation/test_cracked_rotor.cpp"},
    {"[shaft.damping]", "*", "app/test_support_decks.cpp"},
    {"[[shaft.section]]", "name", "a name"},
    {"[[shaft.section]]", "mean_rotary_inertia", "validation/test_full_sections.cpp"},
    {"[[shaft.section]]", "general", "a table: its keys have pairs or lines"},
    {"[[shaft.section]]", "full", "validation/test_full_sections.cpp"},
    {"[shaft.section.full]", "*", "validation/test_full_sections.cpp"},
    {"[shaft.section.general]", "angle_r", "validation/test_full_sections.cpp"},
    {"[shaft.section.general]", "centroid", "validation/test_full_sections.cpp"},
    {"[shaft.section.general]", "shear_centre", "validation/test_full_sections.cpp"},
    {"[[shaft.section]]", "constants", "a table: its keys have pairs or lines"},
    {"[[disk]]", "name", "a name"},
    {"[[disk]]", "draw", "a table: its keys have pairs or lines"},
    {"[disk.draw]", "*", "meshes/test_scene.cpp"},
    {"[[joint]]", "*", "validation/test_joints.cpp, app/test_written_numbers.cpp"},
    {"[[joint]], kind = \"rigid\"", "arm", "app/test_written_numbers.cpp: an error without it"},
    {"[[bearing]]", "*", "app/test_cli.cpp, app/test_spectra.cpp"},
    {"[[bearing]], type = \"spring_block\"", "*", "app/test_cli.cpp, app/test_support_balance.cpp"},
    {"[[bearing]], type = \"table\"", "*", "app/test_spectra.cpp, app/test_linear_limits.cpp"},
    {"[[bearing]], type = \"rigid\"", "*", "app/test_spectra.cpp, app/lateral_mass.hpp"},
    {"[[bearing]], type = \"nonlinear_spring\", shape = \"polynomial\"", "*",
     "app/test_support_decks.cpp, app/test_support_balance.cpp"},
    {"[[bearing]], type = \"nonlinear_spring\", shape = \"one_sided\"", "*",
     "app/test_support_runs.cpp, app/test_support_decks.cpp"},
    {"[[bearing]], type = \"nonlinear_angular_spring\", shape = \"polynomial\"", "*",
     "app/test_support_decks.cpp, app/test_support_balance.cpp"},
    {"[[bearing]], type = \"nonlinear_angular_spring\", shape = \"one_sided\"", "*",
     "app/test_support_runs.cpp, app/test_support_decks.cpp"},
    {"[[bearing]], type = \"short_journal\"", "*", "app/test_spectra.cpp, app/test_oil_whirl.cpp"},
    {"[[bearing]], type = \"journal\"", "*",
     "app/test_support_decks.cpp, app/test_static_speeds.cpp"},
    {"[[bearing]], type = \"journal\", shape = \"two_grooves\"", "*",
     "app/test_support_decks.cpp, app/test_static_speeds.cpp"},
    {"[[bearing]], type = \"journal\", shape = \"lobes\"", "*", "app/test_support_decks.cpp"},
    {"[[bearing]], type = \"journal\", shape = \"grooves\"", "*", "app/test_recessed_journals.cpp"},
    {"[[bearing.axial_groove]]", "*", "app/test_recessed_journals.cpp"},
    {"[[bearing]], type = \"journal\", shape = \"pressure_dam\"", "*",
     "app/test_recessed_journals.cpp"},
    {"[[bearing]], type = \"journal\", shape = \"tapered_land\"", "*",
     "app/test_recessed_journals.cpp"},
    {"[[bearing]], type = \"tilting_pad\"", "*",
     "app/test_tilting_pads.cpp, app/test_unequal_pads.cpp"},
    {"[[bearing.pad]]", "*", "app/test_tilting_pads.cpp, app/test_unequal_pads.cpp"},
    {"[bearing.pad.pivot_contact]", "*", "app/test_unequal_pads.cpp"},
    {"[bearing.pad.pivot_contact], shape = \"ball\"", "*", "app/test_unequal_pads.cpp"},
    {"[bearing.pad.pivot_contact], shape = \"line\"", "*", "app/test_unequal_pads.cpp"},
    {"[bearing.pivot_contact]", "*", "app/test_tilting_pads.cpp"},
    {"[bearing.pivot_contact], shape = \"ball\"", "*", "app/test_tilting_pads.cpp"},
    {"[bearing.pivot_contact], shape = \"line\"", "*", "app/test_tilting_pads.cpp"},
    {"[bearing.heat]", "*", "app/test_hot_films.cpp, app/test_floating_rings.cpp"},
    {"[[bearing]], type = \"floating_ring\"", "*", "app/test_floating_rings.cpp"},
    {"[bearing.inner]", "*", "app/test_floating_rings.cpp"},
    {"[bearing.outer]", "*", "app/test_floating_rings.cpp"},
    {"[bearing.holes]", "*", "app/test_floating_rings.cpp"},
    {"[[bearing]], type = \"squeeze_film\"", "*",
     "app/test_support_decks.cpp, app/test_support_balance.cpp"},
    {"[[bearing]], type = \"roller\"", "*",
     "app/test_support_decks.cpp, app/test_rolling_loads.cpp"},
    {"[[bearing]], type = \"ball_estimate\"", "*", "app/test_support_balance.cpp"},
    {"[[bearing]], type = \"rub\"", "*", "app/test_support_runs.cpp, app/test_support_decks.cpp"},
    {"[[bearing]], type = \"annular_seal\"", "*",
     "app/test_support_decks.cpp, app/test_support_balance.cpp"},
    {"[[bearing]], type = \"cross_coupling\"", "*",
     "app/test_support_decks.cpp, app/test_support_balance.cpp"},
    {"[[bearing]], type = \"coupling\"", "*",
     "app/test_support_decks.cpp, app/test_support_balance.cpp"},
    {"[[bearing]], type = \"gear\"", "*", "app/test_support_runs.cpp, app/test_support_decks.cpp"},
    {"[bearing.support]", "*", "app/test_direction.cpp, app/test_support_runs.cpp"},
    {"[[foundation]]", "*", "app/test_support_decks.cpp, app/test_foundation_motion.cpp"},
    {"[[unbalance]]", "name", "a name"},
    {"[[crack]]", "*", "validation/test_cracked_rotor.cpp, app/test_cracks.cpp"},
    {"[[load]]", "name", "a name"},
    {"[[drive]]", "*", "app/test_resume.cpp, app/test_governor.cpp"},
    {"[[drive]], type = \"angle\"", "*", "app/test_step_speeds.cpp, app/test_energy_balance.cpp"},
    {"[drive.load]", "*", "app/test_resume.cpp"},
    {"[drive.induction]", "*", "validation/test_drives.cpp"},
    {"[drive.pulsation]", "*", "app/test_shaft_torques.cpp, app/key_decks.hpp"},
    {"[drive.dc]", "*", "validation/test_drives.cpp"},
    {"[drive.governor]", "*", "app/test_governor.cpp, validation/test_drives.cpp"},
    {"[base]", "*", "app/test_energy_balance.cpp"},
    {"[base.turn]", "*", "app/test_energy_balance.cpp, validation/test_foundations.cpp"},
    {"[[event]]", "name", "a name"},
    {"[[initial]]", "name", "a name"},
    {"[[probe]]", "*", "app/test_cli.cpp, app/test_resume.cpp"},
    {"[[step]]", "*", "app/test_cli.cpp, app/test_resume.cpp"},
    {"[[step]], type = \"static\"", "*", "app/test_resume.cpp, app/test_governor.cpp"},
    {"[step.speeds]", "*", "app/written_decks.hpp"},
    {"[step.path]", "*", "app/test_static_stability.cpp, app/written_decks.hpp"},
    {"[[step]], type = \"modal\"", "*", "app/test_cli.cpp, app/test_spectra.cpp"},
    {"[[step]], type = \"campbell\"", "*", "app/test_direction.cpp, app/test_support_decks.cpp"},
    {"[step.speed]", "*", "app/test_spectra.cpp, app/test_oil_whirl.cpp"},
    {"[[step]], type = \"critical_speeds\"", "*",
     "app/test_support_decks.cpp, app/test_linearised_about.cpp"},
    {"[[step]], type = \"unbalance_response\"", "*",
     "app/test_direction.cpp, app/test_support_decks.cpp"},
    {"[[step]], type = \"stability\"", "*", "app/test_spectra.cpp, app/test_oil_whirl.cpp"},
    {"[step.map]", "*", "app/written_decks.hpp"},
    {"[[step]], type = \"critical_map\"", "*",
     "app/test_check_refuses.cpp, app/test_support_decks.cpp"},
    {"[[step]], type = \"harmonic_response\"", "*",
     "app/test_direction.cpp, app/test_harmonic_limits.cpp"},
    {"[[step.force]]", "*", "app/test_direction.cpp, app/test_harmonic_limits.cpp"},
    {"[step.frequency]", "*", "app/test_direction.cpp, app/written_decks.hpp"},
    {"[[step]], type = \"torsional\"", "*", "app/written_decks.hpp"},
    {"[[step]], type = \"buckling\"", "*",
     "app/test_axial_force.cpp, app/test_static_stability.cpp"},
    {"[[step]], type = \"unbalance_response\"", "zones", "app/test_reports.cpp"},
    {"[[step]], type = \"unbalance_response\"", "balance_grade", "app/test_reports.cpp"},
    {"[step.zones]", "*", "app/test_reports.cpp"},
    {"[[step]], type = \"api_lateral\"", "*", "app/test_reports.cpp"},
    {"[[step.set]]", "*", "app/test_reports.cpp"},
    {"[step.clearances]", "*", "app/test_reports.cpp"},
    {"[step.stages]", "*", "app/test_reports.cpp"},
    {"[step.limits]", "*", "app/test_reports.cpp"},
    {"[[step]], type = \"api_torsional\"", "*", "app/test_reports.cpp"},
    {"[[step.torque]]", "*", "app/test_reports.cpp, app/test_shaft_torques.cpp"},
    {"[step.torque.harmonics]", "*", "app/test_shaft_torques.cpp"},
    {"[step.torque.crank]", "*", "app/test_shaft_torques.cpp"},
    {"[[step.event]]", "*", "app/test_shaft_torques.cpp"},
    {"[step.torques]", "*", "app/test_shaft_torques.cpp"},
    {"[[step]], type = \"transient\"", "torques", "app/test_shaft_torques.cpp"},
    {"[[step]], type = \"balancing\"", "*", "app/test_reports.cpp"},
    {"[[step.plane]]", "*", "app/test_reports.cpp"},
    {"[step.measured]", "*", "app/test_reports.cpp"},
    {"[[step.trial]]", "*", "app/test_reports.cpp"},
    {"[title_block]", "*", "app/test_reports.cpp"},
    {"[[step]], type = \"transient\"", "previous", "app/test_resume.cpp"},
    {"[[step]], type = \"transient\"", "previous_step", "app/test_resume.cpp"},
    {"[[step]], type = \"transient\"", "checkpoint", "app/test_resume.cpp"},
    {"[[step]], type = \"transient\"", "integrator", "a table: its keys have pairs or lines"},
    {"[output]", "directory",
     "app/test_check_refuses.cpp, and where it says nothing the command line of every test"},
    {"[output]", "tracking", "a table: its keys have pairs or lines"},
    {"[output]", "replay", "app/test_figures.cpp"},
    {"[output.spectra]", "*", "app/written_decks.hpp"},
    {"[[output.vtk]]", "*",
     "app/test_resume.cpp, app/test_frames_in_motion.cpp, app/test_view.cpp"},
    {"[sweep]", "*", "app/test_sweep.cpp"},
    {"Laws of time", "*", "app/test_cli.cpp"},
    {"law, type = \"table\"", "*", "app/test_spectra.cpp, app/test_linear_limits.cpp"},
    {"law, type = \"ramp\"", "*", "app/test_energy_balance.cpp"},
    {"law, type = \"smooth\"", "*", "app/test_step_speeds.cpp, app/test_energy_balance.cpp"},
    {"law, type = \"harmonic\"", "*", "app/test_energy_balance.cpp"},
    {"law, type = \"decaying\"", "*", "app/key_decks.hpp"},
    {"law, type = \"polynomial\"", "*", "app/test_step_speeds.cpp, app/test_energy_balance.cpp"},
    {"law, type = \"piecewise\"", "*", "validation/test_bearing_rotors.cpp"},
};

/// The tables of the reference that the program writes, with their keys.
std::set<std::pair<std::string, std::string>> keys_of_the_program() {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("whirl_keys_" + std::to_string(::getpid()));
  std::set<std::pair<std::string, std::string>> keys;
  if (std::system(("'" WHIRL_EXE "' schema --reference >'" + file.string() + "'").c_str()) != 0)
    return keys;
  std::ifstream in(file);
  std::string table;
  const std::regex key("^\\| `([^`]+)` \\|.*");
  std::smatch found;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("#"))
      table = line.substr(line.find_first_not_of("# "));
    else if (std::regex_match(line, found, key))
      keys.insert({table, found[1]});
  }
  std::filesystem::remove(file);
  return keys;
}

}  // namespace

TEST(KeysMatter, TheOtherDeckWritesWhatItsKeySays) {
  const whirl::test::Decks decks = all_decks();
  std::map<std::string, std::vector<Pair>> of_deck;  // each is run once without a change
  for (const Pair& p : all_pairs())
    of_deck[p.deck].push_back(p);
  for (const auto& [name, list] : of_deck) {
    std::vector<double> before;
    {
      const DeckRun run(decks.at(name));
      for (const Pair& p : list)
        before.push_back(number_of(run, p));
    }
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Pair& p = list[k];
      const std::string of = std::string(p.table) + " " + p.key + " in '" + p.deck + "'";
      const double after = number_of(DeckRun(whirl::test::changed(decks, name, p.from, p.to)), p);
      EXPECT_NEAR(after, p.after, p.tolerance) << of << ": " << p.why;
      EXPECT_GT(std::abs(before[k] - p.after), 10 * p.tolerance) << of << ": it changes nothing";
    }
  }
}

TEST(KeysMatter, TheOtherDeckSaysWhatItsKeyIs) {
  const whirl::test::Decks decks = all_decks();
  for (const Said& s : whirl::test::said) {
    const std::string of = std::string(s.table) + " " + s.key + " in '" + s.deck + "': " + s.why;
    EXPECT_FALSE(is_said(DeckRun(decks.at(s.deck)), s)) << of;
    EXPECT_TRUE(is_said(DeckRun(whirl::test::changed(decks, s.deck, s.from, s.to)), s)) << of;
  }
}

// With each key in its turn: what the program made of a deck, read again, is the same model.
TEST(KeysMatter, TheResolvedDeckSaysTheSame) {
  const whirl::test::Decks decks = all_decks();
  const auto expect_same = [](const std::string& text, const std::string& of) {
    const auto first = whirl::deck::read_deck_text(text, "d.toml");
    ASSERT_TRUE(first.ok()) << of << first.report();
    const auto second = whirl::deck::read_deck_text(first.model.resolved, "resolved.toml");
    ASSERT_TRUE(second.ok()) << of << second.report();
    EXPECT_EQ(whirl::ModelDump(first.model).text(), whirl::ModelDump(second.model).text()) << of;
    EXPECT_EQ(first.model.resolved, second.model.resolved) << of;
  };
  for (const Pair& p : all_pairs())
    expect_same(whirl::test::changed(decks, p.deck, p.from, p.to),
                std::string(p.table) + " " + p.key + " in '" + p.deck + "'");
  for (const auto& [name, deck] : decks)
    expect_same(deck, name);
}

namespace {

/// Defaults as the reference has them: "`"0 N"`" is "0 N"; words about a default are none.
std::map<std::pair<std::string, std::string>, std::string> defaults_of_the_reference() {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("whirl_defaults_" + std::to_string(::getpid()));
  std::map<std::pair<std::string, std::string>, std::string> out;
  if (std::system(("'" WHIRL_EXE "' schema --reference >'" + file.string() + "'").c_str()) != 0)
    return out;
  std::ifstream in(file);
  std::string table;
  const std::regex row("^\\| `([^`]+)` \\| [^|]* \\| `([^`|]+)` \\|.*");
  std::smatch found;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("#"))
      table = line.substr(line.find_first_not_of("# "));
    else if (std::regex_match(line, found, row))
      out[{table, found[1]}] = found[2];
  std::filesystem::remove(file);
  return out;
}

}  // namespace

// A default that stands in a deck is the one that counts where the key is left out.
TEST(KeysMatter, ADefaultWrittenOutChangesNothing) {
  const whirl::test::Decks decks = all_decks();
  const auto defaults = defaults_of_the_reference();
  const auto read = [](const std::string& text) {
    return whirl::deck::read_deck_text(text, "d.toml");
  };
  std::size_t tried = 0;
  for (const Pair& p : all_pairs()) {
    const auto found = defaults.find({p.table, p.key});
    if (found == defaults.end()) continue;
    const std::regex line("(^|\\n)" + std::string(p.key) + " = (\"[^\"]*\"|[-+.0-9a-z]+)(?=\\n|$)");
    const std::string to = p.to, written = std::string("$1") + p.key + " = " + found->second;
    if (!std::regex_search(to, line)) continue;
    const auto deck = [&](const std::string& as) {
      return read(whirl::test::changed(decks, p.deck, p.from, std::regex_replace(to, line, as)));
    };
    const auto without = deck("$1"), with = deck(written);
    if (!without.ok()) continue;  // what stands beside it needs the key
    ++tried;
    const std::string of = std::string(p.table) + " " + p.key + " in '" + p.deck + "'";
    EXPECT_TRUE(with.ok()) << of << with.report();
    EXPECT_EQ(whirl::ModelDump(without.model).text(), whirl::ModelDump(with.model).text()) << of;
  }
  EXPECT_GT(tried, 40u);
}

// The list of keys is the program's: a new one needs a pair or a line in the list, and what is
// listed exists.
TEST(KeysMatter, EveryKeyHasAPairOrALine) {
  const auto keys = keys_of_the_program();
  ASSERT_GT(keys.size(), 300u);
  std::set<std::pair<std::string, std::string>> known;
  for (const Pair& p : all_pairs())
    known.insert({p.table, p.key});
  for (const Said& s : whirl::test::said)
    known.insert({s.table, s.key});
  for (const Elsewhere& e : elsewhere)
    known.insert({e.table, e.key});
  for (const auto& [table, key] : keys)
    EXPECT_TRUE(known.contains({table, key}) || known.contains({table, "*"}))
        << table << " " << key;
  for (const auto& [table, key] : known)
    EXPECT_TRUE(
        keys.contains({table, key}) ||
        (key == "*" && std::any_of(keys.begin(), keys.end(),
                                   [&, of = table](const auto& k) { return k.first == of; })))
        << table << " " << key << " is no key";
}
