#include <assembly/parts.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/rigid/rigid_body.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {
namespace {

/// Id may fall below Ip/2 by rounding of printed data.
constexpr double printed_digits = 1e-6;

void add_disk(Assembly& a, const model::Disk& d, int& symmetric) {
  const std::string who = fmt::format("disk '{}'", d.name);
  const meshes::Place at = a.mesh.place(d.at);
  if (!(d.mass >= 0) || d.Ip < 0 || d.Id < 0) {
    a.error("E14", fmt::format("{}: mass and moments of inertia cannot be negative", who), {}, d,
            who);
    return;
  }
  if (!d.inertia && d.Id < 0.5 * d.Ip * (1 - printed_digits)) {
    a.error("E24",
            fmt::format("{}: Id = {:.6g} kg m2 is less than Ip/2 = {:.6g} kg m2; no body has such "
                        "moments of inertia",
                        who, d.Id, 0.5 * d.Ip),
            "Ip is about the shaft axis, Id about a diameter; are they interchanged?", d, who);
    return;
  }
  const model::Shaft& shaft = a.model.shafts[d.at.shaft];
  const bool bent = !shaft.path.empty() &&
                    d.at.housing < 0;  // the axes of the disk are those of the line where it stands
  const Mat3 axes = bent ? shaft.path.after(d.at.s).triad : Mat3(Mat3::Identity());
  const Vec3 offset = axes * d.offset + Vec3(at.offset, 0, 0);
  if (!a.model.keep_everything && !bent && !d.inertia && d.skew == 0 && offset.y() == 0 &&
      offset.z() == 0) {
    ++symmetric;
    if (d.Ip == 0 && d.Id == 0 && offset.x() == 0)
      a.builder.add(elements::PointMass{d.mass}, {at.node}, "point masses");
    else
      a.builder.add(elements::RigidDisk{d.mass, d.Id, d.Ip, offset.x()}, {at.node}, "rigid disks");
    return;
  }
  Mat3 J = d.inertia
               ? *d.inertia
               : elements::skewed_inertia(d.Ip, std::max(d.Id, 0.5 * d.Ip), d.skew, d.skew_phase);
  if (d.inertia && d.skew != 0) {
    a.error("E26",
            fmt::format("{}: skew and a full inertia tensor are two ways to say the same", who),
            "give one of them", d, who);
    return;
  }
  try {
    a.builder.add(elements::RigidBody(d.mass, offset, axes * J * axes.transpose()), {at.node},
                  "rigid bodies");
  } catch (const Error& e) {
    a.error("E24", fmt::format("{}: {}", who, e.what()), {}, d, who);
  }
}

}  // namespace

void add_bodies(Assembly& a) {
  int symmetric = 0;
  for (const model::Disk& d : a.model.disks)
    add_disk(a, d, symmetric);
  if (symmetric > 0)
    a.built.simpler.push_back(
        fmt::format("inertia that turns with the angle of {} disk{}: balanced and symmetric",
                    symmetric, symmetric > 1 ? "s" : ""));
}

}  // namespace whirl::assembly
