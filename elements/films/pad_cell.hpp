// Cells of a film whose oil is followed, at one angle, as an element.
#pragma once
#include <elements/films/carried_film.hpp>
#include <elements/films/carried_grid.hpp>
#include <core/dual.hpp>
#include <memory>

namespace whirl::elements {

/// Cells of a film at one angle, a block of Pad::rows_of_node rows. Nodes: 0 journal, 1 housing; scalars
/// in which its pad moves (Moves of them, each in its unit); then scalars in m, one a row: contents of the
/// cells before, of the next ones, where there are two blocks of the other one at this angle, and of its
/// own, each less Pad::reference. At the ends of a pad the node itself stands for the one that is not
/// there. A pad that has moved by q sees the journal at r - sum q_k directions_k, and takes F.directions_k.
template <class Pad, int Moves, bool Offsets = false>
struct PadCell {
  static constexpr int blocks = Pad::rows_in_time / Pad::rows_of_node;
  static constexpr int n_nodes = 4 + blocks + Moves, own = 1, width = 7, size = 7 * n_nodes;
  static constexpr int own_each = Pad::rows_of_node;
  static constexpr system::Axes axes = Offsets ? system::Axes::own : system::Axes::any;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{.spin = true};
  using Nodes = system::Nodes<n_nodes>;
  using Rows = std::array<double, at(Pad::rows_of_node)>;

  std::shared_ptr<const Pad> pad;  ///< with as many rows as in time
  Index cell = 0;
  std::array<double, 2> offset{0.0, 0.0};    ///< of journal and housing, m
  std::array<Vec2, at(Moves)> directions{};  ///< of the pad's centre, m a unit of its scalars
  Index block = 0;                           ///< of the rows

  void add_force(const Nodes& x, const system::Context& c, system::ForceX<size>& f) const;
  void add_tangent(const Nodes& x, const system::Context& c, system::TangentX<size>& t) const;
  void add_energy(const Nodes& x, const system::Context& c, system::Energy& e) const;
  /// The contents in balance with journal and pad where they are, at rest.
  void relax(const Nodes& x, const system::Context& c, Rows& q) const;
  /// Force and torques of the cells on journal and housing (lateral_joint.hpp).
  Vector<4> load(const Nodes& x, const system::Context& c) const;
  /// The unknowns where the cells are full, without pressure, m.
  Rows full(const Nodes& x) const;
  /// Of the journal against the centre of the pad.
  LateralMotion motion(const Nodes& x, const system::Context& c) const;

 private:
  static_assert(blocks <= 2);
  /// Nodes.
  static constexpr int before = 2 + Moves, next = 3 + Moves, other = 4 + Moves, held = n_nodes - 1;
  static constexpr Index rows = Pad::rows_of_node;
  using Link = LateralLink<Offsets>;
  using Contents = std::array<double, at(Pad::around)>;
  using All = Dual<3 + Pad::around>;
  static system::Nodes<2> ends(const Nodes& x) { return {x[0], x[1]}; }
  typename Link::Spins spins(const Nodes& x) const {
    return {system::Spin(*x[0]), system::Spin(*x[1])};
  }
  /// Of a row of the block.
  Index row_of(Index k) const { return block * rows + k; }
  /// Node of a content, which of its unknowns, and that of the film.
  struct Place {
    int node;
    Index unknown, row;
  };
  Place place(Index row, const CellStep& step) const;
  Contents contents(const Nodes& x, Index row) const;
  typename Pad::template Cell<double> now(const LateralMotion& m, const Nodes& x, Index row) const;
  bool inside(const Vec2& r) const;
  void add_row_tangent(const Nodes& x, const LateralMotion& m, Index row,
                       system::TangentX<size>& t) const;
};

extern template struct PadCell<CarriedPad, 0, false>;
extern template struct PadCell<CarriedPad, 0, true>;
extern template struct PadCell<CarriedPad, 1, false>;
extern template struct PadCell<CarriedPad, 1, true>;
extern template struct PadCell<CarriedPad, 2, false>;
extern template struct PadCell<CarriedPad, 2, true>;
extern template struct PadCell<CarriedGrid, 0, false>;
extern template struct PadCell<CarriedGrid, 0, true>;
extern template struct PadCell<CarriedGrid, 1, false>;
extern template struct PadCell<CarriedGrid, 1, true>;
extern template struct PadCell<CarriedGrid, 2, false>;
extern template struct PadCell<CarriedGrid, 2, true>;

/// Of a pad that stands in its housing.
template <bool Offsets = false>
using CarriedCell = PadCell<CarriedPad, 0, Offsets>;

}  // namespace whirl::elements
