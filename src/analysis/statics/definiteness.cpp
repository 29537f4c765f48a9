#include <analysis/statics/definiteness.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <la/block_lu.hpp>
#include <la/eigen.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace whirl::analysis {
namespace {

/// Below this share of what the rows of K hold a direction is indifferent.
constexpr double rounding = 2e-14;
/// Above this asymmetry, relative to what the rows hold, K is unsymmetric.
constexpr double skewness = 1e-9;

/// What stands in the rows of K: largest entry of the diagonal, else of the row.
VecX row_sizes(const la::BlockMatrix<6>& K) {
  const la::BlockPattern& p = K.pattern();
  VecX w(6 * p.size());
  for (Index i = 0; i < p.size(); ++i)
    for (Index c = 0; c < 6; ++c) {
      double size = std::abs(K.block(p.diagonal(i))(c, c));
      if (size == 0.0)
        for (Index b = p.row_start()[at(i)]; b < p.row_start()[at(i) + 1]; ++b)
          size = std::max(size, K.block(b).row(c).cwiseAbs().maxCoeff());
      w[6 * i + c] = size > 0.0 ? size : 1.0;
    }
  return w;
}

/// Symmetric part of K in `out`; the largest asymmetry relative to what the rows hold, free
/// unknowns only.
double symmetrise(const la::BlockMatrix<6>& K, const VecX& rows,
                  std::span<const unsigned char> free, la::BlockMatrix<6>& out) {
  const la::BlockPattern& p = K.pattern();
  double skew = 0;
  for (Index i = 0; i < p.size(); ++i)
    for (Index b = p.row_start()[at(i)]; b < p.row_start()[at(i) + 1]; ++b) {
      const Index j = p.cols()[at(b)];
      const Matrix<6> upper = K.block(b);
      const Matrix<6> lower = K.block(p.slot(j, i)).transpose();
      out.block(b) = 0.5 * (upper + lower);
      for (Index r = 0; r < 6; ++r)
        for (Index c = 0; c < 6; ++c) {
          if (!free[at(6 * i + r)] || !free[at(6 * j + c)]) continue;
          const double size = std::sqrt(rows[6 * i + r] * rows[6 * j + c]);
          skew = std::max(skew, std::abs(upper(r, c) - lower(r, c)) / size);
        }
    }
  return skew;
}

/// K and a positive diagonal in M's place, for factors of K + s diag.
class Shifted {
 public:
  Shifted(const la::BlockMatrix<6>& K, const VecX& diagonal, std::span<const unsigned char> free)
      : m_(K.pattern()),
        lu_(K.pattern(), free) {
    std::copy_n(K.data(), K.value_count(), m_.K.data());
    m_.M.set_zero();
    const la::BlockPattern& p = K.pattern();
    for (Index i = 0; i < p.size(); ++i)
      m_.M.block(p.diagonal(i)).diagonal() = diagonal.segment<6>(6 * i);
  }
  bool factor(double s) { return lu_.factor(m_, s, 0.0, 1.0) == la::Status::ok; }
  /// Negative eigenvalues of K + s diag; a pivot that vanishes moves s a little up. Nothing when
  /// that does not help: such factors say nothing.
  std::optional<Index> negative(double s) {
    for (int tries = 0; tries < 8; ++tries, s += (tries < 4 ? 0.1 : 1.0) * std::abs(s))
      if (factor(s)) return lu_.negative_eigenvalues();
    return std::nullopt;
  }
  la::BlockLu<double>& lu() { return lu_; }

 private:
  la::MCK m_;
  la::BlockLu<double> lu_;
};

/// Metric of the lowest eigenvalue: displacements as they are, rotations by a tenth of the model.
VecX metric(const system::System& s, double length) {
  VecX d(s.size());
  for (Index k = 0; k < d.size(); ++k) {
    const bool displacement = k % 6 < 3 || s.node(k / 6).scalar;
    d[k] = displacement ? 1.0 : 0.01 * length * length;
  }
  return d;
}

void clear_held(VecX& x, std::span<const unsigned char> free) {
  WHIRL_EXPECTS(x.size() == static_cast<Index>(free.size()));
  for (Index k = 0; k < x.size(); ++k)
    if (!free[at(k)]) x[k] = 0.0;
}

/// A start that no symmetry of a model makes orthogonal to what is sought.
VecX generic_start(Index n, std::span<const unsigned char> free) {
  VecX x(n);
  for (Index k = 0; k < n; ++k)
    x[k] = 0.5 + std::fmod(0.6180339887498949 * static_cast<double>(k + 1), 1.0);
  clear_held(x, free);
  return x;
}

/// Inverse iteration with the factors at hand: x becomes the vector, the result mu of (K + shift D)
/// x = mu D x of least size.
double inverse_iteration(la::BlockLu<double>& lu, const VecX& D,
                         std::span<const unsigned char> free, VecX& x, int steps,
                         double tolerance) {
  WHIRL_EXPECTS(x.size() == D.size() && steps > 0);
  double mu = nan;
  for (int k = 0; k < steps; ++k) {
    x /= std::sqrt(x.dot(D.cwiseProduct(x)));
    VecX y = D.cwiseProduct(x);
    lu.solve(y);
    clear_held(y, free);
    const double inverse = y.dot(D.cwiseProduct(x));
    if (!y.allFinite() || inverse == 0.0) return nan;
    const double before = mu;
    mu = 1.0 / inverse;
    x = y;
    if (std::abs(mu - before) <= tolerance * std::abs(mu)) break;
  }
  return mu;
}

/// Lowest eigenvalue and vector of a symmetric K: its place between shifts by inertia, then inverse
/// iteration from just below.
void find_lowest(const la::BlockMatrix<6>& K, std::span<const unsigned char> free,
                 const system::System& system, double length, Definiteness& out) {
  const VecX D = metric(system, length);
  Shifted shifted(K, D, free);
  double up = 1.0;  // K + up D is definite; a start from what one row holds
  VecX x = generic_start(D.size(), free);
  VecX Kx = VecX::Zero(D.size());
  K.add_multiply(1.0, x, Kx);
  up = std::max(1e-12 * std::abs(Kx.dot(x)) / x.dot(D.cwiseProduct(x)), 1e-300);
  // what cannot be factored counts as not definite: up is a shift that could
  const auto definite = [&](double shift) { return shifted.negative(shift) == Index{0}; };
  while (!definite(up) && up < 1e30)
    up *= 16.0;
  double down = 0.0;
  for (int k = 0; k < 60 && up - down > 0.02 * up; ++k) {
    const double middle = down > 0.0 && up > 4.0 * down ? std::sqrt(up * down)
                          : down > 0.0                  ? 0.5 * (up + down)
                                                        : up / 64.0;
    if (definite(middle))
      up = middle;
    else
      down = middle;
  }
  if (!shifted.factor(up)) return;
  const double mu = inverse_iteration(shifted.lu(), D, free, x, 60, 1e-12);
  out.lowest = mu - up;
  scale_shape(x, system);
  out.shape = x;
}

/// Unsymmetric K: negative real eigenvalues among those of least size.
void count_real(const la::BlockMatrix<6>& K, std::span<const unsigned char> free,
                const system::System& system, double length, Definiteness& out) {
  const VecX D = metric(system, length);
  la::BlockMatrix<6> B(K.pattern());
  B.set_zero();
  for (Index i = 0; i < K.pattern().size(); ++i)
    B.block(K.pattern().diagonal(i)).diagonal() = D.segment<6>(6 * i);
  out.negative = out.open = 0;
  try {
    for (const la::Mode& m : la::linear_modes(K, B, free, 8)) {
      const double size = std::abs(m.lambda);
      const bool real = std::abs(m.lambda.imag()) <= 1e-9 * size;
      if (!real && m.lambda.real() < -1e-9 * size) ++out.open;
      if (!real || m.lambda.real() >= 0.0) continue;
      ++out.negative;
      if (out.lowest < m.lambda.real()) continue;
      out.lowest = m.lambda.real();
      // a real vector, but for one phase
      Index largest = 0;
      m.x.cwiseAbs().maxCoeff(&largest);
      out.shape = (m.x / m.x[largest]).real();
      scale_shape(out.shape, system);
    }
  } catch (const Error&) {
    out.negative = out.open = 0;
  }
  // one more than were found where the sign of det K says so
  if (out.sign != 0 && (out.negative % 2 != 0) != (out.sign < 0)) ++out.negative;
}

}  // namespace

bool has_signals(const system::System& s) {
  for (Index i = 0; i < s.nodes(); ++i)
    if (s.node(i).signal) return true;
  return false;
}

Definiteness judge_tangent(const la::BlockMatrix<6>& K, std::span<const unsigned char> free,
                           const system::System& system, double length, bool shape) {
  WHIRL_EXPECTS(free.size() == at(system.size()) && length > 0.0);
  Definiteness out;
  const VecX rows = row_sizes(K);
  la::BlockMatrix<6> symmetric(K.pattern());
  out.symmetric = symmetrise(K, rows, free, symmetric) <= skewness;
  Shifted half(symmetric, rows, free);
  const std::optional<Index> directions = half.negative(rounding);
  if (directions) {
    out.negative = *directions;
    out.sign = out.negative % 2 == 0 ? 1 : -1;
    if (out.negative == 0) return out;
  }
  if (out.symmetric && directions) {
    if (shape) find_lowest(symmetric, free, system, length, out);
    return out;
  }
  Shifted whole(K, rows, free);
  bool factored = false;
  for (double s = rounding; s < 1e-9 && !factored; s *= 2.0)
    factored = whole.factor(s);
  out.sign = !factored ? 0 : whole.lu().determinant().second.real() < 0.0 ? -1 : 1;
  out.certain = factored && out.sign < 0;
  if (has_signals(system)) {
    out.negative = out.certain ? 1 : 0;
    out.judged = out.certain;
    return out;
  }
  count_real(K, free, system, length, out);
  return out;
}

void scale_shape(VecX& x, const system::System& s) {
  WHIRL_EXPECTS(x.size() == s.size());
  double top = 0, turn = 0;
  for (Index k = 0; k < x.size(); ++k) {
    double& largest = k % 6 < 3 || s.node(k / 6).scalar ? top : turn;
    if (std::abs(x[k]) > std::abs(largest) * (1 + 1e-9)) largest = x[k];
  }
  const double by = std::abs(top) > 1e-12 * std::abs(turn) ? top : turn;
  if (by != 0.0) x /= by;
}

double model_length(const system::System& s) {
  Vec3 low = Vec3::Constant(infinity);
  Vec3 high = -low;
  for (Index i = 0; i < s.nodes(); ++i) {
    if (s.node(i).scalar) continue;
    low = low.cwiseMin(s.node(i).position);
    high = high.cwiseMax(s.node(i).position);
  }
  const double length = (high - low).norm();
  return length > 0 ? length : 1.0;
}

std::vector<unsigned char> free_unknowns(const system::System& s, std::span<const Index> holds) {
  std::vector<unsigned char> out(s.active().begin(), s.active().end());
  for (Index k : holds)
    out[at(k)] = 0;
  return out;
}

double eigenvalue_near_zero(const la::BlockMatrix<6>& K, std::span<const unsigned char> free,
                            const system::System& system, double length, VecX& x) {
  WHIRL_EXPECTS(free.size() == at(system.size()));
  WHIRL_EXPECTS(length > 0.0);
  const VecX D = metric(system, length);
  if (x.size() != D.size()) x = generic_start(D.size(), free);
  Shifted shifted(K, D, free);
  double shift = 0.0;
  if (!shifted.factor(shift)) {
    // singular to rounding: a shift of that size
    VecX Kx = VecX::Zero(D.size());
    const VecX start = generic_start(D.size(), free);
    K.add_multiply(1.0, start, Kx);
    shift = 1e-13 * std::abs(Kx.dot(start)) / start.dot(D.cwiseProduct(start));
    if (!shifted.factor(shift)) return nan;
  }
  return inverse_iteration(shifted.lu(), D, free, x, 200, 1e-11) - shift;
}

}  // namespace whirl::analysis
