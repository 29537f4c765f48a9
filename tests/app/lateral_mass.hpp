// The deck of a mass on the bearings under test: half a symmetric rigid rotor.
#pragma once
#include <fmt/format.h>

#include <string>

namespace whirl::test {

/// kg on a rigid massless shaft, place "mass", free to spin and to move where `held` does not say;
/// `rest`: bearings, loads, steps.
inline std::string lateral_mass(double kg, const std::string& gravity, const std::string& rest,
                                const std::string& held = R"("x", "ry", "rz")") {
  return "format = 1\n[model]\ngravity = \"" + gravity + R"("
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 100, true], ["right", 100, true]]
[[disk]]
name = "mass"
at = "left:end"
mass = ")" +
         fmt::format("{:.17g}", kg) + R"( kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
name = "guide"
at = "mass"
type = "rigid"
directions = [)" +
         held + "]\n" + rest;
}

}  // namespace whirl::test
