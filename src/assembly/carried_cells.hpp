// Cells of oil as elements between nodes, for all films that conserve mass. Internal to src/assembly.
#pragma once
#include <assembly/support_parts.hpp>
#include <elements/films/carried_film.hpp>
#include <elements/films/tilting_pad.hpp>

#include <algorithm>
#include <memory>

namespace whirl::assembly {

/// A pad with the nodes of its cells.
struct PadCells {
  std::shared_ptr<const elements::CarriedPad> pad;
  std::vector<Index> oil;

  /// Of the cell before, the next one and the cell itself, which stands for those beyond the ends.
  std::array<Index, 3> around(Index i) const {
    const Index last = pad->cells() - 1;
    return {oil[at(std::max<Index>(i - 1, 0))], oil[at(std::min(i + 1, last))], oil[at(i)]};
  }
};

/// Scalar nodes for the oil of a bearing's pads, in all steps of a deck in which one follows it; held
/// where this one does not. Empty: it does not, and the film is that of the momentary state.
std::vector<PadCells> add_oil_nodes(
    Assembly& a, const model::Bearing& b,
    const std::vector<std::shared_ptr<const elements::CarriedPad>>& pads);

/// The cells of a bearing with the nodes they stand between.
template <class Kernel>
class CellsOnNodes {
 public:
  using Between = std::array<Index, Kernel::n_nodes>;

  void add(const Kernel& cell, const Between& nodes) {
    kernels_.push_back(cell);
    nodes_.push_back(nodes);
  }
  std::size_t size() const { return kernels_.size(); }
  const Kernel& kernel(std::size_t k) const { return kernels_[k]; }
  const Between& nodes(std::size_t k) const { return nodes_[k]; }
  /// (F, T_0, T_1) of all cells.
  Vector<4> load(const NodeAt& node, const system::Context& c) const {
    Vector<4> sum = Vector<4>::Zero();
    for (std::size_t k = 0; k < size(); ++k)
      sum += kernels_[k].load(states(k, node), c);
    return sum;
  }
  Vector<7> on_shaft(const NodeAt& node, const system::Context& c) const {
    system::ForceX<Kernel::size> f = system::ForceX<Kernel::size>::Zero();
    for (std::size_t k = 0; k < size(); ++k)
      kernels_[k].add_force(states(k, node), c, f);
    return f.template head<7>();
  }
  /// What the cells' unknowns are with all in balance; NaN where there is none.
  std::vector<double> balanced(const NodeAt& node) const {
    std::vector<double> out;
    for (std::size_t k = 0; k < size(); ++k) {
      std::array<double, 1> q{nan};
      kernels_[k].relax(states(k, node), {}, q);
      out.push_back(q[0]);
    }
    return out;
  }
  /// What they are with all cells full.
  std::vector<double> full(const NodeAt& node) const {
    std::vector<double> out;
    for (std::size_t k = 0; k < size(); ++k)
      out.push_back(kernels_[k].full(states(k, node)));
    return out;
  }
  typename Kernel::Nodes states(std::size_t k, const NodeAt& node) const {
    typename Kernel::Nodes x;
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = &node(nodes_[k][i]);
    return x;
  }

 private:
  std::vector<Kernel> kernels_;
  std::vector<Between> nodes_;
};

/// Tilting pads with the cells of their films, where the step follows the oil; false: it does not.
/// unknowns: scalar nodes of each pad (supports_pad_cells.cpp).
template <bool Pressed, bool Offsets>
bool add_pad_cells(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                   const std::vector<elements::TiltingPad>& pads,
                   const std::vector<std::vector<Index>>& unknowns);

/// The cells as terms of the system, and what they give to the shaft.
template <class Kernel>
void add_cell_terms(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                    const std::shared_ptr<const CellsOnNodes<Kernel>>& cells, const char* kind) {
  auto& terms = a.built.support_terms[number_of(a, b)];
  for (std::size_t k = 0; k < cells->size(); ++k)
    terms.push_back(a.builder.add(cells->kernel(k), cells->nodes(k), kind));
  terms.erase(std::unique(terms.begin(), terms.end()), terms.end());
  a.built.support_forces.push_back(
      {b.name, [cells](const NodeAt& node, const system::Context& c, const ReactionAt&) {
         const Vector<4> z = cells->load(node, c);
         return Vec3(0, z[0], z[1]);
       }});
  a.built.support_forces.back().moment =
      [cells, place = n.shaft](const NodeAt& node, const system::Context& c, const ReactionAt&) {
        return moment_about_place(node(place.node), cells->on_shaft(node, c), place.offset);
      };
}

}  // namespace whirl::assembly
