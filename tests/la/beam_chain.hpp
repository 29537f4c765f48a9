// A uniform spinning shaft along x as matrices: Euler-Bernoulli bending in two planes, stretching,
// torsion; nodal unknowns (u_x, u_y, u_z, rotations about x, y, z). The test bed of the
// eigensolvers.
#pragma once
#include <la/block.hpp>

namespace whirl::la::test {

struct Shaft {
  Index elements = 20;
  double length = 1.5, diameter = 0.05;        // m
  double E = 211e9, G = 81.2e9, rho = 7810.0;  // steel
  double area() const { return pi * diameter * diameter / 4.0; }
  double I() const { return pi * std::pow(diameter, 4) / 64.0; }
  double h() const { return length / static_cast<double>(elements); }
};

inline constexpr int bending_unknown[2][2] = {
    {1, 5}, {2, 4}};  // (displacement, slope) in the planes y and z
inline constexpr double bending_sign[2][2] = {
    {1, 1}, {1, -1}};  // slope of u_z is minus the rotation about y

/// The integral of N'N' over an element: rotary inertia per rho I, geometric stiffness per unit
/// thrust.
inline Matrix<4> slope_matrix(double h) {
  Matrix<4> m;
  m << 36, 3 * h, -36, 3 * h, 3 * h, 4 * h * h, -3 * h, -h * h, -36, -3 * h, 36, -3 * h, 3 * h,
      -h * h, -3 * h, 4 * h * h;
  return m / (30.0 * h);
}

/// M, C, K with gyroscopic couple at spin speed Omega. Free at both ends.
inline MCK shaft_matrices(const BlockPattern& p, const Shaft& s, double Omega) {
  MCK m(p);
  const double h = s.h(), EI = s.E * s.I(), ma = s.rho * s.area() * h, jt = s.rho * s.I();
  const auto put = [&](BlockMatrix<6>& a, Index e, int ni, int ci, int nj, int cj, double v) {
    a.block(p.slot(e + ni, e + nj))(ci, cj) += v;
  };
  Matrix<4> kb, mb;
  kb << 12, 6 * h, -12, 6 * h, 6 * h, 4 * h * h, -6 * h, 2 * h * h, -12, -6 * h, 12, -6 * h, 6 * h,
      2 * h * h, -6 * h, 4 * h * h;
  kb *= EI / (h * h * h);
  mb << 156, 22 * h, 54, -13 * h, 22 * h, 4 * h * h, 13 * h, -3 * h * h, 54, 13 * h, 156, -22 * h,
      -13 * h, -3 * h * h, -22 * h, 4 * h * h;
  mb *= ma / 420.0;
  const Matrix<4> mr = jt * slope_matrix(h);
  const auto& unknown = bending_unknown;
  const auto& sign = bending_sign;
  for (Index e = 0; e < s.elements; ++e) {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        for (int plane = 0; plane < 2; ++plane) {
          const double q = sign[plane][i % 2] * sign[plane][j % 2];
          const int ci = unknown[plane][i % 2], cj = unknown[plane][j % 2];
          put(m.K, e, i / 2, ci, j / 2, cj, q * kb(i, j));
          put(m.M, e, i / 2, ci, j / 2, cj, q * (mb(i, j) + mr(i, j)));
        }
        // Gyroscopic couple of the polar inertia 2 jt, with the shape functions of the slopes.
        const double g = 2.0 * Omega * mr(i, j);
        put(m.C, e, i / 2, unknown[0][i % 2], j / 2, unknown[1][j % 2],
            sign[0][i % 2] * sign[1][j % 2] * g);
        put(m.C, e, i / 2, unknown[1][i % 2], j / 2, unknown[0][j % 2],
            -sign[1][i % 2] * sign[0][j % 2] * g);
      }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        const double stiff = i == j ? 1.0 : -1.0, mass = i == j ? 1.0 / 3.0 : 1.0 / 6.0;
        put(m.K, e, i, 0, j, 0, stiff * s.E * s.area() / h);
        put(m.M, e, i, 0, j, 0, mass * ma);
        put(m.K, e, i, 3, j, 3, stiff * s.G * 2.0 * s.I() / h);
        put(m.M, e, i, 3, j, 3, mass * 2.0 * jt * h);
      }
  }
  return m;
}

/// Geometric stiffness of a unit compressive thrust, to be taken from K (here with a positive sign,
/// in K).
inline BlockMatrix<6> thrust_matrix(const BlockPattern& p, const Shaft& s) {
  BlockMatrix<6> g(p);
  const Matrix<4> k = slope_matrix(s.h());
  for (Index e = 0; e < s.elements; ++e)
    for (int plane = 0; plane < 2; ++plane)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          g.block(p.slot(e + i / 2, e + j / 2))(bending_unknown[plane][i % 2],
                                                bending_unknown[plane][j % 2]) +=
              bending_sign[plane][i % 2] * bending_sign[plane][j % 2] * k(i, j);
  return g;
}

/// A thin disk at a node.
inline void add_disk(MCK& m, Index node, double mass, double Jp, double Jt, double Omega) {
  const Index d = m.M.pattern().diagonal(node);
  for (int c = 0; c < 3; ++c)
    m.M.block(d)(c, c) += mass;
  m.M.block(d)(3, 3) += Jp;
  m.M.block(d)(4, 4) += Jt;
  m.M.block(d)(5, 5) += Jt;
  m.C.block(d)(4, 5) += Jp * Omega;
  m.C.block(d)(5, 4) -= Jp * Omega;
}

/// A bearing: stiffness and damping in y and z, cross-coupled stiffness q (K_yz = q, K_zy = -q).
inline void add_bearing(MCK& m, Index node, double ky, double kz, double cy, double cz,
                        double q = 0.0) {
  const Index d = m.K.pattern().diagonal(node);
  m.K.block(d)(1, 1) += ky;
  m.K.block(d)(2, 2) += kz;
  m.K.block(d)(1, 2) += q;
  m.K.block(d)(2, 1) -= q;
  m.C.block(d)(1, 1) += cy;
  m.C.block(d)(2, 2) += cz;
}

/// Three disks on two bearings, as in many text-book rotors; axial motion held at the first node,
/// spin free.
inline MCK rotor(const BlockPattern& p, Index elements, double Omega, double kz = 0.8e7,
                 double damping = 0.0) {
  Shaft s;
  s.elements = elements;
  MCK m = shaft_matrices(p, s, Omega);
  add_disk(m, elements / 3, 14.6, 0.1232, 0.0646, Omega);
  add_disk(m, elements / 2, 45.9, 0.976, 0.498, Omega);
  add_disk(m, elements - elements / 5, 55.1, 1.171, 0.602, Omega);
  add_bearing(m, 0, 1e7, kz, damping, damping);
  add_bearing(m, elements, 1e7, kz, damping, damping);
  m.K.block(p.diagonal(0))(0, 0) += 1e8;
  return m;
}

}  // namespace whirl::la::test
