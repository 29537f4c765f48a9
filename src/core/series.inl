// Power series by Horner's rule, for one number (T = double) or several (T a compiler vector).
// Included inside an anonymous namespace; the includer gives WHIRL_INLINE.
#pragma once

/// c[0] + c[1] x + .. + c[N-1] x^(N-1), N >= 2.
template <int N, class T>
WHIRL_INLINE T horner(const double* c, T x) {
  T s = c[N - 2] + c[N - 1] * x;
  for (int k = N - 3; k >= 0; --k)
    s = s * x + c[k];
  return s;
}
