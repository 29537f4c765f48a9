// Spectra against speed: waterfall and map.
#include <plot/plots.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot {
namespace {

struct Extent {
  double speed0 = infinity, speed1 = -infinity, amplitude = 0;
  double frequency0 = 0, frequency1 = 0;  ///< Hz; frequency0 < 0: backward whirl apart
};

Extent extent_of(std::span<const SpectrumTrace> traces) {
  Extent e;
  for (const auto& t : traces) {
    e.speed0 = std::min(e.speed0, t.speed * rpm);
    e.speed1 = std::max(e.speed1, t.speed * rpm);
    for (const double v : t.frequency) {
      e.frequency0 = std::min(e.frequency0, v * hertz);
      e.frequency1 = std::max(e.frequency1, v * hertz);
    }
    for (const double v : t.amplitude)
      if (std::isfinite(v)) e.amplitude = std::max(e.amplitude, v);
  }
  if (!(e.speed1 > e.speed0)) e.speed1 = e.speed0 + 1;
  return e;
}

std::string quantity_name(const std::string& quantity, Amplitude convention) {
  return quantity + ", " + to_string(convention);
}

// A round number near x from below: 1, 2 or 5 times a power of ten.
double round_down(double x) {
  const double p = std::pow(10, std::floor(std::log10(x)));
  return x >= 5 * p ? 5 * p : x >= 2 * p ? 2 * p : p;
}

/// By falling speed, so that lower traces stand in front; at most about sixty can be told apart.
std::vector<const SpectrumTrace*> distinct_traces(std::span<const SpectrumTrace> traces) {
  std::vector<const SpectrumTrace*> order;
  for (const auto& t : traces)
    order.push_back(&t);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* x, const auto* y) { return x->speed > y->speed; });
  std::vector<const SpectrumTrace*> shown;
  const std::size_t stride = std::max<std::size_t>(1, (order.size() + 59) / 60);
  for (std::size_t i = 0; i < order.size(); i += stride)
    shown.push_back(order[i]);
  return shown;
}

/// What the traces of a waterfall share.
struct Waterfall {
  Extent extent;
  DisplayUnit unit;
  std::string convention;
  double height = 0, per_y = 1;  ///< of the largest amplitude, rpm; amplitude a unit of the axis
};

/// Points of a line that are needed for it to stay within the tolerance: one is kept where no straight
/// line from the last kept passes all since (a door that swings shut).
std::vector<std::size_t> corners_of(std::span<const double> x, std::span<const double> y,
                                    double tolerance) {
  std::vector<std::size_t> kept;
  if (!x.empty()) kept.push_back(0);
  double low = -infinity, high = infinity;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const auto slope = [&](double to) { return (to - y[kept.back()]) / (x[i] - x[kept.back()]); };
    if (slope(y[i]) < low || slope(y[i]) > high) {
      kept.push_back(i - 1);
      low = -infinity;
      high = infinity;
    }
    low = std::max(low, slope(y[i] - tolerance));
    high = std::min(high, slope(y[i] + tolerance));
  }
  if (x.size() > 1) kept.push_back(x.size() - 1);
  return kept;
}

Series waterfall_trace(const SpectrumTrace& t, const Waterfall& w) {
  Series s;
  s.baseline = t.speed * rpm;
  s.amplitude_per_y = w.per_y;
  s.amplitude_unit = w.unit.name + " " + w.convention;
  s.fill_to_baseline = true;
  s.style = {0, Dash::solid, 1.0};
  s.trace_label = readable(s.baseline, 5) + " rpm";
  const double tolerance = 0.003 * w.height * w.per_y / w.unit.factor;  // a quarter of a pixel
  for (const std::size_t i : corners_of(t.frequency, t.amplitude, tolerance)) {
    s.x.push_back(t.frequency[i] * hertz);
    s.y.push_back(s.baseline + t.amplitude[i] * w.unit.factor / w.per_y);
  }
  return s;
}

/// The line of an order of the speed, to a little beyond the last trace.
void add_order_line(Axes& a, double order, const Waterfall& w) {
  const Extent& e = w.extent;
  const double end = e.speed1 + 0.6 * w.height;
  const double edge = order > 0 ? e.frequency1 : e.frequency0;
  const double last = std::min(end, edge * 60 / order);
  if (last <= e.speed0) return;
  Series s;
  s.x = {e.speed0 * order / 60, last * order / 60};
  s.y = {e.speed0, last};
  s.style = {1, Dash::dashed, 0.9};
  s.trace_label = number_text(order, 3) + "X";
  const bool at_edge = last < end;
  a.notes.push_back({last * order / 60, last, s.trace_label, false,
                     at_edge == (order > 0) ? -24.0 : 3.0, at_edge ? -4.0 : 0.0});
  a.series.push_back(std::move(s));
}

void add_amplitude_bar(Axes& a, const Waterfall& w) {
  const Extent& e = w.extent;
  if (!(e.amplitude > 0)) return;
  const double bar = round_down(e.amplitude * w.unit.factor), x = 0.985 * e.frequency1,
               y1 = e.speed1 + 1.0 * w.height, y0 = y1 - bar / w.per_y;
  Series s;
  s.x = {x, x};
  s.y = {y0, y1};
  s.style = {ink, Dash::solid, 2.5};
  s.trace_label = "scale";
  a.series.push_back(std::move(s));
  const std::string text = number_text(bar, 6) + " " + w.unit.name + " " + w.convention;
  a.notes.push_back({x, y1, text, false, -8 - text_width(text, 11), 10});
}

}  // namespace

Figure plot_waterfall(std::string name, std::string title, std::span<const SpectrumTrace> traces,
                      const std::string& quantity, const std::string& unit, Amplitude convention,
                      std::span<const double> orders) {
  const Extent e = extent_of(traces);
  const std::vector<const SpectrumTrace*> shown = distinct_traces(traces);
  const double spacing =
      (e.speed1 - e.speed0) / std::max(1.0, static_cast<double>(shown.size()) - 1.0);
  Waterfall w{e, unit_for(unit, e.amplitude), to_string(convention)};
  w.height = std::max(0.16 * (e.speed1 - e.speed0), 1.5 * spacing);
  if (e.amplitude > 0) w.per_y = e.amplitude * w.unit.factor / w.height;
  Axes a;
  a.x = Axis("frequency", "Hz");
  a.y = Axis("speed", "rpm");
  a.legend = false;
  a.y.min = e.speed0 - 0.02 * (e.speed1 - e.speed0);
  a.y.max = e.speed1 + 1.05 * w.height;
  a.x.min = e.frequency0;
  a.x.max = e.frequency1;
  if (e.frequency0 < 0) a.x.label = "frequency, backward < 0 < forward";
  for (const SpectrumTrace* t : shown)
    a.series.push_back(waterfall_trace(*t, w));
  for (const double order : orders) {
    add_order_line(a, order, w);
    if (e.frequency0 < 0) add_order_line(a, -order, w);
  }
  add_amplitude_bar(a, w);
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 560;
  f.caption = quantity_name(quantity, convention) + " [" + w.unit.name +
              "] above each trace's speed; the bar gives the scale.";
  f.axes.push_back(std::move(a));
  return f;
}

Figure plot_spectrogram(std::string name, std::string title, std::span<const SpectrumTrace> traces,
                        const std::string& quantity, const std::string& unit, Amplitude convention,
                        bool logarithmic) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 460;
  Axes a;
  a.x = Axis("speed", "rpm");
  a.y = Axis("frequency", "Hz");
  const Extent e = extent_of(traces);
  const DisplayUnit u = unit_for(unit, e.amplitude);
  std::size_t lines = 1;
  for (const auto& t : traces)
    lines = std::max(lines, t.frequency.size());
  HeatMap h;
  h.nx = static_cast<int>(std::clamp<std::size_t>(traces.size(), 1, 360));
  h.ny = static_cast<int>(std::clamp<std::size_t>(lines, 1, 300));
  h.x0 = e.speed0;
  h.x1 = e.speed1;
  h.y0 = 0;
  h.y1 = e.frequency1 > 0 ? e.frequency1 : 1;
  h.label = quantity_name(quantity, convention);
  h.unit = u.name;
  h.logarithmic = logarithmic;
  const auto nx = static_cast<std::size_t>(h.nx), ny = static_cast<std::size_t>(h.ny);
  h.values.assign(nx * ny, nan);
  // Each cell holds the largest amplitude that falls into it; a column nobody falls into repeats
  // its left neighbour.
  for (const auto& t : traces) {
    const auto ix = std::min(
        nx - 1,
        static_cast<std::size_t>((t.speed * rpm - h.x0) / (h.x1 - h.x0) * static_cast<double>(nx)));
    for (std::size_t i = 0; i < t.frequency.size(); ++i) {
      const double hz = t.frequency[i] * hertz;
      if (!(hz >= 0)) continue;
      const auto iy =
          std::min(ny - 1, static_cast<std::size_t>(hz / h.y1 * static_cast<double>(ny)));
      double& cell = h.values[iy * nx + ix];
      if (const double v = t.amplitude[i] * u.factor; !(cell >= v)) cell = v;
    }
  }
  for (std::size_t ix = 1; ix < nx; ++ix)
    if (std::isnan(h.values[ix]))
      for (std::size_t iy = 0; iy < ny; ++iy)
        if (std::isnan(h.values[iy * nx + ix])) h.values[iy * nx + ix] = h.values[iy * nx + ix - 1];
  if (logarithmic && e.amplitude > 0) {
    h.max = e.amplitude * u.factor;
    h.min = h.max * 1e-4;
  }
  a.heat.push_back(std::move(h));
  f.axes.push_back(std::move(a));
  return f;
}

}  // namespace whirl::plot
