// Part of the quadratic eigensolver (eigen.hpp): the problem, the operator (A - sigma B)^-1 B by
// way of Q(sigma) alone, and the choice of its shift.
#pragma once
#include <algorithm>
#include <cmath>
#include <core/error.hpp>
#include <la/krylov.hpp>
#include <la/multiply.hpp>
#include <la/polish.hpp>

namespace whirl::la {

struct ShiftedOperator {
  using Work = ModeSolver::Work;
  const BlockPattern& pattern;
  std::vector<unsigned char> active;
  ModeOptions opt;
  std::vector<Index> unknown;
  Index n;  ///< active unknowns
  Polisher polisher;
  std::unique_ptr<DirectSolver<double>> real;
  std::unique_ptr<DirectSolver<Complex>> complex;
  Krylov<double> krylov;
  const MCK* m = nullptr;
  bool first_order = false;      ///< M = 0: lambda C + K, an N-sized operator
  bool damped = true;            ///< C is not all zero
  double sigma = 0.0;            ///< real shift of the operator
  Complex shift;                 ///< shift of the operator: sigma, or the user's
  int refinements = 0;           ///< of each solution in the operator
  double alpha = 1.0;            ///< scale of lambda in z = (x, lambda x / alpha)
  std::vector<Pair> known_free;  ///< combinations of ModeOptions::maybe_free that K does not resist
  VecX x_, t_, y_;
  VecXc xc_, tc_, yc_;
  Work work;

  ShiftedOperator(const BlockPattern& p, std::span<const unsigned char> a, const ModeOptions& o)
      : pattern(p),
        active(a.begin(), a.end()),
        opt(o),
        polisher(p, active) {
    if (active.size() != at(6 * p.size()))
      throw std::invalid_argument("ModeSolver: the active mask must have 6 flags a node");
    for (std::size_t u = 0; u < active.size(); ++u)
      if (active[u]) unknown.push_back(static_cast<Index>(u));
    n = static_cast<Index>(unknown.size());
    x_ = t_ = y_ = VecX::Zero(6 * p.size());
    xc_ = tc_ = yc_ = VecXc::Zero(6 * p.size());
  }

  bool complex_shift() const { return opt.shift && opt.shift->imag() != 0.0; }
  Index dimension() const { return first_order ? n : 2 * n; }

  bool factor_real(double s) {
    if (!real) real = make_direct_solver<double>(pattern, active);
    ++work.factorizations;
    return real->factor(*m, s * s, s, 1.0) == Status::ok;
  }

  /// t += Q(s)^-1 (b - Q(s) t) with K t in sums of twice the precision. Returns the size of the
  /// correction relative to t.
  template <class Scalar, class Vec>
  double refine(Vec& t, const Vec& b, DirectSolver<Scalar>& solver, Scalar s, Vec& product) {
    Vec r = b;
    multiply_exact(m->K, t, product);
    r -= product;
    if (!first_order) {
      multiply(m->M, t, product);
      r -= s * s * product;
    }
    if (damped) {
      multiply(m->C, t, product);
      r -= s * product;
    }
    for (std::size_t u = 0; u < active.size(); ++u)
      if (!active[u]) r(static_cast<Index>(u)) = 0.0;
    solver.solve(r);
    t += r;
    product.setZero();
    return r.norm() / t.norm();
  }

  /// Beams of thousands of elements leave the factorisation few correct digits for the smooth
  /// modes: how many steps of refinement the operator needs, from the correction to the response to
  /// a load on all unknowns.
  template <class Scalar>
  void measure_accuracy(DirectSolver<Scalar>& solver, Scalar s) {
    using Vec = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
    Vec b = Vec::Zero(6 * pattern.size()), product = b;
    for (const Index u : unknown)
      b(u) = u % 6 < 3 ? 1.0 : 0.0;
    Vec mass = b;
    multiply(first_order ? m->C : m->M, b, mass);
    b.setZero();
    for (const Index u : unknown)
      b(u) = mass(u);
    if (b.norm() == 0.0) return;
    Vec t = b;
    solver.solve(t);
    const double error = refine(t, b, solver, s, product);
    refinements = error > 1e-3 ? 2 : error > 1e-7 ? 1 : 0;
  }

  /// (x, w) -> (p, q/alpha), all over the active unknowns.
  template <class Scalar, class In, class Vec>
  void apply(const In& in, Vec& out, DirectSolver<Scalar>& solver, Scalar s, Vec& x, Vec& t,
             Vec& y) {
    ++work.operator_products;
    out.resize(dimension());
    for (Index i = 0; i < n; ++i)
      x(unknown[at(i)]) = in(i);
    if (damped)
      multiply(m->C, x, y);
    else
      y.setZero();
    if (!first_order) {
      for (Index i = 0; i < n; ++i)
        x(unknown[at(i)]) = s * in(i) + alpha * in(n + i);
      multiply(m->M, x, t);
      y += t;
    }
    t.setZero();
    for (Index i = 0; i < n; ++i)
      t(unknown[at(i)]) = -y(unknown[at(i)]);
    y = t;
    solver.solve(t);
    for (int k = 0; k < refinements; ++k)
      refine(t, y, solver, s, x);
    for (Index i = 0; i < n; ++i)
      out(i) = t(unknown[at(i)]);
    if (!first_order) out.tail(n) = (in.head(n) + s * out.head(n)) / alpha;
  }

  template <class Scalar>
  auto operation() {
    return [this](const auto& in, auto& out) {
      if constexpr (std::is_same_v<Scalar, double>)
        apply<double>(in, out, *real, sigma, x_, t_, y_);
      else
        apply<Complex>(in, out, *complex, shift, xc_, tc_, yc_);
    };
  }

  /// The least of the sizes of the roots that sets the scale of the shift: motions that hardly
  /// anything resists (a spin slowed by the drag of its films, a rotor on a soft coupling) stand
  /// far below the others; a shift as small as they are would see all others as one.
  static double scale_of(std::vector<double> sizes);
  static constexpr double slow_gap = 30.0;
  static constexpr std::size_t most_slow = 8;
  /// Some frequency of the problem: the lowest one a single unknown would have with all others
  /// held.
  double crude_frequency() const;
  /// rad/s: ten times what any unknown by itself would have.
  double crude_limit() const;
  /// A real shift of half the least nonzero |lambda|, to an order of magnitude: below it rigid-body
  /// modes make K singular, far above it the eigenvalues seen from the shift crowd together.
  void find_shift();
  /// Sets known_free.
  void find_known_free();
  /// Both roots of each known free motion out of the way of krylov.
  void lock_known_free();
  Error singular_problem() const;
  /// fresh: no mode is known yet.
  void prepare_operator(bool fresh);
  void factor_operator(bool fresh);
  VecXc full_vector(const VecXc& z) const;
  /// x <- Q(sigma)^-1 (sigma^2 M + sigma C) x keeps K x = 0 and takes (sigma/omega)^2 off the rest,
  /// time and again.
  static constexpr int purifications = 12;
  void purify(VecX& v);
};

}  // namespace whirl::la
