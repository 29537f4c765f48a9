// The circumferential Reynolds problem with cavitation that FiniteJournal solves: P >= 0 on a circle of nodes,
//   R_i = D_i P_i - K_{i-1} P_{i-1} - K_i P_{i+1} - b_i = 0 where P_i > 0,  R_i >= 0 where P_i = 0.
// K_i = h^3/spacing between nodes i and i+1, D_i = K_i + K_{i-1} + beta h_i^3 a_i, b_i = -f_i a_i (a: arc of the node).
//
// Free boundaries lie between nodes, at the distance xi from the last filled one, where P = P' = 0. There
//   P_i = c xi^2/(2 h^3),  and the neighbour's value in R_i is the parabola continued, K g = c (spacing - xi)^2/(2 spacing),
// with c = f at the boundary (linear between the nodes). Without this the boundary would jump from node to node, and the damping
// coefficients would be wrong to the first order of the spacing; with it force and tangent are continuous as it moves.
// So the unknown of such an end node is xi in place of P.
#pragma once
#include <elements/finite_journal.hpp>

namespace whirl::elements {

class ReynoldsLine {
 public:
  static constexpr int max_nodes = JournalSurface::max_nodes;
  using Line = std::array<double, max_nodes>;

  ReynoldsLine(const FiniteJournal& k, const FilmPoint& p);
  /// False when the journal touches the bearing.
  bool inside() const { return inside_; }
  void run();
  bool any_pressure() const { return any_; }
  int passes() const { return passes_; }
  double P(int i) const { return P_[at(i)]; }
  double h(int i) const { return h_[at(i)]; }   ///< in units of the clearance

  /// Derivatives of sum_i g_i P_i in (r, w, slip) at the solution; r in metres.
  struct Gradient { Vec2 r, w; double slip; };
  Gradient gradient(const Line& g) const;

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  int prev(int i) const { return i == 0 ? n_ - 1 : i - 1; }
  int next(int i) const { return i + 1 == n_ ? 0 : i + 1; }
  bool open(int i, int side) const;              ///< free boundary (not a groove, not a lone node) beyond node i
  void find_cut();
  void guess();
  bool settle_sets();
  bool settle_boundaries();
  void refresh();
  void solve(Line& lower, Line& diagonal, Line& upper, Line& x) const;
  double mid(int gap) const;                     ///< h between gap and gap + 1

  const JournalSurface& s_;
  const FilmPoint& p_;
  int n_;
  double beta_, c_;
  bool inside_ = true, any_ = false;
  int cut_ = 0, passes_ = 0;
  Line h_, K_, D_, f_, b_, P_;
  std::array<bool, max_nodes> zero_;
  // End nodes: side of the boundary (+1, -1; 0 for ordinary nodes), distance xi, dP/dxi and d(K g)/dxi.
  std::array<signed char, max_nodes> end_;
  Line xi_, dP_, Kg_, dKg_;
};

}  // namespace whirl::elements
