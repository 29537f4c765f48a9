// Numeric part of the block-sparse LU, compiled once per instruction set and chosen at run time.
//
// Left-looking: step k forms the blocks of its node from M, C and K, subtracts the products of
// earlier factors, inverts the 6x6 diagonal block D_k and stores D_k^-1, U_ki and L_ik = A_ik
// D_k^-1 for every later neighbour i:
//   D_k   = S_kk - sum_j L_kj U_jk,   U_ki = S_ki - sum_j L_kj U_ji,
//       L_ik = (S_ik - sum_j L_ij U_jk) D_k^-1.
// Pivoting stays inside a diagonal block. The usual case, diagonal pivots, is tested as it runs
// (threshold pivoting, as in KLU); a block that fails is inverted again with complete pivoting.
//
// Only plain data crosses this interface, so that no inline function shared with other code is ever
// compiled for an instruction set the machine may lack.
#pragma once
#include <cstddef>

namespace whirl::la::lu {

/// Padded column-major 6x6 block: columns of 8 doubles. A complex block is a real plane followed by
/// an imaginary one.
inline constexpr int plane = 48;
/// Padded vector of one node: 8 doubles a plane.
inline constexpr int lane = 8;
/// Right-hand sides that are solved for at once.
inline constexpr int columns = 4;

/// The symbolic factorisation: one step per node in elimination order. Entry e stands for the pair
/// of factors (L_ik, U_ki) of step k and a later step i = row[e].
struct Plan {
  int n = 0;
  const int* node = nullptr;         ///< [n] node eliminated at step k
  const int* diag_slot = nullptr;    ///< [n] its diagonal block in the pattern
  const int* entry_start = nullptr;  ///< [n+1] entries of step k
  const int* row = nullptr;          ///< [entries] later step i
  const int* lower_slot = nullptr;   ///< [entries] slot of (i,k) in the pattern, -1: fill
  const int* upper_slot = nullptr;   ///< [entries] slot of (k,i), -1: fill
  const int* row_start =
      nullptr;  ///< [n+1] entries e with row[e] == k, i.e. the factors L_kj of earlier steps
  const int* row_entry = nullptr;  ///< their e
  const int* row_step = nullptr;   ///< and their j
  const int* update_start =
      nullptr;  ///< [entries+1] pairs of entries (a,b): L_ik gets -L_b U_a, U_ki gets -L_a U_b
  const int* update = nullptr;             ///< 2 ints a pair
  const unsigned char* partial = nullptr;  ///< [n] 1 when some unknown of the node is held
  const long long* mask =
      nullptr;  ///< [8 n] per step: all bits set for an active unknown, 0 for a held one
};

/// S = sum of terms: up to three matrices with their coefficients (imaginary part unused in real
/// factorisations).
struct Terms {
  int count = 0;
  const double* value[3] = {};
  double re[3] = {}, im[3] = {};
};

struct Factors {
  double* inverse = nullptr;  ///< [n] D_k^-1
  double* lower = nullptr;    ///< [entries] L
  double* upper = nullptr;    ///< [entries] U
  double* vec = nullptr;      ///< [n] node vectors of a solve, [n][columns] of one of several
  double singular_tolerance =
      0.0;  ///< a pivot below this fraction of its row's size counts as zero
};

struct Outcome {
  int step = -1;        ///< step whose pivot vanished, -1: none
  int component = -1;   ///< its unknown within the node
  double growth = 1.0;  ///< largest ratio of a diagonal block's row after elimination to the same
                        ///< row before, where it exceeded 1e3
  int repivoted = 0;    ///< blocks that needed complete pivoting
};

/// A matrix on the rows and columns of a block pattern (BlockPattern's arrays): unpadded 6x6
/// blocks, column-major.
struct Matrix6 {
  std::ptrdiff_t n = 0;
  const std::ptrdiff_t* start = nullptr;
  const std::ptrdiff_t* cols = nullptr;
  const double* value = nullptr;
};

/// Of one pass over K, C and M on one pattern (StepProducts in multiply.hpp).
struct StepVectors {
  const double *q, *v, *stiff_of, *inertia_of, *filter_of;
  double shift;
  double *bound, *rate, *stiff, *inertia, *filter;
};

struct Kernels {
  const char* isa;
  Outcome (*factor_real)(const Plan&, const Terms&, const Factors&);
  Outcome (*factor_complex)(const Plan&, const Terms&, const Factors&);
  void (*solve_real)(const Plan&, const Factors&, double* b);
  void (*solve_complex)(const Plan&, const Factors&, double* b);  ///< b interleaved (re, im)
  /// The same of several right-hand sides at once, bit for bit what solve_complex makes of each.
  void (*solve_complex_columns)(const Plan&, const Factors&, double* const b[columns]);
  void (*multiply_real)(const Matrix6&, const double* x, double* y);  ///< y = A x
  void (*multiply_complex)(const Matrix6&, const double* x,
                           double* y);  ///< the same, x and y interleaved
  /// y[t] = A_t x for three matrices on one pattern (value of Matrix6 unused), all interleaved.
  void (*multiply_three)(const Matrix6&, const double* const a[3], const double* x,
                         double* const y[3]);
  /// y = A x with sums in twice the working precision; complex interleaved.
  void (*multiply_exact_real)(const Matrix6&, const double* x, double* y);
  void (*multiply_exact_complex)(const Matrix6&, const double* x, double* y);
  /// y += s (A_0 x_0 + .. ) with `count` matrices on one pattern (value of Matrix6 unused).
  void (*add_products)(const Matrix6&, int count, const double* const a[], const double* const x[],
                       double s, double* y);
  void (*add_multiply_size)(const Matrix6&, double s, const double* x,
                            double* y);  ///< y += s |A| x
  /// What StepProducts says, of K, C, M (value of Matrix6 unused).
  void (*multiply_step)(const Matrix6&, const double* const kcm[3], const StepVectors&);
};

/// The best set for the machine the program runs on.
const Kernels& kernels();

const Kernels* base_kernels();
const Kernels* avx2_kernels();    ///< nullptr where not compiled in
const Kernels* avx512_kernels();  ///< nullptr where not compiled in

}  // namespace whirl::la::lu
