// The film of one pad, a stretch of a circle seen from an eccentric journal: what FiniteJournal
// adds up.
//
// Clearance 1 - e.n(theta), n = (cos, sin); source W.n. The pressure P solves the complementarity
// problem of Reynolds (Swift-Stieber):
//   (h^3 P')' - beta h^3 P = -W.n where P > 0,   P' = 0 where the film forms or ruptures,
//       P = 0 at the ends of the pad.
// W.n is one wave, so the film is where W.n > 0 (half a circle) and a little further, the core.
// Every core lies in one stretch of film, a pad has at most two (both at its ends, when it is
// longer than half a circle), and the unknowns are the free ends of those.
//
// Each stretch has its own finite elements from end to end: no grid in space, so nothing jumps when
// an end moves. The coordinate is Sommerfeld's angle gamma (dgamma ~ dtheta/h), in which the
// pressure stays smooth up to contact. Elements of order 4 are condensed to the two ends on the
// way; the loads come out of the elimination, and the error of a load falls with the eighth power
// of the element (P. G. Ciarlet, The Finite Element Method, 1978, ch. 3, for the square of the
// error in energy). Free ends by Newton's method on the flow through them, whose slopes are known:
// the source, and the condensed stiffness. Derivatives are those of the discrete load, by forward
// mode and the implicit function theorem: exact to rounding.
//
// A film whose oil is not alike everywhere (PadMedium) has h^3 a_x and h^3 a_z in place of h^3, a_x =
// 1/(mu f_x), a_z = 1/(mu f_z): mu(theta) the viscosity over that of reference, f_x and f_z what
// turbulence adds (turbulence.hpp) at the Reynolds number of the place, reynolds h/mu. Where the
// pad's ends stand at a pressure, a stretch of film begins there whatever the source, and ruptures
// where P' = 0.
//
// Mass conserving, PadMedium::carry (B. Jakobsson, L. Floberg, Trans. Chalmers 190, 1957; K.-O. Olsson,
// ibid. 308, 1965; H. G. Elrod, J. Lubr. Technol. 103, 1981, doi 10.1115/1.3251669): what leaves a film
// where it ruptures, or a groove where none begins, is carried on as if the gap were `content` =
// h(rupture) thick, and the next film forms where that fills it,
//   h^3 a_x P' = carry (h - content) where the film forms, P' = 0 where it ruptures,
// carry = (surface speed)/2 in the unit of W. A gap that nowhere gets so thin has no film. The content
// is that of the present state: oil takes no time on its way (pad_film_carried.cpp).
#pragma once
#include <core/types.hpp>
#include <array>
#include <span>
#include <vector>

namespace whirl::elements {

struct PadLoad {
  Vec2 G;           ///< int P n dtheta
  Mat2 by_e, by_W;  ///< dG/de, dG/dW
};

/// The oil of a film, in the units of PadFilm.
struct PadMedium {
  /// ln mu at equidistant places from the start of the pad to its end, cubic between them; three at
  /// least, or empty: mu = 1.
  std::span<const double> log_viscosity{};
  double reynolds = 0;  ///< of a film of thickness 1 and mu = 1; 0: laminar everywhere
  double edge = 0;      ///< pressure at both ends of the pad, not negative
  double carry = 0;     ///< oil carried over ruptured stretches, its sign that of the motion; 0: a
                        ///< film forms where P' = 0
};
/// With the slope of the load in PadMedium::reynolds, and what the pressure at the ends brings in:
/// flow through them beside the source.
struct PadFlowLoad : PadLoad {
  Vec2 by_reynolds;
  double fed = 0;
};
/// int mu f_s/(1 - e.n) dtheta, f_s what turbulence adds to the shear; slopes in e and reynolds.
struct PadShear {
  double value;
  Vec2 by_e;
  double by_reynolds;
};
/// A mass-conserving film. Its shear is less where it has ruptured: content/h of the width is wetted.
struct PadCarriedLoad : PadFlowLoad {
  Vec2 by_carry;
  PadShear shear;
  Vec2 shear_by_W;
  double shear_by_carry = 0;
};
/// A pad's pressure along its arc.
struct PadProfile {
  std::vector<double> pressure, slope;  ///< P and dP/dtheta at the angles asked
  std::vector<double> content;  ///< thickness that the oil carried fills where film has ruptured;
                                ///< empty: a film that does not conserve mass
  struct Stretch {
    double from, to;          ///< of film, rad from the start of the pad
    bool free_from, free_to;  ///< ends where it forms or ruptures
    /// What the pressure drives out of it at its ends: those of the condensed film, which balance
    /// what the source brings to rounding.
    double out_from, out_to;
  };
  std::vector<Stretch> films;
};

/// Between the knots of PadMedium::log_viscosity (at least three), at the place 0 to 1 along the pad:
/// Hermite's cubic with slopes of three neighbours. slope: by the place.
double log_viscosity_at(std::span<const double> knots, double place, double& slope);

class PadFilm {
 public:
  /// Of a pad: films shorter than this take in less where they form (film_field.hpp).
  static constexpr double short_film = 1.0 / 12.0;
  static constexpr int order = 4;
  static constexpr int points_of_element = 6;  ///< points of the grid an element stands for

  /// start, arc: rad. round: a whole circle without ends. beta: leakage at the sides, (R/L)^2 times
  /// 10. points: over the arc.
  /// @pre 0 < arc <= 2 pi, beta >= 0, points > 0.
  PadFilm(double start, double arc, bool round, double beta, double points);

  /// Smallest clearance 1 - e.n on the pad; the film exists where it is positive.
  double smallest_clearance(const Vec2& e) const;
  /// @pre smallest_clearance(e) > 0 (also load_and_slopes, mean_slope and shear).
  Vec2 load(const Vec2& e, const Vec2& W) const;
  PadLoad load_and_slopes(const Vec2& e, const Vec2& W) const;
  /// dG/dW in the mean over the directions n of W, 1/pi int G(n) n^T dphi: a film without a source
  /// has another slope in each direction.
  Mat2 mean_slope(const Vec2& e) const;
  /// int dtheta/(1 - e.n), and its gradient in e.
  double shear(const Vec2& e, Vec2& gradient) const;

  // The same through a medium.
  Vec2 load(const Vec2& e, const Vec2& W, const PadMedium& m, double& fed) const;
  PadFlowLoad load_and_slopes(const Vec2& e, const Vec2& W, const PadMedium& m) const;
  Mat2 mean_slope(const Vec2& e, const PadMedium& m) const;
  PadShear shear(const Vec2& e, const PadMedium& m) const;
  /// @pre m.carry is not 0.
  PadCarriedLoad carried(const Vec2& e, const Vec2& W, const PadMedium& m) const;
  /// theta: from the start of the pad, rad, 0 to the arc.
  PadProfile profile(const Vec2& e, const Vec2& W, const PadMedium& m,
                     std::span<const double> theta) const;

 private:
  friend struct PadFilmInside;  ///< tests look at where the film is
  /// In gamma: the ends, those of the core, and how far they may move.
  struct Ends {
    double a, b, core_a, core_b, low, high;
    bool held_a, held_b;
    int forms = -1;  ///< 0, 1: the end a, b is where oil that is carried to it forms a film
    double content = 0;
  };
  static constexpr std::size_t most_films = 4;
  using Films = std::array<Ends, most_films>;
  template <class Medium>
  bool settle(const Vec2& e, const Vec2& W, const Medium& m, Ends& ends, int elements,
              double tolerance, int most_passes, int& passes) const;
  template <class Medium>
  void find(const Vec2& e, const Vec2& W, const Medium& m, Ends& ends, int& passes) const;
  int cores(const Vec2& e, const Vec2& W, std::array<Ends, 2>& out) const;
  int solve(const Vec2& e, const Vec2& W, std::array<Ends, 2>& out, int& passes) const;
  template <class Medium>
  int solve_through(const Vec2& e, const Vec2& W, const Medium& m, Films& out, int& passes) const;
  template <class Medium>
  int fed_films(const Vec2& e, const Vec2& W, const Medium& m, Films& out) const;
  template <class Medium>
  int carried_films(const Vec2& e, const Vec2& W, const Medium& m, Films& out, int& passes) const;
  double shear_by_points(const Vec2& e, Vec2& gradient) const;
  void carry_content(const Vec2& e, double carry, std::span<const double> theta,
                     PadProfile& out) const;
  bool fill(const Vec2& e, int up, double content, double edge, Ends& s) const;

  double start_, arc_, beta_;
  bool round_;
  int elements_;
};

}  // namespace whirl::elements
