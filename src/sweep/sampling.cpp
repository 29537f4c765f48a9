#include <sweep/sampling.hpp>
#include <sweep/design.hpp>
#include <core/contract.hpp>
#include <core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::sweep {
namespace {

/// S. Vigna's splitmix64 finaliser: neighbouring numbers to unrelated ones, one to one.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

std::uint64_t key_of(std::uint64_t seed, std::size_t dimension, std::uint64_t purpose) {
  return mixed(mixed(mixed(seed) ^ dimension) ^ (purpose << 56));
}

/// The middles of 2^53 equal parts of (0, 1).
double fraction(std::uint64_t x) { return (static_cast<double>(x >> 11) + 0.5) * 0x1p-53; }

/// Where number k goes in a permutation of 0 .. n - 1: a Feistel network over the next power of
/// four, walked until it lands below n.
std::uint64_t permuted(std::uint64_t key, std::uint64_t k, std::uint64_t n) {
  int half = 1;
  while ((std::uint64_t{1} << (2 * half)) < n)
    ++half;
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  do {
    std::uint64_t left = k >> half, right = k & mask;
    for (std::uint64_t round = 0; round < 6; ++round) {
      const std::uint64_t next = left ^ (mixed(key ^ (round << 60) ^ right) & mask);
      left = right;
      right = next;
    }
    k = (left << half) | right;
  } while (k >= n);
  return k;
}

/// Degree s, coefficients a and first direction numbers m of the primitive polynomials.
struct Polynomial {
  int s;
  unsigned a;
  std::array<std::uint32_t, 5> m;
};
constexpr std::array<Polynomial, sobol_dimensions - 1> polynomials{{{1, 0, {1}},
                                                                    {2, 1, {1, 3}},
                                                                    {3, 1, {1, 3, 1}},
                                                                    {3, 2, {1, 1, 1}},
                                                                    {4, 1, {1, 1, 3, 3}},
                                                                    {4, 4, {1, 3, 5, 13}},
                                                                    {5, 2, {1, 1, 5, 5, 17}},
                                                                    {5, 4, {1, 1, 5, 5, 5}},
                                                                    {5, 7, {1, 1, 7, 11, 19}}}};
constexpr int bits = 32;

std::array<std::uint32_t, bits> directions(std::size_t dimension) {
  std::array<std::uint32_t, bits> v{};
  if (dimension == 0) {
    for (int k = 0; k < bits; ++k)
      v[static_cast<std::size_t>(k)] = std::uint32_t{1} << (bits - 1 - k);
    return v;
  }
  const Polynomial& p = polynomials[dimension - 1];
  for (int k = 0; k < bits; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (k < p.s) {
      v[i] = p.m[i] << (bits - 1 - k);
      continue;
    }
    const auto s = static_cast<std::size_t>(p.s);
    v[i] = v[i - s] ^ (v[i - s] >> p.s);
    for (int j = 1; j < p.s; ++j)
      if ((p.a >> (p.s - 1 - j)) & 1U) v[i] ^= v[i - static_cast<std::size_t>(j)];
  }
  return v;
}

double polynomial(const std::array<double, 8>& c, double x) {
  double y = 0;
  for (std::size_t k = c.size(); k-- > 0;)
    y = y * x + c[k];
  return y;
}

}  // namespace

double random_point(std::uint64_t seed, std::size_t dimension, std::int64_t sample) {
  return fraction(mixed(key_of(seed, dimension, 1) + static_cast<std::uint64_t>(sample)));
}

double latin_point(std::uint64_t seed, std::size_t dimension, std::int64_t sample,
                   std::int64_t samples) {
  WHIRL_EXPECTS(sample >= 0 && sample < samples);
  const std::uint64_t part =
      permuted(key_of(seed, dimension, 2), static_cast<std::uint64_t>(sample),
               static_cast<std::uint64_t>(samples));
  const double within = random_point(seed ^ 0x5bd1e995U, dimension, sample);
  const double x = (static_cast<double>(part) + within) / static_cast<double>(samples);
  return std::min(x, 1.0 - 0x1p-53);
}

double sobol_point(std::uint64_t seed, std::size_t dimension, std::int64_t sample) {
  WHIRL_EXPECTS(dimension < sobol_dimensions && sample >= 0);
  const auto v = directions(dimension);
  const auto number = static_cast<std::uint64_t>(sample);
  const std::uint64_t gray = number ^ (number >> 1);
  std::uint32_t x = static_cast<std::uint32_t>(key_of(seed, dimension, 3));
  for (int k = 0; k < bits; ++k)
    if ((gray >> k) & 1U) x ^= v[static_cast<std::size_t>(k)];
  return (static_cast<double>(x) + 0.5) * 0x1p-32;
}

double saltelli_point(std::uint64_t seed, std::size_t dimension, std::size_t dimensions,
                      std::int64_t run) {
  WHIRL_EXPECTS(dimension < dimensions && run >= 0);
  const auto each = static_cast<std::int64_t>(dimensions) + 2;
  const std::int64_t point = run / each, k = run % each;
  const bool other = k == 1 || k == static_cast<std::int64_t>(dimension) + 2;
  const std::size_t axis = dimension + (other ? dimensions : 0);
  return 2 * dimensions <= sobol_dimensions ? sobol_point(seed, axis, point)
                                            : random_point(seed, axis, point);
}

std::size_t morris_moved(std::uint64_t seed, std::size_t dimensions, std::int64_t path,
                         std::size_t k) {
  WHIRL_EXPECTS(k < dimensions && path >= 0);
  return static_cast<std::size_t>(
      permuted(key_of(seed, static_cast<std::size_t>(path), 4), k, dimensions));
}

double morris_level(std::uint64_t seed, std::size_t dimension, std::size_t dimensions,
                    std::int64_t run) {
  WHIRL_EXPECTS(dimension < dimensions && run >= 0);
  const auto each = static_cast<std::int64_t>(dimensions) + 1;
  const std::int64_t path = run / each;
  const auto done = static_cast<std::size_t>(run % each);
  bool moved = false;
  for (std::size_t k = 0; k < done; ++k)
    moved = moved || morris_moved(seed, dimensions, path, k) == dimension;
  const std::uint64_t dice = mixed(key_of(seed, dimension, 5) + static_cast<std::uint64_t>(path));
  const double low = (dice & 1U) ? 1.0 / 3.0 : 0.0;
  const bool from_above = ((dice >> 1) & 1U) != 0;
  return low + (moved != from_above ? 2.0 / 3.0 : 0.0);
}

double normal_probability(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

double normal_quantile(double p) {
  WHIRL_EXPECTS(p > 0 && p < 1);
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    constexpr std::array<double, 8> a{3.3871328727963666080e0, 1.3314166789178437745e2,
                                      1.9715909503065514427e3, 1.3731693765509461125e4,
                                      4.5921953931549871457e4, 6.7265770927008700853e4,
                                      3.3430575583588128105e4, 2.5090809287301226727e3};
    constexpr std::array<double, 8> b{1.0,
                                      4.2313330701600911252e1,
                                      6.8718700749205790830e2,
                                      5.3941960214247511077e3,
                                      2.1213794301586595867e4,
                                      3.9307895800092710610e4,
                                      2.8729085735721942674e4,
                                      5.2264952788528545610e3};
    const double r = 0.180625 - q * q;
    return q * polynomial(a, r) / polynomial(b, r);
  }
  const double r = std::sqrt(-std::log(std::min(p, 1.0 - p)));
  double x;
  if (r <= 5.0) {
    constexpr std::array<double, 8> c{1.42343711074968357734e0,  4.63033784615654529590e0,
                                      5.76949722146069140550e0,  3.64784832476320460504e0,
                                      1.27045825245236838258e0,  2.41780725177450611770e-1,
                                      2.27238449892691845833e-2, 7.74545014278341407640e-4};
    constexpr std::array<double, 8> d{1.0,
                                      2.05319162663775882187e0,
                                      1.67638483018380384940e0,
                                      6.89767334985100004550e-1,
                                      1.48103976427480074590e-1,
                                      1.51986665636164571966e-2,
                                      5.47593808499534494600e-4,
                                      1.05075007164441684324e-9};
    x = polynomial(c, r - 1.6) / polynomial(d, r - 1.6);
  } else {
    constexpr std::array<double, 8> e{6.65790464350110377720e0,  5.46378491116411436990e0,
                                      1.78482653991729133580e0,  2.96560571828504891230e-1,
                                      2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                      2.71155556874348757815e-5, 2.01033439929228813265e-7};
    constexpr std::array<double, 8> f{1.0,
                                      5.99832206555887937690e-1,
                                      1.36929880922735805310e-1,
                                      1.48753612908506148525e-2,
                                      7.86869131145613259100e-4,
                                      1.84631831751005468180e-5,
                                      1.42151175831644588870e-7,
                                      2.04426310338993978564e-15};
    x = polynomial(e, r - 5.0) / polynomial(f, r - 5.0);
  }
  return q < 0 ? -x : x;
}

}  // namespace whirl::sweep
