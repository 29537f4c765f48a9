// Films that conserve mass, in a motion at large: an element a cell, with a scalar node for the oil in
// it.
#include <assembly/carried_cells.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace whirl::assembly {

namespace {

bool moves_at_large(const model::Step& s) {
  const auto* transient = std::get_if<model::TransientStep>(&s.law);
  return transient && !transient->linear;
}

/// The film of a bearing conserves mass, and its oil can be followed.
bool has_cells(const model::BearingLaw& law) {
  const auto followed = [](const auto& x) { return x.flow.follows_oil(x.rows); };
  if (const auto* film = std::get_if<model::FiniteJournal>(&law)) return followed(*film);
  const auto* pads = std::get_if<model::TiltingPadJournal>(&law);
  return pads && followed(*pads);
}

template <bool Offsets>
void add_cells(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
               const std::vector<PadCells>& pads) {
  using Kernel = elements::CarriedCell<Offsets>;
  const auto cells = std::make_shared<CellsOnNodes<Kernel>>();
  for (const PadCells& p : pads)
    for (Index i = 0; i < p.pad->cells(); ++i) {
      const auto oil = p.around(i);
      Kernel cell;
      cell.pad = p.pad;
      cell.cell = i;
      cell.offset = {n.shaft.offset, n.other.offset};
      cells->add(cell, {n.shaft.node, n.other.node, oil[0], oil[1], oil[2]});
    }
  add_cell_terms<Kernel>(a, b, n, cells, "cells of oil films");
  CarriedOil oil;
  oil.bearing = name_of(b);
  for (const PadCells& p : pads)
    oil.unknowns.insert(oil.unknowns.end(), p.oil.begin(), p.oil.end());
  oil.balanced = [cells](const NodeAt& node) {
    return CarriedOil::Balance{cells->balanced(node), {}};
  };
  oil.full = [cells](const NodeAt& node) { return cells->full(node); };
  a.built.carried_oil.push_back(std::move(oil));
}

}  // namespace

bool follows_oil(const model::Model& m, const model::Step& step) {
  return moves_at_large(step) &&
         std::any_of(m.bearings.begin(), m.bearings.end(),
                     [](const model::Bearing& b) { return has_cells(b.law); });
}

std::vector<PadCells> add_oil_nodes(
    Assembly& a, const model::Bearing& b,
    const std::vector<std::shared_ptr<const elements::CarriedPad>>& pads) {
  const std::vector<model::Step>& steps = a.model.steps;
  std::vector<PadCells> out;
  if (std::none_of(steps.begin(), steps.end(), moves_at_large)) return out;
  const auto now = std::find_if(steps.begin(), steps.end(),
                                [&](const model::Step& s) { return s.name == a.step; });
  const bool followed = now != steps.end() && moves_at_large(*now);
  const Index line = a.builder.add_line(fmt::format("oil of {}", name_of(b)));
  for (std::size_t k = 0; k < pads.size(); ++k) {
    PadCells p;
    p.pad = pads[k];
    for (Index i = 0; i < p.pad->cells(); ++i) {
      p.oil.push_back(a.builder.add_node(
          {Vec3::Zero(), line,
           fmt::format("oil in cell {} of pad {} of {}", i + 1, k + 1, name_of(b)), true, false,
           true}));
      // steps of all kinds have the same nodes, so that one may begin where another ended
      if (!followed) a.builder.hold(p.oil.back(), 0);
    }
    out.push_back(std::move(p));
  }
  if (!followed) out.clear();
  return out;
}

bool add_carried_film(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                      const elements::FiniteJournal& film) {
  if (!film.mass_conserving || film.grid || film.kept_from >= 0) return false;
  std::vector<std::shared_ptr<const elements::CarriedPad>> pads;
  for (std::size_t k = 0; k < film.surface->arcs().size(); ++k)
    pads.push_back(std::make_shared<const elements::CarriedPad>(film, k));
  const std::vector<PadCells> cells = add_oil_nodes(a, b, pads);
  if (cells.empty()) return false;
  if (n.shaft.offset == 0 && n.other.offset == 0)
    add_cells<false>(a, b, n, cells);
  else
    add_cells<true>(a, b, n, cells);
  return true;
}

}  // namespace whirl::assembly
