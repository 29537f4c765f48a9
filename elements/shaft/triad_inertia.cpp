#include <elements/shaft/triad_inertia.hpp>

#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {
namespace {

/// Positive, with the sum one; own: twelve times the diagonal, 4 consistent to 6 lumped.
Mat2 node_matrix(const Vec2& own) {
  const double between = 6.0 - own.mean();
  return (Mat2() << own[0], between, between, own[1]).finished() / 12.0;
}

/// The smaller eigenvalue of a symmetric matrix, 0 at least.
double least(const Mat2& m) {
  const double apart = std::hypot(0.5 * (m(0, 0) - m(1, 1)), m(0, 1));
  return std::max(0.5 * m.trace() - apart, 0.0);
}

}  // namespace

TriadInertia::TriadInertia() {
  for (std::array<Mat2, 3>& row : on)
    row.fill(Mat2::Zero());
}

TriadInertia::TriadInertia(const Mat3& J, double phi, MassKind kind, const TriadShare& share)
    : TriadInertia() {
  WHIRL_EXPECTS(phi >= 0.0 && phi <= 1.0);
  const Vec2 coupling = J.block<2, 1>(1, 0);
  const bool coupled = coupling.squaredNorm() > 0;
  Mat2 lateral = J.bottomRightCorner<2, 2>();
  contained = least(coupled ? Mat2(lateral - coupling * coupling.transpose() / J(0, 0)) : lateral);
  lateral -= contained * Mat2::Identity();

  const double corrected = kind == MassKind::corrected ? 1.0 : 0.0;
  const Vec2 consistent = Vec2::Constant(4.0);
  const Mat2 along = node_matrix(consistent + corrected * share.spin);
  // what couples both is positive with one matrix for both
  const Mat2 across =
      coupled ? along : node_matrix(consistent + (2.0 - phi) * corrected * share.tilt);

  const std::array<Mat2, 3> about{J(0, 0) * along, lateral(0, 0) * across, lateral(1, 1) * across};
  const Mat2 half = 0.5 * (about[0] + about[1] + about[2]);
  for (std::size_t k = 0; k < 3; ++k)
    on[k][k] = half - about[k];
  on[1][2] = on[2][1] = -lateral(0, 1) * across;
  for (const std::size_t k : {1, 2})
    on[0][k] = on[k][0] = -coupling[static_cast<Index>(k) - 1] * along;
}

double shear_share(double k11, double k12, double k22) {
  const double mean = 0.5 * (k11 + k22);
  return 1.0 - std::min((mean + k12) / (3.0 * (mean - k12)), 1.0);
}

}  // namespace whirl::elements
