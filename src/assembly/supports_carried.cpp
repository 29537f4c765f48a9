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
  const auto followed = [](const auto& x) { return x.flow.follows_oil(); };
  if (const auto* film = std::get_if<model::FiniteJournal>(&law)) return followed(*film);
  const auto* pads = std::get_if<model::TiltingPadJournal>(&law);
  return pads && followed(*pads);
}

template <class Pad, bool Offsets>
void add_cells(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
               const elements::FiniteJournal& film, const std::vector<PadCells<Pad>>& pads) {
  using Kernel = elements::PadCell<Pad, 0, Offsets>;
  const auto cells = std::make_shared<CellsOnNodes<Kernel>>();
  for (const PadCells<Pad>& p : pads)
    for (Index i = 0; i < p.pad->cells(); ++i)
      for (Index block = 0; block < PadCells<Pad>::blocks; ++block) {
        typename CellsOnNodes<Kernel>::Between nodes{n.shaft.node, n.other.node};
        const auto oil = p.around(i, block);
        std::copy(oil.begin(), oil.end(), nodes.begin() + 2);
        Kernel cell;
        cell.pad = p.pad;
        cell.cell = i;
        cell.block = block;
        cell.offset = {n.shaft.offset, n.other.offset};
        cells->add(cell, nodes);
      }
  add_cell_terms<Kernel>(a, b, n, cells, "cells of oil films");
  CarriedOil oil;
  oil.bearing = name_of(b);
  oil.unknowns = oil_unknowns(pads);
  oil.balanced = [cells](const NodeAt& node) {
    return CarriedOil::Balance{cells->balanced(node), {}};
  };
  oil.full = [cells](const NodeAt& node) { return cells->full(node); };
  if (film.grid) {
    oil.grid = grid_text(pads);
    oil.off_statics = [film, cells, pads](const NodeAt& node) {
      elements::LateralMotion m = cells->kernel(0).motion(cells->states(0, node), {});
      m.v.setZero();
      elements::FilmForce exact;
      film.evaluate(elements::FilmLaw<elements::FiniteJournal>::point(m), exact);
      Vec2 F = Vec2::Zero();
      for (const PadCells<Pad>& p : pads)
        F += p.pad->force_in_balance(m.r, m.spin - m.housing_spin);
      return (F - exact.F).norm() / exact.F.norm();
    };
  }
  a.built.carried_oil.push_back(std::move(oil));
}

}  // namespace

bool follows_oil(const model::Model& m, const model::Step& step) {
  return moves_at_large(step) &&
         std::any_of(m.bearings.begin(), m.bearings.end(),
                     [](const model::Bearing& b) { return has_cells(b.law); });
}

std::vector<std::vector<Index>> add_oil_nodes(Assembly& a, const model::Bearing& b,
                                              const std::vector<Index>& cells, int rows) {
  const std::vector<model::Step>& steps = a.model.steps;
  std::vector<std::vector<Index>> out;
  if (std::none_of(steps.begin(), steps.end(), moves_at_large)) return out;
  const auto now = std::find_if(steps.begin(), steps.end(),
                                [&](const model::Step& s) { return s.name == a.step; });
  const bool followed = a.oil == FilmOil::followed && now != steps.end() && moves_at_large(*now);
  const Index line = a.builder.add_line(fmt::format("oil of {}", name_of(b)));
  for (std::size_t k = 0; k < cells.size(); ++k) {
    out.emplace_back();
    for (Index i = 0; i < cells[k]; ++i) {
      const Index node = a.builder.add_node(
          {Vec3::Zero(), line,
           fmt::format("oil in cell {} of pad {} of {}", i + 1, k + 1, name_of(b)), true, false,
           true, rows});
      out.back().push_back(node);
      // steps of all kinds have the same nodes, so that one may begin where another ended
      for (int row = 0; !followed && row < rows; ++row)
        a.builder.hold(node, row);
    }
  }
  if (!followed) out.clear();
  return out;
}

namespace {

template <class Pad>
bool add_cells_of(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                  const elements::FiniteJournal& film,
                  const std::vector<std::shared_ptr<const Pad>>& pads) {
  const std::vector<PadCells<Pad>> cells = add_oil_of(a, b, pads);
  if (cells.empty()) return false;
  if (n.shaft.offset == 0 && n.other.offset == 0)
    add_cells<Pad, false>(a, b, n, film, cells);
  else
    add_cells<Pad, true>(a, b, n, film, cells);
  return true;
}

}  // namespace

std::shared_ptr<const elements::CarriedGrid> grid_in_time(const elements::FiniteJournal& film,
                                                          std::size_t k) {
  constexpr int fewest = 6;
  const int columns = std::max(fewest, (*film.grid)[k].columns() / 4);
  return std::make_shared<const elements::CarriedGrid>(film, k, columns);
}

bool add_carried_film(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                      const elements::FiniteJournal& film) {
  if (!film.mass_conserving || film.kept_from >= 0) return false;
  std::vector<std::shared_ptr<const elements::CarriedGrid>> grids;
  std::vector<std::shared_ptr<const elements::CarriedPad>> pads;
  for (std::size_t k = 0; k < film.surface->arcs().size(); ++k)
    if (film.grid)
      grids.push_back(grid_in_time(film, k));
    else
      pads.push_back(std::make_shared<const elements::CarriedPad>(film, k));
  return film.grid ? add_cells_of(a, b, n, film, grids) : add_cells_of(a, b, n, film, pads);
}

}  // namespace whirl::assembly
