#include <core/interrupt.hpp>
#include <la/dense.hpp>
#include <la/eigenpairs.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::la {

void Eigenpairs::suggest(std::vector<Pair>& found, Complex lambda, const VecXc& z,
                         bool real_problem, std::vector<VecXc>* vectors) const {
  const auto push = [&](Complex l, VecXc v) {
    Pair p;
    p.lambda = l;
    p.x = full_vector(v);
    if (vectors) {
      p.from = static_cast<Index>(vectors->size());
      vectors->push_back(std::move(v));
    }
    found.push_back(std::move(p));
  };
  if (!real_problem || std::abs(lambda.imag()) > 1e-6 * std::abs(lambda)) return push(lambda, z);
  push(lambda.real(), z.real().cast<Complex>());
  if (lambda.imag() != 0.0 && !z.imag().isZero(0.0)) push(lambda.real(), z.imag().cast<Complex>());
}

void Eigenpairs::make_real(Pair& p) {
  if (p.lambda.imag() == 0.0 ||
      std::abs(p.lambda.imag()) > std::max(real_line * std::abs(p.lambda), 10.0 * p.uncertainty))
    return;
  p.lambda = p.lambda.real();
  p.x = p.x.real().cast<Complex>().eval();
  if (polisher.evaluate(p)) polisher.assess(p);
}

Index Eigenpairs::count_slow_companions(const std::vector<std::size_t>& free) const {
  MatX span(6 * pattern.size(), static_cast<Index>(free.size()));
  for (std::size_t j = 0; j < free.size(); ++j)
    span.col(static_cast<Index>(j)) = known[free[j]].x.real();
  const ColumnSpan<double> free_motions(span);
  return std::count_if(known.begin(), known.end(), [&](const Pair& p) {
    if (p.rigid || p.lambda.imag() != 0.0 || std::abs(p.lambda) > 1e-2 * std::abs(shift))
      return false;
    const VecX x = p.x.real();
    return free_motions.outside(x).norm() < 1e-2 * x.norm();
  });
}

Eigenpairs::DecayOfFree Eigenpairs::decay_of_free(const std::vector<std::size_t>& free) {
  const Index r = static_cast<Index>(free.size());
  MatX P(6 * pattern.size(), r), CP = P, mass(r, r);
  for (Index j = 0; j < r; ++j) {
    const Pair& p = known[free[at(j)]];
    P.col(j) = p.x.real();
    CP.col(j) = p.Cx.real();
    for (Index i = 0; i < r; ++i)
      mass(i, j) = known[free[at(i)]].x.dot(p.Mx).real();
  }
  DecayOfFree out;
  out.D = DenseLu<double>(mass).solve(MatX(P.transpose() * CP));
  if (CP.isZero(0.0) || complex_shift() || !(sigma > 0.0)) return out;
  // U += Q(sigma)^-1 (C P - K U) less its part P A stands where C P - K U = Q(sigma) P A: from the left
  // D = sigma^2 A + sigma D A. What oscillates falls by sigma^2/(sigma^2 + w^2) each time.
  constexpr int rounds = 12;
  const DenseLu<double> gram(MatX(P.transpose() * P));
  MatX U = MatX::Zero(P.rows(), r), V = U, A;
  for (int k = 0; k < rounds; ++k) {
    for (Index j = 0; j < r; ++j) {
      multiply(m->K, U.col(j), t_);
      for (const Index u : unknown)
        V(u, j) = CP(u, j) - t_(u);
      real->solve(V.col(j));
    }
    A = gram.solve(MatX(P.transpose() * V));
    U += V - P * A;
  }
  const MatX rest = MatX::Identity(r, r) - sigma * A;
  const MatX D = sigma * sigma *
                 DenseLu<double>(MatX(rest.transpose())).solve(MatX(A.transpose())).transpose();
  if (!D.allFinite()) return out;
  return {D, std::move(U)};
}

void Eigenpairs::add_companions() {
  double_zeros = 0;
  slow_beside_zeros = false;
  zero_rounding = 0.0;
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i].rigid) free.push_back(i);
  const Index r = static_cast<Index>(free.size());
  if (r == 0 || first_order) return;
  double rounding = 0.0;
  for (const std::size_t i : free) {
    const double mass = std::max(std::abs(known[i].x.dot(known[i].Mx)), 1e-300);
    rounding = std::max(rounding, polisher.rounding_of_stiffness(known[i]) / mass);
  }
  zero_rounding = 10.0 * std::sqrt(rounding);
  const DecayOfFree decay = decay_of_free(free);
  const DenseEigenpairs eig = eigenpairs(MatX(-decay.D));
  Index slow_found = count_slow_companions(free), zeros = 0;
  for (Index j = 0; j < r; ++j) {
    const Complex rate = eig.values(j);
    // What rounding of K makes of a double zero is sqrt(rounding): a drag below that cannot be told
    // from none.
    if (!(std::abs(rate) > zero_rounding)) {
      ++zeros;
      continue;
    }
    if (rate.imag() < 0.0) continue;
    Pair p;
    p.lambda = rate.imag() == 0.0 ? Complex(rate.real()) : rate;
    p.x = VecXc::Zero(6 * pattern.size());
    for (Index i = 0; i < r; ++i) {
      const Complex part =
          rate.imag() == 0.0 ? Complex(eig.vectors(i, j).real()) : eig.vectors(i, j);
      p.x += part * known[free[at(i)]].x;
      if (decay.follows.size() > 0)
        p.x += part * p.lambda * (p.lambda / sigma - 1.0) * decay.follows.col(i);
    }
    // of first order in the rate; where rounding of K keeps Newton's method off it, that is what is known
    constexpr double estimate = 0.9, apart = 1e-3;
    if (slow_found > 0 && spanned(p, known_near(p, estimate, false))) {
      --slow_found;  // the search has it
      continue;
    }
    Pair first = p;
    const bool polished = polisher.evaluate(p) && polisher.polish(p, opt.tolerance, false);
    if (!polished || std::abs(p.lambda - rate) > estimate * std::abs(rate)) p = std::move(first);
    if (!polisher.evaluate(p)) continue;
    polisher.assess(p);
    if (!(p.residual < unproved)) continue;
    // rounding of K moves it as lambda (lambda - rate) = zero_rounding^2, up to the factor that stands there
    p.uncertainty = std::max(p.uncertainty, 0.01 * zero_rounding * zero_rounding / std::abs(rate));
    make_real(p);
    const auto alike = known_near(p, apart, false);  // several may die away at one rate
    if (!spanned(p, alike)) known.push_back(std::move(p));
  }
  // Slow roots that are left may be what a search has told from zero.
  slow_beside_zeros = slow_found > 0;
  double_zeros = std::max<Index>(0, zeros - slow_found);
  sort_known();
}

std::vector<const Pair*> Eigenpairs::known_near(const Pair& p, double apart, bool free) const {
  std::vector<const Pair*> near;
  for (const Pair& k : known)
    if ((free || !k.rigid) &&
        std::abs(k.lambda - p.lambda) <=
            apart * std::abs(p.lambda) + 10.0 * (k.uncertainty + p.uncertainty))
      near.push_back(&k);
  return near;
}

bool Eigenpairs::spanned(const Pair& p, const std::vector<const Pair*>& by) const {
  constexpr double new_part = 0.05, least_part = 1e-6;
  const VecX weight = polisher.weights(p.lambda);
  const auto columns = [&](const std::vector<const Pair*>& pairs) {
    MatXc a(p.x.size(), static_cast<Index>(pairs.size()));
    for (std::size_t j = 0; j < pairs.size(); ++j)
      a.col(static_cast<Index>(j)) = weight.cwiseProduct(pairs[j]->x).normalized();
    return a;
  };
  const auto within = [](const VecXc& x, const MatXc& a) {
    return a.cols() > 0 && ColumnSpan<Complex>(a).outside(x).norm() < new_part * x.norm();
  };
  const VecXc x = weight.cwiseProduct(p.x);
  if (!within(x, columns(by))) return false;
  // A slow motion drives free ones so far that little else of it is seen: that little decides.
  std::vector<const Pair*> free, others;
  for (const Pair& k : known)
    if (k.rigid) free.push_back(&k);
  for (const Pair* k : by)
    if (!k->rigid) others.push_back(k);
  if (free.empty() || others.size() < by.size()) return true;
  const ColumnSpan<Complex> free_motions(columns(free));
  const VecXc rest = free_motions.outside(x);
  if (rest.norm() < least_part * x.norm()) return true;
  MatXc rests = columns(others);
  for (Index j = 0; j < rests.cols(); ++j)
    rests.col(j) = free_motions.outside(rests.col(j)).normalized();
  return within(rest, rests);
}

bool Eigenpairs::add(Pair&& p) {
  if (p.lambda.imag() < 0.0) {
    p.lambda = std::conj(p.lambda);
    p.x = p.x.conjugate().eval();
    p.Mx = p.Mx.conjugate().eval();
    p.Cx = p.Cx.conjugate().eval();
    p.Kx = p.Kx.conjugate().eval();
  }
  polisher.assess(p);
  if (!(p.residual < unproved)) return false;
  if (!complex_shift()) make_real(p);
  constexpr double apart = 1e-7;
  if (spanned(p, known_near(p, apart, true))) return false;
  known.push_back(std::move(p));
  return true;
}

bool Eigenpairs::add_rigid(const std::vector<Pair>& candidates) {
  if (candidates.empty()) return false;
  const Index before =
      std::count_if(known.begin(), known.end(), [](const Pair& p) { return p.rigid; });
  std::vector<VecX> columns;
  const auto resistance = [this](const VecX& v) {
    Pair p;
    p.x = v.cast<Complex>();
    if (!polisher.evaluate(p)) return infinity;
    polisher.assess(p);
    return p.residual;
  };
  const auto take = [&](VecX v) {
    const double size = v.norm();
    if (!(size > 0.0)) return;
    v /= size;
    if (!complex_shift() && sigma != 0.0) {
      VecX pure = v;
      purify(pure);
      // it adds to what is slower than the shift (an integrator's decay)
      if (resistance(pure) <= resistance(v)) v = std::move(pure);
    }
    columns.push_back(v / v.norm());
  };
  for (const Pair& p : known)
    if (p.rigid) take(p.x.real());
  for (const Pair& p : candidates) {
    take(p.x.real());
    if (p.x.imag().norm() > 1e-6 * p.x.real().norm()) take(p.x.imag());
  }
  MatX a(6 * pattern.size(), static_cast<Index>(columns.size()));
  for (Index j = 0; j < a.cols(); ++j)
    a.col(j) = columns[at(j)];
  const MatX span = orthonormal_span(a, 1e-5);
  std::erase_if(known, [](const Pair& p) { return p.rigid; });
  Index after = 0;
  for (Index j = 0; j < span.cols(); ++j) {
    Pair p;
    p.lambda = 0.0;
    p.x = span.col(j);
    p.rigid = true;
    if (!polisher.evaluate(p) || !polisher.is_unresisted(p)) continue;
    known.push_back(std::move(p));
    ++after;
  }
  return after > before;
}

bool Eigenpairs::is_free_motion(Pair& p) {
  if (!polisher.evaluate(p)) return false;
  if (polisher.is_unresisted(p)) return true;
  if (complex_shift() || sigma == 0.0) return false;
  // Vectors of several zero roots come out mixed with what rounding makes of the rest.
  Pair pure = p;
  VecX x = p.x.real();
  if (p.x.imag().norm() > x.norm()) x = p.x.imag();
  purify(x);
  pure.x = x;
  if (!polisher.evaluate(pure) || !polisher.is_unresisted(pure)) return false;
  const VecXc moved = pure.x - p.x * (p.x.dot(pure.x) / p.x.squaredNorm());
  if (moved.norm() > 1e-2 * pure.x.norm()) return false;  // another motion
  p.x = pure.x;
  return polisher.evaluate(p);
}

bool Eigenpairs::take(std::vector<Pair>& found, bool near) {
  bool any = false;
  std::vector<Pair> rest, rigid;
  for (Pair& p : found) {
    throw_if_interrupted();
    // Rounding of a double zero eigenvalue shows up as far as 1e-3 of the shift.
    if (!first_order && std::abs(p.lambda) < 1e-3 * std::abs(shift) && is_free_motion(p)) {
      rigid.push_back(std::move(p));
      continue;
    }
    Pair q = p;
    if (near) q.from = -1;
    const bool polished = polisher.polish(q, opt.tolerance, near);
    if (polished && add(std::move(q))) any = true;
    // where the shift is small beside the root of what rounding leaves of the stiffness, further
    else if (!polished && !first_order && std::abs(p.lambda) < 0.5 * std::abs(shift) &&
             is_free_motion(p))
      rigid.push_back(std::move(p));
    else
      rest.push_back(std::move(p));
  }
  if (add_rigid(rigid))
    any = true;
  else
    rest.insert(rest.end(), std::make_move_iterator(rigid.begin()),
                std::make_move_iterator(rigid.end()));
  found = std::move(rest);
  return any;
}

void Eigenpairs::sort_known() {
  std::stable_sort(known.begin(), known.end(),
                   [&](const Pair& a, const Pair& b) { return key(a.lambda) < key(b.lambda); });
}

double Eigenpairs::wanted_radius() const {
  if (opt.count <= 0) return opt.max_frequency;
  Index c = 0;
  for (const Pair& p : known)
    if (counts(p) && ++c == opt.count)
      return std::min(std::max(key(p.lambda), least_radius),
                      std::max(opt.max_frequency, least_radius));
  return opt.max_frequency;
}

Index Eigenpairs::missing() const {
  if (opt.count <= 0) return 0;
  return opt.count + opt.guard -
         std::count_if(known.begin(), known.end(), [&](const Pair& p) { return counts(p); });
}

void Eigenpairs::separate_close() {
  std::vector<Pair> all = std::move(known);
  known.clear();
  std::vector<Pair*> group;
  std::vector<std::size_t> rest;
  std::vector<bool> done(all.size(), false);
  constexpr std::size_t most = 32;  // more are a crowd of decaying roots, which nobody looks at
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (done[i] || all[i].rigid) continue;
    group.assign(1, &all[i]);
    for (std::size_t j = i + 1; j < all.size() && group.size() < most; ++j)
      if (!done[j] && !all[j].rigid &&
          std::abs(all[j].lambda - all[i].lambda) < 1e-4 * std::abs(all[i].lambda)) {
        group.push_back(&all[j]);
        done[j] = true;
      }
    if (group.size() == 1) continue;
    polisher.separate(group);
    for (Pair* p : group)
      polisher.evaluate(*p);
  }
  for (Pair& p : all) {
    if (p.rigid)
      known.push_back(std::move(p));
    else
      add(std::move(p));
  }
  sort_known();
}

}  // namespace whirl::la
