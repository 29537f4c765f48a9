// The equations of a pad's film on its grid, for grid_film.cpp and grid_film_carried.cpp.
#pragma once
#include <elements/films/grid_film.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::elements {

/// One state of a pad. Nodes are numbered row by row within a column of cells; a round pad is folded, so
/// that its first and last columns are neighbours.
class GridPad::Solver {
 public:
  Solver(const GridPad& pad, const GridDrive& in, bool with_slopes)
      : pad_(pad),
        in_(in),
        n_(pad.cells_.size()),
        m_(pad.rows_.size()),
        bands_(pad.bands_),
        half_(pad.round_ ? 2 * m_ : m_),
        size_(n_ * m_),
        slopes_(with_slopes),
        carries_(in.carries && in.source[2] != 0.0 && !pad.round_) {
    for (std::size_t i = 0; i < n_; ++i) {
      const std::array<double, 4> mu = viscosity(i);
      for (std::size_t g = 0; g < bands_; ++g)
        add_resistance(i, g, mu);
    }
    number_columns();
    add_conductances();
    add_sources();
    if (carries_)
      find_carried();
    else
      find_film();
  }

  void loads(GridLoad& out) const;
  void slopes(GridSlopes& out);
  GridField field() const;

 private:
  static constexpr std::size_t most = static_cast<std::size_t>(most_columns) * most_rows;
  static constexpr std::size_t late_band = 2, most_band = 2 * (most_rows + late_band) + 1;
  /// A stretch along the arc: int 1/(a h^3), int D/(a h^3), int D^2/(a h^3); slopes by e_y, e_z,
  /// reynolds.
  struct Stretch {
    double r = 0, s = 0, square = 0;
    Vec3 dr = Vec3::Zero(), ds = Vec3::Zero(), dsquare = Vec3::Zero();
  };
  /// Half a cell; a type that takes no time to make.
  struct Half {
    double r, s, square;
    Vec3 dr, ds, dsquare;
    void clear() {
      r = s = square = 0.0;
      dr.setZero();
      ds.setZero();
      dsquare.setZero();
    }
  };
  /// A whole cell: int a h^3, for the flow along the axis.
  struct Section {
    double g;
    Vec3 dg;
  };
  /// In place of a neighbour: the groove at an end of the pad, the free side of the bearing, nothing.
  static constexpr std::size_t groove = ~std::size_t{0}, side = groove - 1;

  std::array<double, 4> viscosity(std::size_t i) const;
  void add_resistance(std::size_t i, std::size_t g, const std::array<double, 4>& mu);
  void number_columns();
  void add_conductances();
  void add_sources();
  void find_film();
  void guess_film();
  void fill_all();
  void solve_film();
  bool take_film(double least, bool may_form);
  void find_flows();
  static constexpr double least_reach = 1e-12;
  double reach(std::size_t k) const;
  double first_reach(std::size_t k, double lacking) const;
  double own(std::size_t i, std::size_t j, Vec3* slope = nullptr) const;
  /// Of its cell that is in balance.
  double share(std::size_t k) const { return k < side ? 0.5 * (1.0 + reach_[k]) : 1.0; }
  double past_front(std::size_t k) const { return own_[k] * (1.0 - reach_[k]) / reach_[k]; }
  /// (1 - s)/2
  double unmet(std::size_t k) const { return 0.5 * (1.0 - reach_[k]); }
  bool parted(std::size_t k) const { return wet(k) && reach_[k] < 1.0; }
  double least_lacking(std::size_t k) const;
  double lacking(std::size_t k) const;
  double lacking_past(std::size_t l, std::size_t r) const;
  double row_share(std::size_t j) const {
    double sum = 0.0;
    for (const Piece& x : pieces(j))
      sum += x.share;
    return sum;
  }
  double lacked(int load, std::size_t k);
  double across(int load, std::size_t k);
  bool may_part(std::size_t k) const { return stepped_[k] == 0; }
  template <class Link>
  void for_each_link(const Link& link) const;
  template <class Link>
  void for_each_link_along(const Link& link) const;
  template <class Link>
  void for_each_link_across(const Link& link) const;
  void add_flow(GridField& out) const;
  struct RowFlow;
  void find_row(std::size_t j, std::size_t band, bool at_side, const std::vector<double>& places,
                RowFlow& row) const;
  double taken_in(double pressure, double resistance, double width) const;
  void join_films(RowFlow& row) const;
  void add_heat(GridField& out) const;
  std::array<double, most>& adjoint(int load) { return lambda_[static_cast<std::size_t>(load)]; }
  /// Slopes of the loads and, in the last row, of the shear: by the source; by e and reynolds.
  struct LoadSlopes {
    Matrix<4, 3> by_source = Matrix<4, 3>::Zero(), by = Matrix<4, 3>::Zero();
  };
  void add_slopes_of_flows(LoadSlopes& to);

  // Of films that conserve mass (grid_film_carried.cpp).
  /// What is dragged past a face where the gap is full, by its amount, with slopes by e_y, e_z,
  /// reynolds; that by S is value/S.
  struct Dragged {
    double value = 0;
    Vec3 by = Vec3::Zero();
  };
  Dragged dragged(std::size_t f, std::size_t j) const;
  Dragged dragged_at_side(std::size_t f) const;
  void add_dragged(Dragged& to, std::size_t f, const Piece& piece) const;
  void find_carried();
  bool settle_carried(double rounding);
  bool move_fronts(double rounding);
  void find_late();
  double handed_on(std::size_t k) const;
  bool in_band(std::size_t row, std::size_t column) const {
    return std::max(row, column) - std::min(row, column) <= half_;
  }
  template <class See>
  void for_each_parted(const See& see) const;
  template <class See>
  void for_each_link_of_parted(const See& see) const;
  std::size_t ruptured_before(std::size_t k) const;
  void add_handed_on();
  void couple_carried();
  void solve_carried();
  Vec2 motion() const;
  double squeeze(std::size_t k) const;
  double shallow() const;
  double shear_carried() const;
  void add_shear_slopes(LoadSlopes& to);
  void add_slopes_of_squeeze(LoadSlopes& to);
  template <class See>
  void for_each_ruptured_cell(const See& see) const;
  template <class See>
  void for_each_cell_at_side(const See& see) const;
  void add_carried_flow(GridField& out) const;
  void take_out_dry(std::vector<double>& shear, std::vector<double>& driven, GridField& out) const;

  void clear_matrix() { std::fill_n(a_.begin(), size_ * (2 * half_ + 1), 0.0); }
  void couple(std::size_t k, std::size_t l, double by_k, double by_l);
  void couple_film();
  void factor();
  void solve(double* x) const;
  void solve_transposed(double* x) const;

  const std::vector<Piece>& pieces(std::size_t j) const { return pad_.rows_[j].pieces; }
  std::size_t at(std::size_t i, std::size_t j) const { return place_[i] * m_ + j; }
  std::size_t node(std::size_t i, std::size_t j) const { return i == groove ? groove : at(i, j); }
  /// Faces along the arc: f between cells f - 1 and f; n_ + 1 of them, n_ when round.
  std::size_t faces() const { return pad_.round_ ? n_ : n_ + 1; }
  std::size_t left_of(std::size_t f) const {
    if (f > 0) return f - 1;
    return pad_.round_ ? n_ - 1 : groove;
  }
  std::size_t right_of(std::size_t f) const { return f < n_ ? f : groove; }
  Stretch face(std::size_t f, std::size_t g) const {
    Stretch out;
    const std::size_t l = left_of(f), r = right_of(f);
    for (const auto& [cell, half] : {std::pair{l, std::size_t{1}}, std::pair{r, std::size_t{0}}}) {
      if (cell == groove) continue;
      const Half& h = half_cells_[(2 * cell + half) * bands_ + g];
      out.r += h.r;
      out.s += h.s;
      out.square += h.square;
      if (!slopes_) continue;
      out.dr += h.dr;
      out.ds += h.ds;
      out.dsquare += h.dsquare;
    }
    return out;
  }
  double& entry(std::size_t row, std::size_t column) {
    return a_[row * (2 * half_ + 1) + half_ + column - row];
  }
  double pressure(std::size_t k) const { return k == groove ? in_.edge : k == side ? 0.0 : P_[k]; }
  /// Of a pressure that is given.
  bool known(std::size_t k) const { return k >= side || open_[k] != 0; }
  bool wet(std::size_t k) const { return k < side && film_[k] != 0; }
  bool forward() const { return in_.source[2] >= 0.0; }
  /// The node that the journal passes before k, or after it, along the arc; `groove` at the end.
  /// @pre not a round pad.
  std::size_t next(std::size_t k, bool rising) const {
    if (rising) return k + m_ < size_ ? k + m_ : groove;
    return k >= m_ ? k - m_ : groove;
  }
  std::size_t upstream(std::size_t k) const { return next(k, !forward()); }
  std::size_t downstream(std::size_t k) const { return next(k, forward()); }
  bool ruptured(std::size_t k) const { return k < side && !film_[k] && !open_[k]; }
  /// What the film past node k lacks in flow, of a film that conserves mass.
  double deficit(std::size_t k) const { return k < side ? lacking_[k] : 0.0; }
  std::size_t far_node(std::size_t i, const Across& x) const {
    return x.to < m_ ? at(i, x.to) : side;
  }

  const GridPad& pad_;
  const GridDrive& in_;
  std::size_t n_, m_, bands_, half_, size_;
  bool slopes_, carries_;
  double shear_ = 0;
  Vec3 dshear_ = Vec3::Zero();
  std::array<std::size_t, most_columns> place_;
  std::array<Half, 2 * most_columns * most_bands> half_cells_;
  std::array<Section, most_columns * most_bands> sections_;
  std::array<double, (most_columns + 1) * most_rows> along_;  ///< conductance of face f in row j
  std::array<double, most> P_, inflow_;
  /// What comes to a node along the arc from grooves and tracks; across it, with the sources.
  std::array<double, most> along_in_, across_in_;
  /// Of a node, for a front near it: the conductance of its own cell along the arc; what it loses
  /// across the arc at the last pressures; of the distance of two nodes, how far film reaches beyond it.
  std::array<double, most> own_, lost_, reach_;
  std::array<std::array<double, most>, 4> lambda_;
  /// Where mass is conserved: what the flow past a ruptured node lacks against a full gap; how it hands
  /// on the squeeze of the node behind.
  std::array<double, most> lacking_, limit_, shared_, late_, shear_by_lacking_;
  std::array<unsigned char, most> beyond_;
  std::array<double, most_columns * most_bands> walls_;  ///< int mu f_s/h of a cell in a band
  std::array<Vec3, most_columns * most_bands> dwalls_;
  std::array<std::array<double, most>, 3> B_;
  std::array<unsigned char, most> film_, open_, stepped_;
  std::array<double, most * most_band> a_;
};

/// link(k, l, conductance, before, behind) for all pairs k, l of nodes that touch; along the arc with
/// the nodes before k and behind l. Either may be `groove`, l `side`.
template <class Link>
void GridPad::Solver::for_each_link(const Link& link) const {
  for_each_link_along(link);
  for_each_link_across(link);
}

template <class Link>
void GridPad::Solver::for_each_link_along(const Link& link) const {
  for (std::size_t f = 0; f < faces(); ++f) {
    const std::size_t l = left_of(f), r = right_of(f);
    const std::size_t before = l == groove ? groove : left_of(l);
    const std::size_t behind = r == groove ? groove : right_of(pad_.round_ ? (r + 1) % n_ : r + 1);
    for (std::size_t j = 0; j < m_; ++j)
      link(node(l, j), node(r, j), along_[f * m_ + j], node(before, j), node(behind, j));
  }
}

template <class Link>
void GridPad::Solver::for_each_link_across(const Link& link) const {
  for (std::size_t i = 0; i < n_; ++i)
    for (const Across& x : pad_.across_)
      link(at(i, x.from), far_node(i, x), x.conductance * sections_[i * bands_ + x.band].g, groove,
           groove);
}

}  // namespace whirl::elements
