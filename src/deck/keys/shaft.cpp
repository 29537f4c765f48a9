// [[material]], [[shaft]] and their sections.
#include <deck/visitor.hpp>
#include <model/full_section.hpp>
#include <cmath>
#include <core/units.hpp>
#include <la/dense.hpp>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

constexpr std::size_t no_material = static_cast<std::size_t>(-1);

struct Diameters {
  double od_l = 0, id_l = 0, od_r = 0, id_r = 0;
  bool given = false;
};

/// od and id for a cylinder, or the four ends of a cone; `keys`: od, id, od_l, id_l, od_r, id_r.
void describe_diameters(Visitor& v, Diameters& d, const char* const (&keys)[6], const char* what) {
  double od = 0, id = 0;
  const bool cylinder =
      v.quantity(optional(keys[0], "see od_l and od_r"), od, "mm", positive, what);
  const bool bore =
      v.quantity(optional(keys[1], "solid"), id, "mm", not_negative, "inner diameter");
  const bool left = v.quantity(optional(keys[2], "od"), d.od_l, "mm", positive,
                               "outer diameter at the left end of a cone");
  const bool left_bore = v.quantity(optional(keys[3], "id"), d.id_l, "mm", not_negative,
                                    "inner diameter at the left end");
  const bool right = v.quantity(optional(keys[4], "od, or od_l"), d.od_r, "mm", positive,
                                "outer diameter at the right end");
  const bool right_bore = v.quantity(optional(keys[5], "id, or id_l"), d.id_r, "mm", not_negative,
                                     "inner diameter at the right end");
  d.given = cylinder || left || right;
  if (!v.clean()) return;
  if ((cylinder && (left || right)) || (bore && (left_bore || right_bore)))
    v.error("E26", cylinder && (left || right) ? keys[0] : keys[1],
            "the diameter is given once for the section and once for its ends",
            "keep od, or od_l and od_r");
  else if (right && !left)
    v.error("E26", keys[4], fmt::format("'{}' needs '{}'", keys[4], keys[2]));
  else if ((bore || left_bore || right_bore) && !d.given)
    v.error("E26",
            bore        ? keys[1]
            : left_bore ? keys[3]
                        : keys[5],
            "an inner diameter needs an outer one");
  if (!v.clean()) return;
  if (cylinder) d.od_l = d.od_r = od;
  if (left && !right) d.od_r = d.od_l;
  if (bore) d.id_l = d.id_r = id;
  if (left_bore && !right_bore) d.id_r = d.id_l;
  const auto bore_fits = [&](double outer, double inner, const char* key, const char* end) {
    if (d.given && inner >= outer)
      v.error("E23", key,
              fmt::format("the bore of {} is not smaller than the outer diameter of {}{}",
                          units::display(inner, "mm"), units::display(outer, "mm"), end),
              "these are diameters, not radii");
  };
  if (bore && cylinder)
    bore_fits(od, id, keys[1], "");
  else {
    bore_fits(d.od_l, d.id_l, bore ? keys[1] : keys[3], " at the left end");
    if (v.clean())
      bore_fits(d.od_r, d.id_r,
                bore         ? keys[1]
                : right_bore ? keys[5]
                             : keys[3],
                " at the right end");
  }
}

void describe_damping(Visitor& v, model::ShaftDamping& d) {
  v.quantity("rayleigh_alpha", d.alpha, "1/s", not_negative,
             "mass-proportional damping, external (acts on the motion in fixed axes)");
  v.quantity("external_beta", d.beta_external, "s", not_negative,
             "stiffness-proportional damping, external: damps at every speed");
  v.quantity("internal_beta", d.beta_internal, "s", not_negative,
             "stiffness-proportional viscous damping of the shaft itself, in its rotating axes: "
             "destabilises forward whirl above the critical speed");
  v.number("internal_loss_factor", d.loss_factor, fraction,
           "hysteretic damping of the shaft itself, in its rotating axes: the same loss a cycle at "
           "every frequency. Steps in the frequency domain apply it as a complex stiffness; it "
           "drives forward whirl above the critical speed");
  const bool stand_in =
      v.quantity(optional("internal_loss_frequency", "no hysteretic damping in transients"),
                 d.loss_frequency, "rad/s", positive,
                 "transients, where hysteretic damping has no form: viscous damping stands for it "
                 "that loses as much a cycle at this frequency (Hz, rpm or rad/s), seen in "
                 "rotating axes: |whirl frequency - spin|");
  if (v.clean() && stand_in && d.loss_factor == 0)
    v.error("E26", "internal_loss_frequency",
            "'internal_loss_frequency' belongs to an internal_loss_factor");
  v.quantity("torsion_beta", d.beta_torsion, "s", not_negative,
             "stiffness-proportional damping of the twist");
}

void describe_shear(Visitor& v, model::Section& s) {
  v.choice("shear", s.shear,
           {{"cowper", "shear factor after Cowper (1966)"},
            {"hutchinson", "after Hutchinson (2001)"},
            {"none", "no shear deformation (Euler-Bernoulli)"},
            {"given", "the value of kappa"}},
           "shear deformation of the sections");
  const bool kappa = v.number(optional("kappa", "from shear"), s.kappa, Range{0, 2, true, false},
                              "shear factor, with shear = \"given\"");
  v.flag("rotary_inertia", s.rotary_inertia,
         "rotary inertia of the cross-sections (false: as in the Euler-Bernoulli beam)");
  v.flag("mean_rotary_inertia", s.mean_rotary_inertia,
         "both transverse inertias of a section that is not round are the mean of the two, so that "
         "no inertia turns with a spinning shaft; for slender shafts, where the difference is "
         "small and costs excitation at twice the speed; not for blades and short flat beams");
  if (!v.clean()) return;
  const bool wanted = s.shear == model::ShearFactor::given;
  if (kappa && !wanted) v.error("E26", "kappa", "'kappa' is given, but shear is not \"given\"");
  if (wanted && s.kappa == 0) v.error("E26", "shear", "shear = \"given\" needs 'kappa'");
}

/// Angle of section axes at both ends, or at the left one for both.
void describe_angles(Visitor& v, double& angle, double& twist) {
  v.quantity("angle", angle, "deg", any,
             "of the section's y axis from that of the shaft, towards z");
  double right = angle;
  if (v.quantity(optional("angle_r", "angle"), right, "deg", any,
                 "at the right end of a section that is twisted evenly: blades, pre-twisted beams"))
    twist = right - angle;
}

constexpr std::array<const char*, 6> section_directions{
    "x", "y", "z", "rotation about x", "rotation about y", "rotation about z"};

/// Symmetric, with eigenvalues (after scaling to a unit diagonal) above `least`.
void check_definite(Visitor& v, const char* key, const Matrix<6>& A, double least,
                    const std::string& kind) {
  constexpr double digits = 1e-6;  // of matrices written with seven digits
  for (int i = 0; i < 6; ++i)
    for (int k = i + 1; k < 6; ++k)
      if (std::abs(A(i, k) - A(k, i)) >
          digits * std::sqrt(std::abs(A(i, i) * A(k, k))) + digits * std::abs(A(i, k))) {
        v.error("E36", key,
                fmt::format("the {} is not symmetric: row {}, column {} is {:.7g} and row {}, "
                            "column {} is {:.7g} (SI)",
                            kind, i + 1, k + 1, A(i, k), k + 1, i + 1, A(k, i)));
        return;
      }
  Vector<6> scale = A.diagonal().cwiseAbs().cwiseSqrt();
  for (int i = 0; i < 6; ++i)
    scale[i] = scale[i] > 0 ? 1 / scale[i] : 1.0;
  const MatX unit = scale.asDiagonal() * (0.5 * (A + A.transpose())) * scale.asDiagonal();
  const la::SymmetricEigenpairs modes = la::symmetric_eigenpairs(unit);
  const double lowest = modes.values[0];
  if (lowest > least) return;
  int main = 0;
  modes.vectors.col(0).cwiseAbs().maxCoeff(&main);
  v.error("E36", key,
          fmt::format("the {} is not positive {}: scaled to a diagonal of ones it has the "
                      "eigenvalue {:.4g}, mainly {}",
                      kind, least < 0 ? "semi-definite" : "definite", lowest,
                      section_directions[static_cast<std::size_t>(main)]),
          "check the signs of the entries beside the diagonal and their units");
}

/// Of the form [m, -m c x; m c x, J], c in the plane of the section.
void check_mass_form(Visitor& v, const Matrix<6>& M, const std::string& section) {
  const Matrix<6> form = SectionMoments(M).matrix();
  const double m = std::abs(M(0, 0)), J = M.bottomRightCorner<3, 3>().cwiseAbs().maxCoeff();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 6; ++k) {
      const double size = k < 3 ? m : std::sqrt(m * J);
      if (std::abs(M(i, k) - form(i, k)) <= 1e-6 * size) continue;
      v.error("E36", "mass",
              fmt::format(
                  "section '{}' cannot have this mass matrix: row {}, column {} is {:.7g} where a "
                  "mass of {:.7g} per length at its centre makes {:.7g} (SI)",
                  section, i + 1, k + 1, M(i, k), M(0, 0), form(i, k)),
              "[m, 0, 0, 0, m z, -m y], [0, m, 0, -m z, 0, 0], [0, 0, m, m y, 0, 0] and their "
              "mirror images, (y, z) the mass centre");
      return;
    }
}

void describe_full(Visitor& v, model::Section& s) {
  model::Section::Full f;
  v.matrix(required("stiffness"), f.stiffness, "N", "N.m", "N.m^2",
           "per length: force (x, y, z) and moment about (x, y, z) of strain (axial, shear along y "
           "and z) and curvature (twist, bending about y and z), in section axes about the line of "
           "nodes; symmetric, positive definite");
  v.matrix(required("mass"), f.mass, "kg/m", "kg", "kg.m",
           "per length: momentum and angular momentum of velocity and angular velocity, in section "
           "axes about the line of nodes; symmetric, positive semi-definite");
  describe_angles(v, f.angle, f.twist);
  if (!v.clean()) return;
  const auto of = [&](const char* what) {
    return fmt::format("{} matrix of section '{}'", what, s.name);
  };
  check_definite(v, "stiffness", f.stiffness, 1e-12, of("stiffness"));
  if (v.clean()) check_definite(v, "mass", f.mass, -1e-9, of("mass"));
  if (v.clean()) check_mass_form(v, f.mass, s.name);
  if (!v.clean()) return;
  f.stiffness = Matrix<6>(0.5 * (f.stiffness + f.stiffness.transpose()));
  f.mass = SectionMoments(0.5 * (f.mass + f.mass.transpose())).matrix();
  s.full = f;
}

void describe_piece(Visitor& v, Path& path) {
  Vec3 to = Vec3::Zero(), through = Vec3::Zero(), centre = Vec3::Zero(), axis = Vec3::UnitZ();
  double angle = 0;
  const bool has_to = v.vector(optional("to", "an arc of an angle about a centre"), to, "mm",
                               "end of the piece: a straight one unless 'through' is given");
  const bool has_through = v.vector(optional("through", "straight"), through, "mm",
                                    "a point on the way: a circular arc through it");
  const bool has_centre =
      v.vector(optional("centre", "not used"), centre, "mm",
               "a point on the axis of an arc that begins where the piece before ends");
  v.vector(optional("axis", "[0, 0, 1]"), axis, "",
           "direction of that axis; the arc turns about it by the right-hand rule");
  const bool has_angle =
      v.quantity(optional("angle", "not used"), angle, "deg", any, "of the arc about that axis");
  if (!v.clean()) return;
  if (has_to == has_centre)
    v.error(
        "E26", has_to ? "centre" : nullptr,
        has_to ? "the piece has an end and a centre" : "the piece has neither an end nor a centre",
        "give 'to' (and 'through' for an arc), or 'centre' and 'angle'");
  else if (has_centre != has_angle)
    v.error("E26", has_angle ? "angle" : "centre",
            "an arc about a centre needs 'centre' and 'angle'");
  else if (has_through && has_centre)
    v.error("E26", "through", "'through' goes with 'to', not with 'centre'");
  if (!v.clean()) return;
  if (has_centre) {
    if (!path.add_arc_about(centre, axis, angle))
      v.error("E26", "centre",
              "there is no such arc: the axis goes through its start, or has no direction, or the "
              "angle is zero or more than two turns");
  } else if (has_through) {
    if (!path.add_arc_through(through, to))
      v.error("E26", "through",
              "there is no such arc: its three points are in one line, or two of them are one",
              "leave 'through' out for a straight piece");
  } else if (!path.add_line(to)) {
    v.error("E26", "to", "the piece ends where it starts");
  }
}

/// Written lengths agree with that of a path to this part of it.
constexpr double length_digits = 1e-6;

void check_path(Visitor& v, const model::Shaft& s) {
  const std::string who =
      s.name.empty() ? std::string("the shaft") : fmt::format("shaft '{}'", s.name);
  if (s.rotating)
    v.error("E26", "path",
            fmt::format("{} has a path: a line that is not straight cannot turn about itself", who),
            "write rotating = false");
  if (s.bow.any())
    v.error("E26", "bow", fmt::format("{} has a path and a bow", who), "put the bow into the path");
  for (const auto& x : s.sections)
    if (x.rigid)
      v.error("E26", "path",
              fmt::format("section '{}' is rigid: on a path every section is elastic", x.name),
              "give it a large stiffness by constants");
  const double have = s.length(), want = s.path.length();
  if (v.clean() && std::abs(have - want) > length_digits * want)
    v.error("E25", "path",
            fmt::format("the path is {:.10g} m long, the sections together {:.10g} m", want, have),
            "lengths of sections are measured along the path");
}

}  // namespace

void describe(Visitor& v, model::Material& m) {
  v.name(m, "material");
  const bool E = v.quantity(required("E"), m.E, "GPa", any, "Young's modulus");
  const bool G = v.quantity(optional("G", "E/(2(1+nu))"), m.G, "GPa", any, "shear modulus");
  const bool nu = v.number(optional("nu", "0.3, or from E and G"), m.nu, any, "Poisson's ratio");
  v.quantity(required("density"), m.rho, "kg/m^3", any, "density");
  v.quantity(optional("yield", "not given"), m.yield, "MPa", positive, "yield stress, for reports");
  v.quantity("expansion", m.expansion, "1/K", any, "coefficient of thermal expansion");
  if (!v.clean() || !E) return;
  if (!(m.E > 0)) v.error("E36", "E", "Young's modulus must be positive");
  if (G && !(m.G > 0)) v.error("E36", "G", "the shear modulus must be positive");
  if (!(m.rho >= 0)) v.error("E36", "density", "the density must not be negative");
  if (nu && !(m.nu > -1 && m.nu <= 0.5))
    v.error("E36", "nu", fmt::format("Poisson's ratio {} lies outside -1 to 0.5", m.nu));
  if (!v.clean()) return;
  if (!G)
    m.G = m.E / (2 * (1 + m.nu));
  else if (!nu)
    m.nu = m.E / (2 * m.G) - 1;
  else if (std::abs(m.G * 2 * (1 + m.nu) / m.E - 1) >
           0.02)  // rounded handbook values agree to better than 2 %
    v.error("E36", "G",
            fmt::format("G and nu contradict each other: E/(2(1+nu)) is {}",
                        units::display(m.E / (2 * (1 + m.nu)), "GPa")),
            "leave one of them out");
  if (G && !nu && !(m.nu > -1 && m.nu <= 0.5))
    v.error("E36", "G", fmt::format("E and G give Poisson's ratio {:.3g}, outside -1 to 0.5", m.nu),
            "check both moduli");
}

void describe(Visitor& v, model::Section& s) {
  static constexpr const char* keys[6] = {"od", "id", "od_l", "id_l", "od_r", "id_r"};
  static constexpr const char* stiffness_keys[6] = {"stiffness_od",   "stiffness_id",
                                                    "stiffness_od_l", "stiffness_id_l",
                                                    "stiffness_od_r", "stiffness_id_r"};
  v.name(s, "section");
  double from = 0;
  v.quantity(optional("from", "the end of the section before"), from, "mm", any,
             "start of the section, checked against the end of the one before");
  v.quantity(required("length"), s.length, "mm", positive, "length along the shaft");
  Diameters d;
  describe_diameters(v, d, keys, "outer diameter (mass and stiffness)");
  Diameters stiffness;
  describe_diameters(v, stiffness, stiffness_keys,
                     "outer diameter for the stiffness, where it differs from that for the mass "
                     "(sleeves, shrink fits)");
  if (v.material(optional("material", "that of the shaft"), s.material, "name of a material") &&
      s.material == no_material)
    s.material = 0;
  v.flag("rigid", s.rigid, "a rigid link: no deformation, and no mass unless it has diameters");
  describe_shear(v, s);
  v.quantity("temperature_rise", s.temperature_rise, "K", any,
             "above the temperature at which the section has its length; needs the expansion of "
             "the material");
  v.quantity("added_mass", s.added_mass_per_length, "kg/m", not_negative,
             "distributed mass without stiffness");
  v.integer(optional("min_elements", "model.mesh"), s.min_elements, between(1, 10000),
            "least number of elements");
  v.quantity(optional("max_element_length", "model.mesh"), s.max_element_length, "mm", positive,
             "longest element");
  v.table(
      optional("general", "a round section"),
      [&](Visitor& w) {
        model::Section::General g;
        w.quantity(required("A"), g.A, "mm^2", positive, "area");
        w.quantity(required("Iy"), g.Iy, "mm^4", positive,
                   "second moment of area about the section's y axis (bending in the x-z plane)");
        w.quantity(required("Iz"), g.Iz, "mm^4", positive,
                   "second moment of area about the section's z axis");
        w.quantity(required("J"), g.J, "mm^4", positive, "torsion constant");
        w.number(required("kappa_y"), g.kappa_y, positive, "shear factor along y");
        w.number(required("kappa_z"), g.kappa_z, positive, "shear factor along z");
        describe_angles(w, g.angle, g.twist);
        std::vector<double> centroid{0, 0}, shear_centre{0, 0};
        w.quantities("centroid", centroid, "mm", any, 2,
                     "(y, z) of the centroid, section axes, from the line of nodes: axial force "
                     "and bending act about it, and the mass is there");
        w.quantities("shear_centre", shear_centre, "mm", any, 2,
                     "(y, z) of the point shear forces go through without twist");
        g.centroid = Vec2(centroid[0], centroid[1]);
        g.shear_centre = Vec2(shear_centre[0], shear_centre[1]);
        if (w.clean()) s.general = g;
      },
      "a section that is not round: keyed, slotted, rectangular");
  v.table(
      optional("full", "a round section"), [&](Visitor& w) { describe_full(w, s); },
      "a section given by its full 6x6 stiffness and mass per length: composite beams, blades; "
      "diameters are then for pictures only");
  v.table(
      optional("constants", "from diameters and material"),
      [&](Visitor& w) {
        model::Section::Constants c;
        w.quantity(required("EA"), c.EA, "N", positive, "axial stiffness");
        w.quantity(required("kGA"), c.kGA, "N", positive, "shear stiffness");
        w.quantity(required("GJ"), c.GJ, "N.m^2", positive, "torsional stiffness");
        w.quantity(required("EI"), c.EI, "N.m^2", positive, "bending stiffness");
        w.quantity(required("rhoA"), c.rhoA, "kg/m", not_negative, "mass per length");
        w.quantity(required("rhoI"), c.rhoI, "kg.m", not_negative, "transverse inertia per length");
        w.quantity(required("rhoIp"), c.rhoIp, "kg.m", not_negative, "polar inertia per length");
        if (w.clean()) s.constants = c;
      },
      "stiffness and inertia of the section given directly; diameters are then for pictures only");
  if (!v.clean()) return;
  s.od_l = d.od_l;
  s.id_l = d.id_l;
  s.od_r = d.od_r;
  s.id_r = d.id_r;
  if (stiffness.given)
    s.stiffness_diameters = {stiffness.od_l, stiffness.id_l, stiffness.od_r, stiffness.id_r};
  if (int(s.general.has_value()) + s.constants.has_value() + s.full.has_value() > 1)
    v.error("E26", s.constants ? "constants" : "full",
            fmt::format("the section is given by '{}' and by '{}'", s.general ? "general" : "full",
                        s.constants ? "constants" : "full"),
            "keep one of the two");
  else if (!s.rigid && !s.general && !s.constants && !s.full && !d.given)
    v.error("E05", nullptr, fmt::format("section '{}' has no diameter", s.name),
            "give od, or od_l and od_r");
  else if (s.rigid && (s.general || s.constants || s.full))
    v.error("E26", "rigid", "a rigid section has no stiffness of its own");
  if (v.clean() && s.full) s.constants = model::round_constants(*s.full);
  const bool needs_material = !s.constants && (!s.rigid || d.given);
  if (s.material == no_material) {
    if (needs_material && v.clean())
      v.error("E05", nullptr, fmt::format("section '{}' has no material", s.name),
              "give material = \"steel\" here or for the whole shaft");
    s.material = 0;
  }
}

void describe(Visitor& v, model::Shaft& s) {
  v.name(s, "shaft");
  model::Section start;
  start.material = no_material;
  start.min_elements = v.model().min_elements;
  start.max_element_length = v.model().max_element_length;
  v.vector("origin", s.origin, "mm", "position of the left end");
  if (v.material(optional("material", "given by each section"), start.material,
                 "material of all sections that do not name another") &&
      start.material == no_material)
    start.material = 0;  // unknown, and reported: not to be reported again for each section
  const auto piece = [&](Visitor& w) { describe_piece(w, s.path); };
  const auto piece_prototype = [](Visitor& w) {
    Path p;
    describe_piece(w, p);
  };
  s.path = Path(s.origin);
  v.list(
      optional("path", "straight along x"), {piece, piece_prototype},
      "the line of a casing, frame or pipe that is not straight, piece by piece from the origin; "
      "needs rotating = false. Section axes y, z are carried along it without twist from the "
      "global axes turned to its first direction; supports, loads and probes act in global axes");
  describe_shear(v, start);
  v.flag("rotating", s.rotating, "false: a casing or foundation beam that does not turn");
  v.number("speed_ratio", s.speed_ratio, any,
           "speed relative to the reference speed of frequency-domain steps; negative: turns the "
           "other way");
  v.quantity("initial_spin", s.spin0, "rpm", any,
             "spin at the start of transients, unless the step or a drive says otherwise");
  v.quantity("axial_preload", s.axial_preload, "N", any,
             "axial force in the undeformed shaft, tension positive, as of a shaft clamped between "
             "supports under tension: what holds its ends along the axis must "
             "balance it, and where an end is free it relaxes");
  v.quantity("axial_force", s.axial_force, "N", any,
             "axial force that pulls at both ends of the shaft, tension positive: a load that "
             "stays whatever the shaft does");
  v.quantity(
      "temperature_rise", start.temperature_rise, "K", any,
      "of all sections that do not give another: the shaft grows, or its supports hold it back");
  v.table(
      optional("bow", "straight"),
      [&](Visitor& w) {
        w.quantity(required("amount"), s.bow.amount, "um", not_negative,
                   "largest deviation, at mid-length; of a thermal bow what it comes to");
        w.quantity("phase", s.bow.phase, "deg", any, "angle on the shaft from e2 towards e3");
        const bool constant = w.quantity(
            optional("time_constant", "residual: always there"), s.bow.time_constant, "s", positive,
            "of a thermal bow: amount + (initial - amount) exp(-t/time_constant) in "
            "transients and in statics at rest (t = 0); a steady rotation has the amount");
        const bool initial = w.quantity(optional("initial", "0"), s.bow.initial, "um", not_negative,
                                        "of a thermal bow: at the start of transients");
        if (!w.clean()) return;
        if (initial && !constant)
          w.error("E26", "initial", "a bow that does not change has no initial amount",
                  "time_constant = \"10 min\" makes it a thermal bow");
        else if (!s.bow.any())
          w.error("E14", "amount", "the bow is zero", "leave it out");
      },
      "residual or thermal bow of the unloaded shaft, half a sine from end to end; it turns with "
      "the shaft");
  v.table(
      "damping", [&](Visitor& w) { describe_damping(w, s.damping); },
      "damping of the shaft material and its surroundings");

  // sections, with the checks that need the one before
  double end = 0;
  const auto add = [&](Visitor& w) {
    s.sections.push_back(start);
    model::Section& x = s.sections.back();
    describe(w, x);
    if (w.clean() && w.given("from")) {
      double from = 0;
      w.quantity(optional("from", ""), from, "mm", any, "");
      // positions written with three decimals of a millimetre agree to half a micrometre
      if (std::abs(from - end) > 0.5e-6)
        w.error("E25", "from",
                fmt::format("section '{}' starts at {}, but the one before ends at {}: {}", x.name,
                            units::display(from, "mm"), units::display(end, "mm"),
                            from < end ? "they overlap" : "there is a gap"));
    }
    end += x.length;
  };
  const auto prototype = [&](Visitor& w) {
    model::Section x = start;
    describe(w, x);
  };
  const bool rows = v.rows({add, prototype}, false, "the sections as a table");
  const bool tables = v.given("section");
  if (rows && tables && v.clean())
    v.error("E26", "section", "the sections are given by rows and by [[shaft.section]]",
            "keep one of the two");
  v.list(optional("section", "the rows"), {add, prototype},
         "the sections one by one, from left to right; needed for rigid links, general sections "
         "and constants");
  if (v.clean() && s.sections.empty())
    v.error("E05", nullptr, fmt::format("shaft '{}' has no sections", s.name),
            "give columns and rows, file = \"shaft.csv\", or [[shaft.section]]");
  if (v.clean() && !s.path.empty()) check_path(v, s);
}

}  // namespace whirl::deck
