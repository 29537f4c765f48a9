// A part of constant matrices between one or two nodes: what reduced foundations and casings are
// assembled from.
//   f = K q + C q' + M q''
// W = 3: q = u, the translations of the nodes (a scalar node: its first component); W = 7: q = X =
// (u, d - e0, phi), into which with_rotations() carries matrices in (x, y, z, rx, ry, rz). The
// rotations are phi and e0 x d, sines of the tilts, as in linear_bearing.hpp; so the part is linear
// in X and its tangents are constant.
// Global axes, e0 = x; N/m, N s/m, kg, and N, N m/rad, .. where a rotation takes part. K and C need
// not be symmetric: the skew part of K (circulatory) exchanges energy and counts as supplied power,
// that of C (gyroscopic) has none. M is symmetric. Gravity acts through M on what moves in space
// (u'' - g at the nodes), not on internal coordinates, which is exact for reductions whose internal
// coordinates vanish in a rigid translation (Craig & Bampton, AIAA J. 6, 1968, doi 10.2514/3.4741).
#pragma once
#include <system/kernel.hpp>

namespace whirl::elements {

template <int N, int W = 3>
struct MatrixPart {
  static constexpr int n_nodes = N, width = W;
  static constexpr bool has_M = true, has_C = true, has_K = true, quadratic_in_rates = true,
                        linear_in_displacements = true;
  static constexpr system::Family family = system::Family::support;
  /// Sees the angles that its stiffness resists.
  system::Dependence depends(const system::Context&) const {
    system::Dependence d{.weight = !M.isZero(0.0)};
    if constexpr (W == 7)
      for (int i = 0; i < N; ++i) {
        if (!K.col(7 * i + 6).isZero(0.0)) d.angle = system::each_angle;
        d.spin = d.spin || !C.col(7 * i + 6).isZero(0.0);
      }
    return d;
  }
  using Part = Matrix<W * N>;

  Part K = Part::Zero(), C = Part::Zero(), M = Part::Zero();
  std::array<bool, N> internal{};  ///< the node is an internal coordinate

  void add_force(const system::Nodes<N>& x, const system::Context&,
                 system::ForceX<W * N>& f) const {
    const Motion m(x);
    f.noalias() += K * m.u + C * m.v + M * m.a;
  }
  void add_tangent(const system::Nodes<N>&, const system::Context&,
                   system::TangentX<W * N>& t) const {
    t.K += K;
    t.C += C;
    t.M += M;
  }
  void add_energy(const system::Nodes<N>& x, const system::Context& c, system::Energy& e) const {
    const Motion m(x);
    const Vector<W* N> Ku = K * m.u;
    e.elastic += 0.5 * m.u.dot(Ku);
    e.kinetic += 0.5 * m.v.dot(M * m.v);
    e.dissipated += m.v.dot(C * m.v);
    e.supplied += 0.5 * m.v.dot(K.transpose() * m.u - Ku);
    Vector<W* N> g = Vector<W * N>::Zero();
    for (int i = 0; i < N; ++i)
      if (!internal[static_cast<std::size_t>(i)]) g.template segment<3>(W * i) = c.gravity;
    e.gravity -= m.u.dot(M * g);
  }

 private:
  struct Motion {
    Vector<W * N> u, v, a;
    explicit Motion(const system::Nodes<N>& x) {
      for (int i = 0; i < N; ++i) {
        const auto& n = *x[static_cast<std::size_t>(i)];
        u.template segment<3>(W * i) = n.u;
        v.template segment<3>(W * i) = n.du;
        a.template segment<3>(W * i) = n.ddu;
        if constexpr (W == 7) {
          u.template segment<3>(W * i + 3) = n.t + (n.e() - Vec3::UnitX());
          v.template segment<3>(W * i + 3) = n.dd;
          a.template segment<3>(W * i + 3) = n.ddd;
          u[W * i + 6] = n.phi + two_pi * n.turns;
          v[W * i + 6] = n.dphi;
          a[W * i + 6] = n.ddphi;
        }
      }
    }
  };
};

/// Matrices in (x, y, z, rx, ry, rz) of N nodes as a part in X.
template <int N>
MatrixPart<N, 7> with_rotations(const Matrix<6 * N>& K, const Matrix<6 * N>& C,
                                const Matrix<6 * N>& M, const std::array<bool, N>& internal) {
  Matrix<6 * N, 7 * N> S = Matrix<6 * N, 7 * N>::Zero();  // dq/dX; e0 x d = (0, -d_z, d_y)
  for (int i = 0; i < N; ++i) {
    for (int c = 0; c < 3; ++c)
      S(6 * i + c, 7 * i + c) = 1.0;
    S(6 * i + 3, 7 * i + 6) = 1.0;
    S(6 * i + 4, 7 * i + 5) = -1.0;
    S(6 * i + 5, 7 * i + 4) = 1.0;
  }
  MatrixPart<N, 7> p;
  p.K = S.transpose() * K * S;
  p.C = S.transpose() * C * S;
  p.M = S.transpose() * M * S;
  p.internal = internal;
  return p;
}

}  // namespace whirl::elements
