// The one suite every element kernel passes: check_kernel(kernel, options).
//
// It works in the nodal unknowns q = (u, phi, gamma) of each node, where the equations live,
// through the node Jacobian J = dX/dq of src/system/node.hpp, and checks
//   - add_force and add_tangent add (they do not overwrite) and leave tangents declared absent
//   alone;
//   - M_q, C_q, K_q built from the kernel's tangents against eighth-order differences of f_q = J^T
//   f_X in (a, v, q);
//     absent tangents are thereby shown to be zero;
//   - power balance d(kinetic + elastic + gravity)/dt = f.X' + supplied - dissipated along smooth
//   motions on |d| = 1
//     (f.X' is the power of the forces that a motion off the solution needs);
//   - what the kernel declares to depend on (system/dependence.hpp): force and tangents stay as
//   they are when anything else changes, in motions and where means are asked for, and change with
//   what is declared at some of the states, unless `over_declared` says why not;
//   - where declared: M symmetric and not negative, K symmetric at rest, dissipation not negative,
//   and objectivity:
//     turning a motion (and gravity) as a whole turns node forces and moments with it and keeps the
//     energies.
#pragma once
#include <core/rotation.hpp>
#include <system/kernel.hpp>
#include "../core/reference.hpp"
#include <gtest/gtest.h>
#include <span>
#include <vector>

namespace whirl::test {

struct ConformanceOptions {
  // What the element claims.
  bool symmetric_K = false;  ///< conservative at rest: K_q is a Hessian
  bool symmetric_M = true;
  bool semidefinite_M = true;  ///< no direction of negative inertia
  bool objective = false;      ///< free in space; needs `position` for elements with several nodes
  bool passive = true;         ///< dissipated >= 0
  // Amplitudes of the random states: displacement m, tilt rad (below pi), phi rad, and their rates.
  double u = 0.1, tilt = 0.8, phi = 2.0;
  double du = 1.0, dtilt = 2.0, dphi = 3.0;
  double ddu = 5.0, ddtilt = 5.0, ddphi = 5.0;
  std::vector<double> q0, v0;  ///< added to the random states: 6 a node, (u, phi, gamma); empty = 0
  std::vector<Vec3> position;  ///< reference positions of the nodes, m (objectivity only)
  Mat3 chart = Mat3::Identity();  ///< columns e, e2, e3
  Vec3 gravity = Vec3(0.3, -2.0, -9.0);
  double time = 0.7;       ///< laws are evaluated from here on
  double frequency = nan;  ///< rad/s, asked about (Context::frequency)
  /// Of what the element declares: what these parameters and states do not show.
  system::Dependence over_declared{};
  std::vector<int> signals{};  ///< nodes whose rows are equations of signals: no power stands there
  double tangent_tolerance =
      1e-9;                       ///< of the largest term in the row; differences reach about 1e-12
  double power_tolerance = 1e-9;  ///< of the largest power; as above
  int samples = 6;
  unsigned seed = 1;
};

/// Motions of a journal in a film of clearance c (m) at a spin (rad/s): displacements and velocities of
/// `share` of the clearance, since higher derivatives jump where films reach grooves.
inline ConformanceOptions film_options(double c, double spin, double share = 1e-2) {
  ConformanceOptions o;
  o.u = share * c;
  o.du = share * c * spin;
  o.ddu = c * spin * spin;
  o.tilt = 0.2;
  o.dtilt = 1e-2;
  o.ddtilt = 10;
  o.dphi = 0.3;
  o.ddphi = 300;
  o.tangent_tolerance = 1e-8;
  o.power_tolerance = 1e-8;
  return o;
}

/// Kinematics of a node in a chart (which outlives it) from q = (u, phi, gamma) and its rates.
void place(system::NodeState& n, rotation::Director& o, const Vector<6>& q, const Vector<6>& v,
           const Vector<6>& a, const Mat3& chart);

/// The kinematics of N nodes at (q, v, a), and the map from X to q.
template <int N, int W>
struct NodeFrame {
  std::array<system::NodeState, N> state;
  std::array<rotation::Director, N> director;
  Matrix<N * W, 6 *N> J = Matrix<N * W, 6 * N>::Zero(), J1 = J,
                      J2 = J;  ///< dX/dq, d(X')/dq, d(X'')/dq

  template <class Q>
  NodeFrame(const Q& q, const Q& v, const Q& a, const Mat3& chart, const Vec3& gravity) {
    for (int i = 0; i < N; ++i) {
      auto& n = state[static_cast<std::size_t>(i)];
      auto& o = director[static_cast<std::size_t>(i)];
      place(n, o, q.template segment<6>(6 * i), v.template segment<6>(6 * i),
            a.template segment<6>(6 * i), chart);
      n.ddu -= gravity;
      J.template block<3, 3>(W * i, 6 * i).setIdentity();
      if constexpr (W == 7) {
        J.template block<3, 2>(W * i + 3, 6 * i + 4) = chart * o.D;
        J1.template block<3, 2>(W * i + 3, 6 * i + 4) = chart * o.D_rate;
        J2.template block<3, 2>(W * i + 3, 6 * i + 4) = chart * o.D_accel;
        J(W * i + 6, 6 * i + 3) = 1.0;
      }
    }
  }
  system::Nodes<N> nodes() const {
    system::Nodes<N> x;
    for (std::size_t i = 0; i < N; ++i)
      x[i] = &state[i];
    return x;
  }
  Vector<N * W> rates() const {
    Vector<N * W> r;
    for (int i = 0; i < N; ++i) {
      const auto& n = state[static_cast<std::size_t>(i)];
      r.template segment<3>(W * i) = n.du;
      if constexpr (W == 7) {
        r.template segment<3>(W * i + 3) = n.dd;
        r[W * i + 6] = n.dphi;
      }
    }
    return r;
  }
};

/// A kernel of any number of nodes and width, so that the suite is compiled once for all of them.
class AnyKernel {
 public:
  struct Tangents {
    MatX M, C, K;
  };
  AnyKernel(int nodes_, int width_, bool has_M_, bool has_C_, bool has_K_)
      : nodes(nodes_),
        width(width_),
        has_M(has_M_),
        has_C(has_C_),
        has_K(has_K_) {}
  virtual ~AnyKernel() = default;
  /// f, t: nodes * width rows; t square.
  virtual void add_force(std::span<const system::NodeState> x, const system::Context& c,
                         VecX& f) const = 0;
  virtual void add_tangent(std::span<const system::NodeState> x, const system::Context& c,
                           Tangents& t) const = 0;
  virtual void add_energy(std::span<const system::NodeState> x, const system::Context& c,
                          system::Energy& e) const = 0;
  virtual system::Dependence depends(const system::Context& c) const = 0;

  const int nodes, width;
  const bool has_M, has_C, has_K;
};

/// The kernel K as one of any size.
template <system::Kernel K>
class KernelOf final : public AnyKernel {
 public:
  explicit KernelOf(const K& k)
      : AnyKernel(K::n_nodes, K::width, K::has_M, K::has_C, K::has_K),
        k_(k) {}
  void add_force(std::span<const system::NodeState> x, const system::Context& c,
                 VecX& f) const override {
    system::ForceX<size> g = Eigen::Map<const Vector<size>>(f.data());
    k_.add_force(all(x), c, g);
    f = g;
  }
  void add_tangent(std::span<const system::NodeState> x, const system::Context& c,
                   Tangents& t) const override {
    system::TangentX<size> s;
    s.M = Eigen::Map<const Matrix<size>>(t.M.data());
    s.C = Eigen::Map<const Matrix<size>>(t.C.data());
    s.K = Eigen::Map<const Matrix<size>>(t.K.data());
    k_.add_tangent(all(x), c, s);
    t.M = s.M;
    t.C = s.C;
    t.K = s.K;
  }
  void add_energy(std::span<const system::NodeState> x, const system::Context& c,
                  system::Energy& e) const override {
    k_.add_energy(all(x), c, e);
  }
  system::Dependence depends(const system::Context& c) const override {
    return system::dependence_of(k_, c);
  }

 private:
  static constexpr int size = K::n_nodes * K::width;
  static system::Nodes<K::n_nodes> all(std::span<const system::NodeState> x) {
    system::Nodes<K::n_nodes> out;
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = &x[i];
    return out;
  }
  const K& k_;
};

/// The suite (conformance.cpp).
void check_conformance(const AnyKernel& kernel, const ConformanceOptions& options);

template <system::Kernel K>
void check_kernel(const K& kernel, const ConformanceOptions& options = {}) {
  check_conformance(KernelOf<K>(kernel), options);
}

/// A chart that is not aligned with the global axes: options.chart = tilted_chart().
inline Mat3 tilted_chart() { return rotation::L(Vec3(0.4, -0.7, 0.5)); }

}  // namespace whirl::test
