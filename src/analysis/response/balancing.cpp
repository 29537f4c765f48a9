#include <analysis/response/balancing.hpp>
#include <core/contract.hpp>

#include <la/dense.hpp>

#include <algorithm>

namespace whirl::analysis {

VecXc balance_by_influence(const MatXc& A, const VecXc& r0) {
  WHIRL_EXPECTS(A.rows() == r0.size());
  return -la::least_squares(A, r0);
}

MatX modal_patterns(const MatX& phi) {
  WHIRL_EXPECTS(phi.rows() <= phi.cols());
  return la::least_squares(phi, MatX::Identity(phi.rows(), phi.rows()));
}

VecXc balance_by_modes(const MatXc& A, const VecXc& r0, const MatX& patterns,
                       const std::vector<std::vector<Index>>& rows) {
  WHIRL_EXPECTS(patterns.rows() == A.cols() &&
                static_cast<std::size_t>(patterns.cols()) == rows.size());
  VecXc w = VecXc::Zero(A.cols());
  VecXc r = r0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const VecXc pattern = patterns.col(static_cast<Index>(k)).cast<Complex>();
    const VecXc influence = A * pattern;
    Complex up = 0, down = 0;
    for (const Index i : rows[k]) {
      up += std::conj(influence[i]) * r[i];
      down += std::norm(influence[i]);
    }
    const Complex amount = down == Complex(0) ? Complex(0) : -up / down;
    w += amount * pattern;
    r += amount * influence;
  }
  return w;
}

int zone_of(double amplitude, const std::vector<double>& borders) {
  return static_cast<int>(
      std::count_if(borders.begin(), borders.end(), [&](double b) { return amplitude > b; }));
}

}  // namespace whirl::analysis
