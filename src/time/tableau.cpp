// Sources: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed. 1996, IV.5 and
// IV.8 (doi 10.1007/978-3-642-05221-7). Only nodes and the characteristic polynomials of A^-1 are
// entered, both in closed form; the rest follows in extended precision. A^-1 has the characteristic
// polynomial of the denominator of the stability function, a Pade approximant of exp:
//   Radau IIA 3:  x^3 -  9 x^2 + 36 x -  60
//   Gauss 3:      x^3 - 12 x^2 + 60 x - 120
//   Gauss 2:      x^2 -  6 x   + 12
#include <time/tableau.hpp>
#include <core/contract.hpp>

#include <cmath>
#include <vector>

namespace whirl::time {
namespace {

using Real = long double;
using Cplx = std::complex<Real>;
template <class T>
using Square = std::vector<std::vector<T>>;

Square<Real> inverse(Square<Real> m) {
  WHIRL_EXPECTS(m.empty() || m.front().size() == m.size());
  const std::size_t n = m.size();
  Square<Real> inv(n, std::vector<Real>(n, 0));
  for (std::size_t i = 0; i < n; ++i)
    inv[i][i] = 1;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t p = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::abs(m[i][k]) > std::abs(m[p][k])) p = i;
    std::swap(m[k], m[p]);
    std::swap(inv[k], inv[p]);
    const Real d = m[k][k];
    for (std::size_t j = 0; j < n; ++j) {
      m[k][j] /= d;
      inv[k][j] /= d;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const Real f = m[i][k];
      for (std::size_t j = 0; j < n; ++j) {
        m[i][j] -= f * m[k][j];
        inv[i][j] -= f * inv[k][j];
      }
    }
  }
  return inv;
}

/// A vector in the kernel of B - lambda (transposed: of its transpose), scaled so that its largest
/// entry is 1.
std::vector<Cplx> eigenvector(const Square<Real>& B, Cplx lambda, bool transposed) {
  const std::size_t n = B.size();
  auto entry = [&](std::size_t i, std::size_t j) {
    return Cplx(transposed ? B[j][i] : B[i][j]) - (i == j ? lambda : Cplx(0));
  };
  std::vector<Cplx> x(n);
  if (n == 2) {
    x = {-entry(0, 1), entry(0, 0)};
  } else {
    // cross product of the two rows whose product is largest
    Real best = -1;
    for (std::size_t r = 0; r < 3; ++r) {
      const std::size_t p = (r + 1) % 3, q = (r + 2) % 3;
      std::vector<Cplx> y(3);
      Real size = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
        y[k] = entry(p, l) * entry(q, m) - entry(p, m) * entry(q, l);
        size = std::max(size, std::abs(y[k]));
      }
      if (size > best) {
        best = size;
        x = y;
      }
    }
  }
  Cplx largest = x[0];
  for (const Cplx& e : x)
    if (std::abs(e) > std::abs(largest)) largest = e;
  for (Cplx& e : x)
    e /= largest;
  return x;
}

/// Sets what follows from the Lagrange polynomials of the nodes c: weights, values at the ends, A,
/// which is returned in extended precision.
Square<Real> set_polynomials(const std::vector<Real>& c, Tableau& t) {
  const std::size_t s = c.size();
  // columns of the inverse Vandermonde matrix
  Square<Real> vander(s, std::vector<Real>(s));
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t k = 0; k < s; ++k)
      vander[i][k] = std::pow(c[i], static_cast<int>(k));
  const auto coeff = inverse(vander);  // coeff[k][j]: power k of l_j
  Square<Real> A(s, std::vector<Real>(s));
  for (std::size_t j = 0; j < s; ++j) {
    Real b = 0, one = 0;
    for (std::size_t k = 0; k < s; ++k) {
      b += coeff[k][j] / static_cast<Real>(k + 1);
      one += coeff[k][j];
      t.poly[j][k] = static_cast<double>(coeff[k][j]);
    }
    t.b[j] = static_cast<double>(b);
    t.at_one[j] = static_cast<double>(one);
    t.at_zero[j] = static_cast<double>(coeff[0][j]);
    for (std::size_t i = 0; i < s; ++i) {
      Real a = 0;
      for (std::size_t k = 0; k < s; ++k)
        a += coeff[k][j] * std::pow(c[i], static_cast<int>(k + 1)) / static_cast<Real>(k + 1);
      A[i][j] = a;
      t.A[i][j] = static_cast<double>(a);
    }
  }
  return A;
}

/// Sets A^-1 = B and its square.
void set_inverse(const Square<Real>& B, Tableau& t) {
  const std::size_t s = B.size();
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) {
      t.Ainv[i][j] = static_cast<double>(B[i][j]);
      Real sum = 0;
      for (std::size_t k = 0; k < s; ++k)
        sum += B[i][k] * B[k][j];
      t.Ainv2[i][j] = static_cast<double>(sum);
    }
}

/// Eigenvalues of A^-1: one of the complex pair, and the real one of three stages.
struct Eigenvalues {
  Cplx complex;
  Real real = 0;
};

/// The real root of x^s + p[s-1] x^(s-1) + ... + p[0] by Newton's method, the rest from the
/// remaining quadratic x^2 + e x + f.
Eigenvalues roots(const std::vector<Real>& p) {
  const std::size_t s = p.size();
  Real e = p[1 % s], f = p[0];
  Eigenvalues out;
  if (s == 3) {
    Real root = -p[2] / 2;
    for (int it = 0; it < 100; ++it) {
      const Real value = ((root + p[2]) * root + p[1]) * root + p[0];
      const Real slope = (3 * root + 2 * p[2]) * root + p[1];
      root -= value / slope;
    }
    e = p[2] + root;
    f = -p[0] / root;
    out.real = root;
  }
  out.complex = Cplx(-e / 2, std::sqrt(f - e * e / 4));
  return out;
}

/// Vectors B x = value x and w^T B = value w^T with w^T x = 1.
struct EigenvectorPair {
  std::vector<Cplx> x, w;
  EigenvectorPair(const Square<Real>& B, Cplx value)
      : x(eigenvector(B, value, false)),
        w(eigenvector(B, value, true)) {
    Cplx product = 0;
    for (std::size_t i = 0; i < B.size(); ++i)
      product += w[i] * x[i];
    for (Cplx& y : w)
      y /= product;
  }
};

/// nodes c; characteristic polynomial x^s + p[s-1] x^(s-1) + ... + p[0] of A^-1.
Tableau make(const std::vector<Real>& c, const std::vector<Real>& p, int order, bool stiff) {
  WHIRL_EXPECTS(c.size() == p.size() && (c.size() == 2 || c.size() == 3));
  const std::size_t s = c.size();
  Tableau t;
  t.stages = static_cast<int>(s);
  t.order = order;
  t.stiffly_accurate = stiff;
  for (std::size_t i = 0; i < s; ++i)
    t.c[i] = static_cast<double>(c[i]);
  const Square<Real> A = set_polynomials(c, t);
  if (stiff) {  // exactly: the last stage is the step's end
    for (std::size_t j = 0; j < s; ++j)
      t.at_one[j] = j + 1 == s ? 1.0 : 0.0;
  }
  const Square<Real> B = inverse(A);
  set_inverse(B, t);
  const Eigenvalues lambda = roots(p);
  const EigenvectorPair of_complex(B, lambda.complex);
  t.lambda_c = Complex(lambda.complex);
  for (std::size_t i = 0; i < s; ++i) {
    t.x_c[i] = Complex(of_complex.x[i]);
    t.w_c[i] = Complex(of_complex.w[i]);
  }
  t.has_real = s == 3;
  if (t.has_real) {
    const EigenvectorPair of_real(B, Cplx(lambda.real));
    t.lambda_r = static_cast<double>(lambda.real);
    for (std::size_t i = 0; i < s; ++i) {
      t.x_r[i] = static_cast<double>(of_real.x[i].real());
      t.w_r[i] = static_cast<double>(of_real.w[i].real());
    }
  }
  t.mu = t.has_real ? t.lambda_r : std::abs(t.lambda_c);
  return t;
}

}  // namespace

Tableau::Basis Tableau::basis(double theta) const {
  WHIRL_EXPECTS(std::isfinite(theta));
  Basis out;
  for (int j = 0; j < stages; ++j) {
    double l = 0, l1 = 0, l2 = 0;
    for (int k = stages - 1; k >= 0; --k) {
      const double p = poly[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)];
      l = l * theta + p;
      l1 = l1 * theta + p / (k + 1);
      l2 = l2 * theta + p / ((k + 1) * (k + 2));
    }
    const auto u = static_cast<std::size_t>(j);
    out.l[u] = l;
    out.l1[u] = l1 * theta;
    out.l2[u] = l2 * theta * theta;
  }
  return out;
}

Tableau::Mat Tableau::extrapolation(double theta0, double r) const {
  WHIRL_EXPECTS(std::isfinite(theta0) && r > 0.0);
  // Taylor shift of each l_j to theta0, then the double integral term by term: no cancellation.
  Mat out{};
  for (std::size_t j = 0; j < static_cast<std::size_t>(stages); ++j) {
    Vec p = poly[j];
    for (int m = 0; m < stages; ++m)
      for (int k = stages - 2; k >= m; --k)
        p[static_cast<std::size_t>(k)] += theta0 * p[static_cast<std::size_t>(k + 1)];
    for (std::size_t i = 0; i < static_cast<std::size_t>(stages); ++i) {
      double sum = 0, power = c[i] * c[i];
      for (int k = 0; k < stages; ++k) {
        sum += p[static_cast<std::size_t>(k)] * power / ((k + 1) * (k + 2));
        power *= r * c[i];
      }
      out[i][j] = sum;
    }
  }
  return out;
}

const Tableau& radau5() {
  static const Tableau t = [] {
    const Real r6 = std::sqrt(Real(6));
    return make({(4 - r6) / 10, (4 + r6) / 10, 1}, {-60, 36, -9}, 5, true);
  }();
  return t;
}

const Tableau& gauss4() {
  static const Tableau t = [] {
    const Real r3 = std::sqrt(Real(3));
    return make({(3 - r3) / 6, (3 + r3) / 6}, {12, -6}, 4, false);
  }();
  return t;
}

const Tableau& gauss6() {
  static const Tableau t = [] {
    const Real r15 = std::sqrt(Real(15));
    return make({(5 - r15) / 10, Real(1) / 2, (5 + r15) / 10}, {-120, 60, -12}, 6, false);
  }();
  return t;
}

}  // namespace whirl::time
