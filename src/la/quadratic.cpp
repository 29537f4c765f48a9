#include <cmath>
#include <la/dense.hpp>
#include <la/eigen.hpp>
#include <la/eigenpairs.hpp>
#include <la/ritz.hpp>
#include <la/root_count.hpp>

namespace whirl::la {

struct ModeSolver::Impl : Eigenpairs {
  using Eigenpairs::Eigenpairs;
  Krylov<Complex> krylov_complex;
  std::vector<VecXc> deflated;  ///< Ritz vectors z that polishing could not make anything new of;
                                ///< out of the way of the searches of this call
  std::vector<Mode> result;
  std::optional<RootCounter> counter;
  Certificate certificate;
  static constexpr double unproved = 1e-8;  ///< backward error

  template <class Scalar>
  void lock_known(Krylov<Scalar>& k) {
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
      // the operator then makes
      // -(alpha / shift^2) x and the like of it.
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

  /// One Arnoldi run in the complement of what is known. False: nothing unknown is left within the
  /// wanted radius.
  template <class Scalar>
  bool search(Krylov<Scalar>& k, unsigned seed) {
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
      while (k.processed() < next_look && !exhausted)
        exhausted = !k.step(op);
      if (k.processed() == 0) return false;
      const Ritz ritz = look(k);
      // Converged Ritz values before the first that is not; the converse distance bounds what is
      // still unknown.
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
        if (opt.real_roots || found.back().lambda.imag() != 0.0)
          counted += static_cast<Index>(found.size() - before);
      }
      const bool enough = growing && opt.count > 0 && counted >= lacking && lacking > 0;
      if (exhausted || enough || all) {
        if (found.empty()) return false;
        take(found, true);
        sort_known();
        separate_close();
        for (const Pair& p : found)
          deflated.push_back(std::move(vectors[at(p.from)]));
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
    const DenseEigenpairs eig = eigenpairs(op);
    double largest = 0.0;
    for (Index j = 0; j < d; ++j)
      largest = std::max(largest, std::abs(eig.values(j)));
    std::vector<Pair> found;
    for (Index j = 0; j < d; ++j) {
      const Complex theta = eig.values(j);
      // Eigenvalues at infinity come out as rounding; double ones as its square root.
      if (!(std::abs(theta) > 1e-9 * largest)) continue;
      const Complex lambda = s + 1.0 / theta;
      if (lambda.imag() >= 0.0) suggest(found, lambda, eig.vectors.col(j), true, nullptr);
    }
    take(found, true);
    sort_known();
    separate_close();
  }

  void start_from_known() {
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

  /// Indices of the known pairs to be returned.
  std::vector<std::size_t> choose() const {
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

  void sort_by_frequency(std::vector<std::size_t>& chosen) const {
    std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
      const Complex x = known[a].lambda, y = known[b].lambda;
      return x.imag() != y.imag() ? x.imag() < y.imag() : std::abs(x) < std::abs(y);
    });
  }

  /// The same of a counted list: all that oscillates up to the frequency or the number asked for,
  /// and the real roots of the region.
  std::vector<std::size_t> choose_counted() const {
    const CountRegion region{certificate.radius, certificate.reach};
    std::vector<std::size_t> oscillating, real_ones;
    for (std::size_t i = 0; i < known.size(); ++i) {
      const Pair& p = known[i];
      if (oscillates(p.lambda) && p.lambda.imag() <= opt.max_frequency) oscillating.push_back(i);
      if (!oscillates(p.lambda) && opt.real_roots && region.contains(p.lambda))
        real_ones.push_back(i);
    }
    sort_by_frequency(oscillating);
    sort_by_frequency(real_ones);
    if (opt.count > 0 && static_cast<Index>(oscillating.size()) > opt.count) {
      const auto beyond = oscillating.begin() + static_cast<std::ptrdiff_t>(opt.count);
      const auto kept = std::remove_if(beyond, oscillating.end(), [&](std::size_t i) {
        return !(opt.growing && region.contains(known[i].lambda) &&
                 known[i].lambda.real() > known[i].uncertainty);
      });
      oscillating.erase(kept, oscillating.end());
    }
    real_ones.insert(real_ones.end(), oscillating.begin(), oscillating.end());
    return real_ones;
  }

  void collect() {
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

  /// A radius for the count: at least what is asked for, where the frequencies known leave the
  /// widest gap.
  double count_radius() const {
    std::vector<double> f;
    for (const Pair& p : known)
      if (oscillates(p.lambda)) f.push_back(p.lambda.imag());
    std::sort(f.begin(), f.end());
    if (opt.count <= 0) return std::max(1.01 * opt.max_frequency, least_radius);
    const Index n = static_cast<Index>(f.size());
    double radius = n > 0 ? 1.1 * f.back() : 4.0 * sigma;
    double widest = 0.0;
    for (Index i = opt.count; i < n; ++i) {
      const double low = f[at(i - 1)], high = f[at(i)];
      if (high / low > widest) {
        widest = high / low;
        radius = std::sqrt(high * low);
      }
    }
    return std::max(std::min(radius, 1.01 * opt.max_frequency), 1.01 * least_radius);
  }

  /// A pair that is no root, or a zero root counted with the free motions already, would hide one
  /// that is missing.
  void drop_unproved() {
    std::erase_if(known, [](const Pair& p) {
      return !p.rigid && (!(p.residual < unproved) || std::abs(p.lambda) <= p.uncertainty);
    });
  }

  std::vector<Complex> known_roots() const {
    std::vector<Complex> roots(static_cast<std::size_t>(double_zeros), 0.0);
    for (const Pair& p : known)
      roots.push_back(p.lambda);
    return roots;
  }

  /// Looks for roots within a distance from a place of the complex plane, in complex arithmetic,
  /// with all that is known out of the way. True: something new.
  bool look_near(Complex place, double distance) {
    ModeOptions o;
    o.count = 0;
    o.max_frequency = distance;
    o.shift = Complex(place.real(), std::max(place.imag(), 1e-2 * distance));
    o.tolerance = opt.tolerance;
    o.dense_below = 0;
    Impl near(pattern, active, o);
    constexpr Index old = 1 << 20;  // marks what was known before
    near.set(*m);
    near.known = known;
    for (Pair& p : near.known)
      p.from = old;
    near.prepare_operator(false);
    for (unsigned seed = 1; seed < 12; ++seed)
      if (!near.search(near.krylov_complex, seed)) break;
    bool any = false;
    for (Pair& p : near.known)
      if (!p.rigid && p.from != old && std::abs(p.lambda) > p.uncertainty)
        any = add(std::move(p)) || any;
    sort_known();
    return any;
  }

  /// Looks round a grid over the region, for roots that lie too close together for their moments to
  /// tell them apart.
  bool look_everywhere(const CountRegion& region) {
    bool any = false;
    for (const double height : {0.0, 0.5, 1.0})
      for (const double left : {0.0, 0.7, 1.4, 2.1, 2.8})
        any = look_near(region.radius * Complex(-left, height), 0.5 * region.radius) || any;
    return any;
  }

  Index count_oscillating() const {
    return std::count_if(known.begin(), known.end(),
                         [](const Pair& p) { return oscillates(p.lambda); });
  }

  /// All searches that lead to something new.
  void search_all() {
    for (unsigned seed = 1; seed < 40; ++seed)
      if (!(complex_shift() ? search(krylov_complex, seed) : search(krylov, seed))) break;
    if (!complex_shift()) add_companions();
  }

  /// Pairs counted on the way may have turned out to be real: the search goes on until as many
  /// modes oscillate as are wanted.
  void extend_to_count() {
    const double given = least_radius;
    for (int more = 0; more < 4 && count_oscillating() < opt.count; ++more) {
      least_radius =
          2.0 * std::max(certificate.radius, wanted_radius() < infinity ? wanted_radius() : 0.0);
      search_all();
      certify();
    }
    least_radius = given;
  }

  /// The missing roots are further copies of overdamped ones that are known: massless unknowns
  /// under damping in proportion to their stiffness all have the one rate -1/beta. Their number
  /// says nothing about the machine.
  bool further_copies(const std::vector<Complex>& places) const {
    const auto is_copy = [&](Complex place) {
      return std::any_of(known.begin(), known.end(), [&](const Pair& p) {
        return !oscillates(p.lambda) && p.lambda.real() < 0.0 &&
               std::abs(p.lambda - place) < 1e-2 * std::abs(p.lambda);
      });
    };
    return !places.empty() && std::all_of(places.begin(), places.end(), is_copy);
  }

  /// Free motions whose zero roots the search could not tell apart (several at once are defective):
  /// they are counted by themselves, within a circle round zero that is small beside every other
  /// root, and the region once more with as many zeros. True: nothing else is missing.
  bool only_zeros_missing() {
    std::vector<double> sizes;
    for (const Pair& p : known)
      if (!p.rigid) sizes.push_back(std::abs(p.lambda));
    const double scale = scale_of(sizes);
    if (!(scale < infinity)) return false;
    for (const double share : {1e-6, 1e-5}) {
      const double small = share * scale;
      std::vector<Complex> others;
      for (const Pair& p : known)
        if (!p.rigid && std::abs(p.lambda) > small) others.push_back(p.lambda);
      const RootCount zeros = counter->count(*m, {small, small}, others);
      certificate.factorizations += zeros.factorizations;
      if (!zeros.certain || zeros.unknown <= 0) continue;
      others.insert(others.end(), static_cast<std::size_t>(zeros.unknown), Complex(0.0));
      const RootCount all = counter->count(*m, {certificate.radius, certificate.reach}, others);
      certificate.factorizations += all.factorizations;
      if (all.certain && all.unknown == 0) return true;
    }
    return false;
  }

  /// Counts the roots of the region, looks for those that are missing, and leaves the certificate.
  void certify() {
    certificate = {};
    if (!counter) counter.emplace(pattern, active);
    const std::size_t before = known.size();
    double radius = count_radius();
    for (int round = 0; round < 6; ++round) {
      drop_unproved();
      const CountRegion region{radius, oscillating_reach * radius};
      const RootCount c = counter->count(*m, region, known_roots());
      certificate.factorizations += c.factorizations;
      certificate.radius = region.radius;
      certificate.reach = region.reach;
      certificate.counted = c.certain;
      certificate.missing = c.certain ? std::abs(c.unknown) : 0;
      if (!c.certain) {  // a root on the curve itself
        radius *= 1.023;
        continue;
      }
      if (c.unknown <= 0) break;
      certificate.where = counter->locate(c.unknown);
      if (further_copies(certificate.where)) {
        certificate.missing = 0;
        break;
      }
      bool any = false;
      for (const Complex place : certificate.where)
        any = look_near(place, 0.1 * (round + 1) * radius) || any;
      if (!any) any = look_everywhere(region);
      if (!any) break;
    }
    if (certificate.counted && certificate.missing > 0 && only_zeros_missing())
      certificate.missing = 0;
    if (certificate.complete()) certificate.where.clear();
    certificate.recovered =
        std::max<Index>(0, static_cast<Index>(known.size()) - static_cast<Index>(before));
    work.factorizations += certificate.factorizations;
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
    certificate = {};
    if (n == 0 || (first_order && !damped)) {
      known.clear();
      return;
    }
    prepare_operator(known.empty());
    if (!known.empty()) start_from_known();
    const bool dense = n <= opt.dense_below && !complex_shift();
    if (dense) {
      solve_dense();
      if (!complex_shift()) add_companions();
    } else {
      search_all();
    }
    if (opt.certify) {
      certify();
      if (!dense && opt.count > 0) extend_to_count();
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

  void rescale_shift() {
    if (opt.shift) return;
    std::vector<double> sizes;
    for (const Pair& p : known)
      if (!p.rigid) sizes.push_back(std::abs(p.lambda));
    const double least = scale_of(std::move(sizes));
    if (least < infinity && (least < 0.5 * sigma || least > 10.0 * sigma) && least > 1e-5 * sigma)
      sigma = alpha = 0.5 * least;
  }
};

ModeSolver::ModeSolver(const BlockPattern& pattern, std::span<const unsigned char> active,
                       const ModeOptions& options)
    : impl_(std::make_unique<Impl>(pattern, active, options)) {}
ModeSolver::~ModeSolver() = default;
ModeSolver::ModeSolver(ModeSolver&&) noexcept = default;

const std::vector<Mode>& ModeSolver::solve_to(const MCK& m, double radius) {
  impl_->least_radius = radius;
  impl_->solve(m);
  impl_->least_radius = 0.0;
  return impl_->result;
}

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
  return Mode{p.lambda, p.x, p.residual, p.uncertainty, -1};
}

const Certificate& ModeSolver::certificate() const { return impl_->certificate; }

ModeSolver::Work ModeSolver::work() const { return impl_->work; }

std::vector<Mode> quadratic_modes(const MCK& m, std::span<const unsigned char> active,
                                  const ModeOptions& options) {
  return ModeSolver(m.K.pattern(), active, options).solve(m);
}

}  // namespace whirl::la