// Block-sparse matrices on the node graph of the model. One block row per node; the pattern is
// structurally symmetric, always holds the diagonal, and never changes after it is built.
#pragma once
#include <core/contract.hpp>
#include <core/types.hpp>
#include <algorithm>
#include <utility>
#include <vector>

namespace whirl::la {

/// Compressed block-row pattern. cols are sorted within a row.
class BlockPattern {
 public:
  BlockPattern() = default;
  /// n nodes, couplings given as pairs (any order, duplicates allowed; (i,j) implies (j,i);
  /// diagonals are added).
  /// @throws std::out_of_range for a coupling to a node outside 0 .. n-1.
  BlockPattern(Index n, const std::vector<std::pair<Index, Index>>& couplings);

  Index size() const { return n_; }
  Index blocks() const { return static_cast<Index>(cols_.size()); }
  /// Slot of block (i,j), or -1 when it is not in the pattern.
  Index slot(Index i, Index j) const;
  /// Slot of the diagonal block of row i.
  /// @pre 0 <= i < size().
  Index diagonal(Index i) const {
    WHIRL_EXPECTS(i >= 0 && i < n_);
    return diagonal_[static_cast<std::size_t>(i)];
  }
  const std::vector<Index>& row_start() const { return start_; }
  const std::vector<Index>& cols() const { return cols_; }
  /// True when the only couplings are (i, i+1): the block-tridiagonal solver applies.
  bool is_tridiagonal() const { return tridiagonal_; }

 private:
  Index n_ = 0;
  bool tridiagonal_ = true;
  std::vector<Index> start_, cols_, diagonal_;
};

/// Values on a pattern: blocks() column-major B x B blocks, in slot order.
template <int B, class Scalar = double>
class BlockMatrix {
 public:
  using Block = Eigen::Matrix<Scalar, B, B>;
  using Map = Eigen::Map<Block>;
  using ConstMap = Eigen::Map<const Block>;
  BlockMatrix() = default;
  explicit BlockMatrix(const BlockPattern& p)
      : pattern_(&p),
        values_(static_cast<std::size_t>(p.blocks() * B * B)) {}
  /// Not of a matrix made without one.
  const BlockPattern& pattern() const {
    WHIRL_EXPECTS(pattern_ != nullptr);
    return *pattern_;
  }
  void set_zero() { std::fill(values_.begin(), values_.end(), Scalar(0)); }
  /// slot: 0 .. pattern().blocks() - 1.
  Map block(Index slot) {
    WHIRL_EXPECTS(slot >= 0 && at((slot + 1) * B * B) <= values_.size());
    return Map(values_.data() + slot * B * B);
  }
  ConstMap block(Index slot) const {
    WHIRL_EXPECTS(slot >= 0 && at((slot + 1) * B * B) <= values_.size());
    return ConstMap(values_.data() + slot * B * B);
  }
  Scalar* data() { return values_.data(); }
  const Scalar* data() const { return values_.data(); }
  std::size_t value_count() const { return values_.size(); }
  /// y += s A x, x and y of length B * size().
  /// @pre x and y of that length.
  template <class VecIn, class VecOut>
  void add_multiply(Scalar s, const VecIn& x, VecOut&& y) const {
    WHIRL_EXPECTS(x.size() == B * pattern().size() && y.size() == x.size());
    const auto& start = pattern_->row_start();
    const auto& cols = pattern_->cols();
    for (Index i = 0; i < pattern_->size(); ++i)
      for (Index k = start[static_cast<std::size_t>(i)]; k < start[static_cast<std::size_t>(i) + 1];
           ++k)
        y.template segment<B>(B * i) +=
            s * (block(k) * x.template segment<B>(B * cols[static_cast<std::size_t>(k)]));
  }

 private:
  const BlockPattern* pattern_ = nullptr;
  std::vector<Scalar> values_;
};

/// The three matrices of a linearisation, all on one pattern, in the nodal unknowns (u, phi,
/// gamma).
struct MCK {
  MCK() = default;
  explicit MCK(const BlockPattern& p) : M(p), C(p), K(p) {}
  BlockMatrix<6> M, C, K;
};

}  // namespace whirl::la
