#include <la/lu_plan.hpp>
#include <amd.h>
#include <numeric>
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

}  // namespace

std::vector<int> make_order(const BlockPattern& pattern, Ordering ordering) {
  const int n = static_cast<int>(pattern.size());
  if (ordering == Ordering::best)
    ordering = pattern.is_tridiagonal() ? Ordering::two_ended : Ordering::amd;
  if (ordering == Ordering::amd && n > 0) return make_amd_order(pattern);
  std::vector<int> order(at(n));
  if (ordering == Ordering::two_ended)
    for (int k = 0; k < n; ++k)
      order[at(k)] = k % 2 == 0 ? k / 2 : n - 1 - k / 2;
  else
    std::iota(order.begin(), order.end(), 0);
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
  number_entries(pattern, find_columns(pattern));
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

std::vector<std::vector<int>> Symbolic::find_columns(const BlockPattern& pattern) const {
  const int n = static_cast<int>(node_.size());
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
    const Index node = node_[at(k)];
    for (Index s = pattern.row_start()[at(node)]; s < pattern.row_start()[at(node) + 1]; ++s)
      add(step_[at(pattern.cols()[at(s)])]);
    for (const int child : children[at(k)])
      for (const int i : column[at(child)])
        add(i);
    std::sort(col.begin(), col.end());
    if (!col.empty()) children[at(col.front())].push_back(k);
  }
  return column;
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
