// Films on a grid in both directions: closed forms of recesses, an independent solution, slopes, power.
#include "conformance.hpp"
#include <core/error.hpp>
#include <elements/films/finite_journal.hpp>

namespace grid_film_tests {

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

constexpr double degree = pi / 180;
constexpr double eta = 0.02, Omega = 300, R = 0.05, c = 1e-4;

/// A pad without leakage at its sides: R/L next to nothing. Its rows stand at one pressure, but for the
/// side itself, which is at that of the surroundings and stands for 1/12 of the length with four rows.
constexpr double endless = 1e-4, side_share = 1.0 / 12, inside = 1.0 - side_share;

GridLoad load(const GridPad& pad, const GridDrive& in) {
  GridLoad out;
  pad.load(in, out);
  return out;
}

/// In steady rotation at 1 rad/s twice over: S = 1.
GridDrive turning(const Vec2& e) {
  GridDrive in;
  in.e = e;
  in.source = Vec3(e.y(), -e.x(), 1.0);
  return in;
}

std::vector<Recess> dam() { return {{0.0, 125 * degree, 2.0, 2.0, 5.0 / 7, false}}; }
std::vector<Recess> track() { return {{0.0, 160 * degree, 0.0, 0.0, 1.5 / 7, true}}; }

/// Reynolds' equation of a pad from `start` with one recess by projected over-relaxation on corners of a
/// uniform grid, half the length; h at midpoints of its edges.
class CornerGrid {
 public:
  CornerGrid(double start, double arc, double ratio, const Recess& r, const GridDrive& in, int N,
             int M)
      : start_(start),
        N_(N),
        M_(M),
        step_(arc / N),
        P_(static_cast<std::size_t>((N + 1) * (M + 1)), 0.0) {
    const double across = 0.5 / M;  // of the length
    const auto depth = [&](double theta, double z) {
      if (theta < r.from || theta > r.to || 2 * z > r.width) return 0.0;
      return r.depth_from + (r.depth_to - r.depth_from) * (theta - r.from) / (r.to - r.from);
    };
    const auto circle = [&](double theta) {
      return 1.0 - in.e.x() * std::cos(start + theta) - in.e.y() * std::sin(start + theta);
    };
    const auto cube = [&](double theta, double z) {
      return std::pow(circle(theta) + depth(theta, z), 3);
    };
    double change = 1, top = 0;
    for (int sweep = 0; sweep < 20000 && change > 1e-9 * top; ++sweep) {
      change = 0;
      for (int i = 1; i < N; ++i)
        for (int k = 0; k < M; ++k) {
          const double theta = i * step_, z = k * across, tiny = 1e-9;
          // halves of the faces, so that steps in the surface may lie on corners
          const auto face = [&](double at) {
            return 0.5 * (cube(at, z + 0.5 * across) + cube(at, std::abs(z - 0.5 * across)));
          };
          const auto side = [&](double at) {
            return 0.5 * (cube(theta + tiny, at) + cube(theta - tiny, at));
          };
          const auto carried = [&](double at) {
            return 0.5 * (depth(at, z + 0.5 * across) + depth(at, std::abs(z - 0.5 * across)));
          };
          const double west = face(theta - 0.5 * step_) / (step_ * step_),
                       east = face(theta + 0.5 * step_) / (step_ * step_);
          const double unit = ratio * ratio / (across * across);
          const double up = unit * side(z + 0.5 * across),
                       down = unit * side(std::abs(z - 0.5 * across));
          const double n =
              in.source[0] * std::cos(start + theta) + in.source[1] * std::sin(start + theta);
          const double source =
              n -
              in.source[2] * (carried(theta + 0.5 * step_) - carried(theta - 0.5 * step_)) / step_;
          const double sum = west * at(i - 1, k) + east * at(i + 1, k) + up * at(i, k + 1) +
                             down * at(i, k == 0 ? 1 : k - 1) + source;
          double& p = at(i, k);
          const double next = std::max(0.0, p + 1.9 * (sum / (west + east + up + down) - p));
          change = std::max(change, std::abs(next - p));
          top = std::max(top, next);
          p = next;
        }
    }
  }
  Vec2 load() const {
    Vec2 sum = Vec2::Zero();
    for (int i = 0; i <= N_; ++i) {
      double line = 0;
      for (int k = 0; k < M_; ++k)
        line += (k == 0 ? 0.5 : 1.0) * P_[index(i, k)] / M_;
      const double theta = start_ + i * step_;
      sum += line * step_ * Vec2(std::cos(theta), std::sin(theta));
    }
    return sum;
  }

 private:
  std::size_t index(int i, int k) const { return static_cast<std::size_t>(i * (M_ + 1) + k); }
  double& at(int i, int k) { return P_[index(i, k)]; }
  double start_;
  int N_, M_;
  double step_;
  std::vector<double> P_;
};

FiniteJournal on_grid(const std::vector<JournalPad>& pads, double L, int columns,
                      const std::vector<std::vector<Recess>>& recesses, double preload = 0.0) {
  FiniteJournal film{R, L, eta, std::make_shared<JournalSurface>(c, preload, pads)};
  std::vector<GridPad> grid;
  for (std::size_t k = 0; k < film.surface->arcs().size(); ++k) {
    const JournalSurface::Arc& arc = film.surface->arcs()[k];
    const int own = static_cast<int>(std::lround(columns * arc.length / two_pi));
    grid.emplace_back(arc.start, arc.length, arc.round, R / L, own, 6,
                      k < recesses.size() ? recesses[k] : std::vector<Recess>{});
  }
  film.grid = std::make_shared<const std::vector<GridPad>>(std::move(grid));
  film.leakage = film.source = 12.0;
  return film;
}

FiniteJournal dam_bearing(int columns = 240) {
  std::vector<Recess> pocket = dam(), relief = track();
  for (Recess& r : pocket)
    r.depth_from = r.depth_to = 2 * c;
  return on_grid(two_groove_pads(0.0, 20 * degree), 0.07, columns, {pocket, relief});
}

FilmForce force(const FiniteJournal& b, const Vec2& r, const Vec2& v, double spin) {
  LateralMotion m;
  m.r = r;
  m.v = v;
  m.spin = spin;
  FilmForce f;
  b.evaluate(FilmLaw<FiniteJournal>::point(m), f);
  return f;
}

}  // namespace

TEST(GridFilm, AStepOfAnEndlessPadHasRayleighsPressure) {
  // Lord Rayleigh, Phil. Mag. 35 (1918) 1: the flow of both parts is the same
  const double arc = 1.2, to = 0.8, depth = 0.7;
  const GridPad pad(0.3, arc, false, endless, 60, 4, {{0.0, to, depth, depth, 1.0, false}});
  GridDrive in;
  in.source[2] = 1.0;
  const GridField f = pad.field(in);
  const double top = depth / (std::pow(1.0 + depth, 3) / to + 1.0 / (arc - to));
  const double highest = *std::max_element(f.largest.begin(), f.largest.end());
  EXPECT_NEAR(highest, top, 0.03 * top);  // half a cell beside the step
  // the load is that of two straight lines: their moments against n, exact but for the mean over cells
  Vec2 sum = Vec2::Zero();
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double at = arc * (i + 0.5) / n;
    const double P = at < to ? top * at / to : top * (arc - at) / (arc - to);
    sum += P * arc / n * Vec2(std::cos(0.3 + at), std::sin(0.3 + at));
  }
  const GridLoad z = load(pad, in);
  EXPECT_LT((z.z.head<2>() - inside * sum).norm(), 2e-4 * sum.norm());
  // moment of the pressure on the step
  EXPECT_NEAR(z.z[2], inside * depth * top, 1e-6 * depth * top);
}

TEST(GridFilm, ATaperOfAnEndlessPadIsExact) {
  const double arc = 1.0, to = 0.6, depth = 1.5;
  const GridPad pad(-0.2, arc, false, endless, 50, 4, {{0.0, to, depth, 0.0, 1.0, false}});
  GridDrive in;
  in.source[2] = 1.0;
  // q = (int D/h^3)/(int 1/h^3), P = int (D - q)/h^3
  double top = 0, bottom = 0;
  const int n = 200000;
  const auto D = [&](double at) { return at < to ? depth * (1.0 - at / to) : 0.0; };
  for (int i = 0; i < n; ++i) {
    const double at = arc * (i + 0.5) / n, h = 1.0 + D(at);
    top += D(at) / (h * h * h);
    bottom += 1.0 / (h * h * h);
  }
  const double q = top / bottom;
  Vec2 sum = Vec2::Zero();
  double P = 0;
  for (int i = 0; i < n; ++i) {
    const double at = arc * (i + 0.5) / n, h = 1.0 + D(at), slope = (D(at) - q) / (h * h * h);
    sum += (P + 0.5 * slope * arc / n) * arc / n * Vec2(std::cos(at - 0.2), std::sin(at - 0.2));
    P += slope * arc / n;
  }
  EXPECT_LT((load(pad, in).z.head<2>() - inside * sum).norm(), 1e-3 * sum.norm());
  const GridField f = pad.field(in);
  for (std::size_t k = 0; k < f.flow.size(); ++k) {  // past the circle (S c = 1) and the taper
    const double flow = f.flow[k] - side_share * (1.0 + D(f.face_place[k]));
    EXPECT_NEAR(flow, inside * (1.0 + q), 5e-3 * (1.0 + q)) << k;
  }
}

TEST(GridFilm, AgainstAnotherSolutionOnCorners) {
  struct Case {
    double start;
    Recess recess;
    Vec2 e;
  };
  const Recess none{0.0, 160 * degree, 0.0, 0.0, 1.0, false};
  for (const Case& k :
       {Case{10 * degree, {0.0, 120 * degree, 2.0, 2.0, 0.75, false}, {0.3, -0.4}},
        Case{10 * degree, {0.0, 120 * degree, 1.0, 0.0, 1.0, false}, {0.1, 0.3}},
        Case{190 * degree, none, {0.4, -0.5}},
        Case{190 * degree, {0.0, 80 * degree, 0.8, 0.2, 0.5, false}, {0.4, -0.5}}}) {
    const GridDrive in = turning(k.e);
    const CornerGrid other(k.start, 160 * degree, 0.7, k.recess, in, 160, 24);
    const GridPad pad(k.start, 160 * degree, false, 0.7, 107, 6, {k.recess});
    const Vec2 exact = other.load(), got = load(pad, in).z.head<2>();
    EXPECT_LT((got - exact).norm(), 1e-2 * exact.norm()) << k.start << ' ' << k.e.transpose();
  }
}

TEST(GridFilm, ShortPadsAreThoseOfTheProfile) {
  const std::vector<JournalPad> pads = two_groove_pads(0.4, 20 * degree);
  for (const double L : {0.01, 0.02}) {
    const FiniteJournal grid = on_grid(pads, L, 240, {});
    const FiniteJournal profile{R, L, eta, std::make_shared<JournalSurface>(c, 0.0, pads)};
    const Vec2 r = c * Vec2(0.3, -0.4), v = c * Omega * Vec2(0.1, 0.2);
    const FilmForce a = force(grid, r, v, Omega), b = force(profile, r, v, Omega);
    EXPECT_LT((a.F - b.F).norm(), 1.2e-2 * (L / 0.02) * b.F.norm()) << L;
    EXPECT_NEAR(a.T, b.T, 1e-4 * std::abs(b.T));
  }
}

TEST(GridFilm, FullFilmsHaveSlopesToRounding) {
  ConformanceOptions o = film_options(c, Omega);
  o.tangent_tolerance = 1e-7;
  o.samples = 3;
  o.q0.assign(12, 0.0);
  o.v0.assign(12, 0.0);
  o.v0[3] = Omega;
  o.v0[9] = 20;
  o.q0[1] = 0.35 * c;
  o.q0[2] = -0.25 * c;
  FiniteJournal film = dam_bearing(60);
  film.supply_pressure = 1e8;  // ruptures nowhere but at the free sides
  check_kernel(FiniteJournalBearing{{film}}, o);
  film.turbulent_density = 900;
  check_kernel(FiniteJournalBearing{{film}}, o);
}

// A viscosity that is everywhere exp(a) times another is one of reference so much larger.
TEST(GridFilm, ViscosityAlongThePad) {
  for (const double density : {0.0, 900.0}) {
    FiniteJournal film = dam_bearing(60);
    film.turbulent_density = density;
    FiniteJournal thin = film;
    thin.viscosity = film.viscosity * std::exp(-0.4);
    film.kept_from = 0;
    film.knots = 5;
    std::vector<double> kept(2 * 7, 0.0);
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (i % 7 >= 2) kept[i] = -0.4;
    FilmPoint p{c * Vec2(0.3, -0.4), c * Omega * Vec2(0.1, 0.2), Omega};
    FilmForce a, b;
    thin.evaluate(p, a);
    p.kept = kept.data();
    film.evaluate(p, b);
    EXPECT_LT((a.F - b.F).norm(), 1e-10 * a.F.norm());
    EXPECT_NEAR(a.T, b.T, 1e-10 * std::abs(a.T));
    // thinner towards the end of the pads; slopes of a full film are those of its force
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (i % 7 >= 2) kept[i] = -0.15 * static_cast<double>(i % 7 - 2);
    film.supply_pressure = 1e8;
    FilmTangent t;
    film.evaluate(p, a, t);
    const double h = 1e-6 * c;
    for (int k = 0; k < 2; ++k) {
      FilmPoint q = p;
      q.r[k] = p.r[k] + h;
      film.evaluate(q, a);
      q.r[k] = p.r[k] - h;
      film.evaluate(q, b);
      EXPECT_LT(((a.F - b.F) / (2 * h) - t.F_r.col(k)).norm(), 1e-6 * t.F_r.norm());
      EXPECT_NEAR((a.T - b.T) / (2 * h), t.T_r[k], 1e-5 * t.T_r.norm());
    }
  }
}

/// Slopes of a film for a journal at e, of its clearance, and the same by differences of its force.
struct SlopesTwice {
  LateralTangent own;
  Mat2 K, C;
};
/// of_four: differences of fourth order; h: their step, of the clearance.
SlopesTwice slopes_twice(const FiniteJournal& film, const Vec2& e, double h, bool of_four) {
  SlopesTwice out;
  LateralMotion m;
  m.r = c * e;
  m.v.setZero();
  m.spin = Omega;
  Vector<4> z;
  out.own.set_zero();
  FilmLaw<FiniteJournal>{film}.tangent(m, z, out.own);
  for (Index k = 0; k < 2; ++k) {
    const auto difference = [&](double dr, double dv) {
      Vec2 r = Vec2::Zero(), v = Vec2::Zero();
      r[k] = dr;
      v[k] = dv;
      return Vec2(force(film, m.r + r, v, Omega).F - force(film, m.r - r, -v, Omega).F);
    };
    const auto slope = [&](double dr, double dv) {
      const double step = 2.0 * (dr + dv);
      if (!of_four) return Vec2(difference(dr, dv) / step);
      return Vec2((8.0 * difference(dr, dv) - difference(2.0 * dr, 2.0 * dv)) / (6.0 * step));
    };
    out.K.col(k) = slope(h * c, 0.0);
    out.C.col(k) = slope(0.0, h * c * Omega);
  }
  return out;
}

TEST(GridFilm, RupturedFilmsHaveTheSlopesOfFinerOnes) {
  // differences over a step in which many cells dry, against slopes at its middle
  const FiniteJournal film = dam_bearing();
  for (const Vec2& e : {Vec2(0.3, -0.4), Vec2(0.5, -0.45), Vec2(-0.1, -0.2)}) {
    const auto [own, K, C] = slopes_twice(film, e, 0.02, true);
    EXPECT_LT((own.r.topRows<2>() - K).norm(), 1e-2 * K.norm()) << e.transpose();
    EXPECT_LT((own.v.topRows<2>() - C).norm(), 1e-2 * C.norm()) << e.transpose();
  }
}

TEST(GridFilm, CoefficientsAreConverged) {
  // the default grid against twice as fine a one: 0.5 % in nine of ten places
  Random random(7);
  int far = 0, looked = 0;
  for (int n = 0; n < 20; ++n) {
    const Vec2 at = random.vector<2>();
    const Vec2 r = 0.8 * c * at / std::max(1.0, at.norm());
    const auto tangent = [&](const FiniteJournal& film) {
      FilmForce f;
      FilmTangent t;
      LateralMotion m;
      m.r = r;
      m.v.setZero();
      m.spin = Omega;
      film.evaluate(FilmLaw<FiniteJournal>::point(m), f, t);
      return t;
    };
    const FilmTangent own = tangent(dam_bearing()), fine = tangent(dam_bearing(480));
    const double apart = std::max((own.F_r - fine.F_r).norm() / fine.F_r.norm(),
                                  (own.F_w - fine.F_w).norm() / fine.F_w.norm());
    ++looked;
    far += apart > 5e-3 ? 1 : 0;
    EXPECT_LT(apart, 2e-2) << r.transpose() / c;
  }
  EXPECT_LE(10 * far, looked);
}

TEST(GridFilm, RoundFilmsAreSmoothInEveryDirection) {
  const FiniteJournal film = on_grid({}, 0.07, 240, {});
  double least = infinity, most = 0;
  for (int k = 0; k < 40; ++k) {
    const double angle = 0.1 + 0.011 * k;
    const Vec2 n(std::cos(angle), std::sin(angle));
    const double F = force(film, 0.6 * c * n, Vec2::Zero(), Omega).F.norm();
    least = std::min(least, F);
    most = std::max(most, F);
  }
  EXPECT_LT(most / least - 1.0, 1e-4);
}

/// Of the force of a journal at e, turned from `from` to `to` against its grid: the largest part that
/// comes again with the cells, over the force. What a mean over a cell keeps is not of the grid.
double trace_of_grid(const FiniteJournal& film, double e, double from, double to) {
  constexpr int a_cell = 10, half = a_cell / 2;
  const JournalSurface::Arc& arc = film.surface->arcs()[0];
  const double step = arc.length / (*film.grid)[0].columns() / a_cell;
  std::vector<Vec2> F;  // along the eccentricity and across it
  for (double angle = from; angle < to; angle += step) {
    const Vec2 n(std::cos(angle), std::sin(angle)), t(-n.y(), n.x());
    const Vec2 f = force(film, e * c * n, Vec2::Zero(), Omega).F;
    F.emplace_back(f.dot(n), f.dot(t));
  }
  std::vector<Vec2> rest = F;
  for (int times = 0; times < 3; ++times) {
    std::vector<Vec2> less;
    for (std::size_t k = half; k + half < rest.size(); ++k) {
      Vec2 sum = 0.5 * (rest[k - half] + rest[k + half]);
      for (std::size_t i = k - half + 1; i < k + half; ++i)
        sum += rest[i];
      less.push_back(rest[k] - sum / a_cell);
    }
    rest = less;
  }
  double worst = 0.0;
  for (std::size_t k = 0; k < rest.size(); ++k)
    worst = std::max(worst, rest[k].norm() / F[k + 3 * half].norm());
  return worst;
}

TEST(GridFilm, ForcesShowNoGrid) {
  const FiniteJournal round = on_grid({}, 0.07, 240, {}),
                      split = on_grid(two_groove_pads(0.0, 20 * degree), 0.07, 240, {}),
                      lobes = on_grid(lobe_pads(3, 0.5 * pi, 20 * degree), 0.05, 240, {}, 0.5);
  for (const double e : {0.3, 0.6, 0.85, 0.9}) {
    EXPECT_LT(trace_of_grid(round, e, 0.1, 0.25), 2e-5) << e;
    EXPECT_LT(trace_of_grid(lobes, e, 110 * degree, 130 * degree), 2e-5) << e;
    EXPECT_LT(trace_of_grid(split, e, 60 * degree, 80 * degree), 1e-4) << e;
  }
  // where the film is shortest, a few cells behind a groove
  EXPECT_LT(trace_of_grid(split, 0.85, 20 * degree, 40 * degree), 1e-4);
}

TEST(GridFilm, RupturedFilmsHaveTheirOwnSlopes) {
  const FiniteJournal film = dam_bearing(120);
  for (const Vec2& e : {Vec2(0.3, -0.4), Vec2(0.5, -0.45), Vec2(-0.1, -0.2)}) {
    const auto [own, K, C] = slopes_twice(film, e, 1e-6, false);
    for (Index k = 0; k < 2; ++k) {
      EXPECT_LT((own.r.col(k).head<2>() - K.col(k)).norm(), 1e-6 * own.r.norm()) << e.transpose();
      EXPECT_LT((own.v.col(k).head<2>() - C.col(k)).norm(), 1e-6 * own.v.norm()) << e.transpose();
    }
  }
}

TEST(GridFilm, AMirroredBearingTurnsTheOtherWay) {
  // y -> -y: the pocket begins at the other end of its pad
  std::vector<Recess> pocket = dam();
  for (Recess& r : pocket) {
    r.depth_from = r.depth_to = 2 * c;
    const double arc = 160 * degree, from = r.from;
    r.from = arc - r.to;
    r.to = arc - from;
  }
  const FiniteJournal mirrored =
      on_grid(two_groove_pads(0.0, 20 * degree), 0.07, 240, {pocket, track()});
  const FilmForce a = force(dam_bearing(), c * Vec2(0.4, -0.3), c * Omega * Vec2(0.1, 0.2), Omega);
  const FilmForce b = force(mirrored, c * Vec2(-0.4, -0.3), c * Omega * Vec2(-0.1, 0.2), -Omega);
  EXPECT_LT((a.F - Vec2(-b.F.x(), b.F.y())).norm(), 1e-9 * a.F.norm());
  EXPECT_NEAR(a.T, -b.T, 1e-9 * std::abs(a.T));
}

TEST(GridFilm, WhatIsLostIsShearAndPressure) {
  // power of the nodes and of the pump is never negative, and at rest without a pump nothing moves
  Random random(3);
  FiniteJournal film = dam_bearing(120);
  for (int n = 0; n < 40; ++n) {
    film.supply_pressure = n % 2 == 0 ? 0.0 : 5e5;
    const FilmPoint p{0.6 * c * random.vector<2>() / 1.5, c * Omega * random.vector<2>(),
                      Omega * random.vector<1>()[0]};
    FilmForce f;
    film.evaluate(p, f);
    ASSERT_TRUE(f.F.allFinite());
    EXPECT_GE(f.pump - (f.F.dot(p.w) + f.T * p.slip), 0.0);
  }
  // the pump alone, at rest: p_s times the flow through the sides
  film.supply_pressure = 5e5;
  FilmForce f;
  film.evaluate({Vec2::Zero(), Vec2::Zero(), 0.0}, f);
  double side = 0;
  for (std::size_t k = 0; k < 2; ++k)
    side += (*film.grid)[k].field(film.drive(k, {Vec2::Zero(), Vec2::Zero(), 0.0})).side;
  EXPECT_NEAR(f.pump, 5e5 * side * R * film.length, 1e-9 * f.pump);
}

TEST(GridFilm, RecessesThatCannotBeAreRefused) {
  const auto make = [](const Recess& r) { GridPad(0.0, 1.0, false, 1.0, 40, 6, {r}); };
  EXPECT_THROW(make({0.0, 1.2, 1.0, 1.0, 0.5, false}), Error);
  EXPECT_THROW(make({0.5, 0.4, 1.0, 1.0, 0.5, false}), Error);
  EXPECT_THROW(make({0.0, 0.4, -1.0, 1.0, 0.5, false}), Error);
  EXPECT_THROW(make({0.0, 0.4, 1.0, 1.0, 1.5, false}), Error);
  EXPECT_NO_THROW(make({0.0, 0.4, 1.0, 1.0, 0.97, false}));
}

}  // namespace grid_film_tests
