// Direct solvers for S = cm M + cc C + ck K on the block pattern. One interface; block LU for the
// usual chain and tree patterns, KLU (SuiteSparse) as the general one.
#pragma once
#include <la/block.hpp>
#include <memory>
#include <span>
#include <string_view>

namespace whirl::la {

enum class Status { ok, singular };

/// Scalar is double or Complex. Unknowns with active == 0 are replaced by identity rows and
/// columns: their solution components are whatever stands in the right-hand side (callers set them
/// to zero).
template <class Scalar>
class DirectSolver {
 public:
  virtual ~DirectSolver() = default;
  /// Numeric factorisation of cm M + cc C + ck K. No allocation after the first call.
  /// @pre matrices with a coefficient other than zero stand on the pattern of the solver.
  /// @throws std::bad_alloc
  virtual Status factor(const MCK& m, Scalar cm, Scalar cc, Scalar ck) = 0;
  /// b := S^-1 b, length 6 * pattern.size().
  /// @pre factor() went well the last time it was called.
  virtual void solve(Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> b) = 0;
  /// The same of every column, bit for bit, for less than one after the other.
  virtual void solve_columns(Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> b) {
    for (Index j = 0; j < b.cols(); ++j)
      solve(b.col(j));
  }
  /// After `singular`: the unknown (6 * node + component) whose pivot vanished, or -1.
  virtual Index singular_unknown() const { return -1; }
  virtual std::string_view name() const = 0;
  /// How much elimination made entries grow in the last factorisation: the relative backward error
  /// is about this times 2e-16. 1 means none.
  virtual double growth() const = 0;
};

/// automatic: block, and KLU (made when first needed) for a matrix that pivoting inside node blocks
/// cannot handle.
enum class SolverKind { automatic, block, klu };

/// active: 6 * pattern.size() flags (1 = unknown, 0 = held). The pattern must outlive the solver.
/// @throws std::invalid_argument when there are not that many flags.
template <class Scalar>
std::unique_ptr<DirectSolver<Scalar>> make_direct_solver(const BlockPattern& pattern,
                                                         std::span<const unsigned char> active,
                                                         SolverKind kind = SolverKind::automatic);

}  // namespace whirl::la
