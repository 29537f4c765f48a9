#include <meshes/mass_properties.hpp>
#include <core/contract.hpp>

#include <core/rotation.hpp>
#include <model/full_section.hpp>
#include <fmt/format.h>

#include <cmath>

namespace whirl::meshes {
namespace {

/// int A ds, int A s ds, int A s^2 ds, int J ds of a solid frustum.
struct Frustum {
  double V = 0, S = 0, I = 0, J = 0;
  Frustum(double L, double a, double b) {
    V = pi * L / 12 * (a * a + a * b + b * b);
    S = pi * L * L / 48 * (a * a + 2 * a * b + 3 * b * b);
    I = pi * L * L * L / 120 * (a * a + 3 * a * b + 6 * b * b);
    J = pi * L / 160 *
        (a * a * a * a + a * a * a * b + a * a * b * b + a * b * b * b + b * b * b * b);
  }
};

/// Inertia tensor of a point mass at c about the origin.
Mat3 steiner(double m, const Vec3& c) {
  return m * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
}

}  // namespace

Mat3 MassProperties::about_centre() const { return about_origin - steiner(mass, centre()); }

MassProperties& MassProperties::operator+=(const MassProperties& o) {
  mass += o.mass;
  moment += o.moment;
  about_origin += o.about_origin;
  return *this;
}

void MassProperties::add(double m, const Vec3& c, const Mat3& J) {
  mass += m;
  moment += m * c;
  about_origin += J + steiner(m, c);
}

namespace {

/// Of a section that is_full, one metre of it at a fraction of its length: in the axes of its line.
SectionMoments moments_at(const model::Model& m, const model::Section& s, double xi) {
  SectionMoments x(model::full_section(m, s).mass);
  const Mat3 R = rotation::L(Vec3(s.angle() + xi * s.twist(), 0, 0));
  x.centre = R * x.centre;
  x.J = R * x.J * R.transpose();
  return x;
}

/// Gauss points on slices so thin that sines of the twist are exact to 1e-12.
MassProperties full_section_mass(const model::Model& m, const model::Section& s,
                                 const Vec3& left_end) {
  static constexpr double x[] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                                 0.9305681557970263};
  static constexpr double w[] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                                 0.1739274225687269};
  const int n = 1 + static_cast<int>(8.0 * std::abs(s.twist()));
  const double h = s.length / n;
  MassProperties p;
  for (int i = 0; i < 4 * n; ++i) {
    const int stretch = i / 4;
    const double at = (stretch + x[i % 4]) / n;
    const SectionMoments unit = moments_at(m, s, at);
    p.add(w[i % 4] * h * unit.m, left_end + Vec3(at * s.length, 0, 0) + unit.centre,
          w[i % 4] * h * unit.J);
  }
  return p;
}

}  // namespace

MassProperties section_mass(const model::Model& m, const model::Section& s, const Vec3& left_end) {
  if (s.is_full()) return full_section_mass(m, s, left_end);
  const double L = s.length, rho = m.materials.empty() ? 0.0 : m.materials.at(s.material).rho;
  // line integrals about the left end: mass, first and second moment, inertia about y, z and the
  // axis, int yz
  double mass = 0, first = 0, second = 0, about_y = 0, about_z = 0, polar = 0, product = 0;
  if (s.constants) {
    const auto& c = *s.constants;
    mass = c.rhoA * L;
    first = mass * L / 2;
    second = mass * L * L / 3;
    about_y = about_z = c.rhoI * L;
    polar = c.rhoIp * L;
  } else if (s.general) {
    const auto& g = *s.general;
    const double c = std::cos(g.angle), n = std::sin(g.angle);  // about_* refer to global y, z
    mass = rho * g.A * L;
    first = mass * L / 2;
    second = mass * L * L / 3;
    about_y = rho * L * (g.Iy * c * c + g.Iz * n * n);
    about_z = rho * L * (g.Iy * n * n + g.Iz * c * c);
    polar = rho * L * (g.Iy + g.Iz);
    product = rho * L * (g.Iz - g.Iy) * c * n;
    if (s.mean_rotary_inertia) {
      about_y = about_z = 0.5 * polar;
      product = 0;
    }
  } else if (s.od_l > 0 || s.od_r > 0) {
    const Frustum out(L, s.od_l, s.od_r), in(L, s.id_l, s.id_r);
    mass = rho * (out.V - in.V);
    first = rho * (out.S - in.S);
    second = rho * (out.I - in.I);
    polar = rho * (out.J - in.J);
    about_y = about_z = polar / 2;
  }
  if (!s.rotary_inertia && !s.rigid) about_y = about_z = product = 0;
  const double added = s.added_mass_per_length * L;
  mass += added;
  first += added * L / 2;
  second += added * L * L / 3;
  MassProperties p;
  if (!(mass > 0)) return p;
  const double x = first / mass, own = second - mass * x * x;  // about the section's own centre
  Mat3 J = Vec3(polar, own + about_y, own + about_z).asDiagonal();
  J(1, 2) = J(2, 1) = -product;
  p.add(mass, left_end + Vec3(x, 0, 0), J);
  return p;
}

namespace {

/// A section from s0 on of a line along a path: Gauss points on slices of a quarter of a radian,
/// exact to 1e-12 for an arc.
MassProperties mass_along(const model::Model& m, const model::Shaft& shaft,
                          const model::Section& section, double s0) {
  static constexpr double x[] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                                 0.9305681557970263};
  static constexpr double w[] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                                 0.1739274225687269};
  std::vector<double> ends{s0};
  for (const double s : shaft.path.joints())
    if (s > ends.back() && s < s0 + section.length) ends.push_back(s);
  ends.push_back(s0 + section.length);
  MassProperties p;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double whole = ends[k + 1] - ends[k];
    const Vec3 t0 = shaft.path.after(ends[k]).triad.col(0),
               half = shaft.path.after(ends[k] + 0.5 * whole).triad.col(0);
    const int n = 1 + static_cast<int>(8.0 * std::atan2(t0.cross(half).norm(), t0.dot(half)));
    for (int i = 0; i < 4 * n; ++i) {
      const int stretch = i / 4;
      const double h = whole / n, s = ends[k] + (stretch + x[i % 4]) * h,
                   xi = (s - s0) / section.length;
      if (section.is_full()) {
        const SectionMoments unit = moments_at(m, section, xi);
        const Path::Point at = shaft.path.after(s);
        p.add(w[i % 4] * h * unit.m, at.r + at.triad * unit.centre,
              w[i % 4] * h * (at.triad * unit.J * at.triad.transpose()));
        continue;
      }
      model::Section slice = section;  // one metre of what stands there
      slice.od_l = slice.od_r = section.od_l + xi * (section.od_r - section.od_l);
      slice.id_l = slice.id_r = section.id_l + xi * (section.id_r - section.id_l);
      slice.length = 1.0;
      const MassProperties unit = section_mass(m, slice, Vec3(-0.5, 0, 0));
      const Path::Point at = shaft.path.after(s);
      const Mat3 own = unit.about_origin - unit.mass / 12.0 * Mat3(Vec3(0, 1, 1).asDiagonal());
      p.add(w[i % 4] * h * unit.mass, at.r, w[i % 4] * h * (at.triad * own * at.triad.transpose()));
    }
  }
  return p;
}

}  // namespace

MassProperties disk_mass(const model::Disk& d, const Vec3& station) {
  Mat3 J = d.inertia ? *d.inertia : Mat3(Vec3(d.Ip, d.Id, d.Id).asDiagonal());
  if (d.skew != 0) {  // the principal axis leans towards the body angle skew_phase
    const Mat3 R = rotation::L(d.skew * Vec3(0, -std::sin(d.skew_phase), std::cos(d.skew_phase)));
    J = R * J * R.transpose();
  }
  MassProperties p;
  p.add(d.mass, station + d.offset, J);
  return p;
}

MassProperties shaft_mass(const model::Model& m, std::size_t shaft) {
  WHIRL_EXPECTS(shaft < m.shafts.size());
  const model::Shaft& s = m.shafts.at(shaft);
  MassProperties p;
  double x = 0;
  for (const auto& k : s.sections) {
    p += s.path.empty() ? section_mass(m, k, s.origin + Vec3(x, 0, 0)) : mass_along(m, s, k, x);
    x += k.length;
  }
  for (const auto& d : m.disks) {
    if (d.at.shaft != shaft) continue;
    if (s.path.empty()) {
      p += disk_mass(d, s.origin + Vec3(d.at.s, 0, 0));
      continue;
    }
    const Path::Point at = s.path.after(d.at.s);
    const MassProperties own = disk_mass(d, Vec3::Zero());  // in the axes of the line there
    p.add(own.mass, at.r + at.triad * own.centre(),
          at.triad * own.about_centre() * at.triad.transpose());
  }
  for (const auto& u : m.unbalances)
    if (u.at.shaft == shaft) {
      const double now = u.factor ? u.amount * u.factor->at(0).f : u.amount;
      const Vec3 at = u.to ? Vec3(0.5 * (s.position(u.at.s) + s.position(u.to->s)))
                           : s.position(u.at.s),
                 arm = now * Vec3(0, std::cos(u.phase), std::sin(u.phase));
      p.moment += arm;
      p.about_origin +=
          2 * at.dot(arm) * Mat3::Identity() - at * arm.transpose() - arm * at.transpose();
    }
  return p;
}

MassProperties total_mass(const model::Model& m) {
  MassProperties p;
  for (std::size_t k = 0; k < m.shafts.size(); ++k)
    p += shaft_mass(m, k);
  return p;
}

std::string mass_table(const model::Model& m) {
  std::string out = fmt::format("{:<20} {:>13} {:>36} {:>13} {:>13}\n", "shaft", "mass, kg",
                                "centre x, y, z, m", "Ip, kg m2", "Id, kg m2");
  const auto row = [&](const std::string& name, const MassProperties& p) {
    const Vec3 c = p.centre();
    out += fmt::format("{:<20} {:>13.6g} {:>12.6g}{:>12.3g}{:>12.3g} {:>13.6g} {:>13.6g}\n", name,
                       p.mass, c.x(), c.y(), c.z(), p.Ip(), p.Id());
  };
  for (std::size_t k = 0; k < m.shafts.size(); ++k)
    row(m.shafts[k].name, shaft_mass(m, k));
  if (m.shafts.size() > 1) row("total", total_mass(m));
  return out;
}

}  // namespace whirl::meshes
