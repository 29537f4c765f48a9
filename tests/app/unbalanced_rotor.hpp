// A disk between two soft bearings: the rotor of tests that look at files, not at numbers.
#pragma once

namespace whirl::test {

inline constexpr const char* unbalanced_rotor = R"(format = 1
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["left", 300, 20, 3], ["right", 300, 20, 3]]
[[disk]]
name = "disk"
at = "left:end"
mass = "3 kg"
Ip = "0.015 kg.m^2"
Id = "0.0076 kg.m^2"
[[unbalance]]
at = "disk"
amount = "60 g.mm"
[[bearing]]
name = "A"
at = "left:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "2e6 N/m"
kzz = "1e6 N/m"
cyy = "200 N.s/m"
czz = "200 N.s/m"
[[bearing]]
name = "B"
at = "right:end"
type = "linear"
kyy = "2e6 N/m"
kzz = "1e6 N/m"
cyy = "200 N.s/m"
czz = "200 N.s/m"
)";

}  // namespace whirl::test
