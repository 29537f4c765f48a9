#include <la/lu_plan.hpp>
#include <algorithm>
#include <amd.h>
#include <iterator>
#include <numeric>
#include <set>
#include <stdexcept>

namespace whirl::la::lu {

namespace {

std::vector<int> make_amd_order(const BlockPattern& pattern) {
  const int n = static_cast<int>(pattern.size());
  std::vector<int> start(at(n) + 1), cols, order(at(n));
  cols.reserve(at(pattern.blocks()));
  for (Index i = 0; i < n; ++i) {
    for (Index k = pattern.row_start()[at(i)]; k < pattern.row_start()[at(i) + 1]; ++k)
      if (pattern.cols()[at(k)] != i) cols.push_back(static_cast<int>(pattern.cols()[at(k)]));
    start[at(i) + 1] = static_cast<int>(cols.size());
  }
  if (cols.empty()) cols.push_back(0);  // AMD wants a valid pointer
  const int status = amd_order(n, start.data(), cols.data(), order.data(), nullptr, nullptr);
  if (status != AMD_OK && status != AMD_OK_BUT_JUMBLED)
    throw std::runtime_error("AMD ordering failed");
  return order;
}

/// The node next whose elimination couples the fewest neighbours anew; among equals the first and
/// the last by turns, so that chains are eliminated from both their ends.
class MinimumFill {
 public:
  explicit MinimumFill(const BlockPattern& pattern)
      : neighbours_(at(pattern.size())),
        fill_(at(pattern.size()), 0) {
    for (Index i = 0; i < pattern.size(); ++i)
      for (Index k = pattern.row_start()[at(i)]; k < pattern.row_start()[at(i) + 1]; ++k)
        if (pattern.cols()[at(k)] != i)
          neighbours_[at(i)].push_back(static_cast<int>(pattern.cols()[at(k)]));
    for (int i = 0; i < static_cast<int>(neighbours_.size()); ++i) {
      fill_[at(i)] = count_fill(i);
      queue_.emplace(fill_[at(i)], i);
    }
  }

  std::vector<int> order() {
    std::vector<int> out;
    while (!queue_.empty()) {
      auto next = queue_.begin();
      if (out.size() % 2 == 1) next = std::prev(queue_.lower_bound({next->first + 1, -1}));
      out.push_back(next->second);
      queue_.erase(next);
      eliminate(out.back());
    }
    return out;
  }

  /// Neighbours of the node that has most.
  static std::size_t most_neighbours(const BlockPattern& pattern) {
    Index most = 0;
    for (Index i = 0; i < pattern.size(); ++i)
      most = std::max(most, pattern.row_start()[at(i) + 1] - pattern.row_start()[at(i)]);
    return at(most);
  }

 private:
  bool coupled(int i, int j) const {
    return std::binary_search(neighbours_[at(i)].begin(), neighbours_[at(i)].end(), j);
  }
  int count_fill(int i) const {
    const std::vector<int>& near = neighbours_[at(i)];
    int out = 0;
    for (std::size_t a = 0; a < near.size(); ++a)
      for (std::size_t b = a + 1; b < near.size(); ++b)
        out += !coupled(near[a], near[b]);
    return out;
  }
  void couple(int i, int j) {
    std::vector<int>& near = neighbours_[at(i)];
    near.insert(std::lower_bound(near.begin(), near.end(), j), j);
  }
  void eliminate(int node) {
    const std::vector<int> near = std::move(neighbours_[at(node)]);
    for (const int i : near) {
      std::vector<int>& others = neighbours_[at(i)];
      others.erase(std::lower_bound(others.begin(), others.end(), node));
    }
    std::vector<int> changed = near;
    for (std::size_t a = 0; a < near.size(); ++a)
      for (std::size_t b = a + 1; b < near.size(); ++b) {
        if (coupled(near[a], near[b])) continue;
        couple(near[a], near[b]);
        couple(near[b], near[a]);
        // what has both for neighbours couples them no more
        std::set_intersection(neighbours_[at(near[a])].begin(), neighbours_[at(near[a])].end(),
                              neighbours_[at(near[b])].begin(), neighbours_[at(near[b])].end(),
                              std::back_inserter(changed));
      }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const int i : changed) {
      queue_.erase({fill_[at(i)], i});
      fill_[at(i)] = count_fill(i);
      queue_.emplace(fill_[at(i)], i);
    }
  }

  std::vector<std::vector<int>> neighbours_;  ///< sorted
  std::vector<int> fill_;
  std::set<std::pair<int, int>> queue_;  ///< fill, node
};

/// Columns of the factor: neighbours eliminated later, merged with the columns of the children in
/// the elimination tree.
std::vector<std::vector<int>> find_columns(const BlockPattern& pattern,
                                           const std::vector<int>& order) {
  const int n = static_cast<int>(order.size());
  std::vector<int> step(at(n));
  for (int k = 0; k < n; ++k)
    step[at(order[at(k)])] = k;
  std::vector<std::vector<int>> column(at(n));
  std::vector<std::vector<int>> children(at(n));
  std::vector<int> seen(at(n), -1);
  for (int k = 0; k < n; ++k) {
    auto& col = column[at(k)];
    seen[at(k)] = k;
    const auto add = [&](int i) {
      if (i > k && seen[at(i)] != k) {
        seen[at(i)] = k;
        col.push_back(i);
      }
    };
    const Index node = order[at(k)];
    for (Index s = pattern.row_start()[at(node)]; s < pattern.row_start()[at(node) + 1]; ++s)
      add(step[at(pattern.cols()[at(s)])]);
    for (const int child : children[at(k)])
      for (const int i : column[at(child)])
        add(i);
    std::sort(col.begin(), col.end());
    if (!col.empty()) children[at(col.front())].push_back(k);
  }
  return column;
}

/// Products of blocks in a factorisation.
std::size_t products(const std::vector<std::vector<int>>& column) {
  std::size_t out = 0;
  for (const std::vector<int>& c : column)
    out += c.size() * (c.size() + 1);
  return out;
}

/// Minimum degree takes a chain between two clusters (the magnets of a rotor with the signals of their
/// controllers) before the clusters, with two neighbours along it; by fill the clusters go first and
/// the chain has one.
std::vector<int> make_best_order(const BlockPattern& pattern) {
  constexpr std::size_t many = 64;  // neighbours of a node: pairs of them are looked at
  std::vector<int> by_degree = make_amd_order(pattern);
  if (MinimumFill::most_neighbours(pattern) > many) return by_degree;
  std::vector<int> by_fill = MinimumFill(pattern).order();
  const auto cost_of = [&](const std::vector<int>& order) {
    return static_cast<double>(products(find_columns(pattern, order)));
  };
  constexpr double worth_it = 0.8;
  return cost_of(by_fill) < worth_it * cost_of(by_degree) ? by_fill : by_degree;
}

}  // namespace

std::vector<int> make_order(const BlockPattern& pattern, Ordering ordering) {
  const int n = static_cast<int>(pattern.size());
  if (ordering == Ordering::best && !pattern.is_tridiagonal()) return make_best_order(pattern);
  if (ordering == Ordering::amd && n > 0) return make_amd_order(pattern);
  std::vector<int> order(at(n));
  if (ordering == Ordering::natural)
    std::iota(order.begin(), order.end(), 0);
  else
    for (int k = 0; k < n; ++k)
      order[at(k)] = k % 2 == 0 ? k / 2 : n - 1 - k / 2;
  return order;
}

Symbolic::Symbolic(const BlockPattern& pattern, std::span<const unsigned char> active,
                   Ordering ordering) {
  const int n = static_cast<int>(pattern.size());
  if (active.size() != at(6 * n))
    throw std::invalid_argument("direct solver: the active mask must have 6 flags a node");
  node_ = make_order(pattern, ordering);
  step_.resize(at(n));
  for (int k = 0; k < n; ++k)
    step_[at(node_[at(k)])] = k;
  number_entries(pattern, find_columns(pattern, node_));
  number_rows();
  list_updates();
  mark_held(active);
  plan_ = Plan{n,
               node_.data(),
               diag_slot_.data(),
               entry_start_.data(),
               row_.data(),
               lower_slot_.data(),
               upper_slot_.data(),
               row_start_.data(),
               row_entry_.data(),
               row_step_.data(),
               update_start_.data(),
               update_.data(),
               partial_.data(),
               mask_.data()};
}

void Symbolic::number_entries(const BlockPattern& pattern,
                              const std::vector<std::vector<int>>& column) {
  const int n = static_cast<int>(node_.size());
  entry_start_.assign(1, 0);
  for (int k = 0; k < n; ++k) {
    const Index node = node_[at(k)];
    diag_slot_.push_back(static_cast<int>(pattern.diagonal(node)));
    for (const int i : column[at(k)]) {
      const Index other = node_[at(i)];
      row_.push_back(i);
      lower_slot_.push_back(static_cast<int>(pattern.slot(other, node)));
      upper_slot_.push_back(static_cast<int>(pattern.slot(node, other)));
    }
    entry_start_.push_back(static_cast<int>(row_.size()));
  }
}

void Symbolic::number_rows() {
  const int n = static_cast<int>(node_.size());
  row_start_.assign(at(n) + 1, 0);
  for (const int i : row_)
    ++row_start_[at(i) + 1];
  for (int k = 0; k < n; ++k)
    row_start_[at(k) + 1] += row_start_[at(k)];
  row_entry_.resize(row_.size());
  row_step_.resize(row_.size());
  std::vector<int> next(row_start_.begin(), row_start_.end() - 1);
  for (int k = 0; k < n; ++k)
    for (int e = entry_start_[at(k)]; e < entry_start_[at(k) + 1]; ++e) {
      const int u = next[at(row_[at(e)])]++;
      row_entry_[at(u)] = e;
      row_step_[at(u)] = k;
    }
}

void Symbolic::list_updates() {
  const int n = static_cast<int>(node_.size());
  const auto find = [&](int j, int i) {
    const auto first = row_.begin() + entry_start_[at(j)],
               last = row_.begin() + entry_start_[at(j) + 1];
    const auto it = std::lower_bound(first, last, i);
    return it != last && *it == i ? static_cast<int>(it - row_.begin()) : -1;
  };
  update_start_.assign(1, 0);
  for (int k = 0; k < n; ++k)
    for (int e = entry_start_[at(k)]; e < entry_start_[at(k) + 1]; ++e) {
      for (int u = row_start_[at(k)]; u < row_start_[at(k) + 1]; ++u) {
        const int a = row_entry_[at(u)], b = find(row_step_[at(u)], row_[at(e)]);
        if (b < 0) continue;
        // L_ki-to-be gets L_b U_a, U gets L_a U_b: a = (j,k), b = (j,i)
        update_.push_back(a);
        update_.push_back(b);
      }
      update_start_.push_back(static_cast<int>(update_.size() / 2));
    }
}

void Symbolic::mark_held(std::span<const unsigned char> active) {
  const int n = static_cast<int>(node_.size());
  partial_.assign(at(n), 0);
  mask_.assign(at(8 * n), 0);
  for (int k = 0; k < n; ++k)
    for (int c = 0; c < 6; ++c) {
      const bool on = active[at(6 * node_[at(k)] + c)] != 0;
      mask_[at(8 * k + c)] = on ? -1LL : 0LL;
      if (!on) partial_[at(k)] = 1;
    }
}

}  // namespace whirl::la::lu
