#include <core/interrupt.hpp>
#include <cmath>
#include <la/dense.hpp>
#include <la/mode_search.hpp>
#include <la/ritz.hpp>

namespace whirl::la {

template <class Scalar>
void ModeSolver::Impl::lock_known(Krylov<Scalar>& k) {
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
    // Steady drift (0, x) belongs to the invariant space of a free motion when nothing damps it:
    // the operator then makes -(alpha / shift^2) x and the like of it.
    for (Index i = 0; i < n; ++i) {
      z(i) = 0.0;
      if constexpr (std::is_same_v<Scalar, double>)
        z(n + i) = p.x(unknown[at(i)]).real();
      else
        z(n + i) = p.x(unknown[at(i)]);
    }
    operation<Scalar>()(z, image);
    Scalar s;
    if constexpr (std::is_same_v<Scalar, double>)
      s = sigma;
    else
      s = shift;
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

template <class Scalar>
ModeSolver::Impl::Harvest ModeSolver::Impl::harvest(Krylov<Scalar>& k, bool exhausted,
                                                    double radius) {
  Harvest h;
  const Ritz ritz = look(k);
  // Of hundreds of roots in one place none converges for long; that they are there is seen at once.
  constexpr std::ptrdiff_t crowd = 24;
  std::vector<Complex> decaying = known_decaying();
  for (const Complex theta : ritz.theta) {
    const Complex lambda = shift + 1.0 / theta;
    if (decays_fast(lambda)) decaying.emplace_back(lambda.real(), std::abs(lambda.imag()));
  }
  const std::vector<Complex> places = crowded_places(decaying, crowd);
  const auto nearest = std::min_element(places.begin(), places.end(), [&](Complex a, Complex b) {
    return std::abs(a - centre()) < std::abs(b - centre());
  });
  if (nearest != places.end()) h.crowd = *nearest;
  const double offset = std::abs(shift - centre());
  for (std::size_t j = 0; j < ritz.theta.size(); ++j) {
    const double size = std::abs(ritz.theta[j]);
    // Not normal, the operator may be off by several residuals.
    const double distance = 1.0 / (size + 10.0 * ritz.residual[j]) - offset;
    const bool beyond = size <= 0.0 || distance > radius;
    if (!exhausted && (beyond || ritz.residual[j] > 1e-5 * size)) {
      h.all = beyond;
      break;
    }
    if (size <= 1e-12 * std::abs(ritz.theta[0])) break;  // infinite eigenvalues
    const Complex lambda = shift + 1.0 / ritz.theta[j];
    if (1.0 / size - offset > radius) break;
    // Of a pair that is hardly one both vectors come real, its real and its imaginary part.
    const bool conjugate =
        lambda.imag() < 0.0 && !ritz.y.col(static_cast<Index>(j)).imag().isZero(0.0);
    if (conjugate && std::is_same_v<Scalar, double>) continue;
    const VecXc z = k.searched_basis() * ritz.y.col(static_cast<Index>(j));
    const std::size_t before = h.found.size();
    suggest(h.found, lambda, z, std::is_same_v<Scalar, double>, &h.vectors);
    if (opt.real_roots || h.found.back().lambda.imag() != 0.0)
      h.counted += static_cast<Index>(h.found.size() - before);
  }
  return h;
}

template <class Scalar>
bool ModeSolver::Impl::search(Krylov<Scalar>& k, unsigned seed) {
  ++work.searches;
  k.reset(dimension(), seed);
  lock_known(k);
  // Of many modes some hundred at a time: the dense part of a search grows with the cube.
  constexpr Index most = 256;
  const Index lacking = std::min(missing(), most);
  // Short of a crowd of decaying roots: beyond it (next to) nothing oscillates, and what does is
  // found by the count.
  constexpr double short_of = 0.9;
  const bool growing = lacking > 0 && crowds.empty();
  const double radius =
      growing ? opt.max_frequency : std::min(wanted_radius(), short_of * to_crowd(centre()));
  if (growing) {
    k.inject();
    k.inject();  // two vectors: the pairs of isotropic rotors come out together
  }
  Index next_look = growing ? std::max<Index>(12, 4 * std::max<Index>(lacking, 1) + 4) : 8;
  const auto op = operation<Scalar>();
  while (true) {
    bool exhausted = false;
    while (k.processed() < next_look && !exhausted) {
      throw_if_interrupted();
      exhausted = !k.step(op);
    }
    if (k.processed() == 0) return false;
    Harvest h = harvest(k, exhausted, radius);
    const bool enough = growing && opt.count > 0 && h.counted >= lacking;
    const bool crowded = watches_crowds && h.crowd && to_nearest({*h.crowd}, centre()) < radius;
    if (crowded) crowds.push_back(*h.crowd);
    if (exhausted || enough || crowded || h.all) {
      if (h.found.empty()) return crowded;  // then once more, short of it
      take(h.found, true);
      sort_known();
      separate_close();
      for (const Pair& p : h.found)
        deflated.push_back(std::move(h.vectors[at(p.from)]));
      return !(exhausted && k.locked() == 0);
    }
    next_look = k.processed() + std::max<Index>(4, k.processed() / 5);
  }
}
template bool ModeSolver::Impl::search(Krylov<Complex>&, unsigned);  // certify.cpp

bool ModeSolver::Impl::solve_dense(const CountRegion* within) {
  std::vector<Pair> found;
  if (solve_dense_at(0.0, within, found)) {
    // What is fast beside the shift is lost in the rounding of what is slow.
    constexpr double further = 1e4;
    double fastest = 0.0;
    for (const Pair& p : found)
      fastest = std::max(fastest, std::abs(p.lambda));
    const double slow = sigma;
    sigma = alpha = further * slow;
    if (factor_real(sigma)) solve_dense_at(1.001 * fastest, within, found);
    sigma = alpha = slow;
    if (!factor_real(sigma)) throw singular_problem();
  }
  const bool any = take(found, true);
  sort_known();
  separate_close();
  return any;
}

bool ModeSolver::Impl::solve_dense_at(double above, const CountRegion* within,
                                      std::vector<Pair>& found) {
  const double s = sigma;
  const Index d = dimension();
  MatX op(d, d);
  VecX out(d);
  for (Index j = 0; j < d; ++j) {
    throw_if_interrupted();
    apply<double>(VecX::Unit(d, j), out, *real, s, x_, t_, y_);
    op.col(j) = out;
  }
  const DenseEigenpairs eig = eigenpairs(op);
  double largest = 0.0;
  for (Index j = 0; j < d; ++j)
    largest = std::max(largest, std::abs(eig.values(j)));
  bool dropped = false;
  for (Index j = 0; j < d; ++j) {
    const Complex theta = eig.values(j);
    // Eigenvalues at infinity come out as rounding; double ones as its square root.
    if (!(std::abs(theta) > 1e-9 * largest)) {
      dropped = dropped || std::abs(theta) > 1e-15 * largest;
      continue;
    }
    const Complex lambda = s + 1.0 / theta;
    if (std::abs(lambda) < above) continue;
    if (within && !within->contains(lambda)) continue;
    const bool real_vector = eig.vectors.col(j).imag().isZero(0.0);
    if (lambda.imag() >= 0.0 || real_vector)
      suggest(found, lambda, eig.vectors.col(j), true, nullptr);
  }
  return dropped;
}

void ModeSolver::Impl::start_from_known() {
  // A better eigenvalue from each old vector, better vectors within groups of close ones, then
  // Newton.
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
    return a.lambda.imag() != b.lambda.imag() ? a.lambda.imag() < b.lambda.imag()
                                              : a.lambda.real() < b.lambda.real();
  });
  for (std::size_t i = 0; i < found.size();) {
    group.clear();
    std::size_t j = i;
    do
      group.push_back(&found[j++]);
    while (j < found.size() && group.size() < 8 &&
           std::abs(found[j].lambda - found[j - 1].lambda) < 0.05 * std::abs(found[j].lambda));
    polisher.separate(group);
    i = j;
  }
  take(found, false);
  sort_known();
  separate_close();
}

std::vector<std::size_t> ModeSolver::Impl::choose() const {
  std::vector<std::size_t> chosen;
  Index c = 0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const Pair& p = known[i];
    if (!counts(p)) continue;
    if (opt.count > 0 && c == opt.count) break;
    ++c;
    if (opt.count <= 0 ? std::abs(p.lambda) > opt.max_frequency
                       : p.lambda.imag() > opt.max_frequency)
      continue;
    chosen.push_back(i);
  }
  sort_by_frequency(chosen);
  return chosen;
}

void ModeSolver::Impl::sort_by_frequency(std::vector<std::size_t>& chosen) const {
  std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
    const Complex x = known[a].lambda, y = known[b].lambda;
    return x.imag() != y.imag() ? x.imag() < y.imag() : std::abs(x) < std::abs(y);
  });
}

std::vector<std::size_t> ModeSolver::Impl::choose_counted() const {
  const CountRegion region{certificate.radius, certificate.reach};
  // What grows is listed wherever it was counted, and what is slower than that: a list has no holes.
  const auto grows = [&](const Pair& p) {
    return opt.growing && region.contains(p.lambda) &&
           p.lambda.real() > std::max(p.uncertainty, unnoticed_growth * std::abs(p.lambda));
  };
  std::vector<std::size_t> oscillating, real_ones;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const Pair& p = known[i];
    if (oscillates(p.lambda) && (p.lambda.imag() <= opt.max_frequency || region.contains(p.lambda)))
      oscillating.push_back(i);
    if (!oscillates(p.lambda) && opt.real_roots && region.contains(p.lambda))
      real_ones.push_back(i);
  }
  sort_by_frequency(oscillating);
  sort_by_frequency(real_ones);
  // beyond what was counted some may be missing
  const double top =
      certificate.counted ? std::min(opt.max_frequency, certificate.radius) : opt.max_frequency;
  Index asked = std::count_if(oscillating.begin(), oscillating.end(),
                              [&](std::size_t i) { return known[i].lambda.imag() <= top; });
  if (opt.count > 0) asked = std::min(asked, opt.count);
  const auto last_growing = std::find_if(oscillating.rbegin(), oscillating.rend(),
                                         [&](std::size_t i) { return grows(known[i]); });
  const auto to_growing = static_cast<Index>(oscillating.rend() - last_growing);
  oscillating.resize(static_cast<std::size_t>(std::max(asked, to_growing)));
  real_ones.insert(real_ones.end(), oscillating.begin(), oscillating.end());
  return real_ones;
}

void ModeSolver::Impl::collect() {
  std::vector<Mode> modes;
  const std::vector<std::size_t> chosen = opt.certify ? choose_counted() : choose();
  for (const std::size_t i : chosen) {
    Pair& p = known[i];
    if (p.rigid) polisher.assess(p);
    modes.push_back({p.lambda, p.x, p.residual, p.uncertainty, p.from});
  }
  for (Pair& p : known)
    p.from = -1;
  for (std::size_t j = 0; j < chosen.size(); ++j)
    known[chosen[j]].from = static_cast<Index>(j);
  result = std::move(modes);
}

void ModeSolver::Impl::search_all() {
  for (unsigned seed = 1; seed < 40; ++seed)
    if (!(complex_shift() ? search(krylov_complex, seed) : search(krylov, seed))) break;
  if (!complex_shift()) add_companions();
}

void ModeSolver::Impl::set(const MCK& matrices) {
  m = &matrices;
  const auto zero = [](const BlockMatrix<6>& a) {
    return std::all_of(a.data(), a.data() + a.value_count(), [](double v) { return v == 0.0; });
  };
  first_order = zero(m->M);
  damped = !zero(m->C);
  polisher.set(matrices);
}

void ModeSolver::Impl::solve(const MCK& matrices) {
  work = {};
  polisher.factorizations = 0;
  set(matrices);
  result.clear();
  deflated.clear();
  certificate = {};
  crowds.clear();
  if (n == 0 || (first_order && !damped)) {
    known.clear();
    return;
  }
  find_known_free();
  prepare_operator(known.empty());
  if (!known.empty()) start_from_known();
  add_rigid(known_free);
  const bool dense = n <= opt.dense_below && !complex_shift();
  fastest_root = 0.0;
  if (dense) {
    solve_dense();
    if (!complex_shift()) add_companions();
  } else {
    search_all();
  }
  if (opt.certify) {
    certify();
    if (!dense && opt.count > 0) extend_to_count();
    if (dense)
      for (const Pair& p : known)
        fastest_root = std::max(fastest_root, std::abs(p.lambda));
  }
  // Only what is wanted, and the guard, is carried on.
  if (opt.count > 0) {
    Index c = 0;
    std::size_t keep = 0;
    while (keep < known.size() && c < opt.count + opt.guard)
      c += counts(known[keep++]) ? 1 : 0;
    if (opt.certify) {
      const CountRegion region{certificate.radius, certificate.reach};
      const auto carried =
          std::stable_partition(known.begin() + static_cast<std::ptrdiff_t>(keep), known.end(),
                                [&](const Pair& p) { return region.contains(p.lambda); });
      keep = static_cast<std::size_t>(carried - known.begin());
    }
    known.resize(keep);
  }
  collect();
  rescale_shift();
  work.factorizations += polisher.factorizations;
}

void ModeSolver::Impl::rescale_shift() {
  if (opt.shift) return;
  std::vector<double> sizes;
  for (const Pair& p : known)
    if (!p.rigid) sizes.push_back(std::abs(p.lambda));
  const double least = scale_of(std::move(sizes));
  if (least < infinity && (least < 0.5 * sigma || least > 10.0 * sigma) && least > 1e-5 * sigma)
    sigma = alpha = 0.5 * least;
}

ModeSolver::ModeSolver(const BlockPattern& pattern, std::span<const unsigned char> active,
                       const ModeOptions& options)
    : impl_(std::make_unique<Impl>(pattern, active, options)) {}
ModeSolver::~ModeSolver() = default;
ModeSolver::ModeSolver(ModeSolver&&) noexcept = default;

void ModeSolver::Impl::solve_from_known(const MCK& matrices) {
  const bool started = !known.empty();
  solve(matrices);
  if (!started || !opt.certify || certificate.complete()) return;
  // what was known of other matrices may hide a mode of these
  const Work before = work;
  known.clear();
  sigma = 0.0;
  solve(matrices);
  work.factorizations += before.factorizations;
  work.operator_products += before.operator_products;
  work.searches += before.searches;
}

const std::vector<Mode>& ModeSolver::solve_to(const MCK& m, double radius) {
  impl_->least_radius = radius;
  impl_->solve_from_known(m);
  impl_->least_radius = 0.0;
  return impl_->result;
}

const std::vector<Mode>& ModeSolver::solve(const MCK& m) {
  impl_->solve_from_known(m);
  return impl_->result;
}

void ModeSolver::reset() {
  impl_->known.clear();
  impl_->sigma = 0.0;
}

void ModeSolver::start_from(const ModeSolver& other) {
  impl_->known = other.impl_->known;
  impl_->sigma = other.impl_->sigma;
  impl_->alpha = other.impl_->alpha;
}

void ModeSolver::start_from(std::span<const Mode> near) {
  impl_->known.clear();
  for (const Mode& m : near) {
    Pair p;
    p.lambda = m.lambda;
    p.x = m.x;
    impl_->known.push_back(std::move(p));
  }
}

std::optional<Mode> ModeSolver::follow(const MCK& m, const Mode& start) {
  impl_->set(m);
  Pair p;
  p.lambda = start.lambda;
  p.x = start.x;
  if (!impl_->polisher.polish(p, impl_->opt.tolerance, false)) return std::nullopt;
  impl_->polisher.assess(p);
  return Mode{p.lambda, p.x, p.residual, p.uncertainty, -1};
}

std::optional<double> ModeSolver::fastest_root() const {
  return impl_->fastest_root > 0.0 ? std::optional(impl_->fastest_root) : std::nullopt;
}

const Certificate& ModeSolver::certificate() const { return impl_->certificate; }

ModeSolver::Work ModeSolver::work() const { return impl_->work; }

std::vector<Mode> quadratic_modes(const MCK& m, std::span<const unsigned char> active,
                                  const ModeOptions& options) {
  return ModeSolver(m.K.pattern(), active, options).solve(m);
}

}  // namespace whirl::la