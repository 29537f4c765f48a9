// Where things stand in a figure: axes about their data, ticks and curves where their values belong,
// samples of a legend beside their names.
#include "xml_check.hpp"
#include <core/types.hpp>
#include <gtest/gtest.h>
#include <plot/plots.hpp>
#include <plot/svg.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

namespace whirl::io {
namespace {

/// Numbers of a text, whatever parts them.
std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> out;
  static const std::regex number("-?[0-9]+(?:\\.[0-9]+)?(?:e[-+]?[0-9]+)?");
  for (auto i = std::sregex_iterator(text.begin(), text.end(), number); i != std::sregex_iterator();
       ++i)
    out.push_back(std::strtod(i->str().c_str(), nullptr));
  return out;
}

/// What stands between two texts, the first time after `from`.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t a = text.find(from);
  if (a == std::string::npos) return "";
  const std::size_t b = a + from.size();
  return text.substr(b, text.find(to, b) - b);
}

std::string attribute(const std::string& text, const std::string& name) {
  return between(text, " " + name + "=\"", "\"");
}

/// Axes of a drawn figure.
struct Drawn {
  std::string svg;
  std::vector<double> box, x, y;  ///< px: left, top, width, height; limits
  explicit Drawn(const plot::Axes& a) {
    plot::Figure f;
    f.name = "f";
    f.axes.push_back(a);
    svg = plot::render_svg(f);
    EXPECT_EQ(xml_fault(svg), "");
    const std::string head = between(svg, "<g class=\"axes\"", ">");
    box = numbers_of(attribute(head, "data-box"));
    x = numbers_of(attribute(head, "data-x"));
    y = numbers_of(attribute(head, "data-y"));
  }
  static double share(const std::vector<double>& limits, double v) {
    if (limits[2] != 0) return std::log(v / limits[0]) / std::log(limits[1] / limits[0]);
    return (v - limits[0]) / (limits[1] - limits[0]);
  }
  double px(double v) const { return box[0] + box[2] * share(x, v); }
  double py(double v) const { return box[1] + box[3] * (1 - share(y, v)); }
};

plot::Axes axes(const std::vector<double>& x, const std::vector<double>& y, bool log = false) {
  plot::Axes a;
  a.x = plot::Axis("x", "-");
  a.y = plot::Axis("y", "-", log);
  plot::Series s;
  s.label = "curve";
  s.x = x;
  s.y = y;
  a.series.push_back(s);
  return a;
}

}  // namespace

// Air above and below is the same; where data end at a zero that is to be shown, the axis does.
TEST(Drawing, LimitsLeaveTheSameAirOnBothSides) {
  const Drawn linear(axes({0, 1}, {2, 12}));
  EXPECT_LT(linear.y[0], 2);
  EXPECT_NEAR(2 - linear.y[0], linear.y[1] - 12, 1e-12);
  EXPECT_LT(linear.y[1], 13.5);
  const Drawn log(axes({0, 1}, {1e-3, 1e2}, true));
  EXPECT_LT(log.y[0], 1e-3);
  EXPECT_NEAR(1e-3 / log.y[0], log.y[1] / 1e2, 1e-12);
  EXPECT_LT(log.y[1], 1e3);
  plot::Axes a = axes({0, 1}, {2, 12});
  a.y.include_zero = true;
  EXPECT_EQ(Drawn(a).y[0], 0);
  EXPECT_GT(Drawn(a).y[1], 12);
  a.series[0].y = {-2, -12};
  EXPECT_EQ(Drawn(a).y[1], 0);
  a = axes({0, 1}, {1e-3, 1e2}, true);
  a.y.include_zero = true;  // there is none
  EXPECT_EQ(Drawn(a).y, log.y);
  a.y.min = 1e-4;
  a.y.max = 1e4;
  EXPECT_EQ(Drawn(a).y, (std::vector<double>{1e-4, 1e4, 1}));
  EXPECT_EQ(Drawn(axes({0, 4}, {1, 2})).x, (std::vector<double>{0, 4, 0}));  // from edge to edge
  const Drawn constant(axes({0, 1}, {5, 5}));
  EXPECT_NEAR(5 - constant.y[0], constant.y[1] - 5, 1e-12);
}

// A curve all over the frame leaves no place for a legend; a line along the diagonal does.
TEST(Drawing, LegendsLieOnNoCurve) {
  const auto legend_of = [](const Drawn& d) {
    return numbers_of(between(d.svg, "<g class=\"legend\"><rect", "/>"));  // rx, x, y, ...
  };
  plot::Axes loops = axes({}, {});  // to and fro all over the frame
  for (int k = 0; k <= 200; ++k) {
    loops.series[0].x.push_back(0.05 * k);
    loops.series[0].y.push_back(k % 2 == 0 ? -5 : 5);
  }
  const Drawn full(loops);
  EXPECT_GE(legend_of(full).at(1), full.box[0] + full.box[2]);
  const Drawn free(axes({0, 1}, {0, 1}));
  EXPECT_LT(legend_of(free).at(1), free.box[0] + free.box[2]);
}

// Names of places along a shaft: the curve below them keeps clear of every row of them.
TEST(Drawing, NamesStandAboveTheData) {
  plot::Axes a = axes({0, 0.5, 1}, {0, 10, 0});
  const Drawn bare(a);
  for (const double x : {0.45, 0.46, 0.47, 0.48, 0.49})  // the first stands at the left of its rule
    a.rules.push_back({true, x, "a long name"});
  const Drawn named(a);
  double lowest = 0;
  for (std::size_t at = named.svg.find("data-lock=\"y\""); at != std::string::npos;
       at = named.svg.find("data-lock=\"y\"", at + 1))
    lowest = std::max(lowest, std::stod(attribute(named.svg.substr(at), "y")));
  EXPECT_GT(lowest, named.box[1] + 4 * 14 - 6);  // four rows
  EXPECT_GT(named.py(10), lowest);
  EXPECT_EQ(named.y[0], bare.y[0]);
}

// What a page moves with the data when it is enlarged: the foot of a rule, along its own axis.
TEST(Drawing, NamesOfRulesArePinnedToThem) {
  plot::Axes a = axes({0, 1}, {0, 10});
  a.rules.push_back({true, 0.25, "upright"});
  a.rules.push_back({false, 4, "level"});
  const Drawn d(a);
  const auto pin = [&](const char* lock) {
    const std::size_t at = d.svg.find(std::string("data-lock=\"") + lock);
    return numbers_of(attribute(d.svg.substr(d.svg.rfind("<g class=\"pin\"", at)), "data-p"));
  };
  EXPECT_NEAR(pin("y").at(0), d.px(0.25), 0.01);
  EXPECT_NEAR(pin("y").at(1), d.box[1], 0.01);
  EXPECT_NEAR(pin("x").at(0), d.box[0] + d.box[2], 0.01);
  EXPECT_NEAR(pin("x").at(1), d.py(4), 0.01);
}

TEST(Drawing, ColoursThatComeAgainAreDashed) {
  plot::Axes a = axes({0, 1}, {0, 0});
  for (int k = 1; k < 18; ++k) {
    plot::Series s = a.series[0];
    s.y = {0, double(k)};
    a.series.push_back(s);
  }
  const Drawn d(a);
  std::vector<std::string> dashes;
  for (std::size_t at = d.svg.find("<path data-s="); at != std::string::npos;
       at = d.svg.find("<path data-s=", at + 1))
    dashes.push_back(attribute(d.svg.substr(at, d.svg.find("/>", at) - at), "stroke-dasharray"));
  ASSERT_EQ(dashes.size(), 18u);
  EXPECT_EQ(dashes[7], "");
  EXPECT_NE(dashes[8], "");
  EXPECT_NE(dashes[16], "");
  EXPECT_NE(dashes[16], dashes[8]);
}

// Ticks of the frame as it stands: wider labels than those of a first guess still leave the title
// of the axis in the figure.
TEST(Drawing, TitlesOfAxesStayInTheFigure) {
  for (const double top : {1.0, 0.75, 1.5, 12.5, 99.0, 1234.0}) {
    plot::Figure f;
    f.name = "f";
    for (int k = 0; k < 3; ++k) {
      f.axes.push_back(axes({0, 1}, {-top, top}));
      f.axes.back().weight = k == 0 ? 1.8 : 1;
      f.axes.back().equal_aspect = k == 2;
    }
    const std::string svg = plot::render_svg(f);
    std::size_t titles = 0;
    for (std::size_t at = svg.find("data-label=\"y\""); at != std::string::npos;
         at = svg.find("data-label=\"y\"", at + 1)) {
      const std::size_t text = svg.rfind("<text", at);
      EXPECT_GE(std::stod(attribute(svg.substr(text), "x")), 0.72 * 12.5) << top;
      ++titles;
    }
    EXPECT_EQ(titles, 3u);
  }
}

TEST(Drawing, CurvesAndTicksStandWhereTheirValuesBelong) {
  for (const bool log : {false, true}) {
    const std::vector<double> x{0, 2, 3, 8}, y{1, 30, 4, 90};
    const Drawn d(axes(x, y, log));
    const std::string curve = between(d.svg, "<path data-s=\"0\"", "/>");
    const std::vector<double> path = numbers_of(attribute(curve, "d"));
    ASSERT_EQ(path.size(), 8u) << curve;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(path[2 * i], d.px(x[i]), 0.06);
      EXPECT_NEAR(path[2 * i + 1], d.py(y[i]), 0.06);
    }
    for (const bool across : {true, false}) {
      const std::string ticks =
          between(d.svg, across ? "<g class=\"tx\">" : "<g class=\"ty\">", "</g>");
      static const std::regex label("<text([^>]*)>([0-9.]+)</text>");
      int count = 0;
      for (auto i = std::sregex_iterator(ticks.begin(), ticks.end(), label);
           i != std::sregex_iterator(); ++i, ++count) {
        const std::string where = (*i)[1].str();
        const double v = std::strtod((*i)[2].str().c_str(), nullptr),
                     x_there = std::strtod(attribute(where, "x").c_str(), nullptr),
                     y_there = std::strtod(attribute(where, "y").c_str(), nullptr);
        if (across)
          EXPECT_NEAR(x_there, d.px(v), 0.06) << v;
        else
          EXPECT_NEAR(y_there, d.py(v) + 4, 0.06) << v;  // the baseline
      }
      EXPECT_GE(count, 3) << ticks;
    }
  }
}

// A line, a patch and bars: each sample is centred in the row of its name, left of it.
TEST(Drawing, SamplesOfALegendStandBesideTheirNames) {
  plot::Axes a = axes({0, 4}, {0, 10});
  a.bars.push_back({});
  a.bars[0].label = "bars";
  a.bars[0].x = {1, 2};
  a.bars[0].height = {3, 4};
  a.patches.push_back({});
  a.patches[0].label = "patch";
  a.patches[0].x = {3, 3.5, 3.5, 3};
  a.patches[0].y = {1, 1, 2, 2};
  const Drawn d(a);
  const std::string legend = d.svg.substr(d.svg.find("<g class=\"legend\">"));
  const std::vector<double> frame = [&] {
    const std::string r = between(legend, "<rect", "/>");
    return std::vector<double>{std::stod(attribute(r, "x")), std::stod(attribute(r, "y")),
                               std::stod(attribute(r, "width")), std::stod(attribute(r, "height"))};
  }();
  std::size_t at = 0, rows = 0;
  double last = frame[1];
  while ((at = legend.find("<g class=\"entry\"", at)) != std::string::npos) {
    const std::string entry = legend.substr(at, legend.find("</g>", at) - at);
    at += 1;
    const std::string row = between(entry, "<rect", "/>");
    const double height = std::stod(attribute(row, "height")),
                 middle = std::stod(attribute(row, "y")) + height / 2;
    EXPECT_GT(middle, last);
    EXPECT_LT(middle + height / 2, frame[1] + frame[3]);
    last = middle;
    const std::string text = between(entry, "<text", ">");
    EXPECT_NEAR(std::stod(attribute(text, "y")), middle + 4, 0.06);
    const std::string rest = entry.substr(entry.find("/>") + 2);
    double left, right, centre;
    if (rest.starts_with("<rect")) {
      left = std::stod(attribute(rest, "x"));
      right = left + std::stod(attribute(rest, "width"));
      centre = std::stod(attribute(rest, "y")) + std::stod(attribute(rest, "height")) / 2;
    } else {
      left = std::stod(attribute(rest, "x1"));
      right = std::stod(attribute(rest, "x2"));
      centre = std::stod(attribute(rest, "y1"));
      EXPECT_EQ(attribute(rest, "y2"), attribute(rest, "y1"));
    }
    EXPECT_NEAR(centre, middle, 0.06) << entry;
    EXPECT_GT(left, frame[0] + 4);
    EXPECT_GT(right - left, 10);
    EXPECT_LT(right, std::stod(attribute(text, "x")));
    ++rows;
  }
  EXPECT_EQ(rows, 3u);
}

TEST(Drawing, TheUprightAxisOfASpaceIsNamedUpright) {
  plot::Axes a;
  a.kind = plot::AxesKind::space;
  a.x = plot::Axis("along", "m");
  a.y = plot::Axis("across", "m");
  a.z = plot::Axis("up", "m");
  plot::SpaceSeries s;
  s.x = {0, 1, 2};
  s.y = {0, 1, 0};
  s.z = {0, 0.5, 1};
  a.space.push_back(s);
  plot::Figure f;
  f.name = "f";
  f.axes.push_back(a);
  const std::string svg = plot::render_svg(f);
  for (const char* name : {"along", "across", "up"}) {
    const std::size_t at = svg.find(std::string(">") + name + " [m]<");
    ASSERT_NE(at, std::string::npos) << name;
    const std::string head = svg.substr(svg.rfind('<', at), at - svg.rfind('<', at));
    EXPECT_EQ(head.find("rotate(-90") != std::string::npos, std::string(name) == "up") << head;
  }
}

// The same air on both sides of data in space, limits where they are given, points where they belong.
TEST(Drawing, PointsOfASpaceStandWhereTheirValuesBelong) {
  for (const bool fixed : {false, true})
    for (const bool equal : {false, true}) {
      plot::Axes a;
      a.kind = plot::AxesKind::space;
      a.equal_aspect = equal;
      a.x = plot::Axis("x", "-");
      a.y = plot::Axis("y", "-");
      a.z = plot::Axis("z", "-");
      if (fixed) {
        a.y.min = -5;
        a.y.max = 7;
      }
      plot::SpaceSeries s;
      s.x = {0, 4, 10};
      s.y = {-2, 1, 3};
      s.z = {1, 2.5, 2};
      a.space.push_back(s);
      plot::Figure f;
      f.name = "f";
      f.axes.push_back(a);
      const std::string svg = plot::render_svg(f);
      const std::string head = between(svg, "<g class=\"axes\"", ">");
      const std::vector<double> half = numbers_of(attribute(head, "data-half"));
      ASSERT_EQ(half.size(), 3u);
      const std::vector<double> xyz =
          numbers_of(attribute(between(svg, "<path data-s=\"0\"", "/>"), "data-xyz"));
      ASSERT_EQ(xyz.size(), 9u);
      const std::vector<double>* data[] = {&s.x, &s.y, &s.z};
      double length[3];
      for (std::size_t d = 0; d < 3; ++d) {
        const std::vector<double> limits =
            numbers_of(attribute(head, std::string("data-") + "xyz"[d]));
        ASSERT_EQ(limits.size(), 3u);
        length[d] = limits[1] - limits[0];
        const auto [low, high] = std::minmax_element(data[d]->begin(), data[d]->end());
        if (d == 1 && fixed) {
          EXPECT_EQ(limits[0], -5);
          EXPECT_EQ(limits[1], 7);
        } else {
          EXPECT_LT(limits[0], *low);
          EXPECT_NEAR(*low - limits[0], limits[1] - *high, 1e-12);
          EXPECT_LT(length[d], 1.2 * (*high - *low));
        }
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(xyz[3 * i + d], half[d] * (2 * ((*data[d])[i] - limits[0]) / length[d] - 1),
                      1e-4)
              << d;
      }
      if (!equal) continue;
      for (const std::size_t d : {1, 2})  // one unit of length for all
        EXPECT_NEAR(half[d] / half[0], length[d] / length[0], 1e-4);
    }
}

// The highest line of a Campbell diagram is below its upper edge, the lines of order end there.
TEST(Drawing, CampbellReachesALittleAboveItsHighestLine) {
  plot::CampbellLine low, high;
  low.label = "1 B";
  high.label = "1 F";
  low.speed = high.speed = {0, 100, 200};
  low.frequency = {60, 50, 40};
  high.frequency = {60, 75, 90};
  low.log_decrement = high.log_decrement = {0.1, 0.1, 0.1};
  const plot::CampbellLine lines[] = {low, high};
  const double orders[] = {1};
  const plot::Axes a = plot::plot_campbell("c", "c", lines, orders, {}).axes.front();
  EXPECT_NEAR(a.y.max, 1.06 * 90 / two_pi, 1e-9);
  const plot::Series& order = a.series.back();
  EXPECT_NEAR(order.y.back(), 1.06 * 90 / two_pi, 1e-9);
  EXPECT_NEAR(order.x.back(), 1.06 * 90 * 60 / two_pi, 1e-9);
}

// The tallest trace reaches a sixth of the speeds, or over its neighbour where there are few.
TEST(Drawing, TracesOfAWaterfallReachOverTheirNeighbours) {
  for (const int count : {3, 41}) {
    std::vector<plot::SpectrumTrace> traces;
    for (int i = 0; i < count; ++i)
      traces.push_back(
          {100.0 + 400.0 * i / (count - 1), {0, 50, 100}, {0, i == 1 ? 2e-5 : 1e-6, 0}});
    const plot::Axes a = plot::plot_waterfall("w", "w", traces, "displacement", "m",
                                              plot::Amplitude::zero_to_peak, {})
                             .axes.front();
    const double rpm = 60 / two_pi, span = 400 * rpm,
                 height = std::max(0.16 * span, 1.5 * span / (count - 1));
    double reach = 0;
    for (const plot::Series& s : a.series)
      for (const double y : s.y)
        if (!std::isnan(s.baseline) && s.fill_to_baseline) reach = std::max(reach, y - s.baseline);
    EXPECT_NEAR(reach, height, 1e-9 * height) << count;
    EXPECT_NEAR(a.y.max, 500 * rpm + 1.05 * height, 1e-9 * height);
    EXPECT_NEAR(a.y.min, 100 * rpm - 0.02 * span, 1e-9 * height);
  }
}

TEST(Drawing, UnitsOfQuantitiesSuitTheirSize) {
  struct Row {
    const char* si;
    double size;
    const char* name;
    double factor;
  };
  // from a tenth to ten thousand
  const Row rows[] = {
      {"m/s", 0.2, "mm/s", 1e3}, {"m/s", 3, "m/s", 1},       {"m/s", 0, "m/s", 1},
      {"m", 3e-5, "µm", 1e6},    {"m", 2e-8, "nm", 1e9},     {"m", 0.4, "mm", 1e3},
      {"N m", 3e3, "N·m", 1},    {"N m", 3e4, "kN·m", 1e-3}, {"Pa", 2e6, "kPa", 1e-3},
      {"Pa", 2e7, "MPa", 1e-6},  {"Pa", 2e10, "GPa", 1e-9},  {"W", 2e-3, "mW", 1e3},
      {"J", 2e-6, "µJ", 1e6},    {"J", 2e-9, "nJ", 1e9},     {"N", 20, "N", 1},
      {"N", 0, "N", 1},          {"Hz", 0.2, "Hz", 1},       {"s", 0.02, "ms", 1e3},
      {"s", 2e5, "s", 1},        {"kg", 2e6, "kg", 1}};
  for (const Row& r : rows) {
    const plot::DisplayUnit u = plot::unit_for(r.si, r.size);
    EXPECT_EQ(u.name, r.name) << r.si << " " << r.size;
    EXPECT_DOUBLE_EQ(u.factor, r.factor) << r.si << " " << r.size;
  }
}

}  // namespace whirl::io
