// The certificate of a list of modes: the roots of a region are counted, those that are missing are
// looked for, and what remains is said.
#include <la/mode_search.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::la {

namespace {

/// Where roots gather (damping by the stiffness makes one a node of them at -1/beta), searches from
/// place to place go through the whole space each: up to this dimension one dense solution costs less.
constexpr Index dense_recovery = 1200;
constexpr Index few_missing = 8;
/// Beyond this dimension one run over the whole region costs less than a dense solution or a search
/// for each, as long as it is for few of its roots (the filters of control loops).
constexpr Index quick_dense = 250, unknowns_per_root = 10, one_by_one = 2;

}  // namespace

double ModeSolver::Impl::count_radius() const {
  std::vector<double> f;
  for (const Pair& p : known)
    if (oscillates(p.lambda)) f.push_back(p.lambda.imag());
  std::sort(f.begin(), f.end());
  if (opt.count <= 0) return std::max(1.01 * opt.max_frequency, least_radius);
  const Index found = static_cast<Index>(f.size());
  double radius = found > 0 ? 1.1 * f.back() : 4.0 * sigma;
  for (const Pair& p : known)  // where nothing oscillates what decays is all there is to list
    if (found == 0 && !p.rigid) radius = std::max(radius, 1.01 * std::abs(p.lambda));
  double widest = 0.0;
  for (Index i = opt.count; i < found; ++i) {
    const double low = f[at(i - 1)], high = f[at(i)];
    if (high / low > widest) {
      widest = high / low;
      radius = std::sqrt(high * low);
    }
  }
  return std::max(std::min(radius, 1.01 * opt.max_frequency), 1.01 * least_radius);
}

void ModeSolver::Impl::drop_unproved() {
  std::erase_if(known, [](const Pair& p) {
    return !p.rigid && (!(p.residual < unproved) || std::abs(p.lambda) <= p.uncertainty);
  });
}

bool ModeSolver::Impl::drop_copies() {
  constexpr double close = 1e-4, weak = 1e-10, much = 100.0;
  const auto is_copy = [&](const Pair& p) {
    return !p.rigid && p.residual > weak &&
           std::any_of(known.begin(), known.end(), [&](const Pair& q) {
             return much * q.residual < p.residual &&
                    std::abs(q.lambda - p.lambda) < close * std::abs(p.lambda);
           });
  };
  std::vector<Pair> kept;
  for (const Pair& p : known)
    if (!is_copy(p)) kept.push_back(p);
  const bool any = kept.size() < known.size();
  known = std::move(kept);
  return any;
}

std::vector<Complex> ModeSolver::Impl::known_roots() const {
  std::vector<Complex> roots(static_cast<std::size_t>(double_zeros), 0.0);
  for (const Pair& p : known)
    roots.push_back(p.lambda);
  return roots;
}

bool ModeSolver::Impl::look_near(Complex place, double distance) {
  ModeOptions o;
  o.count = 0;
  o.max_frequency = distance;
  o.shift = Complex(place.real(), std::max(place.imag(), 1e-2 * distance));
  o.tolerance = opt.tolerance;
  o.dense_below = 0;
  Impl near(pattern, active, o);
  constexpr Index old = 1 << 20;  // marks what was known before
  near.watches_crowds = true;
  near.crowds = crowds;
  near.set(*m);
  near.known = known;
  for (Pair& p : near.known)
    p.from = old;
  near.prepare_operator(false);
  for (unsigned seed = 1; seed < 12; ++seed)
    if (!near.search(near.krylov_complex, seed)) break;
  crowds = std::move(near.crowds);
  bool any = false;
  std::vector<Pair> free;
  for (Pair& p : near.known) {
    if (p.rigid)
      free.push_back(std::move(p));
    else if (p.from != old && std::abs(p.lambda) > p.uncertainty)
      any = add(std::move(p)) || any;
  }
  if (add_rigid(free)) {  // a list that was long enough before the search came to zero
    add_companions();
    any = true;
  }
  sort_known();
  return any;
}

bool ModeSolver::Impl::look_everywhere(const CountRegion& region) {
  // Each search keeps clear of all that is known: its cost grows with the square of that.
  constexpr std::size_t many = 200;
  constexpr double within_crowd = 0.05;
  if (known.size() > many) return false;
  bool any = false;
  for (const double height : {0.0, 0.5, 1.0})
    for (const double left : {0.0, 0.7, 1.4, 2.1, 2.8}) {
      const Complex place = region.radius * Complex(-left, height);
      const double distance = short_of_crowd(place, 0.5 * region.radius);
      if (distance > within_crowd * region.radius) any = look_near(place, distance) || any;
    }
  return any;
}

bool ModeSolver::Impl::look_over(const CountRegion& region) {
  const Complex middle(-0.5 * region.reach, 0.0);
  return look_near(middle, std::hypot(region.radius, 0.5 * region.reach));
}

Index ModeSolver::Impl::count_oscillating() const {
  return std::count_if(known.begin(), known.end(),
                       [](const Pair& p) { return oscillates(p.lambda); });
}

std::vector<Complex> ModeSolver::Impl::known_decaying() const {
  std::vector<Complex> places;
  for (const Pair& p : known)
    if (decays_fast(p.lambda)) places.emplace_back(p.lambda.real(), std::abs(p.lambda.imag()));
  return places;
}

std::vector<Complex> ModeSolver::Impl::crowded_places(const std::vector<Complex>& decaying,
                                                      std::ptrdiff_t crowd) {
  constexpr double round = 0.05;
  std::vector<Complex> places;
  for (const Complex place : decaying) {
    const double near = round * std::abs(place);
    const auto others = std::count_if(decaying.begin(), decaying.end(), [&](Complex other) {
      return std::abs(other - place) < near;
    });
    if (others >= crowd) places.push_back(place);
  }
  return places;
}

double ModeSolver::Impl::to_nearest(const std::vector<Complex>& crowds, Complex place) {
  double distance = infinity;
  for (const Complex crowd : crowds)
    distance = std::min({distance, std::abs(place - crowd), std::abs(place - std::conj(crowd))});
  return distance;
}

double ModeSolver::Impl::short_of_crowd(Complex place, double distance) const {
  constexpr double part = 0.9;
  return std::min(distance, part * to_crowd(place));
}

double ModeSolver::Impl::crowd_decay() const {
  constexpr std::ptrdiff_t few = 6;
  double decay = infinity;
  for (const Complex place : crowds)
    decay = std::min(decay, -place.real());
  for (const Complex place : crowded_places(known_decaying(), few))
    decay = std::min(decay, -place.real());
  return decay;
}

void ModeSolver::Impl::extend_to_count() {
  const double given = least_radius, limit = std::min(opt.max_frequency, crude_limit());
  constexpr double before_crowd = 0.9;
  constexpr int rounds = 16;
  double further = 2.0;
  for (int more = 0; more < rounds && count_oscillating() < opt.count &&
                     certificate.radius < std::min(limit, before_crowd * to_crowd(0.0));
       ++more) {
    const Index before = count_oscillating();
    const Certificate shorter = certificate;
    least_radius = std::min(further * certificate.radius, before_crowd * to_crowd(0.0));
    if (least_radius < crowd_decay()) search_all();  // else the count alone tells what is missing
    certify();
    if (!certificate.counted && shorter.complete()) {  // no further than it can be counted
      certificate = shorter;
      break;
    }
    // where nothing is new the next roots may lie decades above slow ones (controllers, free pads)
    further = count_oscillating() > before ? 2.0 : std::min(2.0 * further, 8.0);
  }
  least_radius = given;
}

bool ModeSolver::Impl::avoid_crowd(const RootCount& c, double radius) {
  constexpr Index many = 16;
  constexpr double short_of = 0.8;
  if (c.unknown <= many || cut_short) return false;
  double decay = crowd_decay();
  if (!(decay < infinity)) decay = counter->crowd_rate(c.unknown);  // none of them is known
  if (oscillating_reach * radius < decay) return false;
  if (crowds.empty()) crowds.emplace_back(-decay, 0.0);
  cut_short = true;
  most_reach = short_of * decay;
  return true;
}

namespace {

/// A decaying root that is known, and places near it where roots are missing.
struct Cluster {
  double root = 0;                         ///< < 0
  double sum = 0, weight = 0, spread = 0;  ///< of the places
  void take(Complex place) {
    const double with_conjugate = place.imag() > 0.0 ? 2.0 : 1.0;
    sum += with_conjugate * place.real();
    weight += with_conjugate;
    spread = std::max(spread, std::abs(place - root));
  }
  /// Rounding spreads the places of a cluster, by its number's root of it, not their mean.
  bool is_of_copies() const {
    constexpr double rounding = 3e-4, least_apart = 0.05, mean_apart = 3e-2;
    const double apart = std::max(least_apart, std::pow(rounding, 1.0 / weight));
    return spread < -apart * root && std::abs(sum - weight * root) < -mean_apart * weight * root;
  }
};

}  // namespace

bool ModeSolver::Impl::further_copies(const std::vector<Complex>& places) const {
  constexpr double mean_apart = 1e-2;  // of all together: the first moment is the best known
  std::vector<Cluster> clusters;
  constexpr double alike = 1e-3;  // copies that are known, as rounding spreads them
  for (const Pair& p : known) {
    const double root = p.lambda.real();
    if (oscillates(p.lambda) || !(root < 0.0)) continue;
    if (std::none_of(clusters.begin(), clusters.end(),
                     [root](const Cluster& c) { return std::abs(c.root - root) < -alike * root; }))
      clusters.push_back({root});
  }
  if (places.empty() || clusters.empty()) return false;
  for (const Complex place : places) {
    const auto nearest =
        std::min_element(clusters.begin(), clusters.end(), [&](const Cluster& a, const Cluster& b) {
          return std::abs(place - a.root) < std::abs(place - b.root);
        });
    nearest->take(place);
  }
  double sum = 0.0, expected = 0.0;
  for (const Cluster& c : clusters) {
    if (c.weight > 0.0 && !c.is_of_copies()) return false;
    sum += c.sum;
    expected += c.weight * c.root;
  }
  return std::abs(sum - expected) < -mean_apart * expected;
}

void ModeSolver::Impl::count_double_zeros() {
  if (!slow_beside_zeros) return;
  slow_beside_zeros = false;
  constexpr double wide_step = 1e-3;
  std::vector<Complex> others;
  double slowest = infinity;
  for (const Pair& p : known) {
    if (p.rigid) continue;
    others.push_back(p.lambda);
    slowest = std::min(slowest, std::abs(p.lambda));
  }
  const Index free = static_cast<Index>(known.size() - others.size());
  // the wider one where rounding of zeros reaches the first
  for (const double within : {0.3, 3.0}) {
    const double radius = within * slowest;
    const RootCount zeros = counter->count(*m, {radius, radius, wide_step}, others);
    certificate.factorizations += zeros.factorizations;
    if (!zeros.certain) continue;
    if (zeros.unknown >= free && zeros.unknown <= 2 * free) double_zeros = zeros.unknown - free;
    return;
  }
}

std::vector<Complex> ModeSolver::Impl::places_of_missing(Index number, const CountRegion& region) {
  constexpr double unresolved = 0.1, further = 3.0;
  constexpr int rounds = 12;
  std::vector<Complex> places = counter->locate(number);
  double radius = region.radius;
  for (int round = 0; round < rounds && !places.empty(); ++round) {
    double farthest = 0.0;
    for (const Complex place : places)
      farthest = std::max(farthest, std::abs(place));
    if (farthest > unresolved * radius || farthest < zero_rounding) break;
    radius = further * farthest;
    const RootCount c = counter->count(*m, {radius, radius}, known_roots());
    certificate.factorizations += c.factorizations;
    if (!c.certain || c.unknown != number) break;
    std::vector<Complex> closer = counter->locate(number);
    if (closer.empty()) break;
    places = std::move(closer);
  }
  return places;
}

bool ModeSolver::Impl::near_zero(const std::vector<Complex>& places) const {
  constexpr double near = 10.0;  // a root of rounding splits into several round it
  return !places.empty() && std::all_of(places.begin(), places.end(), [&](Complex place) {
    return std::abs(place) < near * zero_rounding;
  });
}

bool ModeSolver::Impl::only_zeros_missing() {
  std::vector<double> sizes;
  for (const Pair& p : known)
    if (!p.rigid) sizes.push_back(std::abs(p.lambda));
  const double scale = scale_of(sizes);
  if (!(scale < infinity)) return false;
  // A double zero whose drag is no zero of the projection (a film between two spinning lines) stands
  // where rounding puts it; the count has said where.
  double farthest = 0.0;
  for (const Complex place : certificate.where)
    farthest = std::max(farthest, std::abs(place));
  const double by_place = std::min(3.0 * farthest, zero_rounding);
  std::vector<double> distances{1e-6 * scale, 1e-5 * scale};
  if (by_place > distances.back()) distances.push_back(by_place);
  for (const double small : distances) {
    std::vector<Complex> others;
    for (const Pair& p : known)
      if (!p.rigid && std::abs(p.lambda) > small) others.push_back(p.lambda);
    const RootCount zeros = counter->count(*m, {small, small}, others);
    certificate.factorizations += zeros.factorizations;
    if (!zeros.certain || zeros.unknown <= 0) continue;
    others.insert(others.end(), static_cast<std::size_t>(zeros.unknown), Complex(0.0));
    const RootCount all = counter->count(*m, {certificate.radius, certificate.reach}, others);
    certificate.factorizations += all.factorizations;
    if (!all.certain || all.unknown != 0) continue;
    const auto free =
        std::count_if(known.begin(), known.end(), [](const Pair& p) { return p.rigid; });
    certificate.taken_for_zero = std::max<Index>(0, zeros.unknown - free - double_zeros);
    certificate.zeros_within = small;
    return true;
  }
  return false;
}

void ModeSolver::Impl::certify() {
  certificate = {};
  cut_short = false;
  most_reach = infinity;
  if (!counter) counter.emplace(pattern, active);
  const std::size_t before = known.size();
  double radius = count_radius();
  constexpr int rounds = 10;
  constexpr double less_reach = 0.7;
  int runs = 3;  // what they leave has rounds enough
  for (int round = 0; round < rounds; ++round) {
    drop_unproved();
    count_double_zeros();
    const CountRegion region{radius, std::min(oscillating_reach * radius, most_reach)};
    const RootCount c = counter->count(*m, region, known_roots());
    certificate.factorizations += c.factorizations;
    certificate.radius = region.radius;
    certificate.reach = region.reach;
    certificate.counted = c.certain;
    certificate.missing = c.certain ? std::abs(c.unknown) : 0;
    if (!c.certain) {  // a root on the curve itself
      if (c.crossed.real() < -0.5 * region.reach && region.reach > 0.1 * radius)
        most_reach = less_reach * region.reach;  // or a crowd of them
      else
        radius *= 1.023;
      continue;
    }
    if (c.unknown < 0 && drop_copies()) continue;
    if (c.unknown <= 0) break;
    if (avoid_crowd(c, radius)) continue;
    certificate.where = places_of_missing(c.unknown, region);
    bool any = false;
    const bool copies = further_copies(certificate.where);
    const bool few_of_all = dimension() > std::max(quick_dense, unknowns_per_root * c.unknown);
    if (copies && c.unknown <= one_by_one) {
      for (const Complex place : certificate.where)
        any = look_near(place, short_of_crowd(place, 0.1 * (round + 1) * radius)) || any;
    } else if (runs > 0 && c.unknown > one_by_one && few_of_all) {
      any = look_over(region);
      runs = any ? runs - 1 : 0;
    }
    if (copies && !any) {  // a crowd of them, which nobody looks at
      certificate.missing = 0;
      break;
    }
    if (!any && c.unknown > few_missing && dimension() <= dense_recovery)
      any = solve_dense(&region);
    if (!any)
      for (const Complex place : certificate.where)
        any = look_near(place, short_of_crowd(place, 0.1 * (round + 1) * radius)) || any;
    if (!any && near_zero(certificate.where)) break;
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

}  // namespace whirl::la
