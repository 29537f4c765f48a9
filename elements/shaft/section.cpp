#include <elements/shaft/section.hpp>
#include <core/contract.hpp>

namespace whirl::elements {

// Factored forms: no cancellation for thin walls.
double annulus_area(double od, double id) { return pi / 4 * (od - id) * (od + id); }
double annulus_I(double od, double id) { return annulus_J(od, id) / 2; }
double annulus_J(double od, double id) {
  WHIRL_EXPECTS(od >= id && id >= 0.0);
  return pi / 32 * (od - id) * (od + id) * (od * od + id * id);
}

double cowper_factor(double m, double nu) {
  WHIRL_EXPECTS(m >= 0.0 && m <= 1.0);
  const double m2 = m * m, p = (1 + m2) * (1 + m2);
  return 6 * (1 + nu) * p / ((7 + 6 * nu) * p + (20 + 12 * nu) * m2);
}

double hutchinson_factor(double m, double nu) {
  WHIRL_EXPECTS(m >= 0.0 && m <= 1.0);
  const double m2 = m * m, m4 = m2 * m2, p = (1 + m2) * (1 + m2);
  return 6 * (1 + nu) * (1 + nu) * p /
         (7 + 34 * m2 + 7 * m4 + nu * (12 + 48 * m2 + 12 * m4) + nu * nu * (4 + 16 * m2 + 4 * m4));
}

SectionProperties ElementSection::at(double xi) const {
  WHIRL_EXPECTS(constants || (E > 0.0 && rho >= 0.0));
  if (constants) {
    SectionProperties p = given;
    if (!(p.kGA > 0) || shear == ShearRule::rigid) p.kGA = infinity;
    if (!rotary_inertia) p.rhoI = 0;
    p.rhoA += added_mass;
    return p;
  }
  const auto mix = [xi](double a, double b) { return a + xi * (b - a); };
  const double od = mix(od1, od2), id = mix(id1, id2);
  const double mass_od = mix(mass_od1, mass_od2), mass_id = mix(mass_id1, mass_id2);
  const double A = annulus_area(od, id), J = annulus_J(od, id), nu = E / (2 * G) - 1;
  SectionProperties p;
  p.EA = E * A;
  p.EI = E * J / 2;
  p.GJ = G * J;
  switch (shear) {
    case ShearRule::cowper: p.kGA = cowper_factor(id / od, nu) * G * A; break;
    case ShearRule::hutchinson: p.kGA = hutchinson_factor(id / od, nu) * G * A; break;
    case ShearRule::given: p.kGA = kappa * G * A; break;
    case ShearRule::rigid: p.kGA = infinity; break;
  }
  p.rhoA = rho * annulus_area(mass_od, mass_id) + added_mass;
  p.rhoIp = rho * annulus_J(mass_od, mass_id);
  p.rhoI = rotary_inertia ? p.rhoIp / 2 : 0.0;
  return p;
}

bool ElementSection::uniform() const {
  return constants || (od1 == od2 && id1 == id2 && mass_od1 == mass_od2 && mass_id1 == mass_id2);
}

ElementSection ElementSection::part(double xi1, double xi2) const {
  WHIRL_EXPECTS(0.0 <= xi1 && xi1 <= xi2 && xi2 <= 1.0);
  ElementSection s = *this;
  const auto cut = [&](double a, double b, double& out1, double& out2) {
    out1 = a == b ? a : a + xi1 * (b - a);
    out2 = a == b ? a : a + xi2 * (b - a);
  };
  cut(od1, od2, s.od1, s.od2);
  cut(id1, id2, s.id1, s.id2);
  cut(mass_od1, mass_od2, s.mass_od1, s.mass_od2);
  cut(mass_id1, mass_id2, s.mass_id1, s.mass_id2);
  return s;
}

}  // namespace whirl::elements
