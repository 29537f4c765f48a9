// Block-sparse LU with 6x6 blocks on any symmetric node graph (chains, trees, gears, pedestals,
// casings).
#pragma once
#include <la/direct.hpp>
#include <la/lu_plan.hpp>

namespace whirl::la {

/// Memory aligned for vector loads, allocated once.
class AlignedBuffer {
 public:
  explicit AlignedBuffer(std::size_t doubles)
      : data_(static_cast<double*>(::operator new[](
            std::max<std::size_t>(doubles, 1) * sizeof(double), std::align_val_t(64)))) {
    std::fill_n(data_.get(), doubles, 0.0);
  }
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }

 private:
  struct Free {
    void operator()(double* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  std::unique_ptr<double[], Free> data_;
};

/// Pivots are sought inside the diagonal block of a node only. That is stable for what rotor models
/// give (definite, gyroscopic, damped, shifted), and growth() tells when it was not.
template <class Scalar>
class BlockLu final : public DirectSolver<Scalar> {
 public:
  /// kernels: nullptr = the best for this machine.
  BlockLu(const BlockPattern& pattern, std::span<const unsigned char> active,
          lu::Ordering ordering = lu::Ordering::best, const lu::Kernels* kernels = nullptr);
  Status factor(const MCK& m, Scalar cm, Scalar cc, Scalar ck) override;
  void solve(Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> b) override;
  void solve_columns(Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> b) override;
  Index singular_unknown() const override { return singular_; }
  std::string_view name() const override { return "block"; }
  double growth() const override { return outcome_.growth; }

  /// Diagonal blocks that needed complete pivoting in the last factorisation.
  int repivoted_blocks() const { return outcome_.repivoted; }
  /// log10 |det S| and det S / |det S| of the last factorisation (held unknowns count as 1).
  /// @pre it was regular (also of the two that follow).
  std::pair<double, Complex> determinant() const;
  /// Negative eigenvalues of S, which must be Hermitian: by Sylvester's law, those of the blocks
  /// D_k.
  Index negative_eigenvalues() const;
  /// Diagonal block D_k^-1 of the elimination step of a node.
  Eigen::Matrix<Scalar, 6, 6> inverse_pivot_block(Index step) const;

 private:
  lu::Symbolic symbolic_;
  const lu::Kernels& kernels_;
  AlignedBuffer inverse_, lower_, upper_, vec_;
  lu::Factors factors_;
  lu::Outcome outcome_;
  Index singular_ = -1;
};

}  // namespace whirl::la
