// How the stiffness of elements grows with the stresses that a motion makes in them: for linearised
// buckling.
//
// With an energy V(s) of strains s(X) the tangent is K = sum V_ij ds_i ds_j + sum V_i d2s_i. Its
// derivative along a motion has in it the stresses, V_ij s_j' d2s_i, and how the derivatives ds
// turn as each element turns. The turning must be left out of a linearisation: it is half of a
// square, V_ij (ds_i + ds_i')(ds_j + ds_j'), whose other half is of second order; without that one
// stiff strains (shear, stretching) lose energy to every motion across them, the more the finer the
// mesh. So each element is differentiated along what is left of the motion when it does not move as
// a whole: less its translation and the rotation of its chord. That is exact; differences of
// tangents are not used.
//
// A kernel of two nodes takes part by
//   void add_stiffness_rate(const Nodes<2>& x, const Nodes<2>& rate, const Context&,
//   StiffnessRateX<W>& out) const;
// where the nodes of `rate` hold u', d', phi' in u, t, phi. It is made known once, in its .cpp, by
//   const bool known = system::know_stiffness_rate<Kernel>();
#pragma once
#include <system/system.hpp>

namespace whirl::system {

/// Force of an element in X and its stiffness, and the derivatives of both along the motion.
template <int W>
struct StiffnessRateX {
  Vector<W> f = Vector<W>::Zero(), df = Vector<W>::Zero();
  Matrix<W> K = Matrix<W>::Zero(), dK = Matrix<W>::Zero();
};

/// A state and the motion along which its stiffness is asked for.
struct StiffnessMotion {
  const System& system;
  const Workspace& workspace;  ///< node states at q
  const Frames& frames;
  const VecX& q;
  const VecX& direction;  ///< q'
};

/// Of two nodes the motion relative to that of their chord.
struct RelativeMotion {
  RelativeMotion(const StiffnessMotion& m, const std::array<Index, 2>& nodes);
  std::array<NodeState, 2> rate;  ///< u', d', phi' in u, t, phi
  std::array<Eigen::Matrix<double, 7, 6>, 2> J,
      J_rate;  ///< dX/dq and its derivative, both for small rotations of the nodes as the whole
               ///< model has them
  std::array<Vec2, 2> gamma, gamma_rate;
  std::array<Mat3, 2> chart;
};

/// f_d contracted with the curvature of the director, and the derivative of that: 2x2 in gamma.
Mat2 curvature_rate(const RelativeMotion& m, std::size_t node, const Vec3& f, const Vec3& df);

using AddStiffnessRates = void (*)(const Term& batch, const StiffnessMotion& motion, double weight,
                                   la::BlockMatrix<6>& out);

/// Kernels known to give it, by type of batch.
void know_stiffness_rate(std::type_index batch, AddStiffnessRates add);
/// nullptr: the kernel of this batch does not give it.
AddStiffnessRates find_stiffness_rate(const Term& batch);

/// out += weight K' of all kernels known, in q = (u, phi, gamma).
void add_stiffness_rate(const StiffnessMotion& motion, double weight, la::BlockMatrix<6>& out);

template <Kernel K>
void add_batch_stiffness_rate(const Term& term, const StiffnessMotion& motion, double weight,
                              la::BlockMatrix<6>& out) {
  static_assert(K::n_nodes == 2 && K::width == 7);
  const auto& batch = static_cast<const Batch<K>&>(term);
  const la::BlockPattern& pattern = motion.system.pattern();
  for (std::size_t i = 0; i < batch.count(); ++i) {
    const std::array<Index, 2>& nodes = batch.nodes()[i];
    const RelativeMotion m(motion, nodes);
    Nodes<2> x, rate;
    for (std::size_t a = 0; a < 2; ++a) {
      x[a] = &motion.workspace.nodes[static_cast<std::size_t>(nodes[a])];
      rate[a] = &m.rate[a];
    }
    StiffnessRateX<14> r;
    batch.elements()[i].add_stiffness_rate(x, rate, motion.workspace.context, r);
    for (std::size_t a = 0; a < 2; ++a) {
      const Index row = 7 * static_cast<Index>(a);
      for (std::size_t b = 0; b < 2; ++b) {
        const Index slot = pattern.slot(nodes[a], nodes[b]);
        if (slot < 0) continue;
        const Matrix<7> k = r.K.template block<7, 7>(row, 7 * static_cast<Index>(b));
        const Matrix<7> dk = r.dK.template block<7, 7>(row, 7 * static_cast<Index>(b));
        out.block(slot) +=
            weight * (m.J[a].transpose() * dk * m.J[b] + m.J_rate[a].transpose() * k * m.J[b] +
                      m.J[a].transpose() * k * m.J_rate[b]);
      }
      const Index diagonal = pattern.slot(nodes[a], nodes[a]);
      const Mat2 bend =
          curvature_rate(m, a, r.f.template segment<3>(row + 3), r.df.template segment<3>(row + 3));
      if (diagonal >= 0) out.block(diagonal).template bottomRightCorner<2, 2>() += weight * bend;
    }
  }
}

template <Kernel K>
bool know_stiffness_rate() {
  know_stiffness_rate(std::type_index(typeid(Batch<K>)), &add_batch_stiffness_rate<K>);
  return true;
}

}  // namespace whirl::system
