#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <core/error.hpp>
#include <la/eigen.hpp>
#include <la/krylov.hpp>
#include <la/multiply.hpp>
#include <la/polish.hpp>

namespace whirl::la {

namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// What one look at the projected matrix gives: Ritz values by falling size, with residuals.
struct Ritz {
  std::vector<Complex> theta;
  std::vector<double> residual;
  MatXc y;  ///< eigenvectors of H, in the same order
};

template <class Scalar>
Ritz look(const Krylov<Scalar>& krylov) {
  const Index p = krylov.processed();
  using Solver = std::conditional_t<std::is_same_v<Scalar, double>, Eigen::EigenSolver<MatX>, Eigen::ComplexEigenSolver<MatXc>>;
  const Solver eig(typename Krylov<Scalar>::Mat(krylov.projected()));
  const VecXc values = eig.eigenvalues();
  const MatXc vectors = eig.eigenvectors();
  std::vector<Index> order(at(p));
  for (Index j = 0; j < p; ++j) order[at(j)] = j;
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return std::abs(values(a)) > std::abs(values(b)); });
  Ritz r;
  r.y.resize(p, p);
  const typename Krylov<Scalar>::Mat rest = krylov.rest();
  for (Index j = 0; j < p; ++j) {
    const Index e = order[at(j)];
    r.theta.push_back(values(e));
    r.y.col(j) = vectors.col(e) / vectors.col(e).norm();
    r.residual.push_back(rest.rows() == 0 ? 0.0 : (rest.template cast<Complex>() * r.y.col(j)).norm());
  }
  return r;
}

}  // namespace

struct ModeSolver::Impl {
  const BlockPattern& pattern;
  std::vector<unsigned char> active;
  ModeOptions opt;
  std::vector<Index> unknown;
  Index n;  ///< active unknowns
  Polisher polisher;
  std::unique_ptr<DirectSolver<double>> real;
  std::unique_ptr<DirectSolver<Complex>> complex;
  Krylov<double> krylov;
  Krylov<Complex> krylov_complex;
  const MCK* m = nullptr;
  bool first_order = false;   ///< M = 0: lambda C + K, an N-sized operator
  bool damped = true;         ///< C is not all zero
  double sigma = 0.0;         ///< real shift of the operator
  Complex shift;              ///< shift of the operator: sigma, or the user's
  int refinements = 0;        ///< of each solution in the operator
  double alpha = 1.0;         ///< scale of lambda in z = (x, lambda x / alpha)
  VecX x_, t_, y_;
  VecXc xc_, tc_, yc_;
  std::vector<Pair> known;
  std::vector<VecXc> deflated;  ///< Ritz vectors z that polishing could not make anything new of; out of the way of the searches of this call
  std::vector<Mode> result;
  Work work;

  Impl(const BlockPattern& p, std::span<const unsigned char> a, const ModeOptions& o)
      : pattern(p), active(a.begin(), a.end()), opt(o), polisher(p, active) {
    if (active.size() != at(6 * p.size())) throw std::invalid_argument("ModeSolver: the active mask must have 6 flags a node");
    for (std::size_t u = 0; u < active.size(); ++u)
      if (active[u]) unknown.push_back(static_cast<Index>(u));
    n = static_cast<Index>(unknown.size());
    x_ = t_ = y_ = VecX::Zero(6 * p.size());
    xc_ = tc_ = yc_ = VecXc::Zero(6 * p.size());
  }

  bool complex_shift() const { return opt.shift && opt.shift->imag() != 0.0; }
  Complex centre() const { return opt.shift.value_or(0.0); }
  double key(Complex lambda) const {
    return std::min(std::abs(lambda - centre()), std::abs(std::conj(lambda) - centre()));
  }
  bool counts(const Pair& p) const { return opt.real_roots || p.lambda.imag() != 0.0; }
  Index dimension() const { return first_order ? n : 2 * n; }

  // ---- the operator ----------------------------------------------------------------------------------------------------------

  bool factor_real(double s) {
    if (!real) real = make_direct_solver<double>(pattern, active);
    ++work.factorizations;
    return real->factor(*m, s * s, s, 1.0) == Status::ok;
  }

  /// t += Q(s)^-1 (b - Q(s) t) with K t in sums of twice the precision. Returns the size of the correction relative to t.
  template <class Scalar, class Vec>
  double refine(Vec& t, const Vec& b, DirectSolver<Scalar>& solver, Scalar s, Vec& work) {
    Vec r = b;
    multiply_exact(m->K, t, work);
    r -= work;
    if (!first_order) multiply(m->M, t, work), r -= s * s * work;
    if (damped) multiply(m->C, t, work), r -= s * work;
    for (std::size_t u = 0; u < active.size(); ++u)
      if (!active[u]) r(static_cast<Index>(u)) = 0.0;
    solver.solve(r);
    t += r;
    work.setZero();
    return r.norm() / t.norm();
  }

  /// Beams of thousands of elements leave the factorisation few correct digits for the smooth modes: how many steps of refinement the
  /// operator needs, from the correction to the response to a load on all unknowns.
  template <class Scalar> void measure_accuracy(DirectSolver<Scalar>& solver, Scalar s) {
    using Vec = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
    Vec b = Vec::Zero(6 * pattern.size()), work = b;
    for (const Index u : unknown) b(u) = u % 6 < 3 ? 1.0 : 0.0;
    Vec mass = b;
    multiply(first_order ? m->C : m->M, b, mass);
    b.setZero();
    for (const Index u : unknown) b(u) = mass(u);
    if (b.norm() == 0.0) return;
    Vec t = b;
    solver.solve(t);
    const double error = refine(t, b, solver, s, work);
    refinements = error > 1e-3 ? 2 : error > 1e-7 ? 1 : 0;
  }

  /// (x, w) -> (p, q/alpha), all over the active unknowns.
  template <class Scalar, class In, class Vec>
  void apply(const In& in, Vec& out, DirectSolver<Scalar>& solver, Scalar s, Vec& x, Vec& t, Vec& y) {
    ++work.operator_products;
    out.resize(dimension());
    for (Index i = 0; i < n; ++i) x(unknown[at(i)]) = in(i);
    if (damped) multiply(m->C, x, y);
    else y.setZero();
    if (!first_order) {
      for (Index i = 0; i < n; ++i) x(unknown[at(i)]) = s * in(i) + alpha * in(n + i);
      multiply(m->M, x, t);
      y += t;
    }
    t.setZero();
    for (Index i = 0; i < n; ++i) t(unknown[at(i)]) = -y(unknown[at(i)]);
    y = t;
    solver.solve(t);
    for (int k = 0; k < refinements; ++k) refine(t, y, solver, s, x);
    for (Index i = 0; i < n; ++i) out(i) = t(unknown[at(i)]);
    if (!first_order) out.tail(n) = (in.head(n) + s * out.head(n)) / alpha;
  }

  template <class Scalar> auto operation() {
    return [this](const auto& in, auto& out) {
      if constexpr (std::is_same_v<Scalar, double>)
        apply<double>(in, out, *real, sigma, x_, t_, y_);
      else
        apply<Complex>(in, out, *complex, shift, xc_, tc_, yc_);
    };
  }

  // ---- shift -----------------------------------------------------------------------------------------------------------------

  /// Some frequency of the problem: the lowest one a single unknown would have with all others held.
  double crude_frequency() const {
    double best = infinity;
    for (Index i = 0; i < pattern.size(); ++i) {
      const Index s = pattern.diagonal(i);
      for (int c = 0; c < 6; ++c) {
        if (!active[at(6 * i + c)]) continue;
        const double k = std::abs(m->K.block(s)(c, c)), mm = std::abs(m->M.block(s)(c, c)), cc = std::abs(m->C.block(s)(c, c));
        if (k <= 0.0) continue;
        if (!first_order && mm > 0.0) best = std::min(best, std::sqrt(k / mm));
        if (first_order && cc > 0.0) best = std::min(best, k / cc);
      }
    }
    return best < infinity && best > 0.0 ? best : 1.0;
  }

  /// A real shift of half the least nonzero |lambda|, to an order of magnitude: below it rigid-body modes make K singular,
  /// far above it the eigenvalues seen from the shift crowd together.
  void find_shift() {
    double s = 1e-3 * crude_frequency(), good = 0.0;
    for (int round = 0; round < 12; ++round) {
      if (!factor_real(s)) {
        // An eigenvalue, or too small to lift rigid-body modes above rounding.
        if (good > 0.0) break;
        s *= 1.37 * (1 << round);
        continue;
      }
      good = sigma = alpha = s;
      shift = s;
      krylov.reset(dimension(), 11);
      for (int k = 0; k < 14; ++k)
        if (!krylov.step(operation<double>())) break;
      const Ritz r = look(krylov);
      double least = infinity;
      for (std::size_t j = 0; j < r.theta.size(); ++j) {
        if (!(std::abs(r.theta[j]) > 0.0)) continue;
        const Complex lambda = s + 1.0 / r.theta[j];
        // Rigid-body motions do not set the scale; rounding moves their double zero to about 1e-8 of the highest frequency.
        if (std::abs(lambda) < 0.1 * s) {
          Pair p;
          p.x = full_vector(krylov.searched_basis().topRows(n) * r.y.col(static_cast<Index>(j)));
          VecX v = p.x.real();
          purify(v);
          p.x = v;
          if (!polisher.evaluate(p) || polisher.is_unresisted(p)) continue;
        }
        least = std::min(least, std::abs(lambda));
      }
      if (!(least < infinity) || (least > 0.3 * s && least < 30.0 * s)) return;
      s = 0.5 * least;
    }
    sigma = alpha = good;
    shift = good;
    if (!(good > 0.0) || !factor_real(good)) throw singular_problem();
  }

  Error singular_problem() const {
    const Index u = real ? real->singular_unknown() : complex->singular_unknown();
    return run_error("E61", "the eigenvalue problem cannot be factored: unknown " + std::to_string(u % 6) + " of node " + std::to_string(u / 6) +
                                " has neither stiffness nor mass",
                     "give the node mass or stiffness in this direction, or hold it", "node " + std::to_string(u / 6));
  }

  void prepare_operator() {
    factor_operator();
    if (complex_shift()) measure_accuracy<Complex>(*complex, shift);
    else measure_accuracy<double>(*real, sigma);
  }

  void factor_operator() {
    refinements = 0;
    if (complex_shift()) {
      shift = *opt.shift;
      alpha = std::max(std::abs(shift), 1e-300);
      if (!complex) complex = make_direct_solver<Complex>(pattern, active);
      for (int tries = 0; tries < 4; ++tries) {
        ++work.factorizations;
        if (complex->factor(*m, shift * shift, shift, 1.0) == Status::ok) return;
        shift *= Complex(1.0 + 1e-3, 1e-3);
      }
      throw singular_problem();
    }
    if (opt.shift) {
      sigma = opt.shift->real();
      if (sigma == 0.0 && known.empty()) {
        // Zero is fine unless something moves freely; alpha only balances the two halves of z.
        alpha = crude_frequency() * 1e-2;
      } else if (sigma != 0.0) {
        alpha = std::abs(sigma);
      }
      for (int tries = 0; tries < 4; ++tries) {
        if (factor_real(sigma)) {
          shift = sigma;
          return;
        }
        sigma += 1e-3 * alpha;
      }
      throw singular_problem();
    }
    if (sigma > 0.0 && factor_real(sigma)) {
      shift = sigma;
      return;
    }
    find_shift();
  }

  // ---- eigenpairs ------------------------------------------------------------------------------------------------------------

  VecXc full_vector(const VecXc& z) const {
    VecXc x = VecXc::Zero(6 * pattern.size());
    for (Index i = 0; i < n; ++i) x(unknown[at(i)]) = z(i);
    return x;
  }

  /// Makes candidates of a Ritz pair. In a real problem a double real root shows up as a complex pair a rounding error apart: two
  /// candidates then, of its real and imaginary parts.
  void suggest(std::vector<Pair>& found, Complex lambda, const VecXc& z, bool real_problem, std::vector<VecXc>* vectors) const {
    const auto push = [&](Complex l, VecXc v) {
      Pair p;
      p.lambda = l;
      p.x = full_vector(v);
      if (vectors) p.from = static_cast<Index>(vectors->size()), vectors->push_back(std::move(v));
      found.push_back(std::move(p));
    };
    if (!real_problem || std::abs(lambda.imag()) > 1e-6 * std::abs(lambda)) return push(lambda, z);
    push(lambda.real(), z.real().cast<Complex>());
    if (lambda.imag() != 0.0) push(lambda.real(), z.imag().cast<Complex>());
  }

  /// Adds a polished pair unless it is already there: its vector in the span of those with the same eigenvalue.
  bool add(Pair&& p) {
    if (p.lambda.imag() < 0.0) {
      p.lambda = std::conj(p.lambda);
      p.x = p.x.conjugate().eval();
      p.Mx = p.Mx.conjugate().eval(), p.Cx = p.Cx.conjugate().eval(), p.Kx = p.Kx.conjugate().eval();
    }
    polisher.assess(p);
    std::vector<const Pair*> close;
    for (const Pair& k : known)
      if (std::abs(k.lambda - p.lambda) <= 1e-7 * std::abs(p.lambda) + 10.0 * (k.uncertainty + p.uncertainty)) close.push_back(&k);
    if (!close.empty()) {
      MatXc a(p.x.size(), static_cast<Index>(close.size()));
      for (std::size_t j = 0; j < close.size(); ++j) a.col(static_cast<Index>(j)) = close[j]->x;
      const VecXc rest = p.x - a * a.colPivHouseholderQr().solve(p.x);
      if (rest.norm() < 0.05 * p.x.norm()) return false;
    }
    known.push_back(std::move(p));
    return true;
  }

  /// x <- Q(sigma)^-1 (sigma^2 M + sigma C) x keeps K x = 0 and takes (sigma/omega)^2 off the rest, four times.
  void purify(VecX& v) {
    for (int k = 0; k < 4; ++k) {
      multiply(m->M, v, t_);
      multiply(m->C, v, y_);
      y_ = sigma * (sigma * t_ + y_);
      v.setZero();
      for (const Index u : unknown) v(u) = y_(u);
      real->solve(v);
    }
  }

  /// The rigid-body motions in the span of the candidates' real and imaginary parts and of those already known.
  bool add_rigid(const std::vector<Pair>& candidates) {
    if (candidates.empty()) return false;
    const Index before = std::count_if(known.begin(), known.end(), [](const Pair& p) { return p.rigid; });
    std::vector<VecX> columns;
    const auto take = [&](VecX v) {
      const double size = v.norm();
      if (!(size > 0.0)) return;
      v /= size;
      if (!complex_shift() && sigma != 0.0) purify(v);
      columns.push_back(v / v.norm());
    };
    for (const Pair& p : known)
      if (p.rigid) take(p.x.real());
    for (const Pair& p : candidates) {
      take(p.x.real());
      if (p.x.imag().norm() > 1e-6 * p.x.real().norm()) take(p.x.imag());
    }
    MatX a(6 * pattern.size(), static_cast<Index>(columns.size()));
    for (Index j = 0; j < a.cols(); ++j) a.col(j) = columns[at(j)];
    const Eigen::JacobiSVD<MatX> svd(a, Eigen::ComputeThinU);
    std::erase_if(known, [](const Pair& p) { return p.rigid; });
    Index after = 0;
    for (Index j = 0; j < a.cols() && svd.singularValues()(j) > 1e-5 * svd.singularValues()(0); ++j) {
      Pair p;
      p.lambda = 0.0;
      p.x = svd.matrixU().col(j);
      p.rigid = true;
      if (!polisher.evaluate(p) || !polisher.is_unresisted(p)) continue;
      known.push_back(std::move(p));
      ++after;
    }
    return after > before;
  }

  /// Polishes what a search has found (near) or what a neighbouring problem suggests, and adds it. What does not lead to anything new is left in
  /// `found`.
  bool take(std::vector<Pair>& found, bool near) {
    bool any = false;
    std::vector<Pair> rest, rigid;
    for (Pair& p : found) {
      // Rounding of a double zero eigenvalue shows up as far as 1e-3 of the shift.
      if (!first_order && std::abs(p.lambda) < 1e-3 * std::abs(shift) && polisher.evaluate(p) && polisher.is_unresisted(p)) {
        rigid.push_back(std::move(p));
        continue;
      }
      Pair q = p;
      if (near) q.from = -1;
      if (polisher.polish(q, opt.tolerance, near) && add(std::move(q))) any = true;
      else rest.push_back(std::move(p));
    }
    if (add_rigid(rigid)) any = true;
    else rest.insert(rest.end(), std::make_move_iterator(rigid.begin()), std::make_move_iterator(rigid.end()));
    found = std::move(rest);
    return any;
  }

  void sort_known() {
    std::stable_sort(known.begin(), known.end(), [&](const Pair& a, const Pair& b) { return key(a.lambda) < key(b.lambda); });
  }

  /// Distance from the centre that must be free of unknown eigenvalues; infinity while too few are known.
  double wanted_radius() const {
    if (opt.count <= 0) return opt.max_frequency;
    Index c = 0;
    for (const Pair& p : known)
      if (counts(p) && ++c == opt.count) return std::min(key(p.lambda), opt.max_frequency);
    return opt.max_frequency;
  }
  Index missing() const {
    if (opt.count <= 0) return 0;
    return opt.count + opt.guard - std::count_if(known.begin(), known.end(), [&](const Pair& p) { return counts(p); });
  }

  template <class Scalar> void lock_known(Krylov<Scalar>& k) {
    typename Krylov<Scalar>::Vec z(dimension());
    const auto lock = [&](const VecXc& x, Complex lambda) {
      if constexpr (std::is_same_v<Scalar, double>) {
        for (const bool imaginary : {false, true}) {
          if (imaginary && lambda.imag() == 0.0) continue;
          for (Index i = 0; i < n; ++i) {
            const Complex a = x(unknown[at(i)]), b = lambda * a / alpha;
            z(i) = imaginary ? a.imag() : a.real();
            if (!first_order) z(n + i) = imaginary ? b.imag() : b.real();
          }
          k.lock(z);
        }
      } else {
        for (Index i = 0; i < n; ++i) {
          z(i) = x(unknown[at(i)]);
          if (!first_order) z(n + i) = lambda * z(i) / alpha;
        }
        k.lock(z);
      }
    };
    typename Krylov<Scalar>::Vec image;
    for (const Pair& p : known) {
      lock(p.x, p.lambda);
      if constexpr (!std::is_same_v<Scalar, double>)
        if (p.lambda.imag() != 0.0) lock(p.x.conjugate(), std::conj(p.lambda));
      if (!p.rigid || first_order) continue;
      // Steady drift (0, x) belongs to the invariant space of a free motion when nothing damps it: the operator then makes
      // -(alpha / shift^2) x and the like of it.
      for (Index i = 0; i < n; ++i) {
        z(i) = 0.0;
        if constexpr (std::is_same_v<Scalar, double>) z(n + i) = p.x(unknown[at(i)]).real();
        else z(n + i) = p.x(unknown[at(i)]);
      }
      operation<Scalar>()(z, image);
      Scalar s;
      if constexpr (std::is_same_v<Scalar, double>) s = sigma;
      else s = shift;
      image.head(n) += alpha / (s * s) * z.tail(n);
      if (image.head(n).norm() < 1e-4 * alpha / std::norm(s) * z.norm()) k.lock(z);
    }
    for (const VecXc& v : deflated) {
      if constexpr (std::is_same_v<Scalar, double>) {
        k.lock(v.real());
        if (v.imag().norm() > 0.0) k.lock(v.imag());
      } else {
        k.lock(v);
      }
    }
  }

  /// One Arnoldi run in the complement of what is known. False: nothing unknown is left within the wanted radius.
  template <class Scalar> bool search(Krylov<Scalar>& k, unsigned seed) {
    ++work.searches;
    k.reset(dimension(), seed);
    lock_known(k);
    const double offset = std::abs(shift - centre());
    const Index lacking = missing();
    const bool growing = lacking > 0;
    const double radius = growing ? opt.max_frequency : wanted_radius();
    if (growing) {
      k.inject();
      k.inject();  // two vectors: the pairs of isotropic rotors come out together
    }
    Index next_look = growing ? std::max<Index>(12, 4 * std::max<Index>(lacking, 1) + 4) : 8;
    const auto op = operation<Scalar>();
    while (true) {
      bool exhausted = false;
      while (k.processed() < next_look && !exhausted) exhausted = !k.step(op);
      if (k.processed() == 0) return false;
      const Ritz ritz = look(k);
      // Converged Ritz values before the first that is not; the converse distance bounds what is still unknown.
      std::vector<Pair> found;
      std::vector<VecXc> vectors;
      Index counted = 0;
      bool all = true;
      double reach = infinity;
      for (std::size_t j = 0; j < ritz.theta.size(); ++j) {
        const double size = std::abs(ritz.theta[j]);
        // Not normal, the operator may be off by several residuals.
        const double distance = 1.0 / (size + 10.0 * ritz.residual[j]) - offset;
        const bool beyond = size <= 0.0 || distance > radius;
        if (!exhausted && (beyond || ritz.residual[j] > 1e-5 * size)) {
          reach = std::min(reach, distance);
          all = beyond;
          break;
        }
        if (size <= 1e-12 * std::abs(ritz.theta[0])) break;  // infinite eigenvalues
        const Complex lambda = shift + 1.0 / ritz.theta[j];
        if (1.0 / size - offset > radius) break;
        const bool lower = lambda.imag() < 0.0;
        if (lower && std::is_same_v<Scalar, double>) continue;
        const VecXc z = k.searched_basis() * ritz.y.col(static_cast<Index>(j));
        const std::size_t before = found.size();
        suggest(found, lambda, z, std::is_same_v<Scalar, double>, &vectors);
        if (opt.real_roots || found.back().lambda.imag() != 0.0) counted += static_cast<Index>(found.size() - before);
      }
      const bool enough = growing && opt.count > 0 && counted >= lacking && lacking > 0;
      if (exhausted || enough || all) {
        if (found.empty()) return false;
        take(found, true);
        sort_known();
        separate_close();
        for (const Pair& p : found) deflated.push_back(std::move(vectors[at(p.from)]));
        return !(exhausted && k.locked() == 0);
      }
      next_look = k.processed() + std::max<Index>(4, k.processed() / 5);
    }
  }

  /// Everything dense: for a handful of unknowns.
  void solve_dense() {
    const double s = sigma;
    const Index d = dimension();
    MatX op(d, d);
    VecX out(d);
    for (Index j = 0; j < d; ++j) {
      apply<double>(VecX::Unit(d, j), out, *real, s, x_, t_, y_);
      op.col(j) = out;
    }
    const Eigen::EigenSolver<MatX> eig(op);
    double largest = 0.0;
    for (Index j = 0; j < d; ++j) largest = std::max(largest, std::abs(eig.eigenvalues()(j)));
    std::vector<Pair> found;
    for (Index j = 0; j < d; ++j) {
      const Complex theta = eig.eigenvalues()(j);
      // Eigenvalues at infinity come out as rounding; double ones as its square root.
      if (!(std::abs(theta) > 1e-9 * largest)) continue;
      const Complex lambda = s + 1.0 / theta;
      if (lambda.imag() >= 0.0) suggest(found, lambda, eig.eigenvectors().col(j), true, nullptr);
    }
    take(found, true);
    sort_known();
    separate_close();
  }

  void start_from_known() {
    // A better eigenvalue from each old vector, better vectors within groups of close ones, then Newton.
    std::vector<Pair> old = std::move(known);
    known.clear();
    std::vector<Pair*> group;
    std::vector<Pair> found;
    for (Pair& p : old) {
      if (!polisher.evaluate(p)) continue;
      if (p.rigid && polisher.is_unresisted(p)) {
        known.push_back(std::move(p));
        continue;
      }
      p.rigid = false;
      if (p.lambda == 0.0) p.lambda = Complex(0.0, 1e-3 * std::abs(shift));
      found.push_back(std::move(p));
    }
    std::stable_sort(found.begin(), found.end(), [](const Pair& a, const Pair& b) {
      return a.lambda.imag() != b.lambda.imag() ? a.lambda.imag() < b.lambda.imag() : a.lambda.real() < b.lambda.real();
    });
    for (std::size_t i = 0; i < found.size();) {
      group.clear();
      std::size_t j = i;
      do group.push_back(&found[j++]);
      while (j < found.size() && group.size() < 8 &&
             std::abs(found[j].lambda - found[j - 1].lambda) < 0.05 * std::abs(found[j].lambda));
      polisher.separate(group);
      i = j;
    }
    take(found, false);
    sort_known();
    separate_close();
  }

  /// Vectors of eigenvalues too close for one-by-one polishing, by the projected problem of each group.
  void separate_close() {
    std::vector<Pair> all = std::move(known);
    known.clear();
    std::vector<Pair*> group;
    std::vector<std::size_t> rest;
    std::vector<bool> done(all.size(), false);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (done[i] || all[i].rigid) continue;
      group.assign(1, &all[i]);
      for (std::size_t j = i + 1; j < all.size(); ++j)
        if (!done[j] && !all[j].rigid && std::abs(all[j].lambda - all[i].lambda) < 1e-4 * std::abs(all[i].lambda)) {
          group.push_back(&all[j]);
          done[j] = true;
        }
      if (group.size() == 1) continue;
      polisher.separate(group);
      for (Pair* p : group) polisher.evaluate(*p);
    }
    for (Pair& p : all) {
      if (p.rigid) known.push_back(std::move(p));
      else add(std::move(p));
    }
    sort_known();
  }

  void collect() {
    std::vector<Mode> modes;
    std::vector<Index> index_of(known.size(), -1);
    std::vector<std::size_t> chosen;
    Index c = 0;
    for (std::size_t i = 0; i < known.size(); ++i) {
      Pair& p = known[i];
      if (!counts(p)) continue;
      if (opt.count > 0 && c == opt.count) break;
      ++c;
      if (opt.count <= 0 ? std::abs(p.lambda) > opt.max_frequency : p.lambda.imag() > opt.max_frequency) continue;
      chosen.push_back(i);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
      const Complex x = known[a].lambda, y = known[b].lambda;
      return x.imag() != y.imag() ? x.imag() < y.imag() : std::abs(x) < std::abs(y);
    });
    for (const std::size_t i : chosen) {
      Pair& p = known[i];
      if (p.rigid) polisher.assess(p);
      modes.push_back({p.lambda, p.x, p.residual, p.from});
    }
    for (Pair& p : known) p.from = -1;
    for (std::size_t j = 0; j < chosen.size(); ++j) known[chosen[j]].from = static_cast<Index>(j);
    result = std::move(modes);
  }

  void set(const MCK& matrices) {
    m = &matrices;
    const auto zero = [](const BlockMatrix<6>& a) {
      return std::all_of(a.data(), a.data() + a.value_count(), [](double v) { return v == 0.0; });
    };
    first_order = zero(m->M);
    damped = !zero(m->C);
    polisher.set(matrices);
  }

  void solve(const MCK& matrices) {
    work = {};
    polisher.factorizations = 0;
    set(matrices);
    result.clear();
    deflated.clear();
    if (n == 0 || (first_order && !damped)) {
      known.clear();
      return;
    }
    prepare_operator();
    if (!known.empty()) start_from_known();
    const bool dense = n <= opt.dense_below && !complex_shift();
    if (dense) {
      solve_dense();
    } else {
      for (unsigned seed = 1; seed < 40; ++seed)
        if (!(complex_shift() ? search(krylov_complex, seed) : search(krylov, seed))) break;
    }
    // Only what is wanted, and the guard, is carried on.
    if (opt.count > 0) {
      Index c = 0;
      std::size_t keep = 0;
      while (keep < known.size() && c < opt.count + opt.guard) c += counts(known[keep++]) ? 1 : 0;
      known.resize(keep);
    }
    collect();
    rescale_shift();
    work.factorizations += polisher.factorizations;
  }

  void rescale_shift() {
    if (opt.shift) return;
    double least = infinity;
    for (const Pair& p : known)
      if (!p.rigid) least = std::min(least, std::abs(p.lambda));
    if (least < infinity && (least < 0.5 * sigma || least > 10.0 * sigma) && least > 1e-5 * sigma) sigma = alpha = 0.5 * least;
  }
};

ModeSolver::ModeSolver(const BlockPattern& pattern, std::span<const unsigned char> active, const ModeOptions& options)
    : impl_(std::make_unique<Impl>(pattern, active, options)) {}
ModeSolver::~ModeSolver() = default;
ModeSolver::ModeSolver(ModeSolver&&) noexcept = default;

const std::vector<Mode>& ModeSolver::solve(const MCK& m) {
  impl_->solve(m);
  return impl_->result;
}

void ModeSolver::reset() {
  impl_->known.clear();
  impl_->sigma = 0.0;
}

std::optional<Mode> ModeSolver::follow(const MCK& m, const Mode& start) {
  impl_->set(m);
  Pair p;
  p.lambda = start.lambda;
  p.x = start.x;
  if (!impl_->polisher.polish(p, impl_->opt.tolerance, false)) return std::nullopt;
  impl_->polisher.assess(p);
  return Mode{p.lambda, p.x, p.residual, -1};
}

ModeSolver::Work ModeSolver::work() const { return impl_->work; }

std::vector<Mode> quadratic_modes(const MCK& m, std::span<const unsigned char> active, const ModeOptions& options) {
  return ModeSolver(m.K.pattern(), active, options).solve(m);
}

}  // namespace whirl::la
