// The field's plots as plain data: what goes in stands in the figure, in the units of its axes.
#include <gtest/gtest.h>
#include <plot/plots.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::io {
namespace {

using Values = std::vector<double>;
using plot::Amplitude;
using plot::Axes;
using plot::Figure;
using plot::Series;

constexpr double rad_s = pi / 30;  ///< of 1 rpm

Values times(double factor, Values v) {
  for (double& x : v)
    x *= factor;
  return v;
}

void expect_values(const Values& is, const Values& wanted, const std::string& of) {
  ASSERT_EQ(is.size(), wanted.size()) << of;
  for (std::size_t k = 0; k < is.size(); ++k) {
    if (std::isnan(wanted[k]))
      EXPECT_TRUE(std::isnan(is[k])) << of << k;
    else
      EXPECT_NEAR(is[k], wanted[k], 1e-9 * (1 + std::abs(wanted[k]))) << of << k;
  }
}

void expect_series(const Series& s, const Values& x, const Values& y, const std::string& of) {
  expect_values(s.x, x, of + " x ");
  expect_values(s.y, y, of + " y ");
}

std::vector<Series> series_with(const Axes& a, const std::string& trace) {
  std::vector<Series> out;
  for (const Series& s : a.series)
    if (s.trace_label == trace) out.push_back(s);
  return out;
}

const Series* labelled(const Axes& a, const std::string& label) {
  for (const Series& s : a.series)
    if (s.label == label) return &s;
  return nullptr;
}

std::string titles(const Axes& a) {
  return a.x.label + " [" + a.x.unit + "], " + a.y.label + " [" + a.y.unit + "]";
}

bool has_note(const Axes& a, double x, double y, const std::string& text) {
  return std::any_of(a.notes.begin(), a.notes.end(), [&](const plot::Note& n) {
    return n.text == text && std::abs(n.x - x) < 1e-9 * (1 + std::abs(x)) &&
           std::abs(n.y - y) < 1e-9 * (1 + std::abs(y));
  });
}

/// Forward up to 2000 rpm, backward from there; 10, 20, 15 and 5 Hz.
plot::CampbellLine turning_line() {
  plot::CampbellLine l;
  l.label = "1";
  l.whirl = plot::Whirl::forward;
  l.speed = times(rad_s, {0, 1000, 2000, 3000});
  l.frequency = times(two_pi, {10, 20, 15, 5});
  l.log_decrement = {0.1, 0.2, -0.3, 0.4};
  l.whirl_at = {plot::Whirl::forward, plot::Whirl::forward, plot::Whirl::backward,
                plot::Whirl::backward};
  return l;
}

}  // namespace

TEST(PlotNumbers, OfACampbellDiagram) {
  const plot::CampbellLine l = turning_line();
  const Values orders{1, 0.25};
  const plot::CriticalMark marks[] = {{1000 * rad_s, 20 * two_pi, 1, ""},
                                      {1500 * rad_s, 10 * two_pi, 1, "named"}};
  const Figure f = plot::plot_campbell("c", "c", std::span(&l, 1), orders, marks);
  const Axes& a = f.axes.at(0);
  EXPECT_EQ(titles(a), "speed [rpm], damped natural frequency [Hz]");
  // stretches share their ends
  const auto forward = series_with(a, "1, forward"), backward = series_with(a, "1, backward");
  ASSERT_EQ(forward.size(), 1u);
  ASSERT_EQ(backward.size(), 1u);
  expect_series(forward[0], {0, 1000, 2000}, {10, 20, 15}, "forward");
  expect_series(backward[0], {2000, 3000}, {15, 5}, "backward");
  expect_values(forward[0].extra.at(0).values, {0.1, 0.2, -0.3}, "decrement");
  expect_values(backward[0].extra.at(0).values, {-0.3, 0.4}, "decrement");
  EXPECT_EQ(forward[0].extra[0].label, "log decrement");
  EXPECT_EQ(forward[0].label, "forward");
  EXPECT_EQ(backward[0].label, "backward");
  EXPECT_NE(forward[0].style.color, backward[0].style.color);
  // from the origin to where the diagram ends: 1X above, a quarter of it at the right
  const auto one = series_with(a, "1X excitation"), quarter = series_with(a, "0.25X excitation");
  ASSERT_EQ(one.size(), 1u);
  ASSERT_EQ(quarter.size(), 1u);
  const double top = a.y.max;
  EXPECT_GT(top, 20);
  EXPECT_LT(top, 24);
  expect_series(one[0], {0, 60 * top}, {0, top}, "1X");
  expect_series(quarter[0], {0, 3000}, {0, 12.5}, "0.25X");
  EXPECT_TRUE(has_note(a, 60 * top, top, "1X"));
  EXPECT_TRUE(has_note(a, 3000, 12.5, "0.25X"));
  EXPECT_TRUE(has_note(a, 1000, 20, "1000 rpm"));
  EXPECT_TRUE(has_note(a, 1500, 10, "named"));
}

TEST(PlotNumbers, OfACampbellDiagramOfShaftsThatTurnBackward) {
  plot::CampbellLine l = turning_line();
  l.speed = times(rad_s, {-2000, -500, 500, 1000});
  l.whirl_at.clear();
  const Values orders{0.5};
  const Figure f = plot::plot_campbell("c", "c", std::span(&l, 1), orders, {});
  const auto half = series_with(f.axes.at(0), "0.5X excitation");
  ASSERT_EQ(half.size(), 1u);
  expect_series(half[0], {-2000, 0, 1000}, {2000 / 120.0, 0, 1000 / 120.0}, "0.5X");
}

TEST(PlotNumbers, OfDecrements) {
  plot::CampbellLine l = turning_line(), heavy = turning_line();
  heavy.label = "2";
  heavy.log_decrement = {9, 7, 5, 0.1};
  l.frequency[3] = 0;
  const plot::CampbellLine lines[] = {l, heavy};
  const Values onsets{1500 * rad_s};
  const Figure f = plot::plot_stability("s", "s", lines, onsets);
  ASSERT_EQ(f.axes.size(), 2u);
  const Axes &a = f.axes[0], &near = f.axes[1];
  EXPECT_EQ(titles(a), "speed [rpm], log decrement (unstable below 0) [-]");
  expect_series(series_with(a, "1, forward").at(0), {0, 1000, 2000}, {0.1, 0.2, -0.3}, "1");
  expect_series(series_with(a, "1, backward").at(0), {2000, 3000}, {-0.3, nan},
                "1");  // whirls no more
  expect_series(series_with(a, "2, forward").at(0), {0, 1000, 2000}, {9, 7, 5}, "2");
  expect_values(series_with(a, "2, forward").at(0).extra.at(0).values, {10, 20, 15}, "frequency");
  for (const Axes* x : {&a, &near}) {
    ASSERT_EQ(x->rules.size(), 2u);
    EXPECT_EQ(x->rules[0].value, 0);
    EXPECT_FALSE(x->rules[0].vertical);
    EXPECT_NEAR(x->rules[1].value, 1500, 1e-9);
    EXPECT_TRUE(x->rules[1].vertical);
  }
  EXPECT_EQ(a.rules[1].label, "onset 1500 rpm");
  // enlarged: lines are cut where they leave, 2 from 5 at 2000 rpm to 0.1 at 3000 rpm
  ASSERT_LT(near.y.max, 1);
  ASSERT_LT(near.y.min, -0.3);
  const auto cut = series_with(near, "2, backward");
  ASSERT_EQ(cut.size(), 1u);
  const double speed = 2000 + 1000 * (5 - near.y.max) / 4.9;
  expect_series(cut[0], {speed, 3000}, {near.y.max, 0.1}, "cut");
  const double hz = 15 - 10 * (5 - near.y.max) / 4.9;
  expect_values(cut[0].extra.at(0).values, {hz, 5}, "frequency");
}

TEST(PlotNumbers, OfResponses) {
  const plot::ResponseCurve c{
      "y", times(rad_s, {1000, 2000, 3000}), {10e-6, 40e-6, 20e-6}, {1.5, 4.0, 7.0 - two_pi}};
  const plot::CriticalMark marks[] = {{2100 * rad_s, 0, 1, ""}};
  for (const Amplitude convention : {Amplitude::zero_to_peak, Amplitude::peak_to_peak}) {
    const bool whole = convention == Amplitude::peak_to_peak;
    const std::string of = whole ? "amplitude, peak-to-peak [µm]" : "amplitude, 0-peak [µm]";
    const Values amplitudes = times(whole ? 2 : 1, {10, 40, 20});
    const Figure bode = plot::plot_bode("b", "b", std::span(&c, 1), convention, marks);
    ASSERT_EQ(bode.axes.size(), 2u);
    EXPECT_EQ(titles(bode.axes[0]), "speed [rpm], " + of);
    EXPECT_EQ(titles(bode.axes[1]), "speed [rpm], phase lag [°]");
    expect_series(bode.axes[0].series.at(0), {1000, 2000, 3000}, amplitudes, "bode");
    // without leaps of whole turns
    expect_series(bode.axes[1].series.at(0), {1000, 2000, 3000}, times(180 / pi, {1.5, 4.0, 7.0}),
                  "lag");
    for (const Axes& a : bode.axes) {
      ASSERT_EQ(a.rules.size(), 1u);
      EXPECT_TRUE(a.rules[0].vertical);
      EXPECT_NEAR(a.rules[0].value, 2100, 1e-9);
    }
    EXPECT_EQ(bode.axes[0].rules[0].label, "2100 rpm");
    EXPECT_TRUE(bode.axes[1].share_x);
    const Figure polar = plot::plot_polar("p", "p", std::span(&c, 1), convention);
    const Axes& p = polar.axes.at(0);
    EXPECT_EQ(p.kind, plot::AxesKind::polar);
    EXPECT_TRUE(p.clockwise);
    EXPECT_EQ(titles(p), "phase lag clockwise [°], " + of);
    expect_series(p.series.at(0), times(180 / pi, {1.5, 4.0, 7.0 - two_pi}), amplitudes, "polar");
    expect_values(p.series[0].extra.at(0).values, {1000, 2000, 3000}, "speed");
    EXPECT_TRUE(has_note(p, 4.0 * 180 / pi, amplitudes[1], "2000 rpm"));  // the largest
    // a mark stands at the point next to it and says its own speed
    const Figure marked = plot::plot_polar("p", "p", std::span(&c, 1), convention, marks);
    EXPECT_TRUE(has_note(marked.axes.at(0), 4.0 * 180 / pi, amplitudes[1], "2100 rpm"));
  }
}

// Vectors once a turn of a fast run-up, 30 degrees apart on a circle: what is put between them lies on it,
// and the vectors themselves stay.
TEST(PlotNumbers, BetweenVectorsFarApart) {
  plot::ResponseCurve c{"y", {}, {}, {}};
  for (int k = 0; k <= 12; ++k) {
    c.speed.push_back((1000 + 10 * k) * rad_s);
    c.amplitude.push_back(1e-5);
    c.phase_lag.push_back(k * pi / 6);
  }
  const Figure f = plot::plot_polar("p", "p", std::span(&c, 1), Amplitude::zero_to_peak);
  const plot::Series& s = f.axes.at(0).series.at(0);
  ASSERT_EQ(s.x.size(), 12u * 6u + 1u);
  for (std::size_t k = 0; k < s.x.size(); ++k) {
    const bool own = k % 6 == 0, at_an_end = k < 6 || k > 66;
    EXPECT_NEAR(s.y[k], 10.0, own ? 1e-9 : at_an_end ? 0.5 : 0.03) << k;
    if (own) {
      EXPECT_NEAR(s.x[k], 30.0 * static_cast<double>(k / 6), 1e-9) << k;
    } else if (!at_an_end) {
      EXPECT_NEAR(s.x[k], 5.0 * static_cast<double>(k), 0.6) << k;
    }
    EXPECT_NEAR(s.extra.at(0).values[k], 1000 + 10.0 * static_cast<double>(k) / 6.0, 1e-6) << k;
  }
}

// One line of 3 at 20 Hz, at 600 rpm, and of 1 at 1200 rpm; backward at -20 Hz.
TEST(PlotNumbers, OfSpectraAgainstSpeed) {
  for (const bool full : {false, true}) {
    std::vector<plot::SpectrumTrace> traces;
    for (const double speed : {600.0, 1200.0}) {
      plot::SpectrumTrace t;
      t.speed = speed * rad_s;
      for (int k = full ? -5 : 0; k <= 5; ++k) {
        t.frequency.push_back(two_pi * 10 * k);
        t.amplitude.push_back(std::abs(k) == 2 ? (k > 0 ? 3e-6 : 1e-6) * 600 / speed : 0);
      }
      traces.push_back(t);
    }
    const Values orders{1, 2};
    const Figure f =
        plot::plot_waterfall("w", "w", traces, "y", "m", Amplitude::zero_to_peak, orders);
    const Axes& a = f.axes.at(0);
    EXPECT_EQ(a.x.unit + a.y.unit, "Hzrpm");
    EXPECT_EQ(a.x.label, full ? "frequency, backward < 0 < forward" : "frequency");
    EXPECT_EQ(f.caption, "y, 0-peak [µm] above each trace's speed; the bar gives the scale.");
    double per_y = 0;
    for (const double speed : {600.0, 1200.0}) {
      const auto s = series_with(a, speed == 600 ? "600 rpm" : "1200 rpm");
      ASSERT_EQ(s.size(), 1u);
      EXPECT_NEAR(s[0].baseline, speed, 1e-9);
      EXPECT_EQ(s[0].amplitude_unit, "µm 0-peak");
      per_y = s[0].amplitude_per_y;
      double most = 0, least_x = infinity;
      for (std::size_t k = 0; k < s[0].x.size(); ++k) {
        const double read = (s[0].y[k] - s[0].baseline) * per_y;
        const double hz = s[0].x[k];
        const double wanted = std::abs(hz - 20) < 1e-9           ? 3 * 600 / speed
                              : full && std::abs(hz + 20) < 1e-9 ? 600 / speed
                                                                 : 0;
        EXPECT_NEAR(read, wanted, 0.05) << hz;
        most = std::max(most, read);
        least_x = std::min(least_x, hz);
      }
      EXPECT_NEAR(most, 3 * 600 / speed, 1e-9);
      EXPECT_NEAR(least_x, full ? -50 : 0, 1e-9);
    }
    for (const double order : orders)
      for (const double sign : {1.0, -1.0}) {
        const std::string name = std::string(sign < 0 ? "-" : "") + (order == 1 ? "1X" : "2X");
        const auto s = series_with(a, name);
        ASSERT_EQ(s.size(), full || sign > 0 ? 1u : 0u) << name;
        if (s.empty()) continue;
        EXPECT_NEAR(s[0].y[0], 600, 1e-9);
        for (const std::size_t k : {0, 1})
          EXPECT_NEAR(s[0].x[k], sign * order * s[0].y[k] / 60, 1e-9) << name;
        EXPECT_GT(s[0].y[1], 1200);
        EXPECT_TRUE(has_note(a, s[0].x[1], s[0].y[1], name));
      }
    // the bar is what its text says: a round number below the largest
    const auto bar = series_with(a, "scale");
    ASSERT_EQ(bar.size(), 1u);
    EXPECT_EQ(bar[0].x[0], bar[0].x[1]);
    EXPECT_NEAR((bar[0].y[1] - bar[0].y[0]) * per_y, 2, 1e-9);
    EXPECT_TRUE(has_note(a, bar[0].x[1], bar[0].y[1], "2 µm 0-peak"));
    EXPECT_LT(bar[0].y[1], a.y.max);
  }
}

TEST(PlotNumbers, OfAMapOfSpectra) {
  std::vector<plot::SpectrumTrace> traces;
  for (const double speed : {600.0, 1000.0, 1400.0}) {
    plot::SpectrumTrace t;
    t.speed = speed * rad_s;
    t.frequency = times(two_pi, {0, 10, 20, 30});
    t.amplitude = times(speed * 1e-9, {1, 2, 4, 8});
    traces.push_back(t);
  }
  const Figure f = plot::plot_spectrogram("m", "m", traces, "y", "m", Amplitude::peak_to_peak);
  const Axes& a = f.axes.at(0);
  EXPECT_EQ(titles(a), "speed [rpm], frequency [Hz]");
  ASSERT_EQ(a.heat.size(), 1u);
  const plot::HeatMap& h = a.heat[0];
  EXPECT_EQ(h.label + " [" + h.unit + "]", "y, peak-to-peak [µm]");
  EXPECT_EQ(h.nx, 3);
  EXPECT_EQ(h.ny, 4);
  expect_values({h.x0, h.x1, h.y0, h.y1}, {600, 1400, 0, 30}, "edges");
  expect_values(h.values, {0.6, 1.0, 1.4, 1.2, 2.0, 2.8, 2.4, 4.0, 5.6, 4.8, 8.0, 11.2}, "cells");
  EXPECT_NEAR(h.max, 11.2, 1e-9);
  EXPECT_NEAR(h.min, 11.2e-4, 1e-12);
  EXPECT_TRUE(h.logarithmic);
}

TEST(PlotNumbers, OfACriticalSpeedMap) {
  const plot::Curve modes[] = {{"critical 1", {1e6, 1e8}, times(rad_s, {1000, 2000})}};
  const plot::Curve supports[] = {{"A", {1e5, 1e9}, times(rad_s, {0, 5000})}};
  const Figure f = plot::plot_critical_map("m", "m", modes, supports);
  const Axes& a = f.axes.at(0);
  EXPECT_EQ(titles(a), "support stiffness [N/m], undamped critical speed [rpm]");
  EXPECT_TRUE(a.x.logarithmic && a.y.logarithmic);
  expect_values({a.x.min, a.x.max}, {1e6, 1e8}, "limits");
  expect_series(*labelled(a, "critical 1"), {1e6, 1e8}, {1000, 2000}, "mode");
  expect_series(*labelled(a, "A"), {1e5, 1e9}, {0, 5000}, "support");
}

TEST(PlotNumbers, OfOrbitsAndPaths) {
  const plot::Orbit orbits[] = {{"slow", {1e-5, -2e-5, 3e-5}, {0, 1e-5, -1e-5}, {1}},
                                {"fast", {4e-5, 0, 0}, {0, 5e-5, 0}, {0, 2}}};
  const Figure f = plot::plot_orbit("o", "o", orbits, 100e-6);
  const Axes& a = f.axes.at(0);
  EXPECT_EQ(titles(a), "y displacement [µm], z displacement [µm]");
  EXPECT_TRUE(a.equal_aspect);
  expect_series(*labelled(a, "slow"), {10, -20, 30}, {0, 10, -10}, "slow");
  expect_series(*labelled(a, "fast"), {40, 0, 0}, {0, 50, 0}, "fast");
  const auto slow = series_with(a, "slow, keyphasor"), fast = series_with(a, "fast, keyphasor");
  ASSERT_EQ(slow.size() + fast.size(), 2u);
  expect_series(slow[0], {-20}, {10}, "mark");
  expect_series(fast[0], {40, 0}, {0, 0}, "marks");
  EXPECT_EQ(slow[0].style.color, labelled(a, "slow")->style.color);
  EXPECT_EQ(fast[0].style.color, labelled(a, "fast")->style.color);
  EXPECT_NE(slow[0].style.color, fast[0].style.color);
  EXPECT_EQ(slow[0].label, "keyphasor");
  const Series* wall = labelled(a, "clearance");
  ASSERT_TRUE(wall);
  for (std::size_t k = 0; k < wall->x.size(); ++k)
    EXPECT_NEAR(std::hypot(wall->x[k], wall->y[k]), 100, 1e-9);
  EXPECT_NEAR(wall->x.front(), wall->x.back(), 1e-9);

  const plot::Curve path{"P", {1e-3, 2e-3}, {3e-3, -4e-3}};
  const Figure g = plot::plot_path("p", "p", "y", "z", std::span(&path, 1));
  EXPECT_EQ(titles(g.axes.at(0)), "y [mm], z [mm]");
  EXPECT_TRUE(g.axes[0].equal_aspect);
  expect_series(*labelled(g.axes[0], "P"), {1, 2}, {3, -4}, "path");

  const Values x{0.1, 2.0, 3.0}, y{1e-3, 2e-3, 4e-3}, z{1e-6, -3e-6, 2e-6};
  const Figure h = plot::plot_path_in_space("s", "s", x, y, z);
  const Axes& s = h.axes.at(0);
  EXPECT_EQ(s.x.label + s.y.label + s.z.label, "xyz");
  EXPECT_EQ(s.x.unit + s.y.unit + s.z.unit, "mmmµm");
  ASSERT_EQ(s.space.size(), 3u);
  expect_values(s.space[0].x, {0.1, 2, 3}, "x");
  expect_values(s.space[0].y, {1, 2, 4}, "y");
  expect_values(s.space[0].z, {1, -3, 2}, "z");
  for (const auto& [k, i, text] : {std::tuple{1, 0, "start"}, {2, 2, "end"}}) {
    const plot::SpaceSeries& dot = s.space[static_cast<std::size_t>(k)];
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(dot.label, text);
    expect_values({dot.x.at(0), dot.y.at(0), dot.z.at(0)},
                  {s.space[0].x[at], s.space[0].y[at], s.space[0].z[at]}, text);
  }
}

// Of a thousandth to a hundred thousand million: three digits before the point at most, but for the
// last step, and a second is never a kilosecond.
TEST(PlotNumbers, UnitsOfEverySize) {
  struct Unit {
    const char* si;
    double size, factor;
    const char* name;
  };
  for (const Unit& u : {Unit{"N", 2e10, 1e-9, "GN"}, {"N", 9e9, 1e-6, "MN"},
                        {"N", 2e7, 1e-6, "MN"},      {"N", 9e6, 1e-3, "kN"},
                        {"N", 2e4, 1e-3, "kN"},      {"N", 9e3, 1, "N"},
                        {"N", 0.2, 1, "N"},          {"N", 0.09, 1e3, "mN"},
                        {"N", 2e-4, 1e3, "mN"},      {"N", 9e-5, 1e6, "µN"},
                        {"N", 2e-7, 1e6, "µN"},      {"N", 9e-8, 1e9, "nN"},
                        {"N m", 2e4, 1e-3, "kN·m"},  {"N.m", 5, 1, "N·m"},
                        {"Pa", 2e7, 1e-6, "MPa"},    {"W", 2e4, 1e-3, "kW"},
                        {"J", 2e-4, 1e3, "mJ"},      {"Hz", 2e4, 1e-3, "kHz"},
                        {"s", 2e4, 1, "s"},          {"s", 0.05, 1e3, "ms"},
                        {"s", 2e-5, 1e6, "µs"},      {"N", 0, 1, "N"},
                        {"m/s", 0.4, 1e3, "mm/s"},   {"m/s", 0.6, 1, "m/s"},
                        {"rad", 5, 1, "rad"},        {"m", 0.6, 1, "m"},
                        {"m", 0.4, 1e3, "mm"},       {"m", 2e-3, 1e3, "mm"},
                        {"m", 9e-4, 1e6, "µm"},      {"m", 2e-7, 1e6, "µm"},
                        {"m", 9e-8, 1e9, "nm"},      {"m", 0, 1, "m"}}) {
    const plot::DisplayUnit is = plot::unit_for(u.si, u.size);
    EXPECT_EQ(is.name, u.name) << u.si << u.size;
    EXPECT_NEAR(is.factor, u.factor, 1e-12 * u.factor) << u.si << u.size;
  }
}

TEST(PlotNumbers, OfClearances) {
  const plot::ReachLine line{"rotor", {0, 0.5, 1}, {10e-6, 30e-6, 20e-6}};
  const plot::GapMark gaps[] = {{"seal", 0.25, 120e-6, 30e-6}, {"blade", 0.75, 200e-6, 50e-6}};
  const Figure f = plot::plot_clearances("c", "c", std::span(&line, 1), gaps);
  const Axes& a = f.axes.at(0);
  EXPECT_EQ(titles(a), "axial position [mm], distance from the middle [µm]");
  expect_series(*labelled(a, "rotor"), {0, 500, 1000}, {10, 30, 20}, "rotor");
  expect_series(*labelled(a, "in the gap"), {250, 750}, {30, 50}, "used");
  EXPECT_TRUE(has_note(a, 250, 120, "seal: 25 %"));
  EXPECT_TRUE(has_note(a, 750, 200, "blade: 25 %"));
  EXPECT_EQ(labelled(a, "in the gap")->point_names.at(0), "seal: 25 %");
  ASSERT_EQ(a.patches.size(), 2u);
  EXPECT_EQ(a.patches[0].label, "walls");
  EXPECT_EQ(a.patches[1].tooltip, "blade: gap 200");
  for (const std::size_t k : {0, 1}) {  // from the gap to the upper edge, about its place
    const plot::Patch& p = a.patches[k];
    const double x = k == 0 ? 250 : 750, gap = k == 0 ? 120 : 200;
    EXPECT_NEAR(p.x[0] + p.x[1], 2 * x, 1e-9);
    EXPECT_GT(p.x[1], p.x[0]);
    expect_values(p.y, {gap, gap, a.y.max, a.y.max}, "wall");
  }
  EXPECT_GT(a.y.max, 200);
}

}  // namespace whirl::io
