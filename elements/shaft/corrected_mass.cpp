#include <elements/shaft/corrected_mass.hpp>

#include <core/contract.hpp>
#include <la/dense.hpp>

#include <cmath>

namespace whirl::elements {

double admitted_correction(const MatX& mass, const MatX& correction) {
  WHIRL_EXPECTS(mass.rows() == correction.rows());
  constexpr double allowed = -0.75, rounding = 1e-12;
  VecX inverse = mass.diagonal();
  if (!(inverse.maxCoeff() > 0)) return 0.0;
  for (double& x : inverse)
    x = x > 0 ? 1.0 / std::sqrt(x) : 1.0;
  MatX scaled = inverse.asDiagonal() * mass * inverse.asDiagonal();
  scaled.diagonal().array() += rounding;
  const MatX part = inverse.asDiagonal() * correction * inverse.asDiagonal();
  const double least = la::symmetric_eigenpairs(part, scaled).values[0];
  return least < allowed ? allowed / least : 1.0;
}

}  // namespace whirl::elements
