// Looks at a figure as a reader would: no curve leaves its axes, no axis dwarfs its data or is without
// two numbers, no number is none, no text stands on another, on a frame or outside the drawing. At
// the files, and at the drawings of the report. check_figures.py looks so at the figures of the
// examples.
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
      const std::string_view rest = axes.substr(begin.size());
      const std::string_view kind = rest.substr(0, rest.find('"'));
      if (kind == "xy") look_at(axes);
      if (kind == "polar") look_at_polar(axes);
      if (kind == "space") look_at_space(axes);
      look_at_ticks(axes, kind);
      at = next;
    }
    look_at_legends();
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

  /// What a text or else the group that it stands in says.
  std::string_view said(std::string_view tag, std::string_view group, std::string_view name) const {
    const std::string_view own = attribute(tag, name);
    return own.empty() ? attribute(group, name) : own;
  }

  /// Of a text element; capitals are 0.72 of the size high. Fonts that stand for Helvetica where it
  /// is not there are up to 1.15 as wide.
  TextBox box_of(std::string_view tag, std::string_view group, std::string text) const {
    const double size = numbers_of(said(tag, group, "font-size")).at(0);
    const double x = numbers_of(attribute(tag, "x")).at(0),
                 y = numbers_of(attribute(tag, "y")).at(0);
    const double w = 1.08 * text_width(text, size), h = 0.72 * size;
    const std::string_view anchor = said(tag, group, "text-anchor");
    const double shift = anchor == "middle" ? 0.5 : anchor == "end" ? 1.0 : 0.0;
    if (attribute(tag, "transform").starts_with("rotate(-90"))
      return {std::move(text), x - h, y - (1 - shift) * w, x, y + shift * w};
    return {std::move(text), x - shift * w, y - h, x + (1 - shift) * w, y};
  }

  /// The tag of the group that sets the size of the text at a place; empty without one.
  static std::string_view group_about(std::string_view part, std::size_t at) {
    const std::size_t group = part.rfind("<g font-size=", at);
    if (group == std::string_view::npos ||
        part.substr(group, at - group).find("</g>") != std::string_view::npos)
      return {};
    return part.substr(group, part.find('>', group) - group);
  }

  /// Of a part of the drawing, in their order.
  std::vector<TextBox> texts_in(std::string_view part) const {
    std::vector<TextBox> texts;
    for (std::size_t at = part.find("<text "); at != std::string_view::npos;
         at = part.find("<text ", at + 1)) {
      const std::size_t end = part.find('>', at);
      const std::string_view tag = part.substr(at, end - at), of = group_about(part, at);
      std::string text(part.substr(end + 1, part.find('<', end) - end - 1));
      for (const auto& [written, read] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}})
        for (std::size_t k = text.find(written); k != std::string::npos; k = text.find(written))
          text.replace(k, std::string_view(written).size(), read);
      texts.push_back(box_of(tag, of, std::move(text)));
    }
    return texts;
  }

  void look_at_texts() {
    const std::vector<TextBox> texts = texts_in(svg_);
    const std::vector<double> view = numbers_of(attribute(svg_, "viewBox"));
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const TextBox& t = texts[i];
      const bool leaves =
          view.size() == 4 && (t.x0 < -1 || t.y0 < -1 || t.x1 > view[2] + 1 || t.y1 > view[3] + 1);
      if (leaves) faults_.push_back("text leaves the figure: '" + t.text + "'");
      for (std::size_t j = i + 1; j < texts.size(); ++j)
        if (t.overlaps(texts[j], 1.0))
          faults_.push_back("texts overlap: '" + t.text + "' and '" + texts[j].text + "'");
    }
  }

  /// The groups of one class in a part, each with all that stands in it.
  static std::vector<std::string_view> groups_of(std::string_view part, const std::string& name) {
    std::vector<std::string_view> out;
    const std::string begin = "<g class=\"" + name + "\"";
    for (std::size_t at = part.find(begin); at != std::string_view::npos;
         at = part.find(begin, at + 1)) {
      int depth = 1;
      std::size_t end = at + 1;
      while (depth > 0 && end != std::string_view::npos) {
        const std::size_t opens = part.find("<g", end), closes = part.find("</g>", end);
        if (closes == std::string_view::npos) break;
        depth += opens < closes ? 1 : -1;
        end = std::min(opens, closes) + 2;
      }
      out.push_back(part.substr(at, end - at));
    }
    return out;
  }

  /// Without two numbers one does not know how long an axis is.
  void look_at_ticks(std::string_view axes, std::string_view kind) {
    const auto want = [&](const std::string& name, std::size_t numbers) {
      if (numbers < 2)
        faults_.push_back("axis " + name + " has " + std::to_string(numbers) + " numbers");
    };
    if (kind == "xy" && attribute(axes, "data-fixed").empty()) {
      for (const char* name : {"tx", "ty", "tr"})
        for (const std::string_view ticks : groups_of(axes, name))
          if (name[1] != 'x' || attribute(axes, "data-hidex").empty())
            want(name, texts_in(ticks).size());
    }
    for (const std::string_view ticks : groups_of(axes, "radii"))
      want("of the radius", texts_in(ticks).size());
    constexpr double room_for_two = 40;  // px, along an axis that is not seen nearly end on
    for (const std::string_view ticks : groups_of(axes, "ts"))
      if (numbers_of(attribute(ticks, "data-px")).at(0) > room_for_two)
        want("in space", texts_in(ticks).size());
  }

  /// A legend lies on no text but its own and on no body.
  void look_at_legends() {
    const std::vector<TextBox> texts = texts_in(svg_);
    for (const std::string_view legend : groups_of(svg_, "legend")) {
      const std::string_view tag = legend.substr(legend.find("<rect"));
      const auto value = [&](const char* name) { return numbers_of(attribute(tag, name)).at(0); };
      const double x = value("x"), y = value("y");
      const TextBox box{"", x, y, x + value("width"), y + value("height")};
      const std::vector<TextBox> own = texts_in(legend);
      for (const TextBox& t : texts) {
        const bool is_own = std::any_of(own.begin(), own.end(), [&](const TextBox& o) {
          return o.text == t.text && o.x0 == t.x0 && o.y0 == t.y0;
        });
        if (!is_own && box.overlaps(t, 1.0)) faults_.push_back("a legend covers '" + t.text + "'");
      }
      look_for_bodies_under(box);
    }
  }

  /// Filled paths: patches.
  void look_for_bodies_under(const TextBox& legend) {
    for (std::size_t at = svg_.find("<path "); at != std::string::npos;
         at = svg_.find("<path ", at + 1)) {
      const std::string_view path = std::string_view(svg_).substr(at, svg_.find('>', at) - at);
      const std::string_view shape = attribute(path, "d");
      if (!shape.ends_with("Z") || !attribute(path, "data-xyz").empty()) continue;
      const std::vector<double> d = numbers_of(shape);
      TextBox body{"", 1e9, 1e9, -1e9, -1e9};
      for (std::size_t i = 0; i + 1 < d.size(); i += 2) {
        body.x0 = std::min(body.x0, d[i]);
        body.x1 = std::max(body.x1, d[i]);
        body.y0 = std::min(body.y0, d[i + 1]);
        body.y1 = std::max(body.y1, d[i + 1]);
      }
      if (d.size() > 4 && legend.overlaps(body, 1.0))
        faults_.push_back("a legend covers a body at " + std::to_string(body.x0));
    }
  }

  /// Names within a frame, which is where they are cut; two in a row are read as one.
  void look_at_pins(std::string_view axes, const std::vector<double>& box) {
    constexpr double apart = 2, same_row = 4;  // px
    for (const std::string_view pins : groups_of(axes, "pins")) {
      const std::vector<TextBox> texts = texts_in(pins);
      for (std::size_t i = 0; i < texts.size(); ++i) {
        const TextBox& t = texts[i];
        const double beyond = std::max(
            {box[0] - t.x0, t.x1 - box[0] - box[2], box[1] - t.y0, t.y1 - box[1] - box[3]});
        if (beyond > 0.5) faults_.push_back("the frame cuts '" + t.text + "'");
        for (std::size_t j = i + 1; j < texts.size(); ++j)
          if (TextBox o = texts[j]; std::min(t.y1, o.y1) - std::max(t.y0, o.y0) > same_row &&
                                    std::min(t.x1, o.x1) - std::max(t.x0, o.x0) > -apart)
            faults_.push_back("'" + t.text + "' and '" + o.text + "' run together");
      }
    }
  }

  /// Corners of the curves of some axes: kind, polar or in space.
  template <class Look>
  void look_at_corners(std::string_view axes, const char* mark, const Look& beyond_of) {
    for (std::size_t at = axes.find("<path "); at != std::string_view::npos;
         at = axes.find("<path ", at + 1)) {
      const std::string_view path = axes.substr(at, axes.find('>', at) - at);
      if (path.find(mark) == std::string_view::npos) continue;
      const std::vector<double> d = numbers_of(without_dots(attribute(path, "d")));
      double beyond = 0;
      for (std::size_t i = 0; i + 1 < d.size(); i += 2)
        beyond = std::max(beyond, beyond_of(d[i], d[i + 1]));
      if (beyond > 1.5)
        faults_.push_back("curve " + std::string(attribute(path, "data-name")) +
                          " leaves its axes by " + std::to_string(beyond) + " px");
    }
  }

  void look_at_polar(std::string_view axes) {
    const std::vector<double> box = numbers_of(attribute(axes, "data-box"));
    if (!has_whole_curves()) return;
    look_at_corners(axes, " data-s=", [&](double x, double y) {
      const double r = box.at(2) / 2;
      return std::hypot(x - box[0] - r, y - box[1] - r) - r;
    });
  }

  void look_at_space(std::string_view axes) {
    const std::vector<double> cell = numbers_of(attribute(axes, "data-cell"));
    look_at_corners(axes, " data-xyz=", [&](double x, double) {
      return std::max(cell.at(0) - x, x - cell.at(1));
    });
  }

  /// Pages write long curves by their differences, and narrow drawings repeat those of wide ones.
  bool has_whole_curves() const { return svg_.find("<svg class=\"figure\"") != std::string::npos; }

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
    look_at_pins(axes, box);
    if (!has_whole_curves()) return;
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

/// The drawings in a report, for desks and for telephones.
inline std::vector<std::string> drawings_in(const std::string& report) {
  constexpr std::string_view begin = "<svg class=\"figure ", end = "</svg>";
  std::vector<std::string> out;
  for (std::size_t at = report.find(begin); at != std::string::npos;
       at = report.find(begin, at + 1))
    out.push_back(report.substr(at, report.find(end, at) + end.size() - at));
  return out;
}

/// A line for each fault of the figures in a folder and of the report beside it; none without the
/// folder.
inline std::vector<std::string> figure_faults(const std::filesystem::path& folder) {
  std::vector<std::string> out;
  if (!std::filesystem::exists(folder)) return out;
  const auto text_of = [](const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  };
  const auto look = [&out](const std::string& name, const std::string& svg) {
    for (const std::string& fault : FigureCheck(svg).faults())
      out.push_back(name + ": " + fault);
  };
  for (const auto& file : std::filesystem::directory_iterator(folder))
    if (file.path().extension() == ".svg")
      look(file.path().filename().string(), text_of(file.path()));
  const std::string report = text_of(folder.parent_path() / "report.html");
  for (const std::string& svg : drawings_in(report)) {
    const std::size_t id = svg.find("id=\"") + 4;
    look(svg.substr(id, svg.find('"', id) - id), svg);
  }
  return out;
}

}  // namespace whirl::test
