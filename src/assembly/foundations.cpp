// Reduced foundations: a node for every support point and every internal coordinate, matrices in parts between pairs of them.
#include <assembly/parts.hpp>
#include <elements/matrix_part.hpp>

#include <fmt/format.h>

#include <map>

namespace whirl::assembly {

void add_foundations(Assembly& a) {
  for (const model::Foundation& f : a.model.foundations) {
    // coordinate -> node and component; nodes in the order they appear
    std::vector<std::pair<Index, int>> place;
    std::map<Index, bool> internal;
    Index line = -1;
    std::map<Index, std::array<bool, 3>> used;
    for (const auto& c : f.coordinates) {
      Index node;
      if (c.bearing >= 0) {
        node = a.mesh.bearings[static_cast<std::size_t>(c.bearing)].pedestal;
      } else {
        if (line < 0) line = a.builder.add_line(fmt::format("foundation '{}'", f.name));
        node = a.builder.add_node({Vec3::Zero(), line, fmt::format("coordinate '{}' of foundation '{}'", c.name, f.name), true});
      }
      place.emplace_back(node, c.bearing >= 0 ? c.direction : 0);
      internal[node] = c.bearing < 0;
      used[node][static_cast<std::size_t>(place.back().second)] = true;
    }
    for (const auto& [node, directions] : used) {
      if (internal[node]) continue;
      for (int c = 0; c < 6; ++c)   // a support point does not turn, and moves along its coordinates only
        if (c >= 3 || !directions[static_cast<std::size_t>(c)]) a.builder.hold(node, c);
    }
    std::map<Index, elements::MatrixPart<1>> single;
    std::map<std::array<Index, 2>, elements::MatrixPart<2>> pairs;
    for (std::size_t i = 0; i < place.size(); ++i)
      for (std::size_t j = 0; j < place.size(); ++j) {
        const auto r = static_cast<Index>(i), s = static_cast<Index>(j);
        const double k = f.K(r, s), c = f.C(r, s), m = f.M(r, s);
        auto [n1, d1] = place[i];
        auto [n2, d2] = place[j];
        if (n1 == n2) {
          auto& p = single[n1];
          p.K(d1, d2) = k, p.C(d1, d2) = c, p.M(d1, d2) = m, p.internal[0] = internal[n1];
        } else if (n1 < n2 && (k != 0 || c != 0 || m != 0)) {
          auto& p = pairs[{n1, n2}];
          p.K(d1, 3 + d2) = p.K(3 + d2, d1) = k, p.C(d1, 3 + d2) = p.C(3 + d2, d1) = c, p.M(d1, 3 + d2) = p.M(3 + d2, d1) = m;
          p.internal = {internal[n1], internal[n2]};
        }
      }
    for (const auto& [node, part] : single) a.builder.add(part, {node}, "foundation matrices");
    for (const auto& [nodes, part] : pairs) a.builder.add(part, nodes, "foundation couplings");
  }
}

}  // namespace whirl::assembly
