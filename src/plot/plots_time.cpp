// Units of display; time histories, orbits, paths, energies.
#include <plot/plots.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace whirl::plot {
namespace {

double largest(std::span<const double> v) {
  double m = 0;
  for (const double x : v)
    if (std::isfinite(x)) m = std::max(m, std::abs(x));
  return m;
}

std::vector<double> scaled(std::span<const double> v, double f) {
  std::vector<double> out(v.begin(), v.end());
  for (double& x : out)
    x *= f;
  return out;
}

}  // namespace

const char* to_string(Amplitude a) {
  return a == Amplitude::zero_to_peak ? "0-peak" : "peak-to-peak";
}

DisplayUnit length_unit(double m) {
  if (m >= 0.5 || m == 0) return {1, "m"};
  if (m >= 1e-3) return {1e3, "mm"};
  if (m >= 1e-7) return {1e6, "µm"};
  return {1e9, "nm"};
}

DisplayUnit unit_for(const std::string& si, double m) {
  if (si == "m") return length_unit(m);
  if (si == "rad/s") return {to_rpm(1.0), "rpm"};
  if (si == "m/s") return m < 0.5 && m > 0 ? DisplayUnit{1e3, "mm/s"} : DisplayUnit{1, si};
  const bool moment = si == "N m" || si == "N·m" || si == "N.m";
  if (si == "N" || moment || si == "W" || si == "J" || si == "Pa" || si == "s" || si == "Hz") {
    const std::string name = moment ? "N·m" : si;
    struct Prefix {
      double least;
      double factor;
      const char* name;
    };
    for (const auto& p : {Prefix{1e10, 1e-9, "G"},
                          {1e7, 1e-6, "M"},
                          {1e4, 1e-3, "k"},
                          {0.1, 1, ""},
                          {1e-4, 1e3, "m"},
                          {1e-7, 1e6, "µ"},
                          {0, 1e9, "n"}})
      if (m >= p.least && m > 0)
        return p.factor < 1 && si == "s" ? DisplayUnit{1, "s"}
                                         : DisplayUnit{p.factor, p.name + name};
    return {1, name};
  }
  return {1, si};
}

Figure plot_orbit(std::string name, std::string title, std::span<const Orbit> orbits,
                  double clearance) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.width = 520;
  f.height = 480;
  double m = clearance;
  for (const auto& o : orbits)
    m = std::max({m, largest(o.y), largest(o.z)});
  const DisplayUnit u = length_unit(m);
  Axes a;
  a.x = Axis("y displacement", u.name);
  a.y = Axis("z displacement", u.name);
  a.equal_aspect = true;
  int color = 0;
  for (const auto& o : orbits) {
    Series s;
    s.label = orbits.size() > 1 || !o.label.empty() ? o.label : "";
    s.x = scaled(o.y, u.factor);
    s.y = scaled(o.z, u.factor);
    s.style.color = color;
    s.style.width = 1.3;
    Series key;  // bright spot where the keyphasor fires
    key.trace_label = (o.label.empty() ? "" : o.label + ", ") + "keyphasor";
    key.style.color = color++;
    key.style.width = 0;
    key.style.marker = Marker::circle;
    key.style.marker_size = 7;
    for (const auto k : o.keyphasor)
      if (k < s.x.size()) {
        key.x.push_back(s.x[k]);
        key.y.push_back(s.y[k]);
      }
    if (&o == &orbits.front() && !key.x.empty()) key.label = "keyphasor";
    a.series.push_back(std::move(s));
    if (!key.x.empty()) a.series.push_back(std::move(key));
  }
  if (clearance > 0) {
    Series c;
    c.label = "clearance";
    c.style = {ink, Dash::dash_dot, 1.0};
    for (int k = 0; k <= 180; ++k) {
      c.x.push_back(u.factor * clearance * std::cos(two_pi * k / 180));
      c.y.push_back(u.factor * clearance * std::sin(two_pi * k / 180));
    }
    a.series.push_back(std::move(c));
  }
  f.axes.push_back(std::move(a));
  return f;
}

Figure plot_path(std::string name, std::string title, std::string x_label, std::string y_label,
                 std::span<const Curve> paths) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.width = 560;
  f.height = 480;
  double m = 0;
  for (const auto& c : paths)
    m = std::max({m, largest(c.x), largest(c.y)});
  const DisplayUnit u = length_unit(m);
  Axes a;
  a.x = Axis(std::move(x_label), u.name);
  a.y = Axis(std::move(y_label), u.name);
  a.equal_aspect = true;
  for (const auto& c : paths) {
    Series s;
    s.label = c.label;
    s.x = scaled(c.x, u.factor);
    s.y = scaled(c.y, u.factor);
    s.style.width = 1.2;
    a.series.push_back(std::move(s));
  }
  f.axes.push_back(std::move(a));
  return f;
}

Figure plot_path_in_space(std::string name, std::string title, std::span<const double> x,
                          std::span<const double> y, std::span<const double> z) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 500;
  Axes a;
  a.kind = AxesKind::space;
  const std::array<std::span<const double>, 3> v = {x, y, z};
  const std::array<Axis*, 3> axis = {&a.x, &a.y, &a.z};
  const std::array<const char*, 3> label = {"x", "y", "z"};
  std::array<std::vector<double>, 3> w;
  for (std::size_t d = 0; d < 3; ++d) {
    const DisplayUnit u = length_unit(largest(v[d]));
    *axis[d] = Axis(label[d], u.name);
    w[d] = scaled(v[d], u.factor);
  }
  const auto dot = [&](std::size_t i, const char* text, int color) {
    SpaceSeries s{text, {w[0][i]}, {w[1][i]}, {w[2][i]}, {}};
    s.style = {color, Dash::solid, 0, Marker::circle, 7};
    return s;
  };
  if (!x.empty()) {
    const auto first = dot(0, "start", 2), last = dot(x.size() - 1, "end", 1);
    a.space.push_back(
        {"", std::move(w[0]), std::move(w[1]), std::move(w[2]), Style{0, Dash::solid, 1.1}});
    a.space.push_back(first);
    a.space.push_back(last);
  }
  f.axes.push_back(std::move(a));
  return f;
}

}  // namespace whirl::plot
