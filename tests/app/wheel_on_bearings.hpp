// A shaft with a wheel, on bearings that are not alike each way: for decks of every kind of step.
#pragma once
#include <string>

namespace whirl::test {

/// rest: what acts on it, probes, steps.
inline std::string wheel_on_bearings(const std::string& rest) {
  return R"(format = 1
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 300, 40], ["right", 500, 40]]
[[disk]]
name = "wheel"
at = "left:end"
mass = "20 kg"
Ip = "0.4 kg.m^2"
Id = "0.2 kg.m^2"
[[bearing]]
name = "A"
at = "left:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "2e7 N/m"
kzz = "3e7 N/m"
cyy = "2e3 N.s/m"
czz = "2e3 N.s/m"
[[bearing]]
name = "B"
at = "right:end"
type = "linear"
kyy = "2e7 N/m"
kzz = "3e7 N/m"
cyy = "2e3 N.s/m"
czz = "2e3 N.s/m"
)" + rest;
}

}  // namespace whirl::test
