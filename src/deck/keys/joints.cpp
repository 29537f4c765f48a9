// [[joint]]: what holds two places of shaft lines together exactly, or one to the ground.
#include <core/units.hpp>
#include <deck/visitor.hpp>

#include <fmt/format.h>

#include <cmath>

namespace whirl::deck {
namespace {

using model::JointKind;

/// A direction in global axes; only its sense counts. Returns whether it is one.
bool describe_direction(Visitor& v, const char* key, Vec3& axis, const char* doc) {
  std::vector<double> x;
  v.quantities(required(key), x, "", any, 3, doc);
  if (!v.clean() || x.size() != 3) return false;
  axis = Vec3(x[0], x[1], x[2]);
  const double size = axis.cwiseAbs().maxCoeff();
  if (!(size > 0) || !std::isfinite(size)) {
    v.error("E14", key, "the axis has no direction: its length is zero",
            fmt::format("{} = [0, 0, 1]", key));
    return false;
  }
  axis = (axis / size).normalized();  // the square of 1e300 is no number
  return true;
}

void describe_hinge(Visitor& v, model::Joint& j) {
  describe_direction(v, "axis", j.axis,
                     "direction about which one side turns against the other, in global axes of "
                     "the undeformed model; fixed in both");
  v.quantity("stiffness", j.stiffness, "N.m/rad", not_negative,
             "of a spring against the angle of the hinge");
  v.quantity("damping", j.damping, "N.m.s/rad", not_negative, "of a damper on the angle");
}

void describe_slider(Visitor& v, model::Joint& j) {
  describe_direction(v, "axis", j.axis,
                     "direction along which one side slides against the other, in global axes of "
                     "the undeformed model; fixed in both");
  v.quantity("stiffness", j.stiffness, "N/m", not_negative, "of a spring against the slide");
  v.quantity("damping", j.damping, "N.s/m", not_negative, "of a damper on the slide");
}

void describe_universal(Visitor& v, model::Joint& j) {
  const bool first = describe_direction(v, "axis", j.axis,
                                        "arm of the cross that is fixed in the line of 'at', in "
                                        "global axes of the undeformed model");
  const bool second = describe_direction(v, "second_axis", j.second_axis,
                                         "arm of the cross that is fixed in the other line");
  if (first && second && j.axis.cross(j.second_axis).norm() < 1e-6)
    v.error("E26", "second_axis", "the two axes of the universal joint are parallel",
            "they cross, as a rule at right angles");
}

}  // namespace

void describe(Visitor& v, model::Joint& j) {
  v.name(j, "joint");
  v.location(required("at"), j.at, "place on a line");
  model::Location to;
  if (v.location(optional("to", "the ground"), to, "place on another line it is joined to"))
    j.to = to;
  const auto kind = [&](const char* word, const char* doc, JointKind k, auto describe_keys) {
    return Alternative{word, doc, [&j, k, describe_keys](Visitor& w) {
                         j.kind = k;
                         describe_keys(w, j);
                       }};
  };
  const Alternative kinds[] = {
      kind("rigid", "both sides move as one body", JointKind::rigid,
           [](Visitor& w, model::Joint& x) {
             w.flag("arm", x.arm,
                    "the two places may lie apart: a rigid arm without mass joins them");
           }),
      kind("hinge", "both turn against each other about one axis, any number of times",
           JointKind::hinge, describe_hinge),
      kind("universal",
           "both turn against each other about two axes that cross, as in a Cardan "
           "joint",
           JointKind::universal, describe_universal),
      kind("spherical", "both turn against each other in any way: a ball in its socket",
           JointKind::spherical, [](Visitor&, model::Joint&) {}),
      kind("slider", "both slide along each other in one direction and do not turn",
           JointKind::slider, describe_slider),
  };
  v.alternatives(required("kind"), kinds, "what the joint leaves free");
  if (v.clean() && j.to && j.to->shaft == j.at.shaft && j.to->s == j.at.s)
    v.error("E14", "to", "the joint connects a place with itself");
  if (v.clean() && (j.at.housing >= 0 || (j.to && j.to->housing >= 0)))
    v.error("E26", j.at.housing >= 0 ? "at" : "to", "a joint holds shaft lines, not supports",
            "name a place on a line; a support can be a [[shaft]] with rotating = false");
  if (!v.clean() || !j.to) return;
  const auto& shafts = v.model().shafts;
  const Vec3 apart = shafts[j.at.shaft].position(j.at.s) - shafts[j.to->shaft].position(j.to->s);
  const Vec3 wrong = j.kind == JointKind::slider ? Vec3(apart - apart.dot(j.axis) * j.axis) : apart;
  if (!j.arm && wrong.norm() > 1e-6)
    v.error("E26", "to",
            fmt::format("the two places of the joint are {} apart{}",
                        units::display(wrong.norm(), "mm"),
                        j.kind == JointKind::slider ? " across its axis" : ""),
            j.kind == JointKind::rigid
                ? "arm = true joins them by a rigid arm; else check 'origin' and 'path'"
                : "check 'origin' and 'path' of the two lines; a rigid joint with arm = true "
                  "carries a distance");
}

}  // namespace whirl::deck
