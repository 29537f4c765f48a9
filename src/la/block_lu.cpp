#include <la/block_lu.hpp>
#include <core/contract.hpp>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <type_traits>

namespace whirl::la {

namespace {

template <class Scalar>
constexpr std::size_t planes = std::is_same_v<Scalar, Complex> ? 2 : 1;

/// a b without the checks for infinite factors that the operator makes.
Complex multiply(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// A 6 x 6 matrix in real and imaginary parts, for determinants of the pivot blocks.
struct SmallMatrix {
  double re[6][6];
  double im[6][6];

  /// Columns of eight doubles; the imaginary plane follows.
  void load(const double* data, bool complex) {
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        re[i][j] = data[8 * j + i];
        im[i][j] = complex ? data[8 * j + i + lu::plane] : 0.0;
      }
  }

  /// Elimination with row pivots.
  Complex determinant() {
    Complex out = 1.0;
    for (int k = 0; k < 6; ++k) {
      int pivot = k;
      for (int i = k + 1; i < 6; ++i)
        if (size(i, k) > size(pivot, k)) pivot = i;
      if (pivot != k) {
        std::swap(re[pivot], re[k]);
        std::swap(im[pivot], im[k]);
        out = -out;
      }
      out = multiply(out, {re[k][k], im[k][k]});
      eliminate(k);
    }
    return out;
  }

 private:
  double size(int i, int j) const { return std::abs(re[i][j]) + std::abs(im[i][j]); }

  void eliminate(int k) {
    const double norm = re[k][k] * re[k][k] + im[k][k] * im[k][k];
    const double inverse_re = re[k][k] / norm;
    const double inverse_im = -im[k][k] / norm;
    for (int i = k + 1; i < 6; ++i) {
      const double f_re = re[i][k] * inverse_re - im[i][k] * inverse_im;
      const double f_im = re[i][k] * inverse_im + im[i][k] * inverse_re;
      for (int j = k + 1; j < 6; ++j) {
        re[i][j] -= f_re * re[k][j] - f_im * im[k][j];
        im[i][j] -= f_re * im[k][j] + f_im * re[k][j];
      }
    }
  }
};

void add_term(lu::Terms& t, const BlockMatrix<6>& m, Complex c) {
  if (c == Complex(0.0)) return;
  t.value[t.count] = m.data();
  t.re[t.count] = c.real();
  t.im[t.count] = c.imag();
  ++t.count;
}

}  // namespace

template <class Scalar>
BlockLu<Scalar>::BlockLu(const BlockPattern& pattern, std::span<const unsigned char> active,
                         lu::Ordering ordering, const lu::Kernels* kernels)
    : symbolic_(pattern, active, ordering),
      kernels_(kernels ? *kernels : lu::kernels()),
      inverse_(static_cast<std::size_t>(pattern.size() * lu::plane) * planes<Scalar>),
      lower_(static_cast<std::size_t>(symbolic_.entries() * lu::plane) * planes<Scalar>),
      upper_(static_cast<std::size_t>(symbolic_.entries() * lu::plane) * planes<Scalar>),
      vec_(static_cast<std::size_t>(pattern.size() * lu::lane * lu::columns) * planes<Scalar>) {
  // A singular chain leaves a last pivot of the size of the rounding errors it has gathered; they
  // add up at random.
  const double tolerance = std::numeric_limits<double>::epsilon() *
                           (16.0 + std::sqrt(static_cast<double>(pattern.size())));
  factors_ = {inverse_.data(), lower_.data(), upper_.data(), vec_.data(), tolerance};
}

template <class Scalar>
Status BlockLu<Scalar>::factor(const MCK& m, Scalar cm, Scalar cc, Scalar ck) {
  WHIRL_EXPECTS(m.K.pattern().size() == symbolic_.plan().n);
  WHIRL_EXPECTS(cm == Scalar(0.0) || m.M.value_count() == m.K.value_count());
  WHIRL_EXPECTS(cc == Scalar(0.0) || m.C.value_count() == m.K.value_count());
  lu::Terms t;
  add_term(t, m.M, cm);
  add_term(t, m.C, cc);
  add_term(t, m.K, ck);
  if (t.count == 0) t.value[t.count++] = m.K.data();  // S = 0: only held unknowns are regular
  if constexpr (std::is_same_v<Scalar, double>)
    outcome_ = kernels_.factor_real(symbolic_.plan(), t, factors_);
  else
    outcome_ = kernels_.factor_complex(symbolic_.plan(), t, factors_);
  singular_ =
      outcome_.step < 0 ? -1 : 6 * Index(symbolic_.plan().node[outcome_.step]) + outcome_.component;
  return singular_ < 0 ? Status::ok : Status::singular;
}

template <class Scalar>
void BlockLu<Scalar>::solve(Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> b) {
  WHIRL_EXPECTS(singular_ < 0);
  WHIRL_EXPECTS(b.size() == 6 * symbolic_.plan().n);
  if constexpr (std::is_same_v<Scalar, double>)
    kernels_.solve_real(symbolic_.plan(), factors_, b.data());
  else
    kernels_.solve_complex(symbolic_.plan(), factors_, reinterpret_cast<double*>(b.data()));
}

template <class Scalar>
void BlockLu<Scalar>::solve_columns(
    Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> b) {
  WHIRL_EXPECTS(singular_ < 0);
  WHIRL_EXPECTS(b.rows() == 6 * symbolic_.plan().n);
  Index first = 0;
  if constexpr (std::is_same_v<Scalar, Complex>)
    for (; first + lu::columns <= b.cols(); first += lu::columns) {
      double* to[lu::columns];
      for (int r = 0; r < lu::columns; ++r)
        to[r] = reinterpret_cast<double*>(b.col(first + r).data());
      kernels_.solve_complex_columns(symbolic_.plan(), factors_, to);
    }
  for (; first < b.cols(); ++first)
    solve(b.col(first));
}

template <class Scalar>
Eigen::Matrix<Scalar, 6, 6> BlockLu<Scalar>::inverse_pivot_block(Index step) const {
  WHIRL_EXPECTS(singular_ < 0);
  WHIRL_EXPECTS(step >= 0 && step < symbolic_.plan().n);
  const double* const p =
      inverse_.data() + static_cast<std::size_t>(step * lu::plane) * planes<Scalar>;
  Eigen::Matrix<Scalar, 6, 6> d;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      if constexpr (std::is_same_v<Scalar, double>)
        d(i, j) = p[8 * j + i];
      else
        d(i, j) = Complex(p[8 * j + i], p[8 * j + i + lu::plane]);
    }
  return d;
}

template <class Scalar>
std::pair<double, Complex> BlockLu<Scalar>::determinant() const {
  WHIRL_EXPECTS(singular_ < 0);
  double log10_size = 0.0;
  Complex phase = 1.0;
  for (Index k = 0; k < symbolic_.plan().n; ++k) {
    SmallMatrix inverse;
    const std::size_t offset = static_cast<std::size_t>(k * lu::plane) * planes<Scalar>;
    inverse.load(inverse_.data() + offset, std::is_same_v<Scalar, Complex>);
    const Complex d = inverse.determinant();
    const double size = std::sqrt(d.real() * d.real() + d.imag() * d.imag());
    log10_size -= std::log10(size);
    phase = multiply(phase, Complex(d.real() / size, -d.imag() / size));
  }
  return {log10_size, phase / std::abs(phase)};
}

template <class Scalar>
Index BlockLu<Scalar>::negative_eigenvalues() const {
  WHIRL_EXPECTS(singular_ < 0);
  Index count = 0;
  for (Index k = 0; k < symbolic_.plan().n; ++k) {
    // The inverse has the signs of D. Scaling by the diagonal keeps them and evens out the units.
    Eigen::Matrix<Scalar, 6, 6> d = inverse_pivot_block(k);
    d = (0.5 * (d + d.adjoint())).eval();
    Vector<6> s;
    for (int i = 0; i < 6; ++i)
      s(i) = 1.0 / std::sqrt(std::max(d.row(i).cwiseAbs().maxCoeff(), 1e-300));
    d = (s.asDiagonal() * d * s.asDiagonal()).eval();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Scalar, 6, 6>> eig(d, Eigen::EigenvaluesOnly);
    count += (eig.eigenvalues().array() < 0.0).count();
  }
  return count;
}

template class BlockLu<double>;
template class BlockLu<Complex>;

}  // namespace whirl::la
