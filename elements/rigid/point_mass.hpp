// Point mass (pedestal, lumped mass): one node, translations only. f_u = m (u'' - g). m kg.
#pragma once
#include <system/kernel.hpp>
#include <system/rigid_inertia.hpp>

namespace whirl::elements {

struct PointMass {
  static constexpr int n_nodes = 1, width = 3;
  static constexpr bool has_M = true, has_C = false, has_K = false, quadratic_in_rates = true,
                        inertial = true, powerless = true, linear_in_displacements = true;
  static constexpr system::Family family = system::Family::body;
  static constexpr system::Dependence depends{.weight = true};

  double mass = 0;

  void add_force(const system::Nodes<1>& x, const system::Context&, system::ForceX<3>& f) const {
    f += mass * x[0]->ddu;
  }
  void add_tangent(const system::Nodes<1>&, const system::Context&, system::TangentX<3>& t) const {
    t.M.diagonal().array() += mass;
  }
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const {
    e.kinetic += 0.5 * mass * x[0]->du.squaredNorm();
    e.gravity -= mass * c.gravity.dot(x[0]->u);
  }
  system::RigidInertia inertia(double) const {
    system::RigidInertia r;
    r.mass = mass;
    return r;
  }
};

}  // namespace whirl::elements
