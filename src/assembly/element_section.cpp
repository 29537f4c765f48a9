#include <assembly/element_section.hpp>
#include <core/contract.hpp>

namespace whirl::assembly {

elements::ElementSection element_section(const model::Model& m, const meshes::Element& e) {
  WHIRL_EXPECTS(0.0 <= e.xi1 && e.xi1 < e.xi2 && e.xi2 <= 1.0);
  const model::Section& s = m.shafts.at(static_cast<std::size_t>(e.line)).sections.at(e.section);
  elements::ElementSection out;
  if (!m.materials.empty()) {
    const model::Material& material = m.materials.at(s.material);
    out.E = material.E;
    out.G = material.G;
    out.rho = material.rho;
  }
  out.mass_od1 = s.od_l;
  out.mass_id1 = s.id_l;
  out.mass_od2 = s.od_r;
  out.mass_id2 = s.id_r;
  out.od1 = s.od_l;
  out.id1 = s.id_l;
  out.od2 = s.od_r;
  out.id2 = s.id_r;
  if (s.stiffness_diameters) {
    const auto& d = *s.stiffness_diameters;
    out.od1 = d[0];
    out.id1 = d[1];
    out.od2 = d[2];
    out.id2 = d[3];
  }
  switch (s.shear) {
    case model::ShearFactor::cowper: out.shear = elements::ShearRule::cowper; break;
    case model::ShearFactor::hutchinson: out.shear = elements::ShearRule::hutchinson; break;
    case model::ShearFactor::none: out.shear = elements::ShearRule::rigid; break;
    case model::ShearFactor::given: out.shear = elements::ShearRule::given; break;
  }
  out.kappa = s.kappa;
  out.rotary_inertia = s.rotary_inertia;
  out.added_mass = s.added_mass_per_length;
  if (s.constants) {
    const auto& c = *s.constants;
    out.constants = true;
    out.given = {c.EA, c.kGA, c.GJ, c.EI, c.rhoA, c.rhoI, c.rhoIp};
    return out;
  }
  return out.part(e.xi1, e.xi2);
}

elements::ShaftElementConstants element_constants(const model::Model& m, const meshes::Element& e,
                                                  const elements::MassShare& share) {
  return elements::make_shaft_constants(element_section(m, e), e.s2 - e.s1, e.left.offset,
                                        e.right.offset, mass_kind(m), share);
}

elements::MassKind mass_kind(const model::Model& m) {
  return m.consistent_mass ? elements::MassKind::consistent : elements::MassKind::corrected;
}

}  // namespace whirl::assembly
