#include <elements/shaft/section_beam.hpp>

#include <elements/shaft/corrected_mass.hpp>

#include <core/dual_rate.hpp>
#include <system/stiffness_rate.hpp>
#include <math.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

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

/// A strain, stress or screw.
template <class T>
struct Six {
  V3<T> u, r;
  Six() = default;
  Six(const V3<T>& a, const V3<T>& b) : u(a), r(b) {}
  explicit Six(const Vector<6>& v) : u(Vec3(v.head<3>())), r(Vec3(v.tail<3>())) {}
  friend Six operator+(const Six& a, const Six& b) { return {a.u + b.u, a.r + b.r}; }
  friend Six operator-(const Six& a, const Six& b) { return {a.u - b.u, a.r - b.r}; }
  friend Six operator*(double s, const Six& a) { return {T(s) * a.u, T(s) * a.r}; }
  T dot(const Six& b) const { return u.dot(b.u) + r.dot(b.r); }
  Vector<6> values() const {
    Vector<6> v;
    v << value(u.x), value(u.y), value(u.z), value(r.x), value(r.y), value(r.z);
    return v;
  }
};

template <class T, class M>
V3<T> times3(const M& A, const Six<T>& x) {
  const auto row = [&](int i) {
    return A(i, 0) * x.u.x + A(i, 1) * x.u.y + A(i, 2) * x.u.z + A(i, 3) * x.r.x + A(i, 4) * x.r.y +
           A(i, 5) * x.r.z;
  };
  return {row(0), row(1), row(2)};
}
template <class T>
Six<T> times(const Matrix<6>& A, const Six<T>& x) {
  return {times3(A.topRows<3>(), x), times3(A.bottomRows<3>(), x)};
}

/// Quaternion w + v.
template <class T>
struct Quaternion {
  T w;
  V3<T> v;
  Quaternion(const T& a, const V3<T>& b) : w(a), v(b) {}
  explicit Quaternion(const Mat3& R) {
    const Eigen::Quaterniond q(R);
    w = q.w();
    v = V3<T>(Vec3(q.vec()));
  }
  Quaternion conjugate() const { return {w, -v}; }
  Quaternion operator*(const Quaternion& b) const {
    return {w * b.w - v.dot(b.v), w * b.v + b.w * v + v.cross(b.v)};
  }
  V3<T> turn(const V3<T>& x) const {
    const V3<T> t = T(2.0) * v.cross(x);
    return x + w * t + v.cross(t);
  }
  V3<T> turn_back(const V3<T>& x) const {
    const V3<T> t = T(2.0) * x.cross(v);
    return x + w * t + t.cross(v);
  }
};

/// Of the triad at a node: body in components of its chart at rest.
template <class T>
Quaternion<T> triad_rotation(const NodeT<T>& n, const SectionMotion<T>& m, const Mat3& body) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T c = T(1.0) + m.e.dot(m.d);
  const T inverse = T(1.0) / sqrt(2.0 * c);
  const Quaternion<T> tilt(c * inverse, inverse * m.e.cross(m.d));
  const T half = 0.5 * n.phi;
  const Quaternion<T> spin(cos(half), sin(half) * m.e);
  return tilt * spin * Quaternion<T>(Mat3(*n.chart * body));
}

/// g = (x/2)/sin(x/2), h = (1 - g)/x^2, and their derivatives in X = x^2; half_sine, half_cosine of
/// x/2.
template <class T>
struct HalfAngle {
  T g, h, g1, h1;
};
template <class T>
HalfAngle<T> half_angle(const T& X, const T& sine_square, const T& cosine) {
  using std::atan2;
  using std::sqrt;
  HalfAngle<T> r;
  if (value(X) < 0.2) {
    // (x/2)/sin(x/2) = 1 + X/24 + 7 X^2/5760 + ..: 2 (2^(2k-1) - 1) |B_2k|/(2k)!/4^k
    static constexpr double c[] = {1.0 / 24,
                                   7.0 / 5760,
                                   31.0 / 967680,
                                   127.0 / 154828800,
                                   73.0 / 3503554560.0,
                                   1414477.0 / 2678117105664000.0,
                                   8191.0 / 612141052723200.0};
    T series = c[6], slope = 6.0 * c[6];
    for (int k = 5; k >= 0; --k)
      series = c[k] + X * series;
    for (int k = 5; k >= 1; --k)
      slope = double(k) * c[k] + X * slope;
    r.g = T(1.0) + X * series;
    r.h = -series;
    r.g1 = series + X * slope;
    r.h1 = -slope;
    return r;
  }
  const T sine = sqrt(sine_square);
  r.g = atan2(sine, cosine) / sine;
  r.h = (T(1.0) - r.g) / X;
  r.g1 = (T(1.0) - r.g * cosine) / (8.0 * (r.g * sine_square));
  r.h1 = -(r.g1 + r.h) / X;
  return r;
}

/// The screw from end to end and what its rates need.
template <class T>
struct Screw {
  Quaternion<T> middle;  // R_m
  V3<T> e, theta;        // in the axes of R_m
  HalfAngle<T> f;
  T along, j;  // theta.e
  Six<T> d;
  Screw(Quaternion<T> q1, Quaternion<T> q2, const V3<T>& lambda) : middle(q1) {
    using std::sqrt;
    Quaternion<T> p = q1.conjugate() * q2;
    if (value(p.w) < 0) {  // the same rotation, by less than pi
      p = {-p.w, -p.v};
      q2 = {-q2.w, -q2.v};
    }
    const T w = q1.w + q2.w;
    const V3<T> v = q1.v + q2.v;
    const T inverse = T(1.0) / sqrt(w * w + v.dot(v));
    middle = {inverse * w, inverse * v};
    set(p, lambda);
  }

  /// Forces on e and theta' of a stress on d.
  Six<T> pulled(const Six<T>& s) const {
    const T on = theta.dot(s.u);
    const V3<T> M = s.r + (2.0 * (f.g1 * e.dot(s.u) + f.h1 * along * on)) * theta +
                    f.h * (on * e + along * s.u);
    return {f.g * s.u + (f.h * on) * theta, M};
  }
  /// d' of e' and theta'.
  Six<T> pushed(const V3<T>& de, const V3<T>& dtheta) const {
    const T x = 2.0 * theta.dot(dtheta);
    const V3<T> du = f.g * de + (f.h * theta.dot(de)) * theta + (f.g1 * x) * e +
                     (f.h1 * x * along) * theta + (f.h * dtheta.dot(e)) * theta +
                     (f.h * along) * dtheta;
    return {du, dtheta};
  }
  /// G x of the header.
  V3<T> G(const V3<T>& x) const { return f.g * x + (f.h * theta.dot(x)) * theta; }

 private:
  void set(const Quaternion<T>& p, const V3<T>& lambda) {
    using std::atan2;
    using std::sqrt;
    const T square = p.v.dot(p.v);
    // |theta|/2 = arcsin |v|, by its series in |v|^2 where that is small
    T ratio;
    if (value(square) < 0.01) {
      static constexpr double c[] = {
          1.0,          1.0 / 6,       3.0 / 40,         15.0 / 336,
          105.0 / 3456, 945.0 / 42240, 10395.0 / 599040, 135135.0 / 9676800};
      ratio = c[7];
      for (int k = 6; k >= 0; --k)
        ratio = c[k] + square * ratio;
    } else {
      const T s = sqrt(square);
      ratio = atan2(s, p.w) / s;
    }
    theta = (2.0 * ratio) * p.v;
    f = half_angle(theta.dot(theta), square, p.w);
    e = middle.turn_back(lambda);
    along = theta.dot(e);
    j = T(1.0) / (4.0 * (f.g * (T(1.0) + p.w)));
    d = {f.g * e + (f.h * along) * theta, theta};
  }
};

/// B sigma and B^T y of the header.
template <class T>
Six<T> inside(const V3<T>& v, const V3<T>& theta, const Six<T>& s) {
  return {theta.cross(s.u), v.cross(s.u) + theta.cross(s.r)};
}
template <class T>
Six<T> outside(const V3<T>& v, const V3<T>& theta, const Six<T>& y) {
  return {y.u.cross(theta) + y.r.cross(v), y.r.cross(theta)};
}

Matrix<6> inside_matrix(const Vec3& v, const Vec3& theta) {
  Matrix<6> B = Matrix<6>::Zero();
  B.topLeftCorner<3, 3>() = B.bottomRightCorner<3, 3>() = skew(theta);
  B.bottomLeftCorner<3, 3>() = skew(v);
  return B;
}

Matrix<6> flexibility(const SectionBeamConstants& c, const Vec3& v, const Vec3& theta) {
  const Matrix<6> B = inside_matrix(v, theta);
  return c.length * c.S + (c.length / 12.0) * (B.transpose() * c.S * B);
}

/// How often the solution for numbers with derivatives is improved: once for each order.
template <class T>
inline constexpr int orders = 0;
template <int N>
inline constexpr int orders<Dual<N>> = 1;
template <int N>
inline constexpr int orders<DualRate<N>> = 2;

/// Stress and its energy at a screw; power on d'.
template <class T>
struct Elastic {
  Six<T> q, sigma, on_d;
  Elastic(const SectionBeam& b, const Six<T>& d) {
    const SectionBeamConstants& c = b.c;
    const Six<T> moved = d - Six<T>(b.d0) + Six<T>(b.pre);
    const V3<T> a = times3(b.P, moved);
    const double bow = 1.0 / (240.0 * c.length);
    const V3<T> e1(1.0, 0.0, 0.0);
    q = moved;
    q.u = q.u + T(bow) * (a.dot(a) * e1 - a.x * a);
    const V3<T> v =
        d.u - V3<T>(Vec3(b.d0.head<3>())) + V3<T>(c.length, 0.0, 0.0) + T(1.0 / 12.0) * e1.cross(a);
    solve(c, v, d.r);

    const Six<T> y = times(c.S, inside(v, d.r, sigma));
    const V3<T>&F = sigma.u, &M = sigma.r;
    const double part = -c.length / 12.0;
    const V3<T> on_v = T(part) * F.cross(y.r);
    const V3<T> on_a =
        T(bow) * (2.0 * (F.x * a) - a.x * F - F.dot(a) * e1) + T(1.0 / 12.0) * on_v.cross(e1);
    on_d = sigma + Six<T>(on_v, T(part) * (F.cross(y.u) + M.cross(y.r)));
    const auto column = [&](int k) {
      return b.P(0, k) * on_a.x + b.P(1, k) * on_a.y + b.P(2, k) * on_a.z;
    };
    on_d = on_d +
           Six<T>(V3<T>(column(0), column(1), column(2)), V3<T>(column(3), column(4), column(5)));
  }
  T energy() const { return 0.5 * q.dot(sigma); }

 private:
  void solve(const SectionBeamConstants& c, const V3<T>& v, const V3<T>& theta) {
    const Vector<6> at = Six<T>(v, theta).values();
    const Eigen::LLT<Matrix<6>> factor(flexibility(c, at.head<3>(), at.tail<3>()));
    const Matrix<6> inverse = factor.solve(Matrix<6>::Identity());
    sigma = Six<T>(Vector<6>(factor.solve(q.values())));
    for (int k = 0; k < orders<T>; ++k) {
      const Six<T> y = times(c.S, inside(v, theta, sigma));
      const Six<T> rest =
          q - c.length * times(c.S, sigma) - (c.length / 12.0) * outside(v, theta, y);
      sigma = sigma + times(inverse, rest);
    }
  }
};

/// A configuration and its motion.
template <class T>
struct Moving {
  const NodeT<T>* node[2];
  const SectionMotion<T>* motion[2];
  V3<T> ro[2];
  Screw<T> screw;
  Moving(const SectionBeam& b, const NodeT<T>& n1, const NodeT<T>& n2, const SectionMotion<T>& m1,
         const SectionMotion<T>& m2)
      : node{&n1, &n2},
        motion{&m1, &m2},
        ro{m1.turn(b.arm1), m2.turn(b.arm2)},
        screw(triad_rotation(n1, m1, b.body1), triad_rotation(n2, m2, b.body2),
              V3<T>(b.chord) + n2.u - n1.u + (ro[1] - V3<T>(b.offset2)) -
                  (ro[0] - V3<T>(b.offset1))) {}

  /// d'.
  Six<T> rate() const {
    const V3<T> o1 = screw.middle.turn_back(motion[0]->omega),
                o2 = screw.middle.turn_back(motion[1]->omega);
    const V3<T> rdot =
        node[1]->du + motion[1]->omega.cross(ro[1]) - node[0]->du - motion[0]->omega.cross(ro[0]);
    const V3<T> turning = o2 - o1;
    const V3<T> mean = T(0.5) * (o1 + o2) - screw.j * screw.theta.cross(turning);
    const V3<T> de = screw.middle.turn_back(rdot) - mean.cross(screw.e);
    return screw.pushed(de, screw.G(turning));
  }
};

/// From a stress on d' to forces on the end points and moments on the triads.
template <class T>
ForceOut<T> force_of_stress(const Screw<T>& x, const Six<T>& on_d) {
  const Six<T> on = x.pulled(on_d);
  const V3<T> lever = x.e.cross(on.u), apart = x.G(on.r) + x.j * lever.cross(x.theta);
  ForceOut<T> out;
  out.f[1] = x.middle.turn(on.u);
  out.f[0] = -out.f[1];
  out.m[1] = x.middle.turn(apart - T(0.5) * lever);
  out.m[0] = x.middle.turn(-apart - T(0.5) * lever);
  return out;
}

template <class T>
void add_inertia(const SectionBeam& b, const Moving<T>& x, ForceOut<T>& out) {
  const SectionBeamConstants& c = b.c;
  V3<T> X[8], acc[8];
  for (int i = 0; i < 2; ++i) {
    const SectionMotion<T>& m = *x.motion[i];
    const Mat3& body = i == 0 ? b.body1 : b.body2;
    X[4 * i] = x.ro[i];
    for (int k = 0; k < 3; ++k)
      X[4 * i + 1 + k] = m.turn(body.col(k));
    for (int k = 0; k < 4; ++k) {
      const V3<T>& arm = X[4 * i + k];
      V3<T>& a = acc[4 * i + k];
      a = m.accel(arm);
      if (c.alpha > 0.0) a = a + T(c.alpha) * m.omega.cross(arm);
    }
    acc[4 * i] = acc[4 * i] + x.node[i]->ddu;
    if (c.alpha > 0.0) acc[4 * i] = acc[4 * i] + T(c.alpha) * x.node[i]->du;
  }
  for (int k = 0; k < 8; ++k) {
    V3<T> g = T(c.M8(k, 0)) * acc[0];
    for (int j = 1; j < 8; ++j)
      g = g + T(c.M8(k, j)) * acc[j];
    if (k % 4 == 0)
      out.f[k / 4] = out.f[k / 4] + g;
    else
      out.m[k / 4] = out.m[k / 4] + X[k].cross(g);
  }
}

enum class Parts { all, inertia_and_damping };

template <class T>
ForceOut<T> beam_force(const SectionBeam& b, const NodeT<T>& n1, const NodeT<T>& n2,
                       const SectionMotion<T>& m1, const SectionMotion<T>& m2,
                       Parts parts = Parts::all) {
  const Moving<T> x(b, n1, n2, m1, m2);
  const bool damped = !b.c.damping.isZero(0);
  Six<T> on_d;
  if (parts == Parts::all) on_d = Elastic<T>(b, x.screw.d).on_d;
  T dissipated{};
  if (damped) {
    const Six<T> rate = x.rate(), stress = times(b.c.damping, rate);
    on_d = on_d + stress;
    dissipated = rate.dot(stress);
  }
  ForceOut<T> out;
  if (parts == Parts::all || damped) out = force_of_stress(x.screw, on_d);
  out.dissipated = dissipated;
  add_inertia(b, x, out);
  for (int i = 0; i < 2; ++i)
    out.m[i] = out.m[i] + x.ro[i].cross(out.f[i]);
  return out;
}

using D14 = Dual<14>;

template <class Seed>
Matrix<14> differentiate(const SectionBeam& b, const Nodes<2>& x, Parts parts, Seed&& seed) {
  NodeT<D14> n[2] = {NodeT<D14>(*x[0]), NodeT<D14>(*x[1])};
  for (int i = 0; i < 2; ++i)
    seed(n[i], *x[static_cast<std::size_t>(i)], 7 * i);
  const SectionMotion<D14> m1(n[0]), m2(n[1]);
  const auto f = to_X(beam_force(b, n[0], n[1], m1, m2, parts), m1, m2);
  Matrix<14> J;
  for (int k = 0; k < 14; ++k)
    J.row(k) = f[static_cast<std::size_t>(k)].g.transpose();
  return J;
}

Vector<6> screw_between(const Mat3& t1, const Mat3& t2, const Vec3& chord) {
  const Screw<double> s(Quaternion<double>{t1}, Quaternion<double>{t2}, V3<double>(chord));
  return s.d.values();
}

/// Phi/(1 + Phi) of the plane with the larger rotary inertia; S: compliance.
double shear_share_of(const Matrix<6>& S, const Mat3& J, double l) {
  const bool about_y = J(1, 1) > J(2, 2);
  const Index shear = about_y ? 2 : 1, bend = about_y ? 4 : 5;
  const double Phi = 12.0 * S(shear, shear) / (S(bend, bend) * l * l);
  return Phi / (1.0 + Phi);
}

}  // namespace

SectionBeamConstants make_section_constants(const FullSection& section, double l, double twist,
                                            MassKind kind, const TriadShare& share) {
  SectionBeamConstants c;
  c.length = l;
  c.S = section.stiffness.llt().solve(Matrix<6>::Identity());
  c.S = Matrix<6>(0.5 * (c.S + c.S.transpose()));
  const SectionMoments mass(section.mass);
  const Matrix<6>& S = c.S;
  const Vec2 shear_centre(-S(2, 3) / S(3, 3), S(1, 3) / S(3, 3));
  MassShare mass_share;
  mass_share.bending = Vector<4>(1, share.tilt[0], 1, share.tilt[1]);
  const auto plane = [&](int shear, int bend, double rhoI, MassKind with) {
    const double softness = S(shear, shear) - S(shear, 3) * S(shear, 3) / S(3, 3);
    ElementSection e;
    e.constants = true;
    e.given = {1.0 / S(0, 0), 1.0 / softness, 1.0 / S(3, 3), 1.0 / S(bend, bend), mass.m, rhoI, 0};
    return make_shaft_constants(e, l, 0, 0, with, mass_share).M4;
  };
  const auto mean = [&](double rhoI, MassKind with) {
    return Matrix<4>(0.5 * (plane(1, 5, rhoI, with) + plane(2, 4, rhoI, with)));
  };
  const TriadInertia triads(l * mass.J, shear_share_of(c.S, mass.J, l), kind, share);
  const double rhoI = triads.contained / l;
  const Matrix<4> whole = mean(rhoI, MassKind::consistent);
  const Matrix<4> shapes = mean(0.0, MassKind::consistent), rotation = whole - shapes;
  const Matrix<4> correction = mean(rhoI, kind) - whole;

  // mass centres and the tangents of their line; shear centres of an untwisted section, whose line
  // has the directors for its tangents whatever the twist, and directors
  const Vec2 off = mass.centre.tail<2>() - shear_centre;
  Matrix<4, 8> centres = Matrix<4, 8>::Zero(), line = Matrix<4, 8>::Zero();
  for (int i = 0; i < 2; ++i) {
    line(2 * i, 4 * i) = line(2 * i + 1, 4 * i + 1) = 1;
    line.block<1, 2>(2 * i, 4 * i + 2) =
        (Eigen::Rotation2Dd((i == 0 ? 0.5 : -0.5) * twist) * shear_centre).transpose();
    centres(2 * i, 4 * i) = centres(2 * i + 1, 4 * i + 1) = 1;
    centres.block<1, 3>(2 * i, 4 * i + 1) += mass.centre.transpose();
    for (int k = 0; k < 2; ++k) {
      centres(2 * i + 1, 6 + k) += off[k] / l;
      centres(2 * i + 1, 2 + k) -= off[k] / l;
    }
    centres(2 * i + 1, 4 * i + 2) -= twist / l * shear_centre[1];
    centres(2 * i + 1, 4 * i + 3) += twist / l * shear_centre[0];
  }
  c.M8 = centres.transpose() * shapes * centres + line.transpose() * rotation * line;
  const Matrix<8> on_centres = centres.transpose() * correction * centres;
  c.M8 += admitted_correction(c.M8, on_centres) * on_centres;
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
          c.M8(4 * i + 1 + static_cast<int>(a), 4 * k + 1 + static_cast<int>(b)) +=
              triads.on[a][b](i, k);
  return c;
}

SectionBeam::SectionBeam(const SectionBeamConstants& constants, const Vec3& chord_, const Mat3& t1,
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
      arm2(chart2.transpose() * o2) {
  d0 = screw_between(triad1, triad2, chord);
  set_reference();
}

void SectionBeam::set_reference() {
  const Vec3 v = c.length * Vec3::UnitX(), theta = d0.tail<3>();
  H0 = flexibility(c, v, theta);
  const Matrix<6> K = H0.llt().solve(Matrix<6>::Identity());
  P = c.length * c.length * (c.S * inside_matrix(v, theta) * K).bottomRows<3>();
}

void SectionBeam::set_unstressed(const Mat3& t1, const Mat3& t2) {
  d0 = screw_between(t1, t2, chord);
  set_reference();
}

void SectionBeam::set_prestress(double force, double free_strain) {
  pre = force * H0.col(0);
  pre[0] -= c.length * free_strain;
  V0 = 0;
  V0 = Elastic<double>(*this, Six<double>(screw_between(triad1, triad2, chord))).energy();
}

void SectionBeam::set_damping(double beta, double beta_twist) {
  c.damping = beta * H0.llt().solve(Matrix<6>::Identity());
  c.damping(3, 3) += beta_twist / (c.length * c.S(3, 3));
}

bool SectionBeam::axisymmetric() const {
  constexpr double share = 1e-12;
  const auto along_axis = [](const Vec3& v) { return v.tail<2>().norm() <= 1e-10 * v.norm(); };
  if (!is_axisymmetric(c.S, share) || !is_axisymmetric(c.damping, share)) return false;
  // inertia of the lateral directors: the same of both, and nothing between them or with the others
  Vector<8> size = c.M8.diagonal().cwiseAbs();
  for (const Index i : {2, 6})
    size.segment<2>(i).setConstant(size.segment<2>(i).maxCoeff());
  for (Index i = 0; i < 8; ++i)
    for (Index k = 0; k < 8; ++k) {
      const bool lateral_i = i % 4 >= 2, lateral_k = k % 4 >= 2;
      double rest = lateral_i || lateral_k ? c.M8(i, k) : 0.0;
      if (i % 4 == 3 && k % 4 == 3) rest -= c.M8(i - 1, k - 1);
      if (i % 4 == 2 && k % 4 == 2) rest = 0.0;
      if (std::abs(rest) > share * std::sqrt(size[i] * size[k])) return false;
    }
  return along_axis(body1.col(0)) && along_axis(body2.col(0)) && along_axis(arm1) &&
         along_axis(arm2) && along_axis(d0.head<3>()) &&
         d0.tail<2>().norm() <= 1e-10 * (1 + std::abs(d0[3]));
}

void SectionBeam::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const auto r = to_X(beam_force(*this, n1, n2, m1, m2), m1, m2);
  f += Eigen::Map<const Vector<14>>(r.data());
}

void SectionBeam::add_tangent(const Nodes<2>& x, const Context&, TangentX<14>& out) const {
  out.K += differentiate(*this, x, Parts::all, VaryPlace());
  const Parts rest = Parts::inertia_and_damping;
  out.C += differentiate(*this, x, rest, VaryRate());
  out.M += differentiate(*this, x, rest, VaryAcceleration());
}

void SectionBeam::add_stiffness_rate(const Nodes<2>& x, const Nodes<2>& rate, const Context&,
                                     system::StiffnessRateX<14>& out) const {
  differentiate_in_motion(*this, x, rate, out);
}

void SectionBeam::add_energy(const Nodes<2>& x, const Context& ctx, Energy& en) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const Moving<double> now(*this, n1, n2, m1, m2);
  en.elastic += Elastic<double>(*this, now.screw.d).energy() - V0;
  const auto vec = [](const V3<double>& v) { return Vec3(v.x, v.y, v.z); };
  Vec3 v[8], moved[8];  // relative to the reference, so that a change of chart leaves it alone
  for (int i = 0; i < 2; ++i) {
    const SectionMotion<double>& m = i == 0 ? m1 : m2;
    const Mat3 &body = i == 0 ? body1 : body2, &triad = i == 0 ? triad1 : triad2;
    const NodeState& n = *x[static_cast<std::size_t>(i)];
    const Vec3 omega = vec(m.omega), arm = vec(now.ro[i]);
    v[4 * i] = n.du + omega.cross(arm);
    moved[4 * i] = n.u + arm - (i == 0 ? offset1 : offset2);
    for (int k = 0; k < 3; ++k) {
      const Vec3 b = vec(m.turn(body.col(k)));
      v[4 * i + 1 + k] = omega.cross(b);
      moved[4 * i + 1 + k] = b - triad.col(k);
    }
  }
  double kinetic = 0;
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 8; ++j)
      kinetic += 0.5 * c.M8(k, j) * v[k].dot(v[j]);
  en.kinetic += kinetic;
  for (int j = 0; j < 8; ++j)
    en.gravity -= (c.M8(0, j) + c.M8(4, j)) * ctx.gravity.dot(moved[j]);
  if (!c.damping.isZero(0)) en.dissipated += beam_force(*this, n1, n2, m1, m2).dissipated;
  if (c.alpha > 0.0) en.dissipated += 2.0 * c.alpha * kinetic;
}

namespace {
[[maybe_unused]] const bool known = system::know_stiffness_rate<SectionBeam>();
}  // namespace

}  // namespace whirl::elements
