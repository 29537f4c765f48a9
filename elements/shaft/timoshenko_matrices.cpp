#include <elements/shaft/timoshenko_matrices.hpp>
#include <core/contract.hpp>
#include <elements/shaft/corrected_mass.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::elements {
namespace {

/// Gauss-Legendre rule on [0, 1] with the integrals of its Lagrange polynomials up to each node.
struct GaussRule {
  std::vector<double> x, w;
  std::vector<double> cumulative;  ///< n x n, row i: weights of int_0^{x_i}

  explicit GaussRule(int n) : x(n), w(n), cumulative(n * n) {
    for (int i = 0; i < n; ++i) {
      double z = std::cos(pi * (i + 0.75) / (n + 0.5)), dp = 0;
      for (int it = 0; it < 100; ++it) {
        double p0 = 1, p1 = z;
        for (int k = 2; k <= n; ++k) {
          const double p2 = ((2 * k - 1) * z * p1 - (k - 1) * p0) / k;
          p0 = p1;
          p1 = p2;
        }
        dp = n * (z * p1 - p0) / (z * z - 1);
        const double step = p1 / dp;
        z -= step;
        if (std::abs(step) < 1e-16) break;
      }
      x[n - 1 - i] = 0.5 * (1 + z);
      w[n - 1 - i] = 1 / ((1 - z * z) * dp * dp);
    }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        cumulative[i * n + j] = 0;
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
          cumulative[i * n + j] += x[i] * w[k] * lagrange(j, x[i] * x[k]);
  }
  double lagrange(int j, double t) const {
    double p = 1;
    for (std::size_t m = 0; m < x.size(); ++m)
      if (static_cast<int>(m) != j) p *= (t - x[m]) / (x[j] - x[m]);
    return p;
  }
  int size() const { return static_cast<int>(x.size()); }
};

/// A uniform element's integrands are polynomials of degree 6 at most.
const GaussRule& polynomial_rule() {
  static const GaussRule rule(4);
  return rule;
}
/// For cones. The nearest pole of 1/EI lies where a diameter or the wall vanishes; with their ratio
/// kept below 1.5 within a panel it is at least 5 half-panels from its middle, and 16-point
/// interpolation converges like (5 + sqrt 24)^-16 = 1e-16.
const GaussRule& taper_rule() {
  static const GaussRule rule(16);
  return rule;
}
constexpr double panel_ratio = 1.5;

/// Fractions xi at which the panels of an element begin and end.
std::vector<double> panels(const ElementSection& s) {
  if (s.uniform()) return {0.0, 1.0};
  const auto ratio = [](double a, double b) { return std::max(a / b, b / a); };
  std::vector<double> out{0.0};
  std::vector<double> right{1.0};  // ends still to be reached, nearest last
  while (!right.empty()) {
    const double a = out.back(), b = right.back();
    const ElementSection p = s.part(a, b);
    const bool fine =
        ratio(p.od1, p.od2) <= panel_ratio && ratio(p.od1 - p.id1, p.od2 - p.id2) <= panel_ratio;
    if (fine || right.size() > 60) {
      out.push_back(b);
      right.pop_back();
    } else {
      right.push_back(0.5 * (a + b));
    }
  }
  return out;
}

/// Running integrals over the panels: value at every node.
struct Sampled {
  const GaussRule& rule;
  std::vector<double> ends;
  double l;
  struct Point {
    double xi, ds;
    SectionProperties p;
    double soft_t;  ///< 1/GJ, or 1 where no GJ is given (twist then interpolated linearly)
  };
  std::vector<Point> points;

  Sampled(const ElementSection& s, double length)
      : rule(s.uniform() ? polynomial_rule() : taper_rule()),
        ends(panels(s)),
        l(length) {
    points.reserve((ends.size() - 1) * rule.x.size());
    for (std::size_t k = 0; k + 1 < ends.size(); ++k)
      for (int i = 0; i < rule.size(); ++i) {
        const double h = ends[k + 1] - ends[k], xi = ends[k] + h * rule.x[i];
        const SectionProperties p = s.at(xi);
        points.push_back({xi, h * l * rule.w[i], p, p.GJ > 0 ? 1 / p.GJ : 1.0});
      }
  }

  /// Integral over the element of f(point).
  template <class F>
  double integral(F f) const {
    double sum = 0;
    for (const Point& p : points)
      sum += p.ds * f(p);
    return sum;
  }
  /// Integral of f(point) from 0 to each point.
  template <class F>
  std::vector<double> running(F f) const {
    std::vector<double> v(points.size());
    for (std::size_t n = 0; n < v.size(); ++n)
      v[n] = f(points[n]);
    return running(v, 0.0);
  }
  /// start + integral of f (one value a point) from 0 to each point.
  std::vector<double> running(const std::vector<double>& f, double start) const {
    std::vector<double> out(f.size());
    const int n = rule.size();
    double base = start;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      const double h = (ends[k + 1] - ends[k]) * l;
      const double* fk = f.data() + k * n;
      double whole = 0;
      for (int i = 0; i < n; ++i) {
        double part = 0;
        for (int j = 0; j < n; ++j)
          part += rule.cumulative[i * n + j] * fk[j];
        out[k * n + i] = base + h * part;
        whole += rule.w[i] * fk[i];
      }
      base += h * whole;
    }
    return out;
  }
};

double shear_softness(const SectionProperties& p) { return 1 / p.kGA; }  // 0 for an infinite kGA

/// End moments (k11, k12, k22) per end rotation: the inverse of the flexibility.
Mat2 end_stiffness(const Sampled& sp) {
  const double l = sp.l;
  const double shear = sp.integral([](const auto& q) { return shear_softness(q.p); }) / (l * l);
  const double f11 =
      sp.integral([](const auto& q) { return (1 - q.xi) * (1 - q.xi) / q.p.EI; }) + shear;
  const double f22 = sp.integral([](const auto& q) { return q.xi * q.xi / q.p.EI; }) + shear;
  const double f12 = sp.integral([](const auto& q) { return -q.xi * (1 - q.xi) / q.p.EI; }) + shear;
  const double det = f11 * f22 - f12 * f12;
  Mat2 k;
  k << f22 / det, -f12 / det, -f12 / det, f11 / det;
  return k;
}

/// Section rotation, deflection and slope of the static solution for th_i = 1 (i = 0, 1), at the
/// points.
struct StaticShape {
  std::vector<double> g, w, slope;
};
StaticShape static_shape(const Sampled& sp, const Mat2& k, int i) {
  const double m1 = k(0, i), m2 = k(1, i), Q = -(m1 + m2) / sp.l;
  StaticShape s;
  std::vector<double> f(sp.points.size());
  for (std::size_t n = 0; n < f.size(); ++n)
    f[n] = (-m1 * (1 - sp.points[n].xi) + m2 * sp.points[n].xi) / sp.points[n].p.EI;
  s.g = sp.running(f, i == 0 ? 1.0 : 0.0);
  s.slope.resize(f.size());
  for (std::size_t n = 0; n < f.size(); ++n)
    s.slope[n] = s.g[n] + Q * shear_softness(sp.points[n].p);
  s.w = sp.running(s.slope, 0.0);
  return s;
}

/// From chord-frame shapes to shapes on (r1, d1, r2, d2): r = r1 + s a + w1 (d1 - a) + w2 (d2 - a),
/// a = (r2 - r1)/l.
Vector<4> on_nodes(double chord, double f1, double f2, double l, bool deflection) {
  const double a = (chord - f1 - f2) / l;
  return Vector<4>(deflection ? 1 - a : -a, f1, a, f2);
}

/// X = (x1, d1, x2, d2) at the nodes to (r1, d1, r2, d2) at the end points.
Matrix<4> offset_map(double o1, double o2) {
  Matrix<4> T = Matrix<4>::Identity();
  T(0, 1) = o1;
  T(2, 3) = o2;
  return T;
}

/// Bending stiffness on (r1, d1, r2, d2): th_i = d_i - (r2 - r1)/l to first order in the plane of
/// bending.
Matrix<4> end_point_stiffness(const Mat2& k, double l) {
  Matrix<2, 4> th;
  th << 1 / l, 1, -1 / l, 0, 1 / l, 0, -1 / l, 1;
  return th.transpose() * k * th;
}

/// Twice the complementary energy of the element clamped at both ends, from any equilibrium M(s),
/// Q(s) of its load.
double clamped_energy(const Sampled& sp, const Mat2& k, const std::vector<double>& M,
                      const std::vector<double>& Q) {
  double own = 0;
  Vec2 g = Vec2::Zero();
  for (std::size_t n = 0; n < sp.points.size(); ++n) {
    const auto& q = sp.points[n];
    const double flex = q.ds / q.p.EI, shear = q.ds * shear_softness(q.p);
    own += flex * M[n] * M[n] + shear * Q[n] * Q[n];
    g += flex * M[n] * Vec2(-(1 - q.xi), q.xi) - shear * Q[n] / sp.l * Vec2::Ones();
  }
  return std::max(own - g.dot(k * g), 0.0);
}

/// c_w of the header, s^2: the element clamped at both ends under the load rhoA(s).
double translation_softness(const Sampled& sp, const Mat2& k, double mass) {
  if (!(mass > 0)) return 0;
  std::vector<double> Q = sp.running(
      [](const auto& q) { return q.p.rhoA; });  // simply supported: Q = R - int rhoA, M' = -Q
  const double R = sp.integral([](const auto& q) { return q.p.rhoA * (1 - q.xi); });
  for (double& q : Q)
    q -= R;
  std::vector<double> M = sp.running(Q, 0.0);
  for (double& q : Q)
    q = -q;
  return clamped_energy(sp, k, M, Q) / mass;
}

/// c_th and c_p: clamped at both ends under a distributed moment inertia(s) (= rhoI or rhoIp): M' =
/// -inertia, Q = 0.
template <class F>
double rotation_softness(const Sampled& sp, const Mat2& k, F inertia) {
  const double total = sp.integral(inertia);
  if (!(total > 0)) return 0;
  const std::vector<double> M = sp.running(inertia);
  return clamped_energy(sp, k, M, std::vector<double>(M.size(), 0.0)) / total;
}

/// (w_i c_i K_ij + K_ij c_j w_j)/2 at the nodes (x1, d1, x2, d2), with c = (cr, cd, cr, cd) and K
/// at the end points.
Matrix<4> weighted(const Matrix<4>& K, double cr, double cd, const Matrix<4>& T,
                   const Vector<4>& share) {
  const Matrix<4> a =
      share.asDiagonal() * (T.transpose() * Vector<4>(cr, cd, cr, cd).asDiagonal() * K * T);
  return 0.5 * (a + a.transpose());
}

/// Rows of one share only add to the mass.
template <class V>
bool alike(const V& share) {
  return (share.array() == share[0]).all();
}

/// (L1, L2): the exact static twist, and the polar mass built on it.
Mat2 polar_mass(const Sampled& sp, MassKind kind, const Vec2& share) {
  const double soft = sp.integral([](const auto& q) { return q.soft_t; });
  const double total = sp.integral([](const auto& q) { return q.p.rhoIp; });
  if (!(total > 0)) return Mat2::Zero();
  const std::vector<double> L2 = sp.running([soft](const auto& q) { return q.soft_t / soft; });
  const std::vector<double> V =
      sp.running([](const auto& q) { return q.p.rhoIp; });  // fixed ends: torque T0 - V
  Mat2 m = Mat2::Zero();
  double vv = 0, v = 0;
  for (std::size_t n = 0; n < V.size(); ++n) {
    const auto& q = sp.points[n];
    const Vec2 L(1 - L2[n], L2[n]);
    m += q.ds * q.p.rhoIp * L * L.transpose();
    vv += q.ds * q.soft_t * V[n] * V[n];
    v += q.ds * q.soft_t * V[n];
  }
  if (kind == MassKind::corrected) {
    const double c = (vv - v * v / soft) / total / soft;  // c_t times the torsional stiffness
    const Mat2 a = c * share.asDiagonal() * (Mat2() << 1, -1, -1, 1).finished();
    const Mat2 correction = 0.5 * (a + a.transpose());
    m += (alike(share) ? 1.0 : admitted_correction(m, correction)) * correction;
  }
  return m;
}

/// Integrals over the shapes of the static solution, on end points and directors.
struct ShapeIntegrals {
  Matrix<4> M = Matrix<4>::Zero(), G = Matrix<4>::Zero();  ///< consistent M4 and G4
  double b11 = 0, b12 = 0, b22 = 0;                        ///< 1/l int w_i' w_j' ds
  /// Between the curve of directors and its two arcs through the chord: 1/2 int (g1 g2' - g2 g1')
  /// ds.
  double area = 0;
};
ShapeIntegrals shape_integrals(const Sampled& sp, const Mat2& k) {
  const double l = sp.l;
  const std::array<StaticShape, 2> shape{static_shape(sp, k, 0), static_shape(sp, k, 1)};
  ShapeIntegrals r;
  for (std::size_t n = 0; n < sp.points.size(); ++n) {
    const auto& q = sp.points[n];
    const double g1 = shape[0].g[n], g2 = shape[1].g[n];
    const double slope1 = shape[0].slope[n], slope2 = shape[1].slope[n];
    const Vector<4> N = on_nodes(q.xi * l, shape[0].w[n], shape[1].w[n], l, true);
    const Vector<4> G = on_nodes(1.0, g1, g2, l, false);
    r.M += q.ds * (q.p.rhoA * N * N.transpose() + q.p.rhoI * G * G.transpose());
    r.G += q.ds * q.p.rhoIp * G * G.transpose();
    r.b11 += q.ds / l * slope1 * slope1;
    r.b12 += q.ds / l * slope1 * slope2;
    r.b22 += q.ds / l * slope2 * slope2;
    const double from_end1 = 1 - q.xi;
    const double dg1 = (-k(0, 0) * from_end1 + k(1, 0) * q.xi) / q.p.EI;
    const double dg2 = (-k(0, 1) * from_end1 + k(1, 1) * q.xi) / q.p.EI;
    r.area += q.ds * 0.5 * (g1 * dg2 - g2 * dg1);
  }
  return r;
}

/// The correction of the header on M4 and G4 at the nodes; T: offset_map.
void correct_mass(const Sampled& sp, const Mat2& k, const Matrix<4>& T, const Vector<4>& share,
                  ShaftElementConstants& c) {
  const auto rhoI = [](const auto& q) { return q.p.rhoI; };
  const auto rhoIp = [](const auto& q) { return q.p.rhoIp; };
  const double l = sp.l;
  const Matrix<4> K = end_point_stiffness(k, l);
  const double I = sp.integral(rhoI), rotary = I > 0 ? 15 * I / (15 * I + c.mass * l * l) : 0.0;
  const double cw = translation_softness(sp, k, c.mass), cd = rotation_softness(sp, k, rhoI);
  const Matrix<4> correction = weighted(K, cw, cw - rotary * (cw - cd), T, share);
  c.M4 += (alike(share) ? 1.0 : admitted_correction(c.M4, correction)) * correction;
  c.G4 += weighted(K, 0.0, rotation_softness(sp, k, rhoIp), T, share);
}

}  // namespace

ShaftElementConstants make_shaft_constants(const ElementSection& section, double l, double o1,
                                           double o2, MassKind kind, const MassShare& share) {
  WHIRL_EXPECTS(l > 0.0 && std::isfinite(l));
  WHIRL_EXPECTS(std::isfinite(o1) && std::isfinite(o2));
  const Sampled sp(section, l);
  ShaftElementConstants c;
  c.length = l;
  c.o1 = o1;
  c.o2 = o2;
  const bool has_EA = sp.points.front().p.EA > 0, has_GJ = sp.points.front().p.GJ > 0;
  c.EA_l = has_EA ? 1 / sp.integral([](const auto& q) { return 1 / q.p.EA; }) : 0.0;
  c.GJ_l = has_GJ ? 1 / sp.integral([](const auto& q) { return 1 / q.p.GJ; }) : 0.0;
  c.mass = sp.integral([](const auto& q) { return q.p.rhoA; });
  const Mat2 k = end_stiffness(sp);
  c.k11 = k(0, 0);
  c.k12 = k(0, 1);
  c.k22 = k(1, 1);
  const ShapeIntegrals of_shapes = shape_integrals(sp, k);
  c.b11 = of_shapes.b11;
  c.b12 = of_shapes.b12;
  c.b22 = of_shapes.b22;
  c.tau_c = -of_shapes.area;
  const Matrix<4> T = offset_map(o1, o2);
  c.M4 = T.transpose() * of_shapes.M * T;
  c.G4 = T.transpose() * of_shapes.G * T;
  if (kind == MassKind::corrected) correct_mass(sp, k, T, share.bending, c);
  c.polar = polar_mass(sp, kind, share.spin);
  return c;
}

Matrix<4> bending_stiffness(const ShaftElementConstants& c) {
  WHIRL_EXPECTS(c.length > 0.0);
  const Matrix<4> T = offset_map(c.o1, c.o2);
  return T.transpose() *
         end_point_stiffness((Mat2() << c.k11, c.k12, c.k12, c.k22).finished(), c.length) * T;
}

}  // namespace whirl::elements
