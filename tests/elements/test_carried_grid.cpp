// Films on a grid along the axis whose oil is followed: balance of the oil, equilibria and small motions
// against the film of the momentary state, one row against the axial profile, squeeze between plates in
// closed form, whirl against another discretisation, tangents and power.
#include <la/dense.hpp>
#include "conformance.hpp"
#include <core/dual.hpp>
#include <elements/films/carried_oil.hpp>
#include <elements/films/tilting_cells.hpp>
#include <random>

namespace carried_grid_tests {

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;
using carried_oil::neighbour;

namespace {

constexpr double c = 1e-4, eta = 0.02, Omega = 300, R = 0.05;
constexpr double deg = pi / 180;

/// A bearing of two pads with recesses[k] of pad k; columns of each for the film of the momentary state.
FiniteJournal film_with(const std::vector<std::vector<Recess>>& recesses, double L = 0.05,
                        double supply = 0.0, int columns = 60, int rows = 6) {
  const std::vector<JournalPad> pads = two_groove_pads(0.0, 20 * deg);
  FiniteJournal film{R, L, eta, std::make_shared<JournalSurface>(c, 0.0, pads, 72)};
  film.source = film.leakage = 12.0;
  film.mass_conserving = true;
  film.supply_pressure = supply;
  std::vector<GridPad> grid;
  for (std::size_t k = 0; k < 2; ++k) {
    const JournalSurface::Arc& arc = film.surface->arcs()[k];
    grid.emplace_back(arc.start, arc.length, false, R / L, columns, rows,
                      k < recesses.size() ? recesses[k] : std::vector<Recess>{});
  }
  film.grid = std::make_shared<const std::vector<GridPad>>(std::move(grid));
  return film;
}
const std::vector<std::vector<Recess>> plain{};
/// A pocket behind the first groove, a relief track in the other pad.
const std::vector<std::vector<Recess>> dam{{{0.0, 120 * deg, 2e-4, 2e-4, 0.75, false}},
                                           {{0.0, 160 * deg, 0.0, 0.0, 0.25, true}}};
const std::vector<std::vector<Recess>> tapers{{{0.0, 80 * deg, 6e-5, 0.0, 0.8, false}},
                                              {{0.0, 80 * deg, 6e-5, 0.0, 0.8, false}}};

LateralMotion moving_at(const Vec2& r, const Vec2& v = Vec2::Zero(), double spin = Omega) {
  LateralMotion m;
  m.r = r;
  m.v = v;
  m.a.setZero();
  m.spin = spin;
  return m;
}
FilmPoint point_at(const Vec2& r, const Vec2& v = Vec2::Zero(), double spin = Omega) {
  return FilmLaw<FiniteJournal>::point(moving_at(r, v, spin));
}
Vec2 place(double eccentricity, double angle) {
  return eccentricity * c * Vec2(std::cos(angle), std::sin(angle));
}

template <class T>
std::array<T, 5> around(const CarriedGrid& pad, Index i, Index j, const std::vector<T>& content) {
  std::array<T, 5> out;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const Index other = neighbour(pad, i, j, CarriedGrid::steps[k]);
    out[k] = content[at(other < 0 ? i * pad.rows() + j : other)];
  }
  return out;
}
CarriedGrid::Cell<double> cell_of(const CarriedGrid& pad, Index i, Index j, const Vec2& r,
                                  double slip, const std::vector<double>& content) {
  return pad.cell(i, j, r.x(), r.y(), slip, around(pad, i, j, content));
}

/// Force on the journal, torque and pump (FilmForce) of a pad with its oil.
void add_pad(const CarriedGrid& pad, const std::vector<double>& content, const Vec2& r, double spin,
             FilmForce& f) {
  for (Index i = 0; i < pad.cells(); ++i) {
    double fed = 0.0;
    for (Index j = 0; j < pad.rows(); ++j) {
      const auto x = cell_of(pad, i, j, r, spin, content);
      const Vec2 push(x.push[0], x.push[1]);
      f.F -= push;
      f.T += pad.lever().dot(push) + x.drag;
      fed += x.fed;
    }
    f.pump += pad.pump(i, fed, point_at(r, Vec2::Zero(), spin));
  }
}
FilmForce in_balance(const FiniteJournal& film, const Vec2& r, int columns, int rows,
                     double spin = Omega) {
  FilmForce f{Vec2::Zero(), 0.0, 0.0};
  for (std::size_t k = 0; k < 2; ++k) {
    const CarriedGrid pad(film, k, columns, rows);
    const std::vector<double> content = pad.balanced(r, spin);
    EXPECT_TRUE(std::isfinite(content.front()));
    add_pad(pad, content, r, spin, f);
  }
  return f;
}

/// One pad whose journal is moved: implicit Euler for the oil.
class Moved {
 public:
  Moved(const CarriedGrid& pad, const Vec2& r) : pad_(pad), at_(r) {
    for (Index i = 0; i < pad.cells(); ++i)
      for (Index j = 0; j < pad.rows(); ++j)
        content.push_back(pad.gap(i, j, r));
  }
  /// As CarriedFilm's: one step, or two halves of it; counts what comes in and passes, m rad.
  void step(double dt, const Vec2& r, double slip, int halved = 0) {
    const std::vector<double> old = content;
    if (!pad_.advance(r, slip, 1.0 / dt, content)) {
      ASSERT_LT(halved, 12);
      content = old;
      step(0.5 * dt, 0.5 * (r + at_), slip, halved + 1);
      step(0.5 * dt, r, slip, halved + 1);
      return;
    }
    at_ = r;
    const Index last = pad_.cells() - 1;
    for (Index i = 0; i <= last; ++i)
      for (Index j = 0; j < pad_.rows(); ++j) {
        const auto x = cell_of(pad_, i, j, r, slip, content);
        if (i == 0) entered += dt * pad_.share(j) * x.in;
        if (i == last) entered -= dt * pad_.share(j) * x.out;
        if (j == 0) entered += dt * x.inner;
        if (j == pad_.rows() - 1) entered -= dt * x.outer;
        passed += dt * pad_.share(j) * (std::abs(x.in) + std::abs(x.out));
      }
  }
  double held() const {
    double sum = 0.0;
    for (Index i = 0; i < pad_.cells(); ++i)
      for (Index j = 0; j < pad_.rows(); ++j)
        sum += content[at(i * pad_.rows() + j)] * pad_.width(i) * pad_.share(j);
    return sum;
  }
  double least_share(const Vec2& r) const {
    double least = infinity;
    for (Index i = 0; i < pad_.cells(); ++i)
      for (Index j = 0; j < pad_.rows(); ++j)
        least = std::min(least, content[at(i * pad_.rows() + j)] / pad_.gap(i, j, r));
    return least;
  }
  FilmForce force(const Vec2& r, double slip) const {
    FilmForce f{Vec2::Zero(), 0.0, 0.0};
    add_pad(pad_, content, r, slip, f);
    return f;
  }
  std::vector<double> content;
  double entered = 0, passed = 0;

 private:
  const CarriedGrid& pad_;
  Vec2 at_;
};

}  // namespace

// Oil in balance is the film of the momentary state, to the second order of the cells: force, torque and
// pump of 20 columns a pad and six rows, as in time, and of twice as many in both directions.
TEST(CarriedGrid, EquilibriumOfTheMomentaryState) {
  for (const auto* recesses : {&plain, &dam, &tapers})
    for (const double supply : {0.0, 2e5})
      for (const Vec2& r : {place(0.3, -60 * deg), place(0.7, -80 * deg), place(0.6, 40 * deg)}) {
        const FiniteJournal film = film_with(*recesses, 0.05, supply, 240, 10);
        FilmForce exact;
        film.evaluate(point_at(r), exact);
        const FilmForce cells = in_balance(film, r, 20, 6), fine = in_balance(film, r, 40, 12);
        // above, the only film lies behind a ruptured stretch
        const double most = r.y() > 0.0 ? 0.055 : 0.02;
        EXPECT_LT((cells.F - exact.F).norm(), most * exact.F.norm());
        EXPECT_LT((fine.F - exact.F).norm(), 0.3 * most * exact.F.norm() + 2e-3 * exact.F.norm());
        EXPECT_NEAR(cells.T, exact.T, 7e-3 * std::abs(exact.T));
        EXPECT_NEAR(cells.pump, exact.pump, 5e-3 * std::abs(exact.T * Omega));
        EXPECT_NEAR(fine.pump, exact.pump, 2.5e-3 * std::abs(exact.T * Omega));
      }
}

// A bearing and its mirror image turn opposite ways.
TEST(CarriedGrid, TurnsTheOtherWay) {
  std::vector<std::vector<Recess>> mirrored = dam;
  mirrored[0][0].from = 40 * deg;
  mirrored[0][0].to = 160 * deg;
  const Vec2 r = place(0.5, -70 * deg);
  const FilmForce f = in_balance(film_with(dam, 0.05, 1e5), r, 20, 6);
  const FilmForce g =
      in_balance(film_with(mirrored, 0.05, 1e5), Vec2(-r.x(), r.y()), 20, 6, -Omega);
  EXPECT_NEAR(f.F.x(), -g.F.x(), 1e-6 * f.F.norm());
  EXPECT_NEAR(f.F.y(), g.F.y(), 1e-6 * f.F.norm());
  EXPECT_NEAR(f.T, -g.T, 1e-6 * std::abs(f.T));
}

// One row has the parabola along the axis: cell for cell the film of the axial profile, with the mean
// over the length for its weight.
TEST(CarriedGrid, OneRowIsTheProfile) {
  FiniteJournal film = film_with(plain, 0.06, 1e5);
  film.turbulent_density = 900;
  const CarriedGrid grid(film, 1, 36, 1);
  film.grid = nullptr;
  const CarriedPad profile(film, 1);
  ASSERT_EQ(profile.cells(), 36);
  const Vec2 r = place(0.6, -40 * deg);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0.6, 1.0004);
  std::vector<double> content;
  for (Index i = 0; i < 36; ++i)
    content.push_back(share(random) * profile.gap(i, r));
  for (Index i = 0; i < 36; ++i) {
    const auto a = cell_of(grid, i, 0, r, Omega, content);
    const auto b = profile.cell(i, r.x(), r.y(), Omega, content[at(std::max<Index>(i - 1, 0))],
                                content[at(i)], content[at(std::min<Index>(i + 1, 35))]);
    EXPECT_NEAR(a.outflow, b.outflow, 1e-11 * Omega * R);
    EXPECT_NEAR(a.outer, b.sides, 1e-11 * Omega * R);
    EXPECT_NEAR(a.push[0], b.push[0], 1e-11 * std::abs(b.push[0]));
    EXPECT_NEAR(a.push[1], b.push[1], 1e-11 * std::abs(b.push[1]));
    EXPECT_NEAR(a.drag, b.drag, 1e-12 * std::abs(b.drag));
    EXPECT_NEAR(a.fed, b.fed, 1e-11 * Omega * R);
  }
}

// What leaves a cell enters its neighbour, and over a motion through rupture and refilling the oil held
// is what came in less what left, to rounding: pocket, track.
TEST(CarriedGrid, OilIsConserved) {
  const FiniteJournal film = film_with(dam, 0.05, 5e4);
  for (const std::size_t k : {0, 1}) {
    const CarriedGrid pad(film, k, 16, 6);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.6, 1.0002);
    const Vec2 r = place(0.5, -80 * deg);
    std::vector<double> content;
    for (Index i = 0; i < pad.cells(); ++i)
      for (Index j = 0; j < pad.rows(); ++j)
        content.push_back(share(random) * pad.gap(i, j, r));
    for (Index i = 0; i + 1 < pad.cells(); ++i)
      for (Index j = 0; j + 1 < pad.rows(); ++j) {
        const auto own = cell_of(pad, i, j, r, Omega, content);
        EXPECT_EQ(own.out, cell_of(pad, i + 1, j, r, Omega, content).in);
        EXPECT_EQ(own.outer, cell_of(pad, i, j + 1, r, Omega, content).inner);
      }
    Moved moved(pad, place(0.2, 0.0));
    const double begun = moved.held();
    double least = infinity;
    constexpr int steps = 300;
    for (int s = 1; s <= steps; ++s) {
      const Vec2 now = place(0.2 + 0.6 * s / steps, 4.0 * pi * s / steps);
      moved.step(4.0 * pi / Omega / steps, now, Omega);  // as an unbalance whirls
      least = std::min(least, moved.least_share(now));
    }
    EXPECT_LT(least, 0.95);  // it did rupture
    EXPECT_NEAR(moved.held() - begun, moved.entered, 1e-11 * moved.passed);
  }
}

namespace {

/// int p over plates of the lengths a and b that come near at V, full film, ambient pressure around:
/// the torsion function of a rectangle, N.
double squeezed(double a, double b, double h, double V) {
  double sum = 0.0;
  for (int n = 1; n < 200; n += 2)
    sum += std::tanh(0.5 * n * pi * b / a) / std::pow(n, 5);
  const double whole = 1.0 - 192.0 / std::pow(pi, 5) * (a / b) * sum;
  return eta * V / (h * h * h) * b * a * a * a * whole;
}

}  // namespace

// A pad so narrow that it is plane, of several widths: the series of two plates, to the second order.
TEST(CarriedGrid, SqueezeBetweenPlatesOfFiniteWidth) {
  constexpr double arc = 0.02, radius = 2.5, V = 1e-3, h = 5e-5;
  for (const double L : {0.02, 0.05, 0.15}) {
    double off[2];
    for (const int fine : {0, 1}) {
      const std::vector<JournalPad> pads{{-0.5 * arc, 0.5 * arc, 0.0}};
      FiniteJournal film{radius, L, eta, std::make_shared<JournalSurface>(c, 0.0, pads, 36)};
      film.source = film.leakage = 12.0;
      film.mass_conserving = true;
      const CarriedGrid pad(film, 0, fine ? 24 : 12, fine ? 6 : 3);
      constexpr int steps = 40;
      constexpr double dt = 5e-6;  // in all ten times what the oil takes to be compressed
      const auto journal = [&](int k) { return Vec2(c - h - V * dt * (steps - k), 0.0); };
      Moved moved(pad, journal(0));
      for (int k = 1; k <= steps; ++k)
        moved.step(dt, journal(k), 0.0);
      const double load = -moved.force(journal(steps), 0.0).F.x();
      off[fine] = load / squeezed(arc * radius, L, h, V) - 1.0;
    }
    EXPECT_LT(off[0], L > 0.1 ? 0.06 : 0.03);
    EXPECT_LT(off[1], 0.3 * off[0]);
  }
}

namespace {

/// Stiffness of journal and oil about an equilibrium for motions with exp(rate t), the oil eliminated.
Eigen::Matrix2cd dynamic_stiffness(const CarriedGrid& pad, const Vec2& r, Complex rate) {
  using All = Dual<8>;
  const std::vector<double> content = pad.balanced(r, Omega);
  const Index n = static_cast<Index>(content.size());
  MatX F_r = MatX::Zero(2, 2), F_m = MatX::Zero(2, n), O_r = MatX::Zero(n, 2),
       O_m = MatX::Zero(n, n);
  for (Index i = 0; i < pad.cells(); ++i)
    for (Index j = 0; j < pad.rows(); ++j) {
      const Index own = i * pad.rows() + j;
      const std::array<double, 5> q = around(pad, i, j, content);
      std::array<All, 5> local;
      for (std::size_t s = 0; s < 5; ++s)
        local[s] = All::variable(q[s], 3 + static_cast<int>(s));
      const auto x =
          pad.cell(i, j, All::variable(r.x(), 0), All::variable(r.y(), 1), All(Omega), local);
      for (Index a = 0; a < 2; ++a) {
        F_r.row(a) -= x.push[a].g.head<2>().transpose();
        F_m(a, own) -= x.push[a].g[4];
      }
      O_r.row(own) = x.outflow.g.head<2>().transpose();
      for (std::size_t s = 0; s < 5; ++s) {
        const Index other = neighbour(pad, i, j, CarriedGrid::steps[s]);
        if (other >= 0) O_m(own, other) += x.outflow.g[3 + static_cast<Index>(s)];
      }
    }
  MatXc A = O_m.cast<Complex>();
  A.diagonal().array() += rate;
  const MatXc follow = la::DenseLu<Complex>(A).solve(MatXc(O_r.cast<Complex>()));
  return F_m.cast<Complex>() * follow - F_r.cast<Complex>();
}
/// Of both pads.
Eigen::Matrix2cd dynamic_stiffness(const FiniteJournal& film, const Vec2& r, Complex rate,
                                   int columns, int rows) {
  Eigen::Matrix2cd Z = Eigen::Matrix2cd::Zero();
  for (const std::size_t k : {0, 1})
    Z += dynamic_stiffness(CarriedGrid(film, k, columns, rows), r, rate);
  return Z;
}
struct Coefficients {
  Mat2 K, C;
};
Coefficients of_momentary_state(const FiniteJournal& film, const Vec2& r) {
  Vector<4> z;
  LateralTangent t;
  FilmLaw<FiniteJournal>{film}.tangent(moving_at(r), z, t);
  return {-t.r.topRows<2>(), -t.v.topRows<2>()};
}

}  // namespace

// Small motions of journal and oil have stiffness and damping of the momentary state where a supply
// pressure keeps films full.
TEST(CarriedGrid, SmallMotionsOfTheMomentaryState) {
  for (const auto* recesses : {&dam, &tapers}) {
    const FiniteJournal film = film_with(*recesses, 0.05, 3e6, 240, 8);
    const Vec2 r = place(0.6, -50 * deg);
    const auto [K, C] = of_momentary_state(film, r);
    for (const double w : {0.05 * Omega, 0.5 * Omega})
      for (const int fine : {1, 2}) {
        const Eigen::Matrix2cd Z = dynamic_stiffness(film, r, Complex(0.0, w), 20 * fine, 6 * fine);
        EXPECT_LT((Z.real() - K).norm(), (fine == 1 ? 0.015 : 0.005) * K.norm());
        EXPECT_LT((Z.imag() / w - C).norm(), (fine == 1 ? 0.012 : 0.004) * C.norm());
      }
  }
}

// A film that begins behind a ruptured stretch is thicker or thinner by what its oil met there: slow motions
// have the stiffness of the momentary state, motions at the spin another, the same on a finer grid.
TEST(CarriedGrid, OilTakesTimeBehindARupturedStretch) {
  const FiniteJournal film = film_with(dam, 0.07, 0.0, 240, 12);
  const Vec2 r = place(0.569, -26.6 * deg);
  const auto [K, C] = of_momentary_state(film, r);
  const Complex slow(0.0, 0.02 * Omega), fast(0.0, Omega);
  EXPECT_LT((dynamic_stiffness(film, r, slow, 30, 6).real() - K).norm(), 0.02 * K.norm());
  const Eigen::Matrix2cd Z = dynamic_stiffness(film, r, fast, 30, 6);
  const Eigen::Matrix2cd fine = dynamic_stiffness(film, r, fast, 60, 12);
  EXPECT_GT((fine.real() - K).norm(), 0.15 * K.norm());
  EXPECT_LT((Z - fine).norm(), 0.03 * fine.norm());
}

namespace {

/// The film of one pad by another discretisation: pressures and shares at corners, whose edges of
/// recesses lie on corners, oil that knows no compression; p >= 0, share <= 1 and p (1 - share) = 0 by
/// relaxation at every step of implicit Euler (R. F. Ausas, M. Jai, G. C. Buscaglia, J. Tribol. 131,
/// 2009, doi 10.1115/1.3142903).
class CornerOil {
 public:
  CornerOil(double start, double arc, double L, const Recess& pocket, int columns, int rows)
      : start_(start),
        L_(L),
        pocket_(pocket),
        n_(columns + 1),
        m_(rows + 1),
        dx_(arc / columns),
        dz_(0.5 / rows),
        p_(at(n_ * m_), 0.0),
        share_(at(n_ * m_), 1.0),
        held_(at(n_ * m_)) {}
  void step(double dt, const Vec2& r) {
    set_gaps(r);
    if (held_[0] == 0.0) held_ = volume_;
    double change = 1.0;
    for (int pass = 0; change > 1e-6 && pass < 2000; ++pass) {
      change = 0.0;
      for (int i = 1; i + 1 < n_; ++i)
        for (int j = 0; j + 1 < m_; ++j)
          change = std::max(change, relax(i, j, dt));
    }
    for (std::size_t k = 0; k < held_.size(); ++k)
      held_[k] = share_[k] * volume_[k];
  }
  /// On the journal, N.
  Vec2 force() const {
    Vec2 F = Vec2::Zero();
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < m_; ++j) {
        const double angle = start_ + i * dx_, part = j == 0 || j == m_ - 1 ? 0.5 : 1.0;
        F -= 2.0 * part * dz_ * L_ * R * dx_ * unit * p_[of(i, j)] *
             Vec2(std::cos(angle), std::sin(angle));
      }
    return F;
  }

 private:
  static constexpr double unit = 1e5;  ///< of p_, Pa
  std::size_t of(int i, int j) const { return at(i * m_ + j); }
  /// In the middle of an edge or a quarter, at (i, j) in halves of the mesh.
  double gap(double i, double j, const Vec2& r) const {
    const double angle = start_ + i * dx_;
    const bool deep = i * dx_ < pocket_.to && 2.0 * j * dz_ < pocket_.width;
    return c - r.x() * std::cos(angle) - r.y() * std::sin(angle) +
           (deep ? pocket_.depth_from : 0.0);
  }
  /// Over the quarters beside corner (i, j) that exist.
  template <class Add>
  void for_quarters(int i, int j, const Add& add) const {
    for (const double u : {-0.25, 0.25})
      for (const double v : {-0.25, 0.25})
        if (i + u > 0 && i + u < n_ - 1 && j + v > 0 && j + v < m_ - 1) add(i + u, j + v);
  }
  void set_gaps(const Vec2& r) {
    volume_.assign(p_.size(), 0.0);
    drag_.assign(p_.size(), 0.0);
    along_.assign(p_.size(), 0.0);
    across_.assign(p_.size(), 0.0);
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < m_; ++j) {
        for_quarters(i, j, [&](double a, double b) {
          volume_[of(i, j)] += 0.25 * dx_ * dz_ * gap(a, b, r);
        });
        // past the edges to (i + 1, j) and (i, j + 1), each of two halves
        for (const double v : {-0.25, 0.25}) {
          if (j + v < 0 || j + v > m_ - 1) continue;
          const double h = gap(i + 0.5, j + v, r);
          drag_[of(i, j)] += 0.5 * Omega * 0.5 * dz_ * h;
          along_[of(i, j)] += unit * h * h * h / (12 * eta * R * R * dx_) * 0.5 * dz_;
        }
        for (const double u : {-0.25, 0.25}) {
          if (i + u < 0 || i + u > n_ - 1) continue;
          const double h = gap(i + u, j + 0.5, r);
          across_[of(i, j)] += unit * h * h * h / (12 * eta * L_ * L_ * dz_) * 0.5 * dx_;
        }
      }
  }
  double relax(int i, int j, double dt) {
    const std::size_t k = of(i, j);
    double sum = along_[k] + along_[of(i - 1, j)] + across_[k];
    double in = along_[k] * p_[of(i + 1, j)] + along_[of(i - 1, j)] * p_[of(i - 1, j)] +
                across_[k] * p_[of(i, j + 1)];
    if (j > 0) {
      sum += across_[of(i, j - 1)];
      in += across_[of(i, j - 1)] * p_[of(i, j - 1)];
    }
    in += drag_[of(i - 1, j)] * share_[of(i - 1, j)] + held_[k] / dt;
    const double leaves = drag_[k] + volume_[k] / dt;
    const double before = p_[k], share_before = share_[k];
    const double full = (in - leaves) / sum;
    constexpr double over = 1.75;
    if (full > 0.0) {
      share_[k] = 1.0;
      p_[k] = std::max(0.0, p_[k] + over * (full - p_[k]));
    } else {
      p_[k] = 0.0;
      share_[k] = std::min(1.0, in / leaves);
    }
    return std::max(std::abs(p_[k] - before), std::abs(share_[k] - share_before));
  }

  double start_, L_;
  Recess pocket_;
  int n_, m_;
  double dx_, dz_;
  std::vector<double> p_, share_, held_, volume_, drag_, along_, across_;
};

}  // namespace

// Whirl at twice the spin through rupture and refilling of a pocket: the film comes to that of the other
// discretisation, from which that of the momentary state stands a fifth of the largest force.
TEST(CarriedGrid, WhirlAgainstAnotherDiscretisation) {
  const FiniteJournal film = film_with(dam, 0.05);
  const JournalSurface::Arc& arc = film.surface->arcs()[0];
  constexpr double rate = 2.0 * Omega, far = 0.7 * c;
  constexpr int steps = 200;
  constexpr double dt = two_pi / rate / steps;
  const auto journal = [](double t) {
    return Vec2(far * std::cos(rate * t), 0.1 * c + far * std::sin(rate * t));
  };
  const auto velocity = [](double t) {
    return Vec2(rate * far * Vec2(-std::sin(rate * t), std::cos(rate * t)));
  };
  const CarriedGrid usual(film, 0, 20, 6), fine(film, 0, 40, 12);
  Moved cells(usual, journal(0.0)), fine_cells(fine, journal(0.0));
  CornerOil corners(arc.start, arc.length, 0.05, dam[0][0], 64, 12);
  double largest = 0.0, off = 0.0, fine_off = 0.0, momentary = 0.0;
  for (int k = 1; k <= steps + steps / 2; ++k) {
    const double t = k * dt;
    cells.step(dt, journal(t), Omega);
    fine_cells.step(dt, journal(t), Omega);
    corners.step(dt, journal(t));
    if (k <= steps / 2) continue;
    const Vec2 F = corners.force();
    const FilmPoint now = point_at(journal(t), velocity(t));
    GridLoad load;
    (*film.grid)[0].load(film.drive(0, now), load);
    const Vec2 at_once = -film.pressure_unit(film.gap(0, now)) * R * 0.05 * load.z.head<2>();
    off = std::max(off, (cells.force(journal(t), Omega).F - F).norm());
    fine_off = std::max(fine_off, (fine_cells.force(journal(t), Omega).F - F).norm());
    momentary = std::max(momentary, (at_once - F).norm());
    largest = std::max(largest, F.norm());
  }
  EXPECT_LT(off, 0.07 * largest);
  EXPECT_LT(fine_off, 0.03 * largest);
  EXPECT_GT(momentary, 0.2 * largest);
}

namespace {

/// What the other discretisation has for dynamic_stiffness, as its journal is shaken in both directions at
/// the frequency w; first harmonics of the last of turns + 1 motions.
struct Shaken {
  Eigen::Matrix2cd Z;
  Complex rate;  ///< that implicit Euler has for exp(i w t) at the times of its steps
};
Shaken shaken(const CornerOil& still, const Vec2& r, double w, int turns) {
  constexpr int steps = 32;
  constexpr double far = 0.01 * c;
  const double dt = two_pi / w / steps;
  Shaken out{Eigen::Matrix2cd::Zero(), (1.0 - std::exp(Complex(0.0, -w * dt))) / dt};
  for (const Index axis : {0, 1}) {
    CornerOil oil = still;
    for (int k = 1; k <= (turns + 1) * steps; ++k) {
      oil.step(dt, r + far * std::cos(w * dt * k) * Vec2::Unit(axis));
      const Complex against = 2.0 / (steps * far) * std::exp(Complex(0.0, -w * dt * k));
      if (k > turns * steps) out.Z.col(axis) -= against * oil.force();
    }
  }
  return out;
}

/// Distances of the cells from the other discretisation, of the norm of its dynamic stiffness.
struct Apart {
  double usual, fine, slow;  ///< slow: stiffness and damping of slow motions
};
Apart fast_motion(const std::vector<std::vector<Recess>>& recesses, const Vec2& r, double w,
                  int turns) {
  const FiniteJournal film = film_with(recesses, 0.05);
  const JournalSurface::Arc& arc = film.surface->arcs()[0];
  const CarriedGrid usual(film, 0, 20, 6), fine(film, 0, 40, 12);
  const Recess none{0.0, 0.0, 0.0, 0.0, 0.0, false};
  CornerOil still(arc.start, arc.length, 0.05, recesses.empty() ? none : recesses[0][0], 64, 12);
  for (int k = 0; k < 4; ++k)
    still.step(1.0, r);
  const Shaken corners = shaken(still, r, w, turns);
  const auto off = [&](const Eigen::Matrix2cd& Z) {
    return (Z - corners.Z).norm() / corners.Z.norm();
  };
  const Complex slow(0.0, 0.01 * Omega);
  const Eigen::Matrix2cd Z = dynamic_stiffness(fine, r, slow);
  const Mat2 K = Z.real(), C = Z.imag() / slow.imag();
  return {off(dynamic_stiffness(usual, r, corners.rate)),
          off(dynamic_stiffness(fine, r, corners.rate)),
          off(K.cast<Complex>() + corners.rate * C.cast<Complex>())};
}

}  // namespace

// Small motions at up to four times the spin, of a film behind a ruptured stretch, where stiffness and
// damping of slow ones are 20 to 110 % off, and of a pocket: those of the other discretisation.
TEST(CarriedGrid, FastMotionsAgainstAnotherDiscretisation) {
  for (const double angle : {220 * deg, 240 * deg})
    for (const double ratio : {0.5, 2.0, 4.0}) {
      const Apart a = fast_motion(plain, place(0.6, angle), ratio * Omega, ratio > 2.0 ? 4 : 2);
      EXPECT_LT(a.usual, 0.055);
      EXPECT_LT(a.fine, 0.02);
      if (ratio > 1.0) {
        EXPECT_GT(a.slow, 0.15);
      }
    }
  const Apart pocket = fast_motion(dam, place(0.5, 200 * deg), 2.0 * Omega, 2);
  EXPECT_LT(pocket.usual, 0.065);
  EXPECT_LT(pocket.fine, 0.025);
}

namespace {

/// Motions about oil that fills a share of the cells 4 to 6. blocks of 3 rows: 2.
template <class Pad>
ConformanceOptions moving(const Pad& pad, const Vec2& r, std::size_t first, Index block,
                          double filled) {
  ConformanceOptions o = film_options(c, Omega, 5e-3);
  o.gravity = first > 2 ? Vec3::Zero().eval() : Vec3(0.0, -2.0, -9.0);
  o.tangent_tolerance = 1e-7;
  o.power_tolerance = 1e-9;
  o.samples = 3;
  o.passive = false;  // the elastic energy of the oil is counted as heat
  for (std::size_t k = 0; k < 4; ++k)
    o.signals.push_back(static_cast<int>(first + k));
  o.q0.assign(6 * (first + 4), 0.0);
  o.v0.assign(6 * (first + 4), 0.0);
  o.v0[3] = Omega;
  const std::array<Index, 4> cells{4, 6, 5, 5};  // before, next, other block, own
  for (std::size_t k = 0; k < 4; ++k)
    for (Index j = 0; j < 3; ++j) {
      const Index row = 3 * (k == 2 ? 1 - block : block) + j;
      o.q0[6 * (first + k) + at(j)] =
          filled * pad.gap(cells[k], row, r) - pad.reference(cells[k], row);
    }
  return o;
}

}  // namespace

TEST(CarriedGrid, ConformsToTheContractOfKernels) {
  const Vec2 r = c * Vec2(0.3, -0.4);
  for (const auto* recesses : {&plain, &dam})
    for (const double density : {0.0, 900.0}) {
      FiniteJournal film = film_with(*recesses, 0.05, 1e5);
      film.turbulent_density = density;
      const auto pad = std::make_shared<const CarriedGrid>(film, 0, 10, 6);
      for (const double filled : {0.8, 1.05})
        for (const Index block : {0, 1}) {
          ConformanceOptions o = moving(*pad, r, 2, block, filled);
          o.q0[1] = r.x();
          o.q0[2] = r.y();
          // beside the bulk modulus of full cells what the journal drags along is next to nothing
          o.over_declared.spin = filled > 1.0;
          check_kernel(PadCell<CarriedGrid, 0, false>{pad, 5, {0.0, 0.0}, {}, block}, o);
          check_kernel(PadCell<CarriedGrid, 0, true>{pad, 5, {1e-6, 2e-6}, {}, block}, o);
        }
    }
}

namespace {

/// A pad of 60 deg below the journal, on a grid.
TiltingPad lower_pad() {
  TiltingPad pad = make_tilting_pad({R, 0.06, eta, c, 0.3, -0.5 * pi, pi / 3.0, 0.5, 0.01, 24});
  const JournalSurface::Arc& arc = pad.film.surface->arcs()[0];
  const GridPad grid(arc.start, arc.length, false, R / 0.06, 48, 8, {});
  pad.film.grid = std::make_shared<const std::vector<GridPad>>(std::vector{grid});
  pad.film.source = pad.film.leakage = 12.0;
  pad.film.mass_conserving = true;
  return pad;
}

}  // namespace

// Oil and pad in balance are the pad of the momentary film: where it stands, and its force.
TEST(CarriedGrid, PadsThatTilt) {
  const TiltingPad pad = lower_pad();
  const PadAtRest<CarriedGrid> rest(pad, std::make_shared<const CarriedGrid>(pad.film, 0, 12));
  for (const double down : {0.0, 0.5}) {
    const LateralMotion m = moving_at(Vec2(0.1 * c, -down * c));
    const Vec2 q = rest.settled(m);
    const Vec2 F = rest.force(pad.seen(m, q, Vec2::Zero()).r, Omega);
    const double exact = pad.settled_tilt(m);
    EXPECT_NEAR(q.x() * pad.arm, exact * pad.arm, 0.05 * c);
    const Vec2 momentary = -pad.standing(m, Vec2(exact, 0.0)).force;
    EXPECT_LT((F - momentary).norm(), 0.03 * momentary.norm());
  }
}

TEST(CarriedGrid, PadsThatTiltConformToTheContractOfKernels) {
  TiltingPad pad = lower_pad();
  pad.pivot_stiffness = 2e8;
  const auto rest = std::make_shared<const PadAtRest<CarriedGrid>>(
      pad, std::make_shared<const CarriedGrid>(pad.film, 0, 10));
  const Vec2 q(0.2 * c / pad.arm, 0.05 * c);
  const auto about = [&](bool pressed, double filled, Index block) {
    const LateralMotion m = moving_at(c * Vec2(0.2, -0.4));
    const Vec2 moved(q.x(), pressed ? q.y() : 0.0);
    const Vec2 r = pad.seen(m, moved, Vec2::Zero()).r;
    ConformanceOptions o = moving(*rest->oil(), r, pressed ? 4 : 3, block, filled);
    o.samples = 2;
    o.q0[1] = m.r.x();
    o.q0[2] = m.r.y();
    o.v0[9] = 20;
    o.q0[12] = moved.x();
    if (pressed) o.q0[18] = moved.y();
    return o;
  };
  const std::array<double, 2> none{0.0, 0.0}, aside{1e-6, 2e-6};
  for (const double filled : {0.8, 1.05})
    for (const Index block : {0, 1}) {
      check_kernel(TiltingCell<CarriedGrid, false, false>::of(rest, 5, none, block),
                   about(false, filled, block));
      check_kernel(TiltingCell<CarriedGrid, true, true>::of(rest, 5, aside, block),
                   about(true, filled, block));
    }
}

}  // namespace carried_grid_tests
