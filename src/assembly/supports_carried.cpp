// Journal films that conserve mass, in a motion at large: an element a cell, with a scalar node for the
// oil in it.
#include <assembly/film_kernels.hpp>
#include <assembly/support_parts.hpp>
#include <elements/films/carried_film.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace whirl::assembly {

namespace {

bool moves_at_large(const model::Step& s) {
  const auto* transient = std::get_if<model::TransientStep>(&s.law);
  return transient && !transient->linear;
}

/// A pad with the nodes of its cells.
struct PadCells {
  std::shared_ptr<const elements::CarriedPad> pad;
  std::vector<Index> oil;
};

/// The cells of a bearing with the nodes they stand between.
template <bool Offsets>
class CellsOnNodes {
 public:
  using Kernel = elements::CarriedCell<Offsets>;
  using Between = std::array<Index, Kernel::n_nodes>;

  CellsOnNodes(const meshes::BearingNodes& n, const std::vector<PadCells>& pads) {
    for (const PadCells& p : pads)
      for (Index i = 0; i < p.pad->cells(); ++i) {
        const Index last = p.pad->cells() - 1;
        Kernel cell;
        cell.pad = p.pad;
        cell.cell = i;
        cell.offset = {n.shaft.offset, n.other.offset};
        kernels_.push_back(cell);
        nodes_.push_back({n.shaft.node, n.other.node, p.oil[at(std::max<Index>(i - 1, 0))],
                          p.oil[at(std::min(i + 1, last))], p.oil[at(i)]});
      }
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
  /// What the cells' unknowns are with all in balance.
  std::vector<double> balanced(const NodeAt& node) const {
    std::vector<double> out;
    for (std::size_t k = 0; k < size(); ++k) {
      std::array<double, 1> q{0.0};
      kernels_[k].relax(states(k, node), {}, q);
      out.push_back(q[0]);
    }
    return out;
  }

 private:
  typename Kernel::Nodes states(std::size_t k, const NodeAt& node) const {
    typename Kernel::Nodes x;
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = &node(nodes_[k][i]);
    return x;
  }
  std::vector<Kernel> kernels_;
  std::vector<Between> nodes_;
};

template <bool Offsets>
void add_cells(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
               const std::vector<PadCells>& pads) {
  const auto cells = std::make_shared<const CellsOnNodes<Offsets>>(n, pads);
  auto& terms = a.built.support_terms[number_of(a, b)];
  CarriedOil oil;
  for (std::size_t k = 0; k < cells->size(); ++k) {
    terms.push_back(a.builder.add(cells->kernel(k), cells->nodes(k), "cells of oil films"));
    oil.unknowns.push_back(cells->nodes(k).back());
  }
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
  oil.balanced = [cells](const NodeAt& node) { return cells->balanced(node); };
  a.built.carried_oil.push_back(std::move(oil));
}

}  // namespace

bool follows_oil(const model::Model& m, const model::Step& step) {
  return moves_at_large(step) &&
         std::any_of(m.bearings.begin(), m.bearings.end(), [](const model::Bearing& b) {
           const auto* film = std::get_if<model::FiniteJournal>(&b.law);
           return film && film->flow.cavitation == model::FilmFlow::Cavitation::mass_conserving;
         });
}

bool add_carried_film(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                      const elements::FiniteJournal& film) {
  const std::vector<model::Step>& steps = a.model.steps;
  if (std::none_of(steps.begin(), steps.end(), moves_at_large)) return false;
  const auto now = std::find_if(steps.begin(), steps.end(),
                                [&](const model::Step& s) { return s.name == a.step; });
  const bool followed = now != steps.end() && moves_at_large(*now);
  const Index line = a.builder.add_line(fmt::format("oil of {}", name_of(b)));
  std::vector<PadCells> pads;
  for (std::size_t k = 0; k < film.surface->arcs().size(); ++k) {
    PadCells p;
    p.pad = std::make_shared<const elements::CarriedPad>(film, k);
    for (Index i = 0; i < p.pad->cells(); ++i) {
      p.oil.push_back(a.builder.add_node(
          {Vec3::Zero(), line,
           fmt::format("oil in cell {} of pad {} of {}", i + 1, k + 1, name_of(b)), true, false,
           true}));
      // steps of all kinds have the same nodes, so that one may begin where another ended
      if (!followed) a.builder.hold(p.oil.back(), 0);
    }
    pads.push_back(std::move(p));
  }
  if (!followed) return false;
  if (n.shaft.offset == 0 && n.other.offset == 0)
    add_cells<false>(a, b, n, pads);
  else
    add_cells<true>(a, b, n, pads);
  return true;
}

}  // namespace whirl::assembly
