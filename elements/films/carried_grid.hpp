// The oil of a mass-conserving film on a grid along the axis too, in motion: what every cell of a grid
// holds is an unknown of its own (carried_film.hpp has one profile along the axis).
//
// Columns along the arc, rows from the middle of the length to its side, where edges of recesses are
// edges of cells; recesses are symmetric about the middle. h: mean gap of a cell, recesses included; m
// its content. Elrod's equation in finite volumes, with the share and the pressure of carried_film.hpp,
//   m' + (q_right - q_left)/width + (q_outer - q_inner)/depth = 0.
// Along the arc the film between the middles of two cells is two halves in series, each of the circle's
// gap g at the face and the depth D of its side there, r = source eta R^2 (half a width)/(a_x (g + D)^3):
//   q = (s/2) share_up (g + D_m) - (P_right - P_left)/(r_left + r_right),  D_m = sum D r/sum r,
// the exact flow past a step of the surface (A. A. Samarskii, The Theory of Difference Schemes, 2001, doi
// 10.1201/9780203908518, ch. 3). Along the axis the flow goes with h^3 of each half, to the side at no
// pressure; nothing comes back from there. In the cell at the side the pressure falls on a parabola
// whose top is where the stretch of equal depth is in the middle, so that one row has that of a plain
// bearing. Relief tracks (open recesses) and grooves are full, at the supply pressure.
//
// Force as carried_film.hpp; the torque has what pressure does to steps and slopes of recesses, beside
// -(r x F)/2 and the shear: -R L/2 int D P' of both halves at a face, of which
// sum D^2 r - (sum D r)^2/sum r is what circulates there.
//
// Error of the second order in both directions, of the first where fronts lie. Source: H. G. Elrod, J.
// Lubr. Technol. 103, 1981, doi 10.1115/1.3251669. Limits: carried_film.hpp; tracks reach from end to
// end of their pad, in the middle of the length.
#pragma once
#include <elements/films/carried_film.hpp>

namespace whirl::elements {

/// The cells of one pad.
class CarriedGrid {
 public:
  /// Whose contents the balance of a cell is of; itself second.
  static constexpr Index around = 5;
  static constexpr std::array<CellStep, around> steps{{{-1, 0}, {0, 0}, {1, 0}, {0, -1}, {0, 1}}};
  /// Over half the length, in time; and of those, how many a node has.
  static constexpr Index rows_in_time = 6, rows_of_node = 3;

  /// columns: along the arc; rows: over half the length, beside a relief track.
  /// @pre k below film.surface->arcs().size(); film.mass_conserving without heat; the pad has ends.
  /// @throws Error E84: more recesses than the grid can tell apart, a track that ends on its pad.
  CarriedGrid(const FiniteJournal& film, std::size_t k, int columns, int rows = rows_in_time);

  Index cells() const { return static_cast<Index>(columns_.size()); }  ///< columns
  Index rows() const { return static_cast<Index>(shares_.size()); }
  double width(Index i) const { return columns_[at(i)].width; }  ///< rad
  double middle(Index i) const { return columns_[at(i)].from + 0.5 * width(i); }
  /// Of a row, over half the length.
  double share(Index j) const { return shares_[at(j)]; }
  /// Mean gap of a cell with the journal at r, m; of a column without its recesses.
  double gap(Index i, Index j, const Vec2& r) const;
  double gap(Index i, const Vec2& r) const;
  /// Nowhere from face to face a column touches.
  bool open(Index i, const Vec2& r) const;
  /// Content of the full cell with the journal centred, m: what its unknown is counted from.
  double reference(Index i, Index j) const { return gap(i, j, Vec2::Zero()); }

  /// What a cell does, as CarriedPad::Cell; of its row alone.
  template <class T>
  struct Cell {
    T in, out;       ///< through both faces in the sense of theta, m rad/s
    T inner, outer;  ///< along the axis, towards the side, over half the length, m rad/s
    T fed;           ///< of what the pressure in grooves and tracks drives, m rad/s
    T outflow;       ///< (out - in)/width + (outer - inner)/(share width), m/s
    T push[2];       ///< on the housing, N
    T drag;          ///< torque on the journal, N m
  };
  /// content: of the cell and around it (steps), m; of cells beyond the edges nothing is asked.
  template <class T>
  Cell<T> cell(Index i, Index j, const T& ry, const T& rz, const T& slip,
               const std::array<T, around>& content) const;
  /// The contents, m, row by row of each column, at which nothing changes with the journal still at r;
  /// NaN where the journal stands outside the film, or none are found.
  std::vector<double> balanced(const Vec2& r, double slip) const;
  /// Force on a journal at r with the oil in balance, N; NaN where there is none.
  Vec2 force_in_balance(const Vec2& r, double slip) const;
  double balanced_cell(Index i, Index j, const Vec2& r, double slip) const;
  /// As CarriedPad::advance.
  bool advance(const Vec2& r, double slip, double rate, std::vector<double>& content) const;

  /// What a row of the balance in m/s is times to be a force, N s/m.
  double row_factor(Index i, Index j) const;
  /// Power of the pump that rows of a column take, W. fed: of these; part: of what the walls displace.
  double pump(Index i, double fed, const FilmPoint& p, double part = 1.0) const;
  Vec2 lever() const { return 0.5 * lift_ * Vec2(-thinnest_.y(), thinnest_.x()); }

 private:
  struct Column {
    double from, width;  ///< rad
    Vec2 normal;         ///< int n dtheta
    double to_side;      ///< from the middle of the last row, over half the length
    double to_track;
  };
  struct Depth {
    double mean = 0, from = 0, to = 0;  ///< m, at the faces
  };
  template <class T>
  struct Passed {
    T flow, driven, mean;
    T torque[2];  ///< of the halves before and behind the face over R L/2, Pa m
  };
  template <class T>
  T gap_at(double angle, const T& ry, const T& rz) const;
  template <class T>
  T gap_of(Index i, Index j, const T& ry, const T& rz) const;
  template <class T>
  Passed<T> along(Index face, Index j, const T& ry, const T& rz, const T& slip,
                  const carried_oil::Oil<T>* left, const carried_oil::Oil<T>* right) const;
  template <class T>
  T across(Index i, Index j, const T& slip, const carried_oil::Oil<T>* inner,
           const carried_oil::Oil<T>* outer) const;
  void add_columns(const std::vector<Recess>& recesses, double arc, int columns);
  void add_rows(const std::vector<Recess>& recesses, int rows);
  void place_recesses(const std::vector<Recess>& recesses);
  void find_distances();
  double face(Index f) const;
  const Depth& depth(Index i, Index j) const { return depths_[at(i * rows() + j)]; }

  FiniteJournal film_;
  mutable KeptBalance last_;
  double start_, clearance_, lift_;
  double track_ = 0;  ///< width of a relief track, over the length
  Vec2 thinnest_;
  std::vector<Column> columns_;
  std::vector<double> shares_;
  std::vector<Depth> depths_;
};

}  // namespace whirl::elements
