// Viscosity of lubricating oil against temperature.
#pragma once

namespace whirl::elements {

/// Dynamic viscosity of an ISO VG oil (ISO 3448: kinematic viscosity `grade` mm2/s at 40 C),
/// viscosity index near 100, Pa s:
///   eta = eta_x exp[(159.55657/(T + 95) - 0.181913) ln(rho grade 1e-6/eta_x)],
///       eta_x = 0.18e-3 Pa s, T in degrees Celsius
/// (Vogel form of DIN 31652-2 / DIN 31654-2). temperature: kelvin, 243 to 473 K; density: kg/m3.
/// Errors E85: grade or density not positive, temperature outside the range.
/// @throws Error (E85) when grade or density are not positive or the temperature is beyond -30 ..
/// 200 deg C.
double iso_vg_viscosity(double grade, double temperature, double density = 900.0);

/// The same oil against temperature, for kernels: NaN outside the range, nothing is thrown.
struct OilViscosity {
  double factor = 0;  ///< ln(rho grade 1e-6/eta_x)

  OilViscosity() = default;
  /// @throws Error (E85) when grade or density are not positive.
  OilViscosity(double grade, double density);
  double at(double temperature) const;  ///< Pa s, of K
  /// d ln eta/dT, 1/K.
  double slope(double temperature) const;
};

}  // namespace whirl::elements
