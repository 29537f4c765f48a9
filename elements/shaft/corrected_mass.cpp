#include <elements/shaft/corrected_mass.hpp>

#include <core/contract.hpp>

#include <Eigen/Cholesky>

#include <cmath>

namespace whirl::elements {

double admitted_correction(const MatX& mass, const MatX& correction) {
  WHIRL_EXPECTS(mass.rows() == correction.rows());
  constexpr double spent = 0.75, rounding = 1e-12;
  VecX inverse = mass.diagonal();
  if (!(inverse.maxCoeff() > 0)) return 0.0;
  for (double& x : inverse)
    x = x > 0 ? 1.0 / std::sqrt(x) : 1.0;
  MatX base = inverse.asDiagonal() * mass * inverse.asDiagonal();
  base *= spent;
  base.diagonal().array() += rounding;
  const MatX part = inverse.asDiagonal() * correction * inverse.asDiagonal();
  Eigen::LLT<MatX> root;
  const auto positive = [&](double share) {
    root.compute(base + share * part);
    return root.info() == Eigen::Success;
  };
  if (positive(1.0)) return 1.0;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (positive(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace whirl::elements
