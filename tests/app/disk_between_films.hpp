// A disk amid a shaft between two film bearings at 3000 rpm: the rotor of tests that follow oil.
#pragma once
#include <fmt/format.h>

#include <string>

namespace whirl::test {

/// bearings: their tables. every: between rows. parts: more tables of the model.
inline std::string disk_between(const std::string& bearings, const std::string& steps,
                                const std::string& every = "1 ms", const std::string& parts = "") {
  return R"(format = 1
[model]
gravity = "9.81 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["left", 300, 80, 1], ["right", 300, 80, 1]]
[[disk]]
name = "disk"
at = "left:end"
od = "400 mm"
id = "80 mm"
width = "150 mm"
material = "steel"
[[bearing]]
name = "thrust"
at = "left:mid"
type = "linear"
kxx = "1e7 N/m"
cxx = "1e4 N.s/m"
[[probe]]
name = "DE"
at = "left:start"
[[drive]]
at = "left:start"
type = "speed"
speed = "3000 rpm"
)" + fmt::format("[output]\nreport = false\nevery = \"{}\"\n", every) +
         "quantities = [\"speed\", \"probes\", \"energy\"]\n" + parts + bearings + steps;
}

inline const std::string settled_at_speed =
    "[[step]]\nname = \"st\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n";
inline std::string moves(const char* start, const char* duration) {
  return fmt::format("[[step]]\nname = \"t\"\ntype = \"transient\"\n{}\nduration = \"{}\"\n", start,
                     duration);
}

}  // namespace whirl::test
