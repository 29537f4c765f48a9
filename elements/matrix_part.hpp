// A part of constant symmetric matrices between one or two nodes: what reduced foundations and casings are assembled from.
//   f = K u + C u' + M u''  on the translations u of the nodes (a scalar node: its first component)
// Global axes, N/m, N s/m, kg. Gravity acts through M on what moves in space (u'' - g at the nodes), not on internal coordinates, which is
// exact for reductions whose internal coordinates vanish in a rigid translation (Craig & Bampton, AIAA J. 6, 1968, doi 10.2514/3.4741).
#pragma once
#include <system/kernel.hpp>

namespace whirl::elements {

template <int N>
struct MatrixPart {
  static constexpr int n_nodes = N, width = 3;
  static constexpr bool has_M = true, has_C = true, has_K = true, quadratic_in_rates = true;
  using Part = Matrix<3 * N>;

  Part K = Part::Zero(), C = Part::Zero(), M = Part::Zero();
  std::array<bool, N> internal{};   ///< the node is an internal coordinate

  void add_force(const system::Nodes<N>& x, const system::Context&, system::ForceX<3 * N>& f) const {
    const Motion m(x);
    f.noalias() += K * m.u + C * m.v + M * m.a;
  }
  void add_tangent(const system::Nodes<N>&, const system::Context&, system::TangentX<3 * N>& t) const { t.K += K, t.C += C, t.M += M; }
  void add_energy(const system::Nodes<N>& x, const system::Context& c, system::Energy& e) const {
    const Motion m(x);
    e.elastic += 0.5 * m.u.dot(K * m.u);
    e.kinetic += 0.5 * m.v.dot(M * m.v);
    e.dissipated += m.v.dot(C * m.v);
    Vector<3 * N> g = Vector<3 * N>::Zero();
    for (int i = 0; i < N; ++i)
      if (!internal[static_cast<std::size_t>(i)]) g.template segment<3>(3 * i) = c.gravity;
    e.gravity -= m.u.dot(M * g);
  }

 private:
  struct Motion {
    Vector<3 * N> u, v, a;
    explicit Motion(const system::Nodes<N>& x) {
      for (int i = 0; i < N; ++i) {
        const auto& n = *x[static_cast<std::size_t>(i)];
        u.template segment<3>(3 * i) = n.u, v.template segment<3>(3 * i) = n.du, a.template segment<3>(3 * i) = n.ddu;
      }
    }
  };
};

}  // namespace whirl::elements
