// Body of the block LU kernels; see lu_kernel.hpp. Included by one .cpp per instruction set, which
// defines WHIRL_LU_TABLE (name of the function that returns the table) and WHIRL_LU_ISA (its
// label). Everything here has internal linkage.
#include <la/lu_kernel.hpp>

namespace whirl::la::lu {
namespace {

#include <la/lu_simd.inl>

/// Ratio of a multiplier (rows scaled to size 1) above which a diagonal pivot is refused; 1/0.001
/// is KLU's own default.
constexpr double pivot_threshold = 1e3;
/// A pivot below this fraction of its row is left to the careful inversion, which decides whether
/// it is zero.
constexpr double suspicious_pivot = 1e-9;
/// Pivots outside [smallest, 1/smallest] are left to the careful inversion too: squares of complex
/// ones must not underflow.
constexpr double smallest_pivot = 1e-140;
/// Growth of a diagonal block by elimination beyond this is recorded.
constexpr double noted_growth = 1e3;

template <class T>
struct Block {
  T c[6];
};

template <int I>
struct Int {
  static constexpr int value = I;
};
template <class F>
WHIRL_INLINE void for_each6(F&& f) {
  f(Int<0>{});
  f(Int<1>{});
  f(Int<2>{});
  f(Int<3>{});
  f(Int<4>{});
  f(Int<5>{});
}

/// b = sum of coefficient * matrix block. N = number of terms.
template <int N>
WHIRL_INLINE void form(Block<Real>& b, const Terms& t, long slot) {
  for (int j = 0; j < 6; ++j) {
    Col x = splat(t.re[0]) * load6(t.value[0] + 36 * slot + 6 * j);
    if constexpr (N > 1) x = x + splat(t.re[1]) * load6(t.value[1] + 36 * slot + 6 * j);
    if constexpr (N > 2) x = x + splat(t.re[2]) * load6(t.value[2] + 36 * slot + 6 * j);
    b.c[j].x = x;
  }
}
template <int N>
WHIRL_INLINE void form(Block<Cplx>& b, const Terms& t, long slot) {
  for (int j = 0; j < 6; ++j) {
    const Col v = load6(t.value[0] + 36 * slot + 6 * j);
    Col x = splat(t.re[0]) * v, y = splat(t.im[0]) * v;
    if constexpr (N > 1) {
      const Col w = load6(t.value[1] + 36 * slot + 6 * j);
      x = x + splat(t.re[1]) * w;
      y = y + splat(t.im[1]) * w;
    }
    if constexpr (N > 2) {
      const Col w = load6(t.value[2] + 36 * slot + 6 * j);
      x = x + splat(t.re[2]) * w;
      y = y + splat(t.im[2]) * w;
    }
    b.c[j].x = x;
    b.c[j].y = y;
  }
}

/// Clears held rows (of step i) and columns (of step j) and puts ones on the diagonal of held
/// unknowns.
template <class T>
__attribute__((noinline)) void hold(const Plan& p, Block<T>& b, int i, int j) {
  const long long* const rows = p.mask + 8 * i;
  const long long* const cols = p.mask + 8 * j;
  for (int c = 0; c < 6; ++c) {
    if (cols[c] == 0) b.c[c] = zero_of<T>();
    apply_mask(b.c[c], rows);
  }
  if (i != j) return;
  for_each6([&](auto P) {
    constexpr int c = decltype(P)::value;
    if (cols[c] == 0) b.c[c].x = replace<c>(b.c[c].x, splat(1.0));
  });
}

template <int N, class T>
WHIRL_INLINE void assemble(Block<T>& b, const Plan& p, const Terms& t, long slot, int i, int j) {
  if (slot < 0) {
    for (int c = 0; c < 6; ++c)
      b.c[c] = zero_of<T>();
    return;
  }
  form<N>(b, t, slot);
  if (__builtin_expect(p.partial[i] | p.partial[j], 0)) {
    Block<T> h = b;  // a copy, so that b itself can stay in registers
    hold(p, h, i, j);
    b = h;
  }
}

template <class T>
WHIRL_INLINE void store_block(double* p, const Block<T>& b) {
  for (int j = 0; j < 6; ++j)
    store_col(p + 8 * j, b.c[j]);
}

/// c -= a b, a and b in memory.
template <class T>
WHIRL_INLINE void sub_product(Block<T>& c, const double* a, const double* b) {
  for (int k = 0; k < 6; ++k) {
    T ak;
    load_col(ak, a + 8 * k);
    for (int j = 0; j < 6; ++j) {
      T s;
      load_scalar(s, b + 8 * j + k, plane);
      sub_mul(c.c[j], ak, s);
    }
  }
}

/// c = a b, a in registers or on the stack, b in memory.
template <class T>
WHIRL_INLINE void product(Block<T>& c, const Block<T>& a, const double* b) {
  for (int j = 0; j < 6; ++j) {
    T s;
    load_scalar(s, b + 8 * j, plane);
    c.c[j] = mul(a.c[0], s);
  }
  for (int k = 1; k < 6; ++k)
    for (int j = 0; j < 6; ++j) {
      T s;
      load_scalar(s, b + 8 * j + k, plane);
      add_mul(c.c[j], a.c[k], s);
    }
}

template <class T>
WHIRL_INLINE Col row_sizes(const Block<T>& b) {
  Col m = size_of(b.c[0]);
  for (int j = 1; j < 6; ++j)
    m = max(m, size_of(b.c[j]));
  return m;
}

/// One in-place Gauss-Jordan step on the diagonal pivot P, with its test.
template <int P, class T>
WHIRL_INLINE void pivot_step(Block<T>& d, const Col& rows, const Col& rows_t, const Col& floor,
                             Violation& v) {
  const T pivot = broadcast<P>(d.c[P]);
  const Col size = size_of(pivot);
  note_unless_le(v, size_of(d.c[P]) * broadcast<P>(rows),
                 rows_t * size);  // |d_iP|/row_i <= threshold |d_PP|/row_P
  note_unless_le(v, broadcast<P>(floor), size);
  const T r = reciprocal(pivot);
  const T q = replace<P>(mul(d.c[P], neg(r)), r);
  for (int j = 0; j < 6; ++j) {
    if (j == P) continue;
    const T f = broadcast<P>(d.c[j]);
    T x = replace<P>(d.c[j], zero_of<T>());
    add_mul(x, q, f);
    d.c[j] = x;
  }
  d.c[P] = q;
}

template <class T>
struct Scalar;
template <>
struct Scalar<Real> {
  double re;
  double size() const { return __builtin_fabs(re); }
  static Scalar get(const double* p) { return {*p}; }
  void put(double* p) const { *p = re; }
  Scalar inverse() const { return {1.0 / re}; }
  Scalar operator*(Scalar b) const { return {re * b.re}; }
  Scalar operator-(Scalar b) const { return {re - b.re}; }
  Scalar scaled(double s) const { return {re * s}; }
};
template <>
struct Scalar<Cplx> {
  double re, im;
  double size() const { return __builtin_fabs(re) + __builtin_fabs(im); }
  static Scalar get(const double* p) { return {p[0], p[plane]}; }
  void put(double* p) const {
    p[0] = re;
    p[plane] = im;
  }
  Scalar inverse() const {
    const double s = 1.0 / size(), a = re * s, b = im * s, n = s / (a * a + b * b);
    return {a * n, -b * n};
  }
  Scalar operator*(Scalar b) const { return {re * b.re - im * b.im, re * b.im + im * b.re}; }
  Scalar operator-(Scalar b) const { return {re - b.re, im - b.im}; }
  Scalar scaled(double s) const { return {re * s, im * s}; }
};

/// Inverse of a padded block with complete pivoting after scaling rows and columns to size one, the
/// sizes taken over the block before (s) and after (d) elimination. Returns the component of the
/// first zero pivot, or -1. `growth` is raised where |d| exceeds |s|.
template <class T>
__attribute__((noinline)) int invert_carefully(const double* s, const double* d, double* out,
                                               double tolerance, double& growth) {
  using S = Scalar<T>;
  S a[6][6];
  double row[6], col[6];
  for (int i = 0; i < 6; ++i) {
    double before = 0.0, after = 0.0;
    for (int j = 0; j < 6; ++j) {
      const double x = S::get(s + 8 * j + i).size(), y = S::get(d + 8 * j + i).size();
      if (!(y <= 1e300)) return i;  // infinite or NaN
      before = x > before ? x : before;
      after = y > after ? y : after;
    }
    if (before > 0.0 && after > growth * before) growth = after / before;
    row[i] = after > before ? after : before;
    if (!(row[i] > 0.0)) return i;
  }
  for (int j = 0; j < 6; ++j) {
    col[j] = 0.0;
    for (int i = 0; i < 6; ++i) {
      const double x = S::get(s + 8 * j + i).size() / row[i],
                   y = S::get(d + 8 * j + i).size() / row[i];
      col[j] = x > col[j] ? x : col[j];
      col[j] = y > col[j] ? y : col[j];
    }
    if (!(col[j] > 0.0)) return j;
    for (int i = 0; i < 6; ++i)
      a[i][j] = S::get(d + 8 * j + i).scaled(1.0 / row[i]).scaled(1.0 / col[j]);
  }
  int pr[6], pc[6];
  for (int k = 0; k < 6; ++k) {
    int bi = k, bj = k;
    double best = -1.0;
    for (int j = k; j < 6; ++j)
      for (int i = k; i < 6; ++i)
        if (a[i][j].size() > best) {
          best = a[i][j].size();
          bi = i;
          bj = j;
        }
    pr[k] = bi;
    pc[k] = bj;
    if (!(best > tolerance)) {
      // Follow the column exchanges back to the unknown that is left without a pivot.
      int u = bj;
      for (int m = k - 1; m >= 0; --m)
        u = u == m ? pc[m] : u == pc[m] ? m : u;
      return u;
    }
    for (int j = 0; j < 6; ++j) {
      const S t = a[k][j];
      a[k][j] = a[bi][j];
      a[bi][j] = t;
    }
    for (int i = 0; i < 6; ++i) {
      const S t = a[i][k];
      a[i][k] = a[i][bj];
      a[i][bj] = t;
    }
    const S r = a[k][k].inverse();
    for (int j = 0; j < 6; ++j)
      if (j != k) a[k][j] = a[k][j] * r;
    for (int i = 0; i < 6; ++i) {
      if (i == k) continue;
      const S f = a[i][k];
      for (int j = 0; j < 6; ++j)
        if (j != k) a[i][j] = a[i][j] - f * a[k][j];
      a[i][k] = (f * r).scaled(-1.0);
    }
    a[k][k] = r;
  }
  // inverse(P A Q) = Q^-1 A^-1 P^-1: undo column exchanges on rows, row exchanges on columns, last
  // first.
  for (int k = 5; k >= 0; --k) {
    if (pc[k] != k)
      for (int j = 0; j < 6; ++j) {
        const S t = a[k][j];
        a[k][j] = a[pc[k]][j];
        a[pc[k]][j] = t;
      }
    if (pr[k] != k)
      for (int i = 0; i < 6; ++i) {
        const S t = a[i][k];
        a[i][k] = a[i][pr[k]];
        a[i][pr[k]] = t;
      }
  }
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 6; ++i)
      a[i][j].scaled(1.0 / col[i]).scaled(1.0 / row[j]).put(out + 8 * j + i);
    for (int i = 6; i < 8; ++i)
      for (int m = 0; m < T::planes; ++m)
        out[8 * j + i + plane * m] = 0.0;
  }
  return -1;
}

template <int N, class T>
Outcome factor(const Plan& p, const Terms& t, const Factors& f) {
  constexpr long stride = plane * T::planes;
  Outcome out;
  const Col threshold = splat(pivot_threshold), floor_factor = splat(suspicious_pivot),
            growth_limit = splat(noted_growth);
  const Col smallest = splat(smallest_pivot), largest = splat(1.0 / smallest_pivot);
  for (int k = 0; k < p.n; ++k) {
    Block<T> d;
    assemble<N>(d, p, t, p.diag_slot[k], k, k);
    const Col before = row_sizes(d);
    for (int u = p.row_start[k]; u < p.row_start[k + 1]; ++u) {
      const long e = p.row_entry[u];
      sub_product(d, f.lower + stride * e, f.upper + stride * e);
    }
    double* const inverse = f.inverse + stride * k;
    alignas(64) double saved[plane * T::planes];
    store_block(saved, d);
    const Col rows = row_sizes(d), rows_t = rows * threshold,
              floor = max(before * floor_factor, smallest);
    Violation bad = no_violation();
    note_unless_le(bad, rows, before * growth_limit);
    note_unless_le(bad, rows, largest);
    for_each6([&](auto P) { pivot_step<decltype(P)::value>(d, rows, rows_t, floor, bad); });
    store_block(inverse, d);
    if (__builtin_expect(any(bad), 0)) {
      ++out.repivoted;
      Block<T> s;
      alignas(64) double original[plane * T::planes];
      assemble<N>(s, p, t, p.diag_slot[k], k, k);
      store_block(original, s);
      out.component =
          invert_carefully<T>(original, saved, inverse, f.singular_tolerance, out.growth);
      if (out.component >= 0) {
        out.step = k;
        return out;
      }
    }
    for (long e = p.entry_start[k]; e < p.entry_start[k + 1]; ++e) {
      Block<T> a;
      assemble<N>(a, p, t, p.upper_slot[e], k, p.row[e]);
      for (int u = p.update_start[e]; u < p.update_start[e + 1]; ++u)
        sub_product(a, f.lower + stride * p.update[2 * u], f.upper + stride * p.update[2 * u + 1]);
      store_block(f.upper + stride * e, a);
      assemble<N>(a, p, t, p.lower_slot[e], p.row[e], k);
      for (int u = p.update_start[e]; u < p.update_start[e + 1]; ++u)
        sub_product(a, f.lower + stride * p.update[2 * u + 1], f.upper + stride * p.update[2 * u]);
      Block<T> l;
      product(l, a, inverse);
      store_block(f.lower + stride * e, l);
    }
  }
  return out;
}

template <class T>
Outcome factor_any(const Plan& p, const Terms& t, const Factors& f) {
  if (t.count == 1) return factor<1, T>(p, t, f);
  if (t.count == 2) return factor<2, T>(p, t, f);
  return factor<3, T>(p, t, f);
}

/// y -= A x (sign < 0) with two accumulators to shorten the chain of dependent operations.
template <class T>
WHIRL_INLINE void sub_multiply(T& y, const double* a, const double* x) {
  T z = zero_of<T>();
  for (int k = 0; k < 6; k += 2) {
    T a0, a1, s0, s1;
    load_col(a0, a + 8 * k);
    load_scalar(s0, x + k, lane);
    load_col(a1, a + 8 * k + 8);
    load_scalar(s1, x + k + 1, lane);
    sub_mul(y, a0, s0);
    sub_mul(z, a1, s1);
  }
  y.x = y.x + z.x;
  if constexpr (T::planes == 2) y.y = y.y + z.y;
}

WHIRL_INLINE void load_rhs(Real& y, const double* b) { y.x = load6(b); }
WHIRL_INLINE void store_rhs(double* b, const Real& y) { store6(b, y.x); }
WHIRL_INLINE void load_rhs(Cplx& y, const double* b) {
  double re[8] = {}, im[8] = {};
  for (int i = 0; i < 6; ++i) {
    re[i] = b[2 * i];
    im[i] = b[2 * i + 1];
  }
  y.x = load(re);
  y.y = load(im);
}
WHIRL_INLINE void store_rhs(double* b, const Cplx& y) {
  double re[8], im[8];
  store(re, y.x);
  store(im, y.y);
  for (int i = 0; i < 6; ++i) {
    b[2 * i] = re[i];
    b[2 * i + 1] = im[i];
  }
}
WHIRL_INLINE void store_vec(double* p, const Real& y) { store(p, y.x); }
WHIRL_INLINE void store_vec(double* p, const Cplx& y) {
  store(p, y.x);
  store(p + lane, y.y);
}
WHIRL_INLINE void load_vec(Real& y, const double* p) { y.x = load(p); }
WHIRL_INLINE void load_vec(Cplx& y, const double* p) {
  y.x = load(p);
  y.y = load(p + lane);
}

template <class T>
void solve(const Plan& p, const Factors& f, double* b) {
  constexpr long stride = plane * T::planes, width = lane * T::planes;
  for (int k = 0; k < p.n; ++k) {
    T y;
    load_rhs(y, b + 6 * T::planes * static_cast<long>(p.node[k]));
    for (int u = p.row_start[k]; u < p.row_start[k + 1]; ++u)
      sub_multiply(y, f.lower + stride * p.row_entry[u], f.vec + width * p.row_step[u]);
    store_vec(f.vec + width * k, y);
  }
  for (int k = p.n - 1; k >= 0; --k) {
    double* const v = f.vec + width * k;
    T y;
    load_vec(y, v);
    for (long e = p.entry_start[k]; e < p.entry_start[k + 1]; ++e)
      sub_multiply(y, f.upper + stride * e, f.vec + width * p.row[e]);
    store_vec(v, neg(y));
    T x = zero_of<T>();
    sub_multiply(x, f.inverse + stride * k, v);
    store_vec(v, x);
    store_rhs(b + 6 * T::planes * static_cast<long>(p.node[k]), x);
  }
}

/// Right-hand sides that fit into the registers with their sums.
#ifdef __AVX512F__
constexpr int columns_at_once = 4;
#else
constexpr int columns_at_once = 2;
#endif

/// y[r] -= A x_r of N node vectors beside one another, each as sub_multiply() does it.
template <int N, class T>
WHIRL_INLINE void sub_multiply_columns(T (&y)[N], const double* a, const double* x) {
  constexpr long width = lane * T::planes;
  T z[N];
  for (int r = 0; r < N; ++r)
    z[r] = zero_of<T>();
  for (int k = 0; k < 6; k += 2) {
    T a0, a1;
    load_col(a0, a + 8 * k);
    load_col(a1, a + 8 * k + 8);
    for (int r = 0; r < N; ++r) {
      T s0, s1;
      load_scalar(s0, x + width * r + k, lane);
      load_scalar(s1, x + width * r + k + 1, lane);
      sub_mul(y[r], a0, s0);
      sub_mul(z[r], a1, s1);
    }
  }
  for (int r = 0; r < N; ++r) {
    y[r].x = y[r].x + z[r].x;
    if constexpr (T::planes == 2) y[r].y = y[r].y + z[r].y;
  }
}

/// As solve(), of N right-hand sides: every factor is read once for all.
template <int N, class T>
void solve_columns(const Plan& p, const Factors& f, double* const* b) {
  constexpr long stride = plane * T::planes, width = lane * T::planes;
  for (int k = 0; k < p.n; ++k) {
    T y[N];
    const long at = 6 * T::planes * static_cast<long>(p.node[k]);
    for (int r = 0; r < N; ++r)
      load_rhs(y[r], b[r] + at);
    for (int u = p.row_start[k]; u < p.row_start[k + 1]; ++u)
      sub_multiply_columns<N>(y, f.lower + stride * p.row_entry[u],
                              f.vec + N * width * p.row_step[u]);
    for (int r = 0; r < N; ++r)
      store_vec(f.vec + width * (N * k + r), y[r]);
  }
  for (int k = p.n - 1; k >= 0; --k) {
    double* const v = f.vec + N * width * k;
    T y[N];
    for (int r = 0; r < N; ++r)
      load_vec(y[r], v + width * r);
    for (long e = p.entry_start[k]; e < p.entry_start[k + 1]; ++e)
      sub_multiply_columns<N>(y, f.upper + stride * e, f.vec + N * width * p.row[e]);
    for (int r = 0; r < N; ++r) {
      store_vec(v + width * r, neg(y[r]));
      y[r] = zero_of<T>();
    }
    sub_multiply_columns<N>(y, f.inverse + stride * k, v);
    const long at = 6 * T::planes * static_cast<long>(p.node[k]);
    for (int r = 0; r < N; ++r) {
      store_vec(v + width * r, y[r]);
      store_rhs(b[r] + at, y[r]);
    }
  }
}

void solve_complex_columns(const Plan& p, const Factors& f, double* const b[columns]) {
  for (int r = 0; r < columns; r += columns_at_once)
    solve_columns<columns_at_once, Cplx>(p, f, b + r);
}

void multiply_real(const Matrix6& m, const double* x, double* y) {
  for (std::ptrdiff_t i = 0; i < m.n; ++i) {
    Col even = zero_col(), odd = zero_col();
    for (std::ptrdiff_t k = m.start[i]; k < m.start[i + 1]; ++k) {
      const double* const a = m.value + 36 * k;
      const double* const v = x + 6 * m.cols[k];
      for (int c = 0; c < 6; c += 2) {
        even = even + load6(a + 6 * c) * splat(v[c]);
        odd = odd + load6(a + 6 * c + 6) * splat(v[c + 1]);
      }
    }
    store6(y + 6 * i, even + odd);
  }
}

void multiply_complex(const Matrix6& m, const double* x, double* y) {
  for (std::ptrdiff_t i = 0; i < m.n; ++i) {
    Cplx r = zero_of<Cplx>();
    for (std::ptrdiff_t k = m.start[i]; k < m.start[i + 1]; ++k) {
      const double* const a = m.value + 36 * k;
      const double* const v = x + 12 * m.cols[k];
      for (int c = 0; c < 6; ++c) {
        const Col col = load6(a + 6 * c);
        r.x = r.x + col * splat(v[2 * c]);
        r.y = r.y + col * splat(v[2 * c + 1]);
      }
    }
    store_rhs(y + 12 * i, r);
  }
}

void multiply_three(const Matrix6& m, const double* const a[3], const double* x,
                    double* const y[3]) {
  for (std::ptrdiff_t i = 0; i < m.n; ++i) {
    Cplx r0 = zero_of<Cplx>(), r1 = r0, r2 = r0;
    for (std::ptrdiff_t k = m.start[i]; k < m.start[i + 1]; ++k) {
      const double* const v = x + 12 * m.cols[k];
      for (int c = 0; c < 6; ++c) {
        const Col re = splat(v[2 * c]), im = splat(v[2 * c + 1]);
        const Col c0 = load6(a[0] + 36 * k + 6 * c), c1 = load6(a[1] + 36 * k + 6 * c),
                  c2 = load6(a[2] + 36 * k + 6 * c);
        r0.x = r0.x + c0 * re;
        r0.y = r0.y + c0 * im;
        r1.x = r1.x + c1 * re;
        r1.y = r1.y + c1 * im;
        r2.x = r2.x + c2 * re;
        r2.y = r2.y + c2 * im;
      }
    }
    store_rhs(y[0] + 12 * i, r0);
    store_rhs(y[1] + 12 * i, r1);
    store_rhs(y[2] + 12 * i, r2);
  }
}

/// (sum, rest) += a b without rounding error but in rest: T. Ogita, S. Rump and S. Oishi, doi
/// 10.1137/030601818.
WHIRL_INLINE void add_exact(Col& sum, Col& rest, Col a, Col b) {
  const Col p = opaque(a * b);  // opaque: p must be the rounded product, not part of a fused sum
  const Col s = sum + p, z = s - sum;
  rest = rest + ((sum - (s - z)) + (p - z)) + product_error(a, b, p);
  sum = s;
}

void multiply_exact_real(const Matrix6& m, const double* x, double* y) {
  for (std::ptrdiff_t i = 0; i < m.n; ++i) {
    Col sum = zero_col(), rest = sum;
    for (std::ptrdiff_t k = m.start[i]; k < m.start[i + 1]; ++k)
      for (int c = 0; c < 6; ++c)
        add_exact(sum, rest, load6(m.value + 36 * k + 6 * c), splat(x[6 * m.cols[k] + c]));
    store6(y + 6 * i, sum + rest);
  }
}

void multiply_exact_complex(const Matrix6& m, const double* x, double* y) {
  for (std::ptrdiff_t i = 0; i < m.n; ++i) {
    Cplx sum = zero_of<Cplx>(), rest = sum;
    for (std::ptrdiff_t k = m.start[i]; k < m.start[i + 1]; ++k) {
      const double* const v = x + 12 * m.cols[k];
      for (int c = 0; c < 6; ++c) {
        const Col a = load6(m.value + 36 * k + 6 * c);
        add_exact(sum.x, rest.x, a, splat(v[2 * c]));
        add_exact(sum.y, rest.y, a, splat(v[2 * c + 1]));
      }
    }
    store_rhs(y + 12 * i, Cplx{sum.x + rest.x, sum.y + rest.y});
  }
}

template <int Count>
WHIRL_INLINE void add_sum_of_products(const Matrix6& m, const double* const a[],
                                      const double* const x[], double s, double* y) {
  for (std::ptrdiff_t i = 0; i < m.n; ++i) {
    Col even = zero_col(), odd = zero_col();
    for (std::ptrdiff_t k = m.start[i]; k < m.start[i + 1]; ++k)
      for (int t = 0; t < Count; ++t) {
        const double* const b = a[t] + 36 * k;
        const double* const v = x[t] + 6 * m.cols[k];
        for (int c = 0; c < 6; c += 2) {
          even = even + load6(b + 6 * c) * splat(v[c]);
          odd = odd + load6(b + 6 * c + 6) * splat(v[c + 1]);
        }
      }
    store6(y + 6 * i, load6(y + 6 * i) + splat(s) * (even + odd));
  }
}

void add_products(const Matrix6& m, int count, const double* const a[], const double* const x[],
                  double s, double* y) {
  switch (count) {
    case 1: return add_sum_of_products<1>(m, a, x, s, y);
    case 2: return add_sum_of_products<2>(m, a, x, s, y);
    default: return add_sum_of_products<3>(m, a, x, s, y);
  }
}

void add_multiply_size(const Matrix6& m, double s, const double* x, double* y) {
  for (std::ptrdiff_t i = 0; i < m.n; ++i) {
    Col even = zero_col(), odd = zero_col();
    for (std::ptrdiff_t k = m.start[i]; k < m.start[i + 1]; ++k) {
      const double* const a = m.value + 36 * k;
      const double* const v = x + 6 * m.cols[k];
      for (int c = 0; c < 6; c += 2) {
        even = even + abs(load6(a + 6 * c)) * splat(v[c]);
        odd = odd + abs(load6(a + 6 * c + 6)) * splat(v[c + 1]);
      }
    }
    store6(y + 6 * i, load6(y + 6 * i) + splat(s) * (even + odd));
  }
}

void multiply_step(const Matrix6& m, const double* const kcm[3], const StepVectors& x) {
  const Col shift = splat(x.shift);
  for (std::ptrdiff_t i = 0; i < m.n; ++i) {
    Col of_q = zero_col(), of_v = zero_col(), rate = zero_col(), stiff = zero_col(),
        inertia = zero_col(), filter = zero_col();
    for (std::ptrdiff_t k = m.start[i]; k < m.start[i + 1]; ++k) {
      const std::ptrdiff_t j = 6 * m.cols[k];
      for (int c = 0; c < 6; ++c) {
        const Col stiffness = load6(kcm[0] + 36 * k + 6 * c);
        of_q = of_q + stiffness * splat(x.q[j + c]);
        rate = rate + stiffness * splat(x.v[j + c]);
        stiff = stiff + stiffness * splat(x.stiff_of[j + c]);
      }
      for (int c = 0; c < 6; ++c) {
        const Col damping = load6(kcm[1] + 36 * k + 6 * c), mass = load6(kcm[2] + 36 * k + 6 * c);
        of_v = of_v + damping * splat(x.v[j + c]);
        inertia = inertia + mass * splat(x.inertia_of[j + c]);
        filter = filter + (damping + shift * mass) * splat(x.filter_of[j + c]);
      }
    }
    store6(x.bound + 6 * i, of_q + of_v);
    store6(x.rate + 6 * i, rate);
    store6(x.stiff + 6 * i, stiff);
    store6(x.inertia + 6 * i, inertia);
    store6(x.filter + 6 * i, filter);
  }
}

constexpr Kernels table = {
    WHIRL_LU_ISA,      factor_any<Real>,      factor_any<Cplx>,       solve<Real>,
    solve<Cplx>,       solve_complex_columns, multiply_real,          multiply_complex,
    multiply_three,    multiply_exact_real,   multiply_exact_complex, add_products,
    add_multiply_size, multiply_step};

}  // namespace

const Kernels* WHIRL_LU_TABLE() { return &table; }

}  // namespace whirl::la::lu
