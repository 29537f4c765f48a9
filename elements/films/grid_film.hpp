// The film of one pad on a grid in both directions: what FiniteJournal adds up where its surface, or
// its pressure, is not one profile along the axis.
//
// As pad_film.hpp, but without a profile: clearance h = 1 - e.n(theta) + d(theta, zeta), zeta = z/L,
// d = depth/clearance of recesses (tapers, pockets of pressure dams, relief tracks) that are
// symmetric about the middle of the length. With the pressure unit 12 eta (R/c)^2/c
//   d/dtheta (S D - a_x h^3 P_theta) - (R/L)^2 d/dzeta (a_z h^3 P_zeta) = W.n  where P > 0,  P >= 0,
// D the depth in m, S = slip/2: the oil that a recess holds is carried along with half the speed of
// the surface. a_x, a_z: 1/(mu f), f of turbulence.hpp, mu the viscosity over that of reference, alike
// along the axis.
//
// Over half the length, finite volumes along the arc and quadratic elements along the axis. Along the
// arc the flow between two neighbours is the exact one of a film whose thickness varies between them,
// q = (S int D/h^3 - dP)/int 1/h^3 (A. A. Samarskii, The Theory of Difference Schemes, 2001, doi
// 10.1201/9780203908518, ch. 3): a step in the surface lies on a face and costs no accuracy. Along the
// axis a parabola is exact, and the edges of recesses are edges of elements. The complementarity
// problem is solved by policy iteration, which ends at its one solution where the matrix is an M-matrix
// (O. Bokanowski, S. Maroso, H. Zidani, SIAM J. Numer. Anal. 47, 2009, doi 10.1137/08073041X); quadratic
// elements spoil the sign of one coupling in eight. A film that does not settle has no force (NaN).
// Where the film ends its pressure is a parabola, P = r s^2/(2 k) at the last node, s of the distance to
// the next one beyond it, r what its cell loses across the arc, k its conductance along it. What leaves
// the film there is (s - 1/2) r, where the grid has s^2/2 r: the cell lacks r (1 - s)^2/2, which goes
// to zero smoothly as the next node gets film. That is the largest over s of
// (1 - s)/2 r - (1 - s)/s k P, so policy iteration, over s too, still rises to the one solution, and
// forces and their slopes know next to nothing of the grid. (Not beside steps of the surface, where
// pressures have a corner.) Derivatives by the adjoint equation, to rounding.
//
// Films that conserve mass carry what flows into ruptured nodes on along the arc, at no pressure, and form
// where that fills the gap (Elrod; grid_film_carried.cpp). Every node is in balance to rounding, so that
// what comes in through a groove leaves. Oil takes no time on its way.
//
// With N = (W_y, W_z, S) and B the source of each, loads are z = B^T P: the force over (unit R L), and
// the moment of pressure on the steps and slopes of recesses over (-unit R L/2).
#pragma once
#include <core/types.hpp>
#include <array>
#include <span>
#include <vector>

namespace whirl::elements {

/// A recess of a pad, in the middle of the length; its depth goes linearly along the arc.
struct Recess {
  double from = 0, to = 0;              ///< rad from the start of the pad
  double depth_from = 0, depth_to = 0;  ///< m, there
  double width = 1;                     ///< of the length of the bearing, in (0, 1]
  bool open = false;  ///< so deep that it stands at the pressure of the grooves: a relief track
};

/// What drives the film of a pad, in the units above.
struct GridDrive {
  Vec2 e = Vec2::Zero();       ///< eccentricity from the pad's centre, over its clearance
  Vec3 source = Vec3::Zero();  ///< W in m/s, S in rad/s
  double clearance = 1;        ///< c, m
  double reynolds = 0;         ///< of a film of thickness c; 0: laminar
  double edge = 0;             ///< pressure at the ends of the pad and in open recesses
  /// ln mu along the pad, as PadMedium::log_viscosity; empty: mu = 1.
  std::span<const double> log_viscosity{};
  /// Ruptured film carries on what oil there is, and the next one forms where that fills the gap.
  /// S = 0, or a round pad: no difference.
  bool carries = false;
};

struct GridLoad {
  Vec3 z = Vec3::Zero();  ///< loads; of the pressure over that of the edge
  double fed = 0;         ///< flow that the pressure of the edge drives in
  double normal = 0;      ///< what the sources bring where the pressure is that of the edge
  double shear = 0;  ///< int int mu f_s/h dtheta dzeta, where film that conserves mass has ruptured
                     ///< over the share that its oil wets
};
struct GridSlopes {
  Matrix<3, 3> by_source = Matrix<3, 3>::Zero();
  Matrix<3, 2> by_e = Matrix<3, 2>::Zero();
  Vec3 by_reynolds = Vec3::Zero();
  Vec3 shear_by_source = Vec3::Zero();
  Vec2 shear_by_e = Vec2::Zero();
  double shear_by_reynolds = 0;
};

/// Pressures and flows on the grid, for results.
struct GridField {
  std::vector<double> place;             ///< of the columns: rad from the start of the pad
  std::vector<double> mean, largest;     ///< P: mean along the axis, and largest there
  std::vector<double> thickness;         ///< h at the middle, or beside an open recess there
  std::vector<unsigned char> wet;        ///< film somewhere along the axis
  std::vector<double> face_place, flow;  ///< of the faces between them: mean of q over the length
  /// For the heat balance, at the faces, of films that do not conserve mass (else empty): flow of the oil
  /// there is, before the first film what the groove lets go; what first films have taken in from the
  /// groove where they form, summed up in the sense of rotation.
  std::vector<double> stream, from_groove;
  /// And of all films: flow with ruptured gaps filled; from the start of the pad,
  /// shear (of GridLoad::shear) and what the pressure's flows turn into heat. At the columns: int h
  /// and int 1/h over the part of the length that is no open recess.
  std::vector<double> filled, shear, driven, gap, conducting;
  double side = 0, into_open = 0;        ///< flow out at both sides, and into open recesses
  double thinnest = 0, thinnest_at = 0;  ///< h, and where
  double highest = 0, highest_at = 0;    ///< P anywhere, and where
};

/// Places in ascending order, each once.
std::vector<double> distinct_places(std::vector<double> x);

class GridPad {
 public:
  static constexpr int most_columns = 480, most_rows = 16, most_even_rows = 10;
  static constexpr int most_bands = 3;  ///< stretches of the length, recesses of as many widths
  /// start, arc: rad; round: a whole circle without ends. ratio: R/L. columns: along the arc, rows:
  /// along half the length; beside recesses there are some more.
  /// @pre 0 < arc <= 2 pi; 8 <= columns <= most_columns and 2 <= rows <= most_even_rows.
  /// @throws Error E84: recesses beyond the pad, overlapping, of negative depth or impossible width, or
  /// too many of them for the grid.
  GridPad(double start, double arc, bool round, double ratio, int columns, int rows,
          const std::vector<Recess>& recesses);

  /// @pre 1 - e.n > 0 on the pad.
  void load(const GridDrive& in, GridLoad& out) const;
  void load(const GridDrive& in, GridLoad& out, GridSlopes& slopes) const;
  GridField field(const GridDrive& in) const;
  /// Cells along the arc and nodes along half the length, as they came out.
  int columns() const { return static_cast<int>(cells_.size()); }
  int rows() const { return static_cast<int>(rows_.size()); }
  const std::vector<Recess>& recesses() const { return recesses_; }

 private:
  struct Point {
    double cos, sin, weight;
  };
  struct Cell {
    double from, to;  ///< rad from the start
    Vec2 normal;      ///< int n dtheta
    Point points[4];  ///< two in each half
  };
  /// Of a row of nodes along the arc: its part in a band of equal depth along the axis, as a share of
  /// the length. A row at the edge of a recess has one in either band.
  struct Piece {
    std::size_t band;
    double share;
  };
  struct Row {
    std::vector<Piece> pieces;
    double profile = 0;  ///< of a parabola along the axis
  };
  /// Between two rows; to one more than there are: the side. For a unit of int a h^3 dtheta.
  struct Across {
    std::size_t from, to, band;
    double conductance;
  };
  void add_rows(const std::vector<double>& elements, const std::vector<double>& widths);
  /// Depth at the points of cell i in band g, m.
  const std::array<double, 4>& depth(std::size_t i, std::size_t g) const {
    return depth_[i * bands_ + g];
  }
  bool open(std::size_t i, std::size_t g) const { return open_[i * bands_ + g] != 0; }
  bool stepped(std::size_t i, std::size_t g) const { return stepped_[i * bands_ + g] != 0; }
  void mark_steps();
  class Solver;

  double start_, arc_, ratio_;
  std::vector<Recess> recesses_;
  bool round_;
  std::size_t bands_ = 1;
  std::vector<Cell> cells_;
  std::vector<Row> rows_;
  std::vector<Across> across_;
  double side_share_ = 0;  ///< of the length that the nodes at the side stand for
  std::array<double, most_bands> band_shares_{};
  std::vector<std::array<double, 4>> depth_;
  std::vector<unsigned char> open_;
  std::vector<unsigned char> stepped_;  ///< beside an edge where the depth jumps
};

}  // namespace whirl::elements
