// Inside of the renderer: shared by the files that draw cartesian, polar and 3-D axes.
//
// What the report's script relies on: <g class="axes"> carries data-kind, data-box and, per axis,
// data-x / data-y / data-r = "lo hi log" with label and unit; curves stand in <g class="plot"> as
// paths in px, which the script turns back into values; what must keep its size under zoom stands
// in <g class="pins"> with its px position; data-s numbers the series.
#pragma once
#include <plot/plot.hpp>
#include <plot/svg.hpp>
#include <plot/ticks.hpp>
#include <string>
#include <vector>

namespace whirl::plot::svg {

struct Box {
  double x = 0, y = 0, w = 0, h = 0;
  double right() const { return x + w; }
  double bottom() const { return y + h; }
  bool overlaps(const Box& o) const {
    return x < o.right() && o.x < right() && y < o.bottom() && o.y < bottom();
  }
};

/// Values to px, linear or logarithmic.
struct Scale {
  double lo = 0, hi = 1;
  bool log = false;
  double p0 = 0, p1 = 1;
  double operator()(double v) const;  ///< nan where a logarithmic axis has no place
};

struct Point {
  double x, y;
};

/// Curves of one of the axes of a drawing, and their scales: a second drawing repeats them.
struct DrawnPlot {
  std::string id;
  Scale x, y, right;
};

struct Segment {
  double x0, y0, x1, y1;
};

/// Ranges of the data of some axes, with margins, before they have a frame.
struct DataScales {
  Scale x, y, right;
};

struct Canvas {
  std::string out;
  const Figure& figure;
  const SvgOptions& options;
  std::string prefix;               ///< id of the picture
  std::vector<DrawnPlot>* drawn{};  ///< written by the first drawing of two, read by the second
  bool narrow = false;              ///< the second of two
  std::size_t plots = 0;            ///< of `drawn`, met so far
  int ids = 0;
  const std::vector<DataScales>* data{};  ///< of each of the axes; whole histories are read once
  std::string id() {
    return (options.marks.empty() ? prefix : options.marks) + "-" + std::to_string(++ids);
  }
  void add(std::string_view s) { out += s; }
  /// name="value" with two decimals.
  void attr(const char* name, double v);
  void text(double x, double y, std::string_view content, double size, const char* anchor = "start",
            std::string_view extra = {});
  /// No wider than `width`, if need be in smaller letters.
  void text_within(double width, double x, double y, std::string_view content, double size,
                   const char* anchor, std::string_view extra = {});
  void line(double x0, double y0, double x1, double y1, std::string_view rest);
  /// Lines of one look; in a page they are one path.
  void lines(const std::vector<Segment>& all, std::string_view rest);
};

/// The group of the curves, maps and bodies of some axes. In the second drawing of two it is that of
/// the first, moved and stretched, where one stretch suits all its scales.
class PlotGroup {
 public:
  /// right: y where there is no right axis.
  PlotGroup(Canvas& c, const Scale& x, const Scale& y, const Scale& right);
  /// What is drawn from now on is left out again.
  bool repeats() const { return !repeated_.empty(); }
  void end();

 private:
  Canvas& c_;
  std::string repeated_;  ///< instead of what is drawn; empty: that
  std::size_t from_ = 0;
};

inline constexpr double tick_size = 11.5, label_size = 12.5, title_size = 13.5, legend_size = 11.5,
                        note_size = 11;
/// A browser without the fonts asked for takes others, which are wider.
inline constexpr double wide_fonts = 1.15;

/// class and presentation attributes of a stroke or fill in palette colour k (or ink, faint). Solid
/// strokes in a colour beyond the palette, which comes round again, are dashed.
std::string stroke(int color, double width = 0, Dash dash = Dash::solid);
std::string fill(int color);
std::string paper_fill();

/// Palette indices of all series of some axes, next_color resolved; series, bars, patches, space in
/// that order.
struct Colors {
  std::vector<int> series, bars, patches, space;
};
Colors resolve_colors(const Axes& a);

std::string axis_title(const Axis& a, int exponent = 0);
/// data-x="lo hi log" and the label and unit that the readout shows.
void axis_attributes(Canvas& c, const char* name, const Axis& a, const Scale& s);

/// Path data of points, broken at nan. Appends what it drew to `seen` when given. In the report long
/// curves are written by their differences, in tenths of a px: half the size.
std::string path_of(const std::vector<double>& px, const std::vector<double>& py, bool keep_all,
                    bool increasing, const SvgOptions& options, std::vector<Point>* seen);
/// Name, further values and point names of a curve as attributes for the readout.
std::string readout_attributes(const Series& s, const std::vector<double>& px,
                               const std::vector<double>& py);
/// `<use>` markers at points; defines the marker's shape first.
void draw_pins(Canvas& c, const std::vector<double>& px, const std::vector<double>& py,
               const Style& style, int color, int series, bool right, std::string_view rest,
               const Box* clip = nullptr);

struct LegendEntry {
  std::string label;
  Style style;
  int color;
  int series;
  bool patch = false, bar = false;
};
std::vector<LegendEntry> legend_entries(const Axes& a, const Colors& k);
/// Size of the legend box: one column, or as many as the width given (of a narrow drawing) takes.
Box legend_size_of(const std::vector<LegendEntry>& entries, double width = 0);
/// Whether every place inside the frame hides some of `seen` or `taken`.
bool legend_hides(const std::vector<LegendEntry>& entries, const Box& frame,
                  const std::vector<Point>& seen, const std::vector<Box>& taken);
/// Draws it where it hides the fewest of `seen` inside the frame, or at `outside` when its width is
/// positive. width: as of legend_size_of().
void draw_legend(Canvas& c, const std::vector<LegendEntry>& entries, const Box& frame,
                 const std::vector<Point>& seen, const std::vector<Box>& taken, const Box& outside,
                 double width = 0);

/// Range of cartesian data, with margins; what the axis fixes stays.
DataScales data_range(const Axes& a);

/// Ticks about `spacing` px apart on an axis of `length` px.
Ticks axis_ticks(const Axis& a, const Scale& s, double length, double spacing);
double widest_label(const Ticks& t);

/// Cartesian axes ready to draw: scales (right = r) and their ticks.
struct Prepared {
  Scale x, y, r;
  Ticks tx, ty, tr;
};
/// Markers that are drawn after all curves.
struct PinJob {
  std::vector<double> x, y;
  std::size_t series;
  int color;
  std::string attributes;
};
void draw_heat(Canvas& c, const HeatMap& h, const Prepared& p);
void draw_color_bar(Canvas& c, const HeatMap& h, const Box& bar);
/// pins_only: the curves are not drawn, nor added to what is seen.
void draw_series(Canvas& c, const Axes& a, const Colors& k, const Prepared& p,
                 std::vector<Point>& seen, std::vector<PinJob>& pins, bool pins_only);
void draw_bars_and_patches(Canvas& c, const Axes& a, const Colors& k, const Prepared& p);
/// Where the name of a rule stands; an empty box of one that has none or is not in sight. Below the
/// fourth row of names the others are numbers, and stand in the key.
struct RuleName {
  Box at;
  int number = 0;  ///< 0: its label
};
std::vector<RuleName> places_of_names(const Axes& a, const Scale& x, const Scale& y, const Box& b);
/// Height that names of vertical rules take at the top of the frame, px.
double names_height(const Axes& a, const Scale& x, const Box& b);
void draw_rules(Canvas& c, const Axes& a, const Prepared& p, const Box& b);
/// A circle at p and the text beside it, where it covers the least of what is there; adds its place
/// to `taken`.
void draw_note(Canvas& c, const Point& p, const std::string& text, const Box& frame,
               std::vector<Box>& taken, const std::vector<Point>& seen);
/// Where the notes of some axes stand: beside their points, or, where there is no room for a text, a
/// number there and the text in a key beneath, behind those of the rules.
struct PlacedNote {
  std::size_t note = 0;
  Point point{0, 0};
  Box at;
  int number = 0;  ///< 0: its text
};
struct NotePlan {
  Box frame;
  std::vector<PlacedNote> notes;
  std::vector<std::string> key;  ///< "1: impeller"
};
NotePlan place_notes(const Axes& a, const Prepared& p, const Box& frame,
                     const std::vector<Point>& seen);
/// Height of the key, px; 0 without one.
double key_height(const NotePlan& plan, double width);
/// Names of rules, and the notes where the plan has them. seen: points of the curves, which are
/// dimmed behind a text.
void draw_notes(Canvas& c, const Axes& a, const Prepared& p, const Box& b, const NotePlan& plan,
                const std::vector<Point>& seen, std::vector<Box>& taken);
void draw_key(Canvas& c, const NotePlan& plan, const Point& corner, double width);

struct Margins {
  double left = 0, right = 0, top = 0, bottom = 0;
};
struct CartesianFlags {
  bool hide_x = false;
  bool legend_outside = false;
  NotePlan notes;
  double legend_width = 0;  ///< of a narrow drawing: the legend stands below, so wide
};
inline constexpr double narrow_width = 360;  ///< px, of the drawing for telephones
inline constexpr double narrow_legend_width = 352;
/// Also decides where the legend stands. data: data_range() of the axes, here and below.
Margins cartesian_margins(const Axes& a, const DataScales& data, double width, double height,
                          CartesianFlags& f);
/// Of a frame that stands.
NotePlan plan_notes(const Axes& a, const DataScales& data, const Box& frame);
/// Of a frame that stands: its ticks may have wider labels than those reckoned with.
double left_margin(const Axes& a, const DataScales& data, const Box& frame);
void draw_cartesian(Canvas& c, const Axes& a, const DataScales& data, const Box& frame,
                    const CartesianFlags& f);
void draw_polar(Canvas& c, const Axes& a, const Box& cell);
void draw_space(Canvas& c, const Axes& a, const Box& cell);

}  // namespace whirl::plot::svg
