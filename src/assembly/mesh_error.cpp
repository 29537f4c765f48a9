#include <assembly/mesh_error.hpp>
#include <assembly/element_section.hpp>
#include <elements/shaft/shaft_beam.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <map>

namespace whirl::assembly {
namespace {

constexpr int parts = 4;  // of an element: leaves 1/4^4 of its error and less

using elements::ShaftElementConstants;

template <int N>
using MatC = Eigen::Matrix<Complex, N, N>;

/// Dynamic stiffness of bending on (r1, d1, r2, d2); couple = -+ lambda Omega of the header, times
/// i.
MatC<4> bending(const ShaftElementConstants& c, const Matrix<4>& K4, Complex lambda,
                Complex couple) {
  return K4.cast<Complex>() + lambda * lambda * c.M4.cast<Complex>() +
         couple * c.G4.cast<Complex>();
}

MatC<2> twist(const ShaftElementConstants& c, Complex lambda) {
  const Matrix<2> spring = c.GJ_l * (Matrix<2>() << 1, -1, -1, 1).finished();
  return spring.cast<Complex>() + lambda * lambda * c.polar.cast<Complex>();
}

MatC<2> axial(const ShaftElementConstants& c, Complex lambda) {
  const Matrix<2> spring = c.EA_l * (Matrix<2>() << 1, -1, -1, 1).finished();
  const Matrix<2> mass = c.M4({0, 2}, {0, 2});
  return spring.cast<Complex>() + lambda * lambda * mass.cast<Complex>();
}

/// A chain of `parts` pieces with W unknowns a joint, condensed to its ends.
template <int W>
MatC<2 * W> condensed(const std::array<MatC<2 * W>, parts>& piece) {
  constexpr int all = W * (parts + 1), inside = W * (parts - 1);
  MatC<all> chain = MatC<all>::Zero();
  for (int k = 0; k < parts; ++k)
    chain.template block<2 * W, 2 * W>(W * k, W * k) += piece[static_cast<std::size_t>(k)];
  const auto inner = chain.template block<inside, inside>(W, W);
  Eigen::Matrix<Complex, inside, 2 * W> to_ends;
  to_ends << chain.template block<inside, W>(W, 0), chain.template block<inside, W>(W, all - W);
  Eigen::Matrix<Complex, 2 * W, inside> from_ends;
  from_ends << chain.template block<W, inside>(0, W), chain.template block<W, inside>(all - W, W);
  MatC<2 * W> ends;
  ends << chain.template block<W, W>(0, 0), chain.template block<W, W>(0, all - W),
      chain.template block<W, W>(all - W, 0), chain.template block<W, W>(all - W, all - W);
  const MatC<inside> held = inner;
  return ends - from_ends * held.partialPivLu().solve(to_ends);
}

}  // namespace

struct MeshError::Element {
  Index line = 0;
  std::array<Index, 2> node{};
  ShaftElementConstants c;                          ///< as assembled
  std::array<ShaftElementConstants, parts> pieces;  ///< between its end points
  Matrix<4> K4;                                     ///< on node coordinates
  std::array<Matrix<4>, parts> piece_K4;

  Complex defect(Complex lambda, double spin, const VecXc& x) const;

 private:
  Complex bending_defect(Complex lambda, Complex couple, const Eigen::Vector4cd& q) const;
};

Complex MeshError::Element::bending_defect(Complex lambda, Complex couple,
                                           const Eigen::Vector4cd& q) const {
  std::array<MatC<4>, parts> piece;
  for (std::size_t k = 0; k < parts; ++k)
    piece[k] = bending(pieces[k], piece_K4[k], lambda, couple);
  Matrix<4> to_ends = Matrix<4>::Identity();  // r = x + o d
  to_ends(0, 1) = c.o1;
  to_ends(2, 3) = c.o2;
  const Eigen::Vector4cd e = to_ends.cast<Complex>() * q;
  return e.dot(condensed<2>(piece) * e) - q.dot(bending(c, K4, lambda, couple) * q);
}

Complex MeshError::Element::defect(Complex lambda, double spin, const VecXc& x) const {
  const auto at = [&](int end, int unknown) {
    return x[6 * node[static_cast<std::size_t>(end)] + unknown];
  };
  // Lateral displacement and director, d - e = gamma x e = (gamma3, -gamma2).
  const Eigen::Vector4cd y(at(0, 1), at(0, 5), at(1, 1), at(1, 5));
  const Eigen::Vector4cd z(at(0, 2), -at(0, 4), at(1, 2), -at(1, 4));
  const Complex i(0, 1);
  const Complex couple = i * lambda * spin;
  Complex sum = 0.5 * (bending_defect(lambda, -couple, y + i * z) +
                       bending_defect(lambda, couple, y - i * z));
  std::array<MatC<2>, parts> twists, stretches;
  for (std::size_t k = 0; k < parts; ++k) {
    twists[k] = twist(pieces[k], lambda);
    stretches[k] = axial(pieces[k], lambda);
  }
  const Eigen::Vector2cd phi(at(0, 3), at(1, 3)), u(at(0, 0), at(1, 0));
  sum += phi.dot((condensed<1>(twists) - twist(c, lambda)) * phi);
  sum += u.dot((condensed<1>(stretches) - axial(c, lambda)) * u);
  return sum;
}

namespace {

/// The parts of an element, made once for all elements of a section that are alike.
class Pieces {
 public:
  using Set = std::array<ShaftElementConstants, parts>;
  const Set& of(const model::Model& m, const meshes::Element& e) {
    const elements::ElementSection section = element_section(m, e);
    const double l = e.s2 - e.s1;
    const bool alike = last_ && section.uniform() && last_->line == e.line &&
                       last_->section == e.section && std::abs(length_ - l) < 1e-9 * l;
    if (!alike)
      for (int k = 0; k < parts; ++k)
        set_[static_cast<std::size_t>(k)] = elements::make_shaft_constants(
            section.part(double(k) / parts, double(k + 1) / parts), l / parts);
    last_ = &e;
    length_ = l;
    return set_;
  }

 private:
  const meshes::Element* last_ = nullptr;
  double length_ = 0;
  Set set_;
};

/// Constants of the assembled elements, by their nodes.
template <bool Offsets>
void collect(const system::System& s,
             std::map<std::array<Index, 2>, const ShaftElementConstants*>& out) {
  const auto* batch = s.batch<elements::ShaftBeam<Offsets>>();
  if (!batch) return;
  for (std::size_t k = 0; k < batch->count(); ++k)
    out[batch->nodes()[k]] = &batch->elements()[k].c;
}

}  // namespace

MeshError::MeshError(const model::Model& m, const meshes::Mesh& mesh, const Built& built) {
  std::map<std::array<Index, 2>, const ShaftElementConstants*> assembled;
  collect<false>(built.system, assembled);
  collect<true>(built.system, assembled);
  Pieces pieces;
  for (const meshes::Element& e : mesh.elements) {
    const model::Shaft& shaft = m.shafts[static_cast<std::size_t>(e.line)];
    const std::array<Index, 2> node{e.left.node, e.right.node};
    const auto found = assembled.find(node);
    if (found == assembled.end() || !shaft.path.empty()) {
      if (left_out_.empty() || left_out_.back() != shaft.name) left_out_.push_back(shaft.name);
      continue;
    }
    Element x;
    x.line = e.line;
    x.node = node;
    x.c = *found->second;
    x.pieces = pieces.of(m, e);
    x.K4 = elements::bending_stiffness(x.c);
    for (std::size_t k = 0; k < parts; ++k)
      x.piece_K4[k] = elements::bending_stiffness(x.pieces[k]);
    elements_.push_back(x);
  }
}

MeshError::~MeshError() = default;
MeshError::MeshError(MeshError&&) noexcept = default;
MeshError& MeshError::operator=(MeshError&&) noexcept = default;

Complex MeshError::defect(Complex lambda, const VecXc& x, std::span<const double> spin) const {
  Complex sum = 0;
  for (const Element& e : elements_)
    sum += e.defect(lambda, spin[static_cast<std::size_t>(e.line)], x);
  return sum;
}

}  // namespace whirl::assembly
