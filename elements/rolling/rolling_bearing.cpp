#include <elements/rolling/rolling_bearing.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <elements/rolling/hertz.hpp>
#include <elements/rolling/roller_lanes.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::elements {

ContactLoad ContactLoads::at(std::size_t j) const {
  ContactLoad l;
  l.V = V[j];
  l.g << gx[j], gr[j], gt[j];
  l.H << Hxx[j], Hxr[j], Hxt[j], Hxr[j], Hrr[j], Hrt[j], Hxt[j], Hrt[j], Htt[j];
  return l;
}

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::TangentX;

bool BallContact::evaluate(double x, double rho, double t, Local& l) const {
  const double sa = a0 + x - R * t, sr = r0 + rho, A = std::sqrt(sa * sa + sr * sr), delta = A - A0;
  if (delta <= 0.0) return false;
  const double root = std::sqrt(delta), Q = K * delta * root, dQ = 1.5 * K * root;
  const Vec2 n(sa / A, sr / A);
  // gradient of (s_a, s_r) in (x, rho, t): (1, 0, -R), (0, 1, 0)
  l.V = 0.4 * Q * delta;
  l.g << Q * n.x(), Q * n.y(), -R * Q * n.x();
  const double c = Q / A, haa = dQ * n.x() * n.x() + c * n.y() * n.y(),
               har = (dQ - c) * n.x() * n.y(), hrr = dQ * n.y() * n.y() + c * n.x() * n.x();
  l.H << haa, har, -R * haa, har, hrr, -R * har, -R * haa, -R * har, R * R * haa;
  return true;
}

double BallContact::load(double x, double rho, double t) const {
  const double sa = a0 + x - R * t, sr = r0 + rho, delta = std::sqrt(sa * sa + sr * sr) - A0;
  return delta > 0.0 ? K * delta * std::sqrt(delta) : 0.0;
}

double BallContact::gap_at(int, double x, double rho, double t) const {
  return std::hypot(a0 + x - R * t, r0 + rho) - A0;
}

double RollerContact::gap_at(int part, double, double rho, double t) const {
  return rho + place(part) * t - clearance;
}

bool RollerContact::evaluate_part(int part, double, double rho, double t, Local& l) const {
  const double s = place(part), delta = rho + s * t - clearance;
  if (delta <= 0.0) return false;
  const double dQ = 10.0 / 9.0 * K / slices * std::pow(delta, 1.0 / 9.0), Q = 0.9 * dQ * delta;
  l.V = 9.0 / 19.0 * Q * delta;
  l.g << 0.0, Q, s * Q;
  l.H << 0.0, 0.0, 0.0, 0.0, dQ, s * dQ, 0.0, s * dQ, s * s * dQ;
  return true;
}

void BallContact::evaluate(double x, const double* rho, const double* t, ContactLoads& out) const {
  out = {};
  for (std::size_t j = 0; j < ContactLoads::together; ++j) {
    Local l;
    if (!(rho[j] > -infinity) || !evaluate(x, rho[j], t[j], l)) continue;
    out.V[j] = l.V;
    out.gx[j] = l.g.x();
    out.gr[j] = l.g.y();
    out.gt[j] = l.g.z();
    out.Hxx[j] = l.H(0, 0);
    out.Hxr[j] = l.H(0, 1);
    out.Hxt[j] = l.H(0, 2);
    out.Hrr[j] = l.H(1, 1);
    out.Hrt[j] = l.H(1, 2);
    out.Htt[j] = l.H(2, 2);
  }
}

void RollerContact::evaluate(double, const double* rho, const double* t, ContactLoads& out) const {
  static_assert(ContactLoads::together == roller_lanes::together);
  roller_lanes::Loads l;
  roller_lanes::kernels().evaluate({10.0 / 9.0 * (K / slices), clearance, length, slices}, rho, t,
                                   l);
  out = {};
  std::copy_n(l.energy, ContactLoads::together, out.V.begin());
  std::copy_n(l.force, ContactLoads::together, out.gr.begin());
  std::copy_n(l.moment, ContactLoads::together, out.gt.begin());
  std::copy_n(l.slope[0], ContactLoads::together, out.Hrr.begin());
  std::copy_n(l.slope[1], ContactLoads::together, out.Hrt.begin());
  std::copy_n(l.slope[2], ContactLoads::together, out.Htt.begin());
}

double RollerContact::load(double, double rho, double t) const {
  std::array<double, ContactLoads::together> at, tilt{};
  at.fill(-infinity);
  at[0] = rho;
  tilt[0] = t;
  ContactLoads l;
  evaluate(0, at.data(), tilt.data(), l);
  return l.gr[0];
}

template <class Contact>
Vector<6> RollingBearing<Contact>::deflection(const Nodes<2>& x) const {
  Vector<6> q;
  q.head<3>() = x[0]->u - x[1]->u;
  q.segment<2>(3) = (x[0]->d() - x[1]->d()).template tail<2>();
  const double turns = cage[0] * x[0]->turns + cage[1] * x[1]->turns;
  q[5] = cage[0] * x[0]->phi + cage[1] * x[1]->phi + two_pi * (turns - std::floor(turns));
  return q;
}

namespace {

/// Abscissae and weights on [-1, 1] by the substitution x = tanh(pi/2 sinh t) (Takahasi & Mori,
/// Publ. RIMS 9 (1974), doi 10.2977/prims/1195192451): exact to rounding whatever power of the
/// distance from its ends a function begins with.
struct EndRule {
  static constexpr int half = 16;
  static constexpr double step = 0.2;
  std::array<double, 2 * half + 1> place{}, weight{};
  EndRule() {
    for (int k = -half; k <= half; ++k) {
      const double u = 0.5 * pi * std::sinh(step * k), c = std::cosh(u);
      const int at = k + half;
      place[static_cast<std::size_t>(at)] = std::tanh(u);
      weight[static_cast<std::size_t>(at)] = step * 0.5 * pi * std::cosh(step * k) / (c * c);
    }
  }
};

const EndRule& end_rule() {
  static const EndRule rule;
  return rule;
}

/// Where f passes zero between a and b, at whose ends it has different signs (Illinois).
template <class F>
double zero_between(const F& f, double a, double fa, double b, double fb) {
  constexpr int most = 60;
  constexpr double close = 1e-15;
  double x = b;
  for (int k = 0; k < most && std::abs(b - a) > close; ++k) {
    x = b - fb * (b - a) / (fb - fa);
    const double fx = f(x);
    if (fx == 0.0) break;
    if ((fx > 0) != (fb > 0)) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = x;
    fb = fx;
  }
  return x;
}

}  // namespace

template <class Contact>
void RollingBearing<Contact>::add_element(const Vector<6>& q, double c, double s, double weight,
                                          const typename Contact::Local& l, bool with_hessian,
                                          RollingPotential& p) {
  const double rho = q[1] * c + q[2] * s, t = q[3] * c + q[4] * s;
  const double rho_psi = q[2] * c - q[1] * s, t_psi = q[4] * c - q[3] * s;
  p.V += weight * l.V;
  Vector<6> g;
  g << l.g.x(), l.g.y() * c, l.g.y() * s, l.g.z() * c, l.g.z() * s,
      l.g.y() * rho_psi + l.g.z() * t_psi;
  p.g += weight * g;
  if (!with_hessian) return;
  Matrix<3, 6> J;
  J << 1, 0, 0, 0, 0, 0, 0, c, s, 0, 0, rho_psi, 0, 0, 0, c, s, t_psi;
  p.H.noalias() += weight * (J.transpose() * l.H * J);
  const double cross[4] = {-s * l.g.y(), c * l.g.y(), -s * l.g.z(), c * l.g.z()};
  for (int k = 0; k < 4; ++k) {
    p.H(1 + k, 5) += weight * cross[k];
    p.H(5, 1 + k) += weight * cross[k];
  }
  p.H(5, 5) -= weight * (l.g.y() * rho + l.g.z() * t);
}

template <class Contact>
void RollingBearing<Contact>::potential(const Vector<6>& q, RollingPotential& p,
                                        bool with_hessian) const {
  WHIRL_EXPECTS(elements > 0);
  p.V = 0;
  p.g.setZero();
  p.H.setZero();
  constexpr int together = ContactLoads::together;
  std::array<double, together> c, s, rho, t;
  ContactLoads l;
  // One turn of Z steps by the addition theorem: no trigonometry in the loop.
  double cos = std::cos(q[5]), sin = std::sin(q[5]);
  const int n = elements;
  const double c1 = std::cos(two_pi / n), s1 = std::sin(two_pi / n);
  for (int first = 0; first < n; first += together) {
    const std::size_t count = static_cast<std::size_t>(std::min(together, n - first));
    rho.fill(-infinity);
    t.fill(0.0);
    for (std::size_t j = 0; j < count; ++j) {
      c[j] = cos;
      s[j] = sin;
      rho[j] = q[1] * cos + q[2] * sin;
      t[j] = q[3] * cos + q[4] * sin;
      const double next = cos * c1 - sin * s1;
      sin = sin * c1 + cos * s1;
      cos = next;
    }
    contact.evaluate(q[0], rho.data(), t.data(), l);
    for (std::size_t j = 0; j < count; ++j)
      if (l.V[j] > 0.0) add_element(q, c[j], s[j], 1.0, l.at(j), with_hessian, p);
  }
}

template <class Contact>
void RollingBearing<Contact>::add_arc(const Vector<6>& q, int part, double from, double to,
                                      bool with_hessian, RollingPotential& p) const {
  const EndRule& rule = end_rule();
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  typename Contact::Local l;
  for (std::size_t k = 0; k < rule.place.size(); ++k) {
    const double a = middle + half * rule.place[k], c = std::cos(a), s = std::sin(a);
    if (contact.evaluate_part(part, q[0], q[1] * c + q[2] * s, q[3] * c + q[4] * s, l))
      add_element(q, c, s, elements / two_pi * half * rule.weight[k], l, with_hessian, p);
  }
}

template <class Contact>
void RollingBearing<Contact>::add_ring(const Vector<6>& q, int part, double from, bool with_hessian,
                                       RollingPotential& p) const {
  typename Contact::Local l;
  for (int k = 0; k < smeared; ++k) {
    const double a = from + two_pi * k / smeared, c = std::cos(a), s = std::sin(a);
    if (contact.evaluate_part(part, q[0], q[1] * c + q[2] * s, q[3] * c + q[4] * s, l))
      add_element(q, c, s, double(elements) / smeared, l, with_hessian, p);
  }
}

template <class Contact>
void RollingBearing<Contact>::mean_potential(const Vector<6>& q, RollingPotential& p,
                                             bool with_hessian) const {
  constexpr int looks = 48;
  p = {};
  // from the direction of the displacement on: the middle of the loaded arc is looked at
  const bool shifted = q[1] != 0.0 || q[2] != 0.0;
  const double start = shifted ? std::atan2(q[2], q[1]) : std::atan2(q[4], q[3]);
  for (int part = 0; part < contact.parts(); ++part) {
    const auto gap = [&](double a) {
      const double c = std::cos(a), s = std::sin(a);
      return contact.gap_at(part, q[0], q[1] * c + q[2] * s, q[3] * c + q[4] * s);
    };
    std::array<double, looks> passage;
    std::size_t passages = 0;
    bool enters = false;  // at the first of them
    const double first = gap(start);
    double before = first;
    for (int k = 1; k <= looks; ++k) {
      const double a = start + two_pi * (k - 1) / looks, b = start + two_pi * k / looks;
      const double now = k == looks ? first : gap(b);
      if ((now > 0) != (before > 0)) {
        if (passages == 0) enters = now > 0;
        passage[passages++] = zero_between(gap, a, before, b, now);
      }
      before = now;
    }
    if (passages == 0) {
      if (first > 0) add_ring(q, part, start, with_hessian, p);
      continue;
    }
    for (std::size_t k = enters ? 0 : 1; k < passages; k += 2) {
      const bool last = k + 1 == passages;
      add_arc(q, part, passage[k], last ? passage[0] + two_pi : passage[k + 1], with_hessian, p);
    }
  }
}

template <class Contact>
void RollingBearing<Contact>::evaluate(const Nodes<2>& x, bool averaged, RollingPotential& p,
                                       bool with_hessian) const {
  Vector<6> q = deflection(x);
  if (!averaged) return potential(q, p, with_hessian);
  q[5] = 0.0;
  mean_potential(q, p, with_hessian);
  p.g[5] = 0.0;
  p.H.row(5).setZero();
  p.H.col(5).setZero();
}

template <class Contact>
std::vector<double> RollingBearing<Contact>::loads(const Vector<6>& q) const {
  WHIRL_EXPECTS(elements > 0);
  std::vector<double> out;
  for (int j = 0; j < elements; ++j) {
    const double a = q[5] + two_pi * j / elements, c = std::cos(a), s = std::sin(a);
    out.push_back(contact.load(q[0], q[1] * c + q[2] * s, q[3] * c + q[4] * s));
  }
  return out;
}

namespace {

// q_m = sum over nodes of sign[node][m] X[rows[m]]
constexpr int rows[6] = {0, 1, 2, 4, 5, 6};

Vec3 damping_of(double c_axial, double c_radial) { return Vec3(c_axial, c_radial, c_radial); }

}  // namespace

template <class Contact>
void RollingBearing<Contact>::add_force(const Nodes<2>& x, const Context& context,
                                        ForceX<14>& f) const {
  RollingPotential p;
  evaluate(x, context.averaged, p, false);
  const Vec3 drag = damping_of(c_axial, c_radial).cwiseProduct(x[0]->du - x[1]->du);
  f.template segment<3>(0) += p.g.template head<3>() + drag;
  f.template segment<3>(7) -= p.g.template head<3>() + drag;
  f.template segment<2>(4) += p.g.template segment<2>(3);
  f.template segment<2>(11) -= p.g.template segment<2>(3);
  f[6] += cage[0] * p.g[5];
  f[13] += cage[1] * p.g[5];
}

template <class Contact>
void RollingBearing<Contact>::add_tangent(const Nodes<2>& x, const Context& context,
                                          TangentX<14>& t) const {
  RollingPotential p;
  evaluate(x, context.averaged, p, true);
  const double sign[2][6] = {{1, 1, 1, 1, 1, cage[0]}, {-1, -1, -1, -1, -1, cage[1]}};
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int m = 0; m < 6; ++m)
        for (int n = 0; n < 6; ++n)
          t.K(7 * a + rows[m], 7 * b + rows[n]) += sign[a][m] * sign[b][n] * p.H(m, n);
  const Vec3 c = damping_of(c_axial, c_radial);
  for (int k = 0; k < 3; ++k) {
    t.C(k, k) += c[k];
    t.C(7 + k, 7 + k) += c[k];
    t.C(k, 7 + k) -= c[k];
    t.C(7 + k, k) -= c[k];
  }
}

template <class Contact>
void RollingBearing<Contact>::add_energy(const Nodes<2>& x, const Context& context,
                                         Energy& e) const {
  RollingPotential p;
  evaluate(x, context.averaged, p, false);
  e.elastic += p.V;
  const Vec3 v = x[0]->du - x[1]->du;
  e.dissipated += damping_of(c_axial, c_radial).dot(v.cwiseProduct(v));
}

template struct RollingBearing<BallContact>;
template struct RollingBearing<RollerContact>;

namespace {

[[noreturn]] void bearing_fault(const std::string& what) {
  throw run_error("E83", "rolling bearing: " + what);
}

void check_ring(int n, double D, double d_m, const char* what) {
  if (n < 2) bearing_fault(std::string("at least two ") + what + " are needed");
  if (!(D > 0) || !(d_m > D))
    bearing_fault("element diameter must be positive and smaller than the pitch diameter");
  if (n > 2 && D > d_m * std::sin(pi / n))
    bearing_fault(std::string("the ") + what + " do not fit side by side on the pitch circle");
}

}  // namespace

BallBearing make_ball_bearing(const BallGeometry& g) {
  check_ring(g.balls, g.ball_diameter, g.pitch_diameter, "balls");
  if (!(g.f_inner > 0.5) || !(g.f_outer > 0.5))
    bearing_fault("groove radii must exceed half the ball diameter (f > 0.5)");
  if (!(std::abs(g.contact_angle) < 80.0 * pi / 180.0))
    bearing_fault("the contact angle must be below 80 degrees");
  const double D = g.ball_diameter, A0 = (g.f_inner + g.f_outer - 1.0) * D;
  if (!(g.radial_clearance < A0))
    bearing_fault("the radial clearance is larger than the grooves allow");
  if (g.contact_angle != 0.0 && g.radial_clearance != 0.0)
    bearing_fault("give either a contact angle or a radial clearance, not both");
  const double cos_alpha = std::cos(g.contact_angle), lambda = D * cos_alpha / g.pitch_diameter;
  BallBearing b;
  b.elements = g.balls;
  b.cage = {0.5 * (1.0 - lambda), 0.5 * (1.0 + lambda)};
  BallContact& c = b.contact;
  c.A0 = A0;
  c.r0 = A0 * cos_alpha - g.radial_clearance;
  // The inner groove centre moves towards +x with the shaft: contact opens further when it already
  // lies on that side.
  c.a0 = (g.direction >= 0 ? 1.0 : -1.0) * A0 * std::sin(std::abs(g.contact_angle));
  c.R = 0.5 * g.pitch_diameter + (g.f_inner - 0.5) * D * cos_alpha;
  c.K = g.stiffness;
  if (c.K == 0.0) {
    // Principal planes: rolling direction (ball on ring) and across it (ball in groove).
    const double R = 0.5 * D, inner = R * (1.0 - lambda), outer = R * (1.0 + lambda);
    const double across_i = g.f_inner * D * R / (g.f_inner * D - R),
                 across_o = g.f_outer * D * R / (g.f_outer * D - R);
    c.K = hertz_series(hertz_point_stiffness(inner, across_i),
                       hertz_point_stiffness(outer, across_o), 1.5);
  }
  if (!(c.K > 0)) bearing_fault("the contact stiffness must be positive");
  return b;
}

void set_axial_preload(BallBearing& b, double force) {
  BallContact& c = b.contact;
  if (!(force >= 0)) bearing_fault("the preload must not be negative");
  if (c.a0 == 0.0)
    bearing_fault("a deep-groove bearing has no side to be preloaded on: give a contact angle");
  const double side = c.a0 > 0 ? 1.0 : -1.0, start = c.a0;
  const auto push = [&](double shift) {
    BallContact::Local l;
    c.a0 = start + side * shift;
    return c.evaluate(0, 0, 0, l) ? b.elements * std::abs(l.g.x()) : 0.0;
  };
  double lo = 0.0, hi = 1e-9 * c.A0;
  while (push(hi) < force && hi < 1e6 * c.A0)
    hi *= 2.0;
  for (int i = 0; i < 200 && lo < hi; ++i) {
    const double mid = 0.5 * (lo + hi);
    if (mid == lo || mid == hi) break;
    (push(mid) < force ? lo : hi) = mid;
  }
  c.a0 = start + side * 0.5 * (lo + hi);
}

RollerBearing make_roller_bearing(const RollerGeometry& g) {
  check_ring(g.rollers, g.roller_diameter, g.pitch_diameter, "rollers");
  if (!(g.roller_length > 0)) bearing_fault("the roller length must be positive");
  const double lambda = g.roller_diameter / g.pitch_diameter;
  RollerBearing b;
  b.elements = g.rollers;
  b.cage = {0.5 * (1.0 - lambda), 0.5 * (1.0 + lambda)};
  b.contact.length = g.roller_length;
  b.contact.clearance = g.radial_clearance;
  b.contact.K = g.stiffness;
  if (b.contact.K == 0.0) {
    const double k = hertz_line_stiffness(g.roller_length);
    b.contact.K = hertz_series(k, k, 10.0 / 9.0);
  }
  if (!(b.contact.K > 0)) bearing_fault("the contact stiffness must be positive");
  return b;
}

}  // namespace whirl::elements
