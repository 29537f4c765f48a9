// The cells of tilting pads whose films conserve mass, in a motion at large.
#include <assembly/carried_cells.hpp>
#include <elements/films/tilting_cells.hpp>

#include <cmath>

namespace whirl::assembly {

/// Pads and cells of a bearing with the nodes they stand between.
template <class Oil, bool Pressed, bool Offsets>
class PadsWithCells {
 public:
  using Rest = std::shared_ptr<const elements::PadAtRest<Oil>>;
  using Mount = elements::PadMount<Oil, Pressed, Offsets>;
  using Cell = elements::TiltingCell<Oil, Pressed, Offsets>;
  using Cells = CellsOnNodes<Cell>;

  PadsWithCells(const meshes::BearingNodes& n, const std::vector<Rest>& rests,
                const std::vector<PadCells<Oil>>& oil,
                const std::vector<std::vector<Index>>& unknowns)
      : ends_{n.shaft.node, n.other.node},
        offset_{n.shaft.offset, n.other.offset},
        rests_(rests),
        unknowns_(unknowns),
        cells_(std::make_shared<Cells>()) {
    for (std::size_t k = 0; k < rests.size(); ++k)
      for (Index i = 0; i < oil[k].pad->cells(); ++i)
        for (Index block = 0; block < PadCells<Oil>::blocks; ++block) {
          typename Cells::Between nodes;
          const auto pad_nodes = mount_nodes(k);
          std::copy(pad_nodes.begin(), pad_nodes.end(), nodes.begin());
          const auto around = oil[k].around(i, block);
          std::copy(around.begin(), around.end(), nodes.begin() + pad_nodes.size());
          cells_->add(Cell::of(rests[k], i, offset_, block), nodes);
        }
  }
  std::shared_ptr<const Cells> cells() const { return cells_; }
  std::size_t pads() const { return rests_.size(); }
  Mount mount(std::size_t k) const { return {rests_[k], offset_}; }
  std::array<Index, Mount::n_nodes> mount_nodes(std::size_t k) const {
    std::array<Index, Mount::n_nodes> out{ends_[0], ends_[1]};
    std::copy(unknowns_[k].begin(), unknowns_[k].end(), out.begin() + 2);
    return out;
  }
  /// Oil in balance with the journal where it is and with what of each pad follows at once.
  CarriedOil::Balance balanced(const NodeAt& node) const {
    CarriedOil::Balance out;
    for (std::size_t k = 0; k < pads(); ++k) {
      const typename Mount::Nodes x = mount_states(k, node);
      const elements::LateralMotion journal = mount(k).journal(x);
      const Vec2 q = rests_[k]->followed(journal, mount(k).place(x));
      out.followed.insert(out.followed.end(), q.data(), q.data() + Mount::own);
      const Oil& oil = *rests_[k]->oil();
      const elements::LateralMotion seen = rests_[k]->pad().seen(journal, q, Vec2::Zero());
      const std::vector<double> content = oil.balanced(seen.r, seen.spin - seen.housing_spin);
      for (Index i = 0; i < oil.cells(); ++i)
        for (Index row = 0; row < oil.rows(); ++row)
          out.content.push_back(content[at(i * oil.rows() + row)] - oil.reference(i, row));
    }
    return out;
  }

  /// How far the films stand from those of statics, with pads as balanced() has them.
  double off_statics(const NodeAt& node) const {
    Vec2 off = Vec2::Zero(), whole = Vec2::Zero();
    for (std::size_t k = 0; k < pads(); ++k) {
      const typename Mount::Nodes x = mount_states(k, node);
      const elements::LateralMotion journal = mount(k).journal(x);
      const elements::TiltingPad& pad = rests_[k]->pad();
      const elements::LateralMotion seen =
          pad.seen(journal, rests_[k]->followed(journal, mount(k).place(x)), Vec2::Zero());
      elements::FilmForce exact;
      pad.film.evaluate(elements::FilmLaw<elements::FiniteJournal>::point(seen), exact);
      off += rests_[k]->force(seen.r, seen.spin - seen.housing_spin) - exact.F;
      whole += exact.F;
    }
    return off.norm() / whole.norm();
  }

 private:
  typename Mount::Nodes mount_states(std::size_t k, const NodeAt& node) const {
    typename Mount::Nodes x;
    const auto nodes = mount_nodes(k);
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = &node(nodes[i]);
    return x;
  }

  Pair ends_;
  std::array<double, 2> offset_;
  std::vector<Rest> rests_;
  std::vector<std::vector<Index>> unknowns_;  ///< of each pad
  std::shared_ptr<Cells> cells_;
};

namespace {

template <class Oil, bool Pressed, bool Offsets>
bool add_pads_with(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                   const std::vector<std::shared_ptr<const elements::PadAtRest<Oil>>>& rests,
                   const std::vector<std::vector<Index>>& unknowns) {
  std::vector<std::shared_ptr<const Oil>> films;
  films.reserve(rests.size());
  for (const auto& rest : rests)
    films.push_back(rest->oil());
  const std::vector<PadCells<Oil>> oil = add_oil_of(a, b, films);
  if (oil.empty()) return false;
  using Pads = PadsWithCells<Oil, Pressed, Offsets>;
  const auto made = std::make_shared<const Pads>(n, rests, oil, unknowns);
  auto& terms = a.built.support_terms[number_of(a, b)];
  for (std::size_t k = 0; k < made->pads(); ++k)
    terms.push_back(a.builder.add(made->mount(k), made->mount_nodes(k), "tilting pads"));
  add_cell_terms<typename Pads::Cell>(a, b, n, made->cells(), "cells of tilting pads");
  CarriedOil carried;
  carried.bearing = name_of(b);
  carried.unknowns = oil_unknowns(oil);
  for (const std::vector<Index>& of_pad : unknowns)
    carried.following.insert(carried.following.end(), of_pad.begin(), of_pad.end());
  carried.balanced = [made](const NodeAt& node) { return made->balanced(node); };
  carried.full = [cells = made->cells()](const NodeAt& node) { return cells->full(node); };
  if (rests.front()->pad().film.grid) {
    carried.grid = grid_text(oil);
    carried.off_statics = [made](const NodeAt& node) { return made->off_statics(node); };
  }
  a.built.carried_oil.push_back(std::move(carried));
  return true;
}

}  // namespace

template <bool Pressed, bool Offsets>
bool add_pad_cells(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                   const std::vector<elements::TiltingPad>& pads,
                   const std::vector<std::vector<Index>>& unknowns) {
  using elements::CarriedGrid, elements::CarriedPad, elements::PadAtRest;
  std::vector<std::shared_ptr<const PadAtRest<CarriedPad>>> rests;
  std::vector<std::shared_ptr<const PadAtRest<CarriedGrid>>> on_grid;
  for (const elements::TiltingPad& p : pads)
    if (p.film.grid)
      on_grid.push_back(std::make_shared<const PadAtRest<CarriedGrid>>(p, grid_in_time(p.film, 0)));
    else
      rests.push_back(std::make_shared<const PadAtRest<CarriedPad>>(
          p, std::make_shared<const CarriedPad>(p.film, 0)));
  return on_grid.empty() ? add_pads_with<CarriedPad, Pressed, Offsets>(a, b, n, rests, unknowns)
                         : add_pads_with<CarriedGrid, Pressed, Offsets>(a, b, n, on_grid, unknowns);
}

template bool add_pad_cells<false, false>(Assembly&, const model::Bearing&,
                                          const meshes::BearingNodes&,
                                          const std::vector<elements::TiltingPad>&,
                                          const std::vector<std::vector<Index>>&);
template bool add_pad_cells<false, true>(Assembly&, const model::Bearing&,
                                         const meshes::BearingNodes&,
                                         const std::vector<elements::TiltingPad>&,
                                         const std::vector<std::vector<Index>>&);
template bool add_pad_cells<true, false>(Assembly&, const model::Bearing&,
                                         const meshes::BearingNodes&,
                                         const std::vector<elements::TiltingPad>&,
                                         const std::vector<std::vector<Index>>&);
template bool add_pad_cells<true, true>(Assembly&, const model::Bearing&,
                                        const meshes::BearingNodes&,
                                        const std::vector<elements::TiltingPad>&,
                                        const std::vector<std::vector<Index>>&);

}  // namespace whirl::assembly
