// What the seeded faults of an instrumented copy call (sites.py writes the calls). The environment
// chooses one of them: WHIRL_MUTANT=k. Without it the program is what it was.
// WHIRL_MUTANT_TRACE: a file of 2 x sites bytes, shared by all processes of a test; byte k says that
// site k was reached, byte sites + k that its fault means nothing for the type found there.
#pragma once
#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>
#include <algorithm>
#include <complex>
#include <initializer_list>
#include <type_traits>

namespace whirl_mutation {

#ifndef WHIRL_MUTATION_SITES
#define WHIRL_MUTATION_SITES 20000
#endif
constexpr int sites = WHIRL_MUTATION_SITES;
inline bool spare[2 * sites];
inline bool* trace = spare;
inline int chosen = 0;

inline bool start() {
  if (const char* k = ::getenv("WHIRL_MUTANT")) chosen = ::atoi(k);
  if (const char* file = ::getenv("WHIRL_MUTANT_TRACE")) {
    const int f = ::open(file, O_RDWR);
    void* shared = f < 0 ? MAP_FAILED
                         : ::mmap(nullptr, sizeof spare, PROT_READ | PROT_WRITE, MAP_SHARED, f, 0);
    if (f >= 0) ::close(f);
    if (shared != MAP_FAILED) trace = static_cast<bool*>(shared);
  }
  return true;
}
inline const bool started = start();

namespace {  // kernels compiled for several instruction sets share no code

template <class T>
using plain = std::remove_cv_t<std::remove_reference_t<T>>;
template <class T>
constexpr bool is_eigen = requires {
  typename T::PlainObject;
};

/// The fault k is in force.
inline __attribute__((always_inline)) bool on(int k) {
  trace[k] = true;
  return chosen == k;
}
inline void means_nothing(int k) { trace[sites + k] = true; }

inline double scale(int k) { return on(k) ? 1.5 : 1.0; }
inline int more(int k) { return on(k) ? 1 : 0; }
/// 0 <-> 1, 2 -> 1.
inline int index(int k, int i) { return on(k) ? (i == 0 ? 1 : i - 1) : i; }
/// y -> x, x -> y, z -> y.
inline int component(int k, int i) { return on(k) ? (i == 1 ? 0 : 1) : i; }
inline const char* text(int k, const char* right) { return on(k) ? "mutated" : right; }

/// sign(k) * x: x, or -x (bool: !x).
struct sign {
  int k;
  explicit sign(int site) : k(site) {}
};
template <class Given>
inline __attribute__((always_inline)) auto operator*(sign s, Given&& x) {
  using X = plain<Given>;
  const bool flip = on(s.k);
  if constexpr (std::is_same_v<X, bool>)
    return x != flip;
  else if constexpr (std::is_arithmetic_v<X>)
    return static_cast<X>(flip ? -x : x);
  else if constexpr (is_eigen<X>) {
    if constexpr (std::is_same_v<X, typename X::PlainObject>) {
      X r = x;
      if (flip) r = -x;
      return r;
    } else {
      return typename X::Scalar(flip ? -1 : 1) * x;
    }
  } else if constexpr (requires { X(-x); }) {
    return flip ? X(-x) : X(x);
  } else {
    means_nothing(s.k);
    return X(static_cast<Given&&>(x));
  }
}

/// x & flipped(k) ? a : b: what x stands for as a condition, or its opposite.
struct flipped {
  int k;
  explicit flipped(int site) : k(site) {}
};
template <class X>
bool operator&(const X& x, flipped f) {
  return static_cast<bool>(x) != on(f.k);
}

/// a < less(k) < b and the like: at the border the other way for whole numbers, else the opposite.
enum class Op { lt, le, gt, ge, eq, ne };
template <Op op>
struct compare {
  int k;
  explicit compare(int site) : k(site) {}
};
template <Op op, class A>
struct half {
  int k;
  const A& a;
};
#define WHIRL_MUTATION_COMPARE(NAME, SIGN, SHIFTED)                        \
  template <class A>                                                       \
  half<Op::NAME, A> operator SIGN(const A& a, compare<Op::NAME> c) {       \
    return {c.k, a};                                                       \
  }                                                                        \
  template <class A, class B>                                              \
  auto operator SIGN(half<Op::NAME, A> h, const B& b) {                    \
    if constexpr (is_eigen<plain<decltype(h.a SIGN b)>>) {                 \
      means_nothing(h.k);                                                  \
      return h.a SIGN b;                                                   \
    } else if constexpr (std::is_integral_v<A> && std::is_integral_v<B>) { \
      return on(h.k) ? h.a SHIFTED b : h.a SIGN b;                         \
    } else {                                                               \
      return static_cast<bool>(h.a SIGN b) != on(h.k);                     \
    }                                                                      \
  }
WHIRL_MUTATION_COMPARE(lt, <, <=)
WHIRL_MUTATION_COMPARE(le, <=, <)
WHIRL_MUTATION_COMPARE(gt, >, >=)
WHIRL_MUTATION_COMPARE(ge, >=, >)
WHIRL_MUTATION_COMPARE(eq, ==, !=)
WHIRL_MUTATION_COMPARE(ne, !=, ==)
#undef WHIRL_MUTATION_COMPARE

/// a && also(k) | b: b no longer counts. a || unless(k) & b: likewise.
struct also {
  int k;
  explicit also(int site) : k(site) {}
};
template <class B>
bool operator|(also s, const B& b) {
  return on(s.k) || static_cast<bool>(b);
}
struct unless {
  int k;
  explicit unless(int site) : k(site) {}
};
template <class B>
bool operator&(unless s, const B& b) {
  return !on(s.k) && static_cast<bool>(b);
}

/// The smaller for the larger and back.
struct smaller {
  int k;
  template <class A>
  A operator()(const A& a, const A& b) const {
    return on(k) ? std::max(a, b) : std::min(a, b);
  }
  template <class A>
  A operator()(std::initializer_list<A> all) const {
    return on(k) ? std::max(all) : std::min(all);
  }
};
struct larger {
  int k;
  template <class A>
  A operator()(const A& a, const A& b) const {
    return on(k) ? std::min(a, b) : std::max(a, b);
  }
  template <class A>
  A operator()(std::initializer_list<A> all) const {
    return on(k) ? std::min(all) : std::max(all);
  }
};

/// One of two neighbours in a list: the other one when they have the same type.
template <class A, class B>
inline __attribute__((always_inline)) decltype(auto) pick(int k, A&& a, B&& b) {
  const bool other = on(k);
  if constexpr (std::is_same_v<plain<A>, plain<B>> && std::is_copy_constructible_v<plain<A>>) {
    return other ? plain<A>(b) : plain<A>(a);
  } else {
    means_nothing(k);
    return static_cast<A&&>(a);
  }
}

}  // namespace
}  // namespace whirl_mutation
