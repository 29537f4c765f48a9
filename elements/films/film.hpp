// Lubricating films between a circular journal and its housing, as laws of LateralJoint.
//
// Reynolds: div(h^3/(12 eta) grad p) = v_s dh/ds + dh/dt. For a journal displaced by r in a housing
// whose own clearance is h0(theta), h = h0 - r.n, n = (cos theta, sin theta) from +y towards +z.
// With the mean spin m = (s_0+s_1)/2, the slip s = s_0 - s_1 and J the quarter turn y -> z, the
// right side is
//   -w.n + (s/2) h0',   w = v - m J r
// (the housing's shape does not turn: grooves and lobes stand still in (y, z)). A film is therefore
// a function of (r, w, s).
//
// Force F on the journal. Torque about the housing centre balances (a film has no inertia): T_0 +
// T_1 + r x F = 0, and
//   T_0 = T - (r x F)/2,   T_1 = -T - (r x F)/2,
// T = shear and lobe part. Power delivered to the nodes is F.w + T s: what the film turns into
// heat, with the sign changed, less the power of a pump that feeds it under pressure. So whirl driven by a film takes its power out of the spin of the
// shaft, exactly.
//
//   struct Film {
//     void evaluate(const FilmPoint&, FilmForce&) const;
//     void evaluate(const FilmPoint&, FilmForce&, FilmTangent&) const;
//   };
// Outside its domain (film thickness <= 0) a film returns NaN: the time step or the Newton step is
// then shortened. Source: Szeri, Fluid Film Lubrication, 2nd ed., 2011, doi
// 10.1017/CBO9780511782022, ch. 2-4.
#pragma once
#include <elements/supports/lateral_joint.hpp>
#include <cmath>

namespace whirl::elements {

struct FilmPoint {
  Vec2 r, w;        ///< displacement m; velocity in the frame turning with the mean spin, m/s
  double slip = 0;  ///< s_0 - s_1, rad/s
  const double* kept = nullptr;  ///< what elements keep (system::NodeState::kept)
};
struct FilmForce {
  Vec2 F;           ///< on the journal, N
  double T = 0;     ///< torque on the journal beside -(r x F)/2, N m
  double pump = 0;  ///< power of what feeds the film under pressure, W
};
struct FilmTangent {
  Mat2 F_r, F_w;
  Vec2 F_slip;
  Vec2 T_r, T_w;
  double T_slip = 0;
};

inline void set_zero(FilmForce& f, FilmTangent& t) {
  f = {Vec2::Zero(), 0.0, 0.0};
  t.F_r.setZero();
  t.F_w.setZero();
  t.F_slip.setZero();
  t.T_r.setZero();
  t.T_w.setZero();
  t.T_slip = 0.0;
}

/// What a film returns outside its domain.
inline void set_outside(FilmForce& f) {
  f.F.setConstant(nan);
  f.T = nan;
}
inline void set_outside(FilmForce& f, FilmTangent& t) {
  set_outside(f);
  t.F_r.setConstant(nan);
  t.F_w = t.F_r;
  t.F_slip.setConstant(nan);
  t.T_r = t.T_w = t.F_slip;
  t.T_slip = nan;
}

template <class Film>
struct FilmLaw {
  static constexpr bool inertia = false;
  static constexpr system::Dependence depends{.spin = true};
  Film film;

  static FilmPoint point(const LateralMotion& m) {
    const double mean = 0.5 * (m.spin + m.housing_spin);
    return {m.r, Vec2(m.v.x() + mean * m.r.y(), m.v.y() - mean * m.r.x()), m.spin - m.housing_spin,
            m.kept};
  }
  void force(const LateralMotion& m, Vector<4>& z) const {
    FilmForce f;
    film.evaluate(point(m), f);
    join(m.r, f, z);
  }
  void tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const {
    FilmForce f;
    FilmTangent g;
    film.evaluate(point(m), f, g);
    join(m.r, f, z);
    const double mean = 0.5 * (m.spin + m.housing_spin);
    Mat2 J;
    J << 0.0, -1.0, 1.0, 0.0;
    const Mat2 F_r = g.F_r - mean * g.F_w * J;                // total: w depends on r
    const Vec2 T_r = g.T_r + mean * J * g.T_w;                // J^T = -J
    const Vec2 w_spin = Vec2(0.5 * m.r.y(), -0.5 * m.r.x());  // dw/ds_0 = dw/ds_1
    const auto fill = [&](const Mat2& F, const Vec2& T, Matrix<4, 2>& out) {
      out.topRows<2>() = F;
      const Eigen::RowVector2d half = 0.5 * (m.r.x() * F.row(1) - m.r.y() * F.row(0));
      out.row(2) = T.transpose() - half;
      out.row(3) = -T.transpose() - half;
    };
    fill(g.F_w, g.T_w, t.v);
    fill(F_r, T_r, t.r);
    const Eigen::RowVector2d cross(0.5 * f.F.y(), -0.5 * f.F.x());  // d(r x F / 2)/dr at fixed F
    t.r.row(2) -= cross;
    t.r.row(3) -= cross;
    t.a.setZero();
    const auto by_spin = [&](double sign, Vector<4>& out) {
      const Vec2 F = g.F_w * w_spin + sign * g.F_slip;
      const double T = g.T_w.dot(w_spin) + sign * g.T_slip,
                   half = 0.5 * (m.r.x() * F.y() - m.r.y() * F.x());
      out << F, T - half, -T - half;
    };
    by_spin(1.0, t.spin);
    by_spin(-1.0, t.housing_spin);
  }
  void energy(const LateralMotion& m, system::Energy& e) const {
    const FilmPoint p = point(m);
    FilmForce f;
    film.evaluate(p, f);
    e.dissipated -= f.F.dot(p.w) + f.T * p.slip;
    e.dissipated += f.pump;
    e.supplied += f.pump;
  }

 private:
  static void join(const Vec2& r, const FilmForce& f, Vector<4>& z) {
    const double half = 0.5 * (r.x() * f.F.y() - r.y() * f.F.x());
    z << f.F, f.T - half, -f.T - half;
  }
};

}  // namespace whirl::elements
