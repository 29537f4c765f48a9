// What a film does along its pads in one state: pressure, thickness, flow, loss. For results and for
// the heat balance; the forces come from finite_journal.hpp.
//
// Flow through a section of the pad, relative to the housing, in the sense of theta:
//   Q = L (R s h/2 - h^3 P'/(12 eta f_x R)),   P axial mean
// What enters a stretch of film and does not leave at its other end leaves at the sides. Where the
// film has ruptured the flow is that of the rupture; where none has formed yet, that of the groove. Films
// of Reynolds take in what they lack where they form; the inflow of a pad counts it. One shorter than
// 1/12 of its pad takes in as much less as it is shorter, and flows that much less: it vanishes without a
// jump, where one that conserves mass would fill from what is carried to it.
#pragma once
#include <elements/films/finite_journal.hpp>
#include <vector>

namespace whirl::elements {

/// Along one pad, at equidistant angles from its start to its end, in the sense of theta.
struct FilmField {
  std::vector<double> theta;  ///< rad, from +y towards +z
  std::vector<double>
      thickness;  ///< h, m; of a pad with recesses in the middle, or beside a relief track
  std::vector<double> pressure;   ///< axial mean P above ambient, Pa
  std::vector<double> largest;    ///< pressure where it is largest along the axis, Pa
  std::vector<double> slope;      ///< dP/dtheta, Pa/rad
  std::vector<double> viscosity;  ///< eta, Pa s
  std::vector<double> flow;  ///< Q where there is film, m3/s; else that of the stretch before it
                             ///< (on a grid without mass conserved, of the next one at the start)
  std::vector<unsigned char> wet;  ///< film, not ruptured
  /// Of a film on a grid that does not conserve mass, for its heat: GridField::stream and from_groove,
  /// m3/s. Else empty.
  std::vector<double> stream, from_groove;
  /// Of a film on a grid, for its heat: flow with ruptured gaps filled, m3/s; what is turned into heat
  /// from the start of the pad to here, W; the length that is no relief track times h, over the
  /// length, m, and likewise of 1/h, 1/m. Of a film that conserves mass the flow as it is, and of the
  /// length what oil wets. Empty: one profile along the axis.
  std::vector<double> filled, lost, gap, conducting;
  /// Of a profile: the share of the width that oil wets, and its integral from the start of the pad to
  /// here, rad. Empty on a grid.
  std::vector<double> share, wetted;
};

/// One pad's film.
struct FilmStanding {
  Vec2 force = Vec2::Zero();  ///< on the pad, N
  double power = 0;           ///< turned into heat, W
  double inflow = 0,
         outflow = 0;    ///< through the leading and the trailing edge (with what a relief
                         ///< track takes up), m3/s
  double side_flow = 0;  ///< at both sides, m3/s
  double thinnest = 0, thinnest_at = 0;  ///< smallest thickness, m, and where, rad
  double highest = 0, highest_at = 0;    ///< largest pressure, Pa, and where, rad
  double reynolds = 0;                   ///< largest rho R |s| h/eta; 0 where no density is given
};

/// @pre the journal is inside the film at p; samples >= 3.
FilmField sample_film(const FiniteJournal& film, std::size_t pad, const FilmPoint& p,
                      std::size_t samples);
/// Turned into heat in the film of one pad, W. @pre as sample_film.
double film_loss(const FiniteJournal& film, std::size_t pad, const FilmPoint& p);
/// density: of the oil for the Reynolds number, kg/m3.
FilmStanding film_standing(const FiniteJournal& film, std::size_t pad, const FilmPoint& p,
                           double density);

}  // namespace whirl::elements
