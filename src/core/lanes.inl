// Several doubles in one compiler vector, one a node or element: four with AVX2, two on a baseline
// machine. Included inside an anonymous namespace by the kernels that are compiled once per
// instruction set; needs <math.h> before it.
#define WHIRL_INLINE static inline __attribute__((always_inline))

#ifdef __AVX2__
constexpr int width = 4;
#else
constexpr int width = 2;
#endif
// NOLINTBEGIN(modernize-use-using): attributes of vectors
typedef double T __attribute__((vector_size(8 * width)));
typedef double Unaligned
    __attribute__((vector_size(8 * width), aligned(8), may_alias));  // in memory
typedef long long Mask __attribute__((vector_size(8 * width)));
// NOLINTEND(modernize-use-using)

WHIRL_INLINE T all(double s) { return T{} + s; }
WHIRL_INLINE bool every(Mask m) {
  long long r = -1;
  for (int i = 0; i < width; ++i)
    r &= m[i];
  return r != 0;
}
WHIRL_INLINE T root(T x) {  // one instruction
  for (int i = 0; i < width; ++i)
    x[i] = __builtin_sqrt(x[i]);
  return x;
}

WHIRL_INLINE void transpose4(T a, T b, T c, T d, T* r) {
#ifdef __AVX2__
  const T l01 = __builtin_shufflevector(a, b, 0, 4, 2, 6),
          h01 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const T l23 = __builtin_shufflevector(c, d, 0, 4, 2, 6),
          h23 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(l01, l23, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(h01, h23, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(l01, l23, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(h01, h23, 2, 3, 6, 7);
#else
  (void)a;
  (void)b;
  (void)c;
  (void)d;
  (void)r;
#endif
}
/// Four consecutive doubles of each into four vectors.
WHIRL_INLINE void load4(const double* const* p, T& a, T& b, T& c, T& d) {
#ifdef __AVX2__
  T r[4];
  transpose4(*(const Unaligned*)p[0], *(const Unaligned*)p[1], *(const Unaligned*)p[2],
             *(const Unaligned*)p[3], r);
  a = r[0];
  b = r[1];
  c = r[2];
  d = r[3];
#else
  a = T{p[0][0], p[1][0]};
  b = T{p[0][1], p[1][1]};
  c = T{p[0][2], p[1][2]};
  d = T{p[0][3], p[1][3]};
#endif
}
/// N >= 4 consecutive doubles of each into N vectors.
template <int N, int K = 0>
WHIRL_INLINE void load_record(const double* const* from, T (&r)[N]) {
  if constexpr (K < N && N - K != 1) {
    constexpr int first = K + 4 <= N ? K : N - 4;  // the last four may repeat some
    const double* p[width];
    for (int i = 0; i < width; ++i)
      p[i] = from[i] + first;
    load4(p, r[first], r[first + 1], r[first + 2], r[first + 3]);
    load_record<N, K + 4>(from, r);
  } else if constexpr (K < N) {
    for (int i = 0; i < width; ++i)
      r[K][i] = from[i][K];
  }
}
/// Four components to four consecutive doubles of each, the first `used` only.
WHIRL_INLINE void store4(double* const* p, int offset, int used, T a, T b, T c, T d) {
#ifdef __AVX2__
  T r[4];
  transpose4(a, b, c, d, r);
  for (int i = 0; i < width; ++i)
    if (i < used) *(Unaligned*)(p[i] + offset) = r[i];
#else
  for (int i = 0; i < width; ++i)
    if (i < used) {
      p[i][offset] = a[i];
      p[i][offset + 1] = b[i];
      p[i][offset + 2] = c[i];
      p[i][offset + 3] = d[i];
    }
#endif
}
/// N vectors to N consecutive doubles of each, the first `used` only.
template <int N, int K = 0>
WHIRL_INLINE void store_record(double* const* to, int used, const T (&r)[N]) {
  if constexpr (K + 4 <= N) {
    store4(to, K, used, r[K], r[K + 1], r[K + 2], r[K + 3]);
    store_record<N, K + 4>(to, used, r);
  } else {
    for (int i = 0; i < used; ++i)
      for (int k = K; k < N; ++k)
        to[i][k] = r[k][i];
  }
}
/// Adds four components to four consecutive doubles of each element, the first `used` elements
/// only.
WHIRL_INLINE void add4(double* const* p, int offset, int used, T a, T b, T c, T d) {
#ifdef __AVX2__
  T r[4];
  transpose4(a, b, c, d, r);
  for (int i = 0; i < width; ++i)
    if (i < used) *(Unaligned*)(p[i] + offset) += r[i];
#else
  for (int i = 0; i < width; ++i)
    if (i < used) {
      p[i][offset] += a[i];
      p[i][offset + 1] += b[i];
      p[i][offset + 2] += c[i];
      p[i][offset + 3] += d[i];
    }
#endif
}

struct V {
  T x, y, z;
};
WHIRL_INLINE V operator+(V a, V b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
WHIRL_INLINE V operator-(V a, V b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
WHIRL_INLINE V operator-(V a) { return V{} - a; }
WHIRL_INLINE V operator*(T s, V a) { return {s * a.x, s * a.y, s * a.z}; }
WHIRL_INLINE T dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
WHIRL_INLINE V cross(V a, V b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
WHIRL_INLINE void add(V& a, V b) { a = a + b; }

/// Three numbers of a record; those of a vector into a record.
WHIRL_INLINE V vector_at(const T* r, int place) { return {r[place], r[place + 1], r[place + 2]}; }
WHIRL_INLINE void put(V a, T* r, int place) {
  r[place] = a.x;
  r[place + 1] = a.y;
  r[place + 2] = a.z;
}

// The names that formulas for one and for several have in common (core/single.hpp).
template <class Scalar, class Vector>
struct NumbersOf {
  using T = Scalar;
  using V = Vector;
};
using Lanes = NumbersOf<T, V>;
WHIRL_INLINE T at_least(T x, T limit) { return x > limit ? x : limit; }
/// What vectors and scalars are divided by: one division for all of them.
struct Divisor {
  T inverse;
};
WHIRL_INLINE Divisor divisor(T x) { return {1.0 / x}; }
WHIRL_INLINE T operator/(T a, Divisor d) { return a * d.inverse; }
WHIRL_INLINE V operator/(V a, Divisor d) { return d.inverse * a; }
