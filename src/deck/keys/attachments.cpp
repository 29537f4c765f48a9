// What sits on a shaft: disks, unbalance, loads, probes; and initial motion.
#include <deck/visitor.hpp>
#include <charconv>
#include <cmath>
#include <core/units.hpp>
#include <fmt/format.h>
#include <model/mass.hpp>

namespace whirl::deck {
namespace {

constexpr const char* place =
    "place on a shaft: \"section:mid\", \"section:end - 20 mm\", \"1.14 m\"";

/// Principal moments of a symmetric 3x3 tensor satisfy the triangle inequality when it belongs to a
/// body.
bool physical(const Mat3& J) {
  // trace/2 - J is the tensor of second moments of mass: positive semidefinite for a body (leading
  // minors suffice with slack)
  const Mat3 P = 0.5 * J.trace() * Mat3::Identity() - J;
  const double slack = -1e-9 * std::max(J.trace(), 1e-300);
  const double m2a = P(0, 0) * P(1, 1) - P(0, 1) * P(0, 1),
               m2b = P(0, 0) * P(2, 2) - P(0, 2) * P(0, 2),
               m2c = P(1, 1) * P(2, 2) - P(1, 2) * P(1, 2);
  const double det = P(0, 0) * m2c - P(0, 1) * (P(0, 1) * P(2, 2) - P(1, 2) * P(0, 2)) +
                     P(0, 2) * (P(0, 1) * P(1, 2) - P(1, 1) * P(0, 2));
  const double t = std::max(J.trace(), 1e-300);
  return P(0, 0) >= slack && P(1, 1) >= slack && P(2, 2) >= slack && m2a >= slack * t &&
         m2b >= slack * t && m2c >= slack * t && det >= slack * t * t;
}

}  // namespace

void describe(Visitor& v, model::Disk& d) {
  v.name(d, "disk");
  v.location(required("at"), d.at, place);
  const bool by_mass =
      v.quantity(optional("mass", "from the shape"), d.mass, "kg", not_negative, "mass");
  const bool Ip =
      v.quantity(optional("Ip", "from the shape, or 0"), d.Ip, "kg.m^2", not_negative,
                 "polar moment of inertia, about the shaft axis through the mass centre");
  const bool Id =
      v.quantity(optional("Id", "from the shape, or Ip/2"), d.Id, "kg.m^2", not_negative,
                 "diametral moment of inertia, about an axis across through the mass centre");
  std::vector<double> J;
  const bool tensor =
      v.quantities(optional("inertia", "from Ip and Id"), J, "kg.m^2", any, 6,
                   "full tensor about the mass centre in body axes (x along the shaft): Jxx, Jyy, "
                   "Jzz, Jxy, Jxz, Jyz; off-diagonal entries are those of the tensor");
  double od = 0, id = 0, width = 0;
  std::size_t material = 0;
  const bool by_shape = v.quantity(optional("od", "mass is given"), od, "mm", positive,
                                   "outer diameter of a cylindrical disk");
  v.quantity(optional("id", "solid"), id, "mm", not_negative, "bore");
  const bool has_width = v.quantity(optional("width", "mass is given"), width, "mm", positive,
                                    "axial width of a cylindrical disk");
  const bool has_material =
      v.material(optional("material", "mass is given"), material, "material of a cylindrical disk");
  v.vector("offset", d.offset, "mm",
           "mass centre from the station in body axes (x along the shaft, y and z across): across "
           "it is an unbalance of mass times offset");
  v.quantity("skew", d.skew, "deg", between(0, pi / 2),
             "tilt of the principal axis from the shaft axis");
  v.quantity("skew_phase", d.skew_phase, "deg", any,
             "body angle towards which it is tilted, from y towards z");
  v.table(
      optional("draw", "from the shape or the inertia"),
      [&](Visitor& w) {
        w.quantity(required("od"), d.draw_od, "mm", positive, "outer diameter");
        w.quantity(optional("id", "the shaft"), d.draw_id, "mm", not_negative, "inner diameter");
        w.quantity(required("width"), d.draw_width, "mm", positive, "width");
      },
      "shape for pictures only");
  if (!v.clean()) return;
  if (by_mass && (by_shape || has_width || has_material)) {
    v.error("E26",
            by_shape    ? "od"
            : has_width ? "width"
                        : "material",
            "the disk is given by mass and by shape",
            "keep mass, Ip, Id or od, id, width, material; a shape for pictures goes into draw = { "
            "... }");
  } else if (!by_mass && !by_shape) {
    v.error("E05", nullptr, fmt::format("disk '{}' has no mass", d.name),
            "give mass, Ip, Id, or od, width, material");
  } else if (by_shape && (Ip || Id || tensor)) {
    v.error("E26",
            Ip   ? "Ip"
            : Id ? "Id"
                 : "inertia",
            "the inertia is given and the disk has a shape", "leave one of them out");
  } else if (by_shape && (!has_width || !has_material)) {
    v.error("E05", nullptr,
            fmt::format("disk '{}' lacks '{}'", d.name, has_width ? "material" : "width"),
            "a shape is od, width and material");
  } else if (by_shape && id >= od) {
    v.error("E23", "id",
            fmt::format("the bore of {} is not smaller than the outer diameter of {}",
                        units::display(id, "mm"), units::display(od, "mm")),
            "these are diameters, not radii");
  } else if (tensor && (Ip || Id)) {
    v.error("E26", "inertia", "the inertia is given by 'inertia' and by Ip or Id",
            "keep one of the two");
  }
  if (!v.clean()) return;
  if (by_shape) {
    d.mass = v.model().materials[material].rho * pi / 4 * (od * od - id * id) * width;
    d.Ip = d.mass * (od * od + id * id) / 8;
    d.Id = d.Ip / 2 + d.mass * width * width / 12;
    if (d.draw_od == 0) {
      d.draw_od = od;
      d.draw_id = id;
      d.draw_width = width;
    }
  } else if (tensor) {
    Mat3 m;
    m << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
    d.inertia = m;
    d.Ip = J[0];
    d.Id = 0.5 * (J[1] + J[2]);
    if (!physical(m))
      v.error("E24", "inertia", "no body has this inertia tensor",
              "the sum of two principal moments is at least the third");
  } else {
    if (!Id) d.Id = d.Ip / 2;
    // rounded inputs of a thin disk may miss equality by their last digit
    if (d.Id < 0.5 * d.Ip * (1 - 1e-6))
      v.error("E24", "Id",
              fmt::format("no body has Id = {} with Ip = {}: Id is at least Ip/2",
                          units::display(d.Id, "kg.m^2"), units::display(d.Ip, "kg.m^2")),
              d.Ip > 0 && d.Id > 0
                  ? "equality holds for an infinitely thin disk; are Ip and Id interchanged?"
                  : "");
  }
}

void describe(Visitor& v, model::Unbalance& u) {
  v.name(u, "unbalance");
  v.location(required("at"), u.at, place);
  model::Location to;
  if (v.location(optional("to", "at one place"), to,
                 "the amount is spread evenly from 'at' to here, on the same shaft"))
    u.to = to;
  const bool amount = v.quantity(optional("amount", "from the grade"), u.amount, "g.mm",
                                 not_negative, "mass times eccentricity, in all");
  std::string grade;
  double speed = 0, mass = 0;
  const bool has_grade = v.text(optional("grade", "amount is given"), grade,
                                "balance quality grade after ISO 21940-11, \"G2.5\": eccentricity "
                                "times speed in mm/s at grade_speed");
  const bool has_speed = v.quantity(optional("grade_speed", "amount is given"), speed, "rpm",
                                    positive, "service speed of the grade");
  const bool has_mass = v.quantity(optional("grade_mass", "the whole shaft with its disks"), mass,
                                   "kg", positive, "mass the grade refers to");
  v.quantity("phase", u.phase, "deg", any, "body angle of the heavy spot, from y towards z");
  describe_law(v, optional("factor", "1"), u.factor, "",
               "law of time that multiplies the amount (blade loss, growth); steps without time "
               "take it at 0");
  if (!v.clean()) return;
  if (amount && (has_grade || has_speed || has_mass))
    v.error("E26",
            has_grade   ? "grade"
            : has_speed ? "grade_speed"
                        : "grade_mass",
            "the unbalance is given by amount and by grade", "keep one of the two");
  else if (!amount && !has_grade)
    v.error("E05", nullptr, fmt::format("unbalance '{}' has no amount", u.name),
            "give amount = \"12 g.mm\", or grade = \"G2.5\" and grade_speed");
  else if (has_grade && !has_speed)
    v.error("E05", "grade", "a grade needs 'grade_speed'");
  if (!v.clean() || !has_grade) return;
  double g = 0;
  const std::string_view number = std::string_view(grade).substr(grade.empty() ? 0 : 1);
  const auto r = std::from_chars(number.data(), number.data() + number.size(), g);
  if (grade.empty() || grade[0] != 'G' || r.ec != std::errc() ||
      r.ptr != number.data() + number.size() || !(g > 0)) {
    v.error("E10", "grade", fmt::format("\"{}\" is not a balance quality grade", grade),
            "write \"G2.5\"");
    return;
  }
  if (!has_mass) mass = model::mass(v.model(), u.at.shaft);
  u.amount = mass * g * 1e-3 / speed;
}

namespace {

/// The ways in which a crack can be given.
void describe_size(Visitor& v, model::Crack& c) {
  const bool depth = v.quantity(
      optional("depth", "stiffness or loss is given"), c.depth, "mm", positive,
      "from the surface to the middle of the straight edge, at most a radius, in a solid round "
      "section: the open crack's compliance follows from fracture mechanics");
  const bool stiffness =
      v.quantity(optional("stiffness", "depth or loss is given"), c.stiffness, "N.m/rad", positive,
                 "of the open crack, as a hinge in the shaft, against the bending that opens it");
  const bool across_stiffness =
      v.quantity(optional("stiffness_across", "rigid"), c.stiffness_across, "N.m/rad", positive,
                 "the same against bending across; not below 'stiffness'");
  const bool loss =
      v.number(optional("loss", "depth or stiffness is given"), c.loss, {0, 1, true, true},
               "D: the open crack leaves EI (1 - D) from 'at' to 'to' against the "
               "bending that opens it");
  const bool across_loss =
      v.number(optional("loss_across", "0"), c.loss_across, {0, 1, false, true},
               "the same against bending across; not above 'loss'");
  if (!v.clean()) return;
  if (int(depth) + int(stiffness) + int(loss) > 1) {
    v.error("E26", depth && stiffness ? "stiffness" : "loss",
            fmt::format("crack '{}' is given in more than one way", c.name),
            "keep one of depth, stiffness, and loss with 'to'");
  } else if (!depth && !stiffness && !loss) {
    v.error("E05", nullptr, fmt::format("crack '{}' has no size", c.name),
            "give depth = \"12 mm\", or stiffness = \"2 MN.m/rad\", or loss = 0.1 and 'to'");
  } else if (loss != c.to.has_value()) {
    v.error("E26", loss ? "loss" : "to",
            loss ? "a loss of stiffness needs the length over which it is: 'to' is missing"
                 : "a crack of a depth or stiffness is at one place",
            loss ? "to = \"body:end\"" : "leave 'to' out, or give loss = 0.1");
  } else if (across_stiffness && !stiffness) {
    v.error("E26", "stiffness_across", "it goes with 'stiffness'");
  } else if (across_loss && !loss) {
    v.error("E26", "loss_across", "it goes with 'loss'");
  } else if (c.stiffness_across < c.stiffness) {
    v.error("E26", "stiffness_across", "the crack is softer across than where it opens",
            "'phase' points from the axis to the middle of its mouth");
  } else if (c.loss_across > c.loss) {
    v.error("E26", "loss_across", "the crack is softer across than where it opens",
            "'phase' points from the axis to the middle of its mouth");
  } else if (c.breathing == model::Crack::Breathing::hinge && (across_stiffness || across_loss)) {
    v.error("E26", across_loss ? "loss_across" : "stiffness_across",
            "a hinge opens about one axis: it has no compliance across",
            "breathing = \"response\" has both, or leave the key out");
  }
}

}  // namespace

void describe(Visitor& v, model::Crack& c) {
  v.name(c, "crack");
  v.location(required("at"), c.at, place);
  model::Location to;
  if (v.location(optional("to", "at one place"), to,
                 "end of the length that loses stiffness, on the same shaft"))
    c.to = to;
  v.quantity("phase", c.phase, "deg", any,
             "body angle of the crack's normal, which points from the axis to the middle of its "
             "mouth, from y towards z");
  v.choice(
      "breathing", c.breathing,
      {{"mayes",
        "open by (1 + cos)/2 of the angle between the normal and open_direction: the "
        "weight rules"},
       {"hinge", "open or closed, by the sign of the bending moment at it"},
       {"response",
        "smoothly, by the direction of the bending moment at it; without loss_across as \"hinge\""},
       {"open", "always open, as a notch"}},
      "how it opens and closes");
  const bool direction =
      v.quantity(optional("open_direction", "that of gravity"), c.open_direction, "deg", any,
                 "of breathing \"mayes\": direction in space, from y towards z, into which the "
                 "normal points when the crack is open; with supports on both sides the weight "
                 "opens what points down, beyond the last support what points up");
  describe_size(v, c);
  if (!v.clean()) return;
  const bool mayes = c.breathing == model::Crack::Breathing::weight;
  if (direction && !mayes)
    v.error("E26", "open_direction", "only breathing \"mayes\" has a direction in space");
  if (mayes && !direction && v.model().gravity.tail<2>().norm() == 0)
    v.error("E05", "breathing",
            fmt::format("crack '{}' breathes with the weight, and no gravity acts across the shaft",
                        c.name),
            "give open_direction = \"270 deg\", or breathing = \"response\"");
}

void describe(Visitor& v, model::PointLoad& l) {
  v.name(l, "load");
  v.location(required("at"), l.at, place);
  v.choice("frame", l.frame,
           {{"fixed", "directions fixed in space"}, {"rotating", "directions turn with the shaft"}},
           "axes of force and moment");
  v.vector("force", l.force, "N", "force along x, y, z");
  v.vector("moment", l.moment, "N.m", "moment about x, y, z");
  describe_law(v, optional("factor", "1"), l.factor, "",
               "law of time that multiplies force and moment; steps without time take it at 0");
  if (v.clean() && !v.given("force") && !v.given("moment"))
    v.error("E05", nullptr, fmt::format("load '{}' has neither 'force' nor 'moment'", l.name));
}

void describe(Visitor& v, model::Probe& p) {
  v.name(p, "probe");
  v.location(required("at"), p.at, place);
  v.quantities(optional("angles", "y and z"), p.angles, "deg", any, -1,
               "directions of the probe, from y towards z");
  constexpr double same = 1e-9;  // rad, turns apart or not
  for (std::size_t i = 0; v.clean() && i < p.angles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (std::abs(std::remainder(p.angles[i] - p.angles[j], two_pi)) > same) continue;
      v.error("E26", "angles",
              fmt::format("probe '{}' looks twice in one direction: {} and {}", p.name,
                          units::display(p.angles[j], "deg"), units::display(p.angles[i], "deg")),
              "once is enough: its columns would have one name");
      return;
    }
}

void describe(Visitor& v, model::InitialMotion& m) {
  v.name(m, "initial");
  v.shaft(optional("shaft", "the only one"), m.shaft, "the shaft line that moves");
  v.vector("displacement", m.displacement, "mm", "shift of the whole line");
  std::vector<double> gamma{0, 0};
  v.quantities("tilt", gamma, "deg", any, 2, "transverse rotation (Euler vector) about y and z");
  v.vector("velocity", m.velocity, "m/s", "velocity of the point 'about'");
  v.vector(
      "angular_velocity", m.omega, "rad/s",
      "angular velocity about x, y, z in space; about x the spin, where neither a drive nor the "
      "step gives it");
  v.vector("about", m.about, "mm",
           "point that rotation and velocity refer to, in the undeformed position");
  m.gamma = Vec2(gamma[0], gamma[1]);
  if (v.clean() && m.gamma.norm() >= pi)
    v.error("E14", "tilt", "the tilt must be less than 180 deg",
            "beyond it the same direction is reached the other way round");
}

}  // namespace whirl::deck
