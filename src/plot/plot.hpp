// Figures as plain data: what to draw, not how. render_svg() (svg.hpp) draws them, the report shows
// them. Every axis has a label and a unit; amplitudes say "0-peak" or "peak-to-peak" in the label.
#pragma once
#include <core/types.hpp>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace whirl::plot {

enum class Dash { solid, dashed, dotted, dash_dot };
enum class Marker { none, circle, square, diamond, triangle, cross, plus };

/// Colours come from one palette that colour-blind readers can tell apart, dark and light; see
/// palette.hpp.
inline constexpr int next_color = -1;  ///< the next one of the palette
inline constexpr int ink = -2;         ///< the text colour
inline constexpr int faint = -3;       ///< grid grey

struct Style {
  int color = next_color;
  Dash dash = Dash::solid;
  double width = 1.6;  ///< px; 0 = no line
  Marker marker = Marker::none;
  double marker_size = 6.0;  ///< px
  bool filled = true;        ///< markers
  double opacity = 1.0;
};

/// One more value a point, shown when the pointer is on it ("log decrement").
struct Extra {
  std::string label, unit;
  std::vector<double> values;
};

/// A curve or a cloud of points. nan in x or y breaks the line.
struct Series {
  std::string label;  ///< legend entry; empty: none
  std::vector<double> x, y;
  Style style{};
  bool right_axis = false;
  bool fill_to_baseline = false;  ///< waterfalls: hides what is behind
  double baseline = 0.0;          ///< waterfalls: y of zero amplitude ...
  double amplitude_per_y =
      0.0;  ///< ... and the readout is (y - baseline) * amplitude_per_y; 0 = plain y
  std::string amplitude_unit;  ///< of that readout
  std::string trace_label;     ///< shown in the readout instead of label
  std::vector<Extra> extra{};
  std::vector<std::string> point_names{};  ///< one a point, shown in the readout ("tolerance 1e-6")
  bool keep_all =
      false;  ///< no decimation (few points that all matter; also implied by extra and point_names)
};

struct Bars {
  std::string label;
  std::vector<double> x, height;
  double width = 0.8;
  Style style{};
  bool right_axis = false;
};

/// A closed polygon, filled.
struct Patch {
  std::string label;
  std::vector<double> x, y;
  Style style{};
  double fill_opacity = 0.25;
  std::string tooltip;
};

/// Cells of a regular grid, rows from y0 to y1. values[iy * nx + ix].
struct HeatMap {
  int nx = 0, ny = 0;
  double x0 = 0, x1 = 1, y0 = 0, y1 = 1;  ///< outer edges
  std::vector<double> values;
  std::string label, unit;  ///< of the colour bar
  bool logarithmic = false;
  double min = nan, max = nan;  ///< nan: from the data
};

/// Text at a point; with `leader` a small circle there and the text beside it.
struct Note {
  double x = 0, y = 0;
  std::string text;
  bool leader = true;
  double dx = 8, dy = -8;  ///< px from the point to the text
  bool right_axis = false;
};

/// A straight line right across the axes: x = value or y = value.
struct Rule {
  bool vertical = true;
  double value = 0;
  std::string label;
  Style style{faint, Dash::dashed, 1.0};
};

struct Axis {
  std::string label, unit;  ///< unit "-" for dimensionless
  bool logarithmic = false;
  double min = nan, max = nan;  ///< nan: from the data
  bool include_zero = false;
  std::vector<double> ticks{};             ///< empty: chosen
  std::vector<std::string> tick_labels{};  ///< names instead of numbers, one a tick (bars)
  Axis() = default;
  Axis(std::string label_, std::string unit_, bool log = false)
      : label(std::move(label_)),
        unit(std::move(unit_)),
        logarithmic(log) {}
};

/// A point or curve in space (trajectories, mode shapes).
struct SpaceSeries {
  std::string label;
  std::vector<double> x, y, z;
  Style style{};
  bool closed_fill = false;  ///< planes: filled polygon
  /// Complex amplitude of each point, in the units of the axes: the point is drawn where it is at
  /// phase 0 and is at rest + Re(motion exp(i phase)); empty: it stands still.
  std::vector<std::array<Complex, 3>> motion{};
  /// Which points of the figure's Replay move it, [from, to); trails are the paths of each of them.
  struct Played {
    std::size_t from = 0, to = 0;
    bool trails = false;
  };
  std::optional<Played> played{};
};

/// Moments of a motion that the report sets a figure in space to, each with the motion that begins
/// there: samples at equal times, displacement (y, z) of points, m.
struct Replay {
  std::vector<double> time, speed, span;  ///< s, rad/s, s that the samples of a moment cover
  std::size_t samples = 0, points = 0;
  std::vector<float> y, z;  ///< [moment][sample][point]
  std::size_t shown = 0;    ///< moment that is drawn
  std::vector<Vec3> rest;   ///< of the points, in units of the axes
  double gain = 1;          ///< units of the y and z axes a metre of displacement
};

enum class AxesKind { cartesian, polar, space };

/// One pair of axes. polar: x is the phase in degrees, y the amplitude. space: only `space` series
/// and x, y, z axes.
struct Axes {
  AxesKind kind = AxesKind::cartesian;
  std::string title;
  Axis x, y, z;
  Axis right;                 ///< used when a series says right_axis
  bool equal_aspect = false;  ///< one metre is one metre in both directions (orbits, drawings)
  bool legend = true;
  bool clockwise = false;  ///< polar: direction of growing phase lag
  double zero_at = 0.0;    ///< polar: where 0 deg stands, deg counter-clockwise from the right
  std::array<double, 3> space_aspect{1, 1, 1};  ///< space: box proportions
  std::array<double, 2> view{-60, 22};          ///< space: azimuth and elevation, deg
  std::vector<Series> series;
  std::vector<Bars> bars;
  std::vector<Patch> patches;
  std::vector<HeatMap> heat;  ///< at most one
  std::vector<Note> notes;
  std::vector<Rule> rules;
  std::vector<SpaceSeries> space;
  double weight = 1.0;   ///< share of the figure's height among the rows
  bool share_x = false;  ///< same x range as the axes above; zooms with it
};

/// One picture: one or several axes in a grid, filled row by row.
struct Figure {
  std::string name;  ///< file name and anchor: letters, digits, - and _
  std::string title, caption;
  std::vector<Axes> axes;
  int columns = 1;
  double width = 760, height = 420;  ///< px
  std::shared_ptr<const Replay> replay{};
};

}  // namespace whirl::plot
