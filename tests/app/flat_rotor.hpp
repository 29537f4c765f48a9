// A rotor that bends more easily across one diameter than across the other, with a disk aside of its middle.
#pragma once
#include <fmt/format.h>
#include <string>

namespace whirl::test {

/// flat: sections, of four of 300 mm, with unequal second moments; the disk of 60 kg after `disk` of them.
/// damping: of each bearing, N s/m. Disk and bearing stand in body axes y; gravity is as the parts say.
inline std::string flat_rotor(int flat, int disk, double damping, const std::string& parts) {
  std::string deck = R"(format = 1
[output]
report = false
[[material]]
name = "steel of 200 GPa"
E = "200 GPa"
nu = 0.3
density = "7800 kg/m^3"
[[shaft]]
name = "a"
material = "steel of 200 GPa"
)";
  for (int k = 1; k <= 4; ++k)
    deck += fmt::format(
        "[[shaft.section]]\nname = \"s{}\"\nlength = \"0.3 m\"\n[shaft.section.general]\nA = "
        "\"3000 mm^2\"\n"
        "Iy = \"{} mm^4\"\nIz = \"{} mm^4\"\nJ = \"1500000 mm^4\"\nkappa_y = 0.85\nkappa_z = "
        "0.85\n",
        k, k <= flat ? 700000 : 850000, k <= flat ? 1000000 : 850000);
  deck += fmt::format(
      "[[disk]]\nname = \"d\"\nat = \"s{}:end\"\nmass = \"60 kg\"\nIp = \"0.5 kg.m^2\"\nId = \"0.4 "
      "kg.m^2\"\n",
      disk);
  for (const char* of :
       {"name = \"A\"\nat = \"s1:start\"\nkxx = \"1e8 N/m\"\n", "name = \"B\"\nat = \"s4:end\"\n"})
    deck += fmt::format(
        "[[bearing]]\n{}type = \"linear\"\nkyy = \"2e7 N/m\"\nkzz = \"2e7 N/m\"\ncyy = \"{} "
        "N.s/m\"\nczz = \"{} N.s/m\"\n",
        of, damping, damping);
  return deck + "[[probe]]\nname = \"p\"\nat = \"s1:end\"\n" + parts;
}

}  // namespace whirl::test
