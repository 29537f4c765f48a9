// Figures: thinning keeps extremes, ticks are where a reader expects them, SVG is well-formed, axes
// name their units.
#include "gallery.hpp"
#include "temp_folder.hpp"
#include "xml_check.hpp"
#include <io/file.hpp>
#include <plot/decimate.hpp>
#include <plot/palette.hpp>
#include <plot/png.hpp>
#include <plot/svg.hpp>
#include <core/text.hpp>
#include <plot/ticks.hpp>
#include <png.h>
#include <zlib.h>
#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>

namespace whirl::io {
namespace {

TEST(Decimate, EveryColumnKeepsItsLowestAndHighestPoint) {
  std::mt19937 rng(7);
  std::normal_distribution<double> noise;
  std::vector<double> x, y;
  for (int i = 0; i < 1000000; ++i) {
    x.push_back(i * 1e-5);
    y.push_back(noise(rng) * (i == 123456 ? 1000 : 1));
  }
  constexpr std::size_t columns = 700;
  const auto keep = plot::decimate_columns(x, y, 0, 10, columns);
  EXPECT_LE(keep.size(), 4 * columns);
  EXPECT_TRUE(std::is_sorted(keep.begin(), keep.end()));
  std::vector<double> lo(columns, 1e9), hi(columns, -1e9), klo = lo, khi = hi;
  const auto column = [&](double v) {
    return std::min(columns - 1, static_cast<std::size_t>(v * columns / 10));
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    lo[column(x[i])] = std::min(lo[column(x[i])], y[i]);
    hi[column(x[i])] = std::max(hi[column(x[i])], y[i]);
  }
  for (const auto i : keep) {
    klo[column(x[i])] = std::min(klo[column(x[i])], y[i]);
    khi[column(x[i])] = std::max(khi[column(x[i])], y[i]);
  }
  EXPECT_EQ(lo, klo);
  EXPECT_EQ(hi, khi);
  EXPECT_EQ(keep.front(), 0u);
  EXPECT_EQ(keep.back(), x.size() - 1);
}

TEST(Decimate, GapsStayGaps) {
  std::vector<double> x(1000), y(1000, 1.0);
  for (std::size_t i = 0; i < 1000; ++i)
    x[i] = static_cast<double>(i);
  for (std::size_t i = 400; i < 500; ++i)
    y[i] = nan;
  const auto keep = plot::decimate_columns(x, y, 0, 1000, 10);
  EXPECT_EQ(std::count_if(keep.begin(), keep.end(), [&](auto i) { return std::isnan(y[i]); }), 1);
  EXPECT_TRUE(std::find(keep.begin(), keep.end(), 399u) != keep.end());
  EXPECT_TRUE(std::find(keep.begin(), keep.end(), 500u) != keep.end());
}

TEST(Decimate, RepeatedOrbitIsDrawnOnce) {
  std::vector<double> x, y;
  for (int i = 0; i < 100000; ++i) {
    x.push_back(100 * std::cos(two_pi * i / 500));
    y.push_back(100 * std::sin(two_pi * i / 500));
  }
  std::size_t points = 0;
  double far = 0;
  for (const auto& run : plot::decimate_path(x, y)) {
    points += run.size();
    for (const auto i : run)
      far = std::max(far, x[i]);
  }
  EXPECT_LT(points, 600u);
  EXPECT_EQ(far, 100.0);
}

TEST(Ticks, RoundNumbersInsideTheRange) {
  const plot::Ticks a = plot::linear_ticks(0.3, 9.7, 5);
  EXPECT_EQ(a.major, (std::vector<double>{2, 4, 6, 8}));
  EXPECT_EQ(a.labels, (std::vector<std::string>{"2", "4", "6", "8"}));
  const plot::Ticks b = plot::linear_ticks(-2.2e-6, 2.2e-6, 5);
  EXPECT_EQ(b.exponent, -6);
  EXPECT_EQ(b.labels.front(), "−2");
  EXPECT_EQ(b.labels[b.labels.size() / 2], "0");
  const plot::Ticks c = plot::linear_ticks(49.9931, 50.0012, 4);
  EXPECT_EQ(c.labels.front(), "49.9950");  // steps of 0.0025
  for (const double span : {1e-300, 1e-9, 1.0, 7.3, 1e9, 1e300})
    for (const double at : {0.0, 1.0, -3.0}) {
      const plot::Ticks t = plot::linear_ticks(at * span, (at + 1) * span, 6);
      EXPECT_GE(t.major.size(), 3u) << span;
      EXPECT_LE(t.major.size(), 13u) << span;
      for (const double v : t.major)
        EXPECT_TRUE(v >= (at - 1e-6) * span && v <= (at + 1 + 1e-6) * span);
    }
}

TEST(Ticks, DecadesAndTheirFractions) {
  const plot::Ticks a = plot::log_ticks(2e-8, 3, 5);
  EXPECT_EQ(a.labels.size(), a.major.size());
  EXPECT_LE(a.major.size(), 6u);
  for (const double v : a.major)
    EXPECT_NEAR(std::log10(v), std::round(std::log10(v)), 1e-9);
  EXPECT_TRUE(plot::log_ticks(1, infinity, 6).major.empty());
  EXPECT_EQ(plot::log_ticks(1, 100, 6).labels,
            (std::vector<std::string>{"1", "2", "5", "10", "20", "50", "100"}));
}

// One number alone does not tell how long an axis is.
TEST(Ticks, AreTwoAtLeast) {
  for (const double from : {-1.0, -0.95, -0.3, 0.01, 0.4, 1.1, 4.9})
    for (const double span : {0.7, 1.0, 1.25, 2.1, 4.4, 9.1}) {
      EXPECT_GE(plot::linear_ticks(from, from + span, 2).major.size(), 2u) << from << ' ' << span;
      const double low = std::pow(10.0, from), high = std::pow(10.0, from + span);
      EXPECT_GE(plot::log_ticks(low, high, 2).major.size(), 2u) << from << ' ' << span;
    }
}

// The readers of a polar plot of two directions want the speeds of both.
TEST(Polar, EveryCurveHasItsSpeeds) {
  plot::ResponseCurve y{"y", {}, {}, {}}, z{"z", {}, {}, {}};
  for (int k = 0; k <= 40; ++k) {
    for (plot::ResponseCurve* c : {&y, &z})
      c->speed.push_back(10.0 * k);
    y.amplitude.push_back(1e-5 / (1 + 0.01 * (k - 20) * (k - 20)));
    z.amplitude.push_back(0.5e-5 / (1 + 0.01 * (k - 25) * (k - 25)));
    y.phase_lag.push_back(pi * k / 40);
    z.phase_lag.push_back(pi + pi * k / 40);
  }
  const std::vector<plot::ResponseCurve> both{y, z};
  const plot::Figure f = plot::plot_polar("p", "p", both, plot::Amplitude::zero_to_peak);
  const auto& notes = f.axes.front().notes;
  EXPECT_LE(notes.size(), 12u);
  for (const auto& [from, to] : {std::pair{0.0, 180.0}, {180.0, 360.0}})
    EXPECT_GE(std::count_if(
                  notes.begin(), notes.end(),
                  [from = from, to = to](const plot::Note& n) { return n.x >= from && n.x <= to; }),
              2)
        << from;
}

TEST(Text, EscapesAndRepairs) {
  EXPECT_EQ(escape("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
  EXPECT_EQ(escape("\xff\x01µ\xc3"), "\xEF\xBF\xBD\xEF\xBF\xBDµ\xEF\xBF\xBD");
  EXPECT_EQ(readable(-1.23456e-7, 3), "−1.23×10⁻⁷");
  EXPECT_EQ(readable(4812.34, 5), "4812.3");
  EXPECT_EQ(readable(0.1 + 0.2, 6), "0.3");
  EXPECT_EQ(readable(1200000, 3), "1.2×10⁶");
  EXPECT_EQ(number_text(-1e-9), "0");
  EXPECT_EQ(base64("Man"), "TWFu");
  EXPECT_EQ(base64("Ma"), "TWE=");
  EXPECT_EQ(base64("M"), "TQ==");
}

TEST(Palette, MapGrowsLighterInEqualSteps) {
  double last = -1;
  for (const auto& c : plot::color_map()) {
    // Relative luminance, sRGB.
    const auto lin = [](unsigned char v) {
      const double x = v / 255.0;
      return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    };
    const double y = 0.2126 * lin(c.r) + 0.7152 * lin(c.g) + 0.0722 * lin(c.b);
    EXPECT_GT(y, last - 2e-3);  // one step of 8-bit rounding
    last = std::max(last, y);
  }
  EXPECT_GT(last, 0.8);
}

struct Picture {
  std::vector<std::uint8_t> cells, palette;
  png_uint_32 width = 0, height = 0;
};

Picture read_png(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Picture p;
  if (!png_image_begin_read_from_memory(&image, png.data(), png.size())) return p;
  image.format = PNG_FORMAT_RGB_COLORMAP;
  p.width = image.width;
  p.height = image.height;
  p.cells.resize(PNG_IMAGE_SIZE(image));
  p.palette.resize(PNG_IMAGE_COLORMAP_SIZE(image));
  if (!png_image_finish_read(&image, nullptr, p.cells.data(), 0, p.palette.data())) p.cells.clear();
  return p;
}

std::uint32_t big_endian(const std::string& s, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t k = 0; k < 4; ++k)
    v = v << 8 | static_cast<unsigned char>(s[at + k]);
  return v;
}

/// The rows of a picture: without a filter, deflated.
std::string inflated_rows(const std::string& png, std::size_t size) {
  std::string stream, rows(size + 1, '\1');
  for (std::size_t i = 8; i < png.size(); i += 12 + big_endian(png, i))
    if (png.substr(i + 4, 4) == "IDAT") stream += png.substr(i + 8, big_endian(png, i));
  auto got = static_cast<uLongf>(rows.size());
  EXPECT_EQ(
      uncompress(reinterpret_cast<Bytef*>(rows.data()), &got,
                 reinterpret_cast<const Bytef*>(stream.data()), static_cast<uLong>(stream.size())),
      Z_OK);
  rows.resize(got);
  return rows;
}

TEST(Png, CellsAreReadBack) {
  constexpr std::size_t width = 700, height = 100;
  std::vector<std::uint8_t> cells(width * height);
  for (std::size_t i = 0; i < cells.size(); ++i)
    cells[i] = static_cast<std::uint8_t>(i * 31 + i / 97);
  const std::string png = plot::make_png(width, height, cells, plot::color_map());
  const Picture p = read_png(png);
  EXPECT_EQ(p.width, width);
  EXPECT_EQ(p.height, height);
  EXPECT_EQ(p.cells, cells);
  ASSERT_EQ(p.palette.size(), 3 * plot::color_map().size());
  const plot::Rgb color = plot::color_map()[200];
  EXPECT_EQ(p.palette[600], color.r);
  EXPECT_EQ(p.palette[601], color.g);
  EXPECT_EQ(p.palette[602], color.b);
  std::string rows;
  for (std::size_t y = 0; y < height; ++y)
    rows += '\0' + std::string(cells.begin() + static_cast<std::ptrdiff_t>(y * width),
                               cells.begin() + static_cast<std::ptrdiff_t>((y + 1) * width));
  EXPECT_EQ(inflated_rows(png, rows.size()), rows);
}

TEST(Png, TooManyColorsAreRefused) {
  const std::vector<std::uint8_t> cells(4);
  try {
    plot::make_png(2, 2, cells, std::vector<plot::Rgb>(300));
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("palette"), std::string::npos) << e.what();
  }
}

TEST(XmlCheck, FindsFaults) {
  EXPECT_EQ(xml_fault("<a b=\"1\"><c/>x &amp; y</a>"), "");
  for (const char* bad : {"<a><b></a></b>", "<a b=1/>", "<a>&nbsp;</a>", "<a/><b/>", "<a", "x",
                          "<a b=\"<\"/>", "<a b=\"1\" b=\"2\"/>"})
    EXPECT_NE(xml_fault(bad), "") << bad;
}

class Gallery : public ::testing::TestWithParam<std::size_t> {
 protected:
  static const std::vector<plot::Figure>& figures() {
    static const std::vector<plot::Figure> f = gallery();
    return f;
  }
};
INSTANTIATE_TEST_SUITE_P(Plots, Gallery, ::testing::Range<std::size_t>(0, 18),
                         [](const auto& i) { return gallery()[i.param].name; });

TEST_P(Gallery, IsWellFormedFiniteAndNamesItsUnits) {
  ASSERT_EQ(figures().size(), 18u);
  const plot::Figure& f = figures()[GetParam()];
  for (const bool standalone : {true, false}) {
    const std::string svg = plot::render_svg(f, {standalone, "", "", 1.0});
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf\""), std::string::npos);
    EXPECT_EQ(svg.find("=\"\" x="), std::string::npos);
    EXPECT_LT(svg.size(), 500000u);
    // No reference to the outside but the name of the SVG namespace.
    std::size_t urls = 0;
    for (std::size_t at = svg.find("http"); at != std::string::npos; at = svg.find("http", at + 1))
      ++urls;
    EXPECT_EQ(urls, standalone ? 1u : 0u);
  }
  for (const auto& a : f.axes) {
    EXPECT_FALSE(a.x.unit.empty());
    EXPECT_FALSE(a.y.unit.empty());
    EXPECT_TRUE(a.kind != plot::AxesKind::space || !a.z.unit.empty());
  }
  // Ids are unique: several figures share a page.
  const std::string svg = plot::render_svg(f);
  std::set<std::string> ids;
  for (std::size_t at = svg.find(" id=\""); at != std::string::npos;
       at = svg.find(" id=\"", at + 1)) {
    const auto id = svg.substr(at + 5, svg.find('"', at + 5) - at - 5);
    EXPECT_TRUE(ids.insert(id).second) << id;
    EXPECT_EQ(id.find(f.name), 0u);
  }
}

TEST(Svg, OneMillionPointsMakeASmallFileWithThePeakInIt) {
  plot::Figure f;
  f.name = "long";
  plot::Axes a;
  a.x = plot::Axis("time", "s");
  a.y = plot::Axis("displacement", "µm");
  a.y.min = 0;
  a.y.max = 100;
  plot::Series s;
  for (int i = 0; i < 1000000; ++i) {
    s.x.push_back(1e-3 * i);
    s.y.push_back(40 + 10 * std::sin(i * 0.7) + (i == 654321 ? 50 : 0));
  }
  a.series.push_back(s);
  f.axes.push_back(a);
  const std::string svg = plot::render_svg(f);
  EXPECT_LT(svg.size(), 60000u);
  // The frame and the path tell where 40 + 10 sin + 50 stands.
  const auto box_at = svg.find("data-box=\"") + 10;
  double bx, by, bw, bh;
  ASSERT_EQ(std::sscanf(svg.c_str() + box_at, "%lf %lf %lf %lf", &bx, &by, &bw, &bh), 4);
  const auto path_at = svg.find("<path data-s=\"0\"");
  const auto d = svg.substr(svg.find(" d=\"M", path_at) + 5);
  double highest = 1e9, x = 0, y = 0, at_x = 0;
  const char* p = d.c_str();
  for (int n = 0; std::sscanf(p, "%lf %lf%n", &x, &y, &n) == 2; p += *p == '"' ? 0 : 1) {
    if (y < highest) {
      highest = y;
      at_x = x;
    }
    p += n;
    if (*p == '"') break;
  }
  const double peak = 40 + 10 * std::sin(654321 * 0.7) + 50;
  EXPECT_NEAR(highest, by + bh * (1 - peak / 100), 0.006);  // two decimals of a px
  EXPECT_NEAR(at_x, bx + bw * 654.321 / 999.999, 0.006);
}

/// Points of the first curve of a figure: absolute, or by differences behind an "l".
std::vector<std::pair<double, double>> first_curve(const std::string& svg) {
  const auto start = svg.find(" d=\"M", svg.find("<path data-s=\"0\"")) + 5;
  const std::string d = svg.substr(start, svg.find('"', start) - start);
  std::vector<std::pair<double, double>> out;
  bool steps = false;
  const char* p = d.c_str();
  while (*p != 0) {
    if (*p == 'l') steps = true;
    if (*p == 'M' || *p == 'L' || *p == 'l' || *p == ' ') {
      ++p;
      continue;
    }
    char* end = nullptr;
    double x = std::strtod(p, &end);
    double y = std::strtod(end + (*end == ' ' ? 1 : 0), &end);
    p = end;
    if (steps) {
      x += out.back().first;
      y += out.back().second;
    }
    out.emplace_back(x, y);
  }
  return out;
}

TEST(Svg, LongCurvesOfTheReportAreTheSameByDifferences) {
  plot::Figure f;
  f.name = "long";
  plot::Axes a;
  a.x = plot::Axis("time", "s");
  a.y = plot::Axis("displacement", "µm");
  plot::Series s;
  for (int i = 0; i < 450; ++i) {  // one piece, no point left out
    s.x.push_back(1e-3 * i);
    s.y.push_back(i < 200 ? 0.0 : 10 * std::sin(i * 0.37));
  }
  a.series.push_back(s);
  f.axes.push_back(a);
  const auto file = first_curve(plot::render_svg(f));
  const auto report = first_curve(plot::render_svg(f, {false, "", "", 1.5}));
  ASSERT_EQ(file.size(), 450u);
  ASSERT_EQ(report.size(), 252u);  // of the level stretch its ends
  EXPECT_NEAR(report[0].first, file[0].first, 0.051);
  EXPECT_NEAR(report[1].first, file[199].first, 0.051);
  for (std::size_t i = 2; i < report.size(); ++i) {
    EXPECT_NEAR(report[i].first, file[i + 198].first, 0.051);
    EXPECT_NEAR(report[i].second, file[i + 198].second, 0.051);
  }
}

TEST(Svg, ACurveThatComesBackIsDrawnAsOneThatGoes) {
  plot::Figure f;
  f.name = "back";
  plot::Axes a;
  a.x = plot::Axis("speed", "rpm");
  a.y = plot::Axis("amplitude", "µm");
  plot::Series s;
  for (int i = 0; i < 40000; ++i) {
    s.x.push_back(9000 - 0.2 * i + (i % 2) * 1e-3);  // and shakes by less than one sees
    s.y.push_back(std::sin(i * 0.9));
  }
  a.series.push_back(s);
  f.axes.push_back(a);
  EXPECT_LT(plot::render_svg(f, {false, "", "", 1.5}).size(), 60000u);
}

namespace {

/// A mode whose damping grows with the speed: its line ends at 300 rad/s, or at 600 rad/s.
plot::CampbellLine line_that_ends(std::vector<double> decrement) {
  plot::CampbellLine l;
  l.label = "1 F";
  l.whirl = plot::Whirl::forward;
  l.speed = {100, 200, 300, 400};
  l.frequency = {500, 480, 400, nan};
  l.log_decrement = std::move(decrement);
  return l;
}

const plot::Series* overdamped_marks(const plot::Figure& f) {
  for (const plot::Series& s : f.axes.front().series)
    if (s.label == "becomes overdamped") return &s;
  return nullptr;
}

}  // namespace

// A line that ends since its motion no longer oscillates bears a mark there; one that leaves the
// list of modes does not.
TEST(Campbell, EndsOfOverdampedLinesAreMarked) {
  const auto campbell = [](const plot::CampbellLine& line) {
    return plot::plot_campbell("c", "c", std::span(&line, 1), {}, {});
  };
  const plot::Figure heavy = campbell(line_that_ends({2, 4, 8, nan}));
  const plot::Series* marks = overdamped_marks(heavy);
  ASSERT_NE(marks, nullptr);
  ASSERT_EQ(marks->x.size(), 1u);
  EXPECT_NEAR(marks->x[0], to_rpm(300.0), 1e-9);
  EXPECT_NEAR(marks->y[0], to_hz(400.0), 1e-9);
  EXPECT_NE(marks->style.marker, plot::Marker::none);
  EXPECT_TRUE(heavy.axes.front().notes.empty());
  // damping ratios 0.16, 0.30, 0.69: 1 before the next speed
  EXPECT_NE(overdamped_marks(campbell(line_that_ends({1, 2, 6, nan}))), nullptr);
  EXPECT_EQ(overdamped_marks(campbell(line_that_ends({1, 1.1, 1.2, nan}))), nullptr);
  plot::CampbellLine begins = line_that_ends({2, 4, 8, nan});
  for (auto* column : {&begins.frequency, &begins.log_decrement})
    std::reverse(column->begin(), column->end());
  const plot::Figure other = campbell(begins);
  ASSERT_NE(overdamped_marks(other), nullptr);
  EXPECT_NEAR(overdamped_marks(other)->x[0], to_rpm(200.0), 1e-9);
}

TEST(Campbell, DecrementsAreDrawnWhereAModeWhirls) {
  plot::CampbellLine l = line_that_ends({2, 4, 8, 700});
  l.frequency[3] = 0;
  const plot::Figure f = plot::plot_stability("s", "s", std::span(&l, 1));
  for (const plot::Series& s : f.axes.front().series)
    for (const double y : s.y)
      EXPECT_FALSE(y > 8) << y;
}

TEST(Clearances, WallsStandAtTheGapsAndShareIsWritten) {
  const plot::Figure f = gallery_clearances();
  const plot::Axes& a = f.axes.front();
  ASSERT_EQ(a.patches.size(), 4u);
  EXPECT_DOUBLE_EQ(a.patches[1].y[0], 150.0);  // µm
  EXPECT_DOUBLE_EQ(a.patches[1].x[0], 480.0 - 8.0);
  EXPECT_FALSE(a.y.logarithmic);
  ASSERT_EQ(a.notes.size(), 4u);
  EXPECT_EQ(a.notes[1].text, "seal 1: 26.7 %");
  // a gap that dwarfs the motion
  const plot::GapMark wide{"wide", 0.5, 1e-3, 1e-6};
  const plot::ReachLine line{"rotor", {0, 1}, {1e-6, 1e-6}};
  EXPECT_TRUE(plot::plot_clearances("c", "c", std::span(&line, 1), std::span(&wide, 1))
                  .axes.front()
                  .y.logarithmic);
}

// No one reads an enlarged deflection off axes in mm as a real one.
TEST(MachineShape, AxesSayHowFarDeflectionsAreEnlarged) {
  plot::MachineShape m;
  for (const double y : {0.0, 0.5}) {
    plot::ShapeLine l{"line", {}, {}, {}};
    for (const double x : {0.0, 0.5, 1.0}) {
      l.rest.push_back({x, y, 0});
      l.u.push_back({0.0, Complex(2e-6 * x, 0), 0.0});
    }
    m.lines.push_back(std::move(l));
  }
  const plot::Figure mode = plot::plot_machine_shape("m", "m", m);
  EXPECT_EQ(mode.axes[0].y.label, "y, deflection without scale");
  EXPECT_EQ(mode.axes[1].y.label, "deflection, largest = 1");
  m.in_metres = true;
  const plot::Figure shape = plot::plot_machine_shape("m", "m", m);
  // 2 um of the far end are what is drawn beyond its place
  const plot::SpaceSeries& line = shape.axes[0].space[2];
  ASSERT_EQ(line.y.size(), 3u);
  const double times = line.y.back() / 1e3 / 2e-6;
  EXPECT_EQ(shape.axes[0].y.label, "y, deflection enlarged " + readable(times, 2) + " times");
  EXPECT_EQ(shape.axes[0].z.label, "z, deflection enlarged " + readable(times, 2) + " times");
  EXPECT_EQ(shape.axes[1].y.label, "deflection, 1 = 2 µm");

  plot::ModeShape one{"", {0, 1}, {0.0, 3e-6}, {0.0, 0.0}, {}};
  EXPECT_EQ(plot::plot_mode_shape("m", "m", one).axes[0].y.label, "deflection y, largest = 1");
  one.in_metres = true;
  EXPECT_EQ(plot::plot_mode_shape("m", "m", one).axes[0].y.label, "deflection y, 1 = 3 µm");
}

TEST(MachineShape, AllLinesHaveOneScaleAndMoveByTheirMotion) {
  const plot::Figure f = gallery_machine_shape();
  ASSERT_EQ(f.axes.size(), 2u);
  double rotor = 0, casing = 0;
  for (const plot::Series& s : f.axes[1].series)
    for (const double y : s.y)
      (s.label.starts_with("rotor") ? rotor : casing) =
          std::max(s.label.starts_with("rotor") ? rotor : casing, std::abs(y));
  EXPECT_NEAR(rotor, 1.0, 1e-12);
  EXPECT_NEAR(casing, 1.0 / 3, 1e-12);
  for (const plot::SpaceSeries& s : f.axes[0].space) {
    if (s.motion.empty()) continue;
    ASSERT_EQ(s.motion.size(), s.x.size()) << s.label;
    // rest + Re(motion): what is drawn is phase 0 about a straight line
    for (std::size_t i = 0; i < s.x.size(); ++i)
      EXPECT_TRUE(std::isnan(s.y[i]) || std::abs(s.y[i] - s.motion[i][1].real()) < 1e-9);
  }
}

// Lines at their places in space, in mm; the largest motion is drawn as 14 % of the machine's size.
TEST(MachineShape, LinesStandAtTheirPlacesAndMoveAlongTheirAxes) {
  plot::MachineShape m;
  const std::vector<Vec3> origins{{0, 0, 0}, {0, 0.5, -0.25}};
  for (std::size_t l = 0; l < 2; ++l) {
    plot::ShapeLine line{l == 0 ? "rotor" : "casing", {}, {}, {}};
    for (const double x : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      line.rest.push_back(origins[l] + Vec3(x, 0, 0));
      const double size = l == 0 ? 1e-6 * x : 0.5e-6;  // 5e-6 at most
      line.u.push_back({0.0, Complex(3 * size, 0), Complex(4 * size, 0)});
    }
    line.stations = {0, 4};
    m.lines.push_back(std::move(line));
  }
  const plot::Figure f = plot::plot_machine_shape("m", "m", m);
  std::size_t found = 0;
  for (const plot::SpaceSeries& s : f.axes.at(0).space)
    for (std::size_t l = 0; l < 2; ++l) {
      if (s.label != (l == 0 ? "rotor" : "casing") || s.x.size() != 5) continue;
      ++found;
      for (std::size_t i = 0; i < 5; ++i) {
        const double x = 0.25 * static_cast<double>(i), part = l == 0 ? x : 0.5;
        EXPECT_NEAR(s.x[i], 1e3 * x, 1e-9) << l;
        EXPECT_NEAR(s.y[i], 1e3 * origins[l].y() + 140 * 0.6 * part, 1e-9) << l;
        EXPECT_NEAR(s.z[i], 1e3 * origins[l].z() + 140 * 0.8 * part, 1e-9) << l;
      }
    }
  EXPECT_EQ(found, 2u);
}

TEST(Svg, EmptyConstantAndBrokenDataAreDrawn) {
  for (const bool log : {false, true}) {
    plot::Figure f;
    f.name = "odd";
    plot::Axes a;
    a.x = plot::Axis("x", "-", log);
    a.y = plot::Axis("y", "-", log);
    f.axes.push_back(a);
    EXPECT_EQ(xml_fault(plot::render_svg(f)), "");
    for (const auto& y : {std::vector<double>{3, 3, 3},
                          {nan, nan, nan},
                          {1, nan, 2},
                          {0, 0, 0},
                          {-1, 1e300, 2},
                          {infinity, 1, 2}}) {
      f.axes[0].series.clear();
      plot::Series s;
      s.label = "<&\">";
      s.x = {1, 2, 3};
      s.y = y;
      s.style.marker = plot::Marker::circle;
      f.axes[0].series.push_back(s);
      const std::string svg = plot::render_svg(f);
      EXPECT_EQ(xml_fault(svg), "");
      EXPECT_EQ(svg.find("=\"nan"), std::string::npos);
    }
  }
}

TEST(Svg, NamesOfDecksBecomeIds) {
  plot::Figure f = gallery().front();
  f.name = "step \"a/b\" <1>";
  const std::string svg = plot::render_svg(f);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_NE(svg.find("id=\"step__a_b___1_\""), std::string::npos);
  EXPECT_EQ(safe_name("../x"), "_.._x");
  EXPECT_EQ(safe_name(""), "_");
}

TEST(Svg, FileIsWrittenWhole) {
  TempFolder dir;
  io::write_atomic(dir / "a/b.svg", plot::render_svg(gallery().front()));
  EXPECT_EQ(xml_fault(read_text(dir / "a/b.svg")), "");
  EXPECT_EQ(file_count(dir / "a"), 1u);
}

TEST(Units, SuitTheSize) {
  EXPECT_EQ(plot::length_unit(30e-6).name, "µm");
  EXPECT_EQ(plot::length_unit(0.02).name, "mm");
  EXPECT_EQ(plot::length_unit(0.75).name, "m");
  EXPECT_EQ(plot::unit_for("J", 2e-6).name, "µJ");
  EXPECT_EQ(plot::unit_for("N", 2e5).name, "kN");
  EXPECT_EQ(plot::unit_for("N m", 3).name, "N·m");
  EXPECT_NEAR(plot::unit_for("rad/s", 100).factor * two_pi, 60, 1e-12);
  EXPECT_EQ(plot::unit_for("s", 1000).name, "s");
}

TEST(Pareto, FrontIsTheLowerLeftStaircase) {
  const plot::StudyCurve c[] = {{"a", {{1, 1e-2, ""}, {2, 1e-3, ""}, {8, 5e-3, ""}}},
                                {"b", {{4, 1e-6, ""}, {3, 1e-2, ""}}}};
  const plot::Figure f = plot::plot_study("s", "s", c, "error", "-");
  const auto& front = f.axes[0].series.back();
  EXPECT_EQ(front.label, "Pareto front");
  EXPECT_EQ(front.x, (std::vector<double>{1, 2, 2, 4, 4}));
  EXPECT_EQ(front.y, (std::vector<double>{1e-2, 1e-2, 1e-3, 1e-3, 1e-6}));
}

}  // namespace
}  // namespace whirl::io
