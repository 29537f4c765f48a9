#include <elements/shaft/general_beam.hpp>
#include <core/contract.hpp>

#include <core/dual_rate.hpp>
#include <system/stiffness_rate.hpp>
#include <math.h>
#include <array>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::NodeState;
using system::TangentX;

namespace {

#include <elements/shaft/shaft_single.inl>

#include <elements/shaft/beam_nodes.inl>
#include <elements/shaft/beam_derivatives.inl>

/// Bending stiffness of each plane and what shear takes of it: 1/(1 + Phi) = 1 - phi, slope of the
/// curvature per p1 + p2, 1/kGA.
struct Planes {
  double EIa, EIb, fa, fb, phia, phib, softa, softb;
  explicit Planes(const GeneralBeamConstants& c) {
    const auto plane = [&c](double k11, double k12, double k22, double& EI, double& f, double& phi,
                            double& soft) {
      const double mean = 0.5 * (k11 + k22), L = c.length;
      EI = 0.5 * L * (mean - k12);
      // a cone without shear gives a little more or less than one
      const double stiff = std::min((mean + k12) / (3.0 * (mean - k12)), 1.0);
      f = 6.0 / L * stiff;
      phi = 1.0 - stiff;
      soft = phi / stiff * L * L / (12.0 * EI);
    };
    plane(c.ky_def11, c.ky_def12, c.ky_def22, EIa, fa, phia, softa);
    plane(c.kz_def11, c.kz_def12, c.kz_def22, EIb, fb, phib, softb);
  }
};

/// Deformation at a configuration and the rates that go with it.
template <class T>
struct Shape {
  V3<T> a, D[2], q[2], p[2], y, z, ro[2];  // q, p: to the directors (shaft_strain.inl)
  End<NumbersOf<T>> end[2];
  T l, stretch, psi;
  struct Components {
    T y, z;
  };
  Components P[2];   // of p
  T My, Mz, Ky, Kz;  // mean curvature, and how much it changes from end to end
  Shape(const GeneralBeam& b, const NodeT<T>& n1, const NodeT<T>& n2, const SectionMotion<T>& m1,
        const SectionMotion<T>& m2) {
    using std::sqrt;
    ro[0] = m1.turn(b.arm1);
    ro[1] = m2.turn(b.arm2);
    const V3<T> du = n2.u - n1.u + (ro[1] - V3<T>(b.offset2)) - (ro[0] - V3<T>(b.offset1));
    const V3<T> lambda = V3<T>(b.chord) + du;
    l = sqrt(lambda.dot(lambda));
    stretch = (2.0 * V3<T>(b.chord).dot(du) + du.dot(du)) / (l + T(b.l0));
    a = (T(1.0) / l) * lambda;
    D[0] = m1.turn(b.body1.col(0));
    D[1] = m2.turn(b.body2.col(0));
    const V3<T> B[2] = {m1.turn(b.body1.col(1)), m2.turn(b.body2.col(1))};
    V3<T> transported[2];  // B to the chord
    for (int i = 0; i < 2; ++i) {
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
    set_curvatures(b);
    set_twist(b.c.length, transported);
  }
  T bow(const GeneralBeamConstants& c) const {
    return 0.5 * (c.b11 * p[0].dot(p[0]) + 2.0 * c.b12 * p[0].dot(p[1]) + c.b22 * p[1].dot(p[1]));
  }

 private:
  void set_curvatures(const GeneralBeam& b) {
    for (int i = 0; i < 2; ++i)
      P[i] = {p[i].dot(y), p[i].dot(z)};
    const Planes plane(b.c);
    const double il = 1.0 / b.c.length;
    My = il * (P[1].y - P[0].y);
    Mz = il * (P[1].z - P[0].z);
    const Vec2 rest = b.p01 + b.p02;  // the unstressed shape has no shear
    Ky = plane.fa * (P[0].y + P[1].y - T(rest[0])) + T(6.0 * il * rest[0]);
    Kz = plane.fb * (P[0].z + P[1].z - T(rest[1])) + T(6.0 * il * rest[1]);
  }
  void set_twist(double length, const V3<T> (&B)[2]) {
    using std::atan2;
    psi = atan2(a.dot(B[0].cross(B[1])), B[0].dot(B[1])) -
          0.5 * (P[0].y * P[1].z - P[0].z * P[1].y) -
          (length * length / 12.0) * (My * Kz - Mz * Ky);
  }
};

double bow0(const GeneralBeam& b) {
  return 0.5 * (b.c.b11 * b.p01.squaredNorm() + 2.0 * b.c.b12 * b.p01.dot(b.p02) +
                b.c.b22 * b.p02.squaredNorm());
}

/// 1/(GJ + more) and its derivative in `more`; its parabola below more = -GJ/2.
template <class T>
struct TwistGive {
  T g, slope;
  TwistGive(double GJ, const T& more) {
    const T x = (1.0 / GJ) * more;
    if (value(x) > -0.5) {
      const T rho = T(1.0) / (T(1.0) + x);
      g = (1.0 / GJ) * rho;
      slope = (-1.0 / (GJ * GJ)) * (rho * rho);
    } else {
      const T below = x + T(0.5);
      g = (1.0 / GJ) * (T(2.0) - 4.0 * below + 8.0 * (below * below));
      slope = (1.0 / (GJ * GJ)) * (T(-4.0) + 16.0 * below);
    }
  }
};

/// Mean curvatures and their changes: m, k of the header, and m^e, k^e of the deformation.
template <class T>
struct Curvatures {
  const T &My, &Mz, &Ky, &Kz;
  T Ey, Ez, Sy, Sz;
  Curvatures(const Shape<T>& p, const Planes& n, double il, const T (&ky)[2], const T (&kz)[2])
      : My(p.My),
        Mz(p.Mz),
        Ky(p.Ky),
        Kz(p.Kz),
        Ey(il * (ky[1] - ky[0])),
        Ez(il * (kz[1] - kz[0])),
        Sy(n.fa * (ky[0] + ky[1])),
        Sz(n.fb * (kz[0] + kz[1])) {}
};

/// c(x) = c0 + c1 x + c2 x^2 and s(x) = s0 + s1 x + s2 x^2 over x = xi - 1/2: what turning the
/// sections inside costs.
template <class T>
struct TurningCost {
  T c0, c1, c2, s0, s1, s2;
  // derivatives in (My, Ey) together and in (Ky, Sy) together; c1 has those of c0 and c2 crossed,
  // s1 those of s0 and s2
  T c0y, c0z, c2y, c2z, s0y, s0z, s2y, s2z;
  TurningCost(double EIa, double EIb, const Curvatures<T>& k) {
    const T &My = k.My, &Mz = k.Mz, &Ky = k.Ky, &Kz = k.Kz;
    const T &Ey = k.Ey, &Ez = k.Ez, &Sy = k.Sy, &Sz = k.Sz;
    c0 = EIa * (Mz * Ey) - EIb * (My * Ez);
    c1 = EIa * (Kz * Ey + Mz * Sy) - EIb * (Ky * Ez + My * Sz);
    c2 = EIa * (Kz * Sy) - EIb * (Ky * Sz);
    s0 = EIa * (Mz * Mz - My * Ey) + EIb * (My * My - Mz * Ez);
    s1 = EIa * (2.0 * (Mz * Kz) - My * Sy - Ky * Ey) + EIb * (2.0 * (My * Ky) - Mz * Sz - Kz * Ez);
    s2 = EIa * (Kz * Kz - Ky * Sy) + EIb * (Ky * Ky - Kz * Sz);
    c0y = EIa * Mz - EIb * Ez;
    c0z = EIa * Ey - EIb * My;
    c2y = EIa * Kz - EIb * Sz;
    c2z = EIa * Sy - EIb * Ky;
    s0y = 2.0 * EIb * My - EIa * (Ey + My);
    s0z = 2.0 * EIa * Mz - EIb * (Ez + Mz);
    s2y = 2.0 * EIb * Ky - EIa * (Sy + Ky);
    s2z = 2.0 * EIa * Kz - EIb * (Sz + Kz);
  }
};

/// The sections inside turn by t x, and by a parabola out of the way of c, against GJ and against
/// s: energy and its derivatives in the coefficients of c and s. on_parabola: on c2, and on t s1.
template <class T>
struct Turning {
  T V, on_c0{}, on_c1, on_parabola{}, on_s0, on_s1, on_s2;
  Turning(double L, double GJ, const T& t, const TurningCost<T>& k) {
    on_c1 = L / 12.0 * t;
    on_s0 = 0.5 * (on_c1 * t);
    on_s2 = (L / 160.0) * (t * t);
    V = on_c1 * k.c1 + on_s0 * k.s0 + on_s2 * k.s2;
    if (GJ > 0.0) {
      const TwistGive<T> give(GJ, (L * L) * (0.1 * k.s0 + (1.0 / 280.0) * k.s2));
      const T load = (2.0 / 3.0) * k.c0 + (1.0 / 30.0) * (k.c2 + t * k.s1);
      const double scale = 3.0 / 16.0 * L * L * L;
      const T on_load = -scale * (load * give.g);
      const T on_more = (-0.5 * scale * L * L) * (load * load * give.slope);
      V += 0.5 * (load * on_load);
      on_c0 = (2.0 / 3.0) * on_load;
      on_parabola = (1.0 / 30.0) * on_load;
      on_s0 += 0.1 * on_more;
      on_s2 += (1.0 / 280.0) * on_more;
    }
    on_s1 = on_parabola * t;
  }
};

/// What the element does inside (general_beam.hpp): energy, and forces on (p1.y, p2.y), (p1.z,
/// p2.z); the torque and axial force that act on the rates of psi and w. ky, kz: deformations.
template <class T>
struct Inner {
  T V{}, my[2], mz[2], torque{}, axial{};
  Inner(const GeneralBeam& b, const Shape<T>& p, const T (&ky)[2], const T (&kz)[2], const T& N) {
    const GeneralBeamConstants& c = b.c;
    const Planes n(c);
    const double L = c.length, h = L / 12.0, GJ = c.GJ_l * L;
    const Curvatures<T> k(p, n, 1.0 / L, ky, kz);
    const TurningCost<T> cost(n.EIa, n.EIb, k);
    const T t = p.psi - T(b.psi_r), twist = p.psi - T(b.psi0);
    const Turning<T> turning(L, GJ, t, cost);
    V = turning.V;

    // slopes of curvature and shear that the end moments do not make
    const T xy = t * cost.c0y + GJ * (twist * k.Mz), xz = t * cost.c0z - GJ * (twist * k.My);
    const double qa = h * n.phia / n.EIa, qb = h * n.phib / n.EIb;  // L^3/kGA/144 (1 - phi)
    const double na = L * L * L / 12.0 * n.softa, nb = L * L * L / 12.0 * n.softb;
    // the slope of the shear lengthens the line too: kGA + N
    const ShearGive<T> ga = shear_give(N, n.softa, -0.5 / n.softa);
    const ShearGive<T> gb = shear_give(N, n.softb, -0.5 / n.softb);
    V -= 0.5 * (qa * (xy * xy) + qb * (xz * xz)) +
         0.5 * (na * ga.g * (k.My * k.My) + nb * gb.g * (k.Mz * k.Mz));
    axial = N - c.EA_l * (na * ga.g1 * (k.My * k.My) + nb * gb.g1 * (k.Mz * k.Mz));
    const T ax = qa * xy, az = qb * xz;
    torque = T(c.GJ_l) * twist + h * (cost.c1 + t * cost.s0) + (L / 80.0) * (t * cost.s2) +
             turning.on_parabola * cost.s1;
    torque = torque - ax * ((n.EIa + GJ) * k.Mz - n.EIb * k.Ez) -
             az * (n.EIa * k.Ey - (n.EIb + GJ) * k.My);

    Slopes on = slopes(cost, turning);
    on.My = on.My - az * (t * (n.EIa - n.EIb) - GJ * twist) - na * ga.g * k.My;
    on.Mz = on.Mz - ax * (t * (n.EIa - n.EIb) + GJ * twist) - nb * gb.g * k.Mz;
    set_moments(n, L, p, on);
  }

 private:
  /// Derivatives of V in the mean curvatures and in their changes.
  struct Slopes {
    T My, Mz, Ky, Kz;
  };
  static Slopes slopes(const TurningCost<T>& c, const Turning<T>& t) {
    return {t.on_c0 * c.c0y + t.on_c1 * c.c2y + t.on_s0 * c.s0y + t.on_s1 * c.s2y,
            t.on_c0 * c.c0z + t.on_c1 * c.c2z + t.on_s0 * c.s0z + t.on_s1 * c.s2z,
            t.on_c1 * c.c0y + t.on_parabola * c.c2y + t.on_s1 * c.s0y + t.on_s2 * c.s2y,
            t.on_c1 * c.c0z + t.on_parabola * c.c2z + t.on_s1 * c.s0z + t.on_s2 * c.s2z};
  }
  /// With what the torque does through the area in psi.
  void set_moments(const Planes& n, double L, const Shape<T>& p, Slopes on) {
    const double il = 1.0 / L;
    const T area = (L * L / 12.0) * torque, half = 0.5 * torque;
    on.My = on.My - area * p.Kz;
    on.Mz = on.Mz + area * p.Ky;
    on.Ky = on.Ky + area * p.Mz;
    on.Kz = on.Kz - area * p.My;
    my[0] = n.fa * on.Ky - il * on.My - half * p.P[1].z;
    my[1] = n.fa * on.Ky + il * on.My + half * p.P[0].z;
    mz[0] = n.fb * on.Kz - il * on.Mz + half * p.P[1].y;
    mz[1] = n.fb * on.Kz + il * on.Mz - half * p.P[0].y;
  }
};

/// A configuration and its motion.
template <class T>
struct Moving {
  const NodeT<T>* node[2];
  const SectionMotion<T>* motion[2];
  Shape<T> shape;
  V3<T> ad[2];  // (a x D)/(1 + a.D)
  Moving(const GeneralBeam& b, const NodeT<T>& n1, const NodeT<T>& n2, const SectionMotion<T>& m1,
         const SectionMotion<T>& m2)
      : node{&n1, &n2},
        motion{&m1, &m2},
        shape(b, n1, n2, m1, m2) {
    for (int i = 0; i < 2; ++i)
      ad[i] = (T(1.0) / (T(2.0) - shape.end[i].n)) * shape.a.cross(shape.end[i].delta);
  }
};

/// On the rates of (p1, p2) along y and z, of psi and of w.
template <class T>
struct BeamStresses {
  T my[2], mz[2], twist, N;
  T pull{};  ///< on the length of the chord alone, which N sees with what bending takes of it
  T dissipated{};
};
template <class T>
BeamStresses<T> elastic_stresses(const GeneralBeam& b, const Shape<T>& s) {
  const GeneralBeamConstants& c = b.c;
  const T N0 = T(b.preload) + c.EA_l * (s.stretch + c.length * (s.bow(c) - T(bow0(b))));
  T ky[2], kz[2];  // deformations along y and z
  for (int i = 0; i < 2; ++i) {
    const Vec2& p0 = i == 0 ? b.p01 : b.p02;
    ky[i] = s.P[i].y - T(p0[0]);
    kz[i] = s.P[i].z - T(p0[1]);
  }
  const Inner<T> inner(b, s, ky, kz, N0);
  BeamStresses<T> r{
      {c.ky_def11 * ky[0] + c.ky_def12 * ky[1], c.ky_def12 * ky[0] + c.ky_def22 * ky[1]},
      {c.kz_def11 * kz[0] + c.kz_def12 * kz[1], c.kz_def12 * kz[0] + c.kz_def22 * kz[1]},
      inner.torque,
      inner.axial};
  for (int i = 0; i < 2; ++i) {
    r.my[i] += inner.my[i];
    r.mz[i] += inner.mz[i];
  }
  return r;
}

/// Damping of the objective rates of the same measures.
template <class T>
void add_damping(const GeneralBeamConstants& c, const Moving<T>& x, BeamStresses<T>& r) {
  const Shape<T>& s = x.shape;
  const V3<T>&omega1 = x.motion[0]->omega, &omega2 = x.motion[1]->omega;
  const V3<T> rdot = x.node[1]->du + omega2.cross(s.ro[1]) - x.node[0]->du - omega1.cross(s.ro[0]);
  const T ldot = s.a.dot(rdot);
  const V3<T> adot = (T(1.0) / s.l) * (rdot - ldot * s.a);
  T sigma[2];
  V3<T> rate[2];
  for (int i = 0; i < 2; ++i) {
    const V3<T>& omega = x.motion[i]->omega;
    sigma[i] = (s.a + s.D[i]).dot(omega) / (T(2.0) - s.end[i].n) + x.ad[i].dot(adot);
    rate[i] = bending_rate(s.end[i], s.q[i], s.a, adot, omega.cross(s.D[i]));
  }
  const T mean = 0.5 * (sigma[0] + sigma[1]);
  T ry[2], rz[2];
  for (int i = 0; i < 2; ++i) {
    rate[i] = rate[i] - mean * s.a.cross(s.p[i]);
    ry[i] = rate[i].dot(s.y);
    rz[i] = rate[i].dot(s.z);
  }
  const T dy[2] = {c.beta * (c.ky_def11 * ry[0] + c.ky_def12 * ry[1]),
                   c.beta * (c.ky_def12 * ry[0] + c.ky_def22 * ry[1])};
  const T dz[2] = {c.beta * (c.kz_def11 * rz[0] + c.kz_def12 * rz[1]),
                   c.beta * (c.kz_def12 * rz[0] + c.kz_def22 * rz[1])};
  const T psidot = sigma[1] - sigma[0], torque = (c.beta_twist * c.GJ_l) * psidot;
  r.twist += torque;
  r.pull = (c.beta_axial * c.EA_l) * ldot;
  r.dissipated = torque * psidot + r.pull * ldot;
  for (int i = 0; i < 2; ++i) {
    r.my[i] += dy[i];
    r.mz[i] += dz[i];
    r.dissipated += dy[i] * ry[i] + dz[i] * rz[i];
  }
}

/// From the power of the stresses to forces on the end points and moments on the spins (the chain
/// of shaft_damping.inl).
template <class T>
ForceOut<T> force_of_stresses(const GeneralBeamConstants& c, const Moving<T>& x,
                              const BeamStresses<T>& r) {
  const Shape<T>& s = x.shape;
  const T NL = c.length * r.N;
  V3<T> M[2];
  M[0] = r.my[0] * s.y + r.mz[0] * s.z + NL * (T(c.b11) * s.p[0] + T(c.b12) * s.p[1]);
  M[1] = r.my[1] * s.y + r.mz[1] * s.z + NL * (T(c.b12) * s.p[0] + T(c.b22) * s.p[1]);
  const T turning = -0.5 * (M[0].dot(s.a.cross(s.p[0])) + M[1].dot(s.a.cross(s.p[1])));
  const T spin[2] = {turning - r.twist, turning + r.twist};
  V3<T> fa = spin[0] * x.ad[0] + spin[1] * x.ad[1];
  ForceOut<T> out;
  for (int i = 0; i < 2; ++i) {
    const End<NumbersOf<T>>& end = s.end[i];
    const V3<T> k = cosine_force(end, s.q[i], M[i]);
    fa = fa - k - (end.angle.G * (T(1.0) - end.n)) * M[i];
    const V3<T> on_D = k + end.angle.G * perpendicular(s.a, M[i]);
    out.m[i] = s.D[i].cross(on_D) + (spin[i] / (T(2.0) - end.n)) * (s.a + s.D[i]);
  }
  out.f[1] = (r.N + r.pull) * s.a + (T(1.0) / s.l) * perpendicular(s.a, fa);
  out.f[0] = T(-1.0) * out.f[1];
  out.dissipated = r.dissipated;
  return out;
}

/// M4 on the end points and directors; out: the moments on these are added, the forces on the end
/// points get their lever to the nodes.
template <class T>
void add_beam_inertia(const GeneralBeamConstants& c, const Moving<T>& x, ForceOut<T>& out) {
  const Shape<T>& s = x.shape;
  V3<T> acc[4], g[4];
  for (int i = 0; i < 2; ++i) {
    const SectionMotion<T>& m = *x.motion[i];
    acc[2 * i] = x.node[i]->ddu + m.accel(s.ro[i]);
    acc[2 * i + 1] = m.accel(s.D[i]);
    if (c.alpha > 0.0) {
      acc[2 * i] = acc[2 * i] + T(c.alpha) * (x.node[i]->du + m.omega.cross(s.ro[i]));
      acc[2 * i + 1] = acc[2 * i + 1] + T(c.alpha) * m.omega.cross(s.D[i]);
    }
  }
  for (int k = 0; k < 4; ++k) {
    g[k] = T(c.M4(k, 0)) * acc[0];
    for (int j = 1; j < 4; ++j)
      g[k] = g[k] + T(c.M4(k, j)) * acc[j];
  }
  for (int i = 0; i < 2; ++i) {
    out.f[i] = out.f[i] + g[2 * i];
    out.m[i] = out.m[i] + s.D[i].cross(g[2 * i + 1]) + s.ro[i].cross(out.f[i]);
  }
}

/// Inertia on a director (D, B, C) of both triads.
const Mat2& director_inertia(const GeneralBeamConstants& c, int k) {
  const std::size_t i = static_cast<std::size_t>(k);
  return c.triads.on[i][i];
}

/// Rotary inertia on the triads.
template <class T>
void add_triad_inertia(const GeneralBeam& b, const Moving<T>& x, ForceOut<T>& out) {
  const SectionMotion<T>&m1 = *x.motion[0], &m2 = *x.motion[1];
  for (int axis = 0; axis < 3; ++axis) {
    const Mat2& J = director_inertia(b.c, axis);
    const V3<T> b1 = m1.turn(b.body1.col(axis)), b2 = m2.turn(b.body2.col(axis));
    V3<T> a1 = m1.accel(b1), a2 = m2.accel(b2);
    if (b.c.alpha > 0.0) {
      a1 = a1 + T(b.c.alpha) * m1.omega.cross(b1);
      a2 = a2 + T(b.c.alpha) * m2.omega.cross(b2);
    }
    out.m[0] = out.m[0] + b1.cross(T(J(0, 0)) * a1 + T(J(0, 1)) * a2);
    out.m[1] = out.m[1] + b2.cross(T(J(0, 1)) * a1 + T(J(1, 1)) * a2);
  }
}

template <class T>
ForceOut<T> beam_force(const GeneralBeam& b, const NodeT<T>& n1, const NodeT<T>& n2,
                       const SectionMotion<T>& m1, const SectionMotion<T>& m2) {
  const Moving<T> x(b, n1, n2, m1, m2);
  BeamStresses<T> stresses = elastic_stresses(b, x.shape);
  if (b.c.damped()) add_damping(b.c, x, stresses);
  ForceOut<T> out = force_of_stresses(b.c, x, stresses);
  add_triad_inertia(b, x, out);
  add_beam_inertia(b.c, x, out);
  return out;
}

using D14 = Dual<14>;

template <class Seed>
Matrix<14> differentiate(const GeneralBeam& b, const Nodes<2>& x, Seed&& seed) {
  NodeT<D14> n[2] = {NodeT<D14>(*x[0]), NodeT<D14>(*x[1])};
  for (int i = 0; i < 2; ++i)
    seed(n[i], *x[i], 7 * i);
  const SectionMotion<D14> m1(n[0]), m2(n[1]);
  const auto f = to_X(beam_force(b, n[0], n[1], m1, m2), m1, m2);
  Matrix<14> J;
  for (int k = 0; k < 14; ++k)
    J.row(k) = f[static_cast<std::size_t>(k)].g.transpose();
  return J;
}

}  // namespace

GeneralBeam::GeneralBeam(const GeneralBeamConstants& constants, const Vec3& chord_, const Mat3& t1,
                         const Mat3& t2, const Vec3& o1, const Vec3& o2, const Mat3& chart1,
                         const Mat3& chart2)
    : c(constants),
      chord(chord_),
      triad1(t1),
      triad2(t2),
      offset1(o1),
      offset2(o2),
      body1(chart1.transpose() * t1),
      body2(chart2.transpose() * t2),
      arm1(chart1.transpose() * o1),
      arm2(chart2.transpose() * o2),
      l0(chord_.norm()) {
  WHIRL_EXPECTS(c.length > 0.0 && l0 > 0.0);
  NodeState rest1, rest2;
  for (NodeState* r : {&rest1, &rest2})
    r->u = r->du = r->ddu = r->t = r->dd = r->ddd = Vec3::Zero();
  rest1.chart = &chart1;
  rest2.chart = &chart2;
  const NodeT<double> n1(rest1), n2(rest2);
  const SectionMotion<double> m1(n1), m2(n2);
  const Shape<double> s(*this, n1, n2, m1, m2);
  p01 = Vec2(s.P[0].y, s.P[0].z);
  p02 = Vec2(s.P[1].y, s.P[1].z);
  psi0 = Shape<double>(*this, n1, n2, m1, m2).psi;  // with the area of the unstressed shape
  if (p01.squaredNorm() + p02.squaredNorm() > 1e-20) psi_r = psi0;
}

namespace {
bool alike_across(const TriadInertia& t) {
  const Mat2 &B = t.on[1][1], &C = t.on[2][2];
  return (B - C).cwiseAbs().maxCoeff() <= 1e-12 * B.cwiseAbs().maxCoeff();
}
}  // namespace

bool GeneralBeam::axisymmetric() const {
  const auto equal = [](double a, double b) {
    return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
  };
  const auto along_axis = [](const Vec3& v) { return v.tail<2>().norm() <= 1e-10 * v.norm(); };
  return equal(c.ky_def11, c.kz_def11) && equal(c.ky_def12, c.kz_def12) &&
         equal(c.ky_def22, c.kz_def22) && alike_across(c.triads) && along_axis(body1.col(0)) &&
         along_axis(body2.col(0)) && along_axis(arm1) && along_axis(arm2) &&
         p01.squaredNorm() + p02.squaredNorm() <= 1e-20;
}

void GeneralBeam::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const auto r = to_X(beam_force(*this, n1, n2, m1, m2), m1, m2);
  f += Eigen::Map<const Vector<14>>(r.data());
}

void GeneralBeam::add_tangent(const Nodes<2>& x, const Context&, TangentX<14>& out) const {
  out.K += differentiate(*this, x, VaryPlace());
  out.C += differentiate(*this, x, VaryRate());
  out.M += differentiate(*this, x, VaryAcceleration());
}

void GeneralBeam::add_stiffness_rate(const Nodes<2>& x, const Nodes<2>& rate, const Context&,
                                     system::StiffnessRateX<14>& out) const {
  differentiate_in_motion(*this, x, rate, out);
}

void GeneralBeam::add_energy(const Nodes<2>& x, const Context& ctx, Energy& en) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const Shape<double> s(*this, n1, n2, m1, m2);
  const double w = s.stretch + c.length * (s.bow(c) - bow0(*this));
  const double N = preload + c.EA_l * w;
  double V = (0.5 * c.EA_l * w + preload) * w + 0.5 * c.GJ_l * (s.psi - psi0) * (s.psi - psi0);
  const double y1 = s.P[0].y - p01[0], y2 = s.P[1].y - p02[0], z1 = s.P[0].z - p01[1],
               z2 = s.P[1].z - p02[1];
  V += 0.5 * (c.ky_def11 * y1 * y1 + 2 * c.ky_def12 * y1 * y2 + c.ky_def22 * y2 * y2);
  V += 0.5 * (c.kz_def11 * z1 * z1 + 2 * c.kz_def12 * z1 * z2 + c.kz_def22 * z2 * z2);
  const double ky[2] = {y1, y2}, kz[2] = {z1, z2};
  en.elastic += V + Inner<double>(*this, s, ky, kz, N).V;
  const double kinetic_before = en.kinetic;
  auto vec = [](const V3<double>& v) { return Vec3(v.x, v.y, v.z); };
  const Vec3 w1 = vec(m1.omega), w2 = vec(m2.omega);
  const Vec3 X[4] = {vec(s.ro[0]), vec(s.D[0]), vec(s.ro[1]), vec(s.D[1])};
  const Vec3 v[4] = {x[0]->du + w1.cross(X[0]), w1.cross(X[1]), x[1]->du + w2.cross(X[2]),
                     w2.cross(X[3])};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      en.kinetic += 0.5 * c.M4(k, j) * v[k].dot(v[j]);
  for (int axis = 0; axis < 3; ++axis) {
    const Mat2& J = director_inertia(c, axis);
    const Vec3 b1 = w1.cross(vec(m1.turn(body1.col(axis)))),
               b2 = w2.cross(vec(m2.turn(body2.col(axis))));
    en.kinetic +=
        0.5 * (J(0, 0) * b1.squaredNorm() + J(1, 1) * b2.squaredNorm()) + J(0, 1) * b1.dot(b2);
  }
  // Relative to the reference configuration, so that a change of chart leaves it alone.
  const Vec3 P[4] = {x[0]->u + X[0] - offset1, X[1] - triad1.col(0), x[1]->u + X[2] - offset2,
                     X[3] - triad2.col(0)};
  for (int j = 0; j < 4; ++j)
    en.gravity -= (c.M4(0, j) + c.M4(2, j)) * ctx.gravity.dot(P[j]);
  if (c.damped()) en.dissipated += beam_force(*this, n1, n2, m1, m2).dissipated;
  if (c.alpha > 0.0) en.dissipated += 2.0 * c.alpha * (en.kinetic - kinetic_before);
}

namespace {
[[maybe_unused]] const bool known = system::know_stiffness_rate<GeneralBeam>();
}  // namespace

}  // namespace whirl::elements
