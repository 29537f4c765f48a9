// Inertia of what moves rigidly with a node.
#pragma once
#include <core/types.hpp>

namespace whirl::system {

/// About the node, in body axes (b_1 = d, b_2, b_3). Inertias of one node add.
struct RigidInertia {
  double mass = 0.0;           ///< kg
  Vec3 moment = Vec3::Zero();  ///< mass x position of the mass centre, kg m
  Mat3 J = Mat3::Zero();       ///< kg m2
  RigidInertia& operator+=(const RigidInertia& o) {
    mass += o.mass;
    moment += o.moment;
    J += o.J;
    return *this;
  }
};

}  // namespace whirl::system
