// Round sections of steel for tests of element matrices.
#pragma once
#include <elements/shaft/timoshenko_matrices.hpp>

namespace whirl::test {

/// Tapered, diameters and bores at both ends, m.
inline elements::ElementSection cone(double d1, double d2, double bore1 = 0, double bore2 = 0,
                                     elements::ShearRule shear = elements::ShearRule::cowper,
                                     bool rotary = true) {
  elements::ElementSection s;
  s.od1 = s.mass_od1 = d1;
  s.od2 = s.mass_od2 = d2;
  s.id1 = s.mass_id1 = bore1;
  s.id2 = s.mass_id2 = bore2;
  s.E = 2.1e11;
  s.G = 2.1e11 / 2.6;
  s.rho = 7850;
  s.shear = shear;
  s.rotary_inertia = rotary;
  return s;
}

inline elements::ElementSection cylinder(double d,
                                         elements::ShearRule shear = elements::ShearRule::cowper,
                                         bool rotary = true) {
  return cone(d, d, 0, 0, shear, rotary);
}

}  // namespace whirl::test
