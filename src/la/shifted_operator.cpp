#include <la/shifted_operator.hpp>

#include <la/dense.hpp>
#include <la/ritz.hpp>

namespace whirl::la {

double ShiftedOperator::scale_of(std::vector<double> sizes) {
  std::sort(sizes.begin(), sizes.end());
  std::size_t first = 0;
  // More roots stand beyond the gap than before it.
  for (std::size_t k = 0; 2 * (k + 1) < sizes.size() && k < most_slow; ++k)
    if (sizes[k + 1] > slow_gap * sizes[k]) first = k + 1;
  return sizes.empty() ? infinity : sizes[first];
}

double ShiftedOperator::crude_frequency() const {
  constexpr double rounding = 1e-10;  // what is slower than this part of the fastest is none
  std::vector<double> rates;
  for (Index i = 0; i < pattern.size(); ++i) {
    const Index s = pattern.diagonal(i);
    for (int c = 0; c < 6; ++c) {
      if (!active[at(6 * i + c)]) continue;
      const double k = std::abs(m->K.block(s)(c, c)), mm = std::abs(m->M.block(s)(c, c)),
                   cc = std::abs(m->C.block(s)(c, c));
      if (k <= 0.0) continue;
      if (!first_order && mm > 0.0) rates.push_back(std::sqrt(k / mm));
      if (first_order && cc > 0.0) rates.push_back(k / cc);
    }
  }
  if (rates.empty()) return 1.0;
  const double least = rounding * *std::max_element(rates.begin(), rates.end());
  double best = infinity;
  for (const double rate : rates)
    if (rate >= least) best = std::min(best, rate);
  return best < infinity && best > 0.0 ? best : 1.0;
}

double ShiftedOperator::crude_limit() const {
  double most = 0.0;
  for (Index i = 0; i < pattern.size(); ++i) {
    const Index s = pattern.diagonal(i);
    for (int c = 0; c < 6; ++c) {
      if (!active[at(6 * i + c)]) continue;
      const double kk = std::abs(m->K.block(s)(c, c)), cc = std::abs(m->C.block(s)(c, c)),
                   mm = std::abs(m->M.block(s)(c, c));
      if (mm > 0.0) most = std::max({most, std::sqrt(kk / mm), cc / mm});
      if (mm == 0.0 && cc > 0.0) most = std::max(most, kk / cc);
    }
  }
  return most > 0.0 ? 10.0 * most : infinity;
}

void ShiftedOperator::find_known_free() {
  known_free.clear();
  if (opt.maybe_free.cols() == 0 || first_order || complex_shift()) return;
  // of what K makes of them the part that is more than rounding, unknown by unknown
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon(), at_rounding = 1e-13;
  const MatX& motions = opt.maybe_free;
  MatX force(n, motions.cols());
  VecX size = VecX::Zero(motions.rows()), y;
  for (Index j = 0; j < motions.cols(); ++j) {
    multiply(m->K, motions.col(j), y);
    for (Index i = 0; i < n; ++i)
      force(i, j) = y(unknown[at(i)]);
    add_multiply_size(m->K, 1.0, motions.col(j).cwiseAbs(), size);
  }
  for (Index i = 0; i < n; ++i)
    force.row(i) /= std::max(rounding * size(unknown[at(i)]), 1e-300);
  // what resists one motion hardly and another one much must not be lost beside it
  VecX scale(motions.cols());
  for (Index j = 0; j < motions.cols(); ++j)
    scale(j) = 1.0 / std::max(force.col(j).norm(), 1.0);
  force *= scale.asDiagonal();
  const SymmetricEigenpairs resisted = symmetric_eigenpairs(force.transpose() * force);
  for (Index j = 0; j < motions.cols(); ++j) {
    Pair p;
    p.x = (motions * scale.cwiseProduct(resisted.vectors.col(j))).cast<Complex>();
    if (!polisher.evaluate(p)) continue;
    polisher.assess(p);  // a motion of supports against the rotor may be resisted by little beside
    if (p.residual < at_rounding && polisher.is_unresisted(p)) known_free.push_back(std::move(p));
  }
}

void ShiftedOperator::lock_known_free() {
  for (const Pair& p : known_free)
    for (const Index half : {Index(0), n}) {
      VecX z = VecX::Zero(dimension());
      for (Index i = 0; i < n; ++i)
        z(half + i) = p.x(unknown[at(i)]).real();
      krylov.lock(z);
    }
}

void ShiftedOperator::find_shift() {
  double s = 1e-3 * crude_frequency(), good = 0.0;
  // What is without mass comes out of rounding, at sizes that more often than not outnumber the rest.
  const double infinite = 10.0 * crude_limit();
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
    lock_known_free();
    for (int k = 0; k < 14; ++k)
      if (!krylov.step(operation<double>())) break;
    if (krylov.processed() == 0) return;  // all that can move is free
    const Ritz r = look(krylov);
    std::vector<double> sizes;
    for (std::size_t j = 0; j < r.theta.size(); ++j) {
      if (!(std::abs(r.theta[j]) > 1e-12 * std::abs(r.theta[0]))) continue;  // at infinity: no mass
      const Complex lambda = s + 1.0 / r.theta[j];
      // Rigid-body motions do not set the scale; rounding moves their double zero to about 1e-8 of
      // the highest frequency.
      if (std::abs(lambda) < 0.1 * s) {
        Pair p;
        p.x = full_vector(krylov.searched_basis().topRows(n) * r.y.col(static_cast<Index>(j)));
        VecX v = p.x.real();
        purify(v);
        p.x = v;
        if (!polisher.evaluate(p) || polisher.is_unresisted(p)) continue;
      }
      if (lambda.imag() >= 0.0 && std::abs(lambda) < infinite) sizes.push_back(std::abs(lambda));
    }
    const double least = scale_of(std::move(sizes));
    if (!(least < infinity) || (least > 0.3 * s && least < 30.0 * s)) return;
    s = 0.5 * least;
  }
  sigma = alpha = good;
  shift = good;
  if (!(good > 0.0) || !factor_real(good)) throw singular_problem();
}

Error ShiftedOperator::singular_problem() const {
  const Index u = real ? real->singular_unknown() : complex->singular_unknown();
  return run_error("E61",
                   "the eigenvalue problem cannot be factored: unknown " + std::to_string(u % 6) +
                       " of node " + std::to_string(u / 6) + " has neither stiffness nor mass",
                   "give the node mass or stiffness in this direction, or hold it",
                   "node " + std::to_string(u / 6));
}

void ShiftedOperator::prepare_operator(bool fresh) {
  factor_operator(fresh);
  if (complex_shift())
    measure_accuracy<Complex>(*complex, shift);
  else
    measure_accuracy<double>(*real, sigma);
}

void ShiftedOperator::factor_operator(bool fresh) {
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
    if (sigma == 0.0 && fresh) {
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

VecXc ShiftedOperator::full_vector(const VecXc& z) const {
  VecXc x = VecXc::Zero(6 * pattern.size());
  for (Index i = 0; i < n; ++i)
    x(unknown[at(i)]) = z(i);
  return x;
}

void ShiftedOperator::purify(VecX& v) {
  for (int k = 0; k < purifications; ++k) {
    multiply(m->M, v, t_);
    multiply(m->C, v, y_);
    y_ = sigma * (sigma * t_ + y_);
    v.setZero();
    for (const Index u : unknown)
      v(u) = y_(u);
    real->solve(v);
  }
}

}  // namespace whirl::la
