// Dense output of a step: its ends, and cubic Hermite interpolation between them.
#pragma once
#include <core/contract.hpp>
#include <time/problem.hpp>

namespace whirl::time {

/// State at one end of a step.
struct StepEnd {
  double t;
  const VecX &q, &v, &a;
};

/// Whether t is that end; then its state, to the last bit.
inline bool take_end(double t, const StepEnd& end, Ref q, Ref v, Ref a) {
  if (t != end.t) return false;
  q = end.q;
  v = end.v;
  a = end.a;
  return true;
}

/// q from (q, v) at both ends, v = q', a = q''.
/// @pre h > 0, vectors of one length; q, v, a are none of those given.
inline void hermite(double theta, double h, const VecX& q0, const VecX& v0, const VecX& q1,
                    const VecX& v1, Ref q, Ref v, Ref a) {
  WHIRL_EXPECTS(h > 0.0);
  WHIRL_EXPECTS(q.size() == q0.size() && v.size() == q0.size() && a.size() == q0.size());
  WHIRL_EXPECTS(q.data() != q0.data() && q.data() != q1.data());
  WHIRL_EXPECTS(v.data() != v0.data() && v.data() != v1.data());
  const double x = theta, y = 1.0 - theta;
  q = q0 + (x * x * (3.0 - 2.0 * x)) * (q1 - q0) + (h * x * y * y) * v0 - (h * x * x * y) * v1;
  v = (6.0 * x * y / h) * (q1 - q0) + (y * (1.0 - 3.0 * x)) * v0 + (x * (3.0 * x - 2.0)) * v1;
  a = (6.0 * (1.0 - 2.0 * x) / (h * h)) * (q1 - q0) + ((6.0 * x - 4.0) / h) * v0 +
      ((6.0 * x - 2.0) / h) * v1;
}

}  // namespace whirl::time
