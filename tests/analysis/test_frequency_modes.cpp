// All modes on supports whose coefficients depend on the frequency of the motion, against
// references that do not use Whirl's solver.
#include <analysis/response/unbalance.hpp>
#include <analysis/spectra/campbell.hpp>
#include <analysis/spectra/critical.hpp>
#include <analysis/spectra/stability.hpp>
#include <analysis/spectra/whirl_modes.hpp>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include "../validation/deck_model.hpp"

#include <cstdlib>
#include <functional>
#include <random>

using namespace whirl;

namespace {

/// An isotropic support with cross coupling, at spin s and frequency w: F = -k r - c r' and kc
/// turns r by a quarter, kyz = kc = -kzy.
struct Coefficients {
  double k, c, kc;
};
using Support = std::function<Coefficients(double s, double w)>;

std::string table(const char* name, const char* at, const std::vector<double>& spins,
                  const std::vector<double>& w, const Support& f,
                  const char* extrapolate = "error") {
  std::string rows;
  for (const double s : spins)
    for (const double x : w) {
      const Coefficients v = f(s, x);
      rows +=
          fmt::format("[{:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}],\n",
                      s, x / two_pi, v.k, v.k, v.kc, -v.kc, v.c, v.c);
    }
  return fmt::format(R"([[bearing]]
name = "{}"
at = "{}"
type = "table"
extrapolate = "{}"
columns = ["speed[rad/s]", "frequency[Hz]", "kyy[N/m]", "kzz[N/m]", "kyz[N/m]", "kzy[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [
{}]
)",
                     name, at, extrapolate, rows);
}

/// The branch of m l^2 + c l + k - i sign kc = 0 with Im l > 0; sign 1: forward (y + i z turns with
/// the spin), -1: backward.
Complex branch(double m, const Coefficients& v, int sign) {
  const Complex root = std::sqrt(Complex(v.c * v.c - 4 * m * v.k, 4 * m * sign * v.kc));
  const Complex a = (-v.c + root) / (2 * m), b = (-v.c - root) / (2 * m);
  return a.imag() > b.imag() ? a : b;
}

/// Every w in (0, top) at which Im l(w) falls through w: signs on a fine grid, then bisection.
std::vector<Complex> scalar_modes(double m, const std::function<Coefficients(double)>& f, int sign,
                                  double top, int grid = 100000) {
  std::vector<Complex> out;
  const auto gap = [&](double w) { return branch(m, f(w), sign).imag() - w; };
  double last = gap(1e-9 * top);
  for (int i = 1; i <= grid; ++i) {
    double a = top * (i - 1) / grid, b = top * i / grid;
    const double now = gap(b);
    if (last > 0 && now <= 0) {
      for (int k = 0; k < 80; ++k) {
        const double mid = 0.5 * (a + b);
        (gap(mid) > 0 ? a : b) = mid;
      }
      out.push_back(branch(m, f(0.5 * (a + b)), sign));
    }
    last = now;
  }
  return out;
}

/// A mass m1 on k1, c1 standing on a pedestal m2, k2, c2.
struct Chain {
  double m1, k1, c1, m2, k2, c2;
  Complex D(double w) const {
    return 1.0 / (1.0 / Complex(k1, w * c1) + 1.0 / Complex(k2 - w * w * m2, w * c2));
  }
  Coefficients at(double w) const {
    // at rest the limit: c1 k2^2 + c2 k1^2 over (k1 + k2)^2
    return {D(w).real(),
            w > 0 ? D(w).imag() / w : (c1 * k2 * k2 + c2 * k1 * k1) / ((k1 + k2) * (k1 + k2)), 0.0};
  }
  /// Its two modes as a system of two masses.
  std::array<Complex, 2> modes() const {
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a.topRightCorner<2, 2>().setIdentity();
    a.bottomLeftCorner<2, 2>() << -k1 / m1, k1 / m1, k1 / m2, -(k1 + k2) / m2;
    a.bottomRightCorner<2, 2>() << -c1 / m1, c1 / m1, c1 / m2, -(c1 + c2) / m2;
    std::vector<Complex> up;
    for (const Complex l : Eigen::EigenSolver<Eigen::Matrix4d>(a).eigenvalues())
      if (l.imag() > 0) up.push_back(l);
    if (up[0].imag() > up[1].imag()) std::swap(up[0], up[1]);
    return {up[0], up[1]};
  }
};

std::vector<double> grid(double last, int n) {
  std::vector<double> w;
  for (int i = 0; i <= n; ++i)
    w.push_back(last * i / n);
  return w;
}
void insert(std::vector<double>& w, double x) {
  if (std::find(w.begin(), w.end(), x) == w.end())
    w.insert(std::upper_bound(w.begin(), w.end(), x), x);
}

analysis::ModesOptions lateral(Index count) {
  analysis::ModesOptions o;
  o.count = count;
  o.motion = analysis::Motion::lateral;
  return o;
}

/// Each of `exact` is among the modes `copies` times, and nothing else is.
void expect_modes(const std::vector<analysis::WhirlMode>& modes, const std::vector<Complex>& exact,
                  int copies, double tolerance) {
  EXPECT_EQ(modes.size(), exact.size() * static_cast<std::size_t>(copies));
  for (const Complex l : exact) {
    int found = 0;
    for (const auto& m : modes)
      found += std::abs(m.lambda - l) < tolerance * std::abs(l) ? 1 : 0;
    EXPECT_EQ(found, copies) << l;
  }
}

constexpr Chain nearly_undamped{50, 8e6, 0, 20, 2e7, 0.2}, light{50, 8e6, 20, 20, 2e7, 10};

/// Rows enough for the pole of the support at 1183.2 rad/s; the exact modes among them, where the
/// table is then exact.
std::vector<double> rows_of(const Chain& c) {
  std::vector<double> w = grid(1500, 150);
  const double pole = std::sqrt((c.k1 + c.k2) / c.m2), width = std::max(c.c2 / c.m2, 0.01);
  for (int k = -60; k <= 60; ++k)
    if (const double x = pole + width * std::sinh(0.15 * k); x > 1100 && x < 1300) insert(w, x);
  for (const Complex l : scalar_modes(
           c.m1, [&](double x) { return c.at(x); }, 1, 1500))
    insert(w, l.imag());
  return w;
}

}  // namespace

// One mass in the model, two modes in each plane: the second lives in the table alone.
TEST(FrequencyModes, BothModesOfAMassOnAPedestal) {
  for (const Chain& c : {nearly_undamped, light}) {
    const test::DeckModel a(test::lateral_mass(c.m1, "0 m/s^2",
                                               table("shaken", "mass", {0.0, 700.0}, rows_of(c),
                                                     [&](double, double w) { return c.at(w); })));
    analysis::Linearizer linear(a.built.system, a.running());
    const std::vector<Complex> own = scalar_modes(
        c.m1, [&](double w) { return c.at(w); }, 1, 1500);
    ASSERT_EQ(own.size(), 2u);
    const std::array<Complex, 2> chain = c.modes();
    for (const double Omega : {0.0, 40.0, 332.0, 700.0}) {
      analysis::ModesOptions o = lateral(8);
      o.continued = true;
      const auto modes = analysis::whirl_modes(linear, Omega, o);
      expect_modes(modes, own, 2, 1e-9);
      // The two-mass chain itself: coefficients at w describe a motion that neither grows nor
      // decays. For one that does, K and C change with the decay rate too; to first order that
      // divides the rate by 1 - K'/(2 m w), and the frequency changes with the square of the
      // damping.
      for (std::size_t k = 0; k < 2; ++k) {
        const double w = own[k].imag(), h = 1e-5 * w, zeta = -own[k].real() / w;
        const double slope = (c.at(w + h).k - c.at(w - h).k) / (4 * h * c.m1 * w);
        EXPECT_NEAR(own[k].imag(), chain[k].imag(), zeta * zeta * w + 1e-10 * w);
        EXPECT_NEAR(own[k].real() / (1 - slope), chain[k].real(),
                    (zeta + 1e-6) * std::abs(chain[k].real()));
        // The same from the table, whose slopes between rows are good to 1e-3.
        for (const auto& mode : modes)
          if (std::abs(mode.lambda - own[k]) < 1e-9 * w) {
            EXPECT_LT(std::abs(mode.continued - chain[k]),
                      zeta * zeta * w + 1e-3 * std::abs(chain[k].real()));
          }
      }
    }
  }
}

// Undamped: K(w) = m w^2 with K = Re D alone, both planes. Near the pole K also rises through m
// w^2; that is no critical speed.
TEST(FrequencyModes, UndampedCriticalSpeedsOfAMassOnAPedestal) {
  const test::DeckModel a(test::lateral_mass(light.m1, "0 m/s^2",
                                             table("shaken", "mass", {0.0, 1500.0}, rows_of(light),
                                                   [](double, double w) { return light.at(w); })));
  analysis::Linearizer linear(a.built.system, a.running());
  analysis::CriticalOptions o;
  o.max_speed = 1450;
  o.motion = analysis::Motion::lateral;
  std::vector<double> exact;
  int rising = 0;
  double last = 1;
  for (int i = 1; i <= 145000; ++i) {
    const auto gap = [](double w) { return light.at(w).k - light.m1 * w * w; };
    double low = 0.01 * (i - 1), high = 0.01 * i;
    const double now = gap(high);
    rising += last <= 0 && now > 0;
    if (last > 0 && now <= 0) {
      for (int k = 0; k < 60; ++k)
        (gap(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
      exact.push_back(high);
    }
    last = now;
  }
  ASSERT_EQ(exact.size(), 2u);
  ASSERT_EQ(rising, 1);
  const auto found = analysis::critical_speeds(linear, o);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(found[k].speed, exact[k / 2],
                1e-6 * exact[k / 2]);  // rows lie 0.05 rad/s from the second
}

// Cross coupling, stiffness and damping that go up and down with frequency, so that one mass has
// many modes: exactly those that the equation of y + i z has, forward and backward.
TEST(FrequencyModes, UnsymmetricTableHasExactlyTheModesOfItsEquation) {
  constexpr double m = 50, top = 1270;
  const Support f = [](double s, double w) {
    return Coefficients{m * w * w * (1 + 0.1 * std::sin(w / 30)) + 2e5,
                        2e3 + 1.5e3 * std::cos(w / 60), (0.5 + s / 400) * 8e5 * std::sin(w / 37)};
  };
  for (const double s : {100.0, 400.0}) {
    std::vector<Complex> exact;
    for (const int sign : {1, -1})
      for (const Complex l : scalar_modes(
               m, [&](double w) { return f(s, w); }, sign, top))
        exact.push_back(l);
    ASSERT_GE(exact.size(), 12u);
    std::vector<double> w = grid(top, 635);
    for (const Complex l : exact)
      insert(w, l.imag());  // there the table is exact
    const test::DeckModel a(test::lateral_mass(
        m, "0 m/s^2", table("shaken", "mass", {0.0, 100.0, 400.0}, w, f, "hold")));
    analysis::Linearizer linear(a.built.system, a.running());
    analysis::ModesOptions o = lateral(0);
    o.max_frequency = 1.5 * top;  // beyond the table nothing: held there, both planes stay below
    const auto modes = analysis::whirl_modes(linear, s, o);
    expect_modes(modes, exact, 1, 1e-9);
    for (const auto& mode : modes) {
      const bool forward =
          std::abs(mode.lambda - branch(m, f(s, mode.frequency), 1)) < 1e-9 * mode.frequency;
      EXPECT_EQ(mode.direction,
                forward ? analysis::Direction::forward : analysis::Direction::backward);
    }
    // The slowest of them, by number.
    const auto least = analysis::whirl_modes(linear, s, lateral(5));
    ASSERT_EQ(least.size(), 5u);
    std::vector<double> frequency;
    for (const Complex l : exact)
      frequency.push_back(l.imag());
    std::sort(frequency.begin(), frequency.end());
    for (const auto& mode : least)
      EXPECT_LT(mode.frequency, frequency[4] * (1 + 1e-9));  // in both directions the same
  }
}

// Cross coupling kc(s, w) = s a b(w) that acts near the mode's own frequency alone: at the
// frequency of the spin there is next to none. Onset where kc = w0 c at w0 = sqrt(k/m): s = w0 c/a.
TEST(FrequencyModes, InstabilityAtItsOwnFrequencyOnly) {
  constexpr double m = 50, k = 8e6, c = 2e3, a = 1e3, w0 = 400;
  const Support f = [](double s, double w) {
    return Coefficients{k, c, s * a * std::exp(-std::pow((w - w0) / 40, 2))};
  };
  const test::DeckModel d(
      test::lateral_mass(m, "0 m/s^2", table("seal", "mass", {0.0, 1000.0}, grid(1200, 120), f)));
  analysis::Linearizer linear(d.built.system, d.running());
  const double onset = w0 * c / a;
  ASSERT_LT(branch(m, f(onset, onset), 1).real(),
            -0.9 * c / (2 * m));  // with synchronous coefficients: as stable as without
  analysis::StabilityOptions o;
  o.min_speed = 100;
  o.max_speed = 1000;
  o.grid = 10;
  o.modes = 6;
  o.motion = analysis::Motion::lateral;
  o.all = true;
  const auto r = analysis::find_instability(linear, o);
  EXPECT_TRUE(r.stable_at_start);
  ASSERT_EQ(r.onsets.size(), 1u);
  EXPECT_NEAR(r.onsets[0].speed, onset, 1e-9 * onset);
  EXPECT_NEAR(r.onsets[0].frequency, w0, 1e-9 * w0);
  EXPECT_EQ(r.onsets[0].mode.direction, analysis::Direction::forward);
}

namespace {
constexpr Chain pedestal{0, 1e8, 30, 60, 1.5e8, 15};  // m1: the rotor's

std::string overhung(const std::string& bearings, double loss = 0) {
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
damping = {{ internal_loss_factor = {} }}
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["de", 300, 90, 2], ["span", 700, 110, 3], ["nose", 250, 90, 2]]
[[disk]]
at = "nose:end"
mass = "60 kg"
Ip = "3 kg.m^2"
Id = "1.6 kg.m^2"
[[bearing]]
name = "thrust"
at = "de:start"
type = "rigid"
directions = ["x"]
)",
                     loss) +
         bearings;
}

/// Bearings of the rotor above on pedestals that are masses (first), or in tables (second).
std::pair<std::string, std::string> on_pedestals() {
  std::string masses, tables;
  // The pole at 2041 rad/s lies inside.
  std::vector<double> w = grid(3000, 100);
  const double pole = std::sqrt((pedestal.k1 + pedestal.k2) / pedestal.m2);
  for (int k = -66; k <= 66; ++k)
    insert(w, pole + 0.4 * std::sinh(0.12 * k));
  for (const auto& [name, at] : {std::pair{"first", "de:end"}, std::pair{"second", "span:end"}}) {
    masses +=
        fmt::format(R"([[bearing]]
name = "{0}"
at = "{6}"
type = "linear"
kyy = "{1} N/m"
kzz = "{1} N/m"
cyy = "{2} N.s/m"
czz = "{2} N.s/m"
support = {{ mass = "{3} kg", kyy = "{4} N/m", kzz = "{4} N/m", cyy = "{5} N.s/m", czz = "{5} N.s/m" }}
)",
                    name, pedestal.k1, pedestal.c1, pedestal.m2, pedestal.k2, pedestal.c2, at);
    tables += table(name, at, {0.0, 1000.0}, w, [](double, double x) { return pedestal.at(x); });
  }
  return {masses, tables};
}
}  // namespace

// A gyroscopic rotor on two bearings with pedestals, once with the pedestals as masses, once within
// tables: the same Campbell diagram and the same damped critical speeds.
TEST(FrequencyModes, RotorOnPedestalsInTablesIsTheRotorOnPedestals) {
  const auto [masses, tables] = on_pedestals();
  const test::DeckModel a(overhung(masses)), b(overhung(tables));
  analysis::Linearizer exact(a.built.system, a.running()), reduced(b.built.system, b.running());
  analysis::CampbellOptions o;
  for (int k = 0; k <= 4; ++k)
    o.speeds.push_back(200.0 * k);
  o.track.modes = lateral(0);
  o.track.modes.max_frequency = 2900;
  const auto lines = analysis::campbell(exact, o).lines,
             found = analysis::campbell(reduced, o).lines;
  ASSERT_GE(lines.size(), 10u);
  ASSERT_EQ(found.size(), lines.size());
  for (std::size_t l = 0; l < lines.size(); ++l) {
    EXPECT_EQ(found[l].label, lines[l].label);
    for (std::size_t k = 0; k < o.speeds.size(); ++k)
      EXPECT_NEAR(found[l].frequency[k], lines[l].frequency[k], 1e-4 * lines[l].frequency[k])
          << l << " at " << o.speeds[k];
  }
  analysis::CriticalOptions c;
  c.max_speed = 1000;
  c.grid = 10;
  c.damped = true;
  c.motion = analysis::Motion::lateral;
  const auto speeds = analysis::critical_speeds(exact, c),
             same = analysis::critical_speeds(reduced, c);
  ASSERT_GE(speeds.size(), 3u);
  ASSERT_EQ(same.size(), speeds.size());
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    EXPECT_NEAR(same[k].speed, speeds[k].speed, 1e-4 * speeds[k].speed);
    EXPECT_EQ(same[k].mode.direction, speeds[k].mode.direction);
  }
}

// Hysteretic damping asks for the rate of the motion beside.
TEST(FrequencyModes, HystereticShaftOnPedestalsInTables) {
  const auto [masses, tables] = on_pedestals();
  const test::DeckModel a(overhung(masses, 0.01)), b(overhung(tables, 0.01));
  analysis::Linearizer exact(a.built.system, a.running()), reduced(b.built.system, b.running());
  analysis::ModesOptions o = lateral(0);
  o.max_frequency = 2900;
  analysis::SpectrumCertificate of_masses, of_tables;
  const auto modes = analysis::whirl_modes(exact, 400.0, o, &of_masses),
             found = analysis::whirl_modes(reduced, 400.0, o, &of_tables);
  EXPECT_TRUE(of_masses.complete()) << of_masses.text();
  EXPECT_TRUE(of_tables.complete()) << of_tables.text();
  ASSERT_GE(modes.size(), 10u);
  ASSERT_EQ(found.size(), modes.size());
  for (std::size_t k = 0; k < modes.size(); ++k)
    EXPECT_NEAR(found[k].frequency, modes[k].frequency,
                2e-4 * modes[k].frequency);  // the square of the damping, which is larger here
  // The first two bend the shaft most: the loss factor is in their damping.
  const test::DeckModel without(overhung(tables));
  analysis::Linearizer free(without.built.system, without.running());
  const auto plain = analysis::whirl_modes(free, 400.0, o);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(found[k].damping_ratio - plain[k].damping_ratio, modes[k].damping_ratio,
                0.1 * modes[k].damping_ratio);
}

namespace {

/// A rotor on two bearings, each on a pedestal of its own in either direction: as masses, or as
/// tables of what the pedestals answer.
struct PedestalMachine {
  double length = 0.8, diameter = 0.06, disk_mass = 40, polar = 0.6, diametral = 0.35;
  struct Pedestal {
    std::array<double, 2> k1, c1, mass, k2, c2;  ///< y, z; the masses of one pedestal are equal
    Complex D(int d, double w) const {
      const Complex a(k1[d], w * c1[d]), b(k2[d] - w * w * mass[d], w * c2[d]);
      return a * b / (a + b);
    }
    Complex coefficients(int d, double w) const {  ///< k + i c
      const double x = std::max(w, 1e-3);
      return {D(d, x).real(), D(d, x).imag() / x};
    }
  };
  std::array<Pedestal, 2> pedestal;

  std::string rotor() const {
    return fmt::format(R"(format = 1
[[shaft]]
name = "r"
material = "steel"
[[shaft.section]]
name = "a"
length = "{0:.17g} m"
od = "{1:.17g} m"
min_elements = 3
[[shaft.section]]
name = "b"
length = "{0:.17g} m"
od = "{1:.17g} m"
min_elements = 3
[[disk]]
name = "d"
at = "a:end"
mass = "{2:.17g} kg"
Ip = "{3:.17g} kg.m^2"
Id = "{4:.17g} kg.m^2"
[[step]]
name = "m"
type = "modal"
speed = "6000 rpm"
)",
                       0.5 * length, diameter, disk_mass, polar, diametral);
  }
  std::string with_masses() const {
    std::string text = rotor();
    for (int j = 0; j < 2; ++j) {
      const Pedestal& p = pedestal[static_cast<std::size_t>(j)];
      text += fmt::format(R"([[bearing]]
name = "{}"
at = "{}"
type = "linear"
kyy = "{:.17g} N/m"
kzz = "{:.17g} N/m"
cyy = "{:.17g} N.s/m"
czz = "{:.17g} N.s/m"
[bearing.support]
mass = "{:.17g} kg"
kyy = "{:.17g} N/m"
kzz = "{:.17g} N/m"
cyy = "{:.17g} N.s/m"
czz = "{:.17g} N.s/m"
)",
                          j ? "R" : "L", j ? "b:end" : "a:start", p.k1[0], p.k1[1], p.c1[0],
                          p.c1[1], p.mass[0], p.k2[0], p.k2[1], p.c2[0], p.c2[1]);
    }
    return text;
  }
  std::string with_tables(double top, int rows) const {
    std::string text = rotor();
    for (int j = 0; j < 2; ++j) {
      std::string lines;
      for (const double spin : {0.0, 2000.0})
        for (int i = 0; i < rows; ++i) {
          const double w = top * i / (rows - 1);
          const Complex y = pedestal[static_cast<std::size_t>(j)].coefficients(0, w),
                        z = pedestal[static_cast<std::size_t>(j)].coefficients(1, w);
          lines += fmt::format("[{}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}],\n", spin,
                               w / two_pi, y.real(), z.real(), y.imag(), z.imag());
        }
      text += fmt::format(R"([[bearing]]
name = "{}"
at = "{}"
type = "table"
columns = ["speed[rad/s]", "frequency[Hz]", "kyy[N/m]", "kzz[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [
{}]
)",
                          j ? "R" : "L", j ? "b:end" : "a:start", lines);
    }
    return text;
  }
  /// Distance to the nearest pole of the answers, rad/s.
  double pole_distance(double w) const {
    double least = infinity;
    for (const Pedestal& p : pedestal)
      for (std::size_t d = 0; d < 2; ++d)
        least = std::min(least, std::abs(std::sqrt((p.k1[d] + p.k2[d]) / p.mass[d]) - w));
    return least;
  }
  /// What straight lines between rows make wrong of the answers near w, relative.
  double table_error(double top, int rows, double w) const {
    const double h = top / (rows - 1), from = std::floor(w / h) * h;
    double worst = 0;
    for (const Pedestal& p : pedestal)
      for (int d = 0; d < 2; ++d) {
        const auto dynamic = [&](double at, double x) {
          const Complex q = p.coefficients(d, at);
          return Complex(q.real(), x * q.imag());
        };
        const double t = (w - from) / h;
        const Complex line = (1 - t) * dynamic(from, w) + t * dynamic(from + h, w);
        worst = std::max(worst, std::abs(line - p.D(d, w)) / std::abs(p.D(d, w)));
      }
    return worst;
  }
};

PedestalMachine random_machine(std::mt19937& random) {
  const auto between = [&](double a, double b) {
    return std::exp(std::uniform_real_distribution(std::log(a), std::log(b))(random));
  };
  PedestalMachine m;
  m.length = between(0.5, 1.5);
  m.diameter = m.length * between(0.04, 0.1);
  const double shaft = 7850 * 0.25 * pi * m.diameter * m.diameter * m.length;
  m.disk_mass = shaft * between(0.3, 4);
  m.diametral = m.disk_mass * std::pow(m.diameter * between(0.8, 2.5), 2);
  m.polar = m.diametral * between(1.0, 1.9);
  for (auto& p : m.pedestal) {
    const double mass = (shaft + m.disk_mass) * between(0.1, 3), zeta = between(0.001, 0.03);
    const bool round = between(1, 4) < 2;
    for (std::size_t d = 0; d < 2; ++d) {
      p.mass[d] = mass;
      p.k1[d] = d && round ? p.k1[0] : mass * std::pow(two_pi * between(30, 200), 2);
      p.k2[d] = d && round ? p.k2[0] : p.k1[d] * between(0.2, 3);
      p.c1[d] = 2 * zeta * std::sqrt(p.k1[d] * mass);
      p.c2[d] = 2 * zeta * std::sqrt(p.k2[d] * mass);
    }
  }
  return m;
}

analysis::ModesOptions all_up_to(double top) {
  analysis::ModesOptions o = lateral(0);
  o.max_frequency = top;
  o.continued = true;
  return o;
}

/// Every lightly damped mode of the machine with masses is among those on tables, wherever the
/// tables are fine enough to have it; and the list is said to be complete. Number of modes compared.
int expect_the_same_modes(const PedestalMachine& m, double top, int rows, double Omega) {
  const test::DeckModel exact(m.with_masses()), tables(m.with_tables(top, rows));
  analysis::Linearizer of_exact(exact.built.system, exact.running());
  analysis::Linearizer of_tables(tables.built.system, tables.running());
  analysis::SpectrumCertificate known;
  const auto wanted = analysis::whirl_modes(of_exact, Omega, all_up_to(0.9 * top));
  const auto found = analysis::whirl_modes(of_tables, Omega, all_up_to(0.95 * top), &known);
  EXPECT_TRUE(known.complete()) << known.text();
  std::vector<bool> taken(found.size(), false);
  int compared = 0;
  for (const auto& mode : wanted) {
    const double w = mode.frequency, error = m.table_error(top, rows, w);
    // Coefficients at w are those of a motion that does not decay: what that makes wrong is of second
    // order in the decay over the distance of poles.
    const double decay = -mode.lambda.real() / m.pole_distance(w);
    if (!mode.oscillates() || mode.damping_ratio > 0.05 || decay > 0.1 || error > 0.01) continue;
    const double tolerance = (0.5 * error + 1e-4 + 20 * std::pow(mode.damping_ratio, 2)) * w +
                             5 * decay * decay * m.pole_distance(w);
    std::size_t best = found.size();
    for (std::size_t k = 0; k < found.size(); ++k)
      if (const double off = std::abs(found[k].frequency - w);
          !taken[k] && off < tolerance &&
          (best == found.size() || off < std::abs(found[best].frequency - w)))
        best = k;
    EXPECT_LT(best, found.size()) << to_hz(w) << " Hz of " << to_hz(top) << " in " << rows
                                  << " rows, damping " << mode.damping_ratio << ", " << error;
    if (best < found.size()) taken[best] = true;
    ++compared;
  }
  return compared;
}

}  // namespace

// A pole of the pedestals at 159 Hz, its modes at 71.9, 77.1, 100.0 and 100.7 Hz: branches with the
// coefficients held fall from far above the line to the real axis between two rows of a coarse table.
TEST(FrequencyModes, FineTablesOfAPedestalLoseNoMode) {
  PedestalMachine m;
  for (auto& p : m.pedestal)
    p = {{4e7, 4e7}, {3e2, 3e2}, {60, 60}, {2e7, 2e7}, {6e2, 6e2}};
  m.pedestal[0] = {{1e9, 1e9}, {1e2, 1e2}, {60, 60}, {3e7, 3e7}, {1e3, 1e3}};
  for (const int rows : {50, 100, 200, 400, 1000, 2000})
    EXPECT_GE(expect_the_same_modes(m, two_pi * 700, rows, 200 * pi), rows < 100   ? 2
                                                                      : rows < 200 ? 4
                                                                                   : 8)
        << rows;
}

TEST(FrequencyModes, RandomPedestalsInTablesLoseNoMode) {
  std::mt19937 random(20);
  const char* campaign = std::getenv("WHIRL_CAMPAIGN");
  int compared = 0;
  const int machines = campaign ? std::atoi(campaign) : 12;
  for (int k = 0; k < machines; ++k) {
    const PedestalMachine m = random_machine(random);
    const double spread = std::uniform_real_distribution(0.0, 1.0)(random);
    const int rows = static_cast<int>(20 * std::pow(100.0, spread));
    const double top = two_pi * std::uniform_real_distribution(300.0, 900.0)(random);
    SCOPED_TRACE(fmt::format("machine {}", k));
    compared += expect_the_same_modes(m, top, rows, 100 * (k % 7));
  }
  EXPECT_GE(compared, 4 * machines);
}

namespace {

/// Peaks of the response to an unbalance of the disk from 300 to 12000 rpm.
std::vector<analysis::ResponsePeak> peaks_of(const std::string& deck, int speeds, bool resolve) {
  const test::DeckModel d(deck + "[[unbalance]]\nat = \"d\"\namount = \"10 g.mm\"\n");
  analysis::Linearizer linear(d.built.system, d.running());
  analysis::UnbalanceOptions o;
  for (int k = 0; k < speeds; ++k)
    o.speeds.push_back(test::rpm * (300 + 11700.0 * k / (speeds - 1)));
  o.probes.push_back({"disk", {d.disk(), 0.0}, {}});
  o.resolve = resolve;
  analysis::UnbalanceSolver solver(linear, o);
  solver.run();
  return solver.peaks();
}

}  // namespace

// Peaks are narrower than the critical speeds on tables say, and stand between coarse speeds.
TEST(FrequencyModes, PeaksOnPedestalsInTablesAreThoseOfThePedestals) {
  std::mt19937 random(5);
  std::size_t compared = 0;
  for (int k = 0; k < 3; ++k) {
    const PedestalMachine m = random_machine(random);
    const auto wanted = peaks_of(m.with_masses(), 3000, false),
               found = peaks_of(m.with_tables(two_pi * 250, 4000), 60, true);
    SCOPED_TRACE(fmt::format("machine {}", k));
    for (const analysis::ResponsePeak& p : wanted) {
      const auto same =
          std::min_element(found.begin(), found.end(), [&](const auto& a, const auto& b) {
            return std::abs(a.speed - p.speed) < std::abs(b.speed - p.speed);
          });
      ASSERT_NE(same, found.end());
      EXPECT_NEAR(same->speed, p.speed, 2e-4 * p.speed);
      EXPECT_NEAR(same->amplitude, p.amplitude, 2e-2 * p.amplitude) << p.speed / test::rpm;
      ++compared;
    }
    EXPECT_EQ(found.size(), wanted.size());
  }
  EXPECT_GE(compared, 6u);
}

// A count along the axis that finds fewer growing motions than the list leaves neither standing.
TEST(FrequencyModes, AContradictedListIsNotComplete) {
  analysis::SpectrumCertificate c;
  c.open.clear();
  c.list.counted = true;
  EXPECT_TRUE(c.complete());
  c.axis.emplace();
  c.axis->counted = true;
  EXPECT_TRUE(c.complete());
  EXPECT_TRUE(c.stability_certain());
  for (const Index unknown : {-2, 2}) {
    c.axis->unknown = unknown;
    EXPECT_FALSE(c.complete()) << unknown;
    EXPECT_FALSE(c.stability_certain()) << unknown;
  }
}

TEST(FrequencyModes, WhatTheSearchKnowsIsInTheCertificate) {
  analysis::OwnFrequency::Known k;
  k.counted = true;
  k.low = 3;
  k.top = 500;
  k.reach = 0.25;
  k.rising = {Complex(-1, 40)};
  analysis::SpectrumCertificate c;
  c.open.clear();
  c.take(k);
  EXPECT_TRUE(c.complete());
  EXPECT_DOUBLE_EQ(c.list.radius, 500);
  EXPECT_DOUBLE_EQ(c.list.reach, 125);
  ASSERT_TRUE(c.by_frequency.has_value());
  EXPECT_DOUBLE_EQ(c.by_frequency->low, 3);
  EXPECT_EQ(c.by_frequency->rising, 1);
  k.missing = 2;
  k.where = {Complex(-2, 90)};
  c.take(k);
  EXPECT_FALSE(c.complete());
  EXPECT_EQ(c.list.missing, 2);
  EXPECT_EQ(c.list.where, k.where);
}
