#include <model/full_section.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace whirl::model {

FullSection full_section(const Model& m, const Section& s) {
  FullSection out;
  if (s.full) {
    out = {s.full->stiffness, s.full->mass};
  } else {
    const Section::General& g = *s.general;
    const Material& x = m.materials.at(s.material);
    // the stiffness of a section that does not shear, as nearly as numbers of a matrix can tell
    const double GA = (s.shear == ShearFactor::none ? 1e6 : 1.0) * x.G * g.A;
    out.stiffness = offset_stiffness(x.E * g.A, g.kappa_y * GA, g.kappa_z * GA, x.G * g.J,
                                     x.E * g.Iy, x.E * g.Iz, g.centroid, g.shear_centre);
    out.mass =
        offset_mass(x.rho * g.A, g.centroid, x.rho * (g.Iy + g.Iz), x.rho * g.Iy, x.rho * g.Iz, 0);
  }
  if (!s.rotary_inertia) out.mass = without_rotary_inertia(out.mass);
  if (s.mean_rotary_inertia) out.mass = with_mean_rotary_inertia(out.mass);
  if (s.added_mass_per_length > 0)  // on the line
    out.mass += offset_mass(s.added_mass_per_length, Vec2::Zero(), 0, 0, 0, 0);
  return out;
}

Section::Constants round_constants(const Section::Full& f) {
  const Matrix<6> S = f.stiffness.llt().solve(Matrix<6>::Identity());
  const SectionMoments mass(f.mass);
  Section::Constants c;
  c.EA = 1 / S(0, 0);
  c.kGA = 1 / std::max(S(1, 1), S(2, 2));
  c.GJ = 1 / S(3, 3);
  c.EI = 1 / std::max(S(4, 4), S(5, 5));
  c.rhoA = mass.m;
  c.rhoI = std::max(0.0, 0.5 * (mass.second(1, 1) + mass.second(2, 2)));
  c.rhoIp = mass.J(0, 0);
  return c;
}

bool is_unequal(const Section& s, double share) {
  const auto differ = [share](double a, double b) {
    return std::abs(a - b) > share * std::max(std::abs(a), std::abs(b));
  };
  if (s.general) return differ(s.general->Iy, s.general->Iz) || !s.general->on_line();
  if (!s.full) return false;
  return !is_axisymmetric(s.full->stiffness, share) ||
         SectionMoments(s.full->mass).centre.norm() > 0;
}

bool has_unequal_inertia(const Section& s, double share) {
  if (!s.full || !s.rotary_inertia || s.mean_rotary_inertia) return false;
  return !is_axisymmetric(s.full->mass, share);
}

}  // namespace whirl::model
