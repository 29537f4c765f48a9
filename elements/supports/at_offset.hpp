// A kernel acting at points off its nodes: on rigid stubs o_i along the nodes' axes.
//   u_i -> u_i + o_i (d_i - e_i), rates alike; what the kernel gives in these coordinates goes back
//       by the transposed map, which is
// constant in X: f_d += o f_u, tangents by congruence.
#pragma once
#include <system/kernel.hpp>
#include <array>

namespace whirl::elements {

/// Adds T' g T to t, with T u = u_i + o_i d_i at every node; a node has 3 or 7 coordinates in g.
template <std::size_t Nodes, int Size>
void add_at_offset(const std::array<double, Nodes>& offset, const Matrix<Size>& g,
                   Matrix<7 * static_cast<int>(Nodes)>& t);
extern template void add_at_offset(const std::array<double, 1>&, const Matrix<3>&, Matrix<7>&);
extern template void add_at_offset(const std::array<double, 1>&, const Matrix<7>&, Matrix<7>&);
extern template void add_at_offset(const std::array<double, 2>&, const Matrix<6>&, Matrix<14>&);
extern template void add_at_offset(const std::array<double, 2>&, const Matrix<14>&, Matrix<14>&);

template <class K>
struct AtOffset {
  static constexpr int n_nodes = K::n_nodes, width = 7, inner = K::width;
  static constexpr bool has_M = K::has_M, has_C = K::has_C, has_K = K::has_K;
  static constexpr system::Family family = K::family;
  system::Dependence depends(const system::Context& c) const {
    return system::dependence_of(kernel, c);
  }

  K kernel;
  std::array<double, n_nodes> offset{};  ///< o_i, m

  void add_force(const system::Nodes<n_nodes>& x, const system::Context& c,
                 system::ForceX<7 * n_nodes>& f) const {
    const Shifted s(*this, x);
    system::ForceX<inner* n_nodes> g = system::ForceX<inner * n_nodes>::Zero();
    kernel.add_force(s.nodes, c, g);
    for (int i = 0; i < n_nodes; ++i) {
      f.template segment<inner>(7 * i) += g.template segment<inner>(inner * i);
      f.template segment<3>(7 * i + 3) += arm(i) * g.template segment<3>(inner * i);
    }
  }
  void add_tangent(const system::Nodes<n_nodes>& x, const system::Context& c,
                   system::TangentX<7 * n_nodes>& t) const {
    const Shifted s(*this, x);
    system::TangentX<inner * n_nodes> g;
    g.set_zero();
    kernel.add_tangent(s.nodes, c, g);
    if constexpr (has_M) add_at_offset(offset, g.M, t.M);
    if constexpr (has_C) add_at_offset(offset, g.C, t.C);
    if constexpr (has_K) add_at_offset(offset, g.K, t.K);
  }
  void add_energy(const system::Nodes<n_nodes>& x, const system::Context& c,
                  system::Energy& e) const {
    const Shifted s(*this, x);
    kernel.add_energy(s.nodes, c, e);
  }

  /// The nodes as the kernel sees them.
  struct Shifted {
    std::array<system::NodeState, n_nodes> state;
    system::Nodes<n_nodes> nodes;
    Shifted(const AtOffset& k, const system::Nodes<n_nodes>& x) {
      for (std::size_t i = 0; i < n_nodes; ++i) {
        system::NodeState& n = state[i];
        n = *x[i];
        n.u += k.offset[i] * n.t;
        n.du += k.offset[i] * n.dd;
        n.ddu += k.offset[i] * n.ddd;
        nodes[i] = &n;
      }
    }
  };

 private:
  double arm(int node) const { return offset[static_cast<std::size_t>(node)]; }
};

}  // namespace whirl::elements
