// Newton's method for one eigenpair of Q(lambda) x = (lambda^2 M + lambda C + K) x = 0, and what
// goes with it.
#pragma once
#include <la/direct.hpp>
#include <la/eigen.hpp>

namespace whirl::la {

/// An eigenpair being worked on. x is zero at held unknowns.
struct Pair {
  Complex lambda;
  VecXc x;
  VecXc Mx, Cx, Kx;    ///< kept in step with x
  Index from = -1;     ///< mode of the last result it continues
  bool rigid = false;  ///< K x = 0 and lambda = 0
  double residual = 0.0;
  double uncertainty = 0.0;  ///< error of lambda that rounding of M, C, K alone can cause
};

class Polisher {
 public:
  Polisher(const BlockPattern& pattern, std::span<const unsigned char> active);
  /// The problem that all calls below refer to; must stay alive.
  void set(const MCK& m);

  /// Scales x to largest component 1 and computes M x, C x, K x (K x exactly but for its own
  /// rounding). False when x is zero or not finite.
  /// @pre after set(); p.x of length 6 * pattern.size(), as in all that follow.
  bool evaluate(Pair& p, bool exact = false);
  /// The root of x^H Q(s) x nearest to s0.
  static Complex rayleigh_root(const Pair& p, Complex s0);
  /// Newton iterations with a new factorisation each until near, then residual inverse iterations
  /// with the last one, down to the tolerance or the limit that rounding sets. `near`: lambda is
  /// trusted to a part in a thousand and only one factorisation is made. A start with Im lambda = 0
  /// and real x stays real. False when it does not converge.
  bool polish(Pair& p, double tolerance, bool near);
  /// Sets residual (as Mode::residual) and uncertainty; uses Mx, Cx, Kx.
  void assess(Pair& p);
  /// What rounding of K can make of x^H K x.
  double rounding_of_stiffness(const Pair& p);
  /// |x^H K x| at the level of the rounding errors of K: nothing resists the motion x.
  bool is_unresisted(const Pair& p);
  /// Best vectors of a group of close eigenpairs within the space they span: the projected problem,
  /// solved densely. Leaves the group alone when its vectors are dependent.
  /// @pre not empty.
  void separate(std::span<Pair*> group);

  /// Square roots of the diagonal entries of |lambda|^2 |M| + |lambda| |C| + |K|: with them
  /// displacements and angles compare.
  VecX weights(Complex lambda) const;

  Index factorizations = 0;

 private:
  double residual_norm(const Pair& p, Complex lambda);
  bool factor(Complex shift);
  /// The two phases of polish(). exact: K x exactly; floor: least size of lambda that its change
  /// is measured against; shift: that of the last factorisation.
  bool iterate_newton(Pair& p, bool near, bool exact, double floor, Complex& shift);
  bool refine(Pair& p, double tolerance, bool exact, double floor, Complex shift);
  double uncertainty(const Pair& p);
  void mask(VecXc& v) const;
  /// |K| |x| etc. into size_: sum of |cm| |M||x| + |cc| |C||x| + |ck| |K||x|.
  void sizes(const Pair& p, double cm, double cc, double ck);

  std::vector<unsigned char> active_;
  std::vector<Index> held_;
  const MCK* m_ = nullptr;
  // Near an eigenvalue of the chain that is left of a node, block elimination grows although the
  // answer serves; only a pivot that must come from another node needs the general solver.
  std::unique_ptr<DirectSolver<Complex>> block_, general_;
  DirectSolver<Complex>* solver_ = nullptr;
  const BlockPattern& pattern_;
  VecXc y_;
  VecX abs_x_, size_, diagonal_k_, diagonal_c_, diagonal_m_;
};

}  // namespace whirl::la
