// Rotors for tests, built from elements directly.
#pragma once
#include <elements/supports/linear_bearing.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/shaft_damping.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <elements/loads/unbalance.hpp>
#include <system/system.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace whirl::tests {

inline elements::ElementSection cylinder(double d, double E, double G, double rho, double bore = 0,
                                         elements::ShearRule shear = elements::ShearRule::cowper) {
  elements::ElementSection s;
  s.od1 = s.od2 = s.mass_od1 = s.mass_od2 = d;
  s.id1 = s.id2 = s.mass_id1 = s.mass_id2 = bore;
  s.E = E;
  s.G = G;
  s.rho = rho;
  s.shear = shear;
  return s;
}

inline elements::ElementSection constants(double EA, double kGA, double GJ, double EI, double rhoA,
                                          double rhoI = 0, double rhoIp = 0) {
  elements::ElementSection s;
  s.constants = true;
  s.given = {EA, kGA, GJ, EI, rhoA, rhoI, rhoIp};
  return s;
}

/// A shaft along +x from x = 0, grown section by section.
struct Rotor {
  system::Builder b;
  Index line;
  std::vector<double> x;  ///< of the nodes
  std::vector<Index> node;
  std::vector<elements::ShaftElementConstants> element;
  double preload = 0;  ///< N, tension, of the elements added next

  explicit Rotor(const std::string& name = "rotor") : line(b.add_line(name)) { add_node(0); }
  Index add_node(double position) {
    x.push_back(position);
    node.push_back(b.add_node({Vec3(position, 0, 0), line,
                               "node " + std::to_string(node.size()) + " of " + "the shaft"}));
    return node.back();
  }
  Rotor& add_shaft(const elements::ElementSection& s, double length, int n = 1,
                   elements::MassKind mass = elements::MassKind::corrected) {
    const double x0 = x.back();
    for (int i = 1; i <= n; ++i) {
      const elements::ElementSection part = s.constants ? s : s.part((i - 1.0) / n, (i + 0.0) / n);
      element.push_back(elements::make_shaft_constants(part, length / n, 0, 0, mass));
      add_node(x0 + length * i / n);
      elements::ShaftBeam<false> beam(element.back(), Vec3::UnitX());
      beam.preload = preload;
      b.add(beam, {node[node.size() - 2], node.back()}, "shaft elements");
    }
    return *this;
  }
  Index at(double position) const {
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::abs(x[i] - position) < 1e-9) return node[i];
    throw std::out_of_range("no node there");
  }
  Rotor& add_disk(double position, double m, double Id, double Ip) {
    b.add(elements::RigidDisk{m, Id, Ip, 0}, {at(position)}, "disks");
    return *this;
  }
  /// Steel-like disk by size: m = rho pi/4 (od^2 - id^2) w, Id = m (3 (od^2 + id^2) + 4 w^2)/48, Ip
  /// = m (od^2 + id^2)/8.
  Rotor& add_disk_of_size(double position, double width, double od, double id, double rho) {
    const double m = rho * pi / 4 * (od * od - id * id) * width, s = od * od + id * id;
    return add_disk(position, m, m * (3 * s + 4 * width * width) / 48, m * s / 8);
  }
  Rotor& add_bearing(double position, double kyy, double kzz, double cyy = 0, double czz = 0,
                     double kyz = 0, double kzy = 0) {
    elements::TranslationalBearing t;
    t.K(1, 1) = kyy;
    t.K(2, 2) = kzz;
    t.K(1, 2) = kyz;
    t.K(2, 1) = kzy;
    t.C(1, 1) = cyy;
    t.C(2, 2) = czz;
    b.add(t, {at(position), b.add_ground(Vec3(position, 0, 0), "ground")}, "bearings");
    return *this;
  }
  /// Holds y, z, and the axial motion as well when asked.
  Rotor& pin(double position, bool axial = false) {
    for (int c = axial ? 0 : 1; c < 3; ++c)
      b.hold(at(position), c);
    return *this;
  }
  Rotor& hold_axially(double position) {
    b.hold(at(position), system::ux);
    return *this;
  }
  Rotor& clamp(double position) {
    for (int c = 0; c < 6; ++c)
      b.hold(at(position), c);
    return *this;
  }
  Rotor& add_unbalance(double position, double me, double phase = 0) {
    b.add(elements::UnbalanceMass(me, phase), {at(position)}, "unbalance");
    return *this;
  }
  /// Stiffness-proportional damping of all elements so far.
  template <bool Rotating>
  Rotor& add_shaft_damping(double beta) {
    for (std::size_t i = 0; i < element.size(); ++i)
      b.add(elements::ShaftDamping<Rotating>(element[i], Vec3::UnitX(), beta, beta, beta),
            {node[i], node[i + 1]}, "damping");
    return *this;
  }
};

/// Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines (2010), example 5.9.1: two disks on
/// a 1.5 m shaft.
struct TwoDisk : Rotor {
  TwoDisk(int elements, double ky = 1e6, double kz = 1e6, double c = 0,
          elements::MassKind mass = elements::MassKind::corrected) {
    add_shaft(cylinder(0.05, 2.11e11, 8.12e10, 7810), 1.5, elements, mass);
    add_disk_of_size(0.5, 0.07, 0.28, 0.05, 7810).add_disk_of_size(1.0, 0.07, 0.35, 0.05, 7810);
    add_bearing(0, ky, kz, c, c).add_bearing(1.5, ky, kz, c, c);
    hold_axially(0);
  }
};

}  // namespace whirl::tests
