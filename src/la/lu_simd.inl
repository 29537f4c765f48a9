// Columns of six doubles padded to eight, as compiler vectors: three of 16 bytes on a baseline
// machine (the padding is never touched), two of 32 bytes with AVX2, or one of 64 bytes with
// AVX-512. Real and complex scalars share the algorithms in lu_kernel.inl through the types Real
// and Cplx below.
#define WHIRL_INLINE static inline __attribute__((always_inline))

/// a b - p by splitting the factors in halves (Veltkamp, Dekker), for machines without a fused
/// multiply-add.
template <class C>
WHIRL_INLINE C split_product_error(C a, C b, C p) {
  const C f = a.all(134217729.0), fa = f * a, fb = f * b;
  const C ah = fa - (fa - a), bh = fb - (fb - b);
  const C al = a - ah, bl = b - bh;
  return al * bl - (((p - ah * bh) - al * bh) - ah * bl);
}

typedef double v2 __attribute__((vector_size(16), aligned(8), may_alias));

#ifdef __AVX512F__

struct Col {
  __m512d x;
};
WHIRL_INLINE Col zero_col() { return {_mm512_setzero_pd()}; }
WHIRL_INLINE Col splat(double s) { return {_mm512_set1_pd(s)}; }
WHIRL_INLINE Col load(const double* p) { return {_mm512_loadu_pd(p)}; }
WHIRL_INLINE Col load6(const double* p) { return {_mm512_maskz_loadu_pd(0x3f, p)}; }
WHIRL_INLINE void store(double* p, Col c) { _mm512_storeu_pd(p, c.x); }
WHIRL_INLINE void store6(double* p, Col c) { _mm512_mask_storeu_pd(p, 0x3f, c.x); }
WHIRL_INLINE Col operator+(Col a, Col b) { return {a.x + b.x}; }
WHIRL_INLINE Col operator-(Col a, Col b) { return {a.x - b.x}; }
WHIRL_INLINE Col operator*(Col a, Col b) { return {a.x * b.x}; }
WHIRL_INLINE Col operator/(Col a, Col b) { return {a.x / b.x}; }
WHIRL_INLINE Col abs(Col a) { return {_mm512_abs_pd(a.x)}; }
WHIRL_INLINE Col max(Col a, Col b) { return {_mm512_max_pd(a.x, b.x)}; }
template <int P>
WHIRL_INLINE Col broadcast(Col c) {
  return {_mm512_permutexvar_pd(_mm512_set1_epi64(P), c.x)};
}
/// c with row P replaced by row P of d.
template <int P>
WHIRL_INLINE Col replace(Col c, Col d) {
  return {_mm512_mask_mov_pd(c.x, 1 << P, d.x)};
}
WHIRL_INLINE Col mask_and(Col c, const long long* m) {
  return {_mm512_maskz_mov_pd(_mm512_test_epi64_mask(_mm512_loadu_si512(m), _mm512_set1_epi64(-1)),
                              c.x)};
}
/// c, hidden from the optimiser.
WHIRL_INLINE Col opaque(Col c) {
  __asm__("" : "+v"(c.x));
  return c;
}
/// a b - p without rounding, p the rounded product.
WHIRL_INLINE Col product_error(Col a, Col b, Col p) { return {_mm512_fmsub_pd(a.x, b.x, p.x)}; }
/// True when a <= b fails in any of the rows (NaN fails).
struct Violation {
  __mmask8 m;
};
WHIRL_INLINE Violation no_violation() { return {0}; }
WHIRL_INLINE void note_unless_le(Violation& v, Col a, Col b) {
  v.m = static_cast<__mmask8>(v.m | _mm512_cmp_pd_mask(a.x, b.x, _CMP_NLE_UQ));
}
WHIRL_INLINE bool any(Violation v) { return (v.m & 0x3f) != 0; }

#elif defined(__AVX2__)

typedef double v4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef long long i4 __attribute__((vector_size(32), aligned(8), may_alias));

struct Col {
  v4 a, b;
  static Col all(double s) { return {v4{s, s, s, s}, v4{s, s, s, s}}; }
};
WHIRL_INLINE Col zero_col() { return {v4{}, v4{}}; }
WHIRL_INLINE Col splat(double s) { return Col::all(s); }
WHIRL_INLINE Col load(const double* p) { return {*(const v4*)p, *(const v4*)(p + 4)}; }
WHIRL_INLINE Col load6(const double* p) {
  return {*(const v4*)p, __builtin_shufflevector(*(const v2*)(p + 4), v2{}, 0, 1, 2, 3)};
}
WHIRL_INLINE void store(double* p, Col c) {
  *(v4*)p = c.a;
  *(v4*)(p + 4) = c.b;
}
WHIRL_INLINE void store6(double* p, Col c) {
  *(v4*)p = c.a;
  *(v2*)(p + 4) = __builtin_shufflevector(c.b, c.b, 0, 1);
}
WHIRL_INLINE Col operator+(Col x, Col y) { return {x.a + y.a, x.b + y.b}; }
WHIRL_INLINE Col operator-(Col x, Col y) { return {x.a - y.a, x.b - y.b}; }
WHIRL_INLINE Col operator*(Col x, Col y) { return {x.a * y.a, x.b * y.b}; }
WHIRL_INLINE Col operator/(Col x, Col y) { return {x.a / y.a, x.b / y.b}; }
WHIRL_INLINE Col abs(Col x) {
  const long long m = 0x7fffffffffffffffLL;
  const i4 mm = {m, m, m, m};
  return {(v4)((i4)x.a & mm), (v4)((i4)x.b & mm)};
}
WHIRL_INLINE Col max(Col x, Col y) { return {x.a > y.a ? x.a : y.a, x.b > y.b ? x.b : y.b}; }
template <int P>
WHIRL_INLINE Col broadcast(Col c) {
  if constexpr (P < 4) {
    const v4 r = __builtin_shufflevector(c.a, c.a, P, P, P, P);
    return {r, r};
  } else {
    const v4 r = __builtin_shufflevector(c.b, c.b, P - 4, P - 4, P - 4, P - 4);
    return {r, r};
  }
}
/// c with row P replaced by row P of d.
template <int P>
WHIRL_INLINE Col replace(Col c, Col d) {
  if constexpr (P < 4)
    return {__builtin_shufflevector(c.a, d.a, P == 0 ? 4 : 0, P == 1 ? 5 : 1, P == 2 ? 6 : 2,
                                    P == 3 ? 7 : 3),
            c.b};
  else
    return {c.a, __builtin_shufflevector(c.b, d.b, P == 4 ? 4 : 0, P == 5 ? 5 : 1, 2, 3)};
}
WHIRL_INLINE Col mask_and(Col c, const long long* m) {
  return {(v4)((i4)c.a & *(const i4*)m), (v4)((i4)c.b & *(const i4*)(m + 4))};
}
WHIRL_INLINE Col opaque(Col c) {
  __asm__("" : "+x"(c.a), "+x"(c.b));
  return c;
}
WHIRL_INLINE Col product_error(Col a, Col b, Col p) {
#ifdef __FMA__
  return {_mm256_fmsub_pd(a.a, b.a, p.a), _mm256_fmsub_pd(a.b, b.b, p.b)};
#else
  return split_product_error(a, b, p);
#endif
}
/// True when a <= b fails in any of the rows (NaN fails). Padded rows hold 0 <= 0.
struct Violation {
  i4 m;
};
WHIRL_INLINE Violation no_violation() { return {i4{}}; }
WHIRL_INLINE void note_unless_le(Violation& v, Col x, Col y) {
  v.m |= ~(x.a <= y.a) | ~(x.b <= y.b);
}
WHIRL_INLINE bool any(Violation v) { return (v.m[0] | v.m[1] | v.m[2] | v.m[3]) != 0; }

#else

typedef long long i2 __attribute__((vector_size(16), aligned(8), may_alias));
struct Col {
  v2 a, b, c;
  static Col all(double s) { return {v2{s, s}, v2{s, s}, v2{s, s}}; }
};
WHIRL_INLINE Col splat(double s) { return Col::all(s); }
WHIRL_INLINE Col zero_col() { return splat(0.0); }
WHIRL_INLINE Col load(const double* p) {
  return {*(const v2*)p, *(const v2*)(p + 2), *(const v2*)(p + 4)};
}
WHIRL_INLINE Col load6(const double* p) { return load(p); }
WHIRL_INLINE void store(double* p, Col x) {
  *(v2*)p = x.a;
  *(v2*)(p + 2) = x.b;
  *(v2*)(p + 4) = x.c;
}
WHIRL_INLINE void store6(double* p, Col x) { store(p, x); }
WHIRL_INLINE Col operator+(Col x, Col y) { return {x.a + y.a, x.b + y.b, x.c + y.c}; }
WHIRL_INLINE Col operator-(Col x, Col y) { return {x.a - y.a, x.b - y.b, x.c - y.c}; }
WHIRL_INLINE Col operator*(Col x, Col y) { return {x.a * y.a, x.b * y.b, x.c * y.c}; }
WHIRL_INLINE Col operator/(Col x, Col y) { return {x.a / y.a, x.b / y.b, x.c / y.c}; }
WHIRL_INLINE v2 select(i2 m, v2 x, v2 y) { return (v2)(((i2)x & m) | ((i2)y & ~m)); }
WHIRL_INLINE Col abs(Col x) {
  const long long m = 0x7fffffffffffffffLL;
  const i2 mm = {m, m};
  return {(v2)((i2)x.a & mm), (v2)((i2)x.b & mm), (v2)((i2)x.c & mm)};
}
WHIRL_INLINE Col max(Col x, Col y) {
  return {select(x.a > y.a, x.a, y.a), select(x.b > y.b, x.b, y.b), select(x.c > y.c, x.c, y.c)};
}
template <int P>
WHIRL_INLINE v2 half(Col x) {
  return P < 2 ? x.a : P < 4 ? x.b : x.c;
}
template <int P>
WHIRL_INLINE Col broadcast(Col x) {
  const v2 r = __builtin_shufflevector(half<P>(x), half<P>(x), P % 2, P % 2);
  return {r, r, r};
}
/// x with row P replaced by row P of y.
template <int P>
WHIRL_INLINE Col replace(Col x, Col y) {
  const v2 r =
      __builtin_shufflevector(half<P>(x), half<P>(y), P % 2 == 0 ? 2 : 0, P % 2 == 0 ? 1 : 3);
  return {P / 2 == 0 ? r : x.a, P / 2 == 1 ? r : x.b, P / 2 == 2 ? r : x.c};
}
WHIRL_INLINE Col mask_and(Col x, const long long* m) {
  return {(v2)((i2)x.a & *(const i2*)m), (v2)((i2)x.b & *(const i2*)(m + 2)),
          (v2)((i2)x.c & *(const i2*)(m + 4))};
}
WHIRL_INLINE Col opaque(Col c) {
#if defined(__x86_64__)
  __asm__("" : "+x"(c.a), "+x"(c.b), "+x"(c.c));
#elif defined(__aarch64__)
  __asm__("" : "+w"(c.a), "+w"(c.b), "+w"(c.c));
#endif
  return c;
}
WHIRL_INLINE Col product_error(Col a, Col b, Col p) {
#if defined(__FMA__) || defined(__aarch64__)
  Col e;
  for (int i = 0; i < 2; ++i) {
    e.a[i] = __builtin_fma(a.a[i], b.a[i], -p.a[i]);
    e.b[i] = __builtin_fma(a.b[i], b.b[i], -p.b[i]);
    e.c[i] = __builtin_fma(a.c[i], b.c[i], -p.c[i]);
  }
  return e;
#else
  return split_product_error(a, b, p);
#endif
}
/// True when a <= b fails in any of the rows (NaN fails).
struct Violation {
  i2 m;
};
WHIRL_INLINE Violation no_violation() { return {i2{}}; }
WHIRL_INLINE void note_unless_le(Violation& v, Col x, Col y) {
  v.m |= ~(x.a <= y.a) | ~(x.b <= y.b) | ~(x.c <= y.c);
}
WHIRL_INLINE bool any(Violation v) { return (v.m[0] | v.m[1]) != 0; }

#endif

// A column of real or complex numbers, and a scalar broadcast to all rows.
struct Real {
  static constexpr int planes = 1;
  Col x;
};
struct Cplx {
  static constexpr int planes = 2;
  Col x, y;  // real and imaginary parts
};

template <class T>
WHIRL_INLINE T zero_of();
template <>
inline __attribute__((always_inline)) Real zero_of<Real>() {
  return {zero_col()};
}
template <>
inline __attribute__((always_inline)) Cplx zero_of<Cplx>() {
  return {zero_col(), zero_col()};
}

WHIRL_INLINE void load_col(Real& c, const double* p) { c.x = load(p); }
WHIRL_INLINE void load_col(Cplx& c, const double* p) {
  c.x = load(p);
  c.y = load(p + plane);
}
WHIRL_INLINE void store_col(double* p, const Real& c) { store(p, c.x); }
WHIRL_INLINE void store_col(double* p, const Cplx& c) {
  store(p, c.x);
  store(p + plane, c.y);
}
WHIRL_INLINE void load_scalar(Real& c, const double* p, int) { c.x = splat(*p); }
WHIRL_INLINE void load_scalar(Cplx& c, const double* p, int stride) {
  c.x = splat(*p);
  c.y = splat(p[stride]);
}
/// acc -= a s, acc += a s
WHIRL_INLINE void sub_mul(Real& acc, const Real& a, const Real& s) { acc.x = acc.x - a.x * s.x; }
WHIRL_INLINE void sub_mul(Cplx& acc, const Cplx& a, const Cplx& s) {
  acc.x = acc.x - a.x * s.x;
  acc.y = acc.y - a.y * s.x;
  acc.x = acc.x + a.y * s.y;
  acc.y = acc.y - a.x * s.y;
}
WHIRL_INLINE void add_mul(Real& acc, const Real& a, const Real& s) { acc.x = acc.x + a.x * s.x; }
WHIRL_INLINE void add_mul(Cplx& acc, const Cplx& a, const Cplx& s) {
  acc.x = acc.x + a.x * s.x;
  acc.y = acc.y + a.y * s.x;
  acc.x = acc.x - a.y * s.y;
  acc.y = acc.y + a.x * s.y;
}
WHIRL_INLINE Real mul(const Real& a, const Real& s) { return {a.x * s.x}; }
WHIRL_INLINE Cplx mul(const Cplx& a, const Cplx& s) {
  return {a.x * s.x - a.y * s.y, a.y * s.x + a.x * s.y};
}
WHIRL_INLINE Real neg(const Real& a) { return {zero_col() - a.x}; }
WHIRL_INLINE Cplx neg(const Cplx& a) { return {zero_col() - a.x, zero_col() - a.y}; }
/// Size used in pivot tests: |a|, or |re| + |im|.
WHIRL_INLINE Col size_of(const Real& a) { return abs(a.x); }
WHIRL_INLINE Col size_of(const Cplx& a) { return abs(a.x) + abs(a.y); }
WHIRL_INLINE Real reciprocal(const Real& a) { return {splat(1.0) / a.x}; }
WHIRL_INLINE Cplx reciprocal(const Cplx& a) {
  // The plain quotient: pivots whose squares over- or underflow fail the pivot test.
  const Col r = splat(1.0) / (a.x * a.x + a.y * a.y);
  return {a.x * r, zero_col() - a.y * r};
}
template <int P>
WHIRL_INLINE Real broadcast(const Real& c) {
  return {broadcast<P>(c.x)};
}
template <int P>
WHIRL_INLINE Cplx broadcast(const Cplx& c) {
  return {broadcast<P>(c.x), broadcast<P>(c.y)};
}
template <int P>
WHIRL_INLINE Real replace(const Real& c, const Real& d) {
  return {replace<P>(c.x, d.x)};
}
template <int P>
WHIRL_INLINE Cplx replace(const Cplx& c, const Cplx& d) {
  return {replace<P>(c.x, d.x), replace<P>(c.y, d.y)};
}
WHIRL_INLINE void apply_mask(Real& c, const long long* m) { c.x = mask_and(c.x, m); }
WHIRL_INLINE void apply_mask(Cplx& c, const long long* m) {
  c.x = mask_and(c.x, m);
  c.y = mask_and(c.y, m);
}
