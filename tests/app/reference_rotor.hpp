// A rotor of textbook Timoshenko elements in dense matrices, to hold results of examples against:
// two unknowns a node in each plane, displacement and slope, consistent mass integrated from the
// exact static shape functions, no large displacements, nothing shared with the program. SI units.
// y: (v, v'), z: (w, w'). Gyroscopic moments of a slope p = v' + i w': Id p'' - i Ip Omega p'.
#pragma once
#include <Eigen/Dense>

#include <cmath>
#include <complex>
#include <vector>

namespace whirl::test {

struct ReferenceRotor {
  using Matrix = Eigen::MatrixXd;
  static constexpr double E = 210e9, nu = 0.3, rho = 7850, pi = 3.14159265358979323846;  // "steel"
  Matrix M, C, K, G;      ///< one plane for a rotor that is the same in both: 2 unknowns a node; G:
                          ///< polar inertia on the slopes
  std::vector<double> x;  ///< of the nodes, m
  explicit ReferenceRotor(double start = 0) { node(start); }

  int node(double at) {
    x.push_back(at);
    const Eigen::Index n = 2 * static_cast<Eigen::Index>(x.size());
    for (Matrix* m : {&M, &C, &K, &G}) {
      Matrix old = *m;
      *m = Matrix::Zero(n, n);
      m->topLeftCorner(old.rows(), old.cols()) = old;
    }
    return static_cast<int>(x.size()) - 1;
  }
  /// A cylinder of n elements from the last node on; beta: stiffness-proportional damping that does
  /// not turn, s; ends at the node returned.
  int tube(double length, double od, double id, int n, bool spins, double beta = 0) {
    const double A = pi / 4 * (od * od - id * id),
                 I = pi / 64 * (std::pow(od, 4) - std::pow(id, 4)), Gs = E / (2 * (1 + nu));
    const double m = id / od, m2 = m * m, p = (1 + m2) * (1 + m2),
                 kappa = 6 * (1 + nu) * p / ((7 + 6 * nu) * p + (20 + 12 * nu) * m2);  // Cowper
    const double l = length / n, Phi = 12 * E * I / (kappa * Gs * A * l * l), f = 1 / (1 + Phi);
    Eigen::Matrix4d k, mass = Eigen::Matrix4d::Zero(), gyro = mass;
    k << 12, 6 * l, -12, 6 * l, 6 * l, (4 + Phi) * l * l, -6 * l, (2 - Phi) * l * l, -12, -6 * l,
        12, -6 * l, 6 * l, (2 - Phi) * l * l, -6 * l, (4 + Phi) * l * l;
    k *= E * I * f / (l * l * l);
    const double at[] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                         0.9305681557970262},
                 weight[] = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                             0.17392742256872692};
    for (int g = 0; g < 4; ++g) {  // Gauss: exact for the sixth degree
      const double s = at[g];
      const Eigen::Vector4d N(f * (1 - 3 * s * s + 2 * s * s * s + Phi * (1 - s)),
                              f * l * (s - 2 * s * s + s * s * s + 0.5 * Phi * (s - s * s)),
                              f * (3 * s * s - 2 * s * s * s + Phi * s),
                              f * l * (-s * s + s * s * s - 0.5 * Phi * (s - s * s)));
      const Eigen::Vector4d T(f * 6 * (s * s - s) / l, f * (1 - 4 * s + 3 * s * s + Phi * (1 - s)),
                              -f * 6 * (s * s - s) / l, f * (-2 * s + 3 * s * s + Phi * s));
      mass += weight[g] * l * rho * (A * N * N.transpose() + I * T * T.transpose());
      if (spins) gyro += weight[g] * l * rho * 2 * I * T * T.transpose();
    }
    for (int e = 0; e < n; ++e) {
      const int j = 2 * node(x.back() + l);
      M.block<4, 4>(j - 2, j - 2) += mass;
      G.block<4, 4>(j - 2, j - 2) += gyro;
      K.block<4, 4>(j - 2, j - 2) += k;
      C.block<4, 4>(j - 2, j - 2) += beta * k;
    }
    return static_cast<int>(x.size()) - 1;
  }
  void disk(int at, double mass, double Ip, double Id) {
    M(2 * at, 2 * at) += mass;
    M(2 * at + 1, 2 * at + 1) += Id;
    G(2 * at + 1, 2 * at + 1) += Ip;
  }
};

/// Eigenvalues of (M l^2 + C l + K) x = 0.
inline Eigen::VectorXcd eigenvalues(const Eigen::MatrixXcd& M, const Eigen::MatrixXcd& C,
                                    const Eigen::MatrixXcd& K) {
  const Eigen::Index n = M.rows();
  Eigen::MatrixXcd A = Eigen::MatrixXcd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  const Eigen::PartialPivLU<Eigen::MatrixXcd> lu(M);
  // Time in units of the highest frequency: without it the entries of M^-1 K, 1e14 beside 1, leave
  // the damping of low modes three digits.
  const Eigen::MatrixXcd stiffness = lu.solve(K);
  const double scale = std::sqrt(stiffness.norm());
  A.bottomLeftCorner(n, n) = -stiffness / (scale * scale);
  A.bottomRightCorner(n, n) = -lu.solve(C) / scale;
  return scale * Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(A, false).eigenvalues();
}

inline std::complex<double> nearest(const Eigen::VectorXcd& all, std::complex<double> to) {
  Eigen::Index best = 0;
  for (Eigen::Index k = 1; k < all.size(); ++k)
    if (std::abs(all[k] - to) < std::abs(all[best] - to)) best = k;
  return all[best];
}

}  // namespace whirl::test
