// The rotor whose oil whirl is looked at by eigenvalues and in time.
#pragma once
#include <string>

namespace whirl::test {

/// Rotor of Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines, 2010, example 5.9.6: two
/// disks, two short bearings with 525 N each.
inline std::string oil_whirl_rotor(const std::string& steps = {}) {
  const std::string film = R"(type = "short_journal"
diameter = "100 mm"
length = "30 mm"
clearance = "100 um"
viscosity = "100 mPa.s"
)";
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "given"
E = "211 GPa"
G = "81.2 GPa"
density = "7810 kg/m^3"
[shaft]
name = "rotor"
material = "given"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 500, 50, 2], ["b", 500, 50, 2], ["c", 500, 50, 2]]
[[disk]]
name = "disk1"
at = "a:end"
od = "280 mm"
id = "50 mm"
width = "70 mm"
material = "given"
[[disk]]
name = "disk2"
at = "b:end"
od = "350 mm"
id = "50 mm"
width = "70 mm"
material = "given"
[[bearing]]
name = "thrust"
at = "a:start"
type = "rigid"
directions = ["x"]
[[load]]
at = "a:start"
force = ["0 N", "0 N", "-525 N"]
[[load]]
at = "c:end"
force = ["0 N", "0 N", "-525 N"]
[[probe]]
name = "journal"
at = "a:start"
[[bearing]]
name = "DE"
at = "a:start"
)" + film +
         "[[bearing]]\nname = \"NDE\"\nat = \"c:end\"\n" + film + steps;
}

}  // namespace whirl::test
