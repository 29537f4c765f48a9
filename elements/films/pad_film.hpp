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
#pragma once
#include <core/types.hpp>

namespace whirl::elements {

struct PadLoad {
  Vec2 G;           ///< int P n dtheta
  Mat2 by_e, by_W;  ///< dG/de, dG/dW
};

class PadFilm {
 public:
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

 private:
  friend struct PadFilmInside;  ///< tests look at where the film is
  /// In gamma: the ends, those of the core, and how far they may move.
  struct Ends {
    double a, b, core_a, core_b, low, high;
    bool held_a, held_b;
  };
  bool settle(const Vec2& e, const Vec2& W, Ends& ends, int elements, double tolerance,
              int most_passes, int& passes) const;
  int cores(const Vec2& e, const Vec2& W, std::array<Ends, 2>& out) const;
  int solve(const Vec2& e, const Vec2& W, std::array<Ends, 2>& out, int& passes) const;

  double start_, arc_, beta_;
  bool round_;
  int elements_;
};

}  // namespace whirl::elements
