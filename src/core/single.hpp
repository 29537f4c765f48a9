// What a formula needs that is written once for several nodes or elements at a time
// (core/lanes.inl) and for one: the same names for one node or element, with double, Dual or
// DualRate for a scalar. Such a formula stands in an .inl file, which each user includes in a
// namespace of its own, so that no two instruction sets share a function; around the .inl files the
// user defines WHIRL_INLINE as inline. Not for files that include core/lanes.inl.
#pragma once
#include <core/dual.hpp>
#include <cmath>

namespace whirl::single {

/// Kinds of numbers a formula may be written in: S::T scalars, S::V vectors of three.
struct Numbers {
  using T = double;
  using V = Vec3;
};
template <class X>
struct NumbersOf {
  using T = X;
  using V = Vec3T<X>;
};

inline bool every(bool x) { return x; }
inline double dot(const Vec3& a, const Vec3& b) { return a.dot(b); }
inline Vec3 cross(const Vec3& a, const Vec3& b) { return a.cross(b); }
template <class T>
T dot(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.dot(b);
}
template <class T>
Vec3T<T> cross(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.cross(b);
}
template <class T>
T root(const T& x) {
  using std::sqrt;
  return sqrt(x);
}
/// x, or the limit where x is below it.
template <class T>
T at_least(const T& x, double limit) {
  return value(x) > limit ? x : T(limit);
}
/// What vectors and scalars are divided by.
template <class T>
const T& divisor(const T& x) {
  return x;
}

}  // namespace whirl::single
