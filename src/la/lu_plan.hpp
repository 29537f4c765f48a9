// Symbolic block LU: elimination order, fill and update lists for the kernels of lu_kernel.hpp.
#pragma once
#include <core/contract.hpp>
#include <la/block.hpp>
#include <la/lu_kernel.hpp>
#include <span>
#include <vector>

namespace whirl::la::lu {

/// How the nodes are ordered.
enum class Ordering {
  natural,    ///< as numbered
  two_ended,  ///< tridiagonal patterns: 0, n-1, 1, n-2, ...: no fill, and two independent chains
              ///< that overlap in the processor
  amd,        ///< approximate minimum degree on the node graph
  best        ///< two_ended on tridiagonal patterns; on others amd, or minimum fill where
              ///< that takes far fewer products of blocks
};

/// Elimination order of the nodes: order[k] is eliminated at step k.
std::vector<int> make_order(const BlockPattern& pattern, Ordering ordering);

class Symbolic {
 public:
  /// @throws std::invalid_argument when there are not 6 flags a node.
  Symbolic(const BlockPattern& pattern, std::span<const unsigned char> active, Ordering ordering);
  Symbolic(const Symbolic&) = delete;
  Symbolic& operator=(const Symbolic&) = delete;

  const Plan& plan() const { return plan_; }
  /// Number of factor entries (L, U pairs).
  Index entries() const { return static_cast<Index>(row_.size()); }
  /// Step at which a node is eliminated.
  int step(Index node) const {
    WHIRL_EXPECTS(node >= 0 && static_cast<std::size_t>(node) < step_.size());
    return step_[static_cast<std::size_t>(node)];
  }

 private:
  void number_entries(const BlockPattern& pattern, const std::vector<std::vector<int>>& column);
  /// Rows of the factor, by counting.
  void number_rows();
  /// Updates of entry (i,k): every earlier step j with both k and i in its column.
  void list_updates();
  void mark_held(std::span<const unsigned char> active);

  std::vector<int> node_, step_, diag_slot_, entry_start_, row_, lower_slot_, upper_slot_;
  std::vector<int> row_start_, row_entry_, row_step_, update_start_, update_;
  std::vector<unsigned char> partial_;
  std::vector<long long> mask_;
  Plan plan_;
};

}  // namespace whirl::la::lu
