// Modes on supports that answer by frequency: every lambda with (lambda^2 M(w) + lambda C(w) +
// K(w)) x = 0 at w = Im lambda.
//
// With the coefficients held at some w this is an ordinary quadratic problem. Its eigenvalues
// lambda_k(w) are continuous in w, and a mode is where Im lambda_k(w) = w. Every branch that
// oscillates at w = 0 begins above the line w; the search goes up through the range of the tables,
// solves for all eigenvalues of least size at its nodes, and follows each branch that can have come
// through the line between two of them (Newton; the step is halved while the shape turns or the
// branch moves as fast as the line). The root is found in its bracket by secant, with bisection as
// the last resort: it cannot cycle.
//
// Nodes: zero, those frequencies of the tables that straight lines between the others do not
// replace to 2 % (of the change that the supports make, there or at half of the rows), where the
// eigenvalues known so far end, and the middle of two nodes between which a branch is lost.
//
// The list is then counted by an independent method (la/wedge_count.hpp): roots at which Im lambda_k
// falls through the line less those at which it rises. Where the count asks for more, the band is
// divided, each part counted, and the eigenvalues nearest to the line in the middle of a part in
// which some are missing are followed to it, until none is, or the part is too narrow to divide.
//
// Left out of the list: roots at which Im lambda_k rises through the line, d Im lambda_k/dw > 1. The
// mass of a motion seen through an undamped table is m - K'/(2 w), negative there. No passive support
// has such a mode where nothing is lost: K falls with w (Foster's theorem). They come from poles of
// the support that lie between two rows of its table or are heavily damped. A falling root and a
// rising one, both missing, cancel in the count.
#pragma once
#include <la/eigen.hpp>
#include <la/wedge_count.hpp>
#include <functional>

namespace whirl::analysis {

/// Adds a mode unless those of its eigenvalue (to 1e-7) in the list span its shape. Whether it was new.
bool add_new(const la::Mode& mode, std::vector<la::Mode>& to);

class OwnFrequency {
 public:
  /// Matrices with the coefficients at w, rad/s; valid until the next call.
  /// @throws Error E81: a table does not reach w.
  using Matrices = std::function<const la::MCK&(double w)>;
  /// frequencies: of the tables, rad/s, at least one; wanted: count and max_frequency as for
  /// la::ModeSolver.
  OwnFrequency(const la::BlockPattern& pattern, std::span<const unsigned char> active,
               const la::ModeOptions& wanted, std::vector<double> frequencies);

  /// All modes that oscillate, ascending in frequency; with a count, the first of them.
  /// certify: counted (known()).
  /// @throws Error (E81): a mode wanted lies where a table does not reach (one that does not feel
  /// the tables may).
  std::vector<la::Mode> solve(const Matrices& at, bool certify = false);
  /// What is known of the list of the last solve().
  struct Known {
    bool counted = false;         ///< the argument settled
    Index missing = 0;            ///< falling roots less rising ones that were not found
    double low = 0, top = 0;      ///< rad/s: band of the list
    double reach = 0;             ///< |Re lambda| <= reach Im lambda
    std::vector<Complex> where;   ///< middle of the narrowest parts where some are missing
    std::vector<Complex> rising;  ///< rising roots met
    Index factorizations = 0, recovered = 0;
  };
  const Known& known() const { return known_; }
  /// The mode near `start`, an eigenpair of a neighbouring problem. nullopt: lost.
  /// @throws Error (E81) as above.
  std::optional<la::Mode> settle(const Matrices& at, const la::Mode& start);
  /// Where coefficients at a real w are used, the decay of the motion is left out of them.
  /// Continued to its complex frequency w - i g, lambda = g + i w, they change by -i g d/dw to
  /// first order, and lambda by -i g l'/(1 + i l'), l' = d lambda_k/dw of its branch (differences
  /// over a quarter of the distance of the rows it lies between, at most w/100). Error of second
  /// order in g over the distance of poles.
  Complex continued(const Matrices& at, const la::Mode& mode);
  /// What all tables cover together, rad/s; held: coefficients stay as they are beyond `high`.
  struct Range {
    double low, high;
    bool held;
  };
  Range range(const Matrices& at);
  const std::vector<double>& frequencies() const { return frequencies_; }
  /// The tables reach down to zero frequency, or are held there.
  bool reaches_zero(const Matrices& at);
  /// Problems with held coefficients that the last solve() solved for all modes.
  Index solved() const { return solved_; }

 private:
  /// A place on a branch. gap: above (>= 0) or below the line.
  struct Point {
    double w;
    la::Mode mode;
    double gap() const { return mode.lambda.imag() - w; }
  };
  /// All that oscillates with the coefficients at w, to the radius `reach`.
  struct Node {
    double w = 0;
    std::vector<la::Mode> modes;
    double reach = 0;
  };

  void find_range(const Matrices& at);
  void choose_rows(const Matrices& at);
  Node node(const Matrices& at, double w, double radius);
  /// Follows what can have come through the line between two nodes; false: some branch was lost.
  bool search(const Matrices& at, const Node& a, const Node& b);
  /// The same, with nodes in between where a branch is lost.
  void search_between(const Matrices& at, const Node& a, const Node& b, int halvings);
  void search_above(const Matrices& at, Node top);
  /// Goes along a branch to another w and adds the modes it meets. The place it ends at; nullopt:
  /// it goes over to the real axis, or it or a root of it was lost (lost_).
  std::optional<Point> trace(const Matrices& at, Point p, double to);
  std::optional<Point> step(const Matrices& at, const Point& from, double w);
  /// Every root between two places of a branch at which it falls through the line; false: not all
  /// were found.
  bool add_roots(const Matrices& at, const Point& low, const Point& high, int depth);
  struct Root {
    Point at;
    bool rising;
  };
  std::optional<Root> root(const Matrices& at, Point low, Point high);
  /// Counts found_ and looks for what is missing.
  void complete(const Matrices& at);
  /// A frequency above the modes wanted, in a gap between those found. share: of the gap.
  double top_of_list(double share) const;
  std::optional<la::WedgeCount> count_between(const Matrices& at, double low, double top);
  /// Looks for roots missing between two frequencies. What is still missing.
  Index recover(const Matrices& at, double low, double top, Index missing, int depth);
  /// Follows eigenvalues near the line at the middle of a part, and adds the roots in that part.
  /// Falling roots less rising ones it has found.
  Index look_between(const Matrices& at, double low, double top, Index missing, bool everywhere);
  /// The root that an eigenpair at `start` leads to without leaving [low, top].
  std::optional<Root> land(const Matrices& at, Point start, double low, double top);
  bool rises(const Matrices& at, const Point& root);
  bool feels_tables(const Matrices& at, const la::Mode& mode);
  bool add(const la::Mode& mode) { return add_new(mode, found_); }
  /// Modes known of a frequency up to w.
  Index within(double w) const;

  const la::BlockPattern& pattern_;
  std::vector<unsigned char> active_;
  la::ModeOptions wanted_;
  std::vector<double> frequencies_;      ///< ascending, all different
  double lowest_ = nan, highest_ = nan;  ///< what the tables cover, rad/s
  bool held_ = false;                    ///< coefficients stay as they are beyond highest_
  std::vector<double> rows_;             ///< frequencies worth a node, ascending
  la::ModeSolver follower_;
  std::optional<la::ModeSolver> scan_;
  Index scan_count_ = 0;
  std::vector<la::Mode> found_;
  std::vector<la::Mode> rising_;
  std::optional<la::WedgeCounter> counter_;
  Known known_;
  Index solved_ = 0;
  bool lost_ = false;  ///< a branch, near the line or above it
};

}  // namespace whirl::analysis
