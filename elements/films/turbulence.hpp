// What turbulence adds to the resistance of a film, linearised about Couette flow.
//
// At the local Reynolds number Re = rho U h/eta
//   pressure flow along the motion  h^3/(k_x eta),  k_x = 12 + 0.0136 Re^0.90
//   pressure flow across it         h^3/(k_z eta),  k_z = 12 + 0.0043 Re^0.96
//   shear of the moving surface     eta U/h (1 + 0.0012 Re^0.94)
// V. N. Constantinescu's form of the factors of C.-W. Ng and C. H. T. Pan, J. Basic Eng. 87 (1965),
// doi 10.1115/1.3650640; Szeri 2011, doi 10.1017/CBO9780511782022, ch. 7. The factors f_x = k_x/12,
// f_z = k_z/12, f_s hold down to laminar flow, which they reach at Re = 0 (2 % too much resistance
// at Re = 30, 29 % at 500, where a film of a plain journal may still be laminar: it is turbulent
// beyond about 1000 to 2000). Powers of Re are taken as (Re^2 + 0.01)^(p/2) - 0.01^(p/2), which is
// smooth at rest and less than 0.13 smaller than Re^p.
#pragma once
#include <core/dual.hpp>
#include <cmath>

namespace whirl::elements {

template <class T>
struct TurbulentFactors {
  T along, across, shear;  ///< f_x, f_z, f_s: 1 where the flow is laminar

  explicit TurbulentFactors(const T& reynolds) {
    constexpr double least = 0.01;
    const T square = reynolds * reynolds + T(least);
    const double log_square = std::log(value(square)), log_least = std::log(least);
    const auto part = [&](double factor, double power) {
      const double half = 0.5 * power, now = std::exp(half * log_square);
      return T(1.0) +
             factor * chain(square, now - std::exp(half * log_least), half * now / value(square));
    };
    along = part(0.0136 / 12.0, 0.90);
    across = part(0.0043 / 12.0, 0.96);
    shear = part(0.0012, 0.94);
  }
};

}  // namespace whirl::elements
