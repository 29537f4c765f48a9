// Small models for the tests of meshes and assembly.
#pragma once
#include <model/model.hpp>
#include <string>

namespace whirl::test {

inline std::size_t S(Index i) { return static_cast<std::size_t>(i); }

inline model::Material steel() {
  model::Material s;
  s.name = "steel";
  s.E = 2.1e11;
  s.nu = 0.3;
  s.G = 2.1e11 / 2.6;
  s.rho = 7850;
  return s;
}

inline model::Section cylinder(std::string name, double length, double od, double id = 0,
                               int elements = 1) {
  model::Section s;
  s.name = std::move(name);
  s.length = length;
  s.od_l = s.od_r = od;
  s.id_l = s.id_r = id;
  s.min_elements = elements;
  return s;
}

inline model::Section rigid(std::string name, double length, double od = 0) {
  model::Section s = cylinder(std::move(name), length, od);
  s.rigid = true;
  return s;
}

inline model::Location place(double s, std::size_t shaft = 0) {
  model::Location l;
  l.shaft = shaft;
  l.s = s;
  return l;
}

template <class T>
T named(std::string name, double s, std::size_t shaft = 0) {
  T x;
  x.name = std::move(name);
  x.at = place(s, shaft);
  return x;
}

inline model::Disk disk(std::string name, double s, double mass, double Ip, double Id,
                        std::size_t shaft = 0) {
  auto d = named<model::Disk>(std::move(name), s, shaft);
  d.mass = mass;
  d.Ip = Ip;
  d.Id = Id;
  return d;
}

/// Isotropic spring-damper to ground in y and z.
inline model::Bearing spring(std::string name, double s, double k, double c = 0,
                             std::size_t shaft = 0) {
  auto b = named<model::Bearing>(std::move(name), s, shaft);
  model::LinearBearing law;
  law.K(1, 1) = law.K(2, 2) = k;
  law.C(1, 1) = law.C(2, 2) = c;
  b.law = law;
  return b;
}

inline model::Bearing held(std::string name, double s, std::array<bool, 6> directions,
                           std::size_t shaft = 0) {
  auto b = named<model::Bearing>(std::move(name), s, shaft);
  b.law = model::RigidSupport{directions};
  return b;
}

inline model::Model one_shaft(std::vector<model::Section> sections, std::string name = "rotor") {
  model::Model m;
  m.materials.push_back(steel());
  model::Shaft s;
  s.name = std::move(name);
  s.sections = std::move(sections);
  m.shafts.push_back(std::move(s));
  return m;
}

}  // namespace whirl::test
