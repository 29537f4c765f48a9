#include <assembly/mesh_error.hpp>
#include <assembly/element_section.hpp>
#include <elements/shaft/general_beam.hpp>
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

/// What is the same for elements that are alike.
struct MeshError::Kind {
  ShaftElementConstants c;                          ///< as assembled
  std::array<ShaftElementConstants, parts> pieces;  ///< between its end points
  Matrix<4> K4;                                     ///< on node coordinates
  std::array<Matrix<4>, parts> piece_K4;

  MatC<4> bending_defect(Complex lambda, Complex couple) const;
  Defects defects(Complex lambda, double spin) const;
};

/// dD of an element at one lambda and spin.
struct MeshError::Defects {
  MatC<4> against, with;  ///< of y + i z and y - i z
  MatC<2> twist, stretch;
};

struct MeshError::Element {
  Index line = 0;
  std::array<Index, 2> node{};
  std::size_t kind = 0;

  Complex defect(const Defects& of, const VecXc& x) const;
};

MatC<4> MeshError::Kind::bending_defect(Complex lambda, Complex couple) const {
  std::array<MatC<4>, parts> piece;
  for (std::size_t k = 0; k < parts; ++k)
    piece[k] = bending(pieces[k], piece_K4[k], lambda, couple);
  Matrix<4> to_ends = Matrix<4>::Identity();  // r = x + o d
  to_ends(0, 1) = c.o1;
  to_ends(2, 3) = c.o2;
  const MatC<4> ends = to_ends.cast<Complex>();
  return ends.transpose() * condensed<2>(piece) * ends - bending(c, K4, lambda, couple);
}

MeshError::Defects MeshError::Kind::defects(Complex lambda, double spin) const {
  const Complex couple = Complex(0, 1) * lambda * spin;
  std::array<MatC<2>, parts> twists, stretches;
  for (std::size_t k = 0; k < parts; ++k) {
    twists[k] = twist(pieces[k], lambda);
    stretches[k] = axial(pieces[k], lambda);
  }
  return {bending_defect(lambda, -couple), bending_defect(lambda, couple),
          condensed<1>(twists) - assembly::twist(c, lambda),
          condensed<1>(stretches) - axial(c, lambda)};
}

Complex MeshError::Element::defect(const Defects& of, const VecXc& x) const {
  const auto at = [&](int end, int unknown) {
    return x[6 * node[static_cast<std::size_t>(end)] + unknown];
  };
  // Lateral displacement and director, d - e = gamma x e = (gamma3, -gamma2).
  const Eigen::Vector4cd y(at(0, 1), at(0, 5), at(1, 1), at(1, 5));
  const Eigen::Vector4cd z(at(0, 2), -at(0, 4), at(1, 2), -at(1, 4));
  const Complex i(0, 1);
  const Eigen::Vector4cd forward = y + i * z, backward = y - i * z;
  Complex sum = 0.5 * (forward.dot(of.against * forward) + backward.dot(of.with * backward));
  const Eigen::Vector2cd phi(at(0, 3), at(1, 3)), u(at(0, 0), at(1, 0));
  sum += phi.dot(of.twist * phi);
  sum += u.dot(of.stretch * u);
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
    made_ = !alike;
    return set_;
  }
  /// The last element was not like the one before.
  bool made() const { return made_; }

 private:
  const meshes::Element* last_ = nullptr;
  double length_ = 0;
  bool made_ = false;
  Set set_;
};

/// But for rounding.
template <class A>
bool same(const A& a, const A& b) {
  constexpr double rounding = 1e-11;
  return (a - b).cwiseAbs().maxCoeff() <= rounding * a.cwiseAbs().maxCoeff();
}

bool alike(const ShaftElementConstants& a, const ShaftElementConstants& b) {
  using Springs = Eigen::Array<double, 1, 1>;
  return a.o1 == b.o1 && a.o2 == b.o2 && same(Springs(a.EA_l), Springs(b.EA_l)) &&
         same(Springs(a.GJ_l), Springs(b.GJ_l)) && same(a.M4, b.M4) && same(a.G4, b.G4) &&
         same(a.polar, b.polar);
}

/// Constants of the assembled elements, by their nodes.
template <bool Offsets>
void collect(const system::System& s,
             std::map<std::array<Index, 2>, const ShaftElementConstants*>& out) {
  const auto* batch = s.batch<elements::ShaftBeam<Offsets>>();
  if (!batch) return;
  for (std::size_t k = 0; k < batch->count(); ++k)
    out[batch->nodes()[k]] = &batch->elements()[k].c;
}

/// Elements of a bowed shaft with the mass that is assembled: against their length, which counts, straight.
std::map<std::array<Index, 2>, ShaftElementConstants> bowed_elements(const model::Model& m,
                                                                     const meshes::Mesh& mesh,
                                                                     const system::System& s) {
  std::map<std::array<Index, 2>, ShaftElementConstants> out;
  const auto* batch = s.batch<elements::GeneralBeam>();
  if (!batch) return out;
  std::map<std::array<Index, 2>, const elements::GeneralBeamConstants*> assembled;
  for (std::size_t k = 0; k < batch->count(); ++k)
    assembled[batch->nodes()[k]] = &batch->elements()[k].c;
  for (const meshes::Element& e : mesh.elements) {
    const model::Shaft& shaft = m.shafts[static_cast<std::size_t>(e.line)];
    const auto found = assembled.find({e.left.node, e.right.node});
    if (found == assembled.end() || !shaft.bow.any() || shaft.sections[e.section].general) continue;
    ShaftElementConstants c = element_constants(m, e);
    if (c.o1 == 0.0 && c.o2 == 0.0) c.M4 = found->second->M4;
    out[found->first] = c;
  }
  return out;
}

}  // namespace

MeshError::MeshError(const model::Model& m, const meshes::Mesh& mesh, const Built& built) {
  std::map<std::array<Index, 2>, const ShaftElementConstants*> assembled;
  collect<false>(built.system, assembled);
  collect<true>(built.system, assembled);
  const auto bowed = bowed_elements(m, mesh, built.system);
  for (const auto& [nodes, constants] : bowed)
    assembled[nodes] = &constants;
  Pieces pieces;
  for (const meshes::Element& e : mesh.elements) {
    const model::Shaft& shaft = m.shafts[static_cast<std::size_t>(e.line)];
    const std::array<Index, 2> node{e.left.node, e.right.node};
    const auto found = assembled.find(node);
    if (found == assembled.end() || !shaft.path.empty()) {
      if (left_out_.empty() || left_out_.back() != shaft.name) left_out_.push_back(shaft.name);
      continue;
    }
    const Pieces::Set& set = pieces.of(m, e);
    const ShaftElementConstants& c = *found->second;
    if (pieces.made() || kinds_.empty() || !alike(kinds_.back().c, c)) add_kind(c, set);
    elements_.push_back({e.line, node, kinds_.size() - 1});
  }
}

void MeshError::add_kind(const ShaftElementConstants& c,
                         std::span<const ShaftElementConstants> pieces) {
  Kind& kind = kinds_.emplace_back();
  kind.c = c;
  kind.K4 = elements::bending_stiffness(c);
  for (std::size_t k = 0; k < parts; ++k) {
    kind.pieces[k] = pieces[k];
    kind.piece_K4[k] = elements::bending_stiffness(pieces[k]);
  }
}

MeshError::~MeshError() = default;
MeshError::MeshError(MeshError&&) noexcept = default;
MeshError& MeshError::operator=(MeshError&&) noexcept = default;

Complex MeshError::defect(Complex lambda, const VecXc& x, std::span<const double> spin) const {
  Complex sum = 0;
  const Element* last = nullptr;
  Defects now;
  for (const Element& e : elements_) {
    if (!last || last->kind != e.kind || last->line != e.line)
      now = kinds_[e.kind].defects(lambda, spin[static_cast<std::size_t>(e.line)]);
    sum += e.defect(now, x);
    last = &e;
  }
  return sum;
}

}  // namespace whirl::assembly
