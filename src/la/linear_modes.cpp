// Linear problems, by way of the quadratic solver with M = 0 (an N-sized operator).
#include <core/contract.hpp>
#include <algorithm>
#include <cmath>
#include <la/eigen.hpp>

namespace whirl::la {

std::vector<Mode> linear_modes(const BlockMatrix<6>& A, const BlockMatrix<6>& B,
                               std::span<const unsigned char> active, Index count, double shift) {
  WHIRL_EXPECTS(A.pattern().size() == B.pattern().size());
  WHIRL_EXPECTS(active.size() == at(6 * A.pattern().size()));
  WHIRL_EXPECTS(count > 0);
  ModeOptions options;
  options.count = count;
  options.shift = shift;
  MCK m(A.pattern());
  m.K = A;
  m.C = B;
  for (std::size_t i = 0; i < m.C.value_count(); ++i)
    m.C.data()[i] = -m.C.data()[i];
  std::vector<Mode> modes = quadratic_modes(m, active, options);
  std::stable_sort(modes.begin(), modes.end(), [&](const Mode& a, const Mode& b) {
    return std::abs(a.lambda - shift) < std::abs(b.lambda - shift);
  });
  return modes;
}

}  // namespace whirl::la
