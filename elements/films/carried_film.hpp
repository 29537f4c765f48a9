// The oil of a mass-conserving journal film in motion: what every cell of the circumference holds is
// an unknown of its own.
//
// finite_journal.hpp takes fronts and content of ruptured film from the momentary state: exact at
// rest. In a motion at large the oil in a ruptured stretch is what has come there, so it is followed.
// Along each pad stand equal cells. m: content, the thickness that the oil of a cell would fill; h:
// mean gap of the cell; both of the mean over the length that the axial profile weighs. Elrod's
// equation (J. Lubr. Technol. 103, 1981, doi 10.1115/1.3251669) in finite volumes,
//   m' + (Phi_right - Phi_left)/width + leakage h^3 a_z P/(source eta L^2) = 0,
//   Phi = (s/2) share_up h_face - h_face^3 a_x (P_right - P_left)/(source eta R^2 distance),
//   share = m/h and P = 0 where the cell is not full, share = 1 and P a function of m/h - 1 where it is.
// share_up: of the cell, or groove, that the oil comes from: second order in full film, and ruptured
// film at rest carries the same through every face. Grooves are full, at the supply pressure. Factors and turbulence as in finite_journal.hpp; P: axial mean, Pa; s: slip, rad/s.
//
// The oil is as stiff as oil is: beyond `mixed` of its volume P = bulk (m/h - 1 - mixed/2), a parabola
// before, which is bubbles going into solution at about the pressure of the air. So P is a function of
// states and needs no constraint, m' = -div of a flow conserves mass to rounding in every scheme that is
// linear in the rates, and full film is stiff: implicit schemes step over it. An equilibrium does not
// know of it but for mixed/2 of the flow; in motion it is what oil does.
//
// Force on the journal -R L sum (P - supply) int n dtheta, with the same int n dtheta as in h: what a
// moving wall does to the content is exactly what P does to the wall. Torque: finite_journal.hpp, its
// shear eta f_s R^3 L s (m/h)/h. Energy: what the film takes beyond its pump's power is heat
// (dissipated), the oil's own elastic energy among it (P/bulk of what one filling does).
//
// Limits: the housing and its grooves stand still; one viscosity; the front of a film is one cell wide,
// and what a ruptured stretch holds is smeared over some cells on its way.
#pragma once
#include <elements/films/finite_journal.hpp>
#include <array>
#include <mutex>
#include <vector>

namespace whirl::elements {

namespace carried_oil {
template <class T>
struct Oil;
}

/// From a cell to a neighbour.
struct CellStep {
  Index column, row;
};

/// The contents of a pad's cells in balance. What was asked last is kept: the cells ask one after
/// another, of any thread.
class KeptBalance {
 public:
  /// find: the contents with the journal at r, m, at the slip, rad/s.
  template <class Find>
  double content(std::size_t cell, const Vec2& r, double slip, const Find& find) {
    const std::lock_guard guard(lock_);
    if (r_ != r || slip_ != slip) {
      content_ = find(r, slip);
      r_ = r;
      slip_ = slip;
    }
    return content_[cell];
  }

 private:
  std::mutex lock_;
  Vec2 r_ = Vec2::Constant(nan);
  double slip_ = nan;
  std::vector<double> content_;
};

/// The cells of one pad.
class CarriedPad {
 public:
  static constexpr double bulk = 1.7e9;  ///< of mineral oil, Pa
  static constexpr double mixed = 1e-4;  ///< of the volume: where bubbles still give way
  /// Whose contents the balance of a cell is of; itself second.
  static constexpr Index around = 3;
  static constexpr std::array<CellStep, around> steps{{{-1, 0}, {0, 0}, {1, 0}}};
  /// Of the cells at one angle, in time; and of those, how many a node has.
  static constexpr Index rows_in_time = 1, rows_of_node = 1;

  /// @pre k below film.surface->arcs().size(); film.mass_conserving without heat; the pad has ends.
  CarriedPad(const FiniteJournal& film, std::size_t k);

  Index cells() const { return static_cast<Index>(normal_.size()); }
  static constexpr Index rows() { return 1; }
  /// Middle of a cell, rad.
  double middle(Index i) const { return start_ + (static_cast<double>(i) + 0.5) * width_; }
  double width() const { return width_; }
  /// Mean gap of a cell with the journal at r, m.
  double gap(Index i, const Vec2& r) const;
  double gap(Index i, Index, const Vec2& r) const { return gap(i, r); }
  /// Nowhere from face to face a cell touches.
  bool open(Index i, const Vec2& r) const;
  /// Content of the full cell with the journal centred, m: what its unknown is counted from.
  double reference(Index i) const { return gap(i, Vec2::Zero()); }
  double reference(Index i, Index) const { return reference(i); }
  /// Axial mean, Pa. content: m.
  double pressure(double content, double gap) const;

  /// What a cell does: the rate at which it empties, m/s, and what it gives to the force.
  template <class T>
  struct Cell {
    T in, out, sides;  ///< through both faces in the sense of theta, and at both sides, m rad/s
    T fed;             ///< what of it the pressure in a groove drives, m rad/s
    T outflow;         ///< (out - in + sides)/width, m/s
    T push[2];         ///< R L (P - supply) int n dtheta: on the housing, N
    T drag;            ///< torque on the journal, N m
  };
  /// before, own, next: contents, m; of cells beyond the ends nothing is asked. ry, rz: journal, m;
  /// slip: rad/s.
  template <class T>
  Cell<T> cell(Index i, const T& ry, const T& rz, const T& slip, const T& before, const T& own,
               const T& next) const;
  template <class T>
  Cell<T> cell(Index i, Index, const T& ry, const T& rz, const T& slip,
               const std::array<T, around>& content) const {
    return cell(i, ry, rz, slip, content[0], content[1], content[2]);
  }
  /// The contents, m, at which nothing changes with the journal still at r; at rest: full.
  /// NaN where the journal stands outside the film.
  std::vector<double> balanced(const Vec2& r, double slip) const;
  /// Force on a journal at r with the oil in balance, N; NaN where there is none.
  Vec2 force_in_balance(const Vec2& r, double slip) const;
  /// That of one cell (KeptBalance).
  double balanced_cell(Index i, Index row, const Vec2& r, double slip) const;

  /// Moves the contents on by a step of implicit Euler of the length 1/rate, s, at whose end the
  /// journal stands at r. False: no solution was found.
  bool advance(const Vec2& r, double slip, double rate, std::vector<double>& content) const;

  /// What a row of the balance in m/s is times to be a force, N s/m.
  double row_factor() const;
  double row_factor(Index, Index) const { return row_factor(); }
  /// Power of the pump that a cell takes, W. fed: Cell::fed; part: of what the walls displace.
  double pump(Index i, double fed, const FilmPoint& p, double part = 1.0) const;
  /// Arm of the push in the torque: half of c_p - c_b, a quarter turn ahead of where the pad is
  /// thinnest, m.
  Vec2 lever() const { return 0.5 * lift_ * Vec2(-thinnest_.y(), thinnest_.x()); }

 private:
  template <class T>
  carried_oil::Oil<T> oil(Index i, const T& ry, const T& rz, const T& content) const;
  template <class T>
  T gap_at(double angle, const T& ry, const T& rz) const;
  template <class T>
  T flow_along(Index face, const T& ry, const T& rz, const T& slip, const carried_oil::Oil<T>* left,
               const carried_oil::Oil<T>* right, T& driven) const;

  FiniteJournal film_;
  mutable KeptBalance last_;
  double start_, width_, clearance_, lift_;
  Vec2 thinnest_;
  std::vector<Vec2> normal_;  ///< int n dtheta of each cell
};

}  // namespace whirl::elements
