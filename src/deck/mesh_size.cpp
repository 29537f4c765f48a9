#include <deck/mesh_size.hpp>
#include <model/resolution.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::deck {

NodeCount count_of_nodes(const model::Model& m) {
  NodeCount n;
  const model::Resolution resolution = model::resolution_of(m);
  for (const auto& s : m.shafts)
    for (const auto& x : s.sections) {
      const double longest = model::longest_element(m, s, x, resolution);
      const double parts =
          std::isfinite(longest) ? std::min(1e6, std::ceil(x.length / longest)) : 1.0;
      const double least = std::max(x.min_elements, m.min_elements);
      const double elements = x.rigid ? 1.0 : std::max(least, parts);
      n.line += elements;
      n.surface += elements * (x.id_l > 0 || x.id_r > 0 ? 2 : 1);
      if (elements > n.in_section) {
        n.in_section = elements;
        n.shaft = &s;
        n.section = &x;
      }
    }
  const auto more = static_cast<double>(m.shafts.size() + m.disks.size() + m.bearings.size());
  n.line += more;
  n.surface += more;
  return n;
}

}  // namespace whirl::deck
