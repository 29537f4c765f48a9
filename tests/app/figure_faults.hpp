// Looks at a figure as a reader would: no curve leaves its axes, no axis dwarfs its data, no number
// is none, no text stands on another. check_figures.py looks so at the figures of the examples.
#pragma once
#include <core/text.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::test {

class FigureCheck {
 public:
  explicit FigureCheck(std::string svg) : svg_(std::move(svg)) {}

  std::vector<std::string> faults() {
    for (const char* none : {"\"nan", " nan", "\"inf", " inf", "Lnan", "Mnan"})
      if (find_outside_texts(none)) faults_.push_back("a coordinate is no number");
    constexpr std::string_view begin = "<g class=\"axes\" data-kind=\"";
    for (std::size_t at = svg_.find(begin); at != std::string::npos;) {
      const std::size_t next = svg_.find(begin, at + 1);
      const std::string_view axes =
          std::string_view(svg_).substr(at, next == std::string::npos ? next : next - at);
      if (axes.substr(begin.size(), 2) == "xy") look_at(axes);
      at = next;
    }
    look_at_texts();
    return std::move(faults_);
  }

 private:
  struct TextBox {
    std::string text;
    double x0, y0, x1, y1;
    bool overlaps(const TextBox& o, double by) const {
      return std::min(x1, o.x1) - std::max(x0, o.x0) > by &&
             std::min(y1, o.y1) - std::max(y0, o.y0) > by;
    }
  };

  /// Of a text element; capitals are 0.72 of the size high. Fonts that stand for Helvetica where it
  /// is not there are up to 1.15 as wide.
  static TextBox box_of(std::string_view tag, std::string text) {
    const double size = numbers_of(attribute(tag, "font-size")).at(0);
    const double x = numbers_of(attribute(tag, "x")).at(0),
                 y = numbers_of(attribute(tag, "y")).at(0);
    const double w = 1.08 * text_width(text, size), h = 0.72 * size;
    const std::string_view anchor = attribute(tag, "text-anchor");
    const double shift = anchor == "middle" ? 0.5 : anchor == "end" ? 1.0 : 0.0;
    if (attribute(tag, "transform").starts_with("rotate(-90"))
      return {std::move(text), x - h, y - (1 - shift) * w, x, y + shift * w};
    return {std::move(text), x - shift * w, y - h, x + (1 - shift) * w, y};
  }

  void look_at_texts() {
    std::vector<TextBox> texts;
    for (std::size_t at = svg_.find("<text "); at != std::string::npos;
         at = svg_.find("<text ", at + 1)) {
      const std::size_t end = svg_.find('>', at);
      const std::string_view tag = std::string_view(svg_).substr(at, end - at);
      texts.push_back(box_of(tag, svg_.substr(end + 1, svg_.find('<', end) - end - 1)));
    }
    for (std::size_t i = 0; i < texts.size(); ++i)
      for (std::size_t j = i + 1; j < texts.size(); ++j)
        if (texts[i].overlaps(texts[j], 1.0))
          faults_.push_back("texts overlap: '" + texts[i].text + "' and '" + texts[j].text + "'");
  }

  static std::vector<double> numbers_of(std::string_view text) {
    const std::string copy(text);
    std::vector<double> out;
    for (const char* p = copy.c_str(); *p;) {
      char* end = nullptr;
      const double x = std::strtod(p, &end);
      if (end == p)
        ++p;
      else
        out.push_back(x);
      p = std::max<const char*>(p, end);
    }
    return out;
  }
  /// Of the first tag in a text; empty without it.
  static std::string_view attribute(std::string_view tag, std::string_view name) {
    const std::size_t at = tag.find(" " + std::string(name) + "=\"");
    if (at == std::string_view::npos) return {};
    const std::size_t from = at + name.size() + 3;
    return tag.substr(from, tag.find('"', from) - from);
  }
  /// Within tags, not in what a reader reads or what stands for the readout.
  bool find_outside_texts(std::string_view what) const {
    for (std::size_t at = svg_.find(" d=\""); at != std::string::npos;
         at = svg_.find(" d=\"", at + 1)) {
      const std::string_view d =
          std::string_view(svg_).substr(at + 3, svg_.find('"', at + 4) - at - 2);
      if (d.find(what) != std::string_view::npos) return true;
    }
    return false;
  }

  void look_at(std::string_view axes) {
    const std::vector<double> box = numbers_of(attribute(axes, "data-box"));
    const std::vector<double> y = numbers_of(attribute(axes, "data-y"));
    if (box.size() != 4 || y.size() != 3) {
      faults_.push_back("axes without a frame or a range");
      return;
    }
    const std::size_t from = axes.find("<g class=\"plot\">");
    if (from == std::string_view::npos) return;
    const std::string_view plot = axes.substr(from, axes.find("<g class=\"pins\">") - from);
    std::vector<double> sizes;
    for (std::size_t at = plot.find("<path "); at != std::string_view::npos;
         at = plot.find("<path ", at + 1)) {
      const std::string_view path = plot.substr(at, plot.find('>', at) - at);
      if (attribute(path, "data-s").empty() || !attribute(path, "data-quiet").empty()) continue;
      look_at_curve(path, box, y, sizes);
    }
    // bodies, bars and maps: the curves are not all there is
    if (plot.find("<g data-s=") != std::string_view::npos || y[2] != 0 || sizes.empty()) return;
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<long>(sizes.size() / 2),
                     sizes.end());
    const double median = sizes[sizes.size() / 2];
    if (std::max(std::abs(y[0]), std::abs(y[1])) > 1e6 * median) {
      std::ostringstream fault;
      fault << "axis from " << y[0] << " to " << y[1] << ", data about " << median;
      faults_.push_back(fault.str());
    }
  }

  /// A path without the "h0" that makes a point seen.
  static std::string without_dots(std::string_view path) {
    std::string out(path);
    for (std::size_t at = out.find("h0"); at != std::string::npos; at = out.find("h0", at))
      out.erase(at, 2);
    return out;
  }

  void look_at_curve(std::string_view path, const std::vector<double>& box,
                     const std::vector<double>& y, std::vector<double>& sizes) {
    const std::vector<double> d = numbers_of(without_dots(attribute(path, "d")));
    double beyond = 0;
    for (std::size_t i = 0; i + 1 < d.size(); i += 2) {
      beyond = std::max({beyond, box[0] - d[i], d[i] - box[0] - box[2], box[1] - d[i + 1],
                         d[i + 1] - box[1] - box[3]});
      const double size = std::abs(y[1] - (d[i + 1] - box[1]) / box[3] * (y[1] - y[0]));
      const bool nothing = size <= 1e-9 * (y[1] - y[0]);  // of the curve's rounding
      if (attribute(path, "data-right").empty() && !nothing) sizes.push_back(size);
    }
    if (beyond > 1.5)
      faults_.push_back("curve " + std::string(attribute(path, "data-name")) +
                        " leaves its axes by " + std::to_string(beyond) + " px");
  }

  std::string svg_;
  std::vector<std::string> faults_;
};

/// A line for each fault of the figures in a folder; none without the folder.
inline std::vector<std::string> figure_faults(const std::filesystem::path& folder) {
  std::vector<std::string> out;
  if (!std::filesystem::exists(folder)) return out;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".svg") continue;
    std::ostringstream text;
    text << std::ifstream(file.path()).rdbuf();
    for (const std::string& fault : FigureCheck(text.str()).faults())
      out.push_back(file.path().filename().string() + ": " + fault);
  }
  return out;
}

}  // namespace whirl::test
