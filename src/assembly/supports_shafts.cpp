// What connects two shafts: couplings and gear pairs.
#include <assembly/support_parts.hpp>
#include <elements/between_shafts/gear_mesh.hpp>
#include <elements/between_shafts/shaft_coupling.hpp>

#include <cmath>

namespace whirl::assembly {

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::Coupling& law) {
  elements::ShaftCoupling k;
  k.K = law.K;
  k.C = law.C;
  k.offset = Vec3(0, law.offset_y, law.offset_z);
  k.angle = Vec2(std::sin(law.angle_y), std::sin(law.angle_z));
  add_joint(a, b, n, k, "couplings");
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::GearPair& law) {
  elements::GearGeometry g;
  g.z1 = law.teeth;
  g.z2 = law.other_teeth;
  g.pitch_radius = 0.5 * law.pitch_diameter;
  g.pressure_angle = law.pressure_angle;
  g.base_helix = law.helix;
  g.drive = law.drive;
  // Places of the gear centres: they say where the mesh is, and must agree with the teeth.
  const Vec3 p = a.mesh.station(b.at).position, q = a.mesh.station(*b.to).position;
  const Vec2 between = (q - p).tail<2>();
  const double distance = between.norm(),
               wanted = g.pitch_radius *
                        std::abs(1.0 + static_cast<double>(law.other_teeth) / law.teeth);
  const std::string who = name_of(b);
  // the mesh of an internal gear lies beyond the pinion
  const double from_places =
      std::atan2(between.y(), between.x()) + (law.other_teeth < 0 ? pi : 0.0);
  if (std::isnan(law.centre_angle)) {
    if (!(distance > 0)) {
      a.error("E05",
              fmt::format(
                  "{}: both shafts lie on one line, so the direction of the mesh is unknown", who),
              "give the second shaft its origin, or centre_angle = \"0 deg\"", b, who);
      return;
    }
    g.centre_angle = from_places;
  } else {
    g.centre_angle = law.centre_angle;
    constexpr double apart = pi / 180;
    if (distance > 0 && std::abs(std::remainder(g.centre_angle - from_places, two_pi)) > apart) {
      a.error("E26",
              fmt::format("{}: centre_angle is {:.5g} deg, the shafts lie at {:.5g} deg", who,
                          g.centre_angle * 180 / pi, from_places * 180 / pi),
              "leave it out: the direction follows from the origins of the shafts", b, who);
      return;
    }
  }
  if (distance > 0 && std::abs(distance - wanted) > 0.02 * wanted) {
    a.error("E26",
            fmt::format("{}: the shafts are {:.5g} mm apart, the pitch circles need {:.5g} mm", who,
                        1e3 * distance, 1e3 * wanted),
            "check pitch_diameter, the teeth and the origins of the shafts", b, who);
    return;
  }
  const auto harmonics = [](const std::vector<double>& amplitude,
                            const std::vector<double>& phase) {
    std::vector<elements::GearHarmonic> out;
    for (std::size_t i = 0; i < amplitude.size(); ++i)
      out.push_back({amplitude[i], i < phase.size() ? phase[i] : 0.0});
    return out;
  };
  const auto k = harmonics(law.stiffness_harmonics, law.stiffness_phases),
             e = harmonics(law.error_harmonics, law.error_phases);
  guarded(a, b, [&] {
    if (law.backlash >= 0)
      add_joint(
          a, b, n,
          elements::make_backlash_gear_mesh(g, law.stiffness, law.damping, law.backlash, k, e),
          "gear pairs");
    else
      add_joint(a, b, n, elements::make_gear_mesh(g, law.stiffness, law.damping, k, e),
                "gear pairs");
  });
}

}  // namespace whirl::assembly
