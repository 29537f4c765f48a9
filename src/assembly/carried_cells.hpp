// Cells of oil as elements between nodes, for all films that conserve mass. Internal to src/assembly.
#pragma once
#include <assembly/support_parts.hpp>
#include <elements/films/pad_cell.hpp>
#include <elements/films/tilting_pad.hpp>

#include <algorithm>
#include <memory>
#include <string>

namespace whirl::assembly {

/// A pad with the nodes of its cells, block by block of those at one angle.
template <class Pad>
struct PadCells {
  static constexpr Index blocks = Pad::rows_in_time / Pad::rows_of_node;
  std::shared_ptr<const Pad> pad;
  std::vector<Index> oil;

  /// Of the cells before, the next ones, the other block and the cells themselves, which stand for those
  /// beyond the ends.
  std::array<Index, at(2 + blocks)> around(Index i, Index block) const {
    const Index last = pad->cells() - 1;
    const auto node = [&](Index cell, Index of) { return oil[at(cell * blocks + of)]; };
    std::array<Index, at(2 + blocks)> out;
    out[0] = node(std::max<Index>(i - 1, 0), block);
    out[1] = node(std::min(i + 1, last), block);
    if constexpr (blocks > 1) out[2] = node(i, 1 - block);
    out.back() = node(i, block);
    return out;
  }
};

/// Scalar nodes for the oil of a bearing's pads, cells[k] of pad k with as many rows each, in all steps of
/// a deck in which one follows it; held where this one does not. Empty: it does not, and the film is that
/// of the momentary state.
std::vector<std::vector<Index>> add_oil_nodes(Assembly& a, const model::Bearing& b,
                                              const std::vector<Index>& cells, int rows);

template <class Pad>
std::vector<PadCells<Pad>> add_oil_of(Assembly& a, const model::Bearing& b,
                                      const std::vector<std::shared_ptr<const Pad>>& pads) {
  std::vector<Index> cells;
  cells.reserve(pads.size());
  for (const auto& pad : pads)
    cells.push_back(pad->cells() * PadCells<Pad>::blocks);
  const auto nodes = add_oil_nodes(a, b, cells, Pad::rows_of_node);
  std::vector<PadCells<Pad>> out;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    out.push_back({pads[k], nodes[k]});
  return out;
}

/// "40 x 6 cells", of all pads.
template <class Pad>
std::string grid_text(const std::vector<PadCells<Pad>>& pads) {
  Index columns = 0;
  for (const PadCells<Pad>& p : pads)
    columns += p.pad->cells();
  return std::to_string(columns) + " x " + std::to_string(Pad::rows_in_time) + " cells";
}

/// Their unknowns, in the order of CellsOnNodes::balanced.
template <class Pad>
std::vector<Index> oil_unknowns(const std::vector<PadCells<Pad>>& pads) {
  std::vector<Index> out;
  for (const PadCells<Pad>& p : pads)
    for (const Index node : p.oil)
      for (Index row = 0; row < Pad::rows_of_node; ++row)
        out.push_back(6 * node + row);
  return out;
}

/// The cells of pad k of a film on a grid along the axis too: six rows, of a fourth of the columns of
/// statics. @pre film.grid.
std::shared_ptr<const elements::CarriedGrid> grid_in_time(const elements::FiniteJournal& film,
                                                          std::size_t k);

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
      decltype(kernels_[k].full(states(k, node))) q;
      q.fill(nan);
      kernels_[k].relax(states(k, node), {}, q);
      out.insert(out.end(), q.begin(), q.end());
    }
    return out;
  }
  /// What they are with all cells full.
  std::vector<double> full(const NodeAt& node) const {
    std::vector<double> out;
    for (std::size_t k = 0; k < size(); ++k) {
      const auto q = kernels_[k].full(states(k, node));
      out.insert(out.end(), q.begin(), q.end());
    }
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
