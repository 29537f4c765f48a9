#include <la/block.hpp>
#include <core/contract.hpp>
#include <stdexcept>

namespace whirl::la {

BlockPattern::BlockPattern(Index n, const std::vector<std::pair<Index, Index>>& couplings) : n_(n) {
  WHIRL_EXPECTS(n >= 0);
  std::vector<std::pair<Index, Index>> entries;
  entries.reserve(static_cast<std::size_t>(n) + 2 * couplings.size());
  for (Index i = 0; i < n; ++i)
    entries.emplace_back(i, i);
  for (const auto& [i, j] : couplings) {
    if (i < 0 || j < 0 || i >= n || j >= n)
      throw std::out_of_range("BlockPattern: coupling to a node outside 0..n-1");
    if (i == j) continue;
    entries.emplace_back(i, j);
    entries.emplace_back(j, i);
    if (std::abs(i - j) != 1) tridiagonal_ = false;
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  start_.assign(static_cast<std::size_t>(n) + 1, 0);
  diagonal_.resize(static_cast<std::size_t>(n));
  cols_.reserve(entries.size());
  for (const auto& [i, j] : entries) {
    if (i == j) diagonal_[static_cast<std::size_t>(i)] = static_cast<Index>(cols_.size());
    cols_.push_back(j);
    start_[static_cast<std::size_t>(i) + 1] = static_cast<Index>(cols_.size());
  }
}

Index BlockPattern::slot(Index i, Index j) const {
  if (i < 0 || j < 0 || i >= n_ || j >= n_) return -1;
  const auto first = cols_.begin() + start_[static_cast<std::size_t>(i)];
  const auto last = cols_.begin() + start_[static_cast<std::size_t>(i) + 1];
  const auto it = std::lower_bound(first, last, j);
  return it != last && *it == j ? it - cols_.begin() : -1;
}

}  // namespace whirl::la
