// The shear-deformable, extensible rod in exact kinematics (E. Reissner 1973; J. C. Simo 1985, doi
// 10.1016/0045-7825(85)90050-7), clamped at s = 0 under a dead force at its end, by shooting: an
// independent reference for beam elements.
//   r' = R (1 + N/EA, Q_B/kGA_B, Q_C/kGA_C),   R' = R [kappa0 + (T/GJ, M_B/EI_B, M_C/EI_C)],
//       m' = -r' x n,   n = F,
// all stresses in the axes R = (D, B, C) of the section. Fourth-order Runge-Kutta, Newton on the
// moment at the clamp.
#pragma once
#include "beam_line.hpp"

#include <Eigen/LU>

namespace whirl::test {

struct ExactRod {
  BeamSection section;  ///< kGA 0: no shear deformation
  double length = 0;
  Vec3 r0 = Vec3::Zero();
  Mat3 R0 = Mat3::Identity();      ///< triad at the clamp
  Vec3 curvature0 = Vec3::Zero();  ///< of the unstressed rod, in its own axes, 1/m
  int steps = 1000;

  struct End {
    Vec3 r;
    Mat3 R;
    Vec3 m;
  };

  End march(const Vec3& F, const Vec3& m0) const {
    End x{r0, R0, m0};
    const auto slope = [&](const End& y) {
      const Vec3 N = y.R.transpose() * F, M = y.R.transpose() * y.m;
      const auto over = [](double f, double k) { return k > 0 ? f / k : 0.0; };
      const Vec3 v(1 + N[0] / section.EA, over(N[1], section.kGA_B), over(N[2], section.kGA_C));
      const Vec3 kappa =
          curvature0 + Vec3(M[0] / section.GJ, M[1] / section.EI_B, M[2] / section.EI_C);
      End d;
      d.r = y.R * v;
      for (int c = 0; c < 3; ++c)
        d.R.row(c) = y.R.row(c).cross(kappa);  // rows of R [kappa]
      d.m = -d.r.cross(F);
      return d;
    };
    const auto step = [](const End& y, double h, const End& d) {
      return End{y.r + h * d.r, y.R + h * d.R, y.m + h * d.m};
    };
    const double h = length / steps;
    for (int i = 0; i < steps; ++i) {
      const End k1 = slope(x), k2 = slope(step(x, h / 2, k1)), k3 = slope(step(x, h / 2, k2)),
                k4 = slope(step(x, h, k3));
      x = step(step(step(step(x, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
    }
    return x;
  }

  /// End under the force F and the moment M there, put on in `parts`.
  End solve(const Vec3& F, int parts = 10, const Vec3& M = Vec3::Zero()) const {
    Vec3 m = Vec3::Zero();
    End x{};
    const double size = F.norm() * length + M.norm();
    for (int p = 1; p <= parts; ++p) {
      const Vec3 f = F * p / parts;
      for (int it = 0; it < 50; ++it) {
        x = march(f, m);
        if ((x.m - M * p / parts).norm() < 1e-12 * size) break;
        Mat3 J;
        for (int c = 0; c < 3; ++c) {
          const Vec3 e = 1e-6 * size * Vec3::Unit(c);
          J.col(c) = (march(f, m + e).m - march(f, m - e).m) / (2e-6 * size);
        }
        m -= J.inverse() * (x.m - M * p / parts);
      }
    }
    return x;
  }
};

}  // namespace whirl::test
