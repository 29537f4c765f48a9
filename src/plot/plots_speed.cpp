// Plots against speed: Campbell, stability, Bode, polar, critical-speed map.
#include <plot/plots.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace whirl::plot {
namespace {

struct Look {
  Whirl whirl;
  const char* name;
  Style style;
};
const std::array<Look, 4>& looks() {
  static const std::array<Look, 4> l = {
      {{Whirl::forward, "forward", {0, Dash::solid, 1.8}},
       {Whirl::backward, "backward", {1, Dash::dashed, 1.8}},
       {Whirl::mixed, "mixed", {2, Dash::dotted, 2.0}},
       {Whirl::none, "torsional, axial", {3, Dash::dash_dot, 1.5}}}};
  return l;
}
const Look& look(Whirl w) { return looks()[static_cast<std::size_t>(w)]; }

/// A decrement of 2 pi is a damping ratio of 0.707: beyond it no excitation finds a resonance.
constexpr double heavy_decrement = two_pi;
const Style heavy_style{ink, Dash::dotted, 0.7};
constexpr const char* heavy_name = "damping ratio above 0.7";

// One series for each stretch of a line with the same whirl direction; stretches share their end
// points. heavy: stretches so heavily damped that they have no resonance are drawn thin; null: none
// is; else whether one was.
void add_line(Axes& a, const CampbellLine& line, std::span<const double> y, const char* extra_label,
              const char* extra_unit, std::span<const double> extra, std::array<bool, 4>& used,
              bool* heavy = nullptr) {
  const auto whirl = [&](std::size_t i) {
    return i < line.whirl_at.size() ? line.whirl_at[i] : line.whirl;
  };
  const auto is_heavy = [&](std::size_t i) {
    return heavy && i < line.log_decrement.size() && line.log_decrement[i] > heavy_decrement;
  };
  const std::size_t n = std::min(line.speed.size(), y.size());
  for (std::size_t i = 0; i < n;) {
    std::size_t j = i + 1;
    while (j < n && whirl(j) == whirl(i) && is_heavy(j) == is_heavy(i))
      ++j;
    const Look& l = look(whirl(i));
    Series s;
    s.style = is_heavy(i) ? heavy_style : l.style;
    s.trace_label = line.label + (whirl(i) == Whirl::none ? "" : std::string(", ") + l.name);
    if (is_heavy(i)) {
      if (!std::exchange(*heavy, true)) s.label = heavy_name;
    } else if (!std::exchange(used[static_cast<std::size_t>(l.whirl)], true)) {
      s.label = l.name;
    }
    Extra e{extra_label, extra_unit, {}};
    for (std::size_t k = i; k < std::min(n, j + 1); ++k) {
      s.x.push_back(rpm * line.speed[k]);
      s.y.push_back(y[k]);
      if (k < extra.size()) e.values.push_back(extra[k]);
    }
    if (!e.values.empty()) s.extra.push_back(std::move(e));
    a.series.push_back(std::move(s));
    i = j;
  }
}

/// Whether a line that ends at k, coming from `before`, ends because its motion no longer
/// oscillates: heavily damped there, or its damping ratio about to be 1 at the next speed.
bool becomes_overdamped(const CampbellLine& line, std::size_t k, std::ptrdiff_t back) {
  if (line.log_decrement[k] > heavy_decrement) return true;
  const std::ptrdiff_t b = static_cast<std::ptrdiff_t>(k) + back;
  if (b < 0 || b >= std::ssize(line.log_decrement)) return false;
  const auto ratio = [&](std::size_t i) {
    return line.log_decrement[i] / std::hypot(two_pi, line.log_decrement[i]);
  };
  const double growth = ratio(k) - ratio(static_cast<std::size_t>(b));
  return ratio(k) + 1.5 * growth > 1.0;
}

/// The ends of lines whose motion becomes overdamped, a mark each.
Series overdamped_ends(std::span<const CampbellLine> lines) {
  Series ends;
  ends.label = "becomes overdamped";
  ends.style = {ink, Dash::solid, 0, Marker::diamond, 6, false};
  ends.keep_all = true;
  for (const CampbellLine& line : lines) {
    const std::size_t n =
        std::min({line.frequency.size(), line.log_decrement.size(), line.speed.size()});
    const auto there = [&](std::size_t k) { return line.frequency[k] > 0; };
    for (std::size_t k = 0; k < n; ++k) {
      if (!there(k)) continue;
      const bool goes = k + 1 < n && !there(k + 1) && becomes_overdamped(line, k, -1);
      const bool comes = k > 0 && !there(k - 1) && becomes_overdamped(line, k, 1);
      if (!goes && !comes) continue;
      ends.x.push_back(rpm * line.speed[k]);
      ends.y.push_back(hertz * line.frequency[k]);
    }
  }
  return ends;
}

std::string order_name(double order) { return number_text(order, 3) + "X"; }

}  // namespace

Figure plot_campbell(std::string name, std::string title, std::span<const CampbellLine> lines,
                     std::span<const double> orders, std::span<const CriticalMark> criticals,
                     double reach) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 500;
  Axes a;
  a.x = Axis("speed", "rpm");
  a.y = Axis("damped natural frequency", "Hz");
  a.x.include_zero = a.y.include_zero = true;
  double top = reach * hertz, end = 0, start = 0;
  std::array<bool, 4> used{};
  bool heavy = false;
  for (const auto& l : lines) {
    std::vector<double> y(l.frequency);
    for (double& v : y)
      v = v > 0 ? v * hertz : nan;  // an overdamped mode does not oscillate
    for (const double v : y)
      if (v > top) top = v;
    for (const double v : l.speed) {
      end = std::max(end, v);
      start = std::min(start, v);
    }
    add_line(a, l, y, "log decrement", "-", l.log_decrement, used, &heavy);
  }
  a.y.max = top > 0 ? 1.06 * top : nan;
  for (const double order : orders) {
    if (!(end > 0 || start < 0) || !(order > 0)) continue;
    const double at_top = 1.06 * top / (order * hertz);
    const double limit = std::min(end, at_top);
    const double back = std::min(-start, at_top);  // shafts that turn the other way
    Series s;
    s.x = {0, limit * rpm};
    s.y = {0, order * limit * hertz};
    if (back > 0) {
      s.x.insert(s.x.begin(), -back * rpm);
      s.y.insert(s.y.begin(), order * back * hertz);
    }
    s.style = {ink, Dash::solid, 0.8};
    s.trace_label = order_name(order) + " excitation";
    a.series.push_back(std::move(s));
    const bool at_right = limit == end;
    a.notes.push_back({limit * rpm, order * limit * hertz, order_name(order), false,
                       at_right ? -30.0 : 4.0, at_right ? -5.0 : 14.0});
  }
  if (Series ends = overdamped_ends(lines); !ends.x.empty()) a.series.push_back(std::move(ends));
  for (const auto& c : criticals)
    a.notes.push_back({c.speed * rpm, c.frequency * hertz,
                       c.label.empty() ? readable(c.speed * rpm, 4) + " rpm" : c.label});
  f.axes.push_back(std::move(a));
  return f;
}

namespace {

/// The part of a line between two values; where it leaves them it is cut at the very value.
Series part_between(const Series& line, double low, double high) {
  Series out = line;
  out.x.clear();
  out.y.clear();
  std::erase_if(out.extra, [&](const Extra& e) { return e.values.size() != line.y.size(); });
  const std::vector<Extra> extra = out.extra;
  for (Extra& e : out.extra)
    e.values.clear();
  const auto add = [&](std::size_t i, double share) {  // a share of the way to the point behind it
    const std::size_t j = share > 0.0 ? i + 1 : i;
    out.x.push_back(std::lerp(line.x[i], line.x[j], share));
    out.y.push_back(std::lerp(line.y[i], line.y[j], share));
    for (std::size_t k = 0; k < out.extra.size(); ++k)
      out.extra[k].values.push_back(std::lerp(extra[k].values[i], extra[k].values[j], share));
  };
  const auto leave = [&] {
    if (out.y.empty() || std::isnan(out.y.back())) return;
    out.x.push_back(out.x.back());
    out.y.push_back(nan);
    for (Extra& e : out.extra)
      e.values.push_back(nan);
  };
  const auto inside = [&](double y) { return y >= low && y <= high; };
  for (std::size_t i = 0; i < line.y.size(); ++i) {
    if (inside(line.y[i])) add(i, 0.0);
    if (i + 1 == line.y.size()) break;
    const double rise = line.y[i + 1] - line.y[i];
    std::array<double, 2> cuts{(low - line.y[i]) / rise, (high - line.y[i]) / rise};
    if (cuts[0] > cuts[1]) std::swap(cuts[0], cuts[1]);
    for (const double cut : cuts)
      if (cut > 0.0 && cut < 1.0) add(i, cut);
    if (!inside(line.y[i + 1])) leave();
  }
  return out;
}

/// Decrements about zero, where stability is decided, in axes of their own: heavily damped modes
/// take the scale of the others. Nothing where these can be read as they are.
std::optional<Axes> enlarged_about_zero(const Axes& whole) {
  constexpr double usually_asked_for = 0.1;  // API 617, RP 684
  double least = 0, most = 0;
  for (const Series& s : whole.series)
    for (const double y : s.y) {
      least = std::min(least, y);
      most = std::max(most, y);
    }
  const double reach = std::max(2.0 * usually_asked_for, -1.5 * least);
  if (!(most > 4.0 * reach)) return std::nullopt;
  Axes a;
  a.x = whole.x;
  a.y = Axis("enlarged about zero", "-");
  a.y.min = least < 0 ? -1.1 * std::max(-least, 0.1 * reach) : 0.0;
  a.y.max = reach;
  a.legend = false;
  a.share_x = true;
  for (const Series& s : whole.series)
    if (Series part = part_between(s, a.y.min, a.y.max); !part.y.empty())
      a.series.push_back(std::move(part));
  for (Rule rule : whole.rules) {
    rule.label.clear();
    a.rules.push_back(std::move(rule));
  }
  if (a.series.empty()) return std::nullopt;
  return a;
}

}  // namespace

Figure plot_stability(std::string name, std::string title, std::span<const CampbellLine> lines,
                      std::span<const double> thresholds) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  Axes a;
  a.x = Axis("speed", "rpm");
  a.y = Axis("log decrement (unstable below 0)", "-");
  a.x.include_zero = a.y.include_zero = true;
  std::array<bool, 4> used{};
  for (const auto& l : lines) {
    std::vector<double> hz(l.frequency);
    for (double& v : hz)
      v *= hertz;
    std::vector<double> decrement(l.log_decrement);  // of a motion that whirls: others have none
    for (std::size_t k = 0; k < decrement.size() && k < l.frequency.size(); ++k)
      if (!(l.frequency[k] > 0)) decrement[k] = nan;
    add_line(a, l, decrement, "frequency", "Hz", hz, used);
  }
  a.rules.push_back({false, 0, "", {ink, Dash::solid, 1.0}});
  for (const double s : thresholds)
    a.rules.push_back(
        {true, s * rpm, "onset " + readable(s * rpm, 5) + " rpm", {1, Dash::dashed, 1.2}});
  std::optional<Axes> near = enlarged_about_zero(a);
  f.axes.push_back(std::move(a));
  if (near) {
    f.height = 560;
    f.axes.push_back(std::move(*near));
  }
  return f;
}

namespace {

DisplayUnit amplitude_unit(std::span<const ResponseCurve> curves, double factor) {
  double m = 0;
  for (const auto& c : curves)
    for (const double v : c.amplitude)
      if (std::isfinite(v)) m = std::max(m, factor * v);
  return length_unit(m);
}

// Degrees, without jumps of whole turns.
std::vector<double> unwrapped(const std::vector<double>& phase) {
  std::vector<double> out;
  double last = nan;
  for (const double p : phase) {
    double d = p * 180 / pi;
    if (!std::isnan(last) && !std::isnan(d)) d += 360 * std::round((last - d) / 360);
    if (!std::isnan(d)) last = d;
    out.push_back(d);
  }
  return out;
}

}  // namespace

Figure plot_bode(std::string name, std::string title, std::span<const ResponseCurve> curves,
                 Amplitude convention, std::span<const CriticalMark> criticals,
                 bool log_amplitude) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 540;
  const double factor = factor_of(convention);
  const DisplayUnit u = amplitude_unit(curves, factor);
  Axes amplitude, phase;
  amplitude.x = phase.x = Axis("speed", "rpm");
  amplitude.y = Axis(std::string("amplitude, ") + to_string(convention), u.name, log_amplitude);
  amplitude.y.include_zero = !log_amplitude;
  phase.y = Axis("phase lag", "°");
  phase.legend = false;
  phase.share_x = true;
  phase.weight = 0.55;
  for (const auto& c : curves) {
    Series s, p;
    s.label = p.label = c.label;
    for (const double v : c.speed)
      s.x.push_back(v * rpm);
    p.x = s.x;
    for (const double v : c.amplitude)
      s.y.push_back(v * factor * u.factor);
    p.y = unwrapped(c.phase_lag);
    amplitude.series.push_back(std::move(s));
    phase.series.push_back(std::move(p));
  }
  for (const auto& c : criticals) {
    amplitude.rules.push_back({true,
                               c.speed * rpm,
                               c.label.empty() ? readable(c.speed * rpm, 4) + " rpm" : c.label,
                               {ink, Dash::dotted, 1.0}});
    phase.rules.push_back({true, c.speed * rpm, "", {ink, Dash::dotted, 1.0}});
  }
  f.axes = {std::move(amplitude), std::move(phase)};
  return f;
}

namespace {

/// Points of a vector that one can tell apart: of a long run most lie on one another.
std::vector<std::size_t> distinct_points(const ResponseCurve& c) {
  const std::size_t n = std::min({c.speed.size(), c.amplitude.size(), c.phase_lag.size()});
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (std::isfinite(c.amplitude[i])) largest = std::max(largest, c.amplitude[i]);
  const double apart = n > 300 ? 4e-3 * largest : 0.0;
  std::vector<std::size_t> keep;
  Complex last(nan, nan);
  for (std::size_t i = 0; i < n; ++i) {
    const Complex x = std::polar(c.amplitude[i], c.phase_lag[i]);
    if (std::abs(x - last) < apart && i + 1 < n && c.amplitude[i] < largest) continue;
    keep.push_back(i);
    last = x;
  }
  return keep;
}

/// Points next to the speeds of a list, rpm.
std::vector<std::size_t> points_at(const std::vector<double>& speeds,
                                   std::span<const CriticalMark> marks) {
  std::vector<std::size_t> out;
  for (const CriticalMark& m : marks) {
    const auto nearer = [&](double a, double b) {
      return std::abs(a - rpm * m.speed) < std::abs(b - rpm * m.speed);
    };
    out.push_back(static_cast<std::size_t>(std::min_element(speeds.begin(), speeds.end(), nearer) -
                                           speeds.begin()));
  }
  return out;
}

/// Speeds are written where the vector has turned by 40 degrees or more, and at the peaks: those
/// marked, or the largest value. curves: how many share the axes.
void note_speeds(Axes& a, const Series& s, const std::vector<double>& speeds,
                 std::span<const CriticalMark> marks, std::size_t curves) {
  if (s.y.empty()) return;
  constexpr std::size_t on_all = 12;  // more hide the curves
  const std::size_t most = a.notes.size() + std::max<std::size_t>(2, on_all / curves);
  const auto peak =
      static_cast<std::size_t>(std::max_element(s.y.begin(), s.y.end()) - s.y.begin());
  std::vector<std::size_t> peaks = points_at(speeds, marks);
  if (peaks.empty()) peaks.push_back(peak);
  const auto turned = [&](std::size_t i, double from) {
    return std::abs(std::remainder(s.x[i] - from, 360));
  };
  const auto note = [&](std::size_t i) {
    a.notes.push_back({s.x[i], s.y[i], readable(speeds[i], 4) + " rpm"});
  };
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    if (std::find(peaks.begin(), peaks.begin() + static_cast<std::ptrdiff_t>(k), peaks[k]) !=
        peaks.begin() + static_cast<std::ptrdiff_t>(k))
      continue;
    note(peaks[k]);
    if (k < marks.size()) a.notes.back().text = readable(marks[k].speed * rpm, 4) + " rpm";
  }
  double last = nan;
  for (std::size_t i = 0; i < s.x.size() && a.notes.size() < most; ++i) {
    if (std::find(peaks.begin(), peaks.end(), i) != peaks.end()) {
      last = s.x[i];
      continue;
    }
    if (!(s.y[i] >= 0.2 * s.y[peak]) || (!std::isnan(last) && turned(i, last) < 40)) continue;
    const bool crowded = std::any_of(
        peaks.begin(), peaks.end(), [&](std::size_t p) { return i < p && turned(i, s.x[p]) < 25; });
    if (crowded) continue;
    note(i);
    last = s.x[i];
  }
}

/// A vector, its phase lag (rad) and the speed there, rpm.
struct VectorPoint {
  Complex vector;
  double lag, speed;
};

/// Points of a vector that one can tell apart, with some between those at which the polygon has corners
/// (once a turn of a fast run-up): on the cubic through neighbours (E. Catmull, R. Rom, 1974). Between
/// vectors that turn by more than a right angle nothing is known, and the line stays straight.
std::vector<VectorPoint> smooth_points(const ResponseCurve& c) {
  std::vector<VectorPoint> p;
  for (const std::size_t i : distinct_points(c))
    p.push_back({std::polar(c.amplitude[i], c.phase_lag[i]), c.phase_lag[i], c.speed[i] * rpm});
  const auto bend = [&](std::size_t i) {  // rad, of the polygon at a point; 0 at its ends
    if (i == 0 || i + 1 >= p.size()) return 0.0;
    const Complex a = p[i].vector - p[i - 1].vector, b = p[i + 1].vector - p[i].vector;
    return std::abs(a) > 0.0 && std::abs(b) > 0.0 ? std::abs(std::arg(b / a)) : 0.0;
  };
  constexpr double corner = 0.2, unknown = 0.5 * pi;
  constexpr int between = 5;
  std::vector<VectorPoint> out;
  for (std::size_t i = 0; i < p.size(); ++i) {
    out.push_back(p[i]);
    if (i + 1 == p.size()) break;
    const double sharpest = std::max(bend(i), bend(i + 1));
    if (!(sharpest > corner) || sharpest > unknown) continue;
    const Complex a = p[i].vector, b = p[i + 1].vector;
    const Complex slope_a = i > 0 ? 0.5 * (b - p[i - 1].vector) : b - a;
    const Complex slope_b = i + 2 < p.size() ? 0.5 * (p[i + 2].vector - a) : b - a;
    for (int k = 1; k <= between; ++k) {
      const double x = static_cast<double>(k) / (between + 1), y = 1.0 - x;
      const Complex v = y * y * (1.0 + 2.0 * x) * a + x * x * (1.0 + 2.0 * y) * b +
                        x * y * (y * slope_a - x * slope_b);
      out.push_back({v, p[i].lag + std::arg(v / a), std::lerp(p[i].speed, p[i + 1].speed, x)});
    }
  }
  return out;
}

}  // namespace

Figure plot_polar(std::string name, std::string title, std::span<const ResponseCurve> curves,
                  Amplitude convention, std::span<const CriticalMark> marks) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.width = 620;
  f.height = 520;
  const double factor = factor_of(convention);
  const DisplayUnit u = amplitude_unit(curves, factor);
  Axes a;
  a.kind = AxesKind::polar;
  a.clockwise = true;  // growing lag runs against the spin
  a.x = Axis("phase lag clockwise", "°");
  a.y = Axis(std::string("amplitude, ") + to_string(convention), u.name);
  for (const auto& c : curves) {
    Series s;
    s.label = c.label;
    Extra speed{"speed", "rpm", {}};
    for (const VectorPoint& p : smooth_points(c)) {
      s.x.push_back(p.lag * 180 / pi);
      s.y.push_back(std::abs(p.vector) * factor * u.factor);
      speed.values.push_back(p.speed);
    }
    note_speeds(a, s, speed.values, marks, curves.size());
    s.extra.push_back(std::move(speed));
    a.series.push_back(std::move(s));
  }
  f.axes.push_back(std::move(a));
  return f;
}

Figure plot_critical_map(std::string name, std::string title, std::span<const Curve> modes,
                         std::span<const Curve> supports) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 480;
  Axes a;
  a.x = Axis("support stiffness", "N/m", true);
  a.y = Axis("undamped critical speed", "rpm", true);
  double lo = infinity, hi = 0;
  for (const auto& m : modes) {
    Series s;
    s.label = m.label;
    s.x = m.x;
    for (const double v : m.y)
      s.y.push_back(v * rpm);
    for (const double v : m.x) {
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
    a.series.push_back(std::move(s));
  }
  if (hi > lo) {
    a.x.min = lo;
    a.x.max = hi;
  }
  int color = static_cast<int>(modes.size());  // those behind the modes'
  for (const auto& b : supports) {
    Series s;
    s.label = b.label;
    s.style = {color, color % 2 == 0 ? Dash::dashed : Dash::dash_dot, 1.3};
    ++color;
    s.x = b.x;
    for (const double v : b.y)
      s.y.push_back(v * rpm);
    a.series.push_back(std::move(s));
  }
  f.axes.push_back(std::move(a));
  return f;
}

}  // namespace whirl::plot
