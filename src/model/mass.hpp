// Masses of what the model describes, exact for the given shapes.
#pragma once
#include <model/model.hpp>

namespace whirl::model {

/// Volume of a conical tube, m3: pi l/12 (D1^2 + D1 D2 + D2^2) of the outside minus that of the
/// bore.
inline double volume(const Section& s) {
  const auto cone = [](double a, double b) { return a * a + a * b + b * b; };
  return pi / 12 * s.length * (cone(s.od_l, s.od_r) - cone(s.id_l, s.id_r));
}

/// Mass of a section, kg, with its distributed added mass.
inline double mass(const Model& m, const Section& s) {
  double per_shape = 0;
  if (s.constants)
    per_shape = s.constants->rhoA * s.length;
  else if (s.material < m.materials.size())
    per_shape = m.materials[s.material].rho * (s.general ? s.general->A * s.length : volume(s));
  return per_shape + s.added_mass_per_length * s.length;
}

/// Mass of a shaft line and the disks on it, kg.
inline double mass(const Model& m, std::size_t shaft) {
  double sum = 0;
  for (const auto& s : m.shafts[shaft].sections)
    sum += mass(m, s);
  for (const auto& d : m.disks)
    if (d.at.shaft == shaft) sum += d.mass;
  return sum;
}

}  // namespace whirl::model
