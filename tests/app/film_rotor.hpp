// The deck of a rigid rotor on two journal bearings alike.
#pragma once
#include <fmt/format.h>

#include <string>

namespace whirl::test {

/// 200 kg that do not weigh, pressed along -z with `load` (N) on each of the bearings "DE" and "NDE", whose
/// keys but name and place are `bearing`; `rest`: whatever else, steps among it. No report.
inline std::string film_rotor(const std::string& bearing, double load, const std::string& rest) {
  std::string text = fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "rotor"
[[shaft.section]]
name = "body"
length = "1 m"
rigid = true
[[disk]]
name = "mass"
at = "body:mid"
mass = "200 kg"
Ip = "1 kg.m^2"
Id = "10 kg.m^2"
[[load]]
at = "body:mid"
force = ["0 N", "0 N", "{:.17g} N"]
[[bearing]]
name = "thrust"
at = "body:start"
type = "linear"
kxx = "1e8 N/m"
)",
                                 -2 * load);
  for (const auto& [name, at] : {std::pair{"DE", "start"}, std::pair{"NDE", "end"}})
    text += fmt::format("[[bearing]]\nname = \"{}\"\nat = \"body:{}\"\n{}", name, at, bearing);
  return text + rest + "[output]\nreport = false\n";
}

}  // namespace whirl::test
