#include <elements/shaft/crack.hpp>

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

#include <elements/shaft/end_bending.inl>

/// One plane: h = c f/(1 + c f g), what the stiffness loses per M^2, and its derivatives in f.
struct Loss {
  double h, h1, h2;
  Loss(double c, double g, double f) {
    const double give = 1.0 / (1.0 + c * f * g);
    h = c * f * give;
    h1 = c * give * give;
    h2 = -2.0 * c * g * h1 * give;
  }
};

/// W of the law that follows the moment, its slope and curvature.
struct Potential {
  double W;
  Vec2 slope;
  Mat2 curvature;
  double f;
  Potential(double c_xi, double c_eta, double small, const Vec2& m) {
    const double b2 = 2.0 * c_eta / c_xi;
    const double rho = std::sqrt(m[0] * m[0] + b2 * m[1] * m[1] + small * small);
    const Vec2 of_rho(m[0] / rho, b2 * m[1] / rho);
    const double s = 0.5 * (m[0] + rho);
    const Vec2 of_s = 0.5 * (Vec2(1, 0) + of_rho);
    f = of_s[0];
    W = 0.5 * c_xi * s * s;
    slope = c_xi * s * of_s;
    Mat2 bend;  // of s
    bend << 1.0 - of_rho[0] * of_rho[0], -of_rho[0] * of_rho[1], -of_rho[0] * of_rho[1],
        b2 - of_rho[1] * of_rho[1];
    curvature = c_xi * (of_s * of_s.transpose() + (0.5 * s / rho) * bend);
  }
};

}  // namespace

CrackLaw::Answer CrackLaw::at(double M_xi, double M_eta, double cosine) const {
  if (breathing == Breathing::weight) return follow_weight(M_xi, M_eta, cosine);
  if (breathing == Breathing::response && c_eta > 0.0) return follow_moment(M_xi, M_eta);
  Answer out;
  const bool open = breathing == Breathing::open || M_xi > 0.0;
  out.f = open ? 1.0 : 0.0;
  const double xi = Loss(c_xi, g, out.f).h;
  const double eta = breathing == Breathing::open ? Loss(c_eta, g, 1.0).h : 0.0;
  out.V = -0.5 * (xi * M_xi * M_xi + eta * M_eta * M_eta);
  out.slope = Vec3(-xi * M_xi, -eta * M_eta, 0.0);
  out.curvature.diagonal() = Vec3(-xi, -eta, 0.0);
  return out;
}

double CrackLaw::mean_compliance() const {
  switch (breathing) {
    case Breathing::open: return 0.5 * (c_xi + c_eta);
    case Breathing::hinge: return 0.25 * c_xi;
    case Breathing::weight:
    case Breathing::response: break;
  }
  return 0.25 * (c_xi + c_eta);
}

CrackLaw::Answer CrackLaw::mean(double M_xi, double M_eta) const {
  const double h = Loss(mean_compliance(), g, 1.0).h;
  Answer out;
  out.V = -0.5 * h * (M_xi * M_xi + M_eta * M_eta);
  out.slope = Vec3(-h * M_xi, -h * M_eta, 0.0);
  out.curvature.diagonal() = Vec3(-h, -h, 0.0);
  out.f = breathing == Breathing::open ? 1.0 : 0.5;
  return out;
}

CrackLaw::Answer CrackLaw::follow_weight(double M_xi, double M_eta, double cosine) const {
  Answer out;
  out.f = 0.5 * (1.0 + cosine);
  const Loss x(c_xi, g, out.f), e(c_eta, g, out.f);
  out.V = -0.5 * (x.h * M_xi * M_xi + e.h * M_eta * M_eta);
  // df/dcosine = 1/2
  out.slope = Vec3(-x.h * M_xi, -e.h * M_eta, -0.25 * (x.h1 * M_xi * M_xi + e.h1 * M_eta * M_eta));
  out.curvature.diagonal() = Vec3(-x.h, -e.h, -0.125 * (x.h2 * M_xi * M_xi + e.h2 * M_eta * M_eta));
  out.curvature(0, 2) = out.curvature(2, 0) = -0.5 * x.h1 * M_xi;
  out.curvature(1, 2) = out.curvature(2, 1) = -0.5 * e.h1 * M_eta;
  return out;
}

CrackLaw::Answer CrackLaw::follow_moment(double M_xi, double M_eta) const {
  // m + g W'(m) = M: the gradient of a convex function, and nearly linear along every ray
  const Vec2 M(M_xi, M_eta);
  Vec2 m(M_xi > 0.0 ? M_xi / (1.0 + c_xi * g) : M_xi, M_eta / (1.0 + 0.5 * c_eta * g));
  const double size = M.norm() + small;
  for (int round = 0; g > 0.0 && round < 60; ++round) {
    const Potential p(c_xi, c_eta, small, m);
    const Vec2 defect = m + g * p.slope - M;
    const Mat2 slope = Mat2::Identity() + g * p.curvature;
    const Vec2 step = -slope.inverse() * defect;
    // the merit is |m|^2/2 + g W - m.M, whose gradient is the defect
    const double before = 0.5 * m.squaredNorm() + g * p.W - m.dot(M);
    double part = 1.0;
    // near the answer whole steps converge, where the merit no longer tells them apart
    for (; step.norm() > 1e-4 * size && part > 1e-6; part *= 0.5) {
      const Vec2 next = m + part * step;
      const Potential q(c_xi, c_eta, small, next);
      const double after = 0.5 * next.squaredNorm() + g * q.W - next.dot(M);
      if (after <= before + 1e-4 * part * defect.dot(step) + 1e-15 * size * size) break;
    }
    m += part * step;
    if (step.norm() <= 1e-15 * size) break;
  }
  if (g == 0.0) m = M;
  const Potential p(c_xi, c_eta, small, m);
  Answer out;
  out.f = p.f;
  out.V = -p.W - 0.5 * g * p.slope.squaredNorm();
  out.slope.head<2>() = -p.slope;
  const Mat2 give = Mat2::Identity() + g * p.curvature;
  const Mat2 bend = -p.curvature * give.inverse();
  out.curvature.topLeftCorner<2, 2>() = 0.5 * (bend + bend.transpose());
  return out;
}

namespace {

double grown(const Crack& k, const Context& c) { return c.averaged ? k.bow.end : k.bow.at(c.time); }

/// What the law sees of the element.
template <class T>
struct Opening {
  EndBending<T> bending;
  T M_xi, M_eta, cosine;
  Opening(const Crack& k, const NodeT<T>& n1, const NodeT<T>& n2, const SectionMotion<T>& m1,
          const SectionMotion<T>& m2, double amount)
      : bending(k.at, n1, n2, m1, m2) {
    const auto& P = bending.P;
    const Vec2 rest = amount * (k.r[0] * k.rest1 + k.r[1] * k.rest2);
    M_xi = T(rest[0]) - k.r[0] * P[0].y - k.r[1] * P[1].y;
    M_eta = T(rest[1]) - k.r[0] * P[0].z - k.r[1] * P[1].z;
    const V3<T> toward(k.toward);
    cosine = (1.0 - k.place) * bending.B[0].dot(toward) + k.place * bending.B[1].dot(toward);
  }
};

CrackLaw::Answer answer(const Crack& k, const Context& c, double M_xi, double M_eta,
                        double cosine) {
  if (!c.kinks.empty() && k.law.g > 0.0) {
    CrackLaw::Answer given;
    given.slope.head<2>() = -c.kinks[k.number];
    return given;
  }
  return c.whole_turn ? k.law.mean(M_xi, M_eta) : k.law.at(M_xi, M_eta, cosine);
}

/// dV/d(M_xi, M_eta, cosine).
double slope_along(const CrackLaw::Answer& a, const Opening<double>&, int i) { return a.slope[i]; }
template <int N>
Dual<N> slope_along(const CrackLaw::Answer& a, const Opening<Dual<N>>& o, int i) {
  Dual<N> r(a.slope[i]);
  r.g =
      a.curvature(i, 0) * o.M_xi.g + a.curvature(i, 1) * o.M_eta.g + a.curvature(i, 2) * o.cosine.g;
  return r;
}

template <class T>
ForceOut<T> bending_force(const Crack& k, const NodeT<T>& n1, const NodeT<T>& n2,
                          const SectionMotion<T>& m1, const SectionMotion<T>& m2,
                          const Context& c) {
  const Opening<T> o(k, n1, n2, m1, m2, grown(k, c));
  const CrackLaw::Answer a = answer(k, c, value(o.M_xi), value(o.M_eta), value(o.cosine));
  const T on_xi = slope_along(a, o, 0), on_eta = slope_along(a, o, 1);
  const T on_y[2] = {-k.r[0] * on_xi, -k.r[1] * on_xi};
  const T on_z[2] = {-k.r[0] * on_eta, -k.r[1] * on_eta};
  ForceOut<T> out = o.bending.forces(on_y, on_z);
  if (k.law.breathing != Breathing::weight) return out;
  // the cosine turns with the normals: omega x B . n = omega . (B x n)
  const T on_cosine = slope_along(a, o, 2);
  const V3<T> toward(k.toward);
  const double share[2] = {1.0 - k.place, k.place};
  for (int i = 0; i < 2; ++i)
    out.m[i] = out.m[i] + (share[i] * on_cosine) * o.bending.B[i].cross(toward);
  return out;
}

}  // namespace

void Crack::add_force(const Nodes<2>& x, const Context& c, ForceX<14>& f) const {
  const auto force = place_force(*this, x, c);
  f += Eigen::Map<const Vector<14>>(force.data());
}

void Crack::add_tangent(const Nodes<2>& x, const Context& c, TangentX<14>& t) const {
  t.K += differentiate_place(*this, x, c);
}

void Crack::add_energy(const Nodes<2>& x, const Context& c, Energy& e) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const Opening<double> o(*this, n1, n2, m1, m2, grown(*this, c));
  const CrackLaw::Answer a = answer(*this, c, o.M_xi, o.M_eta, o.cosine);
  e.elastic += a.V;
  if (c.averaged || !bow.varies()) return;
  const Vec2 rest = bow.rate(c.time) * (r[0] * rest1 + r[1] * rest2);
  e.supplied += a.slope[0] * rest[0] + a.slope[1] * rest[1];
}

Vec2 Crack::moment(const Nodes<2>& x, const Context& c) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const Opening<double> o(*this, n1, n2, m1, m2, grown(*this, c));
  return {o.M_xi, o.M_eta};
}

Crack::KinkLaw Crack::kink_law(const Nodes<2>& x, const Context& c) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const Opening<double> o(*this, n1, n2, m1, m2, grown(*this, c));
  KinkLaw out{law, o.cosine};
  out.alone.g = 0.0;
  return out;
}

std::pair<Vec2, Mat2> Crack::KinkLaw::operator()(const Vec2& m) const {
  const CrackLaw::Answer a = alone.at(m[0], m[1], cosine);
  return {-a.slope.head<2>(), -a.curvature.topLeftCorner<2, 2>()};
}

double Crack::opening(const Nodes<2>& x, const Context& c) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const Opening<double> o(*this, n1, n2, m1, m2, grown(*this, c));
  return law.at(o.M_xi, o.M_eta, o.cosine).f;
}

}  // namespace whirl::elements
