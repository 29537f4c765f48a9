// What a picture shows, read back from its file: axes and the curves in them.
#pragma once
#include <core/types.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace whirl::test {

struct Pixel {
  double x, y;
};

/// What stands between two texts from a place on; empty where there is none.
inline std::string between(const std::string& text, const std::string& from, const std::string& to,
                           std::size_t at = 0) {
  const std::size_t a = text.find(from, at);
  if (a == std::string::npos) return "";
  const std::size_t b = a + from.size();
  return text.substr(b, text.find(to, b) - b);
}

inline std::string attribute(const std::string& tag, const std::string& name) {
  return between(tag, " " + name + "=\"", "\"");
}

/// Numbers of a text, whatever parts them.
inline std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> out;
  for (const char* at = text.c_str(); *at != '\0';) {
    char* end = nullptr;
    const double v = std::strtod(at, &end);
    if (end == at) {
      ++at;
    } else {
      out.push_back(v);
      at = end;
    }
  }
  return out;
}

struct DrawnCurve {
  std::string name;
  bool right = false;         ///< belongs to the axis on the right
  std::vector<Pixel> points;  ///< of cartesian and polar axes
};

/// A curve in space at the moment shown; nan parts the pieces of one.
struct DrawnSpaceCurve {
  std::string name;
  std::vector<Vec3> points;  ///< in the units of the axes
};

struct DrawnAxes {
  std::string kind, x_title, y_title;  ///< xy, polar or space; "time [s]"
  std::string right_title;
  std::vector<double> box, x, y;  ///< px: left, top, width, height; limits, 1: logarithmic
  std::vector<double> right;      ///< limits of the axis on the right, where there is one
  std::vector<double> z, half;    ///< of a space: limits of z; half the edges of the box
  double zero_at = 0;             ///< deg
  bool clockwise = false;
  std::vector<DrawnCurve> curves;
  std::vector<DrawnSpaceCurve> space;

  static double share(const std::vector<double>& limits, double v) {
    if (limits[2] != 0) return std::log(v / limits[0]) / std::log(limits[1] / limits[0]);
    return (v - limits[0]) / (limits[1] - limits[0]);
  }
  /// Where a point of the data belongs; polar: degrees and radius.
  Pixel place(double px, double py) const {
    if (kind != "polar")
      return {box[0] + box[2] * share(x, px), box[1] + box[3] * (1 - share(y, py))};
    const double angle = (zero_at + (clockwise ? -px : px)) * pi / 180;
    const double radius = box[2] / 2 * py / y[1];
    return {box[0] + box[2] / 2 + radius * std::cos(angle),
            box[1] + box[3] / 2 - radius * std::sin(angle)};
  }
  /// On the axis of the right.
  Pixel place_right(double px, double py) const {
    return {place(px, y[0]).x, box[1] + box[3] * (1 - share(right, py))};
  }
  const DrawnCurve* curve(const std::string& name) const {
    for (const DrawnCurve& c : curves)
      if (c.name == name) return &c;
    return nullptr;
  }
  const DrawnSpaceCurve* space_curve(const std::string& name) const {
    for (const DrawnSpaceCurve& c : space)
      if (c.name == name) return &c;
    return nullptr;
  }
};

inline std::string title_of(const std::string& tag, const std::string& axis) {
  const std::string unit = attribute(tag, "data-" + axis + "u");
  return attribute(tag, "data-" + axis + "l") + (unit.empty() ? "" : " [" + unit + "]");
}

inline DrawnCurve curve_of(const std::string& tag) {
  DrawnCurve c{attribute(tag, "data-name"), attribute(tag, "data-right") == "1", {}};
  std::string path = attribute(tag, "d");
  for (std::size_t dot = path.find("h0"); dot != std::string::npos; dot = path.find("h0"))
    path.erase(dot, 2);
  const std::vector<double> v = numbers_in(path);
  for (std::size_t i = 0; i + 1 < v.size(); i += 2)
    c.points.push_back({v[i], v[i + 1]});
  return c;
}

/// Places in the box to places on the axes.
inline DrawnSpaceCurve space_curve_of(const std::string& tag, const DrawnAxes& a) {
  DrawnSpaceCurve c{attribute(tag, "data-name"), {}};
  const std::vector<double>* limits[] = {&a.x, &a.y, &a.z};
  const std::string xyz = attribute(tag, "data-xyz") + "|";
  for (std::size_t begin = 0; begin < xyz.size();) {
    const std::size_t end = xyz.find('|', begin);
    const std::vector<double> v = numbers_in(xyz.substr(begin, end - begin));
    for (std::size_t i = 0; i < v.size(); ++i) {
      const std::size_t d = i % 3;
      const double lo = (*limits[d])[0], hi = (*limits[d])[1];
      if (d == 0) c.points.emplace_back();
      c.points.back()[static_cast<Index>(d)] = lo + (hi - lo) * (v[i] / a.half[d] + 1) / 2;
    }
    c.points.push_back(Vec3::Constant(std::nan("")));
    begin = end + 1;
  }
  c.points.pop_back();
  return c;
}

/// All axes of a file, with the curves that stand for data.
inline std::vector<DrawnAxes> drawn(const std::filesystem::path& file) {
  std::ostringstream all;
  all << std::ifstream(file).rdbuf();
  const std::string svg = all.str(), begin = "<g class=\"axes\"";
  std::vector<DrawnAxes> out;
  for (std::size_t at = svg.find(begin); at != std::string::npos;) {
    const std::size_t next = svg.find(begin, at + 1);
    const std::string part = svg.substr(at, next - at), tag = part.substr(0, part.find('>'));
    DrawnAxes a;
    a.kind = attribute(tag, "data-kind");
    a.x_title = title_of(tag, "x");
    a.y_title = title_of(tag, "y");
    a.right_title = title_of(tag, "r");
    a.right = numbers_in(attribute(tag, "data-r"));
    a.box = numbers_in(attribute(tag, "data-box"));
    a.x = numbers_in(attribute(tag, "data-x"));
    a.y = numbers_in(attribute(tag, "data-y"));
    a.z = numbers_in(attribute(tag, "data-z"));
    a.half = numbers_in(attribute(tag, "data-half"));
    a.zero_at = std::strtod(attribute(tag, "data-zero").c_str(), nullptr);
    a.clockwise = attribute(tag, "data-cw") == "1";
    for (std::size_t p = part.find("<path data-s="); p != std::string::npos;
         p = part.find("<path data-s=", p + 1)) {
      const std::string path = part.substr(p, part.find('>', p) - p);
      if (a.kind == "space")
        a.space.push_back(space_curve_of(path, a));
      else
        a.curves.push_back(curve_of(path));
    }
    out.push_back(a);
    at = next;
  }
  return out;
}

/// The largest distance of a point of `these` from the line through `those`, px.
inline double farthest(const std::vector<Pixel>& these, const std::vector<Pixel>& those) {
  double farthest = those.empty() ? std::numeric_limits<double>::infinity() : 0;
  for (const Pixel& p : these) {
    double nearest = those.empty() ? 0 : std::hypot(p.x - those[0].x, p.y - those[0].y);
    for (std::size_t i = 1; i < those.size(); ++i) {
      const Pixel &a = those[i - 1], &b = those[i];
      const double ux = b.x - a.x, uy = b.y - a.y, length2 = ux * ux + uy * uy;
      const double along = length2 > 0 ? ((p.x - a.x) * ux + (p.y - a.y) * uy) / length2 : 0;
      const double s = std::min(1.0, std::max(0.0, along));
      nearest = std::min(nearest, std::hypot(p.x - a.x - s * ux, p.y - a.y - s * uy));
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

}  // namespace whirl::test
