// A rigid rotor of 50 kg between two bearings of 2 MN/m, with a seal in the middle whose table drives whirl at a
// row of its own.
#pragma once
#include <fmt/format.h>
#include <string>

namespace whirl::test {

/// damping: of each bearing, N s/m. rows: of the table, "[speed, kyy, kzz, kyz, kzy, cyy, czz], ...".
inline std::string sealed_rotor(int damping, const std::string& rows, const std::string& parts) {
  std::string deck = R"(format = 1
[output]
report = false
[[shaft]]
name = "r"
[[shaft.section]]
name = "b"
length = "1 m"
rigid = true
[[disk]]
name = "d"
at = "b:mid"
mass = "50 kg"
Ip = "2 kg.m^2"
Id = "4 kg.m^2"
)";
  for (const char* of :
       {"name = \"A\"\nat = \"b:start\"\nkxx = \"1e8 N/m\"\n", "name = \"B\"\nat = \"b:end\"\n"})
    deck += fmt::format(
        "[[bearing]]\n{}type = \"linear\"\nkyy = \"2e6 N/m\"\nkzz = \"2e6 N/m\"\ncyy = \"{} "
        "N.s/m\"\nczz = \"{} N.s/m\"\n",
        of, damping, damping);
  return deck + R"([[bearing]]
name = "seal"
at = "b:mid"
type = "table"
interpolation = "linear"
columns = ["speed[rpm]", "kyy[N/m]", "kzz[N/m]", "kyz[N/m]", "kzy[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [)" +
         rows +
         R"(]
[[probe]]
name = "p"
at = "b:start"
)" + parts;
}

}  // namespace whirl::test
