// What the finite length of the shaft elements does to a small motion, without solving on a finer
// mesh.
//
// A motion x exp(lambda t) of the assembled system satisfies D(lambda) x = 0 with the dynamic
// stiffness D = K + lambda C + lambda^2 M. Were every element divided into parts and these
// condensed to its ends at lambda (which loses nothing), D would be D + dD, dD element by element;
// to first order the root moves by
//   d lambda = - y^H dD x / y^H (2 lambda M + C) x,
// y the left vector, for which x stands (exact for conservative rotors, gyroscopic or not). So one
// product of the shape with dD says what a mesh of elements a fourth as long would give: the error
// of the mesh to first order. Measured: within a quarter on conservative rotors; from 2.4 times too
// small to 5 times too large where films or internal damping make y another vector. Bending in two
// planes goes by q = y +- i z, for which the gyroscopic couples read -+ i lambda Omega G; twist and
// axial motion are chains by themselves.
//
// Not judged: general sections, lines with bends (left_out()).
#pragma once
#include <assembly/build_system.hpp>
#include <elements/shaft/shaft_constants.hpp>
#include <span>
#include <string>
#include <vector>

namespace whirl::assembly {

class MeshError {
 public:
  MeshError(const model::Model& m, const meshes::Mesh& mesh, const Built& built);
  ~MeshError();
  MeshError(MeshError&&) noexcept;
  MeshError& operator=(MeshError&&) noexcept;

  /// x^H dD(lambda) x. x: amplitudes of the system's unknowns, (u, phi, gamma) a node; lambda: 1/s;
  /// spin: of each line, rad/s.
  Complex defect(Complex lambda, const VecXc& x, std::span<const double> spin) const;
  /// Shafts with parts that are not judged.
  const std::vector<std::string>& left_out() const { return left_out_; }
  bool empty() const { return elements_.empty(); }

 private:
  struct Kind;
  struct Defects;
  struct Element;
  void add_kind(const elements::ShaftElementConstants& c,
                std::span<const elements::ShaftElementConstants> pieces);
  std::vector<Kind> kinds_;
  std::vector<Element> elements_;
  std::vector<std::string> left_out_;
};

}  // namespace whirl::assembly
