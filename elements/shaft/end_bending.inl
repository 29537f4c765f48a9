// Bending of a straight element seen in axes that turn with it, and the way from moments on it to the
// nodes: for what acts on a shaft through its bending alone (breathing cracks, thermal bows).
// Included inside an anonymous namespace after beam_nodes.inl.
//
// p_i: vector from the chord a towards the director D_i, perpendicular to a, |p_i| the angle between
// them. y: bisector of the section's first axis B of both ends, transported to the chord; z = a x y.
// P_i = (p_i.y, p_i.z) do not see rigid motion. The force of an energy V(P_1, P_2) is found from the
// power of its derivatives on objective rates, as in general_beam.hpp.
#pragma once

/// Bending of the ends in section axes, and what the forces need of the kinematics.
template <class T>
struct EndBending {
  V3<T> a, y, z, D[2], B[2], q[2], p[2], ro[2];
  End<NumbersOf<T>> end[2];
  T l;
  struct Components {
    T y, z;
  };
  Components P[2];

  EndBending(const EndAxes& b, const NodeT<T>& n1, const NodeT<T>& n2, const SectionMotion<T>& m1,
             const SectionMotion<T>& m2) {
    using std::sqrt;
    const SectionMotion<T>* motion[2] = {&m1, &m2};
    const double offset[2] = {b.o1, b.o2};
    V3<T> transported[2];
    for (int i = 0; i < 2; ++i) {
      D[i] = motion[i]->turn(Vec3::UnitX());
      B[i] = motion[i]->turn(b.normal);
      ro[i] = T(offset[i]) * D[i];
    }
    const V3<T> lambda = V3<T>(Vec3(b.length + b.o1 - b.o2, 0, 0)) + n2.u - n1.u + ro[1] - ro[0];
    l = sqrt(lambda.dot(lambda));
    a = (T(1.0) / l) * lambda;
    for (int i = 0; i < 2; ++i) {
      // differences of small numbers: a tilt of 1e-12 rad keeps its digits
      end[i].delta = D[i] - a;
      end[i].n = 0.5 * end[i].delta.dot(end[i].delta);
      end[i].angle = angle_ratio(end[i].n);
      q[i] = end[i].delta + end[i].n * a;
      p[i] = end[i].angle.G * q[i];
      transported[i] = B[i] - (a.dot(B[i]) / (T(2.0) - end[i].n)) * (a + D[i]);
    }
    const V3<T> sum = transported[0] + transported[1];
    y = (T(1.0) / sqrt(sum.dot(sum))) * sum;
    z = a.cross(y);
    for (int i = 0; i < 2; ++i)
      P[i] = {p[i].dot(y), p[i].dot(z)};
  }

  /// Forces on the nodes and moments about them of dV/dP.
  ForceOut<T> forces(const T (&on_y)[2], const T (&on_z)[2]) const {
    V3<T> M[2];
    T turning = 0.0;
    for (int i = 0; i < 2; ++i) {
      M[i] = on_y[i] * y + on_z[i] * z;
      turning = turning - 0.5 * M[i].dot(a.cross(p[i]));
    }
    ForceOut<T> out;
    V3<T> fa;
    for (int i = 0; i < 2; ++i) {
      const End<NumbersOf<T>>& e = end[i];
      const T share = T(1.0) / (T(2.0) - e.n);
      const V3<T> k = cosine_force(e, q[i], M[i]);
      fa = fa + (turning * share) * a.cross(e.delta) - k - (e.angle.G * (T(1.0) - e.n)) * M[i];
      const V3<T> on_D = k + e.angle.G * perpendicular(a, M[i]);
      out.m[i] = D[i].cross(on_D) + (turning * share) * (a + D[i]);
    }
    out.f[1] = (T(1.0) / l) * perpendicular(a, fa);
    out.f[0] = T(-1.0) * out.f[1];
    for (int i = 0; i < 2; ++i)
      out.m[i] = out.m[i] + ro[i].cross(out.f[i]);
    return out;
  }
};

/// The derivatives of its force in X.
template <class Kernel>
Matrix<14> differentiate_place(const Kernel& k, const Nodes<2>& x, const Context& c) {
  using D = Dual<14>;
  NodeT<D> n[2] = {NodeT<D>(*x[0]), NodeT<D>(*x[1])};
  for (int i = 0; i < 2; ++i)
    VaryPlace()(n[i], *x[static_cast<std::size_t>(i)], 7 * i);
  const SectionMotion<D> m1(n[0]), m2(n[1]);
  const auto f = to_X(bending_force(k, n[0], n[1], m1, m2, c), m1, m2);
  Matrix<14> J;
  for (int r = 0; r < 14; ++r)
    J.row(r) = f[static_cast<std::size_t>(r)].g.transpose();
  return J;
}

template <class Kernel>
std::array<double, 14> place_force(const Kernel& k, const Nodes<2>& x, const Context& c) {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  return to_X(bending_force(k, n1, n2, m1, m2, c), m1, m2);
}
