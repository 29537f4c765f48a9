#include <assembly/tied_lines.hpp>

#include <algorithm>
#include <numeric>

namespace whirl::assembly {

bool ties_spins(const model::Joint& j) {
  return j.to && (j.kind == model::JointKind::rigid || j.kind == model::JointKind::slider ||
                  j.kind == model::JointKind::universal);
}

std::vector<std::size_t> tied_lines(const model::Model& m) {
  std::vector<std::size_t> first(m.shafts.size());
  std::iota(first.begin(), first.end(), std::size_t{0});
  const auto tie = [&](std::size_t a, std::size_t b) {
    if (!m.shafts[a].rotating || !m.shafts[b].rotating) return;
    const auto [to, from] = std::minmax({first[a], first[b]});
    std::replace(first.begin(), first.end(), from, to);
  };
  for (const model::Bearing& b : m.bearings) {
    const std::optional<model::ShaftPair> pair = *model::traits_of(b.law).pair;
    if (pair && b.to) tie(b.at.shaft, b.to->shaft);
  }
  for (const model::Joint& j : m.joints)
    if (ties_spins(j)) tie(j.at.shaft, j.to->shaft);
  return first;
}

}  // namespace whirl::assembly
