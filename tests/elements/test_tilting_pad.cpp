// Tilting pads: conformance, a published geometry against an independent two-dimensional solution,
// locked pads against the lobed journal, reduced coefficients, smoothness, grids, bad input.
#include <la/dense.hpp>
#include "conformance.hpp"
#include <core/error.hpp>
#include <elements/films/tilting_pad.hpp>

#include <Eigen/SparseCholesky>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

constexpr double degree = pi / 180;

/// A bearing of pads on rigid pivots.
struct Ring {
  std::vector<TiltingPad> pads;
  double spin = 0;

  LateralMotion at(const Vec2& r) const {
    LateralMotion m;
    m.r = r;
    m.v.setZero();
    m.a.setZero();
    m.spin = spin;
    return m;
  }
  std::vector<double> tilts(const Vec2& r) const {
    std::vector<double> out;
    for (const TiltingPad& p : pads)
      out.push_back(p.settled_tilt(at(r)));
    return out;
  }
  /// On the journal, every pad in balance.
  Vec2 force(const Vec2& r) const {
    Vec2 F = Vec2::Zero();
    for (const TiltingPad& p : pads)
      F -= p.standing(at(r), Vec2(p.settled_tilt(at(r)), 0)).force;
    return F;
  }
  PadCoefficients coefficients(const Vec2& r, const std::vector<double>& tilt) const {
    const Index n = 2 + static_cast<Index>(pads.size());
    PadCoefficients out{MatX::Zero(n, n), MatX::Zero(n, n), MatX::Zero(n, n)};
    const Mat3 axes = Mat3::Identity();
    for (std::size_t k = 0; k < pads.size(); ++k) {
      std::array<system::NodeState, 3> x;
      for (auto& s : x) {
        s.chart = &axes;
        s.u = s.du = s.ddu = s.t = s.dd = s.ddd = Vec3::Zero();
      }
      x[0].u = Vec3(0, r.x(), r.y());
      x[0].dphi = spin;
      x[2].u.x() = tilt[k];
      system::TangentX<21> t;
      t.set_zero();
      TiltingPadJoint<false>{pads[k]}.add_tangent({&x[0], &x[1], &x[2]}, {}, t);
      const std::pair<Index, Index> place[] = {{0, 1}, {1, 2}, {2 + static_cast<Index>(k), 14}};
      for (const auto& [i, a] : place)
        for (const auto& [j, b] : place) {
          out.K(i, j) += t.K(a, b);
          out.C(i, j) += t.C(a, b);
          out.M(i, j) += t.M(a, b);
        }
    }
    return out;
  }
  /// Where the journal carries a load, by Newton's method with slopes of differences.
  Vec2 equilibrium(const Vec2& load, Vec2 r) const {
    for (int k = 0; k < 40; ++k) {
      const Vec2 miss = force(r) + load;
      const Mat2 K = reduce_pads(coefficients(r, tilts(r)), 0.0).K;
      Vec2 step = K.inverse() * miss;
      const double most = 0.1 * pads[0].film.surface->clearance();
      if (step.norm() > most) step *= most / step.norm();
      r += step;
      if (step.norm() < 1e-13 * pads[0].film.surface->clearance() + 1e-18) break;
    }
    return r;
  }
};

/// Case L4: five pads of 60 deg, load on the fourth; angles from y towards z, load along -z.
constexpr double cb = 194.564e-6;
Ring five_pads(double turned = 0, int points = 14, double preload = 0.3, double offset = 0.5) {
  Ring b;
  b.spin = 94.2477796;
  for (int k = 0; k < 5; ++k)
    b.pads.push_back(
        make_tilting_pad({0.5 * 0.3999992, 0.263144, 19.01574061e-3, cb, preload,
                          (54 + 72 * k) * degree + turned, 60 * degree, offset, 0, points}));
  return b;
}
constexpr double W = 112814.907;

/// int p n dtheta/L of a pad, by finite volumes with complementarity (active sets) on half its
/// length: n cells round, m along; P in units of the source 12 W.n, R = 1.
Vec2 film_in_two_dimensions(double from, double arc, double length, const Vec2& e, const Vec2& W0,
                            int n, int m) {
  const double d = arc / n, dz = 0.5 * length / m;
  const int N = n * m;
  const auto cube = [&](double a) {
    return std::pow(1 - e.x() * std::cos(a) - e.y() * std::sin(a), 3);
  };
  std::vector<Eigen::Triplet<double>> entries;
  VecX source(N);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int here = i * m + j;
      const double a = from + d * (i + 0.5), along = cube(a) * d / dz;
      double sum = 0;
      const auto side = [&](bool inside, int other, double flow) {
        sum += inside ? flow : 2 * flow;
        if (inside) entries.emplace_back(here, other, -flow);
      };
      side(i > 0, here - m, cube(a - d / 2) * dz / d);
      side(i + 1 < n, here + m, cube(a + d / 2) * dz / d);
      if (j > 0) side(true, here - 1, along);
      side(j + 1 < m, here + 1, along);
      entries.emplace_back(here, here, sum);
      source[here] = 12 * (W0.x() * std::cos(a) + W0.y() * std::sin(a)) * d * dz;
    }
  Eigen::SparseMatrix<double> A(N, N);
  A.setFromTriplets(entries.begin(), entries.end());
  std::vector<bool> wet(static_cast<std::size_t>(N), true);
  VecX P = VecX::Zero(N);
  for (int pass = 0, changed = 1; pass < 100 && changed > 0; ++pass) {
    Eigen::SparseMatrix<double> B = A;
    VecX b = source;
    for (int k = 0; k < N; ++k) {
      if (!wet[static_cast<std::size_t>(k)]) b[k] = 0;
      for (Eigen::SparseMatrix<double>::InnerIterator it(B, k); it; ++it)
        if (!wet[static_cast<std::size_t>(k)] || !wet[static_cast<std::size_t>(it.row())])
          it.valueRef() = it.row() == k ? 1.0 : 0.0;
    }
    P = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(B).solve(b);
    const VecX left = A * P - source;
    changed = 0;
    for (int k = 0; k < N; ++k) {
      const bool now = wet[static_cast<std::size_t>(k)] ? P[k] > 0 : left[k] < 0;
      changed += now != wet[static_cast<std::size_t>(k)];
      wet[static_cast<std::size_t>(k)] = now;
    }
  }
  Vec2 G = Vec2::Zero();
  for (int i = 0; i < n; ++i) {
    const double a = from + d * (i + 0.5);
    G += P.segment(i * m, m).mean() * d * Vec2(std::cos(a), std::sin(a));
  }
  return G;
}

}  // namespace

TEST(TiltingPad, Conformance) {
  constexpr double c = 1e-4, Omega = 300;
  TiltingPad pad = make_tilting_pad({0.05, 0.06, 0.02, c, 0.4, -1.2, 1.1, 0.55, 0.01, 16});
  pad.inertia = 2e-4;
  pad.tilt_stiffness += 300;
  pad.tilt_damping += 0.02;
  pad.mass = 0.3;
  pad.pivot_stiffness = 2e8;
  pad.pivot_damping = 3e3;
  ConformanceOptions o = film_options(c, Omega);
  o.gravity.setZero();  // it does not act on scalars
  o.samples = 4;
  const auto start = [&](int nodes) {
    o.q0.assign(static_cast<std::size_t>(6 * nodes), 0.0);
    o.v0.assign(static_cast<std::size_t>(6 * nodes), 0.0);
    o.v0[3] = Omega;
    o.v0[9] = 20;
    o.q0[1] = 0.2 * c;
    o.q0[2] = -0.4 * c;
    o.v0[1] = 0.05 * c * Omega;
    o.q0[12] = 0.3 * c / pad.arm;
  };
  start(3);
  check_kernel(TiltingPadJoint<false>{pad}, o);
  check_kernel(TiltingPadJoint<false, true>{pad, {1e-6, 2e-6}}, o);
  start(4);
  o.q0[18] = 0.05 * c;
  check_kernel(TiltingPadJoint<true>{pad}, o);
  check_kernel(TiltingPadJoint<true, true>{pad, {1e-6, 2e-6}}, o);
  for (const double exponent : {1.5, 10.0 / 9.0}) {  // contacts, pressed and hanging free
    pad.pivot_exponent = exponent;
    pad.pivot_stiffness = 2e8 * std::pow(0.05 * c, 1.0 - exponent);
    o.q0[18] = 0.05 * c;
    check_kernel(TiltingPadJoint<true>{pad}, o);
    o.q0[18] = -0.05 * c;
    check_kernel(TiltingPadJoint<true>{pad}, o);
  }
}

// Five pads, load on one: y/cb = -0.61797 by an independent finite-volume code with
// complementarity, order 2 in its grid: 40x10 -0.616782, 80x20 -0.617670, 160x40 -0.617896.
TEST(TiltingPad, FivePadsLoadOnPad) {
  const Ring b = five_pads();
  const Vec2 r = b.equilibrium(Vec2(0, -W), Vec2(0, -0.4 * cb)) / cb;
  EXPECT_NEAR(r.x(), 0.0, 1e-6);
  EXPECT_NEAR(r.y(), -0.61797, 0.0025);  // 0.4 %
  RecordProperty("y_over_cb", std::to_string(r.y()));
  const auto tilt = b.tilts(cb * r);
  // differences of equilibria of the finite volumes above, 40x10 and 80x20 extrapolated
  const double stiffness = 3.1575e9;
  EXPECT_NEAR(reduce_pads(b.coefficients(cb * r, tilt), 0.0).K(1, 1), stiffness, 0.005 * stiffness);
  const auto load = [&](std::size_t k) {
    return b.pads[k].standing(b.at(cb * r), Vec2(tilt[k], 0)).load;
  };
  EXPECT_GT(load(3), 0.8 * W);
  EXPECT_GT(load(2), 0.05 * W);
  EXPECT_NEAR(load(2), load(4), 1e-8 * W);
  for (const std::size_t unloaded : {0u, 1u}) {
    EXPECT_GE(load(unloaded), 0.0);
    EXPECT_LT(load(unloaded), 1e-6 * W);
  }
}

// A lightly loaded pad of the same bearing has two stable balances where the load leans by 10.5 degrees:
// the pad rests, or carries 0.5 % of the load (1177 N by finite volumes with complementarity).
TEST(TiltingPad, BalancesAreStableAndAllThereAre) {
  const Ring b = five_pads();
  const double lean = 10.5 * degree;
  const Vec2 load = W * Vec2(std::sin(lean), -std::cos(lean));
  const Vec2 r = b.equilibrium(load, Vec2(0, -0.4 * cb));
  std::size_t most = 0;
  for (const TiltingPad& pad : b.pads) {
    const LateralMotion m = b.at(r);
    const auto righting = [&](double tilt) {
      return -pad.standing(m, Vec2(tilt, 0)).force.dot(pad.direction(0)) +
             pad.tilt_stiffness * tilt;
    };
    const std::vector<double> tilts = pad.balances(m);
    most = std::max(most, tilts.size());
    const double size = pad.film.surface->pad_clearance() / pad.arm;
    for (const double tilt : tilts) {
      EXPECT_LT(righting(tilt - 1e-4 * size), 0.0);
      EXPECT_GT(righting(tilt + 1e-4 * size), 0.0);
    }
    const double settled = pad.settled_tilt(m);
    EXPECT_TRUE(std::any_of(tilts.begin(), tilts.end(),
                            [&](double tilt) { return std::abs(tilt - settled) < 1e-6 * size; }));
  }
  EXPECT_EQ(most, 2u);
  const LateralMotion outside = b.at(10 * cb * b.pads.front().pivot);
  EXPECT_TRUE(b.pads.front().balances(outside).empty());
  EXPECT_TRUE(std::isnan(b.pads.front().settled_tilt(outside)));
}

// The axial profile against two dimensions, on pads at work: journals towards the pivot and tilts
// that put the resultant through it, from short to square and longer pads. Worst 0.7 % of the load.
TEST(TiltingPad, AgainstTwoDimensionalReynolds) {
  double worst = 0;
  for (const double arc : {45 * degree, 60 * degree, 80 * degree})
    for (const double length : {0.8, 1.3157, 2.0})
      for (const Vec2& e : {Vec2(0.05, -0.1), Vec2(0.434, -0.252), Vec2(0.734, -0.26),
                            Vec2(0.85, -0.2), Vec2(0.3, -0.22)}) {
        const Vec2 W0(-0.5 * e.y(), 0.5 * e.x());
        const auto by_grid = [&](int n) {
          return film_in_two_dimensions(-arc / 2, arc, length, e, W0, n, n / 4);
        };
        const Vec2 coarse = by_grid(40), fine = by_grid(80), exact = fine + (fine - coarse) / 3;
        const AxialProfile profile = axial_profile_of_pad(arc, length);
        const PadFilm film(-arc / 2, arc, false, profile.leakage / (length * length), 24);
        const Vec2 got = profile.source * film.load(e, W0);
        worst = std::max(worst, (got - exact).norm() / exact.norm());
        EXPECT_LT((got - exact).norm(), 0.01 * exact.norm())
            << "arc " << arc << " L/R " << length << " e " << e.transpose() << ": "
            << got.transpose() << " " << exact.transpose();
      }
  RecordProperty("worst", std::to_string(worst));
}

// Pads that do not turn are lobes.
TEST(TiltingPad, LockedPadsAreALobedJournal) {
  const Ring b = five_pads();
  FiniteJournal journal = b.pads[0].film;
  std::vector<JournalPad> lobes;
  for (int k = 0; k < 5; ++k)
    lobes.push_back({(24 + 72 * k) * degree, (84 + 72 * k) * degree, (54 + 72 * k) * degree});
  journal.surface = std::make_shared<JournalSurface>(cb, 0.3, lobes, 70);
  Random random(3);
  for (int sample = 0; sample < 20; ++sample) {
    LateralMotion m = b.at(0.5 * cb * random.vector<2>());
    m.v = 0.3 * cb * b.spin * random.vector<2>();
    Vector<4> whole, sum = Vector<4>::Zero();
    LateralTangent t_whole, t_sum;
    t_sum.set_zero();
    FilmLaw<FiniteJournal>{journal}.tangent(m, whole, t_whole);
    for (const TiltingPad& p : b.pads) {
      Vector<4> z;
      LateralTangent t;
      FilmLaw<FiniteJournal>{p.film}.tangent(p.seen(m, Vec2::Zero(), Vec2::Zero()), z, t);
      sum += z;
      t_sum.r += t.r;
      t_sum.v += t.v;
    }
    EXPECT_LT((sum - whole).norm(), 1e-12 * whole.norm());
    EXPECT_LT((t_sum.r - t_whole.r).norm(), 1e-12 * t_whole.r.norm());
    EXPECT_LT((t_sum.v - t_whole.v).norm(), 1e-12 * t_whole.v.norm());
  }
}

// Stiffness with the pads following, w -> 0: against differences of equilibria. Damping and
// frequency: against the response of the pads to a small harmonic motion of the journal, integrated.
TEST(TiltingPad, ReducedCoefficientsTwoWays) {
  Ring b = five_pads();
  for (TiltingPad& p : b.pads)
    p.inertia = 2.0;
  for (const Vec2& load : {Vec2(0, -W), Vec2(0.4 * W, -0.6 * W)}) {
    const Vec2 r = b.equilibrium(load, Vec2(0, -0.4 * cb));
    const auto tilt = b.tilts(r);
    const PadCoefficients full = b.coefficients(r, tilt);
    const Mat2 K = reduce_pads(full, 0.0).K;
    const double h = 1e-4 * cb;
    for (Index j = 0; j < 2; ++j) {
      const Vec2 s = h * Vec2::Unit(j);
      const Vec2 slope =
          -(8 * (b.force(r + s) - b.force(r - s)) - (b.force(r + 2 * s) - b.force(r - 2 * s))) /
          (12 * h);
      EXPECT_LT((K.col(j) - slope).norm(), 1e-5 * K.norm()) << j;
    }
    EXPECT_LT((reduce_pads(full, 1e-5).K - K).norm(), 1e-6 * K.norm());
    const Mat2 C = reduce_pads(full, 0.0).C;
    EXPECT_LT((reduce_pads(full, 1e-4).C - C).norm(), 1e-6 * C.norm());
    // M x'' + C x' + K x = 0 of the pads with the journal at e cos(w t), implicit midpoint rule on
    // the loaded pad until the motion is periodic
    const double w = 0.7 * b.spin;
    const Index n = full.K.rows() - 2;
    const ReducedCoefficients at_w = reduce_pads(full, w);
    const int steps = 4000, turns = 6;
    const double dt = two_pi / w / steps;
    const MatX Mp = full.M.bottomRightCorner(n, n), Cp = full.C.bottomRightCorner(n, n),
               Kp = full.K.bottomRightCorner(n, n);
    VecX q = VecX::Zero(n), v = q;
    const MatX left = Mp / dt + 0.5 * Cp + 0.25 * dt * Kp;
    const la::DenseLu<double> lu(left);
    Vec2 in_phase = Vec2::Zero(), ahead = Vec2::Zero();
    const Vec2 e = Vec2(1, 0);
    for (int k = 0; k < turns * steps; ++k) {
      const double t = (k + 0.5) * dt;
      const Vec2 x = e * std::cos(w * t), x_rate = -w * e * std::sin(w * t);
      const VecX push = full.K.bottomLeftCorner(n, 2) * x + full.C.bottomLeftCorner(n, 2) * x_rate;
      const VecX next = lu.solve(VecX((Mp / dt - 0.5 * Cp - 0.25 * dt * Kp) * v - Kp * q - push));
      const VecX middle = 0.5 * (v + next), place = q + 0.5 * dt * middle;
      if (k >= (turns - 1) * steps) {
        const Vec2 F = full.K.topLeftCorner(2, 2) * x + full.C.topLeftCorner(2, 2) * x_rate +
                       full.K.topRightCorner(2, n) * place + full.C.topRightCorner(2, n) * middle;
        in_phase += 2.0 / steps * F * std::cos(w * t);
        ahead -= 2.0 / steps * F * std::sin(w * t);
      }
      q += dt * middle;
      v = next;
    }
    EXPECT_LT((in_phase - at_w.K.col(0)).norm(), 1e-4 * at_w.K.norm());
    EXPECT_LT((ahead / w - at_w.C.col(0)).norm(), 1e-4 * at_w.C.norm());
  }
}

// The direction of the load means nothing but itself: bearing and load turned together, and a load
// that goes round between two pads.
TEST(TiltingPad, SmoothInTheDirectionOfLoad) {
  const Ring b = five_pads();
  const Vec2 r = b.equilibrium(Vec2(0, -W), Vec2(0, -0.4 * cb));
  const ReducedCoefficients here = reduce_pads(b.coefficients(r, b.tilts(r)), b.spin);
  for (const double turn : {0.3, 1.234, -2.5}) {
    const Ring turned = five_pads(turn);
    Mat2 T;
    T << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
    const Vec2 s = turned.equilibrium(T * Vec2(0, -W), T * Vec2(0, -0.4 * cb));
    EXPECT_LT((s - T * r).norm(), 1e-9 * cb);
    const ReducedCoefficients there =
        reduce_pads(turned.coefficients(s, turned.tilts(s)), turned.spin);
    EXPECT_LT((there.K - T * here.K * T.transpose()).norm(), 1e-6 * here.K.norm());
    EXPECT_LT((there.C - T * here.C * T.transpose()).norm(), 1e-6 * here.C.norm());
  }
  // third differences of coefficients over steps of 0.5 deg: no trace of a grid
  std::vector<Mat2> K, C;
  Vec2 s = r;
  for (int k = 0; k <= 24; ++k) {
    const double angle = -pi / 2 + 0.5 * k * degree;
    s = b.equilibrium(W * Vec2(std::cos(angle), std::sin(angle)), s);
    const ReducedCoefficients c = reduce_pads(b.coefficients(s, b.tilts(s)), b.spin);
    K.push_back(c.K);
    C.push_back(c.C);
  }
  double worst = 0;
  for (std::size_t k = 3; k < K.size(); ++k)
    for (const std::vector<Mat2>* x : {&K, &C})
      worst = std::max(worst, ((*x)[k] - 3 * (*x)[k - 1] + 3 * (*x)[k - 2] - (*x)[k - 3]).norm() /
                                  (*x)[k].norm());
  EXPECT_LT(worst, 1e-4);
  RecordProperty("worst", std::to_string(worst));
}

// The default grid of 72 points, 14 a pad, against 360.
TEST(TiltingPad, GridIsConverged) {
  double worst = 0;
  for (const double preload : {0.0, 0.3, 0.6})
    for (const double offset : {0.5, 0.6}) {
      const Ring coarse = five_pads(0, 14, preload, offset),
                 fine = five_pads(0, 72, preload, offset);
      const Vec2 r = coarse.equilibrium(Vec2(0, -W), Vec2(0, -0.4 * cb)),
                 s = fine.equilibrium(Vec2(0, -W), r);
      EXPECT_LT((r - s).norm(), 1e-3 * cb);
      const ReducedCoefficients a = reduce_pads(coarse.coefficients(r, coarse.tilts(r)),
                                                coarse.spin),
                                c = reduce_pads(fine.coefficients(s, fine.tilts(s)), fine.spin);
      worst = std::max({worst, (a.K - c.K).norm() / c.K.norm(), (a.C - c.C).norm() / c.C.norm()});
    }
  EXPECT_LT(worst, 0.005);
  RecordProperty("worst", std::to_string(worst));
}

// Any pads: settled tilts leave no moment, pads push outwards, motion costs power.
TEST(TiltingPad, RandomPads) {
  Random random(11);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * 0.5 * (1.0 + random.vector<1>()[0]);
  };
  int settled = 0;
  for (int sample = 0; sample < 200; ++sample) {
    const double c = 1e-4, Omega = draw(100, 1000);
    const TiltingPad pad =
        make_tilting_pad({0.05, draw(0.02, 0.12), draw(0.005, 0.05), c, draw(0.0, 0.7), draw(-3, 3),
                          draw(0.5, 1.8), draw(0.45, 0.65), draw(0.0, 0.03), 16});
    Ring b{{pad}, Omega};
    const Vec2 r = draw(-0.5, 0.85) * c * pad.pivot + draw(-0.3, 0.3) * c * pad.across();
    LateralMotion m = b.at(r);
    const double tilt = pad.settled_tilt(m);
    if (std::isnan(tilt)) continue;
    ++settled;
    const PadStanding s = pad.standing(m, Vec2(tilt, 0));
    EXPECT_GE(s.load, 0.0);
    EXPECT_GT(s.film, 0.0);
    EXPECT_GT(s.power, 0.0);
    EXPECT_NEAR(-s.force.dot(pad.direction(0)) + pad.tilt_stiffness * tilt, 0.0,
                1e-6 * (s.force.norm() * pad.arm + std::abs(pad.tilt_stiffness * tilt)) + 1e-18);
    for (int k = 0; k < 4; ++k) {
      m.v = 0.5 * c * Omega * random.vector<2>();
      system::Energy e;
      FilmLaw<FiniteJournal>{pad.film}.energy(
          pad.seen(m, Vec2(tilt, 0), Vec2(0.2 * c * Omega / pad.arm * random.vector<1>()[0], 0)),
          e);
      EXPECT_GE(e.dissipated, 0.0);
    }
  }
  EXPECT_GT(settled, 150);
}

TEST(TiltingPad, BadInput) {
  const PadGeometry good{0.05, 0.05, 0.02, 1e-4, 0.3, 0.0, 1.0, 0.5, 0.0, 16};
  EXPECT_NO_THROW(make_tilting_pad(good));
  const auto fails = [&](auto change) {
    PadGeometry g = good;
    change(g);
    EXPECT_THROW(make_tilting_pad(g), Error);
  };
  fails([](PadGeometry& g) { g.clearance = 0; });
  fails([](PadGeometry& g) { g.clearance = -1e-4; });
  fails([](PadGeometry& g) { g.preload = 1; });
  fails([](PadGeometry& g) { g.preload = -0.1; });
  fails([](PadGeometry& g) { g.arc = 0; });
  fails([](PadGeometry& g) { g.arc = 7; });
  fails([](PadGeometry& g) { g.offset = 1.1; });
  fails([](PadGeometry& g) { g.radius = 0; });
  fails([](PadGeometry& g) { g.length = -1; });
  fails([](PadGeometry& g) { g.thickness = -1; });
  // a pivot at the start of its pad: no pressure balances there, the pad gives way until it carries
  // nothing
  LateralMotion m;
  m.r = Vec2(0.5e-4, 0);
  m.v.setZero();
  m.spin = 300;
  const auto load = [&](const TiltingPad& p) {
    return p.standing(m, Vec2(p.settled_tilt(m), 0)).load;
  };
  PadGeometry tipped = good;
  tipped.offset = 0;
  EXPECT_LT(load(make_tilting_pad(tipped)), 1e-5 * load(make_tilting_pad(good)));
}
