// What connects two shafts: couplings and gear pairs.
#include <core/units.hpp>
#include <deck/keys/bearing_kinds.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace whirl::deck {

void describe(Visitor& v, model::Coupling& b) {
  describe_entries(v, b.K, 'k');
  describe_entries(v, b.C, 'c');
  const bool K =
      v.matrix(optional("K", "the entries"), b.K, "N/m", "N/rad", "N.m/rad",
               "full stiffness in the order x, y, z, rx, ry, rz, instead of the entries");
  const bool C =
      v.matrix(optional("C", "the entries"), b.C, "N.s/m", "N.s/rad", "N.m.s/rad", "full damping");
  v.quantity("offset_y", b.offset_y, "mm", any,
             "parallel misalignment: hub of this shaft against the other hub, along y");
  v.quantity("offset_z", b.offset_z, "mm", any, "the same along z");
  v.quantity("angle_y", b.angle_y, "deg", between(-0.5, 0.5),
             "angular misalignment: slope of this hub's axis against the other's, towards y");
  v.quantity("angle_z", b.angle_z, "deg", between(-0.5, 0.5), "the same towards z");
  if (!v.clean()) return;
  for (const auto& [matrix, letter] : {std::pair(K, 'k'), std::pair(C, 'c')})
    if (matrix && !only_matrix(v, letter)) return;
  if (b.K.isZero(0))
    v.error("E05", nullptr, "the coupling has no stiffness",
            "give kyy, kzz, krr (tilting), krxx (torsion) and kxx");
  else if ((b.K - b.K.transpose()).cwiseAbs().maxCoeff() > 1e-12 * b.K.cwiseAbs().maxCoeff() ||
           (b.C - b.C.transpose()).cwiseAbs().maxCoeff() > 1e-12 * b.C.cwiseAbs().maxCoeff())
    v.error("E26", K ? "K" : nullptr, "the matrices of a coupling are symmetric",
            "cross-coupled terms belong to a bearing of type \"linear\"");
}

void describe(Visitor& v, model::GearPair& b) {
  v.integer(required("teeth"), b.teeth, at_least(4), "teeth of the gear on this shaft");
  v.integer(required("other_teeth"), b.other_teeth, any,
            "teeth of the gear on the other shaft; negative: an internal gear");
  v.quantity(required("pitch_diameter"), b.pitch_diameter, "mm", positive,
             "of the gear on this shaft");
  v.quantity("pressure_angle", b.pressure_angle, "deg", Range{0, 45 * pi / 180, true, true},
             "in the transverse plane");
  v.quantity("helix", b.helix, "deg", Range{-60 * pi / 180, 60 * pi / 180, true, true},
             "base helix angle, right-hand on this gear positive; 0: spur gears");
  v.quantity(optional("centre_angle", "from the places of the shafts"), b.centre_angle, "deg", any,
             "direction from this gear's centre to the mesh, from y towards z");
  int side = b.drive > 0 ? 0 : 1;
  static constexpr Option sides[] = {{"positive", "a positive torque of this gear drives"},
                                     {"negative", "a negative torque drives"}};
  v.option("drive", side, sides,
           "flanks in contact: sense of the torque that this gear puts on the mesh");
  b.drive = side == 0 ? 1 : -1;
  v.quantity(required("stiffness"), b.stiffness, "N/m", positive,
             "mean mesh stiffness along the line of action, whole face width");
  const bool play =
      v.quantity(optional("backlash", "none: the flanks always touch"), b.backlash, "um",
                 not_negative, "along the line of action; flanks then separate");
  const bool damping = v.quantity(optional("damping", "0"), b.damping, "N.s/m", not_negative,
                                  "along the line of action, without backlash");
  const bool restitution =
      v.quantity(optional("contact_damping", "0"), b.damping, "s/m", not_negative,
                 "with backlash: normal force k delta (1 + contact_damping delta'), never pulling");
  v.quantities(optional("stiffness_harmonics", "none"), b.stiffness_harmonics, "", not_negative, -1,
               "amplitudes of the tooth-mesh harmonics of the stiffness over its mean, 5 at most");
  v.quantities(optional("stiffness_phases", "0"), b.stiffness_phases, "deg", any, -1,
               "their phases");
  v.quantities(
      optional("error_harmonics", "none"), b.error_harmonics, "um", not_negative, -1,
      "amplitudes of the harmonics of the transmission error along the line of action, 5 at most");
  v.quantities(optional("error_phases", "0"), b.error_phases, "deg", any, -1, "their phases");
  if (!v.clean()) return;
  if (b.other_teeth == 0 || (b.other_teeth > 0 && b.other_teeth < 4))
    v.error("E14", "other_teeth", "the other gear needs at least 4 teeth",
            "negative for an internal gear");
  else if (b.other_teeth < 0 && -b.other_teeth <= b.teeth)
    v.error("E14", "other_teeth", "an internal gear has more teeth than the pinion inside it");
  if (play && damping)
    v.error("E26", "damping", "with backlash the damping is 'contact_damping', in s/m");
  if (!play && restitution)
    v.error("E26", "contact_damping", "without backlash the damping is 'damping', in N.s/m");
  for (const auto& [amplitudes, phases, key] :
       {std::tuple{&b.stiffness_harmonics, &b.stiffness_phases, "stiffness_phases"},
        std::tuple{&b.error_harmonics, &b.error_phases, "error_phases"}}) {
    if (amplitudes->size() > 5)
      v.error("E20",
              std::string_view(key).starts_with("s") ? "stiffness_harmonics" : "error_harmonics",
              "at most 5 harmonics");
    if (!phases->empty() && phases->size() != amplitudes->size())
      v.error("E20", key,
              fmt::format("{} phases for {} harmonics", phases->size(), amplitudes->size()));
  }
  if (std::accumulate(b.stiffness_harmonics.begin(), b.stiffness_harmonics.end(), 0.0) >= 1)
    v.error("E14", "stiffness_harmonics",
            "the mesh stiffness would become negative: the harmonics add up to 1 or more");
}

void add_kinds(Kinds& k, As<model::Coupling>) {
  k.add<model::Coupling>(
      "coupling", "flexible coupling between two shafts, 6x6, with misalignment; needs 'to'");
}

void add_kinds(Kinds& k, As<model::GearPair>) {
  k.add<model::GearPair>("gear",
                         "spur or helical gear pair between two shafts: mesh "
                         "stiffness, backlash, transmission error; needs 'to'");
}

}  // namespace whirl::deck
